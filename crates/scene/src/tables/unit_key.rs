//! A key that names the unit of numbers in a file.

use input::{KINDS, Problems, parse_unit};

/// The SI value of a unit that a scene must state.
pub fn unit_of(
    key: &str,
    typed: Option<&str>,
    (kind, example): (usize, &str),
    problems: &mut Problems,
) -> Option<f64> {
    let Some(typed) = typed else {
        problems.add(format!("{key} is missing; expected a unit such as {example:?}"));
        return None;
    };
    let unit = parse_unit(typed, &KINDS[kind]);
    unit.map_err(|error| problems.add(format!("{key}: {error}"))).ok()
}
