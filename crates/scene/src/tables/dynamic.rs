//! `[dynamic]`: motion in time from t = 0, in equal steps.
//!
//! The bodies are integrated by a scheme of the generalised-alpha family, contact forces by a mean over the
//! step. References: Chung and Hulbert, J. Appl. Mech. 60 (1993) 371, doi:10.1115/1.2900803; Hilbert, Hughes
//! and Taylor, Earthq. Eng. Struct. Dyn. 5 (1977) 283, doi:10.1002/eqe.4290050306 (`alpha` here is minus theirs).

use dynamics::interactions::discrete_gradient::ContactScheme;
use input::{Problems, Quantity, TIME, ten_digits};
use serde::Deserialize;

use super::shaft::Shaft;
use super::start::{RawStart, Start};
use super::steps::{output_every, whole_steps};

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [dynamic]")]
pub struct RawDynamic {
    duration: Quantity<TIME>,
    step: Quantity<TIME>,
    output_every: Option<i64>,
    integrator: Option<IntegratorName>,
    rho: Option<f64>,
    alpha: Option<f64>,
    beta: Option<f64>,
    gamma: Option<f64>,
    contact: Option<ContactScheme>,
    ledger_tolerance: Option<f64>,
    halvings: Option<i64>,
    adaptive: Option<RawAdaptive>,
    start: Option<RawStart>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [dynamic.adaptive]")]
struct RawAdaptive {
    tolerance: f64,
}

/// As typed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
enum IntegratorName {
    AverageAcceleration,
    ChungHulbert,
    Hht,
    Newmark,
}

/// Scheme of the rings, the shaft and the balls, with its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntegratorChoice {
    /// Average acceleration in its energy-conserving form.
    AverageAcceleration,
    /// Chung and Hulbert's scheme.
    ChungHulbert {
        /// Spectral radius at infinite frequency, 0 (those modes vanish in a step) to 1 (no damping).
        rho: f64,
    },
    /// The scheme of Hilbert, Hughes and Taylor.
    Hht {
        /// Minus the alpha of the paper, 0 (no damping) to 1/3.
        alpha: f64,
    },
    /// Newmark's scheme.
    Newmark {
        /// Share of the end's acceleration in the displacement, at least gamma / 2.
        beta: f64,
        /// Share of the end's acceleration in the velocity, 1/2 (no damping) to 1.
        gamma: f64,
    },
}

/// Motion in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamic {
    /// Run time from t = 0, s.
    pub duration: f64,
    /// Size of a step, s.
    pub step: f64,
    /// Number of steps: duration / step.
    pub n_steps: u64,
    /// Steps from one field file to the next, at least 1.
    pub output_every: u64,
    /// Scheme of the bodies.
    pub integrator: IntegratorChoice,
    /// Scheme of the contacts.
    pub contact: ContactScheme,
    /// The run stops when more of the energy than this is unaccounted for, relative to the largest energy or work.
    pub ledger_tolerance: f64,
    /// How often a step may be halved.
    pub halvings: u32,
    /// Accepted local error over the largest contact approach; `None` for equal steps.
    pub adaptive: Option<f64>,
    /// The state at t = 0.
    pub start: Start,
}

/// Every scheme closes to the tolerance of Newton's iteration, 1e-12 for the 7010C: this is far above.
const DEFAULT_LEDGER_TOLERANCE: f64 = 1e-6;
/// Halvings of a step that fails, or is too inaccurate, before the run stops.
const DEFAULT_HALVINGS: i64 = 4;
/// A step 65 536 times smaller: what does not pass then never does.
const MAX_HALVINGS: i64 = 16;
/// Least damped and least accurate of Newmark's unconditionally stable schemes.
const DEFAULT_BETA: f64 = 0.25;
/// Bounds such as (1.1)^2 / 4 are typed with their decimals.
const ROUND_OFF: f64 = 1e-9;
const DEFAULT_GAMMA: f64 = 0.5;

impl RawDynamic {
    /// Whether its integrator conserves energy.
    pub fn conserves(&self) -> bool {
        matches!(self.integrator, None | Some(IntegratorName::AverageAcceleration))
    }

    /// Reports what a list of bearings does not go with.
    pub fn refuse_in_list(&self, problems: &mut Problems) {
        let given = [
            ("adaptive", self.adaptive.is_some(), "its steps are equal"),
            (
                "start",
                self.start.as_ref().is_some_and(|start| !start.is_rolling()),
                "it starts from its equilibrium, at rest or with [dynamic.start.rolling]",
            ),
            (
                "integrator",
                !self.conserves(),
                "it moves by average_acceleration",
            ),
        ];
        for (key, _, instead) in given.iter().filter(|(_, is_given, _)| *is_given) {
            problems.add(format!(
                "dynamic.{key} is not for a list of bearings yet: {instead}; remove it, or give one table [bearing]"
            ));
        }
    }

    /// Checks ranges, that the step fits the duration, and that the integrator has the numbers it needs; `None` when
    /// there are problems.
    pub fn check(&self, (shaft, has_speed): (&Shaft, bool), problems: &mut Problems) -> Option<Dynamic> {
        let before = problems.len();
        let n_steps = whole_steps("dynamic", &self.duration, &self.step, problems);
        let output_every = output_every("dynamic", self.output_every, problems);
        let integrator = self.integrator(problems);
        let halvings = problems.whole(
            self.halvings.unwrap_or(DEFAULT_HALVINGS),
            "dynamic.halvings",
            0,
            MAX_HALVINGS,
        );
        if let Some(adaptive) = &self.adaptive {
            problems.require(
                (1e-9..=1e-1).contains(&adaptive.tolerance),
                "dynamic.adaptive.tolerance",
                adaptive.tolerance,
                "expected 1e-9 to 0.1, the error of a step over the largest contact approach",
            );
        }
        let start = self
            .start
            .as_ref()
            .map_or(Start::Static, |s| s.check(shaft, problems));
        if start == Start::Rolling && !has_speed {
            problems.add(
                "[dynamic.start.rolling] starts with balls that go round, but nothing turns; add [speed] with inner = \
                 \"1800 rpm\" to a scene that has none, or remove it"
                    .to_string(),
            );
        }
        let ledger_tolerance = self.ledger_tolerance.unwrap_or(DEFAULT_LEDGER_TOLERANCE);
        problems.require(
            (1e-14..=1.0).contains(&ledger_tolerance),
            "dynamic.ledger_tolerance",
            ledger_tolerance,
            "expected 1e-14 to 1, it is relative to the largest energy of the run",
        );
        let dynamic = Dynamic {
            duration: self.duration.si(),
            step: self.step.si(),
            n_steps: n_steps?,
            output_every,
            integrator: integrator?,
            contact: self.contact.unwrap_or(ContactScheme::DiscreteGradient),
            ledger_tolerance,
            halvings: halvings as u32,
            adaptive: self.adaptive.as_ref().map(|a| a.tolerance),
            start,
        };
        (problems.len() == before).then_some(dynamic)
    }

    fn integrator(&self, problems: &mut Problems) -> Option<IntegratorChoice> {
        let before = problems.len();
        let name = self.integrator.unwrap_or(IntegratorName::AverageAcceleration);
        self.refuse_foreign_numbers(name, problems);
        let choice = match name {
            IntegratorName::AverageAcceleration => Some(IntegratorChoice::AverageAcceleration),
            IntegratorName::ChungHulbert => self.chung_hulbert(problems),
            IntegratorName::Hht => self.hht(problems),
            IntegratorName::Newmark => Some(self.newmark(problems)),
        };
        choice.filter(|_| problems.len() == before)
    }

    fn refuse_foreign_numbers(&self, name: IntegratorName, problems: &mut Problems) {
        let numbers = [
            ("rho", self.rho, IntegratorName::ChungHulbert),
            ("alpha", self.alpha, IntegratorName::Hht),
            ("beta", self.beta, IntegratorName::Newmark),
            ("gamma", self.gamma, IntegratorName::Newmark),
        ];
        for (key, number, owner) in numbers {
            let Some(number) = number.filter(|_| owner != name) else {
                continue;
            };
            let is = if self.integrator.is_none() {
                "by default "
            } else {
                ""
            };
            problems.add(format!(
                "dynamic.{key} is {number}; it belongs to the integrator {:?}, but the integrator is {is}{:?}",
                owner.typed(),
                name.typed()
            ));
        }
    }

    fn chung_hulbert(&self, problems: &mut Problems) -> Option<IntegratorChoice> {
        let rule = "expected 0 to 1, the amplitude that the highest frequencies keep per step";
        let Some(rho) = self.rho else {
            problems.add(format!(
                "dynamic.rho is missing; the integrator \"chung_hulbert\" needs it, {rule}, 0.8 is usual"
            ));
            return None;
        };
        problems.require((0.0..=1.0).contains(&rho), "dynamic.rho", rho, rule);
        Some(IntegratorChoice::ChungHulbert { rho })
    }

    fn hht(&self, problems: &mut Problems) -> Option<IntegratorChoice> {
        let rule = "expected 0 (no damping) to 1/3";
        let Some(alpha) = self.alpha else {
            problems.add(format!(
                "dynamic.alpha is missing; the integrator \"hht\" needs it, {rule}, 0.1 is usual"
            ));
            return None;
        };
        problems.require((0.0..=1.0 / 3.0).contains(&alpha), "dynamic.alpha", alpha, rule);
        Some(IntegratorChoice::Hht { alpha })
    }

    fn newmark(&self, problems: &mut Problems) -> IntegratorChoice {
        let (beta, gamma) = (
            self.beta.unwrap_or(DEFAULT_BETA),
            self.gamma.unwrap_or(DEFAULT_GAMMA),
        );
        if !(0.5..=1.0).contains(&gamma) {
            let rule = "expected 0.5 (no damping) to 1, less is unstable";
            problems.require(false, "dynamic.gamma", gamma, rule);
            return IntegratorChoice::Newmark { beta, gamma };
        }
        let (least, most) = (0.5 * gamma, 0.25 * (gamma + 0.5) * (gamma + 0.5));
        if gamma == 0.5 {
            let rule = "expected gamma / 2 = 0.25 to 1, less is unstable for high frequencies";
            problems.require((least..=1.0).contains(&beta), "dynamic.beta", beta, rule);
            return IntegratorChoice::Newmark { beta, gamma };
        }
        let rule = format!(
            "expected gamma / 2 = {} to (gamma + 1/2)^2 / 4 = {}, which damps high frequencies most: less is unstable \
             for these, more can feed energy into contacts",
            ten_digits(least),
            ten_digits(most)
        );
        let known = least * (1.0 - ROUND_OFF)..=most * (1.0 + ROUND_OFF);
        problems.require(known.contains(&beta), "dynamic.beta", beta, rule);
        IntegratorChoice::Newmark { beta, gamma }
    }
}

impl IntegratorName {
    /// As a scene has it.
    fn typed(self) -> &'static str {
        match self {
            IntegratorName::AverageAcceleration => "average_acceleration",
            IntegratorName::ChungHulbert => "chung_hulbert",
            IntegratorName::Hht => "hht",
            IntegratorName::Newmark => "newmark",
        }
    }
}
