//! The clock of the benchmarks: the shortest of several runs, in processor time where that is the same thing.

#![allow(dead_code)]

use std::time::Instant;

/// Shortest of several runs, ms, and the last result. On one thread of Linux it is the processor time of all threads of
/// this process, which other programs disturb less than the clock on the wall.
pub fn best<T>(runs: usize, mut run: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let (start, busy) = (Instant::now(), processor_time());
        let result = run();
        let wall = start.elapsed().as_secs_f64();
        let time = match (busy, processor_time()) {
            (Some(busy), Some(now)) if rayon::current_num_threads() == 1 => now - busy,
            _ => wall,
        };
        (1e3 * time, result)
    };
    let (mut shortest, mut last) = timed();
    for _ in 1..runs {
        let (time, result) = timed();
        (shortest, last) = (shortest.min(time), result);
    }
    (shortest, last)
}

/// Seconds that the threads of this process have run, from Linux' scheduler statistics.
fn processor_time() -> Option<f64> {
    // The kernel brings a thread's statistics up to date when it gives way.
    std::thread::yield_now();
    let mut nanoseconds = 0;
    for task in std::fs::read_dir("/proc/self/task").ok()? {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(1e-9 * nanoseconds as f64)
}

/// Seconds of one run.
#[derive(Clone, Copy, Debug)]
pub struct Time {
    /// Of all threads of this process together.
    pub cpu: f64,
    /// On the wall.
    pub wall: f64,
}

/// The least processor time and the least wall time of several runs, and the last result.
pub fn least<T>(runs: usize, mut run: impl FnMut() -> T) -> (Time, T) {
    let mut timed = || {
        let (wall, cpu) = (Instant::now(), processor_time().unwrap_or(f64::NAN));
        let result = run();
        let time = Time {
            cpu: processor_time().unwrap_or(f64::NAN) - cpu,
            wall: wall.elapsed().as_secs_f64(),
        };
        (time, result)
    };
    let (mut least, mut last) = timed();
    for _ in 1..runs {
        let (time, result) = timed();
        least = Time {
            cpu: least.cpu.min(time.cpu),
            wall: least.wall.min(time.wall),
        };
        last = result;
    }
    (least, last)
}
