//! Dofs of an eigenproblem that are no coordinates of rings: balls, shaft, a seat that slides.

/// Entries of a matrix: row, column, value.
pub type SmallEntries = Vec<(usize, usize, f64)>;

/// The small dofs and their own matrices.
#[derive(Clone, Debug, Default)]
pub struct SmallDofs {
    n: usize,
    /// Mass, kg and kg m^2.
    pub mass: SmallEntries,
    /// Stiffness, N/m and N m.
    pub stiffness: SmallEntries,
}

impl SmallDofs {
    /// Number of dofs.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Adds a dof with a mass, and returns its number.
    pub fn add(&mut self, mass: f64) -> usize {
        self.mass.push((self.n, self.n, mass));
        self.n += 1;
        self.n - 1
    }

    /// Makes a dof stand that nothing is coupled to: its mass becomes a stiffness, of that mass at the shift, 1/s^2. So
    /// K + s M stays what it is.
    pub fn hold(&mut self, dof: usize, shift: f64) {
        for entry in self.mass.extract_if(.., |entry| entry.0 == dof) {
            let (i, k, mass) = entry;
            self.stiffness.push((i, k, shift * mass));
        }
    }

    /// Adds dofs with a mass and a stiffness matrix, `[n][n]` flat, and returns the first.
    pub fn add_structure(&mut self, n: usize, mass: &[f64], stiffness: &[f64]) -> usize {
        let first = self.n;
        for (matrix, to) in [(mass, &mut self.mass), (stiffness, &mut self.stiffness)] {
            let entries = (0..n * n).filter(|&k| matrix[k] != 0.0);
            to.extend(entries.map(|k| (first + k / n, first + k % n, matrix[k])));
        }
        self.n += n;
        first
    }

    /// Adds the product of a matrix and a vector.
    pub fn add_product(matrix: &SmallEntries, x: &[f64], to: &mut [f64]) {
        matrix.iter().for_each(|&(i, k, value)| to[i] += value * x[k]);
    }
}
