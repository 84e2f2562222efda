//! A contact of a free ball that rolls over a real surface: the contact's energy over a step, the torque along the
//! track, and the moment of a ball's own profile.
//!
//! The energy V(l; s, R) of the strips ([`crate::interactions::strip_contact`]) depends on the place s on the raceway,
//! the azimuth of the ball on the ring, psi - theta, theta the angle of the ring; and, where the ball has a profile, on
//! the orientation R in which the meridian plane of the contact sees the ball. Over a step
//!
//! ```text
//! F . (l1 - l0) = V(l1; m) - V(l0; m)                       m: s and R half-way
//! W = [V(l0; m) - V(l0; 0)] + [V(l1; 1) - V(l1; m)]         what the surfaces give to the contact as they move on
//! T (s_1 - s_0) = -W                                        of the raceway
//! M = -G - (W - G . phi) phi / |phi|^2                      of the ball
//! ```
//!
//! F is the force of kinematic balls, on the surfaces of the step's middle. T is the torque about the axis of the ring
//! with which the slope of the raceway turns the ball: what the surface gives, a free ball and the drive of the ring
//! lose, exactly. M is the moment of the ball's profile about its centre: phi is the ball's turning less that of the
//! meridian plane, and G = dV/dphi in the middle (Gonzalez, J. Nonlinear Sci. 6 (1996) 449), so that M . phi = -W
//! exactly. All are symmetric in time: the scheme is of second order. Where both have profiles, W is divided as the
//! mean of both orders.
//!
//! **Forces.** The pressure of a spherical ball has no moment about its centre, so that T is a force f on the ball
//! along e_t, the direction of rolling in the middle of the step, through its centre. The ring has -f there. With r_0,
//! r_1 the distances from the axis, and the ball's turning D about it in the ring's frame, f does the work T D:
//!
//! ```text
//! f = T |b'_0 + b'_1| / (2 r_0 r_1 sin(D)/D)
//! ```
//!
//! A raceway without a profile has no torque about its axis. So M comes with the force of the torque -M . e_z on the
//! ball; the ring has the couple -M and the opposite force.
//!
//! Where a contact hardly moves on its surface the quotient for T is the derivative. G is a central difference.
//!
//! Newton's tangent takes F and T as they grow with l at the end, and leaves out how they grow with the place: K w'^2
//! h^2/(2 m), below 1e-2 at the edge of a spall in steps of 10 us, K the stiffness of the contact and w' the slope.
//! With these terms Newton needs as many iterations. M is left out as a whole.
//!
//! Cost: about three times that of a smooth contact, a tenth of its traction; twenty times under a worn ball.

use contact::{Meridian, SeenMeridian};

use super::jet::Jet;
use super::orientation::{Quaternion, in_ball, turned};
use super::place::Standing;
use crate::interactions::contact_damping::StepDamping;
use crate::interactions::discrete_gradient::{ContactScheme, MeanForce};
use crate::interactions::strip_contact::{StripSite, force_on_ring};
use crate::surfaces::{Strips, SurfacePlace};

/// Change of place, rad, below which the torque is a derivative: 0.05 nm of the track.
const LEAST_CHANGE: f64 = 1e-9;
/// Half of the difference for that derivative, rad.
const DIFFERENCE: f64 = 1e-6;
/// Half of the difference for the gradient over turns of a ball, rad: 2 um on a ball of 9 mm.
const TURN: f64 = 5e-4;

/// The surfaces under a contact over a step.
#[derive(Clone, Debug, PartialEq)]
pub struct RollingSurface {
    /// Raceway and ball.
    pub strips: Strips,
    /// Angle of the ring at the start, rad.
    pub ring_angle: f64,
    /// Angle by which the ring turns, rad.
    pub ring_turn: f64,
    /// A ball with a profile.
    pub ball: Option<WornBall>,
}

/// A ball with a profile at the start of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WornBall {
    /// Its orientation.
    pub orientation: Quaternion,
    /// Contact angle, rad.
    pub angle: f64,
}

/// How a ball with a profile and its ring turn over a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct BallCourse {
    /// Directions e_r and e_z of the ring at the ball in space: start, middle, end.
    pub meridians: [[[f64; 3]; 2]; 3],
    /// Rotation vector of the ball, rad.
    pub theta: [f64; 3],
    /// The same less that of the meridian plane.
    pub relative: [f64; 3],
    /// Directions t, q, n of the middle.
    pub directions: [[f64; 3]; 3],
}

/// A contact on the surfaces over which it rolled.
#[derive(Clone, Debug)]
pub(super) struct OverSurface {
    /// Its strips in the middle, at the start and at the end of the step.
    pub strips: Strips,
    /// Force on the ring.
    pub normal: MeanForce,
    /// Torque T of the raceway, N m, and its growth with l at the end, N.
    pub torque: (f64, Meridian),
    /// Moment M on the ball in space, N m.
    pub moment: [f64; 3],
}

/// What a contact takes besides its surfaces.
#[derive(Clone, Copy)]
pub(super) struct StripTerms<'c> {
    /// What patch and ball yield besides, m/N.
    pub compliance: f64,
    /// |l| at which a smooth groove touches, m.
    pub touching: f64,
    /// Sign of the raceway's side.
    pub sign: f64,
    /// How forces are evaluated.
    pub scheme: ContactScheme,
    /// Damping along the normal.
    pub damping: Option<StepDamping<'c>>,
}

/// A contact over a step, with where it stands on the surfaces at the start, half-way and at the end.
struct Passage<'s> {
    strips: &'s Strips,
    terms: StripTerms<'s>,
    l: [Meridian; 2],
    places: [SurfacePlace; 3],
}

impl RollingSurface {
    /// The contact over a step, from where it stands at the start to where it stands at the end.
    pub(super) fn over(
        &self,
        (start, end): (&Standing, &Standing),
        terms: StripTerms<'_>,
        course: Option<&BallCourse>,
    ) -> OverSurface {
        let from = start.seen[1].value.atan2(start.seen[0].value) - self.ring_angle;
        let change = turning(start, end) - self.ring_turn;
        let worn = self.ball.as_ref().zip(course);
        let places = [0, 1, 2].map(|k| {
            let share = 0.5 * k as f64;
            SurfacePlace {
                azimuth: from + share * change,
                rolled: 0.0,
                seen: worn.map(|(ball, course)| {
                    let q = turned(ball.orientation, course.theta.map(|x| share * x));
                    seen(q, course.meridians[k], ball.angle)
                }),
            }
        });
        let strips = self.strips.moved(places[1]).between([places[0], places[2]]);
        let l = [start.reach, end.reach].map(|l| Meridian::from(l.map(|x| x.value)));
        let passage = Passage {
            strips: &strips,
            terms,
            l,
            places,
        };
        let normal = passage
            .site(&strips)
            .mean_force(l, (terms.scheme, 0.5), terms.damping);
        let (torque, moment) = match worn {
            Some((ball, course)) => {
                let works = passage.works();
                let torque = if change.abs() > LEAST_CHANGE {
                    -works.of_raceway / change
                } else {
                    passage.slope()
                };
                (
                    (torque, Meridian::default()),
                    passage.moment(ball, course, works.of_ball),
                )
            }
            None => (passage.torque(change), [0.0; 3]),
        };
        OverSurface {
            strips,
            normal,
            torque,
            moment,
        }
    }
}

/// What surfaces give to a contact as they move on, J.
struct SurfaceWorks {
    of_raceway: f64,
    of_ball: f64,
}

/// A force along the direction of rolling over a step.
pub(super) struct AlongTrack {
    /// That which does the work of a torque about the axis of the ring, per torque, 1/m.
    pub per_torque: f64,
    /// The ball's way along it, m.
    pub way: f64,
    /// The ball's distance from the axis in the middle, m.
    pub radius: f64,
}

impl Passage<'_> {
    fn site<'s>(&self, strips: &'s Strips) -> StripSite<'s> {
        StripSite {
            strips,
            compliance: self.terms.compliance,
            touching: self.terms.touching,
            sign: self.terms.sign,
        }
    }

    /// Mean of the energies with the lengths of start and end, at a place, J.
    fn mean_energy(&self, place: SurfacePlace) -> f64 {
        let strips = self.strips.moved(place);
        let site = self.site(&strips);
        0.5 * (site.at(self.l[0]).energy + site.at(self.l[1]).energy)
    }

    /// Energy with the length of the start, 0, or the end, 1, at a place, J.
    fn energy(&self, end: usize, place: SurfacePlace) -> f64 {
        self.site(&self.strips.moved(place)).at(self.l[end]).energy
    }

    /// Torque of the raceway over a step in which the contact moves on by `change`, rad, and its growth with l at the
    /// end.
    fn torque(&self, change: f64) -> (f64, Meridian) {
        if change.abs() <= LEAST_CHANGE {
            return (self.slope(), Meridian::default());
        }
        let (site, l) = (self.site(self.strips), self.l);
        let ends = [0, 1].map(|end| site.at_end(end, l[end]));
        let middle = l.map(|l| site.at(l));
        let work = [
            middle[0].energy - ends[0].energy,
            ends[1].energy - middle[1].energy,
        ];
        let [on_middle, on_last] = [&middle[1], &ends[1]].map(|at| force_on_ring(at, l[1]));
        let growth = (on_last - on_middle).map(|force| -force / change);
        (-(work[0] + work[1]) / change, growth)
    }

    /// Torque of the raceway where the contact hardly moves on, N m.
    fn slope(&self) -> f64 {
        let middle = self.places[1];
        let moved = |by: f64| {
            self.mean_energy(SurfacePlace {
                azimuth: middle.azimuth + by,
                ..middle
            })
        };
        -(moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE)
    }

    /// What raceway and ball give to the contact as they move on, J.
    fn works(&self) -> SurfaceWorks {
        let site = self.site(self.strips);
        let l = self.l;
        let whole = site.at(l[0]).energy - site.at_end(0, l[0]).energy + site.at_end(1, l[1]).energy
            - site.at(l[1]).energy;
        if !self.strips.surface.has_profile() {
            return SurfaceWorks {
                of_raceway: 0.0,
                of_ball: whole,
            };
        }
        // Where the raceway is at one place and the ball in the orientation of another.
        let mixed = |end: usize, raceway: usize, ball: usize| {
            let place = SurfacePlace {
                azimuth: self.places[raceway].azimuth,
                ..self.places[ball]
            };
            self.energy(end, place)
        };
        let half = |end: usize, from: usize, to: usize| {
            let by = |ball: usize| mixed(end, to, ball) - mixed(end, from, ball);
            0.5 * (by(from) + by(to))
        };
        let of_raceway = half(0, 0, 1) + half(1, 1, 2);
        SurfaceWorks {
            of_raceway,
            of_ball: whole - of_raceway,
        }
    }

    /// Moment on the ball in space, N m, whose profile gives `work`, J, to the contact.
    fn moment(&self, ball: &WornBall, course: &BallCourse, work: f64) -> [f64; 3] {
        let half = turned(ball.orientation, course.theta.map(|x| 0.5 * x));
        let energy = |about: [f64; 3], by: f64| {
            let q = turned(half, about.map(|x| by * x));
            self.mean_energy(SurfacePlace {
                seen: Some(seen(q, course.meridians[1], ball.angle)),
                ..self.places[1]
            })
        };
        let slope = |about: [f64; 3]| (energy(about, TURN) - energy(about, -TURN)) / (2.0 * TURN);
        let slopes = course.directions.map(slope);
        let gradient = [0, 1, 2].map(|i| (0..3).map(|k| slopes[k] * course.directions[k][i]).sum::<f64>());
        let phi = course.relative;
        let square = product(phi, phi);
        let share = if square > LEAST_CHANGE * LEAST_CHANGE {
            (work - product(gradient, phi)) / square
        } else {
            0.0
        };
        [0, 1, 2].map(|i| -(gradient[i] + share * phi[i]))
    }
}

fn seen(q: Quaternion, [out, axial]: [[f64; 3]; 2], angle: f64) -> SeenMeridian {
    SeenMeridian {
        out: in_ball(q, out),
        axial: in_ball(q, axial),
        angle,
    }
}

fn product(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Angle by which a ball turns round the axis of its ring over a step, rad.
pub(super) fn turning(start: &Standing, end: &Standing) -> f64 {
    let [[x0, y0, _], [x1, y1, _]] = [start, end].map(|at| at.seen.map(|x| x.value));
    (x0 * y1 - y0 * x1).atan2(x0 * x1 + y0 * y1)
}

/// A force along the direction of rolling over a step.
pub(super) fn along_track(start: &Standing, end: &Standing) -> AlongTrack {
    let [[x0, y0, _], [x1, y1, _]] = [start, end].map(|at| at.seen.map(|x| x.value));
    let sum = (x0 + x1).hypot(y0 + y1);
    let way = 2.0 * (x0 * y1 - y0 * x1) / sum;
    let turned = turning(start, end);
    let sinc = if turned.abs() > 1e-4 {
        turned.sin() / turned
    } else {
        1.0 - turned * turned / 6.0
    };
    let radii = x0.hypot(y0) * x1.hypot(y1);
    AlongTrack {
        per_torque: sum / (2.0 * radii * sinc),
        way,
        radius: 0.5 * sum,
    }
}

/// A torque as it grows with l at the end.
pub(super) fn chained((value, growth): (f64, Meridian), end: &Standing) -> Jet {
    let jet = end.reach[0] * growth.radial + end.reach[1] * growth.axial;
    Jet { value, ..jet }
}
