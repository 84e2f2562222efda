//! Loads on bodies and contacts: at rest, and for loads that follow the contact angles, until both rest.
//!
//! Loads that do not depend on contact angles are evaluated once. Those that do (the gyroscopic moment; with the
//! speeds of outer raceway control the centrifugal force of the balls too) are evaluated again at the angles of the
//! equilibrium that they gave, until they do not change: a fixed point, since they are dead loads to Newton. Each
//! pass shrinks the change by (change of the loads) / (change of the contact forces), below 0.4 for the gyroscopic
//! moment with the centrifugal force of the balls, even on balls that have left the inner raceway. Where it does not
//! shrink so fast, as for the moment of a fast bearing alone under a small load, where full steps go back and forth
//! for ever, passes are mixed (module `relaxation`).

use contact::{Meridian, Side};
use ring::RingModel;
use timer::SharedLaps;

use crate::bearing::{BearingParts, ContactList, SeatStep};
use crate::bodies::{FlatBody, Inertia, Name};
use crate::displacements::Displacements;
use crate::effects::steady_balls::{SteadyBalls, drag};
use crate::effects::{AtEquilibrium, Loads, Now, resultant, static_inertia, sum_of};
use crate::equilibrium::SearchScales;
use crate::error::DynamicsError;
use crate::frame::{turn, turn_nodal};
use crate::interactions::raceway_contact::Site;
use crate::model::Model;
use crate::pose::Pose;
use crate::relaxation::{Relaxation, following};
use crate::surface_equilibrium::settle_on_surfaces;
use crate::surfaces::{Strips, SurfacePlace};
use crate::system::Interval;

/// First step of a drag that grows, as a share of it, and the least.
const FIRST_SHARE: f64 = 0.25;
const LEAST_SHARE: f64 = 1e-3;

/// Bodies and contacts of a model at an instant, with their loads.
pub struct LoadCase<'a> {
    /// Model.
    pub model: &'a Model,
    /// Instant.
    pub pose: Pose,
    /// Bodies and contacts, with the loads in them.
    pub parts: BearingParts,
    /// The loads.
    pub loads: Loads,
    /// Limits and scales of the search.
    pub scales: SearchScales,
    /// Newton iterations so far.
    pub newton_iterations: usize,
    /// Share of the drag on free balls that acts.
    drag_share: f64,
}

impl<'a> LoadCase<'a> {
    /// Those on rigid rings, with the loads of an instant on contacts as they stand in `u`.
    pub fn new(
        model: &'a Model,
        pose: Pose,
        costs: &SharedLaps,
        u: &Displacements,
    ) -> Result<LoadCase<'a>, DynamicsError> {
        let mut parts = parts_at(&pose, model);
        parts.set_rings([None, None], &u.grooves);
        let stiffness = model.hertz[0].stiffness.max(model.hertz[1].stiffness);
        let mut case = LoadCase {
            model,
            pose,
            parts,
            loads: Loads::none(model.geometry.n_balls),
            scales: SearchScales::new(&model.geometry, stiffness),
            newton_iterations: 0,
            drag_share: 1.0,
        };
        case.loads = case.loads_at(costs, u)?;
        case.parts.set_loads(&case.loads);
        Ok(case)
    }

    /// Loads at the contact angles and forces of `u`.
    fn loads_at(&self, costs: &SharedLaps, u: &Displacements) -> Result<Loads, DynamicsError> {
        self.with_now(u, |now| {
            let loads = self.model.timed_loads(now, costs)?;
            let inertia = static_inertia(self.model, &loads)?;
            in_frames(&self.pose, self.model, loads, inertia)
        })
    }

    /// How free balls roll in `u`; None where they are not free, or nothing rolls.
    pub fn steady(&self, u: &Displacements) -> Result<Option<SteadyBalls>, DynamicsError> {
        self.with_now(u, |now| SteadyBalls::of(self.model, now))
    }

    /// How free balls that nothing drives are taken to roll in `u`; None where they are not free.
    pub fn undriven(&self, u: &Displacements) -> Option<SteadyBalls> {
        self.with_now(u, |now| SteadyBalls::undriven(self.model, now))
    }

    /// The instant with contacts and balls as they stand in `u`.
    fn with_now<T>(&self, u: &Displacements, see: impl FnOnce(&Now) -> T) -> T {
        let states = self.parts.states_at(u);
        let angles: Vec<f64> = states.iter().map(|state| state.angle).collect();
        let forces: Vec<f64> = states.iter().map(|state| state.force.force).collect();
        let approaches: Vec<f64> = states.iter().map(|state| state.force.approach).collect();
        let sites = self.parts.contacts.sites.iter();
        let strips: Vec<Option<&Strips>> = sites.map(|site| site.strips.as_ref()).collect();
        let now = Now {
            angles: Some(&angles),
            seen: Some(AtEquilibrium {
                forces: &forces,
                approaches: &approaches,
                strips: &strips,
                balls: &u.balls,
                drag_share: self.drag_share,
            }),
            ..self.pose.now
        };
        see(&now)
    }

    /// Newton on bodies and contacts as they are.
    pub fn minimise(&mut self, start: &Displacements) -> Result<Displacements, DynamicsError> {
        let (u, iterations) = settle_on_surfaces(&mut self.parts, start, self.scales)?;
        self.newton_iterations += iterations;
        Ok(u)
    }

    /// Equilibrium under loads that may follow the contact angles: they become those of the equilibrium. The time of
    /// effects goes to `costs`.
    pub fn settle(
        &mut self,
        costs: &SharedLaps,
        start: Displacements,
    ) -> Result<Displacements, DynamicsError> {
        match self.settle_from(costs, &start) {
            Err(DynamicsError::NotSettled { .. }) if drag(self.model) > 0.0 => {
                self.settle_by_drag(costs, start)
            }
            settled => settled,
        }
    }

    /// The same along equilibria under a drag that grows: one that nearly stops a ball may have others beside it, or
    /// none near the start.
    fn settle_by_drag(
        &mut self,
        costs: &SharedLaps,
        start: Displacements,
    ) -> Result<Displacements, DynamicsError> {
        self.drag_share = 0.0;
        self.loads = self.loads_at(costs, &start)?;
        self.parts.set_loads(&self.loads);
        let (mut share, mut step, mut u) = (0.0, FIRST_SHARE, self.settle_from(costs, &start)?);
        while share < 1.0 {
            let loads = self.loads.clone();
            self.drag_share = (share + step).min(1.0);
            match self.settle_from(costs, &u) {
                Ok(found) => (u, share, step) = (found, self.drag_share, 2.0 * step),
                Err(DynamicsError::NotSettled { .. }) if step > LEAST_SHARE => {
                    (self.loads, step) = (loads, 0.25 * step);
                    self.parts.set_loads(&self.loads);
                }
                Err(error) => return Err(error),
            }
        }
        Ok(u)
    }

    /// The same from one start.
    fn settle_from(
        &mut self,
        costs: &SharedLaps,
        start: &Displacements,
    ) -> Result<Displacements, DynamicsError> {
        let mut u = self.minimise(start)?;
        if !self.loads.follows_angles {
            return Ok(u);
        }
        let tolerance = self.model.tolerances.force;
        let (mut history, mut worst) = (Vec::new(), 0);
        let mut relaxation = Relaxation::default();
        for _ in 0..self.model.tolerances.max_rounds {
            let mut next = self.loads_at(costs, &u)?;
            let largest = largest_force(&self.parts.forces_at(&u));
            let n_contacts = next.contacts.len();
            let (change, place) = largest_change(&following(&self.loads), &following(&next), largest);
            if change <= tolerance {
                return Ok(u);
            }
            worst = if place < n_contacts {
                place
            } else {
                2 * (place - n_contacts)
            };
            history.push(change);
            relaxation.mix(&self.loads, &mut next);
            self.loads = next;
            self.parts.set_loads(&self.loads);
            u = self.minimise(&u)?;
        }
        Err(not_settled(self.model, tolerance, worst, history))
    }

    /// Forces on the rings: the normal ones and the contact loads, N, by site.
    pub fn ring_forces(&self, normal: &[Meridian]) -> Vec<Meridian> {
        let mut forces = normal.to_vec();
        for (sum, load) in forces.iter_mut().zip(&self.loads.contacts) {
            *sum = *sum + *load;
        }
        forces
    }
}

/// Bodies and contacts of an instant on rings that do not deform, still without loads.
fn parts_at(pose: &Pose, model: &Model) -> BearingParts {
    let (geometry, mounting) = (&model.geometry, model.mounting.at(pose.now.time));
    let site = |ball: usize, side: Side| {
        let azimuth = geometry.azimuth(ball) + pose.now.cage_angle;
        let mut site = Site::new(model, &mounting, ball, side, azimuth);
        site.ring_azimuth -= pose.frame_angle(side);
        let place = SurfacePlace {
            azimuth: site.ring_azimuth,
            rolled: pose.rolled,
            seen: None,
        };
        site.strips = model.surfaces.at(ball, side, place);
        site
    };
    let sites = (0..geometry.n_balls).flat_map(|ball| Side::BOTH.map(|side| site(ball, side)));
    let imposed = [0, 1, 2, 3, 4].map(|dof| model.prescribed(dof, pose.now.time));
    let ball = |ball: usize| FlatBody::new(Name::Ball(ball), [Inertia::default(); 2], [None; 2]);
    BearingParts::new(
        Interval::Rest,
        FlatBody::new(Name::Shaft, [Inertia::default(); 5], imposed),
        (0..geometry.n_balls).map(ball).collect(),
        [None, None],
        ContactList {
            sites: sites.collect(),
            dead: Vec::new(),
            means: None,
        },
        model.seat().map(|seat| SeatStep {
            seat,
            axial: Inertia::default(),
            weight: 0.0,
        }),
    )
}

impl BearingParts {
    /// Puts loads in the place of those before.
    pub fn set_loads(&mut self, loads: &Loads) {
        for (i, dof) in self.shaft.dofs.iter_mut().enumerate() {
            dof.load = loads.shaft[i] + loads.ring_on_shaft[i];
        }
        self.shaft.tilted = self.tilted_loads(loads);
        for (ball, (load, slope)) in self
            .balls
            .iter_mut()
            .zip(loads.balls.iter().zip(&loads.ball_slopes))
        {
            (ball.dofs[0].load, ball.dofs[1].load) = (load.radial, load.axial);
            ball.dofs[0].load_slope = *slope;
        }
        if let Some(seat) = &mut self.seat {
            seat.body.dofs[2].load = loads.ring_on_seat + loads.seat;
        }
        self.contacts.dead.clone_from(&loads.contacts);
    }
}

/// Contact places or loads that do not come to rest; `worst` is the site that changes most.
pub fn not_settled(model: &Model, limit: f64, worst: usize, mut history: Vec<f64>) -> DynamicsError {
    let tail = history.len().saturating_sub(6);
    DynamicsError::NotSettled {
        rounds: model.tolerances.max_rounds,
        change: *history.last().unwrap_or(&f64::NAN),
        limit,
        ball: worst / 2,
        side: Side::BOTH[worst % 2].name(),
        history: history.split_off(tail),
    }
}

/// Largest of the forces, N.
pub fn largest_force(forces: &[Meridian]) -> f64 {
    forces.iter().map(|f| f.norm()).fold(f64::MIN_POSITIVE, f64::max)
}

/// Largest change over a scale (N), and where.
pub fn largest_change(old: &[Meridian], new: &[Meridian], scale: f64) -> (f64, usize) {
    old.iter()
        .zip(new)
        .enumerate()
        .fold((0.0, 0), |(largest, place), (i, (a, b))| {
            let change = (*a - *b).norm() / scale;
            if change > largest {
                (change, i)
            } else {
                (largest, place)
            }
        })
}

/// Weights of a ring's nodes under an acceleration in its frame, m/s2: N, `[n_nodes][3]` flat.
fn nodal_weights((ring, side): (&RingModel, Side), g: [f64; 3]) -> Result<Vec<f64>, DynamicsError> {
    let masses = ring.node_masses(side.name())?;
    Ok(masses.masses.iter().flat_map(|m| g.map(|a| m * a)).collect())
}

/// Loads of which those on the nodes of flexible rings are given in the rings' own frames, and the shaft carries
/// the resultant on the inner ring where the turned nodes stand. `inertia` are loads in these frames, inner first,
/// N, `[n_nodes][3]` flat; they have no force along z. Collective.
fn in_frames(
    pose: &Pose,
    model: &Model,
    mut loads: Loads,
    inertia: [Option<Vec<f64>>; 2],
) -> Result<Loads, DynamicsError> {
    for (side, inertia) in Side::BOTH.into_iter().zip(inertia) {
        let in_space = loads.rings[side.index()].take();
        let turned = in_space.map(|load| turn_nodal(&load, -pose.frame_angle(side)));
        let weight = loads.weights[side.index()].take().zip(model.ring(side));
        let weight = weight
            .map(|(weight, ring)| nodal_weights((ring, side), weight.seen_from(pose.frame_angle(side))));
        loads.rings[side.index()] = sum_of([turned, weight.transpose()?, inertia]);
        loads.bodies[side.index()] = model.body_load(side, &pose.now, pose.frame_angle(side));
    }
    let inner = model.ring(Side::Inner).zip(loads.rings[0].as_ref());
    if let Some((ring, load)) = inner {
        let places = ring.places(Side::Inner.name(), model.backend)?;
        let resultant = resultant(&places, ring.groove.centre_z, load);
        loads.ring_on_shaft = turn(resultant, pose.frame_angle(Side::Inner));
    }
    Ok(loads)
}
