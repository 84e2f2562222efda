//! Whole-program tests: they start the program `raceway` as a user does and look at what it prints, returns and
//! leaves behind. One binary, a file per area; `fixtures/README.md` says where the inputs come from.

mod bad_input;
mod batch;
mod cuts;
mod damaged_tables;
mod examples;
mod export;
mod hard;
mod integration_points;
mod interruption;
mod life;
mod limits;
mod memory;
mod modes;
mod motion;
mod moved_results;
mod own_files;
mod plot;
mod prices;
mod probes;
mod quasi_static;
mod ranks;
mod readers;
mod remarks;
mod report;
mod results;
mod resume;
mod schedules;
mod sectors;
mod statics;
mod stress;
mod stress_histories;
mod study;
mod study_jobs;
mod sweeps;
mod util;
