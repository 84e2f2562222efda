//! A mode: its frequency, how well it is known, and its shape.

use contact::Side;

use super::system::VibratingBearing;

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
    /// Share of a body round the outer ring, which the share of that ring holds; 0 without one.
    pub kinetic_body: f64,
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
    /// The same of an elastic body round the outer ring.
    pub body: Option<Vec<f64>>,
    /// Balls [radial, axial]; empty for a ring alone.
    pub balls: Vec<[f64; 2]>,
    /// Shaft x, y, z, tilt x, tilt y.
    pub shaft: [f64; 5],
}

impl Mode {
    /// The mode of an eigenvector with x^T M x = 1; `[value, bound]` are omega^2 and its largest error, 1/s^2.
    pub(super) fn new(
        system: &VibratingBearing,
        x: &[f64],
        [value, bound]: [f64; 2],
        residual: f64,
        is_rigid: bool,
    ) -> Mode {
        let mut shape = Shape::new(system, x);
        let largest = shape.largest(system.dofs.tilt_arm);
        shape.scale(1.0 / largest);
        let frequency = |value: f64| value.max(0.0).sqrt() / std::f64::consts::TAU;
        let kinetic = system.kinetic(x);
        let total: f64 = kinetic.iter().sum();
        // Round-off may leave a rigid motion below zero.
        let value = value.abs();
        let outer = system.rings[1].as_ref();
        let of_body = outer.map_or(0.0, |ring| ring.body_mass(system.part(x, 1)));
        let middle = frequency(value);
        Mode {
            frequency: middle,
            bound: (frequency(value + bound) - middle).max(middle - frequency(value - bound)),
            residual,
            is_rigid,
            modal_mass: largest.powi(-2),
            kinetic: kinetic.map(|part| part / total),
            kinetic_body: of_body / total,
            shape,
        }
    }
}

impl Shape {
    fn new(system: &VibratingBearing, x: &[f64]) -> Shape {
        let small = system.part(x, 2);
        let n_balls = system.dofs.n_balls;
        let mut shaft = [0.0; 5];
        if let Some(ring) = &system.rings[Side::Inner.index()] {
            shaft = ring.partner_motion(system.part(x, 0));
        }
        for &(dof, place) in &system.dofs.shaft {
            shaft[dof] = small[place];
        }
        Shape {
            rings: [0, 1].map(|i| {
                let ring = system.rings[i].as_ref()?;
                Some(ring.displacement(system.part(x, i)))
            }),
            body: system.rings[1]
                .as_ref()
                .and_then(|ring| ring.body_displacement(system.part(x, 1))),
            balls: (0..n_balls).map(|b| [small[2 * b], small[2 * b + 1]]).collect(),
            shaft,
        }
    }

    /// The displacement of largest size, with the sign of its largest component.
    fn largest(&self, tilt_arm: f64) -> f64 {
        let [x, y, z, tilt_x, tilt_y] = self.shaft;
        let tilts = [tilt_arm * tilt_x, tilt_arm * tilt_y];
        let fields = self.rings.iter().chain([&self.body]).flatten();
        let nodes = fields.flat_map(|u| u.chunks_exact(3));
        let balls = self.balls.iter().map(|b| b.as_slice());
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

    fn scale(&mut self, factor: f64) {
        let rings = self.rings.iter_mut().chain([&mut self.body]);
        let values = rings
            .flatten()
            .flatten()
            .chain(self.balls.iter_mut().flatten())
            .chain(&mut self.shaft);
        values.for_each(|x| *x *= factor);
    }
}
