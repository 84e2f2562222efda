//! The page of several bearings on one shaft: shaft and bearings at a glance, then a part for each bearing, with what
//! the page of a run of one bearing has.

use std::path::Path;

use anyhow::anyhow;
use html_escape::encode_text;
use plot::{Choice, Results};
use results::failure::Failure;
use results::several::SCENE_TEXT;
use serde_json::Value;

use super::html::{Cells, digits, row, table};
use super::numbers::{self, PageNumber};
use super::page::{
    cost, document, energy, figures, key_numbers, list, meshes, program, remarks, scene, text, warnings,
};
use super::pictures::{Picture, drawn};
use super::source::{self, ReportedRun};
use super::{bearing, pictures};

/// A bearing of the list.
struct ListedBearing {
    name: String,
    source: ReportedRun,
    numbers: Vec<PageNumber>,
    pictures: Vec<Picture>,
}

/// What the table of bearings shows: heading, place in the entry of a bearing, factor to the unit, decimals.
const COLUMNS: [(&str, &str, f64, usize); 12] = [
    ("position, mm", "/position_m", 1e3, 2),
    ("x, um", "/displacement_m/0", 1e6, 3),
    ("y, um", "/displacement_m/1", 1e6, 3),
    ("z, um", "/displacement_m/2", 1e6, 3),
    ("tilt x, urad", "/rotation_rad/0", 1e6, 2),
    ("tilt y, urad", "/rotation_rad/1", 1e6, 2),
    ("force x, N", "/force_on_shaft_n/0", 1.0, 2),
    ("force y, N", "/force_on_shaft_n/1", 1.0, 2),
    ("force z, N", "/force_on_shaft_n/2", 1.0, 2),
    ("moment x, N m", "/moment_on_shaft_n_m/0", 1.0, 3),
    ("moment y, N m", "/moment_on_shaft_n_m/1", 1.0, 3),
    ("largest ball, N", "/largest_ball_force_n", 1.0, 2),
];

/// The page of the run in `dir`, whose bearings have these names, and what was not as it should be.
pub fn page(dir: &Path, names: &[String], choice: &Choice) -> Result<(String, Vec<String>), Failure> {
    let mut source = source::read(dir)?;
    source.scene = std::fs::read_to_string(dir.join(SCENE_TEXT)).ok();
    let (shaft, problems) = drawn(plot::figures(dir, choice)?);
    source.doubts.extend(problems);
    let mut parts = Vec::new();
    for name in names {
        let (part, problems) = part(dir, name, choice)?;
        source.doubts.extend(problems);
        parts.push(part);
    }
    if let Some(part) = parts.first() {
        source.commit.clone_from(&part.source.commit);
    }
    let files = parts.iter().flat_map(|part| {
        let files = part.source.files.iter();
        files.map(|(file, bytes)| (format!("{}/{file}", part.name), *bytes))
    });
    source.files.extend(files);
    Ok((html(&source, &shaft, &parts), source.doubts))
}

/// Reads a bearing; its folder has to be there.
fn part(dir: &Path, name: &str, choice: &Choice) -> Result<(ListedBearing, Vec<String>), Failure> {
    let folder = dir.join(name);
    if !folder.is_dir() {
        return Err(Failure::User(anyhow!(
            "{} has no folder {name} of its bearing {name:?}; expected the results of raceway run as they were written",
            dir.display()
        )));
    }
    let source = source::read(&folder)?;
    let (pictures, problems) = drawn(plot::figures(&folder, choice)?);
    let numbers = numbers::numbers(&Results::read(&folder)?)?;
    let problems = problems
        .iter()
        .map(|problem| format!("bearing {name:?}: {problem}"));
    let problems = source.doubts.iter().cloned().chain(problems).collect();
    let name = name.to_string();
    Ok((
        ListedBearing {
            name,
            source,
            numbers,
            pictures,
        },
        problems,
    ))
}

fn html(source: &ReportedRun, shaft: &[pictures::Picture], parts: &[ListedBearing]) -> String {
    let summary = &source.summary;
    let title = text(summary, "title");
    let mut blocks = vec![
        format!("<h1>{}</h1>", encode_text(&title)),
        about(source),
        contents(parts),
        warnings(source),
        remarks("Advice", &list(summary, "advice")),
        remarks("Filled in where the scene is open", &list(summary, "assumed")),
        bearings(summary, parts),
        figures(shaft),
    ];
    blocks.extend(parts.iter().map(|part| of_bearing(part, summary)));
    blocks.push(cost(summary, &source.files));
    blocks.push(scene(source.scene.as_deref()));
    document(&title, &blocks)
}

/// What was run, by which program, and how it ended.
fn about(source: &ReportedRun) -> String {
    let summary = &source.summary;
    let shaft = &summary["shaft"];
    let nodes = shaft["nodes"].as_u64();
    let nodes = nodes.map_or(String::new(), |n| format!(", {n} nodes"));
    let rows = [
        ("status", text(summary, "status")),
        ("scene file", text(summary, "scene")),
        ("analysis", text(summary, "analysis").replace('_', " ")),
        ("effects", list(summary, "effects").join(", ").replace('_', " ")),
        ("shaft", format!("{}{nodes}", text(shaft, "model"))),
        ("program", program(summary, &source.commit)),
        ("ended", source.ended.clone()),
    ];
    let rows = rows.iter().filter(|(_, value)| !value.is_empty());
    let rows = rows.map(|(name, value)| row(name, std::slice::from_ref(value), Cells::Text));
    table("about", None, rows)
}

/// Where the parts of the bearings are. Their names are letters, digits, _ and -.
fn contents(parts: &[ListedBearing]) -> String {
    let link = |part: &ListedBearing| format!("<a href=\"#bearing-{0}\">{0}</a>", part.name);
    let links: Vec<String> = parts.iter().map(link).collect();
    format!("<p class=\"note\">Bearings: {}</p>", links.join(", "))
}

/// Key numbers: a row per bearing at the end of the run, in the frame of the shaft.
fn bearings(summary: &Value, parts: &[ListedBearing]) -> String {
    let of_part = |part: &ListedBearing| {
        let entry = &summary["bearings"][&part.name];
        let number = |key: &str| entry.pointer(key).and_then(Value::as_f64);
        let shown = |(_, key, factor, decimals): &(&str, &str, f64, usize)| {
            number(key).map_or("-".to_string(), |value| {
                bearing::rounded(factor * value, *decimals)
            })
        };
        let whole = |key: &str| number(key).map_or("-".to_string(), |value| format!("{value:.0}"));
        let cells: Vec<String> = std::iter::once(text(entry, "orientation"))
            .chain(COLUMNS.iter().map(shown))
            .chain([format!("{} of {}", whole("/loaded_balls"), whole("/balls"))])
            .collect();
        row(&part.name, &cells, Cells::Numbers)
    };
    let head: Vec<&str> = ["bearing", "turned"]
        .into_iter()
        .chain(COLUMNS.iter().map(|(name, ..)| *name))
        .chain(["loaded balls"])
        .collect();
    format!(
        "<h2>Key numbers</h2>\n<div class=\"wide\">{}</div>\n<p class=\"note\">At the end of the run, in the frame of \
         the shaft: where the shaft stands at each bearing, and what the bearing pushes it with.</p>",
        table("numbers", Some(&head), parts.iter().map(of_part))
    )
}

/// The part of a bearing, in its own frame; its headings are one level below that of its name.
fn of_bearing(part: &ListedBearing, summary: &Value) -> String {
    let (own, source) = (&part.source.summary, &part.source);
    let entry = &summary["bearings"][&part.name];
    let position = entry["position_m"].as_f64().unwrap_or(f64::NAN);
    let rows = [
        ("contact mode", text(own, "contact_mode")),
        ("meshes", meshes(own)),
        ("stress", bearing::stress(source.scene.as_deref())),
    ];
    let rows = rows.iter().filter(|(_, value)| !value.is_empty());
    let rows = rows.map(|(name, value)| row(name, std::slice::from_ref(value), Cells::Text));
    let blocks = [
        table("about", None, rows),
        remarks("Filled in where the scene is open", &list(own, "assumed")),
        bearing::bearing(source.scene.as_deref()),
        key_numbers(&part.numbers, own),
        bearing::balls(own),
        energy(own),
        figures(&part.pictures),
    ];
    let blocks = blocks.join("\n");
    let blocks = blocks.replace("<h2>", "<h3>").replace("</h2>", "</h3>");
    format!(
        "<h2 id=\"bearing-{0}\">Bearing {0}</h2>\n<p class=\"note\">Type {1}, turned {2}, at {3} mm. All in its own \
         frame, in which a force on the shaft along +z presses it.</p>\n{blocks}",
        part.name,
        encode_text(&text(entry, "type")),
        encode_text(&text(entry, "orientation")),
        digits(1e3 * position)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(summary: Value) -> ReportedRun {
        ReportedRun {
            summary,
            doubts: vec![],
            scene: None,
            commit: "abc".into(),
            ended: String::new(),
            files: vec![],
        }
    }

    /// Wrong: a bearing would have no part, or its headings would stand beside those of the shaft.
    #[test]
    fn every_bearing_has_a_row_and_a_part() {
        let entry = |z: f64| {
            serde_json::json!({ "type": "a<b.toml", "orientation": "+z", "position_m": z, "loaded_balls": 17,
                "balls": 18, "displacement_m": [1.5e-6, 0.0, -2e-6], "force_on_shaft_n": [10.0, 0.0, -345.51] })
        };
        let summary = serde_json::json!({ "title": "pair", "shaft": { "model": "beam", "nodes": 25 },
            "bearings": { "front": entry(0.06), "rear": entry(0.13) } });
        let part = |name: &str| ListedBearing {
            name: name.into(),
            source: source(serde_json::json!({ "dofs": { "inner": 300 }, "elements": { "inner": 64 } })),
            numbers: vec![],
            pictures: vec![(format!("ball_force_{name}"), "<svg></svg>".into())],
        };
        let page = html(&source(summary), &[], &[part("front"), part("rear")]);
        for part in [
            "<h2>Key numbers</h2>",
            "<th>shaft</th><td>beam, 25 nodes</td>",
            "<a href=\"#bearing-rear\">rear</a>",
            "<h2 id=\"bearing-front\">Bearing front</h2>",
            "Type a&lt;b.toml, turned +z, at 130.00 mm.",
            "<h3>Key numbers</h3>",
            "<th>meshes</th><td>inner ring 64 elements, 300 dofs</td>",
            "<td class=\"number\">1.500</td>",
            "<td class=\"number\">-345.51</td>",
            "<td class=\"number\">17 of 18</td>",
            "aria-label=\"ball force rear\"",
        ] {
            assert!(page.contains(part), "{part} in {page}");
        }
        assert!(super::super::page::is_page(page.as_bytes()));
    }
}
