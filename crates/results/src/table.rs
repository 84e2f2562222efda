//! A table of a run as others read it: every cell is looked at, so that damage is an error and no number.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, ensure};
use checkpoint::open_regular;

/// Columns of texts. All others hold numbers.
const TEXTS: [&str; 6] = [
    "profile",
    "body",
    "whirl",
    "bearing",
    "inner_ellipse",
    "outer_ellipse",
];
/// Columns that must not fall from row to row.
const STEP: &str = "step";
const TIME: &str = "time_s";
const BALL: &str = "ball";

/// Rows of texts under the names of their columns, as [`read_rows`] has checked them.
#[derive(Debug)]
pub struct Rows {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Cells, a row each.
    pub rows: Vec<csv::StringRecord>,
}

/// Columns of numbers with their names. In the column of a swept value, a cell that is a word is NaN.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// Columns of texts by their names.
    texts: BTreeMap<String, Vec<String>>,
}

/// Reads a table of a run; none if there is no such file. Fails, with the line, at a cell that is no finite
/// number, at a step or time that falls, and at balls out of their order.
pub fn read_rows(path: &Path) -> anyhow::Result<Option<Rows>> {
    if !path.exists() {
        return Ok(None);
    }
    let mut reader = csv::Reader::from_reader(open_regular(path)?);
    let damaged = || format!("{} is damaged", path.display());
    let names: Vec<String> = reader
        .headers()
        .with_context(damaged)?
        .iter()
        .map(str::to_string)
        .collect();
    let mut order = RowOrder::new(&names);
    let mut rows = Vec::new();
    for (i, row) in reader.records().enumerate() {
        let at = || format!("{}, line {}", path.display(), i + 2);
        let row = row.with_context(at)?;
        for (column, (name, cell)) in names.iter().zip(&row).enumerate() {
            require_number(column, name, cell).with_context(at)?;
        }
        order.follow(&row).with_context(at)?;
        rows.push(row);
    }
    order.close().with_context(|| path.display().to_string())?;
    Ok(Some(Rows { names, rows }))
}

/// Whether words may stand in a column: the third of a sweep is named by a path of the scene.
fn is_swept(column: usize, name: &str) -> bool {
    column == 2 && name.contains('.')
}

fn require_number(column: usize, name: &str, cell: &str) -> anyhow::Result<()> {
    if TEXTS.contains(&name) || is_swept(column, name) {
        let is_text = !cell.is_empty() && !cell.contains(char::is_control);
        ensure!(is_text, "{name} is {cell:?}; expected a text");
        return Ok(());
    }
    let is_number = cell.parse::<f64>().is_ok_and(f64::is_finite);
    ensure!(is_number, "{name} is {cell:?}; expected a finite number");
    Ok(())
}

/// What one row says of the next.
struct RowOrder {
    step: Option<usize>,
    time: Option<usize>,
    ball: Option<usize>,
    /// Step, time and ball of the row before.
    last: Option<(u64, f64, usize)>,
    /// Balls of the first step.
    n_balls: Option<usize>,
}

impl RowOrder {
    fn new(names: &[String]) -> RowOrder {
        let place = |wanted: &str| names.iter().position(|name| name == wanted);
        RowOrder {
            step: place(STEP),
            time: place(TIME),
            // The balls of several bearings begin anew with each.
            ball: place(BALL).filter(|_| place("bearing").is_none()),
            last: None,
            n_balls: None,
        }
    }

    fn follow(&mut self, row: &csv::StringRecord) -> anyhow::Result<()> {
        let Some(column) = self.step else { return Ok(()) };
        let step = row[column].parse::<u64>();
        let step = step.map_err(|_| anyhow!("step is {:?}; expected a number from 0", &row[column]))?;
        let time = self.time.map_or(Ok(step as f64), |i| row[i].parse())?;
        let ball = match self.ball {
            None => 0,
            Some(i) => row[i]
                .parse()
                .map_err(|_| anyhow!("ball is {:?}; expected a number from 0", &row[i]))?,
        };
        let mut expected = 0;
        if let Some((last_step, last_time, last_ball)) = self.last {
            let is_same = step == last_step;
            ensure!(step >= last_step, "step {step} follows step {last_step}");
            let fits = if is_same {
                time == last_time
            } else {
                time > last_time
            };
            ensure!(
                fits,
                "step {step} at {time} s follows step {last_step} at {last_time} s"
            );
            expected = if is_same { last_ball + 1 } else { 0 };
            if !is_same {
                self.require_all_balls(last_step, last_ball)?;
            }
        }
        if self.ball.is_some() {
            ensure!(
                ball == expected,
                "ball {ball} of step {step}; expected ball {expected}"
            );
        }
        self.last = Some((step, time, ball));
        Ok(())
    }

    fn require_all_balls(&mut self, step: u64, last: usize) -> anyhow::Result<()> {
        let n_balls = *self.n_balls.get_or_insert(last + 1);
        let found = last + 1;
        let fits = self.ball.is_none() || found == n_balls;
        ensure!(fits, "step {step} has {found} balls; expected {n_balls}");
        Ok(())
    }

    /// The last step must be whole, too.
    fn close(&mut self) -> anyhow::Result<()> {
        let Some((step, _, ball)) = self.last else {
            return Ok(());
        };
        self.require_all_balls(step, ball)
    }
}

impl Table {
    /// Reads `name` in `dir`; none if there is no such file or no row in it.
    pub fn read(dir: &Path, name: &str) -> anyhow::Result<Option<Table>> {
        let path = dir.join(name);
        let Some(Rows { names, rows }) = read_rows(&path)? else {
            return Ok(None);
        };
        let column = |i: usize| {
            rows.iter()
                .map(|row| row[i].parse().unwrap_or(f64::NAN))
                .collect()
        };
        let columns: Vec<Vec<f64>> = (0..names.len()).map(column).collect();
        let text = |(i, name): (usize, &String)| {
            let cells = rows.iter().map(|row| row[i].to_string());
            (name.clone(), cells.collect())
        };
        let is_text = |(_, name): &(usize, &String)| TEXTS.contains(&name.as_str());
        let texts = names.iter().enumerate().filter(is_text).map(text).collect();
        let table = Table {
            path,
            names,
            columns,
            texts,
        };
        Ok(Some(table).filter(|table| table.n_rows() > 0))
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

    /// The column of texts with this name, if there is one.
    pub fn texts(&self, name: &str) -> Option<&[String]> {
        self.texts.get(name).map(Vec::as_slice)
    }

    /// The column with this name, if there is one.
    pub fn find(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|n| n == name)?;
        Some(&self.columns[index])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a damaged cell would be drawn, counted or compared as if the run had written it.
    #[test]
    fn damage_of_cells_is_an_error_with_its_line() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("balls.csv");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read_rows(&path).map_err(|error| format!("{error:#}"))
        };
        let head = "step,time_s,ball,force_n\n";
        let whole = "0,0.0,0,1.5\n0,0.0,1,2.5\n2,1e-5,0,1.5\n2,1e-5,1,0.0\n";
        assert_eq!(read(&format!("{head}{whole}")).unwrap().unwrap().rows.len(), 4);
        for (from, to, said) in [
            (
                "2.5",
                "nan",
                "line 3: force_n is \"nan\"; expected a finite number",
            ),
            (
                "2.5",
                "abc",
                "line 3: force_n is \"abc\"; expected a finite number",
            ),
            (
                "2.5",
                "inf",
                "line 3: force_n is \"inf\"; expected a finite number",
            ),
            (
                "2.5",
                "\0\0",
                "line 3: force_n is \"\\0\\0\"; expected a finite number",
            ),
            (
                "0.0,1,",
                "0.0,-1,",
                "line 3: ball is \"-1\"; expected a number from 0",
            ),
            ("0.0,1,", "0.0,7,", "line 3: ball 7 of step 0; expected ball 1"),
            (
                "2,1e-5,0",
                "2,-1e-5,0",
                "line 4: step 2 at -0.00001 s follows step 0 at 0 s",
            ),
            (
                "2,1e-5,1",
                "2,2e-5,1",
                "line 5: step 2 at 0.00002 s follows step 2 at 0.00001 s",
            ),
            (
                "0,0.0,1,",
                "1,0.0,1,",
                "line 3: step 1 at 0 s follows step 0 at 0 s",
            ),
            ("2,1e-5,1,0.0\n", "", "balls.csv: step 2 has 1 balls; expected 2"),
            (",2.5", "", "line 3: CSV error: record 2"),
        ] {
            let text = read(&format!("{head}{}", whole.replacen(from, to, 1))).unwrap_err();
            assert!(text.contains(said), "{text} lacks {said}");
        }
        // A sweep over words.
        let swept = "step,time_s,contact.mode,ball,force_n\n0,0.0,NaN,0,1.5\n";
        assert_eq!(read(swept).unwrap().unwrap().rows.len(), 1);
    }
}
