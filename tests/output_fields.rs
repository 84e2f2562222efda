//! Fields that only some step files hold, or hold in a region only: `[output.every]` and `[output.region]`.

use std::sync::OnceLock;

use checkpoint::{PointFields, StepRecord, read_any_step, read_mesh, read_step, read_table, step_file_name};

use crate::resume::{moved, resumed};
use crate::several::flexible_pair;
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

/// All three tables, with states in every fourth file only.
const ALL: [&str; 20] = [
    "--set",
    "output.every.stress=2",
    "--set",
    "output.every.displacement=3",
    "--set",
    "output.restart_every=4",
    "--set",
    "output.stress_error=10 kPa",
    "--set",
    "output.region={ raceway_distance = \"1 mm\", fields = [\"stress\", \"displacement\"] }",
    "--set",
    "output.reduction.every=3",
    "--set",
    "output.reduction.damage.stress=von_mises",
    "--set",
    "output.reduction.damage.exponent=9.0",
    "--set",
    "output.reduction.damage.reference_amplitude=600 MPa",
    "--set",
    "output.reduction.damage.reference_cycles=1e6",
];

/// Wrong: a run that is killed and resumed would leave other files than one that is not: a region, the steps that hold
/// a field, or what is counted would depend on where it went on. The kill is after step 14; the last state is that of
/// step 12.
#[test]
fn a_killed_run_with_all_of_it_ends_in_the_same_bytes() {
    let dir = small_motion();
    dir.run("whole", &ALL);
    copy(&dir, "whole", "cut");
    let cut = |name: &str| dir.path(&format!("cut/{name}"));
    for n in 15..=20 {
        std::fs::remove_file(cut(&step_file_name(n))).unwrap();
    }
    for name in ["summary.json", "run.vtkhdf", "reduction.vtkhdf"] {
        std::fs::remove_file(cut(name)).unwrap();
    }
    resumed(&dir, &["cut", "--threads", "1"]);
    let steps = (0..=20).map(step_file_name);
    for name in steps.chain(["reduction.vtkhdf".to_string(), "energy.csv".to_string()]) {
        let read = |folder: &str| std::fs::read(dir.path(folder).join(&name)).unwrap();
        assert!(read("whole") == read("cut"), "{name}");
    }
}

/// Wrong: bearings of a list would keep another region than the shaft's azimuths say, write all fields, count nothing,
/// or go on to other bytes. The rear bearing is turned about x, so that azimuths of its own frame have the other sign.
#[test]
fn a_list_in_motion_has_all_of_it_by_bearing() {
    let output = "[output]\nevery = { stress = 2, displacement = 3 }\nrestart_every = 2\n\
                  region = { raceway_distance = \"1 mm\", azimuth = [\"20 deg\", \"110 deg\"] }\n\
                  reduction = { every = 2 }\n\
                  [dynamic]\nduration = \"120 us\"\nstep = \"20 us\"\nledger_tolerance = 1e-2\n";
    let dir = flexible_pair(output);
    let run = |arguments: &[&str]| {
        let outcome = dir.raceway(arguments);
        assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
        outcome
    };
    run(&["run", "pair.toml", "--out", "whole"]);
    for (bearing, sign) in [("front", 1.0), ("rear", -1.0)] {
        let folder = format!("whole/{bearing}");
        let grid = read_mesh(&dir.path(&folder)).unwrap();
        let stressed = step(&dir, &folder, 4);
        let inside = stressed.points.in_region.unwrap();
        let von_mises = stressed.points.von_mises.unwrap();
        let (n, n_balls) = (inside.len(), 18);
        for i in 0..n - n_balls {
            let [x, y, _] = grid.points[i];
            let in_sector = (20.0 - 1e-6..110.0 + 1e-6).contains(&(sign * y).atan2(x).to_degrees());
            assert!(inside[i] == 0.0 || in_sector, "{bearing}: point {i} at {x} {y}");
            assert_eq!(von_mises[i].is_nan(), inside[i] == 0.0);
        }
        let n_inside = inside.iter().filter(|&&inside| inside == 1.0).count();
        assert!(n_inside > n_balls + n / 20, "{bearing}: {n_inside} of {n}");
        assert!(step(&dir, &folder, 3).points.stress.is_none());
        assert!(step(&dir, &folder, 4).points.displacement.is_empty());
        let counted = read_table(&dir.path(&folder).join("reduction.vtkhdf"), None).unwrap();
        let told = &counted.about["reduction"];
        assert!(told.contains("over 4 steps, 0 to 6, every 2"), "{told}");
        let largest = counted
            .fields
            .iter()
            .find(|f| f.name == "von_mises_maximum")
            .unwrap();
        let at_start = step(&dir, &folder, 0).points.von_mises.unwrap();
        let kept = at_start.iter().zip(&largest.values).filter(|(s, _)| !s.is_nan());
        assert!(kept.clone().count() == n_inside && kept.clone().all(|(start, most)| start <= most));
    }
    copy(&dir, "whole", "half");
    run(&["resume", "half", "--step", "2"]);
    for bearing in ["front", "rear"] {
        let steps = (0..=6).map(step_file_name);
        for name in steps.chain(["reduction.vtkhdf".to_string()]) {
            let read = |out: &str| std::fs::read(dir.path(&format!("{out}/{bearing}/{name}"))).unwrap();
            assert!(read("whole") == read("half"), "{bearing}/{name}");
        }
    }
}

/// Wrong: at rest a list would leave out what it is asked for without a word, or name a bearing of which nothing is
/// kept by no name.
#[test]
fn a_list_says_what_it_has_not() {
    let dir = flexible_pair("[static]");
    for (set, part) in [
        (
            "output.every.stress=2",
            "[output.every] is for a list of bearings over time, [quasi_static] or [dynamic], only",
        ),
        (
            "output.reduction.every=2",
            "[output.reduction] is for a list of bearings over time, [quasi_static] or [dynamic], only",
        ),
        (
            "output.region.z=[\"40 mm\", \"50 mm\"]",
            "bearing \"front\": [output.region] holds no node: the inner ring has nodes ",
        ),
    ] {
        let outcome = dir.raceway(&["run", "pair.toml", "--out", "bad", "--set", set]);
        assert_eq!(outcome.code, Some(2), "{set}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "{set}: {}", outcome.stderr);
        assert!(!dir.path("bad").exists());
    }
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
        let checked = dir.raceway(&["check", "scene.toml", "--set", set]);
        assert!(
            checked.code == Some(2) && checked.stderr.contains(part),
            "{}",
            checked.stderr
        );
        let outcome = dir.raceway(&["run", "scene.toml", "--out", "bad", "--set", set]);
        assert_eq!(outcome.code, Some(2), "{set}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(part), "{set}: {}", outcome.stderr);
        assert!(!dir.path("bad").exists());
    }
}
