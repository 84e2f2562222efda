//! `study.md`: the table of a study for documents, with date and machine.

use std::fmt::Write;

use super::report::{PointReport, ResultReport, StudyReport};

/// The table as text.
pub fn text(report: &StudyReport) -> String {
    let mut s = String::new();
    // Writing into a string cannot fail.
    let _ = write_all(report, &mut s);
    s
}

fn write_all(report: &StudyReport, s: &mut String) -> std::fmt::Result {
    writeln!(s, "# {}\n", report.title)?;
    writeln!(
        s,
        "Made by `raceway study` on {}, {}, {} of {}. Scene `{}`.\n",
        report.date,
        report.machine,
        count(report.repeats, "run"),
        count(report.threads, "thread"),
        report.scene
    )?;
    for q in &report.quantities {
        if let Some(reference) = &q.reference {
            writeln!(s, "- {}: errors against {reference}", q.name)?;
        }
    }
    writeln!(s)?;
    table(report, s)?;
    notes(report, s)?;
    if !report.orders.is_empty() {
        writeln!(
            s,
            "\n| measured order of | over | at | order | from points |\n|---|---|---|---|---|"
        )?;
        for order in &report.orders {
            let at: Vec<String> = order.at.iter().map(|(a, v)| format!("{a} {v}")).collect();
            writeln!(
                s,
                "| {} | {} | {} | {:.2} | {} |",
                order.quantity,
                order.axis,
                at.join(", "),
                order.order,
                order.n_points
            )?;
        }
    }
    Ok(())
}

fn table(report: &StudyReport, s: &mut String) -> std::fmt::Result {
    let mut head: Vec<String> = report.axes.iter().map(|a| a.label.clone()).collect();
    for q in &report.quantities {
        head.push(format!("{}, {}", q.name, q.unit));
        if q.reference.is_some() {
            head.push("error".to_string());
        }
    }
    head.extend(["processor s", "memory MB", "written MB"].map(str::to_string));
    writeln!(s, "| {} |\n|{}", head.join(" | "), "---|".repeat(head.len()))?;
    for point in &report.points {
        writeln!(s, "| {} |", row(report, point).join(" | "))?;
    }
    Ok(())
}

fn row(report: &StudyReport, point: &PointReport) -> Vec<String> {
    let mut cells: Vec<String> = report
        .axes
        .iter()
        .map(|a| point.values[&a.name].clone())
        .collect();
    for q in &report.quantities {
        let result = point.results.get(&q.name);
        cells.push(result.map_or("-".to_string(), |r| format!("{:.6}", Short(r.value))));
        if q.reference.is_some() {
            cells.push(result.map_or("-".to_string(), error));
        }
    }
    match &point.cost {
        Some(c) => {
            let mark = if c.disturbed.is_empty() { "" } else { "*" };
            let spread = if report.repeats > 1 {
                format!(" ({:.2} to {:.2})", c.cpu_s.min, c.cpu_s.max)
            } else {
                String::new()
            };
            cells.push(format!("{:.2}{spread}{mark}", c.cpu_s.median));
            cells.push(format!("{:.0}", 1e-6 * c.peak_memory_bytes));
            cells.push(format!("{:.2}", 1e-6 * c.bytes_written));
        }
        None => cells.extend([point.status.clone(), String::new(), String::new()]),
    }
    cells
}

/// An error with its mark: **bold** on the front, `<` below the uncertainty of the reference.
fn error(result: &ResultReport) -> String {
    if result.is_reference {
        return "reference".to_string();
    }
    let (Some(error), Some(uncertainty)) = (result.error, result.uncertainty) else {
        return "-".to_string();
    };
    let text = if error <= uncertainty {
        format!("< {uncertainty:.1e}")
    } else {
        format!("{error:.1e}")
    };
    if result.pareto {
        format!("**{text}**")
    } else {
        text
    }
}

fn notes(report: &StudyReport, s: &mut String) -> std::fmt::Result {
    let is = |f: &dyn Fn(&PointReport) -> bool| report.points.iter().any(f);
    if report.quantities.iter().any(|q| q.reference.is_some()) {
        writeln!(
            s,
            "\nErrors are relative; **bold**: no other point has a smaller error at a lower {}.",
            report.cost.label().split(',').next().unwrap_or_default()
        )?;
        writeln!(s, "`<`: not to be told from the uncertainty of the reference.")?;
    }
    if is(&|p| p.cost.as_ref().is_some_and(|c| !c.disturbed.is_empty())) {
        writeln!(s, "`*`: timed beside other loads of the machine.")?;
    }
    for point in report.points.iter().filter(|p| p.status == "failed") {
        let values: Vec<&str> = report
            .axes
            .iter()
            .map(|a| point.values[&a.name].as_str())
            .collect();
        writeln!(s)?;
        write_failure(s, &values.join(", "), point.reason.as_deref())?;
    }
    Ok(())
}

/// What failed, and why as text of the program.
pub fn write_failure(s: &mut String, what: &str, reason: Option<&str>) -> std::fmt::Result {
    let reason = reason.unwrap_or_default().replace('\n', " ");
    writeln!(s, "Failed: {what}.\n\n```text\n{reason}\n```")
}

fn count(n: usize, noun: &str) -> String {
    if n == 1 {
        format!("1 {noun}")
    } else {
        format!("{n} {noun}s")
    }
}

/// A number in a table: plain between 1e-3 and 1e6, else with an exponent.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let digits = f.precision().unwrap_or(6);
        let size = self.0.abs();
        if size == 0.0 {
            return write!(f, "0");
        }
        if !(1e-3..1e6).contains(&size) {
            return write!(f, "{:.*e}", digits - 1, self.0);
        }
        let decimals = (digits as i32 - 1 - size.log10().floor() as i32).max(0);
        write!(f, "{:.*}", decimals as usize, self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: tables would show fewer digits than they have.
    #[test]
    fn numbers_keep_six_digits() {
        let text = |x: f64| format!("{:.6}", Short(x));
        assert_eq!(text(331.780_12), "331.780");
        assert_eq!(text(0.341_512_345), "0.341512");
        assert_eq!(text(3.445_012_3e-5), "3.44501e-5");
        assert_eq!(text(-2.5e9), "-2.50000e9");
        assert_eq!(text(0.0), "0");
    }
}
