//! Everything that can be wrong with a mesh, a section or a file of either.

use std::fmt;
use std::path::PathBuf;

use thiserror::Error;

use crate::torus::Torus;

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Line of a text file, from 1.
    Line(usize),
    /// Byte offset in a binary file, from 0.
    Byte(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// An error of this crate. Elements and nodes are named by their Gmsh tags.
#[derive(Debug, Error)]
pub enum MeshError {
    /// The operating system refused to read or write.
    #[error("cannot {action} {path}: {source}")]
    Io {
        /// What was tried: `read`, `write`, `rename`.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The cause.
        source: std::io::Error,
    },
    /// The file is not a Gmsh mesh at all.
    #[error(
        "{path} is not a gmsh mesh: expected \"$MeshFormat\" first, found {found}; write one with \
         `gmsh -3 -format msh41`"
    )]
    Foreign {
        /// The file.
        path: PathBuf,
        /// How it begins.
        found: String,
    },
    /// A version or encoding that is not read.
    #[error(
        "{path} is in {found}, which is not read; expected MSH 4.1 (text or binary) or MSH 2.2 (text), \
         convert it with `gmsh {path} -save -format msh41 -o new.msh`"
    )]
    UnsupportedVersion {
        /// The file.
        path: PathBuf,
        /// Version and encoding found.
        found: String,
    },
    /// The file stops early or holds something else than its format says.
    #[error(
        "{path}, {place}: expected {expected}, found {found}; the file is truncated or damaged, write it again"
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Where.
        place: Place,
        /// What the format asks for.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A header announces another number of things than follow.
    #[error(
        "{path}, {place}: the header announces {announced} {what}, but there are {found}; write the file again"
    )]
    CountMismatch {
        /// The file.
        path: PathBuf,
        /// Where the count was found wrong.
        place: Place,
        /// What is counted.
        what: &'static str,
        /// Number in the header.
        announced: u64,
        /// Number found or possible.
        found: String,
    },
    /// The metres per mesh unit make no sense.
    #[error("mesh unit {unit} m is not a length; expected a positive number, such as 0.001 for millimetres")]
    BadUnit {
        /// The unit given.
        unit: f64,
    },
    /// Two nodes or two elements have the same tag.
    #[error(
        "{path} has two {what}s with tag {tag}; tags must be unique, renumber the mesh in gmsh and write it again"
    )]
    DuplicateTag {
        /// The file.
        path: PathBuf,
        /// `node` or `element`.
        what: &'static str,
        /// The tag.
        tag: u64,
    },
    /// A coordinate is NaN or infinite.
    #[error("{path}: node {node} has the coordinates {at}, which are not finite; mesh the geometry again")]
    NonFinite {
        /// The file.
        path: PathBuf,
        /// Node tag.
        node: u64,
        /// The coordinates as read.
        at: String,
    },
    /// An element names a node the file does not define.
    #[error(
        "{path}: element {element} names node {node}, which the file does not define; write the file again"
    )]
    UnknownNode {
        /// The file.
        path: PathBuf,
        /// Element tag.
        element: u64,
        /// Node tag.
        node: u64,
    },
    /// The group that says which elements are the body is missing.
    #[error(
        "{path} has no physical {kind} \"{name}\" with elements; physical {kind}s are {groups}; name the {name}'s \
         {kind} so in the .geo: Physical {kind}(\"{name}\") = {{...}};"
    )]
    NoBody {
        /// The file.
        path: PathBuf,
        /// `Volume` or `Surface`.
        kind: &'static str,
        /// The name wanted.
        name: &'static str,
        /// The names there.
        groups: String,
    },
    /// Elements that are not read.
    #[error(
        "{path}: \"ring\" holds {count} elements of type {found} (the first is element {element}); expected \
         {expected}; {remedy}"
    )]
    UnsupportedElement {
        /// The file.
        path: PathBuf,
        /// Name of the element type.
        found: String,
        /// How many.
        count: usize,
        /// Tag of the first.
        element: u64,
        /// What is read.
        expected: &'static str,
        /// What to try.
        remedy: &'static str,
    },
    /// More than one kind of volume element.
    #[error(
        "{path}: \"ring\" mixes {found}; expected elements of one kind; recombine all of it, or none, and mesh again"
    )]
    MixedKinds {
        /// The file.
        path: PathBuf,
        /// Kinds and their counts.
        found: String,
    },
    /// A facet in two groups that exclude each other.
    #[error(
        "{path}: a face of element {element} is in group \"{first}\" and in group \"{second}\"; expected each in \
         one of them, as what holds the ring would hold its raceway there"
    )]
    InBothGroups {
        /// The file.
        path: PathBuf,
        /// Tag of the volume element.
        element: u64,
        /// One group.
        first: String,
        /// The other.
        second: String,
    },
    /// Two elements at one place.
    #[error(
        "{path}: elements {first} and {second} have the same corners, so the body would be twice as stiff and heavy \
         there; expected each element once: remove the copies, in gmsh by \
         `gmsh.model.mesh.removeDuplicateElements()`"
    )]
    SameCorners {
        /// The file.
        path: PathBuf,
        /// Tag of the first element.
        first: u64,
        /// Tag of the second.
        second: u64,
    },
    /// A named boundary element that is not a boundary of the body.
    #[error(
        "{path}: element {element} of group \"{group}\" is {problem}; expected a boundary face of exactly one element \
         of \"ring\"; correct the group in the .geo"
    )]
    NotBoundary {
        /// The file.
        path: PathBuf,
        /// Group name.
        group: String,
        /// Tag of the boundary element.
        element: u64,
        /// What it is instead.
        problem: &'static str,
    },
    /// A facet group that is needed is missing or empty.
    #[error(
        "mesh {path} has {problem} facet group \"{name}\"; groups are {groups}; name it in the .geo: Physical \
         Surface(\"{name}\") = {{...}};"
    )]
    MissingGroup {
        /// The file.
        path: PathBuf,
        /// `no` or `an empty`.
        problem: &'static str,
        /// The name wanted.
        name: String,
        /// The names there.
        groups: String,
    },
    /// A group that is a part of its surface only.
    #[error(
        "{path}: group \"{group}\" has {circle:.1} % of the circle and {area:.1} % of the area of its surface: \
         {missing} of {total} faces on it are in no group or in another one (the first is of element {element}); \
         expected the whole surface; add them to the group in the .geo, or, if a part is meant, {remedy}"
    )]
    PartialGroup {
        /// The file.
        path: PathBuf,
        /// Group name.
        group: Box<str>,
        /// Share of the circle in which it has facets, %.
        circle: f64,
        /// Share of the area, %.
        area: f64,
        /// Faces that it lacks.
        missing: usize,
        /// Faces on the surface.
        total: usize,
        /// Tag of the element of the first that it lacks.
        element: u64,
        /// What to do if a part is meant.
        remedy: Box<str>,
    },
    /// An element is inside out or flat.
    #[error(
        "{path}: element {element} is {problem}, its jacobian determinant falls to {worst:.3e} of a mean {mean:.3e} \
         ({count} such elements); expected a positive one everywhere; refine or smooth the mesh there, or turn the \
         element's nodes round"
    )]
    BadElement {
        /// The file.
        path: PathBuf,
        /// Tag of the worst element.
        element: u64,
        /// `inverted` or `degenerate`.
        problem: &'static str,
        /// Smallest determinant, in cubic (or square) mesh units.
        worst: f64,
        /// Mean of its absolute values at the same points.
        mean: f64,
        /// How many elements are bad.
        count: usize,
    },
    /// Two nodes at one place.
    #[error(
        "{path}: nodes {first} and {second} coincide ({distance:.3e} m apart, elements there are {size:.3e} m in \
         size); expected one node per place; use Coherence in the .geo or Mesh > Remove duplicate nodes"
    )]
    CoincidentNodes {
        /// The file.
        path: PathBuf,
        /// Tag of one node.
        first: u64,
        /// Tag of the other.
        second: u64,
        /// Their distance, m.
        distance: f64,
        /// Size of the smaller element at them, m.
        size: f64,
    },
    /// Nodes no volume element uses.
    #[error(
        "{path}: node {node} is used by no {kind} element ({count} such nodes); expected none, they make the stiffness \
         singular; save without -save_all, or delete the point they are on"
    )]
    OrphanNodes {
        /// The file.
        path: PathBuf,
        /// Tag of the first.
        node: u64,
        /// `volume` or `surface`.
        kind: &'static str,
        /// How many.
        count: usize,
    },
    /// The body is in several pieces.
    #[error(
        "{path}: the ring is in {parts} unconnected parts (element {element} begins one of {count} elements); expected \
         one part; merge the interfaces (Coherence) or keep one ring per file"
    )]
    Disconnected {
        /// The file.
        path: PathBuf,
        /// Number of parts.
        parts: usize,
        /// Tag of the first element of the smallest part.
        element: u64,
        /// Elements in that part.
        count: usize,
    },
    /// The raceway of the mesh is not the raceway of the bearing.
    #[error(
        "{path}: node {node} of group \"{group}\" is {deviation:.3e} m off the groove torus (centre circle radius \
         {:.6e} m at z = {:.6e} m, groove radius {:.6e} m), more than {tolerance:.1e} m \
         ({count} of {total} nodes are); expected a mesh of this bearing's groove; {advice}",
        torus.centre_radius, torus.centre_z, torus.groove_radius
    )]
    OffTorus {
        /// What to look at, or what would make it fit.
        advice: Box<str>,
        /// The file.
        path: PathBuf,
        /// Group checked.
        group: Box<str>,
        /// Tag of the worst node.
        node: u64,
        /// Its signed distance from the torus surface, positive outside the tube, m.
        deviation: f64,
        /// The groove.
        torus: Torus,
        /// Tolerance, m.
        tolerance: f64,
        /// Nodes beyond it.
        count: usize,
        /// Nodes of the group.
        total: usize,
    },
    /// The unit of the mesh is evidently another one.
    #[error(
        "{path}: with a mesh unit of {unit} m the ring is {measured:.4e} m across, expected about \
         {expected:.4e} m; {advice}"
    )]
    WrongUnit {
        /// The file.
        path: PathBuf,
        /// Unit used, m.
        unit: f64,
        /// Diameter found, m.
        measured: f64,
        /// Diameter expected, m.
        expected: f64,
        /// Which unit fits.
        advice: String,
    },
    /// A facet in two groups cannot be written.
    #[error(
        "cannot write {path}: face {face} of element {element} is in the groups \"{first}\" and \"{second}\"; \
         expected each facet in one group, take it out of one"
    )]
    OverlappingGroups {
        /// The file.
        path: PathBuf,
        /// Element tag as it would be written.
        element: u64,
        /// Local face.
        face: usize,
        /// One group.
        first: String,
        /// The other.
        second: String,
    },
    /// A mesh or group cannot be written as it is.
    #[error("cannot write {path}: {problem}")]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        problem: String,
    },
    /// The file to write is there already.
    #[error(
        "{path} exists already and is not overwritten; choose another name, move it away, or ask for it to be replaced"
    )]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// Something else about a section.
    #[error("section {path}: {problem}")]
    Section {
        /// The file.
        path: PathBuf,
        /// What is wrong, where, and what to try.
        problem: String,
    },
    /// The shape of a mesh is no body of revolution about the axis z.
    #[error("{path} is not a body of revolution about the axis z: {problem}")]
    NotRevolved {
        /// The file.
        path: PathBuf,
        /// Where it is not, by how much, and what to try.
        problem: Box<str>,
    },
    /// A facet group of a body of revolution does not go round the axis.
    #[error(
        "{path}: group \"{group}\" ends between the nodes {} and {} (azimuth {azimuth:.2} deg, r = {r:.4} mm, \
         z = {z:.4} mm), not on a circle about the axis; expected groups that go all round the ring, so that all \
         sectors are equal", nodes[0], nodes[1]
    )]
    GroupNotRound {
        /// The file.
        path: PathBuf,
        /// The group.
        group: String,
        /// Tags of two nodes between which it ends.
        nodes: [u64; 2],
        /// Azimuth of the first, degrees.
        azimuth: f64,
        /// Its radius, mm.
        r: f64,
        /// Its axial position, mm.
        z: f64,
    },
    /// The section cannot be revolved as asked.
    #[error("cannot revolve the section: {problem}")]
    Revolve {
        /// What is wrong and what to try.
        problem: String,
    },
    /// Measures of a ring that do not make a ring.
    #[error("{name} is {value}; {expected}")]
    Measure {
        /// The measure, as a scene names it.
        name: &'static str,
        /// Its value with unit.
        value: String,
        /// What was expected, and why.
        expected: String,
    },
    /// There is no gmsh to mesh with.
    #[error(
        "the program gmsh was not found, it is needed to mesh {path}; install it (Debian, Ubuntu: `apt-get install \
         gmsh`; any system: `pip install gmsh`) or mesh the file on another machine"
    )]
    NoGmsh {
        /// The geometry that was to be meshed.
        path: PathBuf,
    },
    /// Gmsh failed.
    #[error("gmsh could not mesh {path} ({status}): {output}; run `gmsh {path}` to see the geometry")]
    GmshFailed {
        /// The geometry.
        path: PathBuf,
        /// Exit status.
        status: String,
        /// The last lines it printed.
        output: String,
    },
}

/// `"a", "b"` for messages, or `none`.
pub(crate) fn quoted_list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.into_iter().map(|name| format!("\"{name}\"")).collect();
    if quoted.is_empty() {
        "none".to_string()
    } else {
        quoted.join(", ")
    }
}
