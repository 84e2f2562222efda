//! The shaft of several bearings: its deflection line with the bearings at their places, and their forces.

use std::path::Path;

use figure::{Axis, Figure, Series};
use results::several::{BEARINGS_TABLE, SHAFT_TABLE};
use results::table::Table;

use super::quantity::{AxisUnit, MICROMETRE, MILLIMETRE, NEWTON, points};
use super::run::axis_of;

/// Displacement below which a direction is not drawn, um.
const NOTHING: f64 = 1e-6;
/// Places along the shaft, m.
const POSITION: &str = "position_m";
/// Column before that of a swept value.
const TIME: usize = 1;

/// Whether a folder has the results of several bearings.
pub fn is_of_several(dir: &Path) -> bool {
    dir.join(BEARINGS_TABLE).is_file()
}

/// The figures of such a folder.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<(String, Figure)>> {
    let mut found = Vec::new();
    let (Some(shaft), Some(bearings)) = (Table::read(dir, SHAFT_TABLE)?, Table::read(dir, BEARINGS_TABLE)?)
    else {
        return Ok(found);
    };
    let line = line(&shaft, &bearings)?;
    let line = match last_point(&bearings)? {
        Some(point) => line.note(format!("At the last point of the sweep: {point}")),
        None => line,
    };
    found.push(("shaft_line".to_string(), line));
    found.extend(range(&shaft)?.map(|figure| ("shaft_line_range".to_string(), figure)));
    found.extend(loads(dir, &bearings)?.map(|figure| ("bearing_loads".to_string(), figure)));
    Ok(found)
}

/// Rows of the last step.
fn last_rows(table: &Table) -> anyhow::Result<Vec<usize>> {
    let steps = table.column("step")?;
    let last = steps.iter().copied().fold(0.0, f64::max);
    Ok((0..steps.len()).filter(|&i| steps[i] == last).collect())
}

/// The last point of a sweep in words; None without one.
fn last_point(bearings: &Table) -> anyhow::Result<Option<String>> {
    let Some(column) = swept_column(bearings) else {
        return Ok(None);
    };
    let (axis, x) = axis_of(bearings, column, "step")?;
    Ok(x.last().map(|x| axis.value(*x)))
}

/// The column of the swept value, where there is one.
fn swept_column(bearings: &Table) -> Option<&String> {
    bearings.names().get(TIME + 1).filter(|name| *name != "bearing")
}

/// The line of the shaft at the last step.
fn line(shaft: &Table, bearings: &Table) -> anyhow::Result<Figure> {
    let pick = |table: &Table, rows: &[usize], column: &str, unit: AxisUnit| -> anyhow::Result<Vec<f64>> {
        let values = unit.of(table.column(column)?);
        Ok(rows.iter().map(|&i| values[i]).collect())
    };
    let (rows, places) = (last_rows(shaft)?, last_rows(bearings)?);
    let z = pick(shaft, &rows, "position_m", MILLIMETRE)?;
    let at = pick(bearings, &places, "position_m", MILLIMETRE)?;
    let axis = MILLIMETRE.axis("position along the shaft");
    let mut figure = Figure::new(
        "Deflection line of the shaft",
        axis,
        MICROMETRE.axis("displacement"),
    );
    let of = |name| Ok((name, pick(shaft, &rows, &format!("{name}_m"), MICROMETRE)?));
    let lines = ["x", "y", "z"]
        .map(of)
        .into_iter()
        .collect::<anyhow::Result<Vec<_>>>()?;
    let is_nothing = |line: &[f64]| line.iter().all(|u| u.abs() < NOTHING);
    // A shaft that stands has its lines, too.
    let stands = lines.iter().all(|(_, line)| is_nothing(line));
    for (name, line) in lines {
        if is_nothing(&line) && !stands {
            continue;
        }
        let column = format!("{name}_m");
        figure = figure.series(Series::line(name, points(&z, &line)));
        let own = pick(bearings, &places, &column, MICROMETRE)?;
        figure = figure.series(Series::marks(
            format!("{name} at the bearings"),
            points(&at, &own),
        ));
    }
    Ok(figure)
}

/// Where the line of the shaft has been over time: mean, least and largest displacement of each place; None of one
/// instant, of a sweep, and of a shaft that stands.
fn range(shaft: &Table) -> anyhow::Result<Option<Figure>> {
    let steps = shaft.column("step")?;
    let n = steps.iter().take_while(|step| **step == steps[0]).count();
    let is_swept = shaft.names().get(TIME + 1).is_none_or(|name| name != POSITION);
    // Rows of a step follow each other; a step that is not whole is left out.
    let n_steps = steps.len().checked_div(n).unwrap_or(0);
    if is_swept || n_steps < 2 {
        return Ok(None);
    }
    let z = MILLIMETRE.of(&shaft.column(POSITION)?[..n]);
    let axis = MILLIMETRE.axis("position along the shaft");
    let mut figure = Figure::new(
        "Deflection line of the shaft over time",
        axis,
        MICROMETRE.axis("displacement"),
    )
    .note("Lines are means over the steps, bands go from the least to the largest.");
    let mut moves = false;
    for name in ["x", "y", "z"] {
        let values = MICROMETRE.of(shaft.column(&format!("{name}_m"))?);
        if values.iter().all(|u| u.abs() < NOTHING) {
            continue;
        }
        moves = true;
        let at = |place: usize| values[..n * n_steps].iter().skip(place).step_by(n);
        let mean = |place: usize| at(place).sum::<f64>() / n_steps as f64;
        let ends = |place: usize| {
            at(place).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], u| {
                [low.min(*u), high.max(*u)]
            })
        };
        let mean: Vec<f64> = (0..n).map(mean).collect();
        figure = figure.series(Series::line(name, points(&z, &mean)).band((0..n).map(ends).collect()));
    }
    Ok(moves.then_some(figure))
}

/// The largest ball force of each bearing over the points of a sweep; none of one point.
fn loads(dir: &Path, bearings: &Table) -> anyhow::Result<Option<Figure>> {
    let Some(column) = swept_column(bearings) else {
        return Ok(None);
    };
    let (axis, x): (Axis, Vec<f64>) = axis_of(bearings, column, "step")?;
    let force = NEWTON.of(bearings.column("largest_ball_force_n")?);
    let n = last_rows(bearings)?.len();
    let names = names(dir, n)?;
    let mut figure = Figure::new(
        "Largest ball force of each bearing",
        axis,
        NEWTON.axis("force").including(0.0),
    );
    for (i, name) in names.into_iter().enumerate() {
        let of = |values: &[f64]| values.iter().skip(i).step_by(n).copied().collect::<Vec<_>>();
        figure = figure.series(Series::line_and_marks(name, points(&of(&x), &of(&force))));
    }
    Ok(Some(figure))
}

/// Names of all bearings, in the order of their rows.
pub fn all_names(dir: &Path) -> anyhow::Result<Vec<String>> {
    let bearings = Table::read(dir, BEARINGS_TABLE)?;
    let n = bearings
        .as_ref()
        .map_or(Ok(0), |table| Ok::<_, anyhow::Error>(last_rows(table)?.len()))?;
    names(dir, n)
}

/// Names of the first bearings, in the order of their rows.
pub fn names(dir: &Path, n: usize) -> anyhow::Result<Vec<String>> {
    let text = std::fs::read_to_string(dir.join(BEARINGS_TABLE))?;
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = head.iter().position(|name| *name == "bearing").unwrap_or(0);
    let name = |line: &str| line.split(',').nth(column).unwrap_or_default().to_string();
    Ok(lines.take(n).map(name).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(table: &str) -> Option<String> {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join(SHAFT_TABLE), table).unwrap();
        let table = Table::read(dir.path(), SHAFT_TABLE).unwrap().unwrap();
        range(&table).unwrap().map(|figure| figure.svg().unwrap())
    }

    /// Wrong: a figure of a correct run could not be made: an equal pair without load across leaves its shaft in place.
    #[test]
    fn the_line_of_a_shaft_that_stands_is_drawn() {
        let table = |text: &str| {
            let dir = tempfile::tempdir().unwrap();
            std::fs::write(dir.path().join(SHAFT_TABLE), text).unwrap();
            Table::read(dir.path(), SHAFT_TABLE).unwrap().unwrap()
        };
        let rows = "step,time_s,position_m,x_m,y_m,z_m\n0,0.0,0.0,0.0,-0.0,0.0\n0,0.0,0.1,0.0,0.0,1e-16\n";
        let svg = line(&table(rows), &table(rows)).unwrap().svg().unwrap();
        assert!(svg.contains("y at the bearings"), "{svg}");
        let moved = rows.replace("1e-16", "1e-6");
        let svg = line(&table(&moved), &table(rows)).unwrap().svg().unwrap();
        assert!(!svg.contains("y at the bearings"), "{svg}");
    }

    /// Wrong: the figure would show the end for the whole time, or be drawn of one instant, a sweep, or a shaft that
    /// stands. Over three steps the end of the shaft is at 0, 3 and 6 um, so the axis goes there.
    #[test]
    fn the_line_over_time_has_its_means_and_ends() {
        let rows = "0,0.0,0.0,0.0,0.0,0.0\n0,0.0,0.1,0.0,0.0,0.0\n1,0.1,0.0,0.0,0.0,0.0\n1,0.1,0.1,6e-6,0.0,0.0\n\
                    2,0.2,0.0,0.0,0.0,0.0\n2,0.2,0.1,3e-6,0.0,0.0\n";
        let head = "step,time_s,position_m,x_m,y_m,z_m\n";
        let svg = drawn(&format!("{head}{rows}")).unwrap();
        assert!(svg.contains("over time") && svg.lines().any(|line| line.trim() == "6"));
        assert_eq!(svg.matches("<polygon").count(), 1, "a band of x alone");
        let first: String = rows.lines().take(2).map(|row| format!("{row}\n")).collect();
        assert!(drawn(&format!("{head}{first}")).is_none());
        assert!(drawn(&format!("{head}{}", rows.replace("e-6", "e-13"))).is_none());
        let swept = "step,time_s,pairing.offset_m,position_m,x_m,y_m,z_m\n0,0,1e-6,0.0,0.0,0.0,0.0\n\
                     1,1,2e-6,0.0,1e-6,0.0,0.0\n";
        assert!(drawn(swept).is_none());
    }
}
