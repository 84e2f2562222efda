//! `[[body]]` in a list of bearings: each carries the outer ring of one of them, which its seat names.
//!
//! The mesh of a body stands as its bearing's seat does in the frame of the shaft, whichever way the bearing is turned:
//! in the frame of a bearing that is turned, the body is turned too.

use assembly::Orientation;
use input::Problems;
use serde::Deserialize;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table};

/// Key of a seat, of the list alone.
const BEARING: &str = "bearing";

/// What a list asks of a body; all else is checked with its bearing.
#[derive(Debug, Deserialize)]
pub struct RawListedBody {
    #[serde(default)]
    name: String,
    #[serde(default)]
    seat: Vec<RawListedSeat>,
}

#[derive(Debug, Deserialize)]
struct RawListedSeat {
    bearing: Option<String>,
}

/// Every seat names one of the bearings `names`, and every bearing has one body at most.
pub fn check(bodies: &[RawListedBody], names: &[&str], problems: &mut Problems) {
    let known = names.join(", ");
    let mut taken: Vec<(&str, &str)> = Vec::new();
    for body in bodies {
        let name = body.name.as_str();
        if body.seat.len() > 1 {
            problems.add(format!(
                "body {name:?} has {} seats, but a body that carries several bearings is not solved; give each bearing \
                 a [[body]] of its own",
                body.seat.len()
            ));
        }
        for seat in &body.seat {
            let Some(bearing) = seat.bearing.as_deref() else {
                problems.add(format!(
                    "body {name:?} has a seat without `bearing`; expected the name of the bearing that it carries, one \
                     of {known}"
                ));
                continue;
            };
            if !names.contains(&bearing) {
                problems.add(format!(
                    "body {name:?} has a seat for the bearing {bearing:?}; expected one of {known}"
                ));
            }
            if let Some((other, _)) = taken.iter().find(|(_, of)| *of == bearing) {
                problems.add(format!(
                    "bodies {other:?} and {name:?} have both a seat for the bearing {bearing:?}; expected one body"
                ));
            }
            taken.push((name, bearing));
        }
    }
}

/// Gives a bearing its body, in its own frame, and ties its outer ring to it.
pub fn place(list: &DocumentMut, document: &mut DocumentMut, (name, orientation): (&str, Orientation)) {
    document.remove("body");
    let bodies = list.get("body").and_then(Item::as_array_of_tables);
    let mut own = ArrayOfTables::new();
    for body in bodies.into_iter().flatten().filter(|body| carries(body, name)) {
        let mut body = body.clone();
        if let Some(seats) = body.get_mut("seat").and_then(Item::as_array_of_tables_mut) {
            seats.iter_mut().for_each(|seat| {
                seat.remove(BEARING);
            });
        }
        if orientation == Orientation::MinusZ {
            let own = body.get("orientation").and_then(Item::as_str);
            let other = match own.and_then(Orientation::named) {
                Some(Orientation::MinusZ) => Orientation::PlusZ,
                _ => Orientation::MinusZ,
            };
            body.insert("orientation", toml_edit::value(other.name()));
        }
        own.push(body);
    }
    if !own.is_empty() {
        document.insert("body", Item::ArrayOfTables(own));
        if let Some(outer) = document.get_mut("outer").and_then(Item::as_table_like_mut) {
            outer.insert("support", toml_edit::value("body"));
        }
    }
}

fn carries(body: &Table, bearing: &str) -> bool {
    let seats = body.get("seat").and_then(Item::as_array_of_tables);
    let names = |seat: &Table| seat.get(BEARING).and_then(Item::as_str) == Some(bearing);
    seats.is_some_and(|seats| seats.iter().any(names))
}
