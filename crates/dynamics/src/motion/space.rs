//! Where the vectors of a ring's state, increments and loads live: as coordinates, or as harmonics of a periodic ring.
//!
//! The state of a periodic ring never leaves harmonic space while it moves: matrices act there harmonic by harmonic
//! ([`solver::cyclic::HarmonicOperator`]), and so does the inertia of a turning frame, which is local in cylindrical components. Nodal
//! fields are made when results ask for them. Scalar products of nodal vectors are those of Parseval. The dofs of a shaft that
//! carries the bore stay what they are, behind the harmonics.

use std::sync::OnceLock;

use mesh::NodePositions;
use rayon::prelude::*;
use solver::cyclic::{HarmonicOperator, add_turned};
use solver::{CyclicRing, SolverError};

use super::coordinates::Coordinates;
use super::integrator::Integrator;
use super::matrices::RingMatrices;
use super::ring_state::{Measures, RingState};
use crate::effects::FrameTurn;
use crate::sectors::Sectors;
use crate::solution::dot;

/// The space of a ring's vectors.
pub enum Space {
    /// Coordinates, `[n]`.
    Nodal,
    /// Harmonics of the free nodes, then the shaft's dofs, `[harmonic_len + m]`.
    Harmonic(Box<HarmonicSpace>),
}

/// Harmonic space and what acts in it.
pub struct HarmonicSpace {
    ring: CyclicRing,
    n_shaft: usize,
    /// M.
    pub(super) mass: HarmonicOperator,
    /// K.
    pub(super) stiffness: HarmonicOperator,
    /// Made when a frame turns for the first time.
    frame: OnceLock<FrameLoads>,
}

/// Inertia of a turning frame beyond that of the free nodes' motion, as low vectors: M P and M J of fields, with P u = (u_x, u_y, 0)
/// and J u = (u_y, -u_x, 0).
struct FrameLoads {
    /// Of the node positions.
    position: [Vec<f64>; 2],
    /// Of the motion of the held nodes with each dof of the shaft.
    shaft: Vec<[Vec<f64>; 2]>,
}

/// A ring's matrices between nodes, from which a space takes what the shaft adds.
#[derive(Clone, Copy)]
pub(super) struct Nodes<'a> {
    pub coordinates: &'a Coordinates,
    pub matrices: &'a RingMatrices,
    /// m, `[n_nodes][3]` flat.
    pub positions: &'a NodePositions,
}

impl Nodes<'_> {
    /// Columns of c_M M + c_K K that belong to the shaft dofs: the rows of the free dofs, column-major, and those of the
    /// shaft, row-major.
    pub fn border(&self, [cm, ck]: [f64; 2]) -> [Vec<f64>; 2] {
        let (n_free, n) = (self.coordinates.free().len(), self.coordinates.n());
        let (mut border, mut corner) = (Vec::new(), Vec::new());
        for k in n_free..n {
            let [m, k] = [cm, ck].map(|c| self.unit(k, c));
            let column = self.matrices.sum_of_products(self.coordinates, &m, &k);
            border.extend_from_slice(&column[..n_free]);
            corner.extend_from_slice(&column[n_free..]);
        }
        [border, corner]
    }

    /// Coordinates that are zero but for one.
    fn unit(&self, index: usize, value: f64) -> Vec<f64> {
        let mut unit = vec![0.0; self.coordinates.n()];
        unit[index] = value;
        unit
    }
}

impl Space {
    /// Harmonic space of the free nodes of a periodic ring.
    pub(super) fn harmonic(free: &Sectors, nodes: Nodes<'_>) -> Result<Space, SolverError> {
        let operator = |matrix, coefficients| {
            let [border, corner] = nodes.border(coefficients);
            HarmonicOperator::new(&free.ring, matrix, &border, &corner)
        };
        Ok(Space::Harmonic(Box::new(HarmonicSpace {
            n_shaft: nodes.coordinates.shaft().0.len(),
            mass: operator(&free.mass, [1.0, 0.0])?,
            stiffness: operator(&free.stiffness, [0.0, 1.0])?,
            ring: free.ring.clone(),
            frame: OnceLock::new(),
        })))
    }

    /// Length of a vector of a ring of `n` coordinates.
    pub fn len(&self, n: usize) -> usize {
        match self {
            Space::Nodal => n,
            Space::Harmonic(space) => space.ring.harmonic_len() + space.n_shaft,
        }
    }

    /// The vector with the coordinates `y`.
    pub fn of_coordinates(&self, y: Vec<f64>) -> Vec<f64> {
        match self {
            Space::Nodal => y,
            Space::Harmonic(space) => to_harmonics(&space.ring, &y),
        }
    }

    /// Coordinates of the vector `x`.
    pub fn coordinates(&self, x: &[f64]) -> Vec<f64> {
        match self {
            Space::Nodal => x.to_vec(),
            Space::Harmonic(space) => from_harmonics(&space.ring, x),
        }
    }

    /// Scalar product of the coordinates of two vectors.
    pub fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        match self {
            Space::Nodal => dot(a, b),
            Space::Harmonic(space) => {
                let len = space.ring.harmonic_len();
                space.ring.harmonic_dot(&a[..len], &b[..len]) + dot(&a[len..], &b[len..])
            }
        }
    }

    /// A bound of the sum of the magnitudes of the coordinates of `x`: the root of the sum of their squares times that of their number.
    pub fn size(&self, x: &[f64]) -> f64 {
        (self.n(x) as f64 * self.dot(x, x)).sqrt()
    }

    /// Whether the sum of the magnitudes of the coordinates of `x` is at most `limit`. It lies between the root of the sum of their
    /// squares and [`Space::size`]; only where that does not decide, harmonics are transformed.
    pub fn is_within(&self, limit: f64, x: &[f64]) -> bool {
        let least = self.dot(x, x).sqrt();
        if least > limit {
            return false;
        }
        let sum = || self.coordinates(x).iter().map(|c| c.abs()).sum::<f64>();
        (self.n(x) as f64).sqrt() * least <= limit || sum() <= limit
    }

    /// Number of coordinates of the vector `x`.
    fn n(&self, x: &[f64]) -> usize {
        match self {
            Space::Nodal => x.len(),
            Space::Harmonic(space) => space.ring.n() + space.n_shaft,
        }
    }
}

/// Harmonics and border of the coordinates `y`.
pub(super) fn to_harmonics(ring: &CyclicRing, y: &[f64]) -> Vec<f64> {
    let (free, border) = y.split_at(ring.n());
    let mut x = vec![0.0; ring.harmonic_len() + border.len()];
    let (harmonics, rows) = x.split_at_mut(ring.harmonic_len());
    ring.to_harmonic(free, harmonics);
    rows.copy_from_slice(border);
    x
}

/// Coordinates of the harmonics and border `x`.
pub(super) fn from_harmonics(ring: &CyclicRing, x: &[f64]) -> Vec<f64> {
    let (harmonics, border) = x.split_at(ring.harmonic_len());
    let mut y = vec![0.0; ring.n() + border.len()];
    let (free, rows) = y.split_at_mut(ring.n());
    ring.from_harmonic(harmonics, free);
    rows.copy_from_slice(border);
    y
}

impl HarmonicSpace {
    /// M v and K w, and the energies, J.
    pub(super) fn measures(&self, v: &[f64], w: &[f64]) -> Measures {
        let (mass, stiffness) = rayon::join(|| self.mass.product(v), || self.stiffness.product(w));
        let len = self.ring.harmonic_len();
        let groups = 0..len.checked_div(self.ring.low_len()).unwrap_or(0);
        let sums = groups.into_par_iter().map(|group| {
            let range = self.ring.low_len() * group..self.ring.low_len() * (group + 1);
            let dot = |a: &[f64], b: &[f64]| self.ring.group_dot(group, &a[range.clone()], &b[range.clone()]);
            [dot(v, &mass), dot(w, &stiffness)]
        });
        let sums: Vec<[f64; 2]> = sums.collect();
        self.measured([v, w], [mass, stiffness], &sums)
    }

    /// Measures from the products and each group's part of their scalar products.
    fn measured(&self, [v, w]: [&[f64]; 2], products: [Vec<f64>; 2], sums: &[[f64; 2]]) -> Measures {
        let len = self.ring.harmonic_len();
        let [mut kinetic, mut strain] = [0.0; 2];
        for [m, k] in sums {
            kinetic += m;
            strain += k;
        }
        kinetic += dot(&v[len..], &products[0][len..]);
        strain += dot(&w[len..], &products[1][len..]);
        Measures {
            products,
            energies: [0.5 * kinetic, 0.5 * strain],
        }
    }

    /// The state at the end of a step from `old` with the increment `dw`, with its measures: one pass over the groups of harmonics.
    pub(super) fn advanced(&self, integrator: Integrator, dt: f64, old: &RingState, dw: &[f64]) -> RingState {
        let (n, len, low) = (dw.len(), self.ring.harmonic_len(), self.ring.low_len());
        let [mut w, mut v, mut a, mut mass, mut stiffness] = [(); 5].map(|()| vec![0.0; n]);
        let groups = w[..len]
            .par_chunks_mut(low)
            .zip(v[..len].par_chunks_mut(low))
            .zip(a[..len].par_chunks_mut(low))
            .zip(
                mass[..len]
                    .par_chunks_mut(low)
                    .zip(stiffness[..len].par_chunks_mut(low)),
            );
        let sums = groups.enumerate().map(|(group, (((w, v), a), (m, k)))| {
            old.advance_part(integrator, dt, dw, low * group, [w, v, a]);
            self.mass.group_product(group, v, m);
            self.stiffness.group_product(group, w, k);
            [self.ring.group_dot(group, v, m), self.ring.group_dot(group, w, k)]
        });
        let mut sums: Vec<[f64; 2]> = sums.collect();
        let shaft = [&mut w[len..], &mut v[len..], &mut a[len..]];
        old.advance_part(integrator, dt, dw, len, shaft);
        if self.n_shaft > 0 {
            self.mass.add_border(&v, &mut mass);
            self.stiffness.add_border(&w, &mut stiffness);
            sums[0] =
                [(&v, &mass), (&w, &stiffness)].map(|(x, y)| self.ring.group_dot(0, &x[..low], &y[..low]));
        }
        let measures = self.measured([&v, &w], [mass, stiffness], &sums);
        let mut new = RingState::new(w, v, a);
        new.keep(measures);
        new
    }

    /// Generalised inertia load of the turning frame, see [`super::body::RingBody::frame_load`]: one pass over the groups of
    /// harmonics.
    pub(super) fn frame_load(
        &self,
        turn: FrameTurn,
        nodes: Nodes<'_>,
        (integrator, dt): (Integrator, f64),
        (old, dw): (&RingState, Option<&[f64]>),
    ) -> Vec<f64> {
        let (speed, acceleration) = (turn.speed, turn.acceleration);
        let (n, len, low) = (
            old.displacement().len(),
            self.ring.harmonic_len(),
            self.ring.low_len(),
        );
        let mut load = vec![0.0; n];
        let buffers = || ([vec![0.0; low], vec![0.0; low]], vec![0.0; low]);
        let first = |group: usize, (within, field): &mut ([Vec<f64>; 2], Vec<f64>)| {
            old.part_within(integrator, dt, dw, low * group, within);
            // J u = -e_z x u.
            field.fill(0.0);
            add_turned([speed * speed, -acceleration], &within[0], field);
            add_turned([0.0, -2.0 * speed], &within[1], field);
        };
        load[..len]
            .par_chunks_mut(low)
            .enumerate()
            .for_each_init(buffers, |buffers, (group, load)| {
                first(group, buffers);
                self.mass.group_product(group, &buffers.1, load);
            });
        // The rows of the shaft, which move with the first group alone.
        let mut lowest = buffers();
        first(0, &mut lowest);
        self.mass.add_rows(&lowest.1, &mut load);
        let mut shaft = [vec![0.0; self.n_shaft], vec![0.0; self.n_shaft]];
        old.part_within(integrator, dt, dw, len, &mut shaft);
        let known = self.frame.get_or_init(|| self.frame_loads(nodes));
        let mut add = |[own, turned]: [f64; 2], [p, j]: &[Vec<f64>; 2]| {
            self.ring.add_low(own, p, &mut load);
            self.ring.add_low(turned, j, &mut load);
        };
        add([speed * speed, acceleration], &known.position);
        for (k, of_shaft) in known.shaft.iter().enumerate() {
            let [q, rate] = [shaft[0][k], shaft[1][k]];
            add(
                [speed * speed * q, acceleration * q + 2.0 * speed * rate],
                of_shaft,
            );
        }
        load
    }

    fn frame_loads(&self, nodes: Nodes<'_>) -> FrameLoads {
        let low = |field: Vec<f64>| {
            let load = nodes
                .coordinates
                .reduce(&nodes.matrices.nodal_mass_product(&field));
            let (free, shaft) = load.split_at(self.ring.n());
            self.ring.to_low(free, shaft)
        };
        let loads = |u: &[f64]| {
            let own = u.chunks_exact(3).flat_map(|u| [u[0], u[1], 0.0]);
            let turned = u.chunks_exact(3).flat_map(|u| [u[1], -u[0], 0.0]);
            [low(own.collect()), low(turned.collect())]
        };
        let n_free = nodes.coordinates.free().len();
        let of_shaft = |k: usize| loads(&nodes.coordinates.expand(&nodes.unit(n_free + k, 1.0)));
        FrameLoads {
            position: loads(nodes.positions.as_flattened()),
            shaft: (0..self.n_shaft).map(of_shaft).collect(),
        }
    }
}
