//! Puts loads on all of a body: what its mass gives for that, at rest and of its oscillators ([`crate::loads`]).

use dense::inner_products;
use solver::LinearSolver;

use crate::carried::dot;
use crate::error::SurroundingError;
use crate::loads::{BodyLoad, ModalLoads, N_LOADS, UnitLoads};
use crate::matrix::MatrixBody;
use crate::oscillators::BodyModes;
use crate::rigid_part::RigidPart;
use crate::surrounding::Surrounding;

/// Unit loads of a body that stands: accelerations.
const N_STANDING: usize = 3;

impl Surrounding {
    /// The same body with what loads on all of it do; `matrix` is that of one from matrices. One without a mass stays
    /// as it is.
    pub fn with_loads(mut self, matrix: Option<&MatrixBody>) -> Result<Surrounding, SurroundingError> {
        let Some(forces) = self.unit_forces(matrix)? else {
            return Ok(self);
        };
        let mut solved = forces.concat();
        self.factor.solve(&mut solved, forces.len());
        let fields: Vec<Vec<f64>> = solved
            .chunks_exact(self.free.len())
            .map(|moved| self.on_all_dofs(moved))
            .collect();
        let measured = |field: &Vec<f64>| self.seats.iter().flat_map(|seat| seat.measure(field)).collect();
        let loads = UnitLoads {
            seats: fields.iter().map(measured).collect(),
            forces,
            fields,
        };
        self.bytes += loads.bytes();
        self.loads = Some(loads);
        Ok(self)
    }

    /// The unit loads on the free dofs; None without a mass.
    fn unit_forces(&self, matrix: Option<&MatrixBody>) -> Result<Option<Vec<Vec<f64>>>, SurroundingError> {
        let unit = |k: usize, [x, y, _]: [f64; 3]| match k {
            0..3 => [0, 1, 2].map(|c| f64::from(c == k)),
            3 => [x, y, 0.0],
            _ => [y, -x, 0.0],
        };
        let free = |force: Vec<f64>| self.free.iter().map(|&dof| force[dof]).collect();
        if let Some((mesh, material)) = &self.mesh {
            let mass = fem::assemble_mass(mesh, material).map_err(|source| SurroundingError::Fem {
                body: self.name.clone(),
                source,
            })?;
            let n = if self.carried.is_some() {
                N_LOADS
            } else {
                N_STANDING
            };
            let field = |k: usize| mesh.nodes.iter().flat_map(|x| unit(k, *x)).collect::<Vec<_>>();
            return Ok(Some(
                (0..n)
                    .map(|k| free(solver::products(&mass, &field(k), 1)))
                    .collect(),
            ));
        }
        let Some((mass, matrix)) = matrix.and_then(|matrix| Some((matrix.mass.as_ref()?, matrix))) else {
            return Ok(None);
        };
        let field = |k: usize| -> Vec<f64> {
            let places = matrix.places.iter().zip(&matrix.is_rotation);
            let moved = |(x, is_rotation): (&[f64; 3], &bool)| match is_rotation {
                true => [0.0; 3],
                false => unit(k, *x),
            };
            places.flat_map(moved).collect()
        };
        let load = |k: usize| free(solver::products(mass, &field(k), 1));
        Ok(Some((0..N_STANDING).map(load).collect()))
    }

    /// Factors of the unit loads of a load that the bearing of a seat sees; None where the body has none.
    pub(crate) fn factors(&self, seat: usize, load: Option<BodyLoad>) -> Option<[f64; N_LOADS]> {
        self.loads.as_ref()?;
        Some(load?.factors(self.turned[seat]))
    }

    /// The unit loads on oscillators of modes with held seats, whose squares of frequencies are `fixed`, rad^2/s^2.
    /// `by_forces` are the forces on the seats that move them as a unit load does, by load, N.
    pub(crate) fn modal_loads(
        &self,
        modes: &BodyModes,
        fixed: &[f64],
        by_forces: impl Fn(&[f64]) -> Vec<f64>,
    ) -> Option<ModalLoads> {
        let unit = self.loads.as_ref()?;
        let rigid = self.carried.as_ref().map(|carried| RigidPart::new(carried, &[]));
        let (rows, n_fixed, n) = (self.free.len(), modes.n_fixed, modes.n());
        let mut found = ModalLoads {
            loads: Vec::new(),
            at_rest: Vec::new(),
            beyond: Vec::new(),
        };
        for ((force, field), seats) in unit.forces.iter().zip(&unit.fields).zip(&unit.seats) {
            let on_fixed = inner_products(rows, &modes.fixed, n_fixed, force, 1);
            let shares: Vec<f64> = on_fixed.iter().zip(fixed).map(|(f, square)| f / square).collect();
            let m = seats.len();
            let load = |i: usize| {
                dot(&modes.forces[m * i..m * (i + 1)], seats)
                    + dot(&modes.shares[n_fixed * i..n_fixed * (i + 1)], &on_fixed)
            };
            let loads: Vec<f64> = (0..n).map(load).collect();
            let mut shown = self.displacement(&by_forces(seats));
            for (mode, share) in modes.fixed.chunks_exact(rows).zip(&shares) {
                let moved = self.free.iter().zip(mode);
                moved.for_each(|(&dof, u)| shown[dof] += share * u);
            }
            let moved: Vec<f64> = self.free.iter().map(|&dof| shown[dof]).collect();
            let of_rigid = rigid.as_ref().map(|rigid| rigid.momentum(&moved));
            let stands = |(i, (load, square)): (usize, (&f64, &f64))| match *square {
                0.0 => of_rigid.map_or(0.0, |of| of[i]),
                square => load / square,
            };
            let pairs = loads.iter().zip(&modes.squares).enumerate();
            found.at_rest.push(pairs.map(stands).collect());
            let beyond = field.iter().zip(&shown).map(|(all, shown)| all - shown);
            found.beyond.push(beyond.collect());
            found.loads.push(loads);
        }
        Some(found)
    }
}
