//! Studies of scenes whose files change.

use crate::study::{STUDY, inputs, studied, table};
use crate::util::delivered::coarse;
use crate::util::{Dir, Outcome};

fn study(dir: &Dir) -> Outcome {
    dir.raceway(&["study", "study.toml", "--out", "out"])
}

/// Wrong: points would be mixed that were run with one mesh and with another of the same name.
#[test]
fn a_study_refuses_points_of_files_that_have_changed() {
    let dir = coarse(&["scenes/7010c_1800rpm_quasi_static_coarse.toml"]);
    dir.write(
        "study.toml",
        "scene = \"scenes/7010c_1800rpm_quasi_static_coarse.toml\"\nset = ['quasi_static.duration = \"0.2 ms\"', \
         'outer.mesh = \"{out}/outer.msh\"']\n[[axes]]\nname = \"load\"\nvalues = [{ name = \"a\", set = \
         ['effects.axial_force.value = \"1 kN\"'] }]\n[[quantities]]\nname = \"force\"\nunit = \"N\"\nsummary = \
         \"/balls/0/inner/force_n\"\n",
    );
    std::fs::create_dir_all(dir.path("out")).unwrap();
    let mesh = std::fs::read(dir.path("meshes/7010c_outer_coarse.msh")).unwrap();
    std::fs::write(dir.path("out/outer.msh"), &mesh).unwrap();
    let first = study(&dir);
    assert_eq!(first.code, Some(0), "{}", first.stderr);
    assert_eq!(study(&dir).code, Some(0));
    std::fs::write(dir.path("out/outer.msh"), [&mesh[..], b"\n"].concat()).unwrap();
    let changed = study(&dir);
    assert_eq!(changed.code, Some(2));
    assert!(
        changed
            .stderr
            .contains("was run with other contents of the file of outer.mesh than study.toml asks for now"),
        "{}",
        changed.stderr
    );
}

/// Wrong: the command would name meshes from where `advise` was called, and a run looks from the folder of its scene.
#[test]
fn advice_names_meshes_from_the_root() {
    let dir = studied();
    let mut json = table(&dir);
    for point in json["points"].as_array_mut().unwrap() {
        point["set"] = serde_json::json!(["inner.mesh = \"{out}/meshes/a.msh\""]);
    }
    dir.write("out/study.json", json.to_string());
    let outcome = dir.raceway(&["advise", "out", "--error", "0.1%", "--quantity", "history"]);
    let mesh = outcome.stdout.split("inner.mesh = \"").nth(1);
    let mesh = mesh.unwrap_or_else(|| panic!("no mesh in {}", outcome.stdout));
    assert!(
        mesh.starts_with('/') && mesh.contains("/out/meshes/a.msh\"'"),
        "{mesh}"
    );
}

/// Wrong: the number of the last ball would be taken for that of all, and the rows of all balls be compared with that
/// of the first: 87 % of error where a step halved changes the forces by a ten-thousandth.
#[test]
fn rows_of_several_balls_at_a_time_are_compared_ball_by_ball() {
    let dir = studied();
    let quantity = |take: &str| {
        let text = dir.text("study.toml");
        let head = text.split("[[quantities]]").next().unwrap();
        let reference = "reference = { point = { scheme = \"average\", step = \"0.25\" } }";
        let one = match take {
            "final" => "",
            _ => reference,
        };
        dir.write(
            "study.toml",
            format!(
                "{head}[[quantities]]\nname = \"force\"\nunit = \"N\"\ntable = \"balls.csv\"\ncolumn = \
                 \"inner_force_n\"\ntake = \"{take}\"\n{one}\n"
            ),
        );
        study(&dir)
    };
    assert_eq!(quantity("history").code, Some(0));
    let json = table(&dir);
    let errors: Vec<f64> = json["points"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|point| point["results"]["force"]["error"].as_f64())
        .collect();
    assert_eq!(errors.len(), 6, "{errors:?}");
    assert!(errors.iter().all(|error| *error < 0.02), "{errors:?}");
    let last = quantity("final").stdout;
    let told = "force: balls.csv has 18 rows at the last time, and take = \"final\" is one of them; say which by \
                where, such as where = { ball = 0 }, or take another number of all, such as \"max\"";
    assert!(last.contains(told), "{last}");
}

/// Wrong: a column that is mistyped would be told after hours of runs; or what has been computed would be lost, or a
/// study refused where only some points have a number.
#[test]
fn a_quantity_that_is_mistyped_is_told_after_the_first_point() {
    let dir = inputs();
    let text = "quantity \"history\": shaft.csv has no column \"x\"; columns are step, time_s, x_m";
    let mistyped = STUDY.replace("column = \"x_m\"", "column = \"x\"");
    dir.write("study.toml", &mistyped);
    let refused = study(&dir);
    assert_eq!(refused.code, Some(2), "{}", refused.stdout);
    for said in [
        text,
        "point 0 is the first that has finished",
        "the same command goes on",
    ] {
        assert!(refused.stderr.contains(said), "{said}: {}", refused.stderr);
    }
    let ran = |index: usize| dir.path(&format!("out/points/{index:04}/point.json")).exists();
    assert!(ran(0) && !ran(1));
    // Again: before any run.
    let refused = study(&dir);
    assert!(refused.code == Some(2) && refused.stderr.contains(text) && !ran(1));
    let signals = "[signals]\ntable = \"shaft.csv\"\ncolumns = [\"y\"]\n";
    dir.write("study.toml", format!("{STUDY}\n{signals}"));
    let refused = study(&dir);
    assert!(refused.code == Some(2) && !ran(1), "{}", refused.stderr);
    assert!(refused.stderr.contains("[signals]: "), "{}", refused.stderr);
    let other = STUDY.replace("table = \"shaft.csv\"", "table = \"shafts.csv\"");
    dir.write("study.toml", other);
    let refused = study(&dir);
    let text = "run/shafts.csv is not there; tables there are balls.csv, energy.csv, shaft.csv";
    assert!(refused.stderr.contains(text) && !ran(1), "{}", refused.stderr);
    let record = dir.text("out/points/0000/point.json");
    let optional = "take = \"history\"\noptional = true";
    dir.write("study.toml", mistyped.replace("take = \"history\"", optional));
    let all = study(&dir);
    assert_eq!(all.code, Some(0), "{}", all.stderr);
    assert!(
        all.stdout.contains("history: shaft.csv has no column \"x\""),
        "{}",
        all.stdout
    );
    assert_eq!(dir.text("out/points/0000/point.json"), record);
}
