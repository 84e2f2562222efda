//! A ball that rolls steadily under friction: what bearing engineers call a quasi-dynamic equilibrium.
//!
//! In the meridian frame (e_r, t = e_psi, e_z) that goes round with the ball, place, velocity and angular velocity of
//! the ball stand. Unknowns are the speed w_c round the axis and the turning (w_r, w_t, w_z). With n_k the normal of
//! contact k, from the ball's centre to the raceway, q_k = n_k x t, c_k the lever, and d the distance from the axis,
//!
//! ```text
//! slip           s_t = w_c d + c (w_z n_r - w_r n_z) - W_k (d + c n_r),   s_q = -c w_t
//! turning        dw = w - W_k e_z, in the frame (t, q, n)
//! round the axis F_t (both contacts) = drag |w_c d| w_c d
//! moments        M = J w_c e_z x w = J w_c (-w_t, w_r, 0)
//! ```
//!
//! Forces are those of [`super::traction`] over the ellipse, or over strips. The gyroscopic moment J w_c w_r is what
//! lateral tractions carry. Rates of the ball's place are left out, as is the wobble of a tilted ring along its groove.
//!
//! Solved by Newton's method on the motion towards the steady state: implicit Euler steps of the ball's own inertia,
//! which grow as the residual falls (pseudo-transient continuation; Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998)
//! 508). Where the way leads over larger moments, as where friction falls with slip and the axis of the ball turns far,
//! the motion itself is followed: steps are as long as their equations hold. Where only one contact is loaded nothing
//! drives the ball round: a cage does, at a given speed.
//!
//! Cost: two tractions over 45 places per step, some tens of steps.

use contact::film::FilmContact;
use dense::DenseLu;

use super::traction::creep::RollingContact;
use super::traction::{Ellipse, PatchPoints, Resultant, Slip, Traction};
use crate::model::BallInertia;

/// A contact of a ball that rolls steadily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyContact {
    /// Normal [radial, axial], from the ball's centre to the raceway.
    pub normal: [f64; 2],
    /// Lever c, m.
    pub lever: f64,
    /// Normal force, N.
    pub force: f64,
    /// The ellipse; its film follows from how the ball rolls.
    pub ellipse: Ellipse,
    /// The contact as its film sees it.
    pub film: FilmContact,
    /// Speed of the ring, rad/s.
    pub speed: f64,
    /// Combined shear modulus, Pa.
    pub shear_modulus: f64,
}

/// A ball that rolls steadily.
#[derive(Clone, Debug)]
pub struct SteadyBall<'t> {
    /// Distance from the axis, m.
    pub out: f64,
    /// Its inertia.
    pub inertia: BallInertia,
    /// Drag over the square of the speed, N s^2/m^2.
    pub drag: f64,
    /// Its contacts, inner first.
    pub contacts: [SteadyContact; 2],
    /// Traction.
    pub traction: &'t Traction,
    /// Its places at contacts on strips; None: those of the ellipse.
    pub on_strips: [Option<PatchPoints>; 2],
}

/// How a ball rolls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SteadyRolling {
    /// Speed round the axis, rad/s.
    pub orbit: f64,
    /// Turning about e_r, e_psi, e_z, rad/s.
    pub turning: [f64; 3],
    /// Traction on the ball.
    pub tractions: [Resultant; 2],
    /// The slip that it follows.
    pub slips: [Slip; 2],
    /// Distance from the axis, m.
    pub out: f64,
}

impl SteadyRolling {
    /// Speed round the axis and turning, rad/s.
    pub fn rates(&self) -> [f64; N] {
        let [radial, round, axial] = self.turning;
        [self.orbit, radial, round, axial]
    }
}

/// Unknowns: speed round the axis, turning about e_r, e_psi, e_z.
const N: usize = 4;
/// Residual over the scale of the forces at which a ball rolls steadily.
const TOLERANCE: f64 = 1e-12;
/// The same where it no longer falls.
const ACCEPTED: f64 = 1e-8;
/// Steps before giving up.
const MOST_STEPS: usize = 400;
/// Factor of the slip of creep from which the way to a steady state that is far away begins, by which it falls, and the
/// least such factor.
const SOFTEST: f64 = 3000.0;
const SOFTER: f64 = 3.0;
const LEAST_SOFTER: f64 = 1.001;
/// First step, s, the longest, with which inertia is nothing, and the least.
const FIRST_STEP: f64 = 1e-4;
const LONGEST_STEP: f64 = 1e6;
const LEAST_STEP: f64 = 1e-14;
/// Growth of the residual beyond which a step is taken again, shorter.
const GROWTH: f64 = 1.5;
/// Of steps that follow the motion: most of them, the first one, s, what may be left of the moments at its start, and
/// by what it is shortened and lengthened.
const MOST_FOLLOWED: usize = 1000;
const FIRST_FOLLOWED: f64 = 1e-6;
const LEFT: f64 = 0.3;
const SHORTER: f64 = 0.3;
const LONGER: [f64; 2] = [1.2, 2.0];
/// Passes for the speed of rolling, on which the slope at small slip depends.
const CREEP_PASSES: usize = 4;

impl SteadyBall<'_> {
    /// How the ball rolls; None where nothing turns, friction is zero, or no contact is loaded, and where one contact
    /// alone is without a `cage`, which drives the ball round the axis at a given speed, rad/s. The error is the
    /// residual that stays.
    pub fn solve(&self, cage: Option<f64>) -> Result<Option<SteadyRolling>, f64> {
        let loaded = self.contacts.iter().filter(|contact| contact.force > 0.0).count();
        let is_still = self.contacts.iter().all(|contact| contact.speed == 0.0);
        if loaded == 0 || is_still || self.traction.law.at(0.0)[0].max(self.largest_coefficient()) == 0.0 {
            return Ok(None);
        }
        if loaded == 1 && cage.is_none() {
            return Ok(None);
        }
        let (mut y, held) = (self.pure_rolling(), cage.is_some());
        y[0] = cage.unwrap_or(y[0]);
        for _ in 0..CREEP_PASSES {
            let filmed = self.with_films(&y);
            let found = filmed.settle(y, filmed.small_slips(&y), held)?;
            let change = (0..N).map(|i| (found[i] - y[i]).abs()).fold(0.0, f64::max);
            y = found;
            if change <= TOLERANCE * y[N - 1].abs() {
                break;
            }
        }
        let (filmed, small) = (self.with_films(&y), self.small_slips(&y));
        let tractions = [0, 1].map(|k| filmed.traction_at(k, &y, small[k]));
        Ok(Some(SteadyRolling {
            orbit: y[0],
            turning: [y[1], y[2], y[3]],
            tractions: tractions.map(|(traction, _)| traction),
            slips: tractions.map(|(_, slip)| slip),
            out: self.out,
        }))
    }

    /// Rolling without slip at the centres of both contacts, with spin shared half and half.
    pub fn pure_rolling(&self) -> [f64; N] {
        let [inner, outer] = &self.contacts;
        pure_rolling(
            self.out,
            [inner.lever, outer.lever],
            [inner.normal, outer.normal],
            [inner.speed, outer.speed],
        )
    }

    fn largest_coefficient(&self) -> f64 {
        // Any slip of a bearing: a coefficient that vanishes at rest may grow with it.
        [1e-3, 1e-2, 0.1, 1.0, 10.0]
            .map(|slip| self.traction.law.at(slip)[0])
            .into_iter()
            .fold(0.0, f64::max)
    }

    fn rolling_speed(&self, contact: &SteadyContact, y: &[f64; N]) -> f64 {
        rolling_speed(self.out, (contact.lever, contact.normal), *y, contact.speed)
    }

    /// The same ball with films of contacts that roll so.
    fn with_films(&self, y: &[f64; N]) -> Self {
        let with_film = |contact: SteadyContact| {
            let speed = self.rolling_speed(&contact, y);
            let film = self.traction.law.film(|| contact.film, speed, contact.force);
            let ellipse = Ellipse {
                film,
                ..contact.ellipse
            };
            SteadyContact { ellipse, ..contact }
        };
        SteadyBall {
            contacts: self.contacts.map(with_film),
            ..self.clone()
        }
    }

    /// Slip below which force grows in proportion to it, of both contacts.
    fn small_slips(&self, y: &[f64; N]) -> [f64; 2] {
        self.contacts.map(|contact| {
            let rolling = RollingContact {
                speed: self.rolling_speed(&contact, y),
                force: contact.force,
                semi_axes: contact.ellipse.semi_axes,
                shear_modulus: contact.shear_modulus,
            };
            self.traction.creep.slip(self.traction.law.at(0.0)[0], &rolling)
        })
    }

    /// Growth of slip and turning at a contact with the unknowns.
    fn rows(&self, k: usize) -> [[f64; N]; 5] {
        let SteadyContact {
            normal: [n_r, n_z],
            lever: c,
            ..
        } = self.contacts[k];
        [
            [self.out, -c * n_z, 0.0, c * n_r],
            [0.0, 0.0, -c, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, -n_z, 0.0, n_r],
            [0.0, n_r, 0.0, n_z],
        ]
    }

    fn traction_at(&self, k: usize, y: &[f64; N], small: f64) -> (Resultant, Slip) {
        let contact = &self.contacts[k];
        let [n_r, n_z] = contact.normal;
        let of_ring = [
            contact.speed * (self.out + contact.lever * n_r),
            0.0,
            0.0,
            contact.speed * n_r,
            contact.speed * n_z,
        ];
        let rows = self.rows(k);
        let at = |i: usize| (0..N).map(|j| rows[i][j] * y[j]).sum::<f64>() - of_ring[i];
        let slip = Slip {
            centre: [at(0), at(1)],
            turning: [at(2), at(3), at(4)],
        };
        if contact.force <= 0.0 {
            return (Resultant::default(), slip);
        }
        let load = (contact.force, small);
        let found = self.on_strips[k]
            .as_ref()
            .unwrap_or(&self.traction.places)
            .traction(&self.traction.law, &contact.ellipse, &slip, load);
        (found, slip)
    }

    /// Moments about the axis and about the ball's centre that are out of balance, and their growth.
    fn residual(&self, y: &[f64; N], small: [f64; 2]) -> ([f64; N], [[f64; N]; N]) {
        let (mut sum, mut slope) = ([0.0; N], [[0.0; N]; N]);
        for (k, small) in small.into_iter().enumerate() {
            let (found, _) = self.traction_at(k, y, small);
            let rows = self.rows(k);
            for a in 0..N {
                sum[a] += (0..5).map(|i| rows[i][a] * found.action[i]).sum::<f64>();
                for b in 0..N {
                    let of = |i: usize| (0..5).map(|j| found.slope[i][j] * rows[j][b]).sum::<f64>();
                    slope[a][b] += (0..5).map(|i| rows[i][a] * of(i)).sum::<f64>();
                }
            }
        }
        let moment = self.inertia.moment;
        let [orbit, radial, rolling, _] = *y;
        let speed = orbit * self.out;
        sum[0] -= self.drag * speed.abs() * speed * self.out;
        slope[0][0] -= 2.0 * self.drag * speed.abs() * self.out * self.out;
        sum[1] += moment * orbit * rolling;
        slope[1][0] += moment * rolling;
        slope[1][2] += moment * orbit;
        sum[2] -= moment * orbit * radial;
        slope[2][0] -= moment * radial;
        slope[2][1] -= moment * orbit;
        (sum, slope)
    }

    /// The steady state from `y`, led by creep that is softer at first, in steps as large as it bears; `held` keeps the
    /// speed round the axis.
    fn settle(&self, mut y: [f64; N], small: [f64; 2], held: bool) -> Result<[f64; N], f64> {
        let from = y;
        let mut last = self.step_on(y, small, held);
        let (mut soft, mut step) = (SOFTEST * SOFTER, SOFTER);
        while last.is_err() && step > LEAST_SOFTER {
            let next = (soft / step).max(1.0);
            match self.step_on(y, small.map(|slip| next * slip), held) {
                Ok(found) if next == 1.0 => last = Ok(found),
                Ok(found) => (y, soft, step) = (found, next, (step * step).min(SOFTER)),
                Err(left) => (last, step) = (Err(left), step.sqrt()),
            }
        }
        last.or_else(|left| self.follow(from, small, held).ok_or(left))
    }

    /// The steady state to which the ball comes from `y` by its own motion; None where it does not settle.
    fn follow(&self, mut y: [f64; N], small: [f64; 2], held: bool) -> Option<[f64; N]> {
        let inertia = self.inertias();
        let (mut residual, mut slope) = self.residual(&y, small);
        let (mut dt, mut best, mut stalled) = (FIRST_FOLLOWED, f64::INFINITY, 0);
        for _ in 0..MOST_FOLLOWED {
            let now = self.size(&residual, held);
            if now <= TOLERANCE || (stalled > 6 && now <= ACCEPTED) {
                return Some(y);
            }
            let rates = inertia.map(|i| i / dt);
            let taken = implicit_step(&residual, &slope, &rates, held).and_then(|step| {
                let next: [f64; N] = std::array::from_fn(|i| y[i] + step[i]);
                let (found, growth) = self.residual(&next, small);
                let defect = std::array::from_fn(|i| rates[i] * step[i] - found[i]);
                let left = self.size(&defect, held) / now;
                (left <= LEFT).then_some((next, found, growth, left))
            });
            let Some((next, found, growth, left)) = taken else {
                dt *= SHORTER;
                if dt < LEAST_STEP {
                    return None;
                }
                stalled += 1;
                continue;
            };
            dt = (dt * LONGER[usize::from(left < 0.1 * LEFT)]).min(LONGEST_STEP);
            stalled = if now < 0.5 * best { 0 } else { stalled + 1 };
            best = best.min(now);
            (y, residual, slope) = (next, found, growth);
        }
        None
    }

    fn inertias(&self) -> [f64; N] {
        let BallInertia { mass, moment } = self.inertia;
        [mass * self.out * self.out, moment, moment, moment]
    }

    /// Steps of the ball's inertia towards the steady state from `y`.
    fn step_on(&self, mut y: [f64; N], small: [f64; 2], held: bool) -> Result<[f64; N], f64> {
        let inertia = self.inertias();
        let (mut residual, mut slope) = self.residual(&y, small);
        let mut now = self.size(&residual, held);
        let (mut dt, mut best, mut stalled) = (FIRST_STEP, now, 0);
        for _ in 0..MOST_STEPS {
            if now <= TOLERANCE || (stalled > 6 && best <= ACCEPTED) {
                return Ok(y);
            }
            let Some(step) = implicit_step(&residual, &slope, &inertia.map(|i| i / dt), held) else {
                dt *= 0.1;
                continue;
            };
            let next: [f64; N] = std::array::from_fn(|i| y[i] + step[i]);
            let (found, growth) = self.residual(&next, small);
            let after = self.size(&found, held);
            if !after.is_finite() || after > GROWTH * now {
                dt *= 0.2;
                if dt < LEAST_STEP {
                    break;
                }
                continue;
            }
            dt = (dt * (now / after.max(f64::MIN_POSITIVE)).clamp(0.5, 10.0) * 2.0).min(LONGEST_STEP);
            (y, residual, slope) = (next, found, growth);
            stalled = if after < 0.5 * best { 0 } else { stalled + 1 };
            (now, best) = (after, best.min(after));
        }
        if now <= ACCEPTED { Ok(y) } else { Err(best) }
    }

    /// Largest moment out of balance over the scale of the forces.
    fn size(&self, r: &[f64; N], held: bool) -> f64 {
        let first = if held {
            0.0
        } else {
            r[0].abs() / self.out * self.contacts[0].lever
        };
        r[1..].iter().fold(first, |most, r| most.max(r.abs())) / self.moment_scale()
    }

    /// Moment, N m, with which residuals are compared: of the larger normal force at the ball's radius.
    fn moment_scale(&self) -> f64 {
        let force = self.contacts.iter().fold(0.0, |most: f64, c| most.max(c.force));
        force * self.contacts[0].lever
    }
}

impl SteadyRolling {
    /// Torque about the axis with which traction turns the ball at a contact with this normal and lever, N m.
    pub fn torque(&self, contact: &SteadyContact, side: usize) -> f64 {
        let ([n_r, n_z], a) = (contact.normal, self.tractions[side].action);
        a[0] * (self.out + contact.lever * n_r) + a[3] * n_r + a[4] * n_z
    }

    /// Power lost at a contact, W.
    pub fn power(&self, side: usize) -> f64 {
        -self.tractions[side].power
    }
}

/// An implicit Euler step: (inertia/dt - slope) step = residual; `held` keeps the first unknown.
fn implicit_step(
    residual: &[f64; N],
    slope: &[[f64; N]; N],
    inertia: &[f64; N],
    held: bool,
) -> Option<[f64; N]> {
    let mut matrix = [0.0; N * N];
    for a in 0..N {
        for b in 0..N {
            matrix[N * a + b] = -slope[a][b];
        }
        matrix[(N + 1) * a] += inertia[a];
    }
    let mut step = *residual;
    if held {
        matrix[..N].copy_from_slice(&[1.0, 0.0, 0.0, 0.0]);
        step[0] = 0.0;
    }
    DenseLu::factor(N, &matrix).ok()?.solve(&mut step, 1);
    Some(step)
}

/// Speed round the axis and turning about e_r, e_psi, e_z, rad/s, of a ball at a distance `out` from the axis that
/// rolls without slip at the centres of both contacts and spins as much on either.
pub fn pure_rolling(out: f64, levers: [f64; 2], normals: [[f64; 2]; 2], speeds: [f64; 2]) -> [f64; N] {
    let slip = |k: usize| {
        let [n_r, n_z] = normals[k];
        (
            [out, -levers[k] * n_z, levers[k] * n_r],
            speeds[k] * (out + levers[k] * n_r),
        )
    };
    let ((a, p), (b, q)) = (slip(0), slip(1));
    let c = [0.0, normals[0][0] - normals[1][0], normals[0][1] - normals[1][1]];
    let r = speeds[0] * normals[0][1] - speeds[1] * normals[1][1];
    let [orbit, radial, axial] = solve([a, b, c], [p, q, r]);
    [orbit, radial, 0.0, axial]
}

/// Speed with which material runs through a contact, m/s: mean of both surfaces, seen from the contact. Of a ball as in
/// [`pure_rolling`], with speeds as that gives them, on a ring of a speed, rad/s.
pub fn rolling_speed(
    out: f64,
    (lever, [n_r, n_z]): (f64, [f64; 2]),
    [orbit, radial, _, axial]: [f64; N],
    ring: f64,
) -> f64 {
    let at = out + lever * n_r;
    let of_ball = orbit * out + lever * (axial * n_r - radial * n_z) - orbit * at;
    0.5 * (of_ball + (ring - orbit) * at)
}

/// Solves three equations by Cramer's rule.
fn solve(rows: [[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let all = det(rows);
    [0, 1, 2].map(|column| {
        let mut with = rows;
        for (row, value) in with.iter_mut().zip(right) {
            row[column] = value;
        }
        det(with) / all
    })
}
