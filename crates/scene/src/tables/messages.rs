//! Errors of a scene with the file and line where each was typed.

use std::ops::Range;
use std::path::Path;

use serde::de::DeserializeOwned;
use toml_edit::DocumentMut;

use super::error::SceneError;
use super::gather::{self, Finding};
use super::include::{TypedPlace, WholeText};
use super::locate;

/// What messages need to know of the text of a scene.
pub struct Messages<'a> {
    /// The scene file.
    pub path: &'a Path,
    /// The text before overrides.
    pub whole: &'a WholeText,
    /// The `--set` arguments.
    pub overrides: &'a [String],
}

impl Messages<'_> {
    /// A text as tables.
    pub fn document(&self, text: &str) -> Result<DocumentMut, SceneError> {
        text.parse()
            .map_err(|e: toml_edit::TomlError| self.format_error(text, e.span(), e.message()))
    }

    /// Whether the command line gives the value that a problem is about.
    fn is_overridden(&self, problem: &str) -> bool {
        let keys = self
            .overrides
            .iter()
            .filter_map(|argument| argument.split_once('='));
        keys.into_iter().any(|(key, _)| problem.starts_with(key.trim()))
    }

    /// The `--set` argument that gives what stands in a stretch of the text; of several the last, which wins.
    fn giver(&self, text: &str, at: &Range<usize>) -> Option<&String> {
        let line = text.get(..at.start)?.matches('\n').count();
        let is_typed = || {
            let line = text.lines().nth(line);
            self.whole.text.lines().any(|typed| Some(typed) == line)
        };
        let gives = |argument: &&String| {
            let key = argument.split_once('=').map_or("", |(key, _)| key.trim());
            // Tables on the way to a key that are not in the files have come with it.
            let mut tables = key.match_indices('.').map(|(end, _)| &key[..end]);
            locate::is_at(text, key, at) || tables.any(|table| locate::is_at(text, table, at)) && !is_typed()
        };
        self.overrides.iter().rev().find(gives)
    }

    /// What a text says as tables of a scene.
    pub fn read<T: DeserializeOwned>(&self, text: &str) -> Result<T, SceneError> {
        self.read_beside(text, |_| None)
    }

    /// The same; where there are errors, `beside` may add what no single table shows.
    pub fn read_beside<T: DeserializeOwned>(
        &self,
        text: &str,
        beside: impl Fn(&[Finding]) -> Option<String>,
    ) -> Result<T, SceneError> {
        gather::read(text).map_err(|found| self.format_errors(text, &found, beside(&found)))
    }

    /// One error with its place, or a list of several.
    fn format_errors(&self, text: &str, found: &[Finding], beside: Option<String>) -> SceneError {
        if let ([one], None) = (found, &beside) {
            return self.format_error(text, one.span.clone(), &one.message);
        }
        let problem = |finding: &Finding| {
            let located = locate::locate(text, finding.span.clone(), &finding.message);
            let argument = finding.span.as_ref().and_then(|span| self.giver(text, span));
            match argument {
                _ if located.is_of_whole_file => located.message,
                Some(argument) => format!("{} (--set {argument:?})", located.message),
                None => with_place(&located.message, &self.whole.place_in(text, located.line)),
            }
        };
        SceneError::Invalid {
            path: self.path.to_path_buf(),
            overrides: self.overrides.to_vec(),
            problems: found.iter().map(problem).chain(beside).collect(),
        }
    }

    fn format_error(&self, text: &str, span: Option<Range<usize>>, message: &str) -> SceneError {
        let argument = span.clone().and_then(|span| self.giver(text, &span));
        let located = locate::locate(text, span, message);
        if let Some(argument) = argument {
            return SceneError::Override {
                argument: argument.clone(),
                reason: located.message,
            };
        }
        let place = self.whole.place_in(text, located.line);
        SceneError::Format {
            path: place.path.to_path_buf(),
            overrides: self.overrides.to_vec(),
            line: place.line,
            column: located.column,
            excerpt: located.excerpt(place.line),
            message: located.message,
        }
    }

    /// Problems of values, each with its line in the file where it has one.
    pub fn invalid(&self, problems: Vec<String>) -> SceneError {
        let with_line = |problem: String| match locate::line_of(&self.whole.text, &problem) {
            Some(line) if !self.is_overridden(&problem) => with_place(&problem, &self.whole.place(line)),
            _ => problem,
        };
        let problems = problems.into_iter().map(with_line).collect();
        SceneError::Invalid {
            path: self.path.to_path_buf(),
            overrides: self.overrides.to_vec(),
            problems,
        }
    }
}

/// A problem with its line, and its file if that is not the scene.
fn with_place(problem: &str, place: &TypedPlace<'_>) -> String {
    match place.is_included {
        true => format!("{problem} (line {} of {})", place.line, place.path.display()),
        false => format!("{problem} (line {})", place.line),
    }
}
