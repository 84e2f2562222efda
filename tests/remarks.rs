//! What a run says before it begins and keeps in its summary: slips, steps that resolve too little, advice of rules of
//! thumb; and meshes and steps that are refused because nothing could be right.

use mesh::{Facet, Mesh, MshFormat, Overwrite, RingSide};

use crate::util::rings::{self, TINY};
use crate::util::tables::summary;
use crate::util::{Dir, Outcome, RIGID, SCENE, with_line};

/// The scene with tiny meshes.
fn tiny() -> Dir {
    let dir = Dir::with_scene(SCENE);
    let [inner, outer] = rings::tiny_texts();
    dir.write("inner.msh", inner);
    dir.write("outer.msh", outer);
    dir
}

/// Rigid rings that turn at 1800 rpm, with an analysis and more `--set`.
pub fn turning(command: &str, analysis: &str, sets: &[&str]) -> (Dir, Outcome) {
    let speed = format!("[speed]\ninner = \"1800 rpm\"\n\n{analysis}");
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &speed));
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let out: &[&str] = if command == "run" { &["--out", "out"] } else { &[] };
    let arguments: Vec<&str> = [&[command, "scene.toml"], out, &RIGID[..]]
        .concat()
        .into_iter()
        .chain(sets)
        .collect();
    let outcome = dir.raceway(&arguments);
    (dir, outcome)
}

pub fn texts(dir: &Dir, key: &str) -> Vec<String> {
    let list = summary(dir, "out")[key].as_array().unwrap().clone();
    list.iter()
        .map(|text| text.as_str().unwrap().to_string())
        .collect()
}

#[track_caller]
fn assert_refused(dir: &Dir, arguments: &[&str], parts: &[&str]) {
    let outcome = dir.raceway(arguments);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    for part in parts {
        assert!(
            outcome.stderr.contains(part),
            "expected\n{part}\nin\n{}",
            outcome.stderr
        );
    }
}

const MOVING: &str = "[dynamic]\nduration = \"1 ms\"\nstep = \"20 us\"\noutput_every = 50";

/// Wrong: a mass beside the axis point would lack its coupling in silence, or the advice come where nothing tilts.
#[test]
fn a_mass_beside_the_axis_point_is_told() {
    let said = |sets: &[&str]| turning("check", MOVING, sets).1.stdout;
    let free = ["shaft.tilt_x=\"free\"", "shaft.mass=\"1 kg\""];
    let part =
        "advice   shaft.mass has its inertia at the axis point, though its weight acts 30.0 mm beside it";
    let beside = said(&[free[0], free[1], "shaft.load_point=\"30 mm\""]);
    assert!(beside.contains(part), "{beside}");
    let at = said(&free);
    assert!(!at.contains("though its weight acts"), "{at}");
    let locked = said(&["shaft.mass=\"1 kg\"", "shaft.load_point=\"30 mm\""]);
    assert!(!locked.contains("though its weight acts"), "{locked}");
}

/// Wrong: 1.5 turns of the bearing in a step would draw no remark: balls change places unseen, and every number is
/// wrong. Balls of the 7010C pass its inner raceway 306 times per second at 1800 rpm.
#[test]
fn steps_in_which_balls_change_places_unseen_are_refused() {
    let slow = "[dynamic]\nduration = \"500 ms\"\nstep = \"50 ms\"";
    for command in ["check", "run"] {
        let (dir, outcome) = turning(command, slow, &[]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        let part = "at 1800.0 rpm (1.500 turns a step) balls pass a point of the inner raceway 306.1";
        assert!(outcome.stderr.contains(part), "{}", outcome.stderr);
        let part = " 0.07 steps of 50 ms per period; expected 20 or more: dynamic.step of 160 us or less; with \
                    fewer than 2 no result is right";
        assert!(outcome.stderr.contains(part), "{}", outcome.stderr);
        assert!(!dir.path("out").exists());
    }
}

/// Wrong: a load of 50 kHz at steps of 20 us, whose mean over a step is nothing, would be left out in silence.
#[test]
fn a_harmonic_of_which_a_step_takes_the_mean_is_refused() {
    let set =
        "effects.radial_force.schedule.harmonic={ frequency = \"50 kHz\", mean = 1.0, amplitude = 0.5 }";
    let (_, outcome) = turning("check", MOVING, &[set]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let part = "effects.radial_force.schedule: a harmonic of 50000 Hz, 1.00 steps of 20 us per period; expected 20 or \
                more: dynamic.step of 1 us or less";
    assert!(outcome.stderr.contains(part), "{}", outcome.stderr);
}

/// Wrong: steps that resolve badly would be warned of by `check` alone, or by the terminal and not by the summary;
/// equilibria in time, each right for itself, would be refused.
#[test]
fn steps_that_resolve_badly_are_warned_of_and_stand_in_the_summary() {
    let coarse = "[dynamic]\nduration = \"5 ms\"\nstep = \"500 us\"";
    let (dir, outcome) = turning(
        "run",
        coarse,
        &["shaft.mass=0.5 kg", "dynamic.ledger_tolerance=1"],
    );
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let part = " 6.53 steps of 500 us per period; expected 20 or more: dynamic.step of 160 us or less";
    assert!(outcome.stderr.contains(part), "{}", outcome.stderr);
    assert!(texts(&dir, "warnings").iter().any(|text| text.contains(part)));
    let wide = "[quasi_static]\nduration = \"150 ms\"\nstep = \"50 ms\"";
    let (_, outcome) = turning("check", wide, &[]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let part = "advice   at 1800.0 rpm (1.500 turns a step) balls pass a point of the outer raceway 233.9";
    assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
}

/// Wrong: a load that never comes, or comes within a step, would be computed as none.
#[test]
fn schedules_that_the_steps_do_not_show_are_warned_of() {
    for (schedule, part) in [
        (
            "impact={ start = \"2 ms\", duration = \"1 ms\" }",
            "effects.radial_force.schedule: the impact begins at 2 ms, the run ends at 1 ms",
        ),
        (
            "impact={ start = \"0 ms\", duration = \"50 us\" }",
            "an impact of 50 us is 2.50 steps of 20 us; expected 10 or more: dynamic.step of 5 us or less; its \
             impulse is whole",
        ),
        (
            "step={ at = \"1 s\" }",
            "effects.radial_force.schedule: the step is at 1 s, the run ends at 1 ms",
        ),
        (
            "table={ times = [\"0 s\", \"1 us\"], factors = [0.0, 1.0] }",
            "effects.radial_force.schedule: its points are 1 us apart, less than a step of 20 us",
        ),
    ] {
        let set = format!("effects.radial_force.schedule.{schedule}");
        let (_, outcome) = turning("check", MOVING, &[&set]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert!(
            outcome.stdout.contains(part),
            "expected\n{part}\nin\n{}",
            outcome.stdout
        );
    }
    let (_, outcome) = turning("check", MOVING, &[]);
    assert!(!outcome.stdout.contains("schedule"), "{}", outcome.stdout);
}

/// Wrong: `run` would keep silent about what `check` advises: balls at 12 000 rpm without their centrifugal force.
#[test]
fn a_run_says_what_check_advises() {
    // 100 N of thrust are a fifth of the centrifugal forces.
    let thrust = "effects.axial_force.value=100 N";
    let sets = ["speed.inner=12000 rpm", "shaft.mass=0.5 kg", thrust];
    let (_, checked) = turning("check", MOVING, &sets);
    let advised = checked
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix("advice   "));
    let advised: Vec<&str> = advised.filter(|line| line.starts_with("[effects.")).collect();
    let rules = ["ball_centrifugal] is", "cage_slip] is off, but balls may skid"];
    for part in rules {
        let is_said = advised.iter().any(|line| line[9..].starts_with(part));
        assert!(is_said, "{}", checked.stdout);
    }
    let (dir, outcome) = turning("run", MOVING, &sets);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for line in &advised {
        assert!(
            outcome.stderr.contains(&format!("advice: {line}")),
            "{}",
            outcome.stderr
        );
    }
    let kept = texts(&dir, "advice");
    assert!(
        advised.iter().all(|line| kept.iter().any(|kept| kept == line)),
        "{kept:?}"
    );
}

/// Wrong: two columns of probes.csv would have one name.
#[test]
fn probes_of_two_kinds_with_one_name_are_refused() {
    let probes = "[probes.node.a]\nring = \"inner\"\nazimuth = \"0 deg\"\ngroove_angle = \"15 deg\"\n\n\
                  [probes.point.a]\nring = \"inner\"\nazimuth = \"0 deg\"\ngroove_angle = \"15 deg\"\n\
                  depth = \"0.1 mm\"\n\n[static]";
    let dir = tiny();
    dir.write("scene.toml", with_line("[static]", "[static]", probes));
    let part = "[probes.node.a] and [probes.point.a] have one name, with which their columns in probes.csv begin; \
                expected another name for one of them";
    assert_refused(&dir, &["run", "scene.toml", "--out", "out"], &[part]);
    dir.write(
        "scene.toml",
        with_line("[static]", "[static]", &probes.replace("point.a", "point.b")),
    );
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// Wrong: a second run would go elsewhere with one line at its end, and `plot` of the first folder would show the old
/// results.
#[test]
fn a_second_run_says_where_it_goes_and_plot_says_that_there_is_a_later_one() {
    let dir = Dir::with_scene(SCENE);
    let run = [&["run", "scene.toml"], &RIGID[..]].concat();
    assert!(!dir.raceway(&run).stderr.contains("earlier run"));
    let second = dir.raceway(&run);
    let part = "note: results/scene holds an earlier run; this one goes to results/scene-2";
    assert!(second.stderr.contains(part), "{}", second.stderr);
    let plotted = dir.raceway(&["plot", "results/scene"]);
    assert_eq!(plotted.code, Some(0), "{}", plotted.stderr);
    let part = "note: results/scene-2 holds a later run; this is results/scene";
    assert!(plotted.stderr.contains(part), "{}", plotted.stderr);
    assert!(
        !dir.raceway(&["plot", "results/scene-2"])
            .stderr
            .contains("later run")
    );
}

/// Wrong: a slip that the terminal warns of would be lost with it.
#[test]
fn slips_stand_in_the_summary() {
    let dir = tiny();
    let run = [
        "run",
        "scene.toml",
        "--out",
        "out",
        "--set",
        "bearing.bore_diameter=48 mm",
    ];
    let outcome = dir.raceway(&run);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let part = "mesh inner.msh has a bore with a mean diameter of 50 mm, but bearing.bore_diameter is 48 mm";
    assert!(texts(&dir, "warnings").iter().any(|text| text.starts_with(part)));
}

/// Wrong: a stiffness for a comparison, such as nearly rigid contacts, would be refused, or a slip of its unit pass
/// without a word.
#[test]
fn an_unusual_stiffness_is_warned_of_and_solved() {
    let dir = Dir::with_scene(&with_line(
        "[contact]",
        "mode",
        "mode = \"patch\"\nouter_stiffness = \"8.09e8 N/mm^1.5\"",
    ));
    let run = [&["run", "scene.toml", "--out", "out"], &RIGID[..]].concat();
    let outcome = dir.raceway(&run);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let part = " times E* sqrt(ball_diameter), the size of exact Hertz; check its unit, N/mm^1.5 is usual";
    assert!(outcome.stderr.contains(part), "{}", outcome.stderr);
    assert!(
        texts(&dir, "warnings")
            .iter()
            .any(|text| text.starts_with("contact.outer_stiffness is "))
    );
}

/// Wrong: long motions would write tables that nobody can read; a thinned table would lack rows of steps with fields,
/// or a run that was resumed would have other tables.
#[test]
fn tables_are_thinned_and_keep_the_rows_of_step_files() {
    use crate::util::tables::Table;
    let thinned =
        "[dynamic]\nduration = \"1 ms\"\nstep = \"20 us\"\noutput_every = 20\n\n[output]\ntables_every = 8";
    let (dir, outcome) = turning("run", thinned, &["shaft.mass=0.5 kg"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let expected = [0.0, 8.0, 16.0, 20.0, 24.0, 32.0, 40.0, 48.0, 50.0];
    for name in ["shaft", "energy"] {
        assert_eq!(
            Table::read(&dir, &format!("out/{name}.csv")).column("step"),
            expected,
            "{name}"
        );
    }
    assert_eq!(
        Table::read(&dir, "out/balls.csv").column("step").len(),
        18 * expected.len()
    );
    let whole = dir.text("out/balls.csv");
    let resumed = dir.raceway(&["resume", "out", "--step", "20"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_eq!(dir.text("out/balls.csv"), whole);
    let at_rest = "[static]\n\n[effects.ball_centrifugal]\n\n[output]\ntables_every = 8";
    let (_, refused) = turning("check", at_rest, &[]);
    let part =
        "output.tables_every does nothing without steps in time, [dynamic] or [quasi_static]; remove it";
    assert!(refused.stderr.contains(part), "{}", refused.stderr);
}

/// Wrong: of a long scene a user would have to search the line that a problem is on.
#[test]
fn problems_name_the_lines_of_the_file() {
    let text = with_line("[materials.balls]", "poisson_ratio", "poisson_ratio = 0.9")
        .replace("balls = 18", "balls = 1");
    let dir = Dir::with_scene(&text);
    let check = [&["check", "scene.toml"], &RIGID[..]].concat();
    let outcome = dir.raceway(&check);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    for (problem, start) in [
        (
            "  bearing.balls is 1; expected a whole number from 3 ",
            "balls = 1",
        ),
        ("  materials.balls.poisson_ratio is 0.9; ", "poisson_ratio = 0.9"),
    ] {
        let line = 1 + text.lines().position(|line| line.starts_with(start)).unwrap();
        let said = outcome
            .stderr
            .lines()
            .find(|line| line.starts_with(problem))
            .unwrap_or(&outcome.stderr);
        assert!(said.ends_with(&format!(" (line {line})")), "{said}");
    }
    // A value that the command line gives stands in no line of the file.
    let dir = Dir::with_scene(SCENE);
    let outcome = dir.raceway(&[&check[..], &["--set", "shaft.mass=-1 kg"]].concat());
    assert!(
        outcome.stderr.contains("shaft.mass is -1 kg") && !outcome.stderr.contains("(line"),
        "{}",
        outcome.stderr
    );
}

/// The inner ring with a group of which `keeps` keeps the facets by the azimuth and the height of their centres.
fn with_group(group: &str, keeps: impl Fn(f64, f64) -> bool) -> Vec<u8> {
    let mut mesh = rings::ring(RingSide::Inner, TINY);
    let centre = |mesh: &Mesh, facet: Facet| {
        let nodes: Vec<[f64; 3]> = mesh.facet_nodes(facet).map(|n| mesh.nodes[n]).collect();
        [0, 1, 2].map(|i| nodes.iter().map(|x| x[i]).sum::<f64>() / nodes.len() as f64)
    };
    let kept: Vec<Facet> = mesh.group(group).to_vec();
    let kept = kept.into_iter().filter(|&facet| {
        let [x, y, z] = centre(&mesh, facet);
        keeps(y.atan2(x), z)
    });
    let kept: Vec<Facet> = kept.collect();
    mesh.groups.insert(group.to_string(), kept);
    rings::file(&mesh, 1e-3, MshFormat::Ascii)
}

/// Wrong: a bore that lacks half of its facets would hold half of the ring, with forces 21 % off and exit code 0.
#[test]
fn a_group_that_is_a_part_of_its_surface_is_refused_unless_it_is_meant() {
    let dir = tiny();
    let run = ["run", "scene.toml", "--out", "out"];
    for (group, keeps, part) in [
        (
            "bore",
            (|azimuth, _| azimuth > 0.0) as fn(f64, f64) -> bool,
            "group \"bore\" has 50.0 % of the circle and 50.0 % of the area of its surface: 54 of 108 faces",
        ),
        (
            "bore",
            |_, z| z > 0.0,
            "group \"bore\" has 100.0 % of the circle and 50.0 % of the area of its surface",
        ),
        (
            "raceway",
            |azimuth, z| !(0.0..0.4).contains(&azimuth) || z < 0.0,
            "group \"raceway\" has 100.0 % of the circle and 97.2 % of the area of its surface: 2 of 72 faces",
        ),
    ] {
        dir.write("inner.msh", with_group(group, keeps));
        let remedy = "add them to the group in the .geo, or, if a part is meant, say so in the scene: \
                      inner.partial = true";
        assert_refused(&dir, &run, &[part, remedy]);
    }
    dir.write("inner.msh", with_group("bore", |azimuth, _| azimuth > 0.0));
    let outcome = dir.raceway(&["check", "scene.toml", "--set", "inner.partial=true"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let part =
        "mesh inner.msh: group \"bore\" has 50.0 % of the circle and 50.0 % of the area of its surface";
    assert!(outcome.stdout.contains(part), "{}", outcome.stdout);
}

/// The section of the tiny mesh in a scene, and what `raceway mesh` writes into its file.
pub const SECTION: &str = "[inner.section]\nshoulder_diameters = [\"60.4 mm\", \"60.4 mm\"]\nelement = \"hex8\"\n\
                       sectors = 18\ngroove_elements = 4\nthickness_elements = 1\nshoulder_elements = 1\n\n[outer]";
const RECORD: &str = "bearing.bore_diameter = 50 mm; bearing.inner_raceway_diameter = 56.01 mm; \
                      bearing.inner_groove_radius = 4.65 mm; bearing.width = 16 mm; inner.groove_z = 0 mm; \
                      inner.section.shoulder_diameters = [60.4 mm, 60.4 mm]; inner.section.element = hex8; \
                      inner.section.sectors = 18; inner.section.groove_elements = 4; \
                      inner.section.thickness_elements = 1; inner.section.shoulder_elements = 1; \
                      inner.section.grading = 1";

/// Wrong: a stale mesh would give its own results under the scene's new section.
#[test]
fn a_mesh_of_another_section_is_refused_with_the_command_that_builds_it() {
    let dir = tiny();
    dir.write("scene.toml", with_line("[outer]", "[outer]", SECTION));
    let mesh = rings::ring(RingSide::Inner, TINY);
    mesh::write_msh_with_record(dir.path("inner.msh"), &mesh, 1e-3, Overwrite::Replace, RECORD).unwrap();
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for (set, difference) in [
        (
            "inner.section.groove_elements=24",
            "inner.section.groove_elements = 4, but the scene says 24",
        ),
        (
            "inner.section.shoulder_diameters=[\"60.0 mm\", \"60.4 mm\"]",
            "inner.section.shoulder_diameters = [60.4 mm, 60.4 mm], but the scene says [60 mm, 60.4 mm]",
        ),
        (
            "bearing.width=17 mm",
            "bearing.width = 16 mm, but the scene says 17 mm",
        ),
    ] {
        let command = format!(
            "build the mesh of this scene: raceway mesh scene.toml --set '{set}' --force, which needs Gmsh"
        );
        let difference = format!("error: mesh inner.msh was made with {difference}");
        let run = ["run", "scene.toml", "--out", "out", "--set", set];
        assert_refused(&dir, &run, &[&difference, &command]);
    }
}

/// Wrong: a mesh that was built before meshes had a record would be solved under any section without a word.
#[test]
fn a_mesh_without_a_record_of_its_section_is_said() {
    let dir = tiny();
    let said = "mesh inner.msh does not say from which section it was made, so that it may be another one than \
                [inner.section]; if raceway mesh made it, build it anew: raceway mesh scene.toml --force, which needs \
                Gmsh";
    // The outer ring has no section to compare with.
    assert!(
        !dir.raceway(&["check", "scene.toml"])
            .stdout
            .contains("does not say")
    );
    dir.write("scene.toml", with_line("[outer]", "[outer]", SECTION));
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert!(
        outcome.stdout.contains(&format!("advice   {said}")),
        "{}",
        outcome.stdout
    );
    assert_eq!(
        outcome.stdout.matches("does not say").count(),
        1,
        "{}",
        outcome.stdout
    );
    let outcome = dir.run("out", &[]);
    assert!(
        outcome.stderr.contains(&format!("warning: {said}")),
        "{}",
        outcome.stderr
    );
    assert!(texts(&dir, "warnings").contains(&said.to_string()));
}

/// Wrong: `info` would call a mesh a damaged step file, or not say what it was made from.
#[test]
fn info_says_what_a_mesh_holds_and_what_it_was_made_from() {
    let dir = tiny();
    let mesh = rings::ring(RingSide::Inner, TINY);
    mesh::write_msh_with_record(dir.path("inner.msh"), &mesh, 1e-3, Overwrite::Replace, RECORD).unwrap();
    let outcome = dir.raceway(&["info", "inner.msh"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for part in [
        "file       inner.msh, ",
        "mesh       108 hex8, 252 nodes, 756 dofs",
        "size       diameters 50 to 60.4, z from -8 to 8, in the unit of the file",
        "group      bore, 108 facets",
        "group      raceway, 72 facets",
        RECORD,
    ] {
        assert!(
            outcome.stdout.contains(part),
            "expected\n{part}\nin\n{}",
            outcome.stdout
        );
    }
    dir.write("torn.msh", &std::fs::read(dir.path("inner.msh")).unwrap()[..900]);
    let outcome = dir.raceway(&["info", "torn.msh"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(!outcome.stderr.contains("seal"), "{}", outcome.stderr);
}

/// Wrong: the message on a groove that does not fit would not name the command that makes the mesh fit.
#[test]
fn a_groove_that_does_not_fit_names_the_command_where_the_scene_has_a_section() {
    let dir = tiny();
    dir.write("scene.toml", with_line("[outer]", "[outer]", SECTION));
    let set = "bearing.inner_raceway_diameter=56.1 mm";
    let run = ["run", "scene.toml", "--out", "out", "--set", set];
    let command = format!("or build the mesh of this scene: raceway mesh scene.toml --set '{set}' --force");
    assert_refused(&dir, &run, &["off the groove torus", &command]);
}
