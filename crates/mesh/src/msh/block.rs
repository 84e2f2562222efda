//! Elements of one type as a file has them.

/// Elements of one type in one entity.
pub(crate) struct ElementBlock {
    /// Dimension of the elements, 0 to 3.
    pub(crate) dimension: usize,
    /// Gmsh element type.
    pub(crate) gmsh_type: i64,
    /// Nodes per element.
    pub(crate) n_nodes: usize,
    /// Physical groups of the entity.
    pub(crate) physical: Vec<i64>,
    /// Element tags.
    pub(crate) tags: Vec<u64>,
    /// Node tags in Gmsh's order, `[tags.len()][n_nodes]`, flat.
    pub(crate) nodes: Vec<u64>,
}
