//! A motion that is run step by step and watched.

use dynamics::motion::{Motion, MotionSettings, MotionState, StepCache};
use dynamics::{Model, StaticSolution};

use super::plot::Curve;
use super::record::LEDGER;

/// Points of a curve on the page.
const CURVE_POINTS: usize = 300;

/// What a motion did.
pub struct Course {
    /// Steps asked for.
    pub wanted: usize,
    /// Why it ended before.
    pub error: Option<String>,
    /// Largest ledger defect over the largest energy, at any step.
    pub defect: f64,
    /// Largest contact force, N.
    pub peak: f64,
    /// Most contacts without force at a time.
    pub open: usize,
    /// Whether the losses to contact and Rayleigh damping never shrank (beyond round-off).
    pub losses_grow: bool,
    /// Energy that the integrator has given back at most after it had taken it, J.
    pub given_back: f64,
    /// Most that the integrator had taken, J.
    most_loss: f64,
    /// Largest departure of a shaft displacement from the start, m or rad.
    pub excursion: f64,
    /// Shaft displacement at the start.
    first: [f64; 5],
    /// Mean shaft displacement of all steps, m and rad.
    pub mean_shaft: [f64; 5],
    /// Mean normal force of every contact, by site, N.
    pub mean_forces: Vec<f64>,
    /// The last good state.
    pub last: MotionState,
    /// Parts that failed and were done again in halves.
    pub retries: usize,
    /// Time, ms, and shaft x and z, um, and largest force, N, of some steps.
    samples: Vec<[f64; 4]>,
}

/// Runs `n` steps from the state; stops as the program does, on an error or when the ledger does not close.
pub fn march(motion: &Motion<'_>, start: MotionState, n: usize) -> Course {
    march_with(motion, start, n, |_| ())
}

/// The same, looking at every state.
pub fn march_with(
    motion: &Motion<'_>,
    start: MotionState,
    n: usize,
    mut look: impl FnMut(&MotionState),
) -> Course {
    let mut course = Course {
        wanted: n,
        error: None,
        defect: 0.0,
        peak: 0.0,
        open: 0,
        losses_grow: true,
        given_back: 0.0,
        most_loss: 0.0,
        excursion: 0.0,
        first: start.shaft,
        mean_shaft: [0.0; 5],
        mean_forces: vec![0.0; start.forces.len()],
        last: start,
        retries: 0,
        samples: Vec::new(),
    };
    let mut done = 0.0;
    let mut cache = StepCache::default();
    for step in 0..n {
        let (next, report) = match motion.step(&course.last, &mut cache) {
            Ok(next) => next,
            Err(error) => {
                course.error = Some(error.to_string());
                break;
            }
        };
        course.retries += report.retries;
        course.note(&next);
        done += 1.0;
        if step % n.div_ceil(CURVE_POINTS) == 0 {
            let force = largest_force(&next);
            let [x, z] = [0, 2].map(|i| 1e6 * next.shaft[i]);
            course.samples.push([1e3 * motion.time(next.step), x, z, force]);
        }
        course.last = next;
        look(&course.last);
        // Written so that NaN does not close.
        if course.defect.is_nan() || course.defect > LEDGER {
            course.error = Some(format!("the energy ledger does not close: {:.1e}", course.defect));
            break;
        }
    }
    course.mean_shaft.iter_mut().for_each(|x| *x /= done);
    course.mean_forces.iter_mut().for_each(|x| *x /= done);
    course
}

/// Runs `n` steps from an equilibrium.
pub fn from_equilibrium(model: &Model, start: &StaticSolution, settings: MotionSettings, n: usize) -> Course {
    let motion = Motion::new(model, settings).unwrap();
    let state = motion.with_accelerations(motion.start(start)).unwrap();
    march(&motion, state, n)
}

impl Course {
    fn note(&mut self, next: &MotionState) {
        let defect = next.ledger.relative_defect().abs();
        self.defect = if defect.is_nan() {
            defect
        } else {
            self.defect.max(defect)
        };
        let slack = 1e-12 * next.ledger.largest;
        let losses = next.ledger.losses().into_iter().zip(self.last.ledger.losses());
        self.losses_grow &= losses.take(2).all(|(new, old)| new >= old - slack);
        let loss = next.ledger.numerical_loss;
        self.most_loss = self.most_loss.max(loss);
        self.given_back = self.given_back.max(self.most_loss - loss);
        let departures = next.shaft.iter().zip(self.first).map(|(q, q0)| (q - q0).abs());
        self.excursion = departures.fold(self.excursion, f64::max);
        self.peak = self.peak.max(largest_force(next));
        self.open = self
            .open
            .max(next.forces.iter().filter(|f| f.norm() == 0.0).count());
        (0..5).for_each(|i| self.mean_shaft[i] += next.shaft[i]);
        for (sum, f) in self.mean_forces.iter_mut().zip(&next.forces) {
            *sum += f.norm();
        }
    }

    /// How it ended, for a message.
    pub fn ending(&self) -> String {
        self.error
            .as_ref()
            .map_or(String::new(), |e| format!(" (step {}: {e})", self.last.step + 1))
    }

    /// Whether every number of the last state is finite.
    pub fn is_finite(&self) -> bool {
        let state = &self.last;
        let rings = state
            .rings
            .iter()
            .flatten()
            .flat_map(|r| [r.displacement(), r.velocity(), r.acceleration()].concat());
        let balls = state
            .balls
            .iter()
            .chain(&state.ball_velocities)
            .chain(&state.forces)
            .flat_map(|vector| vector.to_array());
        let shaft = state.shaft.iter().chain(&state.shaft_velocity);
        rings.chain(balls).chain(shaft.copied()).all(f64::is_finite)
    }

    /// Shaft displacement over time: `component` 0 is x, 1 is z, um; 2 is the largest force, N.
    pub fn curve(&self, name: &str, component: usize) -> Curve {
        Curve {
            name: name.to_string(),
            points: self.samples.iter().map(|s| [s[0], s[1 + component]]).collect(),
        }
    }
}

/// Largest contact force, N.
pub fn largest_force(state: &MotionState) -> f64 {
    state.forces.iter().map(|f| f.norm()).fold(0.0, f64::max)
}
