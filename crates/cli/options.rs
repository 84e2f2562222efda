//! What the command line says about a run besides its scene.

use std::time::Duration;

use clap::Args;

use crate::stop::parse_wall_time;

/// Limits of a run.
#[derive(Clone, Debug, Default, Args)]
pub struct Limits {
    /// Stops at a step boundary before this time is used up, with a step to resume from and exit code 75.
    #[arg(long, value_name = "HH:MM:SS", value_parser = parse_wall_time)]
    pub wall_time: Option<Duration>,
    /// Starts even when the forecast of the output does not fit the disk.
    #[arg(long)]
    pub ignore_disk_space: bool,
}
