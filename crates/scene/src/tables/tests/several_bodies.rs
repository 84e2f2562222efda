//! `[[body]]` in lists of bearings.

use ::body::matrix::MatrixSeat;

use super::several::{BEAM, Lists, list};
use super::*;

/// A body with a seat of these keys, and what follows.
fn body(seat: &str, more: &str) -> String {
    format!(
        "[[body]]\nname = \"block\"\nmesh = \"block.msh\"\nmesh_unit = \"mm\"\nfixed = [\"feet\"]\n\
         material = {{ young_modulus = \"110 GPa\", poisson_ratio = 0.26, density = \"7200 kg/m3\" }}\n\
         [[body.seat]]\nring = \"outer\"\ngroup = \"seat_a\"\n{seat}\n{more}"
    )
}

/// Wrong: a body would carry another bearing, stand on its head, or take the place of the support of both.
#[test]
fn a_body_is_that_of_its_bearing_and_stands_as_in_the_frame_of_the_shaft() {
    let lists = Lists::new("bodies");
    let list = lists.several(&list(BEAM, &body("bearing = \"rear\"", "")), &[]);
    let [front, rear] = [0, 1].map(|i| &list.bearings[i].scene);
    assert_eq!(front.bodies, [None, None]);
    let own = rear.bodies[1].as_ref().unwrap();
    assert_eq!((own.name.as_str(), own.is_turned), ("block", true));
    let support = |scene: &Scene| scene.outer.body.as_ref().unwrap().support;
    assert_ne!(support(front), support(rear));
}

/// A body with the seat of the front bearing, and another one.
fn two_seats(group: &str, bearing: &str) -> String {
    let second = format!("[[body.seat]]\nring = \"outer\"\ngroup = \"{group}\"\nbearing = \"{bearing}\"\n");
    body("bearing = \"front\"", &second)
}

/// Wrong: the seats of one body would not go to their bearings, or each bearing would make a body of its own of it.
#[test]
fn each_bearing_has_its_own_seat_of_a_body_that_carries_both() {
    let lists = Lists::new("shared_body");
    let list = lists.several(&list(BEAM, &two_seats("seat_b", "rear")), &[]);
    let bodies = [0, 1].map(|i| list.bearings[i].scene.bodies[1].clone().unwrap());
    let told = bodies.map(|body| (body.group, body.is_turned, body.is_shared));
    assert_eq!(
        told,
        [
            ("seat_a".to_string(), false, true),
            ("seat_b".to_string(), true, true)
        ]
    );
}

/// A body of matrices with a seat for each bearing.
fn of_matrices(more: &str, [front, rear]: [&str; 2]) -> String {
    format!(
        "[[body]]\nname = \"block\"\nstiffness = \"K.mtx\"\nnodes = \"n.csv\"\nlength_unit = \"mm\"\n\
         stiffness_unit = \"N/mm\"\n{more}\n[[body.seat]]\nring = \"outer\"\nbearing = \"front\"\n\
         seat_nodes = \"{front}\"\n[[body.seat]]\nring = \"outer\"\nbearing = \"rear\"\nseat_nodes = \"{rear}\"\n"
    )
}

/// Wrong: the nodes of one seat of a body of matrices would be taken for those of another.
#[test]
fn each_bearing_has_the_nodes_of_its_own_seat() {
    let lists = Lists::new("matrix_bodies");
    let list = lists.several(&list(BEAM, &of_matrices("", ["a.csv", "b.csv"])), &[]);
    for (bearing, file) in list.bearings.iter().zip(["a.csv", "b.csv"]) {
        let body = bearing.scene.bodies[1].as_ref().unwrap();
        let BodySource::Matrix(files) = &body.source else {
            panic!("{body:?}");
        };
        let [MatrixSeat::Nodes(nodes)] = files.seats.as_slice() else {
            panic!("{files:?}");
        };
        assert!(nodes.ends_with(file) && body.is_shared, "{nodes:?}");
    }
}

/// Wrong: a body that no bearing sits in, or two for one, would be left out without a word.
#[test]
fn bodies_that_fit_no_bearing_are_refused_with_advice() {
    let lists = Lists::new("bad_bodies");
    let cases = [
        (
            list(BEAM, &body("", "")),
            "body \"block\" has a seat without `bearing`; expected the name of the bearing that it carries, one of \
             front, rear",
        ),
        (
            list(BEAM, &body("bearing = \"middle\"", "")),
            "body \"block\" has a seat for the bearing \"middle\"; expected one of front, rear",
        ),
        (
            list(
                BEAM,
                &[body("bearing = \"rear\"", ""), body("bearing = \"rear\"", "")].concat(),
            ),
            "body.name \"block\" stands twice; expected a name of its own for each body",
        ),
        (
            list(
                BEAM,
                &[
                    body("bearing = \"rear\"", ""),
                    body("bearing = \"rear\"", "").replace("\"block\"", "\"other\""),
                ]
                .concat(),
            ),
            "bodies \"block\" and \"other\" have both a seat for the outer ring of the bearing \"rear\"; expected one \
             body",
        ),
        (
            list(BEAM, &two_seats("seat_b", "front")),
            "body \"block\" has two seats for the outer ring of the bearing \"front\"; expected one seat for each ring",
        ),
        (
            list(BEAM, &two_seats("seat_a", "rear")),
            "body \"block\" has two seats with the group \"seat_a\"; expected a group of its own for each seat",
        ),
        (
            list(BEAM, &of_matrices("", ["a.csv", "a.csv"])),
            "body \"block\" has two seats with the seat_nodes \"a.csv\"; expected a seat_nodes of its own for each \
             seat",
        ),
        (
            list(
                BEAM,
                &of_matrices("", ["a.csv", "b.csv"])
                    .replace("seat_nodes = \"a.csv\"", "reference_node = 7")
                    .replace("seat_nodes = \"b.csv\"", "reference_node = 7"),
            ),
            "body \"block\" has two seats with the reference_node \"7\"; expected a reference_node of its own for each \
             seat",
        ),
        (
            list(
                BEAM,
                &of_matrices("seat_nodes = \"s.csv\"", ["a.csv", "b.csv"])
                    .replace("\nseat_nodes = \"b.csv\"", ""),
            ),
            "body \"block\" has 2 seats, but names nodes of one, in seat_nodes of [[body]]; expected seat_nodes in \
             each [[body.seat]]",
        ),
        (
            list(
                BEAM,
                &of_matrices("", ["a.csv", "b.csv"]).replace("\nseat_nodes = \"b.csv\"", ""),
            ),
            "body \"block\": seat_nodes is missing; a body from a matrix needs stiffness, nodes and, for each seat, \
             seat_nodes or reference_node",
        ),
        (
            list(
                BEAM,
                &two_seats("seat_b", "rear").replacen("\"outer\"", "\"inner\"", 1),
            ),
            "body \"block\" has seats of inner and of outer rings, but it either turns with the shaft or stands; \
             expected seats of one kind",
        ),
        (
            list(
                BEAM,
                &two_seats("seat_b", "rear").replace("\"outer\"", "\"inner\""),
            ),
            "shaft.model is \"beam\", but body \"block\" carries several inner rings, so that it is the shaft \
             between them; expected shaft.model = \"rigid\"",
        ),
    ];
    for (text, expected) in cases {
        let found = lists.message(&text);
        assert!(found.contains(expected), "found: {found}\nexpected: {expected}");
    }
}

/// Wrong: of two bearings of one name the seats would be blamed, by a list that has that name twice.
#[test]
fn bearings_of_one_name_are_told_without_their_seats() {
    let lists = Lists::new("twin_names");
    let twins = list(BEAM, &two_seats("seat_b", "rear")).replace("name = \"rear\"", "name = \"front\"");
    let found = lists.message(&twins);
    assert!(
        found.contains("bearing.name \"front\" stands twice; expected a name of its own for each bearing"),
        "{found}"
    );
    assert!(!found.contains("expected one of"), "{found}");
}

/// Wrong: a bearing could have its folder where a run puts steps that it took back.
#[test]
fn names_of_folders_of_a_run_are_reserved() {
    let lists = Lists::new("reserved_names");
    let found = lists.message(&list(BEAM, "").replace("name = \"rear\"", "name = \"superseded_1\""));
    let expected =
        "bearing.name of bearing 2 is \"superseded_1\"; this name is reserved: the folder of a run has";
    assert!(found.contains(expected), "{found}");
}
