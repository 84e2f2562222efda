//! Does the mesh belong to this bearing: is its raceway the groove, and its unit the one stated?

use crate::error::MeshError;
use crate::mesh::Mesh;
use crate::origin::Origin;

/// A raceway groove about the axis z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Radius of the circle of groove centres, m.
    pub centre_radius: f64,
    /// Radius of the groove, m.
    pub groove_radius: f64,
    /// Axial position of the plane of groove centres, m.
    pub centre_z: f64,
}

impl Torus {
    /// Signed distance of `x` (m) from the groove surface, m: positive farther from the groove centre.
    pub fn distance(&self, x: [f64; 3]) -> f64 {
        (x[0].hypot(x[1]) - self.centre_radius).hypot(x[2] - self.centre_z) - self.groove_radius
    }
}

/// Every node of `group` must lie on `torus` within `tolerance`, m. The group must exist ([`crate::require_groups`]).
pub fn check_torus(
    mesh: &Mesh,
    origin: &Origin,
    group: &str,
    torus: &Torus,
    tolerance: f64,
) -> Result<(), MeshError> {
    crate::check::require_groups(mesh, &origin.path, &[group])?;
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
    Err(MeshError::OffTorus {
        path: origin.path.clone(),
        group: group.to_string(),
        node: origin.node_tags[worst.0],
        deviation: worst.1,
        centre_radius: torus.centre_radius,
        groove_radius: torus.groove_radius,
        centre_z: torus.centre_z,
        tolerance,
        count,
        total: nodes.len(),
    })
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
