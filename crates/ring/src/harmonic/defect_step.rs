//! The defect of a periodic ring during a step: the regular ring answers, and the forces of the defect correct it.
//!
//! The rows of the defect are functionals like those of the contacts. With t their values when the regular ring is
//! under all other loads, the defect acts with f = -S t ([`solver::cyclic::Defect`]). V holds the motion of contacts
//! and mount under unit forces on these rows, and of the rows under theirs. So contacts and mount see V^T f more
//! motion and the compliance C - V^T S V, and a step needs no further solve.

use solver::cyclic::{Defect, RowResponses};

/// What a defect makes of a factored ring.
pub struct DefectFactor {
    /// The answer of the ring to it.
    pub answer: Defect,
    /// Displacements of its free rows under loads on the raceway, without it.
    pub responses: RowResponses,
}

impl DefectFactor {
    /// Bytes of both.
    pub fn bytes(&self) -> usize {
        self.answer.bytes() + self.responses.bytes()
    }
}

/// Rows of a defect in a step.
pub struct DefectStep {
    /// Values of the rows without the defect and the forces of contacts and mount, t, `[n]`.
    at: Vec<f64>,
    /// Known forces on the rows besides -S t, [`super::space_defect`]; empty when there are none.
    known: Vec<f64>,
    /// Inertia of the turning frame on the rows of [`super::space_defect`]; empty when there is none.
    inertia: Vec<f64>,
    /// V, row-major `[n][functionals]`.
    answers: Vec<f64>,
}

impl DefectStep {
    /// The rows at the predictor's values `at`; `answers` is V.
    pub fn new(at: Vec<f64>, answers: Vec<f64>) -> DefectStep {
        DefectStep {
            at,
            answers,
            known: Vec::new(),
            inertia: Vec::new(),
        }
    }

    /// The rows at the values by the known forces `known` on them, of which `inertia` is a part.
    pub fn under(defect: &Defect, known: Vec<f64>, inertia: Vec<f64>, answers: Vec<f64>) -> DefectStep {
        DefectStep {
            at: defect.moved(&known),
            answers,
            known,
            inertia,
        }
    }

    /// The same rows with other contacts, which `answers` is V of.
    pub fn met_by(self, answers: Vec<f64>) -> DefectStep {
        DefectStep { answers, ..self }
    }

    /// V.
    pub fn into_answers(self) -> Vec<f64> {
        self.answers
    }

    /// Inertia of the turning frame on the rows, the true ring's less the regular one's.
    pub fn inertia(&self) -> &[f64] {
        &self.inertia
    }

    /// Forces on the rows at the displacements `at`.
    fn acting(&self, defect: &Defect, at: &[f64]) -> Vec<f64> {
        let mut forces = defect.forces(at);
        forces.iter_mut().zip(&self.known).for_each(|(f, q)| *f += q);
        forces
    }

    /// Motion of contacts and mount by the defect.
    pub fn motion(&self, defect: &Defect) -> Vec<f64> {
        self.moved(&self.acting(defect, &self.at))
    }

    /// V^T f.
    fn moved(&self, forces: &[f64]) -> Vec<f64> {
        let n = self.answers.len() / forces.len().max(1);
        let mut moved = vec![0.0; n];
        for (row, f) in self.answers.chunks_exact(n.max(1)).zip(forces) {
            moved.iter_mut().zip(row).for_each(|(m, v)| *m += f * v);
        }
        moved
    }

    /// Adds -V^T S V to the compliance of contacts and mount, row-major; exactly symmetric.
    pub fn soften(&self, defect: &Defect, compliance: &mut [f64]) {
        let change = defect.form(&self.answers, compliance.len().isqrt());
        compliance.iter_mut().zip(change).for_each(|(c, d)| *c -= d);
    }

    /// Adds what more loads move the rows by, and returns the motion of contacts and mount by the forces that this
    /// adds.
    pub fn add(&mut self, defect: &Defect, more: &[f64]) -> Vec<f64> {
        self.at.iter_mut().zip(more).for_each(|(t, d)| *t += d);
        self.moved(&defect.forces(more))
    }

    /// Forces of the defect on its rows, index and value, when contacts and mount act with `forces` on the regular
    /// ring.
    pub fn loads(&self, defect: &Defect, forces: &[f64]) -> Vec<(usize, f64)> {
        let rows = self.answers.chunks_exact(forces.len().max(1));
        let total = self.at.iter().zip(rows).map(|(t, row)| {
            let by_forces: f64 = row.iter().zip(forces).map(|(v, f)| v * f).sum();
            t + by_forces
        });
        let acting = self.acting(defect, &total.collect::<Vec<f64>>());
        defect.rows().iter().copied().zip(acting).collect()
    }
}
