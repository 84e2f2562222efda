//! A bearing that nothing holds: momentum.

use crate::support::Case;
use crate::support::rings::Level;
use contact::{HertzContact, Meridian, Side, SphereCompliance, cross};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, ShaftDof};

/// Step, s.
const STEP: f64 = 2e-6;

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

/// Two free rings that press on their balls, which are larger than the room between them: a bearing in space.
fn pressed(n_balls: usize, level: Level) -> Model {
    let mut model = Case::axial(0.0).flexible(ContactMode::Patch, level, Hold::Free);
    model.effects.clear();
    let geometry = &mut model.geometry;
    geometry.n_balls = n_balls;
    geometry.ball_diameter = 0.5 * (geometry.outer_raceway_diameter - geometry.inner_raceway_diameter) + 4e-6;
    let elastic = dynamics::model::elastic(&model.ball_material);
    model.hertz = Side::BOTH.map(|side| HertzContact::new(&model.geometry, side, elastic, elastic));
    model.sphere = SphereCompliance::new(elastic, model.geometry.ball_diameter, &model.hertz);
    model.shaft = [ShaftDof::Prescribed(0.0); 5];
    model
}

/// Linear momentum and moment of momentum about the centre of the outer grooves, of rings and balls.
#[derive(Clone, Copy)]
struct Momentum {
    linear: [f64; 3],
    angular: [f64; 3],
}

impl Momentum {
    fn add(&mut self, [linear, angular]: [[f64; 3]; 2]) {
        for i in 0..3 {
            self.linear[i] += linear[i];
            self.angular[i] += angular[i];
        }
    }

    /// Largest change of either since another time.
    fn change(&self, since: &Momentum) -> [f64; 2] {
        let most = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        [most(self.linear, since.linear), most(self.angular, since.angular)]
    }
}

fn in_space(v: Meridian, azimuth: f64) -> [f64; 3] {
    [v.radial * azimuth.cos(), v.radial * azimuth.sin(), v.axial]
}

fn momentum(model: &Model, motion: &Motion<'_>, state: &MotionState) -> Momentum {
    let mut sum = Momentum {
        linear: [0.0; 3],
        angular: [0.0; 3],
    };
    let (mass, centre) = (model.ball_mass(), model.geometry.ball_centre());
    let groove = model.geometry.groove_centre(Side::Outer);
    for side in Side::BOTH {
        if let Some([linear, angular]) = motion.ring_momentum(state, side) {
            let beside = [0.0, 0.0, model.geometry.groove_centre(side).axial - groove.axial];
            let lever = cross(beside, linear);
            sum.add([linear, [0, 1, 2].map(|i| angular[i] + lever[i])]);
        }
    }
    for ball in 0..model.geometry.n_balls {
        let azimuth = motion.ball_azimuth(ball, 0.0);
        let (x, v) = (state.balls[ball], state.ball_velocities[ball]);
        let p = in_space(v.map(|v| mass * v), azimuth);
        let place = centre + x - Meridian::new(0.0, groove.axial);
        sum.add([p, cross(in_space(place, azimuth), p)]);
    }
    sum
}

/// What a motion keeps of its momentum.
struct Kept {
    /// Largest changes of momentum and moment of momentum over those of one ball.
    changes: [f64; 2],
    /// The same of momentum over the impulses that all contacts have passed on.
    of_impulses: f64,
    /// Largest force, N.
    largest: f64,
}

/// A bearing whose balls are thrown, over a number of steps, some of which are looked at.
fn thrown(model: &Model, velocities: Vec<[f64; 2]>, steps: usize, looked_at: usize) -> Kept {
    let motion = Motion::new(model, MotionSettings::conserving(STEP, Speed::constant(0.0))).unwrap();
    let shaft = model.shaft.map(|dof| match dof {
        ShaftDof::Prescribed(x) => x,
        ShaftDof::Free => unreachable!(),
    });
    let velocities: Vec<Meridian> = velocities.into_iter().map(Meridian::from).collect();
    let speed = velocities.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let scale = model.ball_mass() * speed;
    let lever = model.geometry.ball_centre().radial * scale;
    let mut state = motion.rest(shaft, [0.0; 5]);
    state.ball_velocities = velocities;
    state = motion.with_energies(state);
    let first = momentum(model, &motion, &state);
    let (mut most, mut worst, mut impulses, mut of_impulses) = (0.0f64, [0.0f64; 2], 0.0, 0.0f64);
    let mut cache = StepCache::default();
    for step in 1..=steps {
        state = motion.step(&state, &mut cache).unwrap().0;
        let forces = state.forces.iter().map(|f| f.norm());
        most = forces.clone().fold(most, f64::max);
        impulses += STEP * forces.sum::<f64>();
        if step % (steps / looked_at) != 0 {
            continue;
        }
        let [linear, angular] = momentum(model, &motion, &state).change(&first);
        worst = [worst[0].max(linear / scale), worst[1].max(angular / lever)];
        of_impulses = of_impulses.max(linear / impulses);
        let defect = state.ledger.relative_defect();
        assert!(defect.abs() < 1e-9, "{:?}", state.ledger);
    }
    println!(
        "up to {most:.0} N; linear {:.1e}, {of_impulses:.1e} of the impulses; angular {:.1e}",
        worst[0], worst[1]
    );
    Kept {
        changes: worst,
        of_impulses,
        largest: most,
    }
}

/// Wrong: the force on ring and ball would differ, or act along different lines, or the forces inside a ring would turn
/// it. Two balls thrown at a free ring, one along the contact normal: momentum and all of its moments are kept to
/// round-off at every step, through impact and rebound.
#[test]
fn free_balls_in_a_free_ring_keep_their_momentum() {
    let kept = thrown(&floating(), vec![[0.5, 0.1], [0.2, -0.15]], 25, 25);
    assert!(kept.largest > 50.0, "{}: no impact", kept.largest);
    assert!(
        kept.changes.iter().all(|worst| *worst < 1e-12),
        "{:?}",
        kept.changes
    );
}

/// Wrong: as above, of both rings with balls that press on both and swing across and along them.
#[test]
fn a_bearing_in_space_keeps_its_momentum() {
    let velocities = vec![[0.02, 0.01], [-0.01, 0.015], [0.005, -0.02], [0.0, 0.01]];
    let kept = thrown(&pressed(4, Level::hex8(54, 6, 1, 2)), velocities, 200, 200);
    assert!(kept.largest > 50.0, "{}: balls without load", kept.largest);
    assert!(
        kept.changes.iter().all(|worst| *worst < 1e-12),
        "{:?}",
        kept.changes
    );
    assert!(kept.of_impulses < 1e-15, "{}", kept.of_impulses);
}

/// The same over a million steps: less than one rounding of the impulses that the contacts pass on.
#[test]
#[ignore = "takes an hour; scripts/test-slow momentum"]
fn a_bearing_in_space_keeps_its_momentum_over_a_million_steps() {
    const STEPS: usize = 1_000_000;
    let velocities = vec![[0.002, 0.001], [-0.001, 0.0015], [0.0005, -0.002], [0.0, 0.001]];
    let kept = thrown(&pressed(4, Level::hex8(24, 4, 1, 1)), velocities, STEPS, 1000);
    assert!(
        kept.changes.iter().all(|worst| *worst < 5e-9),
        "{:?}",
        kept.changes
    );
    assert!(kept.of_impulses < f64::EPSILON, "{}", kept.of_impulses);
}
