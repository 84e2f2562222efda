//! Stress histories under passing balls over a whole revolution of the balls, on several meshes: `scripts/test-slow`
//! runs it.

use std::f64::consts::PI;

use mesh::{MshFormat, RingSide};

use crate::util::rings::{self, Level};
use crate::util::tables::Table;
use crate::util::{Dir, with_line};

/// Distance of the balls, rad.
const PITCH: f64 = PI / 9.0;
/// Speed of the inner ring, rad/s.
const SPEED: f64 = 60.0 * PI;
/// Half the width of a pulse; 77 ms are a revolution of the balls.
const STEP: &str = "0.05 ms";

/// Histories of one run: probes `inner` and `outer`, half-way between two balls at the start.
struct Histories {
    time: Vec<f64>,
    /// How far the balls have turned, rad.
    turned: Vec<f64>,
    /// By ring and quantity.
    stress: [[Vec<f64>; 2]; 2],
}

const RINGS: [&str; 2] = ["inner", "outer"];
/// The most stressed depth feels both: von Mises stress, and the orthogonal shear, which changes sign.
const QUANTITIES: [&str; 2] = ["von_mises_pa", "stress_td_pa"];

fn run(level: Level, analysis: &str) -> Histories {
    let mut probes = String::new();
    for (ring, angle) in [("inner", 19.6), ("outer", 19.5)] {
        probes += &format!(
            "[probes.point.{ring}]\nring = \"{ring}\"\nazimuth = \"10 deg\"\ngroove_angle = \"{angle} deg\"\ndepth \
             = \"0.1 mm\"\n"
        );
    }
    let tables = format!("{analysis}\n[speed]\ninner = \"1800 rpm\"\n[stress]\nnear_field = true\n{probes}");
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &tables));
    for (side, name) in [(RingSide::Inner, "inner.msh"), (RingSide::Outer, "outer.msh")] {
        let mesh = rings::ring(side, level);
        dir.write(name, rings::file(&mesh, 1e-3, MshFormat::Binary));
    }
    dir.run("out", &[]);
    let (table, balls) = (
        Table::read(&dir, "out/probes.csv"),
        Table::read(&dir, "out/balls.csv"),
    );
    let azimuth = balls.column("azimuth_rad");
    let mut turned = vec![0.0];
    for pair in azimuth.chunks(18).collect::<Vec<_>>().windows(2) {
        let step = (pair[1][0] - pair[0][0]).rem_euclid(2.0 * PI);
        turned.push(turned.last().unwrap() + step);
    }
    Histories {
        time: table.column("time_s"),
        turned,
        stress: RINGS.map(|ring| QUANTITIES.map(|q| table.column(&format!("{ring}_{q}")))),
    }
}

/// Times at which a history rises and falls through a level, s.
fn crossings(time: &[f64], history: &[f64], level: f64) -> [Vec<f64>; 2] {
    let mut found = [Vec::new(), Vec::new()];
    for i in 1..history.len() {
        let [a, b] = [history[i - 1] - level, history[i] - level];
        if (a < 0.0) != (b < 0.0) {
            found[usize::from(a >= 0.0)].push(time[i - 1] + (time[i] - time[i - 1]) * a / (a - b));
        }
    }
    found
}

fn largest(history: &[f64]) -> f64 {
    history.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn gap(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

fn quasi_static(level: Level) -> Histories {
    run(
        level,
        &format!("[quasi_static]\nduration = \"77 ms\"\nstep = \"{STEP}\"\noutput_every = 1540"),
    )
}

const LEVELS: [Level; 3] = [
    Level {
        sectors: 60,
        groove: 6,
        shoulder: 1,
        thickness: 2,
    },
    rings::COARSE,
    Level {
        sectors: 126,
        groove: 10,
        shoulder: 2,
        thickness: 4,
    },
];

/// Wrong: what a point of a raceway feels as the balls pass would be that of the mesh. Three meshes of 3 to 7
/// elements from ball to ball: every instant, the height and the width of the pulses; and as many pulses as balls
/// pass.
#[test]
#[ignore = "three revolutions of the balls: minutes; scripts/test-slow runs it"]
fn histories_of_a_revolution_do_not_depend_on_the_mesh() {
    let runs = LEVELS.map(quasi_static);
    let finest = &runs[2];
    let end = *finest.turned.last().unwrap();
    assert!(
        (end / (2.0 * PI) - 1.0).abs() < 0.01,
        "{end} rad are a revolution"
    );
    let relative = SPEED * finest.time.last().unwrap() - end;
    for (r, ring) in RINGS.iter().enumerate() {
        // Balls start half a pitch from the point.
        let passed = ((if r == 0 { relative } else { end }) / PITCH + 0.5).floor() as usize;
        if r == 1 {
            assert_eq!(passed, 18, "on the outer ring");
        }
        for (run, level) in runs.iter().zip(LEVELS) {
            let [von_mises, _] = &run.stress[r];
            let height = largest(&finest.stress[r][0]);
            let [up, down] = crossings(&run.time, von_mises, 0.5 * height);
            let widths: Vec<f64> = up.iter().zip(&down).map(|(u, d)| d - u).collect();
            let [fine_up, fine_down] = crossings(&finest.time, &finest.stress[r][0], 0.5 * height);
            assert_eq!([up.len(), down.len()], [passed; 2], "{ring}, {level:?}: pulses");
            let width_gap = widths
                .iter()
                .zip(fine_up.iter().zip(&fine_down))
                .map(|(w, (u, d))| (w / (d - u) - 1.0).abs())
                .fold(0.0, f64::max);
            let peak = largest(von_mises) / height - 1.0;
            let gaps =
                [0, 1].map(|q| gap(&run.stress[r][q], &finest.stress[r][q]) / largest(&finest.stress[r][q]));
            println!(
                "{ring}, {} sectors: {} pulses of {:.1} us, peak {:.1} MPa; against the finest: peak {peak:+.4}, \
                 widths {width_gap:.4}, every instant {gaps:.4?} (von Mises, orthogonal shear)",
                level.sectors,
                up.len(),
                1e6 * widths.iter().sum::<f64>() / widths.len() as f64,
                1e-6 * largest(von_mises)
            );
            assert!(peak.abs() < 0.02 && width_gap < 0.03, "{ring}, {level:?}");
            assert!(gaps.iter().all(|g| *g < 0.03), "{ring}, {level:?}: {gaps:?}");
        }
    }
}

/// Wrong: a motion would show other stress than the equilibria it passes through: from equilibrium, at constant
/// speed, inertia does little.
#[test]
#[ignore = "a fifth of a revolution with inertia: a minute; scripts/test-slow runs it"]
fn a_motion_has_the_histories_of_its_equilibria() {
    let still = run(
        LEVELS[0],
        &format!("[quasi_static]\nduration = \"15.4 ms\"\nstep = \"{STEP}\"\noutput_every = 308"),
    );
    let motion = run(
        LEVELS[0],
        "[dynamic]\nduration = \"15.4 ms\"\nstep = \"0.025 ms\"\noutput_every = 616",
    );
    for (r, ring) in RINGS.iter().enumerate() {
        for (q, quantity) in QUANTITIES.iter().enumerate() {
            let own: Vec<f64> = motion.stress[r][q].iter().copied().step_by(2).collect();
            assert_eq!(own.len(), still.stress[r][q].len());
            let gap = gap(&own, &still.stress[r][q]) / largest(&still.stress[r][q]);
            println!("{ring} {quantity}: motion and equilibria differ by {gap:.4} of the peak");
            assert!(gap < 0.03, "{ring} {quantity}: {gap}");
        }
    }
}
