//! Rain-flow cycles and their damage at nodes, as the run goes on.

use checkpoint::StateArray;
use rayon::prelude::*;
use scene::CycleDamage;

use crate::rainflow::{Cycle, OpenHistory};
use crate::state_arrays::Arrays;

const LENGTHS: &str = "reduction_open_lengths";
const OPEN: &str = "reduction_open_points";
const DAMAGE: &str = "reduction_damage";
const CYCLES: &str = "reduction_cycles";
/// Nodes that a thread takes at least.
const NODES_AT_ONCE: usize = 256;

/// Nodes whose cycles are counted.
#[derive(Clone)]
pub struct NodeHistories {
    asked: CycleDamage,
    /// Their numbers among those of both rings, growing.
    nodes: Vec<usize>,
    counts: Vec<NodeCount>,
}

/// What is known of a node.
#[derive(Clone, Debug, Default)]
struct NodeCount {
    open: OpenHistory,
    /// Damage and number of the cycles that are closed.
    damage: f64,
    cycles: f64,
}

impl NodeHistories {
    /// Nothing yet.
    pub fn new(asked: CycleDamage, nodes: Vec<usize>) -> NodeHistories {
        NodeHistories {
            asked,
            counts: vec![NodeCount::default(); nodes.len()],
            nodes,
        }
    }

    /// Goes on with the stress of a step, Pa, of the nodes of both rings.
    pub fn add(&mut self, stress: &[f64]) {
        let asked = self.asked;
        let counts = self.counts.par_iter_mut().zip(&self.nodes);
        counts.with_min_len(NODES_AT_ONCE).for_each(|(count, &node)| {
            let (damage, cycles) = (&mut count.damage, &mut count.cycles);
            count.open.push(stress[node], asked.least_range, |cycle| {
                *damage += damage_of(cycle, asked);
                *cycles += cycle.count;
            });
        });
    }

    /// Damage and cycles of all points, if the run ends here; NaN where they are not counted.
    pub fn fields(&self, n_points: usize) -> [(&'static str, Vec<f64>); 2] {
        let [mut damage, mut cycles] = [vec![f64::NAN; n_points], vec![f64::NAN; n_points]];
        for (&node, count) in self.nodes.iter().zip(&self.counts) {
            let rest = count.open.rest(self.asked.least_range);
            damage[node] = rest
                .iter()
                .fold(count.damage, |sum, &cycle| sum + damage_of(cycle, self.asked));
            cycles[node] = rest.iter().fold(count.cycles, |sum, cycle| sum + cycle.count);
        }
        [("damage", damage), ("cycles", cycles)]
    }

    /// Adds the arrays of all nodes.
    pub fn store(&self, arrays: &mut Arrays) {
        let lengths = self.counts.iter().map(|count| count.open.points.len() as i64);
        arrays.insert(LENGTHS.to_string(), StateArray::Integer(lengths.collect()));
        let mut add =
            |name: &str, values: Vec<f64>| arrays.insert(name.to_string(), StateArray::Real(values));
        let open = self.counts.iter().flat_map(|count| &count.open.points);
        add(OPEN, open.copied().collect());
        add(DAMAGE, self.counts.iter().map(|count| count.damage).collect());
        add(CYCLES, self.counts.iter().map(|count| count.cycles).collect());
    }

    /// Reads them; None if they are of other nodes.
    pub fn load(&mut self, arrays: &Arrays) -> Option<()> {
        let reals = |name: &str| match arrays.get(name) {
            Some(StateArray::Real(values)) => Some(values),
            _ => None,
        };
        let Some(StateArray::Integer(lengths)) = arrays.get(LENGTHS) else {
            return None;
        };
        let (open, damage, cycles) = (reals(OPEN)?, reals(DAMAGE)?, reals(CYCLES)?);
        let n = self.counts.len();
        if [lengths.len(), damage.len(), cycles.len()] != [n; 3] {
            return None;
        }
        let mut rest = &open[..];
        for (i, count) in self.counts.iter_mut().enumerate() {
            let (points, others) = rest.split_at_checked(usize::try_from(lengths[i]).ok()?)?;
            rest = others;
            *count = NodeCount {
                open: OpenHistory {
                    points: points.to_vec(),
                },
                damage: damage[i],
                cycles: cycles[i],
            };
        }
        rest.is_empty().then_some(())
    }
}

/// Share of the life that a cycle takes: its count over N = N_ref (S / S_ref)^-k, S half its range.
fn damage_of(cycle: Cycle, asked: CycleDamage) -> f64 {
    let amplitude = 0.5 * cycle.range / asked.reference_amplitude;
    cycle.count * amplitude.powf(asked.exponent) / asked.reference_cycles
}

#[cfg(test)]
mod tests {
    use scene::{DamageNodes, DamageStress};

    use super::*;

    /// A line with k = 3 and N_ref = 1000 at 100 Pa.
    fn asked(least_range: f64) -> CycleDamage {
        CycleDamage {
            stress: DamageStress::SignedVonMises,
            exponent: 3.0,
            reference_amplitude: 100.0,
            reference_cycles: 1000.0,
            least_range,
            nodes: DamageNodes::All,
        }
    }

    /// Wrong: a run that was resumed before its stress had turned would count other cycles, or one that has not swung
    /// would have damage. A sine of 190 Pa from its mean, swings above 100 Pa, a restart state at every value.
    #[test]
    fn a_history_that_has_not_turned_goes_on_from_a_restart_state() {
        let mut whole = NodeHistories::new(asked(100.0), vec![0]);
        let mut cut = NodeHistories::new(asked(100.0), vec![0]);
        for step in 0..400 {
            let value = 95.0 * (std::f64::consts::TAU * f64::from(step) / 40.0).sin();
            whole.add(&[value]);
            cut.add(&[value]);
            let mut arrays = Arrays::new();
            cut.store(&mut arrays);
            cut = NodeHistories::new(asked(100.0), vec![0]);
            cut.load(&arrays).unwrap();
            let [[(_, damage), (_, cycles)], [(_, again), (_, cycles_again)]] =
                [&whole, &cut].map(|h| h.fields(1));
            assert_eq!(again[0].to_bits(), damage[0].to_bits(), "{step}");
            assert_eq!(cycles_again, cycles, "{step}");
            assert_eq!(damage[0] > 0.0, step > 20, "{step}");
        }
        let [_, (_, cycles)] = whole.fields(1);
        assert_eq!(cycles, [9.5]);
    }

    /// Wrong: damage would not be Miner's sum by the S-N line, or counts would be lost in a restart state. Twenty half
    /// cycles of the reference amplitude and ten cycles of half of it, with k = 3 and N_ref = 1000: (10 + 10/8) / 1000.
    #[test]
    fn damage_is_the_sum_over_the_cycles_by_the_line() {
        let asked = asked(0.0);
        let mut values: Vec<f64> = (0..20).map(|i| if i % 2 == 0 { 100.0 } else { -100.0 }).collect();
        values.extend((0..20).map(|i| if i % 2 == 0 { 50.0 } else { -50.0 }));
        values.push(100.0);
        let mut whole = NodeHistories::new(asked, vec![1]);
        let mut cut = NodeHistories::new(asked, vec![1]);
        for (i, &value) in values.iter().enumerate() {
            whole.add(&[0.0, value]);
            cut.add(&[0.0, value]);
            if i % 7 == 0 {
                let mut arrays = Arrays::new();
                cut.store(&mut arrays);
                cut = NodeHistories::new(asked, vec![1]);
                cut.load(&arrays).unwrap();
            }
        }
        let [(_, damage), (_, cycles)] = whole.fields(3);
        assert!(damage[0].is_nan() && damage[2].is_nan());
        assert!((cycles[1] - 20.0).abs() < 1e-12, "{}", cycles[1]);
        let expected = (10.0 + 10.0 / 8.0) / 1000.0;
        assert!(
            (damage[1] - expected).abs() < 1e-14 * expected.sqrt(),
            "{} for {expected}",
            damage[1]
        );
        let [(_, again), _] = cut.fields(3);
        assert_eq!(again[1].to_bits(), damage[1].to_bits());
    }
}
