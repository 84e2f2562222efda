//! Figures of a life: round the raceways, and over the swept value.

use figure::{Axis, DataPoint, Figure, Series};
use plot::Named;
use plot::quantity::{DEGREE, azimuth_axis};

use crate::assess::{Assessment, RacewayLife};
use crate::run::SweepLife;

/// What lives are shown in.
const UNIT: &str = "million revolutions";

/// One of the lives of an assessment, revolutions.
type LifeOf = fn(&Assessment) -> Option<f64>;

fn life_axis(name: &str) -> Axis {
    Axis::logarithmic(name, UNIT)
}

/// Life of the positions of both raceways.
pub fn round(found: &Assessment) -> Named {
    let figure = Figure::new("Life round the raceways", azimuth_axis(), life_axis("life of a position"))
        .note("Each raceway in its own frame; of a ring that turns under loads fixed in space all positions are alike");
    let line = |name: &str, ring: &RacewayLife| Series::line(name, places(ring));
    let figure = figure
        .series(line("inner raceway", &found.inner))
        .series(line("outer raceway", &found.outer));
    Named::new("life_round", figure)
}

fn places(ring: &RacewayLife) -> Vec<DataPoint> {
    let Some(positions) = &ring.positions else {
        return Vec::new();
    };
    let lives = positions.l10r_revolutions.iter();
    let lives = lives.map(|life| life.map_or(f64::NAN, |life| 1e-6 * life));
    let angles = positions.azimuth_rad.iter().map(|angle| angle * DEGREE.factor);
    angles.zip(lives).map(|(x, y)| DataPoint::new(x, y)).collect()
}

/// Lives over the swept value; `x` has a place on the axis for each point.
pub fn over_sweep(axis: Axis, x: &[f64], points: &[(SweepLife, Assessment)]) -> Named {
    let mut figure = Figure::new("Life", axis, life_axis("life"));
    let curves: [(&str, LifeOf); 3] = [
        ("L_10r, ISO 16281", |found| found.l10r_revolutions),
        ("L_10, ISO 281", |found| found.catalogue.l10_revolutions),
        ("L_nmr, ISO 16281", |found| found.l_nmr_revolutions),
    ];
    for (name, shown) in curves {
        let lives: Vec<Option<f64>> = points.iter().map(|(_, found)| shown(found)).collect();
        if lives.iter().all(Option::is_none) {
            continue;
        }
        let line = x.iter().zip(lives);
        let line = line.map(|(x, life)| DataPoint::new(*x, life.map_or(f64::NAN, |life| 1e-6 * life)));
        figure = figure.series(Series::line_and_marks(name, line.collect()));
    }
    Named::new("life", figure)
}

/// Life round the raceway that stands under the loads, a curve per point.
pub fn round_each(names: &[String], points: &[(SweepLife, Assessment)]) -> Named {
    // Positions of a ring that turns are alike.
    let differs = |ring: &RacewayLife| ring.even_revolutions > ring.l10r_revolutions.map(|life| 1.001 * life);
    let inner_stands = points.iter().any(|(_, found)| differs(&found.inner));
    let ring = |found: &Assessment| match inner_stands {
        true => places(&found.inner),
        false => places(&found.outer),
    };
    let side = if inner_stands { "inner" } else { "outer" };
    let mut figure = Figure::new(
        format!("Life round the {side} raceway"),
        azimuth_axis(),
        life_axis("life of a position"),
    );
    for (i, ((_, found), name)) in points.iter().zip(names).enumerate() {
        let line = Series::line(name, ring(found)).shade(i, points.len());
        figure = figure.series(line);
    }
    Named::new("life_round", figure)
}
