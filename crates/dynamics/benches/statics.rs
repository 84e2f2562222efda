//! A static bearing of 2 x 57 k dof: total time over the time of its two factorisations, and where the rest goes.
//!
//! The first report takes every figure from the same run, several times over, and prints its minimum and its median
//! in seconds of processor time and of wall time. The factorisations are those of one ring after the other on one
//! thread: order, analysis, numbers. On a machine with other work only the minima of processor time mean much. The
//! target is a total, mesh in memory to equilibrium, of at most 3 factorisations. Run with
//! `cargo bench -p raceway-dynamics`.
//!
//! Measured, 2-core machine shared with other work, November 2026, least processor seconds of 7 runs: hex8 (2 x 56
//! 700 dof) order 0.08, analysis 0.11, numbers 0.57, assembly 0.31, solve 0.56, total 1.66 = 2.2 factorisations, or
//! 2.9 of their numeric part alone; hex20 (2 x 51 570 dof) 0.04, 0.20, 1.00, 0.49, 0.73, total 2.45 = 2.0 or 2.4. On
//! two threads the totals took 0.9 and 1.3 s of wall time.

#[path = "../tests/support/mod.rs"]
mod support;

#[path = "support/clock.rs"]
mod clock;

use std::sync::{Arc, LazyLock};

use clock::Runs;
use contact::Side;
use divan::Bencher;
use divan::counter::BytesCount;
use dynamics::costs::{COLUMNS, NEWTON, PATCHES, SOLVE};
use dynamics::{ContactMode, Hold, Model, RingModel, StaticSolver};
use solver::{LinearSolver, SparseCholesky, Symbolic};
use sprs::CsMat;
use support::Case;
use support::rings::{Level, ring};

/// Runs of each bearing.
const REPEATS: usize = 7;

/// hex8, 56 700 dof per ring.
const HEX8: Level = Level::hex8(180, 14, 3, 4);
/// hex20, 51 570 dof per ring.
const HEX20: Level = Level::hex20(90, 8, 2, 3);

/// 2 kN of preload and 1 kN radially: no two balls are loaded alike.
fn load_case() -> Case {
    Case {
        radial: 1000.0,
        ..Case::axial(2000.0)
    }
}

/// What is factored of one ring, seat or bore clamped: the lower triangle of the free dofs.
struct Stiffness {
    matrix: CsMat<f64>,
    free: Vec<usize>,
}

fn assemble(ring: &RingModel) -> Stiffness {
    let full = fem::assemble_stiffness(&ring.mesh, &ring.material).expect("the mesh is sound");
    let held = fem::facet_node_weights(&ring.mesh, ring.mesh.group(ring.held_group));
    let mut is_free = vec![true; ring.mesh.n_nodes()];
    held.iter().for_each(|&(node, _)| is_free[node] = false);
    let free: Vec<usize> = (0..ring.mesh.n_dofs()).filter(|&dof| is_free[dof / 3]).collect();
    Stiffness {
        matrix: solver::restrict_lower(&full, &free),
        free,
    }
}

fn order(ring: &RingModel, stiffness: &Stiffness) -> Vec<usize> {
    let mesh = &ring.mesh;
    let nodes = solver::angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
    solver::restrict_order(&solver::expand(&nodes, 3), &stiffness.free)
}

fn analyse(stiffness: &Stiffness, order: &[usize]) -> Symbolic {
    Symbolic::new(&stiffness.matrix, order).expect("the order is a permutation of the rows")
}

fn factor(stiffness: &Stiffness, symbolic: &Symbolic) -> SparseCholesky {
    symbolic
        .factor(&stiffness.matrix)
        .expect("a clamped ring is positive definite")
}

/// One bearing from section to equilibrium, every part on the clock.
fn run(level: Level, laps: &mut Runs) {
    let mut model = load_case().rigid();
    model.contact.mode = ContactMode::Patch;
    model.rings = Side::BOTH.map(|side| {
        let ring = laps.time("mesh, both rings", || ring(side, level, Hold::Clamped));
        Some(Arc::new(ring))
    });
    for ring in model.rings.iter().flatten() {
        let stiffness = laps.time("assemble, both rings", || assemble(ring));
        let order = laps.time("order, both rings", || order(ring, &stiffness));
        let symbolic = laps.time("analyse, both rings", || analyse(&stiffness, &order));
        laps.time("factor, both rings", || {
            divan::black_box(factor(&stiffness, &symbolic))
        });
    }
    let mut solver = laps.time("total/new: assemble and factor", || new_solver(&model));
    let solution = laps
        .time("total/solve", || solver.solve(&model, None))
        .expect("the bearing has an equilibrium");
    for (part, lap) in [
        ("total/solve/columns", COLUMNS),
        ("total/solve/patches", PATCHES),
        ("total/solve/solves", SOLVE),
        ("total/solve/newton", NEWTON),
    ] {
        laps.add_wall(part, solver.timing.seconds(lap));
    }
    laps.note = format!(
        "{} rounds, {} newton iterations",
        solution.rounds, solution.newton_iterations
    );
    laps.end_run();
}

fn new_solver(model: &Model) -> StaticSolver {
    StaticSolver::new(model).expect("clamped rings can be factored")
}

fn report(name: &str, level: Level) {
    let mut laps = Runs::default();
    for _ in 0..REPEATS {
        run(level, &mut laps);
    }
    let n_dofs = ring(Side::Inner, level, Hold::Clamped).mesh.n_dofs();
    println!("{name}, 2 x {n_dofs} dof, {} runs, {}", REPEATS, laps.note);
    laps.print();
    let factorisation = ["order, both rings", "analyse, both rings", "factor, both rings"];
    let [cpu, wall] = laps.ratio(&["total"], &factorisation);
    println!(
        "total / (order + analyse + factor): {cpu:.2} of processor time, {wall:.2} of wall time; target 3"
    );
    let [cpu, wall] = laps.ratio(&["total"], &factorisation[2..]);
    println!("total / numeric factorisation alone: {cpu:.2} of processor time, {wall:.2} of wall time");
}

/// The solve of the inner ring against the time to read its factor twice.
fn report_solve() {
    let factor = &RING.factor;
    let bandwidth = clock::read_bandwidth(factor.factor_bytes());
    println!(
        "inner ring: factor {:.1} MB, read bandwidth of an array of that size {:.1} GB/s",
        factor.factor_bytes() as f64 / 1e6,
        bandwidth / 1e9
    );
    for n_rhs in [1, 36] {
        let mut rhs = vec![1.0; factor.n() * n_rhs];
        let seconds = clock::least_wall(REPEATS, || factor.solve(&mut rhs, n_rhs));
        let traffic = 2.0 * factor.factor_bytes() as f64 / seconds;
        println!(
            "{n_rhs:2} right-hand sides: {:.1} ms, {:.1} GB/s of 2 x factor, {:.2} x the floor of one solve",
            1e3 * seconds,
            traffic / 1e9,
            bandwidth / traffic
        );
    }
}

/// The inner ring and everything made from it.
struct Ring {
    model: RingModel,
    stiffness: Stiffness,
    symbolic: Symbolic,
    factor: SparseCholesky,
}

static RING: LazyLock<Ring> = LazyLock::new(|| {
    let model = ring(Side::Inner, HEX8, Hold::Clamped);
    let stiffness = assemble(&model);
    let symbolic = analyse(&stiffness, &order(&model, &stiffness));
    let factor = factor(&stiffness, &symbolic);
    Ring {
        model,
        stiffness,
        symbolic,
        factor,
    }
});

#[divan::bench(sample_count = 10)]
fn ring_assemble(bencher: Bencher) {
    bencher.bench(|| assemble(&RING.model));
}

#[divan::bench(sample_count = 10)]
fn ring_order(bencher: Bencher) {
    bencher.bench(|| order(&RING.model, &RING.stiffness));
}

#[divan::bench(sample_count = 10)]
fn ring_analyse(bencher: Bencher) {
    let order = RING.symbolic.order();
    bencher.bench(|| analyse(&RING.stiffness, order));
}

#[divan::bench(sample_count = 10)]
fn ring_factor(bencher: Bencher) {
    bencher.bench(|| factor(&RING.stiffness, &RING.symbolic));
}

#[divan::bench(args = [1, 36], sample_count = 20)]
fn ring_solve(bencher: Bencher, n_rhs: usize) {
    let factor = &RING.factor;
    bencher
        .counter(BytesCount::new(2 * factor.factor_bytes()))
        .with_inputs(|| vec![1.0; factor.n() * n_rhs])
        .bench_local_refs(|rhs| factor.solve(rhs, n_rhs));
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn bearing_total(bencher: Bencher) {
    let model = load_case().flexible(ContactMode::Patch, HEX8, Hold::Clamped);
    bencher.bench(|| new_solver(&model).solve(&model, None));
}

fn main() {
    report("hex8", HEX8);
    report("hex20", HEX20);
    report_solve();
    divan::main();
}
