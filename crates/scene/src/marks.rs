//! Marks of a scene's raceways, and whether their meshes have a raceway under them.
//!
//! A spall may be missing of the mesh or of the profile, not of both: it would count twice. Only whole meshes tell, so
//! that this is checked where they have been read, before ranks share them.

use std::f64::consts::TAU;

use contact::surface::{Dent, Heights, Spall};
use contact::{BearingGeometry, Profiles, RacewaySurface, Side};
use dynamics::{RACEWAY_GROUP, RingModel};

use crate::error::BuildError;
use crate::tables::{FlexibleRing, Scene};

/// Azimuths and groove angles at which a raceway is looked for holes: none of the size of an element is missed by
/// fewer than 700 sectors.
const SAMPLES: [usize; 2] = [1440, 33];

/// A spall or a dent: where it lies on its groove.
pub struct Mark {
    /// Such as "spall 1".
    pub name: String,
    /// Of the scene.
    pub table: &'static str,
    /// Azimuth of its middle on the ring, rad.
    pub azimuth: f64,
    /// Groove angle of its middle, rad.
    pub groove_angle: f64,
    /// Along the track, m.
    pub length: f64,
    /// Across it, m.
    pub width: f64,
}

/// The spalls and dents of a raceway.
pub fn marks(profiles: &Profiles) -> Vec<Mark> {
    let spall = |(spall, number): (&Spall, usize)| Mark {
        name: format!("spall {number}"),
        table: "spall",
        azimuth: spall.azimuth,
        groove_angle: spall.groove_angle,
        length: spall.length,
        width: spall.width,
    };
    let dent = |(dent, number): (&Dent, usize)| Mark {
        name: format!("dent {number}"),
        table: "dent",
        azimuth: dent.azimuth,
        groove_angle: dent.groove_angle,
        length: 2.0 * dent.reach(),
        width: 2.0 * dent.reach(),
    };
    let spalls = profiles.spalls.iter().zip(1..).map(spall);
    spalls.chain(profiles.dents.iter().zip(1..).map(dent)).collect()
}

/// Fails where a whole mesh has no raceway under a spall, a dent or the depth of a table.
pub fn require_raceway_under_marks(
    scene: &Scene,
    geometry: &BearingGeometry,
    side: Side,
    ring: &RingModel,
) -> Result<(), BuildError> {
    let body = [&scene.inner, &scene.outer][side.index()].body.as_ref();
    let is_whole = |body: &FlexibleRing| body.cuts.is_empty() && !body.is_partial;
    let profiles = &scene.profiles.raceways[side.index()];
    let has_marks = !(profiles.spalls.is_empty() && profiles.dents.is_empty() && profiles.tables.is_empty());
    if !has_marks || body.is_none_or(is_whole) {
        return Ok(());
    }
    let raceway = MeshedRaceway {
        surface: RacewaySurface::new(&ring.mesh, ring.mesh.group(RACEWAY_GROUP), ring.groove),
        radius: geometry.centre_radius(side) + side.sign() * geometry.groove_radius(side),
        groove_radius: geometry.groove_radius(side),
    };
    let gaps = raceway.gaps();
    let marks = marks(profiles);
    let mark = marks.iter().find(|mark| raceway.lacks(mark, &gaps));
    let table = profiles.tables.iter().position(|table| is_deep(table, &gaps));
    let (what, remedy) = match (mark, table) {
        (Some(mark), _) => (
            mark.name.clone(),
            format!("the [[{}.cut]] or the [[profiles.{}]]", side.name(), mark.table),
        ),
        (None, Some(table)) => (
            format!("the depth of table {}", table + 1),
            format!("the [[{}.cut]], or give heights of 0 or more there", side.name()),
        ),
        (None, None) => return Ok(()),
    };
    Err(BuildError::Surface {
        path: scene.path.clone(),
        problem: format!(
            "{what} of the {} ring lies where its mesh has no raceway: it would count twice; leave out {remedy}",
            side.name()
        ),
    })
}

/// Whether a table has missing material at one of these azimuths and groove angles, rad.
fn is_deep(table: &Heights, gaps: &[[f64; 2]]) -> bool {
    gaps.iter()
        .any(|&[azimuth, angle]| table.height(azimuth, angle) < 0.0)
}

/// The raceway of a mesh that may have holes.
struct MeshedRaceway {
    surface: RacewaySurface,
    /// Of its track from the axis, m.
    radius: f64,
    groove_radius: f64,
}

impl MeshedRaceway {
    fn is_missing(&self, azimuth: f64, angle: f64) -> bool {
        self.surface.locate(azimuth, angle).is_err()
    }

    /// Azimuths and groove angles, rad, of a grid at which there is none.
    fn gaps(&self) -> Vec<[f64; 2]> {
        let (low, high) = self.surface.angle_range.clone().into_inner();
        let azimuths = (0..SAMPLES[0]).map(|i| TAU * i as f64 / SAMPLES[0] as f64);
        // Points on the rims themselves are outside by round-off.
        let angle = move |i: usize| low + (high - low) * (i as f64 + 0.5) / SAMPLES[1] as f64;
        let points = azimuths.flat_map(|azimuth| (0..SAMPLES[1]).map(move |i| [azimuth, angle(i)]));
        points
            .filter(|[azimuth, angle]| self.is_missing(*azimuth, *angle))
            .collect()
    }

    /// Whether there is none somewhere under a mark.
    fn lacks(&self, mark: &Mark, gaps: &[[f64; 2]]) -> bool {
        let half = [mark.length / self.radius, mark.width / self.groove_radius].map(|size| 0.5 * size);
        let (low, high) = self.surface.angle_range.clone().into_inner();
        let turned = |azimuth: f64| (azimuth - mark.azimuth + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        let covers = |[azimuth, angle]: &[f64; 2]| {
            turned(*azimuth).abs() <= half[0] && (angle - mark.groove_angle).abs() <= half[1]
        };
        let shares = [-1.0, -0.5, 0.0, 0.5, 1.0];
        let is_missing = |along: f64, across: f64| {
            let angle = (mark.groove_angle + across * half[1]).clamp(low, high);
            self.is_missing(mark.azimuth + along * half[0], angle)
        };
        // A small mark lies between the points of the grid, a hole between those of a long one.
        gaps.iter().any(covers) || shares.iter().any(|&a| shares.iter().any(|&b| is_missing(a, b)))
    }
}
