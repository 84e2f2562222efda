//! How damped contacts close, to first order.

use std::ops::Range;

/// How a contact closes, and its damping.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosingContact {
    /// Growth of its approach with unknowns, by their numbers.
    pub rows: Vec<(usize, f64)>,
    /// The same with what its elastic ring gives way.
    pub of_ring: Vec<(usize, f64)>,
    /// Damping coefficient, N s/m.
    pub damping: f64,
}

impl ClosingContact {
    /// Of the growth of its approach with all unknowns that move it; `ports` are those of its elastic ring.
    pub fn new(growth: Vec<(usize, f64)>, damping: f64, ports: Option<Range<usize>>) -> ClosingContact {
        let is_port = |(unknown, _): &(usize, f64)| ports.as_ref().is_some_and(|p| p.contains(unknown));
        let (of_ring, rows): (Vec<_>, Vec<_>) =
            growth.into_iter().filter(|(_, g)| *g != 0.0).partition(is_port);
        ClosingContact {
            rows,
            of_ring,
            damping,
        }
    }
}
