//! Films that lift balls off their grooves.

use crate::util::tables::Table;
use crate::util::{Dir, RIGID, assert_close, with_line};

const OIL: &str = "[lubricant]\nviscosity = \"40 mPa s\"\npressure_coefficient = \"22 1/GPa\"\n";

/// A 7010C at 6000 rpm under 2 kN on rigid rings.
fn bearing(lubricant: &str, analysis: &str) -> Dir {
    let half_spaces = with_line("[contact]", "[contact]", "[contact]\nball = \"half_space\"");
    let rest = format!("{lubricant}\n[speed]\ninner = \"6000 rpm\"\n\n{analysis}");
    Dir::with_scene(&half_spaces.replace("[static]", &rest))
}

/// Wrong: films would take another room than they are thick. Along the line of contact the distance of both groove
/// centres is that of the parts with the films between them, less what they approach. Across the axis it is that of the
/// bearing without load and the motion of the shaft towards the ball.
#[test]
fn balls_are_lifted_by_films_of_their_load() {
    let load = 331.9;
    let dir = bearing(&format!("{OIL}lift_load = \"{load} N\"\n"), "[static]");
    dir.run("with", &RIGID);
    let without = bearing(OIL, "[static]");
    without.run("without", &RIGID);
    let of = |dir: &Dir, out: &str, name: &str| Table::read(dir, &format!("{out}/balls.csv")).column(name)[0];
    let [with, without] = [(&dir, "with"), (&without, "without")].map(|(dir, out)| {
        let approaches: f64 = ["inner_approach_m", "outer_approach_m"]
            .map(|name| of(dir, out, name))
            .iter()
            .sum();
        let angle = of(dir, out, "inner_contact_angle_rad");
        (
            approaches,
            angle,
            Table::read(dir, &format!("{out}/shaft.csv")).column("x_m")[0],
        )
    });
    // Of the load of the key: a film falls with the load of its contact to the power 0.067.
    let of_key = |side: &str| {
        let own = of(&dir, "with", &format!("{side}_force_n"));
        of(&dir, "with", &format!("{side}_film_central_m")) * (own / load).powf(0.067)
    };
    let films = of_key("inner") + of_key("outer");
    assert!(films > 1.5e-6 && films < 3e-6, "{films}");
    // Groove radii less the ball's diameter, and the radial distance of groove centres: half of the bearing's.
    let free = 4.65e-3 + 4.75e-3 - 9e-3;
    let across = 0.5 * (56.01e-3 + 2.0 * 4.65e-3) - 0.5 * (74.037e-3 - 2.0 * 4.75e-3);
    let far = |(approaches, angle, x): (f64, f64, f64)| (across + x) / angle.cos() - free - approaches;
    assert_close("without films", 1e6 + 1e12 * far(without), 1e6, 1e-6);
    assert_close("films", -far(with), films, 1e-5);
}

/// Wrong: a motion would start from where no film lifts its balls, and swing.
#[test]
fn a_motion_has_the_films_of_its_equilibrium() {
    let dynamic = "[dynamic]\nduration = \"0.2 ms\"\nstep = \"10 us\"";
    let dir = bearing(&format!("{OIL}lift_load = \"332 N\"\n"), dynamic);
    dir.run("out", &RIGID);
    let z = Table::read(&dir, "out/shaft.csv").column("z_m");
    for at in &z {
        // Balls pass the force across; films are 4 % of this.
        assert_close("z", *at, z[0], 1e-5);
    }
    assert!(z.len() > 10);
}
