//! Displacements of a few rows, such as those of a defect, under unit loads on patches of the raceway.
//!
//! As in [`super::ResponseTable`] the responses depend on how many sectors row and load are apart. The displacements
//! of all components that any of the rows needs stand next to each other for each loaded dof, so that a patch takes
//! long sums of neighbours: per patch and sector with rows one product of its weights with a block
//! `[weights][components]`. Cost: 2 multiplications and additions per weight, sector and component; memory 9 N n m
//! numbers for n section nodes of the raceway and m of the rows.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use super::patch::PatchWeights;
use super::response::ResponseTable;

/// Components summed at a time.
const BLOCK: usize = 16;

/// Responses of rows to loads on the first section nodes of a table.
#[derive(Clone, Debug)]
pub struct RowResponses {
    n_sectors: usize,
    n_rows: usize,
    /// Dofs that may be loaded.
    n_forces: usize,
    /// Three per section node of the rows, and zeros up to a multiple of [`BLOCK`].
    n_components: usize,
    /// `[sectors apart][force][component]`, m/N.
    responses: Vec<f64>,
    /// Sectors that have rows.
    sectors: Vec<RowSector>,
}

/// The rows of one sector.
#[derive(Clone, Debug)]
struct RowSector {
    sector: usize,
    /// Row, its first component, and its direction along (radial, azimuthal, axial).
    rows: Vec<(usize, usize, [f64; 3])>,
}

impl RowResponses {
    /// The rows `rows` of the caller's Cartesian vectors under loads on the first `n_loaded` section nodes of `table`.
    ///
    /// # Panics
    /// When the table lacks the node of a row.
    pub fn new(table: &ResponseTable, n_loaded: usize, rows: &[usize]) -> RowResponses {
        let units: Vec<_> = rows.iter().map(|&row| table.unit(row)).collect();
        let mut nodes: Vec<usize> = units.iter().map(|unit| unit.chosen).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut sectors: Vec<RowSector> = Vec::new();
        for (row, unit) in units.iter().enumerate() {
            let component = 3 * nodes.binary_search(&unit.chosen).expect("all nodes are listed");
            let entry = (row, component, unit.weights);
            match sectors.iter_mut().find(|s| s.sector == unit.sector) {
                Some(sector) => sector.rows.push(entry),
                None => sectors.push(RowSector {
                    sector: unit.sector,
                    rows: vec![entry],
                }),
            }
        }
        let (n_forces, n_components) = (3 * n_loaded, (3 * nodes.len()).next_multiple_of(BLOCK));
        let n_sectors = table.n_sectors();
        let mut responses = vec![0.0; n_sectors * n_forces * n_components];
        let blocks = responses.par_chunks_exact_mut((n_forces * n_components).max(1));
        blocks.enumerate().for_each(|(apart, block)| {
            for (i, &node) in nodes.iter().enumerate() {
                for component in 0..3 {
                    let row = table.row(apart, 3 * node + component);
                    let places = block.chunks_exact_mut(n_components).zip(row);
                    places.for_each(|(block, value)| block[3 * i + component] = *value);
                }
            }
        });
        RowResponses {
            n_sectors,
            n_rows: rows.len(),
            n_forces,
            n_components,
            responses,
            sectors,
        }
    }

    /// Displacements of the rows per force on each patch in its directions, m/N, row-major
    /// `[n_rows][directions of all patches]`. The patches are those of [`ResponseTable::first`].
    pub fn of_patches(&self, patches: &[PatchWeights]) -> Vec<f64> {
        let pairs = |patch: &'_ PatchWeights| patch.n_directions() / 2;
        let all: Vec<(&PatchWeights, usize)> = patches
            .iter()
            .flat_map(|patch| (0..pairs(patch)).map(move |pair| (patch, pair)))
            .collect();
        let of_pair = |&(patch, pair): &(&PatchWeights, usize)| {
            Arch::new().dispatch(Measure {
                table: self,
                patch,
                pair,
            })
        };
        let columns: Vec<Vec<[f64; 2]>> = all.par_iter().map(of_pair).collect();
        let mut all = Vec::with_capacity(2 * self.n_rows * columns.len());
        for row in 0..self.n_rows {
            columns.iter().for_each(|column| all.extend(column[row]));
        }
        all
    }

    #[inline(always)]
    fn measured(&self, patch: &PatchWeights, pair: usize) -> Vec<[f64; 2]> {
        let mut moved = vec![[0.0; 2]; self.n_rows];
        let mut fields = vec![[0.0; 2]; self.n_components];
        for sector in &self.sectors {
            let blocks = fields.as_chunks_mut::<BLOCK>().0;
            for (block, fields) in blocks.iter_mut().enumerate() {
                let sums = self.block(sector.sector, BLOCK * block, (patch, pair));
                (0..BLOCK).for_each(|i| fields[i] = [sums[0][i], sums[1][i]]);
            }
            for &(row, first, weights) in &sector.rows {
                for (weight, field) in weights.iter().zip(&fields[first..first + 3]) {
                    (0..2).for_each(|p| moved[row][p] += weight * field[p]);
                }
            }
        }
        moved
    }

    /// Displacements of the components from `first` on in a sector, by direction of a pair of a patch.
    #[inline(always)]
    fn block(&self, sector: usize, first: usize, (patch, pair): (&PatchWeights, usize)) -> [[f64; BLOCK]; 2] {
        let mut sums = [[0.0; BLOCK]; 2];
        for run in patch.runs() {
            let apart = (sector + self.n_sectors - run.sector) % self.n_sectors;
            let start = (apart * self.n_forces + run.dof) * self.n_components + first;
            let weights = patch.of(run).chunks_exact(patch.n_directions());
            let weights = weights.map(|dof| (dof[2 * pair], dof[2 * pair + 1]));
            let rows = self.responses[start..].chunks(self.n_components);
            for ((a, b), row) in weights.zip(rows) {
                let row: &[f64; BLOCK] = row[..BLOCK].try_into().expect("blocks are whole");
                for i in 0..BLOCK {
                    sums[0][i] += a * row[i];
                    sums[1][i] += b * row[i];
                }
            }
        }
        sums
    }

    /// Bytes of the responses of `n_rows` section nodes to loads on `n_loaded` ones.
    pub fn bytes_of(n_sectors: usize, n_loaded: usize, n_rows: usize) -> usize {
        size_of::<f64>() * n_sectors * 3 * n_loaded * (3 * n_rows).next_multiple_of(BLOCK)
    }

    /// Bytes of the responses.
    pub fn bytes(&self) -> usize {
        size_of::<f64>() * self.responses.capacity()
    }
}

/// What a pair of directions of a patch moves, by the processor's widest vectors.
struct Measure<'a> {
    table: &'a RowResponses,
    patch: &'a PatchWeights,
    pair: usize,
}

impl WithSimd for Measure<'_> {
    type Output = Vec<[f64; 2]>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        self.table.measured(self.patch, self.pair)
    }
}
