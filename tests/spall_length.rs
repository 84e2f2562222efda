//! `raceway spall-length`: the length of a spall from the motion of the shaft, on rigid and on elastic rings.

use crate::util::tables::Table;
use crate::util::{Dir, RIGID, with_line};

/// A spall with sharp edges, which ball 0 meets after 0.3 to 0.5 ms at 1800 rpm.
fn spall(ring: &str, length: f64) -> String {
    let azimuth = if ring == "outer" { 2.2 } else { -2.4 };
    format!(
        "[[profiles.spall]]\nring = \"{ring}\"\nazimuth = \"{azimuth} deg\"\ngroove_angle = \"18 deg\"\n\
         length = \"{length} mm\"\nwidth = \"4 mm\"\ndepth = \"100 um\"\n\n"
    )
}

/// A motion at 1800 rpm in steps of 2 us over `duration` ms.
fn motion(duration: f64) -> String {
    format!(
        "[speed]\ninner = \"1800 rpm\"\n\n[effects.contact_damping]\ncoefficient = \"100 N s/m\"\n\
         full_approach = \"3 um\"\n\n[dynamic]\nduration = \"{duration} ms\"\nstep = \"2 us\"\noutput_every = 100000\n\
         integrator = \"chung_hulbert\"\nrho = 0.8\ncontact = \"discrete_gradient\"\nledger_tolerance = 1e-6\n"
    )
}

/// A run of `scene.toml` on elastic rings, or on rigid ones.
fn ran(tables: &str, more: &[&str]) -> Dir {
    let dir = match more.is_empty() {
        true => Dir::with_meshes(),
        false => Dir::empty(),
    };
    dir.write("scene.toml", with_line("[static]", "[static]", tables));
    dir.run("out", &[more, &["--set", "shaft.mass=2 kg"]].concat());
    dir
}

/// What the command says.
fn said(dir: &Dir, ring: &str) -> String {
    let outcome = dir.raceway(&["spall-length", "out", "--ring", ring]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    outcome.stdout
}

/// Lengths over the true one of all passages, none of which flies, and their azimuths, deg.
fn found(dir: &Dir, ring: &str, length: f64) -> Vec<[f64; 2]> {
    println!("{}", said(dir, ring));
    let table = Table::read(dir, "out/spall_lengths.csv");
    assert!(table.column("flies").iter().all(|flies| *flies == 0.0));
    let lengths = table.column("length_m");
    let azimuths = table.column("azimuth_rad");
    let pairs = lengths.iter().zip(azimuths);
    pairs.map(|(l, a)| [1e3 * l / length, a.to_degrees()]).collect()
}

/// Wrong: the length would not be found, on either ring, or the shaft's own answer would stand for it: within 5 %, on
/// rings that are elastic and move themselves. The tests' meshes are coarse, 54 sectors. A step makes 2.4 % of 0.5 mm.
#[test]
fn a_spall_on_elastic_rings_has_its_length_within_five_percent() {
    for (ring, length, azimuth) in [("outer", 0.5, 2.2), ("inner", 0.4, -2.4)] {
        let dir = ran(&(spall(ring, length) + &motion(0.9)), &[]);
        let found = found(&dir, ring, length);
        assert_eq!(found.len(), 1, "{ring}");
        let [ratio, at] = found[0];
        assert!((ratio - 1.0).abs() < 0.05, "{ring}: {ratio}");
        assert!((at - azimuth).abs() < 0.05, "{ring}: {at}");
    }
}

/// Wrong: what is left of an earlier blow would be taken for an entry, or the wrong ball be named: every ball that
/// passes gives the length, and the same place on the ring. 9 ms hold two passages outside and three inside.
#[test]
fn all_balls_that_pass_tell_the_length_and_the_place() {
    for (ring, length, azimuth, n) in [
        ("outer", 0.3, 2.2, 2),
        ("outer", 0.5, 2.2, 2),
        ("inner", 0.4, -2.4, 3),
    ] {
        let dir = ran(&(spall(ring, length) + &motion(9.0)), &RIGID);
        let found = found(&dir, ring, length);
        assert_eq!(found.len(), n, "{ring}");
        for [ratio, at] in found {
            assert!((ratio - 1.0).abs() < 0.05, "{ring} {length}: {ratio}");
            assert!((at - azimuth).abs() < 0.1, "{ring} {length}: {at}");
        }
        if ring == "inner" {
            let said = said(&dir, "outer");
            let expected =
                "the passages lie at places of their own on the outer ring: no length of one spall";
            assert!(said.contains(expected), "{said}");
        }
    }
}

/// Wrong: a length would be told where there is none to tell: over 1 mm the ball flies, a smooth bearing has no
/// impulses, and neither have waves of 1 um.
#[test]
fn where_there_is_no_double_impulse_none_is_told() {
    let dir = ran(&(spall("outer", 1.0) + &motion(1.0)), &RIGID);
    let text = said(&dir, "outer");
    let expected = "every ball flies over the spall: its length is not to be told";
    assert!(
        text.contains(expected) && text.contains("; it flies, and the spall is shorter"),
        "{text}"
    );
    let waves = "[[profiles.waviness]]\nring = \"outer\"\norder = 19\namplitude = \"1 um\"\n\n";
    for tables in ["", waves] {
        let dir = ran(&(tables.to_string() + &motion(9.0)), &RIGID);
        let text = said(&dir, "outer");
        let expected = "no ball loses its load and meets an edge: no double impulse to tell a length from";
        assert!(text.contains(expected), "{text}");
        assert_eq!(dir.text("out/spall_lengths.csv").lines().count(), 1);
    }
}

/// A 33 mm bearing at 600 rpm with a spall of the outer ring at 40 deg, 20 um deep, which ball 1 meets at 7.4 ms.
const SHALLOW: &str = r#"
[bearing]
bore_diameter = "33 mm"
outside_diameter = "58.5 mm"
width = "11 mm"
balls = 13
ball_diameter = "7.2 mm"
pitch_diameter = "45.9 mm"
contact_angle = "22 deg"
inner_curvature_ratio = 0.525
outer_curvature_ratio = 0.535
[materials]
rings = "bearing steel"
balls = "silicon nitride"
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
mass = "1.3 kg"
[effects.axial_force]
value = "1200 N"
[effects.radial_force]
value = "350 N"
direction = "30 deg"
[speed]
inner = "600 rpm"
[effects.contact_damping]
coefficient = "2e-1 N s/mm"
full_approach = "1 um"
[[profiles.spall]]
ring = "outer"
azimuth = "40 deg"
groove_angle = "22 deg"
length = "0.9 mm"
width = "3 mm"
depth = "20 um"
edge = "0.05 mm"
[dynamic]
duration = "12 ms"
step = "10 us"
output_every = 5000
"#;

/// Wrong: ball 7, on the other side, which the blow of ball 1 unloads by a quarter, would be said to pass the spall; or
/// a ball would be said to meet the far edge while it has no load. A ball that flies tells no length here.
#[test]
fn the_ball_is_the_one_that_loses_its_load() {
    let firm = ("12 ms", &["1"][..]);
    let loose = ("27.5 ms", &["1", "0"][..]);
    for (length, load, damping, (duration, balls)) in [(0.9, 1200, "2e-1", firm), (1.3, 600, "5e-2", loose)] {
        let dir = Dir::empty();
        let scene = SHALLOW.replace("0.9 mm", &format!("{length} mm"));
        let scene = scene.replace("1200 N", &format!("{load} N"));
        dir.write(
            "scene.toml",
            scene.replace("2e-1", damping).replace("12 ms", duration),
        );
        dir.run("out", &[]);
        let text = said(&dir, "outer");
        assert!(
            text.contains("every ball flies over the spall: its length is not to be told"),
            "{text}"
        );
        let table = dir.text("out/spall_lengths.csv");
        let rows: Vec<Vec<&str>> = table
            .lines()
            .skip(1)
            .map(|line| line.split(',').collect())
            .collect();
        assert_eq!(
            rows.iter().map(|row| row[0]).collect::<Vec<_>>(),
            balls,
            "{table}"
        );
        for row in rows {
            let azimuth: f64 = row[3].parse().unwrap();
            assert!((azimuth.to_degrees() - 40.0).abs() < 0.5, "{table}");
            // No length, or one that is too large, as is said of a ball that flies.
            assert!(
                row[4]
                    .parse()
                    .map_or(row[4].is_empty(), |told: f64| told > 1e-3 * length),
                "{table}"
            );
            assert_eq!(row[5], "1", "{table}");
        }
    }
}

/// Wrong: a length would come of steps that skip the spall, of a shaft that cannot move, or of a mass of nothing.
#[test]
fn lengths_that_cannot_be_told_are_refused() {
    let refused = |set: &[&str], arguments: &[&str], text: &str| {
        let dir = Dir::with_scene(&with_line("[static]", "[static]", &motion(0.4)));
        dir.run("out", &[&RIGID, set].concat());
        let outcome = dir.raceway(&[&["spall-length", "out"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{}", outcome.stdout);
        assert!(outcome.stderr.contains(text), "{}", outcome.stderr);
    };
    let ring = ["--ring", "outer"];
    let massless = ["--set", "shaft.mass=0 kg"];
    refused(
        &massless,
        &ring,
        "the shaft has no mass; expected shaft.mass in the scene, or --mass KG",
    );
    let long = ["--set", "shaft.mass=2 kg", "--set", "dynamic.step=20 us"];
    refused(
        &long,
        &ring,
        "the run has 214 steps from ball to ball; expected 320 at least",
    );
    let held = [
        "--set",
        "shaft.mass=2 kg",
        "--set",
        "shaft.x=locked",
        "--set",
        "shaft.y=locked",
    ];
    let held = [&held[..], &["--set", "shaft.z=30 um", "--set", "effects={}"]].concat();
    refused(
        &held,
        &ring,
        "x, y and z of the shaft are held: nothing tells what a ball lacks",
    );
    refused(
        &["--set", "shaft.mass=2 kg"],
        &["--ring", "cage"],
        "invalid value 'cage' for '--ring <RING>'",
    );
}
