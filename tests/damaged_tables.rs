//! Tables that are not what the run wrote: nothing goes on with them, shows them or counts in them without saying so.

use std::sync::OnceLock;

use crate::util::lockstep::{assert_same_run, copy, small_motion};
use crate::util::{Dir, Files, RIGID, SCENE};

/// A folder with the small motion run to its end as `whole`, without a summary that says so; once for all tests.
fn moved() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        dir.run("whole", &[]);
        dir.snapshot()
    }))
}

/// What may happen to a table of 18 balls: what it is, and the table after it.
fn damages(table: &str) -> Vec<(&'static str, String)> {
    let mut lines: Vec<&str> = table.lines().collect();
    let cell = |line: usize, column: usize, text: &str| {
        let mut lines: Vec<String> = table.lines().map(str::to_string).collect();
        let mut cells: Vec<&str> = lines[line].split(',').collect();
        cells[column] = text;
        lines[line] = cells.join(",");
        lines.join("\n") + "\n"
    };
    let mut found = vec![
        ("a cell nan", cell(40, 4, "nan")),
        ("a cell abc", cell(40, 4, "abc")),
        ("another number", cell(40, 4, "1.0")),
        ("ball -1", cell(40, 2, "-1")),
        ("time that goes backwards", cell(40, 1, "-1.0")),
    ];
    let mut bytes = table.as_bytes().to_vec();
    bytes[12_000..12_512].fill(0);
    found.push(("512 NUL bytes", String::from_utf8(bytes).unwrap()));
    lines.drain(37..55);
    found.push(("rows cut out", lines.join("\n") + "\n"));
    found
}

/// Wrong: a run would go on beside rows it never wrote, or figures and pages would show them as its results.
#[test]
fn a_damaged_table_is_not_used_in_silence() {
    let dir = moved();
    let table = dir.text("whole/balls.csv");
    for (what, damaged) in damages(&table) {
        dir.write("whole/balls.csv", &damaged);
        // Also a run that has nothing left to do looks at its tables.
        let finished = dir.raceway(&["resume", "whole"]);
        assert_eq!(finished.code, Some(2), "{what}: {}", finished.stdout);
        assert!(
            finished.stderr.contains("step_000020.hdf "),
            "{what}: {}",
            finished.stderr
        );
        let outcome = dir.raceway(&["resume", "whole", "--step", "15"]);
        assert_eq!(outcome.code, Some(2), "{what}: {}", outcome.stderr);
        for part in [
            "whole/balls.csv is not as the run wrote it: its first ",
            "step_000015.hdf says ",
            "go on from step 1, the newest whose tables are as written: --step 1",
        ] {
            assert!(
                outcome.stderr.contains(part),
                "{what}: {} lacks {part}",
                outcome.stderr
            );
        }
        assert_eq!(
            dir.text("whole/balls.csv"),
            damaged,
            "{what}: refused, so untouched"
        );
        for command in ["plot", "report", "info"] {
            let outcome = dir.raceway(&[command, "whole"]);
            let said = outcome.stderr.clone() + &outcome.stdout;
            assert!(said.contains("balls.csv"), "{command} with {what}: {said}");
            let only_said = ["another number", "rows cut out"].contains(&what) && command != "info";
            let code = if only_said { 0 } else { 2 };
            assert_eq!(outcome.code, Some(code), "{command} with {what}: {said}");
        }
    }
    // A number that could be one is shown, with a warning on the page, too.
    dir.write("whole/balls.csv", &damages(&table)[2].1);
    assert_eq!(dir.raceway(&["report", "whole"]).code, Some(0));
    assert!(
        dir.text("whole/report.html")
            .contains("balls.csv is not as the run wrote it")
    );
    // From a step before the damage the run makes its rows again.
    dir.write("whole/balls.csv", &table);
    copy(&dir, "whole", "cut");
    dir.write("cut/balls.csv", &damages(&table)[0].1);
    let outcome = dir.raceway(&["resume", "cut", "--step", "1"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_same_run(&dir, "whole", "cut");
    // Rows behind the last step are cut off.
    dir.write("whole/balls.csv", format!("{table}21,1.0\n"));
    let outcome = dir.raceway(&["resume", "whole"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    assert_eq!(dir.text("whole/balls.csv"), table);
}

/// Wrong: rows that somebody added, or a table that is gone, would pass.
#[test]
fn a_table_with_more_or_less_than_the_run_wrote_is_said() {
    let dir = Dir::with_scene(SCENE);
    dir.run("out", &RIGID);
    let table = dir.text("out/shaft.csv");
    let row = table.lines().nth(1).unwrap().replacen("0,0.0", "1,1.0", 1);
    dir.write("out/shaft.csv", format!("{table}{row}\n"));
    let plot = dir.raceway(&["plot", "out"]);
    let said = format!(
        "warning: out/shaft.csv has {} bytes more than the run wrote",
        row.len() + 1
    );
    assert!(plot.stderr.contains(&said), "{}", plot.stderr);
    std::fs::remove_file(dir.path("out/shaft.csv")).unwrap();
    let plot = dir.raceway(&["plot", "out"]);
    assert!(
        plot.stderr.contains("cannot read out/shaft.csv: No such file"),
        "{}",
        plot.stderr
    );
    assert_eq!(dir.raceway(&["info", "out"]).code, Some(2));
}

/// Wrong: a command would wait without end for somebody to write into a pipe.
#[test]
fn a_pipe_in_the_place_of_a_file_is_refused() {
    let dir = moved();
    for name in ["balls.csv", "step_000020.hdf", "mesh.hdf"] {
        let path = dir.path(&format!("whole/{name}"));
        std::fs::remove_file(&path).unwrap();
        let made = std::process::Command::new("mkfifo").arg(&path).status().unwrap();
        assert!(made.success());
        let outcome = dir.raceway(&["info", "whole", "--verify"]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        let said = format!("cannot read whole/{name}: it is no plain file");
        assert!(outcome.stdout.contains(&said), "{}", outcome.stdout);
    }
    for command in [
        &["plot", "whole"][..],
        &["report", "whole"],
        &["resume", "whole", "--step", "20"],
    ] {
        let outcome = dir.raceway(command);
        assert_eq!(outcome.code, Some(2), "{command:?}: {}", outcome.stderr);
        assert!(
            outcome.stderr.contains("it is no plain file"),
            "{}",
            outcome.stderr
        );
    }
}
