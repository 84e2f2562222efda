//! The bodies in which rings sit, as results show them.

use std::collections::BTreeMap;
use std::sync::Arc;

use assembly::MountedBearing;
use body::Surrounding;
use contact::Side;
use dynamics::motion::{BodyState, Motion, MotionState};
use dynamics::{Model, StaticSolution};
use fem::Material;
use mesh::Mesh;

use super::seat::{SeatState, tied};
use super::shown::{Shown, Turn};
use crate::failure::Failure;

/// A body in which a ring sits, as results show it.
pub struct ShownBody<'m> {
    /// The ring.
    pub side: Side,
    /// The body.
    pub body: &'m Surrounding,
    /// Its mesh.
    pub mesh: &'m Mesh,
    /// What it is made of.
    pub material: &'m Material,
    /// Where the mesh stands in the bearing, m.
    pub shift: [f64; 3],
}

/// The bodies in which the rings sit and that have a mesh, that of the outer ring first. One that carries several
/// bearings is shown with the first of them.
pub fn bodies_of(model: &Model) -> Vec<ShownBody<'_>> {
    let of = |side: Side| {
        let (_, tie) = tied(model, side).filter(|(_, tie)| tie.seat == 0)?;
        let body = tie.body.as_ref()?;
        let (mesh, material) = body.mesh.as_ref()?;
        Some(ShownBody {
            side,
            body,
            mesh,
            material,
            shift: [0.0, 0.0, body.shift + model.ring_shift(side)],
        })
    };
    Side::BOTH.into_iter().rev().filter_map(of).collect()
}

/// Bodies in which rings of a bearing sit and that the files of another one show: their names, and the folder of that
/// one beside the folder of this.
pub type BodiesElsewhere = BTreeMap<String, String>;

/// The bodies of a bearing, by its number in a list, that the files of another one show.
pub fn bodies_elsewhere(bearings: &[MountedBearing], number: usize) -> BodiesElsewhere {
    let of = |side: Side| {
        let (_, tie) = tied(&bearings[number].model, side).filter(|(_, tie)| tie.seat != 0)?;
        let body = tie.body.as_ref().filter(|body| body.mesh.is_some())?;
        let shows = |other: &&MountedBearing| {
            tied(&other.model, side).is_some_and(|(_, other)| {
                other.seat == 0 && other.body.as_ref().is_some_and(|b| Arc::ptr_eq(b, body))
            })
        };
        let first = bearings.iter().find(shows)?;
        Some((body.name.clone(), format!("../{}", first.name)))
    };
    Side::BOTH.into_iter().filter_map(of).collect()
}

/// Says where bodies of the results of a bearing are.
pub fn where_bodies_are(elsewhere: &BodiesElsewhere) -> Vec<String> {
    let line = |(name, folder): (&String, &String)| {
        format!(
            "{name:?} is in the files of {folder}; raceway export of the folder above, --to vtu, has all bearings with \
             their bodies"
        )
    };
    elsewhere.iter().map(line).collect()
}

/// Displacement of such a body at one instant.
pub struct BodyField {
    /// In its own frame, m, `[n_nodes][3]` flat.
    pub displacement: Vec<f64>,
    /// From that frame to space.
    pub turn: Turn,
}

impl BodyField {
    /// Of a body that does not turn.
    pub fn standing(displacement: Vec<f64>) -> BodyField {
        BodyField {
            displacement,
            turn: Turn::new(0.0),
        }
    }

    /// Displacements in space from the places in the mesh, turning included, m.
    pub fn shown(&self, mesh: &Mesh) -> Vec<[f64; 3]> {
        let moved = mesh.nodes.iter().zip(self.displacement.as_chunks::<3>().0);
        moved
            .map(|(place, u)| self.turn.displacement(*place, *u))
            .collect()
    }
}

/// Displacements of the bodies that are shown, in their order.
pub fn body_fields(shown: &Shown<'_>) -> Result<Vec<BodyField>, Failure> {
    let mut fields = Vec::new();
    for body in bodies_of(shown.model()) {
        let found = match shown {
            Shown::Equilibrium { model, solution, .. } => body_at_rest(shown, (model, solution), body.side)?,
            Shown::Motion { motion, state, .. } => moved_body(motion, state, body.side),
        };
        // Of a body whose state was not kept there is nothing to show.
        let displacement = found.unwrap_or_else(|| vec![0.0; body.mesh.n_dofs()]);
        fields.push(BodyField {
            displacement,
            turn: shown.turn(body.side),
        });
    }
    Ok(fields)
}

/// Displacement of a body at an equilibrium, m, `[n_nodes][3]` flat, with the motion of the shaft that carries it.
fn body_at_rest(
    shown: &Shown<'_>,
    (model, solution): (&Model, &StaticSolution),
    side: Side,
) -> Result<Option<Vec<f64>>, Failure> {
    let Some(seat) = SeatState::new(model, solution, side)? else {
        return Ok(None);
    };
    let mut displacement = seat.body_displacement();
    if let (Some(q), Some((_, tie))) = (shown.shaft_in_frame(side), tied(model, side)) {
        tie.add_shaft_motion(q, &mut displacement);
    }
    Ok(Some(displacement))
}

/// The same of a motion, from the oscillators of its state.
fn moved_body(motion: &Motion<'_>, state: &MotionState, side: Side) -> Option<Vec<f64>> {
    let (_, tie) = tied(motion.model(), side)?;
    let BodyState([at, ..]) = state.rings[side.index()].as_ref()?.body()?;
    tie.moved(at, motion.body_load(state, side))
}
