//! The functionals through which contacts, carried masses and constraints act on rings and small dofs.

use ring::VibratingRing;
use ring::sparse::SparseLoad;
use ring::vectors::dot;

/// A contact: its tangent and what moves it.
pub struct Contact {
    /// Tangent over [radial, axial], N/m.
    pub stiffness: [[f64; 2]; 2],
    /// Ring and motion [radial, axial] of its groove centre per coordinate; None on a rigid ring.
    pub ring: Option<(usize, [SparseLoad; 2])>,
    /// Ball centre minus rigid groove centre [radial, axial] per small dof.
    pub small: [SparseLoad; 2],
}

/// What a column does.
#[derive(Clone, Copy)]
pub enum Role {
    /// Direction, 0 or 1, of a contact.
    Contact(usize, usize),
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

/// The columns of contacts, two each and in pairs, then of carried masses and constraints.
pub fn columns(rings: &[Option<VibratingRing>; 2], contacts: &[Contact]) -> Vec<Column> {
    let mut columns = Vec::new();
    for (c, contact) in contacts.iter().enumerate() {
        for direction in 0..2 {
            let minus = |load: &SparseLoad| load.iter().map(|&(k, w)| (k, -w)).collect::<SparseLoad>();
            let ring = contact.ring.as_ref();
            columns.push(Column {
                role: Role::Contact(c, direction),
                ring: ring.map(|(i, motion)| (*i, minus(&motion[direction]))),
                small: contact.small[direction].clone(),
            });
        }
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
