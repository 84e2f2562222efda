//! The raceways unrolled: von Mises stress over azimuth and arc of the groove, with the contact ellipses.
//!
//! An ellipse is Hertz's, around the contact of its ball: its semi-axis across is an arc of the groove, that along the
//! raceway an angle about the axis, so it is not distorted. Of contacts at an edge or over a profile, which have
//! another one, it is drawn in dashes; at an edge it ends where the groove does.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use checkpoint::{read_any_step, read_mesh};
use contact::Groove;
use figure::{Axis, DataPoint, Figure, Look, Series, Surface};

use super::choice::Choice;
use super::named::Named;
use super::quantity::{DEGREE, MEGAPASCAL, azimuth_axis};
use super::raceways::{self, RacewayNode};
use super::run::Results;
use super::stress_step::step_with_stress;
use results::table::Table;

/// Columns and rows of the picture of a raceway.
const CELLS: [usize; 2] = [240, 24];
/// Corners of an ellipse.
const CORNERS: usize = 48;

/// A figure per raceway of the chosen step; none if it has no nodal stress.
pub fn figures(results: &Results, choice: &Choice) -> anyhow::Result<Vec<Named>> {
    if !results.may_show_loads() {
        return Ok(Vec::new());
    }
    let balls = results.balls.as_ref();
    let Some(step) = step_with_stress(&results.dir, choice.step)? else {
        return Ok(Vec::new());
    };
    let record = read_any_step(&results.dir, step)?;
    let grid = read_mesh(&results.dir)?;
    let mut figures = Vec::new();
    let raceways = raceways::raceways(&record)?;
    for (groove, body) in raceways.grooves.into_iter().zip([0, 1]) {
        let nodes = raceways::nodes(&grid, &record, &groove);
        if let (Some(values), true) = (&record.points.von_mises, raceways::rows(&nodes).len() > 1) {
            let largest = raceways::largest_of_body(&grid, values, body);
            let mut named = unrolled(&nodes, largest, &groove, (balls, step))?;
            named.figure = named.figure.note(raceways.note);
            figures.push(named);
        }
    }
    Ok(figures)
}

/// The picture of a raceway; `largest` is the end of its scale, Pa.
fn unrolled(
    nodes: &[RacewayNode],
    largest: f64,
    groove: &Groove,
    (balls, step): (Option<&Table>, u64),
) -> anyhow::Result<Named> {
    let side = groove.side.name();
    let arc = |angle: f64| 1e3 * groove.groove_radius * angle.to_radians();
    let angles = nodes.iter().map(|node| node.groove_angle);
    let [low, high] = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| {
        [a.min(x), b.max(x)]
    });
    let [n_x, n_y] = CELLS;
    let edges = |n: usize, from: f64, to: f64| -> Vec<f64> {
        (0..=n)
            .map(|i| from + (to - from) * i as f64 / n as f64)
            .collect()
    };
    let (x_edges, y_edges) = (edges(n_x, 0.0, 360.0), edges(n_y, low, high));
    let rows: Vec<(f64, Vec<RacewayNode>)> = raceways::rows(nodes)
        .into_iter()
        .map(|(k, row)| (1e-3 * k as f64, row))
        .collect();
    let mut values = Vec::with_capacity(n_x * n_y);
    for y in y_edges.windows(2) {
        for x in x_edges.windows(2) {
            let value = interpolate(&rows, 0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
            values.push(value * MEGAPASCAL.factor);
        }
    }
    let value_axis = MEGAPASCAL
        .axis("von Mises stress")
        .including(0.0)
        .including(largest * MEGAPASCAL.factor);
    let y_edges = y_edges.into_iter().map(arc).collect();
    let ellipses = balls.map(|balls| ellipses(groove, &(arc(low)..=arc(high)), (balls, step)));
    let with = match ellipses.is_some() {
        true => " with the contact ellipses",
        false => "",
    };
    let title = format!("Stress of the {side} raceway{with}, step {step}");
    let y_axis = Axis::linear("arc of the groove from its bottom", "mm").tight();
    let mut figure = Figure::new(title, azimuth_axis(), y_axis)
        .surface(Surface::new(value_axis, x_edges, y_edges, values)?)
        .size(900, 400);
    for (look, ellipse) in ellipses.transpose()?.unwrap_or_default() {
        let name = match look {
            Look::BrokenOutline => "ellipse at an edge or over a profile: not Hertz's",
            _ => "contact ellipse",
        };
        figure = figure.series(Series::new(name, look, ellipse));
    }
    Ok(Named::new(format!("raceway_{side}"), figure))
}

/// Bilinear between rows of groove angle and, in each, between neighbours in azimuth.
fn interpolate(rows: &[(f64, Vec<RacewayNode>)], azimuth: f64, angle: f64) -> f64 {
    let after = rows
        .partition_point(|(a, _)| *a <= angle)
        .clamp(1, rows.len() - 1);
    let ((low, below), (high, above)) = (&rows[after - 1], &rows[after]);
    let part = ((angle - low) / (high - low)).clamp(0.0, 1.0);
    let (a, b) = (
        raceways::at_azimuth(below, azimuth),
        raceways::at_azimuth(above, azimuth),
    );
    a + part * (b - a)
}

/// Outlines of the loaded contacts of a step over azimuth in deg and arc in mm, cut where the picture ends, and how
/// they are drawn. `arcs` are those of the groove, mm.
fn ellipses(
    groove: &Groove,
    arcs: &RangeInclusive<f64>,
    (balls, step): (&Table, u64),
) -> anyhow::Result<Vec<(Look, Vec<DataPoint>)>> {
    let side = groove.side.name();
    let column = |name: &str| balls.column(&format!("{side}_{name}"));
    let (force, angle) = (column("force_n")?, column("contact_angle_rad")?);
    let (along, across) = (column("semi_axis_rolling_m")?, column("semi_axis_groove_m")?);
    let (steps, azimuth) = (balls.column("step")?, balls.column("azimuth_rad")?);
    let loaded = (0..balls.n_rows()).filter(|&row| steps[row] == step as f64 && force[row] > 0.0);
    let ellipse = balls.texts(&format!("{side}_ellipse"));
    let is_cut = |row: usize| ellipse.is_some_and(|texts| texts[row] == "edge");
    let look = |row: usize| match ellipse.map(|texts| texts[row].as_str()) {
        None | Some("hertz") => Look::Outline,
        Some(_) => Look::BrokenOutline,
    };
    let outline = |row: usize| {
        let half_width = along[row] / groove.radius(angle[row]) * DEGREE.factor;
        let middle = (azimuth[row] * DEGREE.factor).rem_euclid(360.0);
        let corner = |i: usize| {
            let t = TAU * i as f64 / CORNERS as f64;
            let arc = groove.groove_radius * angle[row] + across[row] * t.sin();
            let arc = if is_cut(row) {
                (1e3 * arc).clamp(*arcs.start(), *arcs.end())
            } else {
                1e3 * arc
            };
            DataPoint::new(middle + half_width * t.cos(), arc)
        };
        let turned = |p: DataPoint, turn: f64| match p.x + turn {
            x if (0.0..=360.0).contains(&x) => DataPoint { x, ..p },
            _ => DataPoint::GAP,
        };
        // At the ends of the picture both halves are drawn.
        [-360.0, 0.0, 360.0]
            .map(|turn| {
                (0..=CORNERS)
                    .map(corner)
                    .map(|p| turned(p, turn))
                    .collect::<Vec<_>>()
            })
            .map(|line| (look(row), line))
    };
    let drawn = loaded
        .flat_map(outline)
        .filter(|(_, line)| line.iter().any(|p| p.x.is_finite()));
    Ok(drawn.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::Side;

    /// Wrong: an ellipse that ends at a shoulder would be drawn over where there is no groove. The same contact, whole
    /// and cut 1.9 mm from the bottom: one reaches 2.5 mm, the other ends with a straight line, wherever else it is.
    #[test]
    fn an_ellipse_at_an_edge_ends_where_the_groove_does() {
        let groove = Groove {
            side: Side::Outer,
            centre_radius: 32.2685e-3,
            groove_radius: 4.75e-3,
            centre_z: 0.0,
        };
        let folder = tempfile::tempdir().unwrap();
        let text = "step,azimuth_rad,outer_force_n,outer_contact_angle_rad,outer_semi_axis_rolling_m,\
                    outer_semi_axis_groove_m,outer_ellipse\n0,1,300,0.35,1.3e-4,8.4e-4,hertz\n\
                    0,2,300,0.35,1.3e-4,8.4e-4,edge\n";
        std::fs::write(folder.path().join("balls.csv"), text).unwrap();
        let balls = Table::read(folder.path(), "balls.csv").unwrap().unwrap();
        let drawn = ellipses(&groove, &(-1.9..=1.9), (&balls, 0)).unwrap();
        assert_eq!(drawn.len(), 2);
        let arcs = |k: usize| drawn[k].1.iter().map(|p| p.y);
        let highest = |k: usize| arcs(k).fold(f64::NEG_INFINITY, f64::max);
        assert!(drawn[0].0 == Look::Outline && (highest(0) - 1e3 * (4.75e-3 * 0.35 + 8.4e-4)).abs() < 1e-9);
        assert!(
            drawn[1].0 == Look::BrokenOutline && highest(1) == 1.9,
            "{}",
            highest(1)
        );
        for (whole, cut) in arcs(0).zip(arcs(1)) {
            assert_eq!(cut, whole.min(1.9));
        }
    }
}
