//! What a mesh file says of its making: one line of text near its head, in a `$Comments` section, which every reader
//! skips.
//!
//! A file that Gmsh or another program has saved again has none.

use std::io::Read;
use std::path::Path;

use crate::error::MeshError;

/// What the line begins with.
const MARK: &str = "made by raceway mesh from ";
/// The record stands within so many bytes of the file's beginning.
const HEAD: u64 = 4096;

/// The section of a file that holds the record; `text` is one line without `$`.
pub(super) fn section(text: &str) -> String {
    debug_assert!(!text.contains(['\n', '$']), "a record is one line of plain text");
    format!("$Comments\n{MARK}{text}\n$EndComments\n")
}

/// The record of a mesh file; None if it has none.
pub fn read_record(path: &Path) -> Result<Option<String>, MeshError> {
    let fail = |source| MeshError::Io {
        action: "read",
        path: path.to_path_buf(),
        source,
    };
    let mut head = Vec::new();
    let file = std::fs::File::open(path).map_err(fail)?;
    file.take(HEAD).read_to_end(&mut head).map_err(fail)?;
    let text = String::from_utf8_lossy(&head);
    let line = text.lines().find_map(|line| line.strip_prefix(MARK));
    Ok(line.map(|line| line.trim_end().to_string()))
}
