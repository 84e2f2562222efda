//! Bearings with one rigid and one flexible ring: natural modes beside those of the shaft that turns, at rest.

use contact::Side;
use dynamics::effects::{AxialForce, SpringPreload};
use dynamics::interactions::seat_spring::Seat;
use dynamics::model::ShaftInertia;
use dynamics::modes::{ModesSettings, bearing_modes};
use dynamics::whirl::{TurningShaft, turning_inertia};
use dynamics::{Backend, ContactMode, DampingLaws, Hold, Linearisation, Model, StaticSolver};
use input::Schedule;

use crate::support::rings::Level;
use crate::support::{Case, relative};

const LOAD: f64 = 2000.0;

fn with_one_ring(rigid: Side) -> Model {
    let case = Case {
        free_tilt: true,
        ..Case::axial(LOAD)
    };
    let mut model = case.flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), Hold::Clamped);
    model.rings[rigid.index()] = None;
    model.shaft_mass = 3.0;
    model.shaft_inertia = ShaftInertia {
        transverse: 3e-3,
        polar: 2e-3,
    };
    model
}

/// The same whose outer ring, next to without mass, is pressed by a spring.
fn on_a_spring(mut model: Model) -> Model {
    let seat = Seat {
        mass: 1e-6,
        force: 0.5 * LOAD,
        stiffness: 2e5,
    };
    model.effects = vec![
        Box::new(SpringPreload { seat }),
        Box::new(AxialForce {
            value: 0.5 * LOAD,
            schedule: Schedule::Constant,
        }),
    ];
    model
}

/// Lowest frequencies, Hz: natural modes, and those of the shaft that turns, without speed.
fn both(model: &Model) -> [Vec<f64>; 2] {
    let mut solver = StaticSolver::new(model).unwrap();
    let solution = solver.solve(model, None).unwrap();
    let settings = ModesSettings {
        number: 5,
        shift: None,
        backend: Backend::Auto,
    };
    let natural = bearing_modes(model, &solution, settings, &mut |_| {}).unwrap();
    let linear = Linearisation::new(model, &solver, &solution, DampingLaws::default()).unwrap();
    let shaft = TurningShaft::new(model, &linear, turning_inertia(model).unwrap(), 0.0).unwrap();
    [
        natural.modes.iter().map(|mode| mode.frequency).collect(),
        shaft.modes().unwrap().iter().map(|mode| mode.frequency).collect(),
    ]
}

/// Wrong: the natural modes would lose what carries the rigid ring where the other one is flexible: the shaft, or the
/// seat of an outer ring on a spring. Rings that yield without inertia make the difference; an outer ring on a spring
/// has its mass along the axis in the natural modes alone, 4 % of all.
#[test]
fn the_rigid_ring_of_two_stays_on_what_carries_it() {
    for rigid in Side::BOTH {
        let fixed = with_one_ring(rigid);
        let sliding = on_a_spring(with_one_ring(rigid));
        for (model, axial) in [(&fixed, 1e-3), (&sliding, 0.03)] {
            let [natural, turning] = both(model);
            assert!(natural.len() == 5 && natural[0] > 10.0, "{natural:?}");
            for (f, expected) in natural.iter().zip(&turning) {
                let most = if *expected < 100.0 { axial } else { 1e-3 };
                assert!(
                    relative(*f, *expected) < most,
                    "{rigid:?}: {natural:?} {turning:?}"
                );
            }
        }
    }
}
