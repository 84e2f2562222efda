//! A ring tied to a body: what the ring's solver needs to know, and what the joint carries.

use std::ops::Range;
use std::sync::Arc;

use dense::DenseCholesky;

use crate::carried::{Carried, CarriedInertia, N_SHAFT, dot};
use crate::loads::{BesideRing, BodyLoad, ModalLoads, N_LOADS};
use crate::oscillators::{BodyModes, SeatModes, ShaftAtSeat};
use crate::seat::{SeatBasis, SeatFunctions, SeatSpace};
use crate::surrounding::Surrounding;

/// The joint of a ring with what is round it.
#[derive(Clone)]
pub struct SeatTie {
    /// Functions that are tied.
    pub space: SeatSpace,
    /// F of the body at these functions, m/N, `[n][n]` flat; zero for a rigid body.
    pub flexibility: Vec<f64>,
    /// The body; None for a rigid one.
    pub body: Option<Arc<Surrounding>>,
    /// Number of the seat among those of the body.
    pub seat: usize,
    /// What moves of it; None where it is at rest only.
    pub modes: Option<SeatModes>,
}

/// What a joint carries at rest.
#[derive(Clone, Debug)]
pub struct SeatTraction {
    /// Forces on the ring, by function, N.
    pub forces: Vec<f64>,
    /// Motion of the seat, by function, m.
    pub motion: Vec<f64>,
}

/// How much the last functions matter: shares of the energy that the joint puts into the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TieConvergence {
    /// Of the last two orders n.
    pub last_orders: f64,
    /// Of the last degree across.
    pub last_degree: f64,
}

impl SeatTie {
    /// A joint with a seat of a body.
    pub fn to_seat(body: Arc<Surrounding>, seat: usize) -> SeatTie {
        let (own, all) = (body.functions_of(seat), body.n_functions());
        let row = |i: usize| &body.flexibility[all * i + own.start..all * i + own.end];
        SeatTie {
            space: body.seats[seat].space,
            flexibility: own.clone().flat_map(row).copied().collect(),
            body: Some(body),
            seat,
            modes: None,
        }
    }

    /// The same for a motion, with the modes of the body.
    pub fn in_motion(mut self, modes: Arc<BodyModes>) -> SeatTie {
        let place = self.carried().map(|carried| carried.places[self.seat]);
        let on_shaft = modes.on_shaft.as_ref().zip(place);
        self.modes = Some(SeatModes {
            on_shaft: on_shaft.map(|(shares, place)| ShaftAtSeat::new(shares, &place)),
            of_body: modes,
            own: self.own(),
        });
        self
    }

    /// Numbers of its functions among those of all seats of the body.
    pub fn own(&self) -> Range<usize> {
        match &self.body {
            Some(body) => body.functions_of(self.seat),
            None => 0..self.space.basis.n_functions(),
        }
    }

    /// How a shaft carries the body; None of one that stands.
    pub fn carried(&self) -> Option<&Carried> {
        self.body.as_ref()?.carried.as_ref()
    }

    /// Inertia of a body on a shaft; None of one that stands, and at other seats than the first.
    pub fn carried_inertia(&self) -> Option<CarriedInertia> {
        let carried = self.carried().filter(|_| self.seat == 0)?;
        Some(carried.places[0].seen(carried.inertia))
    }

    /// Adds the motion of the body with its shaft, as the bearing of the seat sees it, to a displacement, m.
    pub fn add_shaft_motion(&self, q: [f64; N_SHAFT], field: &mut [f64]) {
        if let (Some(body), Some(carried)) = (&self.body, self.carried()) {
            body.add_shaft_motion(carried.places[self.seat].here(q), field);
        }
    }

    /// Motion of the seat with the shaft that carries the body, as its own bearing sees it, m; None of one that stands.
    pub fn shaft_motion(&self, q: [f64; N_SHAFT]) -> Option<Vec<f64>> {
        let carried = self.carried()?;
        let here = carried.places[self.seat].here(q);
        Some(carried.seat_motion(here)[self.own()].to_vec())
    }

    /// Whether the body has other seats.
    pub fn has_others(&self) -> bool {
        self.body.as_ref().is_some_and(|body| body.seats.len() > 1)
    }

    /// Motion of the seat, m, by forces on the functions of all seats of the body, N.
    pub fn motion_by(&self, forces: &[f64]) -> Vec<f64> {
        let Some(body) = &self.body else {
            return vec![0.0; self.space.basis.n_functions()];
        };
        let row = |i: usize| &body.flexibility[forces.len() * i..forces.len() * (i + 1)];
        self.own()
            .map(|i| row(i).iter().zip(forces).map(|(f, p)| f * p).sum())
            .collect()
    }

    /// Motion of the seat, m, by what acts on the body besides its ring; None: nothing does.
    pub fn moved_by(&self, acting: BesideRing<'_>) -> Option<Vec<f64>> {
        let by_others = acting.others.map(|others| self.motion_by(others));
        let Some(by_load) = self.moved_by_load(acting.load) else {
            return by_others;
        };
        let mut moved = by_others.unwrap_or_else(|| vec![0.0; by_load.len()]);
        moved.iter_mut().zip(by_load).for_each(|(d, s)| *d += s);
        Some(moved)
    }

    /// Motion of the seat by a load on all of the body, m; None: the body takes none.
    fn moved_by_load(&self, load: Option<BodyLoad>) -> Option<Vec<f64>> {
        let body = self.body.as_ref()?;
        let factors = body.factors(self.seat, load)?;
        let all = body.loads.as_ref()?.seat_motion(factors);
        Some(all[self.own()].to_vec())
    }

    /// Work of a load on all of the body at rest over its displacement, J: that by the forces of this joint, and at the
    /// first seat that by the load itself. Summed over the seats of a body it is all.
    pub fn load_work(&self, traction: &SeatTraction, load: Option<BodyLoad>) -> f64 {
        let (Some(body), Some(moved)) = (&self.body, self.moved_by_load(load)) else {
            return 0.0;
        };
        let by_joint = -dot(&traction.forces, &moved);
        let factors = body.factors(self.seat, load).filter(|_| self.seat == 0);
        let own = factors.zip(body.loads.as_ref());
        by_joint + own.map_or(0.0, |(factors, loads)| loads.own_work(&body.free, factors))
    }

    /// Strain energy that the joint and a load on all of the body put into it, J; summed over its seats it is all.
    pub fn energy(&self, traction: &SeatTraction, load: Option<BodyLoad>) -> f64 {
        traction.energy() + 0.5 * self.load_work(traction, load)
    }

    /// Displacement of the body at rest, m, `[n_nodes][3]` flat, of one on a shaft beside that of the shaft; None for a
    /// rigid body.
    pub fn displacement(&self, traction: &SeatTraction, acting: BesideRing<'_>) -> Option<Vec<f64>> {
        let body = self.body.as_ref()?;
        let mut field = body.displacement(&self.forces_on_body(traction, acting.others));
        if let (Some(factors), Some(loads)) = (body.factors(self.seat, acting.load), &body.loads) {
            let by_load = loads.displacement(factors);
            field.iter_mut().zip(by_load).for_each(|(u, v)| *u += v);
        }
        Some(field)
    }

    /// Displacement of the body in motion, m, `[n_nodes][3]` flat, of its oscillators and what these leave out of that
    /// by a load on all of it; None for a rigid body.
    pub fn moved(&self, oscillators: &[f64], load: Option<BodyLoad>) -> Option<Vec<f64>> {
        let (body, modes) = (self.body.as_ref()?, &self.modes.as_ref()?.of_body);
        let mut field = body.moved(modes, oscillators);
        if let (Some(factors), Some(loads)) = (body.factors(self.seat, load), &modes.loads) {
            let beyond = loads.beyond(factors);
            field.iter_mut().zip(beyond).for_each(|(u, v)| *u += v);
        }
        Some(field)
    }

    /// Loads on the oscillators of a load on all of the body; empty: none.
    pub fn on_oscillators(&self, load: Option<BodyLoad>) -> Vec<f64> {
        self.of_load(load, ModalLoads::on_oscillators)
    }

    /// Where the oscillators stand under a load on all of the body; empty: there is none.
    pub fn at_rest_under(&self, load: Option<BodyLoad>) -> Vec<f64> {
        self.of_load(load, ModalLoads::at_rest)
    }

    fn of_load(
        &self,
        load: Option<BodyLoad>,
        see: impl Fn(&ModalLoads, [f64; N_LOADS]) -> Vec<f64>,
    ) -> Vec<f64> {
        let loads = self.modes.as_ref().and_then(|modes| modes.of_body.loads.as_ref());
        let factors = self.body.as_ref().and_then(|body| body.factors(self.seat, load));
        match (loads, factors) {
            (Some(loads), Some(factors)) => see(loads, factors),
            _ => Vec::new(),
        }
    }

    /// A joint with a rigid body.
    pub fn to_rigid(space: SeatSpace) -> SeatTie {
        let n = space.basis.n_functions();
        SeatTie {
            space,
            flexibility: vec![0.0; n * n],
            body: None,
            seat: 0,
            modes: Some(SeatModes::rigid()),
        }
    }

    /// What the joint carries when the ring stands as displaced, m, `[n_nodes][3]` flat, and something else acts on the
    /// body; None for a rigid body.
    ///
    /// The body follows from its own flexibility: lam = -F^-1 (g - d), d the motion of the seat by what else acts.
    pub fn traction(
        &self,
        ring: &SeatFunctions,
        displacement: &[f64],
        acting: BesideRing<'_>,
    ) -> Option<SeatTraction> {
        self.body.as_ref()?;
        let motion = ring.measure(displacement);
        let factor = DenseCholesky::factor(motion.len(), &self.flexibility).ok()?;
        let mut forces: Vec<f64> = motion.iter().map(|g| -g).collect();
        if let Some(moved) = self.moved_by(acting) {
            forces.iter_mut().zip(moved).for_each(|(f, d)| *f += d);
        }
        factor.solve(&mut forces, 1);
        Some(SeatTraction { forces, motion })
    }

    /// Forces on all seats of the body, N: those of the joint and of the `others`.
    pub fn forces_on_body(&self, traction: &SeatTraction, others: Option<&[f64]>) -> Vec<f64> {
        let all = || self.body.as_ref().map_or(0, |body| body.n_functions());
        let mut forces = others.map_or_else(|| vec![0.0; all()], <[f64]>::to_vec);
        let own = forces[self.own()].iter_mut();
        own.zip(&traction.forces).for_each(|(on_body, f)| *on_body -= f);
        forces
    }
}

impl SeatTraction {
    /// Strain energy that the forces of the joint put into the body, J.
    pub fn energy(&self) -> f64 {
        -0.5 * self.products().sum::<f64>()
    }

    fn products(&self) -> impl Iterator<Item = f64> + '_ {
        self.forces.iter().zip(&self.motion).map(|(f, g)| f * g)
    }

    /// Shares of the last functions in the energy; None of a seat that moves as a rigid one.
    pub fn convergence(&self, basis: SeatBasis) -> Option<TieConvergence> {
        let [harmonics, across] = basis.largest()?;
        let share = |is_last: &dyn Fn([usize; 2]) -> bool| {
            let mut sum = 0.0;
            for (function, product) in self.products().enumerate() {
                if basis.order_and_degree(function).is_some_and(is_last) {
                    sum += product;
                }
            }
            match 2.0 * self.energy() {
                0.0 => 0.0,
                total => (sum / total).abs(),
            }
        };
        Some(TieConvergence {
            last_orders: share(&|[n, _]| n + 2 > harmonics),
            last_degree: share(&|[_, j]| j == across),
        })
    }
}
