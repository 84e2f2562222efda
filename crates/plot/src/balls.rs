//! Forces, contact angles and pressures of the balls: round the bearing, and against time or the swept value.

use figure::{Axis, DataPoint, Figure, Series};

use super::choice::Choice;
use super::named::Named;
use super::quantity::{
    AxisUnit, DEGREE, GIGAPASCAL, MEGAWATT_PER_SQUARE_METRE, MICROMETRE, MILLIMETRE_PER_SECOND, NEWTON, ONE,
    RPM, WATT, azimuth_axis, points,
};
use super::run::{Results, Steps};
use super::shades::{self, Shades};
use results::table::Table;

/// A quantity of both contacts of a ball.
struct ContactQuantity {
    name: &'static str,
    title: &'static str,
    axis: &'static str,
    column: &'static str,
    unit: AxisUnit,
    /// Differences below are round-off, in the unit.
    resolution: f64,
}

impl ContactQuantity {
    fn y_axis(&self) -> Axis {
        self.unit.axis(self.axis).no_finer_than(self.resolution)
    }
}

const CONTACTS: [ContactQuantity; 3] = [
    ContactQuantity {
        name: "ball_force",
        title: "Contact force",
        axis: "contact force",
        column: "force_n",
        unit: NEWTON,
        resolution: 1e-6,
    },
    ContactQuantity {
        name: "contact_angle",
        title: "Contact angle",
        axis: "contact angle",
        column: "contact_angle_rad",
        unit: DEGREE,
        resolution: 1e-4,
    },
    ContactQuantity {
        name: "peak_pressure",
        title: "Peak Hertz pressure",
        axis: "peak pressure",
        column: "peak_pressure_pa",
        unit: GIGAPASCAL,
        resolution: 1e-9,
    },
];

/// What contacts of free balls have besides.
const OF_FREE_BALLS: [ContactQuantity; 5] = [
    ContactQuantity {
        name: "ball_slip",
        title: "Slip along the rolling direction",
        axis: "slip",
        column: "slip_rolling_m_per_s",
        unit: MILLIMETRE_PER_SECOND,
        resolution: 1e-6,
    },
    ContactQuantity {
        name: "ball_spin",
        title: "Spin",
        axis: "spin",
        column: "spin_rad_per_s",
        unit: RPM,
        resolution: 1e-6,
    },
    ContactQuantity {
        name: "traction",
        title: "Traction along the rolling direction",
        axis: "traction",
        column: "traction_rolling_n",
        unit: NEWTON,
        resolution: 1e-6,
    },
    ContactQuantity {
        name: "friction_power",
        title: "Friction power",
        axis: "power",
        column: "friction_power_w",
        unit: WATT,
        resolution: 1e-9,
    },
    ContactQuantity {
        name: "pv",
        title: "Largest pressure times sliding speed",
        axis: "pv",
        column: "pv_w_per_m2",
        unit: MEGAWATT_PER_SQUARE_METRE,
        resolution: 1e-9,
    },
];

/// What lubricated contacts have besides.
const OF_FILMS: [ContactQuantity; 2] = [
    ContactQuantity {
        name: "film_minimum",
        title: "Least thickness of the film",
        axis: "film",
        column: "film_minimum_m",
        unit: MICROMETRE,
        resolution: 1e-9,
    },
    ContactQuantity {
        name: "lambda",
        title: "Film over roughness",
        axis: "lambda",
        column: "lambda",
        unit: ONE,
        resolution: 1e-9,
    },
];

const SIDES: [&str; 2] = ["inner", "outer"];

/// All figures of `balls.csv`.
pub fn figures(results: &Results, choice: &Choice) -> anyhow::Result<Vec<Named>> {
    let Some(table) = &results.balls else {
        return Ok(Vec::new());
    };
    let steps = BallRows::new(table)?;
    let mut figures = Vec::new();
    let is_free = table.find("inner_slip_rolling_m_per_s").is_some();
    let of_free_balls = OF_FREE_BALLS.iter().filter(|_| is_free);
    let of_films = OF_FILMS.iter();
    let of_films = of_films.filter(|film| table.find(&format!("inner_{}", film.column)).is_some());
    for contact in CONTACTS.iter().chain(of_free_balls).chain(of_films) {
        match &results.steps {
            Steps::Single => figures.push(round(table, &steps.of_step(0), contact)?),
            Steps::Sweep(_) => {
                figures.push(over_values(results, table, &steps, contact)?);
                figures.push(round_each(results, table, &steps, contact)?);
            }
            Steps::Times => {
                figures.push(match turns(table, &steps, choice.ball)? {
                    true => way_round(table, &steps, contact, choice.ball)?,
                    false => in_time(results, table, &steps, contact, choice.ball)?,
                });
                figures.push(over_values(results, table, &steps, contact)?);
            }
        }
    }
    if results.steps == Steps::Times {
        figures.push(displacement(results, table, &steps, choice.ball)?);
    }
    Ok(figures)
}

/// Which rows of the table belong to which step and ball.
struct BallRows {
    /// First row of each step, and the end, `[n_steps + 1]`.
    starts: Vec<usize>,
    balls: Vec<usize>,
}

impl BallRows {
    fn new(table: &Table) -> anyhow::Result<BallRows> {
        let steps = table.column("step")?;
        let first_of_step = |&row: &usize| row == 0 || steps[row] != steps[row - 1];
        let mut starts: Vec<usize> = (0..steps.len()).filter(first_of_step).collect();
        starts.push(steps.len());
        let balls = table.column("ball")?.iter().map(|b| *b as usize).collect();
        Ok(BallRows { starts, balls })
    }

    fn n_steps(&self) -> usize {
        self.starts.len() - 1
    }

    fn of_step(&self, step: usize) -> Vec<usize> {
        (self.starts[step]..self.starts[step + 1]).collect()
    }

    fn of_ball(&self, ball: usize) -> anyhow::Result<Vec<usize>> {
        let rows: Vec<usize> = (0..self.balls.len())
            .filter(|&row| self.balls[row] == ball)
            .collect();
        if rows.is_empty() {
            let last = self.balls.iter().max().unwrap_or(&0);
            return Err(anyhow::anyhow!("there is no ball {ball}; balls are 0 to {last}"));
        }
        Ok(rows)
    }
}

/// Values of a contact at the given rows; an unloaded contact has a force but no angle and no pressure.
fn values(table: &Table, contact: &ContactQuantity, side: &str, rows: &[usize]) -> anyhow::Result<Vec<f64>> {
    let column = table.column(&format!("{side}_{}", contact.column))?;
    let force = table.column(&format!("{side}_force_n"))?;
    let value = |&row: &usize| match force[row] > 0.0 || contact.column == "force_n" {
        true => column[row] * contact.unit.factor,
        false => f64::NAN,
    };
    Ok(rows.iter().map(value).collect())
}

/// One equilibrium: both contacts against the azimuth of the balls.
fn round(table: &Table, rows: &[usize], contact: &ContactQuantity) -> anyhow::Result<Named> {
    let title = format!("{} of the balls", contact.title);
    let mut figure = Figure::new(title, azimuth_axis(), contact.y_axis());
    for side in SIDES {
        let places = by_azimuth(table, rows, &values(table, contact, side, rows)?)?;
        figure = figure.series(Series::line_and_marks(format!("{side} contact"), places));
    }
    Ok(Named::new(contact.name, figure))
}

/// A sweep: the inner contacts against the azimuth of the balls, a curve per point.
fn round_each(
    results: &Results,
    table: &Table,
    steps: &BallRows,
    contact: &ContactQuantity,
) -> anyhow::Result<Named> {
    let title = format!("{} of the balls at the inner ring", contact.title);
    let mut figure = Figure::new(title, azimuth_axis(), contact.y_axis());
    let against = results.against(table)?;
    let n = steps.n_steps();
    let numbers = table.column("step")?;
    let numbers: Vec<u64> = (0..n).map(|step| numbers[steps.starts[step]] as u64).collect();
    let shades = Shades::of(results, &numbers)?;
    figure = shades::bar(figure, shades.as_ref());
    for step in 0..n {
        let rows = steps.of_step(step);
        let places = by_azimuth(table, &rows, &values(table, contact, "inner", &rows)?)?;
        let name = against
            .as_ref()
            .map_or(String::new(), |(axis, value)| axis.value(value[rows[0]]));
        let series = Series::line_and_marks(name, places);
        figure = figure.series(shades::shaded(series, shades.as_ref(), step, n));
    }
    Ok(Named::new(format!("{}_round", contact.name), figure))
}

/// Points in the order of their azimuth from 0 to 360 deg.
fn by_azimuth(table: &Table, rows: &[usize], values: &[f64]) -> anyhow::Result<Vec<DataPoint>> {
    let azimuth = table.column("azimuth_rad")?;
    let place = |&row: &usize| (azimuth[row] * DEGREE.factor).rem_euclid(360.0);
    let places: Vec<f64> = rows.iter().map(place).collect();
    let mut places = points(&places, values);
    places.sort_by(|a, b| a.x.total_cmp(&b.x));
    if let Some(&first) = places.first() {
        // The curve closes.
        places.push(DataPoint::new(first.x + 360.0, first.y));
        places.retain(|place| place.x <= 360.0 + 1e-9);
    }
    Ok(places)
}

/// Mean over the balls with the band from the smallest to the largest, against time or the swept value.
fn over_values(
    results: &Results,
    table: &Table,
    steps: &BallRows,
    contact: &ContactQuantity,
) -> anyhow::Result<Named> {
    let Some((x_axis, x)) = results.against(table)? else {
        unreachable!("a single step has nothing to be plotted against")
    };
    // Others have no angle, pressure or film, and are left out of the mean.
    let balls = match contact.column {
        "force_n" => "the balls",
        _ => "the balls that carry",
    };
    let title = format!("{}, mean and range over {balls}", contact.title);
    let mut figure = Figure::new(title, x_axis, contact.y_axis());
    for side in SIDES {
        let (mut mean, mut band) = (Vec::new(), Vec::new());
        for step in 0..steps.n_steps() {
            let rows = steps.of_step(step);
            let mut loaded = values(table, contact, side, &rows)?;
            loaded.retain(|v| v.is_finite());
            let of_all = |f: fn(f64, f64) -> f64| loaded.iter().copied().reduce(f).unwrap_or(f64::NAN);
            let of_loaded = loaded.iter().sum::<f64>() / loaded.len() as f64;
            mean.push(DataPoint::new(x[rows[0]], of_loaded));
            band.push([of_all(f64::min), of_all(f64::max)]);
        }
        let name = format!("{side} contact");
        let series = match results.steps {
            Steps::Times => Series::line(name, mean),
            _ => Series::line_and_marks(name, mean),
        };
        figure = figure.series(series.band(band));
    }
    let suffix = if results.steps == Steps::Times {
        "_of_all"
    } else {
        ""
    };
    Ok(Named::new(format!("{}{suffix}", contact.name), figure))
}

/// Whether a ball moves round.
fn turns(table: &Table, steps: &BallRows, ball: usize) -> anyhow::Result<bool> {
    let (rows, azimuth) = (steps.of_ball(ball)?, table.column("azimuth_rad")?);
    Ok(rows.iter().any(|&row| azimuth[row] != azimuth[rows[0]]))
}

/// A motion of a bearing that does not turn: the contacts of one ball against time.
fn in_time(
    results: &Results,
    table: &Table,
    steps: &BallRows,
    contact: &ContactQuantity,
    ball: usize,
) -> anyhow::Result<Named> {
    let rows = steps.of_ball(ball)?;
    let Some((x_axis, x)) = results.against(table)? else {
        unreachable!("a motion has times")
    };
    let times: Vec<f64> = rows.iter().map(|&row| x[row]).collect();
    let title = format!("{} of ball {ball}, which does not turn", contact.title);
    let mut figure = Figure::new(title, x_axis, contact.y_axis());
    for side in SIDES {
        let line = points(&times, &values(table, contact, side, &rows)?);
        figure = figure.series(Series::line(format!("{side} contact"), line));
    }
    Ok(Named::new(contact.name, figure))
}

/// A motion: the contacts of one ball against its azimuth.
fn way_round(
    table: &Table,
    steps: &BallRows,
    contact: &ContactQuantity,
    ball: usize,
) -> anyhow::Result<Named> {
    let rows = steps.of_ball(ball)?;
    let azimuth = table.column("azimuth_rad")?;
    let title = format!("{} of ball {ball} on its way round", contact.title);
    let x_axis = Axis::linear(format!("azimuth of ball {ball}"), "deg")
        .ticks_every(45.0)
        .tight();
    let mut figure = Figure::new(title, x_axis, contact.y_axis());
    for side in SIDES {
        let along = rows.iter().zip(values(table, contact, side, &rows)?);
        let mut line: Vec<DataPoint> = Vec::new();
        for (&row, value) in along {
            let place = (azimuth[row] * DEGREE.factor).rem_euclid(360.0);
            if line.last().is_some_and(|last| (last.x - place).abs() > 180.0) {
                line.push(DataPoint::GAP);
            }
            line.push(DataPoint::new(place, value));
        }
        figure = figure.series(Series::line(format!("{side} contact"), line));
    }
    Ok(Named::new(contact.name, figure))
}

/// A motion: displacement of one ball in its meridian plane against time.
fn displacement(results: &Results, table: &Table, steps: &BallRows, ball: usize) -> anyhow::Result<Named> {
    let rows = steps.of_ball(ball)?;
    let Some((x_axis, x)) = results.against(table)? else {
        unreachable!("a motion has times")
    };
    let title = format!("Displacement of ball {ball} from the just-touching state");
    let mut figure = Figure::new(title, x_axis, MICROMETRE.axis("displacement"));
    let times: Vec<f64> = rows.iter().map(|&row| x[row]).collect();
    for direction in ["radial", "axial"] {
        let column = table.column(&format!("displacement_{direction}_m"))?;
        let values: Vec<f64> = rows.iter().map(|&row| column[row] * MICROMETRE.factor).collect();
        figure = figure.series(Series::line(direction, points(&times, &values)));
    }
    Ok(Named::new("ball_displacement", figure))
}
