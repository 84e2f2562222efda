//! Slips in lists of bearings that once ended late, or in words on another table.

use super::several::{BEAM, Lists, kind, list};

/// Wrong: one slip would be told twice, the second time of a table that the scene does not have.
#[test]
fn a_negative_spring_is_one_problem() {
    let lists = Lists::new("negative_spring");
    let said = lists.message(&list(
        BEAM,
        "[pairing]\nspring = \"-100 N\"\nsliding = \"rear\"\n",
    ));
    let expected = "pairing.spring is -100 N; expected more than 0 and at most 1e9 N";
    assert!(said.contains(expected), "{said}");
    assert!(!said.contains("spring_preload"), "{said}");
}

/// Wrong: an offset would act on a bearing that is not there, on one side alone, or names would stand without it.
#[test]
fn an_offset_of_some_bearings_needs_them_on_both_sides() {
    let lists = Lists::new("offset_of_some");
    let cases = [
        (
            "offset = \"8 um\"\nbearings = [\"front\"]",
            "pairing.offset is 8 um, but all bearings have the same orientation",
        ),
        (
            "offset = \"8 um\"\nbearings = [\"front\", \"back\"]",
            "pairing.bearings has \"back\"; expected names of bearings: front, rear",
        ),
        (
            "spring = \"500 N\"\nsliding = \"rear\"\nbearings = [\"front\"]",
            "pairing.bearings needs offset, the distance by which these bearings press on each other",
        ),
    ];
    for (keys, expected) in cases {
        let said = lists.message(&list(BEAM, &format!("[pairing]\n{keys}\n")));
        assert!(said.contains(expected), "{keys}: {said}");
    }
}

/// Wrong: a shaft would not take the name that a body takes, or have other numbers than the name stands for.
#[test]
fn the_material_of_a_shaft_has_a_name() {
    let lists = Lists::new("named_shaft");
    let numbers = list(BEAM, "");
    let old = numbers
        .lines()
        .find(|line| line.starts_with("material = "))
        .unwrap();
    let named = numbers.replacen(old, "material = \"bearing steel\"", 1);
    let [expected, found] = [&numbers, &named].map(|text| lists.several(text, &[]).shaft);
    assert_eq!(found.kind, expected.kind);
    assert!(expected.assumed.is_empty());
    assert!(
        found.assumed[0].starts_with("shaft.material is bearing steel: Young's modulus 207 GPa"),
        "{:?}",
        found.assumed
    );
    let said = lists.message(&numbers.replacen(old, "material = \"cheese\"", 1));
    assert!(
        said.contains("\"cheese\" is no material with a name here"),
        "{said}"
    );
}

/// Wrong: a list with contacts that have no tangent would pass every check and end in its first equilibrium.
#[test]
fn contacts_without_a_tangent_are_refused_in_a_list() {
    let lists = Lists::new("facets");
    for (old, new, expected) in [
        (
            "mode = \"patch\"",
            "mode = \"facet\"",
            "contact.mode is \"facet\" in the type of bearing \"front\", types/kind.toml: a list balances its shaft by \
             the stiffness of each bearing, and such contacts change it wherever a ball stands; expected \
             contact.mode = \"patch\", or one table [bearing]",
        ),
        (
            "edges = false",
            "edges = true",
            "contact.edges is true in the type of bearing \"front\", types/kind.toml",
        ),
    ] {
        let changed = kind()
            .replacen(old, new, 1)
            .replacen("ball = \"sphere\"", "ball = \"half_space\"", 1);
        assert_ne!(changed, kind(), "{old}");
        std::fs::write(lists.0.join("types/kind.toml"), changed).unwrap();
        let said = lists.message(&list(BEAM, ""));
        assert!(said.contains(expected), "{said}");
    }
}
