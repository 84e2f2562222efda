//! Meshes of another unit, bearing, axis or size than the scene's.

use mesh::{MshFormat, RingSide};

use super::meshes::tiny;
use super::{assert_refused, run};
use crate::util::rings::{self, TINY};
use crate::util::with_line;

/// If this failed, a mesh read in the wrong unit would give forces that are wrong by powers of a thousand.
#[test]
fn a_wrong_mesh_unit_is_refused_with_the_right_one() {
    let dir = tiny();
    for unit in ["m", "in", "um"] {
        dir.write(
            "scene.toml",
            with_line("[inner]", "mesh_unit", &format!("mesh_unit = \"{unit}\"")),
        );
        let parts = [
            "error: inner.msh: with a mesh unit of",
            "m across, expected about 5.6010e-2 m; the file's lengths seem to be in mm: state a mesh unit \
             of \"mm\"",
        ];
        assert_refused(unit, &dir, &[], &run(&[]), &parts);
    }
}

/// If this failed, the remedy of the message would not be one, for a drawing in inches.
#[test]
fn a_mesh_in_inches_is_refused_as_millimetres_and_read_as_inches() {
    let dir = tiny();
    dir.write(
        "inner.msh",
        rings::file(&rings::ring(RingSide::Inner, TINY), 0.0254, MshFormat::Ascii),
    );
    let part = "the file's lengths seem to be in in: state a mesh unit of \"in\" (0.0254 m)";
    assert_refused("inches", &dir, &[], &run(&[]), &[part]);
    let outcome = dir.raceway(&["check", "scene.toml", "--set", "inner.mesh_unit=in"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
}

/// If this failed, the mesh of one bearing would be solved with the contacts of another.
#[test]
fn the_mesh_of_another_bearing_is_refused() {
    let dir = tiny();
    let cases: [(&str, &[&str]); 4] = [
        (
            "bearing.inner_raceway_diameter=56.1 mm",
            &[
                "error: inner.msh: node ",
                "of group \"raceway\" is 4.500e-5 m off the groove torus",
                "compare the raceway diameter, groove radius and axial position with the .geo",
            ],
        ),
        (
            "bearing.outer_groove_radius=4.8 mm",
            &[
                "error: outer.msh: node ",
                "groove radius 4.800000e-3 m), more than",
            ],
        ),
        (
            "inner.groove_z=1 mm",
            &[
                "error: inner.msh: node ",
                "at z = 1.000000e-3 m",
                "the groove fits with its centre at z = 0 mm: state that as groove_z",
            ],
        ),
        (
            "inner.mesh=outer.msh",
            &["error: mesh outer.msh has no facet group \"bore\"; groups are \"raceway\", \"seat\""],
        ),
    ];
    for (change, parts) in cases {
        assert_refused(change, &dir, &[], &run(&["--set", change]), parts);
    }
}

/// If this failed, a drawing about another axis would be refused without a word about the axis.
#[test]
fn a_mesh_about_another_axis_is_named() {
    let dir = tiny();
    let mut mesh = rings::ring(RingSide::Inner, TINY);
    mesh.nodes
        .iter_mut()
        .for_each(|[x, y, z]| (*x, *y, *z) = (*z, *x, *y));
    dir.write("inner.msh", rings::file(&mesh, 1e-3, MshFormat::Ascii));
    let part = "the groove fits about the x axis: turn the mesh so that the bearing's axis is z";
    assert_refused("about x", &dir, &[], &run(&[]), &[part]);
}

/// If this failed, a scene could say one bearing, or a unit a thousand times too small, and solve another without a
/// word.
#[test]
fn slips_that_a_run_can_do_with_are_warned_of() {
    let dir = tiny();
    let slips = [
        (
            "bearing.bore_diameter=48 mm",
            "mesh inner.msh has a bore with a mean diameter of 50 mm, but bearing.bore_diameter is 48 mm",
        ),
        (
            "bearing.outside_diameter=82 mm",
            "mesh outer.msh has a seat with a mean diameter of 80 mm, but bearing.outside_diameter is 82 mm",
        ),
        (
            "bearing.width=20 mm",
            "mesh inner.msh has a width of 16 mm, but bearing.width is 20 mm",
        ),
        (
            "materials.rings.young_modulus=207 MPa",
            "materials.rings.young_modulus is 207 MPa; rings and balls have",
        ),
        (
            "materials.balls.density=7.8 kg/m3",
            "materials.balls.density is 7.8 kg/m3; rings and balls have",
        ),
    ];
    let sound = dir.raceway(&["check", "scene.toml"]).stdout;
    for (slip, part) in slips {
        let outcome = dir.raceway(&["check", "scene.toml", "--set", slip]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        assert!(
            outcome.stdout.contains(&format!("advice   {part}")),
            "{slip}: {}",
            outcome.stdout
        );
        assert!(!sound.contains(part), "{sound}");
    }
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "out", "--set", slips[0].0]);
    assert!(
        outcome.stderr.contains(&format!("warning: {}", slips[0].1)),
        "{}",
        outcome.stderr
    );
}
