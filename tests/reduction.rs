//! `[output.reduction]`: extremes, means and damage of a run, found while it goes on.

use std::sync::OnceLock;

use checkpoint::{PointTable, TableField, committed_steps, read_step, read_table, step_file_name};

use crate::resume::{refused, resumed};
use crate::util::lockstep::{copy, small_motion};
use crate::util::{Dir, Files};

const FILE: &str = "reduction.vtkhdf";

/// Reduction with damage.
pub const REDUCTION: [&str; 8] = [
    "--set",
    "output.reduction.damage.stress=signed_von_mises",
    "--set",
    "output.reduction.damage.exponent=5.0",
    "--set",
    "output.reduction.damage.reference_amplitude=50 MPa",
    "--set",
    "output.reduction.damage.reference_cycles=1e6",
];
/// What makes step files exact: stress in full, in the rings' own frames.
const EXACT: [&str; 6] = [
    "--set",
    "output.precision=f64",
    "--set",
    "output.inner_ring=own_frame",
    "--set",
    "output.outer_ring=own_frame",
];

/// The small motion with both as `whole`; once for all tests.
fn reduced() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        dir.run("whole", &[&REDUCTION[..], &EXACT[..]].concat());
        dir.snapshot()
    }))
}

fn table(dir: &Dir, folder: &str) -> PointTable {
    read_table(&dir.path(folder).join(FILE), None).unwrap()
}

fn field<'a>(table: &'a PointTable, name: &str) -> &'a TableField {
    table.fields.iter().find(|field| field.name == name).unwrap()
}

fn bits(table: &PointTable) -> Vec<(&str, Vec<u64>)> {
    let bits = |field: &TableField| field.values.iter().map(|v| v.to_bits()).collect();
    table
        .fields
        .iter()
        .map(|field| (field.name.as_str(), bits(field)))
        .collect()
}

/// Wrong: the fields would not be the extremes and means of what step files hold.
#[test]
fn extremes_and_means_are_those_of_the_step_files() {
    let dir = reduced();
    let found = table(&dir, "whole");
    let steps = committed_steps(&dir.path("whole")).unwrap();
    assert_eq!(steps.len(), 21);
    let all: Vec<_> = steps
        .iter()
        .map(|&n| {
            read_step(&dir.path("whole").join(step_file_name(n)))
                .unwrap()
                .points
        })
        .collect();
    let stress: Vec<&[f64]> = all
        .iter()
        .map(|p| p.stress.as_ref().unwrap().as_flattened())
        .collect();
    let von_mises: Vec<&[f64]> = all.iter().map(|p| &p.von_mises.as_ref().unwrap()[..]).collect();
    for (name, histories) in [("stress", stress), ("von_mises", von_mises)] {
        for i in 0..histories[0].len() {
            let values = || histories.iter().map(|values| values[i]);
            let (least, most) = (
                values().fold(f64::INFINITY, f64::min),
                values().fold(f64::NEG_INFINITY, f64::max),
            );
            let at = |kind: &str| field(&found, &format!("{name}_{kind}")).values[i];
            assert_eq!(
                [at("minimum"), at("maximum"), at("range")],
                [least, most, most - least],
                "{name} {i}"
            );
            assert_eq!(at("mean"), values().sum::<f64>() / 21.0, "{name} {i}");
        }
    }
    let costs = dir.text("whole/summary.json");
    assert!(costs.contains("\"reduction\": "), "the price is told: {costs}");
    let damage = &field(&found, "damage").values;
    let n = damage.iter().filter(|d| !d.is_nan()).count();
    assert!(n > 100 && n < damage.len() / 2, "{n} nodes of the raceways");
    assert!(damage.iter().any(|&d| d > 0.0));
    let told = dir.raceway(&["info", "whole"]);
    let expected = "reduction  reduction.vtkhdf: stress at nodes, Pa, in each ring's own frame";
    assert!(told.stdout.contains(expected), "{}", told.stdout);
    let told = dir.raceway(&["info", "whole/reduction.vtkhdf"]);
    assert_eq!(told.code, Some(0), "{}", told.stderr);
    assert!(
        told.stdout.contains("/VTKHDF/PointData/von_mises_maximum"),
        "{}",
        told.stdout
    );
    assert!(
        found.about["reduction"].contains("over 21 steps, 0 to 20, every 1"),
        "{:?}",
        found.about
    );
}

/// Wrong: a resumed run would count other cycles, sums or extremes than one that was not interrupted, or threads would
/// change bits.
#[test]
fn a_resumed_run_counts_to_the_same_bits() {
    let dir = reduced();
    let whole = table(&dir, "whole");
    for (step, threads) in [("3", "1"), ("11", "3")] {
        let cut = format!("cut{step}");
        copy(&dir, "whole", &cut);
        std::fs::remove_file(dir.path(&cut).join("summary.json")).unwrap();
        resumed(&dir, &[&cut, "--step", step, "--threads", threads]);
        assert!(bits(&table(&dir, &cut)) == bits(&whole), "cut after step {step}");
    }
}

/// Wrong: without step files, or with states in some of them only, the same would not be found.
#[test]
fn it_needs_no_step_files() {
    let dir = reduced();
    let few = [
        "--set",
        "dynamic.output_every=7",
        "--set",
        "output.stress=none",
        "--threads",
        "1",
    ];
    dir.run("few", &[&REDUCTION[..], &EXACT[..], &few[..]].concat());
    assert!(bits(&table(&dir, "few")) == bits(&table(&dir, "whole")));
    resumed_from_last_state(&dir);
}

/// Wrong: a step at the time `from` would not count where its time, in binary numbers, falls short of the one that is
/// typed. Steps 3 and 6 of 20 us do: 3 x 2e-5 is less than 0.06 x 1e-3.
#[test]
fn a_step_at_the_first_time_counts() {
    let dir = small_motion();
    for step in [3_u64, 6, 7] {
        let from = format!("output.reduction.from={:.2} ms", 0.02 * step as f64);
        let out = format!("from{step}");
        dir.run(&out, &["--set", &from, "--set", "dynamic.duration=0.2 ms"]);
        let told = &table(&dir, &out).about["reduction"];
        let expected = format!("over {} steps, {step} to 10, every 1", 11 - step);
        assert!(told.contains(&expected), "{told}");
    }
}

/// The run `few` without its last file goes on from the state of step 14.
fn resumed_from_last_state(dir: &Dir) {
    let whole = table(dir, "few");
    for name in [step_file_name(20), "summary.json".to_string(), FILE.to_string()] {
        std::fs::remove_file(dir.path("few").join(name)).unwrap();
    }
    resumed(dir, &["few"]);
    assert!(bits(&table(dir, "few")) == bits(&whole));
}

/// Wrong: counts of two kinds would be mixed, or a scene that asks for what it cannot have would run.
#[test]
fn what_cannot_be_counted_is_refused() {
    let dir = reduced();
    refused(
        &dir,
        &[
            "whole",
            "--step",
            "11",
            "--set",
            "output.reduction.damage.exponent=6.0",
        ],
        &["[output.reduction] has changed since step 11, and what it has counted cannot be counted anew"],
    );
    for (set, part) in [
        (
            "output.reduction.damage.exponent=0.5",
            "output.reduction.damage.exponent is 0.5; expected 1 to 50, the slope of the S-N line",
        ),
        (
            "output.reduction.damage.reference_cycles=0.0",
            "output.reduction.damage.reference_cycles is 0; expected at least 1 cycle",
        ),
        (
            "output.reduction.every=0",
            "output.reduction.every is 0; expected a whole number from 1",
        ),
    ] {
        let arguments = [&["check", "scene.toml"], &REDUCTION[..], &["--set", set]].concat();
        let outcome = dir.raceway(&arguments);
        assert_eq!(outcome.code, Some(2), "{set}");
        assert!(outcome.stderr.contains(part), "{set}: {}", outcome.stderr);
    }
    let lacks = dir.raceway(&[
        "check",
        "scene.toml",
        "--set",
        "output.reduction.damage.exponent=5.0",
    ]);
    assert_eq!(lacks.code, Some(2));
    assert!(
        lacks.stderr.contains("reference_amplitude") || lacks.stderr.contains("stress"),
        "{}",
        lacks.stderr
    );
}
