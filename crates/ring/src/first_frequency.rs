//! First natural frequency of a ring as it is held, by a partner at rest, and whether it is above another one.
//!
//! The Rayleigh quotient of any shape w that the hold allows is an upper bound of its square,
//!
//! ```text
//! w_1^2  <=  w K w / w M w
//! ```
//!
//! [`first_frequency_bound`] takes the least of a few shapes: of a clamped ring shears that grow with the distance from
//! the held surface, along the axis, the radius and the circumference; of one in its mean motion the oval bending
//! without stretch, u_r = cos 2a, u_t = (3 r / 2 R - 2) sin 2a. It costs a product with K and one with M for each.
//!
//! [`first_frequency`] finds the value by block Lanczos on K^-1 M ([`dense::eigen`]), with K as statics factors it, so
//! for any linear solver and any number of ranks. It comes with a bound of its error. Cost: one factorisation, and some
//! ten solves of four columns.
//!
//! [`first_frequency_above`] asks less. Of a periodic ring without a defect one elimination of K - w^2 M tells whether
//! w_1 > w, without a search ([`solver::cyclic::DefiniteTest`]). A few more take w_1 between bounds 10 % apart. Other
//! rings take the search.

use dense::{DenseError, EigenProblem, LanczosSettings, lowest_pairs};
use solver::cyclic::Definite;

use crate::body::ElasticBody;
use crate::error::RingError;
use crate::model::{Hold, RingModel};
use crate::sparse::SparseLoad;
use crate::statics::{RingSolver, StaticSettings};
use crate::vectors::dot;

/// Vectors per block: modes of a round ring are double, and two kinds may be close.
const BLOCK: usize = 4;
/// Residual of the pair over its own value: what the bound of its error may be. Its true error is about the square.
const TOLERANCE: f64 = 1e-2;

/// Upper over lower bound of a frequency for a log.
const WIDTH: f64 = 1.1;

/// A displacement of trial, of any size, at a position.
type TrialShape = Box<dyn Fn([f64; 3]) -> [f64; 3]>;

/// An upper bound of the first natural frequency of a ring that is clamped or in its mean motion, rad/s. Collective.
pub fn first_frequency_bound(body: &dyn ElasticBody, ring: &RingModel) -> f64 {
    let (held, matrices) = (body.held(), body.matrices());
    let quotient = |shape: TrialShape| {
        let field = held.places.field(shape);
        let mut w = vec![0.0; held.coordinates.n()];
        let free = w.iter_mut().zip(held.coordinates.free());
        free.for_each(|(w, &dof)| *w = field[dof]);
        let w = held.without_rigid_motion(&w);
        let products = [
            matrices.stiffness_product(&held.coordinates, &w),
            matrices.mass_product(&held.coordinates, &w),
        ];
        let [stiffness, mass] = products.map(|product| dot(&w, &product));
        stiffness / mass
    };
    let squares = shapes(body, ring).into_iter().map(quotient);
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// Shapes that a held ring may take.
fn shapes(body: &dyn ElasticBody, ring: &RingModel) -> Vec<TrialShape> {
    let radius = |x: [f64; 3]| x[0].hypot(x[1]);
    match ring.hold {
        Hold::Clamped => {
            let nodes = ring.mesh.group_nodes(ring.held_group);
            let sum: f64 = nodes.iter().map(|&node| radius(ring.mesh.nodes[node])).sum();
            let surface = sum / nodes.len() as f64;
            let apart = move |x: [f64; 3]| (radius(x) - surface).abs();
            let along = move |x: [f64; 3]| apart(x) / radius(x);
            vec![
                Box::new(move |x| [0.0, 0.0, apart(x)]),
                Box::new(move |x| [along(x) * x[0], along(x) * x[1], 0.0]),
                Box::new(move |x| [-along(x) * x[1], along(x) * x[0], 0.0]),
            ]
        }
        Hold::MeanMotion | Hold::Free => {
            let [sum, count] = body.held().places.sum(|_, x| [radius(x), 1.0]);
            let middle = sum / count;
            vec![Box::new(move |x| {
                let r = radius(x);
                let (sin, cos) = (2.0 * x[1].atan2(x[0])).sin_cos();
                let round = (1.5 * r / middle - 2.0) * sin;
                [
                    (x[0] * cos - x[1] * round) / r,
                    (x[1] * cos + x[0] * round) / r,
                    0.0,
                ]
            })]
        }
    }
}

/// A natural frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstFrequency {
    /// Its square, 1/s^2.
    pub square: f64,
    /// Largest possible error of the square, 1/s^2.
    pub error: f64,
}

impl FirstFrequency {
    /// The least that it can be, rad/s.
    pub fn least(&self) -> f64 {
        (self.square - self.error).max(0.0).sqrt()
    }
}

/// First natural frequency of a ring that is clamped or held in its mean motion and tied to no body. Collective.
pub fn first_frequency(
    body: &dyn ElasticBody,
    ring: &RingModel,
    settings: StaticSettings,
) -> Result<FirstFrequency, RingError> {
    let problem = HeldVibration {
        body,
        solver: RingSolver::new(ring, settings)?,
        reactions: directions(&body.held().mount.rows, body.held().coordinates.free().len()),
    };
    let settings = LanczosSettings {
        tolerance: TOLERANCE,
        ..LanczosSettings::new(1, BLOCK)
    };
    let pairs = lowest_pairs(&problem, settings, &mut |_| ()).and_then(|pairs| {
        let first = pairs.values.first().zip(pairs.bounds.first());
        first
            .map(|(&square, &error)| FirstFrequency { square, error })
            .ok_or(DenseError::EigenNotFinite)
    });
    let side = body.held().name;
    pairs.map_err(|source| RingError::FirstFrequency { side, source })
}

/// Bounds of a first natural frequency, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyBounds {
    /// It is above.
    pub least: f64,
    /// It is no more.
    pub most: f64,
}

/// Bounds of the first natural frequency of a ring that is clamped or held in its mean motion and tied to no body, if
/// it is above the first of `bounds`; the second is known, such as by [`first_frequency_bound`]. Collective.
pub fn first_frequency_above(
    (body, ring): (&dyn ElasticBody, &RingModel),
    mut bounds: FrequencyBounds,
    settings: StaticSettings,
) -> Result<Option<FrequencyBounds>, RingError> {
    let limit = bounds.least;
    let mut is_above = false;
    while !is_above || bounds.most > WIDTH * bounds.least {
        let tried = match is_above {
            // Most frequencies are far above a limit, and near their upper bound.
            false => limit.max(0.5 * bounds.most),
            true => (bounds.least * bounds.most).sqrt(),
        };
        match body.vibrates_above(tried)? {
            Definite::Yes => (bounds.least, is_above) = (tried, true),
            Definite::No if tried <= limit => return Ok(None),
            Definite::No => bounds.most = tried,
            Definite::Unknown if is_above => break,
            Definite::Unknown => return searched((body, ring), limit, settings),
        }
    }
    Ok(Some(bounds))
}

/// The same by the search for the value.
fn searched(
    (body, ring): (&dyn ElasticBody, &RingModel),
    limit: f64,
    settings: StaticSettings,
) -> Result<Option<FrequencyBounds>, RingError> {
    let found = first_frequency(body, ring, settings)?;
    let bounds = FrequencyBounds {
        least: found.least(),
        most: found.square.sqrt(),
    };
    Ok((bounds.least > limit).then_some(bounds))
}

/// A ring whose partner is at rest: unknowns are the free nodal dofs.
struct HeldVibration<'a> {
    body: &'a dyn ElasticBody,
    solver: RingSolver,
    /// Orthonormal directions of the forces that hold a mean motion.
    reactions: Vec<Vec<f64>>,
}

impl HeldVibration<'_> {
    /// What `product` makes of each column with the dofs of the partner.
    fn of_columns(&self, x: &[f64], product: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        let (n, n_shaft) = (self.n(), self.body.n() - self.n());
        let column = |x: &[f64]| {
            let mut of_column = product(&[x, &vec![0.0; n_shaft]].concat());
            of_column.truncate(n);
            of_column
        };
        x.chunks_exact(n).flat_map(column).collect()
    }
}

impl EigenProblem for HeldVibration<'_> {
    fn n(&self) -> usize {
        self.body.held().coordinates.free().len()
    }

    fn shift(&self) -> f64 {
        0.0
    }

    fn stiffness(&self, x: &[f64], _: usize) -> Vec<f64> {
        let (matrices, coordinates) = (self.body.matrices(), &self.body.held().coordinates);
        self.of_columns(x, |x| matrices.stiffness_product(coordinates, x))
    }

    fn mass(&self, x: &[f64], _: usize) -> Vec<f64> {
        let (matrices, coordinates) = (self.body.matrices(), &self.body.held().coordinates);
        self.of_columns(x, |x| matrices.mass_product(coordinates, x))
    }

    fn solve(&self, b: Vec<f64>, n_vectors: usize) -> Vec<f64> {
        let (free, n_dofs) = (self.body.held().coordinates.free(), self.solver.n_dofs());
        let mut loads = vec![0.0; n_dofs * n_vectors];
        for (load, b) in loads.chunks_exact_mut(n_dofs).zip(b.chunks_exact(free.len())) {
            free.iter().zip(b).for_each(|(&dof, &value)| load[dof] = value);
        }
        let fields = self.solver.solve(loads, n_vectors);
        let columns = fields.chunks_exact(n_dofs);
        columns
            .flat_map(|field| free.iter().map(|&dof| field[dof]))
            .collect()
    }

    fn remove_reactions(&self, force: &mut [f64]) {
        for direction in &self.reactions {
            let size = dot(force, direction);
            force.iter_mut().zip(direction).for_each(|(f, d)| *f -= size * d);
        }
    }
}

/// Orthonormal directions of rows, of which those of a partner's own dofs have none, by Gram-Schmidt.
fn directions(rows: &[SparseLoad], n: usize) -> Vec<Vec<f64>> {
    let mut directions: Vec<Vec<f64>> = Vec::new();
    for row in rows {
        let mut direction = vec![0.0; n];
        let own = row.iter().filter(|(i, _)| *i < n);
        own.for_each(|&(i, value)| direction[i] += value);
        for _ in 0..2 {
            for other in &directions {
                let size = dot(&direction, other);
                direction.iter_mut().zip(other).for_each(|(d, o)| *d -= size * o);
            }
        }
        let length = dot(&direction, &direction).sqrt();
        if length > 0.0 {
            direction.iter_mut().for_each(|d| *d /= length);
            directions.push(direction);
        }
    }
    directions
}
