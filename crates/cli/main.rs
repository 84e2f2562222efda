//! The program `raceway`: rolling bearings whose two rings are finite-element bodies.
//!
//! Exit codes: 0 finished, 2 wrong input, 3 no solution found.

mod build;
mod check;
mod failure;
mod meshing;
mod modes;
mod motion;
mod print;
mod progress;
mod results;
mod run;
mod scene;
mod units;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use mesh::Overwrite;

use crate::failure::Failure;

/// Simulates angular contact ball bearings with fully flexible rings.
#[derive(Debug, Parser)]
#[command(name = "raceway", version, arg_required_else_help = true)]
struct Arguments {
    /// Number of threads; default: all cores. Results do not depend on it.
    #[arg(long, global = true)]
    threads: Option<usize>,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs a scene and writes its results.
    Run {
        /// Scene file.
        scene: PathBuf,
        /// Changes a value of the scene: path=value, such as effects.axial_force.value="3 kN".
        #[arg(long = "set", value_name = "PATH=VALUE")]
        overrides: Vec<String>,
        /// Folder of the results; default: results/ and the scene's name.
        #[arg(long)]
        out: Option<PathBuf>,
    },
    /// Builds everything a run needs but solves nothing: effects, sizes, memory, output.
    Check {
        /// Scene file.
        scene: PathBuf,
        /// Changes a value of the scene.
        #[arg(long = "set", value_name = "PATH=VALUE")]
        overrides: Vec<String>,
    },
    /// Builds the ring meshes that a scene describes; needs Gmsh.
    Mesh {
        /// Scene file.
        scene: PathBuf,
        /// Changes a value of the scene.
        #[arg(long = "set", value_name = "PATH=VALUE")]
        overrides: Vec<String>,
        /// Replaces existing mesh files.
        #[arg(long)]
        force: bool,
    },
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match execute(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            print::note(format_args!("error: {}", failure.text()));
            failure.code()
        }
    }
}

fn execute(arguments: Arguments) -> Result<(), Failure> {
    comm::refuse_parallel_launch()?;
    if let Some(threads) = arguments.threads {
        if threads == 0 {
            return Err(Failure::User(anyhow::anyhow!(
                "--threads is 0; expected at least 1"
            )));
        }
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build_global()?;
    }
    match arguments.command {
        Command::Run {
            scene,
            overrides,
            out,
        } => {
            let dir = run::run(&scene, &overrides, out)?;
            print::line(format_args!("results: {}", dir.display()));
            Ok(())
        }
        Command::Check { scene, overrides } => check::check(&scene, &overrides),
        Command::Mesh {
            scene,
            overrides,
            force,
        } => {
            let overwrite = if force {
                Overwrite::Replace
            } else {
                Overwrite::Refuse
            };
            meshing::build_meshes(&scene, &overrides, overwrite)
        }
    }
}
