//! Commands that a page shows: in blocks of code, and in its running text where they begin with `raceway`.

use std::path::Path;
use std::process::Command as Process;

use crate::util::{Dir, Outcome};

/// Programs of others, of which only the paths are checked.
const OTHERS: [&str; 19] = [
    "apptainer",
    "cargo",
    "conda",
    "curl",
    "docker",
    "export",
    "ldd",
    "mkdir",
    "module",
    "mpirun",
    "pip",
    "python3",
    "scp",
    "squeue",
    "srun",
    "target/cmake/bin/pip",
    "tar",
    "xvfb-run",
    "sbatch",
];
/// Folders of the project whose files commands name.
const FOLDERS: [&str; 6] = [
    "scripts/",
    "slurm/",
    "packaging/",
    "scenes/",
    "studies/",
    "meshes/",
];

/// A command of a page.
#[derive(Debug)]
pub struct Command {
    /// The command on one line, without its comment.
    pub text: String,
    /// Whether it stands in a block of its own; else it is part of a sentence.
    is_shown: bool,
}

/// The commands of a page. An error where a block mixes commands with something else.
pub fn commands_of(text: &str) -> Result<Vec<Command>, String> {
    let mut commands = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("\n```") {
        commands.extend(in_running_text(before));
        let (kind, block) = after.split_once('\n').unwrap_or(("", ""));
        let (block, next) = block.split_once("\n```").unwrap_or((block, ""));
        if ["", "sh", "console"].contains(&kind) {
            commands.extend(in_block(block)?);
        }
        rest = next;
    }
    commands.extend(in_running_text(rest));
    Ok(commands)
}

/// Spans of code that begin with the name of the program and a command.
fn in_running_text(text: &str) -> Vec<Command> {
    let spans = text.split('`').skip(1).step_by(2);
    let words = spans.map(|span| span.split_whitespace().collect::<Vec<_>>().join(" "));
    // Shortened ones are words about a command.
    let commands = words.filter(|span| span.starts_with("raceway ") && !span.contains("..."));
    let is_shown = false;
    commands.map(|text| Command { text, is_shown }).collect()
}

/// Commands of a block: all its lines, or none.
fn in_block(block: &str) -> Result<Vec<Command>, String> {
    let joined = block.replace("\\\n", " ");
    let lines = joined
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let commands: Vec<Command> = lines.map(Command::of).collect();
    let n_known = commands.iter().filter(|command| command.is_known()).count();
    match n_known {
        0 => Ok(Vec::new()),
        n if n == commands.len() => Ok(commands),
        _ => {
            let other = commands
                .iter()
                .find(|command| !command.is_known())
                .expect("not all are known");
            Err(format!(
                "among commands there is {:?}, which is none that is known here",
                other.text
            ))
        }
    }
}

impl Command {
    /// A line without its comment, or its description after three spaces.
    fn of(line: &str) -> Command {
        let line = line.split(" #").next().unwrap_or(line);
        // What it is piped into is no command of ours.
        let line = line.split(" | ").next().unwrap_or(line).trim();
        let words = line
            .find("   ")
            .map_or(line, |end| match line[end..].trim_start().chars().next() {
                Some(c) if c.is_alphanumeric() => &line[..end],
                _ => line,
            });
        let words = words.trim().split("  ").map(str::trim);
        let text = words
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(" ");
        Command::shown(text)
    }

    fn first(&self) -> &str {
        let mut words = self.text.split_whitespace();
        // Variables of the environment come before the program.
        words
            .find(|word| !word.contains('=') || word.starts_with('-'))
            .unwrap_or_default()
    }

    fn is_known(&self) -> bool {
        let first = self.first();
        first.ends_with("raceway")
            || OTHERS.contains(&first)
            || FOLDERS.iter().any(|folder| first.starts_with(folder))
    }

    /// Files of the project that the command names.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        let words = self.text.split_whitespace();
        words.filter(|word| {
            let is_named = FOLDERS.iter().any(|folder| word.starts_with(folder));
            is_named && !word.contains(['*', '$', '<', ',', ';'])
        })
    }

    /// A command that stands in a block.
    pub fn shown(text: String) -> Command {
        Command { text, is_shown: true }
    }

    /// The command, where `scripts/run` builds the program and runs a scene.
    fn of_program(&self) -> String {
        match self.text.strip_prefix("scripts/run ") {
            Some(rest) => format!("raceway run {rest}"),
            None => self.text.clone(),
        }
    }

    /// What follows the name of the program, if this is a command of it: also behind a launcher.
    fn words(&self) -> Option<String> {
        let text = self.of_program();
        let launchers = [
            "",
            "mpirun ",
            "srun ",
            "target/release/",
            "docker run ",
            "apptainer run ",
        ];
        let is_ours =
            text.starts_with("raceway ") || launchers[1..].iter().any(|launcher| text.starts_with(launcher));
        let (_, words) = is_ours.then(|| text.split_once("raceway "))??;
        Some(words.trim_start_matches(".sif ").to_string())
    }

    /// Fails, with what the program says, if it does not take the command. Nothing is run.
    pub fn parse(&self, dir: &Dir) -> Result<(), String> {
        let Some(words) = self.words() else { return Ok(()) };
        // Brackets mark what may be left out, a bar one of two; a lone capital letter is a number.
        let words = words
            .replace(['[', ']'], " ")
            .replace(" | ", " ")
            .replace(" N ", " 1 ");
        let words = words
            .strip_suffix(" N")
            .map_or(words.clone(), |start| format!("{start} 1"));
        let examples = [
            ("hh:mm:ss", "01:00:00"),
            (" SECONDS", " 1"),
            (" S ", " 1 "),
            ("LOW..HIGH", "1..2"),
            ("scene KEY", "scene bearing"),
            ("completions SHELL", "completions bash"),
        ];
        let words = examples
            .iter()
            .fold(words, |words, (name, example)| words.replace(name, example));
        let words = words
            .strip_suffix(" S")
            .map_or(words.clone(), |start| format!("{start} 1"));
        let ends = ["help", "man", "completions", "--version"];
        let is_free = ends.iter().any(|end| words.trim().starts_with(end));
        let end = if is_free { "" } else { " --help" };
        let outcome = shell(dir, &format!("raceway {words}{end}"));
        match outcome.code {
            Some(0) => Ok(()),
            _ => Err(outcome.stderr),
        }
    }

    /// Whether a word stands for others: capitals alone, or what may be left out.
    fn has_placeholders(&self) -> bool {
        let is_placeholder = |word: &str| {
            word.len() > 1 && word.chars().all(|c| c.is_ascii_uppercase() || c == '_')
                || word.contains(['[', '<'])
        };
        self.text.split([' ', '=', '/', '.']).any(is_placeholder)
    }

    /// Whether this is a command of the program that needs nothing in the place of a word.
    pub fn can_be_run(&self) -> bool {
        let is_ours = self.is_shown && self.of_program().starts_with("raceway ");
        is_ours && !self.has_placeholders()
    }

    /// Whether this is a command of the program with words that stand for others.
    pub fn is_form(&self) -> bool {
        self.is_shown && self.text.starts_with("raceway ") && self.has_placeholders()
    }

    /// Runs it.
    pub fn run(&self, dir: &Dir) -> Outcome {
        shell(dir, &self.of_program())
    }
}

/// A line of a shell in the folder, with the program of the tests on its path.
fn shell(dir: &Dir, line: &str) -> Outcome {
    let program = Path::new(env!("CARGO_BIN_EXE_raceway"));
    let path = format!(
        "{}:{}",
        program.parent().unwrap().display(),
        std::env::var("PATH").unwrap()
    );
    let mut bash = Process::new("bash");
    bash.args(["-c", line])
        .env("PATH", path)
        .current_dir(dir.path("."));
    Outcome::of(bash.output().unwrap())
}

/// Wrong: commands would be overlooked, and their tests see nothing.
#[test]
fn commands_are_found() {
    let page = "Text with `raceway plot DIR` and `other`.\n\n```\nraceway run a.toml \\\n    --out b   # why\n\
                sbatch x\n```\n\n```toml\nraceway = 1\n```\n\n```\nx = y\n```\n\n\
                ```\nraceway info PATH      says\n```\nend";
    let found: Vec<String> = commands_of(page)
        .unwrap()
        .into_iter()
        .map(|command| command.text)
        .collect();
    assert_eq!(
        found,
        [
            "raceway plot DIR",
            "raceway run a.toml --out b",
            "sbatch x",
            "raceway info PATH"
        ]
    );
    let error = commands_of("\n```\nraceway run a\ncheese\n```\n").unwrap_err();
    assert!(
        error.contains("\"cheese\", which is none that is known here"),
        "{error}"
    );
}
