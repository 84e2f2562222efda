//! Order, analyse, factor and solve (1 and 36 right-hand sides) on a revolved ring of 57 k dof.
//!
//! The floor of a solve is the time to read the stored factor twice; the memory bandwidth is measured in the same
//! process, by summing an array as large as the factor, and the ratio to the floor printed first. Run with
//! `cargo bench -p raceway-solver`.

use std::sync::LazyLock;
use std::time::{Duration, Instant};

use divan::Bencher;
use divan::counter::BytesCount;
use solver::{LinearSolver, SparseCholesky, Symbolic, angular_dissection, expand};
use sprs::CsMat;

const SECTORS: usize = 360;
const SECTION: [usize; 2] = [11, 5];

/// The ring and everything made from it.
struct Ring {
    points: Vec<[f64; 3]>,
    elements: Vec<usize>,
    matrix: CsMat<f64>,
    symbolic: Symbolic,
    factor: SparseCholesky,
}

static RING: LazyLock<Ring> = LazyLock::new(|| {
    let points = points();
    let elements = elements();
    let matrix = matrix();
    let symbolic = Symbolic::new(&matrix, &expand(&angular_dissection(&points, &elements, 8), 3))
        .expect("the pattern is square and the order a permutation");
    let factor = symbolic
        .factor(&matrix)
        .expect("the matrix is diagonally dominant");
    Ring {
        points,
        elements,
        matrix,
        symbolic,
        factor,
    }
});

fn node(sector: usize, z: usize, r: usize) -> usize {
    ((sector % SECTORS) * SECTION[0] + z) * SECTION[1] + r
}

fn points() -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for sector in 0..SECTORS {
        let (sin, cos) = (std::f64::consts::TAU * sector as f64 / SECTORS as f64).sin_cos();
        for z in 0..SECTION[0] {
            for r in 0..SECTION[1] {
                let radius = 0.028 + 0.0012 * r as f64;
                points.push([radius * cos, radius * sin, 0.0016 * z as f64]);
            }
        }
    }
    points
}

fn elements() -> Vec<usize> {
    let mut elements = Vec::new();
    for sector in 0..SECTORS {
        for z in 0..SECTION[0] - 1 {
            for r in 0..SECTION[1] - 1 {
                let corners = [[0, 0], [0, 1], [1, 1], [1, 0]];
                for layer in 0..2 {
                    elements.extend(corners.map(|[a, b]| node(sector + layer, z + a, r + b)));
                }
            }
        }
    }
    elements
}

/// All nodes of neighbouring cells coupled in all components, diagonally dominant: the pattern of hexahedra.
fn matrix() -> CsMat<f64> {
    let (mut starts, mut indices, mut values) = (vec![0], Vec::new(), Vec::new());
    for sector in 0..SECTORS {
        for z in 0..SECTION[0] {
            for r in 0..SECTION[1] {
                let mut neighbours = Vec::new();
                for s in [sector + SECTORS - 1, sector, sector + 1] {
                    for zz in z.saturating_sub(1)..(z + 2).min(SECTION[0]) {
                        neighbours
                            .extend((r.saturating_sub(1)..(r + 2).min(SECTION[1])).map(|rr| node(s, zz, rr)));
                    }
                }
                neighbours.sort_unstable();
                for row in 3 * node(sector, z, r)..3 * node(sector, z, r) + 3 {
                    for column in neighbours.iter().flat_map(|&other| 3 * other..3 * other + 3) {
                        indices.push(column);
                        values.push(if row == column {
                            81.0
                        } else {
                            -1.0 / (1 + (row + column) % 3) as f64
                        });
                    }
                    starts.push(indices.len());
                }
            }
        }
    }
    let n = starts.len() - 1;
    CsMat::new((n, n), starts, indices, values)
}

/// Shortest of several runs.
fn best(runs: usize, mut run: impl FnMut()) -> Duration {
    let time = |()| {
        let start = Instant::now();
        run();
        start.elapsed()
    };
    std::iter::repeat_n((), runs).map(time).min().unwrap_or_default()
}

/// Bytes per second of reading an array of `bytes` bytes, eight partial sums.
fn read_bandwidth(bytes: usize) -> f64 {
    let array = vec![1.0_f64; bytes / 8];
    let duration = best(10, || {
        let mut sums = [0.0; 32];
        for chunk in array.chunks_exact(32) {
            sums.iter_mut().zip(chunk).for_each(|(sum, value)| *sum += value);
        }
        divan::black_box(sums);
    });
    bytes as f64 / duration.as_secs_f64()
}

fn report() {
    let ring = &*RING;
    let (n, bytes) = (ring.factor.n(), ring.factor.factor_bytes());
    let factor = best(3, || {
        divan::black_box(ring.symbolic.factor(&ring.matrix)).ok();
    });
    let gflops = ring.symbolic.flops() / factor.as_secs_f64() / 1e9;
    println!(
        "ring of {n} dof: factor {:.1} MB, {gflops:.1} GFlop/s, {factor:.3?}",
        bytes as f64 / 1e6
    );
    let bandwidth = read_bandwidth(bytes);
    println!(
        "read bandwidth of an array of that size: {:.1} GB/s",
        bandwidth / 1e9
    );
    for n_rhs in [1, 36] {
        let mut rhs = vec![1.0; n * n_rhs];
        let duration = best(10, || ring.factor.solve(&mut rhs, n_rhs));
        let traffic = 2.0 * bytes as f64 / duration.as_secs_f64();
        println!(
            "{n_rhs:2} right-hand sides: {duration:.1?}, {:.1} GB/s of 2 x factor, {:.2} x the floor of one solve",
            traffic / 1e9,
            bandwidth / traffic
        );
    }
}

#[divan::bench]
fn order(bencher: Bencher) {
    let ring = &*RING;
    bencher.bench(|| angular_dissection(&ring.points, &ring.elements, 8));
}

#[divan::bench]
fn analyse(bencher: Bencher) {
    let ring = &*RING;
    let order = ring.symbolic.order();
    bencher.bench(|| Symbolic::new(&ring.matrix, order));
}

#[divan::bench(sample_count = 10)]
fn factor(bencher: Bencher) {
    let ring = &*RING;
    bencher.bench(|| ring.symbolic.factor(&ring.matrix));
}

#[divan::bench(args = [1, 36], sample_count = 20)]
fn solve(bencher: Bencher, n_rhs: usize) {
    let factor = &RING.factor;
    bencher
        .counter(BytesCount::new(2 * factor.factor_bytes()))
        .with_inputs(|| vec![1.0; factor.n() * n_rhs])
        .bench_local_refs(|rhs| factor.solve(rhs, n_rhs));
}

fn main() {
    report();
    divan::main();
}
