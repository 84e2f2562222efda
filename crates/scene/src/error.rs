//! Why a scene has no model or no meshes.

use std::path::PathBuf;

use assembly::AssemblyError;
use body::SurroundingError;
use contact::ContactError;
use dynamics::DynamicsError;
use fem::FemError;
use mesh::MeshError;
use thiserror::Error;

use crate::tables::SceneError;

/// Failures of building what a scene describes. All of them are those of its user.
#[derive(Debug, Error)]
pub enum BuildError {
    /// The scene cannot be read.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A mesh cannot be read, made or written, or does not fit.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The bearing cannot be.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// A material cannot be.
    #[error(transparent)]
    Fem(#[from] FemError),
    /// An effect cannot be constructed.
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    /// The body round a ring cannot be read, or does not fit.
    #[error(transparent)]
    Body(#[from] SurroundingError),
    /// Two seats of a body stand otherwise than their bearings on the shaft.
    #[error(
        "body \"{body}\": the seat of bearing \"{}\" stands {found_mm:.4} mm along the shaft from that of \"{}\", \
         but with these positions of the bearings it is {expected_mm:.4} mm; expected the same to {limit_mm:.3} mm, \
         so correct bearing.position, body.orientation, the groups of the seats or their z", bearings[1], bearings[0]
    )]
    SeatDistance {
        /// Name of the body.
        body: String,
        /// Names of the bearings.
        bearings: [String; 2],
        /// Distance in the body, mm.
        found_mm: f64,
        /// Distance on the shaft, mm.
        expected_mm: f64,
        /// Allowed difference, mm.
        limit_mm: f64,
    },
    /// A body on the shaft is far from round.
    #[error(
        "body \"{body}\" is on the shaft, but its inertia differs by {found:.1} % from that of a body of revolution, \
         more than {limit} %: unbalance and unequal moments of inertia of a body are not solved; mesh it round, or \
         clamp the ring"
    )]
    NotOfRevolution {
        /// Name of the body.
        body: String,
        /// Difference, %.
        found: f64,
        /// What is allowed, %.
        limit: f64,
    },
    /// The shaft of a list of bearings cannot be.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The wall of a hollow ball is too thin for Hertz's contacts.
    #[error(
        "scene {}: bearing.ball_inner_diameter is {cavity_mm:.4} mm, which leaves a wall of {wall_mm:.3} mm; expected \
         at most {most_mm:.3} mm, a wall of {least_mm:.3} mm: the contacts are Hertz's where the wall is twice the \
         larger semi-axis of their ellipse at 1.5 GPa", path.display()
    )]
    ThinWall {
        /// The scene file.
        path: PathBuf,
        /// Diameter of the cavity, mm.
        cavity_mm: f64,
        /// Wall, mm.
        wall_mm: f64,
        /// Least wall, mm.
        least_mm: f64,
        /// Largest cavity, mm.
        most_mm: f64,
    },
    /// Profiles do not fit the rings.
    #[error("scene {}: {problem}", path.display())]
    Surface {
        /// The scene file.
        path: PathBuf,
        /// What is wrong, and what was expected.
        problem: String,
    },
    /// The cuts of a ring do not fit its mesh.
    #[error("mesh {}: {problem}", path.display())]
    Cut {
        /// The mesh file.
        path: PathBuf,
        /// What is wrong, and what was expected.
        problem: String,
    },
    /// The mesh was made from other values than the scene has.
    #[error(
        "mesh {} was made with {differences}; build the mesh of this scene: {command}, which needs Gmsh, with another \
         {key}.mesh if the old one is to stay",
        path.display()
    )]
    StaleMesh {
        /// The mesh file.
        path: PathBuf,
        /// The values that differ.
        differences: String,
        /// The command that builds it.
        command: String,
        /// The ring: `inner` or `outer`.
        key: &'static str,
    },
    /// Steps that cannot show what happens.
    #[error("scene {}: {}", path.display(), problems.join("; "))]
    Unresolvable {
        /// The scene file.
        path: PathBuf,
        /// A sentence for each.
        problems: Vec<String>,
    },
    /// The scene has no table of a mesh.
    #[error(
        "{} describes no mesh to build: expected [inner.section] or [outer.section] of a flexible ring",
        path.display()
    )]
    NoSection {
        /// The scene file.
        path: PathBuf,
    },
    /// A mesh file would be overwritten.
    #[error(
        "{} exists already; give --force to replace it, or another mesh name in the scene",
        path.display()
    )]
    Exists {
        /// The mesh file.
        path: PathBuf,
    },
    /// Bearings of a list name the same mesh file, but describe different meshes.
    #[error(
        "{} is the mesh of several bearings, which describe it otherwise: {differences}; expected a mesh file for each",
        path.display()
    )]
    TwoInOne {
        /// The mesh file.
        path: PathBuf,
        /// Keys with the value of either.
        differences: String,
    },
    /// A mesh would be written over the one that it is made from.
    #[error("{} is the mesh that is to be revolved; expected another name for the new one", path.display())]
    OwnSource {
        /// The mesh file.
        path: PathBuf,
    },
    /// A file or folder cannot be made or removed.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// What was tried: create, write or remove.
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The reason of the system.
        source: std::io::Error,
    },
}
