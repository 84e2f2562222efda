//! Ratings of a bearing from its dimensions: dynamic, static, fatigue limit, and the shares of the raceways.
//!
//! With gamma = D_w cos(a) / D_pw, a the nominal contact angle, and lengths in mm (ISO 281:2007, clause 5; ISO/TR
//! 1281-1:2021, clause 5):
//!
//! ```text
//! C_r = 1.3 f_c cos(a)^0.7 Z^(2/3) D_w^1.8                      D_w <= 25.4 mm, else 3.647 D_w^1.4
//! f_c = 0.41 * 0.95 * 98.0665 (2 f_i / (2 f_i - 1))^0.41 gamma^0.3 (1 - gamma)^1.39 / (1 + gamma)^(1/3)
//!       {1 + [1.04 ((1 - gamma)/(1 + gamma))^1.72 (f_i (2 f_e - 1) / (f_e (2 f_i - 1)))^0.41]^(10/3)}^-0.3
//! C_0r = Z cos(a) Q / 5,   Q the force of a ball that makes 4200 MPa               (ISO 76:2006)
//! C_u = C_0r / 22, times (100 mm / D_pw)^0.5 above 100 mm                           (ISO 281:2007, annex B)
//! Q_ci = C_r / (0.407 Z cos(a)^0.7) {1 + X^(10/3)}^0.3                              (ISO 16281:2025)
//! Q_ce = C_r / (0.389 Z cos(a)^0.7) {1 + X^(-10/3)}^0.3
//! X = 1.044 ((1 - gamma)/(1 + gamma))^1.72 (r_i (2 r_e - D_w) / (r_e (2 r_i - D_w)))^0.41
//! ```
//!
//! f_c takes the groove radii 0.52 D_w that the table of ISO 281 is made of; C_0r takes 0.52 and 0.53 and steel of
//! 207 GPa and 0.3, by exact Hertz theory. One row of balls. A bearing of other steel has the same ratings here.

use contact::{Elastic, HertzContact, Side};
use dynamics::kinematics::BothRings;

/// Groove radii over the ball diameter that f_c of ISO 281 is tabled for, inner first.
const TABLED_GROOVES: BothRings = [0.52, 0.52];
/// Groove radii over the ball diameter of a usual bearing (ISO 76:2006, ISO 16281:2025), inner first.
pub const REFERENCE_GROOVES: BothRings = [0.52, 0.53];
/// Peak pressure that leaves 1e-4 of the ball diameter (ISO 76:2006), Pa.
pub const STATIC_PRESSURE: f64 = 4200e6;
/// Steel of ISO 76.
const STEEL: Elastic = Elastic {
    young_modulus: 207e9,
    poisson_ratio: 0.3,
};
/// Above this ball diameter the rating grows less, mm.
const LARGE_BALL: f64 = 25.4;
/// Above this pitch diameter the fatigue limit is less, mm.
const LARGE_PITCH: f64 = 100.0;

/// What ratings depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CatalogueBearing {
    /// Number of balls Z of the row.
    pub n_balls: usize,
    /// Ball diameter D_w, m.
    pub ball_diameter: f64,
    /// Pitch diameter D_pw, m.
    pub pitch_diameter: f64,
    /// Nominal contact angle, rad.
    pub contact_angle: f64,
    /// Groove radii by which the rating is shared, m, inner first.
    pub groove_radii: BothRings,
}

impl CatalogueBearing {
    /// gamma = D_w cos(a) / D_pw.
    pub fn gamma(&self) -> f64 {
        self.ball_diameter * self.contact_angle.cos() / self.pitch_diameter
    }

    /// Basic dynamic radial load rating C_r, N.
    pub fn dynamic_rating(&self) -> f64 {
        let diameter = 1e3 * self.ball_diameter;
        let power = if diameter <= LARGE_BALL {
            diameter.powf(1.8)
        } else {
            3.647 * diameter.powf(1.4)
        };
        let shape = self.contact_angle.cos().powf(0.7) * (self.n_balls as f64).powf(2.0 / 3.0);
        1.3 * rating_factor(TABLED_GROOVES, self.gamma()) * shape * power
    }

    /// Basic static radial load rating C_0r, N: that of the raceway with the larger pressure.
    pub fn static_rating(&self) -> f64 {
        let force = Side::BOTH
            .map(|side| self.force_of_static_pressure(side))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        self.n_balls as f64 * self.contact_angle.cos() * force / 5.0
    }

    /// Force of a ball that makes 4200 MPa on a raceway with the reference groove, N.
    fn force_of_static_pressure(&self, side: Side) -> f64 {
        let ball = 2.0 / self.ball_diameter;
        let across = ball - 1.0 / (REFERENCE_GROOVES[side.index()] * self.ball_diameter);
        let gamma = self.gamma();
        // The inner raceway is convex in the rolling direction, the outer one concave.
        let rolling = ball * (1.0 - side.sign() * gamma / (1.0 + side.sign() * gamma));
        let modulus = 0.5 / STEEL.plane_compliance();
        let unit = HertzContact::from_curvatures(across, rolling, modulus).peak_pressure(1.0);
        (STATIC_PRESSURE / unit).powi(3)
    }

    /// Fatigue load limit C_u, N, of a static rating.
    pub fn fatigue_limit(&self, static_rating: f64) -> f64 {
        let pitch = 1e3 * self.pitch_diameter;
        static_rating / 22.0 * (LARGE_PITCH / pitch.max(LARGE_PITCH)).sqrt()
    }

    /// Dynamic ratings of a ball on the raceways, Q_ci and Q_ce, N: a ring all of whose contacts carry its own lives
    /// 1e6 revolutions. `rating` is C_r, N.
    pub fn raceway_ratings(&self, rating: f64) -> BothRings {
        let gamma = self.gamma();
        let [inner, outer] = self.groove_radii;
        let open = |radius: f64| (2.0 * radius - self.ball_diameter) / radius;
        let ratio =
            1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72) * (open(outer) / open(inner)).powf(0.41);
        let share = rating / (self.n_balls as f64 * self.contact_angle.cos().powf(0.7));
        let of = |factor: f64, ratio: f64| share / factor * (1.0 + ratio.powf(10.0 / 3.0)).powf(0.3);
        [of(0.407, ratio), of(0.389, 1.0 / ratio)]
    }
}

/// Factor f_c of ISO 281, N and mm, for groove radii over the ball diameter, inner first.
pub fn rating_factor([inner, outer]: BothRings, gamma: f64) -> f64 {
    let ratio = 1.04
        * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72)
        * (inner * (2.0 * outer - 1.0) / (outer * (2.0 * inner - 1.0))).powf(0.41);
    0.41 * 0.95
        * 98.0665
        * (2.0 * inner / (2.0 * inner - 1.0)).powf(0.41)
        * gamma.powf(0.3)
        * (1.0 - gamma).powf(1.39)
        / (1.0 + gamma).cbrt()
        * (1.0 + ratio.powf(10.0 / 3.0)).powf(-0.3)
}
