//! The reference of scenes against the program.

use super::super::several::RawSeveral;
use super::super::{gather, reference};
use super::*;

/// The keys that the program takes in the table of a scene, from its message on one that it does not take.
fn taken(table: &str) -> Vec<String> {
    // An array of tables takes what its tables take.
    let header = match table {
        "" => "no_such_key = 1\n".to_string(),
        "body" => "[[body]]\nno_such_key = 1\n".to_string(),
        "body.seat" => "[[body]]\n[[body.seat]]\nno_such_key = 1\n".to_string(),
        "inner.cut" | "effects.seat_form" => format!("[[{table}]]\nno_such_key = 1\n"),
        _ if table.starts_with("profiles.") => format!("[[{table}]]\nno_such_key = 1\n"),
        _ => format!("[{table}]\nno_such_key = 1\n"),
    };
    taken_by::<RawScene>(&header)
}

/// The same of a kind of scene, under a header with a key that it does not take.
fn taken_by<T: serde::de::DeserializeOwned>(header: &str) -> Vec<String> {
    let found = gather::read::<T>(header).map(|_| ()).unwrap_err();
    let unknown = found
        .iter()
        .find(|finding| finding.message.starts_with("unknown field `no_such_key`"));
    let message = &unknown.unwrap_or_else(|| panic!("{header}: {found:?}")).message;
    message
        .split('`')
        .skip(3)
        .step_by(2)
        .map(str::to_string)
        .collect()
}

/// Wrong: a key would be in the program but not in its reference, or the reference would show one that is refused.
#[test]
fn every_key_of_the_program_is_in_the_reference_and_none_other() {
    let all = reference::all();
    let mut tables: Vec<&str> = all.iter().map(|block| block.table.as_str()).collect();
    tables.sort_unstable();
    tables.dedup();
    for table in tables {
        let taken = taken(table);
        let of_table = |block: &&reference::ReferenceTable| block.table == table;
        // The outer ring has "the same keys".
        let same = table.replace("outer", "inner");
        let shown = |block: &&reference::ReferenceTable| block.table == table || block.table == same;
        let text: String = all
            .iter()
            .filter(shown)
            .map(|block| block.text.clone() + "\n")
            .collect();
        for key in &taken {
            let is_table = all.iter().any(|block| {
                let inside = match table {
                    "" => Some(block.table.as_str()),
                    _ => block
                        .table
                        .strip_prefix(same.as_str())
                        .and_then(|rest| rest.strip_prefix('.')),
                };
                inside.is_some_and(|rest| rest.split('.').next() == Some(key))
            });
            let other = locate::other_name(key).is_some_and(|other| text.contains(other));
            let is_shown = text.contains(key.as_str()) || is_table || other;
            assert!(
                is_shown,
                "[{table}] takes {key}, which the reference does not show"
            );
        }
        let blocks = all.iter().filter(of_table);
        for key in blocks.flat_map(reference::ReferenceTable::keys) {
            let first = key.split('.').next().unwrap();
            assert!(
                taken.iter().any(|t| t == first),
                "[{table}] does not take {key}, which the reference shows"
            );
        }
    }
}

/// Wrong: a table of the program would have no reference at all.
#[test]
fn every_table_of_the_program_is_in_the_reference() {
    let all = reference::all();
    for table in taken("") {
        let has = |block: &reference::ReferenceTable| {
            block.table == table
                || block.table.starts_with(&format!("{table}."))
                || block.table.is_empty() && ["title", "include"].contains(&table.as_str())
        };
        assert!(all.iter().any(has), "the reference has no [{table}]");
    }
    for effect in taken("effects") {
        let table = format!("effects.{effect}");
        assert!(
            all.iter().any(|block| block.table == table),
            "the reference has no [{table}]"
        );
    }
}

/// Wrong: a key of a list would be in the program but not in its reference, or the reference show one that is refused.
#[test]
fn every_key_of_a_list_is_in_the_reference_and_none_other() {
    let all = reference::of_lists();
    for table in ["bearing", "pairing", "shaft", "shaft.section", "shaft.load"] {
        let header = match table {
            "pairing" | "shaft" => format!("[{table}]"),
            _ => format!("[[{table}]]"),
        };
        let taken = taken_by::<RawSeveral>(&format!("{header}\nno_such_key = 1\n"));
        let own = || all.iter().filter(|block| block.table == table);
        let text: String = own().map(|block| block.text.clone() + "\n").collect();
        for key in &taken {
            let inside = format!("{table}.{key}");
            let is_shown = text.contains(key.as_str()) || all.iter().any(|block| block.table == inside);
            assert!(
                is_shown,
                "[{table}] takes {key}, which the reference does not show"
            );
        }
        for key in own().flat_map(reference::ReferenceTable::keys) {
            assert!(taken.iter().any(|t| t == key), "[{table}] does not take {key}");
        }
    }
}

/// Wrong: the page of the documentation would be another than what the program prints.
#[test]
fn the_page_is_what_the_program_prints() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference.md");
    let page = std::fs::read_to_string(path).unwrap();
    let printed = reference::whole_page();
    assert_eq!(
        page.trim_end(),
        printed.trim_end(),
        "docs/reference.md is old; write it: raceway help scene > docs/reference.md"
    );
}

/// Wrong: `raceway help scene KEY` would show other tables, or none.
#[test]
fn keys_are_found_by_their_name_and_by_that_of_their_table() {
    let tables =
        |topic: &str| -> Vec<String> { reference::about(topic).into_iter().map(|b| b.table).collect() };
    assert_eq!(tables("contact_angle"), ["bearing", "life"]);
    assert_eq!(tables("bearing.pitch_diameter"), ["bearing"]);
    assert_eq!(tables("[effects.gravity]"), ["effects.gravity"]);
    assert_eq!(tables("gravity"), ["effects.gravity"]);
    assert_eq!(
        tables("dynamic"),
        ["dynamic", "dynamic.adaptive", "dynamic.start.given"]
    );
    assert_eq!(tables("shaft.mass"), ["shaft", "shaft.mass"]);
    assert_eq!(tables("pairing"), ["pairing"]);
    assert_eq!(tables("shaft.load"), ["shaft.load"]);
    assert_eq!(tables("shaft.section"), ["shaft.section"]);
    assert_eq!(tables("bearing.position"), ["bearing", "bearing"]);
    let of_both = [
        "bearing",
        "bearing",
        "bearing.ball_diameters",
        "bearing",
        "bearing",
    ];
    assert_eq!(tables("bearing"), of_both);
    assert_eq!(tables("cheese"), Vec::<String>::new());
}
