//! A mode: its frequency, how well it is known, and its shape.

use contact::{BySide, Meridian};
use ring::sparse::{SparseLoad, sparse_dot};
use ring::vectors::dot;
use ring::{VibratingRing, VibratingRings};

use super::system::VibratingSystem;

/// Share of the largest component that counts as just as large, so that round-off does not choose the sign of a shape.
const AS_LARGE: f64 = 1.0 - 1e-6;

/// A natural mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Natural frequency, Hz; of a rigid motion what round-off leaves.
    pub frequency: f64,
    /// Largest possible error of the frequency, Hz.
    pub bound: f64,
    /// |K x - omega^2 M x| / |(K + s M) x|, without the forces of constraints.
    pub residual: f64,
    /// Whether it is a motion at zero frequency.
    pub is_rigid: bool,
    /// Mass that growth, kg, when the largest displacement is the coordinate: twice the kinetic energy over the square
    /// of its velocity.
    pub modal_mass: f64,
    /// Shares of the kinetic energy: inner ring, outer ring, balls, shaft.
    pub kinetic: [f64; 4],
    /// Shares of the bodies to which the rings are tied, inner first, held by the shares of the rings; 0 without one.
    pub kinetic_bodies: BySide<f64>,
    /// Displacements, scaled so that the largest is 1.
    pub shape: Shape,
}

/// Displacements of all bodies in a mode, dimensionless: the largest is 1, its largest component positive. Tilts are
/// per m.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Nodal displacement of the rings in their own coordinates, `[n_nodes][3]` flat; None for rings that are rigid
    /// or not part of the body.
    pub rings: [Option<Vec<f64>>; 2],
    /// The same of the elastic bodies to which they are tied, inner first, that of several rings with its first seat.
    pub bodies: [Option<Vec<f64>>; 2],
    /// Balls; empty for a ring alone.
    pub balls: Vec<Meridian>,
    /// Shaft x, y, z, tilt x, tilt y.
    pub shaft: [f64; 5],
}

/// An eigenpair, with x^T M x = 1.
#[derive(Clone, Copy)]
pub(super) struct FoundPair<'p> {
    pub x: &'p [f64],
    /// omega^2, 1/s^2.
    pub value: f64,
    /// Its largest error.
    pub bound: f64,
    pub residual: f64,
    pub is_rigid: bool,
}

/// Whether a displacement is larger than another by more than round-off.
pub(super) fn is_larger(size: f64, than: f64) -> bool {
    AS_LARGE * size.abs() > than.abs()
}

/// Where an elastic ring is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RingPlace {
    /// Number of its group.
    pub group: usize,
    /// Its number there.
    pub ring: usize,
}

/// Where a bearing is among the unknowns.
#[derive(Clone, Debug, Default)]
pub(super) struct BearingDofs {
    /// Its elastic rings, inner first.
    pub rings: [Option<RingPlace>; 2],
    /// First small dof of its balls, [radial, axial] each.
    pub first_ball: usize,
    /// Number of balls.
    pub n_balls: usize,
    /// Motion x, y, z, tilt x, tilt y of the shaft by small dofs; empty where an elastic inner ring has it.
    pub shaft: [SparseLoad; 5],
    /// Small dof of the seat of a rigid outer ring that slides.
    pub seat: Option<usize>,
    /// Radius at which tilts count as displacements, m.
    pub tilt_arm: f64,
}

/// Twice the kinetic energy of a bearing at unit angular frequency.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Kinetic {
    /// Inner ring, outer ring, balls, shaft.
    pub parts: [f64; 4],
    /// Of the bodies to which its rings are tied, which the parts of the rings hold.
    pub bodies: BySide<f64>,
}

impl BearingDofs {
    /// Its elastic rings with the numbers of their groups.
    pub fn in_groups<'g>(&self, groups: &'g [VibratingRings]) -> [Option<(usize, &'g VibratingRing)>; 2] {
        self.rings
            .map(|place| place.map(|RingPlace { group, ring }| (group, &groups[group].rings()[ring])))
    }

    /// Its kinetic energy, with that of a shaft that no one else has.
    pub fn kinetic(&self, system: &VibratingSystem, y: &[f64]) -> Kinetic {
        let mut sum = Kinetic::default();
        for (i, place) in self.rings.iter().enumerate() {
            let Some(RingPlace { group, ring: number }) = *place else {
                continue;
            };
            let (group, own) = (&system.groups[group], system.part(y, group));
            let ring = &group.rings()[number];
            if number == 0 {
                sum.bodies[i] = group.body_mass(own);
            }
            sum.parts[i] = match group.rings() {
                [_] => dot(own, &group.mass(own, 1)),
                _ => ring.mass_of(own) + sum.bodies[i],
            };
            for (load, mass) in ring.lumps() {
                // The shaft carries the inner ring; what slides with the outer one counts as that ring.
                sum.parts[if i == 0 { 3 } else { 1 }] += mass * sparse_dot(load, own).powi(2);
            }
        }
        let (small, last) = (system.small_part(y), self.first_ball + 2 * self.n_balls);
        for &(i, k, mass) in &system.small.mass {
            let owner = match i {
                _ if (self.first_ball..last).contains(&i) => 2,
                _ if Some(i) == self.seat => 1,
                _ if i >= last && self.has_shaft(i) => 3,
                _ => continue,
            };
            sum.parts[owner] += mass * small[i] * small[k];
        }
        sum
    }

    /// Whether the shaft moves with a small dof: its own where it comes after the balls.
    fn has_shaft(&self, small: usize) -> bool {
        self.shaft.iter().any(|motion| *motion == [(small, 1.0)])
    }
}

impl Mode {
    /// The mode of a bearing alone.
    pub(super) fn new(system: &VibratingSystem, dofs: &BearingDofs, pair: FoundPair<'_>) -> Mode {
        let mut shape = Shape::new(system, dofs, pair.x);
        let largest = shape.largest(dofs.tilt_arm);
        shape.scale(1.0 / largest);
        let kinetic = dofs.kinetic(system, pair.x);
        let total: f64 = kinetic.parts.iter().sum();
        Mode::of_parts(pair, kinetic, (total, largest), shape)
    }

    /// A mode with the kinetic energies of its parts among a total, and a shape that was scaled by a largest one.
    pub(super) fn of_parts(
        pair: FoundPair<'_>,
        kinetic: Kinetic,
        (total, largest): (f64, f64),
        shape: Shape,
    ) -> Mode {
        let frequency = |value: f64| value.max(0.0).sqrt() / std::f64::consts::TAU;
        // Round-off may leave a rigid motion below zero.
        let (value, bound) = (pair.value.abs(), pair.bound);
        let middle = frequency(value);
        Mode {
            frequency: middle,
            bound: (frequency(value + bound) - middle).max(middle - frequency(value - bound)),
            residual: pair.residual,
            is_rigid: pair.is_rigid,
            modal_mass: largest.powi(-2),
            kinetic: kinetic.parts.map(|part| part / total),
            kinetic_bodies: kinetic.bodies.map(|part| part / total),
            shape,
        }
    }
}

impl Shape {
    pub(super) fn new(system: &VibratingSystem, dofs: &BearingDofs, x: &[f64]) -> Shape {
        let small = system.small_part(x);
        let rings = dofs.in_groups(&system.groups);
        let mut shaft = [0.0; 5];
        if let Some((group, ring)) = rings[0] {
            shaft = ring.partner_motion(system.part(x, group));
        }
        for (value, motion) in shaft.iter_mut().zip(&dofs.shaft) {
            if !motion.is_empty() {
                *value = sparse_dot(motion, small);
            }
        }
        let ball = |b: usize| {
            let first = dofs.first_ball + 2 * b;
            Meridian::new(small[first], small[first + 1])
        };
        Shape {
            rings: rings.map(|place| place.map(|(group, ring)| ring.displacement(system.part(x, group)))),
            bodies: dofs.rings.map(|place| {
                let RingPlace { group, .. } = place.filter(|place| place.ring == 0)?;
                system.groups[group].body_displacement(system.part(x, group))
            }),
            balls: (0..dofs.n_balls).map(ball).collect(),
            shaft,
        }
    }

    /// The displacement of largest size, with the sign of its largest component.
    pub(super) fn largest(&self, tilt_arm: f64) -> f64 {
        let [x, y, z, tilt_x, tilt_y] = self.shaft;
        let tilts = [tilt_arm * tilt_x, tilt_arm * tilt_y];
        let fields = self.rings.iter().chain(self.bodies.iter().rev()).flatten();
        let nodes = fields.flat_map(|u| u.chunks_exact(3));
        let balls = Meridian::flat(&self.balls);
        let balls = balls.chunks_exact(2);
        let shaft = [[x, y, z].to_vec(), tilts.to_vec()];
        let points = || {
            let shaft = shaft.iter().map(Vec::as_slice);
            nodes.clone().chain(balls.clone()).chain(shaft)
        };
        let size = |u: &[f64]| u.iter().map(|x| x * x).sum::<f64>().sqrt();
        let most = points().map(size).fold(0.0, f64::max);
        let first = points().find(|u| size(u) >= AS_LARGE * most).unwrap_or(&[1.0]);
        let component = first.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let leading = first.iter().find(|x| x.abs() >= AS_LARGE * component);
        most * leading.map_or(1.0, |x| x.signum())
    }

    pub(super) fn scale(&mut self, factor: f64) {
        let rings = self.rings.iter_mut().chain(&mut self.bodies);
        let values = rings.flatten().flatten().chain(&mut self.shaft);
        values.for_each(|x| *x *= factor);
        for ball in &mut self.balls {
            *ball = ball.map(|x| x * factor);
        }
    }
}
