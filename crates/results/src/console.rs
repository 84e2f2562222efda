//! The short table at the end of a run.

use comm::print;
use dynamics::StaticSolution;

use super::snapshot::Snapshot;

/// Prints the balls and the shaft at one instant.
pub fn print_snapshot(snapshot: &Snapshot) {
    print::line(format_args!(
        "ball  azimuth    inner N    outer N  angle i  angle o   p_max i  p_max o"
    ));
    print::line(format_args!(
        "          deg                            deg      deg       GPa      GPa"
    ));
    for (i, b) in snapshot.balls.iter().enumerate() {
        print::line(format_args!(
            "{i:4} {:8.1} {:10.2} {:10.2} {:>8} {:>8} {:9.3} {:8.3}",
            b.azimuth_rad.to_degrees(),
            b.inner.force_n,
            b.outer.force_n,
            fixed::<3>(b.inner.contact_angle_rad.to_degrees()),
            fixed::<3>(b.outer.contact_angle_rad.to_degrees()),
            1e-9 * b.inner.peak_pressure_pa,
            1e-9 * b.outer.peak_pressure_pa,
        ));
    }
    print_shaft(snapshot);
}

/// Prints a line per point of a sweep.
pub fn print_sweep(column: &str, solutions: &[(f64, &StaticSolution)]) {
    print::line(format_args!(
        "{column:>28}    x um     y um     z um  tilt_x urad  tilt_y urad   force N min..max   angle deg min..max"
    ));
    for (value, s) in solutions {
        let range = |f: &dyn Fn(&dynamics::balls::BallResult) -> f64| {
            let values = s.balls.iter().map(f);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                (l.min(x), h.max(x))
            })
        };
        let (force, angle) = (
            range(&|b| b.inner.force_n),
            range(&|b| b.inner.contact_angle_rad.to_degrees()),
        );
        let [x, y, z, tilt_x, tilt_y] = s.displacements.shaft.map(|q| 1e6 * q);
        print::line(format_args!(
            "{:>28} {:>7} {:>8} {:>8} {:>12} {:>12} {:9.2} {:8.2} {:10.3} {:8.3}",
            digits(*value),
            fixed::<3>(x),
            fixed::<3>(y),
            fixed::<3>(z),
            fixed::<2>(tilt_x),
            fixed::<2>(tilt_y),
            force.0,
            force.1,
            angle.0,
            angle.1
        ));
    }
}

fn print_shaft(snapshot: &Snapshot) {
    let [x, y, z, tilt_x, tilt_y] = snapshot.shaft;
    print::line(format_args!(
        "shaft: x {} um, y {} um, z {} um, tilt x {} urad, tilt y {} urad",
        fixed::<4>(1e6 * x),
        fixed::<4>(1e6 * y),
        fixed::<4>(1e6 * z),
        fixed::<3>(1e6 * tilt_x),
        fixed::<3>(1e6 * tilt_y)
    ));
    if let Some(z) = snapshot.seat {
        print::line(format_args!(
            "seat of the outer ring: z {} um",
            fixed::<4>(1e6 * z)
        ));
    }
}

/// A number with N decimals; one that rounds to zero has no sign.
pub fn fixed<const N: usize>(x: f64) -> String {
    let text = format!("{x:.N$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_string(),
        _ => text,
    }
}

/// A number of the scene with as many digits as it was typed with, not those of its unit's factor: seven at most, and
/// no long row of zeros.
pub fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.6e}").parse().unwrap_or(x);
    match rounded == 0.0 || (LEAST_PLAIN..MOST_PLAIN).contains(&rounded.abs()) {
        true => rounded.to_string(),
        false if rounded.is_finite() => format!("{rounded:e}"),
        false => rounded.to_string(),
    }
}

/// A point of a sweep in words: the column of the swept value, and the value.
pub fn at_value(column: &str, value: f64) -> String {
    format!("{column} = {}", digits(value))
}

/// Numbers from the first to below the second are shown without an exponent.
const LEAST_PLAIN: f64 = 1e-9;
const MOST_PLAIN: f64 = 1e15;

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a reader would see round-off instead of a number.
    #[test]
    fn numbers_are_shown_as_people_write_them() {
        assert_eq!(
            [fixed::<4>(-1e-9), fixed::<4>(-1.5), fixed::<2>(0.0)],
            ["0.0000", "-1.5000", "0.00"]
        );
        assert_eq!(
            [digits(1256.6370614359173), digits(0.1), digits(2000.0)],
            ["1256.637", "0.1", "2000"]
        );
        assert_eq!(
            [digits(0.1 + 0.2), digits(-14e-6), digits(2.07e11), digits(0.0)],
            ["0.3", "-0.000014", "207000000000", "0"]
        );
        assert_eq!([digits(1e300), digits(-1.5e-12)], ["1e300", "-1.5e-12"]);
        assert_eq!([digits(f64::NAN), digits(f64::INFINITY)], ["NaN", "inf"]);
    }
}
