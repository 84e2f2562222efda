//! Point search over a raceway: a uniform grid of bins over (azimuth, groove angle), and the boxes of the facets in it.

use std::f64::consts::PI;

/// How far the box of a facet's nodes is grown, as a share of its size, to hold all points that are taken for the
/// facet's.
const BOX_GROWTH: f64 = 0.05;

/// Which facets may hold a point.
pub(crate) struct Bins {
    n: [usize; 2],
    low: f64,
    width: [f64; 2],
    start: Vec<usize>,
    facets: Vec<usize>,
}

/// Box of points (azimuth, groove angle), grown.
pub(crate) fn grown_box(points: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for x in points {
        for i in 0..2 {
            low[i] = low[i].min(x[i]);
            high[i] = high[i].max(x[i]);
        }
    }
    let grow = [0, 1].map(|i| BOX_GROWTH * (high[i] - low[i]));
    [
        [low[0] - grow[0], low[1] - grow[1]],
        [high[0] + grow[0], high[1] + grow[1]],
    ]
}

impl Bins {
    /// Grid of about one facet per bin; a facet is listed in every bin its box touches.
    pub fn new(boxes: &[[[f64; 2]; 2]], angle_range: [f64; 2]) -> Bins {
        let side = ((boxes.len() as f64).sqrt().ceil() as usize).max(1);
        // A raceway is long and narrow: many bins round, few across.
        let count = [(8 * side).max(1), side.div_ceil(8).max(1)];
        let height = (angle_range[1] - angle_range[0]).max(f64::MIN_POSITIVE);
        let width = [2.0 * PI / count[0] as f64, height / count[1] as f64];
        let mut bins = Bins {
            n: count,
            low: angle_range[0],
            width,
            start: Vec::new(),
            facets: Vec::new(),
        };
        let mut lists: Vec<Vec<usize>> = vec![Vec::new(); count[0] * count[1]];
        for (f, extent) in boxes.iter().enumerate() {
            bins.for_each_bin(*extent, |bin| lists[bin].push(f));
        }
        bins.start = std::iter::once(0)
            .chain(lists.iter().scan(0, |sum, l| {
                *sum += l.len();
                Some(*sum)
            }))
            .collect();
        bins.facets = lists.concat();
        bins
    }

    fn for_each_bin(&self, [low, high]: [[f64; 2]; 2], mut visit: impl FnMut(usize)) {
        let first = (low[0] / self.width[0]).floor() as i64;
        let last = ((high[0] / self.width[0]).floor() as i64).min(first + self.n[0] as i64 - 1);
        for i in first..=last {
            for j in self.row(low[1])..=self.row(high[1]) {
                visit(i.rem_euclid(self.n[0] as i64) as usize * self.n[1] + j);
            }
        }
    }

    fn row(&self, angle: f64) -> usize {
        (((angle - self.low) / self.width[1]).floor().max(0.0) as usize).min(self.n[1] - 1)
    }

    /// Facets whose boxes touch the bin of a point.
    pub fn candidates(&self, azimuth: f64, angle: f64) -> &[usize] {
        let column = ((azimuth / self.width[0]).floor() as i64).rem_euclid(self.n[0] as i64) as usize;
        let bin = column * self.n[1] + self.row(angle);
        &self.facets[self.start[bin]..self.start[bin + 1]]
    }
}
