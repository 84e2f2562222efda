//! Coordinates y of a vibrating ring: its nodal dofs that are not clamped, then the partner's dofs that move a clamped
//! surface. Nodal displacement w = T y; loads T^T f.

use contact::NodalWeights;

use crate::sparse::SparseLoad;

/// Map between nodal dofs and coordinates.
pub struct Coordinates {
    /// Index of the coordinate of each nodal dof; None on clamped nodes.
    places: Vec<Option<usize>>,
    /// Nodal dof of each of the first coordinates, ascending.
    pub free: Vec<usize>,
    /// Clamped nodal dofs.
    held: Vec<usize>,
    /// Motion of the clamped nodal dofs per unit of each moving partner dof, `[n_moving][n_held]`.
    levers: Vec<Vec<f64>>,
}

impl Coordinates {
    /// Coordinates of `n_dofs` nodal dofs of which those of the nodes `clamped` follow the rigid `motions` (nodal, m per
    /// unit).
    pub fn new(n_dofs: usize, clamped: &[usize], motions: &[&Vec<f64>]) -> Coordinates {
        let mut is_held = vec![false; n_dofs];
        clamped
            .iter()
            .for_each(|&node| is_held[3 * node..3 * node + 3].fill(true));
        let free: Vec<usize> = (0..n_dofs).filter(|&dof| !is_held[dof]).collect();
        let held: Vec<usize> = (0..n_dofs).filter(|&dof| is_held[dof]).collect();
        let mut places = vec![None; n_dofs];
        free.iter()
            .enumerate()
            .for_each(|(i, &dof)| places[dof] = Some(i));
        let lever = |motion: &&Vec<f64>| held.iter().map(|&dof| motion[dof]).collect();
        Coordinates {
            levers: motions.iter().map(lever).collect(),
            places,
            free,
            held,
        }
    }

    /// Number of coordinates.
    pub fn n(&self) -> usize {
        self.free.len() + self.levers.len()
    }

    /// Number of moving partner dofs among them.
    pub fn n_moving(&self) -> usize {
        self.levers.len()
    }

    /// Nodal displacement of the clamped nodes alone per unit of a moving partner dof, `[n_dofs]`.
    pub fn held_motion(&self, moving: usize) -> Vec<f64> {
        let mut motion = vec![0.0; self.places.len()];
        for (&dof, value) in self.held.iter().zip(&self.levers[moving]) {
            motion[dof] = *value;
        }
        motion
    }

    /// Nodal displacement, `[n_dofs]`.
    pub fn expand(&self, y: &[f64]) -> Vec<f64> {
        let mut nodal = vec![0.0; self.places.len()];
        for (&dof, value) in self.free.iter().zip(y) {
            nodal[dof] = *value;
        }
        for (lever, q) in self.levers.iter().zip(&y[self.free.len()..]) {
            for (&dof, value) in self.held.iter().zip(lever) {
                nodal[dof] += value * q;
            }
        }
        nodal
    }

    /// Generalised load of nodal loads at a few dofs.
    pub fn reduce(&self, load: impl Iterator<Item = (usize, f64)>) -> SparseLoad {
        let mut reduced = SparseLoad::new();
        let mut moved = vec![0.0; self.levers.len()];
        for (dof, value) in load {
            match self.places[dof] {
                Some(i) => reduced.push((i, value)),
                None => {
                    let place = self.held.partition_point(|&held| held < dof);
                    for (sum, lever) in moved.iter_mut().zip(&self.levers) {
                        *sum += lever[place] * value;
                    }
                }
            }
        }
        let moved = moved.into_iter().enumerate().filter(|m| m.1 != 0.0);
        reduced.extend(moved.map(|(k, value)| (self.free.len() + k, value)));
        reduced
    }

    /// Generalised loads of a unit force, radial and axial, of a contact.
    pub fn reduce_weights(&self, weights: &NodalWeights) -> [SparseLoad; 2] {
        [0, 1].map(|direction| {
            let nodes = weights.nodes.iter().zip(&weights.coefficients);
            self.reduce(nodes.flat_map(|(&node, c)| (0..3).map(move |k| (3 * node + k, c[direction][k]))))
        })
    }
}
