//! A ring in sectors against the ring as a whole and against dense solutions.

mod columns;
#[path = "../../benches/support/refined.rs"]
mod refined;
mod rings;
mod solve;
mod wrong;
