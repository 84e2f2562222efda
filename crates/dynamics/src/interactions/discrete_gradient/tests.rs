//! Forces over a step: work, orders, pulls.

use super::super::contact_damping::{ContactDamping, StepDamping, Viscous};
use super::*;

const LAW: ContactLaw = ContactLaw {
    stiffness: 2.9e10,
    patch_compliance: 2e-9,
    ball_compliance: 0.0,
};
const TOUCHING: f64 = 0.15e-3;
const CONSERVING: (ContactScheme, f64) = (ContactScheme::DiscreteGradient, 0.5);

/// Contacts that know nothing of each other, and those of a sphere.
fn balls() -> [BallLaws; 2] {
    let sphere = |ball_compliance: f64| ContactLaw {
        ball_compliance,
        ..LAW
    };
    [
        BallLaws {
            laws: [LAW; 2],
            across: 0.0,
            stiffest: f64::INFINITY,
        },
        BallLaws {
            laws: [sphere(4e-10), sphere(3e-10)],
            across: 1.8e-10,
            stiffest: 2.8e9,
        },
    ]
}

fn paths() -> Vec<[[f64; 2]; 2]> {
    let mut cases = Vec::new();
    for d0 in [-3e-6, 0.0, 1e-7, 5e-6] {
        for change in [1e-13, 1e-9, 3e-8, 1e-6, -4e-6] {
            let point = |d: f64, angle: f64| [(TOUCHING + d) * angle.cos(), (TOUCHING + d) * angle.sin()];
            cases.push([point(d0, 0.3), point(d0 + change, 0.31)]);
        }
    }
    cases
}

/// Every path of one contact with every third one of the other.
fn cases() -> Vec<BallLengths> {
    let (touching, paths) = ([TOUCHING; 2], paths());
    let other = |first: [[f64; 2]; 2]| {
        let pair = move |second: &[[f64; 2]; 2]| BallLengths {
            touching,
            l: [first, *second],
        };
        paths.iter().step_by(3).map(pair).collect::<Vec<_>>()
    };
    paths.iter().flat_map(|first| other(*first)).collect()
}

fn energy(laws: &BallLaws, lengths: &BallLengths, end: usize) -> f64 {
    let at = laws.evaluate(lengths.approaches()[end]);
    at.contacts[0].energy + at.contacts[1].energy
}

fn growth(l: [[f64; 2]; 2]) -> [f64; 2] {
    [l[1][0] - l[0][0], l[1][1] - l[0][1]]
}

/// Wrong: contact would make or lose energy. F . (l1 - l0) = V1 - V0, to the round-off of the energies.
#[test]
fn the_discrete_gradient_exchanges_exactly_the_stored_energy() {
    for laws in balls() {
        for lengths in cases() {
            let found = mean_forces((&laws, &[laws; 2]), &lengths, CONSERVING, None);
            let work: f64 = (0..2)
                .map(|k| {
                    let (f, d) = (found.contacts[k].force, growth(lengths.l[k]));
                    f[0] * d[0] + f[1] * d[1]
                })
                .sum();
            let (start, end) = (energy(&laws, &lengths, 0), energy(&laws, &lengths, 1));
            let scale = start.abs().max(end.abs()).max(1e-12);
            assert!((work - end + start).abs() < 1e-9 * scale, "{lengths:?}");
        }
    }
}

/// Wrong: a dissipating integrator would gain energy in the contacts, or pull on a ball.
#[test]
fn the_weighted_discrete_gradient_only_takes_energy() {
    for laws in balls() {
        for lengths in cases() {
            for weight in [0.0, 0.3] {
                let scheme = (ContactScheme::DiscreteGradient, weight);
                let found = mean_forces((&laws, &[laws; 2]), &lengths, scheme, None);
                let loss: f64 = found.contacts.iter().map(|f| f.numerical_loss).sum();
                assert!(loss >= 0.0, "{lengths:?}: {loss}");
                for (f, l) in found.contacts.iter().zip(lengths.l) {
                    let pull = f.force[0] * (l[0][0] + l[1][0]) + f.force[1] * (l[0][1] + l[1][1]);
                    assert!(pull >= -1e-12 * size(f.force) * size(l[0]), "{pull}");
                }
            }
        }
    }
}

fn step(law: &ContactDamping, dt: f64) -> StepDamping<'_> {
    let passing = 3e-9;
    StepDamping { law, dt, passing }
}

fn damped(damping: Option<&ContactDamping>, lengths: &BallLengths) -> Option<[Viscous; 2]> {
    damping.map(|d| lengths.l.map(|l| step(d, 1e-5).viscous(TOUCHING, l)))
}

/// Wrong: Newton would use a wrong tangent. Difference quotients, all schemes.
#[test]
fn tangents_are_derivatives() {
    let damping = ContactDamping {
        coefficient: 50.0,
        full_approach: 1e-6,
    };
    for scheme in [
        CONSERVING,
        (ContactScheme::DiscreteGradient, 0.3),
        (ContactScheme::Pointwise, 0.4),
    ] {
        for (laws, damping) in balls().into_iter().zip([Some(&damping), None]) {
            for lengths in cases() {
                check_tangents(&laws, &lengths, scheme, damping);
            }
        }
    }
}

fn check_tangents(
    laws: &BallLaws,
    lengths: &BallLengths,
    scheme: (ContactScheme, f64),
    damping: Option<&ContactDamping>,
) {
    let at =
        |lengths: &BallLengths| mean_forces((laws, &[*laws; 2]), lengths, scheme, damped(damping, lengths));
    let (found, h) = (at(lengths), 1e-11);
    for (k, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let (mut low, mut high) = (*lengths, *lengths);
        low.l[k][1][j] -= h;
        high.l[k][1][j] += h;
        let (low, high) = (at(&low), at(&high));
        for i in 0..2 {
            let quotient = |c: usize| (high.contacts[c].force[i] - low.contacts[c].force[i]) / (2.0 * h);
            let (exact, across) = (found.contacts[k].tangent[i][j], found.across[1 - k][i][j]);
            // Cases nearer to a kink of the law than h show half the damping.
            let kink = if damping.is_some() { 3e6 } else { 1e5 };
            assert!(
                (quotient(k) - exact).abs() < 2e-2 * exact.abs() + kink,
                "{scheme:?} {lengths:?}: {} {exact}",
                quotient(k)
            );
            // What drops the pull of a force is left out of the other contact's share.
            if scheme != (ContactScheme::DiscreteGradient, 0.3) {
                assert!(
                    (quotient(1 - k) - across).abs() < 2e-2 * across.abs() + kink,
                    "{scheme:?} {lengths:?}: {} {across}",
                    quotient(1 - k)
                );
            }
        }
    }
}

/// Wrong: damping would feed energy or pull on a ball.
#[test]
fn damping_only_takes_energy_and_never_pulls() {
    let damping = ContactDamping {
        coefficient: 5e4,
        full_approach: 1e-6,
    };
    for laws in balls() {
        for lengths in cases() {
            let viscous = lengths.l.map(|l| step(&damping, 1e-6).viscous(TOUCHING, l));
            let found = mean_forces((&laws, &[laws; 2]), &lengths, CONSERVING, Some(viscous));
            for (f, l) in found.contacts.iter().zip(lengths.l) {
                assert!(f.loss >= 0.0, "{}", f.loss);
                assert!(f.force[0] * (l[0][0] + l[1][0]) + f.force[1] * (l[0][1] + l[1][1]) >= 0.0);
            }
        }
    }
}
