//! What ranks share of a run, and what rank 0 does for all before it.

use std::path::Path;

use anyhow::anyhow;
use checkpoint::FolderLock;
use comm::{Communicator, print};
use results::failure::{Failure, agree};
use results::files::note_dead_owner;
use scene::Scene;

/// Says what ranks do not share.
pub fn note_unshared(scene: &Scene) {
    let ranks = Communicator::world().size();
    if let (Some(unshared), true) = (scene.solver.backend.unshared(), ranks > 1) {
        print::note(format_args!(
            "note: each of the {ranks} ranks computes {unshared}; with solver.backend = \"sector\" they share any ring"
        ));
    }
}

/// A number that rank 0 finds for all, such as the step to go on from: ranks may see the newest files at different
/// times. Collective.
pub fn of_root(find: impl FnOnce() -> Result<u64, Failure>) -> Result<u64, Failure> {
    let comm = Communicator::world();
    let chosen = agree(match comm.is_root() {
        true => find(),
        false => Ok(0),
    })?;
    let bytes = comm.from_root(chosen.to_le_bytes().to_vec());
    Ok(u64::from_le_bytes(
        bytes.try_into().expect("rank 0 sends a number"),
    ))
}

/// The lock of the folder, which rank 0 holds for all.
pub fn acquire(dir: &Path) -> Result<Option<FolderLock>, Failure> {
    if !dir.is_dir() {
        return Err(anyhow!("{} is no folder; expected the results of a run", dir.display()).into());
    }
    if !Communicator::world().is_root() {
        return Ok(None);
    }
    let lock = FolderLock::acquire(dir)?;
    note_dead_owner(&lock);
    Ok(Some(lock))
}

/// Prints which effects a scene has.
pub fn print_effects(names: &[&str]) {
    let names = match names {
        [] => "none".to_string(),
        names => names.join(", "),
    };
    print::line(format_args!("effects  {names}"));
}
