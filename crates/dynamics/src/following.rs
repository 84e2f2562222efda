//! What follows the contact angles of an equilibrium, as a part of its tangent.

use timer::SharedLaps;

use crate::bodies::AXES;
use crate::effects::{Loads, Now};
use crate::error::DynamicsError;
use crate::interactions::raceway_contact::SiteState;
use crate::loading::LoadCase;
use crate::model::Model;
use crate::solution::StaticSolution;

/// Step of a contact angle in a difference quotient of loads, rad: their relative error is its square.
const ANGLE_STEP: f64 = 1e-5;
/// Step of an unknown in a difference quotient of contact angles, over the distance of the centres.
pub(crate) const LENGTH_STEP: f64 = 1e-5;

/// Adds the growth of loads that follow the contact angles: d residual/d angle, of each site, times d angle/dx.
pub(crate) fn add_following_loads(
    model: &Model,
    solution: &StaticSolution,
    (case, growths): (&LoadCase, &ContactGrowths),
    x: &[f64],
    stiffness: &mut [f64],
) -> Result<(), DynamicsError> {
    let states = case.parts.states(x);
    let angles: Vec<f64> = states.iter().map(|state| state.angle).collect();
    let mut parts = case.parts.clone();
    let mut residual = |angles: &[f64]| -> Result<Vec<f64>, DynamicsError> {
        let now = Now {
            angles: Some(angles),
            ..solution.pose.now
        };
        let found = model.loads(&now)?;
        parts.set_loads(&Loads {
            ring_on_shaft: case.loads.ring_on_shaft,
            ring_on_seat: case.loads.ring_on_seat,
            ..found
        });
        Ok(parts.system().evaluate(x, &SharedLaps::default()).residual)
    };
    let mut of_angles = Vec::with_capacity(angles.len());
    for site in 0..angles.len() {
        let mut at = |sign: f64| {
            let mut moved = angles.clone();
            moved[site] += sign * ANGLE_STEP;
            residual(&moved)
        };
        let (low, high) = (at(-1.0)?, at(1.0)?);
        let change = low
            .iter()
            .zip(&high)
            .map(|(low, high)| (high - low) / (2.0 * ANGLE_STEP));
        of_angles.push(change.collect::<Vec<f64>>());
    }
    for (site, of_angle) in of_angles.iter().enumerate() {
        for column in 0..x.len() {
            let [angle, _] = growths.of(site, column);
            if angle != 0.0 {
                add_to_column(stiffness, (x.len(), column), of_angle, angle);
            }
        }
    }
    Ok(())
}

/// Adds a change times a factor to a column of a row-major matrix of `n` columns.
pub(crate) fn add_to_column(matrix: &mut [f64], (n, column): (usize, usize), change: &[f64], factor: f64) {
    let rows = matrix.iter_mut().skip(column).step_by(n);
    rows.zip(change).for_each(|(sum, change)| *sum += change * factor);
}

/// Growth of contact angles, rad, and of contact forces, N, with the unknowns.
pub(crate) struct ContactGrowths(Vec<[Vec<f64>; 2]>);

impl ContactGrowths {
    /// About the unknowns `x` of a bearing whose patches stay.
    pub(crate) fn new(case: &LoadCase, x: &[f64]) -> ContactGrowths {
        ContactGrowths((0..x.len()).map(|unknown| growths(case, x, unknown)).collect())
    }

    /// Of a site with an unknown: angle and force.
    pub(crate) fn of(&self, site: usize, unknown: usize) -> [f64; 2] {
        self.0[unknown].each_ref().map(|sites| sites[site])
    }
}

/// Growth of all contact angles and of all forces with an unknown.
fn growths(case: &LoadCase, x: &[f64], unknown: usize) -> [Vec<f64>; 2] {
    let scale = case.model.geometry.groove_distance();
    let is_tilt = (3..AXES.len()).contains(&unknown);
    let step = LENGTH_STEP
        * if is_tilt {
            scale / case.scales.tilt_arm
        } else {
            scale
        };
    let states = |sign: f64| {
        let mut moved = x.to_vec();
        moved[unknown] += sign * step;
        case.parts.states(&moved)
    };
    let (low, high) = (states(-1.0), states(1.0));
    let growth = |of: fn(&SiteState) -> f64| {
        let pairs = low.iter().zip(&high);
        pairs
            .map(|(low, high)| (of(high) - of(low)) / (2.0 * step))
            .collect()
    };
    [growth(|state| state.angle), growth(|state| state.force.force)]
}
