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
//! **To first order** each bearing has H ([`dynamics::moved_seat`]) over its place on the shaft, and its balls where
//! these are kept, q, and the motions d of its seats by the others. With F' the part of F of all bodies between
//! different seats, and all bearings one below the other,
//!
//! ```text
//! (1 + H_dd F') p = -H_dq q,      r = H_qq q + H_qd F' p
//! ```
//!
//! is what all of them do together when they are moved by q. A bearing may be in two such bodies, a housing and a
//! shaft.

use std::ops::Range;
use std::sync::Arc;

use body::{SeatFunctions, SeatTie, Surrounding};
use contact::Side;
use dense::{DenseError, DenseLu};
use dynamics::moved_seat::SeatStiffness;
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

/// Bearings in bodies, and where each is among all rows and functions.
struct Coupled<'c> {
    own: &'c [Option<SeatStiffness>],
    /// The seats of each bearing.
    seats: Vec<Vec<CoupledSeat<'c>>>,
    /// First of the rows that are kept, by bearing, and their number.
    starts: Vec<usize>,
    /// Functions of all bodies.
    n_functions: usize,
}

/// A seat of a bearing.
struct CoupledSeat<'c> {
    body: &'c SharedBody,
    tie: &'c SeatTie,
    /// Numbers of all functions of its body.
    of_body: Range<usize>,
    /// Numbers of its own functions among those of its bearing.
    of_bearing: Range<usize>,
}

/// Loads on all that is kept of bearings in bodies, each in its own frame, by unit motions of it, row-major. `own` are
/// those of the bearings alone; None of a bearing in no shared body, which has no rows.
pub fn coupled(bodies: &[SharedBody], own: &[Option<SeatStiffness>]) -> Result<Vec<f64>, DenseError> {
    let all = Coupled::new(bodies, own);
    let n = *all.starts.last().expect("there is an end");
    let columns = all.forces(n)?;
    let mut coupled = vec![0.0; n * n];
    for (column, forces) in columns.chunks_exact(all.n_functions).enumerate() {
        all.add_loads(column, forces, &mut coupled);
    }
    Ok(coupled)
}

impl<'c> Coupled<'c> {
    fn new(bodies: &'c [SharedBody], own: &'c [Option<SeatStiffness>]) -> Coupled<'c> {
        let mut all = Coupled {
            own,
            seats: own.iter().map(|_| Vec::new()).collect(),
            starts: vec![0],
            n_functions: 0,
        };
        for own in own {
            let n = own.as_ref().map_or(0, |own| own.n_kept);
            all.starts.push(all.starts[all.starts.len() - 1] + n);
        }
        for body in bodies {
            let of_body = all.n_functions..all.n_functions + body.none().len();
            for (&bearing, (tie, _)) in body.bearings.iter().zip(&body.seats) {
                let functions = own[bearing].as_ref().map(|own| &own.functions[body.side.index()]);
                let Some(of_bearing) = functions.cloned().flatten() else {
                    continue;
                };
                all.seats[bearing].push(CoupledSeat {
                    body,
                    tie,
                    of_body: of_body.clone(),
                    of_bearing,
                });
            }
            all.n_functions = of_body.end;
        }
        all
    }

    /// Forces on the functions of all bodies by unit motions of all `n` rows that are kept, column-major.
    fn forces(&self, n: usize) -> Result<Vec<f64>, DenseError> {
        let all = self.n_functions;
        let mut matrix = vec![0.0; all * all];
        let mut forces = vec![0.0; all * n];
        for (bearing, seats) in self.seats.iter().enumerate() {
            let Some(own) = &self.own[bearing] else { continue };
            for seat in seats {
                for (k, function) in seat.tie.own().enumerate() {
                    let row = seat.of_body.start + function;
                    let (by_kept, by_seats) = own.function_row(seat.of_bearing.start + k);
                    for other in seats {
                        let to = &mut matrix[all * row..][other.of_body.clone()];
                        let by_seat = &by_seats[other.of_bearing.clone()];
                        other.body.add_motion(other.tie, by_seat, to);
                    }
                    matrix[(all + 1) * row] += 1.0;
                    for (j, h) in by_kept.iter().enumerate() {
                        forces[all * (self.starts[bearing] + j) + row] = -h;
                    }
                }
            }
        }
        DenseLu::factor(all, &matrix)?.solve(&mut forces, n);
        Ok(forces)
    }

    /// Adds the loads by one of the motions, under which forces act on the bodies.
    fn add_loads(&self, column: usize, forces: &[f64], coupled: &mut [f64]) {
        let n = self.starts[self.own.len()];
        for (bearing, seats) in self.seats.iter().enumerate() {
            let Some(own) = &self.own[bearing] else { continue };
            let moved: Vec<Vec<f64>> = seats.iter().map(|seat| seat.moved_by(forces)).collect();
            let start = self.starts[bearing];
            for i in 0..own.n_kept {
                let (by_kept, by_seats) = own.kept_row(i);
                let through = seats.iter().zip(&moved).flat_map(|(seat, moved)| {
                    let by_seat = by_seats[seat.of_bearing.clone()].iter();
                    by_seat.zip(moved).map(|(h, d)| h * d)
                });
                let through: f64 = through.sum();
                let direct = column.checked_sub(start).and_then(|j| by_kept.get(j));
                coupled[n * (start + i) + column] = direct.copied().unwrap_or(0.0) + through;
            }
        }
    }
}

impl CoupledSeat<'_> {
    /// Its motion by forces on the other seats of its body.
    fn moved_by(&self, forces: &[f64]) -> Vec<f64> {
        let mut others = forces[self.of_body.clone()].to_vec();
        others[self.tie.own()].fill(0.0);
        self.tie.motion_by(&others)
    }
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
            let model = &bearings[i].model;
            let acting = model.acting(self.side, solutions[i].body_load(model, self.side));
            let field = solutions[i].elastic[ring].as_ref();
            let traction = field.and_then(|field| tie.traction(functions, field, acting));
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

    /// The number of the bearing and the joint of each seat.
    pub fn seats(&self) -> impl Iterator<Item = (usize, &SeatTie)> {
        let seats = self.bearings.iter().zip(&self.seats);
        seats.map(|(bearing, (tie, _))| (*bearing, tie.as_ref()))
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
