//! Stress at points given in ring coordinates, for probes and profiles.

use anyhow::anyhow;
use contact::near_field::in_axes;
use contact::{RingPoint, Side};
use dynamics::Model;
use fem::FemError;
use fem::stress::{PointRecovery, principal, von_mises};
use scene::StressLine;

use super::probe_places::side_of;
use super::shown::{Shown, add};
use super::timed_near_field::TimedNearField;
use crate::failure::Failure;

/// Names of the columns of one point: components in the directions g (along the groove), t (rolling direction) and d
/// (depth).
pub const COLUMNS: [&str; 12] = [
    "stress_gg_pa",
    "stress_tt_pa",
    "stress_dd_pa",
    "stress_gt_pa",
    "stress_td_pa",
    "stress_gd_pa",
    "von_mises_pa",
    "principal_1_pa",
    "principal_2_pa",
    "principal_3_pa",
    "maximum_shear_pa",
    "hydrostatic_pa",
];

/// Lines of points on the rings.
pub struct StressPoints {
    lines: Vec<StressLine>,
    /// By side; None where no point lies.
    rings: [Option<RingPoints>; 2],
}

/// The points of one ring, line after line.
struct RingPoints {
    recovery: PointRecovery,
    near_field: Option<TimedNearField>,
    axes: Vec<[[f64; 3]; 3]>,
}

impl StressPoints {
    /// Finds the points in the meshes.
    pub fn new(lines: &[StressLine], model: &Model, reach: Option<f64>) -> Result<StressPoints, Failure> {
        let on_ring = |side: Side| {
            let own: Vec<&StressLine> = lines.iter().filter(|line| side_of(line.ring) == side).collect();
            let Some(ring) = model.ring(side).filter(|_| !own.is_empty()) else {
                return Ok::<_, Failure>(None);
            };
            let ring_point = |[azimuth, angle, depth]: [f64; 3]| RingPoint {
                azimuth,
                angle,
                depth,
            };
            let points: Vec<RingPoint> = own
                .iter()
                .flat_map(|line| line.points())
                .map(ring_point)
                .collect();
            let positions: Vec<[f64; 3]> = points.iter().map(|p| p.position(&ring.groove)).collect();
            let recovery = PointRecovery::new(&ring.mesh, &ring.material, &positions);
            let recovery = recovery.map_err(|error| match error {
                FemError::OutsideMesh { point } => {
                    let place = positions.iter().position(|x| *x == point);
                    outside(&own, place.unwrap_or(0))
                }
                other => other.into(),
            })?;
            let near_field = reach.map(|reach| TimedNearField::new(ring, reach, &positions));
            Ok(Some(RingPoints {
                recovery,
                near_field,
                axes: points.iter().map(|p| p.axes(&ring.groove)).collect(),
            }))
        };
        Ok(StressPoints {
            lines: lines.to_vec(),
            rings: Side::try_both(on_ring)?,
        })
    }

    /// The lines, in the order of their values.
    pub fn lines(&self) -> &[StressLine] {
        &self.lines
    }

    /// Seconds spent on near fields so far; None where no point has one.
    pub fn near_field_seconds(&self) -> Option<f64> {
        let fields = self.rings.iter().flatten().filter_map(|r| r.near_field.as_ref());
        fields.map(TimedNearField::seconds).reduce(|a, b| a + b)
    }

    /// Values of [`COLUMNS`] at every point, line after line, Pa.
    pub fn values(&self, shown: &Shown<'_>) -> Result<Vec<[f64; 12]>, Failure> {
        let mut rings = [Vec::new().into_iter(), Vec::new().into_iter()];
        for side in Side::BOTH {
            if let Some(points) = &self.rings[side.index()] {
                rings[side.index()] = points.values(shown, side)?.into_iter();
            }
        }
        let mut values = Vec::new();
        for line in &self.lines {
            let own = &mut rings[side_of(line.ring).index()];
            values.extend(own.take(line.n_points));
        }
        Ok(values)
    }
}

impl RingPoints {
    fn values(&self, shown: &Shown<'_>, side: Side) -> Result<Vec<[f64; 12]>, Failure> {
        let Some(ring) = shown.ring_at(side, self.recovery.nodes()) else {
            unreachable!("a ring with points has a field while it is shown")
        };
        let mut stress = self.recovery.stress(&ring.strained);
        if let Some(own) = &ring.own_stress {
            add(&mut stress, &self.recovery.interpolate(&own.nodal));
        }
        if let Some(near_field) = &self.near_field {
            near_field.add(&shown.patches(side).map_err(Failure::solving)?, &mut stress);
        }
        let in_raceway = stress.iter().zip(&self.axes).map(|(s, axes)| in_axes(*s, axes));
        Ok(in_raceway.map(quantities).collect())
    }
}

/// The columns of one tensor.
fn quantities(stress: [f64; 6]) -> [f64; 12] {
    let [gg, tt, dd, gt, td, gd] = stress;
    let [first, second, third] = principal(stress);
    [
        gg,
        tt,
        dd,
        gt,
        td,
        gd,
        von_mises(stress),
        first,
        second,
        third,
        0.5 * (first - third),
        (gg + tt + dd) / 3.0,
    ]
}

/// The message about the point `place` of a ring's lines.
fn outside(lines: &[&StressLine], place: usize) -> Failure {
    let mut before = 0;
    for line in lines {
        if place < before + line.n_points {
            let [azimuth, angle, depth] = line.points()[place - before];
            return Failure::User(anyhow!(
                "probes.{}.{}: the point at azimuth {:.3} deg, groove angle {:.3} deg, depth {:.4} mm is not in the \
                 mesh of the {} ring; expected a point between its raceway and its back",
                if line.n_points == 1 { "point" } else { "profile" },
                line.name,
                azimuth.to_degrees(),
                angle.to_degrees(),
                1e3 * depth,
                line.ring.key()
            ));
        }
        before += line.n_points;
    }
    unreachable!("the point is of one of the lines")
}
