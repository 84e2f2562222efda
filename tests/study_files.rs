//! Studies of scenes whose files change.

use crate::study::{studied, table};
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
         \"/largest_contact_force_n\"\n",
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
