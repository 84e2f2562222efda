//! Does the mesh belong to this bearing: is its raceway the groove, and its unit the one stated?

use super::groups::require_groups;
use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::origin::Origin;
use crate::torus::Torus;

/// What to do where the corners of elements lie on the groove, but nodes in the middle of their sides do not.
const STRAIGHT: &str = "only mid-side nodes are off, so that the elements of second order have straight sides: mesh \
                        the geometry itself with Mesh.SecondOrderLinear = 0, which puts them on the groove";

/// Every node of `group` must lie on `torus` within `tolerance`, m. The group must exist ([`crate::require_groups`]).
pub fn check_torus(
    mesh: &Mesh,
    origin: &Origin,
    group: &str,
    torus: &Torus,
    tolerance: f64,
) -> Result<(), MeshError> {
    require_groups(mesh, &origin.path, &[group])?;
    let nodes = mesh.group_nodes(group);
    let mut worst = (0, 0.0_f64);
    let mut count = 0;
    for &n in &nodes {
        let deviation = torus.distance(mesh.nodes[n]);
        count += usize::from(deviation.abs() > tolerance);
        if deviation.abs() > worst.1.abs() {
            worst = (n, deviation);
        }
    }
    if count == 0 {
        return Ok(());
    }
    let points: Vec<[f64; 3]> = nodes.iter().map(|&n| mesh.nodes[n]).collect();
    let n_corners = mesh.kind.facet_kind().n_corners();
    let mut facets = mesh.group(group).iter();
    let is_on = |n: usize| torus.distance(mesh.nodes[n]).abs() <= tolerance;
    let is_straight = facets.all(|&facet| mesh.facet_nodes(facet).take(n_corners).all(is_on));
    Err(MeshError::OffTorus {
        advice: match is_straight {
            true => STRAIGHT.into(),
            false => remedy(&points, torus, tolerance),
        },
        path: origin.path.clone(),
        group: group.into(),
        node: origin.node_tags[worst.0],
        deviation: worst.1,
        torus: *torus,
        tolerance,
        count,
        total: nodes.len(),
    })
}

/// A change of the axes.
type AxesChange = fn([f64; 3]) -> [f64; 3];

/// What would make the mesh fit, if it is a matter of its place alone.
fn remedy(points: &[[f64; 3]], torus: &Torus, tolerance: f64) -> Box<str> {
    let fits =
        |of: AxesChange, torus: &Torus| points.iter().all(|&x| torus.distance(of(x)).abs() <= tolerance);
    let axes: [(&str, AxesChange); 2] = [("x", |[x, y, z]| [y, z, x]), ("y", |[x, y, z]| [z, x, y])];
    for (axis, turned) in axes {
        // The groove's plane may lie elsewhere on that axis.
        let moved = centred(points.iter().map(|&x| turned(x)[2]), torus);
        if fits(turned, &moved) {
            return format!(
                "the groove fits about the {axis} axis: turn the mesh so that the bearing's axis is z"
            )
            .into();
        }
    }
    let moved = centred(points.iter().map(|x| x[2]), torus);
    if fits(|x| x, &moved) {
        // In micrometres and back, so that zero has no sign.
        let centre = (moved.centre_z * 1e9).round() / 1e6 + 0.0;
        return format!("the groove fits with its centre at z = {centre} mm: state that as groove_z").into();
    }
    "compare the raceway diameter, groove radius and axial position with the .geo".into()
}

/// The groove with its centre in the middle of what nodes reach along the axis.
fn centred(along: impl Iterator<Item = f64>, torus: &Torus) -> Torus {
    let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
        (low.min(z), high.max(z))
    });
    Torus {
        centre_z: 0.5 * (low + high),
        ..*torus
    }
}

/// Units a drawing may be in, m.
const UNITS: [(&str, f64); 5] = [
    ("m", 1.0),
    ("cm", 1e-2),
    ("mm", 1e-3),
    ("um", 1e-6),
    ("in", 0.0254),
];

/// A diameter within this factor of the expected one is not a matter of units.
const PLAUSIBLE: f64 = 3.0;

/// The mesh must be about `outside_diameter` (m) across, or its unit is evidently another one. This is no check
/// of accuracy: only a factor beyond 3 is an error.
pub fn check_unit(mesh: &Mesh, origin: &Origin, outside_diameter: f64) -> Result<(), MeshError> {
    let measured = 2.0 * mesh.nodes.iter().map(|x| x[0].hypot(x[1])).fold(0.0, f64::max);
    let factor = measured / outside_diameter;
    if factor < PLAUSIBLE && factor > 1.0 / PLAUSIBLE {
        return Ok(());
    }
    let misfit = |unit: f64| (measured / origin.unit * unit / outside_diameter).ln().abs();
    let best = UNITS.iter().min_by(|a, b| misfit(a.1).total_cmp(&misfit(b.1)));
    let advice = match best {
        Some((name, unit)) if misfit(*unit) < 1.5_f64.ln() => {
            format!("the file's lengths seem to be in {name}: state a mesh unit of \"{name}\" ({unit} m)")
        }
        _ => "no common unit fits, so check that this is the mesh of this ring".to_string(),
    };
    Err(MeshError::WrongUnit {
        path: origin.path.clone(),
        unit: origin.unit,
        measured,
        expected: outside_diameter,
        advice,
    })
}
