//! A field over points or cells as it is stored.

use crate::storage::{Coding, Precision, Storage};

/// Name of the field that tells the region in which fields are kept.
pub(crate) const IN_REGION: &str = "in_region";
/// Components of a vector.
pub(crate) const VECTOR: usize = 3;

/// One field as it is stored.
pub(crate) struct Field<'a> {
    pub name: &'static str,
    pub n_components: usize,
    /// Row-major values, `[n_rows][n_components]`, flat; a row is a point or a cell.
    pub values: &'a [f64],
    pub coding: Coding,
}

/// Name, components per row, and row-major values of fields.
pub(crate) fn listed(fields: Vec<Field<'_>>) -> Vec<(&'static str, usize, &[f64])> {
    fields
        .into_iter()
        .map(|field| (field.name, field.n_components, field.values))
        .collect()
}

/// A field of stress of this name, with so many components.
pub(crate) fn stress_field<'a>(
    region: Option<&[f64]>,
    storage: Storage,
    (name, n_components, values): (&'static str, usize, &'a [f64]),
) -> Field<'a> {
    let coding = storage.stress_coding();
    let field = Field {
        name,
        n_components,
        values,
        coding,
    };
    kept(region, field)
}

/// A field with the coding of its region, if its rows outside are not known.
pub(crate) fn kept<'a>(region: Option<&[f64]>, field: Field<'a>) -> Field<'a> {
    let outside = region.and_then(|inside| inside.iter().position(|&inside| inside == 0.0));
    let row = |row: usize| {
        field
            .values
            .get(row * field.n_components..(row + 1) * field.n_components)
    };
    let is_left = |row: &[f64]| !row.is_empty() && row.iter().all(|value| value.is_nan());
    match outside.and_then(row).is_some_and(is_left) {
        true => Field {
            coding: field.coding.in_region(),
            ..field
        },
        false => field,
    }
}

/// The region itself.
pub(crate) fn mask(inside: &[f64]) -> Field<'_> {
    Field {
        name: IN_REGION,
        n_components: 1,
        values: inside,
        coding: Coding::Packed(Precision::F32),
    }
}

/// Vectors of a row each, where there are any.
pub(crate) fn vectors<'a>(
    name: &'static str,
    rows: &'a Option<Vec<[f64; VECTOR]>>,
    coding: Coding,
) -> Option<Field<'a>> {
    rows.as_deref().map(|rows| vector(name, rows, coding))
}

/// Vectors of a row each.
pub(crate) fn vector<'a>(name: &'static str, rows: &'a [[f64; 3]], coding: Coding) -> Field<'a> {
    Field {
        name,
        n_components: VECTOR,
        values: rows.as_flattened(),
        coding,
    }
}
