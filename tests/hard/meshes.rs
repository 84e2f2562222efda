//! Meshes that break contact codes: slivers, crooked elements, crude grooves, seams.

use std::sync::Arc;

use contact::Side;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings};
use dynamics::{ContactMode, DynamicsError, Hold, Model, RingModel, StaticSolution, StaticSolver};

use super::bearings::{Load, RPM, SMALL, conserving, equilibrium_at, flexible, rigid, transient};
use super::record::Record;
use super::support::relative;
use super::support::rings::{Level, ring};
use super::{HardCase, Pace};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    let loaded = "2 kN axial, 1 kN radial, at rest; then half the balls unload in motion, dt 5 us, 1 ms";
    vec![
        case(
            "slivers",
            Pace::Slow,
            "a layer of elements 130 times as wide as thick below the raceway",
            loaded,
            slivers,
        ),
        case(
            "crooked_elements",
            Pace::Slow,
            "inner nodes pushed by a third of an element: no periodicity, bad angles",
            loaded,
            crooked,
        ),
        case(
            "one_element_across",
            Pace::Slow,
            "one flat element from rim to rim of the groove",
            loaded,
            one_element,
        ),
        case(
            "balls_on_the_seam",
            Pace::Fast,
            "azimuth 0 and 2 pi, where numbering of the mesh begins",
            "ball 0 at 0, +-1e-13 and 2 pi rad",
            seam,
        ),
        case(
            "ball_crosses_the_seam",
            Pace::Slow,
            "a rolling ball passes the seam and the edges of elements",
            "12 000 rpm, 2 kN, one pitch of balls and more",
            crossing,
        ),
    ]
}

/// A model with these rings under 2 kN of thrust and 1 kN of radial force.
pub fn loaded(rings: [RingModel; 2]) -> Model {
    let mut model = rigid(Load::dead(2e3), Load::dead(1e3));
    model.shaft_mass = 0.0;
    model.contact.mode = ContactMode::Patch;
    model.rings = rings.map(|r| Some(Arc::new(r)));
    model
}

pub fn rings(level: Level) -> [RingModel; 2] {
    Side::BOTH.map(|side| ring(side, level, Hold::Clamped))
}

/// Largest relative difference of ball forces.
pub fn difference(a: &StaticSolution, b: &StaticSolution) -> f64 {
    let pairs = a.balls.iter().zip(&b.balls);
    pairs
        .map(|(a, b)| relative(a.inner.force_n, b.inner.force_n))
        .fold(0.0, f64::max)
}

/// At rest against good meshes to a share, and in motion with a closed ledger.
fn at_rest_and_in_motion(record: &mut Record, rings: [RingModel; 2], share: f64) {
    let model = loaded(rings);
    let solution = equilibrium_at(&model, 0.0).unwrap();
    let good = equilibrium_at(&loaded(self::rings(SMALL)), 0.0).unwrap();
    record.below(
        "largest difference of a ball force from good meshes",
        difference(&solution, &good),
        share,
    );
    let residual = solution.shaft_residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
    record.below("balance of the shaft, N,", residual, 1e-6);
    let mut moving = loaded([0, 1].map(|_| ring(Side::Inner, SMALL, Hold::Clamped)));
    moving.rings = model.rings.clone();
    super::bearings::set_loads(&mut moving, Load::dead(1e3), Load::jump(0.0, 5e3));
    let course = transient(&moving, conserving(5e-6), 1e-3);
    record.closed(&course);
    record.that("balls unload", course.open > 0);
}

/// Number of nodes through the thickness and along the section of a revolved mesh.
fn layers(level: Level) -> [usize; 2] {
    [level.thickness + 1, 2 * level.shoulder + level.groove + 1]
}

fn slivers(record: &mut Record) {
    let mut rings = rings(SMALL);
    let mut aspect = f64::INFINITY;
    for ring in &mut rings {
        let [through, along] = layers(SMALL);
        let nodes = &mut ring.mesh.nodes;
        for i in 0..nodes.len() / through {
            let (race, back) = (nodes[through * i], nodes[through * i + through - 1]);
            // The layer below the raceway gets 1/200 of the thickness.
            nodes[through * i + 1] = [0, 1, 2].map(|c| race[c] + 0.005 * (back[c] - race[c]));
            let next = nodes[(through * (i + along)) % nodes.len()];
            let distance =
                |a: [f64; 3], b: [f64; 3]| (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt();
            aspect = aspect.min(distance(race, next) / (0.005 * distance(race, back)));
        }
        assert!(
            ring.mesh.group_nodes("raceway").iter().all(|n| n % through == 0),
            "the node order is another"
        );
    }
    record.note(format!("aspect {aspect:.0} and more"));
    record.that("the aspect is 100 or more", aspect >= 100.0);
    at_rest_and_in_motion(record, rings, 5e-2);
}

fn crooked(record: &mut Record) {
    let level = Level::hex8(54, 6, 1, 3);
    let mut rings = rings(level);
    for ring in &mut rings {
        let [through, _] = layers(level);
        let mut noise = 12345u64;
        let mut random = || {
            noise = noise
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (noise >> 33) as f64 / (1u64 << 31) as f64 - 0.5
        };
        let inner = |n: usize| (1..through - 1).contains(&(n % through));
        for n in (0..ring.mesh.nodes.len()).filter(|n| inner(*n)) {
            // An element is 3.6 mm round and about 1.4 mm the other ways.
            let [dx, dz] = [1.0e-3 * random(), 0.5e-3 * random()];
            let [x, y, _] = ring.mesh.nodes[n];
            let (sin, cos) = y.atan2(x).sin_cos();
            let half_width = 7.99e-3;
            let z = ring.mesh.nodes[n][2];
            let dz = if z.abs() >= half_width { 0.0 } else { dz };
            ring.mesh.nodes[n] = [x - dx * sin, y + dx * cos, z + dz];
        }
    }
    at_rest_and_in_motion(record, rings, 2e-2);
}

fn one_element(record: &mut Record) {
    at_rest_and_in_motion(record, rings(Level::hex8(54, 1, 1, 2)), 5e-2);
}

fn seam(record: &mut Record) {
    let mut model = loaded(rings(SMALL));
    let at = |model: &mut Model, phase: f64| {
        model.geometry.first_ball_azimuth = phase;
        equilibrium_at(model, 0.0).unwrap()
    };
    let on = at(&mut model, 0.0);
    for phase in [1e-13, -1e-13, std::f64::consts::TAU, -0.0] {
        let near = at(&mut model, phase);
        record.below(
            &format!("change of a ball force at {phase:e} rad"),
            difference(&on, &near),
            1e-9,
        );
    }
    // One sector on, all balls stand on the next edge between elements: the same bearing under a load turned backwards.
    let sector = std::f64::consts::TAU / 54.0;
    let axial = |phase: f64, model: &mut Model| {
        super::bearings::set_loads(model, Load::dead(2e3), Load::dead(0.0));
        at(model, phase)
    };
    let (here, next) = (axial(0.0, &mut model), axial(sector, &mut model));
    record.below(
        "change of a ball force one sector on, under thrust",
        difference(&here, &next),
        1e-9,
    );
}

fn crossing(record: &mut Record) {
    let mut model = flexible(Load::dead(2e3), Load::dead(0.0));
    model.geometry.first_ball_azimuth = -0.05;
    let speed = Speed::constant(12_000.0 * RPM);
    let motion = Motion::new(
        &model,
        MotionSettings {
            speeds: speed.into(),
            ..conserving(5e-6)
        },
    )
    .unwrap();
    let start = motion.start(&equilibrium_at(&model, 0.0).unwrap());
    let (mut low, mut high, mut azimuth) = (f64::INFINITY, 0.0f64, 0.0);
    let course = super::course::march_with(&motion, start, 200, |s| {
        let f = s.forces[1].norm();
        (low, high) = (low.min(f), high.max(f));
        azimuth = motion.ball_azimuth(0, motion.time(s.step));
    });
    record.closed(&course);
    record.that("ball 0 passes azimuth 0", azimuth > 0.35);
    record.below(
        "spread of its force over its mean",
        (high - low) / course.mean_forces[1],
        2e-3,
    );
}

pub fn solve(model: &Model) -> Result<StaticSolution, DynamicsError> {
    StaticSolver::new(model)?.solve(model, None)
}
