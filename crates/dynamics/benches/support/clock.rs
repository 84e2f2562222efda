//! Clocks of the benchmarks: processor time of all threads and wall time, by part and run.

#![allow(dead_code)]

use timer::{Laps, Stopwatch};

/// Processor and wall time.
struct Clock {
    cpu: f64,
    wall: Stopwatch,
}

impl Clock {
    /// Starts now.
    fn start() -> Clock {
        Clock {
            cpu: cpu_seconds(),
            wall: Stopwatch::start(),
        }
    }

    /// Seconds [processor, wall] since the start.
    fn stop(mut self) -> [f64; 2] {
        [cpu_seconds() - self.cpu, self.wall.lap()]
    }
}

/// Laps of several runs, each in [processor, wall] time.
#[derive(Default)]
pub struct Runs {
    ended: Vec<[Laps; 2]>,
    current: [Laps; 2],
    /// Printed with the table.
    pub note: String,
}

impl Runs {
    /// Runs `work` as (a further piece of) a lap of the current run.
    pub fn time<T>(&mut self, path: &'static str, work: impl FnOnce() -> T) -> T {
        let clock = Clock::start();
        let result = work();
        let seconds = clock.stop();
        (0..2).for_each(|i| self.current[i].add(path, seconds[i]));
        result
    }

    /// Adds wall seconds to a part of a lap, whose processor time is not known.
    pub fn add_wall(&mut self, path: &'static str, seconds: f64) {
        self.current[1].add_part(path, seconds);
    }

    /// The next times belong to another run.
    pub fn end_run(&mut self) {
        self.ended.push(std::mem::take(&mut self.current));
    }

    /// Prints least and median seconds of every lap, parts below their whole.
    pub fn print(&self) {
        println!(
            "{:28} {:>9} {:>9} {:>9} {:>9}",
            "seconds", "cpu min", "median", "wall min", "median"
        );
        let mut all = Laps::default();
        self.ended.iter().for_each(|[_, wall]| all.merge(wall));
        self.print_laps(&all, "", "");
    }

    fn print_laps(&self, laps: &Laps, whole: &str, indent: &str) {
        for lap in laps.iter() {
            let path = format!("{whole}{}", lap.name);
            let [cpu, wall] = [0, 1].map(|i| match self.seconds(&path, i) {
                Some(seconds) => least_and_median(seconds).map(|x| format!("{x:.4}")),
                None => ["-", "-"].map(str::to_string),
            });
            println!(
                "{:28} {:>9} {:>9} {:>9} {:>9}",
                format!("{indent}{}", lap.name),
                cpu[0],
                cpu[1],
                wall[0],
                wall[1]
            );
            self.print_laps(&lap.parts, &format!("{path}/"), &format!("{indent}  "));
        }
    }

    /// Least seconds of some laps over those of others, [processor, wall].
    pub fn ratio(&self, above: &[&str], below: &[&str]) -> [f64; 2] {
        [0, 1].map(|i| self.least_sum(above, i) / self.least_sum(below, i))
    }

    /// Least seconds of a lap, [processor, wall].
    pub fn least(&self, path: &str) -> [f64; 2] {
        [0, 1].map(|i| self.least_sum(&[path], i))
    }

    /// Sum over the laps of their least seconds.
    fn least_sum(&self, paths: &[&str], i: usize) -> f64 {
        let known = paths.iter().filter_map(|path| self.seconds(path, i));
        known.map(|seconds| least_and_median(seconds)[0]).sum()
    }

    /// Seconds of a lap run by run; None if they are not known.
    fn seconds(&self, path: &str, i: usize) -> Option<Vec<f64>> {
        let runs = self.ended.iter().map(|run| &run[i]);
        runs.clone()
            .any(|laps| laps.get(path).is_some())
            .then(|| runs.map(|laps| laps.seconds(path)).collect())
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
        let mut clock = Stopwatch::start();
        work();
        seconds.push(clock.lap());
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
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}
