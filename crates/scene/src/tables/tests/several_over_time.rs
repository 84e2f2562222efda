//! Lists of bearings in equilibria over time, and their unbalance.

use super::several::{BEAM, Lists, RIGID, list, moving};
use super::*;

const UNBALANCE: &str = "[effects.unbalance]\nmass = \"1 g\"\neccentricity = \"1 mm\"\n";

/// Wrong: bearings of a list in equilibria over time would be at rest, loads have no course, or an unbalance act in
/// every bearing.
#[test]
fn a_list_in_equilibria_over_time_has_that_in_every_bearing() {
    let lists = Lists::new("quasi");
    let more = format!(
        "{UNBALANCE}[speed]\ninner = \"600 rpm\"\n[effects.axial_force]\nvalue = \"1 kN\"\nschedule.step = {{ at = \
         \"0.5 ms\" }}\n[effects.ball_centrifugal]\n[output.every]\nstress = 2\n"
    );
    let over_time = "[quasi_static]\nduration = \"1 ms\"\nstep = \"0.1 ms\"\noutput_every = 5\n";
    let scene = lists.several(&list(BEAM, &more).replace("[static]\n", over_time), &[]);
    let Analysis::QuasiStatic(settings) = scene.analysis else {
        panic!("{:?}", scene.analysis);
    };
    assert_eq!((settings.n_steps, settings.output_every), (10, 5));
    for bearing in &scene.bearings {
        assert_eq!(bearing.scene.analysis, scene.analysis);
        assert_eq!(bearing.scene.effects.names(), ["ball_centrifugal"]);
        assert_eq!(bearing.scene.output.every.stress, 2);
    }
    assert_eq!(
        scene.effects.names(),
        ["axial_force", "ball_centrifugal", "unbalance"]
    );
}

/// Wrong: slips of a list over time would be solved, or the message would not say what to do.
#[test]
fn bad_lists_over_time_are_refused_with_advice() {
    let lists = Lists::new("bad_over_time");
    let beam = list(BEAM, "");
    let pushed = RIGID.replace(
        "x = \"free\"\ny",
        "x = { value = \"3 um\", schedule.step = { at = \"1 ms\" } }\ny",
    );
    let cases: Vec<(String, &str)> = vec![
        (
            beam.replace(
                "[static]",
                "[quasi_static]\nduration = \"1 ms\"\nstep = \"3 us\"\n",
            ),
            "quasi_static.duration is 1 ms; that is 333.",
        ),
        (
            format!("{beam}[quasi_static]\nduration = \"1 ms\"\nstep = \"2 us\"\n"),
            "the scene has both [static] and [quasi_static]; keep exactly one analysis",
        ),
        (
            moving(&list(&pushed, ""), ""),
            "shaft.x.schedule is not there for a list of bearings yet, whose shaft keeps the displacement that it is \
             given; expected shaft.x without a schedule, or a scene of one bearing",
        ),
        (
            list(BEAM, UNBALANCE),
            "effects.unbalance of a list of bearings is for [quasi_static] and [dynamic]: it turns with the shaft; at \
             rest write [[shaft.load]] with its force m e Omega^2",
        ),
        (
            moving(&list(BEAM, UNBALANCE), ""),
            "[effects.unbalance] needs the speed of a ring; add [speed] with inner = \"1800 rpm\" or remove the effect",
        ),
        (
            moving(
                &list(
                    BEAM,
                    &format!("{UNBALANCE}position = \"101 mm\"\n[speed]\ninner = \"9 rpm\"\n"),
                ),
                "",
            ),
            "effects.unbalance.position is 101.000 mm, which is off the shaft; expected 0.000 to 100.000 mm, where its \
             sections are",
        ),
    ];
    for (text, expected) in cases {
        let found = lists.message(&text);
        assert!(found.contains(expected), "found: {found}\nexpected: {expected}");
    }
}

/// Wrong: a table that the command line takes out would stay in the bearings of a list, without a word.
#[test]
fn a_table_that_is_taken_out_is_in_no_bearing() {
    let lists = Lists::new("taken_out");
    let more = "[speed]\ninner = \"600 rpm\"\n[output]\ntables_every = 3\n";
    let text = list(BEAM, more).replace(
        "[static]\n",
        "[quasi_static]\nduration = \"1 ms\"\nstep = \"0.1 ms\"\n",
    );
    let turning = lists.several(&text, &[]);
    assert!(turning.speed.is_some() && turning.bearings.iter().all(|b| b.scene.speed.is_some()));
    let standing = lists.several(&text, &["speed=none"]);
    assert!(standing.speed.is_none() && standing.bearings.iter().all(|b| b.scene.speed.is_none()));
}

/// If this failed, the balls of a list with an unbalance, whose courses turn with the shaft, would get the inertia of
/// courses that stand.
#[test]
fn balls_of_a_list_that_starts_rolling_have_the_inertia_of_orbits_without_an_unbalance() {
    let lists = Lists::new("rolling_start");
    let effects = "[speed]\ninner = \"600 rpm\"\n[effects.ball_centrifugal]\n";
    let text = moving(&list(BEAM, effects), "[dynamic.start.rolling]\n");
    let have_inertia = |text: &str| {
        let scene = lists.several(text, &[]);
        let mut effects = scene.bearings.iter().map(|bearing| &bearing.scene.effects);
        effects.all(|effects| effects.orbit_inertia.is_some())
    };
    assert!(have_inertia(&text));
    assert!(!have_inertia(&format!("{text}{UNBALANCE}")));
}
