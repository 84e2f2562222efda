//! Forecasts of the memory of a run, known before its first step.

use anyhow::anyhow;
use comm::Communicator;
use dynamics::motion::Motion;
use dynamics::{RingMemory, forecast_peak};
use rustix::process::{Resource, getrlimit};
use scene::Dynamic;

use crate::failure::Failure;

/// Steps between files up to which files wait for the disk.
const OFTEN: u64 = 10;

/// Forecasts of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Forecasts {
    /// Statics of inner and outer ring; None is rigid, or was not solved.
    pub rings: [Option<RingMemory>; 2],
    /// Peak of the run, bytes; None where there is no forecast.
    pub peak: Option<usize>,
}

impl Forecasts {
    /// Of a run at rest.
    pub fn at_rest(rings: [Option<RingMemory>; 2]) -> Forecasts {
        Forecasts {
            rings,
            peak: Some(forecast_peak(rings, rings_at_once())),
        }
    }

    /// Of a motion that begins with `rings` at rest.
    pub fn of_motion(rings: [Option<RingMemory>; 2], motion: &Motion<'_>, dynamic: &Dynamic) -> Forecasts {
        let start = forecast_peak(rings, rings_at_once());
        let steps = motion.memory_forecast(queued_steps(dynamic));
        Forecasts {
            rings,
            peak: steps.map(|steps| steps.max(start)),
        }
    }
}

/// Steps of a motion that wait to be written at a time.
pub fn queued_steps(dynamic: &Dynamic) -> usize {
    if dynamic.output_every <= OFTEN { 2 } else { 0 }
}

/// Number of threads that make rings: ranks make one after the other.
fn rings_at_once() -> usize {
    match Communicator::world().size() {
        1 => rayon::current_num_threads(),
        _ => 1,
    }
}

/// Least address space, bytes: the libraries reserve some before the first ring is read, and end the program
/// where they get none.
const LEAST_ADDRESS_SPACE: u64 = 320_000_000;

/// Fails if the system gives this process too little address space for any work.
pub fn require_address_space() -> Result<(), Failure> {
    let limit = getrlimit(Resource::As).current;
    match limit.filter(|&limit| limit < LEAST_ADDRESS_SPACE) {
        None => Ok(()),
        Some(limit) => Err(Failure::User(anyhow!(
            "the address space of this process is limited to {} MB; expected at least {} MB and the memory that \
             raceway check forecasts, see ulimit -v",
            limit / 1_000_000,
            LEAST_ADDRESS_SPACE / 1_000_000
        ))),
    }
}
