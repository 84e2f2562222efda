//! Where a contact force acts on a flexible ring: a patch on the torus, or one facet of the mesh.

use contact::patch::PatchShape;
use contact::{ContactError, NodalWeights, Patch, Side};
use mesh::Mesh;

use crate::error::DynamicsError;
use crate::model::{ContactMode, Model, RingModel, elastic};
use crate::problem::{Displacements, Problem, Site};
use crate::ring::RingSolver;

/// Groove angle kept from the rim by an unloaded contact, as a share of the groove.
const RIM_SHARE: f64 = 0.05;

/// Place of one contact on a ring.
#[derive(Clone, Debug)]
pub struct Footprint {
    /// Nodal weights.
    pub weights: NodalWeights,
    /// Semi-axes of the spread patch, m; None on a facet.
    pub semi_axes: Option<[f64; 2]>,
    /// The Hertz ellipse reaches beyond the groove.
    pub truncated: bool,
}

/// Places all contacts of one ring for the displacements `u` and site forces, and sets the laws (patch compliance)
/// and, for facets, the local groove centres of the problem's sites. `field`: the ring's elastic displacement, m.
pub fn place(
    model: &Model,
    side: Side,
    solver: &RingSolver,
    problem: &mut Problem,
    u: &Displacements,
    forces: &[[f64; 2]],
    field: Option<&[f64]>,
) -> Result<Vec<Footprint>, DynamicsError> {
    let ring = model.ring(side).expect("only flexible rings have footprints");
    let n_balls = model.geometry.n_balls;
    let mut feet = Vec::with_capacity(n_balls);
    for ball in 0..n_balls {
        let index = 2 * ball + side.index();
        let site = &mut problem.sites[index];
        feet.push(match model.contact.mode {
            ContactMode::Facet => place_facet(model, ring, solver, site, u, field)?,
            _ => place_patch(model, ring, solver, site, u, forces[index])?,
        });
    }
    Ok(feet)
}

fn place_patch(
    model: &Model,
    ring: &RingModel,
    solver: &RingSolver,
    site: &mut Site,
    u: &Displacements,
    force: [f64; 2],
) -> Result<Footprint, DynamicsError> {
    let load = force[0].hypot(force[1]);
    let angle = site.contact_angle(&site.state(u));
    let angle = reachable(solver, site, angle, load)?;
    let hertz = model.hertz[site.side.index()].semi_axes(load);
    let spacings = model.contact.patch_spacings;
    let shape = PatchShape::new(&solver.surface, site.azimuth, angle, hertz, spacings)?;
    let patch = Patch::new(
        &solver.surface,
        &ring.mesh.nodes,
        &solver.rule,
        shape,
        elastic(&ring.material),
    )?;
    site.law.patch_compliance = patch.compliance;
    Ok(Footprint {
        weights: patch.weights,
        semi_axes: Some(shape.semi_axes),
        truncated: shape.truncated,
    })
}

/// The contact angle if the groove reaches it; an unloaded contact is moved onto the groove.
fn reachable(solver: &RingSolver, site: &Site, angle: f64, load: f64) -> Result<f64, DynamicsError> {
    let [low, high] = solver.surface.angle_range;
    if load > 0.0 {
        if angle <= low || angle >= high {
            return Err(ContactError::OffRaceway {
                ball: site.ball,
                side: site.side.name(),
                angle_deg: angle.to_degrees(),
                low_deg: low.to_degrees(),
                high_deg: high.to_degrees(),
            }
            .into());
        }
        return Ok(angle);
    }
    let rim = RIM_SHARE * (high - low);
    Ok(angle.clamp(low + rim, high - rim))
}

/// Closest facet of the deformed mesh; the site's groove centre becomes the centre of curvature there.
fn place_facet(
    model: &Model,
    ring: &RingModel,
    solver: &RingSolver,
    site: &mut Site,
    u: &Displacements,
    field: Option<&[f64]>,
) -> Result<Footprint, DynamicsError> {
    let facets = solver
        .facets
        .as_ref()
        .expect("facet mode builds the facet search of every flexible ring");
    let (sin, cos) = site.azimuth.sin_cos();
    // Ball centre in mesh coordinates, seen from a ring whose rigid motion is taken out.
    let geometry = &model.geometry;
    let shift = model.ring_shift(site.side);
    let reference = geometry.ball_centre();
    let mut ball = [
        reference[0] + u.balls[site.ball][0],
        reference[1] + u.balls[site.ball][1] - shift,
    ];
    if site.side == Side::Inner {
        for (row, q) in site.shaft_rows().iter().zip(u.shaft) {
            ball[0] -= row[0] * q;
            ball[1] -= row[1] * q;
        }
    }
    let centre = [ball[0] * cos, ball[0] * sin, ball[1]];
    let position = |node: usize| deformed(&ring.mesh, field, node);
    let radius = 0.5 * geometry.ball_diameter;
    let contact = facets
        .foot(centre, 2.0 * radius, position)
        .ok_or(DynamicsError::NoFacet {
            ball: site.ball,
            side: site.side.name(),
        })?;
    let weights = NodalWeights::interpolation(contact.nodes, &contact.weights, site.azimuth);
    let meridian = [
        contact.normal[0] * cos + contact.normal[1] * sin,
        contact.normal[2],
    ];
    let size = meridian[0].hypot(meridian[1]);
    let normal = meridian.map(|x| x / size);
    let approach = radius - contact.distance;
    // Groove centre such that the vector to the ball is the normal, with the penetration just measured.
    let length = site.touching + approach;
    let moved = field.map_or([0.0; 2], |f| weights.measure(f));
    for i in 0..2 {
        let rest = ball[i] - [reference[0], reference[1] - shift][i];
        site.reach[i] = length * normal[i] - rest + moved[i];
    }
    Ok(Footprint {
        weights,
        semi_axes: None,
        truncated: false,
    })
}

fn deformed(mesh: &Mesh, field: Option<&[f64]>, node: usize) -> [f64; 3] {
    let x = mesh.nodes[node];
    field.map_or(x, |u| {
        [x[0] + u[3 * node], x[1] + u[3 * node + 1], x[2] + u[3 * node + 2]]
    })
}
