//! One ring as a vibrating body: K and M in its coordinates, the factor of K + s M, and what its partner imposes.
//!
//! A clamped surface that moves with dofs of the partner has these as coordinates. A mean-motion hold leaves all
//! nodes free; its held motions are constraints c^T w = 0, where c takes the area-weighted least-squares rigid motion
//! of the surface. A mass of the partner acts on the motions that it follows. A ring that is tied to a body has the
//! oscillators of this after its own coordinates (`tied::vibration`).

use solver::LinearSolver;

use crate::body::{Held, HeldRing, Partner};
use crate::error::RingError;
use crate::harmonic::harmonics::Harmonics;
use crate::harmonic::periodic::Periodic;
use crate::matrices::{NodalMatrices, SparseMatrices};
use crate::model::{Backend, Hold, RingModel};
use crate::sparse::{SparseLoad, sparse_dot};
use crate::tied::vibration::VibratingTie;

/// A ring ready to vibrate.
pub struct VibratingRing {
    held: HeldRing,
    matrices: Box<dyn NodalMatrices>,
    factor: Box<dyn LinearSolver>,
    /// Held motions of a mean-motion hold, as generalised loads.
    pub constraints: Vec<SparseLoad>,
    /// Masses of the partner: generalised load of the motion that one follows, and kg or kg m^2.
    pub lumps: Vec<(SparseLoad, f64)>,
    /// Motions x, y, z, tilt x, tilt y of the partner, where the ring knows them.
    partner: [Option<SparseLoad>; 5],
    /// The body to which it is tied.
    tie: Option<VibratingTie>,
}

impl VibratingRing {
    /// Assembles a ring and factors K + `shift` M. It is held as its model says by a partner whose translations carry
    /// `mass` (kg), or it floats.
    pub fn new(
        name: &'static str,
        ring: &RingModel,
        partner: Option<(Partner, [f64; 5])>,
        shift: f64,
        backend: Backend,
    ) -> Result<VibratingRing, RingError> {
        let hold = partner.map_or(Hold::Free, |_| ring.hold);
        let tied = ring.tie.as_ref().filter(|_| partner.is_some());
        let (of, masses) = partner.unwrap_or((Partner::AT_REST, [0.0; 5]));
        let held = HeldRing::new(name, ring, Held { hold, partner: of }, backend)?;
        let error = |source| RingError::Solver { side: name, source };
        let coefficients = [shift, 1.0];
        let (matrices, factor): (Box<dyn NodalMatrices>, Box<dyn LinearSolver>) =
            match Periodic::for_modes(ring, name, backend, &held.coordinates.held_nodes())? {
                Ok(periodic) => {
                    let (harmonics, stencils) = Harmonics::new(ring, &held, periodic)?;
                    let factor = harmonics
                        .bordered(&held, &stencils, coefficients)
                        .map_err(error)?;
                    (Box::new(stencils), Box::new(factor))
                }
                Err(_) => {
                    let matrices = SparseMatrices::new(ring, name, &held.coordinates)?;
                    let symbolic = matrices.analyse(ring, &held.coordinates).map_err(error)?;
                    let factor = matrices.factor(&symbolic, &held.coordinates, coefficients);
                    (Box::new(matrices), Box::new(factor.map_err(error)?))
                }
            };
        let of_ring = (&*factor, held.coordinates.n());
        let tie = tied.map(|tie| {
            let functions = ring.seat_functions(name)?;
            let functions = functions.expect("a ring that is tied has the functions of its seat");
            VibratingTie::new(tie, &functions, of_ring, shift)
        });
        let tie = tie.transpose()?;
        // A tied ring meets no rigid partner.
        let hold = if tie.is_some() { Hold::Free } else { hold };
        // A mount has the moving dofs of a clamped surface, or all mean motions.
        let moving = (0..5).filter(|&dof| of.moves[dof]);
        let of_mount = |k: usize| held.mount.rows.get(k).cloned();
        let motions: [Option<SparseLoad>; 5] = match hold {
            Hold::MeanMotion => [0, 1, 2, 3, 4].map(of_mount),
            Hold::Clamped | Hold::Free => {
                let mut motions = [const { None }; 5];
                moving.enumerate().for_each(|(k, dof)| motions[dof] = of_mount(k));
                motions
            }
        };
        let constraints = match hold {
            Hold::MeanMotion => (0..6)
                .filter(|&dof| dof == 5 || !of.moves[dof])
                .filter_map(of_mount)
                .collect(),
            Hold::Clamped | Hold::Free => Vec::new(),
        };
        let carries = |dof: &usize| masses[*dof] > 0.0 && of.moves[*dof];
        let lumps = (0..5)
            .filter(carries)
            .filter_map(|dof| Some((motions[dof].clone()?, masses[dof])));
        Ok(VibratingRing {
            lumps: lumps.collect(),
            constraints,
            partner: motions,
            tie,
            held,
            matrices,
            factor,
        })
    }

    /// How it is held.
    pub fn held(&self) -> &HeldRing {
        &self.held
    }

    /// Number of coordinates, with those of a body to which it is tied.
    pub fn n(&self) -> usize {
        let of_body = self.tie.as_ref().map_or(0, VibratingTie::n_oscillators);
        self.held.coordinates.n() + of_body
    }

    /// K Y of a block of vectors, column-major, without what constraints and contacts add.
    pub fn stiffness(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        let product = |y: &[f64]| {
            self.matrices
                .stiffness_products(&self.held.coordinates, y, n_vectors)
        };
        self.with_body(y, product, |square| square)
    }

    /// M Y of a block of vectors without the masses of the partner.
    pub fn mass(&self, y: &[f64], n_vectors: usize) -> Vec<f64> {
        let product = |y: &[f64]| -> Vec<f64> {
            let columns = y.chunks_exact((y.len() / n_vectors.max(1)).max(1));
            columns
                .flat_map(|y| self.matrices.mass_product(&self.held.coordinates, y))
                .collect()
        };
        self.with_body(y, product, |_| 1.0)
    }

    /// A product of the ring's own coordinates, and the oscillators of its body times a factor of their omega^2.
    fn with_body(
        &self,
        y: &[f64],
        product: impl Fn(&[f64]) -> Vec<f64>,
        of_oscillator: impl Fn(f64) -> f64,
    ) -> Vec<f64> {
        match &self.tie {
            None => product(y),
            Some(tie) => tie.joined(&product(&tie.of_ring(y)), y, of_oscillator),
        }
    }

    /// (K + s M)^-1 of a block of `n_vectors` loads, column-major `[n][n_vectors]`.
    pub fn solve(&self, loads: &mut [f64], n_vectors: usize) {
        match &self.tie {
            None => self.factor.solve(loads, n_vectors),
            Some(tie) => tie.solve(&*self.factor, loads),
        }
    }

    /// Takes the forces that tie it to a body out of a vector of forces.
    pub fn remove_reactions(&self, force: &mut [f64]) {
        if let Some(tie) = &self.tie {
            tie.remove_reactions(force);
        }
    }

    /// Displacement of its nodes, `[n_nodes][3]` flat.
    pub fn displacement(&self, y: &[f64]) -> Vec<f64> {
        let n_ring = self.held.coordinates.n();
        self.held.coordinates.expand(&y[..n_ring])
    }

    /// The same of the body to which it is tied; None where there is none, or a rigid one.
    pub fn body_displacement(&self, y: &[f64]) -> Option<Vec<f64>> {
        self.tie.as_ref()?.body_displacement(y)
    }

    /// What of y^T M y belongs to that body.
    pub fn body_mass(&self, y: &[f64]) -> f64 {
        self.tie.as_ref().map_or(0.0, |tie| tie.body_mass(y))
    }

    /// Generalised load of a motion (0 to 4: x, y, z, tilt x, tilt y) of the partner, where the ring knows it.
    pub fn partner_load(&self, dof: usize) -> Option<&SparseLoad> {
        self.partner[dof].as_ref()
    }

    /// Motion x, y, z, tilt x, tilt y of the partner, m and rad.
    pub fn partner_motion(&self, y: &[f64]) -> [f64; 5] {
        let value = |motion: &Option<SparseLoad>| motion.as_ref().map_or(0.0, |m| sparse_dot(m, y));
        self.partner.each_ref().map(value)
    }
}
