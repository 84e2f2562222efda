//! Strain gauges: where their grids lie on the surface of a ring's mesh, and what they read.
//!
//! A gauge has a grid of points, equally far apart, over its length and width. On a surface along the axis they are
//! places of azimuth and z, on a face of azimuth and r; each is the point of a facet there, exactly. At each of them
//! the hoop direction is the tangent of the facet that is square to the axis, or to the radius on a face.

use anyhow::anyhow;
use contact::Side;
use dynamics::{Hold, Model, RingModel};
use fem::stress::{GaugePoint, MeshPoint, StrainGauge};
use mesh::Facet;
use scene::{Across, GaugeProbe};

use super::facet_search::{FacetPlace, SurfaceFacets, free_faces, is_face};
use super::probe_places::side_of;
use super::shown::Shown;
use crate::failure::Failure;

/// Points of a grid along and across its direction.
const GRID: [usize; 2] = [24, 12];
/// Surface of all free faces that are in no group.
const FREE: &str = "free";
/// How far beyond the rims of a surface, in sizes of a facet, a point of a grid still counts as on it.
const BEYOND: f64 = 1e-9;

/// The strain gauges of a run.
pub struct Gauges {
    gauges: Vec<(String, Side, StrainGauge)>,
    /// Nodes that the gauges of each ring read, ascending.
    nodes: [Vec<usize>; 2],
}

impl Gauges {
    /// Places the gauges of a scene on the meshes.
    pub fn new(probes: &[GaugeProbe], model: &Model) -> Result<Gauges, Failure> {
        let mut gauges = Vec::new();
        let mut nodes = [Vec::new(), Vec::new()];
        for probe in probes {
            let side = side_of(probe.ring);
            let Some(ring) = model.ring(side) else {
                unreachable!("the scene refuses gauges on rigid rings")
            };
            let gauge = place(probe, ring)?;
            nodes[side.index()].extend(gauge.nodes());
            gauges.push((probe.name.clone(), side, gauge));
        }
        for nodes in &mut nodes {
            nodes.sort_unstable();
            nodes.dedup();
        }
        Ok(Gauges { gauges, nodes })
    }

    /// Names of the columns.
    pub fn columns(&self) -> impl Iterator<Item = String> + '_ {
        self.gauges.iter().map(|(name, ..)| format!("{name}_strain"))
    }

    /// Numbers of the gauges on one ring.
    pub fn on(&self, side: Side) -> impl Iterator<Item = usize> + '_ {
        (0..self.gauges.len()).filter(move |&g| self.gauges[g].1 == side)
    }

    /// Name of a gauge.
    pub fn name(&self, gauge: usize) -> &str {
        &self.gauges[gauge].0
    }

    /// Strain of one gauge under displacements of all nodes of its ring, m, `[n_nodes][3]` flat.
    pub fn strain(&self, gauge: usize, displacement: &[f64]) -> f64 {
        self.gauges[gauge].2.strain(displacement)
    }

    /// Strains at one instant.
    pub fn values(&self, shown: &Shown<'_>) -> Vec<f64> {
        let ring = |side: Side| {
            let nodes = &self.nodes[side.index()];
            (!nodes.is_empty()).then(|| shown.ring_at(side, nodes)).flatten()
        };
        let rings = Side::BOTH.map(ring);
        let read = |(_, side, gauge): &(String, Side, StrainGauge)| {
            let Some(ring) = &rings[side.index()] else {
                unreachable!("a ring with gauges has a field while it is shown")
            };
            // What own strain does not become stress is no strain of a gauge that is matched to the steel.
            let own = ring.own_stress.as_ref();
            gauge.strain(&ring.strained) + own.map_or(0.0, |own| gauge.strain_of_stress(&own.nodal))
        };
        self.gauges.iter().map(read).collect()
    }
}

/// A gauge on its ring.
fn place(probe: &GaugeProbe, ring: &RingModel) -> Result<StrainGauge, Failure> {
    let surface = surface(probe, ring)?;
    let middle = middle(probe, ring, &surface)?;
    let points: Vec<GaugePoint> = grid(probe)
        .into_iter()
        .map(|[along, second]| {
            let at = [probe.azimuth + along / middle.radius, middle.height + second];
            let found = surface.at(at, middle.other, BEYOND);
            found.map(|place| point(probe, ring, &place)).ok_or_else(|| {
                error(probe, format!(
                    "its grid of {:.4} mm x {:.4} mm reaches beyond the surface {:?} at azimuth {:.3} deg, {}",
                    1e3 * probe.size[0],
                    1e3 * probe.size[1],
                    probe.surface,
                    at[0].to_degrees(),
                    surface.words(at[1], ring.groove.centre_z)
                ))
            })
        })
        .collect::<Result<_, _>>()?;
    Ok(StrainGauge::new(&ring.mesh, &ring.material, &points))
}

/// The facets on which a gauge may lie.
fn surface<'a>(probe: &GaugeProbe, ring: &'a RingModel) -> Result<SurfaceFacets<'a>, Failure> {
    let (mesh, name) = (&ring.mesh, probe.surface.as_str());
    let facets: Vec<Facet> = match name {
        FREE => free_faces(mesh),
        _ => mesh.group(name).to_vec(),
    };
    if facets.is_empty() {
        let known: Vec<&str> = mesh.groups.keys().map(String::as_str).collect();
        let what = format!(
            "the {} ring has no surface {name:?}; its mesh has the surfaces {}, and \"free\" is what is in none of \
             them",
            probe.ring.key(),
            known.join(", ")
        );
        return Err(error(probe, what));
    }
    if ring.hold == Hold::Clamped && name == ring.held_group {
        return Err(error(
            probe,
            format!(
                "the {name} of the {} ring is clamped, so that a gauge there reads nothing; expected another \
                 surface, the floor of a [[{}.cut]] (surface = \"free\") or {}.support = \"mean_motion\"",
                probe.ring.key(),
                probe.ring.key(),
                probe.ring.key()
            ),
        ));
    }
    // A group may have facets of both kinds, as what cuts leave free does.
    let on_face = probe.r.is_some() || probe.across == Across::Radial;
    let of_kind: Vec<Facet> = facets
        .into_iter()
        .filter(|f| is_face(mesh, *f) == on_face)
        .collect();
    if of_kind.is_empty() {
        let expected = match on_face {
            true => {
                "lies along the axis; expected its place by z and the direction \"hoop\", \"axial\" or an angle"
            }
            false => {
                "is square to the axis; expected its place by r and the direction \"hoop\", \"radial\" or an angle"
            }
        };
        return Err(error(probe, format!("the surface {name:?} {expected}")));
    }
    if on_face && (probe.r.is_none() || probe.across == Across::Axial) {
        let what = "on a face it needs its place by r, and the direction \"hoop\", \"radial\" or an angle";
        return Err(error(probe, what.to_string()));
    }
    Ok(SurfaceFacets::new(mesh, of_kind, on_face))
}

/// The middle of a gauge.
struct GaugePlace {
    /// Distance from the axis, m.
    radius: f64,
    /// z on a surface along the axis, r on a face, in coordinates of the mesh, m.
    height: f64,
    /// The other one of the two, where several places share the first: r, or z on a face.
    other: f64,
}

fn middle(probe: &GaugeProbe, ring: &RingModel, surface: &SurfaceFacets<'_>) -> Result<GaugePlace, Failure> {
    let z = probe.z.map(|z| ring.groove.centre_z + z);
    let (height, other) = match surface.on_face {
        true => (probe.r, z),
        false => (z, None),
    };
    let height = height.expect("a place by r on a face, by z elsewhere");
    let found = surface.all_at([probe.azimuth, height], BEYOND);
    let others: Vec<f64> = found.iter().map(|place| surface.other(place.position)).collect();
    let (low, high) = others
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
            (l.min(*x), h.max(*x))
        });
    let Some(first) = others.first() else {
        return Err(error(
            probe,
            format!(
                "the surface {:?} of the {} ring has no point at azimuth {:.3} deg, {}; it reaches from {} to {}",
                probe.surface,
                probe.ring.key(),
                probe.azimuth.to_degrees(),
                surface.words(height, ring.groove.centre_z),
                surface.words(surface.range()[0], ring.groove.centre_z),
                surface.words(surface.range()[1], ring.groove.centre_z)
            ),
        ));
    };
    let other = match other {
        Some(wanted) => *others
            .iter()
            .min_by(|a, b| (*a - wanted).abs().total_cmp(&(*b - wanted).abs()))
            .expect("one"),
        None if high - low <= 1e-3 * ring.groove.groove_radius => *first,
        None => {
            return Err(error(
                probe,
                format!(
                    "the surface {:?} is there at several places, z {:.4} mm and z {:.4} mm; expected z besides r",
                    probe.surface,
                    1e3 * (low - ring.groove.centre_z),
                    1e3 * (high - ring.groove.centre_z)
                ),
            ));
        }
    };
    let radius = if surface.on_face { height } else { other };
    Ok(GaugePlace {
        radius,
        height,
        other,
    })
}

/// Places of the grid [in hoop direction, in the second one], m from its middle.
fn grid(probe: &GaugeProbe) -> Vec<[f64; 2]> {
    let (sin, cos) = probe.angle.sin_cos();
    let centre = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 - 0.5;
    let all = (0..GRID[0]).flat_map(|i| (0..GRID[1]).map(move |j| (i, j)));
    all.map(|(i, j)| {
        let (along, across) = (
            probe.size[0] * centre(i, GRID[0]),
            probe.size[1] * centre(j, GRID[1]),
        );
        [along * cos - across * sin, along * sin + across * cos]
    })
    .collect()
}

/// A point of the grid with its direction in the facet.
fn point(probe: &GaugeProbe, ring: &RingModel, place: &FacetPlace) -> GaugePoint {
    let [hoop, second] = place.tangents();
    let (sin, cos) = probe.angle.sin_cos();
    GaugePoint {
        place: MeshPoint::on_facet(&ring.mesh, place.facet, place.xi),
        direction: [0, 1, 2].map(|i| cos * hoop[i] + sin * second[i]),
    }
}

fn error(probe: &GaugeProbe, what: String) -> Failure {
    Failure::User(anyhow!("probes.gauge.{}: {what}", probe.name))
}
