//! Paths in an included file, which start at its own folder.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A text with the relative paths of its files, meshes and measured profiles, behind `folder`.
pub fn started_at(text: &str, folder: &Path) -> String {
    let Ok(document) = DeTable::parse(text) else {
        return text.to_string();
    };
    let mut typed: Vec<(Range<usize>, String)> = Vec::new();
    let root = document.get_ref();
    let table = |table: &str| root.get(table).and_then(|value| value.get_ref().as_table());
    for ring in ["inner", "outer"] {
        let mesh = table(ring).and_then(|ring| ring.get("mesh"));
        typed.extend(mesh.and_then(path_of));
    }
    let profiles = table("profiles").and_then(|profiles| profiles.get("table"));
    let profiles = profiles.and_then(|value| value.get_ref().as_array());
    for profile in profiles.into_iter().flatten() {
        let file = profile.get_ref().as_table().and_then(|table| table.get("file"));
        typed.extend(file.and_then(path_of));
    }
    typed.sort_by_key(|(span, _)| span.start);
    let mut text = text.to_string();
    for (span, path) in typed.into_iter().rev() {
        let path = folder.join(path).to_string_lossy().into_owned();
        text.replace_range(span, &toml::Value::from(path).to_string());
    }
    text
}

/// The place of a path, and the path.
fn path_of(value: &Spanned<DeValue<'_>>) -> Option<(Range<usize>, String)> {
    Some((value.span(), value.get_ref().as_str()?.to_string()))
}
