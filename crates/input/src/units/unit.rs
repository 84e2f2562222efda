//! A unit: its size and its dimension.

use super::number::Decimal;

/// Exponents of kilogram, metre, second and radian, dimensionless.
pub type Dimension = [f64; 4];

/// A unit: size = `factor` * 10^`power_of_ten` in SI.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// Dimensionless part of the size that is no power of ten.
    pub factor: f64,
    /// Exponent of ten, not always whole: -4.5 for mm^1.5.
    pub power_of_ten: f64,
    /// Exponents of the base units.
    pub dimension: Dimension,
}

impl Unit {
    /// The number 1.
    pub const ONE: Unit = Unit {
        factor: 1.0,
        power_of_ten: 0.0,
        dimension: [0.0; 4],
    };

    /// The number times this unit, SI. Exact powers of ten do not round.
    pub fn apply(&self, number: &Decimal<'_>) -> f64 {
        let whole = self.power_of_ten.round();
        let part = self.power_of_ten - whole;
        let part = if part.abs() < 1e-12 { 1.0 } else { 10f64.powf(part) };
        let scaled = number.times_power_of_ten(whole as i64);
        if self.factor == 1.0 && part == 1.0 {
            scaled
        } else {
            scaled * (self.factor * part)
        }
    }

    /// To a power.
    pub fn raised(self, power: f64) -> Unit {
        let factor = if self.factor == 1.0 {
            1.0
        } else {
            self.factor.powf(power)
        };
        Unit {
            factor,
            power_of_ten: self.power_of_ten * power,
            dimension: self.dimension.map(|d| d * power),
        }
    }

    /// The product of two units.
    pub fn times(self, other: Unit) -> Unit {
        let mut dimension = self.dimension;
        for (d, o) in dimension.iter_mut().zip(other.dimension) {
            *d += o;
        }
        Unit {
            factor: self.factor * other.factor,
            power_of_ten: self.power_of_ten + other.power_of_ten,
            dimension,
        }
    }
}
