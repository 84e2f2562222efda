//! The turning frame, mounts and integrators of a motion.

use crate::support::rings::{self, Level};
use crate::support::{Case, equilibrium};
use contact::Side;
use dynamics::effects::FrameRotation;
use dynamics::interactions::contact_damping::ContactDamping;
use dynamics::kinematics::Speed;
use dynamics::motion::{Integrator, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Backend, ContactMode, Hold, Model, Sectors, ShaftDof, StaticSolution};
use ring::Frame;

const SMALL: Level = Level::hex8(54, 6, 1, 2);

fn settings(dt: f64) -> MotionSettings {
    MotionSettings::conserving(dt, Speed::constant(0.0))
}

fn run(model: &Model, start: &StaticSolution, settings: MotionSettings, n: usize) -> Vec<MotionState> {
    let motion = Motion::new(model, settings).unwrap();
    let mut states = vec![motion.start(start)];
    let mut cache = StepCache::default();
    for _ in 0..n {
        let next = motion.step(states.last().unwrap(), &mut cache).unwrap().0;
        states.push(next);
    }
    states
}

/// The model at rest under 1 kN of thrust, and under a radial force that comes at t = 0.
fn radial_step(radial: f64, hold: Hold, free_tilt: bool) -> (Model, StaticSolution) {
    let before = Case {
        free_tilt,
        ..Case::axial(1000.0)
    };
    let model = before.flexible(ContactMode::Patch, SMALL, hold);
    let mut loaded = Model {
        rings: model.rings.clone(),
        ..Case { radial, ..before }.spheres()
    };
    loaded.contact.mode = ContactMode::Patch;
    (loaded, equilibrium(&model))
}

fn worst_defect(states: &[MotionState]) -> f64 {
    states
        .iter()
        .map(|s| s.ledger.relative_defect().abs())
        .fold(0.0, f64::max)
}

/// Position of a free inner ring at the end, seen in space, when it starts with velocity `v` along x from the axis.
fn free_flight(speed: Speed, dt: f64, n: usize, v: f64) -> [f64; 2] {
    let mut model = Case::axial(0.0).flexible(ContactMode::Patch, SMALL, Hold::Free);
    model.rings[1] = None;
    // Room for the ring: a large clearance.
    model.geometry.outer_raceway_diameter += 0.1e-3;
    model.effects = vec![Box::new(FrameRotation::new(speed.clone()))];
    // A shaft that flies beside its ring.
    model.shaft[2] = ShaftDof::Free;
    model.shaft_mass = 1.0;
    let motion = Motion::new(
        &model,
        MotionSettings {
            speeds: speed.clone().into(),
            ..settings(dt)
        },
    )
    .unwrap();
    // The balls lie on the bottom of the inner groove without touching it.
    let back = model.geometry.ball_centre().axial - model.geometry.groove_centre(Side::Inner).axial;
    let mut state = motion.rest([0.0, 0.0, back, 0.0, 0.0], [v, 0.0, 0.0, 0.0, 0.0]);
    assert!(state.approaches.iter().step_by(2).all(|d| *d < -20e-6));
    let mut cache = StepCache::default();
    for _ in 0..n {
        state = motion.step(&state, &mut cache).unwrap().0;
        assert!(state.forces.iter().step_by(2).all(|f| f.norm() == 0.0));
    }
    let (u, angle) = motion.ring_displacement(&state, Side::Inner).unwrap();
    let mass = &model.ring(Side::Inner).unwrap().mesh;
    let n = mass.n_nodes() as f64;
    let mean = [0, 1].map(|c| u.iter().skip(c).step_by(3).sum::<f64>() / n);
    let (sin, cos) = angle.sin_cos();
    [cos * mean[0] - sin * mean[1], sin * mean[0] + cos * mean[1]]
}

/// Wrong: Coriolis force, spin softening or Euler force have a wrong sign or size. A ring that no force holds flies
/// straight through space, whatever its frame does; in the turning frame only these forces bend its path. Second
/// order in the step.
#[test]
fn a_free_ring_flies_straight_in_a_turning_frame() {
    let (v, time) = (10e-3, 3e-4);
    for speed in [
        Speed::constant(1500.0),
        Speed::table(vec![0.0, 1e-3], vec![500.0, 5000.0]),
    ] {
        let error = |n: usize| {
            let [x, y] = free_flight(speed.clone(), time / n as f64, n, v);
            (x - v * time).hypot(y)
        };
        let (coarse, fine) = (error(15), error(30));
        println!("{coarse:.3e} {fine:.3e} of {:.3e}", v * time);
        assert!(coarse < 0.02 * v * time, "{coarse}");
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.2, "order {order}");
    }
}

/// Wrong: a bearing whose bore and seat are held in their mean motion would not be in motion what it is in statics.
#[test]
fn a_mean_motion_bearing_rests_and_closes_its_ledger() {
    let (model, start) = radial_step(0.0, Hold::MeanMotion, true);
    let states = run(&model, &start, settings(1e-5), 5);
    let (first, last) = (&states[0], states.last().unwrap());
    for (a, b) in first.balls.iter().zip(&last.balls) {
        assert!((*a - *b).norm() < 1e-12, "{a:?} {b:?}");
    }
    let (model, start) = radial_step(300.0, Hold::MeanMotion, true);
    let states = run(&model, &start, settings(1e-5), 150);
    println!("{:?}", states.last().unwrap().ledger);
    assert!(worst_defect(&states) < 1e-8, "{}", worst_defect(&states));
}

/// Wrong: shaft dofs that are held differently, in space, would turn with the ring. y is locked, x free, at speed.
#[test]
fn a_locked_direction_stays_locked_in_space() {
    let (mut model, _) = radial_step(500.0, Hold::Clamped, false);
    model.shaft[1] = ShaftDof::Prescribed(0.0);
    let start = equilibrium(&model);
    let turning = MotionSettings {
        speeds: Speed::constant(2000.0).into(),
        ..settings(1e-5)
    };
    let states = run(&model, &start, turning, 60);
    let last = states.last().unwrap();
    assert_eq!(last.shaft[1], 0.0);
    assert!(
        (last.shaft[0] / states[0].shaft[0] - 1.0).abs() < 0.01,
        "{:?}",
        last.shaft
    );
    assert!(worst_defect(&states) < 1e-8, "{}", worst_defect(&states));
}

/// Wrong: numerical dissipation would not be in the ledger, or a setting would gain energy. The unloading case under
/// every setting of the family, in steps of 10 us, where the stability page shows all of them to lose energy: the
/// ledger closes, and what the integrator takes it does not give back.
#[test]
fn every_integrator_closes_the_ledger() {
    let (model, start) = radial_step(5000.0, Hold::Clamped, false);
    let family = [
        ("chung_hulbert 0.8", Integrator::chung_hulbert(0.8)),
        ("chung_hulbert 0", Integrator::chung_hulbert(0.0)),
        ("hht 0.1", Integrator::hht(0.1)),
        ("newmark 0.3025 0.6", Integrator::newmark(0.3025, 0.6)),
    ];
    for (name, integrator) in family {
        let choices = MotionSettings {
            integrator,
            ..settings(1e-5)
        };
        let states = run(&model, &start, choices, 100);
        let last = states.last().unwrap().ledger;
        println!(
            "{name}: defect {:.1e}, lost {:.2e} of {:.2e} J",
            worst_defect(&states),
            last.numerical_loss,
            last.largest
        );
        assert!(worst_defect(&states) < 1e-8, "{name}: {}", worst_defect(&states));
        assert!(last.numerical_loss > 0.0, "{name}: {}", last.numerical_loss);
    }
}

/// Wrong: a spinning bearing under centrifugal force would not rest where statics puts it, or the frame's work would be
/// missing in the ledger. 30 000 rpm from static equilibrium with the same effect.
#[test]
fn a_spinning_ring_rests_in_its_static_expansion() {
    let speed = Speed::constant(30_000.0 * std::f64::consts::PI / 30.0);
    let mut model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::MeanMotion);
    let still = equilibrium(&model);
    model.effects.push(Box::new(FrameRotation::new(speed.clone())));
    let start = equilibrium(&model);
    // The expansion of the ring closes the clearance: less axial approach under the same thrust.
    assert!(still.displacements.shaft[2] - start.displacements.shaft[2] > 1e-6);
    let states = run(
        &model,
        &start,
        MotionSettings {
            speeds: speed.into(),
            ..settings(5e-6)
        },
        100,
    );
    let force = |s: &MotionState, site: usize| s.forces[site].norm();
    let worst = (0..36)
        .map(|i| (force(states.last().unwrap(), i) / force(&states[0], i) - 1.0).abs())
        .fold(0.0, f64::max);
    println!(
        "forces change by {worst:.2e}; {:?}",
        states.last().unwrap().ledger
    );
    assert!(worst < 0.02, "{worst}");
    assert!(worst_defect(&states) < 1e-8, "{}", worst_defect(&states));
}

/// Wrong: the cyclic solver or sectors would solve other equations than the sparse one. 60 steps of a load step with
/// each, at speed, clamped and in mean motion: forces and displacements agree to 1e-10 of their size; each names
/// itself.
#[test]
fn cyclic_sparse_and_sector_steps_agree() {
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let (mut model, start) = radial_step(1500.0, hold, false);
        model
            .effects
            .push(Box::new(FrameRotation::new(Speed::constant(1000.0))));
        let mut ends = Vec::new();
        let backends = [
            (Backend::Auto, "cyclic"),
            (Backend::Sparse, "sparse"),
            (Backend::Sector(five_sectors()), "sector"),
        ];
        for (backend, name) in backends {
            model.backend = backend;
            let turning = MotionSettings {
                speeds: Speed::constant(1000.0).into(),
                ..settings(1e-5)
            };
            let motion = Motion::new(&model, turning.clone()).unwrap();
            assert_eq!(Side::BOTH.map(|side| motion.solver_name(side)), [Some(name); 2]);
            ends.push(run(&model, &start, turning, 60).pop().unwrap());
        }
        let largest = ends[0].forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
        for end in &ends[1..] {
            for (a, b) in ends[0].forces.iter().zip(&end.forces) {
                assert!((*a - *b).norm() < 1e-10 * largest, "{a:?} {b:?}");
            }
            for (a, b) in ends[0].shaft.iter().zip(&end.shaft) {
                assert!((a - b).abs() < 1e-10 * ends[0].shaft[2].abs(), "{a} {b}");
            }
        }
        assert!(ends.iter().all(|s| s.ledger.relative_defect().abs() < 1e-9));
    }
}

fn five_sectors() -> Sectors {
    Sectors {
        n_sectors: Some(5),
        ..Sectors::default()
    }
}

/// Wrong: a ring in sectors would have another equilibrium than as a whole.
#[test]
fn sectors_have_the_equilibrium_of_the_whole_ring() {
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let case = Case {
            radial: 500.0,
            ..Case::axial(1000.0)
        };
        let mut model = case.flexible(ContactMode::Patch, SMALL, hold);
        let whole = equilibrium(&model);
        model.backend = Backend::Sector(five_sectors());
        let sectors = equilibrium(&model);
        for (a, b) in whole.balls.iter().zip(&sectors.balls) {
            let change = (a.inner.force_n - b.inner.force_n).abs();
            assert!(change < 1e-9 * whole.balls[0].inner.force_n, "{a:?} {b:?}");
        }
        for (a, b) in whole
            .elastic
            .iter()
            .flatten()
            .zip(sectors.elastic.iter().flatten())
        {
            let largest = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let error = a.iter().zip(b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
            assert!(error < 1e-9 * largest, "{hold:?}: {error:.1e} of {largest:.1e}");
        }
    }
}

/// Wrong: a ring without equal sectors would be solved as if it had them, or be refused without a reason.
#[test]
fn a_ring_that_is_not_periodic_is_solved_as_a_whole_or_refused_with_the_reason() {
    let mut model = Case::axial(1000.0).flexible(ContactMode::Patch, SMALL, Hold::Clamped);
    let ring = model.ring(Side::Outer).unwrap();
    let mut mesh = ring.mesh.clone();
    // The outer part, unevenly: no defect of a few sectors.
    for (k, x) in mesh.nodes.iter_mut().enumerate() {
        if x[0].hypot(x[1]) > 38e-3 {
            x[2] += 1e-5 * (0.618 * k as f64).fract();
        }
    }
    let bumped = rings::ring_model(Side::Outer, mesh, Hold::Clamped);
    model.rings[1] = Some(std::sync::Arc::new(bumped));
    let motion = Motion::new(&model, settings(1e-5)).unwrap();
    let names = Side::BOTH.map(|side| motion.solver_name(side));
    assert_eq!(names, [Some("cyclic"), Some("sparse")]);
    model.backend = Backend::Cyclic;
    let text = Motion::new(&model, settings(1e-5)).err().unwrap().to_string();
    assert!(
        text.starts_with(
            "the outer ring is not rotationally periodic, so solver.backend = \"cyclic\" cannot be: "
        ) && text.ends_with("; use \"auto\" or \"sparse\""),
        "{text}"
    );
    assert!(text.contains("node"), "{text}");
}

/// Wrong: the inertia of a turning ring that may tilt or move would pull it off its equilibrium, as that of linear
/// displacements does: by 7 % in x and 6 % of the tilt at 40 000 rpm. A bearing under a load across starts in its
/// equilibrium, with damped contacts and a free tilt: x, z and tilt stay, by their mean over a millisecond. The damping
/// leaves 0.2 % at steps of 20 us, which halves with the step; what would be left without a step is 4e-4.
#[test]
fn a_turning_ring_with_a_free_tilt_stays_in_its_equilibrium() {
    for (rpm, most, limit) in [(1800.0, 5e-5, 5e-5), (40e3, 2e-3, 4e-4)] {
        let speed = Speed::constant(rpm * std::f64::consts::PI / 30.0);
        for frame in [Frame::Still, Frame::Turning, Frame::Stiffened] {
            let case = Case {
                radial: 1000.0,
                free_tilt: true,
                ..Case::axial(2000.0)
            };
            let mut model = case.flexible(ContactMode::Patch, Level::hex8(36, 6, 1, 2), Hold::Clamped);
            let turning = FrameRotation::new(speed.clone());
            match frame {
                Frame::Still => (),
                Frame::Turning => model.effects.push(Box::new(turning)),
                Frame::Stiffened => model.effects.push(Box::new(turning.stiffened())),
            }
            let start = equilibrium(&model);
            let [coarse, fine] = [100, 200].map(|steps| {
                let settings = MotionSettings {
                    contact_damping: Some(ContactDamping {
                        coefficient: 50.0,
                        full_approach: 1e-6,
                    }),
                    ..MotionSettings::conserving(2e-3 / steps as f64, speed.clone())
                };
                let states = run(&model, &start, settings, steps);
                let late = &states[steps / 2..];
                [0, 2, 4].map(|i| {
                    let mean = late.iter().map(|s| s.shaft[i]).sum::<f64>() / late.len() as f64;
                    mean / start.displacements.shaft[i] - 1.0
                })
            });
            println!("{rpm} rpm, {frame:?} frame: x, z and tilt off by {coarse:.6?} {fine:.6?}");
            for (coarse, fine) in coarse.into_iter().zip(fine) {
                assert!(coarse.abs() < most && fine.abs() < most, "{coarse} {fine}");
                let left = 2.0 * fine - coarse;
                assert!(left.abs() < limit, "{coarse} {fine}");
            }
        }
    }
}
