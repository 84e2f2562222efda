//! Forces of contacts that are not opposite: work, derivatives, convexity.

use super::*;

const TOUCHING: f64 = 0.15e-3;
const CONSERVING: (ContactScheme, f64) = (ContactScheme::DiscreteGradient, 0.5);

/// A ball of a 7010C, without its patches, and one that pushes the other contact out at 35 deg and more, as a thin
/// shell does.
fn balls() -> [BallContacts; 2] {
    let law = |ball_compliance: f64| ContactLaw {
        stiffness: 2.9e10,
        patch_compliance: 2e-9,
        ball_compliance,
    };
    let of = |mean: f64| BallContacts {
        laws: [law(4e-10), law(3e-10)],
        across: AcrossCompliance::new(|angle| 3e-10 * (0.5 / (0.5 * angle).sin() - mean)),
    };
    let shell = BallContacts {
        across: AcrossCompliance::new(|angle| -2e-9 * (angle.cos() + 0.8)),
        ..of(0.0)
    };
    [of(-0.1), shell]
}

/// l of a contact at an approach, m, and a contact angle, rad.
fn place(side: usize, approach: f64, angle: f64) -> [f64; 2] {
    let length = SIGNS[side] * (TOUCHING + approach);
    [length * angle.cos(), length * angle.sin()]
}

fn cases() -> Vec<BallLengths> {
    let mut cases = Vec::new();
    let approaches = [
        [5e-6, 6e-6],
        [1e-7, 5e-6],
        [-3e-7, 5e-6],
        [4e-6, 2e-8],
        [-1e-8, 4e-6],
    ];
    let steps = [
        [0.0; 2],
        [1e-13, -1e-13],
        [3e-8, -2e-8],
        [1e-6, 2e-6],
        [-4e-6, 1e-6],
        [4e-7, 0.0],
    ];
    for g in approaches {
        for step in steps {
            for angles in [[0.26, 0.26], [0.5, 0.1], [0.9, -0.1]] {
                for turns in [[0.0; 2], [1e-9, 0.0], [1e-4, -3e-4], [0.05, 0.01], [-0.1, 0.2]] {
                    let of = |k: usize| {
                        let start = place(k, g[k], angles[k]);
                        [start, place(k, g[k] + step[k], angles[k] + turns[k])]
                    };
                    cases.push(BallLengths {
                        touching: [TOUCHING; 2],
                        l: [of(0), of(1)],
                    });
                }
            }
        }
    }
    cases
}

fn energy(ball: &BallContacts, lengths: &BallLengths, end: usize) -> f64 {
    let found = ball
        .instant(lengths.approaches()[end], lengths.at(end).map(Meridian::from))
        .0;
    found.contacts[0].energy + found.contacts[1].energy
}

fn work(found: &BallMeans, lengths: &BallLengths) -> f64 {
    let of = |k: usize| {
        let (f, [l0, l1]) = (found.contacts[k].force, lengths.l[k]);
        f[0] * (l1[0] - l0[0]) + f[1] * (l1[1] - l0[1])
    };
    of(0) + of(1)
}

/// Wrong: contacts would make or lose energy where the angle between them changes. F . (l1 - l0) = V1 - V0, to the
/// round-off of the energies.
#[test]
fn the_work_over_a_step_is_the_change_of_the_energy() {
    for ball in balls() {
        for lengths in cases() {
            let found = ball.mean_forces(&lengths, CONSERVING, None);
            let (start, end) = (energy(&ball, &lengths, 0), energy(&ball, &lengths, 1));
            let lack = work(&found, &lengths) - end + start;
            let scale = start.max(end).max(1e-12);
            assert!(lack.abs() < 1e-9 * scale, "{lengths:?}: {lack} {scale}");
        }
    }
}

/// Wrong: forces over no step would not be those of an instant, or those not the gradient of the energy.
#[test]
fn forces_of_an_instant_are_the_gradient_of_the_energy() {
    for ball in balls() {
        for lengths in cases() {
            let l = lengths.at(1);
            let still = BallLengths {
                l: l.map(|l| [l, l]),
                ..lengths
            };
            let found = ball.mean_forces(&still, CONSERVING, None);
            let (at, lateral) = ball.instant(still.approaches()[1], l.map(Meridian::from));
            for k in 0..2 {
                let across = lateral.expect("the ball couples")[k].force(unit(l[k]).into(), size(l[k]));
                for (i, across) in across.to_array().into_iter().enumerate() {
                    let force = at.contacts[k].force * unit(l[k])[i] + across;
                    let mean = found.contacts[k].force[i];
                    assert!(
                        (mean - force).abs() < 1e-9 * (1.0 + force.abs()),
                        "{mean} {force}"
                    );
                    let h = 1e-11;
                    let moved = |h: f64| {
                        let mut moved = still;
                        moved.l[k][1][i] += h;
                        energy(&ball, &moved, 1)
                    };
                    let slope = (moved(h) - moved(-h)) / (2.0 * h);
                    assert!((slope - force).abs() < 1e-3 + 1e-4 * size(found.contacts[k].force));
                }
            }
        }
    }
}

/// Wrong: Newton would use a wrong tangent. Difference quotients, all schemes and at an instant.
#[test]
fn tangents_are_derivatives() {
    let dissipating = (ContactScheme::DiscreteGradient, 0.3);
    for scheme in [CONSERVING, dissipating, (ContactScheme::Pointwise, 0.4)] {
        for ball in balls() {
            for lengths in cases() {
                let at = |lengths: &BallLengths| ball.mean_forces(lengths, scheme, None);
                check_tangents(&lengths, scheme == dissipating, at);
            }
        }
    }
}

fn check_tangents(lengths: &BallLengths, drops: bool, at: impl Fn(&BallLengths) -> BallMeans) {
    let (found, h) = (at(lengths), 2e-11);
    // What drops the pull of a force is left out of the other contact's share, and quotients over an opening are none.
    let presses = |d: [f64; 2]| d.into_iter().all(|d| d > 1e-7);
    let is_pressed = lengths.approaches().into_iter().all(presses);
    for (k, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let moved = |h: f64| {
            let mut moved = *lengths;
            moved.l[k][1][j] += h;
            at(&moved)
        };
        let (low, high) = (moved(-h), moved(h));
        for i in 0..2 {
            let quotient = |c: usize| (high.contacts[c].force[i] - low.contacts[c].force[i]) / (2.0 * h);
            let stiffness = found.contacts[k].tangent.as_flattened().iter();
            let largest = stiffness.fold(0.0f64, |most, t| most.max(t.abs()));
            let kink = if is_pressed {
                2e-5 * largest + 10.0
            } else {
                2e-2 * largest + 1e5
            };
            let own = quotient(k) - found.contacts[k].tangent[i][j];
            assert!(own.abs() < kink, "{lengths:?} {k}{i}{j}: {own} {largest}");
            let other = quotient(1 - k) - found.across[1 - k][i][j];
            assert!(
                other.abs() < kink || (drops && !is_pressed),
                "{lengths:?} {k}{i}{j}: {other} {largest}"
            );
        }
    }
}

/// Wrong: an equilibrium of balls would not be the minimum of a convex energy. The tangent over both lengths l is
/// symmetric and has no negative eigenvalue up to 60 deg between the contact angles and 1 kN; over no step it is half
/// of that of an instant.
#[test]
fn the_energy_is_convex_in_both_lengths() {
    let ball = balls()[0];
    for approach in [1e-9, 1e-7, 2e-6, 8e-6] {
        for other in [1e-8, 1e-6, 9e-6] {
            for difference in [0.0, 0.1, 0.35, 0.7, -1.05] {
                let l = [place(0, approach, 0.3 + difference), place(1, other, 0.3)];
                let lengths = BallLengths {
                    touching: [TOUCHING; 2],
                    l: l.map(|l| [l, l]),
                };
                let found = ball.mean_forces(&lengths, CONSERVING, None);
                let entry = |row: usize, column: usize| match row / 2 == column / 2 {
                    true => 2.0 * found.contacts[row / 2].tangent[row % 2][column % 2],
                    false => 2.0 * found.across[row / 2][row % 2][column % 2],
                };
                let matrix: Vec<f64> = (0..16).map(|i| entry(i / 4, i % 4)).collect();
                let largest = matrix.iter().fold(0.0f64, |most, k| most.max(k.abs()));
                for (i, value) in matrix.iter().enumerate() {
                    let mirrored = matrix[4 * (i % 4) + i / 4];
                    assert!((value - mirrored).abs() < 1e-9 * largest, "{value} {mirrored}");
                }
                let (values, _) = dense::symmetric_eigen(4, &matrix).unwrap();
                assert!(
                    values[0] > -1e-12 * largest,
                    "{approach} {other} {difference}: {values:?}"
                );
            }
        }
    }
}

/// Wrong: an integrator that dissipates would gain energy in contacts that turn against each other.
#[test]
fn the_weighted_discrete_gradient_only_takes_energy() {
    for lengths in cases() {
        let scheme = (ContactScheme::DiscreteGradient, 0.3);
        let found = balls()[0].mean_forces(&lengths, scheme, None);
        let loss: f64 = found.contacts.iter().map(|f| f.numerical_loss).sum();
        let scale = energy(&balls()[0], &lengths, 0).max(energy(&balls()[0], &lengths, 1));
        assert!(loss >= -1e-13 * scale, "{lengths:?}: {loss}");
    }
}
