//! Extremes, means and damage of the stress of a run, found while it goes on, without step files.
//!
//! At every node of the flexible rings, and of a body round the outer ring: least, largest and mean value of the six
//! stress components and of von Mises stress over the steps that count, in the ring's own frame. A node is a point of
//! the material, so that on a ring that turns it meets one contact after the other. At the chosen nodes of rings:
//! rain-flow cycles of one stress ([`crate::rainflow`]) and their damage by an S-N line. The stress is that of nodes
//! (`ring_stress`), with the near field if the scene's stress has one.
//!
//! Nodes are independent of each other, so that bits do not depend on threads. All that is known is part of the restart
//! state. Memory: 168 B a node, and of each node whose cycles are counted 24 B and its open turning points.

mod extremes;
mod histories;

use std::collections::BTreeMap;
use std::sync::Arc;

use anyhow::{anyhow, ensure};
use checkpoint::{PointTable, StateArray, TableField};
use comm::print;
use contact::Side;
use dynamics::Model;
use fem::stress::von_mises;
use rayon::prelude::*;
use scene::{DamageStress, KeptFields, Scene, StressOutput};
use timer::Laps;

use self::extremes::Extremes;
use self::histories::NodeHistories;
use super::about::STRESS;
use super::bodies::body_fields;
use super::fields::shown_ring;
use super::reduction_sizes::{counted_nodes, n_points};
use super::ring_stress::{Gathered, RingStress};
use super::shown::{Shown, Turn};
use super::state_arrays::Arrays;
use crate::failure::Failure;

/// Name of the file in the result folder.
pub const REDUCTION_FILE: &str = "reduction.vtkhdf";
/// Text in it on what was counted.
pub const REDUCTION: &str = "reduction";
/// Beginning of the names of its arrays in a restart state.
const PREFIX: &str = "reduction_";
const STEPS: &str = "reduction_steps";
const SETTINGS: &str = "reduction_settings";
/// What ranks gather for it.
const STRESS_ALONE: KeptFields = KeptFields {
    stress: true,
    displacement: false,
};
/// Share by which the time of a step, its number times its length, may fall short of the same time as it is typed.
const ROUND_OFF: f64 = 1e-12;
/// Nodes that a thread takes at least.
const NODES_AT_ONCE: usize = 512;

/// What is known of the steps so far.
#[derive(Clone)]
pub struct StressReduction {
    asked: scene::OutputReduction,
    stress: Arc<RingStress>,
    /// Steps that have counted: how many, the first, the last.
    steps: [u64; 3],
    /// By point of all bodies, as in step files; balls have no stress.
    extremes: Vec<Extremes>,
    /// Cycles, if damage is asked for.
    histories: Option<NodeHistories>,
    has_near_field: bool,
}

/// The stress of which a run finds extremes, on every rank.
pub struct ReducedStress {
    asked: scene::OutputReduction,
    stress: Arc<RingStress>,
}

impl ReducedStress {
    /// What the scene asks for, if it does; `stress` is that of step files. Collective.
    pub fn new(
        scene: &Scene,
        model: &Model,
        stress: &Arc<RingStress>,
    ) -> Result<Option<ReducedStress>, Failure> {
        let Some(asked) = scene.output.reduction else {
            return Ok(None);
        };
        let stress = match scene.output.stress {
            StressOutput::Nodal => stress.clone(),
            _ => Arc::new(RingStress::of_kind(StressOutput::Nodal, model, scene)?),
        };
        Ok(Some(ReducedStress { asked, stress }))
    }

    /// Whether a step counts.
    pub fn counts(&self, step: u64, time: f64) -> bool {
        step.is_multiple_of(self.asked.every) && time >= self.asked.from * (1.0 - ROUND_OFF)
    }

    /// The stress of rings that ranks share, on rank 0, and laps. Collective.
    pub fn gather(&self, shown: &Shown<'_>) -> (Gathered, Laps) {
        self.stress.gather(shown, STRESS_ALONE)
    }
}

impl StressReduction {
    /// Nothing yet.
    pub fn new(scene: &Scene, model: &Model, reduced: &ReducedStress) -> StressReduction {
        let asked = reduced.asked;
        StressReduction {
            asked,
            stress: reduced.stress.clone(),
            steps: [0; 3],
            extremes: vec![Extremes::NONE; n_points(model)],
            histories: asked
                .damage
                .map(|damage| NodeHistories::new(damage, counted_nodes(model, damage))),
            has_near_field: scene.stress.near_field_reach.is_some(),
        }
    }

    /// Takes a step into account, with the stress that ranks have `gathered`.
    pub fn add(
        &mut self,
        step: u64,
        shown: &Shown<'_>,
        mut gathered: Gathered,
        scene: &Scene,
    ) -> Result<(), Failure> {
        let mut rings = [None, None];
        for side in Side::BOTH {
            let Some(mut ring) = shown.ring(side) else {
                continue;
            };
            ring.turn = Turn::new(0.0);
            let stress = gathered.stress[side.index()].take();
            rings[side.index()] = Some(shown_ring(shown, side, ring, stress, scene)?);
        }
        let mut bodies = body_fields(shown)?;
        bodies.iter_mut().for_each(|body| body.turn = Turn::new(0.0));
        let stress = self.stress.fields(&rings, &bodies).nodal;
        let stress = stress.expect("a run of flexible rings has stress at nodes");
        let kind = self.asked.damage.map(|damage| damage.stress);
        let counted: Vec<f64> = self
            .extremes
            .par_iter_mut()
            .zip(&stress)
            .with_min_len(NODES_AT_ONCE)
            .map(|(extremes, &stress)| {
                let equivalent = von_mises(stress);
                extremes.add(stress, equivalent);
                match kind {
                    Some(DamageStress::SignedVonMises) if stress[0] + stress[1] + stress[2] < 0.0 => {
                        -equivalent
                    }
                    _ => equivalent,
                }
            })
            .collect();
        if let Some(histories) = &mut self.histories {
            histories.add(&counted);
        }
        let first = if self.steps[0] == 0 { step } else { self.steps[1] };
        self.steps = [self.steps[0] + 1, first, step];
        Ok(())
    }

    /// All that is known, as arrays of a restart state.
    pub fn arrays(&self) -> Arrays {
        let steps = self.steps.map(|n| n as i64).to_vec();
        let mut arrays = Arrays::from([
            (STEPS.to_string(), StateArray::Integer(steps)),
            (SETTINGS.to_string(), StateArray::Real(self.settings())),
        ]);
        extremes::store(&self.extremes, &mut arrays);
        if let Some(histories) = &self.histories {
            histories.store(&mut arrays);
        }
        arrays
    }

    /// Goes on from the arrays of a restart state; without any, from nothing, which is said.
    pub fn load(&mut self, arrays: &Arrays, step: u64) -> anyhow::Result<()> {
        let Some(StateArray::Integer(steps)) = arrays.get(STEPS) else {
            print::note(format_args!(
                "note: the run had no [output.reduction] up to step {step}; it counts the steps after it"
            ));
            return Ok(());
        };
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let same = match arrays.get(SETTINGS) {
            Some(StateArray::Real(then)) => bits(then) == bits(&self.settings()),
            _ => false,
        };
        ensure!(
            same,
            "[output.reduction] has changed since step {step}, and what it has counted cannot be counted anew; \
             resume with its old values, or without the table"
        );
        let read = |n: &i64| u64::try_from(*n);
        let steps: Vec<u64> = steps.iter().map(read).collect::<Result<_, _>>()?;
        let wrong = || anyhow!("the counts of [output.reduction] in step {step} are not of this run");
        self.steps = <[u64; 3]>::try_from(steps).map_err(|_| wrong())?;
        extremes::load(&mut self.extremes, arrays).ok_or_else(wrong)?;
        if let Some(histories) = &mut self.histories {
            histories.load(arrays).ok_or_else(wrong)?;
        }
        Ok(())
    }

    /// The numbers of the scene on which the counts depend.
    fn settings(&self) -> Vec<f64> {
        let mut numbers = vec![self.asked.from, self.asked.every as f64];
        if let Some(damage) = self.asked.damage {
            numbers.extend([
                damage.stress as u8 as f64,
                damage.exponent,
                damage.reference_amplitude,
                damage.reference_cycles,
                damage.least_range,
                damage.nodes as u8 as f64,
            ]);
        }
        numbers
    }

    /// Fields over the points of all bodies; None before a step has counted. Balls have zeros, as in step files; damage
    /// and cycles are NaN where they are not counted.
    pub fn table(&self) -> Option<PointTable> {
        let [n, first, last] = self.steps;
        if n == 0 {
            return None;
        }
        let mut fields = extremes::fields(&self.extremes, n);
        if let Some(histories) = &self.histories {
            fields.extend(
                histories
                    .fields(self.extremes.len())
                    .map(|(name, values)| TableField {
                        name: name.to_string(),
                        n_components: 1,
                        values,
                    }),
            );
        }
        let near_field = match self.has_near_field {
            true => "with the near field of contacts",
            false => "near contacts that of the spread patch",
        };
        let text = format!(
            "stress at nodes, Pa, in each ring's own frame (nodes are points of the material), {near_field}; over {n} \
             steps, {first} to {last}, every {}",
            self.asked.every
        );
        Some(PointTable {
            fields,
            about: BTreeMap::from([
                (REDUCTION.to_string(), text),
                (STRESS.to_string(), format!("not rounded; see {REDUCTION}")),
            ]),
        })
    }
}

/// Takes the arrays of a reduction out of those of a restart state.
pub fn take_arrays(arrays: &mut Arrays) -> Arrays {
    let (own, others) = std::mem::take(arrays)
        .into_iter()
        .partition(|(name, _)| name.starts_with(PREFIX));
    *arrays = others;
    own
}
