//! A table of a run, read into numbers.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};

/// Columns of numbers with their names; a cell that is no number is NaN.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl Table {
    /// Reads `name` in `dir`; none if there is no such file.
    pub fn read(dir: &Path, name: &str) -> anyhow::Result<Option<Table>> {
        let path = dir.join(name);
        if !path.exists() {
            return Ok(None);
        }
        let mut reader =
            csv::Reader::from_path(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let names: Vec<String> = reader.headers()?.iter().map(str::to_string).collect();
        let mut columns = vec![Vec::new(); names.len()];
        for (row, record) in reader.records().enumerate() {
            let record = record.with_context(|| format!("{}: row {} is damaged", path.display(), row + 1))?;
            for (column, cell) in columns.iter_mut().zip(&record) {
                column.push(cell.parse().unwrap_or(f64::NAN));
            }
        }
        Ok(Some(Table { path, names, columns }).filter(|table| table.n_rows() > 0))
    }

    /// Number of rows.
    pub fn n_rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The column with this name, `[n_rows]`.
    pub fn column(&self, name: &str) -> anyhow::Result<&[f64]> {
        self.find(name).ok_or_else(|| {
            anyhow!(
                "{} has no column {name:?}; it has {}",
                self.path.display(),
                self.names.join(", ")
            )
        })
    }

    /// The column with this name, if there is one.
    pub fn find(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|n| n == name)?;
        Some(&self.columns[index])
    }
}
