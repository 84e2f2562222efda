//! Bodies that carry several bearings at rest.
//!
//! Each bearing solves its outer ring on the body as if it were alone there, moved by what the others press on it:
//!
//! ```text
//! y_k = F_kk p_k + sum over others F_kj p_j,      p_k = -lam_k the forces of ring k on its seat
//! ```
//!
//! The second term is given, the shaft and all bearings are balanced, and the forces p that come out are handed on
//! until they stay as they are. Their fixed point is found with memory of the last rounds ([`crate::mixing`]): soft
//! feet, on which all seats move together, would need many rounds or never end otherwise.

use std::sync::Arc;

use body::{SeatFunctions, SeatTie, Surrounding};
use dynamics::{Model, StaticSolution};

use crate::error::AssemblyError;
use crate::place::MountedBearing;

/// A body and the bearings in it.
pub struct SharedBody {
    /// Its name.
    pub name: String,
    /// Number of the bearing of each seat.
    bearings: Vec<usize>,
    /// Joints of these, with the functions on the side of the ring.
    seats: Vec<(Arc<SeatTie>, SeatFunctions)>,
}

/// The body of a bearing that carries others as well.
fn shared(model: &Model) -> Option<(&Arc<SeatTie>, &Arc<Surrounding>)> {
    let (_, ring) = model.tied()?;
    let tie = ring.tie.as_ref()?;
    let body = tie.body.as_ref().filter(|_| tie.has_others())?;
    Some((tie, body))
}

/// Name of each body that carries several bearings, and the numbers of these in the order of their seats.
pub fn housed_together(bearings: &[MountedBearing]) -> Vec<(String, Vec<usize>)> {
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, bearing) in bearings.iter().enumerate() {
        let Some((_, body)) = shared(&bearing.model) else {
            continue;
        };
        let is_of = |(_, group): &&mut (String, Vec<usize>)| {
            shared(&bearings[group[0]].model).is_some_and(|(_, other)| Arc::ptr_eq(other, body))
        };
        match groups.iter_mut().find(is_of) {
            Some((_, group)) => group.push(i),
            None => groups.push((body.name.clone(), vec![i])),
        }
    }
    groups
}

/// The bodies of an assembly that carry several of its bearings.
pub fn shared_bodies(bearings: &[MountedBearing]) -> Result<Vec<SharedBody>, AssemblyError> {
    let body = |(name, group): (String, Vec<usize>)| -> Result<SharedBody, AssemblyError> {
        let mut seats = Vec::new();
        for &i in &group {
            let MountedBearing { model, name: of, .. } = &bearings[i];
            let functions = model.tied().map(|(side, ring)| ring.seat_functions(side.name()));
            let functions = functions
                .transpose()
                .map_err(|source| AssemblyError::of_bearing(of)(source.into()))?;
            if let (Some((tie, _)), Some(functions)) = (shared(model), functions.flatten()) {
                seats.push((tie.clone(), functions));
            }
        }
        Ok(SharedBody {
            name,
            bearings: group,
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
            bearings[i].model.other_seats = Some(Arc::new(others));
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
            let others = bearings[i].model.other_seats.as_ref().map(|o| o.as_slice());
            let tied = bearings[i].model.tied();
            let field = tied.and_then(|(side, _)| solutions[i].elastic[side.index()].as_ref());
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

    /// No forces.
    pub fn none(&self) -> Vec<f64> {
        let body = self.seats.first().and_then(|(tie, _)| tie.body.as_ref());
        vec![0.0; body.map_or(0, |body| body.n_functions())]
    }
}
