//! What a periodic mesh would gain where a ring's mesh is free but its shape is a body of revolution.
//!
//! Time of a step and memory of factors are power laws through measured rings of one sparse factor and of equal sectors
//! (docs/dev/performance.md): they tell orders of magnitude. Cost of finding out: one sort of the faces of a free mesh.

use contact::Side;
use dynamics::{Model, RingModel};
use input::shell_word;
use mesh::{REVOLVED_TOLERANCE, is_revolved};
use scene::Scene;

/// c n^p through two measured rings of n dofs.
struct PowerLaw {
    dofs: [f64; 2],
    values: [f64; 2],
}

impl PowerLaw {
    fn at(&self, dofs: f64) -> f64 {
        let [a, b] = self.dofs;
        let exponent = (self.values[1] / self.values[0]).ln() / (b / a).ln();
        self.values[0] * (dofs / a).powf(exponent)
    }
}

/// Step of a ring with one sparse factor, two threads, ms: "Rings of free meshes", less the other ring.
const FREE_STEP: PowerLaw = PowerLaw {
    dofs: [88_278.0, 413_631.0],
    values: [31.0, 174.0],
};
/// Its factor, MB.
const FREE_MEMORY: PowerLaw = PowerLaw {
    dofs: [88_278.0, 413_631.0],
    values: [180.0, 1712.0],
};
/// Step of a ring of equal sectors, two threads, ms: "Measured", half of both rings.
const PERIODIC_STEP: PowerLaw = PowerLaw {
    dofs: [57_000.0, 410_000.0],
    values: [1.55, 5.5],
};
/// Its factors and tables, MB.
const PERIODIC_MEMORY: PowerLaw = PowerLaw {
    dofs: [57_000.0, 410_000.0],
    values: [7.5, 59.0],
};
/// Sectors from ball to ball that the command proposes, those of the meshes of the static scenes.
const SECTORS_PER_BALL: usize = 10;
/// Names of length units, m.
const UNITS: [(&str, f64); 3] = [("m", 1.0), ("cm", 1e-2), ("um", 1e-6)];

/// A sentence for each ring whose mesh is free but whose shape is a body of revolution.
pub fn advice(scene: &Scene, model: &Model) -> Vec<String> {
    let of_side = |(side, table): (Side, &scene::Ring)| {
        let (ring, body) = (model.ring(side)?, table.body.as_ref()?);
        if !is_free(ring) {
            return None;
        }
        let radii = ring.mesh.nodes.iter().map(|x| x[0].hypot(x[1]));
        let tolerance = REVOLVED_TOLERANCE * radii.fold(0.0, f64::max);
        if !is_revolved(&ring.mesh, tolerance) {
            return None;
        }
        let unit = UNITS.iter().find(|(_, unit)| *unit == body.mesh_unit);
        let unit = unit.map_or(String::new(), |(name, _)| format!(" --mesh-unit {name}"));
        let n = ring.mesh.n_dofs() as f64;
        Some(format!(
            "the {} ring is a body of revolution, but its mesh has no equal sectors; a step in time takes about \
             {:.0} ms and {:.0} MB of factors, with a periodic mesh of as many dofs about {:.1} ms and {:.0} MB \
             (two cores of an AMD EPYC): raceway mesh --revolve-like {} --sectors {}{unit}",
            side.name(),
            FREE_STEP.at(n),
            FREE_MEMORY.at(n),
            PERIODIC_STEP.at(n),
            PERIODIC_MEMORY.at(n),
            shell_word(body.mesh.display()),
            SECTORS_PER_BALL * model.geometry.n_balls
        ))
    };
    Side::BOTH
        .into_iter()
        .zip([&scene.inner, &scene.outer])
        .filter_map(of_side)
        .collect()
}

/// Whether a ring is neither periodic nor so up to a defect; a part of a ring on a rank is not asked.
fn is_free(ring: &RingModel) -> bool {
    let nodes = &ring.mesh.nodes;
    let is_whole = ring.is_whole() && nodes.n_kept() == nodes.len();
    is_whole && ring.periodicity().is_err() && ring.nearly_periodic().is_err()
}
