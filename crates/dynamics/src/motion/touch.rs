//! Contacts as the responses of a periodic ring's raceway meet them: their motion by the predictor, and their compliance.

use contact::NodalWeights;
use solver::LinearSolver;
use solver::cyclic::{Patch, ResponseTable};

use super::body::RingBody;
use super::defect::{DefectFactor, DefectStep};
use super::effective::CyclicFactor;
use super::harmonic_step::Rows;
use super::ring::RingFactor;
use crate::solution::dot;
use crate::sparse::{SparseLoad, sparse_dot};

/// Contacts as the responses of a raceway meet them.
struct Touch {
    patches: Vec<Patch>,
    /// Motion of each contact direction under unit forces of the mount, `[2 n_contacts][n_mount]`.
    by_mount: Vec<Vec<f64>>,
    /// M^-1 times these, with M the border's compliance; empty without a border.
    by_border: Vec<Vec<f64>>,
}

impl RingFactor {
    /// What a defect makes of the predictor, harmonics and border; the motion by the predictor of `all`, contacts at `feet`, then mount;
    /// and their compliance.
    pub(super) fn meet(
        &self,
        (body, rows): (&RingBody, Rows<'_>),
        factor: &CyclicFactor,
        predictor: &[f64],
        feet: &[NodalWeights],
        all: &[&SparseLoad],
    ) -> (Option<DefectStep>, Vec<f64>, Vec<f64>) {
        let mut moved = factor.measure(predictor, all);
        let touch = self.touch(body, &factor.table, feet, &all[..2 * feet.len()]);
        let mut compliance = self.table_compliance(&factor.table, &touch, body.mount.len());
        let step = factor.defect.as_ref().map(|defect| {
            let n_free = factor.solver.inner().n();
            let answers = self.answers(defect, &touch, n_free, body.coordinates.n());
            let step = match rows {
                Rows::Of(Some(old)) => old.met_by(answers),
                Rows::Of(None) => unreachable!("a ring keeps its defect"),
                Rows::Found(from) => {
                    self.defect_step((body, from), (factor, &defect.answer), predictor, answers)
                }
            };
            let more = step.motion(&defect.answer);
            moved.iter_mut().zip(more).for_each(|(m, d)| *m += d);
            step.soften(&defect.answer, &mut compliance);
            step
        });
        (step, moved, compliance)
    }

    /// What the responses of the raceway need to know of the contacts.
    fn touch(
        &self,
        body: &RingBody,
        table: &ResponseTable,
        feet: &[NodalWeights],
        contacts: &[&SparseLoad],
    ) -> Touch {
        let patch = |foot: &NodalWeights| {
            let free = |node: &usize| body.coordinates.free_node(*node);
            let nodes: Option<Vec<usize>> = foot.nodes.iter().map(free).collect();
            let nodes = nodes.expect("no raceway node of a periodic ring is held");
            table
                .patch(&nodes, &foot.coefficients)
                .expect("patches lie on the raceway")
        };
        let columns: Vec<&[f64]> = self.mount.chunks_exact(body.coordinates.n()).collect();
        let moved = |contact: &&SparseLoad| columns.iter().map(|y| sparse_dot(contact, y)).collect();
        let by_mount: Vec<Vec<f64>> = contacts.iter().map(moved).collect();
        Touch {
            patches: feet.iter().map(patch).collect(),
            by_border: by_mount.iter().map(|v| self.times_border(v)).collect(),
            by_mount,
        }
    }

    /// Compliance of contacts, then mount, from the responses of the raceway: those of the ring without its border, plus what
    /// the border adds, V M^-1 V^T, with M the border's compliance and V the motion of the contacts under its unit forces.
    fn table_compliance(&self, table: &ResponseTable, touch: &Touch, m: usize) -> Vec<f64> {
        let (direct, v) = (table.compliances(&touch.patches), &touch.by_mount);
        let n = v.len();
        let size = n + m;
        let mut compliance = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let value = match (i < n, j < n) {
                    (true, _) => direct[n * i + j] + dot(&v[i], &touch.by_border[j]),
                    (false, true) => v[j][i - n],
                    (false, false) => self.mount_compliance[m * (i - n) + j - n],
                };
                (compliance[size * i + j], compliance[size * j + i]) = (value, value);
            }
        }
        compliance
    }

    /// Motion of contacts, then mount, under unit forces on the rows of a defect, row-major, without the defect; of n coordinates n_free are
    /// free.
    fn answers(&self, defect: &DefectFactor, touch: &Touch, n_free: usize, n: usize) -> Vec<f64> {
        let (rows, contacts) = (defect.answer.rows(), touch.by_mount.len());
        let columns: Vec<&[f64]> = self.mount.chunks_exact(n).collect();
        let direct = defect.responses.of_patches(&touch.patches);
        let mut answers = Vec::with_capacity(rows.len() * (contacts + columns.len()));
        // Rows of the border come last, so the free ones keep their numbers.
        for (i, &row) in rows.iter().enumerate() {
            let by_mount: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            match row.checked_sub(n_free) {
                Some(shaft) => answers.extend(touch.by_mount.iter().map(|v| v[shaft])),
                None => {
                    let both = direct[contacts * i..][..contacts].iter().zip(&touch.by_border);
                    answers.extend(both.map(|(direct, border)| direct + dot(&by_mount, border)));
                }
            }
            answers.extend(by_mount);
        }
        answers
    }

    /// M^-1 b for a row of V; empty without a border.
    fn times_border(&self, b: &[f64]) -> Vec<f64> {
        let inverse = self.border.as_deref().unwrap_or_default();
        inverse
            .chunks_exact(b.len().max(1))
            .map(|row| dot(row, b))
            .collect()
    }
}
