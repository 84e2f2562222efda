//! A periodic ring with nodes that are free where most sectors hold them: its vectors are coordinates, its solves
//! harmonic.

use solver::cyclic::Loose;

use super::defect_step::DefectStep;
use super::factor::CyclicFactor;
use super::harmonics::Harmonics;
use super::space::{from_harmonics, to_harmonics};
use super::touch::Meeting;
use crate::body::HeldRing;
use crate::error::RingError;
use crate::matrices::{NodalMatrices, Stencils};
use crate::memory::MotionMemory;
use crate::nodal::columns::{Columns, Moved, NodalSolver, Ports};
use crate::step::PortForces;
use crate::vectors::add;

/// Harmonics, and matrices in coordinates.
pub(crate) struct LooseSolver {
    pub harmonics: Harmonics,
    pub stencils: Stencils,
}

/// The increment without forces of contacts and partner.
pub(crate) struct LoosePredictor {
    /// Of the regular ring, the first half of its solve: harmonics, the rows of the border and those that it lacks.
    regular: Vec<f64>,
    /// What the defect makes of it.
    defect: Option<DefectStep>,
}

impl NodalSolver for LooseSolver {
    type Columns = CyclicFactor;

    fn matrices(&self) -> &dyn NodalMatrices {
        &self.stencils
    }

    fn name(&self) -> &'static str {
        "cyclic"
    }

    fn note(&self) -> String {
        self.harmonics.note.clone()
    }

    fn memory(&self, held: &HeldRing) -> Option<MotionMemory> {
        Some(self.harmonics.sizes(held).memory())
    }

    fn factor(&self, held: &HeldRing, coefficients: [f64; 2]) -> Result<CyclicFactor, RingError> {
        self.harmonics.factor(held, &self.stencils, coefficients)
    }
}

impl CyclicFactor {
    /// The first half of S^-1 of a generalised load of coordinates: harmonics of the free nodes, then the rows of the
    /// border, and what [`solver::cyclic::Loose::take`] says of rows that the regular ring lacks.
    fn begin_coordinates(&self, mut load: Vec<f64>) -> Vec<f64> {
        let alone = self.loose().map(|loose| loose.take(&mut load));
        let mut x = to_harmonics(self.solver.inner().ring(), &load);
        x.extend(alone.into_iter().flatten());
        self.begin_in_place(&mut x);
        x
    }
}

impl Columns for CyclicFactor {
    type Predictor = LoosePredictor;

    const BY_TABLE: bool = true;

    fn bytes(&self) -> usize {
        self.bytes()
    }

    fn iterations(&self) -> Option<usize> {
        self.iterations()
    }

    fn begin(&self, held: &HeldRing, side: Vec<f64>, ports: &Ports) -> (LoosePredictor, Moved) {
        let regular = self.begin_coordinates(side);
        let Meeting { step, moved } = self.meet(held, ports, &regular, |defect, answers| {
            DefectStep::new(self.at_rows(&defect.answer, &regular), answers)
        });
        let predictor = LoosePredictor {
            regular,
            defect: step,
        };
        (predictor, moved)
    }

    fn move_contacts(&self, held: &HeldRing, predictor: &mut LoosePredictor, ports: &Ports) -> Moved {
        let old = predictor.defect.take();
        let Meeting { step, moved } = self.meet(held, ports, &predictor.regular, |_, answers| {
            old.expect("a ring keeps its defect").met_by(answers)
        });
        predictor.defect = step;
        moved
    }

    fn add_load(
        &self,
        held: &HeldRing,
        predictor: &mut LoosePredictor,
        load: Vec<f64>,
        ports: &Ports,
    ) -> Vec<f64> {
        let more = self.begin_coordinates(load);
        add(&mut predictor.regular, &more);
        let mut moved = ports.values(held, |all| self.measure(&more, all));
        if let (Some(defect), Some(step)) = (&self.responses.defect, &mut predictor.defect) {
            let corrected = step.add(&defect.answer, &self.at_rows(&defect.answer, &more));
            moved.iter_mut().zip(corrected).for_each(|(m, d)| *m += d);
        }
        moved
    }

    fn increment(
        &self,
        held: &HeldRing,
        predictor: &LoosePredictor,
        ports: &Ports,
        forces: PortForces<'_>,
    ) -> Vec<f64> {
        let by_defect = self.by_defect(predictor.defect.as_ref(), forces);
        let loads = self.forces(ports.loads(held, forces).chain(by_defect));
        let x = self.finish(loads, &predictor.regular);
        let ring = self.solver.inner().ring();
        let Some(loose) = self.loose() else {
            return from_harmonics(ring, &x);
        };
        let (x, alone) = x.split_at(x.len() - Loose::len(loose));
        let mut y = from_harmonics(ring, x);
        loose.put(alone, &mut y);
        y
    }
}
