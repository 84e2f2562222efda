//! `raceway advise study.json --error 1%`: the cheapest settings of a study that reach an error.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use clap::Args;
use comm::print;
use input::shell_word;
use results::about::tidy;
use results::failure::Failure;

use super::format::CostKind;
use super::plan::arguments;
use super::report::{PointReport, ResultReport, StudyReport};

/// What is asked.
#[derive(Debug, Args)]
pub struct Question {
    /// Table of a study: its study.json, or its folder.
    study: PathBuf,
    /// Largest error, such as 1% or 0.01: relative to the scale of each quantity.
    #[arg(long, value_parser = parse_error)]
    error: f64,
    /// Only this quantity; default: all.
    #[arg(long)]
    quantity: Option<String>,
    /// What cheap means; default: as the study says.
    #[arg(long, value_enum)]
    cost: Option<CostKind>,
}

/// Prints the cheapest settings per quantity, and those that reach all.
pub fn advise(question: &Question) -> Result<(), Failure> {
    let path = if question.study.is_dir() {
        question.study.join(super::table::JSON)
    } else {
        question.study.clone()
    };
    let mut report = StudyReport::load(&path)?;
    // Paths of a scene start at its folder.
    let whole = std::path::absolute(&path).with_context(|| path.display().to_string())?;
    let folder = whole.parent().unwrap_or(Path::new("."));
    for point in &mut report.points {
        point.set = arguments(&point.set, folder);
    }
    if let Some(file) = &report.scene_file {
        let from_here = path.parent().unwrap_or(Path::new("")).join(file);
        report.scene = tidy(&from_here).display().to_string();
    }
    let kind = question.cost.unwrap_or(report.cost);
    let names = asked(&report, question.quantity.as_deref(), &path)?;
    print::line(format_args!(
        "{}: cheapest settings within {}, by {}",
        report.title,
        percent(question.error),
        kind.label()
    ));
    let mut missed = Vec::new();
    for name in &names {
        if !advise_one(&report, std::slice::from_ref(name), question.error, kind) {
            missed.push(name.clone());
        }
    }
    if names.len() > 1 && missed.is_empty() && !advise_one(&report, &names, question.error, kind) {
        missed.push("all quantities at once".to_string());
    }
    if missed.is_empty() {
        return Ok(());
    }
    Err(Failure::Numerical(anyhow!(
        "no finished point of {} has an error and uncertainty within {} in: {}",
        path.display(),
        percent(question.error),
        missed.join("; ")
    )))
}

/// Names of the quantities that have errors, or the one that is asked for.
fn asked(report: &StudyReport, wanted: Option<&str>, path: &Path) -> anyhow::Result<Vec<String>> {
    let names: Vec<String> = report
        .quantities
        .iter()
        .filter(|q| q.reference.is_some())
        .map(|q| q.name.clone())
        .collect();
    match wanted {
        None if names.is_empty() => bail!("no quantity of {} has a reference", path.display()),
        None => Ok(names),
        Some(name) if names.iter().any(|n| n == name) => Ok(vec![name.to_string()]),
        Some(name) => bail!(
            "{} has no quantity {name:?} with a reference; there are {}",
            path.display(),
            names.join(", ")
        ),
    }
}

/// Prints the advice for quantities that have to be reached together; whether there is one.
fn advise_one(report: &StudyReport, names: &[String], error: f64, kind: CostKind) -> bool {
    let title = match names {
        [one] => one.clone(),
        _ => "all quantities".to_string(),
    };
    let best = report
        .points
        .iter()
        .filter(|p| names.iter().all(|n| surely(p, n).is_some_and(|e| e <= error)))
        .filter_map(|p| Some((p, p.cost.as_ref()?.of(kind))))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((point, _)) = best else {
        let least = names
            .iter()
            .filter_map(|n| least_error(report, n))
            .fold(0.0, f64::max);
        print::line(format_args!(
            "{title}: no point; the smallest error with its uncertainty is {}",
            percent(least)
        ));
        return false;
    };
    print::line(format_args!("{title}: {}", settings(point)));
    for name in names {
        let unit = report.quantities.iter().find(|q| q.name == *name);
        let unit = unit.map_or("1", |quantity| &quantity.unit);
        print::line(format_args!("    {}", reached(name, unit, &point.results[name])));
    }
    if let Some(cost) = &point.cost {
        let mark = if cost.disturbed.is_empty() {
            ""
        } else {
            ", times disturbed by other loads"
        };
        print::line(format_args!(
            "    {:.3} s wall, {:.3} s processor, {:.0} MB, {:.1} MB written{mark}",
            cost.wall_s.median,
            cost.cpu_s.median,
            1e-6 * cost.peak_memory_bytes,
            1e-6 * cost.bytes_written
        ));
    }
    print::line(format_args!(
        "    raceway run {}{}",
        shell_word(&report.scene),
        set_arguments(point)
    ));
    true
}

/// Error and uncertainty together; `None` for the reference itself and where there is no result.
fn surely(point: &PointReport, name: &str) -> Option<f64> {
    let result = point.results.get(name)?;
    Some(result.error? + result.uncertainty?)
}

fn least_error(report: &StudyReport, name: &str) -> Option<f64> {
    let errors = report.points.iter().filter_map(|p| surely(p, name));
    errors.min_by(f64::total_cmp)
}

fn settings(point: &PointReport) -> String {
    let parts: Vec<String> = point.values.iter().map(|(a, v)| format!("{a} = {v}")).collect();
    parts.join(", ")
}

fn reached(name: &str, unit: &str, result: &ResultReport) -> String {
    let (error, uncertainty) = (result.error.unwrap_or(0.0), result.uncertainty.unwrap_or(0.0));
    let plus = if uncertainty > 0.0 {
        format!(", uncertainty {}", percent(uncertainty))
    } else {
        String::new()
    };
    // One is no unit.
    let unit = if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    };
    format!(
        "{name}: {}{unit}, error {}{plus}",
        digits(result.value),
        percent(error)
    )
}

/// A number with six significant digits.
fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

fn set_arguments(point: &PointReport) -> String {
    point
        .set
        .iter()
        .map(|argument| format!(" --set {}", shell_word(argument)))
        .collect()
}

fn percent(x: f64) -> String {
    let p = 100.0 * x;
    if p == 0.0 || (1e-2..1e4).contains(&p) {
        format!("{p:.3} %")
    } else {
        format!("{p:.2e} %")
    }
}

/// Reads `1%`, `1 %` or `0.01`.
fn parse_error(text: &str) -> Result<f64, String> {
    let error = || format!("{text:?} is no error; expected more than 0, such as 1% or 0.01");
    let (number, factor) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 1e-2),
        None => (text, 1.0),
    };
    let x: f64 = number.trim().parse().map_err(|_| error())?;
    let x = factor * x;
    if x > 0.0 && x.is_finite() {
        Ok(x)
    } else {
        Err(error())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a displacement of 8.1 um would be shown as 0.000008, and nobody would know of what.
    #[test]
    fn values_have_significant_digits_and_their_unit() {
        let result = ResultReport {
            value: 8.123456e-6,
            reference: None,
            error: Some(0.01),
            uncertainty: None,
            is_reference: false,
            pareto: true,
        };
        assert_eq!(reached("z", "m", &result), "z: 8.12346e-6 m, error 1.000 %");
        assert_eq!(
            [digits(1234.5678), digits(0.0), digits(-0.25)],
            ["1234.57", "0", "-0.25"]
        );
        assert_eq!(reached("share", "1", &result), "share: 8.12346e-6, error 1.000 %");
    }

    /// Wrong: an error would be taken for a hundred times itself.
    #[test]
    fn errors_are_read_with_and_without_percent() {
        assert_eq!(parse_error("1%"), Ok(0.01));
        assert_eq!(parse_error("0.5 %"), Ok(0.005));
        assert_eq!(parse_error("0.02"), Ok(0.02));
        for bad in ["0", "-1%", "%", "one", "nan", "inf"] {
            let text = parse_error(bad).unwrap_err();
            assert!(text.contains("is no error; expected more than 0"), "{text}");
        }
    }
}
