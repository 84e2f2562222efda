//! The bearings and the shaft on them, to first order about an equilibrium.
//!
//! Every bearing has the matrix that it has alone ([`dynamics::stiffness`]), in the frame of the shaft, at its place.
//! The matrix of the shaft at a point is over the motion of that point: the load to be put there for a unit of its
//! displacement, with everything else free and the held dofs of a rigid shaft held no more. A rigid shaft carries the
//! matrices of the bearings to the point. A beam gives way between, so that its matrix is the inverse of the compliance
//! of the point.

use dense::DenseLu;
use dynamics::stiffness::{DampingLaws, N_SHAFT, ShaftMatrix};
use dynamics::{Linearisation, StaticSolver};

use crate::assembly::{Assembly, AssemblySolution, AssemblySolver};
use crate::error::AssemblyError;
use crate::shaft::Station;

/// Bearings of an assembly to first order.
pub struct LinearAssembly {
    /// Each alone, in its own frame.
    pub bearings: Vec<Linearisation>,
    /// Stiffness of each in the shaft's frame at its place.
    pub stiffness: Vec<ShaftMatrix>,
    /// Damping of each there, if there is any.
    pub damping: Vec<Option<ShaftMatrix>>,
}

impl LinearAssembly {
    /// Of an equilibrium.
    pub fn new(
        assembly: &Assembly,
        solver: &AssemblySolver,
        solution: &AssemblySolution,
        laws: DampingLaws,
    ) -> Result<LinearAssembly, AssemblyError> {
        assembly.require_bodies_of_one()?;
        let mut linear = LinearAssembly {
            bearings: Vec::new(),
            stiffness: Vec::new(),
            damping: Vec::new(),
        };
        for (i, bearing) in assembly.bearings.iter().enumerate() {
            let fail = AssemblyError::of_bearing(&bearing.name);
            let factors: &StaticSolver = solver.of_bearing(i);
            let found = Linearisation::new(&bearing.model, factors, &solution.bearings[i], laws);
            let found = found.map_err(fail)?;
            let (stiffness, damping) = found.of_shaft().map_err(fail)?;
            let turned = |m: &ShaftMatrix| bearing.place.orientation.turned_matrix(m);
            linear.stiffness.push(turned(&stiffness));
            linear.damping.push(damping.as_ref().map(turned));
            linear.bearings.push(found);
        }
        Ok(linear)
    }

    /// Stiffness of the shaft on its bearings at a position, m.
    pub fn of_shaft(&self, assembly: &Assembly, position: f64) -> Result<ShaftMatrix, AssemblyError> {
        let shaft = &assembly.shaft;
        if !shaft.is_beam() {
            let mut sum = vec![0.0; N_SHAFT * N_SHAFT];
            for (bearing, stiffness) in assembly.bearings.iter().zip(&self.stiffness) {
                let station = Station::on_rigid_shaft(bearing.place.position - position);
                station.add_matrix(stiffness, N_SHAFT, &mut sum);
            }
            return Ok(square(&sum));
        }
        let n = shaft.n();
        let mut whole = shaft.stiffness.clone();
        for (mount, stiffness) in assembly.mounts().iter().zip(&self.stiffness) {
            mount.station.add_matrix(stiffness, n, &mut whole);
        }
        let matrix = |source| AssemblyError::Matrix { source };
        let first = shaft.station(position).first;
        let mut columns = vec![0.0; n * N_SHAFT];
        (0..N_SHAFT).for_each(|j| columns[n * j + first + j] = 1.0);
        DenseLu::factor(n, &whole)
            .map_err(matrix)?
            .solve(&mut columns, N_SHAFT);
        let compliance: Vec<f64> = (0..N_SHAFT * N_SHAFT)
            .map(|k| columns[n * (k % N_SHAFT) + first + k / N_SHAFT])
            .collect();
        let inverse = DenseLu::factor(N_SHAFT, &compliance).map_err(matrix)?.inverse();
        Ok(square(&inverse))
    }
}

fn square(entries: &[f64]) -> ShaftMatrix {
    std::array::from_fn(|i| std::array::from_fn(|j| entries[N_SHAFT * i + j]))
}
