//! Real surfaces of a bearing: raceways of strips, balls of different diameters, and balls that are no spheres.

use std::collections::BTreeMap;
use std::sync::Arc;

use contact::{BallArc, BallSurface, SeenMeridian, Side, StripLine, StripSurface, WornLine};

/// What a scene asks for beyond smooth grooves without edges and equal balls; the default is nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surfaces {
    /// Raceways of strips, inner first; None: Hertz's law on a groove without edges.
    pub strips: [Option<Arc<StripSurface>>; 2],
    /// How much larger the diameter of each ball is, m; empty: all are equal. Mass and Hertz stiffness stay those of
    /// the bearing's ball.
    pub oversizes: Vec<f64>,
    /// Balls that are no spheres, by number, as inner and outer raceway meet them; both raceways are then of strips.
    pub balls: BTreeMap<usize, [Arc<BallSurface>; 2]>,
}

/// Where a contact stands on its surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePlace {
    /// Azimuth on the ring, rad.
    pub azimuth: f64,
    /// Angle by which balls have rolled since the start, rad ([`contact::surface::ball`]).
    pub rolled: f64,
    /// How the contact's meridian plane sees a ball that turns freely, in the place of `rolled`.
    pub seen: Option<SeenMeridian>,
}

impl SurfacePlace {
    /// A contact of balls that have not rolled yet, at an azimuth on the ring, rad.
    pub fn at_start(azimuth: f64) -> SurfacePlace {
        SurfacePlace {
            azimuth,
            ..SurfacePlace::default()
        }
    }
}

impl Surfaces {
    /// Whether contacts of a raceway are strips.
    pub fn has_strips(&self) -> bool {
        self.strips.iter().any(Option::is_some)
    }

    /// Whether balls meet anything but smooth grooves.
    pub fn has_profiles(&self) -> bool {
        !self.balls.is_empty() || self.strips.iter().flatten().any(|surface| surface.has_profile())
    }

    /// How much larger the radius of a ball is, m.
    pub fn larger_radius(&self, ball: usize) -> f64 {
        0.5 * self.oversizes.get(ball).copied().unwrap_or(0.0)
    }

    /// The strips of a ball's contact where it stands; None: it has none.
    pub fn at(&self, ball: usize, side: Side, place: SurfacePlace) -> Option<Strips> {
        let surface = self.strips[side.index()].as_ref()?;
        let worn = self.balls.get(&ball).map(|sides| sides[side.index()].clone());
        Some(Strips {
            lines: MissingLines::at(surface, worn.as_deref(), place),
            ends: None,
            surface: surface.clone(),
            worn,
        })
    }
}

/// What is missing of both bodies along the line of a contact, m.
#[derive(Clone, Debug, PartialEq)]
struct MissingLines {
    groove: Arc<[f64]>,
    /// None of a sphere.
    ball: Option<BallMissing>,
}

/// What is missing of a ball along the line of a contact.
#[derive(Clone, Debug, PartialEq)]
enum BallMissing {
    /// At the corners of its own grid, m.
    AtCorners(Arc<[f64]>),
    /// Along an arc.
    Along(Arc<BallArc>),
}

impl BallMissing {
    fn at(ball: &BallSurface, place: SurfacePlace) -> BallMissing {
        match &place.seen {
            Some(seen) => BallMissing::Along(ball.arc(seen).into()),
            None => BallMissing::AtCorners(ball.missing_at(place.rolled).into()),
        }
    }

    fn line<'l>(&'l self, ball: &'l BallSurface) -> WornLine<'l> {
        match self {
            BallMissing::AtCorners(missing) => ball.line(missing),
            BallMissing::Along(arc) => ball.line_along(arc),
        }
    }

    fn scaled(&self, share: f64) -> BallMissing {
        let scaled = |missing: &[f64]| missing.iter().map(|w| share * w).collect::<Vec<f64>>();
        match self {
            BallMissing::AtCorners(missing) => BallMissing::AtCorners(scaled(missing).into()),
            BallMissing::Along(arc) => BallMissing::Along(
                BallArc {
                    missing: scaled(&arc.missing),
                    angles: arc.angles.clone(),
                }
                .into(),
            ),
        }
    }
}

impl MissingLines {
    fn at(surface: &StripSurface, worn: Option<&BallSurface>, place: SurfacePlace) -> MissingLines {
        MissingLines {
            groove: surface.missing_at(place.azimuth).into(),
            ball: worn.map(|ball| BallMissing::at(ball, place)),
        }
    }
}

/// The strips of one contact where it stands on its raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct Strips {
    /// The raceway.
    pub surface: Arc<StripSurface>,
    /// The ball; None: it is a sphere.
    worn: Option<Arc<BallSurface>>,
    lines: MissingLines,
    /// The same at the start and at the end of a step, during which the contact keeps those of its middle.
    ends: Option<[MissingLines; 2]>,
}

impl Strips {
    /// The same where the contact stands at another place.
    pub fn moved(&self, place: SurfacePlace) -> Strips {
        Strips {
            surface: self.surface.clone(),
            worn: self.worn.clone(),
            lines: MissingLines::at(&self.surface, self.worn.as_deref(), place),
            ends: None,
        }
    }

    /// The same over a step that begins and ends at these places.
    pub fn between(self, places: [SurfacePlace; 2]) -> Strips {
        let ends = places.map(|place| MissingLines::at(&self.surface, self.worn.as_deref(), place));
        Strips {
            ends: Some(ends),
            ..self
        }
    }

    /// Contact angle that meets the equator of its ball at the start, rad; None: the ball is a sphere.
    pub fn equator(&self) -> Option<f64> {
        self.worn.as_ref().map(|ball| ball.equator())
    }

    /// The line across the track on which the contact stands.
    pub fn line(&self) -> StripLine<'_> {
        self.line_of(&self.lines)
    }

    fn line_of<'l>(&'l self, lines: &'l MissingLines) -> StripLine<'l> {
        let worn = self.worn.as_ref().zip(lines.ball.as_ref());
        StripLine {
            worn: worn.map(|(ball, missing)| missing.line(ball)),
            ..self.surface.line(&lines.groove)
        }
    }

    /// The lines on which it stands at the start and at the end of a step; without a step, where it stands.
    pub fn lines_at_ends(&self) -> [StripLine<'_>; 2] {
        match &self.ends {
            Some(ends) => ends.each_ref().map(|lines| self.line_of(lines)),
            None => [self.line(); 2],
        }
    }

    /// The same with this share of what is missing.
    pub fn scaled(&self, share: f64) -> Strips {
        Strips {
            lines: MissingLines {
                groove: self.lines.groove.iter().map(|w| share * w).collect(),
                ball: self.lines.ball.as_ref().map(|ball| ball.scaled(share)),
            },
            ..self.clone()
        }
    }
}
