//! Moments of the volume of a ring, in closed form.

use std::f64::consts::TAU;

use super::RingSection;
use crate::error::MeshError;

/// Integrals over the volume of a ring, whose groove centres are at z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeMoments {
    /// Of 1, m^3.
    pub volume: f64,
    /// Of z, m^4.
    pub axial: f64,
    /// Of z^2, m^5.
    pub axial_square: f64,
    /// Of x^2 + y^2, m^5.
    pub polar: f64,
}

impl VolumeMoments {
    /// Of y^2 + z^2 = x^2 + z^2, m^5.
    pub fn transverse(&self) -> f64 {
        0.5 * self.polar + self.axial_square
    }
}

impl RingSection {
    /// Moments of the ring. Each is 2 pi times an integral over z of its integral over r, between seat and raceway.
    /// Along the groove r = c + s R cos t and z = R sin t: powers of cos t, integrated by their recurrence.
    pub fn moments(&self) -> Result<VolumeMoments, MeshError> {
        let g = self.geometry()?;
        let (sign, seat) = (self.side.sign(), 0.5 * self.seat_diameter);
        // Integrals of r^2/2, z r^2/2, z^2 r^2/2 and r^4/4.
        let mut sums = [0.0; 4];
        for (half, towards) in [(0, -1.0), (1, 1.0)] {
            let shoulder = 0.5 * self.shoulder_diameters[half];
            let (face, rim) = (g.face_z[half].abs(), g.groove_z[half].abs());
            let groove = groove_half(g.centre_radius, sign * g.groove_radius, g.groove_angles[half]);
            let solid = straight(seat, [0.0, face]);
            let land = straight(shoulder, [rim, face]);
            for (i, parity) in [1.0, towards, 1.0, 1.0].into_iter().enumerate() {
                sums[i] += parity * TAU * sign * (solid[i] - land[i] - groove[i]);
            }
        }
        Ok(VolumeMoments {
            volume: sums[0],
            axial: sums[1],
            axial_square: sums[2],
            polar: sums[3],
        })
    }
}

/// Integrals of r^2/2, z r^2/2, z^2 r^2/2 and r^4/4 over z at one radius.
fn straight(r: f64, [from, to]: [f64; 2]) -> [f64; 4] {
    let power = |n: i32| (to.powi(n) - from.powi(n)) / f64::from(n);
    let half = 0.5 * r * r;
    [
        half * power(1),
        half * power(2),
        half * power(3),
        half * half * power(1),
    ]
}

/// The same along half a groove, r = c + b cos t and z = |b| sin t, t from 0 to an angle.
fn groove_half(c: f64, b: f64, angle: f64) -> [f64; 4] {
    let (sin, cos) = angle.sin_cos();
    // Integrals of cos^n t.
    let mut cosines = [angle, sin, 0.0, 0.0, 0.0, 0.0];
    for n in 2..6 {
        let m = n as f64;
        cosines[n] = (cos.powi(n as i32 - 1) * sin + (m - 1.0) * cosines[n - 2]) / m;
    }
    let radius = b.abs();
    // r^n as a sum of powers of cos t, with the integral of the rest of each.
    let square = [c * c, 2.0 * c * b, b * b];
    let fourth = [
        c.powi(4),
        4.0 * c.powi(3) * b,
        6.0 * c * c * b * b,
        4.0 * c * b.powi(3),
        b.powi(4),
    ];
    let sum = |r: &[f64], rest: &dyn Fn(usize) -> f64| -> f64 { (0..r.len()).map(|k| r[k] * rest(k)).sum() };
    [
        0.5 * radius * sum(&square, &|k| cosines[k + 1]),
        0.5 * radius.powi(2) * sum(&square, &|k| (1.0 - cos.powi(k as i32 + 2)) / (k + 2) as f64),
        0.5 * radius.powi(3) * sum(&square, &|k| cosines[k + 1] - cosines[k + 3]),
        0.25 * radius * sum(&fourth, &|k| cosines[k + 1]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RingSide;

    fn section(side: RingSide, shoulders: [f64; 2]) -> RingSection {
        let (seat, raceway) = match side {
            RingSide::Inner => (50e-3, 56.01e-3),
            RingSide::Outer => (80e-3, 74.037e-3),
        };
        RingSection {
            side,
            seat_diameter: seat,
            raceway_diameter: raceway,
            groove_radius: 4.65e-3,
            shoulder_diameters: shoulders,
            width: 16e-3,
            groove_offset: 0.4e-3,
            groove_elements: 2,
            thickness_elements: 1,
            shoulder_elements: [1, 1],
            grading: 1.0,
        }
    }

    /// Wrong: mass or moments of inertia of a ring would not be those of its section. Against sums over 2e5 slices of
    /// the section, whose midpoint rule is off by 1e-9, and the volume by Pappus.
    #[test]
    fn moments_are_those_of_thin_slices() {
        for (side, shoulders) in [
            (RingSide::Inner, [60.4e-3, 58.0e-3]),
            (RingSide::Outer, [68.6e-3, 71.0e-3]),
        ] {
            let section = section(side, shoulders);
            let (found, g) = (section.moments().unwrap(), section.geometry().unwrap());
            let n = 200_000;
            let step = section.width / n as f64;
            let (mut sums, seat) = ([0.0; 4], 0.5 * section.seat_diameter);
            for i in 0..n {
                let z = g.face_z[0] + (i as f64 + 0.5) * step;
                let half = usize::from(z > 0.0);
                let r = if z.abs() < g.groove_z[half].abs() {
                    let reach = (g.groove_radius * g.groove_radius - z * z).sqrt();
                    g.centre_radius + side.sign() * reach
                } else {
                    0.5 * shoulders[half]
                };
                let ring = |power: i32| side.sign() * (seat.powi(power) - r.powi(power)) / f64::from(power);
                for (k, value) in [ring(2), z * ring(2), z * z * ring(2), ring(4)]
                    .into_iter()
                    .enumerate()
                {
                    sums[k] += TAU * step * value;
                }
            }
            let moments = [found.volume, found.axial, found.axial_square, found.polar];
            for (k, (a, b)) in moments.into_iter().zip(sums).enumerate() {
                let size = [1.0, section.width, section.width.powi(2), seat * seat][k] * found.volume;
                assert!((a - b).abs() < 1e-7 * size, "{side:?} {k}: {a:e} {b:e}");
            }
            let pappus = section.volume().unwrap();
            assert!((found.volume / pappus - 1.0).abs() < 1e-13, "{side:?}");
        }
    }
}
