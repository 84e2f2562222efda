//! `[inner.section]` and `[outer.section]`: the meshes that `raceway mesh` builds.
//!
//! Shoulders that a scene does not give are alike on both sides of the groove. Each stands h above its bottom,
//! h = max(0.2 D_w, R (1 - cos(a0 + 20 deg))) with groove radius R and free contact angle a0: the height of deep groove
//! bearings, or more, so that the edge of the groove is 20 degrees beyond the contact. It is a rule of this program; a
//! low shoulder or a counterbore has to be given.

use input::{LENGTH, Problems, Quantity, ten_digits};
use mesh::{RingSection, RingSide};
use serde::Deserialize;

use super::bearing::Bearing;
use super::ring_name::RingName;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of a ring's section")]
pub struct RawSection {
    shoulder_diameters: Option<[Quantity<LENGTH>; 2]>,
    element: SectionElement,
    sectors: i64,
    groove_elements: i64,
    thickness_elements: i64,
    shoulder_elements: i64,
    grading: Option<f64>,
}

/// Elements that `raceway mesh` can build.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum SectionElement {
    /// Trilinear hexahedra, revolved.
    Hex8,
    /// Serendipity hexahedra, revolved, mid-nodes on the torus.
    Hex20,
    /// Quadratic tetrahedra of Gmsh; not rotationally periodic.
    Tet10,
}

/// Diameters of the shoulders beside a groove, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShoulderDiameters {
    /// On the side of lower z.
    pub at_low_z: f64,
    /// On the side of higher z.
    pub at_high_z: f64,
}

/// A ring's section and the fineness of its mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshedSection {
    /// Diameters of the shoulders beside the groove.
    pub shoulder_diameters: ShoulderDiameters,
    /// Element kind.
    pub element: SectionElement,
    /// Elements round the ring, a multiple of the number of balls.
    pub sectors: usize,
    /// Elements across the groove.
    pub groove_elements: usize,
    /// Elements through the thickness.
    pub thickness_elements: usize,
    /// Elements along each shoulder.
    pub shoulder_elements: usize,
    /// Ratio of neighbouring element sizes through the thickness, finer towards the raceway; 1 is uniform.
    pub grading: f64,
}

/// Least height of a shoulder without a given diameter, over the ball diameter.
const SHOULDER_HEIGHT: f64 = 0.2;
/// Angle from the free contact to the edge of such a shoulder, rad: 20 degrees.
const BEYOND_CONTACT: f64 = std::f64::consts::PI / 9.0;
/// Largest growth from one element to the next.
const MOST_GRADING: f64 = 3.0;
/// Most by which sizes of elements through the thickness may differ.
const LARGEST_SHARE: f64 = 1e4;
/// More elements than this in one direction is a slip of the keyboard.
const MAX_ELEMENTS: i64 = 1000;
/// The same round the ring.
const MAX_SECTORS: i64 = 100_000;

impl MeshedSection {
    /// Measures of the ring that it is the section of.
    pub fn measures(&self, bearing: &Bearing, ring: RingName) -> RingSection {
        let (side, seat_diameter, raceway_diameter, groove_radius) = match ring {
            RingName::Inner => (
                RingSide::Inner,
                bearing.bore_diameter,
                bearing.inner_raceway_diameter,
                bearing.inner_groove_radius,
            ),
            RingName::Outer => (
                RingSide::Outer,
                bearing.outside_diameter,
                bearing.outer_raceway_diameter,
                bearing.outer_groove_radius,
            ),
        };
        let shoulders = self.shoulder_diameters;
        RingSection {
            side,
            seat_diameter,
            raceway_diameter,
            groove_radius,
            shoulder_diameters: [shoulders.at_low_z, shoulders.at_high_z],
            width: bearing.width,
            groove_offset: 0.0,
            groove_elements: self.groove_elements,
            thickness_elements: self.thickness_elements,
            shoulder_elements: [self.shoulder_elements; 2],
            grading: self.grading,
        }
    }
}

impl RawSection {
    /// Checks the section of `ring`; the bearing is there when it is sound. `assumed` is told shoulders that are not
    /// given.
    pub fn check(
        &self,
        ring: RingName,
        bearing: Option<&Bearing>,
        problems: &mut Problems,
        assumed: &mut Vec<String>,
    ) -> MeshedSection {
        let table = format!("{}.section", ring.key());
        let whole = |problems: &mut Problems, value, name: &str, min, max| {
            problems.whole(value, &format!("{table}.{name}"), min, max)
        };
        let sectors = whole(problems, self.sectors, "sectors", 3, MAX_SECTORS);
        if let Some(bearing) = bearing {
            self.check_sectors(ring, bearing.balls, problems);
            self.check_shoulders(ring, bearing, problems);
        }
        let groove_elements = whole(problems, self.groove_elements, "groove_elements", 2, MAX_ELEMENTS);
        let thickness_elements = whole(
            problems,
            self.thickness_elements,
            "thickness_elements",
            1,
            MAX_ELEMENTS,
        );
        let shoulder_elements = whole(
            problems,
            self.shoulder_elements,
            "shoulder_elements",
            1,
            MAX_ELEMENTS,
        );
        let grading = self.grading.unwrap_or(1.0);
        let key = format!("{table}.grading");
        problems.require(
            (1.0..=MOST_GRADING).contains(&grading),
            &key,
            grading,
            "expected 1 (uniform) to 3",
        );
        check_growth(grading, thickness_elements, &key, problems);
        let [at_low_z, at_high_z] = match (bearing, &self.shoulder_diameters) {
            (None, _) => [0.0; 2],
            (_, Some(typed)) => typed.each_ref().map(|diameter| diameter.si()),
            (Some(bearing), None) => [shoulder_by_rule(ring, bearing, assumed); 2],
        };
        MeshedSection {
            shoulder_diameters: ShoulderDiameters { at_low_z, at_high_z },
            element: self.element,
            sectors,
            groove_elements,
            thickness_elements,
            shoulder_elements,
            grading,
        }
    }

    /// The mesh must repeat from ball to ball.
    fn check_sectors(&self, ring: RingName, balls: usize, problems: &mut Problems) {
        let Ok(sectors) = usize::try_from(self.sectors) else {
            return;
        };
        if sectors < 3 || sectors.is_multiple_of(balls) {
            return;
        }
        let below = sectors - sectors % balls;
        let near = if below == 0 {
            String::new()
        } else {
            format!("{below} or ")
        };
        problems.add(format!(
            "{}.section.sectors is {sectors}; it must be a multiple of the {balls} balls, such as {near}{}, so that \
             every ball meets the same mesh",
            ring.key(),
            below + balls
        ));
    }

    /// A shoulder lies between the bottom of the groove and the circle of groove centres.
    fn check_shoulders(&self, ring: RingName, bearing: &Bearing, problems: &mut Problems) {
        let (low, high) = match ring {
            RingName::Inner => {
                let bottom = bearing.inner_raceway_diameter;
                (bottom, bottom + 2.0 * bearing.inner_groove_radius)
            }
            RingName::Outer => {
                let bottom = bearing.outer_raceway_diameter;
                (bottom - 2.0 * bearing.outer_groove_radius, bottom)
            }
        };
        for (i, diameter) in self.shoulder_diameters.iter().flatten().enumerate() {
            problems.require(
                low < diameter.si() && diameter.si() < high,
                &format!("{}.section.shoulder_diameters[{i}]", ring.key()),
                diameter,
                format!(
                    "a shoulder must lie between the bottom and the centre of the groove, {} to {}",
                    Quantity::<LENGTH>::about(low),
                    Quantity::<LENGTH>::about(high),
                ),
            );
        }
    }
}

/// Elements through the thickness must not grow so much that nodes beside the groove are at one place.
fn check_growth(grading: f64, thickness_elements: usize, key: &str, problems: &mut Problems) {
    let growths = thickness_elements.saturating_sub(1).max(1) as f64;
    let most = (1e3 * LARGEST_SHARE.powf(1.0 / growths)).floor() / 1e3;
    let rule = format!(
        "with {thickness_elements} thickness_elements the last would be {:.1e} times the first; expected at most \
         {LARGEST_SHARE:.0e} times: a grading of at most {most}, or fewer thickness_elements",
        grading.powf(growths)
    );
    let is_too_much = grading > most && grading <= MOST_GRADING;
    problems.require(!is_too_much, key, grading, rule);
}

/// Diameter of the shoulders, m, by the rule above.
fn shoulder_by_rule(ring: RingName, bearing: &Bearing, assumed: &mut Vec<String>) -> f64 {
    let (bottom, groove, inwards) = match ring {
        RingName::Inner => (bearing.inner_raceway_diameter, bearing.inner_groove_radius, 1.0),
        RingName::Outer => (bearing.outer_raceway_diameter, bearing.outer_groove_radius, -1.0),
    };
    let edge = bearing.free_contact_angle() + BEYOND_CONTACT;
    let height = (groove * (1.0 - edge.cos())).max(SHOULDER_HEIGHT * bearing.ball_diameter);
    let diameter = ten_digits(bottom + inwards * 2.0 * height);
    assumed.push(format!(
        "{}.section.shoulder_diameters are {:.4} mm on both sides, {:.2} ball diameters above the groove; a catalogue \
         or a drawing may give others",
        ring.key(),
        1e3 * diameter,
        height / bearing.ball_diameter
    ));
    diameter
}

/// The shoulders of the two rings face each other across the cage: they must not meet.
pub fn check_gap(inner: &MeshedSection, outer: &MeshedSection, problems: &mut Problems) {
    let (inner, outer) = (inner.shoulder_diameters, outer.shoulder_diameters);
    let below = (inner.at_low_z, outer.at_low_z);
    let above = (inner.at_high_z, outer.at_high_z);
    for (i, (a, b)) in [below, above].into_iter().enumerate() {
        problems.require(
            a < b,
            &format!("inner.section.shoulder_diameters[{i}]"),
            Quantity::<LENGTH>::about(a),
            format!(
                "it must be less than outer.section.shoulder_diameters[{i}], which is {}, or the rings touch",
                Quantity::<LENGTH>::about(b)
            ),
        );
    }
}
