//! What the numbers of matrices would mean as a solid body: a slip of a unit shows by its thousands.

use sprs::CsMat;

use crate::matrix::MatrixBody;

/// Moduli that the diagonal of a stiffness has with sound units, Pa: plastics to ceramics, with room for thin walls.
const MODULI: [f64; 2] = [1e9, 5e12];
/// Mass over the volume of the box round the nodes, kg/m3: open frames to what was condensed to the nodes of its seats.
const DENSITIES: [f64; 2] = [20.0, 5e5];
/// Fewer nodes than these have no spacing to speak of.
const LEAST_NODES: usize = 8;

/// A body of matrices, taken for a solid one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apparent {
    /// Median over the nodes of their largest diagonal entry over the mean spacing of nodes, Pa.
    pub modulus: f64,
    /// Mass, kg, and the same over the volume of the box round the nodes, kg/m3; None without a mass.
    pub mass: Option<[f64; 2]>,
}

impl MatrixBody {
    /// What its numbers would mean; None of few nodes, or in a plane.
    pub(crate) fn apparent(&self) -> Option<Apparent> {
        let nodes: Vec<usize> = (0..self.places.len())
            .filter(|&node| !self.is_rotation[node])
            .collect();
        let side = |c: usize| {
            let along = nodes.iter().map(|&node| self.places[node][c]);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        };
        let volume = side(0) * side(1) * side(2);
        if nodes.len() < LEAST_NODES || volume <= 0.0 {
            return None;
        }
        let entry = |dof: usize| self.stiffness.get(dof, dof).copied().unwrap_or(0.0);
        let largest = |&node: &usize| (0..3).map(|c| entry(3 * node + c)).fold(0.0, f64::max);
        let mut diagonal: Vec<f64> = nodes.iter().map(largest).collect();
        let (_, median, _) = diagonal.select_nth_unstable_by(nodes.len() / 2, f64::total_cmp);
        let spacing = (volume / nodes.len() as f64).cbrt();
        let mass = self.mass.as_ref().map(|mass| self.translated(mass));
        Some(Apparent {
            modulus: *median / spacing,
            mass: mass.map(|mass| [mass, mass / volume]),
        })
    }

    /// r M r of a translation along x, kg.
    fn translated(&self, mass: &CsMat<f64>) -> f64 {
        let moves = |dof: usize| dof.is_multiple_of(3) && !self.is_rotation[dof / 3];
        let rows = mass.outer_iterator().enumerate().filter(|(row, _)| moves(*row));
        let of_row = |row: sprs::CsVecView<'_, f64>| -> f64 {
            row.iter()
                .filter(|(column, _)| moves(*column))
                .map(|(_, m)| m)
                .sum()
        };
        rows.map(|(_, row)| of_row(row)).sum()
    }
}

impl Apparent {
    /// A sentence for each number that no solid body has.
    pub fn doubts(&self, name: &str) -> Vec<String> {
        let mut lines = Vec::new();
        if !(MODULI[0]..=MODULI[1]).contains(&self.modulus) {
            lines.push(format!(
                "body {name:?}: between its nodes it is as stiff as a solid of {:.2e} GPa, expected {} to {} GPa: \
                 check stiffness_unit and length_unit, and that `stiffness` is not the file of the mass",
                1e-9 * self.modulus,
                1e-9 * MODULI[0],
                1e-9 * MODULI[1]
            ));
        }
        let Some([mass, density]) = self.mass else {
            return lines;
        };
        if !(DENSITIES[0]..=DENSITIES[1]).contains(&density) {
            lines.push(format!(
                "body {name:?}: its mass is {mass:.3e} kg, {density:.2e} kg/m3 of the box round its nodes, expected {} \
                 to {:.0e} kg/m3: check mass_unit and length_unit",
                DENSITIES[0], DENSITIES[1]
            ));
        }
        lines
    }
}
