//! Whole-program tests: they start the program `raceway` as a user does and look at what it prints, returns and
//! leaves behind. One binary, a file per area; `fixtures/README.md` says where the inputs come from.

mod bad_input;
mod export;
mod interruption;
mod memory;
mod motion;
mod readers;
mod results;
mod resume;
mod statics;
mod sweeps;
mod util;
