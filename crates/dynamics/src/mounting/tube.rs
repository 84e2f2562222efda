//! Thick tubes under pressure and turning, in plane stress: partners of seats, and rigid rings as seats see them.
//!
//! ```text
//! pressure p on the seat:  u(r) = p a^2 / (E (b^2 - a^2)) [(1 - nu) r + (1 + nu) b^2 / r]
//! turning at omega:        u(a) = rho omega^2 a / (4 E) [(3 + nu) b^2 + (1 - nu) a^2]
//! ```
//!
//! a is the radius of the seat, b that of the other surface, larger or smaller; displacements are positive outwards.
//! Validity: ends are free, and the pressure is uniform; a solid shaft has b = 0. Source: Timoshenko and
//! Goodier, Theory of Elasticity, 3rd ed. 1970, art. 28 (Lame) and 32 (rotating discs).

use fem::Material;

/// A thick tube with a seat on one of its surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tube {
    /// Radius of the seat, m.
    pub seat: f64,
    /// Radius of the other surface, m; 0 is solid. The seat is the bore if this is the larger one.
    pub other: f64,
    /// What it is made of.
    pub material: Material,
}

impl Tube {
    /// Motion of the seat away from a pressure on it, m/Pa.
    pub fn give(&self) -> f64 {
        self.pressed(self.seat).abs()
    }

    /// Displacement of the other surface per pressure on the seat, m/Pa.
    pub fn growth(&self) -> f64 {
        self.pressed(self.other)
    }

    /// Displacement at a radius per pressure on the seat, m/Pa.
    pub fn pressed(&self, r: f64) -> f64 {
        let (seat, other) = (self.seat.powi(2), self.other.powi(2));
        let nu = self.material.poisson_ratio;
        let shape = (1.0 - nu) * r + (1.0 + nu) * other / r;
        seat / (other - seat) * shape / self.material.young_modulus
    }

    /// Displacement of the seat per square of the speed, m s^2.
    pub fn spun(&self) -> f64 {
        let (seat, other) = (self.seat.powi(2), self.other.powi(2));
        let Material {
            young_modulus,
            poisson_ratio,
            density,
        } = self.material;
        let shape = (3.0 + poisson_ratio) * other + (1.0 - poisson_ratio) * seat;
        density / (4.0 * young_modulus) * self.seat * shape
    }

    /// Largest difference of principal stresses per pressure inside or outside, at the inner surface, dimensionless:
    /// what Tresca's criterion compares with the yield strength.
    pub fn tresca(&self) -> f64 {
        let [a, b] = [self.seat.min(self.other), self.seat.max(self.other)].map(|r| r * r);
        2.0 * b / (b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tube(seat: f64, other: f64) -> Tube {
        let material = Material::new(207e9, 0.3, 7800.0).unwrap();
        Tube {
            seat,
            other,
            material,
        }
    }

    /// Wrong: the give of shaft or housing would not be that of a thick tube, or that of a solid shaft.
    #[test]
    fn the_give_of_partners_is_that_of_thick_tubes() {
        let (d, hole, nu, e) = (50e-3f64, 20e-3f64, 0.3, 207e9);
        let give = d / (2.0 * e) * ((d * d + hole * hole) / (d * d - hole * hole) - nu);
        assert!((tube(0.5 * d, 0.5 * hole).give() / give - 1.0).abs() < 1e-14);
        let solid = d * (1.0 - nu) / (2.0 * e);
        assert!((tube(0.5 * d, 0.0).give() / solid - 1.0).abs() < 1e-14);
        let (seat, outside) = (80e-3f64, 160e-3f64);
        let squares = [seat * seat, outside * outside];
        let give = seat / (2.0 * e) * ((squares[1] + squares[0]) / (squares[1] - squares[0]) + nu);
        assert!((tube(0.5 * seat, 0.5 * outside).give() / give - 1.0).abs() < 1e-14);
    }

    /// Wrong: a ring would shrink on its shaft, or grow in its housing.
    #[test]
    fn a_pressure_moves_both_surfaces_away_from_it() {
        let (ring, outer) = (tube(25e-3, 28e-3), tube(40e-3, 37e-3));
        assert!(ring.pressed(ring.seat) > ring.growth() && ring.growth() > 0.0);
        assert!(outer.pressed(outer.seat) < 0.0 && outer.growth() < outer.pressed(outer.seat));
    }

    /// Wrong: a turning tube would not grow as its own weight pulls it. A thin ring grows by rho omega^2 r^3 / E.
    #[test]
    fn a_thin_turning_ring_grows_as_a_hoop() {
        let hoop = 7800.0 * 0.1f64.powi(3) / 207e9;
        for found in [
            tube(0.1 - 1e-9, 0.1 + 1e-9).spun(),
            tube(0.1 + 1e-9, 0.1 - 1e-9).spun(),
        ] {
            assert!((found / hoop - 1.0).abs() < 1e-7, "{found:e} {hoop:e}");
        }
    }
}
