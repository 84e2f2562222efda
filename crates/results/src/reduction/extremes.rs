//! Least, largest and mean values of the stress of a node.

use checkpoint::{StateArray, TableField};

use crate::state_arrays::Arrays;

/// Six components and von Mises stress.
const N: usize = 7;
const LEAST: &str = "reduction_least";
const MOST: &str = "reduction_most";
const SUM: &str = "reduction_sum";

/// What is known of a node, Pa: xx yy zz xy yz xz, von Mises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    least: [f64; N],
    most: [f64; N],
    sum: [f64; N],
}

impl Extremes {
    /// Before the first step.
    pub const NONE: Extremes = Extremes {
        least: [f64::INFINITY; N],
        most: [f64::NEG_INFINITY; N],
        sum: [0.0; N],
    };

    /// Takes the stress of a step into account.
    pub fn add(&mut self, [xx, yy, zz, xy, yz, xz]: [f64; 6], von_mises: f64) {
        let values = [xx, yy, zz, xy, yz, xz, von_mises];
        for (i, value) in values.into_iter().enumerate() {
            self.least[i] = self.least[i].min(value);
            self.most[i] = self.most[i].max(value);
            self.sum[i] += value;
        }
    }
}

/// Adds the arrays of all nodes.
pub fn store(nodes: &[Extremes], arrays: &mut Arrays) {
    let mut add = |name: &str, values: &dyn Fn(&Extremes) -> [f64; N]| {
        let values = nodes.iter().flat_map(values).collect();
        arrays.insert(name.to_string(), StateArray::Real(values));
    };
    add(LEAST, &|node| node.least);
    add(MOST, &|node| node.most);
    add(SUM, &|node| node.sum);
}

/// Reads them; None if they are of other nodes.
pub fn load(nodes: &mut [Extremes], arrays: &Arrays) -> Option<()> {
    let values = |name: &str| match arrays.get(name) {
        Some(StateArray::Real(values)) if values.len() == N * nodes.len() => Some(values.as_chunks::<N>().0),
        _ => None,
    };
    let (least, most, sum) = (values(LEAST)?, values(MOST)?, values(SUM)?);
    for (i, node) in nodes.iter_mut().enumerate() {
        *node = Extremes {
            least: least[i],
            most: most[i],
            sum: sum[i],
        };
    }
    Some(())
}

/// Fields over the nodes after `n` steps.
pub fn fields(nodes: &[Extremes], n: u64) -> Vec<TableField> {
    let n = n as f64;
    type Value = fn(&Extremes, usize, f64) -> f64;
    let kinds: [(&str, Value); 4] = [
        ("minimum", |node, i, _| node.least[i]),
        ("maximum", |node, i, _| node.most[i]),
        ("mean", |node, i, n| node.sum[i] / n),
        ("range", |node, i, _| node.most[i] - node.least[i]),
    ];
    let mut fields = Vec::new();
    for (stress, components) in [("stress", 0..N - 1), ("von_mises", N - 1..N)] {
        for (kind, value) in kinds {
            let mut values = Vec::with_capacity(components.len() * nodes.len());
            for node in nodes {
                values.extend(components.clone().map(|i| value(node, i, n)));
            }
            fields.push(TableField {
                name: format!("{stress}_{kind}"),
                n_components: components.len(),
                values,
            });
        }
    }
    fields
}
