//! Rings that are alike share their body and factors.

use ring::{FactoredBody, Integrator, MadeRing, StepScheme, body_beside};

use super::motion::on_moving_body;
use super::*;
use dynamics::kinematics::Speed;
use dynamics::motion::MotionSettings;

const SETTINGS: BodySettings = BodySettings {
    partner: Partner::AT_REST,
    damping: [0.0; 2],
    backend: Backend::Auto,
    frame: Frame::Still,
};

fn scheme(dt: f64) -> StepScheme {
    StepScheme {
        integrator: Integrator::average_acceleration(),
        dt,
    }
}

fn beside(
    made: &[(&RingModel, &Arc<FactoredBody>)],
    ring: &RingModel,
    settings: BodySettings,
) -> Arc<FactoredBody> {
    let made: Vec<MadeRing<'_>> = made
        .iter()
        .map(|&(ring, body)| MadeRing {
            ring,
            settings: SETTINGS,
            body,
        })
        .collect();
    body_beside("outer", ring, settings, &made).unwrap()
}

/// Wrong: a ring would share the body of one of another mesh, hold or damping, or not that of its like.
#[test]
fn only_rings_that_are_alike_share_a_body() {
    let first = outer(Hold::Clamped);
    let body = beside(&[], &first, SETTINGS);
    let of_first = [(&first, &body)];
    let is_shared = |ring: &RingModel, settings| Arc::ptr_eq(&body, &beside(&of_first, ring, settings));
    assert!(is_shared(&outer(Hold::Clamped), SETTINGS));
    assert!(!is_shared(&outer(Hold::MeanMotion), SETTINGS));
    let damped = BodySettings {
        damping: [1.0, 0.0],
        ..SETTINGS
    };
    assert!(!is_shared(&outer(Hold::Clamped), damped));
    let mut moved = outer(Hold::Clamped);
    let mut nodes: Vec<[f64; 3]> = moved.mesh.nodes.to_vec();
    nodes.iter_mut().for_each(|x| x[2] += 1e-9);
    moved.mesh.nodes = nodes.into();
    assert!(!is_shared(&moved, SETTINGS));
    let on_body = on_moving_body(wrapped(&first, 2, 1.45, |_| true).0, 3, 30e3);
    assert!(!is_shared(&on_body, SETTINGS));
    let [a, b] = [(); 2].map(|()| body.factor(scheme(1e-5)).unwrap());
    assert!(Arc::ptr_eq(&a, &b), "a factor is made once");
    assert!(!Arc::ptr_eq(&a, &body.factor(scheme(5e-6)).unwrap()));
}

/// Wrong: a ring tied to another body, or by other functions, would move with the body of its like. Bearings side by
/// side, in housings of different thickness, have the bits of each alone.
#[test]
fn motions_beside_each_other_have_the_bits_of_each_alone() {
    let model = |layers: usize, orders: usize| {
        let (own, _) = tube(&outer(Hold::Clamped), layers);
        bearing(on_moving_body(own, orders, 30e3), Backend::Auto)
    };
    let models = [model(2, 6), model(3, 6), model(3, 5)];
    let settings = || MotionSettings::conserving(2e-6, Speed::constant(300.0));
    let mut together: Vec<Motion<'_>> = Vec::new();
    for model in &models {
        together.push(Motion::beside(&together, model, settings()).unwrap());
    }
    for (model, beside) in models.iter().zip(&together) {
        let alone = Motion::new(model, settings()).unwrap();
        let start = alone.start(&equilibrium(model));
        let [expected, found] = [&alone, beside].map(|motion| every_fifth(motion, start.clone(), 10));
        assert!(expected == found);
    }
}
