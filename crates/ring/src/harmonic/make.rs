//! Makes the body of a ring that harmonics solve: in harmonic space, or in coordinates where nodes are loose.

use std::sync::Arc;

use super::harmonics::{HarmonicBody, Harmonics};
use super::loose::LooseSolver;
use super::periodic::Periodic;
use super::space::HarmonicSpace;
use super::space_defect::SpaceDefect;
use crate::body::{ElasticBody, Frame, HeldRing};
use crate::error::RingError;
use crate::model::RingModel;
use crate::nodal::columns::NodalBody;

/// The body of a ring that harmonics solve, stiffened by the stress of an expansion.
pub(crate) fn harmonic_body(
    ring: &RingModel,
    held: HeldRing,
    periodic: Periodic,
    (frame, expansion): (Frame, Option<&[f64]>),
) -> Result<Arc<dyn ElasticBody>, RingError> {
    let name = held.name;
    let periodic = match expansion {
        Some(expansion) => periodic.stiffened(ring, name, &held.coordinates.held_nodes(), expansion)?,
        None => periodic,
    };
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
                    Frame::Turning | Frame::Stiffened => defect.turning(own, regular, change.changes.rows()),
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
