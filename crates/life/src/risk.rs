//! Damage of a contact from the stress below it, after Ioannides and Harris. Research: for ratios of lives, no hours.
//!
//! ```text
//! ln(1/S) = A N^e  integral of  (tau - tau_u)^c / z_m^h  dV  over tau > tau_u,    c = 31/3, h = 7/3, e = 10/9
//! ```
//!
//! S is the probability to survive N passes, tau the largest von Mises stress over the root of 3 that a point meets as
//! the ball rolls over it, tau_u the stress below which nothing happens (0 unless a scene gives one), z_m the mean
//! depth of the volume at risk, weighed by tau^c. tau is that of Hertz's ellipse plus the stress of the ring as a body,
//! which is taken as uniform over the contact. A is unknown and leaves with a ratio.
//!
//! With the section I of the integral along the track, the damage of a pass is d = I^(1/e). It takes the place of
//! (Q/Q_c)^3 of [`crate::damage`]: d grows with the load by Q^3, since sizes and stresses grow by Q^(1/3), and the
//! body's stress changes it. Sources: Ioannides and Harris, ASME J. Tribology 107 (1985) 367-378, eq. 15, c, h and e of
//! ball bearings; von Mises stress as the criterion: Harris and McCool, ASME J. Tribology 118 (1996) 297-310.
//!
//! Validity: elastic, dry or fully lubricated without traction, no residual stress of hardening. Cost: some 8000
//! stresses per contact.

use contact::LoadedPatch;
use contact::halfspace::EllipticPressure;
use fem::stress::von_mises;

use crate::damage::WEIBULL;

/// Exponents of stress and depth.
const STRESS_EXPONENT: f64 = 31.0 / 3.0;
const DEPTH_EXPONENT: f64 = 7.0 / 3.0;
/// The section that is looked at, in semi-axes: half width along the groove, depth over the smaller one, half way of
/// the ball along its track. Outside tau is below 0.4 of its maximum, and its power below 1e-4.
const SECTION: [f64; 3] = [1.1, 3.0, 1.25];
/// Middles of cells in these directions.
const CELLS: [usize; 3] = [24, 30, 13];

/// Damage I^(1/e) of one pass of a contact over a ring whose own stress below it is `body`, Pa: gg tt dd gt td gd, g
/// along the groove, t in the rolling direction, d into the ring; 0 without load. In Pa^(c/e) m^((2 - h)/e).
pub fn damage_of_pass(patch: &LoadedPatch, body: [f64; 6], poisson_ratio: f64, limit: f64) -> f64 {
    section(patch, body, poisson_ratio, limit, CELLS).powf(1.0 / WEIBULL)
}

/// The section I.
fn section(patch: &LoadedPatch, body: [f64; 6], poisson_ratio: f64, limit: f64, cells: [usize; 3]) -> f64 {
    let axes = patch.semi_axes;
    if patch.force <= 0.0 || axes.minor() <= 0.0 {
        return 0.0;
    }
    let pressure = EllipticPressure::of_force(patch.force, axes, poisson_ratio);
    let size = [
        2.0 * SECTION[0] * axes.groove,
        SECTION[1] * axes.minor(),
        2.0 * SECTION[2] * axes.rolling,
    ];
    let cell = [0, 1, 2].map(|i| size[i] / cells[i] as f64);
    let track: Vec<f64> = (0..cells[2])
        .map(|k| (k as f64 + 0.5) * cell[2] - 0.5 * size[2])
        .collect();
    let (mut risk, mut depth) = (0.0, 0.0);
    let mut stress = vec![[0.0; 6]; track.len()];
    for i in 0..cells[0] {
        let x = (i as f64 + 0.5) * cell[0] - 0.5 * size[0];
        for j in 0..cells[1] {
            let z = (j as f64 + 0.5) * cell[1];
            let points: Vec<[f64; 3]> = track.iter().map(|y| [x, *y, z]).collect();
            pressure.stresses(&points, &mut stress);
            let shear = |own: &[f64; 6]| von_mises(std::array::from_fn(|c| own[c] + body[c])) / 3f64.sqrt();
            let largest = stress.iter().map(shear).fold(0.0, f64::max);
            let share = (largest - limit).max(0.0).powf(STRESS_EXPONENT);
            risk += share;
            depth += share * z;
        }
    }
    if risk == 0.0 {
        return 0.0;
    }
    risk * cell[0] * cell[1] / (depth / risk).powf(DEPTH_EXPONENT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::SemiAxes;

    const NU: f64 = 0.3;

    /// A contact like that of a 7010C, whose ellipse grows with the cube root of its force.
    fn patch(force: f64) -> LoadedPatch {
        let size = (force / 300.0).cbrt();
        LoadedPatch {
            azimuth: 0.0,
            force,
            angle: 0.3,
            semi_axes: SemiAxes::new(1e-3 * size, 0.1e-3 * size),
            patch_angle: 0.3,
            patch_axes: SemiAxes::new(2e-3, 1e-3),
        }
    }

    /// Wrong: life would not fall with the cube of the load, as Lundberg's and Palmgren's does. Exact: all lengths and
    /// stresses scale.
    #[test]
    fn damage_grows_with_the_cube_of_the_load() {
        let damage = |force: f64| damage_of_pass(&patch(force), [0.0; 6], NU, 0.0);
        for factor in [0.5, 2.0, 8.0] {
            let ratio = damage(300.0 * factor) / damage(300.0);
            assert!((ratio / factor.powi(3) - 1.0).abs() < 1e-10, "{factor}: {ratio}");
        }
    }

    /// Wrong: the stress of the ring would not count by its share in that of the contact: the same ratio to the peak
    /// pressure is the same factor of life.
    #[test]
    fn the_stress_of_the_ring_counts_over_the_pressure() {
        let factor = |force: f64, hoop: f64| {
            let with = damage_of_pass(&patch(force), [0.0, hoop, 0.0, 0.0, 0.0, 0.0], NU, 0.0);
            with / damage_of_pass(&patch(force), [0.0; 6], NU, 0.0)
        };
        assert!((factor(300.0, 50e6) / factor(2400.0, 100e6) - 1.0).abs() < 1e-10);
    }

    /// Wrong: hoop tension would lengthen life, or pressure shorten it. Published: 100 MPa of hoop tension cost some
    /// tenths of a life at usual pressures; more tension costs more.
    #[test]
    fn hoop_tension_costs_life_and_the_more_the_worse() {
        let life = |hoop: f64| 1.0 / damage_of_pass(&patch(300.0), [0.0, hoop, 0.0, 0.0, 0.0, 0.0], NU, 0.0);
        let lives: Vec<f64> = [-100e6, 0.0, 50e6, 100e6, 200e6].map(life).to_vec();
        assert!(lives.windows(2).all(|pair| pair[1] < pair[0]), "{lives:?}");
        let kept = lives[3] / lives[1];
        assert!((0.4..0.9).contains(&kept), "{kept}");
        // A pressure from all sides changes no difference of stresses.
        let even = [-50e6, -50e6, -50e6, 0.0, 0.0, 0.0];
        let same =
            damage_of_pass(&patch(300.0), even, NU, 0.0) / damage_of_pass(&patch(300.0), [0.0; 6], NU, 0.0);
        assert!((same - 1.0).abs() < 1e-9, "{same}");
    }

    /// Wrong: a limit would not protect light loads, nor leave heavy ones alone.
    #[test]
    fn a_limit_spares_light_loads() {
        let kept = |force: f64| {
            let damage = |limit: f64| damage_of_pass(&patch(force), [0.0; 6], NU, limit);
            damage(200e6) / damage(0.0)
        };
        assert!(kept(3.0) == 0.0 && kept(300.0) < kept(3000.0) && kept(3000.0) < 1.0);
        assert_eq!(damage_of_pass(&patch(0.0), [0.0; 6], NU, 0.0), 0.0);
    }

    /// Wrong: the cells would be too coarse. Twice as many in each direction change damage, and what 100 MPa do to it,
    /// by less than 2 and 0.5 %.
    #[test]
    fn finer_cells_change_little() {
        let finer = CELLS.map(|n| 2 * n);
        let damage = |hoop: f64, cells| {
            section(&patch(300.0), [0.0, hoop, 0.0, 0.0, 0.0, 0.0], NU, 0.0, cells).powf(1.0 / WEIBULL)
        };
        let change = damage(0.0, finer) / damage(0.0, CELLS);
        assert!((change - 1.0).abs() < 0.02, "{change}");
        let factor = |cells| damage(100e6, cells) / damage(0.0, cells);
        assert!((factor(finer) / factor(CELLS) - 1.0).abs() < 5e-3);
    }
}
