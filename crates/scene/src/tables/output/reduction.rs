//! ```toml
#![doc = include_str!("../example_reduction.toml")]
//! ```
//! `[output.reduction]`: extremes, means and damage of stress over a run, found while it goes on.
//!
//! Damage is the sum of n / N over the rain-flow cycles of a stress (ASTM E1049-85), with N = N_ref (S / S_ref)^-k of
//! the amplitude S (M. A. Miner, Cumulative damage in fatigue, J. Appl. Mech. 12 (1945) A159; O. H. Basquin, Proc. ASTM
//! 10 (1910) 625); means of cycles do not count. The three numbers are of a material, so that none has a default.

use input::{Problems, Quantity, STRESS, TIME};
use serde::Deserialize;

use super::context::{MAX_EVERY, OutputContext};

/// As typed.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [output.reduction]")]
pub struct RawReduction {
    from: Option<Quantity<TIME>>,
    every: Option<i64>,
    damage: Option<RawDamage>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the table [output.reduction.damage]")]
pub struct RawDamage {
    stress: DamageStress,
    exponent: f64,
    reference_amplitude: Quantity<STRESS>,
    reference_cycles: f64,
    least_range: Option<Quantity<STRESS>>,
    nodes: Option<DamageNodes>,
}

/// The stress whose cycles are counted.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum DamageStress {
    /// Von Mises stress, never negative.
    VonMises,
    /// The same with the sign of the mean normal stress.
    SignedVonMises,
}

/// Nodes whose cycles are counted.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum DamageNodes {
    /// Those of the raceways.
    Raceways,
    /// All of flexible rings.
    All,
}

/// What is found of the stress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputReduction {
    /// Time of the first step that may count, s.
    pub from: f64,
    /// Steps from one that counts to the next, at least 1.
    pub every: u64,
    /// Damage, if it is asked for.
    pub damage: Option<CycleDamage>,
}

/// Cycles and their damage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleDamage {
    /// The stress that is counted.
    pub stress: DamageStress,
    /// Exponent k of the S-N line.
    pub exponent: f64,
    /// Amplitude of a point of the line, Pa.
    pub reference_amplitude: f64,
    /// Cycles to failure at this amplitude.
    pub reference_cycles: f64,
    /// Swings of this range or less, Pa, are passed over.
    pub least_range: f64,
    /// Where it is counted.
    pub nodes: DamageNodes,
}

impl RawReduction {
    /// Checks ranges and fills in defaults.
    pub fn check(&self, context: OutputContext, problems: &mut Problems) -> OutputReduction {
        context.require_series("output.reduction", problems);
        if context.flexible == [false; 2] {
            problems.add("[output.reduction] needs stress, and rigid rings have none; remove it");
        }
        if let Some(from) = &self.from {
            if !context.has_steps {
                problems.add("output.reduction.from is a time, and a sweep has none; remove it");
            }
            problems.require(
                from.si() >= 0.0,
                "output.reduction.from",
                from,
                "expected 0 s or later",
            );
        }
        let every = problems.whole(self.every.unwrap_or(1), "output.reduction.every", 1, MAX_EVERY);
        OutputReduction {
            from: self.from.as_ref().map_or(0.0, Quantity::si),
            every: every as u64,
            damage: self.damage.as_ref().map(|damage| damage.check(problems)),
        }
    }
}

impl RawDamage {
    fn check(&self, problems: &mut Problems) -> CycleDamage {
        const KEY: &str = "output.reduction.damage";
        problems.require(
            (1.0..=50.0).contains(&self.exponent),
            &format!("{KEY}.exponent"),
            self.exponent,
            "expected 1 to 50, the slope of the S-N line",
        );
        problems.require(
            self.reference_cycles.is_finite() && self.reference_cycles >= 1.0,
            &format!("{KEY}.reference_cycles"),
            self.reference_cycles,
            "expected at least 1 cycle",
        );
        let amplitude = &self.reference_amplitude;
        problems.require_positive(amplitude, &format!("{KEY}.reference_amplitude"), "the amplitude");
        if let Some(least) = &self.least_range {
            let key = format!("{KEY}.least_range");
            problems.require(least.si() >= 0.0, &key, least, "expected 0 or more");
        }
        CycleDamage {
            stress: self.stress,
            exponent: self.exponent,
            reference_amplitude: amplitude.si(),
            reference_cycles: self.reference_cycles,
            least_range: self.least_range.as_ref().map_or(0.0, Quantity::si),
            nodes: self.nodes.unwrap_or(DamageNodes::Raceways),
        }
    }
}
