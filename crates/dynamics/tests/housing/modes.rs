//! Natural modes of a ring in an elastic body: against a rigid partner, and against ring and body meshed as one.

use std::sync::Arc;

use body::{SeatBasis, SeatTie};
use contact::Side;
use dynamics::modes::{bearing_modes, ring_modes};
use dynamics::{Backend, Hold, Mode, ModesSettings, RingModel, RingSupport};

use super::{bearing, equilibrium, harmonics, outer, space, surrounding, tied, tube};
use crate::support::steel;

/// Modes that are compared.
const NUMBER: usize = 10;

fn settings(number: usize, backend: Backend) -> ModesSettings {
    ModesSettings {
        number,
        shift: None,
        backend,
    }
}

/// Modes of the outer ring as it is held.
fn of_ring(ring: &RingModel, backend: Backend) -> Vec<Mode> {
    let found = ring_modes(
        Side::Outer,
        ring,
        RingSupport::AsHeld,
        settings(NUMBER, backend),
        &mut |_| (),
    );
    found.unwrap().modes
}

/// Modes of a bearing with this outer ring about its equilibrium.
fn of_bearing(ring: RingModel, backend: Backend) -> Vec<Mode> {
    let model = bearing(ring, backend);
    let settings = settings(NUMBER, backend);
    let found = bearing_modes(&model, &equilibrium(&model), settings, &mut |_| ());
    let modes = found.unwrap().modes;
    assert!(modes.iter().all(|mode| !mode.is_rigid));
    modes
}

/// The outer ring in a tube that moves by `n` harmonics and its modes below a frequency, Hz.
fn in_tube(n: usize, below: f64) -> RingModel {
    let (own, _) = tube(&outer(Hold::Clamped), 3);
    let body = surrounding(own, space(&outer(Hold::MeanMotion), harmonics(n, 2)), steel());
    let modes = Arc::new(body.modes(below).unwrap());
    tied(SeatTie::to_seat(Arc::new(body), 0).in_motion(modes))
}

/// Ring and tube as one mesh.
fn one_mesh() -> RingModel {
    RingModel {
        mesh: tube(&outer(Hold::Clamped), 3).1,
        held_group: "feet",
        ..outer(Hold::Clamped)
    }
}

/// Largest difference of frequencies, relative.
fn off(found: &[Mode], expected: &[Mode]) -> f64 {
    assert_eq!([found.len(), expected.len()], [NUMBER; 2]);
    let pairs = found.iter().zip(expected);
    let each = pairs.map(|(a, b)| (a.frequency / b.frequency - 1.0).abs());
    each.fold(0.0, f64::max)
}

fn require_known(modes: &[Mode]) {
    for mode in modes {
        let told = [mode.frequency, mode.bound, mode.residual];
        assert!(
            mode.bound < 1e-6 * mode.frequency && mode.residual < 1e-6,
            "{told:?}"
        );
    }
}

/// Wrong: the joint would hold a vibrating ring more or less than the mean motion when it ties nothing else.
#[test]
fn the_six_rigid_functions_on_a_rigid_body_are_the_mean_motion() {
    let held = outer(Hold::MeanMotion);
    let rigid = tied(SeatTie::to_rigid(space(&held, SeatBasis::Rigid)));
    let found = of_ring(&rigid, Backend::Auto);
    require_known(&found);
    let of_ring = off(&found, &of_ring(&held, Backend::Auto));
    assert!(of_ring < 1e-8, "{of_ring:e}");
}

/// Wrong: a ring in its housing would vibrate otherwise than the body that they are together, or more functions and
/// more modes of the housing would not come nearer to it.
#[test]
fn ring_and_housing_have_the_modes_of_one_mesh() {
    let expected = of_ring(&one_mesh(), Backend::Sparse);
    let mut errors = Vec::new();
    for (n, below) in [(2, 100e3), (6, 100e3), (12, 2e3), (12, 100e3)] {
        let found = of_ring(&in_tube(n, below), Backend::Auto);
        require_known(&found);
        assert!(found.iter().all(|mode| mode.kinetic == [0.0, 1.0, 0.0, 0.0]));
        errors.push(off(&found, &expected));
    }
    let shares: Vec<f64> = of_ring(&in_tube(12, 100e3), Backend::Auto)
        .iter()
        .map(|mode| mode.kinetic_bodies[1])
        .collect();
    assert!(
        shares.iter().all(|share| *share > 0.1 && *share < 0.95),
        "{shares:?}"
    );
    println!("frequencies: {errors:?}");
    assert!(errors[3] < 1e-3, "{errors:?}");
    assert!(
        errors[3] < errors[1] && errors[1] < errors[0] && errors[3] < errors[2],
        "{errors:?}"
    );
}

/// Wrong: a loaded bearing in its housing would have other modes than with ring and housing as one mesh.
#[test]
fn a_bearing_in_its_housing_has_the_modes_of_one_mesh() {
    let expected = of_bearing(one_mesh(), Backend::Sparse);
    let found = of_bearing(in_tube(12, 100e3), Backend::Auto);
    require_known(&found);
    let all = off(&found, &expected);
    println!("frequencies of the bearing: {all:e}");
    assert!(all < 5e-3, "{all:e}");
}

/// Wrong: a solver of harmonics and one of the whole matrix would find other modes.
#[test]
fn all_solvers_of_the_ring_give_the_same_modes() {
    let [a, b] = [Backend::Cyclic, Backend::Sparse].map(|backend| of_ring(&in_tube(6, 20e3), backend));
    let all = off(&a, &b);
    assert!(all < 1e-8, "{all:e}");
    let body = |mode: &Mode| mode.shape.bodies[1].as_ref().unwrap().len();
    assert!(a.iter().all(|mode| body(mode) == body(&a[0]) && body(mode) > 0));
}
