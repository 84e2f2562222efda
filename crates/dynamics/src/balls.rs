//! What is reported of every ball.

use contact::{BySide, Meridian, SemiAxes, Side};
use serde::Serialize;

use crate::surfaces::EllipseKind;

/// One contact of a ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactResult {
    /// Force, N: normal; on strips with the force across the normal.
    pub force_n: f64,
    /// Contact angle, rad.
    pub contact_angle_rad: f64,
    /// Hertz approach, m; negative is a gap.
    pub approach_m: f64,
    /// Semi-axes of the Hertz ellipse, m.
    pub semi_axes_m: SemiAxes,
    /// Peak Hertz pressure, Pa.
    pub peak_pressure_pa: f64,
    /// Whether the ellipse, and with it pressure and stress, is Hertz's; None: the raceway has no strips, and it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ellipse: Option<EllipseKind>,
}

/// One ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BallResult {
    /// Azimuth, rad, from 0 to below 2 pi.
    pub azimuth_rad: f64,
    /// Inner contact.
    pub inner: ContactResult,
    /// Outer contact.
    pub outer: ContactResult,
    /// Displacement from the just-touching position.
    pub displacement_m: Meridian,
    /// Force of the inner ring on the ball across its meridian plane, towards growing azimuths, N, which the cage
    /// holds: the groove of a ring that has moved is not round about the axis. None where grooves are projected, and of
    /// free balls in motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub across_n: Option<f64>,
    /// Of a free ball, its turning and its traction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free: Option<FreeBallResult>,
}

/// Traction at one contact of a free ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TractionResult {
    /// Slip of the ball on the ring along the rolling direction and across it, m/s.
    pub slip_m_per_s: [f64; 2],
    /// Relative turning about the normal, rad/s.
    pub spin_rad_per_s: f64,
    /// Force on the ball along the rolling direction and across it, N.
    pub traction_n: [f64; 2],
    /// Moment on the ball about the centre of the contact: about these directions and the normal, which points from the
    /// ball's centre to the raceway, N m.
    pub traction_moment_n_m: [f64; 3],
    /// Of a contact on a real surface, force on the ball along the rolling direction by the slope of the surface,
    /// through the ball's centre, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope_force_n: Option<f64>,
    /// Of the same, moment on the ball about its centre, x, y, z in space, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope_moment_n_m: Option<[f64; 3]>,
    /// Largest pressure times sliding speed over the ellipse, W/m^2.
    pub pv_w_per_m2: f64,
    /// Power lost, W.
    pub friction_power_w: f64,
}

/// What a free ball has besides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FreeBallResult {
    /// Traction at the inner contact.
    pub inner: TractionResult,
    /// Traction at the outer contact.
    pub outer: TractionResult,
    /// Angular velocity in space, rad/s.
    pub omega_rad_per_s: [f64; 3],
    /// Speed round the axis, rad/s.
    pub orbit_rad_per_s: f64,
}

/// Friction of all free balls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Friction {
    /// Torque that brakes the inner ring, N m.
    pub torque_n_m: f64,
    /// Torque that brakes the outer ring, N m: below zero where balls take it along.
    pub outer_torque_n_m: f64,
    /// Power lost at all contacts, W.
    pub power_w: f64,
    /// Mean speed of the balls round the axis, rad/s.
    pub cage_speed_rad_per_s: f64,
    /// Speed of a cage of pure rolling at the free contact angle, rad/s.
    pub kinematic_cage_speed_rad_per_s: f64,
}

impl Friction {
    /// Power, W, that rings put in which turn at these speeds, rad/s: what the contacts lose and what drag takes from
    /// the balls.
    pub fn drive_power(&self, speeds: BySide<f64>) -> f64 {
        self.torque_n_m * speeds[0] + self.outer_torque_n_m * speeds[1]
    }
}

/// A free cage.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CageResult {
    /// Place of its centre, m.
    pub position_m: [f64; 3],
    /// Tilts about x and y, rad.
    pub tilt_rad: [f64; 2],
    /// Turn since the start, rad.
    pub turn_rad: f64,
    /// Speed about its axis, rad/s.
    pub speed_rad_per_s: f64,
    /// The same of pure rolling at the free contact angle, rad/s.
    pub kinematic_speed_rad_per_s: f64,
    /// Mean force of each pocket on its ball in the last step, along the rolling direction and along the axis, N.
    pub pocket_forces_n: Vec<[f64; 2]>,
    /// Mean force of the land on the ends of the cage at lower and at larger z, x and y, N; zero without a land.
    pub land_forces_n: [[f64; 2]; 2],
    /// Torque of friction in the pockets and of the land on the cage, N m.
    pub torques_n_m: [f64; 2],
}

impl FreeBallResult {
    /// Traction at the contact with the ring of one side.
    pub fn traction(&self, side: Side) -> &TractionResult {
        [&self.inner, &self.outer][side.index()]
    }
}

impl BallResult {
    /// Speed with which surfaces roll through a contact of a free ball of a radius, m/s and m: mean of both, seen from
    /// the contact, along the way round; None: the ball is not free.
    pub fn rolling_speed(&self, side: Side, radius: f64) -> Option<f64> {
        let free = self.free?;
        let slip = free.traction(side).slip_m_per_s[0];
        let (sin, cos) = self.contact(side).contact_angle_rad.sin_cos();
        let [n_r, n_z] = [side.sign() * cos, side.sign() * sin];
        let (y, x) = self.azimuth_rad.sin_cos();
        let [w_x, w_y, w_z] = free.omega_rad_per_s;
        let of_ball = radius * ((w_z - free.orbit_rad_per_s) * n_r - (w_x * x + w_y * y) * n_z);
        // The ring's surface is slower by the slip.
        Some(of_ball - 0.5 * slip)
    }

    /// The contact with the ring of one side.
    pub fn contact(&self, side: Side) -> &ContactResult {
        side.choose(&self.inner, &self.outer)
    }
}
