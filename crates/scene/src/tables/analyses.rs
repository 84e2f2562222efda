//! That a scene has exactly one of the tables that say what is computed.

use toml_edit::DocumentMut;

use super::gather::Finding;

/// The tables that say what is computed.
const ANALYSES: [&str; 5] = ["static", "sweep", "quasi_static", "dynamic", "modes"];

/// Says that a scene has no analysis, or several; `has` in the order of [`ANALYSES`].
pub fn not_one(has: [bool; 5]) -> Option<String> {
    let found = ANALYSES.iter().zip(has).filter(|(_, has)| *has);
    let found: Vec<String> = found.map(|(name, _)| format!("[{name}]")).collect();
    match found.as_slice() {
        [_] => None,
        [] => Some(
            "the scene has no analysis; add one of the tables [static], [sweep], [quasi_static], [dynamic] and [modes]"
                .into(),
        ),
        [a, b] => Some(format!(
            "the scene has both {a} and {b}; keep exactly one analysis"
        )),
        names => Some(format!(
            "the scene has all of {}; keep exactly one analysis",
            names.join(", ")
        )),
    }
}

/// The same of a text whose tables could not be read; none where a misspelt table may be the analysis.
pub fn not_one_of_text(document: &DocumentMut, found: &[Finding]) -> Option<String> {
    let is_of_tables = |finding: &Finding| {
        finding.message.starts_with("unknown field") && finding.message.contains("`quasi_static`")
    };
    if found.iter().any(is_of_tables) {
        return None;
    }
    not_one(ANALYSES.map(|name| document.contains_key(name)))
}
