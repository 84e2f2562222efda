//! Probes through the whole program: against the step files, the tables, and points that no mesh has.

use checkpoint::read_step;
use serde_json::Value;

use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, RIGID, SCENE, assert_close, assert_within, with_line};

/// One probe of every kind.
const PROBES: &str = "
[probes.node.pi2]
ring = \"inner\"
azimuth = \"20 deg\"
groove_angle = \"15 deg\"

[probes.node.pi2_fixed]
ring = \"inner\"
azimuth = \"20 deg\"
groove_angle = \"15 deg\"
axes = \"cartesian\"

[probes.node.po2]
ring = \"outer\"
azimuth = \"40 deg\"
r = \"38.5 mm\"
z = \"1 mm\"
axes = \"cartesian\"

[probes.contact.b3]
ball = 3
ring = \"outer\"

[probes.contact.b3_inner]
ball = 3
ring = \"inner\"
about = [\"1 mm\", \"-2 mm\", \"3 mm\"]

[output]
precision = \"f64\"
";

/// The tests' scene with probes and another analysis.
fn scene(analysis: &str) -> String {
    with_line("[static]", "[static]", &format!("{analysis}\n{PROBES}"))
}

const ANALYSES: [(&str, u64); 3] = [
    ("[static]", 0),
    (
        "[quasi_static]\nduration = \"2 ms\"\nstep = \"1 ms\"\n[speed]\ninner = \"1800 rpm\"",
        2,
    ),
    (
        "[dynamic]\nduration = \"60 us\"\nstep = \"20 us\"\n[speed]\ninner = \"18000 rpm\"",
        3,
    ),
];

fn six(table: &Table, name: &str) -> [f64; 6] {
    ["xx", "yy", "zz", "xy", "yz", "xz"].map(|ij| table.column(&format!("{name}_stress_{ij}_pa"))[0])
}

/// If this failed, a history of a node would not be the history of the field that ParaView shows, of nodes of the
/// fixed and of the turning ring, at rest and in motion: displacements have the same bits; stress, which a probe
/// takes from the elements around its node and the field of a periodic ring from the weights of its sector, agrees to
/// rounding of the largest stress.
#[test]
fn a_node_probe_has_the_numbers_of_the_step_file() {
    for (analysis, last) in ANALYSES {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", scene(analysis));
        dir.run("out", &[]);
        let table = Table::read(&dir, "out/probes.csv");
        assert_eq!(table.rows.len() as u64, last + 1, "{analysis}");
        let (row, summary) = (table.step(last as usize), summary(&dir, "out"));
        let points = read_step(&dir.path(&format!("out/step_{last:06}.hdf")))
            .unwrap()
            .points;
        let n_inner = number(&summary, "/dofs/inner") as usize / 3;
        for (probe, name, first) in [(1, "pi2_fixed", 0), (2, "po2", n_inner)] {
            let place = &summary["probes"][probe];
            assert_eq!(place["name"], name);
            let point = first + place["node"].as_u64().unwrap() as usize;
            let all = points.von_mises.as_ref().unwrap();
            let rounding = 1e-12 * all.iter().fold(0.0f64, |m, s| m.max(*s));
            let near = |found: f64, expected: f64| {
                assert!(
                    (found - expected).abs() <= rounding,
                    "{analysis}: {found} Pa, {expected} Pa in the file"
                );
            };
            let stress = points.stress.as_ref().unwrap()[point];
            six(&row, name)
                .into_iter()
                .zip(stress)
                .for_each(|(a, b)| near(a, b));
            let von_mises = row.column(&format!("{name}_von_mises_pa"))[0];
            near(von_mises, all[point]);
            assert!(von_mises > 1e3, "{von_mises}: there is something to compare");
            let moved = ["x", "y", "z"].map(|i| row.column(&format!("{name}_displacement_{i}_m"))[0]);
            assert_eq!(moved, points.displacement[point]);
        }
    }
}

/// If this failed, cylindrical components would be in other axes, or those of the turning ring not turn with it:
/// traces and von Mises stress agree with the Cartesian ones of the same node, and the radial stress is n . s n at
/// its azimuth.
#[test]
fn cylindrical_components_are_those_at_the_node() {
    for (analysis, last) in ANALYSES {
        let dir = Dir::with_meshes();
        dir.write("scene.toml", scene(analysis));
        dir.run("out", &[]);
        let (table, summary) = (Table::read(&dir, "out/probes.csv"), summary(&dir, "out"));
        let row = table.step(last as usize);
        let [xx, yy, zz, xy, ..] = six(&row, "pi2_fixed");
        let cell = |name: &str| row.column(&format!("pi2_{name}"))[0];
        let scale = cell("von_mises_pa");
        assert_eq!(scale, row.column("pi2_fixed_von_mises_pa")[0]);
        let speed = if last == 3 { 18000.0 } else { 1800.0 } * std::f64::consts::PI / 30.0;
        let turned = if last == 0 {
            0.0
        } else {
            speed * row.column("time_s")[0]
        };
        let azimuth = number(&summary, "/probes/0/azimuth_rad") + turned;
        let (s, c) = azimuth.sin_cos();
        let radial = c * c * xx + 2.0 * s * c * xy + s * s * yy;
        // Some ten products of round-off.
        assert_within("radial stress", cell("stress_rr_pa"), radial, 1e-13 * scale);
        let trace = cell("stress_rr_pa") + cell("stress_tt_pa") + cell("stress_zz_pa");
        assert_within("trace", trace, xx + yy + zz, 1e-13 * scale);
        // Within the ring, displacements are micrometres however far it has turned.
        for i in ["r", "t", "z"] {
            assert!(cell(&format!("displacement_{i}_m")).abs() < 1e-4, "{analysis}");
        }
    }
}

/// If this failed, forces and moments of contacts would not be those of the tables, or would act elsewhere.
#[test]
fn a_contact_probe_has_the_force_of_the_tables_and_its_moment() {
    let dir = Dir::with_scene(&format!(
        "{SCENE}\n{}",
        PROBES
            .split_once("[probes.contact.b3]")
            .map_or("", |(_, contacts)| contacts)
    ));
    // The header was cut off with the text before it.
    dir.write(
        "scene.toml",
        dir.text("scene.toml").replace(
            "[static]\n\n\nball = 3",
            "[static]\n\n[probes.contact.b3]\nball = 3",
        ),
    );
    dir.run("out", &RIGID);
    let (probes, balls) = (
        Table::read(&dir, "out/probes.csv"),
        Table::read(&dir, "out/balls.csv"),
    );
    let cell = |name: &str| probes.column(name)[0];
    let ball = |name: &str| balls.column(name)[3];
    let (angle, azimuth) = (ball("outer_contact_angle_rad"), ball("azimuth_rad"));
    let force = ball("outer_force_n");
    assert_close("size", cell("b3_force_n"), force, 4e-16);
    // The outer ring pushes inwards, and against preload: towards -z.
    let expected = [
        -force * angle.cos() * azimuth.cos(),
        -force * angle.cos() * azimuth.sin(),
        -force * angle.sin(),
    ];
    for (i, f) in ["x", "y", "z"].iter().zip(expected) {
        assert_within("force", cell(&format!("b3_force_{i}_n")), f, 1e-12);
    }
    let vector = |name: &str, unit: &str| ["x", "y", "z"].map(|i| cell(&format!("{name}_{i}_{unit}")));
    // Without friction a force through the axis of rotation has no moment about z there.
    let moment = vector("b3_moment", "n_m");
    assert_within("moment about z", moment[2], 0.0, 1e-15 * force);
    let size = moment.iter().map(|m| m * m).sum::<f64>().sqrt();
    assert_close("size", cell("b3_moment_n_m"), size, 4e-16);
    // The ball is in equilibrium: forces and, about the same point, moments cancel: M' = M - p x F.
    let (inner, outer) = (vector("b3_inner_force", "n"), vector("b3_force", "n"));
    for i in 0..3 {
        assert_within("balance", inner[i] + outer[i], 0.0, 1e-9 * force);
    }
    let (p, about) = ([1e-3, -2e-3, 3e-3], vector("b3_inner_moment", "n_m"));
    let shift = [
        p[1] * inner[2] - p[2] * inner[1],
        p[2] * inner[0] - p[0] * inner[2],
        p[0] * inner[1] - p[1] * inner[0],
    ];
    for i in 0..3 {
        assert_within(
            "moments",
            about[i] + shift[i] + moment[i],
            0.0,
            1e-9 * force * 40e-3,
        );
    }
}

/// If this failed, a sweep would have no histories of its probes.
#[test]
fn a_sweep_has_a_line_per_point() {
    let sweep = "[sweep]\nkey = \"effects.axial_force.value\"\nvalues = [\"1 kN\", \"2 kN\"]";
    let dir = Dir::with_meshes();
    dir.write("scene.toml", scene(sweep));
    dir.run("out", &[]);
    let table = Table::read(&dir, "out/probes.csv");
    assert_eq!(
        table.columns[..3],
        ["step", "time_s", "effects.axial_force.value_n"]
    );
    assert_eq!(table.column("effects.axial_force.value_n"), [1000.0, 2000.0]);
    let forces = table.column("b3_force_n");
    assert!(forces[1] > 1.5 * forces[0], "{forces:?}");
    let message = dir
        .raceway(&[
            "run",
            "scene.toml",
            "--set",
            "sweep.key=\"probes.contact.b3.ball\"",
            "--set",
            "sweep.values=[1, 2]",
        ])
        .stderr;
    assert!(
        message.contains("expected the path of a number in the scene"),
        "{message}"
    );
}

/// If this failed, a probe beside the ring would silently give the stress of some other place; and what was found
/// would not be told.
#[test]
fn a_point_beside_the_mesh_is_refused_and_a_found_node_is_named() {
    let dir = Dir::with_meshes();
    dir.write("scene.toml", scene("[static]"));
    for (set, point) in [
        (
            "probes.node.po2.r=60 mm",
            "the point at azimuth 40.000 deg, r 60.0000 mm, z 1.0000 mm is ",
        ),
        (
            "probes.node.pi2.groove_angle=80 deg",
            "probes.node.pi2.groove_angle is 80.000 deg; the raceway of the inner ring reaches from -",
        ),
    ] {
        let outcome = dir.raceway(&["run", "scene.toml", "--out", "beside", "--set", set]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(point), "{}", outcome.stderr);
        assert!(!dir.path("beside").exists());
    }
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(
        outcome.stdout.contains("probe    po2: node "),
        "{}",
        outcome.stdout
    );
    dir.run("out", &[]);
    let places = &summary(&dir, "out")["probes"];
    assert_eq!(places.as_array().map(Vec::len), Some(3));
    let po2: &Value = &places[2];
    assert_eq!((&po2["name"], &po2["ring"]), (&"po2".into(), &"outer".into()));
    assert_eq!(
        po2["tag"].as_u64().unwrap(),
        po2["node"].as_u64().unwrap() + 1,
        "the tests' meshes count from 1"
    );
    let r = po2["r_m"].as_f64().unwrap();
    let distance = po2["distance_m"].as_f64().unwrap();
    assert!((r - 38.5e-3).abs() <= distance && distance < 2e-3, "{po2}");
}
