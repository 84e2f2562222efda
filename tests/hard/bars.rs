//! An elastic bar on a rigid wall, see [`super::rod`].

use dynamics::interactions::discrete_gradient::ContactScheme;
use dynamics::motion::Integrator;

use super::plot::{Curve, Plot};
use super::record::{LEDGER, Record};
use super::{HardCase, Pace};

use super::rod::{DOYEN, ELEMENTS, Rod};

pub fn cases() -> Vec<HardCase> {
    let case = |name, why, settings, run| HardCase::new(name, Pace::Fast, why, settings, run);
    let conserving = "100 elements, time step of one element's wave; average acceleration, discrete gradient";
    vec![
        case(
            "bar_on_wall",
            "a shock wave in the bar; contact must open when the wave returns, not before",
            conserving,
            |record| doyen(record, Integrator::average_acceleration(), "average acceleration"),
        ),
        case(
            "bar_on_wall_chung_hulbert",
            "dissipation must only take energy, and not the rebound",
            "the same with chung_hulbert, rho = 0.8",
            |record| doyen(record, Integrator::chung_hulbert(0.8), "chung_hulbert 0.8"),
        ),
        case(
            "bar_on_wall_hht",
            "a published case gains energy with HHT (x1.88)",
            "the same with hht, alpha = 0.1",
            |record| doyen(record, Integrator::hht(0.1), "hht 0.1"),
        ),
        case(
            "bar_on_wall_pointwise",
            "average acceleration with forces at points in time: the comparison",
            "the same with pointwise forces",
            pointwise,
        ),
        case(
            "vm85_bar",
            "the verification problem, in its own units; elements of aspect 100",
            conserving,
            vm85,
        ),
        case(
            "bar_bounces",
            "three bounces under gravity, waves that never die",
            "g = 10 m/s2, dropped by 5 m",
            bounces,
        ),
        case(
            "bar_meets_bar_of_its_mass",
            "no support at all: only momentum and energy hold",
            "the wall is a free body with the mass of the bar",
            momentum,
        ),
    ]
}

/// The impact of Doyen, Ern and Piperno with a scheme that may dissipate.
fn doyen(record: &mut Record, integrator: Integrator, name: &str) {
    let rod = DOYEN;
    let dt = rod.length / ELEMENTS as f64 / rod.wave();
    let flight = rod.fly(integrator, ContactScheme::DiscreteGradient, dt, 450);
    let crossing = 2.0 * rod.length / rod.wave();
    record.near("touch, s,", flight.touch, rod.gap / rod.speed, 0.01);
    record.near("contact, s,", flight.part - flight.touch, crossing, 0.05);
    record.near(
        "impulse, N s,",
        flight.impulse,
        2.0 * rod.mass() * rod.speed,
        0.03,
    );
    record.note_defect(flight.defect);
    record.below("ledger defect", flight.defect, LEDGER);
    record.below("energy at any time over the first", flight.energy[1], 1.0 + 1e-9);
    if integrator.is_conserving() {
        record.near("least energy over the first", flight.energy[0], 1.0, 1e-9);
    } else {
        record.near("least energy over the first", flight.energy[0], 1.0, 0.1);
    }
    record.near(
        "velocity of the centre after, m/s,",
        flight.end[0],
        rod.speed,
        0.03,
    );
    let pointwise = rod.fly(integrator, ContactScheme::Pointwise, dt, 450);
    record.note(format!(
        "pointwise forces: energy up to {:.4} of the first",
        pointwise.energy[1]
    ));
    let curve = |name: &str, points: &[[f64; 2]]| Curve {
        name: name.to_string(),
        points: points.to_vec(),
    };
    let exact = [
        [0.0, 0.0],
        [0.5, 0.0],
        [0.5, rod.force(rod.speed)],
        [0.5 + crossing, rod.force(rod.speed)],
        [0.5 + crossing, 0.0],
        [1.5, 0.0],
    ];
    record.plot = Some(Plot {
        x: "time, s",
        y: "contact force, N",
        curves: vec![curve(name, &flight.force), curve("closed form", &exact)],
    });
}

fn pointwise(record: &mut Record) {
    let rod = DOYEN;
    let dt = rod.length / ELEMENTS as f64 / rod.wave();
    let flight = rod.fly(
        Integrator::average_acceleration(),
        ContactScheme::Pointwise,
        dt,
        450,
    );
    record.note_defect(flight.defect);
    record.that(
        "the ledger catches it: the defect exceeds 1e-6",
        flight.defect > LEDGER,
    );
    record.note(format!(
        "energy between {:.4} and {:.4} of the first, defect {:.1e}",
        flight.energy[0], flight.energy[1], flight.defect
    ));
}

fn vm85(record: &mut Record) {
    // Inches, pounds, seconds: nothing in the code knows a unit.
    let rod = Rod {
        length: 1e4,
        side: 1.0,
        modulus: 30e6,
        density: 0.00073,
        gap: 0.64,
        speed: 100.0,
        gravity: 0.0,
        softness: 1e-6,
        wall: 1e9,
    };
    let dt = rod.length / ELEMENTS as f64 / rod.wave();
    let flight = rod.fly(
        Integrator::average_acceleration(),
        ContactScheme::DiscreteGradient,
        dt,
        300,
    );
    record.near("wave time L/c, s,", rod.length / rod.wave(), 0.0493288, 1e-5);
    // Impact falls into a step: its middle is noted.
    record.below(
        "touch less 0.0064 s over a step",
        (flight.touch - 0.0064).abs() / dt,
        1.0,
    );
    record.near("contact, s,", flight.part - flight.touch, 2.0 * 0.0493288, 0.05);
    record.note_defect(flight.defect);
    record.below("ledger defect", flight.defect, LEDGER);
    record.below("energy at any time over the first", flight.energy[1], 1.0 + 1e-9);
    record.near(
        "velocity of the centre after, in/s,",
        flight.end[0],
        rod.speed,
        0.03,
    );
}

fn bounces(record: &mut Record) {
    let rod = Rod {
        speed: 0.0,
        gravity: 10.0,
        ..DOYEN
    };
    let dt = rod.length / ELEMENTS as f64 / rod.wave();
    let flight = rod.fly(
        Integrator::average_acceleration(),
        ContactScheme::DiscreteGradient,
        dt,
        2400,
    );
    record.near(
        "first touch, s,",
        flight.touch,
        (2.0 * rod.gap / rod.gravity).sqrt(),
        0.01,
    );
    record.note_defect(flight.defect);
    record.below("ledger defect", flight.defect, LEDGER);
    record.that("three bounces or more", flight.touches.len() >= 3);
    record.note(format!("{} touches in 8 s", flight.touches.len()));
    record.plot = Some(Plot {
        x: "time, s",
        y: "contact force, N",
        curves: vec![Curve {
            name: "force".to_string(),
            points: flight.force,
        }],
    });
}

fn momentum(record: &mut Record) {
    let rod = Rod { wall: 1.0, ..DOYEN };
    let dt = rod.length / ELEMENTS as f64 / rod.wave();
    let flight = rod.fly(
        Integrator::average_acceleration(),
        ContactScheme::DiscreteGradient,
        dt,
        450,
    );
    let sum = flight.end[0] + flight.end[1];
    record.near("momentum after over before", sum / -rod.speed, 1.0, 1e-12);
    record.note_defect(flight.defect);
    record.below("ledger defect", flight.defect, LEDGER);
    record.that("they part", flight.part > flight.touch);
    record.note(format!(
        "bar {:.4} m/s, body {:.4} m/s after: part of the energy stays in the bar's waves",
        flight.end[0], flight.end[1]
    ));
}
