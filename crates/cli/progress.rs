//! Progress of a run: a bar on a terminal, plain lines in a batch log.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use comm::{Communicator, print};
use indicatif::{ProgressBar, ProgressStyle};

/// Shows what a run is doing and how far it is.
pub struct Progress {
    bar: Option<ProgressBar>,
    start: Instant,
    total: u64,
    done: u64,
}

impl Progress {
    /// Progress over `total` equal parts.
    pub fn new(total: u64) -> Progress {
        let has_bar = std::io::stderr().is_terminal() && !print::manner().is_quiet;
        let bar = (Communicator::world().is_root() && has_bar).then(|| {
            let bar = ProgressBar::new(total);
            let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.enable_steady_tick(Duration::from_millis(200));
            bar
        });
        Progress {
            bar,
            start: Instant::now(),
            total,
            done: 0,
        }
    }

    /// `done` parts were finished before this run.
    pub fn start_at(&mut self, done: u64) {
        self.done = done;
        if let Some(bar) = &self.bar {
            bar.set_position(done);
        }
    }

    /// Says what is done now.
    pub fn stage(&self, text: &str) {
        let line = format!(
            "[{:8.2} s] {}/{} {text}",
            self.start.elapsed().as_secs_f64(),
            self.done,
            self.total
        );
        match &self.bar {
            Some(bar) => {
                bar.set_message(text.to_string());
                print::log(format_args!("{line}"));
            }
            None => print::note(format_args!("{line}")),
        }
    }

    /// A warning that stays.
    pub fn warn(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| print::note(format_args!("warning: {text}"))),
            None => print::note(format_args!("warning: {text}")),
        }
    }

    /// One part is finished.
    pub fn advance(&mut self) {
        self.done += 1;
        if let Some(bar) = &self.bar {
            bar.inc(1);
        }
    }

    /// Clears the bar.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
