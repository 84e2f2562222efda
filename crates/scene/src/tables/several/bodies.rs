//! `[[body]]` in a list of bearings: each carries the rings that its seats name, outer or inner ones.
//!
//! The mesh of a body stands as its bearing's seat does in the frame of the shaft, whichever way the bearing is turned:
//! in the frame of a bearing that is turned, the body is turned too.

use assembly::Orientation;
use input::Problems;
use serde::Deserialize;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table};

use crate::tables::ring_name::RingName;

/// Key of a seat, of the list alone.
const BEARING: &str = "bearing";

/// What a list asks of a body; all else is checked with its bearing.
#[derive(Debug, Deserialize)]
pub struct RawListedBody {
    #[serde(default)]
    name: String,
    stiffness: Option<String>,
    seat_nodes: Option<String>,
    #[serde(default)]
    seat: Vec<RawListedSeat>,
}

#[derive(Debug, Deserialize)]
struct RawListedSeat {
    ring: RingName,
    bearing: Option<String>,
    group: Option<String>,
    seat_nodes: Option<String>,
    reference_node: Option<i64>,
}

/// Every seat names one of the bearings `names`, and every ring has one body at most.
pub fn check(bodies: &[RawListedBody], names: &[&str], problems: &mut Problems) {
    let known = names.join(", ");
    // Of two bearings of one name, which is said elsewhere, a seat may mean the one whose name is missing.
    let have_twins = (1..names.len()).any(|i| names[..i].contains(&names[i]));
    let mut taken: Vec<(&str, &str, RingName)> = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let name = body.name.as_str();
        if bodies[..number].iter().any(|other| other.name == name) {
            problems.add(format!(
                "body.name {name:?} stands twice; expected a name of its own for each body"
            ));
        }
        body.check_seats(problems);
        for seat in &body.seat {
            let Some(bearing) = seat.bearing.as_deref() else {
                problems.add(format!(
                    "body {name:?} has a seat without `bearing`; expected the name of the bearing that it carries, one \
                     of {known}"
                ));
                continue;
            };
            if !names.contains(&bearing) && !have_twins {
                problems.add(format!(
                    "body {name:?} has a seat for the bearing {bearing:?}; expected one of {known}"
                ));
            }
            let key = seat.ring.key();
            let same = taken
                .iter()
                .find(|(_, of, ring)| (*of, *ring) == (bearing, seat.ring));
            if let Some((other, ..)) = same {
                problems.add(match *other == name {
                    true => format!(
                        "body {name:?} has two seats for the {key} ring of the bearing {bearing:?}; expected one seat \
                         for each ring"
                    ),
                    false => format!(
                        "bodies {other:?} and {name:?} have both a seat for the {key} ring of the bearing \
                         {bearing:?}; expected one body"
                    ),
                });
            }
            taken.push((name, bearing, seat.ring));
        }
    }
}

impl RawListedBody {
    /// What several seats of one body ask for.
    fn check_seats(&self, problems: &mut Problems) {
        let name = self.name.as_str();
        if self.stiffness.is_some() && self.seat.len() > 1 && self.seat_nodes.is_some() {
            problems.add(format!(
                "body {name:?} has {} seats, but names nodes of one, in seat_nodes of [[body]]; expected seat_nodes in \
                 each [[body.seat]]",
                self.seat.len()
            ));
        }
        let rings = |ring: RingName| self.seat.iter().any(|seat| seat.ring == ring);
        if rings(RingName::Inner) && rings(RingName::Outer) {
            problems.add(format!(
                "body {name:?} has seats of inner and of outer rings, but it either turns with the shaft or stands; \
                 expected seats of one kind"
            ));
        }
        let group = |seat: &RawListedSeat| seat.group.clone();
        let nodes = |seat: &RawListedSeat| seat.seat_nodes.clone();
        self.require_different("group", group, problems);
        let reference = |seat: &RawListedSeat| seat.reference_node.map(|node| node.to_string());
        self.require_different("seat_nodes", nodes, problems);
        self.require_different("reference_node", reference, problems);
    }

    /// Seats stand at different places of the body.
    fn require_different(
        &self,
        key: &str,
        of_seat: impl Fn(&RawListedSeat) -> Option<String>,
        problems: &mut Problems,
    ) {
        let values: Vec<String> = self.seat.iter().filter_map(of_seat).collect();
        for (number, value) in values.iter().enumerate() {
            if values[..number].contains(value) {
                problems.add(format!(
                    "body {:?} has two seats with the {key} {value:?}; expected a {key} of its own for each seat",
                    self.name
                ));
            }
        }
    }
}

/// Gives a bearing its bodies, in its own frame and with its own seats, and ties its rings to them.
pub fn place(list: &DocumentMut, document: &mut DocumentMut, (name, orientation): (&str, Orientation)) {
    document.remove("body");
    let bodies = list.get("body").and_then(Item::as_array_of_tables);
    let mut own = ArrayOfTables::new();
    for body in bodies.into_iter().flatten().filter(|body| carries(body, name)) {
        let mut body = body.clone();
        if let Some(seats) = body.get_mut("seat").and_then(Item::as_array_of_tables_mut) {
            seats.retain(|seat| seat.get(BEARING).and_then(Item::as_str) == Some(name));
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
        for ring in rings(&body) {
            if let Some(ring) = document.get_mut(&ring).and_then(Item::as_table_like_mut) {
                ring.insert("support", toml_edit::value("body"));
            }
        }
        own.push(body);
    }
    if !own.is_empty() {
        document.insert("body", Item::ArrayOfTables(own));
    }
}

/// The rings in the seats of a body, as typed.
fn rings(body: &Table) -> Vec<String> {
    let seats = body.get("seat").and_then(Item::as_array_of_tables);
    let ring = |seat: &Table| Some(seat.get("ring")?.as_str()?.to_string());
    seats.into_iter().flatten().filter_map(ring).collect()
}

fn carries(body: &Table, bearing: &str) -> bool {
    let seats = body.get("seat").and_then(Item::as_array_of_tables);
    let names = |seat: &Table| seat.get(BEARING).and_then(Item::as_str) == Some(bearing);
    seats.is_some_and(|seats| seats.iter().any(names))
}
