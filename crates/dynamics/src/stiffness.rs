//! A bearing about an equilibrium, to first order: stiffness and damping that its shaft feels.
//!
//! All five dofs of the shaft move, free in the equilibrium or not. The matrix is Newton's tangent at the equilibrium:
//! contacts with the geometric stiffness of their forces and the balls' own elasticity, the finite rotation of the
//! shaft, the seat of the outer ring, loads that grow with the radius of a ball, and flexible rings by the inverse
//! compliance of their contacts, found anew where these stand. To it comes what Newton leaves to its rounds: loads that
//! follow the contact angles, such as the gyroscopic moment. Those make the matrix unsymmetric.
//!
//! ```text
//! K = condensed on the shaft (x, y, z, tilt_x, tilt_y):   d(restoring loads) = K d(shaft)
//! ```
//!
//! Signs: K d is the load that has to be put on the shaft to move it by d. Tilts are the components of the rotation
//! vector; moments are those that do work on them, which are moments about the axes while the shaft is straight.
//! Forces on the shaft whose moments change as it tilts are no part of the bearing: their negative stiffness is apart
//! ([`Linearisation::load_stiffness`]).
//!
//! **Patches** of flexible rings go along with their contacts, and grow with their forces, as in a motion
//! ([`crate::moving_patches`]). So the matrix is the slope of whole equilibria, and slightly unsymmetric.
//!
//! **Damping** of slow motions, whose frequency is low beside those of balls and rings:
//!
//! - Contacts: c(d) along the normal, with the approach d of the equilibrium.
//! - Rings: the part in proportion to stiffness, which is that multiple of the inverse compliance. The part in
//!   proportion to mass is left out ([`Linearisation::leaves_out_mass_damping`]), and so is the circulatory stiffness
//!   of a ring that deforms while it turns, below `stiffness` x speed of its own share of K.
//!
//! Cost: the compliance of twice the contacts, one block solve per ring, and dense factors of 5 + 2 n_balls
//! (1 + rings) rows.

use std::ops::Range;

use contact::Side;
use dense::DenseError;
use timer::SharedLaps;

use crate::bearing::{BearingParts, CONTACTS, lengths};
use crate::compliance;
use crate::condensation::{Condensation, hold_sliding};
use crate::effects::RingDamping;
use crate::error::DynamicsError;
use crate::following::{ContactGrowths, add_following_loads};
use crate::interactions::closing_contact::ClosingContact;
use crate::interactions::contact_damping::{ContactDamping, coefficient};
use crate::interactions::raceway_contact::{Site, SiteState};
use crate::loading::LoadCase;
use crate::model::{ContactMode, Model};
use crate::moving_patches::{PatchGrowth, add_moving_patches};
use crate::solution::StaticSolution;
use crate::statics::StaticSolver;
use crate::system::{BodyId, ElasticPorts, LinkForces, LinkRows, System};

/// Dofs of the shaft.
pub const N_SHAFT: usize = 5;
/// Lengths of a ball's contacts.
const N_ROWS: usize = 4;

/// A matrix over the shaft's dofs, N/m, N/rad, N m/m and N m/rad, or the same times s.
pub type ShaftMatrix = [[f64; N_SHAFT]; N_SHAFT];

/// Damping laws of a bearing that moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DampingLaws {
    /// Of contacts, along their normal.
    pub contacts: Option<ContactDamping>,
    /// Of the rings.
    pub rings: Option<RingDamping>,
}

/// Stiffness and damping over the shaft, the balls and what else moves; see the module.
pub struct Linearisation {
    pub(crate) n: usize,
    /// Over shaft, balls, seat and ports of the rings, row-major.
    pub(crate) stiffness: Vec<f64>,
    pub(crate) damping: Option<Vec<f64>>,
    /// Damping of the rings over their stiffness, s.
    pub(crate) ring_damping: f64,
    pub(crate) n_balls: usize,
    /// Where rings meet their contacts, by side; only of one that was found anew.
    pub(crate) ports: [Option<RingPorts>; 2],
    /// How contacts close that are damped, by site; empty without damping.
    pub(crate) closing: Vec<ClosingContact>,
    /// Whether the stiffness has the inertia of the balls' orbits.
    pub(crate) has_orbits: bool,
    /// What loads on the shaft add to its stiffness because their moments change as it tilts.
    pub load_stiffness: ShaftMatrix,
    /// Whether the rings have damping in proportion to mass, which no matrix here has.
    pub leaves_out_mass_damping: bool,
}

/// A ring at its contacts.
pub(crate) struct RingPorts {
    /// Numbers of its ports among the unknowns.
    pub unknowns: Range<usize>,
    /// Inverse compliance of the contacts, N/m, row-major.
    pub stiffness: Vec<f64>,
    /// What its patches do as the bearing moves.
    pub patches: Option<PatchGrowth>,
}

/// Matrices over the dofs of the shaft, then [radial, axial] of each ball, row-major.
pub struct ShaftAndBalls {
    /// Number of rows, 5 + 2 n_balls.
    pub n: usize,
    /// Stiffness.
    pub stiffness: Vec<f64>,
    /// Damping, if there is any.
    pub damping: Option<Vec<f64>>,
}

impl ShaftAndBalls {
    /// Whether something touches the ball of row `i`.
    pub fn is_held(&self, i: usize) -> bool {
        is_held(&self.stiffness[self.n * i..self.n * (i + 1)], i)
    }
}

/// Whether something touches the ball of row `i` of a stiffness.
pub fn is_held(row: &[f64], i: usize) -> bool {
    row.iter().enumerate().any(|(j, k)| j != i && *k != 0.0)
}

impl Linearisation {
    /// Of the bearing about an equilibrium that `solver` found of `model`.
    pub fn new(
        model: &Model,
        solver: &StaticSolver,
        solution: &StaticSolution,
        laws: DampingLaws,
    ) -> Result<Linearisation, DynamicsError> {
        require_linear(model)?;
        let case = released(model, Some(solver), solution)?;
        Linearisation::of_case((model, Some(solver)), solution, &case, laws)
    }

    /// The same without damping on rings whose contacts have the compliance with which they were solved, which is that
    /// of places nearby: a tangent for Newton, for the cost of the dense factors.
    pub fn as_solved(model: &Model, solution: &StaticSolution) -> Result<Linearisation, DynamicsError> {
        require_linear(model)?;
        let case = released(model, None, solution)?;
        Linearisation::of_case((model, None), solution, &case, DampingLaws::default())
    }

    fn of_case(
        (model, solver): (&Model, Option<&StaticSolver>),
        solution: &StaticSolution,
        case: &LoadCase,
        laws: DampingLaws,
    ) -> Result<Linearisation, DynamicsError> {
        let parts = &case.parts;
        let (system, x) = (parts.system(), parts.unknowns(&solution.displacements));
        let at = system.evaluate(&x, &SharedLaps::default());
        let mut stiffness = system.body_tangent(&x);
        system.add_link_tangents(&x, &at.links, &mut stiffness);
        system.add_curvatures(&x, &at.links, &mut stiffness);
        let follows = case.loads.follows_angles;
        let growths = (follows || solver.is_some()).then(|| ContactGrowths::new(case, &x));
        if let Some(growths) = growths.as_ref().filter(|_| follows) {
            add_following_loads(model, solution, (case, growths), &x, &mut stiffness)?;
        }
        let patches = solver.zip(growths.as_ref()).map(|(solver, growths)| {
            add_moving_patches(solver, solution, (case, growths), &x, &mut stiffness)
        });
        let patches = patches.transpose()?;
        let damped = laws.contacts.map(|law| damped_contacts(parts, &x, law));
        let damping = damping_of(parts, &system, &x, (damped.as_deref(), laws.rings));
        let n = system.n();
        hold_unloaded(parts, n, &mut stiffness);
        let found = Linearisation {
            n,
            has_orbits: false,
            stiffness,
            damping,
            ring_damping: laws.rings.map_or(0.0, |rings| rings.stiffness),
            n_balls: parts.balls.len(),
            ports: patches.map_or([None, None], |patches| ports_of(parts, patches)),
            closing: damped.map_or(Vec::new(), |damped| closing(parts, &system, &x, &damped)),
            load_stiffness: parts.shaft.tilted.map_or([[0.0; N_SHAFT]; N_SHAFT], |loads| {
                loads.stiffness(solution.displacements.shaft)
            }),
            leaves_out_mass_damping: laws.rings.is_some_and(|rings| rings.mass > 0.0),
        };
        Ok(match model.orbit_speed(solution.pose.now.time) {
            Some(speed) => found.on_orbits(model.ball_mass(), speed),
            None => found,
        })
    }

    /// Stiffness of the shaft on its bearing.
    pub fn stiffness(&self) -> Result<ShaftMatrix, DynamicsError> {
        Ok(self.of_shaft()?.0)
    }

    /// Stiffness and damping of the shaft on its bearing.
    pub fn of_shaft(&self) -> Result<(ShaftMatrix, Option<ShaftMatrix>), DynamicsError> {
        let [stiffness, damping] = self.condensed(N_SHAFT)?;
        let square = |m: Vec<f64>| std::array::from_fn(|i| std::array::from_fn(|j| m[N_SHAFT * i + j]));
        Ok((square(stiffness.unwrap_or_default()), damping.map(square)))
    }

    /// The same with the balls, which rings and seat follow.
    pub fn of_shaft_and_balls(&self) -> Result<ShaftAndBalls, DynamicsError> {
        let n = N_SHAFT + 2 * self.n_balls;
        let [stiffness, damping] = self.condensed(n)?;
        Ok(ShaftAndBalls {
            n,
            stiffness: stiffness.unwrap_or_default(),
            damping,
        })
    }

    fn condensed(&self, kept: usize) -> Result<[Option<Vec<f64>>; 2], DynamicsError> {
        let condensation =
            Condensation::new(self.n, kept, &self.stiffness).map_err(|source| not_solved(&source))?;
        let apply = |matrix: &Vec<f64>| condensation.apply(matrix);
        Ok([Some(apply(&self.stiffness)), self.damping.as_ref().map(apply)])
    }
}

/// Fails for contacts and balls that have no tangent.
fn require_linear(model: &Model) -> Result<(), DynamicsError> {
    if model.contact.mode == ContactMode::Facet {
        let what = "contact.mode = \"facet\", whose contacts jump from facet to facet; use \"patch\"";
        return Err(DynamicsError::NotInStiffness { what });
    }
    if model.surfaces.has_strips() {
        let what =
            "real surfaces ([[profiles.*]], contact.edges), whose tangent changes wherever a ball stands";
        return Err(DynamicsError::NotInStiffness { what });
    }
    if model.traction().is_some() {
        let what = "balls.motion = \"free\", whose traction is not linearised; use \"kinematic\"";
        return Err(DynamicsError::NotInStiffness { what });
    }
    Ok(())
}

fn not_solved(source: &DenseError) -> DynamicsError {
    DynamicsError::ContactSystem {
        source: source.clone(),
    }
}

/// Bodies and contacts of a solution whose shaft may move in all its dofs, on rings with the compliance of their
/// contacts where these stand, or without `solver` with that of the solution.
pub(crate) fn released<'m>(
    model: &'m Model,
    solver: Option<&StaticSolver>,
    solution: &StaticSolution,
) -> Result<LoadCase<'m>, DynamicsError> {
    let u = &solution.displacements;
    let mut case = LoadCase::new(model, solution.pose, &SharedLaps::default(), u)?;
    case.parts
        .contacts
        .sites
        .clone_from(&solution.parts.contacts.sites);
    case.parts.shaft.imposed = [None; N_SHAFT];
    let mut rings = [None, None];
    for side in Side::BOTH {
        let (i, found) = (side.index(), solution.parts.rings[side.index()].as_ref());
        let Some(ports) = found else { continue };
        let Some(ring) = solver.and_then(|solver| solver.ring(side)) else {
            rings[i] = Some(ports.clone());
            continue;
        };
        let weights: Vec<_> = solution
            .footprints(side)
            .iter()
            .map(|f| f.weights.clone())
            .collect();
        let n = 2 * weights.len();
        let columns = ring.solver.compliance(&weights);
        rings[i] = Some(ElasticPorts {
            stiffness: compliance::inverse(side, n, weights.len(), &columns)?,
            ..ports.clone()
        });
    }
    case.parts.set_rings(rings, &u.grooves);
    // The tilts are free now, so loads on the shaft may change with them.
    case.parts.set_loads(&case.loads);
    Ok(case)
}

/// Where the rings meet their contacts.
fn ports_of(parts: &BearingParts, mut patches: [Option<PatchGrowth>; 2]) -> [Option<RingPorts>; 2] {
    let system = parts.system();
    let mut number = 0;
    [0, 1].map(|side: usize| {
        let ports = parts.rings[side].as_ref()?;
        let unknowns = system.unknowns(BodyId::Elastic(number));
        number += 1;
        Some(RingPorts {
            unknowns,
            stiffness: ports.stiffness.clone(),
            patches: patches[side].take(),
        })
    })
}

/// Holds balls that nothing touches, which have no stiffness and pass nothing on, and balls that no more than round-off
/// presses.
fn hold_unloaded(parts: &BearingParts, n: usize, stiffness: &mut [f64]) {
    let scale = stiffness
        .iter()
        .fold(f64::MIN_POSITIVE, |most, k| most.max(k.abs()));
    let balls = N_SHAFT..N_SHAFT + 2 * parts.balls.len();
    for i in balls.clone() {
        if stiffness[n * i..n * (i + 1)].iter().all(|k| *k == 0.0) {
            stiffness[n * i + i] = scale;
        }
    }
    for i in balls.step_by(2) {
        hold_sliding(n, i, stiffness);
    }
}

/// Damping over all unknowns, row-major; None where no law gives any.
fn damping_of(
    parts: &BearingParts,
    system: &System,
    x: &[f64],
    (contacts, rings): (Option<&[DampedContact]>, Option<RingDamping>),
) -> Option<Vec<f64>> {
    let n = system.n();
    let stiffness_factor = rings.map_or(0.0, |rings| rings.stiffness);
    let has_rings = parts.rings.iter().any(Option::is_some) && stiffness_factor > 0.0;
    if contacts.is_none() && !has_rings {
        return None;
    }
    let mut damping = vec![0.0; n * n];
    if let Some(contacts) = contacts {
        system.add_link_tangents(x, &contact_damping(parts, system, x, contacts), &mut damping);
    }
    for (number, ports) in parts.rings.iter().flatten().enumerate() {
        let own = system.unknowns(BodyId::Elastic(number));
        for (i, row) in own.clone().zip(ports.stiffness.chunks_exact(own.len())) {
            for (j, k) in own.clone().zip(row) {
                damping[n * i + j] += stiffness_factor * k;
            }
        }
    }
    Some(damping)
}

/// The damping of all contacts as tangents of their links, c n n^T each; other families have none.
fn contact_damping(
    parts: &BearingParts,
    system: &System,
    x: &[f64],
    contacts: &[DampedContact],
) -> Vec<LinkForces> {
    let families = parts.interactions().into_iter().enumerate();
    families
        .map(|(number, family)| {
            let found = system.lengths_at(number, x);
            let mut forces = family.evaluate(lengths(&found), &SharedLaps::default());
            forces.tangents.iter_mut().for_each(|t| *t = 0.0);
            if number == CONTACTS {
                for (site, (state, c)) in contacts.iter().enumerate() {
                    let (first, n) = (N_ROWS * N_ROWS * (site / 2), state.normal.to_array());
                    for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                        let (row, column) = (2 * (site % 2) + i, 2 * (site % 2) + k);
                        forces.tangents[first + N_ROWS * row + column] = c * n[i] * n[k];
                    }
                }
            }
            forces
        })
        .collect()
}

/// A contact and its damping coefficient, N s/m.
type DampedContact = (SiteState, f64);

/// The contacts with their damping, by site.
fn damped_contacts(parts: &BearingParts, x: &[f64], law: ContactDamping) -> Vec<DampedContact> {
    let states = parts.states(x).into_iter().zip(&parts.contacts.sites);
    states
        .map(|(state, site)| (state, coefficient(&law, state.length - site.touching)[0]))
        .collect()
}

/// How damped contacts close, by site: along their normals, as their lengths grow at `x`.
fn closing(
    parts: &BearingParts,
    system: &System,
    x: &[f64],
    contacts: &[DampedContact],
) -> Vec<ClosingContact> {
    let growths = system.growths(CONTACTS, x);
    let of_site = |(i, ((state, c), site)): (usize, (&DampedContact, &Site))| {
        let (first, n) = (2 * (i % 2), state.normal.to_array());
        let along = |rows: &LinkRows| n[0] * rows[first] + n[1] * rows[first + 1];
        let growth = growths[i / 2]
            .iter()
            .map(|(unknown, rows)| (*unknown, along(rows)));
        let ring = parts.elastic(site.side).map(BodyId::Elastic);
        ClosingContact::new(growth.collect(), *c, ring.map(|body| system.unknowns(body)))
    };
    let contacts = contacts.iter().zip(&parts.contacts.sites);
    contacts.enumerate().map(of_site).collect()
}

/// Where a stiffness is least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softest {
    /// Lowest eigenvalue of the symmetric part, N/m.
    pub lowest: f64,
    /// Largest eigenvalue, N/m.
    pub largest: f64,
    /// The dof that moves most at the lowest.
    pub dof: usize,
}

/// The softest motion of a shaft on a stiffness, of which tilts count by `arm`, m.
pub fn softest(matrix: &ShaftMatrix, arm: f64) -> Result<Softest, DynamicsError> {
    let scale = |i: usize| if i < 3 { 1.0 } else { 1.0 / arm };
    let entry = |i: usize, j: usize| 0.5 * (matrix[i][j] + matrix[j][i]) * scale(i) * scale(j);
    let symmetric: Vec<f64> = (0..N_SHAFT * N_SHAFT)
        .map(|k| entry(k / N_SHAFT, k % N_SHAFT))
        .collect();
    let (values, vectors) =
        dense::symmetric_eigen(N_SHAFT, &symmetric).map_err(|source| not_solved(&source))?;
    let softest = &vectors[..N_SHAFT];
    let most = (0..N_SHAFT).max_by(|a, b| softest[*a].abs().total_cmp(&softest[*b].abs()));
    Ok(Softest {
        lowest: values[0],
        largest: values[N_SHAFT - 1],
        dof: most.unwrap_or_default(),
    })
}
