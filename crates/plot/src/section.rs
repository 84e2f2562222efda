//! Stress over the section of a raceway: along the arc of the groove at the most loaded ball.

use checkpoint::{all_steps, read_any_step, read_mesh};
use contact::Groove;
use figure::{Figure, Series};

use super::quantity::{DEGREE, MEGAPASCAL};
use super::raceways;
use super::run::Steps;
use super::{Choice, Named, Results};
use results::table::Table;

/// A figure per raceway: of a sweep a curve per point, else the chosen step.
pub fn figures(results: &Results, choice: &Choice) -> anyhow::Result<Vec<Named>> {
    let Some(balls) = &results.balls else {
        return Ok(Vec::new());
    };
    let steps = all_steps(&results.dir)?;
    let steps: Vec<u64> = match (&results.steps, choice.step) {
        (Steps::Sweep(_), None) => steps,
        (_, chosen) => chosen.or(steps.last().copied()).into_iter().collect(),
    };
    let mut figures: [Option<Figure>; 2] = [None, None];
    if steps.is_empty() {
        return Ok(Vec::new());
    }
    let grid = read_mesh(&results.dir)?;
    for (i, &step) in steps.iter().enumerate() {
        let record = read_any_step(&results.dir, step)?;
        let name = results.name_of(record.step)?;
        let raceways = raceways::raceways(&record)?;
        for (figure, groove) in figures.iter_mut().zip(raceways.grooves) {
            let nodes = raceways::nodes(&grid, &record, &groove);
            let (ball, azimuth) = most_loaded(balls, step, &groove)?;
            let points: Vec<[f64; 2]> = raceways::rows(&nodes)
                .into_iter()
                .map(|(key, row)| {
                    [
                        1e-3 * key as f64,
                        raceways::at_azimuth(&row, azimuth) * MEGAPASCAL.factor,
                    ]
                })
                .collect();
            if points.len() < 2 {
                continue;
            }
            let label = format!("{name}, ball {ball} at {azimuth:.0} deg");
            // One step has the scale of the picture of its raceway.
            let largest = match steps.len() {
                1 => raceways::largest(&nodes) * MEGAPASCAL.factor,
                _ => 0.0,
            };
            let empty = || over_section(&groove, largest).note(raceways.note);
            let empty = figure.take().unwrap_or_else(empty);
            *figure = Some(empty.series(Series::line_and_marks(label, points).shade(i, steps.len())));
        }
    }
    let named = figures.into_iter().zip(["inner", "outer"]);
    Ok(named
        .filter_map(|(figure, side)| Some(Named::new(format!("section_{side}"), figure?)))
        .collect())
}

/// An empty figure whose scale reaches from 0 to `largest`, MPa, at least.
fn over_section(groove: &Groove, largest: f64) -> Figure {
    let title = format!(
        "Stress over the section of the {} raceway at its most loaded ball",
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

/// The ball with the largest force on a raceway in a step, and its azimuth, deg.
fn most_loaded(balls: &Table, step: u64, groove: &Groove) -> anyhow::Result<(usize, f64)> {
    let force = balls.column(&format!("{}_force_n", groove.side.name()))?;
    let (steps, ball, azimuth) = (
        balls.column("step")?,
        balls.column("ball")?,
        balls.column("azimuth_rad")?,
    );
    let rows = (0..balls.n_rows()).filter(|&row| steps[row] == step as f64);
    let row = rows.max_by(|&a, &b| force[a].total_cmp(&force[b]));
    let row = row.ok_or_else(|| anyhow::anyhow!("balls.csv has no rows of step {step}"))?;
    Ok((
        ball[row] as usize,
        (azimuth[row] * DEGREE.factor).rem_euclid(360.0),
    ))
}
