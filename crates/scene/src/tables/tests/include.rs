//! Tables of other files.

use std::path::PathBuf;

use super::*;

/// A folder of files that goes with its test.
struct Files(PathBuf);

impl Files {
    fn new(name: &str, files: &[(&str, &str)]) -> Files {
        let folder = std::env::temp_dir().join(format!("raceway_include_{name}_{}", std::process::id()));
        for (file, text) in files {
            let path = folder.join(file);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Files(folder)
    }

    fn load(&self, file: &str, overrides: &[&str]) -> Result<Scene, SceneError> {
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        Scene::load_with(&self.0.join(file), &overrides, MeshFiles::MayBeMissing)
    }

    /// The message on a scene, without the folder.
    #[track_caller]
    fn message(&self, file: &str, overrides: &[&str]) -> String {
        let error = self.load(file, overrides).expect_err("the scene was accepted");
        error.to_string().replace(&format!("{}/", self.0.display()), "")
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The example in two files: the tables of the bearing and its rings, and the scene with all else. A table of which
/// both have a part is `[bearing]`.
fn halves() -> [String; 2] {
    let of_type = |name: &str| {
        ["bearing", "materials", "inner", "outer"].contains(&name.split('.').next().unwrap_or_default())
    };
    let [mut kind, mut rest] = [String::new(), "include = \"types/kind.toml\"\n".to_string()];
    let mut is_kind = false;
    for line in EXAMPLE.lines() {
        if let Some(name) = line
            .trim_start_matches('[')
            .split_once(']')
            .filter(|_| line.starts_with('['))
        {
            is_kind = of_type(name.0);
        }
        let text = if is_kind { &mut kind } else { &mut rest };
        *text += &format!("{line}\n");
    }
    let azimuth = EXAMPLE
        .lines()
        .find(|l| l.starts_with("first_ball_azimuth"))
        .unwrap();
    kind = kind.replace(&format!("{azimuth}\n"), "");
    rest += &format!("\n[bearing]\n{azimuth}\n");
    [kind.replace("\"../meshes/", "\"../../meshes/"), rest]
}

/// Wrong: a scene that includes its bearing would be another one than the same tables in one file, or what a run
/// records would need the other file.
#[test]
fn a_scene_in_two_files_is_the_scene_in_one() {
    let [kind, rest] = halves();
    let files = Files::new(
        "halves",
        &[
            ("a.toml", &rest),
            ("types/kind.toml", &kind),
            ("one.toml", EXAMPLE),
        ],
    );
    let (two, one) = (
        files.load("a.toml", &[]).unwrap(),
        files.load("one.toml", &[]).unwrap(),
    );
    let differ: Vec<String> = difference(&one.text, &two.text)
        .unwrap()
        .iter()
        .map(|d| d.to_string())
        .collect();
    // Paths start at the folder of the file that they stand in.
    let mesh = |ring: &str| {
        format!("{ring}.mesh from \"../meshes/7010c_{ring}.msh\" to \"types/../../meshes/7010c_{ring}.msh\"")
    };
    assert_eq!(differ, [mesh("inner"), mesh("outer")]);
    assert_eq!((&two.bearing, &two.effects), (&one.bearing, &one.effects));
    let again = Scene::parse(&two.text, &two.path, &[], MeshFiles::MayBeMissing).unwrap();
    assert_eq!(again, two);
    assert!(
        two.text
            .contains("# include = \"types/kind.toml\"\n# from types/kind.toml\n")
            || { two.text.contains("# include = ") && two.text.contains("\n# from types/kind.toml\n") }
    );
}

/// Wrong: a mistake in an included file would be looked for in the scene, or on another line.
#[test]
fn errors_name_the_file_and_the_line_where_they_were_typed() {
    let [kind, rest] = halves();
    let line = |text: &str, start: &str| 1 + text.lines().position(|l| l.starts_with(start)).unwrap();
    let files = |kind: &str, rest: &str| Files::new("errors", &[("a.toml", rest), ("types/kind.toml", kind)]);
    let width = line(&kind, "width");
    let cases = [
        (
            kind.replace("width = \"16 mm\"", "width = \"16\""),
            rest.clone(),
            format!(
                "types/kind.toml:{width}:9: bearing.width: \"16\" has no unit; expected a length such as"
            ),
        ),
        (
            kind.replace("width = \"16 mm\"", "width = \"1 mm\""),
            rest.clone(),
            format!("(line {width} of types/kind.toml)"),
        ),
        (
            kind.replace("width = \"16 mm\"", "width = 16 mm"),
            rest.clone(),
            format!("types/kind.toml:{width}:9: this is not TOML: "),
        ),
        (
            kind.clone(),
            rest.replace("x = \"free\"", "x = \"fre\""),
            format!("a.toml:{}:5: shaft.x: \"fre\" is no state", line(&rest, "x = ")),
        ),
        (
            kind.replace("width", "breadth"),
            rest.replace("x = \"free\"", "x = \"3 N\""),
            format!("(line {width} of types/kind.toml)"),
        ),
        (
            kind.clone(),
            rest.replace("[shaft]", "[shat]"),
            format!("a.toml:{}:2: unknown key \"shat\"", line(&rest, "[shaft]")),
        ),
    ];
    for (kind, rest, expected) in cases {
        let message = files(&kind, &rest).message("a.toml", &[]);
        assert!(message.contains(&expected), "expected\n{expected}\nin\n{message}");
    }
    // The mark stands below the line as it was typed.
    let message = files(&kind.replace("width = \"16 mm\"", "width = \"16\""), &rest).message("a.toml", &[]);
    assert!(
        message.contains(&format!("\n{width} | width = \"16\"\n")),
        "{message}"
    );
}

/// Wrong: one of two values would be taken without a word.
#[test]
fn a_value_that_stands_in_two_files_is_refused_with_both_places() {
    let [kind, rest] = halves();
    let twice = rest.replace("[bearing]\n", "[bearing]\nballs = 17\nbore = \"50 mm\"\n");
    let files = Files::new("twice", &[("a.toml", &twice), ("types/kind.toml", &kind)]);
    let line = |text: &str, start: &str| 1 + text.lines().position(|l| l.starts_with(start)).unwrap();
    let message = files.message("a.toml", &[]);
    let expected = format!(
        "a.toml has 2 problems:\n  bearing.balls stands in a.toml, line {}, and in types/kind.toml, line {}; leave it \
         in one of them, --set changes it for a run\n  bearing.bore_diameter stands in a.toml, line {}, and in \
         types/kind.toml, line {}; leave",
        line(&twice, "balls = 17"),
        line(&kind, "balls"),
        line(&twice, "bore"),
        line(&kind, "bore_diameter"),
    );
    assert!(
        message.starts_with(&expected),
        "expected\n{expected}\nin\n{message}"
    );
}

/// Wrong: `--set` would not reach what an included file says, or not choose another file.
#[test]
fn set_changes_included_values_and_the_file_itself() {
    let [kind, rest] = halves();
    let other = kind
        .replace("balls = 18", "balls = 17")
        .replace("sectors = 180", "sectors = 170");
    let files = Files::new(
        "set",
        &[
            ("a.toml", &rest),
            ("types/kind.toml", &kind),
            ("types/other.toml", &other),
        ],
    );
    let balls = |set: &[&str]| files.load("a.toml", set).unwrap().bearing.balls;
    assert_eq!(balls(&[]), 18);
    assert_eq!(balls(&["bearing.balls=9"]), 9);
    assert_eq!(balls(&["include=types/other.toml"]), 17);
    assert_eq!(
        balls(&[
            "bearing.balls=10",
            "inner.section.sectors=170",
            "include=\"types/other.toml\""
        ]),
        10
    );
    let message = files.message("a.toml", &["bearing.bals=9"]);
    assert!(
        message.contains("unknown key \"bals\" in [bearing]; did you mean \"balls\"?"),
        "{message}"
    );
    // Added lines do not shift the places of others.
    let message = files.message(
        "a.toml",
        &["inner.flexible=true", "shaft.x=3", "bearing.width=1 mm"],
    );
    assert!(
        message.contains("shaft.x: 3 is a number without a unit"),
        "{message}"
    );
}

/// Wrong: files of files would be lost, a circle would never end, or a missing file would leave tables out.
#[test]
fn files_include_files_and_circles_are_refused() {
    let [kind, rest] = halves();
    let (materials, kind) = kind.split_at(kind.find("[inner]").unwrap());
    let nested = format!("include = [\"parts/first.toml\"]\n{kind}");
    let files = Files::new(
        "nested",
        &[
            ("a.toml", &rest),
            ("types/kind.toml", &nested),
            ("types/parts/first.toml", materials),
        ],
    );
    assert_eq!(files.load("a.toml", &[]).unwrap().bearing.balls, 18);
    std::fs::write(
        files.0.join("types/parts/first.toml"),
        "title = \"x\"\ninclude = \"../../a.toml\"\n",
    )
    .unwrap();
    assert!(
        files.message("a.toml", &[]).starts_with(
            "types/parts/first.toml:2:11: include: files include each other in a circle: a.toml > kind.toml > \
             first.toml > a.toml\n"
        ),
        "{}",
        files.message("a.toml", &[])
    );
    let cases = [
        (
            "include = \"types/none.toml\"",
            "a.toml:1:11: include: types/none.toml cannot be read: No such file",
        ),
        (
            "include = \"types\"",
            "a.toml:1:11: include: types is no plain file; expected a file of TOML",
        ),
        (
            "include = \"\"",
            "a.toml:1:11: include: this includes no file; expected the path of a file such as",
        ),
        (
            "include = [\"types/kind.toml\", 3]",
            "a.toml:1:31: include[1]: this includes no file; expected",
        ),
        (
            "[shaft]\ninclude = \"b.toml\"",
            "unknown key \"include\" in [shaft]; include stands at the top, before the",
        ),
        (
            "includes = \"b.toml\"",
            "unknown key \"includes\"; did you mean \"include\"?",
        ),
        (
            "include = \"types/dotted.toml\"\n[bearing]\n",
            "a.toml:1:11: include: what is included does not go with this file (duplicate key): write each table",
        ),
    ];
    std::fs::write(files.0.join("types/dotted.toml"), "bearing.balls = 18\n").unwrap();
    for (text, expected) in cases {
        std::fs::write(files.0.join("a.toml"), text).unwrap();
        let message = files.message("a.toml", &[]);
        assert!(
            message.contains(expected),
            "{text}: expected\n{expected}\nin\n{message}"
        );
    }
}

/// Wrong: who mistypes a `--set` would look for it in a file, on a line that says something else.
#[test]
fn a_wrong_override_of_an_included_value_is_that_of_the_command_line() {
    let [kind, rest] = halves();
    let files = Files::new("overridden", &[("scene.toml", &rest), ("types/kind.toml", &kind)]);
    let cases = [
        (
            "bearing.ball_diameter=9",
            "bearing.ball_diameter: 9 is a number without a unit",
        ),
        (
            "bearing.ball_diametr=9 mm",
            "unknown key \"ball_diametr\" in [bearing]",
        ),
        (
            "effects.axial_force.value=2",
            "effects.axial_force.value: 2 is a number without a unit",
        ),
    ];
    for (argument, problem) in cases {
        // What the command line gives besides, and gives rightly, is not named.
        let message = files.message("scene.toml", &["bearing.balls=17", argument]);
        assert!(
            message.starts_with(&format!("--set {argument:?}: {problem}")),
            "{message}"
        );
    }
    // A mistake in the file stays one of the file.
    let typed = kind.replacen("ball_diameter = \"9 mm\"", "ball_diameter = 9", 1);
    std::fs::write(files.0.join("types/kind.toml"), typed).unwrap();
    let message = files.message("scene.toml", &["bearing.balls=17"]);
    assert!(message.starts_with("types/kind.toml:"), "{message}");
}
