//! Temperatures of bodies between which heat flows by given conductances.
//!
//! ```text
//! sum over the neighbours j of body i of  G_ij (T_i - T_j) = P_i,      the surroundings have T_amb
//! ```
//!
//! Each body has one temperature. A body without conductance follows others: the shaft the inner ring, the housing the
//! outer ring, the balls the mean of both. Steady state; masses have no part in it. Cost: a matrix of at most 5 rows.

use dense::DenseCholesky;
use scene::SURROUNDINGS;

/// Bodies in the order of [`scene::BODIES`]: inner ring, outer ring, balls, shaft, housing.
pub type OfBodies = [f64; 5];

/// Inner ring, outer ring, balls, shaft and housing by number.
pub const INNER: usize = 0;
/// The outer ring.
pub const OUTER: usize = 1;
/// All balls.
pub const BALLS: usize = 2;
const SHAFT: usize = 3;
const HOUSING: usize = 4;

/// Conductances between bodies and surroundings.
#[derive(Clone, Debug)]
pub struct Network<'a> {
    /// Conductances, W/K, each between two bodies or a body and the surroundings.
    pub conductances: &'a [([usize; 2], f64)],
    /// Temperature of the surroundings, K.
    pub ambient: f64,
}

impl Network<'_> {
    /// Whether a body takes part.
    fn has(&self, body: usize) -> bool {
        self.conductances.iter().any(|(ends, _)| ends.contains(&body))
    }

    /// Heat of a friction power in W: half of it in the contacts of each ring, of which ring and balls take one half
    /// each where the balls take part, else the ring all of it.
    pub fn heat(&self, power: f64) -> OfBodies {
        let mut heat = [0.0; 5];
        let to_balls = if self.has(BALLS) { 0.5 } else { 0.0 };
        for ring in [INNER, OUTER] {
            heat[ring] = 0.5 * (1.0 - to_balls) * power;
            heat[BALLS] += 0.5 * to_balls * power;
        }
        heat
    }

    /// Steady temperatures, K, under heat in W.
    pub fn steady(&self, heat: OfBodies) -> OfBodies {
        let bodies: Vec<usize> = (0..SURROUNDINGS).filter(|body| self.has(*body)).collect();
        let place = |body: usize| bodies.iter().position(|other| *other == body);
        let n = bodies.len();
        let mut matrix = vec![0.0; n * n];
        let mut rises: Vec<f64> = bodies.iter().map(|body| heat[*body]).collect();
        for ([a, b], conductance) in self.conductances {
            let ends = [place(*a), place(*b)];
            for i in ends.into_iter().flatten() {
                matrix[n * i + i] += conductance;
            }
            if let [Some(i), Some(j)] = ends {
                matrix[n * i + j] -= conductance;
                matrix[n * j + i] -= conductance;
            }
        }
        DenseCholesky::factor(n, &matrix)
            .expect("all bodies of a checked scene lose heat to the surroundings")
            .solve(&mut rises, 1);
        let mut temperatures = [f64::NAN; 5];
        for (body, rise) in bodies.iter().zip(rises) {
            temperatures[*body] = self.ambient + rise;
        }
        self.follow(temperatures)
    }

    /// Temperatures with those of bodies that follow others.
    fn follow(&self, mut temperatures: OfBodies) -> OfBodies {
        let [inner, outer] = [temperatures[INNER], temperatures[OUTER]];
        for (body, followed) in [(BALLS, 0.5 * (inner + outer)), (SHAFT, inner), (HOUSING, outer)] {
            if !self.has(body) {
                temperatures[body] = followed;
            }
        }
        temperatures
    }

    /// Heat that the surroundings take, W.
    pub fn given_off(&self, temperatures: OfBodies) -> f64 {
        let to_ambient = self
            .conductances
            .iter()
            .filter(|(ends, _)| ends[1] == SURROUNDINGS);
        to_ambient
            .map(|(ends, conductance)| conductance * (temperatures[ends[0]] - self.ambient))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn network(conductances: &[([usize; 2], f64)]) -> Network<'_> {
        Network {
            conductances,
            ambient: 293.15,
        }
    }

    /// Wrong: two rings would not share their heat. G_i T_i + g (T_i - T_o) = P/2 and the same of the other ring:
    /// T_i = P/2 (G_o + 2 g) / (G_i G_o + g (G_i + G_o)).
    #[test]
    fn two_lumps_have_their_closed_form() {
        let (g_i, g_o, g, power) = (0.5, 4.0, 1.5, 30.0);
        let conductances = [
            ([INNER, SURROUNDINGS], g_i),
            ([OUTER, SURROUNDINGS], g_o),
            ([INNER, OUTER], g),
        ];
        let network = network(&conductances);
        let found = network.steady(network.heat(power));
        let determinant = g_i * g_o + g * (g_i + g_o);
        let inner = 0.5 * power * (g_o + 2.0 * g) / determinant;
        let outer = 0.5 * power * (g_i + 2.0 * g) / determinant;
        assert!((found[INNER] - 293.15 - inner).abs() < 1e-12 * 300.0);
        assert!((found[OUTER] - 293.15 - outer).abs() < 1e-12 * 300.0);
        assert_eq!(found[BALLS], 0.5 * (found[INNER] + found[OUTER]));
        assert_eq!([found[SHAFT], found[HOUSING]], [found[INNER], found[OUTER]]);
    }

    /// Wrong: five bodies would lose or make heat. What flows off is what friction makes, and bodies in a chain add
    /// their resistances: T_o = T_amb + P_o (1/G_oh + 1/G_ha).
    #[test]
    fn a_chain_adds_resistances_and_gives_off_all_heat() {
        let conductances = [
            ([INNER, SHAFT], 3.0),
            ([SHAFT, SURROUNDINGS], 0.4),
            ([OUTER, HOUSING], 20.0),
            ([HOUSING, SURROUNDINGS], 2.0),
        ];
        let network = network(&conductances);
        let heat = network.heat(10.0);
        assert_eq!(heat, [5.0, 5.0, 0.0, 0.0, 0.0]);
        let found = network.steady(heat);
        assert!((found[OUTER] - 293.15 - 5.0 * (1.0 / 20.0 + 1.0 / 2.0)).abs() < 1e-10);
        assert!((found[INNER] - 293.15 - 5.0 * (1.0 / 3.0 + 1.0 / 0.4)).abs() < 1e-10);
        assert!((network.given_off(found) - 10.0).abs() < 1e-10);
    }

    /// Wrong: balls that take part would get no heat: half of that of each contact.
    #[test]
    fn balls_take_their_half() {
        let conductances = [
            ([INNER, SURROUNDINGS], 1.0),
            ([OUTER, SURROUNDINGS], 1.0),
            ([INNER, BALLS], 0.5),
            ([OUTER, BALLS], 0.5),
        ];
        let network = network(&conductances);
        assert_eq!(network.heat(8.0), [2.0, 2.0, 4.0, 0.0, 0.0]);
        let found = network.steady(network.heat(8.0));
        assert!((found[BALLS] - found[INNER] - 4.0).abs() < 1e-10);
        assert!((network.given_off(found) - 8.0).abs() < 1e-10);
    }
}
