//! The bearings and the shaft on them, to first order about an equilibrium.
//!
//! Every bearing has the matrix that it has alone ([`dynamics::stiffness`]), in the frame of the shaft, at its place.
//! Where a body carries several, each has that of its place while the shaft is held at the others': the body gives, and
//! the others with it. What a motion of one place does to another bearing is apart ([`BodyCoupling`]).
//!
//! The matrix of the shaft at a point is over the motion of that point: the load to be put there for a unit of its
//! displacement, with everything else free and the held dofs of a rigid shaft held no more. A rigid shaft carries the
//! matrices of the bearings to the point. A beam gives way between, so that its matrix is the inverse of the compliance
//! of the point. Damping of the point is that of slow motions ([`Condensation`]); the beam has none of its own.

use contact::Side;
use dense::DenseLu;
use dynamics::condensation::Condensation;
use dynamics::moved_seat::{MovedSeats, SeatMatrices, SeatStiffness};
use dynamics::stiffness::{DampingLaws, N_SHAFT, ShaftMatrix};
use dynamics::{Linearisation, StaticSolver};

use crate::assembly::{Assembly, AssemblySolution, AssemblySolver};
use crate::error::AssemblyError;
use crate::housing::{SharedBody, coupled};
use crate::housing_damping::damping_in_bodies;
use crate::loads::{ShaftLoads, first_dofs};
use crate::shaft::{Station, applied};

/// Bearings of an assembly to first order.
#[derive(Default)]
pub struct LinearAssembly {
    /// Each alone, in its own frame.
    pub bearings: Vec<Linearisation>,
    /// Stiffness of each in the shaft's frame at its place.
    pub stiffness: Vec<ShaftMatrix>,
    /// Damping of each there, if there is any.
    pub damping: Vec<Option<ShaftMatrix>>,
    /// What bearings do to each other through bodies that carry them.
    pub couplings: Vec<BodyCoupling>,
    /// Their places on the shaft, with the motions of these about the equilibrium.
    pub stations: Vec<Station>,
    /// What the levers of all forces on a rigid shaft add to its stiffness about its origin: none of a beam.
    pub of_levers: ShaftMatrix,
    /// Displacement of the shaft's dofs, m and rad.
    shaft: Vec<f64>,
    /// Loads of the shaft on each, in the shaft's frame, N and N m.
    on_bearings: Vec<[f64; N_SHAFT]>,
}

/// Bearings in bodies that carry several.
struct InBodies {
    /// First row of each: its place on the shaft, in its own frame; the last is their number. A bearing in no such body
    /// has no rows.
    starts: Vec<usize>,
    /// Stiffness, row-major.
    stiffness: Vec<f64>,
    /// Damping, if there is any.
    damping: Option<Vec<f64>>,
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
    /// The same with the velocity, if there is damping.
    pub damping: Option<ShaftMatrix>,
}

/// Laws of damping, and the speeds with which balls pass the contacts, rad/s, by bearing.
pub type PassedDamping<'a> = (DampingLaws, &'a [f64]);

impl LinearAssembly {
    /// Of an equilibrium.
    pub fn new(
        assembly: &Assembly,
        solver: &AssemblySolver,
        solution: &AssemblySolution,
        laws: DampingLaws,
    ) -> Result<LinearAssembly, AssemblyError> {
        let stand = vec![0.0; assembly.bearings.len()];
        LinearAssembly::passing(assembly, solver, solution, (laws, &stand))
    }

    /// The same whose damped contacts are passed by balls at these speeds, rad/s, each bearing's own.
    pub fn passing(
        assembly: &Assembly,
        solver: &AssemblySolver,
        solution: &AssemblySolution,
        (laws, speeds): PassedDamping<'_>,
    ) -> Result<LinearAssembly, AssemblyError> {
        let mut linear = LinearAssembly {
            stations: assembly.stations_at(solution),
            of_levers: assembly.of_levers(solution),
            shaft: solution.shaft.displacements.clone(),
            on_bearings: assembly.loads_on_bearings(solution),
            ..LinearAssembly::default()
        };
        for (i, bearing) in assembly.bearings.iter().enumerate() {
            let fail = AssemblyError::of_bearing(&bearing.name);
            let factors: &StaticSolver = solver.of_bearing(i);
            let found = Linearisation::new(&bearing.model, factors, &solution.bearings[i], laws);
            let found = found.map_err(fail)?.passing(speeds[i]);
            let (stiffness, damping) = found.of_shaft().map_err(fail)?;
            let turned = |m: &ShaftMatrix| bearing.place.orientation.turned_matrix(m);
            linear.stiffness.push(turned(&stiffness));
            linear.damping.push(damping.as_ref().map(turned));
            linear.bearings.push(found);
        }
        linear.couple(assembly, solver, solution)?;
        Ok(linear)
    }

    /// Places of the bearings on a rigid shaft whose dofs are those of its point at a position, m, in the equilibrium.
    fn stations_about(&self, assembly: &Assembly, position: f64) -> Vec<Station> {
        let places = assembly.bearings.iter().map(|b| b.place.position - position);
        places
            .map(|place| assembly.shaft.at_distance(place).at(&self.shaft))
            .collect()
    }

    /// The same with the inertia of balls that go round at these speeds, rad/s, each bearing's own: for modes. Matrices
    /// over the shaft alone stay.
    pub fn going_round(mut self, assembly: &Assembly, speeds: &[f64]) -> LinearAssembly {
        let all = self.bearings.into_iter().zip(&assembly.bearings).zip(speeds);
        let going = all.map(|((own, of), speed)| own.going_round(of.model.ball_mass(), *speed));
        self.bearings = going.collect();
        self
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
        let mut whole: Vec<Option<SeatMatrices>> = Vec::new();
        for (i, bearing) in assembly.bearings.iter().enumerate() {
            let around = bodies.iter().filter(|body| body.bearings().contains(&i));
            let sides: Vec<Side> = around.map(SharedBody::side).collect();
            if sides.is_empty() {
                of_shaft.push(None);
                whole.push(None);
                continue;
            }
            let fail = AssemblyError::of_bearing(&bearing.name);
            let factors = solver.of_bearing(i);
            let seats = MovedSeats::new(&sides, factors, &solution.bearings[i], &self.bearings[i]);
            of_shaft.push(Some(seats.of_shaft().map_err(fail)?));
            whole.push(self.damping[i].map(|_| seats.matrices()));
        }
        let failed = |source| AssemblyError::Matrix { source };
        let stiffness = coupled(bodies, &of_shaft).map_err(failed)?;
        let damping = damping_in_bodies(bodies, &whole).map_err(failed)?;
        let mut starts = vec![0];
        for own in &of_shaft {
            let n = own.as_ref().map_or(0, |own| own.n_kept);
            starts.push(starts[starts.len() - 1] + n);
        }
        let all = InBodies {
            starts,
            stiffness,
            damping,
        };
        self.take_blocks(assembly, bodies, &all);
        Ok(())
    }

    /// Takes the matrices of bearings in bodies, and what they do to each other, from those of all.
    fn take_blocks(&mut self, assembly: &Assembly, bodies: &[SharedBody], all: &InBodies) {
        let n = all.starts[assembly.bearings.len()];
        for group in joined(bodies) {
            for &loaded in &group {
                for &moved in &group {
                    let [to, from] = [loaded, moved].map(|b| assembly.bearings[b].place.orientation);
                    let block = |matrix: &[f64]| {
                        let entry =
                            |i: usize, j: usize| matrix[n * (all.starts[loaded] + i) + all.starts[moved] + j];
                        let block = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
                        to.turned_block(from, &block)
                    };
                    let stiffness = block(&all.stiffness);
                    let damping = all.damping.as_deref().map(block);
                    if loaded == moved {
                        self.stiffness[loaded] = stiffness;
                        self.damping[loaded] = damping;
                        continue;
                    }
                    self.couplings.push(BodyCoupling {
                        loaded,
                        moved,
                        stiffness,
                        damping,
                    });
                }
            }
        }
    }

    /// Adds what bearings at these stations do to each other to a matrix of the shaft of `n` dofs.
    fn add_couplings(&self, stations: &[Station], n: usize, matrix: &mut [f64]) {
        let of = |coupling: &BodyCoupling| Some(coupling.stiffness);
        self.add_between(of, stations, n, matrix);
    }

    fn add_between(
        &self,
        of: impl Fn(&BodyCoupling) -> Option<ShaftMatrix>,
        stations: &[Station],
        n: usize,
        matrix: &mut [f64],
    ) {
        for coupling in &self.couplings {
            let Some(between) = of(coupling) else { continue };
            for column in 0..n {
                let (mut unit, mut load) = (vec![0.0; n], vec![0.0; n]);
                unit[column] = 1.0;
                let moved = stations[coupling.moved].moved(&unit);
                stations[coupling.loaded].add_load(applied(&between, &moved), &mut load);
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
            let stations = self.stations_about(assembly, position);
            for (station, stiffness) in stations.iter().zip(&self.stiffness) {
                station.add_matrix(stiffness, N_SHAFT, &mut sum);
            }
            self.add_couplings(&stations, N_SHAFT, &mut sum);
            let pushed = stations.into_iter().zip(self.on_bearings.iter().copied());
            if let Some(levers) = ShaftLoads::none(shaft).beyond_straight(shaft, pushed) {
                let of_levers = levers.stiffness(first_dofs(&self.shaft));
                Station::on_rigid_shaft(0.0).add_matrix(&of_levers, N_SHAFT, &mut sum);
            }
            return Ok(square(&sum));
        }
        let n = shaft.n();
        let whole = self.on_beam(assembly);
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

    /// Stiffness of a beam on its bearings over all its dofs, row-major.
    fn on_beam(&self, assembly: &Assembly) -> Vec<f64> {
        let (n, mounts) = (assembly.shaft.n(), assembly.mounts());
        let mut whole = assembly.shaft.stiffness.clone();
        for (mount, stiffness) in mounts.iter().zip(&self.stiffness) {
            mount.station.add_matrix(stiffness, n, &mut whole);
        }
        let stations: Vec<Station> = mounts.into_iter().map(|mount| mount.station).collect();
        self.add_couplings(&stations, n, &mut whole);
        whole
    }

    /// Damping of the shaft on its bearings at a position, m, in slow motions; None where no bearing has any.
    pub fn damping_of_shaft(
        &self,
        assembly: &Assembly,
        position: f64,
    ) -> Result<Option<ShaftMatrix>, AssemblyError> {
        if self.damping.iter().all(Option::is_none) {
            return Ok(None);
        }
        let shaft = &assembly.shaft;
        let (n, origin) = match shaft.is_beam() {
            true => (shaft.n(), None),
            false => (N_SHAFT, Some(position)),
        };
        let stations = match origin {
            Some(origin) => self.stations_about(assembly, origin),
            None => self.stations.clone(),
        };
        let mut damping = vec![0.0; n * n];
        for (station, own) in stations.iter().zip(&self.damping) {
            if let Some(own) = own {
                station.add_matrix(own, n, &mut damping);
            }
        }
        self.add_between(|coupling| coupling.damping, &stations, n, &mut damping);
        if origin.is_some() {
            return Ok(Some(square(&damping)));
        }
        let first = shaft.station(position).first;
        let whole = with_node_first(n, first, &self.on_beam(assembly));
        let condensation = Condensation::new(n, N_SHAFT, &whole);
        let condensation = condensation.map_err(|source| AssemblyError::Matrix { source })?;
        Ok(Some(square(
            &condensation.apply(&with_node_first(n, first, &damping)),
        )))
    }
}

/// A matrix of `n` rows with the five rows and columns from `first` on before all others.
fn with_node_first(n: usize, first: usize, matrix: &[f64]) -> Vec<f64> {
    let of_node = first..first + N_SHAFT;
    let others = (0..n).filter(|i| !of_node.contains(i));
    let order: Vec<usize> = of_node.clone().chain(others).collect();
    let row = |i: &usize| order.iter().map(|j| matrix[n * i + j]).collect::<Vec<f64>>();
    order.iter().flat_map(row).collect()
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
