//! Contacts as the responses of a periodic ring's raceway meet them: their motion by the predictor, and their
//! compliance.

use contact::NodalWeights;
use solver::LinearSolver;
use solver::cyclic::{PairWeights, PatchWeights};

use super::defect_step::{DefectFactor, DefectStep};
use super::factor::CyclicFactor;
use crate::body::HeldRing;
use crate::nodal::columns::{Moved, Ports};
use crate::vectors::dot;

/// Contacts as the responses of a raceway meet them.
struct Touch {
    /// One by contact, of all its functionals.
    patches: Vec<PatchWeights>,
    /// Motion of each functional of the contacts under unit forces of the mount, `[n][n_mount]`.
    by_mount: Vec<Vec<f64>>,
    /// M^-1 times these, with M the border's compliance; empty without a border.
    by_border: Vec<Vec<f64>>,
}

/// Contacts and mount under a predictor.
pub(super) struct Meeting {
    /// What the defect makes of it.
    pub step: Option<DefectStep>,
    /// What the ports see.
    pub moved: Moved,
}

impl CyclicFactor {
    /// What ports see of a predictor, harmonics and border; `defect_step` makes the step of a defect from the motion
    /// of its rows under unit forces at the ports.
    pub(super) fn meet(
        &self,
        held: &HeldRing,
        ports: &Ports,
        predictor: &[f64],
        defect_step: impl FnOnce(&DefectFactor, Vec<f64>) -> DefectStep,
    ) -> Meeting {
        let mut predicted = ports.values(held, |all| self.measure(predictor, all));
        let touch = self.touch(held, ports);
        let mut compliance = self.table_compliance(&touch, held.mount.len());
        let step = self.responses.defect.as_ref().map(|defect| {
            let n_free = self.solver.inner().n();
            let answers = self.answers(defect, &touch, n_free);
            let step = defect_step(defect, answers);
            let more = step.motion(&defect.answer);
            predicted.iter_mut().zip(more).for_each(|(m, d)| *m += d);
            step.soften(&defect.answer, &mut compliance);
            step
        });
        let moved = Moved {
            predicted,
            compliance,
        };
        Meeting { step, moved }
    }

    /// What the responses of the raceway need to know of the contacts.
    fn touch(&self, held: &HeldRing, ports: &Ports) -> Touch {
        let table = &self.responses.table;
        let free_nodes = |foot: &NodalWeights| -> Vec<usize> {
            let free = |node: &usize| held.coordinates.free_node(*node);
            let nodes: Option<Vec<usize>> = foot.nodes.iter().map(free).collect();
            nodes.expect("no raceway node of a periodic ring is held")
        };
        let patch = |feet: &[NodalWeights]| {
            let nodes: Vec<Vec<usize>> = feet.iter().map(free_nodes).collect();
            let pairs = nodes.iter().zip(feet);
            let pairs: Vec<PairWeights> = pairs.map(|(n, foot)| (&n[..], &foot.coefficients[..])).collect();
            table.patch(&pairs).expect("patches lie on the raceway")
        };
        let by_mount: Vec<Vec<f64>> = ports.contacts.iter().map(|c| self.mount.of(c)).collect();
        Touch {
            patches: ports.places.chunks_exact(ports.per_contact).map(patch).collect(),
            by_border: by_mount.iter().map(|v| self.times_border(v)).collect(),
            by_mount,
        }
    }

    /// Compliance of contacts, then mount, from the responses of the raceway: those of the ring without its border,
    /// plus what the border adds, V M^-1 V^T, with M the border's compliance and V the motion of the contacts under
    /// its unit forces.
    fn table_compliance(&self, touch: &Touch, m: usize) -> Vec<f64> {
        let (direct, v) = (self.responses.table.compliances(&touch.patches), &touch.by_mount);
        let n = v.len();
        let size = n + m;
        let mut compliance = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let value = match (i < n, j < n) {
                    (true, _) => direct[n * i + j] + dot(&v[i], &touch.by_border[j]),
                    (false, true) => v[j][i - n],
                    (false, false) => self.mount.compliance[m * (i - n) + j - n],
                };
                (compliance[size * i + j], compliance[size * j + i]) = (value, value);
            }
        }
        compliance
    }

    /// Motion of contacts, then mount, under unit forces on the rows of a defect, row-major, without the defect;
    /// `n_free` coordinates are free.
    fn answers(&self, defect: &DefectFactor, touch: &Touch, n_free: usize) -> Vec<f64> {
        let (rows, contacts) = (defect.answer.rows(), touch.by_mount.len());
        let direct = defect.responses.of_patches(&touch.patches);
        let mut answers = Vec::with_capacity(rows.len() * (contacts + self.mount.n()));
        // Rows of the border come last, so the free ones keep their numbers.
        for (i, &row) in rows.iter().enumerate() {
            let by_mount = self.mount.at(row);
            match row.checked_sub(n_free) {
                Some(shaft) => answers.extend(touch.by_mount.iter().map(|v| v[shaft])),
                None => {
                    let both = direct[contacts * i..][..contacts].iter().zip(&touch.by_border);
                    answers.extend(both.map(|(direct, border)| direct + dot(by_mount, border)));
                }
            }
            answers.extend(by_mount);
        }
        answers
    }

    /// M^-1 b for a row of V; empty without a border.
    fn times_border(&self, b: &[f64]) -> Vec<f64> {
        let inverse = self.border_inverse.as_deref().unwrap_or_default();
        inverse
            .chunks_exact(b.len().max(1))
            .map(|row| dot(row, b))
            .collect()
    }
}
