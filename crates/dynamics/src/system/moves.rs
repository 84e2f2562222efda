//! What unknowns move which coordinates.

/// By coordinate: the unknowns that move it, and by how much.
#[derive(Default)]
pub(super) struct Moves {
    /// Where the list of each coordinate begins.
    first: Vec<usize>,
    /// What is added to the coordinate that began last.
    pub list: Vec<(usize, f64)>,
}

impl Moves {
    /// Unknowns that move a coordinate, and its growth with each.
    pub fn of(&self, coordinate: usize) -> &[(usize, f64)] {
        let end = self.first.get(coordinate + 1).copied().unwrap_or(self.list.len());
        &self.list[self.first[coordinate]..end]
    }

    /// What is added next belongs to `coordinate`.
    pub fn begin(&mut self, coordinate: usize) {
        self.first.resize(coordinate + 1, self.list.len());
    }
}
