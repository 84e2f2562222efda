//! Whole-program tests: they start the program `raceway` as a user does and look at what it prints, returns and
//! leaves behind. One binary, a file per area; `fixtures/README.md` says where the inputs come from.

mod bad_input;
mod memory;
mod modes;
mod motion;
mod results;
mod statics;
mod sweeps;
mod util;
