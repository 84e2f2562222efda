//! `raceway mesh`: builds the ring meshes that a scene describes in `[inner.section]` and `[outer.section]`.
//!
//! Gmsh meshes the section (or the whole ring, for tetrahedra); hexahedra are made by revolving the section into
//! equal sectors. The section's .geo and .msh stay beside the mesh, so that it can be made again. Of a list of bearings
//! each mesh file is built once, for all bearings that name it.

use std::io::Write;
use std::path::{Path, PathBuf};

use comm::print;
use contact::Side;
use mesh::{ElementKind, Gmsh, Mesh, Overwrite, RingSection};

use crate::error::BuildError;
use crate::section_record::{disagreements, record};
use crate::tables::{
    AnyScene, FlexibleRing, MeshFiles, MeshedSection, Ring, RingName, Scene, SectionElement,
};

/// Length unit of the files that Gmsh reads and writes, m.
const GMSH_UNIT: f64 = 1e-3;

/// Builds the meshes of a scene; `overwrite` replaces existing files.
pub fn build_meshes(
    path: &Path,
    overrides: &[String],
    overwrite: Overwrite,
    gmsh: Gmsh<'_>,
) -> Result<(), BuildError> {
    let scene = AnyScene::load_with(path, overrides, MeshFiles::MayBeMissing)?;
    let scenes: Vec<&Scene> = match &scene {
        AnyScene::One(scene) => vec![scene],
        AnyScene::Several(list) => list.bearings.iter().map(|bearing| &bearing.scene).collect(),
    };
    say_assumed(&scenes);
    let jobs = jobs(&scenes)?;
    if jobs.is_empty() {
        return Err(BuildError::NoSection {
            path: path.to_path_buf(),
        });
    }
    let is_kept = |job: &Job<'_>| overwrite == Overwrite::Refuse && job.body.mesh.exists();
    let (kept, wanted): (Vec<Job<'_>>, Vec<Job<'_>>) = jobs.into_iter().partition(is_kept);
    if let (Some(first), true) = (kept.first(), wanted.is_empty()) {
        return Err(BuildError::Exists {
            path: first.body.mesh.clone(),
        });
    }
    for job in &kept {
        let path = job.body.mesh.display();
        print::note(format_args!(
            "{path} exists already and is kept; --force replaces it"
        ));
    }
    wanted.iter().try_for_each(|job| build_file(job, overwrite, gmsh))
}

/// Says once what bearings leave open.
fn say_assumed(scenes: &[&Scene]) {
    let mut said: Vec<&String> = Vec::new();
    for line in scenes.iter().flat_map(|scene| &scene.assumed) {
        if !said.contains(&line) {
            print::note(format_args!("assumed: {line}"));
            said.push(line);
        }
    }
}

/// A mesh file to build.
struct Job<'a> {
    scene: &'a Scene,
    side: RingName,
    body: &'a FlexibleRing,
    section: &'a MeshedSection,
}

impl Job<'_> {
    /// What the mesh is made from.
    fn record(&self) -> String {
        record(
            self.scene,
            Side::BOTH[self.side as usize],
            self.body,
            self.section,
        )
    }
}

/// The rings with a section, each file once. Fails where bearings ask for two meshes in one file.
fn jobs<'a>(scenes: &[&'a Scene]) -> Result<Vec<Job<'a>>, BuildError> {
    let mut jobs: Vec<Job<'a>> = Vec::new();
    for job in scenes.iter().flat_map(|scene| of_scene(scene)) {
        let Some(first) = jobs.iter().find(|other| other.body.mesh == job.body.mesh) else {
            jobs.push(job);
            continue;
        };
        let differences = disagreements(&first.record(), &job.record());
        if !differences.is_empty() {
            return Err(BuildError::TwoInOne {
                path: job.body.mesh.clone(),
                differences: differences.join(", "),
            });
        }
    }
    Ok(jobs)
}

/// The rings of a bearing that have a section.
fn of_scene(scene: &Scene) -> impl Iterator<Item = Job<'_>> {
    let rings = [(RingName::Inner, &scene.inner), (RingName::Outer, &scene.outer)];
    rings
        .into_iter()
        .filter_map(move |(side, ring)| job(scene, side, ring))
}

/// Builds those meshes of a scene that it describes and that do not exist.
pub fn build_missing(scene: &Scene, gmsh: Gmsh<'_>) -> Result<(), BuildError> {
    for job in of_scene(scene).filter(|job| !job.body.mesh.exists()) {
        build_file(&job, Overwrite::Refuse, gmsh)?;
    }
    Ok(())
}

fn build_file(job: &Job<'_>, overwrite: Overwrite, gmsh: Gmsh<'_>) -> Result<(), BuildError> {
    let body = job.body;
    let mesh = build_ring(job.scene, job.side, (body, job.section), gmsh)?;
    mesh::write_msh_with_record(&body.mesh, &mesh, body.mesh_unit, overwrite, &job.record())?;
    print::line(format_args!(
        "{}: {} {} elements, {} nodes, {} dofs",
        body.mesh.display(),
        mesh.n_elements(),
        mesh.kind.name(),
        mesh.n_nodes(),
        mesh.n_dofs()
    ));
    Ok(())
}

fn job<'a>(scene: &'a Scene, side: RingName, ring: &'a Ring) -> Option<Job<'a>> {
    Some(Job {
        scene,
        side,
        body: ring.body.as_ref()?,
        section: ring.section.as_ref()?,
    })
}

fn build_ring(
    scene: &Scene,
    side: RingName,
    (body, section): (&FlexibleRing, &MeshedSection),
    gmsh: Gmsh<'_>,
) -> Result<Mesh, BuildError> {
    let measures = section.measures(&scene.bearing, side);
    if let Some(folder) = body.mesh.parent() {
        std::fs::create_dir_all(folder).map_err(file_error("create", folder))?;
    }
    let geo = beside(&body.mesh, "geo");
    let mut mesh = match section.element {
        SectionElement::Tet10 => {
            let size = measures.width / (2 * section.shoulder_elements + section.groove_elements) as f64;
            let msh = beside(&body.mesh, "gmsh.msh");
            write_geo(&geo, &msh, &mesh::ring_tet_geo(&measures, size)?)?;
            mesh::mesh_tets_with_gmsh(gmsh, &geo, &msh)?;
            let mesh = mesh::read_msh(&msh, GMSH_UNIT)?;
            std::fs::remove_file(&msh).map_err(file_error("remove", &msh))?;
            mesh
        }
        SectionElement::Hex8 => revolved(&measures, &geo, (body, section), gmsh, ElementKind::Hex8)?,
        SectionElement::Hex20 => revolved(&measures, &geo, (body, section), gmsh, ElementKind::Hex20)?,
    };
    mesh.nodes.iter_mut().for_each(|x| x[2] += body.groove_z);
    Ok(mesh)
}

fn revolved(
    measures: &RingSection,
    geo: &Path,
    (body, section): (&FlexibleRing, &MeshedSection),
    gmsh: Gmsh<'_>,
    kind: ElementKind,
) -> Result<Mesh, BuildError> {
    let msh = beside(&body.mesh, "section.msh");
    write_geo(geo, &msh, &mesh::ring_geo(measures)?)?;
    mesh::mesh_section_with_gmsh(gmsh, geo, &msh)?;
    let flat = mesh::read_section(&msh, GMSH_UNIT)?;
    Ok(mesh::revolve(
        &flat,
        section.sectors,
        kind,
        &[measures.geometry()?.snap()],
    )?)
}

/// The mesh's path with another ending.
pub(crate) fn beside(mesh: &Path, ending: &str) -> PathBuf {
    mesh.with_extension(ending)
}

/// Writes the geometry of a ring: whole or not at all, and only over one that was written here. What Gmsh makes of it
/// has no place for a mark; it is known by the geometry beside it.
pub(crate) fn write_geo(path: &Path, msh: &Path, text: &str) -> Result<(), BuildError> {
    require_own(path).map_err(file_error("write", path))?;
    let is_own = msh
        .symlink_metadata()
        .map_or(true, |data| data.is_file() && path.exists());
    if !is_own {
        return Err(file_error("write", msh)(foreign()));
    }
    let write = || {
        let hidden = path.with_extension("geo.tmp");
        // What a killed process left; it is gone if there was none.
        let _ = std::fs::remove_file(&hidden);
        std::fs::File::create_new(&hidden)?.write_all(text.as_bytes())?;
        std::fs::rename(&hidden, path)
    };
    write().map_err(file_error("write", path))
}

/// Words in the first line of every geometry.
const OWN: &str = " ring of a ball bearing; lengths in mm";

fn require_own(path: &Path) -> std::io::Result<()> {
    let Ok(data) = path.symlink_metadata() else {
        return Ok(());
    };
    if data.is_file() && String::from_utf8_lossy(&std::fs::read(path)?).contains(OWN) {
        return Ok(());
    }
    Err(foreign())
}

fn foreign() -> std::io::Error {
    let what = "it was not written by raceway mesh; move it away";
    std::io::Error::new(std::io::ErrorKind::AlreadyExists, what)
}

pub(crate) fn file_error(action: &'static str, path: &Path) -> impl Fn(std::io::Error) -> BuildError {
    let path = path.to_path_buf();
    move |source| BuildError::File {
        action,
        path: path.clone(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a geometry of the user's beside a mesh would be written over.
    #[test]
    fn only_own_geometries_are_written_over() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("inner.geo");
        let text = format!("// inner{OWN}\n");
        let msh = dir.path().join("inner.section.msh");
        (0..2).for_each(|_| write_geo(&path, &msh, &text).unwrap());
        std::fs::write(&path, "Point(1) = {0, 0, 0};").unwrap();
        let said = with_cause(&write_geo(&path, &msh, &text).unwrap_err());
        assert!(
            said.contains("it was not written by raceway mesh; move it away"),
            "{said}"
        );
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "Point(1) = {0, 0, 0};");
        // A section of the user's, without a geometry beside it.
        std::fs::remove_file(&path).unwrap();
        std::fs::write(&msh, "$MeshFormat").unwrap();
        let said = with_cause(&write_geo(&path, &msh, &text).unwrap_err());
        assert!(
            said.contains("inner.section.msh") && said.contains("not written by raceway mesh"),
            "{said}"
        );
        assert!(!path.exists());
    }

    /// A message with its cause.
    fn with_cause(error: &BuildError) -> String {
        let cause = std::error::Error::source(error).map(|cause| cause.to_string());
        format!("{error} {}", cause.unwrap_or_default())
    }
}
