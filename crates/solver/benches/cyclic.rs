//! The cyclic solver beside the sparse one on rings of 65 k, 151 k, 410 k and 1 M dof: set-up, 1 and 36 right-hand
//! sides, memory, and the time to read the factor once, which no solve can beat. Then products and stress of one
//! sector's blocks.
//!
//!     cargo bench -p raceway-solver --bench cyclic -- [65k] [150k] [400k] [1M] [sparse] [hermitian]
//!
//! Without sizes all but 1M, the sparse solver at the smaller two. `hermitian` turns the planes of the ring against
//! each other, so that no section is its own mirror image. The sparse factor of 1 M dof takes 7 GB. All on the
//! threads of RAYON_NUM_THREADS; best of several runs.

#[path = "support/clock.rs"]
mod clock;
#[path = "support/matrix.rs"]
mod matrix;
#[path = "support/ring.rs"]
mod ring;

use std::time::Instant;

use clock::best;
use divan::black_box;
use matrix::{couplings, steel};
use mesh::{Mesh, PERIODIC_TOLERANCE, Periodicity, find_periodicity};
use ring::ring;
use solver::{
    CyclicMatrix, CyclicRing, LinearSolver, ResponseTable, Symbolic, angular_dissection, expand,
    restrict_lower,
};

/// Name, sectors, nodes across and along the section, whether the sparse solver runs.
const SIZES: [(&str, usize, [usize; 2], bool); 4] = [
    ("65k", 360, [12, 5], true),
    ("150k", 360, [20, 7], true),
    ("400k", 720, [19, 10], false),
    ("1M", 1080, [26, 12], false),
];

/// Time to read `bytes` bytes once on this thread, ms.
fn read_once(bytes: usize) -> f64 {
    let array = vec![1.0_f64; bytes / 8];
    let read = || {
        let mut sums = [0.0; 32];
        for chunk in array.chunks_exact(32) {
            sums.iter_mut().zip(chunk).for_each(|(sum, value)| *sum += value);
        }
        black_box(sums)
    };
    best(50, read).0
}

/// Compliance of 18 contacts on six of the raceway's nodes in seven sectors, with one pair of directions, as of normal
/// forces, and with two, as of free balls.
fn contacts(table: &ResponseTable, periodicity: &Periodicity, raceway: &[usize]) {
    let (n, width) = (periodicity.n_sectors(), periodicity.n_section_nodes());
    let weights: Vec<[[f64; 3]; 2]> = (0..42)
        .map(|i| [0, 3].map(|k| [0, 1, 2].map(|c| 1.0 + ((7 * i + k + c) % 11) as f64)))
        .collect();
    let patch = |contact: usize, pairs: usize| {
        let node = |i: usize| {
            let sector = (contact * n / 18 + i / 6) % n;
            periodicity.nodes()[sector * width + raceway[1 + i % 6]]
        };
        let nodes: Vec<usize> = (0..42).map(node).collect();
        table
            .patch(&vec![(&nodes[..], &weights[..]); pairs])
            .expect("nodes of the raceway")
    };
    let time = |pairs: usize| {
        let patches: Vec<_> = (0..18).map(|contact| patch(contact, pairs)).collect();
        best(50, || black_box(table.compliances(&patches))).0
    };
    let (one, two) = (time(1), time(2));
    println!(
        "  cyclic: compliance of 18 contacts {one:.2} ms, with two pairs of directions {two:.2} ms = {:.1} x",
        two / one
    );
}

fn cyclic(mesh: &Mesh) -> (f64, f64, f64) {
    let (find, periodicity) = best(3, || {
        find_periodicity(mesh, PERIODIC_TOLERANCE).expect("a revolved ring is periodic")
    });
    let (assemble, sector) = best(3, || {
        fem::assemble_sector(mesh, &periodicity, &steel()).expect("a valid mesh")
    });
    let [matrix, stiffness, mass] = matrix::cyclic(&periodicity, &sector);
    let directions = fem::azimuth_directions(mesh);
    let (analyse, ring) = best(3, || {
        CyclicRing::new(&matrix, periodicity.nodes(), &directions, periodicity.half_way()).expect("a ring")
    });
    let mut factor = Some(ring.factor(&matrix).expect("positive definite"));
    let refactor = best(30, || {
        let old = factor.take().expect("put back below");
        factor = Some(old.refactored(&matrix).expect("positive definite"));
    })
    .0;
    let factor = factor.expect("put back above");
    println!(
        "  cyclic: find sectors {find:.1} ms, assemble {assemble:.2} ms, order {analyse:.2} ms, factor {refactor:.2} \
         ms, {:.1} MB, {:?}",
        factor.factor_bytes() as f64 / 1e6,
        factor.symmetry()
    );
    let mut w = vec![0.0; ring.harmonic_len()];
    let mut y = w.clone();
    let mut u = vec![1.0; mesh.n_dofs()];
    let forward = best(50, || ring.to_harmonic(&u, &mut w)).0;
    let product = best(50, || {
        ring.apply_harmonic(&mass, &w, &mut y).expect("one pattern")
    })
    .0;
    let harmonic = best(100, || {
        y.copy_from_slice(&w);
        factor.solve_harmonic(&mut [&mut y]);
    })
    .0;
    let inverse = best(50, || ring.from_harmonic(&w, &mut u)).0;
    let one = best(50, || factor.solve(&mut u, 1)).0;
    let mut block = vec![1.0; 36 * mesh.n_dofs()];
    let many = best(3, || factor.solve(&mut block, 36)).0;
    let mut columns = vec![1.0; 36 * w.len()];
    let many_harmonic = best(6, || {
        factor.solve_harmonic(&mut columns.chunks_exact_mut(w.len()).collect::<Vec<_>>());
    })
    .0;
    let raceway: Vec<usize> = (0..8).map(|i| i % periodicity.n_section_nodes()).collect();
    let (table, responses) = best(3, || ResponseTable::new(&factor, &raceway));
    println!(
        "  cyclic: table of responses of 8 section nodes {table:.1} ms, {:.1} MB",
        responses.bytes() as f64 / 1e6
    );
    contacts(&responses, &periodicity, &raceway);
    let floor = read_once(factor.factor_bytes());
    println!(
        "  cyclic: solve in harmonic space {harmonic:.2} ms = {:.2} x reading L once ({floor:.2} ms on one thread), \
         36 columns {many_harmonic:.1} ms = {:.1} x one",
        harmonic / floor,
        many_harmonic / harmonic
    );
    println!(
        "  cyclic: transforms {forward:.2} and {inverse:.2} ms, mass product {product:.2} ms, nodal solve {one:.2} ms, \
         36 nodal {many:.1} ms"
    );
    stencils(mesh, &periodicity, (&ring, &stiffness));
    (refactor, harmonic, factor.factor_bytes() as f64)
}

/// Products and stress through the blocks of one sector, beside recovery element by element.
fn stencils(mesh: &Mesh, periodicity: &Periodicity, (ring, stiffness): (&CyclicRing, &CyclicMatrix)) {
    let operator = ring.operator(stiffness).expect("one pattern");
    let u: Vec<f64> = (0..mesh.n_dofs()).map(|i| 1e-9 * (i % 97) as f64).collect();
    let mut lines = vec![0.0; ring.lines_len()];
    let there = best(30, || ring.to_lines(&u, &mut lines)).0;
    let mut product = vec![0.0; operator.product_len()];
    let inner = best(30, || operator.add_product(&lines, &mut product)).0;
    let whole = best(30, || operator.apply(&u)).0;
    let recovery = fem::StressRecovery::new(mesh, &steel()).expect("a valid mesh");
    let (build, sector) = best(2, || recovery.sector(mesh, periodicity));
    let couplings = couplings(&sector.couplings);
    let stress = ring.stencil(6, &couplings, sector.weights.as_flattened().as_flattened());
    let mut tensors = vec![[0.0; 6]; mesh.n_nodes()];
    let fast = best(30, || stress.tensors(&u, &mut tensors)).0;
    let slow = best(3, || recovery.nodal(&u)).0;
    let floor = read_once(8 * 9 * mesh.n_nodes());
    println!(
        "  stencils: K u {whole:.2} ms (there {there:.2}, product {inner:.2}); stress {fast:.2} ms = {:.1} x reading \
         u and stress once, weights {:.2} MB made in {build:.1} ms; element by element {slow:.1} ms",
        fast / floor,
        stress.bytes() as f64 / 1e6
    );
}

fn sparse(mesh: &Mesh, (refactor, harmonic, bytes): (f64, f64, f64)) {
    let start = Instant::now();
    let matrix = matrix::sparse(mesh);
    let assemble = 1e3 * start.elapsed().as_secs_f64();
    let matrix = restrict_lower(&matrix, &(0..mesh.n_dofs()).collect::<Vec<_>>());
    let start = Instant::now();
    let order = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
    let symbolic = Symbolic::new(&matrix, &expand(&order, 3)).expect("a permutation");
    let analyse = 1e3 * start.elapsed().as_secs_f64();
    let (factorise, factor) = best(2, || symbolic.factor(&matrix).expect("positive definite"));
    let mut u = vec![1.0; mesh.n_dofs()];
    let one = best(10, || factor.solve(&mut u, 1)).0;
    let mut block = vec![1.0; 36 * mesh.n_dofs()];
    let many = best(2, || factor.solve(&mut block, 36)).0;
    println!(
        "  sparse: assemble {assemble:.0} ms, order and analyse {analyse:.0} ms, factor {factorise:.0} ms, {:.0} MB, \
         solve {one:.1} ms, 36 columns {many:.0} ms",
        factor.factor_bytes() as f64 / 1e6
    );
    println!(
        "  sparse / cyclic: factor {:.0} x, solve {:.0} x, memory {:.1} x",
        factorise / refactor,
        one / harmonic,
        factor.factor_bytes() as f64 / bytes
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let is_named = |name: &str| arguments.iter().any(|a| a == name);
    let all = !SIZES.iter().any(|(name, ..)| is_named(name));
    println!("threads: {}", rayon::current_num_threads());
    for (name, n_sectors, grid, with_sparse) in SIZES {
        if !(all && name != "1M" || is_named(name)) {
            continue;
        }
        let mut mesh = ring(n_sectors, grid);
        if is_named("hermitian") {
            for [x, y, z] in &mut mesh.nodes {
                let (s, c) = (20.0 * *z).sin_cos();
                (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
            }
        }
        println!(
            "{name}: {n_sectors} sectors of {} x {} nodes, {} dof",
            grid[0],
            grid[1],
            mesh.n_dofs()
        );
        let times = cyclic(&mesh);
        if (all && with_sparse) || is_named("sparse") {
            sparse(&mesh, times);
        }
    }
}
