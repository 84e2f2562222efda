//! `raceway cycles`: amplitude, mean and rain-flow cycles of every stress in `probes.csv`: what fatigue work starts
//! from.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::print;
use plot::swept_column;
use results::failure::Failure;
use results::integrity::warn_of_doubts;
use results::rainflow::{rainflow, turning_points};
use results::table::Table;
use results::whole;

/// Table that is read.
const PROBES: &str = "probes.csv";
/// Tables that are written.
const RANGES: &str = "stress_ranges.csv";
const CYCLES: &str = "stress_cycles.csv";

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Cycles {
    /// Folder of the results of a scene with probes.
    pub dir: PathBuf,
    /// Start of the time that counts, s; such as the start of a revolution.
    #[arg(long, default_value_t = f64::NEG_INFINITY)]
    from: f64,
    /// Its end, s.
    #[arg(long, default_value_t = f64::INFINITY)]
    to: f64,
    /// Swings up to this share of a stress's whole range are not counted as cycles.
    #[arg(long, default_value_t = 0.01)]
    least: f64,
    /// Folder of the tables; default: the folder of the results. Nothing in it is replaced.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Histories of the stresses of a run.
struct Histories {
    times: Vec<f64>,
    /// Name and values.
    columns: Vec<(String, Vec<f64>)>,
}

/// Counts and writes both tables.
pub fn cycles(request: &Cycles) -> Result<(), Failure> {
    if !(0.0..1.0).contains(&request.least) {
        return Err(anyhow!(
            "--least is {}; expected 0 to below 1, a share of the range",
            request.least
        )
        .into());
    }
    let dir = &request.dir;
    plot::require_one_bearing(dir)?;
    let histories = Histories::read(dir, [request.from, request.to])?;
    warn_of_doubts(dir)?;
    let (Some(first), Some(last)) = (histories.times.first(), histories.times.last()) else {
        return Err(anyhow!(
            "{} has no step from {} s to {} s",
            dir.join(PROBES).display(),
            request.from,
            request.to
        )
        .into());
    };
    let mut ranges = header(&RANGE_COLUMNS)?;
    let mut counted = header(&CYCLE_COLUMNS)?;
    for (name, values) in &histories.columns {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let cycles = rainflow(&turning_points(values, request.least * (high - low)));
        let n: f64 = cycles.iter().map(|c| c.count).sum();
        let numbers = [
            *first,
            *last,
            low,
            high,
            0.5 * (high - low),
            0.5 * (high + low),
            n,
        ];
        let row = std::iter::once(name.clone()).chain(numbers.map(|x| format!("{x:?}")));
        ranges.write_record(row)?;
        for cycle in cycles {
            let numbers = [cycle.range, cycle.mean, cycle.count].map(|x| format!("{x:?}"));
            let row = std::iter::once(name.clone()).chain(numbers);
            counted.write_record(row)?;
        }
    }
    let out = whole::output_folder(request.out.as_deref(), dir, &[RANGES, CYCLES])?;
    write(out, RANGES, &RANGE_COLUMNS, ranges)?;
    write(out, CYCLES, &CYCLE_COLUMNS, counted)?;
    let span = match swept_column(dir)? {
        Some(_) => format!("point {first} to point {last} of the sweep"),
        None => format!("{first} s to {last} s"),
    };
    print::line(format_args!(
        "{} stresses from {span}: {RANGES} and {CYCLES} in {}",
        histories.columns.len(),
        out.display()
    ));
    Ok(())
}

const CYCLE_COLUMNS: [&str; 4] = ["stress", "range_pa", "mean_pa", "count"];
const RANGE_COLUMNS: [&str; 8] = [
    "stress",
    "from_s",
    "to_s",
    "minimum_pa",
    "maximum_pa",
    "amplitude_pa",
    "mean_pa",
    "cycles",
];

impl Histories {
    /// Reads the stresses of the probes of the run in `dir` within a span of time.
    fn read(dir: &Path, [from, to]: [f64; 2]) -> anyhow::Result<Histories> {
        let path = dir.join(PROBES);
        let expected = || {
            format!(
                "cannot read {}: expected the results of a scene with [probes.node.*] or [probes.point.*]",
                path.display()
            )
        };
        let table = Table::read(dir, PROBES)?.with_context(expected)?;
        let all = table.column("time_s")?;
        let is_counted = |i: &usize| (from..=to).contains(&all[*i]);
        let rows: Vec<usize> = (0..table.n_rows()).filter(is_counted).collect();
        let chosen = |column: &[f64]| rows.iter().map(|&i| column[i]).collect::<Vec<f64>>();
        let stresses = table.names().iter().filter(|name| name.ends_with("_pa"));
        let columns = stresses
            .map(|name| Ok((name.clone(), chosen(table.column(name)?))))
            .collect::<anyhow::Result<Vec<_>>>()?;
        if columns.is_empty() {
            return Err(anyhow!(
                "{} has no stress: expected columns that end in _pa, from [probes.node.*] or [probes.point.*]",
                path.display()
            ));
        }
        Ok(Histories {
            times: chosen(all),
            columns,
        })
    }
}

/// A table in memory with its header line.
fn header(columns: &[&str]) -> anyhow::Result<csv::Writer<Vec<u8>>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns)?;
    Ok(writer)
}

/// Writes a table in the place of one that this command wrote before.
fn write(dir: &Path, name: &str, columns: &[&str], table: csv::Writer<Vec<u8>>) -> anyhow::Result<()> {
    let content = table.into_inner().context("cannot format a table")?;
    let own = columns.join(",") + "\n";
    whole::write(&dir.join(name), &content, |old| old.starts_with(own.as_bytes()))
}
