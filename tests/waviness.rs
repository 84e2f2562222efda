//! Which orders of waves show as which lines, through the whole program: rigid and coarse elastic rings under thrust.

use crate::util::lockstep::small_motion;
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, SCENE};

const RADIAL: &str = "[effects.radial_force]\nvalue = \"1 kN\"\ndirection = \"0 deg\"\n";
const AMPLITUDE: f64 = 0.1e-6;
const BPFO: f64 = 233.888;
const BPFI: f64 = 306.112;
const SHAFT: f64 = 30.0;

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Rings {
    Rigid,
    Elastic,
}

/// Equilibria in time under thrust at 1800 rpm with waves of an order on a ring, or without: 0.2 s, so that lines are 5
/// Hz apart, and 1000 instants.
fn ran(rings: Rings, waves: Option<(&str, usize)>) -> Dir {
    let motion = "[speed]\ninner = \"1800 rpm\"\n\n[quasi_static]\nduration = \"0.2 s\"\nstep = \"200 us\"\n\
                  output_every = 1000\n\n";
    let gauge = "[probes.gauge.g1]\nring = \"outer\"\nsurface = \"free\"\nazimuth = \"10 deg\"\nz = \"6 mm\"\n\
                 length = \"3 mm\"\nwidth = \"1.5 mm\"\ndirection = \"hoop\"\n\n";
    let waves = waves.map_or(String::new(), |(ring, order)| {
        format!("[[profiles.waviness]]\nring = \"{ring}\"\norder = {order}\namplitude = \"0.1 um\"\n\n")
    });
    let gauge = match rings {
        Rings::Rigid => "",
        Rings::Elastic => gauge,
    };
    assert!(SCENE.contains(RADIAL));
    let scene = SCENE
        .replace(RADIAL, "")
        .replace("[static]", &(motion.to_string() + gauge + &waves));
    let (dir, fixed): (Dir, &[&str]) = match rings {
        Rings::Rigid => (Dir::empty(), &RIGID),
        Rings::Elastic => (small_motion(), &[]),
    };
    dir.write("scene.toml", scene);
    dir.run("out", fixed);
    dir
}

/// Spectrum of a column: frequency, Hz, and amplitude, SI.
fn lines(dir: &Dir, probe: &str, file: &str, column: &str) -> Vec<[f64; 2]> {
    let outcome = dir.raceway(&["spectrum", "out", "--probe", probe]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let table = Table::read(dir, &format!("out/{file}.csv"));
    let pairs = table.column("frequency_hz").into_iter();
    pairs.zip(table.column(column)).map(|(f, a)| [f, a]).collect()
}

/// The highest line of a displacement of the shaft.
fn highest(dir: &Dir, axis: &str) -> [f64; 2] {
    let all = lines(
        dir,
        &format!("{axis}_m"),
        &format!("spectrum_{axis}"),
        "amplitude_m",
    );
    let above = |most: [f64; 2], line: [f64; 2]| if line[1] > most[1] { line } else { most };
    all.into_iter().skip(1).fold([0.0; 2], above)
}

/// What must show (Wardle 1988): the axis along which the shaft moves, and its frequency, Hz.
const LINES: [(&str, usize, &str, f64); 8] = [
    ("outer", 17, "x", BPFO),
    ("outer", 18, "z", BPFO),
    ("outer", 19, "x", BPFO),
    ("outer", 36, "z", 2.0 * BPFO),
    ("inner", 17, "x", BPFI - SHAFT),
    ("inner", 18, "z", BPFI),
    ("inner", 19, "x", BPFI + SHAFT),
    ("inner", 36, "z", 2.0 * BPFI),
];

fn check(rings: Rings, (ring, order, axis, frequency): (&str, usize, &str, f64), floor: [f64; 2]) {
    let dir = ran(rings, Some((ring, order)));
    for (own, floor) in ["x", "z"].into_iter().zip(floor) {
        let [found, amplitude] = highest(&dir, own);
        println!("{rings:?} {ring} {order} {own}: {amplitude:.3e} m at {found:.1} Hz");
        if own == axis {
            assert!(
                (found - frequency).abs() < 5.0,
                "{rings:?} {ring} {order}: {own} at {found} Hz, not {frequency}"
            );
            let least = if axis == "z" { 1.0 } else { 0.2 };
            assert!(amplitude > least * AMPLITUDE, "{ring} {order}: {amplitude}");
        } else {
            assert!(
                amplitude < floor,
                "{rings:?} {ring} {order}: {own} {amplitude} {floor}"
            );
        }
    }
}

/// Wrong: waves would show at other lines than those of the rules, or where nothing must move. Rigid rings: kZ along
/// the axis at k BPFO or k BPFI; kZ +- 1 across it, on the inner ring at k BPFI +- f; the other direction, and order 5,
/// stay at rest: 0.1 % of the amplitude, of second order in it over the approach of 5 um.
#[test]
fn orders_of_waves_show_at_their_lines_on_rigid_rings() {
    let floor = [1e-3 * AMPLITUDE; 2];
    for line in LINES {
        check(Rings::Rigid, line, floor);
    }
    for ring in ["inner", "outer"] {
        let dir = ran(Rings::Rigid, Some((ring, 5)));
        for axis in ["x", "z"] {
            let [_, amplitude] = highest(&dir, axis);
            assert!(amplitude < 1e-3 * AMPLITUDE, "{ring} {axis}: {amplitude}");
        }
    }
}

/// Wrong: elastic rings would show other lines, or their meshes be taken for waves. The floor is what smooth grooves
/// show as balls pass the elements: three sectors from ball to ball.
#[test]
fn orders_of_waves_show_at_their_lines_on_elastic_rings() {
    let smooth = ran(Rings::Elastic, None);
    let ripple = ["x", "z"].map(|axis| highest(&smooth, axis)[1]);
    println!("smooth elastic: {ripple:?}");
    assert!(ripple.iter().all(|a| *a < 0.05 * AMPLITUDE), "{ripple:?}");
    for line in [LINES[1], LINES[6]] {
        check(Rings::Elastic, line, ripple.map(|a| 2.0 * a + 1e-3 * AMPLITUDE));
    }
    // A gauge feels every ball that passes, smooth grooves or not.
    let strain = lines(&smooth, "g1", "spectrum_g1", "amplitude_strain");
    let most = strain.iter().skip(1).fold(
        [0.0; 2],
        |most: [f64; 2], line| {
            if line[1] > most[1] { *line } else { most }
        },
    );
    assert!((most[0] - BPFO).abs() < 5.0, "{most:?}");
}
