//! Probes against time or the swept value: a figure per probe and unit.

use std::collections::BTreeMap;

use figure::{Figure, Series};

use super::named::Named;
use super::quantity::{self, points};
use super::run::{Results, Steps};

/// What a column of a probe shows, by the words in its name: the words that end the name of the probe, and the figure.
const KINDS: [(&str, &str); 12] = [
    ("_principal_", "principal_stress"),
    ("_maximum_shear", "principal_stress"),
    ("_hydrostatic", "principal_stress"),
    ("_stress_", "stress"),
    ("_von_mises", "stress"),
    ("_displacement_", "displacement"),
    ("_acceleration_", "acceleration"),
    ("_force", "force"),
    ("_moment", "moment"),
    ("_pressure", "stress"),
    ("_strain", "strain"),
    ("_angle_rad", "angle"),
];

/// The figures of `probes.csv`; none for a single step.
pub fn figures(results: &Results) -> anyhow::Result<Vec<Named>> {
    let Some(table) = &results.probes else {
        return Ok(Vec::new());
    };
    let Some((x_axis, x)) = results.against(table)? else {
        return Ok(Vec::new());
    };
    // Probe and kind, then the columns in their order.
    let mut groups: BTreeMap<(String, &str), Vec<&str>> = BTreeMap::new();
    for column in table.names() {
        if let Some((probe, kind)) = kind(column) {
            groups.entry((probe.to_string(), kind)).or_default().push(column);
        }
    }
    let mut figures = Vec::new();
    for ((probe, kind), columns) in groups {
        let (_, unit) = quantity::split(columns[0]);
        let what = kind.replace('_', " ");
        let title = format!("Probe {probe}: {what}");
        let mut figure = Figure::new(title, x_axis.clone(), unit.axis(what));
        for column in columns {
            let (name, unit) = quantity::split(column);
            let label = name[probe.len()..].trim_start_matches('_').replace('_', " ");
            let values = points(&x, &unit.of(table.column(column)?));
            figure = figure.series(match results.steps {
                Steps::Times => Series::line(label, values),
                _ => Series::line_and_marks(label, values),
            });
        }
        figures.push(Named::new(format!("probe_{probe}_{kind}"), figure));
    }
    Ok(figures)
}

/// The probe of a column and what it shows; the swept key of a scene, which has dots, is no probe.
fn kind(column: &str) -> Option<(&str, &'static str)> {
    if column.contains('.') {
        return None;
    }
    KINDS.iter().find_map(|(word, kind)| {
        let at = column.rfind(word)?;
        (at > 0).then_some((&column[..at], *kind))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: columns of different probes or units would share a figure.
    #[test]
    fn columns_are_grouped_by_probe_and_kind() {
        assert_eq!(kind("p_o2_stress_rr_pa"), Some(("p_o2", "stress")));
        assert_eq!(kind("p_o2_von_mises_pa"), Some(("p_o2", "stress")));
        assert_eq!(kind("p_principal_2_pa"), Some(("p", "principal_stress")));
        assert_eq!(kind("p_maximum_shear_pa"), Some(("p", "principal_stress")));
        assert_eq!(kind("p_hydrostatic_pa"), Some(("p", "principal_stress")));
        assert_eq!(kind("p_o2_displacement_r_m"), Some(("p_o2", "displacement")));
        assert_eq!(kind("ball_1_force_n"), Some(("ball_1", "force")));
        assert_eq!(kind("ball_1_moment_x_n_m"), Some(("ball_1", "moment")));
        assert_eq!(kind("g1_strain"), Some(("g1", "strain")));
        assert_eq!(kind("time_s"), None);
        assert_eq!(kind("effects.axial_force.value_n"), None);
    }
}
