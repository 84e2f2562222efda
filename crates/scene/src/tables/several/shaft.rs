//! `[shaft]` of a list of bearings: rigid or a beam, with loads and masses along it.

use assembly::{BeamSection, BeamShaft, PointMass};
use dynamics::model::MAX_TILT;
use fem::Material;
use input::{ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT, Problems, Quantity, Schedule};
use serde::Deserialize;

use super::super::materials::RawMaterial;
use super::super::shaft::{RawMotion, ShaftMotion};
use super::load::ShaftLoad;
use std::ops::RangeInclusive;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [shaft] of a list of bearings")]
pub struct RawCommonShaft {
    model: Option<String>,
    x: Option<RawMotion<LENGTH>>,
    y: Option<RawMotion<LENGTH>>,
    z: Option<RawMotion<LENGTH>>,
    tilt_x: Option<RawMotion<ANGLE>>,
    tilt_y: Option<RawMotion<ANGLE>>,
    load_point: Option<Quantity<LENGTH>>,
    mass: Option<RawMasses>,
    transverse_inertia: Option<Quantity<INERTIA>>,
    polar_inertia: Option<Quantity<INERTIA>>,
    material: Option<RawMaterial>,
    element_length: Option<Quantity<LENGTH>>,
    #[serde(default)]
    section: Vec<RawShaftSection>,
    #[serde(default)]
    load: Vec<RawLoad>,
}

/// As typed: `mass` of a rigid shaft, or a list of tables `[[shaft.mass]]`.
#[derive(Debug, Deserialize)]
#[serde(
    untagged,
    expecting = "a mass such as \"2 kg\", or tables [[shaft.mass]] with position and mass"
)]
enum RawMasses {
    Whole(Quantity<MASS>),
    Points(Vec<RawPointMass>),
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[shaft.section]]")]
struct RawShaftSection {
    from: Quantity<LENGTH>,
    to: Quantity<LENGTH>,
    outside: Quantity<LENGTH>,
    bore: Option<Quantity<LENGTH>>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[shaft.load]]")]
struct RawLoad {
    position: Quantity<LENGTH>,
    force: Option<[Quantity<FORCE>; 3]>,
    moment: Option<[Quantity<MOMENT>; 2]>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[shaft.mass]]")]
struct RawPointMass {
    position: Quantity<LENGTH>,
    mass: Quantity<MASS>,
    transverse_inertia: Option<Quantity<INERTIA>>,
    polar_inertia: Option<Quantity<INERTIA>>,
}

/// The shaft that the bearings carry.
#[derive(Clone, Debug, PartialEq)]
pub struct CommonShaft {
    /// What it is.
    pub kind: ShaftKind,
    /// Position at which the forces of effects act, m.
    pub load_point: f64,
    /// Loads along it.
    pub loads: Vec<ShaftLoad>,
    /// Masses along it.
    pub masses: Vec<PointMass>,
    /// Numbers that a name stands for.
    pub assumed: Vec<String>,
}

/// Rigid, or a beam.
#[derive(Clone, Debug, PartialEq)]
pub enum ShaftKind {
    /// Five dofs at position 0.
    Rigid(RigidShaft),
    /// Beam elements, held by the bearings alone.
    Beam(BeamShaft),
}

/// Freedoms and inertia of a rigid shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidShaft {
    /// Motions x, y, z, tilt x, tilt y of the axis point at position 0.
    pub motions: [ShaftMotion; 5],
    /// Mass besides that along it, kg; its weight acts at the load point.
    pub mass: f64,
    /// Its moment of inertia about x and y through position 0, kg m^2.
    pub transverse: f64,
    /// Its moment of inertia about z, kg m^2.
    pub polar: f64,
}

/// Positions farther away are slips of the unit, m.
const MAX_POSITION: f64 = 100.0;
/// Elements for the default: as many along the shaft.
const ELEMENTS: f64 = 40.0;
/// Ends of sections nearer than this over the length of the shaft are the same.
const SAME_PLACE: f64 = 1e-9;
const MODELS: &str = "expected \"rigid\" or \"beam\"";

impl RawCommonShaft {
    /// Whether a scene with one bearing has such a shaft.
    pub fn is_plain(&self) -> bool {
        let is_rigid = self.model.as_deref().is_none_or(|model| model == "rigid");
        is_rigid
            && self.section.is_empty()
            && self.load.is_empty()
            && self.material.is_none()
            && self.element_length.is_none()
            && !matches!(self.mass, Some(RawMasses::Points(_)))
    }

    /// Checks everything; `largest_ball` limits prescribed displacements, m.
    pub fn check(&self, largest_ball: f64, problems: &mut Problems) -> Option<CommonShaft> {
        let mut assumed = Vec::new();
        let kind = match self.model.as_deref() {
            None => {
                problems.add(format!("shaft.model is missing; {MODELS}"));
                None
            }
            Some("rigid") => Some(ShaftKind::Rigid(self.rigid(largest_ball, problems))),
            Some("beam") => self.beam(problems, &mut assumed).map(ShaftKind::Beam),
            Some(other) => {
                problems.add(format!("shaft.model is {other:?}; {MODELS}"));
                None
            }
        };
        let load_point = self.load_point.as_ref().map_or(0.0, Quantity::si);
        let shaft = CommonShaft {
            kind: kind?,
            load_point,
            loads: self.load.iter().map(RawLoad::load).collect(),
            masses: self.masses(problems),
            assumed,
        };
        self.check_positions(&shaft, problems);
        Some(shaft)
    }

    fn rigid(&self, largest_ball: f64, problems: &mut Problems) -> RigidShaft {
        self.check_rigid_keys(problems);
        // Without a sound bearing there is no ball to compare with.
        let largest_ball = if largest_ball > 0.0 {
            largest_ball
        } else {
            f64::INFINITY
        };
        let rule = "a prescribed displacement must be less than a ball radius";
        for (key, motion) in [("shaft.x", &self.x), ("shaft.y", &self.y), ("shaft.z", &self.z)] {
            check_motion(motion, key, 0.5 * largest_ball, rule, problems);
        }
        for (key, motion) in [("shaft.tilt_x", &self.tilt_x), ("shaft.tilt_y", &self.tilt_y)] {
            check_motion(
                motion,
                key,
                MAX_TILT,
                "a prescribed tilt must be small, at most 55 mrad",
                problems,
            );
        }
        RigidShaft {
            motions: [
                motion(&self.x),
                motion(&self.y),
                motion(&self.z),
                motion(&self.tilt_x),
                motion(&self.tilt_y),
            ],
            mass: match &self.mass {
                Some(RawMasses::Whole(mass)) => {
                    let rule = "expected 0 to 1e6 kg, what turns with the inner rings beside them";
                    problems.require((0.0..=1e6).contains(&mass.si()), "shaft.mass", mass, rule);
                    mass.si()
                }
                _ => 0.0,
            },
            transverse: self.transverse_inertia.as_ref().map_or(0.0, Quantity::si),
            polar: self.polar_inertia.as_ref().map_or(0.0, Quantity::si),
        }
    }

    /// Reports keys that only a beam has, and motions that are missing.
    fn check_rigid_keys(&self, problems: &mut Problems) {
        let beam_only = [
            ("section", !self.section.is_empty()),
            ("material", self.material.is_some()),
            ("element_length", self.element_length.is_some()),
        ];
        for (key, _) in beam_only.iter().filter(|(_, is_there)| *is_there) {
            problems.add(format!(
                "shaft.{key} is for shaft.model = \"beam\"; remove it, or write \"beam\""
            ));
        }
        let missing: Vec<&str> = [
            ("x", self.x.is_none()),
            ("y", self.y.is_none()),
            ("z", self.z.is_none()),
            ("tilt_x", self.tilt_x.is_none()),
            ("tilt_y", self.tilt_y.is_none()),
        ]
        .iter()
        .filter_map(|(key, is_missing)| is_missing.then_some(*key))
        .collect();
        if !missing.is_empty() {
            problems.add(format!(
                "shaft lacks {}; a rigid shaft needs all of x, y, z, tilt_x and tilt_y: \"free\", \"locked\" or a \
                 value",
                missing.join(", ")
            ));
        }
    }

    fn beam(&self, problems: &mut Problems, assumed: &mut Vec<String>) -> Option<BeamShaft> {
        let before = problems.len();
        self.refuse_rigid_keys(problems);
        let Some(steel) = &self.material else {
            problems.add(
                "shaft.material is missing; expected a name such as \"bearing steel\", or { young_modulus = \
                 \"207 GPa\", poisson_ratio = 0.3, density = \"7800 kg/m3\" }",
            );
            return None;
        };
        let steel = steel.check("shaft.material", problems, assumed);
        if problems.len() > before {
            return None;
        }
        let material = Material::new(steel.young_modulus, steel.poisson_ratio, steel.density);
        if let Err(error) = &material {
            problems.add(format!("shaft.material: {error}"));
        }
        let sections = self.sections(problems)?;
        let length = sections[sections.len() - 1].to - sections[0].from;
        let longest = self.element_length.as_ref();
        if let Some(longest) = longest {
            problems.require(
                longest.si() > 0.0 && longest.si() >= 1e-3 * length,
                "shaft.element_length",
                longest,
                "expected at least a thousandth of the shaft",
            );
        }
        let material = material.ok()?;
        (problems.len() == before).then_some(BeamShaft {
            sections,
            material,
            longest_element: longest.map_or(length / ELEMENTS, Quantity::si),
        })
    }

    /// Reports keys that only a rigid shaft has.
    fn refuse_rigid_keys(&self, problems: &mut Problems) {
        let of_rigid = [
            ("x", self.x.is_some()),
            ("y", self.y.is_some()),
            ("z", self.z.is_some()),
            ("tilt_x", self.tilt_x.is_some()),
            ("tilt_y", self.tilt_y.is_some()),
            ("transverse_inertia", self.transverse_inertia.is_some()),
            ("polar_inertia", self.polar_inertia.is_some()),
            ("mass", matches!(self.mass, Some(RawMasses::Whole(_)))),
        ];
        for (key, _) in of_rigid.iter().filter(|(_, is_there)| *is_there) {
            problems.add(format!(
                "shaft.{key} is for a rigid shaft; a beam is held by its bearings and has the mass of its sections, so \
                 remove it, or write [[shaft.mass]]"
            ));
        }
    }

    /// The sections of a beam from the lowest z to the highest; at least one.
    fn sections(&self, problems: &mut Problems) -> Option<Vec<BeamSection>> {
        let mut sections: Vec<(usize, &RawShaftSection)> = (1..).zip(&self.section).collect();
        sections
            .iter()
            .for_each(|(number, section)| section.check(*number, problems));
        sections.sort_by(|a, b| a.1.from.si().total_cmp(&b.1.from.si()));
        let (Some(first), Some(last)) = (sections.first(), sections.last()) else {
            problems.add(
                "shaft.section is missing; expected at least one table [[shaft.section]] with from, to and outside",
            );
            return None;
        };
        let length = last.1.to.si() - first.1.from.si();
        for pair in sections.windows(2) {
            check_ends(pair, length, problems);
        }
        Some(
            sections
                .into_iter()
                .map(|(_, section)| section.section())
                .collect(),
        )
    }

    fn masses(&self, problems: &mut Problems) -> Vec<PointMass> {
        let Some(RawMasses::Points(masses)) = &self.mass else {
            return Vec::new();
        };
        for mass in masses {
            problems.require(
                mass.mass.si() > 0.0,
                "shaft.mass",
                &mass.mass,
                "the mass of a table [[shaft.mass]] must be positive",
            );
            let PointMass {
                transverse, polar, ..
            } = mass.mass();
            if polar > 2.0 * transverse || transverse < 0.0 || polar < 0.0 {
                problems.add(format!(
                    "shaft.mass at {} has polar_inertia {polar} kg m2 and transverse_inertia {transverse} kg m2; no \
                     body has more than twice as much about its axis as across it",
                    mass.position
                ));
            }
        }
        masses.iter().map(RawPointMass::mass).collect()
    }

    /// Loads and masses lie on the shaft.
    fn check_positions(&self, shaft: &CommonShaft, problems: &mut Problems) {
        let mut places: Vec<(String, &Quantity<LENGTH>)> = Vec::new();
        places.extend(
            (1..)
                .zip(&self.load)
                .map(|(i, l)| (format!("shaft.load {i}"), &l.position)),
        );
        if let Some(RawMasses::Points(masses)) = &self.mass {
            places.extend(
                (1..)
                    .zip(masses)
                    .map(|(i, m)| (format!("shaft.mass {i}"), &m.position)),
            );
        }
        places.extend(
            self.load_point
                .iter()
                .map(|p| ("shaft.load_point".to_string(), p)),
        );
        for (name, position) in places {
            let (ends, text) = shaft.ends();
            let near = SAME_PLACE * (ends.end() - ends.start());
            if !(ends.start() - near..=ends.end() + near).contains(&position.si()) {
                problems.add(format!(
                    "{name} is at {position}, which is off the shaft; expected {text}"
                ));
            }
        }
        for (number, load) in (1..).zip(&self.load) {
            let is_zero = load.force.is_none() && load.moment.is_none();
            if is_zero {
                problems.add(format!(
                    "shaft.load {number} has neither force nor moment; expected force = [\"0 N\", \"-1 kN\", \"0 N\"] \
                     or moment = [\"3 N m\", \"0 N m\"]"
                ));
            }
        }
    }
}

impl CommonShaft {
    /// From end to end of the shaft, m, and what a message says of it.
    pub fn ends(&self) -> (RangeInclusive<f64>, String) {
        match &self.kind {
            ShaftKind::Rigid(_) => (
                -MAX_POSITION..=MAX_POSITION,
                format!("at most {MAX_POSITION} m from position 0, check its unit"),
            ),
            ShaftKind::Beam(beam) => {
                let [first, last] = beam.ends();
                let text = format!(
                    "{:.3} to {:.3} mm, where its sections are",
                    1e3 * first,
                    1e3 * last
                );
                (first..=last, text)
            }
        }
    }
}

fn motion<const KIND: usize>(raw: &Option<RawMotion<KIND>>) -> ShaftMotion {
    raw.as_ref().map_or(ShaftMotion::Free, RawMotion::motion)
}

fn check_motion<const KIND: usize>(
    raw: &Option<RawMotion<KIND>>,
    key: &str,
    limit: f64,
    rule: &str,
    problems: &mut Problems,
) {
    let Some(raw) = raw else { return };
    if raw.has_schedule() {
        problems.add(format!(
            "{key}.schedule is not there for a list of bearings yet, whose shaft keeps the displacement that it is \
             given; expected {key} without a schedule, or a scene of one bearing"
        ));
    }
    raw.require_small(limit, key, &Schedule::Constant, rule, problems);
}

fn check_ends(pair: &[(usize, &RawShaftSection)], length: f64, problems: &mut Problems) {
    let [(a, first), (b, second)] = [pair[0], pair[1]];
    let gap = second.from.si() - first.to.si();
    if gap.abs() <= SAME_PLACE * length {
        return;
    }
    let what = if gap > 0.0 { "leave a gap" } else { "overlap" };
    problems.add(format!(
        "shaft.section {a} ends at {} and shaft.section {b} begins at {}: they {what}; expected sections that lie end \
         to end",
        first.to, second.from
    ));
}

impl RawShaftSection {
    fn check(&self, number: usize, problems: &mut Problems) {
        problems.require(
            self.to.si() > self.from.si(),
            &format!("shaft.section {number}.to"),
            &self.to,
            format!("expected more than its from, {}", self.from),
        );
        problems.require(
            self.outside.si() > 0.0,
            &format!("shaft.section {number}.outside"),
            &self.outside,
            "expected a positive diameter",
        );
        if let Some(bore) = &self.bore {
            problems.require(
                bore.si() >= 0.0 && bore.si() < self.outside.si(),
                &format!("shaft.section {number}.bore"),
                bore,
                format!("expected 0 mm to less than its outside, {}", self.outside),
            );
        }
    }

    fn section(&self) -> BeamSection {
        BeamSection {
            from: self.from.si(),
            to: self.to.si(),
            outside: self.outside.si(),
            bore: self.bore.as_ref().map_or(0.0, Quantity::si),
        }
    }
}

impl RawLoad {
    fn load(&self) -> ShaftLoad {
        let si = |q: &Quantity<FORCE>| q.si();
        ShaftLoad {
            position: self.position.si(),
            force: self.force.as_ref().map_or([0.0; 3], |f| f.each_ref().map(si)),
            moment: self
                .moment
                .as_ref()
                .map_or([0.0; 2], |m| m.each_ref().map(Quantity::si)),
        }
    }
}

impl RawPointMass {
    fn mass(&self) -> PointMass {
        let inertia = |typed: &Option<Quantity<INERTIA>>| typed.as_ref().map_or(0.0, Quantity::si);
        PointMass {
            position: self.position.si(),
            mass: self.mass.si(),
            transverse: inertia(&self.transverse_inertia),
            polar: inertia(&self.polar_inertia),
        }
    }
}
