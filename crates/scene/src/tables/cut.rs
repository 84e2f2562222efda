//! `[[inner.cut]]` and `[[outer.cut]]`: parts of a ring's mesh that are left out, such as a keyway or a spall.
//!
//! ```toml
//! [[inner.cut]]                           # a keyway in the bore
//! azimuth = ["84 deg", "96 deg"]          # from the first towards +y to the second
//! radius = ["25 mm", "26.5 mm"]           # optional, default all
//! z = ["-8 mm", "8 mm"]                   # optional, in coordinates of the mesh, default all
//! ```
//! Elements whose centre, the mean of their nodes, lies in the region are no part of the ring. Their facets leave
//! their groups, and the faces that become free belong to none: walls of a keyway are not held.

use std::f64::consts::TAU;

use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::ring_name::RingName;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table of a part that is cut out of a ring"
)]
pub struct RawCut {
    azimuth: [Quantity<ANGLE>; 2],
    radius: Option<[Quantity<LENGTH>; 2]>,
    z: Option<[Quantity<LENGTH>; 2]>,
}

/// A region of a ring, from and to, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// rad; the second one is the larger one, by at most a turn.
    pub azimuth: [f64; 2],
    /// m.
    pub radius: [f64; 2],
    /// m.
    pub z: [f64; 2],
}

impl RawCut {
    /// Checks the `number`th cut, from 1, of a ring.
    pub fn check(&self, ring: RingName, number: usize, problems: &mut Problems) -> Cut {
        let key = format!("{}.cut {number}", ring.key());
        let azimuth = self.azimuth.each_ref().map(Quantity::si);
        let [from, to] = &self.azimuth;
        problems.require(
            azimuth[0] < azimuth[1] && azimuth[1] - azimuth[0] <= TAU,
            &format!("{key}: azimuth"),
            format!("{from} to {to}"),
            "expected a second azimuth beyond the first, by at most 360 deg",
        );
        let mut range = |name: &str, range: &Option<[Quantity<LENGTH>; 2]>| match range {
            None => [f64::NEG_INFINITY, f64::INFINITY],
            Some([from, to]) => {
                problems.require(
                    from.si() < to.si(),
                    &format!("{key}: {name}"),
                    format!("{from} to {to}"),
                    "expected the smaller value first",
                );
                [from.si(), to.si()]
            }
        };
        Cut {
            radius: range("radius", &self.radius),
            z: range("z", &self.z),
            azimuth,
        }
    }
}

impl Cut {
    /// Whether a point, m, lies in the region.
    pub fn holds(&self, [x, y, z]: [f64; 3]) -> bool {
        let within = |[from, to]: [f64; 2], value: f64| from <= value && value <= to;
        let [from, to] = self.azimuth;
        let beyond = (y.atan2(x) - from).rem_euclid(TAU);
        beyond <= to - from && within(self.radius, x.hypot(y)) && within(self.z, z)
    }
}
