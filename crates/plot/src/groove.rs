//! Stress along the arc of the groove at the most loaded ball of a raceway, a curve per point of a sweep.

use checkpoint::{all_steps, read_any_step, read_mesh};
use contact::Groove;
use figure::{DataPoint, Figure, Series};

use super::quantity::{DEGREE, MEGAPASCAL};
use super::raceways;
use super::run::{Results, Steps};
use super::shades::{self, Shades};
use super::stress_step::step_with_stress;

/// A figure per raceway: of a sweep a curve per point, else the chosen step.
pub fn figures(results: &Results, step: Option<u64>) -> anyhow::Result<Vec<(String, Figure)>> {
    if !results.may_show_loads() {
        return Ok(Vec::new());
    }
    let balls = results.balls.as_ref();
    let steps = all_steps(&results.dir)?;
    let steps: Vec<u64> = match (&results.steps, step) {
        (Steps::Sweep(_), None) => steps,
        (_, chosen) => step_with_stress(&results.dir, chosen)?.into_iter().collect(),
    };
    let mut figures: [Option<Figure>; 2] = [None, None];
    if steps.is_empty() {
        return Ok(Vec::new());
    }
    let grid = read_mesh(&results.dir)?;
    let shades = Shades::of(results, &steps)?;
    for (i, &step) in steps.iter().enumerate() {
        let record = read_any_step(&results.dir, step)?;
        let name = results.name_of(record.step)?;
        let raceways = raceways::raceways(&record)?;
        for ((figure, groove), body) in figures.iter_mut().zip(raceways.grooves).zip([0, 1]) {
            let nodes = raceways::nodes(&grid, &record, &groove);
            let Some((ball, azimuth)) = raceways::most_loaded(balls, (&grid, &record), &groove)? else {
                continue;
            };
            let points: Vec<DataPoint> = raceways::rows(&nodes)
                .into_iter()
                .map(|(key, row)| {
                    let stress = raceways::at_azimuth(&row, azimuth);
                    DataPoint::new(1e-3 * key as f64, stress * MEGAPASCAL.factor)
                })
                .filter(|point| !point.y.is_nan())
                .collect();
            if points.len() < 2 {
                continue;
            }
            let label = format!("{name}, ball {ball} at {azimuth:.0} deg");
            // One step has the scale of the picture of its raceway.
            let largest = match (steps.len(), &record.points.von_mises) {
                (1, Some(values)) => raceways::largest_of_body(&grid, values, body) * MEGAPASCAL.factor,
                _ => 0.0,
            };
            let empty = || {
                let figure = along_groove(&groove, largest).note(raceways.note);
                shades::bar(figure, shades.as_ref())
            };
            let empty = figure.take().unwrap_or_else(empty);
            let series = Series::line_and_marks(label, points);
            *figure = Some(empty.series(shades::shaded(series, shades.as_ref(), i, steps.len())));
        }
    }
    let named = figures.into_iter().zip(["inner", "outer"]);
    Ok(named
        .filter_map(|(figure, side)| Some((format!("groove_{side}"), figure?)))
        .collect())
}

/// An empty figure whose scale reaches from 0 to `largest`, MPa, at least.
fn along_groove(groove: &Groove, largest: f64) -> Figure {
    let title = format!(
        "Stress along the groove of the {} raceway at its most loaded ball",
        groove.side.name()
    );
    Figure::new(
        title,
        DEGREE.axis("groove angle").tight(),
        MEGAPASCAL
            .axis("von Mises stress")
            .including(0.0)
            .including(largest),
    )
}
