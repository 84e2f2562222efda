//! Studies as arrays of Slurm jobs, with a stand-in for Slurm.

use serde_json::Value;

use crate::signals::labelled;
use crate::study::inputs;
use crate::util::Dir;

/// Wrong: the jobs of an array would run other points than the study has, or nobody would make its tables.
#[test]
fn an_array_of_jobs_runs_every_point_and_one_more_makes_the_tables() {
    let dir = inputs();
    let jobs = array_of_jobs(&dir, 7);
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

/// Wrong: an array of jobs would leave signals without labels, or with those of other points.
#[test]
fn an_array_of_jobs_makes_the_labels_of_all_signals() {
    let dir = labelled();
    array_of_jobs(&dir, 4);
    let labels = dir.text("my out/labels.csv");
    let lines: Vec<&str> = labels.lines().collect();
    assert_eq!(
        lines[0],
        "point,file,length,seed,samples,samples_per_second,largest force [N]"
    );
    let expected = [("0.5", "1"), ("0.5", "2"), ("1", "1"), ("1", "2")];
    assert_eq!(lines.len(), 1 + expected.len());
    for (point, (line, (length, seed))) in lines[1..].iter().zip(expected).enumerate() {
        let start = format!("{point},signals/{point:04}.csv,{length},{seed},101,");
        assert!(line.starts_with(&start), "{line}");
        let signal = dir.text(&format!("my out/signals/{point:04}.csv"));
        assert_eq!(signal.lines().count(), 102);
    }
}

/// Runs the study of a folder by `slurm/study` as jobs of an array with so many points; what the jobs said.
fn array_of_jobs(dir: &Dir, n_points: usize) -> String {
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
    let array = format!("--array=0-{} --exclusive", n_points - 1);
    assert!(asked.contains(&array), "{asked}");
    assert!(asked.contains("--dependency=afterany:42"), "{asked}");
    dir.text("jobs.txt")
}
