//! One part of a step, of one size: loads, patches and both rings, then Newton until patches and inertia of the turning frame
//! are those of the motion found, then the new state.

use std::time::Instant;

use contact::Side;

use super::newton::{SmallSolution, check_patches, check_range};
use super::part::Moving;
use super::place::Placing;
use super::run::Motion;
use super::small::SmallSystem;
use super::state::{MotionState, StepReport};
use crate::effects::Loads;
use crate::error::DynamicsError;

/// Rounds before a step counts as failed; each contracts by about speed times step size.
const MAX_FRAME_ROUNDS: usize = 25;
/// The same for the places of the patches.
const MAX_PLACE_ROUNDS: usize = 20;

/// A part of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    /// Time at its start, s.
    pub start: f64,
    /// Its size, s.
    pub dt: f64,
    /// Its rung of the ladder.
    pub rung: u32,
}

impl Span {
    /// Time at a share of the part, s.
    pub fn at(&self, share: f64) -> f64 {
        self.start + share * self.dt
    }
}

/// A part of a step under way.
struct Part<'m> {
    span: Span,
    loads: Loads,
    /// Contact angle, rad, and force, N, for which the patches were placed, by site.
    places: Vec<[f64; 2]>,
    placing: Placing,
    moving: [Option<Moving<'m>>; 2],
    system: SmallSystem,
    /// Largest force that acts at the start, N.
    scale: f64,
    report: StepReport,
    clock: Lap,
}

impl Motion<'_> {
    pub(super) fn substep(
        &self,
        state: &MotionState,
        span: Span,
    ) -> Result<(MotionState, StepReport), DynamicsError> {
        let mut part = self.begin(state, span)?;
        let (solution, increments) = loop {
            let solution = self.solve_in_place(state, &mut part)?;
            let increments = self.increments(&part.system, &solution, &part.moving);
            part.report.seconds.update += part.clock.lap();
            if self.settle_frame(&mut part, &increments)? {
                break (solution, increments);
            }
        };
        check_patches(&part.system, &solution)?;
        check_range(self.model, &part.system, &solution)?;
        let places = part.system.places(&solution);
        self.check_on_grooves(&places)?;
        let (mut next, error) = self.finish(state, &part.system, &solution, part.moving, increments);
        next.places.rotate_right(1);
        next.places[0] = places;
        let mut report = part.report;
        report.error = error;
        report.seconds.update += part.clock.lap();
        Ok((next, report))
    }

    /// Loads, patches where they are expected, and both rings.
    fn begin<'m>(&'m self, state: &'m MotionState, span: Span) -> Result<Part<'m>, DynamicsError> {
        let mut report = StepReport {
            substeps: 1,
            ..StepReport::default()
        };
        let mut clock = Lap::new();
        let places = state.expected_places();
        let loads = self.loads_at(&places, self.weighted_time(span), span.dt)?;
        report.seconds.loads = clock.lap();
        let placing = self.place(&places, self.weighted_time(span))?;
        report.seconds.patches = clock.lap();
        let moving = self.prepare(state, span, &loads, &placing.feet)?;
        let times = moving.iter().flatten().map(|m| m.step.seconds);
        [report.seconds.right_side, report.seconds.solve] = longest(times);
        clock.lap();
        let system = self.system(state, span, placing.sites.clone(), &moving, &loads)?;
        Ok(Part {
            span,
            places,
            placing,
            system,
            scale: self.force_scale(state, &loads),
            loads,
            moving,
            report,
            clock,
        })
    }

    /// Time at which a part is in balance, s.
    fn weighted_time(&self, span: Span) -> f64 {
        span.at(1.0 - self.settings.integrator.alpha_f)
    }

    /// Contact forces over patches that lie where these forces put them.
    fn solve_in_place(
        &self,
        state: &MotionState,
        part: &mut Part<'_>,
    ) -> Result<SmallSolution, DynamicsError> {
        for _ in 0..=MAX_PLACE_ROUNDS {
            let solution = part.system.solve(part.scale, &self.costs)?;
            part.report.newton_iterations += solution.iterations;
            part.report.seconds.newton += part.clock.lap();
            let met = part.system.places(&solution);
            if part.placing.holds(&part.places, &met) {
                return Ok(solution);
            }
            part.report.place_rounds += 1;
            part.placing = self.place(&met, self.weighted_time(part.span))?;
            part.places = met;
            part.report.seconds.patches += part.clock.lap();
            self.move_contacts(part);
            part.report.seconds.solve += part.clock.lap();
            let sites = part.placing.sites.clone();
            part.system = self.system(state, part.span, sites, &part.moving, &part.loads)?;
        }
        // A ball that presses beyond the rim has no place: that is the cause then.
        self.check_on_grooves(&part.places)?;
        Err(DynamicsError::PlacesNotSettled {
            rounds: MAX_PLACE_ROUNDS,
        })
    }

    /// Both rings with their contacts where the patches are.
    fn move_contacts(&self, part: &mut Part<'_>) {
        let feet = &part.placing.feet;
        let [inner, outer] = &mut part.moving;
        let turn = |ring: &mut Option<Moving<'_>>, side: Side| {
            if let Some(m) = ring {
                m.factor
                    .move_contacts(m.body, m.old, &mut m.step, &feet[side.index()]);
            }
        };
        self.model
            .backend
            .both(|| turn(inner, Side::Inner), || turn(outer, Side::Outer));
    }

    /// True when the inertia of the turning frame is that of the motion found; else the part goes on with the new one.
    fn settle_frame(
        &self,
        part: &mut Part<'_>,
        increments: &[Option<Vec<f64>>; 2],
    ) -> Result<bool, DynamicsError> {
        let Some(turn) = part.loads.frame else {
            return Ok(true);
        };
        let settled = self.costs.time("frame_rotation", || {
            self.renew_inertia(part.span, &mut part.moving, increments, part.scale)
        });
        part.report.seconds.frame += part.clock.lap();
        if settled {
            return Ok(true);
        }
        part.report.frame_rounds += 1;
        if part.report.frame_rounds > MAX_FRAME_ROUNDS {
            return Err(DynamicsError::FrameNotSettled {
                rounds: MAX_FRAME_ROUNDS,
                speed: turn.speed,
            });
        }
        for (answer, ring) in part.system.rings.iter_mut().zip(&part.moving) {
            if let (Some(answer), Some(ring)) = (answer, ring) {
                answer.predicted.clone_from(&ring.step.predicted);
            }
        }
        Ok(false)
    }
}

/// Component-wise largest.
fn longest(times: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    times.fold([0.0; 2], |m, t| [m[0].max(t[0]), m[1].max(t[1])])
}

/// A stop watch.
struct Lap(Instant);

impl Lap {
    fn new() -> Lap {
        Lap(Instant::now())
    }

    /// Seconds since the last lap.
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.0).as_secs_f64();
        self.0 = now;
        seconds
    }
}
