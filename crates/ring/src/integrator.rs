//! The generalised-alpha family of one-step schemes (Chung and Hulbert, J. Appl. Mech. 60 (1993) 371,
//! doi:10.1115/1.2900803).
//!
//! Balance: M a[1-am] + C v[1-af] + K w[1-af] = f, where x[1-s] = (1-s) x1 + s x0; Newmark: w1 = w0 + dt v0 + dt^2
//! ((1/2-beta) a0 + beta a1), v1 = v0 + dt ((1-gamma) a0 + gamma a1). Contact forces are means over the step, moved
//! to the weighted time (`dynamics::interactions::discrete_gradient`). With am = af = 1/2, beta = 1/4, gamma = 1/2
//! this is the midpoint rule, which conserves the energy of a linear body exactly. Damping of contacts and the inertia
//! of free tilts are not moved: with them only schemes with e = 0, below, are of second order.
//!
//! **What the schemes lose.** Newmark with gamma = 1/2 + d > 1/2 is taken in the equivalent form
//! ([`Integrator::newmark`])
//!
//! ```text
//! w1 - w0 = dt (v_mean + k (v1 - v0)),   M (v1 - v0)/dt + K w_mean + e K (w1 - w0) + F + e (F1 - F0) = f
//! k + e = d,   k e = beta - gamma / 2
//! ```
//!
//! which takes k |v1 - v0|^2 of M, e |w1 - w0|^2 of K and e (F1 - F0) (l1 - l0) of the contacts in a step: never less
//! than nothing, whatever opens and closes, as long as k and e are not negative, gamma / 2 <= beta <= (gamma + 1/2)^2
//! / 4. The second-order schemes remember an acceleration, so the energy itself may rise for a while. With d = af -
//! am, e = 1/2 - af and c = a + M^-1 (K w - f) the part of a that is not the acceleration of the forces, a linear
//! body loses in the norm
//!
//! ```text
//! E + dt^2 M [ (x - e^2) a^2 / 2 + e v c / dt + e^2 c a + x e c^2 / (2 d) ],   x = (e + d/2)^2
//! ```
//!
//! exactly dt^2 (x / d) |c_mean|^2 of M in a step (checked by a test). For contacts the same holds but for the
//! difference between the mean of the forces at both ends and the discrete gradient, of second order in the change of
//! the approach.

/// Parameters of the scheme.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integrator {
    /// Weight of the old acceleration.
    pub alpha_m: f64,
    /// Weight of the old displacement and velocity.
    pub alpha_f: f64,
    /// Newmark's beta.
    pub beta: f64,
    /// Newmark's gamma.
    pub gamma: f64,
    /// Share of dt^2 a0 in the displacement, 1/2 - beta, and of dt a0 in the velocity, 1 - gamma; 0 when a is the
    /// mean acceleration.
    pub old: [f64; 2],
}

/// A scheme and its step size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepScheme {
    /// The scheme.
    pub integrator: Integrator,
    /// Step size, s.
    pub dt: f64,
}

impl Integrator {
    /// Average acceleration in its energy-conserving (midpoint) form: Chung-Hulbert with rho = 1.
    pub fn average_acceleration() -> Integrator {
        Integrator::chung_hulbert(1.0)
    }

    /// Whether the scheme conserves the energy of a linear body; the others lose some on purpose.
    pub fn is_conserving(&self) -> bool {
        *self == Integrator::average_acceleration()
    }

    /// Chung-Hulbert with spectral radius `rho` at infinite frequency, 0..=1; second order.
    pub fn chung_hulbert(rho: f64) -> Integrator {
        Integrator::second_order((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0))
    }

    /// HHT-alpha, `alpha` in 0..=1/3 (minus the alpha of Hilbert, Hughes and Taylor 1977); second order.
    pub fn hht(alpha: f64) -> Integrator {
        Integrator::second_order(0.0, alpha)
    }

    /// Newmark; second order only for gamma = 1/2, where balance is the mean of the balances at both ends: the same
    /// scheme for linear bodies, and contacts then exchange exactly the energy that they store. With gamma > 1/2 it
    /// is written with the mean acceleration of a step, which again changes nothing for linear bodies, and the energy
    /// falls monotonically with any contacts, for gamma / 2 <= beta <= (gamma + 1/2)^2 / 4. There is no such form for
    /// a larger beta: it counts as the largest.
    pub fn newmark(beta: f64, gamma: f64) -> Integrator {
        let excess = gamma - 0.5;
        if excess == 0.0 {
            return Integrator::with_memory([0.5, 0.5], beta, gamma);
        }
        // k and e of the module's text, k the larger.
        let root = ((1.0 + excess) * (1.0 + excess) - 4.0 * beta).max(0.0).sqrt();
        let (k, e) = (0.5 * (excess + root), 0.5 * (excess - root));
        Integrator {
            alpha_m: 0.0,
            alpha_f: 0.5 - e,
            beta: 0.5 + k,
            gamma: 1.0,
            old: [0.0; 2],
        }
    }

    fn second_order(alpha_m: f64, alpha_f: f64) -> Integrator {
        let root = 1.0 - alpha_m + alpha_f;
        Integrator::with_memory([alpha_m, alpha_f], 0.25 * root * root, root - 0.5)
    }

    /// The family of Chung and Hulbert: [am, af], beta, gamma.
    fn with_memory([alpha_m, alpha_f]: [f64; 2], beta: f64, gamma: f64) -> Integrator {
        Integrator {
            alpha_m,
            alpha_f,
            beta,
            gamma,
            old: [0.5 - beta, 1.0 - gamma],
        }
    }

    /// Coefficients of M, C and K in the effective matrix S at step size `dt`.
    pub fn effective(&self, dt: f64) -> [f64; 3] {
        let (m, f) = (1.0 - self.alpha_m, 1.0 - self.alpha_f);
        [m / (self.beta * dt * dt), f * self.gamma / (self.beta * dt), f]
    }

    /// Coefficients of v0 and a0 in the vectors that M and C multiply on the right-hand side of S dw.
    pub fn history(&self, dt: f64) -> [[f64; 2]; 2] {
        let (m, f) = (1.0 - self.alpha_m, 1.0 - self.alpha_f);
        let (b, g, [in_w, in_v]) = (self.beta, self.gamma, self.old);
        let mass = [m / (b * dt), m * in_w / b - self.alpha_m];
        let damping = [f * (g / b - 1.0) - self.alpha_f, f * dt * (g * in_w / b - in_v)];
        [mass, damping]
    }

    /// Weighted acceleration a[1-am] of a step with displacement increment `dw`, and its derivative with respect to it.
    pub fn weighted_acceleration(&self, dt: f64, dw: f64, v0: f64, a0: f64) -> [f64; 2] {
        let (m, slope) = (1.0 - self.alpha_m, 1.0 / (self.beta * dt * dt));
        let old = self.alpha_m - m * self.old[0] / self.beta;
        [m * slope * (dw - dt * v0) + old * a0, m * slope]
    }

    /// Velocity and acceleration at the end of a step with displacement increment `dw`.
    pub fn update(&self, dt: f64, dw: f64, v0: f64, a0: f64) -> [f64; 2] {
        // Of many numbers the quotients are found once.
        let (rate, share) = (1.0 / (self.beta * dt * dt), self.old[0] / self.beta);
        self.ended(dt, v0, a0, (dw - dt * v0) * rate - share * a0)
    }

    /// Velocity and acceleration at the end of a step with the weighted acceleration `mean`.
    pub fn update_by(&self, dt: f64, mean: f64, v0: f64, a0: f64) -> [f64; 2] {
        self.ended(dt, v0, a0, (mean - self.alpha_m * a0) / (1.0 - self.alpha_m))
    }

    /// Velocity and acceleration at the end of a step, of which the acceleration is `a1`.
    fn ended(&self, dt: f64, v0: f64, a0: f64, a1: f64) -> [f64; 2] {
        [v0 + dt * (self.old[1] * a0 + self.gamma * a1), a1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error at t = 1 of w'' + 2 z p w' + p^2 w = 0, w(0) = 1, w'(0) = 0.
    fn error(scheme: Integrator, damping: f64, n: usize) -> f64 {
        let (p, dt) = (5.0f64, 1.0 / n as f64);
        let (m, c, k) = (1.0, 2.0 * damping * p, p * p);
        let [sm, sc, sk] = scheme.effective(dt);
        let s = sm * m + sc * c + sk * k;
        let (mut w, mut v, mut a) = (1.0, 0.0, -k);
        for _ in 0..n {
            let [[mv, ma], [cv, ca]] = scheme.history(dt);
            let dw = (-k * w + m * (mv * v + ma * a) + c * (cv * v + ca * a)) / s;
            [v, a] = scheme.update(dt, dw, v, a);
            w += dw;
        }
        let q = p * (1.0 - damping * damping).sqrt();
        let exact = (-damping * p).exp() * (q.cos() + damping * p / q * q.sin());
        (w - exact).abs()
    }

    /// Wrong: a setting would not have its order. Damped and undamped oscillator, step halved.
    #[test]
    fn every_setting_has_its_order() {
        let settings = [
            (Integrator::average_acceleration(), 2.0),
            (Integrator::chung_hulbert(0.8), 2.0),
            (Integrator::chung_hulbert(0.0), 2.0),
            (Integrator::hht(0.1), 2.0),
            (Integrator::newmark(0.25, 0.5), 2.0),
            (Integrator::newmark(0.3025, 0.6), 1.0),
        ];
        for (scheme, order) in settings {
            for damping in [0.0, 0.1] {
                let rate = (error(scheme, damping, 200) / error(scheme, damping, 400)).log2();
                assert!(
                    (rate - order).abs() < 0.1,
                    "{scheme:?} at damping {damping}: order {rate}, not {order}"
                );
            }
        }
    }

    /// Wrong: the midpoint rule would not conserve the energy of a linear oscillator.
    #[test]
    fn average_acceleration_conserves_energy() {
        let (scheme, dt, k) = (Integrator::average_acceleration(), 0.3, 25.0);
        let [sm, _, sk] = scheme.effective(dt);
        let (mut w, mut v, mut a) = (1.0, 0.0, -k);
        for _ in 0..1000 {
            let [[mv, ma], _] = scheme.history(dt);
            let dw = (-k * w + mv * v + ma * a) / (sm + sk * k);
            [v, a] = scheme.update(dt, dw, v, a);
            w += dw;
            assert!((0.5 * v * v + 0.5 * k * w * w - 12.5).abs() < 1e-11);
        }
    }

    /// Wrong: Newmark without numerical damping would be another scheme than average acceleration, and contacts would
    /// gain energy with it.
    #[test]
    fn newmark_without_damping_is_average_acceleration() {
        assert!(Integrator::newmark(0.25, 0.5).is_conserving());
    }

    /// Displacements of w'' + p^2 w = 0, w(0) = 1, w'(0) = 0, over `n` steps of 1.
    fn oscillation(scheme: Integrator, p: f64, n: usize) -> Vec<f64> {
        let (k, [sm, _, sk]) = (p * p, scheme.effective(1.0));
        // The mean-acceleration form remembers no acceleration, so its start does not matter.
        let (mut w, mut v, mut a) = (1.0, 0.0, -k);
        let step = |_| {
            let [[mv, ma], _] = scheme.history(1.0);
            let dw = (-k * w + mv * v + ma * a) / (sm + sk * k);
            [v, a] = scheme.update(1.0, dw, v, a);
            w += dw;
            w
        };
        (0..n).map(step).collect()
    }

    /// Wrong: damped Newmark would be another scheme than Newmark's. Its recurrence over three displacements, (1 + b
    /// q) w2 + ((1/2 + g - 2 b) q - 2) w1 + (1 + (1/2 - g + b) q) w0 = 0 with q = (p dt)^2 (Hughes, The Finite
    /// Element Method, 1987, 9.1), holds to round-off.
    #[test]
    fn damped_newmark_has_newmarks_recurrence() {
        for (beta, gamma) in [
            (0.3025, 0.6),
            (0.3, 0.6),
            (0.5625, 1.0),
            (0.26, 0.5),
            (0.275, 0.55),
        ] {
            for p in [0.01, 1.0, 30.0] {
                let w = oscillation(Integrator::newmark(beta, gamma), p, 40);
                let q = p * p;
                for t in w.windows(3) {
                    let terms = [
                        (1.0 + beta * q) * t[2],
                        ((0.5 + gamma - 2.0 * beta) * q - 2.0) * t[1],
                        (1.0 + (0.5 - gamma + beta) * q) * t[0],
                    ];
                    let size = terms.iter().fold(1e-300, |m: f64, x| m.max(x.abs()));
                    let sum: f64 = terms.iter().sum();
                    assert!(
                        sum.abs() < 1e-12 * size,
                        "{beta} {gamma} {p}: {sum:e} of {size:e}"
                    );
                }
            }
        }
    }

    /// Wrong: an integrator could feed energy into a linear body, and the norm in which it loses would not be that of
    /// the module's text. Every step takes exactly dt^2 (x / d) |c_mean|^2, from any start, at any frequency.
    #[test]
    fn second_order_schemes_lose_in_their_norm_at_every_step() {
        let schemes = [
            Integrator::chung_hulbert(0.9),
            Integrator::chung_hulbert(0.5),
            Integrator::chung_hulbert(0.0),
            Integrator::hht(0.05),
            Integrator::hht(1.0 / 3.0),
        ];
        for scheme in schemes {
            let (d, e) = (scheme.alpha_f - scheme.alpha_m, 0.5 - scheme.alpha_f);
            let x = (e + 0.5 * d) * (e + 0.5 * d);
            for (dt, k) in [(0.01, 1.0), (0.5, 3.0), (1.0, 1e3), (2.0, 1e6)] {
                let norm = |[w, v, a]: [f64; 3]| {
                    let c = a + k * w;
                    let memory =
                        0.5 * (x - e * e) * a * a + e * v * c / dt + e * e * c * a + 0.5 * x * e / d * c * c;
                    (0.5 * (v * v + k * w * w) + dt * dt * memory, c)
                };
                let [sm, _, sk] = scheme.effective(dt);
                // An acceleration that no force explains, too.
                let mut s = [1.0, -0.3, 0.7 * k];
                for _ in 0..40 {
                    let [[mv, ma], _] = scheme.history(dt);
                    let dw = (-k * s[0] + mv * s[1] + ma * s[2]) / (sm + sk * k);
                    let [v, a] = scheme.update(dt, dw, s[1], s[2]);
                    let new = [s[0] + dw, v, a];
                    let ((before, c0), (after, c1)) = (norm(s), norm(new));
                    let mean = 0.5 * (c0 + c1);
                    let lost = dt * dt * x / d * mean * mean;
                    let off = before - after - lost;
                    assert!(
                        after <= before * (1.0 + 1e-12),
                        "{scheme:?} {k}: {before:e} {after:e}"
                    );
                    assert!(
                        off.abs() < 1e-10 * before,
                        "{scheme:?} {k}: {off:e} of {before:e}"
                    );
                    s = new;
                }
            }
        }
    }

    /// Wrong: `rho` would not be the damping of the highest frequencies per step.
    #[test]
    fn high_frequencies_decay_by_rho() {
        for rho in [0.5, 0.8] {
            let scheme = Integrator::chung_hulbert(rho);
            let k = 1e12;
            let [sm, _, sk] = scheme.effective(1.0);
            let (mut w, mut v, mut a) = (1.0, 0.0, -k);
            let mut sizes = Vec::new();
            for _ in 0..=60 {
                let [[mv, ma], _] = scheme.history(1.0);
                let dw = (-k * w + mv * v + ma * a) / (sm + sk * k);
                [v, a] = scheme.update(1.0, dw, v, a);
                w += dw;
                sizes.push(a.abs().max(k * w.abs()));
            }
            // The double root at infinity adds a factor that grows with the step number only.
            let decay = (sizes[60] / sizes[40]).powf(0.05);
            assert!((decay - rho).abs() < 0.05, "{rho}: {decay}");
        }
    }
}
