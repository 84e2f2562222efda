//! The documents: links lead somewhere, the contents name every page, sentences are short, and every command is one
//! that the program takes. Commands are run, from the top of a page to its end, but for those that a table names.

mod commands;
mod fixtures;
mod prose;

use std::path::{Path, PathBuf};

use self::commands::{Command, commands_of};
use self::fixtures::FILLED;
use crate::first_hour::has_gmsh;
use crate::util::Dir;

/// Largest mean of words in the sentences of a page.
const MEAN_WORDS: f64 = 20.0;

/// Pages of which each is read from the folder that the one before has left.
const TUTORIAL: [&str; 2] = ["docs/tutorial/bearing.md", "docs/tutorial/motion.md"];

/// Pages of which nothing is run without Gmsh: what they show first is a mesh.
const WITH_GMSH: [&str; 4] = [TUTORIAL[0], TUTORIAL[1], "docs/scenes.md", "meshes/README.md"];

/// Beginnings of commands that no test runs as they are written, with the reason. They are parsed, if they are ours.
const NOT_RUN: [(&str, &str); 42] = [
    ("apptainer ", "needs Apptainer"),
    (
        "CMAKE=$PWD/target/cmake/bin/cmake packaging/",
        "builds the program and HDF5",
    ),
    ("cargo bench ", "a benchmark of minutes"),
    ("cargo build ", "builds the program"),
    ("cargo install ", "builds the program"),
    (
        "cargo test ",
        "tests of minutes, some of which scripts/test-slow runs",
    ),
    ("cargo vendor ", "needs a network"),
    ("conda ", "needs conda"),
    ("curl ", "needs a network"),
    ("docker ", "needs Docker"),
    ("export HDF5_DIR=", "of a cluster"),
    ("ldd ", "of a cluster"),
    ("mkdir -p .cargo", "of a cluster"),
    ("module ", "of a cluster"),
    ("mpirun ", "needs MPI; scripts/test-mpi runs others"),
    ("packaging/build-static", "builds the program and HDF5"),
    ("packaging/check-static", "needs that program"),
    (
        "pip install ",
        "needs a network; scripts/test-python installs the wheel",
    ),
    ("python3 -m venv target/cmake", "needs a network"),
    (
        "raceway advise out",
        "it reads a study of minutes; tests/study.rs asks another",
    ),
    ("raceway export --to csv", "an option; tests/export.rs runs it"),
    ("raceway heat --out DIR", "an option; docs/heat.md shows it"),
    (
        "raceway info results/rolling",
        "it reads the results of a batch job",
    ),
    (
        "raceway plot results/rolling",
        "it reads the results of a batch job",
    ),
    (
        "raceway prices scenes/",
        "a price list of minutes; tests/prices.rs makes a shorter one",
    ),
    ("raceway study studies/spalls.toml --out", "a study of an hour"),
    (
        "raceway study studies/static.toml --list",
        "its meshes are those of that study",
    ),
    ("raceway study studies/static.toml --out", "a study of minutes"),
    ("sbatch ", "needs Slurm; scripts/test-slurm submits such jobs"),
    ("scp ", "of a cluster"),
    ("scripts/compare-versions ", "it builds another version"),
    ("scripts/fuzz", "it ends when it is stopped"),
    ("scripts/hard-cases", "an hour; the fast cases are tests"),
    ("scripts/peers/", "programs of others"),
    ("scripts/test", "it runs this test"),
    (
        "slurm/sweep ",
        "needs Slurm; scripts/test-slurm submits such jobs",
    ),
    ("squeue ", "needs Slurm"),
    ("srun ", "needs Slurm; scripts/test-slurm submits such jobs"),
    ("tar ", "of a cluster"),
    ("target/cmake/bin/pip ", "needs a network"),
    (
        "xvfb-run ",
        "needs ParaView; tests/readers.rs runs the script where it is",
    ),
    (
        "raceway mesh --revolve-like",
        "its free mesh is large; tests/revolve_like.rs meshes a small one",
    ),
];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All pages of the project, by their path from its root.
fn pages() -> Vec<String> {
    let mut pages: Vec<String> = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md"]
        .map(String::from)
        .into();
    for folder in [
        "docs",
        "docs/tutorial",
        "docs/dev",
        "docs/studies",
        "slurm",
        "meshes",
        "python",
    ] {
        let entries = std::fs::read_dir(root().join(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        pages.extend(
            names
                .filter(|name| name.ends_with(".md"))
                .map(|name| format!("{folder}/{name}")),
        );
    }
    pages.sort();
    pages
}

fn text_of(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).unwrap_or_else(|e| panic!("{page}: {e}"))
}

/// Targets of the links of a page, without those to other sites.
fn links(text: &str) -> Vec<&str> {
    let parts = text.split("](").skip(1);
    parts
        .filter_map(|part| part.split_once(')').map(|(target, _)| target))
        .filter(|target| !target.contains("://"))
        .collect()
}

/// The anchor of a heading, as sites that show Markdown make it.
fn anchor(heading: &str) -> String {
    let words = heading.trim_start_matches('#').trim().to_lowercase();
    words
        .chars()
        .filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// Wrong: a reader would follow a link into nothing.
#[test]
fn every_link_leads_to_a_file_and_a_heading() {
    for page in pages() {
        let text = text_of(&page);
        let here = root().join(&page);
        for link in links(&text) {
            let (path, heading) = link.split_once('#').unwrap_or((link, ""));
            let target: PathBuf = match path {
                "" => here.clone(),
                path => here.parent().unwrap().join(path),
            };
            assert!(target.exists(), "{page}: the link {link} leads to no file");
            if !heading.is_empty() {
                let other = std::fs::read_to_string(&target).unwrap();
                let found = other
                    .lines()
                    .any(|line| line.starts_with('#') && anchor(line) == heading);
                assert!(found, "{page}: the link {link} leads to no heading");
            }
        }
    }
}

/// Wrong: a page would be in the folder and in no part of the book.
#[test]
fn the_contents_name_every_page() {
    let contents = text_of("docs/README.md");
    let named = links(&contents);
    for page in pages() {
        let Some(name) = page.strip_prefix("docs/") else {
            continue;
        };
        // Tables of studies are shown by the page on accuracy.
        if name != "README.md" && !name.starts_with("studies/") {
            assert!(named.contains(&name), "docs/README.md does not name {name}");
        }
    }
    assert!(
        text_of("README.md").contains("(docs/README.md)"),
        "the README does not name the book"
    );
}

/// Wrong: pages would be read slowly: sentences of 20 words in the mean are those of a newspaper.
#[test]
fn sentences_are_short() {
    let mut long = Vec::new();
    for page in pages() {
        let lengths = prose::lengths_of_sentences(&text_of(&page));
        let mean = lengths.iter().sum::<usize>() as f64 / lengths.len().max(1) as f64;
        if mean >= MEAN_WORDS {
            long.push(format!(
                "{page}: {mean:.1} words a sentence; expected less than {MEAN_WORDS}"
            ));
        }
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}

/// Wrong: a page would show a command that the program does not take, or a file that is not there.
#[test]
fn every_command_of_the_documents_is_taken() {
    let dir = Dir::empty();
    let mut wrong = Vec::new();
    for page in pages() {
        // What was new then may have other names now.
        let text = if page == "CHANGELOG.md" {
            String::new()
        } else {
            text_of(&page)
        };
        for command in commands_of(&text).unwrap_or_else(|e| panic!("{page}: {e}")) {
            let missing = command.paths().find(|path| !root().join(path).exists());
            if let Some(path) = missing {
                wrong.push(format!("{page}: {}: there is no {path}", command.text));
            }
            if let Err(said) = command.parse(&dir) {
                wrong.push(format!("{page}: {}: {said}", command.text));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The commands of a page that are not only a name in its text, each once.
fn whole_commands(page: &str) -> Vec<Command> {
    // What was new then may have other names now.
    if page == "CHANGELOG.md" {
        return Vec::new();
    }
    let mut found: Vec<Command> = Vec::new();
    for command in commands_of(&text_of(page)).unwrap() {
        if !command.is_a_name() && found.iter().all(|earlier| earlier.text != command.text) {
            found.push(command);
        }
    }
    found
}

fn is_named(command: &Command) -> bool {
    NOT_RUN.iter().any(|(start, _)| command.text.starts_with(start))
}

/// Wrong: a command would be in a page that nobody has ever typed, or one would be excused that no page has.
#[test]
fn every_command_is_run_or_named_with_the_reason() {
    let mut texts = Vec::new();
    let mut wrong = Vec::new();
    for page in pages() {
        for command in whole_commands(&page) {
            if !is_named(&command) && command.line().is_none() {
                wrong.push(format!(
                    "{page}: {}: no test runs it; expected words for its capitals in tests/documents/fixtures.rs, \
                     or its name in NOT_RUN with the reason",
                    command.text
                ));
            }
            texts.push(command.text);
        }
    }
    for (start, _) in NOT_RUN {
        if !texts.iter().any(|text| text.starts_with(start)) {
            wrong.push(format!("NOT_RUN names {start:?}, which no page has"));
        }
    }
    for filled in FILLED {
        if !texts.iter().any(|text| text == filled.command) {
            wrong.push(format!("FILLED has {:?}, which no page has", filled.command));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Runs the commands of pages in one folder; returns how many.
fn run_pages(pages: &[&str]) -> usize {
    let dir = fixtures::world();
    for name in ["scenes", "meshes", "studies"] {
        copy(&root().join(name), &dir.path(name));
    }
    let mut count = 0;
    for page in pages {
        for command in whole_commands(page).iter().filter(|command| !is_named(command)) {
            let needs_gmsh = command.text.contains("raceway mesh ");
            if needs_gmsh && !has_gmsh() {
                continue;
            }
            let outcome = command.run(&dir);
            assert_eq!(
                outcome.code,
                Some(0),
                "{page}: {}: {}",
                command.text,
                outcome.stderr
            );
            count += 1;
        }
    }
    count
}

/// Copies a folder, so that what a command writes there is not in the project.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to);
        } else {
            std::fs::copy(path, to).unwrap();
        }
    }
}

/// Wrong: a reader who types what a page shows would not get what it says.
#[test]
fn commands_of_the_pages_run() {
    let mut count = 0;
    for page in pages() {
        if !WITH_GMSH.contains(&page.as_str()) {
            count += run_pages(&[&page]);
        }
    }
    assert!(count >= 40, "only {count} commands were found");
}

/// Wrong: the first two pages of the tutorial, the way from a catalogue, or that to other meshes would end with an
/// error.
#[test]
fn the_tutorial_and_pages_with_meshes_run() {
    if !has_gmsh() {
        eprintln!("skipped: the meshes of the tutorial are made by Gmsh, which is not installed");
        return;
    }
    assert!(run_pages(&TUTORIAL) >= 12);
    for page in &WITH_GMSH[2..] {
        assert!(run_pages(&[page]) >= 4, "{page}");
    }
}

/// Wrong: a recipe or the citation would be of another version than the program, or of an older compiler.
#[test]
fn recipes_and_citation_have_the_versions_of_the_project() {
    let version = env!("CARGO_PKG_VERSION");
    let rust = env!("CARGO_PKG_RUST_VERSION");
    let expected = [
        ("CITATION.cff", format!("\nversion: {version}\n")),
        (
            "packaging/conda/meta.yaml",
            format!("set version = \"{version}\""),
        ),
        (
            "packaging/conda/meta.yaml",
            format!("compiler(\"rust\") }}}} >={rust}\n"),
        ),
        ("packaging/Dockerfile", format!("BUILD_IMAGE=rust:{rust}-")),
        ("packaging/raceway.def", format!("From: rust:{rust}-")),
        ("docs/install.md", format!("Rust {rust}")),
    ];
    for (file, text) in expected {
        assert!(text_of(file).contains(&text), "{file} has no {text:?}");
    }
}
