//! Small loads on a ring that its shaft has moved far: the play of the bearing is a thousand times its elastic
//! deflection.

use body::BesideRing;
use contact::Side;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, StepCache};
use dynamics::{Backend, Hold, Model, RingModel};
use ring::{BodySettings, Frame, Partner, elastic_body};

use super::HEX8;
use super::missing::keyed;
use super::{bearing, twisted};
use crate::support::{Case, equilibrium};

/// All ways to solve a ring, clamped and in its mean motion.
fn cases() -> Vec<(&'static str, Model)> {
    let mut cases = Vec::new();
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        for (name, backend) in [
            ("cyclic", Backend::Cyclic),
            ("sparse", Backend::Sparse),
            ("sector", Backend::Sector(Default::default())),
        ] {
            cases.push((name, bearing(HEX8, hold, backend)));
        }
        let mut asymmetric = bearing(HEX8, hold, Backend::Cyclic);
        twisted(&mut asymmetric);
        cases.push(("cyclic, twisted", asymmetric));
        cases.push(("cyclic with a keyway", keyed(HEX8, hold, Backend::Cyclic)));
    }
    cases
}

/// The same bearing under another axial force alone, with a shaft that may tilt.
fn pulled(model: Model, axial: f64) -> Model {
    let case = Case {
        free_tilt: true,
        ..Case::axial(axial)
    };
    let rigid = case.rigid();
    Model {
        rings: model.rings,
        contact: model.contact,
        backend: model.backend,
        ..rigid
    }
}

/// A smooth field of 1 nm that leaves held nodes where they are, `[n_dofs]`.
fn small_field(ring: &RingModel, held: &[usize]) -> Vec<f64> {
    let field = |x: &[f64; 3]| {
        [
            1e-9 * (200.0 * x[1]).sin(),
            1e-9 * (150.0 * x[2]).cos(),
            1e-9 * (100.0 * x[0]).sin(),
        ]
    };
    let mut u: Vec<f64> = ring.mesh.nodes.iter().flat_map(field).collect();
    held.iter().for_each(|&node| u[3 * node..3 * node + 3].fill(0.0));
    u
}

/// Wrong: a rigid motion would change the strain energy of a deformed ring by its round-off, which a ledger takes for
/// energy that came from nowhere. 1 mm of translation and 1 mrad of tilt on deformations of 1 nm, less the energy of
/// the rigid motion alone, which is that of the round-off of K: the sum has the deformations to 1e-10.
#[test]
fn a_rigid_motion_does_not_change_the_strain_energy() {
    for (name, model) in cases() {
        let ring = model.ring(Side::Inner).unwrap();
        let settings = BodySettings {
            partner: Partner::SHAFT,
            damping: [0.0; 2],
            backend: model.backend,
            frame: Frame::Still,
        };
        let body = elastic_body("inner", ring, settings).unwrap();
        let u = small_field(ring, &body.held().coordinates.held_nodes());
        let energy = |u: &[f64], q: [f64; 5]| {
            body.energies(&body.rigid_state((u, BesideRing::default()), [q, [0.0; 5]], 0.0))[1]
        };
        let (undeformed, far) = (vec![0.0; u.len()], [1e-3, -1e-3, 1e-3, 1e-3, -1e-3]);
        let expected = energy(&u, [0.0; 5]);
        let found = energy(&u, far) - energy(&undeformed, far);
        println!("{name}: {expected:e} J, changed by {:e}", found / expected - 1.0);
        assert!(
            (found / expected - 1.0).abs() < 1e-8,
            "{name}: {found:e} J for {expected:e} J"
        );
    }
}

/// Wrong: the ledger would stop a motion under small loads, pulled through its axial play of 0.2 mm, where strain
/// energies are 1e-11 of k d^2. The equilibrium it starts from is known to 1e-10 of the loads.
#[test]
fn the_ledger_closes_under_small_loads_at_the_far_end_of_the_play() {
    for (name, model) in cases() {
        let model = pulled(model, -0.1);
        let start = equilibrium(&model);
        let settings = MotionSettings::conserving(2e-5, Speed::constant(0.0));
        let motion = Motion::new(&model, settings).unwrap();
        let (mut state, mut cache) = (motion.start(&start), StepCache::default());
        assert!(
            state.shaft[2] < -1e-4,
            "the play is that of {:e} m",
            state.shaft[2]
        );
        for _ in 0..10 {
            state = motion.step(&state, &mut cache).unwrap().0;
        }
        let defect = state.ledger.relative_defect();
        println!("{name}: defect {defect:e}");
        assert!(defect.abs() < 1e-7, "{name}: {defect:e}, {:?}", state.ledger);
    }
}

/// Wrong: a bearing that drifts freely at 0.1 mm/s would be stopped by round-off of its positions with blame on step
/// and scheme. All of its energy is 1e-9 J; what the ledger misses must stay below the energy of round-off, and that
/// far below the energies of a bearing under load.
#[test]
fn a_slow_drift_loses_no_more_than_round_off() {
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let mut model = pulled(bearing(HEX8, hold, Backend::Cyclic), 0.0);
        model.effects.clear();
        model.shaft_mass = 0.1;
        let settings = MotionSettings::conserving(2e-4, Speed::constant(0.0));
        let motion = Motion::new(&model, settings).unwrap();
        let mut state = motion.rest([0.0; 5], [0.0, 0.0, -1e-4, 0.0, 0.0]);
        let (mut cache, mut worst) = (StepCache::default(), 0.0f64);
        for _ in 0..600 {
            state = motion.step(&state, &mut cache).unwrap().0;
            let floor = motion.energy_round_off(&state).unwrap();
            let closes = state.ledger.relative_defect().abs() <= 1e-6;
            assert!(
                closes || state.ledger.defect().abs() <= floor,
                "{:?}, {floor:e}",
                state.ledger
            );
            worst = worst.max(state.ledger.relative_defect().abs());
        }
        let floor = motion.energy_round_off(&state).unwrap();
        println!(
            "largest relative defect {worst:e}, round-off {floor:e} J of {:e} J",
            state.ledger.largest
        );
        assert!(floor < 1e-9, "{floor:e} J would hide what a loaded bearing loses");
    }
}
