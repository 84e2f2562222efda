//! Strain gauges through the whole program: against the motion of nodes, symmetry, and the passing of balls.

use crate::util::tables::Table;
use crate::util::{Dir, assert_within, with_line};

/// Gauges that reach from node to node along an edge of the mesh, whose strain is the change of its length, and
/// probes of these nodes.
const EDGES: &str = "
[probes.gauge.outside]
ring = \"outer\"
surface = \"seat\"
azimuth = \"42 deg\"
z = \"8 mm\"
length = \"2.7925268031909 mm\"
width = \"0 mm\"
direction = \"hoop\"

[probes.gauge.inside]
ring = \"inner\"
surface = \"bore\"
azimuth = \"42 deg\"
z = \"8 mm\"
length = \"1.7453292519943 mm\"
width = \"0 mm\"
direction = \"hoop\"

[probes.node.o1]
ring = \"outer\"
azimuth = \"40 deg\"
r = \"40 mm\"
z = \"8 mm\"

[probes.node.o2]
ring = \"outer\"
azimuth = \"44 deg\"
r = \"40 mm\"
z = \"8 mm\"

[probes.node.i1]
ring = \"inner\"
azimuth = \"40 deg\"
r = \"25 mm\"
z = \"8 mm\"

[probes.node.i2]
ring = \"inner\"
azimuth = \"44 deg\"
r = \"25 mm\"
z = \"8 mm\"

[output]
precision = \"f64\"
";

/// The tests' scene with both rings in their mean motion, another analysis and more tables.
fn elastic(analysis: &str, tables: &str) -> Dir {
    let dir = Dir::with_meshes();
    let scene = with_line("[static]", "[static]", &format!("{analysis}\n{tables}"));
    dir.write(
        "scene.toml",
        scene.replace("support = \"clamped\"", "support = \"mean_motion\""),
    );
    dir
}

const ANALYSES: [&str; 3] = [
    "[static]",
    "[quasi_static]\nduration = \"2 ms\"\nstep = \"1 ms\"\n[speed]\ninner = \"1800 rpm\"",
    "[dynamic]\nduration = \"60 us\"\nstep = \"20 us\"\n[speed]\ninner = \"18000 rpm\"",
];

/// Change of the length between two nodes of one radius and z at azimuths 4 deg apart, over that length.
fn elongation(table: &Table, nodes: [&str; 2], radius: f64, row: usize) -> f64 {
    let half = 2f64.to_radians();
    let along = |node: &str, sign: f64| {
        let cell = |i: &str| table.column(&format!("{node}_displacement_{i}_m"))[row];
        // The chord's direction seen from the node: the tangential one, turned by half the angle.
        cell("t") * half.cos() + sign * cell("r") * half.sin()
    };
    (along(nodes[1], 1.0) - along(nodes[0], -1.0)) / (2.0 * radius * half.sin())
}

/// Wrong: a gauge would not show the strain of the ring that the fields show, at rest, over equilibria or in motion,
/// on
/// the turning ring or the other.
#[test]
fn a_gauge_along_an_edge_reads_the_change_of_its_length() {
    for analysis in ANALYSES {
        let dir = elastic(analysis, EDGES);
        dir.run("out", &[]);
        let table = Table::read(&dir, "out/probes.csv");
        for row in 0..table.rows.len() {
            for (gauge, nodes, radius) in [("outside", ["o1", "o2"], 40e-3), ("inside", ["i1", "i2"], 25e-3)]
            {
                let strain = table.column(&format!("{gauge}_strain"))[row];
                let expected = elongation(&table, nodes, radius, row);
                // Nodes move by up to 1e-4 m over 1.7 mm, known to 16 digits.
                assert_within(&format!("{gauge}, row {row}"), strain, expected, 1e-15);
                assert!(
                    strain.abs() > 1e-7,
                    "{gauge}: {strain}: there is something to read"
                );
            }
        }
    }
}

/// Wrong: what a gauge reads would not be that of the balls' places alone: under thrust it reads the same a ball
/// later,
/// and what a gauge half a turn away reads; between balls it reads less.
#[test]
fn a_gauge_reads_a_pulse_per_ball() {
    let gauge = |name: &str, azimuth: &str| {
        format!(
            "[probes.gauge.{name}]\nring = \"outer\"\nsurface = \"seat\"\nazimuth = \"{azimuth}\"\nz = \"2 mm\"\n\
             length = \"3 mm\"\nwidth = \"1.5 mm\"\ndirection = \"hoop\"\n"
        )
    };
    // A pitch of the balls, 20 deg, in ten steps, and the same again.
    let azimuths: Vec<String> = (0..=20).map(|i| format!("\"{} deg\"", 2 * i)).collect();
    let sweep = format!(
        "[sweep]\nkey = \"bearing.first_ball_azimuth\"\nvalues = [{}]\n",
        azimuths.join(", ")
    );
    let dir = elastic(&sweep, &(gauge("a", "5 deg") + &gauge("b", "185 deg")));
    let scene = dir
        .text("scene.toml")
        .replace("value = \"1 kN\"", "value = \"0 kN\"");
    dir.write("scene.toml", scene);
    dir.run("out", &[]);
    let table = Table::read(&dir, "out/probes.csv");
    let (a, b) = (table.column("a_strain"), table.column("b_strain"));
    let (low, high) = a
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
    assert!(high - low > 1e-6, "{low} {high}");
    for i in 0..=10 {
        // Equilibria are found to 1e-10 of their forces.
        assert_within("a ball later", a[i], a[i + 10], 1e-7 * (high - low));
        assert_within("half a turn away", a[i], b[i], 1e-7 * (high - low));
    }
    // The ball nearest to 5 deg stands at 4 or 6 deg; half a pitch on it is at 14 or 16 deg.
    assert!((a[2] - a[7]).abs() > 0.8 * (high - low), "{a:?}");
}

/// Wrong: a gauge that reads nothing, or lies elsewhere than the user thinks, would be taken.
#[test]
fn gauges_that_cannot_be_placed_are_refused() {
    let dir = Dir::with_meshes();
    let gauge = "[probes.gauge.g]\nring = \"outer\"\nsurface = \"free\"\nazimuth = \"42 deg\"\nz = \"7 mm\"\n\
                 length = \"1 mm\"\nwidth = \"0.5 mm\"\ndirection = \"hoop\"\n";
    dir.write(
        "scene.toml",
        with_line("[static]", "[static]", &format!("[static]\n{gauge}")),
    );
    for (sets, expected) in [
        (
            &["probes.gauge.g.surface=seat"][..],
            "probes.gauge.g: the seat of the outer ring is clamped, so that a gauge there reads nothing; expected \
             another surface, the floor of a [[outer.cut]] (surface = \"free\") or outer.support = \"mean_motion\"",
        ),
        (
            &["probes.gauge.g.surface=rim"],
            "probes.gauge.g: the outer ring has no surface \"rim\"; its mesh has the surfaces raceway, seat, and \
             \"free\" is what is in none of them",
        ),
        (
            &["probes.gauge.g.z=9 mm"],
            "the surface \"free\" of the outer ring has no point at azimuth 42.000 deg, z 9.0000 mm; it reaches from",
        ),
        (
            &["probes.gauge.g.length=10 mm", "probes.gauge.g.direction=axial"],
            "its grid of 10.0000 mm x 0.5000 mm reaches beyond the surface \"free\" at azimuth",
        ),
        (
            &["probes.gauge.g.direction=radial"],
            "on a face it needs its place by r, and the direction \"hoop\", \"radial\" or an angle",
        ),
        (
            &[
                "outer.support=mean_motion",
                "probes.gauge.g.surface=seat",
                "probes.gauge.g.r=40 mm",
            ],
            "the surface \"seat\" lies along the axis; expected its place by z",
        ),
        (
            &["probes.gauge.g.width=-1 mm"],
            "probes.gauge.g.width is -1 mm; expected 0 mm, a point or a line, or more",
        ),
        (
            &["probes.gauge.g.direction=up"],
            "a direction: \"hoop\", \"axial\", \"radial\", or an angle from hoop such as \"45 deg\"",
        ),
    ] {
        let sets: Vec<&str> = sets.iter().flat_map(|set| ["--set", set]).collect();
        let outcome = dir.raceway(&[&["check", "scene.toml"], &sets[..]].concat());
        assert_eq!(outcome.code, Some(2), "{sets:?}: {}", outcome.stdout);
        assert!(
            outcome.stderr.contains(expected),
            "expected\n{expected}\nin\n{}",
            outcome.stderr
        );
    }
    let whole = dir.text("scene.toml");
    for (place, expected) in [
        (
            "r = \"37 mm\"",
            "the surface \"free\" is there at several places, z -8.0000 mm and z 8.0000 mm; expected z besides r",
        ),
        (
            "",
            "probes.gauge.g needs its place in the section: z such as \"2 mm\", from the plane of the groove centres",
        ),
    ] {
        dir.write("other.toml", whole.replace("z = \"7 mm\"", place));
        let outcome = dir.raceway(&["check", "other.toml"]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stdout);
        assert!(
            outcome.stderr.contains(expected),
            "expected\n{expected}\nin\n{}",
            outcome.stderr
        );
    }
    let outcome = dir.raceway(&["check", "scene.toml"]);
    let told = "probe    g: strain gauge of 1 mm x 0.5 mm on the \
                surface \"free\" of the outer ring, azimuth 42.000 deg";
    assert!(
        outcome.stdout.contains(told),
        "{}{}",
        outcome.stdout,
        outcome.stderr
    );
}

/// Wrong: hoop, axial and oblique directions would be mixed up, or a face's gauge lie elsewhere: on one place the
/// strains
/// along a direction and square to it add up to those of any other such pair; a face's hoop gauge at its rim reads
/// what
/// the gauge on the seat reads there.
#[test]
fn directions_in_a_surface_share_their_trace() {
    let place = |surface: &str, at: &str| {
        format!(
            "ring = \"outer\"\nsurface = \"{surface}\"\nazimuth = \"9 deg\"\n\
             {at}\nlength = \"0 mm\"\nwidth = \"0 mm\"\n"
        )
    };
    let mut tables = String::new();
    for (name, direction) in [("h", "hoop"), ("a", "axial"), ("p", "30 deg"), ("q", "120 deg")] {
        tables += &format!(
            "[probes.gauge.{name}]\n{}direction = \"{direction}\"\n",
            place("seat", "z = \"1 mm\"")
        );
    }
    let rims = [
        ("rim_seat", "seat", "z = \"8 mm\""),
        ("rim_face", "free", "r = \"39.98 mm\"\nz = \"8 mm\""),
    ];
    for (name, surface, at) in rims {
        tables += &format!(
            "[probes.gauge.{name}]\n{}direction = \"hoop\"\n",
            place(surface, at)
        );
    }
    let dir = elastic("[static]", &tables);
    dir.run("out", &[]);
    let table = Table::read(&dir, "out/probes.csv");
    let read = |name: &str| table.column(&format!("{name}_strain"))[0];
    let scale = read("h").abs() + read("a").abs();
    assert!(
        scale > 1e-7 && (read("h") - read("a")).abs() > 0.03 * scale,
        "{} {}",
        read("h"),
        read("a")
    );
    assert_within(
        "trace",
        read("h") + read("a"),
        read("p") + read("q"),
        1e-9 * scale,
    );
    // One element, 0.02 mm from one to the other; its strain changes by its own size over 2 mm.
    assert_within(
        "rim",
        read("rim_seat"),
        read("rim_face"),
        0.05 * read("rim_seat").abs(),
    );
}

/// A gauge beside each ball of the tests' bearing, on the shoulder at which the outer ring carries them.
fn gauges_beside_balls() -> String {
    let gauge = |ball: usize| {
        format!(
            "[probes.gauge.g{ball:02}]\nring = \"outer\"\nsurface = \"seat\"\nazimuth = \"{} deg\"\nz = \"2 mm\"\n\
             length = \"3 mm\"\nwidth = \"1.5 mm\"\ndirection = \"hoop\"\n",
            20 * ball
        )
    };
    (0..18).map(gauge).collect()
}

/// Wrong: a load matrix would not be that of the ring, or its inverse give other loads than act: at the equilibrium
/// of
/// the matrix the loads are found to round-off times its condition, under other loads, whose contact angles and
/// patches
/// differ, to 3 % of the largest, unloaded balls among them.
#[test]
fn ball_loads_come_back_from_gauge_signals() {
    let dir = elastic("[static]", &gauges_beside_balls());
    let outcome = dir.raceway(&["load-matrix", "scene.toml", "--out", "matrix"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let matrix: serde_json::Value = serde_json::from_str(&dir.text("matrix/load_matrix.json")).unwrap();
    let condition = matrix["condition"].as_f64().unwrap();
    assert!(condition > 1.0 && condition < 100.0, "{condition}");
    assert!(
        outcome
            .stdout
            .contains("18 gauges on the outer ring, 18 balls: condition"),
        "{}",
        outcome.stdout
    );
    assert!(
        dir.text("matrix/load_matrix.csv")
            .starts_with("gauge,offset,ball_0_per_n,")
    );
    let error = |out: &str, sets: &[&str]| {
        dir.run(out, sets);
        let outcome = dir.raceway(&["ball-loads", out, "--matrix", "matrix/load_matrix.json"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        let table = Table::read(&dir, &format!("{out}/ball_loads.csv"));
        let (found, known) = (table.column("load_n"), table.column("outer_force_n"));
        assert_eq!(
            known,
            Table::read(&dir, &format!("{out}/balls.csv")).column("outer_force_n")
        );
        let largest = known.iter().copied().fold(0.0, f64::max);
        found
            .iter()
            .zip(&known)
            .map(|(a, b)| (a - b).abs() / largest)
            .fold(0.0, f64::max)
    };
    let same = error("same", &[]);
    assert!(same < 1e-9 * condition * condition, "{same}");
    let other = error(
        "other",
        &[
            "--set",
            "effects.radial_force.value=2 kN",
            "--set",
            "effects.axial_force.value=1.5 kN",
        ],
    );
    assert!(other > same && other < 0.03, "{other}");
}

/// Wrong: loads would be made of signals that do not tell them, or of balls that stand elsewhere.
#[test]
fn load_matrices_refuse_what_they_cannot_tell() {
    let dir = elastic("[static]", &gauges_beside_balls());
    let refused = |arguments: &[&str], text: &str| {
        let outcome = dir.raceway(arguments);
        assert_eq!(outcome.code, Some(2), "{arguments:?}: {}", outcome.stdout);
        assert!(outcome.stderr.contains(text), "{arguments:?}: {}", outcome.stderr);
    };
    let few = [
        "load-matrix",
        "scene.toml",
        "--out",
        "few",
        "--set",
        "probes.gauge.g03=none",
    ];
    assert_eq!(dir.raceway(&few).code, Some(0));
    dir.run("out", &[]);
    let matrix = |name: &'static str| ["ball-loads", "out", "--matrix", name];
    refused(
        &matrix("few/load_matrix.json"),
        "17 gauges on the outer ring do not tell the loads of 18 balls apart; expected one gauge per ball at least",
    );
    refused(&few, "few already holds load_matrix.json; choose another");
    refused(
        &matrix("scene.toml"),
        "scene.toml is no load matrix; expected the load_matrix.json of raceway load-matrix",
    );
    refused(
        &["load-matrix", "scene.toml", "--out", "inner", "--ring", "inner"],
        "the inner ring has no strain gauges; expected [probes.gauge.NAME] with ring = \"inner\"",
    );
    let turned = [
        "load-matrix",
        "scene.toml",
        "--out",
        "turned",
        "--set",
        "bearing.first_ball_azimuth=3 deg",
    ];
    assert_eq!(dir.raceway(&turned).code, Some(0));
    refused(
        &matrix("turned/load_matrix.json"),
        "no step of out has its 18 balls at the places of turned/load_matrix.json",
    );
    // One gauge twice, on the same place: a singular matrix.
    let twice = [
        "load-matrix",
        "scene.toml",
        "--out",
        "twice",
        "--set",
        "probes.gauge.g03.azimuth=40 deg",
    ];
    assert_eq!(dir.raceway(&twice).code, Some(0));
    refused(
        &matrix("twice/load_matrix.json"),
        "do not tell the loads of the balls apart: the condition of their load matrix is",
    );
}

/// Wrong: looking would change what is looked at: a motion with gauges and a tachometer has the bits of one without.
#[test]
fn gauges_change_no_bit_of_a_motion() {
    let dir = elastic(ANALYSES[2], EDGES);
    let scene = dir.text("scene.toml");
    let (before, rest) = scene.split_once("[probes.gauge.outside]").unwrap();
    let (_, output) = rest.split_once("[output]").unwrap();
    let tachometer = "[probes.tachometer.t]\nring = \"inner\"\n\n[output]";
    dir.write("scene.toml", format!("{before}[output]{output}"));
    dir.run("without", &[]);
    dir.write("scene.toml", scene.replace("[output]", tachometer));
    dir.run("with", &[]);
    for table in ["balls.csv", "shaft.csv", "energy.csv"] {
        assert_eq!(
            dir.text(&format!("with/{table}")),
            dir.text(&format!("without/{table}")),
            "{table}"
        );
    }
    assert!(!dir.path("without/probes.csv").exists());
    let turned = Table::read(&dir, "with/probes.csv").column("t_angle_rad");
    let exact = 60e-6 * 18000.0 * std::f64::consts::PI / 30.0;
    assert_within("angle", *turned.last().unwrap(), exact, 1e-12);
}

/// Wrong: a gauge that balls pass would read another line than the static one. Slowly, 18 rpm, a pitch of the balls in
/// motion: at nine places the signal is the offset and the sum of the balls' forces times what `load-matrix` has for a
/// unit load of each where it stands. Forces of a motion are means over a step, 0.02 deg of the cage: 1e-4 of the peak
/// at the largest slope, and half of it late. The ball that passes makes more than the signal, others take some away.
#[test]
fn passing_slowly_a_ball_draws_the_static_line_of_the_load_matrix() {
    let analysis = "[dynamic]\nduration = \"400 ms\"\nstep = \"0.5 ms\"\noutput_every = 100\nintegrator = \
                    \"chung_hulbert\"\nrho = 0.5\ncontact = \"discrete_gradient\"\nledger_tolerance = 1e-3\n\
                    [speed]\ninner = \"18 rpm\"";
    let gauge = "[probes.gauge.g]\nring = \"outer\"\nsurface = \"seat\"\nazimuth = \"10 deg\"\nz = \"2 mm\"\n\
                 length = \"3 mm\"\nwidth = \"1.5 mm\"\ndirection = \"hoop\"\n";
    let dir = elastic(analysis, gauge);
    dir.run("out", &["--set", "shaft.mass=1 kg"]);
    let (probes, balls) = (
        Table::read(&dir, "out/probes.csv"),
        Table::read(&dir, "out/balls.csv"),
    );
    let (signal, times) = (probes.column("g_strain"), probes.column("time_s"));
    let (forces, at) = (balls.column("outer_force_n"), balls.column("time_s"));
    let peak = signal.iter().fold(0.0, |most: f64, e| most.max(e.abs()));
    let (mut worst, mut passing) = (0.0f64, 0.0f64);
    for k in 0..9 {
        let time = format!("{}", 0.05 * f64::from(k));
        let folder = format!("matrix_{k}");
        let said = dir.raceway(&["load-matrix", "scene.toml", "--out", &folder, "--time", &time]);
        assert_eq!(said.code, Some(0), "{}", said.stderr);
        let text = dir.text(&format!("{folder}/load_matrix.csv"));
        let cells = text.lines().nth(1).unwrap().split(',').skip(1);
        let matrix: Vec<f64> = cells.map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(matrix.len(), 19, "{text}");
        let row = (times.iter().position(|t| (t - 0.05 * f64::from(k)).abs() < 1e-9)).unwrap();
        let of_balls: Vec<f64> = (0..forces.len())
            .filter(|line| (at[*line] - times[row]).abs() < 1e-9)
            .map(|line| forces[line])
            .collect();
        assert_eq!(of_balls.len(), 18);
        let parts: Vec<f64> = of_balls
            .iter()
            .zip(&matrix[1..])
            .map(|(force, unit)| force * unit)
            .collect();
        let line = matrix[0] + parts.iter().sum::<f64>();
        let largest = parts.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        println!(
            "{time} s: {} by the matrix {line}, largest part {largest}",
            signal[row]
        );
        worst = worst.max((signal[row] - line).abs() / peak);
        passing = passing.max(largest / peak);
    }
    println!("off by {worst:e} of the peak; one ball makes {passing} of it");
    assert!(worst < 5e-5, "{worst}");
    assert!(passing > 1.0, "{passing}");
}
