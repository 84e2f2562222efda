//! One flexible ring: its hold, its patches, its compliance.

use std::collections::BTreeMap;

use crate::support::rings::{Level, ring, ring_model};
use crate::support::{Case, LEAST_PATCH};
use contact::patch_shape::PatchShape;
use contact::quadrature::PressureRule;
use contact::{Patch, RacewaySurface, SemiAxes, Side};
use dynamics::model::elastic;
use dynamics::statics::StaticRing;
use dynamics::{Backend, ContactMode, Hold, RingModel, Sectors, SharedStress, StressPlaces};
use fem::StressRecovery;
use mesh::{ElementKind, Mesh};
use ring::division::body_load;

const LEVEL: Level = Level::hex8(54, 6, 1, 2);

fn patch(ring: &RingModel, azimuth: f64, angle: f64) -> Patch {
    let surface = RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
    let shape = PatchShape::new(&surface, azimuth, angle, SemiAxes::new(1e-3, 1e-4), LEAST_PATCH).unwrap();
    Patch::new(
        &surface,
        &ring.mesh.nodes,
        &PressureRule::new(),
        shape,
        elastic(&ring.material),
    )
    .unwrap()
}

/// Displacement of a rigid motion t + phi x X, `[n_nodes][3]` flat.
fn rigid(nodes: &[[f64; 3]], t: [f64; 3], phi: [f64; 3]) -> Vec<f64> {
    nodes.iter().flat_map(|x| rigid_at(*x, t, phi)).collect()
}

fn rigid_at(x: [f64; 3], t: [f64; 3], phi: [f64; 3]) -> [f64; 3] {
    [
        t[0] + phi[1] * x[2] - phi[2] * x[1],
        t[1] + phi[2] * x[0] - phi[0] * x[2],
        t[2] + phi[0] * x[1] - phi[1] * x[0],
    ]
}

/// Wrong: a rigid motion of a ring would change contact angles. The groove centre measured through a patch follows any
/// rigid motion exactly, on every kind of element, anywhere on the groove.
#[test]
fn patches_follow_rigid_motions_exactly() {
    let (t, phi) = ([3e-6, -2e-6, 5e-6], [1e-4, -2e-4, 3e-4]);
    for side in Side::BOTH {
        for level in [LEVEL, Level::hex20(54, 4, 1, 1)] {
            let ring = ring(side, level, Hold::Clamped);
            for (azimuth, angle) in [(0.3f64, 0.35), (2.0, -0.2), (-3.1, 0.0)] {
                let measured = patch(&ring, azimuth, angle)
                    .weights
                    .measure(&rigid(&ring.mesh.nodes, t, phi));
                let u = rigid_at(ring.groove.centre(azimuth), t, phi);
                let expected = [u[0] * azimuth.cos() + u[1] * azimuth.sin(), u[2]];
                for i in 0..2 {
                    assert!(
                        (measured[i] - expected[i]).abs() < 1e-17,
                        "{measured:?} {expected:?}"
                    );
                }
            }
        }
    }
}

/// A ring whose facets are no parallelograms: nodes turned about the axis by up to a tenth of a sector.
fn uneven(mut ring: RingModel) -> RingModel {
    for x in &mut ring.mesh.nodes.iter_mut() {
        let [radius, azimuth] = [x[0].hypot(x[1]), x[1].atan2(x[0])];
        let turned = azimuth + 2e-3 * (40.0 * x[2] / radius).sin() * (9.0 * azimuth).cos();
        (x[0], x[1]) = (radius * turned.cos(), radius * turned.sin());
    }
    ring
}

/// Wrong: the slope that a free ball meets would not be that of the ring's surface under it: of a rigid motion, and of
/// any field by differences of patches a little ahead and behind, on affine and on uneven facets.
#[test]
fn slopes_are_the_growth_of_the_patches_motion_with_the_azimuth() {
    let (t, phi) = ([3e-6, -2e-6, 5e-6], [1e-4, -2e-4, 3e-4]);
    let quadratic = Level::hex20(54, 4, 1, 1);
    for side in Side::BOTH {
        let rings = [
            ring(side, LEVEL, Hold::Clamped),
            ring(side, quadratic, Hold::Clamped),
            uneven(ring(side, LEVEL, Hold::Clamped)),
            uneven(ring(side, quadratic, Hold::Clamped)),
        ];
        for ring in rings {
            let surface = RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
            let (nodes, rule, steel) = (&ring.mesh.nodes, PressureRule::new(), elastic(&ring.material));
            for (azimuth, angle) in [(0.3f64, 0.35), (2.0, -0.2), (-3.1, 0.0)] {
                let shape = PatchShape::new(&surface, azimuth, angle, SemiAxes::new(1e-3, 1e-4), LEAST_PATCH)
                    .unwrap();
                let free = |shape| Patch::of_free_ball(&surface, nodes, &rule, shape, steel).unwrap();
                let (patch, [traction, slope]) = free(shape);
                assert_eq!(
                    patch.weights,
                    Patch::new(&surface, nodes, &rule, shape, steel).unwrap().weights
                );
                let total: f64 = traction.coefficients.iter().map(|c| c[0][1]).sum();
                assert!((total - azimuth.cos()).abs() < 1e-12, "{total}");

                let found = slope.measure(&rigid(nodes, t, phi));
                let (centre, (sin, cos)) = (ring.groove.centre(azimuth), azimuth.sin_cos());
                let (u, along) = (rigid_at(centre, t, phi), [-centre[1], centre[0], 0.0]);
                let grown = rigid_at(along, [0.0; 3], phi);
                let expected = [
                    u[1] * cos - u[0] * sin + grown[0] * cos + grown[1] * sin,
                    grown[2],
                ];
                for i in 0..2 {
                    assert!((found[i] - expected[i]).abs() < 1e-16, "{found:?} {expected:?}");
                }

                let field: Vec<f64> = (0..ring.mesh.n_dofs())
                    .map(|i| ((37 * i) % 101) as f64 / 101.0)
                    .collect();
                let h = 1e-7;
                let [ahead, behind] = [h, -h].map(|h| {
                    let azimuth = azimuth + h;
                    free(PatchShape { azimuth, ..shape }).0.weights.measure(&field)
                });
                let found = slope.measure(&field);
                for i in 0..2 {
                    let expected = (ahead[i] - behind[i]) / (2.0 * h);
                    assert!(
                        (found[i] - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                        "{found:?} {expected}"
                    );
                }
            }
        }
    }
}

/// Wrong: the loads of a patch would not have the resultant of the contact force at the groove centre: force and
/// moment on the shaft would not be those of the balls. Conjugate to the statement before; 1e-12 of the force.
#[test]
fn patch_loads_have_the_resultant_of_the_contact_force() {
    let ring = ring(Side::Inner, LEVEL, Hold::Clamped);
    let (azimuth, force) = (0.7f64, [-300.0, -110.0]);
    let mut load = vec![0.0; ring.mesh.n_dofs()];
    patch(&ring, azimuth, 0.34).weights.add_load(force, &mut load);
    let mut sum = [0.0; 6];
    for (x, f) in ring.mesh.nodes.iter().zip(load.chunks_exact(3)) {
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            sum[i] += f[i];
            sum[3 + i] += x[j] * f[k] - x[k] * f[j];
        }
    }
    let (x, f) = (
        ring.groove.centre(azimuth),
        [force[0] * azimuth.cos(), force[0] * azimuth.sin(), force[1]],
    );
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        assert!((sum[i] - f[i]).abs() < 1e-10, "{sum:?}");
        assert!(
            (sum[3 + i] - (x[j] * f[k] - x[k] * f[j])).abs() < 1e-11,
            "{sum:?}"
        );
    }
}

/// Wrong: a mean-motion hold would restrain more than the mean motion of the bore, or less. Off the bore the ring's
/// own forces balance the loads; on it the mean displacement and the mean rotation vanish.
#[test]
fn a_mean_motion_hold_holds_the_mean_motion_only() {
    let model = Case::axial(0.0).flexible(ContactMode::Patch, LEVEL, Hold::MeanMotion);
    let ring = model.ring(Side::Inner).unwrap();
    let solver = StaticRing::new(&model, Side::Inner, ring).unwrap().solver;
    let mut load = vec![0.0; ring.mesh.n_dofs()];
    patch(ring, 0.4, 0.3)
        .weights
        .add_load([-500.0, -200.0], &mut load);
    let u = solver.solve(load.clone(), 1);
    let stiffness = fem::assemble_stiffness(&ring.mesh, &ring.material).unwrap();
    let held = ring.mesh.group_nodes("bore");
    for (dof, row) in stiffness.outer_iterator().enumerate() {
        let force: f64 = row.iter().map(|(j, k)| k * u[j]).sum();
        let on_bore = held.binary_search(&(dof / 3)).is_ok();
        assert!(
            on_bore || (force - load[dof]).abs() < 1e-8,
            "dof {dof}: {force} {}",
            load[dof]
        );
    }
    let weights = fem::facet_node_weights(&ring.mesh, ring.mesh.group("bore"));
    let area: f64 = weights.iter().map(|w| w.1).sum();
    let (mut mean, mut turn) = ([0.0; 3], [0.0; 3]);
    let mut largest = 0.0f64;
    for &(node, w) in &weights {
        let x = ring.mesh.nodes[node];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            mean[i] += w / area * u[3 * node + i];
            turn[i] += w / area * (x[j] * u[3 * node + k] - x[k] * u[3 * node + j]) / 25e-3;
            largest = largest.max(u[3 * node + i].abs());
        }
    }
    assert!(largest > 1e-7, "the bore deforms: {largest}");
    assert!(
        mean.iter().chain(&turn).all(|m| m.abs() < 1e-10 * largest),
        "{mean:?} {turn:?}"
    );
}

/// Wrong: a point held clamped would move, or the clamped compliance would exceed the softer mean-motion one.
#[test]
fn a_clamped_bore_does_not_move_and_is_stiffer() {
    let mut compliance = Vec::new();
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let model = Case::axial(0.0).flexible(ContactMode::Patch, LEVEL, hold);
        let ring = model.ring(Side::Inner).unwrap();
        let solver = StaticRing::new(&model, Side::Inner, ring).unwrap().solver;
        let foot = patch(ring, 0.4, 0.3).weights;
        let mut load = vec![0.0; ring.mesh.n_dofs()];
        foot.add_load([1.0, 0.0], &mut load);
        let u = solver.solve(load, 1);
        compliance.push(foot.measure(&u)[0]);
        if hold == Hold::Clamped {
            assert!(
                ring.mesh
                    .group_nodes("bore")
                    .iter()
                    .all(|n| u[3 * n..3 * n + 3] == [0.0; 3])
            );
        }
        let matrix = solver.compliance(&[foot]);
        assert!((matrix[0] / compliance[compliance.len() - 1] - 1.0).abs() < 1e-10);
    }
    assert!(compliance[1] > 2.0 * compliance[0], "{compliance:?}");
}

/// Wrong: a hole in the raceway or a ball beyond the groove would not be noticed.
#[test]
fn places_off_the_raceway_are_errors() {
    let ring = ring(Side::Inner, LEVEL, Hold::Clamped);
    let surface = RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
    let error = PatchShape::new(&surface, 0.1, 1.5, SemiAxes::new(1e-3, 1e-4), LEAST_PATCH)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("no facet of the inner raceway holds azimuth 5.7296 deg"),
        "{error}"
    );
    let facets = &ring.mesh.group("raceway")[12..];
    let open = RacewaySurface::new(&ring.mesh, facets, ring.groove);
    let missing = (0..360)
        .filter(|deg| open.locate((*deg as f64).to_radians(), 0.3).is_err())
        .count();
    assert!(
        (5..=20).contains(&missing),
        "two of 54 sectors are missing: {missing} degrees"
    );
    // Edge contact: the Hertz ellipse does not fit between the contact and the rim.
    assert!(
        PatchShape::new(&surface, 0.1, 0.9, SemiAxes::new(3e-3, 1e-4), LEAST_PATCH)
            .unwrap()
            .truncated
    );
    assert!(
        !PatchShape::new(&surface, 0.1, 0.3, SemiAxes::new(1e-3, 1e-4), LEAST_PATCH)
            .unwrap()
            .truncated
    );
}

/// Wrong: a ring in sectors would show other stress than the ring as a whole: on every kind of element, at nodes and
/// integration points, any number of sectors, an uneven mesh. At nodes sums of sectors differ by round-off; at
/// integration points every bit is the same.
#[test]
fn stress_by_sector_is_that_of_the_whole_ring() {
    let mut rings = vec![
        ring(Side::Outer, Level::hex8(24, 4, 1, 1), Hold::Clamped),
        ring(Side::Inner, Level::hex20(18, 2, 1, 1), Hold::Clamped),
    ];
    // Three nodes moved: not periodic.
    for node in [10, 40, 77] {
        rings[0].mesh.nodes[node].iter_mut().for_each(|x| *x *= 1.004);
    }
    rings.push(tetrahedra(&rings[0]));
    for ring in rings {
        let u: Vec<f64> = (0..ring.mesh.n_dofs())
            .map(|i| 1e-6 * ((i * i) as f64 * 0.37).sin())
            .collect();
        let whole = StressRecovery::new(&ring.mesh, &ring.material).unwrap();
        let (nodal, points) = (whole.nodal(&u), whole.integration_points(&u));
        let largest = nodal.iter().flatten().fold(0.0f64, |m, s| m.max(s.abs()));
        for n_sectors in [1, 2, 5, 16] {
            let sectors = Sectors {
                n_sectors: Some(n_sectors),
                ..Sectors::default()
            };
            let shared = |places| SharedStress::new(&ring, "outer", sectors, places).unwrap();
            let stress = |shared: &SharedStress| shared.gather(shared.recover(&u)).unwrap();
            let by_sector = stress(&shared(StressPlaces::Nodes));
            assert_eq!(by_sector.len(), nodal.len());
            for (node, (a, b)) in by_sector.iter().zip(&nodal).enumerate() {
                for c in 0..6 {
                    assert!(
                        (a[c] - b[c]).abs() <= 1e-12 * largest,
                        "{n_sectors} sectors, node {node}: {a:?}, {b:?}"
                    );
                }
            }
            let at_points = shared(StressPlaces::IntegrationPoints);
            assert!(stress(&at_points) == points, "{n_sectors} sectors");
            assert_eq!(at_points.point_positions().unwrap(), whole.point_positions());
            assert_eq!(at_points.points_per_element(), whole.points_per_element());
        }
    }
}

/// Wrong: sectors would weigh a ring otherwise than the whole does, or a ring that was divided for one process would
/// not be what it was.
#[test]
fn loads_by_sector_are_those_of_the_whole_ring() {
    let sectors = Sectors {
        n_sectors: Some(5),
        ..Sectors::default()
    };
    let force = |x: [f64; 3]| [3e7 * x[0], 1e5 - 2e7 * x[1], 4e5];
    for level in [Level::hex8(24, 4, 1, 1), Level::hex20(18, 2, 1, 1)] {
        let whole = ring(Side::Inner, level, Hold::Clamped);
        let divided = ring(Side::Inner, level, Hold::Clamped)
            .divide("inner", sectors)
            .unwrap();
        assert!(divided.is_whole() && divided.mesh == whole.mesh);
        let expected = body_load(&whole, "inner", Backend::Sparse, force).unwrap();
        let largest = expected.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        for ring in [&whole, &divided] {
            let found = body_load(ring, "inner", Backend::Sector(sectors), force).unwrap();
            for (a, b) in found.iter().zip(&expected) {
                assert!((a - b).abs() <= 1e-13 * largest, "{a} {b}");
            }
        }
    }
}

/// Wrong: a rank would hold the whole mesh, or not have what it needs of its sectors and of the surfaces that
/// contacts and partner touch.
#[test]
fn a_rank_keeps_its_part_of_the_mesh_and_knows_no_other() {
    let sectors = Sectors {
        n_sectors: Some(8),
        ..Sectors::default()
    };
    for level in [Level::hex8(48, 6, 2, 3), Level::hex20(24, 4, 1, 2)] {
        let whole = || ring(Side::Outer, level, Hold::MeanMotion);
        let (ring, backend) = (whole(), Backend::Sector(sectors));
        let cut = ring.sector_cut("outer", sectors).unwrap();
        for rank in 0..4 {
            let probed = ring.mesh.n_nodes() / 2 + 7;
            let part = whole().kept_by(&cut, [rank, 4], &[probed]);
            assert!(!part.is_whole());
            assert_eq!(
                (part.mesh.n_dofs(), part.n_elements()),
                (ring.mesh.n_dofs(), ring.mesh.n_elements())
            );
            let [n_nodes, n_kept] = [ring.mesh.n_nodes(), part.mesh.nodes.n_kept()];
            let surface = ring.surface_nodes().len();
            assert!(
                n_kept < n_nodes && n_kept < n_nodes / 3 + surface,
                "{n_kept} of {n_nodes}, {surface}"
            );
            assert!(part.mesh.n_elements() < ring.mesh.n_elements());
            assert!(part.mesh.nodes.kept().all(|(node, x)| x == ring.mesh.nodes[node]));
            assert_eq!(part.mesh.nodes[probed], ring.mesh.nodes[probed]);
            // Own sectors are what they are in the whole ring.
            let own = part.sector_cut("outer", sectors).unwrap();
            for s in 2 * rank..2 * rank + 2 {
                let nodes: Vec<usize> = cut.nodes[s].iter().map(|&node| node as usize).collect();
                assert!(
                    part.mesh.part(&own.elements[s], &nodes) == ring.mesh.part(&cut.elements[s], &nodes),
                    "rank {rank}, sector {s}"
                );
            }
            let other = (2 * rank + 4) % 8;
            assert!(own.elements[other].is_empty() && own.nodes == cut.nodes);
            // The surfaces are where they were.
            for group in ["raceway", "seat"] {
                assert_eq!(part.mesh.group_nodes(group), ring.mesh.group_nodes(group));
                let weights = |ring: &RingModel| fem::facet_node_weights(&ring.mesh, ring.mesh.group(group));
                assert!(weights(&part) == weights(&ring), "{group}");
            }
            let missing = cut.nodes[other].iter().map(|&node| node as usize);
            let is_kept = |node: usize| part.mesh.nodes.kept().any(|(kept, _)| kept == node);
            let missing = missing.into_iter().find(|&node| !is_kept(node)).unwrap();
            let asked = std::panic::catch_unwind(|| part.mesh.nodes[missing]);
            assert!(asked.is_err(), "rank {rank} knows node {missing}");
            let all = std::panic::catch_unwind(|| part.mesh.nodes.to_vec());
            assert!(all.is_err(), "rank {rank} knows all nodes");
        }
        // Fields and sums over a ring in sectors are those over the whole.
        let places = ring.places("outer", backend).unwrap();
        let plain = ring.places("outer", Backend::Sparse).unwrap();
        let square = |x: [f64; 3]| x.map(|x| x * x);
        assert!(places.field(square) == plain.field(square));
        let [a, b] = [places, plain].map(|places| places.sum(|node, x| [node as f64, square(x)[1]]));
        assert_eq!(a[0], b[0]);
        assert!((a[1] - b[1]).abs() <= 1e-13 * b[1], "{a:?}, {b:?}");
    }
}

/// The ring of hex8 with each element cut into six tet10, the mid-nodes on straight edges.
fn tetrahedra(ring: &RingModel) -> RingModel {
    // Around the diagonal from corner 0 to corner 6.
    const CUTS: [[usize; 4]; 6] = [
        [0, 1, 2, 6],
        [0, 2, 3, 6],
        [0, 3, 7, 6],
        [0, 7, 4, 6],
        [0, 4, 5, 6],
        [0, 5, 1, 6],
    ];
    let edges = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    let (mut nodes, mut connectivity) = (ring.mesh.nodes.to_vec(), Vec::new());
    let mut middles = BTreeMap::new();
    for hexahedron in ring.mesh.connectivity.chunks_exact(8) {
        for corners in CUTS.map(|cut| cut.map(|i| hexahedron[i])) {
            connectivity.extend(corners);
            connectivity.extend(edges.map(|edge| {
                let [a, b] = edge.map(|i| corners[i]);
                *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                    nodes.push([0, 1, 2].map(|i| 0.5 * (nodes[a][i] + nodes[b][i])));
                    nodes.len() - 1
                })
            }));
        }
    }
    let mesh = Mesh {
        kind: ElementKind::Tet10,
        nodes: nodes.into(),
        connectivity,
        groups: BTreeMap::new(),
    };
    ring_model(Side::Outer, mesh, Hold::Free)
}
