//! Materials, units, starts and tilts at their limits.

use std::sync::Arc;

use dynamics::motion::Motion;
use dynamics::{StaticSolution, StaticSolver};
use fem::Material;
use mesh::{MshFormat, RingSide};

use super::bearings::{Load, SMALL, conserving, flexible, released, rigid, transient};
use super::course::march;
use super::record::Record;
use super::support::rings::Level;
use super::support::{Case, relative};
use super::{HardCase, Pace};
use crate::util::rings::{COARSE, file};
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, SCENE};

use super::meshes::{difference, loaded, rings, solve};

pub fn cases() -> Vec<HardCase> {
    let case = HardCase::new;
    vec![
        case(
            "nearly_incompressible",
            Pace::Slow,
            "Poisson's ratio 0.499 locks plain linear elements",
            "hex8 against hex20, 2 kN axial and 1 kN radial",
            incompressible,
        ),
        case(
            "density_contrast",
            Pace::Slow,
            "balls a million times as dense as rings, and the other way",
            "half the balls unload, both rings flexible, dt 5 us, 0.5 ms",
            density,
        ),
        case(
            "stiff_rings",
            Pace::Fast,
            "modulus 1e6 times steel's: conditioning, and the rigid limit",
            "2 kN axial and 1 kN radial, against rigid rings",
            stiff_rings,
        ),
        case(
            "soft_rings",
            Pace::Fast,
            "modulus 1e-6 of steel's under contacts of steel",
            "2 kN axial",
            soft_rings,
        ),
        case(
            "mesh_in_inches",
            Pace::Fast,
            "a mesh in units of its own",
            "the same mesh in inches and in micrometres, by the program",
            odd_units,
        ),
        case(
            "start_1_mm_off",
            Pace::Slow,
            "1 mm radially: 100 times the clearance, contact forces of 10^5 N",
            "rigid rings, shaft 0.5 kg, dt 0.5 us, 1 ms",
            far_start,
        ),
        case(
            "start_1_mm_off_flexible",
            Pace::Fast,
            "the same on rings that answer",
            "both rings flexible, dt 0.5 us",
            far_start_flexible,
        ),
        case(
            "tilt_5_deg",
            Pace::Fast,
            "outside small rotations",
            "imposed in a scene, and by a moment on a free tilt",
            tilt,
        ),
    ]
}

fn incompressible(record: &mut Record) {
    let at = |level: Level, ratio: f64| {
        let mut rings = rings(level);
        rings
            .iter_mut()
            .for_each(|r| r.material = Material::new(207e9, ratio, 7800.0).unwrap());
        solve(&loaded(rings)).unwrap()
    };
    let (hex8, hex20) = (
        at(Level::hex8(90, 8, 2, 3), 0.499),
        at(Level::hex20(54, 4, 1, 2), 0.499),
    );
    record.below(
        "ball forces, hex8 against hex20, nu 0.499",
        difference(&hex8, &hex20),
        1e-2,
    );
    let usual = (
        at(Level::hex8(90, 8, 2, 3), 0.3),
        at(Level::hex20(54, 4, 1, 2), 0.3),
    );
    record.note(format!(
        "the same at nu = 0.3: {:.1e}",
        difference(&usual.0, &usual.1)
    ));
    let strain = |a: &StaticSolution, b: &StaticSolution| relative(a.strain_energy, b.strain_energy);
    record.note(format!(
        "strain energy differs by {:.1e}, at 0.3 by {:.1e}",
        strain(&hex8, &hex20),
        strain(&usual.0, &usual.1)
    ));
}

fn density(record: &mut Record) {
    for (ball, ring) in [(7.8e9, 7.8e3), (7.8e3, 7.8e9)] {
        let mut model = flexible(Load::dead(1e3), Load::jump(0.0, 5e3));
        model.ball_material = Material::new(207e9, 0.3, ball).unwrap();
        let rings = rings(SMALL).map(|mut r| {
            r.material = Material::new(207e9, 0.3, ring).unwrap();
            Some(Arc::new(r))
        });
        model.rings = rings;
        let course = transient(&model, conserving(5e-6), 0.5e-3);
        record.closed(&course);
    }
}

fn stiff_rings(record: &mut Record) {
    let rings = rings(SMALL).map(|mut r| {
        r.material = Material::new(207e15, 0.3, 7800.0).unwrap();
        r
    });
    let stiff = solve(&loaded(rings)).unwrap();
    let limit = solve(&rigid(Load::dead(2e3), Load::dead(1e3))).unwrap();
    record.below(
        "ball forces against rigid rings",
        difference(&stiff, &limit),
        1e-5,
    );
    record.near(
        "z, m,",
        stiff.displacements.shaft[2],
        limit.displacements.shaft[2],
        1e-5,
    );
}

fn soft_rings(record: &mut Record) {
    let rings = rings(SMALL).map(|mut r| {
        r.material = Material::new(207e3, 0.3, 7800.0).unwrap();
        r
    });
    match solve(&loaded(rings)) {
        Ok(_) => record.that("rings like jelly under contacts of steel are refused", false),
        Err(error) => {
            let text = error.to_string();
            record.note(format!("\"{text}\""));
            let causes = ["takes more compliance than Hertz", "no equilibrium", "leaves the"];
            record.that(
                "the error names the cause",
                causes.iter().any(|c| text.contains(c)),
            );
        }
    }
}

fn odd_units(record: &mut Record) {
    let forces = |unit: &str, metres: f64| {
        let scene = SCENE.replace("mesh_unit = \"mm\"", &format!("mesh_unit = \"{unit}\""));
        let dir = Dir::with_scene(&scene);
        for (name, side) in [("inner.msh", RingSide::Inner), ("outer.msh", RingSide::Outer)] {
            dir.write(
                name,
                file(&crate::util::rings::ring(side, COARSE), metres, MshFormat::Binary),
            );
        }
        dir.run("out", &["--set", "output.stress=none"]);
        Table::read(&dir, "out/balls.csv").column("inner_force_n")
    };
    let usual = forces("mm", 1e-3);
    for (unit, metres) in [("in", 0.0254), ("um", 1e-6), ("km", 1e3)] {
        let other = forces(unit, metres);
        let worst = usual
            .iter()
            .zip(&other)
            .map(|(a, b)| relative(*a, *b))
            .fold(0.0, f64::max);
        record.below(&format!("change of a ball force, mesh in {unit},"), worst, 1e-9);
    }
}

fn far_start(record: &mut Record) {
    let model = rigid(Load::dead(1e3), Load::dead(0.0));
    let course = released(&model, conserving(5e-7), [1e-3, 0.0, 0.0, 0.0, 0.0], 1e-3);
    // 1 mm is more than the grooves hold: some balls are on no groove at all.
    record.says(
        &course.error.clone().unwrap_or_default(),
        "but no groove reaches beyond 90 deg",
    );
    let inside = released(&model, conserving(5e-7), [0.01e-3, 0.0, 0.05e-3, 0.0, 0.0], 1e-3);
    record.closed(&inside);
    record.note(format!(
        "from 10 um off in x and 50 um in z it flies, with up to {:.2e} N",
        inside.peak
    ));
    record.note_defect(course.defect);
    record.below("ledger defect", course.defect, super::record::LEDGER);
    let model = rigid(Load::dead(1e3), Load::dead(0.0));
    let far = StaticSolver::new(&model).unwrap();
    let mut solver = far;
    let rest = solver.solve(&model, None).unwrap();
    let mut start = solver.solve(&model, None).unwrap();
    start.displacements.shaft = [1e-3, -1e-3, 1e-3, 0.0, 0.0];
    let again = solver.solve(&model, Some(&start)).unwrap();
    record.below(
        "ball forces of statics from 1 mm off",
        difference(&rest, &again),
        1e-9,
    );
}

fn far_start_flexible(record: &mut Record) {
    let model = flexible(Load::dead(1e3), Load::dead(0.0));
    let motion = Motion::new(&model, conserving(5e-7)).unwrap();
    let state = motion.rest([1e-3, 0.0, 0.0, 0.0, 0.0], [0.0; 5]);
    let course = march(&motion, state, 2000);
    match &course.error {
        Some(error) => {
            record.note(format!("\"{error}\""));
            let causes = [
                "takes more compliance than Hertz",
                "leaves the",
                "it has left the bearing",
                "do not balance",
            ];
            record.that(
                "the error names the cause",
                causes.iter().any(|c| error.contains(c)),
            );
        }
        None => record.closed(&course),
    }
    record.below("ledger defect", course.defect, super::record::LEDGER);
}

fn tilt(record: &mut Record) {
    let dir = Dir::with_scene(SCENE);
    let arguments = [
        &["run", "scene.toml", "--out", "out", "--set", "shaft.tilt_x=5 deg"][..],
        &RIGID[..],
    ]
    .concat();
    let outcome = dir.raceway(&arguments);
    record.that("the program ends with code 2", outcome.code == Some(2));
    record.says(
        outcome.stderr.trim(),
        "a prescribed tilt must be small, at most 55 mrad",
    );
    let case = Case {
        moment: 1e7,
        free_tilt: true,
        ..Case::axial(1e3)
    };
    let error = solve(&case.rigid())
        .err()
        .map_or(String::new(), |e| e.to_string());
    record.says(&error, "rad, where small rotations end");
    let mut moving = case.rigid();
    moving.shaft_mass = 0.5;
    let course = released(&moving, conserving(1e-6), [0.0; 5], 1e-3);
    let error = course.error.unwrap_or_default();
    record.note(format!("in motion: \"{error}\""));
    record.that("motion stops with an error too", !error.is_empty());
}
