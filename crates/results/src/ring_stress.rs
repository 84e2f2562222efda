//! Stress of the rings as step files hold it: averaged at nodes, or at the integration points of the elements.

use std::sync::Arc;

use checkpoint::{CellFields, IntegrationPointStress};
use comm::Communicator;
use contact::{LoadedPatch, Side};
use dynamics::{Backend, Model, NodalStress, OwnStress, PointStress, RingModel, SharedStress, StressPlaces};
use fem::StressRecovery;
use fem::quadrature::stiffness_rule;
use fem::stress::von_mises;
use mesh::NodePositions;
use scene::{KeptFields, Scene, StressOutput};
use timer::Laps;

use super::bodies::{BodyField, bodies_of};
use super::shown::{Shown, Turn, add};
use super::summary::{GATHER, STRESS};
use super::timed_near_field::TimedNearField;
use crate::failure::Failure;

/// Order of points and components, as every step file states it. Points beyond those of a cell's kind are zero.
pub const LAYOUT: &str = "stress in Pa, tension positive; a row per cell: points one after the other, each with the \
                          components xx yy zz xy yz xz in the axes in which the ring is shown; VTK cell type 12 \
                          (hex8): 8 points of the 2x2x2 Gauss rule, 25 (hex20): 27 points of the 3x3x3 Gauss rule, \
                          the first reference coordinate fastest, then the second; 24 (tet10): 4 points of the \
                          Hammer-Stroud rule, point 0 near node 0 and so on; 1 (ball): none; numbers beyond the \
                          points of a cell are zero";

/// Stress recovery of the flexible rings, made once per run.
pub struct RingStress {
    kind: StressOutput,
    /// By side; None for rigid rings.
    rings: [Option<Recovery>; 2],
    /// Balls, which have a point and a cell each.
    n_balls: usize,
    /// Recovery of the bodies of the rings, in their order.
    bodies: Vec<StressRecovery>,
}

/// Recovery of one ring, and the places of its stress for the near field if that is asked for.
struct Recovery {
    source: RingRecovery,
    points_per_element: usize,
    near_field: Option<TimedNearField>,
}

/// What recovers the stress of a ring from its displacements.
enum RingRecovery {
    /// At the integration points.
    Points(Box<PointStress>),
    /// At the nodes.
    Nodes(NodalStress),
    /// Either, by sector: ranks share it.
    Shared(Box<SharedStress>),
}

/// What rank 0 has gathered of the rings that ranks share, by side; None of other rings.
#[derive(Default)]
pub struct Gathered {
    /// Stress, Pa, as it was recovered.
    pub stress: [Option<Vec<[f64; 6]>>; 2],
    /// Where all nodes are, of rings that have moved as a whole.
    pub places: [Option<NodePositions>; 2],
}

/// A flexible ring at one instant.
pub struct ShownRing {
    /// What its stress follows from.
    pub basis: StressBasis,
    /// Stress besides that of the displacement; None: none.
    pub own_stress: Option<Arc<OwnStress>>,
    /// From the ring's frame to space.
    pub turn: Turn,
    /// Contact forces on it; empty without near field.
    pub patches: Vec<LoadedPatch>,
}

/// What the stress of a ring follows from, in its own frame.
pub enum StressBasis {
    /// Displacement up to a rigid motion, m, `[n_nodes][3]` flat.
    Displacement(Vec<f64>),
    /// The stress that ranks have recovered together, Pa.
    Stress(Vec<[f64; 6]>),
}

/// Stress of one instant over points and cells; what the scene does not ask for is absent.
#[derive(Debug, Default)]
pub struct StressFields {
    /// Stress of all points, Pa, zero on balls.
    pub nodal: Option<Vec<[f64; 6]>>,
    /// Stress of all cells, zero on balls.
    pub cells: CellFields,
}

impl RingStress {
    /// Prepares what the scene asks for: on rank 0 that of all rings, on others their part of rings that ranks share.
    /// Collective.
    pub fn new(model: &Model, scene: &Scene) -> Result<RingStress, Failure> {
        RingStress::of_kind(scene.output.stress, model, scene)
    }

    /// The same of another kind than step files have.
    pub fn of_kind(kind: StressOutput, model: &Model, scene: &Scene) -> Result<RingStress, Failure> {
        let recovery = |side: Side| match model.ring(side) {
            Some(ring) if kind != StressOutput::None => {
                Recovery::new(ring, (side.name(), kind), model.backend, scene)
            }
            _ => Ok::<_, Failure>(None),
        };
        Ok(RingStress {
            kind,
            rings: Side::try_both(recovery)?,
            n_balls: model.geometry.n_balls,
            bodies: body_recoveries(model, kind)?,
        })
    }

    /// Stress of the rings that several ranks share, and what else their fields take, on rank 0;
    /// laps of the sectors of this rank, and of putting all together. Collective.
    pub fn gather(&self, shown: &Shown<'_>, kept: KeptFields) -> (Gathered, Laps) {
        let (mut gathered, mut laps) = (Gathered::default(), Laps::default());
        let model = shown.model();
        let sectors = model.backend.sectors();
        if sectors.is_none_or(|sectors| sectors.comm.size() == 1) {
            return (gathered, laps);
        }
        for side in Side::BOTH {
            let (Some(ring), Some(field)) = (model.ring(side), shown.ring(side)) else {
                continue;
            };
            laps.time(GATHER, || {
                if kept.displacement && field.needs_places() {
                    let places = ring.places(side.name(), model.backend);
                    let places = places.expect("a ring that is divided has sectors");
                    gathered.places[side.index()] = places.to_root();
                }
            });
            let recovery = self.rings[side.index()].as_ref().filter(|_| kept.stress);
            let Some(RingRecovery::Shared(shared)) = recovery.map(|r| &r.source) else {
                continue;
            };
            let own = laps.time(STRESS, || shared.recover(&field.strained));
            gathered.stress[side.index()] = laps.time(GATHER, || shared.gather(own));
        }
        (gathered, laps)
    }

    /// Seconds spent on near fields so far; None where no ring has one.
    pub fn near_field_seconds(&self) -> Option<f64> {
        let fields = self.rings.iter().flatten().filter_map(|r| r.near_field.as_ref());
        fields.map(TimedNearField::seconds).reduce(|a, b| a + b)
    }

    /// Stress of a ring with its near field, Pa, in its own frame.
    fn stress(&self, recovery: &Recovery, ring: &ShownRing) -> Vec<[f64; 6]> {
        let mut stress = match &ring.basis {
            StressBasis::Displacement(field) => recovery.source.stress(field),
            StressBasis::Stress(stress) => stress.clone(),
        };
        if let Some(own) = &ring.own_stress {
            add(
                &mut stress,
                match self.kind {
                    StressOutput::IntegrationPoints => &own.points,
                    StressOutput::Nodal | StressOutput::None => &own.nodal,
                },
            );
        }
        if let Some(near_field) = &recovery.near_field {
            near_field.add(&ring.patches, &mut stress);
        }
        stress
    }

    /// Stress of one instant, from the fields of the flexible rings, and after all others that of their bodies.
    pub fn fields(&self, rings: &[Option<ShownRing>; 2], bodies: &[BodyField]) -> StressFields {
        let known: Vec<(&Recovery, &ShownRing)> = self
            .rings
            .iter()
            .zip(rings)
            .filter_map(|(recovery, field)| recovery.as_ref().zip(field.as_ref()))
            .collect();
        if known.is_empty() {
            return StressFields::default();
        }
        let mut fields = match self.kind {
            StressOutput::None => StressFields::default(),
            StressOutput::Nodal => StressFields {
                nodal: Some(self.nodal(&known)),
                cells: CellFields::default(),
            },
            StressOutput::IntegrationPoints => StressFields {
                nodal: None,
                cells: self.cells(&known),
            },
        };
        for (recovery, body) in self.bodies.iter().zip(bodies) {
            add_body(recovery, body, &mut fields);
        }
        fields
    }

    fn nodal(&self, rings: &[(&Recovery, &ShownRing)]) -> Vec<[f64; 6]> {
        let mut stress = Vec::new();
        for (recovery, ring) in rings {
            let own = self.stress(recovery, ring);
            stress.extend(own.into_iter().map(|s| ring.turn.tensor(s)));
        }
        stress.resize(stress.len() + self.n_balls, [0.0; 6]);
        stress
    }

    fn cells(&self, rings: &[(&Recovery, &ShownRing)]) -> CellFields {
        let points = rings.iter().map(|(recovery, _)| recovery.points_per_element);
        let of_bodies = self.bodies.iter().map(StressRecovery::points_per_element);
        let points_per_cell = points.chain(of_bodies).max().unwrap_or(0);
        let (mut values, mut largest) = (Vec::new(), Vec::new());
        for (recovery, ring) in rings {
            let stress = self.stress(recovery, ring);
            for cell in stress.chunks_exact(recovery.points_per_element) {
                let end = values.len() + 6 * points_per_cell;
                values.extend(cell.iter().flat_map(|&s| ring.turn.tensor(s)));
                values.resize(end, 0.0);
                largest.push(cell.iter().map(|&s| von_mises(s)).fold(0.0, f64::max));
            }
        }
        values.resize(values.len() + 6 * points_per_cell * self.n_balls, 0.0);
        largest.resize(largest.len() + self.n_balls, 0.0);
        CellFields {
            stress_integration_points: Some(IntegrationPointStress {
                points_per_cell,
                values,
                layout: LAYOUT.to_string(),
            }),
            von_mises_largest: Some(largest),
            in_region: None,
        }
    }
}

/// Recovery of the bodies that are shown, where stress is asked for.
fn body_recoveries(model: &Model, kind: StressOutput) -> Result<Vec<StressRecovery>, Failure> {
    let shown = bodies_of(model)
        .into_iter()
        .filter(|_| kind != StressOutput::None);
    let recoveries = shown.map(|body| StressRecovery::new(body.mesh, body.material));
    let recoveries: Result<_, _> = recoveries.collect();
    Ok(recoveries.map_err(anyhow::Error::from)?)
}

/// Adds the stress of a body after all others.
fn add_body(recovery: &StressRecovery, body: &BodyField, fields: &mut StressFields) {
    let shown = |stress: &[f64; 6]| body.turn.tensor(*stress);
    if let Some(nodal) = &mut fields.nodal {
        nodal.extend(recovery.nodal(&body.displacement).iter().map(shown));
    }
    let (Some(points), Some(largest)) = (
        &mut fields.cells.stress_integration_points,
        &mut fields.cells.von_mises_largest,
    ) else {
        return;
    };
    let stress = recovery.integration_points(&body.displacement);
    for cell in stress.chunks_exact(recovery.points_per_element()) {
        let end = points.values.len() + 6 * points.points_per_cell;
        points.values.extend(cell.iter().flat_map(shown));
        points.values.resize(end, 0.0);
        largest.push(cell.iter().map(|&s| von_mises(s)).fold(0.0, f64::max));
    }
}

impl Recovery {
    /// Recovery of a ring; None on a rank that has no part in it.
    fn new(
        ring: &RingModel,
        (side, kind): (&'static str, StressOutput),
        backend: Backend,
        scene: &Scene,
    ) -> Result<Option<Recovery>, Failure> {
        let (at_points, is_root) = (
            kind == StressOutput::IntegrationPoints,
            Communicator::world().is_root(),
        );
        let source = match backend.sectors() {
            Some(sectors) => {
                let places = if at_points {
                    StressPlaces::IntegrationPoints
                } else {
                    StressPlaces::Nodes
                };
                let shared = SharedStress::new(ring, side, sectors, places).map_err(Failure::solving)?;
                RingRecovery::Shared(Box::new(shared))
            }
            _ if !is_root => return Ok(None),
            _ if at_points => RingRecovery::Points(Box::new(
                PointStress::new(ring, side, backend).map_err(Failure::solving)?,
            )),
            _ => RingRecovery::Nodes(NodalStress::new(ring, side, backend).map_err(Failure::solving)?),
        };
        let points = match &source {
            _ if scene.stress.near_field_reach.is_none() => None,
            RingRecovery::Nodes(_) => Some(ring.mesh.nodes.to_vec()),
            RingRecovery::Points(stress) => Some(stress.point_positions()),
            RingRecovery::Shared(shared) if at_points => shared.point_positions(),
            RingRecovery::Shared(_) => {
                let places = ring.places(side, backend).map_err(Failure::solving)?;
                places.to_root().map(|places| places.to_vec())
            }
        };
        let near_field = scene
            .stress
            .near_field_reach
            .zip(points)
            .map(|(reach, points)| TimedNearField::new(ring, reach, &points));
        Ok(Some(Recovery {
            source,
            points_per_element: stiffness_rule(ring.mesh.kind).points.len(),
            near_field,
        }))
    }
}

impl RingRecovery {
    /// Stress from displacements, by this process alone, Pa.
    fn stress(&self, field: &[f64]) -> Vec<[f64; 6]> {
        match self {
            RingRecovery::Points(stress) => stress.at_points(field),
            RingRecovery::Nodes(nodal) => nodal.nodal(field),
            RingRecovery::Shared(shared) => {
                let gathered = shared.gather(shared.recover(field));
                gathered.expect("one process has all sectors")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use fem::Material;
    use fem::element::reference_nodes;
    use mesh::{ElementKind, Mesh};

    use super::*;

    /// An element on its reference cell.
    fn element(kind: ElementKind) -> Mesh {
        Mesh {
            kind,
            nodes: reference_nodes(kind).to_vec().into(),
            connectivity: (0..kind.n_nodes()).collect(),
            groups: Default::default(),
        }
    }

    /// Wrong: rings of different elements would shift each other's rows, or cells with fewer points end in anything but
    /// zeros. Uniaxial strain xx of 1e-3 with E = 200 GPa, Poisson's ratio 1/4: 240, 80, 80 MPa, von Mises 160 MPa; the
    /// inner ring is turned by a quarter, which makes it strain yy.
    #[test]
    fn rings_of_different_elements_share_rows_of_one_width() {
        let steel = Material::new(200e9, 0.25, 7800.0).unwrap();
        let meshes = [ElementKind::Tet10, ElementKind::Hex20].map(element);
        let stress = RingStress {
            kind: StressOutput::IntegrationPoints,
            rings: meshes.each_ref().map(|mesh| {
                let elements = StressRecovery::new(mesh, &steel).unwrap();
                Some(Recovery {
                    points_per_element: elements.points_per_element(),
                    source: RingRecovery::Points(Box::new(PointStress::of_elements(elements))),
                    near_field: None,
                })
            }),
            n_balls: 1,
            bodies: Vec::new(),
        };
        let stretched = |mesh: &Mesh| mesh.nodes.iter().flat_map(|x| [1e-3 * x[0], 0.0, 0.0]).collect();
        let quarter = std::f64::consts::FRAC_PI_2;
        let shown = |field: Vec<f64>, angle: f64| {
            Some(ShownRing {
                basis: StressBasis::Displacement(field),
                own_stress: None,
                turn: Turn::new(angle),
                patches: Vec::new(),
            })
        };
        let fields = [
            shown(stretched(&meshes[0]), quarter),
            shown(stretched(&meshes[1]), 0.0),
        ];
        let found = stress.fields(&fields, &[]);
        assert!(found.nodal.is_none());
        let tensors = found.cells.stress_integration_points.unwrap();
        assert_eq!(tensors.points_per_cell, 27);
        let tensors = tensors.values.as_chunks::<6>().0;
        assert_eq!(tensors.len(), 3 * 27, "tetrahedron, hexahedron, ball");
        for (i, tensor) in tensors.iter().enumerate() {
            let expected = match i {
                0..4 => [80e6, 240e6, 80e6, 0.0, 0.0, 0.0],
                27..54 => [240e6, 80e6, 80e6, 0.0, 0.0, 0.0],
                _ => [0.0; 6],
            };
            for c in 0..6 {
                assert!(
                    (tensor[c] - expected[c]).abs() < 1e-12 * 240e6,
                    "tensor {i}: {tensor:?}, expected {expected:?}"
                );
            }
        }
        let largest = found.cells.von_mises_largest.unwrap();
        for (value, expected) in largest.iter().zip([160e6, 160e6, 0.0]) {
            assert!((value - expected).abs() < 1e-12 * 160e6, "{largest:?}");
        }
    }
}
