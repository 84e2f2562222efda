//! Loads on the bodies at one instant, and what is known of the bearing at it.

use body::BodyLoad;
use contact::{BearingGeometry, Meridian, Side};
use input::Schedule;
pub use ring::FrameTurn;

use crate::surfaces::Strips;
use ring::division::NodePlaces;

/// Loads on all bodies at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Loads {
    /// Generalised shaft loads: force x, y, z in N, moment x, y in N m about the shaft's origin.
    pub shaft: [f64; 5],
    /// Forces on the shaft times their distances from its origin, N m; their moments are in `shaft`.
    pub lever: [f64; 3],
    /// What the body loads of a flexible inner ring add to them, N and N m.
    pub ring_on_shaft: [f64; 5],
    /// Force along z of the body loads of a flexible outer ring, which its seat carries, N.
    pub ring_on_seat: f64,
    /// Force along z on what slides with the seat of the outer ring besides a flexible ring, N.
    pub seat: f64,
    /// Force on each ball at its just-touching position, N.
    pub balls: Vec<Meridian>,
    /// Growth of the radial force on each ball with its radial displacement, N/m.
    pub ball_slopes: Vec<f64>,
    /// Whether forces on balls or contacts depend on the contact angles.
    pub follows_angles: bool,
    /// Body loads on the nodes of a flexible ring, N, `[n_nodes][3]` flat; None: no such load.
    pub rings: [Option<Vec<f64>>; 2],
    /// What the nodes of a flexible ring weigh, besides those; None: nothing.
    pub weights: [Option<RingWeight>; 2],
    /// Force on the ring at each contact besides the normal one, N, by site (2 ball + side), acting
    /// at the groove centre; the ball gets its negative. Empty: no effect adds any.
    pub contacts: Vec<Meridian>,
    /// Turning of the rings' frames, inner first, where their inertia is called for.
    pub frames: [Option<FrameTurn>; 2],
    /// Loads of an equilibrium on all of the bodies in which the rings sit, inner first, in the frames of the rings.
    pub bodies: [Option<BodyLoad>; 2],
}

/// Weight of the nodes of a flexible ring: their masses times one acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingWeight {
    /// Mass of the ring, kg.
    pub mass: f64,
    /// Acceleration, m/s2, `[3]` in x, y, z in space.
    pub acceleration: [f64; 3],
}

impl RingWeight {
    /// The acceleration seen from a frame that is turned by an angle, rad, m/s2.
    pub fn seen_from(&self, angle: f64) -> [f64; 3] {
        seen_from(self.acceleration, angle)
    }
}

/// A vector in space seen from a frame that is turned about z by an angle, rad.
pub(crate) fn seen_from([x, y, z]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    [cos * x + sin * y, cos * y - sin * x, z]
}

impl Loads {
    /// No load on a bearing with so many balls.
    pub fn none(n_balls: usize) -> Loads {
        Loads {
            shaft: [0.0; 5],
            lever: [0.0; 3],
            ring_on_shaft: [0.0; 5],
            ring_on_seat: 0.0,
            seat: 0.0,
            ball_slopes: vec![0.0; n_balls],
            follows_angles: false,
            balls: vec![Meridian::default(); n_balls],
            rings: [None, None],
            weights: [None, None],
            contacts: Vec::new(),
            frames: [None, None],
            bodies: [None, None],
        }
    }

    /// Adds a force (N) on the shaft's axis at a distance (m) from the plane of the inner groove centres.
    pub fn add_shaft_force_at(&mut self, distance: f64, force: [f64; 3]) {
        for i in 0..3 {
            self.shaft[i] += force[i];
            self.lever[i] += distance * force[i];
        }
        // Moment of a force at distance L along the axis: L e_z x F.
        self.shaft[3] -= distance * force[1];
        self.shaft[4] += distance * force[0];
    }

    /// Adds a force (N) on the ring at one contact; the ball gets its negative.
    pub fn add_contact_force(&mut self, ball: usize, side: Side, force: Meridian) {
        self.contacts.resize(2 * self.balls.len(), Meridian::default());
        let sum = &mut self.contacts[2 * ball + side.index()];
        *sum = *sum + force;
    }

    /// Adds nodal body loads (N) to a flexible ring; shaft and housing carry the `resultant`: force x, y, z, N,
    /// and moment about x and y, N m, about the shaft's origin.
    pub fn add_ring_load(&mut self, side: Side, load: Vec<f64>, resultant: [f64; 5]) {
        self.add_carried(side, resultant);
        match &mut self.rings[side.index()] {
            Some(sum) => sum.iter_mut().zip(&load).for_each(|(s, l)| *s += l),
            none => *none = Some(load),
        }
    }

    /// Adds the weight of a flexible ring; shaft and housing carry the `resultant` as of [`Loads::add_ring_load`].
    pub fn add_ring_weight(&mut self, side: Side, weight: RingWeight, resultant: [f64; 5]) {
        self.add_carried(side, resultant);
        let sum = self.weights[side.index()].get_or_insert(RingWeight {
            acceleration: [0.0; 3],
            ..weight
        });
        (0..3).for_each(|i| sum.acceleration[i] += weight.acceleration[i]);
    }

    /// What shaft and housing carry of loads on a flexible ring.
    fn add_carried(&mut self, side: Side, resultant: [f64; 5]) {
        if side == Side::Inner {
            let sum = self.ring_on_shaft.iter_mut().zip(resultant);
            sum.for_each(|(s, f)| *s += f);
        } else {
            self.ring_on_seat += resultant[2];
        }
    }
}

/// Sum of the loads that there are, of one length; None: none.
pub(crate) fn sum_of(loads: [Option<Vec<f64>>; 3]) -> Option<Vec<f64>> {
    loads.into_iter().flatten().reduce(|mut sum, load| {
        sum.iter_mut().zip(&load).for_each(|(s, l)| *s += l);
        sum
    })
}

/// Force x, y, z, N, and moment about x and y, N m, of nodal loads on a ring (N, `[n_nodes][3]` flat), about the
/// point `origin_z` of its axis. Collective.
pub(crate) fn resultant(places: &NodePlaces, origin_z: f64, load: &[f64]) -> [f64; 5] {
    places.sum(|node, [x, y, z]| {
        let [f, arm] = [&load[3 * node..3 * node + 3], &[x, y, z - origin_z]];
        [
            f[0],
            f[1],
            f[2],
            arm[1] * f[2] - arm[2] * f[1],
            arm[2] * f[0] - arm[0] * f[2],
        ]
    })
}

/// An instant of a motion; the default is the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Now<'a> {
    /// Time, s.
    pub time: f64,
    /// Loads are means over an interval of so many seconds about the time: that of a step in time; 0 at an instant.
    pub width: f64,
    /// Angle the cage has turned since the start, rad.
    pub cage_angle: f64,
    /// Contact angles, rad, by site (2 ball + side), `[2 n_balls]`; None: not known yet, the free contact angle
    /// stands for them.
    pub angles: Option<&'a [f64]>,
    /// Forces and places of an equilibrium; None: not known yet, or over a step.
    pub seen: Option<AtEquilibrium<'a>>,
}

/// Contacts and balls as an equilibrium has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtEquilibrium<'a> {
    /// Normal forces, N, by site.
    pub forces: &'a [f64],
    /// Approaches, m, by site.
    pub approaches: &'a [f64],
    /// Strips, by site; None: it has none.
    pub strips: &'a [Option<&'a Strips>],
    /// Displacements of the balls, m.
    pub balls: &'a [Meridian],
    /// Share of the drag on balls that acts: 1, but on the way to an equilibrium.
    pub drag_share: f64,
}

impl Now<'_> {
    /// Factor of a scheduled load.
    pub fn factor(&self, schedule: &Schedule) -> f64 {
        schedule.mean(self.time, self.width)
    }

    /// Contact angle of a ball on one raceway, rad.
    pub fn contact_angle(&self, geometry: &BearingGeometry, ball: usize, side: Side) -> f64 {
        match self.angles {
            Some(angles) => angles[2 * ball + side.index()],
            None => geometry.free_contact_angle(),
        }
    }
}
