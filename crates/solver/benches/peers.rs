//! One matrix for other programs, and our own solvers on the same matrix: `scripts/peers/measure-solvers` reads both.
//!
//!     cargo bench -p raceway-solver --bench peers -- export SIZE DIR
//!     cargo bench -p raceway-solver --bench peers -- measure SIZE sparse|cyclic|sector
//!     cargo bench -p raceway-solver --bench peers -- count SIZE
//!
//! The matrix is S = K + c M of a free ring, c that of a step of 1e-5 s. `export` writes its lower triangle by
//! columns: `size.txt` (rows, entries), `starts.i64` `[n + 1]`, `rows.i32` and `values.f64` `[entries]`,
//! little-endian, counted from 0. `measure` prints one line of `name value` pairs: seconds of processor time and on
//! the wall of ordering and analysis, factorisation, one and 36 right-hand sides, reading an array as large as the
//! factor once, bytes of the factor, peak memory of the process, and the error of the solution of S x = b with a
//! known x. `count` prints the sizes of both factors and the operations of the sparse one, without factoring.

#[path = "support/clock.rs"]
mod clock;
#[path = "support/matrix.rs"]
mod matrix;
#[path = "support/ring.rs"]
mod ring;
#[path = "support/sectors.rs"]
mod sectors;

use std::borrow::Cow;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;

use clock::{Time, least};
use comm::Communicator;
use matrix::steel;
use mesh::{Mesh, PERIODIC_TOLERANCE, find_periodicity};
use ring::ring;
use solver::{
    CyclicMatrix, CyclicRing, LinearSolver, Points, SectorSymbolic, Symbolic, angular_dissection, expand,
    restrict_lower,
};

/// Name, sectors, nodes across and along the section.
const SIZES: [(&str, usize, [usize; 2]); 5] = [
    ("20k", 180, [10, 4]),
    ("65k", 360, [12, 5]),
    ("150k", 360, [20, 7]),
    ("400k", 720, [19, 10]),
    ("1M", 1080, [26, 12]),
];

/// Right-hand sides of a block: two directions of 18 contacts.
const BLOCK: usize = 36;

/// The known solution: no two neighbours alike, between -1 and 1.
fn known(row: usize) -> f64 {
    ((row % 1009) as f64 / 504.0 - 1.0) * if row.is_multiple_of(2) { 1.0 } else { -0.5 }
}

fn export(mesh: &Mesh, dir: &Path) -> std::io::Result<()> {
    fs::create_dir_all(dir)?;
    let n = mesh.n_dofs();
    // Columns of the lower triangle are rows of the upper one, and the matrix is symmetric.
    let lower = restrict_lower(&matrix::sparse(mesh), &(0..n).collect::<Vec<_>>()).to_csc();
    let file = |name: &str| fs::File::create(dir.join(name)).map(BufWriter::new);
    writeln!(file("size.txt")?, "{n} {}", lower.nnz())?;
    let (mut starts, mut rows, mut values) = (file("starts.i64")?, file("rows.i32")?, file("values.f64")?);
    for &start in lower.indptr().raw_storage() {
        starts.write_all(&(start as i64).to_le_bytes())?;
    }
    for &row in lower.indices() {
        rows.write_all(&(row as i32).to_le_bytes())?;
    }
    for value in lower.data() {
        values.write_all(&value.to_le_bytes())?;
    }
    for mut file in [starts, rows, values] {
        file.flush()?;
    }
    Ok(())
}

/// Costs of one solver on one matrix.
struct Costs {
    analyse: Time,
    factor: Time,
    one: Time,
    many: Time,
    factor_bytes: usize,
    error: f64,
    /// One right-hand side that is in harmonic space already.
    harmonic: Option<Time>,
}

/// Solves S x = b with a known x, then times one and many right-hand sides.
fn costs(analyse: Time, factor: Time, solver: &dyn LinearSolver, rhs: &[f64], repeats: usize) -> Costs {
    let n = rhs.len();
    let mut x = rhs.to_vec();
    solver.solve(&mut x, 1);
    let error = (0..n).map(|i| (x[i] - known(i)).abs()).fold(0.0, f64::max);
    // The right-hand side anew each time: repeated solutions would run out of the range of numbers.
    let (one, ()) = least(repeats, || {
        x.copy_from_slice(rhs);
        solver.solve(&mut x, 1);
    });
    let mut block = vec![0.0; BLOCK * n];
    let (many, ()) = least(repeats.div_ceil(4), || {
        block
            .chunks_exact_mut(n)
            .for_each(|column| column.copy_from_slice(rhs));
        solver.solve(&mut block, BLOCK);
    });
    Costs {
        analyse,
        factor,
        one,
        many,
        factor_bytes: solver.factor_bytes(),
        error,
        harmonic: None,
    }
}

fn rhs(mesh: &Mesh) -> Vec<f64> {
    let x: Vec<f64> = (0..mesh.n_dofs()).map(known).collect();
    let mut b = vec![0.0; x.len()];
    sprs::prod::mul_acc_mat_vec_csr(matrix::sparse(mesh).view(), &x, &mut b);
    b
}

fn sparse(mesh: &Mesh, rhs: &[f64]) -> Costs {
    let lower = restrict_lower(&matrix::sparse(mesh), &(0..mesh.n_dofs()).collect::<Vec<_>>());
    let (analyse, symbolic) = least(1, || {
        let order = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
        Symbolic::new(&lower, &expand(&order, 3)).expect("a permutation")
    });
    let repeats = if mesh.n_dofs() > 300_000 { 5 } else { 12 };
    let (factor, solver) = least(if mesh.n_dofs() > 300_000 { 1 } else { 3 }, || {
        symbolic.factor(&lower).expect("positive definite")
    });
    costs(analyse, factor, &solver, rhs, repeats)
}

/// The matrix of a periodic ring, and the ring that factors it.
fn periodic(mesh: &Mesh) -> (CyclicMatrix, impl Fn() -> CyclicRing) {
    let periodicity = find_periodicity(mesh, PERIODIC_TOLERANCE).expect("a revolved ring is periodic");
    let sector = fem::assemble_sector(mesh, &periodicity, &steel()).expect("a valid mesh");
    let [matrix, ..] = matrix::cyclic(&periodicity, &sector);
    let directions = fem::azimuth_directions(mesh);
    let of_ring = matrix.clone();
    let ring = move || {
        CyclicRing::new(&of_ring, periodicity.nodes(), &directions, periodicity.half_way()).expect("a ring")
    };
    (matrix, ring)
}

fn cyclic(mesh: &Mesh, rhs: &[f64]) -> Costs {
    let (matrix, new_ring) = periodic(mesh);
    let (analyse, ring) = least(3, new_ring);
    let (factor, solver) = least(5, || ring.factor(&matrix).expect("positive definite"));
    let (ones, mut w) = (vec![1.0; ring.harmonic_len()], vec![0.0; ring.harmonic_len()]);
    let harmonic = least(50, || {
        w.copy_from_slice(&ones);
        solver.solve_harmonic(&mut [&mut w]);
    })
    .0;
    Costs {
        harmonic: Some(harmonic),
        ..costs(analyse, factor, &solver, rhs, 20)
    }
}

/// The ring in sectors, on as many threads as there are.
fn sector(mesh: &Mesh, rhs: &[f64]) -> Costs {
    let (layout, parts) = sectors::cut(mesh);
    let of = |s: usize| Cow::Borrowed(&parts[s]);
    let points = |node: usize| mesh.nodes[node];
    let cells = (
        &points as &Points<'_>,
        &mesh.connectivity[..],
        mesh.kind.n_nodes(),
    );
    let (analyse, symbolic) = least(1, || {
        SectorSymbolic::new(layout.clone(), Communicator::Serial, cells, of).expect("a pattern")
    });
    let is_large = mesh.n_dofs() > 300_000;
    let (factor, solver) = least(if is_large { 1 } else { 3 }, || {
        symbolic.factor(of).expect("positive definite")
    });
    costs(analyse, factor, &solver, rhs, if is_large { 5 } else { 12 })
}

/// Sizes of the factors, and operations.
fn count(mesh: &Mesh) {
    let lower = restrict_lower(&matrix::sparse(mesh), &(0..mesh.n_dofs()).collect::<Vec<_>>());
    let order = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
    let symbolic = Symbolic::new(&lower, &expand(&order, 3)).expect("a permutation");
    let (matrix, new_ring) = periodic(mesh);
    let cyclic = new_ring().factor(&matrix).expect("positive definite");
    println!(
        "dofs {} matrix_entries {} flops {:.4e} factor_bytes {} cyclic_bytes {}",
        mesh.n_dofs(),
        symbolic.n_entries(),
        symbolic.flops(),
        symbolic.factor_bytes(),
        cyclic.factor_bytes()
    );
}

/// Reads an array of `bytes` bytes once, in 32 partial sums: what no solve with a factor of that size can beat.
fn read_once(bytes: usize) -> Time {
    let array = vec![1.0_f64; bytes / 8];
    let read = || {
        let mut sums = [0.0; 32];
        for chunk in array.chunks_exact(32) {
            sums.iter_mut().zip(chunk).for_each(|(sum, value)| *sum += value);
        }
        std::hint::black_box(sums)
    };
    least(10, read).0
}

/// Largest memory of this process so far, bytes, as Linux says.
fn peak_memory() -> usize {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|text| text.trim().trim_end_matches(" kB").parse::<usize>().ok());
    1024 * kilobytes.unwrap_or(0)
}

fn measure(mesh: &Mesh, name: &str) {
    let rhs = rhs(mesh);
    let costs = match name {
        "sparse" => sparse(mesh, &rhs),
        "cyclic" => cyclic(mesh, &rhs),
        "sector" => sector(mesh, &rhs),
        _ => panic!("no solver {name}; there are sparse, cyclic, sector"),
    };
    print!(
        "solver {name} dofs {} threads {}",
        mesh.n_dofs(),
        rayon::current_num_threads()
    );
    if let Some(time) = costs.harmonic {
        print!(" harmonic_cpu {:.3e} harmonic_wall {:.3e}", time.cpu, time.wall);
    }
    let parts = [
        ("analyse", costs.analyse),
        ("factor", costs.factor),
        ("one", costs.one),
        ("many", costs.many),
    ];
    for (part, time) in parts {
        print!(" {part}_cpu {:.3e} {part}_wall {:.3e}", time.cpu, time.wall);
    }
    let peak = peak_memory();
    println!(
        " read_cpu {:.3e} factor_bytes {} peak_bytes {peak} error {:.1e}",
        read_once(costs.factor_bytes).cpu,
        costs.factor_bytes,
        costs.error
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let size = |name: &str| {
        let found = SIZES.into_iter().find(|(size, ..)| *size == name);
        let (_, n_sectors, grid) =
            found.unwrap_or_else(|| panic!("no size {name}; there are 20k 65k 150k 400k 1M"));
        ring(n_sectors, grid)
    };
    match words[..] {
        ["export", name, dir] => export(&size(name), Path::new(dir)).expect("the folder can be written"),
        ["measure", name, solver] => measure(&size(name), solver),
        ["count", name] => count(&size(name)),
        [] => measure(&size("20k"), "cyclic"),
        _ => panic!("expected: export SIZE DIR, measure SIZE SOLVER, or count SIZE"),
    }
}
