//! A bearing that rolls at 1800 rpm, step by step and part by part.

use dynamics::costs::*;
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache, StepReport};
use dynamics::{Model, StaticSolver};

use crate::clock::Runs;

/// Parts of a step in the table, and their laps.
const PARTS: [(&str, &str); 8] = [
    ("step/loads", LOADS),
    ("step/patches", PATCHES),
    ("step/right_side", RIGHT_SIDE),
    ("step/solve", BLOCK_SOLVE),
    ("step/raceways", RACEWAYS),
    ("step/newton", NEWTON),
    ("step/frame", FRAME),
    ("step/update", UPDATE),
];
/// Step size, s, and speed, rad/s (1800 rpm).
pub const DT: f64 = 1e-5;
pub const SPEED: f64 = 60.0 * std::f64::consts::PI;

/// A bearing on its way.
pub struct Rolling<'a> {
    pub motion: Motion<'a>,
    pub state: MotionState,
    cache: StepCache,
    pub laps: Runs,
    report: StepReport,
    n_steps: usize,
}

impl<'a> Rolling<'a> {
    pub fn new(model: &'a Model) -> Rolling<'a> {
        let start = StaticSolver::new(model)
            .and_then(|mut solver| solver.solve(model, None))
            .expect("the bearing has an equilibrium");
        let settings = MotionSettings::conserving(DT, Speed::constant(SPEED));
        let motion = Motion::new(model, settings).expect("the rings can be factored");
        let state = motion.start(&start);
        let mut cache = StepCache::default();
        // The first step touches memory for the first time.
        let state = motion
            .step(&state, &mut cache)
            .expect("a step from equilibrium")
            .0;
        Rolling {
            motion,
            state,
            cache,
            laps: Runs::default(),
            report: StepReport::default(),
            n_steps: 0,
        }
    }

    pub fn step(&mut self) {
        let (next, report) = self
            .laps
            .time("step", || self.motion.step(&self.state, &mut self.cache))
            .expect("slow rolling");
        for (part, lap) in PARTS {
            self.laps.add_wall(part, report.laps.seconds(lap));
        }
        self.laps.end_run();
        self.report.add(&report);
        self.n_steps += 1;
        self.state = next;
    }

    pub fn print(&self, name: &str) {
        let per_step = |n: usize| n as f64 / self.n_steps as f64;
        println!(
            "\n{name}: {} steps, {:.1} newton iterations and {:.1} frame rounds each",
            self.n_steps,
            per_step(self.report.newton_iterations),
            per_step(self.report.frame_rounds)
        );
        self.laps.print();
    }
}
