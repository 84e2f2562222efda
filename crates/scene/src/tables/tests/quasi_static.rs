//! Scenes of quasi-static runs: what they say, and those that cannot be.

use super::*;

/// The example of motion as a quasi-static run with these keys.
fn with_keys(keys: &str) -> String {
    let (head, _) = DYNAMIC.split_once("[effects.contact_damping]").unwrap();
    format!("{head}[quasi_static]\n{keys}\n")
}

/// If this failed, a quasi-static run would have other instants than its scene names, or could not follow a speed.
#[test]
fn a_quasi_static_scene_reads_as_it_says() {
    let text = with_keys("duration = \"77 ms\"\nstep = \"0.1 ms\"\noutput_every = 10");
    let scene = parse(&text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let expected = QuasiStatic {
        duration: 77e-3,
        step: 1e-4,
        n_steps: 770,
        output_every: 10,
    };
    assert_eq!(scene.analysis, Analysis::QuasiStatic(expected));
    assert_eq!(scene.speed.unwrap().inner.times, [0.0, 1e-3]);
    let short = with_keys("duration = \"1 ms\"\nstep = \"1 ms\"");
    let Analysis::QuasiStatic(short) = parse(&short, &[]).unwrap().analysis else {
        panic!("no quasi-static run")
    };
    assert_eq!((short.n_steps, short.output_every), (1, 1));
}

/// If this failed, a slip in the scene would cost a run, or its message would not say where it is.
#[test]
fn wrong_quasi_static_scenes_are_refused() {
    let good = "duration = \"1 ms\"\nstep = \"0.1 ms\"";
    let cases = [
        (
            with_keys("step = \"1 ms\""),
            "[quasi_static] has no key \"duration\", which is required",
        ),
        (
            with_keys("duration = \"1 ms\"\nstep = \"0 s\""),
            "quasi_static.step is 0 s; a step must be positive",
        ),
        (
            with_keys("duration = \"1.05 ms\"\nstep = \"0.1 ms\""),
            "quasi_static.duration is 1.05 ms; that is 10.5 steps of 0.1 ms, expected a whole number",
        ),
        (
            with_keys(&format!("{good}\noutput_every = 0")),
            "quasi_static.output_every is 0; expected a whole number from 1 to 100000000",
        ),
        (
            with_keys(&format!("{good}\nintegrator = \"hht\"")),
            "unknown key \"integrator\" in [quasi_static]; integrator belongs to \
             [dynamic]; valid keys are \"duration\", \"step\", \"output_every\"",
        ),
        (
            with_keys(&format!("{good}\n[static]")),
            "the scene has both [static] and [quasi_static]; keep exactly one analysis",
        ),
        (
            with_keys(&format!(
                "{good}\n[effects.contact_damping]\ncoefficient = \"5e-2 N s/mm\"\nfull_approach = \"1 um\""
            )),
            "[effects.contact_damping] does nothing in a scene without inertia; remove it, or compute motion with \
             [dynamic]",
        ),
    ];
    for (text, part) in cases {
        let message = message_of(&text, &[]);
        assert!(message.contains(part), "expected\n{part}\nin\n{message}");
    }
}
