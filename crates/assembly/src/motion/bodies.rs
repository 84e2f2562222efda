//! Bodies that carry several bearings, over a part of a step.
//!
//! Every bearing moves the whole body, its own seat by the forces of its joint, and the oscillators besides by the mean
//! loads of the other bearings. A round hands these on. Over a step the inertia of the body holds most of what one
//! bearing does away from the others, so rounds contract fast: by about the share of the ring's mass in that of the
//! body. What the ledger of a bearing says of its body includes what the others do to it, as imposed work.

use dynamics::motion::held::{HeldPart, Holding};

use crate::housing::HousedTogether;
use crate::mixing::{Mixing, dot};

/// Change of the loads over their size at which they stay as they are. The ledger of each bearing closes with any
/// loads; what is left makes the copies of a body differ.
const LIMIT: f64 = 1e-10;
/// The same where rounds no longer contract.
const FLOOR: f64 = 1e-8;
/// The same above which the shaft need not move before bearings have answered to the new loads.
const FAR: f64 = 0.1;
/// A round that leaves more than this of the change before it contracts slowly: the next point is that of the mixing.
/// Elsewhere that would only spread round-off.
const SLOW: f64 = 0.2;
/// A round that leaves more than this of the change before it no longer contracts.
const STALLED: f64 = 0.5;

/// Loads on the oscillators of shared bodies.
pub struct SharedLoads<'a> {
    bodies: Vec<SharedLoad<'a>>,
}

/// Loads on one body.
struct SharedLoad<'a> {
    housed: &'a HousedTogether,
    /// Of each bearing, one after the other; empty before the first round.
    loads: Vec<f64>,
    mixing: Mixing,
    /// Last change over the size.
    change: f64,
}

impl<'a> SharedLoads<'a> {
    /// Loads of the bearings in each body, none yet.
    pub fn new(housed: &'a [HousedTogether]) -> SharedLoads<'a> {
        let body = |housed: &'a HousedTogether| SharedLoad {
            housed,
            loads: Vec::new(),
            mixing: Mixing::default(),
            change: f64::INFINITY,
        };
        SharedLoads {
            bodies: housed.iter().map(body).collect(),
        }
    }

    /// Name of the body whose loads changed most in the last exchange, and their change over their size.
    pub fn worst(&self) -> Option<(&str, f64)> {
        let changes = self
            .bodies
            .iter()
            .map(|body| (&body.housed.name[..], body.change));
        changes.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Whether the last exchange changed much: nothing is near its end yet.
    pub fn are_far(&self) -> bool {
        let far = FAR..f64::INFINITY;
        self.bodies.iter().any(|body| far.contains(&body.change))
    }

    /// Hands on the loads of the last answers; settled if no bearing is told anything new.
    pub fn exchange(&mut self, parts: &mut [HeldPart<'_>]) -> Holding {
        let mut holding = Holding::Settled;
        for body in &mut self.bodies {
            if body.exchange(parts) == Holding::Again {
                holding = Holding::Again;
            }
        }
        holding
    }
}

impl SharedLoad<'_> {
    fn exchange(&mut self, parts: &mut [HeldPart<'_>]) -> Holding {
        let HousedTogether { side, bearings, .. } = self.housed;
        let answers = bearings.iter().map(|&i| parts[i].load_on_body(*side));
        let found: Vec<f64> = answers.flat_map(Option::unwrap_or_default).collect();
        if self.loads.is_empty() {
            self.loads = vec![0.0; found.len()];
        }
        let size = dot(&found, &found).sqrt();
        let off: Vec<f64> = found.iter().zip(&self.loads).map(|(g, x)| g - x).collect();
        let change = dot(&off, &off).sqrt() / size.max(f64::MIN_POSITIVE);
        let stalls = change > STALLED * self.change && change <= FLOOR;
        let is_slow = change > SLOW * self.change;
        if change <= LIMIT || stalls {
            // What changes after this is new, such as turning frames: earlier rounds say nothing of it.
            self.change = f64::INFINITY;
            self.mixing = Mixing::default();
            return Holding::Settled;
        }
        self.change = change;
        let mixed = self.mixing.next(std::mem::take(&mut self.loads), &found);
        self.loads = if is_slow { mixed } else { found };
        let n = self.loads.len() / bearings.len();
        for (number, &i) in bearings.iter().enumerate() {
            let of_others = |k: usize| -> f64 {
                let others = (0..bearings.len()).filter(|other| *other != number);
                others.map(|other| self.loads[n * other + k]).sum()
            };
            parts[i].load_body(*side, (0..n).map(of_others).collect());
        }
        Holding::Again
    }
}
