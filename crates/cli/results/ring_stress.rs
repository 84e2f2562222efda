//! Stress of the rings as step files hold it: averaged at nodes, or at the integration points of the elements.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use checkpoint::{CellFields, IntegrationPointStress};
use contact::{LoadedPatch, NearField, Side};
use dynamics::{Model, NodalStress, RingModel};
use fem::stress::{StressRecovery, von_mises};

use super::shown::Turn;
use crate::failure::Failure;
use crate::scene::{Scene, StressOutput};

/// Order of points and components, as every step file states it. Points beyond those of a cell's kind are zero.
pub const LAYOUT: &str = "stress in Pa, tension positive; a row per cell: points one after the other, each with the \
                          components xx yy zz xy yz xz in the axes in which the ring is shown; VTK cell type 12 (hex8): \
                          8 points of the 2x2x2 Gauss rule, 25 (hex20): 27 points of the 3x3x3 Gauss rule, the first \
                          reference coordinate fastest, then the second; 24 (tet10): 4 points of the Hammer-Stroud rule, \
                          point 0 near node 0 and so on; 1 (ball): none; numbers beyond the points of a cell are zero";

/// Stress recovery of the flexible rings, made once per run.
pub struct RingStress {
    kind: StressOutput,
    /// By side; None for rigid rings.
    rings: [Option<Recovery>; 2],
    /// Balls, which have a point and a cell each.
    n_balls: usize,
    /// Nanoseconds spent on near fields.
    near_field_time: AtomicU64,
}

/// Recovery of one ring, and the places of its stress for the near field if that is asked for.
struct Recovery {
    elements: StressRecovery,
    /// What averages at nodes, when the scene asks for it.
    nodal: Option<NodalStress>,
    near_field: Option<NearField>,
}

/// A flexible ring at one instant.
pub struct ShownRing {
    /// Displacement up to a rigid motion in the ring's own frame, m, `[n_nodes][3]` flat.
    pub field: Vec<f64>,
    /// From that frame to space.
    pub turn: Turn,
    /// Contact forces on it; empty without near field.
    pub patches: Vec<LoadedPatch>,
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
    /// Prepares what the scene asks for.
    pub fn new(model: &Model, scene: &Scene) -> Result<RingStress, Failure> {
        let recovery = |side: Side| match model.ring(side) {
            Some(ring) if scene.output.stress != StressOutput::None => {
                let mut recovery = Recovery::new(ring, scene.output.stress, scene.stress.near_field_reach)?;
                if scene.output.stress == StressOutput::Nodal {
                    let nodal = NodalStress::new(ring, side.name(), model.backend);
                    recovery.nodal = Some(nodal.map_err(Failure::solving)?);
                }
                Ok(Some(recovery))
            }
            _ => Ok::<_, Failure>(None),
        };
        Ok(RingStress {
            kind: scene.output.stress,
            rings: [recovery(Side::Inner)?, recovery(Side::Outer)?],
            n_balls: model.geometry.n_balls,
            near_field_time: AtomicU64::new(0),
        })
    }

    /// Time spent on near fields so far; None where no ring has one.
    pub fn near_field_time(&self) -> Option<Duration> {
        let has_one = |ring: &Option<Recovery>| ring.as_ref().is_some_and(|r| r.near_field.is_some());
        let nanoseconds = self.near_field_time.load(Ordering::Relaxed);
        (self.rings.iter().any(has_one)).then(|| Duration::from_nanos(nanoseconds))
    }

    /// Adds the near field of a ring's contacts to its stress.
    fn add_near_field(&self, recovery: &Recovery, ring: &ShownRing, stress: &mut [[f64; 6]]) {
        if let Some(near_field) = &recovery.near_field {
            let clock = Instant::now();
            near_field.add(&ring.patches, stress);
            let spent = clock.elapsed().as_nanos() as u64;
            self.near_field_time.fetch_add(spent, Ordering::Relaxed);
        }
    }

    /// Stress of one instant, from the fields of the flexible rings.
    pub fn fields(&self, rings: &[Option<ShownRing>; 2]) -> StressFields {
        let known: Vec<(&Recovery, &ShownRing)> = self
            .rings
            .iter()
            .zip(rings)
            .filter_map(|(recovery, field)| recovery.as_ref().zip(field.as_ref()))
            .collect();
        if known.is_empty() {
            return StressFields::default();
        }
        match self.kind {
            StressOutput::None => StressFields::default(),
            StressOutput::Nodal => StressFields {
                nodal: Some(self.nodal(&known)),
                cells: CellFields::default(),
            },
            StressOutput::IntegrationPoints => StressFields {
                nodal: None,
                cells: self.cells(&known),
            },
        }
    }

    fn nodal(&self, rings: &[(&Recovery, &ShownRing)]) -> Vec<[f64; 6]> {
        let mut stress = Vec::new();
        for (recovery, ring) in rings {
            let mut own = match &recovery.nodal {
                Some(nodal) => nodal.nodal(&ring.field),
                None => recovery.elements.nodal(&ring.field),
            };
            self.add_near_field(recovery, ring, &mut own);
            stress.extend(own.into_iter().map(|s| ring.turn.tensor(s)));
        }
        stress.resize(stress.len() + self.n_balls, [0.0; 6]);
        stress
    }

    fn cells(&self, rings: &[(&Recovery, &ShownRing)]) -> CellFields {
        let points = rings
            .iter()
            .map(|(recovery, _)| recovery.elements.points_per_element());
        let points_per_cell = points.max().unwrap_or(0);
        let (mut values, mut largest) = (Vec::new(), Vec::new());
        for (recovery, ring) in rings {
            let mut stress = recovery.elements.integration_points(&ring.field);
            self.add_near_field(recovery, ring, &mut stress);
            for cell in stress.chunks_exact(recovery.elements.points_per_element()) {
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
        }
    }
}

impl Recovery {
    fn new(ring: &RingModel, kind: StressOutput, reach: Option<f64>) -> Result<Recovery, Failure> {
        let elements = StressRecovery::new(&ring.mesh, &ring.material)?;
        let near_field = reach.map(|reach| {
            let poisson_ratio = ring.material.poisson_ratio;
            match kind {
                StressOutput::IntegrationPoints => {
                    NearField::new(ring.groove, poisson_ratio, reach, &elements.point_positions())
                }
                _ => NearField::new(ring.groove, poisson_ratio, reach, &ring.mesh.nodes),
            }
        });
        Ok(Recovery {
            elements,
            nodal: None,
            near_field,
        })
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
            nodes: reference_nodes(kind).to_vec(),
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
                Some(Recovery {
                    elements: StressRecovery::new(mesh, &steel).unwrap(),
                    nodal: None,
                    near_field: None,
                })
            }),
            n_balls: 1,
            near_field_time: AtomicU64::new(0),
        };
        let stretched = |mesh: &Mesh| mesh.nodes.iter().flat_map(|x| [1e-3 * x[0], 0.0, 0.0]).collect();
        let quarter = std::f64::consts::FRAC_PI_2;
        let shown = |field: Vec<f64>, angle: f64| {
            Some(ShownRing {
                field,
                turn: Turn::new(angle),
                patches: Vec::new(),
            })
        };
        let fields = [
            shown(stretched(&meshes[0]), quarter),
            shown(stretched(&meshes[1]), 0.0),
        ];
        let found = stress.fields(&fields);
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
