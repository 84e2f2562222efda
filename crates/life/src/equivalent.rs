//! Equivalent loads of ISO 281 and ISO 76: one radial load with the life, or the dent, of a radial and an axial load.
//!
//! P = X F_r + Y F_a, with X = 1 and Y = 0 where F_a / F_r <= e. X, Y and e are those of ISO 281:2007, table 3, for one
//! row: linear between the tabled contact angles, and up to 15 degrees between the tabled values of the relative axial
//! load F_a / (Z D_w^2), which is held at its first and last one. A bearing of 5 degrees has the factors of a radial
//! contact bearing. P_0 = X_0 F_r + Y_0 F_a, at least F_r (ISO 76:2006, table 2).

use crate::rating::CatalogueBearing;

/// Forces on the inner ring, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BearingLoad {
    /// Across the axis.
    pub radial: f64,
    /// Along the axis, without its sign.
    pub axial: f64,
}

/// Loads with the same life and the same dent as those of a bearing, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentLoads {
    /// Dynamic equivalent load P.
    pub dynamic: f64,
    /// Static equivalent load P_0.
    pub at_rest: f64,
}

/// Factors of one contact angle over the relative axial load.
struct Factors {
    /// Contact angle, deg.
    angle: f64,
    x: f64,
    y: [f64; 9],
    e: [f64; 9],
}

/// Relative axial loads F_a / (Z D_w^2) of the table, N/mm^2.
const RELATIVE_LOADS: [f64; 9] = [0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89];

const fn fixed(angle: f64, x: f64, y: f64, e: f64) -> Factors {
    Factors {
        angle,
        x,
        y: [y; 9],
        e: [e; 9],
    }
}

const fn radial_contact(angle: f64) -> Factors {
    Factors {
        angle,
        x: 0.56,
        y: [2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00],
        e: [0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44],
    }
}

/// Table 3 of ISO 281:2007 for F_a / F_r > e, one row.
static FACTORS: [Factors; 10] = [
    radial_contact(0.0),
    radial_contact(5.0),
    Factors {
        angle: 10.0,
        x: 0.46,
        y: [1.88, 1.71, 1.52, 1.41, 1.34, 1.23, 1.10, 1.01, 1.00],
        e: [0.29, 0.32, 0.36, 0.38, 0.40, 0.44, 0.49, 0.54, 0.54],
    },
    Factors {
        angle: 15.0,
        x: 0.44,
        y: [1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00],
        e: [0.38, 0.40, 0.43, 0.46, 0.47, 0.50, 0.55, 0.56, 0.56],
    },
    fixed(20.0, 0.43, 1.00, 0.57),
    fixed(25.0, 0.41, 0.87, 0.68),
    fixed(30.0, 0.39, 0.76, 0.80),
    fixed(35.0, 0.37, 0.66, 0.95),
    fixed(40.0, 0.35, 0.57, 1.14),
    fixed(45.0, 0.33, 0.50, 1.34),
];

/// X_0 and Y_0 of ISO 76:2006, table 2, by contact angle, deg, one row.
const STATIC_ANGLES: [f64; 10] = [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0];
const STATIC_X: [f64; 10] = [0.6, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5];
const STATIC_Y: [f64; 10] = [0.50, 0.52, 0.50, 0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22];

impl BearingLoad {
    /// Both equivalent loads, N.
    pub fn equivalent(&self, bearing: &CatalogueBearing) -> EquivalentLoads {
        EquivalentLoads {
            dynamic: self.dynamic(bearing),
            at_rest: self.at_rest(bearing),
        }
    }

    /// Dynamic equivalent load P, N.
    pub fn dynamic(&self, bearing: &CatalogueBearing) -> f64 {
        let diameter = 1e3 * bearing.ball_diameter;
        let relative = self.axial / (bearing.n_balls as f64 * diameter * diameter);
        let angles: Vec<f64> = FACTORS.iter().map(|row| row.angle).collect();
        let of_angle = |value: &dyn Fn(&Factors) -> f64| {
            let values: Vec<f64> = FACTORS.iter().map(value).collect();
            between(&angles, &values, bearing.contact_angle.to_degrees())
        };
        let limit = of_angle(&|row| between(&RELATIVE_LOADS, &row.e, relative));
        if self.axial <= limit * self.radial {
            return self.radial;
        }
        let x = of_angle(&|row| row.x);
        let y = of_angle(&|row| between(&RELATIVE_LOADS, &row.y, relative));
        x * self.radial + y * self.axial
    }

    /// Static equivalent load P_0, N.
    pub fn at_rest(&self, bearing: &CatalogueBearing) -> f64 {
        let angle = bearing.contact_angle.to_degrees();
        let (x, y) = (
            between(&STATIC_ANGLES, &STATIC_X, angle),
            between(&STATIC_ANGLES, &STATIC_Y, angle),
        );
        (x * self.radial + y * self.axial).max(self.radial)
    }
}

/// Linear between growing places, constant before the first and after the last.
fn between(places: &[f64], values: &[f64], x: f64) -> f64 {
    let last = places.len() - 1;
    let i = places.partition_point(|place| *place < x);
    if i == 0 {
        return values[0];
    }
    if i > last {
        return values[last];
    }
    let share = (x - places[i - 1]) / (places[i] - places[i - 1]);
    values[i - 1] + share * (values[i] - values[i - 1])
}
