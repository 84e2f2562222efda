//! Runs that are killed, stopped, or whose disk is full: what was committed is whole, and the run goes on from it.

use std::io::{BufRead, BufReader, Read};
use std::path::PathBuf;
use std::process::{Child, Command};
use std::time::Duration;

use checkpoint::{committed_steps, read_step, step_file_name};

use crate::readers::python;
use crate::several_interruption::assert_same_stamps;
use crate::util::Outcome;
use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::tables::summary;

/// Environment variable with the number of kills, when it shall not be [`KILLS`].
const MANY: &str = "RACEWAY_TEST_KILLS";
const KILLS: usize = 15;

/// Pseudo-random numbers 0 to 1: xorshift (Marsaglia 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub fn signal(child: &Child, name: &str) {
    let kill = Command::new("kill")
        .args([&format!("-{name}"), &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
}

/// Waits until the run takes steps or ends; returns the rest of its messages.
pub fn wait_for_steps(child: &mut Child) -> impl Read + use<> {
    let mut lines = BufReader::new(child.stderr.take().unwrap());
    let mut line = "the start".to_string();
    // Progress is "[time] done/all what", with the number of the step when it takes steps.
    while !(line.starts_with('[') && line.contains(" step ")) {
        line.clear();
        if lines.read_line(&mut line).unwrap() == 0 {
            break;
        }
    }
    lines
}

pub fn outcome_of(mut child: Child, mut messages: impl Read) -> Outcome {
    let mut stderr = String::new();
    messages.read_to_string(&mut stderr).unwrap();
    Outcome {
        code: child.wait().unwrap().code(),
        stdout: String::new(),
        stderr,
    }
}

/// VTK opens every step file, with finite displacements at all its points.
#[track_caller]
fn assert_vtk_reads(python: &str, files: &[PathBuf]) {
    const READ: &str = "
import sys, vtk
from vtk.util.numpy_support import vtk_to_numpy
for name in sys.argv[1:]:
    reader = vtk.vtkHDFReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    moved = vtk_to_numpy(grid.GetPointData().GetArray('displacement'))
    assert len(moved) == grid.GetNumberOfPoints() > 0 and abs(moved).max() < 1, name
";
    let output = Command::new(python)
        .args(["-c", READ])
        .args(files)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// Wrong: a kill at some instant would leave a half step under a final name, lose committed steps or rows, or keep the
/// run from going on to the same bits.
#[test]
fn a_killed_run_goes_on_from_whole_steps() {
    let kills = std::env::var(MANY).map_or(KILLS, |n| n.parse().unwrap());
    let dir = small_motion();
    dir.run("whole", &[]);
    let mut files = Vec::new();
    let (mut random, mut done, mut survived) = (Random(0x9e37_79b9_7f4a_7c15), 0, 0);
    for round in 0.. {
        let out = format!("cut{round}");
        let mut arguments = vec!["run", "scene.toml", "--out", &out];
        while done < kills {
            let mut child = dir.start(&arguments);
            let lines = wait_for_steps(&mut child);
            // Half of the runs are hit while they write and step, the others also at their end.
            std::thread::sleep(Duration::from_secs_f64(0.5 * random.next() * random.next()));
            if child.try_wait().unwrap().is_some() {
                drop(lines);
                survived += 1;
                break;
            }
            signal(&child, "KILL");
            child.wait().unwrap();
            done += 1;
            let folder = dir.path(&out);
            let steps = committed_steps(&folder).unwrap();
            for step in &steps {
                read_step(&folder.join(step_file_name(*step))).unwrap();
            }
            // VTK takes a second to start: it reads a copy of all that kills have left, at the end.
            let left = format!("left{done}");
            copy(&dir, &out, &left);
            files.extend(
                steps
                    .iter()
                    .map(|step| dir.path(&left).join(step_file_name(*step))),
            );
            arguments = vec!["resume", &out];
            if committed_steps(&folder).unwrap().is_empty() {
                // Killed before its first step was committed: nothing to go on from.
                break;
            }
        }
        let outcome = dir.raceway(&["resume", &out]);
        if !outcome.stderr.contains("holds no committed step") {
            assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
            assert_same_run(&dir, "whole", &out);
        }
        if done >= kills {
            break;
        }
    }
    if let Some(python) = python() {
        assert_vtk_reads(&python, &files);
    }
    println!("{done} kills, {survived} runs ended before theirs");
}

/// Wrong: a batch system that warns before it kills would get no checkpoint, an unfinished step, or a run that cannot
/// go on to the same bits; the exit code tells scripts that there is more to do.
#[test]
fn a_signal_stops_between_steps() {
    let dir = small_motion();
    let slow = [
        "--set",
        "dynamic.duration=2 s",
        "--set",
        "dynamic.output_every=100000",
    ];
    let signals = [("TERM", "term"), ("USR1", "usr1"), ("INT", "int"), ("HUP", "hup")];
    // What these tests ignore, as under nohup, their children ignore as well.
    for (name, out) in signals
        .into_iter()
        .filter(|(name, _)| *name != "HUP" || !hangup_is_ignored())
    {
        let mut child = dir.start(&[&["run", "scene.toml", "--out", out], &slow[..]].concat());
        let lines = wait_for_steps(&mut child);
        signal(&child, name);
        let outcome = outcome_of(child, lines);
        assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
        let step = *committed_steps(&dir.path(out)).unwrap().last().unwrap();
        let said = format!("stopped: SIG{name} received; the state after step {step} of 100000");
        assert!(
            outcome.stderr.contains(&said) && outcome.stderr.contains(&format!("raceway resume {out}")),
            "{}",
            outcome.stderr
        );
        let status = summary(&dir, out)["status"].as_str().unwrap().to_string();
        assert!(
            status.starts_with(&format!("stopped: SIG{name} received")),
            "{status}"
        );
        // The longer of the two ends 5 steps later.
        let duration = format!("dynamic.duration={} us", 20 * (step + 5));
        let to = ["--set", &duration, "--set", "dynamic.output_every=1"];
        assert_eq!(dir.raceway(&[&["resume", out], &to[..]].concat()).code, Some(0));
        let whole = format!("{out}_whole");
        let sparse = [
            "--set",
            &duration,
            "--set",
            &format!("dynamic.output_every={}", step + 5),
        ];
        dir.run(&whole, &sparse);
        assert_same_run(&dir, &whole, out);
    }
}

/// Wrong: each stop would leave rows between those that `output.tables_every` and `output_every` ask for, so that
/// spectra refuse the run, and later steps tell of other tables.
#[test]
fn rows_that_only_stops_add_are_gone_after_them() {
    let dir = small_motion();
    let profile = "[probes.profile.down]\nring = \"inner\"\nazimuth = \"0 deg\"\ngroove_angle = \"25 deg\"\n\
                   depth = [\"0 mm\", \"0.2 mm\"]\npoints = 3\n";
    let motion = dir.text("scene.toml") + profile;
    let equilibria = "[quasi_static]\nduration = \"1 ms\"\nstep = \"20 us\"\n[speed]";
    let (head, tail) = motion.split_once("[dynamic]").unwrap();
    let (_, tail) = tail.split_once("[speed]").unwrap();
    dir.write("dynamic.toml", &motion);
    dir.write("quasi_static.toml", format!("{head}{equilibria}{tail}"));
    for key in ["dynamic", "quasi_static"] {
        let (scene, cut) = (format!("{key}.toml"), format!("{key}_cut"));
        let endless = [
            format!("{key}.duration=2 s"),
            format!("{key}.output_every=100000"),
        ];
        let every = "output.tables_every=7";
        let mut arguments = vec!["run", &scene, "--out", &cut, "--set", every];
        endless.iter().for_each(|set| arguments.extend(["--set", set]));
        for arguments in [&arguments[..], &["resume", &cut]] {
            let mut child = dir.start(arguments);
            let lines = wait_for_steps(&mut child);
            signal(&child, "TERM");
            let outcome = outcome_of(child, lines);
            assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
        }
        let last = committed_steps(&dir.path(&cut)).unwrap().last().unwrap() + 9;
        let duration = format!("{key}.duration={} us", 20 * last);
        let resumed = dir.raceway(&["resume", &cut, "--set", &duration]);
        assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
        let (whole, at_end) = (format!("{key}_whole"), format!("{key}.output_every={last}"));
        let run = [
            "run", &scene, "--out", &whole, "--set", every, "--set", &duration, "--set", &at_end,
        ];
        assert_eq!(dir.raceway(&run).code, Some(0));
        assert_same_run(&dir, &whole, &cut);
        assert_same_stamps(&dir, &whole, &cut);
    }
}

/// Wrong: a job would be killed by its batch system, or its run could not be chained. The time is used up at once, so
/// the state is the start: the first step is taken by the resumed run.
#[test]
fn the_wall_time_stops_a_run_that_can_go_on() {
    let dir = small_motion();
    dir.run("whole", &[]);
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "cut", "--wall-time", "00:00:00"]);
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    assert!(
        outcome
            .stderr
            .contains("stopped: --wall-time 00:00:00 is used up"),
        "{}",
        outcome.stderr
    );
    assert_eq!(committed_steps(&dir.path("cut")).unwrap(), [0]);
    let outcome = dir.raceway(&["resume", "cut", "--wall-time", "01:00:00"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_same_run(&dir, "whole", "cut");
}

/// Wrong: a full disk would end a run without its reason, take committed steps with it, or leave what cannot go on. A
/// limit on the size of files stands for the full disk; it is a table, which grows, that meets it.
#[test]
fn a_full_disk_costs_nothing_that_was_committed() {
    let dir = small_motion();
    dir.run("whole", &[]);
    let step = std::fs::metadata(dir.path("whole/step_000000.hdf"))
        .unwrap()
        .len();
    let table = std::fs::metadata(dir.path("whole/balls.csv")).unwrap().len();
    let mesh = std::fs::metadata(dir.path("whole/mesh.hdf")).unwrap().len();
    // No step fits.
    let limit = (step.max(mesh) / 1024).saturating_sub(2) as u32;
    let outcome = dir.raceway_with_small_files(limit, &["run", "scene.toml", "--out", "none"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("File too large"), "{}", outcome.stderr);
    assert!(committed_steps(&dir.path("none")).unwrap().is_empty());
    // Steps fit, the table of a longer run does not.
    let n_steps = 20 * (2 * step.max(mesh) / table + 1);
    let longer = format!("dynamic.duration={} us", 20 * n_steps);
    let sparse = ["--set", longer.as_str(), "--set", "dynamic.output_every=10"];
    let limit = (step.max(mesh) / 1024 + 8) as u32;
    let run = |out| [&["run", "scene.toml", "--out", out], &sparse[..]].concat();
    let outcome = dir.raceway_with_small_files(limit, &run("cut"));
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("cannot write balls.csv of the results")
            && outcome.stderr.contains("File too large"),
        "{}",
        outcome.stderr
    );
    let steps = committed_steps(&dir.path("cut")).unwrap();
    assert!(steps.len() > 2, "{steps:?}");
    for step in steps {
        read_step(&dir.path(&format!("cut/{}", step_file_name(step)))).unwrap();
    }
    let outcome = dir.raceway(&["resume", "cut"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    dir.run("long", &sparse);
    assert_same_run(&dir, "long", "cut");
}

/// Wrong: a run would fill the disk and fail at its end, or `check` would promise another size than the run has.
#[test]
fn a_run_that_cannot_fit_the_disk_does_not_start() {
    let dir = small_motion();
    let endless = ["--set", "dynamic.duration=2000 s"];
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &endless[..]].concat());
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    for part in [
        "the results need about ",
        " TB (100000001 step files of ",
        " free",
        "--ignore-disk-space",
    ] {
        assert!(outcome.stderr.contains(part), "{} lacks {part}", outcome.stderr);
    }
    assert!(!dir.path("out").exists());
    let told = ["--ignore-disk-space", "--wall-time", "00:00:00"];
    let outcome = dir.raceway(&[&["run", "scene.toml", "--out", "out"], &endless[..], &told[..]].concat());
    assert_eq!(outcome.code, Some(75), "{}", outcome.stderr);
    assert!(
        outcome.stderr.contains("going on because of --ignore-disk-space"),
        "{}",
        outcome.stderr
    );
}

/// Wrong: the forecast of the output would not be its size.
#[test]
fn the_forecast_of_the_output_is_its_size() {
    let dir = small_motion();
    for (choice, out) in [("f32", "single"), ("f64", "double")] {
        let precision = format!("output.precision={choice}");
        dir.run(out, &["--set", &precision]);
        let said = dir.raceway(&["check", "scene.toml", "--set", &precision]).stdout;
        let line = said.lines().find(|line| line.starts_with("output")).unwrap();
        let megabytes: Vec<f64> = line
            .split(" MB")
            .filter_map(|part| part.rsplit(' ').next()?.parse().ok())
            .collect();
        let size = |name: &str| {
            std::fs::metadata(dir.path(&format!("{out}/{name}")))
                .unwrap()
                .len() as f64
                / 1e6
        };
        let step = line
            .split(" kB per")
            .next()
            .and_then(|part| part.rsplit(' ').next()?.parse::<f64>().ok());
        let forecast = step.map_or_else(|| megabytes[0], |kilobytes| kilobytes / 1e3);
        crate::util::assert_close(line, forecast, size("step_000007.hdf"), 0.05);
        let names = ["balls.csv", "shaft.csv", "energy.csv"];
        let all = 21.0 * size("step_000007.hdf") + names.iter().map(|name| size(name)).sum::<f64>();
        let total = line
            .split(" MB in all")
            .next()
            .and_then(|part| part.rsplit(' ').next()?.parse::<f64>().ok());
        crate::util::assert_close(line, total.unwrap(), all, 0.05);
    }
}

/// Wrong: a job that failed before its first step would be stuck: nothing to resume, and a folder that no run may use.
#[test]
fn a_run_that_ended_before_its_first_step_is_started_again() {
    let dir = small_motion();
    dir.run("whole", &[]);
    let size = |name: &str| {
        std::fs::metadata(dir.path(&format!("whole/{name}")))
            .unwrap()
            .len()
    };
    assert!(
        size("step_000000.hdf") > size("mesh.hdf"),
        "the mesh must fit where the step does not"
    );
    let limit = (size("step_000000.hdf") / 1024) as u32;
    let run = ["run", "scene.toml", "--out", "out"];
    let outcome = dir.raceway_with_small_files(limit, &run);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(dir.path("out/balls.csv").exists() && committed_steps(&dir.path("out")).unwrap().is_empty());
    let outcome = dir.raceway(&["resume", "out"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let said = "out holds no committed step: the run ended before its first one; \
                start it again with raceway run SCENE --out out";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    let outcome = dir.raceway(&run);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let said = "note: the run in out ended before its first step; it is started anew";
    assert!(outcome.stderr.contains(said), "{}", outcome.stderr);
    assert_same_run(&dir, "whole", "out");
    assert!(!dir.path("out/.raceway.starting").exists());
}

/// Wrong: a run under nohup would end when its terminal closes.
#[test]
fn a_run_that_ignores_a_closed_terminal_goes_on() {
    let dir = small_motion();
    let slow = [
        "--set",
        "dynamic.duration=2 s",
        "--set",
        "dynamic.output_every=100000",
    ];
    let arguments = [&["run", "scene.toml", "--out", "out"], &slow[..]].concat();
    let mut command = dir.shell("trap '' HUP", &arguments);
    let mut child = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
    let lines = wait_for_steps(&mut child);
    signal(&child, "HUP");
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it ended");
    signal(&child, "TERM");
    let outcome = outcome_of(child, lines);
    assert!(
        outcome.stderr.contains("stopped: SIGTERM received"),
        "{}",
        outcome.stderr
    );
}

/// Whether this process ignores SIGHUP, bit 0 of the mask that the system shows.
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & 1 == 1)
}

/// Wrong: under a small limit of the address space the program would abort, which tells a user nothing.
#[test]
fn too_little_address_space_is_an_error() {
    let dir = small_motion();
    for kilobytes in [100_000, 250_000] {
        let outcome = dir.raceway_after(
            &format!("ulimit -v {kilobytes}"),
            &["run", "scene.toml", "--out", "out"],
        );
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        let said = "error: the address space of this process is limited to ";
        assert!(
            outcome.stderr.starts_with(said) && outcome.stderr.contains("expected at least 320 MB"),
            "{}",
            outcome.stderr
        );
        assert!(!dir.path("out").exists());
    }
}
