//! Free balls with a film that shears, drag and a cage on flexible rings: the same bits on any number of threads, after
//! a cut and after kills.

use std::time::Duration;

use checkpoint::committed_steps;

use crate::interruption::{signal, wait_for_steps};
use crate::resume::assert_cuts_continue;
use crate::util::lockstep::{assert_same_run, small_motion};
use crate::util::tables::Table;
use crate::util::{Dir, SCENE};

/// Balls that a radial force and the run-up bring against their pockets.
const EVERYTHING: &str = "[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"limiting_shear\"\n\
     eyring_stress = \"5 MPa\"\nlimit = 0.08\n\n[lubricant]\nviscosity = \"40 mPa s\"\n\
     pressure_coefficient = \"22 1/GPa\"\n\n[effects.ball_drag]\ncoefficient = 0.5\ndensity = \"20 kg/m3\"\n\n\
     [effects.contact_damping]\ncoefficient = \"5e-2 N s/mm\"\nfull_approach = \"1 um\"\n\n\
     [cage]\nmotion = \"free\"\nbore_diameter = \"62 mm\"\noutside_diameter = \"68.2 mm\"\nwidth = \"14 mm\"\n\
     mass = \"12 g\"\npocket_clearance = \"0.2 um\"\npocket_stiffness = \"2e8 N/m^1.5\"\nguidance = \"outer_land\"\n\
     guidance_clearance = \"0.1 um\"\nland_viscosity = \"0.01 Pa s\"\nfriction = 0.1\nrestitution = 0.6\n\n\
     [probes.contact.ball]\nball = 3\nring = \"inner\"\n\n\
     [speed.inner]\ntimes = [\"0 ms\", \"1 ms\"]\nvalues = [\"6000 rpm\", \"9000 rpm\"]\n\n\
     [dynamic]\nduration = \"0.4 ms\"\nstep = \"10 us\"\noutput_every = 2";

/// Scene and meshes of a motion of 40 steps with all of it.
pub fn everything() -> Dir {
    let dir = small_motion();
    let scene = SCENE.replace("[static]", EVERYTHING);
    dir.write(
        "scene.toml",
        scene.replace("value = \"2 kN\"", "value = \"0.4 kN\""),
    );
    dir
}

/// All that the scene asks for acts: else its bits would show nothing.
fn assert_all_acts(dir: &Dir, out: &str) {
    let energy = Table::read(dir, &format!("{out}/energy.csv"));
    for loss in [
        "friction_loss_j",
        "drag_loss_j",
        "contact_loss_j",
        "cage_impact_loss_j",
        "cage_friction_loss_j",
        "cage_drag_loss_j",
    ] {
        let last = energy.column(loss).last().copied();
        assert!(last > Some(0.0), "{loss}: {last:?}");
    }
    let films = Table::read(dir, &format!("{out}/balls.csv")).column("inner_film_central_m");
    assert!(films.iter().any(|film| *film > 1e-8));
}

/// Wrong: results would depend on the machine, or a run that is cut go on with other balls, cage or losses.
#[test]
fn with_all_of_it_on_a_run_has_the_same_bits_on_any_threads_and_after_a_cut() {
    let dir = everything();
    dir.run("whole", &["--threads", "1"]);
    assert_all_acts(&dir, "whole");
    dir.run("two", &["--threads", "2"]);
    assert_same_run(&dir, "whole", "two");
    assert_cuts_continue(&dir, &[("0", "2"), ("14", "1"), ("38", "2")]);
}

/// Wrong: a kill would lose what free balls and their cage had, or leave what cannot go on.
#[test]
fn with_all_of_it_on_a_killed_run_goes_on_bit_for_bit() {
    let dir = everything();
    dir.run("whole", &[]);
    let (mut arguments, mut kills) = (vec!["run", "scene.toml", "--out", "killed"], 0);
    for milliseconds in [5, 30, 80] {
        let mut child = dir.start(&arguments);
        let lines = wait_for_steps(&mut child);
        std::thread::sleep(Duration::from_millis(milliseconds));
        if child.try_wait().unwrap().is_some() {
            drop(lines);
            break;
        }
        signal(&child, "KILL");
        child.wait().unwrap();
        kills += 1;
        if !committed_steps(&dir.path("killed")).unwrap().is_empty() {
            arguments = vec!["resume", "killed"];
        }
    }
    assert!(kills > 0);
    let outcome = dir.raceway(&arguments);
    // A run that ended before its kill has nothing left to do.
    assert!(matches!(outcome.code, Some(0)), "{}", outcome.stderr);
    assert_same_run(&dir, "whole", "killed");
}
