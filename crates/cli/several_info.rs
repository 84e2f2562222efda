//! `raceway info` of the results of a list of bearings: the run, the shaft, then the folder of each bearing.

use std::path::Path;

use anyhow::Context;
use results::answer;
use results::failure::Failure;
use results::summary::SUMMARY_FILE;
use serde_json::Value;

use crate::info::{Inspected, Inspection, damaged_files, inspect, line};

/// Prints what the folder holds. Damage found is printed, and then an error.
pub fn info(dir: &Path, depth: Inspection) -> Result<(), Failure> {
    line("folder", &dir.display().to_string());
    let path = dir.join(SUMMARY_FILE);
    let summary = match std::fs::read_to_string(&path) {
        Ok(text) => serde_json::from_str(&text).with_context(|| format!("{} is no JSON", path.display()))?,
        // A run that goes on, or was killed.
        Err(_) => Value::Null,
    };
    about(&summary);
    let (mut common, mut damaged): (Option<Vec<u64>>, Vec<String>) = (None, Vec::new());
    for name in plot::bearings(dir)? {
        line("bearing", &of_bearing(&name, &summary["bearings"][&name]));
        let own = dir.join(&name);
        if !own.is_dir() {
            let text = format!("the folder {} of a bearing is not there", own.display());
            line("damaged", &text);
            damaged.push(text);
            common = Some(Vec::new());
            continue;
        }
        let Inspected {
            steps,
            damaged: of_bearing,
        } = inspect(&own, depth)?;
        damaged.extend(of_bearing);
        let before = common.get_or_insert_with(|| steps.clone());
        before.retain(|step| steps.contains(step));
    }
    answer::add_results(dir);
    answer::add("steps", common.unwrap_or_default());
    answer::add("damaged", &damaged);
    match damaged.len() {
        0 => Ok(()),
        n => Err(damaged_files(n, dir)),
    }
}

/// What the summary of the run says of all bearings.
fn about(summary: &Value) {
    let text = |pointer: &str| summary.pointer(pointer).and_then(Value::as_str);
    for (name, pointer) in [
        ("title", "/title"),
        ("scene", "/scene"),
        ("analysis", "/analysis"),
        ("status", "/status"),
    ] {
        if let Some(text) = text(pointer) {
            line(name, text);
        }
    }
    let ends = summary.pointer("/shaft/position_m").and_then(Value::as_array);
    let ends: Vec<f64> = ends.into_iter().flatten().filter_map(Value::as_f64).collect();
    if let (Some(model), [first, .., last]) = (text("/shaft/model"), &ends[..]) {
        let text = format!("{model}, results from {:.3} to {:.3} mm", 1e3 * first, 1e3 * last);
        line("shaft", &text);
    }
    let frequencies = summary.pointer("/modes/frequency_hz").and_then(Value::as_array);
    let frequencies: Vec<f64> = frequencies
        .into_iter()
        .flatten()
        .filter_map(Value::as_f64)
        .collect();
    if let [first, .., last] = frequencies[..] {
        line(
            "modes",
            &format!("{} from {first:.2} to {last:.2} Hz", frequencies.len()),
        );
    }
    let warnings = summary["warnings"].as_array().into_iter().flatten();
    warnings
        .filter_map(Value::as_str)
        .for_each(|warning| line("warning", warning));
}

/// Where a bearing is and what it carries, as far as the summary knows.
fn of_bearing(name: &str, found: &Value) -> String {
    let number = |pointer: &str| found.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN);
    match (found["type"].as_str(), found["orientation"].as_str()) {
        (Some(kind), Some(orientation)) => format!(
            "{name} of {kind} at {:.3} mm, {orientation}: pushes the shaft by {:.2}, {:.2}, {:.2} N, largest ball \
             force {:.2} N, {} of {} balls loaded",
            1e3 * number("/position_m"),
            number("/force_on_shaft_n/0"),
            number("/force_on_shaft_n/1"),
            number("/force_on_shaft_n/2"),
            number("/largest_ball_force_n"),
            found["loaded_balls"],
            found["balls"]
        ),
        _ => name.to_string(),
    }
}
