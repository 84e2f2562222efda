//! A rolling bearing after its start: agreement with equilibria, and the lines of its spectra.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use crate::support::Case;
use crate::support::rings::Level;
use contact::Side;
use dynamics::balls::BallResult;
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::{Rolling, Speed};
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, QuasiStaticMotion};

/// 50 elements round each ring: no multiple of 18 balls, so that elements and balls have different lines.
const MESH: Level = Level::hex8(50, 6, 1, 2);
/// 1800 rpm, rad/s.
const SPEED: f64 = 60.0 * PI;
/// Steps per ball pitch of the outer ring, and pitches left to the start.
const PITCH_STEPS: usize = 180;
const START: usize = 1;

/// What is seen of a step: time of its middle, inner and outer forces of the balls, N; at its end, shaft x, y, z, m,
/// and the elastic radial displacement of one raceway node of each ring, m.
struct Seen {
    middle: f64,
    forces: [Vec<f64>; 2],
    shaft: [f64; 3],
    nodes: [f64; 2],
}

/// A bearing with loads along and across (N), at 1800 rpm.
struct Run {
    model: Model,
    rolling: Rolling,
    dt: f64,
    seen: Vec<Seen>,
}

impl Run {
    fn new(axial: f64, radial: f64, pitches: usize) -> Run {
        let case = Case {
            radial,
            ..Case::axial(axial)
        };
        let model = case.flexible(ContactMode::Patch, MESH, Hold::Clamped);
        let rolling = Rolling::new(&model.geometry, Speed::constant(SPEED), [0.0; 2]);
        let pitch = TAU / (model.geometry.n_balls as f64 * rolling.kinematics.cage * SPEED);
        let mut run = Run {
            dt: pitch / PITCH_STEPS as f64,
            seen: Vec::new(),
            model,
            rolling,
        };
        run.roll((START + pitches) * PITCH_STEPS);
        run
    }

    fn roll(&mut self, n: usize) {
        let nodes = Side::BOTH.map(|side| raceway_node(&self.model, side));
        let start = QuasiStaticMotion::new(&self.model, self.rolling.clone(), self.dt)
            .and_then(|mut quasi| quasi.step(0, None))
            .unwrap();
        let settings = MotionSettings {
            contact_damping: Some(ContactDamping {
                coefficient: 50.0,
                full_approach: 1e-6,
            }),
            ..MotionSettings::conserving(self.dt, self.rolling.speeds.clone())
        };
        let motion = Motion::new(&self.model, settings).unwrap();
        let mut state = motion.start(&start);
        let mut cache = StepCache::default();
        for _ in 0..n {
            state = motion.step(&state, &mut cache).unwrap().0;
            let radial = |i: usize| elastic_radial(&self.model, &motion, &state, Side::BOTH[i], nodes[i]);
            self.seen.push(Seen {
                middle: motion.time(state.step) - 0.5 * self.dt,
                forces: [0, 1].map(|i| state.forces.iter().skip(i).step_by(2).map(|f| f.norm()).collect()),
                shaft: [0, 1, 2].map(|i| state.shaft[i]),
                nodes: [radial(0), radial(1)],
            });
        }
    }
}

/// A node of the raceway in the middle of the load zone, 17 deg up the groove.
fn raceway_node(model: &Model, side: Side) -> usize {
    let ring = model.ring(side).unwrap();
    let nodes = ring.mesh.group_nodes("raceway");
    let azimuth = |n: usize| ring.mesh.nodes[n][1].atan2(ring.mesh.nodes[n][0]).abs();
    let height = side.sign() * (0.3 * ring.groove.groove_radius);
    let far = |n: usize| (ring.mesh.nodes[n][2] - height).abs() + azimuth(n);
    nodes
        .into_iter()
        .min_by(|a, b| far(*a).total_cmp(&far(*b)))
        .unwrap()
}

/// Radial displacement of a node without the rigid motion of its ring, m.
fn elastic_radial(model: &Model, motion: &Motion<'_>, state: &MotionState, side: Side, node: usize) -> f64 {
    let (u, turned) = motion.ring_displacement(state, side).unwrap();
    let x = model.ring(side).unwrap().mesh.nodes[node];
    let (sin, cos) = x[1].atan2(x[0]).sin_cos();
    let total = cos * u[3 * node] + sin * u[3 * node + 1];
    let (sin, cos) = (x[1].atan2(x[0]) + turned).sin_cos();
    match side {
        Side::Inner => total - cos * state.shaft[0] - sin * state.shaft[1],
        Side::Outer => total,
    }
}

/// Amplitude and phase of exp(i angle) in values at equally spaced places of whole periods: 2/n sum x exp(-i angle).
fn harmonic(values: &[f64], angle: impl Fn(usize) -> f64) -> [f64; 2] {
    let sum = values.iter().enumerate().fold([0.0; 2], |sum, (i, x)| {
        let (sin, cos) = angle(i).sin_cos();
        [sum[0] + x * cos, sum[1] - x * sin]
    });
    sum.map(|s| 2.0 * s / values.len() as f64)
}

fn size(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

/// Amplitude of a frequency, Hz, in values `dt` apart with their mean taken away, under Hann's window.
fn windowed(values: &[f64], dt: f64, frequency: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let window = |i: usize| 1.0 - (TAU * (i as f64 + 0.5) / n).cos();
    let weighted: Vec<f64> = (0..values.len())
        .map(|i| window(i) * (values[i] - mean))
        .collect();
    size(harmonic(&weighted, |i| TAU * frequency * dt * i as f64))
}

/// 2 kN and 1 kN: all balls are loaded.
static LOADED: LazyLock<Run> = LazyLock::new(|| Run::new(2000.0, 1000.0, 4));

/// Wrong: motion would carry what its start has left behind, or find other forces than equilibria do. After one ball
/// pitch the forces are those of equilibria at the same places, to 1e-4 of the largest.
#[test]
fn rolling_settles_on_the_quasi_static_forces() {
    let run = &*LOADED;
    let mut quasi = QuasiStaticMotion::new(&run.model, run.rolling.clone(), 0.5 * run.dt).unwrap();
    let (mut earlier, mut worst) = (None, 0.0f64);
    for (i, seen) in run.seen.iter().enumerate().skip(START * PITCH_STEPS).step_by(37) {
        let rest = quasi.step(2 * i as u64 + 1, earlier.as_ref()).unwrap();
        let forces = [0, 1].map(|side| -> Vec<f64> {
            let contact = |b: &BallResult| [b.inner.force_n, b.outer.force_n][side];
            rest.balls.iter().map(contact).collect()
        });
        let largest = forces[0].iter().copied().fold(0.0, f64::max);
        for (expected, found) in forces.iter().zip(&seen.forces) {
            let pairs = expected.iter().zip(found);
            worst = pairs.fold(worst, |w, (a, b)| w.max((a - b).abs() / largest));
        }
        earlier = Some(rest);
    }
    println!("forces differ by {worst:.2e}");
    assert!(worst < 1e-4, "{worst}");
}

/// Wrong: the mesh would be felt. Neither at the elements that a ball passes on the outer ring nor at those on the
/// inner one has its force a component of 1e-4 of the mean, and nor has it at any azimuth harmonic between 5 and 150:
/// over one pitch the balls together pass the whole circle.
#[test]
fn balls_do_not_feel_the_elements() {
    let run = &*LOADED;
    let z = run.model.geometry.n_balls;
    let settled = &run.seen[START * PITCH_STEPS..];
    let pose = |seen: &Seen| run.rolling.pose(seen.middle);
    for side in [0, 1] {
        let pitch = |b: usize| settled[..PITCH_STEPS].iter().map(move |s| s.forces[side][b]);
        let circle: Vec<f64> = (0..z).flat_map(pitch).collect();
        let component = |m: usize| harmonic(&circle, |j| TAU * (m * j) as f64 / circle.len() as f64);
        let mean = 0.5 * component(0)[0];
        let ripple = (5..=150).map(|m| size(component(m)) / mean).fold(0.0, f64::max);
        println!("side {side}: mean {mean:.1} N, harmonics from 5 on {ripple:.1e}");
        assert!(ripple < 1e-4, "{ripple}");
        // What the load zone makes of the force is left out; it is no multiple of whole elements.
        let low: Vec<[f64; 2]> = (0..5).map(component).collect();
        let smooth = |azimuth: f64| -> f64 {
            let of = |(m, c): (usize, &[f64; 2])| {
                let (sin, cos) = (m as f64 * azimuth).sin_cos();
                if m == 0 {
                    0.5 * c[0]
                } else {
                    c[0] * cos - c[1] * sin
                }
            };
            low.iter().enumerate().map(of).sum()
        };
        let start = pose(&settled[0]).now.cage_angle;
        let (mut rest, mut angles) = (Vec::new(), [Vec::new(), Vec::new()]);
        for seen in settled {
            let pose = pose(seen);
            for ball in 0..z {
                let azimuth = TAU * ball as f64 / z as f64 + pose.now.cage_angle;
                rest.push(seen.forces[side][ball] - smooth(azimuth - start));
                angles[0].push(MESH.sectors as f64 * (azimuth - pose.ring_angles[0]));
                angles[1].push(MESH.sectors as f64 * azimuth);
            }
        }
        for (ring, angles) in angles.iter().enumerate() {
            let line = size(harmonic(&rest, |j| angles[j])) / mean;
            println!("  elements of ring {ring}: {line:.1e} of the mean force");
            assert!(line < 1e-4, "{line}");
        }
    }
}

/// Wrong: balls would pass the rings at other rates than kinematics says. A node of the outer raceway feels them at
/// Z f_cage = 234 Hz, one of the inner at Z (f_i - f_cage) = 306 Hz: the highest points of the spectra of their elastic
/// displacement. Windows of four pitches tell these apart, 72 Hz, and place a line to a few Hz.
#[test]
fn raceways_feel_the_balls_at_their_passing_frequencies() {
    let run = &*LOADED;
    let z = run.model.geometry.n_balls as f64;
    let turn = SPEED / TAU;
    let cage = run.rolling.kinematics.cage * turn;
    for (side, expected) in [(0, z * (turn - cage)), (1, z * cage)] {
        let settled = run.seen.iter().skip(START * PITCH_STEPS);
        let values: Vec<f64> = settled.map(|s| s.nodes[side]).collect();
        let amplitude = |f: &i32| windowed(&values, run.dt, f64::from(*f));
        let highest = (150..450)
            .max_by(|a, b| amplitude(a).total_cmp(&amplitude(b)))
            .unwrap();
        println!(
            "ring {side}: {highest} Hz with {:.2e} m, expected {expected:.1} Hz",
            amplitude(&highest)
        );
        assert!(
            (f64::from(highest) - expected).abs() < 12.0,
            "{highest} {expected}"
        );
    }
}

/// Wrong: the shaft would not move as balls enter and leave the load zone, or at another rate. With 0.5 kN of thrust
/// and 2 kN across, 11 balls of 18 carry no load; in a window of three pitches, whose lines are 78 Hz apart, the
/// shaft moves at 234 Hz and multiples of it, as far as equilibria do. What else there is rings on from the start:
/// balls in their clearance. (Under 2 kN and 1 kN all balls are loaded, and this line is below 1e-12 m.)
#[test]
fn the_shaft_moves_at_the_ball_passing_frequency() {
    let run = Run::new(500.0, 2000.0, 3);
    let settled = &run.seen[START * PITCH_STEPS..];
    let unloaded = |s: &Seen| s.forces[0].iter().filter(|f| **f == 0.0).count();
    assert!(settled.iter().any(|s| unloaded(s) >= 10));
    let samples = 20;
    let still = still_shaft(&run, samples);
    for dof in 0..3 {
        let line =
            |values: &[f64], k: usize, n: usize| size(harmonic(values, |j| TAU * (k * j) as f64 / n as f64));
        let moving: Vec<f64> = settled.iter().map(|s| s.shaft[dof]).collect();
        let lines: Vec<f64> = (0..=12).map(|k| line(&moving, k, moving.len())).collect();
        let others = (1..=12)
            .filter(|k| k % 3 != 0)
            .map(|k| lines[k])
            .fold(0.0, f64::max);
        let at_rest: Vec<f64> = still.iter().map(|q| q[dof]).collect();
        let expected = line(&at_rest, 1, samples);
        println!(
            "dof {dof}: {:.2e} m at 234 Hz, equilibria {expected:.2e} m, other lines {:.1e} of it",
            lines[3],
            others / lines[3]
        );
        assert!(
            (lines[3] / expected - 1.0).abs() < 0.03,
            "{} {expected}",
            lines[3]
        );
        assert!(others < 0.03 * lines[3], "{others} {}", lines[3]);
        assert!((1..=12).all(|k| k == 3 || lines[k] < 0.5 * lines[3]), "{lines:?}");
    }
}

/// Wrong: rolling without friction would need a drive, or be one. Where the shaft tilts, contacts go up and down the
/// grooves once per turn of a ball. Patches that follow them late do work, which comes out at the drive; with play of
/// a tenth of a patch it was 1e-3 of the energy in two pitches.
#[test]
fn rolling_without_friction_needs_no_drive() {
    let case = Case {
        radial: 1000.0,
        free_tilt: true,
        ..Case::axial(2000.0)
    };
    let model = case.flexible(ContactMode::Patch, MESH, Hold::Clamped);
    let rolling = Rolling::new(&model.geometry, Speed::constant(SPEED), [0.0; 2]);
    let pitch = TAU / (model.geometry.n_balls as f64 * rolling.kinematics.cage * SPEED);
    let dt = pitch / PITCH_STEPS as f64;
    let motion = Motion::new(&model, MotionSettings::conserving(dt, rolling.speeds.clone())).unwrap();
    let mut state = motion.start(&crate::support::equilibrium(&model));
    let mut drive = Vec::new();
    for _ in 0..3 {
        let mut cache = StepCache::default();
        for _ in 0..PITCH_STEPS {
            state = motion.step(&state, &mut cache).unwrap().0;
        }
        drive.push(state.ledger.frame_work / state.ledger.total());
    }
    println!("work of the drive over the energy, by pitch: {drive:?}");
    assert!((drive[2] - drive[0]).abs() < 1e-4, "{drive:?}");
}

/// Shaft of equilibria at `n` places of one pitch.
fn still_shaft(run: &Run, n: usize) -> Vec<[f64; 5]> {
    let dt = run.dt * PITCH_STEPS as f64 / n as f64;
    let mut quasi = QuasiStaticMotion::new(&run.model, run.rolling.clone(), dt).unwrap();
    let (mut earlier, mut places) = (None, Vec::new());
    for step in 0..n as u64 {
        let rest = quasi.step(step, earlier.as_ref()).unwrap();
        places.push(rest.displacements.shaft);
        earlier = Some(rest);
    }
    places
}
