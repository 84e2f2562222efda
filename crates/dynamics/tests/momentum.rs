//! A free ball in a free ring: momentum.

mod support;

use contact::{Meridian, Side};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, ShaftDof};
use support::Case;
use support::rings::Level;

/// Two balls at azimuths 0 and pi in a free outer ring; the inner ring is out of reach.
fn floating() -> Model {
    let mut model = Case::axial(0.0).flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), Hold::Free);
    model.rings[0] = None;
    model.effects.clear();
    model.geometry.n_balls = 2;
    // Room between the balls and the inner ring, which stands where they lie on the bottom of its groove.
    model.geometry.inner_raceway_diameter -= 0.1e-3;
    let back = model.geometry.ball_centre().axial - model.geometry.groove_centre(Side::Inner).axial;
    model.shaft = [0.0, 0.0, back, 0.0, 0.0].map(ShaftDof::Prescribed);
    model
}

/// Linear momentum and moment of momentum about the centre of the outer grooves of ring and balls, and what the
/// levers of linear theory leave out of the latter, the sum over time of u_c x F.
struct Momentum {
    linear: [f64; 3],
    angular: [f64; 3],
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn in_space(v: Meridian, azimuth: f64) -> [f64; 3] {
    [v.radial * azimuth.cos(), v.radial * azimuth.sin(), v.axial]
}

fn momentum(model: &Model, motion: &Motion<'_>, state: &MotionState) -> Momentum {
    let [mut linear, mut angular] = motion.ring_momentum(state, Side::Outer).unwrap();
    let (mass, centre) = (model.ball_mass(), model.geometry.ball_centre());
    let groove = model.geometry.groove_centre(Side::Outer);
    for ball in 0..2 {
        let azimuth = motion.ball_azimuth(ball, 0.0);
        let (x, v) = (state.balls[ball], state.ball_velocities[ball]);
        let p = in_space(v.map(|v| mass * v), azimuth);
        let place = centre + x - Meridian::new(0.0, groove.axial);
        let moment = cross(in_space(place, azimuth), p);
        for i in 0..3 {
            linear[i] += p[i];
            angular[i] += moment[i];
        }
    }
    Momentum { linear, angular }
}

/// Wrong: the force on the ring and on the ball would differ, or act along different lines: the torque of the normal
/// force would be missing. Two balls thrown at a free ring, one along the contact normal: linear momentum and
/// momentum about the axis are kept to round-off at every step, through impact and rebound; momentum about the other
/// axes is kept to what small displacements leave out of the ring's levers, dt u_c x F, to round-off.
#[test]
fn free_balls_in_a_free_ring_keep_their_momentum() {
    let model = floating();
    let settings = MotionSettings::conserving(2e-6, Speed::constant(0.0));
    let motion = Motion::new(&model, settings).unwrap();
    let ShaftDof::Prescribed(back) = model.shaft[2] else {
        unreachable!()
    };
    let mut state = motion.rest([0.0, 0.0, back, 0.0, 0.0], [0.0; 5]);
    state.ball_velocities = [[0.5, 0.1], [0.2, -0.15]].map(Meridian::from).to_vec();
    state = motion.with_energies(state);
    let first = momentum(&model, &motion, &state);
    let scale = model.ball_mass() * 0.5;
    let lever = model.geometry.ball_centre().radial * scale;
    let (mut hardest, mut worst, mut drift) = (0.0f64, [0.0f64; 3], [0.0; 3]);
    let mut cache = StepCache::default();
    for _ in 0..25 {
        let next = motion.step(&state, &mut cache).unwrap().0;
        for ball in 0..2 {
            let force = next.forces[2 * ball + 1];
            hardest = hardest.max(force.norm());
            let azimuth = motion.ball_azimuth(ball, 0.0);
            let mean = motion.groove_motion(&state, &next, ball, Side::Outer).unwrap();
            let left_out = cross(in_space(mean, azimuth), in_space(force, azimuth));
            (0..3).for_each(|i| drift[i] += 2e-6 * left_out[i]);
        }
        assert!(
            next.forces.iter().step_by(2).all(|f| f.norm() == 0.0),
            "the inner ring was struck"
        );
        state = next;
        let now = momentum(&model, &motion, &state);
        let change = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        worst[0] = worst[0].max(change(now.linear, first.linear) / scale);
        worst[1] = worst[1].max((now.angular[2] - first.angular[2]).abs() / lever);
        let explained = [0, 1, 2].map(|i| first.angular[i] - drift[i]);
        worst[2] = worst[2].max(change(now.angular, explained) / lever);
        assert!(state.ledger.relative_defect().abs() < 1e-10, "{:?}", state.ledger);
    }
    println!(
        "up to {hardest:.0} N; linear {:.1e}, about the axis {:.1e}, about all with levers {:.1e}; drift {:.1e}",
        worst[0],
        worst[1],
        worst[2],
        drift.iter().fold(0.0f64, |m, d| m.max(d.abs())) / lever
    );
    assert!(
        hardest > 50.0 && state.forces.iter().all(|f| f.norm() == 0.0),
        "{hardest}: no impact and rebound"
    );
    assert!(worst[0] < 1e-12 && worst[1] < 1e-12, "{worst:?}");
    assert!(worst[2] < 1e-10, "{worst:?}");
    assert!(drift.iter().all(|d| d.abs() < 1e-5 * lever), "{drift:?}");
}
