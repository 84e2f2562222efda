//! The usual figure for scuffing and wear: pressure times sliding speed.
//!
//! pv is the largest p |s| over the contact, W/m^2: Hertz's pressure p under the mean force of a step, and the slip s
//! that traction follows, with spin and differential slip ([`super`]). Times the coefficient of friction it is the
//! largest heat per area. It is searched on a grid over the ellipse, whatever the places of traction are. Error: below
//! 0.3 % where spin makes it, none where the contact slides as a whole. Cost: 369 products per contact. Over strips
//! that are not Hertz's ellipse it is searched on lines over what carries the load.

use super::patch::{Ellipse, Slip};

/// Half the number of steps of the grid along t and along q.
const STEPS: [i32; 2] = [4, 20];

/// A strip along the rolling direction that carries load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureLine {
    /// Its place across the track over the half-width of Hertz's ellipse under the same force.
    pub place: f64,
    /// Its overlap over the approach of that.
    pub overlap: f64,
}

/// Largest pressure times sliding speed, W/m^2: over the ellipse, or over `lines` where there are any.
pub fn largest_pv(ellipse: &Ellipse, lines: &[PressureLine], slip: &Slip) -> f64 {
    let on_ellipse = (-STEPS[1]..=STEPS[1]).map(|j| {
        let unit_y = f64::from(j) / f64::from(STEPS[1]);
        largest_on_line(ellipse, slip, (unit_y, 1.0), |x| 1.0 - x * x - unit_y * unit_y)
    });
    let on_lines = lines.iter().map(|&PressureLine { place, overlap }| {
        largest_on_line(ellipse, slip, (place, overlap.sqrt()), |x| overlap - x * x)
    });
    let largest = match lines {
        [] => on_ellipse.fold(0.0, f64::max),
        _ => on_lines.fold(0.0, f64::max),
    };
    ellipse.peak_pressure * largest.sqrt()
}

/// Largest square of pressure times sliding speed along the rolling direction at y/a, up to `reach` half-widths, where
/// `pressure` is the square of it at x/b; pressures over the peak of the ellipse.
fn largest_on_line(
    ellipse: &Ellipse,
    slip: &Slip,
    (unit_y, reach): (f64, f64),
    pressure: impl Fn(f64) -> f64,
) -> f64 {
    let [a, b] = ellipse.semi_axes.into();
    let ([s_t, s_q], [w_t, w_q, w_n]) = (slip.centre, slip.turning);
    let y = a * unit_y;
    let z = -y * y / (2.0 * ellipse.radius);
    let along = s_t - w_n * y + w_q * z;
    let at = |i: i32| {
        let unit_x = reach * (f64::from(i) / f64::from(STEPS[0]));
        let across = s_q + w_n * b * unit_x - w_t * z;
        pressure(unit_x) * (along * along + across * across)
    };
    (-STEPS[0]..=STEPS[0]).map(at).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::SemiAxes;

    const ELLIPSE: Ellipse = Ellipse {
        semi_axes: SemiAxes::new(1.0155e-3, 1.03e-4),
        radius: f64::INFINITY,
        peak_pressure: 1.5e9,
        film: 0.0,
    };

    fn assert_near(slip: Slip, expected: f64, most: f64) {
        let error = largest_pv(&ELLIPSE, &[], &slip) / expected - 1.0;
        assert!(error.abs() <= most, "{error}");
    }

    /// Wrong: the figure would not be that of the definition. Gross sliding: p0 |s| in the middle. Pure spin: p0 w a/2,
    /// at y = a/sqrt(2).
    #[test]
    fn sliding_and_pure_spin_have_their_closed_pv() {
        let slides = Slip {
            centre: [0.3, -0.4],
            turning: [0.0; 3],
        };
        assert_near(slides, 1.5e9 * 0.5, 1e-15);
        let spins = Slip {
            centre: [0.0; 2],
            turning: [0.0, 0.0, -700.0],
        };
        assert_near(spins, 1.5e9 * 700.0 * 0.5 * 1.0155e-3, 3e-3);
    }

    /// Wrong: differential slip would be left out. A groove that embraces the ball: p0 w_q a^2/(2 R_d) Y^2
    /// sqrt(1 - Y^2) is largest at Y^2 = 2/3.
    #[test]
    fn differential_slip_has_its_closed_pv() {
        let radius = 4.57e-3;
        let ellipse = Ellipse { radius, ..ELLIPSE };
        let slip = Slip {
            centre: [0.0; 2],
            turning: [0.0, 900.0, 0.0],
        };
        let expected = 1.5e9 * 900.0 * 1.0155e-3f64.powi(2) / (2.0 * radius) * 2.0 / 27f64.sqrt();
        let error = largest_pv(&ellipse, &[], &slip) / expected - 1.0;
        assert!(error.abs() < 3e-3, "{error}");
    }

    /// Wrong: a grid would miss the place that sliding along the lateral direction moves aside. A grid 40 times as
    /// fine.
    #[test]
    fn slip_with_spin_has_the_pv_of_a_fine_grid() {
        let slip = Slip {
            centre: [0.2, 0.35],
            turning: [30.0, 900.0, 700.0],
        };
        let ellipse = Ellipse {
            radius: 4.57e-3,
            ..ELLIPSE
        };
        let [a, b] = ellipse.semi_axes.into();
        let mut expected = 0.0f64;
        for (i, j) in (-160..=160).flat_map(|i| (-800..=800).map(move |j| (i, j))) {
            let (x, y) = (f64::from(i) / 160.0, f64::from(j) / 800.0);
            let z = -(a * y).powi(2) / (2.0 * ellipse.radius);
            let s = [0.2 - 700.0 * a * y + 900.0 * z, 0.35 + 700.0 * b * x - 30.0 * z];
            let pressure = (1.0 - x * x - y * y).max(0.0).sqrt();
            expected = expected.max(1.5e9 * pressure * s[0].hypot(s[1]));
        }
        let error = largest_pv(&ellipse, &[], &slip) / expected - 1.0;
        assert!((-3e-3..=1e-12).contains(&error), "{error}");
    }

    /// Wrong: strips of Hertz's overlaps would have another figure than the ellipse, or a half that is missing would
    /// still slide. With pure spin about the middle both halves have p0 w a/2, at y = a/sqrt(2); of a quarter from the
    /// edge inwards it is that of its own end, p0 w a/2 sqrt(3/4) at y = a sqrt(3/4).
    #[test]
    fn strips_have_the_pv_of_what_carries_the_load() {
        let slip = Slip {
            centre: [0.0; 2],
            turning: [0.0, 0.0, 700.0],
        };
        let lines = |from: f64| {
            let at = |k: usize| {
                let y = from + (1.0 - from) * k as f64 / 40.0;
                PressureLine {
                    place: y,
                    overlap: 1.0 - y * y,
                }
            };
            (0..=40).map(at).collect::<Vec<_>>()
        };
        let whole = 1.5e9 * 700.0 * 0.5 * 1.0155e-3;
        for (from, expected) in [
            (-1.0, whole),
            (0.0, whole),
            (0.75f64.sqrt(), whole * 0.75f64.sqrt()),
        ] {
            let found = largest_pv(&ELLIPSE, &lines(from), &slip);
            assert!(
                (found / expected - 1.0).abs() < 3e-3,
                "{from}: {found} {expected}"
            );
        }
    }

    /// Wrong: an open contact would have a figure, or none at all be a number.
    #[test]
    fn an_open_contact_has_none() {
        let open = Ellipse {
            semi_axes: SemiAxes::default(),
            peak_pressure: 0.0,
            ..ELLIPSE
        };
        let slip = Slip {
            centre: [1.0, 0.0],
            turning: [0.0, 0.0, 50.0],
        };
        assert_eq!(largest_pv(&open, &[], &slip), 0.0);
    }
}
