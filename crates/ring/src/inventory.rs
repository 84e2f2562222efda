//! What a solver holds: counted on its own objects, so that a test can tell what an effect adds.

use std::ops::Add;

/// Unknowns and matrices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inventory {
    /// Degrees of freedom of the flexible rings.
    pub dofs: usize,
    /// Sparse matrices and factors.
    pub matrices: usize,
}

impl Add for Inventory {
    type Output = Inventory;

    fn add(self, other: Inventory) -> Inventory {
        Inventory {
            dofs: self.dofs + other.dofs,
            matrices: self.matrices + other.matrices,
        }
    }
}
