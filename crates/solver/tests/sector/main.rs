//! A ring in sectors against the ring as a whole and against dense solutions.

mod columns;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../benches/support/refined.rs"]
mod refined;
mod rings;
mod solve;
mod wrong;
