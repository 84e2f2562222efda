//! How a ring is held: clamped, or by the mean motion of its bore or seat.
//!
//! Both give the *elastic* displacement: relative to the rigid partner. With a mean-motion hold the elastic
//! displacement u has C u = 0, where C takes the area-weighted least-squares rigid motion of the held surface.
//! With rigid modes R (C R = 1) the partner's reaction to loads f is -C^T R^T f, so the ring sees the balanced loads
//! P^T f, P = 1 - R C. Six dofs chosen on the surface then hold the matrix without reaction, and P removes the
//! rigid motion left: u = P K_fixed^-1 P^T f, exact and symmetric (the RBE3 of structural codes).

use dense::DenseCholesky;
use mesh::Mesh;

use crate::division::NodePlaces;
use crate::model::Hold;

/// A hold, ready to apply.
pub struct AppliedHold {
    /// Dofs that stay in the factored matrix, ascending.
    pub free: Vec<usize>,
    mean: Option<MeanMotion>,
}

/// The mean motion of a surface as six functionals.
struct MeanMotion {
    /// Reference point of the surface, m.
    centre: [f64; 3],
    /// Its radius of gyration, m: the unit of the arms.
    size: f64,
    /// Where the nodes are.
    places: NodePlaces,
    /// Held nodes and their area weights.
    weights: Vec<(usize, f64)>,
    /// (R^T W R)^-1, row-major 6 x 6.
    inverse: Vec<f64>,
}

impl AppliedHold {
    /// Hold of the surface with nodal area weights `weights` (node, m^2).
    pub fn new(mesh: &Mesh, hold: Hold, weights: Vec<(usize, f64)>, places: NodePlaces) -> AppliedHold {
        match hold {
            Hold::Clamped => {
                let mut held = vec![false; mesh.n_nodes()];
                weights.iter().for_each(|&(node, _)| held[node] = true);
                AppliedHold {
                    free: (0..mesh.n_dofs()).filter(|&d| !held[d / 3]).collect(),
                    mean: None,
                }
            }
            Hold::Free => AppliedHold {
                free: (0..mesh.n_dofs()).collect(),
                mean: None,
            },
            Hold::MeanMotion => {
                let mean = MeanMotion::new(places, weights);
                let fixed = mean.determinate_dofs();
                let free = (0..mesh.n_dofs()).filter(|d| !fixed.contains(d)).collect();
                AppliedHold {
                    free,
                    mean: Some(mean),
                }
            }
        }
    }

    /// The same for a factor that needs no dofs fixed in a mean motion: all stay, and loads must be balanced.
    pub fn unfixed(mesh: &Mesh, hold: Hold, weights: Vec<(usize, f64)>, places: NodePlaces) -> AppliedHold {
        match hold {
            Hold::Clamped | Hold::Free => AppliedHold::new(mesh, hold, weights, places),
            Hold::MeanMotion => AppliedHold {
                free: (0..mesh.n_dofs()).collect(),
                mean: Some(MeanMotion::new(places, weights)),
            },
        }
    }

    /// Nodes whose displacements [`AppliedHold::remove_rigid`] looks at.
    pub fn measured_nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.mean
            .iter()
            .flat_map(|mean| mean.weights.iter().map(|&(node, _)| node))
    }

    /// Replaces loads by what the ring sees with its partner's reaction: P^T f. Collective.
    pub fn balance(&self, load: &mut [f64]) {
        if let Some(mean) = &self.mean {
            mean.balance(load);
        }
    }

    /// The same of a load on some `nodes` that every rank keeps, zero elsewhere.
    pub fn balance_at(&self, nodes: &[usize], load: &mut [f64]) {
        if let Some(mean) = &self.mean {
            mean.balance_at(nodes, load);
        }
    }

    /// Removes the partner's rigid motion from a displacement: P u. Collective.
    pub fn remove_rigid(&self, displacement: &mut [f64]) {
        if let Some(mean) = &self.mean {
            mean.remove_rigid(displacement);
        }
    }

    /// The same at some `nodes` that every rank keeps.
    pub fn remove_rigid_at(&self, nodes: &[usize], displacement: &mut [f64]) {
        if let Some(mean) = &self.mean {
            mean.remove_rigid_at(nodes, displacement);
        }
    }
}

/// The mean rigid motion of a surface as six functionals of the nodal dofs, (dof, value): translations x, y, z of the
/// axis point `z = origin_z` in m per m, rotations about x, y, z in rad per m; area-weighted least squares.
pub fn mean_motion(mesh: &Mesh, weights: Vec<(usize, f64)>, origin_z: f64) -> [Vec<(usize, f64)>; 6] {
    let mean = MeanMotion::new(NodePlaces::whole(mesh.nodes.clone()), weights);
    let (centre, size) = (mean.centre, mean.size);
    let mut rows: [Vec<(usize, f64)>; 6] = Default::default();
    for &(node, w) in &mean.weights {
        for c in 0..3 {
            let motion = mean.apply_inverse(rigid_row(mean.arm(node), c).map(|r| w * r));
            let turn = [motion[3] / size, motion[4] / size, motion[5] / size];
            // From the surface's reference point to the origin: t + phi x (origin - centre).
            let arm = [-centre[0], -centre[1], origin_z - centre[2]];
            let moved = [
                motion[0] + turn[1] * arm[2] - turn[2] * arm[1],
                motion[1] + turn[2] * arm[0] - turn[0] * arm[2],
                motion[2] + turn[0] * arm[1] - turn[1] * arm[0],
            ];
            for (row, value) in rows.iter_mut().zip(moved.into_iter().chain(turn)) {
                row.push((3 * node + c, value));
            }
        }
    }
    rows
}

/// Rows of the rigid modes at one node: u = q[0..3] + q[3..6] x arm.
fn rigid_row(arm: [f64; 3], component: usize) -> [f64; 6] {
    let [x, y, z] = arm;
    match component {
        0 => [1.0, 0.0, 0.0, 0.0, z, -y],
        1 => [0.0, 1.0, 0.0, -z, 0.0, x],
        _ => [0.0, 0.0, 1.0, y, -x, 0.0],
    }
}

impl MeanMotion {
    fn new(places: NodePlaces, weights: Vec<(usize, f64)>) -> MeanMotion {
        let positions = places.positions();
        let total: f64 = weights.iter().map(|w| w.1).sum();
        let mut centre = [0.0; 3];
        for &(node, w) in &weights {
            (0..3).for_each(|i| centre[i] += w / total * positions[node][i]);
        }
        let square = |x: [f64; 3]| (0..3).map(|i| (x[i] - centre[i]).powi(2)).sum::<f64>();
        let size = weights
            .iter()
            .map(|&(node, w)| w / total * square(positions[node]))
            .sum::<f64>()
            .sqrt();
        let mut gram = vec![0.0; 36];
        for &(node, w) in &weights {
            for component in 0..3 {
                let row = rigid_row(arm_of(positions[node], centre, size), component);
                for i in 0..6 {
                    (0..6).for_each(|j| gram[6 * i + j] += w * row[i] * row[j]);
                }
            }
        }
        let inverse = DenseCholesky::factor(6, &gram)
            .expect("a surface of facets is not a straight line, so its mean rotation is defined")
            .inverse();
        MeanMotion {
            centre,
            size,
            places,
            weights,
            inverse,
        }
    }

    /// Six dofs of held nodes that determine a rigid motion best: Gaussian elimination with complete pivoting.
    fn determinate_dofs(&self) -> Vec<usize> {
        let mut rows: Vec<(usize, [f64; 6])> = self
            .weights
            .iter()
            .flat_map(|&(node, _)| (0..3).map(move |c| (3 * node + c, c)))
            .map(|(dof, c)| (dof, rigid_row(self.arm(dof / 3), c)))
            .collect();
        let mut chosen = Vec::new();
        for _ in 0..6 {
            let norm = |r: &[f64; 6]| r.iter().map(|x| x * x).sum::<f64>();
            let (mut best, mut largest) = (0, -1.0);
            for (i, (_, row)) in rows.iter().enumerate() {
                // A clear margin, so that equal candidates always give the first one.
                if norm(row) > largest * (1.0 + 1e-9) {
                    (best, largest) = (i, norm(row));
                }
            }
            let (dof, pivot) = rows.swap_remove(best);
            rows.sort_by_key(|r| r.0);
            chosen.push(dof);
            for (_, row) in &mut rows {
                let share = (0..6).map(|i| row[i] * pivot[i]).sum::<f64>() / largest;
                (0..6).for_each(|i| row[i] -= share * pivot[i]);
            }
        }
        chosen.sort_unstable();
        chosen
    }

    /// Position relative to the surface's reference point over its size.
    fn arm(&self, node: usize) -> [f64; 3] {
        arm_of(self.places.positions()[node], self.centre, self.size)
    }

    /// f -= C^T R^T f, C = (R^T W R)^-1 R^T W on the held nodes.
    fn balance(&self, load: &mut [f64]) {
        let resultant = self.places.sum(|node, x| {
            let mut sum = [0.0; 6];
            accumulate(
                &mut sum,
                arm_of(x, self.centre, self.size),
                &load[3 * node..3 * node + 3],
                1.0,
            );
            sum
        });
        self.react(resultant, load);
    }

    fn balance_at(&self, nodes: &[usize], load: &mut [f64]) {
        let mut resultant = [0.0; 6];
        for &node in nodes {
            accumulate(&mut resultant, self.arm(node), &load[3 * node..3 * node + 3], 1.0);
        }
        self.react(resultant, load);
    }

    /// Takes the partner's reaction to loads R^T f off the held nodes.
    fn react(&self, resultant: [f64; 6], load: &mut [f64]) {
        let multipliers = self.apply_inverse(resultant);
        for &(node, w) in &self.weights {
            for c in 0..3 {
                let row = rigid_row(self.arm(node), c);
                load[3 * node + c] -= w * (0..6).map(|i| row[i] * multipliers[i]).sum::<f64>();
            }
        }
    }

    /// u -= R C u.
    fn remove_rigid(&self, displacement: &mut [f64]) {
        let motion = self.motion(displacement);
        let rigid = self.places.field(|x| self.rigid(x, motion));
        displacement.iter_mut().zip(rigid).for_each(|(u, r)| *u -= r);
    }

    fn remove_rigid_at(&self, nodes: &[usize], displacement: &mut [f64]) {
        let motion = self.motion(displacement);
        for &node in nodes {
            let rigid = self.rigid(self.places.positions()[node], motion);
            let u = displacement[3 * node..3 * node + 3].iter_mut();
            u.zip(rigid).for_each(|(u, r)| *u -= r);
        }
    }

    /// R q at a position.
    fn rigid(&self, x: [f64; 3], motion: [f64; 6]) -> [f64; 3] {
        let arm = arm_of(x, self.centre, self.size);
        [0, 1, 2].map(|c| {
            let row = rigid_row(arm, c);
            (0..6).map(|i| row[i] * motion[i]).sum()
        })
    }

    /// q = C u.
    fn motion(&self, displacement: &[f64]) -> [f64; 6] {
        let mut moment = [0.0; 6];
        for &(node, w) in &self.weights {
            accumulate(
                &mut moment,
                self.arm(node),
                &displacement[3 * node..3 * node + 3],
                w,
            );
        }
        self.apply_inverse(moment)
    }

    fn apply_inverse(&self, v: [f64; 6]) -> [f64; 6] {
        [0, 1, 2, 3, 4, 5].map(|i| (0..6).map(|j| self.inverse[6 * i + j] * v[j]).sum())
    }
}

fn arm_of(x: [f64; 3], centre: [f64; 3], size: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| (x[i] - centre[i]) / size)
}

/// sum += w R_node^T v.
fn accumulate(sum: &mut [f64; 6], arm: [f64; 3], v: &[f64], w: f64) {
    for c in 0..3 {
        let row = rigid_row(arm, c);
        (0..6).for_each(|i| sum[i] += w * row[i] * v[c]);
    }
}
