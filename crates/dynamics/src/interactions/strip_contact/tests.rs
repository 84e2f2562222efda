//! Tests of contacts by strips over a step.

use std::sync::Arc;

use contact::surface::{Heights, Profiles};
use contact::{BallLaws, BearingGeometry, HertzContact, Side, StripLaw, StripSurface};

use super::*;
use crate::interactions::contact_damping::ContactDamping;
use crate::interactions::discrete_gradient::{BallLengths, mean_forces};
use crate::surfaces::{SurfacePlace, Surfaces};

const TOUCHING: f64 = 0.15e-3;
const CONSERVING: (ContactScheme, f64) = (ContactScheme::DiscreteGradient, 0.5);

fn law() -> StripLaw {
    let hertz = HertzContact::from_curvatures(14.0, 260.0, 113.7e9);
    StripLaw::new(&hertz, 4.75e-3)
}

/// A raceway with a shoulder, a dip and a bump within the ellipse.
fn strips(height: f64, shoulders: std::ops::RangeInclusive<f64>) -> Strips {
    let geometry = BearingGeometry::reference_7010c();
    let profiles = Profiles {
        tables: vec![Heights {
            azimuths: vec![0.0, 3.0],
            angles: vec![0.2, 0.27, 0.3, 0.33],
            heights: [0.0, -2e-6, 1e-6, -0.3e-6]
                .repeat(2)
                .iter()
                .map(|h| height * h)
                .collect(),
        }],
        ..Profiles::default()
    };
    let surface = StripSurface::new(law(), (&geometry, Side::Outer), Some(shoulders), &profiles);
    let surfaces = Surfaces {
        strips: [None, surface.map(Arc::new)],
        ..Surfaces::default()
    };
    surfaces.at(0, Side::Outer, SurfacePlace::at_start(1.0)).unwrap()
}

fn contact_law(compliance: f64) -> ContactLaw {
    ContactLaw {
        stiffness: law().stiffness,
        patch_compliance: compliance,
        ball_compliance: 0.0,
    }
}

fn paths() -> Vec<[[f64; 2]; 2]> {
    let point = |d: f64, angle: f64| [(TOUCHING + d) * angle.cos(), (TOUCHING + d) * angle.sin()];
    let mut cases = Vec::new();
    for d0 in [-3e-6, 1e-7, 5e-6] {
        for change in [0.0, 1e-12, 1e-9, 3e-8, 1e-6, -4e-6] {
            for turn in [0.0, 1e-9, 1e-5, 2e-3, -0.02, 0.1] {
                cases.push([point(d0, 0.3), point(d0 + change, 0.3 + turn)]);
            }
        }
    }
    cases
}

fn growth(l: [[f64; 2]; 2]) -> [f64; 2] {
    [l[1][0] - l[0][0], l[1][1] - l[0][1]]
}

/// Wrong: contact would make or lose energy. F . (l1 - l0) = V1 - V0 to the round-off of the energies, and of the
/// Gauss points where both variables change by a thousandth at most.
#[test]
fn the_discrete_gradient_exchanges_exactly_the_stored_energy() {
    let strips = strips(1.0, -0.5..=0.36);
    for compliance in [0.0, 2e-9] {
        let law = contact_law(compliance);
        let site = StripSite::new(&strips, &law, TOUCHING, 1.0);
        for l in paths() {
            let found = site.mean_force(l.map(Meridian::from), CONSERVING, None);
            let (f, d) = (found.force, growth(l));
            let [start, end] = site.energies_at_ends(l.map(Meridian::from));
            let work = f[0] * d[0] + f[1] * d[1];
            let scale = start.abs().max(end.abs()).max(1e-12);
            assert!(
                (work - end + start).abs() < 1e-9 * scale,
                "{l:?}: {work} {}",
                end - start
            );
        }
    }
}

/// Wrong: strips on a smooth groove would be another contact than Hertz's in motion.
#[test]
fn a_smooth_groove_has_the_means_of_hertz() {
    let strips = strips(0.0, -2.0..=2.0);
    let law = contact_law(2e-9);
    let site = StripSite::new(&strips, &law, TOUCHING, 1.0);
    let ball = BallLaws {
        laws: [law; 2],
        across: 0.0,
        stiffest: f64::INFINITY,
    };
    let law = ContactDamping {
        coefficient: 50.0,
        full_approach: 4e-6,
    };
    let damping = StepDamping {
        law: &law,
        dt: 1e-5,
        passing: 3e-9,
    };
    for l in paths() {
        let lengths = BallLengths {
            touching: [TOUCHING; 2],
            l: [l; 2],
        };
        for scheme in [
            CONSERVING,
            (ContactScheme::DiscreteGradient, 0.3),
            (ContactScheme::Pointwise, 0.4),
        ] {
            let viscous = [damping.viscous(TOUCHING, l); 2];
            let exact = mean_forces((&ball, &[ball; 2]), &lengths, scheme, Some(viscous)).contacts[0];
            let found = site.mean_force(l.map(Meridian::from), scheme, Some(damping));
            for i in 0..2 {
                let size = size(exact.force).max(1e-3);
                assert!(
                    (found.force[i] - exact.force[i]).abs() < 2e-7 * size,
                    "{scheme:?} {l:?}"
                );
            }
            assert!((found.loss - exact.loss).abs() < 1e-6 * exact.loss.abs() + 1e-15);
        }
    }
}

/// Wrong: Newton would use a wrong tangent. Difference quotients, all schemes, with and without damping.
#[test]
fn tangents_are_derivatives() {
    let strips = strips(1.0, -0.5..=0.36);
    let law = ContactDamping {
        coefficient: 50.0,
        full_approach: 1e-6,
    };
    let damping = StepDamping {
        law: &law,
        dt: 1e-5,
        passing: 3e-9,
    };
    let law = contact_law(2e-9);
    let site = StripSite::new(&strips, &law, TOUCHING, 1.0);
    let schemes = [
        CONSERVING,
        (ContactScheme::DiscreteGradient, 0.3),
        (ContactScheme::Pointwise, 0.4),
    ];
    for (scheme, damping) in schemes.into_iter().flat_map(|s| [(s, None), (s, Some(damping))]) {
        for l in paths() {
            let at = |l: [[f64; 2]; 2]| site.mean_force(l.map(Meridian::from), scheme, damping);
            let (found, h) = (at(l), 1e-11);
            for j in 0..2 {
                let (mut low, mut high) = (l, l);
                low[1][j] -= h;
                high[1][j] += h;
                let (low, high) = (at(low), at(high));
                for i in 0..2 {
                    let quotient = (high.force[i] - low.force[i]) / (2.0 * h);
                    let exact = found.tangent[i][j];
                    let kink = if damping.is_some() { 4e6 } else { 2e5 };
                    assert!(
                        (quotient - exact).abs() < 2e-2 * exact.abs() + kink,
                        "{scheme:?} {l:?} {i} {j}: {quotient} {exact}"
                    );
                }
            }
        }
    }
}
