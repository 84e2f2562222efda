//! Where the time of the steps of a run went.

use dynamics::Timing;
use dynamics::motion::StepSeconds;

/// Seconds in the steps of a motion, those of loads apart, which their effects count.
#[derive(Debug, Default)]
pub struct Spent {
    /// Patches, motion of the raceways and compliance of the contacts.
    patches: f64,
    /// Newton on contacts, balls and shaft.
    newton: f64,
    /// Whole rings: products, solves, new states, energies.
    rings: f64,
}

impl Spent {
    /// Adds a step.
    pub fn add(&mut self, step: StepSeconds) {
        self.patches += step.patches + step.raceways;
        self.newton += step.newton;
        self.rings += step.right_side + step.solve + step.frame + step.update;
    }

    /// With the seconds of what came before the steps.
    pub fn with(&self, start: Timing) -> Timing {
        Timing {
            patches: start.patches + self.patches,
            newton: start.newton + self.newton,
            solve: start.solve + self.rings,
            ..start
        }
    }
}
