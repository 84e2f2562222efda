//! Numbers with their derivatives: the geometry of a free ball's contact is written once, and Newton's tangent follows.
//!
//! Forward differentiation over the lengths of a link (e.g. Griewank and Walther, Evaluating Derivatives, 2008,
//! chapter 3): exact to round-off. Cost: an operation costs as many multiplications as there are lengths; all are
//! inlined, so that the processor's vectors do them.

use std::ops::{Add, Mul, Neg, Sub};

/// Lengths of a link of a free ball.
pub const N_LENGTHS: usize = 12;

/// A number and its growth with each length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// The number.
    pub value: f64,
    /// Its derivatives.
    pub slope: [f64; N_LENGTHS],
}

/// A vector in space.
pub type Vector = [Jet; 3];

impl Jet {
    /// A number that does not change.
    #[inline(always)]
    pub fn constant(value: f64) -> Jet {
        Jet {
            value,
            ..Jet::default()
        }
    }

    /// A length itself.
    #[inline(always)]
    pub fn length(index: usize, value: f64) -> Jet {
        let mut jet = Jet::constant(value);
        jet.slope[index] = 1.0;
        jet
    }

    /// A function of it with this value and derivative.
    #[inline(always)]
    pub fn map(self, value: f64, derivative: f64) -> Jet {
        Jet {
            value,
            slope: std::array::from_fn(|i| derivative * self.slope[i]),
        }
    }

    /// Its square root.
    #[inline(always)]
    pub fn sqrt(self) -> Jet {
        let root = self.value.sqrt();
        self.map(root, 0.5 / root)
    }

    /// One over it.
    #[inline(always)]
    pub fn recip(self) -> Jet {
        let inverse = 1.0 / self.value;
        self.map(inverse, -inverse * inverse)
    }
}

impl Add for Jet {
    type Output = Jet;

    #[inline(always)]
    fn add(self, other: Jet) -> Jet {
        Jet {
            value: self.value + other.value,
            slope: std::array::from_fn(|i| self.slope[i] + other.slope[i]),
        }
    }
}

impl Sub for Jet {
    type Output = Jet;

    #[inline(always)]
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Neg for Jet {
    type Output = Jet;

    #[inline(always)]
    fn neg(self) -> Jet {
        Jet {
            value: -self.value,
            slope: std::array::from_fn(|i| -self.slope[i]),
        }
    }
}

impl Mul for Jet {
    type Output = Jet;

    #[inline(always)]
    fn mul(self, other: Jet) -> Jet {
        Jet {
            value: self.value * other.value,
            slope: product_rule(&self, &other),
        }
    }
}

impl Add<f64> for Jet {
    type Output = Jet;

    #[inline(always)]
    fn add(self, other: f64) -> Jet {
        Jet {
            value: self.value + other,
            ..self
        }
    }
}

impl Mul<f64> for Jet {
    type Output = Jet;

    #[inline(always)]
    fn mul(self, factor: f64) -> Jet {
        self.map(self.value * factor, factor)
    }
}

#[inline(always)]
fn product_rule(a: &Jet, b: &Jet) -> [f64; N_LENGTHS] {
    std::array::from_fn(|i| a.slope[i] * b.value + a.value * b.slope[i])
}

/// A vector that does not change.
#[inline(always)]
pub fn fixed(v: [f64; 3]) -> Vector {
    [Jet::constant(v[0]), Jet::constant(v[1]), Jet::constant(v[2])]
}

/// a + b.
#[inline(always)]
pub fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// a - b.
#[inline(always)]
pub fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// s a.
#[inline(always)]
pub fn times(s: Jet, a: Vector) -> Vector {
    [s * a[0], s * a[1], s * a[2]]
}

/// A multiple by a plain number.
#[inline(always)]
pub fn scaled(s: f64, a: Vector) -> Vector {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// a . b.
#[inline(always)]
pub fn dot(a: Vector, b: Vector) -> Jet {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a x b.
#[inline(always)]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The values alone.
#[inline(always)]
pub fn values(a: Vector) -> [f64; 3] {
    a.map(|x| x.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a rule of differentiation. Difference quotients of a function that uses them all.
    #[test]
    fn derivatives_are_those_of_the_function() {
        let f = |x: [f64; 3]| {
            let v = [0, 1, 2].map(|i| Jet::length(i, x[i]));
            let u = cross(v, fixed([0.3, -0.2, 0.9]));
            let s = (dot(u, u) + 0.7).sqrt();
            dot(times(s.recip(), minus(plus(u, v), scaled(0.5, v))), v) * s + 1.0
        };
        let x = [0.4, -1.3, 0.8];
        for j in 0..3 {
            let moved = |h: f64| {
                let mut y = x;
                y[j] += h;
                f(y).value
            };
            let numeric = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            assert!((numeric - f(x).slope[j]).abs() < 1e-8, "{j}");
        }
    }
}
