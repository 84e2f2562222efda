//! Reads the tables of a text and finds all that is not of the format in one go: keys that are missing or unknown,
//! values of the wrong kind.
//!
//! The reader of tables stops at its first error. So each error is written down, the text mended in memory in the
//! simplest way that the message offers, and read again: a missing key gets the value that the message has as an
//! example, an unknown key the name that was meant, or it is taken out. What a mended text says is thrown away.
//! Mended values have places beyond the end of the text, so that errors about them are told from those of the user.
//! Where a message offers nothing, the search ends with what was found. Cost: one reading per error, some 0.2 ms.

use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};

use super::hints;

/// More errors than this are no slips.
const MOST: usize = 200;

/// An error of the reader.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Where, in bytes of the text.
    pub span: Option<Range<usize>>,
    /// The words of the reader.
    pub message: String,
}

impl Finding {
    fn new(error: &toml::de::Error) -> Finding {
        Finding {
            span: error.span(),
            message: error.message().to_string(),
        }
    }
}

/// What a text says, or all that is wrong with it, at least one finding, in the order of the text.
pub fn read<T: DeserializeOwned>(text: &str) -> Result<T, Vec<Finding>> {
    let mut document = DeTable::parse(text).map_err(|error| vec![Finding::new(&error)])?;
    let mut found: Vec<Finding> = Vec::new();
    let mut mended = 0;
    loop {
        // Values beyond the text were put there below.
        let new = text.len() + 2 * mended + 2..text.len() + 2 * mended + 3;
        mended += 1;
        let error = match T::deserialize(Deserializer::from(document.clone())) {
            Ok(value) if found.is_empty() => return Ok(value),
            Ok(_) => break,
            Err(error) => Finding::new(&error),
        };
        let is_mended = error.span.as_ref().is_some_and(|span| span.start > text.len());
        let can_go_on = mended < MOST && mend(&mut document, &error, new);
        if !is_mended {
            found.push(error);
        }
        if !can_go_on {
            break;
        }
    }
    found.sort_by_key(|finding| finding.span.as_ref().map_or(0, |span| span.start));
    Err(found)
}

/// Mends the place of an error, so that the next reading gets further; whether it could.
fn mend(document: &mut Spanned<DeTable<'_>>, error: &Finding, new: Range<usize>) -> bool {
    let message = error.message.as_str();
    let name = || message.split('`').nth(1).unwrap_or_default().to_string();
    let span = error.span.clone().unwrap_or_default();
    if message.starts_with("missing field") {
        let value = Spanned::new(new.clone(), DeValue::String("?".into()));
        return insert(document.get_mut(), &span, (name(), new), value);
    }
    if message.starts_with("unknown field") {
        let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        let Some((name, valid)) = names.split_first() else {
            return false;
        };
        return rename(document.get_mut(), &span, (name, valid));
    }
    let Some(value) = example(message) else {
        return false;
    };
    replace(document.get_mut(), &span, &Spanned::new(new, value))
}

/// A value as the message says that it was expected.
fn example(message: &str) -> Option<DeValue<'static>> {
    let owned = |text: &str| Some(DeValue::String(text.to_string().into()));
    let literal = |text: &'static str| DeValue::parse(text).ok().map(Spanned::into_inner);
    let (_, expected) = message.split_once("expected")?;
    let quoted = |text: &str| text.split('"').nth(1).map(str::to_string);
    if message.starts_with("unknown variant") {
        return owned(expected.split('`').nth(1)?);
    }
    if let Some((_, such)) = expected.rsplit_once("such as ") {
        return owned(&quoted(such)?);
    }
    match expected.trim() {
        "i64" => literal("3"),
        "f64" => literal("1.0"),
        "a boolean" => literal("true"),
        "a string" => owned("?"),
        text if text.contains("table") && !text.starts_with('"') => Some(DeValue::Table(DeTable::new())),
        text => owned(&quoted(text)?),
    }
}

/// The place and the name of a key.
type KeyPlace = (String, Range<usize>);

/// Puts a value into the table at `span` that lacks the key; the whole document is such a table too.
fn insert(
    table: &mut DeTable<'_>,
    span: &Range<usize>,
    key: KeyPlace,
    value: Spanned<DeValue<'static>>,
) -> bool {
    let name = key.0.clone();
    let lacks = |table: &DeTable<'_>| !table.iter().any(|(key, _)| *key.get_ref() == name);
    let added = |table: &mut DeTable<'_>| {
        table.insert(Spanned::new(key.1.clone(), key.0.clone().into()), value.clone());
    };
    let at_place = visit(table, &mut |place, value| match value {
        DeValue::Table(table) if place == *span && lacks(table) => {
            added(table);
            true
        }
        _ => false,
    });
    if !at_place && lacks(table) {
        added(table);
        return true;
    }
    at_place
}

/// Gives the key that stands at `span` the one name that was meant, or takes it out. A table gets another name only
/// for a slip of the keyboard: a table of another purpose has other keys.
fn rename(table: &mut DeTable<'_>, span: &Range<usize>, (name, valid): (&str, &[&str])) -> bool {
    let in_table = |table: &mut DeTable<'_>| {
        let Some(key) = table.keys().find(|key| key.span() == *span).cloned() else {
            return false;
        };
        let Some(value) = table.remove(&key) else {
            return false;
        };
        let meant = match (value.get_ref(), hints::meant(name, valid).as_slice()) {
            (DeValue::Table(_), _) => hints::near(name, valid),
            (_, [one]) => Some(*one),
            _ => None,
        };
        if let Some(name) = meant.filter(|name| !table.iter().any(|(key, _)| key.get_ref() == name)) {
            table.insert(Spanned::new(key.span(), name.to_string().into()), value);
        }
        true
    };
    in_table(table)
        || visit(table, &mut |_, value| match value {
            DeValue::Table(table) => in_table(table),
            _ => false,
        })
}

/// Replaces the value at `span`.
fn replace(table: &mut DeTable<'_>, span: &Range<usize>, new: &Spanned<DeValue<'static>>) -> bool {
    for (_, value) in table.iter_mut() {
        if replace_in(value, span, new) {
            return true;
        }
    }
    false
}

fn replace_in<'i>(
    value: &mut Spanned<DeValue<'i>>,
    span: &Range<usize>,
    new: &Spanned<DeValue<'static>>,
) -> bool {
    let inside = match value.get_mut() {
        DeValue::Table(table) => replace(table, span, new),
        DeValue::Array(items) => items.iter_mut().any(|item| replace_in(item, span, new)),
        _ => false,
    };
    if !inside && value.span() == *span {
        *value = new.clone();
        return true;
    }
    inside
}

/// Shows every value of a table with its place, until one is taken.
fn visit<'i>(table: &mut DeTable<'i>, take: &mut dyn FnMut(Range<usize>, &mut DeValue<'i>) -> bool) -> bool {
    table.iter_mut().any(|(_, value)| visit_value(value, take))
}

fn visit_value<'i>(
    value: &mut Spanned<DeValue<'i>>,
    take: &mut dyn FnMut(Range<usize>, &mut DeValue<'i>) -> bool,
) -> bool {
    let span = value.span();
    if take(span, value.get_mut()) {
        return true;
    }
    match value.get_mut() {
        DeValue::Table(table) => visit(table, take),
        DeValue::Array(items) => items.iter_mut().any(|item| visit_value(item, take)),
        _ => false,
    }
}
