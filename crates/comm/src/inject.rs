//! Faults on request, to test that a fault of one rank ends all.
//!
//! `RACEWAY_INJECT` says what: `list` prints a line `op OPERATION PLACE` on rank 0 for every message, PLACE being the
//! line of the program that sends it. `KIND RANK PLACE NUMBER` makes one fault on one rank at the message that this
//! rank sends from PLACE for the NUMBER-th time, from 1.
//! Kinds: `error` fails an agreement, `panic` panics before a message, `nan` spoils the numbers of a message that this
//! rank gets.

use std::panic::Location;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The fault asked for.
struct Fault {
    kind: String,
    rank: usize,
    place: String,
    number: usize,
}

fn variable() -> &'static str {
    static TEXT: OnceLock<String> = OnceLock::new();
    TEXT.get_or_init(|| std::env::var("RACEWAY_INJECT").unwrap_or_default())
}

fn fault() -> Option<&'static Fault> {
    static FAULT: OnceLock<Option<Fault>> = OnceLock::new();
    let read = || {
        let [kind, rank, place, number] = variable().split(' ').collect::<Vec<&str>>()[..] else {
            return None;
        };
        Some(Fault {
            kind: kind.to_string(),
            rank: rank.parse().expect("a rank in RACEWAY_INJECT"),
            place: place.to_string(),
            number: number.parse().expect("a number in RACEWAY_INJECT"),
        })
    };
    FAULT.get_or_init(read).as_ref()
}

/// What to do to a message: the kind of the fault, when it is the one asked for. Panics if that is a panic.
pub(crate) fn before(operation: &str, rank: usize, place: &Location<'_>) -> Option<&'static str> {
    static SENT: AtomicUsize = AtomicUsize::new(0);
    let place = format!("{}:{}", place.file(), place.line());
    if variable() == "list" && rank == 0 {
        eprintln!("op {operation} {place}");
    }
    let fault = fault().filter(|fault| fault.rank == rank && fault.place == place)?;
    if SENT.fetch_add(1, Ordering::Relaxed) + 1 != fault.number {
        return None;
    }
    assert!(fault.kind != "panic", "injected at {place}");
    Some(&fault.kind)
}
