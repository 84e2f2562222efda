//! Heat balances through the whole program.

use serde_json::Value;

use crate::util::tables::{Table, number};
use crate::util::{Dir, RIGID, SCENE, assert_close};

/// Known friction, and two rings that lose heat.
const HEAT: &str = "[heat]\nambient = \"20 degC\"\nspeed = \"3000 rpm\"\ntorque = \"0.05 N m\"\n\
                    conductance.inner_ambient = \"0.4 W/K\"\nconductance.outer_ambient = \"2 W/K\"\n\
                    conductance.inner_outer = \"0.8 W/K\"\n\n[static]";

/// A folder with a scene that has `[heat]` and thermal expansion.
fn scene(heat: &str) -> Dir {
    let expansion = "density = \"7800 kg/m3\"\nexpansion = \"11.5e-6 /K\"\n";
    let text = SCENE.replace("density = \"7800 kg/m3\"\n", expansion);
    Dir::with_scene(&text.replace("[static]", heat))
}

fn heat_file(dir: &Dir, folder: &str) -> Value {
    serde_json::from_str(&dir.text(&format!("{folder}/heat.json"))).unwrap()
}

/// The command must end so, with this text.
fn refused(dir: &Dir, arguments: &[&str], code: i32, expected: &str) {
    let outcome = dir.raceway(&[&["heat", "scene.toml"], &RIGID[..], arguments].concat());
    assert_eq!(outcome.code, Some(code), "{arguments:?}: {}", outcome.stderr);
    assert!(
        outcome.stderr.contains(expected),
        "{arguments:?}: {}",
        outcome.stderr
    );
}

/// Wrong: power, temperatures and clearance would not be those of one bearing. With a torque that is known two rings
/// have their closed form, and the clearance is that of their strains: P_d = D_e (1 + e_o) - d_i (1 + e_i) - 2 D_w (1 +
/// e_b).
#[test]
fn a_given_torque_warms_two_rings_by_their_closed_form() {
    let dir = scene(HEAT);
    let outcome = dir.raceway(&[&["heat", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = heat_file(&dir, "out");
    let power = 0.05 * 3000.0 * std::f64::consts::PI / 30.0;
    let (g_i, g_o, g) = (0.4, 2.0, 0.8);
    let determinant = g_i * g_o + g * (g_i + g_o);
    let inner = 0.5 * power * (g_o + 2.0 * g) / determinant;
    let outer = 0.5 * power * (g_i + 2.0 * g) / determinant;
    assert_close(
        "inner",
        number(&found, "/temperatures_k/0"),
        293.15 + inner,
        1e-10,
    );
    assert_close(
        "outer",
        number(&found, "/temperatures_k/1"),
        293.15 + outer,
        1e-10,
    );
    assert_close("balance", number(&found, "/given_off_w"), power, 1e-9);
    assert_eq!(found["end"], "steady");
    let strain = |rise: f64| 11.5e-6 * rise;
    let clearance = 74.037e-3 * (1.0 + strain(outer))
        - 56.01e-3 * (1.0 + strain(inner))
        - 18e-3 * (1.0 + strain(0.5 * (inner + outer)));
    // Growth is counted from the outer ring: products of strains, 1e-7 of a diameter, are left out.
    assert_close(
        "clearance",
        number(&found, "/rounds/1/radial_clearance_m"),
        clearance,
        2e-5,
    );
    assert!(outcome.stdout.contains("friction: given"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("steady: "), "{}", outcome.stdout);
}

/// Wrong: a bearing that seizes would end with a code of success. Locked along the axis, its balls are squeezed as the
/// inner ring becomes warm; friction grows with that.
#[test]
fn a_runaway_is_named_and_is_an_error() {
    let dir = scene(HEAT);
    let squeezed = [
        "--out",
        "out",
        "--set",
        "shaft.z=20 um",
        "--set",
        "effects.axial_force=none",
    ];
    let text = dir.text("scene.toml").replace(
        "torque = \"0.05 N m\"",
        "f_0 = 2.0\nf_1 = 0.004\nviscosity = \"20 mm2/s\"",
    );
    dir.write(
        "scene.toml",
        text.replace("0.4 W/K", "0.1 W/K").replace("0.8 W/K", "0.01 W/K"),
    );
    refused(&dir, &squeezed, 3, "thermal runaway: after ");
    assert_eq!(heat_file(&dir, "out")["end"], "runaway");
    let rounds = heat_file(&dir, "out")["rounds"].as_array().unwrap().len();
    assert!(rounds > 1, "{rounds}");
}

/// Wrong: thick oil, whose friction falls faster than it warms the bearing, would have no steady state, or be taken for
/// a runaway. The power of the last round is that which flows off, within 0.5 K.
#[test]
fn thick_oil_has_its_steady_state() {
    let oil = "f_0 = 6.0\nf_1 = 6e-4\nviscosity_class = 680\nviscosity_at_100 = \"40 mm2/s\"";
    let cooled = HEAT
        .replace("0.4 W/K", "2.0 W/K")
        .replace("\"2 W/K\"", "\"5 W/K\"");
    let dir = scene(&cooled.replace("torque = \"0.05 N m\"", oil));
    let outcome = dir.raceway(&[&["heat", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = heat_file(&dir, "out");
    assert_eq!(found["end"], "steady");
    let rounds = found["rounds"].as_array().unwrap();
    assert!((4..=10).contains(&rounds.len()), "{}", rounds.len());
    assert!(number(&found, "/gain") < -1.0);
    let last = rounds.last().unwrap();
    for body in 0..2 {
        let was = last["temperatures_k"][body].as_f64().unwrap();
        let is = number(&found, &format!("/temperatures_k/{body}"));
        assert!((was - is).abs() < 0.5, "{was} {is}");
    }
}

/// Wrong: what a balance cannot be found with would be guessed, or an error would name a key that no scene has.
#[test]
fn what_a_balance_lacks_is_said() {
    let dir = scene(HEAT);
    let set = |value: &'static str| ["--set", value];
    let cases: [(&[&str], &str); 14] = [
        (
            &set("heat=none"),
            "has no [heat]; expected friction and conductances",
        ),
        (
            &set("effects.temperature={inner=\"20 degC\", outer=\"20 degC\", balls=\"20 degC\"}"),
            "has [effects.temperature], which raceway heat finds; remove it",
        ),
        (
            &set("heat.conductance={inner_ambient=\"1 W/K\"}"),
            "heat.conductance leads no heat from the outer ring to the surroundings; add outer_ambient, or a chain",
        ),
        (
            &set("heat.conductance.inner_cage=\"1 W/K\""),
            "heat.conductance.inner_cage joins no two bodies; expected two of inner, outer, balls, shaft, housing",
        ),
        (
            &set("heat.conductance.outer_inner=\"1 W/K\""),
            "joins what another key joins already; keep one of them",
        ),
        (
            &set("heat.conductance.inner_balls=\"0 W/K\""),
            "heat.conductance.inner_balls is 0 W/K; a conductance must be positive",
        ),
        (
            &set("heat.conductance.shaft_housing=\"1 W/K\""),
            "heat.conductance leads no heat from the shaft to the surroundings",
        ),
        (
            &set("heat.f_0=2.0"),
            "heat.torque and heat.f_0 both say how much friction there is; keep one way",
        ),
        (
            &set("heat.torque=\"0 N m\""),
            "heat.torque is 0 N m; a torque must be positive",
        ),
        (
            &set("heat.limit=\"10 degC\""),
            "heat.limit is 10 degC; expected more than the ambient 20 degC",
        ),
        (
            &set("heat.ambient=\"200 degC\""),
            "heat.ambient is 200 degC; expected -100 degC to 150 degC",
        ),
        (
            &set("heat.speed=\"0 rpm\""),
            "heat.speed is 0 rpm; expected a speed of at most 1e5 rad/s",
        ),
        (
            &[
                "--set",
                "speed.inner=1800 rpm",
                "--set",
                "effects.ball_centrifugal={}",
            ],
            "heat.speed is given, but [speed] says how fast the rings turn; remove heat.speed",
        ),
        (
            &set("heat.conductance.inner_shaft=\"5\""),
            "\"5\" has no unit, of which \"W/K\", \"mW/K\", \"kW/K\" are known; expected \
             a thermal conductance such as \"5 W/K\"",
        ),
    ];
    for (arguments, expected) in cases {
        refused(&dir, arguments, 2, expected);
    }
    let of = |from: &str, to: &str, expected: &str| {
        let other = scene(&HEAT.replace(from, to));
        refused(&other, &[], 2, expected);
    };
    of(
        "ambient = \"20 degC\"\nspeed = \"3000 rpm\"\ntorque = \"0.05 N m\"\n",
        "ambient = \"-70 degC\"\nspeed = \"3000 rpm\"\nf_0 = 2.0\nf_1 = 1e-3\nviscosity_class = 32\n\
         viscosity_at_100 = \"5.4 mm2/s\"\n",
        "heat.ambient is -70 degC; expected -60 degC to 300 degC of an oil by its class",
    );
    of(
        "speed = \"3000 rpm\"\n",
        "",
        "[heat] needs a speed; add heat.speed",
    );
    let torque = "torque = \"0.05 N m\"\n";
    of(
        torque,
        "",
        "[heat] has no friction; add heat.torque, or heat.f_0, heat.f_1 and a viscosity",
    );
    of(
        torque,
        "f_0 = 2\nf_1 = 0.001\n",
        "Palmgren's formula of [heat] has no viscosity; add heat.viscosity",
    );
    of(
        torque,
        "f_0 = 2\nf_1 = 0.001\nviscosity_class = 68\n",
        "heat.viscosity_class is the viscosity at 40 degC, and the bearing has the temperature that is found",
    );
    of(
        torque,
        "f_0 = 200\nf_1 = 0.001\nviscosity = \"20 mm2/s\"\n",
        "heat.f_0 is 200; expected 0 to 50",
    );
    let cold = Dir::with_scene(&SCENE.replace("[static]", HEAT));
    refused(
        &cold,
        &[],
        2,
        "a heat balance needs the thermal expansion of rings and balls",
    );
    let swept = scene(&HEAT.replace(
        "[static]",
        "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"2 kN\"]",
    ));
    refused(
        &swept,
        &[],
        2,
        "is no single equilibrium; a heat balance takes a scene with [static]",
    );
    dir.write("heat.json", "{}");
    refused(&dir, &["--out", "."], 2, "heat.json");
    assert_eq!(dir.text("heat.json"), "{}");
}

/// Wrong: the heat of free balls would not be that of their equilibrium at the temperatures found. The last round
/// beside a run of the scene at these temperatures.
#[test]
fn free_balls_warm_a_bearing_by_their_own_friction() {
    let balls = "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n\
                 [speed]\ninner = \"3000 rpm\"\n\n[heat]";
    let text = HEAT.replace("speed = \"3000 rpm\"\ntorque = \"0.05 N m\"\n", "");
    let dir = scene(&text.replace("[heat]", balls));
    let outcome = dir.raceway(&[&["heat", "scene.toml", "--out", "out"], &RIGID[..]].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let found = heat_file(&dir, "out");
    assert_eq!(found["friction"], "free_balls");
    let rounds = found["rounds"].as_array().unwrap();
    let last = rounds.last().unwrap();
    let torque = last["torque_n_m"].as_f64().unwrap();
    let power = torque * 3000.0 * std::f64::consts::PI / 30.0;
    assert_close("balance", number(&found, "/given_off_w"), power, 1e-9);
    let of = |i: usize| last["temperatures_k"][i].as_f64().unwrap() - 273.15;
    let set = ["inner", "outer", "balls"].map(|body| {
        let place = ["inner", "outer", "balls"]
            .iter()
            .position(|name| *name == body)
            .unwrap();
        format!("effects.temperature.{body}=\"{:?} degC\"", of(place))
    });
    let mut arguments = vec!["run", "scene.toml", "--out", "warm"];
    arguments.extend(RIGID);
    set.iter().for_each(|set| arguments.extend(["--set", set]));
    let outcome = dir.raceway(&arguments);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let shaft = Table::read(&dir, "warm/shaft.csv");
    assert_close("torque", shaft.column("friction_torque_n_m")[0], torque, 1e-6);
    refused(
        &dir,
        &["--set", "heat.torque=\"0.1 N m\""],
        2,
        "heat.torque stands beside balls.motion = \"free\", whose friction is a result; remove it",
    );
}

/// Wrong: with drag of the balls an outer ring that turns would warm the bearing by a part of its power, that of the
/// torque on the inner ring which stands. Either ring puts in what contacts lose and what drag takes, n k (r w_c)^3
/// with k = rho C_d pi D_w^2/8.
#[test]
fn drag_warms_whichever_ring_turns() {
    let text = HEAT.replace("speed = \"3000 rpm\"\ntorque = \"0.05 N m\"\n", "");
    for ring in ["inner", "outer"] {
        let balls = format!(
            "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n\
             [effects.ball_drag]\ncoefficient = 0.5\ndensity = \"25 kg/m3\"\n\n\
             [speed]\n{ring} = \"-9000 rpm\"\n\n[heat]"
        );
        let dir = scene(&text.replace("[heat]", &balls));
        let no_radial = ["--set", "effects.radial_force=none"];
        let heat = [&["heat", "scene.toml", "--out", "out"], &RIGID[..], &no_radial].concat();
        let outcome = dir.raceway(&heat);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let cold = ["inner", "outer", "balls"].map(|body| format!("effects.temperature.{body}=\"20 degC\""));
        let mut run = [&["run", "scene.toml", "--out", "cold"], &RIGID[..], &no_radial].concat();
        cold.iter().for_each(|cold| run.extend(["--set", cold]));
        let outcome = dir.raceway(&run);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let shaft = Table::read(&dir, "cold/shaft.csv");
        let of = |name: &str| shaft.column(name)[0];
        let orbit = 0.5 * 65.0235e-3 * of("cage_speed_rad_per_s").abs();
        let drag = 18.0 * 0.5 * 25.0 * 0.5 * std::f64::consts::FRAC_PI_4 * 9e-3f64.powi(2) * orbit.powi(3);
        let power = of("friction_power_w") + drag;
        assert!(drag > 0.2 * power, "{ring}: {drag} of {power}");
        let found = heat_file(&dir, "out");
        assert_close(ring, number(&found, "/rounds/0/power_w"), power, 1e-3);
    }
}

/// Wrong: a balance could not have a housing of another material, which holds the outer ring otherwise as it warms up,
/// nor another reference. The last round beside a run of the scene at these temperatures.
#[test]
fn partners_of_a_balance_have_their_own_expansion() {
    let fit = "[effects.fit.outer]\ninterference = \"15 um\"\nhousing_diameter = \"160 mm\"\n\n[heat]\n\
               housing_expansion = \"23e-6 /K\"\nreference = \"15 degC\"";
    let text = HEAT
        .replace("[heat]", fit)
        .replace("outer_ambient = \"2 W/K\"", "outer_housing = \"2 W/K\"");
    let dir = scene(&text.replace(
        "[static]",
        "conductance.housing_ambient = \"0.5 W/K\"\n\n[static]",
    ));
    let clearance = |arguments: &[&str], out: &str| {
        let outcome = dir.raceway(&[arguments, &["scene.toml", "--out", out], &RIGID[..]].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    };
    clearance(&["heat"], "out");
    let found = heat_file(&dir, "out");
    let last = found["rounds"].as_array().unwrap().last().unwrap();
    let bodies = ["inner", "outer", "balls", "shaft", "housing"].iter().enumerate();
    let kelvin = |i: usize| last["temperatures_k"][i].as_f64().unwrap();
    let mut set: Vec<String> = bodies
        .map(|(i, body)| format!("effects.temperature.{body}=\"{:?} K\"", kelvin(i)))
        .collect();
    set.push("effects.temperature.housing_expansion=\"23e-6 /K\"".to_string());
    set.push("effects.temperature.reference=\"15 degC\"".to_string());
    let mut run = vec!["run"];
    set.iter().for_each(|set| run.extend(["--set", set]));
    clearance(&run, "warm");
    let summary = crate::util::tables::summary(&dir, "warm");
    assert_close(
        "clearance",
        last["radial_clearance_m"].as_f64().unwrap(),
        number(&summary, "/clearance/operating/radial_m"),
        1e-9,
    );
    refused(
        &dir,
        &["--set", "heat.housing_expansion=\"23 /K\""],
        2,
        "heat.housing_expansion is 23 /K; expected at most 1e-3 /K",
    );
}
