//! Bytes of a body: what it keeps, and what it takes for a while.
//!
//! N free dofs of D, K the bytes of its stiffness, m functions of all seats, o oscillators, b vectors of a search or of
//! a block of products, on each thread:
//!
//! | phase | bytes | arrays |
//! |---|---|---|
//! | at rest | 5/2 K | stiffness of all dofs and of the free ones, and what its factor is made of |
//! | modes | 8 m N + 4/3 K + 8 b N + 96 o^2 | columns of the seats, stiffness, mass, vectors, dense matrices |
//! | frame | 8 m N + 8 o D, then 8 o D + K/3 + 8 b D | columns and fields of the oscillators, then mass, blocks |
//!
//! The allocator keeps blocks below 32 MiB for later. So modes and frame take another 3/2 K, and frame 96 o^2; and 4 K
//! and 96 o^2 are still there when a motion or a search for modes begins. These numbers are measured.
//! Functions of a seat on a ring have matrices of its joint, `[n][n]` each: flexibility, compliance, factor, and one in
//! the making.

use crate::oscillators::BodyModes;
use crate::surrounding::Surrounding;
use crate::vibration::{AT_A_TIME, FIRST_SEARCH, search_settings};

/// Matrices of a joint over the functions of its seat.
const JOINT_MATRICES: usize = 4;

/// Bytes of the matrices of a joint of `n` functions.
pub fn joint_bytes(n: usize) -> usize {
    JOINT_MATRICES * n * n * size_of::<f64>()
}

/// Dense matrices over the oscillators while these are found.
const OSCILLATOR_MATRICES: usize = 12;

/// What a body takes while it is made, bytes: see the module.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MakingBytes {
    /// Assembly and factorisation.
    pub at_rest: usize,
    /// Columns of the seats, matrices, and vectors of the search for its modes.
    pub modes: usize,
    /// Fields of its oscillators and what they are made of; 0 of a body that stands.
    pub frame: usize,
    /// What the allocator still has of it afterwards; 0 of a body at rest.
    pub left: usize,
}

impl MakingBytes {
    /// The most of all.
    pub fn most(&self) -> usize {
        self.at_rest.max(self.modes).max(self.frame)
    }
}

impl Surrounding {
    /// Bytes that stay: factor, functions, flexibility, mesh, own matrices, what loads on all of it do.
    pub fn kept_bytes(&self) -> usize {
        let mesh = self.mesh.as_ref().map_or(0, |(mesh, _)| {
            24 * mesh.n_nodes() + size_of::<usize>() * mesh.connectivity.len()
        });
        let loads = self.loads.as_ref().map_or(0, |loads| loads.bytes());
        self.bytes + mesh + self.own_matrix_bytes() + loads
    }

    /// Bytes that it takes for a while on so many threads; with its `modes` where they are found.
    pub fn making_bytes(&self, modes: Option<&BodyModes>, n_threads: usize) -> MakingBytes {
        let k = self.matrix_bytes;
        let mut making = MakingBytes {
            at_rest: 5 * k / 2,
            ..MakingBytes::default()
        };
        let Some(modes) = modes else { return making };
        let [free, all] = [self.free.len(), self.n_dofs].map(|n| n * size_of::<f64>());
        let columns = self.n_functions() * free;
        // The search is for more than are found, and doubles.
        let mut wanted = FIRST_SEARCH;
        while wanted <= modes.n_fixed {
            wanted *= 2;
        }
        let search = (search_settings(wanted).capacity() * free).max(2 * n_threads * AT_A_TIME * free);
        // A body of matrices has its own already.
        let matrices = if self.mesh.is_some() { k + k / 3 } else { 0 };
        let dense = OSCILLATOR_MATRICES * modes.n().pow(2) * size_of::<f64>();
        let freed = 3 * k / 2 + dense;
        making.modes = columns + matrices + search + freed;
        making.left = 4 * k + dense;
        if modes.frame.is_some() {
            let (fields, blocks) = (modes.n() * all, 2 * n_threads * AT_A_TIME * all);
            making.frame = (columns + fields).max(fields + k / 3) + blocks + freed;
        }
        making
    }
}
