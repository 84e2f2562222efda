//! Checks the sources against `tools/architecture/rules.toml`, and prints the numbers that it states.
//!
//! ```text
//! architecture [--root FOLDER] [--rules FILE] [--places NUMBER]
//! ```
//!
//! `--places` prints every place that counts for one number, by its name or a part of it. Exit codes: 0 all rules hold,
//! 1 some do not, or the sources cannot be read.

mod check;
mod circles;
mod code;
mod imports;
mod numbers;
mod place;
mod rules;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod workspace;

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, bail};

use crate::numbers::{Measured, Program};
use crate::rules::{Number, Rules};
use crate::workspace::Workspace;

/// So many places of a number are printed when it exceeds its limit.
const PLACES_SHOWN: usize = 20;

struct Arguments {
    root: PathBuf,
    rules: Option<PathBuf>,
    places: Option<String>,
}

fn main() -> ExitCode {
    match arguments().and_then(|arguments| execute(&arguments)) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(violations) => {
            eprintln!("architecture: {violations} violations");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("architecture: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn arguments() -> anyhow::Result<Arguments> {
    let mut found = Arguments {
        root: PathBuf::from("."),
        rules: None,
        places: None,
    };
    let mut given = std::env::args().skip(1);
    while let Some(key) = given.next() {
        let value = given.next().with_context(|| format!("{key} has no value"))?;
        match key.as_str() {
            "--root" => found.root = PathBuf::from(value),
            "--rules" => found.rules = Some(PathBuf::from(value)),
            "--places" => found.places = Some(value),
            _ => bail!("{key} is unknown; expected --root FOLDER, --rules FILE or --places NUMBER"),
        }
    }
    Ok(found)
}

/// Returns the number of violations.
fn execute(arguments: &Arguments) -> anyhow::Result<usize> {
    let usual = arguments.root.join("tools/architecture/rules.toml");
    let rules = Rules::read(arguments.rules.as_ref().unwrap_or(&usual))?;
    let workspace = Workspace::read(&arguments.root)?;
    let imports = imports::resolve(&workspace)?;
    let program = Program::new(&workspace, &imports);
    if let Some(name) = &arguments.places {
        return print_places(&program, &rules, name).map(|()| 0);
    }
    let mut violations = check::dependencies(&workspace, &rules);
    violations.extend(check::words(&workspace, &rules, &program.proper())?);
    let mut violations: Vec<String> = violations.iter().map(ToString::to_string).collect();
    let mut measured = Vec::new();
    for number in &rules.numbers {
        match program.measure(number, &rules) {
            Ok(value) => measured.push((number, value)),
            Err(error) => violations.push(format!("{error:#}")),
        }
    }
    print!("{}", table::table(&rules.start, &measured));
    println!("{}", table::lines_by_crate(&program.lines_by_crate()));
    for (number, measured) in &measured {
        match number.most {
            Some(most) if measured.value > most => {
                violations.push(excess(number, measured, most, &arguments.root));
            }
            Some(most) if measured.value < most && !number.fixed => println!(
                "note: {} is {}; its limit in rules.toml can go down from {most}",
                number.name, measured.value
            ),
            _ => {}
        }
    }
    for violation in &violations {
        eprintln!("{violation}");
    }
    if violations.is_empty() {
        println!("architecture: all invariants hold");
    }
    Ok(violations.len())
}

/// Says that a number is over its limit, and where to look.
fn excess(number: &Number, measured: &Measured, most: usize, root: &Path) -> String {
    let places = measured.over(most, root);
    let mut lines = vec![format!(
        "{}: {}, the limit is {most}; in the files that changed last:",
        number.name, measured.value
    )];
    if measured.sizes.is_some() {
        lines[0] = format!("{}: {}, the limit is {most}:", number.name, measured.value);
    }
    lines.extend(places.iter().take(PLACES_SHOWN).map(|place| format!("  {place}")));
    if places.len() > PLACES_SHOWN {
        lines.push(format!(
            "  and {} more: scripts/check-architecture --places {:?}",
            places.len() - PLACES_SHOWN,
            number.name
        ));
    }
    lines.join("\n")
}

fn print_places(program: &Program, rules: &Rules, name: &str) -> anyhow::Result<()> {
    let number = rules.numbers.iter().find(|number| number.name.contains(name));
    let Some(number) = number else {
        let names: Vec<&str> = rules.numbers.iter().map(|number| number.name.as_str()).collect();
        bail!("no number is called {name:?}; numbers are {}", names.join("; "));
    };
    let places = program.measure(number, rules)?.places;
    let lines: Vec<String> = places.iter().map(|place| format!("{place}\n")).collect();
    match std::io::stdout().write_all(lines.concat().as_bytes()) {
        // The reader has seen enough.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => Ok(written?),
    }
}
