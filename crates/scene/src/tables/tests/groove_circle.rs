//! `contact.groove_circle`: what balls see of the inner groove.

use super::balls::{COULOMB, free};
use super::several::{BEAM, Lists, RIGID, list};
use super::*;

fn circle(text: &str) -> SeenGroove {
    parse(text, &[]).unwrap().contact.groove_circle
}

/// A text that leaves the key out.
fn without_key(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("groove_circle"));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Wrong: answers of the standard methods would change where tilts are locked, or a bearing that tilts would have less
/// than a torus.
#[test]
fn grooves_are_projected_where_tilts_are_locked() {
    let locked = without_key(EXAMPLE);
    assert_eq!(circle(&locked), SeenGroove::Projected);
    for tilt in ["\"free\"", "\"0 mrad\"", "\"0.1 mrad\""] {
        let text = locked.replacen("tilt_x = \"locked\"", &format!("tilt_x = {tilt}"), 1);
        assert_eq!(circle(&text), SeenGroove::Exact, "{tilt}");
    }
    let asked = locked.replacen("[contact]\n", "[contact]\ngroove_circle = \"exact\"\n", 1);
    assert_eq!(circle(&asked), SeenGroove::Exact);
    let text = asked.replacen("\"exact\"", "\"torus\"", 1);
    let message = message_of(&text, &[]);
    assert!(
        message.contains("contact.groove_circle is \"torus\"; valid values are \"exact\", \"projected\""),
        "{message}"
    );
}

/// Wrong: free balls, whose motion sees a torus, would start from where a projected groove puts them.
#[test]
fn balls_that_move_freely_see_a_torus() {
    assert_eq!(circle(&free(COULOMB, "")), SeenGroove::Exact);
    let projected =
        free(COULOMB, "").replacen("[contact]\n", "[contact]\ngroove_circle = \"projected\"\n", 1);
    let message = message_of(&projected, &[]);
    assert!(
        message.contains("contact.groove_circle is \"projected\", but free balls in motion see a torus"),
        "{message}"
    );
}

/// Wrong: a list whose shaft cannot tilt would have other answers than each of its bearings alone.
#[test]
fn bearings_of_a_list_are_projected_where_its_shaft_locks_tilts() {
    let lists = Lists::new("groove_circle");
    let kind = lists.0.join("types/kind.toml");
    std::fs::write(&kind, without_key(&std::fs::read_to_string(&kind).unwrap())).unwrap();
    let locked = RIGID
        .replace("tilt_x = \"free\"", "tilt_x = \"locked\"")
        .replace("tilt_y = \"free\"", "tilt_y = \"locked\"");
    for (shaft, expected) in [
        (locked.as_str(), SeenGroove::Projected),
        (RIGID, SeenGroove::Exact),
        (BEAM, SeenGroove::Exact),
    ] {
        let scene = lists.several(&list(shaft, ""), &[]);
        for bearing in &scene.bearings {
            assert_eq!(bearing.scene.contact.groove_circle, expected);
        }
    }
}
