//! Small rings of every kind of element, as a whole and as a sum of sectors.

use std::borrow::Cow;
use std::collections::BTreeMap;

use comm::Communicator;
use fem::Material;
use mesh::{ElementKind, Mesh, Section, revolve};
use solver::{
    Points, SectorCholesky, SectorLayout, SectorSymbolic, SolverError, SparseCholesky, Symbolic,
    angular_dissection, expand, restrict, restrict_order,
};
use sprs::CsMat;

use crate::common::Numbers;

/// Shift by the mass, 1/s^2: that of a step of 1e-5 s.
pub const SHIFT: f64 = 4e10;

pub fn steel() -> Material {
    Material::new(207e9, 0.3, 7800.0).unwrap()
}

/// A ring of `layers` layers of 2 x 2 quads, so thick that it bends little more easily than it stretches; its inner
/// side is the `bore`.
pub fn ring(kind: ElementKind, layers: usize) -> Mesh {
    let at = |i: usize, j: usize| 3 * j + i;
    let points = (0..9).map(|k| [0.012 + 0.008 * (k % 3) as f64, 0.008 * (k / 3) as f64]);
    let quads = (0..4).map(|k| {
        let (i, j) = (k % 2, k / 2);
        [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
    });
    let bore = vec![[at(0, 0), at(0, 1)], [at(0, 1), at(0, 2)]];
    let groups = BTreeMap::from([("bore".to_string(), bore)]);
    let section = Section::new(points.collect(), quads.collect(), &groups).unwrap();
    match kind {
        ElementKind::Tet10 => tets(&revolve(&section, layers, ElementKind::Hex8, &[]).unwrap()),
        kind => revolve(&section, layers, kind, &[]).unwrap(),
    }
}

/// Every hexahedron cut into six quadratic tetrahedra round its diagonal from corner 0 to 6.
fn tets(hexes: &Mesh) -> Mesh {
    const PATHS: [[usize; 2]; 6] = [[1, 2], [2, 3], [3, 7], [7, 4], [4, 5], [5, 1]];
    const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];
    let mut nodes = hexes.nodes.clone();
    let mut middles = BTreeMap::new();
    let mut connectivity = Vec::new();
    for e in 0..hexes.n_elements() {
        let hex = hexes.element(e);
        for [a, b] in PATHS {
            let corners = [hex[0], hex[a], hex[b], hex[6]];
            connectivity.extend(corners);
            for [i, j] in EDGES {
                let ends = [corners[i].min(corners[j]), corners[i].max(corners[j])];
                let middle = *middles.entry(ends).or_insert_with(|| {
                    nodes.push([0, 1, 2].map(|c| 0.5 * (nodes[ends[0]][c] + nodes[ends[1]][c])));
                    nodes.len() - 1
                });
                connectivity.push(middle);
            }
        }
    }
    Mesh {
        kind: ElementKind::Tet10,
        nodes,
        connectivity,
        groups: BTreeMap::new(),
    }
}

/// The same ring with its layers crowded on one side and all nodes displaced at random: nothing repeats.
pub fn irregular(mut mesh: Mesh) -> Mesh {
    let mut numbers = Numbers::new(11);
    for x in &mut mesh.nodes {
        let (r, angle) = (x[0].hypot(x[1]), x[1].atan2(x[0]));
        let moved = angle + 0.45 * angle.sin();
        let [a, b, c] = [0, 1, 2].map(|_| 1.0 + 2e-5 / 0.025 * numbers.next());
        *x = [a * r * moved.cos(), b * r * moved.sin(), c * x[2]];
    }
    mesh
}

/// What holds a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Held {
    /// All nodes at the least radius.
    Clamped,
    /// Its mean motion: six dofs are fixed, loads are balanced, rigid motions taken off.
    Mean,
    /// Nothing but its mass, as in motion.
    Inertia,
}

/// A ring with what holds it.
pub struct Problem {
    pub mesh: Mesh,
    pub held: Held,
    pub free: Vec<usize>,
}

impl Problem {
    pub fn new(mesh: Mesh, held: Held) -> Problem {
        let radius = |node: usize| mesh.nodes[node][0].hypot(mesh.nodes[node][1]);
        let least = (0..mesh.n_nodes()).map(radius).fold(f64::INFINITY, f64::min);
        // Three nodes apart: all directions of one, two of another, one of a third.
        let farthest = |direction: [f64; 2]| {
            let along = |&n: &usize| direction[0] * mesh.nodes[n][0] + direction[1] * mesh.nodes[n][1];
            (0..mesh.n_nodes())
                .max_by(|a, b| along(a).total_cmp(&along(b)))
                .unwrap()
        };
        let (a, b, c) = (farthest([1.0, 0.0]), farthest([-1.0, 0.0]), farthest([0.0, 1.0]));
        let six = [3 * a, 3 * a + 1, 3 * a + 2, 3 * b + 1, 3 * b + 2, 3 * c + 2];
        let is_free = |dof: &usize| match held {
            Held::Clamped => radius(dof / 3) > least + 1e-3,
            Held::Mean => !six.contains(dof),
            Held::Inertia => true,
        };
        Problem {
            free: (0..mesh.n_dofs()).filter(is_free).collect(),
            mesh,
            held,
        }
    }

    /// Under a mean-motion hold, loads or displacements of the free dofs without their share of the six rigid motions.
    pub fn balanced(&self, x: Vec<f64>) -> Vec<f64> {
        if self.held != Held::Mean {
            return x;
        }
        let mut whole = vec![0.0; self.mesh.n_dofs()];
        self.free.iter().zip(&x).for_each(|(&dof, x)| whole[dof] = *x);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for mut mode in fem::rigid_modes(&self.mesh, [0.0, 0.0, 0.008]) {
            for _ in 0..2 {
                for other in &basis {
                    let share = dot(other, &mode);
                    mode.iter_mut().zip(other).for_each(|(m, o)| *m -= share * o);
                }
            }
            let norm = dot(&mode, &mode).sqrt();
            basis.push(mode.iter().map(|m| m / norm).collect());
        }
        for mode in &basis {
            let share = dot(mode, &whole);
            whole.iter_mut().zip(mode).for_each(|(w, m)| *w -= share * m);
        }
        self.free.iter().map(|&dof| whole[dof]).collect()
    }

    /// The matrix of a mesh or of a part of one, with mass when nothing else holds it.
    pub fn matrix_of(&self, mesh: &Mesh) -> CsMat<f64> {
        let stiffness = fem::assemble_stiffness(mesh, &steel()).unwrap();
        if self.held != Held::Inertia {
            return stiffness;
        }
        let mass = fem::assemble_mass(mesh, &steel()).unwrap();
        &stiffness + &mass.map(|m| SHIFT * m)
    }

    /// Matrix of the free dofs.
    pub fn matrix(&self) -> CsMat<f64> {
        restrict(&self.matrix_of(&self.mesh), &self.free)
    }

    pub fn sparse(&self) -> SparseCholesky {
        let (mesh, matrix) = (&self.mesh, self.matrix());
        let nodes = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
        let order = restrict_order(&expand(&nodes, 3), &self.free);
        Symbolic::new(&matrix, &order).unwrap().factor(&matrix).unwrap()
    }

    pub fn layout(&self, n_sectors: usize) -> SectorLayout {
        let mesh = &self.mesh;
        let n = mesh.kind.n_nodes();
        SectorLayout::new(&mesh.nodes, &mesh.connectivity, n, &self.free, n_sectors).unwrap()
    }

    pub fn symbolic(&self, n_sectors: usize) -> SectorSymbolic {
        let layout = self.layout(n_sectors);
        let mesh = &self.mesh;
        let points = |node: usize| mesh.nodes[node];
        let cells = (
            &points as &Points<'_>,
            &mesh.connectivity[..],
            mesh.kind.n_nodes(),
        );
        let parts = layout.clone();
        SectorSymbolic::new(layout, Communicator::Serial, cells, |s| {
            Cow::Owned(self.part(&parts, s))
        })
        .unwrap()
    }

    /// The own matrix of a sector.
    pub fn part(&self, layout: &SectorLayout, sector: usize) -> CsMat<f64> {
        let sector = &layout.sectors()[sector];
        self.matrix_of(&self.mesh.part(&sector.elements, &sector.nodes))
    }

    pub fn sectors(&self, n_sectors: usize) -> Result<SectorCholesky, SolverError> {
        let symbolic = self.symbolic(n_sectors);
        let layout = symbolic.layout().clone();
        symbolic.factor(|s| Cow::Owned(self.part(&layout, s)))
    }
}
