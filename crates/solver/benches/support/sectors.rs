//! A ring cut into its default number of sectors, and the sectors' own matrices.

use mesh::Mesh;
use solver::{SectorLayout, default_sectors};
use sprs::CsMat;

use crate::matrix;

/// The cut, all dofs being free, and `S` of each sector.
pub fn cut(mesh: &Mesh) -> (SectorLayout, Vec<CsMat<f64>>) {
    let n = mesh.n_dofs();
    let free: Vec<usize> = (0..n).collect();
    let per_element = mesh.kind.n_nodes();
    let layout = SectorLayout::new(
        &mesh.nodes,
        &mesh.connectivity,
        per_element,
        &free,
        default_sectors(n),
    )
    .expect("more elements than sectors");
    let part = |s: &solver::Sector| matrix::sparse(&mesh.part(&s.elements, &s.nodes));
    let parts = layout.sectors().iter().map(part).collect();
    (layout, parts)
}
