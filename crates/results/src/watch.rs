//! Watches a motion for contacts beyond their limits: a line in the log at the first step of every ball, a count in
//! the summary.

use checkpoint::StateArray;
use contact::Side;
use dynamics::Surfaces;
use dynamics::motion::{ContactLimit, Exceeded};

use crate::state_arrays::Arrays;

/// Array of a step file that counts contacts beyond their limits since the start of the run.
const ARRAY: &str = "contacts_beyond_limits";

/// What was seen since the start of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Watch {
    /// First step of every contact beyond each limit, by site; 0: never.
    first: [Vec<u64>; 2],
    /// Steps in which any contact was beyond each limit.
    steps: [u64; 2],
}

impl Watch {
    /// Of a bearing that nobody has watched yet.
    pub fn new(n_balls: usize) -> Watch {
        Watch {
            first: [vec![0; 2 * n_balls], vec![0; 2 * n_balls]],
            steps: [0; 2],
        }
    }

    /// Notes the contacts beyond limits at a step, and says what a log should, once per ball.
    pub fn note(&mut self, step: u64, time: f64, found: &[Exceeded]) -> Vec<String> {
        let mut texts = Vec::new();
        for (k, limit) in ContactLimit::ALL.into_iter().enumerate() {
            let now: Vec<&Exceeded> = found.iter().filter(|e| e.limit == limit).collect();
            self.steps[k] += u64::from(!now.is_empty());
            for e in now {
                let first = &mut self.first[k];
                let said = first[2 * e.ball] != 0 || first[2 * e.ball + 1] != 0;
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
        let all = self.steps.iter().chain(self.first.iter().flatten());
        all.map(|n| i64::try_from(*n).expect("nobody counts to 2^63"))
            .collect()
    }

    /// From the numbers of a step file; None when they are of another bearing.
    fn from_numbers(n_balls: usize, numbers: &[i64]) -> Option<Watch> {
        if numbers.len() != 2 + 4 * n_balls || numbers.iter().any(|n| *n < 0) {
            return None;
        }
        let numbers: Vec<u64> = numbers.iter().map(|n| n.unsigned_abs()).collect();
        let (steps, first) = numbers.split_at(2);
        let (edge, pressure) = first.split_at(2 * n_balls);
        Some(Watch {
            first: [edge.to_vec(), pressure.to_vec()],
            steps: [steps[0], steps[1]],
        })
    }
}

fn event(limit: ContactLimit, ball: usize, side: Side, pressure: Option<f64>) -> String {
    let side = side.name();
    match limit {
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
        ContactLimit::StaticPressure => "there it yields (ISO 76), which this model does not know",
    }
}
