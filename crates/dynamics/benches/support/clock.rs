//! Clocks of the benchmarks: processor time of all threads and wall time, by part and run.

#![allow(dead_code)]

use std::time::Instant;

/// A stopwatch.
pub struct Lap {
    cpu: f64,
    wall: Instant,
}

impl Lap {
    /// Starts now.
    pub fn start() -> Lap {
        Lap {
            cpu: cpu_seconds(),
            wall: Instant::now(),
        }
    }

    /// Seconds [processor, wall] since the start.
    pub fn stop(&self) -> [f64; 2] {
        [cpu_seconds() - self.cpu, self.wall.elapsed().as_secs_f64()]
    }
}

/// Seconds of named parts, run by run.
#[derive(Default)]
pub struct Laps {
    /// Parts in the order of their first use, with [processor, wall] of each run; the last entry is the current run.
    parts: Vec<(String, Vec<[f64; 2]>)>,
    n_runs: usize,
    /// Printed with the table.
    pub note: String,
}

impl Laps {
    /// Runs `work` as (a further piece of) a part of the current run.
    pub fn time<T>(&mut self, part: &str, work: impl FnOnce() -> T) -> T {
        let lap = Lap::start();
        let result = work();
        self.add(part, lap.stop());
        result
    }

    /// Adds seconds [processor, wall] to a part of the current run.
    pub fn add(&mut self, part: &str, seconds: [f64; 2]) {
        let index = self
            .parts
            .iter()
            .position(|(name, _)| name == part)
            .unwrap_or_else(|| {
                self.parts.push((part.to_string(), Vec::new()));
                self.parts.len() - 1
            });
        let runs = &mut self.parts[index].1;
        runs.resize(self.n_runs + 1, [0.0; 2]);
        (0..2).for_each(|i| runs[self.n_runs][i] += seconds[i]);
    }

    /// Adds wall seconds to a part whose processor time is not known.
    pub fn add_wall(&mut self, part: &str, seconds: f64) {
        self.add(part, [f64::NAN, seconds]);
    }

    /// The next times belong to another run.
    pub fn end_run(&mut self) {
        self.n_runs += 1;
    }

    /// Prints least and median seconds of every part.
    pub fn print(&self) {
        println!(
            "{:28} {:>9} {:>9} {:>9} {:>9}",
            "seconds", "cpu min", "median", "wall min", "median"
        );
        for (name, runs) in &self.parts {
            let [cpu, wall] = [0, 1].map(|i| least_and_median(runs.iter().map(|r| r[i]).collect()));
            let cell = |x: f64| {
                if x.is_nan() {
                    "-".to_string()
                } else {
                    format!("{x:.4}")
                }
            };
            println!(
                "{name:28} {:>9} {:>9} {:>9} {:>9}",
                cell(cpu[0]),
                cell(cpu[1]),
                cell(wall[0]),
                cell(wall[1])
            );
        }
    }

    /// Least seconds of some parts over those of others, [processor, wall].
    pub fn ratio(&self, above: &[&str], below: &[&str]) -> [f64; 2] {
        [0, 1].map(|i| self.least_sum(above, i) / self.least_sum(below, i))
    }

    /// Least seconds of a part, [processor, wall].
    pub fn least(&self, part: &str) -> [f64; 2] {
        [0, 1].map(|i| self.least_sum(&[part], i))
    }

    /// Sum over the parts of their least seconds.
    fn least_sum(&self, names: &[&str], i: usize) -> f64 {
        let chosen = self
            .parts
            .iter()
            .filter(|(name, _)| names.contains(&name.as_str()));
        chosen
            .map(|(_, runs)| least_and_median(runs.iter().map(|r| r[i]).collect())[0])
            .sum()
    }
}

fn least_and_median(mut values: Vec<f64>) -> [f64; 2] {
    values.sort_by(f64::total_cmp);
    [values[0], values[values.len() / 2]]
}

/// Least wall seconds of several runs.
pub fn least_wall(n_runs: usize, mut work: impl FnMut()) -> f64 {
    let mut seconds: Vec<f64> = Vec::new();
    for _ in 0..n_runs {
        let start = Instant::now();
        work();
        seconds.push(start.elapsed().as_secs_f64());
    }
    least_and_median(seconds)[0]
}

/// Bytes per second of reading an array of `bytes` bytes.
pub fn read_bandwidth(bytes: usize) -> f64 {
    let array = vec![1.0_f64; bytes / 8];
    let seconds = least_wall(10, || {
        let mut sums = [0.0; 32];
        for chunk in array.chunks_exact(32) {
            sums.iter_mut().zip(chunk).for_each(|(sum, value)| *sum += value);
        }
        std::hint::black_box(sums);
    });
    bytes as f64 / seconds
}

/// Processor seconds of all threads of this process so far; wall time where the system does not tell.
fn cpu_seconds() -> f64 {
    let threads = std::fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    let nanoseconds: f64 = threads
        .filter_map(|thread| std::fs::read_to_string(thread.path().join("schedstat")).ok())
        .filter_map(|text| text.split_whitespace().next()?.parse::<f64>().ok())
        .sum();
    if nanoseconds > 0.0 {
        1e-9 * nanoseconds
    } else {
        since_start()
    }
}

/// Wall seconds since the first call.
fn since_start() -> f64 {
    static START: std::sync::LazyLock<Instant> = std::sync::LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}
