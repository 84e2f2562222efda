//! Several bearings on one shaft through the whole program: run, check, stiffness, campbell, plot, refusals.

use serde_json::Value;

use crate::first_hour::has_gmsh;
use crate::util::lockstep::small_motion;
use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, Outcome, SCENE, assert_close};

/// The tables of the scene's bearing, with rigid rings, in `types/kind.toml`.
pub fn with_type() -> Dir {
    let dir = Dir::with_scene(SCENE);
    std::fs::create_dir_all(dir.path("types")).unwrap();
    dir.write("types/kind.toml", kind());
    dir
}

pub fn parts() -> [String; 2] {
    let [mut kind, mut rest] = [String::new(), String::new()];
    let mut is_kind = false;
    for line in SCENE.lines() {
        if let Some((name, _)) = line.strip_prefix('[').and_then(|line| line.split_once(']')) {
            let root = name.split('.').next().unwrap_or_default();
            is_kind = ["bearing", "materials", "contact", "inner", "outer"].contains(&root);
        }
        let text = if is_kind { &mut kind } else { &mut rest };
        *text += &format!("{line}\n");
    }
    [kind, rest]
}

pub fn kind() -> String {
    let text = parts()[0].clone();
    let kept = text.split("[inner]").next().unwrap();
    let kept = kept.replace("mode = \"patch\"", "mode = \"rigid\"");
    format!("{kept}\n[inner]\nflexible = false\n\n[outer]\nflexible = false\n")
}

pub const PAIR: &str = r#"
[[bearing]]
name = "front"
position = "60 mm"
orientation = "+z"
type = "types/kind.toml"

[[bearing]]
name = "rear"
position = "130 mm"
orientation = "-z"
type = "types/kind.toml"

[pairing]
offset = "20 um"

[shaft]
model = "beam"
material = { young_modulus = "207 GPa", poisson_ratio = 0.3, density = "7800 kg/m3" }

[[shaft.section]]
from = "0 mm"
to = "200 mm"
outside = "50 mm"
bore = "20 mm"

[[shaft.load]]
position = "0 mm"
force = ["300 N", "0 N", "200 N"]
"#;

/// The pair with rigid rings and an analysis in `pair.toml`.
pub fn pair(analysis: &str) -> Dir {
    let dir = with_type();
    dir.write("pair.toml", format!("{PAIR}\n{analysis}\n"));
    dir
}

/// The pair with flexible rings of the small motion's meshes, both of the type `types/kind.toml`.
pub fn flexible_pair(analysis: &str) -> Dir {
    let dir = small_motion();
    std::fs::create_dir_all(dir.path("types")).unwrap();
    for mesh in ["inner.msh", "outer.msh"] {
        std::fs::rename(dir.path(mesh), dir.path(&format!("types/{mesh}"))).unwrap();
    }
    dir.write("types/kind.toml", &parts()[0]);
    dir.write("pair.toml", format!("{PAIR}\n{analysis}\n"));
    dir
}

#[track_caller]
pub fn succeeds(dir: &Dir, arguments: &[&str]) -> Outcome {
    let outcome = dir.raceway(arguments);
    assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
    outcome
}

/// Wrong: tables would lack a bearing or its name, forces not balance, or the folder of a bearing be no results.
#[test]
fn a_pair_leaves_tables_of_both_and_a_folder_for_each() {
    let dir = pair("[static]");
    let said = succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    assert!(said.stdout.contains("front        +z   60.00"), "{}", said.stdout);
    let head = dir.text("out/balls.csv");
    assert!(
        head.starts_with("step,time_s,bearing,ball,azimuth_rad,inner_force_n"),
        "{head}"
    );
    assert_eq!(head.lines().filter(|line| line.contains(",rear,")).count(), 18);
    let found = summary(&dir, "out");
    let force =
        |bearing: &str, axis: usize| number(&found, &format!("/bearings/{bearing}/force_on_shaft_n/{axis}"));
    assert_close("x", force("front", 0) + force("rear", 0), -300.0, 1e-9);
    assert_close("z", force("front", 2) + force("rear", 2), -200.0, 1e-9);
    assert_eq!(found["shaft"]["model"], "beam");
    // The bearing alone, with its shaft where it stands, is what its folder says.
    let front = Table::read(&dir, "out/front/shaft.csv");
    assert_close(
        "reaction",
        front.column("reaction_z_n")[0],
        -force("front", 2),
        1e-9,
    );
    succeeds(&dir, &["info", "out/front"]);
    succeeds(&dir, &["plot", "out/front"]);
    let drawn = succeeds(&dir, &["plot", "out"]);
    assert!(drawn.stdout.contains("shaft_line"), "{}", drawn.stdout);
    let said = succeeds(&dir, &["report", "out"]);
    assert!(said.stdout.contains("report: out/report.html"), "{}", said.stdout);
    let page = dir.text("out/report.html");
    for part in [
        "<a href=\"#bearing-rear\">rear</a>",
        "<h2 id=\"bearing-front\">Bearing front</h2>",
        "<h2 id=\"bearing-rear\">Bearing rear</h2>",
        "<h3>Balls at the end</h3>",
        "aria-label=\"shaft line\"",
        "<td class=\"number\">18 of 18</td>",
        "<tr><th>front/balls.csv</th>",
        "[[bearing]]",
        "name = \"front\"",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("aria-label=\"ball force\"").count(), 2);
    let largest = number(&found, "/bearings/front/largest_ball_force_n");
    assert!(
        page.contains(&format!("<td class=\"number\">{largest:.2}</td>")),
        "{largest}"
    );
    // A page is its own: it may be made again.
    succeeds(&dir, &["report", "out", "--step", "0"]);
    std::fs::rename(dir.path("out/rear"), dir.path("rear")).unwrap();
    let refused = dir.raceway(&["report", "out"]);
    assert_eq!(refused.code, Some(2));
    let expected = "error: out has no folder rear of its bearing \"rear\"; expected the results of raceway run as they \
                    were written";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    std::fs::rename(dir.path("rear"), dir.path("out/rear")).unwrap();
    // Nothing is written over.
    assert_eq!(dir.raceway(&["run", "pair.toml", "--out", "out"]).code, Some(2));
}

/// Wrong: bearings of a list would have to be meshed one by one, each type twice, or two meshes written into one file.
#[test]
fn the_meshes_of_a_list_are_built_once_each() {
    if !has_gmsh() {
        eprintln!("skipped: the meshes of this test are made by Gmsh, which is not installed");
        return;
    }
    let dir = pair("[static]");
    let with_sections = |sectors: usize| {
        let section = |ring: &str| {
            format!(
                "[{ring}.section]\nelement = \"hex8\"\nsectors = {sectors}\ngroove_elements = 6\n\
                 thickness_elements = 2\nshoulder_elements = 1\n\n"
            )
        };
        let text = parts()[0].replace("[outer]", &(section("inner") + "[outer]"));
        text + "\n" + &section("outer")
    };
    dir.write("types/kind.toml", with_sections(36));
    let missing = dir.raceway(&["run", "pair.toml", "--out", "out"]);
    let part = "build it with \"raceway mesh pair.toml\", which needs Gmsh";
    assert!(missing.stderr.contains(part), "{}", missing.stderr);
    let said = succeeds(&dir, &["mesh", "pair.toml"]);
    assert_eq!(
        said.stdout.matches(" hex8 elements, ").count(),
        2,
        "{}",
        said.stdout
    );
    assert_eq!(
        said.stderr.matches("inner.section.shoulder_diameters").count(),
        1,
        "{}",
        said.stderr
    );
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let page = succeeds(&dir, &["report", "out"]);
    assert!(page.stderr.is_empty(), "{}", page.stderr);
    let text = dir.text("out/report.html");
    assert_eq!(text.matches("aria-label=\"section inner\"").count(), 2);
    let refused = dir.raceway(&["mesh", "pair.toml"]);
    assert_eq!(refused.code, Some(2));
    let part =
        "types/inner.msh exists already; give --force to replace it, or another mesh name in the scene";
    assert!(refused.stderr.contains(part), "{}", refused.stderr);
    // Of two meshes the one that is there is kept.
    let kept = dir.text("types/inner.section.msh");
    std::fs::remove_file(dir.path("types/outer.msh")).unwrap();
    std::fs::remove_file(dir.path("types/outer.section.msh")).unwrap();
    let said = succeeds(&dir, &["mesh", "pair.toml"]);
    assert!(said.stdout.contains("types/outer.msh: "), "{}", said.stdout);
    assert!(
        said.stderr
            .contains("types/inner.msh exists already and is kept; --force replaces it"),
        "{}",
        said.stderr
    );
    assert_eq!(kept, dir.text("types/inner.section.msh"));
    // Another type that names the same files.
    dir.write("types/other.toml", with_sections(54));
    let (head, tail) = PAIR.split_once("[pairing]").unwrap();
    let head = head.replace(
        "orientation = \"-z\"\ntype = \"types/kind.toml\"",
        "orientation = \"-z\"\ntype = \"types/other.toml\"",
    );
    dir.write("two.toml", format!("{head}[pairing]{tail}\n[static]\n"));
    let refused = dir.raceway(&["mesh", "two.toml", "--force"]);
    assert_eq!(refused.code, Some(2));
    let part = "types/inner.msh is the mesh of several bearings, which describe it otherwise: inner.section.sectors = \
                36 and 54; expected a mesh file for each";
    assert!(refused.stderr.contains(part), "{}", refused.stderr);
    // Nothing was touched.
    succeeds(&dir, &["run", "pair.toml", "--out", "again"]);
    // Rigid rings have no mesh.
    dir.write("types/kind.toml", kind());
    let refused = dir.raceway(&["mesh", "pair.toml", "--force"]);
    assert_eq!(refused.code, Some(2));
    assert!(refused.stderr.contains("[inner.section]"), "{}", refused.stderr);
}

/// Wrong: the scene of a user, kept in the folder of the results, would be replaced by that of the run.
#[test]
fn a_scene_in_the_folder_is_not_written_over() {
    let dir = pair("[static]");
    std::fs::create_dir_all(dir.path("out")).unwrap();
    dir.write("out/scene.toml", "mine");
    let refused = dir.raceway(&["run", "pair.toml", "--out", "out"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
    assert!(
        refused
            .stderr
            .contains("out already holds scene.toml; choose another --out or remove it"),
        "{}",
        refused.stderr
    );
    assert_eq!(dir.text("out/scene.toml"), "mine");
}

/// Wrong: a sweep would lose a point or its value.
#[test]
fn a_sweep_of_the_offset_stiffens_the_pair() {
    let sweep = "[sweep]\nkey = \"pairing.offset\"\nvalues = [\"10 um\", \"20 um\", \"30 um\"]";
    let dir = pair(sweep);
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let table = dir.text("out/bearings.csv");
    let mut lines = table.lines();
    let head = lines.next().unwrap();
    assert!(head.split(',').any(|name| name == "pairing.offset_m"), "{head}");
    assert_eq!(lines.count(), 6);
    let drawn = succeeds(&dir, &["plot", "out"]);
    assert!(drawn.stdout.contains("bearing_loads"), "{}", drawn.stdout);
    succeeds(&dir, &["report", "out"]);
    assert!(
        dir.text("out/report.html")
            .contains("aria-label=\"bearing loads\"")
    );
    succeeds(&dir, &["stiffness", "pair.toml", "--out", "k"]);
    let k = Table::read(&dir, "k/stiffness.csv").column("k_z_z");
    assert!(k.len() == 3 && k[0] < k[1] && k[1] < k[2], "{k:?}");
    assert!(dir.path("k/stiffness.svg").exists());
    let json: Value = serde_json::from_str(&dir.text("k/stiffness.json")).unwrap();
    assert_eq!(json["bearings"]["rear"]["points"].as_array().unwrap().len(), 3);
    assert_eq!(json["shaft"]["points"].as_array().unwrap().len(), 3);
}

/// Wrong: commands on a list would end in an error, or options that they do not know be ignored.
#[test]
fn check_stiffness_and_campbell_take_a_list() {
    let dir = pair("[static]");
    let said = succeeds(&dir, &["check", "pair.toml"]);
    assert!(
        said.stdout.contains("its rings are those of \"front\""),
        "{}",
        said.stdout
    );
    assert!(
        said.stdout.contains("shaft    beam from 0.000 to 200.000 mm"),
        "{}",
        said.stdout
    );
    succeeds(&dir, &["stiffness", "pair.toml", "--out", "k"]);
    for name in ["stiffness_front.csv", "ross_rear.csv"] {
        assert!(dir.path(&format!("k/{name}")).exists(), "{name}");
    }
    succeeds(
        &dir,
        &[
            "campbell",
            "pair.toml",
            "--speeds",
            "0..20000:10000",
            "--out",
            "c",
        ],
    );
    // At rest modes swing in planes, at speed they go round.
    let modes = dir.text("c/campbell.csv");
    let at = |speed: &str, whirl: &str| {
        let is_one = |line: &&str| line.starts_with(speed) && line.contains(whirl);
        modes.lines().filter(is_one).count()
    };
    assert!(
        at("0.0,", ",planar,") >= 2 && at("0.0,", ",forward,") == 0,
        "{modes}"
    );
    assert!(
        at("20000.0,", ",forward,") >= 1 && at("20000.0,", ",backward,") >= 1,
        "{modes}"
    );
    for arguments in [
        &["run", "pair.toml", "--out", "r2", "--points", "0"][..],
        &["life", "pair.toml"],
    ] {
        assert_eq!(dir.raceway(arguments).code, Some(2), "{arguments:?}");
    }
}

/// Wrong: soft preload would depend on the shaft, or press the wrong way; or the ring slide the wrong way in a table.
#[test]
fn a_spring_presses_the_sliding_ring_with_its_force() {
    let dir = with_type();
    let text = PAIR.replace("offset = \"20 um\"", "spring = \"500 N\"\nsliding = \"rear\"");
    dir.write("pair.toml", format!("{text}\n[static]\n"));
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let found = summary(&dir, "out");
    let force = |bearing: &str| number(&found, &format!("/bearings/{bearing}/force_on_shaft_n/2"));
    assert_close("rear", force("rear"), 500.0, 1e-8);
    assert_close("front", force("front"), -700.0, 1e-8);
    // Seats stand in the shaft's frame as all of their table, and in that of the bearing in its own.
    let of_all = dir.text("out/bearings.csv");
    let rear = of_all.lines().find(|line| line.contains(",rear,")).unwrap();
    let of_all: f64 = rear.rsplit(',').next().unwrap().parse().unwrap();
    let own = Table::read(&dir, "out/rear/shaft.csv").column("outer_seat_z_m")[0];
    assert!(own < -1e-6, "{own}");
    assert_close("seat", of_all, -own, 1e-12);
}

/// A pair that gets a load across while it speeds up, in steps of 10 us.
fn moving_pair(duration: &str) -> Dir {
    pair(&format!(
        "[speed]\ninner = {{ times = [\"0 ms\", \"1 ms\"], values = [\"1800 rpm\", \"6000 rpm\"] }}\n\
         [effects.radial_force]\nvalue = \"2 kN\"\ndirection = \"30 deg\"\n\
         [effects.radial_force.schedule.impact]\nstart = \"0.1 ms\"\nduration = \"0.4 ms\"\n\
         [effects.contact_damping]\ncoefficient = \"5e-2 N s/mm\"\nfull_approach = \"1 um\"\n\
         [dynamic]\nduration = \"{duration}\"\nstep = \"10 us\"\noutput_every = 10\n"
    ))
}

const OWN_TABLES: [&str; 8] = [
    "balls.csv",
    "bearings.csv",
    "energy.csv",
    "shaft.csv",
    "front/balls.csv",
    "front/energy.csv",
    "rear/shaft.csv",
    "rear/step_000060.hdf",
];

fn bytes(dir: &Dir, out: &str, name: &str) -> Vec<u8> {
    std::fs::read(dir.path(&format!("{out}/{name}"))).unwrap()
}

/// Wrong: a motion of a list would not balance, lose energy, or be no motion. Forces of the bearings, the load and the
/// inertia of the shaft; the defect of energy; a restart from the middle to the same bits.
#[test]
fn a_pair_moves_and_a_resumed_one_has_the_same_bits() {
    let dir = moving_pair("0.6 ms");
    let checked = succeeds(&dir, &["check", "pair.toml"]);
    let what = "analysis dynamic: 60 steps of 0.00001 s, a step file of each bearing every 10";
    assert!(checked.stdout.contains(what), "{}", checked.stdout);
    let many = ["dynamic.duration=\"1000 s\"", "dynamic.output_every=1"];
    let refused = dir.raceway(&[
        "run",
        "pair.toml",
        "--out",
        "long",
        "--set",
        many[0],
        "--set",
        many[1],
    ]);
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.stderr.contains("the results need about"),
        "{}",
        refused.stderr
    );
    assert!(!dir.path("long").exists());
    let said = succeeds(&dir, &["run", "pair.toml", "--out", "whole"]);
    assert!(said.stdout.contains("60 steps of 0.00001 s"), "{}", said.stdout);
    let found = summary(&dir, "whole");
    assert_eq!(found["analysis"], "dynamic");
    assert!(number(&found, "/residual") < 1e-9);
    let line = Table::read(&dir, "whole/shaft.csv");
    let x = line.column("x_m");
    let range = x.iter().fold(0.0f64, |m, at| m.max((at - x[0]).abs()));
    assert!(range > 1e-6, "{range}");
    succeeds(&dir, &["report", "whole"]);
    let page = dir.text("whole/report.html");
    for part in ["<h3>Energy at the end</h3>", "aria-label=\"energy ledger\""] {
        assert!(page.contains(part), "{part}");
    }
    let of_one = "whole has the results of several bearings on one shaft; expected the folder of one of them, such as \
                  whole/front";
    for command in [
        &["cycles", "whole"][..],
        &["pack", "whole"],
        &["spectrum", "whole", "--probe", "x_m", "--upto", "1000"],
        &["spall-length", "whole", "--ring", "outer"],
        &["ball-loads", "whole", "--matrix", "none.csv"],
        &["life", "whole"],
    ] {
        let refused = dir.raceway(command);
        assert_eq!(refused.code, Some(2), "{command:?}");
        assert!(refused.stderr.contains(of_one), "{command:?}: {}", refused.stderr);
    }
    // The same again, of which the half is done anew.
    succeeds(&dir, &["run", "pair.toml", "--out", "half"]);
    let refused = dir.raceway(&["resume", "half", "--set", "pairing.offset=\"1 um\""]);
    assert_eq!(refused.code, Some(2));
    assert!(
        refused.stderr.contains("a resumed run may change only"),
        "{}",
        refused.stderr
    );
    let refused = dir.raceway(&["resume", "half", "--step", "7"]);
    let expected = "has no step 7 with a restart state of all bearings; there are 0, 10, 20, 30, 40, 50, 60";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    let said = succeeds(&dir, &["resume", "half", "--step", "30"]);
    assert!(said.stdout.contains("30 steps of 0.00001 s"), "{}", said.stdout);
    for name in OWN_TABLES {
        assert!(bytes(&dir, "whole", name) == bytes(&dir, "half", name), "{name}");
    }
    let again = succeeds(&dir, &["resume", "half"]);
    assert!(
        again
            .stdout
            .contains("nothing to do: half has finished with step 60"),
        "{}",
        again.stdout
    );
}

/// Wrong: threads would change bits of a list in motion, or a step of one bearing that is damaged be taken.
#[test]
fn a_list_in_motion_has_the_same_bits_for_any_threads_and_falls_back_from_damage() {
    let dir = moving_pair("0.6 ms");
    succeeds(&dir, &["run", "pair.toml", "--out", "one", "--threads", "1"]);
    succeeds(&dir, &["run", "pair.toml", "--out", "two", "--threads", "2"]);
    for name in OWN_TABLES {
        assert!(bytes(&dir, "one", name) == bytes(&dir, "two", name), "{name}");
    }
    let mut damaged = bytes(&dir, "two", "rear/step_000060.hdf");
    let middle = damaged.len() / 2;
    damaged[middle..middle + 64].fill(7);
    std::fs::write(dir.path("two/rear/step_000060.hdf"), damaged).unwrap();
    let said = succeeds(&dir, &["resume", "two"]);
    assert!(
        said.stderr.contains("falling back to the step before"),
        "{}",
        said.stderr
    );
    for name in OWN_TABLES {
        assert!(bytes(&dir, "one", name) == bytes(&dir, "two", name), "{name}");
    }
    std::fs::remove_file(dir.path("two/summary.json")).unwrap();
    let at_rest = pair("[static]");
    succeeds(&at_rest, &["run", "pair.toml", "--out", "out"]);
    let refused = at_rest.raceway(&["resume", "out"]);
    let expected = "holds results of a [static] scene; only a run over time, a scene with [dynamic] or [quasi_static], \
                    can be resumed";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
}
