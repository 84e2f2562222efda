//! What tells the curves of many steps apart: a colour bar, where names would take too much room.

use figure::{Axis, Figure, Series, Surface};

use super::run::Results;

/// More curves than this have no names.
const MOST_NAMED: usize = 8;

/// The swept value or the time of each curve.
pub struct Shades {
    axis: Axis,
    values: Vec<f64>,
    low: f64,
    high: f64,
}

impl Shades {
    /// Those of some steps; none for a few, which are named, and where nothing tells them apart.
    pub fn of(results: &Results, steps: &[u64]) -> anyhow::Result<Option<Shades>> {
        let Some(balls) = results.balls.as_ref().filter(|_| steps.len() > MOST_NAMED) else {
            return Ok(None);
        };
        let Some((axis, values)) = results.against(balls)? else {
            return Ok(None);
        };
        let numbers = balls.column("step")?;
        let value = |step: &u64| {
            let row = numbers.iter().position(|number| *number == *step as f64)?;
            Some(values[row]).filter(|value| value.is_finite())
        };
        let Some(values) = steps.iter().map(value).collect::<Option<Vec<f64>>>() else {
            return Ok(None);
        };
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let shades = Shades {
            axis,
            values,
            low,
            high,
        };
        Ok((low < high).then_some(shades))
    }
}

/// The colour bar of the curves of a figure, if it has one.
pub fn bar(figure: Figure, shades: Option<&Shades>) -> Figure {
    let Some(Shades { axis, low, high, .. }) = shades else {
        return figure;
    };
    let axis = axis.clone().including(*low).including(*high);
    figure.surface(Surface::bar_of_series(axis))
}

/// Curve `i` of `n` in its colour.
pub fn shaded(series: Series, shades: Option<&Shades>, i: usize, n: usize) -> Series {
    match shades {
        None => series.shade(i, n),
        Some(Shades {
            values, low, high, ..
        }) => series.shade_at((values[i] - low) / (high - low)),
    }
}
