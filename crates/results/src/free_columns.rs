//! Columns and cells that free balls and a free cage have in the long tables. SI units in the names.

use dynamics::balls::{CageResult, FreeBallResult, Friction};

use super::snapshot::Snapshot;

/// Of a contact of a free ball, with `inner_` or `outer_` before.
pub const TRACTION_COLUMNS: [&str; 7] = [
    "slip_rolling_m_per_s",
    "slip_lateral_m_per_s",
    "spin_rad_per_s",
    "traction_rolling_n",
    "traction_lateral_n",
    "friction_power_w",
    "pv_w_per_m2",
];

/// Turning of a free ball.
pub const FREE_BALL_COLUMNS: [&str; 4] = [
    "omega_x_rad_per_s",
    "omega_y_rad_per_s",
    "omega_z_rad_per_s",
    "orbit_rad_per_s",
];

/// Forces of its pocket on a ball.
pub const POCKET_COLUMNS: [&str; 2] = ["pocket_rolling_n", "pocket_axial_n"];

/// Of `cage.csv`.
const CAGE_COLUMNS: [&str; 15] = [
    "x_m",
    "y_m",
    "z_m",
    "tilt_x_rad",
    "tilt_y_rad",
    "turn_rad",
    "speed_rad_per_s",
    "kinematic_speed_rad_per_s",
    "largest_pocket_force_n",
    "lower_land_x_n",
    "lower_land_y_n",
    "upper_land_x_n",
    "upper_land_y_n",
    "pocket_torque_n_m",
    "land_torque_n_m",
];

/// Columns of `cage.csv`, if there is a free cage.
pub fn cage_columns(first: &Snapshot) -> Option<Vec<String>> {
    let columns = || CAGE_COLUMNS.iter().map(|name| name.to_string()).collect();
    first.cage.as_ref().map(|_| columns())
}

/// Cells of [`CAGE_COLUMNS`].
pub fn cage_cells(cage: &CageResult) -> [f64; 15] {
    let ([x, y, z], [tilt_x, tilt_y]) = (cage.position_m, cage.tilt_rad);
    let forces = cage.pocket_forces_n.iter().map(|f| f[0].hypot(f[1]));
    let [[a, b], [c, d]] = cage.land_forces_n;
    let [pockets, land] = cage.torques_n_m;
    [
        x,
        y,
        z,
        tilt_x,
        tilt_y,
        cage.turn_rad,
        cage.speed_rad_per_s,
        cage.kinematic_speed_rad_per_s,
        forces.fold(0.0, f64::max),
        a,
        b,
        c,
        d,
        pockets,
        land,
    ]
}

/// Cells of the pocket of a ball; none without a free cage.
pub fn pocket_cells(ball: usize, snapshot: &Snapshot) -> impl Iterator<Item = f64> {
    let cage = snapshot.cage.iter();
    cage.flat_map(move |cage| cage.pocket_forces_n[ball])
}

/// Friction of all balls, of `shaft.csv`.
pub const FRICTION_COLUMNS: [&str; 5] = [
    "friction_torque_n_m",
    "friction_power_w",
    "cage_speed_rad_per_s",
    "outer_friction_torque_n_m",
    "kinematic_cage_speed_rad_per_s",
];

/// Cells of a free ball: both contacts, then its turning.
pub fn free_cells(ball: &FreeBallResult) -> [f64; 18] {
    let [inner, outer] = [&ball.inner, &ball.outer].map(|contact| {
        let ([s_t, s_q], [f_t, f_q]) = (contact.slip_m_per_s, contact.traction_n);
        [
            s_t,
            s_q,
            contact.spin_rad_per_s,
            f_t,
            f_q,
            contact.friction_power_w,
            contact.pv_w_per_m2,
        ]
    });
    let [x, y, z] = ball.omega_rad_per_s;
    let turning = [x, y, z, ball.orbit_rad_per_s];
    let mut cells = [0.0; 18];
    let all = inner.into_iter().chain(outer).chain(turning);
    cells.iter_mut().zip(all).for_each(|(cell, value)| *cell = value);
    cells
}

/// Cells of [`FRICTION_COLUMNS`].
pub fn friction_cells(friction: &Friction) -> [f64; 5] {
    [
        friction.torque_n_m,
        friction.power_w,
        friction.cage_speed_rad_per_s,
        friction.outer_torque_n_m,
        friction.kinematic_cage_speed_rad_per_s,
    ]
}
