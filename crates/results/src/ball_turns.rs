//! How far balls go round between rows of `balls.csv`, which has azimuths from 0 to a turn.
//!
//! Which turn it is tells the cage as it rolls, or the speed round the axis of a free ball. So rows may be turns apart.

use std::f64::consts::TAU;

use dynamics::kinematics::Rolling;
use scene::Scene;

use crate::table::Table;

/// What tells the way of balls between two rows.
pub struct BallTurns<'t> {
    times: &'t [f64],
    azimuths: &'t [f64],
    /// Speed round the axis of free balls, rad/s.
    orbits: Option<&'t [f64]>,
    /// None: nothing turns.
    rolling: Option<Rolling>,
}

impl<'t> BallTurns<'t> {
    /// Of a table of balls.
    pub fn new(table: &'t Table, scene: &Scene) -> anyhow::Result<BallTurns<'t>> {
        Ok(BallTurns {
            times: table.column("time_s")?,
            azimuths: table.column("azimuth_rad")?,
            orbits: table.find("orbit_rad_per_s"),
            rolling: scene::rolling(scene),
        })
    }

    /// Angle by which a ball goes round from one of its rows to a later one, rad.
    pub fn between(&self, from: usize, to: usize) -> f64 {
        let turn = self.azimuths[to] - self.azimuths[from];
        turn + TAU * ((self.expected(from, to) - turn) / TAU).round()
    }

    fn expected(&self, from: usize, to: usize) -> f64 {
        let times = [from, to].map(|row| self.times[row]);
        match (self.orbits, &self.rolling) {
            (Some(orbits), _) => 0.5 * (orbits[from] + orbits[to]) * (times[1] - times[0]),
            (None, Some(Rolling { speeds, kinematics })) => {
                let [before, after] = times.map(|time| kinematics.cage_angle(speeds, time));
                after - before
            }
            (None, None) => 0.0,
        }
    }
}
