//! Interactions: families of links between bodies.

use timer::SharedLaps;

use super::finite::CarriedCircle;
use super::lumped::BodyId;

/// Most lengths of a link: three displacements and three rotations of one body, six lengths of another.
pub const MOST_ROWS: usize = 12;

/// A value for each length of a link; those beyond its number are zero.
pub type LinkRows = [f64; MOST_ROWS];

/// What a link sees of one coordinate: the growth of its lengths with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkTerm {
    /// The body.
    pub body: BodyId,
    /// Its coordinate.
    pub coordinate: usize,
    /// Growth of the lengths.
    pub rows: LinkRows,
}

impl LinkTerm {
    /// A coordinate of a body with the growth of the first lengths.
    pub fn new<const N: usize>(body: BodyId, coordinate: usize, rows: [f64; N]) -> LinkTerm {
        let rows = std::array::from_fn(|i| rows.get(i).copied().unwrap_or(0.0));
        LinkTerm {
            body,
            coordinate,
            rows,
        }
    }
}

/// A link: its lengths are `reach` plus what its terms add, and what its finite motion does.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Lengths when all coordinates are zero, m.
    pub reach: LinkRows,
    /// The coordinates that it sees.
    pub terms: Vec<LinkTerm>,
    /// What its first two lengths have beyond the terms, which are those of small motions; None: nothing.
    pub finite: Option<CarriedCircle>,
}

impl Link {
    /// A link that is linear in its coordinates.
    pub fn linear(reach: LinkRows, terms: Vec<LinkTerm>) -> Link {
        Link {
            reach,
            terms,
            finite: None,
        }
    }
}

impl CarriedCircle {
    /// What lengths [radial, axial] from the circle put into the lengths of the link.
    pub fn in_link(&self, [radial, axial]: [f64; 2]) -> LinkRows {
        let (first, sign) = self.place();
        let mut rows = LinkRows::default();
        rows[first] = sign * radial;
        rows[first + 1] = sign * axial;
        rows
    }

    /// Forces on the lengths from the circle, of those of the link.
    pub fn of_link(&self, forces: &[f64]) -> [f64; 2] {
        let (first, sign) = self.place();
        [sign * forces[first], sign * forces[first + 1]]
    }
}

/// Lengths of all links of a family, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Lengths<'l> {
    /// At the start of the interval, m.
    pub start: &'l [f64],
    /// At its end, m.
    pub end: &'l [f64],
}

impl Lengths<'_> {
    /// Of a family of links with `N` lengths each: those of one link at start and end.
    pub fn of<const N: usize>(&self, link: usize) -> [[f64; N]; 2] {
        [self.start, self.end].map(|all| std::array::from_fn(|i| all[N * link + i]))
    }
}

/// Forces of all links of a family, one after the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinkForces {
    /// Work of the link per growth of each of its lengths, N: what resists that growth.
    pub forces: Vec<f64>,
    /// Their growth with the lengths at the end, N/m, row-major by link.
    pub tangents: Vec<f64>,
}

/// What Newton may rely on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Character {
    /// Forces are the gradient of a convex energy: tangents are symmetric and not negative.
    Potential,
    /// Tangents may be of any kind.
    General,
}

/// A family of links of one kind.
pub trait Interaction: Send + Sync {
    /// The links.
    fn links(&self) -> &[Link];

    /// Number of lengths of each of them.
    fn n_rows(&self) -> usize;

    /// What Newton may rely on.
    fn character(&self) -> Character;

    /// Forces at given lengths. The wall time of effects goes to `costs`.
    fn evaluate(&self, lengths: Lengths, costs: &SharedLaps) -> LinkForces;

    /// Force, N, that the round-off of the lengths makes in all links together: what a light load can be balanced to.
    fn round_off(&self, lengths: Lengths) -> f64;
}
