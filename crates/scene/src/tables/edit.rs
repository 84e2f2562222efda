//! Changes to the text of a scene before it is read: `--set path=value`, and the points of a sweep.
//!
//! The text is edited in place, so that comments and line numbers stay as the user knows them. A path that is
//! not in the scene is added; whether such a key exists is then checked with all others.

use super::locate::other_name;
use toml_edit::{DocumentMut, Item, Key, Table, TableLike, Value};

/// The value that takes a table out, `--set effects.gravity=none`.
const REMOVE: &str = "none";

/// Applies `path=value` to the document. The value is read as TOML, or else taken as a string; `none` for a table
/// takes it out.
pub fn apply_override(document: &mut DocumentMut, text: &str) -> Result<(), String> {
    let Some((path, value)) = text.split_once('=') else {
        return Err("expected path=value such as \"effects.axial_force.value=3 kN\"".to_string());
    };
    let value = value.trim();
    if value == REMOVE && remove_table(document, path.trim()) {
        return Ok(());
    }
    let parsed = value.parse::<Value>().unwrap_or_else(|_| Value::from(value));
    set(document, path.trim(), parsed)
}

/// Tables of `[output]` that need a series of steps.
pub const OF_SERIES: [&str; 2] = ["every", "reduction"];

/// Takes what needs a series of steps out of the scene of one equilibrium.
pub fn remove_series(document: &mut DocumentMut) {
    for name in OF_SERIES {
        remove_table(document, &format!("output.{name}"));
    }
}

/// The document as the scene of one point of its sweep: `key` has the value, and `[sweep]` is `[static]`.
pub fn point_text(document: &DocumentMut, key: &str, value: Value) -> Result<String, String> {
    let mut point = document.clone();
    set(&mut point, key, value)?;
    point.remove("sweep");
    remove_series(&mut point);
    point.insert("static", Item::Table(Table::new()));
    Ok(point.to_string())
}

/// Takes out the table at a dotted path; whether there was one.
fn remove_table(document: &mut DocumentMut, path: &str) -> bool {
    let Ok(keys) = Key::parse(path) else { return false };
    let Some((last, tables)) = keys.split_last() else {
        return false;
    };
    let mut table: &mut dyn TableLike = document.as_table_mut();
    for key in tables {
        match table.get_mut(key.get()).and_then(Item::as_table_like_mut) {
            Some(next) => table = next,
            None => return false,
        }
    }
    let is_table = |item: &Item| item.is_table_like() || item.is_array_of_tables();
    let is_table = table.get(last.get()).is_some_and(is_table);
    is_table && table.remove(last.get()).is_some()
}

/// Sets the value at a dotted path; tables on the way are made when they are missing. A table of a list is reached by
/// its number from 0: `body.0.seat.0.harmonics`.
fn set(document: &mut DocumentMut, path: &str, mut value: Value) -> Result<(), String> {
    let keys = Key::parse(path).map_err(|_| {
        format!("{path:?} is no path of keys; expected one such as effects.axial_force.value")
    })?;
    let (last, tables) = keys.split_last().ok_or("the path is empty")?;
    let mut table: &mut dyn TableLike = document.as_table_mut();
    let mut walked = String::new();
    let mut rest = tables;
    while let [key, after @ ..] = rest {
        rest = after;
        walked += if walked.is_empty() { "" } else { "." };
        walked += key.get();
        if !table.contains_key(key.get()) {
            let mut new = Table::new();
            new.set_implicit(true);
            table.insert(key.get(), Item::Table(new));
        }
        table = match table.get_mut(key.get()) {
            Some(Item::ArrayOfTables(list)) => {
                let known = list.len();
                let number = after.first().map_or("", |key| key.get());
                rest = after.get(1..).unwrap_or_default();
                let found = number.parse().ok().and_then(|i: usize| list.get_mut(i));
                let found = found.ok_or_else(|| {
                    format!(
                        "{walked} is a list of {known}; expected a number below {known} and a key behind it, such as \
                         {walked}.0.name"
                    )
                })?;
                walked = format!("{walked}.{number}");
                found
            }
            found => found
                .and_then(Item::as_table_like_mut)
                .ok_or_else(|| format!("{walked} is a value, so it has no key {:?}", last.get()))?,
        };
    }
    // A key that has two names keeps the one it has.
    let name = match other_name(last.get()) {
        Some(other) if table.contains_key(other) => other,
        _ => last.get(),
    };
    match table.get_mut(name) {
        Some(Item::Value(old)) => {
            // Keep the comment behind the value.
            *value.decor_mut() = old.decor().clone();
            *old = value;
        }
        _ => {
            table.insert(name, Item::Value(value));
        }
    }
    Ok(())
}
