//! `raceway study`: what accuracy costs. A grid of runs of one scene, their errors against a reference, and their
//! price.
//!
//! ```toml
#![doc = include_str!("example.toml")]
//! ```
//!
//! Every combination of values that is not excluded is a point, run by a process of its own. The folder of the study
//! holds `points/NNNN` (see `runner`), and the tables `study.json`, `study.csv` and `study.md`. The error of a number
//! is its distance to the reference over the scale, by default the size of the reference. A point has the price of the
//! median of its repeats; timings beside other loads are marked. Errors below the uncertainty of the reference say
//! nothing about an order of convergence and are left out of it.

mod advise;
mod check;
mod early;
mod errors;
mod format;
mod machine;
mod markdown;
mod plan;
mod plots;
pub mod prices;
mod read;
mod record;
mod report;
mod richardson;
mod runner;
mod signals;
mod table;
mod unit;

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::print;
use results::failure::Failure;
use results::whole::make_asked_folder;

pub use self::advise::{Question, advise};
pub use self::format::{Cell, CostKind, Meshes, Take};
pub use self::plan::{AxisValue, Plan, Point, Source, StudyAxis, StudyQuantity, grid};
pub use self::record::write_whole;
pub use self::report::{PointReport, StudyReport};
pub use self::table::JSON as STUDY_FILE;

/// What is asked.
#[derive(Debug, Args)]
pub struct StudyRequest {
    /// Study file.
    study: PathBuf,
    /// Folder of the results, new or that of an earlier call; default: results/ and the study's name.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Points that run at the same time; they disturb each other's timing.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
    /// Runs only this point and makes no table: for job arrays.
    #[arg(long)]
    point: Option<usize>,
    /// Runs points again that have failed.
    #[arg(long)]
    retry_failed: bool,
    /// Prints the points and runs nothing.
    #[arg(long)]
    list: bool,
}

/// Runs the points that are missing and writes the tables.
pub fn study(request: &StudyRequest) -> Result<(), Failure> {
    let plan = check::load(&request.study)?;
    if request.list {
        for point in &plan.points {
            print::line(format_args!("{} {}", point.index, plan.name(point)));
        }
        return Ok(());
    }
    let out = match &request.out {
        Some(out) => out.clone(),
        None => PathBuf::from("results").join(request.study.file_stem().unwrap_or("study".as_ref())),
    };
    let out = absolute(&out)?;
    plan.check_scenes(&out)?;
    let wanted = match request.point {
        Some(index) => std::slice::from_ref(plan.point(index)?),
        None => &plan.points,
    };
    run_missing(&plan, wanted, &out, request.jobs, request.retry_failed)?;
    if request.point.is_some() {
        return Ok(());
    }
    let report = table::collect(&plan, &out)?;
    print_report(&report);
    if let Some(n) = signals::write(&plan, &report, &out)? {
        print::line(format_args!(
            "{n} labelled signals: {}",
            out.join(signals::LABELS).display()
        ));
    }
    for path in plots::write(&report, &out)? {
        print::line(format_args!("plot: {}.svg and .png", path.display()));
    }
    print::line(format_args!("results: {}", out.display()));
    Ok(())
}

/// Runs all points of a plan that are missing in `out` and collects them.
pub fn run_all(plan: &Plan, out: &Path, jobs: usize) -> Result<StudyReport, Failure> {
    let out = absolute(out)?;
    plan.check_scenes(&out)?;
    run_missing(plan, &plan.points, &out, jobs, false)?;
    Ok(table::collect(plan, &out)?)
}

/// Runs those of the wanted points that have no record, and failed ones again if asked to.
fn run_missing(
    plan: &Plan,
    wanted: &[Point],
    out: &Path,
    jobs: usize,
    retry_failed: bool,
) -> Result<(), Failure> {
    if jobs == 0 {
        return Err(Failure::User(anyhow!("--jobs is 0; expected at least 1")));
    }
    make_asked_folder(out)?;
    let mut missing: Vec<Point> = Vec::new();
    let mut finished = None;
    for point in wanted {
        match record::find(plan, point, out)? {
            Some(record) if record.failure.is_none() => finished = finished.or(Some(point.index)),
            Some(_) if !retry_failed => {}
            _ => missing.push(point.clone()),
        }
    }
    // Tables of points that are all there say themselves what is not to be read.
    if let Some(index) = finished
        && !missing.is_empty()
    {
        early::require_readable(plan, index, out)?;
    }
    runner::run(plan, &missing, (out, finished.is_some()), jobs)
}

fn absolute(out: &Path) -> anyhow::Result<PathBuf> {
    std::path::absolute(out).with_context(|| format!("cannot use {}", out.display()))
}

fn print_report(report: &StudyReport) {
    for point in &report.points {
        let values: Vec<&str> = report
            .axes
            .iter()
            .map(|a| point.values[&a.name].as_str())
            .collect();
        let cost = point.cost.as_ref().map_or(String::new(), |c| {
            let mark = if c.disturbed.is_empty() { "" } else { "*" };
            format!(
                " {:9.3} s{mark} {:7.0} MB",
                c.of(report.cost.seconds()),
                1e-6 * c.peak_memory_bytes
            )
        });
        let errors = report
            .quantities
            .iter()
            .map(|q| match point.results.get(&q.name) {
                Some(r) if r.is_reference => format!("{} reference", q.name),
                Some(r) => match r.error {
                    Some(error) => format!("{} {}{error:.2e}", q.name, if r.pareto { "+" } else { "" }),
                    None => format!("{} = {:.6e} {}", q.name, r.value, q.unit),
                },
                None => format!("{} -", q.name),
            });
        print::line(format_args!(
            "{:4} {:9} {:40}{cost}  {}",
            point.index,
            point.status,
            values.join(", "),
            errors.collect::<Vec<_>>().join("; ")
        ));
        if let Some(reason) = &point.reason {
            print::line(format_args!("     {reason}"));
        }
        for (name, reason) in &point.unread {
            print::line(format_args!("     {name}: {reason}"));
        }
    }
    for order in &report.orders {
        let at: Vec<String> = order.at.iter().map(|(a, v)| format!(", {a} = {v}")).collect();
        print::line(format_args!(
            "order of {} over {}{}: {:.2} from {} points",
            order.quantity,
            order.axis,
            at.concat(),
            order.order,
            order.n_points
        ));
    }
    print::line(format_args!(
        "+ on the front of error and {}; * timed beside other loads",
        report.cost.label()
    ));
}
