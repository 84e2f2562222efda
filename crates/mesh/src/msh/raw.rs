//! What an MSH file says, before it is judged: names, nodes and elements by their tags.

use std::collections::BTreeMap;
use std::path::Path;

use super::block::ElementBlock;
use super::cursor::{Cursor, shown};
use super::{v22, v41};
use crate::error::MeshError;

/// The contents of a file.
#[derive(Default)]
pub(crate) struct RawMsh {
    /// Names of the physical groups by dimension and number.
    pub(crate) names: BTreeMap<(i64, i64), String>,
    /// Tag and coordinates (in the file's unit) of each node, sorted by tag, tags unique, coordinates finite.
    pub(crate) nodes: Vec<(u64, [f64; 3])>,
    /// Sorted tags of nodes that may be mere construction points.
    pub(crate) construction: Vec<u64>,
    /// Elements; their tags are unique.
    pub(crate) blocks: Vec<ElementBlock>,
}

/// The versions that are read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V41,
    V22,
}

impl RawMsh {
    /// Reads a file and checks that it is consistent in itself.
    pub(crate) fn read(path: &Path) -> Result<RawMsh, MeshError> {
        let data = std::fs::read(path).map_err(|source| MeshError::Io {
            action: "read",
            path: path.to_path_buf(),
            source,
        })?;
        RawMsh::parse(path, &data)
    }

    /// The same from bytes; `path` is for messages.
    pub(crate) fn parse(path: &Path, data: &[u8]) -> Result<RawMsh, MeshError> {
        let mut cursor = Cursor::new(path, data);
        let version = read_format(&mut cursor, data)?;
        let mut raw = RawMsh::default();
        let mut entities = v41::Entities::default();
        let (mut has_nodes, mut has_elements) = (false, false);
        while let Some(name) = cursor.section()? {
            match (name, version) {
                ("Nodes", _) if std::mem::replace(&mut has_nodes, true) => {
                    return Err(cursor.damaged("one section $Nodes", "a second"));
                }
                ("Elements", _) if std::mem::replace(&mut has_elements, true) => {
                    return Err(cursor.damaged("one section $Elements", "a second"));
                }
                ("PhysicalNames", _) => read_names(&mut cursor, &mut raw.names)?,
                ("Entities", Version::V41) => v41::read_entities(&mut cursor, &mut entities)?,
                ("PartitionedEntities", Version::V41) => v41::read_partitioned(&mut cursor, &mut entities)?,
                ("Nodes", Version::V41) => raw.nodes = v41::read_nodes(&mut cursor, &mut entities)?,
                ("Elements", Version::V41) => raw.blocks = v41::read_elements(&mut cursor, &mut entities)?,
                ("Nodes", Version::V22) => raw.nodes = v22::read_nodes(&mut cursor)?,
                ("Elements", Version::V22) => raw.blocks = v22::read_elements(&mut cursor)?,
                ("ParametricNodes", Version::V22) => {
                    return Err(unsupported(path, "MSH 2.2 with parametric nodes"));
                }
                _ => {
                    cursor.skip_section(name)?;
                    continue;
                }
            }
            cursor.end(name)?;
        }
        if !has_nodes {
            return Err(cursor.damaged("a section $Nodes", "the end of the file"));
        }
        if !has_elements {
            return Err(cursor.damaged("a section $Elements", "the end of the file"));
        }
        if version == Version::V41 {
            entities.assign(&mut raw.blocks);
            raw.construction = entities.take_construction();
        }
        raw.check(path)?;
        Ok(raw)
    }

    /// Sorts the nodes and checks tags, coordinates and connectivity.
    fn check(&mut self, path: &Path) -> Result<(), MeshError> {
        self.nodes.sort_by_key(|node| node.0);
        if let Some(pair) = self.nodes.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(MeshError::DuplicateTag {
                path: path.to_path_buf(),
                what: "node",
                tag: pair[0].0,
            });
        }
        if let Some((tag, x)) = self.nodes.iter().find(|(_, x)| x.iter().any(|c| !c.is_finite())) {
            let at = format!("({}, {}, {})", x[0], x[1], x[2]);
            return Err(MeshError::NonFinite {
                path: path.to_path_buf(),
                node: *tag,
                at,
            });
        }
        let mut tags: Vec<u64> = self
            .blocks
            .iter()
            .flat_map(|block| block.tags.iter().copied())
            .collect();
        tags.sort_unstable();
        if let Some(pair) = tags.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(MeshError::DuplicateTag {
                path: path.to_path_buf(),
                what: "element",
                tag: pair[0],
            });
        }
        Ok(())
    }

    /// Numbers of the physical groups of dimension `dimension` called `name`.
    pub(crate) fn numbers(&self, dimension: usize, name: &str) -> Vec<i64> {
        let of_dimension = self.names.iter().filter(|(key, _)| key.0 == dimension as i64);
        of_dimension
            .filter(|(_, n)| n.as_str() == name)
            .map(|(key, _)| key.1)
            .collect()
    }

    /// Names of the physical groups of a dimension, sorted and distinct.
    pub(crate) fn names_of(&self, dimension: usize) -> Vec<&str> {
        let of_dimension = self.names.iter().filter(|(key, _)| key.0 == dimension as i64);
        let mut names: Vec<&str> = of_dimension.map(|(_, name)| name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

fn unsupported(path: &Path, found: impl Into<String>) -> MeshError {
    MeshError::UnsupportedVersion {
        path: path.to_path_buf(),
        found: found.into(),
    }
}

/// Reads `$MeshFormat`, which must come first but for comments.
fn read_format(cursor: &mut Cursor<'_>, data: &[u8]) -> Result<Version, MeshError> {
    let foreign = |found: String| MeshError::Foreign {
        path: cursor.path.to_path_buf(),
        found,
    };
    let start = data
        .iter()
        .position(|b| !b.is_ascii_whitespace())
        .unwrap_or(data.len());
    let head = String::from_utf8_lossy(&data[start..data.len().min(start + 20)]).into_owned();
    if head.is_empty() {
        return Err(foreign("an empty file".to_string()));
    }
    if !["$MeshFormat", "$Comments"]
        .iter()
        .any(|known| head.starts_with(known))
    {
        return Err(foreign(shown(&head)));
    }
    loop {
        match cursor.section()? {
            Some("MeshFormat") => break,
            Some("Comments") => cursor.skip_section("Comments")?,
            Some(other) => {
                let found = shown(&format!("${other}"));
                return Err(MeshError::Foreign {
                    path: cursor.path.to_path_buf(),
                    found,
                });
            }
            None => return Err(cursor.damaged("$MeshFormat", "the end of the file")),
        }
    }
    read_version(cursor)
}

/// Reads the line behind `$MeshFormat` and, in a binary file, the byte order.
fn read_version(cursor: &mut Cursor<'_>) -> Result<Version, MeshError> {
    let line = cursor.line("version, file type and data size")?;
    let fields: Vec<&str> = line.split_ascii_whitespace().collect();
    let [version, file_type, size] = fields[..] else {
        return Err(cursor.damaged("version, file type and data size", shown(line)));
    };
    let form = match file_type {
        "0" => "text",
        "1" => "binary",
        _ => return Err(cursor.damaged("file type 0 (text) or 1 (binary)", shown(file_type))),
    };
    let read = match (version, form) {
        ("4.1", _) => Version::V41,
        ("2.2", "text") => Version::V22,
        _ => return Err(unsupported(cursor.path, format!("MSH {version} {form}"))),
    };
    if form == "binary" {
        let size_bytes = match size {
            "4" => 4,
            "8" => 8,
            _ => return Err(cursor.damaged("data size 4 or 8", shown(size))),
        };
        cursor.read_byte_order(size_bytes)?;
    }
    cursor.end("MeshFormat")?;
    Ok(read)
}

/// Reads `$PhysicalNames`, which is text in every encoding.
fn read_names(cursor: &mut Cursor<'_>, names: &mut BTreeMap<(i64, i64), String>) -> Result<(), MeshError> {
    let announced: u64 = cursor.parse("a number of physical names")?;
    // A line `2 1 "a"` has at least 8 bytes.
    if announced > cursor.remaining() as u64 / 8 {
        return Err(cursor.mismatch("physical names", announced, "not room for so many"));
    }
    for _ in 0..announced {
        let dimension: i64 = cursor.parse("a dimension from 0 to 3")?;
        if !(0..=3).contains(&dimension) {
            return Err(cursor.damaged("a dimension from 0 to 3", dimension.to_string()));
        }
        let number: i64 = cursor.parse("the number of a physical group")?;
        let line = cursor.line("a physical name in quotes")?;
        let name = line.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
        let Some(name) = name.filter(|name| !name.is_empty()) else {
            return Err(cursor.damaged("a physical name in quotes", shown(line)));
        };
        if names.insert((dimension, number), name.to_string()).is_some() {
            return Err(cursor.damaged("one name per physical group", shown(name)));
        }
    }
    Ok(())
}
