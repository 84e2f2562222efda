//! Figures of a run through the whole program: which there are, that they show the numbers of the tables, and that
//! they can be read.

use std::sync::OnceLock;

use crate::several::{pair, succeeds};
use crate::util::tables::Table;
use crate::util::{Dir, Files, RIGID, SCENE, assert_within, with_line};

const SWEEP: &str = "[sweep]\nkey = \"effects.radial_force.value\"\nvalues = [\"0 kN\", \"1 kN\"]\n\n\
                     [probes.profile.arc]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = [\"-20 deg\", \"45 \
                     deg\"]\npoints = 66";
const MOTION: &str = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"\noutput_every = 5\n\n[speed]\ninner = \"1800 \
                      rpm\"\n\n\
                      [probes.node.p]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"15 deg\"\n\n\
                      [probes.contact.c]\nball = 0\nring = \"inner\"\n\n\
                      [probes.point.q]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"19 deg\"\ndepth \
                      = \"0.1 mm\"\n\n\
                      [probes.profile.arc]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = [\"-20 deg\", \"45 \
                      deg\"]\npoints = 131\n\n\
                      [probes.profile.down]\nring = \"inner\"\nazimuth = \"0 deg\"\ngroove_angle = \"19 deg\"\ndepth \
                      = [\"0 mm\", \"1 mm\"]\n\
                      points = 81\n\n[stress]\nnear_field = true";

/// Folders `sweep` and `motion` on the coarse meshes, with their figures; solved once for all tests.
pub fn plotted() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = Dir::with_meshes();
        for (out, analysis) in [("sweep", SWEEP), ("motion", MOTION)] {
            dir.write("scene.toml", with_line("[static]", "[static]", analysis));
            dir.run(out, &[]);
            let outcome = dir.raceway(&["plot", out]);
            assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        }
        dir.snapshot()
    }))
}

/// Names of the files with an ending in a folder, without the ending.
fn names(dir: &Dir, folder: &str, ending: &str) -> Vec<String> {
    let below = dir.snapshot().into_keys().map(|path| path.display().to_string());
    below
        .filter_map(|path| Some(path.strip_prefix(folder)?.strip_suffix(ending)?.to_string()))
        .collect()
}

/// Wrong: a user would miss a figure of what the run computed.
#[test]
fn every_run_has_the_figures_of_its_kind() {
    let dir = plotted();
    let of_sweep = [
        "ball_force",
        "ball_force_round",
        "contact_angle",
        "contact_angle_round",
        "deformed_rings",
        "groove_inner",
        "groove_outer",
        "peak_pressure",
        "peak_pressure_round",
        "profile_arc_principal_stress",
        "profile_arc_stress",
        "profile_arc_von_mises",
        "raceway_inner",
        "raceway_outer",
        "section_inner",
        "section_outer",
        "shaft_displacement",
    ];
    let of_motion = [
        "ball_displacement",
        "ball_force",
        "ball_force_of_all",
        "contact_angle",
        "contact_angle_of_all",
        "deformed_rings",
        "energy_defect",
        "energy_ledger",
        "groove_inner",
        "groove_outer",
        "peak_pressure",
        "peak_pressure_of_all",
        "probe_c_force",
        "probe_c_moment",
        "probe_p_displacement",
        "probe_p_stress",
        "probe_q_principal_stress",
        "probe_q_stress",
        "profile_arc_principal_stress",
        "profile_arc_stress",
        "profile_down_principal_stress",
        "profile_down_stress",
        "raceway_inner",
        "raceway_outer",
        "section_inner",
        "section_outer",
        "shaft_displacement",
    ];
    for (folder, expected) in [
        ("sweep/figures/", &of_sweep[..]),
        ("motion/figures/", &of_motion[..]),
    ] {
        for ending in [".svg", ".png"] {
            assert_eq!(names(&dir, folder, ending), expected, "{folder} {ending}");
        }
    }
}

/// Wrong: the stress of forces that are spread over patches would be taken for that under a ball, or the picture of a
/// raceway and that of its section would have two scales for one step.
#[test]
fn stress_without_near_field_says_so_and_one_step_has_one_scale() {
    let dir = plotted();
    let note = "Without near field: stress of forces spread over the contact patches";
    let numbers =
        |svg: &str| -> Vec<f64> { svg.lines().filter_map(|line| line.trim().parse().ok()).collect() };
    for side in ["inner", "outer"] {
        let figures = [
            format!("sweep/figures/raceway_{side}.svg"),
            format!("sweep/figures/section_{side}.svg"),
        ];
        assert!(figures.iter().all(|name| dir.text(name).contains(note)), "{side}");
        let names = [
            format!("motion/figures/raceway_{side}.svg"),
            format!("motion/figures/section_{side}.svg"),
        ];
        let [raceway, section] = names.map(|name| dir.text(&name));
        let at_nodes = "Stress at the nodes of the mesh, that of the Hertz contacts included";
        for figure in [&raceway, &section] {
            assert!(
                !figure.contains("near field") && figure.contains(at_nodes),
                "{side}"
            );
        }
        // The colour bar comes after the azimuths.
        let (raceway, section) = (numbers(&raceway), numbers(&section));
        let bar = &raceway[raceway.iter().rposition(|tick| *tick == 360.0).unwrap() + 1..];
        assert!(bar.len() > 2, "{side}: {raceway:?}");
        assert!(
            section.windows(bar.len()).any(|ticks| ticks == bar),
            "{side}: {bar:?} {section:?}"
        );
    }
}

/// Wrong: a section would be a curve or a frame and no filled section, each ring have its own shape for an eye, or
/// round-off choose which of equal balls is shown.
#[test]
fn sections_are_filled_and_to_scale_at_the_first_of_equal_balls() {
    let dir = Dir::with_meshes();
    dir.run("out", &["--set", "effects.radial_force=none"]);
    assert_eq!(dir.raceway(&["plot", "out"]).code, Some(0));
    for side in ["inner", "outer"] {
        let svg = dir.text(&format!("out/figures/section_{side}.svg"));
        let title = format!("Stress in the section of the {side} ring at ball 0, 0.0 deg, step 0");
        assert!(svg.contains(&title), "{side}");
        let filled = svg.lines().filter(|line| line.starts_with("<polygon")).count();
        assert!(filled > 100, "{side}: {filled} polygons");
        let [width, height] = [0, 1].map(|component| extent_of_polygons(&svg, component));
        // The sections of the 7010C are 16 mm wide; from bore to shoulder 5.2 mm, from shoulder to seat 5.7 mm.
        let exact = 16.0 / if side == "inner" { 5.2 } else { 5.7 };
        assert_within(side, width / height, exact, 0.01 * exact);
    }
}

/// Extent of all filled polygons of a picture, pixels.
fn extent_of_polygons(svg: &str, component: usize) -> f64 {
    let polygons = svg.lines().filter(|line| line.starts_with("<polygon"));
    let points = polygons.filter_map(|line| line.split_once("points=\"")?.1.split('"').next());
    let places = points.flat_map(|points| points.split_whitespace().map(str::to_string).collect::<Vec<_>>());
    let values: Vec<f64> = places
        .filter_map(|place| place.split(',').nth(component)?.parse().ok())
        .collect();
    let [low, high] = values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &v| {
            [a.min(v), b.max(v)]
        });
    high - low
}

/// Wrong: an axis would be stretched until round-off looks like a result: contact angles of a bearing without them.
#[test]
fn round_off_is_no_range_of_an_axis() {
    let dir = Dir::with_scene(SCENE);
    // All balls carry the same without a radial force.
    dir.run(
        "out",
        &[&RIGID[..], &["--set", "effects.radial_force=none"]].concat(),
    );
    assert_eq!(dir.raceway(&["plot", "out"]).code, Some(0));
    for name in ["ball_force", "contact_angle"] {
        let svg = dir.text(&format!("out/figures/{name}.svg"));
        let texts = svg.lines().map(str::trim);
        let ticks: Vec<f64> = texts
            .filter_map(|text| text.parse().ok())
            .filter(|tick: &f64| tick % 45.0 != 0.0)
            .collect();
        let [low, high] = ticks
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &v| {
                [a.min(v), b.max(v)]
            });
        assert!(ticks.len() > 2 && high - low > 0.02 * high, "{name}: {ticks:?}");
    }
}

/// Wrong: a motion of a bearing that does not turn would show its whole history as a bar at one azimuth.
#[test]
fn a_bearing_that_does_not_turn_is_shown_in_time() {
    let still = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", still));
    dir.run("out", &[&RIGID[..], &["--set", "shaft.mass=0.5 kg"]].concat());
    assert_eq!(dir.raceway(&["plot", "out"]).code, Some(0));
    let svg = dir.text("out/figures/ball_force.svg");
    assert!(svg.contains("Contact force of ball 0, which does not turn") && svg.contains("time (ms)"));
    assert!(!svg.contains("azimuth"));
}

/// Wrong: a sweep of many points would have no room for a name of each, so that its figures fail or its legend covers
/// them. Points are told apart by shades then, with a bar of the swept value from its first to its last.
#[test]
fn a_sweep_of_fifty_points_has_a_colour_bar_and_no_legend() {
    // Ticks have two points, a curve one for each ball.
    const LENGTH_OF_A_CURVE: usize = 150;
    let sweep =
        "[sweep]\nkey = \"effects.radial_force.value\"\nfrom = \"0 kN\"\nto = \"2.45 kN\"\nsteps = 49";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", sweep));
    dir.run("out", &RIGID);
    assert_eq!(Table::read(&dir, "out/shaft.csv").column("step").len(), 50);
    let outcome = dir.raceway(&["plot", "out"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert!(!outcome.stderr.contains("warning"), "{}", outcome.stderr);
    for name in ["ball_force_round", "contact_angle_round", "peak_pressure_round"] {
        let svg = dir.text(&format!("out/figures/{name}.svg"));
        assert_eq!(figure::clashes(&svg).unwrap(), Vec::<String>::new(), "{name}");
        let texts: Vec<&str> = svg.lines().map(str::trim).collect();
        assert!(texts.contains(&"radial force (N)"), "{name}: no bar");
        // A curve for each point; texts are the ticks of two axes and of the bar, their names and the title.
        let lines = svg.lines().filter(|line| line.starts_with("<polyline"));
        let curves = lines.filter(|line| line.len() > LENGTH_OF_A_CURVE).count();
        let words = svg.lines().filter(|line| line.starts_with("<text")).count();
        assert_eq!(curves, 50, "{name}");
        assert!(words < 40, "{name}: {words} texts");
        assert!(dir.path(&format!("out/figures/{name}.png")).is_file());
    }
    let all = dir.text("out/figures/shaft_displacement.svg");
    assert_eq!(figure::clashes(&all).unwrap(), Vec::<String>::new());
}

/// Wrong: a label would lie on another or be cut off, or an axis would not tell its unit.
#[test]
fn figures_of_runs_can_be_read() {
    let dir = plotted();
    for folder in ["sweep/figures/", "motion/figures/"] {
        for name in names(&dir, folder, ".svg") {
            let svg = dir.text(&format!("{folder}{name}.svg"));
            assert_eq!(figure::clashes(&svg).unwrap(), Vec::<String>::new(), "{name}");
            let units = svg.lines().filter(|line| line.trim_end().ends_with(')')).count();
            let axes = if name.starts_with("raceway_") { 3 } else { 2 };
            assert!(units >= axes, "{name}: {units} of {axes} axes have a unit");
            assert!(svg.len() < 400_000, "{name}: {} bytes", svg.len());
        }
    }
}

/// Wrong: the figure would show other numbers than the table.
#[test]
fn a_figure_shows_the_numbers_of_the_table() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    assert_eq!(dir.raceway(&["plot", "out", "--out", "pictures"]).code, Some(0));
    let svg = dir.text("pictures/ball_force.svg");
    let attribute = |line: &str, name: &str| -> Option<f64> {
        let (_, rest) = line.split_once(&format!("{name}=\""))?;
        rest.split('"').next()?.parse().ok()
    };
    // The first series has circles; the first circle after them is the sample in the legend.
    let circles = svg.lines().filter(|line| line.starts_with("<circle"));
    let places: Vec<[f64; 2]> = circles
        .filter_map(|line| Some([attribute(line, "cx")?, attribute(line, "cy")?]))
        .collect();
    let table = Table::read(&dir, "out/balls.csv");
    let (azimuth, force) = (table.column("azimuth_rad"), table.column("inner_force_n"));
    assert_eq!(
        places.len(),
        force.len() + 2,
        "balls, the first again at 360 deg, and the legend"
    );
    let y_scale = (places[9][1] - places[0][1]) / (force[9] - force[0]);
    let x_scale = (places[9][0] - places[0][0]) / (azimuth[9] - azimuth[0]);
    assert!(y_scale < 0.0 && x_scale > 0.0, "{x_scale} {y_scale}");
    for i in 0..force.len() {
        // Places are whole tenths of a pixel.
        assert_within(
            "force",
            places[i][1],
            places[0][1] + y_scale * (force[i] - force[0]),
            1.5,
        );
        assert_within(
            "azimuth",
            places[i][0],
            places[0][0] + x_scale * (azimuth[i] - azimuth[0]),
            1.5,
        );
    }
}

/// Wrong: a wrong folder, ball or step would end in a crash or an empty picture.
#[test]
fn what_cannot_be_plotted_is_said() {
    let dir = plotted();
    std::fs::create_dir(dir.path("empty")).unwrap();
    let refused = |arguments: &[&str], expected: &str| {
        let outcome = dir.raceway(&[&["plot"], arguments].concat());
        assert_eq!(outcome.code, Some(2), "{arguments:?}");
        assert!(
            outcome.stderr.contains(expected),
            "{arguments:?}: {}",
            outcome.stderr
        );
    };
    refused(
        &["nowhere"],
        "nowhere is no folder; expected the results of a run",
    );
    refused(&["empty"], "empty has nothing to plot");
    refused(
        &["motion", "--ball", "40"],
        "there is no ball 40; balls are 0 to 17",
    );
    for command in ["plot", "report"] {
        let told = dir.raceway(&[command, "motion", "--step", "7"]);
        let expected = "folder motion has no step 7; committed steps are 0 to 10, the nearest are 5 and 10";
        assert_eq!(told.code, Some(2));
        assert!(told.stderr.contains(expected), "{command}: {}", told.stderr);
    }
    refused(
        &["sweep", "--step", "77"],
        "folder sweep has no step 77; committed steps are 0 to 1, the nearest is 1",
    );
}

/// Wrong: results without their largest table, such as one that was left behind in a copy, would have no figures.
#[test]
fn what_is_there_is_drawn_without_the_table_of_balls() {
    let dir = plotted();
    for of in ["motion", "sweep"] {
        let figures = format!("{of}/figures/");
        let mut expected = names(&dir, &figures, ".svg");
        let title = || {
            let text = std::fs::read_to_string(dir.path(&format!("{figures}section_inner.svg"))).unwrap();
            let from = text.find("Stress in the section").unwrap();
            text[from..].split(", step").next().unwrap().to_string()
        };
        let by_table = title();
        std::fs::remove_file(dir.path(&format!("{of}/balls.csv"))).unwrap();
        std::fs::remove_dir_all(dir.path(&figures)).unwrap();
        let outcome = dir.raceway(&["plot", of]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        // The step files tell which ball carries most, and so where the sections are.
        let of_balls = ["ball_", "contact_angle", "peak_pressure"];
        expected.retain(|name| !of_balls.iter().any(|start| name.starts_with(start)));
        assert_eq!(names(&dir, &figures, ".svg"), expected, "{of}");
        // In motion the table has the ball in the middle of the step, and the step file where it ends.
        if of == "sweep" {
            assert_eq!(title(), by_table);
        }
    }
}

/// Wrong: a ball or a step that is chosen of a list would be passed over in silence.
#[test]
fn figures_of_a_list_have_no_ball_and_no_step_to_choose() {
    let dir = pair("[static]");
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    for choice in [["--ball", "99"], ["--step", "3"]] {
        let refused = dir.raceway(&[&["plot", "out"], &choice[..]].concat());
        assert_eq!(refused.code, Some(2), "{}", refused.stdout);
        let expected =
            "--ball and --step choose from the figures of one bearing: out has the results of several";
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    }
}

/// Wrong: every reason would stand twice, so that one missing file fills the screen.
#[test]
fn figures_that_cannot_be_made_have_their_reason_once() {
    let dir = plotted();
    std::fs::remove_file(dir.path("sweep/mesh.hdf")).unwrap();
    let told = dir.raceway(&["plot", "sweep"]);
    assert_eq!(told.code, Some(2), "{}", told.stdout);
    let reasons: Vec<&str> = told.stderr.split("; figures of").collect();
    assert!(reasons.len() > 1, "{}", told.stderr);
    for reason in reasons {
        assert_eq!(reason.matches("No such file").count(), 1, "{}", told.stderr);
    }
}
