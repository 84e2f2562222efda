//! Interactions of a bearing's bodies.

pub mod between_contacts;
pub mod cage;
pub mod carried_site;
pub mod closing_contact;
pub mod contact_damping;
mod contact_ends;
pub mod discrete_gradient;
pub mod free_contact;
pub mod raceway_contact;
pub mod seat_spring;
pub mod steady_rolling;
pub mod strip_contact;
pub mod traction;
