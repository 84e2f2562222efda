//! Forecast of the memory of a static run, from sizes known before the first number is factored.
//!
//! Bytes of one ring with n nodes, N = 3 n dofs, e elements of p nodes, P node pairs (nnz(K) = 9 P), E stored entries
//! of the lower triangle of the held K, a factor of F bytes with an analysis of S, and b balls:
//!
//! | phase | bytes | arrays |
//! |---|---|---|
//! | mesh | 24 n + 8 e p | nodes, connectivity; kept to the end |
//! | assembly | 16 (9 P) + 8 P + 2 e p^2, then 16 (9 P) + 16 E | K, indices, pattern; then K and its triangle |
//! | factorisation | 16 E + S + F + W | the triangle, analysis, factor; W: the permuted copy, fronts |
//! | kept | S + F + 8 N | analysis, factor, support |
//! | columns | kept + 2 (8 N 2 b) | right-hand sides and solver's copy of a block of 2 b columns |
//! | results | 240 n + 24 e p + 48 e c | copies of the mesh, lists of stress and output, stress at the c corners |
//!
//! Both rings are made at the same time if there are two threads, so their peaks add; one thread makes the inner ring
//! first, and the outer one while the inner is kept. The columns of both are solved likewise. The results come on top:
//! glibc returns no freed block below 32 MiB to the system, so they find that memory in use, or in pieces. On larger
//! rings the forecast is high by as much, a few per cent.
//!
//! A periodic ring of n nodes has no matrix: its harmonics' factor takes F bytes, its sites, order and directions 152
//! n, a block of 8 columns 77 n each (right-hand sides, harmonics, what the allocator keeps), each coupling of its
//! sector 600 (blocks of K, M, stress). What its results take fits into what the columns left. For rings in sectors
//! see [`crate::rank_memory`].
//!
//! **Motion** of a ring with one sparse factor, made anew after the start: K stays, E being its entries and P = E / 9;
//! the mass of all dofs has E / 3. Making adds scaled lower triangles of both and their sum, or that sum with F + W.
//! Freed blocks of the assembly that the allocator keeps count as another K, measured. Mesh, states and vectors of a
//! step are counted as those of a periodic ring.
//!
//! **Motion** of a periodic ring of n nodes, N sectors and r section nodes in its raceway: factor, table of responses
//! 72 N r^2, 900 per coupling of a sector, 24 N r for each functional of the mount, 1340 n for mesh, sites, states and
//! the vectors of a step, 390 n for each of two step files that wait to be written. The last two numbers are measured:
//! see `tests/memory.rs`. Making takes 24 n for each functional whose column is solved at the same time.
//!
//! A ring that the stress of its turning stiffens has one matrix more: half of what couplings take of K and M, or, of
//! one sparse factor, a value for each pair of nodes, twice while it is made.
//!
//! The threads need not be in step, and the measured peak is then lower, down to that of one thread.

use crate::mount::COLUMNS_AT_ONCE;
use mesh::Mesh;
use solver::Symbolic;

/// Program, libraries and small buffers, bytes: resident memory of a run with rigid rings, 2-core machine with glibc,
/// of a program with line numbers; the one of the profile `dist` takes 16 MB less.
pub const PROGRAM_BYTES: usize = 35_000_000;

/// Bytes of one stored entry: value and column index.
const ENTRY_BYTES: usize = 16;

/// Sites, order, directions and support of a periodic ring, whole and held, bytes per node.
const PERIODICITY_BYTES: usize = 152;

/// Buffers of a periodic ring that do not grow with it, bytes, measured.
const SMALL_BYTES: usize = 1_500_000;

/// Blocks and lists of a sector's couplings: stiffness, mass and stress, whole and held, bytes per coupling.
const COUPLING_BYTES: usize = 600;

/// Mesh, sites, coordinates, states and vectors of a step of a periodic ring in motion, bytes per node, measured.
const MOTION_BYTES: usize = 1340;

/// A step that waits to be written, bytes per node, measured.
const QUEUED_BYTES: usize = 390;

/// Blocks and lists of a sector's couplings in motion: whole and held, products and stress, bytes per coupling.
const MOTION_COUPLING_BYTES: usize = 900;

/// The same of the stiffness by the stress of turning: one matrix beside stiffness and mass.
const STRESS_COUPLING_BYTES: usize = MOTION_COUPLING_BYTES / 2;

/// What the search for periodicity holds beside the mesh, bytes per node.
const SEARCH_BYTES: usize = 250;

/// Bytes of one ring by phase: see the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RingMemory {
    /// Mesh, kept to the end.
    pub mesh: usize,
    /// Peak of the assembly, without the mesh.
    pub assembly: usize,
    /// Peak of the factorisation, without the mesh.
    pub factorisation: usize,
    /// What stays of it, without the mesh.
    pub kept: usize,
    /// Peak of a block solve for the columns of all contacts, without the mesh.
    pub columns: usize,
    /// Stress recovery, record of a step and output.
    pub results: usize,
}

impl RingMemory {
    /// Forecast for a ring of `n_balls` contacts whose held matrix, lower triangle only, was analysed; its whole matrix
    /// has `n_entries` stored entries.
    pub fn new(mesh: &Mesh, n_entries: usize, symbolic: &Symbolic, n_balls: usize) -> RingMemory {
        let whole = ENTRY_BYTES * n_entries;
        let triangle = ENTRY_BYTES * symbolic.n_entries();
        let pattern = 8 * (n_entries / 9) + 2 * mesh.kind.n_nodes() * mesh.connectivity.len();
        let kept = symbolic.bytes() + symbolic.factor_bytes() + 8 * mesh.n_dofs();
        RingMemory {
            mesh: 24 * mesh.n_nodes() + 8 * mesh.connectivity.len(),
            assembly: whole + pattern.max(triangle),
            factorisation: triangle + symbolic.bytes() + symbolic.peak_bytes(),
            kept,
            columns: kept + 2 * 8 * mesh.n_dofs() * 2 * n_balls,
            results: 240 * mesh.n_nodes()
                + 24 * mesh.connectivity.len()
                + 48 * mesh.kind.n_corners() * mesh.n_elements(),
        }
    }

    /// Forecast for a periodic ring of `n_couplings` couplings per sector, whose harmonics' factor takes `factor`
    /// bytes and solves blocks of `block` columns: see the module.
    pub fn cyclic(mesh: &Mesh, n_couplings: usize, factor: usize, block: usize) -> RingMemory {
        let (n, list) = (mesh.n_nodes(), 8 * mesh.connectivity.len());
        let kept = factor + PERIODICITY_BYTES * n;
        RingMemory {
            mesh: 24 * n + list,
            assembly: SEARCH_BYTES * n + 2 * list,
            factorisation: kept,
            kept,
            columns: kept + 77 * n * block,
            results: SMALL_BYTES + COUPLING_BYTES * n_couplings,
        }
    }

    /// The same for a ring with a defect that takes `bytes`: its factor, made of a table of responses, and stress
    /// element by element.
    pub fn with_defect(self, mesh: &Mesh, bytes: usize) -> RingMemory {
        let recovery = 240 * mesh.n_nodes()
            + 24 * mesh.connectivity.len()
            + 48 * mesh.kind.n_corners() * mesh.n_elements();
        RingMemory {
            factorisation: self.factorisation + bytes,
            columns: self.columns + bytes,
            results: self.results.max(recovery),
            ..self
        }
    }

    /// Peak from the assembly to the factor, without the mesh.
    pub fn making(&self) -> usize {
        self.assembly.max(self.factorisation)
    }
}

/// What the motion of a periodic ring is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotionSizes {
    /// Nodes of the mesh.
    pub n_nodes: usize,
    /// Equal sectors.
    pub n_sectors: usize,
    /// Couplings of a sector.
    pub n_couplings: usize,
    /// Section nodes whose responses are kept.
    pub n_responses: usize,
    /// Functionals of the mount.
    pub n_mount: usize,
    /// Bytes of the harmonics' factor, and of a defect.
    pub factor: usize,
}

/// Bytes of one ring in motion: see the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotionMemory {
    /// Peak while its matrices and its factor are made.
    pub making: usize,
    /// What it holds while steps are made.
    pub kept: usize,
    /// Each step that waits to be written.
    pub queued: usize,
    /// What the stiffness by the stress of turning adds where the ring has it.
    pub stress: usize,
}

impl MotionSizes {
    /// Bytes of the ring.
    pub fn memory(&self) -> MotionMemory {
        let kept = self.factor
            + 72 * self.n_sectors * self.n_responses.pow(2)
            + MOTION_COUPLING_BYTES * self.n_couplings
            + 24 * self.n_mount * self.n_sectors * self.n_responses
            + MOTION_BYTES * self.n_nodes;
        MotionMemory {
            making: kept + 24 * self.n_mount.min(COLUMNS_AT_ONCE) * self.n_nodes,
            kept,
            queued: QUEUED_BYTES * self.n_nodes,
            stress: STRESS_COUPLING_BYTES * self.n_couplings,
        }
    }
}

impl MotionMemory {
    /// Of a ring with one sparse factor, whose matrices have `n_entries` stored entries together and whose analysis is
    /// `symbolic`.
    pub fn sparse(mesh: &Mesh, n_entries: usize, symbolic: &Symbolic) -> MotionMemory {
        let stiffness = ENTRY_BYTES * n_entries;
        // Of nine entries between two nodes the mass of all dofs has three, and that between nodes one.
        let (mass, node_mass) = (stiffness / 3, stiffness / 9);
        // Blocks of the assembly that the allocator keeps: measured, about as much as K.
        let freed = stiffness;
        let lasting = 8 * mesh.connectivity.len()
            + MOTION_BYTES * mesh.n_nodes()
            + stiffness
            + node_mass
            + freed
            + symbolic.bytes();
        let triangle = stiffness / 2;
        MotionMemory {
            making: lasting + (mass / 2 + 2 * triangle).max(triangle + symbolic.peak_bytes()),
            kept: lasting
                + symbolic.factor_bytes()
                + 24 * mesh.connectivity.len()
                + 48 * mesh.kind.n_corners() * mesh.n_elements(),
            queued: QUEUED_BYTES * mesh.n_nodes(),
            // Of all dofs while it is assembled, then of the nodes.
            stress: 2 * node_mass,
        }
    }

    /// That of a ring that its stress stiffens.
    pub fn stiffened(self) -> MotionMemory {
        MotionMemory {
            making: self.making + self.stress,
            kept: self.kept + self.stress,
            ..self
        }
    }
}

/// Forecast of the largest resident memory of a motion after its start, bytes, with `n_threads` threads while `queued`
/// steps wait to be written; inner ring first, None is rigid.
pub fn forecast_motion_peak(rings: [Option<MotionMemory>; 2], queued: usize, n_threads: usize) -> usize {
    let of = |phase: fn(&MotionMemory) -> usize| rings.each_ref().map(|ring| ring.as_ref().map_or(0, phase));
    let (making, kept, waiting) = (of(|r| r.making), of(|r| r.kept), of(|r| r.queued));
    let made = if n_threads > 1 {
        making[0] + making[1]
    } else {
        making[0].max(kept[0] + making[1])
    };
    let stepping = kept[0] + kept[1] + queued * (waiting[0] + waiting[1]);
    PROGRAM_BYTES + made.max(stepping)
}

/// Forecast of the largest resident memory of a static run, bytes, with `n_threads` threads; inner ring first, None is
/// rigid.
pub fn forecast_peak(rings: [Option<RingMemory>; 2], n_threads: usize) -> usize {
    let of = |phase: fn(&RingMemory) -> usize| rings.each_ref().map(|ring| ring.as_ref().map_or(0, phase));
    let (making, kept, columns) = (of(RingMemory::making), of(|r| r.kept), of(|r| r.columns));
    let (made, solved) = if n_threads > 1 {
        (making[0] + making[1], columns[0] + columns[1])
    } else {
        let solved = (columns[0] + kept[1]).max(kept[0] + columns[1]);
        (making[0].max(kept[0] + making[1]), solved)
    };
    let lasting: usize = of(|r| r.mesh + r.results).iter().sum();
    PROGRAM_BYTES + lasting + made.max(solved)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMALL: RingMemory = RingMemory {
        mesh: 1,
        assembly: 30,
        factorisation: 50,
        kept: 20,
        columns: 25,
        results: 3,
    };
    const LARGE: RingMemory = RingMemory {
        mesh: 2,
        assembly: 900,
        factorisation: 700,
        kept: 200,
        columns: 600,
        results: 4,
    };

    /// If this failed, a job for a motion would be sized for rings that are factored after each other, or together,
    /// although they are not.
    #[test]
    fn a_motion_is_made_on_its_threads_before_it_steps() {
        let ring = |making, kept| {
            Some(MotionMemory {
                making,
                kept,
                queued: 7,
                stress: 5,
            })
        };
        let peak = |rings, queued, threads| forecast_motion_peak(rings, queued, threads) - PROGRAM_BYTES;
        assert_eq!(peak([None, None], 2, 2), 0);
        assert_eq!(peak([ring(90, 40), ring(80, 30)], 1, 2), 170);
        assert_eq!(peak([ring(90, 40), ring(80, 30)], 1, 1), 120);
        assert_eq!(peak([ring(90, 40), None], 1, 1), 90);
        assert_eq!(peak([ring(90, 80), ring(80, 30)], 10, 2), 80 + 30 + 140);
        let stiffened = ring(90, 80).map(MotionMemory::stiffened);
        assert_eq!(peak([stiffened, None], 1, 1), 95);
        assert_eq!(peak([stiffened, None], 10, 1), 85 + 70);
    }

    /// If this failed, a batch job sized by the forecast would be killed, or reserve memory it never uses.
    #[test]
    fn peaks_add_on_two_threads_and_follow_each_other_on_one() {
        let peak = |rings, threads| forecast_peak(rings, threads) - PROGRAM_BYTES;
        assert_eq!(peak([None, None], 2), 0);
        assert_eq!(peak([Some(SMALL), None], 2), 54);
        assert_eq!(peak([Some(SMALL), Some(LARGE)], 2), 10 + 50 + 900);
        assert_eq!(peak([Some(SMALL), Some(LARGE)], 1), 10 + 20 + 900);
        assert_eq!(peak([Some(LARGE), Some(SMALL)], 1), 10 + 900);
    }
}
