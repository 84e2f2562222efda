//! A bearing in an elastic housing through the whole program: files, balance of the seat, figures, refusals.

use checkpoint::{read_mesh, read_step, read_table, step_file_name};

use crate::util::Dir;
use crate::util::delivered::delivered;
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::{Table, number, summary};

/// Few functions of a seat, for what asks for no accuracy.
const FEW: [&str; 4] = [
    "--set",
    "body.0.seat.0.harmonics=3",
    "--set",
    "body.0.seat.0.across=1",
];

/// If this failed, the tractions of the seat would not be those that carry the bearing, or a user would find no
/// housing in tables, step files and figures. 10 kN downwards come through the balls to the seat: the integral of its
/// tractions, by the trapezoidal rule round it, which is exact for its orders, and Simpson's across. The forces at the
/// nodes balance exactly (`dynamics/tests/housing.rs`); these 17 rows of nodes, 2 mm apart at the edges, integrate the
/// second degree with an error of 1 %, which is in the pressure: 1.6 % in all.
#[test]
fn the_seat_carries_the_load_and_files_show_the_housing() {
    let dir = delivered();
    let run = dir.raceway(&["run", "scenes/6010_plummer_block.toml", "--out", "run"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let told = "seat of the outer ring in body \"plummer block\": 225 functions";
    assert!(run.stdout.contains(told), "{}", run.stdout);
    let seat = Table::read(&dir, "run/seat_outer.csv");
    let column = |name: &str| seat.column(name);
    let (azimuth, pressure, shear) = (
        column("azimuth_rad"),
        column("pressure_pa"),
        column("shear_tangential_pa"),
    );
    let simpson = |i: usize| match i % 9 {
        0 | 8 => 1.0 / 3.0,
        j if j % 2 == 1 => 4.0 / 3.0,
        _ => 2.0 / 3.0,
    };
    let area = |i: usize| simpson(i) * 2e-3 * 40e-3 * std::f64::consts::TAU / 144.0;
    let force = |direction: f64| -> f64 {
        let of = |i: usize| {
            let (sin, cos) = (azimuth[i] - direction).sin_cos();
            area(i) * (-pressure[i] * cos - shear[i] * sin)
        };
        (0..azimuth.len()).map(of).sum()
    };
    let up = force(std::f64::consts::FRAC_PI_2);
    assert!((up / 10e3 - 1.0).abs() < 0.02, "{up} N upwards on the ring");
    assert!(force(0.0).abs() < 50.0, "{} N sideways", force(0.0));
    let summary = summary(&dir, "run");
    assert_eq!(number(&summary, "/seat/functions"), 225.0);
    assert!(number(&summary, "/seat/energy_share_last_orders") < 0.02);
    assert!(number(&summary, "/seat/body_energy_j") > 0.0);
    assert!(number(&summary, "/energy_j/defect").abs() < 1e-9 * number(&summary, "/energy_j/strain"));
    let plot = dir.raceway(&["plot", "run"]);
    assert_eq!(plot.code, Some(0), "{}", plot.stderr);
    assert!(
        plot.stdout.contains("seat_pressure") && plot.stdout.contains("seat_motion"),
        "{}",
        plot.stdout
    );
}

/// If this failed, nobody would know that a seat of few orders lets the ring give way under each ball.
#[test]
fn check_advises_orders_for_the_balls() {
    let dir = delivered();
    let advice = |set: &str| {
        let check = dir.raceway(&["check", "scenes/6010_plummer_block.toml", "--set", set]);
        assert_eq!(check.code, Some(0), "{}", check.stderr);
        check.stdout.contains("its seat has 12 orders for 14 balls")
            && check.stdout.contains("harmonics = 16 follows")
    };
    assert!(advice("body.0.seat.0.harmonics=12"));
    assert!(!advice("body.0.seat.0.harmonics=16"));
}

/// If this failed, a body that is not there, does not fit or is not held would end in anything but a message.
#[test]
fn bodies_that_do_not_fit_end_with_a_message() {
    let dir = delivered();
    let refused = |set: &[&str], expected: &str| {
        let sets = set.iter().flat_map(|set| ["--set", set]);
        let first = ["run", "scenes/6010_plummer_block.toml", "--out", "bad"];
        let run = dir.raceway(&first.into_iter().chain(sets).collect::<Vec<_>>());
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert!(
            run.stderr.contains(expected),
            "{}\nexpected: {expected}",
            run.stderr
        );
        assert!(!dir.path("bad").exists());
    };
    refused(
        &["outer.support=\"clamped\""],
        "but outer.support is not \"body\"",
    );
    refused(&["solver.backend=\"sector\""], "does not tie a ring to a body");
    refused(&["speed.outer=\"100 rpm\""], "speed.outer turns the outer ring");
}

/// If this failed, regions and extremes would lack the housing, which comes after the balls in all files, or take its
/// stress for that of rings. Extremes over a sweep of two loads are those of the two step files, of every point; a
/// region of azimuths holds the housing, one near the grooves does not; without stress in step files the extremes are
/// the same.
#[test]
fn regions_and_extremes_hold_the_housing() {
    let dir = delivered();
    let text = dir.text("scenes/6010_plummer_block.toml");
    let sweep = "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"2 kN\", \"10 kN\"]\n";
    let text = text.replace("[static]                             # one equilibrium", sweep);
    dir.write("sweep.toml", text.replace("../meshes", "meshes"));
    let run = |out: &str, set: &[&str]| {
        let sets = set.iter().flat_map(|set| ["--set", set]);
        let first = [
            "run",
            "sweep.toml",
            "--out",
            out,
            "--set",
            "output.reduction.every=1",
        ];
        let run = dir.raceway(&first.into_iter().chain(sets).collect::<Vec<_>>());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let table = read_table(&dir.path(out).join("reduction.vtkhdf"), None).unwrap();
        table
            .fields
            .into_iter()
            .find(|field| field.name == "von_mises_maximum")
            .unwrap()
            .values
    };
    let in_sector = [
        "output.region.azimuth=[\"-100 deg\", \"-80 deg\"]",
        "output.precision=f64",
    ];
    let most = run("sector", &in_sector);
    let grid = read_mesh(&dir.path("sector")).unwrap();
    let steps = [0, 1].map(|n| {
        read_step(&dir.path("sector").join(step_file_name(n)))
            .unwrap()
            .points
    });
    let [small, large] = steps.each_ref().map(|points| points.von_mises.as_ref().unwrap());
    let inside = steps[1].in_region.as_ref().unwrap();
    let mut of_body = vec![false; most.len()];
    for (ends, _) in grid
        .offsets
        .windows(2)
        .zip(&grid.body)
        .filter(|(_, body)| **body == 3)
    {
        for &point in &grid.connectivity[ends[0] as usize..ends[1] as usize] {
            of_body[point as usize] = true;
        }
    }
    let (mut kept, mut left, mut stressed) = (0, 0, 0);
    for i in (0..most.len()).filter(|&i| of_body[i]) {
        let [x, y, _] = grid.points[i];
        let in_sector = (y.atan2(x).to_degrees() + 90.0).abs() <= 10.0 + 1e-6;
        assert_eq!(inside[i] == 1.0, in_sector, "point {i} at {x} {y}");
        match in_sector {
            true => {
                assert_eq!(most[i], small[i].max(large[i]), "point {i}");
                kept += 1;
            }
            false => {
                assert!(large[i].is_nan());
                left += 1;
            }
        }
        stressed += usize::from(most[i] > 1e5);
    }
    assert!(
        kept > 100 && left > 1000 && stressed > 1000,
        "{kept} {left} {stressed}"
    );
    let without = ["output.stress=none", "output.precision=f64"];
    assert!(run("none", &without) == most);
    let near = ["output.region.raceway_distance=1 mm", "output.precision=f64"];
    assert!(run("near", &near) == most);
    let near = read_step(&dir.path("near").join(step_file_name(1)))
        .unwrap()
        .points;
    let near = near.in_region.unwrap();
    assert!((0..most.len()).all(|i| !(of_body[i] && near[i] == 1.0)));
    assert!(near.iter().filter(|&&inside| inside == 1.0).count() > 1000);
}

/// Writes the delivered bearing on a shaft of 5 kg with another analysis.
fn with_analysis(dir: &Dir, name: &str, analysis: &str) {
    let text = dir.text("scenes/6010_plummer_block.toml");
    let text = text.replace("[static]                             # one equilibrium", analysis);
    let text = text.replace("load_point = \"0 mm\"", "load_point = \"0 mm\"\nmass = \"5 kg\"");
    dir.write(name, text.replace("../meshes", "meshes"));
}

/// It turns at 3000 rpm with an unbalance under gravity; 12 steps, a file every fourth.
pub fn in_motion(dir: &Dir) {
    let motion = "[speed]\ninner = \"3000 rpm\"\n[effects.unbalance]\nmass = \"20 g\"\neccentricity = \"30 mm\"\n\
                  [effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0.0, -1.0, 0.0]\n\
                  [dynamic]\nduration = \"240 us\"\nstep = \"20 us\"\noutput_every = 4\n";
    with_analysis(dir, "motion.toml", motion);
}

/// If this failed, a housing would not move, or be left out of step files; a run that is cut and goes on, or has other
/// threads, would have other bits.
#[test]
fn a_housing_moves_and_goes_on_to_the_same_bits() {
    let dir = delivered();
    in_motion(&dir);
    let first = ["run", "motion.toml", "--out", "whole", "--threads", "1"];
    let run = dir.raceway(&[&first[..], &FEW].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let told = "its seat is tied to a body by 42 functions, and the body moves by these and by its";
    assert!(run.stderr.contains(told), "{}", run.stderr);
    let summary = summary(&dir, "whole");
    let energy = |name: &str| number(&summary, &format!("/energy_j/{name}"));
    assert!(energy("defect").abs() < 1e-9 * energy("total"));
    assert!(energy("kinetic_outer") > 0.0);
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    let resumed = dir.raceway(&["resume", "cut", "--step", "4", "--threads", "2"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_same_run(&dir, "whole", "cut");
    let grid = read_mesh(&dir.path("whole")).unwrap();
    let of_body = |cell: usize| grid.body[cell] == 3;
    let ends = |cell: usize| grid.offsets[cell] as usize..grid.offsets[cell + 1] as usize;
    let cells = (0..grid.body.len()).filter(|&cell| of_body(cell));
    let points: Vec<usize> = cells
        .flat_map(|cell| grid.connectivity[ends(cell)].iter().map(|&p| p as usize))
        .collect();
    let [first, last] = [0, 12].map(|step| {
        read_step(&dir.path("whole").join(step_file_name(step)))
            .unwrap()
            .points
    });
    let most = |of: &dyn Fn(usize) -> f64| points.iter().map(|&p| of(p)).fold(0.0, f64::max);
    let moved = |p: usize| {
        (0..3)
            .map(|c| (last.displacement[p][c] - first.displacement[p][c]).abs())
            .fold(0.0, f64::max)
    };
    assert!(
        most(&|p| first.displacement[p][1].abs()) > 1e-6,
        "it stands under the load"
    );
    assert!(most(&moved) > 1e-10, "it moves by {} m", most(&moved));
    assert!(most(&|p| last.von_mises.as_ref().unwrap()[p]) > 1e5);
}

/// If this failed, modes would be those of a bearing without its housing, or a user would not see what moves. Modes of
/// ring and shaft lie below those in a seat that is clamped, and the block has a part in them.
#[test]
fn a_bearing_has_natural_modes_in_its_housing() {
    let dir = delivered();
    let modes = "[modes]\nnumber = 16\nbodies = [\"outer\", \"bearing\"]\nsupport = \"as_held\"\n";
    with_analysis(&dir, "modes.toml", modes);
    let run = |out: &str| {
        let run = dir.raceway(&["run", "modes.toml", "--out", out]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        run
    };
    let told = run("block");
    assert!(told.stdout.contains("of outer in the body"), "{}", told.stdout);
    let columns = |out: &str, names: [&str; 3]| {
        let mut reader = csv::Reader::from_path(dir.path(out).join("modes.csv")).unwrap();
        let head = reader.headers().unwrap().clone();
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        names.map(|name| -> Vec<f64> {
            let Some(i) = head.iter().position(|column| column == name) else {
                return Vec::new();
            };
            rows.iter().map(|row| row[i].parse().unwrap()).collect()
        })
    };
    let names = ["frequency_hz", "kinetic_outer", "kinetic_body"];
    let [frequency, outer, share] = columns("block", names);
    assert_eq!(frequency.len(), 32);
    assert!((0..32).all(|i| share[i] >= 0.0 && share[i] <= outer[i] + 1e-12));
    assert!(share[..16].iter().all(|share| *share > 0.05), "{share:?}");
    let mut rigid = text_without_body(&dir, "modes.toml");
    rigid = rigid.replace("support = \"body\"", "support = \"clamped\"");
    dir.write("modes.toml", rigid);
    run("rigid");
    let [rigid, _, without] = columns("rigid", names);
    assert!(without.is_empty(), "a column of a body that is not there");
    assert!(
        frequency[0] < 0.9 * rigid[0],
        "{} Hz, {} Hz",
        frequency[0],
        rigid[0]
    );
    let bearing = |list: &[f64]| list[16..].iter().copied().find(|f| *f > 1.0).unwrap();
    assert!(bearing(&frequency) < bearing(&rigid), "{frequency:?} {rigid:?}");
}

/// The text of a scene without its tables of bodies.
fn text_without_body(dir: &Dir, name: &str) -> String {
    let text = dir.text(name);
    let (before, after) = (text.find("\n[[body]]").unwrap(), text.find("\n[shaft]").unwrap());
    format!("{}{}", &text[..before], &text[after..])
}

/// A list of two 6010 under 20 kN, each in a block of its own, on a shaft that is stiff.
fn two_blocks(dir: &Dir, analysis: &str) {
    let text = dir
        .text("scenes/6010_plummer_block.toml")
        .replace("../meshes", "meshes");
    let place = |table: &str| text.find(&format!("\n{table}")).unwrap();
    let [kind, body, shaft] = ["[bearing]", "[[body]]", "[shaft]"].map(place);
    dir.write(
        "kind.toml",
        text[kind..body].replace("support = \"body\"", "support = \"mean_motion\""),
    );
    let mut list = String::new();
    for (name, position, orientation) in [("front", 30, "+z"), ("rear", 230, "-z")] {
        list += &format!(
            "[[bearing]]\nname = \"{name}\"\nposition = \"{position} mm\"\norientation = \"{orientation}\"\n\
             type = \"kind.toml\"\nfirst_ball_azimuth = \"270 deg\"\n"
        );
    }
    for name in ["front", "rear"] {
        let own = text[body..shaft].replace("plummer block", &format!("block of {name}"));
        list += &own.replace(
            "ring = \"outer\"",
            &format!("ring = \"outer\"\nbearing = \"{name}\""),
        );
    }
    list += "[shaft]\nmodel = \"rigid\"\nx = \"free\"\ny = \"free\"\nz = \"locked\"\ntilt_x = \"free\"\n\
             tilt_y = \"free\"\nmass = \"10 kg\"\ntransverse_inertia = \"0.05 kg m2\"\n\
             polar_inertia = \"0.02 kg m2\"\n[[shaft.load]]\nposition = \"130 mm\"\n\
             force = [\"3 kN\", \"-20 kN\", \"0 N\"]\n[solver]\n[output]\n";
    dir.write("list.toml", list + analysis);
}

/// If this failed, a bearing of a list would have no housing, or one that stands on its head: the rear bearing is
/// turned by 180 deg about x, its block is not. Both carry half of the load; their blocks differ by tetrahedra alone.
#[test]
fn bearings_of_a_list_sit_in_blocks_of_their_own() {
    let dir = delivered();
    two_blocks(&dir, "[static]\n");
    let run = dir.raceway(&["run", "list.toml", "--out", "list"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let displacements = |out: &str| {
        let summary = summary(&dir, out);
        [0, 1].map(|c| number(&summary, &format!("/shaft/displacement_m/{c}")))
    };
    let [front, rear] = ["list/front", "list/rear"].map(displacements);
    // In its own frame the rear bearing sees y the other way.
    assert!((front[0] / rear[0] - 1.0).abs() < 2e-3, "{front:?} {rear:?}");
    assert!((front[1] / -rear[1] - 1.0).abs() < 2e-3, "{front:?} {rear:?}");
    // The same bearing alone under the half of the load, the shaft free to tilt in both.
    let alone = text_alone(&dir);
    dir.write("alone.toml", alone);
    let run = dir.raceway(&["run", "alone.toml", "--out", "alone"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let alone = displacements("alone");
    assert!((front[0] / alone[0] - 1.0).abs() < 2e-3, "{front:?} {alone:?}");
    assert!((front[1] / alone[1] - 1.0).abs() < 1e-3, "{front:?} {alone:?}");
    for name in ["front", "rear"] {
        let seat = summary(&dir, &format!("list/{name}"));
        assert_eq!(number(&seat, "/seat/functions"), 225.0);
        assert!(dir.path(&format!("list/{name}/seat_outer.csv")).exists());
    }
    let few = [
        "--set",
        "body.0.seat.0.harmonics=2",
        "--set",
        "body.0.seat.0.across=1",
    ];
    let few = dir.raceway(&[&["run", "list.toml", "--out", "few"], &few[..]].concat());
    let told = "warning: bearing \"front\": the seat of body \"block of front\" is not resolved";
    assert!(
        few.code == Some(0) && few.stdout.contains(told),
        "{}{}",
        few.stdout,
        few.stderr
    );
    let slip = dir.raceway(&[
        "run",
        "list.toml",
        "--out",
        "bad",
        "--set",
        "body.1.seat.0.bearing=back",
    ]);
    assert_eq!(slip.code, Some(2), "{}", slip.stderr);
    let told = "body \"block of rear\" has a seat for the bearing \"back\"; expected one of front, rear";
    assert!(slip.stderr.contains(told), "{}", slip.stderr);
}

/// The delivered scene under the load of one of the two blocks.
fn text_alone(dir: &Dir) -> String {
    let text = dir
        .text("scenes/6010_plummer_block.toml")
        .replace("../meshes", "meshes");
    let (before, after) = (
        text.find("\n[effects.radial_force]").unwrap(),
        text.find("\n[solver]").unwrap(),
    );
    let force = "\n[effects.radial_force]\nvalue = \"10111.874208 N\"\ndirection = \"278.53076561 deg\"\n";
    format!("{}{force}{}", &text[..before], &text[after..])
}

/// If this failed, a list in housings would not move, would lose energy, or would go on to other bits.
#[test]
fn a_list_moves_in_its_blocks_and_goes_on_to_the_same_bits() {
    let dir = delivered();
    let motion = "[speed]\ninner = \"3000 rpm\"\n[effects.radial_force]\nvalue = \"4 kN\"\n\
                  schedule.ramp = { start = \"0 s\", duration = \"20 us\" }\ndirection = \"0 deg\"\n\
                  [dynamic]\nduration = \"80 us\"\n\
                  step = \"10 us\"\noutput_every = 4\n";
    two_blocks(&dir, motion);
    let rear = FEW.map(|set| set.replace("body.0", "body.1"));
    let sets: Vec<&str> = FEW.into_iter().chain(rear.iter().map(String::as_str)).collect();
    assert_moves_and_goes_on(&dir, "list.toml", &sets);
}

/// Fails unless a list of "front" and "rear" moves in elastic housings without losing energy, and goes on from step 4
/// to the same bits on another number of threads.
#[track_caller]
pub fn assert_moves_and_goes_on(dir: &Dir, scene: &str, more: &[&str]) {
    let first = ["run", scene, "--out", "whole", "--threads", "1"];
    let run = dir.raceway(&[&first[..], more].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for name in ["front", "rear"] {
        let summary = summary(dir, &format!("whole/{name}"));
        let energy = |name: &str| number(&summary, &format!("/energy_j/{name}"));
        assert!(energy("defect").abs() < 1e-9 * energy("total"), "{summary}");
        assert!(energy("kinetic_outer") > 0.0);
    }
    copy(dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    let resumed = dir.raceway(&["resume", "cut", "--step", "4", "--threads", "2"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    for name in ["front", "rear"] {
        assert_same_run(dir, &format!("whole/{name}"), &format!("cut/{name}"));
    }
}

/// Wrong: `info` would call the mesh of a body a bad mesh of a ring.
#[test]
fn info_says_what_the_mesh_of_a_body_holds() {
    let dir = Dir::with_scene(crate::util::SCENE);
    let [inner, _] = crate::util::rings::tiny_texts();
    assert!(inner.contains("\"ring\""));
    dir.write("body.msh", inner.replace("\"ring\"", "\"body\""));
    let outcome = dir.raceway(&["info", "body.msh"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for part in ["mesh       108 hex8, 252 nodes", "group      bore, 108 facets"] {
        assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
    }
    dir.write("part.msh", inner.replace("\"ring\"", "\"part\""));
    let outcome = dir.raceway(&["info", "part.msh"]);
    let expected = "part.msh has no physical Volume \"ring\" or \"body\" with elements, the mesh of a ring or of a \
                    [[body]]; physical Volumes are \"part\"";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
}
