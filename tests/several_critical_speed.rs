//! Critical speeds of a beam shaft on its bearings by `raceway campbell`, against a continuous Timoshenko beam.
//!
//! The independent model has no elements. An unloaded pair is the same in all directions across the axis, so that a
//! whirl is X = x + i y and the slope Y of the axis, both times e^(i w t). With E I, k G A, rho A, rho I of a section,
//! moment M and shear force V, turning at W (polar inertia 2 rho I):
//!
//! ```text
//! X' = Y + V / (k G A)     Y' = M / (E I)     M' = -V - rho I (w^2 - 2 W w) Y     V' = -rho A w^2 X
//! ```
//!
//! At a bearing V and M grow by its 5 x 5 stiffness times (X, Y), at a disc by less its inertia. Both ends are free. A
//! critical speed has w = W along the spin, w = -W against it.

use std::f64::consts::{PI, TAU};

use serde_json::Value;

use crate::several::{pair, succeeds, with_type};
use crate::util::Dir;

const YOUNG: f64 = 207e9;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 7800.0;
/// Length of the shaft, its diameter, m.
const LENGTH: f64 = 0.7;
const DIAMETER: f64 = 0.04;
/// Places of the bearings and the disc, m.
const BEARINGS: [(&str, f64); 2] = [("front", 0.1), ("rear", 0.6)];
const DISC: f64 = 0.4;
/// Mass, kg, transverse and polar inertia, kg m2, of the disc.
const OF_DISC: [f64; 3] = [8.0, 0.02, 0.015];

/// Wrong: modes would depend on the speed of the scene, and the place of the shaft on a force that turns with it.
#[test]
fn an_unbalance_is_no_part_of_the_place_about_which_modes_swing() {
    let dir = pair("[dynamic]\nduration = \"1 ms\"\nstep = \"10 us\"");
    let campbell = |out: &str, rpm: u32| {
        let unbalance = "effects.unbalance={mass=\"20 g\",eccentricity=\"5 mm\",position=\"60 mm\"}";
        let speed = format!("speed.inner=\"{rpm} rpm\"");
        let speeds = ["--speeds", "0..30000:30000", "--out", out];
        let sets = ["--set", unbalance, "--set", &speed];
        let said = succeeds(
            &dir,
            &[&["campbell", "pair.toml"], &speeds[..], &sets[..]].concat(),
        );
        let note = "note: [effects.unbalance] turns with the shaft and is left out of the equilibrium";
        assert!(said.stderr.contains(note), "{}", said.stderr);
        dir.text(&format!("{out}/campbell.csv"))
    };
    assert!(campbell("slow", 1) == campbell("fast", 30000));
    let refused = dir.raceway(&[
        "campbell",
        "pair.toml",
        "--speeds",
        "0..1000:500",
        "--out",
        "no",
        "--set",
        "speed={inner=\"-9000 rpm\",outer=\"2000 rpm\"}",
    ]);
    let text = "error: speed.inner is -9000 rpm and speed.outer 2000 rpm, and the speeds of the shaft in modes are \
                positive; expected speed.inner above 0: give both speeds the other sign";
    assert!(
        refused.code == Some(2) && refused.stderr.contains(text),
        "{}",
        refused.stderr
    );
}

/// Balls without mass, a rigid pair without load.
fn rotor() -> Dir {
    let dir = with_type();
    let (head, balls) = dir
        .text("types/kind.toml")
        .split_once("[materials.balls]")
        .map(|(head, balls)| (head.to_string(), balls.to_string()))
        .unwrap();
    let light = balls.replacen("7800 kg/m3", "1 kg/m3", 1);
    dir.write("types/kind.toml", format!("{head}[materials.balls]{light}"));
    let mut text = String::new();
    for ((name, position), orientation) in BEARINGS.into_iter().zip(["+z", "-z"]) {
        text += &format!(
            "[[bearing]]\nname = \"{name}\"\nposition = \"{position} m\"\norientation = \"{orientation}\"\n\
             type = \"types/kind.toml\"\n\n"
        );
    }
    let [mass, transverse, polar] = OF_DISC;
    text += &format!(
        "[pairing]\noffset = \"20 um\"\n\n[shaft]\nmodel = \"beam\"\nelement_length = \"14 mm\"\nmaterial = {{ \
         young_modulus = \"207 GPa\", poisson_ratio = {POISSON}, density = \"{DENSITY} kg/m3\" }}\n\n\
         [[shaft.section]]\nfrom = \"0 m\"\nto = \"{LENGTH} m\"\noutside = \"{DIAMETER} m\"\n\n\
         [[shaft.mass]]\nposition = \"{DISC} m\"\nmass = \"{mass} kg\"\ntransverse_inertia = \"{transverse} kg m2\"\n\
         polar_inertia = \"{polar} kg m2\"\n\n[static]\n"
    );
    dir.write("rotor.toml", text);
    dir
}

/// X, Y, M, V.
type Section = [f64; 4];

/// The state after a length of the beam, by Taylor's series over short pieces.
fn carried(mut state: Section, length: f64, [whirl, speed]: [f64; 2]) -> Section {
    let area = 0.25 * PI * DIAMETER.powi(2);
    let second = PI * DIAMETER.powi(4) / 64.0;
    // Cowper's coefficient of a solid round section (1966).
    let shear = 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON);
    let kga = shear * 0.5 * YOUNG / (1.0 + POISSON) * area;
    let rate = |[x, y, m, v]: Section| -> Section {
        [
            y + v / kga,
            m / (YOUNG * second),
            -v - DENSITY * second * (whirl * whirl - 2.0 * speed * whirl) * y,
            -DENSITY * area * whirl * whirl * x,
        ]
    };
    let pieces = (length / 0.02).ceil();
    let h = length / pieces;
    for _ in 0..pieces as usize {
        let (mut term, mut sum) = (state, state);
        for k in 1..20 {
            term = rate(term).map(|x| h / f64::from(k) * x);
            (0..4).for_each(|i| sum[i] += term[i]);
        }
        state = sum;
    }
    state
}

/// What is left of M and V at the far end, as a determinant over X and Y at the first: 0 where the shaft whirls.
fn determinant(stiffness: &[[[f64; 2]; 2]; 2], [whirl, speed]: [f64; 2]) -> f64 {
    let [mass, transverse, polar] = OF_DISC;
    let end = |first: Section| -> [f64; 2] {
        let (mut state, mut at) = (first, 0.0);
        let inertia = transverse * whirl * whirl - polar * speed * whirl;
        let disc = [[-mass * whirl * whirl, 0.0], [0.0, -inertia]];
        for (place, k) in [
            (BEARINGS[0].1, stiffness[0]),
            (DISC, disc),
            (BEARINGS[1].1, stiffness[1]),
        ] {
            state = carried(state, place - at, [whirl, speed]);
            at = place;
            let [x, y, ..] = state;
            state[3] += k[0][0] * x + k[0][1] * y;
            state[2] += k[1][0] * x + k[1][1] * y;
        }
        let [_, _, m, v] = carried(state, LENGTH - at, [whirl, speed]);
        [m, v]
    };
    let [a, b] = [end([1.0, 0.0, 0.0, 0.0]), end([0.0, 1.0, 0.0, 0.0])];
    a[0] * b[1] - a[1] * b[0]
}

/// The critical speeds up to a speed, rad/s: zeros with w = way W.
fn critical_speeds(stiffness: &[[[f64; 2]; 2]; 2], way: f64, most: f64) -> Vec<f64> {
    let f = |speed: f64| determinant(stiffness, [way * speed, speed]);
    let n = 400;
    let places: Vec<f64> = (1..=n).map(|i| most * f64::from(i) / f64::from(n)).collect();
    let mut found = Vec::new();
    for pair in places.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        if f(low) * f(high) > 0.0 {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if f(low) * f(middle) <= 0.0 {
                high = middle
            } else {
                low = middle
            }
        }
        found.push(low);
    }
    found
}

/// Over x and the slope of x, of both bearings.
fn stiffness(dir: &Dir) -> [[[f64; 2]; 2]; 2] {
    succeeds(dir, &["stiffness", "rotor.toml", "--out", "k"]);
    let json: Value = serde_json::from_str(&dir.text("k/stiffness.json")).unwrap();
    BEARINGS.map(|(name, _)| {
        let k = &json["bearings"][name]["points"][0]["stiffness"];
        let entry = |i: usize, j: usize| k[i][j].as_f64().unwrap();
        // The same in all directions: the slope of y is minus tilt_x.
        assert!((entry(1, 1) / entry(0, 0) - 1.0).abs() < 1e-6);
        assert!((entry(1, 3) / entry(0, 4) + 1.0).abs() < 1e-6);
        [0, 4].map(|i| [0, 4].map(|j| entry(i, j)))
    })
}

/// Frequency of the mode of a whirl nearest to a frequency at a speed, Hz.
fn nearest(text: &str, speed: f64, whirl: &str, near: f64) -> f64 {
    let rows = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect::<Vec<_>>());
    let at = rows.filter(|row| row[0].parse::<f64>().unwrap() == speed && row[3] == whirl);
    let frequencies = at.map(|row| row[2].parse::<f64>().unwrap());
    frequencies
        .min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs()))
        .unwrap_or_else(|| panic!("no {whirl} mode at {speed} rpm: {text}"))
}

/// Wrong: bearings as springs of a beam, its shear, rotary inertia or gyroscopic moments, the inertia of a disc, or
/// their signs. The first two of each whirl; elements of 14 mm leave 2e-5.
#[test]
fn critical_speeds_of_a_beam_on_its_bearings_are_those_of_a_continuous_beam() {
    let dir = rotor();
    let stiffness = stiffness(&dir);
    for (whirl, way, expected) in [("forward", 1.0, 2), ("backward", -1.0, 2)] {
        let speeds = critical_speeds(&stiffness, way, 60_000.0 * PI / 30.0);
        println!("{whirl}: {speeds:?} rad/s");
        assert!(speeds.len() >= expected, "{whirl}: {speeds:?}");
        for (number, exact) in speeds.into_iter().enumerate() {
            // Campbell's lines cross that of the speed between two speeds about it.
            let rpm = (exact * 30.0 / PI).round();
            let [low, high] = [rpm - 10.0, rpm + 10.0];
            let out = format!("{whirl}{number}");
            let range = format!("{low}..{high}:20");
            let arguments = [
                "campbell",
                "rotor.toml",
                "--speeds",
                &range,
                "--number",
                "30",
                "--out",
                &out,
            ];
            succeeds(&dir, &arguments);
            let text = dir.text(&format!("{out}/campbell.csv"));
            let [a, b] = [low, high].map(|rpm| nearest(&text, rpm, whirl, exact / TAU) - rpm / 60.0);
            let critical = (low + 20.0 * a / (a - b)) * PI / 30.0;
            let error = critical / exact - 1.0;
            println!("{whirl} {number}: {critical:.4} rad/s, off by {error:.1e}");
            assert!(
                error.abs() < 5e-5,
                "{whirl} {number}: {critical} and {exact} rad/s"
            );
        }
    }
}
