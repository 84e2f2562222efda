//! Real surfaces of a bearing: raceways of strips, and balls of different diameters.

use std::sync::Arc;

use contact::{Side, StripLine, StripSurface};

/// What a scene asks for beyond smooth grooves without edges and equal balls; the default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// Raceways of strips, inner first; None: Hertz's law on a groove without edges.
    pub strips: [Option<Arc<StripSurface>>; 2],
    /// How much larger the diameter of each ball is, m; empty: all are equal. Mass and Hertz stiffness stay those of
    /// the bearing's ball.
    pub oversizes: Vec<f64>,
}

impl Surfaces {
    /// Whether contacts of a raceway are strips.
    pub fn has_strips(&self) -> bool {
        self.strips.iter().any(Option::is_some)
    }

    /// Whether balls meet anything but smooth grooves.
    pub fn has_profiles(&self) -> bool {
        self.strips.iter().flatten().any(|surface| surface.has_profile())
    }

    /// How much larger the radius of a ball is, m.
    pub fn larger_radius(&self, ball: usize) -> f64 {
        0.5 * self.oversizes.get(ball).copied().unwrap_or(0.0)
    }

    /// The strips of a contact at an azimuth of its ring, rad; None: it has none.
    pub fn at(&self, side: Side, azimuth: f64) -> Option<Strips> {
        let surface = self.strips[side.index()].as_ref()?;
        Some(Strips {
            missing: surface.missing_at(azimuth).into(),
            ends: None,
            surface: surface.clone(),
        })
    }
}

/// The strips of one contact where it stands on its raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct Strips {
    /// The raceway.
    pub surface: Arc<StripSurface>,
    /// What is missing at its corners, m.
    missing: Arc<[f64]>,
    /// The same at the start and at the end of a step, during which the contact keeps that of its middle.
    ends: Option<[Arc<[f64]>; 2]>,
}

impl Strips {
    /// The same over a step that begins and ends at these azimuths of the ring, rad.
    pub fn between(self, start: f64, end: f64) -> Strips {
        let ends = [start, end].map(|azimuth| self.surface.missing_at(azimuth).into());
        Strips {
            ends: Some(ends),
            ..self
        }
    }

    /// The line across the track on which the contact stands.
    pub fn line(&self) -> StripLine<'_> {
        self.surface.line(&self.missing)
    }

    /// The lines on which it stands at the start and at the end of a step; without a step, where it stands.
    pub fn lines_at_ends(&self) -> [StripLine<'_>; 2] {
        match &self.ends {
            Some(ends) => ends.each_ref().map(|missing| self.surface.line(missing)),
            None => [self.line(); 2],
        }
    }

    /// The same with this share of what is missing.
    pub fn scaled(&self, share: f64) -> Strips {
        Strips {
            missing: self.missing.iter().map(|w| share * w).collect(),
            ..self.clone()
        }
    }
}
