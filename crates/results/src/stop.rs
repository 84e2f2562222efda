//! Stopping early: on a signal, or when the wall time that a batch job has is used up.
//!
//! A signal (SIGINT, SIGTERM, SIGUSR1, as batch systems send before they kill, SIGHUP when a terminal closes) only
//! leaves a note; the run looks at it between two steps, never within one, so the state it saves is that of a
//! finished step. A second SIGINT ends the program at once.

use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context, ensure};
use comm::Communicator;
use rustix::process;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXFSZ};
use signal_hook::flag;

/// The signals that stop a run, with their names.
const SIGNALS: [(i32, &str); 4] = [
    (SIGINT, "SIGINT"),
    (SIGTERM, "SIGTERM"),
    (SIGUSR1, "SIGUSR1"),
    (SIGHUP, "SIGHUP"),
];
/// Exit code at a second SIGINT: 128 and its number, as a shell says it.
const INTERRUPTED: i32 = 130;
/// Steps of the longest duration so far that must still fit into the wall time: the next one, its writing, and the
/// closing of the files.
const RESERVE_STEPS: u32 = 3;

/// What may stop a run.
pub struct Stop {
    /// Number of the signal that came; 0 before.
    signal: Arc<AtomicUsize>,
    /// Start of the run and the time it has.
    wall: Option<(Instant, Duration)>,
    last_step: Instant,
    longest_step: Duration,
}

impl Stop {
    /// Listens to signals from now on. The wall time counts from `start`.
    pub fn listen(start: Instant, wall_time: Option<Duration>) -> anyhow::Result<Stop> {
        let signal = Arc::new(AtomicUsize::new(0));
        let interrupted = Arc::new(AtomicBool::new(false));
        // In this order: the first SIGINT finds the note unset, and sets it.
        flag::register_conditional_shutdown(SIGINT, INTERRUPTED, interrupted.clone())
            .and_then(|_| flag::register(SIGINT, interrupted))
            .context("cannot listen to signals")?;
        // A run under nohup goes on when its terminal closes.
        let heard = SIGNALS
            .iter()
            .filter(|(number, _)| *number != SIGHUP || !is_ignored(SIGHUP));
        for &(number, _) in heard {
            flag::register_usize(number, signal.clone(), number as usize)
                .context("cannot listen to signals")?;
        }
        Ok(Stop {
            signal,
            // Clocks differ: that of rank 0 counts.
            wall: wall_time
                .filter(|_| Communicator::world().is_root())
                .map(|time| (start, time)),
            last_step: Instant::now(),
            longest_step: Duration::ZERO,
        })
    }

    /// Listens where there are several points to stop between; a single one ends at once at a signal.
    pub fn of_points(n: usize, start: Instant, wall_time: Option<Duration>) -> anyhow::Result<Option<Stop>> {
        (n > 1).then(|| Stop::listen(start, wall_time)).transpose()
    }

    /// Called by all ranks between steps: why the run has to stop now, if it has to. What one rank knows stops all.
    pub fn reason(&mut self) -> Option<String> {
        let own = self.own_reason();
        let first = Communicator::world().first_text(own.clone());
        first.map(|(rank, reason)| own.unwrap_or_else(|| format!("{reason} on rank {rank}")))
    }

    fn own_reason(&mut self) -> Option<String> {
        self.longest_step = self.longest_step.max(self.last_step.elapsed());
        self.last_step = Instant::now();
        let number = self.signal.load(Ordering::Relaxed);
        if let Some((_, name)) = SIGNALS.iter().find(|(n, _)| *n as usize == number) {
            return Some(format!("{name} received"));
        }
        let (start, time) = self.wall?;
        let used = start.elapsed() + RESERVE_STEPS * self.longest_step;
        (used >= time).then(|| {
            format!(
                "--wall-time {} is used up but for what it takes to stop",
                hours_minutes_seconds(time)
            )
        })
    }
}

/// Whether this process was started to ignore a signal; the system shows such signals as bits from 1.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Lets a write beyond the limit on the size of files (`ulimit -f`) fail as one to a full disk does, with a message and
/// an exit code. Else the system would end this process without a word.
pub fn outlive_file_limit() -> anyhow::Result<()> {
    flag::register(SIGXFSZ, Arc::default()).context("cannot listen to signals")?;
    Ok(())
}

/// Lets this process end at once when its parent `pid` ends, however that ends: nobody would use its results.
pub fn end_with(pid: i32) -> anyhow::Result<()> {
    let ask = process::set_parent_process_death_signal(Some(process::Signal::KILL));
    ask.context("cannot ask to end with the parent")?;
    let parent = process::getppid().map(process::Pid::as_raw_nonzero);
    ensure!(
        parent.is_some_and(|parent| parent.get() == pid),
        "the process {pid} that started this one has ended"
    );
    Ok(())
}

/// This program as a child that ends with this process; its command is still to be said.
pub fn child() -> Command {
    let mut command = Command::new(std::env::current_exe().unwrap_or_else(|_| "raceway".into()));
    command.args(["--parent", &std::process::id().to_string()]);
    command
}

/// Gmsh as a child that ends with this process: this program, which becomes Gmsh.
pub fn gmsh() -> Command {
    let mut command = child();
    command.arg("gmsh");
    command
}

/// Reads hh:mm:ss, as batch systems write it.
pub fn parse_wall_time(text: &str) -> Result<Duration, String> {
    let error = || format!("{text:?} is no wall time; expected hours, minutes and seconds such as 23:55:00");
    let parts: Vec<&str> = text.split(':').collect();
    let number = |part: &str| {
        let digits = !part.is_empty() && part.len() <= 6 && part.bytes().all(|b| b.is_ascii_digit());
        digits
            .then(|| part.parse::<u64>().ok())
            .flatten()
            .ok_or_else(error)
    };
    let [hours, minutes, seconds] = parts[..] else {
        return Err(error());
    };
    let (hours, minutes, seconds) = (number(hours)?, number(minutes)?, number(seconds)?);
    if minutes > 59 || seconds > 59 {
        return Err(error());
    }
    Ok(Duration::from_secs(3600 * hours + 60 * minutes + seconds))
}

fn hours_minutes_seconds(time: Duration) -> String {
    let s = time.as_secs();
    format!("{:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a job would stop after another time than its batch system gives it.
    #[test]
    fn wall_times_are_those_of_batch_systems() {
        assert_eq!(parse_wall_time("01:02:03"), Ok(Duration::from_secs(3723)));
        assert_eq!(parse_wall_time("120:00:00"), Ok(Duration::from_secs(432_000)));
        for bad in [
            "90", "1:30", "1:60:00", "1:00:60", "-1:00:00", "a:00:00", "1:+1:00", ":00:00", "",
        ] {
            let text = parse_wall_time(bad).unwrap_err();
            assert!(
                text.starts_with(&format!("{bad:?} is no wall time; expected")),
                "{text}"
            );
        }
    }

    /// Wrong: a job would be killed in its last step, or would not use its time.
    #[test]
    fn the_wall_time_leaves_room_to_stop() {
        let start = Instant::now() - Duration::from_secs(95);
        let wall = |seconds| Stop {
            signal: Arc::default(),
            wall: Some((start, Duration::from_secs(seconds))),
            last_step: Instant::now() - Duration::from_secs(2),
            longest_step: Duration::ZERO,
        };
        assert_eq!(wall(110).reason(), None, "95 s and three steps of 2 s");
        let reason = wall(100).reason().unwrap();
        assert!(reason.starts_with("--wall-time 00:01:40 is used up"), "{reason}");
    }
}
