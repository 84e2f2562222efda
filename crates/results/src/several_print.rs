//! What the screen shows of several bearings on one shaft.

use assembly::Assembly;
use comm::print;
use dynamics::stiffness::N_SHAFT;

use crate::console::{digits, fixed};
use crate::several::{ListState, StateOnShaft, line};

/// Prints the bearings and the ends of the shaft.
pub fn print_solution(assembly: &Assembly, last: &ListState) {
    print::line(format_args!(
        "bearing        position       x        y        z   tilt x   tilt y   force x   force y   force z  \
         largest ball  loaded"
    ));
    print::line(format_args!(
        "                     mm      um       um       um     urad     urad         N         N         N\
         {:>14}   balls",
        "N"
    ));
    for (mounted, state) in assembly.bearings.iter().zip(&last.bearings) {
        let [x, y, z, a, b] = state.displacement.map(|q| 1e6 * q);
        let [fx, fy, fz, ..] = state.force;
        print::line(format_args!(
            "{:<12} {} {:7.2} {:>7} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9} {:13.2} {:4} of {}",
            mounted.name,
            mounted.place.orientation.name(),
            1e3 * mounted.place.position,
            fixed::<3>(x),
            fixed::<3>(y),
            fixed::<3>(z),
            fixed::<2>(a),
            fixed::<2>(b),
            fixed::<2>(fx),
            fixed::<2>(fy),
            fixed::<2>(fz),
            state.largest_ball_force,
            state.loaded_balls,
            mounted.model.geometry.n_balls
        ));
    }
    for (z, q) in ends(assembly, &last.shaft) {
        print::line(format_args!(
            "shaft at {:.2} mm: x {} um, y {} um, z {} um",
            1e3 * z,
            fixed::<3>(1e6 * q[0]),
            fixed::<3>(1e6 * q[1]),
            fixed::<3>(1e6 * q[2])
        ));
    }
}

/// The ends of a beam.
fn ends(assembly: &Assembly, displacements: &[f64]) -> Vec<(f64, [f64; N_SHAFT])> {
    let line = line(assembly, |z| assembly.shaft.displacement_at(z, displacements));
    match assembly.shaft.is_beam() {
        true => vec![line[0], line[line.len() - 1]],
        false => Vec::new(),
    }
}

/// Prints a line per point of a sweep: the bearings' largest forces and loaded balls.
pub fn print_sweep_head(column: &str, assembly: &Assembly) {
    let names: Vec<String> = assembly
        .bearings
        .iter()
        .map(|b| format!("{:>12} N (balls)", b.name))
        .collect();
    print::line(format_args!("{column:>28} {}", names.join(" ")));
}

/// Prints a point of a sweep.
pub fn print_sweep_point(value: f64, point: &ListState) {
    let cell = |state: &StateOnShaft| format!("{:14.2} ({:5})", state.largest_ball_force, state.loaded_balls);
    let cells: Vec<String> = point.bearings.iter().map(cell).collect();
    print::line(format_args!("{:>28} {}", digits(value), cells.join(" ")));
}
