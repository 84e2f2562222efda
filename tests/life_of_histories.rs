//! Lives of histories through the whole program: balls that skid, and rows that lie far apart.

use crate::life::{LIFE, TURN, life, life_file};
use crate::util::tables::{Table, number, summary};
use crate::util::{Dir, RIGID, assert_close, with_line};

/// Wrong: balls that skid would be counted by where the cage would be without slip, ten times too often here. The rings
/// reach 30 000 rpm in a millisecond, the balls go round half a time instead of four times. The ways are those of the
/// speeds of the orbits.
#[test]
fn balls_that_skid_are_counted_by_their_own_way() {
    let skid = "[life]\n\n[balls]\nmotion = \"free\"\n\n[effects.traction]\nlaw = \"coulomb\"\nfriction = 0.002\n\n\
                [speed]\ninner = { times = [\"0 s\", \"1 ms\"], values = [\"3000 rpm\", \"30000 rpm\"] }\n\n\
                [dynamic]\nduration = \"20 ms\"\nstep = \"20 us\"\noutput_every = 1000";
    let dir = Dir::with_scene(&with_line("[static]", "[static]", skid));
    let axial = ["effects.axial_force.value=200 N", "effects.radial_force=none"];
    dir.run(
        "out",
        &[&RIGID[..], &["--set", axial[0], "--set", axial[1]]].concat(),
    );
    life(&dir, &["out"]);
    let found = life_file(&dir, "out");
    let [balls, shaft] = ["balls", "shaft"].map(|name| Table::read(&dir, &format!("out/{name}.csv")));
    let time = shaft.column("time_s");
    let speed = |time: f64| (3000.0 + 27000.0 * (time / 1e-3).min(1.0)) * std::f64::consts::PI / 30.0;
    let share = shaft.column("kinematic_cage_speed_rad_per_s")[0] / speed(0.0);
    // The corner of the speed is an instant of the run.
    let turned = |row: usize| 0.5 * (speed(time[row - 1]) + speed(time[row])) * (time[row] - time[row - 1]);
    let whole: f64 = (1..time.len()).map(turned).sum();
    let orbits = balls.column("orbit_rad_per_s");
    for (side, per_turn) in [("inner", 1.0 - share), ("outer", share)] {
        let forces = balls.column(&format!("{side}_force_n"));
        let rating = number(&found, &format!("/{side}/q_c_n"));
        let mut damage = 0.0;
        for row in 1..time.len() {
            for ball in 0..18 {
                let [a, b] = [18 * (row - 1) + ball, 18 * row + ball];
                let orbit = 0.5 * (orbits[a] + orbits[b]) * (time[row] - time[row - 1]);
                let way = if side == "inner" {
                    turned(row) - orbit
                } else {
                    orbit
                };
                damage += 0.5 * ((forces[a] / rating).powi(3) + (forces[b] / rating).powi(3)) * way;
            }
        }
        let expected = 1e6 * 18.0 * per_turn * whole / damage;
        // All balls are alike, so that every position has its share but for the ends of the ways.
        let life = number(&found, &format!("/{side}/l10r_revolutions"));
        assert_close(side, life, expected, 1e-4);
    }
}

/// Wrong: rows that lie so far apart that nobody knows the forces between would give a life without a word, or those of
/// a bearing whose forces are equal would be blamed. At 1800 rpm a ball goes by half a pitch in 2.1 ms.
#[test]
fn rows_far_apart_are_told() {
    let sparse = TURN.replace("35 ms", "399 ms") + "\n[output]\ntables_every = 70\n";
    let analysis = LIFE.replace("speed = \"1800 rpm\"\n", "").replace(
        "[static]",
        &sparse.replace("\"0.1 ms\"", "\"0.1 ms\"\noutput_every = 3990"),
    );
    let dir = Dir::with_scene(&with_line("[static]", "[static]", &analysis));
    let light = ["--set", "effects.axial_force.value=0.3 kN"];
    dir.run("uneven", &[&RIGID[..], &light].concat());
    let told = "rows of balls.csv lie 1.64 ball pitches apart";
    let advice = "output.tables_every of 10 or less";
    let ahead = format!("{told}; where forces differ round the bearing");
    let said = summary(&dir, "uneven")["warnings"].to_string();
    assert!(said.contains(&ahead), "{said}");
    let found = format!("life: {told}, and forces change much from one to the next");
    assert!(said.contains(&found) && said.contains(advice), "{said}");
    let shown = life(&dir, &["uneven"]);
    assert!(shown.contains(&format!("warning: {told}")), "{shown}");
    let notes = life_file(&dir, "uneven")["notes"].to_string();
    assert!(notes.contains(&format!("warning: {told}")), "{notes}");
    let spectrum = "[[conditions]]\nresults = \"uneven\"\nshare = 1.0\n";
    dir.write("year.toml", spectrum);
    let shown = life(&dir, &["--spectrum", "year.toml"]);
    assert!(shown.contains(&format!("warning: uneven: {told}")), "{shown}");

    dir.run(
        "even",
        &[&RIGID[..], &["--set", "effects.radial_force=none"]].concat(),
    );
    let shown = life(&dir, &["even"]);
    assert!(!shown.contains("pitches apart"), "{shown}");
}
