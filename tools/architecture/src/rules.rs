//! What `rules.toml` states. That file explains each key.

use std::path::Path;

use anyhow::Context;
use serde::Deserialize;

/// All rules.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// The commit at which the numbers were first counted.
    pub start: String,
    /// Crates, lowest first.
    #[serde(rename = "crate", default)]
    pub crates: Vec<CrateRule>,
    /// What code may not name.
    #[serde(rename = "word", default)]
    pub words: Vec<WordRule>,
    /// What is measured.
    #[serde(rename = "number", default)]
    pub numbers: Vec<Number>,
}

/// What one crate may use, and the order of its modules.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrateRule {
    /// Its name.
    pub name: String,
    /// Crates of the program that it may use.
    pub uses: Vec<String>,
    /// Crates of others that it may use; any, if absent.
    pub libraries: Option<Vec<String>>,
    /// Groups of modules, lowest first.
    #[serde(default)]
    pub layers: Vec<Vec<String>>,
}

/// Names that code may not use.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WordRule {
    /// The rule in words.
    pub rule: String,
    /// Regular expression for a line of code.
    pub pattern: String,
    /// The crates that may not name it.
    #[serde(default)]
    pub not: Vec<String>,
    /// The only crates that may name it.
    #[serde(default)]
    pub only: Vec<String>,
}

/// A number, its limit and its aim.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Number {
    /// What it counts.
    pub name: String,
    /// How it is counted.
    pub measure: Measure,
    /// Its value at the commit where the count began.
    pub at_start: usize,
    /// More than this is a failure; no limit, if absent.
    pub most: Option<usize>,
    /// Whether the limit stays when the number is lower.
    #[serde(default)]
    pub fixed: bool,
    /// What is to be reached.
    pub reach: String,
    /// Regular expressions for lines of code.
    #[serde(default)]
    pub patterns: Vec<String>,
    /// Crates to look at; all, if absent.
    pub crates: Option<Vec<String>>,
    /// Modules to look at, such as `dynamics::motion::small`.
    #[serde(default)]
    pub modules: Vec<String>,
}

/// How a number is counted.
#[derive(Deserialize, Clone, Copy, PartialEq, Eq, Debug)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Lines with code in all crates, without benchmarks and examples.
    CodeLines,
    /// Lines with code in `modules`.
    CodeLinesOfModules,
    /// All lines in `modules`.
    LinesOfModules,
    /// How many `modules` there are.
    Modules,
    /// Files in circles of imports.
    FilesInCircles,
    /// Files of the largest circle.
    LargestCircle,
    /// Pairs of files that import against the layers of their crate.
    ImportsAgainstLayers,
    /// Files of a crate with layers that are in none.
    FilesWithoutLayer,
    /// Imports, through re-exports too, of a crate that the crate may not use.
    ImportsOfOtherCrates,
    /// Crates among `crates` that depend on the crate in `patterns`.
    Dependents,
    /// Matches of `patterns`.
    Matches,
    /// Files with a match of all `patterns`.
    FilesWithMatches,
    /// Lines of the longest file, with everything in it.
    LongestFile,
    /// Lines of the longest function.
    LongestFunction,
    /// Median of the lines of a function.
    MedianFunction,
    /// Lines of the README.
    ReadmeLines,
    /// Lines of Markdown over 120 characters, without rows of tables.
    LongMarkdownLines,
    /// Lines of Rust over 120 characters.
    LongRustLines,
    /// Names that several types have.
    SharedTypeNames,
}

impl Rules {
    /// Reads the rules from a file.
    pub fn read(path: &Path) -> anyhow::Result<Rules> {
        let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
        toml::from_str(&text).with_context(|| path.display().to_string())
    }

    /// The rule of a crate.
    pub fn of_crate(&self, name: &str) -> Option<&CrateRule> {
        self.crates.iter().find(|rule| rule.name == name)
    }
}

impl CrateRule {
    /// The layer of a module, from 0: that of its longest prefix that is named. The root is above all.
    pub fn layer(&self, module: &str) -> Option<usize> {
        if module.is_empty() {
            return Some(self.layers.len());
        }
        let mut longest = None;
        for (layer, modules) in self.layers.iter().enumerate() {
            for name in modules {
                let inside = module.strip_prefix(name.as_str());
                let inside = inside.is_some_and(|rest| rest.is_empty() || rest.starts_with("::"));
                if inside && longest.is_none_or(|(length, _)| name.len() > length) {
                    longest = Some((name.len(), layer));
                }
            }
        }
        longest.map(|(_, layer)| layer)
    }
}
