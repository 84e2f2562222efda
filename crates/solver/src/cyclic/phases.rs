//! Cosines and sines of the harmonics, a group of harmonics at a time.

use std::f64::consts::PI;

/// Harmonics treated together: one AVX2 vector. Eight, in two such vectors or in one of AVX-512, took 14-40 % longer
/// per solve on rings of 150 k and 410 k dof (AMD EPYC 9004, November 2026): the factor of a group then leaves the L2
/// cache.
pub(crate) const LANES: usize = 4;

/// Numbers of one section node in a group's part of a vector: real and imaginary parts of three components,
/// `[3][2][LANES]`.
pub const NODE_LEN: usize = 6 * LANES;

/// One number per harmonic of a group.
pub(crate) type Lanes = [f64; LANES];

/// Phases `exp(i pi k q / N)` of the harmonics k = 0..=N/2, in groups of [`LANES`]; q counts half sectors.
#[derive(Clone, Debug)]
pub(crate) struct Phases {
    n_sectors: usize,
    /// (cos, sin) of pi j / N, `[2 N]`.
    table: Vec<[f64; 2]>,
}

impl Phases {
    pub(crate) fn new(n_sectors: usize) -> Phases {
        let direction = |j: usize| {
            let (sin, cos) = (PI * j as f64 / n_sectors as f64).sin_cos();
            [cos, sin]
        };
        Phases {
            n_sectors,
            table: (0..2 * n_sectors).map(direction).collect(),
        }
    }

    /// Number of harmonics, N/2 + 1.
    pub(crate) fn n_harmonics(&self) -> usize {
        self.n_sectors / 2 + 1
    }

    /// Number of groups of harmonics.
    pub(crate) fn n_groups(&self) -> usize {
        self.n_harmonics().div_ceil(LANES)
    }

    /// (cos, sin) for harmonic `k`.
    pub(crate) fn of(&self, k: usize, q: i32) -> [f64; 2] {
        let (place, period) = (k as i64 * i64::from(q), 2 * self.n_sectors as i64);
        // Most are in the first period, and a division takes longer than the rest.
        let inside = (0..period).contains(&place);
        self.table[if inside { place } else { place.rem_euclid(period) } as usize]
    }

    /// Cosines and sines of a group; lanes beyond the last harmonic repeat it.
    pub(crate) fn lanes(&self, group: usize, q: i32) -> [Lanes; 2] {
        let mut lanes = [[0.0; LANES]; 2];
        for lane in 0..LANES {
            let k = (group * LANES + lane).min(self.n_harmonics() - 1);
            let [cos, sin] = self.of(k, q);
            lanes[0][lane] = cos;
            lanes[1][lane] = sin;
        }
        lanes
    }
}
