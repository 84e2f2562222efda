//! Contacts as the responses of a periodic ring's raceway meet them: their motion by the predictor, and their compliance.

use contact::NodalWeights;
use solver::LinearSolver;
use solver::cyclic::{Patch, ResponseTable};

use super::body::RingBody;
use super::defect::DefectStep;
use super::effective::CyclicFactor;
use super::ring::RingFactor;
use crate::sparse::{SparseLoad, sparse_dot};

/// Contacts as the responses of a raceway meet them.
struct Touch {
    patches: Vec<Patch>,
    /// Motion of each contact direction under unit forces of the mount, `[2 n_contacts][n_mount]`.
    by_mount: Vec<Vec<f64>>,
}

impl RingFactor {
    /// What a defect makes of the predictor, harmonics and border; the motion by the predictor of `all`, contacts at `feet`, then mount;
    /// and their compliance.
    pub(super) fn meet(
        &self,
        body: &RingBody,
        factor: &CyclicFactor,
        predictor: &[f64],
        feet: &[NodalWeights],
        all: &[&SparseLoad],
    ) -> (Option<DefectStep>, Vec<f64>, Vec<f64>) {
        let [mut moved, at] = factor.motions(predictor, all);
        let touch = self.touch(body, &factor.table, feet, &all[..2 * feet.len()]);
        let mut compliance = self.table_compliance(&factor.table, &touch, body.mount.len());
        let step = factor.defect.as_ref().map(|defect| {
            let answers = self.answers(factor, &touch, defect.rows(), body.coordinates.n());
            let step = DefectStep::new(at, answers);
            let more = step.motion(defect);
            moved.iter_mut().zip(more).for_each(|(m, d)| *m += d);
            step.soften(defect, &mut compliance);
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
        Touch {
            patches: feet.iter().map(patch).collect(),
            by_mount: contacts.iter().map(moved).collect(),
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
                    (true, _) => direct[n * i + j] + self.by_border(&v[i], &v[j]),
                    (false, true) => v[j][i - n],
                    (false, false) => self.mount_compliance[m * (i - n) + j - n],
                };
                (compliance[size * i + j], compliance[size * j + i]) = (value, value);
            }
        }
        compliance
    }

    /// Motion of contacts, then mount, under unit forces on the `rows` of n coordinates, row-major, without a defect.
    fn answers(&self, factor: &CyclicFactor, touch: &Touch, rows: &[usize], n: usize) -> Vec<f64> {
        let columns: Vec<&[f64]> = self.mount.chunks_exact(n).collect();
        let (table, n_free) = (&factor.table, factor.solver.inner().n());
        let free: Vec<usize> = rows.iter().copied().filter(|&row| row < n_free).collect();
        let direct: Vec<Vec<[f64; 2]>> = touch.patches.iter().map(|p| table.of_patch(&free, p)).collect();
        let mut answers = Vec::with_capacity(rows.len() * (touch.by_mount.len() + columns.len()));
        // Rows of the border come last, so the free ones keep their numbers.
        for (i, &row) in rows.iter().enumerate() {
            let by_mount: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            answers.extend(
                touch
                    .by_mount
                    .iter()
                    .enumerate()
                    .map(|(k, v)| match row.checked_sub(n_free) {
                        Some(shaft) => v[shaft],
                        None => direct[k / 2][i][k % 2] + self.by_border(&by_mount, v),
                    }),
            );
            answers.extend(by_mount);
        }
        answers
    }

    /// a M^-1 b for two rows of V; zero without a border.
    fn by_border(&self, a: &[f64], b: &[f64]) -> f64 {
        let Some(inverse) = &self.border else { return 0.0 };
        let m = b.len();
        let row = |i: usize| (0..m).map(|j| inverse[m * i + j] * b[j]).sum::<f64>();
        a.iter().enumerate().map(|(i, a)| a * row(i)).sum()
    }
}
