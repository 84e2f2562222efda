//! Load spectra: the conditions of a machine with their shares of time.
//!
//! ```toml
#![doc = include_str!("example.toml")]
//! ```
//!
//! Damage is added position by position: with shares w of time and speeds n of the conditions,
//!
//! ```text
//! 1/L(theta) = sum of w n / L_condition(theta) / sum of w n
//! ```
//!
//! and the life of the rings follows as for one condition. For L_nmr the damage of each condition is divided by its own
//! a_ISO. If no condition has a speed, all are taken to turn equally fast.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, ensure};
use input::{ANGULAR_SPEED, Quantity};
use results::failure::Failure;
use serde::{Deserialize, Serialize};

use crate::assess::{Assessment, Exposure, add_damage, assess, life_of};
use crate::run::FinishedRun;

/// The whole file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the tables of a load spectrum")]
struct RawSpectrum {
    title: Option<String>,
    conditions: Vec<RawCondition>,
}

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table [[conditions]] with results and share"
)]
struct RawCondition {
    results: PathBuf,
    share: f64,
    point: Option<usize>,
    speed: Option<Quantity<ANGULAR_SPEED>>,
}

/// A condition with its life.
#[derive(Clone, Debug, Serialize)]
pub struct ConditionLife {
    /// Folder of its results, as typed.
    pub results: String,
    /// Point of a sweep.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point: Option<usize>,
    /// Share of time.
    pub share: f64,
    /// Share of the turns.
    pub share_of_turns: f64,
    /// Its own life, if it went on for ever.
    pub life: Assessment,
}

/// A load spectrum with its life.
pub struct SpectrumLife {
    /// Free text for people.
    pub title: Option<String>,
    /// The conditions, in the order of the file.
    pub conditions: Vec<ConditionLife>,
    /// All together.
    pub whole: Assessment,
}

/// Difference of the sum of the shares from 1 that is round-off of their decimals.
const SHARE_TOLERANCE: f64 = 1e-6;

/// Reads a spectrum and the results that it names; paths start at the folder of the file.
pub fn read(path: &Path, overrides: &[String]) -> Result<SpectrumLife, Failure> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let raw: RawSpectrum = scene::read_tables(&text, path)?;
    check_shares(&raw).with_context(|| path.display().to_string())?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut exposures = Vec::new();
    for condition in &raw.conditions {
        let dir = folder.join(&condition.results);
        let exposure = exposure(&dir, condition, overrides)
            .map_err(|failure| failure.context(format!("condition {}", condition.results.display())))?;
        exposures.push(exposure);
    }
    require_one_bearing(&raw, &exposures).with_context(|| path.display().to_string())?;
    let weights = weights(&raw, &exposures).with_context(|| path.display().to_string())?;
    let conditions = raw.conditions.iter().zip(&exposures).zip(&weights);
    Ok(SpectrumLife {
        title: raw.title.clone(),
        conditions: conditions
            .map(|((condition, exposure), weight)| ConditionLife {
                results: condition.results.display().to_string(),
                point: condition.point,
                share: condition.share,
                share_of_turns: *weight,
                life: assess(exposure).without_positions(),
            })
            .collect(),
        whole: together(&raw, &exposures, &weights),
    })
}

fn check_shares(raw: &RawSpectrum) -> anyhow::Result<()> {
    ensure!(!raw.conditions.is_empty(), "the spectrum has no [[conditions]]");
    for condition in &raw.conditions {
        ensure!(
            condition.share > 0.0 && condition.share <= 1.0,
            "the share of {} is {}; expected a share of time above 0, at most 1",
            condition.results.display(),
            condition.share
        );
    }
    let sum: f64 = raw.conditions.iter().map(|condition| condition.share).sum();
    ensure!(
        (sum - 1.0).abs() <= SHARE_TOLERANCE,
        "the shares of time add up to {sum}; expected 1"
    );
    Ok(())
}

/// What the bearing goes through in one condition.
fn exposure(dir: &Path, condition: &RawCondition, overrides: &[String]) -> Result<Exposure, Failure> {
    let run = FinishedRun::read(dir, overrides)?;
    let speed = condition.speed.as_ref().map(|speed| speed.si().abs());
    if run.is_history() {
        if condition.point.is_some() || speed.is_some() {
            return Err(anyhow!("point and speed are for equilibria; a history has its own").into());
        }
        return run.history();
    }
    let mut points = run.points()?;
    let index = match (condition.point, points.len()) {
        (Some(point), n) if point >= n => {
            return Err(anyhow!("point is {point}; the results have points 0 to {}", n - 1).into());
        }
        (Some(point), _) => point,
        (None, 1) => 0,
        (None, n) => {
            return Err(anyhow!("a sweep of {n} points; give point, such as point = 0").into());
        }
    };
    let mut exposure = points.swap_remove(index).exposure;
    if let Some(speed) = speed {
        if speed <= 0.0 {
            return Err(anyhow!("speed is 0; expected a speed of one ring against the other").into());
        }
        if exposure.speed.is_some() || exposure.rated.life.speed.is_some() {
            return Err(anyhow!("speed is given, but the scene of the results has one; remove speed").into());
        }
        exposure.speed = Some(speed);
    }
    Ok(exposure)
}

/// Shares of time are of one bearing's life.
fn require_one_bearing(raw: &RawSpectrum, exposures: &[Exposure]) -> anyhow::Result<()> {
    let first = &exposures[0].rated;
    for (condition, exposure) in raw.conditions.iter().zip(exposures) {
        let rated = &exposure.rated;
        let same = rated.bearing == first.bearing && rated.dynamic == first.dynamic;
        ensure!(
            same && rated.at_rest == first.at_rest && rated.fatigue_limit == first.fatigue_limit,
            "{} is of another bearing or rating than {}; expected the same in all conditions",
            condition.results.display(),
            raw.conditions[0].results.display()
        );
        ensure!(
            rated.life.reliability == first.life.reliability,
            "{} asks for another reliability than {}; --set life.reliability=90 sets it for all",
            condition.results.display(),
            raw.conditions[0].results.display()
        );
    }
    Ok(())
}

fn speed_of(exposure: &Exposure) -> Option<f64> {
    exposure.speed.or(exposure.rated.life.speed).map(f64::abs)
}

/// Shares of the turns; they add up to 1.
fn weights(raw: &RawSpectrum, exposures: &[Exposure]) -> anyhow::Result<Vec<f64>> {
    let speeds: Vec<Option<f64>> = exposures.iter().map(speed_of).collect();
    let known = speeds.iter().flatten().count();
    if known > 0 && known < speeds.len() {
        let without = speeds.iter().position(Option::is_none).unwrap_or(0);
        return Err(anyhow!(
            "{} has no speed, other conditions do; give its speed, such as speed = \"1800 rpm\"",
            raw.conditions[without].results.display()
        ));
    }
    let shares = raw.conditions.iter().map(|condition| condition.share);
    let turns: Vec<f64> = shares
        .zip(&speeds)
        .map(|(share, n)| share * n.unwrap_or(1.0))
        .collect();
    let sum: f64 = turns.iter().sum();
    Ok(turns.iter().map(|turns| turns / sum).collect())
}

/// What warns of the life of a condition, and so of the whole.
fn warnings((condition, exposure): (&RawCondition, &Exposure)) -> Vec<String> {
    let of_condition = |text| format!("warning: {}: {text}", condition.results.display());
    let notes = exposure.notes.iter();
    notes
        .filter_map(|note| Some(of_condition(note.strip_prefix("warning: ")?)))
        .collect()
}

/// All conditions as one exposure.
fn together(raw: &RawSpectrum, exposures: &[Exposure], weights: &[f64]) -> Assessment {
    let mut whole = exposures[0].clone();
    let empty = exposures[0]
        .damage
        .each_ref()
        .map(|damage| vec![0.0; damage.len()]);
    let (mut plain, mut modified) = (empty.clone(), empty);
    let (mut cubes, mut factors_known) = (0.0, true);
    for (exposure, weight) in exposures.iter().zip(weights) {
        add_damage(&mut plain, *weight, &exposure.damage);
        match assess(exposure).a_iso {
            Some(factor) => add_damage(&mut modified, weight / factor, &exposure.damage),
            // A condition without load does no damage.
            None => factors_known &= exposure.damage.iter().flatten().all(|damage| *damage == 0.0),
        }
        cubes += weight * exposure.equivalent.dynamic.powi(3);
        whole.equivalent.at_rest = whole.equivalent.at_rest.max(exposure.equivalent.at_rest);
        whole.peak_pressure = whole.peak_pressure.max(exposure.peak_pressure);
    }
    whole.equivalent.dynamic = cubes.cbrt();
    whole.damage = plain;
    whole.notes = raw.conditions.iter().zip(exposures).flat_map(warnings).collect();
    let shares = raw.conditions.iter().map(|condition| condition.share);
    let speeds: Option<Vec<f64>> = exposures.iter().map(speed_of).collect();
    whole.speed = speeds.map(|speeds| shares.zip(speeds).map(|(share, n)| share * n).sum());
    let mut life = assess(&whole);
    // Each condition has its own kappa and a_ISO.
    life.catalogue.kappa = None;
    life.catalogue.l_nm_revolutions = None;
    let modified = Some(life.catalogue.a_1 * life_of(&modified)).filter(|l| factors_known && l.is_finite());
    let ratio = modified
        .zip(life.l10r_revolutions)
        .map(|(modified, plain)| modified / plain);
    life.a_iso = ratio.map(|ratio| ratio / life.catalogue.a_1);
    life.l_nmr_revolutions = modified;
    life.l_nmr_hours = life.l10r_hours.zip(ratio).map(|(hours, ratio)| hours * ratio);
    life.catalogue.notes.retain(|note| !note.starts_with("no a_ISO"));
    if !factors_known {
        let text = "no a_ISO: a condition has none, see its own notes";
        life.catalogue.notes.push(text.to_string());
    }
    life
}
