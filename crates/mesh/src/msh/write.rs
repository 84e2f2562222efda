//! Writes a mesh as MSH 4.1, text or binary, with its physical names.
//!
//! One volume entity holds the elements (physical volume `ring`), one surface entity each facet group. Tags count
//! from 1 in the order of the mesh, volume elements first. Coordinates are divided by the unit: a file read back
//! agrees to one unit in the last place, exactly when the unit is 1.

use std::collections::BTreeMap;
use std::io::{BufWriter, Read, Write};
use std::path::Path;

use super::record::section;
use super::{BODY, check_scale};
use crate::error::MeshError;
use crate::mesh::{Facet, Mesh};

/// What every mesh file begins with.
const HEAD: [u8; 11] = *b"$MeshFormat";

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MshFormat {
    /// Text; numbers with as many digits as it takes to read the same bits.
    Ascii,
    /// Binary, little endian.
    Binary,
}

/// What to do when the file exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// An error.
    Refuse,
    /// The old file is replaced, in one step when the new one is complete.
    Replace,
}

/// Writes `mesh` in units of `unit` metres. The file appears complete or not at all.
pub fn write_msh(
    path: impl AsRef<Path>,
    mesh: &Mesh,
    unit: f64,
    format: MshFormat,
    overwrite: Overwrite,
) -> Result<(), MeshError> {
    write(path.as_ref(), mesh, unit, format, overwrite, None)
}

/// The same in binary form with one line that says what the mesh was made from, which [`super::record::read_record`]
/// finds.
pub fn write_msh_with_record(
    path: impl AsRef<Path>,
    mesh: &Mesh,
    unit: f64,
    overwrite: Overwrite,
    record: &str,
) -> Result<(), MeshError> {
    write(
        path.as_ref(),
        mesh,
        unit,
        MshFormat::Binary,
        overwrite,
        Some(record),
    )
}

fn write(
    path: &Path,
    mesh: &Mesh,
    unit: f64,
    format: MshFormat,
    overwrite: Overwrite,
    record: Option<&str>,
) -> Result<(), MeshError> {
    check_scale(unit)?;
    check_writable(path, mesh)?;
    if overwrite == Overwrite::Refuse && path.exists() {
        return Err(MeshError::Exists {
            path: path.to_path_buf(),
        });
    }
    require_mesh(path)?;
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".tmp");
    let temporary = Path::new(&temporary);
    let fail = |source| MeshError::Io {
        action: "write",
        path: temporary.to_path_buf(),
        source,
    };
    // What a killed run left under this name goes, also a link; it is gone if there was none.
    let _ = std::fs::remove_file(temporary);
    let file = std::fs::File::create_new(temporary).map_err(fail)?;
    let written = write_file(file, mesh, unit, format, record);
    if let Err(source) = written {
        // The first error is the one to tell; a left-over temporary file harms nobody.
        let _ = std::fs::remove_file(temporary);
        return Err(fail(source));
    }
    std::fs::rename(temporary, path).map_err(|source| MeshError::Io {
        action: "rename the finished file to",
        path: path.to_path_buf(),
        source,
    })
}

/// Fails if there is something at `path` that is no mesh file: it is not replaced.
fn require_mesh(path: &Path) -> Result<(), MeshError> {
    let Ok(data) = path.metadata() else {
        return Ok(());
    };
    let mut head = [0; HEAD.len()];
    let mut read = || std::fs::File::open(path)?.read_exact(&mut head);
    if data.is_file() && read().is_ok() && head == HEAD {
        return Ok(());
    }
    let what = "it is no mesh, so it is not written over; move it away or choose another name";
    Err(MeshError::Io {
        action: "write",
        path: path.to_path_buf(),
        source: std::io::Error::new(std::io::ErrorKind::AlreadyExists, what),
    })
}

fn write_file(
    file: std::fs::File,
    mesh: &Mesh,
    unit: f64,
    format: MshFormat,
    record: Option<&str>,
) -> std::io::Result<()> {
    let mut out = Writer {
        out: BufWriter::new(file),
        format,
    };
    out.write_head(mesh, unit, record)?;
    out.write_nodes(mesh, unit)?;
    out.write_elements(mesh)?;
    out.out.flush()?;
    out.out.get_ref().sync_all()
}

/// Names must be writable in quotes, and no facet in two groups: MSH 4.1 gives each surface element one entity.
fn check_writable(path: &Path, mesh: &Mesh) -> Result<(), MeshError> {
    let mut owner: BTreeMap<Facet, &str> = BTreeMap::new();
    for (name, facets) in &mesh.groups {
        if name.is_empty() || name.len() > 127 || name.contains(['"', '\n', '\r']) {
            let problem = format!(
                "the group name {name:?} does not fit the format; expected 1 to 127 bytes without quotes and line ends"
            );
            return Err(MeshError::Unwritable {
                path: path.to_path_buf(),
                problem,
            });
        }
        for &facet in facets {
            if let Some(first) = owner.insert(facet, name) {
                return Err(MeshError::OverlappingGroups {
                    path: path.to_path_buf(),
                    element: facet.element as u64 + 1,
                    face: facet.face,
                    first: first.to_string(),
                    second: name.clone(),
                });
            }
        }
    }
    if mesh.n_elements() == 0 {
        let problem = "the mesh has no elements; expected at least one".to_string();
        return Err(MeshError::Unwritable {
            path: path.to_path_buf(),
            problem,
        });
    }
    Ok(())
}

struct Writer<W: Write> {
    out: W,
    format: MshFormat,
}

impl<W: Write> Writer<W> {
    fn int(&mut self, value: i32) -> std::io::Result<()> {
        match self.format {
            MshFormat::Ascii => write!(self.out, "{value} "),
            MshFormat::Binary => self.out.write_all(&value.to_le_bytes()),
        }
    }

    fn size(&mut self, value: usize) -> std::io::Result<()> {
        match self.format {
            MshFormat::Ascii => write!(self.out, "{value} "),
            MshFormat::Binary => self.out.write_all(&(value as u64).to_le_bytes()),
        }
    }

    fn real(&mut self, value: f64) -> std::io::Result<()> {
        match self.format {
            MshFormat::Ascii => write!(self.out, "{value:e} "),
            MshFormat::Binary => self.out.write_all(&value.to_le_bytes()),
        }
    }

    /// Ends a record, which only the text form shows.
    fn end_record(&mut self) -> std::io::Result<()> {
        match self.format {
            MshFormat::Ascii => writeln!(self.out),
            MshFormat::Binary => Ok(()),
        }
    }

    /// Ends a section; behind binary data a line end is expected.
    fn end_section(&mut self, name: &str) -> std::io::Result<()> {
        if self.format == MshFormat::Binary {
            writeln!(self.out)?;
        }
        writeln!(self.out, "$End{name}")
    }

    /// Format, names and entities.
    fn write_head(&mut self, mesh: &Mesh, unit: f64, record: Option<&str>) -> std::io::Result<()> {
        let file_type = if self.format == MshFormat::Binary { 1 } else { 0 };
        writeln!(self.out, "$MeshFormat\n4.1 {file_type} 8")?;
        if self.format == MshFormat::Binary {
            self.int(1)?;
        }
        self.end_section("MeshFormat")?;
        if let Some(record) = record {
            self.out.write_all(section(record).as_bytes())?;
        }
        writeln!(self.out, "$PhysicalNames\n{}", mesh.groups.len() + 1)?;
        for (i, name) in mesh.groups.keys().enumerate() {
            writeln!(self.out, "2 {} \"{name}\"", i + 2)?;
        }
        writeln!(self.out, "3 1 \"{BODY}\"\n$EndPhysicalNames\n$Entities")?;
        for count in [0, 0, mesh.groups.len(), 1] {
            self.size(count)?;
        }
        self.end_record()?;
        for (i, name) in mesh.groups.keys().enumerate() {
            let nodes = mesh.group_nodes(name);
            let entity = Entity {
                tag: i as i32 + 1,
                physical: i as i32 + 2,
                n_bounds: 0,
            };
            self.write_entity(entity, nodes.iter().map(|&n| &mesh.nodes[n]), unit)?;
        }
        let entity = Entity {
            tag: 1,
            physical: 1,
            n_bounds: mesh.groups.len(),
        };
        self.write_entity(entity, mesh.nodes.iter(), unit)?;
        self.end_section("Entities")
    }

    fn write_entity<'a>(
        &mut self,
        entity: Entity,
        nodes: impl Iterator<Item = &'a [f64; 3]>,
        unit: f64,
    ) -> std::io::Result<()> {
        let mut bounds: Option<[[f64; 3]; 2]> = None;
        for x in nodes {
            let [low, high] = bounds.get_or_insert([*x, *x]);
            for c in 0..3 {
                low[c] = low[c].min(x[c]);
                high[c] = high[c].max(x[c]);
            }
        }
        self.int(entity.tag)?;
        for value in bounds.unwrap_or_default().iter().flatten() {
            self.real(value / unit)?;
        }
        self.size(1)?;
        self.int(entity.physical)?;
        self.size(entity.n_bounds)?;
        for i in 0..entity.n_bounds {
            self.int(i as i32 + 1)?;
        }
        self.end_record()
    }

    fn write_nodes(&mut self, mesh: &Mesh, unit: f64) -> std::io::Result<()> {
        writeln!(self.out, "$Nodes")?;
        let n = mesh.n_nodes();
        for value in [1, n, 1, n] {
            self.size(value)?;
        }
        self.end_record()?;
        self.write_block_head([3, 1, 0], n)?;
        for tag in 1..=n {
            self.size(tag)?;
            self.end_record()?;
        }
        for x in &mesh.nodes {
            for c in x {
                self.real(c / unit)?;
            }
            self.end_record()?;
        }
        self.end_section("Nodes")
    }

    fn write_elements(&mut self, mesh: &Mesh) -> std::io::Result<()> {
        writeln!(self.out, "$Elements")?;
        let filled = mesh.groups.values().filter(|facets| !facets.is_empty()).count();
        let total = mesh.n_elements() + mesh.groups.values().map(Vec::len).sum::<usize>();
        for value in [filled + 1, total, 1, total] {
            self.size(value)?;
        }
        self.end_record()?;
        self.write_block_head([3, 1, mesh.kind.gmsh_type() as i32], mesh.n_elements())?;
        // The place in our list of Gmsh's node `i`.
        let mut place = vec![0; mesh.kind.n_nodes()];
        for (ours, &gmsh) in mesh.kind.gmsh_order().iter().enumerate() {
            place[gmsh] = ours;
        }
        for e in 0..mesh.n_elements() {
            let nodes = mesh.element(e);
            self.write_element(e + 1, place.iter().map(|&i| nodes[i]))?;
        }
        let mut tag = mesh.n_elements();
        for (i, facets) in mesh
            .groups
            .values()
            .enumerate()
            .filter(|(_, facets)| !facets.is_empty())
        {
            self.write_block_head(
                [2, i as i32 + 1, mesh.kind.facet_kind().gmsh_type() as i32],
                facets.len(),
            )?;
            for &facet in facets {
                tag += 1;
                self.write_element(tag, mesh.facet_nodes(facet))?;
            }
        }
        self.end_section("Elements")
    }

    fn write_block_head(&mut self, head: [i32; 3], count: usize) -> std::io::Result<()> {
        for value in head {
            self.int(value)?;
        }
        self.size(count)?;
        self.end_record()
    }

    fn write_element(&mut self, tag: usize, nodes: impl Iterator<Item = usize>) -> std::io::Result<()> {
        self.size(tag)?;
        for n in nodes {
            self.size(n + 1)?;
        }
        self.end_record()
    }
}

/// An entity of the file: a volume bounded by surfaces 1 to `n_bounds`, or a surface.
#[derive(Clone, Copy)]
struct Entity {
    tag: i32,
    physical: i32,
    n_bounds: usize,
}
