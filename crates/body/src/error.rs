//! What can be wrong with a body round a ring.

use std::path::PathBuf;

use dense::DenseError;
use fem::FemError;
use solver::SolverError;
use thiserror::Error;

/// Directions, for messages.
pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];
/// Rotations, for messages.
const ROTATIONS: [&str; 3] = ["rx", "ry", "rz"];

/// The direction of a row, for messages; `is_rotation` of each three of them, of no rotations empty.
pub(crate) fn direction(is_rotation: &[bool], row: usize) -> &'static str {
    let names = if is_rotation.get(row / 3) == Some(&true) {
        ROTATIONS
    } else {
        AXES
    };
    names[row % 3]
}

/// Why there is no body, or no joint of it with a ring.
#[derive(Debug, Error)]
pub enum SurroundingError {
    /// A body from matrices on a shaft.
    #[error(
        "body \"{body}\" comes from the matrices of another program, which a shaft does not carry; give its mesh"
    )]
    MatrixOnShaft {
        /// Name of the body.
        body: String,
    },
    /// A body from a stiffness matrix alone, in motion.
    #[error(
        "body \"{body}\" comes from a stiffness matrix and has no mass, so it is solved at rest only; give its mass \
         matrix, or use [static], [sweep] or [quasi_static]"
    )]
    NoMass {
        /// Name of the body.
        body: String,
    },
    /// Modes that were not found.
    #[error("the natural modes of body \"{body}\" below {below_hz} Hz: {source}; lower body.modes_below")]
    Modes {
        /// Name of the body.
        body: String,
        /// Frequency up to which they are wanted, Hz.
        below_hz: f64,
        /// Why.
        source: DenseError,
    },
    /// More modes than can be kept.
    #[error(
        "body \"{body}\" has more than {most} natural modes below {below_hz} Hz with its seat held; lower \
         body.modes_below{doubt}"
    )]
    TooManyModes {
        /// Name of the body.
        body: String,
        /// Frequency up to which they are wanted, Hz.
        below_hz: f64,
        /// How many may be kept.
        most: usize,
        /// What is odd of its matrices, after a semicolon.
        doubt: String,
    },
    /// A group that is not in the mesh.
    #[error(
        "body \"{body}\" has no facet group \"{group}\" in its mesh; groups are {known}; correct {key} or name the \
         surface in Gmsh"
    )]
    UnknownGroup {
        /// Name of the body.
        body: String,
        /// The group.
        group: String,
        /// Those that it has.
        known: String,
        /// The key of the scene.
        key: &'static str,
    },
    /// Nothing holds the body.
    #[error("body \"{body}\" is not held: it can move at node {node} in {axis} without any force; {advice}")]
    NotHeld {
        /// Name of the body.
        body: String,
        /// Node, as its source numbers it.
        node: u64,
        /// Direction.
        axis: &'static str,
        /// What to try.
        advice: &'static str,
    },
    /// The fixed nodes lie on a line or a point.
    #[error(
        "body \"{body}\" is fixed at {count} nodes that lie on one line, so it can turn about it; fix a surface, or \
         nodes that span one"
    )]
    FixedOnLine {
        /// Name of the body.
        body: String,
        /// Number of fixed nodes.
        count: usize,
    },
    /// A seat that shares nodes with what is fixed.
    #[error(
        "body \"{body}\": node {node} of {seat} is fixed as well; a seat that does not move is \
         `support = \"clamped\"`, so {advice}"
    )]
    FixedSeat {
        /// Name of the body.
        body: String,
        /// The seat, in words.
        seat: String,
        /// Node, as its source numbers it.
        node: u64,
        /// What to do.
        advice: &'static str,
    },
    /// The seat is no cylinder about z.
    #[error(
        "{what} is no cylinder about the z axis: node {node} lies at a radius of {radius_mm:.4} mm, most others at \
         {most_mm:.4} mm; {advice}"
    )]
    NoCylinder {
        /// The seat.
        what: String,
        /// The farthest node.
        node: u64,
        /// Its radius, mm.
        radius_mm: f64,
        /// Median radius, mm.
        most_mm: f64,
        /// What to do.
        advice: &'static str,
    },
    /// Ring and seat of the body have different radii.
    #[error(
        "the seat of body \"{body}\" has a radius of {found_mm:.4} mm, that of the ring has {expected_mm:.4} mm; \
         expected the same to {limit} %, so check {advice}{unit}"
    )]
    Radius {
        /// Name of the body.
        body: String,
        /// Of the body, mm.
        found_mm: f64,
        /// Of the ring, mm.
        expected_mm: f64,
        /// Allowed difference, per cent.
        limit: f64,
        /// The keys to check.
        advice: &'static str,
        /// The unit that would fit, as a remark.
        unit: String,
    },
    /// Ring and seat of the body have different widths.
    #[error(
        "the seat of body \"{body}\" is {found_mm:.4} mm wide, that of the ring {expected_mm:.4} mm; expected the same \
         to {limit} %: {advice}"
    )]
    Width {
        /// Name of the body.
        body: String,
        /// Of the body, mm.
        found_mm: f64,
        /// Of the ring, mm.
        expected_mm: f64,
        /// Allowed difference, per cent.
        limit: f64,
        /// What to do.
        advice: &'static str,
    },
    /// The ring stands beside its seat.
    #[error(
        "the ring stands beside {what}: its middle lies {beside_mm:.4} mm along z from that of the seat, which is \
         {width_mm:.4} mm wide; expected at most {most_mm:.4} mm: give another z of the seat, or none for its middle \
         in the body"
    )]
    Beside {
        /// The seat.
        what: String,
        /// Distance of the middles, mm.
        beside_mm: f64,
        /// Width of the ring's seat, mm.
        width_mm: f64,
        /// Allowed distance, mm.
        most_mm: f64,
    },
    /// A reference node that is not on the axis of the ring.
    #[error(
        "{what} lies {off_mm:.4} mm off the z axis, that of the ring in its seat; expected at most {most_mm:.4} mm: \
         give the file `nodes` in a frame whose z is the axis of the seat, or check reference_node and length_unit"
    )]
    OffAxis {
        /// The node.
        what: String,
        /// Distance from the axis, mm.
        off_mm: f64,
        /// Allowed distance, mm.
        most_mm: f64,
    },
    /// The nodes of a seat do not tell the functions apart.
    #[error(
        "{what} has {nodes} nodes, too few or too uneven for {functions} functions of the seat in each \
         direction (waves up to order N need more than 2 N nodes round it); {advice}, \
         or fewer harmonics or across"
    )]
    TooFewNodes {
        /// The seat.
        what: String,
        /// Its nodes.
        nodes: usize,
        /// Functions of a component.
        functions: usize,
        /// What to do.
        advice: &'static str,
    },
    /// A file of a body cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Reason of the system.
        source: std::io::Error,
    },
    /// A file of a body is not as it should be.
    #[error("{}{}: {problem}", path.display(), at(*line))]
    File {
        /// The file.
        path: PathBuf,
        /// Line from 1; 0: the file as a whole.
        line: usize,
        /// What is wrong, what was expected, what to do.
        problem: String,
    },
    /// A whole stiffness that a rigid motion strains.
    #[error(
        "body \"{body}\": the stiffness is not that of a free body: {found}, because fixed_nodes hold the body: export \
         the stiffness without supports and springs to ground, in the frame and unit of the nodes; of a body on \
         springs give the feet as nodes of the matrix and name them in fixed_nodes, or take out the rows of held nodes \
         and leave fixed_nodes away"
    )]
    StrainedByMotion {
        /// Name of the body.
        body: String,
        /// The motion, the largest force and what was expected.
        found: String,
    },
    /// A mass that a motion makes negative.
    #[error(
        "body \"{body}\": the mass matrix is not positive: elimination fails at node {node} in {axis}, so it and nodes \
         around could move with a negative kinetic energy; correct the entries there, or export the mass once more"
    )]
    MassNotPositive {
        /// Name of the body.
        body: String,
        /// Node, as its source numbers it.
        node: u64,
        /// Direction.
        axis: &'static str,
    },
    /// The matrix is not symmetric.
    #[error(
        "{}: the stiffness is not symmetric: node {} {} with node {} {} has {value:e}, the other way round {other:e}; \
         expected equal to 1e-8 of the diagonal, so export the stiffness of a linear static step without friction or \
         follower loads", path.display(), places[0].0, places[0].1, places[1].0, places[1].1
    )]
    NotSymmetric {
        /// The file.
        path: PathBuf,
        /// Node number and direction of row and column.
        places: [(u64, &'static str); 2],
        /// Entry.
        value: f64,
        /// Its mirror image.
        other: f64,
    },
    /// Finite elements failed.
    #[error("body \"{body}\": {source}")]
    Fem {
        /// Name of the body.
        body: String,
        /// Cause.
        source: FemError,
    },
    /// The factorisation failed otherwise.
    #[error("body \"{body}\": {source}")]
    Solver {
        /// Name of the body.
        body: String,
        /// Cause.
        source: SolverError,
    },
}

impl SurroundingError {
    /// The same with what to do about matrices and lists of nodes in the place of meshes and groups.
    pub(crate) fn of_matrices(mut self) -> SurroundingError {
        use SurroundingError::{FixedSeat, NoCylinder, NotHeld, Radius, TooFewNodes, Width};
        match &mut self {
            NotHeld { advice, .. } => *advice = matrix_advice::HELD,
            FixedSeat { advice, .. } => *advice = matrix_advice::FIXED,
            NoCylinder { advice, .. } => *advice = matrix_advice::CYLINDER,
            Radius { advice, .. } => *advice = matrix_advice::RADIUS,
            Width { advice, .. } => *advice = matrix_advice::WIDTH,
            TooFewNodes { advice, .. } => *advice = matrix_advice::NODES,
            _ => (),
        }
        self
    }
}

/// What to do about a mesh.
pub(crate) mod mesh_advice {
    pub const HELD: &str = "name the groups that stand on the ground in `fixed`, and check that the body is one \
                            connected part";
    pub const FIXED: &str = "separate the two groups";
    pub const CYLINDER: &str =
        "move the mesh so that the axis of the seat is z, and choose the facets of the cylinder only";
    pub const RADIUS: &str = "mesh_unit and the group";
    pub const WIDTH: &str = "split the bore of the body in Gmsh where the seat of the ring ends";
    pub const NODES: &str = "use a finer mesh there";
}

/// What to do about matrices.
mod matrix_advice {
    pub const HELD: &str = "list the nodes that stand on the ground in fixed_nodes, or export the stiffness of a body \
                            that is held and one connected part; a stiffness with wrong entries ends here too";
    pub const FIXED: &str = "take it out of fixed_nodes or of seat_nodes";
    pub const CYLINDER: &str = "give the file `nodes` in a frame whose z is the axis of the seat, and list in \
                                seat_nodes nodes of the cylinder only";
    pub const RADIUS: &str = "length_unit, the file `nodes` and the nodes in seat_nodes";
    pub const WIDTH: &str = "list in seat_nodes all nodes of the bore from one end of the seat of the ring to the \
                             other, and check length_unit; the body needs nodes where the seat ends";
    pub const NODES: &str = "list all nodes of the seat in seat_nodes, take a body with more of them";
}

fn at(line: usize) -> String {
    match line {
        0 => String::new(),
        line => format!(", line {line}"),
    }
}
