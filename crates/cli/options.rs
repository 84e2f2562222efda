//! What the command line says about a run besides its scene.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::time::Duration;

use anyhow::anyhow;
use clap::Args;
use results::failure::Failure;
use results::stop::parse_wall_time;
use scene::Analysis;

/// Limits of a run.
#[derive(Clone, Debug, Default, Args)]
pub struct Limits {
    /// Stops between two steps, or points of a sweep, before this time is used up, with exit code 75 and how to go on.
    #[arg(long, value_name = "HH:MM:SS", value_parser = parse_wall_time)]
    pub wall_time: Option<Duration>,
    /// Starts even when the forecast of the output does not fit the disk.
    #[arg(long)]
    pub ignore_disk_space: bool,
}

/// Some of the points of a sweep, one after the other, by their numbers from 0; the last is among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SweepPart {
    first: usize,
    last: usize,
}

impl fmt::Display for SweepPart {
    /// As `--points` takes it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.first == self.last {
            true => write!(f, "{}", self.first),
            false => write!(f, "{}-{}", self.first, self.last),
        }
    }
}

impl SweepPart {
    /// The parts that numbers make up; they grow.
    pub fn of_numbers(numbers: impl IntoIterator<Item = usize>) -> Vec<SweepPart> {
        let mut parts: Vec<SweepPart> = Vec::new();
        for number in numbers {
            match parts.last_mut() {
                Some(part) if part.last + 1 == number => part.last = number,
                _ => parts.push(SweepPart {
                    first: number,
                    last: number,
                }),
            }
        }
        parts
    }

    /// How many points it has.
    pub fn n_points(self) -> usize {
        self.range().len()
    }

    /// The points as a range.
    pub fn range(self) -> Range<usize> {
        self.first..self.last + 1
    }

    /// Refuses a scene that has no such points.
    pub fn check(self, scene: &Path, analysis: &Analysis) -> Result<(), Failure> {
        let Analysis::Sweep(sweep) = analysis else {
            return Err(Failure::User(anyhow!(
                "--points chooses points of a [sweep], and {} has none",
                scene.display()
            )));
        };
        let n = sweep.points.len();
        if self.last >= n {
            return Err(Failure::User(anyhow!(
                "--points names point {}, but the sweep of {} has {n}, from 0 to {}",
                self.last,
                scene.display(),
                n - 1
            )));
        }
        Ok(())
    }
}

/// Reads a number, or the first and the last of several: 3 or 0-9.
pub fn parse_part(text: &str) -> Result<SweepPart, String> {
    let error =
        || format!("{text:?} names no points; expected a number or the first and the last, such as 3 or 0-9");
    let number = |part: &str| {
        let digits = !part.is_empty() && part.len() <= 6 && part.bytes().all(|b| b.is_ascii_digit());
        digits
            .then(|| part.parse::<usize>().ok())
            .flatten()
            .ok_or_else(error)
    };
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let part = SweepPart {
        first: number(first)?,
        last: number(last)?,
    };
    (part.first <= part.last).then_some(part).ok_or_else(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a user would be told to compute points that are there, or not all of those that are missing.
    #[test]
    fn numbers_make_up_parts_as_points_takes_them() {
        let parts = SweepPart::of_numbers([0, 1, 2, 5, 7, 8]);
        let texts: Vec<String> = parts.iter().map(SweepPart::to_string).collect();
        assert_eq!(texts, ["0-2", "5", "7-8"]);
        let again: Result<Vec<SweepPart>, String> = texts.iter().map(|text| parse_part(text)).collect();
        assert_eq!(again, Ok(parts));
        assert!(SweepPart::of_numbers([]).is_empty());
    }

    /// Wrong: a job of an array would solve other points than it was given.
    #[test]
    fn points_are_a_number_or_the_first_and_the_last() {
        let range = |text| parse_part(text).map(SweepPart::range);
        assert_eq!(range("3"), Ok(3..4));
        assert_eq!(range("0-9"), Ok(0..10));
        for bad in ["", "-1", "3-", "9-0", "a", "1-2-3", "1.5"] {
            let text = range(bad).unwrap_err();
            assert!(
                text.starts_with(&format!("{bad:?} names no points; expected")),
                "{text}"
            );
        }
    }
}
