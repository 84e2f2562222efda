//! `contact.groove_circle`: what balls see of the inner groove.

use super::balls::{COULOMB, free};
use super::*;

fn circle(text: &str) -> SeenGroove {
    parse(text, &[]).unwrap().contact.groove_circle
}

/// A text that leaves the key out.
fn without_key(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("groove_circle"));
    lines.map(|line| format!("{line}\n")).collect()
}

/// Wrong: kinematic balls would push a cage that nothing holds, and answers not be those of the standard methods.
#[test]
fn grooves_are_projected_unless_a_scene_asks_for_a_torus() {
    let usual = without_key(EXAMPLE);
    assert_eq!(circle(&usual), SeenGroove::Projected);
    let free = usual.replace("\"locked\"", "\"free\"");
    assert_eq!(circle(&free), SeenGroove::Projected);
    let asked = usual.replacen("[contact]\n", "[contact]\ngroove_circle = \"exact\"\n", 1);
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
