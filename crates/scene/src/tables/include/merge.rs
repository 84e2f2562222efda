//! Two texts of TOML become one: lines of a table that both have stand under one header.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_edit::Key;

use super::locate;

/// Where a line comes from; lines count from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LineSource {
    Scene(usize),
    Included(usize),
    /// The comment before what is included.
    Heading,
}

/// A line of the new text.
#[derive(Clone, Copy, Debug)]
pub struct TextLine<'a> {
    /// Empty for a heading.
    pub text: &'a str,
    pub from: LineSource,
}

/// A value that stands in both texts.
#[derive(Debug)]
pub struct Clash {
    /// Dotted path.
    pub key: String,
    /// Its place in the first text, bytes.
    pub at: usize,
    /// Its place in the second text, bytes.
    pub other_at: usize,
}

/// A header with the lines below it; the first section has no header.
struct Headed {
    /// Names of the path.
    names: Vec<String>,
    is_array: bool,
    /// Lines, from 0, of the header and all that belongs to it.
    lines: Range<usize>,
}

/// Both texts in one; `statement` is the line, from 1, behind which keys without a table are put. They must not clash.
pub fn merge<'a>(scene: &'a str, other: &'a str, statement: usize) -> Result<Vec<TextLine<'a>>, String> {
    let (scene_lines, other_lines): (Vec<&str>, Vec<&str>) =
        (scene.lines().collect(), other.lines().collect());
    let (sections, mut left) = (sections(scene)?, sections(other)?);
    let mut merged: Vec<TextLine<'a>> = Vec::new();
    let included = |i: usize| TextLine {
        text: other_lines[i],
        from: LineSource::Included(i),
    };
    let heading = TextLine {
        text: "",
        from: LineSource::Heading,
    };
    for section in &sections {
        let is_root = section.names.is_empty();
        let place = match is_root {
            true => statement,
            false => end_of_values(&scene_lines, &section.lines),
        };
        let own = |lines: Range<usize>| {
            let line = |i: usize| TextLine {
                text: scene_lines[i],
                from: LineSource::Scene(i),
            };
            lines.map(line)
        };
        merged.extend(own(section.lines.start..place));
        let same = |s: &Headed| s.names == section.names && !s.is_array && !section.is_array;
        if let Some(i) = left.iter().position(same) {
            let body = left.remove(i).lines;
            let first = body.start + usize::from(!is_root);
            let end = end_of_values(&other_lines, &body);
            if first < end {
                merged.push(heading);
                merged.extend((first..end).map(included));
            }
        }
        merged.extend(own(place..section.lines.end));
    }
    if left.iter().any(|s| !s.lines.is_empty()) {
        merged.push(heading);
    }
    merged.extend(left.into_iter().flat_map(|s| s.lines).map(included));
    let text: String = merged.iter().map(|line| line.text.to_string() + "\n").collect();
    match DeTable::parse(&text) {
        Ok(_) => Ok(merged),
        Err(error) => Err(format!(
            "what is included does not go with this file ({}): write each table with its header, [name], in both",
            error.message()
        )),
    }
}

/// A text without the tables whose names are not wanted: their lines are blank. Keys without a table stay.
pub fn blanked(text: &str, is_wanted: impl Fn(&[String]) -> bool) -> Result<String, String> {
    let mut lines: Vec<&str> = text.lines().collect();
    for section in sections(text)? {
        if !section.names.is_empty() && !is_wanted(&section.names) {
            lines[section.lines].fill("");
        }
    }
    Ok(lines.iter().map(|line| line.to_string() + "\n").collect())
}

/// The line behind the last one that is neither empty nor a comment.
fn end_of_values(lines: &[&str], range: &Range<usize>) -> usize {
    let is_value = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let last = range.clone().rev().find(|i| is_value(lines[*i]));
    last.map_or(range.start, |i| i + 1)
}

/// The sections of a text.
fn sections(text: &str) -> Result<Vec<Headed>, String> {
    let document = DeTable::parse(text).map_err(|error| error.message().to_string())?;
    let mut values = Vec::new();
    for (_, value) in document.get_ref().iter() {
        spans(value, text, &mut values);
    }
    let inside_value = |at: usize| values.iter().any(|span| span.start < at && at < span.end);
    let mut sections = vec![Headed {
        names: Vec::new(),
        is_array: false,
        lines: 0..0,
    }];
    let mut at = 0;
    for (i, line) in text.split_inclusive('\n').enumerate() {
        if line.trim_start().starts_with('[') && !inside_value(at) {
            let is_array = line.trim_start().starts_with("[[");
            sections.push(Headed {
                names: names(line)?,
                is_array,
                lines: i..i,
            });
        }
        if let Some(section) = sections.last_mut() {
            section.lines.end = i + 1;
        }
        at += line.len();
    }
    Ok(sections)
}

/// The names in a header.
fn names(line: &str) -> Result<Vec<String>, String> {
    let inside = line.trim_start().trim_start_matches('[');
    let path = inside.split(']').next().unwrap_or_default();
    let keys = Key::parse(path).map_err(|error| error.to_string())?;
    Ok(keys.iter().map(|key| key.get().to_string()).collect())
}

/// Whether it is a table with a header or dotted keys, no value in braces.
fn is_section(value: &Spanned<DeValue<'_>>, text: &str) -> bool {
    value.get_ref().is_table() && !text[value.span()].starts_with('{')
}

/// The places of the values of a table.
fn spans(value: &Spanned<DeValue<'_>>, text: &str, found: &mut Vec<Range<usize>>) {
    match value.get_ref() {
        DeValue::Table(table) if is_section(value, text) => {
            table.iter().for_each(|(_, value)| spans(value, text, found));
        }
        DeValue::Array(items) if items.first().is_some_and(|item| is_section(item, text)) => {
            items.iter().for_each(|item| spans(item, text, found));
        }
        _ => found.push(value.span()),
    }
}

/// Values that stand in both texts.
pub fn clashes(scene: &str, other: &str) -> Vec<Clash> {
    let mut found = Vec::new();
    if let (Ok(a), Ok(b)) = (DeTable::parse(scene), DeTable::parse(other)) {
        find_clashes((a.get_ref(), scene), (b.get_ref(), other), "", &mut found);
    }
    found.sort_by_key(|clash| clash.at);
    found
}

fn find_clashes(
    (scene, text): (&DeTable<'_>, &str),
    (other, other_text): (&DeTable<'_>, &str),
    path: &str,
    found: &mut Vec<Clash>,
) {
    for (key, value) in other {
        let Some((place, own)) = locate::entry(scene, key.get_ref()) else {
            continue;
        };
        let below = match path {
            "" => key.get_ref().to_string(),
            _ => format!("{path}.{}", key.get_ref()),
        };
        match (own.get_ref().as_table(), value.get_ref().as_table()) {
            (Some(a), Some(b)) if is_section(own, text) && is_section(value, other_text) => {
                find_clashes((a, text), (b, other_text), &below, found);
            }
            _ => found.push(Clash {
                key: below,
                at: place.start,
                other_at: key.span().start,
            }),
        }
    }
}
