//! Harmonic space: transforms, products, responses.

use mesh::{ElementKind, revolve};
use solver::cyclic::{HarmonicOperator, NODE_LEN, turned};
use solver::{LinearSolver, NodalLoad, ResponseTable};

use super::rings::{Ring, SHIFT, loads, rings, section};
use crate::common::assert_close;

/// Wrong: products through the sectors, in nodal and in harmonic space, would not be those of the assembled matrix; or
/// energies summed in harmonic space would not be those of the nodal vectors.
#[test]
fn products_through_the_sector_are_those_of_the_assembled_matrix() {
    for (ring, _) in rings() {
        let n = ring.mesh.n_dofs();
        let x = loads(n);
        let matrix = ring.assembled(SHIFT);
        let expected = crate::common::product(&matrix, &x);
        let shifted = ring.shifted();
        assert_close(&ring.ring.apply(&shifted, &x).unwrap(), &expected, 1e-13);

        let mut w = vec![0.0; ring.ring.harmonic_len()];
        let mut product = w.clone();
        ring.ring.to_harmonic(&x, &mut w);
        ring.ring.apply_harmonic(&shifted, &w, &mut product).unwrap();
        let mut nodal = vec![0.0; n];
        ring.ring.from_harmonic(&product, &mut nodal);
        assert_close(&nodal, &expected, 1e-13);

        let energy: f64 = x.iter().zip(&expected).map(|(x, f)| x * f).sum();
        let low = ring.ring.low_len();
        let groups = w.chunks_exact(low).zip(product.chunks_exact(low)).enumerate();
        let parts: Vec<[f64; 1]> = groups.map(|(g, (a, b))| [ring.ring.group_dot(g, a, b)]).collect();
        assert_close(&ring.ring.sum_groups(&parts), &[energy], 1e-12);
    }
}

/// Wrong: a field would change on its way to harmonic space and back, for some number of sectors.
#[test]
fn a_field_survives_the_way_to_harmonic_space_and_back() {
    for n in [3, 4, 7, 16, 97] {
        let ring = Ring::new(revolve(&section(), n, ElementKind::Hex20, &[]).unwrap());
        let x = loads(ring.mesh.n_dofs());
        let (mut w, mut back) = (vec![0.0; ring.ring.harmonic_len()], vec![0.0; x.len()]);
        ring.ring.to_harmonic(&x, &mut w);
        ring.ring.from_harmonic(&w, &mut back);
        assert_close(&back, &x, 1e-14);
    }
}

/// Nodes and their Cartesian weights in two directions.
type Weights = (Vec<usize>, Vec<[[f64; 3]; 2]>);

/// Wrong: compliances of patches from the table would not be those that solves for the same loads give.
#[test]
fn the_table_gives_the_compliances_of_solves() {
    for (ring, _) in rings() {
        let factor = ring.ring.factor(&ring.shifted()).unwrap();
        let chosen = [4, 1, 7, 11];
        let table = ResponseTable::new(&factor, &chosen);
        let (n, width) = (ring.periodicity.n_sectors(), ring.periodicity.n_section_nodes());
        // The last row is read as if it were longer.
        assert_eq!(table.bytes(), 8 * (n * 12 * 12 + 7));
        let node = |sector: usize, i: usize| ring.periodicity.nodes()[(sector % n) * width + chosen[i]];
        let values = loads(200);
        let patches: Vec<Weights> = [0, 1, n / 2, n - 1]
            .iter()
            .enumerate()
            .map(|(p, &sector)| {
                let nodes: Vec<usize> = (0..5).map(|i| node(sector + i / 2, (p + i) % 4)).collect();
                let value = |i: usize| values[(40 * p + i) % 200];
                let weights = (0..5)
                    .map(|i| {
                        [
                            [0, 1, 2].map(|c| value(6 * i + c)),
                            [3, 4, 5].map(|c| value(6 * i + c)),
                        ]
                    })
                    .collect();
                (nodes, weights)
            })
            .collect();
        let in_table: Vec<_> = patches
            .iter()
            .map(|(n, w)| table.patch(&[(n, w)]).unwrap())
            .collect();
        let m = 2 * patches.len();
        let mut expected = vec![0.0; m * m];
        for j in 0..m {
            let mut u = vec![0.0; ring.mesh.n_dofs()];
            let (nodes, weights) = &patches[j / 2];
            for (&node, w) in nodes.iter().zip(weights) {
                (0..3).for_each(|c| u[3 * node + c] += w[j % 2][c]);
            }
            factor.solve(&mut u, 1);
            for i in 0..m {
                let (nodes, weights) = &patches[i / 2];
                let measured = nodes
                    .iter()
                    .zip(weights)
                    .map(|(&node, w)| (0..3).map(|c| w[i % 2][c] * u[3 * node + c]).sum::<f64>());
                expected[m * i + j] = measured.sum();
            }
        }
        assert_close(&table.compliances(&in_table), &expected, 1e-12);
        let other = (0..ring.mesh.n_nodes())
            .find(|&node| !chosen.contains(&ring.periodicity.sites()[node].section_node))
            .unwrap();
        assert_eq!(table.patch(&[(&[other], &[[[0.0; 3]; 2]])]), Err(other));
    }
}

/// Wrong: a patch on so many neighbouring nodes that their responses do not fit into the registers would meet some of
/// them twice or not at all.
#[test]
fn compliances_of_large_patches_are_sums_over_the_table() {
    for (ring, _) in rings() {
        let factor = ring.ring.factor(&ring.shifted()).unwrap();
        let (n, width) = (ring.periodicity.n_sectors(), ring.periodicity.n_section_nodes());
        let chosen: Vec<usize> = (0..width).collect();
        let table = ResponseTable::new(&factor, &chosen);
        let values = loads(24 * width);
        // Weights of node i of a sector along (radial, azimuthal, axial).
        let weight = |sector: usize, i: usize, direction: usize| {
            let first = 12 * (i + width * (sector % 2)) + 3 * direction;
            [0, 1, 2].map(|c| values[first + c])
        };
        let patch = |first: usize| {
            let sites = (first..first + 2).flat_map(|s| (0..width).map(move |i| (s % n, i)));
            let (nodes, weights): (Vec<_>, Vec<_>) = sites
                .map(|(sector, i)| {
                    let node = ring.periodicity.nodes()[sector * width + i];
                    let x = ring.mesh.nodes[node];
                    let (c, s) = (x[0] / x[0].hypot(x[1]), x[1] / x[0].hypot(x[1]));
                    let weights = [0, 1].map(|d| {
                        let [r, t, z] = weight(sector, i, d);
                        [c * r - s * t, s * r + c * t, z]
                    });
                    (node, weights)
                })
                .unzip();
            table.patch(&[(&nodes, &weights)]).unwrap()
        };
        let [a, b] = [0, n / 2];
        let found = table.compliance(&patch(a), &patch(b));
        let mut expected = [0.0; 4];
        for (k, sum) in expected.iter_mut().enumerate() {
            for (s, t) in [(a, b), (a, b + 1), (a + 1, b), (a + 1, b + 1)] {
                for ij in 0..width * width {
                    let (w, v) = (weight(s % n, ij / width, k / 2), weight(t % n, ij % width, k % 2));
                    let g = table.response((s + n - t % n) % n, ij / width, ij % width);
                    *sum += (0..9).map(|e| w[e / 3] * g[e] * v[e % 3]).sum::<f64>();
                }
            }
        }
        assert_close(&found, &expected, 1e-11);
    }
}

/// Wrong: pairs of directions that share some of their nodes would meet each other's weights. Patches of one and two
/// pairs have the compliances that the pairs have as patches of their own.
#[test]
fn pairs_of_directions_share_nodes() {
    for (ring, _) in rings() {
        let factor = ring.ring.factor(&ring.shifted()).unwrap();
        let (n, width) = (ring.periodicity.n_sectors(), ring.periodicity.n_section_nodes());
        let chosen: Vec<usize> = (0..width).collect();
        let table = ResponseTable::new(&factor, &chosen);
        let values = loads(6 * width);
        // Pair `pair` of a patch begins one node later than the pair before, and so it ends.
        let pair = |sector: usize, pair: usize| -> Weights {
            let nodes = (pair..pair + width).map(|i| {
                let (s, i) = (sector + i / width, i % width);
                ring.periodicity.nodes()[(s % n) * width + i]
            });
            let weight =
                |i: usize, d: usize| [0, 1, 2].map(|c| values[(6 * i + 3 * d + c + pair) % values.len()]);
            let weights = (0..width).map(|i| [weight(i, 0), weight(i, 1)]).collect();
            (nodes.collect(), weights)
        };
        for pairs in 1..=2 {
            let sectors = [0, n / 3, n - 1];
            let all: Vec<Vec<Weights>> = sectors
                .iter()
                .map(|&sector| (0..pairs).map(|k| pair(sector, k)).collect())
                .collect();
            let patch = |pairs: &[Weights]| {
                let pairs: Vec<_> = pairs.iter().map(|(n, w)| (&n[..], &w[..])).collect();
                table.patch(&pairs).unwrap()
            };
            let together: Vec<_> = all.iter().map(|pairs| patch(pairs)).collect();
            let alone: Vec<_> = all
                .iter()
                .flatten()
                .map(|pair| patch(std::slice::from_ref(pair)))
                .collect();
            assert_close(&table.compliances(&together), &table.compliances(&alone), 1e-13);
        }
    }
}

/// Wrong: a load on a node would be another one in harmonic space than in nodal space.
#[test]
fn single_nodes_are_loaded_as_in_the_whole_field() {
    for (ring, _) in rings() {
        let x = loads(ring.mesh.n_dofs());
        let nodes: Vec<usize> = (0..30).map(|i| (37 * i + 5) % ring.mesh.n_nodes()).collect();
        let mut w = vec![0.0; ring.ring.harmonic_len()];
        ring.ring.to_harmonic(&x, &mut w);
        // The second load of a node adds to the first.
        let forces: Vec<NodalLoad> = nodes
            .iter()
            .chain(&nodes[..3])
            .enumerate()
            .map(|(i, &node)| NodalLoad {
                node,
                force: [x[i], x[i + 1], x[i + 2]],
            })
            .collect();
        let mut nodal = x.clone();
        for load in &forces {
            (0..3).for_each(|c| nodal[3 * load.node + c] += load.force[c]);
        }
        let mut expected = vec![0.0; w.len()];
        ring.ring.to_harmonic(&nodal, &mut expected);
        ring.ring.add_loads(&forces, &mut w);
        assert_close(&w, &expected, 1e-13);
    }
}

/// Wrong: a vector on the raceway alone would get other harmonics than as part of the whole field, or nodes read back
/// from a field would be others; nodes left out must keep their values.
#[test]
fn part_of_a_section_is_transformed_as_in_the_whole() {
    for (ring, _) in rings() {
        let part = ring.ring.section_part(&[2, 5], [7, 3]);
        let sites = ring.periodicity.sites();
        let chosen = [2, 5, sites[7].section_node, sites[3].section_node];
        let is_inside = |node: usize| chosen.contains(&sites[node].section_node);
        let x = loads(ring.mesh.n_dofs());
        let alone: Vec<f64> = (0..x.len())
            .map(|i| if is_inside(i / 3) { x[i] } else { 0.0 })
            .collect();
        let mut expected = vec![0.0; ring.ring.harmonic_len()];
        let mut found = vec![f64::NAN; expected.len()];
        ring.ring.to_harmonic(&alone, &mut expected);
        ring.ring.to_harmonic_from(&part, &x, &mut found);
        assert_eq!(found, expected);

        ring.ring.to_harmonic(&x, &mut found);
        let mut nodal = vec![7.0; x.len()];
        ring.ring.from_harmonic_at(&part, &found, &mut nodal);
        let expected: Vec<f64> = (0..x.len())
            .map(|i| if is_inside(i / 3) { x[i] } else { 7.0 })
            .collect();
        assert_close(&nodal, &expected, 1e-14);

        let rows: Vec<usize> = (0..x.len()).filter(|i| is_inside(i / 3)).collect();
        let field = ring.ring.field_at(&part, &found);
        let values: Vec<f64> = rows.iter().map(|&row| field.value(row)).collect();
        let expected: Vec<f64> = rows.iter().map(|&row| x[row]).collect();
        assert_close(&values, &expected, 1e-14);
        let mut loads = ring.ring.no_loads(&part);
        // In two parts each: the second adds to the first.
        for &row in rows.iter().chain(&rows) {
            loads.add(row, 0.5 * x[row]);
        }
        let mut whole = vec![0.0; found.len()];
        ring.ring.to_harmonic(&alone, &mut whole);
        found.fill(0.0);
        loads.write_harmonics(&mut found);
        assert_close(&found, &whole, 1e-13);
    }
}

/// Wrong: the state of a moving ring, which stays in harmonic space, would meet another matrix there than the
/// assembled one with the rows of its shaft; or what turns with a frame would turn the wrong way.
#[test]
fn bordered_products_and_turned_fields_are_those_of_nodal_vectors() {
    for (ring, _) in rings() {
        let (n, len) = (ring.mesh.n_dofs(), ring.ring.harmonic_len());
        let x = loads(n + 3);
        let rigid = |[_, y, z]: [f64; 3]| [[1.0, 0.0, 0.0], [0.0, -z, y], [0.0, 0.0, 1.0]];
        let nodes = &ring.mesh.nodes;
        let border: Vec<f64> = (0..3)
            .flat_map(|k| nodes.iter().flat_map(move |&node| rigid(node)[k]))
            .collect();
        let corner = [4.0, 1.0, 0.5, 1.0, 3.0, -0.7, 0.5, -0.7, 2.0];
        let mut expected = crate::common::product(&ring.assembled(SHIFT), &x[..n]);
        for (column, q) in border.chunks_exact(n).zip(&x[n..]) {
            expected.iter_mut().zip(column).for_each(|(y, b)| *y += b * q);
        }
        for (row, column) in corner.chunks_exact(3).zip(border.chunks_exact(n)) {
            let free: f64 = column.iter().zip(&x).map(|(b, x)| b * x).sum();
            let own: f64 = row.iter().zip(&x[n..]).map(|(d, q)| d * q).sum();
            expected.push(free + own);
        }
        let operator = HarmonicOperator::new(&ring.ring, &ring.shifted(), &border, &corner).unwrap();
        let (mut w, low) = (vec![0.0; len], ring.ring.low_len());
        ring.ring.to_harmonic(&x[..n], &mut w);
        let (mut product, mut rows) = (vec![0.0; len], Vec::new());
        for (group, (x_of, y_of)) in w.chunks_exact(low).zip(product.chunks_exact_mut(low)).enumerate() {
            let q = if group == 0 { &x[n..] } else { &[] };
            let mut y = vec![0.0; low + q.len()];
            operator.group_product(group, &[x_of, q].concat(), &mut y);
            y_of.copy_from_slice(&y[..low]);
            rows.extend_from_slice(&y[low..]);
        }
        let mut found = vec![0.0; n];
        ring.ring.from_harmonic(&product, &mut found);
        found.extend_from_slice(&rows);
        assert_close(&found, &expected, 1e-13);

        let nodes = w.as_chunks::<NODE_LEN>().0.iter();
        let field: Vec<f64> = nodes
            .flat_map(|w| turned(&w.map(|w| 0.7 * w), &w.map(|w| -0.4 * w)))
            .collect();
        let mut found = vec![0.0; n];
        ring.ring.from_harmonic(&field, &mut found);
        let fields = x[..n].chunks_exact(3);
        let expected = fields.flat_map(|u| [0.7 * u[0] + 0.4 * u[1], 0.7 * u[1] - 0.4 * u[0], 0.0]);
        assert_close(&found, &expected.collect::<Vec<f64>>(), 1e-13);
    }
}
