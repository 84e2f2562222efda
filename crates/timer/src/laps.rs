//! The tree.

use crate::stopwatch::Stopwatch;

/// Between the names of a path.
const SEPARATOR: char = '/';

/// Named laps in the order of their first use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Laps(Vec<Lap>);

/// A lap and its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Lap {
    /// Its name among its neighbours.
    pub name: &'static str,
    /// Wall time, s, with that of its parts.
    pub seconds: f64,
    /// What of it is told apart; the rest has no name.
    pub parts: Laps,
}

impl Laps {
    /// Does some work and adds its time, see [`Laps::add`].
    pub fn time<T>(&mut self, path: &'static str, work: impl FnOnce() -> T) -> T {
        let mut clock = Stopwatch::start();
        let made = work();
        self.add(path, clock.lap());
        made
    }

    /// Adds seconds to a lap and to all that it is a part of.
    pub fn add(&mut self, path: &'static str, seconds: f64) {
        let mut laps = self;
        for name in path.split(SEPARATOR) {
            let lap = laps.lap(name);
            lap.seconds += seconds;
            laps = &mut lap.parts;
        }
    }

    /// Adds seconds to a lap alone: what it is a part of is measured as a whole.
    pub fn add_part(&mut self, path: &'static str, seconds: f64) {
        self.find(path).seconds += seconds;
    }

    /// Adds all laps of another tree.
    pub fn merge(&mut self, other: &Laps) {
        self.combine(other, |a, b| a + b);
    }

    /// Adds all laps of another tree as parts of a lap.
    pub fn merge_into(&mut self, path: &'static str, other: &Laps) {
        self.add(path, other.total());
        self.find(path).parts.merge(other);
    }

    /// The longer of each lap: of work that was done side by side.
    pub fn longest(mut self, other: &Laps) -> Laps {
        self.combine(other, f64::max);
        self
    }

    /// A lap, if it was ever run.
    pub fn get(&self, path: &str) -> Option<&Lap> {
        let (first, rest) = match path.split_once(SEPARATOR) {
            Some((first, rest)) => (first, Some(rest)),
            None => (path, None),
        };
        let lap = self.0.iter().find(|lap| lap.name == first)?;
        rest.map_or(Some(lap), |rest| lap.parts.get(rest))
    }

    /// Seconds of a lap; 0 of one that was never run.
    pub fn seconds(&self, path: &str) -> f64 {
        self.get(path).map_or(0.0, |lap| lap.seconds)
    }

    /// Seconds of all laps together.
    pub fn total(&self) -> f64 {
        self.iter().fold(0.0, |sum, lap| sum + lap.seconds)
    }

    /// The laps, without looking into their parts.
    pub fn iter(&self) -> std::slice::Iter<'_, Lap> {
        self.0.iter()
    }

    fn find(&mut self, path: &'static str) -> &mut Lap {
        match path.rsplit_once(SEPARATOR) {
            Some((whole, part)) => self.find(whole).parts.lap(part),
            None => self.lap(path),
        }
    }

    fn lap(&mut self, name: &'static str) -> &mut Lap {
        let known = self.0.iter().position(|lap| lap.name == name);
        let i = known.unwrap_or_else(|| {
            self.0.push(Lap {
                name,
                seconds: 0.0,
                parts: Laps::default(),
            });
            self.0.len() - 1
        });
        &mut self.0[i]
    }

    fn combine(&mut self, other: &Laps, both: fn(f64, f64) -> f64) {
        for theirs in other.iter() {
            let own = self.lap(theirs.name);
            own.seconds = both(own.seconds, theirs.seconds);
            own.parts.combine(&theirs.parts, both);
        }
    }
}
