//! What a rank knows of the sectors of a ring whose mesh it keeps in part.

use solver::SectorCut;

/// What a rank knows of a mesh that is divided.
#[derive(Debug)]
pub struct Division {
    /// Nodes of all sectors, and elements of those that this rank owns by their numbers in the mesh it keeps.
    pub(crate) cut: SectorCut,
    /// Number of elements of each sector.
    pub(crate) lengths: Vec<usize>,
    /// Elements of each sector by their numbers in the ring, on rank 0; empty on others.
    pub(crate) elements: Vec<Vec<u32>>,
}
