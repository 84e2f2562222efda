//! `[inner.section]` and `[outer.section]`: the meshes that `raceway mesh` builds.

use input::{LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::bearing::Bearing;
use super::ring::RingName;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of a ring's section")]
pub struct RawSection {
    shoulder_diameters: [Quantity<LENGTH>; 2],
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

/// A ring's section and the fineness of its mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Diameters of the shoulders beside the groove, m, at -z and at +z.
    pub shoulder_diameters: [f64; 2],
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

/// More elements than this in one direction is a slip of the keyboard.
const MAX_ELEMENTS: i64 = 1000;
/// The same round the ring.
const MAX_SECTORS: i64 = 100_000;

impl RawSection {
    /// Checks the section of `ring`; the bearing is there when it is sound.
    pub fn check(&self, ring: RingName, bearing: Option<&Bearing>, problems: &mut Problems) -> Section {
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
            (1.0..=3.0).contains(&grading),
            &key,
            grading,
            "expected 1 (uniform) to 3",
        );
        Section {
            shoulder_diameters: [self.shoulder_diameters[0].si(), self.shoulder_diameters[1].si()],
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
        for (i, diameter) in self.shoulder_diameters.iter().enumerate() {
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

/// The shoulders of the two rings face each other across the cage: they must not meet.
pub fn check_gap(inner: &Section, outer: &Section, problems: &mut Problems) {
    for (i, (a, b)) in inner
        .shoulder_diameters
        .iter()
        .zip(outer.shoulder_diameters)
        .enumerate()
    {
        problems.require(
            *a < b,
            &format!("inner.section.shoulder_diameters[{i}]"),
            Quantity::<LENGTH>::about(*a),
            format!(
                "it must be less than outer.section.shoulder_diameters[{i}], which is {}, or the rings touch",
                Quantity::<LENGTH>::about(b)
            ),
        );
    }
}
