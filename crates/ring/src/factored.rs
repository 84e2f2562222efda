//! Rings that are alike share their body and its factors: several bearings of one type on a shaft.
//!
//! What is shared does not change, so results have the bits that they have without. A step of a ring takes its factor
//! from memory at least twice; of the rings of a pair that share it, it may still be in the cache.

use std::ops::Deref;
use std::sync::{Arc, Mutex, PoisonError};

use body::SeatFunctions;

use crate::body::ElasticBody;
use crate::error::RingError;
use crate::free::{FreeFactor, is_free};
use crate::integrator::StepScheme;
use crate::step::StepFactor;

/// A body, and its factors as they are made.
pub struct FactoredBody {
    body: Arc<dyn ElasticBody>,
    factors: Mutex<Vec<(StepScheme, Arc<dyn StepFactor>)>>,
    /// The ring behind the seat of a tied one.
    behind: Option<Arc<FactoredBody>>,
}

impl FactoredBody {
    /// A body without factors; of a tied one with the ring behind its seat.
    pub(crate) fn new(body: Arc<dyn ElasticBody>, behind: Option<Arc<FactoredBody>>) -> Arc<FactoredBody> {
        Arc::new(FactoredBody {
            body,
            factors: Mutex::default(),
            behind,
        })
    }

    /// The ring behind the functions of its seat, if it is tied by these.
    pub(crate) fn behind_seat(&self, functions: &SeatFunctions) -> Option<&Arc<FactoredBody>> {
        let tied = self.body.tied().filter(|tied| tied.functions() == functions);
        tied.and(self.behind.as_ref())
    }

    /// The body alone.
    pub(crate) fn into_body(self: Arc<Self>) -> Arc<dyn ElasticBody> {
        self.body.clone()
    }

    /// The factor of a scheme and step size, made when first asked for.
    pub fn factor(&self, scheme: StepScheme) -> Result<Arc<dyn StepFactor>, RingError> {
        let known = || {
            let factors = self.factors.lock().unwrap_or_else(PoisonError::into_inner);
            let found = factors.iter().find(|(of, _)| *of == scheme);
            found.map(|(_, factor)| factor.clone())
        };
        if let Some(factor) = known() {
            return Ok(factor);
        }
        // Nobody waits for a factor under way. A second thread that makes it too makes the same bits.
        let factor = self.body.clone().step_factor(scheme)?;
        let factor: Arc<dyn StepFactor> = match is_free(&*self.body) {
            true => Arc::new(FreeFactor::new(self.body.clone(), factor, scheme)?),
            false => factor.into(),
        };
        if let Some(earlier) = known() {
            return Ok(earlier);
        }
        let mut factors = self.factors.lock().unwrap_or_else(PoisonError::into_inner);
        factors.push((scheme, factor.clone()));
        Ok(factor)
    }
}

impl Deref for FactoredBody {
    type Target = dyn ElasticBody;

    fn deref(&self) -> &Self::Target {
        &*self.body
    }
}
