//! What a case found: its checks, with the numbers, and what is worth showing.

use std::fmt;

use super::course::Course;
use super::plot::Plot;

/// Largest ledger defect over the largest energy.
pub const LEDGER: f64 = 1e-6;

/// Findings of a case.
#[derive(Default)]
pub struct Record {
    checks: Vec<(String, bool)>,
    /// Largest ledger defect of its motions over the largest energy.
    pub defect: Option<f64>,
    /// What happened, for people.
    pub happened: Vec<String>,
    /// Curves for the page.
    pub plot: Option<Plot>,
    /// Further tables for the page, as Markdown.
    pub tables: Vec<String>,
}

impl Record {
    /// A statement must be true.
    pub fn that(&mut self, what: &str, holds: bool) {
        self.checks.push((what.to_string(), holds));
    }

    /// A number must not exceed its limit; NaN does.
    pub fn below(&mut self, what: &str, value: f64, limit: f64) {
        self.checks
            .push((format!("{what} {value:.3e} <= {limit:.3e}"), value <= limit));
    }

    /// A number must be another one to a share of that.
    pub fn near(&mut self, what: &str, value: f64, expected: f64, share: f64) {
        let error = (value - expected).abs() / expected.abs();
        self.checks.push((
            format!("{what} {value:.6e}, expected {expected:.6e} to {share:.1e}"),
            error <= share,
        ));
    }

    /// An error must say this.
    pub fn says(&mut self, error: &str, part: &str) {
        self.happened.push(format!("\"{error}\""));
        self.checks
            .push((format!("the error says \"{part}\""), error.contains(part)));
    }

    /// A remark for the page.
    pub fn note(&mut self, text: impl Into<String>) {
        self.happened.push(text.into());
    }

    /// A motion must have come to its end with a ledger that closes.
    pub fn closed(&mut self, course: &Course) {
        self.that(
            &format!("all {} steps are done{}", course.wanted, course.ending()),
            course.error.is_none(),
        );
        self.note_defect(course.defect);
        self.below("ledger defect", course.defect, LEDGER);
        self.that("all numbers are finite", course.is_finite());
    }

    /// Keeps the largest defect for the page.
    pub fn note_defect(&mut self, defect: f64) {
        self.defect = Some(self.defect.unwrap_or(0.0).max(defect));
    }

    /// What does not hold.
    pub fn failures(&self) -> Vec<String> {
        let failed = self.checks.iter().filter(|c| !c.1);
        failed.map(|c| c.0.clone()).collect()
    }

    /// What holds.
    pub fn held(&self) -> Vec<String> {
        let held = self.checks.iter().filter(|c| c.1);
        held.map(|c| c.0.clone()).collect()
    }
}

impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let checks = self.checks.iter();
        let texts: Vec<String> = checks
            .map(|(text, holds)| {
                if *holds {
                    text.clone()
                } else {
                    format!("NOT {text}")
                }
            })
            .collect();
        write!(f, "{} [{}]", texts.join("; "), self.happened.join("; "))
    }
}
