//! A ring in sectors on one and two threads, against the same ring as one sparse matrix and against the time to read
//! the factor.
//!
//!     cargo bench -p raceway-solver --bench sector -- 65k 150k 400k
//!
//! S = K + c M of a free ring of hex8, c that of a step of 1e-5 s. Every round measures all variants one after the
//! other, and the least of all rounds counts, so that other programs disturb all alike; wall and processor time are
//! given. The floor of a solve is the time to read the stored factor twice, in pieces of a sector's size, by as many
//! threads.

#[path = "support/clock.rs"]
mod clock;
#[path = "support/matrix.rs"]
mod matrix;
#[path = "support/ring.rs"]
mod ring;
#[path = "support/sectors.rs"]
mod sectors;

use std::borrow::Cow;
use std::hint::black_box;
use std::time::Instant;

use comm::Communicator;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use ring::ring;
use solver::{
    LinearSolver, Points, SectorCholesky, SectorSymbolic, Symbolic, angular_dissection, expand,
    restrict_lower,
};

/// Name, layers, nodes of a section across and along.
const SIZES: [(&str, usize, [usize; 2]); 4] = [
    ("20k", 180, [10, 4]),
    ("65k", 360, [12, 5]),
    ("150k", 360, [20, 7]),
    ("400k", 720, [19, 10]),
];
const ROUNDS: usize = 7;

/// Least wall and processor time, ms, of one variant.
#[derive(Clone)]
struct Least {
    name: String,
    ms: [f64; 2],
}

/// Something to measure, and its name.
type Variant<'a> = (String, Box<dyn FnMut() + 'a>);

/// Runs all variants in turn, several times.
fn measure(variants: &mut [Variant<'_>], rounds: usize) -> Vec<Least> {
    let start = |(name, _): &Variant<'_>| Least {
        name: name.clone(),
        ms: [f64::INFINITY; 2],
    };
    let mut least: Vec<Least> = variants.iter().map(start).collect();
    for _ in 0..rounds {
        for ((_, run), least) in variants.iter_mut().zip(&mut least) {
            let time = clock::least(1, run).0;
            let ms = [time.wall, time.cpu].map(|s| 1e3 * s);
            (0..2).for_each(|i| least.ms[i] = least.ms[i].min(ms[i]));
        }
    }
    least
}

/// Reads an array once in `pieces`, by the threads of the pool this runs in.
fn read(array: &[f64], pieces: usize) -> f64 {
    let sum = |piece: &[f64]| {
        let mut sums = [0.0; 32];
        for chunk in piece.chunks_exact(32) {
            sums.iter_mut().zip(chunk).for_each(|(sum, value)| *sum += value);
        }
        sums.iter().sum::<f64>()
    };
    let sums: Vec<f64> = array.par_chunks(array.len().div_ceil(pieces)).map(sum).collect();
    sums.iter().sum()
}

fn report(name: &str, layers: usize, section: [usize; 2]) {
    let mesh = ring(layers, section);
    let n = mesh.n_dofs();
    let pools: Vec<ThreadPool> = [1, 2]
        .map(|n| ThreadPoolBuilder::new().num_threads(n).build().expect("threads"))
        .into();
    let free: Vec<usize> = (0..n).collect();
    let (layout, parts) = sectors::cut(&mesh);
    let n_sectors = layout.sectors().len();
    let of = |s: usize| Cow::Borrowed(&parts[s]);
    let points = |node: usize| mesh.nodes[node];
    let cells = (&points as &Points<'_>, &mesh.connectivity[..], 8);
    let clock = Instant::now();
    let symbolic = SectorSymbolic::new(layout, Communicator::Serial, cells, of).expect("a pattern");
    let analysis = clock.elapsed().as_secs_f64();
    let whole = restrict_lower(&matrix::sparse(&mesh), &free);
    let clock = Instant::now();
    let order = expand(&angular_dissection(&mesh.nodes, &mesh.connectivity, 8), 3);
    let sparse_symbolic = Symbolic::new(&whole, &order).expect("a pattern");
    println!(
        "\n{name}: {n} dofs, {n_sectors} sectors; order and analysis {analysis:.2} s, as a whole {:.2} s",
        clock.elapsed().as_secs_f64()
    );
    let factors = [0, 1].map(|_| std::cell::RefCell::new(None::<SectorCholesky>));
    let kept = std::cell::RefCell::new(None);
    let mut variants: Vec<Variant<'_>> = vec![(
        "factor, whole".to_string(),
        Box::new(|| *kept.borrow_mut() = sparse_symbolic.factor(&whole).ok()),
    )];
    for (pool, factor) in pools.iter().zip(&factors) {
        let run = || {
            factor.take();
            *factor.borrow_mut() = pool.install(|| symbolic.factor(of)).ok();
        };
        let threads = pool.current_num_threads();
        variants.push((format!("factor, {threads} threads"), Box::new(run)));
    }
    print(&measure(&mut variants, 2));
    drop(variants);
    let (sparse, sectors) = (
        kept.take().expect("a factor"),
        factors[0].take().expect("a factor"),
    );
    let bytes = [sparse.factor_bytes(), sectors.factor_bytes()].map(|b| b as f64 / 1e6);
    println!(
        "  factor {:.1} MB, of which the interface {:.1}; as a whole {:.1} MB",
        bytes[1],
        symbolic.interface_bytes(symbolic.owned()) as f64 / 1e6,
        bytes[0]
    );
    solves(&sparse, &sectors, &pools, n_sectors);
}

fn solves(sparse: &dyn LinearSolver, sectors: &SectorCholesky, pools: &[ThreadPool], n_sectors: usize) {
    let array = vec![1.0_f64; sectors.factor_bytes() / 8];
    for n_rhs in [1, 36] {
        let mut rhs = vec![1.0; n_rhs * sparse.n()];
        let mut others = pools.iter().map(|_| rhs.clone()).collect::<Vec<_>>();
        let mut variants: Vec<Variant<'_>> = vec![(
            format!("{n_rhs} right-hand sides, whole"),
            Box::new(|| sparse.solve(&mut rhs, n_rhs)),
        )];
        for (pool, rhs) in pools.iter().zip(&mut others) {
            let threads = pool.current_num_threads();
            let run = move || pool.install(|| sectors.solve(rhs, n_rhs));
            variants.push((
                format!("{n_rhs} right-hand sides, {threads} threads"),
                Box::new(run),
            ));
            if n_rhs == 1 {
                let array = &array;
                let run = move || {
                    let twice = || [(); 2].map(|()| read(array, n_sectors));
                    black_box(pool.install(twice));
                };
                variants.push((format!("factor read twice, {threads} threads"), Box::new(run)));
            }
        }
        let found = measure(&mut variants, ROUNDS);
        drop(variants);
        print(&found);
        if n_rhs > 1 {
            // Each entry of the factor is multiplied and added once down and once up.
            let flops = 4.0 * (n_rhs * sectors.factor_bytes() / 8) as f64;
            for least in &found {
                println!("  {:32} {:9.1} GFlop/s", least.name, 1e-6 * flops / least.ms[0]);
            }
            println!(
                "  {:32} {:9.1} GFlop/s",
                "large dense product, one thread",
                dense_rate()
            );
        }
        // The last right-hand sides have been overwritten by their solutions: keep the compiler honest.
        black_box((&rhs, &others));
    }
}

/// GFlop/s of a product of two dense matrices on one thread.
fn dense_rate() -> f64 {
    const N: usize = 768;
    let factor = Mat::from_fn(N, N, |i, j| ((i + 2 * j) % 7) as f64);
    let mut product = Mat::zeros(N, N);
    let multiply = || matmul(product.as_mut(), Accum::Replace, &factor, &factor, 1.0, Par::Seq);
    1e-9 * 2.0 * (N as f64).powi(3) / clock::least(ROUNDS, multiply).0.wall
}

fn print(found: &[Least]) {
    for least in found {
        let [wall, cpu] = least.ms;
        println!("  {:32} {wall:9.1} ms wall {cpu:9.1} ms processor", least.name);
    }
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    for (name, layers, section) in SIZES {
        if wanted.iter().any(|w| w == name) || (wanted.is_empty() && name == "65k") {
            report(name, layers, section);
        }
    }
}
