//! One end of a cage on its land over a step.
//!
//! Lengths of the link: displacement (3), tilts (2) and turn (1) of the cage since the start, then displacement of what
//! carries the ring (3 + 2), and one that is not used. The eccentricity is linear in them, so that the work of the
//! normal force is exact.

use contact::Side;

use super::super::free_contact::RingStep;
use super::super::free_contact::jet::{Jet, N_LENGTHS, Vector, cross, dot, fixed, minus, plus, times};
use super::impact::Impact;
use super::{CageContact, CageForce, Land, Rubbing, press};

/// One end of a cage on its land over a step.
#[derive(Clone, Debug)]
pub struct LandStep {
    /// Step size, s.
    pub dt: f64,
    /// The cage at the start: place, tilts, turn; then their rates.
    pub cage: [[f64; 6]; 2],
    /// The land's ring.
    pub ring: RingStep,
    /// The land.
    pub land: Land,
    /// Axial distances of the end from the centre of the cage and from the origin of what carries the ring, m.
    pub heights: [f64; 2],
    /// Force law.
    pub impact: Impact,
    /// Friction.
    pub rubbing: Rubbing,
}

/// Velocities of cage and ring: translation and turning.
struct Rates {
    cage: [Vector; 2],
    ring: [Vector; 2],
}

impl CageContact for LandStep {
    fn closing_speed(&self) -> f64 {
        let ([x, y], [u, v]) = (
            self.eccentricity(0, self.ring.carrier[0]),
            self.eccentricity(1, self.ring.carrier[1]),
        );
        let size = x.hypot(y);
        if size == 0.0 { 0.0 } else { (x * u + y * v) / size }
    }

    fn overlap_at_start(&self) -> f64 {
        let [x, y] = self.eccentricity(0, self.ring.carrier[0]);
        x.hypot(y) - self.touching()
    }

    fn evaluate(&self, end: [f64; N_LENGTHS], resists: &mut [Jet; N_LENGTHS]) -> CageForce {
        let x: [Jet; N_LENGTHS] = std::array::from_fn(|i| Jet::length(i, end[i]));
        let turn = x[5] * (1.0 / self.dt) + -self.ring.spin[0];
        resists[5] = resists[5] + turn * (0.5 * self.land.drag());
        let (start, last) = (self.eccentricity(0, self.ring.carrier[0]), self.at_end(&x));
        let Some((load, mut found)) = press(&self.impact, self.touching(), (start, last), self.dt) else {
            return CageForce::default();
        };
        let [h, height] = self.heights;
        add_load(load, (0, 1.0, h), resists);
        if self.land_moves() {
            add_load(load, (6, -1.0, height), resists);
        }
        if self.rubbing.acts(&found) {
            self.add_friction((start, last), load, &x, resists, &mut found);
        }
        found
    }

    fn sizes(&self) -> (f64, f64) {
        (self.dt, self.land.radius)
    }

    fn impact(&self) -> &Impact {
        &self.impact
    }

    fn impact_mut(&mut self) -> &mut Impact {
        &mut self.impact
    }
}

impl LandStep {
    /// Energy lost to the drag of this end over the step, J, and its torque on the cage, N m.
    pub fn drag(&self, end: [f64; N_LENGTHS]) -> [f64; 2] {
        let slip = end[5] / self.dt - self.ring.spin[0];
        let torque = 0.5 * self.land.drag() * slip;
        [torque * slip * self.dt, -torque]
    }

    fn touching(&self) -> f64 {
        0.5 * self.land.clearance
    }

    fn land_moves(&self) -> bool {
        self.land.side == Side::Inner
    }

    /// Eccentricity, m, at the start (0), or its rate, m/s (1).
    fn eccentricity(&self, which: usize, ring: [f64; 5]) -> [f64; 2] {
        let (cage, [h, height]) = (self.cage[which], self.heights);
        [
            cage[0] + h * cage[4] - ring[0] - height * ring[4],
            cage[1] - h * cage[3] - ring[1] + height * ring[3],
        ]
    }

    /// Eccentricity at the end. The lengths of the ring are those of its carrier, which are no increments.
    fn at_end(&self, x: &[Jet; N_LENGTHS]) -> [Jet; 2] {
        let (cage, [h, height]) = (self.cage[0], self.heights);
        let ring: [Jet; 5] = self.carrier_at_end(x);
        [
            x[0] + cage[0] + (x[4] + cage[4]) * h - ring[0] - ring[4] * height,
            x[1] + cage[1] - (x[3] + cage[3]) * h - ring[1] + ring[3] * height,
        ]
    }

    fn carrier_at_end(&self, x: &[Jet; N_LENGTHS]) -> [Jet; 5] {
        match self.land_moves() {
            true => std::array::from_fn(|i| x[6 + i]),
            false => [Jet::default(); 5],
        }
    }

    /// Friction on cage and ring under a normal force.
    fn add_friction(
        &self,
        (start, last): ([f64; 2], [Jet; 2]),
        load: [Jet; 2],
        x: &[Jet; N_LENGTHS],
        resists: &mut [Jet; N_LENGTHS],
        found: &mut CageForce,
    ) {
        let middle = self.frame([0, 1].map(|i| last[i] + start[i]));
        let at_middle = middle.slip(&self.mean_rates(x));
        let at_end = || self.frame(last).slip(&self.last_rates(x));
        let f = self.rubbing.rub(load, (at_middle, at_end), self.dt, found);
        let force = plus(times(f[0], middle.round), [Jet::default(), Jet::default(), f[1]]);
        let about = middle.arms.map(|arm| cross(arm, force));
        found.torque = about[0][2].value;
        for i in 0..3 {
            resists[i] = resists[i] - force[i];
            resists[3 + i] = resists[3 + i] - about[0][i];
        }
        if self.land_moves() {
            for i in 0..3 {
                resists[6 + i] = resists[6 + i] + force[i];
            }
            for i in 0..2 {
                resists[9 + i] = resists[9 + i] + about[1][i];
            }
        }
    }

    fn frame(&self, reach: [Jet; 2]) -> LandFrame {
        let short = (reach[0] * reach[0] + reach[1] * reach[1]).sqrt().recip();
        let [n_x, n_y] = reach.map(|l| l * short);
        // The cage's outside meets the outer ring where it is eccentric to, its bore the inner ring opposite of it.
        let lever = self.land.side.sign() * self.land.radius;
        LandFrame {
            arms: self.heights.map(|h| [n_x * lever, n_y * lever, Jet::constant(h)]),
            round: [-n_y, n_x, Jet::default()],
        }
    }

    fn mean_rates(&self, x: &[Jet; N_LENGTHS]) -> Rates {
        let mean = |first: usize| [0, 1, 2].map(|i| x[first + i] * (1.0 / self.dt));
        let (carrier, from) = (self.carrier_at_end(x), self.ring.carrier[0]);
        let ring = [0, 1, 2, 3, 4].map(|i| match self.land_moves() {
            true => (carrier[i] + -from[i]) * (1.0 / self.dt),
            false => Jet::default(),
        });
        Rates {
            cage: [mean(0), mean(3)],
            ring: turning_ring(ring, self.ring.spin[0]),
        }
    }

    fn last_rates(&self, x: &[Jet; N_LENGTHS]) -> Rates {
        let [_, rate] = self.cage;
        let last = |first: usize| [0, 1, 2].map(|i| x[first + i] * (2.0 / self.dt) + -rate[first + i]);
        let (carrier, [from, velocity]) = (self.carrier_at_end(x), self.ring.carrier);
        let ring = [0, 1, 2, 3, 4].map(|i| {
            let change = carrier[i] + -from[i];
            match (self.land_moves(), self.ring.has_inertia[i]) {
                (false, _) => Jet::default(),
                (true, true) => change * (2.0 / self.dt) + -velocity[i],
                (true, false) => change * (1.0 / self.dt),
            }
        });
        Rates {
            cage: [last(0), last(3)],
            ring: turning_ring(ring, self.ring.spin[1]),
        }
    }
}

/// Adds a load in x and y at a height above the origin of a body, whose lengths begin at `first`.
fn add_load(load: [Jet; 2], (first, sign, height): (usize, f64, f64), resists: &mut [Jet; N_LENGTHS]) {
    for i in 0..2 {
        resists[first + i] = resists[first + i] + load[i] * sign;
    }
    resists[first + 3] = resists[first + 3] - load[1] * (sign * height);
    resists[first + 4] = resists[first + 4] + load[0] * (sign * height);
}

fn turning_ring(rates: [Jet; 5], spin: f64) -> [Vector; 2] {
    let [x, y, z, tilt_x, tilt_y] = rates;
    [[x, y, z], [tilt_x, tilt_y, Jet::constant(spin)]]
}

/// Where cage and land meet at one instant.
struct LandFrame {
    /// From the centre of the cage, and from the origin of the ring's carrier.
    arms: [Vector; 2],
    /// Round the land.
    round: Vector,
}

impl LandFrame {
    /// Slip of the cage on the ring, round the land and along the axis.
    fn slip(&self, rates: &Rates) -> [Jet; 2] {
        let at = |[v, w]: [Vector; 2], arm: Vector| plus(v, cross(w, arm));
        let slip = minus(at(rates.cage, self.arms[0]), at(rates.ring, self.arms[1]));
        [dot(slip, self.round), dot(slip, fixed([0.0, 0.0, 1.0]))]
    }
}
