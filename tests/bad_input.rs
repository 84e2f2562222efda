//! Inputs that must be refused: exit code 2, a message with what is wrong, where, what was expected and what to try,
//! and not one file made, changed or removed.

mod command_line;
mod fit;
mod meshes;
mod scenes;
mod text;

use crate::util::Dir;

/// Exit code of a user error.
const USER_ERROR: i32 = 2;

/// The program, started in `dir`, refuses `arguments`: its message has all `parts`, and no file is touched.
#[track_caller]
fn assert_refused(name: &str, dir: &Dir, variables: &[(&str, &str)], arguments: &[&str], parts: &[&str]) {
    let before = dir.snapshot();
    let outcome = dir.raceway_with(variables, arguments);
    let stderr = &outcome.stderr;
    assert_eq!(outcome.code, Some(USER_ERROR), "{name}: {stderr}");
    for part in parts {
        assert!(stderr.contains(part), "{name}: expected\n{part}\nin\n{stderr}");
    }
    assert_eq!(
        stderr.matches("error: ").count(),
        1,
        "{name}: not exactly one error in\n{stderr}"
    );
    assert_eq!(outcome.stdout, "", "{name}: something was announced as a result");
    let after = dir.snapshot();
    let touched: Vec<_> = after
        .keys()
        .filter(|path| before.get(*path) != after.get(*path))
        .collect();
    assert!(touched.is_empty(), "{name}: made or changed {touched:?}");
    assert_eq!(before.len(), after.len(), "{name}: a file was removed");
}

/// `raceway run scene.toml --out out` with further arguments.
fn run<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["run", "scene.toml", "--out", "out"], more].concat()
}
