//! Why a mesh is not rotationally periodic, and why not even up to a defect.

use thiserror::Error;

/// The first thing that differs between the sectors of a ring. Nodes and elements are indices of the mesh, from 0.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotPeriodic {
    /// There is nothing to turn.
    #[error("the mesh has no elements")]
    Empty,
    /// A node on the axis belongs to no sector.
    #[error("node {node} lies on the axis of the ring, so it belongs to no sector")]
    OnAxis {
        /// Node index.
        node: usize,
    },
    /// No other node has the radius and height of this one.
    #[error(
        "node {node} is the only one at radius {radius:.9e} m and z = {z:.9e} m; in a periodic mesh every sector has \
         one"
    )]
    Alone {
        /// Node index.
        node: usize,
        /// Its radius, m.
        radius: f64,
        /// Its height, m.
        z: f64,
    },
    /// A turned node meets no node.
    #[error(
        "with {n_sectors} sectors, node {node} at ({:.9e}, {:.9e}, {:.9e}) m turned by one sector meets no node within \
         {tolerance:.1e} m",
        position[0], position[1], position[2]
    )]
    Node {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Node index.
        node: usize,
        /// Its position, m.
        position: [f64; 3],
        /// Tolerance, m.
        tolerance: f64,
    },
    /// A turned element meets no element.
    #[error(
        "with {n_sectors} sectors, element {element} turned by one sector meets no element with the same nodes"
    )]
    Element {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Element index.
        element: usize,
    },
    /// A turned facet leaves its group.
    #[error(
        "with {n_sectors} sectors, face {face} of element {element} turned by one sector is not in its \
         group \"{group}\" any more"
    )]
    Facet {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Name of the group.
        group: String,
        /// Element index.
        element: usize,
        /// Face of the element.
        face: usize,
    },
}

/// Why a ring is not periodic up to a defect. Nodes and elements are indices of the mesh, from 0; those beyond its
/// own are of the ring without a defect.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotNearlyPeriodic {
    /// Neighbours on a circle have no usual distance.
    #[error("its nodes are not at equal angles")]
    NoPattern,
    /// Too many nodes stand elsewhere or are absent, or too many elements are missing.
    #[error("with {n_sectors} sectors, more than {limit} of its nodes or elements differ")]
    Large {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Most nodes or elements of a defect.
        limit: usize,
    },
    /// There are nodes that belong to no sector.
    #[error(
        "with {n_sectors} sectors, {strays} nodes from node {first} on are not where their sectors have nodes, for \
         {vacancies} places without a node"
    )]
    MoreNodes {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Nodes that stand elsewhere.
        strays: usize,
        /// The first of them.
        first: usize,
        /// Places that lack a node.
        vacancies: usize,
    },
    /// A node has no place of its own in the ring without a defect, or no element.
    #[error(
        "with {n_sectors} sectors, node {node} has no place of its own in an element of the ring without a defect"
    )]
    Node {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Node index.
        node: usize,
    },
    /// An element that most sectors lack.
    #[error("with {n_sectors} sectors, most sectors have no element like element {element}")]
    MoreElements {
        /// Number of sectors tried.
        n_sectors: usize,
        /// Element index.
        element: usize,
    },
    /// The ring without the defect is not periodic.
    #[error("without its defect it would not be periodic: {0}")]
    Regular(NotPeriodic),
}
