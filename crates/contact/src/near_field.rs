//! Stress near contacts that a mesh cannot resolve: Hertz's instead of that of the spread patch.
//!
//! A ring carries a contact force over a patch of a few elements ([`crate::patch`]), not over the much smaller Hertz
//! ellipse. Both have the same force, so their fields differ only nearby, and there the raceway is nearly a
//! half-space:
//!
//! ```text
//! sigma = sigma_FE(patch) + w [ sigma_halfspace(Hertz ellipse) - sigma_halfspace(patch) ]
//! ```
//!
//! **Frame.** The half-space is wrapped round the torus: x is the arc along the groove and y that in the rolling
//! direction, both on the raceway, z the depth below it, and the tensor is taken in the directions of these
//! coordinates at the point itself. So the raceway stays free of traction outside the ellipse and carries exactly
//! Hertz's pressure inside, everywhere on the torus. What the curvatures of the raceway change below is added to
//! first order ([`CurvedSurface`]): up to 0.1 of the peak pressure, as tension along the groove. Left out: the second
//! order in size over radius, how the circles of rolling diverge, and that the forces of a patch are parallel.
//!
//! **Distance.** The difference falls with the fourth power of the distance. The weight w is 1 up to half the reach,
//! then falls with two continuous derivatives to 0 at the reach, so nothing jumps when a ball rolls by. `reach`
//! counts larger semi-axes of the patch.
//!
//! Friction: the difference of tangential tractions would be added in the same way; there is none yet.
//!
//! Cost: two half-space fields at every point within reach of a contact; of their corrections for curvature, up to
//! 320 point loads each for points within one to two semi-axes, 4 to 16 beyond, by the vectors of the processor.
//! Memory: 28 bytes per point.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::halfspace::{CurvatureRules, CurvedSurface, EllipticPressure};
use crate::raceway::Groove;
use crate::semi_axes::SemiAxes;
use crate::unwrap::unwrap_near;

/// Bins of azimuth in which points are looked up.
const N_BINS: usize = 1024;

/// A contact force on a ring: where it is spread in the computation, and where Hertz has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedPatch {
    /// Azimuth in the ring's frame, rad.
    pub azimuth: f64,
    /// Normal force, N.
    pub force: f64,
    /// Groove angle of the contact, rad.
    pub angle: f64,
    /// Semi-axes of the Hertz ellipse, m.
    pub semi_axes: SemiAxes,
    /// Groove angle of the spread patch, rad.
    pub patch_angle: f64,
    /// Semi-axes of the spread patch, m.
    pub patch_axes: SemiAxes,
}

/// A point in the coordinates of a raceway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingPoint {
    /// Azimuth, rad.
    pub azimuth: f64,
    /// Groove angle, rad.
    pub angle: f64,
    /// Depth below the raceway, m.
    pub depth: f64,
}

/// Points of a ring whose stress is to be corrected.
pub struct NearField {
    groove: Groove,
    poisson_ratio: f64,
    /// Larger semi-axes of a patch within which its contact is corrected.
    reach: f64,
    rules: CurvatureRules,
    points: Vec<RingPoint>,
    /// Points by bin of azimuth: those of bin i are `order[start[i]..start[i + 1]]`.
    start: Vec<usize>,
    order: Vec<u32>,
}

/// What stands in the place of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InPlace {
    Hertz,
    Nothing,
}

impl RingPoint {
    /// Coordinates of a point of the mesh, m.
    pub fn of(groove: &Groove, x: [f64; 3]) -> RingPoint {
        let [azimuth, angle] = groove.coordinates(x);
        let radial = x[0].hypot(x[1]) - groove.centre_radius;
        RingPoint {
            azimuth,
            angle,
            depth: radial.hypot(x[2] - groove.centre_z) - groove.groove_radius,
        }
    }

    /// The point in the coordinates of the mesh, m.
    pub fn position(&self, groove: &Groove) -> [f64; 3] {
        let [radial, axial] = groove.direction(self.angle);
        let distance = groove.groove_radius + self.depth;
        let r = groove.centre_radius + distance * radial;
        let (sin, cos) = self.azimuth.sin_cos();
        [r * cos, r * sin, groove.centre_z + distance * axial]
    }

    /// Unit vectors along the groove, in the rolling direction (growing azimuth) and into the ring.
    pub fn axes(&self, groove: &Groove) -> [[f64; 3]; 3] {
        let [radial, axial] = groove.direction(self.angle);
        let (sin, cos) = self.azimuth.sin_cos();
        [
            [-axial * cos, -axial * sin, radial],
            [-sin, cos, 0.0],
            [radial * cos, radial * sin, axial],
        ]
    }
}

impl NearField {
    /// Prepares points (m, in the coordinates of the mesh) of a ring of a given Poisson's ratio; `reach` counts
    /// larger semi-axes of a patch.
    pub fn new(groove: Groove, poisson_ratio: f64, reach: f64, positions: &[[f64; 3]]) -> NearField {
        let points: Vec<RingPoint> = positions.iter().map(|&x| RingPoint::of(&groove, x)).collect();
        let mut start = vec![0; N_BINS + 1];
        points.iter().for_each(|p| start[bin(p.azimuth) + 1] += 1);
        for i in 0..N_BINS {
            start[i + 1] += start[i];
        }
        let (mut next, mut order) = (start.clone(), vec![0; points.len()]);
        for (index, point) in points.iter().enumerate() {
            let place = &mut next[bin(point.azimuth)];
            order[*place] = index as u32;
            *place += 1;
        }
        NearField {
            groove,
            poisson_ratio,
            reach,
            rules: CurvatureRules::new(),
            points,
            start,
            order,
        }
    }

    /// Adds the correction of all contacts to the stress of the points, Pa, `[n_points][6]`, in the axes of the mesh.
    /// Contacts are added in their order, so the bits do not depend on threads nor on the other points.
    ///
    /// # Panics
    /// If `stress` has another length.
    pub fn add(&self, contacts: &[LoadedPatch], stress: &mut [[f64; 6]]) {
        self.put(contacts, InPlace::Hertz, stress);
    }

    /// Takes the patches of all contacts out of the stress of the points, Pa, `[n_points][6]`, in the axes of the mesh,
    /// and puts nothing there: what is left is the stress of the ring as a body.
    ///
    /// # Panics
    /// If `stress` has another length.
    pub fn take_out(&self, contacts: &[LoadedPatch], stress: &mut [[f64; 6]]) {
        self.put(contacts, InPlace::Nothing, stress);
    }

    fn put(&self, contacts: &[LoadedPatch], instead: InPlace, stress: &mut [[f64; 6]]) {
        assert_eq!(stress.len(), self.points.len(), "one stress per point");
        let of_contact = |contact| self.of_contact(contact, instead);
        let added: Vec<Vec<(u32, [f64; 6])>> = contacts.par_iter().map(of_contact).collect();
        for (index, tensor) in added.into_iter().flatten() {
            let sum = &mut stress[index as usize];
            for c in 0..6 {
                sum[c] += tensor[c];
            }
        }
    }

    /// Correction of one contact at the points within its reach, in the axes of the mesh.
    fn of_contact(&self, contact: &LoadedPatch, instead: InPlace) -> Vec<(u32, [f64; 6])> {
        if contact.force <= 0.0 || contact.semi_axes.minor() <= 0.0 {
            return Vec::new();
        }
        let distance = self.reach * contact.patch_axes.major();
        let (mut near, mut hertz_places, mut patch_places) = (Vec::new(), Vec::new(), Vec::new());
        for &index in self.candidates(contact.azimuth, distance) {
            let point = &self.points[index as usize];
            let [hertz, patch] =
                [contact.angle, contact.patch_angle].map(|angle| self.local(point, contact.azimuth, angle));
            let weight = weight(length(hertz) / distance);
            if weight > 0.0 {
                near.push((index, weight));
                hertz_places.push(hertz);
                patch_places.push(patch);
            }
        }
        let surface = CurvedSurface::new(&self.rules, self.curvatures(contact.angle));
        let hertz_peak = self.pressure(contact, contact.semi_axes).peak;
        let field = |semi_axes: SemiAxes, places: &[[f64; 3]]| {
            let pressure = self.pressure(contact, semi_axes);
            let mut stress = vec![[0.0; 6]; places.len()];
            pressure.stresses(places, &mut stress);
            surface.add_stresses(&pressure, hertz_peak, places, &mut stress);
            stress
        };
        let hertz = match instead {
            InPlace::Hertz => field(contact.semi_axes, &hertz_places),
            InPlace::Nothing => vec![[0.0; 6]; hertz_places.len()],
        };
        let patch = field(contact.patch_axes, &patch_places);
        let pairs = near.into_iter().zip(hertz.into_iter().zip(patch));
        pairs
            .map(|((index, weight), (hertz, patch))| {
                let difference = std::array::from_fn(|c| weight * (hertz[c] - patch[c]));
                let axes = self.points[index as usize].axes(&self.groove);
                (index, from_axes(difference, &axes))
            })
            .collect()
    }

    fn pressure(&self, contact: &LoadedPatch, semi_axes: SemiAxes) -> EllipticPressure {
        EllipticPressure::of_force(contact.force, semi_axes, self.poisson_ratio)
    }

    /// Curvatures of the raceway at a groove angle, 1/m, [along the groove, in the rolling direction], positive where
    /// concave.
    fn curvatures(&self, angle: f64) -> [f64; 2] {
        let [outwards, _] = self.groove.direction(angle);
        [
            1.0 / self.groove.groove_radius,
            outwards / self.groove.radius(angle),
        ]
    }

    /// [arc along the groove, arc in the rolling direction, depth] of a point from a contact, m.
    fn local(&self, point: &RingPoint, azimuth: f64, angle: f64) -> [f64; 3] {
        let turn = unwrap_near(point.azimuth, azimuth) - azimuth;
        [
            self.groove.groove_radius * (point.angle - angle),
            self.groove.radius(point.angle) * turn,
            point.depth.max(0.0),
        ]
    }

    /// Points whose azimuth is near enough, and some more.
    fn candidates(&self, azimuth: f64, distance: f64) -> impl Iterator<Item = &u32> {
        let smallest = (self.groove.centre_radius - self.groove.groove_radius).max(f64::MIN_POSITIVE);
        let bins = (distance / smallest * N_BINS as f64 / (2.0 * PI)).ceil();
        let (first, n) = if 2.0 * bins + 1.0 >= N_BINS as f64 {
            (0, N_BINS)
        } else {
            (bin(azimuth) + N_BINS - bins as usize, 2 * bins as usize + 1)
        };
        (first..first + n).flat_map(move |i| &self.order[self.start[i % N_BINS]..self.start[i % N_BINS + 1]])
    }
}

fn bin(azimuth: f64) -> usize {
    let share = azimuth.rem_euclid(2.0 * PI) / (2.0 * PI);
    ((share * N_BINS as f64) as usize).min(N_BINS - 1)
}

fn length(x: [f64; 3]) -> f64 {
    (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt()
}

/// 1 up to half the reach, 0 from the reach on, between them the polynomial of fifth order with two continuous
/// derivatives.
fn weight(share: f64) -> f64 {
    let s = (2.0 * share - 1.0).clamp(0.0, 1.0);
    1.0 - s * s * s * (10.0 + s * (6.0 * s - 15.0))
}

/// A tensor xx yy zz xy yz xz given in the directions `axes`, in the frame of these directions' components.
pub fn from_axes([xx, yy, zz, xy, yz, xz]: [f64; 6], axes: &[[f64; 3]; 3]) -> [f64; 6] {
    let own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    component(|i, j| {
        (0..3)
            .map(|k| axes[k][i] * (0..3).map(|l| own[k][l] * axes[l][j]).sum::<f64>())
            .sum()
    })
}

/// Components of a tensor xx yy zz xy yz xz in the directions `axes`: the inverse of [`from_axes`].
pub fn in_axes([xx, yy, zz, xy, yz, xz]: [f64; 6], axes: &[[f64; 3]; 3]) -> [f64; 6] {
    let own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    component(|i, j| {
        (0..3)
            .map(|k| axes[i][k] * (0..3).map(|l| own[k][l] * axes[j][l]).sum::<f64>())
            .sum()
    })
}

fn component(entry: impl Fn(usize, usize) -> f64) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].map(|(i, j)| entry(i, j))
}
