//! Vectors in a meridian plane of the bearing: where a ball and its contacts move.

use std::ops::{Add, Sub};

use serde::Serialize;

/// A vector in a meridian plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Meridian {
    /// Away from the axis.
    pub radial: f64,
    /// Along +z.
    pub axial: f64,
}

impl Meridian {
    /// A vector of these components.
    pub const fn new(radial: f64, axial: f64) -> Meridian {
        Meridian { radial, axial }
    }

    /// Its length.
    pub fn norm(self) -> f64 {
        self.radial.hypot(self.axial)
    }

    /// The product with another one.
    pub fn dot(self, other: Meridian) -> f64 {
        self.radial * other.radial + self.axial * other.axial
    }

    /// What a function makes of each component, the radial one first.
    pub fn map(self, mut f: impl FnMut(f64) -> f64) -> Meridian {
        Meridian::new(f(self.radial), f(self.axial))
    }

    /// `[radial, axial]`, as links, rows and files have it.
    pub fn to_array(self) -> [f64; 2] {
        [self.radial, self.axial]
    }

    /// The components of all vectors, one after another.
    pub fn flat(all: &[Meridian]) -> Vec<f64> {
        all.iter().flat_map(|vector| vector.to_array()).collect()
    }

    /// The vectors of components one after another.
    pub fn list(flat: &[f64]) -> Vec<Meridian> {
        flat.as_chunks().0.iter().copied().map(Meridian::from).collect()
    }
}

impl From<[f64; 2]> for Meridian {
    fn from([radial, axial]: [f64; 2]) -> Meridian {
        Meridian { radial, axial }
    }
}

impl Add for Meridian {
    type Output = Meridian;

    fn add(self, other: Meridian) -> Meridian {
        Meridian::new(self.radial + other.radial, self.axial + other.axial)
    }
}

impl Sub for Meridian {
    type Output = Meridian;

    fn sub(self, other: Meridian) -> Meridian {
        Meridian::new(self.radial - other.radial, self.axial - other.axial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: state arrays and step files would have the components in another order than they are read in.
    #[test]
    fn vectors_come_back_from_their_components() {
        let all = [Meridian::new(1.0, -0.0), Meridian::new(3.0, 4.0)];
        assert_eq!(Meridian::flat(&all), [1.0, -0.0, 3.0, 4.0]);
        assert_eq!(Meridian::list(&Meridian::flat(&all)), all);
        assert_eq!(all[1], Meridian::from(all[1].to_array()));
    }

    /// Wrong: a force or a displacement would be taken in other directions than it has. 3-4-5 triangles.
    #[test]
    fn sums_and_products_go_by_components() {
        let (a, b) = (Meridian::new(3.0, 4.0), Meridian::new(-1.0, 2.0));
        assert_eq!((a.norm(), a.dot(b)), (5.0, 5.0));
        assert_eq!((a + b, a - b), (Meridian::new(2.0, 6.0), Meridian::new(4.0, 2.0)));
        assert_eq!(a.map(|x| 2.0 * x), a + a);
    }
}
