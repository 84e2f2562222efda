//! One part of a step, of one size: loads, patches and both rings, then Newton until patches and inertia of the
//! turning frame are those of the motion found, then the new state.

use std::sync::Arc;

use contact::Side;
use ring::ElasticStep;
use timer::{Laps, Stopwatch};

use super::cache::{Ahead, ExpectedLoads, RingEnds, StepCache};
use super::finite::require_finite;
use super::free::check_apart;
use super::part::RingSteps;
use super::place::Placing;
use super::run::Motion;
use super::solve::{StepSolution, check_patches, check_range, policy};
use super::span::PartSpan;
use super::state::PatchPlace;
use super::state::{MotionState, StepReport};
use crate::bearing::BearingParts;
use crate::costs::{BLOCK_SOLVE, LOADS, NEWTON, PATCHES, UPDATE};
use crate::error::DynamicsError;
use crate::system::newton::KeptTangent;

/// Rounds for the places of the patches before a step counts as failed.
const MAX_PLACE_ROUNDS: usize = 20;

/// A part of a step under way.
pub(super) struct StepPart<'m> {
    pub span: PartSpan,
    pub expected: Arc<ExpectedLoads>,
    /// Where the patches were placed, by site.
    places: Vec<PatchPlace>,
    placing: Placing,
    pub rings: RingSteps<'m>,
    pub parts: BearingParts,
    /// Largest force that acts at the start, N.
    pub scale: f64,
    /// Newton's unknowns of the round before; None in the first.
    pub before: Option<Vec<f64>>,
    /// Newton's tangent there; None where contacts have moved since.
    tangent: Option<KeptTangent>,
    pub report: StepReport,
    pub clock: Stopwatch,
}

impl Motion<'_> {
    /// One part of a step; looks ahead to the part `upcoming`.
    pub(super) fn substep(
        &self,
        state: &MotionState,
        span: PartSpan,
        upcoming: Option<PartSpan>,
        cache: &StepCache,
    ) -> Result<(MotionState, StepReport, Option<Ahead>), DynamicsError> {
        let mut part = self.begin(state, span, cache)?;
        let (solution, ends) = loop {
            let solution = self.solve_in_place(state, &mut part)?;
            if let Some(ends) = self.close(state, &mut part, &solution, upcoming)? {
                break (solution, ends);
            }
        };
        self.conclude(state, part, &solution, ends)
    }

    /// The state after a part whose rings have ended.
    pub(super) fn conclude(
        &self,
        state: &MotionState,
        mut part: StepPart<'_>,
        solution: &StepSolution,
        ends: RingEnds,
    ) -> Result<(MotionState, StepReport, Option<Ahead>), DynamicsError> {
        check_patches(&part.parts, solution)?;
        check_range(self.model, &part.parts, solution)?;
        check_apart(self.model, &part.parts, solution)?;
        let places = part.parts.places(solution);
        self.check_on_grooves(&places)?;
        let (mut next, error) = self.finish(
            state,
            (&part.parts, part.span.dt),
            solution,
            part.rings,
            ends.rings,
        );
        require_finite(&next)?;
        next.places.rotate_right(1);
        next.places[0] = places;
        let mut report = part.report;
        report.error = error;
        report.laps.add(UPDATE, part.clock.lap());
        Ok((next, report, ends.ahead))
    }

    /// Loads, patches where they are expected, and both rings.
    pub(super) fn begin<'m>(
        &'m self,
        state: &'m MotionState,
        span: PartSpan,
        cache: &StepCache,
    ) -> Result<StepPart<'m>, DynamicsError> {
        let mut report = StepReport {
            substeps: 1,
            ..StepReport::default()
        };
        let mut clock = Stopwatch::start();
        let ahead = self.ahead(state, span, cache)?;
        let expected = ahead.loads.clone();
        report.laps.add(LOADS, clock.lap());
        let places = expected.places.clone();
        let placing = self.place(&places, &self.course(state, span))?;
        report.laps.add(PATCHES, clock.lap());
        let rings = self.begin_rings(state, ahead, &placing)?;
        let known = longest(rings.iter().flatten().map(|step| step.laps()));
        report.laps.add(BLOCK_SOLVE, clock.lap() - known.total());
        report.laps.merge(&known);
        let parts = self.parts(state, span, (&placing, &places), &rings, &expected.loads)?;
        Ok(StepPart {
            span,
            places,
            placing,
            parts,
            scale: self.force_scale(state, &expected.loads),
            expected,
            rings,
            before: None,
            tangent: None,
            report,
            clock,
        })
    }

    /// Time at which a part is in balance, s.
    pub(super) fn weighted_time(&self, span: PartSpan) -> f64 {
        span.at(1.0 - self.settings.integrator.alpha_f)
    }

    /// Contact forces over patches that lie where these forces put them.
    fn solve_in_place(
        &self,
        state: &MotionState,
        part: &mut StepPart<'_>,
    ) -> Result<StepSolution, DynamicsError> {
        for _ in 0..=MAX_PLACE_ROUNDS {
            let solution = match part.parts.free {
                Some(_) => part.parts.solve_free(self.model, part.scale, &self.costs)?,
                None => self.solve_again(part)?,
            };
            part.report.newton_iterations += solution.iterations;
            part.report.laps.add(NEWTON, part.clock.lap());
            if self.stays_in_place(state, part, &solution)? {
                return Ok(solution);
            }
        }
        // A ball that presses beyond the rim has no place: that is the cause then.
        self.check_on_grooves(&part.places)?;
        Err(DynamicsError::PlacesNotSettled {
            rounds: MAX_PLACE_ROUNDS,
        })
    }

    /// Newton on the part. In a round of a turning frame it starts from the solution of the round before, with its
    /// tangent.
    fn solve_again(&self, part: &mut StepPart<'_>) -> Result<StepSolution, DynamicsError> {
        let policy = policy(part.scale, None, &self.costs);
        let before = part.before.take();
        part.parts.solve_step_from(before, &policy, &mut part.tangent)
    }

    /// Whether the patches lie where the forces of a solution put them; else they are moved there.
    pub(super) fn stays_in_place(
        &self,
        state: &MotionState,
        part: &mut StepPart<'_>,
        solution: &StepSolution,
    ) -> Result<bool, DynamicsError> {
        let met = part.parts.places(solution);
        if part.placing.holds(&part.places, &met) {
            return Ok(true);
        }
        part.report.place_rounds += 1;
        part.tangent = None;
        part.placing = self.place(&met, &self.course(state, part.span))?;
        part.places = met;
        part.report.laps.add(PATCHES, part.clock.lap());
        self.move_contacts(part);
        let placed = (&part.placing, &part.places[..]);
        part.parts = self.parts(state, part.span, placed, &part.rings, &part.expected.loads)?;
        Ok(false)
    }

    /// Both rings with their contacts where the patches are.
    fn move_contacts(&self, part: &mut StepPart<'_>) {
        let placing = &part.placing;
        let move_ring = |step: &mut Option<Box<dyn ElasticStep + '_>>, side: Side| {
            step.as_mut()
                .map(|step| step.move_contacts(self.feet(side, placing)))
        };
        let known = self.model.backend.with_sides(part.rings.each_mut(), move_ring);
        let known = longest(known.iter().flatten());
        let laps = &mut part.report.laps;
        laps.add(BLOCK_SOLVE, part.clock.lap() - known.total());
        laps.merge(&known);
    }
}

/// Laps of rings side by side: of each the longest.
fn longest<'a>(rings: impl Iterator<Item = &'a Laps>) -> Laps {
    rings.fold(Laps::default(), Laps::longest)
}
