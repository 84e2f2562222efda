//! `raceway help`, of the program, of a command, and the reference of scenes; completions and the man page.

use std::path::Path;
use std::process::ExitCode;

use comm::print;
use results::failure::Failure;
use scene::reference;

/// Prints help on a topic, or says which topics there are.
pub fn help(topic: &[String], mut program: clap::Command) -> ExitCode {
    let topic: Vec<&str> = topic.iter().map(String::as_str).collect();
    let text = match topic.as_slice() {
        [] => Ok(program.render_long_help().to_string()),
        ["scene"] => Ok(reference::whole_page()),
        ["scene", key] => of_key(key),
        [command] => of_command(command, &mut program),
        [first, ..] => Err(format!(
            "help takes a command, or scene and a key, not all of {first:?} and the rest"
        )),
    };
    match text {
        Ok(text) => print_all(text.trim_end()),
        Err(problem) => {
            let failure = Failure::User(anyhow::anyhow!(problem));
            print::note(format_args!("{}: {}", failure.kind(), failure.text()));
            ExitCode::from(failure.number())
        }
    }
}

/// Prints the completions of a shell.
pub fn completions(shell: clap_complete::Shell, mut program: clap::Command) -> ExitCode {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut program, "raceway", &mut text);
    print_all(&String::from_utf8_lossy(&text))
}

/// Prints the man page.
pub fn man(program: clap::Command) -> ExitCode {
    let mut text = Vec::new();
    match clap_mangen::Man::new(program).render(&mut text) {
        Ok(()) => print_all(&String::from_utf8_lossy(&text)),
        Err(error) => {
            print::note(format_args!("error: cannot make the man page: {error}"));
            ExitCode::FAILURE
        }
    }
}

/// Writes the man pages of the program and of all its commands into a folder.
pub fn pages(mut program: clap::Command, out: &Path) -> ExitCode {
    // Options that all commands share are known to a command once the program is built.
    program.build();
    match write_pages(&program, out) {
        Ok(n) => print_all(&format!("{n} man pages in {}", out.display())),
        Err(error) => {
            let failure = Failure::User(anyhow::anyhow!(
                "cannot write man pages into {}: {error}",
                out.display()
            ));
            print::note(format_args!("{}: {}", failure.kind(), failure.text()));
            ExitCode::from(failure.number())
        }
    }
}

/// Returns how many.
fn write_pages(program: &clap::Command, out: &Path) -> std::io::Result<usize> {
    std::fs::create_dir_all(out)?;
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set());
    let all = std::iter::once(program).chain(commands);
    let mut n = 0;
    for command in all {
        clap_mangen::Man::new(command.clone()).generate_to(out)?;
        n += 1;
    }
    Ok(n)
}

fn print_all(text: &str) -> ExitCode {
    print::to_standard_output(text);
    match Failure::unwritten() {
        None => ExitCode::SUCCESS,
        Some(failure) => {
            print::note(format_args!("{}: {}", failure.kind(), failure.text()));
            ExitCode::from(failure.number())
        }
    }
}

fn of_key(key: &str) -> Result<String, String> {
    match reference::about(key).as_slice() {
        [] => Err(format!(
            "no table and no key of a scene has the name {key:?}; expected one such as bearing, shaft.z or \
             contact_angle, and raceway help scene lists all"
        )),
        blocks => Ok(blocks.iter().map(|block| format!("{}\n\n", block.text)).collect()),
    }
}

fn of_command(name: &str, program: &mut clap::Command) -> Result<String, String> {
    let names: Vec<String> = program
        .get_subcommands()
        .filter(|command| !command.is_hide_set())
        .map(|command| command.get_name().to_string())
        .collect();
    // Options that all commands share are known to a command once the program is built.
    program.build();
    let command = program.find_subcommand_mut(name).ok_or_else(|| {
        format!(
            "there is no command {name:?}; commands are {}, and help scene has the keys of scenes",
            names.join(", ")
        )
    })?;
    Ok(command.render_long_help().to_string())
}
