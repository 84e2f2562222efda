//! What a step does to one flexible ring: predictor, columns, the compliance its contacts and its partner see, update.
//!
//! Contacts and partner act by a compliance C and then by the increment that their forces make. A sparse factor gives both by
//! columns, one block solve of 1 + 2 n_balls right-hand sides per step, which reads the factor once. A periodic ring has C in a
//! table of the responses of its raceway, made once per step size; its predictor stays in harmonic space, where contact
//! forces are added, so that a step takes two solves but transforms one whole field there and one back. The columns of the
//! mount are solved once per step size. A defect of the ring corrects all of it ([`super::defect`]).

use contact::NodalWeights;
use solver::LinearSolver;
use solver::cyclic::Defect;
use solver::dense::DenseCholesky;

use super::body::RingBody;
use super::defect::DefectStep;
use super::effective::Factored;
use super::integrator::Integrator;
use crate::error::DynamicsError;
use crate::sparse::{SparseLoad, sparse_dot};

/// The factor of one ring at one step size.
pub struct RingFactor {
    pub(super) factor: Factored,
    /// Inverse of the border's compliance where S has one, row-major.
    pub(super) border: Option<Vec<f64>>,
    /// S^-1 times the mount's functionals, column-major `[n][n_mount]`.
    pub(super) mount: Vec<f64>,
    /// The mount's compliance, row-major.
    pub(super) mount_compliance: Vec<f64>,
    integrator: Integrator,
    dt: f64,
}

/// Displacement, velocity, acceleration of a ring's coordinates, `[n]` each, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RingState {
    /// Total displacement in the ring's frame.
    pub w: Vec<f64>,
    /// Velocity.
    pub v: Vec<f64>,
    /// Acceleration.
    pub a: Vec<f64>,
}

impl RingState {
    /// At rest, without acceleration, at the displacement `w`.
    pub fn at_rest(w: Vec<f64>) -> RingState {
        let zero = vec![0.0; w.len()];
        RingState {
            w,
            v: zero.clone(),
            a: zero,
        }
    }

    /// Displacement and velocity at the weighted time of the scheme when the step's increment is `dw`.
    pub fn within(&self, integrator: Integrator, dt: f64, dw: &[f64]) -> [Vec<f64>; 2] {
        let s = 1.0 - integrator.alpha_f;
        let w = self.w.iter().zip(dw).map(|(w, d)| w + s * d).collect();
        let v = self.v.iter().zip(&self.a).zip(dw).map(|((v0, a0), d)| {
            let [v1, _] = integrator.update(dt, *d, *v0, *a0);
            v0 + s * (v1 - v0)
        });
        [w, v.collect()]
    }
}

/// A ring over one step as contacts and partner see it: g = start, then g1 = predicted + C F, over the two directions
/// of every contact and the functionals of the mount.
pub struct RingStep {
    predictor: Predictor,
    /// Functionals of the contacts.
    contacts: Vec<SparseLoad>,
    /// g at the start of the step, m and rad.
    pub start: Vec<f64>,
    /// g at its end without forces.
    pub predicted: Vec<f64>,
    /// Compliance over the step, row-major, SI.
    pub compliance: Vec<f64>,
    /// Wall time of the predictor's right-hand side and of the block solve, s.
    pub seconds: [f64; 2],
}

/// The increment without forces of contacts and partner.
enum Predictor {
    /// Itself, then the increments per unit contact force: column-major `[n][1 + 2 n_contacts]`.
    Columns(Vec<f64>),
    /// Of the regular ring in harmonic space, the rows of the border, and what a defect makes of it.
    Harmonic(Vec<f64>, Vec<f64>, Option<DefectStep>),
}

impl RingStep {
    /// Motion of the groove centres, `[2 n_contacts]`, when the coordinates move by `x`.
    pub fn contact_motion(&self, x: &[f64]) -> Vec<f64> {
        self.contacts.iter().map(|g| sparse_dot(g, x)).collect()
    }
}

impl RingFactor {
    /// Factors the ring for steps of `dt` seconds.
    pub fn new(body: &RingBody, integrator: Integrator, dt: f64) -> Result<RingFactor, DynamicsError> {
        let factor = body.factor(integrator, dt)?;
        let n = body.coordinates.n();
        let mount = columns(factor.solver(), &body.mount, n);
        let m = body.mount.len();
        let mut mount_compliance = vec![0.0; m * m];
        for i in 0..m {
            for j in 0..m {
                mount_compliance[m * i + j] = sparse_dot(&body.mount[i], &mount[n * j..n * (j + 1)]);
            }
        }
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

    /// Predictor and columns of a step from `state` under the generalised load `load` and with contacts at `feet`.
    pub fn prepare(
        &self,
        body: &RingBody,
        state: &RingState,
        load: &[f64],
        feet: &[NodalWeights],
    ) -> RingStep {
        let clock = std::time::Instant::now();
        let n = body.coordinates.n();
        let contacts = functionals(body, feet);
        let mut side = self.right_side(body, state, load);
        let all: Vec<&SparseLoad> = contacts.iter().chain(&body.mount).collect();
        let start: Vec<f64> = all.iter().map(|g| sparse_dot(g, &state.w)).collect();
        let sides = clock.elapsed().as_secs_f64();
        let (predictor, moved, compliance) = match &self.factor {
            Factored::Cyclic(factor) => {
                let (harmonic, border) = factor.solve(&side);
                let (defect, moved, compliance) = self.meet(body, factor, [&harmonic, &border], feet, &all);
                (Predictor::Harmonic(harmonic, border, defect), moved, compliance)
            }
            Factored::Sparse(solver) => {
                side.resize(n * (1 + contacts.len()), 0.0);
                fill(&mut side[n..], &contacts, n);
                solver.solve(&mut side, 1 + contacts.len());
                let moved: Vec<f64> = all.iter().map(|g| sparse_dot(g, &side[..n])).collect();
                let compliance = self.column_compliance(&all, &side[n..], n);
                (Predictor::Columns(side), moved, compliance)
            }
        };
        RingStep {
            predictor,
            predicted: start.iter().zip(&moved).map(|(s, d)| s + d).collect(),
            start,
            compliance,
            seconds: [sides, clock.elapsed().as_secs_f64() - sides],
            contacts,
        }
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
        step.start = all.iter().map(|g| sparse_dot(g, &state.w)).collect();
        let (moved, compliance) = match (&self.factor, &mut step.predictor) {
            (Factored::Cyclic(factor), Predictor::Harmonic(harmonic, border, defect)) => {
                let (met, moved, compliance) = self.meet(body, factor, [harmonic, border], feet, &all);
                *defect = met;
                (moved, compliance)
            }
            (Factored::Sparse(solver), Predictor::Columns(block)) => {
                block[n..].fill(0.0);
                fill(&mut block[n..], &step.contacts, n);
                solver.solve(&mut block[n..], step.contacts.len());
                let moved: Vec<f64> = all.iter().map(|g| sparse_dot(g, &block[..n])).collect();
                (moved, self.column_compliance(&all, &block[n..], n))
            }
            _ => unreachable!("a step keeps what its factor made"),
        };
        step.predicted = step.start.iter().zip(&moved).map(|(s, d)| s + d).collect();
        step.compliance = compliance;
    }

    /// Compliance of contacts, then mount, exactly symmetric, from the columns of the contacts.
    fn column_compliance(&self, all: &[&SparseLoad], columns: &[f64], n: usize) -> Vec<f64> {
        let (size, contacts) = (all.len(), columns.len() / n);
        let mut compliance = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let value = if j < contacts {
                    sparse_dot(all[i], &columns[n * j..n * (j + 1)])
                } else {
                    self.mount_compliance[(size - contacts) * (i - contacts) + j - contacts]
                };
                (compliance[size * i + j], compliance[size * j + i]) = (value, value);
            }
        }
        compliance
    }

    /// f - K w0 + M (history) + C (history), the right-hand side of S dw.
    fn right_side(&self, body: &RingBody, state: &RingState, load: &[f64]) -> Vec<f64> {
        let [mass, damping] = self.integrator.history(self.dt);
        let [am, ak] = body.damping;
        let combine = |c: [f64; 2]| move |(v, a): (&f64, &f64)| c[0] * v + c[1] * a;
        let c_mass = [mass[0] + am * damping[0], mass[1] + am * damping[1]];
        let c_stiff = [ak * damping[0], ak * damping[1]];
        let inertial: Vec<f64> = state.v.iter().zip(&state.a).map(combine(c_mass)).collect();
        let elastic: Vec<f64> = state
            .w
            .iter()
            .zip(state.v.iter().zip(&state.a).map(combine(c_stiff)))
            .map(|(w, c)| c - w)
            .collect();
        let mut side = body
            .matrices
            .sum_of_products(&body.coordinates, &inertial, &elastic);
        side.iter_mut().zip(load).for_each(|(side, f)| *side += f);
        side
    }

    /// Adds a generalised load to the step; one solve.
    pub fn add_load(&self, body: &RingBody, step: &mut RingStep, mut load: Vec<f64>) {
        let all: Vec<&SparseLoad> = step.contacts.iter().chain(&body.mount).collect();
        let moved: Vec<f64> = match (&self.factor, &mut step.predictor) {
            (Factored::Cyclic(factor), Predictor::Harmonic(harmonic, border, correction)) => {
                let (more, q) = factor.solve(&load);
                harmonic.iter_mut().zip(&more).for_each(|(p, d)| *p += d);
                border.iter_mut().zip(&q).for_each(|(p, d)| *p += d);
                let [mut moved, at] = factor.motions(&more, &q, &all);
                if let (Some(defect), Some(correction)) = (self.factor.defect(), correction) {
                    let corrected = correction.add(defect, &at);
                    moved.iter_mut().zip(corrected).for_each(|(m, d)| *m += d);
                }
                moved
            }
            (Factored::Sparse(solver), Predictor::Columns(block)) => {
                solver.solve(&mut load, 1);
                block.iter_mut().zip(&load).for_each(|(p, d)| *p += d);
                all.iter().map(|g| sparse_dot(g, &load)).collect()
            }
            _ => unreachable!("a step keeps what its factor made"),
        };
        step.predicted.iter_mut().zip(&moved).for_each(|(p, d)| *p += d);
    }

    /// Increment of the coordinates under forces on contacts (N, `[2 n_contacts]`) and mount (N and N m).
    pub fn increment(&self, body: &RingBody, step: &RingStep, contacts: &[f64], mount: &[f64]) -> Vec<f64> {
        match (&self.factor, &step.predictor) {
            (Factored::Cyclic(factor), Predictor::Harmonic(harmonic, border, correction)) => {
                let mut load = vec![0.0; body.coordinates.n()];
                let loads = step
                    .contacts
                    .iter()
                    .zip(contacts)
                    .chain(body.mount.iter().zip(mount));
                for (functional, f) in loads {
                    functional.iter().for_each(|&(i, w)| load[i] += f * w);
                }
                if let (Some(defect), Some(correction)) = (&factor.defect, correction) {
                    correction.add_forces(defect, &[contacts, mount].concat(), &mut load);
                }
                factor.increment((harmonic, border), load)
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
    pub fn advance(&self, state: &RingState, dw: &[f64]) -> RingState {
        let (mut v, mut a) = (Vec::with_capacity(dw.len()), Vec::with_capacity(dw.len()));
        for ((d, v0), a0) in dw.iter().zip(&state.v).zip(&state.a) {
            let [v1, a1] = self.integrator.update(self.dt, *d, *v0, *a0);
            v.push(v1);
            a.push(a1);
        }
        let w = state.w.iter().zip(dw).map(|(w, d)| w + d).collect();
        RingState { w, v, a }
    }
}

/// Functionals of contacts at `feet`, two each.
fn functionals(body: &RingBody, feet: &[NodalWeights]) -> Vec<SparseLoad> {
    let reduced = feet.iter().flat_map(|foot| body.coordinates.reduce_weights(foot));
    reduced.collect()
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
