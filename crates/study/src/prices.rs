//! `raceway prices SCENE`: every effect of a scene turned off or on, what that changes, and what it costs.
//!
//! A study (see [`crate`]) over the values of `--vary` and over the variants of the scene: as it is, and one effect
//! different at a time. The table gives changes against the scene as it is: one effect at a time says nothing about two
//! together.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use anyhow::{Context, bail};
use clap::Args;
use comm::print;
use results::failure::Failure;
use scene::{MeshFiles, Scene};

use crate::markdown::write_failure;
use crate::{AxisValue, CostKind, Meshes, Plan, Source, StudyAxis, StudyQuantity, StudyReport, Take};

mod variants;

/// The name of the variant that is the scene itself.
const BASE: &str = "as it is";
/// Its axis.
const EFFECTS: &str = "effects";
/// The table for documents.
pub const PRICES_FILE: &str = "prices.md";

/// What is asked.
#[derive(Debug, Args)]
pub struct PricesRequest {
    /// Scene file.
    scene: PathBuf,
    /// Changes a value of the scene.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Tables for several values, such as 'speed.inner=1800 rpm,10000 rpm'; may be given more than once.
    #[arg(long, value_name = "PATH=VALUE,VALUE")]
    vary: Vec<String>,
    /// Folder of the results, new or that of an earlier call; default: results/ and the scene's name with -prices.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Runs at the same time; they disturb each other's timing.
    #[arg(long, default_value_t = 1)]
    jobs: usize,
}

/// Runs what is missing and writes the table.
pub fn prices(request: &PricesRequest) -> Result<(), Failure> {
    let plan = plan(request)?;
    let out = request.out.clone().unwrap_or_else(|| {
        let stem = request.scene.file_stem().unwrap_or("scene".as_ref());
        PathBuf::from("results").join(format!("{}-prices", stem.to_string_lossy()))
    });
    let report = crate::run_all(&plan, &out, request.jobs)?;
    let text = table(&report);
    print::line(format_args!("{text}"));
    crate::write_whole(&out.join(PRICES_FILE), &text)?;
    print::line(format_args!("results: {}", out.display()));
    Ok(())
}

fn plan(request: &PricesRequest) -> anyhow::Result<Plan> {
    let mut axes = request
        .vary
        .iter()
        .enumerate()
        .map(|(i, text)| varied(i, text))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let scene = Scene::load_with(&request.scene, &request.overrides, MeshFiles::MustExist)?;
    let scene_text = std::fs::read_to_string(&request.scene)
        .with_context(|| format!("cannot read {}", request.scene.display()))?;
    let base = (BASE.to_string(), Vec::new());
    let is_possible = |(name, set): &variants::Variant| {
        let set = [request.overrides.clone(), set.clone()].concat();
        match Scene::parse(&scene_text, &request.scene, &set, MeshFiles::MustExist) {
            Ok(_) => true,
            Err(error) => {
                print::note(format_args!("left out: {name}: {error}"));
                false
            }
        }
    };
    let variants = std::iter::once(base).chain(variants::of(&scene).into_iter().filter(is_possible));
    axes.push(StudyAxis {
        name: EFFECTS.to_string(),
        label: EFFECTS.to_string(),
        values: variants
            .map(|(name, set)| AxisValue {
                name,
                size: None,
                set,
            })
            .collect(),
    });
    let points = crate::grid(&request.overrides, &axes, |_| false)?;
    Ok(Plan {
        path: request.scene.clone(),
        title: format!(
            "Price list of effects: {}",
            scene.title.as_deref().unwrap_or("a scene")
        ),
        scene: request.scene.clone(),
        scene_text,
        repeats: 1,
        threads: 1,
        meshes: Meshes::Given,
        cost: CostKind::Cpu,
        axes,
        points,
        quantities: quantities(&scene),
        signals: None,
    })
}

/// An axis of `--vary PATH=VALUE,VALUE`.
fn varied(index: usize, text: &str) -> anyhow::Result<StudyAxis> {
    let Some((path, values)) = text.split_once('=') else {
        bail!("--vary {text:?} has no =; expected such as 'speed.inner=1800 rpm,10000 rpm'");
    };
    let path = path.trim();
    let values = values.split(',').map(str::trim);
    let values: Vec<AxisValue> = values
        .map(|value| AxisValue {
            name: value.to_string(),
            size: None,
            set: vec![format!("{path}={value}")],
        })
        .collect();
    if values.iter().any(|v| v.name.is_empty()) {
        bail!("--vary {text:?} has an empty value");
    }
    Ok(StudyAxis {
        name: format!("vary_{index}"),
        label: path.to_string(),
        values,
    })
}

/// A quantity from a column of a table, of some rows.
fn entry(
    name: &str,
    unit: &str,
    file: &str,
    (column, rows): (String, BTreeMap<String, crate::Cell>),
    take: Take,
) -> StudyQuantity {
    StudyQuantity {
        name: name.to_string(),
        unit: unit.to_string(),
        source: Source::Table {
            file: file.to_string(),
            column,
            rows,
            take,
        },
        scale: None,
        reference: None,
        // A variant may be without a number; the table says so.
        is_optional: true,
    }
}

/// What a table shows.
fn quantities(scene: &Scene) -> Vec<StudyQuantity> {
    let of_ball = |column: &str| (column.to_string(), BTreeMap::new());
    let first = BTreeMap::from([("ball".to_string(), crate::Cell::Number(0.0))]);
    let mut list = vec![
        entry(
            "largest inner ball force",
            "N",
            "balls.csv",
            of_ball("inner_force_n"),
            Take::Max,
        ),
        entry(
            "largest outer ball force",
            "N",
            "balls.csv",
            of_ball("outer_force_n"),
            Take::Max,
        ),
        entry(
            "inner contact angle of ball 0",
            "rad",
            "balls.csv",
            ("inner_contact_angle_rad".to_string(), first.clone()),
            Take::Mean,
        ),
        entry(
            "outer contact angle of ball 0",
            "rad",
            "balls.csv",
            ("outer_contact_angle_rad".to_string(), first),
            Take::Mean,
        ),
        entry("shaft z, mean", "m", "shaft.csv", of_ball("z_m"), Take::Mean),
        entry(
            "shaft x, RMS about its mean",
            "m",
            "shaft.csv",
            of_ball("x_m"),
            Take::Deviation,
        ),
    ];
    let nodes = scene.probes.nodes.iter().map(|probe| &probe.name);
    let points = scene.probes.points.iter().map(|probe| &probe.name);
    for probe in nodes.chain(points) {
        let name = format!("largest von Mises stress at {probe}");
        let column = format!("{probe}_von_mises_pa");
        list.push(entry(&name, "Pa", "probes.csv", of_ball(&column), Take::Max));
    }
    list
}

/// A table per combination of varied values.
fn table(report: &StudyReport) -> String {
    let mut s = String::new();
    // Writing into a string cannot fail.
    let _ = write_table(report, &mut s);
    s
}

fn write_table(report: &StudyReport, s: &mut String) -> std::fmt::Result {
    let varied = &report.axes[..report.axes.len() - 1];
    writeln!(s, "# {}\n", report.title)?;
    writeln!(
        s,
        "Made by `raceway prices` on {}, {}, 1 thread. Scene `{}`. First row of a table: the scene as it is; below: \
         changes against it with one effect different. Processor time is that of the whole run.\n",
        report.date, report.machine, report.scene
    )?;
    let mut groups: Vec<(Vec<String>, Vec<&crate::PointReport>)> = Vec::new();
    for point in &report.points {
        let key: Vec<String> = varied.iter().map(|a| point.values[&a.name].clone()).collect();
        match groups.last_mut() {
            Some((last, points)) if *last == key => points.push(point),
            _ => groups.push((key, vec![point])),
        }
    }
    for (key, points) in groups {
        let title: Vec<String> = varied
            .iter()
            .zip(&key)
            .map(|(axis, value)| format!("{} = {value}", axis.label))
            .collect();
        if !title.is_empty() {
            writeln!(s, "## {}\n", title.join(", "))?;
        }
        let names: Vec<String> = report
            .quantities
            .iter()
            .map(|q| format!("{}, {}", q.name, q.unit))
            .collect();
        writeln!(
            s,
            "| effect | {} | processor s | ms per step, set-up included | memory MB | written MB |\n|{}",
            names.join(" | "),
            "---|".repeat(names.len() + 5)
        )?;
        let base = points[0];
        for point in points {
            writeln!(s, "| {} |", row(report, base, point).join(" | "))?;
        }
        writeln!(s)?;
    }
    for point in report.points.iter().filter(|p| p.reason.is_some()) {
        write_failure(s, &point.values[EFFECTS], point.reason.as_deref())?;
        writeln!(s)?;
    }
    Ok(())
}

fn row(report: &StudyReport, base: &crate::PointReport, point: &crate::PointReport) -> Vec<String> {
    let is_base = point.values[EFFECTS] == BASE;
    let mut cells = vec![point.values[EFFECTS].clone()];
    for q in &report.quantities {
        let value = |p: &crate::PointReport| p.results.get(&q.name).map(|r| r.value);
        cells.push(match (value(point), value(base)) {
            (Some(value), _) if is_base => format!("{value:.4e}"),
            (Some(value), Some(base)) => change(value, base),
            _ => "-".to_string(),
        });
    }
    let (Some(cost), Some(of_base)) = (&point.cost, &base.cost) else {
        cells.extend([point.status.clone(), "-".into(), "-".into(), "-".into()]);
        return cells;
    };
    let cpu = cost.cpu_s.median;
    let steps = point.steps.filter(|n| *n > 0.0);
    let per_step = steps.map_or("-".to_string(), |n| format!("{:.2}", 1e3 * cpu / n));
    let own = [
        (cpu, of_base.cpu_s.median, "s"),
        (cost.peak_memory_bytes, of_base.peak_memory_bytes, "B"),
        (cost.bytes_written, of_base.bytes_written, "B"),
    ]
    .map(|(x, base, unit)| match (is_base, unit) {
        (true, "s") => format!("{x:.2}"),
        (true, _) => format!("{:.2}", 1e-6 * x),
        _ => change(x, base),
    });
    let [cpu, memory, bytes] = own;
    cells.extend([cpu, per_step, memory, bytes]);
    cells
}

/// A change in percent, or the value itself where there was nothing before.
fn change(value: f64, base: f64) -> String {
    let ratio = 100.0 * (value - base) / base.abs();
    if value == base {
        "0".to_string()
    } else if !ratio.is_finite() || ratio.abs() >= 1e5 {
        format!("to {value:.2e}")
    } else if ratio.abs() < 0.01 {
        format!("{ratio:+.0e} %")
    } else if ratio.abs() < 10.0 {
        format!("{ratio:+.2} %")
    } else {
        format!("{ratio:+.0} %")
    }
}
