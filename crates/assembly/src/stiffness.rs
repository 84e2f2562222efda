//! The bearings and the shaft on them, to first order about an equilibrium.
//!
//! Every bearing has the matrix that it has alone ([`dynamics::stiffness`]), in the frame of the shaft, at its place.
//! Where a body carries several, each has that of its place while the shaft is held at the others': the body gives, and
//! the others with it. What a motion of one place does to another bearing is apart ([`BodyCoupling`]).
//!
//! The matrix of the shaft at a point is over the motion of that point: the load to be put there for a unit of its
//! displacement, with everything else free and the held dofs of a rigid shaft held no more. A rigid shaft carries the
//! matrices of the bearings to the point. A beam gives way between, so that its matrix is the inverse of the compliance
//! of the point.

use contact::Side;
use dense::DenseLu;
use dynamics::moved_seat::{MovedSeats, SeatStiffness};
use dynamics::stiffness::{DampingLaws, N_SHAFT, ShaftMatrix};
use dynamics::{Linearisation, StaticSolver};

use crate::assembly::{Assembly, AssemblySolution, AssemblySolver};
use crate::error::AssemblyError;
use crate::housing::{SharedBody, coupled};
use crate::shaft::{Station, applied};

/// Bearings of an assembly to first order.
pub struct LinearAssembly {
    /// Each alone, in its own frame.
    pub bearings: Vec<Linearisation>,
    /// Stiffness of each in the shaft's frame at its place.
    pub stiffness: Vec<ShaftMatrix>,
    /// Damping of each there, if there is any.
    pub damping: Vec<Option<ShaftMatrix>>,
    /// What bearings do to each other through bodies that carry them.
    pub couplings: Vec<BodyCoupling>,
}

/// Bearings in bodies that carry several.
struct InBodies {
    /// First row of each: its place on the shaft, in its own frame; the last is their number. A bearing in no such body
    /// has no rows.
    starts: Vec<usize>,
    /// Stiffness, row-major.
    stiffness: Vec<f64>,
}

/// Load on a bearing by the motion of the shaft at another, through a body that carries both, in the shaft's frame.
#[derive(Clone, Copy, Debug)]
pub struct BodyCoupling {
    /// Number of the bearing.
    pub loaded: usize,
    /// Number of the one whose place moves.
    pub moved: usize,
    /// Growth of the load.
    pub stiffness: ShaftMatrix,
}

impl LinearAssembly {
    /// Of an equilibrium.
    pub fn new(
        assembly: &Assembly,
        solver: &AssemblySolver,
        solution: &AssemblySolution,
        laws: DampingLaws,
    ) -> Result<LinearAssembly, AssemblyError> {
        let mut linear = LinearAssembly {
            bearings: Vec::new(),
            stiffness: Vec::new(),
            damping: Vec::new(),
            couplings: Vec::new(),
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
        linear.couple(assembly, solver, solution)?;
        Ok(linear)
    }

    /// Lets the bearings in bodies feel each other.
    fn couple(
        &mut self,
        assembly: &Assembly,
        solver: &AssemblySolver,
        solution: &AssemblySolution,
    ) -> Result<(), AssemblyError> {
        let bodies = solver.bodies();
        if bodies.is_empty() {
            return Ok(());
        }
        let mut of_shaft: Vec<Option<SeatStiffness>> = Vec::new();
        for (i, bearing) in assembly.bearings.iter().enumerate() {
            let around = bodies.iter().filter(|body| body.bearings().contains(&i));
            let sides: Vec<Side> = around.map(SharedBody::side).collect();
            if sides.is_empty() {
                of_shaft.push(None);
                continue;
            }
            let fail = AssemblyError::of_bearing(&bearing.name);
            let factors = solver.of_bearing(i);
            let seats = MovedSeats::new(&sides, factors, &solution.bearings[i], &self.bearings[i]);
            of_shaft.push(Some(seats.of_shaft().map_err(fail)?));
        }
        let stiffness = coupled(bodies, &of_shaft).map_err(|source| AssemblyError::Matrix { source })?;
        let mut starts = vec![0];
        for own in &of_shaft {
            let n = own.as_ref().map_or(0, |own| own.n_kept);
            starts.push(starts[starts.len() - 1] + n);
        }
        self.take_blocks(assembly, bodies, &InBodies { starts, stiffness });
        Ok(())
    }

    /// Takes the matrices of bearings in bodies, and what they do to each other, from those of all.
    fn take_blocks(&mut self, assembly: &Assembly, bodies: &[SharedBody], all: &InBodies) {
        let n = all.starts[assembly.bearings.len()];
        for group in joined(bodies) {
            for &loaded in &group {
                for &moved in &group {
                    let entry = |i: usize, j: usize| {
                        all.stiffness[n * (all.starts[loaded] + i) + all.starts[moved] + j]
                    };
                    let block = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
                    let [to, from] = [loaded, moved].map(|b| assembly.bearings[b].place.orientation);
                    let stiffness = to.turned_block(from, &block);
                    match loaded == moved {
                        true => self.stiffness[loaded] = stiffness,
                        false => self.couplings.push(BodyCoupling {
                            loaded,
                            moved,
                            stiffness,
                        }),
                    }
                }
            }
        }
    }

    /// Adds what bearings at these stations do to each other to a matrix of the shaft of `n` dofs.
    fn add_couplings(&self, stations: &[Station], n: usize, matrix: &mut [f64]) {
        for coupling in &self.couplings {
            for column in 0..n {
                let (mut unit, mut load) = (vec![0.0; n], vec![0.0; n]);
                unit[column] = 1.0;
                let moved = stations[coupling.moved].displacement(&unit);
                stations[coupling.loaded].add_load(applied(&coupling.stiffness, &moved), &mut load);
                let rows = matrix.iter_mut().skip(column).step_by(n);
                rows.zip(load).for_each(|(sum, load)| *sum += load);
            }
        }
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
            let places = assembly.bearings.iter().map(|b| b.place.position - position);
            let stations: Vec<Station> = places.map(Station::on_rigid_shaft).collect();
            self.add_couplings(&stations, N_SHAFT, &mut sum);
            return Ok(square(&sum));
        }
        let n = shaft.n();
        let mut whole = shaft.stiffness.clone();
        for (mount, stiffness) in assembly.mounts().iter().zip(&self.stiffness) {
            mount.station.add_matrix(stiffness, n, &mut whole);
        }
        let stations: Vec<Station> = assembly.mounts().into_iter().map(|mount| mount.station).collect();
        self.add_couplings(&stations, n, &mut whole);
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

/// The bearings that feel each other, directly or by others.
fn joined(bodies: &[SharedBody]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for body in bodies {
        let mut group = body.bearings().to_vec();
        groups.retain(|known| {
            let meets = known.iter().any(|bearing| group.contains(bearing));
            if meets {
                group.extend(known);
            }
            !meets
        });
        if group.len() > body.bearings().len() {
            group.sort_unstable();
            group.dedup();
        }
        groups.push(group);
    }
    groups
}

fn square(entries: &[f64]) -> ShaftMatrix {
    std::array::from_fn(|i| std::array::from_fn(|j| entries[N_SHAFT * i + j]))
}
