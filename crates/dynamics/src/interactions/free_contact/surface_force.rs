//! What a real surface does to ball and ring over a step ([`super::rolling_surface`]).

use super::jet::{Jet, N_LENGTHS, cross, dot, fixed, minus, scaled, times, values};
use super::place::{ContactFrame, Standing, frame};
use super::ring_step::{Middle, RingStep, SlopeForce};
use super::rolling_surface::{
    BallCourse, OverSurface, RollingSurface, StripTerms, along_track, chained, turning,
};
use crate::surfaces::Strips;

/// What a real surface does over a step.
#[derive(Clone, Debug)]
pub struct SurfaceForce {
    /// The strips over which the contact rolled.
    pub strips: Strips,
    /// The force along the track; its work has that of the moment.
    pub track: SlopeForce,
    /// What of it an elastic ring has along its patch, with the opposite sign, N.
    pub of_raceway: f64,
    /// Moment on the ball in space, N m.
    pub moment: [f64; 3],
}

/// The contact on the surfaces over which it rolls from start to end.
pub(super) fn over_surface(
    surface: &RollingSurface,
    terms: StripTerms<'_>,
    ring: &RingStep,
    (start, end): (&Standing, &Standing),
    (mid, x): (&Middle, &[Jet; N_LENGTHS]),
) -> OverSurface {
    let course = surface.ball.map(|_| ball_course(ring, (start, end), (mid, x)));
    surface.over((start, end), terms, course.as_ref())
}

fn ball_course(
    ring: &RingStep,
    (start, end): (&Standing, &Standing),
    (mid, x): (&Middle, &[Jet; N_LENGTHS]),
) -> BallCourse {
    let [from, _] = ring.carrier;
    let to = ring.carrier_at_end(x).map(|x| x.value);
    let frame_at = |at: &Standing, carrier: &[f64; 5]| {
        frame(at.seen, at.reach, [3, 4].map(|dof| Jet::constant(carrier[dof])))
    };
    let meridian = |frame: &ContactFrame| {
        let axis = frame.columns[2];
        [values(cross(frame.rolling, axis)), values(axis)]
    };
    let (first, last) = (frame_at(start, &from), frame_at(end, &to));
    let meridians = [&first, &mid.frame, &last].map(meridian);
    let theta = [3, 4, 5].map(|i| x[i].value);
    let (turn, [_, axis]) = (turning(start, end), meridians[1]);
    let tilts = mid.frame.tilts.map(values);
    let relative = [0, 1, 2].map(|i| {
        let tilted = tilts[0][i] * (to[3] - from[3]) + tilts[1][i] * (to[4] - from[4]);
        theta[i] - turn * axis[i] - tilted
    });
    BallCourse {
        meridians,
        theta,
        relative,
        directions: mid.frame.directions(),
    }
}

/// Adds the force along the track and the moment on the ball to what resists the lengths.
pub(super) fn add_surface(
    ring: &RingStep,
    (mid, x): (&Middle, &[Jet; N_LENGTHS]),
    (start, end): (&Standing, &Standing),
    over: OverSurface,
    resists: &mut [Jet; N_LENGTHS],
) -> SurfaceForce {
    let track = along_track(start, end);
    let moment = fixed(over.moment);
    let about_axis = dot(moment, mid.frame.columns[2]);
    let of_raceway = chained(over.torque, end) * track.per_torque;
    let along = of_raceway - about_axis * track.per_torque;
    let force = times(along, mid.frame.rolling);
    for i in 0..3 {
        resists[i] = resists[i] - force[i];
        resists[3 + i] = resists[3 + i] - moment[i];
    }
    let turned = [3, 4, 5].map(|i| x[i].value);
    let mut work = along.value * track.way + (0..3).map(|i| over.moment[i] * turned[i]).sum::<f64>();
    if let Some(at) = ring.elastic {
        resists[8] = resists[8] + of_raceway;
        work -= of_raceway.value * (x[8].value - at.start[2]);
    } else {
        let on_ring = scaled(-1.0, force);
        let couple = minus(cross(mid.arm, on_ring), moment);
        mid.add_to_ring(on_ring, couple, resists);
        let to = ring.carrier_at_end(x);
        for (k, tilt) in mid.frame.tilts.into_iter().enumerate() {
            work -= dot(tilt, moment).value * (to[3 + k].value - ring.carrier[0][3 + k]);
        }
    }
    SurfaceForce {
        strips: over.strips,
        track: SlopeForce {
            force: along.value,
            work,
            torque: along.value * track.radius + about_axis.value,
        },
        of_raceway: of_raceway.value,
        moment: over.moment,
    }
}
