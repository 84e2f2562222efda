//! The largest shear and von Mises stress below a Hertz contact, and the range of orthogonal shear of rolling.
//!
//! All are proportional to the peak pressure, and their depths to the ellipse, so one set of numbers holds for a
//! contact at every load. The largest maximum shear and von Mises stress of steel lie on the axis below the centre
//! (Johnson 1985, 4.2, table 4.1). The orthogonal shear tau_yz of rolling, y the rolling direction, is largest in the
//! plane x = 0 under the flanks of the contact and changes sign as the ball passes: its range is twice its amplitude
//! (Lundberg and Palmgren 1947; Harris, Rolling Bearing Analysis, 4th ed., chapter 6). There, with l the confocal
//! coordinate and zeta = z/sqrt(l),
//!
//! ```text
//! |tau_yz| = p0 a b zeta^2 sqrt(1 - zeta^2) sqrt(l) / ((l + b^2 zeta^2) sqrt(a^2 + l))
//! ```

use super::stress::EllipticPressure;
use crate::semi_axes::SemiAxes;

/// Steps of the scan that brackets a maximum on the axis, to a depth of [`DEEPEST`] smaller semi-axes.
const SCAN: usize = 128;
const DEEPEST: f64 = 2.0;
/// Rounds of golden section: the bracket shrinks to 1e-9 of itself, beyond what a flat maximum resolves.
const ROUNDS: usize = 44;

/// A largest stress over the peak pressure, and its depth over the smaller semi-axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// Stress over peak pressure.
    pub over_peak_pressure: f64,
    /// Depth over the smaller semi-axis.
    pub depth_over_minor_axis: f64,
}

/// What a contact does below the surface of one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subsurface {
    /// Largest maximum shear stress, half the difference of the outer principal stresses.
    pub maximum_shear: Extreme,
    /// Largest von Mises stress.
    pub von_mises: Extreme,
    /// Amplitude of the orthogonal shear stress of rolling along y.
    pub orthogonal_shear: Extreme,
}

/// Largest stresses below an ellipse with semi-axes of any unit in a body of a Poisson's ratio.
pub fn subsurface(semi_axes: SemiAxes, poisson_ratio: f64) -> Subsurface {
    let axes = semi_axes.map(|axis| axis / semi_axes.minor());
    let pressure = EllipticPressure::of_peak(1.0, axes, poisson_ratio);
    let principal = |z: f64| {
        let mut s = pressure.stress([0.0, 0.0, z]);
        s[..3].sort_by(f64::total_cmp);
        s
    };
    let shear = |z: f64| {
        let s = principal(z);
        0.5 * (s[2] - s[0])
    };
    let von_mises = |z: f64| fem::stress::von_mises(principal(z));
    Subsurface {
        maximum_shear: on_axis(shear),
        von_mises: on_axis(von_mises),
        orthogonal_shear: orthogonal(axes),
    }
}

fn on_axis(stress: impl Fn(f64) -> f64) -> Extreme {
    let step = DEEPEST / SCAN as f64;
    let best = (0..=SCAN).max_by(|&i, &j| stress(i as f64 * step).total_cmp(&stress(j as f64 * step)));
    let middle = best.map_or(0.0, |i| i as f64 * step);
    let depth = maximum([(middle - step).max(0.0), middle + step], &stress);
    Extreme {
        over_peak_pressure: stress(depth),
        depth_over_minor_axis: depth,
    }
}

fn orthogonal(axes: SemiAxes) -> Extreme {
    let [a, b] = axes.into();
    // The confocal ellipsoid through the place of the maximum is never larger than twice the ellipse.
    let highest = 2.0 * a.max(b);
    let stress = |zeta: f64, root: f64| {
        let l = root * root;
        a * b * zeta * zeta * (1.0 - zeta * zeta).sqrt() * root
            / ((l + b * b * zeta * zeta) * (a * a + l).sqrt())
    };
    let best_root = |zeta: f64| maximum([0.0, highest], &|root| stress(zeta, root));
    let zeta = maximum([0.0, 1.0], &|zeta| stress(zeta, best_root(zeta)));
    let root = best_root(zeta);
    Extreme {
        over_peak_pressure: stress(zeta, root),
        depth_over_minor_axis: zeta * root,
    }
}

/// Place of the only maximum of a function in a range, by golden section.
fn maximum([mut low, mut high]: [f64; 2], f: &impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - golden * (high - low), low + golden * (high - low)];
    let mut x = inner(low, high);
    let mut y = x.map(f);
    for _ in 0..ROUNDS {
        if y[0] >= y[1] {
            high = x[1];
            x = [inner(low, high)[0], x[0]];
            y = [f(x[0]), y[0]];
        } else {
            low = x[0];
            x = [x[1], inner(low, high)[1]];
            y = [y[1], f(x[1])];
        }
    }
    0.5 * (low + high)
}
