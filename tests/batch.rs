//! The batch scripts in `slurm/`, with a stand-in for Slurm that only takes notes; `scripts/test-slurm` runs real jobs.

use std::os::unix::fs::PermissionsExt;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::util::Dir;

/// A folder with a stand-in for the program, which does what `body` says, and one for Slurm, which refuses to requeue.
fn job(body: &str) -> Dir {
    let dir = Dir::empty();
    std::fs::create_dir(dir.path("bin")).unwrap();
    for (name, text) in [
        ("raceway", format!("#!/bin/bash\necho \"$@\" >> calls\n{body}\n")),
        (
            "bin/scontrol",
            "#!/bin/bash\necho \"$@\" >> requeued\nexit 1\n".to_string(),
        ),
    ] {
        dir.write(name, text);
        std::fs::set_permissions(dir.path(name), std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    dir
}

/// Starts `slurm/run.sbatch scene.toml out` as link number `link` of a chain.
fn start(dir: &Dir, link: usize) -> Child {
    start_with(dir, link, &[])
}

/// The same with more variables.
fn start_with(dir: &Dir, link: usize, variables: &[(&str, &str)]) -> Child {
    let root = env!("CARGO_MANIFEST_DIR");
    let mut command = Command::new("bash");
    for (name, _) in
        std::env::vars().filter(|(name, _)| name.starts_with("SLURM") || name.starts_with("RACEWAY"))
    {
        command.env_remove(name);
    }
    command
        .arg(format!("{root}/slurm/run.sbatch"))
        .args(["scene.toml", "out", "--set", "title=\"two words\""])
        .current_dir(dir.path(""))
        .env("RACEWAY_ROOT", root)
        .env("RACEWAY", dir.path("raceway"))
        .env(
            "PATH",
            format!("{}:{}", dir.path("bin").display(), std::env::var("PATH").unwrap()),
        )
        .env("SLURM_JOB_ID", "7")
        .env("SLURM_CPUS_PER_TASK", "3")
        .env("SLURM_RESTART_COUNT", link.to_string())
        .envs(variables.iter().copied())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Exit code and messages of the script at its end.
fn end(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

fn was_requeued(dir: &Dir) -> bool {
    dir.path("requeued").exists()
}

/// Wrong: a failed run would be queued for ever, or a run that was only stopped would be lost.
#[test]
fn only_a_run_that_stopped_early_is_queued_again() {
    for (code, requeued) in [(0, false), (2, false), (3, false), (137, false), (75, true)] {
        let dir = job(&format!("exit {code}"));
        let (ended, stderr) = end(start(&dir, 0));
        assert_eq!((ended, was_requeued(&dir)), (Some(code), requeued), "{stderr}");
        assert_eq!(
            dir.text("calls"),
            "--threads 3 run scene.toml --out out --set title=\"two words\"\n"
        );
        assert!(
            dir.text("out.links")
                .ends_with(&format!("end exit code {code} at step none\n"))
        );
    }
    let dir = job("exit 75");
    end(start(&dir, 0));
    assert_eq!(dir.text("requeued"), "requeue 7\n");
}

/// Wrong: a later link would begin again instead of going on, or go on from nothing.
#[test]
fn a_later_link_resumes_when_there_is_a_step() {
    let dir = job("exit 0");
    assert_eq!(end(start(&dir, 1)).0, Some(0));
    std::fs::create_dir(dir.path("out")).unwrap();
    for name in ["step_000008.hdf", "pack_000009_000041.hdf", "step_000010.hdf.tmp"] {
        dir.write(&format!("out/{name}"), "");
    }
    assert_eq!(end(start(&dir, 1)).0, Some(0));
    let calls = dir.text("calls");
    let (first, second) = calls.trim_end().split_once('\n').unwrap();
    assert!(first.contains(" run scene.toml "), "{first}");
    assert_eq!(second, "--threads 3 resume out");
    assert!(dir.text("out.links").contains("resume from step 41\n"));
}

/// Wrong: a motion of several bearings, whose steps lie in folders of their own, would begin again, be refused because
/// of its own results, and never end.
#[test]
fn a_later_link_resumes_a_list_of_bearings_from_the_step_that_all_have() {
    let dir = job("exit 0");
    for (name, steps) in [
        ("front", &[0, 8, 16][..]),
        ("rear", &[0, 8]),
        ("superseded_1", &[24]),
    ] {
        std::fs::create_dir_all(dir.path(&format!("out/{name}"))).unwrap();
        dir.write(&format!("out/{name}/mesh.hdf"), "");
        for step in steps {
            dir.write(&format!("out/{name}/step_{step:06}.hdf"), "");
        }
    }
    dir.write("out/scene.toml", "");
    assert_eq!(end(start(&dir, 1)).0, Some(0));
    assert_eq!(dir.text("calls"), "--threads 3 resume out\n");
    assert!(dir.text("out.links").contains("resume from step 8\n"));

    std::fs::remove_file(dir.path("out/rear/step_000000.hdf")).unwrap();
    std::fs::remove_file(dir.path("out/rear/step_000008.hdf")).unwrap();
    assert_eq!(end(start(&dir, 1)).0, Some(0));
    assert!(
        dir.text("calls").contains(" run scene.toml "),
        "no step that both have"
    );
}

/// Wrong: all threads of a rank that srun starts would share one core; the next job of a chain would lack memory or
/// quality of service, and be killed or refused.
#[test]
fn threads_and_resources_are_handed_on() {
    let dir = job("echo \"threads ${SRUN_CPUS_PER_TASK:-none}\" >> seen\nexit 75");
    for (name, text) in [
        ("bin/srun", "#!/bin/bash\nexec \"$@\"\n"),
        ("bin/launch", "#!/bin/bash\nexec \"$@\"\n"),
        ("bin/squeue", "#!/bin/bash\necho 1:00:00\n"),
        (
            "bin/sbatch",
            "#!/bin/bash\nprintf '%s\\n' \"$@\" >> submitted\necho 8\n",
        ),
        ("bin/scontrol", "#!/bin/bash\necho '   StdOut=/logs/my run.log'\n"),
    ] {
        dir.write(name, text);
        std::fs::set_permissions(dir.path(name), std::fs::Permissions::from_mode(0o755)).unwrap();
    }
    let given = [
        ("SLURM_NTASKS", "2"),
        ("SLURM_JOB_NAME", "raceway"),
        ("SLURM_MEM_PER_CPU", "2048"),
        ("SLURM_JOB_QOS", "long"),
        ("RACEWAY_CONTINUE", "chain"),
        ("RACEWAY_CHAIN_OPTIONS", "--signal=B:USR1@600 --nodes=1"),
    ];
    for (launcher, threads) in [("srun", "threads 3\n"), ("launch", "threads none\n")] {
        let variables: Vec<_> = given
            .into_iter()
            .chain([("RACEWAY_LAUNCHER", launcher)])
            .collect();
        let (code, stderr) = end(start_with(&dir, 0, &variables));
        assert_eq!((code, dir.text("seen").as_str()), (Some(0), threads), "{stderr}");
        std::fs::remove_file(dir.path("seen")).unwrap();
    }
    let submitted = dir.text("submitted");
    for option in [
        "--mem-per-cpu=2048",
        "--qos=long",
        "--output=/logs/my run.log",
        "--signal=B:USR1@600",
        "--nodes=1",
        "--time=1:00:00",
    ] {
        assert!(
            submitted.lines().any(|line| line == option),
            "{option}: {submitted}"
        );
    }
}

/// Wrong: the run would not hear that its time is over; a job that somebody cancels would come back.
#[test]
fn signals_reach_the_run_and_only_usr1_queues_it_again() {
    let waits = "trap 'exit 75' USR1 TERM\ntouch started\nfor i in {1..600}; do sleep 0.05; done";
    for (signal, requeued) in [("USR1", true), ("TERM", false)] {
        let dir = job(waits);
        let found = end_by(signal, &dir, start(&dir, 0));
        assert_eq!(found, (Some(75), requeued), "{signal}");
    }
}

/// Wrong: a launcher such as mpirun, which kills its ranks when it is told to end, would lose what they have computed
/// when a job is cancelled.
#[test]
fn a_launcher_is_told_to_stop_its_ranks_not_to_end() {
    let waits =
        "trap 'exit 75' USR1\ntrap 'exit 1' TERM\ntouch started\nfor i in {1..600}; do sleep 0.05; done";
    for (signal, requeued) in [("USR1", true), ("TERM", false)] {
        let dir = job(waits);
        let ranks = [("SLURM_NTASKS", "2"), ("RACEWAY_LAUNCHER", "bash")];
        let found = end_by(signal, &dir, start_with(&dir, 0, &ranks));
        assert_eq!(found, (Some(75), requeued), "{signal}");
        assert!(dir.text("out.links").contains(" ranks 2 "));
    }
}

/// Sends a signal to the script when its program has started. The script's exit code, and whether it queued the job
/// again.
fn end_by(signal: &str, dir: &Dir, child: Child) -> (Option<i32>, bool) {
    let begun = Instant::now();
    while !dir.path("started").exists() {
        assert!(
            begun.elapsed() < Duration::from_secs(20),
            "the program does not start"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
    let sent = Command::new("kill")
        .args(["-s", signal, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    let (code, _) = end(child);
    assert!(
        begun.elapsed() < Duration::from_secs(25),
        "{signal} did not arrive"
    );
    (code, was_requeued(dir))
}

/// Wrong: a job whose limit leaves no time for a step would be queued for ever.
#[test]
fn links_without_progress_are_not_followed_by_another() {
    let dir = job("exit 75");
    for link in [0, 1] {
        assert_eq!(end(start(&dir, link)).0, Some(75));
    }
    let (code, stderr) = end(start(&dir, 2));
    assert_eq!(code, Some(1));
    assert!(
        stderr.contains("2 links in a row did not get beyond step none; give them more time"),
        "{stderr}"
    );
    assert_eq!(dir.text("calls").lines().count(), 2);
    // A chain that a user submits anew may try again.
    assert_eq!(end(start(&dir, 0)).0, Some(75));
}

/// Wrong: a job would add its lines to the file that a link in the place of its log leads to.
#[test]
fn a_job_writes_through_no_link() {
    let dir = job("exit 0");
    dir.write("precious", "precious");
    std::os::unix::fs::symlink(dir.path("precious"), dir.path("out.links")).unwrap();
    let (code, said) = end(start(&dir, 0));
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("out.links is a link, and nothing is written through one; remove it"),
        "{said}"
    );
    assert_eq!(dir.text("precious"), "precious");
    assert!(!dir.path("calls").exists(), "the run was started");
}

/// Runs a script of `slurm/` with the stand-ins of a folder.
fn script(dir: &Dir, name: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let root = env!("CARGO_MANIFEST_DIR");
    let path = format!("{}:{}", dir.path("bin").display(), std::env::var("PATH").unwrap());
    let child = Command::new("bash")
        .arg(format!("{root}/slurm/{name}"))
        .args(arguments)
        .current_dir(dir.path(""))
        .env("RACEWAY", dir.path("raceway"))
        .env("PATH", path)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn();
    end(child.unwrap())
}

/// Wrong: numbers of one column would stand under the name of another, where a setting changes which columns there are.
#[test]
fn rows_of_jobs_with_other_columns_stand_below_their_names() {
    let dir = job("");
    std::fs::create_dir(dir.path("sweep")).unwrap();
    dir.write("sweep/sweep.txt", "scene=scene.toml\npoints=3\nper_job=1\n");
    dir.write("sweep/settings.txt", "a=1\nb=2\nc=3\n");
    for (part, table) in [
        (0, "step,force_n\n0,10.5\n1,11.5\n"),
        (1, "step,spin_rad_per_s,force_n\n0,7.25,12.5\n"),
        (2, "step,force_n\n0,13.5\n"),
    ] {
        std::fs::create_dir(dir.path(&format!("sweep/part_{part:05}"))).unwrap();
        dir.write(&format!("sweep/part_{part:05}/balls.csv"), table);
        dir.write(&format!("sweep/part_{part:05}.exit"), "0\n");
    }
    let (code, stderr) = script(&dir, "table", &["sweep"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert_eq!(
        dir.text("sweep/balls.csv"),
        "point,step,force_n,spin_rad_per_s\n0,0,10.5,\n0,1,11.5,\n1,0,12.5,7.25\n2,0,13.5,\n"
    );
}

/// Wrong: a site that asks for an account would run the points and refuse the job of their table.
#[test]
fn the_job_of_a_table_has_the_account_of_the_points() {
    let dir = job("");
    dir.write("scene.toml", "");
    dir.write("settings", "a=1\n");
    let refuses = "#!/bin/bash\n[[ \" $* \" == *\" --account=ours -p fast \"* ]] || exit 1\necho 5\n";
    dir.write("bin/sbatch", refuses);
    std::fs::set_permissions(dir.path("bin/sbatch"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let of_site = ["--", "--account=ours", "-p", "fast", "--time=1:00:00"];
    let sweep = ["scene.toml", "out", "--settings", "settings"];
    let (code, stderr) = script(&dir, "sweep", &[&sweep[..], &of_site].concat());
    assert_eq!(code, Some(0), "{stderr}");
    let study = ["scene.toml", "points"];
    let (code, stderr) = script(&dir, "study", &[&study[..], &of_site].concat());
    assert_eq!(code, Some(0), "{stderr}");
    // What is refused says so, and leaves the folder free.
    for _ in 0..2 {
        let (code, stderr) = script(&dir, "sweep", &["scene.toml", "other", "--settings", "settings"]);
        assert_eq!(code, Some(2));
        assert!(stderr.contains("sweep: sbatch refused the array"), "{stderr}");
    }
}

/// Wrong: a sweep whose time is over would wait in the queue to be resumed, which it cannot be.
#[test]
fn a_sweep_that_stopped_is_not_queued_again() {
    let dir = job("mkdir -p out\necho '  \"analysis\": \"sweep\",' > out/summary.json\nexit 75");
    let (code, stderr) = end(start(&dir, 0));
    assert_eq!((code, was_requeued(&dir)), (Some(75), false), "{stderr}");
    assert!(stderr.contains("with --points"), "{stderr}");
}
