//! Lists of bearings in equilibria over time, and their unbalance, through the whole program.

use std::f64::consts::TAU;

use crate::several::{PAIR, flexible_pair, pair, succeeds};
use crate::util::Dir;
use crate::util::tables::{Table, number, summary};
use crate::util::{assert_close, assert_within};

/// A load across that grows, weight, a speed that changes, an unbalance off the bearings.
const TURNING: &str = "[speed]\ninner = { times = [\"0 ms\", \"3 ms\"], values = [\"1800 rpm\", \"6000 rpm\"] }\n\
                       [effects.radial_force]\nvalue = \"2 kN\"\ndirection = \"30 deg\"\n\
                       [effects.radial_force.schedule.impact]\nstart = \"1 ms\"\nduration = \"4 ms\"\n\
                       [effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0, -1, 0]\n\
                       [effects.ball_centrifugal]\n\
                       [effects.unbalance]\nmass = \"10 g\"\neccentricity = \"5 mm\"\nposition = \"20 mm\"\n";

fn quasi_static(more: &str) -> String {
    format!("{TURNING}{more}[quasi_static]\nduration = \"5 ms\"\nstep = \"0.25 ms\"\noutput_every = 5\n")
}

const TABLES: [&str; 7] = [
    "balls.csv",
    "bearings.csv",
    "shaft.csv",
    "front/balls.csv",
    "front/energy.csv",
    "rear/shaft.csv",
    "rear/step_000020.hdf",
];

fn bytes(dir: &Dir, out: &str, name: &str) -> Vec<u8> {
    std::fs::read(dir.path(&format!("{out}/{name}"))).unwrap()
}

/// Wrong: instants would lack rows or files, forces not balance the loads of their time, or a run that goes on have
/// other bits than one that was never stopped. Loads along x: 300 N, the share of the impact, the unbalance m e
/// Omega^2.
#[test]
fn a_pair_turns_in_equilibrium_and_a_resumed_one_has_the_same_bits() {
    let dir = pair(&quasi_static(""));
    let checked = succeeds(&dir, &["check", "pair.toml"]);
    let what = "analysis quasi-static: 20 steps of 0.00025 s, a step file of each bearing every 5";
    assert!(checked.stdout.contains(what), "{}", checked.stdout);
    let said = succeeds(&dir, &["run", "pair.toml", "--out", "whole"]);
    assert!(said.stdout.contains("20 steps of 0.00025 s"), "{}", said.stdout);
    let found = summary(&dir, "whole");
    assert_eq!(found["analysis"], "quasi_static");
    let table = dir.text("whole/bearings.csv");
    let column = |name: &str| {
        table
            .lines()
            .next()
            .unwrap()
            .split(',')
            .position(|n| n == name)
            .unwrap()
    };
    let (time, force) = (column("time_s"), column("force_x_n"));
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 2 * 21);
    for both in rows.chunks(2) {
        let cell = |row: &[&str], column: usize| row[column].parse::<f64>().unwrap();
        let t = cell(&both[0], time);
        let rpm = 1800.0 + 4200.0 * (t / 3e-3).min(1.0);
        let (speed, rate) = (
            rpm * TAU / 60.0,
            if t < 3e-3 { 4200.0 / 3e-3 * TAU / 60.0 } else { 0.0 },
        );
        let angle = match t < 3e-3 {
            true => (1800.0 * t + 0.5 * 4200.0 / 3e-3 * t * t) * TAU / 60.0,
            false => (3900.0 * 3e-3 + 6000.0 * (t - 3e-3)) * TAU / 60.0,
        };
        let unbalance = 5e-5 * (speed * speed * angle.cos() + rate * angle.sin());
        let share = ((t - 1e-3) / 4e-3).clamp(0.0, 1.0);
        let impact = 2000.0 * (0.5 * TAU * share).sin() * (TAU / 12.0).cos();
        // At the corner of the speed its rate is that of either side.
        if (t - 3e-3).abs() > 1e-9 {
            let sum = cell(&both[0], force) + cell(&both[1], force);
            assert_within("x", sum, -(300.0 + impact + unbalance), 1e-5);
        }
    }
    succeeds(&dir, &["plot", "whole"]);
    succeeds(&dir, &["report", "whole"]);
    tells_of_the_list(&dir);
    succeeds(&dir, &["run", "pair.toml", "--out", "half"]);
    let refused = dir.raceway(&["resume", "half", "--step", "7"]);
    let expected = "has no step 7 with a restart state of all bearings; there are 0, 5, 10, 15, 20";
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    let said = succeeds(&dir, &["resume", "half", "--step", "10"]);
    assert!(said.stdout.contains("10 steps of 0.00025 s"), "{}", said.stdout);
    for name in TABLES {
        assert!(bytes(&dir, "whole", name) == bytes(&dir, "half", name), "{name}");
    }
    let [whole, half] = ["whole", "half"].map(|out| summary(&dir, out));
    assert_eq!(whole["iterations"], half["iterations"]);
    let log = dir.text("half/run.log");
    assert!(log.contains("resuming half after step 10 of 20"), "{log}");
    assert!(
        !dir.path("half/front/run.log").exists(),
        "the log is that of the list"
    );
    let again = succeeds(&dir, &["resume", "half"]);
    let expected = "nothing to do: half has finished with step 20 of 20; a longer duration goes on from there, --set \
                    quasi_static.duration=...";
    assert!(again.stdout.contains(expected), "{}", again.stdout);
    succeeds(
        &dir,
        &["resume", "half", "--set", "quasi_static.duration=\"5.5 ms\""],
    );
    assert_eq!(Table::read(&dir, "half/front/shaft.csv").rows.len(), 23);
}

/// What `raceway info` says of the folder `whole` of a list, and of one that lacks a bearing.
fn tells_of_the_list(dir: &Dir) {
    let told = succeeds(dir, &["info", "whole", "--verify"]).stdout;
    for part in [
        "analysis   quasi_static",
        "shaft      beam, results from 0.000 to 200.000 mm",
        "bearing    rear of types/kind.toml at 130.000 mm, -z: pushes the shaft by ",
        "folder     whole/front",
        "steps      5 from 0 to 20, t = 0.0 s to 0.005 s",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    let answer = succeeds(dir, &["info", "whole", "--json", "--quiet"]).stdout;
    let found: serde_json::Value = serde_json::from_str(&answer).unwrap();
    assert_eq!(found["steps"], serde_json::json!([0, 5, 10, 15, 20]));
    assert_eq!(found["summary"]["analysis"], "quasi_static");
    std::fs::rename(dir.path("whole/rear"), dir.path("rear")).unwrap();
    let refused = dir.raceway(&["info", "whole"]);
    assert_eq!(refused.code, Some(2));
    let part = "damaged    the folder whole/rear of a bearing is not there";
    assert!(refused.stdout.contains(part), "{}", refused.stdout);
    std::fs::rename(dir.path("rear"), dir.path("whole/rear")).unwrap();
}

/// Wrong: elastic rings would not go on to the same bits, from one thread to two, with what is found of the whole run.
#[test]
fn elastic_rings_go_on_to_the_same_bits_too() {
    let dir = flexible_pair(&quasi_static("[output.reduction]\n"));
    succeeds(&dir, &["run", "pair.toml", "--out", "whole", "--threads", "1"]);
    succeeds(&dir, &["run", "pair.toml", "--out", "half", "--threads", "2"]);
    succeeds(&dir, &["resume", "half", "--step", "5"]);
    for name in TABLES {
        assert!(bytes(&dir, "whole", name) == bytes(&dir, "half", name), "{name}");
    }
}

/// The scene of one bearing with a free shaft, as a list that is no plain one or by itself; the shaft has its load
/// along it, or as an effect.
fn one_bearing(analysis: &str) -> Dir {
    let dir = pair("[static]");
    let shaft = "[shaft]\nx = \"free\"\ny = \"free\"\nz = \"free\"\ntilt_x = \"free\"\ntilt_y = \"free\"\n\
                 mass = \"3 kg\"\ntransverse_inertia = \"4e-3 kg m2\"\npolar_inertia = \"3e-3 kg m2\"\n";
    let common = format!(
        "{analysis}\n[effects.axial_force]\nvalue = \"1500 N\"\n[effects.gravity]\nacceleration = \"9.81 m/s2\"\n\
         direction = [0, -1, 0]\n[effects.unbalance]\nmass = \"1 g\"\neccentricity = \"5 mm\"\nposition = \"20 mm\"\n\
         angle = \"40 deg\"\n"
    );
    let kind = dir.text("types/kind.toml");
    let load = "[effects.radial_force]\nvalue = \"60 N\"\ndirection = \"0 deg\"\n";
    dir.write(
        "single.toml",
        format!("{kind}\n{shaft}load_point = \"0 mm\"\n{common}{load}"),
    );
    let bearing = "[[bearing]]\nname = \"front\"\nposition = \"0 mm\"\norientation = \"+z\"\n\
                   type = \"types/kind.toml\"\n";
    let along = "[[shaft.load]]\nposition = \"0 mm\"\nforce = [\"60 N\", \"0 N\", \"0 N\"]\n";
    dir.write(
        "list.toml",
        format!("{bearing}\n{shaft}model = \"rigid\"\n{along}{common}"),
    );
    succeeds(&dir, &["run", "single.toml", "--out", "single"]);
    succeeds(&dir, &["run", "list.toml", "--out", "list"]);
    dir
}

fn assert_same_shaft(dir: &Dir) {
    let single = Table::read(dir, "single/shaft.csv");
    let list = Table::read(dir, "list/shaft.csv");
    let own = Table::read(dir, "list/front/shaft.csv");
    assert_eq!(single.rows.len(), list.rows.len());
    for (name, size) in [("x", 0), ("y", 0), ("z", 0), ("tilt_x", 1), ("tilt_y", 1)] {
        let unit = ["m", "rad"][size];
        let largest = |axes: [&str; 2]| {
            let all = axes
                .iter()
                .flat_map(|axis| single.column(&format!("{axis}_{unit}")));
            all.fold(0.0f64, |most, x| most.max(x.abs()))
        };
        let largest = largest([["x", "z"], ["tilt_x", "tilt_y"]][size]);
        let name = format!("{name}_{unit}");
        let expected = single.column(&name);
        for table in [&list, &own] {
            for (found, expected) in table.column(&name).iter().zip(&expected) {
                assert_within(&name, *found, *expected, 1e-9 * largest);
            }
        }
    }
}

/// Wrong: a list of one bearing would turn, or feel an unbalance, otherwise than the scene of that bearing. Two
/// programs of one equilibrium or step, whose residuals end at 1e-10 of the forces. Loads across are small: levers of a
/// list do not change as the shaft tilts, which is of the order of the tilt squared.
#[test]
fn a_list_of_one_bearing_is_the_scene_of_that_bearing() {
    let turning = "[speed]\ninner = { times = [\"0 ms\", \"2 ms\"], values = [\"3000 rpm\", \"9000 rpm\"] }\n\
                   [effects.ball_centrifugal]\n";
    let dir = one_bearing(&format!(
        "{turning}[quasi_static]\nduration = \"4 ms\"\nstep = \"0.2 ms\"\n"
    ));
    assert_same_shaft(&dir);
    let [single, list] = ["single", "list/front"].map(|out| Table::read(&dir, &format!("{out}/balls.csv")));
    for name in ["azimuth_rad", "spin_rad_per_s"] {
        assert!(single.column(name) == list.column(name), "{name}");
    }
    let dir = one_bearing(&format!(
        "{turning}[dynamic]\nduration = \"1 ms\"\nstep = \"10 us\"\noutput_every = 50\n"
    ));
    assert_same_shaft(&dir);
    assert!(number(&summary(&dir, "list"), "/residual") < 1e-9);
}

/// Wrong: balls of a bearing would go round with the cage of another. Two bearings of other balls on one shaft: each
/// cage turns by (1 - gamma) / 2 of it, gamma = D_w cos(alpha) / D_pw (Harris), the pitch circle to 1e-3.
#[test]
fn every_bearing_has_its_own_cage() {
    let text = PAIR.replace(
        "orientation = \"-z\"\ntype = \"types/kind.toml\"",
        "orientation = \"-z\"\ntype = \"types/few.toml\"",
    );
    let dir = pair("[static]");
    let mut few = dir.text("types/kind.toml");
    for (key, from, to) in [
        ("balls", "18", "14"),
        ("ball_diameter", "\"9 mm\"", "\"10 mm\""),
        ("inner_raceway_diameter", "\"56.01 mm\"", "\"55.01 mm\""),
        ("outer_raceway_diameter", "\"74.037 mm\"", "\"75.037 mm\""),
        ("inner_groove_radius", "\"4.65 mm\"", "\"5.16 mm\""),
        ("outer_groove_radius", "\"4.75 mm\"", "\"5.27 mm\""),
    ] {
        let old = format!("{key} = {from}");
        assert!(few.contains(&old), "{old}");
        few = few.replace(&old, &format!("{key} = {to}"));
    }
    dir.write("types/few.toml", few);
    dir.write(
        "two.toml",
        format!(
            "{text}\n[speed]\ninner = \"3000 rpm\"\n[quasi_static]\nduration = \"3 ms\"\nstep = \"1 ms\"\n"
        ),
    );
    succeeds(&dir, &["run", "two.toml", "--out", "out"]);
    for (name, sign, ball, pitch, radii) in [
        ("front", 1.0, 9.0, 65.0235, 9.4),
        ("rear", -1.0, 10.0, 65.0235, 10.43),
    ] {
        let table = Table::read(&dir, &format!("out/{name}/balls.csv"));
        let azimuth = |step: usize| table.step(step).column("azimuth_rad")[5];
        let gamma = ball / pitch * (1.0 - 0.027 / (2.0 * (radii - ball)));
        let expected = 0.5 * (1.0 - gamma) * 3000.0 * TAU / 60.0 * 3e-3;
        assert_close(name, sign * (azimuth(3) - azimuth(0)), expected, 1e-3);
    }
}

/// The stiffness of the shaft at rest, N/m, `[5][5]`, where the first load along it acts.
fn stiffness(dir: &Dir, scene: &str) -> Vec<f64> {
    succeeds(dir, &["stiffness", scene, "--out", "stiffness"]);
    let text = dir.text("stiffness/stiffness.csv");
    let row = text.lines().nth(1).unwrap();
    let cells = row.split(',').skip(3).take(25);
    cells.map(|cell| cell.parse().unwrap()).collect()
}

/// Wrong: the unbalance would act elsewhere than where it is, or with another force. Without inertia a beam gives by
/// K^-1 m e Omega^2 that turns with the shaft; contacts that stiffen leave 1e-3.
#[test]
fn an_unbalance_bends_the_shaft_by_its_stiffness() {
    let with = |more: &str| {
        format!(
            "[speed]\ninner = \"6000 rpm\"\n{more}[quasi_static]\nduration = \"10 ms\"\nstep = \"1 ms\"\n"
        )
    };
    let dir = pair(&with(""));
    let unbalance = "[effects.unbalance]\nmass = \"2 g\"\neccentricity = \"10 mm\"\nangle = \"20 deg\"\n\
                     position = \"0 mm\"\n";
    dir.write("off.toml", format!("{PAIR}\n{}", with(unbalance)));
    let mut compliance = vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    dense::DenseLu::factor(5, &stiffness(&dir, "pair.toml"))
        .unwrap()
        .solve(&mut compliance, 2);
    succeeds(&dir, &["run", "pair.toml", "--out", "none"]);
    succeeds(&dir, &["run", "off.toml", "--out", "off"]);
    let [none, off] = ["none", "off"].map(|out| Table::read(&dir, &format!("{out}/shaft.csv")));
    let omega = 6000.0 * TAU / 60.0;
    let force = 2e-5 * omega * omega;
    for step in 0..=10 {
        let angle = 20f64.to_radians() + omega * 1e-3 * step as f64;
        for (axis, name) in ["x_m", "y_m"].iter().enumerate() {
            let at = |table: &Table| table.step(step).column(name)[0];
            let expected = force * (angle.cos() * compliance[axis] + angle.sin() * compliance[5 + axis]);
            let largest = force * compliance[0];
            assert_within(name, at(&off) - at(&none), expected, 2e-3 * largest);
        }
    }
}

/// Wrong: a rotor on a list of bearings would not whirl as it should. A rigid rotor of mass M in the middle of a
/// symmetric pair, without damping, below its resonance: the part of its motion that turns with it is m e Omega^2 over
/// k - M Omega^2 (Jeffcott, e.g. Genta 2005, ch. 2); what swings freely is fitted beside. Balls and steps leave 1e-2 of
/// the gain, which is a tenth.
#[test]
fn a_rotor_below_its_resonance_whirls_with_the_gain_of_jeffcott() {
    let shaft = "[shaft]\nmodel = \"rigid\"\nx = \"free\"\ny = \"free\"\nz = \"free\"\ntilt_x = \"free\"\n\
                 tilt_y = \"free\"\nmass = \"20 kg\"\ntransverse_inertia = \"0.2 kg m2\"\n\
                 polar_inertia = \"0.05 kg m2\"\n";
    let (head, _) = PAIR.split_once("[shaft]").unwrap();
    let head = head.replace("60 mm", "-30 mm").replace("130 mm", "30 mm");
    let rotor = format!(
        "{head}{shaft}[speed]\ninner = \"12000 rpm\"\n[effects.unbalance]\nmass = \"1 g\"\neccentricity = \"10 mm\"\n\
         [dynamic]\nduration = \"20 ms\"\nstep = \"20 us\"\noutput_every = 1000\n"
    );
    let dir = pair("[static]");
    dir.write("rotor.toml", rotor);
    let k = stiffness(&dir, "rotor.toml");
    let (omega, mass) = (12000.0 * TAU / 60.0, 20.0);
    let free = (k[0] / mass).sqrt();
    succeeds(&dir, &["run", "rotor.toml", "--out", "out"]);
    assert!(number(&summary(&dir, "out"), "/residual") < 1e-9);
    let table = Table::read(&dir, "out/shaft.csv");
    let row = |t: f64| {
        let ((a, b), (c, d)) = ((omega * t).sin_cos(), (free * t).sin_cos());
        [b, a, d, c, 1.0]
    };
    let (mut matrix, mut right) = (vec![0.0; 25], vec![0.0; 10]);
    let at_nose = |name: &str| -> Vec<f64> {
        let rows = table.column("position_m").into_iter().zip(table.column(name));
        rows.filter(|(z, _)| *z == 0.0).map(|(_, q)| q).collect()
    };
    let (x, y) = (at_nose("x_m"), at_nose("y_m"));
    assert_eq!(x.len(), 1001);
    for (n, (x, y)) in x.iter().zip(&y).enumerate() {
        let row = row(20e-6 * n as f64);
        for i in 0..5 {
            (0..5).for_each(|j| matrix[5 * i + j] += row[i] * row[j]);
            right[i] += row[i] * x;
            right[5 + i] += row[i] * y;
        }
    }
    dense::DenseLu::factor(5, &matrix).unwrap().solve(&mut right, 2);
    let force = 1e-5 * omega * omega;
    let expected = force / (k[0] - mass * omega * omega);
    let gain = expected * k[0] / force;
    assert!((1.08..1.2).contains(&gain), "{gain}");
    println!("{right:?} {expected:e} {gain}");
    assert_close("x in phase", right[0], expected, 1e-3 * 10.0 * (gain - 1.0));
    assert_close(
        "y a quarter turn behind",
        right[6],
        expected,
        1e-3 * 10.0 * (gain - 1.0),
    );
    for across in [right[1], right[5]] {
        assert_within("across", across, 0.0, 1e-3 * expected);
    }
}
