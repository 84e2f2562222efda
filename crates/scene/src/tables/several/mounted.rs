//! A table `[[bearing]]`: a bearing of a type at its place on the shaft.

use assembly::Orientation;
use input::{ANGLE, LENGTH, Problems, Quantity};
use serde::Deserialize;

use super::super::Scene;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table [[bearing]] with name, position, orientation and type"
)]
pub struct RawMounted {
    pub name: String,
    pub position: Quantity<LENGTH>,
    pub orientation: String,
    pub r#type: String,
    pub first_ball_azimuth: Option<Quantity<ANGLE>>,
}

/// A bearing of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct BearingOnShaft {
    /// Its name; that of its folder of results too.
    pub name: String,
    /// Position of the plane of its inner groove centres along the shaft, m.
    pub position: f64,
    /// Which way it is turned.
    pub orientation: Orientation,
    /// The file of its type, as typed.
    pub type_file: String,
    /// The bearing as a scene of its own, in its own frame: its shaft is prescribed, and nothing loads that.
    pub scene: Scene,
}

/// Name of the folder of figures that a run has itself.
const FIGURES: &str = "figures";
/// What folders of steps that a run took back begin with.
const SUPERSEDED: &str = "superseded";

impl RawMounted {
    /// Its direction, checked.
    pub fn orientation(&self) -> Option<Orientation> {
        Orientation::named(&self.orientation)
    }

    /// Whether a scene with one table has it too.
    pub fn is_plain(&self) -> bool {
        self.position.si() == 0.0 && self.orientation == "+z"
    }

    /// Checks its own keys; `number` counts from 1.
    pub fn check(&self, number: usize, problems: &mut Problems) {
        let letters = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let is_name = !self.name.is_empty() && self.name.chars().all(letters);
        let (key, name) = (
            format!("bearing.name of bearing {number}"),
            format!("{:?}", self.name),
        );
        problems.require(
            self.name != FIGURES && !self.name.starts_with(SUPERSEDED),
            &key,
            &name,
            "this name is reserved: the folder of a run has \"figures\" and \"superseded_1\" itself; expected a name \
             that is not \"figures\" and does not begin with \"superseded\"",
        );
        problems.require(
            is_name,
            &key,
            &name,
            "expected letters, digits, _ and -, such as \"front\": its results have a folder of that name",
        );
        problems.require(
            self.orientation().is_some(),
            &format!("bearing.orientation of {:?}", self.name),
            format!("{:?}", self.orientation),
            "expected \"+z\", pressed by a force on the shaft along +z, or \"-z\"",
        );
    }
}

/// Two bearings of one name, and bearings that lie in each other.
pub fn check_places(raw: &[RawMounted], scenes: &[Option<Scene>], problems: &mut Problems) {
    for (i, bearing) in raw.iter().enumerate() {
        if raw[..i].iter().any(|other| other.name == bearing.name) {
            problems.add(format!(
                "bearing.name {:?} stands twice; expected a name of its own for each bearing",
                bearing.name
            ));
        }
        for (other, scene) in raw[..i].iter().zip(scenes) {
            let (Some(a), Some(b)) = (scene, &scenes[i]) else {
                continue;
            };
            // Groove centres lie off the middle of the balls by less than the distance of the grooves.
            let slack = [a, b].map(|s| s.bearing.inner_groove_radius - 0.5 * s.bearing.ball_diameter);
            let needed = 0.5 * (a.bearing.width + b.bearing.width) - slack[0] - slack[1];
            let apart = (bearing.position.si() - other.position.si()).abs();
            if apart < needed {
                problems.add(format!(
                    "bearing.position: {:?} at {} and {:?} at {} overlap: they are {:.3} mm apart and {:.3} mm wide; \
                     expected at least {:.3} mm",
                    other.name,
                    other.position,
                    bearing.name,
                    bearing.position,
                    1e3 * apart,
                    1e3 * 0.5 * (a.bearing.width + b.bearing.width),
                    1e3 * needed
                ));
            }
        }
    }
}
