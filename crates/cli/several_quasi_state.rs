//! What step files hold of a list of bearings in equilibria over time, and how it goes on from them: where each bearing
//! stands and the tangents of its contacts, the shaft, forces on shared bodies, and counts.

use std::path::Path;

use anyhow::{Context, anyhow};
use assembly::points::AssemblyPointStart;
use assembly::{Assembly, AssemblySolver, AssemblyStart};
use checkpoint::StateArray;
use dynamics::points::PointStart;
use results::failure::Failure;
use results::reduction::take_arrays;
use results::rest_state;
use results::state_arrays::Arrays;

use crate::points_ahead::Taken;
use crate::several_state::{StoredBearing, other_shaft};

/// Of the equilibrium itself, of that from which the next ones start, of that from which it was found.
const SHAFT: [&str; 3] = ["list_shaft", "list_start_shaft", "list_from_shaft"];
const BODIES: [&str; 3] = [
    "list_forces_on_bodies",
    "list_start_forces_on_bodies",
    "list_from_forces_on_bodies",
];
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
    pub taken: Taken<AssemblyPointStart>,
    pub counts: ListCounts,
    /// What each bearing knows of the whole run by `[output.reduction]`.
    pub reductions: Vec<Arrays>,
}

/// The arrays of a bearing, by its number.
pub fn arrays(taken: &Taken<AssemblyPointStart>, counts: &ListCounts, bearing: usize) -> Arrays {
    let start = (taken.start != taken.before).then_some(&taken.start);
    let from = taken.from.as_ref().filter(|from| **from != taken.start);
    let of_bearing = |point: &AssemblyPointStart| PointStart {
        displacements: point.equilibrium.bearings[bearing].clone(),
        columns: point.columns[bearing].clone(),
    };
    let [own_start, own_from] = [start, from].map(|point| point.map(of_bearing));
    let earlier = [own_start.as_ref(), own_from.as_ref()];
    let mut arrays = rest_state::store_point(&of_bearing(&taken.before), earlier);
    for (k, point) in [Some(&taken.before), start, from].into_iter().enumerate() {
        let Some(AssemblyPointStart { equilibrium, .. }) = point else {
            continue;
        };
        let shaft = StateArray::Real(equilibrium.shaft.clone());
        arrays.insert(SHAFT[k].to_string(), shaft);
        let on_bodies = equilibrium.on_bodies.concat();
        if !on_bodies.is_empty() {
            arrays.insert(BODIES[k].to_string(), StateArray::Real(on_bodies));
        }
    }
    let integers = |values: &[u64]| {
        let stored = |count: &u64| i64::try_from(*count).expect("nobody counts to 2^63");
        StateArray::Integer(values.iter().map(stored).collect())
    };
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
    let (mut stored, mut of_bearings) = ([const { Vec::new() }; 3], Vec::new());
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
        let mut take = |name: &str| arrays.remove(name);
        let own = (SHAFT.map(&mut take), BODIES.map(&mut take), take(COUNTS));
        if *of_list.get_or_insert_with(|| own.clone()) != own {
            return Err(other_shaft(&bearing.folder, (dir, step)));
        }
        of_bearings.push(counts::<2>(arrays.remove(ROUNDS)).ok_or_else(missing)?);
        let (own, [start, from]) = rest_state::load_point(arrays, &mounted.model).with_context(at)?;
        let points = [Some(own), start, from].into_iter();
        stored
            .iter_mut()
            .zip(points)
            .for_each(|(all, point)| all.extend(point));
    }
    let (shafts, on_bodies, of_run) = of_list.ok_or_else(missing)?;
    let mut points = shafts.into_iter().zip(on_bodies).zip(stored);
    let mut next = || {
        let (of_list, own) = points.next().expect("there are three");
        let is_there = of_list.0.is_some() || !own.is_empty();
        let point = is_there.then(|| start_of_list(of_list, own, (assembly, solver)).ok_or_else(missing));
        point.transpose()
    };
    let (before, start, from) = (next()?.ok_or_else(missing)?, next()?, next()?);
    let start = start.unwrap_or_else(|| before.clone());
    let [iterations, warned] = counts(of_run).ok_or_else(missing)?;
    Ok(RestoredEquilibrium {
        taken: Taken {
            n: step,
            from: from.or_else(|| (step > 0).then(|| start.clone())),
            start,
            before,
        },
        counts: ListCounts {
            iterations,
            warned,
            of_bearings,
        },
        reductions,
    })
}

/// An equilibrium of a list, from arrays of the shaft and of forces on bodies, and from its bearings; None where they
/// do not fit the list.
fn start_of_list(
    (shaft, on_bodies): (Option<StateArray>, Option<StateArray>),
    bearings: Vec<PointStart>,
    (assembly, solver): (&Assembly, &AssemblySolver),
) -> Option<AssemblyPointStart> {
    if bearings.len() != assembly.bearings.len() {
        return None;
    }
    let mut forces = solver.no_forces_on_bodies();
    let mut all = match forces.iter().map(Vec::len).sum() {
        0 => Vec::new(),
        length => reals(on_bodies, length)?,
    }
    .into_iter();
    let each = forces.iter_mut().flatten().zip(&mut all);
    each.for_each(|(to, from)| *to = from);
    let of_bearing = |point: PointStart| (point.displacements, point.columns);
    let (displacements, columns) = bearings.into_iter().map(of_bearing).unzip();
    Some(AssemblyPointStart {
        equilibrium: AssemblyStart {
            shaft: reals(shaft, assembly.shaft.n())?,
            bearings: displacements,
            on_bodies: forces,
        },
        columns,
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
