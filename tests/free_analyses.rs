//! Free balls in every analysis that knows them: sweeps and quasi-static runs roll as equilibria do.

use crate::util::lockstep::assert_same_run;
use crate::util::tables::{Table, summary};
use crate::util::{Dir, RIGID, assert_close, with_line};

const ROLLING: &str =
    "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n";
const COLUMNS: [&str; 4] = [
    "friction_torque_n_m",
    "outer_friction_torque_n_m",
    "friction_power_w",
    "cage_speed_rad_per_s",
];
/// Of Newton's iterations, which end at 1e-10 of the loads, and of warm starts.
const TOLERANCE: f64 = 1e-6;

/// Rigid rings with free balls and these tables in place of `[static]`.
fn rolling(dir: &Dir, name: &str, tables: &str) -> Table {
    dir.write(
        "scene.toml",
        with_line("[static]", "[static]", &format!("{ROLLING}{tables}")),
    );
    dir.run(name, &RIGID);
    Table::read(dir, &format!("{name}/shaft.csv"))
}

/// Fails unless every row has the friction of the equilibrium at its speed, rpm.
#[track_caller]
fn assert_equilibria(dir: &Dir, table: &Table, speeds: &[f64]) {
    let found = COLUMNS.map(|name| table.column(name));
    assert_eq!(found[0].len(), speeds.len());
    for (row, speed) in speeds.iter().enumerate() {
        let single = rolling(
            dir,
            &format!("at_{speed}"),
            &format!("[speed]\ninner = \"{speed} rpm\"\n\n[static]"),
        );
        for (name, values) in COLUMNS.iter().zip(&found) {
            assert_close(name, values[row], single.column(name)[0], TOLERANCE);
        }
    }
    let speed_up = found[3].windows(2).all(|pair| pair[1] > pair[0]);
    assert!(speed_up, "{:?}", found[3]);
}

/// Wrong: points of a sweep would keep the rolling of another speed.
#[test]
fn points_of_a_sweep_over_the_speed_roll_as_single_runs() {
    let dir = Dir::empty();
    let sweep = "[speed]\ninner = \"1000 rpm\"\n\n\
                 [sweep]\nkey = \"speed.inner\"\nvalues = [\"1000 rpm\", \"6000 rpm\", \"20000 rpm\"]";
    let table = rolling(&dir, "sweep", sweep);
    assert_equilibria(&dir, &table, &[1000.0, 6000.0, 20_000.0]);
}

/// Wrong: instants of a quasi-static run would roll at another time's speed. Under thrust alone it does not matter
/// where balls stand.
#[test]
fn instants_of_a_quasi_static_run_roll_as_equilibria() {
    let dir = Dir::empty();
    let ramp = "[speed.inner]\ntimes = [\"0 ms\", \"10 ms\"]\nvalues = [\"1000 rpm\", \"11000 rpm\"]\n\n\
                [quasi_static]\nduration = \"10 ms\"\nstep = \"5 ms\"";
    let table = rolling(&dir, "ramp", ramp);
    assert_equilibria(&dir, &table, &[1000.0, 6000.0, 11_000.0]);
}

/// Wrong: race control would pass for a law of rolling.
#[test]
fn outer_race_control_is_said_to_be_an_assumption() {
    let dir = Dir::with_scene(&with_line(
        "[static]",
        "[static]",
        "[speed]\ninner = \"1800 rpm\"\n\n[effects.ball_centrifugal]\n\n[static]",
    ));
    let part = "\"outer_control\" assumes that balls spin on the inner raceway alone";
    let controlled = ["--set", "speed.ball_speeds=outer_control"];
    for (name, sets, is_said) in [("with", &controlled[..], true), ("without", &[], false)] {
        let outcome = dir.raceway(&[&["run", "scene.toml", "--out", name], &RIGID[..], sets].concat());
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert_eq!(outcome.stderr.contains(part), is_said, "{}", outcome.stderr);
        let warnings = summary(&dir, name)["warnings"].to_string();
        assert_eq!(
            warnings.contains("assumes that balls spin"),
            is_said,
            "{warnings}"
        );
    }
}

/// Wrong: saying what is the default would change a bit.
#[test]
fn kinematic_balls_asked_for_are_those_of_no_table() {
    let moving = "[speed]\ninner = \"6000 rpm\"\n\n[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"";
    let dir = Dir::empty();
    for (name, table) in [
        ("without", ""),
        (
            "with",
            "[balls]\nmotion = \"kinematic\"\n\n[cage]\nmotion = \"kinematic\"\n\n",
        ),
    ] {
        dir.write(
            "scene.toml",
            with_line("[static]", "[static]", &format!("{table}{moving}")),
        );
        dir.run(name, &RIGID);
    }
    assert_same_run(&dir, "without", "with");
}

/// Wrong: a bearing without preload, whose balls on one side touch nothing, would not start, or its heat would fall.
#[test]
fn a_radial_force_alone_is_rolled_through() {
    let dir = Dir::empty();
    let cage = "[cage]\nmotion = \"free\"\nbore_diameter = \"62 mm\"\noutside_diameter = \"68.2 mm\"\n\
                width = \"14 mm\"\nmass = \"12 g\"\npocket_clearance = \"0.2 mm\"\n\
                pocket_stiffness = \"2e8 N/m^1.5\"\nguidance = \"outer_land\"\nguidance_clearance = \"0.3 mm\"\n\
                friction = 0.1\nrestitution = 0.6\n\n\
                [speed]\ninner = \"6000 rpm\"\n\n[dynamic]\nduration = \"2 ms\"\nstep = \"10 us\"";
    let scene = with_line("[static]", "[static]", &format!("{ROLLING}{cage}"));
    dir.write("scene.toml", scene);
    let loads = [
        "--set",
        "effects.axial_force.value=0 N",
        "--set",
        "effects.radial_force={ value = \"20 N\", direction = \"0 deg\" }",
        "--set",
        "shaft.mass=0.5 kg",
    ];
    dir.run("out", &[&RIGID[..], &loads].concat());
    let [balls, energy] = ["balls", "energy"].map(|name| Table::read(&dir, &format!("out/{name}.csv")));
    let forces = balls.column("inner_force_n");
    let last = &forces[forces.len() - 18..];
    assert!(last.iter().any(|q| *q > 1.0) && last.contains(&0.0), "{last:?}");
    let heat = energy.column("friction_loss_j");
    assert!(heat.windows(2).all(|pair| pair[1] >= pair[0]) && heat[heat.len() - 1] > 0.0);
}

/// Wrong: a bearing would have no equilibrium because some of its balls are hardly loaded: there the gyroscopic moment
/// is far more than friction can carry, and a ball comes to roll from softer creep by small steps alone. The power
/// follows the speed as of well loaded balls, whose friction is Coulomb's.
#[test]
fn balls_that_carry_next_to_nothing_come_to_roll() {
    let dir = Dir::with_scene(SLACK);
    let power = |rpm: u32| {
        let speed = format!("speed.inner=\"{rpm} rpm\"");
        let out = format!("at_{rpm}");
        let run = dir.raceway(&["run", "scene.toml", "--out", &out, "--set", &speed]);
        assert_eq!(run.code, Some(0), "{rpm} rpm: {}", run.stderr);
        Table::read(&dir, &format!("{out}/shaft.csv")).column("friction_power_w")[0]
    };
    let [slow, fast] = [90, 100].map(power);
    assert_close("power", fast / slow, 100.0 / 90.0, 1e-3);
}

/// A 71908 with ceramic balls, of which a load across leaves some all but free.
const SLACK: &str = r#"
[bearing]
bore_diameter = "40 mm"
outside_diameter = "62 mm"
width = "12 mm"
balls = 20
ball_diameter = "6.35 mm"
pitch_diameter = "51 mm"
contact_angle = "25 deg"
inner_groove_radius = "3.28 mm"
outer_groove_radius = "3.34 mm"

[materials.rings]
young_modulus = "208 GPa"
poisson_ratio = 0.29
density = "7830 kg/m3"

[materials.balls]
young_modulus = "310 GPa"
poisson_ratio = 0.26
density = "3200 kg/m3"

[contact]
mode = "rigid"

[inner]
flexible = false

[outer]
flexible = false

[shaft]
x = "free"
y = "free"
z = "free"
tilt_x = "locked"
tilt_y = "locked"
load_point = "0 mm"

[effects.axial_force]
value = "600 N"

[effects.radial_force]
value = "1200 N"
direction = "30 deg"

[speed]
inner = "100 rpm"

[balls]
motion = "free"

[effects.traction]
law = "coulomb"
friction = 0.02

[static]
"#;
