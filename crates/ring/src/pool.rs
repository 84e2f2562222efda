//! Long vectors whose memory is used again. Every step of a ring ends in new ones; memory that is fresh from the
//! system is zeroed page by page, which takes longer than to fill it.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, Mutex, PoisonError};

/// Vectors of one length that nobody needs any more: never more than were needed at once.
#[derive(Clone, Default)]
pub struct VectorPool {
    len: usize,
    free: Arc<Mutex<Vec<Vec<f64>>>>,
}

/// A vector that goes back to its pool, if it has one.
#[derive(Default)]
pub struct PooledVector {
    numbers: Vec<f64>,
    pool: VectorPool,
}

impl VectorPool {
    /// Without vectors, for vectors of `len` numbers.
    pub fn new(len: usize) -> VectorPool {
        VectorPool {
            len,
            free: Arc::default(),
        }
    }

    /// A vector to be wholly overwritten: it has the numbers of its last use.
    pub fn take(&self) -> PooledVector {
        let used = self.free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        PooledVector {
            numbers: used.unwrap_or_else(|| vec![0.0; self.len]),
            pool: self.clone(),
        }
    }

    /// The same where it is wanted, else an empty one.
    pub fn take_if<T>(&self, wanted: Option<T>) -> PooledVector {
        wanted.map_or_else(PooledVector::default, |_| self.take())
    }
}

impl PooledVector {
    /// Its numbers, which do not go back.
    pub fn into_vec(mut self) -> Vec<f64> {
        std::mem::take(&mut self.numbers)
    }
}

impl From<Vec<f64>> for PooledVector {
    fn from(numbers: Vec<f64>) -> PooledVector {
        PooledVector {
            numbers,
            pool: VectorPool::default(),
        }
    }
}

impl Drop for PooledVector {
    fn drop(&mut self) {
        if self.pool.len > 0 && self.numbers.len() == self.pool.len {
            let mut free = self.pool.free.lock().unwrap_or_else(PoisonError::into_inner);
            free.push(std::mem::take(&mut self.numbers));
        }
    }
}

impl Clone for PooledVector {
    fn clone(&self) -> PooledVector {
        if self.pool.len == 0 {
            return PooledVector::from(self.numbers.clone());
        }
        let mut copy = self.pool.take();
        copy.copy_from_slice(self);
        copy
    }
}

impl Deref for PooledVector {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.numbers
    }
}

impl DerefMut for PooledVector {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.numbers
    }
}

impl PartialEq for PooledVector {
    fn eq(&self, other: &PooledVector) -> bool {
        self.numbers == other.numbers
    }
}

impl fmt::Debug for PooledVector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.numbers.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: each step would take fresh memory, or a vector would go back while a copy of it is in use.
    #[test]
    fn a_vector_is_used_again_when_nobody_has_it() {
        let pool = VectorPool::new(3);
        let mut first = pool.take();
        first.copy_from_slice(&[1.0, 2.0, 3.0]);
        let copy = first.clone();
        let place = first.as_ptr();
        drop(first);
        let again = pool.take();
        assert_eq!(again.as_ptr(), place);
        assert_eq!(*copy, [1.0, 2.0, 3.0]);
        let kept = again.into_vec();
        assert_ne!(pool.take().as_ptr(), kept.as_ptr());
        assert!(pool.take_if(None::<()>).is_empty());
    }
}
