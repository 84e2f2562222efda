//! Rules of thumb of a list: effects are those of all its bearings, which carry different loads.

use crate::several::{pair, succeeds};
use crate::util::Dir;
use crate::util::tables::summary;

const STEPS: &str = "[dynamic]\nduration = \"0.1 ms\"\nstep = \"10 us\"";

fn advised(dir: &Dir, sets: &[&str]) -> Vec<String> {
    let sets = sets.iter().flat_map(|set| ["--set", *set]);
    let arguments: Vec<&str> = ["check", "pair.toml"].into_iter().chain(sets).collect();
    let said = succeeds(dir, &arguments).stdout;
    let lines = said.lines().filter_map(|line| line.strip_prefix("advice   "));
    lines.map(str::to_string).collect()
}

/// The lines on an effect.
fn on<'a>(lines: &'a [String], effect: &str) -> Vec<&'a str> {
    let named = format!("[effects.{effect}] is ");
    let lines = lines.iter().map(String::as_str);
    lines.filter(|line| line.contains(&named)).collect()
}

/// Wrong: an effect that all bearings share would be left out of a fast spindle without a word, or be named for the
/// bearing that misses it least. The front bearing carries the force at the nose, the rear one has the smaller load.
#[test]
fn an_effect_that_is_missing_is_told_of_the_bearing_that_misses_it_most() {
    let dir = pair(STEPS);
    let fast = ["speed.inner=20000 rpm"];
    let lines = advised(&dir, &fast);
    let [line] = on(&lines, "ball_centrifugal")[..] else {
        panic!("{lines:?}")
    };
    let rest = line
        .strip_prefix("bearing \"rear\": [effects.ball_centrifugal] is off, but the centrifugal force of ");
    assert!(
        rest.is_some_and(|rest| rest.contains("% of its load of about ")),
        "{line}"
    );
    assert!(on(&lines, "gravity").is_empty(), "not of a bearing: {lines:?}");
    let said = succeeds(&dir, &["run", "pair.toml", "--out", "out", "--set", fast[0]]);
    let kept = summary(&dir, "out")["advice"].clone();
    let kept: Vec<&str> = kept
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|text| text.as_str())
        .collect();
    for line in &lines {
        assert!(
            said.stderr.contains(&format!("advice: {line}")),
            "{}",
            said.stderr
        );
        assert!(kept.contains(&line.as_str()), "{kept:?}");
    }
}

/// Wrong: an effect would be called idle although one of the bearings needs it.
#[test]
fn an_effect_is_idle_where_it_is_in_all_bearings() {
    let dir = pair(STEPS);
    let at = |rpm: &str| {
        let speed = format!("speed.inner={rpm} rpm");
        let lines = advised(&dir, &[&speed, "effects.ball_centrifugal={}"]);
        println!("{rpm}: {lines:?}");
        on(&lines, "ball_centrifugal").len()
    };
    assert_eq!([at("100"), at("800"), at("3000")], [1, 0, 0]);
}
