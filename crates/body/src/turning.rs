//! The forms of a turning frame ([`crate::frame`]) from the mesh of a body.

use dense::{inner_products, linear_combinations};
use fem::Material;
use mesh::Mesh;
use rayon::prelude::*;

use crate::error::SurroundingError;
use crate::frame::FrameForms;
use crate::oscillators::BodyModes;
use crate::surrounding::Surrounding;

/// Oscillators of a block of products. Fixed, so that threads change no bit.
const AT_A_TIME: usize = 32;

impl Surrounding {
    /// The forms of a body that a shaft carries, of its modes and the columns K^-1 Phi of its seats, which go when they
    /// are no longer needed.
    pub(crate) fn frame_forms(
        &self,
        (mesh, material): (&Mesh, &Material),
        modes: &BodyModes,
        columns: Vec<f64>,
    ) -> Result<FrameForms, SurroundingError> {
        let (n, n_dofs) = (modes.n(), self.n_dofs);
        let numbers: Vec<usize> = (0..n).collect();
        let mut fields = vec![0.0; n * n_dofs];
        fields
            .par_chunks_mut(AT_A_TIME * n_dofs)
            .zip(numbers.par_chunks(AT_A_TIME))
            .for_each(|(fields, block)| self.fields_of_oscillators(block, modes, &columns, fields));
        drop(columns);
        let mass = fem::assemble_mass(mesh, material).map_err(|source| SurroundingError::Fem {
            body: self.name.clone(),
            source,
        })?;
        let form = |turn: fn([f64; 3]) -> [f64; 3]| -> Vec<f64> {
            let block = |fields_of: &[f64]| -> Vec<f64> {
                let mut moved = fields_of.to_vec();
                moved
                    .as_chunks_mut::<3>()
                    .0
                    .iter_mut()
                    .for_each(|u| *u = turn(*u));
                let k = moved.len() / n_dofs;
                inner_products(n_dofs, &fields, n, &solver::products(&mass, &moved, k), k)
            };
            fields
                .par_chunks(AT_A_TIME * n_dofs)
                .map(block)
                .collect::<Vec<_>>()
                .concat()
        };
        let mut forms = FrameForms {
            across: form(|[x, y, _]| [-y, x, 0.0]),
            radial: form(|[x, y, _]| [x, y, 0.0]),
        };
        forms.remove_round_off(n);
        Ok(forms)
    }

    /// The gyroscopic matrix of 1 rad/s about z, in space, of the first `n` oscillators of a body of revolution: 2 U^T
    /// S U with [`fem::assemble_azimuthal_mass`], `[n][n]` flat, over their velocities by rows.
    ///
    /// Beside it the acceleration of what moves through a place has W^2 d2u/dtheta2, and the spin stresses the body,
    /// which stiffens it by W^2. Where sections stay plane both cancel, as the section's own centrifugal forces hold
    /// it; both are left out. What that leaves is (W/omega)^2 of modes that deform sections.
    pub fn gyroscopic(&self, modes: &BodyModes, n: usize) -> Result<Vec<f64>, SurroundingError> {
        let Some((mesh, material)) = &self.mesh else {
            return Ok(vec![0.0; n * n]);
        };
        let azimuthal =
            fem::assemble_azimuthal_mass(mesh, material).map_err(|source| SurroundingError::Fem {
                body: self.name.clone(),
                source,
            })?;
        let mut fields = vec![0.0; n * self.n_dofs];
        let each = fields.par_chunks_mut(self.n_dofs).enumerate();
        each.for_each(|(i, field)| {
            let mut unit = vec![0.0; modes.n()];
            unit[i] = 1.0;
            field.copy_from_slice(&self.moved(modes, &unit));
        });
        let moved = solver::products(&azimuthal, &fields, n);
        let columns = inner_products(self.n_dofs, &fields, n, &moved, n);
        // Skew to the last bit, so that it does no work.
        let entry = |i: usize, j: usize| columns[n * j + i] - columns[n * i + j];
        Ok((0..n * n).map(|k| entry(k / n, k % n)).collect())
    }

    /// Displacements of all dofs of a block of oscillators, into `fields`, `[block][n_dofs]` flat.
    fn fields_of_oscillators(&self, block: &[usize], modes: &BodyModes, columns: &[f64], fields: &mut [f64]) {
        let (rows, n_dofs) = (self.free.len(), self.n_dofs);
        let (m, n_fixed) = (columns.len() / rows, modes.n_fixed);
        let [lam, shares] = [(&modes.forces, m), (&modes.shares, n_fixed)].map(|(of, width)| {
            let all = block.iter().flat_map(|&i| &of[width * i..width * (i + 1)]);
            all.copied().collect::<Vec<f64>>()
        });
        let mut free = linear_combinations(rows, columns, m, &lam, block.len());
        let own = linear_combinations(rows, &modes.fixed, n_fixed, &shares, block.len());
        free.iter_mut().zip(own).for_each(|(u, w)| *u += w);
        for ((&i, field), free) in block
            .iter()
            .zip(fields.chunks_exact_mut(n_dofs))
            .zip(free.chunks_exact(rows))
        {
            self.free.iter().zip(free).for_each(|(&dof, u)| field[dof] = *u);
            self.add_shaft_motion(modes.shaft_row(i), field);
        }
    }
}
