//! Tests of moved circles.

use super::*;
use contact::cross;

const CIRCLE: Circle = Circle {
    azimuth: [0.8, 0.6],
    radius: 0.0326,
    is_projected: false,
};
const PROJECTED: Circle = Circle {
    is_projected: true,
    ..CIRCLE
};
const MOTIONS: [FiniteCoordinates; 5] = [
    [2e-6, 7e-6, 1e-3, -4e-4],
    [-3e-4, 1e-4, 0.03, -0.04],
    [2e-3, 3e-3, 0.3, 0.45],
    [-40e-6, 25e-6, 0.0, 0.0],
    [0.0; 4],
];

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// R v by Rodrigues' formula.
pub fn rotated([x, y]: [f64; 2], v: [f64; 3]) -> [f64; 3] {
    let angle = x.hypot(y).max(f64::MIN_POSITIVE);
    let k = [x / angle, y / angle, 0.0];
    let (once, twice) = (cross(k, v), cross(k, cross(k, v)));
    [0, 1, 2].map(|i| v[i] + angle.sin() * once[i] + (1.0 - angle.cos()) * twice[i])
}

/// Where a growing function vanishes between two places, by bisection.
fn zero_between(mut low: f64, mut high: f64, growing: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match growing(middle) > 0.0 {
            true => high = middle,
            false => low = middle,
        }
    }
    low
}

/// Place of the point of the moved circle at the azimuth psi + delta of the body.
fn place(circle: &Circle, [x, y, tilt_x, tilt_y]: FiniteCoordinates, delta: f64) -> [f64; 3] {
    let ([cos, sin], (turn_sin, turn_cos)) = (circle.azimuth, delta.sin_cos());
    let arm = [
        cos * turn_cos - sin * turn_sin,
        sin * turn_cos + cos * turn_sin,
        0.0,
    ];
    let turned = rotated([tilt_x, tilt_y], arm).map(|v| circle.radius * v);
    [x + turned[0], y + turned[1], turned[2]]
}

/// Where round the body the moved circle meets the half-plane.
fn crossing(circle: &Circle, at: FiniteCoordinates) -> f64 {
    let [cos, sin] = circle.azimuth;
    zero_between(-0.6, 0.6, |delta| dot(place(circle, at, delta), [-sin, cos, 0.0]))
}

/// The place there, along e_r and z.
fn met(circle: &Circle, at: FiniteCoordinates) -> [f64; 2] {
    let [cos, sin] = circle.azimuth;
    let found = place(circle, at, crossing(circle, at));
    [dot(found, [cos, sin, 0.0]) - circle.radius, found[2]]
}

/// What the linear terms of a link say of the same motion.
fn linear(circle: &Circle, [x, y, tilt_x, tilt_y]: FiniteCoordinates) -> [f64; 2] {
    let [cos, sin] = circle.azimuth;
    [x * cos + y * sin, -circle.radius * (tilt_y * cos - tilt_x * sin)]
}

/// Wrong: lengths are not those from where the moved circle meets the plane of a ball.
#[test]
fn lengths_are_those_from_the_moved_circle() {
    for at in MOTIONS {
        let (found, exact, linear) = (CIRCLE.lengths(at), met(&CIRCLE, at), linear(&CIRCLE, at));
        for i in 0..2 {
            let expected = linear[i] - exact[i];
            assert!(
                (found[i] - expected).abs() < 3e-17,
                "{at:?}: {found:?} {expected}"
            );
        }
    }
}

/// Wrong: the distance from a point in the plane is not the least to the circle, but for the square of its slope
/// along the distance. Least distance by bisection of its growth round the circle.
#[test]
fn distances_are_those_from_a_torus() {
    let at = MOTIONS[0];
    let [radial, axial] = met(&CIRCLE, at);
    let [cos, sin] = CIRCLE.azimuth;
    let l = [-4.1e-4, 1.5e-4];
    let far = CIRCLE.radius + radial + l[0];
    let ball = [far * cos, far * sin, axial + l[1]];
    let between = |delta: f64| {
        let found = place(&CIRCLE, at, delta);
        [0, 1, 2].map(|i| ball[i] - found[i])
    };
    let nearest = zero_between(-0.1, 0.1, |delta| {
        let [before, after] = [delta - 1e-4, delta + 1e-4].map(between);
        dot(between(delta), [0, 1, 2].map(|i| after[i] - before[i]))
    });
    let (least, seen) = (dot(between(nearest), between(nearest)).sqrt(), l[0].hypot(l[1]));
    assert!((least / seen - 1.0).abs() < 1e-6, "{least} {seen}");
}

/// Wrong: a projected circle would be seen elsewhere than at its point, or feel a motion along itself.
#[test]
fn of_a_projected_circle_one_point_is_seen() {
    for at in MOTIONS {
        let (found, linear) = (PROJECTED.lengths(at), linear(&PROJECTED, at));
        let point = place(&PROJECTED, at, 0.0);
        let [cos, sin] = PROJECTED.azimuth;
        let exact = [dot(point, [cos, sin, 0.0]) - PROJECTED.radius, point[2]];
        (0..2).for_each(|i| assert!((found[i] - (linear[i] - exact[i])).abs() < 3e-17, "{at:?}"));
        assert_eq!(PROJECTED.rows(at)[..2].concat(), [0.0; 4]);
    }
}

/// Wrong: forces would act at another lever than lengths grow. Difference quotients.
#[test]
fn rows_are_slopes_and_curvature_is_theirs() {
    for (circle, at) in [CIRCLE, PROJECTED]
        .into_iter()
        .flat_map(|circle| MOTIONS.map(|at| (circle, at)))
    {
        let (rows, force) = (circle.rows(at), [-300.0, 90.0]);
        let curvature = circle.curvature(at, force);
        for k in 0..N_FINITE {
            let unit = if k < 2 { circle.radius } else { 1.0 };
            let (h, mut low, mut high) = (1e-5 * unit, at, at);
            (low[k], high[k]) = (low[k] - h, high[k] + h);
            let (a, b) = (circle.lengths(low), circle.lengths(high));
            let (slopes, moved) = (circle.rows(low), circle.rows(high));
            for i in 0..2 {
                let growth = (b[i] - a[i]) / (2.0 * h);
                assert!((growth - rows[k][i]).abs() < 1e-11 / unit, "{at:?} {k} {i}");
            }
            for i in 0..N_FINITE {
                let change: f64 = (0..2).map(|l| (moved[i][l] - slopes[i][l]) * force[l]).sum();
                let of_i = if i < 2 { circle.radius } else { 1.0 };
                let off = (change / (2.0 * h) - curvature[i][k]).abs();
                assert!(off < 1e-7 / (unit * of_i), "{at:?} {i} {k}: {off}");
            }
        }
    }
}

/// Wrong: forces of a table would not balance: across the plane the circle pushes with its slope along the force. Two
/// points of the circle give its direction where it meets the plane.
#[test]
fn a_force_has_no_part_along_the_circle() {
    for at in MOTIONS {
        let [cos, sin] = CIRCLE.azimuth;
        let beside = [-sin, cos, 0.0];
        let met = crossing(&CIRCLE, at);
        let [before, after] = [met - 1e-5, met + 1e-5].map(|delta| place(&CIRCLE, at, delta));
        let along = [0, 1, 2].map(|i| after[i] - before[i]);
        let force = [-300.0, 90.0];
        let across = CIRCLE.across(at, force);
        let in_space = [0, 1, 2]
            .map(|i| force[0] * [cos, sin, 0.0][i] - across * beside[i] + force[1] * [0.0, 0.0, 1.0][i]);
        let part = dot(in_space, along) / dot(along, along).sqrt();
        assert!(part.abs() < 1e-6, "{at:?}: {part}");
    }
    assert_eq!(PROJECTED.across(MOTIONS[1], [-300.0, 90.0]), 0.0);
}

/// Wrong: a ball that goes round would meet another slope of the groove than the circle has. Difference quotients.
#[test]
fn lengths_grow_along_the_circle() {
    for at in MOTIONS {
        let (h, along) = (1e-5, CIRCLE.along(at));
        let [before, after] = [-h, h].map(|turn: f64| {
            let ([cos, sin], (s, c)) = (CIRCLE.azimuth, turn.sin_cos());
            let azimuth = [cos * c - sin * s, sin * c + cos * s];
            Circle { azimuth, ..CIRCLE }.lengths(at)
        });
        for i in 0..2 {
            let growth = (after[i] - before[i]) / (2.0 * h);
            assert!((growth - along[i]).abs() < 1e-11, "{at:?} {growth} {along:?}");
        }
    }
}

/// Wrong: contacts would make or lose energy over a step, because forces act through other slopes than lengths
/// change. A step far larger than any of a motion.
#[test]
fn mean_rows_give_the_change_of_the_lengths() {
    let (start, change) = (MOTIONS[1], [3e-6, -5e-6, 1e-4, -2e-4]);
    let end = std::array::from_fn(|k| start[k] + change[k]);
    let rows = CIRCLE.mean_rows(start, end);
    let (before, after) = (CIRCLE.lengths(start), CIRCLE.lengths(end));
    for i in 0..2 {
        let grown: f64 = (0..N_FINITE).map(|k| rows[k][i] * change[k]).sum();
        assert!(
            (grown - (after[i] - before[i])).abs() < 1e-12 * grown.abs(),
            "{grown}"
        );
    }
}

/// Wrong: a contact would feel where it stands round the bearing. Everything turned about the axis.
#[test]
fn turning_everything_about_the_axis_changes_nothing() {
    for at in MOTIONS {
        let (sin, cos) = 1.1f64.sin_cos();
        let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, sin * x + cos * y];
        let circle = Circle {
            azimuth: turn(CIRCLE.azimuth),
            ..CIRCLE
        };
        let [x, y, tilt_x, tilt_y] = at;
        let ([x, y], [tilt_x, tilt_y]) = (turn([x, y]), turn([tilt_x, tilt_y]));
        let (found, turned) = (CIRCLE.lengths(at), circle.lengths([x, y, tilt_x, tilt_y]));
        (0..2).for_each(|i| assert!((turned[i] - found[i]).abs() <= 1e-13 * found[i].abs()));
    }
}

/// Wrong: a wild guess of Newton's would end a run with numbers that are none.
#[test]
fn far_motions_have_lengths() {
    for at in [
        [1.0, -3.0, 0.0, 0.0],
        [0.0, 0.0, 1.57, 0.0],
        [0.2, 0.0, -2.0, 4.0],
    ] {
        let values = CIRCLE.lengths(at).into_iter().chain(CIRCLE.rows(at).concat());
        assert!(values.into_iter().all(f64::is_finite), "{at:?}");
    }
}

/// Wrong: the functions of the angle jump where their series end.
#[test]
fn series_and_closed_forms_meet() {
    let (below, above) = (angle_functions(SMALL * (1.0 - 1e-15)), angle_functions(SMALL));
    (0..2).for_each(|i| assert!((below[i] - above[i]).abs() < 2e-15, "{below:?} {above:?}"));
    let [c, e] = above;
    let slopes = [SMALL * (1.0 - 1e-15), SMALL].map(|square| c_slope(square, c, e));
    assert!((slopes[0] - slopes[1]).abs() < 1e-13, "{slopes:?}");
    assert_eq!(angle_functions(0.0), [0.5, 1.0 / 6.0]);
}
