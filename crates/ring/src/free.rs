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

use dense::DenseLu;
use timer::Laps;

use crate::body::{ElasticBody, HeldRing, frame_inertia};
use crate::coordinates::RIGID_MOTIONS;
use crate::error::RingError;
use crate::integrator::StepScheme;
use crate::matrices::Matrix;
use crate::sparse::{SparseLoad, sparse_dot};
use crate::state::RingState;
use crate::step::{ElasticStep, End, Feet, Known, KnownLoad, PortAnswer, PortForces, Settling, StepFactor};
use crate::vectors::{combined, dot};

/// One number of each rigid motion: x, y, z, tilts, rotation about z.
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
    /// Loads of unit forces.
    loads: Vec<SparseLoad>,
    /// Directions of these forces.
    directions: Vec<[f64; 3]>,
    /// Ports of a contact.
    of_one: usize,
}

/// Forces of the contacts.
struct ContactForces<'a> {
    ports: &'a ContactPorts,
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
        let moved = at(s.alpha_f, old.displacement(), new.displacement());
        let w = body.nodal(&moved);
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
        let along = |place: [f64; 3], force: &[f64]| {
            unit_motions().map(|unit| dot(&held.coordinates.whole_rigid_motion(place, unit), force))
        };
        let lack = held.places.sum(|node, x| {
            let dofs = 3 * node..3 * node + 3;
            let place = [0, 1, 2].map(|c| x[c] + w[3 * node + c]);
            let (of_net, of_contacts) = (along(place, &net[dofs.clone()]), along(x, &contacts.nodal[dofs]));
            [0, 1, 2, 3, 4, 5].map(|i| of_net[i] - of_contacts[i])
        });
        let more = contacts.moment(&held.coordinates.reduce(&w));
        [
            lack[0],
            lack[1],
            lack[2],
            lack[3] - more[0],
            lack[4] - more[1],
            lack[5] - more[2],
        ]
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
        let field = |unit: Rigid| {
            let nodal = held
                .places
                .field(|x| held.coordinates.whole_rigid_motion(x, unit));
            body.state_of_coordinates(held.coordinates.reduce(&nodal))
        };
        let vectors: Vec<Vec<f64>> = unit_motions().map(field).into();
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
        let coordinates = &held.coordinates;
        let loads = coordinates.of_contacts(contacts.weights);
        let direction = |load: &SparseLoad| {
            let mut sum = [0.0; 3];
            load.iter()
                .for_each(|&(i, value)| sum[coordinates.free()[i] % 3] += value);
            sum
        };
        ContactPorts {
            directions: loads.iter().map(direction).collect(),
            loads,
            of_one: 2 * contacts.per_contact,
        }
    }

    fn under<'a>(&'a self, held: &HeldRing, at_ports: &'a [f64]) -> ContactForces<'a> {
        let mut sum = vec![0.0; held.coordinates.n()];
        for (load, force) in self.loads.iter().zip(at_ports) {
            load.iter().for_each(|&(i, value)| sum[i] += value * force);
        }
        ContactForces {
            ports: self,
            at_ports,
            nodal: held.coordinates.expand(&sum),
        }
    }
}

impl ContactForces<'_> {
    /// Moment about the undeformed places of the contacts, which have moved by the displacement `w`, N m.
    fn moment(&self, w: &[f64]) -> [f64; 3] {
        let ports = self.ports;
        let numbers: Vec<usize> = (0..self.at_ports.len()).collect();
        let of_contact = |ports_of: &[usize]| {
            let (mut motion, mut force) = ([0.0; 3], [0.0; 3]);
            for &port in ports_of {
                let moved = sparse_dot(&ports.loads[port], w);
                for (c, direction) in ports.directions[port].into_iter().enumerate() {
                    motion[c] += moved * direction;
                    force[c] += self.at_ports[port] * direction;
                }
            }
            let [[a, b, c], [x, y, z]] = [motion, force];
            [b * z - c * y, c * x - a * z, a * y - b * x]
        };
        let moments = numbers.chunks(ports.of_one.max(1)).map(of_contact);
        moments.fold([0.0; 3], |sum, moment| [0, 1, 2].map(|c| sum[c] + moment[c]))
    }
}

/// The rigid motions by one of each.
fn unit_motions() -> [Rigid; RIGID_MOTIONS] {
    [0, 1, 2, 3, 4, 5].map(|i| [0, 1, 2, 3, 4, 5].map(|k| f64::from(i == k)))
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
        let ports = self
            .answer
            .predicted
            .iter_mut()
            .zip(self.inner.at_contacts(&motion));
        ports.for_each(|(predicted, more)| *predicted += more);
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
        let contacts = self.contacts.under(body.held(), forces.contacts);
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
