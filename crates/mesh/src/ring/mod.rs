//! The measures of a ring, checked, and what follows from them: its groove, its section, its geometry files.
//!
//! The groove is a full circular arc between two shoulders; corner radii and chamfers are left out, they carry no
//! load. The plane of groove centres is z = 0 of the file.

mod geo;
mod geometry;
mod moments;

use crate::error::MeshError;

pub(crate) use geo::section_head;
pub use geo::{ring_geo, ring_tet_geo};
pub use geometry::RingGeometry;
pub use moments::VolumeMoments;

/// Which ring it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingSide {
    /// Groove outside, bore inside.
    Inner,
    /// Groove inside, seat outside.
    Outer,
}

impl RingSide {
    /// Name of the surface opposite to the raceway: `bore` of the inner ring, `seat` of the outer.
    pub fn seat_group(self) -> &'static str {
        match self {
            RingSide::Inner => "bore",
            RingSide::Outer => "seat",
        }
    }

    /// +1 when the ring's body lies outside the groove, -1 when inside.
    pub(crate) fn sign(self) -> f64 {
        match self {
            RingSide::Inner => -1.0,
            RingSide::Outer => 1.0,
        }
    }
}

/// Section of a ring and how finely it is divided.
#[derive(Clone, Debug, PartialEq)]
pub struct RingSection {
    /// Inner or outer ring.
    pub side: RingSide,
    /// Bore diameter of the inner, outside diameter of the outer ring, m.
    pub seat_diameter: f64,
    /// Diameter at the groove bottom, m.
    pub raceway_diameter: f64,
    /// Groove radius, m.
    pub groove_radius: f64,
    /// Shoulder diameters at -z and at +z, m; they may differ.
    pub shoulder_diameters: [f64; 2],
    /// Width of the ring, m.
    pub width: f64,
    /// Axial position of the groove centres above the middle of the width, m.
    pub groove_offset: f64,
    /// Elements across the whole groove, at least 2.
    pub groove_elements: usize,
    /// Elements from the raceway to the seat.
    pub thickness_elements: usize,
    /// Elements along each shoulder, at -z and at +z.
    pub shoulder_elements: [usize; 2],
    /// Growth of the element size from the raceway to the seat, each against the one before; 1 is even.
    pub grading: f64,
}

/// The shallowest shoulder, as a share of the groove radius: its half of the groove spans 2.6 degrees.
const SHALLOWEST: f64 = 1e-3;

impl RingSection {
    /// Checks that the measures make a ring; the message names the first one that does not.
    pub fn validate(&self) -> Result<(), MeshError> {
        self.check_numbers()?;
        self.check_groove()?;
        self.check_shoulders()
    }

    fn check_numbers(&self) -> Result<(), MeshError> {
        let lengths = [
            ("seat_diameter", self.seat_diameter),
            ("raceway_diameter", self.raceway_diameter),
            ("groove_radius", self.groove_radius),
            ("shoulder_diameters[0]", self.shoulder_diameters[0]),
            ("shoulder_diameters[1]", self.shoulder_diameters[1]),
            ("width", self.width),
        ];
        for (name, value) in lengths {
            if !(value.is_finite() && value > 0.0) {
                return Err(bad_length(name, value, "expected a positive length".to_string()));
            }
        }
        if !self.groove_offset.is_finite() {
            return Err(bad_length(
                "groove_offset",
                self.groove_offset,
                "expected a finite length".to_string(),
            ));
        }
        let counts = [
            ("groove_elements", self.groove_elements, 2),
            ("thickness_elements", self.thickness_elements, 1),
            ("shoulder_elements[0]", self.shoulder_elements[0], 1),
            ("shoulder_elements[1]", self.shoulder_elements[1], 1),
        ];
        for (name, value, least) in counts {
            if value < least || value > 10_000 {
                let expected = format!("expected between {least} and 10000 elements");
                return Err(MeshError::Measure {
                    name,
                    value: value.to_string(),
                    expected,
                });
            }
        }
        if !(0.2..=5.0).contains(&self.grading) {
            let expected = "expected a growth per element between 0.2 and 5, such as 1.3".to_string();
            return Err(MeshError::Measure {
                name: "grading",
                value: self.grading.to_string(),
                expected,
            });
        }
        Ok(())
    }

    /// The groove bottom must leave material before the seat.
    fn check_groove(&self) -> Result<(), MeshError> {
        let thickness = 0.5 * self.side.sign() * (self.seat_diameter - self.raceway_diameter);
        if thickness > 0.0 {
            return Ok(());
        }
        let relation = if self.side == RingSide::Inner {
            "above"
        } else {
            "below"
        };
        let expected = format!(
            "expected {relation} the seat_diameter of {}, else the groove is deeper than the ring is thick",
            millimetres(self.seat_diameter)
        );
        Err(bad_length("raceway_diameter", self.raceway_diameter, expected))
    }

    /// Each shoulder must end the groove between its bottom and its centre, before the face.
    fn check_shoulders(&self) -> Result<(), MeshError> {
        let names = ["shoulder_diameters[0]", "shoulder_diameters[1]"];
        let geometry = self.geometry_unchecked();
        let limits = [2.0 * geometry.centre_radius, self.raceway_diameter].map(millimetres);
        for i in 0..2 {
            let depth = 0.5 * self.side.sign() * (self.raceway_diameter - self.shoulder_diameters[i]);
            if !(depth < self.groove_radius && depth >= SHALLOWEST * self.groove_radius) {
                let expected = format!(
                    "expected between the groove centres' {} and the groove bottom's {} (with {} of depth at least)",
                    limits[0],
                    limits[1],
                    millimetres(SHALLOWEST * self.groove_radius)
                );
                return Err(bad_length(names[i], self.shoulder_diameters[i], expected));
            }
            let land = geometry.face_z[i].abs() - geometry.groove_z[i].abs();
            let is_inside = (geometry.face_z[i] > 0.0) == (i == 1) && land > 0.0;
            if !is_inside {
                let expected = format!(
                    "with the groove {} off the middle it leaves no shoulder at {}z: the face is at z = {}, the groove \
                     ends at z = {}; widen the ring or lower that shoulder",
                    millimetres(self.groove_offset),
                    ["-", "+"][i],
                    millimetres(geometry.face_z[i]),
                    millimetres(geometry.groove_z[i])
                );
                return Err(bad_length("width", self.width, expected));
            }
        }
        Ok(())
    }
}

fn bad_length(name: &'static str, value: f64, expected: String) -> MeshError {
    MeshError::Measure {
        name,
        value: millimetres(value),
        expected,
    }
}

/// A length in mm to 1e-9 mm, without needless zeros.
pub(crate) fn millimetre_digits(metres: f64) -> String {
    let text = format!("{:.9}", 1e3 * metres);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_string()
    } else {
        text.to_string()
    }
}

fn millimetres(metres: f64) -> String {
    format!("{} mm", millimetre_digits(metres))
}
