//! What effects cost: nothing when they are absent, one pass over the nodes when they load rings.

use contact::Side;
use dynamics::costs::of_effects;
use dynamics::effects::{self, AxialForce, Effect, Gravity, Now, RingDamping};
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{ContactMode, Hold, Inventory, Model, StaticSolver};
use input::Schedule;
use timer::Laps;

use crate::support::Case;
use crate::support::rings::Level;

const SMALL: Level = Level::hex8(36, 4, 1, 1);

fn flexible(effects: Vec<Box<dyn Effect>>) -> Model {
    let mut model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    model.effects = effects;
    model
}

fn by_name(laps: &Laps) -> Vec<(&'static str, f64)> {
    laps.iter().map(|lap| (lap.name, lap.seconds)).collect()
}

fn settings() -> MotionSettings {
    MotionSettings::conserving(1e-5, Speed::constant(0.0))
}

/// Wrong: a scene would pay for an effect it does not name. Rigid rings have no dofs and no matrices; without effects
/// there is no load vector; every thing that is made is counted on the objects that hold it.
#[test]
fn a_scene_without_an_effect_pays_nothing() {
    let rigid = Case::axial(1000.0).rigid();
    let counted = |model: &Model| StaticSolver::new(model).unwrap().inventory();
    let none = Inventory { dofs: 0, matrices: 0 };
    assert_eq!(counted(&rigid), none);

    let bare = flexible(Vec::new());
    let n_dofs: usize = bare.rings.iter().flatten().map(|r| r.mesh.n_dofs()).sum();
    let rings = Inventory {
        dofs: n_dofs,
        matrices: 2,
    };
    assert_eq!(counted(&bare), rings, "one factor per ring");
    let loads = bare.loads(&Now::default()).unwrap();
    assert_eq!(
        loads,
        effects::Loads::none(bare.geometry.n_balls),
        "no load of any body"
    );
    assert!(loads.rings.iter().all(Option::is_none), "no nodal vector");
    assert!(loads.weights.iter().all(Option::is_none), "no weight");

    let heavy = flexible(vec![Box::new(
        Gravity::new([0.0, -9.81, 0.0], Schedule::Constant, &bare.rings).unwrap(),
    )]);
    assert_eq!(counted(&heavy), rings, "a load needs no dof and no matrix");
    let loads = heavy.loads(&Now::default()).unwrap();
    assert!(loads.weights.iter().all(Option::is_some));
    assert!(
        loads.rings.iter().all(Option::is_none),
        "a weight is no nodal vector"
    );
}

/// Wrong: motion would assemble matrices of effects that are off, or an effect that reuses K and M would be thought to.
/// Per flexible ring: mass, stiffness, and the factor of the effective matrix; damping adds none.
#[test]
fn motion_holds_three_matrices_per_flexible_ring() {
    let counted = |model: &Model, settings| Motion::new(model, settings).unwrap().inventory();
    let mut rigid = Case::axial(1000.0).rigid();
    rigid.shaft_mass = 1.0;
    let none = Inventory { dofs: 0, matrices: 0 };
    assert_eq!(counted(&rigid, settings()), none);
    let mut half = flexible(Vec::new());
    half.rings[Side::Inner.index()] = None;
    let both = counted(&flexible(Vec::new()), settings());
    let outer = counted(&half, settings());
    assert_eq!((both.matrices, outer.matrices), (6, 3));
    assert!(outer.dofs > 0 && both.dofs > 2 * outer.dofs - 1000);
    let damped = MotionSettings {
        contact_damping: Some(ContactDamping {
            coefficient: 50.0,
            full_approach: 1e-6,
        }),
        rayleigh: RingDamping {
            mass: 100.0,
            stiffness: 1e-7,
        },
        ..settings()
    };
    assert_eq!(counted(&flexible(Vec::new()), damped), both);
}

/// Wrong: the weight of a ring from nodal masses would not be the integral of its body force. Same quadrature, one
/// product more: round-off.
#[test]
fn gravity_on_nodal_masses_is_the_body_load() {
    let g = [1.5, -9.81, 0.7];
    let model = flexible(Vec::new());
    let gravity = Gravity::new(g, Schedule::Constant, &model.rings).unwrap();
    let mut loads = effects::Loads::none(model.geometry.n_balls);
    gravity.add_loads(&model, &Now::default(), &mut loads).unwrap();
    for side in Side::BOTH {
        let ring = model.ring(side).unwrap();
        let weight = g.map(|a| ring.material.density * a);
        let expected = fem::body_load(&ring.mesh, |_| weight).unwrap();
        let largest = expected.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let weight = loads.weights[side.index()].unwrap();
        let masses = ring.node_masses(side.name()).unwrap();
        assert_eq!(weight.mass, masses.total);
        let found = masses
            .masses
            .iter()
            .flat_map(|m| weight.acceleration.map(|a| m * a));
        for (a, b) in found.zip(&expected) {
            assert!((a - b).abs() < 1e-14 * largest, "{a} {b}");
        }
    }
    // The shaft carries the inner ring: mass times g.
    let ring = model.ring(Side::Inner).unwrap();
    let mass = ring.material.density * mesh::volume(&ring.mesh);
    for i in 0..3 {
        assert!((loads.ring_on_shaft[i] / (mass * g[i]) - 1.0).abs() < 1e-9);
    }
}

/// Wrong: the log of a run would charge an effect for another one, or lose one that took no time.
#[test]
fn costs_are_kept_by_effect() {
    let mut model = Case::axial(1000.0).rigid();
    model.effects = vec![Box::new(AxialForce {
        value: 1.0,
        schedule: Schedule::Constant,
    })];
    let costs = of_effects(&model);
    assert_eq!(by_name(&costs.laps()), [("axial_force", 0.0)]);
    model.timed_loads(&Now::default(), &costs).unwrap();
    let before = costs.laps();
    assert_eq!(by_name(&before).len(), 1);
    let answer = costs.time("contact_damping", || {
        std::thread::sleep(std::time::Duration::from_millis(5));
        7
    });
    let after = costs.laps();
    assert_eq!(answer, 7);
    assert_eq!(after.seconds("axial_force"), before.seconds("axial_force"));
    assert!(after.seconds("contact_damping") >= 5e-3);
}

/// Wrong: the log of a run would not say what damping costs, or would show damping that is off. Both dampings are
/// inside the steps.
#[test]
fn dampings_are_charged_in_a_motion() {
    let model = flexible(vec![Box::new(AxialForce {
        value: 1000.0,
        schedule: Schedule::Constant,
    })]);
    let lines = |settings| {
        let motion = Motion::new(&model, settings).unwrap();
        let solution = StaticSolver::new(&model).unwrap().solve(&model, None).unwrap();
        motion
            .step(&motion.start(&solution), &mut StepCache::default())
            .unwrap();
        motion.costs.laps()
    };
    let plain = lines(settings());
    assert!(plain.iter().map(|lap| lap.name).eq(["axial_force"]));
    let damped = MotionSettings {
        contact_damping: Some(ContactDamping {
            coefficient: 50.0,
            full_approach: 1e-6,
        }),
        rayleigh: RingDamping {
            mass: 100.0,
            stiffness: 1e-7,
        },
        ..settings()
    };
    let charged = lines(damped);
    for name in ["contact_damping", "rayleigh_damping"] {
        assert!(charged.seconds(name) > 0.0, "{charged:?}");
    }
}
