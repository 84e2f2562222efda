//! `raceway pack`: finished steps into larger files, and back.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use checkpoint::{FolderLock, committed_steps, pack_steps, packs, unpack_steps};
use clap::Args;
use comm::print::{self, counted};
use results::failure::Failure;
use results::files::note_dead_owner;

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Pack {
    /// Folder of the results; no run may be writing to it.
    pub dir: PathBuf,
    /// Newest steps that stay files of their own, and at least all from the newest with a restart state; a run resumes
    /// from files of their own only.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..))]
    keep: u32,
    /// Steps in a pack.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    per_file: u32,
    /// Makes a file of every step again, of the same bytes as before.
    #[arg(long, conflicts_with_all = ["keep", "per_file"])]
    undo: bool,
}

/// Packs or unpacks.
pub fn pack(request: &Pack) -> Result<(), Failure> {
    let dir = &request.dir;
    if !dir.is_dir() {
        return Err(anyhow!("{} is no folder; expected the results of a run", dir.display()).into());
    }
    plot::require_one_bearing(dir)?;
    let lock = FolderLock::acquire(dir)?;
    note_dead_owner(&lock);
    if request.undo {
        let n = unpack_steps(&lock)?;
        let own = match n {
            1 => "is a file of its own",
            _ => "are files of their own",
        };
        print::line(format_args!(
            "{} of {} {own} again",
            counted(n, "step"),
            dir.display()
        ));
        return Ok(());
    }
    let n = pack_steps(&lock, request.keep as usize, request.per_file as usize)?;
    let packs = packs(dir)?;
    print::line(format_args!(
        "{} packed, {} in {}; {}",
        counted(n, "step"),
        counted(packs.len(), "pack"),
        dir.display(),
        match n {
            0 => why_none(
                dir,
                packs.iter().map(|(_, steps)| steps.len()).sum(),
                request.keep
            )?,
            _ => "run.vtkhdf shows them, run.hdf.series only the files of one step".to_string(),
        }
    ));
    Ok(())
}

/// Why no step was packed, of a folder with so many in packs.
fn why_none(dir: &Path, n_packed: usize, keep: u32) -> Result<String, Failure> {
    let own = committed_steps(dir)?.len();
    let before = match n_packed {
        0 => String::new(),
        1 => "1 step is in a pack, ".to_string(),
        n => format!("{n} steps are in packs, "),
    };
    let why = match own > keep as usize {
        true => ": the first of them holds the newest restart state",
        false => " (--keep)",
    };
    let stay = match own {
        1 => "the newest stays a file of its own".to_string(),
        n => format!("the newest {n} stay files of their own"),
    };
    Ok(format!("{before}{stay}{why}"))
}
