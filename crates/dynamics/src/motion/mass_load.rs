//! Loads that are the masses of a ring's nodes times a field of accelerations, in the coordinates of its body.

use ring::ElasticBody;

/// Load of the mass of a ring under a field of accelerations of its place, m/s2: a vector of the body. Collective.
pub(super) fn mass_load(body: &dyn ElasticBody, field: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
    let field = body.held().places.field(field);
    body.load(&body.matrices().nodal_mass_product(&field))
}

/// Weights of a ring under unit accelerations along x, y and z, vectors of its body.
pub(super) struct UnitWeights([Vec<f64>; 3]);

impl UnitWeights {
    /// Those of a body. Collective.
    pub fn of(body: &dyn ElasticBody) -> UnitWeights {
        let along = |axis: usize| mass_load(body, |_| [0, 1, 2].map(|i| f64::from(i == axis)));
        UnitWeights([along(0), along(1), along(2)])
    }

    /// Load under an acceleration, m/s2, in the frame of the ring.
    pub fn load(&self, g: [f64; 3]) -> Vec<f64> {
        let [x, y, z] = &self.0;
        let sum = |((x, y), z): ((&f64, &f64), &f64)| g[0] * x + g[1] * y + g[2] * z;
        x.iter().zip(y).zip(z).map(sum).collect()
    }
}
