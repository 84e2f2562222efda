//! What spins, by schemes that damp.

use dynamics::Hold;
use dynamics::kinematics::Speed;
use dynamics::motion::{Integrator, MotionSettings, MotionState};
use ring::Frame;

use super::{RATE, TINY, fly, free_ring, ratio, rigid_shaft};

/// Wrong: a scheme that damps would feed the nutation of what spins, with the moment of another time than that at which
/// it balances: a third of its energy in these 15 rad of a rigid shaft by HHT, of first order in the step. It loses
/// next to nothing, and the ledger says so.
#[test]
fn no_scheme_feeds_the_nutation() {
    let speed = Speed::constant(18e3 * std::f64::consts::PI / 30.0);
    let models = [
        (rigid_shaft(&speed), 1.5),
        (free_ring(TINY, Hold::Clamped, &speed, Frame::Still), 0.0),
        (free_ring(TINY, Hold::Clamped, &speed, Frame::Turning), 0.0),
    ];
    for (model, known) in models {
        let nutation = speed.at(0.0) * if known > 0.0 { known } else { ratio(&model) };
        for integrator in [Integrator::chung_hulbert(0.5), Integrator::hht(0.3)] {
            let settings = MotionSettings {
                integrator,
                ..MotionSettings::conserving(0.05 / nutation, speed.clone())
            };
            let states = fly(&model, settings, [0.0, 0.0, 0.0, RATE, 0.0], 300);
            let rate = |state: &MotionState| state.shaft_velocity[3].hypot(state.shaft_velocity[4]);
            let growth = rate(&states[300]) / rate(&states[5]) - 1.0;
            let ledger = &states[300].ledger;
            let [loss, defect] = [ledger.numerical_loss / ledger.largest, ledger.relative_defect()];
            println!("{integrator:?}: {growth:.2e}, loss {loss:.2e}, defect {defect:.1e}");
            assert!(
                growth.abs() < 1e-3 && loss > 0.0,
                "{integrator:?}: {growth} {loss}"
            );
            // The energy of a ring is small beside the round-off of its strain.
            let round_off = if known > 0.0 { 1e-12 } else { 1e-4 };
            assert!(defect.abs() < round_off, "{integrator:?}: {ledger:?}");
        }
    }
}
