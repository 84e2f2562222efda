//! Force and moment of traction over the ellipse of a contact.
//!
//! Quadrature: Gauss-Legendre in y/a with the weight 3/4 (1 - (y/a)^2), which is the ellipse's load per length; on each
//! of these lines Chebyshev's of the second kind in x, for the pressure along it. The moment of pure spin is good to
//! 0.8 % with 3 x 15 places at a/b = 9.9, to 0.2 % with 3 x 31.
//!
//! Over strips ([`contact::strips`]) the lines are those of the envelope of what is touched ([`contact::extent`]); on a
//! smooth groove it is the ellipse. Each line stands for a part of the envelope as wide as its weight. It has the share
//! of its load that the strips leave of the part, in the middle of what is left. A line whose part carries nothing has
//! no traction. Where o is the mean overlap of a part, the line is sqrt(2 R' o) b/a long, and its pressure goes with
//! sqrt(o) as Hertz's does. So shares are never negative and change steadily with the surface; on a smooth groove they
//! are Hertz's. An edge within a part is good to the square of the part's width.

use contact::{SemiAxes, StripLoads};

use super::law::TractionLaw;

/// Motion of the ball's surface relative to the ring's, in the frame (t, q, n).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slip {
    /// At the centre of the contact, along t and q, m/s.
    pub centre: [f64; 2],
    /// Relative angular velocity, rad/s; the last is the spin.
    pub turning: [f64; 3],
}

/// The contact over which traction is spread.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ellipse {
    /// Semi-axes a along the groove and b in the rolling direction, m.
    pub semi_axes: SemiAxes,
    /// Radius R_d of the deformed surface across the track, m; infinite is flat.
    pub radius: f64,
    /// Largest pressure, Pa.
    pub peak_pressure: f64,
    /// Thickness of the film, m; 0 where the law of traction knows none.
    pub film: f64,
}

/// A place of the unit ellipse and its share of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PatchPoint {
    x: f64,
    y: f64,
    share: f64,
    /// Pressure over the ellipse's largest.
    pressure: f64,
}

/// PatchPoints over an ellipse.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchPoints {
    /// Line by line.
    places: Vec<PatchPoint>,
    /// Where the parts of the lines begin and end, from -1 to 1, `[lines + 1]`.
    cuts: Vec<f64>,
}

/// Traction on the ball about the centre of the contact, in the frame (t, q, n): two forces, N, and three moments, N m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultant {
    /// Forces along t and q, then moments about t, q and n.
    pub action: [f64; 5],
    /// Their growth with the slip at the centre (t, q) and the turning (t, q, n): symmetric, never positive where the
    /// coefficient does not fall.
    pub slope: [[f64; 5]; 5],
    /// Power of the traction on both bodies, W: never positive.
    pub power: f64,
    /// Largest speed of slip, m/s, times the share of the pressure there in the peak pressure.
    pub severity: f64,
}

impl PatchPoints {
    /// `along` places in each line along t, on `lines` lines across, whose shares add up to one.
    pub fn new([along, lines]: [usize; 2]) -> PatchPoints {
        let n = (along + 1) as f64;
        // The rule has Hertz's loads of two and more lines exactly; one carries all of the force.
        let sum = if lines == 1 { 1.5 } else { 1.0 };
        let mut places = Vec::with_capacity(along * lines);
        let mut cuts = vec![-1.0];
        for [y, weight] in gauss_legendre(lines) {
            cuts.push(cuts[cuts.len() - 1] + weight);
            let half = (1.0 - y * y).sqrt();
            let load = 0.75 * (1.0 - y * y) * weight / sum;
            for k in 1..=along {
                let (sin, cos) = (k as f64 * std::f64::consts::PI / n).sin_cos();
                let x = half * cos;
                places.push(PatchPoint {
                    x,
                    y,
                    share: load * 2.0 / n * sin * sin,
                    pressure: (1.0 - x * x - y * y).max(0.0).sqrt(),
                });
            }
        }
        PatchPoints { places, cuts }
    }

    /// The same places over strips, in the ellipse with the half-width `half_width` across the track, m. `loads` gives
    /// the load of the strips between cuts of their envelope from -1 to 1.
    pub fn over_strips(&self, half_width: f64, loads: impl FnOnce(&[f64]) -> StripLoads) -> PatchPoints {
        let loads = loads(&self.cuts);
        let lines = self.places.chunks(self.places.len() / loads.parts.len());
        let mut places = Vec::with_capacity(self.places.len());
        let wider = loads.half_width / half_width;
        for (line, part) in lines.zip(&loads.parts).filter(|(_, part)| part.left > 0.0) {
            let stretch = part.overlap.sqrt() * wider;
            places.extend(line.iter().map(|place| PatchPoint {
                x: stretch * place.x,
                y: (place.y * loads.half_width + part.shift).clamp(part.ends[0], part.ends[1]) / half_width,
                share: place.share * part.left,
                pressure: stretch * place.pressure,
            }));
        }
        let sum: f64 = places.iter().map(|place| place.share).sum();
        places.iter_mut().for_each(|place| place.share /= sum);
        PatchPoints {
            places,
            cuts: self.cuts.clone(),
        }
    }

    /// Traction under a force of `force` N; `small` is the slip s_v, m/s.
    pub fn traction(
        &self,
        law: &TractionLaw,
        ellipse: &Ellipse,
        slip: &Slip,
        (force, small): (f64, f64),
    ) -> Resultant {
        let [a, b] = ellipse.semi_axes.into();
        let ([s_t, s_q], [w_t, w_q, w_n]) = (slip.centre, slip.turning);
        let mut found = Resultant::default();
        for place in &self.places {
            let (x, y) = (b * place.x, a * place.y);
            let z = -y * y / (2.0 * ellipse.radius);
            let s = [s_t - w_n * y + w_q * z, s_q + w_n * x - w_t * z];
            let square = s[0] * s[0] + s[1] * s[1];
            let size = square.sqrt();
            let g = (square + small * small).sqrt();
            let pressure = place.pressure;
            let [mu, rise] = law.at_place([size, g], pressure * ellipse.peak_pressure, ellipse.film);
            let load = force * place.share;
            let f = s.map(|s| -mu * load * s / g);
            found.power += f[0] * s[0] + f[1] * s[1];
            found.severity = found.severity.max(size * pressure);
            // Growth of both slips with the slip and the turning of the contact; forces and moments are its transpose.
            let rows = [[1.0, 0.0, 0.0, z, -y], [0.0, 1.0, -z, 0.0, x]];
            let more = if size > 0.0 { rise / size } else { 0.0 };
            let along = mu / (g * g) - more;
            let bend = [0, 1].map(|i| {
                [0, 1].map(|j| {
                    let identity = if i == j { mu } else { 0.0 };
                    -load / g * (identity - along * s[i] * s[j])
                })
            });
            for i in 0..5 {
                found.action[i] += rows[0][i] * f[0] + rows[1][i] * f[1];
                let left = [0, 1].map(|j| rows[0][i] * bend[0][j] + rows[1][i] * bend[1][j]);
                for (j, slope) in found.slope[i].iter_mut().enumerate() {
                    *slope += left[0] * rows[0][j] + left[1] * rows[1][j];
                }
            }
        }
        found
    }
}

/// PatchPoints on -1..1 and weights of Gauss and Legendre's rule, ascending: the roots of P_n by Newton's iteration.
fn gauss_legendre(n: usize) -> Vec<[f64; 2]> {
    let root = |i: usize| {
        // Tricomi's first guess is good to 1e-3.
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut before, mut value) = (0.0, 1.0);
            for k in 0..n {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        [x, 2.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..n).map(root).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::hertz::Elastic;
    use contact::{BearingGeometry, HertzContact, Side, StripLaw, StripLine};

    const FLAT: f64 = f64::INFINITY;

    fn turning(w_n: f64) -> Slip {
        Slip {
            turning: [0.0, 0.0, w_n],
            ..Slip::default()
        }
    }

    fn inner_7010c() -> [f64; 2] {
        let steel = Elastic {
            young_modulus: 207e9,
            poisson_ratio: 0.3,
        };
        let geometry = BearingGeometry::reference_7010c();
        HertzContact::new(&geometry, Side::Inner, steel, steel)
            .semi_axes(332.0)
            .into()
    }

    /// Complete elliptic integral of the second kind by its arithmetic-geometric mean (DLMF 19.8.6): a second way than
    /// that of the program.
    fn elliptic_e(m: f64) -> f64 {
        let (mut a, mut g, mut sum, mut power) = (1.0, (1.0 - m).sqrt(), 1.0 - 0.5 * m, 1.0);
        for _ in 0..40 {
            let c = 0.5 * (a - g);
            (a, g) = (0.5 * (a + g), (a * g).sqrt());
            sum -= power * c * c;
            power *= 2.0;
        }
        sum * std::f64::consts::FRAC_PI_2 / a
    }

    /// Wrong: a coarse set of places would have more or less friction than the coefficient says.
    #[test]
    fn shares_of_any_places_add_up_to_one() {
        for places in [[1, 1], [3, 1], [1, 2], [1, 15], [3, 15], [63, 63]] {
            let sum: f64 = PatchPoints::new(places)
                .places
                .iter()
                .map(|place| place.share)
                .sum();
            assert!((sum - 1.0).abs() < 1e-14, "{places:?}: {sum}");
        }
    }

    const STRIPS: StripLaw = StripLaw {
        stiffness: 1e10,
        density: 5e10,
        parabola_radius: 0.06,
        groove_radius: 4.75e-3,
    };
    const APPROACH: f64 = 8e-6;

    /// Half-width of the whole ellipse, m.
    fn half_width() -> f64 {
        (2.0 * STRIPS.parabola_radius * APPROACH).sqrt()
    }

    /// Places over a groove of which [from, to], in half-widths of the whole ellipse, is missing.
    fn places_without(points: [usize; 2], [from, to]: [f64; 2]) -> PatchPoints {
        let beta = |y: f64| y * half_width() / STRIPS.groove_radius;
        let angles = [
            -1.0,
            beta(from - 1e-9),
            beta(from),
            beta(to),
            beta(to + 1e-9),
            1.0,
        ];
        let line = StripLine {
            angles: &angles,
            missing: &[0.0, 0.0, 1e-3, 1e-3, 0.0, 0.0],
            worn: None,
        };
        PatchPoints::new(points).over_strips(half_width(), |cuts| {
            STRIPS.loads(&line, (APPROACH, 0.0), 0.0, cuts)
        })
    }

    /// Wrong: strips of a smooth groove would have another traction than Hertz's ellipse. The same places and shares,
    /// to the round-off of integrals over up to 63 parts.
    #[test]
    fn places_over_strips_of_a_smooth_groove_are_those_of_the_ellipse() {
        for points in [[1, 1], [3, 15], [5, 63]] {
            let found = places_without(points, [2.0, 3.0]).places;
            let expected = PatchPoints::new(points).places;
            assert_eq!(found.len(), expected.len());
            for (a, b) in found.iter().zip(&expected) {
                let pairs = [
                    (a.x, b.x),
                    (a.y, b.y),
                    (a.share, b.share),
                    (a.pressure, b.pressure),
                ];
                assert!(pairs.iter().all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} {b:?}");
            }
        }
    }

    /// Wrong: traction would act where the groove has ended, or where a spall has left nothing; or the moment of spin
    /// would be that of the whole ellipse. A slender ellipse whose load per length is 3/4 (1 - Y^2) where material
    /// stands has mu Q a times the mean of |Y| under it. An edge within a part, and the kink of |Y|, are good to the
    /// square of the part's width: 2/15 and 2/63.
    #[test]
    fn edges_and_spalls_carry_no_traction_and_have_their_closed_moment_of_spin() {
        let (mu, force, w) = (0.07, 332.0, 100.0);
        // Integrals of (1 - Y^2) and |Y| (1 - Y^2) from 0 to Y.
        let load = |y: f64| y - y.powi(3) / 3.0;
        let moment = |y: f64| y.signum() * (0.5 * y * y - 0.25 * y.powi(4));
        for gone in [[0.5, 2.0], [0.0, 2.0], [-0.4, 2.0], [-0.5, 0.5], [-0.3, 0.2]] {
            let [from, to] = gone.map(|y: f64| y.clamp(-1.0, 1.0));
            let left = |f: &dyn Fn(f64) -> f64| f(1.0) - f(-1.0) - (f(to) - f(from));
            let expected = left(&moment) / left(&load);
            for (lines, most) in [(15, (2.0f64 / 15.0).powi(2)), (63, (2.0f64 / 63.0).powi(2))] {
                let places = places_without([3, lines], gone);
                let sum: f64 = places.places.iter().map(|place| place.share).sum();
                assert!((sum - 1.0).abs() < 1e-13, "{sum}");
                let is_on_it = |y: f64| y <= gone[0] + 1e-12 || y >= gone[1] - 1e-12;
                assert!(
                    places
                        .places
                        .iter()
                        .all(|place| place.share > 0.0 && is_on_it(place.y))
                );
                let a = half_width();
                let ellipse = Ellipse {
                    semi_axes: SemiAxes::new(a, 1e-3 * a),
                    radius: FLAT,
                    ..Ellipse::default()
                };
                let law = TractionLaw::Coulomb(mu);
                let found = places.traction(&law, &ellipse, &turning(w), (force, 1e-9));
                let error = -found.action[4] / (mu * force * a) - expected;
                println!("gone {gone:?}, {lines} lines: {expected:.4} off by {error:e}");
                assert!(error.abs() < most, "{gone:?} {lines}: {error}");
            }
        }
    }

    /// Wrong: the moment of spin. 3/8 mu Q a E(m), 3 pi/16 mu Q a of a circle; 7010C inside at 332 N: a = 1.0155 mm,
    /// E = 1.01634. Errors of the quadrature are those of the module's text.
    #[test]
    fn pure_spin_has_its_closed_moment() {
        let mu = 0.07;
        let [a, b] = inner_7010c();
        let e = elliptic_e(1.0 - (b / a).powi(2));
        assert!(
            (a - 1.0155e-3).abs() < 2e-6 && (e - 1.01634).abs() < 2e-4,
            "{a} {e}"
        );
        // Three lines along t are made for slender ellipses.
        let slender: &[_] = &[([3, 15], 9e-3), ([3, 31], 2.5e-3), ([31, 63], 6e-4)];
        for (semi_axes, expected, rules) in [
            ([a, b], 0.375 * a * e, slender),
            (
                [1e-3; 2],
                3.0 * std::f64::consts::PI / 16.0 * 1e-3,
                &[([31, 63], 1e-3)],
            ),
        ] {
            for (points, most) in rules.iter().copied() {
                let ellipse = Ellipse {
                    semi_axes: SemiAxes::from(semi_axes),
                    radius: FLAT,
                    ..Ellipse::default()
                };
                let found = PatchPoints::new(points).traction(
                    &TractionLaw::Coulomb(mu),
                    &ellipse,
                    &turning(100.0),
                    (332.0, 1e-9),
                );
                let error = -found.action[4] / (mu * 332.0 * expected) - 1.0;
                assert!(error.abs() < most, "{points:?}: {error}");
                assert!((found.power + mu * 332.0 * 100.0 * expected).abs() < 1.1 * most * found.power.abs());
            }
        }
    }

    /// Wrong: differential slip of a conforming groove. Without a net force slip vanishes on |y| = 2 sin(10 deg) a and
    /// the moment is 0.16114 mu Q a^2 / (2 R_d) (both from 3/4 of the load at |y| > y_0 being half of it).
    #[test]
    fn free_rolling_in_a_groove_has_heathcotes_resistance() {
        let (mu, force, w) = (0.07, 332.0, 600.0);
        let [a, b] = inner_7010c();
        let ellipse = Ellipse {
            semi_axes: SemiAxes::new(a, b),
            radius: 4.57e-3,
            ..Ellipse::default()
        };
        let places = PatchPoints::new([3, 63]);
        let at = |s: f64| {
            let slip = Slip {
                centre: [s, 0.0],
                turning: [0.0, w, 0.0],
            };
            places.traction(&TractionLaw::Coulomb(mu), &ellipse, &slip, (force, 1e-7))
        };
        let (mut low, mut high) = (0.0, w * a * a / (2.0 * ellipse.radius));
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if at(middle).action[0] > 0.0 {
                low = middle
            } else {
                high = middle
            }
        }
        let y = (2.0 * ellipse.radius * low / w).sqrt() / a;
        assert!((y - 0.3473).abs() < 0.01, "{y}");
        // Sliding on lines: the rule of 63 lines has an error of a line's share where slip changes sign.
        let moment = -at(low).action[3] * 2.0 * ellipse.radius / (mu * force * a * a);
        assert!((moment - 0.16114).abs() < 0.003, "{moment}");
    }

    /// Wrong: what spin leaves of the grip. Slide with v = w_s a: along t 0.998 mu Q and 0.0037 mu Q a, along q 0.922
    /// and 0.169, of an ellipse with b/a = 0.101.
    #[test]
    fn sliding_kills_the_moment_of_spin() {
        let (mu, force, a, w) = (0.07, 332.0, 1e-3, 100.0);
        let ellipse = Ellipse {
            semi_axes: SemiAxes::new(a, 0.101 * a),
            radius: FLAT,
            ..Ellipse::default()
        };
        let places = PatchPoints::new([15, 63]);
        for (centre, share, moment) in [([w * a, 0.0], 0.998, 0.0037), ([0.0, w * a], 0.922, 0.169)] {
            let slip = Slip { centre, ..turning(w) };
            let found = places.traction(&TractionLaw::Coulomb(mu), &ellipse, &slip, (force, 1e-9));
            let pull = found.action[0].hypot(found.action[1]) / (mu * force);
            let twist = found.action[4].abs() / (mu * force * a);
            assert!((pull - share).abs() < 1e-3, "{pull}");
            assert!((twist - moment).abs() < 5e-4, "{twist}");
        }
    }

    /// Wrong: Newton would use a wrong tangent, or traction would do work. Difference quotients.
    #[test]
    fn slopes_are_derivatives_and_power_is_a_loss() {
        let ellipse = Ellipse {
            semi_axes: SemiAxes::new(1e-3, 1e-4),
            radius: 4.6e-3,
            peak_pressure: 1e9,
            film: 0.4e-6,
        };
        let curve = super::super::law::Curve::new(super::super::law::CurvePoints {
            at_rest: 0.02,
            most: 0.08,
            slip_of_most: 0.05,
            at_large: 0.03,
        });
        let places = PatchPoints::new([3, 15]);
        let slip = [0.02, -0.01, 30.0, 500.0, 120.0];
        let at = |law: &TractionLaw, s: [f64; 5]| {
            let slip = Slip {
                centre: [s[0], s[1]],
                turning: [s[2], s[3], s[4]],
            };
            places.traction(law, &ellipse, &slip, (100.0, 3e-3))
        };
        let film = TractionLaw::LimitingShear(super::super::LimitingShear {
            eyring: 5e6,
            limit: 0.08,
            lubricant: contact::film::Lubricant {
                viscosity: 0.04,
                pressure_coefficient: 2.2e-8,
            },
        });
        for law in [TractionLaw::Coulomb(0.07), TractionLaw::Curve(curve), film] {
            let found = at(&law, slip);
            assert!(found.power < 0.0);
            let work: f64 = (0..5).map(|i| found.action[i] * slip[i]).sum();
            assert!((work / found.power - 1.0).abs() < 1e-12);
            for j in 0..5 {
                let step = 1e-6 * slip[j].abs();
                let moved = |sign: f64| {
                    let mut s = slip;
                    s[j] += sign * step;
                    at(&law, s).action
                };
                let (low, high) = (moved(-1.0), moved(1.0));
                for i in 0..5 {
                    let numeric = (high[i] - low[i]) / (2.0 * step);
                    let exact = found.slope[i][j];
                    let size = (found.slope[i][i] * found.slope[j][j]).abs().sqrt();
                    assert!(
                        (numeric - exact).abs() < 1e-5 * size,
                        "{i} {j}: {numeric} {exact}"
                    );
                }
            }
        }
    }
}
