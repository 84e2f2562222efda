//! `output.stress = "integration_points"`: the stress of every element, unaveraged, in step files and their views.

use std::sync::OnceLock;

use checkpoint::{Grid, StepRecord, read_any_step, read_mesh, read_step};
use contact::near_field::in_axes;
use contact::{Groove, RingPoint, Side};
use fem::{Material, StressRecovery, von_mises};
use mesh::{ElementKind, Mesh};

use crate::util::lockstep::small_motion;
use crate::util::tables::Table;
use crate::util::{Dir, Files, with_line};

/// Points of a hex8 element.
const POINTS: usize = 8;
/// Steel of the tests' scene.
const STEEL: [f64; 3] = [207e9, 0.3, 7800.0];
/// Speed of the small motion, 12 000 rpm, rad/s.
const SPEED: f64 = 400.0 * std::f64::consts::PI;

/// Ten steps of the small motion, every fifth written in f64: `space`, and `own` with the inner ring in its own frame.
fn moved() -> Dir {
    static FILES: OnceLock<Files> = OnceLock::new();
    Dir::with_files(FILES.get_or_init(|| {
        let dir = small_motion();
        for (out, frame) in [("space", "space"), ("own", "own_frame")] {
            let frame = format!("output.inner_ring={frame}");
            let mut arguments = vec!["--set", &frame];
            for setting in [
                "dynamic.duration=0.2 ms",
                "dynamic.output_every=5",
                "output.stress=integration_points",
                "output.precision=f64",
            ] {
                arguments.extend(["--set", setting]);
            }
            dir.run(out, &arguments);
        }
        dir.snapshot()
    }))
}

fn step(dir: &Dir, out: &str, step: u64) -> StepRecord {
    read_step(&dir.path(&format!("{out}/step_{step:06}.hdf"))).unwrap()
}

/// Cells and tensors of a body, and the whole record checked for its shape.
fn tensors(grid: &Grid, record: &StepRecord, body: u8) -> Vec<[f64; 6]> {
    let stress = record.cells.stress_integration_points.as_ref().unwrap();
    assert_eq!(stress.points_per_cell, POINTS);
    let all = stress.values.as_chunks::<6>().0.chunks_exact(POINTS);
    assert_eq!(all.len(), grid.types.len());
    let own = all.zip(&grid.body).filter(|(_, b)| **b == body);
    own.flat_map(|(cell, _)| cell.to_vec()).collect()
}

/// The mesh of a ring as the result shows it, and the first of its points.
fn ring(grid: &Grid, body: u8) -> (Mesh, usize) {
    let cells: Vec<usize> = (0..grid.types.len()).filter(|&c| grid.body[c] == body).collect();
    let nodes =
        |cell: usize| &grid.connectivity[grid.offsets[cell] as usize..grid.offsets[cell + 1] as usize];
    let used: Vec<usize> = cells
        .iter()
        .flat_map(|&c| nodes(c))
        .map(|&n| n as usize)
        .collect();
    let (first, last) = (*used.iter().min().unwrap(), *used.iter().max().unwrap());
    let mesh = Mesh {
        kind: ElementKind::Hex8,
        nodes: grid.points[first..=last].to_vec().into(),
        connectivity: used.iter().map(|node| node - first).collect(),
        groups: Default::default(),
    };
    (mesh, first)
}

#[track_caller]
fn assert_close(found: &[[f64; 6]], expected: &[[f64; 6]]) {
    assert_eq!(found.len(), expected.len());
    let largest = expected
        .as_flattened()
        .iter()
        .fold(0.0, |m: f64, s| m.max(s.abs()));
    assert!(largest > 1e6, "the ring is loaded: {largest}");
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        let error = (0..6).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max);
        // Displacements of 30 um in places of 40 mm lose five digits to round-off in the strain.
        assert!(
            error < 1e-9 * largest,
            "tensor {i}: {a:?} and {b:?}, {error} of {largest}"
        );
    }
}

/// Wrong: what a reader finds would not be the stress that belongs to the displacement in the same file, element by
/// element, or balls would show stress.
#[test]
fn the_stress_is_that_of_the_displacement_in_the_file() {
    let dir = moved();
    let grid = read_mesh(&dir.path("own")).unwrap();
    let record = step(&dir, "own", 10);
    assert!(record.points.stress.is_none() && record.points.von_mises.is_none());
    let [e, nu, density] = STEEL;
    let steel = Material::new(e, nu, density).unwrap();
    for body in [0, 1] {
        let (mesh, first) = ring(&grid, body);
        let u = record.points.displacement[first..first + mesh.nodes.len()].as_flattened();
        let expected = StressRecovery::new(&mesh, &steel).unwrap().integration_points(u);
        assert_close(&tensors(&grid, &record, body), &expected);
    }
    let balls = tensors(&grid, &record, 2);
    assert_eq!(balls, vec![[0.0; 6]; 18 * POINTS], "balls have no stress");
    let largest = record.cells.von_mises_largest.unwrap();
    let stress = &record.cells.stress_integration_points.unwrap().values;
    for (cell, value) in stress.as_chunks::<6>().0.chunks_exact(POINTS).zip(largest) {
        let own = cell.iter().map(|&s| von_mises(s)).fold(0.0, f64::max);
        assert!((own - value).abs() <= 1e-12 * own, "{own} and {value}");
    }
}

/// Wrong: tensors of the turning ring would be shown in the axes of its own frame.
#[test]
fn the_inner_ring_is_turned_with_its_stress() {
    let dir = moved();
    let grid = read_mesh(&dir.path("own")).unwrap();
    let (space, own) = (step(&dir, "space", 10), step(&dir, "own", 10));
    let (sin, cos) = (SPEED * own.time).sin_cos();
    assert!(sin > 0.2, "the ring has turned");
    let turned: Vec<[f64; 6]> = tensors(&grid, &own, 0)
        .into_iter()
        .map(|[xx, yy, zz, xy, yz, xz]| {
            // R S R^T by its definition.
            let (r, s) = (
                [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]],
                [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]],
            );
            let entry = |i: usize, j: usize| -> f64 {
                (0..9).map(|k| r[i][k / 3] * s[k / 3][k % 3] * r[j][k % 3]).sum()
            };
            [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].map(|(i, j)| entry(i, j))
        })
        .collect();
    assert_close(&tensors(&grid, &space, 0), &turned);
    assert_eq!(
        tensors(&grid, &space, 1),
        tensors(&grid, &own, 1),
        "the outer ring stands still"
    );
}

/// Wrong: a reader of the file could not tell the order of points and components, or what it holds.
#[test]
fn the_file_says_what_it_holds() {
    let dir = moved();
    let n = read_mesh(&dir.path("own")).unwrap().types.len();
    let info = dir.raceway(&["info", "own/step_000005.hdf"]).stdout;
    for part in [
        format!("/VTKHDF/CellData/stress_integration_points float64 [{n}, 48]"),
        format!("/VTKHDF/CellData/von_mises_largest float64 [{n}]"),
    ] {
        assert!(info.contains(&part), "{info} lacks {part}");
    }
    assert!(!info.contains("PointData/stress"), "{info}");
    let layout = step(&dir, "own", 5)
        .cells
        .stress_integration_points
        .unwrap()
        .layout;
    for part in [
        "xx yy zz xy yz xz",
        "12 (hex8): 8 points",
        "first reference coordinate fastest",
    ] {
        assert!(layout.contains(part), "{layout} lacks {part}");
    }
}

/// Wrong: `check` would promise another size than the files have.
#[test]
fn the_forecast_counts_the_cells() {
    let dir = moved();
    let long = [
        "--set",
        "output.stress=integration_points",
        "--set",
        "output.precision=f64",
    ];
    let outcome = dir.raceway(&[&["check", "scene.toml"], &long[..]].concat());
    let line = outcome.stdout.lines().find(|line| line.starts_with("output"));
    let words: Vec<&str> = line.unwrap().split_whitespace().collect();
    let unit = match words[3] {
        "kB" => 1e3,
        "MB" => 1e6,
        other => panic!("{other} in {words:?}"),
    };
    let forecast = unit * words[2].parse::<f64>().unwrap();
    let bytes = std::fs::metadata(dir.path("own/step_000010.hdf")).unwrap().len() as f64;
    assert!(
        (forecast / bytes - 1.0).abs() < 0.02,
        "{forecast} bytes forecast, {bytes} written"
    );
}

/// Wrong: packing or exporting would lose the stress or change it.
#[test]
fn packs_and_exports_keep_it() {
    let dir = moved();
    let (before, grid) = (step(&dir, "own", 5), read_mesh(&dir.path("own")).unwrap());
    let packed = dir.raceway(&["pack", "own", "--keep", "1"]);
    assert_eq!(packed.code, Some(0), "{}", packed.stderr);
    assert!(
        packed.stdout.contains(" packed, 1 pack in own;"),
        "{}",
        packed.stdout
    );
    assert!(!dir.path("own/step_000005.hdf").exists());
    assert!(read_any_step(&dir.path("own"), 5).unwrap() == before);
    let outcome = dir.raceway(&["export", "own", "--to", "csv", "--steps", "5"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = Table::read(&dir, "own/export/step_000005_integration_points.csv");
    let rings: Vec<[f64; 6]> = [0, 1].iter().flat_map(|&b| tensors(&grid, &before, b)).collect();
    let column = |name: &str| table.column(name);
    assert_eq!(table.rows.len(), rings.len(), "a row per point, none for balls");
    assert_eq!(
        column("stress_yz_pa"),
        rings.iter().map(|s| s[4]).collect::<Vec<_>>()
    );
    let von_mises: Vec<f64> = rings.iter().map(|&s| von_mises(s)).collect();
    assert_eq!(column("von_mises_pa"), von_mises);
    assert_eq!(
        column("point")[..9],
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 0.0]
    );
    let (mesh, _) = ring(&grid, 0);
    let [e, nu, density] = STEEL;
    let steel = Material::new(e, nu, density).unwrap();
    let places = StressRecovery::new(&mesh, &steel).unwrap().point_positions();
    for (i, name) in ["x_m", "y_m", "z_m"].iter().enumerate() {
        for (place, found) in places.iter().zip(column(name)) {
            assert!((place[i] - found).abs() < 1e-15, "{name}: {place:?} and {found}");
        }
    }
    let outcome = dir.raceway(&["export", "own", "--to", "vtu", "--steps", "5"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let text = dir.text("own/export/step_000005.vtu");
    assert!(
        text.contains("Name=\"stress_integration_points\" NumberOfComponents=\"48\" ComponentName0=\"0_XX\"")
    );
    assert!(text.contains("ComponentName47=\"7_XZ\""));
}

/// Wrong: the near field would be missing at integration points, be that of another place, or be added where no
/// contact is. What it changes there is what it changes at probes in the same points, which find their stress in
/// another way; far from contacts no bit changes.
#[test]
fn the_near_field_is_added_at_integration_points() {
    let dir = Dir::with_meshes();
    let settings = "[static]\n[output]\nstress = \"integration_points\"\nprecision = \"f64\"\n";
    let scene = |tables: &str| with_line("[static]", "[static]", &format!("{settings}{tables}"));
    // A short reach: with the default one every point of this coarse mesh is near some ball.
    let near_field = "near_field = true\nnear_field_reach = 1.0\n";
    dir.write("scene.toml", scene(""));
    dir.run("off", &[]);
    dir.write("scene.toml", scene(&format!("[stress]\n{near_field}")));
    dir.run("on", &[]);
    let grid = read_mesh(&dir.path("on")).unwrap();
    let [e, nu, density] = STEEL;
    let steel = Material::new(e, nu, density).unwrap();
    let (off, on) = (step(&dir, "off", 0), step(&dir, "on", 0));
    let balls = Table::read(&dir, "off/balls.csv");
    let mut probes = String::new();
    let mut changes = Vec::new();
    for (body, name, mut groove) in grooves() {
        let mesh = ring(&grid, body).0;
        // Rings are symmetric, and shown where they touch: the inner one is shifted along the axis.
        let z = mesh.nodes.iter().map(|x| x[2]);
        groove.centre_z =
            0.5 * (z.clone().fold(f64::INFINITY, f64::min) + z.fold(f64::NEG_INFINITY, f64::max));
        let places = StressRecovery::new(&mesh, &steel).unwrap().point_positions();
        let (off, on) = (tensors(&grid, &off, body), tensors(&grid, &on, body));
        let change = |i: usize| -> [f64; 6] { std::array::from_fn(|c| on[i][c] - off[i][c]) };
        let size = |s: [f64; 6]| s.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let most = (0..on.len()).max_by(|&i, &j| size(change(i)).total_cmp(&size(change(j))));
        let point = RingPoint::of(&groove, places[most.unwrap()]);
        let peak = balls.column(&format!("{name}_peak_pressure_pa"))[0];
        assert!(
            size(change(most.unwrap())) > 0.02 * peak,
            "{name}: {:?}",
            change(most.unwrap())
        );
        let untouched = (0..on.len()).filter(|&i| on[i] == off[i]).count();
        assert!(
            untouched > on.len() / 10,
            "{name}: {untouched} of {} points are far from contacts",
            on.len()
        );
        probes += &format!(
            "[probes.point.{name}]\nring = \"{name}\"\nazimuth = \"{} rad\"\ngroove_angle = \"{} rad\"\ndepth = \"{} \
             m\"\n",
            point.azimuth, point.angle, point.depth
        );
        changes.push((name, in_axes(change(most.unwrap()), &point.axes(&groove)), peak));
    }
    for (out, stress) in [("probes_off", ""), ("probes_on", near_field)] {
        dir.write("scene.toml", scene(&format!("[stress]\n{stress}{probes}")));
        dir.run(out, &[]);
    }
    let [off, on] = ["probes_off", "probes_on"].map(|out| Table::read(&dir, &format!("{out}/probes.csv")));
    for (name, change, peak) in changes {
        for (c, ij) in ["gg", "tt", "dd", "gt", "td", "gd"].iter().enumerate() {
            let column = format!("{name}_stress_{ij}_pa");
            let probed = on.column(&column)[0] - off.column(&column)[0];
            // Places were written as text: some units of 1e-16 of the ring, over an ellipse.
            assert!(
                (probed - change[c]).abs() < 1e-9 * peak,
                "{column}: {probed} and {} Pa",
                change[c]
            );
        }
    }
}

/// Bodies, names and grooves of the rings.
fn grooves() -> [(u8, &'static str, Groove); 2] {
    let groove = |side, centre_radius, groove_radius| Groove {
        side,
        centre_radius,
        groove_radius,
        centre_z: 0.0,
    };
    [
        (0, "inner", groove(Side::Inner, 0.5 * 56.01e-3 + 4.65e-3, 4.65e-3)),
        (
            1,
            "outer",
            groove(Side::Outer, 0.5 * 74.037e-3 - 4.75e-3, 4.75e-3),
        ),
    ]
}
