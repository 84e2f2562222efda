//! The length of arrays of shape functions of facets.

/// Nodes of the largest facet; arrays of shape functions have this length and end in zeros.
pub const MAX_FACET_NODES: usize = 8;
