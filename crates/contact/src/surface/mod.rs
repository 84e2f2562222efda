//! The surface of a raceway as its balls meet it: spalls, dents, waves, measured heights, filtered by the ball's size.
//!
//! h(theta, beta) is the material that is missing of the smooth groove, m, at the azimuth theta of the ring and the
//! groove angle beta: the sum of all profiles. Along the track the ball touches what is highest within its reach, so
//! it meets the lower envelope
//!
//! ```text
//! w(s, beta) = min over t of [h(s + t, beta) + k_t t^2 / 2],   k_t = 1/r -+ cos(beta)/rho   (outer, inner)
//! ```
//!
//! with s the length along the track, rho its radius and r that of the ball. Over a spall of length L with sharp edges,
//! deeper than k_t L^2 / 8, the ball sinks by k_t L^2 / 8 and no more. The envelope is made once, on a grid round the
//! ring: along every line of one groove angle h is taken as linear between the grid's azimuths, and the envelope of
//! that is found by the algorithm of Felzenszwalb and Huttenlocher (Theory of Computing 8 (2012) 415), in linear time,
//! and made exact beside the point that it finds. Between azimuths, and across the track between corners, w is linear.
//!
//! Validity: envelopes of neighbouring lines know nothing of each other, so that a spall narrower than the ellipse is
//! met by the strips beside it as if it were not there. The ellipse's own length along the track filters waves alone,
//! by a factor that a scene's waves have before ([`felt`]): marks and tables are felt as by a point.

pub mod ball;
mod ball_arc;
mod dent;
pub mod felt;
mod grid;
mod track;

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

pub use self::ball::{BallArc, BallSurface};
pub use self::ball_arc::SeenMeridian;
pub use self::dent::Dent;
use self::grid::SurfaceGrid;
use self::track::{Track, turn};
use rayon::prelude::*;

use crate::geometry::{BearingGeometry, Side};
use crate::strips::{StripLaw, StripLine};

/// A region of missing material: a rectangle on the groove with ramps as edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spall {
    /// Azimuth of its middle on the ring, rad.
    pub azimuth: f64,
    /// Groove angle of its middle, rad.
    pub groove_angle: f64,
    /// Length along the track at the surface, m.
    pub length: f64,
    /// Width across the track at the surface, m.
    pub width: f64,
    /// Depth of the floor, m.
    pub depth: f64,
    /// Length of the ramps from the surface down to the floor, m; they lie within length and width.
    pub edge: f64,
}

/// A wave round the ring, the same at all groove angles: height amplitude cos(order theta + phase).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Waves round the ring.
    pub order: usize,
    /// Amplitude, m.
    pub amplitude: f64,
    /// Phase, rad.
    pub phase: f64,
}

/// Heights on a regular grid, linear between its points, constant beyond the groove angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Heights {
    /// Azimuths, rad, rising within one turn; the table goes round.
    pub azimuths: Vec<f64>,
    /// Groove angles, rad, rising; one is enough.
    pub angles: Vec<f64>,
    /// Heights above the smooth groove, m, `[n_azimuths][n_angles]`, flat.
    pub heights: Vec<f64>,
}

/// Everything by which a raceway differs from a smooth groove.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profiles {
    /// Spalls.
    pub spalls: Vec<Spall>,
    /// Dents.
    pub dents: Vec<Dent>,
    /// Waves.
    pub waves: Vec<Wave>,
    /// Tables of heights.
    pub tables: Vec<Heights>,
}

/// A raceway of strips: its law, and what is missing of its groove.
#[derive(Clone, Debug, PartialEq)]
pub struct StripSurface {
    /// Law of the strips.
    pub law: StripLaw,
    grid: SurfaceGrid,
    track: Track,
    edges: Option<RangeInclusive<f64>>,
    has_profile: bool,
}

/// Pieces into which a ramp is cut across the track: the envelope bends there.
const RAMP_PIECES: usize = 8;
/// Largest piece of a floor, rad: the curvature of the track, and with it the sag of the ball, changes along it.
const FLOOR_PIECE: f64 = 0.1;
/// Distance of the corners of what goes all over the groove, rad: radius and curvature of the track change with them.
const ALL_OVER_PIECE: f64 = PI / 18.0;
/// Such corners on either side of the middle: up to 60 deg from it, beyond which no contact stands.
const ALL_OVER_CORNERS: i32 = 6;
/// Width of an edge without a ramp, over the width of its spall.
const SHARP: f64 = 1e-6;
/// Grid spacings in the length of a spall.
const SPACINGS_PER_SPALL: f64 = 400.0;
/// Largest grid spacing beside a spall, m.
const SPALL_SPACING: f64 = 5e-6;
/// Grid spacings in a wave.
const SPACINGS_PER_WAVE: f64 = 64.0;
/// Least grid spacings round a ring with waves. Heights linear between M azimuths add to a wave of order n those of the
/// orders k M +- n, of n^2/(k M +- n)^2 of its amplitude: below 1e-6 up to order 60, so that a bearing shows no line of
/// an order that the wave has not.
const LEAST_WAVE_ROWS: f64 = 65536.0;
/// Grid spacings between azimuths of a table.
const SPACINGS_PER_ROW: f64 = 4.0;
/// Most numbers of a surface: 160 MB.
pub const MOST_NUMBERS: usize = 20_000_000;

/// Depth by which a ball sinks into a spall of the length `length`, m, with sharp edges, if it is deep enough: k_t L^2
/// / 8, m.
pub fn sag(geometry: &BearingGeometry, side: Side, angle: f64, length: f64) -> f64 {
    Track::new(geometry, side).curvature(angle) * length * length / 8.0
}

impl StripSurface {
    /// Memory of what is missing of the groove, bytes.
    pub fn bytes(&self) -> usize {
        self.grid.bytes()
    }

    /// The raceway of one side. Without `shoulders`, groove angles in rad, the groove goes on for ever. None where the
    /// grid would need more than [`MOST_NUMBERS`] numbers.
    pub fn new(
        law: StripLaw,
        (geometry, side): (&BearingGeometry, Side),
        shoulders: Option<RangeInclusive<f64>>,
        profiles: &Profiles,
    ) -> Option<StripSurface> {
        let edges = shoulders.clone();
        let groove = shoulders.unwrap_or(-PI..=PI);
        let track = Track::new(geometry, side);
        Some(StripSurface {
            law,
            grid: profiles.grid(track, &groove)?,
            track,
            edges,
            has_profile: !profiles.is_empty(),
        })
    }

    /// Groove angles of the corners, rad.
    pub fn angles(&self) -> &[f64] {
        self.grid.angles()
    }

    /// Groove angles where the groove ends, rad; None: it goes on for ever.
    pub fn edges(&self) -> Option<&RangeInclusive<f64>> {
        self.edges.as_ref()
    }

    /// Radius of the track at a contact angle, rad, in m.
    pub fn track_radius(&self, angle: f64) -> f64 {
        self.track.radius(angle)
    }

    /// Whether anything is missing of the smooth groove between the shoulders.
    pub fn has_profile(&self) -> bool {
        self.has_profile
    }

    /// Missing material at the corners, m, as a ball meets it at an azimuth of the ring, rad.
    pub fn missing_at(&self, azimuth: f64) -> Vec<f64> {
        self.grid.missing_at(azimuth)
    }

    /// A line across the track, under a smooth ball.
    pub fn line<'l>(&'l self, missing: &'l [f64]) -> StripLine<'l> {
        StripLine {
            angles: self.angles(),
            missing,
            worn: None,
        }
    }
}

impl Profiles {
    /// Whether the groove is smooth.
    pub fn is_empty(&self) -> bool {
        self.spalls.is_empty() && self.dents.is_empty() && self.waves.is_empty() && self.tables.is_empty()
    }

    /// Their envelopes within a range of contact angles, rad; None where the grid would need more than
    /// [`MOST_NUMBERS`] numbers.
    fn grid(&self, track: Track, range: &RangeInclusive<f64>) -> Option<SurfaceGrid> {
        let angles = corners(range, track.section_radius(), self);
        let n_rows = self.rows(track);
        if n_rows.checked_mul(angles.len())? > MOST_NUMBERS {
            return None;
        }
        let waves = self.wave_heights(n_rows);
        Some(SurfaceGrid::new(track, n_rows, angles, |angle| {
            self.column(track, &waves, angle)
        }))
    }

    /// Heights of all waves at equal azimuths from 0 on, m.
    fn wave_heights(&self, n_rows: usize) -> Vec<f64> {
        let height = |row: usize| {
            let azimuth = azimuth_of(row, n_rows);
            self.waves.iter().map(|wave| wave.height(azimuth)).sum()
        };
        (0..n_rows).into_par_iter().map(height).collect()
    }

    /// Missing material along the line of one groove angle, rad, in m: from the heights of the waves on it. Spalls and
    /// dents cost only where they are.
    fn column(&self, track: Track, waves: &[f64], angle: f64) -> Vec<f64> {
        let n_rows = waves.len();
        let mut missing = vec![0.0; n_rows];
        let mut add = |middle: f64, reach: f64, height: &dyn Fn(f64) -> f64| {
            for row in rows_within(middle, reach / track.radius(angle).abs(), n_rows) {
                missing[row] += height(azimuth_of(row, n_rows));
            }
        };
        for spall in &self.spalls {
            add(spall.azimuth, 0.5 * spall.length, &|azimuth| {
                spall.missing(track, azimuth, angle)
            });
        }
        for dent in &self.dents {
            add(dent.azimuth, dent.reach(), &|azimuth| {
                dent.missing(track, azimuth, angle)
            });
        }
        for (row, (missing, wave)) in missing.iter_mut().zip(waves).enumerate() {
            let azimuth = azimuth_of(row, n_rows);
            let tables: f64 = self.tables.iter().map(|table| table.height(azimuth, angle)).sum();
            *missing = *missing - wave - tables;
        }
        missing
    }

    /// Azimuths of the grid.
    fn rows(&self, track: Track) -> usize {
        let longest = track.longest();
        let spall = |s: &Spall| {
            let finest = SPALL_SPACING.min(s.length / SPACINGS_PER_SPALL);
            let finest = if s.edge > 0.0 {
                finest.min(s.edge / RAMP_PIECES as f64)
            } else {
                finest
            };
            longest / finest
        };
        let table = |t: &Heights| SPACINGS_PER_ROW * TAU / smallest_gap(&t.azimuths);
        let dent = |d: &Dent| longest / SPALL_SPACING.min(d.spacing());
        let wanted = self.spalls.iter().map(spall).chain(self.dents.iter().map(dent));
        let wanted = wanted.chain(
            self.waves
                .iter()
                .map(|w| LEAST_WAVE_ROWS.max(SPACINGS_PER_WAVE * w.order as f64)),
        );
        let wanted = wanted.chain(self.tables.iter().map(table));
        wanted.fold(1.0, f64::max).ceil().min(1e12) as usize
    }
}

impl Spall {
    fn missing(&self, track: Track, azimuth: f64, angle: f64) -> f64 {
        let turn = turn(azimuth, self.azimuth);
        let along = turn * track.radius(angle);
        let across = (angle - self.groove_angle) * track.section_radius();
        self.depth * self.ramp(along, self.length) * self.ramp(across, self.width)
    }

    /// 1 on the floor, 0 on the surface, linear on the ramps.
    fn ramp(&self, place: f64, extent: f64) -> f64 {
        let inside = 0.5 * extent - place.abs();
        if self.edge > 0.0 {
            (inside / self.edge).clamp(0.0, 1.0)
        } else if inside > 0.0 {
            1.0
        } else {
            0.0
        }
    }
}

impl Wave {
    fn height(&self, azimuth: f64) -> f64 {
        self.amplitude * (self.order as f64 * azimuth + self.phase).cos()
    }
}

impl Heights {
    /// Height at an azimuth and a groove angle, rad, in m.
    pub fn height(&self, azimuth: f64, angle: f64) -> f64 {
        let (n, n_angles) = (self.azimuths.len(), self.angles.len());
        let first = self.azimuths[0];
        let azimuth = first + (azimuth - first).rem_euclid(TAU);
        let row = self.azimuths.partition_point(|a| *a <= azimuth).max(1) - 1;
        let (next, end) = if row + 1 < n {
            (row + 1, self.azimuths[row + 1])
        } else {
            (0, first + TAU)
        };
        let share = (azimuth - self.azimuths[row]) / (end - self.azimuths[row]);
        let at = |row: usize| {
            let heights = &self.heights[n_angles * row..n_angles * (row + 1)];
            let i = self.angles.partition_point(|a| *a <= angle);
            if i == 0 || i == n_angles {
                return heights[i.min(n_angles - 1)];
            }
            let t = (angle - self.angles[i - 1]) / (self.angles[i] - self.angles[i - 1]);
            heights[i - 1] + t * (heights[i] - heights[i - 1])
        };
        at(row) + share * (at(next) - at(row))
    }
}

/// Azimuth of a row of the grid, rad.
fn azimuth_of(row: usize, n_rows: usize) -> f64 {
    TAU * row as f64 / n_rows as f64
}

/// Rows of a grid round the ring within an angle of an azimuth, rad, each once, and one more on both sides.
fn rows_within(azimuth: f64, half: f64, n_rows: usize) -> impl Iterator<Item = usize> {
    let spacing = TAU / n_rows as f64;
    let first = ((azimuth - half) / spacing).floor();
    let n = (2.0 * half / spacing).ceil() as usize + 3;
    let first = first.rem_euclid(n_rows as f64) as usize;
    (0..n.min(n_rows)).map(move |i| (first + i) % n_rows)
}

/// Smallest distance of neighbouring azimuths round the ring, rad.
fn smallest_gap(azimuths: &[f64]) -> f64 {
    let around = azimuths[0] + TAU - azimuths[azimuths.len() - 1];
    azimuths.windows(2).map(|a| a[1] - a[0]).fold(around, f64::min)
}

/// Contact angles between which w is linear: shoulders, edges of spalls, pieces of dents, angles of tables, and pieces
/// of what goes all over the groove.
fn corners(range: &RangeInclusive<f64>, section_radius: f64, profiles: &Profiles) -> Vec<f64> {
    let mut angles = vec![*range.start(), *range.end()];
    for spall in &profiles.spalls {
        let edge = spall.edge.max(SHARP * spall.width);
        let floor = (0.5 * spall.width - edge) / section_radius;
        let pieces = (2.0 * floor / FLOOR_PIECE).ceil().max(1.0);
        let step = 2.0 * floor / pieces;
        angles.extend((1..pieces as usize).map(|i| spall.groove_angle - floor + step * i as f64));
        for sign in [-1.0, 1.0] {
            for piece in 0..=RAMP_PIECES {
                let inside = edge * piece as f64 / RAMP_PIECES as f64;
                let y = sign * (0.5 * spall.width - inside);
                angles.push(spall.groove_angle + y / section_radius);
            }
        }
    }
    angles.extend(
        profiles
            .dents
            .iter()
            .flat_map(|dent| dent.corners(section_radius)),
    );
    angles.extend(profiles.tables.iter().flat_map(|table| &table.angles));
    if !(profiles.waves.is_empty() && profiles.tables.is_empty()) {
        let middle = 0.5 * (range.start() + range.end());
        let pieces = -ALL_OVER_CORNERS..=ALL_OVER_CORNERS;
        angles.extend(pieces.map(|i| middle + ALL_OVER_PIECE * f64::from(i)));
    }
    angles.retain(|angle| range.contains(angle));
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|b, a| *b - *a <= 1e-12);
    angles
}

#[cfg(test)]
mod tests;
