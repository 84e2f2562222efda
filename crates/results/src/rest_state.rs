//! What an equilibrium leaves to the next one in time, as named arrays: what step files hold and a run resumes from.
//!
//! That is its displacements and the tangents of the contacts on flexible rings. From these the next equilibrium has
//! the same bits as in a run that was never stopped.

use anyhow::{anyhow, ensure};
use checkpoint::StateArray;
use contact::{Meridian, Side};
use dynamics::Model;
use dynamics::displacements::Displacements;
use dynamics::points::PointStart;
use dynamics::statics::ContactColumns;

use super::state_arrays::Arrays;

const SHAFT: &str = "shaft";
const BALLS: &str = "balls";
const SEAT: &str = "seat";
const GROOVES: [&str; 2] = ["grooves_inner", "grooves_outer"];
const COLUMNS: [&str; 2] = ["columns_inner", "columns_outer"];
/// Before the names of earlier equilibria: from which the next ones start, and from which it was found.
const EARLIER: [&str; 2] = ["start_", "from_"];

/// The arrays of an equilibrium: displacements, m and rad, and inverse compliances of the contacts, N/m.
pub fn store(displacements: &Displacements, columns: &ContactColumns) -> Arrays {
    let Displacements {
        shaft,
        balls,
        grooves,
        seat,
    } = displacements;
    let mut all = vec![
        (SHAFT, shaft.to_vec()),
        (BALLS, Meridian::flat(balls)),
        (SEAT, vec![*seat]),
    ];
    for side in Side::BOTH {
        let i = side.index();
        if !grooves[i].is_empty() {
            all.push((GROOVES[i], Meridian::flat(&grooves[i])));
        }
        if let Some(columns) = &columns[i] {
            all.push((COLUMNS[i], columns.clone()));
        }
    }
    let array = |(name, values): (&str, Vec<f64>)| (name.to_string(), StateArray::Real(values));
    all.into_iter().map(array).collect()
}

/// The same of a point, and of earlier ones: from which the next points start, and from which it was found.
pub fn store_point(own: &PointStart, earlier: [Option<&PointStart>; 2]) -> Arrays {
    let mut arrays = store(&own.displacements, &own.columns);
    for (prefix, earlier) in EARLIER.into_iter().zip(earlier) {
        let stored = earlier.map(|earlier| store(&earlier.displacements, &earlier.columns));
        let named = stored.into_iter().flatten();
        arrays.extend(named.map(|(name, values)| (format!("{prefix}{name}"), values)));
    }
    arrays
}

/// What [`store_point`] has stored of a model.
pub fn load_point(mut own: Arrays, model: &Model) -> anyhow::Result<(PointStart, [Option<PointStart>; 2])> {
    let load = |arrays: Arrays| {
        load(arrays, model).map(|(displacements, columns)| PointStart {
            displacements,
            columns,
        })
    };
    let mut earlier = [None, None];
    for (prefix, earlier) in EARLIER.into_iter().zip(&mut earlier) {
        let (named, others): (Arrays, Arrays) =
            own.into_iter().partition(|(name, _)| name.starts_with(prefix));
        own = others;
        if !named.is_empty() {
            let bare = |(name, values): (String, _)| (name[prefix.len()..].to_string(), values);
            *earlier = Some(load(named.into_iter().map(bare).collect())?);
        }
    }
    Ok((load(own)?, earlier))
}

/// What was stored of an equilibrium of a model, bit for bit; fails where an array is missing, unknown or of another
/// length.
pub fn load(mut arrays: Arrays, model: &Model) -> anyhow::Result<(Displacements, ContactColumns)> {
    let n_balls = model.geometry.n_balls;
    let mut take = |name: &str, length: usize| match arrays.remove(name) {
        Some(StateArray::Real(values)) if values.len() == length => Ok(values),
        Some(_) => Err(anyhow!(
            "the state array {name} is not as expected, {length} real numbers"
        )),
        None => Err(anyhow!(
            "there is no state array {name}; expected that of an equilibrium in time"
        )),
    };
    let shaft = take(SHAFT, 5)?;
    let balls = take(BALLS, 2 * n_balls)?;
    let seat = take(SEAT, 1)?[0];
    let (mut grooves, mut columns) = ([Vec::new(), Vec::new()], ContactColumns::default());
    for side in Side::BOTH {
        let i = side.index();
        if model.ring(side).is_some() {
            grooves[i] = Meridian::list(&take(GROOVES[i], 2 * n_balls)?);
            columns[i] = Some(take(COLUMNS[i], (2 * n_balls).pow(2))?);
        }
    }
    let unknown = arrays.keys().next();
    ensure!(
        unknown.is_none(),
        "the state array {} is not known to this version",
        unknown.map_or("", String::as_str)
    );
    let displacements = Displacements {
        shaft: std::array::from_fn(|i| shaft[i]),
        balls: Meridian::list(&balls),
        grooves,
        seat,
    };
    Ok((displacements, columns))
}
