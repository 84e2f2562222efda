//! Free balls in an equilibrium: each rolls steadily where it stands, and its tractions are loads.
//!
//! Lateral tractions act at the contacts, across the normal forces, and with a couple where a ring is a groove radius
//! away; tractions round the axis and the moments of spin act on the shaft. Centrifugal force has the ball's own speed
//! round the axis. They follow the contact angles and forces, as the loads of [`crate::loading`] do.

use contact::{BySide, Side};

use super::loads::{AtEquilibrium, Loads, Now};
use crate::balls::{FreeBallResult, Friction, TractionResult};
use crate::error::DynamicsError;
use crate::interactions::steady_rolling::{SteadyBall, SteadyContact, SteadyRolling};
use crate::interactions::traction::{PatchPoints, PressureLine, Traction, largest_pv};
use crate::kinematics::Kinematics;
use crate::model::Model;

/// How far a ball may fall behind the cage, over the speed of the faster ring: a quarter of the cage's speed in most
/// bearings. Kinematics makes a few hundredths; drag on a ball that is hardly loaded would stop it.
const MOST_LAG: f64 = 0.1;

/// Steadily rolling balls of an equilibrium.
#[derive(Clone, Debug)]
pub struct SteadyBalls {
    /// How each ball rolls.
    pub balls: Vec<SteadyRolling>,
    contacts: Vec<[SteadyContact; 2]>,
    /// Where the load of each contact lies that is not on Hertz's ellipse ([`crate::surfaces::StripBearing`]).
    lines: Vec<BySide<Vec<PressureLine>>>,
    /// Speed round the axis of pure rolling at the free contact angle, rad/s.
    kinematic_orbit: f64,
}

impl SteadyBalls {
    /// How the balls of a model roll at an instant; None where none does: they are not free, nothing is known of the
    /// contacts yet, no ring turns, there is no friction, or no ball is loaded by both rings.
    pub fn of(model: &Model, now: &Now) -> Result<Option<SteadyBalls>, DynamicsError> {
        let Some(FreeRow {
            balls,
            seen,
            angles,
            speeds,
            kinematic_orbit,
        }) = FreeRow::of(model, now)
        else {
            return Ok(None);
        };
        let solve = |ball: usize, cage: Option<f64>| {
            balls[ball]
                .solve(cage)
                .map_err(|residual| DynamicsError::NoSteadyRolling { ball, residual })
        };
        let mut found = Vec::new();
        for ball in 0..balls.len() {
            found.push(solve(ball, None)?);
        }
        let Some(cage) = cage_speed(&balls, &found) else {
            return Ok(None);
        };
        let fastest = speeds[0].abs().max(speeds[1].abs());
        let slowest = cage - MOST_LAG * fastest.copysign(cage);
        let mut all = Vec::new();
        for (ball, found) in found.into_iter().enumerate() {
            let found = match found {
                Some(found) if (found.orbit - slowest) * cage >= 0.0 => Some(found),
                // The cage pushes a ball that drag would leave behind.
                Some(_) => solve(ball, Some(slowest))?,
                // It drives balls that one ring alone loads.
                None => solve(ball, Some(cage))?,
            };
            all.push(found.unwrap_or(SteadyRolling {
                orbit: cage,
                out: balls[ball].out,
                ..SteadyRolling::default()
            }));
        }
        let lines_of =
            |ball: usize| Side::BOTH.map(|side| lines(model, (seen, angles), 2 * ball + side.index()));
        Ok(Some(SteadyBalls {
            lines: (0..balls.len()).map(lines_of).collect(),
            contacts: balls.iter().map(|ball| ball.contacts).collect(),
            balls: all,
            kinematic_orbit,
        }))
    }

    /// Free balls that no friction drives, because no ring turns, both load no ball, or friction is zero: they go round
    /// and turn as without slip. None where balls are not free.
    pub fn undriven(model: &Model, now: &Now) -> Option<SteadyBalls> {
        let FreeRow {
            balls,
            kinematic_orbit,
            ..
        } = FreeRow::of(model, now)?;
        let rolls = |ball: &SteadyBall<'_>| {
            let [orbit, turning @ ..] = ball.pure_rolling();
            SteadyRolling {
                orbit,
                turning,
                out: ball.out,
                ..SteadyRolling::default()
            }
        };
        Some(SteadyBalls {
            balls: balls.iter().map(rolls).collect(),
            contacts: balls.iter().map(|ball| ball.contacts).collect(),
            lines: vec![BySide::default(); balls.len()],
            kinematic_orbit,
        })
    }

    /// Adds tractions and centrifugal forces.
    pub fn add_loads(&self, model: &Model, now: &Now, loads: &mut Loads) {
        let radius = model.geometry.ball_centre().radial;
        for (ball, (rolls, contacts)) in self.balls.iter().zip(&self.contacts).enumerate() {
            let slope = model.ball_mass() * rolls.orbit * rolls.orbit;
            loads.balls[ball].radial += slope * radius;
            loads.ball_slopes[ball] += slope;
            for side in Side::BOTH {
                let contact = &contacts[side.index()];
                let [n_r, n_z] = contact.normal;
                let [t, q, m_t, m_q, m_n] = rolls.tractions[side.index()].action;
                // On the ring, along q = (-n_z, n_r).
                loads.add_contact_force(ball, side, [q * n_z, -q * n_r].into());
                if side == Side::Outer {
                    continue;
                }
                let (sin, cos) = (model.geometry.azimuth(ball) + now.cage_angle).sin_cos();
                let height = model.geometry.ball_centre().axial - model.geometry.groove_centre(side).axial;
                let height = height + contact.lever * n_z;
                loads.shaft[0] += t * sin;
                loads.shaft[1] -= t * cos;
                // Of -t e_psi at the contact: out e_r + height e_z.
                let radial = height * t;
                // Moments about e_r and e_psi on the shaft, with the couple of -q at the contact about the groove.
                let radial = radial - (m_n * n_r - m_q * n_z);
                let round = model.geometry.groove_radius(side) * q - m_t;
                loads.shaft[3] += radial * cos - round * sin;
                loads.shaft[4] += radial * sin + round * cos;
            }
        }
        loads.follows_angles = true;
    }

    /// What is reported of a ball at this azimuth, rad.
    pub fn result(&self, ball: usize, azimuth: f64) -> FreeBallResult {
        let rolls = &self.balls[ball];
        let contact = |side: Side| {
            let (traction, slip) = (&rolls.tractions[side.index()], &rolls.slips[side.index()]);
            let contact = &self.contacts[ball][side.index()];
            let [f_t, f_q, moment @ ..] = traction.action;
            TractionResult {
                slip_m_per_s: slip.centre,
                spin_rad_per_s: slip.turning[2],
                traction_n: [f_t, f_q],
                traction_moment_n_m: moment,
                slope_force_n: None,
                slope_moment_n_m: None,
                pv_w_per_m2: largest_pv(&contact.ellipse, &self.lines[ball][side.index()], slip),
                friction_power_w: rolls.power(side.index()),
            }
        };
        let (sin, cos) = azimuth.sin_cos();
        let [r, t, z] = rolls.turning;
        let [inner, outer] = Side::BOTH.map(contact);
        FreeBallResult {
            inner,
            outer,
            omega_rad_per_s: [r * cos - t * sin, r * sin + t * cos, z],
            orbit_rad_per_s: rolls.orbit,
        }
    }

    /// Torques, power and cage speeds.
    pub fn friction(&self) -> Friction {
        let pairs = || self.balls.iter().zip(&self.contacts);
        let torque = |side: usize| pairs().map(move |(rolls, contacts)| rolls.torque(&contacts[side], side));
        Friction {
            torque_n_m: torque(0).sum(),
            outer_torque_n_m: torque(1).sum(),
            power_w: pairs().map(|(rolls, _)| rolls.power(0) + rolls.power(1)).sum(),
            cage_speed_rad_per_s: self.balls.iter().map(|ball| ball.orbit).sum::<f64>()
                / self.balls.len() as f64,
            kinematic_cage_speed_rad_per_s: self.kinematic_orbit,
        }
    }
}

/// Free balls where they stand, and what turns them.
struct FreeRow<'m> {
    balls: Vec<SteadyBall<'m>>,
    /// Contacts and balls as they stand.
    seen: AtEquilibrium<'m>,
    /// Contact angles, rad, by site.
    angles: &'m [f64],
    /// Speeds of the rings, rad/s.
    speeds: BySide<f64>,
    /// Speed round the axis of pure rolling at the free contact angle, rad/s.
    kinematic_orbit: f64,
}

impl<'m> FreeRow<'m> {
    /// None where balls are not free, or nothing is known of the contacts yet.
    fn of(model: &'m Model, now: &Now<'m>) -> Option<FreeRow<'m>> {
        let speeds = model.effects.iter().find_map(|effect| effect.rolling_speeds())?;
        let (seen, angles, traction) = (now.seen?, now.angles?, model.traction()?);
        let kinematic_orbit = Kinematics::new(&model.geometry, [0.0; 2]).cage_speed(speeds, now.time);
        let speeds = Side::BOTH.map(|side| speeds.of(side).at(now.time));
        let drag = seen.drag_share * drag(model);
        let ball = |ball: usize| SteadyBall {
            out: model.geometry.ball_centre().radial + seen.balls[ball].radial,
            inertia: model.ball_inertia(),
            drag,
            contacts: Side::BOTH.map(|side| contact(model, side, speeds[side.index()], (seen, angles, ball))),
            traction,
            on_strips: Side::BOTH
                .map(|side| on_strips(model, traction, (seen, angles), 2 * ball + side.index())),
        };
        Some(FreeRow {
            balls: (0..model.geometry.n_balls).map(ball).collect(),
            seen,
            angles,
            speeds,
            kinematic_orbit,
        })
    }
}

/// Drag of a ball over the square of its speed, N s^2/m^2.
pub fn drag(model: &Model) -> f64 {
    model.effects.iter().map(|effect| effect.drag(model)).sum()
}

/// Speed with which a cage goes round, rad/s: that of the balls which roll, by the forces with which the inner ring
/// drives them; None where none rolls.
fn cage_speed(balls: &[SteadyBall<'_>], found: &[Option<SteadyRolling>]) -> Option<f64> {
    let driven = balls
        .iter()
        .zip(found)
        .filter_map(|(ball, found)| found.as_ref().map(|found| (ball.contacts[0].force, found.orbit)));
    let (force, sum) = driven.fold((0.0, 0.0), |(force, sum), (of_ball, orbit)| {
        (force + of_ball, sum + of_ball * orbit)
    });
    (force > 0.0).then(|| sum / force)
}

/// A contact of a ball as it stands.
fn contact(
    model: &Model,
    side: Side,
    speed: f64,
    (seen, angles, ball): (AtEquilibrium<'_>, &[f64], usize),
) -> SteadyContact {
    let site = 2 * ball + side.index();
    let (sin, cos) = angles[site].sin_cos();
    let force = match seen.forces[site] {
        force if force > round_off(model, side) => force,
        _ => 0.0,
    };
    SteadyContact {
        normal: [side.sign() * cos, side.sign() * sin],
        lever: model.contact_lever(ball, seen.approaches[site]),
        force,
        ellipse: model.ellipse(side, force),
        film: model.film_contact(side),
        speed,
        shear_modulus: model.combined_shear_modulus(side),
    }
}

/// Places of traction at a loaded contact on strips.
fn on_strips(
    model: &Model,
    traction: &Traction,
    (seen, angles): (AtEquilibrium<'_>, &[f64]),
    site: usize,
) -> Option<PatchPoints> {
    let strips = seen.strips[site].filter(|_| seen.forces[site] > 0.0)?;
    let half_width = model.hertz[site % 2].semi_axes(seen.forces[site]).groove;
    let approach = (seen.approaches[site], 0.0);
    Some(strips.places(&traction.places, half_width, approach, angles[site]))
}

/// Where the load of a contact on strips lies; none of Hertz's ellipse.
fn lines(model: &Model, (seen, angles): (AtEquilibrium<'_>, &[f64]), site: usize) -> Vec<PressureLine> {
    let semi_axes = model.hertz[site % 2].semi_axes(seen.forces[site]);
    let strips = seen.strips[site].filter(|_| seen.forces[site] > 0.0);
    strips.map_or_else(Vec::new, |strips| {
        strips
            .bearing(seen.approaches[site], angles[site], semi_axes)
            .lines
    })
}

/// Force of a contact that the round-off of places alone makes, N: a ball that just touches is not loaded.
fn round_off(model: &Model, side: Side) -> f64 {
    let place = 16.0 * f64::EPSILON * model.geometry.ball_centre().radial;
    model.hertz[side.index()].stiffness * place.powf(1.5)
}
