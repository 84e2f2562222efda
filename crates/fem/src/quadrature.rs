//! Integration points and weights on the reference cells.
//!
//! Gauss-Legendre rules in closed form (Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, 25.4.29-30
//! and table 25.4), their tensor products, products collapsed onto the simplex (Stroud, Approximate Calculation
//! of Multiple Integrals, 1971, section 2.4), and the 4-point rule on the tetrahedron (Hammer and Stroud, Mathematical
//! Tables and Other Aids to Computation 10, 1956, 137-139). In products the first coordinate runs fastest.

use mesh::{ElementKind, FacetKind};

/// A rule on a volume's reference cell.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeRule {
    /// Reference points, `[n_points][3]`.
    pub points: Vec<[f64; 3]>,
    /// Weights, `[n_points]`; their sum is the reference volume, 8 or 1/6.
    pub weights: Vec<f64>,
}

/// A rule on a facet's reference cell.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetRule {
    /// Reference points, `[n_points][2]`.
    pub points: Vec<[f64; 2]>,
    /// Weights, `[n_points]`; their sum is the reference area, 4 or 1/2.
    pub weights: Vec<f64>,
}

/// Rule of the stiffness and of the stress points: 8, 27 or 4 points, exact on affine elements.
pub fn stiffness_rule(kind: ElementKind) -> VolumeRule {
    match kind {
        ElementKind::Hex8 => hexahedron(2),
        ElementKind::Hex20 => hexahedron(3),
        ElementKind::Tet10 => tetrahedron_4(),
    }
}

/// Rule of mass, volume, inertia and body loads: exact for `N_a N_b det J` on any element, curved ones included.
///
/// Degree per direction: hex8 1 + 1 + 2 = 4; hex20 2 + 2 + 5 = 9; tet10, in total, 2 + 2 + 3 = 7.
pub fn mass_rule(kind: ElementKind) -> VolumeRule {
    match kind {
        ElementKind::Hex8 => hexahedron(3),
        ElementKind::Hex20 => hexahedron(5),
        ElementKind::Tet10 => tetrahedron(5),
    }
}

/// Rule of surface loads and facet weights: exact for a constant pressure on any facet, curved ones included.
///
/// Degree of `N_a a`, a the area vector, per direction: quad4 1 + 1 = 2; quad8 2 + 3 = 5; tri6, in total, 2 + 2 = 4.
/// One point more per direction is taken, for area elements `|a|`, which are no polynomials, and for varying loads.
pub fn facet_rule(kind: FacetKind) -> FacetRule {
    match kind {
        FacetKind::Quad4 => quadrilateral(3),
        FacetKind::Quad8 => quadrilateral(4),
        FacetKind::Tri6 => triangle(4),
    }
}

/// Product rule on `[-1, 1]^3` with n points per direction (1 to 5), exact to degree 2n - 1 in each coordinate.
pub fn hexahedron(n: usize) -> VolumeRule {
    let line = gauss_legendre(n);
    let mut rule = VolumeRule {
        points: Vec::new(),
        weights: Vec::new(),
    };
    for &(z, wz) in &line {
        for &(y, wy) in &line {
            for &(x, wx) in &line {
                rule.points.push([x, y, z]);
                rule.weights.push(wx * wy * wz);
            }
        }
    }
    rule
}

/// Collapsed product rule on the unit tetrahedron with n^3 points, exact to total degree 2n - 3.
///
/// `xi = u, eta = v (1 - u), zeta = w (1 - u)(1 - v)`; the Jacobian `(1 - u)^2 (1 - v)` costs two degrees.
pub fn tetrahedron(n: usize) -> VolumeRule {
    let line = unit_interval(n);
    let mut rule = VolumeRule {
        points: Vec::new(),
        weights: Vec::new(),
    };
    for &(w, ww) in &line {
        for &(v, wv) in &line {
            for &(u, wu) in &line {
                let (p, q) = (1.0 - u, 1.0 - v);
                rule.points.push([u, v * p, w * p * q]);
                rule.weights.push(wu * wv * ww * p * p * q);
            }
        }
    }
    rule
}

/// Four points on the unit tetrahedron, exact to total degree 2 (Hammer and Stroud).
pub fn tetrahedron_4() -> VolumeRule {
    let root = 5.0_f64.sqrt();
    let (far, near) = ((5.0 + 3.0 * root) / 20.0, (5.0 - root) / 20.0);
    VolumeRule {
        points: vec![
            [near, near, near],
            [far, near, near],
            [near, far, near],
            [near, near, far],
        ],
        weights: vec![1.0 / 24.0; 4],
    }
}

/// Product rule on `[-1, 1]^2` with n points per direction (1 to 5), exact to degree 2n - 1 in each coordinate.
pub fn quadrilateral(n: usize) -> FacetRule {
    let line = gauss_legendre(n);
    let mut rule = FacetRule {
        points: Vec::new(),
        weights: Vec::new(),
    };
    for &(y, wy) in &line {
        for &(x, wx) in &line {
            rule.points.push([x, y]);
            rule.weights.push(wx * wy);
        }
    }
    rule
}

/// Collapsed product rule on the unit triangle with n^2 points, exact to total degree 2n - 2.
pub fn triangle(n: usize) -> FacetRule {
    let line = unit_interval(n);
    let mut rule = FacetRule {
        points: Vec::new(),
        weights: Vec::new(),
    };
    for &(v, wv) in &line {
        for &(u, wu) in &line {
            rule.points.push([u, v * (1.0 - u)]);
            rule.weights.push(wu * wv * (1.0 - u));
        }
    }
    rule
}

/// Gauss-Legendre points and weights on `[-1, 1]`, ascending, exact to degree 2n - 1.
///
/// # Panics
/// If n is not 1 to 5.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    match n {
        1 => vec![(0.0, 2.0)],
        2 => symmetric(None, &[((1.0_f64 / 3.0).sqrt(), 1.0)]),
        3 => symmetric(Some(8.0 / 9.0), &[(0.6_f64.sqrt(), 5.0 / 9.0)]),
        4 => {
            let (spread, root) = (2.0 / 7.0 * 1.2_f64.sqrt(), 30.0_f64.sqrt());
            let inner = ((3.0 / 7.0 - spread).sqrt(), (18.0 + root) / 36.0);
            let outer = ((3.0 / 7.0 + spread).sqrt(), (18.0 - root) / 36.0);
            symmetric(None, &[inner, outer])
        }
        5 => {
            let (spread, root) = (2.0 * (10.0_f64 / 7.0).sqrt(), 13.0 * 70.0_f64.sqrt());
            let inner = ((5.0 - spread).sqrt() / 3.0, (322.0 + root) / 900.0);
            let outer = ((5.0 + spread).sqrt() / 3.0, (322.0 - root) / 900.0);
            symmetric(Some(128.0 / 225.0), &[inner, outer])
        }
        _ => panic!("gauss-legendre rules have 1 to 5 points here, not {n}"),
    }
}

/// All points of a rule from its positive half (ascending) and the weight of its midpoint.
fn symmetric(midpoint: Option<f64>, half: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let below = half.iter().rev().map(|&(x, w)| (-x, w));
    below
        .chain(midpoint.map(|w| (0.0, w)))
        .chain(half.iter().copied())
        .collect()
}

/// Gauss-Legendre points and weights on `[0, 1]`.
fn unit_interval(n: usize) -> Vec<(f64, f64)> {
    gauss_legendre(n)
        .into_iter()
        .map(|(x, w)| (0.5 * (1.0 + x), 0.5 * w))
        .collect()
}
