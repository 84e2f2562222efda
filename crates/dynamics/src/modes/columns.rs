//! The functionals through which interactions, carried masses and constraints act on rings and small dofs.

use ring::VibratingRings;
use ring::sparse::{SparseLoad, sparse_dot};

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
    /// Group of rings and growth per coordinate; None on a rigid ring.
    pub ring: Option<(usize, SparseLoad)>,
    /// Growth per small dof.
    pub small: SparseLoad,
}

impl LengthGrowth {
    /// Adds `factor` times a growth with the coordinates of a group of rings; a length sees one.
    pub fn add_ring(&mut self, ring: usize, load: &SparseLoad, factor: f64) {
        let (of, sum) = self.ring.get_or_insert_with(|| (ring, SparseLoad::new()));
        debug_assert_eq!(*of, ring, "a length of a link sees one ring");
        sum.extend(load.iter().map(|&(k, w)| (k, factor * w)));
    }

    /// The functional of fields of the rings, by group: a^T r.
    pub fn in_rings<'f>(&self, field: impl Fn(usize) -> &'f [f64]) -> f64 {
        let ring = self.ring.as_ref();
        ring.map_or(0.0, |(group, load)| sparse_dot(load, field(*group)))
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
    /// Growth of the functional, which is the generalised load of a unit force too.
    pub growth: LengthGrowth,
}

/// The columns of link_tangents, side by side those of each, then of carried masses and constraints, and `joints`.
pub fn columns(
    groups: &[VibratingRings],
    link_tangents: &[LinkTangent],
    joints: Vec<LengthGrowth>,
) -> Vec<Column> {
    let column = |role, growth| Column { role, growth };
    let mut columns = Vec::new();
    for (c, link_tangent) in link_tangents.iter().enumerate() {
        let lengths = link_tangent.lengths.iter().enumerate();
        columns.extend(lengths.map(|(row, growth)| column(Role::Link(c, row), growth.clone())));
    }
    for (i, group) in groups.iter().enumerate() {
        let of_group = |role, load: &SparseLoad| {
            let ring = Some((i, load.clone()));
            let small = SparseLoad::new();
            column(role, LengthGrowth { ring, small })
        };
        for ring in group.rings() {
            let lumps = ring.lumps().iter();
            columns.extend(lumps.map(|(load, mass)| of_group(Role::Mass(*mass), load)));
            let constraints = ring.constraints().iter();
            columns.extend(constraints.map(|load| of_group(Role::Constraint, load)));
        }
    }
    columns.extend(joints.into_iter().map(|joint| column(Role::Constraint, joint)));
    columns
}
