//! Reads the quantities of a study out of the results of one run.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, bail};
use results::summary::SUMMARY_FILE;
use results::table::{Rows, read_rows};
use serde_json::Value;

use super::format::{Cell, Take};
use super::plan::Source;

/// Numbers in a table that differ by less than this, relatively, are the same: azimuths and times are sums.
const SAME: f64 = 1e-9;

/// A number of a run, and the rows it was taken from where all of them are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The number, unit of its quantity.
    pub value: f64,
    /// Time and value of every row, in the order of the table; empty unless histories are compared.
    pub history: Vec<[f64; 2]>,
}

/// Reads one quantity from the result folder `dir`; refuses what is no number.
pub fn read(source: &Source, dir: &Path) -> anyhow::Result<Reading> {
    let reading = look_up(source, dir)?;
    if !reading.value.is_finite() {
        bail!("{} is no number", reading.value);
    }
    Ok(reading)
}

/// Reads what stands where a quantity is in the result folder `dir`.
pub fn look_up(source: &Source, dir: &Path) -> anyhow::Result<Reading> {
    Ok(match source {
        Source::Summary(pointer) => Reading {
            value: summary_number(dir, pointer)?,
            history: Vec::new(),
        },
        Source::Table {
            file,
            column,
            rows,
            take,
        } => {
            let history = table_rows(dir, file, column, rows, *take)?;
            Reading {
                value: reduce(&history, *take),
                history: if *take == Take::History {
                    history
                } else {
                    Vec::new()
                },
            }
        }
    })
}

fn summary_number(dir: &Path, pointer: &str) -> anyhow::Result<f64> {
    let path = dir.join(SUMMARY_FILE);
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let json: Value =
        serde_json::from_str(&text).with_context(|| format!("cannot read {}", path.display()))?;
    match json.pointer(pointer) {
        Some(Value::Array(list)) => Ok(list.len() as f64),
        Some(value) if value.is_f64() || value.is_i64() || value.is_u64() => {
            Ok(value.as_f64().unwrap_or(f64::NAN))
        }
        Some(_) => bail!("{SUMMARY_FILE} has no number at {pointer:?}"),
        None => bail!(
            "{SUMMARY_FILE} has nothing at {pointer:?}{}",
            deepest(&json, pointer)
        ),
    }
}

/// The keys that the summary has where the pointer goes astray.
fn deepest(json: &Value, pointer: &str) -> String {
    let mut here = json;
    for part in pointer.split('/').skip(1) {
        match here.pointer(&format!("/{part}")) {
            Some(next) => here = next,
            None => break,
        }
    }
    match here {
        Value::Object(keys) => {
            let keys: Vec<&str> = keys.keys().map(String::as_str).collect();
            format!("; keys there are {}", keys.join(", "))
        }
        Value::Array(list) => format!("; there is a list of {} there, counted from 0", list.len()),
        _ => String::new(),
    }
}

/// Time and value of the rows that match; the number of the row stands for the time where there is none. Refuses what
/// is not one number: the final one of several rows at the last time.
fn table_rows(
    dir: &Path,
    file: &str,
    column: &str,
    wanted: &BTreeMap<String, Cell>,
    take: Take,
) -> anyhow::Result<Vec<[f64; 2]>> {
    let path = dir.join(file);
    let table = read_rows(&path)?;
    let Rows {
        names: header,
        rows: all,
    } = table.with_context(|| format!("{} is not there; {}", path.display(), tables_of(dir)))?;
    let index = |name: &str| match header.iter().position(|h| h == name) {
        Some(i) => Ok(i),
        None => bail!("{file} has no column {name:?}; columns are {}", header.join(", ")),
    };
    let value = index(column)?;
    let time = header.iter().position(|h| h == "time_s");
    let wanted = wanted
        .iter()
        .map(|(name, cell)| Ok((index(name)?, cell)))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let (mut rows, mut cells) = (Vec::new(), Vec::new());
    for (i, row) in all.iter().enumerate() {
        if !wanted.iter().all(|(c, cell)| matches_cell(&row[*c], cell)) {
            continue;
        }
        let number = |c: usize| {
            row[c]
                .parse::<f64>()
                .with_context(|| format!("{file}, row {}: {:?} is no number", i + 1, &row[c]))
        };
        rows.push([time.map_or(Ok(i as f64), number)?, number(value)?]);
        cells.push(row);
    }
    let Some(last) = instants(&rows).last().map(|last| last.len()) else {
        bail!("{file} has no row that matches where");
    };
    if take == Take::Final && last > 1 {
        let of_last = &cells[cells.len() - last..];
        bail!(
            "{file} has {last} rows at the last time, and take = \"final\" is one of them; say which{}, or take \
             another number of all, such as \"max\"",
            example_of_where(&header, of_last, value)
        );
    }
    Ok(rows)
}

/// The tables that a folder has.
fn tables_of(dir: &Path) -> String {
    let names = std::fs::read_dir(dir).into_iter().flatten().flatten();
    let mut names: Vec<String> = names
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".csv"))
        .collect();
    names.sort();
    format!("tables there are {}", names.join(", "))
}

/// How `where` names one of some rows of a time, by the first column but that of the value that tells them apart.
fn example_of_where(header: &[String], rows: &[&csv::StringRecord], value: usize) -> String {
    let [one, .., other] = rows else {
        return String::new();
    };
    let apart = (0..header.len()).find(|&c| c != value && one[c] != other[c]);
    apart.map_or_else(String::new, |c| {
        let cell = match one[c].parse::<f64>() {
            Ok(_) => one[c].to_string(),
            Err(_) => format!("{:?}", &one[c]),
        };
        format!(" by where, such as where = {{ {} = {cell} }}", header[c])
    })
}

/// Rows of a table by the times that they have: those next to each other of the same time.
fn instants(rows: &[[f64; 2]]) -> impl Iterator<Item = &[[f64; 2]]> {
    rows.chunk_by(|a, b| a[0] == b[0])
}

fn matches_cell(text: &str, wanted: &Cell) -> bool {
    match wanted {
        Cell::Text(wanted) => text == wanted,
        Cell::Number(wanted) => text
            .parse::<f64>()
            .is_ok_and(|x| (x - wanted).abs() <= SAME * wanted.abs().max(x.abs())),
    }
}

/// One number from all rows. `rows` is not empty.
fn reduce(rows: &[[f64; 2]], take: Take) -> f64 {
    let values = || rows.iter().map(|r| r[1]);
    let n = rows.len() as f64;
    let mean = values().sum::<f64>() / n;
    let max = values().fold(f64::NEG_INFINITY, f64::max);
    let min = values().fold(f64::INFINITY, f64::min);
    let root_mean_square = |about: f64| (values().map(|x| (x - about) * (x - about)).sum::<f64>() / n).sqrt();
    match take {
        Take::Final => rows[rows.len() - 1][1],
        Take::Mean => mean,
        Take::Max => max,
        Take::Min => min,
        Take::Rms | Take::History => root_mean_square(0.0),
        Take::Deviation => root_mean_square(mean),
        Take::Range => max - min,
        Take::Ripple => (max - min) / mean.abs(),
    }
}

/// RMS of the difference of two histories at the times that both have, row by row where a time has several. At least
/// two such rows are needed.
pub fn history_difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> anyhow::Result<f64> {
    let span = b.last().map_or(0.0, |l| l[0].abs());
    let mut others = instants(b).peekable();
    let (mut n, mut sum) = (0usize, 0.0);
    for rows in instants(a) {
        let time = rows[0][0];
        while others.next_if(|of| of[0][0] < time - SAME * span).is_some() {}
        let Some(of) = others.next_if(|of| (of[0][0] - time).abs() <= SAME * span) else {
            continue;
        };
        if of.len() != rows.len() {
            bail!(
                "its history has {} rows at {time} s and that of the reference {}; name one by where",
                rows.len(),
                of.len()
            );
        }
        let square = |(x, y): (&[f64; 2], &[f64; 2])| (x[1] - y[1]) * (x[1] - y[1]);
        sum += rows.iter().zip(of).map(square).sum::<f64>();
        n += rows.len();
    }
    if n < 2 {
        bail!(
            "its history and that of the reference have {n} times in common; expected two or more, of steps that \
             divide each other in a scene over time"
        );
    }
    Ok((sum / n as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a study would print other statistics than it names.
    #[test]
    fn reductions_are_those_of_their_names() {
        let rows = [[0.0, 3.0], [1.0, 5.0], [2.0, 4.0]];
        let close = |take, expected: f64| assert!((reduce(&rows, take) - expected).abs() < 1e-15, "{take:?}");
        close(Take::Final, 4.0);
        close(Take::Mean, 4.0);
        close(Take::Max, 5.0);
        close(Take::Min, 3.0);
        close(Take::Rms, (50.0f64 / 3.0).sqrt());
        close(Take::Deviation, (2.0f64 / 3.0).sqrt());
        close(Take::Range, 2.0);
        close(Take::Ripple, 0.5);
    }

    /// Wrong: histories of different steps would be compared at different times.
    #[test]
    fn histories_are_compared_at_common_times_only() {
        let coarse = [[0.0, 0.0], [0.2, 1.0], [0.4, 3.0]];
        let fine = [[0.0, 0.0], [0.1, 9.0], [0.2, 1.5], [0.3, 9.0], [0.4, 3.0]];
        let difference = history_difference(&coarse, &fine).unwrap();
        assert!(
            (difference - (0.25f64 / 3.0).sqrt()).abs() < 1e-15,
            "{difference}"
        );
        let error = history_difference(&coarse, &[[0.15, 1.0], [0.35, 1.0]]).unwrap_err();
        assert!(error.to_string().contains("have 0 times in common"), "{error}");
    }

    /// Wrong: a history of all rows of an instant would be compared with the first of the reference, and say 50 % where
    /// the rows agree to the last bit.
    #[test]
    fn histories_of_several_rows_an_instant_are_compared_row_by_row() {
        let coarse = [[0.0, 1.0], [0.0, 5.0], [0.2, 2.0], [0.2, 6.0]];
        let fine = [
            [0.0, 1.0],
            [0.0, 5.0],
            [0.1, 9.0],
            [0.1, 9.0],
            [0.2, 2.0],
            [0.2, 6.5],
        ];
        assert_eq!(history_difference(&coarse, &coarse).unwrap(), 0.0);
        assert_eq!(history_difference(&coarse, &fine).unwrap(), 0.25);
        let error = history_difference(&coarse, &[[0.0, 1.0], [0.2, 2.0]]).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("2 rows at 0 s and that of the reference 1"),
            "{error}"
        );
    }
}
