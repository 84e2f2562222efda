//! One part of a step, of one size: loads, patches and both rings, then Newton until patches and inertia of the turning frame
//! are those of the motion found, then the new state.

use std::sync::Arc;
use std::time::Instant;

use contact::Side;

use super::ahead::Foreseen;
use super::close::Settling;
use super::newton::{SmallSolution, check_patches, check_range};
use super::part::Moving;
use super::place::Placing;
use super::run::Motion;
use super::small::SmallSystem;
use super::state::{MotionState, StepReport};
use crate::error::DynamicsError;

/// Rounds for the places of the patches before a step counts as failed.
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
pub(super) struct Part<'m> {
    pub span: Span,
    pub foreseen: Arc<Foreseen>,
    /// Contact angle, rad, and force, N, for which the patches were placed, by site.
    places: Vec<[f64; 2]>,
    placing: Placing,
    pub moving: [Option<Moving<'m>>; 2],
    pub system: SmallSystem,
    /// Largest force that acts at the start, N.
    pub scale: f64,
    /// The inertia of the turning frame.
    pub settling: Settling,
    /// Sum of the squares of its last change, N^2.
    pub last_change: Option<f64>,
    pub report: StepReport,
    pub clock: Lap,
}

impl Motion<'_> {
    /// One part of a step; looks ahead to the part `upcoming`.
    pub(super) fn substep(
        &self,
        state: &MotionState,
        span: Span,
        upcoming: Option<Span>,
    ) -> Result<(MotionState, StepReport), DynamicsError> {
        let mut part = self.begin(state, span)?;
        let (solution, ends) = loop {
            let solution = self.solve_in_place(state, &mut part)?;
            if let Some(ends) = self.close(state, &mut part, &solution, upcoming)? {
                break (solution, ends);
            }
        };
        check_patches(&part.system, &solution)?;
        check_range(self.model, &part.system, &solution)?;
        let places = part.system.places(&solution);
        self.check_on_grooves(&places)?;
        let (mut next, error) = self.finish(state, &part.system, &solution, part.moving, ends);
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
        let foreseen = self.foreseen(state, span)?;
        report.seconds.loads = clock.lap();
        let places = foreseen.places.clone();
        let placing = self.place(&places, self.weighted_time(span))?;
        report.seconds.patches = clock.lap();
        let moving = self.prepare(state, &foreseen, &placing.feet)?;
        let longest = |part: usize| {
            let rings = moving.iter().flatten();
            rings.map(|m| m.step.seconds[part]).fold(0.0, f64::max)
        };
        report.seconds.right_side = longest(0);
        report.seconds.raceways = longest(2);
        report.seconds.solve = clock.lap() - longest(0) - longest(2);
        let system = self.system(state, span, placing.sites.clone(), &moving, &foreseen.loads)?;
        let mut part = Part {
            span,
            places,
            placing,
            system,
            scale: self.force_scale(state, &foreseen.loads),
            settling: Settling::Settled,
            last_change: None,
            foreseen,
            moving,
            report,
            clock,
        };
        if part.foreseen.loads.frame.is_some() {
            part.settling = Settling::Open(self.contraction(&part));
        }
        Ok(part)
    }

    /// Time at which a part is in balance, s.
    pub(super) fn weighted_time(&self, span: Span) -> f64 {
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
            let tables = part.moving.iter().flatten().all(|m| m.factor.has_table());
            let (seconds, lap) = (&mut part.report.seconds, part.clock.lap());
            *(if tables {
                &mut seconds.raceways
            } else {
                &mut seconds.solve
            }) += lap;
            let sites = part.placing.sites.clone();
            part.system = self.system(state, part.span, sites, &part.moving, &part.foreseen.loads)?;
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
}

/// A stop watch.
pub(super) struct Lap(Instant);

impl Lap {
    fn new() -> Lap {
        Lap(Instant::now())
    }

    /// Seconds since the last lap.
    pub(super) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.0).as_secs_f64();
        self.0 = now;
        seconds
    }
}
