//! Sweeps of a list of bearings: their points on several threads, and apart.

use crate::several::{flexible_pair, succeeds};
use crate::util::tables::Table;
use crate::util::{Dir, assert_close};

const LAST: usize = 10;

/// Two groups of points, the second of which starts from point 8.
fn swept() -> Dir {
    let values: Vec<String> = (0..=LAST).map(|i| format!("\"{} um\"", 14 + i)).collect();
    let sweep = format!(
        "[sweep]\nkey = \"pairing.offset\"\nvalues = [{}]",
        values.join(", ")
    );
    flexible_pair(&sweep)
}

/// Wrong: points that are solved at the same time would start from what happens to be there; or a reader would see
/// round-off in the place of values, and the line of the shaft without the point whose it is.
#[test]
fn points_of_a_list_have_the_same_bits_on_any_number_of_threads() {
    let dir = swept();
    for threads in ["1", "2", "4"] {
        let said = succeeds(
            &dir,
            &["run", "pair.toml", "--out", threads, "--threads", threads],
        );
        // 15 um, without the round-off of the unit.
        assert!(
            said.stderr.contains("bearings at pairing.offset_m = 0.000015\n"),
            "{}",
            said.stderr
        );
        assert!(
            said.stdout.contains("                    0.000015 "),
            "{}",
            said.stdout
        );
    }
    succeeds(&dir, &["plot", "1"]);
    let line = dir.text("1/figures/shaft_line.svg");
    assert!(
        line.contains("At the last point of the sweep: "),
        "the figure names no point"
    );
    for name in [
        "bearings.csv",
        "shaft.csv",
        "balls.csv",
        "front/balls.csv",
        "rear/shaft.csv",
        "front/step_000007.hdf",
        "rear/step_000010.hdf",
    ] {
        let bytes = |out: &str| std::fs::read(dir.path(&format!("{out}/{name}"))).unwrap();
        assert!(bytes("1") == bytes("2") && bytes("1") == bytes("4"), "{name}");
    }
    // Each in its place, as the ball forces say.
    let balls = Table::read(&dir, "1/front/balls.csv");
    let force = |step: usize| balls.step(step).column("outer_force_n").into_iter().sum::<f64>();
    let forces: Vec<f64> = (0..=LAST).map(force).collect();
    assert!(forces.windows(2).all(|two| two[0] < two[1]), "{forces:?}");
}

/// Wrong: jobs that share a sweep of a list would solve other points than the whole sweep has, or number them
/// otherwise; `resume` would say that points are there which are missing, or send a user off to solve all again.
#[test]
fn points_of_a_list_can_be_solved_apart() {
    let dir = swept();
    succeeds(&dir, &["run", "pair.toml", "--out", "whole"]);
    succeeds(&dir, &["run", "pair.toml", "--out", "part", "--points", "7-9"]);
    assert_eq!(dir.text("part/bearings.csv").lines().count(), 1 + 3 * 2);
    let rest = |out: &str, expected: &str| {
        let refused = dir.raceway(&["resume", out]);
        assert_eq!(refused.code, Some(2));
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    };
    rest("whole", "can be resumed; points 0-10 are there\n");
    rest(
        "part",
        "can be resumed; points 7-9 are there, points 0-6, 10 are missing; the same command with --points 0-6, with \
         --points 10, each with another --out, computes the missing ones",
    );
    for bearing in ["front", "rear"] {
        let table = |out: &str| Table::read(&dir, &format!("{out}/{bearing}/balls.csv"));
        let [whole, part] = [table("whole"), table("part")];
        assert_eq!(whole.columns, part.columns);
        for (step, name) in
            (7..=9).flat_map(|step| [(step, "outer_force_n"), (step, "inner_contact_angle_rad")])
        {
            let [whole, part] = [&whole, &part].map(|table| table.step(step).column(name));
            assert!(part.len() > 2 && whole.len() == part.len());
            for (a, b) in part.iter().zip(whole) {
                assert_close(&format!("{name} of {bearing} at point {step}"), *a, b, 1e-7);
            }
        }
    }
    let has = |name: &str| dir.path(&format!("part/front/{name}")).exists();
    assert!(has("step_000009.hdf") && !has("step_000006.hdf"));
    let refused = dir.raceway(&["run", "pair.toml", "--out", "no", "--points", "9-11"]);
    let text = "--points names point 11, but the sweep of pair.toml has 11, from 0 to 10";
    assert!(
        refused.code == Some(2) && refused.stderr.contains(text),
        "{}",
        refused.stderr
    );
}
