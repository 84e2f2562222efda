//! The step whose fields figures show: steps may lack fields (`output.every`).

use std::path::Path;

use checkpoint::{all_steps, point_field_names};
use comm::print;

/// The chosen step, or the newest that holds stress and displacement at nodes. None if there is none, or if the chosen
/// one lacks them, which [`note_lacking`] says.
pub fn step_with_stress(dir: &Path, chosen: Option<u64>) -> anyhow::Result<Option<u64>> {
    if let Some(step) = chosen {
        return Ok(lacking(dir, step)?.is_empty().then_some(step));
    }
    for step in all_steps(dir)?.into_iter().rev() {
        if lacking(dir, step)?.is_empty() {
            return Ok(Some(step));
        }
    }
    Ok(None)
}

/// The chosen step, or the newest, if it holds displacements; None if there is none.
pub fn step_with_displacement(dir: &Path, chosen: Option<u64>) -> anyhow::Result<Option<u64>> {
    let steps = match chosen {
        Some(step) => vec![step],
        None => all_steps(dir)?,
    };
    for step in steps.into_iter().rev() {
        if has(dir, step, "displacement")? {
            return Ok(Some(step));
        }
    }
    Ok(None)
}

fn has(dir: &Path, step: u64, field: &str) -> anyhow::Result<bool> {
    Ok(point_field_names(dir, step)?.iter().any(|name| name == field))
}

/// Says that a chosen step lacks what figures of stress need while others have it.
pub fn note_lacking(dir: &Path, chosen: Option<u64>) -> anyhow::Result<()> {
    let Some(step) = chosen else { return Ok(()) };
    let lacks = lacking(dir, step)?;
    if lacks.is_empty() {
        return Ok(());
    }
    let mut others = all_steps(dir)?;
    others.sort_by_key(|&other| other.abs_diff(step));
    for other in others {
        if lacking(dir, other)?.is_empty() {
            print::note(format_args!(
                "note: step {step} has no {} (output.every), and no figures of stress; the nearest that has is {other}",
                lacks.join(" and ")
            ));
            return Ok(());
        }
    }
    Ok(())
}

/// What a step lacks of both.
fn lacking(dir: &Path, step: u64) -> anyhow::Result<Vec<&'static str>> {
    let names = point_field_names(dir, step)?;
    let has = |name: &str| names.iter().any(|n| n == name);
    let needed = [("von_mises", "stress"), ("displacement", "displacement")];
    let lacks = needed.into_iter().filter(|(name, _)| !has(name));
    Ok(lacks.map(|(_, words)| words).collect())
}
