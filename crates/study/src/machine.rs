//! The machine that a study runs on: what it is, and how busy others keep it.
//!
//! The time of all processors comes from `/proc/stat`. What was busy during a run, less what the run used itself, is
//! the load of others, this study's other jobs among them. Other loads share caches, memory and turbo clocks, so a
//! timing is called disturbed from a small part of one processor on. Where the system does not tell, a run is
//! disturbed when it waited for a processor.

use std::time::Duration;

/// Share of one processor that others may use during an undisturbed run.
const OTHERS: f64 = 0.15;
/// Seconds by which `/proc/stat` may be off: it counts in ticks of 10 ms, on every processor.
const TICKS: f64 = 0.02;
/// A run of one thread that takes this much longer than its processor time has waited.
const WAITED: f64 = 1.3;

/// Name of the processor, and how many there are.
pub fn describe() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info
        .lines()
        .find_map(|l| l.strip_prefix("model name"))
        .and_then(|l| l.split_once(':'))
        .map_or("unknown processor", |(_, name)| name.trim());
    format!("{} x {name}", cores())
}

/// Number of processors this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get())
}

/// Today, UTC, as 2026-11-21.
pub fn date() -> String {
    let now = jiff::Timestamp::now().to_string();
    now.split('T').next().unwrap_or_default().to_string()
}

/// Seconds that all processors have been busy since the system started; `None` where it does not tell.
pub fn busy() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/stat").ok()?;
    parse_busy(&text).map(|ticks| ticks / rustix::param::clock_ticks_per_second() as f64)
}

/// Busy ticks: user, nice, system, irq and softirq of the first line. Stolen time is of other machines: busy as well.
fn parse_busy(text: &str) -> Option<f64> {
    let line = text.lines().next()?.strip_prefix("cpu ")?;
    let ticks: Vec<f64> = line.split_whitespace().map_while(|t| t.parse().ok()).collect();
    [0, 1, 2, 5, 6, 7]
        .iter()
        .map(|&i| ticks.get(i).copied())
        .sum::<Option<f64>>()
}

/// Why the timing of a run is not its own, if so. `busy` is what all processors worked during it, s, if known.
pub fn disturbance(wall: Duration, cpu: Duration, busy: Option<f64>, threads: usize) -> Option<String> {
    let (wall, cpu) = (wall.as_secs_f64(), cpu.as_secs_f64());
    let Some(busy) = busy else {
        let waited = threads == 1 && wall > WAITED * cpu + TICKS;
        return waited.then(|| format!("waited: {wall:.2} s for {cpu:.2} s of work"));
    };
    let others = (busy - cpu - TICKS * cores() as f64).max(0.0) / wall.max(f64::MIN_POSITIVE);
    (others > OTHERS).then(|| format!("others used {others:.1} of {} processors", cores()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a timing beside other programs would pass as the price of a setting.
    #[test]
    fn a_run_beside_others_is_disturbed() {
        let seconds = Duration::from_secs_f64;
        let alone = disturbance(seconds(2.0), seconds(1.9), Some(2.0), 1);
        assert_eq!(alone, None);
        let beside = disturbance(seconds(2.0), seconds(1.9), Some(3.95), 1).unwrap();
        assert!(
            beside.starts_with("others used 1.0 of") || beside.starts_with("others used 0.9 of"),
            "{beside}"
        );
        assert_eq!(disturbance(seconds(2.0), seconds(1.9), None, 1), None);
        let waited = disturbance(seconds(4.0), seconds(1.9), None, 1).unwrap();
        assert_eq!(waited, "waited: 4.00 s for 1.90 s of work");
    }

    /// Wrong: idle processors would count as busy.
    #[test]
    fn waiting_and_idling_is_not_busy() {
        let text = "cpu  100 1 20 5000 300 2 3 4 50 60\ncpu0 1 2 3\n";
        assert_eq!(parse_busy(text), Some(130.0));
        assert_eq!(parse_busy("intr 5"), None);
    }
}
