//! Forecasts of the memory of lists of bearings: what bearings share counts once.
//!
//! Bearings of one type share meshes, and types are made one after the other. Rings that are alike share what they are
//! made of and their factors, also where they sit in seats of their own, which have their own meshes. What each bearing
//! has for itself is counted by its nodes, measured (`tests/memory_of_lists.rs`): fields, states and vectors, lists of
//! stress and output, steps that wait to be written. Two bearings in one housing of the example: -9 to -2 % at rest,
//! +17 % in motion.

use std::sync::Arc;

use comm::Communicator;
use dynamics::modes::{COLUMNS_PER_BALL, basis_sizes};
use dynamics::{Model, MotionMemory, RingMemory, RingModel, forecast_motion_peak, forecast_peak};
use scene::{Analysis, Modes, Scene};

use crate::failure::Failure;
use crate::memory::{
    Bound, MOST_PER_NODE, bound, bytes_of_points, queued_steps, reduction_memory, require, rings_at_once,
    rings_of, searched_bytes, tied_bytes, with_bodies, with_reduction, written_bytes,
};

/// Files and tables of a bearing after the first, bytes, measured on rigid rings.
const BEARING_BYTES: usize = 2_400_000;

/// What a bearing of a known type has for itself at rest, bytes per node of its rings, measured.
const AT_REST_BYTES: usize = 263;

/// The same in motion of a ring like an earlier one, beside the steps that wait to be written.
const IN_MOTION_BYTES: usize = 520;

/// A bearing of a list, with the memory of its rings as if it were alone.
#[derive(Clone, Copy)]
pub struct BearingMemory<'m> {
    /// Its scene.
    pub scene: &'m Scene,
    /// The bearing.
    pub model: &'m Model,
    /// Its rings at rest; None of a rigid ring.
    pub rest: [Option<RingMemory>; 2],
    /// In motion: Some(None) of a rigid ring, None when its steps are not forecast.
    pub motion: [Option<Option<MotionMemory>>; 2],
}

impl BearingMemory<'_> {
    /// Whether it has the very rings of another.
    fn is_of_type(&self, other: &BearingMemory<'_>) -> bool {
        let same = |(a, b): (&Option<Arc<RingModel>>, &Option<Arc<RingModel>>)| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.model.rings.iter().zip(&other.model.rings).all(same)
    }

    /// How its ring of a side stands to those of earlier bearings; None of a rigid ring.
    fn share(&self, earlier: &[BearingMemory<'_>], side: usize) -> Option<RingSharing> {
        let ring = self.model.rings[side].as_ref()?;
        let mut known = earlier
            .iter()
            .filter_map(|known| known.model.rings[side].as_ref());
        Some(match known.clone().any(|known| Arc::ptr_eq(known, ring)) {
            true => RingSharing::All,
            false if known.any(|known| known.is_like(ring)) => RingSharing::Factor,
            false => RingSharing::Nothing,
        })
    }
}

/// What a ring shares with that of an earlier bearing.
#[derive(Clone, Copy, PartialEq)]
enum RingSharing {
    /// It is the first of its kind.
    Nothing,
    /// The factor; it is alike, with a mesh of its own.
    Factor,
    /// The ring is the same.
    All,
}

/// Forecast of the largest resident memory of a list, bytes: until there is an equilibrium, and in steps of a motion.
pub fn forecast_list(analysis: &Analysis, bearings: &[BearingMemory<'_>]) -> (usize, Option<usize>) {
    let (program, at_once) = (forecast_peak([None, None], 1), rings_at_once());
    let (mut lasting, mut making) = (0, 0);
    for (i, bearing) in bearings.iter().enumerate() {
        let (mut made, mut made_lasting) = ([None; 2], 0);
        for side in 0..2 {
            let (Some(ring), Some(memory)) = (&bearing.model.rings[side], bearing.rest[side]) else {
                continue;
            };
            let own = AT_REST_BYTES * ring.mesh.n_nodes();
            match bearing.share(&bearings[..i], side) {
                None => {}
                Some(RingSharing::All) => lasting += own,
                Some(RingSharing::Factor) => lasting += memory.mesh + own,
                Some(RingSharing::Nothing) => {
                    made[side] = Some(memory);
                    made_lasting += memory.mesh + memory.results + memory.kept;
                }
            }
        }
        making = making.max(forecast_peak(made, at_once).saturating_sub(program + made_lasting));
        lasting += made_lasting;
    }
    let rest = program + lasting + making + points_of(analysis, bearings);
    let files = BEARING_BYTES * bearings.len().saturating_sub(1);
    let with_all = |peak: usize| with_bodies(peak, models_of(bearings)) + files;
    let reductions: usize = bearings
        .iter()
        .map(|bearing| reduction_memory(bearing.scene, bearing.model))
        .sum();
    let steps = steps_of(analysis, bearings).map(with_all);
    with_reduction((with_all(rest), steps), analysis, reductions)
}

/// What load cases and instants hold beside the rings, of which several are solved at the same time, bytes.
fn points_of(analysis: &Analysis, bearings: &[BearingMemory<'_>]) -> usize {
    let n_points = match analysis {
        Analysis::Sweep(sweep) => sweep.points.len() as u64,
        Analysis::QuasiStatic(settings) => 1 + settings.n_steps,
        _ => return 0,
    };
    let listed = bearings.iter().map(|bearing| (bearing.rest, bearing.model));
    let written = bearings
        .iter()
        .map(|bearing| written_bytes(bearing.scene, bearing.model, n_points));
    bytes_of_points(listed, n_points) + written.sum::<usize>()
}

/// Forecast of the steps of a motion without bodies, bytes; None where there is none.
fn steps_of(analysis: &Analysis, bearings: &[BearingMemory<'_>]) -> Option<usize> {
    let Analysis::Dynamic(dynamic) = analysis else {
        return None;
    };
    let (queued, program) = (queued_steps(dynamic), forecast_peak([None, None], 1));
    let (mut kept, mut making) = (0, 0);
    for (i, bearing) in bearings.iter().enumerate() {
        let mut own = [None; 2];
        for side in 0..2 {
            let Some(memory) = bearing.motion[side]? else {
                continue;
            };
            let ring = bearing.model.rings[side].as_ref()?;
            own[side] = Some(match bearing.share(&bearings[..i], side) {
                Some(RingSharing::All | RingSharing::Factor) => {
                    let beside = IN_MOTION_BYTES * ring.mesh.n_nodes();
                    MotionMemory {
                        making: beside,
                        kept: beside,
                        ..memory
                    }
                }
                Some(RingSharing::Nothing) | None => memory,
            });
        }
        let held: usize = own
            .iter()
            .flatten()
            .map(|ring| ring.kept + queued * ring.queued)
            .sum();
        let peak = forecast_motion_peak(own, queued, rings_at_once()) - program;
        making = making.max(kept + peak);
        kept += held;
    }
    Some(program + kept.max(making))
}

/// Forecast of the largest resident memory of the natural modes of a list, bytes: each ring has factor, stiffness and
/// mass of its own, and the search keeps vectors over all of them. Good to a tenth: 1338 MB for 1213 MB, two bearings
/// in a housing with rings of 51 000 dofs each, 20 modes.
pub fn forecast_modes_of_list(wanted: &Modes, bearings: &[BearingMemory<'_>]) -> usize {
    let models = bearings.iter().map(|bearing| bearing.model);
    let mut sum = forecast_peak([None, None], 1) + vectors_of_list(wanted, models);
    let mut meshes: Vec<&Arc<RingModel>> = Vec::new();
    for bearing in bearings {
        for (ring, memory) in bearing.model.rings.iter().zip(&bearing.rest) {
            let (Some(ring), Some(memory)) = (ring, memory) else {
                continue;
            };
            sum += searched_bytes(*memory);
            // Bearings of one type share their mesh.
            if !meshes.iter().any(|other| Arc::ptr_eq(other, ring)) {
                meshes.push(ring);
                sum += memory.mesh;
            }
        }
    }
    sum += bearings
        .iter()
        .map(|bearing| tied_bytes(bearing.model))
        .sum::<usize>();
    with_bodies(sum, models_of(bearings))
}

fn models_of<'m>(bearings: &[BearingMemory<'m>]) -> impl Iterator<Item = &'m Model> {
    bearings.iter().map(|bearing| bearing.model)
}

/// Vectors of the search for modes of a list, its restart included, and those of contacts and their patches, bytes.
fn vectors_of_list<'m>(wanted: &Modes, models: impl Iterator<Item = &'m Model>) -> usize {
    let (mut n_balls, mut n_dofs, mut of_contacts) = (0, 0, 0);
    for model in models {
        let rings = model.rings.iter().flatten();
        let own = rings.map(|ring| ring.mesh.n_dofs()).sum::<usize>();
        n_balls += model.geometry.n_balls;
        n_dofs += own;
        of_contacts += COLUMNS_PER_BALL * model.geometry.n_balls * own;
    }
    let [_, n_vectors] = basis_sizes(wanted.number, n_balls);
    size_of::<f64>() * (2 * n_vectors * n_dofs + of_contacts)
}

/// Fails if a list, of which nothing is factored yet, needs more memory than there is for it by its forecast, as
/// [`crate::memory::require_memory`] does for one bearing.
pub fn require_memory_of_list(analysis: &Analysis, listed: &[(&Scene, &Model)]) -> Result<(), Failure> {
    let models: Vec<&Model> = listed.iter().map(|(_, model)| *model).collect();
    let rings = models.iter().flat_map(|model| model.rings.iter().flatten());
    let n_nodes: usize = rings.map(|ring| ring.mesh.n_nodes()).sum();
    let vectors = match analysis {
        Analysis::Modes(wanted) => vectors_of_list(wanted, models.iter().copied()),
        _ => 0,
    };
    let most = MOST_PER_NODE * n_nodes as u64 + vectors as u64;
    let short = bound().filter(|bound: &Bound| bound.bytes < most);
    let is_known = matches!(analysis, Analysis::Modes(_)) || Communicator::world().size() == 1;
    let Some(bound) = short.filter(|_| is_known) else {
        return Ok(());
    };
    let mut bearings: Vec<BearingMemory<'_>> = Vec::new();
    for &(scene, model) in listed {
        let none = BearingMemory {
            scene,
            model,
            rest: [None; 2],
            motion: [None; 2],
        };
        let known = bearings.iter().find(|known| known.is_of_type(&none)).copied();
        bearings.push(match known {
            Some(known) => BearingMemory {
                scene,
                model,
                ..known
            },
            None => {
                let (rest, motion) = rings_of(model)?;
                BearingMemory { rest, motion, ..none }
            }
        });
    }
    let peak = match analysis {
        Analysis::Modes(wanted) => forecast_modes_of_list(wanted, &bearings),
        _ => {
            let (start, steps) = forecast_list(analysis, &bearings);
            steps.unwrap_or(0).max(start)
        }
    };
    require(peak, bound)
}
