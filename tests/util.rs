//! Starts the program in a folder of its own and reads what it leaves there.

pub mod delivered;
pub mod lockstep;
pub mod matrices;
pub mod rings;
pub mod tables;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use tempfile::TempDir;

/// The scene that all tests start from.
pub const SCENE: &str = include_str!("fixtures/7010c.toml");

/// `--set` arguments that make both rings rigid, so that no mesh is read.
pub const RIGID: [&str; 6] = [
    "--set",
    "contact.mode=rigid",
    "--set",
    "inner.flexible=false",
    "--set",
    "outer.flexible=false",
];

/// Variables of launchers that the program looks at; the tests may themselves run under a launcher.
const LAUNCHERS: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"];

/// Files and folders (without content) by path.
pub type Files = BTreeMap<PathBuf, Option<Vec<u8>>>;

/// A temporary folder with the inputs of one test; the program is started in it. Removed at the end.
pub struct Dir(TempDir);

/// How the program ended.
#[derive(Debug)]
pub struct Outcome {
    /// Exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// What it printed as its result.
    pub stdout: String,
    /// Progress and errors.
    pub stderr: String,
}

impl Outcome {
    /// What a process left.
    pub fn of(output: Output) -> Outcome {
        Outcome {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Dir {
    /// An empty folder.
    pub fn empty() -> Dir {
        Dir(tempfile::tempdir().unwrap())
    }

    /// A folder with the scene of the tests as `scene.toml`, without meshes.
    pub fn with_scene(text: &str) -> Dir {
        let dir = Dir::empty();
        dir.write("scene.toml", text);
        dir
    }

    /// A folder with the scene of the tests and coarse meshes of both rings, mm.
    pub fn with_meshes() -> Dir {
        let dir = Dir::with_scene(SCENE);
        let [inner, outer] = rings::coarse_files();
        dir.write("inner.msh", inner);
        dir.write("outer.msh", outer);
        dir
    }

    /// A folder with these files, as [`Dir::snapshot`] gives them.
    pub fn with_files(files: &Files) -> Dir {
        let dir = Dir::empty();
        // Folders come before what is in them.
        for (path, content) in files {
            match content {
                Some(bytes) => std::fs::write(dir.0.path().join(path), bytes).unwrap(),
                None => std::fs::create_dir(dir.0.path().join(path)).unwrap(),
            }
        }
        dir
    }

    /// Path of something in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file; its folder must be there.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    /// Reads a text file.
    pub fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Every file and folder below, by path from here; folders have no content.
    pub fn snapshot(&self) -> Files {
        let mut found = Files::new();
        collect(self.0.path(), self.0.path(), &mut found);
        found
    }

    /// Starts the program here.
    pub fn raceway(&self, arguments: &[&str]) -> Outcome {
        self.raceway_with(&[], arguments)
    }

    /// Starts the program here with environment variables.
    pub fn raceway_with(&self, variables: &[(&str, &str)], arguments: &[&str]) -> Outcome {
        let mut command = self.command(arguments);
        Outcome::of(command.envs(variables.iter().copied()).output().unwrap())
    }

    /// Starts the program here with a standard output that nobody reads: the other end of the pipe is closed.
    pub fn raceway_into_closed_pipe(&self, arguments: &[&str]) -> Outcome {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let child = self
            .command(arguments)
            .stdout(writer)
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        Outcome::of(child.wait_with_output().unwrap())
    }

    /// Puts a shell script in front of the programs on the PATH and returns that PATH.
    pub fn program(&self, name: &str, script: &str) -> String {
        std::fs::create_dir_all(self.path("bin")).unwrap();
        self.write(&format!("bin/{name}"), format!("#!/usr/bin/env bash\n{script}\n"));
        let executable = std::os::unix::fs::PermissionsExt::from_mode(0o755);
        std::fs::set_permissions(self.path(&format!("bin/{name}")), executable).unwrap();
        format!(
            "{}:{}",
            self.path("bin").display(),
            std::env::var("PATH").unwrap()
        )
    }

    /// Starts the program here and leaves it running, with its progress to be read.
    pub fn start(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    /// Starts the program here under a limit of the size of its files, kB; writing beyond it is an error.
    pub fn raceway_with_small_files(&self, limit: u32, arguments: &[&str]) -> Outcome {
        self.raceway_after(&format!("ulimit -f {limit}"), arguments)
    }

    /// Starts the program here after some words of a shell, such as a limit.
    pub fn raceway_after(&self, words: &str, arguments: &[&str]) -> Outcome {
        Outcome::of(self.shell(words, arguments).output().unwrap())
    }

    /// The program as a shell starts it after some words; it takes the place of the shell.
    pub fn shell(&self, words: &str, arguments: &[&str]) -> Command {
        let mut shell = Command::new("bash");
        for name in LAUNCHERS {
            shell.env_remove(name);
        }
        shell
            .args([
                "-c",
                &format!("{words}; exec \"$0\" \"$@\""),
                env!("CARGO_BIN_EXE_raceway"),
            ])
            .args(arguments)
            .current_dir(self.0.path());
        shell
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_raceway"));
        for name in LAUNCHERS {
            command.env_remove(name);
        }
        command.args(arguments).current_dir(self.0.path());
        command
    }

    /// `raceway run scene.toml --out <out>` with further arguments, which must succeed.
    pub fn run(&self, out: &str, arguments: &[&str]) -> Outcome {
        let outcome = self.raceway(&[&["run", "scene.toml", "--out", out], arguments].concat());
        assert_eq!(outcome.code, Some(0), "{arguments:?}: {}", outcome.stderr);
        outcome
    }
}

fn collect(root: &Path, folder: &Path, found: &mut Files) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.strip_prefix(root).unwrap().to_path_buf();
        if path.is_dir() {
            found.insert(name, None);
            collect(root, &path, found);
        } else {
            found.insert(name, Some(std::fs::read(&path).unwrap()));
        }
    }
}

/// The scene of the tests with the line that starts with `line` replaced; the first one of the table `header` if
/// that is not empty.
pub fn with_line(header: &str, line: &str, replacement: &str) -> String {
    let from = SCENE
        .find(header)
        .unwrap_or_else(|| panic!("the scene has no {header}"));
    let (head, tail) = SCENE.split_at(from);
    let old = tail.lines().find(|l| l.starts_with(line));
    let old = old.unwrap_or_else(|| panic!("the scene has no line {line:?} in {header}"));
    format!("{head}{}", tail.replacen(old, replacement, 1))
}

/// The two numbers differ by no more than `tolerance` of the larger one.
#[track_caller]
pub fn assert_close(what: &str, a: f64, b: f64, tolerance: f64) {
    let error = (a - b).abs() / a.abs().max(b.abs()).max(f64::MIN_POSITIVE);
    assert!(
        error <= tolerance,
        "{what}: {a:e} and {b:e} differ by {error:.3e}, more than {tolerance:.1e}"
    );
}

/// The two numbers differ by no more than `tolerance`, in their own unit.
#[track_caller]
pub fn assert_within(what: &str, a: f64, b: f64, tolerance: f64) {
    let error = (a - b).abs();
    assert!(
        error <= tolerance,
        "{what}: {a:e} and {b:e} differ by {error:.3e}, more than {tolerance:.1e}"
    );
}
