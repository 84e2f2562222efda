//! Tells after the first finished point of a study what its runs do not have: a column that is mistyped would else be
//! told after all of them.

use std::path::Path;

use anyhow::anyhow;
use results::failure::Failure;

use super::plan::Plan;
use super::read::look_up;
use super::record::{RUN, folder};

/// Fails if a finished point has no number for a quantity that is not optional, or no signals that are asked for.
pub fn require_readable(plan: &Plan, index: usize, out: &Path) -> Result<(), Failure> {
    let dir = folder(out, index).join(RUN);
    let refused = |what: &str, error: anyhow::Error, or: &str| {
        Failure::User(anyhow!(
            "{what}: {error:#}; point {index} is the first that has finished, in {}; correct {}{or}, and the same \
             command goes on with what is there",
            dir.display(),
            plan.path.display()
        ))
    };
    for quantity in plan.quantities.iter().filter(|quantity| !quantity.is_optional) {
        look_up(&quantity.source, &dir).map_err(|error| {
            let or = ", or give the quantity optional = true if only some points have it";
            refused(&format!("quantity {:?}", quantity.name), error, or)
        })?;
    }
    match plan.signals.as_ref().map(|signals| signals.of_run(&dir)) {
        Some(Err(error)) => Err(refused("[signals]", error, "")),
        _ => Ok(()),
    }
}
