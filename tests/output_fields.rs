//! Fields that only some step files hold, or hold in a region only: `[output.every]` and `[output.region]`.

use std::sync::OnceLock;

use checkpoint::{PointFields, StepRecord, read_any_step, read_mesh, read_step, step_file_name};

use crate::resume::{moved, resumed};
use crate::util::lockstep::{copy, small_motion};
use crate::util::{Dir, Files};

/// Stress in every fourth file, displacement in every second.
const EVERY: [&str; 4] = [
    "--set",
    "output.every.stress=4",
    "--set",
    "output.every.displacement=2",
];

/// The small motion with these as `every`, and its stress near the raceways of a sector as `region`; once for all.
fn runs() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        dir.run("every", &EVERY);
        let region = [
            "--set",
            "output.region.raceway_distance=1 mm",
            "--set",
            "output.region.azimuth=[\"-30 deg\", \"30 deg\"]",
            "--set",
            "output.region.rings=[\"outer\"]",
        ];
        dir.run("region", &region);
        dir.snapshot()
    }))
}

fn step(dir: &Dir, folder: &str, step: u64) -> StepRecord {
    read_step(&dir.path(folder).join(step_file_name(step))).unwrap()
}

fn names(points: &PointFields) -> Vec<&'static str> {
    points.arrays().iter().map(|array| array.0).collect()
}

/// Wrong: other steps than every n-th would hold a field, the values of one would change, or the run itself.
#[test]
fn every_nth_file_holds_a_field() {
    let (dir, plain) = (runs(), moved());
    for n in 0..=20 {
        let (some, all) = (step(&dir, "every", n), step(&plain, "whole", n));
        let mut expected = all.points.clone();
        if n % 2 != 0 {
            expected.displacement.clear();
        }
        if n % 4 != 0 {
            (expected.stress, expected.von_mises) = (None, None);
        }
        assert_eq!(names(&some.points), names(&expected), "step {n}");
        assert!(some.points == expected, "step {n}");
        assert_eq!(
            format!("{:?}", some.state),
            format!("{:?}", all.state),
            "step {n}"
        );
    }
    let energy = "energy.csv";
    assert_eq!(
        dir.text(&format!("every/{energy}")),
        plain.text(&format!("whole/{energy}"))
    );
}

/// Wrong: a run could not go on from a step that lacks fields, packs would lose some, or commands would end in a panic
/// instead of saying which steps hold what.
#[test]
fn commands_go_on_with_steps_that_lack_fields() {
    let dir = runs();
    copy(&dir, "every", "cut");
    resumed(&dir, &["cut", "--step", "7"]);
    for n in 0..=20 {
        assert!(
            step(&dir, "cut", n).points == step(&dir, "every", n).points,
            "step {n}"
        );
    }
    assert_eq!(dir.raceway(&["pack", "cut", "--keep", "1"]).code, Some(0));
    for n in 0..=20 {
        let packed = read_any_step(&dir.path("cut"), n).unwrap();
        assert!(packed.points == step(&dir, "every", n).points, "step {n}");
    }
    let run = |arguments: &[&str]| {
        let outcome = dir.raceway(arguments);
        assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
        outcome
    };
    run(&["pack", "cut", "--undo"]);
    for (n, lacks) in [
        ("5", "stress and displacement"),
        ("7", "stress and displacement"),
        ("6", "stress"),
    ] {
        let outcome = run(&["plot", "every", "--step", n]);
        let other = if n == "7" { 8 } else { 4 };
        let text = format!(
            "step {n} has no {lacks} (output.every), and no figures of stress; the nearest that has is {other}"
        );
        assert!(outcome.stderr.contains(&text), "{}", outcome.stderr);
    }
    run(&["plot", "every"]);
    run(&["report", "every"]);
    run(&["info", "every"]);
    run(&["export", "every", "--steps", "4..7", "--to", "csv"]);
    let head = |n: u64| {
        dir.text(&format!("every/export/step_{n:06}.csv"))
            .lines()
            .next()
            .unwrap()
            .to_string()
    };
    assert!(head(4).contains("von_mises_pa") && head(4).contains("displacement_x_m"));
    assert!(!head(6).contains("von_mises_pa") && head(6).contains("displacement_x_m"));
    assert!(!head(5).contains("displacement_x_m") && head(5).contains("force_inner_x_n"));
    run(&["export", "every", "--steps", "5", "--to", "vtu", "--out", "vtu"]);
}

/// Wrong: values in the region would change, places outside would hold anything but NaN, or the file would not shrink
/// with the region.
#[test]
fn a_region_holds_the_stress_of_the_whole() {
    let (dir, plain) = (runs(), moved());
    let grid = read_mesh(&dir.path("region")).unwrap();
    let n_outer = grid
        .offsets
        .windows(2)
        .zip(&grid.body)
        .filter(|(_, body)| **body == 1);
    let mut outer = vec![false; grid.points.len()];
    for (ends, _) in n_outer {
        for &point in &grid.connectivity[ends[0] as usize..ends[1] as usize] {
            outer[point as usize] = true;
        }
    }
    let n_balls = 18;
    for n in [0, 7, 20] {
        let (some, all) = (step(&dir, "region", n), step(&plain, "whole", n));
        let inside = some.points.in_region.as_ref().unwrap();
        let (some_stress, all_stress) = (some.points.von_mises.unwrap(), all.points.von_mises.unwrap());
        let tensors = some
            .points
            .stress
            .as_ref()
            .unwrap()
            .iter()
            .zip(all.points.stress.as_ref().unwrap());
        let mut n_inside = 0;
        for (i, (some, all)) in tensors.enumerate() {
            let ball = i >= grid.points.len() - n_balls;
            let [x, y, _] = grid.points[i];
            let expected = ball || outer[i] && y.atan2(x).to_degrees().abs() < 30.0 + 1e-6;
            match inside[i] == 1.0 {
                true => {
                    assert!(
                        expected && some == all && some_stress[i] == all_stress[i],
                        "point {i}"
                    );
                    n_inside += 1;
                }
                false => assert!(!ball && some.iter().all(|s| s.is_nan()) && some_stress[i].is_nan()),
            }
        }
        assert!(
            n_inside > n_balls && n_inside < inside.len() / 8,
            "{n_inside} of {}",
            inside.len()
        );
        assert!(some.points.displacement == all.points.displacement);
    }
    let size = |dir: &Dir, folder: &str| {
        std::fs::metadata(dir.path(folder).join(step_file_name(7)))
            .unwrap()
            .len()
    };
    let stress = 7 * 4 * grid.points.len() as u64;
    let (small, whole) = (size(&dir, "region"), size(&plain, "whole"));
    assert!(
        small + stress * 3 / 4 < whole,
        "{small} of {whole}, stress {stress}"
    );
}

/// Wrong: a region without a node would write nothing but NaN, silently.
#[test]
fn wrong_regions_are_refused() {
    let dir = small_motion();
    for (set, part) in [
        (
            "output.region.raceway_distance=0 mm",
            "output.region.raceway_distance is 0 mm; the distance must be positive",
        ),
        (
            "output.region.z=[\"40 mm\", \"50 mm\"]",
            "[output.region] holds no node: the inner ring has nodes ",
        ),
        (
            "output.region.azimuth=[\"10 deg\", \"370 deg\"]",
            "output.region.azimuth goes from 10 deg to 370 deg, the same azimuth; expected both ends of a sector",
        ),
        (
            "output.region.rings=[\"middle\"]",
            "valid values are \"inner\", \"outer\"",
        ),
        (
            "output.region.fields=[\"stress\"]",
            "[output.region] says no place; expected raceway_distance, azimuth, x, y, z or rings",
        ),
    ] {
        let outcome = dir.raceway(&["run", "scene.toml", "--out", "bad", "--set", set]);
        assert_eq!(outcome.code, Some(2), "{set}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "{set}: {}", outcome.stderr);
        assert!(!dir.path("bad").exists());
    }
}
