//! Files that a scene names: meshes, matrices, tables.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use crate::Scene;

/// Keys of a scene, such as `body.0.mesh`, whose values are names of files that are there, and these files.
pub fn named_files(scene: &Scene) -> Result<Vec<(String, PathBuf)>, toml::de::Error> {
    let folder = scene.path.parent().unwrap_or(Path::new(""));
    let mut found = Vec::new();
    for (key, value) in scene.text.parse::<Table>()? {
        add(key, &value, folder, &mut found);
    }
    Ok(found)
}

fn add(key: String, value: &Value, folder: &Path, found: &mut Vec<(String, PathBuf)>) {
    match value {
        Value::Table(table) => {
            let below = table.iter();
            below.for_each(|(name, value)| add(format!("{key}.{name}"), value, folder, found));
        }
        Value::Array(values) => {
            let below = values.iter().enumerate();
            below.for_each(|(number, value)| add(format!("{key}.{number}"), value, folder, found));
        }
        Value::String(typed) if !typed.is_empty() => {
            let path = folder.join(typed);
            if path.is_file() {
                found.push((key, path));
            }
        }
        _ => {}
    }
}
