//! What effects matter: the rules of thumb of `raceway check`, and the price list of `raceway prices`.

use serde_json::Value;

use crate::util::tables::number;
use crate::util::{Dir, RIGID, assert_close, with_line};

/// Mass of a ball, kg: 9 mm of steel.
const BALL_MASS: f64 = 7800.0 * std::f64::consts::PI / 6.0 * 0.009 * 0.009 * 0.009;
/// Cage speed over inner ring speed of the 7010C in pure rolling.
const CAGE: f64 = 0.433_1;

fn turning(speed: &str) -> Dir {
    let dynamic = format!(
        "[dynamic]\nduration = \"0.2 ms\"\nstep = \"10 us\"\noutput_every = 1000\n\n[speed]\ninner = \"{speed}\""
    );
    Dir::with_scene(&with_line("[static]", "[static]", &dynamic))
}

/// Lines of `raceway check` that begin with a word.
fn checked(dir: &Dir, set: &[&str], word: &str) -> String {
    let set: Vec<&str> = set.iter().flat_map(|s| ["--set", s]).collect();
    let outcome = dir.raceway(&[&["check", "scene.toml"], &RIGID[..], &set[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let lines = outcome.stdout.lines().filter(|l| l.starts_with(word));
    lines.collect::<Vec<&str>>().join("\n")
}

fn check(dir: &Dir, set: &[&str]) -> String {
    checked(dir, set, "advice")
}

/// Centrifugal force of a ball, N, at its undeformed radius.
fn centrifugal(rpm: f64) -> f64 {
    let cage = CAGE * rpm * std::f64::consts::PI / 30.0;
    BALL_MASS * 0.032_48 * cage * cage
}

/// Wrong: a spectrum would be searched for ball passing frequencies that the bearing does not have.
#[test]
fn the_check_says_how_cage_and_balls_roll() {
    let line = checked(&turning("-1800 rpm"), &[], "rolling");
    let gamma = 9.0 / 65.0235 * 15f64.to_radians().cos();
    let before = |unit: &str| {
        let head = line.split(unit).next().unwrap();
        let number = head.rsplit(' ').next().unwrap();
        number.parse::<f64>().unwrap_or_else(|_| panic!("{unit}: {line}"))
    };
    assert_close("inner ring", before(" rpm inside"), -1800.0, 1e-12);
    assert_close("cage", before(" rpm, balls"), -900.0 * (1.0 - gamma), 2e-4);
    let spin = 1800.0 * 65.0235 / 18.0 * (1.0 - gamma * gamma);
    assert_close("balls", before(" rpm about"), spin, 2e-4);
    assert_close(
        "inside",
        before(" per second inside"),
        270.0 * (1.0 + gamma),
        2e-4,
    );
    assert_close(
        "outside",
        before(" per second outside"),
        270.0 * (1.0 - gamma),
        2e-4,
    );
    // The mirror: an outer ring that turns the other way, seen from it.
    let outer = ["speed.inner=0 rpm", "speed.outer=1800 rpm"];
    let mirrored = checked(&turning("-1800 rpm"), &outer, "rolling");
    let (_, passing) = line.split_once("; ").unwrap();
    assert!(mirrored.ends_with(passing), "{mirrored} {passing}");
    assert!(
        mirrored.contains("at 0.00 rpm inside and 1800.00 rpm outside: cage "),
        "{mirrored}"
    );
    let together = ["speed.inner=1800 rpm", "speed.outer=1800 rpm"];
    let line = checked(&turning("-1800 rpm"), &together, "rolling");
    let still =
        "cage 1800.00 rpm, balls 0.00 rpm about their axes; passing balls 0.000 per second inside, 0.000";
    assert!(line.contains(still), "{line}");
    let at_rest = Dir::with_scene(&with_line("[static]", "[static]", "[static]"));
    assert_eq!(checked(&at_rest, &[], "rolling"), "");
}

/// Wrong: a user of a fast bearing would not learn that an effect is missing, or by how much.
#[test]
fn effects_that_matter_and_are_off_are_pointed_out() {
    let advice = check(&turning("40000 rpm"), &[]);
    let line = |name: &str| {
        let found = advice.lines().find(|l| l.contains(name));
        found.unwrap_or_else(|| panic!("{name}: {advice}")).to_string()
    };
    let force =
        line("[effects.ball_centrifugal] is off, but the centrifugal force of a ball, m r omega_c^2 = ");
    let force = force.split("omega_c^2 = ").nth(1).unwrap();
    let force: f64 = force.split(' ').next().unwrap().parse().unwrap();
    assert_close("centrifugal force", force, centrifugal(40000.0), 5e-3);
    line("[effects.gyroscopic_moment] is off, but");
    line("friction may not hold the balls: the gyroscopic moment");
    line("[effects.cage_slip] is off, but balls may skid: F_a / (Z F_c) = 0.3");
    line("inner.flexible is false, but a ring that nothing holds stretches");
    assert!(!advice.contains("gravity"), "2 kN and a light shaft: {advice}");
}

/// Wrong: rules of thumb would take for a load of the balls what the hold of a shaft carries.
#[test]
fn forces_along_axes_that_are_held_load_no_ball() {
    let said = |sets: &[&str]| check(&turning("1800 rpm"), sets);
    let stretch = |text: &str| -> f64 {
        let (_, rest) = text
            .split_once("(2 pi E A) = ")
            .unwrap_or_else(|| panic!("{text}"));
        rest.split(' ').next().unwrap().parse().unwrap()
    };
    let z = "shaft.z=1 um";
    let [free, held] = [&[][..], &[z][..]].map(|sets| stretch(&said(sets)));
    // 2 kN along the axis at 14.9 deg carry more than 1 kN across.
    assert!(held < 0.6 * free, "{held} of {free}");
    let none = said(&[z, "shaft.x=locked", "shaft.y=locked"]);
    assert!(!none.contains("a ring that nothing holds"), "{none}");
}

/// Wrong: a user would go on paying for effects that do nothing, or be told so of effects that do.
#[test]
fn effects_that_do_nothing_and_are_on_are_pointed_out() {
    let on = ["effects.ball_centrifugal={}", "effects.gyroscopic_moment={}"];
    let slow = check(&turning("100 rpm"), &on);
    assert!(slow.contains("[effects.ball_centrifugal] is on, but"), "{slow}");
    assert!(slow.contains("[effects.gyroscopic_moment] is on, but"), "{slow}");
    let fast = check(&turning("40000 rpm"), &on);
    for name in ["ball_centrifugal", "gyroscopic_moment"] {
        assert!(!fast.contains(name), "{fast}");
    }
    let light = [
        "effects.axial_force.value=20 N",
        "effects.radial_force.value=0 N",
        "shaft.mass=2 kg",
    ];
    let light = check(&turning("100 rpm"), &light);
    assert!(
        light.contains("[effects.gravity] is off, but shaft, inner ring and balls weigh about"),
        "{light}"
    );
}

/// Wrong: the price list would turn on another effect than it says, or report other changes than the runs show.
#[test]
fn the_price_list_shows_what_an_effect_changes() {
    let dir = turning("1800 rpm");
    let outcome = dir.raceway(
        &[
            &[
                "prices",
                "scene.toml",
                "--out",
                "out",
                "--vary",
                "speed.inner=1800 rpm, 40000 rpm",
            ],
            &RIGID[..],
            &[
                "--set",
                "effects.radial_force.value=0 N",
                "--set",
                "shaft.mass=2 kg",
            ],
        ]
        .concat(),
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let json: Value = serde_json::from_str(&dir.text("out/study.json")).unwrap();
    let points = json["points"].as_array().unwrap();
    for rpm in [1800.0, 40000.0] {
        let at = |effect: &str| {
            let is = |p: &&Value| {
                p["values"]["vary_0"] == format!("{rpm} rpm") && p["values"]["effects"] == effect
            };
            points
                .iter()
                .find(is)
                .unwrap_or_else(|| panic!("{effect}: {json:#}"))
        };
        let radial = |p: &Value, side: &str| {
            let value = |name: &str| number(&p["results"][name], "/value");
            value(&format!("largest {side} ball force"))
                * value(&format!("{side} contact angle of ball 0")).cos()
        };
        let (plain, with) = (at("as it is"), at("ball_centrifugal on"));
        let excess = |p: &Value| radial(p, "outer") - radial(p, "inner");
        assert!(excess(plain).abs() < 1e-6 * radial(plain, "inner"), "{plain:#}");
        // The ball's radius grows by the approach, some micrometres of 32.5 mm.
        assert_close("outer less inner", excess(with), centrifugal(rpm), 5e-3);
        assert_eq!(
            at("gyroscopic_moment on, outer raceway control")["status"],
            "finished"
        );
        assert_eq!(at("inertia off (quasi-static)")["status"], "finished");
    }
    let text = dir.text("out/prices.md");
    assert_eq!(text.matches("| as it is |").count(), 2, "{text}");
    assert!(text.contains("## speed.inner = 40000 rpm"), "{text}");
    assert!(text.contains("| ball_centrifugal on |"), "{text}");
    let outcome = dir.raceway(&["prices", "scene.toml", "--vary", "speed.inner"]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome.stderr.contains("has no =; expected such as"),
        "{}",
        outcome.stderr
    );
    // There is no file of a study in which to leave a point out.
    let outcome = dir.raceway(&[&["prices", "scene.toml", "--vary", "cheese=1"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome
            .stderr
            .contains("is no valid scene; correct its values: --set \"cheese=1\": unknown key"),
        "{}",
        outcome.stderr
    );
}

/// Wrong: a user would not see what the near field costs, or what it changes: the stress of a probe below a ball, and
/// no force.
#[test]
fn the_price_list_has_the_near_field() {
    let dir = Dir::with_meshes();
    let point = "[static]\n[probes.point.below]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"19.6 \
                 deg\"\ndepth = \"0.1 mm\"";
    dir.write("scene.toml", with_line("[static]", "[static]", point));
    let only = ["--set", "inner.flexible=false"];
    let outcome = dir.raceway(&[&["prices", "scene.toml", "--out", "out"], &only[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let json: Value = serde_json::from_str(&dir.text("out/study.json")).unwrap();
    let points = json["points"].as_array().unwrap();
    let value = |effect: &str, name: &str| {
        let found = points.iter().find(|p| p["values"]["effects"] == effect);
        let found = found.unwrap_or_else(|| panic!("{effect}: {json:#}"));
        assert_eq!(found["status"], "finished", "{found:#}");
        number(&found["results"][name], "/value")
    };
    let stress = "largest von Mises stress at below";
    let force = "largest outer ball force";
    let [far, near] = ["as it is", "near field on"].map(|effect| value(effect, stress));
    assert!(near > 10.0 * far, "{near} and {far} Pa");
    assert_eq!(value("as it is", force), value("near field on", force));
    let text = dir.text("out/prices.md");
    assert!(text.contains("| near field on |"), "{text}");
    assert!(text.contains("| outer ring rigid |"), "{text}");
}
