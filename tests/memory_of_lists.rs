//! The forecast of memory of lists of bearings against what the system measures, at rest and over time.

use mesh::ElementKind;

use crate::memory::rings;
use crate::several::{parts, succeeds};
use crate::util::Dir;

/// Largest relative difference of forecast and measured peak that is promised, as for one bearing. Measured: -6 to
/// +10 % at rest, +3 to +9 % in motion, two and four bearings of 13 k to 68 k nodes, 1 and 2 threads. On a busy machine
/// two threads make fewer rings at a time, and the peak can be a fifth less: half as much more is allowed there.
const TOLERANCE: f64 = 0.2;

/// Back to back, one bearing or pair after the other, on a beam.
fn list(n_sectors: usize, n_bearings: usize, analysis: &str) -> Dir {
    let dir = rings(n_sectors, ElementKind::Hex8);
    std::fs::create_dir_all(dir.path("types")).unwrap();
    for mesh in ["inner.msh", "outer.msh"] {
        std::fs::rename(dir.path(mesh), dir.path(&format!("types/{mesh}"))).unwrap();
    }
    dir.write("types/kind.toml", &parts()[0]);
    let mut text = String::new();
    for i in 0..n_bearings {
        let orientation = if i % 2 == 0 { "+z" } else { "-z" };
        text += &format!(
            "[[bearing]]\nname = \"b{i}\"\nposition = \"{} mm\"\norientation = \"{orientation}\"\n\
             type = \"types/kind.toml\"\n\n",
            60 + 40 * i
        );
    }
    text += &format!(
        "[pairing]\noffset = \"20 um\"\n\n[shaft]\nmodel = \"beam\"\nmaterial = {{ young_modulus = \"207 GPa\", \
         poisson_ratio = 0.3, density = \"7800 kg/m3\" }}\n\n[[shaft.section]]\nfrom = \"0 mm\"\nto = \"300 mm\"\n\
         outside = \"50 mm\"\nbore = \"20 mm\"\n\n[[shaft.load]]\nposition = \"0 mm\"\n\
         force = [\"300 N\", \"0 N\", \"200 N\"]\n\n{analysis}\n"
    );
    dir.write("list.toml", text);
    dir
}

/// Forecast of `check` and measured peak of a run of a scene, MB.
fn forecast_and_peak(dir: &Dir, scene: &str, threads: &str) -> [f64; 2] {
    let checked = succeeds(dir, &["check", scene, "--threads", threads]).stdout;
    let line = checked.lines().find(|line| line.starts_with("memory")).unwrap();
    let forecast: f64 = line.split_whitespace().nth(3).unwrap().parse().unwrap();
    let out = format!("out_{threads}");
    succeeds(dir, &["run", scene, "--out", &out, "--threads", threads]);
    let summary: serde_json::Value = serde_json::from_str(&dir.text(&format!("{out}/summary.json"))).unwrap();
    [forecast, summary["peak_memory_bytes"].as_f64().unwrap() / 1e6]
}

#[track_caller]
fn assert_forecast(what: &str, dir: &Dir, threads: &str) {
    let [forecast, measured] = forecast_and_peak(dir, "list.toml", threads);
    let difference = forecast / measured - 1.0;
    println!(
        "{what}, {threads} threads: forecast {forecast:.0} MB, measured {measured:.0} MB, {:+.1} %",
        100.0 * difference
    );
    assert!(
        (-TOLERANCE..=1.5 * TOLERANCE).contains(&difference),
        "{what}, {threads} threads: forecast {forecast:.0} MB, measured {measured:.0} MB"
    );
}

const MOTION: &str = "[speed]\ninner = \"1800 rpm\"\n\n[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"\n\
                      ledger_tolerance = 1e-3\n";
const TURNING: &str = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"0.1 ms\"\n\
                       step = \"20 us\"\noutput_every = 1000\n";

/// Wrong: a job for a list at rest would ask for too little memory, as if all bearings were one.
#[test]
fn the_forecast_of_memory_holds_for_lists_at_rest() {
    for (sectors, bearings, threads) in [
        (72, 2, "2"),
        (198, 2, "1"),
        (198, 2, "2"),
        (198, 4, "2"),
        (360, 2, "2"),
    ] {
        assert_forecast(
            &format!("{bearings} of {sectors} sectors"),
            &list(sectors, bearings, "[static]"),
            threads,
        );
    }
    assert_forecast("2 that turn without inertia", &list(198, 2, TURNING), "2");
}

/// Wrong: the same in motion, where each bearing holds a state and a queue of steps, and all share their factors.
#[test]
fn the_forecast_of_memory_holds_for_lists_in_motion() {
    for (sectors, bearings, threads) in [(198, 2, "1"), (198, 2, "2"), (198, 4, "2"), (360, 2, "2")] {
        let what = format!("{bearings} of {sectors} sectors in motion");
        let motion = format!("{MOTION}output_every = 1000\n");
        assert_forecast(&what, &list(sectors, bearings, &motion), threads);
    }
    // Files at every step wait for the disk, two for each bearing, or do not: of 176 MB 120 to 152 are taken.
    let often = list(198, 2, &format!("{MOTION}output_every = 1\n"));
    let [forecast, measured] = forecast_and_peak(&often, "list.toml", "2");
    println!("files at every step: forecast {forecast:.0} MB, measured {measured:.0} MB");
    assert!(
        measured < (1.0 + TOLERANCE) * forecast && forecast < 1.6 * measured,
        "{forecast} {measured}"
    );
}
