//! Which file imports from which, with names resolved to the file that defines them.
//!
//! A path is followed through imports and re-exports, stars too, and through other crates of the workspace. So
//! `crate::Thing` that `lib.rs` re-exports from `motion/state.rs` is an import of that file, and not of `lib.rs`. A
//! file that re-exports what the modules below it define does not import them. Modules alone are no import: what
//! counts is what is named in them. Calls of methods name nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use anyhow::Context;

use crate::source::{Body, Contents, PathAt};
use crate::workspace::{Crate, Workspace};

/// A file of a crate imports from another file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Import {
    /// Index of the file that imports.
    pub from: usize,
    /// Index of the file that defines what is imported.
    pub to: usize,
    /// Line of the first such import.
    pub line: usize,
}

/// A file in the module trees.
pub struct File {
    /// Path from the root.
    pub path: PathBuf,
    /// Name of its crate.
    pub krate: String,
    /// Its module in the crate, such as `motion::state`; empty for the root.
    pub module: String,
}

/// All files of the program with their imports.
pub struct Imports {
    /// Files that the module trees of the crates reach, without tests, benchmarks and examples.
    pub files: Vec<File>,
    /// One import for each pair of files, in the order of the files.
    pub imports: Vec<Import>,
}

struct Module<'a> {
    file: usize,
    parent: Option<usize>,
    contents: &'a Contents,
    children: BTreeMap<&'a str, usize>,
    root: usize,
}

/// What a path may name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Module(usize),
    /// An item of this module.
    Item(usize),
}

struct Tree<'a> {
    workspace: &'a Workspace,
    files: Vec<File>,
    modules: Vec<Module<'a>>,
    /// Root module of the library of each crate.
    libraries: BTreeMap<&'a str, usize>,
}

/// Reads the module trees of all crates and resolves all paths.
pub fn resolve(workspace: &Workspace) -> anyhow::Result<Imports> {
    let mut tree = Tree {
        workspace,
        files: Vec::new(),
        modules: Vec::new(),
        libraries: BTreeMap::new(),
    };
    for krate in &workspace.crates {
        for path in &krate.roots {
            let root = tree.add_root(krate, path)?;
            tree.libraries.entry(&krate.name).or_insert(root);
        }
    }
    let mut first: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for module in 0..tree.modules.len() {
        for (to, line) in tree.references(module) {
            let from = tree.modules[module].file;
            if from != to {
                let known = first.entry((from, to)).or_insert(line);
                *known = line.min(*known);
            }
        }
    }
    let imports = first
        .into_iter()
        .map(|((from, to), line)| Import { from, to, line });
    Ok(Imports {
        imports: imports.collect(),
        files: tree.files,
    })
}

impl<'a> Tree<'a> {
    fn add_root(&mut self, krate: &'a Crate, path: &Path) -> anyhow::Result<usize> {
        let below = path.parent().unwrap_or(Path::new(""));
        self.add_file(krate, path, below, None, String::new())
    }

    /// Adds a file and the modules below it; those without a path of their own lie in the folder `below`.
    fn add_file(
        &mut self,
        krate: &'a Crate,
        path: &Path,
        below: &Path,
        parent: Option<usize>,
        name: String,
    ) -> anyhow::Result<usize> {
        let workspace = self.workspace;
        let source = workspace.sources.get(path).with_context(|| {
            format!(
                "module {name} of crate {} has no file {}",
                krate.name,
                path.display()
            )
        })?;
        self.files.push(File {
            path: path.to_path_buf(),
            krate: krate.name.clone(),
            module: name.clone(),
        });
        self.add_module(krate, self.files.len() - 1, &source.contents, below, parent, name)
    }

    fn add_module(
        &mut self,
        krate: &'a Crate,
        file: usize,
        contents: &'a Contents,
        below: &Path,
        parent: Option<usize>,
        name: String,
    ) -> anyhow::Result<usize> {
        let index = self.modules.len();
        self.modules.push(Module {
            file,
            parent,
            contents,
            children: BTreeMap::new(),
            root: parent.map_or(index, |parent| self.modules[parent].root),
        });
        for child in &contents.modules {
            let child_name = match name.as_str() {
                "" => child.name.clone(),
                name => format!("{name}::{}", child.name),
            };
            let folder = below.join(&child.name);
            let added = match &child.body {
                Body::Inline(contents) => {
                    self.add_module(krate, file, contents, &folder, Some(index), child_name)?
                }
                Body::File(given) => {
                    let beside = self.files[file].path.parent().unwrap_or(Path::new(""));
                    let usual = [below.join(format!("{}.rs", child.name)), folder.join("mod.rs")];
                    let path = match given {
                        Some(given) => beside.join(given),
                        None if self.workspace.sources.contains_key(&usual[0]) => usual[0].clone(),
                        None => usual[1].clone(),
                    };
                    self.add_file(krate, &path, &folder, Some(index), child_name)?
                }
            };
            self.modules[index].children.insert(&child.name, added);
        }
        Ok(index)
    }

    /// Files that a module names, with lines.
    fn references(&self, module: usize) -> Vec<(usize, usize)> {
        let contents = self.modules[module].contents;
        let mut found = Vec::new();
        for import in contents.imports.iter().filter(|import| import.name.is_some()) {
            for target in self.targets(module, &import.path) {
                let passed_on = import.public && self.is_below(target, module);
                if !passed_on {
                    found.push((self.modules[target].file, import.path.line));
                }
            }
        }
        for path in &contents.paths {
            for target in self.targets(module, path) {
                found.push((self.modules[target].file, path.line));
            }
        }
        found
    }

    /// Modules whose items a path names.
    fn targets(&self, module: usize, path: &PathAt) -> Vec<usize> {
        let targets = self.follow(module, &path.segments, &mut BTreeSet::new());
        let items = targets.into_iter().filter_map(|target| match target {
            Target::Item(module) => Some(module),
            Target::Module(_) => None,
        });
        items.collect()
    }

    fn is_below(&self, mut module: usize, above: usize) -> bool {
        while let Some(parent) = self.modules[module].parent {
            if parent == above {
                return true;
            }
            module = parent;
        }
        false
    }

    fn follow(
        &self,
        module: usize,
        segments: &'a [String],
        seen: &mut BTreeSet<(usize, &'a str)>,
    ) -> Vec<Target> {
        let Some((first, mut rest)) = segments.split_first() else {
            return Vec::new();
        };
        let library = |name: &str| self.libraries.get(name).map(|&root| Target::Module(root));
        let mut at = match first.as_str() {
            "crate" => vec![Target::Module(self.modules[module].root)],
            "self" => vec![Target::Module(module)],
            "super" => self.modules[module]
                .parent
                .map(Target::Module)
                .into_iter()
                .collect(),
            "" => {
                let Some((name, after)) = rest.split_first() else {
                    return Vec::new();
                };
                rest = after;
                library(name).into_iter().collect()
            }
            name => match self.look_up(module, name, seen) {
                Some(targets) => targets,
                None => library(name).into_iter().collect(),
            },
        };
        for segment in rest {
            let mut next = Vec::new();
            for target in at {
                match target {
                    // What follows an item is a variant or an associated item.
                    Target::Item(_) => next.push(target),
                    Target::Module(module) if segment == "super" => {
                        next.extend(self.modules[module].parent.map(Target::Module));
                    }
                    Target::Module(module) => {
                        next.extend(self.look_up(module, segment, seen).into_iter().flatten());
                    }
                }
            }
            at = next;
        }
        at.sort();
        at.dedup();
        at
    }

    /// What a name means in a module; none if the module does not know it.
    fn look_up(
        &self,
        module: usize,
        name: &'a str,
        seen: &mut BTreeSet<(usize, &'a str)>,
    ) -> Option<Vec<Target>> {
        if !seen.insert((module, name)) {
            return None;
        }
        let Module {
            contents, children, ..
        } = &self.modules[module];
        let mut targets: Vec<Target> = children
            .get(name)
            .map(|&child| Target::Module(child))
            .into_iter()
            .collect();
        if contents.items.iter().any(|item| item == name) {
            targets.push(Target::Item(module));
        }
        let mut known = !targets.is_empty();
        for import in contents
            .imports
            .iter()
            .filter(|import| import.name.as_deref() == Some(name))
        {
            known = true;
            targets.extend(self.follow(module, &import.path.segments, seen));
        }
        if !known {
            for star in contents.imports.iter().filter(|import| import.name.is_none()) {
                for target in self.follow(module, &star.path.segments, seen) {
                    if let Target::Module(other) = target
                        && let Some(more) = self.look_up(other, name, seen)
                    {
                        known = true;
                        targets.extend(more);
                    }
                }
            }
        }
        seen.remove(&(module, name));
        known.then_some(targets)
    }
}
