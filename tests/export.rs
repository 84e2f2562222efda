//! `raceway info` and `raceway export`, and in which frame the inner ring is shown.

use std::sync::OnceLock;

use checkpoint::{read_mesh, read_step};

use crate::util::lockstep::small_motion;
use crate::util::tables::Table;
use crate::util::{Dir, Files, RIGID, SCENE};

/// A folder with ten steps of the small motion, every fifth written.
fn moved() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        let short = [
            "--set",
            "dynamic.duration=0.2 ms",
            "--set",
            "dynamic.output_every=5",
        ];
        dir.run("out", &short);
        dir.snapshot()
    }))
}

/// Wrong: folders of other commands, and the file that shows all steps, would be called damaged.
#[test]
fn info_knows_folders_without_a_run_and_the_index_of_steps() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    let info = |path: &str| dir.raceway(&["info", path]);
    let index = info("out/run.vtkhdf");
    assert_eq!(index.code, Some(0), "{}", index.stderr);
    assert!(
        index
            .stdout
            .contains("array      /VTKHDF/PointData/displacement float64 ["),
        "{}",
        index.stdout
    );
    let made = dir.raceway(&[&["stiffness", "scene.toml", "--out", "k"], &RIGID[..]].concat());
    assert_eq!(made.code, Some(0), "{}", made.stderr);
    let made = dir.raceway(&["export", "out", "--out", "e", "--to", "csv"]);
    assert_eq!(made.code, Some(0), "{}", made.stderr);
    std::fs::create_dir(dir.path("s")).unwrap();
    dir.write("s/study.json", "{}");
    dir.write("s/prices.md", "# Price list of effects");
    for (folder, what) in [
        ("k", "raceway stiffness"),
        ("e", "raceway export"),
        ("s", "raceway prices"),
    ] {
        let told = info(folder);
        assert_eq!(told.code, Some(0), "{}", told.stderr);
        assert!(
            told.stdout.contains("holds") && told.stdout.contains(what),
            "{}",
            told.stdout
        );
    }
    std::fs::create_dir(dir.path("empty")).unwrap();
    let told = info("empty");
    assert_eq!(told.code, Some(2));
    assert!(
        told.stderr.contains("empty holds no run: expected"),
        "{}",
        told.stderr
    );
}

/// Wrong: times that steps add up to would be said with the round-off of the sum.
#[test]
fn info_says_times_as_they_were_meant() {
    let dir = moved();
    dir.run(
        "summed",
        &[
            &RIGID[..],
            &["--set", "dynamic.duration=0.3 ms", "--set", "dynamic.step=20 us"],
        ]
        .concat(),
    );
    let told = dir.raceway(&["info", "summed"]);
    assert!(told.stdout.contains("t = 0.0 s to 0.0003 s,"), "{}", told.stdout);
}

/// Wrong: a user could not tell what a folder or a file holds, or damage would be hidden.
#[test]
fn info_says_what_is_there() {
    let dir = moved();
    let info = |arguments: &[&str]| dir.raceway(&[&["info"], arguments].concat());
    let has = |text: &str, parts: &[&str]| {
        for part in parts {
            assert!(text.contains(part), "{text} lacks {part:?}");
        }
    };
    let folder = info(&["out"]);
    assert_eq!(folder.code, Some(0), "{}", folder.stderr);
    has(
        &folder.stdout,
        &[
            "steps      3 from 0 to 10, t = 0.0 s to 0.0002 s",
            "title      7010C under test",
            "scene_file ../scene.toml",
            "overrides  dynamic.duration=0.2 ms; dynamic.output_every=5",
            "bodies",
            "status     finished",
        ],
    );
    let step = info(&["out/step_000005.hdf"]).stdout;
    let n = read_mesh(&dir.path("out")).unwrap().points.len();
    has(
        &step,
        &[
            "step       5, t = 0.0001 s",
            &format!("/VTKHDF/PointData/stress float32 [{n}, 6]"),
            "/restart/state/balls float64 [36]",
        ],
    );
    has(
        &info(&["out/mesh.hdf"]).stdout,
        &[&format!("/VTKHDF/Points float64 [{n}, 3]"), "mesh_hash"],
    );
    // A wrong byte in a value: only a look at every byte can tell.
    let path = dir.path("out/step_000005.hdf");
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(info(&["out"]).code, Some(0));
    for arguments in [&["out", "--verify"][..], &["out/step_000005.hdf"]] {
        let outcome = info(arguments);
        assert_eq!(outcome.code, Some(2), "{arguments:?}");
        has(
            &(outcome.stdout + &outcome.stderr),
            &["of out/step_000005.hdf is damaged"],
        );
    }
    has(
        &info(&["nowhere"]).stderr,
        &["nowhere is not there; expected a result folder"],
    );
}

/// Wrong: another tool would be given other numbers than those computed.
#[test]
fn tables_of_steps_hold_the_fields() {
    let dir = moved();
    let outcome = dir.raceway(&[
        "export", "out", "--to", "csv", "--steps", "5..9", "--out", "tables",
    ]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = Table::read(&dir, "tables/step_000005.csv");
    let (step, grid) = (
        read_step(&dir.path("out/step_000005.hdf")).unwrap(),
        read_mesh(&dir.path("out")).unwrap(),
    );
    assert_eq!(table.rows.len(), grid.points.len());
    let column = |name: &str| table.column(name);
    let stress = step.points.stress.unwrap();
    let points = [
        (
            column("z_m"),
            grid.points.iter().map(|p| p[2]).collect::<Vec<_>>(),
        ),
        (column("stress_xz_pa"), stress.iter().map(|s| s[5]).collect()),
        (column("von_mises_pa"), step.points.von_mises.unwrap()),
        (
            column("displacement_y_m"),
            step.points.displacement.iter().map(|u| u[1]).collect(),
        ),
        (
            column("force_outer_x_n"),
            step.points.force_outer.unwrap().iter().map(|f| f[0]).collect(),
        ),
    ];
    for (written, computed) in points {
        assert_eq!(written, computed);
    }
    let n = grid.points.len();
    assert_eq!(column("body")[n - 18..], [2.0; 18], "the balls are the last body");
    assert_eq!(column("body")[0], 0.0);
    let again = dir.raceway(&["export", "out", "--to", "csv", "--steps", "5", "--out", "tables"]);
    assert_eq!(again.code, Some(2), "an existing file was replaced");
    assert!(
        again.stderr.contains("tables already holds step_000005.csv"),
        "{}",
        again.stderr
    );
    let none = dir.raceway(&["export", "out", "--to", "csv", "--steps", "6..9"]);
    assert!(
        none.stderr
            .contains("has no step from 6 to 9; it has 3 steps from 0 to 10"),
        "{}",
        none.stderr
    );
}

/// Wrong: an array of a VTU file would not be that of the step, or its frame not what VTK reads. (`readers.rs` lets VTK
/// itself read it, where it is installed.)
#[test]
fn vtu_files_hold_the_arrays() {
    let dir = moved();
    let outcome = dir.raceway(&["export", "out", "--to", "vtu"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let text = dir.text("out/export/step_000010.vtu");
    let array = |name: &str| vtu_array(&text, name);
    let step = read_step(&dir.path("out/step_000010.hdf")).unwrap();
    assert_eq!(array("TimeValue"), [step.time]);
    assert_eq!(array("stress"), step.points.stress.unwrap().concat());
    assert_eq!(array("displacement"), step.points.displacement.concat());
    assert_eq!(
        array("Points"),
        read_mesh(&dir.path("out")).unwrap().points.concat()
    );
    let collection = dir.text("out/export/run.pvd");
    assert!(
        collection.contains("timestep=\"0.0001\" part=\"0\" file=\"step_000005.vtu\""),
        "{collection}"
    );
}

/// Numbers of an array in the text of a VTU file.
pub fn vtu_array(text: &str, name: &str) -> Vec<f64> {
    let start = text
        .find(&format!("Name=\"{name}\""))
        .unwrap_or_else(|| panic!("no array {name}"));
    let content = text[start..]
        .split_once('>')
        .unwrap()
        .1
        .split_once('<')
        .unwrap()
        .0;
    let bytes = decode(content);
    let (head, values) = bytes.split_at(8);
    assert_eq!(
        u64::from_le_bytes(head.try_into().unwrap()) as usize,
        values.len(),
        "{name}"
    );
    values
        .as_chunks::<8>()
        .0
        .iter()
        .map(|b| f64::from_le_bytes(*b))
        .collect()
}

/// Base64 by its definition (RFC 4648): six bits per letter.
fn decode(text: &str) -> Vec<u8> {
    let letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let values: Vec<u32> = text
        .trim_end_matches('=')
        .chars()
        .map(|c| letters.find(c).unwrap() as u32)
        .collect();
    values
        .chunks(4)
        .flat_map(|four| {
            let bits = (0..4).fold(0, |bits, i| bits << 6 | four.get(i).copied().unwrap_or(0));
            let bytes = [(bits >> 16) as u8, (bits >> 8) as u8, bits as u8];
            bytes[..four.len() * 6 / 8].to_vec()
        })
        .collect()
}

/// Wrong: in its own frame the inner ring would still turn, or the choice would touch the motion.
#[test]
fn a_turning_ring_is_shown_in_space_or_in_its_own_frame() {
    let dir = moved();
    let own = [
        "--set",
        "output.inner_ring=own_frame",
        "--set",
        "dynamic.duration=0.2 ms",
    ];
    dir.run("own", &own);
    let step = |folder: &str| read_step(&dir.path(&format!("{folder}/step_000010.hdf"))).unwrap();
    let (space, own) = (step("out"), step("own"));
    assert_eq!(space.state, own.state);
    let largest = |u: &[[f64; 3]]| u.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let grid = read_mesh(&dir.path("out")).unwrap();
    let cells = grid.body.iter().filter(|body| **body == 0).count();
    let n_inner = 1 + *grid.connectivity[..8 * cells].iter().max().unwrap() as usize;
    let [turned, still] = [&space, &own].map(|s| largest(&s.points.displacement[..n_inner]));
    // 12 000 rpm for 0.2 ms turn the ring by 0.2513 rad: the bore, at 25 mm, moves by 6.3 mm, the shoulders by more.
    assert!(turned > 6e-3 && still < 1e-3, "{turned} {still}");
    let i = n_inner / 2;
    let (a, b) = (
        space.points.von_mises.unwrap()[i],
        own.points.von_mises.unwrap()[i],
    );
    assert!(
        (a - b).abs() <= 1e-5 * a.abs(),
        "{a} {b}: turning does not change von Mises"
    );
    assert_eq!(
        space.points.displacement[n_inner..],
        own.points.displacement[n_inner..]
    );
}

/// Wrong: an outer ring that turns would be shown standing, or could not be shown standing.
#[test]
fn a_turning_outer_ring_is_shown_like_an_inner_one() {
    let dir = moved();
    let set = [
        "dynamic.duration=0.2 ms",
        "speed.inner=0 rpm",
        "speed.outer=12000 rpm",
    ];
    let set = set.map(|value| ["--set", value]).concat();
    dir.run("space", &set);
    dir.run(
        "own",
        &[&set[..], &["--set", "output.outer_ring=own_frame"]].concat(),
    );
    let [turned, still] = ["space", "own"].map(|folder| {
        let step = read_step(&dir.path(&format!("{folder}/step_000010.hdf"))).unwrap();
        let grid = read_mesh(&dir.path(folder)).unwrap();
        let outer = grid.body.iter().position(|body| *body == 1).unwrap();
        let node = grid.connectivity[8 * outer] as usize;
        step.points.displacement[node]
            .iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()))
    });
    assert!(turned > 5e-3 && still < 1e-3, "{turned} {still}");
}

/// Wrong: an export into the folder of an older one would leave some of its files there before it is refused, beside
/// times that do not name them.
#[test]
fn an_export_that_would_write_over_a_file_writes_none() {
    let dir = moved();
    for form in ["vtu", "csv"] {
        let export =
            |steps: &str| dir.raceway(&["export", "out", "--to", form, "--out", form, "--steps", steps]);
        let made = export("5");
        assert_eq!(made.code, Some(0), "{}", made.stderr);
        let before = dir.snapshot();
        let refused = export("0..10");
        assert_eq!(refused.code, Some(2));
        let expected = format!("{form} already holds step_000005.{form}; choose another --out or remove it");
        assert!(refused.stderr.contains(&expected), "{}", refused.stderr);
        assert!(dir.snapshot() == before);
    }
    let refused = dir.raceway(&["export", "out", "--to", "vtu", "--out", "vtu", "--steps", "10"]);
    assert!(
        refused.stderr.contains("vtu already holds run.pvd"),
        "{}",
        refused.stderr
    );
}

/// Wrong: who gives the folder of another command would hear of a file that no such folder ever has.
#[test]
fn commands_of_runs_say_what_another_command_wrote() {
    let dir = Dir::with_scene(SCENE);
    let made = dir.raceway(&[&["stiffness", "scene.toml", "--out", "k"], &RIGID[..]].concat());
    assert_eq!(made.code, Some(0), "{}", made.stderr);
    let commands: [&[&str]; 9] = [
        &["report", "k"],
        &["life", "k"],
        &["export", "k", "--to", "csv"],
        &["pack", "k"],
        &["resume", "k"],
        &["cycles", "k"],
        &["spectrum", "k", "--probe", "x_m"],
        &["spall-length", "k", "--ring", "outer"],
        &["ball-loads", "k", "--matrix", "none.json"],
    ];
    let refused = |command: &[&str], expected: &str| {
        let told = dir.raceway(command);
        assert_eq!(told.code, Some(2), "{command:?}");
        assert!(told.stderr.contains(expected), "{command:?}: {}", told.stderr);
    };
    for command in commands {
        refused(
            command,
            "k holds a stiffness, from raceway stiffness; expected the results of raceway run; raceway plot draws",
        );
    }
    std::fs::create_dir(dir.path("h")).unwrap();
    dir.write("h/heat.json", "{}");
    for command in ["report", "plot"] {
        refused(
            &[command, "h"],
            "h holds temperatures, from raceway heat; expected the results of raceway run",
        );
    }
    // A matrix at one point has no figure, which plot itself says.
    refused(&["plot", "k"], "k has the stiffness at one point");
}
