//! `[solver]`: how the equations are solved.

use comm::Communicator;
use dynamics::{Backend, Sectors};
use input::Problems;
use serde::Deserialize;

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [solver]")]
pub struct RawSolver {
    backend: Option<BackendChoice>,
    sectors: Option<i64>,
    tolerance: Option<f64>,
    max_iterations: Option<i64>,
}

/// Solver of the linear systems of the rings.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BackendChoice {
    /// Harmonics for a rotationally periodic ring in motion, else sparse Cholesky.
    Auto,
    /// Harmonics in motion; a ring that is not periodic is refused.
    Cyclic,
    /// Sparse Cholesky factorisation of each ring.
    Sparse,
    /// Rings cut by angle into sectors, which threads and ranks share.
    Sector,
}

impl BackendChoice {
    /// Whether a rank may hold a part of a ring only.
    pub fn divides_rings(self) -> bool {
        self == BackendChoice::Sector
    }

    /// What each of several ranks computes by itself, in words; None: they share all of it.
    pub fn unshared(self) -> Option<&'static str> {
        match self {
            BackendChoice::Sector | BackendChoice::Cyclic => None,
            BackendChoice::Auto => Some("rings that are not rotationally periodic"),
            BackendChoice::Sparse => Some("the whole run"),
        }
    }
}

/// How the equations are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// Linear solver.
    pub backend: BackendChoice,
    /// Number of sectors of each ring with the backend `sector`; None: by the size of the ring.
    pub sectors: Option<usize>,
    /// Newton stops when the residual is below this part of the loads, dimensionless.
    pub tolerance: f64,
    /// Newton iterations before a solution counts as failed.
    pub max_iterations: usize,
}

impl Solver {
    /// The linear solver of the rings, with the ranks of this process.
    pub fn of_rings(&self) -> Backend {
        match self.backend {
            BackendChoice::Auto => Backend::Auto,
            BackendChoice::Cyclic => Backend::Cyclic,
            BackendChoice::Sparse => Backend::Sparse,
            BackendChoice::Sector => Backend::Sector(Sectors {
                n_sectors: self.sectors,
                comm: Communicator::world(),
            }),
        }
    }
}

/// Two digits above the round-off of the contact equations.
const DEFAULT_TOLERANCE: f64 = 1e-10;
/// Newton needs 2 to 6 iterations; many more only in line searches from a bad start.
const DEFAULT_MAX_ITERATIONS: i64 = 50;

impl RawSolver {
    /// Checks ranges and fills in defaults.
    pub fn check(&self, problems: &mut Problems) -> Solver {
        let tolerance = self.tolerance.unwrap_or(DEFAULT_TOLERANCE);
        problems.require(
            (1e-14..=1e-2).contains(&tolerance),
            "solver.tolerance",
            tolerance,
            "expected 1e-14 to 1e-2, it is relative to the loads",
        );
        let backend = self.backend.unwrap_or(BackendChoice::Auto);
        if let Some(sectors) = self.sectors {
            problems.require(
                backend == BackendChoice::Sector,
                "solver.sectors",
                sectors,
                "expected only with backend = \"sector\"",
            );
        }
        let sectors = self.sectors.map(|n| problems.whole(n, "solver.sectors", 1, 4096));
        let max_iterations = self.max_iterations.unwrap_or(DEFAULT_MAX_ITERATIONS);
        Solver {
            backend,
            sectors,
            tolerance,
            max_iterations: problems.whole(max_iterations, "solver.max_iterations", 1, 10_000),
        }
    }
}
