//! What differs between two scene texts, key by key: comments, order and layout do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use toml::{Table, Value};

/// A key that two scenes do not agree on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Dotted path.
    pub key: String,
    /// Value in the first scene, as TOML; None without the key.
    pub before: Option<String>,
    /// Value in the second scene.
    pub after: Option<String>,
}

impl Difference {
    /// Whether the key is one of these or lies in one of these tables.
    pub fn is_below(&self, paths: &[&str]) -> bool {
        let below = |path: &&str| {
            self.key
                .strip_prefix(*path)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        paths.iter().any(below)
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let or_absent = |value: &Option<String>| value.clone().unwrap_or("absent".to_string());
        write!(
            f,
            "{} from {} to {}",
            self.key,
            or_absent(&self.before),
            or_absent(&self.after)
        )
    }
}

/// The keys in which two scene texts differ, sorted. An empty table counts: effects without keys are such tables.
pub fn difference(before: &str, after: &str) -> Result<Vec<Difference>, toml::de::Error> {
    let values = |text: &str| -> Result<BTreeMap<String, String>, toml::de::Error> {
        let mut values = BTreeMap::new();
        flatten("", &Value::Table(text.parse::<Table>()?), &mut values);
        Ok(values)
    };
    let (before, after) = (values(before)?, values(after)?);
    let keys: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let differ = keys.into_iter().filter(|key| before.get(*key) != after.get(*key));
    let difference = |key: &String| Difference {
        key: key.clone(),
        before: before.get(key).cloned(),
        after: after.get(key).cloned(),
    };
    Ok(differ.map(difference).collect())
}

fn flatten(path: &str, value: &Value, values: &mut BTreeMap<String, String>) {
    match value {
        Value::Table(table) => {
            if !path.is_empty() {
                values.insert(path.to_string(), "a table".to_string());
            }
            for (key, value) in table {
                let below = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                flatten(&below, value, values);
            }
        }
        _ => {
            values.insert(path.to_string(), value.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a changed scene would be taken for the same one, or a comment for a change.
    #[test]
    fn only_values_and_tables_differ() {
        let before =
            "title = \"a\" # x\n[effects.axial_force]\nvalue = \"2 kN\"\n[dynamic]\nduration = \"1 ms\"\n";
        let same = "title=\"a\"\n[dynamic]\nduration = \"1 ms\" # longer\n[effects]\naxial_force = { value = \"2 kN\" \
                    }\n";
        assert_eq!(difference(before, same).unwrap(), []);
        let after = "title = \"a\"\n[effects.ball_centrifugal]\n[dynamic]\nduration = \"2 ms\"\n";
        let texts: Vec<String> = difference(before, after)
            .unwrap()
            .iter()
            .map(Difference::to_string)
            .collect();
        assert_eq!(
            texts,
            [
                "dynamic.duration from \"1 ms\" to \"2 ms\"",
                "effects.axial_force from a table to absent",
                "effects.axial_force.value from \"2 kN\" to absent",
                "effects.ball_centrifugal from absent to a table",
            ]
        );
        let found = &difference(before, after).unwrap()[0];
        assert!(found.is_below(&["output", "dynamic.duration"]) && found.is_below(&["dynamic"]));
        assert!(!found.is_below(&["dynamic.dur", "duration"]));
    }
}
