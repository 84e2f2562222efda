//! What step files hold of a list of bearings in equilibria over time, and how it goes on from them: where each bearing
//! stands and the tangents of its contacts, the shaft, forces on shared bodies, and counts.

use std::path::Path;

use anyhow::{Context, anyhow};
use assembly::{Assembly, AssemblySolver, AssemblyStart};
use checkpoint::StateArray;
use dynamics::statics::ContactColumns;
use results::failure::Failure;
use results::reduction::take_arrays;
use results::rest_state;
use results::state_arrays::Arrays;

use crate::several_state::{StoredBearing, other_shaft};

const SHAFT: &str = "list_shaft";
const BODIES: &str = "list_forces_on_bodies";
const COUNTS: &str = "list_counts";
const ROUNDS: &str = "list_rounds";

/// What has been counted of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ListCounts {
    /// Iterations of the shaft.
    pub iterations: u64,
    /// Instants with warnings.
    pub warned: u64,
    /// Rounds and iterations of the last answers of every bearing.
    pub of_bearings: Vec<[u64; 2]>,
}

/// What a run goes on with.
pub struct RestoredEquilibrium {
    pub start: AssemblyStart,
    pub columns: Vec<ContactColumns>,
    pub counts: ListCounts,
    /// What each bearing knows of the whole run by `[output.reduction]`.
    pub reductions: Vec<Arrays>,
}

/// The arrays of a bearing, by its number.
pub fn arrays(
    start: &AssemblyStart,
    columns: &ContactColumns,
    counts: &ListCounts,
    bearing: usize,
) -> Arrays {
    let mut arrays = rest_state::store(&start.bearings[bearing], columns);
    let integers = |values: &[u64]| {
        let stored = |count: &u64| i64::try_from(*count).expect("nobody counts to 2^63");
        StateArray::Integer(values.iter().map(stored).collect())
    };
    arrays.insert(SHAFT.to_string(), StateArray::Real(start.shaft.clone()));
    let on_bodies = start.on_bodies.concat();
    if !on_bodies.is_empty() {
        arrays.insert(BODIES.to_string(), StateArray::Real(on_bodies));
    }
    let ListCounts {
        iterations,
        warned,
        of_bearings,
    } = counts;
    arrays.insert(COUNTS.to_string(), integers(&[*iterations, *warned]));
    arrays.insert(ROUNDS.to_string(), integers(&of_bearings[bearing]));
    arrays
}

/// What a step of all bearings holds.
pub fn restore(
    bearings: &[StoredBearing],
    (assembly, solver): (&Assembly, &AssemblySolver),
    (dir, step): (&Path, u64),
) -> Result<RestoredEquilibrium, Failure> {
    let (mut displacements, mut columns, mut of_bearings) = (Vec::new(), Vec::new(), Vec::new());
    let (mut reductions, mut of_list) = (Vec::new(), None);
    let missing = || {
        anyhow!(
            "step {step} of {} has no state of the shaft in equilibrium over time",
            dir.display()
        )
    };
    for (bearing, mounted) in bearings.iter().zip(&assembly.bearings) {
        let at = || format!("step {step} of {}", bearing.folder.display());
        let mut arrays = bearing.record.state.clone();
        reductions.push(take_arrays(&mut arrays));
        let own = [SHAFT, BODIES, COUNTS].map(|name| arrays.remove(name));
        if *of_list.get_or_insert_with(|| own.clone()) != own {
            return Err(other_shaft(&bearing.folder, (dir, step)));
        }
        of_bearings.push(counts::<2>(arrays.remove(ROUNDS)).ok_or_else(missing)?);
        let (own, tangents) = rest_state::load(arrays, &mounted.model).with_context(at)?;
        displacements.push(own);
        columns.push(tangents);
    }
    let [shaft, on_bodies, of_run] = of_list.ok_or_else(missing)?;
    let shaft = reals(shaft, assembly.shaft.n()).ok_or_else(missing)?;
    let mut forces = solver.no_forces_on_bodies();
    let length = forces.iter().map(Vec::len).sum();
    let mut all = match length {
        0 => Vec::new(),
        length => reals(on_bodies, length).ok_or_else(missing)?,
    }
    .into_iter();
    forces
        .iter_mut()
        .flatten()
        .zip(&mut all)
        .for_each(|(to, from)| *to = from);
    let [iterations, warned] = counts(of_run).ok_or_else(missing)?;
    Ok(RestoredEquilibrium {
        start: AssemblyStart {
            shaft,
            bearings: displacements,
            on_bodies: forces,
        },
        columns,
        counts: ListCounts {
            iterations,
            warned,
            of_bearings,
        },
        reductions,
    })
}

fn reals(array: Option<StateArray>, length: usize) -> Option<Vec<f64>> {
    match array {
        Some(StateArray::Real(values)) if values.len() == length => Some(values),
        _ => None,
    }
}

fn counts<const N: usize>(array: Option<StateArray>) -> Option<[u64; N]> {
    match array {
        Some(StateArray::Integer(values)) if values.len() == N => {
            Some(std::array::from_fn(|i| u64::try_from(values[i]).unwrap_or(0)))
        }
        _ => None,
    }
}
