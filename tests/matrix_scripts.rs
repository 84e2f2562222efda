//! The scripts that make bodies of the matrices that other programs write, on files of the documented forms.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

use crate::util::Dir;

/// Runs a script on a job of the folder; what it ends with and says. None where there is no Python.
fn script(dir: &Dir, name: &str, arguments: &[&str]) -> Option<(i32, String)> {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("SKIPPED: python3 is not installed");
        return None;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(name);
    let mut command = Command::new("python3");
    command
        .arg("-B")
        .arg(path)
        .args(arguments)
        .current_dir(dir.path("."));
    let output = command.output().unwrap();
    let said = [output.stdout, output.stderr].concat();
    Some((output.status.code().unwrap(), String::from_utf8(said).unwrap()))
}

/// Nodes of a small body, not in the order of their numbers.
const NODES: [u64; 3] = [7, 3, 5];
/// Its deck.
const DECK: &str = "*NODE, NSET=ALL\n7, 0.5, 0., 0.\n3, 0., 1.5, 0.\n5, 0., 0., 2.5\n** a comment\n\
                    *NSET, NSET=Seat\n3, 7\n*NSET, NSET=FEET\n5\n*STEP\n*MATRIX GENERATE, STIFFNESS, MASS\n*END STEP\n";

/// Value of an entry: no two are the same.
fn value(row: usize, column: usize) -> f64 {
    let [low, high] = [row.min(column), row.max(column)];
    if low == high {
        100.0 + row as f64
    } else {
        -(1.0 + low as f64 + 0.01 * high as f64)
    }
}

/// Node and direction of a row in the order of the numbers of the nodes.
fn row(number: usize) -> (u64, usize) {
    let mut nodes = NODES;
    nodes.sort_unstable();
    (nodes[number / 3], number % 3 + 1)
}

/// The lower triangle as node, direction, node, direction, value; from the last row to the first.
fn with_labels(scale: f64) -> String {
    let mut text = String::from("** ASSEMBLED MATRIX\n");
    for i in (0..9).rev() {
        for j in 0..=i {
            let ((node, c), (other, d)) = (row(i), row(j));
            writeln!(text, "{node},{c}, {other},{d}, {:.14E}", scale * value(i, j)).unwrap();
        }
    }
    text
}

/// Both triangles as row, column, value.
fn with_coordinates(scale: f64) -> String {
    let mut text = String::new();
    for i in 0..9 {
        for j in 0..9 {
            writeln!(text, "  {}  {}  {:.14E}", i + 1, j + 1, scale * value(i, j)).unwrap();
        }
    }
    text
}

const SEAT: [&str; 5] = ["job", "--seat", "SEAT", "--fixed", "FEET"];

/// The entries of a Matrix Market file.
fn entries(text: &str) -> Vec<(usize, usize, f64)> {
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some("%%MatrixMarket matrix coordinate real symmetric")
    );
    assert_eq!(lines.next(), Some("9 9 45"));
    let entry = |line: &str| {
        let cells: Vec<&str> = line.split(' ').collect();
        (
            cells[0].parse().unwrap(),
            cells[1].parse().unwrap(),
            cells[2].parse().unwrap(),
        )
    };
    lines.map(entry).collect()
}

/// If this failed, rows would be those of other nodes, or a triangle would count twice.
#[test]
fn matrices_of_abaqus_have_rows_by_node_and_direction() {
    let dir = Dir::empty();
    dir.write("job.inp", DECK);
    for (form, of) in [
        ("labels", with_labels as fn(f64) -> String),
        ("coordinates", with_coordinates),
    ] {
        dir.write("job_STIF1.mtx", of(1.0));
        dir.write("job_MASS1.mtx", of(0.5));
        let Some((code, said)) = script(
            &dir,
            "matrix-from-abaqus",
            &[&SEAT[..], &["--out", form]].concat(),
        ) else {
            return;
        };
        assert_eq!(code, 0, "{said}");
        assert!(
            said.starts_with(
                "3 nodes: K.mtx, M.mtx, nodes.csv and the nodes of seat.csv (2), fixed.csv (1) in"
            ),
            "{said}"
        );
        let table = |name: &str| dir.text(&format!("{form}/{name}"));
        for (name, scale) in [("K.mtx", 1.0), ("M.mtx", 0.5)] {
            for (i, j, found) in entries(&table(name)) {
                let expected = scale * value(i - 1, j - 1);
                assert!(
                    i >= j && (found / expected - 1.0).abs() < 1e-13,
                    "{form} {i} {j} {found} {expected}"
                );
            }
        }
        assert_eq!(
            table("nodes.csv"),
            "node,x,y,z\n3,0.0,1.5,0.0\n5,0.0,0.0,2.5\n7,0.5,0.0,0.0\n"
        );
        assert_eq!(
            [table("seat.csv"), table("fixed.csv")],
            ["node\n3\n7\n", "node\n5\n"]
        );
    }
    // Several seats have files with the names of their sets; without a mass there is none.
    std::fs::remove_file(dir.path("job_MASS1.mtx")).unwrap();
    let two = ["job.inp", "--seat", "SEAT", "FEET", "--out", "two"];
    let (code, said) = script(&dir, "matrix-from-abaqus", &two).unwrap();
    assert_eq!(code, 0, "{said}");
    assert_eq!(
        [dir.text("two/seat.csv"), dir.text("two/feet.csv")],
        ["node\n3\n7\n", "node\n5\n"]
    );
    assert!(!dir.path("two/M.mtx").exists() && dir.path("two/K.mtx").exists());
}

/// If this failed, a body would be made of what is no matrix of its nodes, or nobody would know why it is not made.
#[test]
fn matrices_of_abaqus_with_slips_are_refused_with_their_place() {
    let dir = Dir::empty();
    let labels = with_labels(1.0);
    let first = labels.lines().nth(1).unwrap();
    let more = |line: &str| format!("{labels}{line}\n");
    let cases = [
        (
            DECK.to_string(),
            None,
            "job_STIF1.mtx: No such file or directory; expected what *MATRIX OUTPUT writes",
        ),
        (
            format!("*PART, NAME=A\n{DECK}"),
            Some(labels.clone()),
            "*PART numbers nodes anew; expected a deck without parts",
        ),
        (
            DECK.replace("Seat", "BORE"),
            Some(labels.clone()),
            "no *NSET SEAT; it has ALL, BORE, FEET",
        ),
        (
            DECK.to_string(),
            Some(more("-1,1, 3,1, 2.0")),
            "line 47: row -1 is internal to Abaqus, as of hybrid elements",
        ),
        (
            DECK.to_string(),
            Some(more("3,4, 3,4, 2.0")),
            "node 3 has the directions 1 2 3 4; expected 1 2 3, those of a solid",
        ),
        (
            DECK.to_string(),
            Some(more("9,1, 9,1, 2.0")),
            "line 47: node 9 is not in the deck",
        ),
        (
            DECK.to_string(),
            Some(more("3,1, 3,2, nan")),
            "line 47: nan; expected a number",
        ),
        (
            DECK.to_string(),
            Some(more("3,1, 3,1, 1.0E+36")),
            "stands for a held node; hold none in the deck",
        ),
        (
            DECK.to_string(),
            Some(more("3,2, 7,3, 8.0")),
            "but the same entry is -2.08",
        ),
        (
            DECK.to_string(),
            Some(more("3,2, 7, 8.0")),
            "line 47: 4 numbers; expected node, direction, node, direction, value",
        ),
        (
            DECK.to_string(),
            Some(more("3,2, 7,x, 8.0")),
            "is no entry of a matrix",
        ),
        (
            DECK.to_string(),
            Some("10 1 5.0\n".to_string()),
            "line 1: row 10 of 3 x 3; expected three rows for each node",
        ),
        (
            DECK.to_string(),
            Some("** none\n".to_string()),
            "job_STIF1.mtx: no entries",
        ),
        (
            DECK.replace("7, 0.5", "11, 0., 0., 0.\n7, 0.5")
                .replace("3, 7\n", "3, 11\n"),
            Some(labels.clone()),
            "node 11 for seat.csv has no stiffness; it is in no element",
        ),
    ];
    assert!(first.starts_with("7,3, 3,1"), "{first}");
    for (deck, matrix, expected) in cases {
        dir.write("job.inp", deck);
        let path = dir.path("job_STIF1.mtx");
        let _ = std::fs::remove_file(&path);
        if let Some(text) = matrix {
            std::fs::write(&path, text).unwrap();
        }
        let Some((code, said)) = script(&dir, "matrix-from-abaqus", &SEAT) else {
            return;
        };
        assert!(
            code == 2 && said.contains(expected),
            "{code} {said}\nexpected: {expected}"
        );
        assert!(!dir.path("K.mtx").exists());
    }
}

/// If this failed, matrices of CalculiX would have the rows of other nodes.
#[test]
fn matrices_of_calculix_have_rows_by_node_and_direction() {
    let dir = Dir::empty();
    dir.write("job.inp", DECK);
    dir.write("job.dof", names_of_rows().collect::<String>());
    let mut text = String::new();
    for i in 0..9 {
        for j in 0..=i {
            writeln!(text, "{} {} {:.14E}", 9 - i, 9 - j, value(i, j)).unwrap();
        }
    }
    dir.write("job.sti", &text);
    dir.write("job.mas", &text);
    let Some((code, said)) = script(
        &dir,
        "matrix-from-calculix",
        &["job", "--seat", "SEAT", "FEET", "--out", "made"],
    ) else {
        return;
    };
    assert_eq!(code, 0, "{said}");
    for name in ["K.mtx", "M.mtx"] {
        for (i, j, found) in entries(&dir.text(&format!("made/{name}"))) {
            assert!(
                i >= j && (found / value(i - 1, j - 1) - 1.0).abs() < 1e-13,
                "{i} {j} {found}"
            );
        }
    }
    assert_eq!(dir.text("made/nodes.csv").lines().nth(1), Some("3,0.0,1.5,0.0"));
    assert_eq!(
        [dir.text("made/seat.csv"), dir.text("made/feet.csv")],
        ["node\n3\n7\n", "node\n5\n"]
    );
    // Wrong rows.
    let first = names_of_rows().collect::<String>();
    let twice = first.replace("3.3\n", "3.2\n");
    let cases = [
        (
            first.as_str(),
            "0 0 4.0\n",
            "line 1: '0 0 4.0'; expected rows and columns 1 to 9 and a number",
        ),
        (
            first.as_str(),
            "1 10 4.0\n",
            "line 1: '1 10 4.0'; expected rows and columns 1 to 9 and a number",
        ),
        (
            first.as_str(),
            "1 1 inf\n",
            "line 1: '1 1 inf'; expected rows and columns 1 to 9 and a number",
        ),
        (
            first.as_str(),
            "1 x 4.0\n",
            "line 1: '1 x 4.0'; expected row, column, value",
        ),
        (
            twice.as_str(),
            "1 1 4.0\n",
            "node 3 has rows in the directions 1 2 2; expected 1 2 3",
        ),
    ];
    for (rows, matrix, expected) in cases {
        dir.write("job.dof", rows);
        dir.write("job.sti", matrix);
        let (code, said) = script(&dir, "matrix-from-calculix", &["job", "--seat", "SEAT"]).unwrap();
        assert!(
            code == 2 && said.contains(expected),
            "{code} {said}\nexpected: {expected}"
        );
    }
}

/// The rows of CalculiX, which come in an order of its own: here from the last to the first.
fn names_of_rows() -> impl Iterator<Item = String> {
    (0..9).rev().map(row).map(|(node, c)| format!("{node}.{c}\n"))
}
