//! Puts a body on a shaft: what its mesh gives for that.

use fem::Material;
use mesh::Mesh;

use crate::carried::{Carried, CarriedInertia, N_SHAFT, ShaftPlace, dot};
use crate::error::SurroundingError;
use crate::surrounding::Surrounding;

/// Rigid motions: those of a shaft, and the rotation about z.
const N_RIGID: usize = N_SHAFT + 1;

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

impl Surrounding {
    /// The same body, carried by a shaft. The tilts of each bearing have their origin at one of the `origins`, m along
    /// z in the coordinates of its ring, by seat; those of the body at the first.
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
        let inertia = CarriedInertia {
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
fn asymmetry(inertia: &CarriedInertia, whole: impl Fn(usize, usize) -> f64) -> f64 {
    let gyration = (inertia.transverse / inertia.mass).sqrt();
    let unit = |k: usize| if k < 3 { 1.0 } else { gyration };
    let expected = |pair: (usize, usize)| match pair {
        (0, 0) | (1, 1) | (2, 2) => inertia.mass,
        (3, 3) | (4, 4) => inertia.transverse,
        (5, 5) => inertia.polar,
        (0, 4) | (4, 0) => inertia.first_moment,
        (1, 3) | (3, 1) => -inertia.first_moment,
        _ => 0.0,
    };
    let pairs = (0..N_RIGID * N_RIGID).map(|pair| (pair / N_RIGID, pair % N_RIGID));
    let off = pairs.map(|(i, k)| (whole(i, k) - expected((i, k))) / (inertia.mass * unit(i) * unit(k)));
    off.fold(0.0, |most: f64, off| most.max(off.abs()))
}
