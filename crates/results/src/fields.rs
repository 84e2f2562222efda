//! Fields of one step for ParaView: rings with displacement and stress, balls as points with their forces.

use std::collections::BTreeMap;

use body::Surrounding;
use checkpoint::{Body, CellFields, PointFields, StateArray, StepRecord};
use contact::{BearingGeometry, Side};
use dynamics::balls::BallResult;
use dynamics::motion::{BodyState, MotionState};
use dynamics::{Model, StaticSolution};
use fem::stress::von_mises;
use mesh::Mesh;
use scene::{KeptFields, RingFrame, Scene};

use super::on_ball::force_on_ball;
use super::ring_stress::{Basis, Gathered, RingStress, ShownRing, StressFields};
use super::seat::{SeatState, tied};
use super::shown::{RingField, Shown, Turn};
use crate::failure::Failure;

/// Value of the cell array `body` on a body round the outer ring.
const BODY_ID: u8 = 3;

/// The bodies of a result, in the order of its points: flexible rings, whose meshes must be whole, the balls, then a
/// body round the outer ring.
pub fn bodies(model: &Model) -> Vec<Body> {
    let mut bodies = Vec::new();
    for side in Side::BOTH {
        if let Some(ring) = model.ring(side) {
            let shift = [0.0, 0.0, model.ring_shift(side)];
            let name = format!("{} ring", side.name());
            bodies.push(Body::from_mesh(&name, side as u8, &ring.mesh, shift));
        }
    }
    let body = body_of(model);
    let centre = model.geometry.ball_centre();
    let centres: Vec<[f64; 3]> = (0..model.geometry.n_balls)
        .map(|ball| {
            let (sin, cos) = model.geometry.azimuth(ball).sin_cos();
            [centre[0] * cos, centre[0] * sin, centre[1]]
        })
        .collect();
    bodies.push(Body::balls(
        "balls",
        2,
        &centres,
        0.5 * model.geometry.ball_diameter,
    ));
    if let Some((body, mesh, shift)) = body {
        bodies.push(Body::from_mesh(&body.name, BODY_ID, mesh, shift));
    }
    bodies
}

/// The body round the outer ring, its mesh, and where that stands in the bearing, m. A body that carries several
/// bearings is shown with the first of them.
pub fn body_of(model: &Model) -> Option<(&Surrounding, &Mesh, [f64; 3])> {
    let (side, _, tie) = tied(model).filter(|(_, _, tie)| tie.seat == 0)?;
    let body = tie.body.as_ref()?;
    let shift = [0.0, 0.0, body.shift + model.ring_shift(side)];
    Some((body, &body.mesh.as_ref()?.0, shift))
}

/// The record of one equilibrium, with the stress that ranks have `gathered`; its step also stands for its time where
/// there is none.
pub fn record(
    shown: &Shown<'_>,
    solution: &StaticSolution,
    (stress, gathered): (&RingStress, Gathered),
    (step, time): (u64, f64),
    (scene, kept): (&Scene, KeptFields),
) -> Result<StepRecord, Failure> {
    let (points, cells) = Places::new(shown, gathered, scene, kept)?.fields(stress);
    Ok(StepRecord {
        step,
        time,
        points,
        cells,
        scene: scene.text.clone(),
        state: state(solution),
        tables: None,
    })
}

/// A step file with forces on balls alone.
const NOTHING: KeptFields = KeptFields {
    stress: false,
    displacement: false,
};

/// All points at one instant, but for the stress.
pub struct Places {
    /// Displacement of every point, m; empty where it is not kept.
    displacement: Vec<[f64; 3]>,
    /// What the stress of the flexible rings follows from.
    rings: [Option<ShownRing>; 2],
    /// Forces on the balls, N.
    forces: [Vec<[f64; 3]>; 2],
    /// Displacement of a body round the outer ring, m, flat.
    body: Option<Vec<f64>>,
}

impl Places {
    /// Places of rings and balls, rings as they stand in space or in their own frames, and the stress that ranks
    /// have `gathered`; without the fields that are not kept.
    pub fn new(
        shown: &Shown<'_>,
        mut gathered: Gathered,
        scene: &Scene,
        kept: KeptFields,
    ) -> Result<Places, Failure> {
        let (mut displacement, mut rings, mut n_points) = (Vec::new(), [None, None], 0);
        for side in Side::BOTH {
            n_points += shown.model().ring(side).map_or(0, |ring| ring.mesh.n_nodes());
            if kept == NOTHING {
                continue;
            }
            let Some(mut ring) = shown.ring(side) else {
                continue;
            };
            if let Some(places) = gathered.places[side.index()].take() {
                ring.places = places;
            }
            if scene.output.rings[side.index()] == RingFrame::OwnFrame {
                ring.turn = Turn::new(0.0);
            }
            if kept.displacement {
                displacement.extend(ring.shown_displacements());
            }
            if kept.stress {
                let stress = gathered.stress[side.index()].take();
                rings[side.index()] = Some(shown_ring(shown, side, ring, stress, scene)?);
            }
        }
        let (of_balls, mut forces) = balls(shown.model(), shown.placed(), &shown.balls(), n_points);
        let of_body = body_of(shown.model()).map_or(0, |(_, mesh, _)| mesh.n_nodes());
        for list in &mut forces {
            list.resize(list.len() + of_body, [0.0; 3]);
        }
        let body = if kept == NOTHING {
            None
        } else {
            body_displacement(shown)?
        };
        if kept.displacement {
            displacement.extend(of_balls);
            displacement.extend(body.iter().flat_map(|body| body.as_chunks::<3>().0));
        }
        Ok(Places {
            displacement,
            rings,
            forces,
            body: body.filter(|_| kept.stress),
        })
    }

    /// Fields of all points and cells, with the stress that is asked for.
    pub fn fields(self, stress: &RingStress) -> (PointFields, CellFields) {
        let stress = stress.fields(&self.rings, self.body.as_deref());
        let [force_inner, force_outer] = self.forces;
        let (points, cells) = with_stress(self.displacement, stress);
        let points = PointFields {
            force_inner: Some(force_inner),
            force_outer: Some(force_outer),
            ..points
        };
        (points, cells)
    }
}

/// Displacement of the body round the outer ring, m, `[n_nodes][3]` flat; None where none is shown.
pub fn body_displacement(shown: &Shown<'_>) -> Result<Option<Vec<f64>>, Failure> {
    if body_of(shown.model()).is_none() {
        return Ok(None);
    }
    match shown {
        Shown::Equilibrium { model, solution, .. } => {
            Ok(SeatState::new(model, solution)?.map(|seat| seat.body_displacement()))
        }
        Shown::Motion { model, state, .. } => Ok(moved_body(model, state)),
    }
}

/// The same of a motion, from the oscillators of its state.
fn moved_body(model: &Model, state: &MotionState) -> Option<Vec<f64>> {
    let (side, _, tie) = tied(model)?;
    let BodyState([at, ..]) = state.rings[side.index()].as_ref()?.body()?;
    Some(tie.body.as_ref()?.moved(&tie.modes.as_ref()?.of_body, at))
}

/// What the stress of a ring follows from: its displacement, or the stress that ranks have gathered.
pub fn shown_ring(
    shown: &Shown<'_>,
    side: Side,
    ring: RingField<'_>,
    gathered: Option<Vec<[f64; 6]>>,
    scene: &Scene,
) -> Result<ShownRing, Failure> {
    let patches = match scene.stress.near_field_reach {
        Some(_) => shown.patches(side).map_err(Failure::solving)?,
        None => Vec::new(),
    };
    Ok(ShownRing {
        own_stress: ring.own_stress.clone(),
        basis: match gathered {
            Some(stress) => Basis::Stress(stress),
            None => Basis::Displacement(ring.strained.into_owned()),
        },
        turn: ring.turn,
        patches,
    })
}

/// Displacement and stress of all points and cells.
pub fn with_stress(displacement: Vec<[f64; 3]>, stress: StressFields) -> (PointFields, CellFields) {
    let nodal = stress.nodal;
    let points = PointFields {
        displacement,
        von_mises: nodal
            .as_ref()
            .map(|stress| stress.iter().map(|&s| von_mises(s)).collect()),
        stress: nodal,
        ..PointFields::default()
    };
    (points, stress.cells)
}

/// Displacements of the balls, m, and the forces on them from the inner and the outer ring, N, at all points of rings
/// and balls, zero on rings, which have `n_points`. `placed` is the bearing of the mesh file.
fn balls(
    model: &Model,
    placed: &BearingGeometry,
    balls: &[BallResult],
    n_points: usize,
) -> (Vec<[f64; 3]>, [Vec<[f64; 3]>; 2]) {
    let mut displacement = Vec::new();
    let mut forces = [vec![[0.0; 3]; n_points], vec![[0.0; 3]; n_points]];
    let (centre, from) = (model.geometry.ball_centre(), placed.ball_centre());
    for (i, ball) in balls.iter().enumerate() {
        let (sin, cos) = ball.azimuth_rad.sin_cos();
        let (sin_0, cos_0) = placed.azimuth(i).sin_cos();
        let radius = centre[0] + ball.displacement_m.radial;
        let moved = [
            radius * cos - from[0] * cos_0,
            radius * sin - from[0] * sin_0,
            centre[1] - from[1] + ball.displacement_m.axial,
        ];
        displacement.push(moved);
        for (side, list) in Side::BOTH.into_iter().zip(&mut forces) {
            list.push(force_on_ball(side, ball));
        }
    }
    (displacement, forces)
}

fn state(solution: &StaticSolution) -> BTreeMap<String, StateArray> {
    let displacements = &solution.displacements;
    BTreeMap::from([
        (
            "shaft".to_string(),
            StateArray::Real(displacements.shaft.to_vec()),
        ),
        (
            "balls".to_string(),
            StateArray::Real(displacements.balls.concat()),
        ),
    ])
}
