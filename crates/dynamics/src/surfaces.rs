//! Real surfaces of a bearing: raceways of strips, balls of different diameters, and balls that are no spheres.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

use contact::{
    BallArc, BallSurface, BySide, SeenMeridian, SemiAxes, Side, StripLine, StripSurface, WornLine,
};
use serde::Serialize;

use crate::interactions::traction::{PatchPoints, PressureLine};

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
    /// Half-widths along the track of the ellipses by which waves are felt, m, inner first; 0: as by a point.
    pub half_widths: BySide<f64>,
}

/// What missing material under a contact changes at most where its stress is taken for Hertz's, over its overlap:
/// heights of 1 % change pressures by 1.5 %.
const LEVEL: f64 = 0.01;

/// Whether a contact on strips has Hertz's ellipse, with Hertz's pressure and stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EllipseKind {
    /// It has, or nothing touches.
    Hertz,
    /// The groove ends under it.
    Edge,
    /// It touches a profile that is not level under it.
    Profile,
}

/// How a contact on strips carries its load. A strip with the overlap o is as long as an ellipse of the approach o is
/// in its middle, and has the largest pressure of that: both go with sqrt(o).
#[derive(Clone, Debug, PartialEq)]
pub struct StripBearing {
    /// Whether it has Hertz's ellipse.
    pub kind: EllipseKind,
    /// Largest pressure over that of Hertz's ellipse under the same force.
    pub peak: f64,
    /// Where the load lies across the track; none of Hertz's ellipse itself.
    pub lines: Vec<PressureLine>,
}

impl StripBearing {
    const HERTZ: StripBearing = StripBearing {
        kind: EllipseKind::Hertz,
        peak: 1.0,
        lines: Vec::new(),
    };
}

/// Places across the track at which pressures are told.
const PRESSURE_LINES: usize = 41;

impl EllipseKind {
    /// As in tables.
    pub fn name(self) -> &'static str {
        match self {
            EllipseKind::Hertz => "hertz",
            EllipseKind::Edge => "edge",
            EllipseKind::Profile => "profile",
        }
    }
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
    /// Memory of what is missing of all surfaces, bytes.
    pub fn bytes(&self) -> usize {
        let raceways = self.strips.iter().flatten().map(|strips| strips.bytes());
        let balls = self.balls.values().flatten().map(|ball| ball.bytes());
        raceways.chain(balls).sum()
    }

    /// Whether contacts of a raceway are strips.
    pub fn has_strips(&self) -> bool {
        self.strips.iter().any(Option::is_some)
    }

    /// Groove angles where the groove of a raceway ends, rad; None: it goes on for ever.
    pub fn edges(&self, side: Side) -> Option<&RangeInclusive<f64>> {
        self.strips[side.index()].as_ref()?.edges()
    }

    /// What an ellipse beyond the groove of one side means.
    pub fn edge_meaning(&self, side: Side) -> &'static str {
        match self.edges(side) {
            Some(_) => {
                "the ellipse ends at the shoulder; forces are those of what is left of it, but the stress at the edge \
                 is higher than any pressure given here"
            }
            None => {
                "the Hertz ellipse reaches beyond the groove; pressures there are not valid, and forces only with \
                 contact.edges = true"
            }
        }
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
            place,
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
    place: SurfacePlace,
    lines: MissingLines,
    /// The same at the start and at the end of a step, during which the contact keeps those of its middle.
    ends: Option<[MissingLines; 2]>,
}

impl Strips {
    /// The same where the contact stands at another place.
    pub fn moved(&self, place: SurfacePlace) -> Strips {
        Strips {
            place,
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

    /// How it carries its load, at an approach, m, and a contact angle, rad, beside Hertz's ellipse of the same force
    /// with these semi-axes.
    pub fn bearing(&self, approach: f64, angle: f64, axes: SemiAxes) -> StripBearing {
        let half_width = axes.groove;
        let (law, line) = (&self.surface.law, self.line());
        let extent = law.extent(&line, approach, angle).filter(|_| half_width > 0.0);
        let Some(extent) = extent else {
            return StripBearing::HERTZ;
        };
        let mut range = extent.missing;
        for place in self.ends_of_ellipse(angle, axes.rolling) {
            let [low, high] = law.missing_within(&self.moved(place).line(), angle, extent.ends);
            range = [range[0].min(low), range[1].max(high)];
        }
        let kind = if extent.is_cut && self.surface.edges().is_some() {
            EllipseKind::Edge
        } else if range[1] - range[0] > LEVEL * extent.overlap {
            EllipseKind::Profile
        } else {
            return StripBearing::HERTZ;
        };
        let smooth = 0.5 * half_width * half_width / law.parabola_radius;
        let [low, high] = extent.ends;
        let line_at = |k: usize| {
            let y = low + (high - low) * k as f64 / (PRESSURE_LINES - 1) as f64;
            let [missing, _] = law.missing_within(&line, angle, [y; 2]);
            let overlap = approach - missing - 0.5 * y * y / law.parabola_radius;
            PressureLine {
                place: y / half_width,
                overlap: overlap.max(0.0) / smooth,
            }
        };
        StripBearing {
            kind,
            peak: (extent.overlap / smooth).sqrt(),
            lines: (0..PRESSURE_LINES).map(line_at).collect(),
        }
    }

    /// Whether at an approach, m, and a contact angle, rad, it touches a smooth groove that ends nowhere under it.
    pub fn is_smooth(&self, approach: f64, angle: f64) -> bool {
        let law = &self.surface.law;
        let reach = (2.0 * law.parabola_radius * approach.max(0.0)).sqrt() / law.groove_radius;
        let is_within =
            |edges: &RangeInclusive<f64>| *edges.start() < angle - reach && angle + reach < *edges.end();
        approach > 0.0
            && self.worn.is_none()
            && !self.surface.has_profile()
            && self.surface.edges().is_none_or(is_within)
    }

    /// Places of traction with the loads of the strips, at an approach, m, and a contact angle, rad, in the ellipse
    /// with the half-width `half_width` across the track, m. Strips that overlap by less than `least`, m, are taken to
    /// be so near.
    pub fn places(
        &self,
        smooth: &PatchPoints,
        half_width: f64,
        (approach, least): (f64, f64),
        angle: f64,
    ) -> PatchPoints {
        smooth.over_strips(half_width, |cuts| {
            self.surface
                .law
                .loads(&self.line(), (approach, least), angle, cuts)
        })
    }

    /// Where the ellipse ends along the track of the raceway and of a ball that is no sphere.
    fn ends_of_ellipse(&self, angle: f64, rolling: f64) -> Vec<SurfacePlace> {
        let (place, mut ends) = (self.place, Vec::new());
        if self.surface.has_profile() {
            let half = rolling / self.surface.track_radius(angle);
            ends.extend([-half, half].map(|turn| SurfacePlace {
                azimuth: place.azimuth + turn,
                ..place
            }));
        }
        if let (Some(ball), None) = (&self.worn, place.seen) {
            let half = rolling / ball.radius();
            ends.extend([-half, half].map(|turn| SurfacePlace {
                rolled: place.rolled + turn,
                ..place
            }));
        }
        ends
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
