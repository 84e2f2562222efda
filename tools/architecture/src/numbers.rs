//! The numbers of `rules.toml`, measured.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::bail;
use regex_lite::Regex;

use crate::circles::circles;
use crate::imports::{File, Import, Imports};
use crate::place::Place;
use crate::rules::{Measure, Number, Rules};
use crate::source::{Named, Source};
use crate::workspace::{Workspace, files_below};

/// Longest line of text, in characters.
const LONGEST_LINE: usize = 120;

/// A value and where it comes from.
pub struct Measured {
    /// The value.
    pub value: usize,
    /// Where it was found.
    pub places: Vec<Place>,
    /// Of a value that is the largest of many, the value of each place, the largest first.
    pub sizes: Option<Vec<usize>>,
}

/// What is measured.
pub struct Program<'a> {
    /// Crates and sources.
    pub workspace: &'a Workspace,
    /// Imports.
    pub imports: &'a Imports,
    /// Circles of imports, the largest first.
    pub circles: Vec<Vec<usize>>,
}

impl Measured {
    fn new(value: usize, places: Vec<Place>) -> Measured {
        Measured {
            value,
            places,
            sizes: None,
        }
    }

    fn count(places: Vec<Place>) -> Measured {
        Measured::new(places.len(), places)
    }

    fn sum(sized: Vec<(usize, Place)>) -> Measured {
        let (sizes, places): (Vec<usize>, _) = sized.into_iter().unzip();
        Measured::new(sizes.iter().sum(), places)
    }

    fn largest(mut sized: Vec<(usize, Place)>) -> Measured {
        sized.sort_by_key(|(size, _)| usize::MAX - size);
        let (sizes, places): (Vec<usize>, _) = sized.into_iter().unzip();
        Measured {
            value: sizes.first().copied().unwrap_or(0),
            places,
            sizes: Some(sizes),
        }
    }

    /// The places to look at when a value is over its limit: those that are over it themselves, else all, those in
    /// files that changed last first.
    pub fn over(&self, most: usize, root: &Path) -> Vec<&Place> {
        if let Some(sizes) = &self.sizes {
            let over = self.places.iter().zip(sizes).filter(|(_, size)| **size > most);
            return over.map(|(place, _)| place).collect();
        }
        let changed = |place: &Place| {
            let data = std::fs::metadata(root.join(&place.path));
            data.and_then(|data| data.modified()).ok()
        };
        let mut places: Vec<&Place> = self.places.iter().collect();
        places.sort_by_cached_key(|place| Reverse(changed(place)));
        places
    }
}

impl<'a> Program<'a> {
    /// Finds the circles of a program.
    pub fn new(workspace: &'a Workspace, imports: &'a Imports) -> Program<'a> {
        Program {
            workspace,
            imports,
            circles: circles(imports.files.len(), &imports.imports),
        }
    }

    /// Sources of the crates proper: what the module trees reach, each once.
    pub fn proper(&self) -> Vec<&'a Source> {
        let paths: BTreeSet<&Path> = self
            .imports
            .files
            .iter()
            .map(|file| file.path.as_path())
            .collect();
        paths
            .into_iter()
            .map(|path| &self.workspace.sources[path])
            .collect()
    }

    /// Measures a number.
    pub fn measure(&self, number: &Number, rules: &Rules) -> anyhow::Result<Measured> {
        let root = &self.workspace.root;
        Ok(match number.measure {
            Measure::CodeLines => Measured::sum(self.code_lines(number)),
            Measure::CodeLinesOfModules => Measured::sum(self.modules(number, Source::n_code_lines)?),
            Measure::LinesOfModules => Measured::sum(self.modules(number, Source::n_lines)?),
            Measure::Modules => {
                let modules = self.modules(number, Source::n_lines)?.into_iter();
                Measured::count(modules.map(|(_, place)| place).collect())
            }
            Measure::FilesInCircles => {
                let files = self.circles.iter().map(Vec::len).sum();
                Measured::new(files, self.circle_imports(usize::MAX))
            }
            Measure::LargestCircle => {
                let files = self.circles.first().map_or(0, Vec::len);
                Measured::new(files, self.circle_imports(1))
            }
            Measure::ImportsAgainstLayers => Measured::count(self.against_layers(rules)),
            Measure::FilesWithoutLayer => Measured::count(self.without_layer(rules)),
            Measure::ImportsOfOtherCrates => Measured::count(self.of_other_crates(rules)),
            Measure::Dependents => Measured::count(self.dependents(number)),
            Measure::Matches => Measured::count(self.matches(number)?),
            Measure::FilesWithMatches => Measured::count(self.files_with_matches(number)?),
            Measure::LongestFile => Measured::largest(file_lengths(root)?),
            Measure::LongestFunction => Measured::largest(self.functions()),
            Measure::MedianFunction => median(self.functions()),
            Measure::ReadmeLines => readme(root)?,
            Measure::LongMarkdownLines => Measured::count(long_lines(root, "md")?),
            Measure::LongRustLines => Measured::count(long_lines(root, "rs")?),
            Measure::SharedTypeNames => Measured::count(self.shared_type_names()),
        })
    }

    fn code_lines(&self, number: &Number) -> Vec<(usize, Place)> {
        let mut found = Vec::new();
        for source in self.proper_of(number) {
            let lines = source.n_code_lines();
            found.push((
                lines,
                Place::of_file(&source.path, format!("{lines} lines of code")),
            ));
        }
        found
    }

    /// Sources of the crates that a number looks at.
    fn proper_of(&self, number: &Number) -> Vec<&'a Source> {
        let within = |source: &&Source| match &number.crates {
            None => true,
            Some(names) => names.iter().any(|name| {
                let krate = self.workspace.find(name);
                krate.is_some_and(|krate| source.path.starts_with(&krate.folder))
            }),
        };
        self.proper().into_iter().filter(within).collect()
    }

    /// Lines of named modules, each with the modules below it.
    fn modules(&self, number: &Number, size: fn(&Source) -> usize) -> anyhow::Result<Vec<(usize, Place)>> {
        let mut found = Vec::new();
        for name in &number.modules {
            let mut lines = 0;
            let mut first: Option<&File> = None;
            for file in &self.imports.files {
                let whole = format!("{}::{}", file.krate, file.module);
                let rest = whole.strip_prefix(name.as_str());
                if rest.is_some_and(|rest| rest.is_empty() || rest.starts_with("::")) {
                    lines += size(&self.workspace.sources[&file.path]);
                    first = first.or(Some(file));
                }
            }
            let Some(file) = first else {
                bail!(
                    "{:?} counts module {name}, but there is none; say in rules.toml where it went, or that it is gone",
                    number.name
                );
            };
            let text = format!("{name}, {lines} lines");
            found.push((lines, Place::of_file(&file.path, text)));
        }
        Ok(found)
    }

    fn place(&self, import: &Import, text: &str) -> Place {
        let to = self.imports.files[import.to].path.display();
        Place::of_line(
            &self.imports.files[import.from].path,
            import.line,
            format!("imports {to}{text}"),
        )
    }

    /// Imports inside the `n` largest circles.
    fn circle_imports(&self, n: usize) -> Vec<Place> {
        let mut found = Vec::new();
        for circle in self.circles.iter().take(n) {
            let inside = |file: &usize| circle.binary_search(file).is_ok();
            let text = format!(", in a circle of {} files", circle.len());
            let imports = self.imports.imports.iter();
            let imports = imports.filter(|import| inside(&import.from) && inside(&import.to));
            found.extend(imports.map(|import| self.place(import, &text)));
        }
        found
    }

    fn against_layers(&self, rules: &Rules) -> Vec<Place> {
        let mut found = Vec::new();
        for import in &self.imports.imports {
            let (from, to) = (&self.imports.files[import.from], &self.imports.files[import.to]);
            let Some(rule) = rules.of_crate(&from.krate) else {
                continue;
            };
            if from.krate != to.krate || rule.layers.is_empty() {
                continue;
            }
            if let (Some(lower), Some(upper)) = (rule.layer(&from.module), rule.layer(&to.module))
                && lower < upper
            {
                let text = format!(", layer {} imports from layer {}", lower + 1, upper + 1);
                found.push(self.place(import, &text));
            }
        }
        found
    }

    fn without_layer(&self, rules: &Rules) -> Vec<Place> {
        let mut found = Vec::new();
        for file in &self.imports.files {
            if let Some(rule) = rules.of_crate(&file.krate)
                && !rule.layers.is_empty()
                && rule.layer(&file.module).is_none()
            {
                let text = format!("module {} is in no layer of {}", file.module, file.krate);
                found.push(Place::of_file(&file.path, text));
            }
        }
        found
    }

    fn of_other_crates(&self, rules: &Rules) -> Vec<Place> {
        let mut found = Vec::new();
        for import in &self.imports.imports {
            let (from, to) = (&self.imports.files[import.from], &self.imports.files[import.to]);
            if from.krate != to.krate
                && let Some(rule) = rules.of_crate(&from.krate)
                && !rule.uses.contains(&to.krate)
            {
                let text = format!(", but {} may not use {}", from.krate, to.krate);
                found.push(self.place(import, &text));
            }
        }
        found
    }

    fn dependents(&self, number: &Number) -> Vec<Place> {
        let mut found = Vec::new();
        for krate in &self.workspace.crates {
            let counts = number
                .crates
                .as_ref()
                .is_none_or(|names| names.contains(&krate.name));
            for name in krate
                .dependencies
                .iter()
                .filter(|name| number.patterns.contains(name))
            {
                if counts {
                    found.push(Place::of_file(&krate.manifest, format!("depends on {name}")));
                }
            }
        }
        found
    }

    fn matches(&self, number: &Number) -> anyhow::Result<Vec<Place>> {
        let mut found = Vec::new();
        let patterns = patterns(number)?;
        for source in self.proper_of(number) {
            for (line, code) in source.code.iter().enumerate() {
                for pattern in &patterns {
                    for _ in pattern.find_iter(code) {
                        found.push(Place::of_line(&source.path, line + 1, code.trim().to_owned()));
                    }
                }
            }
        }
        Ok(found)
    }

    fn files_with_matches(&self, number: &Number) -> anyhow::Result<Vec<Place>> {
        let mut found = Vec::new();
        let patterns = patterns(number)?;
        for source in self.proper_of(number) {
            let first = |pattern: &Regex| source.code.iter().position(|code| pattern.is_match(code));
            let lines: Option<Vec<usize>> = patterns.iter().map(first).collect();
            if let Some(&line) = lines.as_ref().and_then(|lines| lines.first()) {
                let text = source.code[line].trim().to_owned();
                found.push(Place::of_line(&source.path, line + 1, text));
            }
        }
        Ok(found)
    }

    fn functions(&self) -> Vec<(usize, Place)> {
        let mut found = Vec::new();
        for source in self.proper() {
            for Named { name, lines } in &source.functions {
                let size = lines.end() - lines.start() + 1;
                let text = format!("{name} has {size} lines");
                found.push((size, Place::of_line(&source.path, *lines.start(), text)));
            }
        }
        found
    }

    fn shared_type_names(&self) -> Vec<Place> {
        let mut types: BTreeMap<&str, Vec<Place>> = BTreeMap::new();
        for source in self.proper() {
            for Named { name, lines } in &source.types {
                let place = Place::of_line(&source.path, *lines.start(), name.clone());
                types.entry(name).or_default().push(place);
            }
        }
        let shared = types.into_iter().filter(|(_, places)| places.len() > 1);
        shared
            .map(|(name, places)| {
                let others: Vec<String> = places[1..]
                    .iter()
                    .map(|place| format!("{}:{}", place.path.display(), place.line.unwrap_or(1)))
                    .collect();
                Place {
                    text: format!("{name}, also {}", others.join(", ")),
                    ..places[0].clone()
                }
            })
            .collect()
    }

    /// Lines of code of each crate, in the order of the workspace.
    pub fn lines_by_crate(&self) -> Vec<(&'a str, usize)> {
        let proper = self.proper();
        let lines = |folder: &Path| {
            let inside = proper.iter().filter(|source| source.path.starts_with(folder));
            inside.map(|source| source.n_code_lines()).sum()
        };
        let crates = self.workspace.crates.iter();
        crates
            .map(|krate| (krate.name.as_str(), lines(&krate.folder)))
            .collect()
    }
}

fn patterns(number: &Number) -> anyhow::Result<Vec<Regex>> {
    Ok(number
        .patterns
        .iter()
        .map(|text| Regex::new(text))
        .collect::<Result<_, _>>()?)
}

/// Lines of each Rust file, Python file and script, tests and tools as well.
fn file_lengths(root: &Path) -> anyhow::Result<Vec<(usize, Place)>> {
    let mut found = Vec::new();
    for folder in ["crates", "tests", "scripts", "tools"] {
        for path in files_below(root, Path::new(folder))? {
            let code = path.extension().is_some_and(|end| end == "rs" || end == "py");
            if code || folder == "scripts" {
                let bytes = std::fs::read(root.join(&path))?;
                let lines = bytes.iter().filter(|&&byte| byte == b'\n').count();
                found.push((lines, Place::of_file(&path, format!("{lines} lines"))));
            }
        }
    }
    Ok(found)
}

fn median(functions: Vec<(usize, Place)>) -> Measured {
    let mut sizes: Vec<usize> = functions.into_iter().map(|(size, _)| size).collect();
    sizes.sort();
    Measured::new(sizes.get(sizes.len() / 2).copied().unwrap_or(0), Vec::new())
}

fn readme(root: &Path) -> anyhow::Result<Measured> {
    let path = Path::new("README.md");
    let lines = match root.join(path).is_file() {
        true => std::fs::read_to_string(root.join(path))?.lines().count(),
        false => 0,
    };
    let places = vec![Place::of_file(path, format!("{lines} lines"))];
    Ok(Measured::new(lines, places))
}

/// Lines over the limit in all files with this ending. Rows of Markdown tables cannot be broken and do not count.
fn long_lines(root: &Path, ending: &str) -> anyhow::Result<Vec<Place>> {
    let mut found = Vec::new();
    for path in files_below(root, Path::new(""))? {
        if path.extension().is_none_or(|end| end != ending) {
            continue;
        }
        let text = std::fs::read_to_string(root.join(&path))?;
        for (line, text) in text.lines().enumerate() {
            let length = text.chars().count();
            let row = ending == "md" && text.trim_start().starts_with('|');
            if length > LONGEST_LINE && !row {
                found.push(Place::of_line(&path, line + 1, format!("{length} characters")));
            }
        }
    }
    Ok(found)
}
