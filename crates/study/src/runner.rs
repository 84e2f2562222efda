//! Runs the points of a study: each a child process of this program in a folder of its own, so that its time and
//! memory are its own.
//!
//! A folder `points/NNNN` holds `run` (the results), `log.txt` and, once the point came to an end, `point.json`. A
//! point with a record is not run again; one without starts anew. A lock in the folder keeps two processes, such as
//! the tasks of a Slurm array, from running the same point. A second one belongs to the run, which ends a moment
//! after a study that was killed: the next study waits for it.

use std::fs::{File, TryLockError};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};
use checkpoint::open_lock;
use comm::print;
use results::failure::Failure;
use results::stop::{Stop, child, gmsh};
use results::whole::make_folder;
use scene::{MeshFiles, Scene};
use signal_hook::consts::{SIGINT, SIGTERM};
use wait4::Wait4;

use super::early::require_readable;
use super::format::Meshes;
use super::machine;
use super::plan::{Plan, Point, arguments};
use super::record::{self, Cost, LOG, RUN, Record};

/// How often the lock of a study is tried: a child that is not yet this program has it for a moment.
const STUDY_TRIES: usize = 5;
/// How often that of a run is tried: one that was killed may have memory to free and files to close.
const RUN_TRIES: usize = 1200;
/// How long to wait between.
const LOCK_WAIT: Duration = Duration::from_millis(100);
/// Exit code of a run that was asked to stop.
const STOPPED: i32 = 75;

/// Runs these points, `jobs` at a time. Stops between points when a signal came, and after the first that finishes if
/// it has not what the study reads, unless an earlier one `is_read`.
pub fn run(plan: &Plan, points: &[Point], (out, is_read): (&Path, bool), jobs: usize) -> Result<(), Failure> {
    let stop = Mutex::new(Stop::listen(Instant::now(), None)?);
    let next = AtomicUsize::new(0);
    let is_read = AtomicBool::new(is_read);
    let first_failure: Mutex<Option<Failure>> = Mutex::new(None);
    let work = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some(point) = points.get(i) else { return };
            let reason = stop.lock().unwrap_or_else(PoisonError::into_inner).reason();
            let result = match reason {
                Some(reason) => Err(Failure::Stopped(anyhow!(
                    "{reason} after {i} of {} points; the same command goes on",
                    points.len()
                ))),
                None => run_point(plan, point, out).and_then(|end| match end {
                    PointEnd::Finished if !is_read.swap(true, Ordering::Relaxed) => {
                        require_readable(plan, point.index, out)
                    }
                    _ => Ok(()),
                }),
            };
            if let Err(failure) = result {
                next.store(points.len(), Ordering::Relaxed);
                let mut first = first_failure.lock().unwrap_or_else(PoisonError::into_inner);
                first.get_or_insert(failure);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(work);
        }
    });
    let failure = first_failure.into_inner().unwrap_or_else(PoisonError::into_inner);
    failure.map_or(Ok(()), Err)
}

/// What became of a point.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PointEnd {
    Finished,
    /// Its run failed, or is another process's.
    WithoutResults,
}

/// Runs one point and records what became of it. A failed run is a result; an error is one of the study itself.
fn run_point(plan: &Plan, point: &Point, out: &Path) -> Result<PointEnd, Failure> {
    let dir = record::folder(out, point.index);
    dir.parent().map_or(Ok(()), make_folder)?;
    make_folder(&dir)?;
    let Some(_study) = take_lock(&dir.join(".lock"), STUDY_TRIES)? else {
        print::note(format_args!(
            "point {} is being run by another process",
            point.index
        ));
        return Ok(PointEnd::WithoutResults);
    };
    let lock = take_lock(&dir.join(".run.lock"), RUN_TRIES)?.with_context(|| {
        let folder = dir.display();
        format!("the run in {folder} has not ended, although its study has; kill it, then the same command goes on")
    })?;
    print::note(format_args!("point {}: {}", point.index, plan.name(point)));
    let set = arguments(&point.set, out);
    let built = match plan.meshes {
        Meshes::Build => build_meshes(plan, &set, out),
        Meshes::Given => Ok(()),
    };
    let mut record = Record {
        index: point.index,
        name: plan.name(point),
        set: point.set.clone(),
        scene: plan.whole_scene(&set)?,
        files: record::files(plan, &set)?,
        threads: plan.threads,
        program: record::program(),
        failure: built.err().map(|failure| failure.text()),
        costs: Vec::new(),
    };
    for repeat in 0..plan.repeats {
        if record.failure.is_some() {
            break;
        }
        match run_once(plan, &set, (&dir, &lock), repeat)? {
            Ok(cost) => record.costs.push(cost),
            Err(reason) => {
                // The folder of the study may be moved.
                record.failure = Some(reason.replace(&format!("{}/", out.display()), ""));
                record.costs.clear();
            }
        }
    }
    if let Some(reason) = &record.failure {
        print::note(format_args!("point {} failed: {reason}", point.index));
    }
    record::write(&record, out)?;
    Ok(match record.failure {
        None => PointEnd::Finished,
        Some(_) => PointEnd::WithoutResults,
    })
}

/// Takes the lock `path`; nothing if somebody has it all the time that is tried.
fn take_lock(path: &Path, tries: usize) -> Result<Option<File>, Failure> {
    let lock = open_lock(path)?;
    for _ in 0..tries {
        match lock.try_lock() {
            Ok(()) => return Ok(Some(lock)),
            Err(TryLockError::WouldBlock) => std::thread::sleep(LOCK_WAIT),
            Err(TryLockError::Error(e)) => {
                return Err(anyhow!(e)
                    .context(format!("cannot lock {}", path.display()))
                    .into());
            }
        }
    }
    Ok(None)
}

/// Builds the meshes of a point that are missing; one process at a time.
fn build_meshes(plan: &Plan, set: &[String], out: &Path) -> Result<(), Failure> {
    let scene = Scene::parse(&plan.scene_text, &plan.scene, set, MeshFiles::MayBeMissing)?;
    let path = out.join(".meshes.lock");
    let lock = open_lock(&path)?;
    lock.lock()
        .with_context(|| format!("cannot lock {}", path.display()))?;
    Ok(scene::build_missing(&scene, &gmsh)?)
}

/// Runs the program once: the cost, or why there are no results. Results of repeats are not kept: they are the same.
/// The run has its lock as its input, so that the folder stays locked as long as it writes, and ends with this process.
fn run_once(
    plan: &Plan,
    set: &[String],
    (dir, lock): (&Path, &File),
    repeat: usize,
) -> Result<Result<Cost, String>, Failure> {
    let out = dir.join(if repeat == 0 { RUN } else { "repeat" });
    if out.exists() {
        std::fs::remove_dir_all(&out).with_context(|| format!("cannot remove {}", out.display()))?;
    }
    let log_path = dir.join(LOG);
    // The log of an earlier try goes, also a link; it is gone if there was none.
    let _ = std::fs::remove_file(&log_path);
    let log = File::create_new(&log_path).with_context(|| format!("cannot write {}", log_path.display()))?;
    let mut command = child();
    command
        .args(["--threads", &plan.threads.to_string(), "run"])
        .arg(&plan.scene)
        .arg("--out")
        .arg(&out)
        .args(set.iter().flat_map(|s| ["--set", s]))
        .stdin(lock.try_clone().context("cannot share a lock")?)
        .stdout(log.try_clone().context("cannot write a log")?)
        .stderr(log);
    let (start, busy) = (Instant::now(), machine::busy());
    let used = command
        .spawn()
        .and_then(Wait4::wait4)
        .context("cannot run this program")?;
    let wall = start.elapsed();
    let busy = machine::busy().zip(busy).map(|(after, before)| after - before);
    if !used.status.success() {
        let by_signal = matches!(used.status.signal(), Some(SIGINT | SIGTERM));
        if by_signal || used.status.code() == Some(STOPPED) {
            return Err(Failure::Stopped(anyhow!(
                "the run in {} was stopped; the same command goes on",
                dir.display()
            )));
        }
        return Ok(Err(reason(&log_path, used.status)));
    }
    let cpu = used.rusage.utime + used.rusage.stime;
    let cost = Cost {
        wall_s: wall.as_secs_f64(),
        cpu_s: cpu.as_secs_f64(),
        peak_memory_bytes: used.rusage.maxrss,
        bytes_written: size(&out).with_context(|| format!("cannot read {}", out.display()))?,
        disturbed: machine::disturbance(wall, cpu, busy, plan.threads),
    };
    if repeat > 0 {
        std::fs::remove_dir_all(&out).with_context(|| format!("cannot remove {}", out.display()))?;
    }
    Ok(Ok(cost))
}

/// The error that a failed run printed, or how it ended.
fn reason(log: &Path, status: std::process::ExitStatus) -> String {
    let text = std::fs::read_to_string(log).unwrap_or_default();
    match text.find("error: ") {
        Some(start) => text[start + "error: ".len()..].trim_end().to_string(),
        None => format!("the run ended without a message ({status}); see {LOG}"),
    }
}

/// Bytes of all files below a folder.
fn size(dir: &Path) -> std::io::Result<u64> {
    let mut sum = 0;
    for entry in std::fs::read_dir(dir)? {
        let entry = entry?;
        let data = entry.metadata()?;
        sum += if data.is_dir() {
            size(&entry.path())?
        } else {
            data.len()
        };
    }
    Ok(sum)
}
