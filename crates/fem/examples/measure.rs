//! Times assembly, loads and stress recovery on a ring:
//! `cargo run --release -p raceway-fem --example measure [hex8|hex20|tet10]`.
//!
//! Best of several repeats on one thread and on all. Measured on one thread of a 2-core Xeon (Sapphire Rapids, 2.3
//! GHz, shared with other work, load 2.4), November 2026, ms:
//!
//! | | hex8, 68 040 dofs | hex20, 70 740 dofs | tet10, 65 520 dofs |
//! |---|---|---|---|
//! | pattern | 13 | 38 | 23 |
//! | stiffness values | 86 | 111 | 33 |
//! | stiffness with pattern and matrix | 148 | 264 | 119 |
//! | mass values | 44 | 134 | 194 |
//! | centrifugal load | 24 | 58 | 105 |
//! | stress at points | 18 | 17 | 5 |
//! | stress at nodes | 19 | 13 | 5 |

#[path = "../tests/fem/support/grids.rs"]
#[allow(dead_code)]
mod grids;

use std::time::Instant;

use fem::{Material, Pattern, StressRecovery, StressWorkspace};
use mesh::{ElementKind, Mesh};

/// Repeats of which the best is printed.
const REPEATS: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let wanted = std::env::args().nth(1).unwrap_or_else(|| "hex8".into());
    let kind = ElementKind::ALL.into_iter().find(|kind| kind.name() == wanted);
    let kind =
        kind.ok_or_else(|| format!("unknown element \"{wanted}\"; elements are hex8, hex20, tet10"))?;
    let cells = match kind {
        ElementKind::Hex8 => [6, 360, 8],
        ElementKind::Hex20 => [3, 180, 8],
        ElementKind::Tet10 => [3, 120, 6],
    };
    let mesh = grids::ring(kind, cells, [0.0370, 0.0400], 0.016, std::f64::consts::TAU);
    println!("{wanted}: {} elements, {} dofs", mesh.n_elements(), mesh.n_dofs());
    for threads in [1, rayon::current_num_threads()] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        println!("{threads} thread(s)");
        pool.install(|| measure(&mesh))?;
    }
    Ok(())
}

/// Prints the best time of every operation.
fn measure(mesh: &Mesh) -> Result<(), fem::FemError> {
    let material = Material::new(207e9, 0.3, 7800.0)?;
    let pattern = Pattern::new(mesh)?;
    let mut values = vec![0.0; pattern.n_values()];
    best("pattern", || Pattern::new(mesh).map(drop))?;
    best("stiffness values", || {
        fem::assemble_stiffness_into(&pattern, mesh, &material, &mut values)
    })?;
    best("stiffness, whole", || {
        fem::assemble_stiffness(mesh, &material).map(drop)
    })?;
    best("mass values", || {
        fem::assemble_mass_into(&pattern, mesh, &material, &mut values)
    })?;
    best("centrifugal load", || {
        fem::centrifugal_load(mesh, 7800.0, 188.5).map(drop)
    })?;
    let recovery = StressRecovery::new(mesh, &material)?;
    let u: Vec<f64> = (0..mesh.n_dofs())
        .map(|i| 1e-6 * (0.1 * i as f64).sin())
        .collect();
    let mut stress = vec![[0.0; 6]; mesh.n_nodes()];
    let mut workspace = StressWorkspace::default();
    best("stress recovery set-up", || {
        StressRecovery::new(mesh, &material).map(drop)
    })?;
    best("stress at points", || {
        std::hint::black_box(recovery.integration_points(&u));
        Ok(())
    })?;
    best("stress at nodes", || {
        recovery.nodal_into(&u, &mut workspace, &mut stress);
        Ok(())
    })
}

/// Prints the best wall time of an operation, ms.
fn best(name: &str, mut run: impl FnMut() -> Result<(), fem::FemError>) -> Result<(), fem::FemError> {
    let mut shortest = f64::INFINITY;
    for _ in 0..REPEATS {
        let start = Instant::now();
        run()?;
        shortest = shortest.min(start.elapsed().as_secs_f64());
    }
    println!("  {name:24} {:8.2} ms", 1e3 * shortest);
    Ok(())
}
