//! A free cage in motion: how it starts, its body and contacts over a part of a step, and its end.

use contact::Side;

use super::cage_state::CageState;
use super::free_state::FreeState;
use super::ledger::{CageLedger, Ledger};
use super::run::Motion;
use super::solve::StepSolution;
use super::span::PartSpan;
use super::state::MotionState;
use crate::bearing::{BearingParts, CageParts};
use crate::bodies::CageBody;
use crate::interactions::cage::impact::Impact;
use crate::interactions::cage::land::LandStep;
use crate::interactions::cage::links::CageLinks;
use crate::interactions::cage::pocket::PocketStep;
use crate::interactions::cage::{Cage, CageContact, Land};
use crate::interactions::free_contact::{Carrier, RingStep};

impl Motion<'_> {
    /// A cage that stands round the balls, or in the middle of an inner land, and turns with the balls; None where
    /// there is none.
    pub(super) fn cage_at_start(&self, free: &FreeState, shaft: [f64; 5]) -> Option<CageState> {
        let cage = self.model.cage.as_ref()?;
        let n = free.places.len();
        let mean = |of: &dyn Fn(usize) -> f64| (0..n).map(of).sum::<f64>() / n as f64;
        let mut state = CageState {
            met: vec![0.0; n + cage.n_ends()],
            pockets: vec![[0.0; 2]; n],
            lands: vec![[0.0; 2]; cage.n_ends()],
            ..CageState::default()
        };
        state.place[2] = mean(&|ball| free.places[ball][2]);
        if cage.land.is_some_and(|land| land.side == Side::Inner) {
            // In the middle of its land.
            let height = self.cage_height();
            state.place[0] = shaft[0] + height * shaft[4];
            state.place[1] = shaft[1] - height * shaft[3];
            state.place[3..5].copy_from_slice(&shaft[3..]);
        }
        state.rates[5] = mean(&|ball| free.orbit(ball));
        Some(state)
    }

    /// The cage and its contacts over a part; None where there is none.
    pub(super) fn cage_parts(
        &self,
        free: &FreeState,
        span: PartSpan,
        fall: [f64; 3],
        shaft: RingStep,
    ) -> Option<CageParts> {
        let (cage, state) = (self.model.cage.as_ref()?, free.cage.as_ref()?);
        let n_balls = free.places.len();
        let body = CageParts::number(n_balls, self.model.seat().is_some());
        let impact = cage.impact();
        let pockets = (0..n_balls).map(|ball| self.pocket_step((cage, impact), (state, free), span, ball));
        let pockets = CageLinks::pockets(pockets.collect(), crate::bearing::FIRST_BALL, body);
        let ends = cage.land.iter().flat_map(|land| {
            [0, 1].map(|end| self.land_step((cage, impact, land), state, span, (n_balls, end), shaft))
        });
        let carrier = match cage.land.map(|land| land.side) {
            Some(Side::Inner) => Carrier::Lumped(crate::bearing::SHAFT),
            _ => Carrier::AtRest,
        };
        Some(CageParts {
            body: CageBody {
                masses: cage.masses(),
                rates: state.rates,
                load: fall.map(|a| cage.mass * a),
                dt: span.dt,
            },
            pockets,
            lands: CageLinks::lands(ends.collect(), body, carrier),
        })
    }

    fn pocket_step(
        &self,
        (cage, impact): (&Cage, Impact),
        (state, free): (&CageState, &FreeState),
        span: PartSpan,
        ball: usize,
    ) -> PocketStep {
        let turning = free.turnings[ball];
        let radius = 0.5 * self.model.geometry.ball_diameter;
        let speed = radius * turning.iter().map(|w| w * w).sum::<f64>().sqrt();
        let offset = cage.pocket_offsets.get(ball).copied().unwrap_or(0.0);
        let step = PocketStep {
            dt: span.dt,
            ball: [free.places[ball], free.velocities[ball], turning],
            cage: [state.place, state.rates],
            azimuth: self.model.geometry.azimuth(ball) + offset,
            ball_radius: radius,
            touching: 0.5 * cage.pocket_clearance,
            impact,
            rubbing: cage.rubbing(speed),
        };
        step.after(state.met[ball])
    }

    fn land_step(
        &self,
        (cage, impact, land): (&Cage, Impact, &Land),
        state: &CageState,
        span: PartSpan,
        (n_balls, end): (usize, usize),
        shaft: RingStep,
    ) -> LandStep {
        let ring = RingStep {
            spin: self.turning_step(land.side, span).spin,
            ..land.side.choose(shaft, RingStep::default())
        };
        let h = land.width * (end as f64 - 0.5);
        let step = LandStep {
            dt: span.dt,
            cage: [state.place, state.rates],
            ring,
            land: *land,
            heights: [h, self.cage_height() + h],
            impact,
            rubbing: cage.rubbing(land.radius * (state.rates[5] - ring.spin[1])),
        };
        step.after(state.met[n_balls + end])
    }

    /// Axial distance of the middle of the cage from the origin of the shaft, m: that of the bearing at rest, because a
    /// height that moved would change the stored energy.
    fn cage_height(&self) -> f64 {
        let geometry = &self.model.geometry;
        geometry.ball_centre().axial - geometry.groove_centre(Side::Inner).axial
    }

    /// New state and works of the cage.
    pub(super) fn finish_cage(
        &self,
        (before, next): (&FreeState, &mut Ledger),
        parts: &BearingParts,
        solution: &StepSolution,
    ) -> Option<CageState> {
        let cage = parts.free.as_ref()?.cage.as_ref()?;
        let (found, before) = (solution.cage.as_ref()?, before.cage.as_ref()?);
        let mut ledger = next.cage.unwrap_or_default();
        let all = || found.pockets.iter().chain(&found.lands);
        // Where a contact stands in a step that begins is where the last one ended, but for round-off.
        ledger.strain = all().map(|force| force.energy).sum();
        for force in all() {
            ledger.impact_loss += force.impact_loss;
            ledger.friction_loss -= force.friction_work;
            ledger.integrator_share += force.work_at_slip - force.friction_work;
        }
        ledger.drag_loss += found.drag[0];
        next.load_work += cage.body.load_work(&found.end);
        let on_land = found.lands.iter().map(|force| force.torque).sum::<f64>() + found.drag[1];
        let turned = cage
            .lands
            .contacts
            .first()
            .map_or(0.0, |end| end.ring.spin[0] * end.dt);
        ledger.drive_work += on_land * turned;
        let rates = cage.body.rates_at_end(&found.end);
        let mut place = before.place;
        place.iter_mut().zip(found.end).for_each(|(x, u)| *x += u);
        let mut new = CageState {
            place,
            rates,
            met: Vec::new(),
            pockets: found.pockets.iter().map(|force| force.normal).collect(),
            lands: found.lands.iter().map(|force| force.normal).collect(),
            torques: [found.pockets.iter().map(|force| force.torque).sum(), on_land],
        };
        let impacts = cage.pockets.contacts.iter().map(|contact| contact.impact);
        let impacts = impacts.chain(cage.lands.contacts.iter().map(|contact| contact.impact));
        new.met = all()
            .zip(impacts)
            .map(|(force, impact)| if force.touches { impact.speed() } else { 0.0 })
            .collect();
        ledger.kinetic = new.kinetic(cage.body.masses);
        next.cage = Some(ledger);
        Some(new)
    }

    /// Energies of a cage at the start of a motion.
    pub(super) fn cage_ledger(&self, state: &MotionState) -> Option<CageLedger> {
        let (cage, free) = (self.model.cage.as_ref()?, state.free.as_ref()?);
        let cage_state = free.cage.as_ref()?;
        let span = PartSpan {
            start: self.time(state.step),
            dt: self.settings.dt,
            rung: 0,
        };
        let parts = self.cage_parts(free, span, [0.0; 3], self.carrier_step(state, span, Side::Inner))?;
        let overlaps = parts.pockets.contacts.iter().map(PocketStep::overlap_at_start);
        let overlaps = overlaps.chain(parts.lands.contacts.iter().map(LandStep::overlap_at_start));
        let impact = cage.impact();
        Some(CageLedger {
            kinetic: cage_state.kinetic(cage.masses()),
            strain: overlaps.map(|overlap| impact.energy_at(overlap)).sum(),
            ..CageLedger::default()
        })
    }
}
