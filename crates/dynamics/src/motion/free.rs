//! Free balls in motion: how they start, their bodies and contacts over a part of a step, and its end.

use std::sync::Arc;

use contact::{BySide, Meridian, SemiAxes, Side};
use ring::ElasticStep;

use super::free_state::{ContactTraction, FreeState};
use super::ledger::FrictionLedger;
use super::part::RingSteps;
use super::place::Course;
use super::ring_course::RingCourse;
use super::run::Motion;
use super::solve::StepSolution;
use super::span::PartSpan;
use super::state::MotionState;
use crate::bearing::{BearingParts, FreeParts};
use crate::bodies::FreeBall;
use crate::effects::steady_balls::{SteadyBalls, drag};
use crate::error::DynamicsError;
use crate::interactions::free_contact::orientation::turned;
use crate::interactions::free_contact::place::GrooveCircle;
use crate::interactions::free_contact::{
    ContactStep, ElasticPlace, FREE_FEET, FREE_PORTS, FoundContact, FreeContacts, RingStep,
};
use crate::interactions::raceway_contact::Site;
use crate::interactions::steady_rolling::{SteadyRolling, pure_rolling, rolling_speed};
use crate::interactions::traction::creep::RollingContact;
use crate::interactions::traction::{Ellipse, Traction};
use crate::model::Model;
use crate::system::CarriedCircle;

/// Acceleration by which the least force of a contact is a weight, m/s^2: what opens has no size of its own.
const EARTH: f64 = 9.81;

impl Motion<'_> {
    /// Balls that roll steadily, or without slip from the displacements and contact angles of a state; None where balls
    /// are not free.
    pub(super) fn free_start(&self, state: &MotionState, steady: Option<&SteadyBalls>) -> Option<FreeState> {
        self.model.traction()?;
        let mut free = FreeState::default();
        let centre = self.model.geometry.ball_centre();
        for (ball, displacement) in state.balls.iter().enumerate() {
            let (sin, cos) = self.model.geometry.azimuth(ball).sin_cos();
            let Meridian { radial: out, axial } = centre + *displacement;
            let angles = [state.angles[2 * ball], state.angles[2 * ball + 1]];
            let rolls = steady.and_then(|steady| steady.balls.get(ball));
            let [orbit, turning @ ..] = rolls.map_or_else(|| self.rolls(out, angles), SteadyRolling::rates);
            free.places.push([out * cos, out * sin, axial]);
            let along = orbit * out;
            free.velocities.push(match state.ball_velocities[ball] {
                still if still == Meridian::default() => [-along * sin, along * cos, 0.0],
                Meridian { radial, axial } => [radial * cos - along * sin, radial * sin + along * cos, axial],
            });
            free.turnings.push([
                turning[0] * cos - turning[1] * sin,
                turning[0] * sin + turning[1] * cos,
                turning[2],
            ]);
        }
        free.trends = vec![[0.0; 6]; free.places.len()];
        free.contacts = vec![ContactTraction::default(); 2 * free.places.len()];
        free.courses = vec![RingCourse::default(); 2 * free.places.len()];
        if self.has_strips() {
            free.track = vec![[0.0; 4]; 2 * free.places.len()];
        }
        free.orientations = self.orientations_at_start();
        free.cage = self.cage_at_start(&free, state.shaft);
        Some(free)
    }

    /// Rolling without slip at the centres of both contacts, with spin shared half and half, of a ball at a distance
    /// from the axis, m, with contact angles, rad, on rings that turn as at the start.
    fn rolls(&self, out: f64, angles: BySide<f64>) -> [f64; 4] {
        let lever = 0.5 * self.model.geometry.ball_diameter;
        let speeds = Side::BOTH.map(|side| self.settings.speeds.of(side).at(0.0));
        let normal = Side::BOTH.map(|side| {
            let (sin, cos) = angles[side.index()].sin_cos();
            [side.sign() * cos, side.sign() * sin]
        });
        pure_rolling(out, [lever; 2], normal, speeds)
    }

    /// Free balls and their contacts over a part; None where balls are not free.
    pub(super) fn free_parts(
        &self,
        state: &MotionState,
        span: PartSpan,
        sites: &[Site],
        rings: &RingSteps<'_>,
    ) -> Option<FreeParts> {
        let (traction, free) = (self.model.traction()?, state.free.as_ref()?);
        let traction = Arc::new(traction.clone());
        let shaft = self.carrier_step(state, span, Side::Inner);
        let fall = self.fall(span);
        let rings = Side::BOTH.map(|side| {
            let step = rings[side.index()].as_deref();
            self.ring_steps((state, free), span, (side, sites), step)
        });
        let contact = |(index, site): (usize, &Site)| {
            let ring = rings[index % 2][index / 2];
            self.contact_step((state, free), span, (index, site), (ring, &traction))
        };
        let contacts = sites.iter().enumerate().map(contact).collect();
        Some(FreeParts {
            balls: (0..free.places.len())
                .map(|ball| self.free_ball(free, span, (ball, fall)))
                .collect(),
            contacts: FreeContacts::new(contacts),
            cage: self.cage_parts(free, span, fall, shaft),
        })
    }

    /// Nodal weights of a contact on a flexible ring: of its groove, and of a free ball of its patch too.
    pub(super) fn feet_per_contact(&self) -> usize {
        match self.model.traction() {
            Some(_) => FREE_FEET,
            None => 1,
        }
    }

    /// Where balls are in the middle of a part. A free ball is expected on the orbit that it has at the start: wrong by
    /// dt^2/8 times its angular acceleration, 1e-4 of a patch where all friction speeds it up.
    pub(super) fn course(&self, state: &MotionState, span: PartSpan) -> Course {
        let time = self.weighted_time(span);
        let balls = 0..self.n_balls();
        let Some(free) = &state.free else {
            return Course {
                time,
                azimuths: balls.map(|ball| self.ball_azimuth(ball, time)).collect(),
                is_free: false,
                passed: self.passed(state, span),
                start: span.at(0.0),
                end: span.at(1.0),
            };
        };
        let half = 0.5 * span.dt;
        Course {
            time,
            azimuths: balls
                .map(|ball| free.azimuth(ball) + half * free.orbit(ball))
                .collect(),
            is_free: true,
            passed: None,
            start: span.at(0.0),
            end: span.at(1.0),
        }
    }

    /// Acceleration of all that falls, m/s^2.
    fn fall(&self, span: PartSpan) -> [f64; 3] {
        let now = self.now(span);
        self.model.effects.iter().fold([0.0; 3], |sum, effect| {
            let a = effect.acceleration(&now);
            [0, 1, 2].map(|i| sum[i] + a[i])
        })
    }

    fn free_ball(&self, free: &FreeState, span: PartSpan, (ball, fall): (usize, [f64; 3])) -> FreeBall {
        let inertia = self.model.ball_inertia();
        FreeBall {
            ball,
            inertia,
            place: free.places[ball],
            velocity: free.velocities[ball],
            turning: free.turnings[ball],
            trend: [0, 1].map(|k| std::array::from_fn(|i| free.trends[ball][3 * k + i])),
            load: fall.map(|a| inertia.mass * a),
            drag: drag(self.model),
            dt: span.dt,
        }
    }

    /// A ring's side of its contacts, by ball.
    fn ring_steps(
        &self,
        (state, free): (&MotionState, &FreeState),
        span: PartSpan,
        (side, sites): (Side, &[Site]),
        step: Option<&(dyn ElasticStep + '_)>,
    ) -> Vec<RingStep> {
        let Some(step) = step else {
            return vec![self.carrier_step(state, span, side); self.n_balls()];
        };
        let answer = step.answer();
        let courses = free.courses.iter().skip(side.index()).step_by(2);
        let contacts = answer.start.as_chunks().0.iter().zip(answer.seen.as_chunks().0);
        let sites = sites.iter().skip(side.index()).step_by(2);
        let of_contact = contacts.zip(courses).zip(sites);
        let of_contact = of_contact.map(|(((start, seen), course), site)| {
            let slope = course.expected_slope(*seen, span.dt);
            let more = self.finite_slope(state, span, site);
            RingStep {
                elastic: Some(ElasticPlace {
                    start: *start,
                    slope: (Meridian::from(slope) + more).to_array(),
                }),
                ..self.turning_step(side, span)
            }
        });
        of_contact.collect()
    }

    /// Growth of a groove's motion with the azimuth that its ring's motion does not have, which is linear in the tilts
    /// of the shaft: in the middle of a part, m/rad.
    fn finite_slope(&self, state: &MotionState, span: PartSpan, site: &Site) -> Meridian {
        if site.side.choose(false, true) {
            return Meridian::default();
        }
        let half = 0.5 * span.dt;
        let at = CarriedCircle::COORDINATES.map(|k| state.shaft[k] + half * state.shaft_velocity[k]);
        Meridian::from(site.circle().along(at).map(|growth| -growth))
    }

    /// Goes on with the course of the contacts of free balls on a ring, whose motion is `end` at the end of a part.
    pub(super) fn note_courses(
        &self,
        next: &mut MotionState,
        side: Side,
        (solution, dt): (&StepSolution, f64),
        (step, end): (&dyn ElasticStep, &[f64]),
    ) {
        let Some(free) = &mut next.free else { return };
        let (answer, slopes_at_end) = (step.answer(), step.at_seen(end));
        let pairs = |values: &[f64]| values.as_chunks::<2>().0.to_vec();
        let slopes = pairs(&answer.seen).into_iter().zip(pairs(&slopes_at_end));
        let ports = answer.start.as_chunks::<FREE_PORTS>().0.iter();
        let ports = ports.zip(solution.ports[side.index()].as_chunks::<FREE_PORTS>().0);
        let courses = free.courses.iter_mut().skip(side.index()).step_by(2);
        for ((course, (from, to)), (start, end)) in courses.zip(slopes).zip(ports) {
            *course = RingCourse::over([*start, *end], [from, to], dt);
        }
    }

    /// What carries a ring, over a part.
    pub(super) fn carrier_step(&self, state: &MotionState, span: PartSpan, side: Side) -> RingStep {
        let (carrier, masses) = match (side, state.seat) {
            (Side::Inner, _) => ([state.shaft, state.shaft_velocity], self.model.shaft_masses()),
            (Side::Outer, Some([z, v, _])) => {
                let mass = self.model.seat().map_or(0.0, |seat| seat.mass);
                ([[0.0, 0.0, z, 0.0, 0.0], [0.0, 0.0, v, 0.0, 0.0]], [mass; 5])
            }
            (Side::Outer, None) => ([[0.0; 5]; 2], [0.0; 5]),
        };
        RingStep {
            carrier,
            has_inertia: masses.map(|mass| mass > 0.0),
            ..self.turning_step(side, span)
        }
    }

    /// A ring that turns at its speed over a part, and does not move else.
    pub(super) fn turning_step(&self, side: Side, span: PartSpan) -> RingStep {
        let speed = self.settings.speeds.of(side);
        RingStep {
            spin: [self.frame_speed(side, span), speed.at(span.at(1.0))],
            ..RingStep::default()
        }
    }

    fn contact_step(
        &self,
        (state, free): (&MotionState, &FreeState),
        span: PartSpan,
        (index, site): (usize, &Site),
        (ring, traction): (RingStep, &Arc<Traction>),
    ) -> ContactStep {
        let (ball, geometry) = (site.ball, &self.model.geometry);
        let groove = GrooveCircle {
            radius: geometry.centre_radius(site.side),
            height: geometry.groove_centre(site.side).axial,
            lever: self.model.contact_lever(ball, state.approaches[index]),
        };
        let least = EARTH * self.model.ball_mass();
        let force = state.forces[index].norm().max(least);
        let ellipse = self.model.ellipse(site.side, force);
        let (sin, cos) = state.angles[index].sin_cos();
        let normal = [site.side.sign() * cos, site.side.sign() * sin];
        let (out, rates) = free.rolls(ball);
        let rolling = RollingContact {
            speed: rolling_speed(out, (groove.lever, normal), rates, ring.spin[0]),
            force,
            semi_axes: ellipse.semi_axes,
            shear_modulus: self.model.combined_shear_modulus(site.side),
        };
        ContactStep {
            dt: span.dt,
            ball: [free.places[ball], free.velocities[ball], free.turnings[ball]],
            groove,
            law: site.law,
            across: site.across,
            touching: site.touching,
            sign: site.side.sign(),
            surface: self.rolling_surface((free, state.angles[index]), span, site),
            scheme: self.settings.scheme,
            damping: self.settings.contact_damping,
            ring,
            traction: self.traction_at((state, span.start), (index, site), ellipse.semi_axes, traction),
            ellipse: Ellipse {
                film: traction
                    .law
                    .film(|| self.model.film_contact(site.side), rolling.speed, force),
                ..ellipse
            },
            small_slip: traction.creep.slip(traction.law.at(0.0)[0], &rolling),
            slip_at: Default::default(),
        }
    }

    /// The traction of a contact, on a real surface at the places of its strips; its patch has these semi-axes.
    fn traction_at(
        &self,
        (state, start): (&MotionState, f64),
        (index, site): (usize, &Site),
        semi_axes: SemiAxes,
        traction: &Arc<Traction>,
    ) -> Arc<Traction> {
        match self.strips_at((state, start), (site.ball, site.side)) {
            Some(strips) => {
                let least = EARTH * self.model.ball_mass();
                let approach = (
                    state.approaches[index],
                    strips.surface.law.smooth_approach(0.0, least),
                );
                let angle = state.angles[index];
                Arc::new(Traction {
                    places: strips.places(&traction.places, semi_axes.groove, approach, angle),
                    ..Traction::clone(traction)
                })
            }
            None => traction.clone(),
        }
    }

    /// New state and works of free balls.
    pub(super) fn finish_free(&self, next: &mut MotionState, parts: &BearingParts, solution: &StepSolution) {
        let (Some(free), Some(before)) = (&parts.free, next.free.take()) else {
            return;
        };
        let mut state = FreeState {
            courses: before.courses.clone(),
            ..FreeState::default()
        };
        let mut friction = next.ledger.friction.unwrap_or_default();
        for (ball, x) in free.balls.iter().zip(&solution.free_ends) {
            let [velocity, turning] = ball.velocities(x);
            state.places.push(ball.end(x));
            state.velocities.push(velocity);
            state.turnings.push(turning);
            let [a, b] = ball.next_trend(x);
            state.trends.push([a[0], a[1], a[2], b[0], b[1], b[2]]);
            next.ledger.load_work += ball.load_work(x);
            friction.drag_loss += ball.drag_loss(x);
        }
        for (contact, found) in free.contacts.contacts.iter().zip(&solution.free_contacts) {
            friction.loss -= found.work;
            friction.integrator_share += found.work_at_slip - found.work;
            let turned = contact.ring.spin[0] * contact.dt;
            friction.drive_work += found.torque * turned;
            // What the slope force takes from a patch that moves on, ball and drive have.
            friction.drive_work += found.slope.torque * turned;
            next.ledger.patch_work += found.slope.work - found.slope.torque * turned;
            if let Some(surface) = &found.surface {
                // What a surface that moves on gives to the contact, ball and drive lose.
                friction.drive_work += surface.track.torque * turned;
                next.ledger.profile_work += surface.track.work - surface.track.torque * turned;
            }
            if self.has_strips() {
                let track = found.surface.as_ref().map_or([0.0; 4], |surface| {
                    let [x, y, z] = surface.moment;
                    [surface.track.force, x, y, z]
                });
                state.track.push(track);
            }
            state.contacts.push(contact_traction(found, contact.dt));
        }
        let turns = before.orientations.iter().zip(&solution.free_ends);
        state.orientations = turns.map(|(q, x)| turned(*q, [x[3], x[4], x[5]])).collect();
        next.ledger.friction = Some(friction);
        state.cage = self.finish_cage((&before, &mut next.ledger), parts, solution);
        for ball in 0..state.places.len() {
            next.balls[ball] = solution.balls[ball];
            next.ball_velocities[ball] = state.meridian_velocity(ball);
        }
        next.free = Some(state);
    }
}

/// What a contact of a free ball does over a step of `dt`, s.
fn contact_traction(found: &FoundContact, dt: f64) -> ContactTraction {
    ContactTraction {
        slip: found.slip,
        action: found.traction.action,
        power: -found.work / dt,
        torque: found.torque,
    }
}

impl BearingParts {
    /// Displacements of free balls from the just-touching position, m.
    pub(super) fn free_displacements(&self, model: &Model, ends: &[[f64; 6]]) -> Vec<Meridian> {
        let centre = model.geometry.ball_centre();
        let balls = self.free.iter().flat_map(|free| &free.balls).zip(ends);
        balls
            .map(|(ball, x)| {
                let [x, y, z] = ball.end(x);
                Meridian::new(x.hypot(y), z) - centre
            })
            .collect()
    }

    /// What all contacts of free balls ask of the carrier of a rigid ring, N and N m.
    pub(super) fn free_reactions(&self, side: Side, solution: &StepSolution) -> [f64; 5] {
        let mut sum = [0.0; 5];
        for found in solution.free_contacts.iter().skip(side.index()).step_by(2) {
            for (sum, force) in sum.iter_mut().zip(&found.resists[6..]) {
                *sum += force.value;
            }
        }
        sum
    }
}

/// Fails where two balls have run into each other, or a cage is off the axis.
pub(super) fn check_apart(
    model: &Model,
    parts: &BearingParts,
    solution: &StepSolution,
) -> Result<(), DynamicsError> {
    let Some(free) = &parts.free else { return Ok(()) };
    check_cage(model, parts, solution)?;
    let n = free.balls.len();
    let place = |ball: usize| free.balls[ball].end(&solution.free_ends[ball]);
    let remedy = match &free.cage {
        Some(_) => "give the pockets of the cage less clearance",
        None => "give them a cage, [cage] with motion = \"free\"",
    };
    for ball in 0..n {
        let other = (ball + 1) % n;
        let (a, b) = (place(ball), place(other));
        let square: f64 = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum();
        if square < model.geometry.ball_diameter.powi(2) {
            return Err(DynamicsError::BallsTouch { ball, other, remedy });
        }
    }
    Ok(())
}

fn check_cage(model: &Model, parts: &BearingParts, solution: &StepSolution) -> Result<(), DynamicsError> {
    let (Some(cage), Some(found)) = (parts.cage(), &solution.cage) else {
        return Ok(());
    };
    let Some(pocket) = cage.pockets.contacts.first() else {
        return Ok(());
    };
    let [x, y] = [0, 1].map(|i| pocket.cage[0][i] + found.end[i]);
    let (distance, limit) = (x.hypot(y), 0.25 * model.geometry.ball_diameter);
    if distance > limit {
        return Err(DynamicsError::CageLost { distance, limit });
    }
    Ok(())
}

/// The ledger of friction where balls are free.
pub(super) fn friction_at_start(model: &Model) -> Option<FrictionLedger> {
    model.traction().map(|_| FrictionLedger::default())
}
