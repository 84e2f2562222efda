//! The functionals through which interactions, carried masses and constraints act on rings and small dofs.

use ring::VibratingRing;
use ring::sparse::SparseLoad;
use ring::vectors::dot;

/// A link of an interaction: its tangent, and what growth it.
pub struct LinkTangent {
    /// Tangent over its lengths, N/m, row-major.
    pub tangent: Vec<f64>,
    /// What growth each of its lengths.
    pub lengths: Vec<LengthGrowth>,
}

/// Growth of a length with the coordinates of a ring and with the small dofs.
#[derive(Clone, Default)]
pub struct LengthGrowth {
    /// Ring and growth per coordinate; None on a rigid ring.
    pub ring: Option<(usize, SparseLoad)>,
    /// Growth per small dof.
    pub small: SparseLoad,
}

impl LengthGrowth {
    /// Adds `factor` times a growth with the coordinates of a ring; a length sees one ring.
    pub fn add_ring(&mut self, ring: usize, load: &SparseLoad, factor: f64) {
        let (of, sum) = self.ring.get_or_insert_with(|| (ring, SparseLoad::new()));
        debug_assert_eq!(*of, ring, "a length of a link sees one ring");
        sum.extend(load.iter().map(|&(k, w)| (k, factor * w)));
    }
}

/// What a column does.
#[derive(Clone, Copy)]
pub enum Role {
    /// A length, by number, of a link_tangent.
    Link(usize, usize),
    /// Carries a mass, kg.
    Mass(f64),
    /// Does not move.
    Constraint,
}

/// A functional of the unknowns and its force.
pub struct Column {
    /// What it does.
    pub role: Role,
    /// Ring and generalised load of a unit force on it.
    pub ring: Option<(usize, SparseLoad)>,
    /// The same of the small dofs.
    pub small: SparseLoad,
}

/// The columns of link_tangents, side by side those of each, then of carried masses and constraints.
pub fn columns(rings: &[Option<VibratingRing>; 2], link_tangents: &[LinkTangent]) -> Vec<Column> {
    let mut columns = Vec::new();
    for (c, link_tangent) in link_tangents.iter().enumerate() {
        columns.extend(
            link_tangent
                .lengths
                .iter()
                .enumerate()
                .map(|(row, growth)| Column {
                    role: Role::Link(c, row),
                    ring: growth.ring.clone(),
                    small: growth.small.clone(),
                }),
        );
    }
    for (i, ring) in rings.iter().enumerate() {
        let Some(ring) = ring else { continue };
        let of_ring = |role, load: &SparseLoad| Column {
            role,
            ring: Some((i, load.clone())),
            small: SparseLoad::new(),
        };
        columns.extend(
            ring.lumps
                .iter()
                .map(|(load, mass)| of_ring(Role::Mass(*mass), load)),
        );
        columns.extend(
            ring.constraints
                .iter()
                .map(|load| of_ring(Role::Constraint, load)),
        );
    }
    columns
}

/// Orthonormal directions of the constraint forces of a ring, by Gram-Schmidt.
pub fn reactions(rings: &[Option<VibratingRing>; 2], columns: &[Column], i: usize) -> Vec<Vec<f64>> {
    let mut directions: Vec<Vec<f64>> = Vec::new();
    let Some(ring) = &rings[i] else {
        return directions;
    };
    for column in columns {
        let (Role::Constraint, Some((owner, load))) = (column.role, &column.ring) else {
            continue;
        };
        if *owner != i {
            continue;
        }
        let mut direction = vec![0.0; ring.n()];
        load.iter().for_each(|&(k, value)| direction[k] = value);
        for _ in 0..2 {
            for other in &directions {
                let size = dot(&direction, other);
                direction.iter_mut().zip(other).for_each(|(d, o)| *d -= size * o);
            }
        }
        let length = dot(&direction, &direction).sqrt();
        direction.iter_mut().for_each(|d| *d /= length);
        directions.push(direction);
    }
    directions
}
