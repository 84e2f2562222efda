//! Watches a motion for contacts beyond their limits: a line in the log at the first step of every ball, a count in
//! the summary.

use checkpoint::StateArray;
use contact::Side;
use dynamics::motion::{ContactLimit, Exceeded};
use dynamics::{Surfaces, shoulders};

use crate::state_arrays::Arrays;

/// Array of a step file that counts contacts beyond their limits since the start of the run.
const ARRAY: &str = "contacts_beyond_limits";

/// Number of limits.
const N_LIMITS: usize = ContactLimit::ALL.len();
/// Those that every step file counts; the others stand behind them where a contact was beyond one.
const ALWAYS_COUNTED: usize = 2;

/// What was seen since the start of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Watch {
    /// First step of every contact beyond each limit, by site; 0: never.
    first: [Vec<u64>; N_LIMITS],
    /// Steps in which any contact was beyond each limit.
    steps: [u64; N_LIMITS],
}

impl Watch {
    /// Of a bearing that nobody has watched yet.
    pub fn new(n_balls: usize) -> Watch {
        Watch {
            first: std::array::from_fn(|_| vec![0; 2 * n_balls]),
            steps: [0; N_LIMITS],
        }
    }

    /// Notes the contacts beyond limits at a step, and says what a log should: once per ball, of balls on the wrong
    /// shoulder once.
    pub fn note(&mut self, step: u64, time: f64, found: &[Exceeded]) -> Vec<String> {
        let mut texts = Vec::new();
        for (k, limit) in ContactLimit::ALL.into_iter().enumerate() {
            let now: Vec<&Exceeded> = found.iter().filter(|e| e.limit == limit).collect();
            self.steps[k] += u64::from(!now.is_empty());
            for e in now {
                let first = &mut self.first[k];
                let said = match limit {
                    // A bearing that comes apart does so with all its balls.
                    ContactLimit::WrongShoulder => first.iter().any(|step| *step != 0),
                    _ => first[2 * e.ball] != 0 || first[2 * e.ball + 1] != 0,
                };
                let own = &mut first[2 * e.ball + e.side.index()];
                if *own == 0 {
                    *own = step;
                }
                if !said {
                    texts.push(format!(
                        "step {step}, t = {time:.6e} s: {}",
                        event(limit, e.ball, e.side, Some(e.pressure))
                    ));
                }
            }
        }
        texts
    }

    /// A line for the summary per limit that was exceeded; `time` of a step, s.
    pub fn warnings(&self, surfaces: &Surfaces, time: impl Fn(u64) -> f64) -> Vec<String> {
        let mut texts = Vec::new();
        for (k, limit) in ContactLimit::ALL.into_iter().enumerate() {
            let seen = self.first[k].iter().enumerate().filter(|(_, step)| **step > 0);
            let Some((site, &step)) = seen.min_by_key(|(_, step)| **step) else {
                continue;
            };
            let balls = self.first[k]
                .chunks(2)
                .filter(|c| c.iter().any(|s| *s > 0))
                .count();
            texts.push(format!(
                "in motion, {} of {} balls, in {} steps, first at step {step}, t = {:.6e} s: {}; {}",
                balls,
                self.first[k].len() / 2,
                self.steps[k],
                time(step),
                event(limit, site / 2, Side::BOTH[site % 2], None),
                meaning(limit, surfaces, Side::BOTH[site % 2])
            ));
        }
        texts
    }

    /// Puts the counts into the arrays of a step file.
    pub fn put(&self, arrays: &mut Arrays) {
        arrays.insert(ARRAY.to_string(), StateArray::Integer(self.to_numbers()));
    }

    /// Takes the counts of a bearing out of the arrays of a step file; None where they are not there.
    pub fn take(arrays: &mut Arrays, n_balls: usize) -> Option<Watch> {
        match arrays.remove(ARRAY) {
            Some(StateArray::Integer(numbers)) => Watch::from_numbers(n_balls, &numbers),
            _ => None,
        }
    }

    /// As numbers of a step file: steps, then first steps.
    fn to_numbers(&self) -> Vec<i64> {
        let counted = match self.steps[ALWAYS_COUNTED..].iter().any(|n| *n > 0) {
            true => N_LIMITS,
            false => ALWAYS_COUNTED,
        };
        let all = self.steps[..counted]
            .iter()
            .chain(self.first[..counted].iter().flatten());
        all.map(|n| i64::try_from(*n).expect("nobody counts to 2^63"))
            .collect()
    }

    /// From the numbers of a step file; None when they are of another bearing.
    fn from_numbers(n_balls: usize, numbers: &[i64]) -> Option<Watch> {
        let is_of = |counted: &usize| numbers.len() == counted * (1 + 2 * n_balls);
        let counted = [ALWAYS_COUNTED, N_LIMITS].into_iter().find(is_of)?;
        if numbers.iter().any(|n| *n < 0) {
            return None;
        }
        let numbers: Vec<u64> = numbers.iter().map(|n| n.unsigned_abs()).collect();
        let (steps, first) = numbers.split_at(counted);
        let mut watch = Watch::new(n_balls);
        watch.steps[..counted].copy_from_slice(steps);
        for (own, found) in watch.first.iter_mut().zip(first.chunks(2 * n_balls)) {
            own.copy_from_slice(found);
        }
        Some(watch)
    }
}

fn event(limit: ContactLimit, ball: usize, side: Side, pressure: Option<f64>) -> String {
    let side = side.name();
    match limit {
        ContactLimit::WrongShoulder => {
            format!("ball {ball} carries on the wrong shoulder of the {side} raceway")
        }
        ContactLimit::Edge => format!("edge contact of ball {ball} on the {side} raceway"),
        ContactLimit::StaticPressure => {
            let value = pressure.map_or(String::new(), |p| format!(" of {:.2} GPa", 1e-9 * p));
            format!(
                "a peak pressure{value} at ball {ball}, {side} raceway, above the static limit of bearing steel, 4.2 \
                 GPa"
            )
        }
    }
}

fn meaning(limit: ContactLimit, surfaces: &Surfaces, side: Side) -> &'static str {
    match limit {
        ContactLimit::Edge => surfaces.edge_meaning(side),
        ContactLimit::WrongShoulder => shoulders::MEANING,
        ContactLimit::StaticPressure => "there it yields (ISO 76), which this model does not know",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exceeded(limit: ContactLimit, ball: usize) -> Exceeded {
        Exceeded {
            limit,
            ball,
            side: Side::Outer,
            pressure: 5e9,
        }
    }

    /// Wrong: step files of bearings that carry as they should would change, or a resumed run forget what it has seen.
    #[test]
    fn counts_come_back_and_the_wrong_shoulder_stands_in_step_files_only_where_it_was_seen() {
        let mut watch = Watch::new(3);
        watch.note(4, 0.4, &[exceeded(ContactLimit::Edge, 1)]);
        assert_eq!(watch.to_numbers().len(), 2 + 2 * 6);
        assert_eq!(Watch::from_numbers(3, &watch.to_numbers()).as_ref(), Some(&watch));
        watch.note(5, 0.5, &[exceeded(ContactLimit::WrongShoulder, 2)]);
        assert_eq!(watch.to_numbers().len(), 3 + 3 * 6);
        assert_eq!(Watch::from_numbers(3, &watch.to_numbers()).as_ref(), Some(&watch));
        assert_eq!(Watch::from_numbers(4, &watch.to_numbers()), None);
    }

    /// Wrong: a log would have a line for every ball of a bearing that comes apart, or none.
    #[test]
    fn a_motion_says_once_that_balls_carry_on_the_wrong_shoulder() {
        let mut watch = Watch::new(3);
        let both = [0, 1].map(|ball| exceeded(ContactLimit::WrongShoulder, ball));
        let said = watch.note(7, 0.5, &both);
        let expected = "step 7, t = 5.000000e-1 s: ball 0 carries on the wrong shoulder of the outer raceway";
        assert_eq!(said, [expected]);
        assert!(watch.note(8, 0.6, &both).is_empty());
        let lines = watch.warnings(&Surfaces::default(), |step| 0.1 * step as f64);
        let expected = "in motion, 2 of 3 balls, in 2 steps, first at step 7, t = 7.000000e-1 s: ball 0 carries on the \
                        wrong shoulder of the outer raceway; an angular contact bearing has a low shoulder there";
        assert!(lines.len() == 1 && lines[0].starts_with(expected), "{lines:?}");
    }
}
