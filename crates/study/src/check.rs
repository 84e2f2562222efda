//! From the text of a study to a plan: every name, range and reference is checked before anything runs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, bail};
use results::about::tidy;

use super::format::{OneOrMany, RawAxis, RawQuantity, RawReference, RawSignals, RawStudy, Take};
use super::plan::{AxisValue, Plan, Reference, Signals, Source, StudyAxis, StudyQuantity, grid};
use super::unit;

/// Runs of a point beyond this are a slip.
const MAX_REPEATS: i64 = 100;
/// Threads of a run beyond this are a slip.
const MAX_THREADS: i64 = 1024;
/// Sizes that Richardson's extrapolation needs.
const RICHARDSON_SIZES: usize = 3;

/// A combination that is left out: axes with the values that make it up.
type Exclusion = Vec<(usize, Vec<usize>)>;

/// Reads and checks a study, and every scene of its points.
pub fn load(path: &Path) -> anyhow::Result<Plan> {
    let text =
        std::fs::read_to_string(path).with_context(|| format!("cannot read study {}", path.display()))?;
    let raw: RawStudy = scene::read_tables(&text, path)?;
    check(raw, path)
}

/// Checks a study; `path` is its file, where relative paths start.
pub fn check(raw: RawStudy, path: &Path) -> anyhow::Result<Plan> {
    let at = path.display().to_string();
    checked(raw, path).with_context(|| at)
}

fn checked(raw: RawStudy, path: &Path) -> anyhow::Result<Plan> {
    let scene = tidy(&path.parent().unwrap_or(Path::new("")).join(&raw.scene));
    let scene_text = std::fs::read_to_string(&scene).with_context(|| {
        format!(
            "scene is {:?}, but {} cannot be read; the path is relative to the study",
            raw.scene,
            scene.display()
        )
    })?;
    let repeats = whole("repeats", raw.repeats.unwrap_or(1), MAX_REPEATS)?;
    let threads = whole("threads", raw.threads.unwrap_or(1), MAX_THREADS)?;
    let axes = axes(raw.axes)?;
    let excluded = excluded(&raw.exclude, &axes)?;
    let points = grid(&raw.set, &axes, |at| {
        excluded
            .iter()
            .any(|rule| rule.iter().all(|(axis, values)| values.contains(&at[*axis])))
    })?;
    if points.is_empty() {
        bail!("exclude leaves no point");
    }
    if raw.quantities.is_empty() {
        bail!("there are no [[quantities]]; a study needs at least one number to look at");
    }
    let mut names = BTreeSet::new();
    let mut quantities = Vec::new();
    for q in raw.quantities {
        if q.name.trim().is_empty() || !names.insert(q.name.clone()) {
            bail!("the name {:?} of a quantity is empty or used twice", q.name);
        }
        let name = q.name.clone();
        quantities.push(quantity(q, &axes).with_context(|| format!("quantity {name:?}"))?);
    }
    let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
    Ok(Plan {
        path: path.to_path_buf(),
        title: raw.title.or(stem).unwrap_or_default(),
        scene,
        scene_text,
        repeats,
        threads,
        meshes: raw.meshes,
        cost: raw.cost,
        axes,
        points,
        quantities,
        signals: raw.signals.map(signals).transpose()?,
    })
}

/// Columns of a labelled set.
fn signals(raw: RawSignals) -> anyhow::Result<Signals> {
    if raw.columns.is_empty() {
        bail!("[signals] has no columns; expected names of columns of its table, such as \"g1_strain\"");
    }
    let table = raw.table.unwrap_or_else(|| "probes.csv".to_string());
    if !["probes.csv", "shaft.csv"].contains(&table.as_str()) {
        bail!(
            "[signals] has the table {table:?}; expected \"probes.csv\" or \"shaft.csv\", which have a line per step"
        );
    }
    Ok(Signals {
        table,
        columns: raw.columns,
    })
}

fn whole(key: &str, value: i64, max: i64) -> anyhow::Result<usize> {
    if !(1..=max).contains(&value) {
        bail!("{key} is {value}; expected a whole number from 1 to {max}");
    }
    Ok(value as usize)
}

fn axes(raw: Vec<RawAxis>) -> anyhow::Result<Vec<StudyAxis>> {
    if raw.is_empty() {
        bail!("there are no [[axes]]; a study varies at least one choice");
    }
    let mut names = BTreeSet::new();
    raw.into_iter()
        .map(|axis| {
            let word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            if axis.name.is_empty() || !axis.name.chars().all(word) || axis.name == "out" {
                bail!(
                    "the axis name {:?} is no word of a-z, 0-9 and _, other than \"out\"",
                    axis.name
                );
            }
            if !names.insert(axis.name.clone()) {
                bail!("two axes have the name {:?}", axis.name);
            }
            self::axis(axis)
        })
        .collect()
}

fn axis(raw: RawAxis) -> anyhow::Result<StudyAxis> {
    let name = &raw.name;
    if raw.values.is_empty() {
        bail!("axis {name:?} has no values");
    }
    let mut seen = BTreeSet::new();
    for value in &raw.values {
        if value.name.trim().is_empty() || !seen.insert(&value.name) {
            bail!(
                "axis {name:?}: the name {:?} of a value is empty or used twice",
                value.name
            );
        }
        if let Some(size) = value.size
            && !(size > 0.0 && size.is_finite())
        {
            bail!(
                "axis {name:?}, value {:?}: size is {size}; expected more than 0, such as the element size",
                value.name
            );
        }
    }
    let sized = raw.values.iter().filter(|v| v.size.is_some()).count();
    if sized != 0 && sized != raw.values.len() {
        bail!("axis {name:?}: only {sized} of its values have a size; give it to all or to none");
    }
    Ok(StudyAxis {
        label: raw.label.unwrap_or_else(|| raw.name.clone()),
        name: raw.name,
        values: raw
            .values
            .into_iter()
            .map(|v| AxisValue {
                name: v.name,
                size: v.size,
                set: v.set,
            })
            .collect(),
    })
}

/// Rules of exclusion: every axis of a rule with the values that it names.
fn excluded(rules: &[BTreeMap<String, OneOrMany>], axes: &[StudyAxis]) -> anyhow::Result<Vec<Exclusion>> {
    let rule = |rule: &BTreeMap<String, OneOrMany>| {
        if rule.is_empty() {
            bail!("an entry of exclude is empty; it would exclude everything");
        }
        rule.iter()
            .map(|(axis, names)| {
                let i = axis_index(axes, axis).context("exclude")?;
                let values = names.names().iter().map(|v| value_index(&axes[i], v));
                Ok((i, values.collect::<anyhow::Result<Vec<_>>>().context("exclude")?))
            })
            .collect()
    };
    rules.iter().map(rule).collect()
}

fn axis_index(axes: &[StudyAxis], name: &str) -> anyhow::Result<usize> {
    let names: Vec<&str> = axes.iter().map(|a| a.name.as_str()).collect();
    match names.iter().position(|n| *n == name) {
        Some(i) => Ok(i),
        None => bail!("there is no axis {name:?}; axes are {}", names.join(", ")),
    }
}

fn value_index(axis: &StudyAxis, name: &str) -> anyhow::Result<usize> {
    match axis.values.iter().position(|v| v.name == name) {
        Some(i) => Ok(i),
        None => {
            let names: Vec<String> = axis.values.iter().map(|v| format!("{:?}", v.name)).collect();
            bail!(
                "axis {:?} has no value {name:?}; values are {}",
                axis.name,
                names.join(", ")
            )
        }
    }
}

fn quantity(raw: RawQuantity, axes: &[StudyAxis]) -> anyhow::Result<StudyQuantity> {
    let source = match (raw.summary, raw.table, raw.column) {
        (Some(pointer), None, None) => {
            if !pointer.starts_with('/') {
                bail!("summary is {pointer:?}; expected a path such as \"/shaft/displacement_m/2\"");
            }
            if raw.take.is_some() || !raw.r#where.is_empty() {
                bail!("take and where belong to a table, not to summary");
            }
            Source::Summary(pointer)
        }
        (None, Some(file), Some(column)) => Source::Table {
            file,
            column,
            rows: raw.r#where,
            take: raw.take.unwrap_or(Take::Final),
        },
        _ => bail!(
            "expected either summary = \"/path/into/summary.json\", or table = \"balls.csv\" and column = \"...\""
        ),
    };
    if let Some(scale) = raw.scale
        && !(scale > 0.0 && scale.is_finite())
    {
        bail!("scale is {scale}; expected more than 0: errors are divided by it");
    }
    let reference = raw.reference.map(|r| reference(r, axes)).transpose()?;
    let is_history = matches!(
        source,
        Source::Table {
            take: Take::History,
            ..
        }
    );
    if is_history && !matches!(reference, Some(Reference::Point { .. })) {
        bail!("take = \"history\" compares with the history of a point; give reference = {{ point = ... }}");
    }
    if let (Some(Reference::Value { value: 0.0, .. }), None) = (&reference, raw.scale) {
        bail!("the reference is 0, so a relative error needs a scale");
    }
    unit::check(&raw.unit, &source)?;
    Ok(StudyQuantity {
        name: raw.name,
        unit: raw.unit,
        source,
        scale: raw.scale,
        reference,
        is_optional: raw.optional.unwrap_or(false),
    })
}

fn reference(raw: RawReference, axes: &[StudyAxis]) -> anyhow::Result<Reference> {
    let uncertainty = raw.uncertainty.unwrap_or(0.0);
    if !(uncertainty >= 0.0 && uncertainty.is_finite()) {
        bail!("the uncertainty of the reference is {uncertainty}; expected 0 or more");
    }
    let fixed = |at: &BTreeMap<String, String>| {
        at.iter()
            .map(|(axis, value)| {
                let i = axis_index(axes, axis)?;
                Ok((i, value_index(&axes[i], value)?))
            })
            .collect::<anyhow::Result<Vec<_>>>()
            .context("reference")
    };
    match (raw.value, &raw.point, &raw.richardson) {
        (Some(value), None, None) => match raw.source {
            Some(source) if value.is_finite() && raw.at.is_empty() => Ok(Reference::Value {
                value,
                source,
                uncertainty,
            }),
            _ => bail!("a reference value must be finite and say its source, such as a book and a page"),
        },
        (None, Some(point), None) if raw.at.is_empty() && !point.is_empty() => Ok(Reference::Point {
            fixed: fixed(point)?,
            uncertainty,
        }),
        (None, None, Some(name)) if raw.uncertainty.is_none() => {
            let axis = axis_index(axes, name).context("reference")?;
            if raw.at.contains_key(name) {
                bail!("the reference extrapolates axis {name:?}, so at must not fix it");
            }
            let values = &axes[axis].values;
            if values.iter().any(|v| v.size.is_none()) || values.len() < RICHARDSON_SIZES {
                bail!(
                    "Richardson extrapolation over axis {name:?} needs a size of every value and at least \
                     {RICHARDSON_SIZES} values"
                );
            }
            Ok(Reference::Richardson {
                axis,
                fixed: fixed(&raw.at)?,
            })
        }
        _ => bail!(
            "a reference is one of {{ value = 1.0, source = \"...\" }}, {{ point = {{ axis = \"value\" }} }} and \
             {{ richardson = \"axis\", at = {{ axis = \"value\" }} }}; the first two may have an uncertainty"
        ),
    }
}
