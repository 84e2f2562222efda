//! Where the raceway ends: edges, holes, ellipses and patches as large as the groove, and too few nodes.

use std::sync::Arc;

use contact::Side;
use dynamics::{Hold, Model};

use super::bearings::{Load, SMALL};
use super::record::Record;
use super::support::rings::{Level, ring_model};
use super::{HardCase, Pace};

use super::meshes::{difference, loaded, rings, solve};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    vec![
        case(
            "ball_on_the_edge",
            Pace::Fast,
            "the raceway group ends where the balls run",
            "raceway of the inner ring cut at 19.4 deg, 100 N to 20 kN",
            edge,
        ),
        case(
            "hole_in_the_raceway",
            Pace::Fast,
            "a facet is missing under a ball",
            "one facet of the raceway group removed",
            hole,
        ),
        case(
            "ellipse_larger_than_groove",
            Pace::Fast,
            "the Hertz ellipse reaches over both rims",
            "raceway cut to one element, 20 kN axial, mean contact angle in it",
            edge_contact,
        ),
        case(
            "edge_contact_in_motion",
            Pace::Fast,
            "a load jump brings the balls to the edge while the bearing moves",
            "raceway of the inner ring cut at 19.4 deg, axial 10 N to 1.5 kN in 10 us, rings flexible, dt 5 us, 0.5 ms",
            edge_in_motion,
        ),
        case(
            "patch_fills_the_groove",
            Pace::Fast,
            "patches as wide as the groove and 5 elements long on both sides",
            "patch_elements = 20 against 2, 2 kN axial",
            patch,
        ),
        case(
            "too_few_nodes",
            Pace::Fast,
            "more balls than the mesh can tell apart",
            "6 elements round, 18 balls",
            too_few,
        ),
    ]
}

/// The inner ring with those facets of its raceway that `keep` by [low, high] groove angle, deg.
fn cut_raceway(keep: impl Fn([f64; 2]) -> bool) -> Model {
    let mut rings = rings(SMALL);
    let ring = &mut rings[0];
    let angle = |n: usize| ring.groove.coordinates(ring.mesh.nodes[n])[1].to_degrees();
    let range = |f: mesh::Facet| {
        let angles = ring.mesh.facet_nodes(f).map(angle);
        angles.fold([f64::INFINITY, f64::NEG_INFINITY], |r, a| {
            [r[0].min(a), r[1].max(a)]
        })
    };
    let kept: Vec<mesh::Facet> = ring
        .mesh
        .group("raceway")
        .iter()
        .copied()
        .filter(|f| keep(range(*f)))
        .collect();
    ring.mesh.groups.insert("raceway".to_string(), kept);
    let mut model = loaded(rings);
    super::bearings::set_loads(&mut model, Load::dead(2e3), Load::dead(0.0));
    model
}

fn edge(record: &mut Record) {
    let mut model = cut_raceway(|[_, high]| high < 20.0);
    let mut said = [0; 2];
    for force in [100.0, 1e3, 1.5e3, 1.9e3, 2e3, 5e3, 20e3] {
        super::bearings::set_loads(&mut model, Load::dead(force), Load::dead(0.0));
        match solve(&model) {
            Ok(solution) => {
                let angle = solution.balls[0].inner.contact_angle_rad.to_degrees();
                let warned = solution
                    .warnings
                    .iter()
                    .any(|w| w.contains("edge contact on the inner raceway"));
                record.note(format!(
                    "{force} N: {angle:.2} deg, {}",
                    if warned {
                        "edge contact is said"
                    } else {
                        "no warning"
                    }
                ));
                said[0] += usize::from(warned);
                record.that(
                    &format!("{force} N: a ball near the edge warns"),
                    warned || angle < 18.0,
                );
            }
            Err(error) => {
                record.says(&error.to_string(), "leaves the inner raceway: contact angle");
                said[1] += 1;
            }
        }
    }
    record.that(
        "both happen: edge contact is said, and balls beyond the edge are refused",
        said.iter().all(|n| *n > 0),
    );
}

fn hole(record: &mut Record) {
    let mut model = cut_raceway(|_| true);
    let mut ring = ring_model(
        Side::Inner,
        model.rings[0].as_ref().unwrap().mesh.clone(),
        Hold::Clamped,
    );
    let surface = contact::RacewaySurface::new(&ring.mesh, ring.mesh.group("raceway"), ring.groove);
    let under = surface.locate(0.0, 0.34).unwrap().facet;
    ring.mesh.groups.get_mut("raceway").unwrap().remove(under);
    model.rings[0] = Some(Arc::new(ring));
    let error = solve(&model).err().map_or(String::new(), |e| e.to_string());
    record.says(&error, "no facet of the inner raceway holds azimuth");
}

fn edge_contact(record: &mut Record) {
    let mut model = cut_raceway(|[low, high]| low > -1.0 && high < 40.0);
    super::bearings::set_loads(&mut model, Load::dead(40e3), Load::dead(0.0));
    match solve(&model) {
        Ok(solution) => {
            let text = solution.warnings.join("; ");
            record.says(&text, "edge contact on the inner raceway");
        }
        Err(error) => record.says(&error.to_string(), "leaves the inner raceway"),
    }
}

fn edge_in_motion(record: &mut Record) {
    let mut model = cut_raceway(|[_, high]| high < 20.0);
    super::bearings::set_loads(&mut model, Load::jump(10.0, 1.5e3), Load::dead(0.0));
    let settings = super::bearings::conserving(5e-6);
    let start = super::bearings::equilibrium_at(&model, 0.0).unwrap();
    record.that("no edge contact at the start", start.warnings.is_empty());
    let motion = dynamics::motion::Motion::new(&model, settings).unwrap();
    let state = motion.with_accelerations(motion.start(&start)).unwrap();
    record.that("nor in the first state", motion.exceeded(&state).is_empty());
    let mut first = None;
    let course = super::course::march_with(&motion, state, 100, |state| {
        if let (None, Some(found)) = (first, motion.exceeded(state).first()) {
            first = Some((state.step, found.side, found.limit));
        }
    });
    record.note(format!("first beyond a limit at {first:?}; {}", course.ending()));
    record.that(
        "edge contact is said",
        matches!(first, Some((step, Side::Inner, dynamics::motion::ContactLimit::Edge)) if step > 1),
    );
    record.below("ledger defect", course.defect, super::record::LEDGER);
    if let Some(error) = &course.error {
        record.says(error, "leaves the inner raceway");
    }
}

fn patch(record: &mut Record) {
    let mut model = loaded(rings(Level::hex8(90, 6, 1, 2)));
    super::bearings::set_loads(&mut model, Load::dead(2e3), Load::dead(0.0));
    model.contact.least_patch.spacings = 2.0;
    let usual = solve(&model).unwrap();
    // On 90 elements round, 5 from ball to ball, patches of 5 elements on both sides overlap.
    model.contact.least_patch.spacings = 5.0;
    match solve(&model) {
        Ok(wide) => {
            record.below(
                "change of a ball force at 5 elements",
                difference(&usual, &wide),
                2e-2,
            );
        }
        Err(error) => record.says(&error.to_string(), "few nodes"),
    }
    model.contact.least_patch.spacings = 20.0;
    match solve(&model) {
        Ok(widest) => {
            record.note(format!(
                "20 elements: ball forces change by {:.1e}",
                difference(&usual, &widest)
            ));
            record.below(
                "change of a ball force at 20 elements",
                difference(&usual, &widest),
                0.1,
            );
        }
        Err(error) => record.says(&error.to_string(), "tell 18 balls apart"),
    }
}

fn too_few(record: &mut Record) {
    let model = loaded(rings(Level::hex8(6, 1, 1, 1)));
    let error = solve(&model).err().map_or(String::new(), |e| e.to_string());
    record.says(&error, "too few nodes on its raceway to tell 18 balls apart");
}
