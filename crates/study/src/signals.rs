//! A labelled set: one file of signals per finished point, and one table that says what each of them is.
//!
//! `signals/NNNN.csv` has the time and the columns asked for, and `labels.csv` a line per finished point: its number
//! and file, the value of every axis, samples and samples per second, and every quantity that was read.

use std::path::Path;

use anyhow::{Context, ensure};
use results::table::Table;
use results::whole::make_folder;

use super::plan::{Plan, Signals};
use super::record::{RUN, folder, write_whole};
use super::report::StudyReport;

/// The table of labels.
pub const LABELS: &str = "labels.csv";
/// Folder of the signals.
const SIGNALS: &str = "signals";

/// Writes the set of a study, if it asks for one; returns the number of its signals.
pub fn write(plan: &Plan, report: &StudyReport, out: &Path) -> anyhow::Result<Option<usize>> {
    let Some(signals) = &plan.signals else {
        return Ok(None);
    };
    make_folder(&out.join(SIGNALS))?;
    let mut labels = csv::Writer::from_writer(Vec::new());
    let axes = report.axes.iter().map(|axis| axis.name.clone());
    let quantities = report
        .quantities
        .iter()
        .map(|q| format!("{} [{}]", q.name, q.unit));
    let own = ["samples", "samples_per_second"].map(str::to_string);
    let head = ["point", "file"]
        .map(str::to_string)
        .into_iter()
        .chain(axes)
        .chain(own)
        .chain(quantities);
    labels.write_record(head)?;
    let mut n = 0;
    for point in report.points.iter().filter(|point| point.status == "finished") {
        let dir = folder(out, point.index).join(RUN);
        let (text, times) = signals.of_run(&dir)?;
        let file = format!("{SIGNALS}/{:04}.csv", point.index);
        write_whole(&out.join(&file), &text)?;
        let rate = (times.len() - 1) as f64 / (times[times.len() - 1] - times[0]);
        let mut row = vec![point.index.to_string(), file];
        row.extend(report.axes.iter().map(|axis| point.values[&axis.name].clone()));
        row.extend([times.len().to_string(), format!("{rate:?}")]);
        let values = report.quantities.iter().map(|q| point.results.get(&q.name));
        row.extend(values.map(|result| result.map_or(String::new(), |r| format!("{:?}", r.value))));
        labels.write_record(row)?;
        n += 1;
    }
    let bytes = labels
        .into_inner()
        .with_context(|| format!("cannot format {LABELS}"))?;
    write_whole(&out.join(LABELS), &String::from_utf8(bytes)?)?;
    Ok(Some(n))
}

impl Signals {
    /// The file of a run, and its times, s.
    pub fn of_run(&self, dir: &Path) -> anyhow::Result<(String, Vec<f64>)> {
        let path = dir.join(&self.table);
        let table = Table::read(dir, &self.table)?
            .with_context(|| format!("{} is not there; [signals] needs it in every run", path.display()))?;
        let times = table.column("time_s")?;
        ensure!(
            times.len() > 1 && times[times.len() - 1] > times[0],
            "{} has no history; [signals] needs runs in time",
            path.display()
        );
        let columns = self.columns.iter().map(|name| table.column(name));
        let columns = columns.collect::<anyhow::Result<Vec<_>>>()?;
        let mut text = format!("time_s,{}\n", self.columns.join(","));
        for (row, time) in times.iter().enumerate() {
            text += &format!("{time:?}");
            for column in &columns {
                text += &format!(",{:?}", column[row]);
            }
            text.push('\n');
        }
        Ok((text, times.to_vec()))
    }
}
