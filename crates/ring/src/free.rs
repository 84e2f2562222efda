//! Steps of a ring that nothing holds: the forces inside it have no moment.
//!
//! Displacements are linear, so K w has neither a net force nor a moment about the undeformed places X of the nodes.
//! About the places X + w where they are it has one, the sum of w x K w: of second order, but nothing would take it. A
//! ring that is held leaves it to shaft or housing; of a free one it would be made out of nothing. Here the rigid
//! acceleration b is found with which inertia and loads balance about the places where the nodes are,
//! ```text
//! sum over the nodes of (X + w) x (M a - F) = 0     and the sum of M a - F = 0
//! ```
//! at the weighted time of the step, F all but the forces inside. It comes by a load M R b, R the rigid motions, to
//! which the ring answers by R b / s, S R = s M R, without a solve. Contacts see it at their ports, so that their
//! forces are found again, once as a rule: it is a millionth of their motion. A contact acts where its ports are, in
//! the meridian plane of its ball.
//!
//! With average acceleration (X + w) x M v changes over a step by the moments of the forces at the mean places, to
//! round-off: a contact whose force acts along the mean of its ends takes from a ball what it gives to the ring.
//! The work of M R b stands with that of the frame.

use std::sync::Arc;

use contact::cross;
use dense::DenseLu;
use timer::Laps;

use crate::body::{ElasticBody, HeldRing, frame_inertia, resultant};
use crate::coordinates::RIGID_MOTIONS;
use crate::error::RingError;
use crate::integrator::StepScheme;
use crate::matrices::Matrix;
use crate::nodal::columns::Ports;
use crate::sparse::{SparseLoad, sparse_dot};
use crate::state::RingState;
use crate::step::{ElasticStep, End, Feet, Known, KnownLoad, PortAnswer, PortForces, Settling, StepFactor};
use crate::vectors::{add_part, combined};

/// One number of each rigid motion: along x, y, z, then about them, through the point z = 0 of the mesh's axis.
type Rigid = [f64; RIGID_MOTIONS];

/// Change of the load of the rigid acceleration over the largest force of the bearing at which contacts keep theirs.
const TOLERANCE: f64 = 1e-9;
/// The same over that load itself, which moves contacts by a millionth of what they move.
const SHARE: f64 = 1e-3;
/// Rounds in which contacts answer to it: each leaves a millionth. Beyond is round-off.
const MOST_ROUNDS: usize = 2;
/// Corrections of the end of a step: each leaves strains of what there was before.
const CORRECTIONS: usize = 2;

/// The factor of a free ring.
pub(crate) struct FreeFactor {
    body: Arc<dyn ElasticBody>,
    /// That of a ring whose forces inside may have a moment.
    inner: Box<dyn StepFactor>,
    scheme: StepScheme,
    rigid: RigidResponse,
}

/// Rigid motions as vectors of a body, and how it answers to loads of their inertia.
struct RigidResponse {
    vectors: Vec<Vec<f64>>,
    /// M of one by another, flat, and its factor.
    mass: Vec<f64>,
    factor: DenseLu,
    /// s in S R = s M R.
    effective: f64,
}

/// A step of a free ring under way.
struct FreeStep<'a> {
    factor: &'a FreeFactor,
    inner: Box<dyn ElasticStep + 'a>,
    old: &'a RingState,
    known: Arc<Known>,
    contacts: ContactPorts,
    /// The rigid acceleration that contacts see.
    acceleration: Rigid,
    /// How often it has changed for them.
    rounds: usize,
    answer: PortAnswer,
}

/// The ports of the contacts of a ring.
struct ContactPorts {
    ports: Ports,
    /// Directions of the forces at them.
    directions: Vec<[f64; 3]>,
}

/// Forces of the contacts.
struct ContactForces<'a> {
    on: &'a ContactPorts,
    at_ports: &'a [f64],
    /// At the nodes, `[n_nodes][3]` flat.
    nodal: Vec<f64>,
}

/// Whether nothing holds a ring, so that it is stepped by a [`FreeFactor`].
pub(crate) fn is_free(body: &dyn ElasticBody) -> bool {
    let held = body.held();
    body.tied().is_none() && held.mount.is_empty() && held.coordinates.held_nodes().is_empty()
}

impl FreeFactor {
    /// Steps of a body that is free by its factor `inner`.
    pub fn new(
        body: Arc<dyn ElasticBody>,
        inner: Box<dyn StepFactor>,
        scheme: StepScheme,
    ) -> Result<FreeFactor, RingError> {
        let rigid = RigidResponse::new(&*body, scheme)?;
        Ok(FreeFactor {
            body,
            inner,
            scheme,
            rigid,
        })
    }

    /// What the balance of the whole ring lacks over a step, N and N m, without the forces inside.
    fn imbalance(
        &self,
        [old, new]: [&RingState; 2],
        known: &KnownLoad,
        contacts: &ContactForces<'_>,
    ) -> Rigid {
        let (body, held) = (&*self.body, self.body.held());
        let s = self.scheme.integrator;
        let at = |weight: f64, from: &[f64], to: &[f64]| combined([weight, 1.0 - weight], from, to);
        let w = body.nodal(&at(s.alpha_f, old.displacement(), new.displacement()));
        let v = body.nodal(&at(s.alpha_f, old.velocity(), new.velocity()));
        let mut field = body.nodal(&at(s.alpha_m, old.acceleration(), new.acceleration()));
        let drag = held.damping[0];
        field.iter_mut().zip(&v).for_each(|(a, v)| *a += drag * v);
        if let Some(turn) = known.turn {
            let inertia = frame_inertia(held, turn, [&w, &v]);
            field.iter_mut().zip(&inertia).for_each(|(a, f)| *a -= f);
        }
        let mut net = body.matrices().nodal_mass_product(&field);
        if let Some(load) = &known.load {
            net.iter_mut()
                .zip(body.nodal(load))
                .for_each(|(net, f)| *net -= f);
        }
        let [force, moment] = resultant(&held.places, Some(&w), &net);
        let [on_contacts, about_contacts] = resultant(&held.places, None, &contacts.nodal);
        let moved = contacts.moment_by(&held.coordinates.reduce(&w));
        let forces = [0, 1, 2].map(|c| force[c] - on_contacts[c]);
        let moments = [0, 1, 2].map(|c| moment[c] - about_contacts[c] - moved[c]);
        let mut lack = [0.0; RIGID_MOTIONS];
        lack.copy_from_slice([forces, moments].as_flattened());
        lack
    }

    /// The state with another rigid acceleration over the step that led to it.
    fn moved(&self, state: &RingState, acceleration: Rigid) -> RingState {
        let StepScheme { integrator, dt } = self.scheme;
        let by = self.rigid.answer(acceleration);
        // Velocity and acceleration are linear in the increment.
        let [in_v, in_a] = integrator.update(dt, 1.0, 0.0, 0.0);
        let sum = |factor: f64, x: &[f64]| combined([1.0, factor], x, &by);
        RingState::new(
            sum(1.0, state.displacement()),
            sum(in_v, state.velocity()),
            sum(in_a, state.acceleration()),
        )
    }

    /// The end of a step with a balance of the whole ring, found from an end without a rigid acceleration, and that
    /// acceleration.
    fn balanced(
        &self,
        [old, end]: [&RingState; 2],
        start: Rigid,
        known: &KnownLoad,
        contacts: &ContactForces<'_>,
    ) -> (RingState, Rigid) {
        let mut acceleration = start;
        for _ in 0..CORRECTIONS {
            let state = self.moved(end, acceleration);
            let lack = self
                .rigid
                .acceleration(self.imbalance([old, &state], known, contacts));
            (0..RIGID_MOTIONS).for_each(|i| acceleration[i] -= lack[i]);
        }
        (self.moved(end, acceleration), acceleration)
    }
}

impl RigidResponse {
    fn new(body: &dyn ElasticBody, scheme: StepScheme) -> Result<RigidResponse, RingError> {
        let held = body.held();
        let field = |motion: usize| {
            let axis = [0, 1, 2].map(|c| f64::from(c == motion % 3));
            let at = |x: [f64; 3]| if motion < 3 { axis } else { cross(axis, x) };
            body.state_of_coordinates(held.coordinates.reduce(&held.places.field(at)))
        };
        let vectors: Vec<Vec<f64>> = (0..RIGID_MOTIONS).map(field).collect();
        let by_others = |a: &Vec<f64>| {
            vectors
                .iter()
                .map(|b| body.form(Matrix::Mass, a, b))
                .collect::<Vec<_>>()
        };
        let mass: Vec<f64> = vectors.iter().flat_map(by_others).collect();
        let factor = DenseLu::factor(RIGID_MOTIONS, &mass).map_err(|source| RingError::RigidMass {
            side: held.name,
            source,
        })?;
        let [effective, _] = held.effective(scheme);
        Ok(RigidResponse {
            vectors,
            mass,
            factor,
            effective,
        })
    }

    /// The acceleration that takes this force and moment.
    fn acceleration(&self, force: Rigid) -> Rigid {
        let mut acceleration = force;
        self.factor.solve(&mut acceleration, 1);
        acceleration
    }

    /// Motion of the ring over a step by a load M R b, a vector of its body.
    fn answer(&self, acceleration: Rigid) -> Vec<f64> {
        let mut motion = vec![0.0; self.vectors[0].len()];
        for (vector, b) in self.vectors.iter().zip(acceleration) {
            let share = b / self.effective;
            motion
                .iter_mut()
                .zip(vector)
                .for_each(|(sum, x)| *sum += share * x);
        }
        motion
    }

    /// Size of the load M R b, N: the mass by the root of the mean square of R b over it.
    fn size(&self, b: Rigid) -> f64 {
        let row = |i: usize| &self.mass[RIGID_MOTIONS * i..][..RIGID_MOTIONS];
        let load = [0, 1, 2, 3, 4, 5].map(|i| row(i).iter().zip(b).map(|(m, b)| m * b).sum::<f64>());
        let square: f64 = load.iter().zip(b).map(|(f, b)| f * b).sum();
        (square.max(0.0) * self.mass[0]).sqrt()
    }

    /// Work of the load M R b over an increment of the body, J.
    fn work(&self, body: &dyn ElasticBody, b: Rigid, increment: &[f64]) -> f64 {
        let load = self.vectors.iter().zip(b);
        load.map(|(vector, b)| b * body.form(Matrix::Mass, vector, increment))
            .sum()
    }
}

impl ContactPorts {
    fn new(held: &HeldRing, contacts: Feet<'_>) -> ContactPorts {
        let ports = Ports::new(held, contacts);
        let direction = |load: &SparseLoad| {
            let mut sum = [0.0; 3];
            let free = held.coordinates.free();
            load.iter().for_each(|&(i, value)| sum[free[i] % 3] += value);
            sum
        };
        ContactPorts {
            directions: ports.contacts.iter().map(direction).collect(),
            ports,
        }
    }

    fn under<'a>(&'a self, held: &HeldRing, forces: PortForces<'a>) -> ContactForces<'a> {
        let mut sum = vec![0.0; held.coordinates.n()];
        self.ports
            .loads(held, forces)
            .for_each(|(i, force)| sum[i] += force);
        ContactForces {
            on: self,
            at_ports: forces.contacts,
            nodal: held.coordinates.expand(&sum),
        }
    }
}

impl ContactForces<'_> {
    /// Moment by the displacement `w` of the contacts, N m: that of their forces about where they were.
    fn moment_by(&self, w: &[f64]) -> [f64; 3] {
        let ContactPorts { ports, directions } = self.on;
        let at_ports = ports.contacts.iter().zip(directions).zip(self.at_ports);
        let all: Vec<_> = at_ports
            .map(|((load, direction), force)| [sparse_dot(load, w), *force].map(|x| direction.map(|d| x * d)))
            .collect();
        let sum = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|c| a[c] + b[c]);
        let of_contact = |of_ports: &[[[f64; 3]; 2]]| {
            let zero = [[0.0; 3]; 2];
            let [motion, force] = of_ports
                .iter()
                .fold(zero, |[u, f], [du, df]| [sum(u, *du), sum(f, *df)]);
            cross(motion, force)
        };
        let contacts = all.chunks(2 * ports.per_contact.max(1));
        contacts.map(of_contact).fold([0.0; 3], sum)
    }
}

impl StepFactor for FreeFactor {
    fn bytes(&self) -> usize {
        self.inner.bytes()
    }

    fn iterations(&self) -> Option<usize> {
        self.inner.iterations()
    }

    fn predict(&self, from: &RingState, load: KnownLoad) -> Known {
        self.inner.predict(from, load)
    }

    fn begin<'a>(
        &'a self,
        from: &'a RingState,
        known: Arc<Known>,
        contacts: Feet<'_>,
    ) -> Box<dyn ElasticStep + 'a> {
        let inner = self.inner.begin(from, known.clone(), contacts);
        Box::new(FreeStep {
            factor: self,
            answer: inner.answer().clone(),
            inner,
            old: from,
            known,
            contacts: ContactPorts::new(self.body.held(), contacts),
            acceleration: [0.0; RIGID_MOTIONS],
            rounds: 0,
        })
    }
}

impl FreeStep<'_> {
    /// Takes what the ports see of the ring, with its rigid acceleration.
    fn renew_answer(&mut self) {
        self.answer.clone_from(self.inner.answer());
        if self.acceleration == [0.0; RIGID_MOTIONS] {
            return;
        }
        let motion = self.factor.rigid.answer(self.acceleration);
        add_part(&mut self.answer.predicted, &self.inner.at_contacts(&motion));
    }
}

impl ElasticStep for FreeStep<'_> {
    fn answer(&self) -> &PortAnswer {
        &self.answer
    }

    fn laps(&self) -> &Laps {
        self.inner.laps()
    }

    fn move_contacts(&mut self, contacts: Feet<'_>) -> Laps {
        let laps = self.inner.move_contacts(contacts);
        self.contacts = ContactPorts::new(self.factor.body.held(), contacts);
        self.renew_answer();
        laps
    }

    fn at_contacts(&self, x: &[f64]) -> Vec<f64> {
        self.inner.at_contacts(x)
    }

    fn at_seen(&self, x: &[f64]) -> Vec<f64> {
        self.inner.at_seen(x)
    }

    fn settle(&mut self, forces: PortForces<'_>, scale: f64) -> Settling {
        let settled = self.inner.settle(forces, scale);
        if settled == Settling::Again {
            self.renew_answer();
        }
        settled
    }

    fn end(&mut self, forces: PortForces<'_>, scale: f64, next: Option<KnownLoad>) -> End {
        let mut ended = match self.inner.end(forces, scale, None) {
            End::Done(ended) => ended,
            End::Again => {
                self.renew_answer();
                return End::Again;
            }
        };
        let FreeFactor {
            body, inner, rigid, ..
        } = self.factor;
        let contacts = self.contacts.under(body.held(), forces);
        let ends = [self.old, &ended.state];
        let (state, found) = self
            .factor
            .balanced(ends, self.acceleration, &self.known.load, &contacts);
        let change = [0, 1, 2, 3, 4, 5].map(|i| found[i] - self.acceleration[i]);
        let limit = (TOLERANCE * scale).max(SHARE * rigid.size(found));
        // What no contact presses on keeps to no contact.
        if scale > 0.0 && self.rounds < MOST_ROUNDS && rigid.size(change) > limit {
            self.rounds += 1;
            self.acceleration = found;
            self.renew_answer();
            return End::Again;
        }
        let increment = combined([1.0, -1.0], state.displacement(), self.old.displacement());
        ended.works.frame += rigid.work(&**body, found, &increment);
        ended.energies = body.energies(&state);
        ended.next = next.map(|load| inner.predict(&state, load));
        ended.state = state;
        End::Done(ended)
    }
}
