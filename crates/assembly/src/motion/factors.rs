//! Newton's tangent of the shaft over a part of a step.
//!
//! With A = 2 M/h^2 + W G/h + K/2 of the shaft alone, S the motion of its places and T the tangents of the bearings
//! there, a step follows from its residual r by
//!
//! ```text
//! (A + S^T T S) dq = r:    dq = y - Z f,    y = A^-1 r,    Z = A^-1 S^T,    (1 + T S Z) f = T S y
//! ```
//!
//! A, Z and S Z change with the size of the part and the speed alone, so they are kept from step to step; 1 + T S Z has
//! five rows for each bearing. A rigid shaft may have no inertia in some direction, and has few dofs: its tangent is
//! factored as a whole.

use dense::DenseLu;
use dynamics::motion::held::HeldPart;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};

use super::step::ShaftStep;
use crate::error::AssemblyError;
use crate::mixing::dot;
use crate::newton::Mount;
use crate::shaft::applied;
use crate::side_by_side::of_each;

/// The shaft alone over parts of one size at one speed.
pub struct ShaftAlone {
    dt: f64,
    speed: f64,
    /// A^-1 over the free dofs, row-major.
    inverse: Vec<f64>,
    /// What a unit load on a place moves, a column of all dofs for each of the five of every place.
    columns: Vec<Vec<f64>>,
    /// Motion of the places for these loads, row-major.
    compliance: Vec<f64>,
}

/// The shaft with its bearings.
enum Tangent {
    Whole(DenseLu),
    Borne {
        tangents: Vec<ShaftMatrix>,
        loads: DenseLu,
    },
}

/// Factors that are kept while Newton gets on with them, and those of the shaft alone.
pub struct KeptFactors {
    free: Vec<usize>,
    /// The shaft alone, for the next part of this size and speed.
    pub alone: Option<ShaftAlone>,
    tangent: Option<Tangent>,
}

impl KeptFactors {
    /// Nothing but what an earlier part has left of the shaft alone.
    pub fn new(step: &ShaftStep<'_>, alone: Option<ShaftAlone>) -> KeptFactors {
        let held = &step.shaft.held;
        KeptFactors {
            free: (0..held.len()).filter(|&i| held[i].is_none()).collect(),
            alone: alone.filter(|alone| alone.dt == step.dt && alone.speed == step.speeds[1]),
            tangent: None,
        }
    }

    /// Lets go of the tangent of the bearings.
    pub fn renew(&mut self) {
        self.tangent = None;
    }

    /// Newton's step from a residual, with an earlier tangent if there is one.
    pub fn step(
        &mut self,
        step: &ShaftStep<'_>,
        parts: &mut [HeldPart<'_>],
        residual: &[f64],
    ) -> Result<Vec<f64>, AssemblyError> {
        if self.tangent.is_none() {
            self.tangent = Some(self.tangent(step, parts)?);
        }
        match (&self.tangent, &self.alone) {
            (Some(Tangent::Borne { tangents, loads }), Some(alone)) => {
                let mut moved = alone.moved(residual, &self.free);
                let mut force = Vec::with_capacity(N_SHAFT * tangents.len());
                for (mount, tangent) in step.mounts.iter().zip(tangents) {
                    force.extend(applied(tangent, &mount.station.moved(&moved)));
                }
                loads.solve(&mut force, 1);
                for (column, f) in alone.columns.iter().zip(&force) {
                    moved.iter_mut().zip(column).for_each(|(q, z)| *q -= f * z);
                }
                Ok(moved)
            }
            (Some(Tangent::Whole(factors)), _) => Ok(solve(factors, residual, &self.free)),
            _ => unreachable!("a tangent of bearings comes with the shaft alone"),
        }
    }

    /// The tangent at the last answers of the bearings.
    fn tangent(
        &mut self,
        step: &ShaftStep<'_>,
        parts: &mut [HeldPart<'_>],
    ) -> Result<Tangent, AssemblyError> {
        let tangent = |(part, mount): (&mut HeldPart<'_>, &Mount)| {
            let own = part.stiffness().map_err(AssemblyError::of_bearing(&mount.name))?;
            Ok(mount.place.orientation.turned_matrix(&own))
        };
        let tangents = of_each(parts.iter_mut().zip(step.mounts), tangent)?;
        if !step.shaft.is_beam() {
            let mut whole = step.own_tangent();
            for (mount, tangent) in step.mounts.iter().zip(&tangents) {
                let station = mount.station.at(step.start[0]);
                station.add_matrix(tangent, step.shaft.n(), &mut whole);
            }
            return Ok(Tangent::Whole(factored(step.shaft.n(), &whole, &self.free)?));
        }
        let alone = match &mut self.alone {
            Some(alone) => alone,
            none => none.insert(ShaftAlone::new(step, &self.free)?),
        };
        let n = N_SHAFT * tangents.len();
        let mut matrix = vec![0.0; n * n];
        for row in 0..n {
            let tangent = &tangents[row / N_SHAFT][row % N_SHAFT];
            let own = &alone.compliance[n * (row - row % N_SHAFT)..];
            for column in 0..n {
                let along = (0..N_SHAFT).map(|k| tangent[k] * own[n * k + column]);
                matrix[n * row + column] = along.sum::<f64>() + f64::from(u8::from(row == column));
            }
        }
        let loads = DenseLu::factor(n, &matrix).map_err(|source| AssemblyError::Matrix { source })?;
        Ok(Tangent::Borne { tangents, loads })
    }
}

impl ShaftAlone {
    fn new(step: &ShaftStep<'_>, free: &[usize]) -> Result<ShaftAlone, AssemblyError> {
        let n = step.shaft.n();
        let mut alone = ShaftAlone {
            dt: step.dt,
            speed: step.speeds[1],
            inverse: factored(n, &step.own_tangent(), free)?.inverse(),
            columns: Vec::new(),
            compliance: Vec::new(),
        };
        for mount in step.mounts {
            for i in 0..N_SHAFT {
                let (mut unit, mut load) = ([0.0; N_SHAFT], vec![0.0; n]);
                unit[i] = 1.0;
                mount.station.add_load(unit, &mut load);
                let column = alone.moved(&load, free);
                alone.columns.push(column);
            }
        }
        for mount in step.mounts {
            let motions = alone.columns.iter().map(|z| mount.station.moved(z));
            let motions: Vec<_> = motions.collect();
            for i in 0..N_SHAFT {
                alone.compliance.extend(motions.iter().map(|motion| motion[i]));
            }
        }
        Ok(alone)
    }

    /// Motion of all dofs for a load on them; held ones stay.
    fn moved(&self, load: &[f64], free: &[usize]) -> Vec<f64> {
        let rows = self.inverse.chunks_exact(free.len().max(1));
        over_free(load, free, |load| rows.map(|row| dot(row, &load)).collect())
    }
}

/// Factors of a matrix over the free dofs.
fn factored(n: usize, matrix: &[f64], free: &[usize]) -> Result<DenseLu, AssemblyError> {
    let entries = free.iter().flat_map(|&i| free.iter().map(move |&j| n * i + j));
    let matrix: Vec<f64> = entries.map(|k| matrix[k]).collect();
    DenseLu::factor(free.len(), &matrix).map_err(|source| AssemblyError::Matrix { source })
}

/// Motion of all dofs for a load on them; held ones stay.
fn solve(factors: &DenseLu, load: &[f64], free: &[usize]) -> Vec<f64> {
    over_free(load, free, |mut load| {
        factors.solve(&mut load, 1);
        load
    })
}

/// What `solve` makes of the free dofs of a load; the others stay 0.
fn over_free(load: &[f64], free: &[usize], solve: impl FnOnce(Vec<f64>) -> Vec<f64>) -> Vec<f64> {
    let found = solve(free.iter().map(|&i| load[i]).collect());
    let mut motion = vec![0.0; load.len()];
    free.iter().zip(found).for_each(|(&i, x)| motion[i] = x);
    motion
}
