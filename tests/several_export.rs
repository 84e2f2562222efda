//! `raceway export` of a whole list of bearings: blocks and tables in the frame of the shaft, times, refusals.

use checkpoint::{Grid, StepRecord, all_steps, read_mesh, read_step, step_file_name};

use crate::export::vtu_array;
use crate::several::{flexible_pair, pair, succeeds};
use crate::several_modes::column;
use crate::shared_housing::{FEW, SCENE};
use crate::util::delivered::coarse;
use crate::util::tables::Table;
use crate::util::{Dir, assert_within};

/// Places of the points of a block and a vector on them, `[n_points][3]`.
fn vectors(text: &str, name: &str) -> Vec<[f64; 3]> {
    vtu_array(text, name).as_chunks::<3>().0.to_vec()
}

/// Points, cells and fields of a bearing in its own folder, at a step.
fn own(dir: &Dir, folder: &str, step: u64) -> (Grid, StepRecord) {
    let path = dir.path(folder);
    let record = read_step(&path.join(step_file_name(step))).unwrap();
    (read_mesh(&path).unwrap(), record)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// Rows of a table whose `body` is one of a bearing, without the number of the point.
fn rows_of(table: &Table, body: f64) -> Vec<Vec<f64>> {
    let rows = table.rows.iter().filter(|row| row[1] == body);
    rows.map(|row| row[1..].to_vec()).collect()
}

/// Wrong: tables of a list would lack a part or a row, or have it in another frame than the blocks: places, fields
/// and stress of a bearing that is turned by 180 deg about x, at nodes and at integration points.
#[test]
fn tables_of_a_list_have_each_part_in_the_frame_of_the_shaft() {
    let dir = flexible_pair("[output]\nstress = \"integration_points\"\n\n[static]");
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let said = succeeds(&dir, &["export", "out", "--to", "csv"]).stdout;
    assert!(said.contains("1 step as csv in out/export"), "{said}");
    let step = all_steps(&dir.path("out/front")).unwrap()[0];
    let stem = format!("step_{step:06}");
    let sign = |column: &str, turned: bool| {
        let odd = ["y_m", "z_m", "_y_m", "_z_m", "_y_n", "_z_n", "_xy_pa", "_xz_pa"];
        if turned && odd.iter().any(|end| column.ends_with(end)) {
            -1.0
        } else {
            1.0
        }
    };
    let mut shifts = Vec::new();
    for (name, turned, position) in [("front", false, 0.06), ("rear", true, 0.13)] {
        succeeds(&dir, &["export", &format!("out/{name}"), "--to", "csv"]);
        for (end, parts) in [
            ("", &["inner_ring", "outer_ring", "balls"][..]),
            ("_integration_points", &["inner_ring", "outer_ring"]),
        ] {
            let own = Table::read(&dir, &format!("out/{name}/export/{stem}{end}.csv"));
            for (body, part) in parts.iter().enumerate() {
                let table = Table::read(&dir, &format!("out/export/{stem}/{name}_{part}{end}.csv"));
                assert_eq!(table.columns, own.columns);
                let (found, expected) = (rows_of(&table, body as f64), rows_of(&own, body as f64));
                assert_eq!((found.len(), found.is_empty()), (expected.len(), false));
                for (i, column) in own.columns[1..].iter().enumerate() {
                    let difference = |(a, b): (&Vec<f64>, &Vec<f64>)| a[i] - sign(column, turned) * b[i];
                    let off: Vec<f64> = found.iter().zip(&expected).map(difference).collect();
                    let shift = if column == "z_m" { off[0] } else { 0.0 };
                    assert!(
                        off.iter().all(|x| (x - shift).abs() < 1e-15),
                        "{name} {part} {column}"
                    );
                    if column == "z_m" {
                        shifts.push(shift - position);
                    }
                }
            }
        }
    }
    // Groove centres are at the positions: by so much is each off in its own frame.
    for shift in &shifts[..5] {
        assert!(
            (shift - shifts[0]).abs() < 1e-15 && shift.abs() > 1e-6 && shift.abs() < 2e-4,
            "{shifts:?}"
        );
    }
    assert!(
        shifts[5..].iter().all(|shift| (shift + shifts[0]).abs() < 1e-15),
        "{shifts:?}"
    );
    let shaft = Table::read(&dir, &format!("out/export/{stem}/shaft.csv"));
    let own = Table::read(&dir, "out/shaft.csv");
    assert_eq!(shaft.column("z_m"), own.column("position_m"));
    for (there, here) in [("displacement_x_m", "x_m"), ("rotation_y_rad", "tilt_y_rad")] {
        assert_eq!(shaft.column(there), own.column(here));
    }
    assert!(!dir.path("out/export/run.pvd").exists());
    let again = dir.raceway(&["export", "out", "--to", "csv"]);
    let text = format!("out/export already holds {stem}; choose another --out or remove it");
    assert!(
        again.code == Some(2) && again.stderr.contains(&text),
        "{}",
        again.stderr
    );
}

/// Wrong: a bearing would stand elsewhere or be turned otherwise than its shaft has it, a field would not be that of
/// its own files, or the bores of both would not move as the beam does. That last is no part of the export: the bores
/// are clamped to the shaft, half of the offset apart along their own z, and the shaft has its own table.
#[test]
fn a_list_is_shown_in_the_frame_of_its_shaft() {
    let dir = flexible_pair("[static]");
    let load = "shaft.load.0.force=[\"300 N\", \"150 N\", \"200 N\"]";
    succeeds(&dir, &["run", "pair.toml", "--out", "out", "--set", load]);
    let said = succeeds(&dir, &["export", "out", "--to", "vtu"]);
    assert!(
        said.stdout.contains("1 step as vtu in out/export"),
        "{}",
        said.stdout
    );
    let step = all_steps(&dir.path("out/front")).unwrap()[0];
    let stem = format!("step_{step:06}");
    assert_eq!(dir.text(&format!("out/export/{stem}.vtm")), tree(&stem));
    let column = |name: &str| column(&dir, "out/bearings.csv", name);
    for (row, (name, position, sign)) in [("front", 0.06, 1.0), ("rear", 0.13, -1.0)]
        .into_iter()
        .enumerate()
    {
        let (grid, record) = own(&dir, &format!("out/{name}"), step);
        let stress = record.points.stress.as_ref().unwrap();
        let von_mises = record.points.von_mises.as_ref().unwrap();
        let forces = record.points.force_outer.as_ref().unwrap();
        let turned = |v: [f64; 3]| [v[0], sign * v[1], sign * v[2]];
        let (mut first, mut origin) = (0, None);
        for block in ["inner_ring", "outer_ring", "balls"] {
            let text = dir.text(&format!("out/export/{stem}/{name}_{block}.vtu"));
            let points = vectors(&text, "Points");
            let rows = first..first + points.len();
            first = rows.end;
            // One shift along z; the bores below tell that it is the right one.
            let shift = *origin.get_or_insert(points[0][2] - turned(grid.points[0])[2]);
            for (shown, own) in points.iter().zip(&grid.points[rows.clone()]) {
                let own = turned(*own);
                assert_eq!(shown[..2], own[..2], "{name} {block}");
                assert_within(block, shown[2], own[2] + shift, 1e-15);
            }
            let u = vectors(&text, "displacement");
            let expected: Vec<[f64; 3]> = record.points.displacement[rows.clone()]
                .iter()
                .map(|u| turned(*u))
                .collect();
            assert_eq!(u, expected, "{name} {block}");
            let expected: Vec<[f64; 3]> = forces[rows.clone()].iter().map(|f| turned(*f)).collect();
            assert_eq!(vectors(&text, "force_outer"), expected);
            assert_eq!(vtu_array(&text, "von_mises"), von_mises[rows.clone()]);
            assert_same_tensors(vtu_array(&text, "stress").as_chunks::<6>().0, &stress[rows], sign);
            let radius = vtu_array(&text, "radius");
            assert!(radius.iter().all(|r| (*r > 0.0) == (block == "balls")));
            if block == "inner_ring" {
                let q = ["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"].map(|name| column(name)[row]);
                assert_moves_with_shaft((&points, &u), position, q, sign * 10e-6);
            }
        }
        assert_eq!(first, grid.points.len());
    }
    let (shaft, text) = (
        Table::read(&dir, "out/shaft.csv"),
        dir.text(&format!("out/export/{stem}/shaft.vtu")),
    );
    let rows = |names: [&str; 3]| {
        let columns = names.map(|name| shaft.column(name));
        (0..shaft.rows.len())
            .map(|i| [0, 1, 2].map(|k| columns[k][i]))
            .collect::<Vec<_>>()
    };
    assert_eq!(vectors(&text, "displacement"), rows(["x_m", "y_m", "z_m"]));
    let places: Vec<f64> = vectors(&text, "Points").iter().map(|p| p[2]).collect();
    assert_eq!(places, shaft.column("position_m"));
    let rotation: Vec<f64> = vectors(&text, "rotation").iter().map(|r| r[1]).collect();
    assert_eq!(rotation, shaft.column("tilt_y_rad"));
}

/// The blocks of the pair.
fn tree(stem: &str) -> String {
    let of_bearing = |index: usize, name: &str| {
        let blocks = ["inner ring", "outer ring", "balls"]
            .iter()
            .enumerate()
            .map(|(i, block)| {
                let file = format!("{stem}/{name}_{}.vtu", block.replace(' ', "_"));
                format!("<DataSet index=\"{i}\" name=\"{block}\" file=\"{file}\"/>\n")
            });
        let blocks: String = blocks.collect();
        format!("<Block index=\"{index}\" name=\"{name}\">\n{blocks}</Block>\n")
    };
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<vtkMultiBlockDataSet>\n<Block index=\"0\" name=\"bearings\">\n{}{}</Block>\n\
         <DataSet index=\"1\" name=\"shaft\" file=\"{stem}/shaft.vtu\"/>\n</vtkMultiBlockDataSet>\n</VTKFile>\n",
        of_bearing(0, "front"),
        of_bearing(1, "rear")
    )
}

/// The traction on a turned plane is the turned traction, for any plane: for three that span space.
fn assert_same_tensors(shown: &[[f64; 6]], own: &[[f64; 6]], sign: f64) {
    assert_eq!(shown.len(), own.len());
    let traction = |s: &[f64; 6], n: [f64; 3]| {
        [
            dot([s[0], s[3], s[5]], n),
            dot([s[3], s[1], s[4]], n),
            dot([s[5], s[4], s[2]], n),
        ]
    };
    for (shown, own) in shown.iter().zip(own) {
        for n in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let turned = |v: [f64; 3]| [v[0], sign * v[1], sign * v[2]];
            assert_eq!(traction(shown, turned(n)), turned(traction(own, n)));
        }
    }
}

/// The bore moves as a point of the shaft does: x, y, z, tilt x, tilt y of it at the position, and what the ring is
/// moved along z besides.
fn assert_moves_with_shaft(
    (points, u): (&[[f64; 3]], &[[f64; 3]]),
    position: f64,
    [x, y, z, tilt_x, tilt_y]: [f64; 5],
    moved: f64,
) {
    let radius = |p: &[f64; 3]| p[0].hypot(p[1]);
    let bore = points.iter().map(radius).fold(f64::INFINITY, f64::min);
    let mut n = 0;
    for (p, u) in points.iter().zip(u).filter(|(p, _)| radius(p) < bore + 1e-9) {
        let arm = p[2] - position;
        let expected = [
            x + tilt_y * arm,
            y - tilt_x * arm,
            z + tilt_x * p[1] - tilt_y * p[0] + moved,
        ];
        (0..3).for_each(|i| assert_within("bore", u[i], expected[i], 1e-12));
        n += 1;
    }
    assert!(
        n > 20 && tilt_x.abs() > 1e-6 && tilt_y.abs() > 1e-6,
        "{n} nodes, {tilt_x} {tilt_y}"
    );
}

/// Wrong: steps of a sweep would lack their times, files be written over, or a user not learn which bearing or step is
/// missing.
#[test]
fn steps_of_a_list_are_those_of_all_bearings() {
    let sweep = "[effects.axial_force]\nvalue = \"1 N\"\n[sweep]\nkey = \"effects.axial_force.value\"\n\
                 values = [\"1 N\", \"200 N\", \"400 N\"]";
    let dir = pair(sweep);
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    let steps = all_steps(&dir.path("out/front")).unwrap();
    assert_eq!(steps.len(), 3);
    succeeds(&dir, &["export", "out", "--to", "vtu", "--out", "all"]);
    let times = dir.text("all/run.pvd");
    for step in &steps {
        let record = read_step(&dir.path(&format!("out/rear/{}", step_file_name(*step)))).unwrap();
        let line = format!(
            "timestep=\"{:?}\" part=\"0\" file=\"step_{step:06}.vtm\"",
            record.time
        );
        assert!(times.contains(&line), "{times}");
        // Rings are rigid: of each bearing there are the balls.
        let tree = dir.text(&format!("all/step_{step:06}.vtm"));
        assert_eq!(tree.matches("<DataSet").count(), 3, "{tree}");
    }
    let refused = |arguments: &[&str], expected: &str| {
        let refused = dir.raceway(&[&["export", "out", "--to", "vtu"], arguments].concat());
        assert_eq!(refused.code, Some(2));
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    };
    let first = format!(
        "all already holds step_{:06}; choose another --out or remove it",
        steps[0]
    );
    refused(&["--out", "all"], &first);
    let range = format!("{}..{}", steps[0], steps[1]);
    std::fs::remove_file(dir.path(&format!("out/rear/{}", step_file_name(steps[2])))).unwrap();
    let expected = format!(
        "step {} of out is there for the bearing \"front\" and not for \"rear\"; expected steps of all bearings, which \
         have 2 from {} to {}; choose some with --steps",
        steps[2], steps[0], steps[1]
    );
    refused(&["--out", "some"], &expected);
    succeeds(
        &dir,
        &["export", "out", "--to", "vtu", "--out", "some", "--steps", &range],
    );
    assert_eq!(dir.text("some/run.pvd").matches("<DataSet").count(), 2);
    refused(
        &["--out", "none", "--steps", "70..80"],
        "out has no step from 70 to 80",
    );
    std::fs::rename(dir.path("out/rear"), dir.path("out/elsewhere")).unwrap();
    refused(
        &["--out", "none"],
        "the folder out/rear of the bearing \"rear\" is not there; expected the results of all bearings of out",
    );
    assert!(!dir.path("none").exists());
}

/// Wrong: shapes of modes would be shown with a shaft of another scale.
#[test]
fn modes_of_a_list_move_shaft_and_bearings_on_one_scale() {
    let dir = flexible_pair("[modes]\nnumber = 4");
    succeeds(&dir, &["run", "pair.toml", "--out", "out"]);
    succeeds(&dir, &["export", "out", "--to", "vtu", "--steps", "2"]);
    let shaft = Table::read(&dir, "out/mode_shaft.csv");
    let modes = shaft.column("mode");
    let rows = (0..modes.len()).filter(|&i| modes[i] == 2.0);
    let expected: Vec<f64> = rows.map(|i| 1e-3 * shaft.column("x")[i]).collect();
    let text = dir.text("out/export/step_000002/shaft.vtu");
    let found: Vec<f64> = vectors(&text, "displacement").iter().map(|u| u[0]).collect();
    assert_eq!(found, expected);
    // The bore of a ring has the mean motion of its place on the shaft, whichever way the bearing is turned.
    for (name, position) in [("front", 0.06), ("rear", 0.13)] {
        let text = dir.text(&format!("out/export/step_000002/{name}_inner_ring.vtu"));
        let (points, u) = (vectors(&text, "Points"), vectors(&text, "displacement"));
        let places = vectors(&dir.text("out/export/step_000002/shaft.vtu"), "Points");
        let at = places
            .iter()
            .position(|p| (p[2] - position).abs() < 1e-9)
            .unwrap();
        let on_shaft = vectors(&dir.text("out/export/step_000002/shaft.vtu"), "displacement")[at];
        let bore = points
            .iter()
            .map(|p| p[0].hypot(p[1]))
            .fold(f64::INFINITY, f64::min);
        let held: Vec<usize> = (0..points.len())
            .filter(|&i| points[i][0].hypot(points[i][1]) < bore + 1e-9)
            .collect();
        let middle: f64 = held.iter().map(|&i| points[i][2]).sum::<f64>() / held.len() as f64;
        let tilts = vectors(&dir.text("out/export/step_000002/shaft.vtu"), "rotation")[at];
        let arm = middle - position;
        let expected = [
            on_shaft[0] + tilts[1] * arm,
            on_shaft[1] - tilts[0] * arm,
            on_shaft[2],
        ];
        for i in 0..3 {
            let mean = held.iter().map(|&k| u[k][i]).sum::<f64>() / held.len() as f64;
            assert_within(name, mean, expected[i], 1e-9);
        }
    }
}

/// Wrong: a body would not stand round the rings that sit in it, or be turned with the bearing that shows it. In the
/// other order of the list the other bearing shows the body, in a frame that is turned.
#[test]
fn a_housing_stands_round_both_outer_rings_in_either_order() {
    let dir = coarse(&[SCENE]);
    let text = dir
        .text(SCENE)
        .replace("../meshes", "meshes")
        .replace("\"types/", "\"scenes/types/");
    let parts: Vec<&str> = text.split("\n[[bearing]]").collect();
    let (rear, rest) = parts[2].split_once("\n[pairing]").unwrap();
    let reversed = format!(
        "{}\n[[bearing]]{rear}\n[[bearing]]{}\n[pairing]{rest}",
        parts[0], parts[1]
    );
    dir.write("order.toml", &text);
    dir.write("reversed.toml", &reversed);
    let mut shown = Vec::new();
    for name in ["order", "reversed"] {
        succeeds(
            &dir,
            &[&["run", &format!("{name}.toml"), "--out", name][..], &FEW].concat(),
        );
        succeeds(&dir, &["export", name, "--to", "vtu"]);
        let step = all_steps(&dir.path(&format!("{name}/front"))).unwrap()[0];
        let stem = format!("{name}/export/step_{step:06}");
        let tree = dir.text(&format!("{stem}.vtm"));
        assert!(tree.contains("<DataSet index=\"0\" name=\"housing\""), "{tree}");
        let block = |block: &str| {
            let text = dir.text(&format!("{stem}/{block}.vtu"));
            (vectors(&text, "Points"), vectors(&text, "displacement"))
        };
        shown.push(["body_0", "front_outer_ring", "rear_outer_ring"].map(block));
    }
    for (number, (a, b)) in shown[0].iter().zip(&shown[1]).enumerate() {
        assert_eq!(a.0.len(), b.0.len());
        // The body stands at the seat of the first bearing; the seats of both are 70 mm apart, and so are the inner
        // grooves: the outer rings are apart by twice the distance of inner and outer groove centres more.
        let along = a.0[0][2] - b.0[0][2];
        assert!(number == 0 || along.abs() < 1e-12, "{along}");
        assert!(along.abs() < 0.25e-3, "{along}");
        for i in 0..a.0.len() {
            for k in 0..3 {
                let moved = if k == 2 { along } else { 0.0 };
                assert_within("place", a.0[i][k], b.0[i][k] + moved, 1e-12);
                assert_within("displacement", a.1[i][k], b.1[i][k], 1e-11);
            }
        }
    }
    let [housing, rings @ ..] = &shown[0];
    for ring in rings {
        assert_sits(housing, ring);
    }
}

/// The outside of a ring and the seat under it have one radius, and move on average by the same, radially too. Means
/// over nodes of two meshes differ by a part of the largest displacement.
fn assert_sits(housing: &(Vec<[f64; 3]>, Vec<[f64; 3]>), ring: &(Vec<[f64; 3]>, Vec<[f64; 3]>)) {
    let radius = |p: &[f64; 3]| p[0].hypot(p[1]);
    let outside = ring.0.iter().map(radius).fold(0.0, f64::max);
    let on = |p: &[f64; 3]| (radius(p) - outside).abs() < 1e-5;
    let z: Vec<f64> = ring.0.iter().filter(|p| on(p)).map(|p| p[2]).collect();
    let (low, high) = z.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), z| {
        (a.min(*z), b.max(*z))
    });
    let chosen = |(points, u): &(Vec<[f64; 3]>, Vec<[f64; 3]>)| {
        let within = |p: &[f64; 3]| on(p) && p[2] > low - 3e-4 && p[2] < high + 3e-4;
        let pairs = points.iter().zip(u).filter(|(p, _)| within(p));
        let radial = |p: &[f64; 3], u: &[f64; 3]| (p[0] * u[0] + p[1] * u[1]) / radius(p);
        pairs
            .map(|(p, u)| [u[0], u[1], u[2], radial(p, u)])
            .collect::<Vec<_>>()
    };
    let mean = |rows: &[[f64; 4]]| -> [f64; 4] {
        assert!(rows.len() > 50, "{} nodes from z {low} to {high}", rows.len());
        std::array::from_fn(|k| rows.iter().map(|row| row[k]).sum::<f64>() / rows.len() as f64)
    };
    let (of_ring, of_seat) = (chosen(ring), chosen(housing));
    let largest = of_ring
        .iter()
        .map(|[x, y, z, _]| x.hypot(*y).hypot(*z))
        .fold(0.0, f64::max);
    let (of_ring, of_seat) = (mean(&of_ring), mean(&of_seat));
    (0..4).for_each(|k| assert_within("seat", of_seat[k], of_ring[k], 0.03 * largest));
    assert!(
        of_ring[3] > 0.05 * largest,
        "the balls widen the ring: {of_ring:?} {largest}"
    );
}
