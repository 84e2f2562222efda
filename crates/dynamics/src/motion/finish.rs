//! The new state of a part of a step, its energies and its ledger.

use contact::{BySide, Meridian, Side};
use ring::{ElasticStep, Ended, RingState, StepScheme, Works};

use super::ledger::Ledger;
use super::part::RingSteps;
use super::run::{Motion, MovingRing};
use super::solve::StepSolution;
use super::state::MotionState;
use super::surfaces::{note_profile_work, note_temperature_work};
use crate::bearing::{BearingParts, SHAFT};
use crate::bodies::FlatBody;
use crate::system::{Interval, Lumped};

impl Motion<'_> {
    /// The state after a part, and its local error over the largest contact approach.
    pub(super) fn finish(
        &self,
        state: &MotionState,
        (parts, dt): (&BearingParts, f64),
        solution: &StepSolution,
        rings: RingSteps<'_>,
        ends: [Option<Ended>; 2],
    ) -> (MotionState, f64) {
        let mut next = state.without_rings();
        let mut trend = self
            .settings
            .ladder
            .tolerance
            .map(|_| vec![Meridian::default(); 3 * parts.n_balls()]);
        let energies = ends
            .each_ref()
            .map(|end| end.as_ref().map_or([0.0; 2], |end| end.energies));
        for ((side, step), end) in Side::BOTH.into_iter().zip(rings).zip(ends) {
            let i = side.index();
            if let (Some(step), Some(end), Some(old)) = (step, end, &state.rings[i]) {
                self.finish_ring(&mut next, side, (parts, solution), end.works, [old, &end.state]);
                if let Some(trend) = &mut trend {
                    let mean = mean_acceleration(&*step, [old, &end.state], dt);
                    let first = parts.n_balls() + i;
                    for (ball, a) in mean.chunks_exact(2 * self.feet_per_contact()).enumerate() {
                        trend[first + 2 * ball] = Meridian::new(a[0], a[1]);
                    }
                }
                self.note_courses(
                    &mut next,
                    side,
                    (solution, dt),
                    (&*step, end.state.displacement()),
                );
                next.rings[i] = Some(end.state);
            }
        }
        let step = StepScheme {
            integrator: self.settings.integrator,
            dt,
        };
        finish_shaft(&mut next, parts, solution, step);
        finish_balls(&mut next, parts, solution, step);
        self.finish_free(&mut next, parts, solution);
        finish_seat(&mut next, parts, solution, step);
        finish_contacts(&mut next, parts, solution);
        let [kinetic, strain] = [0, 1].map(|i| energies.map(|of_ring| of_ring[i]));
        self.note_energies(&mut next, kinetic, strain);
        next.ledger.note_scale();
        let Some(mut trend) = trend else {
            return (next, 0.0);
        };
        for (b, mean) in trend.iter_mut().take(parts.n_balls()).enumerate() {
            *mean = (next.ball_velocities[b] - state.ball_velocities[b]).map(|change| change / dt);
        }
        let error = local_error(&trend, &state.trend, dt, &next.approaches);
        next.trend = trend;
        (next, error)
    }

    /// Works and losses of one ring between two states.
    fn finish_ring(
        &self,
        next: &mut MotionState,
        side: Side,
        (parts, solution): (&BearingParts, &StepSolution),
        works: Works,
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
        let Some(ports) = &parts.rings[side.index()] else {
            return;
        };
        if let Some(follow) = ports.follow.filter(|follow| follow.body == SHAFT) {
            // What the shaft gives in space and what the ring gets in its frame differ by the work of the turning.
            let mount = &solution.mounts[side.index()];
            let (start, end) = (&ports.start[ports.n_moving..], follow.in_frame(solution.shaft));
            let in_frame: f64 = (0..mount.len().min(5))
                .map(|i| mount[i] * (end[i] - start[i]))
                .sum();
            let force = follow.in_space(mount);
            let (from, to) = (parts.shaft.start(), solution.shaft);
            let in_space: f64 = (0..5).map(|i| force[i] * (to[i] - from[i])).sum();
            ledger.frame_work += in_frame - in_space;
        }
    }

    /// Energies of a state whose rings have those found anew.
    pub(super) fn measure_energies(&self, state: &mut MotionState) {
        let energies = |side: Side| match (&self.rings[side.index()], &state.rings[side.index()]) {
            (Some(moving), Some(ring)) => moving.body.energies(ring),
            _ => [0.0; 2],
        };
        let energies = self.model.backend.on_sides(energies);
        let [kinetic, strain] = [0, 1].map(|i| energies.map(|of_ring| of_ring[i]));
        self.note_energies(state, kinetic, strain);
    }

    /// Kinetic and strain energies of a state, of which those of the rings are known.
    fn note_energies(&self, state: &mut MotionState, kinetic: BySide<f64>, strain: BySide<f64>) {
        let [inner, outer] = kinetic;
        let kinetic = |mass: f64, v: &f64| 0.5 * mass * v * v;
        let mass = self.model.ball_mass();
        let balls: f64 = state
            .ball_velocities
            .iter()
            .flat_map(|v| v.to_array())
            .map(|v| kinetic(mass, &v))
            .sum();
        let balls = match &state.free {
            Some(free) => free.kinetic(self.model.ball_inertia()),
            None => balls,
        };
        let shaft = self.model.shaft_masses().into_iter().zip(&state.shaft_velocity);
        let shaft: f64 = shaft.map(|(mass, v)| kinetic(mass, v)).sum();
        let seat = state.seat.zip(self.model.seat());
        let outer_kinetic = match seat {
            Some((seat, of)) => outer + kinetic(of.mass, &seat[1]),
            None => outer,
        };
        state.ledger.kinetic = [inner + shaft, outer_kinetic, balls];
        state.ledger.strain = strain;
    }
}

/// Mean acceleration of the groove centres of a ring in a part, `[2 n_balls]`, m/s^2.
fn mean_acceleration(step: &dyn ElasticStep, [old, new]: [&RingState; 2], dt: f64) -> Vec<f64> {
    let change = new.velocity().iter().zip(old.velocity());
    let change: Vec<f64> = change.map(|(a, b)| (a - b) / dt).collect();
    step.at_contacts(&change)
}

/// Local error of the last part over the largest contact approach: dt^2/12 times the change of the mean
/// accelerations, the leading term of average acceleration.
fn local_error(new: &[Meridian], old: &[Meridian], dt: f64, approaches: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |m: f64, x| m.max(x.abs()));
    // After a start from undeformed bodies there is no earlier acceleration: no estimate.
    let change = |(new, old): (&Meridian, &Meridian)| {
        let change = |x: f64| if x.is_nan() { 0.0 } else { x };
        (*new - *old).map(change).to_array()
    };
    let change = largest(&mut new.iter().zip(old).flat_map(change));
    let scale = largest(&mut approaches.iter().copied());
    if scale > 0.0 {
        dt * dt / 12.0 * change / scale
    } else {
        0.0
    }
}

/// Velocities and accelerations of a body at the end of a step, under the forces of all else on it where they are
/// known; adds its works.
fn finish_body<const N: usize>(
    body: &FlatBody<N>,
    step: StepScheme,
    (end, forces): ([f64; N], Option<[f64; N]>),
    ledger: &mut Ledger,
) -> [[f64; N]; 2] {
    let StepScheme { integrator, dt } = step;
    let [mut velocity, mut acceleration] = [[0.0; N]; 2];
    for (i, (dof, x)) in body.dofs.iter().zip(end).enumerate() {
        ledger.load_work += dof.load_at(integrator, x) * (x - dof.start[0]);
        ledger.numerical_loss += dof.numerical_loss(integrator, x, dt);
        [velocity[i], acceleration[i]] = match forces {
            Some(forces) => dof.update_under(step, forces[i], x),
            None => dof.update(integrator, x, dt),
        };
    }
    [velocity, acceleration]
}

fn finish_shaft(next: &mut MotionState, parts: &BearingParts, solution: &StepSolution, step: StepScheme) {
    let reactions = parts.shaft_reactions(solution, step);
    let imposed = parts
        .shaft
        .imposed
        .iter()
        .enumerate()
        .filter(|(_, value)| value.is_some());
    for (dof, _) in imposed {
        let change = solution.shaft[dof] - parts.shaft.dofs[dof].start[0];
        next.ledger.imposed_work += reactions[dof] * change;
    }
    if let Some(turning) = &parts.shaft.turning {
        let [work, of_scheme] = turning.works(solution.shaft);
        next.ledger.frame_work -= work;
        next.ledger.numerical_loss += of_scheme;
    }
    if let Some(large) = &parts.shaft.large_tilt {
        next.ledger.frame_work -= large.work(solution.shaft);
    }
    let loads = parts.shaft.loads_by_tilt(Interval::Step(step), &solution.shaft);
    for (dof, load) in loads.iter().enumerate() {
        next.ledger.load_work += load * (solution.shaft[dof] - parts.shaft.dofs[dof].start[0]);
    }
    next.shaft = solution.shaft;
    [next.shaft_velocity, next.shaft_acceleration] =
        finish_body(&parts.shaft, step, (solution.shaft, None), &mut next.ledger);
}

/// Balls get what the rings get, with the opposite sign, so that momentum is kept whatever Newton leaves.
fn finish_balls(next: &mut MotionState, parts: &BearingParts, solution: &StepSolution, step: StepScheme) {
    let on_rings = parts.with_dead(&solution.forces);
    let balls = parts.balls.iter().zip(&solution.balls);
    for (b, ((ball, end), of_ball)) in balls.zip(on_rings.as_chunks::<4>().0).enumerate() {
        let forces = [0, 1].map(|i| -(of_ball[i] + of_ball[2 + i]));
        next.balls[b] = *end;
        [next.ball_velocities[b], next.ball_accelerations[b]] =
            finish_body(ball, step, (end.to_array(), Some(forces)), &mut next.ledger).map(Meridian::from);
    }
}

fn finish_seat(next: &mut MotionState, parts: &BearingParts, solution: &StepSolution, step: StepScheme) {
    let Some(seat) = &parts.seat else { return };
    let end = [0.0, 0.0, solution.seat, 0.0, 0.0];
    let [velocity, acceleration] = finish_body(&seat.body, step, (end, None), &mut next.ledger);
    let [work, loss] = seat.spring.works([seat.body.dofs[2].start[0], solution.seat]);
    next.ledger.load_work += work;
    next.ledger.numerical_loss += loss;
    next.seat = Some([solution.seat, velocity[2], acceleration[2]]);
}

fn finish_contacts(next: &mut MotionState, parts: &BearingParts, solution: &StepSolution) {
    let (mut start, mut end) = (0.0, 0.0);
    let states = [0, 1].map(|end| solution.states(parts, end));
    for (index, (first, last)) in states[0].iter().zip(&states[1]).enumerate() {
        let [l0, l1] = solution.reach(index);
        start += first.force.energy;
        end += last.force.energy;
        next.approaches[index] = last.force.approach;
        next.angles[index] = last.angle;
        next.forces[index] = solution.forces[index].force.into();
        next.ledger.contact_loss += solution.forces[index].loss;
        next.ledger.patch_work += solution.forces[index].passing_work;
        next.ledger.numerical_loss += solution.forces[index].numerical_loss;
        if let Some(dead) = parts.contacts.dead.get(index) {
            // On the ring and, with the opposite sign, on the ball.
            next.ledger.load_work -= dead.dot(l1 - l0);
        }
    }
    next.ledger.patch_work += start - next.ledger.hertz;
    next.ledger.hertz = end;
    note_profile_work(&mut next.ledger, parts, solution, (start, end));
    note_temperature_work(&mut next.ledger, parts, solution, (start, end));
}

impl BearingParts {
    /// Forces that hold or drive the shaft's dofs, N and N m; zero to round-off for free ones.
    pub(super) fn shaft_reactions(&self, solution: &StepSolution, step: StepScheme) -> [f64; 5] {
        let mut reactions = self.shaft.forces(Interval::Step(step), &solution.shaft);
        let mount = self.rings[0].as_ref().and_then(|ports| ports.follow);
        let mount = mount.map_or([0.0; 5], |follow| follow.in_space(&solution.mounts[0]));
        (0..5).for_each(|i| reactions[i] += mount[i] + solution.on_shaft[i]);
        if self.free.is_some() && self.rings[0].is_none() {
            let asked = self.free_reactions(Side::Inner, solution);
            (0..5).for_each(|i| reactions[i] += asked[i]);
        }
        if let Some(cage) = &solution.cage {
            (0..5).for_each(|i| reactions[i] += cage.on_shaft[i]);
        }
        reactions
    }
}
