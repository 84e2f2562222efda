//! Lists of bearings on a rigid shaft with a weight.

use crate::several::{PAIR, succeeds, with_type};
use crate::util::tables::{number, summary};
use crate::util::{Dir, assert_close};

/// A rigid shaft of 8 kg and its own load point between the bearings of the pair.
fn weighed(analysis: &str) -> Dir {
    let dir = with_type();
    let bearings = PAIR.split("[shaft]").next().unwrap();
    let bearings = bearings
        .replace("\"60 mm\"", "\"-40 mm\"")
        .replace("\"130 mm\"", "\"40 mm\"");
    let shaft = r#"
[shaft]
model = "rigid"
x = "free"
y = "free"
z = "free"
tilt_x = "free"
tilt_y = "free"
mass = "8 kg"
transverse_inertia = "3e-2 kg m2"
polar_inertia = "1e-2 kg m2"
load_point = "100 mm"

[effects.gravity]
acceleration = "9.81 m/s2"
direction = [0.0, -1.0, 0.0]
"#;
    dir.write("pair.toml", format!("{bearings}{shaft}\n{analysis}\n"));
    dir
}

/// Wrong: the weight of a rigid shaft would act where loads do, not where its mass is.
#[test]
fn the_weight_of_a_rigid_shaft_acts_where_its_mass_is() {
    let dir = weighed("[static]");
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let found = summary(&dir, "out");
    let force = |name: &str| number(&found, &format!("/bearings/{name}/force_on_shaft_n/1"));
    let [front, rear] = ["front", "rear"].map(force);
    assert_close("halves", front, rear, 1e-6);
    assert!(front + rear > 0.99 * 8.0 * 9.81, "{front} {rear}");
}

/// Wrong: a motion that begins at rest would be refused for round-off, the sooner the smaller its steps are: with a
/// weight and nothing else the shaft moves by less than its position is known.
#[test]
fn a_list_at_rest_closes_its_ledger_with_small_steps() {
    for step in ["10 us", "1 us"] {
        let dir = weighed(&format!(
            "[dynamic]\nduration = \"30 us\"\nstep = \"{step}\"\noutput_every = 100"
        ));
        succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    }
}
