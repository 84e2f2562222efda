//! Friction torque of a bearing in the form of catalogues, after Palmgren.
//!
//! ```text
//! M_0 = 1e-7 f_0 (nu n)^(2/3) d_m^3   for nu n >= 2000,   160e-7 f_0 d_m^3 below      N mm, mm^2/s, rpm, mm
//! M_1 = f_1 F d_m,     M = M_0 + M_1
//! ```
//!
//! Palmgren, Ball and Roller Bearing Engineering, 3rd ed. 1959, eqs. 2.18 and 2.24; Harris, Rolling Bearing Analysis,
//! 4th ed., chapter 14. F here is the sum of the balls' forces on the inner ring, where the sources have the equivalent
//! load F_beta: so balls that are squeezed between warm rings count. Under a thrust load both differ by 1/0.9 over cos
//! a.

use scene::Oil;

/// Friction torque, N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torque {
    /// Of the oil.
    pub of_oil: f64,
    /// Of the load.
    pub of_load: f64,
}

/// Below this nu n, mm^2/s rpm, the oil's torque does not depend on it.
const LEAST_FLOW: f64 = 2000.0;

impl Torque {
    /// Both together, N m.
    pub fn total(&self) -> f64 {
        self.of_oil + self.of_load
    }
}

/// Torque of the oil, N m; viscosity in m2/s, speed in rad/s, pitch diameter in m.
pub fn of_oil(factor: f64, viscosity: f64, speed: f64, pitch_diameter: f64) -> f64 {
    let (d_m, rpm) = (1e3 * pitch_diameter, speed * 30.0 / std::f64::consts::PI);
    let flow = (1e6 * viscosity * rpm).max(LEAST_FLOW);
    1e-3 * 1e-7 * factor * flow.powf(2.0 / 3.0) * d_m.powi(3)
}

/// Torque of the load, N m; sum of the ball forces in N, pitch diameter in m.
pub fn of_load(factor: f64, ball_forces: f64, pitch_diameter: f64) -> f64 {
    factor * ball_forces * pitch_diameter
}

/// Viscosity of an oil at a temperature, m2/s, where its class is known, else as it is given.
pub fn viscosity_at(oil: &Oil, kelvin: f64) -> f64 {
    let warm = match *oil {
        Oil::Class { at_40, at_100, .. } => Oil::Class {
            at_40,
            at_100,
            temperature: kelvin,
        },
        other => other,
    };
    warm.viscosity().expect("friction has a viscosity, not a ratio")
}

#[cfg(test)]
mod tests {
    use super::*;

    const RPM: f64 = std::f64::consts::PI / 30.0;

    /// Wrong: units of the formula would be lost. f_0 = 2, 24 mm2/s, 1800 rpm, 65 mm: 2e-7 x 43200^(2/3) x 65^3 = 67.6
    /// N mm; f_1 = 0.001, 6 kN: 0.39 N m.
    #[test]
    fn the_torque_is_that_of_the_formula() {
        let oil = of_oil(2.0, 24e-6, 1800.0 * RPM, 65e-3);
        assert!((oil - 1e-3 * 2e-7 * 43200f64.powf(2.0 / 3.0) * 65f64.powi(3)).abs() < 1e-12);
        assert!((oil - 67.6e-3).abs() < 0.1e-3, "{oil}");
        assert!((of_load(1e-3, 6000.0, 65e-3) - 0.39).abs() < 1e-15);
    }

    /// Wrong: slow bearings would have no friction, or a jump where the formulas meet: 2000^(2/3) is 158.7, the sources
    /// round it to 160.
    #[test]
    fn slow_bearings_keep_the_torque_of_the_oil() {
        let at = |rpm: f64| of_oil(2.0, 20e-6, rpm * RPM, 65e-3);
        assert!((at(1.0) / at(100.0) - 1.0).abs() < 1e-12);
        assert!((at(101.0) / at(100.0) - 1.01f64.powf(2.0 / 3.0)).abs() < 1e-9);
    }

    /// Wrong: warm oil would be as thick as cold oil.
    #[test]
    fn oil_thins_as_it_becomes_warm() {
        let class = Oil::Class {
            at_40: 68e-6,
            at_100: Some(8.7e-6),
            temperature: 293.15,
        };
        assert!((viscosity_at(&class, 313.15) / 68e-6 - 1.0).abs() < 1e-9);
        assert!((viscosity_at(&class, 373.15) / 8.7e-6 - 1.0).abs() < 1e-9);
        assert_eq!(viscosity_at(&Oil::Viscosity(24e-6), 400.0), 24e-6);
    }
}
