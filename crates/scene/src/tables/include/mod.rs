//! `include = "types/7010c.toml"`: tables of other files, so that a bearing type stands in one file.
//!
//! ```toml
#![doc = include_str!("../example_include.toml")]
//! ```
//!
//! The tables of the file are put into the text of the scene before it is read; what a run records is the text with
//! all of it, which needs no other file. Files may include others; a circle is refused. A value stands in one of the
//! files: one that stands in two is an error that names both places. `--set` changes any of them, and `include` too.
//! Paths in a file start at the folder of that file, so they are written anew in the text of the scene.

mod merge;
mod paths;

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use toml_edit::DocumentMut;

use super::edit;
use super::error::SceneError;
use super::locate;

/// The key.
pub const INCLUDE: &str = "include";

/// A line of a file, from 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LineOrigin {
    /// Number in [`WholeText::files`].
    file: usize,
    line: usize,
}

/// The text of a scene with those of all files that it includes, and where every line of it comes from.
#[derive(Clone, Debug)]
pub struct WholeText {
    /// TOML without `include`.
    pub text: String,
    /// Of every line of the text.
    origins: Vec<LineOrigin>,
    /// The scene, then the files that it includes.
    files: Vec<PathBuf>,
}

/// Where a line of a text was typed.
#[derive(Debug, PartialEq)]
pub struct TypedPlace<'a> {
    /// The file.
    pub path: &'a Path,
    /// Line, from 1.
    pub line: usize,
    /// Whether it is a file that the scene includes.
    pub is_included: bool,
}

impl WholeText {
    /// The text of a scene as it was typed.
    fn typed(text: &str, path: &Path) -> WholeText {
        let origin = |i| LineOrigin { file: 0, line: i + 1 };
        WholeText {
            text: text.to_string(),
            origins: (0..text.lines().count()).map(origin).collect(),
            files: vec![path.to_path_buf()],
        }
    }

    /// The place of a line, from 1, of this text.
    pub fn place(&self, line: usize) -> TypedPlace<'_> {
        let origin = self.origins.get(line.saturating_sub(1)).copied();
        let origin = origin.unwrap_or(LineOrigin { file: 0, line });
        TypedPlace {
            path: &self.files[origin.file],
            line: origin.line,
            is_included: origin.file > 0,
        }
    }

    /// The place of a line of this text after `--set` has changed lines and added some: the last one before that reads
    /// the same. Where tables have been taken out, as of a list of bearings, it is the next one after. A line that the
    /// command line gives is one of the scene.
    pub fn place_in(&self, edited: &str, line: usize) -> TypedPlace<'_> {
        let Some(wanted) = edited.lines().nth(line.saturating_sub(1)) else {
            return self.place(line);
        };
        let same = |(i, typed): (usize, &str)| (typed == wanted).then_some(i + 1);
        let alike = || self.text.lines().enumerate().filter_map(same);
        match alike()
            .take_while(|&i| i <= line)
            .last()
            .or_else(|| alike().next())
        {
            Some(line) => self.place(line),
            None => TypedPlace {
                path: &self.files[0],
                line,
                is_included: false,
            },
        }
    }

    /// Puts the tables of another text in; `statement` is the line of this text that includes it.
    fn add(self, other: &WholeText, typed: &str, statement: usize) -> Result<WholeText, String> {
        let from = self.files.len();
        let moved = |origin: &LineOrigin| LineOrigin {
            file: from + origin.file,
            line: origin.line,
        };
        let heading = self.origins[statement - 1];
        let lines = merge::merge(&self.text, &other.text, statement)?;
        let origin = |line: &merge::TextLine<'_>| match line.from {
            merge::LineSource::Scene(i) => self.origins[i],
            merge::LineSource::Included(i) => moved(&other.origins[i]),
            merge::LineSource::Heading => heading,
        };
        let heading = format!("# from {typed}");
        let text = |line: &merge::TextLine<'_>| match line.from {
            merge::LineSource::Heading => heading.clone() + "\n",
            _ => line.text.to_string() + "\n",
        };
        Ok(WholeText {
            origins: lines.iter().map(origin).collect(),
            text: lines.iter().map(text).collect(),
            files: [self.files.clone(), other.files.clone()].concat(),
        })
    }
}

/// Why the type of a bearing is not read.
pub enum TypeError {
    /// What is wrong with its name or its tables: a sentence.
    Here(String),
    /// What is wrong in the file.
    There(SceneError),
}

impl WholeText {
    /// The tables of which `is_shared` tells by their names, with those of a type file for the bearing of a name; the
    /// lines of all others are blank. The file may have the tables `known` alone.
    pub fn with_type(
        &self,
        (bearing, typed): (&str, &str),
        known: &[&str],
        is_shared: impl Fn(&[String]) -> bool,
    ) -> Result<WholeText, TypeError> {
        let blanked = merge::blanked(&self.text, is_shared).map_err(TypeError::Here)?;
        // A line of its own, behind which the first table may begin.
        let first = LineOrigin { file: 0, line: 1 };
        let base = WholeText {
            text: format!("\n{blanked}"),
            origins: [&[first][..], &self.origins].concat(),
            files: self.files.clone(),
        };
        let scene = &self.files[0];
        let other = included(scene, typed, &[physical(scene)]).map_err(|error| match error {
            NotIncluded::Here(message) => {
                TypeError::Here(format!("bearing.type of {bearing:?} is {typed:?}: {message}"))
            }
            NotIncluded::There(error) => TypeError::There(error),
        })?;
        if let Ok(document) = DeTable::parse(&other.text) {
            let unknown = document
                .get_ref()
                .keys()
                .find(|key| !known.contains(&key.get_ref().as_ref()));
            if let Some(key) = unknown {
                return Err(TypeError::Here(format!(
                    "bearing.type of {bearing:?}: {} has {}; expected the tables of one bearing alone: {}",
                    other.files[0].display(),
                    key.get_ref(),
                    known
                        .iter()
                        .map(|name| format!("[{name}]"))
                        .collect::<Vec<_>>()
                        .join(", ")
                )));
            }
        }
        let clashes = clashes(&base, &other);
        if !clashes.is_empty() {
            return Err(TypeError::There(SceneError::Invalid {
                path: scene.clone(),
                overrides: Vec::new(),
                problems: clashes,
            }));
        }
        base.add(&other, typed, 1).map_err(TypeError::Here)
    }
}

/// The text of a scene with all that it includes; `overrides` may name other files to include.
pub fn whole(text: &str, path: &Path, overrides: &[String]) -> Result<WholeText, SceneError> {
    let of_include: Vec<&String> = overrides.iter().filter(|o| is_of_include(o)).collect();
    let mut typed = WholeText::typed(text, path);
    if let (false, Ok(mut document)) = (of_include.is_empty(), text.parse::<DocumentMut>()) {
        for argument in of_include {
            edit::apply_override(&mut document, argument).map_err(|reason| SceneError::Override {
                argument: argument.clone(),
                reason,
            })?;
        }
        let edited = document.to_string();
        let line = |i: usize| typed.place_in(&edited, i + 1).line;
        let origin = |i| LineOrigin {
            file: 0,
            line: line(i),
        };
        typed.origins = (0..edited.lines().count()).map(origin).collect();
        typed.text = edited;
    }
    with_included(typed, &[physical(path)])
}

/// Whether a `--set` argument says which files are included.
pub fn is_of_include(argument: &str) -> bool {
    argument
        .split_once('=')
        .is_some_and(|(key, _)| key.trim() == INCLUDE)
}

/// A file as the system knows it, to tell circles.
fn physical(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// A text with what it includes; `chain` has the files that are being read, this one last.
fn with_included(mut whole: WholeText, chain: &[PathBuf]) -> Result<WholeText, SceneError> {
    let text = whole.text.clone();
    // A text that is no TOML is refused where it is read.
    let Ok(document) = DeTable::parse(&text) else {
        return Ok(whole);
    };
    let Some((key, value)) = document
        .get_ref()
        .iter()
        .find(|(key, _)| key.get_ref() == INCLUDE)
    else {
        return Ok(whole);
    };
    let files = files(value).map_err(|(span, message)| error_at(&whole, &text, span, &message))?;
    let statement = lines_of(&text, key.span().start..value.span().end);
    whole.text = commented(&text, &statement);
    for (span, typed) in files {
        let fail = |whole: &WholeText, message: String| error_at(whole, &text, span.clone(), &message);
        let other = included(&whole.files[0], &typed, chain).map_err(|error| match error {
            NotIncluded::Here(message) => fail(&whole, message),
            NotIncluded::There(error) => error,
        })?;
        let clashes = clashes(&whole, &other);
        if !clashes.is_empty() {
            return Err(SceneError::Invalid {
                path: whole.files[0].clone(),
                overrides: Vec::new(),
                problems: clashes,
            });
        }
        let kept = whole.clone();
        whole = whole
            .add(&other, &typed, statement.end)
            .map_err(|message| fail(&kept, message))?;
    }
    Ok(whole)
}

/// Why a file is not included.
enum NotIncluded {
    /// What is wrong with the statement.
    Here(String),
    /// What is wrong in the file.
    There(SceneError),
}

/// The text of an included file, with what it includes itself; its paths start at the folder of `scene`.
fn included(scene: &Path, typed: &str, chain: &[PathBuf]) -> Result<WholeText, NotIncluded> {
    let path = scene.parent().unwrap_or(Path::new("")).join(typed);
    let here = |message: String| Err(NotIncluded::Here(message));
    let known = physical(&path);
    if let Some(first) = chain.iter().position(|file| *file == known) {
        let name = |file: &PathBuf| file.file_name().map(|n| n.to_string_lossy().into_owned());
        let names: Vec<String> = chain[first..].iter().chain([&known]).filter_map(name).collect();
        return here(format!(
            "files include each other in a circle: {}",
            names.join(" > ")
        ));
    }
    if path.exists() && !path.is_file() {
        return here(format!(
            "{} is no plain file; expected a file of TOML",
            path.display()
        ));
    }
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => {
            return here(format!(
                "{} cannot be read: {error}; the path is relative to the file that includes it",
                path.display()
            ));
        }
    };
    let found = WholeText::typed(&text, &path);
    if let Err(error) = DeTable::parse(&text) {
        let error = error_at(&found, &text, error.span().unwrap_or_default(), error.message());
        return Err(NotIncluded::There(error));
    }
    let mut whole = with_included(found, &[chain, &[known]].concat()).map_err(NotIncluded::There)?;
    if let Some(folder) = Path::new(typed).parent().filter(|f| !f.as_os_str().is_empty()) {
        whole.text = paths::started_at(&whole.text, folder);
    }
    Ok(whole)
}

/// A stretch of the text, and a path in it, or what is wrong there.
type InFile = (Range<usize>, String);

/// The files of the statement with their places.
fn files(value: &Spanned<DeValue<'_>>) -> Result<Vec<InFile>, InFile> {
    let expected = "expected the path of a file such as \"types/7010c.toml\", or a list of such paths";
    let one = |value: &Spanned<DeValue<'_>>| match value.get_ref() {
        DeValue::String(typed) if !typed.is_empty() => Ok((value.span(), typed.to_string())),
        _ => Err((value.span(), format!("this includes no file; {expected}"))),
    };
    match value.get_ref() {
        DeValue::Array(items) => items.iter().map(one).collect(),
        _ => one(value).map(|file| vec![file]),
    }
}

/// The lines, from 1, of a stretch of a text.
fn lines_of(text: &str, span: Range<usize>) -> Range<usize> {
    let line = |at: usize| 1 + text[..at].matches('\n').count();
    line(span.start)..line(span.end)
}

/// A text whose lines from `lines.start` to `lines.end` are comments.
fn commented(text: &str, lines: &Range<usize>) -> String {
    let comment = |(i, line): (usize, &str)| match (lines.start..=lines.end).contains(&(i + 1)) {
        true => format!("# {line}\n"),
        false => format!("{line}\n"),
    };
    text.lines().enumerate().map(comment).collect()
}

/// An error of the format at its place.
fn error_at(whole: &WholeText, text: &str, span: Range<usize>, message: &str) -> SceneError {
    let located = locate::locate(text, Some(span), message);
    let place = whole.place(located.line);
    SceneError::Format {
        path: place.path.to_path_buf(),
        overrides: Vec::new(),
        line: place.line,
        column: located.column,
        excerpt: located.excerpt(place.line),
        message: located.message,
    }
}

/// Values that stand in both texts: a sentence each.
fn clashes(scene: &WholeText, other: &WholeText) -> Vec<String> {
    let sentence = |clash: &merge::Clash| {
        let place = |whole: &WholeText, at: usize| {
            let line = lines_of(&whole.text, at..at).start;
            let place = whole.place(line);
            format!("{}, line {}", place.path.display(), place.line)
        };
        format!(
            "{} stands in {}, and in {}; leave it in one of them, --set changes it for a run",
            clash.key,
            place(scene, clash.at),
            place(other, clash.other_at)
        )
    };
    merge::clashes(&scene.text, &other.text)
        .iter()
        .map(sentence)
        .collect()
}
