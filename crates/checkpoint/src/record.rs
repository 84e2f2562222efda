//! One step as the rest of the program sees it: fields over points and cells, and the state a restart needs.

use std::collections::BTreeMap;

use crate::cells::CellFields;
use crate::error::CheckpointError;
use crate::field::{Field, kept, listed, mask, stress_field, vector, vectors};
use crate::growing::Stamps;
use crate::storage::{Coding, Precision, Storage};

/// Everything written for one step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepRecord {
    /// Number of the step; grows from file to file.
    pub step: u64,
    /// Time, s; grows from file to file.
    pub time: f64,
    /// Fields over the points of all bodies.
    pub points: PointFields,
    /// Fields over the cells of all bodies.
    pub cells: CellFields,
    /// Text of the scene the run was started with, so that a step file alone can be resumed.
    pub scene: String,
    /// Everything else that evolves, by name (letters, digits, `_`). Never shown by viewers. Empty in a step that
    /// nothing can go on from.
    pub state: BTreeMap<String, StateArray>,
    /// The tables of the run up to this step; None where the version that wrote the step kept no stamps.
    pub tables: Option<Stamps>,
}

/// Fields over points, one row per point of all bodies in their order ([`crate::point_ranges`]). A field that is
/// `None` is not written. Rows where a field has no meaning hold zeros, not NaN, so that colour ranges and
/// statistics in a viewer stay finite: stress on balls, ball forces on rings. NaN is what is not kept.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointFields {
    /// Displacement, m, `[n_points][3]`, in the precision of [`Storage::displacement`]; empty in a step without.
    pub displacement: Vec<[f64; 3]>,
    /// Velocity, m/s, `[n_points][3]`, f64.
    pub velocity: Option<Vec<[f64; 3]>>,
    /// Acceleration, m/s², `[n_points][3]`, f64.
    pub acceleration: Option<Vec<[f64; 3]>>,
    /// Stress, Pa, `[n_points][6]`, components xx yy zz xy yz xz, in the precision of [`Storage::stress`].
    pub stress: Option<Vec<[f64; 6]>>,
    /// Von Mises stress, Pa, `[n_points]`, in the precision of [`Storage::stress`].
    pub von_mises: Option<Vec<f64>>,
    /// Force of the inner ring on each ball, N, `[n_points][3]`, zero on points of rings, f64; zeros take no place.
    pub force_inner: Option<Vec<[f64; 3]>>,
    /// Force of the outer ring on each ball, N, `[n_points][3]`, zero on points of rings, f64; zeros take no place.
    pub force_outer: Option<Vec<[f64; 3]>>,
    /// 1 in the region in which fields are kept, 0 outside, `[n_points]`, f32; None keeps all. A field whose rows
    /// outside are NaN is stored without them.
    pub in_region: Option<Vec<f64>>,
}

/// An array of the state, stored and returned bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub enum StateArray {
    /// Real numbers, f64, `[n]`; NaN and signed zeros keep their bits.
    Real(Vec<f64>),
    /// Integers, `[n]`.
    Integer(Vec<i64>),
}

impl PointFields {
    /// Name, components per point, and row-major values of every field that is present.
    pub fn arrays(&self) -> Vec<(&'static str, usize, &[f64])> {
        listed(self.present(Storage::default()))
    }

    /// Fields that are present, in the order of the files.
    pub(crate) fn present(&self, storage: Storage) -> Vec<Field<'_>> {
        let region = self.in_region.as_deref();
        let stress = |name, n_components, values| stress_field(region, storage, (name, n_components, values));
        let exact = Coding::Full(Precision::F64);
        let displacement = Some(&self.displacement[..]).filter(|rows| !rows.is_empty());
        let displacement = displacement.map(|rows| {
            kept(
                region,
                vector("displacement", rows, Coding::Full(storage.displacement)),
            )
        });
        // Zeros that are not in the file need a field of as many rows that is.
        let forces = match displacement.is_some() || region.is_some() {
            true => Coding::MostlyZero,
            false => Coding::Packed(Precision::F64),
        };
        let tensors = self.stress.as_deref();
        let fields = [
            displacement,
            vectors("velocity", &self.velocity, exact),
            vectors("acceleration", &self.acceleration, exact),
            tensors.map(|rows| stress("stress", 6, rows.as_flattened())),
            self.von_mises
                .as_deref()
                .map(|values| stress("von_mises", 1, values)),
            vectors("force_inner", &self.force_inner, forces),
            vectors("force_outer", &self.force_outer, forces),
            region.map(mask),
        ];
        fields.into_iter().flatten().collect()
    }
}

impl StepRecord {
    /// Checks everything that can be checked before the first byte is written.
    pub(crate) fn validate(&self, n_points: usize, n_cells: usize) -> Result<(), CheckpointError> {
        if !self.time.is_finite() || i64::try_from(self.step).is_err() {
            return Err(CheckpointError::Time {
                step: self.step,
                time: self.time,
            });
        }
        let storage = Storage::default();
        let fields = [
            ("points", n_points, self.points.present(storage)),
            ("cells", n_cells, self.cells.present(storage)),
        ];
        for (rows, expected, fields) in fields {
            for field in fields {
                self.require_rows(&field, rows, expected)?;
            }
        }
        if let Some(stress) = &self.cells.stress_integration_points {
            require_text("the layout of stress_integration_points", &stress.layout)?;
        }
        require_text("the scene text", &self.scene)?;
        for name in self.tables.iter().flat_map(Stamps::keys) {
            if name.contains(['\n', '\0', '/']) {
                return Err(text_error("a table named", name, "expected the name of a file"));
            }
        }
        self.state
            .keys()
            .try_for_each(|name| require_name("a state array named", name))
    }

    fn require_rows(
        &self,
        field: &Field<'_>,
        rows: &'static str,
        expected: usize,
    ) -> Result<(), CheckpointError> {
        let found = field.values.len().checked_div(field.n_components).unwrap_or(0);
        if found == expected && field.values.len() == found * field.n_components {
            return Ok(());
        }
        Err(CheckpointError::FieldLength {
            field: field.name,
            step: self.step,
            rows,
            expected,
            found,
        })
    }
}

/// Fails unless HDF5 can hold these texts as attributes under their names.
pub(crate) fn require_texts(texts: &BTreeMap<String, String>) -> Result<(), CheckpointError> {
    texts.iter().try_for_each(|(name, text)| {
        require_name("a text named", name)?;
        require_text("a text about the run", text)
    })
}

fn require_text(what: &'static str, text: &str) -> Result<(), CheckpointError> {
    if text.contains('\0') {
        return Err(text_error(what, text, "expected text without NUL characters"));
    }
    Ok(())
}

fn require_name(what: &'static str, name: &str) -> Result<(), CheckpointError> {
    if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Err(text_error(what, name, "expected letters, digits and _"));
    }
    Ok(())
}

fn text_error(what: &'static str, text: &str, reason: &'static str) -> CheckpointError {
    CheckpointError::Text {
        what,
        text: text.chars().take(40).collect(),
        reason,
    }
}
