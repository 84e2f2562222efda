//! `raceway cycles`: amplitude, mean and rain-flow cycles of every stress in `probes.csv`: what fatigue work starts from.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::print;
use results::failure::Failure;
use results::rainflow::{rainflow, turning_points};

/// Tables that are written into the folder.
const RANGES: &str = "stress_ranges.csv";
const CYCLES: &str = "stress_cycles.csv";

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Cycles {
    /// Folder of the results of a scene with probes.
    dir: PathBuf,
    /// Start of the time that counts, s; such as the start of a revolution.
    #[arg(long, default_value_t = f64::NEG_INFINITY)]
    from: f64,
    /// Its end, s.
    #[arg(long, default_value_t = f64::INFINITY)]
    to: f64,
    /// Swings up to this share of a stress's whole range are not counted as cycles.
    #[arg(long, default_value_t = 0.01)]
    least: f64,
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
    let histories = Histories::read(&dir.join("probes.csv"), [request.from, request.to])?;
    let (Some(first), Some(last)) = (histories.times.first(), histories.times.last()) else {
        return Err(anyhow!(
            "{} has no step from {} s to {} s",
            dir.join("probes.csv").display(),
            request.from,
            request.to
        )
        .into());
    };
    let mut ranges = create(&dir.join(RANGES), &RANGE_COLUMNS)?;
    let mut counted = create(&dir.join(CYCLES), &["stress", "range_pa", "mean_pa", "count"])?;
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
        ranges
            .write_record(row)
            .with_context(|| format!("cannot write {RANGES}"))?;
        for cycle in cycles {
            let numbers = [cycle.range, cycle.mean, cycle.count].map(|x| format!("{x:?}"));
            let row = std::iter::once(name.clone()).chain(numbers);
            counted
                .write_record(row)
                .with_context(|| format!("cannot write {CYCLES}"))?;
        }
    }
    ranges.flush().with_context(|| format!("cannot write {RANGES}"))?;
    counted
        .flush()
        .with_context(|| format!("cannot write {CYCLES}"))?;
    print::line(format_args!(
        "{} stresses from {first} s to {last} s: {RANGES} and {CYCLES} in {}",
        histories.columns.len(),
        dir.display()
    ));
    Ok(())
}

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
    /// Reads the stresses of a table of probes within a span of time.
    fn read(path: &Path, [from, to]: [f64; 2]) -> anyhow::Result<Histories> {
        let mut reader = csv::Reader::from_path(path).with_context(|| {
            format!(
                "cannot read {}: expected the results of a scene with [probes.node.*] or [probes.point.*]",
                path.display()
            )
        })?;
        let header = reader.headers()?.clone();
        let time = header.iter().position(|name| name == "time_s");
        let time = time.ok_or_else(|| anyhow!("{} has no column time_s", path.display()))?;
        let stresses: Vec<usize> = (0..header.len())
            .filter(|&i| header[i].ends_with("_pa"))
            .collect();
        if stresses.is_empty() {
            return Err(anyhow!(
                "{} has no stress: expected columns that end in _pa, from [probes.node.*] or [probes.point.*]",
                path.display()
            ));
        }
        let mut histories = Histories {
            times: Vec::new(),
            columns: stresses
                .iter()
                .map(|&i| (header[i].to_string(), Vec::new()))
                .collect(),
        };
        for (line, record) in reader.records().enumerate() {
            let record = record.with_context(|| format!("cannot read {}", path.display()))?;
            let number = |i: usize| {
                let cell = record.get(i).unwrap_or("");
                let place = || format!("{}, line {}: {cell:?} is no number", path.display(), line + 2);
                cell.parse::<f64>().with_context(place)
            };
            let now = number(time)?;
            if now < from || now > to {
                continue;
            }
            histories.times.push(now);
            for (column, &i) in histories.columns.iter_mut().zip(&stresses) {
                column.1.push(number(i)?);
            }
        }
        Ok(histories)
    }
}

fn create(path: &Path, columns: &[&str]) -> anyhow::Result<csv::Writer<std::fs::File>> {
    let mut writer =
        csv::Writer::from_path(path).with_context(|| format!("cannot create {}", path.display()))?;
    writer.write_record(columns)?;
    Ok(writer)
}
