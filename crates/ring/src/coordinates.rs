//! Generalised coordinates of a moving ring: its free nodal dofs, then the shaft dofs that carry its bore.
//!
//! All displacements are total, in the ring's own (co-rotating) frame. A clamped bore moves with the shaft: w = R q
//! at its nodes; held shaft dofs and a clamped seat do not move. y = (w_free, q_free), w = T y, loads T^T f, matrices
//! T^T A T: symmetric positive definite, with the few dense rows of the shaft last in the elimination order.

use contact::NodalWeights;
use mesh::Mesh;
use sprs::CsMat;

use crate::sparse::SparseLoad;

/// What one nodal dof is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DofSource {
    /// A free dof: its index.
    Free(usize),
    /// A held node, its place among them: rigid motion with the shaft.
    Held(usize),
}

/// Rigid motions of a ring: translations, tilts, rotation about the axis.
pub const RIGID_MOTIONS: usize = 6;

/// What is added to places of held nodes.
const HELD: u32 = 1 << 31;

/// Map between nodal dofs and generalised coordinates.
#[derive(Clone)]
pub struct Coordinates {
    /// Of each nodal dof its free coordinate, or [`HELD`] plus the place of its node among the held ones.
    sources: Vec<u32>,
    /// Nodal dof of each free coordinate, ascending.
    free: Vec<usize>,
    /// Shaft dofs (0..5) that are coordinates, after the free ones.
    shaft: Vec<usize>,
    /// Positions of the held nodes relative to the shaft's origin, m.
    arms: Vec<[f64; 3]>,
    /// Axial position of the shaft's origin, m.
    origin_z: f64,
}

impl Coordinates {
    /// Coordinates of a ring whose `held` nodes follow the `shaft` dofs (of x, y, z, tilt x, tilt y) that are free;
    /// `origin_z` is the axial position of the shaft's origin in the mesh, m.
    pub fn new(mesh: &Mesh, held: &[usize], shaft: Vec<usize>, origin_z: f64) -> Coordinates {
        let mut is_held = vec![false; mesh.n_nodes()];
        held.iter().for_each(|&n| is_held[n] = true);
        let free: Vec<usize> = (0..mesh.n_dofs()).filter(|d| !is_held[d / 3]).collect();
        assert!(
            mesh.n_dofs() < HELD as usize,
            "rings of 2^31 dofs fit into no memory"
        );
        let mut sources = vec![0; mesh.n_dofs()];
        free.iter().enumerate().for_each(|(i, &d)| sources[d] = i as u32);
        let mut arms = Vec::new();
        for node in (0..mesh.n_nodes()).filter(|&node| is_held[node]) {
            let x = mesh.nodes[node];
            sources[3 * node..3 * node + 3].fill(HELD + arms.len() as u32);
            arms.push([x[0], x[1], x[2] - origin_z]);
        }
        Coordinates {
            sources,
            free,
            shaft,
            arms,
            origin_z,
        }
    }

    /// Coordinates of another mesh of the ring, whose `held` nodes follow the same shaft dofs.
    pub fn of_mesh(&self, mesh: &Mesh, held: &[usize]) -> Coordinates {
        Coordinates::new(mesh, held, self.shaft.clone(), self.origin_z)
    }

    /// Number of coordinates.
    pub fn n(&self) -> usize {
        self.free.len() + self.shaft.len()
    }

    /// Number of nodal dofs.
    pub fn expanded(&self) -> usize {
        self.sources.len()
    }

    /// Nodal dofs of the free coordinates.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Shaft dofs among the coordinates and the index of the first.
    pub fn shaft(&self) -> (&[usize], usize) {
        (&self.shaft, self.free.len())
    }

    /// Nodes that are not free, ascending.
    pub fn held_nodes(&self) -> Vec<usize> {
        let is_held = |&node: &usize| self.free_node(node).is_none();
        (0..self.sources.len() / 3).filter(is_held).collect()
    }

    /// Generalised loads of unit forces on the contacts at `places`, two each.
    pub fn of_contacts(&self, places: &[NodalWeights]) -> Vec<SparseLoad> {
        places
            .iter()
            .flat_map(|place| self.reduce_weights(place))
            .collect()
    }

    /// Number of a node among the free ones; None when it is held.
    pub fn free_node(&self, node: usize) -> Option<usize> {
        match self.source(3 * node) {
            DofSource::Free(i) => Some(i / 3),
            DofSource::Held(_) => None,
        }
    }

    fn source(&self, dof: usize) -> DofSource {
        match self.sources[dof].checked_sub(HELD) {
            Some(place) => DofSource::Held(place as usize),
            None => DofSource::Free(self.sources[dof] as usize),
        }
    }

    /// Motion of a component of a held node, given by its place, per unit of shaft dof `q`.
    fn lever(&self, place: usize, component: usize, q: usize) -> f64 {
        rigid_lever(self.arms[place], component, q)
    }

    /// Motion of a component of a node at `x` (m) under a rigid motion `q` of the shaft.
    pub fn rigid_motion(&self, component: usize, x: [f64; 3], q: [f64; 5]) -> f64 {
        let arm = [x[0], x[1], x[2] - self.origin_z];
        (0..5).map(|i| rigid_lever(arm, component, i) * q[i]).sum()
    }

    /// Motion of a node at `x` (m) under a rigid motion of the ring: the five of the shaft, then the rotation about the
    /// axis.
    pub fn whole_rigid_motion(&self, x: [f64; 3], q: [f64; RIGID_MOTIONS]) -> [f64; 3] {
        let [of_shaft @ .., turn] = q;
        let [u, v, w] = [0, 1, 2].map(|component| self.rigid_motion(component, x, of_shaft));
        [u - turn * x[1], v + turn * x[0], w]
    }

    /// Rigid motions that the coordinates take without strain, by their places in a whole one: those of the shaft that
    /// carries the ring, or all where no node is held.
    pub fn rigid_motions(&self) -> Vec<usize> {
        if self.arms.is_empty() {
            (0..RIGID_MOTIONS).collect()
        } else {
            self.shaft.clone()
        }
    }

    /// The coordinates that move a nodal dof and by how much, were its node at the position `x` (m): a row of T.
    pub fn terms(&self, dof: usize, x: [f64; 3]) -> Vec<(usize, f64)> {
        match self.source(dof) {
            DofSource::Free(i) => vec![(i, 1.0)],
            DofSource::Held(_) => {
                let arm = [x[0], x[1], x[2] - self.origin_z];
                let term = |(k, &q): (usize, &usize)| (self.free.len() + k, rigid_lever(arm, dof % 3, q));
                self.shaft.iter().enumerate().map(term).collect()
            }
        }
    }

    /// Nodal values w = T y, `[n_dofs]`.
    pub fn expand(&self, y: &[f64]) -> Vec<f64> {
        let q = &y[self.free.len()..];
        let value = |dof: usize| match self.source(dof) {
            DofSource::Free(i) => y[i],
            DofSource::Held(place) => self
                .shaft
                .iter()
                .zip(q)
                .map(|(&s, q)| self.lever(place, dof % 3, s) * q)
                .sum(),
        };
        (0..self.sources.len()).map(value).collect()
    }

    /// Displacement of a held node when the shaft dofs among the coordinates are `q`.
    ///
    /// # Panics
    /// When the node is free.
    pub fn held_displacement(&self, node: usize, q: &[f64]) -> [f64; 3] {
        let DofSource::Held(place) = self.source(3 * node) else {
            panic!("node {node} is free")
        };
        [0, 1, 2].map(|component| {
            let terms = self.shaft.iter().zip(q);
            terms.map(|(&s, q)| self.lever(place, component, s) * q).sum()
        })
    }

    /// Generalised loads T^T f, `[n]`.
    pub fn reduce(&self, load: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.n()];
        let first = self.free.len();
        for (dof, f) in load.iter().enumerate() {
            match self.source(dof) {
                DofSource::Free(i) => y[i] = *f,
                DofSource::Held(place) if *f != 0.0 => {
                    for (k, &s) in self.shaft.iter().enumerate() {
                        y[first + k] += self.lever(place, dof % 3, s) * f;
                    }
                }
                DofSource::Held(_) => {}
            }
        }
        y
    }

    /// Generalised loads of a unit force in each direction of a contact: index and value, indices distinct.
    pub fn reduce_weights(&self, weights: &NodalWeights) -> [SparseLoad; 2] {
        [0, 1].map(|direction| {
            let mut load = SparseLoad::new();
            let mut shaft = vec![0.0; self.shaft.len()];
            for (&node, coefficients) in weights.nodes.iter().zip(&weights.coefficients) {
                for (component, &value) in coefficients[direction].iter().enumerate() {
                    match self.source(3 * node + component) {
                        DofSource::Free(i) => load.push((i, value)),
                        DofSource::Held(place) => {
                            for (sum, &q) in shaft.iter_mut().zip(&self.shaft) {
                                *sum += self.lever(place, component, q) * value;
                            }
                        }
                    }
                }
            }
            let first = self.free.len();
            load.extend(
                shaft
                    .into_iter()
                    .enumerate()
                    .filter(|s| s.1 != 0.0)
                    .map(|(k, value)| (first + k, value)),
            );
            load
        })
    }

    /// T^T A T of a symmetric matrix of all nodal dofs, both triangles.
    pub fn reduce_matrix(&self, a: &CsMat<f64>) -> CsMat<f64> {
        let inner = solver::restrict(a, &self.free);
        if self.shaft.is_empty() {
            return inner;
        }
        let (n, m) = (self.free.len(), self.shaft.len());
        let (mut border, mut corner) = (vec![0.0; n * m], vec![0.0; m * m]);
        for (dof, row) in a.outer_iterator().enumerate() {
            let mut moved = vec![0.0; m];
            for (j, value) in row.iter() {
                if let DofSource::Held(place) = self.source(j) {
                    (0..m).for_each(|k| moved[k] += value * self.lever(place, j % 3, self.shaft[k]));
                }
            }
            match self.source(dof) {
                DofSource::Free(i) => border[m * i..m * (i + 1)].copy_from_slice(&moved),
                DofSource::Held(place) => {
                    for k in 0..m {
                        let lever = self.lever(place, dof % 3, self.shaft[k]);
                        (0..m).for_each(|l| corner[m * k + l] += lever * moved[l]);
                    }
                }
            }
        }
        bordered(&inner, &border, &corner, m)
    }
}

/// Motion of a node's component per unit of shaft dof `q`: translations, then tilts about x and y.
pub fn rigid_lever(arm: [f64; 3], component: usize, q: usize) -> f64 {
    match (q, component) {
        (0, 0) | (1, 1) | (2, 2) => 1.0,
        (3, 1) => -arm[2],
        (3, 2) => arm[1],
        (4, 0) => arm[2],
        (4, 2) => -arm[0],
        _ => 0.0,
    }
}

/// The matrix [inner, border; border^T, corner] in compressed rows.
fn bordered(inner: &CsMat<f64>, border: &[f64], corner: &[f64], m: usize) -> CsMat<f64> {
    let n = inner.rows();
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (i, row) in inner.outer_iterator().enumerate() {
        for (j, value) in row.iter() {
            columns.push(j);
            values.push(*value);
        }
        for (k, &value) in border[m * i..m * (i + 1)].iter().enumerate() {
            if value != 0.0 {
                columns.push(n + k);
                values.push(value);
            }
        }
        starts.push(columns.len());
    }
    for k in 0..m {
        for i in 0..n {
            if border[m * i + k] != 0.0 {
                columns.push(i);
                values.push(border[m * i + k]);
            }
        }
        for l in 0..m {
            // Both halves of the corner were summed in different orders.
            columns.push(n + l);
            values.push(0.5 * (corner[m * k + l] + corner[m * l + k]));
        }
        starts.push(columns.len());
    }
    CsMat::new((n + m, n + m), starts, columns, values)
}
