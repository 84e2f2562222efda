//! Both rings across the axis, in the plane of their groove centres, undeformed and with magnified displacement, and
//! the balls ([`super::ring_outline`]).
//!
//! Balls are shown at their azimuths, as far out as they are: they may move many times as far as rings deform, so that
//! magnified they would leave them. Rings without circles of nodes, of free meshes, have no such figure.

use std::f64::consts::TAU;

use checkpoint::{Grid, StepRecord, read_any_step, read_mesh};
use figure::{DataPoint, Figure, Series};

use super::quantity::{MICROMETRE, MILLIMETRE};
use super::raceways;
use super::ring_outline::{DisplacedPoint, RingOutline, closed, outline, places};
use super::run::Results;
use super::stress_step::step_with_displacement;

/// Width and height of the picture.
const SIZE: (u32, u32) = (720, 780);
/// The largest displacement is shown as this part of the outside radius at most.
const SHOWN: f64 = 0.08;
/// Displacements below this are nothing, m.
const NOTHING: f64 = 1e-12;
/// Sides of the circle of a ball.
const SIDES: usize = 48;
const NAMES: [&str; 2] = ["inner ring", "outer ring"];

/// The figure of the chosen step, or of the newest with displacements; none of rings without circles of nodes.
pub fn figures(results: &Results, step: Option<u64>) -> anyhow::Result<Vec<(String, Figure)>> {
    if !results.may_show_loads() {
        return Ok(Vec::new());
    }
    let Some(step) = step_with_displacement(&results.dir, step)? else {
        return Ok(Vec::new());
    };
    let record = read_any_step(&results.dir, step)?;
    let grid = read_mesh(&results.dir)?;
    let grooves = raceways::raceways(&record)?.grooves;
    let rings: Vec<Option<RingOutline>> = (0..2)
        .map(|side| outline(&grid, &record, &grooves[side]))
        .collect();
    let figure = draw(&rings, &balls(&grid, &record), &results.name_of(step)?);
    Ok(figure
        .map(|figure| ("deformed_rings".to_string(), figure))
        .into_iter()
        .collect())
}

/// The picture of the rings; none if there is none, or nothing has moved.
fn draw(rings: &[Option<RingOutline>], balls: &[Disc], at: &str) -> Option<Figure> {
    let of_rings = || {
        rings
            .iter()
            .flatten()
            .flat_map(|ring| ring.circles.iter().flatten())
    };
    let largest = of_rings().map(DisplacedPoint::size).fold(0.0, f64::max);
    let outside = of_rings().map(|m| m.from[0].hypot(m.from[1])).fold(0.0, f64::max);
    if largest < NOTHING {
        return None;
    }
    let magnification = round_below(SHOWN * outside / largest).max(1.0);
    let title = format!("Deformed rings, displacements {magnification} times: {at}");
    let note = format!(
        "In the plane of the groove centres, without turns of rings; balls not magnified. Largest {:.3} µm",
        MICROMETRE.factor * largest
    );
    let mut figure = Figure::new(title, MILLIMETRE.axis("x"), MILLIMETRE.axis("y"))
        .size(SIZE.0, SIZE.1)
        .equal_scales()
        .note(note);
    for circle in rings.iter().flatten().flat_map(|ring| &ring.circles) {
        figure = figure.series(Series::reference("undeformed", closed(circle, 0.0)));
    }
    for (ring, name) in rings.iter().zip(NAMES) {
        for circle in ring.iter().flat_map(|ring| &ring.circles) {
            figure = figure.series(Series::line(name, closed(circle, magnification)));
        }
    }
    let mut round = Vec::new();
    for Disc { x, y, radius } in balls {
        let side = |i: usize| {
            let (sin, cos) = (TAU * i as f64 / SIDES as f64).sin_cos();
            DataPoint::from([x + radius * cos, y + radius * sin].map(|x| MILLIMETRE.factor * x))
        };
        round.extend((0..=SIDES).map(side));
        // The line ends between two balls.
        round.push(DataPoint::GAP);
    }
    Some(figure.series(Series::line("balls", round)))
}

/// The largest number 1, 2 or 5 times a power of ten that is not above `value`.
fn round_below(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let steps = [5.0, 2.0, 1.0].map(|step| step * power);
    steps
        .into_iter()
        .find(|step| *step <= value * (1.0 + 1e-12))
        .unwrap_or(power)
}

/// A ball across the axis, m.
struct Disc {
    x: f64,
    y: f64,
    radius: f64,
}

/// The balls across the axis.
fn balls(grid: &Grid, record: &StepRecord) -> Vec<Disc> {
    let ball = |i: usize| {
        let [_, [x, y]] = places(grid, record, grid.cell(i).next()?);
        Some(Disc {
            x,
            y,
            radius: grid.radius[i],
        })
    };
    raceways::ball_cells(grid).filter_map(ball).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a reader could not tell displacements from an odd scale, or they would fill the picture.
    #[test]
    fn magnifications_are_round_and_not_above() {
        for (value, expected) in [
            (1.0, 1.0),
            (1.99, 1.0),
            (2.0, 2.0),
            (7.3, 5.0),
            (999.0, 500.0),
            (1000.0, 1000.0),
        ] {
            assert_eq!(round_below(value), expected, "{value}");
        }
    }
}
