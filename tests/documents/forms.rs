//! Commands that pages show with placeholders (`raceway plot DIR`), run on inputs that fit.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::commands::{Command, commands_of};
use super::{is_user_page, pages, text_of};
use crate::first_hour::has_gmsh;
use crate::remarks::SECTION;
use crate::util::Dir;

/// Words of commands and what stands for them; a word of one command stands before the same word of all.
const EXAMPLES: [(&str, &str); 14] = [
    ("heat SCENE", "heat warm.toml"),
    ("mesh SCENE", "mesh new.toml"),
    ("prices SCENE", "prices short.toml"),
    ("pack DIR", "pack turning"),
    ("SCENE", "scene.toml"),
    ("STUDY", "study.toml"),
    ("FILE.toml", "mix.toml"),
    ("RUN", "rest"),
    ("PATH", "turning"),
    ("NAME", "g0"),
    ("--matrix DIR/", "--matrix out/load-matrix/"),
    ("--out DIR", "--out out/"),
    ("0..40000:2000", "0..40000:20000"),
    ("DIR", "turning"),
];

/// A folder with an equilibrium `rest`, a motion `turning`, the scenes of both, a short motion, a study, shares of
/// time, a scene with a heat balance and one without meshes.
fn inputs() -> Dir {
    let dir = Dir::with_meshes();
    let mut gauges = String::new();
    for k in 0..18 {
        let at = f64::from(k) * 20.0 + 2.0;
        let _ = write!(
            gauges,
            "[probes.gauge.g{k}]\nring = \"outer\"\nsurface = \"seat\"\nazimuth = \"{at} deg\"\nz = \"4 mm\"\n\
             length = \"2 mm\"\nwidth = \"1 mm\"\ndirection = \"hoop\"\n\n"
        );
    }
    let life = "[life]\ncontact_angle = \"15 deg\"\n\n[speed]\ninner = \"1800 rpm\"\n\n\
                [effects.ball_centrifugal]\n\n";
    let scene = crate::util::SCENE.replace(
        "[outer]\nmesh = \"outer.msh\"\nmesh_unit = \"mm\"\nsupport = \"clamped\"",
        "[outer]\nmesh = \"outer.msh\"\nmesh_unit = \"mm\"\nsupport = \"mean_motion\"",
    );
    let with = |analysis: &str| scene.replace("[static]", &format!("{life}{gauges}{analysis}"));
    dir.write("scene.toml", with("[static]"));
    let points = "\n[probes.point.p]\nring = \"inner\"\nazimuth = \"3 deg\"\ngroove_angle = \"15 deg\"\n\
                  depth = \"0.1 mm\"\n\n[stress]\nnear_field = true\n";
    let lasting =
        |time: &str| format!("[dynamic]\nduration = \"{time}\"\nstep = \"10 us\"\noutput_every = 20\n");
    dir.write("motion.toml", with(&lasting("2 ms")) + points);
    dir.write("short.toml", with(&lasting("0.2 ms")) + points);
    let heat = "expansion = \"11.5e-6 /K\"\n";
    let warm = with("[static]").replace(
        "density = \"7800 kg/m3\"\n",
        &format!("density = \"7800 kg/m3\"\n{heat}"),
    );
    let balance = "\n[heat]\nambient = \"20 degC\"\ntorque = \"0.05 N m\"\nconductance.inner_ambient = \"0.4 W/K\"\n\
                   conductance.outer_ambient = \"2 W/K\"\nconductance.inner_outer = \"0.8 W/K\"\n";
    dir.write("warm.toml", warm + balance);
    dir.write(
        "new.toml",
        scene.replace("inner.msh", "new.msh").replace("[outer]", SECTION),
    );
    let study = include_str!("../fixtures/study.toml").replace("\"scene.toml\"", "\"pulse.toml\"");
    dir.write("study.toml", study);
    dir.write("pulse.toml", scene.replace("[static]", &lasting("0.4 ms")));
    let mix = "title = \"shift\"\n[[conditions]]\nresults = \"rest\"\nshare = 0.7\n[[conditions]]\nresults = \
               \"turning\"\nshare = 0.3\n";
    dir.write("mix.toml", mix);
    for (scene, out) in [("scene.toml", "rest"), ("motion.toml", "turning")] {
        let outcome = dir.raceway(&["run", scene, "--out", out]);
        assert_eq!(outcome.code, Some(0), "{scene}: {}", outcome.stderr);
    }
    std::fs::create_dir(dir.path("out")).unwrap();
    dir
}

/// A form without what may be left out, with inputs for its placeholders.
fn filled(form: &str) -> String {
    let mut text = String::new();
    let mut depth = 0;
    for c in form.chars() {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            c if depth == 0 => text.push(c),
            _ => {}
        }
    }
    let text = EXAMPLES
        .iter()
        .fold(text, |text, (word, example)| text.replace(word, example));
    let name = text.split_whitespace().nth(1).unwrap_or_default().to_string();
    text.trim().replace("--out out/", &format!("--out out/{name}"))
}

/// Wrong: a form of a command would be taken, but not do what the page says it does without more words.
#[test]
fn commands_with_placeholders_run_on_inputs_that_fit() {
    let dir = inputs();
    let mut done = BTreeSet::new();
    for page in pages()
        .iter()
        .filter(|page| is_user_page(page) || *page == "README.md")
    {
        let commands = commands_of(&text_of(page)).unwrap();
        for command in commands.iter().filter(|command| command.is_form()) {
            let text = filled(&command.text);
            let is_possible = !text.starts_with("raceway mesh ") || has_gmsh();
            if !is_possible || !done.insert(text.clone()) {
                continue;
            }
            let outcome = Command::shown(text.clone()).run(&dir);
            assert_eq!(outcome.code, Some(0), "{page}: {text}: {}", outcome.stderr);
        }
    }
    assert!(done.len() >= 20, "only these forms were found: {done:?}");
}
