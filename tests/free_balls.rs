//! Free balls and a free cage through the whole program: tables that agree, the same bits after a resume, figures.

use crate::resume::resumed;
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, assert_close, with_line};

/// Balls between rigid rings under preload and a radial force: each has a slip and a power of its own. A cage with
/// little clearance meets them and its land.
const FREE: &str = "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n\
                    [effects.ball_drag]\ncoefficient = 0.5\ndensity = \"20 kg/m3\"\n\n\
                    [cage]\nmotion = \"free\"\nbore_diameter = \"62 mm\"\noutside_diameter = \"68.2 mm\"\n\
                    width = \"14 mm\"\nmass = \"12 g\"\npocket_clearance = \"0.2 um\"\n\
                    pocket_stiffness = \"2e8 N/m^1.5\"\nguidance = \"outer_land\"\nguidance_clearance = \"0.1 um\"\n\
                    friction = 0.1\nrestitution = 0.6\n\n\
                    [speed]\ninner = \"6000 rpm\"\n\n[dynamic]\nduration = \"0.3 ms\"\nstep = \"10 us\"";

fn whole() -> Dir {
    let dir = Dir::with_scene(&with_line("[static]", "[static]", FREE));
    dir.run("whole", &RIGID);
    dir
}

/// Wrong: tables would tell of another friction than acts: power of the balls against that of the bearing, its sum over
/// time against the ledger, orbits against the cage.
#[test]
fn tables_of_free_balls_agree() {
    let dir = whole();
    let [balls, shaft, energy] =
        ["balls", "shaft", "energy"].map(|name| Table::read(&dir, &format!("whole/{name}.csv")));
    let sides = ["inner", "outer"].map(|side| balls.column(&format!("{side}_friction_power_w")));
    let (orbits, steps) = (balls.column("orbit_rad_per_s"), balls.column("step"));
    let (powers, cage) = (
        shaft.column("friction_power_w"),
        shaft.column("cage_speed_rad_per_s"),
    );
    let losses = energy.column("friction_loss_j");
    let mut heat = 0.0;
    for (row, &step) in shaft.column("step").iter().enumerate() {
        let of_step: Vec<usize> = (0..steps.len()).filter(|&i| steps[i] == step).collect();
        let power: f64 = of_step.iter().map(|&i| sides[0][i] + sides[1][i]).sum();
        let orbit = of_step.iter().map(|&i| orbits[i]).sum::<f64>() / of_step.len() as f64;
        assert_close("orbit", cage[row], orbit, 1e-12);
        heat += 10e-6 * power;
        if row > 0 {
            assert_close("power", powers[row], power, 1e-12);
            assert_close("heat", losses[row], heat, 1e-9);
        }
    }
    assert!(heat > 0.0);
    // Rolling at the free contact angle, 14.93 deg: (1 - D cos(a)/d_m)/2 of the inner ring's speed, within 1 %.
    let inner = 6000.0 * std::f64::consts::PI / 30.0;
    assert_close("cage", cage[0] / inner, 0.4331, 0.01);
}

/// Wrong: forces of the cage would stand in one table and not in the other, or its energy in none.
#[test]
fn tables_of_a_cage_agree() {
    let dir = whole();
    let [balls, cage, energy] =
        ["balls", "cage", "energy"].map(|name| Table::read(&dir, &format!("whole/{name}.csv")));
    let [rolling, axial] = ["rolling", "axial"].map(|way| balls.column(&format!("pocket_{way}_n")));
    let steps = balls.column("step");
    let (largest, speed) = (
        cage.column("largest_pocket_force_n"),
        cage.column("speed_rad_per_s"),
    );
    for (row, &step) in cage.column("step").iter().enumerate() {
        let of_step = (0..steps.len()).filter(|&i| steps[i] == step);
        let expected = of_step.map(|i| rolling[i].hypot(axial[i])).fold(0.0, f64::max);
        assert_close("pocket", largest[row], expected, 1e-12);
        let turning = 0.5 * energy.column("kinetic_cage_j")[row];
        assert!(turning > 0.0 && speed[row] > 200.0, "{turning} {}", speed[row]);
    }
    assert!(largest.iter().any(|force| *force > 0.0));
    let loss = energy.column("cage_friction_loss_j");
    assert!(loss.windows(2).all(|pair| pair[1] >= pair[0]) && loss[loss.len() - 1] > 0.0);
}

/// Wrong: an equilibrium of rolling balls would show other friction than it balances, or a speed of kinematic balls.
#[test]
fn an_equilibrium_has_rolling_balls_and_their_torque() {
    let (balls, _) = FREE.split_once("[cage]").unwrap();
    let turning = format!("{balls}[speed]\ninner = \"6000 rpm\"\n\n[static]");
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &turning));
    dir.run("rest", &RIGID);
    let shaft = Table::read(&dir, "rest/shaft.csv");
    let torque = shaft.column("friction_torque_n_m")[0];
    let drag = 0.5 * 20.0 * 0.5 * std::f64::consts::FRAC_PI_4 * 9e-3f64.powi(2);
    let balls = Table::read(&dir, "rest/balls.csv");
    let orbits = balls.column("orbit_rad_per_s");
    // Power of the drive goes to friction and to the drag of balls on their pitch circle.
    let dragged: f64 = orbits.iter().map(|w| drag * (w * 32.512e-3).powi(3)).sum();
    let drive = torque * 6000.0 * std::f64::consts::PI / 30.0;
    assert_close(
        "power",
        shaft.column("friction_power_w")[0] + dragged,
        drive,
        1e-3,
    );
    let head = std::fs::read_to_string(dir.path("rest/balls.csv")).unwrap();
    assert!(
        !head.lines().next().unwrap().ends_with("spin_rad_per_s"),
        "a spin of kinematic balls"
    );
}

/// Wrong: a run that is cut would go on with other balls than it had.
#[test]
fn free_balls_continue_bit_for_bit() {
    let dir = whole();
    copy(&dir, "whole", "cut");
    std::fs::remove_file(dir.path("cut/summary.json")).unwrap();
    resumed(&dir, &["cut", "--step", "11", "--threads", "2"]);
    assert_same_run(&dir, "whole", "cut");
}

/// Wrong: what friction does would stand in tables alone.
#[test]
fn free_balls_have_figures() {
    let dir = whole();
    let outcome = dir.raceway(&["plot", "whole"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    for name in [
        "ball_slip",
        "ball_spin",
        "traction",
        "friction_power",
        "friction_power_of_all",
        "friction_torque",
        "friction_power_sum",
        "cage_speed",
        "cage_orbit",
        "cage_turning",
        "cage_forces",
    ] {
        assert!(dir.path(&format!("whole/figures/{name}.svg")).exists(), "{name}");
    }
}
