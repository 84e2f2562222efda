//! Scenes whose values make no sense, and the essential parts of their messages.

use super::{Case, EXAMPLE, Scene, assert_messages, message_of, with_line};

/// Values that make no sense.
const INVALID: [Case; 62] = [
    (
        "cut",
        "cut = [{ azimuth = [\"96 deg\", \"84 deg\"] }]",
        &[
            "inner.cut 1: azimuth is 96 deg to 84 deg; expected a second azimuth beyond the first, by at most 360 deg",
        ],
    ),
    (
        "cut",
        "cut = [{ azimuth = [\"0 deg\", \"9 deg\"], radius = [\"26 mm\", \"25 mm\"] }]",
        &["inner.cut 1: radius is 26 mm to 25 mm; expected the smaller value first"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"-9 mm\"",
        &["bearing.ball_diameter is -9 mm; a diameter must be positive"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"0 mm\"",
        &["bearing.ball_diameter is 0 mm; a diameter must be positive"],
    ),
    (
        "ball_diameter",
        "ball_diameter = \"9 km\"",
        &["bearing.ball_diameter is 9 km; check its unit, expected 10 um to 100 m"],
    ),
    (
        "width",
        "width = \"-16 mm\"",
        &["bearing.width is -16 mm; a width must be positive"],
    ),
    (
        "width",
        "width = \"8 mm\"",
        &["bearing.width is 8 mm; it must be at least the ball diameter 9 mm"],
    ),
    (
        "balls",
        "balls = 2",
        &["bearing.balls is 2; expected a whole number from 3 to 1000"],
    ),
    (
        "balls",
        "balls = -18",
        &["bearing.balls is -18; expected a whole number from 3 to 1000"],
    ),
    (
        "balls",
        "balls = 23",
        &["bearing.balls is 23; the balls overlap on the pitch circle of 65.0235 mm, at most 22 of 9 mm fit"],
    ),
    (
        "inner_groove",
        "inner_groove_radius = \"4.5 mm\"",
        &[
            "bearing.inner_groove_radius is 4.5 mm; it must be more than the ball radius 4.5 mm, 0.515 to 0.53",
        ],
    ),
    (
        "outer_groove",
        "outer_groove_radius = \"4.4 mm\"",
        &["bearing.outer_groove_radius is 4.4 mm; it must be more than the ball radius"],
    ),
    (
        "outer_groove",
        "outer_groove_radius = \"6 mm\"",
        &["bearing.outer_groove_radius is 6 mm; that is 0.667 of the ball diameter, more than 0.6"],
    ),
    (
        "inner_raceway",
        "inner_raceway_diameter = \"74.1 mm\"",
        &[
            "bearing.inner_raceway_diameter is 74.1 mm; it must be less than bearing.outer_raceway_diameter, which is \
             74.037 mm",
        ],
    ),
    (
        "inner_raceway",
        "inner_raceway_diameter = \"57 mm\"",
        &[
            "the diametral clearance -0.9630 mm",
            "the groove distance 0.4000 mm",
            "so large an interference is beyond small strain, check the diameters",
        ],
    ),
    (
        "outer_raceway",
        "outer_raceway_diameter = \"75 mm\"",
        &[
            "the diametral clearance 0.9900 mm",
            "is -0.2375; the balls would touch at 90 degrees or not at all",
        ],
    ),
    (
        "bore",
        "bore_diameter = \"57 mm\"",
        &[
            "bearing.bore_diameter is 57 mm; it must be less than bearing.inner_raceway_diameter, which is 56.01 mm",
        ],
    ),
    (
        "outside",
        "outside_diameter = \"74 mm\"",
        &[
            "bearing.outer_raceway_diameter is 74.037 mm; it must be less than bearing.outside_diameter, which is 74 \
             mm",
        ],
    ),
    (
        "young",
        "young_modulus = \"207 Pa\"",
        &["materials.rings.young_modulus is 207 Pa; expected 1 kPa to 10 TPa"],
    ),
    (
        "young",
        "young_modulus = \"207 TPa\"",
        &["materials.rings.young_modulus is 207 TPa; expected 1 kPa to 10 TPa"],
    ),
    (
        "poisson",
        "poisson_ratio = 0.5",
        &["materials.rings.poisson_ratio is 0.5; expected 0 to 0.49"],
    ),
    (
        "poisson",
        "poisson_ratio = -0.1",
        &["materials.rings.poisson_ratio is -0.1; expected 0 to 0.49"],
    ),
    (
        "poisson",
        "poisson_ratio = nan",
        &["materials.rings.poisson_ratio is NaN; expected 0 to 0.49"],
    ),
    (
        "poisson",
        "poisson_ratio = 0.4999",
        &["materials.rings.poisson_ratio is 0.4999; displacement elements lock above 0.49"],
    ),
    (
        "density",
        "density = \"7.8 mg/m3\"",
        &["materials.rings.density is 7.8 mg/m3; expected 1 kg/m3 to 1e5 kg/m3"],
    ),
    (
        "inner_stiffness",
        "inner_stiffness = \"-1 N/mm^1.5\"",
        &["contact.inner_stiffness is -1 N/mm^1.5; a stiffness must be positive"],
    ),
    (
        "outer_stiffness",
        "outer_stiffness = \"8.09e20 N/m^1.5\"",
        &[
            "contact.outer_stiffness is 8.09e20 N/m^1.5; that is 7.5e10 times E* sqrt(ball_diameter), check its unit",
        ],
    ),
    (
        "patch_length",
        "patch_length = \"-1 mm\"",
        &["contact.patch_length is -1 mm; expected 0 mm to a ball diameter, 0.21 of one is usual"],
    ),
    (
        "patch_length",
        "patch_length = \"1.89 m\"",
        &["contact.patch_length is 1.89 m; expected 0 mm to a ball diameter, 0.21 of one is usual"],
    ),
    (
        "patch_elements",
        "patch_elements = 0",
        &["contact.patch_elements is 0; expected 0.5 to 20 element sizes"],
    ),
    (
        "patch_elements",
        "patch_elements = 1e300",
        &["contact.patch_elements is 1e300; expected 0.5 to 20 element sizes"],
    ),
    (
        "patch_elements",
        "patch_elements = inf",
        &["contact.patch_elements is inf; expected 0.5 to 20 element sizes"],
    ),
    (
        "mode",
        "mode = \"rigid\"",
        &[
            "2 problems",
            "inner.flexible is true but contact.mode is \"rigid\"; set inner.flexible = false, or contact.mode \
             = \"patch\"",
            "outer.flexible is true (the default) but contact.mode is \"rigid\"; set outer.flexible = false",
        ],
    ),
    (
        "mesh =",
        "",
        &["inner.mesh is missing; a flexible ring needs a mesh file, or set inner.flexible = false"],
    ),
    (
        "mesh_unit",
        "",
        &["inner.mesh_unit is missing; a flexible ring needs the unit of its mesh such as \"mm\""],
    ),
    (
        "mesh_unit",
        "mesh_unit = \"N\"",
        &["inner.mesh_unit: \"N\" is a force; expected a unit of length such as \"mm\""],
    ),
    (
        "support",
        "",
        &[
            "inner.support is missing; a flexible ring needs to know how its bore is held, \"clamped\" \
             or \"mean_motion\"",
        ],
    ),
    (
        "groove_z",
        "groove_z = \"8 m\"",
        &["inner.groove_z is 8 m; that is more than ten bearing widths"],
    ),
    (
        "sectors",
        "sectors = 100",
        &["inner.section.sectors is 100; it must be a multiple of the 18 balls, such as 90 or 108, so that"],
    ),
    (
        "sectors",
        "sectors = 5",
        &["inner.section.sectors is 5; it must be a multiple of the 18 balls, such as 18, so"],
    ),
    (
        "groove_elements",
        "groove_elements = 0",
        &["inner.section.groove_elements is 0; expected a whole number from 2 to 1000"],
    ),
    (
        "grading",
        "grading = 0.2",
        &["inner.section.grading is 0.2; expected 1 (uniform) to 3"],
    ),
    // Wrong: Gmsh would be blamed for nodes at one place.
    (
        "thickness_elements",
        "thickness_elements = 60",
        &[
            "inner.section.grading is 1.2; with 60 thickness_elements the last would be 4.7e4 times the first; \
             expected at most 1e4 times: a grading of at most 1.168, or fewer thickness_elements",
        ],
    ),
    (
        "shoulder_diameters",
        "shoulder_diameters = [\"56 mm\", \"60.4 mm\"]",
        &[
            "inner.section.shoulder_diameters[0] is 56 mm; a shoulder must lie between the bottom and the centre of \
             the groove, 56.01 mm to 65.31 mm",
        ],
    ),
    (
        "z =",
        "z = \"12 mm\"",
        &["shaft.z is 12 mm; a prescribed displacement must be less than a ball radius"],
    ),
    (
        "tilt_y",
        "tilt_y = \"5 deg\"",
        &["shaft.tilt_y is 5 deg; a prescribed tilt must be small, at most 55 mrad"],
    ),
    (
        "load_point",
        "load_point = \"20 m\"",
        &["shaft.load_point is 20 m; that is more than 100 outside diameters"],
    ),
    (
        "value = \"2 kN\"",
        "value = \"2 TN\"",
        &["effects.axial_force.value is 2 TN; that is more than any bearing carries"],
    ),
    (
        "acceleration",
        "acceleration = \"-9.81 m/s2\"",
        &["effects.gravity.acceleration is -9.81 m/s2; expected 0 to 1e7 m/s2"],
    ),
    (
        "direction = [",
        "direction = [0.0, 0.0, 0.0]",
        &[
            "effects.gravity.direction is [0.0, 0.0, 0.0]; expected a vector with a direction such as [0.0, -1.0, 0.0]",
        ],
    ),
    (
        "tolerance",
        "tolerance = 1.0",
        &["solver.tolerance is 1; expected 1e-14 to 1e-2, it is relative to the loads"],
    ),
    (
        "max_iterations",
        "max_iterations = 0",
        &["solver.max_iterations is 0; expected a whole number from 1 to 10000"],
    ),
    (
        "compression",
        "compression = 12",
        &["output.compression is 12; expected a whole number from 0 to 9"],
    ),
    (
        "compression",
        "stress_error = \"0.5 kPa\"",
        &["output.stress_error is 0.5 kPa; expected at least 1 kPa; precision = \"f64\" allows 1 Pa"],
    ),
    (
        "precision",
        "precision = \"f64\"\nstress_error = \"0.5 Pa\"",
        &["output.stress_error is 0.5 Pa; expected at least 1 Pa"],
    ),
    (
        "compression",
        "stress_error = \"1 GPa\"",
        &["output.stress_error is 1 GPa; expected at most 100 MPa"],
    ),
    (
        "stress =",
        "stress = \"none\"\nstress_error = \"10 kPa\"",
        &["output.stress_error does nothing with output.stress = \"none\"; remove it"],
    ),
    (
        "compression",
        "displacement = \"f32\"",
        &[
            "output.displacement is \"f32\"; expected \"f64\" without a motion, [dynamic], whose state \
             holds it exactly",
        ],
    ),
    (
        "compression",
        "restart_every = 2",
        &[
            "output.restart_every does nothing without a motion, [dynamic]: equilibria over time have a restart state \
             in every step file; remove it",
        ],
    ),
    (
        "[sweep]",
        "[static]\n[sweep]",
        &["the scene has both [static] and [sweep]; keep exactly one analysis"],
    ),
    (
        "values",
        "values = []",
        &["sweep.values is empty; expected at least one value"],
    ),
    (
        "values",
        "values = [\"0 kN\", 3]",
        &["sweep.values[1] is 3 while sweep.values[0] is \"0 kN\"; all must be of the same kind"],
    ),
];

/// If this failed, a bearing that cannot exist would be solved, or the message would not name key, value and
/// rule.
#[test]
fn values_that_make_no_sense_are_refused_with_key_value_and_rule() {
    assert_messages(EXAMPLE, &INVALID);
}

/// If this failed, one slip would drown in messages about its consequences, so that nobody finds it.
#[test]
fn one_slip_gives_one_problem() {
    for (line, replacement, parts) in &INVALID {
        let message = message_of(&with_line(line, replacement), &[]);
        let several = message.contains(" problems:");
        assert_eq!(several, parts[0] == "2 problems", "{replacement}: {message}");
    }
}

/// If this failed, the user would have to run the program once per mistake.
#[test]
fn all_problems_are_reported_together() {
    let text = with_line("poisson", "poisson_ratio = 0.7").replace("balls = 18", "balls = 1");
    let text = text
        .replace("compression = 0", "compression = 99")
        .replace("support = \"clamped\"", "");
    let message = message_of(&text, &[]);
    assert!(
        message.starts_with("scenes/test.toml has 5 problems:\n  bearing.balls is 1"),
        "{message}"
    );
    for key in [
        "materials.rings.poisson_ratio",
        "inner.support",
        "outer.support",
        "output.compression",
    ] {
        assert!(message.contains(&format!("\n  {key} is ")), "{key}: {message}");
    }
}

/// If this failed, a bearing loaded against its usual direction would be refused; whether balls hold the shaft is
/// only known when it is solved.
#[test]
fn a_shaft_free_along_its_axis_may_be_pushed_either_way() {
    let scene = super::parse(&with_line("value = \"2 kN\"", "value = \"-2 kN\""), &[]).unwrap();
    assert_eq!(
        super::axial_of(&scene),
        Some((-2000.0, input::Schedule::Constant))
    );
}

/// If this failed, sections whose shoulders run into each other would be meshed.
#[test]
fn shoulders_of_both_rings_must_leave_a_gap() {
    let section = "element = \"hex8\"\nsectors = 18\ngroove_elements = 4\nthickness_elements = 2\nshoulder_elements = \
                   2\n";
    let inner = with_line(
        "shoulder_diameters",
        "shoulder_diameters = [\"60.4 mm\", \"65 mm\"]",
    );
    let text = format!("{inner}\n[outer.section]\nshoulder_diameters = [\"68 mm\", \"64.8 mm\"]\n{section}");
    let message = message_of(&text, &[]);
    let expected = "inner.section.shoulder_diameters[1] is 65 mm; it must be less than \
                    outer.section.shoulder_diameters[1], which is 64.8 mm, or the rings touch";
    assert!(message.contains(expected), "{message}");
}

/// If this failed, a scene without a table would be told that its title lacks a key, and a device would
/// count as missing.
#[test]
fn a_missing_table_and_a_mesh_that_is_no_file_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let (head, tail) = EXAMPLE.split_once("[bearing]").unwrap();
    let rest = tail.split_once("\n[").unwrap().1;
    std::fs::write(&path, format!("{head}[{rest}")).unwrap();
    let message = Scene::load(&path, &[]).unwrap_err().to_string();
    assert!(message.contains("the table [bearing] is missing"), "{message}");
    std::fs::write(&path, EXAMPLE).unwrap();
    let message = Scene::load(&path, &["inner.mesh = \"/dev/null\"".into()])
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("inner.mesh is \"/dev/null\", but /dev/null is no plain file"),
        "{message}"
    );
}

/// If this failed, a wrong path would surface after minutes of set-up, without the place that was looked at or the
/// command that builds the mesh.
#[test]
fn a_missing_mesh_is_reported_as_typed_and_as_resolved() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    std::fs::create_dir(&scenes).unwrap();
    let path = scenes.join("scene.toml");
    std::fs::write(&path, EXAMPLE).unwrap();
    let message = Scene::load(&path, &[]).unwrap_err().to_string();
    let resolved = scenes.join("../meshes/7010c_inner.msh");
    let expected = format!(
        "inner.mesh is \"../meshes/7010c_inner.msh\", but there is no file {}; build it with \"raceway mesh {}\", \
         which needs Gmsh, or correct the path",
        resolved.display(),
        path.display()
    );
    assert!(message.contains(&expected), "{message}");
    assert!(
        message.contains("outer.mesh is \"../meshes/7010c_outer.msh\""),
        "{message}"
    );
    let changed = Scene::load(&path, &["inner.mesh = \"other.msh\"".into()]).unwrap_err();
    assert!(
        changed
            .to_string()
            .contains("scene.toml\" and the same --set, which needs Gmsh"),
        "{changed}"
    );
}
