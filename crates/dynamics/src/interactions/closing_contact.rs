//! How damped contacts close, to first order.

use contact::Meridian;

use super::raceway_contact::SiteState;

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
    /// Of a ball and of what carries its ring, whose motions start at these unknowns; `ports` is the unknown of the
    /// first of an elastic ring.
    pub fn new(
        (state, damping): (&SiteState, f64),
        (ball, ports): (usize, Option<usize>),
        carrier: Option<(usize, [Meridian; 5])>,
    ) -> ClosingContact {
        let n = state.normal.to_array();
        let along = |first: usize, sign: f64| [0, 1].map(|i| (first + i, sign * n[i]));
        let carried = carrier.into_iter().flat_map(|(first, motions)| {
            let row = move |(j, motion): (usize, &Meridian)| (first + j, -state.normal.dot(*motion));
            motions.iter().enumerate().map(row).collect::<Vec<_>>()
        });
        ClosingContact {
            rows: along(ball, 1.0).into_iter().chain(carried).collect(),
            of_ring: ports.map_or(Vec::new(), |first| along(first, -1.0).to_vec()),
            damping,
        }
    }
}
