//! Studies through the whole program: orders, fronts, advice, what is kept of failed and interrupted points, and what
//! is refused.

use std::sync::OnceLock;
use std::time::Duration;

use serde_json::Value;

use crate::remarks::SECTION;
use crate::util::tables::{Table, number};
use crate::util::{Dir, Files, assert_within, with_line};

pub const STUDY: &str = include_str!("fixtures/study.toml");
const DYNAMIC: &str = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"4 us\"\noutput_every = 1000";

/// A folder with the scene and the study.
pub fn inputs() -> Dir {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", DYNAMIC));
    dir.write("study.toml", STUDY);
    dir
}

fn study(dir: &Dir, arguments: &[&str]) -> crate::util::Outcome {
    dir.raceway(&[&["study", "study.toml", "--out", "out"], arguments].concat())
}

/// A folder where the study was run; once for all tests that look at it.
pub fn studied() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = inputs();
        let outcome = study(&dir, &[]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        dir.snapshot()
    }))
}

pub fn table(dir: &Dir) -> Value {
    serde_json::from_str(&dir.text("out/study.json")).unwrap()
}

/// RMS of the difference of two histories of the shaft along x over the RMS of the second, at the times of the first.
fn distance(a: &Table, b: &Table, stride: usize) -> f64 {
    let (a, b) = (a.column("x_m"), b.column("x_m"));
    let fine: Vec<f64> = b.iter().step_by(stride).copied().collect();
    assert_eq!(a.len(), fine.len());
    let rms = |x: &mut dyn Iterator<Item = f64>, n: usize| (x.map(|v| v * v).sum::<f64>() / n as f64).sqrt();
    rms(&mut a.iter().zip(&fine).map(|(a, b)| a - b), a.len()) / rms(&mut b.iter().copied(), b.len())
}

/// Wrong: a study would report orders that its schemes do not have, or errors that its own results do not show.
#[test]
fn a_study_measures_the_orders_of_its_schemes() {
    let dir = studied();
    let json = table(&dir);
    let order = |scheme: &str, quantity: &str| {
        let all = json["orders"].as_array().unwrap();
        let found = all
            .iter()
            .find(|o| o["at"]["scheme"] == scheme && o["quantity"] == quantity && o["axis"] == "step");
        number(
            found.unwrap_or_else(|| panic!("{scheme}, {quantity}: {all:?}")),
            "/order",
        )
    };
    // Average acceleration is of second order, Newmark with gamma above 1/2 of first.
    assert_within("average acceleration", order("average", "history"), 2.0, 0.15);
    assert_within("Newmark", order("newmark", "history"), 1.0, 0.1);
    let fine = Table::read(&dir, "out/points/0003/run/shaft.csv");
    for (point, stride) in [(0, 16), (1, 8), (4, 16)] {
        let own = Table::read(&dir, &format!("out/points/{point:04}/run/shaft.csv"));
        let error = number(&json, &format!("/points/{point}/results/history/error"));
        assert_within("error of a history", error, distance(&own, &fine, stride), 1e-12);
    }
    let value = number(&json, "/points/3/results/final/value");
    let extrapolated = number(&json, "/points/3/results/final/reference");
    let uncertainty = number(&json, "/points/3/results/final/uncertainty") * extrapolated.abs();
    assert!(
        uncertainty < (value - extrapolated).abs() * 2.0 && uncertainty > 0.0,
        "{value} {extrapolated} {uncertainty}"
    );
}

/// Wrong: a setting would be recommended although another is both cheaper and better.
#[test]
fn the_front_holds_what_no_other_point_beats() {
    let dir = studied();
    let json = table(&dir);
    let points = json["points"].as_array().unwrap();
    let on_front = |q: &str| -> Vec<u64> {
        let on = points.iter().filter(|p| p["results"][q]["pareto"] == true);
        on.map(|p| p["index"].as_u64().unwrap()).collect()
    };
    // At every step average acceleration is better than Newmark; it writes the fewer bytes the larger its step is.
    assert_eq!(on_front("history"), [0, 1, 2]);
    for point in points {
        assert_eq!(point["status"], "finished", "{point}");
        for key in [
            "/wall_s/median",
            "/cpu_s/median",
            "/peak_memory_bytes",
            "/bytes_written",
        ] {
            assert!(number(&point["cost"], key) > 0.0, "{key} {point}");
        }
    }
    let csv = dir.text("out/study.csv");
    assert_eq!(csv.lines().count(), 8, "{csv}");
    assert!(csv.starts_with("point,scheme,step,status,wall_s,"), "{csv}");
}

/// Wrong: the settings that are recommended would not reach the error in a run of their own.
#[test]
fn advice_holds_on_a_fresh_run() {
    let dir = studied();
    let outcome = dir.raceway(&[
        "advise",
        "out/study.json",
        "--error",
        "0.1%",
        "--quantity",
        "history",
    ]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let command = outcome
        .stdout
        .lines()
        .find_map(|l| l.trim().strip_prefix("raceway run scene.toml "));
    let command = command.unwrap_or_else(|| panic!("no command in {}", outcome.stdout));
    let set: Vec<&str> = command.split('\'').skip(1).step_by(2).collect();
    let arguments: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
    dir.run("fresh", &arguments);
    let fresh = Table::read(&dir, "fresh/shaft.csv");
    let fine = Table::read(&dir, "out/points/0003/run/shaft.csv");
    let stride = (fine.rows.len() - 1) / (fresh.rows.len() - 1);
    let error = distance(&fresh, &fine, stride);
    assert!(error <= 1e-3, "{error}");
    // Cheaper ones do not reach it: the next larger step has a larger error than asked for.
    let coarser = table(&dir);
    let beyond = number(&coarser, "/points/0/results/history/error");
    assert!(
        stride == 8 && beyond > 1e-3 || stride == 16 && beyond <= 1e-3,
        "{stride} {beyond}"
    );
}

/// Wrong: the command that is recommended would name a scene that is not there, seen from another folder.
#[test]
fn advice_runs_from_where_it_is_asked_for() {
    let dir = studied();
    std::fs::create_dir(dir.path("elsewhere")).unwrap();
    let (out, scene) = (dir.path("out"), dir.path("scene.toml"));
    for (folder, study, scene) in [
        ("elsewhere", "../out", "../scene.toml"),
        ("/", out.to_str().unwrap(), scene.to_str().unwrap()),
    ] {
        let arguments = ["advise", study, "--error", "1%", "--quantity", "history"];
        let said = dir.raceway_after(&format!("cd {folder}"), &arguments).stdout;
        assert!(said.contains(&format!("    raceway run {scene} --set")), "{said}");
    }
}

/// Wrong: a user would take a study for an answer that it does not have.
#[test]
fn an_error_that_no_point_reaches_is_said() {
    let dir = studied();
    let outcome = dir.raceway(&["advise", "out", "--error", "1e-9"]);
    assert_eq!(outcome.code, Some(3), "{}", outcome.stdout);
    assert!(
        outcome
            .stderr
            .contains("no finished point of out/study.json has an error and uncertainty within"),
        "{}",
        outcome.stderr
    );
    let outcome = dir.raceway(&["advise", "out", "--error", "1%", "--quantity", "colour"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome
            .stderr
            .contains("has no quantity \"colour\" with a reference; there are history, final"),
        "{}",
        outcome.stderr
    );
    dir.write("other.json", "{}");
    let outcome = dir.raceway(&["advise", "other.json", "--error", "1%"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome.stderr.contains("other.json is no table of a study"),
        "{}",
        outcome.stderr
    );
}

/// Wrong: a study that was interrupted would begin again, or would mix runs of different settings.
#[test]
fn a_study_goes_on_where_it_was_and_refuses_other_settings() {
    let dir = inputs();
    dir.write(
        "study.toml",
        STUDY.replace("cost = \"bytes\"", "cost = \"bytes\"\nrepeats = 2"),
    );
    let one = study(&dir, &["--point", "1"]);
    assert_eq!(one.code, Some(0), "{}", one.stderr);
    assert!(!dir.path("out/study.json").exists());
    // A point that was cut off has no record.
    std::fs::create_dir_all(dir.path("out/points/0000/run")).unwrap();
    dir.write("out/points/0000/run/summary.json", "{");
    let all = study(&dir, &["--jobs", "2"]);
    assert_eq!(all.code, Some(0), "{}", all.stderr);
    assert!(
        all.stderr.contains("point 0: scheme = average, step = 4"),
        "{}",
        all.stderr
    );
    assert!(!all.stderr.contains("point 1:"), "run twice: {}", all.stderr);
    let before = dir.text("out/points/0002/point.json");
    let again = study(&dir, &[]);
    assert_eq!((again.code, again.stderr.as_str()), (Some(0), ""));
    assert_eq!(dir.text("out/points/0002/point.json"), before);
    let record: Value = serde_json::from_str(&before).unwrap();
    assert_eq!(record["costs"].as_array().unwrap().len(), 2);
    dir.write(
        "study.toml",
        STUDY
            .replace("gamma = 0.6", "gamma = 0.7")
            .replace("0.3025", "0.36"),
    );
    let changed = study(&dir, &[]);
    assert_eq!(changed.code, Some(2));
    assert!(
        changed
            .stderr
            .contains("points/0004 was run with other settings than study.toml asks for now"),
        "{}",
        changed.stderr
    );
}

/// Wrong: one point that cannot be solved would end the study, or would vanish from its table.
#[test]
fn a_failed_point_is_recorded_with_its_reason() {
    let dir = inputs();
    let tight = "{ name = \"1\", size = 1, set = ['dynamic.step = \"1 us\"', 'effects.axial_force.value = \"0 N\"'] }";
    let text = STUDY.replace(
        "{ name = \"1\", size = 1, set = ['dynamic.step = \"1 us\"'] }",
        tight,
    );
    assert_ne!(text, STUDY);
    dir.write("study.toml", text);
    let outcome = study(&dir, &[]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let json = table(&dir);
    assert_eq!(json["points"][2]["status"], "failed");
    let reason = json["points"][2]["reason"].as_str().unwrap();
    assert!(
        reason.contains("x of the shaft is free but nothing resists it"),
        "{reason}"
    );
    assert!(json["points"][2]["results"].as_object().unwrap().is_empty());
    assert!(dir.text("out/study.csv").contains("2,average,1,failed,"));
    let outcome = study(&dir, &["--retry-failed"]);
    assert!(
        outcome.stderr.contains("point 2: scheme = average, step = 1"),
        "{}",
        outcome.stderr
    );
    assert!(!outcome.stderr.contains("point 3:"), "{}", outcome.stderr);
}

/// Wrong: a slip in a study would be found after hours of runs, or a message would not say where it is.
#[test]
fn bad_studies_are_refused_before_anything_runs() {
    let cases = [
        (
            "cost = \"bytes\"",
            "cost = \"money\"",
            "cost is \"money\"; valid values are \"wall\", \"cpu\"",
        ),
        (
            "cost = \"bytes\"",
            "repeats = 0",
            "repeats is 0; expected a whole number from 1 to 100",
        ),
        (
            "[[axes]]\nname = \"scheme\"",
            "[[axes]]\nname = \"Scheme!\"",
            "the axis name \"Scheme!\" is no word",
        ),
        (
            "name = \"scheme\"",
            "name = \"step\"",
            "two axes have the name \"step\"",
        ),
        ("size = 2,", "", "axis \"step\": only 3 of its values have a size"),
        (
            "size = 2,",
            "size = -2,",
            "axis \"step\", value \"2\": size is -2; expected more than 0",
        ),
        (
            "step = \"0.25\" }]",
            "step = \"3\" }]",
            "axis \"step\" has no value \"3\"; values are \"4\", \"2\"",
        ),
        (
            "scheme = \"newmark\", step",
            "skeme = \"newmark\", step",
            "there is no axis \"skeme\"; axes are scheme, step",
        ),
        (
            "column = \"x_m\"",
            "",
            "expected either summary = \"/path/into/summary.json\", or table",
        ),
        (
            "summary = \"/",
            "summary = \"",
            "summary is \"shaft/displacement_m/0\"; expected a path such as",
        ),
        (
            "{ richardson = \"step\", at = { scheme = \"average\" } }",
            "{ richardson = \"scheme\" }",
            "needs a size of every value",
        ),
        (
            "reference = { richardson = \"step\", at = { scheme = \"average\" } }",
            "reference = { value = 1.0 }",
            "a reference value must be finite and say its source",
        ),
        (
            "name = \"final\"",
            "name = \"history\"",
            "the name \"history\" of a quantity is empty or used twice",
        ),
        (
            "scene = \"scene.toml\"",
            "scene = \"none.toml\"",
            "scene is \"none.toml\", but none.toml cannot be read",
        ),
        (
            "shaft.mass",
            "shaft.masse",
            "is no valid scene; correct its values or name the combination in exclude",
        ),
        (
            "take = \"history\"",
            "take = \"middle\"",
            "take is \"middle\"; valid values are",
        ),
    ];
    for (from, to, message) in cases {
        let dir = inputs();
        let text = STUDY.replacen(from, to, 1);
        assert_ne!(text, STUDY, "{from}");
        dir.write("study.toml", text);
        let outcome = study(&dir, &[]);
        assert_eq!(outcome.code, Some(2), "{to}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(message), "{to}: {}", outcome.stderr);
        assert!(!dir.path("out").exists(), "{to}: something was run");
    }
    let dir = inputs();
    let outcome = study(&dir, &["--point", "7"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome
            .stderr
            .contains("study.toml has no point 7; its points are 0 to 6"),
        "{}",
        outcome.stderr
    );
}

/// Wrong: a number that a run does not have would be left out without a word.
#[test]
fn a_quantity_that_is_not_there_is_said() {
    let dir = studied();
    dir.write("study.toml", STUDY.replace("column = \"x_m\"", "column = \"x\""));
    let outcome = study(&dir, &[]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome
            .stdout
            .contains("history: shaft.csv has no column \"x\"; columns are step, time_s, x_m"),
        "{}",
        outcome.stdout
    );
}

/// Wrong: a study that was killed would leave its run behind, which goes on writing into the folder that the
/// same command then cannot empty.
#[test]
fn a_killed_study_takes_its_run_with_it() {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", DYNAMIC));
    let study = STUDY.replace("set = [\n", "set = [\n    'dynamic.duration = \"0.5 s\"',\n");
    assert!(study != STUDY);
    dir.write("study.toml", &study);
    let table = dir.path("out/points/0000/run/balls.csv");
    for _ in 0..2 {
        let mut child = dir.start(&["study", "study.toml", "--out", "out"]);
        while !table.exists() {
            if child.try_wait().unwrap().is_some() {
                let said = std::io::read_to_string(child.stderr.take().unwrap()).unwrap();
                panic!("the study ended: {said}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        // At once: the run is gone, or the next study waits until it is.
        std::fs::remove_file(&table).unwrap();
    }
    std::thread::sleep(Duration::from_millis(500));
    let size = |name: &str| {
        std::fs::metadata(dir.path(&format!("out/points/0000/run/{name}")))
            .unwrap()
            .len()
    };
    let before = size("shaft.csv");
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(size("shaft.csv"), before, "a run still writes");
}

/// Wrong: a study would leave out a point because the run of a study that was killed takes a while to end.
#[test]
fn a_study_waits_for_the_run_of_one_that_was_killed() {
    let dir = inputs();
    let folder = dir.path("out/points/0000");
    std::fs::create_dir_all(&folder).unwrap();
    let file = |name: &str| std::fs::File::create(folder.join(name)).unwrap();
    let ending = file(".run.lock");
    ending.lock().unwrap();
    std::thread::scope(|scope| {
        let one = scope.spawn(|| study(&dir, &["--point", "0"]));
        std::thread::sleep(Duration::from_secs(2));
        assert!(!one.is_finished(), "the study did not wait");
        drop(ending);
        assert_eq!(one.join().unwrap().code, Some(0));
    });
    assert!(folder.join("point.json").exists());
    std::fs::remove_file(folder.join("point.json")).unwrap();
    let other = file(".lock");
    other.lock().unwrap();
    let outcome = study(&dir, &["--point", "0"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let said = "point 0 is being run by another process";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    assert!(!folder.join("point.json").exists());
}

/// Wrong: Gmsh would go on after the command that started it was killed, and write beside that of the next try.
#[test]
fn a_killed_command_takes_gmsh_with_it() {
    let dir = inputs();
    dir.write("scene.toml", with_line("[outer]", "[outer]", SECTION));
    dir.write("study.toml", BUILDING);
    let path = dir.program("gmsh", "echo $$ > pid.new\nmv pid.new pid\nexec sleep 60");
    for command in [
        &["mesh", "scene.toml"][..],
        &["study", "study.toml", "--out", "out"],
    ] {
        let mut child = dir
            .shell(&format!("export PATH='{path}'"), command)
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        while !dir.path("pid").exists() {
            assert!(child.try_wait().unwrap().is_none(), "{command:?} ended");
            std::thread::sleep(Duration::from_millis(20));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let gmsh = dir.text("pid");
        // The system shows no words of a process that has ended.
        let words = std::path::Path::new("/proc").join(gmsh.trim()).join("cmdline");
        let runs = || std::fs::read_to_string(&words).is_ok_and(|words| words.starts_with("sleep"));
        for _ in 0..100 {
            if runs() {
                std::thread::sleep(Duration::from_millis(20));
            }
        }
        assert!(!runs(), "{command:?}");
        std::fs::remove_file(dir.path("pid")).unwrap();
    }
}

/// A study of one point that builds its meshes.
const BUILDING: &str = r#"
scene = "scene.toml"
meshes = "build"

[[axes]]
name = "step"
values = [{ name = "a" }]

[[quantities]]
name = "final"
unit = "m"
summary = "/shaft/displacement_m/0"
"#;
