//! What a step does to one flexible ring: predictor, columns, the compliance its contacts and its partner see, update.
//!
//! Contacts and partner act by a compliance C and then by the increment that their forces make. A sparse factor gives both by
//! columns, one block solve of 1 + 2 n_balls right-hand sides per step, which reads the factor once. A periodic ring has C in a
//! table of the responses of its raceway, made once per step size, and its vectors stay in harmonic space ([`super::space`]): the pass that
//! ends a step solves for the predictor of the next (`pass`), and the raceway alone is transformed. The columns of a ring in
//! sectors stay by sector ([`super::by_sector`]). The columns of the mount are solved once per step size. A defect of the ring
//! corrects all of it (`motion::defect`).

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use contact::NodalWeights;
use dense::DenseCholesky;
use solver::LinearSolver;
use solver::cyclic::Defect;

use super::body::RingBody;
use super::by_sector::{Motions, StepColumns};
use super::defect::DefectStep;
use super::effective::Factored;
use super::harmonic_step::Rows;
use super::integrator::Integrator;
use super::pass::{Acting, Coming, Increment};
use super::pool::PooledVector;
pub use super::ring_state::RingState;
use super::space::Space;
use super::vectors::add;
use crate::error::DynamicsError;
use crate::sparse::{SparseLoad, sparse_dot};

/// The factor of one ring at one step size.
pub struct RingFactor {
    pub(super) factor: Factored,
    /// Inverse of the border's compliance where S has one, row-major.
    pub(super) border: Option<Vec<f64>>,
    /// S^-1 times the mount's functionals, column-major `[n][n_mount]`; none of a ring in sectors, whose factor has them.
    pub(super) mount: Vec<f64>,
    /// The mount's compliance, row-major.
    pub(super) mount_compliance: Vec<f64>,
    pub(super) integrator: Integrator,
    pub(super) dt: f64,
}

/// A ring over one step as contacts and partner see it: g = start, then g1 = predicted + C F, over the two directions
/// of every contact and the functionals of the mount.
pub struct RingStep {
    pub(super) predictor: Predictor,
    /// Functionals of the contacts.
    pub(super) contacts: Vec<SparseLoad>,
    /// g at the start of the step, m and rad.
    pub start: Vec<f64>,
    /// g at its end without forces.
    pub predicted: Vec<f64>,
    /// Compliance over the step, row-major, SI.
    pub compliance: Vec<f64>,
    /// Wall time of the predictor's right-hand side, of the block solve, and of what the table of responses says of the contacts, s.
    pub seconds: [f64; 3],
}

/// The increment without forces of contacts and partner.
pub(super) enum Predictor {
    /// Itself, then the increments per unit contact force: column-major `[n][1 + 2 n_contacts]`.
    Columns(Vec<f64>),
    /// Of the regular ring, the first half of its solve, harmonics and the rows of the border, and what a defect makes of it.
    Harmonic(Arc<PooledVector>, Option<DefectStep>),
    /// As columns, by sector.
    Sectors(StepColumns),
}

impl RingFactor {
    /// Factors the ring for steps of `dt` seconds.
    pub fn new(body: &RingBody, integrator: Integrator, dt: f64) -> Result<RingFactor, DynamicsError> {
        let factor = body.factor(integrator, dt)?;
        let n = body.coordinates.n();
        let m = body.mount.len();
        let (mount, mount_compliance) = match &factor {
            Factored::Sectors(factor) => (Vec::new(), factor.mount_compliance(&body.mount)),
            Factored::Sparse(_) | Factored::Cyclic(_) => {
                let mount = columns(factor.solver(), &body.mount, n);
                let entry = |k: usize| sparse_dot(&body.mount[k / m], &mount[n * (k % m)..n * (k % m + 1)]);
                let compliance = (0..m * m).map(entry).collect();
                (mount, compliance)
            }
        };
        // The border of S is the mount of a clamped bore.
        let border = body.is_bordered().then(|| {
            DenseCholesky::factor(m, &mount_compliance)
                .expect("the shaft's compliance is positive definite")
                .inverse()
        });
        Ok(RingFactor {
            factor,
            border,
            mount,
            mount_compliance,
            integrator,
            dt,
        })
    }

    /// Bytes of the factor and of the table.
    pub fn bytes(&self) -> usize {
        self.factor.bytes()
    }

    /// Of a ring with a defect, see [`solver::cyclic::Defect::iterations`].
    pub fn iterations(&self) -> Option<usize> {
        self.factor.defect().map(Defect::iterations)
    }

    /// Motion of the groove centres, `[2 n_contacts]`, in a step when the ring moves by `x`, of its space.
    pub fn contact_motion(&self, body: &RingBody, step: &RingStep, x: &[f64]) -> Vec<f64> {
        self.measure(body, &step.contacts.iter().collect::<Vec<_>>(), x)
    }

    /// Values of functionals on what contacts and partner touch, at `x` of the ring's space.
    pub(super) fn measure(&self, body: &RingBody, functionals: &[&SparseLoad], x: &[f64]) -> Vec<f64> {
        match (&self.factor, &body.space) {
            (Factored::Cyclic(factor), Space::Harmonic(_)) => factor.measure(x, functionals),
            _ => functionals.iter().map(|g| sparse_dot(g, x)).collect(),
        }
    }

    /// Predictor and columns of a step from `state` under the generalised load `load`, of the ring's space, and with contacts at
    /// `feet`.
    pub fn prepare(
        &self,
        body: &RingBody,
        state: &RingState,
        load: Option<&[f64]>,
        feet: &[NodalWeights],
    ) -> RingStep {
        let clock = Instant::now();
        if let Factored::Cyclic(factor) = &self.factor {
            let (predictor, sides) = match self.pass(body) {
                Some(pass) => (pass.predict(state, Coming { load, turn: None }).solved, 0.0),
                None => {
                    let side = self.right_side(body, state, load);
                    let sides = clock.elapsed().as_secs_f64();
                    (factor.begin(&body.space, side).into(), sides)
                }
            };
            let solve = clock.elapsed().as_secs_f64() - sides;
            let mut step = self.prepare_solved(body, (state, None), Arc::new(predictor), feet);
            (step.seconds[0], step.seconds[1]) = (sides, solve);
            return step;
        }
        let n = body.coordinates.n();
        let contacts = functionals(body, feet);
        let mut side = self.right_side(body, state, load);
        let all: Vec<&SparseLoad> = contacts.iter().chain(&body.mount).collect();
        let start = self.measure(body, &all, state.displacement());
        let sides = clock.elapsed().as_secs_f64();
        let (predictor, moved, compliance) = match &self.factor {
            Factored::Cyclic(_) => unreachable!("prepared above"),
            Factored::Sparse(solver) => {
                side.resize(n * (1 + contacts.len()), 0.0);
                fill(&mut side[n..], &contacts, n);
                solver.solve(&mut side, 1 + contacts.len());
                let (moved, compliance) = self.column_motion(&side, n, &all);
                (Predictor::Columns(side), moved, compliance)
            }
            Factored::Sectors(factor) => {
                let (columns, motions) = factor.prepare(&side, &contacts, &all);
                let compliance = self.motion_compliance(&motions);
                (Predictor::Sectors(columns), motions.predicted, compliance)
            }
        };
        let all = clock.elapsed().as_secs_f64();
        RingStep {
            predictor,
            predicted: sum(&start, &moved),
            start,
            compliance,
            seconds: [sides, all - sides, 0.0],
            contacts,
        }
    }

    /// Whether contacts are moved by the table of responses, without a solve.
    pub fn has_table(&self) -> bool {
        matches!(self.factor, Factored::Cyclic(_))
    }

    /// Moves the contacts of a step from `state` to `feet`: products with the table, or one block solve of a sparse factor.
    pub fn move_contacts(
        &self,
        body: &RingBody,
        state: &RingState,
        step: &mut RingStep,
        feet: &[NodalWeights],
    ) {
        let n = body.coordinates.n();
        step.contacts = functionals(body, feet);
        let all: Vec<&SparseLoad> = step.contacts.iter().chain(&body.mount).collect();
        step.start = self.measure(body, &all, state.displacement());
        let (moved, compliance) = match (&self.factor, &mut step.predictor) {
            (Factored::Cyclic(factor), Predictor::Harmonic(predictor, defect)) => {
                let (met, moved, compliance) =
                    self.meet((body, Rows::Of(defect.take())), factor, predictor, feet, &all);
                *defect = met;
                (moved, compliance)
            }
            (Factored::Sparse(solver), Predictor::Columns(block)) => {
                block[n..].fill(0.0);
                fill(&mut block[n..], &step.contacts, n);
                solver.solve(&mut block[n..], step.contacts.len());
                self.column_motion(block, n, &all)
            }
            (Factored::Sectors(factor), Predictor::Sectors(columns)) => {
                let motions = factor.move_contacts(columns, &step.contacts, &all);
                let compliance = self.motion_compliance(&motions);
                (motions.predicted, compliance)
            }
            _ => unreachable!("a step keeps what its factor made"),
        };
        step.predicted = sum(&step.start, &moved);
        step.compliance = compliance;
    }

    /// Motion of `all`, contacts, then mount, by the predictor of a block of columns of n coordinates, and their compliance.
    fn column_motion(&self, block: &[f64], n: usize, all: &[&SparseLoad]) -> (Vec<f64>, Vec<f64>) {
        let (predictor, columns) = block.split_at(n);
        let moved = all.iter().map(|g| sparse_dot(g, predictor)).collect();
        let compliance = self.column_compliance(all.len(), columns.len() / n, |i, j| {
            sparse_dot(all[i], &columns[n * j..n * (j + 1)])
        });
        (moved, compliance)
    }

    /// Compliance of contacts, then mount, of a ring in sectors, from what they have measured.
    fn motion_compliance(&self, motions: &Motions) -> Vec<f64> {
        let size = motions.predicted.len();
        let contacts = motions.by_contacts.len() / size.max(1);
        self.column_compliance(size, contacts, |i, j| motions.by_contacts[contacts * i + j])
    }

    /// Compliance of contacts, then mount, `size` functionals in all, exactly symmetric, from the `motion(i, j)` of functional
    /// i under a unit force on contact j.
    fn column_compliance(
        &self,
        size: usize,
        contacts: usize,
        motion: impl Fn(usize, usize) -> f64,
    ) -> Vec<f64> {
        let mut compliance = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let value = if j < contacts {
                    motion(i, j)
                } else {
                    self.mount_compliance[(size - contacts) * (i - contacts) + j - contacts]
                };
                (compliance[size * i + j], compliance[size * j + i]) = (value, value);
            }
        }
        compliance
    }

    /// Factors of v and a under M, and under K, on the right-hand side.
    pub(super) fn history(&self, body: &RingBody) -> [[f64; 2]; 2] {
        let [mass, damping] = self.integrator.history(self.dt);
        let [am, ak] = body.damping;
        [
            [mass[0] + am * damping[0], mass[1] + am * damping[1]],
            [ak * damping[0], ak * damping[1]],
        ]
    }

    /// f - K w0 + M (history) + C (history), the right-hand side of S dw, of coordinates.
    fn right_side(&self, body: &RingBody, state: &RingState, load: Option<&[f64]>) -> Vec<f64> {
        let [mass, stiffness] = self.history(body);
        let mut side = body.balance(state, mass, stiffness);
        if let Some(load) = load {
            add(&mut side, load);
        }
        side
    }

    /// Adds a generalised load, of the ring's space, to the step; one solve.
    pub fn add_load(&self, body: &RingBody, step: &mut RingStep, mut load: Vec<f64>) {
        let all: Vec<&SparseLoad> = step.contacts.iter().chain(&body.mount).collect();
        let moved: Vec<f64> = match (&self.factor, &mut step.predictor) {
            (Factored::Cyclic(factor), Predictor::Harmonic(predictor, correction)) => {
                let more = factor.begin(&body.space, load);
                let whole: &mut PooledVector = Arc::make_mut(predictor);
                add(whole, &more);
                let mut moved = factor.measure(&more, &all);
                if let (Some(defect), Some(correction)) = (self.factor.defect(), correction) {
                    let corrected = correction.add(defect, &factor.at_rows(defect, &more));
                    moved.iter_mut().zip(corrected).for_each(|(m, d)| *m += d);
                }
                moved
            }
            (Factored::Sparse(solver), Predictor::Columns(block)) => {
                solver.solve(&mut load, 1);
                block.iter_mut().zip(&load).for_each(|(p, d)| *p += d);
                all.iter().map(|g| sparse_dot(g, &load)).collect()
            }
            (Factored::Sectors(factor), Predictor::Sectors(columns)) => factor.add_load(columns, &load, &all),
            _ => unreachable!("a step keeps what its factor made"),
        };
        step.predicted.iter_mut().zip(&moved).for_each(|(p, d)| *p += d);
    }

    /// Increment, in the ring's space, under forces on contacts (N, `[2 n_contacts]`) and mount (N and N m).
    pub fn increment(&self, body: &RingBody, step: &RingStep, contacts: &[f64], mount: &[f64]) -> Vec<f64> {
        match (&self.factor, &step.predictor) {
            (Factored::Cyclic(factor), Predictor::Harmonic(predictor, correction)) => {
                let by_defect = factor.by_defect(correction.as_ref(), contacts, mount);
                let loads = acting(body, step, contacts, mount).chain(by_defect);
                factor.increment(&body.space, predictor, loads)
            }
            (Factored::Sectors(factor), Predictor::Sectors(columns)) => {
                factor.increment(columns, contacts, mount)
            }
            (_, Predictor::Columns(block)) => {
                let n = body.coordinates.n();
                let mut dw = block[..n].to_vec();
                let columns = block[n..].chunks_exact(n).zip(contacts);
                for (column, &f) in columns.chain(self.mount.chunks_exact(n).zip(mount)) {
                    if f != 0.0 {
                        dw.iter_mut().zip(column).for_each(|(d, c)| *d += f * c);
                    }
                }
                dw
            }
            _ => unreachable!("a step keeps what its factor made"),
        }
    }

    /// The state at the end of a step with increment `dw`.
    pub fn advance(&self, body: &RingBody, state: &RingState, dw: &[f64]) -> RingState {
        match self.pass(body) {
            Some(pass) => {
                let increment = Increment {
                    forces: None,
                    rest: Cow::Borrowed(dw),
                };
                pass.end(state, increment, Acting::default(), None).state
            }
            None => state.advanced(self.integrator, self.dt, dw),
        }
    }
}

/// Generalised loads of forces on contacts and mount, index and value.
pub(super) fn acting<'a>(
    body: &'a RingBody,
    step: &'a RingStep,
    contacts: &'a [f64],
    mount: &'a [f64],
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let contacts = step.contacts.iter().zip(contacts);
    let all = contacts.chain(body.mount.iter().zip(mount));
    all.flat_map(|(functional, f)| functional.iter().map(move |&(i, w)| (i, f * w)))
}

/// Functionals of contacts at `feet`, two each.
pub(super) fn functionals(body: &RingBody, feet: &[NodalWeights]) -> Vec<SparseLoad> {
    let reduced = feet.iter().flat_map(|foot| body.coordinates.reduce_weights(foot));
    reduced.collect()
}

/// Component-wise a + b.
pub(super) fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// S^-1 of sparse loads, column-major `[n][loads]`.
fn columns(factor: &dyn LinearSolver, loads: &[SparseLoad], n: usize) -> Vec<f64> {
    let mut columns = vec![0.0; n * loads.len()];
    fill(&mut columns, loads, n);
    factor.solve(&mut columns, loads.len());
    columns
}

/// Writes sparse loads into zeroed columns.
fn fill(columns: &mut [f64], loads: &[SparseLoad], n: usize) {
    for (column, load) in columns.chunks_exact_mut(n).zip(loads) {
        load.iter().for_each(|&(i, value)| column[i] = value);
    }
}
