//! Frequencies at which defects of a bearing show: from the cage as it was simulated.
//!
//! With the cage at f_c, the rings at f_i and f_o and Z balls: BPFO = Z |f_c - f_o|, BPFI = Z |f_i - f_c|; a defect
//! on a ball meets both raceways in a turn of the ball relative to the cage: 2 BSF. A free ball has its own turning w:
//! that is |w - f_c e_z|, of the first ball with a profile.
//!
//! A defect that turns with its ring through a load that stands is loaded and unloaded once a turn of the ring: its
//! lines have sidebands at the speed of the ring, those of a defect on a ball at the speed of the cage. Under an
//! unbalance the load turns with the inner ring: then it is the outer ring's lines that have them. (Randall and Antoni,
//! Mechanical Systems and Signal Processing 25 (2011) 485.)

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::{Context, anyhow, ensure};
use contact::Side;
use results::ball_turns::BallTurns;
use results::table::Table;
use scene::Scene;

/// A frequency and its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Such as BPFO.
    pub name: &'static str,
    /// Hz.
    pub frequency: f64,
    /// Multiples of it that matter.
    pub harmonics: usize,
    /// Distance from the line to its sidebands, Hz; 0: it has none.
    pub sidebands: f64,
}

/// Sidebands that matter on each side of a line.
const SIDEBANDS: i32 = 2;

impl Line {
    /// The line and its multiples, each with its sidebands: frequency, Hz, and whether it is a sideband.
    pub fn family(&self) -> Vec<(f64, bool)> {
        let orders = -SIDEBANDS..=SIDEBANDS;
        let wanted = |order: &i32| *order == 0 || self.sidebands > 0.0;
        let orders: Vec<i32> = orders.filter(wanted).collect();
        let of = |k: usize| {
            let line = k as f64 * self.frequency;
            orders
                .iter()
                .map(move |order| (line + f64::from(*order) * self.sidebands, *order != 0))
        };
        let all = (1..=self.harmonics).flat_map(of);
        all.filter(|(frequency, _)| *frequency > 0.0).collect()
    }
}

impl Line {
    /// Whether a record shows a place of this line, itself or a sideband, apart from the ends of its frequencies, 0 and
    /// `highest`, from the other lines of `all`, and from the line itself, by two resolutions: so wide is a peak under
    /// the window of Hann.
    pub fn is_resolved(&self, place: f64, all: &[Line], (resolution, highest): (f64, f64)) -> bool {
        let lines = all.iter().map(|line| line.frequency).chain([0.0]);
        let others = lines.filter(|line| *line != place);
        others
            .map(|line| (line - place).abs())
            .all(|off| off >= 2.0 * resolution)
            && place + 2.0 * resolution <= highest
            && (self.sidebands == 0.0 || self.sidebands >= 2.0 * resolution)
    }
}

/// The lines of a motion in `dir` over a span of time, s, with those that are 0 left out.
pub fn lines(dir: &Path, scene: &Scene, (from, to): (f64, f64)) -> anyhow::Result<Vec<Line>> {
    let table = Table::read(dir, "balls.csv")?.with_context(|| {
        format!(
            "{} has no balls.csv; expected the results of a motion",
            dir.display()
        )
    })?;
    let (times, balls) = (table.column("time_s")?, table.column("ball")?);
    let rows: Vec<usize> = (0..table.n_rows())
        .filter(|&row| balls[row] == 0.0 && (from..=to).contains(&times[row]))
        .collect();
    ensure!(
        rows.len() > 1,
        "{} has fewer than two steps from {from} s to {to} s",
        dir.join("balls.csv").display()
    );
    let turns = BallTurns::new(&table, scene)?;
    let turned: f64 = rows.windows(2).map(|pair| turns.between(pair[0], pair[1])).sum();
    let duration = times[rows[rows.len() - 1]] - times[rows[0]];
    let cage = turned / (TAU * duration);
    let speeds = scene.speed.as_ref();
    let of_ring = |side: Side| {
        speeds.map_or(0.0, |speeds| {
            let speed = speeds.of(side);
            (speed.angle(times[rows[rows.len() - 1]]) - speed.angle(times[rows[0]])) / (TAU * duration)
        })
    };
    let [inner, outer] = Side::BOTH.map(of_ring);
    let spin = spin(&table, scene, (from, to))?;
    let all = lines_of(scene, (inner, outer), cage, spin);
    let found: Vec<Line> = all.into_iter().filter(|line| line.frequency > 0.0).collect();
    if found.is_empty() {
        return Err(anyhow!(
            "{} does not turn: there are no lines to mark",
            dir.display()
        ));
    }
    Ok(found)
}

/// Instants at which the speed of a ring is looked at.
const LOOKS: u32 = 200;

/// A sentence where a ring changes its speed so much, from `from` to `to`, s, that its highest line is drawn out over
/// more than a peak of a spectrum over the frequency has; `resolution` is that of the spectrum, Hz.
pub fn smear(scene: &Scene, (from, to): (f64, f64), marks: &[Line], resolution: f64) -> Option<String> {
    let highest = marks.iter().map(|line| line.frequency).fold(0.0, f64::max);
    let step = (to - from) / f64::from(LOOKS);
    Side::BOTH.into_iter().find_map(|side| {
        let speed = scene.speed.as_ref()?.of(side);
        let (low, high) = extremes(turns(|t| speed.angle(t), (from, to)).map(|turned| turned / (TAU * step)));
        let mean = (speed.angle(from + f64::from(LOOKS) * step) - speed.angle(from)) / (TAU * (to - from));
        let width = highest * (high - low) / mean.abs().max(f64::MIN_POSITIVE);
        (width > 2.0 * resolution).then(|| {
            format!(
                "the {} ring turns at {:.0} to {:.0} rpm in this time, so lines smear, and those named are of the mean \
                 speed; take --orders with a tachometer of the scene, or a part of the run by --from and --to",
                side.name(),
                60.0 * low,
                60.0 * high
            )
        })
    })
}

/// Angles that a ring turns between looks from `from` to `to`, s, in rad; `angle` is its angle at a time.
fn turns(angle: impl Fn(f64) -> f64, (from, to): (f64, f64)) -> impl Iterator<Item = f64> {
    let step = (to - from) / f64::from(LOOKS);
    let angle = move |i: u32| angle(from + f64::from(i) * step);
    (0..LOOKS).map(move |i| angle(i + 1) - angle(i))
}

fn extremes(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    values.fold(none, |(low, high), x| (low.min(x), high.max(x)))
}

/// The same of a spectrum over orders with this resolution: there the rings smear the lines of passing balls, Z/2 times
/// the change of the ratio of their speeds, unless they keep step.
pub fn smear_of_orders(scene: &Scene, span: (f64, f64), resolution: f64) -> Option<String> {
    let speeds = scene.speed.as_ref()?;
    let [inner, outer] = Side::BOTH.map(|side| turns(move |t| speeds.of(side).angle(t), span));
    let ratios = outer.zip(inner).map(|(outer, inner)| outer / inner);
    let (low, high) = extremes(ratios.filter(|ratio| ratio.is_finite()));
    let width = 0.5 * scene.bearing.balls as f64 * (high - low);
    (width > 2.0 * resolution).then(|| {
        format!(
            "the outer ring turns {low:.3} to {high:.3} times as fast as the inner ring in this time, so lines smear \
             over orders too, and those named are of the mean speeds; take a part of the run by --from and --to"
        )
    })
}

/// The lines of a bearing whose rings, cage and balls turn at these speeds, Hz.
fn lines_of(scene: &Scene, (inner, outer): (f64, f64), cage: f64, spin: f64) -> [Line; 5] {
    let n = scene.bearing.balls as f64;
    let line = |name, frequency: f64, harmonics, sidebands: f64| Line {
        name,
        frequency: frequency.abs(),
        harmonics,
        sidebands: sidebands.abs(),
    };
    let load = match scene.effects.unbalance {
        Some(_) => inner,
        None => 0.0,
    };
    // Balls that are spheres have no pulses.
    let of_ball = if scene.profiles.balls.is_empty() { 1 } else { 3 };
    [
        line("BPFO", n * (cage - outer), 3, outer - load),
        line("BPFI", n * (inner - cage), 3, inner),
        line("2 BSF", 2.0 * spin, of_ball, cage),
        line("cage", cage, 1, 0.0),
        line("shaft", inner, 1, 0.0),
    ]
}

/// Mean speed with which a ball turns relative to the cage, Hz; 0 where the table does not tell.
fn spin(table: &Table, scene: &Scene, (from, to): (f64, f64)) -> anyhow::Result<f64> {
    let marked = scene.profiles.balls.keys().next().copied().unwrap_or(0) as f64;
    let (times, balls) = (table.column("time_s")?, table.column("ball")?);
    let is_wanted = |row: &usize| balls[*row] == marked && (from..=to).contains(&times[*row]);
    let free = [
        "omega_x_rad_per_s",
        "omega_y_rad_per_s",
        "omega_z_rad_per_s",
        "orbit_rad_per_s",
    ];
    let speed = |row: usize| match (table.find("spin_rad_per_s"), free.map(|name| table.find(name))) {
        (Some(spin), _) => spin[row].abs(),
        (None, [Some(x), Some(y), Some(z), Some(orbit)]) => x[row].hypot(y[row]).hypot(z[row] - orbit[row]),
        _ => 0.0,
    };
    let speeds: Vec<f64> = (0..table.n_rows()).filter(is_wanted).map(speed).collect();
    Ok(speeds.iter().sum::<f64>() / (TAU * speeds.len().max(1) as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: sidebands would be marked elsewhere, at lines that have none, or below frequency 0.
    #[test]
    fn a_line_has_its_multiples_and_sidebands() {
        let line = Line {
            name: "BPFI",
            frequency: 300.0,
            harmonics: 2,
            sidebands: 30.0,
        };
        let lines: Vec<f64> = line.family().iter().map(|(f, _)| *f).collect();
        assert_eq!(
            lines,
            [
                240.0, 270.0, 300.0, 330.0, 360.0, 540.0, 570.0, 600.0, 630.0, 660.0
            ]
        );
        let own = line
            .family()
            .iter()
            .filter(|(_, is_sideband)| !is_sideband)
            .count();
        assert_eq!(own, 2);
        let bare = Line {
            sidebands: 0.0,
            ..line.clone()
        };
        assert_eq!(bare.family(), [(300.0, false), (600.0, false)]);
        let slow = Line {
            frequency: 40.0,
            harmonics: 1,
            ..line
        };
        assert_eq!(
            slow.family().iter().map(|(f, _)| *f).collect::<Vec<_>>(),
            [10.0, 40.0, 70.0, 100.0]
        );
    }

    /// Wrong: the neighbour of a line, or the mean of the signal, would be read as the line.
    #[test]
    fn a_line_is_resolved_two_resolutions_from_all_others_and_from_zero() {
        let line = |name, frequency, sidebands| Line {
            name,
            frequency,
            harmonics: 1,
            sidebands,
        };
        let all = [
            line("BPFO", 234.0, 0.0),
            line("2 BSF", 213.0, 0.0),
            line("cage", 13.0, 0.0),
            line("BPFI", 306.0, 30.0),
        ];
        let resolved = |resolution: f64| {
            let found = all
                .iter()
                .map(|line| line.is_resolved(line.frequency, &all, (resolution, 500.0)));
            found.collect::<Vec<_>>()
        };
        assert_eq!(resolved(5.0), [true; 4]);
        assert_eq!(resolved(8.0), [true, true, false, true]);
        assert_eq!(resolved(12.0), [false, false, false, true]);
        assert_eq!(resolved(16.0), [false, false, false, false]);
        let side = |resolution: f64, highest: f64| all[3].is_resolved(276.0, &all, (resolution, highest));
        assert!(side(8.0, 500.0) && !side(16.0, 500.0));
        assert!(side(8.0, 292.0) && !side(8.0, 291.0), "beyond what rows tell");
    }
}
