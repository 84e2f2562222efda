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

/// Peaks and valleys of a history, its ends included; swings of `least` or less are passed over.
pub fn turning_points(history: &[f64], least: f64) -> Vec<f64> {
    let mut points: Vec<f64> = Vec::new();
    for &value in history {
        let Some(&last) = points.last() else {
            points.push(value);
            continue;
        };
        let rising = points.len() > 1 && last > points[points.len() - 2];
        let falling = points.len() > 1 && last < points[points.len() - 2];
        let goes_on = (rising && value >= last) || (falling && value <= last);
        if goes_on {
            *points.last_mut().expect("there is a last point") = value;
        } else if (value - last).abs() > least {
            points.push(value);
        }
    }
    points
}

/// Cycles of a sequence of peaks and valleys, in the order in which they close; what is left at the end are half
/// cycles.
pub fn rainflow(points: &[f64]) -> Vec<Cycle> {
    let (mut stack, mut cycles): (Vec<f64>, Vec<Cycle>) = (Vec::new(), Vec::new());
    let cycle = |a: f64, b: f64, count: f64| Cycle {
        range: (a - b).abs(),
        mean: 0.5 * (a + b),
        count,
    };
    for &point in points {
        stack.push(point);
        while let &[.., a, b, c] = &stack[..] {
            if (c - b).abs() < (b - a).abs() {
                break;
            }
            if stack.len() == 3 {
                // The range holds the start of the history: half a cycle.
                cycles.push(cycle(a, b, 0.5));
                stack.remove(0);
            } else {
                cycles.push(cycle(a, b, 1.0));
                stack.truncate(stack.len() - 3);
                stack.push(c);
            }
        }
    }
    cycles.extend(stack.windows(2).map(|pair| cycle(pair[0], pair[1], 0.5)));
    cycles
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
}
