//! Which nodes of a section are coupled, within a sector and across sectors.

use crate::error::SolverError;

/// Coupling of the section nodes `row` and `column`, the second `shift` sectors farther round the ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Coupling {
    /// Section node of the block's rows.
    pub row: usize,
    /// Section node of the block's columns.
    pub column: usize,
    /// Sectors from the first node to the second, from -N to N.
    pub shift: i32,
}

/// The couplings of one sector's nodes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CyclicPattern {
    pub(crate) n_sectors: usize,
    pub(crate) n_section_nodes: usize,
    /// Ascending, shifts reduced to above -N/2 and at most N/2.
    pub(crate) couplings: Vec<Coupling>,
}

impl CyclicPattern {
    /// Sorts the couplings, which must come in opposite pairs and include each node with itself. Returns as well the
    /// place in the caller's list of each coupling.
    pub(crate) fn new(
        n_sectors: usize,
        n_section_nodes: usize,
        couplings: &[Coupling],
    ) -> Result<(CyclicPattern, Vec<usize>), SolverError> {
        let mut sorted: Vec<(Coupling, usize)> = Vec::with_capacity(couplings.len());
        for (index, &coupling) in couplings.iter().enumerate() {
            let Coupling { row, column, shift } = coupling;
            let is_inside = row < n_section_nodes && column < n_section_nodes;
            if !is_inside || shift.unsigned_abs() as usize > n_sectors {
                return Err(bad(coupling, "names a node or sector that does not exist"));
            }
            let shift = reduced(shift, n_sectors);
            sorted.push((Coupling { row, column, shift }, index));
        }
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(bad(pair[0].0, "is given twice"));
        }
        let (couplings, places): (Vec<Coupling>, Vec<usize>) = sorted.into_iter().unzip();
        let pattern = CyclicPattern {
            n_sectors,
            n_section_nodes,
            couplings,
        };
        for &coupling in &pattern.couplings {
            if pattern.place(pattern.opposite(coupling)).is_none() {
                return Err(bad(coupling, "has no opposite"));
            }
        }
        for row in 0..n_section_nodes {
            let own = Coupling {
                row,
                column: row,
                shift: 0,
            };
            if pattern.place(own).is_none() {
                return Err(bad(own, "is missing"));
            }
        }
        Ok((pattern, places))
    }

    /// Place of a coupling in the list.
    pub(crate) fn place(&self, coupling: Coupling) -> Option<usize> {
        self.couplings.binary_search(&coupling).ok()
    }

    /// The coupling seen from the other node.
    pub(crate) fn opposite(&self, coupling: Coupling) -> Coupling {
        Coupling {
            row: coupling.column,
            column: coupling.row,
            shift: reduced(-coupling.shift, self.n_sectors),
        }
    }

    /// The couplings among the section nodes `keep` (ascending), renumbered, and their places in this list.
    pub(crate) fn restrict(&self, keep: &[usize]) -> (CyclicPattern, Vec<usize>) {
        let mut new_index = vec![usize::MAX; self.n_section_nodes];
        keep.iter()
            .enumerate()
            .for_each(|(new, &old)| new_index[old] = new);
        let mut kept = Vec::new();
        for (place, c) in self.couplings.iter().enumerate() {
            let (row, column) = (new_index[c.row], new_index[c.column]);
            if row != usize::MAX && column != usize::MAX {
                let shift = c.shift;
                kept.push((Coupling { row, column, shift }, place));
            }
        }
        kept.sort_unstable();
        let (couplings, places) = kept.into_iter().unzip();
        let pattern = CyclicPattern {
            n_sectors: self.n_sectors,
            n_section_nodes: keep.len(),
            couplings,
        };
        (pattern, places)
    }

    /// Neighbours of every section node in any sector, ascending, itself left out.
    pub(crate) fn neighbours(&self) -> Vec<Vec<usize>> {
        let mut neighbours = vec![Vec::new(); self.n_section_nodes];
        for c in self.couplings.iter().filter(|c| c.row != c.column) {
            neighbours[c.row].push(c.column);
        }
        neighbours.iter_mut().for_each(|list| list.dedup());
        neighbours
    }
}

fn bad(coupling: Coupling, problem: &'static str) -> SolverError {
    let Coupling { row, column, shift } = coupling;
    SolverError::BadCoupling {
        row,
        column,
        shift,
        problem,
    }
}

/// A shift modulo N, above -N/2 and at most N/2.
fn reduced(shift: i32, n_sectors: usize) -> i32 {
    let n = n_sectors as i32;
    let forward = shift.rem_euclid(n);
    if 2 * forward > n { forward - n } else { forward }
}
