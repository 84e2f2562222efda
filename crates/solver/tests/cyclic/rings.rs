//! Rings in both forms: as one sector and assembled.

use std::collections::BTreeMap;

use fem::Material;
use mesh::{ElementKind, Mesh, PERIODIC_TOLERANCE, Periodicity, Section, find_periodicity, revolve};
use solver::{
    Coupling, CyclicCholesky, CyclicMatrix, CyclicRing, LinearSolver, SparseCholesky, Symbolic, Symmetry,
    angular_dissection, expand, restrict_lower, restrict_order,
};
use sprs::CsMat;

use crate::common::assert_close;

/// Shift by the mass, 1/s^2: that of a step of 1e-5 s.
pub const SHIFT: f64 = 4e10;

/// A lopsided section of 4 x 5 nodes, its inner side named `bore`.
pub fn section() -> Section {
    let (n_r, n_z) = (3, 4);
    let mut points = Vec::new();
    for j in 0..=n_z {
        for i in 0..=n_r {
            let (x, y) = (i as f64 / n_r as f64, j as f64 / n_z as f64);
            points.push([0.025 + 0.006 * x + 0.001 * x * y, 0.016 * y + 0.0015 * x * x]);
        }
    }
    let at = |i: usize, j: usize| j * (n_r + 1) + i;
    let quads = (0..n_z)
        .flat_map(|j| (0..n_r).map(move |i| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let bore = (0..n_z).map(|j| [at(0, j), at(0, j + 1)]).collect();
    Section::new(
        points,
        quads.collect(),
        &BTreeMap::from([("bore".to_string(), bore)]),
    )
    .unwrap()
}

/// A ring whose planes are turned against each other along the axis: periodic without mirror symmetry.
pub fn twisted(mut mesh: Mesh) -> Mesh {
    for [x, y, z] in &mut mesh.nodes {
        let (s, c) = (20.0 * *z).sin_cos();
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    }
    mesh
}

/// A ring in both forms.
pub struct Ring {
    pub mesh: Mesh,
    pub periodicity: Periodicity,
    pub stiffness: CyclicMatrix,
    pub mass: CyclicMatrix,
    pub ring: CyclicRing,
}

/// Couplings of a sector as the solver has them.
pub fn couplings(couplings: &[fem::SectorCoupling]) -> Vec<Coupling> {
    let coupling = |c: &fem::SectorCoupling| Coupling {
        row: c.row,
        column: c.column,
        shift: c.shift,
    };
    couplings.iter().map(coupling).collect()
}

impl Ring {
    pub fn new(mesh: Mesh) -> Ring {
        let periodicity = find_periodicity(&mesh, PERIODIC_TOLERANCE).unwrap();
        let half_way = periodicity.half_way().map(<[bool]>::to_vec);
        Ring::with_offsets(mesh, periodicity, half_way.as_deref())
    }

    /// Section nodes and dofs that a clamped bore leaves.
    pub fn without_bore(&self) -> [Vec<usize>; 2] {
        let bore = self.mesh.group_nodes("bore");
        let held = self.periodicity.section_nodes(&bore).unwrap();
        let nodes = (0..self.periodicity.n_section_nodes()).filter(|node| !held.contains(node));
        let dofs = (0..self.mesh.n_dofs()).filter(|dof| bore.binary_search(&(dof / 3)).is_err());
        [nodes.collect(), dofs.collect()]
    }

    pub fn with_offsets(mesh: Mesh, periodicity: Periodicity, half_way: Option<&[bool]>) -> Ring {
        let sector = fem::assemble_sector(&mesh, &periodicity, &steel()).unwrap();
        let couplings = couplings(&sector.couplings);
        let (n, width) = (periodicity.n_sectors(), periodicity.n_section_nodes());
        let stiffness = CyclicMatrix::new(n, width, &couplings, &sector.stiffness).unwrap();
        let mass = stiffness.with_blocks(&couplings, &sector.mass).unwrap();
        let directions = fem::azimuth_directions(&mesh);
        let ring = CyclicRing::new(&stiffness, periodicity.nodes(), &directions, half_way).unwrap();
        Ring {
            mesh,
            periodicity,
            stiffness,
            mass,
            ring,
        }
    }

    pub fn shifted(&self) -> CyclicMatrix {
        self.stiffness.combined(1.0, SHIFT, &self.mass).unwrap()
    }

    /// The same matrix assembled over all elements.
    pub fn assembled(&self, shift: f64) -> CsMat<f64> {
        let mut matrix = fem::assemble_stiffness(&self.mesh, &steel()).unwrap();
        let mass = fem::assemble_mass(&self.mesh, &steel()).unwrap();
        matrix
            .data_mut()
            .iter_mut()
            .zip(mass.data())
            .for_each(|(k, m)| *k += shift * m);
        matrix
    }

    /// Sparse factor of the rows `free` of an assembled matrix.
    pub fn sparse(&self, matrix: &CsMat<f64>, free: &[usize]) -> SparseCholesky {
        let mesh = &self.mesh;
        let nodes = angular_dissection(&mesh.nodes, &mesh.connectivity, mesh.kind.n_nodes());
        let lower = restrict_lower(matrix, free);
        let symbolic = Symbolic::new(&lower, &restrict_order(&expand(&nodes, 3), free)).unwrap();
        symbolic.factor(&lower).unwrap()
    }
}

pub fn steel() -> Material {
    Material::new(207e9, 0.3, 7800.0).unwrap()
}

/// Numbers between -1 and 1 by a fixed rule.
pub fn loads(n: usize) -> Vec<f64> {
    (0..n as u64)
        .map(|i| {
            let mixed = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            ((mixed ^ (mixed >> 31)) % 20_001) as f64 / 1e4 - 1.0
        })
        .collect()
}

/// Solutions of both solvers for three right-hand sides must agree.
#[track_caller]
pub fn assert_agree(cyclic: &CyclicCholesky, sparse: &SparseCholesky, tolerance: f64) {
    let (n, n_rhs) = (sparse.n(), 3);
    assert_eq!(cyclic.n(), n);
    let mut found = loads(n * n_rhs);
    let mut expected = found.clone();
    cyclic.solve(&mut found, n_rhs);
    sparse.solve(&mut expected, n_rhs);
    for (found, expected) in found.chunks(n).zip(expected.chunks(n)) {
        assert_close(found, expected, tolerance);
    }
}

/// All rings tested: even, odd and prime numbers of sectors, both hexahedra, with and without mirror symmetry.
pub fn rings() -> Vec<(Ring, Symmetry)> {
    let mut rings = Vec::new();
    for (kind, n) in [
        (ElementKind::Hex8, 24),
        (ElementKind::Hex8, 15),
        (ElementKind::Hex8, 37),
        (ElementKind::Hex20, 12),
        (ElementKind::Hex20, 13),
    ] {
        let mesh = revolve(&section(), n, kind, &[]).unwrap();
        rings.push((Ring::new(mesh.clone()), Symmetry::Mirrored));
        rings.push((Ring::new(twisted(mesh)), Symmetry::None));
    }
    let hexes = revolve(&section(), 14, ElementKind::Hex8, &[]).unwrap();
    rings.push((Ring::new(tetrahedra(&hexes)), Symmetry::None));
    rings
}

/// Straight-edged quadratic tetrahedra, six to a hexahedron round its diagonal (Kuhn).
pub fn tetrahedra(hexes: &Mesh) -> Mesh {
    const KUHN: [[usize; 4]; 6] = [
        [0, 1, 2, 6],
        [0, 2, 3, 6],
        [0, 3, 7, 6],
        [0, 7, 4, 6],
        [0, 4, 5, 6],
        [0, 5, 1, 6],
    ];
    let mut mesh = Mesh {
        kind: ElementKind::Tet10,
        connectivity: Vec::new(),
        groups: BTreeMap::new(),
        ..hexes.clone()
    };
    let mut mids = BTreeMap::new();
    for e in 0..hexes.n_elements() {
        for corners in KUHN.map(|tet| tet.map(|corner| hexes.element(e)[corner])) {
            mesh.connectivity.extend(corners);
            for &[a, b] in ElementKind::Tet10.edges() {
                let pair = [corners[a].min(corners[b]), corners[a].max(corners[b])];
                let nodes = &mut mesh.nodes;
                mesh.connectivity.push(*mids.entry(pair).or_insert_with(|| {
                    nodes.push([0, 1, 2].map(|i| 0.5 * (nodes[pair[0]][i] + nodes[pair[1]][i])));
                    nodes.len() - 1
                }));
            }
        }
    }
    let facets = (0..mesh.n_elements())
        .flat_map(|element| (0..mesh.kind.n_faces()).map(move |face| mesh::Facet { element, face }));
    let smallest = hexes
        .nodes
        .iter()
        .map(|x| x[0].hypot(x[1]))
        .fold(f64::INFINITY, f64::min);
    let on_bore: Vec<mesh::Facet> = facets
        .filter(|&facet| {
            let mut corners = mesh.facet_nodes(facet).take(3);
            corners.all(|node| mesh.nodes[node][0].hypot(mesh.nodes[node][1]) < smallest + 1e-9)
        })
        .collect();
    mesh.groups.insert("bore".to_string(), on_bore);
    mesh
}
