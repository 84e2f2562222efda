//! A rotationally periodic ring, solved harmonic by harmonic, and what its defects change.
//!
//! Its state stays in harmonic space while it moves ([`space`]); one pass over the harmonics ends a step and begins the solve of the next
//! ([`pass`]). Defects (moved, missing or otherwise held nodes) are forces on few rows of the regular ring. Where nodes are free
//! that most sectors hold, the vectors are coordinates and only the solves are harmonic ([`loose`]).

mod body;
pub mod defect;
pub mod defect_change;
mod defect_step;
mod factor;
mod harmonics;
mod loose;
mod pass;
pub mod periodic;
pub mod regular;
mod space;
pub(crate) mod space_defect;
mod step;
mod touch;

use std::sync::Arc;

use crate::body::{ElasticBody, Frame, HeldRing};
use crate::error::RingError;
use crate::model::RingModel;
use crate::nodal::NodalBody;
use body::HarmonicBody;
pub(crate) use harmonics::Harmonics;
use loose::LooseSolver;
pub use periodic::Periodic;
use space::HarmonicSpace;
use space_defect::SpaceDefect;

/// The body of a ring that harmonics solve.
pub(crate) fn body(
    ring: &RingModel,
    held: HeldRing,
    periodic: Periodic,
    frame: Frame,
) -> Result<Arc<dyn ElasticBody>, RingError> {
    let name = held.name;
    let (harmonics, stencils) = Harmonics::new(ring, &held, periodic)?;
    let own = held.nodes(&stencils);
    let space = match &harmonics.defect {
        None => HarmonicSpace::new(&harmonics.held, own, None),
        Some(change) => match SpaceDefect::new(&change.changes, &harmonics.held) {
            None => {
                return Ok(Arc::new(NodalBody {
                    held,
                    solver: LooseSolver { harmonics, stencils },
                }));
            }
            Some(defect) => {
                let regular = change.nodes();
                let defect = match frame {
                    Frame::Turning => defect.turning(own, regular, change.changes.rows()),
                    Frame::Still => defect,
                };
                HarmonicSpace::new(&harmonics.held, regular, Some(defect))
            }
        },
    };
    let space = space.map_err(|source| RingError::Solver { side: name, source })?;
    Ok(Arc::new(HarmonicBody {
        held,
        stencils,
        harmonics,
        space,
    }))
}
