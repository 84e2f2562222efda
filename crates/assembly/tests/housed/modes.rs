//! Natural modes of two bearings in one sleeve, or on one hollow shaft: against two bodies, and the order of the list.

use assembly::modes::modes;
use dynamics::modes::ModeOfSeveral;
use dynamics::{Backend, ModesSettings};

use super::shaft::{HELD_BELOW, on_one, on_one_turned, on_two};
use super::*;

/// Modes that are compared.
const NUMBER: usize = 16;
/// Modes that are searched, with those beside the bearings.
const SEARCHED: usize = 40;

fn of(mut list: Assembly) -> Vec<ModeOfSeveral> {
    let solution = at_rest(&mut list);
    let settings = ModesSettings {
        number: SEARCHED,
        shift: None,
        backend: Backend::Auto,
    };
    let found = modes(&list, &solution, settings, &mut |_| ());
    let found = found.unwrap_or_else(|e| panic!("{e}")).modes.into_iter();
    let found = found.filter(|mode| !is_beside(mode));
    let found: Vec<_> = found.take(NUMBER).collect();
    for ModeOfSeveral { whole, .. } in &found {
        let told = [whole.frequency, whole.bound, whole.residual];
        assert!(
            whole.bound < 1e-6 * whole.frequency && whole.residual < 1e-6,
            "{told:?}"
        );
    }
    found
}

/// Whether a part of a body vibrates that carries no ring: the two sleeves have the part of the other in their mesh.
fn is_beside(mode: &ModeOfSeveral) -> bool {
    mode.whole.kinetic_bodies.iter().sum::<f64>() > 1.0 - 1e-9
}

/// Largest difference of frequencies, relative.
fn apart(found: &[ModeOfSeveral], expected: &[ModeOfSeveral]) -> f64 {
    assert_eq!([found.len(), expected.len()], [NUMBER; 2]);
    let pairs = found.iter().zip(expected);
    let each = pairs.map(|(a, b)| (a.whole.frequency / b.whole.frequency - 1.0).abs());
    each.fold(0.0, f64::max)
}

/// Wrong: rings would feel each other where nothing joins their seats, or would not where one sleeve carries both; the
/// mass of the sleeve would count twice; it would matter which bearing stands first.
#[test]
fn rings_in_one_sleeve_vibrate_together() {
    let two = of(pair(in_two(), [0, 1]));
    let parts = of(pair(in_one(false, 70e9), [0, 1]));
    let off = apart(&parts, &two);
    assert!(off < 1e-8, "{off:e}");
    let joined = of(pair(in_one(true, 70e9), [0, 1]));
    let turned = of(pair(in_one_turned(), [1, 0]));
    let off = apart(&turned, &joined);
    assert!(off < 1e-6, "{off:e}");
    let off = apart(&joined, &two);
    assert!(off > 0.01, "{off:e}");
    let of_body: Vec<f64> = joined.iter().map(|mode| mode.whole.kinetic_bodies[1]).collect();
    assert!(
        of_body.iter().all(|share| (0.0..0.999).contains(share)),
        "{of_body:?}"
    );
    assert!(of_body.iter().any(|share| *share > 0.1), "{of_body:?}");
    for mode in &joined {
        let parts = mode.bearings.iter().map(|own| own.kinetic.iter().sum::<f64>());
        let sum = parts.sum::<f64>() + mode.whole.kinetic[3];
        assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        assert!(mode.bearings[0].shape.bodies[1].is_some() && mode.bearings[1].shape.bodies[1].is_none());
    }
}

/// Wrong: a hollow shaft between its bearings would not be one body, follow the rigid shaft at one of them only, or its
/// rigid motion count twice.
#[test]
fn rings_on_one_hollow_shaft_vibrate_together() {
    let list = |ties, order| tied_pair(Side::Inner, ties, order);
    let two = of(list(on_two(), [0, 1]));
    let parts = of(list(on_one(false, super::shaft::CARRIED), [0, 1]));
    let off = apart(&parts, &two);
    assert!(off < 1e-8, "{off:e}");
    let joined = of(list(on_one(true, HELD_BELOW), [0, 1]));
    let turned = of(list(on_one_turned(HELD_BELOW), [1, 0]));
    let off = apart(&turned, &joined);
    assert!(off < 1e-6, "{off:e}");
    let off = apart(&joined, &two);
    assert!(off > 0.01, "{off:e}");
}
