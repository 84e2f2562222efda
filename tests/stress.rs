//! Near field, point probes, profiles and stress cycles through the whole program.

use std::f64::consts::PI;

use checkpoint::read_step;
use contact::halfspace::{EllipticPressure, subsurface};

use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, RIGID, assert_close, assert_within, with_line};

/// Columns of a point's stress in the axes of the raceway.
const TENSOR: [&str; 6] = ["gg", "tt", "dd", "gt", "td", "gd"];

/// The tests' scene with another analysis and more tables.
fn scene(analysis: &str, tables: &str) -> String {
    with_line("[static]", "[static]", &format!("{analysis}\n{tables}"))
}

fn near_field() -> &'static str {
    "[stress]\nnear_field = true\n"
}

/// A point under ball 0 of a ring, and a profile through it along the groove and in depth.
fn under_ball(ring: &str, angle: f64, depth: f64) -> String {
    format!(
        "[probes.point.p]\nring = \"{ring}\"\nazimuth = \"0 deg\"\ngroove_angle = \"{angle} rad\"\ndepth = \"{depth} \
         m\"\n\
         [probes.profile.arc]\nring = \"{ring}\"\nazimuth = \"0 deg\"\ngroove_angle = [\"{} rad\", \"{} \
         rad\"]\npoints = 81\n\
         [probes.profile.down]\nring = \"{ring}\"\nazimuth = \"0 deg\"\ngroove_angle = \"{angle} rad\"\n\
         depth = [\"0 m\", \"{} m\"]\npoints = 3\n",
        angle - 0.3,
        angle + 0.3,
        2.0 * depth
    )
}

/// Rows of a profile: values of one column.
fn profile(dir: &Dir, out: &str, name: &str, column: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(dir.path(&format!("{out}/profiles.csv"))).unwrap();
    let header = reader.headers().unwrap().clone();
    let place = |name: &str| {
        header
            .iter()
            .position(|h| h == name)
            .unwrap_or_else(|| panic!("{name}: {header:?}"))
    };
    let (profile, column) = (place("profile"), place(column));
    let rows = reader.records().map(Result::unwrap);
    let own = rows.filter(|row| &row[profile] == name);
    own.map(|row| row[column].parse().unwrap()).collect()
}

/// If this failed, the stress under a ball would not be Hertz's on a coarse mesh, or be so without being asked for:
/// von Mises at the depth of its largest value, the pressure on the surface and the ellipse along the groove, within
/// 3 % of the peak (mesh: some 5 elements from ball to ball).
#[test]
fn the_near_field_gives_the_stress_under_a_ball() {
    let dir = Dir::with_meshes();
    dir.run("plain", &[]);
    let balls = Table::read(&dir, "plain/balls.csv");
    for ring in ["inner", "outer"] {
        let of_ball = |name: &str| balls.column(&format!("{ring}_{name}"))[0];
        let (angle, peak) = (of_ball("contact_angle_rad"), of_ball("peak_pressure_pa"));
        let axes = [of_ball("semi_axis_groove_m"), of_ball("semi_axis_rolling_m")];
        let largest = subsurface(axes.into(), 0.3).von_mises;
        let depth = largest.depth_over_minor_axis * axes[1];
        let (near, far) = (format!("near_{ring}"), format!("far_{ring}"));
        let tables = under_ball(ring, angle, depth);
        dir.write(
            "scene.toml",
            scene("[static]", &format!("{}{tables}", near_field())),
        );
        dir.run(&near, &[]);
        dir.write("scene.toml", scene("[static]", &tables));
        dir.run(&far, &[]);
        let expected = largest.over_peak_pressure * peak;
        let at_point =
            |out: &str, column: &str| Table::read(&dir, &format!("{out}/probes.csv")).column(column)[0];
        assert_within(
            "von Mises",
            at_point(&near, "p_von_mises_pa"),
            expected,
            0.03 * expected,
        );
        assert!(at_point(&far, "p_von_mises_pa") < 0.1 * expected);
        // On the raceway the pressure is the half ellipse, and outside it nothing.
        let angles = profile(&dir, &near, "arc", "groove_angle_rad");
        let radius = if ring == "inner" { 4.65e-3 } else { 4.75e-3 };
        for (a, dd) in angles.iter().zip(profile(&dir, &near, "arc", "stress_dd_pa")) {
            let share: f64 = 1.0 - (radius * (a - angle) / axes[0]).powi(2);
            assert_within("pressure", -dd, peak * share.max(0.0).sqrt(), 0.03 * peak);
        }
        assert_eq!(
            profile(&dir, &near, "down", "von_mises_pa")[1],
            at_point(&near, "p_von_mises_pa"),
            "the same point, as a probe and in a profile"
        );
        let row = Table::read(&dir, &format!("{near}/probes.csv"));
        let [gg, tt, dd, ..] = TENSOR.map(|ij| row.column(&format!("p_stress_{ij}_pa"))[0]);
        let principal = [1, 2, 3].map(|i| row.column(&format!("p_principal_{i}_pa"))[0]);
        assert_close("trace", gg + tt + dd, principal.iter().sum(), 1e-12);
        assert_close(
            "hydrostatic",
            row.column("p_hydrostatic_pa")[0],
            (gg + tt + dd) / 3.0,
            1e-12,
        );
        assert_close(
            "shear",
            row.column("p_maximum_shear_pa")[0],
            0.5 * (principal[0] - principal[2]),
            1e-12,
        );
        // The summary says the same of the raceway; its ball is of the same steel.
        let told = summary(&dir, &near);
        for body in ["ball", "ring"] {
            let stress = number(
                &told,
                &format!("/subsurface/{ring}/{body}/von_mises/over_peak_pressure"),
            );
            assert_close("ratio", stress, largest.over_peak_pressure, 1e-6);
        }
        assert!(number(&told, "/timing_s/near_field") > 0.0);
        assert!(summary(&dir, &far).pointer("/timing_s/near_field").is_none());
    }
}

/// If this failed, probes and step files would disagree about the near field: the same bits, at rest and in motion,
/// and it is there.
#[test]
fn a_node_probe_has_the_near_field_of_the_step_file() {
    let probe = "[probes.node.n]\nring = \"RING\"\nazimuth = \"0 deg\"\ngroove_angle = \"19 deg\"\naxes \
                 = \"cartesian\"\n\
                 [output]\nprecision = \"f64\"\n";
    let motion = "[dynamic]\nduration = \"40 us\"\nstep = \"20 us\"\n[speed]\ninner = \"1800 rpm\"";
    for (analysis, last, ring) in [
        ("[static]", 0, "inner"),
        (motion, 2, "inner"),
        (motion, 2, "outer"),
    ] {
        let dir = Dir::with_meshes();
        let tables = probe.replace("RING", ring);
        let mut found = Vec::new();
        for (out, stress) in [("far", ""), ("near", near_field())] {
            dir.write("scene.toml", scene(analysis, &format!("{stress}{tables}")));
            dir.run(out, &[]);
            let row = Table::read(&dir, &format!("{out}/probes.csv")).step(last);
            let names = ["xx", "yy", "zz", "xy", "yz", "xz"];
            let probed = names.map(|ij| row.column(&format!("n_stress_{ij}_pa"))[0]);
            let points = read_step(&dir.path(&format!("{out}/step_{last:06}.hdf")))
                .unwrap()
                .points;
            let told = summary(&dir, out);
            let first = if ring == "outer" {
                number(&told, "/dofs/inner") as usize / 3
            } else {
                0
            };
            let node = first + number(&told, "/probes/0/node") as usize;
            // The file's stress may come from the weights of a sector: equal to rounding.
            let stress = points.stress.unwrap();
            let rounding = 1e-12 * stress.as_flattened().iter().fold(0.0f64, |m, s| m.max(s.abs()));
            for (found, expected) in probed.iter().zip(stress[node]) {
                assert!(
                    (found - expected).abs() <= rounding,
                    "{analysis} {out}: {found} Pa, {expected} Pa in the file"
                );
            }
            found.push(row.column("n_von_mises_pa")[0]);
        }
        assert!(found[1] > 2.0 * found[0], "{analysis}: {found:?}");
        // Without stress in the step files the probe's own near field is in the timing table.
        dir.run("probe", &["--set", "output.stress=none"]);
        assert!(number(&summary(&dir, "probe"), "/timing_s/near_field") > 0.0);
    }
}

/// If this failed, histories would have jumps or pulses that no ball makes. Balls roll by over 40 degrees of the
/// cage, half an ellipse a step: the orthogonal shear at its depth has Hertz's range, from ball to ball, the pulses
/// are those of the kinematics on both rings, the history is smooth, and the counted cycles have the same range.
#[test]
fn passing_balls_leave_pulses_of_hertz_size() {
    let dir = Dir::with_meshes();
    dir.run("plain", &["--set", "effects.radial_force.value=0 kN"]);
    let balls = Table::read(&dir, "plain/balls.csv");
    let mut probes = String::new();
    for ring in ["inner", "outer"] {
        let of_ball = |name: &str| balls.column(&format!("{ring}_{name}"))[0];
        let axes = [of_ball("semi_axis_groove_m"), of_ball("semi_axis_rolling_m")];
        let depth = subsurface(axes.into(), 0.3)
            .orthogonal_shear
            .depth_over_minor_axis
            * axes[1];
        probes += &format!(
            "[probes.point.{ring}]\nring = \"{ring}\"\nazimuth = \"10 deg\"\ngroove_angle = \"{} rad\"\ndepth \
             = \"{depth} m\"\n",
            of_ball("contact_angle_rad")
        );
    }
    let analysis = "[quasi_static]\nduration = \"8.4 ms\"\nstep = \"0.028 ms\"\noutput_every = 300\n[speed]\ninner \
                    = \"1800 rpm\"";
    dir.write(
        "scene.toml",
        scene(analysis, &format!("{}{probes}", near_field())),
    );
    dir.run("out", &["--set", "effects.radial_force.value=0 kN"]);
    let (table, rolling) = (
        Table::read(&dir, "out/probes.csv"),
        Table::read(&dir, "out/balls.csv"),
    );
    let azimuths: Vec<f64> = rolling.rows.chunks(18).map(|rows| rows[0][3]).collect();
    let end = *table.column("time_s").last().unwrap();
    let turned = (azimuths.last().unwrap() - azimuths[0]).rem_euclid(2.0 * PI);
    assert_eq!(rolling.columns[3], "azimuth_rad");
    let outcome = dir.raceway(&["cycles", "out"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for ring in ["inner", "outer"] {
        let of_ball = |name: &str| balls.column(&format!("{ring}_{name}"))[0];
        let axes = [of_ball("semi_axis_groove_m"), of_ball("semi_axis_rolling_m")];
        let amplitude =
            subsurface(axes.into(), 0.3).orthogonal_shear.over_peak_pressure * of_ball("peak_pressure_pa");
        let history = table.column(&format!("{ring}_stress_td_pa"));
        let (low, high) = history
            .iter()
            .fold((0.0f64, 0.0f64), |(l, h), x| (l.min(*x), h.max(*x)));
        // At every instant it is Hertz's stress at the place of the nearest ball.
        let (sign, centre, groove) = if ring == "inner" {
            (-1.0, 32.655e-3, 4.65e-3)
        } else {
            (1.0, 32.2685e-3, 4.75e-3)
        };
        let radius = centre + sign * groove * of_ball("contact_angle_rad").cos();
        let depth = subsurface(axes.into(), 0.3)
            .orthogonal_shear
            .depth_over_minor_axis
            * axes[1];
        let field = EllipticPressure::of_peak(of_ball("peak_pressure_pa"), axes.into(), 0.3);
        for ((time, azimuth), found) in table.column("time_s").iter().zip(&azimuths).zip(&history) {
            let ring_turned = if ring == "inner" {
                1800.0 * PI / 30.0 * time
            } else {
                0.0
            };
            let ahead = PI / 18.0 + ring_turned - azimuth;
            let nearest = ahead - PI / 9.0 * (ahead / (PI / 9.0)).round();
            let expected = field.stress([0.0, radius * nearest, depth])[4];
            assert_within(&format!("{ring}, {time} s"), *found, expected, 0.04 * amplitude);
        }
        // Pulses: rises of the von Mises stress through half of its largest value.
        let von_mises = table.column(&format!("{ring}_von_mises_pa"));
        let half = 0.5 * von_mises.iter().copied().fold(0.0, f64::max);
        let pulses = von_mises
            .windows(2)
            .filter(|w| w[0] < half && w[1] >= half)
            .count();
        // Balls pass where their azimuth on the ring is that of the point: every 20 degrees from 10 degrees on.
        let ring_turned = if ring == "inner" {
            1800.0 * PI / 30.0 * end
        } else {
            0.0
        };
        let passed = ((turned - ring_turned).abs() + PI / 18.0) / (PI / 9.0);
        assert_eq!(pulses, passed as usize, "{ring}: {passed} balls");
        // Half an ellipse a step: no step changes by more than the steepest slope of Hertz's field, about two
        // amplitudes an ellipse.
        let jump = history
            .windows(2)
            .map(|w| (w[1] - w[0]).abs())
            .fold(0.0, f64::max);
        assert!(jump < 1.6 * amplitude, "{ring}: {jump:e} of {amplitude:e}");
        let text = dir.text("out/stress_ranges.csv");
        let row = text
            .lines()
            .find(|line| line.starts_with(&format!("{ring}_stress_td_pa,")));
        let cells: Vec<f64> = row
            .unwrap()
            .split(',')
            .skip(1)
            .map(|x| x.parse().unwrap())
            .collect();
        assert_close("amplitude", cells[4], 0.5 * (high - low), 1e-12);
        let counted = dir.text("out/stress_cycles.csv");
        let own = counted
            .lines()
            .filter(|line| line.starts_with(&format!("{ring}_stress_td_pa,")));
        let large: f64 = own
            .map(|line| {
                line.split(',')
                    .skip(1)
                    .map(|x| x.parse().unwrap())
                    .collect::<Vec<f64>>()
            })
            .filter(|cycle| cycle[0] > 1.3 * amplitude)
            .map(|cycle| cycle[2])
            .sum();
        assert!(
            (large - pulses as f64).abs() <= 0.5,
            "{ring}: {large} cycles, {pulses} pulses"
        );
    }
}

/// If this failed, a slip would cost a run, or be passed over in silence.
#[test]
fn wrong_requests_are_refused() {
    let dir = Dir::with_meshes();
    let point = "[probes.point.p]\nring = \"outer\"\nazimuth = \"0 deg\"\ngroove_angle = \"10 deg\"\ndepth = \"0 \
                 mm\"\n";
    dir.write(
        "scene.toml",
        scene("[static]", &format!("{}{point}", near_field())),
    );
    for (set, text) in [
        (
            "contact.mode=facet",
            "stress.near_field replaces the stress of a contact patch, which only contact.mode = \"patch\" has",
        ),
        (
            "stress.near_field_reach=0.5",
            "stress.near_field_reach is 0.5; expected 1 to 20 semi-axes of the contact patch",
        ),
        (
            "probes.point.p.depth=-1 mm",
            "probes.point.p.depth is -1 mm; expected 0, the raceway, or more",
        ),
        (
            "probes.point.p.groove_angle=100 deg",
            "probes.point.p.groove_angle is 100.000 deg; expected -90 to 90 deg",
        ),
        (
            "probes.point.p.depth=9 mm",
            "probes.point.p: the point at azimuth 0.000 deg, groove angle 10.000 deg, depth 9.0000 mm is not in the \
             mesh of the outer",
        ),
    ] {
        let outcome = dir.raceway(&["run", "scene.toml", "--out", "refused", "--set", set]);
        assert_eq!(outcome.code, Some(2), "{set}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(text), "{set}: {}", outcome.stderr);
        assert!(!dir.path("refused").exists());
    }
    dir.write("scene.toml", scene("[modes]\nnumber = 4", near_field()));
    let outcome = dir.raceway(&["run", "scene.toml", "--out", "refused"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(
        outcome
            .stderr
            .contains("stress.near_field needs contact forces, and [modes] has none; remove near_field"),
        "{}",
        outcome.stderr
    );
    assert!(!dir.path("refused").exists());
    let reach = scene("[static]", "[stress]\nnear_field_reach = 3.0\n");
    dir.write("scene.toml", reach);
    let outcome = dir.raceway(&["check", "scene.toml"]);
    assert!(
        outcome
            .stderr
            .contains("near_field_reach is given without near_field = true"),
        "{}",
        outcome.stderr
    );
    dir.write("scene.toml", scene("[static]", ""));
    dir.run("none", &RIGID);
    let outcome = dir.raceway(&["cycles", "none"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    assert!(
        outcome
            .stderr
            .contains("expected the results of a scene with [probes.node.*]"),
        "{}",
        outcome.stderr
    );
}
