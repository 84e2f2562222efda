//! The crates of the workspace, from their manifests, and all their sources.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::Context;
use toml::{Table, Value};

use crate::source::Source;

/// All crates and their sources.
pub struct Workspace {
    /// Folder of the workspace.
    pub root: PathBuf,
    /// Crates of the program, in the order of the workspace; the root package comes last.
    pub crates: Vec<Crate>,
    /// Sources by path, without files of tests.
    pub sources: BTreeMap<PathBuf, Source>,
}

/// A crate.
pub struct Crate {
    /// Its short name: that of its folder, which is also its name in code.
    pub name: String,
    /// Its manifest, from the root.
    pub manifest: PathBuf,
    /// Folder of its sources, from the root.
    pub folder: PathBuf,
    /// Files that start a module tree: library, programs, build script.
    pub roots: Vec<PathBuf>,
    /// Names of its dependencies, without those of tests.
    pub dependencies: Vec<String>,
}

impl Workspace {
    /// Reads the workspace in the folder `root`.
    pub fn read(root: &Path) -> anyhow::Result<Workspace> {
        let table = manifest(root, Path::new("Cargo.toml"))?;
        let members = table
            .get("workspace")
            .and_then(|workspace| workspace.get("members"));
        let mut crates = Vec::new();
        for member in members.and_then(Value::as_array).into_iter().flatten() {
            let folder = PathBuf::from(member.as_str().context("workspace.members names folders")?);
            // Tools are no part of the program.
            if folder.starts_with("crates") {
                let path = folder.join("Cargo.toml");
                crates.push(Crate::new(root, &manifest(root, &path)?, path, &folder));
            }
        }
        if table.contains_key("package") {
            crates.push(Crate::new(
                root,
                &table,
                PathBuf::from("Cargo.toml"),
                Path::new(""),
            ));
        }
        let mut sources = BTreeMap::new();
        for krate in &crates {
            for path in rust_files(root, &krate.folder)? {
                let is_test = path.iter().any(|part| part == "tests" || part == "tests.rs");
                if !is_test && !sources.contains_key(&path) {
                    sources.insert(path.clone(), Source::read(root, &path)?);
                }
            }
        }
        Ok(Workspace {
            root: root.to_path_buf(),
            crates,
            sources,
        })
    }

    /// The crate of this name.
    pub fn find(&self, name: &str) -> Option<&Crate> {
        self.crates.iter().find(|krate| krate.name == name)
    }

    /// Sources in the folder of a crate, with its benchmarks and examples.
    pub fn sources_of<'a>(&'a self, krate: &'a Crate) -> impl Iterator<Item = &'a Source> {
        let inside = |path: &Path| path.starts_with(&krate.folder);
        self.sources.values().filter(move |source| inside(&source.path))
    }
}

impl Crate {
    fn new(root: &Path, table: &Table, manifest: PathBuf, folder: &Path) -> Crate {
        let roots = root_files(root, table, folder);
        let sources = if folder.as_os_str().is_empty() {
            root_folder(&roots)
        } else {
            folder.to_path_buf()
        };
        let name = sources
            .file_name()
            .map_or(String::new(), |name| name.to_string_lossy().into_owned());
        Crate {
            name,
            manifest,
            folder: sources,
            roots,
            dependencies: dependencies(table),
        }
    }
}

/// The folder of the root package's sources.
fn root_folder(roots: &[PathBuf]) -> PathBuf {
    let folder = roots
        .first()
        .and_then(|file| file.parent())
        .unwrap_or(Path::new("src"));
    match folder.file_name() {
        Some(name) if name == "src" => folder.parent().unwrap_or(folder).to_path_buf(),
        _ => folder.to_path_buf(),
    }
}

fn root_files(root: &Path, table: &Table, folder: &Path) -> Vec<PathBuf> {
    let path_of = |value: &Value| value.get("path").and_then(Value::as_str).map(PathBuf::from);
    let package = table.get("package");
    let build = package
        .and_then(|package| package.get("build"))
        .and_then(Value::as_str);
    let library = table.get("lib").and_then(path_of);
    let mut files = vec![library.unwrap_or_else(|| PathBuf::from("src/lib.rs"))];
    files.push(PathBuf::from("src/main.rs"));
    let programs = table.get("bin").and_then(Value::as_array);
    files.extend(programs.into_iter().flatten().filter_map(path_of));
    files.push(PathBuf::from(build.unwrap_or("build.rs")));
    let files = files.into_iter().map(|file| folder.join(file));
    files.filter(|file| root.join(file).is_file()).collect()
}

/// Names in the tables of dependencies, also in those of a target.
fn dependencies(table: &Table) -> Vec<String> {
    let mut names = Vec::new();
    let targets = table.get("target").and_then(Value::as_table);
    let targets = targets
        .into_iter()
        .flat_map(Table::values)
        .filter_map(Value::as_table);
    for table in std::iter::once(table).chain(targets) {
        for key in ["dependencies", "build-dependencies"] {
            let list = table.get(key).and_then(Value::as_table);
            names.extend(list.into_iter().flat_map(Table::keys).cloned());
        }
    }
    names
}

fn manifest(root: &Path, path: &Path) -> anyhow::Result<Table> {
    let text = std::fs::read_to_string(root.join(path)).with_context(|| path.display().to_string())?;
    toml::from_str(&text).with_context(|| path.display().to_string())
}

fn rust_files(root: &Path, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let files = files_below(root, folder)?.into_iter();
    Ok(files
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect())
}

/// All files below a folder in the order of their names, without hidden ones and what is built.
pub fn files_below(root: &Path, folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let at = root.join(folder);
    if !at.is_dir() {
        return Ok(files);
    }
    let mut entries = std::fs::read_dir(&at)
        .and_then(Iterator::collect::<std::io::Result<Vec<_>>>)
        .with_context(|| at.display().to_string())?;
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let name = entry.file_name();
        if name.to_string_lossy().starts_with('.') {
            continue;
        }
        let path = folder.join(&name);
        let kind = entry.file_type()?;
        if kind.is_dir() {
            let built = name == "target" || (folder.as_os_str().is_empty() && name == "results");
            if !built {
                files.extend(files_below(root, &path)?);
            }
        } else if kind.is_file() {
            files.push(path);
        }
    }
    Ok(files)
}
