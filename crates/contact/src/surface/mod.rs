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
//! met by the strips beside it as if it were not there. The ellipse's own length along the track does not filter waves:
//! waves shorter than some four half-widths of the ellipse are felt too much.

mod dent;
mod track;

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

pub use self::dent::Dent;
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
    /// Groove angles of the corners, rad.
    angles: Vec<f64>,
    /// Missing material as a ball meets it, m, `[n_rows][n_angles]`, at equal azimuths from 0 on.
    missing: Vec<f64>,
    /// Radius of the ball-free track at each corner, m.
    track_radii: Vec<f64>,
    has_profile: bool,
}

/// Pieces into which a ramp is cut across the track: the envelope bends there.
const RAMP_PIECES: usize = 8;
/// Largest piece of a floor, rad: the curvature of the track, and with it the sag of the ball, changes along it.
const FLOOR_PIECE: f64 = 0.1;
/// Width of an edge without a ramp, over the width of its spall.
const SHARP: f64 = 1e-6;
/// Grid spacings in the length of a spall.
const SPACINGS_PER_SPALL: f64 = 400.0;
/// Largest grid spacing beside a spall, m.
const SPALL_SPACING: f64 = 5e-6;
/// Grid spacings in a wave.
const SPACINGS_PER_WAVE: f64 = 64.0;
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
    /// The raceway of one side. Without `shoulders`, groove angles in rad, the groove goes on for ever. None where the
    /// grid would need more than [`MOST_NUMBERS`] numbers.
    pub fn new(
        law: StripLaw,
        (geometry, side): (&BearingGeometry, Side),
        shoulders: Option<RangeInclusive<f64>>,
        profiles: &Profiles,
    ) -> Option<StripSurface> {
        let track = Track::new(geometry, side);
        let groove = shoulders.unwrap_or(-PI..=PI);
        let angles = corners(&groove, track.groove_radius, profiles);
        let n_rows = profiles.rows(track);
        if n_rows.checked_mul(angles.len())? > MOST_NUMBERS {
            return None;
        }
        let waves = profiles.wave_heights(n_rows);
        let columns: Vec<Vec<f64>> = angles
            .par_iter()
            .map(|&angle| {
                let spacing = track.radius(angle).abs() * TAU / n_rows as f64;
                let heights = profiles.column(track, &waves, angle);
                envelope(&heights, spacing, track.curvature(angle))
            })
            .collect();
        let missing = (0..n_rows)
            .flat_map(|row| columns.iter().map(move |column| column[row]))
            .collect();
        Some(StripSurface {
            law,
            track_radii: angles.iter().map(|&angle| track.radius(angle)).collect(),
            missing,
            angles,
            has_profile: !profiles.is_empty(),
        })
    }

    /// Groove angles of the corners, rad.
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// Whether anything is missing of the smooth groove between the shoulders.
    pub fn has_profile(&self) -> bool {
        self.has_profile
    }

    /// Missing material at the corners, m, as a ball meets it at an azimuth of the ring, rad.
    pub fn missing_at(&self, azimuth: f64) -> Vec<f64> {
        let n = self.angles.len();
        let n_rows = self.missing.len() / n;
        let place = azimuth.rem_euclid(TAU) / TAU * n_rows as f64;
        let row = (place.floor() as usize).min(n_rows - 1);
        let share = place - row as f64;
        let next = (row + 1) % n_rows;
        let of = |row: usize| &self.missing[n * row..n * (row + 1)];
        let pairs = of(row).iter().zip(of(next));
        pairs.map(|(a, b)| a + share * (b - a)).collect()
    }

    /// Largest difference of the missing material, m.
    pub fn height_range(&self) -> f64 {
        let low = self.missing.iter().copied().fold(0.0, f64::min);
        self.missing.iter().copied().fold(0.0, f64::max) - low
    }

    /// The same surface with all missing material multiplied: to follow an equilibrium from the smooth groove.
    pub fn scaled(&self, share: f64) -> StripSurface {
        StripSurface {
            missing: self.missing.iter().map(|w| share * w).collect(),
            ..self.clone()
        }
    }

    /// A line across the track.
    pub fn line<'l>(&'l self, missing: &'l [f64]) -> StripLine<'l> {
        StripLine {
            angles: &self.angles,
            missing,
        }
    }
}

impl Profiles {
    /// Whether the groove is smooth.
    pub fn is_empty(&self) -> bool {
        self.spalls.is_empty() && self.dents.is_empty() && self.waves.is_empty() && self.tables.is_empty()
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
        let longest = TAU * track.radius(0.0).max(track.radius(0.5 * PI));
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
        let wanted = wanted.chain(self.waves.iter().map(|w| SPACINGS_PER_WAVE * w.order as f64));
        let wanted = wanted.chain(self.tables.iter().map(table));
        wanted.fold(1.0, f64::max).ceil().min(1e12) as usize
    }
}

impl Spall {
    fn missing(&self, track: Track, azimuth: f64, angle: f64) -> f64 {
        let turn = turn(azimuth, self.azimuth);
        let along = turn * track.radius(angle);
        let across = (angle - self.groove_angle) * track.groove_radius;
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
    fn height(&self, azimuth: f64, angle: f64) -> f64 {
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

/// Groove angles between which w is linear: shoulders, edges of spalls, pieces of dents, angles of tables.
fn corners(groove: &RangeInclusive<f64>, groove_radius: f64, profiles: &Profiles) -> Vec<f64> {
    let mut angles = vec![*groove.start(), *groove.end()];
    for spall in &profiles.spalls {
        let edge = spall.edge.max(SHARP * spall.width);
        let floor = (0.5 * spall.width - edge) / groove_radius;
        let pieces = (2.0 * floor / FLOOR_PIECE).ceil().max(1.0);
        let step = 2.0 * floor / pieces;
        angles.extend((1..pieces as usize).map(|i| spall.groove_angle - floor + step * i as f64));
        for sign in [-1.0, 1.0] {
            for piece in 0..=RAMP_PIECES {
                let inside = edge * piece as f64 / RAMP_PIECES as f64;
                let y = sign * (0.5 * spall.width - inside);
                angles.push(spall.groove_angle + y / groove_radius);
            }
        }
    }
    angles.extend(profiles.dents.iter().flat_map(|dent| dent.corners(groove_radius)));
    angles.extend(profiles.tables.iter().flat_map(|table| &table.angles));
    angles.retain(|angle| groove.contains(angle));
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|b, a| *b - *a <= 1e-12);
    angles
}

/// Lower envelope min over t of h(s + t) + k t^2 / 2 round a ring, h linear between points `spacing` apart, m.
fn envelope(heights: &[f64], spacing: f64, curvature: f64) -> Vec<f64> {
    let n = heights.len();
    let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if high - low == 0.0 {
        return heights.to_vec();
    }
    // A ball meets nothing farther away than where the parabola has risen by the whole range.
    let reach = (2.0 * (high - low) / curvature).sqrt() / spacing;
    let reach = (reach.ceil() as usize + 1).min(n);
    let at = |i: isize| heights[i.rem_euclid(n as isize) as usize];
    let factor = 0.5 * curvature * spacing * spacing;
    // Parabolas of the points from -reach to n + reach, in units of the spacing.
    let (mut vertices, mut starts): (Vec<isize>, Vec<f64>) = (Vec::new(), Vec::new());
    for q in -(reach as isize)..(n + reach) as isize {
        let mut start = f64::NEG_INFINITY;
        while let Some(&p) = vertices.last() {
            let (p_, q_) = (p as f64, q as f64);
            start = ((at(q) - at(p)) / factor + q_ * q_ - p_ * p_) / (2.0 * (q_ - p_));
            if start > starts[starts.len() - 1] {
                break;
            }
            vertices.pop();
            starts.pop();
            start = f64::NEG_INFINITY;
        }
        vertices.push(q);
        starts.push(start);
    }
    let mut k = 0;
    let mut result = Vec::with_capacity(n);
    for s in 0..n as isize {
        while k + 1 < vertices.len() && starts[k + 1] < s as f64 {
            k += 1;
        }
        let vertex = vertices[k];
        let point = |i: isize| at(i) + factor * ((i - s) as f64).powi(2);
        let mut least = point(vertex);
        // The minimum may lie on the lines beside the point.
        for (a, b) in [(vertex - 1, vertex), (vertex, vertex + 1)] {
            let ramp = at(b) - at(a);
            let t = (s - a) as f64 - 0.5 * ramp / factor;
            if t > 0.0 && t < 1.0 {
                let place = a as f64 + t - s as f64;
                least = least.min(at(a) + t * ramp + factor * place * place);
            }
        }
        result.push(least);
    }
    result
}

#[cfg(test)]
mod tests;
