//! Sizes of what `[output.reduction]` holds in memory, in restart states and in its file, bytes, by the arrays of
//! [`crate::reduction`].

use contact::Side;
use dynamics::{Model, RACEWAY_GROUP};
use scene::{CycleDamage, DamageNodes, Scene};

use crate::bodies::bodies_of;

/// Least, largest and sum of seven stresses, of every point.
const EXTREMES: usize = 3 * 7 * 8;
/// Six stresses and the one that is counted, of every point while a step is taken into account.
const STRESS: usize = (6 + 1) * 8;
/// Open turning points of a node: 3.4 measured over 10 steps of a motion, 5 over 100. They grow slowly.
const OPEN_POINTS: usize = 5;
/// Number of a node, its list of open points with what the allocator takes for it, damage and cycles.
const HISTORY: usize = 8 + 24 + 16 + 8 * OPEN_POINTS + 2 * 8;
/// Number of open points, these, damage and cycles of a node in a state.
const STORED_HISTORY: usize = 8 + 8 * OPEN_POINTS + 2 * 8;
/// Numbers of a point in the file: four of each of seven stresses.
const FILE_NUMBERS: usize = 4 * 7;
/// The same of damage and cycles.
const DAMAGE_NUMBERS: usize = 2;

/// What `[output.reduction]` of a scene counts.
pub struct ReductionSizes {
    /// Points of all bodies.
    n_points: usize,
    /// Nodes whose cycles are counted, if any may be.
    n_counted: Option<usize>,
}

impl ReductionSizes {
    /// Those of a scene; None where it asks for nothing.
    pub fn new(scene: &Scene, model: &Model) -> Option<ReductionSizes> {
        let asked = scene.output.reduction?;
        Some(ReductionSizes {
            n_points: n_points(model),
            n_counted: asked.damage.map(|damage| counted_nodes(model, damage).len()),
        })
    }

    /// In a restart state.
    pub fn state(&self) -> usize {
        EXTREMES * self.n_points + STORED_HISTORY * self.n_counted.unwrap_or(0)
    }

    /// Numbers of its file.
    pub fn file_numbers(&self) -> usize {
        let of_damage = self.n_counted.map_or(0, |_| DAMAGE_NUMBERS);
        (FILE_NUMBERS + of_damage) * self.n_points
    }

    /// In memory: what is known, and a step that is taken into account.
    pub fn known(&self) -> usize {
        (EXTREMES + STRESS) * self.n_points + HISTORY * self.n_counted.unwrap_or(0)
    }
}

/// Points of all bodies, as in step files.
pub fn n_points(model: &Model) -> usize {
    let of_rings: usize = model.rings.iter().flatten().map(|ring| ring.mesh.n_nodes()).sum();
    let of_bodies: usize = bodies_of(model).iter().map(|body| body.mesh.n_nodes()).sum();
    of_rings + model.geometry.n_balls + of_bodies
}

/// Nodes whose cycles are counted, by their numbers among those of both rings, growing.
pub fn counted_nodes(model: &Model, damage: CycleDamage) -> Vec<usize> {
    let (mut n_nodes, mut counted) = (0, Vec::new());
    for side in Side::BOTH {
        let Some(ring) = model.ring(side) else { continue };
        match damage.nodes {
            DamageNodes::All => counted.extend(n_nodes..n_nodes + ring.mesh.n_nodes()),
            DamageNodes::Raceways => {
                let nodes = ring.mesh.group_nodes(RACEWAY_GROUP);
                counted.extend(nodes.into_iter().map(|node| n_nodes + node));
            }
        }
        n_nodes += ring.mesh.n_nodes();
    }
    counted
}
