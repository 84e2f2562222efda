//! The forecast of memory against what the system measures, over sizes, element kinds and numbers of threads.

use mesh::{Arc, ElementKind, MshFormat, Overwrite, Snap};

use crate::util::{Dir, SCENE};

/// Largest relative difference of forecast and measured peak that is promised. Measured with two threads in step:
/// -7 to +5 %, with one thread -9 %; threads out of step use up to the difference to one thread less.
const TOLERANCE: f64 = 0.2;

/// The sections of the shipped meshes: 95 points, 72 quads; with the radius of the groove centres and the groove's, m.
const SECTIONS: [(&str, f64, f64); 2] = [
    ("meshes/7010c_inner.section.msh", 32.655e-3, 4.65e-3),
    ("meshes/7010c_outer.section.msh", 32.2685e-3, 4.75e-3),
];

/// A folder with the scene of the tests and both rings in `n_sectors` sectors.
pub fn rings(n_sectors: usize, kind: ElementKind) -> Dir {
    let dir = Dir::with_scene(SCENE);
    for ((path, centre_r, radius), name) in SECTIONS.into_iter().zip(["inner.msh", "outer.msh"]) {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let section = mesh::read_section(path, 1e-3).unwrap();
        let arc = Arc {
            centre_r,
            centre_z: 0.0,
            radius,
        };
        let snap = Snap {
            group: "raceway".to_string(),
            arc,
        };
        let ring = mesh::revolve(&section, n_sectors, kind, &[snap]).unwrap();
        mesh::write_msh(dir.path(name), &ring, 1e-3, MshFormat::Binary, Overwrite::Refuse).unwrap();
    }
    dir
}

/// Fails unless the forecast of a run is near its measured peak; returns the forecast, bytes.
#[track_caller]
fn assert_forecast(dir: &Dir, threads: &str) -> f64 {
    let out = format!("out_{threads}");
    let outcome = dir.raceway(&["run", "scene.toml", "--out", &out, "--threads", threads]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let summary: serde_json::Value = serde_json::from_str(&dir.text(&format!("{out}/summary.json"))).unwrap();
    let bytes = |key: &str| summary[key].as_f64().unwrap();
    let (forecast, measured) = (bytes("peak_memory_forecast_bytes"), bytes("peak_memory_bytes"));
    let difference = forecast / measured - 1.0;
    println!(
        "{} dofs, {threads} threads: forecast {:.0} MB, measured {:.0} MB, {:+.1} %",
        summary["dofs"]["inner"],
        forecast / 1e6,
        measured / 1e6,
        100.0 * difference
    );
    assert!(
        difference.abs() <= TOLERANCE,
        "{} dofs, {threads} threads: forecast {forecast} bytes, measured {measured}",
        summary["dofs"]["inner"]
    );
    forecast
}

/// If this failed, a job on a cluster would ask for the wrong memory: killed by the scheduler, or waiting for
/// a machine it does not need.
#[test]
fn the_forecast_of_memory_holds_over_sizes_and_elements() {
    for (n_sectors, kind) in [
        (72, ElementKind::Hex8),
        (198, ElementKind::Hex8),
        (540, ElementKind::Hex8),
        (54, ElementKind::Hex20),
    ] {
        assert_forecast(&rings(n_sectors, kind), "2");
    }
}

/// Wrong: a job for a motion would ask for too little memory and be killed, or for a machine it does not need.
/// Measured with `rings`, a file every step and at the ends only, 1 and 2 threads, 7 k to 376 k dofs a ring: -11 to
/// +11 %.
#[test]
fn check_forecasts_the_memory_of_motions_of_periodic_rings() {
    for (n_sectors, every) in [(198, "1"), (198, "1000"), (360, "1")] {
        let dir = rings(n_sectors, ElementKind::Hex8);
        let motion = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"\nledger_tolerance = 1e-3\n\n[speed]\ninner \
                      = \"1800 rpm\"";
        dir.write("scene.toml", SCENE.replace("[static]", motion));
        let set = format!("dynamic.output_every={every}");
        let options = ["scene.toml", "--threads", "2", "--set", &set];
        let checked = dir.raceway(&[&["check"], &options[..]].concat());
        assert_eq!(checked.code, Some(0), "{}", checked.stderr);
        let line = checked.stdout.lines().find(|l| l.starts_with("memory")).unwrap();
        let forecast: f64 = line.split_whitespace().nth(3).unwrap().parse().unwrap();
        let run = dir.raceway(&[&["run"], &options[..], &["--out", "out"]].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let summary: serde_json::Value = serde_json::from_str(&dir.text("out/summary.json")).unwrap();
        let measured = summary["peak_memory_bytes"].as_f64().unwrap() / 1e6;
        // The run knows what `check` has said.
        let own = summary["peak_memory_forecast_bytes"].as_f64().unwrap();
        assert_eq!(format!("{:.0}", own / 1e6), format!("{forecast:.0}"));
        println!("{n_sectors} sectors, files every {every}: {line}; measured {measured:.0} MB");
        assert!(
            (forecast / measured - 1.0).abs() <= 0.15,
            "{line}; measured {measured:.0} MB"
        );
    }
}

/// Wrong: a run with `[output.reduction]` would be killed for the memory of what it counts, a fifth to a half more, or
/// fill the disk with its states, a sixth more than was forecast.
#[test]
fn extremes_and_damage_are_part_of_the_forecasts() {
    let dir = rings(198, ElementKind::Hex8);
    let motion = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"20 us\"\nledger_tolerance = 1e-3\n\n[output.reduction]\n\n\
                  [output.reduction.damage]\nstress = \"von_mises\"\nexponent = 9.0\nreference_amplitude = \"100 \
                  MPa\"\nreference_cycles = 1e6\nnodes = \"all\"";
    dir.write("scene.toml", SCENE.replace("[static]", motion));
    for every in ["1", "1000"] {
        let set = format!("dynamic.output_every={every}");
        let options = ["scene.toml", "--threads", "2", "--json", "--set", &set];
        let json = |arguments: &[&str]| -> serde_json::Value {
            let outcome = dir.raceway(arguments);
            assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
            serde_json::from_str(&outcome.stdout).unwrap()
        };
        let checked = json(&[&["check"], &options[..]].concat());
        let ran = json(&[&["run"], &options[..], &["--out", every]].concat());
        let written: u64 = std::fs::read_dir(dir.path(every))
            .unwrap()
            .map(|entry| entry.unwrap().metadata().unwrap().len())
            .sum();
        let own = ran["summary"]["peak_memory_forecast_bytes"].as_f64();
        assert_eq!(checked["peak_memory_bytes"].as_f64(), own);
        let measured = ran["summary"]["peak_memory_bytes"].as_f64();
        for (what, forecast, measured, limit) in [
            ("memory", own, measured, TOLERANCE),
            (
                "disk",
                checked["output_bytes"].as_f64(),
                Some(written as f64),
                0.1,
            ),
        ] {
            let (forecast, measured) = (forecast.unwrap() / 1e6, measured.unwrap() / 1e6);
            println!("files every {every}: {what} {forecast:.1} MB, measured {measured:.1} MB");
            assert!(
                (forecast / measured - 1.0).abs() <= limit,
                "{what}: {forecast} for {measured} MB"
            );
        }
    }
}

/// Wrong: the same of rings with one sparse factor, which is made anew for a motion. Measured with free meshes of 45 k
/// to 414 k dofs and hex8 of 51 k, 1 and 2 threads: -9 to +17 %; the same run differs by up to 25 % on two threads.
#[test]
fn check_forecasts_the_memory_of_motions_with_sparse_factors() {
    let dir = rings(120, ElementKind::Hex8);
    let motion = "[dynamic]\nduration = \"0.1 ms\"\nstep = \"20 us\"\nledger_tolerance = 1e-3";
    dir.write("scene.toml", SCENE.replace("[static]", motion));
    let free = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/7010c_inner_tet10.msh");
    let free = format!("inner.mesh={:?}", free.to_str().unwrap());
    for (mesh, out) in [("inner.mesh=\"inner.msh\"", "equal"), (free.as_str(), "free")] {
        let options = [
            "scene.toml",
            "--threads",
            "1",
            "--set",
            "solver.backend=sparse",
            "--set",
            mesh,
        ];
        let checked = dir.raceway(&[&["check"], &options[..]].concat());
        assert_eq!(checked.code, Some(0), "{}", checked.stderr);
        let line = checked.stdout.lines().find(|l| l.starts_with("memory")).unwrap();
        assert!(line.contains("for the static start)"), "{line}");
        let forecast: f64 = line.split_whitespace().nth(3).unwrap().parse().unwrap();
        let run = dir.raceway(&[&["run"], &options[..], &["--out", out]].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let summary: serde_json::Value =
            serde_json::from_str(&dir.text(&format!("{out}/summary.json"))).unwrap();
        let megabytes = |key: &str| summary[key].as_f64().unwrap() / 1e6;
        let (own, measured) = (
            megabytes("peak_memory_forecast_bytes"),
            megabytes("peak_memory_bytes"),
        );
        println!("{mesh}: {line}; own forecast {own:.0} MB, measured {measured:.0} MB");
        assert!(
            (forecast / own - 1.0).abs() < 0.02,
            "{line}; the run says {own:.0} MB"
        );
        assert!(
            (forecast / measured - 1.0).abs() <= 0.3,
            "{line}; measured {measured:.0} MB"
        );
    }
}

/// If this failed, the forecast of a run on one core would count the rings' peaks together, although they follow
/// each other.
#[test]
fn one_thread_needs_less_memory_than_two() {
    let dir = rings(108, ElementKind::Hex8);
    let [one, two] = ["1", "2"].map(|threads| assert_forecast(&dir, threads));
    assert!(one < 0.95 * two, "one thread {one} bytes, two {two}");
}

/// If this failed, `raceway check` would promise another peak than the run itself forecasts.
#[test]
fn check_prints_the_forecast_of_the_run() {
    let dir = rings(36, ElementKind::Hex8);
    let checked = dir.raceway(&["check", "scene.toml", "--threads", "2"]);
    let run = dir.raceway(&["run", "scene.toml", "--out", "out", "--threads", "2"]);
    assert_eq!(
        (checked.code, run.code),
        (Some(0), Some(0)),
        "{}{}",
        checked.stderr,
        run.stderr
    );
    let summary: serde_json::Value = serde_json::from_str(&dir.text("out/summary.json")).unwrap();
    let forecast = summary["peak_memory_forecast_bytes"].as_f64().unwrap();
    let expected = format!("memory   peak about {:.0} MB with 2 threads", forecast / 1e6);
    assert!(
        checked.stdout.contains(&expected),
        "expected {expected:?} in {}",
        checked.stdout
    );
}

/// Wrong: a run that outgrows a limit of its memory would abort, which tells a user nothing, or spoil what it saved.
#[test]
fn a_run_short_of_memory_ends_with_a_message() {
    let dir = rings(360, ElementKind::Hex8);
    let motion =
        "[dynamic]\nduration = \"0.1 ms\"\nstep = \"20 us\"\noutput_every = 1\nledger_tolerance = 1e-3";
    dir.write("scene.toml", SCENE.replace("[static]", motion));
    let options = |backend: &str| format!("solver.backend={backend}");
    let cyclic = options("cyclic");
    dir.run("whole", &["--threads", "2", "--set", &cyclic]);
    let before = dir.snapshot();
    let outcome = dir.raceway_after(
        "ulimit -v 315000",
        &["resume", "whole", "--step", "2", "--threads", "2"],
    );
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(dir.raceway(&["info", "whole", "--verify"]).code == Some(0));
    let outcome = dir.raceway(&["resume", "whole", "--step", "2"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let step = std::path::Path::new("whole/step_000005.hdf");
    assert!(dir.snapshot()[step] == before[step]);
    let (mut forecast, mut ended, mut finished) = (0, 0, 0);
    // Between 400 and 480 MB the memory ends while HDF5, a library in C, writes a step.
    let limits = (400_000..480_000).step_by(8_000).map(|limit| ("cyclic", limit));
    // Products of matrices reserve address space of twice the last cache for each thread, hardly any of it used: with
    // 300 MB of cache a run finishes in 4 GB only.
    let wide = [
        330_000, 360_000, 480_000, 600_000, 2_000_000, 4_000_000, 16_000_000,
    ]
    .into_iter();
    for (backend, kilobytes) in wide
        .flat_map(|limit| [("cyclic", limit), ("sparse", limit)])
        .chain(limits)
    {
        let out = format!("{backend}_{kilobytes}");
        let run = [
            "run",
            "scene.toml",
            "--out",
            &out,
            "--threads",
            "2",
            "--set",
            &options(backend),
        ];
        let outcome = dir.raceway_after(&format!("ulimit -v {kilobytes}; export RUST_BACKTRACE=1"), &run);
        let last = outcome.stderr.lines().last().unwrap();
        assert!(
            !outcome.stderr.contains("panicked") && !outcome.stderr.contains("backtrace"),
            "{last}"
        );
        match outcome.code {
            Some(0) => finished += 1,
            Some(2) if last.starts_with("error: the run needs about ") => {
                let limit = format!(
                    "expected at most {} MB, the limit of the address space",
                    1024 * kilobytes / 1_000_000
                );
                assert!(
                    last.contains(&limit) && last.contains("use a coarser mesh"),
                    "{last}"
                );
                assert!(!dir.path(&out).exists());
                forecast += 1;
            }
            _ => {
                assert_eq!(outcome.code, Some(2), "{out}: {last}");
                assert!(last.starts_with("error: "), "{last}");
                ended += usize::from(last.starts_with("error: out of memory: "));
            }
        }
    }
    assert!(
        forecast > 0 && ended > 0 && finished > 2,
        "{forecast} {ended} {finished}"
    );
}

/// Wrong: a run over a short spall, whose grid is fine all round the ring, would need several times its forecast.
/// What is held while grids are made differs with the machine's threads; a quarter is what the forecast promises.
#[test]
fn the_forecast_counts_the_grids_of_real_surfaces() {
    let dir = Dir::with_meshes();
    let spall = "profiles.spall=[{ ring = \"outer\", azimuth = \"10 deg\", groove_angle = \"18 deg\", length = \"0.2 \
                 mm\", width = \"3 mm\", depth = \"50 um\", edge = \"0.02 mm\" }]";
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "out", "--set", spall]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let summary: serde_json::Value = serde_json::from_str(&dir.text("out/summary.json")).unwrap();
    let bytes = |key: &str| summary[key].as_f64().unwrap();
    let (forecast, measured) = (bytes("peak_memory_forecast_bytes"), bytes("peak_memory_bytes"));
    println!(
        "forecast {:.0} MB, measured {:.0} MB",
        forecast / 1e6,
        measured / 1e6
    );
    assert!(measured > 80e6, "the grid is too small to be seen: {measured}");
    assert!(
        (forecast / measured - 1.0).abs() <= 0.25,
        "{forecast} bytes, measured {measured}"
    );
}

/// Wrong: forces 5 % off and more would come without a word from a ring with an element or two a ball. 18 balls, whose
/// patches are two elements in semi-axis, a quadratic one counting twice.
#[test]
fn a_ring_of_too_few_elements_for_its_balls_is_named() {
    for (sectors, kind, few) in [
        (24, ElementKind::Hex8, Some((36, 108))),
        (36, ElementKind::Hex8, None),
        (18, ElementKind::Hex20, None),
    ] {
        let dir = rings(sectors, kind);
        let told = dir.raceway(&["check", "scene.toml"]);
        assert_eq!(told.code, Some(0), "{}", told.stderr);
        let lines = (told.stdout.lines()).filter(|line| line.contains("elements round its raceway"));
        let lines: Vec<&str> = lines.collect();
        assert_eq!(lines.len(), if few.is_some() { 2 } else { 0 }, "{}", told.stdout);
        let Some((least, better)) = few else { continue };
        for side in ["inner", "outer"] {
            let expected = format!(
                "mesh {side}.msh of the {side} ring has {sectors} elements round its raceway for 18 balls: the patch \
                 over which the force of a ball is spread reaches the next one, and forces may be off by more than 5 \
                 %; expected at least {least}, better {better}"
            );
            assert!(lines.iter().any(|line| line.contains(&expected)), "{lines:?}");
        }
    }
}

/// Wrong: a job for modes would ask for a third of the memory that their search takes, and be killed; one that has
/// several load cases to write while it solves, on one thread, for four fifths.
#[test]
fn check_forecasts_the_memory_of_modes_and_of_load_cases() {
    let turning = "[quasi_static]\nduration = \"0.2 ms\"\nstep = \"20 us\"\noutput_every = 5\n\n[speed]\ninner = \
                   \"1800 rpm\"";
    for (analysis, threads) in [
        ("[modes]\nnumber = 6\nbodies = [\"inner\", \"bearing\"]", "2"),
        ("[modes]\nnumber = 20\nbodies = [\"outer\"]", "2"),
        (turning, "1"),
        (turning, "2"),
    ] {
        let dir = rings(198, ElementKind::Hex8);
        dir.write("scene.toml", SCENE.replace("[static]", analysis));
        let json = |arguments: &[&str]| -> serde_json::Value {
            let outcome = dir.raceway(&[arguments, &["scene.toml", "--json", "--threads", threads]].concat());
            assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
            serde_json::from_str(&outcome.stdout).unwrap()
        };
        let forecast = json(&["check"])["peak_memory_bytes"].as_f64().unwrap() / 1e6;
        let measured = json(&["run", "--out", "out"])["summary"]["peak_memory_bytes"].as_f64();
        let measured = measured.unwrap() / 1e6;
        println!("{analysis}, {threads} threads: forecast {forecast:.0} MB, measured {measured:.0} MB");
        assert!(
            (forecast / measured - 1.0).abs() <= TOLERANCE,
            "{analysis}, {threads} threads: forecast {forecast:.0} MB, measured {measured:.0} MB"
        );
    }
}
