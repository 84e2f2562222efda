//! Errors of all points against the references of a study, orders of convergence, and fronts.

use std::collections::BTreeMap;

use anyhow::{Context, anyhow, bail};

use super::plan::{Plan, Point, Reference, StudyQuantity};
use super::read::{Reading, history_difference};
use super::report::{Order, PointReport, ResultReport};
use super::richardson::{Extrapolated, extrapolate};

/// Readings of one quantity by point, `[n_points]`; `None` where there is none.
pub type Readings = Vec<Option<Reading>>;

/// A reference for one point.
struct ReferenceValue<'a> {
    value: f64,
    uncertainty: f64,
    /// The point it is, if it is one.
    point: Option<usize>,
    history: &'a [[f64; 2]],
}

/// What a point gave for a quantity, with its error where there is a reference.
pub fn judge(
    plan: &Plan,
    quantity: &StudyQuantity,
    readings: &Readings,
    point: &Point,
) -> anyhow::Result<Option<ResultReport>> {
    let Some(reading) = &readings[point.index] else {
        return Ok(None);
    };
    let mut result = ResultReport {
        value: reading.value,
        reference: None,
        error: None,
        uncertainty: None,
        is_reference: false,
        pareto: false,
    };
    let Some(reference) = &quantity.reference else {
        return Ok(Some(result));
    };
    let known = know(plan, reference, readings, point)?;
    result.reference = Some(known.value);
    result.is_reference = known.point == Some(point.index);
    if result.is_reference {
        return Ok(Some(result));
    }
    let scale = quantity.scale.unwrap_or(known.value.abs());
    if scale <= 0.0 {
        bail!(
            "the reference of {:?} is {}, so a relative error needs a scale",
            quantity.name,
            known.value
        );
    }
    let difference = if reading.history.is_empty() {
        (reading.value - known.value).abs()
    } else {
        history_difference(&reading.history, known.history)?
    };
    result.error = Some(difference / scale);
    result.uncertainty = Some(known.uncertainty / scale);
    Ok(Some(result))
}

fn know<'a>(
    plan: &Plan,
    reference: &Reference,
    readings: &'a Readings,
    point: &Point,
) -> anyhow::Result<ReferenceValue<'a>> {
    match reference {
        Reference::Value {
            value, uncertainty, ..
        } => Ok(ReferenceValue {
            value: *value,
            uncertainty: *uncertainty,
            point: None,
            history: &[],
        }),
        Reference::Point { fixed, uncertainty } => {
            let at = with_fixed(&point.at, fixed);
            let of = plan
                .point_at(&at)
                .ok_or_else(|| anyhow!("the point of the reference is excluded"))?;
            let reading = readings[of.index]
                .as_ref()
                .ok_or_else(|| anyhow!("point {}, the reference, has no result", of.index))?;
            Ok(ReferenceValue {
                value: reading.value,
                uncertainty: *uncertainty,
                point: Some(of.index),
                history: &reading.history,
            })
        }
        Reference::Richardson { axis, fixed } => {
            let found =
                richardson(plan, *axis, &with_fixed(&point.at, fixed), readings).with_context(|| {
                    format!(
                        "fewer than three points along axis {:?} to extrapolate",
                        plan.axes[*axis].name
                    )
                })?;
            Ok(ReferenceValue {
                value: found.value,
                uncertainty: found.uncertainty,
                point: None,
                history: &[],
            })
        }
    }
}

fn with_fixed(at: &[usize], fixed: &[(usize, usize)]) -> Vec<usize> {
    let mut at = at.to_vec();
    for (axis, value) in fixed {
        at[*axis] = *value;
    }
    at
}

/// Extrapolation along an axis at the other values of `at`.
fn richardson(plan: &Plan, axis: usize, at: &[usize], readings: &Readings) -> Option<Extrapolated> {
    let points: Vec<(f64, f64)> = plan.axes[axis]
        .values
        .iter()
        .enumerate()
        .filter_map(|(i, value)| {
            let point = plan.point_at(&with_fixed(at, &[(axis, i)]))?;
            Some((value.size?, readings[point.index].as_ref()?.value))
        })
        .collect();
    extrapolate(&points)
}

/// A reference in words.
pub fn describe(plan: &Plan, reference: &Reference) -> String {
    let named = |fixed: &[(usize, usize)]| {
        let parts = fixed.iter().map(|(axis, value)| {
            let axis = &plan.axes[*axis];
            format!("{} = {}", axis.name, axis.values[*value].name)
        });
        parts.collect::<Vec<_>>().join(", ")
    };
    match reference {
        Reference::Value { value, source, .. } => format!("{value}, {source}"),
        Reference::Point { fixed, .. } => format!("the run with {}", named(fixed)),
        Reference::Richardson { axis, fixed } => {
            let at = if fixed.is_empty() {
                String::new()
            } else {
                format!(" at {}", named(fixed))
            };
            format!("Richardson extrapolation over {}{at}", plan.axes[*axis].name)
        }
    }
}

/// Orders of all quantities along all axes that have sizes.
pub fn orders(plan: &Plan, points: &[PointReport]) -> Vec<Order> {
    let mut orders = Vec::new();
    for (a, axis) in plan.axes.iter().enumerate() {
        if axis.values.iter().any(|v| v.size.is_none()) {
            continue;
        }
        // Lines along the axis, by the values of the others.
        let mut lines: BTreeMap<Vec<usize>, Vec<&Point>> = BTreeMap::new();
        for point in &plan.points {
            lines
                .entry(with_fixed(&point.at, &[(a, 0)]))
                .or_default()
                .push(point);
        }
        for (at, line) in lines {
            for quantity in &plan.quantities {
                let counted = line.iter().filter_map(|point| {
                    let result = points[point.index].results.get(&quantity.name)?;
                    let (error, uncertainty) = (result.error?, result.uncertainty?);
                    (error > uncertainty).then_some((axis.values[point.at[a]].size?, error))
                });
                let Some((order, steps, n_points)) = slope(counted.collect()) else {
                    continue;
                };
                let others = plan.axes.iter().zip(&at).enumerate().filter(|(i, _)| *i != a);
                orders.push(Order {
                    axis: axis.name.clone(),
                    at: others
                        .map(|(_, (axis, &v))| (axis.name.clone(), axis.values[v].name.clone()))
                        .collect(),
                    quantity: quantity.name.clone(),
                    order,
                    steps,
                    n_points,
                });
            }
        }
    }
    orders
}

/// Slope of log error over log size by least squares, the slopes from size to size, and the number of points.
fn slope(mut points: Vec<(f64, f64)>) -> Option<(f64, Vec<f64>, usize)> {
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    let logs: Vec<(f64, f64)> = points.iter().map(|(h, e)| (h.ln(), e.ln())).collect();
    let n = logs.len() as f64;
    let (mx, my) = (
        logs.iter().map(|l| l.0).sum::<f64>() / n,
        logs.iter().map(|l| l.1).sum::<f64>() / n,
    );
    let sxx: f64 = logs.iter().map(|l| (l.0 - mx) * (l.0 - mx)).sum();
    let sxy: f64 = logs.iter().map(|l| (l.0 - mx) * (l.1 - my)).sum();
    if logs.len() < 2 || sxx <= 0.0 {
        return None;
    }
    let steps = logs
        .windows(2)
        .map(|w| (w[0].1 - w[1].1) / (w[0].0 - w[1].0))
        .collect();
    Some((sxy / sxx, steps, logs.len()))
}

/// Marks those results of a quantity that no other point beats in both error and cost.
pub fn mark_front(points: &mut [PointReport], quantity: &str, kind: super::format::CostKind) {
    let price = |p: &PointReport| {
        let error = p.results.get(quantity)?.error?;
        Some((p.cost.as_ref()?.of(kind), error))
    };
    let prices: Vec<Option<(f64, f64)>> = points.iter().map(price).collect();
    for (i, point) in points.iter_mut().enumerate() {
        let Some((cost, error)) = prices[i] else { continue };
        let beaten = prices
            .iter()
            .flatten()
            .any(|&(c, e)| c <= cost && e <= error && (c < cost || e < error));
        if let Some(result) = point.results.get_mut(quantity) {
            result.pareto = !beaten;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: orders of convergence would be misread.
    #[test]
    fn the_slope_of_a_power_law_is_its_exponent() {
        let points: Vec<_> = [1.0, 0.5, 0.2, 0.1].map(|h: f64| (h, 3.0 * h * h)).to_vec();
        let (order, steps, n) = slope(points).unwrap();
        assert!((order - 2.0).abs() < 1e-12, "{order}");
        assert!(steps.iter().all(|s| (s - 2.0).abs() < 1e-12), "{steps:?}");
        assert_eq!((steps.len(), n), (3, 4));
        assert_eq!(slope(vec![(1.0, 1.0)]), None);
    }
}
