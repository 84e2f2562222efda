//! Traction of a lubricant film that shears: an Eyring fluid with a limiting stress.
//!
//! ```text
//! tau_f = tau_E asinh(eta s/(h_c tau_E)),   eta = eta_0 exp(xi p)
//! tau   = L p tanh(tau_f/(L p)),            mu = tau/p
//! ```
//!
//! h_c is the thickness of the film in the middle of the contact ([`contact::film`]), the same everywhere; p is Hertz's
//! pressure at the place, tau_E the Eyring stress (about 5 MPa for mineral oils), L the limit (0.05 to 0.1). tanh is a
//! smooth cap, and the only one: the viscosity has no bound. At small slip the bodies creep before the film shears
//! where it is stiff: mu is taken at sqrt(s^2 + s_v^2), with s_v of elastic creep for the coefficient L. Sources:
//! Eyring, J. Chem. Phys. 4 (1936) 283; Johnson and Tevaarwerk, Proc. R. Soc. A 356 (1977) 215. Validity: isothermal,
//! so too high above some 1 m/s of slip.

use contact::film::{FilmContact, Lubricant};

/// Largest exponent xi p of the viscosity, far above any contact: beyond it numbers overflow.
const MOST_EXPONENT: f64 = 300.0;
/// Thinnest film, m: the size of molecules. A contact that does not roll has no other.
const LEAST_FILM: f64 = 1e-9;

/// A film that shears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimitingShear {
    /// Stress tau_E, Pa.
    pub eyring: f64,
    /// Largest shear stress over pressure, L.
    pub limit: f64,
    /// The oil.
    pub lubricant: Lubricant,
}

impl LimitingShear {
    /// Coefficient at a slip of at least 0 m/s under a pressure, Pa, in a film, m; and its slope, s/m.
    pub fn at(&self, slip: f64, pressure: f64, film: f64) -> (f64, f64) {
        let Lubricant {
            viscosity,
            pressure_coefficient,
        } = self.lubricant;
        let most = self.limit * pressure;
        if most <= 0.0 {
            return (self.limit, 0.0);
        }
        let viscosity = viscosity * (pressure_coefficient * pressure).min(MOST_EXPONENT).exp();
        let rate = viscosity / (film.max(LEAST_FILM) * self.eyring);
        let x = rate * slip;
        let share = (self.eyring * x.asinh() / most).tanh();
        let slope = self.eyring * rate / x.hypot(1.0) / pressure;
        (self.limit * share, (1.0 - share * share) * slope)
    }

    /// Thickness in the middle of a contact whose surfaces roll at a speed, m/s, under a force, N.
    pub fn film(&self, contact: &FilmContact, speed: f64, force: f64) -> f64 {
        let film = contact.film(self.lubricant, speed, force);
        film.map_or(LEAST_FILM, |film| film.central.max(LEAST_FILM))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OIL: LimitingShear = LimitingShear {
        eyring: 5e6,
        limit: 0.08,
        lubricant: Lubricant {
            viscosity: 0.04,
            pressure_coefficient: 2.2e-8,
        },
    };

    /// Wrong: a film would be no Newtonian fluid where nothing limits it, or not end at the limit.
    #[test]
    fn a_film_is_viscous_at_first_and_limited_at_last() {
        let (pressure, film) = (1e8, 0.4e-6);
        let viscosity = 0.04 * (2.2f64).exp();
        let (mu, slope) = OIL.at(1e-6, pressure, film);
        let newton = viscosity * 1e-6 / film / pressure;
        assert!((mu / newton - 1.0).abs() < 1e-6, "{mu} {newton}");
        assert!((slope * 1e-6 / mu - 1.0).abs() < 1e-6);
        // Eyring's stress below the limit: 5 MPa asinh(50) of 160 MPa.
        let (pressure, slip) = (2e9, 50.0 * film * 5e6 / (0.04 * 44f64.exp()));
        let expected = 0.08 * (5e6 * 50f64.asinh() / 160e6).tanh();
        assert!((OIL.at(slip, pressure, film).0 / expected - 1.0).abs() < 1e-12);
        assert!((OIL.at(1e9, 1e8, film).0 / 0.08 - 1.0).abs() < 1e-9);
        assert_eq!(OIL.at(1.0, 0.0, film), (0.08, 0.0));
    }

    /// Wrong: where the oil is stiffest a film would carry less than its law says, 0.6 of it at 2 GPa, as a largest
    /// viscosity made it. Closed form: asinh x is ln 2x to 1/(4 x^2), so that x may be any number.
    #[test]
    fn a_film_under_high_pressure_carries_what_its_law_says() {
        for (pressure, slip, film) in [(1.4e9, 1e-3, 1e-6), (2e9, 1e-2, 0.4e-6), (3.5e9, 1.0, 0.1e-6)] {
            let asinh = (2.0 * 0.04 * slip / (film * 5e6_f64)).ln() + 2.2e-8 * pressure;
            let expected = 0.08 * (5e6 * asinh / (0.08 * pressure)).tanh();
            let (mu, slope) = OIL.at(slip, pressure, film);
            assert!((mu / expected - 1.0).abs() < 1e-12, "{pressure} {mu} {expected}");
            assert!(slope > 0.0 && slope < mu / slip, "{slope}");
        }
        // No oil is too stiff for numbers.
        let (mu, slope) = OIL.at(1e-6, 1e12, 1e-9);
        assert!(mu.is_finite() && slope.is_finite() && mu > 0.0, "{mu} {slope}");
    }

    /// Wrong: Newton would use a wrong tangent. Difference quotients.
    #[test]
    fn the_slope_is_the_derivative() {
        for pressure in [1e7, 3e8, 1.5e9] {
            for slip in [1e-6, 1e-4, 1e-2, 1.0] {
                let h = 1e-5 * slip;
                let at = |s: f64| OIL.at(s, pressure, 0.4e-6).0;
                let numeric = (at(slip + h) - at(slip - h)) / (2.0 * h);
                let slope = OIL.at(slip, pressure, 0.4e-6).1;
                assert!(
                    (numeric - slope).abs() <= 1e-6 * slope.abs() + 1e-9 / slip,
                    "{pressure} {slip}"
                );
            }
        }
    }
}
