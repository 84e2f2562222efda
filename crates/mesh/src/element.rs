//! Element kinds, their node order and their faces.
//!
//! Node order inside the program is VTK's (and the textbooks'): corners, then the mid-nodes of the bottom,
//! top and vertical edges (hex20), or of the edges 01 12 02 03 13 23 (tet10). Gmsh's order differs for hex20
//! and tet10; the reader and the writer translate with [`ElementKind::gmsh_order`], and nothing else does.

/// A volume element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ElementKind {
    /// Trilinear hexahedron, 8 nodes.
    Hex8,
    /// Serendipity hexahedron, 20 nodes.
    Hex20,
    /// Quadratic tetrahedron, 10 nodes.
    Tet10,
}

/// A face of a volume element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FacetKind {
    /// Bilinear quadrilateral, 4 nodes.
    Quad4,
    /// Serendipity quadrilateral, 8 nodes: corners, then mid-nodes of edges 01 12 23 30.
    Quad8,
    /// Quadratic triangle, 6 nodes: corners, then mid-nodes of edges 01 12 20.
    Tri6,
}

/// Faces of a hexahedron, corners then mid-nodes, counter-clockwise seen from outside.
const HEX_FACES: [[usize; 8]; 6] = [
    [0, 3, 2, 1, 11, 10, 9, 8],
    [4, 5, 6, 7, 12, 13, 14, 15],
    [0, 1, 5, 4, 8, 17, 12, 16],
    [1, 2, 6, 5, 9, 18, 13, 17],
    [2, 3, 7, 6, 10, 19, 14, 18],
    [3, 0, 4, 7, 11, 16, 15, 19],
];

/// Faces of a tetrahedron, corners then mid-nodes, counter-clockwise seen from outside.
const TET_FACES: [[usize; 6]; 4] = [
    [0, 2, 1, 6, 5, 4],
    [0, 1, 3, 4, 8, 7],
    [1, 2, 3, 5, 9, 8],
    [2, 0, 3, 6, 7, 9],
];

/// Corners of the edges of a hexahedron: bottom, top, vertical.
const HEX_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// Corners of the edges of a tetrahedron.
const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// `HEX20_GMSH[i]` is the place in Gmsh's list of our node `i`.
const HEX20_GMSH: [usize; 20] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15,
];
/// The same for the quadratic tetrahedron: Gmsh swaps the last two mid-nodes.
const TET10_GMSH: [usize; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8];

impl ElementKind {
    /// All kinds, for loops in tests and messages.
    pub const ALL: [ElementKind; 3] = [ElementKind::Hex8, ElementKind::Hex20, ElementKind::Tet10];

    /// Name used in scenes, files and messages.
    pub fn name(self) -> &'static str {
        match self {
            ElementKind::Hex8 => "hex8",
            ElementKind::Hex20 => "hex20",
            ElementKind::Tet10 => "tet10",
        }
    }

    /// Nodes of one element.
    pub fn n_nodes(self) -> usize {
        match self {
            ElementKind::Hex8 => 8,
            ElementKind::Hex20 => 20,
            ElementKind::Tet10 => 10,
        }
    }

    /// Corner nodes of one element; they come first in the node list.
    pub fn n_corners(self) -> usize {
        match self {
            ElementKind::Hex8 | ElementKind::Hex20 => 8,
            ElementKind::Tet10 => 4,
        }
    }

    /// Corners of the edges; the mid-node of edge `i` of a quadratic kind is local node `n_corners() + i`.
    pub fn edges(self) -> &'static [[usize; 2]] {
        match self {
            ElementKind::Hex8 | ElementKind::Hex20 => &HEX_EDGES,
            ElementKind::Tet10 => &TET_EDGES,
        }
    }

    /// Faces of one element.
    pub fn n_faces(self) -> usize {
        match self {
            ElementKind::Hex8 | ElementKind::Hex20 => 6,
            ElementKind::Tet10 => 4,
        }
    }

    /// Local nodes of a face, in the order of [`Self::facet_kind`], outward normal by the right-hand rule.
    pub fn face_nodes(self, face: usize) -> &'static [usize] {
        match self {
            ElementKind::Hex8 => &HEX_FACES[face][..4],
            ElementKind::Hex20 => &HEX_FACES[face],
            ElementKind::Tet10 => &TET_FACES[face],
        }
    }

    /// Kind of all faces.
    pub fn facet_kind(self) -> FacetKind {
        match self {
            ElementKind::Hex8 => FacetKind::Quad4,
            ElementKind::Hex20 => FacetKind::Quad8,
            ElementKind::Tet10 => FacetKind::Tri6,
        }
    }

    /// VTK cell type: 12 hexahedron, 25 quadratic hexahedron, 24 quadratic tetrahedron.
    pub fn vtk_type(self) -> u8 {
        match self {
            ElementKind::Hex8 => 12,
            ElementKind::Hex20 => 25,
            ElementKind::Tet10 => 24,
        }
    }

    /// Gmsh element type: 5, 17, 11.
    pub fn gmsh_type(self) -> usize {
        match self {
            ElementKind::Hex8 => 5,
            ElementKind::Hex20 => 17,
            ElementKind::Tet10 => 11,
        }
    }

    /// `gmsh_order()[i]` is the place in Gmsh's node list of our node `i`.
    pub fn gmsh_order(self) -> &'static [usize] {
        match self {
            ElementKind::Hex8 => &HEX20_GMSH[..8],
            ElementKind::Hex20 => &HEX20_GMSH,
            ElementKind::Tet10 => &TET10_GMSH,
        }
    }
}

impl FacetKind {
    /// Nodes of one facet.
    pub fn n_nodes(self) -> usize {
        match self {
            FacetKind::Quad4 => 4,
            FacetKind::Quad8 => 8,
            FacetKind::Tri6 => 6,
        }
    }

    /// Corner nodes of one facet.
    pub fn n_corners(self) -> usize {
        match self {
            FacetKind::Quad4 | FacetKind::Quad8 => 4,
            FacetKind::Tri6 => 3,
        }
    }

    /// Gmsh element type: 3, 16, 9. Gmsh's node order is ours for all three.
    pub fn gmsh_type(self) -> usize {
        match self {
            FacetKind::Quad4 => 3,
            FacetKind::Quad8 => 16,
            FacetKind::Tri6 => 9,
        }
    }
}
