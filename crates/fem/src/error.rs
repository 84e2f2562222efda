//! What can be wrong with a mesh or a material.

/// An error of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FemError {
    /// A material constant lies outside its physical range.
    #[error("{quantity} is {value}, expected {expected}; check the material's units")]
    InvalidMaterial {
        /// The constant, in words.
        quantity: &'static str,
        /// Its value, SI.
        value: f64,
        /// The allowed range, in words.
        expected: &'static str,
    },
    /// The mesh has no element.
    #[error(
        "the mesh has no elements, expected at least one {kind}; check the mesh file and its volume groups"
    )]
    EmptyMesh {
        /// Element kind.
        kind: &'static str,
    },
    /// The connectivity is not a whole number of elements.
    #[error(
        "the mesh lists {length} element nodes, expected a multiple of {nodes_per_element} ({kind}); \
         the mesh is cut short or mixes element kinds"
    )]
    PartialElement {
        /// Length of the connectivity.
        length: usize,
        /// Nodes of one element.
        nodes_per_element: usize,
        /// Element kind.
        kind: &'static str,
    },
    /// An element names a node that does not exist.
    #[error(
        "element {element} names node {node}, expected a node below {n_nodes}; check the mesh's node numbers"
    )]
    UnknownNode {
        /// Element index.
        element: usize,
        /// The node it names.
        node: usize,
        /// Number of nodes of the mesh.
        n_nodes: usize,
    },
    /// An element is inverted or degenerate.
    #[error(
        "element {element} ({kind}) is inverted or degenerate: its jacobian determinant is {det:.3e} m^3 near \
         ({:.6e}, {:.6e}, {:.6e}) m, expected a positive one; check the node order or remesh more evenly",
        position[0], position[1], position[2]
    )]
    NonPositiveJacobian {
        /// Element index.
        element: usize,
        /// Element kind.
        kind: &'static str,
        /// Integration point, m, `[3]`.
        position: [f64; 3],
        /// Determinant of the derivative of position with respect to reference coordinates, m^3.
        det: f64,
    },
    /// A point is not in the mesh.
    #[error(
        "no element holds the point ({:.6e}, {:.6e}, {:.6e}) m, not even within a seventh of its size; \
         expected a point of the body",
        point[0], point[1], point[2]
    )]
    OutsideMesh {
        /// The point, m, `[3]`.
        point: [f64; 3],
    },
    /// A node belongs to more elements than the pattern can number.
    #[error(
        "node {node} shares elements with {neighbours} nodes, expected at most {limit}; \
         the mesh has a degenerate fan of elements there"
    )]
    TooManyNeighbours {
        /// Node index.
        node: usize,
        /// Nodes it is coupled with.
        neighbours: usize,
        /// Largest supported number.
        limit: usize,
    },
}
