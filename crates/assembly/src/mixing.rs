//! A fixed point x = g(x) with memory of the last rounds: D. G. Anderson, J. ACM 12 (1965) 547,
//! doi:10.1145/321296.321305.
//!
//! Of the last points the combination is taken whose residual g(x) - x is smallest if g were linear. On a linear g it
//! is GMRES (H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715): as many rounds as directions that matter.

/// Most rounds that are remembered.
const MEMORY: usize = 24;
/// A direction of which less than this is new is forgotten.
const NEW: f64 = 1e-8;

/// The last rounds of a fixed point.
#[derive(Default)]
pub struct Mixing {
    last: Option<[Vec<f64>; 2]>,
    /// Changes of residuals, orthonormal, and of points that belong to them.
    changes: Vec<[Vec<f64>; 2]>,
}

impl Mixing {
    /// The next point after x, of which g(x) is found.
    pub fn next(&mut self, x: Vec<f64>, found: &[f64]) -> Vec<f64> {
        let residual: Vec<f64> = found.iter().zip(&x).map(|(g, x)| g - x).collect();
        if let Some([x_before, r_before]) = self.last.take() {
            self.remember(difference(&residual, &r_before), difference(&x, &x_before));
        }
        let (mut next, mut left) = (x.clone(), residual.clone());
        for [of_residual, of_point] in &self.changes {
            let share = dot(&left, of_residual);
            add(&mut left, -share, of_residual);
            add(&mut next, -share, of_point);
        }
        add(&mut next, 1.0, &left);
        self.last = Some([x, residual]);
        next
    }

    /// Adds a direction, orthogonal to those before.
    fn remember(&mut self, mut of_residual: Vec<f64>, mut of_point: Vec<f64>) {
        if self.changes.len() == MEMORY {
            self.changes.clear();
        }
        let whole = dot(&of_residual, &of_residual).sqrt();
        for [r, x] in &self.changes {
            let share = dot(&of_residual, r);
            add(&mut of_residual, -share, r);
            add(&mut of_point, -share, x);
        }
        let size = dot(&of_residual, &of_residual).sqrt();
        if size > NEW * whole {
            let scaled = |v: Vec<f64>| v.into_iter().map(|v| v / size).collect();
            self.changes.push([scaled(of_residual), scaled(of_point)]);
        }
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn add(to: &mut [f64], factor: f64, of: &[f64]) {
    to.iter_mut().zip(of).for_each(|(t, o)| *t += factor * o);
}

/// Scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = A x + b with a spectral radius of 3, of two directions: found in their number of rounds and two.
    #[test]
    fn a_linear_map_that_grows_is_solved_in_as_many_rounds_as_it_has_directions() {
        let g = |x: &[f64]| -> Vec<f64> {
            let a = [[-3.0, 1.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.0, 0.0]];
            (0..3).map(|i| dot(&a[i], x) + [1.0, 2.0, 3.0][i]).collect()
        };
        let (mut mixing, mut x) = (Mixing::default(), vec![0.0; 3]);
        for _ in 0..4 {
            let found = g(&x);
            x = mixing.next(x, &found);
        }
        let off = difference(&g(&x), &x);
        assert!(dot(&off, &off).sqrt() < 1e-12, "{off:?}");
    }
}
