//! The length of arrays of shape functions.

/// Nodes of the largest element; arrays of shape functions have this length and end in zeros.
pub const MAX_NODES: usize = 20;
