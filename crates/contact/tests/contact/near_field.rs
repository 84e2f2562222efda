//! What the near field adds on a torus: how far from equilibrium it is, what its end at the reach leaves out, and how
//! it moves.

use contact::near_field::in_axes;
use contact::{Groove, LoadedPatch, NearField, RingPoint, SemiAxes, Side};

const NU: f64 = 0.3;
const GROOVE: Groove = Groove {
    side: Side::Outer,
    centre_radius: 32.2685e-3,
    groove_radius: 4.75e-3,
    centre_z: 0.0,
};
/// 500 N on the outer ring of the 7010C, spread over two elements of a mesh with 90 sectors; peak 1.76 GPa.
const CONTACT: LoadedPatch = LoadedPatch {
    azimuth: 0.0,
    force: 500.0,
    angle: 0.34,
    semi_axes: SemiAxes::new(1.05e-3, 0.129e-3),
    patch_angle: 0.34,
    patch_axes: SemiAxes::new(2.7e-3, 5.2e-3),
};

fn peak() -> f64 {
    1.5 * CONTACT.force / (std::f64::consts::PI * CONTACT.semi_axes.groove * CONTACT.semi_axes.rolling)
}

/// Added stress over the peak pressure at places of the mesh, m, in its axes.
fn added(contact: LoadedPatch, reach: f64, places: &[[f64; 3]]) -> Vec<[f64; 6]> {
    let mut stress = vec![[0.0; 6]; places.len()];
    NearField::new(GROOVE, NU, reach, places).add(&[contact], &mut stress);
    stress.into_iter().map(|s| s.map(|c| c / peak())).collect()
}

/// Points in the ring at a distance along the raceway, m, over the groove and through the thickness.
fn across(distance: f64) -> Vec<[f64; 3]> {
    let (mut places, radius) = (Vec::new(), GROOVE.radius(CONTACT.angle));
    for angle in [-0.6, 0.0, 0.34, 0.8] {
        for depth in [0.1e-3, 0.5e-3, 1.5e-3, 2.5e-3] {
            let azimuth = distance / radius;
            let point = RingPoint {
                azimuth,
                angle,
                depth,
            };
            places.push(point.position(&GROOVE));
        }
    }
    places
}

fn size(s: &[f64; 6]) -> f64 {
    s.iter().fold(0.0, |most, c| most.max(c.abs()))
}

/// Divergence of the added stress, peak pressures per m, by central differences of fourth order.
fn divergence(reach: f64, x: [f64; 3]) -> f64 {
    let h = 0.02e-3;
    let steps = [-2.0, -1.0, 1.0, 2.0];
    let moved = |i: usize, n: f64| std::array::from_fn(|j| x[j] + if i == j { n * h } else { 0.0 });
    let places: Vec<[f64; 3]> = (0..3).flat_map(|i| steps.map(|n| moved(i, n))).collect();
    let stress = added(CONTACT, reach, &places);
    let slope = |j: usize, c: usize| {
        let s = |n: usize| stress[4 * j + n][c];
        (8.0 * (s(2) - s(1)) - (s(3) - s(0))) / (12.0 * h)
    };
    let rows = [[0, 3, 5], [3, 1, 4], [5, 4, 2]];
    let parts = rows.map(|row| (0..3).map(|j| slope(j, row[j])).sum::<f64>());
    parts.iter().fold(0.0, |most, p| most.max(p.abs()))
}

/// Wrong: fading out at the reach would leave out stress that matters, or need body forces that do. Bounds chosen
/// beforehand: 0.2 % of the peak pressure left out, and body forces that over the size of the patch add up to 0.5 %
/// of it.
#[test]
fn the_end_at_the_reach_leaves_little_out() {
    let patch = CONTACT.patch_axes.rolling;
    let (mut left_out, mut residual, mut inside) = (0.0f64, 0.0f64, 0.0f64);
    for i in 0..30 {
        let distance = patch * (0.5 + 0.15 * i as f64);
        let places = across(distance);
        let (whole, faded) = (added(CONTACT, 20.0, &places), added(CONTACT, 4.0, &places));
        let gap: Vec<f64> = whole
            .iter()
            .zip(&faded)
            .map(|(a, b)| size(&std::array::from_fn(|c| a[c] - b[c])))
            .collect();
        let most = places.iter().map(|&x| divergence(4.0, x)).fold(0.0, f64::max) * patch;
        if distance < 1.7 * patch {
            // The weight is 1: nothing is left out.
            inside = inside.max(most);
            assert!(gap.iter().all(|g| *g == 0.0));
        } else {
            residual = residual.max(most);
            left_out = gap.iter().fold(left_out, |most, g| most.max(*g));
        }
    }
    println!(
        "left out {left_out:.2e} p0; body forces over a patch {residual:.2e} p0 where it fades, {inside:.2e} p0 nearer"
    );
    assert!(left_out < 2e-3, "{left_out:e}");
    assert!(residual < 5e-3, "{residual:e}");
}

/// Wrong: histories would jump where a ball comes into reach, where the blend begins, where one quadrature takes over
/// from another, or at the edge of the ellipse. With half the step the largest change of a step is half as large,
/// everywhere on the way, but for 1e-6 of the peak pressure.
#[test]
fn stress_is_smooth_as_a_ball_rolls_by() {
    let changes = |n: usize, from: f64, to: f64, depth: f64, angle: f64| {
        let point = RingPoint {
            azimuth: 0.0,
            angle,
            depth,
        };
        let place = [point.position(&GROOVE)];
        let radius = GROOVE.radius(angle);
        let history: Vec<[f64; 6]> = (0..=n)
            .map(|i| {
                let mut contact = CONTACT;
                contact.azimuth = (from + (to - from) * i as f64 / n as f64) / radius;
                in_axes(added(contact, 4.0, &place)[0], &point.axes(&GROOVE))
            })
            .collect();
        history
            .windows(2)
            .map(|w| size(&std::array::from_fn(|c| w[1][c] - w[0][c])))
            .fold(0.0, f64::max)
    };
    let patch = CONTACT.patch_axes.rolling;
    for (from, to, depth, angle) in [
        // Over the ellipse and out of it, below the middle and beside it.
        (-0.5e-3, 0.5e-3, 0.05e-3, 0.34),
        (-0.5e-3, 0.5e-3, 0.05e-3, 0.5),
        // From one rule to another, three semi-axes away, and over the edge of the patch.
        (1.0e-3, 7.0e-3, 0.1e-3, 0.34),
        // Through the blend and beyond.
        (1.8 * patch, 4.2 * patch, 0.1e-3, 0.2),
    ] {
        let [coarse, fine] = [2000, 4000].map(|n| changes(n, from, to, depth, angle));
        println!("{from:e} to {to:e}: {coarse:.3e} and {fine:.3e} p0 a step");
        assert!(
            coarse > 0.0 && fine < 0.6 * coarse + 1e-6,
            "{from} {to}: {coarse:e} {fine:e}"
        );
    }
}
