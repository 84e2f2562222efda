//! Contacts of a motion beyond what Hertz's theory and steel can do: said once per ball, counted in the summary, also
//! after a resume.

use crate::util::tables::summary;
use crate::util::{Dir, RIGID, SCENE, with_line};

/// A jump of the radial force to 40 kN at 0.1 ms on rigid rings.
fn overload() -> Dir {
    let moving = with_line(
        "[static]",
        "[static]",
        "[dynamic]\nduration = \"0.6 ms\"\nstep = \"10 us\"\noutput_every = 20",
    );
    assert!(SCENE.contains("[effects.radial_force]"));
    let late = "[effects.radial_force]\nschedule.step = { at = \"0.1 ms\" }";
    Dir::with_scene(&moving.replace("[effects.radial_force]", late))
}

fn run(dir: &Dir, out: &str, force: &str) -> crate::util::Outcome {
    let force = format!("effects.radial_force.value={force}");
    let sets = ["--set", "shaft.mass=0.5 kg", "--set", &force];
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", out][..], &RIGID[..], &sets[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    outcome
}

fn warnings(dir: &Dir, out: &str) -> Vec<String> {
    let list = summary(dir, out)["warnings"].as_array().unwrap().clone();
    list.iter().map(|w| w.as_str().unwrap().to_string()).collect()
}

/// Wrong: contacts that yield in a motion would pass without a word, or the log would repeat them at every step; a
/// run that was resumed would have another count.
#[test]
fn contacts_beyond_the_static_limit_in_motion_are_said_once_per_ball() {
    let dir = overload();
    let outcome = run(&dir, "out", "40 kN");
    let said: Vec<&str> = outcome
        .stderr
        .lines()
        .filter(|l| l.starts_with("warning: step "))
        .collect();
    assert!((1..=18).contains(&said.len()), "{said:?}");
    assert!(
        said[0].contains(" s: a peak pressure of ") && said[0].contains(" GPa at ball "),
        "{}",
        said[0]
    );
    let balls: std::collections::BTreeSet<&str> = said
        .iter()
        .map(|l| l.split(" at ball ").nth(1).unwrap().split(',').next().unwrap())
        .collect();
    assert_eq!(balls.len(), said.len(), "a ball is named twice: {said:?}");
    let texts = warnings(&dir, "out");
    assert_eq!(texts.len(), 1, "{texts:?}");
    let expected = format!("in motion, {} of 18 balls, in ", balls.len());
    assert!(
        texts[0].starts_with(&expected)
            && texts[0].contains("above the static limit of bearing steel, 4.2 GPa"),
        "{texts:?}"
    );
    // The count of steps is that of the table.
    let table = crate::util::tables::Table::read(&dir, "out/balls.csv");
    let pressures = ["inner_peak_pressure_pa", "outer_peak_pressure_pa"].map(|c| table.column(c));
    let beyond = |step: usize| (18 * step..18 * (step + 1)).any(|i| pressures.iter().any(|p| p[i] > 4.2e9));
    let steps = (1..=60).filter(|s| beyond(*s)).count();
    assert!(
        texts[0].contains(&format!(" balls, in {steps} steps, ")),
        "{texts:?}, not {steps}"
    );
    let resumed = dir.raceway(&["resume", "out", "--step", "20"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_eq!(warnings(&dir, "out"), texts);
}

/// Wrong: a motion within the limits would warn.
#[test]
fn a_motion_within_the_limits_says_nothing() {
    let dir = overload();
    let outcome = run(&dir, "out", "1 kN");
    assert!(!outcome.stderr.contains("warning"), "{}", outcome.stderr);
    assert!(warnings(&dir, "out").is_empty());
}
