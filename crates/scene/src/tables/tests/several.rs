//! Lists of bearings on one shaft.

use std::path::PathBuf;

use assembly::Orientation;

use super::*;

/// A folder with the type of the example's bearing.
pub(super) struct Lists(pub(super) PathBuf);

impl Lists {
    pub(super) fn new(name: &str) -> Lists {
        let folder = std::env::temp_dir().join(format!("raceway_several_{name}_{}", std::process::id()));
        std::fs::create_dir_all(folder.join("types")).unwrap();
        std::fs::write(folder.join("types/kind.toml"), kind()).unwrap();
        Lists(folder)
    }

    fn parse(&self, text: &str, overrides: &[&str]) -> Result<AnyScene, SceneError> {
        let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
        AnyScene::parse(
            text,
            &self.0.join("list.toml"),
            &overrides,
            MeshFiles::MayBeMissing,
        )
    }

    #[track_caller]
    pub(super) fn several(&self, text: &str, overrides: &[&str]) -> SeveralScene {
        match self
            .parse(text, overrides)
            .unwrap_or_else(|error| panic!("{error}"))
        {
            AnyScene::Several(scene) => *scene,
            AnyScene::One(_) => panic!("one bearing"),
        }
    }

    /// The message on a list, without the folder.
    #[track_caller]
    pub(super) fn message(&self, text: &str) -> String {
        let error = self.parse(text, &[]).expect_err("the scene was accepted");
        error.to_string().replace(&format!("{}/", self.0.display()), "")
    }
}

impl Drop for Lists {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The tables of the example's bearing, and the scene without them.
fn parts() -> [String; 2] {
    let [mut kind, mut rest] = [String::new(), String::new()];
    let mut is_kind = false;
    for line in EXAMPLE.lines() {
        if let Some((name, _)) = line.strip_prefix('[').and_then(|line| line.split_once(']')) {
            let root = name.split('.').next().unwrap_or_default();
            is_kind = ["bearing", "materials", "contact", "inner", "outer"].contains(&root);
        }
        let text = if is_kind { &mut kind } else { &mut rest };
        *text += &format!("{line}\n");
    }
    [kind, rest]
}

pub(super) fn kind() -> String {
    parts()[0].replace("\"../meshes/", "\"../../meshes/")
}

const BEARINGS: &str = r#"
[[bearing]]
name = "front"
position = "30 mm"
orientation = "+z"
type = "types/kind.toml"

[[bearing]]
name = "rear"
position = "60 mm"
orientation = "-z"
type = "types/kind.toml"
first_ball_azimuth = "10 deg"
"#;

pub(super) const BEAM: &str = r#"
[shaft]
model = "beam"
material = { young_modulus = "207 GPa", poisson_ratio = 0.3, density = "7800 kg/m3" }

[[shaft.section]]
from = "0 mm"
to = "50 mm"
outside = "50 mm"
bore = "20 mm"

[[shaft.section]]
from = "50 mm"
to = "100 mm"
outside = "45 mm"
"#;

pub(super) const RIGID: &str = r#"
[shaft]
model = "rigid"
x = "free"
y = "free"
z = "free"
tilt_x = "free"
tilt_y = "free"
"#;

pub(super) fn list(shaft: &str, more: &str) -> String {
    format!("{BEARINGS}{shaft}{more}\n[static]\n")
}

/// Wrong: the documented example would not be one, or a bearing of the list be another than its type says.
#[test]
fn the_example_is_a_list() {
    let lists = Lists::new("example");
    let text = include_str!("../example_several.toml").replace("7010c.toml", "kind.toml");
    let scene = lists.several(&text, &[]);
    assert_eq!(scene.bearings.len(), 2);
    assert_eq!(scene.pairing.offset, 8e-6);
    assert_eq!(scene.shaft.loads[0].force, [0.0, -1000.0, 0.0]);
    assert_eq!(scene.shaft.masses.len(), 1);
    let ShaftKind::Beam(beam) = &scene.shaft.kind else {
        panic!("no beam");
    };
    assert_eq!((beam.ends(), beam.longest_element), ([0.0, 0.1], 5e-3));
    let rear = &scene.bearings[1];
    assert_eq!((rear.position, rear.orientation), (0.06, Orientation::MinusZ));
    // Azimuths of the shaft are turned into the bearing's frame.
    assert!((rear.scene.bearing.first_ball_azimuth + 10f64.to_radians()).abs() < 1e-15);
    assert_eq!(
        rear.scene.bearing.balls,
        parse(EXAMPLE, &[]).unwrap().bearing.balls
    );
    assert_eq!(rear.scene.shaft.z, ShaftMotion::Prescribed(0.0));
}

/// Wrong: a bearing that is turned would feel weight, spin or a load of the shaft as one that is not.
#[test]
fn weight_and_spin_are_turned_and_loads_of_the_shaft_kept_apart() {
    let lists = Lists::new("turned");
    let more = r#"
[speed]
inner = "3000 rpm"
[effects.ball_centrifugal]
[effects.axial_force]
value = "400 N"
[effects.gravity]
acceleration = "9.81 m/s2"
direction = [0.0, -1.0, 1.0]
"#;
    let scene = lists.several(&list(BEAM, more), &["effects.axial_force.value=600 N"]);
    let [front, rear] = [&scene.bearings[0].scene, &scene.bearings[1].scene];
    let weight = |s: &Scene| s.effects.gravity.as_ref().unwrap().acceleration();
    let (a, b) = (weight(front), weight(rear));
    assert_eq!([b[0], b[1], b[2]], [a[0], -a[1], -a[2]]);
    let spin = |s: &Scene| s.speed.as_ref().unwrap().inner.values[0];
    assert_eq!(spin(front), -spin(rear));
    assert!(front.effects.axial_force.is_none() && rear.effects.axial_force.is_none());
    assert_eq!(scene.effects.axial_force.as_ref().unwrap().value.si(), 600.0);
    // Overrides of what stands in the type file act in it.
    let soft = lists.several(
        &list(BEAM, ""),
        &[
            "contact.mode=rigid",
            "inner.flexible=false",
            "outer.flexible=false",
        ],
    );
    assert_eq!(soft.bearings[1].scene.contact.mode, ContactMode::Rigid);
}

/// Wrong: a list of one bearing would be another scene than the one with its table.
#[test]
fn a_list_of_one_bearing_on_a_rigid_shaft_is_the_scene_with_one_table() {
    let lists = Lists::new("one");
    let [_, rest] = parts();
    let one = "[[bearing]]\nname = \"front\"\nposition = \"0 mm\"\norientation = \"+z\"\ntype = \"types/kind.toml\"\n";
    let text = rest.replace("[shaft]", &format!("{one}\n[shaft]\nmodel = \"rigid\""));
    let AnyScene::One(found) = lists.parse(&text, &[]).unwrap() else {
        panic!("a list of one is no list");
    };
    let expected = Scene::parse(EXAMPLE, &lists.0.join("list.toml"), &[], MeshFiles::MayBeMissing).unwrap();
    assert_eq!(found.bearing, expected.bearing);
    assert_eq!(found.shaft, expected.shaft);
    assert_eq!(found.effects, expected.effects);
    assert_eq!(
        (&found.materials, &found.contact),
        (&expected.materials, &expected.contact)
    );
    assert_eq!(found.solver, expected.solver);
    let values = |scene: &Scene| match &scene.analysis {
        Analysis::Sweep(sweep) => sweep.points.iter().map(|p| p.value).collect::<Vec<_>>(),
        _ => Vec::new(),
    };
    assert_eq!(values(&found), values(&expected));
    // Commands that know no lists take it too.
    assert!(Scene::parse(&text, &lists.0.join("list.toml"), &[], MeshFiles::MayBeMissing).is_ok());
}

/// Wrong: a command that knows no lists would say something else about them.
#[test]
fn commands_for_one_bearing_name_those_for_lists() {
    let lists = Lists::new("refused");
    let error = Scene::parse(
        &list(BEAM, ""),
        &lists.0.join("list.toml"),
        &[],
        MeshFiles::MayBeMissing,
    );
    let text = error.unwrap_err().to_string();
    assert!(
        text.ends_with(
            "has a list of bearings on one shaft, which this command does not take yet; expected one table [bearing]. \
             Lists are for raceway run, resume, check, mesh, info, export, stiffness, campbell, plot and report"
        ),
        "{text}"
    );
}

/// Wrong: points of a sweep would not be lists, or not have the value.
#[test]
fn a_sweep_of_the_offset_has_a_list_at_every_point() {
    let lists = Lists::new("sweep");
    let text = list(BEAM, "[pairing]\noffset = \"8 um\"\n").replace(
        "[static]",
        "[sweep]\nkey = \"pairing.offset\"\nvalues = [\"4 um\", \"12 um\"]",
    );
    let scene = lists.several(&text, &["contact.patch_elements=2.5"]);
    let points = scene.sweep_scenes().unwrap();
    let offsets: Vec<f64> = points.iter().map(|p| p.pairing.offset).collect();
    assert_eq!(offsets, [4e-6, 12e-6]);
    assert_eq!(points[1].bearings[0].scene.contact.patch_elements, 2.5);
}

/// Wrong: what a bearing of a list leaves behind could not be run by itself.
#[test]
fn a_bearing_of_a_list_can_be_put_where_its_shaft_is() {
    let lists = Lists::new("placed");
    let scene = lists.several(&list(BEAM, ""), &[]);
    let q = [1.25e-6, -3e-7, 1.0 / 3.0 * 1e-5, 2e-5, -1e-6];
    let placed = scene.bearings[1].scene.with_shaft_at(q).unwrap();
    assert_eq!(placed.shaft.z, ShaftMotion::Prescribed(q[2]));
    assert_eq!(placed.shaft.tilt_y, ShaftMotion::Prescribed(q[4]));
    let again = Scene::parse(&placed.text, &placed.path, &[], MeshFiles::MayBeMissing).unwrap();
    assert_eq!(again.shaft, placed.shaft);
}

/// A list in motion.
pub(super) fn moving(list: &str, more: &str) -> String {
    let analysis = format!("[dynamic]\nduration = \"100 us\"\nstep = \"1 us\"\n{more}");
    list.replace("[static]", &analysis)
}

#[test]
fn speeds_over_time_are_turned_with_their_bearing() {
    let lists = Lists::new("speeds");
    for speed in [
        "{ ramp = { from = \"600 rpm\", to = \"1200 rpm\", start = \"0 s\", duration = \"1 s\" } }",
        "{ times = [\"0 s\", \"1 s\"], values = [\"600 rpm\", \"1200 rpm\"] }",
    ] {
        let text = moving(&list(BEAM, &format!("[speed]\ninner = {speed}\n")), "");
        let AnyScene::Several(scene) = lists.parse(&text, &[]).unwrap() else {
            panic!("a list");
        };
        for (bearing, sign) in scene.bearings.iter().zip([1.0, -1.0]) {
            let speed = bearing.scene.speed.clone().unwrap().inner;
            let found = [0.0, 1.0].map(|t| sign * speed.at(t) * 30.0 / std::f64::consts::PI);
            assert!(
                (found[0] - 600.0).abs() < 1e-9 && (found[1] - 1200.0).abs() < 1e-9,
                "{found:?}"
            );
        }
    }
}

/// Wrong: slips in a list would be solved, or the message would not say what to do.
#[test]
fn bad_lists_are_refused_with_advice() {
    let lists = Lists::new("bad");
    let beam = list(BEAM, "");
    let cases: Vec<(String, &str)> = vec![
        (
            beam.replace("position = \"60 mm\"", "position = \"40 mm\""),
            "overlap: they are 10.000 mm apart and 16.000 mm wide; expected at least",
        ),
        (
            beam.replace("position = \"60 mm\"", "position = \"97 mm\""),
            "bearing.position of \"rear\" is 97 mm: with its width of 16.000 mm it reaches beyond the shaft; expected \
             0.000 to 100.000 mm, where its sections are",
        ),
        (
            beam.replacen("types/kind.toml", "types/kin.toml", 1),
            "bearing.type of \"front\" is \"types/kin.toml\": types/kin.toml cannot be read",
        ),
        (
            beam.replace("name = \"rear\"", "name = \"front\""),
            "bearing.name \"front\" stands twice; expected a name of its own for each bearing",
        ),
        (
            beam.replace("name = \"rear\"", "name = \"figures\""),
            "bearing.name of bearing 2 is \"figures\"; this name is reserved: the folder of a run has \"figures\" and \
             \"superseded_1\" itself; expected a name that is not \"figures\" and does not begin with \"superseded\"",
        ),
        (
            beam.replace("name = \"rear\"", "name = \"rear one\""),
            "bearing.name of bearing 2 is \"rear one\"; expected letters, digits, _ and -",
        ),
        (
            beam.replace("\"-z\"", "\"z\""),
            "bearing.orientation of \"rear\" is \"z\"; expected \"+z\", pressed by a force on the shaft along +z, or \
             \"-z\"",
        ),
        (
            beam.replace("to = \"50 mm\"", "to = \"48 mm\""),
            "shaft.section 1 ends at 48 mm and shaft.section 2 begins at 50 mm: they leave a gap; expected sections \
             that lie end to end",
        ),
        (
            beam.replace("to = \"50 mm\"", "to = \"52 mm\""),
            "shaft.section 1 ends at 52 mm and shaft.section 2 begins at 50 mm: they overlap",
        ),
        (
            beam.replace("bore = \"20 mm\"", "bore = \"50 mm\""),
            "shaft.section 1.bore is 50 mm; expected 0 mm to less than its outside, 50 mm",
        ),
        (
            beam.replace("to = \"100 mm\"", "to = \"50 mm\""),
            "shaft.section 2.to is 50 mm; expected more than its from, 50 mm",
        ),
        (
            list(
                BEAM,
                "[[shaft.load]]\nposition = \"120 mm\"\nforce = [\"1 N\", \"0 N\", \"0 N\"]\n",
            ),
            "shaft.load 1 is at 120 mm, which is off the shaft; expected 0.000 to 100.000 mm, where its sections are",
        ),
        (
            list(BEAM, "[[shaft.load]]\nposition = \"20 mm\"\n"),
            "shaft.load 1 has neither force nor moment; expected force =",
        ),
        (
            list(BEAM, "[[shaft.mass]]\nposition = \"-1 mm\"\nmass = \"1 kg\"\n"),
            "shaft.mass 1 is at -1 mm, which is off the shaft",
        ),
        (
            list(
                BEAM,
                "[[shaft.mass]]\nposition = \"1 mm\"\nmass = \"1 kg\"\npolar_inertia = \"1 kg m2\"\n",
            ),
            "no body has more than twice as much about its axis as across it",
        ),
        (
            moving(&beam, "[dynamic.adaptive]\ntolerance = 1e-4\n"),
            "dynamic.adaptive is not for a list of bearings yet: its steps are equal; remove it",
        ),
        (
            moving(&beam, "[dynamic.start.free]\n"),
            "dynamic.start is not for a list of bearings yet: it starts from its equilibrium, at rest or with \
             [dynamic.start.rolling]",
        ),
        (
            moving(&beam, "integrator = \"chung_hulbert\"\nrho = 0.8\n"),
            "dynamic.integrator is not for a list of bearings yet: it moves by average_acceleration",
        ),
        (moving(&beam, "step = \"2 us\"\n"), "duplicate key"),
        (
            format!("{}[static]\n", moving(&beam, "")),
            "the scene has both [static] and [dynamic]; keep exactly one analysis",
        ),
        (
            beam.replace(
                "[static]",
                "[static]\n[effects.contact_damping]\ncoefficient = \"1 N s/mm\"\n",
            ),
            "effects.contact_damping",
        ),
        (
            beam.replace("[static]", "[modes]\nnumber = 3\nbodies = [\"outer\"]\n"),
            "modes.bodies names \"outer\", a ring alone, but a list of bearings vibrates as one with its shaft; leave",
        ),
        (
            beam.replace("[static]", "[modes]\nnumber = 0\n"),
            "modes.number is 0",
        ),
        (
            beam.replace("[static]", "[static]\n[modes]\nnumber = 3\n"),
            "the scene has both [static] and [modes]; keep exactly one analysis",
        ),
        (
            beam.replace("[static]", "[speed]\ninner = \"100 rpm\"\n[modes]\nnumber = 3\n"),
            "[speed] is given, but [modes] are those of a bearing that does not turn",
        ),
        (
            beam.replace("[static]", ""),
            "the scene has no analysis; add one of the tables [static], [sweep], [quasi_static], [dynamic] and [modes]",
        ),
        (
            beam.replace("model = \"beam\"", "model = \"elastic\""),
            "shaft.model is \"elastic\"; expected \"rigid\" or \"beam\"",
        ),
        (
            beam.replace("model = \"beam\"", "model = \"beam\"\nz = \"locked\""),
            "shaft.z is for a rigid shaft; a beam is held by its bearings",
        ),
        (
            list(RIGID, "").replace("tilt_y = \"free\"\n", ""),
            "shaft lacks tilt_y; a rigid shaft needs all of x, y, z, tilt_x and tilt_y",
        ),
        (
            list(RIGID, "").replace("x = \"free\"\ny", "x = \"9 mm\"\ny"),
            "shaft.x is 9 mm; a prescribed displacement must be less than a ball radius",
        ),
        (
            list(BEAM, "[pairing]\noffset = \"8 um\"\n").replace("\"-z\"", "\"+z\""),
            "pairing.offset is 8 um, but all bearings have the same orientation",
        ),
        (
            list(BEAM, "[pairing]\noffset = \"8 mm\"\n"),
            "pairing.offset is 8 mm; expected -1 to 1 mm",
        ),
        (
            list(BEAM, "[pairing]\nspring = \"500 N\"\n"),
            "pairing.spring needs sliding, the bearing whose outer ring slides: one of front, rear",
        ),
        (
            list(BEAM, "[pairing]\nspring = \"500 N\"\nsliding = \"last\"\n"),
            "pairing.sliding is \"last\"; expected the name of a bearing: front, rear",
        ),
        (
            list(BEAM, "[pairing]\n"),
            "pairing is empty; expected offset = \"8 um\", or spring = \"500 N\" and sliding = \"rear\"",
        ),
        (
            list(BEAM, "[effects.spring_preload]\nforce = \"300 N\"\n"),
            "effects.spring_preload is not for a list of bearings; write [pairing] with spring and sliding",
        ),
        (
            list(BEAM, "[probes.contact.a]\nball = 0\nring = \"inner\"\n"),
            "[probes] is not for a list of bearings yet; remove it, or give one table [bearing]",
        ),
        (
            list(
                BEAM,
                "[effects.gravity]\nacceleration = \"-1 m/s2\"\ndirection = [0.0, 1.0, 0.0]\n",
            ),
            "has a problem: effects.gravity.acceleration is -1 m/s2; expected 0 to 1e7 m/s2",
        ),
    ];
    for (text, expected) in cases {
        let found = lists.message(&text);
        assert!(found.contains(expected), "found: {found}\nexpected: {expected}");
    }
}

/// Wrong: a shaft that only a sliding ring holds would be solved.
#[test]
fn a_shaft_whose_only_bearing_slides_is_refused() {
    let lists = Lists::new("axis");
    let (first, _) = BEARINGS.split_at(BEARINGS.rfind("[[bearing]]").unwrap());
    let text = format!("{first}{BEAM}[pairing]\nspring = \"500 N\"\nsliding = \"front\"\n[static]\n");
    assert!(
        lists.message(&text).contains(
            "nothing holds the shaft along z: the outer ring of \"front\", the only bearing, slides"
        ),
    );
}

/// Wrong: an error in a type file would be told of the list, or once for each bearing of the type.
#[test]
fn errors_in_a_type_file_are_told_once_with_its_name_and_line() {
    let lists = Lists::new("kind");
    let bad = kind().replace("poisson_ratio = 0.3", "poisson_ratio = 0.7");
    std::fs::write(lists.0.join("types/kind.toml"), bad).unwrap();
    let text = lists.message(&list(BEAM, ""));
    assert_eq!(text.matches("materials.rings.poisson_ratio").count(), 1, "{text}");
    assert!(text.contains(" of types/kind.toml)"), "{text}");
    // A value of a wrong unit too, though the tables of the list stand before those of the type.
    let bad = kind().replace("ball_diameter = \"9 mm\"", "ball_diameter = \"9 kg\"");
    let line = 1 + bad.lines().position(|line| line.contains("\"9 kg\"")).unwrap();
    std::fs::write(lists.0.join("types/kind.toml"), bad).unwrap();
    let text = lists.message(&list(BEAM, ""));
    assert!(text.contains(&format!("types/kind.toml:{line}:")), "{text}");
    std::fs::write(lists.0.join("types/kind.toml"), format!("{}\n[static]\n", kind())).unwrap();
    let text = lists.message(&list(BEAM, ""));
    assert!(
        text.contains(
            "types/kind.toml has static; expected the tables of one bearing alone: [bearing], [materials], [contact], \
             [inner], [outer]"
        ),
        "{text}"
    );
}
