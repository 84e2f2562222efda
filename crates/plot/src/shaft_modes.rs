//! Mode shapes of the shaft of several bearings, over the positions along it.
//!
//! A mode moves the axis of the shaft by x, y and z. Across the axis it is shown in the direction in which it moves
//! most: that of the larger eigenvalue of the sum of (x, y) (x, y)^T over the places. What stands across that is left
//! out; it is nothing where the mode is plane.

use std::path::Path;

use figure::{Axis, DataPoint, Figure, Look, Series};
use results::several::{BEARING, BEARINGS_TABLE};
use results::table::Table;

use super::quantity::{DEGREE, MILLIMETRE, points};

/// Share of the kinetic energy of a mode that shaft and bodies on it must have to be shown.
const SHARE: f64 = 0.1;
/// Modes in one figure.
const IN_ONE: usize = 5;
/// Columns with the share of the shaft; the second where bodies are on it.
const OF_SHAFT: [&str; 2] = ["kinetic_shaft", "kinetic_shaft_body"];

/// A mode of the shaft.
struct ShaftMode {
    /// Frequency, way and direction in words.
    name: String,
    /// Place, mm, and displacement over the largest one of the shaft.
    line: Vec<DataPoint>,
}

/// Figures of the modes in which the shaft takes part, the lowest first; none without such.
pub fn figures(dir: &Path) -> anyhow::Result<Vec<(String, Figure)>> {
    let tables = [MODES, SHAPES, BEARINGS_TABLE].map(|name| Table::read(dir, name));
    let [Some(modes), Some(shapes), Some(bearings)] = collected(tables)? else {
        return Ok(Vec::new());
    };
    let frequencies = modes.column("frequency_hz")?;
    let mut found = Vec::new();
    for (i, frequency) in frequencies.iter().enumerate() {
        let share = |name: &&str| modes.find(name).map_or(0.0, |column| column[i]);
        if OF_SHAFT.iter().map(share).sum::<f64>() >= SHARE {
            found.extend(mode(&shapes, i + 1, *frequency)?);
        }
    }
    let places = MILLIMETRE.of(bearings.column("position_m")?);
    let names = bearings.texts(BEARING).unwrap_or_default();
    let bearings: Vec<(f64, &str)> = places
        .into_iter()
        .zip(names)
        .map(|(z, name)| (z, name.as_str()))
        .collect();
    let figure = |(i, modes): (usize, &[ShaftMode])| {
        let number = if i == 0 {
            String::new()
        } else {
            format!("_{}", i + 1)
        };
        (format!("shaft_modes{number}"), figure(modes, &bearings))
    };
    Ok(found.chunks(IN_ONE).enumerate().map(figure).collect())
}

/// Frequencies and shares.
const MODES: &str = "modes.csv";
/// Shapes of the shaft.
const SHAPES: &str = "mode_shaft.csv";

/// The tables, or why one of them cannot be read.
fn collected(tables: [anyhow::Result<Option<Table>>; 3]) -> anyhow::Result<[Option<Table>; 3]> {
    let [a, b, c] = tables;
    Ok([a?, b?, c?])
}

/// The shape of a mode by its number; None where the shaft stands.
fn mode(shapes: &Table, number: usize, frequency: f64) -> anyhow::Result<Option<ShaftMode>> {
    let rows = shapes.column("mode")?.iter().enumerate();
    let rows: Vec<usize> = rows
        .filter(|(_, mode)| **mode == number as f64)
        .map(|(i, _)| i)
        .collect();
    let of = |name: &str| -> anyhow::Result<Vec<f64>> {
        let column = shapes.column(name)?;
        Ok(rows.iter().map(|&i| column[i]).collect())
    };
    let places = MILLIMETRE.of(&of("position_m")?);
    let [x, y, z] = [of("x")?, of("y")?, of("z")?];
    let direction = direction(&x, &y);
    let (sin, cos) = direction.sin_cos();
    let across: Vec<f64> = x.iter().zip(&y).map(|(x, y)| cos * x + sin * y).collect();
    let size = |line: &[f64]| line.iter().fold(0.0f64, |most, u| most.max(u.abs()));
    let (line, way) = match size(&z) > size(&across) {
        true => (z, "along z".to_string()),
        false => {
            let degrees = DEGREE.of(&[direction])[0].rem_euclid(180.0).round() % 180.0;
            (across, format!("at {degrees:.0} deg"))
        }
    };
    // Modes of one kind look alike: the first place that moves by half of the largest moves up.
    let most = size(&line);
    let first = line
        .iter()
        .find(|u| u.abs() >= 0.5 * most)
        .copied()
        .unwrap_or(1.0);
    let scaled: Vec<f64> = line.iter().map(|u| u / most.copysign(first)).collect();
    Ok((most > 0.0).then(|| ShaftMode {
        name: format!("{number}: {frequency:.1} Hz, {way}"),
        line: points(&places, &scaled),
    }))
}

/// Azimuth of the direction across the axis in which displacements are largest, rad.
fn direction(x: &[f64], y: &[f64]) -> f64 {
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    0.5 * (2.0 * sum(x, y)).atan2(sum(x, x) - sum(y, y))
}

/// Modes over the positions along the shaft, and where the bearings are.
fn figure(modes: &[ShaftMode], bearings: &[(f64, &str)]) -> Figure {
    let displacement = Axis::linear("displacement over the largest", "1");
    let mut figure = Figure::new(
        "Mode shapes of the shaft",
        MILLIMETRE.axis("position along the shaft"),
        displacement.including(-1.0).including(1.0),
    );
    for &(z, name) in bearings {
        let [low, high] = [-1.0, 1.0].map(|u| DataPoint::new(z, u));
        figure = figure
            .series(Series::reference("bearings", vec![low, high]))
            .label(low, name);
    }
    for mode in modes {
        // A shaft with one place has no line.
        let look = if mode.line.len() > 1 {
            Look::Line
        } else {
            Look::Marks
        };
        figure = figure.series(Series::new(mode.name.clone(), look, mode.line.clone()));
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "mode,position_m,x,y,z,tilt_x_per_m,tilt_y_per_m\n";

    /// The tables of a shaft of three places in three modes, of which the second is one of balls.
    fn folder() -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| std::fs::write(dir.path().join(name), text).unwrap();
        write(
            MODES,
            "step,body,mode,frequency_hz,kinetic_shaft\n1,bearings,1,100.04,0.9\n2,bearings,2,150,0.01\n\
             3,bearings,3,400,0.6\n",
        );
        let mut shapes = HEAD.to_string();
        // Bent in the plane at 150 deg: the sine of 0 to pi with the other sign.
        for (i, u) in [0.0, -0.8, 0.0].into_iter().enumerate() {
            let (sin, cos) = 150f64.to_radians().sin_cos();
            let z = 0.1 * i as f64;
            shapes += &format!("1,{z:?},{:?},{:?},0.01,0.0,0.0\n", u * cos, u * sin);
        }
        for mode in [2, 3] {
            for z in ["0.0", "0.1", "0.2"] {
                shapes += &format!("{mode},{z},0.0,0.001,-0.5,0.0,0.0\n");
            }
        }
        write(SHAPES, &shapes);
        write(
            BEARINGS_TABLE,
            "step,time_s,bearing,position_m\n0,0,front,0.05\n0,0,rear,0.15\n",
        );
        dir
    }

    /// Wrong: modes of balls would hide those of the shaft, a mode be drawn in a plane in which it hardly moves, or
    /// point down; a reader would not know which mode it is and where the bearings are.
    #[test]
    fn modes_of_the_shaft_are_drawn_in_their_plane() {
        let dir = folder();
        let shapes = Table::read(dir.path(), SHAPES).unwrap().unwrap();
        let bent = mode(&shapes, 1, 100.04).unwrap().unwrap();
        assert_eq!(bent.name, "1: 100.0 Hz, at 150 deg");
        let expected = [[0.0, 0.0], [100.0, 1.0], [200.0, 0.0]];
        for (found, [x, y]) in bent.line.iter().zip(expected) {
            let off = (found.x - x).abs().max((found.y - y).abs());
            assert!(off < 1e-12, "{:?}", bent.line);
        }
        let along = mode(&shapes, 3, 400.0).unwrap().unwrap();
        assert_eq!(along.name, "3: 400.0 Hz, along z");
        assert!(along.line.iter().all(|p| p.y == 1.0));
        let found = figures(dir.path()).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, "shaft_modes");
        let svg = found[0].1.svg().unwrap();
        for text in ["100.0 Hz", "400.0 Hz", "front", "rear", "bearings"] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(!svg.contains("150.0 Hz"));
    }
}
