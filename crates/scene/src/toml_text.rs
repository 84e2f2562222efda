//! TOML for those who have no scene: the title in a text, and other files in this language.

use std::path::Path;

use serde::de::DeserializeOwned;

use crate::tables::{SceneError, locate};

/// The title in the text of a scene; None without one, or when the text is no TOML.
pub fn title(text: &str) -> Option<String> {
    let table = text.parse::<toml::Table>().ok()?;
    Some(table.get("title")?.as_str()?.to_string())
}

/// Reads the text of the file `path` as tables of another kind. Errors say line, column and key as those of a scene.
pub fn read_tables<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, SceneError> {
    toml::from_str(text).map_err(|e: toml::de::Error| {
        let located = locate(text, e.span(), e.message());
        SceneError::Format {
            path: path.to_path_buf(),
            overrides: Vec::new(),
            line: located.line,
            column: located.column,
            excerpt: located.excerpt(located.line),
            message: located.message,
        }
    })
}
