//! Reads a Gmsh file into nodes, elements and named groups, checks it, and revolves sections into rings.
//!
//! Two ways lead to a [`Mesh`]: [`read_msh`] takes any 3-D Gmsh mesh of a ring (physical volume `ring`, named
//! physical surfaces); [`read_section`] and [`revolve`] take a 2-D mesh of its section and make a ring that is
//! exactly rotationally periodic. [`ring_geo`] writes the section of a ring for Gmsh. [`find_periodicity`] finds the
//! equal sectors of any mesh, or the reason why there are none.

pub mod check;
pub mod element;
pub mod error;
pub mod geometry;
pub mod gmsh;
pub mod mesh;
pub mod msh;
pub mod origin;
pub mod periodic;
pub mod positions;
pub mod revolution;
pub mod ring;
pub mod section;
pub mod torus;

pub use check::{
    Coverage, Cylinder, CylinderPart, Revolved, check_mesh, check_torus, check_unit, check_whole, coverage,
    require_apart, require_groups,
};
pub use element::{ElementKind, FacetKind};
pub use error::{MeshError, Place};
pub use geometry::volume;
pub use gmsh::{Gmsh, NO_GMSH, mesh_section_with_gmsh, mesh_tets_with_gmsh};
pub use mesh::{Facet, Mesh};
pub use msh::record::read_record;
pub use msh::write::{MshFormat, Overwrite, write_msh, write_msh_with_record};
pub use msh::{read_body_msh, read_msh, read_msh_with_origin};
pub use origin::Origin;
pub use periodic::{
    NearlyPeriodic, NotNearlyPeriodic, NotPeriodic, PERIODIC_TOLERANCE, PeriodicSite, Periodicity,
    find_nearly_periodic, find_periodicity,
};
pub use positions::NodePositions;
pub use revolution::{
    GrooveOfOutline, NotRevolved, OffOutline, OutlineCurve, OutlinePiece, OwnAxis, REVOLVED_TOLERANCE,
    Revolution, RevolvedOutline, SectionFineness, find_revolution, groove_of, group_outline, is_revolved,
    outline_geo, revolve_outline,
};
pub use ring::{RingGeometry, RingSection, RingSide, VolumeMoments, ring_geo, ring_tet_geo};
pub use section::{Arc, Section, SectionEdge, Snap, read_section, read_section_with_origin, revolve};
pub use torus::Torus;
