//! A body that a shaft carries, such as a hollow end of it with the seat of an inner ring.
//!
//! Its fixed groups move with the shaft: its displacement is a rigid motion R q of the shaft and what it yields beside
//! that. At rest the ring stands on what it yields. In motion R q has inertia, and accelerates what yields.

use fem::Material;
use mesh::Mesh;

use crate::error::SurroundingError;
use crate::surrounding::Surrounding;

/// Motions of a shaft: x, y, z, tilts about x and y.
pub const N_SHAFT: usize = 5;
/// Rigid motions: those of a shaft, and the rotation about z.
const N_RIGID: usize = N_SHAFT + 1;

/// Inertia of a rigid body of revolution about a point of its axis, the origin of the tilts.
///
/// Its kinetic energy at the velocity v and the tilt rate w, both across the axis, is m v^2 / 2 + S (v_x w_y - v_y
/// w_x) + I w^2 / 2, besides that of the spin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigidInertia {
    /// Mass m, kg.
    pub mass: f64,
    /// First moment S: mass times the distance of its centre from the origin along z, kg m.
    pub first_moment: f64,
    /// Moment of inertia I about x and y through the origin, kg m^2.
    pub transverse: f64,
    /// Moment of inertia about z, kg m^2.
    pub polar: f64,
}

impl RigidInertia {
    /// Force and moment that a rigid motion with the acceleration `a` (x, y, z, tilt x, tilt y) asks for, N and N m,
    /// without the spin.
    pub fn times(&self, a: [f64; 5]) -> [f64; 5] {
        [
            self.mass * a[0] + self.first_moment * a[4],
            self.mass * a[1] - self.first_moment * a[3],
            self.mass * a[2],
            self.transverse * a[3] - self.first_moment * a[1],
            self.transverse * a[4] + self.first_moment * a[0],
        ]
    }

    /// That of two bodies about the same origin.
    pub fn with(self, other: RigidInertia) -> RigidInertia {
        RigidInertia {
            mass: self.mass + other.mass,
            first_moment: self.first_moment + other.first_moment,
            transverse: self.transverse + other.transverse,
            polar: self.polar + other.polar,
        }
    }
}

/// How a shaft carries a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// Inertia of the body as one of revolution, about the origin of the shaft's tilts.
    pub inertia: RigidInertia,
    /// How far it is from one of revolution: largest entry of its inertia that such a body has not, over its mass or
    /// what its radius of gyration makes of that.
    pub asymmetry: f64,
    /// R^T M R of the motions of the shaft, `[5][5]` flat.
    pub(crate) matrix: Vec<f64>,
    /// M R on the free dofs, by motion.
    pub(crate) pushes: Vec<Vec<f64>>,
    /// R of the functions of all seats, m per m or rad, by motion.
    pub(crate) seats: Vec<Vec<f64>>,
    /// Where the bearing of each seat stands.
    pub(crate) places: Vec<ShaftPlace>,
    /// The origin of the tilts along the body's own z, m.
    origin: f64,
}

/// Where a bearing stands on the shaft, seen from the body at the origin of its tilts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaftPlace {
    /// Distance along z of the body, m.
    distance: f64,
    /// Whether it is turned by 180 deg about x.
    is_turned: bool,
}

impl ShaftPlace {
    /// The motion of the shaft there, of that of the body.
    pub fn there(&self, [x, y, z, tilt_x, tilt_y]: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let [x, y] = [x + self.distance * tilt_y, y - self.distance * tilt_x];
        self.turned([x, y, z, tilt_x, tilt_y])
    }

    /// The motion of the body, of that of the shaft there.
    pub fn here(&self, there: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        let [x, y, z, tilt_x, tilt_y] = self.turned(there);
        [
            x - self.distance * tilt_y,
            y + self.distance * tilt_x,
            z,
            tilt_x,
            tilt_y,
        ]
    }

    /// An inertia about the origin of the body's tilts as a bearing there sees it.
    pub fn seen(&self, inertia: RigidInertia) -> RigidInertia {
        let way = if self.is_turned { -1.0 } else { 1.0 };
        RigidInertia {
            first_moment: way * inertia.first_moment,
            ..inertia
        }
    }

    fn turned(&self, [x, y, z, tilt_x, tilt_y]: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        match self.is_turned {
            true => [x, -y, -z, tilt_x, -tilt_y],
            false => [x, y, z, tilt_x, tilt_y],
        }
    }
}

impl Carried {
    /// Motions of the shaft that are orthonormal in R^T M R, by Gram and Schmidt.
    pub(crate) fn orthonormal(&self) -> [[f64; N_SHAFT]; N_SHAFT] {
        let mut found: [[f64; N_SHAFT]; N_SHAFT] = Default::default();
        for k in 0..N_SHAFT {
            let mut q = [0.0; N_SHAFT];
            q[k] = 1.0;
            // Once more against round-off.
            for earlier in found[..k].iter().chain(&found[..k]) {
                let share = dot(earlier, &self.momentum(q));
                (0..N_SHAFT).for_each(|i| q[i] -= share * earlier[i]);
            }
            let size = dot(&q, &self.momentum(q)).sqrt();
            found[k] = q.map(|x| x / size);
        }
        found
    }

    /// R^T M R q: what a motion of the shaft takes, kg m and kg m^2 per unit of it.
    pub(crate) fn momentum(&self, q: [f64; N_SHAFT]) -> [f64; N_SHAFT] {
        [0, 1, 2, 3, 4].map(|i| dot(&self.matrix[N_SHAFT * i..N_SHAFT * (i + 1)], &q))
    }

    /// Motion of the functions of all seats with the shaft, m.
    pub fn seat_motion(&self, q: [f64; N_SHAFT]) -> Vec<f64> {
        let mut sum = vec![0.0; self.seats[0].len()];
        for (row, q) in self.seats.iter().zip(q) {
            sum.iter_mut().zip(row).for_each(|(s, r)| *s += r * q);
        }
        sum
    }
}

/// Motions of a place by unit rigid motions, its arms from the origin of the tilts, m.
fn rigid_motions([x, y, z]: [f64; 3]) -> [[f64; 3]; N_RIGID] {
    [
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, -z, y],
        [z, 0.0, -x],
        [-y, x, 0.0],
    ]
}

/// A rigid motion of all dofs of a mesh.
fn rigid_field(mesh: &Mesh, origin: f64, motion: usize) -> Vec<f64> {
    let arms = mesh.nodes.iter().map(|[x, y, z]| [*x, *y, z - origin]);
    arms.flat_map(|arm| rigid_motions(arm)[motion]).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

impl Surrounding {
    /// The same body, carried by a shaft. The tilts of each bearing have their origin at one of the `origins`, m along z
    /// in the coordinates of its ring, by seat; those of the body at the first.
    pub fn on_shaft(mut self, origins: &[f64]) -> Result<Surrounding, SurroundingError> {
        let Some((mesh, material)) = &self.mesh else {
            return Err(SurroundingError::MatrixOnShaft {
                body: self.name.clone(),
            });
        };
        let in_body = |seat: usize| {
            let way = if self.turned[seat] { -1.0 } else { 1.0 };
            self.middles[seat] + way * (origins[seat] - self.seats[seat].space.middle)
        };
        let first = in_body(0);
        let place = |seat: usize| ShaftPlace {
            distance: in_body(seat) - first,
            is_turned: self.turned[seat],
        };
        let places = (0..self.seats.len()).map(place).collect();
        self.carried = Some(self.carried_by((mesh, material), first, places)?);
        Ok(self)
    }

    fn carried_by(
        &self,
        (mesh, material): (&Mesh, &Material),
        origin: f64,
        places: Vec<ShaftPlace>,
    ) -> Result<Carried, SurroundingError> {
        let mass = fem::assemble_mass(mesh, material).map_err(|source| SurroundingError::Fem {
            body: self.name.clone(),
            source,
        })?;
        let fields: Vec<Vec<f64>> = (0..N_RIGID).map(|k| rigid_field(mesh, origin, k)).collect();
        let products: Vec<Vec<f64>> = fields
            .iter()
            .map(|field| solver::products(&mass, field, 1))
            .collect();
        let whole = |i: usize, k: usize| dot(&fields[i], &products[k]);
        let inertia = RigidInertia {
            mass: 0.5 * (whole(0, 0) + whole(1, 1)),
            first_moment: 0.5 * (whole(0, 4) - whole(1, 3)),
            transverse: 0.5 * (whole(3, 3) + whole(4, 4)),
            polar: whole(5, 5),
        };
        let of_shaft = 0..N_SHAFT;
        let measured = |k: usize| {
            self.seats
                .iter()
                .flat_map(|seat| seat.measure(&fields[k]))
                .collect()
        };
        Ok(Carried {
            asymmetry: asymmetry(&inertia, whole),
            inertia,
            matrix: (0..N_SHAFT * N_SHAFT)
                .map(|i| whole(i / N_SHAFT, i % N_SHAFT))
                .collect(),
            pushes: of_shaft
                .clone()
                .map(|k| self.free.iter().map(|&dof| products[k][dof]).collect())
                .collect(),
            seats: of_shaft.map(measured).collect(),
            places,
            origin,
        })
    }

    /// Adds a rigid motion about the origin of the body's tilts to a displacement, m, `[n_nodes][3]` flat.
    pub(crate) fn add_shaft_motion(&self, q: [f64; N_SHAFT], field: &mut [f64]) {
        let (Some((mesh, _)), Some(carried)) = (&self.mesh, &self.carried) else {
            return;
        };
        for ([x, y, z], u) in mesh.nodes.iter().zip(field.chunks_exact_mut(3)) {
            let motions = rigid_motions([*x, *y, z - carried.origin]);
            for (motion, q) in motions.iter().zip(q) {
                (0..3).for_each(|c| u[c] += motion[c] * q);
            }
        }
    }
}

/// How far rigid motions are coupled otherwise than in a body of revolution.
fn asymmetry(inertia: &RigidInertia, whole: impl Fn(usize, usize) -> f64) -> f64 {
    let gyration = (inertia.transverse / inertia.mass).sqrt();
    let unit = |k: usize| if k < 3 { 1.0 } else { gyration };
    let mut largest: f64 = 0.0;
    for k in 0..N_RIGID {
        let expected = match k {
            5 => [0.0, 0.0, 0.0, 0.0, 0.0, inertia.polar],
            _ => {
                let mut q = [0.0; N_SHAFT];
                q[k] = 1.0;
                let [a, b, c, d, e] = inertia.times(q);
                [a, b, c, d, e, 0.0]
            }
        };
        for (i, expected) in expected.into_iter().enumerate() {
            let off = (whole(i, k) - expected) / (inertia.mass * unit(i) * unit(k));
            largest = largest.max(off.abs());
        }
    }
    largest
}
