//! Meshes of mapped boxes: a grid of the unit cube, its nodes moved by any map, mid-nodes included.

use std::collections::BTreeMap;

use mesh::{ElementKind, Facet, Mesh};

/// The six tetrahedra of a cube around its diagonal 0-6 (Kuhn): neighbours agree on the diagonals of shared faces.
const KUHN: [[usize; 4]; 6] = [
    [0, 1, 2, 6],
    [0, 2, 3, 6],
    [0, 3, 7, 6],
    [0, 7, 4, 6],
    [0, 4, 5, 6],
    [0, 5, 1, 6],
];

/// Corners of a cube in the node order of a hexahedron.
const CUBE: [[usize; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];

/// Corners of the edges of the mid-nodes.
const HEX_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];
const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// Whether the last cells along the second direction are joined to the first, as in a full ring.
#[derive(Clone, Copy, PartialEq)]
pub enum Ends {
    /// A block.
    Free,
    /// A ring.
    Joined,
}

/// A grid of `cells` of the unit cube mapped by `map`; groups `x0 x1 y0 y1 z0 z1` are its sides before the map.
pub fn mapped_grid(
    kind: ElementKind,
    cells: [usize; 3],
    ends: Ends,
    map: impl Fn([f64; 3]) -> [f64; 3],
) -> Mesh {
    // Every node has a place in a lattice of half cells.
    let mut nodes: BTreeMap<[usize; 3], usize> = BTreeMap::new();
    let mut mesh = Mesh {
        kind,
        nodes: Default::default(),
        connectivity: Vec::new(),
        groups: BTreeMap::new(),
    };
    for k in 0..cells[2] {
        for j in 0..cells[1] {
            for i in 0..cells[0] {
                for places in elements_of_cell(kind, [i, j, k]) {
                    add_element(&mut mesh, &mut nodes, &places, cells, ends, &map);
                    collect_sides(&mut mesh, &places, cells);
                }
            }
        }
    }
    mesh
}

/// Lattice places of the nodes of the elements of one cell.
fn elements_of_cell(kind: ElementKind, cell: [usize; 3]) -> Vec<Vec<[usize; 3]>> {
    let corners = CUBE.map(|corner| [0, 1, 2].map(|i| 2 * (cell[i] + corner[i])));
    let middle = |[a, b]: [usize; 2]| [0, 1, 2].map(|i| (corners[a][i] + corners[b][i]) / 2);
    match kind {
        ElementKind::Hex8 => vec![corners.to_vec()],
        ElementKind::Hex20 => vec![corners.into_iter().chain(HEX_EDGES.map(middle)).collect()],
        ElementKind::Tet10 => {
            let tet = |t: [usize; 4]| {
                let mids = TET_EDGES.map(|[a, b]| middle([t[a], t[b]]));
                t.into_iter().map(|corner| corners[corner]).chain(mids).collect()
            };
            KUHN.into_iter().map(tet).collect()
        }
    }
}

/// Appends an element and its new nodes.
fn add_element(
    mesh: &mut Mesh,
    nodes: &mut BTreeMap<[usize; 3], usize>,
    places: &[[usize; 3]],
    cells: [usize; 3],
    ends: Ends,
    map: &impl Fn([f64; 3]) -> [f64; 3],
) {
    for &place in places {
        let mut place = place;
        if ends == Ends::Joined {
            place[1] %= 2 * cells[1];
        }
        let node = *nodes.entry(place).or_insert_with(|| {
            mesh.nodes
                .push(map([0, 1, 2].map(|i| place[i] as f64 / (2 * cells[i]) as f64)));
            mesh.nodes.len() - 1
        });
        mesh.connectivity.push(node);
    }
}

/// Adds the faces of the last element that lie on a side of the cube to that side's group.
fn collect_sides(mesh: &mut Mesh, places: &[[usize; 3]], cells: [usize; 3]) {
    let element = mesh.n_elements() - 1;
    for face in 0..mesh.kind.n_faces() {
        let on_face: Vec<[usize; 3]> = mesh.kind.face_nodes(face).iter().map(|&a| places[a]).collect();
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            for (end, level) in [("0", 0), ("1", 2 * cells[i])] {
                if on_face.iter().all(|place| place[i] == level) {
                    mesh.groups
                        .entry(format!("{axis}{end}"))
                        .or_default()
                        .push(Facet { element, face });
                }
            }
        }
    }
}

/// The unit cube with its inside bent by smooth waves; its sides stay plane.
pub fn wavy_cube(kind: ElementKind, n: usize) -> Mesh {
    mapped_grid(kind, [n; 3], Ends::Free, |[x, y, z]| {
        let wave = |t: f64| (std::f64::consts::PI * t).sin();
        let bump = 0.08 * wave(x) * wave(y) * wave(z);
        [x + bump, y - 0.7 * bump, z + 0.5 * bump]
    })
}

/// The unit cube with corners moved by up to a fifth of a cell by a fixed pseudo-random rule, edges straight.
pub fn crooked_cube(kind: ElementKind, n: usize) -> Mesh {
    let hash = |x: [f64; 3], i: usize| {
        let phase = 127.1 * x[0] + 311.7 * x[1] + 74.7 * x[2] + 53.3 * i as f64;
        2.0 * (43758.5453 * phase.sin()).rem_euclid(1.0) - 1.0
    };
    let corner = |x: [f64; 3]| [0, 1, 2].map(|i| x[i] + 0.2 / n as f64 * hash(x, i));
    mapped_grid(kind, [n; 3], Ends::Free, |x| {
        // A mid-node has odd half-cell coordinates along its edge: it is the mean of the edge's ends.
        let half = 0.5 / n as f64;
        let odd = x.map(|t| (t / half).round() as usize % 2 == 1);
        let end = |sign: f64| {
            corner([0, 1, 2].map(|i| {
                if odd[i] {
                    snap(x[i] + sign * half, n)
                } else {
                    snap(x[i], n)
                }
            }))
        };
        let (a, b) = (end(-1.0), end(1.0));
        [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]))
    })
}

/// The nearest multiple of 1/n, so that both ends of an edge hash alike from every side.
fn snap(t: f64, n: usize) -> f64 {
    (t * n as f64).round() / n as f64
}

/// A sector (rad) of a ring of rectangular section, inner and outer radius and height in m; x0 is the bore, x1 the rim.
pub fn ring(kind: ElementKind, cells: [usize; 3], radii: [f64; 2], height: f64, sector: f64) -> Mesh {
    let full = (sector - std::f64::consts::TAU).abs() < 1e-12;
    let ends = if full { Ends::Joined } else { Ends::Free };
    mapped_grid(kind, cells, ends, |[x, y, z]| {
        let r = radii[0] + (radii[1] - radii[0]) * x;
        [r * (sector * y).cos(), r * (sector * y).sin(), height * z]
    })
}
