//! Collects the points of a study into `study.json`, `study.csv` and `study.md`.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Context;
use results::about::path_from;

use super::errors::{Readings, describe, judge, mark_front, orders};
use super::machine;
use super::markdown;
use super::plan::{Plan, Source, StudyQuantity};
use super::read::read;
use super::record::{self, Cost, RUN, Record};
use super::report::{
    AxisReport, CostReport, PointReport, QuantityReport, ResultReport, SCHEMA, Spread, StudyReport,
};

/// File names in the folder of a study.
pub const JSON: &str = "study.json";
/// A table for documents.
pub const MARKDOWN: &str = "study.md";
/// The same numbers, a line per point.
pub const CSV: &str = "study.csv";

/// Reads what all points gave, judges it, and writes the tables.
pub fn collect(plan: &Plan, out: &Path) -> anyhow::Result<StudyReport> {
    let records = plan
        .points
        .iter()
        .map(|point| record::find(plan, point, out))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let mut points: Vec<PointReport> = plan
        .points
        .iter()
        .zip(&records)
        .map(|(point, record)| point_report(plan, &point.at, record.as_ref(), point.index, &point.set))
        .collect();
    for point in &mut points {
        let steps = Source::Summary("/iterations/steps".to_string());
        point.steps = read(&steps, &record::folder(out, point.index).join(RUN))
            .ok()
            .map(|r| r.value);
    }
    for quantity in &plan.quantities {
        let readings = read_all(quantity, &mut points, &records, out);
        judge_all(plan, quantity, &readings, &mut points);
        mark_front(&mut points, &quantity.name, plan.cost);
    }
    let scene_file = path_from(out, &plan.scene)?;
    let report = report(plan, &records, points, &scene_file);
    record::write_whole(&out.join(JSON), &record::to_json(&report)?)?;
    record::write_whole(&out.join(CSV), &csv_text(&report)?)?;
    record::write_whole(&out.join(MARKDOWN), &markdown::text(&report))?;
    Ok(report)
}

/// What the runs of all points say of a quantity; a point that does not tell notes why.
fn read_all(
    quantity: &StudyQuantity,
    points: &mut [PointReport],
    records: &[Option<Record>],
    out: &Path,
) -> Readings {
    let mut readings: Readings = Vec::new();
    for (point, record) in points.iter_mut().zip(records) {
        let is_there = record.as_ref().is_some_and(|r| r.failure.is_none());
        let dir = record::folder(out, point.index).join(RUN);
        readings.push(match is_there.then(|| read(&quantity.source, &dir)) {
            Some(Ok(reading)) => Some(reading),
            Some(Err(error)) => {
                point.unread.insert(quantity.name.clone(), format!("{error:#}"));
                None
            }
            None => None,
        });
    }
    readings
}

/// Judges the readings of a quantity at all points.
fn judge_all(plan: &Plan, quantity: &StudyQuantity, readings: &Readings, points: &mut [PointReport]) {
    for point in &plan.points {
        let report = &mut points[point.index];
        match judge(plan, quantity, readings, point) {
            Ok(None) => {}
            Ok(Some(result)) => {
                report.results.insert(quantity.name.clone(), result);
            }
            // The number is there; only its error is not.
            Err(error) => {
                report.unread.insert(quantity.name.clone(), format!("{error:#}"));
                if let Some(reading) = &readings[point.index] {
                    report.results.insert(quantity.name.clone(), bare(reading.value));
                }
            }
        }
    }
}

/// The report of judged points.
fn report(
    plan: &Plan,
    records: &[Option<Record>],
    points: Vec<PointReport>,
    scene_file: &Path,
) -> StudyReport {
    StudyReport {
        schema: SCHEMA,
        title: plan.title.clone(),
        scene: plan.scene.display().to_string(),
        scene_file: Some(scene_file.display().to_string()),
        date: machine::date(),
        machine: machine::describe(),
        programs: programs(records),
        threads: plan.threads,
        repeats: plan.repeats,
        cost: plan.cost,
        axes: plan.axes.iter().map(axis_report).collect(),
        quantities: plan
            .quantities
            .iter()
            .map(|q| QuantityReport {
                name: q.name.clone(),
                unit: q.unit.clone(),
                reference: q.reference.as_ref().map(|r| describe(plan, r)),
            })
            .collect(),
        orders: orders(plan, &points),
        points,
    }
}

/// A number without a reference.
fn bare(value: f64) -> ResultReport {
    ResultReport {
        value,
        reference: None,
        error: None,
        uncertainty: None,
        is_reference: false,
        pareto: false,
    }
}

fn programs(records: &[Option<Record>]) -> Vec<String> {
    let mut programs: Vec<String> = records.iter().flatten().map(|r| r.program.clone()).collect();
    programs.sort();
    programs.dedup();
    programs
}

fn axis_report(axis: &super::plan::StudyAxis) -> AxisReport {
    AxisReport {
        name: axis.name.clone(),
        label: axis.label.clone(),
        values: axis.values.iter().map(|v| v.name.clone()).collect(),
        sizes: axis.values.iter().filter_map(|v| v.size).collect(),
    }
}

fn point_report(
    plan: &Plan,
    at: &[usize],
    record: Option<&Record>,
    index: usize,
    set: &[String],
) -> PointReport {
    let (status, reason) = match record {
        None => ("not run", None),
        Some(Record {
            failure: Some(reason),
            ..
        }) => ("failed", Some(reason.clone())),
        Some(_) => ("finished", None),
    };
    let values = plan.axes.iter().zip(at);
    PointReport {
        index,
        values: values
            .map(|(axis, &i)| (axis.name.clone(), axis.values[i].name.clone()))
            .collect(),
        set: set.to_vec(),
        status: status.to_string(),
        reason,
        cost: record.filter(|r| !r.costs.is_empty()).map(|r| cost(&r.costs)),
        steps: None,
        results: BTreeMap::new(),
        unread: BTreeMap::new(),
    }
}

fn cost(costs: &[Cost]) -> CostReport {
    CostReport {
        wall_s: spread(costs.iter().map(|c| c.wall_s)),
        cpu_s: spread(costs.iter().map(|c| c.cpu_s)),
        peak_memory_bytes: spread(costs.iter().map(|c| c.peak_memory_bytes as f64)).max,
        bytes_written: spread(costs.iter().map(|c| c.bytes_written as f64)).max,
        disturbed: costs.iter().filter_map(|c| c.disturbed.clone()).collect(),
    }
}

/// Median, smallest and largest; there is at least one value.
fn spread(values: impl Iterator<Item = f64>) -> Spread {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let n = values.len();
    Spread {
        median: 0.5 * (values[(n - 1) / 2] + values[n / 2]),
        min: values[0],
        max: values[n - 1],
    }
}

fn csv_text(report: &StudyReport) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = vec!["point".to_string()];
    header.extend(report.axes.iter().map(|a| a.name.clone()));
    header.extend(
        [
            "status",
            "wall_s",
            "wall_min_s",
            "wall_max_s",
            "cpu_s",
            "cpu_min_s",
            "cpu_max_s",
            "peak_memory_bytes",
            "bytes_written",
            "disturbed_repeats",
        ]
        .map(str::to_string),
    );
    for q in &report.quantities {
        header.push(format!("{} [{}]", q.name, q.unit));
        header.extend(["error", "uncertainty", "pareto"].map(|k| format!("{} {k}", q.name)));
    }
    writer.write_record(&header)?;
    for point in &report.points {
        writer.write_record(csv_row(report, point))?;
    }
    let bytes = writer.into_inner().context("cannot format study.csv")?;
    Ok(String::from_utf8(bytes)?)
}

fn csv_row(report: &StudyReport, point: &PointReport) -> Vec<String> {
    let number = |x: f64| format!("{x:?}");
    let optional = |x: Option<f64>| x.map_or(String::new(), number);
    let mut row = vec![point.index.to_string()];
    row.extend(report.axes.iter().map(|a| point.values[&a.name].clone()));
    row.push(point.status.clone());
    match &point.cost {
        Some(c) => {
            for s in [c.wall_s, c.cpu_s] {
                row.extend([s.median, s.min, s.max].map(number));
            }
            row.extend([c.peak_memory_bytes, c.bytes_written].map(|b| format!("{b:.0}")));
            row.push(c.disturbed.len().to_string());
        }
        None => row.extend(std::iter::repeat_n(String::new(), 9)),
    }
    for q in &report.quantities {
        match point.results.get(&q.name) {
            Some(r) => {
                row.extend([number(r.value), optional(r.error), optional(r.uncertainty)]);
                row.push(u8::from(r.pareto).to_string());
            }
            None => row.extend(std::iter::repeat_n(String::new(), 4)),
        }
    }
    row
}
