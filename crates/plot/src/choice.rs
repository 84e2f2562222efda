//! What is chosen of a run for its figures.

use clap::Args;

/// What the figures show of a run.
#[derive(Clone, Debug, Default, Args)]
pub struct Choice {
    /// Ball whose way round is shown, from 0.
    #[arg(long, default_value_t = 0)]
    pub ball: usize,
    /// Step whose stress is shown; default: the last with stress.
    #[arg(long)]
    pub step: Option<u64>,
}
