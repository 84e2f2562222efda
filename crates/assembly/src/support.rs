//! What holds the shaft at a place: a bearing, or a linear spring.

use dynamics::displacements::Displacements;
use dynamics::statics::ContactColumns;
use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::{DynamicsError, Linearisation, Model, Pose, ShaftDof, StaticSolution, StaticSolver};
use timer::Laps;

use crate::error::AssemblyError;
use crate::side_by_side::of_each;

/// What answers a displacement, in the frame of what answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportAnswer {
    /// Load that has to be put on the shaft to hold it there, N and N m.
    pub load: [f64; N_SHAFT],
    /// Its growth with the displacement; a tangent, good enough for Newton.
    pub stiffness: ShaftMatrix,
    /// A force by which its round-off counts, N.
    pub force: f64,
}

/// What answers displacements of the shaft, by the number of the mount.
pub trait Supports {
    /// The load and tangent of every mount, by name, at its displacement; the error of the first that fails.
    fn answers(&mut self, asked: &[(&str, [f64; N_SHAFT])]) -> Result<Vec<SupportAnswer>, AssemblyError>;

    /// Displacement beyond which there is no equilibrium, m; None: any.
    fn range(&self, mount: usize) -> Option<f64>;
}

/// A linear spring over all five dofs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSupport {
    /// Its stiffness.
    pub stiffness: ShaftMatrix,
}

impl LinearSupport {
    /// A hinge: stiffness along x, y, z, none against tilt.
    pub fn hinge(stiffness: f64) -> LinearSupport {
        let mut matrix = [[0.0; N_SHAFT]; N_SHAFT];
        (0..3).for_each(|i| matrix[i][i] = stiffness);
        LinearSupport { stiffness: matrix }
    }
}

impl Supports for Vec<LinearSupport> {
    fn answers(&mut self, asked: &[(&str, [f64; N_SHAFT])]) -> Result<Vec<SupportAnswer>, AssemblyError> {
        let answer = |(support, (_, at)): (&LinearSupport, &(&str, [f64; N_SHAFT]))| {
            let stiffness = support.stiffness;
            let load: [f64; N_SHAFT] = stiffness.map(|row| row.iter().zip(at).map(|(k, x)| k * x).sum());
            SupportAnswer {
                load,
                stiffness,
                force: load[..3].iter().fold(0.0, |m, f| f.abs().max(m)),
            }
        };
        Ok(self.iter().zip(asked).map(answer).collect())
    }

    fn range(&self, _mount: usize) -> Option<f64> {
        None
    }
}

/// A bearing whose shaft is put where it is asked for.
pub struct BearingSupport<'a> {
    /// The bearing.
    pub model: &'a mut Model,
    /// Number of the factors of its rings.
    pub solver: usize,
    /// The columns of this bearing: those of other bearings of its type stay as they are.
    pub columns: &'a mut ContactColumns,
    /// Where its parts stand.
    pub pose: Pose,
    /// Where the first solution starts from.
    pub start: Option<&'a Displacements>,
    /// The last solution, from which the next starts.
    pub last: Option<StaticSolution>,
    /// Wall time of its answers.
    pub laps: Laps,
}

/// Bearings with the factors of their rings.
pub struct BearingSupports<'s, 'a> {
    /// Factors of each type.
    pub solvers: &'s [StaticSolver],
    /// The bearings.
    pub bearings: Vec<BearingSupport<'a>>,
}

impl BearingSupport<'_> {
    /// What it answers, with the factors of its type.
    fn answer(&mut self, factors: &StaticSolver, at: [f64; N_SHAFT]) -> Result<SupportAnswer, DynamicsError> {
        self.model.shaft = at.map(ShaftDof::Prescribed);
        let mut solver = factors.beside(std::mem::take(self.columns));
        let last = self.last.as_ref().map(|solution| &solution.displacements);
        let found = solver.solve_from(self.model, &self.pose, last.or(self.start));
        let (columns, laps) = solver.into_point();
        *self.columns = columns;
        self.laps.merge(&laps);
        let solution = found?;
        let tangent = Linearisation::as_solved(self.model, &solution)?.stiffness()?;
        let forces = solution
            .balls
            .iter()
            .flat_map(|b| [b.inner.force_n, b.outer.force_n]);
        let answer = SupportAnswer {
            load: solution.shaft_reaction,
            stiffness: tangent,
            force: forces.fold(0.0, f64::max),
        };
        self.last = Some(solution);
        Ok(answer)
    }
}

impl Supports for BearingSupports<'_, '_> {
    fn answers(&mut self, asked: &[(&str, [f64; N_SHAFT])]) -> Result<Vec<SupportAnswer>, AssemblyError> {
        let solvers = self.solvers;
        let answer = |(bearing, (name, at)): (&mut BearingSupport<'_>, &(&str, [f64; N_SHAFT]))| {
            let factors = &solvers[bearing.solver];
            bearing
                .answer(factors, *at)
                .map_err(AssemblyError::of_bearing(name))
        };
        of_each(self.bearings.iter_mut().zip(asked), answer)
    }

    fn range(&self, mount: usize) -> Option<f64> {
        Some(0.5 * self.bearings[mount].model.geometry.ball_diameter)
    }
}
