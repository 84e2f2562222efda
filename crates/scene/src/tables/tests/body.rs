//! `[[body]]`: an elastic body round the outer ring.

use ::body::SeatBasis;
use ::body::matrix::MatrixSeat;

use super::*;

/// The delivered scene.
const SCENE: &str = include_str!("../../../../../scenes/6010_plummer_block.toml");
/// The seat of the delivered scene.
const SEAT: &str = "[[body.seat]]\nring = \"outer\"\ngroup = \"seat_a\"";

fn with(old: &str, new: &str) -> String {
    assert!(SCENE.contains(old), "{old}");
    SCENE.replacen(old, new, 1)
}

fn body_of(text: &str) -> SceneBody {
    let scene = parse(text, &[]).unwrap_or_else(|e| panic!("{e}"));
    scene.bodies[1].clone().unwrap()
}

/// Wrong: a key would be read as something else, or a default would differ from what the reference says.
#[test]
fn the_delivered_scene_and_the_defaults_read_as_they_say() {
    let body = body_of(SCENE);
    let BodySource::Mesh {
        mesh_unit,
        material,
        fixed,
        ..
    } = &body.source
    else {
        panic!("{body:?}");
    };
    assert_eq!((body.name.as_str(), *mesh_unit), ("plummer block", 1e-3));
    assert_eq!(
        (material.young_modulus, fixed.as_slice()),
        (110e9, &["feet".to_string()][..])
    );
    let short = SCENE.replace("harmonics = 12", "").replace("\nacross = 2", "");
    let expected = SeatBasis::Harmonics {
        harmonics: 12,
        across: 2,
    };
    assert_eq!((body.basis, body_of(&short).basis), (expected, expected));
    assert_eq!(
        (body.z, body_of(&with(SEAT, &format!("{SEAT}\nz = \"3 mm\""))).z),
        (None, Some(3e-3))
    );
}

/// Wrong: a body of matrices would be read with other units or files.
#[test]
fn a_body_of_matrices_reads_as_it_says() {
    let text = matrices("");
    let BodySource::Matrix(files) = body_of(&text).source else {
        panic!("{text}");
    };
    assert_eq!(
        (files.length_unit, files.stiffness_unit, files.fixed_nodes),
        (1e-3, 1e3, None)
    );
    assert!(files.stiffness.ends_with("K.mtx"), "{:?}", files.stiffness);
    let nodes = |text: &str| match body_of(text).source {
        BodySource::Matrix(files) => files.seats,
        source => panic!("{source:?}"),
    };
    // The nodes of the seat stand in its own table or in that of the body.
    let of_seat = matrices("").replace("\nseat_nodes = \"s.csv\"", "");
    let of_seat = of_seat.replace("ring = \"outer\"", "ring = \"outer\"\nseat_nodes = \"s.csv\"");
    assert_eq!(nodes(&of_seat), nodes(&text));
}

/// Wrong: a seat on one node would be tied as a cylinder, or a slip beside it pass.
#[test]
fn a_seat_may_move_with_one_node() {
    let of_node = |more: &str| {
        let text = matrices("").replace("\nseat_nodes = \"s.csv\"", "");
        let text = text.replace("harmonics = 12", "").replace("\nacross = 2", "");
        text.replace("ring = \"outer\"", &format!("ring = \"outer\"\n{more}"))
    };
    let body = body_of(&of_node("reference_node = 4711"));
    let BodySource::Matrix(files) = &body.source else {
        panic!("{body:?}");
    };
    assert_eq!(files.seats, [MatrixSeat::Reference(4711)]);
    assert_eq!(body.basis, SeatBasis::Rigid);
    for (more, expected) in [
        (
            "reference_node = 4711\nharmonics = 3",
            "has reference_node, with which a seat moves as a rigid one, but harmonics or across too; remove them",
        ),
        (
            "reference_node = 4711\nseat_nodes = \"s.csv\"",
            "has reference_node and seat_nodes; keep reference_node where the seat moves with one node",
        ),
        (
            "reference_node = -1",
            "seat.reference_node is -1; expected the number of a node, 0, 1, 2 ...",
        ),
    ] {
        let said = parse(&of_node(more), &[]).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    }
    let of_mesh = with(SEAT, &format!("{SEAT}\nreference_node = 4711"));
    let said = parse(&of_mesh, &[]).unwrap_err().to_string();
    let expected = "has a mesh, but reference_node is a key of a body from matrices; remove it";
    assert!(said.contains(expected), "{said}");
}

/// The delivered scene with a body of matrices.
fn matrices(more: &str) -> String {
    let start = SCENE.find("mesh = \"../meshes/plummer_block.msh\"").unwrap();
    let end = SCENE.find("[[body.seat]]").unwrap();
    let files = "stiffness = \"K.mtx\"\nnodes = \"n.csv\"\nseat_nodes = \"s.csv\"";
    let keys = format!("{files}\nlength_unit = \"mm\"\nstiffness_unit = \"N/mm\"\n");
    let seat = SCENE[end..].replacen("group = \"seat_a\"", "", 1);
    format!("{}{keys}{more}\n{seat}", &SCENE[..start])
}

/// Wrong: a body would be left out in silence, stand where nothing is known of it, or be refused without a remedy.
#[test]
fn scenes_in_which_a_body_makes_no_sense_are_refused() {
    let support = "support = \"body\"";
    let whole_body = {
        let (start, end) = (SCENE.find("[[body]]  ").unwrap(), SCENE.find("[shaft]").unwrap());
        &SCENE[start..end]
    };
    let unit = "mesh_unit = \"mm\"\nmaterial";
    let cases: Vec<(String, &str)> = vec![
        (
            with(whole_body, ""),
            "outer.support is \"body\", but the scene has no body for it; add a table [[body]]",
        ),
        (
            with(support, "support = \"clamped\""),
            "body \"plummer block\" is there, but outer.support is not \"body\"",
        ),
        (
            with("[shaft]", &format!("{whole_body}\n[shaft]")),
            "2 tables [[body]], such as \"plummer block\" and \"plummer block\"",
        ),
        (
            with(SEAT, &format!("{SEAT}\n{SEAT}")),
            "has 2 tables [[body.seat]], but the bearing has one ring in it; expected one",
        ),
        (
            with(
                &SCENE[SCENE.find("[[body.seat]]").unwrap()..SCENE.find("[shaft]").unwrap()],
                "",
            ),
            "has no seat; add a table [[body.seat]]",
        ),
        (
            with("ring = \"outer\"", "ring = \"inner\""),
            "body \"plummer block\" is there, but inner.support is not \"body\"; set inner.support = \"body\"",
        ),
        (
            with("support = \"clamped\"    ", support),
            "inner.support is \"body\", but the scene has no body for it; add a table [[body]] with a [[body.seat]] of \
             ring = \"inner\"",
        ),
        (
            with("group = \"seat_a\"", ""),
            "seat.group is missing; expected the facet group of its mesh",
        ),
        (with("harmonics = 12", "harmonics = 0"), "body.seat.harmonics"),
        (with("across = 2", "across = 9"), "body.seat.across"),
        (
            with("fixed = [\"feet\"]", "fixed = []"),
            "fixed names no facet group, so nothing holds the body",
        ),
        (
            with(unit, "material"),
            "body \"plummer block\": mesh_unit is missing; expected a unit such as \"mm\"",
        ),
        (
            with(unit, "mesh_unit = \"kg\"\nmaterial"),
            "body \"plummer block\": mesh_unit",
        ),
        (
            with("name = \"plummer block\"", "name = \"\""),
            "expected a name of 1 to 64 letters",
        ),
        (
            with("name = \"plummer block\"", "name = \"a\"\nstiffness = \"K.mtx\""),
            "has both mesh and stiffness; keep one",
        ),
        (
            with("mesh = \"../meshes/plummer_block.msh\"", "#"),
            "has neither mesh nor stiffness",
        ),
        (
            with("poisson_ratio = 0.26", "poisson_ratio = 0.6"),
            "body \"plummer block\": material.poisson_ratio",
        ),
        (
            matrices("").replace("nodes = \"n.csv\"\nseat", "seat"),
            "nodes is missing; a body from a matrix needs",
        ),
        (
            matrices("").replace("stiffness_unit = \"N/mm\"", "stiffness_unit = \"mm\""),
            "stiffness_unit",
        ),
        (
            matrices("").replace("ring = \"outer\"", "ring = \"outer\"\nseat_nodes = \"s.csv\""),
            "has seat_nodes itself and in a [[body.seat]]; keep that of the seat",
        ),
        (
            matrices("").replace("ring = \"outer\"", "ring = \"outer\"\ngroup = \"seat_a\""),
            "comes from a matrix, which has no facet groups; remove seat.group",
        ),
        (
            with(SEAT, &format!("{SEAT}\nseat_nodes = \"s.csv\"")),
            "has a mesh, but seat_nodes is a key of a body from matrices; remove it",
        ),
        (
            with("[[body.seat]]", "stiffness_unit = \"N/mm\"\n[[body.seat]]"),
            "has a mesh, but stiffness_unit is a key of a body from matrices; remove it",
        ),
        (
            matrices("fixed = [\"feet\"]"),
            "comes from a matrix, which has material and supports in it",
        ),
        (
            with("backend = \"auto\"", "backend = \"sector\""),
            "solver.backend is \"sector\", which does not tie a ring to a body",
        ),
        (
            with(
                "[output]",
                "[effects.fit.outer]\ninterference = \"5 um\"\nhousing_diameter = \"160 mm\"\n[output]",
            ),
            "effects.fit does not go with body",
        ),
    ];
    assert!(cases.len() >= 20);
    for (text, expected) in cases {
        let said = parse(&text, &[]).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    }
}

/// The delivered scene with its body on the shaft, and more of the scene.
fn on_shaft(more: &str) -> String {
    with("support = \"body\"", "support = \"mean_motion\"")
        .replace("support = \"clamped\"    ", "support = \"body\"")
        .replace("ring = \"outer\"", "ring = \"inner\"")
        .replace("[output]", &format!("{more}\n[output]"))
}

/// Wrong: a body on the shaft would be taken for a housing, or be solved with what it does not know.
#[test]
fn a_body_on_the_shaft_carries_the_inner_ring_and_goes_with_what_it_knows() {
    let scene = parse(&on_shaft(""), &[]).unwrap();
    let [inner, outer] = &scene.bodies;
    assert_eq!(inner.as_ref().unwrap().ring, RingName::Inner);
    assert_eq!(*outer, None);
    let matrix = {
        let text = on_shaft("");
        let start = text.find("mesh = \"../meshes/plummer_block.msh\"").unwrap();
        let end = text.find("[[body.seat]]").unwrap();
        let files = "stiffness = \"K.mtx\"\nnodes = \"n.csv\"\nseat_nodes = \"s.csv\"\nlength_unit = \"mm\"\n\
                     stiffness_unit = \"N/mm\"\n";
        format!("{}{files}{}", &text[..start], &text[end..])
    };
    let modes = on_shaft("").replace("[static]", "[modes]\nnumber = 4");
    let scene = parse(&modes, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(
        scene.bodies[0].as_ref().and_then(|body| body.modes_below),
        Some(20e3)
    );
    for (text, expected) in [
        (
            matrix,
            "comes from a stiffness matrix, of which nothing says how it moves with the shaft; give it as a mesh",
        ),
        (
            on_shaft("[effects.fit.inner]\ninterference = \"5 um\""),
            "effects.fit does not go with body \"plummer block\": its pressure is that of a rigid or round shaft",
        ),
        (
            on_shaft("").replacen("flexible = true", "flexible = false", 1),
            "body \"plummer block\" carries the inner ring, but that ring is rigid; set inner.flexible = true",
        ),
    ] {
        let said = parse(&text, &[]).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    }
}

/// Wrong: a motion would move a body that has no mass, or one at rest promise modes that nobody finds.
#[test]
fn only_a_body_with_a_mass_moves() {
    let moving = |text: &str| {
        let table = "[dynamic]\nduration = \"1 ms\"\nstep = \"10 us\"\noutput_every = 10";
        assert!(text.contains("[static]"));
        text.replace("[static]", table)
    };
    let below = |text: &str| {
        with(
            "[[body.seat]]",
            &format!("modes_below = \"{text}\"\n[[body.seat]]"),
        )
    };
    assert_eq!(body_of(&moving(SCENE)).modes_below, Some(20e3));
    assert_eq!(body_of(&moving(&below("5 kHz"))).modes_below, Some(5e3));
    assert_eq!(body_of(SCENE).modes_below, None);
    let BodySource::Matrix(files) = body_of(&moving(&matrices("mass = \"M.mtx\"\nmass_unit = \"t\""))).source
    else {
        panic!("a body of matrices");
    };
    let (path, unit) = files.mass.unwrap();
    assert!(path.ends_with("M.mtx") && unit == 1e3, "{path:?} {unit}");
    let with_mass = matrices("mass = \"M.mtx\"\nmass_unit = \"t\"");
    let reads = [&with_mass, &moving(&with_mass)].map(|text| body_of(text).reads_mass);
    assert_eq!(reads, [false, true]);
    // At rest gravity asks for the mass, and says where there is none.
    let heavy = |text: &str| {
        let gravity =
            "[effects.gravity]\nacceleration = \"9.81 m/s2\"\ndirection = [0.0, -1.0, 0.0]\n[static]";
        text.replace("[static]", gravity)
    };
    let body = body_of(&heavy(&with_mass));
    assert!(body.reads_mass && body.is_loaded);
    assert!(body_of(&heavy(SCENE)).is_loaded && !body_of(SCENE).is_loaded);
    let assumed = |text: &str| parse(text, &[]).unwrap_or_else(|e| panic!("{e}")).assumed;
    let said = "body \"plummer block\" comes from matrices without a mass, so effects.gravity does not make it sag; \
                add mass and mass_unit for that";
    assert!(assumed(&heavy(&matrices(""))).iter().any(|line| line == said));
    assert!(!assumed(&heavy(&with_mass)).iter().any(|line| line == said));
    for (text, expected) in [
        (
            moving(&below("0 Hz")),
            "expected a frequency between 1 Hz and 1 MHz",
        ),
        (moving(&below("5 mm")), "modes_below"),
        (
            moving(&matrices("")),
            "which has no mass, but the scene has [dynamic] or [modes]; add mass and mass_unit",
        ),
        (
            moving(&matrices("mass = \"M.mtx\"")),
            "mass_unit is missing; expected a unit such as \"kg\"",
        ),
        (
            moving(&matrices("mass_unit = \"kg\"")),
            "has mass_unit, but no mass; add the file of its mass matrix",
        ),
        (
            moving(&with("[[body.seat]]", "mass = \"M.mtx\"\n[[body.seat]]")),
            "has a mesh, whose mass follows from its density",
        ),
        (
            below("5 kHz"),
            "has modes_below, but the scene has no [dynamic] or [modes]",
        ),
    ] {
        let said = parse(&text, &[]).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    }
}

/// Wrong: no study could vary a body, or a slip in the number of a table would change something else.
#[test]
fn tables_of_lists_are_set_by_their_number() {
    let set = parse(SCENE, &["body.0.seat.0.harmonics=7", "body.0.name=block"]).unwrap();
    let body = set.bodies[1].clone().unwrap();
    let basis = SeatBasis::Harmonics {
        harmonics: 7,
        across: 2,
    };
    assert_eq!((body.basis, body.name.as_str()), (basis, "block"));
    for (path, expected) in [
        (
            "body.name=block",
            "body is a list of 1; expected a number below 1 and a key behind it, such as body.0.name",
        ),
        ("body.1.name=block", "body is a list of 1"),
        ("body.0.seat.3.harmonics=7", "body.0.seat is a list of 1"),
        ("body.0=3", "body is a list of 1"),
        (
            "body.0.name.x=3",
            "body.0.name is a value, so it has no key \"x\"",
        ),
    ] {
        let said = parse(SCENE, &[path]).unwrap_err().to_string();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
    }
}

/// Wrong: a body would stand on its head without a word, or not be turned.
#[test]
fn a_body_is_turned_where_it_says_so() {
    let turned = |text: &str| {
        with(
            "[[body.seat]]",
            &format!("orientation = \"{text}\"\n[[body.seat]]"),
        )
    };
    assert!(!body_of(SCENE).is_turned && !body_of(&turned("+z")).is_turned);
    assert!(body_of(&turned("-z")).is_turned);
    let said = parse(&turned("down"), &[]).unwrap_err().to_string();
    assert!(
        said.contains("expected \"+z\", as the mesh stands, or \"-z\", turned by 180 deg about x"),
        "{said}"
    );
    let said = parse(
        &with("ring = \"outer\"", "ring = \"outer\"\nbearing = \"front\""),
        &[],
    );
    let said = said.unwrap_err().to_string();
    assert!(
        said.contains("body.seat.bearing is for a list [[bearing]]"),
        "{said}"
    );
}

/// Wrong: a missing file would be found after the meshes are read, or without its place.
#[test]
fn missing_files_of_a_body_are_named() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/test.toml");
    let text = with("plummer_block.msh", "no_block.msh");
    let said = Scene::parse(&text, &path, &[], MeshFiles::MustExist)
        .unwrap_err()
        .to_string();
    assert!(
        said.contains("body \"plummer block\": mesh is \"../meshes/no_block.msh\", but there is no file"),
        "{said}"
    );
}
