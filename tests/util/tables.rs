//! Reads `summary.json` and the tables of a run.

use serde_json::Value;

use super::Dir;

/// A table of a run: the names of its columns and its rows of numbers.
#[derive(Debug)]
pub struct Table {
    pub columns: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a table; every cell must be a finite number.
    pub fn read(dir: &Dir, name: &str) -> Table {
        let mut reader = csv::Reader::from_path(dir.path(name)).unwrap();
        let columns = reader.headers().unwrap().iter().map(str::to_string).collect();
        let number = |cell: &str| {
            let x: f64 = cell.parse().unwrap_or_else(|e| panic!("{name}: {cell:?}: {e}"));
            assert!(x.is_finite(), "{name}: {x}");
            x
        };
        let rows = reader
            .records()
            .map(|row| row.unwrap().iter().map(number).collect())
            .collect();
        Table { columns, rows }
    }

    /// The values of one column.
    #[track_caller]
    pub fn column(&self, name: &str) -> Vec<f64> {
        let i = self.columns.iter().position(|c| c == name);
        let i = i.unwrap_or_else(|| panic!("no column {name:?} among {:?}", self.columns));
        self.rows.iter().map(|row| row[i]).collect()
    }

    /// Whether it has a column.
    pub fn has(&self, name: &str) -> bool {
        self.columns.iter().any(|column| column == name)
    }

    /// The rows of one step.
    pub fn step(&self, step: usize) -> Table {
        let rows = self
            .rows
            .iter()
            .filter(|row| row[0] == step as f64)
            .cloned()
            .collect();
        Table {
            columns: self.columns.clone(),
            rows,
        }
    }
}

/// The summary of a run.
pub fn summary(dir: &Dir, out: &str) -> Value {
    serde_json::from_str(&dir.text(&format!("{out}/summary.json"))).unwrap()
}

/// The number at a JSON pointer such as `/shaft/displacement_m/2`.
#[track_caller]
pub fn number(json: &Value, pointer: &str) -> f64 {
    let value = json.pointer(pointer).and_then(Value::as_f64);
    value.unwrap_or_else(|| panic!("no number at {pointer}"))
}

/// The keys of a JSON object, sorted.
#[track_caller]
pub fn keys(json: &Value) -> Vec<&str> {
    json.as_object()
        .unwrap_or_else(|| panic!("no object: {json}"))
        .keys()
        .map(String::as_str)
        .collect()
}
