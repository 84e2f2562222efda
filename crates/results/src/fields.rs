//! Fields of one step for ParaView: rings with displacement and stress, balls as points with their forces.

use std::collections::BTreeMap;

use checkpoint::{Body, CellFields, PointFields, StateArray, StepRecord};
use contact::{BearingGeometry, Meridian, Side};
use dynamics::balls::BallResult;
use dynamics::{Model, StaticSolution};
use fem::stress::von_mises;
use scene::{KeptFields, RingFrame, Scene};

use super::bodies::{BodyField, bodies_of, body_fields};
use super::on_ball::force_on_ball;
use super::ring_stress::{Gathered, RingStress, ShownRing, StressBasis, StressFields};
use super::shown::{RingField, Shown, Turn};
use crate::failure::Failure;

/// Values of the cell array `body` on the bodies in which the rings sit, inner ring first.
const BODY_IDS: [u8; 2] = [4, 3];

/// The bodies of a result, in the order of its points: flexible rings, whose meshes must be whole, the balls, then the
/// bodies in which the rings sit.
pub fn bodies(model: &Model) -> Vec<Body> {
    let mut bodies = Vec::new();
    for side in Side::BOTH {
        if let Some(ring) = model.ring(side) {
            let shift = [0.0, 0.0, model.ring_shift(side)];
            let name = format!("{} ring", side.name());
            bodies.push(Body::from_mesh(&name, side as u8, &ring.mesh, shift));
        }
    }
    let centre = model.geometry.ball_centre();
    let centres: Vec<[f64; 3]> = (0..model.geometry.n_balls)
        .map(|ball| {
            let (sin, cos) = model.geometry.azimuth(ball).sin_cos();
            [centre.radial * cos, centre.radial * sin, centre.axial]
        })
        .collect();
    bodies.push(Body::balls(
        "balls",
        2,
        &centres,
        0.5 * model.geometry.ball_diameter,
    ));
    let of_rings = bodies_of(model).into_iter();
    bodies.extend(of_rings.map(|b| Body::from_mesh(&b.body.name, BODY_IDS[b.side.index()], b.mesh, b.shift)));
    bodies
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
    /// The bodies in which the rings sit; none where no stress is kept.
    bodies: Vec<BodyField>,
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
        let shown_bodies = bodies_of(shown.model());
        let of_body: usize = shown_bodies.iter().map(|body| body.mesh.n_nodes()).sum();
        for list in &mut forces {
            list.resize(list.len() + of_body, [0.0; 3]);
        }
        let mut bodies = match kept == NOTHING {
            true => Vec::new(),
            false => body_fields(shown)?,
        };
        for (body, field) in shown_bodies.iter().zip(&mut bodies) {
            if scene.output.rings[body.side.index()] == RingFrame::OwnFrame {
                field.turn = Turn::new(0.0);
            }
        }
        if kept.displacement {
            displacement.extend(of_balls);
            let moved = shown_bodies.iter().zip(&bodies);
            displacement.extend(moved.flat_map(|(body, field)| field.shown(body.mesh)));
        }
        if !kept.stress {
            bodies.clear();
        }
        Ok(Places {
            displacement,
            rings,
            forces,
            bodies,
        })
    }

    /// Fields of all points and cells, with the stress that is asked for.
    pub fn fields(self, stress: &RingStress) -> (PointFields, CellFields) {
        let stress = stress.fields(&self.rings, &self.bodies);
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
            Some(stress) => StressBasis::Stress(stress),
            None => StressBasis::Displacement(ring.strained.into_owned()),
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
        let radius = centre.radial + ball.displacement_m.radial;
        let moved = [
            radius * cos - from.radial * cos_0,
            radius * sin - from.radial * sin_0,
            centre.axial - from.axial + ball.displacement_m.axial,
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
            StateArray::Real(Meridian::flat(&displacements.balls)),
        ),
    ])
}
