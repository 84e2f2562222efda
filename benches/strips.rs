//! The price of strip contacts: steps in time of one bearing with Hertz's law and with strips on smooth grooves.
//!
//! The 7010C rolls at 1800 rpm under 2 kN and 1 kN on flexible rings, with one thread. Steps of both take turns, so
//! that other work on the machine meets both; what counts is the median of the ratios of pairs. Run with
//!
//!     cargo bench -p raceway --bench strips -- [dofs per ring: 10k (default), 57k]
//!
//! Results: docs/dev/performance.md.

#[path = "../crates/dynamics/tests/support/mod.rs"]
mod support;

use std::sync::Arc;

use contact::{Profiles, Side, StripLaw, StripSurface};
use dynamics::kinematics::Speed;
use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{ContactMode, Hold, Model, StaticSolver};
use support::Case;
use support::rings::Level;
use timer::Stopwatch;

/// Pairs of steps.
const PAIRS: usize = 200;
/// Step size, s, and speed, rad/s (1800 rpm).
const DT: f64 = 1e-5;
const SPEED: f64 = 60.0 * std::f64::consts::PI;

fn bearing(level: Level, has_strips: bool) -> Model {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, level, Hold::Clamped);
    // Beside strips both contacts of a ball are on their own.
    model.sphere = Default::default();
    for side in Side::BOTH.into_iter().filter(|_| has_strips) {
        let law = StripLaw::new(&model.hertz[side.index()], model.geometry.groove_radius(side));
        let place = (&model.geometry, side);
        let surface = StripSurface::new(law, place, Some(-1.0..=1.0), &Profiles::default());
        model.surfaces.strips[side.index()] = surface.map(Arc::new);
    }
    model
}

/// A bearing on its way.
struct Rolling<'a> {
    motion: Motion<'a>,
    state: MotionState,
    cache: StepCache,
}

impl<'a> Rolling<'a> {
    fn new(model: &'a Model) -> Rolling<'a> {
        let start = StaticSolver::new(model)
            .and_then(|mut solver| solver.solve(model, None))
            .expect("the bearing has an equilibrium");
        let settings = MotionSettings::conserving(DT, Speed::constant(SPEED));
        let motion = Motion::new(model, settings).expect("the rings can be factored");
        Rolling {
            state: motion.start(&start),
            motion,
            cache: StepCache::default(),
        }
    }

    /// Seconds of a step.
    fn step(&mut self) -> f64 {
        let mut watch = Stopwatch::start();
        let next = self.motion.step(&self.state, &mut self.cache);
        let seconds = watch.lap();
        self.state = next.expect("slow rolling").0;
        seconds
    }
}

fn main() {
    let level = match std::env::args().any(|argument| argument == "57k") {
        true => Level::hex8(180, 14, 3, 4),
        false => Level::hex8(90, 8, 2, 2),
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .expect("no pool before");
    let models = [false, true].map(|has_strips| bearing(level, has_strips));
    let [mut hertz, mut strips] = models.each_ref().map(Rolling::new);
    let pairs: Vec<[f64; 2]> = (0..PAIRS).map(|_| [hertz.step(), strips.step()]).collect();
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let ratios = pairs.iter().map(|[hertz, strips]| strips / hertz);
    println!(
        "a step with Hertz's law {:.3} ms, with strips {:.3} ms; median ratio of {PAIRS} pairs {:.3}",
        1e3 * median(pairs.iter().map(|pair| pair[0]).collect()),
        1e3 * median(pairs.iter().map(|pair| pair[1]).collect()),
        median(ratios.collect())
    );
}
