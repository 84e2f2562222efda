//! Energies of the shaft and what went into it.

use dynamics::motion::held::HeldAnswer;

use super::step::ShaftStep;
use crate::shaft::{ShaftBody, times};

/// Energy ledger of the shaft, J. Each bearing has its own, into which the shaft's work goes as `imposed_work`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShaftLedger {
    /// Kinetic energy.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Their sum at the start.
    pub initial: f64,
    /// Work of the loads.
    pub load_work: f64,
    /// Work of the spin where its speed changes: that of the drive.
    pub spin_work: f64,
    /// Work that went into the bearings.
    pub bearing_work: f64,
    /// Largest of all energies and works so far, and of what the forces of the bearings would do from no displacement
    /// on: beside that a motion that begins at rest is round-off.
    pub scale: f64,
}

impl ShaftLedger {
    /// How many numbers it has.
    pub const N: usize = 7;

    /// Its numbers, to be stored.
    pub fn to_numbers(&self) -> [f64; ShaftLedger::N] {
        [
            self.kinetic,
            self.strain,
            self.initial,
            self.load_work,
            self.spin_work,
            self.bearing_work,
            self.scale,
        ]
    }

    /// The ledger of stored numbers; None where they are not as many.
    pub fn from_numbers(numbers: &[f64]) -> Option<ShaftLedger> {
        let [
            kinetic,
            strain,
            initial,
            load_work,
            spin_work,
            bearing_work,
            scale,
        ] = *numbers
        else {
            return None;
        };
        Some(ShaftLedger {
            kinetic,
            strain,
            initial,
            load_work,
            spin_work,
            bearing_work,
            scale,
        })
    }

    /// A ledger that begins with a displacement and a velocity.
    pub fn begin(shaft: &ShaftBody, q: &[f64], v: &[f64]) -> ShaftLedger {
        let [kinetic, strain] = energies(shaft, q, v);
        let mut ledger = ShaftLedger {
            kinetic,
            strain,
            initial: kinetic + strain,
            ..ShaftLedger::default()
        };
        ledger.note_scale(0.0);
        ledger
    }

    /// The ledger after a part that ends so.
    pub fn after(
        &self,
        step: &ShaftStep<'_>,
        end: &[f64],
        velocity: &[f64],
        answers: &[HeldAnswer],
    ) -> ShaftLedger {
        let [kinetic, strain] = energies(step.shaft, end, velocity);
        let change: Vec<f64> = end.iter().zip(step.start[0]).map(|(a, b)| a - b).collect();
        // Work that goes into a bearing, and the size of what its forces would do over the whole displacement.
        let into = |(mount, answer): (&crate::newton::Mount, &HeldAnswer)| -> [f64; 2] {
            let [from, to] = [step.start[0], end].map(|q| mount.station.displacement(q));
            let moved = std::array::from_fn(|i| to[i] - from[i]);
            let [moved, whole] = [moved, to].map(|u| mount.place.orientation.turned(u));
            let sizes = answer.load.iter().zip(whole).map(|(f, u)| (f * u).abs());
            [work(&answer.load, &moved), sizes.sum()]
        };
        let bearings = step.mounts.iter().zip(answers).map(into);
        let [into_bearings, whole] = bearings.fold([0.0; 2], |[a, b], [work, size]| [a + work, b + size]);
        let by_tilt = step.load.over(step.shaft, step.interval(), [step.start[0], end]);
        let mut ledger = ShaftLedger {
            kinetic,
            strain,
            load_work: self.load_work + work(&step.load.on_dofs, &change) + work(&by_tilt, &change),
            spin_work: self.spin_work + work(&step.spin_force(end), &change),
            bearing_work: self.bearing_work + into_bearings,
            ..*self
        };
        ledger.note_scale(whole);
        ledger
    }

    /// Energy that nothing accounts for, J.
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain - self.initial - self.load_work - self.spin_work + self.bearing_work
    }

    /// The defect over the largest energy or work.
    pub fn relative_defect(&self) -> f64 {
        self.defect() / self.scale.max(f64::MIN_POSITIVE)
    }

    fn note_scale(&mut self, whole: f64) {
        let all = [
            self.kinetic,
            self.strain,
            self.load_work,
            self.spin_work,
            self.bearing_work,
            whole,
        ];
        self.scale = all.iter().fold(self.scale, |m, x| m.max(x.abs()));
    }
}

fn energies(shaft: &ShaftBody, q: &[f64], v: &[f64]) -> [f64; 2] {
    let half = |matrix: &[f64], x: &[f64]| 0.5 * work(&times(shaft.n(), matrix, x), x);
    [half(&shaft.mass, v), half(&shaft.stiffness, q)]
}

fn work(force: &[f64], change: &[f64]) -> f64 {
    force.iter().zip(change).map(|(f, u)| f * u).sum()
}
