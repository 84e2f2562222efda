//! What a run spends its time on: names of the laps of the solver, and a lap for every effect.
//!
//! Laps live in the workspace of a solver, never in an effect, and nothing that is computed depends on them.
//! Effects that add loads are timed by [`crate::Model::timed_loads`]; those inside the steps of a motion time
//! themselves.

use timer::{Laps, SharedLaps};

use crate::model::Model;

pub use ring::statics::{ASSEMBLE, FACTOR};
pub use ring::step::{RACEWAYS, RIGHT_SIDE};

/// All that is done at the contacts.
pub const CONTACT: &str = "contact";
/// Placing of the patches.
pub const PATCHES: &str = "contact/patches";
/// Newton on contacts, balls and shaft.
pub const NEWTON: &str = "contact/newton";
/// Compliance columns of the contacts, in statics.
pub const COLUMNS: &str = "columns";
/// The search for modes.
pub const SEARCH: &str = "search";
/// Full-field solves of statics; in motion whole rings: products, solves, new states, energies.
pub const SOLVE: &str = "solve";
/// In motion, predictor and columns: the block solve.
pub const BLOCK_SOLVE: &str = "solve/solve";
/// In motion, inertia of the turning frame: products and solves.
pub const FRAME: &str = "solve/frame";
/// In motion, new state, energies and ledger.
pub const UPDATE: &str = "solve/update";
/// In motion, loads of the effects.
pub const LOADS: &str = "loads";
/// Effects, each a part by its name; they overlap with the other laps.
pub const EFFECTS: &str = "effects";

/// A lap of 0 s for every effect of the model.
pub fn of_effects(model: &Model) -> SharedLaps {
    let mut laps = Laps::default();
    for effect in &model.effects {
        laps.add(effect.name(), 0.0);
    }
    laps.into()
}
