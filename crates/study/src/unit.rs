//! The unit that a plan gives a quantity names what the numbers are in: they are not converted.

use anyhow::bail;
use input::units::{AnyQuantity, KINDS, Kind, kind_of_dimension};

use crate::format::Take;
use crate::plan::Source;

/// Refuses a unit in which the column or the number of `summary.json` is not, told by the end of its name. Words that
/// are no unit, such as "of the mean force", are left as they are.
pub fn check(unit: &str, source: &Source) -> anyhow::Result<()> {
    let name = match source {
        Source::Table {
            take: Take::Ripple, ..
        } => return Ok(()),
        Source::Table { column, .. } => column.as_str(),
        Source::Summary(pointer) => match pointer.rsplit('/').find(|part| part.parse::<usize>().is_err()) {
            Some(name) => name,
            None => return Ok(()),
        },
    };
    let first = unit.split(',').next().unwrap_or_default().trim();
    let (Some(kind), Ok(one)) = (kind_of_name(name), format!("1 {first}").parse::<AnyQuantity>()) else {
        return Ok(());
    };
    let is_of_kind = kind_of_dimension(one.dimension).is_some_and(|found| found.name == kind.name);
    if !is_of_kind || one.si != 1.0 {
        bail!(
            "unit is {unit:?}, but {name} is in {}, and numbers are not converted; expected unit = \"{}\"",
            kind.si_unit,
            kind.si_unit
        );
    }
    Ok(())
}

/// The kind of quantity of a column by the end of its name, the longest that fits.
fn kind_of_name(name: &str) -> Option<&'static Kind> {
    let fitting = KINDS
        .iter()
        .filter(|kind| !kind.column_suffix.is_empty() && name.ends_with(kind.column_suffix));
    fitting.max_by_key(|kind| kind.column_suffix.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(unit: &str, name: &str) -> Option<String> {
        let source = match name.starts_with('/') {
            true => Source::Summary(name.to_string()),
            false => Source::Table {
                file: "shaft.csv".into(),
                column: name.to_string(),
                rows: Default::default(),
                take: Take::Max,
            },
        };
        check(unit, &source).err().map(|error| error.to_string())
    }

    /// Wrong: metres would be printed as micrometres, or a unit with a remark be refused.
    #[test]
    fn a_unit_that_contradicts_its_column_is_refused() {
        for (unit, name) in [
            ("m", "x_m"),
            ("m, RMS", "x_m"),
            ("N", "/balls/0/inner/force_n"),
            ("m", "/shaft/displacement_m/2"),
            ("of the mean force", "inner_force_n"),
            ("N m", "moment_n_m"),
            ("J", "strain_j"),
            ("1", "damping_ratio"),
        ] {
            assert_eq!(refusal(unit, name), None, "{unit} {name}");
        }
        assert_eq!(
            refusal("um", "x_m").unwrap(),
            "unit is \"um\", but x_m is in m, and numbers are not converted; expected unit = \"m\""
        );
        for (unit, name) in [
            ("deg", "/balls/0/inner/contact_angle_rad"),
            ("N", "x_m"),
            ("MPa", "peak_pressure_pa"),
        ] {
            assert!(refusal(unit, name).is_some(), "{unit} {name}");
        }
    }
}
