//! A ring as a vibrating body.

mod body;
mod coordinates;
mod products;

pub use body::{Partner, RingBody};
