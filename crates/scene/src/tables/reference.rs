//! The reference of all tables and keys of a scene: the commented examples that the pages of the tables show, and those
//! of the effects. `raceway help scene` prints it, and `docs/reference.md` is what it prints.
//!
//! Tests hold it: every example is a scene or a table of one, and every key that the program takes stands in it.

use dynamics::effects::Effects;

/// Scenes at rest, with the tables of most scenes.
pub const REST: &str = include_str!("example.toml");
/// Motion, of which the tables that say more than those at rest are shown.
pub const MOTION: &str = include_str!("example_dynamic.toml");
/// All other tables.
pub const OTHERS: [&str; 19] = [
    include_str!("example_include.toml"),
    include_str!("example_catalogue.toml"),
    include_str!("example_materials.toml"),
    include_str!("example_body.toml"),
    include_str!("example_balls.toml"),
    include_str!("example_cage.toml"),
    include_str!("example_lubricant.toml"),
    include_str!("example_profiles.toml"),
    include_str!("example_static.toml"),
    include_str!("example_modes.toml"),
    include_str!("example_quasi_static.toml"),
    include_str!("example_output.toml"),
    include_str!("example_reduction.toml"),
    include_str!("example_stress.toml"),
    include_str!("example_probes.toml"),
    include_str!("example_stress_probes.toml"),
    include_str!("example_gauges.toml"),
    include_str!("example_life.toml"),
    include_str!("example_heat.toml"),
];
/// Tables of a list of bearings on one shaft.
pub const SEVERAL: &str = include_str!("example_several.toml");
/// Tables of [`SEVERAL`] that a scene with one bearing has as well.
const OF_BOTH: [&str; 4] = ["", "solver", "output", "static"];
/// Tables of [`MOTION`] that say more than those of [`REST`].
const OF_MOTION: [&str; 4] = ["shaft", "speed", "output", "dynamic"];

/// A table of the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceTable {
    /// Dotted name of the table; empty for the keys of the scene itself.
    pub table: String,
    /// Its commented TOML, without blank lines at its end.
    pub text: String,
}

impl ReferenceTable {
    /// The keys that it shows, also those in comments.
    pub fn keys(&self) -> Vec<&str> {
        self.text
            .lines()
            .filter_map(|line| {
                line.trim_start_matches("# ")
                    .split_once(" = ")
                    .map(|(key, _)| key.trim())
            })
            .filter(|key| {
                !key.is_empty()
                    && key
                        .bytes()
                        .all(|b| b.is_ascii_alphanumeric() || b"_.".contains(&b))
            })
            .collect()
    }
}

/// All tables in the order of the reference: those of scenes at rest, effects, motion, the others.
pub fn all() -> Vec<ReferenceTable> {
    let is_effect = |block: &ReferenceTable| block.table.starts_with("effects.");
    let of_motion = |block: &ReferenceTable| {
        let first = block.table.split('.').next().unwrap_or_default();
        OF_MOTION.contains(&first)
    };
    let rest = blocks(REST).into_iter().filter(|block| !is_effect(block));
    let mut all: Vec<ReferenceTable> = rest.collect();
    for entry in Effects::default().list() {
        all.extend(blocks(entry.about().example));
    }
    all.extend(blocks(MOTION).into_iter().filter(of_motion));
    all.extend(OTHERS.iter().flat_map(|text| blocks(text)));
    // One after the other where a table has several.
    let mut order: Vec<String> = Vec::new();
    for block in &all {
        let first = block.table.split('.').next().unwrap_or_default().to_string();
        if !order.contains(&first) {
            order.push(first);
        }
    }
    let place = |block: &ReferenceTable| {
        order
            .iter()
            .position(|first| block.table.split('.').next() == Some(first))
    };
    all.sort_by_key(place);
    all
}

/// The tables that only a list of bearings has, or that say something else there.
pub fn of_lists() -> Vec<ReferenceTable> {
    let is_own = |block: &ReferenceTable| !OF_BOTH.contains(&block.table.as_str());
    blocks(SEVERAL).into_iter().filter(is_own).collect()
}

/// The tables that have a key, or whose name begins with `topic`: `bearing`, `bearing.width`, `width`; of no such topic
/// those in whose dotted names, or in those of whose keys, it stands: `gauge` of `probes.gauge.NAME`, `harmonic` of
/// `schedule.harmonic`.
pub fn about(topic: &str) -> Vec<ReferenceTable> {
    let topic = topic.trim_matches(['[', ']']);
    let all = [all(), of_lists()].concat();
    let is_table =
        |block: &&ReferenceTable| block.table == topic || block.table.starts_with(&format!("{topic}."));
    let has_key = |block: &&ReferenceTable| match topic.rsplit_once('.') {
        Some((table, key)) => block.table == table && block.keys().contains(&key),
        None => block.keys().contains(&topic) || block.table.ends_with(&format!(".{topic}")),
    };
    // A dotted name may be a key of one kind of scene, and a table of the other.
    let is_dotted = topic.contains('.');
    let both = |block: &&ReferenceTable| is_table(block) || is_dotted && has_key(block);
    let tables: Vec<ReferenceTable> = all.iter().filter(both).cloned().collect();
    if !tables.is_empty() {
        return tables;
    }
    let with_key: Vec<ReferenceTable> = all.iter().filter(has_key).cloned().collect();
    if !with_key.is_empty() {
        return with_key;
    }
    let has_part = |name: &str| name.split('.').any(|part| part == topic);
    let names_it = |block: &&ReferenceTable| has_part(&block.table) || block.keys().into_iter().any(has_part);
    all.iter().filter(names_it).cloned().collect()
}

/// Blocks as a page: a heading each, and the TOML.
pub fn page(blocks: &[ReferenceTable]) -> String {
    let mut page = String::new();
    let mut last = None;
    for block in blocks {
        let first = block.table.split('.').next().unwrap_or_default();
        if last != Some(first) {
            page += &match first {
                "" => "\n## The scene itself\n".to_string(),
                _ => format!("\n## [{first}]\n"),
            };
        }
        last = Some(first);
        page += &format!("\n```toml\n{}\n```\n", block.text);
    }
    page
}

/// The whole page.
pub fn whole_page() -> String {
    format!(
        "# Reference of scenes\n\nEvery table and key of a scene, with its comment. `raceway help scene` prints this \
         page, `raceway help scene KEY`\nwhat it says of a table or a key. What scenes are for: \
         [scenes.md](scenes.md).\n{}{}",
        page(&all()),
        page_of_lists()
    )
}

/// The part on lists.
fn page_of_lists() -> String {
    let blocks = of_lists();
    let shown = blocks
        .iter()
        .map(|block| format!("\n```toml\n{}\n```\n", block.text));
    format!(
        "\n## A list of bearings\n\nTables that only a list `[[bearing]]` has, or that say something else there \
         ([several.md](several.md)).\n{}",
        shown.collect::<String>()
    )
}

/// The tables of a text with the comments in them. A commented header, `# [name]`, begins a table too, which is shown
/// without its comment signs.
fn blocks(text: &str) -> Vec<ReferenceTable> {
    let mut blocks: Vec<ReferenceTable> = Vec::new();
    let mut hidden = false;
    for line in text.lines() {
        let bare = line.strip_prefix("# ").unwrap_or(line);
        if let Some(name) = header(bare) {
            hidden = bare != line;
            blocks.push(ReferenceTable {
                table: name.to_string(),
                text: String::new(),
            });
        } else if blocks.is_empty() && !line.is_empty() {
            blocks.push(ReferenceTable {
                table: String::new(),
                text: String::new(),
            });
        }
        let Some(block) = blocks.last_mut() else { continue };
        block.text += if hidden { bare } else { line };
        block.text.push('\n');
    }
    for block in &mut blocks {
        block.text.truncate(block.text.trim_end().len());
    }
    blocks
}

/// The name in a header.
fn header(line: &str) -> Option<&str> {
    let inside = line.strip_prefix('[')?;
    let (name, _) = inside.trim_start_matches('[').split_once(']')?;
    let is_name = name
        .bytes()
        .all(|b| b.is_ascii_alphanumeric() || b"_.".contains(&b));
    is_name.then_some(name)
}
