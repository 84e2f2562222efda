//! Hard cases: what breaks contact dynamics, and what must hold there. `docs/dev/stability.md` is their page.
//!
//! Every case says why it is hard, what is set, and what must hold; it runs the crates of the program, or the program
//! itself. The fast ones are tests like others. `scripts/hard-cases` runs all and writes the page's tables and plots.

mod bars;
mod bearings;
mod classics;
mod clearances;
mod course;
mod edges;
mod extremes;
mod free_balls;
mod free_cage;
mod free_surfaces;
mod invariance;
mod loads;
mod meshes;
mod norm;
mod numbers;
mod page;
mod plot;
mod properties;
mod record;
mod rod;
mod speeds;
mod statics;
mod steps;
#[path = "../../crates/dynamics/tests/support/mod.rs"]
mod support;
mod surface_balls;
mod surface_spalls;
mod surface_waves;
mod surfaces;
mod swings;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use record::Record;

/// Whether a case belongs to the normal tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pace {
    Fast,
    Slow,
}

/// A hard case.
struct HardCase {
    /// Name, also of its plot.
    name: &'static str,
    pace: Pace,
    /// Why it is hard.
    why: &'static str,
    /// What is computed, with which settings.
    settings: &'static str,
    run: fn(&mut Record),
}

impl HardCase {
    fn new(
        name: &'static str,
        pace: Pace,
        why: &'static str,
        settings: &'static str,
        run: fn(&mut Record),
    ) -> HardCase {
        HardCase {
            name,
            pace,
            why,
            settings,
            run,
        }
    }
}

/// Cases that belong together.
struct Group {
    title: &'static str,
    cases: Vec<HardCase>,
}

fn groups() -> Vec<Group> {
    let group = |title, cases| Group { title, cases };
    vec![
        group("Classics", both(classics::cases(), bars::cases())),
        group(
            "Bearings",
            both(both(loads::cases(), clearances::cases()), speeds::cases()),
        ),
        group("Free balls and cage", free_balls::cases()),
        group("Real surfaces", both(surfaces::cases(), free_surfaces::cases())),
        group("Steps and integrators", steps::cases()),
        group(
            "Discretisation",
            both(both(meshes::cases(), edges::cases()), extremes::cases()),
        ),
        group("Statics", statics::cases()),
        group("Numbers", both(invariance::cases(), numbers::cases())),
        group("Random bearings", properties::cases()),
    ]
}

/// One list after the other.
fn both(mut first: Vec<HardCase>, second: Vec<HardCase>) -> Vec<HardCase> {
    first.extend(second);
    first
}

/// A case that was run.
struct Finished {
    case: HardCase,
    record: Record,
}

/// Runs the cases that are wanted, each on one thread, and gives them in their order. `threads` run at a time.
fn run(wanted: impl Fn(&HardCase) -> bool, threads: usize) -> Vec<Finished> {
    let all = groups().into_iter().flat_map(|group| group.cases);
    let cases: Vec<HardCase> = all.filter(|case| wanted(case)).collect();
    let next = AtomicUsize::new(0);
    let records: Vec<Mutex<Record>> = cases.iter().map(|_| Mutex::default()).collect();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(i) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|i| *i < cases.len()) {
                    *records[i].lock().unwrap() = run_one(&cases[i]);
                }
            });
        }
    });
    let records = records.into_iter().map(|r| r.into_inner().unwrap());
    let finished = cases.into_iter().zip(records);
    finished.map(|(case, record)| Finished { case, record }).collect()
}

fn run_one(case: &HardCase) -> Record {
    let clock = std::time::Instant::now();
    let mut record = Record::default();
    let ended = catch_unwind(AssertUnwindSafe(|| (case.run)(&mut record)));
    record.that("it ends without a panic", ended.is_ok());
    let verdict = if record.failures().is_empty() {
        "ok"
    } else {
        "FAILED"
    };
    println!(
        "{} {verdict}, {:.2} s: {record}",
        case.name,
        clock.elapsed().as_secs_f64()
    );
    record
}

#[track_caller]
fn assert_all_hold(finished: &[Finished]) {
    let failures: Vec<String> = finished
        .iter()
        .flat_map(|f| {
            f.record
                .failures()
                .into_iter()
                .map(|text| format!("{}: {text}", f.case.name))
        })
        .collect();
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

/// If this failed, a hard case would not be stable any more: its line says which and what did not hold.
#[test]
fn the_fast_hard_cases_hold() {
    let only = std::env::var("HARD_CASES_ONLY").unwrap_or_default();
    let finished = run(|case| case.pace == Pace::Fast && case.name.contains(&only), 1);
    assert_all_hold(&finished);
}

/// If this failed, the same of all cases. `HARD_CASES_PAGE` is the folder whose `stability.md` gets tables and plots.
#[test]
#[ignore = "takes minutes: scripts/hard-cases runs it"]
fn all_hard_cases_hold() {
    let only = std::env::var("HARD_CASES_ONLY").unwrap_or_default();
    let finished = run(|case| only.split(',').any(|part| case.name.contains(part)), 2);
    println!("{} cases", finished.len());
    if let Some(folder) = std::env::var_os("HARD_CASES_PAGE") {
        page::write(Path::new(&folder), &groups(), &finished);
    }
    assert_all_hold(&finished);
}

/// If this failed, two cases would share a line of the page or a plot.
#[test]
fn hard_cases_have_names_of_their_own() {
    let mut names: Vec<&str> = groups()
        .iter()
        .flat_map(|g| g.cases.iter().map(|c| c.name))
        .collect();
    let n = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), n, "a name stands twice");
    assert!(n >= 60, "{n} cases");
}

/// If this failed, the page would state another number of cases than `scripts/hard-cases` runs, or lack one. The number
/// stands in its text and below its tables, and every case has a line of its own.
#[test]
fn the_page_counts_the_cases_that_are_run() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/dev/stability.md");
    let page = std::fs::read_to_string(page).unwrap();
    let groups = groups();
    let names: Vec<&str> = groups
        .iter()
        .flat_map(|group| group.cases.iter().map(|case| case.name))
        .collect();
    let n = names.len();
    assert!(
        page.contains(&format!("\nAll {n} cases hold in the run below")),
        "{n}"
    );
    assert!(page.contains(&format!("\n\n{n} cases.\n")), "{n}");
    for name in names {
        assert!(page.contains(&format!("\n| {name} | ")), "{name} has no line");
    }
}
