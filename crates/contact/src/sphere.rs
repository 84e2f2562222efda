//! Elasticity of a ball as a sphere between its two contacts, beyond the half-spaces of Hertz's law.
//!
//! A normal traction sigma P_n(cos t) on a solid sphere of radius a moves its surface by a f_n sigma P_n, without shear
//! and against its centre of mass, with (Lurie, Theory of Elasticity, 2005, section 8.3; by Navier's solutions of
//! degree n + 1 and n - 1)
//!
//! ```text
//! f_n = [2 n^2 (1 - nu) + n nu - 1 + 2 nu] / [2 G (n - 1) (n^2 + n + 1 + (2 n + 1) nu)],   n = 0, 2, 3, ...
//! f_1 = 0.3 (1 - 2 nu) / [G (1 + nu)]              with the body force that accelerates the ball
//! ```
//!
//! A force at a point has the parts (2 n + 1)/(4 pi a^2), so it presses the surface at the angle t inwards by
//!
//! ```text
//! w(t) = 1/(4 pi a) sum (2 n + 1) f_n P_n(cos t)
//! ```
//!
//! per N. On a half-space the same force gives the part h P_n of the series of 1/(2 sin(t/2)), h = 2 (1 - nu)/G, at
//! the chord 2 a sin(t/2). The difference is regular but for h e P_n / n, e = (1 - 2 nu)^2 / (2 (1 - nu)), whose sum is
//! -h e ln(sin(t/2) + sin^2(t/2)). Under a Hertz pressure over the semi-axes (c, d) the mean of ln of the distance of
//! two points is ln((c + d)/2) - 0.3637, a logarithmic potential; with the growth of the ellipse under load, 1/6 more.
//! The ellipse is that of a peak pressure of 1.5 GPa: twice the pressure changes the compliance by 0.05/(E D).
//!
//! A contact is stiffer than Hertz's by `own` Q, about 0.70 Q/(E D), and softer by `across` times the force of the
//! other one, 0.33/(E D): together about 0.4 Q/(E D), 1.5 % of the approach of a 9 mm ball under 330 N. `across`
//! follows the angle between the contacts ([`crate::across`]): at 150 deg it is a quarter less. Valid for small
//! ellipses, where the pressure stays Hertz's.
//!
//! **Hollow balls** have the f_n of a shell (`shell`), which for large n are those of a solid ball, so that the
//! singular parts stay. `own` takes what the cavity adds in the middle of the contact. Where the wall is twice the
//! larger semi-axis, [`least_wall`], its mean over the ellipse is 5 % less: 0.2 % of the approach.

use crate::across::AcrossCompliance;
use crate::geometry::BySide;
use crate::hertz::{Elastic, HertzContact};
use crate::semi_axes::SemiAxes;
use crate::shell;

/// Terms of the series; what is left falls with their square.
const TERMS: u32 = 20_000;
/// Peak pressure at which the ellipse is taken, Pa.
const PRESSURE: f64 = 1.5e9;
/// Mean of ln(distance / radius) of two points under Hertz's pressure on a circle: -(2 H_(3/2) - H_3)/2 with the
/// harmonic numbers of 3/2 and 3.
const MEAN_LOGARITHM: f64 = -0.363_704_787_458_873_6;
/// How much more the growth of the ellipse with the cube root of the force adds.
const GROWTH: f64 = 1.0 / 6.0;

/// Compliances of a ball beyond those of half-spaces, m/N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SphereCompliance {
    /// By how much less than a half-space a contact yields under its own force, inner first.
    pub own: BySide<f64>,
    /// By how much a contact yields under the force of the other one.
    pub across: AcrossCompliance,
}

impl SphereCompliance {
    /// Of a solid ball with its contacts on both raceways.
    pub fn new(ball: Elastic, diameter: f64, contacts: &[HertzContact; 2]) -> SphereCompliance {
        SphereCompliance::of_shell(ball, diameter, 0.0, contacts)
    }

    /// Of a hollow ball with this outer and inner diameter, m; without a hole it is the solid one.
    pub fn of_shell(
        ball: Elastic,
        diameter: f64,
        inner_diameter: f64,
        contacts: &[HertzContact; 2],
    ) -> SphereCompliance {
        let series = LegendreSeries::new(ball, 0.5 * diameter, inner_diameter / diameter);
        SphereCompliance {
            own: contacts.map(|hertz| series.own(&hertz)),
            across: AcrossCompliance::new(|angle| series.at_angle(angle)),
        }
    }
}

/// Thinnest wall of a hollow ball on which contacts are still Hertz's, m: twice the larger semi-axis at 1.5 GPa.
pub fn least_wall(contacts: &[HertzContact; 2]) -> f64 {
    let [inner, outer] = contacts.each_ref().map(|hertz| ellipse(hertz).major());
    2.0 * inner.max(outer)
}

/// Semi-axes at [`PRESSURE`], m.
fn ellipse(contact: &HertzContact) -> SemiAxes {
    contact.semi_axes((PRESSURE / contact.peak_pressure(1.0)).powi(3))
}

/// The series of one ball.
struct LegendreSeries {
    /// Radius, m.
    radius: f64,
    /// h, 1/Pa, and e.
    half_space: f64,
    logarithm: f64,
    /// (2 n + 1) f_n - h (1 + e/n), by n.
    rest: Vec<f64>,
}

impl LegendreSeries {
    /// `ratio` is the inner over the outer radius.
    fn new(ball: Elastic, radius: f64, ratio: f64) -> LegendreSeries {
        let nu = ball.poisson_ratio;
        let shear = 0.5 * ball.young_modulus / (1.0 + nu);
        let half_space = 2.0 * (1.0 - nu) / shear;
        let logarithm = (1.0 - 2.0 * nu).powi(2) / (2.0 * (1.0 - nu));
        let term = |n: u32| {
            let n_f = f64::from(n);
            let weight = 2.0 * n_f + 1.0;
            let of_shell = (ratio > 0.0).then(|| shell::pressed_in(n, nu, ratio)).flatten();
            let f = match (n, of_shell) {
                (_, Some(pressed_in)) => pressed_in / shear,
                (1, None) => 0.3 * (1.0 - 2.0 * nu) / (shear * (1.0 + nu)),
                _ => {
                    let load = n_f * n_f + n_f + 1.0 + weight * nu;
                    (2.0 * n_f * n_f * (1.0 - nu) + n_f * nu - 1.0 + 2.0 * nu)
                        / (2.0 * shear * (n_f - 1.0) * load)
                }
            };
            let log_part = if n == 0 { 0.0 } else { logarithm / n_f };
            weight * f - half_space * (1.0 + log_part)
        };
        LegendreSeries {
            radius,
            half_space,
            logarithm,
            rest: (0..TERMS).map(term).collect(),
        }
    }

    /// w at an angle from the force that is not small, m/N.
    fn at_angle(&self, angle: f64) -> f64 {
        let (cos, half) = (angle.cos(), (0.5 * angle).sin());
        let (mut p, mut next) = (1.0, cos);
        let mut sum = 0.0;
        for (n, rest) in self.rest.iter().enumerate() {
            sum += rest * p;
            let n = n as f64;
            (p, next) = (next, ((2.0 * n + 3.0) * cos * next - (n + 1.0) * p) / (n + 2.0));
        }
        let of_half_space = 0.5 / half - self.logarithm * (half + half * half).ln();
        (sum + self.half_space * of_half_space) / (4.0 * std::f64::consts::PI * self.radius)
    }

    /// By how much less than a half-space the contact yields, m/N.
    fn own(&self, contact: &HertzContact) -> f64 {
        let axes = ellipse(contact);
        let half = 0.25 * (axes.groove + axes.rolling) / self.radius;
        let logarithm = half.ln() + half.ln_1p() + MEAN_LOGARITHM + GROWTH;
        let sum: f64 = self.rest.iter().rev().sum();
        -(sum - self.half_space * self.logarithm * logarithm) / (4.0 * std::f64::consts::PI * self.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Elastic = Elastic {
        young_modulus: 207e9,
        poisson_ratio: 0.3,
    };

    /// Wrong: a term of the series. Uniform pressure squeezes a sphere by (1 - 2 nu)/E p a.
    #[test]
    fn uniform_pressure_squeezes_a_sphere_by_its_bulk_modulus() {
        let series = LegendreSeries::new(STEEL, 4.5e-3, 0.0);
        let f_0 = series.rest[0] + series.half_space;
        let expected = (1.0 - 2.0 * STEEL.poisson_ratio) / STEEL.young_modulus;
        assert!((f_0 / expected - 1.0).abs() < 1e-12);
    }

    /// Wrong: the series does not reach its sum. Twice as many terms change less than 1e-4 of it, at both ends.
    #[test]
    fn the_series_has_converged() {
        let mut series = LegendreSeries::new(STEEL, 4.5e-3, 0.0);
        let whole = (series.rest.iter().sum::<f64>(), series.at_angle(3.0));
        series.rest.truncate(TERMS as usize / 2);
        let half = (series.rest.iter().sum::<f64>(), series.at_angle(3.0));
        assert!((half.0 / whole.0 - 1.0).abs() < 1e-4, "{half:?} {whole:?}");
        assert!((half.1 / whole.1 - 1.0).abs() < 1e-9, "{half:?} {whole:?}");
    }

    /// Wrong: the sum of the series and of its singular parts. Two opposite forces F change the volume inside the
    /// surface by 2 F times what a pressure of 1 presses in (Betti): (1 - 2 nu) a/E of a solid ball, Lame's of a hollow
    /// one. Against the integral of w over the surface.
    #[test]
    fn the_volume_shrinks_as_betti_says() {
        let (radius, nu) = (4.5e-3, STEEL.poisson_ratio);
        for ratio in [0.0f64, 0.3, 0.5] {
            let series = LegendreSeries::new(STEEL, radius, ratio);
            // Both forces, at 0 and pi, where w is singular as 1/t: midpoint rule.
            let (n, pi) = (400, std::f64::consts::PI);
            let ring = |i: i32| {
                let angle = pi * (f64::from(i) + 0.5) / f64::from(n);
                let w = series.at_angle(angle) + series.at_angle(pi - angle);
                2.0 * pi * radius * radius * w * angle.sin() * pi / f64::from(n)
            };
            let volume: f64 = (0..n).map(ring).sum();
            let cube = ratio.powi(3);
            let lame = (1.0 - 2.0 * nu + 0.5 * (1.0 + nu) * cube) / (1.0 - cube);
            let expected = lame * 2.0 * radius / STEEL.young_modulus;
            assert!(
                (volume / expected - 1.0).abs() < 1e-3,
                "{ratio}: {volume} {expected}"
            );
        }
    }

    /// Wrong: a hollow ball is not softer, or a small cavity changes the solid one. What a cavity of half the diameter
    /// adds to 7010C: 0.90/(E D) in the middle of a contact, 0.40/(E D) opposite.
    #[test]
    fn a_cavity_softens_a_ball() {
        let geometry = crate::BearingGeometry::reference_7010c();
        let contacts = crate::Side::BOTH.map(|side| HertzContact::new(&geometry, side, STEEL, STEEL));
        let diameter = geometry.ball_diameter;
        let of = |inner: f64| SphereCompliance::of_shell(STEEL, diameter, inner, &contacts);
        let (solid, unit) = (of(0.0), 1.0 / (STEEL.young_modulus * diameter));
        assert_eq!(solid, SphereCompliance::new(STEEL, diameter, &contacts));
        let pinhole = of(1e-3 * diameter);
        assert!((pinhole.own[0] / solid.own[0] - 1.0).abs() < 1e-7);
        assert!((pinhole.across.opposite() / solid.across.opposite() - 1.0).abs() < 1e-7);
        let half = of(0.5 * diameter);
        let more = (solid.own[1] - half.own[1]) / unit;
        assert!((more - 0.90).abs() < 0.01, "{more}");
        let more = (half.across.opposite() - solid.across.opposite()) / unit;
        assert!((more - 0.40).abs() < 0.01, "{more}");
        let wall = least_wall(&contacts);
        assert!((2.0e-3..2.5e-3).contains(&wall), "{wall}");
    }

    /// Wrong: the polynomial over the angle between the contacts is not the series, or not its bits at opposite ones.
    /// The series ends with an alternating term of 1e-10 there and of nothing at other angles.
    #[test]
    fn across_is_the_series_at_any_angle() {
        let geometry = crate::BearingGeometry::reference_7010c();
        let contacts = crate::Side::BOTH.map(|side| HertzContact::new(&geometry, side, STEEL, STEEL));
        let across = SphereCompliance::new(STEEL, geometry.ball_diameter, &contacts).across;
        let series = LegendreSeries::new(STEEL, 0.5 * geometry.ball_diameter, 0.0);
        let pi = std::f64::consts::PI;
        assert_eq!(across.opposite(), series.at_angle(pi));
        for difference in [1e-3f64, 0.02, 0.1, 0.3, -0.6, 0.9, -1.04] {
            let error = across.at(difference).value - series.at_angle(pi - difference);
            assert!(error.abs() < 2e-10 * across.opposite(), "{difference}: {error}");
        }
        assert_eq!(across.stiffest(), crate::law::STIFFEST / across.opposite());
    }

    /// Wrong: sign or size. 7010C: each contact is stiffer by about 0.4/(E D), 2e-7 mm/N, under equal forces.
    #[test]
    fn a_ball_of_the_7010c_is_stiffer_than_two_half_spaces() {
        let geometry = crate::BearingGeometry::reference_7010c();
        let contacts = crate::Side::BOTH.map(|side| HertzContact::new(&geometry, side, STEEL, STEEL));
        let found = SphereCompliance::new(STEEL, geometry.ball_diameter, &contacts);
        let unit = 1.0 / (STEEL.young_modulus * geometry.ball_diameter);
        for own in found.own {
            let together = (own - found.across.opposite()) / unit;
            assert!((0.35..0.45).contains(&together), "{together}");
        }
        let across = found.across.opposite() / unit;
        assert!((across - 0.3334).abs() < 1e-3, "{across}");
    }
}
