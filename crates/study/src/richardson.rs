//! Richardson's extrapolation to size zero, with an uncertainty of its own.
//!
//! From the values f1, f2, f3 at the three smallest sizes h1 < h2 < h3 follows the observed order p of
//! f = f0 + c h^p, for any sizes, by bisection of (f3 - f2) / (f2 - f1) = (h3^p - h2^p) / (h2^p - h1^p), and from it
//!
//! ```text
//! f0 = f1 + (f1 - f2) / ((h2 / h1)^p - 1)
//! ```
//!
//! The uncertainty of f0 is, with three sizes, that of the grid convergence index, 1.25 |f0 - f1|; with four or more,
//! the difference to f0 from the next three sizes, but no less than a tenth of the index. Values that do not approach
//! a limit monotonically, or at an order outside 0.5 to 8, are not extrapolated: f0 is f1 then, and its uncertainty
//! three times the largest difference of the three.
//!
//! Reference: Celik et al. (2008), Procedure for estimation and reporting of uncertainty due to discretization in CFD
//! applications, J. Fluids Eng. 130, 078001, eqs. 3 to 7, doi:10.1115/1.2960953.

/// Safety factor of the grid convergence index with three sizes.
const SAFETY: f64 = 1.25;
/// The same where nothing can be extrapolated.
const SAFETY_WITHOUT_ORDER: f64 = 3.0;
/// Least share of the index that four sizes may leave: two extrapolations can agree by chance.
const LEAST_SHARE: f64 = 0.1;
/// Smallest and largest order that is believed.
const ORDERS: [f64; 2] = [0.5, 8.0];
/// Halvings of the range of orders: to round-off.
const BISECTIONS: usize = 60;

/// A value at size zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrapolated {
    /// The value.
    pub value: f64,
    /// What it may be wrong by.
    pub uncertainty: f64,
    /// Observed order; `None` where nothing could be extrapolated.
    pub order: Option<f64>,
}

/// Extrapolates `(size, value)`; `None` with fewer than three different sizes.
pub fn extrapolate(points: &[(f64, f64)]) -> Option<Extrapolated> {
    let mut points = points.to_vec();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.dedup_by(|a, b| a.0 == b.0);
    let three = three(points.get(..3)?);
    let next = points.get(1..4).map(self::three);
    let Some((value, order)) = three else {
        let f = [points[0].1, points[1].1, points[2].1];
        let spread = f.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x))
            - f.iter().fold(f64::INFINITY, |m, x| m.min(*x));
        return Some(Extrapolated {
            value: f[0],
            uncertainty: SAFETY_WITHOUT_ORDER * spread,
            order: None,
        });
    };
    let index = SAFETY * (value - points[0].1).abs();
    let uncertainty = match next {
        Some(Some((coarser, _))) => (coarser - value).abs().max(LEAST_SHARE * index),
        _ => index,
    };
    Some(Extrapolated {
        value,
        uncertainty,
        order: Some(order),
    })
}

/// Value at size zero and order from three points, smallest size first; `None` when they do not converge.
fn three(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let [(h1, f1), (h2, f2), (h3, f3)] = points.try_into().ok()?;
    let ratio = (f3 - f2) / (f2 - f1);
    // Grows with the order: 0 to infinity over all orders.
    let ratio_at = |p: f64| (h3.powf(p) - h2.powf(p)) / (h2.powf(p) - h1.powf(p));
    let [mut low, mut high] = ORDERS;
    if !(ratio_at(low) <= ratio && ratio <= ratio_at(high)) {
        return None;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if ratio_at(middle) < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    let p = 0.5 * (low + high);
    Some((f1 + (f1 - f2) / ((h2 / h1).powf(p) - 1.0), p))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: references of studies would not be the limit of their points.
    #[test]
    fn a_power_law_is_extrapolated_exactly_for_any_ratios() {
        for order in [1.0, 1.5, 2.0, 4.0] {
            let points = [0.4, 0.1, 0.25].map(|h: f64| (h, 7.0 - 3.0 * h.powf(order)));
            let e = extrapolate(&points).unwrap();
            assert!((e.value - 7.0).abs() < 1e-9, "{e:?}");
            assert!((e.order.unwrap() - order).abs() < 1e-8, "{e:?}");
            let index = SAFETY * 3.0 * 0.1f64.powf(order);
            assert!((e.uncertainty - index).abs() < 1e-8, "{e:?}");
        }
    }

    /// Wrong: the uncertainty of a series that has a second term would not cover its error.
    #[test]
    fn the_uncertainty_covers_the_error_of_a_series() {
        let f = |h: f64| 1.0 + 0.5 * h * h + 0.2 * h * h * h;
        for n in [3, 4] {
            let points: Vec<_> = [0.125, 0.25, 0.5, 1.0][..n].iter().map(|&h| (h, f(h))).collect();
            let e = extrapolate(&points).unwrap();
            let error = (e.value - 1.0).abs();
            assert!(error > 0.0 && error < e.uncertainty, "{n}: {error:e}, {e:?}");
        }
    }

    /// Wrong: values that go up and down would be extrapolated to nonsense.
    #[test]
    fn values_without_a_limit_are_not_extrapolated() {
        let e = extrapolate(&[(1.0, 5.0), (2.0, 5.2), (4.0, 4.9)]).unwrap();
        assert_eq!(e.order, None);
        assert_eq!(e.value, 5.0);
        assert!((e.uncertainty - 0.9).abs() < 1e-12, "{e:?}");
        assert_eq!(extrapolate(&[(1.0, 5.0), (2.0, 5.2)]), None);
    }
}
