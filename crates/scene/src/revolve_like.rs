//! `raceway mesh --revolve-like`: the periodic mesh of a ring whose shape is a body of revolution though its mesh is
//! not.
//!
//! The outline of the section is found from the surface of the mesh ([`mesh::find_revolution`]), Gmsh meshes it in
//! quads, and it is revolved into equal sectors, with the facet groups that the mesh has.

use std::path::{Path, PathBuf};

use mesh::{
    Gmsh, GrooveOfOutline, Mesh, MeshError, NotRevolved, Origin, OutlinePiece, Overwrite, REVOLVED_TOLERANCE,
    Revolution, SectionFineness, find_revolution,
};

use crate::error::BuildError;
use crate::meshing::{beside, file_error, write_geo};

/// What is asked for.
#[derive(Clone, Debug)]
pub struct RevolveLike {
    /// The mesh of a ring.
    pub ring: PathBuf,
    /// Length unit of that mesh and of the new one, m.
    pub mesh_unit: f64,
    /// The mesh to write.
    pub out: PathBuf,
    /// How far nodes may be off the section, m; none: [`REVOLVED_TOLERANCE`] of the largest radius.
    pub tolerance: Option<f64>,
    /// How finely the new mesh is divided.
    pub fineness: SectionFineness,
    /// Whether existing files are replaced.
    pub overwrite: Overwrite,
}

/// What was found and made.
#[derive(Clone, Debug)]
pub struct MadeLike {
    /// The ring that was given.
    pub given: Mesh,
    /// Its section.
    pub revolution: Revolution,
    /// How far nodes may be off the section, m.
    pub tolerance: f64,
    /// The outline with the groups of the mesh.
    pub outline: Vec<OutlinePiece>,
    /// Its groove.
    pub groove: GrooveOfOutline,
    /// The new mesh.
    pub mesh: Mesh,
    /// Volume of the new mesh, m3.
    pub volume: f64,
    /// Largest distance of the edges of its section from the outline, m.
    pub section_distance: f64,
}

/// Finds the section of a ring's mesh, and writes the periodic mesh of it.
pub fn revolve_like(request: &RevolveLike, gmsh: Gmsh<'_>) -> Result<MadeLike, BuildError> {
    let (ring, out) = (&request.ring, &request.out);
    if same_file(ring, out) {
        return Err(BuildError::OwnSource { path: out.clone() });
    }
    if request.overwrite == Overwrite::Refuse && out.exists() {
        return Err(BuildError::Exists { path: out.clone() });
    }
    let (given, origin) = mesh::read_msh_with_origin(ring, request.mesh_unit)?;
    let radii = given.nodes.iter().map(|x| x[0].hypot(x[1]));
    let tolerance = request
        .tolerance
        .unwrap_or(REVOLVED_TOLERANCE * radii.fold(0.0, f64::max));
    let revolution = find_revolution(&given, tolerance).map_err(|reason| not_revolved(&origin, &reason))?;
    let outline = mesh::group_outline(&given, &origin, &revolution, tolerance)?;
    let groove = mesh::groove_of(&outline, ring, tolerance)?;
    if let Some(folder) = out.parent() {
        std::fs::create_dir_all(folder).map_err(file_error("create", folder))?;
    }
    let (geo, msh) = (beside(out, "geo"), beside(out, "section.msh"));
    write_geo(
        &geo,
        &msh,
        &mesh::outline_geo(&outline, &groove, &request.fineness)?,
    )?;
    mesh::mesh_section_with_gmsh(gmsh, &geo, &msh)?;
    let made = mesh::revolve_outline(&outline, &groove, &request.fineness, &msh)?;
    let record = record(request);
    mesh::write_msh_with_record(out, &made.mesh, request.mesh_unit, request.overwrite, &record)?;
    Ok(MadeLike {
        volume: mesh::volume(&made.mesh),
        section_distance: made.section_distance,
        mesh: made.mesh,
        given,
        revolution,
        tolerance,
        outline,
        groove,
    })
}

/// The error that a mesh is no body of revolution, with what to do.
fn not_revolved(origin: &Origin, reason: &NotRevolved) -> MeshError {
    let remedy = match reason {
        NotRevolved::Off(off) => format!(
            " (node {}); a ring with a hole, a keyway or a slit keeps its free mesh, or takes the periodic mesh of the \
             ring without it and [[inner.cut]]; a rough mesh takes a larger --tolerance",
            origin.node_tags[off.node]
        ),
        NotRevolved::OnAxis { node } => format!(" (node {})", origin.node_tags[*node]),
        NotRevolved::Curves { .. } | NotRevolved::OtherAxis(_) => String::new(),
    };
    MeshError::NotRevolved {
        path: origin.path.clone(),
        problem: format!("{reason}{remedy}").into(),
    }
}

fn same_file(a: &Path, b: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    a == b || real(a).is_some_and(|a| real(b) == Some(a))
}

/// What the new mesh was made from, in its file.
fn record(request: &RevolveLike) -> String {
    let f = &request.fineness;
    let name = request.ring.file_name().unwrap_or_default().to_string_lossy();
    // A record is one line of plain text.
    let name: String = name.chars().filter(|c| !c.is_control() && *c != '$').collect();
    format!(
        "revolve_like = {name}; element = {}; sectors = {}; groove_elements = {}; thickness_elements = {}; \
         grading = {}",
        f.kind.name(),
        f.sectors,
        f.groove_elements,
        f.thickness_elements,
        f.grading
    )
}
