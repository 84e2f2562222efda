//! Bearings on a shaft, and their equilibrium.

use std::sync::Arc;

use contact::Side;
use dynamics::displacements::Displacements;
use dynamics::equilibrium::SearchScales;
use dynamics::statics::ContactColumns;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::{Model, Pose, StaticSolution, StaticSolver};
use timer::Laps;

use crate::body_rounds::{LOOSEST, change, has_stalled, largest, tolerance_after};
use crate::error::AssemblyError;
use crate::housing::{HousedTogether, SharedBody, housed_together, shared_bodies};
use crate::loads::{ShaftLoads, first_dofs};
use crate::mixing::Mixing;
use crate::newton::{Mount, Problem, Scales, SettledShaft, settle};
use crate::place::{MountedBearing, Orientation};
use crate::shaft::{ShaftBody, Station};
use crate::support::{BearingSupport, BearingSupports};

/// Change of the forces on a body over their size at which its bearings no longer feel each other's.
const BODY_TOLERANCE: f64 = 1e-9;
/// Rounds of these before giving up.
const MOST_BODY_ROUNDS: usize = 100;

/// Bearings, their shaft and its loads.
pub struct Assembly {
    /// Bearings in the order of the scene.
    pub bearings: Vec<MountedBearing>,
    /// The shaft without what bearings carry.
    pub shaft: ShaftBody,
    /// Loads on the shaft.
    pub load: ShaftLoads,
}

/// Rings factored, once those of a type, and what each bearing has found of them.
pub struct AssemblySolver {
    solvers: Vec<StaticSolver>,
    rigid: Vec<StaticSolver>,
    /// Number of its solver, by bearing.
    type_of: Vec<usize>,
    columns: Vec<ContactColumns>,
    /// Bodies that carry several bearings.
    bodies: Arc<[SharedBody]>,
}

/// Equilibrium of an assembly.
pub struct AssemblySolution {
    /// Solution of every bearing, in its own frame.
    pub bearings: Vec<StaticSolution>,
    /// The shaft.
    pub shaft: SettledShaft,
    /// Forces on the bodies that carry several bearings, N, over the functions of all seats of each.
    on_bodies: Vec<Vec<f64>>,
}

/// What of an equilibrium the next one starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyStart {
    /// Displacements of the shaft's dofs, m and rad.
    pub shaft: Vec<f64>,
    /// Those of every bearing, in its own frame.
    pub bearings: Vec<Displacements>,
    /// Forces on the bodies that carry several bearings, N, over the functions of all seats of each.
    pub on_bodies: Vec<Vec<f64>>,
}

/// The shaft in balance, and the bearings.
type SettledAssembly = (SettledShaft, Vec<StaticSolution>);

impl Assembly {
    /// The bodies that carry several bearings.
    pub fn housed_together(&self) -> Vec<HousedTogether> {
        housed_together(&self.bearings)
    }

    /// Takes the tilts of a rigid shaft for small where a body that it carries does, which carries several bearings.
    pub fn be_linear_in_bodies(&mut self) {
        let is_carried = |body: &HousedTogether| {
            let model = &self.bearings[body.bearings[0]].model;
            let tie = model.tied(body.side).and_then(|ring| ring.tie.as_ref());
            tie.is_some_and(|tie| tie.carried().is_some())
        };
        if self.housed_together().iter().any(is_carried) {
            self.shaft.be_linear();
        }
    }

    /// The places of the bearings on the shaft.
    pub fn mounts(&self) -> Vec<Mount> {
        let mount = |(bearing, station): (&MountedBearing, Station)| Mount {
            name: bearing.name.clone(),
            place: bearing.place,
            station,
        };
        self.bearings.iter().zip(self.stations()).map(mount).collect()
    }

    /// The places of the bearings on the straight shaft.
    fn stations(&self) -> impl Iterator<Item = Station> {
        self.bearings
            .iter()
            .map(|bearing| self.shaft.station(bearing.place.position))
    }

    /// The places of the bearings, with their motions about an equilibrium.
    pub fn stations_at(&self, solution: &AssemblySolution) -> Vec<Station> {
        self.stations()
            .map(|station| station.at(&solution.shaft.displacements))
            .collect()
    }

    /// Loads of the shaft on the bearings in an equilibrium, in its frame, N and N m.
    pub fn loads_on_bearings(&self, solution: &AssemblySolution) -> Vec<[f64; N_SHAFT]> {
        let pairs = self.bearings.iter().zip(&solution.bearings);
        pairs
            .map(|(bearing, found)| bearing.place.orientation.turned(found.shaft_reaction))
            .collect()
    }

    /// What the levers of all forces on a rigid shaft add to its stiffness about its origin, in an equilibrium; nothing
    /// of a linear shaft.
    pub fn of_levers(&self, solution: &AssemblySolution) -> ShaftMatrix {
        let on_bearings = self.stations().zip(self.loads_on_bearings(solution));
        let levers = self.load.beyond_straight(&self.shaft, on_bearings);
        levers.map_or([[0.0; N_SHAFT]; N_SHAFT], |levers| {
            levers.stiffness(first_dofs(&solution.shaft.displacements))
        })
    }

    /// Sizes of the search: those of the largest bearing.
    pub fn scales(&self) -> Scales {
        let mut scales = Scales {
            step: 0.0,
            stiffness: 0.0,
            tilt_arm: 0.0,
            tolerance: 1.0,
        };
        for bearing in &self.bearings {
            let model = &bearing.model;
            let hertz = model.hertz[0].stiffness.max(model.hertz[1].stiffness);
            let own = SearchScales::new(&model.geometry, hertz);
            scales.step = scales.step.max(own.step);
            scales.stiffness = scales.stiffness.max(own.stiffness);
            scales.tilt_arm = scales.tilt_arm.max(own.tilt_arm);
            scales.tolerance = scales.tolerance.min(model.tolerances.force);
        }
        scales
    }

    /// Force along the axis by which the bearings press on each other in an equilibrium, N: what the "+z" bearings and
    /// the "-z" bearings both carry; the rest is the load on the shaft. None unless there are bearings of both.
    pub fn preload(&self, solution: &AssemblySolution) -> Option<f64> {
        let carried = |orientation: Orientation| {
            let bearings = self.bearings.iter().zip(&solution.bearings);
            let own = bearings.filter(|(bearing, _)| bearing.place.orientation == orientation);
            own.map(|(_, found)| found.shaft_reaction[2])
                .reduce(|sum, force| sum + force)
        };
        let both = carried(Orientation::PlusZ).zip(carried(Orientation::MinusZ));
        // Bearings with two shoulders press either way; those pulled to one side press on no other.
        both.map(|(plus, minus)| match plus * minus > 0.0 {
            true => plus.abs().min(minus.abs()),
            false => 0.0,
        })
    }

    /// Force x, y, z, N, and moment about x and y, N m, about the origin of the shaft, by which a bearing pushes it.
    pub fn force_on_shaft(&self, bearing: usize, solution: &AssemblySolution) -> [f64; 5] {
        let orientation = self.bearings[bearing].place.orientation;
        let reaction = solution.bearings[bearing].shaft_reaction;
        orientation.turned(reaction).map(|f| 0.0 - f)
    }
}

impl AssemblySolution {
    /// What the next equilibrium starts from.
    pub fn as_start(&self) -> AssemblyStart {
        let displacements = |solution: &StaticSolution| solution.displacements.clone();
        AssemblyStart {
            shaft: self.shaft.displacements.clone(),
            bearings: self.bearings.iter().map(displacements).collect(),
            on_bodies: self.on_bodies.clone(),
        }
    }
}

impl AssemblySolver {
    /// Factors the rings of every type, once also where they sit in seats of their own.
    pub fn new(assembly: &Assembly) -> Result<AssemblySolver, AssemblyError> {
        let mut first_of: Vec<usize> = Vec::new();
        let mut type_of = Vec::new();
        for (i, bearing) in assembly.bearings.iter().enumerate() {
            let known = first_of
                .iter()
                .position(|&k| have_same_rings(&assembly.bearings[k].model, &bearing.model));
            type_of.push(known.unwrap_or(first_of.len()));
            if known.is_none() {
                first_of.push(i);
            }
        }
        let model = |i: &usize| &assembly.bearings[*i].model;
        let mut solvers: Vec<StaticSolver> = Vec::new();
        for i in &first_of {
            let made: Vec<_> = first_of.iter().map(model).zip(&solvers).collect();
            let solver = StaticSolver::new_beside(model(i), &made);
            solvers.push(solver.map_err(AssemblyError::of_bearing(&assembly.bearings[*i].name))?);
        }
        Ok(AssemblySolver {
            rigid: first_of.iter().map(|i| StaticSolver::rigid(model(i))).collect(),
            solvers,
            columns: type_of.iter().map(|_| ContactColumns::default()).collect(),
            type_of,
            bodies: shared_bodies(&assembly.bearings)?.into(),
        })
    }

    /// The factors of each type, and the first bearing of it.
    pub fn types(&self) -> Vec<(usize, &StaticSolver)> {
        let first = |k: usize| self.type_of.iter().position(|t| *t == k).unwrap_or(0);
        self.solvers
            .iter()
            .enumerate()
            .map(|(k, s)| (first(k), s))
            .collect()
    }

    /// The factors of a bearing.
    pub fn of_bearing(&self, bearing: usize) -> &StaticSolver {
        &self.solvers[self.type_of[bearing]]
    }

    /// Bodies that carry several bearings.
    pub(crate) fn bodies(&self) -> &[SharedBody] {
        &self.bodies
    }

    /// The tangents of the contacts that each bearing goes on with: with them, an equilibrium from the same start has
    /// the same bits.
    pub fn columns(&self) -> &[ContactColumns] {
        &self.columns
    }

    /// Goes on with tangents that were found before.
    pub fn restore_columns(&mut self, columns: Vec<ContactColumns>) {
        self.columns = columns;
    }

    /// No forces on the bodies that carry several bearings: so many as [`AssemblyStart::on_bodies`] has.
    pub fn no_forces_on_bodies(&self) -> Vec<Vec<f64>> {
        self.bodies.iter().map(SharedBody::none).collect()
    }

    /// Another solver with the same rings and these tangents of the contacts, or none; its time is its own.
    pub fn beside(&self, columns: Option<Vec<ContactColumns>>) -> AssemblySolver {
        let none = || self.type_of.iter().map(|_| ContactColumns::default()).collect();
        let beside = |solver: &StaticSolver| solver.beside(ContactColumns::default());
        AssemblySolver {
            solvers: self.solvers.iter().map(beside).collect(),
            rigid: self.rigid.iter().map(beside).collect(),
            type_of: self.type_of.clone(),
            columns: columns.unwrap_or_else(none),
            bodies: Arc::clone(&self.bodies),
        }
    }

    /// The tangents of the contacts by bearing, and the wall time so far by type, effects apart.
    pub fn into_point(self) -> (Vec<ContactColumns>, Vec<Laps>) {
        let pairs = self.solvers.into_iter().zip(self.rigid);
        let laps = pairs.map(|(solver, rigid)| {
            let mut laps = solver.timing;
            laps.merge(&rigid.timing);
            laps
        });
        (self.columns, laps.collect())
    }

    /// Takes the wall time of a point that was solved beside.
    pub fn add_laps(&mut self, of_point: &[Laps]) {
        let pairs = self.solvers.iter_mut().zip(of_point);
        pairs.for_each(|(solver, laps)| solver.timing.merge(laps));
    }

    /// Wall time so far.
    pub fn laps(&self) -> Laps {
        let mut laps = Laps::default();
        for solver in self.solvers.iter().chain(&self.rigid) {
            laps.merge(&solver.laps());
        }
        laps
    }

    /// Equilibrium, from zero displacement or from an earlier solution of the same bearings and shaft. Without an
    /// earlier solution flexible rings start from where rigid ones leave the shaft.
    pub fn solve(
        &mut self,
        assembly: &mut Assembly,
        start: Option<&AssemblySolution>,
    ) -> Result<AssemblySolution, AssemblyError> {
        let poses = vec![Pose::default(); assembly.bearings.len()];
        self.solve_at(assembly, &poses, start.map(AssemblySolution::as_start).as_ref())
    }

    /// The same at another instant, at which the parts of every bearing stand as its pose in its own frame says; the
    /// loads on the shaft are those of the assembly.
    pub fn solve_at(
        &mut self,
        assembly: &mut Assembly,
        poses: &[Pose],
        start: Option<&AssemblyStart>,
    ) -> Result<AssemblySolution, AssemblyError> {
        let is_flexible = |b: &MountedBearing| Side::BOTH.iter().any(|&side| b.model.ring(side).is_some());
        let at = match start {
            Some(start) => start.shaft.clone(),
            None if assembly.bearings.iter().any(is_flexible) => {
                let at = vec![0.0; assembly.shaft.n()];
                self.settle(assembly, (SolvedRings::Rigid, poses), &at, None)?
                    .0
                    .displacements
            }
            None => vec![0.0; assembly.shaft.n()],
        };
        let asked = AskedTolerances::of(assembly);
        let found = self.settle_in_bodies(assembly, poses, &at, (start, &asked));
        asked.set(assembly, 0.0);
        if let (Err(_), Some(start)) = (&found, start) {
            // What failed is forgotten: the bearings are those of the last solution again.
            self.tell(&start.on_bodies, assembly);
        }
        found
    }

    /// Tells all bearings the forces on the bodies that carry several.
    fn tell(&self, forces: &[Vec<f64>], assembly: &mut Assembly) {
        let told = self.bodies.iter().zip(forces);
        told.for_each(|(body, forces)| body.tell(forces, &mut assembly.bearings));
    }

    /// The same with rings as they are, until the forces on bodies that carry several bearings stay as they are.
    fn settle_in_bodies(
        &mut self,
        assembly: &mut Assembly,
        poses: &[Pose],
        at: &[f64],
        (start, asked): (Option<&AssemblyStart>, &AskedTolerances),
    ) -> Result<AssemblySolution, AssemblyError> {
        let mut forces = match start {
            Some(start) => start.on_bodies.clone(),
            None => self.no_forces_on_bodies(),
        };
        let mut mixings: Vec<Mixing> = self.bodies.iter().map(|_| Mixing::default()).collect();
        let (mut before, mut history): (Option<SettledAssembly>, Vec<f64>) = (None, Vec::new());
        let mut iterations = 0;
        let limit = BODY_TOLERANCE.max(assembly.scales().tolerance);
        let mut loose = if self.bodies.is_empty() { 0.0 } else { LOOSEST };
        loop {
            self.tell(&forces, assembly);
            asked.set(assembly, loose);
            let at = before.as_ref().map_or(at, |(shaft, _)| &shaft.displacements);
            let starts: Option<Vec<&Displacements>> = match &before {
                Some((_, bearings)) => Some(bearings.iter().map(|b| &b.displacements).collect()),
                None => start.map(|start| start.bearings.iter().collect()),
            };
            let rings = (SolvedRings::AsTheyAre, poses);
            let (mut shaft, bearings) = self.settle(assembly, rings, at, starts)?;
            let found = self.bodies.iter();
            let found = found.map(|b| b.forces(&assembly.bearings, &bearings));
            let found = found.collect::<Result<Vec<Vec<f64>>, AssemblyError>>()?;
            iterations += shaft.iterations;
            let pairs = forces.iter().zip(&found);
            let changes: Vec<f64> = pairs.map(|(x, g)| change(x, g)).collect();
            let largest = largest(&changes);
            let is_last = largest <= limit || has_stalled(&history, largest);
            if is_last && loose <= asked.least {
                shaft.iterations = iterations;
                return Ok(AssemblySolution {
                    bearings,
                    shaft,
                    on_bodies: forces,
                });
            }
            loose = tolerance_after(largest, is_last);
            history.push(largest);
            if history.len() == MOST_BODY_ROUNDS {
                let body = changes.iter().position(|c| *c == largest).unwrap_or(0);
                return Err(AssemblyError::BodiesNotSettled {
                    body: self.bodies[body].name.clone(),
                    rounds: MOST_BODY_ROUNDS,
                    change: largest,
                });
            }
            let mixed = mixings.iter_mut().zip(forces).zip(&found);
            forces = mixed.map(|((mixing, x), found)| mixing.next(x, found)).collect();
            before = Some((shaft, bearings));
        }
    }

    /// The shaft in balance on bearings with these rings, which stand so, and their solutions.
    fn settle(
        &mut self,
        assembly: &mut Assembly,
        (rings, poses): (SolvedRings, &[Pose]),
        at: &[f64],
        start: Option<Vec<&Displacements>>,
    ) -> Result<SettledAssembly, AssemblyError> {
        let (mounts, scales) = (assembly.mounts(), assembly.scales());
        let problem = Problem {
            shaft: &assembly.shaft,
            load: &assembly.load,
            mounts: &mounts,
            scales,
        };
        let solvers = match rings {
            SolvedRings::Rigid => &mut self.rigid,
            SolvedRings::AsTheyAre => &mut self.solvers,
        };
        let bearings = assembly
            .bearings
            .iter_mut()
            .zip(&mut self.columns)
            .zip(&self.type_of)
            .enumerate()
            .map(|(i, ((bearing, columns), &solver))| BearingSupport {
                model: &mut bearing.model,
                solver,
                columns,
                pose: poses[i],
                start: start.as_ref().map(|starts| starts[i]),
                last: None,
                laps: Laps::default(),
            });
        let mut supports = BearingSupports {
            bearings: bearings.collect(),
            solvers,
        };
        let settled = settle(&problem, &mut supports, at);
        let mut found = Vec::new();
        for bearing in supports.bearings {
            solvers[bearing.solver].timing.merge(&bearing.laps);
            found.push(bearing.last);
        }
        let settled = settled?;
        let answered = |last: Option<StaticSolution>| last.expect("every bearing has answered");
        Ok((settled, found.into_iter().map(answered).collect()))
    }
}

/// Tolerances of forces that a scene asks for, by bearing.
struct AskedTolerances {
    forces: Vec<f64>,
    /// The least of them.
    least: f64,
}

impl AskedTolerances {
    fn of(assembly: &Assembly) -> AskedTolerances {
        let forces: Vec<f64> = assembly
            .bearings
            .iter()
            .map(|b| b.model.tolerances.force)
            .collect();
        AskedTolerances {
            least: forces.iter().copied().fold(f64::INFINITY, f64::min),
            forces,
        }
    }

    /// Gives the bearings theirs, or `loose` where that is more.
    fn set(&self, assembly: &mut Assembly, loose: f64) {
        for (bearing, force) in assembly.bearings.iter_mut().zip(&self.forces) {
            bearing.model.tolerances.force = force.max(loose);
        }
    }
}

/// With which rings.
#[derive(Clone, Copy)]
enum SolvedRings {
    Rigid,
    AsTheyAre,
}

/// Whether one factorisation serves both: the same rings, contacts found on them in the same way.
fn have_same_rings(a: &Model, b: &Model) -> bool {
    let same = |side: Side| match (&a.rings[side.index()], &b.rings[side.index()]) {
        (None, None) => true,
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        _ => false,
    };
    Side::BOTH.into_iter().all(same)
        && a.contact.mode == b.contact.mode
        && a.geometry.n_balls == b.geometry.n_balls
}
