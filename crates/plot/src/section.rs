//! The section of each ring at its most loaded ball, filled with the stress of the mesh.

use checkpoint::{read_any_step, read_mesh};
use contact::Groove;
use figure::{DataPoint, Figure, Series, Surface, Triangle};

use super::cut;
use super::quantity::{DEGREE, MEGAPASCAL, MILLIMETRE};
use super::raceways;
use super::run::Results;
use super::stress_step::step_with_stress;
use results::table::Table;

/// Width and height of the picture of a section.
const SIZE: (u32, u32) = (820, 480);

/// A figure per ring of the chosen step; none if it has no nodal stress.
pub fn figures(results: &Results, step: Option<u64>) -> anyhow::Result<Vec<(String, Figure)>> {
    if !results.may_show_loads() {
        return Ok(Vec::new());
    }
    let balls = results.balls.as_ref();
    let Some(step) = step_with_stress(&results.dir, step)? else {
        return Ok(Vec::new());
    };
    let record = read_any_step(&results.dir, step)?;
    let Some(von_mises) = &record.points.von_mises else {
        return Ok(Vec::new());
    };
    let grid = read_mesh(&results.dir)?;
    let moved: Vec<[f64; 3]> = grid
        .points
        .iter()
        .zip(&record.points.displacement)
        // Where the displacement is not kept (output.region) the mesh stands in for it.
        .map(|(x, u)| [0, 1, 2].map(|i| if u[i].is_nan() { x[i] } else { x[i] + u[i] }))
        .collect();
    let raceways = raceways::raceways(&record)?;
    let mut figures = Vec::new();
    for (groove, body) in raceways.grooves.into_iter().zip([0, 1]) {
        let Some((ball, azimuth)) = raceways::most_loaded(balls, (&grid, &record), &groove)? else {
            continue;
        };
        let triangles = cut::at_azimuth(&grid, &moved, von_mises, body, azimuth / DEGREE.factor);
        let is_known = |triangle: &Triangle| triangle.values.iter().any(|value| !value.is_nan());
        if !triangles.iter().any(is_known) {
            continue;
        }
        let largest = raceways::largest_of_body(&grid, von_mises, body) * MEGAPASCAL.factor;
        let side = groove.side.name();
        let title =
            format!("Stress in the section of the {side} ring at ball {ball}, {azimuth:.1} deg, step {step}");
        let value = MEGAPASCAL
            .axis("von Mises stress")
            .including(0.0)
            .including(largest);
        let mut figure = Figure::new(title, MILLIMETRE.axis("z"), MILLIMETRE.axis("radius"))
            .size(SIZE.0, SIZE.1)
            .equal_scales()
            .note(raceways.note)
            .surface(Surface::of_triangles(value, in_figure(&triangles)));
        if let Some(balls) = balls {
            figure = figure.series(contact(balls, step, ball, &groove)?);
        }
        figures.push((format!("section_{side}"), figure));
    }
    Ok(figures)
}

/// Triangles in the units of the figure.
fn in_figure(triangles: &[Triangle]) -> Vec<Triangle> {
    let shown = |t: &Triangle| Triangle {
        corners: t.corners.map(|corner| corner.map(|x| x * MILLIMETRE.factor)),
        values: t.values.map(|value| value * MEGAPASCAL.factor),
    };
    triangles.iter().map(shown).collect()
}

/// Where a ball touches the raceway: z and radius; none for a ball without force.
fn contact(table: &Table, step: u64, ball: usize, groove: &Groove) -> anyhow::Result<Series> {
    let side = groove.side.name();
    let (steps, numbers) = (table.column("step")?, table.column("ball")?);
    let force = table.column(&format!("{side}_force_n"))?;
    let angle = table.column(&format!("{side}_contact_angle_rad"))?;
    let is_it = |&row: &usize| steps[row] == step as f64 && numbers[row] == ball as f64 && force[row] > 0.0;
    let place = |row: usize| {
        let [_, along] = groove.direction(angle[row]);
        let z = groove.centre_z + groove.groove_radius * along;
        let place = [z, groove.radius(angle[row])];
        DataPoint::from(place.map(|x| x * MILLIMETRE.factor))
    };
    let places = (0..table.n_rows()).filter(is_it).map(place);
    Ok(Series::rings("contact", places.collect()))
}
