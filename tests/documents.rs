//! The documents: links lead somewhere, the contents name every page, sentences are short, and every command is one
//! that the program takes. Commands without placeholders are run, from the top of a page to its end.

mod commands;
mod forms;
mod prose;

use std::path::{Path, PathBuf};

use self::commands::{Command, commands_of};
use crate::first_hour::has_gmsh;
use crate::util::Dir;

/// Largest mean of words in the sentences of a page.
const MEAN_WORDS: f64 = 20.0;

/// Pages of which each is read from the folder that the one before has left.
const TUTORIAL: [&str; 2] = ["docs/tutorial/bearing.md", "docs/tutorial/motion.md"];

/// Commands that are only parsed, with the reason.
const NOT_RUN: [(&str, &str); 9] = [
    ("raceway study studies/spalls.toml --out", "a study of an hour"),
    ("raceway study studies/static.toml --out", "a study of minutes"),
    (
        "raceway study studies/static.toml --list",
        "its meshes are those of that study",
    ),
    ("raceway advise out", "it reads that study"),
    ("raceway prices ", "a price list of minutes"),
    ("raceway run scenes/7010c_1800rpm", "a revolution of 40 s"),
    (
        "raceway info results/rolling",
        "it reads the results of a batch job",
    ),
    ("raceway plot results/rolling", "the same"),
    ("raceway init 7208 ", "in a list with descriptions"),
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

/// Whether a command takes too long for every change, or follows one that does.
fn is_slow(command: &Command) -> bool {
    NOT_RUN.iter().any(|(start, _)| command.text.starts_with(start))
}

/// Runs the commands of pages that are not slow in one folder; returns how many.
fn run_pages(pages: &[&str]) -> usize {
    run_commands(pages, |command| !is_slow(command))
}

/// Runs the commands of pages that are chosen in one folder; returns how many.
fn run_commands(pages: &[&str], is_chosen: impl Fn(&Command) -> bool) -> usize {
    let dir = Dir::empty();
    for name in ["scenes", "meshes", "studies"] {
        std::os::unix::fs::symlink(root().join(name), dir.path(name)).unwrap();
    }
    let mut count = 0;
    for page in pages {
        let text = text_of(page);
        let is_run = |command: &&Command| command.can_be_run() && is_chosen(command);
        for command in commands_of(&text).unwrap().iter().filter(is_run) {
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

/// Whether a page is for those who use the program.
fn is_user_page(page: &str) -> bool {
    page.starts_with("docs/") && !page.starts_with("docs/dev/")
}

/// Wrong: a reader who types what a page shows would not get what it says.
#[test]
fn commands_of_the_user_pages_run() {
    let mut count = 0;
    for page in pages() {
        let needs_gmsh = text_of(&page).contains("raceway mesh ");
        if is_user_page(&page) && !needs_gmsh && !TUTORIAL.contains(&page.as_str()) {
            count += run_pages(&[&page]);
        }
    }
    assert!(count >= 5, "only {count} commands were found");
}

/// Wrong: as above, for commands of minutes. A study of an hour, and what follows a batch job, are left to
/// `scripts/test-slurm` and the reader.
#[test]
#[ignore = "some minutes; scripts/test-slow runs it"]
fn slow_commands_of_the_documents_run() {
    let count = run_commands(&["docs/accuracy.md"], |_| true);
    assert!(count >= 5, "only {count} commands were found");
}

/// Wrong: the first two pages of the tutorial, or the way from a catalogue, would end with an error.
#[test]
fn the_tutorial_runs() {
    if !has_gmsh() {
        eprintln!("skipped: the meshes of the tutorial are made by Gmsh, which is not installed");
        return;
    }
    assert!(run_pages(&TUTORIAL) >= 12);
    assert!(run_pages(&["docs/scenes.md"]) >= 4);
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
