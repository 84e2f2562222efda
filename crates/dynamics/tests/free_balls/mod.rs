//! Free balls on rigid rings against closed forms: rolling, sliding, driven and thrown balls, thrust, ledgers.

mod bearings;
mod cage;
mod closed_forms;
mod conservation;
mod control;
mod flexible;
mod hard;
mod ledger;
mod skid;
mod spheres;
mod steady;
mod surfaces;
mod thrust;
mod worn;
