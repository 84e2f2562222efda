//! The numbers as text.

use std::fmt::Write;

use crate::numbers::Measured;
use crate::rules::Number;

/// A table in Markdown, its columns aligned.
pub fn table(start: &str, measured: &[(&Number, Measured)]) -> String {
    let start = format!("at {start}");
    let titles = ["number", &start, "now", "at most", "to reach"];
    let mut rows = vec![titles.map(str::to_owned)];
    for (number, measured) in measured {
        rows.push([
            number.name.clone(),
            number.at_start.to_string(),
            measured.value.to_string(),
            number.most.map_or("-".to_owned(), |most| most.to_string()),
            number.reach.clone(),
        ]);
    }
    let widths: Vec<usize> = (0..titles.len())
        .map(|column| {
            rows.iter()
                .map(|row| row[column].chars().count())
                .max()
                .unwrap_or(0)
        })
        .collect();
    let mut text = String::new();
    for (i, row) in rows.iter().enumerate() {
        for (column, cell) in row.iter().enumerate() {
            let width = widths[column];
            // Text on the left, numbers on the right.
            let _ = match column {
                1..=3 => write!(text, "| {cell:>width$} "),
                _ => write!(text, "| {cell:<width$} "),
            };
        }
        text.push_str("|\n");
        if i == 0 {
            for width in &widths {
                let _ = write!(text, "|{}", "-".repeat(width + 2));
            }
            text.push_str("|\n");
        }
    }
    text
}

/// Lines of code of each crate, in one line.
pub fn lines_by_crate(lines: &[(&str, usize)]) -> String {
    let crates: Vec<String> = lines
        .iter()
        .map(|(name, lines)| format!("{name} {lines}"))
        .collect();
    format!("code lines by crate: {}", crates.join(", "))
}
