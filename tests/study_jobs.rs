//! Studies as arrays of Slurm jobs, with a stand-in for Slurm.

use serde_json::Value;

use crate::study::inputs;

/// Wrong: the jobs of an array would run other points than the study has, or nobody would make its tables.
#[test]
fn an_array_of_jobs_runs_every_point_and_one_more_makes_the_tables() {
    let dir = inputs();
    // Stands for Slurm: runs what it is given, a task after the other, and prints the number of a job.
    let sbatch = "echo \"$@\" >> sbatch.txt\n\
        for a in \"$@\"; do\n\
            case \"$a\" in --array=0-*) last=${a#--array=0-} ;; --wrap=*) run=${a#--wrap=} ;; esac\n\
        done\n\
        for i in $(seq 0 \"${last:-0}\"); do SLURM_ARRAY_TASK_ID=$i bash -c \"$run\" >> jobs.txt 2>&1; done\n\
        echo 42\n";
    let path = dir.program("sbatch", sbatch);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/slurm/study");
    let output = std::process::Command::new(script)
        .args(["study.toml", "my out", "--", "--exclusive"])
        .current_dir(dir.path("."))
        .env("PATH", path)
        .env("RACEWAY", env!("CARGO_BIN_EXE_raceway"))
        .output()
        .unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said.trim(), "array 42, tables 42", "{}", dir.text("jobs.txt"));
    let asked = dir.text("sbatch.txt");
    assert!(asked.contains("--array=0-6 --exclusive"), "{asked}");
    assert!(asked.contains("--dependency=afterany:42"), "{asked}");
    let jobs = dir.text("jobs.txt");
    for point in 0..7 {
        assert_eq!(
            jobs.matches(&format!("point {point}: scheme")).count(),
            1,
            "{jobs}"
        );
    }
    let json: Value = serde_json::from_str(&dir.text("my out/study.json")).unwrap();
    assert!(
        json["points"]
            .as_array()
            .unwrap()
            .iter()
            .all(|p| p["status"] == "finished"),
        "{json}"
    );
}
