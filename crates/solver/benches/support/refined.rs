//! A ring of tetrahedra that is finer round one place of its raceway: neither its sectors nor its sections are alike.

use std::collections::BTreeMap;

use mesh::{ElementKind, Mesh};

/// Divides the edges of straight tetrahedra, longest first, until none is longer than `size` says at its middle.
/// Quadratic tetrahedra in, quadratic ones out, with new numbers and without groups.
pub fn refined(mesh: &Mesh, size: impl Fn([f64; 3]) -> f64) -> Mesh {
    assert_eq!(mesh.kind, ElementKind::Tet10, "only tetrahedra are divided");
    let mut points = mesh.nodes.to_vec();
    let corners = |nodes: &[usize]| [nodes[0], nodes[1], nodes[2], nodes[3]];
    let mut tets: Vec<[usize; 4]> = mesh.connectivity.chunks_exact(10).map(corners).collect();
    loop {
        let mut around: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (t, tet) in tets.iter().enumerate() {
            for edge in edges(tet) {
                around.entry(edge).or_default().push(t);
            }
        }
        let length = |[a, b]: [usize; 2]| {
            (0..3)
                .map(|c| (points[a][c] - points[b][c]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let mut long: Vec<(f64, [usize; 2])> = around.keys().map(|&edge| (length(edge), edge)).collect();
        long.retain(|&(length, edge)| length > size(middle(&points, edge)));
        long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        if long.is_empty() {
            break;
        }
        // An edge whose tetrahedra have been divided already waits for the next round.
        let mut is_new = vec![false; tets.len()];
        for (_, edge) in long {
            if around[&edge].iter().any(|&t| is_new[t]) {
                continue;
            }
            let node = points.len();
            points.push(middle(&points, edge));
            for &t in &around[&edge] {
                is_new[t] = true;
                let mut half = tets[t];
                let end = |corner: usize| {
                    tets[t]
                        .iter()
                        .position(|&n| n == edge[corner])
                        .expect("an edge of it")
                };
                let (a, b) = (end(0), end(1));
                half[a] = node;
                tets[t][b] = node;
                tets.push(half);
            }
        }
    }
    quadratic(&points, &tets)
}

/// Edges of a tetrahedron in the order of the middle nodes of a quadratic one, each with the lower node first.
fn edges(tet: &[usize; 4]) -> [[usize; 2]; 6] {
    [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]].map(|[i, j]| [tet[i].min(tet[j]), tet[i].max(tet[j])])
}

fn middle(points: &[[f64; 3]], [a, b]: [usize; 2]) -> [f64; 3] {
    [0, 1, 2].map(|c| 0.5 * (points[a][c] + points[b][c]))
}

/// Quadratic tetrahedra with the given corners; points that are no corners are left out.
fn quadratic(points: &[[f64; 3]], tets: &[[usize; 4]]) -> Mesh {
    let (mut nodes, mut connectivity) = (Vec::new(), Vec::new());
    let mut number = BTreeMap::new();
    let mut node_at = |ends: [usize; 2]| {
        *number.entry(ends).or_insert_with(|| {
            nodes.push(middle(points, ends));
            nodes.len() - 1
        })
    };
    for tet in tets {
        connectivity.extend(tet.map(|corner| node_at([corner, corner])));
        connectivity.extend(edges(tet).map(&mut node_at));
    }
    Mesh {
        kind: ElementKind::Tet10,
        nodes: nodes.into(),
        connectivity,
        groups: BTreeMap::new(),
    }
}
