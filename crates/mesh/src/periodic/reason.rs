//! Why a mesh is not rotationally periodic.

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
        "node {node} is the only one at radius {radius:.9e} m and z = {z:.9e} m; in a periodic mesh every sector has one"
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
        "with {n_sectors} sectors, face {face} of element {element} turned by one sector is not in its group \"{group}\" any more"
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
