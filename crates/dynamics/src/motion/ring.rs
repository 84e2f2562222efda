//! One flexible ring in motion: its matrices, its factored effective matrix, and what a step does to it.
//!
//! Cost of a step: one solve, one block solve of 2 n_balls columns, two products with K and M.

use contact::quadrature::PressureRule;
use contact::{NodalWeights, RacewaySurface, Side};
use solver::{LinearSolver, SolverError, SparseCholesky, Symbolic};
use sprs::CsMat;

use super::coordinates::{Coordinates, SparseLoad};
use super::integrator::Integrator;
use super::run::Motion;
use crate::error::DynamicsError;
use crate::inventory::Inventory;
use crate::model::{Model, RACEWAY_GROUP, RingModel, ShaftDof};
use crate::ring::elimination_order;
use crate::solution::dot;

/// Matrices and factor of one ring at one step size.
pub struct RingMotion {
    /// Coordinates of the ring.
    pub coordinates: Coordinates,
    /// Raceway in (azimuth, groove angle).
    pub surface: RacewaySurface,
    /// Integration rule of the patches.
    pub rule: PressureRule,
    stiffness: CsMat<f64>,
    mass: CsMat<f64>,
    /// Rayleigh damping: C = damping[0] M + damping[1] K.
    damping: [f64; 2],
    factor: SparseCholesky,
    integrator: Integrator,
    dt: f64,
}

/// Displacement, velocity, acceleration of a ring's coordinates, `[n]` each, SI.
#[derive(Clone, Debug, PartialEq)]
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
}

/// What the contacts of a step see of a ring: u_c = start + predicted + C F.
pub struct RingStep {
    /// Predicted increment without contact forces, `[n]`.
    predictor: Vec<f64>,
    /// Increment per unit force, column-major `[n][2 n_contacts]`.
    columns: Vec<f64>,
    /// Motion of the groove centres at the start of the step, `[2 n_contacts]`, m.
    pub start: Vec<f64>,
    /// Their predicted motion at its end without contact forces.
    pub predicted: Vec<f64>,
    /// Their compliance over the step, row-major, m/N.
    pub compliance: Vec<f64>,
}

impl RingMotion {
    /// Assembles and factors the ring on `side` for steps of `dt` seconds.
    pub fn new(
        model: &Model,
        side: Side,
        ring: &RingModel,
        integrator: Integrator,
        dt: f64,
        damping: [f64; 2],
    ) -> Result<RingMotion, DynamicsError> {
        let fem_error = |source| DynamicsError::Fem {
            side: side.name(),
            source,
        };
        let mesh = &ring.mesh;
        let shaft = match side {
            Side::Inner => (0..5).filter(|&i| model.shaft[i] == ShaftDof::Free).collect(),
            Side::Outer => Vec::new(),
        };
        let held = mesh.group_nodes(ring.held_group);
        let coordinates = Coordinates::new(mesh, &held, shaft, ring.groove.centre_z);
        let stiffness =
            coordinates.reduce_matrix(&fem::assemble_stiffness(mesh, &ring.material).map_err(fem_error)?);
        let mass = coordinates.reduce_matrix(&fem::assemble_mass(mesh, &ring.material).map_err(fem_error)?);
        let mass = with_shaft_mass(mass, &coordinates, model);
        let mut order = elimination_order(mesh, coordinates.free());
        order.extend(coordinates.free().len()..coordinates.n());
        let factor =
            factor_effective(&stiffness, &mass, &order, integrator, dt, damping).map_err(|source| {
                DynamicsError::Solver {
                    side: side.name(),
                    source,
                }
            })?;
        let surface = RacewaySurface::new(mesh, mesh.group(RACEWAY_GROUP), ring.groove);
        Ok(RingMotion {
            coordinates,
            surface,
            rule: PressureRule::new(),
            stiffness,
            mass,
            damping,
            factor,
            integrator,
            dt,
        })
    }

    /// Predictor and columns of a step from `state` under the constant generalised load `load` and with contacts at
    /// `feet`.
    pub fn prepare(&self, state: &RingState, load: &[f64], feet: &[NodalWeights]) -> RingStep {
        let n = self.coordinates.n();
        let mut predictor = self.right_side(state, load);
        self.factor.solve(&mut predictor, 1);
        let m = 2 * feet.len();
        let loads: Vec<SparseLoad> = feet
            .iter()
            .flat_map(|foot| self.coordinates.reduce_weights(foot))
            .collect();
        let mut columns = vec![0.0; n * m];
        for (column, load) in columns.chunks_exact_mut(n).zip(&loads) {
            load.iter().for_each(|&(i, value)| column[i] = value);
        }
        self.factor.solve(&mut columns, m);
        let start: Vec<f64> = (0..m).map(|i| sparse_dot(&loads[i], &state.w)).collect();
        let predicted = (0..m)
            .map(|i| start[i] + sparse_dot(&loads[i], &predictor))
            .collect();
        let mut compliance = vec![0.0; m * m];
        for i in 0..m {
            for j in 0..=i {
                let value = sparse_dot(&loads[i], &columns[n * j..n * (j + 1)]);
                (compliance[m * i + j], compliance[m * j + i]) = (value, value);
            }
        }
        RingStep {
            predictor,
            columns,
            start,
            predicted,
            compliance,
        }
    }

    /// f - K w0 + M (history) + C (history), the right-hand side of S dw.
    fn right_side(&self, state: &RingState, load: &[f64]) -> Vec<f64> {
        let [mass, damping] = self.integrator.history(self.dt);
        let [am, ak] = self.damping;
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
        let (m, k) = (product(&self.mass, &inertial), product(&self.stiffness, &elastic));
        load.iter().zip(&m).zip(&k).map(|((f, m), k)| f + m + k).collect()
    }

    /// The state at the end of the step under contact forces `forces` (N, `[2 n_contacts]`).
    pub fn finish(&self, state: &RingState, step: RingStep, forces: &[f64]) -> RingState {
        let n = self.coordinates.n();
        let mut dw = step.predictor;
        for (column, &f) in step.columns.chunks_exact(n).zip(forces) {
            if f != 0.0 {
                dw.iter_mut().zip(column).for_each(|(d, c)| *d += f * c);
            }
        }
        let (mut v, mut a) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for ((d, v0), a0) in dw.iter().zip(&state.v).zip(&state.a) {
            let [v1, a1] = self.integrator.update(self.dt, *d, *v0, *a0);
            v.push(v1);
            a.push(a1);
        }
        let w = state.w.iter().zip(&dw).map(|(w, d)| w + d).collect();
        RingState { w, v, a }
    }

    /// Kinetic and strain energy, J.
    pub fn energies(&self, state: &RingState) -> [f64; 2] {
        let energy = |a: &CsMat<f64>, x: &[f64]| 0.5 * dot(x, &product(a, x));
        [energy(&self.mass, &state.v), energy(&self.stiffness, &state.w)]
    }

    /// Energy lost to Rayleigh damping over a step at the mean velocity of its two ends, J.
    pub fn damping_loss(&self, old: &RingState, new: &RingState) -> f64 {
        if self.damping == [0.0; 2] {
            return 0.0;
        }
        let mean: Vec<f64> = old.v.iter().zip(&new.v).map(|(a, b)| 0.5 * (a + b)).collect();
        let [am, ak] = self.damping;
        let loss = |c: f64, a: &CsMat<f64>| {
            if c == 0.0 {
                0.0
            } else {
                c * dot(&mean, &product(a, &mean))
            }
        };
        self.dt * (loss(am, &self.mass) + loss(ak, &self.stiffness))
    }
}

/// Adds the shaft's own mass to its translations.
fn with_shaft_mass(mut mass: CsMat<f64>, coordinates: &Coordinates, model: &Model) -> CsMat<f64> {
    let (dofs, first) = coordinates.shaft();
    for (k, &dof) in dofs.iter().enumerate() {
        if dof < 3
            && let Some(entry) = mass.get_mut(first + k, first + k)
        {
            *entry += model.shaft_mass;
        }
    }
    mass
}

fn factor_effective(
    stiffness: &CsMat<f64>,
    mass: &CsMat<f64>,
    order: &[usize],
    integrator: Integrator,
    dt: f64,
    damping: [f64; 2],
) -> Result<SparseCholesky, SolverError> {
    let [m, c, k] = integrator.effective(dt);
    let (cm, ck) = (m + c * damping[0], k + c * damping[1]);
    let effective = &mass.map(|x| cm * x) + &stiffness.map(|x| ck * x);
    Symbolic::new(&effective, order)?.factor(&effective)
}

/// A x, rows in order.
fn product(a: &CsMat<f64>, x: &[f64]) -> Vec<f64> {
    use rayon::prelude::*;
    let (starts, columns, values) = (a.indptr(), a.indices(), a.data());
    let starts = starts.raw_storage();
    // Every row is summed by one thread in its own order: the same bits on any number of threads.
    (0..a.rows())
        .into_par_iter()
        .with_min_len(2048)
        .map(|i| {
            let range = starts[i]..starts[i + 1];
            columns[range.clone()]
                .iter()
                .zip(&values[range])
                .map(|(&j, v)| v * x[j])
                .sum()
        })
        .collect()
}

fn sparse_dot(load: &SparseLoad, x: &[f64]) -> f64 {
    load.iter().map(|&(i, value)| value * x[i]).sum()
}

impl RingMotion {
    /// Coordinates, matrices, and the factor of the effective one.
    pub fn inventory(&self) -> Inventory {
        let (matrices, factors) = ([&self.stiffness, &self.mass], [&self.factor]);
        Inventory {
            dofs: self.coordinates.n(),
            matrices: matrices.len() + factors.len(),
        }
    }
}

impl Motion<'_> {
    /// What both rings hold.
    pub fn inventory(&self) -> Inventory {
        let rings = self.rings.iter().flatten();
        rings.fold(Inventory::default(), |sum, ring| sum + ring.inventory())
    }
}
