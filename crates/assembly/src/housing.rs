//! Bodies that carry several bearings at rest.
//!
//! Each bearing solves its ring on the body as if it were alone there, moved by what the others press on it:
//!
//! ```text
//! y_k = F_kk p_k + sum over others F_kj p_j,      p_k = -lam_k the forces of ring k on its seat
//! ```
//!
//! The second term is given, the shaft and all bearings are balanced, and the forces p that come out are handed on
//! until they stay as they are. Their fixed point is found with memory of the last rounds ([`crate::mixing`]): soft
//! feet, on which all seats move together, would need many rounds or never end otherwise.
//!
//! **To first order** each bearing has H ([`dynamics::moved_seat`]) over its place on the shaft and the motion d of its
//! seat by the others. With F' the part of F between different seats, and all bearings one below the other,
//!
//! ```text
//! (1 + H_dd F') p = -H_dq q,      r = H_qq q + H_qd F' p
//! ```
//!
//! is what all of them do together when the shaft moves by q at their places.

use std::sync::Arc;

use body::{SeatFunctions, SeatTie, Surrounding};
use contact::Side;
use dense::{DenseError, DenseLu};
use dynamics::moved_seat::SeatStiffness;
use dynamics::stiffness::N_SHAFT;
use dynamics::{Model, StaticSolution};

use crate::error::AssemblyError;
use crate::place::MountedBearing;

/// A body and the bearings in it.
pub struct SharedBody {
    /// Its name.
    pub name: String,
    /// The rings in it.
    side: Side,
    /// Number of the bearing of each seat.
    bearings: Vec<usize>,
    /// Joints of these, with the functions on the side of the ring.
    seats: Vec<(Arc<SeatTie>, SeatFunctions)>,
}

/// A body that carries several bearings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HousedTogether {
    /// Its name.
    pub name: String,
    /// The rings in it: outer ones of a housing, inner ones of a shaft.
    pub side: Side,
    /// Numbers of the bearings in the order of their seats.
    pub bearings: Vec<usize>,
}

/// The body of a ring that carries others as well.
fn shared(model: &Model, side: Side) -> Option<(&Arc<SeatTie>, &Arc<Surrounding>)> {
    let tie = model.tied(side)?.tie.as_ref()?;
    let body = tie.body.as_ref().filter(|_| tie.has_others())?;
    Some((tie, body))
}

/// The bodies that carry several bearings: shafts, then housings.
pub fn housed_together(bearings: &[MountedBearing]) -> Vec<HousedTogether> {
    let mut groups: Vec<HousedTogether> = Vec::new();
    for side in Side::BOTH {
        for (i, bearing) in bearings.iter().enumerate() {
            let Some((_, body)) = shared(&bearing.model, side) else {
                continue;
            };
            let is_of = |group: &&mut HousedTogether| {
                let other = shared(&bearings[group.bearings[0]].model, side);
                group.side == side && other.is_some_and(|(_, other)| Arc::ptr_eq(other, body))
            };
            match groups.iter_mut().find(is_of) {
                Some(group) => group.bearings.push(i),
                None => groups.push(HousedTogether {
                    name: body.name.clone(),
                    side,
                    bearings: vec![i],
                }),
            }
        }
    }
    groups
}

/// The bodies of an assembly that carry several of its bearings.
pub fn shared_bodies(bearings: &[MountedBearing]) -> Result<Vec<SharedBody>, AssemblyError> {
    let body = |housed: HousedTogether| -> Result<SharedBody, AssemblyError> {
        let (side, mut seats) = (housed.side, Vec::new());
        for &i in &housed.bearings {
            let MountedBearing { model, name: of, .. } = &bearings[i];
            let functions = model.tied(side).map(|ring| ring.seat_functions(side.name()));
            let functions = functions
                .transpose()
                .map_err(|source| AssemblyError::of_bearing(of)(source.into()))?;
            if let (Some((tie, _)), Some(functions)) = (shared(model, side), functions.flatten()) {
                seats.push((tie.clone(), functions));
            }
        }
        Ok(SharedBody {
            name: housed.name,
            side,
            bearings: housed.bearings,
            seats,
        })
    };
    housed_together(bearings).into_iter().map(body).collect()
}

impl SharedBody {
    /// Tells its bearings what the others press on it: `forces` over the functions of all its seats, N.
    pub fn tell(&self, forces: &[f64], bearings: &mut [MountedBearing]) {
        for (&i, (tie, _)) in self.bearings.iter().zip(&self.seats) {
            let mut others = forces.to_vec();
            others[tie.own()].fill(0.0);
            bearings[i].model.other_seats[self.side.index()] = Some(Arc::new(others));
        }
    }

    /// Forces of its bearings on it, N, over the functions of all its seats.
    pub fn forces(
        &self,
        bearings: &[MountedBearing],
        solutions: &[StaticSolution],
    ) -> Result<Vec<f64>, AssemblyError> {
        let mut forces = self.none();
        for (&i, (tie, functions)) in self.bearings.iter().zip(&self.seats) {
            let ring = self.side.index();
            let others = bearings[i].model.other_seats[ring].as_ref();
            let others = others.map(|others| others.as_slice());
            let field = solutions[i].elastic[ring].as_ref();
            let traction = field.and_then(|field| tie.traction(functions, field, others));
            let traction = traction.ok_or_else(|| AssemblyError::NoSeatForces {
                body: self.name.clone(),
                bearing: bearings[i].name.clone(),
            })?;
            let own = forces[tie.own()].iter_mut();
            own.zip(&traction.forces).for_each(|(on_body, f)| *on_body = -f);
        }
        Ok(forces)
    }

    /// The rings in it.
    pub fn side(&self) -> Side {
        self.side
    }

    /// Numbers of its bearings, in the order of its seats.
    pub fn bearings(&self) -> &[usize] {
        &self.bearings
    }

    /// Loads on all its bearings, each in its own frame, by a unit motion of each of their places on the shaft,
    /// row-major over (bearing, dof). `own` are those of the bearings alone.
    pub fn coupled(&self, own: &[SeatStiffness]) -> Result<Vec<f64>, DenseError> {
        let (all, n) = (self.none().len(), N_SHAFT * own.len());
        let mut matrix = vec![0.0; all * all];
        let mut forces = vec![0.0; all * n];
        for (number, ((tie, _), own)) in self.seats.iter().zip(own).enumerate() {
            for (k, row) in tie.own().enumerate() {
                let (by_shaft, by_seat) = own.row(N_SHAFT + k).split_at(N_SHAFT);
                self.add_motion(tie, by_seat, &mut matrix[all * row..all * (row + 1)]);
                matrix[(all + 1) * row] += 1.0;
                for (j, h) in by_shaft.iter().enumerate() {
                    forces[all * (N_SHAFT * number + j) + row] = -h;
                }
            }
        }
        DenseLu::factor(all, &matrix)?.solve(&mut forces, n);
        let mut coupled = vec![0.0; n * n];
        for (column, forces) in forces.chunks_exact(all).enumerate() {
            for (number, ((tie, _), own)) in self.seats.iter().zip(own).enumerate() {
                let mut others = forces.to_vec();
                others[tie.own()].fill(0.0);
                let moved = tie.motion_by(&others);
                for i in 0..N_SHAFT {
                    let (by_shaft, by_seat) = own.row(i).split_at(N_SHAFT);
                    let through: f64 = by_seat.iter().zip(&moved).map(|(h, d)| h * d).sum();
                    let direct = if column / N_SHAFT == number {
                        by_shaft[column % N_SHAFT]
                    } else {
                        0.0
                    };
                    coupled[n * (N_SHAFT * number + i) + column] = direct + through;
                }
            }
        }
        Ok(coupled)
    }

    /// Adds a row over the motion of a seat, times what forces on the other seats move it, to a row over forces.
    fn add_motion(&self, tie: &SeatTie, row: &[f64], to: &mut [f64]) {
        let Some(body) = &tie.body else { return };
        let own = tie.own();
        for (h, of_function) in row.iter().zip(own.clone()) {
            let flexibility = &body.flexibility[to.len() * of_function..to.len() * (of_function + 1)];
            for (j, (sum, f)) in to.iter_mut().zip(flexibility).enumerate() {
                if !own.contains(&j) {
                    *sum += h * f;
                }
            }
        }
    }

    /// No forces.
    pub fn none(&self) -> Vec<f64> {
        let body = self.seats.first().and_then(|(tie, _)| tie.body.as_ref());
        vec![0.0; body.map_or(0, |body| body.n_functions())]
    }
}
