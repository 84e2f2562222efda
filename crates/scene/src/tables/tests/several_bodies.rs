//! `[[body]]` in lists of bearings.

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
    assert_eq!(front.body, None);
    let own = rear.body.as_ref().unwrap();
    assert_eq!((own.name.as_str(), own.is_turned), ("block", true));
    let support = |scene: &Scene| scene.outer.body.as_ref().unwrap().support;
    assert_ne!(support(front), support(rear));
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
            "bodies \"block\" and \"block\" have both a seat for the bearing \"rear\"; expected one body",
        ),
        (
            list(
                BEAM,
                &body(
                    "bearing = \"front\"",
                    "[[body.seat]]\nring = \"outer\"\ngroup = \"seat_b\"\nbearing = \"rear\"\n",
                ),
            ),
            "body \"block\" has 2 seats, but a body that carries several bearings is not solved; give each bearing a \
             [[body]] of its own",
        ),
    ];
    for (text, expected) in cases {
        let found = lists.message(&text);
        assert!(found.contains(expected), "found: {found}\nexpected: {expected}");
    }
}
