//! Whether the state at the end of a part of a step is made of numbers.
//!
//! A NaN spreads: one component of a ring's displacement or velocity is in its energy, so that a few sums tell of all.
//! It may come from overflow, or to one rank alone in a message; a state that has one must never be the start of the
//! next step.

use contact::{Meridian, Side};

use super::free_state::FreeState;
use super::state::MotionState;
use crate::error::DynamicsError;

/// Fails when something of a state is NaN or infinite. Costs a few hundred additions.
pub(super) fn require_finite(state: &MotionState) -> Result<(), DynamicsError> {
    let ledger = &state.ledger;
    let of_balls = [&state.balls, &state.ball_velocities, &state.ball_accelerations];
    let of_contacts = [&state.angles, &state.approaches];
    let balls = of_balls.into_iter().flat_map(|x| Meridian::flat(x)).sum::<f64>();
    let free = state.free.iter().map(FreeState::sum).sum::<f64>();
    let friction: f64 = ledger
        .friction
        .iter()
        .map(|f| f.loss + f.drive_work + f.drag_loss)
        .sum();
    let cage = ledger.cage.map_or(0.0, |c| {
        c.kinetic + c.strain + c.impact_loss + c.friction_loss + c.drag_loss + c.drive_work
    });
    let contacts = of_contacts
        .into_iter()
        .flatten()
        .copied()
        .chain(Meridian::flat(&state.forces))
        .sum::<f64>();
    let shaft = [state.shaft, state.shaft_velocity, state.shaft_acceleration];
    let [inner, outer] = Side::BOTH
        .map(Side::index)
        .map(|i| ledger.kinetic[i] + ledger.strain[i]);
    let works: f64 = ledger.works().iter().chain(&ledger.losses()).sum();
    let sums = [
        ("the energy of the inner ring at the end of a step", inner),
        ("the energy of the outer ring at the end of a step", outer),
        (
            "the motion of the balls at the end of a step",
            balls + free + ledger.kinetic[2],
        ),
        (
            "the motion of the shaft at the end of a step",
            shaft.iter().flatten().sum(),
        ),
        (
            "the motion of the outer ring's seat at the end of a step",
            state.seat.iter().flatten().sum(),
        ),
        ("the contacts at the end of a step", contacts + ledger.hertz),
        ("the work of a step", works + friction + cage),
    ];
    match sums.into_iter().find(|(_, sum)| !sum.is_finite()) {
        Some((what, _)) => Err(DynamicsError::NotFinite { what }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(change: impl Fn(&mut MotionState)) -> String {
        let mut state = MotionState {
            balls: vec![Meridian::new(1e-6, 1e-6); 3],
            ball_velocities: vec![Meridian::new(0.1, 0.1); 3],
            ball_accelerations: vec![Meridian::new(10.0, 10.0); 3],
            forces: vec![Meridian::new(1e3, 1e3); 6],
            angles: vec![0.3; 6],
            approaches: vec![1e-6; 6],
            ..MotionState::default()
        };
        change(&mut state);
        require_finite(&state).map_or_else(|error| error.to_string(), |()| String::new())
    }

    /// Wrong: a number that a rank has received as NaN would be stepped on with, and written as a result.
    #[test]
    fn a_number_that_is_none_is_named() {
        assert_eq!(said(|_| {}), "");
        for (text, change) in [
            (
                "the energy of the outer ring",
                (|s| s.ledger.strain[1] = f64::NAN) as fn(&mut MotionState),
            ),
            ("the energy of the inner ring", |s| {
                s.ledger.kinetic[0] = f64::INFINITY
            }),
            ("the motion of the balls", |s| {
                s.ball_velocities[2].axial = f64::NAN
            }),
            ("the motion of the shaft", |s| s.shaft[4] = f64::NEG_INFINITY),
            ("the contacts", |s| s.angles[5] = f64::NAN),
            ("the work of a step", |s| s.ledger.frame_work = f64::NAN),
        ] {
            let found = said(change);
            let expected = format!("{text} at the end of a step is not finite");
            assert!(
                found.starts_with(&expected) || found.starts_with(&format!("{text} is not finite")),
                "{found}"
            );
        }
    }
}
