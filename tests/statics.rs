//! Static equilibria through the whole program: balance of forces, the same numbers however the run is asked for, and
//! what happens when there is no equilibrium.

use std::sync::OnceLock;

use mesh::{MshFormat, RingSide};
use serde_json::Value;

use crate::util::rings::{self, COARSE};
use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, Files, RIGID, SCENE, assert_close, assert_within, with_line};

/// Loads of the tests' scene, N.
const AXIAL: f64 = 2000.0;
const RADIAL: f64 = 1000.0;

/// Radius of the circle of the inner groove's centres: half of 56.01 mm and 4.65 mm, m.
const INNER_LEVER: f64 = 32.655e-3;

/// Contact forces settle to 1e-10 of the largest (`solver.tolerance`); sums over 18 balls and Newton's own residual
/// take another digit.
const BALANCE: f64 = 1e-9;

/// A folder where the tests' scene was solved on the coarse meshes; solved once for all tests that look at it.
pub fn reference() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        dir.run("out", &[]);
        dir.snapshot()
    }))
}

/// Sum over the balls of the force between ball and ring: [x, y, z], N, on the inner ring with the sign of what the
/// balls take from it; and its moment about x and y, N m, with the lever of the groove centres at these tilts, rad.
fn resultant(balls: &Table, side: &str, at: [f64; 4]) -> ([f64; 3], [f64; 2]) {
    let force = balls.column(&format!("{side}_force_n"));
    let angle = balls.column(&format!("{side}_contact_angle_rad"));
    let azimuth = balls.column("azimuth_rad");
    // Without the column balls see the point of the circle at their own azimuth.
    let (across, at) = match side == "inner" && balls.has("inner_across_n") {
        true => (balls.column("inner_across_n"), at),
        false => (vec![0.0; force.len()], [0.0, 0.0, at[2], at[3]]),
    };
    let (mut sum, mut moment) = ([0.0; 3], [0.0; 2]);
    for i in 0..force.len() {
        let ((sin_a, cos_a), (sin, cos)) = (angle[i].sin_cos(), azimuth[i].sin_cos());
        let (radial, axial) = (force[i] * cos_a, force[i] * sin_a);
        let along = [radial * cos - across[i] * sin, radial * sin + across[i] * cos];
        sum[0] += along[0];
        sum[1] += along[1];
        sum[2] += axial;
        let lever = crossing(azimuth[i], at);
        moment[0] += lever[1] * axial - lever[2] * along[1];
        moment[1] += lever[2] * along[0] - lever[0] * axial;
    }
    (sum, moment)
}

/// From the shaft's origin to where the circle of inner groove centres, which x, y and both tilts have moved, crosses
/// the plane of an azimuth, m.
fn crossing(azimuth: f64, [x, y, tilt_x, tilt_y]: [f64; 4]) -> [f64; 3] {
    let (sin, cos) = azimuth.sin_cos();
    let beside = |v: [f64; 3]| v[1] * cos - v[0] * sin;
    let lever =
        |angle: f64| turned([angle.cos(), angle.sin(), 0.0], [tilt_x, tilt_y]).map(|v| INNER_LEVER * v);
    let moves = x != 0.0 || y != 0.0;
    let mut angle = azimuth;
    for _ in 0..4 * usize::from(moves) {
        angle -= (beside([x, y, 0.0]) + beside(lever(angle))) / INNER_LEVER;
    }
    lever(angle)
}

/// A vector turned by the rotation vector [x, y, 0], to third order in it.
fn turned(v: [f64; 3], [x, y]: [f64; 2]) -> [f64; 3] {
    let cross = |a: [f64; 3]| [y * a[2], -x * a[2], x * a[1] - y * a[0]];
    let [once, twice, thrice] = [cross(v), cross(cross(v)), cross(cross(cross(v)))];
    [0, 1, 2].map(|i| v[i] + once[i] + twice[i] / 2.0 + thrice[i] / 6.0)
}

#[track_caller]
fn assert_balanced(balls: &Table, [x, y, z]: [f64; 3]) {
    let scale = x.hypot(y).hypot(z);
    for side in ["inner", "outer"] {
        let (sum, _) = resultant(balls, side, [0.0; 4]);
        for (sum, load) in sum.into_iter().zip([x, y, z]) {
            assert_within(side, sum, load, BALANCE * scale);
        }
    }
}

/// If this failed, a load would get lost between the shaft, the balls and the rings.
#[test]
fn ball_forces_balance_the_load() {
    let balls = Table::read(&reference(), "out/balls.csv");
    assert_eq!(balls.rows.len(), 18);
    assert_balanced(&balls, [RADIAL, 0.0, AXIAL]);
    let (inner, outer) = (balls.column("inner_force_n"), balls.column("outer_force_n"));
    for (i, o) in inner.iter().zip(&outer) {
        assert_within("a ball at rest", *i, *o, BALANCE * AXIAL);
    }
}

/// If this failed, the reaction of a locked tilt would not be the moment that the balls make.
#[test]
fn the_reaction_of_a_locked_tilt_balances_the_moment_of_the_balls() {
    let dir = reference();
    let (_, moment) = resultant(&Table::read(&dir, "out/balls.csv"), "inner", [0.0; 4]);
    let shaft = Table::read(&dir, "out/shaft.csv");
    let scale = AXIAL * INNER_LEVER;
    for (name, moment) in ["reaction_tilt_x_n_m", "reaction_tilt_y_n_m"]
        .into_iter()
        .zip(moment)
    {
        assert_within(name, shaft.column(name)[0], moment, BALANCE * scale);
    }
    assert!(
        moment[1].abs() > 0.01 * scale,
        "a radial force makes no moment: {moment:?}"
    );
}

/// If this failed, a usual support of the shaft or of the rings would not be solved, or not in balance.
#[test]
fn free_tilt_and_mean_motion_are_solved() {
    let dir = Dir::with_meshes();
    let free = ["--set", "shaft.tilt_x=free", "--set", "shaft.tilt_y=free"];
    let mean = [
        "--set",
        "inner.support=mean_motion",
        "--set",
        "outer.support=mean_motion",
    ];
    let no_stress = ["--set", "output.stress=none"];
    for (out, set) in [
        ("free", &free[..]),
        ("mean", &mean),
        ("both", &[free, mean].concat()),
    ] {
        dir.run(out, &[set, &no_stress].concat());
        let balls = Table::read(&dir, &format!("{out}/balls.csv"));
        assert_balanced(&balls, [RADIAL, 0.0, AXIAL]);
        assert!(!balls.has("inner_across_n"));
        if out != "mean" {
            let shaft = Table::read(&dir, &format!("{out}/shaft.csv"));
            let at = ["x_m", "y_m", "tilt_x_rad", "tilt_y_rad"].map(|name| shaft.column(name)[0]);
            let (_, moment) = resultant(&balls, "inner", at);
            moment
                .iter()
                .for_each(|m| assert_within("moment", *m, 0.0, BALANCE * AXIAL * INNER_LEVER));
        }
    }
}

/// If this failed, forces of the inner ring would not balance where balls see its groove as a torus, or the table not
/// say what the cage holds.
#[test]
fn a_torus_is_in_balance_with_the_force_across() {
    let dir = Dir::with_meshes();
    let set = [
        "--set",
        "shaft.tilt_x=free",
        "--set",
        "shaft.tilt_y=free",
        "--set",
        "contact.groove_circle=exact",
        "--set",
        "output.stress=none",
    ];
    dir.run("torus", &set);
    let (balls, shaft) = (
        Table::read(&dir, "torus/balls.csv"),
        Table::read(&dir, "torus/shaft.csv"),
    );
    let at = ["x_m", "y_m", "tilt_x_rad", "tilt_y_rad"].map(|name| shaft.column(name)[0]);
    let (sum, moment) = resultant(&balls, "inner", at);
    for (sum, load) in sum.into_iter().zip([RADIAL, 0.0, AXIAL]) {
        assert_within("inner", sum, load, BALANCE * AXIAL);
    }
    for m in moment {
        assert_within("moment", m, 0.0, BALANCE * AXIAL * INNER_LEVER);
    }
    assert!(balls.column("inner_across_n").iter().any(|n| n.abs() > 0.01));
}

/// If this failed, `--set` would solve something else than the scene with that value written into it.
#[test]
fn an_override_solves_the_scene_with_that_value() {
    let dir = Dir::with_meshes();
    dir.run("set", &["--set", "effects.axial_force.value=3 kN"]);
    dir.write(
        "scene.toml",
        with_line("[effects.axial_force]", "value", "value = \"3 kN\""),
    );
    dir.run("edited", &[]);
    for name in ["balls.csv", "shaft.csv", "energy.csv"] {
        assert_eq!(
            dir.text(&format!("set/{name}")),
            dir.text(&format!("edited/{name}")),
            "{name}"
        );
    }
    assert_balanced(&Table::read(&dir, "set/balls.csv"), [RADIAL, 0.0, 3000.0]);
}

/// If this failed, the unit of a mesh file would change the answer.
#[test]
fn a_mesh_in_metres_gives_the_numbers_of_one_in_millimetres() {
    let dir = Dir::with_scene(&SCENE.replace("mesh_unit = \"mm\"", "mesh_unit = \"m\""));
    for (name, side) in [("inner.msh", RingSide::Inner), ("outer.msh", RingSide::Outer)] {
        dir.write(
            name,
            rings::file(&rings::ring(side, COARSE), 1.0, MshFormat::Ascii),
        );
    }
    dir.run("out", &[]);
    let (m, mm) = (
        Table::read(&dir, "out/balls.csv"),
        Table::read(&reference(), "out/balls.csv"),
    );
    // Coordinates differ by their last bit; the condition of the rings' stiffness takes up to six digits.
    for name in [
        "inner_force_n",
        "outer_force_n",
        "inner_contact_angle_rad",
        "outer_peak_pressure_pa",
    ] {
        for (a, b) in m.column(name).iter().zip(mm.column(name)) {
            assert_close(name, *a, b, 1e-9);
        }
    }
    let (m, mm) = (summary(&dir, "out"), summary(&reference(), "out"));
    for pointer in [
        "/shaft/displacement_m/0",
        "/shaft/displacement_m/2",
        "/energy_j/strain",
        "/energy_j/hertz",
    ] {
        assert_close(pointer, number(&m, pointer), number(&mm, pointer), 1e-9);
    }
}

/// If this failed, the answer would depend on the machine it is computed on, and no result could be reproduced.
#[test]
fn one_and_two_threads_give_the_same_bits() {
    let dir = Dir::with_meshes();
    dir.run("one", &["--threads", "1"]);
    dir.run("two", &["--threads", "2"]);
    let names = [
        "balls.csv",
        "shaft.csv",
        "energy.csv",
        "mesh.hdf",
        "step_000000.hdf",
        "run.vtkhdf",
        "run.hdf.series",
    ];
    for name in names {
        let bytes = |out: &str| std::fs::read(dir.path(&format!("{out}/{name}"))).unwrap();
        assert!(bytes("one") == bytes("two"), "{name} differs");
    }
    let physics = |out: &str| {
        let mut all = summary(&dir, out);
        let keys = all.as_object_mut().unwrap();
        for key in ["timing_s", "peak_memory_bytes", "peak_memory_forecast_bytes"] {
            keys.remove(key).unwrap();
        }
        all
    };
    assert_eq!(physics("one"), physics("two"));
}

/// If this failed, driving the shaft to a place and loading it until it is there would be two different models.
#[test]
fn a_prescribed_displacement_has_the_load_as_its_reaction() {
    let loaded = summary(&reference(), "out");
    let at = |i: usize| format!("{:e} m", number(&loaded, &format!("/shaft/displacement_m/{i}")));
    let dir = Dir::with_meshes();
    let set = ["x", "y", "z"]
        .into_iter()
        .enumerate()
        .map(|(i, axis)| format!("shaft.{axis}={}", at(i)));
    let mut arguments: Vec<String> = set.flat_map(|s| ["--set".to_string(), s]).collect();
    for force in ["axial_force", "radial_force"] {
        arguments.extend(["--set".to_string(), format!("effects.{force}.value=0 N")]);
    }
    dir.run("out", &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let driven = summary(&dir, "out");
    for (i, load) in [RADIAL, 0.0, AXIAL].into_iter().enumerate() {
        let reaction = number(&driven, &format!("/shaft/reaction_force_n/{i}"));
        // Both runs settle to 1e-10 of the largest ball force; the contact's stiffness carries that over.
        assert_within("reaction", reaction, load, 1e-8 * AXIAL);
    }
    let force = |s: &Value| number(s, "/balls/0/inner/force_n");
    assert_close("force of the first ball", force(&driven), force(&loaded), 1e-8);
}

/// If this failed, the rigid limit would read meshes, cost something, or not balance its loads.
#[test]
fn rigid_rings_need_no_mesh_and_no_time() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    assert_balanced(&Table::read(&dir, "out/balls.csv"), [RADIAL, 0.0, AXIAL]);
    let summary = summary(&dir, "out");
    assert_eq!(
        (number(&summary, "/dofs/inner"), number(&summary, "/dofs/outer")),
        (0.0, 0.0)
    );
    assert_eq!(number(&summary, "/energy_j/strain"), 0.0);
    // Measured: 0.02 s, most of it writing.
    let seconds = number(&summary, "/timing_s/total");
    assert!(seconds < 2.0, "{seconds} s");
}

/// If this failed, the two sides of the grooves would not be alike, or a bearing pushed backwards would be refused.
#[test]
fn a_reversed_thrust_mirrors_the_contacts() {
    let dir = Dir::with_scene(SCENE);
    let reversed = ["--set", "effects.axial_force.value=-2 kN"];
    dir.run("forwards", &RIGID);
    dir.run("backwards", &[&RIGID[..], &reversed].concat());
    let [forwards, backwards] =
        ["forwards", "backwards"].map(|out| Table::read(&dir, &format!("{out}/balls.csv")));
    // Both converge to 1e-10 of the loads from different starts.
    for (a, b) in forwards
        .column("inner_force_n")
        .iter()
        .zip(backwards.column("inner_force_n"))
    {
        assert_within("force", *a, b, BALANCE * AXIAL);
    }
    for (a, b) in forwards
        .column("inner_contact_angle_rad")
        .iter()
        .zip(backwards.column("inner_contact_angle_rad"))
    {
        assert_within("angle", *a, -b, BALANCE);
    }
}

/// If this failed, a load that no bearing carries would give numbers, or files that look like results.
#[test]
fn a_load_without_equilibrium_ends_with_code_3_and_no_files() {
    let dir = Dir::with_meshes();
    for set in [&RIGID[..], &[]] {
        let before = dir.snapshot();
        let load = [
            "run",
            "scene.toml",
            "--out",
            "out",
            "--set",
            "effects.axial_force.value=1e9 N",
        ];
        let outcome = dir.raceway(&[&load, set].concat());
        assert_eq!(outcome.code, Some(3), "{}", outcome.stderr);
        let message = "error: no equilibrium: z of the shaft runs beyond 4.500 mm; the loads push the inner ring off \
                       the \
                       balls or a free direction is not held; lock it, add preload or reduce the load";
        assert!(outcome.stderr.contains(message), "{}", outcome.stderr);
        assert_eq!(outcome.stdout, "");
        assert!(dir.snapshot() == before, "files were made");
    }
}

/// If this failed, one would have to run a scene to learn how large it is.
#[test]
fn check_prints_the_sizes_and_leaves_no_files() {
    let dir = Dir::with_meshes();
    let before = dir.snapshot();
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let mesh = rings::ring(RingSide::Inner, COARSE);
    let parts = [
        "scene    7010C under test".to_string(),
        "analysis static".to_string(),
        "effects  axial_force, radial_force".to_string(),
        "bearing  18 balls, clearance 0.0270 mm, groove distance 0.4000 mm, free contact angle 14.9"
            .to_string(),
        format!(
            "inner    {} hex8, {} nodes, {} dofs; Hertz",
            mesh.n_elements(),
            mesh.n_nodes(),
            mesh.n_dofs()
        ),
        format!(
            "outer    {} hex8, {} nodes, {} dofs; Hertz",
            mesh.n_elements(),
            mesh.n_nodes(),
            mesh.n_dofs()
        ),
        "factor ".to_string(),
        "output   about ".to_string(),
    ];
    for part in parts {
        assert!(
            outcome.stdout.contains(&part),
            "expected\n{part}\nin\n{}",
            outcome.stdout
        );
    }
    assert!(dir.snapshot() == before, "files were made");
}

/// Wrong: a shaft that is locked at 0 would be taken for one in the middle of its play: a deep groove bearing has
/// contact angles then. The 7010C has grooves 0.4 mm apart and a free contact angle of 14.93 deg.
#[test]
fn a_shaft_locked_at_zero_is_told_where_the_middle_is() {
    let dir = Dir::with_scene(SCENE);
    let check = [&["check", "scene.toml"], &RIGID[..], &["--set", "shaft.z=locked"]].concat();
    let outcome = dir.raceway(&check);
    let part = "advice   shaft.z is held at 0, where all balls just touch at the free contact angle of 14.93 \
                deg; with the grooves opposite each other, as in a deep groove bearing without thrust, it is \
                shaft.z = \"-103.";
    assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
    let zero = [&check[..check.len() - 1], &["shaft.z=0 mm"]].concat();
    let outcome = dir.raceway(&zero);
    assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
    let outcome = dir.raceway(&check[..check.len() - 2]);
    assert!(!outcome.stdout.contains("shaft.z is"), "{}", outcome.stdout);
    // Without clearance the grooves are opposite each other, up to round-off.
    let tight = "bearing.outer_raceway_diameter=74.01 mm";
    let outcome = dir.raceway(&[&check[..], &["--set", tight]].concat());
    assert!(
        outcome.stdout.contains("free contact angle 0."),
        "{}",
        outcome.stdout
    );
    assert!(!outcome.stdout.contains("shaft.z is"), "{}", outcome.stdout);
}

/// Wrong: an angular contact bearing without thrust would come apart, and nobody would say why contact angles are 0.
#[test]
fn a_bearing_that_only_a_radial_force_loads_is_told_that_it_comes_apart() {
    let dir = Dir::with_scene(SCENE);
    let check = |more: &[&str]| {
        let check = [
            &["check", "scene.toml"],
            &RIGID[..],
            &["--set", "shaft.z=free"],
            more,
        ]
        .concat();
        dir.raceway(&check).stdout
    };
    let radial = [
        "--set",
        "effects.radial_force={ value=\"1 kN\", direction=\"0 deg\" }",
    ];
    let alone = [&radial[..], &["--set", "effects.axial_force=none"]].concat();
    let part = "advice   shaft.z is \"free\" and no load acts along the axis: from the free contact angle of 14.93 deg \
                the radial force drives the rings apart until contact angles are about 0; an angular contact bearing \
                needs [effects.axial_force], [effects.spring_preload] or a shaft.z that is held";
    let said = check(&alone);
    assert!(said.contains(part), "{said}");
    let said = check(&radial);
    assert!(!said.contains("no load acts"), "{said}");
}
