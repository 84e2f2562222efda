//! The nonlinear system of a bearing between two instants: bodies, interactions between them, one Newton.
//!
//! A body has *coordinates*, the displacements that others see, and unknowns that place them: [`Lumped`] ones few of
//! their own, [`ElasticPorts`] the motion at the ports of an elastic body. An [`Interaction`] is a family of links;
//! each sees a few lengths that grow with the coordinates, and answers with the forces that belong to them.
//!
//! ```text
//! coordinates  q = place(x)                          by body
//! lengths      l = reach + sum of rows q + c(q)      by link; c of a finite motion only
//! residual     balance(x) + K (g - offset) + (dl/dx)^T F(l)
//! tangent      its derivative, of which bodies give the constant part
//! ```
//!
//! Over a step dl/dx are mean slopes, with which forces do the work of the lengths they belong to.
//!
//! At rest forces are those of the instant, and the residual is the gradient of the energy if all interactions have
//! one. Over a step they are means over it. This module knows no bearing: statics, motion and equilibria in time
//! differ by their bodies, and by the policy of [`newton`].
//!
//! The order of a sum is that of the lists, so equal lists give equal bits: lumped bodies, elastic ones, links.

mod assembly;
mod elastic;
mod finite;
mod interaction;
mod lumped;
mod moves;
pub mod newton;
pub mod tangent;
#[cfg(test)]
mod tests;

pub use assembly::{Evaluated, System};
pub use elastic::{ElasticPorts, Follow};
#[cfg(test)]
pub(crate) use finite::tests::rotated;
pub use finite::{
    CarriedCircle, Circle, CircleLengths, Curvature, FiniteCoordinates, FiniteMotion, FiniteRows, N_FINITE,
    angle_functions,
};
pub use interaction::{Character, Interaction, Lengths, Link, LinkForces, LinkRows, LinkTerm, MOST_ROWS};
pub use lumped::{BodyId, Interval, Lumped};
