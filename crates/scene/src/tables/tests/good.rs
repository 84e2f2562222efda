//! Scenes that must be read, and what they say.

use super::*;

/// If this failed, the documentation would show a scene that the program refuses or reads as something else.
#[test]
fn the_example_of_the_documentation_reads_as_it_says() {
    let scene = parse(EXAMPLE, &[]).unwrap();
    let b = scene.bearing;
    assert_eq!(
        (b.balls, b.ball_diameter, b.inner_raceway_diameter),
        (18, 9e-3, 56.01e-3)
    );
    assert_eq!(
        (b.outer_raceway_diameter, b.bore_diameter, b.outside_diameter),
        (74.037e-3, 50e-3, 80e-3)
    );
    assert_eq!(
        (b.inner_groove_radius, b.outer_groove_radius, b.width),
        (4.65e-3, 4.75e-3, 16e-3)
    );
    let steel = MaterialProperties {
        young_modulus: 207e9,
        poisson_ratio: 0.3,
        density: 7800.0,
        expansion: Some(11.5e-6),
        yield_strength: None,
    };
    assert_eq!(
        scene.materials,
        Materials {
            rings: steel,
            balls: steel
        }
    );
    assert_eq!(scene.contact.mode, ContactMode::Patch);
    assert_eq!(scene.shaft.z, ShaftMotion::Free);
    assert_eq!(scene.shaft.tilt_x, ShaftMotion::Locked);
    let effects = &scene.effects;
    let radial = effects.radial_force.as_ref().unwrap();
    assert_eq!(
        (radial.value.si(), radial.direction.si(), radial.schedule()),
        (1e3, 0.0, Schedule::Constant)
    );
    let moment = effects.moment.as_ref().unwrap();
    assert_eq!(
        (moment.x.si(), moment.y.si(), moment.schedule()),
        (0.0, 3.0, Schedule::Constant)
    );
    let gravity = effects.gravity.as_ref().unwrap();
    assert_eq!(
        (gravity.acceleration(), gravity.schedule()),
        ([0.0, -9.81, 0.0], Schedule::Constant)
    );
    assert_eq!(scene.text, EXAMPLE);
    let inner = scene.inner.body.unwrap();
    assert_eq!(inner.mesh, Path::new("scenes/../meshes/7010c_inner.msh"));
    assert_eq!(
        (inner.mesh_unit, inner.support, inner.groove_z),
        (1e-3, Support::Clamped, 0.0)
    );
    let [keyway] = inner.cuts[..] else {
        panic!("{:?}", inner.cuts);
    };
    assert_eq!((keyway.radius, keyway.z), ([25e-3, 26e-3], [-8e-3, 8e-3]));
    assert!(keyway.holds([0.0, 25.5e-3, 0.0]) && !keyway.holds([25.5e-3, 0.0, 0.0]));
    let section = scene.inner.section.unwrap();
    assert_eq!(
        (section.element, section.sectors, section.grading),
        (SectionElement::Hex20, 180, 1.2)
    );
    let shoulders = section.shoulder_diameters;
    assert_eq!((shoulders.at_low_z, shoulders.at_high_z), (60.4e-3, 60.4e-3));
}

/// If this failed, a short scene would not be read, or a default would differ from what the example states.
#[test]
fn what_is_optional_may_be_left_out() {
    let mut text = EXAMPLE.to_string();
    for line in [
        "title",
        "first_ball",
        "inner_stiffness",
        "outer_stiffness",
        "groove_circle",
        "patch_elements",
        "patch_length",
        "inertia",
        "groove_z",
        "flexible",
        "grading",
        "backend",
        "tolerance",
        "max_iterations",
        "stress",
        "precision",
        "compression",
        "[solver]",
        "[output]",
    ] {
        let old = text.lines().find(|l| l.starts_with(line)).unwrap().to_string();
        text = text.replacen(&old, "", 1);
    }
    let short = parse(&text, &[]).unwrap();
    let long = parse(EXAMPLE, &[]).unwrap();
    assert_eq!(
        short.contact,
        Contact {
            inner_stiffness: None,
            outer_stiffness: None,
            patch_length: None,
            ..long.contact
        }
    );
    assert!((long.contact.patch_length.unwrap() - 1.89e-3).abs() < 1e-15);
    assert_eq!((short.solver, short.output), (long.solver, long.output));
    assert_eq!((short.inner.body, short.bearing), (long.inner.body, long.bearing));
    assert_eq!(short.inner.section.map(|s| s.grading), Some(1.0));
}

/// If this failed, the Jones-Harris limit could not be run without meshes.
#[test]
fn rigid_rings_need_no_tables_beyond_the_switch() {
    let text = without_table("[inner.section]").replace("mode = \"patch\"", "mode = \"rigid\"");
    let text = text
        .replace("flexible = true", "flexible = false")
        .replace("inertia = \"section\"", "")
        .replace("[outer]", "[outer]\nflexible = false");
    let scene = parse(&text, &[]).unwrap();
    assert_eq!((scene.inner.body, scene.outer.body), (None, None));
    assert_eq!(scene.contact.mode, ContactMode::Rigid);
    let mixed = parse(&text.replace("mode = \"rigid\"", "mode = \"patch\""), &[]).unwrap();
    assert_eq!((mixed.inner.body, mixed.outer.body), (None, None));
}

/// If this failed, prescribed motions, that is displacement-controlled scenes, would not reach the solver.
#[test]
fn a_prescribed_motion_keeps_its_value() {
    let scene = parse(
        EXAMPLE,
        &["shaft.z=12 um", "shaft.tilt_y=-0.1 mrad", "shaft.x=locked"],
    )
    .unwrap();
    assert_eq!(scene.shaft.z, ShaftMotion::Prescribed(12e-6));
    assert_eq!(scene.shaft.tilt_y, ShaftMotion::Prescribed(-1e-4));
    assert_eq!(scene.shaft.x, ShaftMotion::Locked);
}

/// If this failed, a bearing without clearance (deep groove, contact angle 0) would be refused because of
/// round-off.
#[test]
fn zero_clearance_is_accepted() {
    let scene = parse(EXAMPLE, &["bearing.outer_raceway_diameter=74.01 mm"]).unwrap();
    assert!(
        scene.bearing.clearance().abs() < 1e-16,
        "{}",
        scene.bearing.clearance()
    );
}

/// If this failed, a reference case delivered with the program would not run, or not solve what its name
/// says.
#[test]
fn the_delivered_scenes_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let expected = [
        ("7010c_preload", 2e3, None, 0, ShaftMotion::Locked),
        ("7010c_radial_tilt_free", 2e3, Some(1e3), 0, ShaftMotion::Free),
        ("7010c_radial_tilt_locked", 2e3, Some(1e3), 0, ShaftMotion::Locked),
        ("7010c_preload_sweep", 2e3, None, 11, ShaftMotion::Locked),
        ("7010c_radial_sweep", 2e3, Some(0.0), 7, ShaftMotion::Locked),
        ("7010c_10kn_radial_sweep", 10e3, Some(0.0), 8, ShaftMotion::Locked),
    ];
    for (name, axial, radial, n_points, tilt) in expected {
        let path = folder.join(format!("{name}.toml"));
        let scene = Scene::load_with(&path, &[], MeshFiles::MayBeMissing).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(axial_of(&scene), Some((axial, Schedule::Constant)), "{name}");
        assert_eq!(radial_of(&scene), radial, "{name}");
        assert_eq!(scene.sweep_scenes().unwrap().len(), n_points, "{name}");
        assert_eq!((scene.shaft.tilt_x, scene.shaft.tilt_y), (tilt, tilt), "{name}");
        assert_eq!(scene.bearing, parse(EXAMPLE, &[]).unwrap().bearing, "{name}");
        for (ring, mesh) in [(scene.inner, "7010c_inner.msh"), (scene.outer, "7010c_outer.msh")] {
            let body = ring.body.unwrap_or_else(|| panic!("{name}: rigid"));
            assert_eq!(body.mesh_as_typed, format!("../meshes/{mesh}"), "{name}");
            assert_eq!(body.support, Support::Clamped, "{name}");
        }
    }
}

/// If this failed, a motion delivered with the program would not run, or not solve what its name says.
#[test]
fn the_delivered_motions_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let expected = [
        ("7010c_1800rpm", 7700, 1e-5, 180),
        ("7010c_1800rpm_coarse", 500, 2e-5, 90),
    ];
    for (name, n_steps, step, sectors) in expected {
        let path = folder.join(format!("{name}.toml"));
        let scene = Scene::load_with(&path, &[], MeshFiles::MayBeMissing).unwrap_or_else(|e| panic!("{e}"));
        let Analysis::Dynamic(dynamic) = &scene.analysis else {
            panic!("{name}: {:?}", scene.analysis);
        };
        assert_eq!((dynamic.n_steps, dynamic.step), (n_steps, step), "{name}");
        assert_eq!(dynamic.contact, ContactScheme::DiscreteGradient, "{name}");
        assert_eq!(
            scene.speed.as_ref().map(|s| &s.inner.times),
            Some(&vec![0.0]),
            "{name}"
        );
        assert_eq!(axial_of(&scene), Some((2e3, Schedule::Constant)), "{name}");
        assert_eq!(radial_of(&scene), Some(1e3), "{name}");
        assert_eq!(
            (scene.shaft.tilt_x, scene.shaft.tilt_y),
            (ShaftMotion::Locked, ShaftMotion::Locked),
            "{name}"
        );
        let suffix = name.strip_prefix("7010c_1800rpm").unwrap_or("");
        for (ring, side) in [(scene.inner, "inner"), (scene.outer, "outer")] {
            assert_eq!(ring.section.map(|s| s.sectors), Some(sectors), "{name}");
            let mesh = format!("../meshes/7010c_{side}{suffix}.msh");
            assert_eq!(ring.body.map(|b| b.mesh_as_typed), Some(mesh), "{name}");
        }
    }
}
