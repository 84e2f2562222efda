//! Turns an error of the TOML reader into line, column, key and advice.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::hints;

/// Where and what, in the words of a scene.
#[derive(Debug)]
pub struct Located {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Key, value, what was expected.
    pub message: String,
    /// The line itself.
    content: String,
    /// Length of the mark below it, characters.
    marks: usize,
    /// Whether it is about a table that the file lacks: no line has it.
    pub is_of_whole_file: bool,
}

impl Located {
    /// The line itself with a mark below; `line` is the number that the user knows it by.
    pub fn excerpt(&self, line: usize) -> String {
        let gutter = " ".repeat(line.to_string().len());
        format!(
            "{gutter} |\n{line} | {}\n{gutter} | {}{}",
            self.content,
            " ".repeat(self.column - 1),
            "^".repeat(self.marks)
        )
    }
}

/// Locates the reader's `message` about a stretch of the text, in bytes.
pub fn locate(text: &str, span: Option<Range<usize>>, message: &str) -> Located {
    let span = span.unwrap_or(0..0);
    let start = floor_boundary(text, span.start);
    let line_start = text[..start].rfind('\n').map_or(0, |i| i + 1);
    let line = 1 + text[..start].matches('\n').count();
    let column = 1 + text[line_start..start].chars().count();
    let content = text[line_start..].lines().next().unwrap_or("");
    let end = floor_boundary(
        text,
        span.end
            .clamp(start, line_start.max(start).max(line_start + content.len())),
    );
    let marks = text[start..end].chars().count().max(1);
    let message = describe(text, span, message);
    Located {
        line,
        column,
        is_of_whole_file: message.starts_with(NO_TABLE),
        message,
        content: content.to_string(),
        marks,
    }
}

/// A file without a bearing is no scene yet.
fn missing_table(name: &str) -> String {
    match name {
        "bearing" => format!("{NO_TABLE}{name}] is missing; \"raceway init\" writes a scene to start from"),
        _ => format!("{NO_TABLE}{name}] is missing"),
    }
}

/// Start of the message on a table that the file lacks.
const NO_TABLE: &str = "the table [";

fn floor_boundary(text: &str, mut index: usize) -> usize {
    index = index.min(text.len());
    while !text.is_char_boundary(index) {
        index -= 1;
    }
    index
}

/// Whole numbers of a file.
const WHOLE_RANGE: &str =
    "this whole number is too large; expected -9223372036854775808 to 9223372036854775807";

/// The line, from 1, on which a text has the key that a problem begins with, such as `bearing.width` or
/// `[probes.node.a]`. A key that is missing has the line of its table, a computed one that of a key that it is computed
/// from.
pub fn line_of(text: &str, problem: &str) -> Option<usize> {
    let first = problem.split([' ', ',', ':']).next()?;
    let key = first.trim_matches(['[', ']']);
    let rest = &problem[first.len()..];
    let (table, _) = key.rsplit_once('.').unwrap_or((key, ""));
    let source = rest
        .strip_prefix(" (from ")
        .and_then(|rest| rest.split([' ', ')']).next());
    let document = DeTable::parse(text).ok()?;
    let place = place_of(document.get_ref(), key)
        .or_else(|| place_of(document.get_ref(), &format!("{table}.{}", source?)))
        .or_else(|| place_of(document.get_ref(), table).filter(|_| rest.starts_with(" is missing;")))?;
    Some(1 + text[..floor_boundary(text, place.start)].matches('\n').count())
}

/// Where a document has a dotted key.
fn place_of(document: &DeTable<'_>, key: &str) -> Option<Range<usize>> {
    let mut names = key.split('.');
    let (mut place, mut value) = entry(document, names.next()?)?;
    for name in names {
        (place, value) = entry(value.get_ref().as_table()?, name)?;
    }
    Some(place)
}

/// Whether a stretch of a text, in bytes, is where a dotted key stands, or in its value. A table of a list is reached
/// by its number from 0.
pub fn is_at(text: &str, key: &str, at: &Range<usize>) -> bool {
    let Ok(document) = DeTable::parse(text) else {
        return false;
    };
    let mut names = key.split('.').map(str::trim);
    let mut found = names.next().and_then(|name| entry(document.get_ref(), name));
    for name in names {
        found = found.and_then(|(_, value)| match value.get_ref() {
            DeValue::Table(table) => entry(table, name),
            DeValue::Array(list) => {
                let item = list.get(name.parse::<usize>().ok()?)?;
                Some((item.span().start..item.span().start, item))
            }
            _ => None,
        });
    }
    found.is_some_and(|(place, value)| {
        // The value of a table in parts is its heading, which stands before the keys.
        let within = |stretch: &Range<usize>| stretch.start <= at.start && at.end <= stretch.end;
        within(&place) || (value.get_ref().as_table().is_none() && within(&value.span()))
    })
}

/// Short names of keys.
const SHORT: [(&str, &str); 3] = [
    ("bore_diameter", "bore"),
    ("outside_diameter", "outside"),
    ("contact_angle", "free_contact_angle"),
];

/// The other name of a key that has two.
pub fn other_name(name: &str) -> Option<&'static str> {
    SHORT.iter().find_map(|&(long, short)| match name {
        _ if name == long => Some(short),
        _ if name == short => Some(long),
        _ => None,
    })
}

/// The place of a key in its table, and its value; the key may have its other name there.
pub fn entry<'a, 'i>(table: &'a DeTable<'i>, name: &str) -> Option<(Range<usize>, &'a Spanned<DeValue<'i>>)> {
    let find = |name: &str| table.iter().find(|(key, _)| key.get_ref() == name);
    let (key, value) = find(name).or_else(|| find(other_name(name)?))?;
    Some((key.span(), value))
}

/// Adds the key's path to the reader's message, and says it in the words of a scene.
fn describe(text: &str, span: Range<usize>, message: &str) -> String {
    let message = message
        .trim_end()
        .replace('\n', "; ")
        .replace("integer number overflowed", WHOLE_RANGE)
        .replace("wanted string or table", "expected a string");
    let Ok(document) = DeTable::parse(text) else {
        return not_toml(text, span.start, &message);
    };
    let path = match span == document.span() {
        true => String::new(),
        false => path_at(document.get_ref(), &span),
    };
    let message = message
        .replace("expected i64", "expected a whole number")
        .replace("expected f64", "expected a number")
        .replace("expected a boolean", "expected true or false")
        .replace(
            "expected an array of length 2",
            "expected two values in brackets, [a, b]",
        );
    let names = quoted(&message);
    if message.starts_with("unknown field") {
        let (name, valid) = names.split_first().map_or(("", &[][..]), |(n, v)| (*n, v));
        let table = match path.rsplit_once('.') {
            Some((table, _)) => format!(" in [{table}]"),
            None => String::new(),
        };
        let advice = advice("keys", name, valid);
        return format!("unknown key {name:?}{table}{advice}");
    }
    if message.starts_with("unknown variant") {
        let (name, valid) = names.split_first().map_or(("", &[][..]), |(n, v)| (*n, v));
        return format!("{path} is {name:?}{}", advice("values", name, valid));
    }
    if message.starts_with("missing field") {
        let name = names.first().copied().unwrap_or("");
        // What lacks a table is the whole scene, whose first key is no table.
        let is_value = |value: &DeValue<'_>| value.as_table().is_none() && value.as_array().is_none();
        let first = document.get_ref().get(path.as_str());
        let table = path.as_str();
        return match table {
            _ if first.is_some_and(|first| is_value(first.get_ref())) => missing_table(name),
            "" => missing_table(name),
            table => format!("[{table}] has no key {name:?}, which is required"),
        };
    }
    if path.is_empty() {
        message
    } else if message == "invalid type: map, expected a sequence" {
        format!("[{path}] is one table, expected a list of them: write [[{path}]] with two brackets")
    } else {
        format!("{path}: {message}")
    }
}

/// The message on a text that is no TOML from the byte `at` on, with a hint where there is one.
fn not_toml(text: &str, at: usize, message: &str) -> String {
    let line = text[..floor_boundary(text, at)].matches('\n').count();
    let hint = text.lines().nth(line).and_then(hints::of_syntax);
    let repeated = hints::first_of(text, line + 1).filter(|_| message.contains("duplicate key"));
    match hint {
        _ if let Some(first) = repeated => {
            format!("this is not TOML: {message}; it stands in line {first} too")
        }
        Some(hint) => format!("this is not TOML: {message}; {hint}"),
        None => format!("this is not TOML: {message}"),
    }
}

/// `; did you mean ...? valid keys are ...`, or the tables that have the key.
fn advice(what: &str, name: &str, valid: &[&str]) -> String {
    let quote = |names: &[&str]| -> Vec<String> { names.iter().map(|v| format!("{v:?}")).collect() };
    let list = quote(valid);
    let meant = match hints::meant(name, valid).as_slice() {
        [] if what == "keys" => hints::elsewhere(name).map_or(String::new(), |place| format!("{place}; ")),
        [] => String::new(),
        names => format!("did you mean {}? ", quote(names).join(" or ")),
    };
    match list.as_slice() {
        [] => format!("; {meant}this table has no {what}"),
        [only] => format!("; {meant}the only valid {} is {only}", what.trim_end_matches('s')),
        _ => format!("; {meant}valid {what} are {}", list.join(", ")),
    }
}

/// The words between backticks.
fn quoted(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// Dotted path of the innermost key or value that contains the span.
fn path_at(table: &DeTable<'_>, span: &Range<usize>) -> String {
    let mut best: Option<(usize, String)> = None;
    visit(table, "", span, &mut best);
    best.map_or(String::new(), |(_, path)| path)
}

fn visit(table: &DeTable<'_>, prefix: &str, span: &Range<usize>, best: &mut Option<(usize, String)>) {
    for (key, value) in table {
        let path = match prefix {
            "" => key.get_ref().to_string(),
            _ => format!("{prefix}.{}", key.get_ref()),
        };
        offer(key.span(), &path, span, best);
        visit_value(value, &path, span, best);
    }
}

fn visit_value(
    value: &Spanned<DeValue<'_>>,
    path: &str,
    span: &Range<usize>,
    best: &mut Option<(usize, String)>,
) {
    offer(value.span(), path, span, best);
    match value.get_ref() {
        DeValue::Table(table) => visit(table, path, span, best),
        DeValue::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                visit_value(item, &format!("{path}[{i}]"), span, best);
            }
        }
        _ => {}
    }
}

/// Keeps the shortest stretch of text that contains the span.
fn offer(candidate: Range<usize>, path: &str, span: &Range<usize>, best: &mut Option<(usize, String)>) {
    let contains = candidate.start <= span.start && span.end <= candidate.end && !candidate.is_empty();
    let length = candidate.len();
    if contains && best.as_ref().is_none_or(|(shortest, _)| length <= *shortest) {
        *best = Some((length, path.to_string()));
    }
}
