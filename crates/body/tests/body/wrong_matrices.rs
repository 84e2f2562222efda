//! Matrices that are no body: their messages.

use body::matrix::{MatrixBody, MatrixFiles};
use body::{BodySeat, Surrounding};

use super::matrices::{condensed, of_matrix, write_matrix};
use super::{basis, small, space};

/// The files of a small body held outside, in a folder that lives as long as they are asked for.
fn files() -> (tempfile::TempDir, MatrixFiles) {
    let dir = tempfile::tempdir().unwrap();
    let files = write_matrix(dir.path(), &small(), "outside");
    (dir, files)
}

/// What is said of the body after a change of its matrices.
fn said(files: &MatrixFiles, change: impl Fn(&mut MatrixBody)) -> Option<String> {
    let mut matrix = MatrixBody::read(files).unwrap();
    change(&mut matrix);
    condensed(&matrix).err()
}

/// Wrong: a stiffness with a spring to ground, or in other axes than its nodes, would pass for that of a free body.
#[test]
fn a_stiffness_that_rigid_motions_strain_is_refused() {
    let (_dir, files) = files();
    assert_eq!(said(&files, |_| ()), None);
    let spring = |share: f64| {
        move |matrix: &mut MatrixBody| {
            let own = matrix.stiffness.get_mut(4, 4).unwrap();
            *own *= 1.0 + share;
        }
    };
    let text = said(&files, spring(0.2)).unwrap();
    for part in [
        "body \"other\": the stiffness is not that of a free body: moved as a whole along y, which should strain \
         nothing, it asks for ",
        " N at node 102 in y per m, ",
        "expected at most 1e-6, because fixed_nodes hold the body: export the stiffness without supports and \
         springs to ground, in the frame and unit of the nodes; of a body on springs give the feet as nodes of the \
         matrix and name them in fixed_nodes, or take out the rows of held nodes and leave fixed_nodes away",
    ] {
        assert!(text.contains(part), "{text}");
    }
    // Seven digits pass, six do not.
    assert_eq!(said(&files, spring(1e-7)), None);
    assert!(said(&files, spring(2e-5)).is_some());
    // Nodes in another order, or another unit of one axis: translations strain nothing, rotations do.
    let text = said(&files, |matrix| {
        matrix.places.iter_mut().for_each(|x| x[2] *= 1.001)
    })
    .unwrap_or_default();
    assert!(text.contains("moved as a whole about x"), "{text}");
    assert!(
        text.contains("per rad") && text.contains("expected at most 1e-5"),
        "{text}"
    );
    // A matrix that holds its supports itself has springs at the nodes beside them.
    let held = |matrix: &mut MatrixBody| {
        let fixed = matrix.fixed.clone();
        for (dof, mut row) in matrix.stiffness.outer_iterator_mut().enumerate() {
            if let (true, Some(own)) = (fixed[dof / 3], row.get_mut(dof)) {
                *own *= 1e3;
            }
        }
        matrix.fixed.fill(false);
    };
    assert_eq!(said(&files, held), None);
}

/// Wrong: an entry that is far too large would end in a word on supports, or a mass that is not positive pass.
#[test]
fn matrices_that_are_not_positive_are_refused_with_their_place() {
    let (dir, files) = files();
    for (name, what) in [("M.mtx", "mass"), ("K.mtx", "stiffness")] {
        let path = dir.path().join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        let large = |line: &str| {
            let [i, j, value] = line.split(' ').collect::<Vec<_>>()[..] else {
                return None;
            };
            let is_it = i == "4" && j == "1";
            is_it.then(|| format!("{i} {j} {:e}", 1e3 * value.parse::<f64>().unwrap()))
        };
        let changed = text
            .lines()
            .map(|line| large(line).unwrap_or(line.to_string()) + "\n");
        std::fs::write(&path, changed.collect::<String>()).unwrap();
        let said = of_matrix(&files).err().unwrap();
        let expected = format!("{name}: the {what} is not positive: node 10");
        assert!(said.contains(&expected), "{said}");
        let expected =
            "so they could move with a negative energy: correct the entry, or export the matrix once more";
        assert!(said.contains(expected), "{said}");
        std::fs::write(&path, text).unwrap();
    }
    // No pair is wrong, but a motion of many nodes has a negative energy.
    let text = said(&files, |matrix| {
        for (row, mut vector) in matrix.mass.as_mut().unwrap().outer_iterator_mut().enumerate() {
            let others = vector.iter_mut().filter(|(column, _)| *column != row);
            others.for_each(|(_, m)| *m *= -1.2);
        }
    })
    .unwrap();
    let expected = "body \"other\": the mass matrix is not positive: elimination fails at node ";
    assert!(text.starts_with(expected), "{text}");
    assert!(
        text.contains("correct the entries there, or export the mass once more"),
        "{text}"
    );
    // A mass without off-diagonal entries, and one of round-off in a motion, are masses.
    let lumped = said(&files, |matrix| {
        for (row, mut vector) in matrix.mass.as_mut().unwrap().outer_iterator_mut().enumerate() {
            let others = vector.iter_mut().filter(|(column, _)| *column != row);
            others.for_each(|(_, m)| *m = 0.0);
        }
    });
    assert_eq!(lumped, None);
}

/// Wrong: of a whole matrix in a file that says symmetric all that couples its dofs would count twice, and a mass or a
/// condensed stiffness so made passes all other tests.
#[test]
fn a_symmetric_file_with_both_halves_is_refused() {
    let (dir, files) = files();
    for (name, what) in [("M.mtx", "mass"), ("K.mtx", "stiffness")] {
        let path = dir.path().join(name);
        let half = std::fs::read_to_string(&path).unwrap();
        let lines = half.lines().filter(|line| !line.starts_with("% "));
        let [head, sizes, entries @ ..] = &lines.collect::<Vec<_>>()[..] else {
            panic!("{name} has no entries");
        };
        let mirrored = entries.iter().filter_map(|entry| {
            let [i, j, value] = entry.split(' ').collect::<Vec<_>>()[..] else {
                return None;
            };
            (i != j).then(|| format!("{j} {i} {value}"))
        });
        let both: Vec<String> = entries.iter().map(|e| e.to_string()).chain(mirrored).collect();
        let n = sizes.split(' ').next().unwrap();
        let whole = |head: &str| format!("{head}\n{n} {n} {}\n{}\n", both.len(), both.join("\n"));
        std::fs::write(&path, whole(head)).unwrap();
        let said = MatrixBody::read(&files).err().unwrap().to_string();
        for part in [
            format!("{name}: the {what} of node 101 x with node 10"),
            "stands here in both halves, row 1 column ".to_string(),
            "a file that its first line calls symmetric has one half: write general there, or take one half out"
                .to_string(),
        ] {
            assert!(said.contains(&part), "{said}");
        }
        // Called general, the same text is the matrix of its half.
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            MatrixBody::read(&files).unwrap()
        };
        let [general, of_half] =
            [&whole(&head.replace("symmetric", "general")), &half].map(|text| read(text));
        assert_eq!(general.stiffness, of_half.stiffness);
        assert_eq!(general.mass, of_half.mass);
    }
}

/// Wrong: one who has matrices would be told of meshes, groups and Gmsh.
#[test]
fn messages_on_matrices_speak_of_their_files() {
    let (_dir, files) = files();
    let seat = |radius: f64, half_width: f64, harmonics: usize| {
        let mut space = space(basis(harmonics, 1));
        space.radius *= radius;
        space.half_width *= half_width;
        BodySeat {
            name: String::new(),
            space,
            middle: None,
            is_turned: false,
        }
    };
    let matrix = MatrixBody::read(&files).unwrap();
    let mut free = matrix.clone();
    free.fixed.fill(false);
    let mut seat_fixed = matrix.clone();
    seat_fixed.fixed.fill(true);
    let mut off = matrix.clone();
    off.places.iter_mut().for_each(|x| x[0] += 1e-3);
    for (matrix, seat, expected) in [
        (
            &matrix,
            seat(1e-3, 1.0, 3),
            "so check length_unit, the file `nodes` and the nodes in seat_nodes; its lengths seem to be in a unit 1000",
        ),
        (
            &matrix,
            seat(1.0, 2.0, 3),
            "list in seat_nodes all nodes of the bore from one end of the seat of the ring to the other, and check \
             length_unit; the body needs nodes where the seat ends",
        ),
        (&matrix, seat(1.0, 1.0, 60), "the seat of body \"other\" has "),
        (
            &matrix,
            seat(1.0, 1.0, 60),
            "list all nodes of the seat in seat_nodes, take a body with more of them, or fewer harmonics or across",
        ),
        (
            &free,
            seat(1.0, 1.0, 3),
            "without any force; list the nodes that stand on the ground in fixed_nodes, or export the stiffness of a \
             body that is held and one connected part; a stiffness with wrong entries ends here too",
        ),
        (
            &seat_fixed,
            seat(1.0, 1.0, 3),
            "of the seat is fixed as well; a seat that does not move is `support = \"clamped\"`, so take it out of \
             fixed_nodes or of seat_nodes",
        ),
        (
            &off,
            seat(1.0, 1.0, 3),
            "give the file `nodes` in a frame whose z is the axis of the seat, and list in seat_nodes nodes of the \
             cylinder only",
        ),
    ] {
        let said = Surrounding::of_matrix("other", matrix, &[seat])
            .err()
            .unwrap()
            .to_string();
        assert!(said.contains(expected), "{said}\nexpected: {expected}");
        for word in ["Gmsh", "mesh", "\"\"", "group"] {
            assert!(!said.contains(word), "{said}");
        }
    }
}
