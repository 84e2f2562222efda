//! Mean strain at points of facets.

use fem::Material;
use fem::stress::{GaugePoint, MeshPoint, PointRecovery, StrainGauge, StressRecovery, strain};
use mesh::{ElementKind, Facet, Mesh};

use crate::support::grids::wavy_cube;
use crate::support::{assert_close, nodal_field};

const DIRECTION: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];

/// A gauge over some points of every facet of a mesh's first group.
fn gauge(mesh: &Mesh, material: &Material) -> StrainGauge {
    let facets: &[Facet] = mesh.groups.values().next().unwrap();
    let on = |facet: &Facet| {
        [[0.2, 0.3], [0.1, 0.6], [0.4, 0.1]].map(|xi| GaugePoint {
            place: MeshPoint::on_facet(mesh, *facet, xi),
            direction: DIRECTION,
        })
    };
    let points: Vec<GaugePoint> = facets.iter().flat_map(on).collect();
    StrainGauge::new(mesh, material, &points)
}

fn along(e: [f64; 6]) -> f64 {
    let [x, y, z] = DIRECTION;
    e[0] * x * x + e[1] * y * y + e[2] * z * z + e[3] * x * y + e[4] * y * z + e[5] * x * z
}

/// Wrong: a gauge would not show the strain that is there: any linear displacement has the same strain everywhere, on
/// distorted elements of all kinds; that of a rigid motion, a small turn included, is zero.
#[test]
fn a_gauge_shows_the_strain_of_a_linear_displacement_and_none_of_a_rigid_one() {
    let material = Material::new(2.1e11, 0.3, 7800.0).unwrap();
    let gradient = [
        [1.0e-3, -2.0e-3, 0.5e-3],
        [0.7e-3, 3.0e-3, -1.1e-3],
        [0.2e-3, 0.9e-3, -0.4e-3],
    ];
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 3);
        let gauge = gauge(&mesh, &material);
        let linear = nodal_field(&mesh, |x| {
            gradient.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + 0.3)
        });
        assert_close(gauge.strain(&linear), along(strain(gradient)), 1e-12, kind.name());
        let rigid = nodal_field(&mesh, |[x, y, z]| {
            [0.1 - 0.2 * y + 0.5 * z, 0.2 * x - 0.3 * z, -0.5 * x + 0.3 * y]
        });
        assert!(gauge.strain(&rigid).abs() < 1e-13, "{}", gauge.strain(&rigid));
    }
}

/// Wrong: strain and stress of one ring would not belong together. A gauge at an integration point shows what Hooke's
/// law makes of the stress there, of any displacement, incompatible modes included.
#[test]
fn strain_at_an_integration_point_is_that_of_its_stress_by_hooke() {
    let material = Material::new(2.1e11, 0.3, 7800.0).unwrap();
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 2);
        let u = nodal_field(&mesh, |[x, y, z]| {
            [x * y + 0.2 * z * z, y * z - x * x, 0.3 * x * z + y * y]
        });
        let stress = StressRecovery::new(&mesh, &material)
            .unwrap()
            .integration_points(&u);
        let rule = fem::quadrature::stiffness_rule(kind);
        for (e, q) in [(0, 0), (mesh.n_elements() - 1, rule.points.len() - 1)] {
            let point = GaugePoint {
                place: MeshPoint {
                    element: e,
                    xi: rule.points[q],
                },
                direction: DIRECTION,
            };
            let gauge = StrainGauge::new(&mesh, &material, &[point]);
            // The same stress everywhere shows the strain of the point.
            let everywhere = vec![stress[rule.points.len() * e + q]; mesh.n_nodes()];
            assert_close(
                gauge.strain(&u),
                gauge.strain_of_stress(&everywhere),
                1e-11,
                kind.name(),
            );
        }
    }
}

/// Wrong: points of facets would lie elsewhere: the point of a facet has the position of the facet there.
#[test]
fn a_point_of_a_facet_lies_where_the_facet_does() {
    let material = Material::new(1.0, 0.3, 1.0).unwrap();
    for kind in ElementKind::ALL {
        let mesh = wavy_cube(kind, 2);
        let facet = mesh.groups.values().next().unwrap()[1];
        let nodes: Vec<[f64; 3]> = mesh.facet_nodes(facet).map(|n| mesh.nodes[n]).collect();
        let xi = [0.25, 0.5];
        let (position, _) = fem::facet::point_and_area(kind.facet_kind(), &nodes, xi);
        let place = MeshPoint::on_facet(&mesh, facet, xi);
        let shape = fem::element::shape(kind, place.xi);
        for i in 0..3 {
            let own = mesh.element(place.element).iter().zip(shape);
            let found: f64 = own.map(|(&n, value)| value * mesh.nodes[n][i]).sum();
            assert_close(found, position[i], 1e-14, kind.name());
        }
        assert!(PointRecovery::new(&mesh, &material, &[position]).is_ok());
    }
}
