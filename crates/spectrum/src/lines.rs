//! Frequencies at which defects of a bearing show: from the cage as it was simulated.
//!
//! With the cage at f_c, the rings at f_i and f_o and Z balls: BPFO = Z |f_c - f_o|, BPFI = Z |f_i - f_c|; a defect
//! on a ball meets both raceways in a turn of the ball relative to the cage: 2 BSF.

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::{Context, anyhow, ensure};
use contact::Side;
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
}

/// The lines of a motion in `dir` over a span of time, s, with those that are 0 left out.
pub fn lines(dir: &Path, scene: &Scene, (from, to): (f64, f64)) -> anyhow::Result<Vec<Line>> {
    let table = Table::read(dir, "balls.csv")?.with_context(|| {
        format!(
            "{} has no balls.csv; expected the results of a motion",
            dir.display()
        )
    })?;
    let (times, balls, azimuths) = (
        table.column("time_s")?,
        table.column("ball")?,
        table.column("azimuth_rad")?,
    );
    let rows: Vec<usize> = (0..table.n_rows())
        .filter(|&row| balls[row] == 0.0 && (from..=to).contains(&times[row]))
        .collect();
    ensure!(
        rows.len() > 1,
        "{} has fewer than two steps from {from} s to {to} s",
        dir.join("balls.csv").display()
    );
    let turns = rows.windows(2).map(|pair| {
        let turn = azimuths[pair[1]] - azimuths[pair[0]];
        turn - TAU * (turn / TAU).round()
    });
    let duration = times[rows[rows.len() - 1]] - times[rows[0]];
    let cage = turns.sum::<f64>() / (TAU * duration);
    let speeds = scene.speed.as_ref();
    let of_ring = |side: Side| {
        speeds.map_or(0.0, |speeds| {
            let speed = speeds.of(side);
            (speed.angle(times[rows[rows.len() - 1]]) - speed.angle(times[rows[0]])) / (TAU * duration)
        })
    };
    let [inner, outer] = Side::BOTH.map(of_ring);
    let n = scene.bearing.balls as f64;
    let spins = table.find("spin_rad_per_s");
    let spin = spins.map_or(0.0, |spin| {
        rows.iter().map(|&row| spin[row].abs()).sum::<f64>() / (TAU * rows.len() as f64)
    });
    let line = |name, frequency: f64, harmonics| Line {
        name,
        frequency: frequency.abs(),
        harmonics,
    };
    let all = [
        line("BPFO", n * (cage - outer), 3),
        line("BPFI", n * (inner - cage), 3),
        line("2 BSF", 2.0 * spin, 1),
        line("cage", cage, 1),
        line("shaft", inner, 1),
    ];
    let found: Vec<Line> = all.into_iter().filter(|line| line.frequency > 0.0).collect();
    if found.is_empty() {
        return Err(anyhow!(
            "{} does not turn: there are no lines to mark",
            dir.display()
        ));
    }
    Ok(found)
}
