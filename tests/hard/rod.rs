//! An elastic bar on a rigid wall, by the code of a ring: `ring::elastic_body` of a mesh that happens to be a straight
//! bar, its predictor and compliance (`ring::ElasticStep`), the discrete gradient of the contact and the bearing's
//! system with its Newton (`BearingParts`).
//!
//! The bar lies along z, one element thick, Poisson's ratio 0: its waves are those of a rod. Its end face is the
//! "groove centre" of one contact; the "ball" is the wall (1e9 masses of the bar) or a free body. Closed form: the
//! end stops at impact, a wave c = sqrt(E/rho) runs to the far end and back, force A rho c V meanwhile, and the bar
//! parts after 2 L/c with -V. References: Doyen, Ern, Piperno, SIAM J. Sci. Comput. 33 (2011) 223,
//! doi:10.1137/090777542 (L = 10 m, E = 900 Pa, rho = 1 kg/m3, 5 m from the wall, 10 m/s); ANSYS Verification Manual,
//! VM85 (a rod in inches and pounds).

use std::collections::BTreeMap;
use std::sync::Arc;

use contact::{ContactLaw, Groove, NodalWeights, Side};
use dense::DenseCholesky;
use dynamics::bearing::{BearingParts, ContactList};
use dynamics::bodies::{FlatBody, Inertia, Name};
use dynamics::interactions::discrete_gradient::ContactScheme;
use dynamics::interactions::raceway_contact::{Means, Site};
use dynamics::motion::Integrator;
use dynamics::system::{ElasticPorts, Interval};
use dynamics::{Backend, Hold, RingModel};
use fem::Material;
use mesh::{ElementKind, Facet, Mesh};
use ring::{
    BodySettings, End, Feet, Frame, KnownLoad, Partner, PortForces, RingState, StepScheme, elastic_body,
};
use timer::SharedLaps;

/// Dimensions and numbers of a bar and its flight.
#[derive(Clone, Copy)]
pub struct Rod {
    pub length: f64,
    pub side: f64,
    pub modulus: f64,
    pub density: f64,
    pub gap: f64,
    pub speed: f64,
    pub gravity: f64,
    /// Approach at the force A rho c V over the length.
    pub softness: f64,
    /// Mass of what it meets over its own.
    pub wall: f64,
}

pub const DOYEN: Rod = Rod {
    length: 10.0,
    side: 1.0,
    modulus: 900.0,
    density: 1.0,
    gap: 5.0,
    speed: 10.0,
    gravity: 0.0,
    softness: 1e-4,
    wall: 1e9,
};

pub const ELEMENTS: usize = 100;

/// What happened to a rod.
#[derive(Default)]
pub struct Flight {
    /// First touch and last contact, s.
    pub touch: f64,
    pub part: f64,
    /// Impulse of all contacts, N s.
    pub impulse: f64,
    /// Energy in bar, contact and wall less the work of gravity, over the first: smallest and largest.
    pub energy: [f64; 2],
    /// Largest ledger defect: energy that neither work nor the integrator's own balance explains, over the first.
    pub defect: f64,
    /// Velocity of the centre of mass at the end, and of the wall, m/s.
    pub end: [f64; 2],
    /// Times of all touches, s.
    pub touches: Vec<f64>,
    pub force: Vec<[f64; 2]>,
    pub total: Vec<[f64; 2]>,
}

impl Rod {
    pub fn area(&self) -> f64 {
        self.side * self.side
    }

    pub fn mass(&self) -> f64 {
        self.density * self.area() * self.length
    }

    pub fn wave(&self) -> f64 {
        (self.modulus / self.density).sqrt()
    }

    /// A rho c V.
    pub fn force(&self, speed: f64) -> f64 {
        self.area() * self.density * self.wave() * speed
    }

    pub fn model(&self) -> RingModel {
        RingModel {
            mesh: bar_mesh(self.length, self.side),
            material: Material::new(self.modulus, 0.0, self.density).unwrap(),
            hold: Hold::Free,
            held_group: "seat",
            groove: Groove {
                side: Side::Outer,
                centre_radius: 2.0 * self.side,
                groove_radius: self.side,
                centre_z: 0.0,
            },
            tie: None,
            sectors: Default::default(),
        }
    }

    pub fn fly(&self, integrator: Integrator, scheme: ContactScheme, dt: f64, n: usize) -> Flight {
        let settings = BodySettings {
            partner: Partner::AT_REST,
            damping: [0.0; 2],
            backend: Backend::Sparse,
            frame: Frame::Still,
        };
        let body = elastic_body("outer", &self.model(), settings).unwrap();
        let factor = body.clone().step_factor(StepScheme { integrator, dt }).unwrap();
        let coordinates = body.n();
        let along = |value: f64| -> Vec<f64> {
            (0..coordinates)
                .map(|i| if i % 3 == 2 { value } else { 0.0 })
                .collect()
        };
        let mut state = RingState::new(vec![0.0; coordinates], along(-self.speed), along(-self.gravity));
        let weight = body
            .matrices()
            .mass_product(&body.held().coordinates, &along(-self.gravity));
        let foot = NodalWeights {
            nodes: vec![0, 1, 2, 3],
            coefficients: vec![[[0.25, 0.0, 0.0], [0.0, 0.0, 0.25]]; 4],
        };
        let scale = self.force(self.speed.max((2.0 * self.gravity * self.gap).sqrt()));
        let law = ContactLaw {
            stiffness: scale / (self.softness * self.length).powf(1.5),
            patch_compliance: 0.0,
            ball_compliance: 0.0,
        };
        let touching = 10.0 * self.length;
        let mass = self.wall * self.mass();
        let mut wall = [[0.0; 3]; 2];
        let mut flight = Flight::default();
        let costs = SharedLaps::default();
        let (mut work, mut loss, mut first) = (0.0, 0.0, None);
        let site = Site {
            ball: 0,
            side: Side::Outer,
            azimuth: 0.0,
            ring_azimuth: 0.0,
            reach: [0.0, touching - self.gap].into(),
            touching,
            lever: 0.0,
            is_projected: true,
            law,
            across: Default::default(),
            unevenness: None,
            strips: None,
            passing: 0.0,
            ends: None,
        };
        // The other contact of the ball is out of reach.
        let far = Site {
            side: Side::Inner,
            touching: 1e6,
            lever: 1.0,
            ..site.clone()
        };
        for step in 0..n {
            let load = KnownLoad {
                load: Some(weight.clone()),
                ..KnownLoad::default()
            };
            let known = Arc::new(factor.predict(&state, load));
            let feet = Feet {
                weights: std::slice::from_ref(&foot),
                per_contact: 1,
                seen: &[],
            };
            let mut moving = factor.begin(&state, known, feet);
            let answer = moving.answer().clone();
            let inverse = DenseCholesky::factor(2, &answer.compliance).unwrap().inverse();
            let inertia = wall.map(|start| Inertia {
                mass,
                start,
                ..Inertia::default()
            });
            let bar = ElasticPorts {
                name: "outer",
                start: answer.start,
                offset: answer.predicted,
                stiffness: inverse,
                n_moving: 2,
                ..ElasticPorts::default()
            };
            let contacts = ContactList {
                sites: vec![far.clone(), site.clone()],
                dead: Vec::new(),
                means: Some(Means {
                    dt,
                    scheme,
                    weight: integrator.alpha_f,
                    damping: None,
                }),
            };
            let parts = BearingParts::new(
                Interval::Step(StepScheme { integrator, dt }),
                FlatBody::new(Name::Shaft, [Inertia::default(); 5], [Some(0.0); 5]),
                vec![FlatBody::new(Name::Ball(0), inertia, [None; 2])],
                [None, Some(bar)],
                contacts,
                None,
            );
            let solution = parts.solve_step(scale, &costs).unwrap();
            let contact = solution.forces[1];
            let forces = PortForces {
                contacts: &contact.force,
                mount: &[],
            };
            let End::Done(ended) = moving.end(forces, scale, None) else {
                panic!("no frame turns");
            };
            drop(moving);
            let next = ended.state;
            work += ended.works.load;
            loss += body.numerical_loss(integrator, &state, &next) + contact.numerical_loss;
            for (i, place) in wall.iter_mut().enumerate() {
                let (inertia, x) = (inertia[i], solution.balls[0].to_array()[i]);
                loss += inertia.numerical_loss(integrator, x, dt);
                let [v, a] = inertia.update(integrator, x, dt);
                *place = [x, v, a];
            }
            state = next;
            let [_, end] = solution.reach(1);
            let stored = law.evaluate(end.norm() - touching).energy;
            let energy =
                body.energies(&state).iter().sum::<f64>() + stored + 0.5 * mass * wall[1][1] * wall[1][1];
            let before = *first.get_or_insert(0.5 * self.mass() * self.speed * self.speed);
            let scale = before.max(self.mass() * self.gravity * self.gap);
            flight.note(
                step,
                dt,
                contact.force[1].abs(),
                (energy - work) / scale,
                (energy - work + loss - before) / scale,
            );
        }
        let momentum = body.momentum(&state)[0][2];
        flight.end = [momentum / self.mass(), wall[1][1]];
        flight
    }
}

impl Flight {
    pub fn note(&mut self, step: usize, dt: f64, force: f64, energy: f64, defect: f64) {
        let t = dt * (step as f64 + 0.5);
        let last = self.force.last().map_or(0.0, |f| f[1]);
        if force > 0.0 && last == 0.0 {
            self.touches.push(t);
            if self.touches.len() == 1 {
                self.touch = t;
            }
        }
        if force > 0.0 {
            self.part = t;
        }
        self.impulse += dt * force;
        if step == 0 {
            self.energy = [energy; 2];
        }
        self.energy = [self.energy[0].min(energy), self.energy[1].max(energy)];
        self.defect = self.defect.max(defect.abs());
        self.force.push([t, force]);
        self.total.push([t, energy]);
    }
}

/// One column of cubes along z from 0; facet group `raceway` at z = 0, `seat` at the other end.
fn bar_mesh(length: f64, side: f64) -> Mesh {
    let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    let layer = |i: usize| {
        let z = length * i as f64 / ELEMENTS as f64;
        corners.map(|c| [c[0], c[1], z])
    };
    let group = |element, face| vec![Facet { element, face }];
    Mesh {
        kind: ElementKind::Hex8,
        nodes: (0..=ELEMENTS).flat_map(layer).collect(),
        connectivity: (0..ELEMENTS).flat_map(|e| 4 * e..4 * e + 8).collect(),
        groups: BTreeMap::from([
            ("raceway".to_string(), group(0, 0)),
            ("seat".to_string(), group(ELEMENTS - 1, 1)),
        ]),
    }
}
