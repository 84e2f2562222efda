//! Free balls through the whole program: tables that agree, the same bits after a resume, figures.

use crate::resume::resumed;
use crate::util::lockstep::{assert_same_run, copy};
use crate::util::tables::Table;
use crate::util::{Dir, RIGID, assert_close, with_line};

/// Balls between rigid rings under preload and a radial force: each has a slip and a power of its own.
const FREE: &str = "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.07\n\n\
                    [effects.ball_drag]\ncoefficient = 0.5\ndensity = \"20 kg/m3\"\n\n\
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
    ] {
        assert!(dir.path(&format!("whole/figures/{name}.svg")).exists(), "{name}");
    }
}
