//! A step in time of a bearing whose inner ring is a free mesh, beside one solve of that ring.
//!
//! The outer ring is periodic, 57 k dofs. The bearing rolls at 1800 rpm under 2 kN and 1 kN. A free mesh has no sectors
//! to share work: it is one sparse factor. Steps and solves take turns, so that other work on the machine meets both.
//! The solve is one right-hand side of the ring's sparse factor, K + s M with the s of the step, on one thread. Run
//! with `cargo bench -p raceway --bench free_mesh`.
//!
//!     cargo bench -p raceway --bench free_mesh -- [MESH]
//!
//! MESH is another inner ring of the 7010C in millimetres, such as that of docs/dev/performance.md with 400 k dofs;
//! without it the ring is meshes/7010c_inner_tet10.msh.

#[path = "../crates/dynamics/tests/support/mod.rs"]
mod support;

#[path = "../crates/dynamics/benches/support/clock.rs"]
mod clock;

#[path = "support/rolling.rs"]
mod rolling;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clock::Runs;
use contact::Side;
use dynamics::{Backend, ContactMode, Hold, Model};
use ring::{Partner, RingToVibrate, VibratingRings};
use rolling::{DT, Rolling};
use support::Case;
use support::rings::{Level, ring_model};

/// Steps and solves.
const REPEATS: usize = 24;

fn bearing(mesh: &Path) -> Model {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    };
    let mut model = case.flexible(ContactMode::Patch, Level::hex8(180, 14, 3, 4), Hold::Clamped);
    let mesh = mesh::read_msh(mesh, 1e-3).expect("an inner ring of the 7010C");
    model.rings[0] = Some(Arc::new(ring_model(Side::Inner, mesh, Hold::Clamped)));
    model
}

/// The free ring with the factor of K + s M.
fn alone(model: &Model) -> VibratingRings {
    let ring = model.rings[0].as_ref().expect("the inner ring");
    // Average acceleration: the effective matrix is 2 / dt^2 M + K / 2.
    let shift = 4.0 / DT.powi(2);
    let ring = RingToVibrate {
        name: "inner",
        ring,
        partner: Some((Partner::SHAFT, [0.0; 5])),
    };
    VibratingRings::new(&[ring], shift, Backend::Auto).expect("the ring is held")
}

fn main() {
    let given = std::env::args().skip(1).find(|a| !a.starts_with("--"));
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/7010c_inner_tet10.msh");
    let model = bearing(&given.map_or(own, PathBuf::from));
    let alone = alone(&model);
    let mut rolling = Rolling::new(&model);
    let n = Side::BOTH.map(|side| rolling.motion.n_coordinates(side));
    println!(
        "== {} and {} coordinates, {} threads, factors and tables {:.1} MB",
        n[0],
        n[1],
        rayon::current_num_threads(),
        1e-6 * rolling.motion.factor_bytes() as f64
    );
    let (mut solves, mut load) = (Runs::default(), vec![1.0; alone.n()]);
    for _ in 0..REPEATS {
        rolling.step();
        solves.time("solve", || alone.solve(&mut load, 1));
        solves.end_run();
    }
    rolling.print("rolls");
    solves.print();
    let [step, solve] = [rolling.laps.least("step"), solves.least("solve")];
    println!(
        "\nstep {:.1} ms, solve {:.1} ms: {:.2} solves by the wall, {:.2} by processor time",
        1e3 * step[1],
        1e3 * solve[1],
        step[1] / solve[1],
        step[0] / solve[0]
    );
}
