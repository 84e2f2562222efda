//! The tables of all effects, each by its own example.

use dynamics::effects::{About, Effects, SpeedRole};

use super::*;

/// All there is to know of every effect.
fn all() -> Vec<About> {
    let none = Effects::default();
    none.list().iter().map(|entry| entry.about()).collect()
}

/// A scene of motion with a speed, flexible rings and no effects but what is given.
fn with_effects(tables: &str) -> String {
    let (head, tail) = DYNAMIC.split_once("[effects.axial_force]").unwrap();
    let (_, tail) = tail.split_once("[dynamic]").unwrap();
    conserving(&format!("{head}{tables}\n{}[dynamic]{tail}", balls_for(tables)))
}

/// What an effect needs besides: free balls with their traction, or another effect.
fn balls_for(tables: &str) -> &'static str {
    if tables.contains("[effects.traction]") {
        "[balls]\nmotion = \"free\"\n"
    } else if tables.contains("[effects.ball_drag]") {
        "[balls]\nmotion = \"free\"\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n"
    } else if tables.contains("[effects.orbit_inertia]") {
        "[effects.ball_centrifugal]\n"
    } else {
        ""
    }
}

/// A scene whose integrator conserves energy, as free balls ask.
fn conserving(text: &str) -> String {
    let text = replace_line(
        text,
        "integrator = \"chung_hulbert\"",
        "integrator = \"average_acceleration\"",
    );
    replace_line(&text, "rho = 0.8", "")
}

/// Wrong: the example in the file of an effect would be refused, or be the table of another; a new effect would not
/// be in the list, or under a name that is not its key.
#[test]
fn the_example_of_every_effect_is_its_table() {
    for about in all() {
        let scene = parse(&with_effects(about.example), &[]).unwrap_or_else(|e| panic!("{e}"));
        let names = scene.effects.names();
        let needed = balls_for(about.example);
        let is_own = |name: &&str| *name == about.name || !needed.contains(&format!("effects.{name}]"));
        let own: Vec<&str> = names.into_iter().filter(is_own).collect();
        assert_eq!(own, [about.name]);
        let header = format!("effects.{}]", about.name);
        let start = about.example.trim_start_matches('[');
        assert!(start.starts_with(&header), "{}", about.example);
    }
}

/// Wrong: `raceway prices` would turn an effect on with values that a scene refuses.
#[test]
fn the_trial_of_every_effect_is_a_table_of_it() {
    for (about, trial) in all().iter().filter_map(|about| Some((about, about.trial?))) {
        let value = |(key, value): &(&str, &str)| format!("effects.{}.{key}={value}", about.name);
        let mut set: Vec<String> = trial.keys.iter().map(value).collect();
        if set.is_empty() {
            set.push(format!("effects.{}={{}}", about.name));
        }
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let needed = balls_for(about.example);
        let scene = parse(&with_effects(needed), &set).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(scene.effects.names().len(), 1 + usize::from(!needed.is_empty()));
        assert!(scene.effects.names().contains(&about.name));
    }
}

/// Wrong: an effect would be computed with a speed of zero, as if it were not there.
#[test]
fn every_effect_of_speed_needs_one() {
    let text = with_effects("");
    let (head, tail) = text.split_once("[speed]").unwrap();
    let (_, tail) = tail.split_once("[dynamic]").unwrap();
    for about in all() {
        let balls = balls_for(about.example);
        let result = parse(&format!("{head}{}\n{balls}[dynamic]{tail}", about.example), &[]);
        let expected = format!("[effects.{}] needs the speed of a ring; add [speed]", about.name);
        match result {
            Ok(_) => assert!(
                matches!(about.speed, SpeedRole::None | SpeedRole::Optional),
                "{}",
                about.name
            ),
            Err(error) => assert!(error.to_string().contains(&expected), "{error}"),
        }
    }
}

/// Wrong: the remedy of an idle speed would leave out an effect that uses it, or name one that does not.
#[test]
fn an_idle_speed_is_refused_with_every_effect_that_would_use_it() {
    let still = replace_line(&at_rest("inner = \"1800 rpm\""), "[effects.ball_centrifugal]", "");
    let idle = replace_line(&still, "[effects.frame_rotation]", "");
    let message = message_of(&idle, &[]);
    let remedy = "; add one, compute motion with [dynamic], or remove [speed]";
    assert!(message.contains(remedy), "{message}");
    for about in all() {
        let uses_it = matches!(
            about.speed,
            SpeedRole::Force | SpeedRole::BallForce | SpeedRole::Optional
        );
        let header = format!("[effects.{}]", about.name);
        assert_eq!(message.contains(&header), uses_it, "{header}: {message}");
    }
}

/// Wrong: a mass off the axis that is heavier than all that turns would be solved, though it is a part of that, or one
/// be refused where the scene does not say what turns: without a mass, or with the mesh of a ring.
#[test]
fn an_unbalance_heavier_than_what_turns_is_refused() {
    let rigid = [
        "contact.mode=rigid",
        "inner.flexible=false",
        "outer.flexible=false",
    ];
    let text = with_effects("[effects.unbalance]\nmass = \"3 kg\"\neccentricity = \"1 um\"");
    let message = message_of(&text, &rigid);
    let expected = "effects.unbalance.mass is 3 kg; expected at most 2 kg, all that turns: the mass off the axis is \
                    part of shaft.mass; check the unit of both";
    assert!(message.contains(expected), "{message}");
    for others in [&["shaft.mass=3 kg"][..], &["shaft.mass=0 kg"]] {
        parse(&text, &[&rigid[..], others].concat()).unwrap();
    }
    parse(&text, &[]).unwrap();
}

/// Wrong: balls that each have a course of their own, or one that turns, would have the inertia of another.
#[test]
fn the_inertia_of_orbits_is_refused_where_balls_do_not_follow_each_other() {
    let text = with_effects("[effects.orbit_inertia]");
    parse(&text, &[]).unwrap();
    let alone = message_of(&with_effects(""), &["effects.orbit_inertia={}"]);
    let expected = "[effects.orbit_inertia] needs [effects.ball_centrifugal], without which nothing holds unloaded \
                    balls; add it, or remove the effect";
    assert!(alone.contains(expected), "{alone}");
    let unbalance = "effects.unbalance={ mass = \"10 g\", eccentricity = \"1 um\" }";
    let waves = "profiles.waviness=[{ ring = \"outer\", order = 3, amplitude = \"1 um\" }]";
    let sizes = "bearing.ball_diameters={ spread = \"1 um\", seed = 1 }";
    for (set, key) in [
        (unbalance, "[effects.unbalance]"),
        (waves, "[[profiles.*]]"),
        (sizes, "[bearing.ball_diameters]"),
    ] {
        let expected = format!(
            "[effects.orbit_inertia] takes balls to follow each other on one course, but with {key} each has its own; \
             remove one of both"
        );
        let message = message_of(&text, &[set]);
        assert!(message.contains(&expected), "{message}");
    }
}
