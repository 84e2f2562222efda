//! Geometry and laws of ball-raceway contact: bearing geometry, Hertz theory, contact patches on a raceway
//! mesh, bounding boxes over its facets.
//!
//! Frame: the bearing axis is z, the azimuth is measured from +x towards +y. A vector in the meridian plane
//! of a ball is `[radial, axial]`.

pub mod across;
mod bins;
pub mod elliptic;
pub mod error;
pub mod extent;
mod facet_map;
pub mod facets;
pub mod film;
pub mod geometry;
pub mod halfspace;
pub mod hertz;
pub mod law;
mod meridian;
pub mod near_field;
mod neighbours;
pub mod patch;
pub mod patch_shape;
mod pressure;
pub mod quadrature;
pub mod raceway;
mod semi_axes;
mod shell;
pub mod sphere;
pub mod strips;
pub mod surface;
pub mod unevenness;
mod unwrap;
mod vector;
pub mod weights;
pub mod worn_line;

pub use across::AcrossCompliance;
pub use error::ContactError;
pub use extent::{LoadPart, StripExtent, StripLoads};
pub use facets::FacetSurface;
pub use geometry::{BearingGeometry, BySide, Side};
pub use hertz::{Elastic, HertzContact};
pub use law::{BallLaws, ContactLaw};
pub use meridian::Meridian;
pub use near_field::{LoadedPatch, NearField, RingPoint};
pub use patch::Patch;
pub use patch_shape::{LeastSize, PatchShape, is_truncated};
pub use raceway::{Groove, RacewaySurface, spacings_in_side};
pub use semi_axes::SemiAxes;
pub use sphere::SphereCompliance;
pub use strips::{StripForce, StripLaw, StripLine};
pub use surface::{BallArc, BallSurface, Profiles, SeenMeridian, StripSurface};
pub use unevenness::Unevenness;
pub use vector::cross;
pub use weights::NodalWeights;
pub use worn_line::WornLine;
