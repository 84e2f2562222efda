//! A ring tied to a body: what the ring's solver needs to know, and what the joint carries.

use std::sync::Arc;

use dense::DenseCholesky;

use crate::error::SurroundingError;
use crate::seat::{SeatBasis, SeatFunctions, SeatSpace};
use crate::surrounding::Surrounding;
use crate::vibration::BodyModes;

/// The joint of a ring with what is round it.
#[derive(Clone)]
pub struct SeatTie {
    /// Functions that are tied.
    pub space: SeatSpace,
    /// F of the body at these functions, m/N, `[n][n]` flat; zero for a rigid body.
    pub flexibility: Vec<f64>,
    /// The body; None for a rigid one.
    pub body: Option<Arc<Surrounding>>,
    /// What moves of it; None where it is at rest only.
    pub modes: Option<Arc<BodyModes>>,
}

/// What a joint carries at rest.
#[derive(Clone, Debug)]
pub struct SeatTraction {
    /// Forces on the ring, by function, N.
    pub forces: Vec<f64>,
    /// Motion of the seat, by function, m.
    pub motion: Vec<f64>,
}

/// How much the last functions matter: shares of the energy that the joint puts into the body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TieConvergence {
    /// Of the last two orders n.
    pub last_orders: f64,
    /// Of the last degree across.
    pub last_degree: f64,
}

impl SeatTie {
    /// A joint with the first seat of a body, which is its only one.
    pub fn to_body(body: Arc<Surrounding>) -> SeatTie {
        SeatTie {
            space: body.seats[0].space,
            flexibility: body.flexibility.clone(),
            body: Some(body),
            modes: None,
        }
    }

    /// The same for a motion, with the modes of the body with a held seat up to a frequency, Hz.
    pub fn in_motion(mut self, below_hz: f64) -> Result<SeatTie, SurroundingError> {
        if let Some(body) = &self.body {
            self.modes = Some(Arc::new(body.modes(below_hz)?));
        }
        Ok(self)
    }

    /// A joint with a rigid body.
    pub fn to_rigid(space: SeatSpace) -> SeatTie {
        let n = space.basis.n_functions();
        SeatTie {
            space,
            flexibility: vec![0.0; n * n],
            body: None,
            modes: Some(Arc::new(BodyModes::rigid())),
        }
    }

    /// What the joint carries when the ring stands as displaced, m, `[n_nodes][3]` flat; None for a rigid body.
    ///
    /// The body follows from its own flexibility: lam = -F^-1 g.
    pub fn traction(&self, ring: &SeatFunctions, displacement: &[f64]) -> Option<SeatTraction> {
        self.body.as_ref()?;
        let motion = ring.measure(displacement);
        let factor = DenseCholesky::factor(motion.len(), &self.flexibility).ok()?;
        let mut forces: Vec<f64> = motion.iter().map(|g| -g).collect();
        factor.solve(&mut forces, 1);
        Some(SeatTraction { forces, motion })
    }

    /// Displacement of the body, m, `[n_nodes][3]` flat.
    pub fn body_displacement(&self, traction: &SeatTraction) -> Option<Vec<f64>> {
        let onto_body: Vec<f64> = traction.forces.iter().map(|f| -f).collect();
        Some(self.body.as_ref()?.displacement(&onto_body))
    }
}

impl SeatTraction {
    /// Strain energy of the body, J.
    pub fn energy(&self) -> f64 {
        -0.5 * self.products().sum::<f64>()
    }

    fn products(&self) -> impl Iterator<Item = f64> + '_ {
        self.forces.iter().zip(&self.motion).map(|(f, g)| f * g)
    }

    /// Shares of the last functions in the energy.
    pub fn convergence(&self, basis: SeatBasis) -> TieConvergence {
        let SeatBasis::Harmonics { harmonics, across } = basis else {
            return TieConvergence::default();
        };
        let share = |is_last: &dyn Fn([usize; 2]) -> bool| {
            let mut sum = 0.0;
            for (function, product) in self.products().enumerate() {
                if basis.order_and_degree(function).is_some_and(is_last) {
                    sum += product;
                }
            }
            match 2.0 * self.energy() {
                0.0 => 0.0,
                total => (sum / total).abs(),
            }
        };
        TieConvergence {
            last_orders: share(&|[n, _]| n + 2 > harmonics),
            last_degree: share(&|[_, j]| j == across),
        }
    }
}
