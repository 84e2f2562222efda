//! What links see of elastic bodies besides their ports: it moves with all ports, and no force acts there.
//!
//! Of the tangent only the ports of the same link are kept. Those of others move it a hundred times less: left out,
//! they leave Newton its order of convergence down to round-off, and blocks of unknowns the few others that they see.

use super::super::interaction::{Link, LinkRows, LinkTerm};
use super::super::lumped::Body;
use super::System;

impl System<'_> {
    /// Adds the growth of a link's forces, with tangents `t` over its `m` lengths and the unknowns `moved` that they
    /// act on, with what it sees.
    pub(super) fn add_seen(
        &self,
        link: &Link,
        (t, m): (&[f64], usize),
        moved: &[(usize, LinkRows)],
        tangent: &mut [f64],
    ) {
        let n = self.n();
        for term in &link.terms {
            let Body::Elastic(number) = term.body else {
                continue;
            };
            let body = self.elastic[number];
            let Some(place) = term.coordinate.checked_sub(body.n_moving) else {
                continue;
            };
            let mut growth = LinkRows::default();
            for (sum, row) in growth.iter_mut().zip(t.chunks_exact(m)) {
                *sum = row.iter().zip(&term.rows).map(|(t, r)| t * r).sum();
            }
            let by_ports = &body.seen.by_ports[place * body.offset.len()..];
            let first = self.unknowns(term.body).start;
            let same = |other: &&LinkTerm| other.body == term.body;
            let ports = link.terms.iter().filter(same).map(|other| other.coordinate);
            for port in ports.filter(|port| *port < body.n_moving) {
                for (a, row) in moved {
                    let grown: f64 = row.iter().zip(&growth).map(|(r, g)| r * g).sum();
                    tangent[n * a + first + port] += grown * by_ports[port];
                }
            }
        }
    }
}
