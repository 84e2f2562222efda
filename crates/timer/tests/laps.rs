//! The tree of laps.

use std::time::Duration;

use timer::{Laps, SharedLaps, Stopwatch};

const PAUSE: Duration = Duration::from_millis(5);

fn laps(of: &[(&'static str, f64)]) -> Laps {
    let mut laps = Laps::default();
    of.iter().for_each(|&(path, seconds)| laps.add(path, seconds));
    laps
}

fn names(laps: &Laps) -> Vec<&'static str> {
    laps.iter().map(|lap| lap.name).collect()
}

/// Wrong: a whole would be less than its parts, or count them twice. Binary fractions: exact.
#[test]
fn a_lap_includes_its_parts() {
    let laps = laps(&[("a/x", 1.0), ("b", 4.0), ("a/y", 0.5), ("a", 0.25), ("a/x", 2.0)]);
    assert_eq!(names(&laps), ["a", "b"], "in the order of first use");
    assert_eq!(laps.seconds("a"), 3.75);
    assert_eq!(laps.seconds("a/x"), 3.0);
    assert_eq!(laps.seconds("a/y"), 0.5);
    assert_eq!(laps.total(), 7.75);
}

/// Wrong: what was never run could not be told from what took no time.
#[test]
fn a_lap_of_no_time_is_there() {
    let laps = laps(&[("a/x", 0.0)]);
    assert_eq!(laps.get("a/x").map(|lap| lap.seconds), Some(0.0));
    for absent in ["x", "a/y", "a/x/y", ""] {
        assert_eq!(laps.get(absent), None);
        assert_eq!(laps.seconds(absent), 0.0);
    }
}

/// Wrong: the parts of a lap that is measured as a whole would be added to it.
#[test]
fn parts_of_a_whole_leave_it_as_it_is() {
    let mut laps = laps(&[("a", 4.0)]);
    laps.add_part("a/x", 1.0);
    laps.add_part("a/x/deep", 0.5);
    let found = ["a", "a/x", "a/x/deep"].map(|path| laps.seconds(path));
    assert_eq!(found, [4.0, 1.0, 0.5]);
}

/// Wrong: a run would lose laps of some of its steps, or of some of their parts.
#[test]
fn merging_adds_lap_by_lap() {
    let mut sum = laps(&[("a/x", 1.0), ("b", 2.0)]);
    sum.merge(&laps(&[("c", 8.0), ("a/y", 0.5), ("a/x", 0.25)]));
    let expected = laps(&[("a/x", 1.25), ("a/y", 0.5), ("b", 2.0), ("c", 8.0)]);
    assert_eq!(sum, expected);
    let mut whole = laps(&[("all/b", 1.0)]);
    whole.merge_into("all", &sum);
    assert_eq!(whole.seconds("all"), 12.75);
    assert_eq!(whole.seconds("all/b"), 3.0);
    assert_eq!(whole.seconds("all/a/y"), 0.5);
}

/// Wrong: two rings side by side would take the time of both one after the other, or a lap that one of them lacks
/// would be lost.
#[test]
fn side_by_side_the_longer_counts() {
    let [inner, outer] = [
        laps(&[("a/x", 1.0), ("b", 2.0)]),
        laps(&[("a/x", 3.0), ("b", 1.0), ("c", 0.5)]),
    ];
    let expected = laps(&[("a/x", 3.0), ("b", 2.0), ("c", 0.5)]);
    assert_eq!(inner.clone().longest(&outer), expected);
    assert_eq!(Laps::default().longest(&inner), inner);
}

/// Wrong: work would be charged to another lap, or its result be lost.
#[test]
fn work_is_timed() {
    let work = || {
        std::thread::sleep(PAUSE);
        7
    };
    let (mut own, shared) = (laps(&[("b", 1.0)]), SharedLaps::from(laps(&[("b", 1.0)])));
    assert_eq!([own.time("a/x", work), shared.time("a/x", work)], [7, 7]);
    for laps in [own, shared.laps()] {
        assert!(laps.seconds("a/x") >= PAUSE.as_secs_f64());
        assert_eq!(laps.seconds("a/x"), laps.seconds("a"));
        assert_eq!(laps.seconds("b"), 1.0);
    }
}

/// Wrong: threads that share laps would lose some.
#[test]
fn laps_of_several_threads_are_all_counted() {
    let shared = SharedLaps::default();
    std::thread::scope(|scope| {
        for name in ["a", "b", "a", "b"] {
            let shared = &shared;
            scope.spawn(move || shared.time(name, || std::thread::sleep(PAUSE)));
        }
    });
    let laps = shared.laps();
    for name in ["a", "b"] {
        assert!(laps.seconds(name) >= 2.0 * PAUSE.as_secs_f64(), "{laps:?}");
    }
}

/// Wrong: laps that follow each other would leave gaps or overlap.
#[test]
fn a_stopwatch_starts_again_at_each_lap() {
    let (mut whole, mut clock) = (Stopwatch::start(), Stopwatch::start());
    let mut sum = 0.0;
    for _ in 0..3 {
        std::thread::sleep(PAUSE);
        let seconds = clock.lap();
        assert!(seconds >= PAUSE.as_secs_f64());
        sum += seconds;
    }
    assert!(sum <= whole.lap());
}
