//! Linear elasticity on a [`mesh::Mesh`]: stiffness, mass, loads, rigid motions and stress recovery.
//!
//! Small strain, isotropic Hooke's law, three degrees of freedom per node: `dof = 3 * node + component`, SI.
//! Matrices hold all degrees of freedom; supports are the caller's business. Six-component order is stated in
//! [`stress`] and nowhere redefined.
//!
//! | kind | stiffness | points | mass |
//! |---|---|---|---|
//! | hex8 | incompatible modes (Taylor, Beresford, Wilson), condensed ([`stiffness`]) | 2 x 2 x 2 | 3 x 3 x 3, exact |
//! | hex20 | full integration | 3 x 3 x 3 | 5 x 5 x 5, exact also on curved elements |
//! | tet10 | full integration | 4 | collapsed 5 x 5 x 5, exact also on curved elements |
//!
//! A rotationally periodic ring needs one sector only: [`assemble_sector`].
//!
//! Reduced integration is not offered: it hourglasses under contact loads.
//!
//! Every sum over elements runs in the order of the elements ([`mesh::Mesh::connectivity`]), so results are the
//! same bits for any number of threads.

mod chunks;
pub mod element;
pub mod error;
pub mod facet;
mod geometry;
pub mod loads;
pub mod mass;
pub mod material;
pub mod norms;
pub mod pattern;
pub mod prestress;
pub mod quadrature;
pub mod rigid;
pub mod sector;
pub mod stiffness;
pub mod stress;
pub mod surface;
mod table;

pub use error::FemError;
pub use geometry::check_elements;
pub use loads::{body_load, centrifugal_load};
pub use mass::{assemble_azimuthal_mass, assemble_mass, assemble_mass_into, assemble_node_mass};
pub use material::Material;
pub use pattern::Pattern;
pub use prestress::{SectorPrestress, assemble_node_prestress, assemble_sector_prestress};
pub use rigid::{MassProperties, inertia, rigid_modes, volume};
pub use sector::{SectorCoupling, SectorMatrices, assemble_sector, azimuth_directions};
pub use stiffness::{assemble_stiffness, assemble_stiffness_into, stiffness_product};
pub use stress::{SectorStress, StressRecovery, StressWorkspace, principal, von_mises};
pub use surface::{area, facet_node_weights, pressure_load, traction_load};
