//! What is missing of a surface on a grid round it: along the track filtered by what rolls over it, across it linear
//! between corners.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::track::Track;

/// Envelopes of the profiles of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SurfaceGrid {
    /// Contact angles of the corners, rad.
    angles: Vec<f64>,
    /// Missing material as it is met, m, `[n_rows][n_angles]`, at equal azimuths from 0 on.
    missing: Vec<f64>,
}

impl SurfaceGrid {
    /// The grid of `n_rows` azimuths round a track with these corners, contact angles in rad; `column` is what is
    /// missing along one of these, m, before it is filtered.
    pub fn new(
        track: Track,
        n_rows: usize,
        angles: Vec<f64>,
        column: impl Fn(f64) -> Vec<f64> + Sync,
    ) -> SurfaceGrid {
        let columns: Vec<Vec<f64>> = angles
            .par_iter()
            .map(|&angle| {
                let spacing = track.radius(angle).abs() * TAU / n_rows as f64;
                envelope(&column(angle), spacing, track.curvature(angle))
            })
            .collect();
        let mut missing = Vec::with_capacity(n_rows * angles.len());
        (0..n_rows).for_each(|row| missing.extend(columns.iter().map(|column| column[row])));
        SurfaceGrid { angles, missing }
    }

    /// Memory of the grid, bytes.
    pub fn bytes(&self) -> usize {
        8 * (self.angles.len() + self.missing.len())
    }

    /// Contact angles of the corners, rad.
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// Missing material at the corners at an azimuth, rad, in m.
    pub fn missing_at(&self, azimuth: f64) -> Vec<f64> {
        let n = self.angles.len();
        let ([row, next], share) = self.rows_at(azimuth);
        let of = |row: usize| &self.missing[n * row..n * (row + 1)];
        let pairs = of(row).iter().zip(of(next));
        pairs.map(|(a, b)| a + share * (b - a)).collect()
    }

    /// The same at one corner.
    pub fn missing_on(&self, azimuth: f64, corner: usize) -> f64 {
        let n = self.angles.len();
        let (rows, share) = self.rows_at(azimuth);
        let [a, b] = rows.map(|row| self.missing[n * row + corner]);
        a + share * (b - a)
    }

    /// The rows on both sides of an azimuth, rad, and how far it is on from the first to the second.
    fn rows_at(&self, azimuth: f64) -> ([usize; 2], f64) {
        let n_rows = self.missing.len() / self.angles.len();
        let place = azimuth.rem_euclid(TAU) / TAU * n_rows as f64;
        let row = (place.floor() as usize).min(n_rows - 1);
        ([row, (row + 1) % n_rows], place - row as f64)
    }
}

/// Lower envelope min over t of h(s + t) + k t^2 / 2 round a ring, h linear between points `spacing` apart, m.
pub(super) fn envelope(heights: &[f64], spacing: f64, curvature: f64) -> Vec<f64> {
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
