//! The new state of a part of a step, its energies and its ledger.

use contact::Side;
use ring::{ElasticStep, Ended, RingState, Works};

use super::newton::SmallSolution;
use super::part::RingSteps;
use super::run::{Motion, MovingRing};
use super::small::{SmallSystem, first_five};
use super::state::MotionState;

impl Motion<'_> {
    /// The state after a part, and its local error over the largest contact approach.
    pub(super) fn finish(
        &self,
        state: &MotionState,
        system: &SmallSystem,
        solution: &SmallSolution,
        rings: RingSteps<'_>,
        ends: [Option<Ended>; 2],
    ) -> (MotionState, f64) {
        let mut next = state.without_rings();
        let mut trend = self
            .settings
            .ladder
            .tolerance
            .map(|_| vec![[0.0; 2]; 3 * system.balls.len()]);
        let energies = ends
            .each_ref()
            .map(|end| end.as_ref().map_or([0.0; 2], |end| end.energies));
        for ((side, step), end) in Side::BOTH.into_iter().zip(rings).zip(ends) {
            let i = side.index();
            if let (Some(step), Some(end), Some(old)) = (step, end, &state.rings[i]) {
                let works = (end.works, &*step);
                self.finish_ring(&mut next, side, (system, solution), works, [old, &end.state]);
                if let Some(trend) = &mut trend {
                    let mean = mean_acceleration(&*step, [old, &end.state], system.dt);
                    let first = system.balls.len() + i;
                    for (ball, a) in mean.chunks_exact(2).enumerate() {
                        trend[first + 2 * ball] = [a[0], a[1]];
                    }
                }
                next.rings[i] = Some(end.state);
            }
        }
        self.finish_shaft(&mut next, system, solution);
        finish_balls(&mut next, system, solution);
        finish_contacts(&mut next, system, solution);
        self.note_energies(&mut next, energies);
        next.ledger.note_scale();
        let Some(mut trend) = trend else {
            return (next, 0.0);
        };
        for (b, mean) in trend.iter_mut().take(system.balls.len()).enumerate() {
            *mean = [0, 1].map(|i| (next.ball_velocities[b][i] - state.ball_velocities[b][i]) / system.dt);
        }
        let error = local_error(&trend, &state.trend, system.dt, &next.approaches);
        next.trend = trend;
        (next, error)
    }

    /// Works and losses of one ring between two states.
    fn finish_ring(
        &self,
        next: &mut MotionState,
        side: Side,
        (system, solution): (&SmallSystem, &SmallSolution),
        (works, step): (Works, &dyn ElasticStep),
        [old, new]: [&RingState; 2],
    ) {
        let Some(MovingRing { body, .. }) = &self.rings[side.index()] else {
            return;
        };
        let integrator = self.settings.integrator;
        let ledger = &mut next.ledger;
        ledger.load_work += works.load;
        ledger.frame_work += works.frame;
        if body.held().damping != [0.0; 2] {
            let loss = || body.rayleigh_loss(integrator, old, new);
            ledger.rayleigh_loss += self.costs.time("rayleigh_damping", loss);
        }
        ledger.numerical_loss += body.numerical_loss(integrator, old, new);
        if side == Side::Inner {
            // What the shaft gives in space and what the ring gets in its frame differ by the work of the turning.
            let mount = &solution.mounts[0];
            let n = 2 * system.balls.len();
            let (start, end) = (
                &step.answer().start[n..],
                system.shaft.in_frame(system.shaft_end(&solution.unknowns)),
            );
            let in_frame: f64 = (0..mount.len().min(5))
                .map(|i| mount[i] * (end[i] - start[i]))
                .sum();
            let force = system.shaft.in_space(first_five(mount));
            let (from, to) = (system.shaft.start(), system.shaft_end(&solution.unknowns));
            let in_space: f64 = (0..5).map(|i| force[i] * (to[i] - from[i])).sum();
            ledger.frame_work += in_frame - in_space;
        }
    }

    fn finish_shaft(&self, next: &mut MotionState, system: &SmallSystem, solution: &SmallSolution) {
        let end = system.shaft_end(&solution.unknowns);
        let reactions = system.shaft_reactions(solution);
        for (dof, body) in system.shaft.bodies.iter().enumerate() {
            let change = end[dof] - body.start[0];
            next.ledger.load_work += body.load * change;
            if system.shaft.imposed[dof].is_some() {
                next.ledger.imposed_work += reactions[dof] * change;
            }
            next.shaft[dof] = end[dof];
            next.ledger.numerical_loss += body.numerical_loss(system.integrator, end[dof], system.dt);
            [next.shaft_velocity[dof], next.shaft_acceleration[dof]] =
                body.update(system.integrator, end[dof], system.dt);
        }
    }

    /// Energies of a state whose rings have those found anew.
    pub(super) fn measure_energies(&self, state: &mut MotionState) {
        let energies = |i: usize| match (&self.rings[i], &state.rings[i]) {
            (Some(moving), Some(ring)) => moving.body.energies(ring),
            _ => [0.0; 2],
        };
        let (inner, outer) = self.model.backend.both(|| energies(0), || energies(1));
        self.note_energies(state, [inner, outer]);
    }

    /// Kinetic and strain energies of a state, of which those of the rings are known.
    fn note_energies(&self, state: &mut MotionState, [inner, outer]: [[f64; 2]; 2]) {
        let kinetic = |mass: f64, v: &f64| 0.5 * mass * v * v;
        let mass = self.model.ball_mass();
        let balls: f64 = state
            .ball_velocities
            .iter()
            .flatten()
            .map(|v| kinetic(mass, v))
            .sum();
        let shaft: f64 = state.shaft_velocity[..3]
            .iter()
            .map(|v| kinetic(self.model.shaft_mass, v))
            .sum();
        state.ledger.kinetic = [inner[0] + shaft, outer[0], balls];
        state.ledger.strain = [inner[1], outer[1]];
    }
}

/// Mean acceleration of the groove centres of a ring in a part, `[2 n_balls]`, m/s^2.
fn mean_acceleration(step: &dyn ElasticStep, [old, new]: [&RingState; 2], dt: f64) -> Vec<f64> {
    let change = new.velocity().iter().zip(old.velocity());
    let change: Vec<f64> = change.map(|(a, b)| (a - b) / dt).collect();
    step.at_contacts(&change)
}

/// Local error of the last part over the largest contact approach: dt^2/12 times the change of the mean accelerations, the
/// leading term of average acceleration.
fn local_error(new: &[[f64; 2]], old: &[[f64; 2]], dt: f64, approaches: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
    // After a start from undeformed bodies there is no earlier acceleration: no estimate.
    let change = |i: usize, c: usize| {
        if old[i][c].is_nan() {
            0.0
        } else {
            new[i][c] - old[i][c]
        }
    };
    let change = largest(&mut (0..new.len()).flat_map(|i| [change(i, 0), change(i, 1)]));
    let scale = largest(&mut approaches.iter().copied());
    if scale > 0.0 {
        dt * dt / 12.0 * change / scale
    } else {
        0.0
    }
}

/// State and work of the balls.
fn finish_balls(next: &mut MotionState, system: &SmallSystem, solution: &SmallSolution) {
    let (scheme, dt) = (system.integrator, system.dt);
    for (b, bodies) in system.balls.iter().enumerate() {
        for (i, body) in bodies.iter().enumerate() {
            let x = solution.unknowns[system.ball_index(b) + i];
            next.ledger.load_work += body.load_at(scheme, x) * (x - body.start[0]);
            next.ledger.numerical_loss += body.numerical_loss(scheme, x, dt);
            next.balls[b][i] = x;
            [next.ball_velocities[b][i], next.ball_accelerations[b][i]] = body.update(scheme, x, dt);
        }
    }
}

fn finish_contacts(next: &mut MotionState, system: &SmallSystem, solution: &SmallSolution) {
    let (mut start, mut end) = (0.0, 0.0);
    for (index, site) in system.sites.iter().enumerate() {
        let [l0, l1] = system.reach(site, &solution.unknowns);
        let at = |l: [f64; 2]| site.law.evaluate(l[0].hypot(l[1]) - site.touching);
        let last = at(l1);
        start += at(l0).energy;
        end += last.energy;
        next.approaches[index] = last.approach;
        let sign = site.side.sign();
        next.angles[index] = (sign * l1[1]).atan2(sign * l1[0]);
        next.forces[index] = solution.forces[index].force;
        next.ledger.contact_loss += solution.forces[index].loss;
        next.ledger.numerical_loss += solution.forces[index].numerical_loss;
        if let Some(extra) = system.extra.get(index) {
            // On the ring and, with the opposite sign, on the ball.
            next.ledger.load_work -= extra[0] * (l1[0] - l0[0]) + extra[1] * (l1[1] - l0[1]);
        }
    }
    next.ledger.patch_work += start - next.ledger.hertz;
    next.ledger.hertz = end;
}

impl SmallSystem {
    /// Forces that hold or drive the shaft's dofs, N and N m; zero to round-off for free ones.
    fn shaft_reactions(&self, solution: &SmallSolution) -> [f64; 5] {
        let end = self.shaft_end(&solution.unknowns);
        let mut reactions =
            [0, 1, 2, 3, 4].map(|i| self.shaft.bodies[i].residual(self.integrator, end[i], self.dt)[0]);
        if self.rings[0].is_some() {
            let force = self.shaft.in_space(first_five(&solution.mounts[0]));
            (0..5).for_each(|i| reactions[i] += force[i]);
            return reactions;
        }
        let loads = self.ring_loads(Side::Inner, solution);
        for site in self.sites.iter().filter(|s| s.side == Side::Inner) {
            let force = &loads[2 * site.ball..2 * site.ball + 2];
            for (reaction, row) in reactions.iter_mut().zip(site.shaft_rows()) {
                *reaction -= row[0] * force[0] + row[1] * force[1];
            }
        }
        reactions
    }
}
