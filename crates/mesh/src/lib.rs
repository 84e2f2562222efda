//! Reads a Gmsh file into nodes, elements and named groups, checks it, and revolves sections into rings.

pub mod element;
pub mod mesh;

pub use element::{ElementKind, FacetKind};
pub use mesh::{Facet, Mesh};
