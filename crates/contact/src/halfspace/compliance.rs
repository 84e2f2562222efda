//! Compliance of an elastic half-space under a semi-ellipsoidal pressure patch.
//!
//! The pressure-weighted mean of a Hertz displacement field is exactly 4/5 of its centre value, and the centre
//! value is 3 Q (1 - nu^2) K(m) / (2 pi E a), a the larger semi-axis, m = 1 - (b/a)^2 (Johnson 1985, eq. 3.64).

use crate::elliptic::complete_elliptic;
use crate::hertz::Elastic;
use crate::semi_axes::SemiAxes;

/// Mean normal displacement of the patch per unit load, m/N, for semi-axes in m.
pub fn patch_compliance(semi_axes: SemiAxes, body: Elastic) -> f64 {
    let (major, minor) = (semi_axes.major(), semi_axes.minor());
    let (k_integral, _) = complete_elliptic(1.0 - (minor / major) * (minor / major));
    0.8 * 1.5 / std::f64::consts::PI * body.plane_compliance() / major * k_integral
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the share of the Hertz approach taken out of the law. Circular patch: centre value 3 Q (1-nu^2)
    /// / (4 E a) (Johnson 1985, eq. 4.22), its weighted mean 4/5 of that.
    #[test]
    fn circular_patch_has_its_closed_form() {
        let body = Elastic {
            young_modulus: 207e9,
            poisson_ratio: 0.3,
        };
        let expected = 0.8 * 0.75 * (1.0 - 0.09) / (207e9 * 1e-3);
        let computed = patch_compliance([1e-3, 1e-3].into(), body);
        assert!((computed / expected - 1.0).abs() < 1e-14, "{computed} {expected}");
    }
}
