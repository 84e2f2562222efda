//! Fields over the cells of all bodies.

use crate::field::{Field, listed, mask, stress_field};
use crate::storage::Storage;

/// Components of a stress tensor, in the order xx yy zz xy yz xz.
pub(crate) const TENSOR: usize = 6;

/// Fields over cells, one row per cell of all bodies in their order. A field that is `None` is not written. Rows
/// where a field has no meaning, such as stress of balls, hold zeros, as in [`crate::PointFields`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellFields {
    /// Stress at the integration points of each cell.
    pub stress_integration_points: Option<IntegrationPointStress>,
    /// The largest von Mises stress among the integration points of each cell, Pa, `[n_cells]`, in the precision of
    /// [`Storage::stress`].
    pub von_mises_largest: Option<Vec<f64>>,
    /// 1 in the region in which fields are kept, 0 outside, `[n_cells]`, f32; None keeps all.
    pub in_region: Option<Vec<f64>>,
}

/// Stress at the integration points of every cell, in the precision of [`Storage::stress`].
///
/// VTKHDF has no names for components: ParaView numbers them, component `6 q + c` is component c at point q, and
/// "Magnitude" means nothing. To colour cells there is [`CellFields::von_mises_largest`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntegrationPointStress {
    /// Integration points in a row: the most that a cell of the grid has. The rows of cells with fewer end in zeros.
    pub points_per_cell: usize,
    /// Stress, Pa, `[n_cells][points_per_cell][6]`, flat, components xx yy zz xy yz xz.
    pub values: Vec<f64>,
    /// Order of points and components for whoever opens the file: its attribute `layout`.
    pub layout: String,
}

impl IntegrationPointStress {
    /// Numbers in the row of a cell.
    pub fn n_components(&self) -> usize {
        TENSOR * self.points_per_cell
    }
}

impl CellFields {
    /// Name, components per cell, and row-major values of every field that is present.
    pub fn arrays(&self) -> Vec<(&'static str, usize, &[f64])> {
        listed(self.present(Storage::default()))
    }

    /// Fields that are present, in the order of the files.
    pub(crate) fn present(&self, storage: Storage) -> Vec<Field<'_>> {
        let region = self.in_region.as_deref();
        let derived = |field| stress_field(region, storage, field);
        let stress = self.stress_integration_points.as_ref();
        let stress = stress.map(|s| derived(("stress_integration_points", s.n_components(), &s.values[..])));
        let largest = self.von_mises_largest.as_deref();
        let largest = largest.map(|values| derived(("von_mises_largest", 1, values)));
        stress
            .into_iter()
            .chain(largest)
            .chain(region.map(mask))
            .collect()
    }
}
