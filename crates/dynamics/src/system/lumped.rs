//! Bodies with few coordinates of their own.

use ring::StepScheme;

/// Between which instants a system is in balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Interval {
    /// At one instant: nothing has inertia.
    Rest,
    /// Over a step in time.
    Step(StepScheme),
}

/// A body of a system: its place in the list of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyId {
    /// A lumped body.
    Lumped(usize),
    /// The ports of an elastic one.
    Elastic(usize),
}

/// A body that its own unknowns place.
pub trait Lumped: Send + Sync {
    /// Number of unknowns.
    fn n_unknowns(&self) -> usize;

    /// Number of coordinates. By default, as [`place`](Lumped::place) and [`slopes`](Lumped::slopes), that of a body
    /// whose unknowns are its coordinates.
    fn n_coordinates(&self) -> usize {
        self.n_unknowns()
    }

    /// Coordinates at the start of the interval, m and rad.
    fn start(&self) -> &[f64];

    /// Coordinates at its end for the unknowns `x`.
    fn place(&self, x: &[f64], end: &mut [f64]) {
        end.copy_from_slice(x);
    }

    /// Growth of the coordinates with the unknowns at `x`: (coordinate, unknown, value), in ascending order. Where it
    /// changes with `x`, Newton's tangent leaves that change out and converges linearly.
    fn slopes(&self, x: &[f64]) -> Vec<(usize, usize, f64)> {
        (0..x.len()).map(|i| (i, i, 1.0)).collect()
    }

    /// Unknowns when nothing accelerates.
    fn guess(&self, interval: Interval) -> Vec<f64>;

    /// Forces that the body asks for to be placed by `x`, less its loads, N and N m.
    fn balance(&self, interval: Interval, x: &[f64], residual: &mut [f64]);

    /// Growth of these with the unknowns, row-major; constant over an interval.
    fn tangent(&self, interval: Interval) -> Vec<f64>;

    /// What gives an unknown a place that nothing resists, for messages.
    fn remedy(&self) -> &'static str;

    /// What an unknown is, for messages.
    fn name(&self, unknown: usize) -> String;
}
