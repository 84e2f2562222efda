//! Modes of a shaft that turns on its bearings.
//!
//! ```text
//! M x'' + (C + W G) x' + K x = 0        x: free dofs of the shaft, then [radial, axial] of the balls of each bearing
//! ```
//!
//! As [`dynamics::whirl`] for one bearing: M has the shaft, the inner rings as rigid bodies at their places, and the
//! balls; G is the gyroscopic matrix of all that turns, W the speed. What that leaves out is left out here too. Elastic
//! bodies under the rings, on the shaft or in a housing, have rows of their own (`whirl_in_bodies`).

use contact::Side;
use dynamics::bodies::AXES;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::whirl::{ShaftRow, TurningShaft, WhirlMatrices, ring_inertia, shaft_inertia, turning_inertia};
use dynamics::{Linearisation, Model, ShaftDof, StaticSolution, StaticSolver};
use ring::rigid::RigidInertia;

use crate::assembly::{Assembly, AssemblySolution, AssemblySolver};
use crate::error::AssemblyError;
use crate::place::MountedBearing;
use crate::shaft::{ShaftBody, Station, identity, product};
use crate::stiffness::LinearAssembly;
use crate::whirl_bodies::{WhirlBody, whirl_bodies};
use crate::whirl_in_bodies::equations_in_bodies;
use crate::whirl_rows::{WhirlBearing, WhirlShaft};

/// What turns with a shaft and what yields round it, made ready for all speeds.
pub struct TurningAssembly {
    /// The shaft: with all inner rings where no elastic body is under one, else with rigid ones alone.
    shaft: ShaftBody,
    /// Elastic bodies that have a mass.
    bodies: Vec<WhirlBody>,
    /// Flexible inner rings in no such body, where there are bodies.
    rings: Vec<Option<RigidInertia>>,
}

impl TurningAssembly {
    /// Of an assembly.
    pub fn new(assembly: &Assembly) -> Result<TurningAssembly, AssemblyError> {
        let bearings: Vec<_> = assembly
            .bearings
            .iter()
            .map(|b| (b.name.as_str(), &b.model))
            .collect();
        let bodies = whirl_bodies(&bearings)?;
        if bodies.is_empty() {
            return Ok(TurningAssembly {
                shaft: turning_shaft(assembly)?,
                bodies,
                rings: Vec::new(),
            });
        }
        let mut shaft = assembly.shaft.clone();
        for (bearing, mount) in assembly.bearings.iter().zip(assembly.mounts()) {
            shaft.add_inertia(&mount.station, &shaft_inertia(&bearing.model));
        }
        let rings = assembly.bearings.iter().enumerate();
        let rings = rings.map(|(i, b)| ring_on_shaft(&bodies, i, &b.name, &b.model));
        Ok(TurningAssembly {
            shaft,
            rings: rings.collect::<Result<_, _>>()?,
            bodies,
        })
    }

    /// Of one bearing alone, which has a rigid shaft; None where it has no elastic body with a mass.
    pub fn of_one(name: &str, model: &Model) -> Result<Option<TurningAssembly>, AssemblyError> {
        let bodies = whirl_bodies(&[(name, model)])?;
        if bodies.is_empty() {
            return Ok(None);
        }
        let held = model
            .shaft
            .map(|dof| if dof == ShaftDof::Free { None } else { Some(0.0) });
        Ok(Some(TurningAssembly {
            shaft: ShaftBody::rigid(shaft_inertia(model), held),
            rings: vec![ring_on_shaft(&bodies, 0, name, model)?],
            bodies,
        }))
    }

    /// Whether bodies swing, so that there are more modes than those of the shaft.
    pub fn has_bodies(&self) -> bool {
        !self.bodies.is_empty()
    }

    /// The equations of linearised bearings at a speed, rad/s.
    pub fn equations(
        &self,
        (assembly, solver): (&Assembly, &AssemblySolver),
        (solution, linear): (&AssemblySolution, &LinearAssembly),
        speed: f64,
    ) -> Result<TurningShaft, AssemblyError> {
        if self.bodies.is_empty() {
            return equations(assembly, &self.shaft, linear, speed);
        }
        let bearing = |b: usize| {
            let of: &MountedBearing = &assembly.bearings[b];
            WhirlBearing {
                model: &of.model,
                solver: solver.of_bearing(b),
                solution: &solution.bearings[b],
                linear: &linear.bearings[b],
                motion: own_motion(of, &linear.stations[b]),
                first: linear.stations[b].first,
                way: of.place.orientation.turned_angle(1.0),
                ring: self.rings[b],
            }
        };
        let bearings: Vec<_> = (0..assembly.bearings.len()).map(bearing).collect();
        let shaft = of_shaft((&self.shaft, linear), self.shaft.n(), speed);
        self.in_bodies(shaft, &bearings, speed)
    }

    /// The equations of one linearised bearing alone at a speed, rad/s.
    pub fn equations_of_one(
        &self,
        model: &Model,
        (solver, solution): (&StaticSolver, &StaticSolution),
        linear: &Linearisation,
        speed: f64,
    ) -> Result<TurningShaft, AssemblyError> {
        let mut shaft = of_shaft_alone(&self.shaft, N_SHAFT, speed);
        let loads = linear.load_stiffness.as_flattened();
        shaft
            .stiffness
            .iter_mut()
            .zip(loads)
            .for_each(|(sum, k)| *sum += k);
        let bearing = WhirlBearing {
            model,
            solver,
            solution,
            linear,
            motion: identity(),
            first: 0,
            way: 1.0,
            ring: self.rings[0],
        };
        self.in_bodies(shaft, &[bearing], speed)
    }

    fn in_bodies(
        &self,
        matrices: WhirlMatrices,
        bearings: &[WhirlBearing<'_>],
        speed: f64,
    ) -> Result<TurningShaft, AssemblyError> {
        let shaft = WhirlShaft {
            free: self
                .shaft
                .held
                .iter()
                .enumerate()
                .filter(|(_, held)| held.is_none())
                .map(|(i, _)| i)
                .collect(),
            matrices,
            speed,
        };
        let found = equations_in_bodies(&shaft, bearings, &self.bodies)?;
        let lacking = found.without_mass();
        lacking.map_or(Ok(found), |row| Err(no_inertia(row.dof)))
    }
}

/// Inertia of a flexible inner ring that sits in none of these bodies.
fn ring_on_shaft(
    bodies: &[WhirlBody],
    bearing: usize,
    name: &str,
    model: &Model,
) -> Result<Option<RigidInertia>, AssemblyError> {
    let [inner, _] = Side::BOTH;
    let mut seats = bodies.iter().flat_map(|body| &body.seats);
    if seats.any(|seat| seat.bearing == bearing && seat.side == inner) {
        return Ok(None);
    }
    ring_inertia(model, inner).map_err(AssemblyError::of_bearing(name))
}

/// Motion of the place of a bearing, in its own frame, by five dofs of the shaft.
fn own_motion(bearing: &MountedBearing, station: &Station) -> ShaftMatrix {
    let turn: ShaftMatrix = std::array::from_fn(|i| {
        let mut row = [0.0; N_SHAFT];
        row[i] = 1.0;
        bearing.place.orientation.turned(row)
    });
    product(&turn, &station.motion)
}

/// The shaft with the inner rings that turn with it.
pub fn turning_shaft(assembly: &Assembly) -> Result<ShaftBody, AssemblyError> {
    let mut shaft = assembly.shaft.clone();
    for (bearing, mount) in assembly.bearings.iter().zip(assembly.mounts()) {
        let mut inertia =
            turning_inertia(&bearing.model).map_err(AssemblyError::of_bearing(&bearing.name))?;
        // Its centre lies along the bearing's own z.
        inertia.first_moment = bearing.place.orientation.turned_angle(inertia.first_moment);
        shaft.add_inertia(&mount.station, &inertia);
    }
    Ok(shaft)
}

/// The equations of linearised bearings and a shaft with all that turns ([`turning_shaft`]) at a speed, rad/s.
pub fn equations(
    assembly: &Assembly,
    shaft: &ShaftBody,
    linear: &LinearAssembly,
    speed: f64,
) -> Result<TurningShaft, AssemblyError> {
    let n_shaft = shaft.n();
    let balls = |b: usize| 2 * assembly.bearings[b].model.geometry.n_balls;
    let n = n_shaft + (0..assembly.bearings.len()).map(balls).sum::<usize>();
    let mut all = of_shaft((shaft, linear), n, speed);
    let free: Vec<usize> = (0..n_shaft).filter(|&i| shaft.held[i].is_none()).collect();
    require_inertia(&all, &free)?;
    let mut rows = free.clone();
    let mut first = n_shaft;
    for (b, (bearing, station)) in assembly.bearings.iter().zip(&linear.stations).enumerate() {
        let fail = AssemblyError::of_bearing(&bearing.name);
        let own = linear.bearings[b].of_shaft_and_balls().map_err(fail)?;
        let at = BearingRows {
            motion: own_motion(bearing, station),
            shaft: station.first,
            balls: first,
        };
        at.add((own.n, &own.stiffness), n, &mut all.stiffness);
        if let Some(damping) = &own.damping {
            at.add((own.n, damping), n, &mut all.rates);
        }
        for i in 0..balls(b) {
            all.mass[(n + 1) * (first + i)] = bearing.model.ball_mass();
            if own.is_held(N_SHAFT + i) {
                rows.push(first + i);
            }
        }
        first += balls(b);
    }
    let row = |&i: &usize| ShaftRow {
        node: i / N_SHAFT,
        dof: i % N_SHAFT,
    };
    let shaft_rows = free.iter().map(row).collect();
    Ok(TurningShaft::of_matrices(all.of_rows(&rows), shaft_rows, speed))
}

/// Matrices of the shaft at a speed with the levers of all forces, of `n` rows with room for what follows its dofs.
fn of_shaft((shaft, linear): (&ShaftBody, &LinearAssembly), n: usize, speed: f64) -> WhirlMatrices {
    let mut matrices = of_shaft_alone(shaft, n, speed);
    Station::on_rigid_shaft(0.0).add_matrix(&linear.of_levers, n, &mut matrices.stiffness);
    matrices
}

/// Matrices of the shaft at a speed, of `n` rows with room for what follows its dofs.
fn of_shaft_alone(shaft: &ShaftBody, n: usize, speed: f64) -> WhirlMatrices {
    let spread = |matrix: &[f64], factor: f64| {
        let mut whole = vec![0.0; n * n];
        for (row, own) in whole.chunks_exact_mut(n).zip(matrix.chunks_exact(shaft.n())) {
            row.iter_mut().zip(own).for_each(|(sum, x)| *sum = factor * x);
        }
        whole
    };
    WhirlMatrices {
        n,
        mass: spread(&shaft.mass, 1.0),
        rates: spread(&shaft.gyroscopic, speed),
        stiffness: spread(&shaft.stiffness, 1.0),
    }
}

/// Where the dofs of a bearing are among all rows: its axis point moves by `motion` times five dofs of the shaft.
struct BearingRows {
    motion: [[f64; N_SHAFT]; N_SHAFT],
    shaft: usize,
    balls: usize,
}

impl BearingRows {
    /// Adds a matrix of `m` columns over the bearing's axis point and balls to one of `n` rows.
    fn add(&self, (m, own): (usize, &[f64]), n: usize, to: &mut [f64]) {
        let columns: Vec<_> = (0..m).map(|j| self.spread(j)).collect();
        for (i, row) in own.chunks_exact(m).enumerate() {
            for (row_of, a) in self.spread(i) {
                for (entry, columns) in row.iter().zip(&columns) {
                    for (column, b) in columns {
                        to[n * row_of + column] += a * entry * b;
                    }
                }
            }
        }
    }

    /// Of a row of the bearing: the rows among all, and their factors.
    fn spread(&self, i: usize) -> Vec<(usize, f64)> {
        match i {
            0..N_SHAFT => (0..N_SHAFT)
                .map(|k| (self.shaft + k, self.motion[i][k]))
                .collect(),
            _ => vec![(self.balls + i - N_SHAFT, 1.0)],
        }
    }
}

fn require_inertia(all: &WhirlMatrices, free: &[usize]) -> Result<(), AssemblyError> {
    let lacking = free.iter().find(|&&i| all.mass[(all.n + 1) * i] <= 0.0);
    lacking.map_or(Ok(()), |&i| Err(no_inertia(i % N_SHAFT)))
}

fn no_inertia(dof: usize) -> AssemblyError {
    AssemblyError::NoInertia {
        dof: AXES[dof],
        key: if dof < 3 {
            "shaft.mass"
        } else {
            "shaft.transverse_inertia"
        },
    }
}
