//! Life factors of ISO 281:2007, clause 9: reliability a_1, and a_ISO for lubricant and dirt.
//!
//! ```text
//! kappa = nu / nu_1,   nu_1 = 45000 n^-0.83 D_pw^-0.5 below 1000 rpm, 4500 n^-0.5 D_pw^-0.5 above    mm^2/s, mm
//! a_ISO = 0.1 {1 - [2.5671 - u(kappa)]^0.83 (e_C C_u / P)^(1/3)}^-9.3,   at most 50
//! u = 2.2649 kappa^-0.054381 (0.1 to 0.4),   1.9987 kappa^-0.19087 (0.4 to 1),   1.9987 kappa^-0.071739 (1 to 4)
//! log10 log10 (nu + 0.7) = A - B log10 T      mm^2/s, K, above 2 mm^2/s    (Walther; ASTM D341)
//! ```
//!
//! A thicker film than kappa = 4 brings no more life; below 0.1 the standard has no factor.

use std::f64::consts::PI;

pub use contact::film::walther;
use scene::Oil;

/// Range of kappa of ISO 281.
const KAPPA: [f64; 2] = [0.1, 4.0];
/// Largest a_ISO.
const MOST: f64 = 50.0;

/// Factor a_1 of a reliability, per cent (ISO 281:2007, table 12); None for one that is not tabled.
pub fn reliability_factor(reliability: f64) -> Option<f64> {
    const TABLE: [[f64; 2]; 6] = [
        [90.0, 1.0],
        [95.0, 0.64],
        [96.0, 0.55],
        [97.0, 0.47],
        [98.0, 0.37],
        [99.0, 0.25],
    ];
    let row = TABLE.iter().find(|row| row[0] == reliability);
    row.map(|row| row[1])
}

/// Reference viscosity nu_1, m2/s, at a speed of a ring against the other, rad/s, and a pitch diameter, m.
pub fn reference_viscosity(speed: f64, pitch_diameter: f64) -> f64 {
    let (n, pitch) = (speed.abs() * 30.0 / PI, 1e3 * pitch_diameter);
    let speed_term = if n < 1000.0 {
        45000.0 * n.powf(-0.83)
    } else {
        4500.0 * n.powf(-0.5)
    };
    1e-6 * speed_term * pitch.powf(-0.5)
}

/// Viscosity ratio kappa, at most 4, of an oil; `speed` in rad/s, `pitch_diameter` in m. Says why there is none.
pub fn viscosity_ratio(oil: Option<&Oil>, speed: Option<f64>, pitch_diameter: f64) -> Result<f64, String> {
    let Some(oil) = oil else {
        return Err("no viscosity: life.viscosity_ratio, life.viscosity or life.viscosity_class".to_string());
    };
    let viscosity = match (oil, oil.viscosity()) {
        (Oil::Ratio(ratio), _) => return Ok(ratio.min(KAPPA[1])),
        (_, viscosity) => viscosity.expect("an oil that is no ratio has a viscosity"),
    };
    let Some(speed) = speed else {
        return Err("no speed, on which the viscosity ratio depends: life.speed".to_string());
    };
    Ok((viscosity / reference_viscosity(speed, pitch_diameter)).min(KAPPA[1]))
}

/// Factor a_ISO of a radial ball bearing. `limit_ratio` is e_C C_u / P.
pub fn life_factor(kappa: f64, limit_ratio: f64) -> Result<f64, String> {
    if kappa < KAPPA[0] {
        return Err(format!(
            "kappa is {kappa:.3}; ISO 281 has no factor below 0.1, where the film separates nothing"
        ));
    }
    let u = film_term(kappa.min(KAPPA[1]));
    let base = 1.0 - (2.5671 - u).max(0.0).powf(0.83) * limit_ratio.cbrt();
    if base <= 0.0 {
        return Ok(MOST);
    }
    Ok((0.1 * base.powf(-9.3)).min(MOST))
}

/// u(kappa), for kappa from 0.1 to 4.
pub fn film_term(kappa: f64) -> f64 {
    if kappa < 0.4 {
        2.2649 * kappa.powf(-0.054381)
    } else if kappa < 1.0 {
        1.9987 * kappa.powf(-0.19087)
    } else {
        1.9987 * kappa.powf(-0.071739)
    }
}
