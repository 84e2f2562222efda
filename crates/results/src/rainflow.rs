//! Rain-flow counting of a history, as ASTM E1049-85 (reapproved 2017), section 5.4.4, has it.

/// A counted cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Highest minus lowest value.
    pub range: f64,
    /// Mean of both.
    pub mean: f64,
    /// 1, or 0.5 for a half cycle.
    pub count: f64,
}

/// Peaks and valleys of a history, its ends included; swings of `least` or less are passed over. None of a history
/// that never swings by more.
pub fn turning_points(history: &[f64], least: f64) -> Vec<f64> {
    let mut points: Vec<f64> = Vec::new();
    for &value in history {
        go_on(&mut points, value, least, |_| {});
    }
    if !has_turned(&points, least) {
        points.clear();
    }
    points
}

/// Goes on with a value. Points are the turning points, then the last value, which may yet become one; before the first
/// turning point is found, the least and the largest value, or one if they are equal. `turned` is told of the points
/// where the last of them is a turning point.
fn go_on(points: &mut Vec<f64>, value: f64, least: f64, turned: impl FnOnce(&mut Vec<f64>)) {
    if !has_turned(points, least) {
        return begin(points, value, least);
    }
    let &mut [.., before, ref mut last] = &mut points[..] else {
        unreachable!("a history that has turned has two points");
    };
    // The point before the last is the turning point before it: closing cycles keeps it.
    if (*last > before && value >= *last) || (*last < before && value <= *last) {
        *last = value;
    } else if (value - *last).abs() > least {
        turned(points);
        points.push(value);
    }
}

/// Whether the first turning point is found. Points in a row are more than `least` apart, also after cycles are closed,
/// which takes out the smaller ranges.
fn has_turned(points: &[f64], least: f64) -> bool {
    match *points {
        [] | [_] => false,
        [first, second] => (second - first).abs() > least,
        _ => true,
    }
}

/// Goes on before the first turning point is found. It is the least or the largest value so far, not the first one: a
/// history may start amid its swings.
fn begin(points: &mut Vec<f64>, value: f64, least: f64) {
    let low = points.first().copied().unwrap_or(value);
    let high = points.last().copied().unwrap_or(value);
    points.clear();
    if value - low > least {
        points.extend([low, value]);
    } else if high - value > least {
        points.extend([high, value]);
    } else {
        points.extend([low.min(value), high.max(value)]);
        points.dedup();
    }
}

/// Cycles of a sequence of peaks and valleys, in the order in which they close; what is left at the end are half
/// cycles.
pub fn rainflow(points: &[f64]) -> Vec<Cycle> {
    let (mut open, mut cycles): (Vec<f64>, Vec<Cycle>) = (Vec::new(), Vec::new());
    for &point in points {
        open.push(point);
        close(&mut open, &mut |cycle| cycles.push(cycle));
    }
    cycles.extend(halves(&open));
    cycles
}

/// Takes out of the points that are still open those of the cycles that the last one closes.
fn close(open: &mut Vec<f64>, closed: &mut impl FnMut(Cycle)) {
    while let &[.., a, b, c] = &open[..] {
        if (c - b).abs() < (b - a).abs() {
            break;
        }
        if open.len() == 3 {
            // The range holds the start of the history: half a cycle.
            closed(Cycle::of(a, b, 0.5));
            open.remove(0);
        } else {
            closed(Cycle::of(a, b, 1.0));
            open.truncate(open.len() - 3);
            open.push(c);
        }
    }
}

/// Half cycles between the points that are open at the end.
fn halves(open: &[f64]) -> impl Iterator<Item = Cycle> {
    open.windows(2).map(|pair| Cycle::of(pair[0], pair[1], 0.5))
}

impl Cycle {
    fn of(a: f64, b: f64, count: f64) -> Cycle {
        Cycle {
            range: (a - b).abs(),
            mean: 0.5 * (a + b),
            count,
        }
    }
}

/// A history whose cycles are counted while it goes on: the same as those of [`rainflow`] of its [`turning_points`], in
/// the same order. It remembers the turning points of cycles that are still open, few in a history that repeats
/// itself, and the last value, which may yet become one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpenHistory {
    /// Turning points of open cycles, then the last value; before the first turning point is found, the least and the
    /// largest value, or one if they are equal.
    pub points: Vec<f64>,
}

impl OpenHistory {
    /// Goes on with a value; swings of `least` or less are passed over. Cycles that it closes go to `closed`.
    pub fn push(&mut self, value: f64, least: f64, mut closed: impl FnMut(Cycle)) {
        go_on(&mut self.points, value, least, |points| {
            close(points, &mut closed)
        });
    }

    /// The cycles that are left if the history ends here; `least` as before.
    pub fn rest(&self, least: f64) -> Vec<Cycle> {
        if !has_turned(&self.points, least) {
            return Vec::new();
        }
        let (mut open, mut cycles) = (self.points.clone(), Vec::new());
        close(&mut open, &mut |cycle| cycles.push(cycle));
        cycles.extend(halves(&open));
        cycles
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: cycles would be counted in another way than the standard's. Its example, figure 6: ranges 3, 4, 6, 8, 9
    /// with counts 0.5, 1.5, 0.5, 1, 0.5.
    #[test]
    fn the_example_of_the_standard_is_counted_as_printed() {
        let history = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];
        let cycles = rainflow(&turning_points(&history, 0.0));
        let of_range = |range: f64| -> f64 {
            let own = cycles.iter().filter(|c| c.range == range);
            own.map(|c| c.count).sum()
        };
        assert_eq!([3.0, 4.0, 6.0, 8.0, 9.0].map(of_range), [0.5, 1.5, 0.5, 1.0, 0.5]);
        assert_eq!(cycles.iter().map(|c| c.count).sum::<f64>(), 4.0);
    }

    /// Wrong: points between a valley and a peak, or ripple below the least swing, would count as cycles.
    #[test]
    fn a_sampled_wave_has_its_turning_points_only() {
        let wave: Vec<f64> = (0..=400)
            .map(|i| (0.05 * std::f64::consts::PI * i as f64).sin() + 1e-3 * (2.1 * i as f64).sin())
            .collect();
        let cycles = rainflow(&turning_points(&wave, 0.1));
        let full: f64 = cycles.iter().filter(|c| c.range > 1.9).map(|c| c.count).sum();
        assert!((full - 9.5).abs() < 1e-12, "{full} {cycles:?}");
        assert!(cycles.iter().all(|c| c.range > 0.9));
    }

    /// Wrong: a history that starts amid its swings would lose those between `least` and twice as much. A sine of 100
    /// periods turns twice in each, wherever it starts; its ends may add two points.
    #[test]
    fn swings_are_found_wherever_the_history_starts() {
        for eighth in 0..8 {
            let at = |k: i32| (std::f64::consts::TAU * (f64::from(k) / 40.0 + f64::from(eighth) / 8.0)).sin();
            let wave: Vec<f64> = (0..=4000).map(|k| 0.95 * at(k)).collect();
            let points = turning_points(&wave, 1.0);
            assert!((199..=202).contains(&points.len()), "{eighth}: {}", points.len());
            let cycles = rainflow(&points);
            assert!(cycles.iter().all(|cycle| cycle.range > 1.0), "{eighth}");
            let whole: f64 = cycles.iter().filter(|c| c.range > 1.89).map(|c| c.count).sum();
            assert!((99.0..=100.0).contains(&whole), "{eighth}: {whole}");
            assert_eq!(turning_points(&wave, 1.901), [0.0; 0]);
        }
    }

    /// Wrong: a slow start below the least swing would be lost, or count as a swing of its own.
    #[test]
    fn the_first_turning_point_is_the_extreme_before_the_first_swing() {
        assert_eq!(
            turning_points(&[0.0, -0.5, 0.4, 2.0, 1.5, -1.0], 1.0),
            [-0.5, 2.0, -1.0]
        );
        assert_eq!(turning_points(&[0.0, 0.9, 0.2, -0.5, 1.0], 1.0), [0.9, -0.5, 1.0]);
        assert_eq!(turning_points(&[0.0, 0.9, 0.0], 1.0), [0.0; 0]);
        assert_eq!(turning_points(&[3.0, 3.0], 0.0), [0.0; 0]);
    }

    /// Wrong: cycles counted while a history goes on would be others, or come in another order, than those of the whole
    /// history. Histories of values that repeat have equal ranges, in which the counts differ most easily; 2000 of
    /// them, up to 60 values long, by a linear congruential generator (Knuth, MMIX).
    #[test]
    fn counting_as_the_history_goes_on_gives_the_same_cycles() {
        let mut seed = 1_u64;
        let mut random = move |below: u64| {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) % below
        };
        for history in 0..2000 {
            let n = random(60);
            let levels = 2 + random(40);
            let values: Vec<f64> = (0..n).map(|_| random(levels) as f64 / 3.0 - 2.0).collect();
            let least = random(3) as f64 / 2.0;
            let (mut open, mut found) = (OpenHistory::default(), Vec::new());
            for &value in &values {
                open.push(value, least, |cycle| found.push(cycle));
            }
            found.extend(open.rest(least));
            assert_eq!(
                found,
                rainflow(&turning_points(&values, least)),
                "history {history}: {values:?}, swings above {least}"
            );
        }
    }
}
