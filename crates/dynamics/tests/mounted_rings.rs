//! Flexible rings on their seats, against closed forms and by other ways.

use crate::support::mounting::{
    ALPHA, I, at, fit, fitted, flexible, message, mount, mounted_model, unmounted,
};
use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative, steel};
use ::ring::statics::{RingSolver, StaticSettings};
use ::ring::{Partner, SeatAction};
use contact::{BearingGeometry, Side};
use dynamics::mounting::{Conditions, Mounting, SeatForm};
use dynamics::{Backend, ContactMode, Hold, Model, NodalStress, Sectors};

/// Wrong: finite elements would grow more than the tube to the groove bottom, or less than that to the shoulder, of
/// which the section lies between; or a pressed seat otherwise than a moved one.
#[test]
fn the_groove_of_a_flexible_ring_grows_between_the_tubes() {
    let mut growths = Vec::new();
    for hold in [Hold::Clamped, Hold::MeanMotion] {
        let report = mount(&flexible(hold), &fitted()).report.unwrap();
        let [inner, outer] = report.seats.map(Option::unwrap);
        let growth = 2e6 * inner.groove_growth;
        assert!((8.278..8.927).contains(&growth), "{hold:?}: {growth} um");
        let shrinkage = -2e6 * outer.groove_growth;
        assert!((7.88..8.83).contains(&shrinkage), "{hold:?}: {shrinkage} um");
        assert!(
            (4.20e6..6.51e6).contains(&inner.pressure),
            "{hold:?}: {} Pa",
            inner.pressure
        );
        growths.push((growth, inner.pressure));
    }
    // A clamped seat holds the ring along the axis, so that it cannot contract there as it grows.
    let [(a, p), (b, q)] = [growths[0], growths[1]];
    assert!(
        (0.3..0.4).contains(&(b - a)) && relative(p, q) < 0.04,
        "{growths:?}"
    );
}

/// Wrong: the stress of a fit would be missing, or of another sign. Hoop stress at the bore of tubes to groove bottom
/// and shoulder is 37.2 and 34.9 MPa; the mean over the real bore lies near.
#[test]
fn a_fit_stretches_the_bore() {
    let rings = flexible(Hold::MeanMotion);
    let mounting = mount(&rings, &fitted());
    let ring = rings[0].as_deref().unwrap();
    let field = mounting.rings[0].field.clone().unwrap();
    let stress = NodalStress::new(ring, "inner", Backend::Auto)
        .unwrap()
        .nodal(&field);
    let hoop = |node: usize| {
        let [x, y, _] = ring.mesh.nodes[node];
        let (r, s) = (x.hypot(y), stress[node]);
        let [c, s_] = [x / r, y / r];
        s_ * s_ * s[0] + c * c * s[1] - 2.0 * c * s_ * s[3]
    };
    let nodes = ring.mesh.group_nodes("bore");
    let mean = nodes.iter().map(|&n| hoop(n)).sum::<f64>() / nodes.len() as f64;
    assert!((33e6..39e6).contains(&mean), "{mean}");
}

/// Wrong: the speed at which a flexible ring lets go would not be that at which its pressure vanishes: by Betti's
/// theorem here, by the reaction of the turning ring there.
#[test]
fn a_flexible_ring_lets_go_where_its_seat_has_no_reaction() {
    let rings = flexible(Hold::Clamped);
    let conditions = Conditions {
        fits: [fit(I, 0.0), None],
        ..Conditions::default()
    };
    let mounting = mount(&rings, &conditions);
    let seat = mounting.report.unwrap().seats[0].unwrap();
    let limit = seat.loosening_speed.unwrap();
    assert!(
        (2300.0..2864.0).contains(&limit),
        "{limit} rad/s: the shoulders pull more"
    );
    let ring = rings[0].as_deref().unwrap();
    let settings = StaticSettings {
        name: "inner",
        partner: Partner::AT_REST,
        backend: Backend::Auto,
        n_contacts: 18,
    };
    let solver = RingSolver::new(ring, settings).unwrap();
    let load = fem::centrifugal_load(&ring.mesh, 7800.0, limit).unwrap();
    let turned = solver.solve(load.clone(), 1);
    // At that speed the shaft has grown by its own turning and carries nothing: its seat stands at I/2 + growth.
    let shaft = 7800.0 * limit * limit * 0.7 * 25e-3f64.powi(3) / (4.0 * 207e9);
    let unit = ring.seat_fields(settings, &[SeatAction::Radial]).unwrap();
    let moved: Vec<f64> = unit[0]
        .displacement
        .iter()
        .map(|w| (0.5 * I + shaft) * w)
        .collect();
    let sum: Vec<f64> = turned.iter().zip(&moved).map(|(a, b)| a + b).collect();
    let forces = fem::stiffness_product(&ring.mesh, &steel(), &sum).unwrap();
    let outwards = |forces: &[f64], load: &[f64]| -> f64 {
        let of_node = |&node: &usize| {
            let [x, y, _] = ring.mesh.nodes[node];
            let f = [0, 1].map(|c| forces[3 * node + c] - load[3 * node + c]);
            (x * f[0] + y * f[1]) / x.hypot(y)
        };
        ring.mesh.group_nodes("bore").iter().map(of_node).sum()
    };
    let at_rest = fem::stiffness_product(&ring.mesh, &steel(), &moved).unwrap();
    let zero = vec![0.0; load.len()];
    let (left, whole) = (outwards(&forces, &load), outwards(&at_rest, &zero));
    assert!(left.abs() < 1e-9 * whole, "{left} N of {whole} N");
}

/// Wrong: a flexible ring on a shaft would meet its balls elsewhere than a bearing with that groove.
#[test]
fn contacts_of_a_fitted_flexible_ring_are_those_of_its_grown_groove() {
    let case = Case::axial(2000.0);
    let level = Level::hex8(36, 6, 2, 3);
    let conditions = Conditions {
        fits: [fit(I, 0.0), None],
        ..Conditions::default()
    };
    let model = mounted_model(
        case.flexible(ContactMode::Patch, level, Hold::Clamped),
        &conditions,
    );
    let growth = model.mounting.rings[0].groove.radial;
    let mut grown = case.flexible(ContactMode::Patch, level, Hold::Clamped);
    grown.geometry.inner_raceway_diameter += 2.0 * growth;
    let plain = case.flexible(ContactMode::Patch, level, Hold::Clamped);
    let angle = |model: &Model| equilibrium(model).balls[0].inner.contact_angle_rad.to_degrees();
    let [fitted, grown, plain] = [&model, &grown, &plain].map(angle);
    assert!(plain - fitted > 1.0, "{plain} {fitted}");
    assert!(
        (fitted - grown).abs() < 0.02 * (plain - fitted),
        "{fitted} {grown} {plain}"
    );
}

/// Wrong: a clamped seat would not follow its warm shaft along the axis too, or be stressed without cause.
#[test]
fn a_clamped_seat_follows_the_strain_of_its_partner() {
    let rings = flexible(Hold::Clamped);
    let mounting = mount(&rings, &at(20.0, 20.0, 20.0, [30.0, 20.0]));
    let (ring, field) = (
        rings[0].as_deref().unwrap(),
        mounting.rings[0].field.clone().unwrap(),
    );
    let e = 10.0 * ALPHA;
    for node in ring.mesh.group_nodes("bore") {
        let x = ring.mesh.nodes[node];
        for (c, x) in x.into_iter().enumerate() {
            assert!((field[3 * node + c] - e * x).abs() < 1e-12 * 25e-3, "node {node}");
        }
    }
    assert!(mounting.rings[1].field.is_none());
    // A shaft that is colder pulls: nobody said how tight the ring sits.
    let cold = mount(&rings, &at(30.0, 20.0, 20.0, [20.0, 20.0])).report.unwrap();
    let said = &cold.warnings[0];
    assert!(
        said.starts_with("temperature pulls the clamped seat of the inner ring with "),
        "{said}"
    );
    assert!(
        said.contains("say how large it is by [effects.fit.inner]"),
        "{said}"
    );
}

/// Wrong: solvers would mount a ring otherwise.
#[test]
fn every_solver_finds_the_same_field() {
    let geometry = BearingGeometry::reference_7010c();
    let field = |backend: Backend| {
        let rings = flexible(Hold::Clamped);
        let mut bearing = unmounted(&geometry, &rings);
        bearing.backend = backend;
        let mounting = Mounting::new(&bearing, &fitted()).unwrap();
        mounting.rings[1].field.clone().unwrap()
    };
    let cyclic = field(Backend::Cyclic);
    for backend in [
        Backend::Sparse,
        Backend::Sector(Sectors {
            n_sectors: Some(4),
            ..Sectors::default()
        }),
    ] {
        let other = field(backend);
        let largest = cyclic.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        let pairs = cyclic.iter().zip(other.iter());
        let worst = pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        assert!(worst < 1e-9 * largest, "{backend:?}: {worst} of {largest}");
    }
}

/// Wrong: a wave of the seat would not be that of the scene, or its mean would move the groove.
#[test]
fn a_seat_form_is_taken_over_by_a_clamped_ring() {
    let rings = flexible(Hold::Clamped);
    let form = SeatForm {
        side: Side::Inner,
        order: 3,
        amplitude: 1e-6,
        azimuth: 0.4,
    };
    let conditions = Conditions {
        fits: [fit(I, 0.0), None],
        seat_forms: vec![form],
        ..Conditions::default()
    };
    let with = mount(&rings, &conditions);
    let without = mount(
        &rings,
        &Conditions {
            seat_forms: Vec::new(),
            ..conditions.clone()
        },
    );
    let (ring, field) = (rings[0].as_deref().unwrap(), with.rings[0].field.clone().unwrap());
    let round = without.rings[0].field.clone().unwrap();
    assert_eq!(with.rings[0].groove, without.rings[0].groove);
    for node in ring.mesh.group_nodes("bore") {
        let [x, y, _] = ring.mesh.nodes[node];
        let (angle, r) = (y.atan2(x), x.hypot(y));
        let u = [0, 1].map(|c| field[3 * node + c] - round[3 * node + c]);
        let expected = 1e-6 * (3.0 * (angle - 0.4)).cos();
        assert!(((u[0] * x + u[1] * y) / r - expected).abs() < 1e-17);
    }
    let large = Conditions {
        seat_forms: vec![SeatForm {
            amplitude: 10e-6,
            ..form
        }],
        ..conditions
    };
    let said = message(&rings, &large);
    let start = "the waves of [[effects.seat_form]] lift the inner ring off ";
    assert!(
        said.starts_with(start) && said.contains("% of its seat"),
        "{said}"
    );
    let soft = Conditions {
        seat_forms: vec![form],
        ..Conditions::default()
    };
    let said = message(&flexible(Hold::MeanMotion), &soft);
    let start =
        "[[effects.seat_form]] gives the inner ring the form of its seat, which only a flexible ring with";
    assert!(said.starts_with(start), "{said}");
}

/// Wrong: a seat would take a wave of many orders for an oval, as 60 nodes have the same cosines of orders 58 and 2, or
/// a wave that its nodes hardly follow would be computed without a word.
#[test]
fn a_seat_form_that_the_nodes_of_the_seat_do_not_follow_is_refused() {
    let rings = flexible(Hold::Clamped);
    let of_order = |order| Conditions {
        seat_forms: vec![SeatForm {
            side: Side::Outer,
            order,
            amplitude: 1e-6,
            azimuth: 0.0,
        }],
        ..Conditions::default()
    };
    for order in [30, 58] {
        let said = message(&rings, &of_order(order));
        let start = format!("[[effects.seat_form]] of order {order} has ");
        assert!(said.starts_with(&start), "{said}");
        assert!(said.contains("expected more than 2, at most order 29"), "{said}");
    }
    let warnings = |order| mount(&rings, &of_order(order)).report.unwrap().warnings;
    assert!(warnings(10).is_empty());
    let said = warnings(15);
    assert!(
        said.len() == 1 && said[0].contains("has 4.0 nodes for each wave"),
        "{said:?}"
    );
}
