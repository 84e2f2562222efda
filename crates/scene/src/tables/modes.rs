//! `[modes]`: natural frequencies and shapes, of rings alone or of the loaded bearing about its equilibrium.
//!
//! Undamped and without rotation: there are no gyroscopic effects, so `[speed]` is refused.

use input::{Problems, Quantity, RATE};
use serde::Deserialize;

use super::solver::BackendChoice;
use dynamics::ContactMode;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [modes]")]
pub struct RawModes {
    number: i64,
    bodies: Option<Vec<ModeBody>>,
    support: Option<ModeSupport>,
    shift: Option<Quantity<RATE>>,
}

/// Whose modes are computed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ModeBody {
    /// The inner ring alone.
    Inner,
    /// The outer ring alone.
    Outer,
    /// Rings, balls and shaft about the static equilibrium.
    Bearing,
}

/// What holds a ring alone.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ModeSupport {
    /// Nothing: six modes are rigid motions.
    Free,
    /// Its `support`, by a shaft or housing at rest.
    AsHeld,
}

/// Natural frequencies and shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Number of modes of each body, from the lowest, rigid motions included.
    pub number: usize,
    /// Bodies in the order they are computed, none twice.
    pub bodies: Vec<ModeBody>,
    /// What holds the rings that are looked at alone.
    pub support: ModeSupport,
    /// Frequency the search is centred at, 1/s; chosen from size and material when `None`.
    pub shift: Option<f64>,
}

/// What the modes have to go with.
#[derive(Clone, Copy, Debug)]
pub struct ModesContext {
    /// Whether the inner and the outer ring are finite-element bodies.
    pub flexible: [bool; 2],
    /// Contact mode of the scene.
    pub contact: ContactMode,
    /// How its rings are solved.
    pub backend: BackendChoice,
}

impl ModesContext {
    /// What modes need to know of rings that are elastic or not, inner first.
    pub fn new(flexible: [bool; 2], contact: ContactMode, backend: BackendChoice) -> ModesContext {
        ModesContext {
            flexible,
            contact,
            backend,
        }
    }
}

/// Every mode is a step file.
const MAX_NUMBER: i64 = 1000;
/// Shifts beyond this are slips of the unit, 1/s.
const MAX_SHIFT: f64 = 1e8;

impl ModeBody {
    /// As a scene has it.
    pub fn typed(self) -> &'static str {
        match self {
            ModeBody::Inner => "inner",
            ModeBody::Outer => "outer",
            ModeBody::Bearing => "bearing",
        }
    }
}

impl RawModes {
    /// Reports what a list of bearings does not have modes of.
    pub fn refuse_in_list(&self, problems: &mut Problems) {
        let named = self.bodies.iter().flatten();
        for body in named.filter(|body| **body != ModeBody::Bearing) {
            problems.add(format!(
                "modes.bodies names {:?}, a ring alone, but a list of bearings vibrates as one with its shaft; leave \
                 modes.bodies out, or give one table [bearing] for rings alone",
                body.typed()
            ));
        }
    }

    /// Checks numbers, and that the bodies have modes; `None` when there are problems.
    pub fn check(&self, context: ModesContext, problems: &mut Problems) -> Option<Modes> {
        let before = problems.len();
        if context.backend.divides_rings() {
            problems.add(
                "solver.backend is \"sector\", but the search for modes has no sectors; expected \"auto\", \"cyclic\" \
                 or \"sparse\" with [modes]",
            );
        }
        let number = problems.whole(self.number, "modes.number", 1, MAX_NUMBER);
        let bodies = self.bodies.clone().unwrap_or(vec![ModeBody::Bearing]);
        if bodies.is_empty() {
            problems
                .add("modes.bodies is empty; expected \"inner\", \"outer\", \"bearing\" or several of them");
        }
        for (i, body) in bodies.iter().enumerate() {
            if bodies[..i].contains(body) {
                problems.add(format!("modes.bodies names {:?} twice", body.typed()));
            }
            check_body(*body, context, problems);
        }
        if self.support.is_some() && bodies.iter().all(|b| *b == ModeBody::Bearing) {
            problems.add(
                "modes.support is how rings alone are held, but modes.bodies names none; name \"inner\" or \"outer\", \
                 or remove modes.support",
            );
        }
        if let Some(shift) = &self.shift {
            let rule = "expected more than 0 and at most 1e8 1/s, near the lowest elastic frequencies";
            let s = shift.si();
            problems.require(s > 0.0 && s <= MAX_SHIFT, "modes.shift", shift, rule);
        }
        (problems.len() == before).then(|| Modes {
            number,
            bodies,
            support: self.support.unwrap_or(ModeSupport::AsHeld),
            shift: self.shift.as_ref().map(Quantity::si),
        })
    }
}

fn check_body(body: ModeBody, context: ModesContext, problems: &mut Problems) {
    let is_flexible = match body {
        ModeBody::Inner => context.flexible[0],
        ModeBody::Outer => context.flexible[1],
        ModeBody::Bearing => {
            if context.contact == ContactMode::Facet {
                problems.add(
                    "contact.mode is \"facet\", whose forces have no energy, so the bearing has no natural modes; use \
                     \"patch\"",
                );
            }
            return;
        }
    };
    if !is_flexible {
        let name = body.typed();
        problems.add(format!(
            "modes.bodies names {name:?}, but that ring is rigid; expected {name}.flexible = true or the \
             body \"bearing\""
        ));
    }
}
