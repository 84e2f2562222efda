//! Static equilibrium of the bearing: rounds of (place patches, measure the rings, solve the contacts).
//!
//! ```text
//! rigid equilibrium -> first places and forces
//! columns: compliance C of all contacts, once per ring (one block solve)
//! repeat
//!     place patches from the forces and contact angles
//!     u = K^-1 (patch loads), one solve per ring; c = motion measured by the same patches
//!     Newton on balls, shaft and groove motions with u_c = c + C (F - F0)
//!         (again while loads that follow the contact angles change)
//! until no force changes
//! ```
//! C is only a tangent: a slightly outdated one costs rounds, never accuracy; it is renewed when rounds contract
//! slowly.

use std::sync::Arc;

use contact::{Meridian, Side};
use timer::{Laps, SharedLaps, Stopwatch};

use crate::bearing::{BearingParts, partner};
use crate::compliance;
use crate::costs::{self, COLUMNS, EFFECTS, FACTOR, NEWTON, PATCHES, SOLVE};
use crate::displacements::Displacements;
use crate::effects::Loads;
use crate::equilibrium::{SearchScales, check_held, minimise, round_off};
use crate::error::DynamicsError;
use crate::footprint::{Footprint, check_in_grooves, check_on_groove, place};
use crate::interactions::raceway_contact::on_rings;
use crate::loading::{LoadCase, largest_change, largest_force, not_settled};
use crate::model::{ContactMode, Model};
use crate::pose::Pose;
use crate::raceway::Raceway;
use crate::solution::{RingFields, StaticSolution};
use crate::system::ElasticPorts;
use ring::Inventory;
use ring::statics::{RingSolver, StaticSettings};
use ring::{Backend, RingModel};

/// Contraction of a round above which the columns are renewed.
const SLOW_CONTRACTION: f64 = 0.2;
/// Facets make the force jump where a ball changes facets; rounds settle to this share of the largest force.
const FACET_TOLERANCE: f64 = 1e-6;

/// Stages in which the facets' offsets are brought in.
const FACET_STAGES: usize = 8;

/// A factored flexible ring and its raceway.
pub struct StaticRing {
    /// The ring.
    pub solver: RingSolver,
    /// Where contacts find it.
    pub raceway: Arc<Raceway>,
}

/// Inverse compliance of the contacts on both rings, inner first; none yet by default.
pub type ContactColumns = [Option<Vec<f64>>; 2];

/// Factored rings of a model, ready for any number of load cases.
pub struct StaticSolver {
    /// Several solvers of one run may have the same rings.
    rings: [Option<Arc<StaticRing>>; 2],
    columns: ContactColumns,
    /// Wall time so far, effects apart.
    pub timing: Laps,
    /// Wall time so far, by effect.
    pub costs: Arc<SharedLaps>,
}

/// What the ring on `side` is made with.
pub fn settings(model: &Model, side: Side) -> StaticSettings {
    StaticSettings {
        name: side.name(),
        partner: partner(model, side),
        backend: model.backend,
        n_contacts: model.geometry.n_balls,
    }
}

impl StaticRing {
    /// Assembles and factors the stiffness of the ring on `side`.
    pub fn new(model: &Model, side: Side, ring: &RingModel) -> Result<StaticRing, DynamicsError> {
        StaticRing::beside((model, side, ring), &[])
    }

    /// The same beside other bearings: it takes what it has in common with their rings.
    fn beside(
        (model, side, ring): (&Model, Side, &RingModel),
        made: &[(&Model, &StaticSolver)],
    ) -> Result<StaticRing, DynamicsError> {
        let rings = made.iter().filter_map(|(other, solver)| {
            let (of, made) = (other.ring(side)?, solver.ring(side)?);
            Some((*other, of, made))
        });
        let solvers: Vec<_> = rings.clone().map(|(_, of, made)| (of, &made.solver)).collect();
        let mut solver = RingSolver::beside(ring, settings(model, side), &solvers)?;
        let alike = rings.filter(|(other, _, made)| {
            other.contact.mode == model.contact.mode && made.solver.shares_factor(&solver)
        });
        let raceway = match alike.map(|(_, _, made)| made.raceway.clone()).next() {
            Some(raceway) => raceway,
            None => {
                let raceway = || Raceway::new(ring, model.contact.mode);
                Arc::new(solver.laps.time(FACTOR, raceway))
            }
        };
        Ok(StaticRing { solver, raceway })
    }
}

impl StaticSolver {
    /// Factors both rings, on two threads if there are two.
    pub fn new(model: &Model) -> Result<StaticSolver, DynamicsError> {
        StaticSolver::new_beside(model, &[])
    }

    /// The same beside other bearings: rings that are alike but for the bodies they are tied to are factored once.
    pub fn new_beside(
        model: &Model,
        made: &[(&Model, &StaticSolver)],
    ) -> Result<StaticSolver, DynamicsError> {
        let build = |side: Side| {
            let ring = model.ring(side).map(|ring| (model, side, ring));
            ring.map(|ring| StaticRing::beside(ring, made)).transpose()
        };
        let rings = model.backend.try_on_sides(build)?;
        let mut timing = Laps::default();
        for ring in rings.iter().flatten() {
            timing.merge(&ring.solver.laps);
        }
        Ok(StaticSolver {
            rings: rings.map(|ring| ring.map(Arc::new)),
            columns: ContactColumns::default(),
            timing,
            costs: Arc::new(costs::of_effects(model)),
        })
    }

    /// The bearing of a model as if its rings were rigid: where flexible ones may start from.
    pub fn rigid(model: &Model) -> StaticSolver {
        StaticSolver {
            rings: [None, None],
            columns: ContactColumns::default(),
            timing: Laps::default(),
            costs: Arc::new(costs::of_effects(model)),
        }
    }

    /// Another solver with the same rings and these tangents of the contacts; its time is its own, that of effects goes
    /// to the same costs.
    pub fn beside(&self, columns: ContactColumns) -> StaticSolver {
        StaticSolver {
            rings: self.rings.clone(),
            columns,
            timing: Laps::default(),
            costs: Arc::clone(&self.costs),
        }
    }

    /// The tangents of the contacts and the wall time so far, effects apart.
    pub fn into_point(self) -> (ContactColumns, Laps) {
        (self.columns, self.timing)
    }

    /// Wall time so far, effects among it.
    pub fn laps(&self) -> Laps {
        self.laps_with(&Laps::default())
    }

    /// The same with that of points which have been solved beside.
    pub fn laps_with(&self, points: &Laps) -> Laps {
        let mut laps = self.timing.clone();
        laps.merge(points);
        laps.merge_into(EFFECTS, &self.costs.laps());
        laps
    }

    /// The ring of one side.
    pub fn ring(&self, side: Side) -> Option<&StaticRing> {
        self.rings[side.index()].as_deref()
    }

    /// What both rings hold.
    pub fn inventory(&self) -> Inventory {
        let rings = self.rings.iter().flatten();
        rings.fold(Inventory::default(), |sum, ring| sum + ring.solver.inventory())
    }

    /// Equilibrium under the model's loads, from zero displacement or from an earlier solution. The model must have the
    /// rings that were factored, and the balls of the earlier solution.
    pub fn solve(
        &mut self,
        model: &Model,
        start: Option<&StaticSolution>,
    ) -> Result<StaticSolution, DynamicsError> {
        self.solve_at(model, &Pose::default(), start)
    }

    /// The same at another instant: of a bearing that has turned, with the loads and imposed displacements of its time.
    pub fn solve_at(
        &mut self,
        model: &Model,
        pose: &Pose,
        start: Option<&StaticSolution>,
    ) -> Result<StaticSolution, DynamicsError> {
        self.solve_from(model, pose, start.map(|solution| &solution.displacements))
    }

    /// The same from the displacements of an earlier solution, of which nothing else is needed.
    pub fn solve_from(
        &mut self,
        model: &Model,
        pose: &Pose,
        start: Option<&Displacements>,
    ) -> Result<StaticSolution, DynamicsError> {
        let u = self.start(model, pose.now.time, start);
        let mut case = LoadCase::new(model, *pose, &self.costs, &u)?;
        let mut clock = Stopwatch::start();
        // Rings as they were (undeformed without a start): places and forces near those of the new loads.
        let u = case.settle(&self.costs, u)?;
        self.timing.add(NEWTON, clock.lap());
        if self.rings.iter().any(Option::is_some) {
            return self.rounds(case, u);
        }
        let states = case.parts.states_at(&u);
        check_in_grooves(&case.parts.contacts.sites, &states, &on_rings(&states))?;
        check_held(&case.parts, &u, case.scales)?;
        let rings = RingFields {
            elastic: [None, None],
            footprints: [Vec::new(), Vec::new()],
        };
        StaticSolution::new(case, u, rings, 1)
    }

    /// Displacements to start from.
    fn start(&self, model: &Model, time: f64, start: Option<&Displacements>) -> Displacements {
        let flexible = [self.rings[0].is_some(), self.rings[1].is_some()];
        let mut u = match start {
            Some(earlier) => earlier.clone(),
            None => Displacements::zero(model.geometry.n_balls, flexible),
        };
        for (i, q) in u.shaft.iter_mut().enumerate() {
            *q = model.prescribed(i, time).unwrap_or(*q);
        }
        u
    }

    fn rounds(&mut self, mut case: LoadCase, mut u: Displacements) -> Result<StaticSolution, DynamicsError> {
        let model = case.model;
        let tolerance = match model.contact.mode {
            ContactMode::Facet => model.tolerances.force.max(FACET_TOLERANCE),
            _ => model.tolerances.force,
        };
        let mounting = model.mounting.at(case.pose.now.time);
        let mut forces = case.parts.forces_at(&u);
        let (mut history, mut worst) = (Vec::new(), 0);
        for round in 1..=model.tolerances.max_rounds {
            let mut clock = Stopwatch::start();
            let mut feet = [Vec::new(), Vec::new()];
            let states = case.parts.states_at(&u);
            for side in Side::BOTH {
                if let Some(ring) = &self.rings[side.index()] {
                    let contacts = &mut case.parts.contacts;
                    feet[side.index()] =
                        place(model, &mounting, side, &ring.raceway, contacts, &states, &forces)?;
                }
            }
            self.timing.add(PATCHES, clock.lap());
            self.renew_columns(model.backend, &feet, &history)?;
            let ring_forces = case.ring_forces(&forces);
            let fields = self.fields(model, &feet, &ring_forces, &case.loads);
            let rings = self.answers(&feet, &ring_forces, &fields);
            case.parts.set_rings(rings, &u.grooves);
            let contact_loads = case.loads.contacts.clone();
            let mut clock = Stopwatch::start();
            if round == 1 {
                adopt_offsets(&case.parts, &mut u, case.scales.step);
                u = approach_facets(&mut case.parts, u, case.scales)?;
            }
            u = case.settle(&self.costs, u)?;
            self.timing.add(NEWTON, clock.lap());
            let updated = case.parts.forces_at(&u);
            let largest = largest_force(&updated);
            let normal = largest_change(&forces, &updated, largest);
            let across = largest_change(&contact_loads, &case.loads.contacts, largest);
            let (change, place) = if across.0 > normal.0 { across } else { normal };
            (forces, worst) = (updated, place);
            history.push(change);
            if change <= tolerance.max(round_off(&case.parts, &u) / largest) {
                self.check_places(&case.parts, &u, &forces)?;
                check_held(&case.parts, &u, case.scales)?;
                check_patches(&case.parts, &u)?;
                let rings = RingFields {
                    elastic: fields,
                    footprints: feet,
                };
                return StaticSolution::new(case, u, rings, round);
            }
        }
        self.check_places(&case.parts, &u, &forces)?;
        Err(not_settled(model, tolerance, worst, history))
    }

    fn check_places(
        &self,
        parts: &BearingParts,
        u: &Displacements,
        forces: &[Meridian],
    ) -> Result<(), DynamicsError> {
        let (sites, states) = (&parts.contacts.sites, parts.states_at(u));
        let mut rings = self.rings.iter().flatten();
        rings.try_for_each(|ring| check_on_groove(&ring.raceway.surface, sites, &states, forces))?;
        check_in_grooves(sites, &states, forces)
    }

    /// Computes the compliance columns when there are none, and again when rounds contract slowly.
    fn renew_columns(
        &mut self,
        backend: Backend,
        feet: &[Vec<Footprint>; 2],
        history: &[f64],
    ) -> Result<(), DynamicsError> {
        let slow = matches!(history, [.., before, last] if *last > SLOW_CONTRACTION * before);
        let mut clock = Stopwatch::start();
        let rings = &self.rings;
        let columns = &self.columns;
        let renewed = |side: Side| -> Result<Option<Vec<f64>>, DynamicsError> {
            let i = side.index();
            let Some(ring) = rings[i].as_ref().filter(|_| columns[i].is_none() || slow) else {
                return Ok(None);
            };
            let weights: Vec<_> = feet[i].iter().map(|f| f.weights.clone()).collect();
            let n = 2 * weights.len();
            let columns = ring.solver.compliance(&weights);
            compliance::inverse(side, n, n / 2, &columns).map(Some)
        };
        let renewed = backend.try_on_sides(renewed)?;
        for (columns, new) in self.columns.iter_mut().zip(renewed) {
            if new.is_some() {
                *columns = new;
            }
        }
        self.timing.add(COLUMNS, clock.lap());
        Ok(())
    }

    /// Elastic fields of both rings under the contact forces and body loads.
    fn fields(
        &mut self,
        model: &Model,
        feet: &[Vec<Footprint>; 2],
        forces: &[Meridian],
        loads: &Loads,
    ) -> [Option<Vec<f64>>; 2] {
        let mut clock = Stopwatch::start();
        let field = |side: Side| {
            let ring = self.rings[side.index()].as_ref()?;
            let mut load = loads.rings[side.index()]
                .clone()
                .unwrap_or_else(|| vec![0.0; ring.solver.n_dofs()]);
            for (ball, foot) in feet[side.index()].iter().enumerate() {
                foot.weights
                    .add_load(forces[2 * ball + side.index()].to_array(), &mut load);
            }
            let seat = model.seat_motion(side, loads.bodies[side.index()]);
            Some(ring.solver.solve_on(load, 1, seat.as_deref()))
        };
        let fields = model.backend.on_sides(field);
        self.timing.add(SOLVE, clock.lap());
        fields
    }

    /// How the rings answer at their contacts: the motions measured under these forces, and the columns.
    fn answers(
        &self,
        feet: &[Vec<Footprint>; 2],
        forces: &[Meridian],
        fields: &[Option<Vec<f64>>; 2],
    ) -> [Option<ElasticPorts>; 2] {
        Side::BOTH.map(|side| {
            let i = side.index();
            let (field, stiffness) = (fields[i].as_ref()?, self.columns[i].as_ref()?);
            let measured = feet[i].iter().flat_map(|f| f.weights.measure(field));
            Some(ElasticPorts {
                name: side.name(),
                start: vec![0.0; 2 * feet[i].len()],
                offset: measured.collect(),
                at_forces: (0..feet[i].len())
                    .flat_map(|b| forces[2 * b + i].to_array())
                    .collect(),
                stiffness: stiffness.clone(),
                n_moving: 2 * feet[i].len(),
                ..ElasticPorts::default()
            })
        })
    }
}

/// Follows the equilibrium from exact grooves to their facets, whose offsets exceed the approach of the balls.
fn approach_facets(
    parts: &mut BearingParts,
    mut u: Displacements,
    scales: SearchScales,
) -> Result<Displacements, DynamicsError> {
    let exact = parts.contacts.sites.iter().all(|site| site.unevenness.is_none());
    if exact {
        return Ok(u);
    }
    let full: Vec<_> = parts
        .contacts
        .sites
        .iter()
        .map(|s| s.unevenness.clone())
        .collect();
    for i in 1..FACET_STAGES {
        let share = i as f64 / FACET_STAGES as f64;
        for (site, unevenness) in parts.contacts.sites.iter_mut().zip(&full) {
            site.unevenness = unevenness.as_ref().map(|x| Arc::new(x.scaled(share)));
        }
        u = minimise(parts, &u, scales)?.0;
    }
    for (site, unevenness) in parts.contacts.sites.iter_mut().zip(full) {
        site.unevenness = unevenness;
    }
    Ok(u)
}

/// Grooves where the forces of their contacts put them: the first guess of a ring that answers for the first time. Not
/// where one would go farther than `longest`, m: balls and shaft of a bearing in a soft body would be left behind,
/// pressed by many times any load. Newton takes them along.
fn adopt_offsets(parts: &BearingParts, u: &mut Displacements, longest: f64) {
    let list = |ring: &Option<ElasticPorts>| ring.as_ref().map(|ring| Meridian::list(&ring.offset));
    let offsets = parts.rings.each_ref().map(list).map(Option::unwrap_or_default);
    let mut moves = u
        .grooves
        .iter()
        .zip(&offsets)
        .flat_map(|(from, to)| from.iter().zip(to));
    if moves.any(|(from, to)| (*to - *from).norm() > longest) {
        return;
    }
    for (groove, offsets) in u.grooves.iter_mut().zip(offsets) {
        groove.iter_mut().zip(offsets).for_each(|(g, c)| *g = c);
    }
}

fn check_patches(parts: &BearingParts, u: &Displacements) -> Result<(), DynamicsError> {
    for (site, state) in parts.contacts.sites.iter().zip(parts.states_at(u)) {
        if state.force.beyond_limit {
            return Err(DynamicsError::PatchTooSmall {
                ball: site.ball,
                side: site.side.name(),
                force: state.force.force,
            });
        }
    }
    Ok(())
}
