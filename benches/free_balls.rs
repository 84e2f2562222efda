//! A step in time of a bearing of 2 x 57 k dof with free balls, traction and a free cage, beside the same step without.
//!
//! The bearing rolls at 1800 rpm under 2 kN and 1 kN, on half-spaces, as free balls are. Traction has 3 x 15 places a
//! contact. Steps of the three bearings take turns on one thread, so that other work on the machine meets all. The
//! table has the least wall time of each, as the processor's clock may tick every 4 ms, and its ratio to that of the
//! bearing without. Run with `cargo bench -p raceway --bench free_balls`. Results: docs/dev/performance.md.

#[path = "../crates/dynamics/tests/support/mod.rs"]
mod support;

#[path = "../crates/dynamics/benches/support/clock.rs"]
mod clock;

#[path = "support/rolling.rs"]
mod rolling;

use contact::{Side, SphereCompliance};
use dynamics::effects::ball_centrifugal::BallCentrifugal;
use dynamics::effects::traction::FreeBalls;
use dynamics::interactions::cage::{Cage, Land};
use dynamics::interactions::traction::{Creep, PatchPoints, Traction, TractionLaw};
use dynamics::kinematics::{BallSpeeds, Speed};
use dynamics::{ContactMode, Hold, Model};
use rolling::{Rolling, SPEED};
use support::Case;
use support::rings::Level;

/// Steps of each.
const REPEATS: usize = 200;

fn bearing() -> Model {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, Level::hex8(180, 14, 3, 4), Hold::Clamped);
    model.sphere = SphereCompliance::default();
    model.shaft_mass = 0.5;
    model
}

fn with_free_balls(mut model: Model) -> Model {
    model.effects.push(Box::new(FreeBalls {
        traction: Traction {
            law: TractionLaw::Coulomb(0.07),
            creep: Creep::Elastic,
            places: PatchPoints::new([3, 15]),
        },
        at_start: BallCentrifugal {
            speeds: Speed::constant(SPEED).into(),
            slip: [0.0; 2],
            ball_speeds: BallSpeeds::OuterControl,
        },
    }));
    model
}

/// A polymer cage on the lands of the outer ring.
fn with_cage(mut model: Model) -> Model {
    model.cage = Some(Cage {
        mass: 0.012,
        polar: 1.2e-5,
        transverse: 6.5e-6,
        pocket_clearance: 0.2e-3,
        pocket_offsets: Vec::new(),
        stiffness: 2e8,
        restitution: 0.6,
        friction: 0.1,
        land: Some(Land {
            side: Side::Outer,
            radius: 35e-3,
            width: 10e-3,
            clearance: 0.3e-3,
            viscosity: 0.0,
        }),
    });
    model
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread").install(|| {
        let models = [
            bearing(),
            with_free_balls(bearing()),
            with_cage(with_free_balls(bearing())),
        ];
        let mut bearings: Vec<Rolling> = models.iter().map(Rolling::new).collect();
        for _ in 0..REPEATS {
            bearings.iter_mut().for_each(Rolling::step);
        }
        let n = Side::BOTH.map(|side| bearings[0].motion.n_coordinates(side));
        println!("== {} and {} coordinates, one thread", n[0], n[1]);
        let names = ["balls that roll", "free balls", "free balls and cage"];
        for (name, bearing) in names.iter().zip(&bearings) {
            bearing.print(name);
        }
        let least = |bearing: &Rolling| bearing.laps.least("step")[1];
        let base = least(&bearings[0]);
        println!("\nleast wall time of a step, ms, and over that of balls that roll");
        for (name, bearing) in names.iter().zip(&bearings) {
            println!(
                "{name:22} {:8.2} {:6.2}",
                1e3 * least(bearing),
                least(bearing) / base
            );
        }
    });
}
