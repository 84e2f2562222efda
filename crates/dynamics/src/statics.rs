//! Static equilibrium of the bearing: rounds of (place patches, measure the rings, solve the contacts).
//!
//! ```text
//! rigid equilibrium -> first places and forces
//! columns: compliance C of all contacts, once per ring (one block solve)
//! repeat
//!     place patches from the forces and contact angles
//!     u = K^-1 (patch loads), one solve per ring; c = motion measured by the same patches
//!     Newton on balls, shaft and groove motions with u_c = c + C (F - F0)
//! until no force changes
//! ```
//! C is only a tangent: a slightly outdated one costs rounds, never accuracy; it is renewed when rounds contract slowly.

use std::time::Instant;

use contact::{ContactLaw, Side};
use rayon::prelude::*;
use solver::dense::DenseCholesky;

use crate::balls::{BallResult, ball_results};
use crate::effects::{self, Loads};
use crate::equilibrium::{SearchScales, centre_unloaded, check_held, minimise};
use crate::error::DynamicsError;
use crate::footprint::{Footprint, place};
use crate::model::{ContactMode, Model, ShaftDof};
use crate::problem::{Displacements, Problem, RingResponse, Site};
use crate::ring::RingSolver;

/// Contraction of a round above which the columns are renewed.
const SLOW_CONTRACTION: f64 = 0.2;
/// Facets make the force jump where a ball changes facets; rounds settle to this share of the largest force.
const FACET_TOLERANCE: f64 = 1e-6;

/// Seconds spent, by part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timing {
    /// Assembly of the stiffness matrices.
    pub assemble: f64,
    /// Ordering, analysis and factorisation.
    pub factor: f64,
    /// Compliance columns of the contacts.
    pub columns: f64,
    /// Placing of patches.
    pub patches: f64,
    /// Full-field solves.
    pub solve: f64,
    /// Newton on contacts, balls and shaft.
    pub newton: f64,
}

/// A static equilibrium.
pub struct StaticSolution {
    /// Displacements of shaft, balls and groove centres.
    pub displacements: Displacements,
    /// Results of every ball.
    pub balls: Vec<BallResult>,
    /// Elastic nodal displacements of flexible rings relative to shaft or housing, m, `[n_nodes][3]` flat.
    pub elastic: [Option<Vec<f64>>; 2],
    /// Out-of-balance force on the shaft, N and N m, about its origin; zero on prescribed dofs.
    pub shaft_residual: [f64; 5],
    /// Force and moment that hold the prescribed dofs, N and N m.
    pub shaft_reaction: [f64; 5],
    /// Strain energy of the rings, Hertz energy, J.
    pub strain_energy: f64,
    /// Energy of the local contacts (2/5 K d_e^2.5 - c_s Q^2/2), J.
    pub hertz_energy: f64,
    /// Work of the loads through the displacements (twice a linear spring's energy), J.
    pub load_work: f64,
    /// Rounds and Newton iterations.
    pub rounds: usize,
    /// Newton iterations in all rounds.
    pub newton_iterations: usize,
    /// Warnings a user should read.
    pub warnings: Vec<String>,
    footprints: [Vec<Footprint>; 2],
}

/// Factored rings of a model, ready for any number of load cases.
pub struct StaticSolver<'a> {
    model: &'a Model,
    rings: [Option<RingSolver>; 2],
    columns: [Option<Vec<f64>>; 2],
    /// Seconds so far.
    pub timing: Timing,
}

impl<'a> StaticSolver<'a> {
    /// Factors both rings, on two threads if there are two.
    pub fn new(model: &'a Model) -> Result<StaticSolver<'a>, DynamicsError> {
        let build = |side: Side| {
            model
                .ring(side)
                .map(|ring| RingSolver::new(model, side, ring))
                .transpose()
        };
        let (inner, outer) = rayon::join(|| build(Side::Inner), || build(Side::Outer));
        let rings = [inner?, outer?];
        let mut timing = Timing::default();
        for ring in rings.iter().flatten() {
            timing.assemble += ring.seconds[0];
            timing.factor += ring.seconds[1];
        }
        Ok(StaticSolver {
            model,
            rings,
            columns: [None, None],
            timing,
        })
    }

    /// The ring solver of one side.
    pub fn ring(&self, side: Side) -> Option<&RingSolver> {
        self.rings[side.index()].as_ref()
    }

    /// Equilibrium under the model's loads, from zero displacement or from an earlier solution.
    pub fn solve(&mut self, start: Option<&StaticSolution>) -> Result<StaticSolution, DynamicsError> {
        let loads = effects::loads(self.model)?;
        self.solve_loads(&loads, start)
    }

    fn solve_loads(
        &mut self,
        loads: &Loads,
        start: Option<&StaticSolution>,
    ) -> Result<StaticSolution, DynamicsError> {
        let model = self.model;
        let problem = base_problem(model, loads);
        let scales = SearchScales::new(
            &model.geometry,
            model.hertz[0].stiffness.max(model.hertz[1].stiffness),
        );
        let mut u = self.start(&problem, start);
        let clock = Instant::now();
        let mut newton_iterations = 0;
        let all_rigid = self.rings.iter().all(Option::is_none);
        if start.is_none() || all_rigid {
            let rigid = Displacements {
                grooves: [Vec::new(), Vec::new()],
                ..u.clone()
            };
            let (found, iterations) = minimise(&problem, rigid, scales)?;
            u = Displacements {
                grooves: u.grooves,
                ..found
            };
            newton_iterations += iterations;
        }
        self.timing.newton += clock.elapsed().as_secs_f64();
        if all_rigid {
            check_held(&problem, &u, scales)?;
            return Ok(self.finish(
                problem,
                u,
                loads,
                [None, None],
                [Vec::new(), Vec::new()],
                [1, newton_iterations],
            ));
        }
        self.rounds(problem, u, loads, scales, newton_iterations)
    }

    /// Displacements to start from.
    fn start(&self, problem: &Problem, start: Option<&StaticSolution>) -> Displacements {
        let flexible = [self.rings[0].is_some(), self.rings[1].is_some()];
        let mut u = match start {
            Some(solution) => solution.displacements.clone(),
            None => Displacements::zero(problem.ball_load.len(), flexible),
        };
        for (i, dof) in self.model.shaft.iter().enumerate() {
            if let ShaftDof::Prescribed(value) = dof {
                u.shaft[i] = *value;
            }
        }
        u
    }

    fn rounds(
        &mut self,
        mut problem: Problem,
        mut u: Displacements,
        loads: &Loads,
        scales: SearchScales,
        mut newton_iterations: usize,
    ) -> Result<StaticSolution, DynamicsError> {
        let model = self.model;
        let tolerance = match model.contact.mode {
            ContactMode::Facet => model.tolerances.force.max(FACET_TOLERANCE),
            _ => model.tolerances.force,
        };
        let mut forces = site_forces(&problem, &u);
        let mut fields: [Option<Vec<f64>>; 2] = [None, None];
        let mut history = Vec::new();
        let mut worst = 0;
        for round in 1..=model.tolerances.max_rounds {
            let clock = Instant::now();
            let mut feet = [Vec::new(), Vec::new()];
            for side in Side::BOTH {
                if let Some(ring) = &self.rings[side.index()] {
                    feet[side.index()] = place(
                        model,
                        side,
                        ring,
                        &mut problem,
                        &u,
                        &forces,
                        fields[side.index()].as_deref(),
                    )?;
                }
            }
            self.timing.patches += clock.elapsed().as_secs_f64();
            self.renew_columns(&feet, &history);
            fields = self.fields(&feet, &forces, loads);
            self.respond(&mut problem, &feet, &forces, &fields);
            let clock = Instant::now();
            if round == 1 {
                adopt_offsets(&problem, &mut u);
            }
            let (next, iterations) = minimise(&problem, u, scales)?;
            self.timing.newton += clock.elapsed().as_secs_f64();
            newton_iterations += iterations;
            u = next;
            let updated = site_forces(&problem, &u);
            let (change, place) = largest_change(&forces, &updated);
            (forces, worst) = (updated, place);
            history.push(change);
            if change <= tolerance {
                check_held(&problem, &u, scales)?;
                check_patches(&problem, &u)?;
                return Ok(self.finish(problem, u, loads, fields, feet, [round, newton_iterations]));
            }
        }
        let tail = history.len().saturating_sub(6);
        Err(DynamicsError::NotSettled {
            rounds: model.tolerances.max_rounds,
            change: *history.last().unwrap_or(&f64::NAN),
            limit: tolerance,
            ball: worst / 2,
            side: Side::BOTH[worst % 2].name(),
            history: history.split_off(tail),
        })
    }

    /// Computes the compliance columns when there are none, and again when rounds contract slowly.
    fn renew_columns(&mut self, feet: &[Vec<Footprint>; 2], history: &[f64]) {
        let slow = matches!(history, [.., before, last] if *last > SLOW_CONTRACTION * before);
        let clock = Instant::now();
        let rings = &self.rings;
        let renewed: Vec<Option<Vec<f64>>> = Side::BOTH
            .par_iter()
            .map(|side| {
                let i = side.index();
                let ring = rings[i].as_ref()?;
                if self.columns[i].is_some() && !slow {
                    return None;
                }
                let weights: Vec<_> = feet[i].iter().map(|f| f.weights.clone()).collect();
                let n = 2 * weights.len();
                let compliance = ring.compliance(&weights);
                let factor = DenseCholesky::factor(n, &compliance)
                    .expect("the compliance of distinct contacts on a held ring is positive definite");
                Some(factor.inverse())
            })
            .collect();
        for (columns, new) in self.columns.iter_mut().zip(renewed) {
            if new.is_some() {
                *columns = new;
            }
        }
        self.timing.columns += clock.elapsed().as_secs_f64();
    }

    /// Elastic fields of both rings under the contact forces and body loads.
    fn fields(
        &mut self,
        feet: &[Vec<Footprint>; 2],
        forces: &[[f64; 2]],
        loads: &Loads,
    ) -> [Option<Vec<f64>>; 2] {
        let clock = Instant::now();
        let field = |side: Side| {
            let ring = self.rings[side.index()].as_ref()?;
            let mut load = loads.rings[side.index()]
                .clone()
                .unwrap_or_else(|| vec![0.0; ring.n_dofs()]);
            for (ball, foot) in feet[side.index()].iter().enumerate() {
                foot.weights.add_load(forces[2 * ball + side.index()], &mut load);
            }
            Some(ring.solve(load, 1))
        };
        let (inner, outer) = rayon::join(|| field(Side::Inner), || field(Side::Outer));
        self.timing.solve += clock.elapsed().as_secs_f64();
        [inner, outer]
    }

    /// Puts the measured motions and the columns into the problem.
    fn respond(
        &self,
        problem: &mut Problem,
        feet: &[Vec<Footprint>; 2],
        forces: &[[f64; 2]],
        fields: &[Option<Vec<f64>>; 2],
    ) {
        for side in Side::BOTH {
            let i = side.index();
            if let (Some(field), Some(stiffness)) = (&fields[i], &self.columns[i]) {
                problem.rings[i] = Some(RingResponse {
                    offset: feet[i].iter().flat_map(|f| f.weights.measure(field)).collect(),
                    force: (0..feet[i].len()).flat_map(|b| forces[2 * b + i]).collect(),
                    stiffness: stiffness.clone(),
                });
            }
        }
    }

    fn finish(
        &self,
        problem: Problem,
        mut u: Displacements,
        loads: &Loads,
        elastic: [Option<Vec<f64>>; 2],
        footprints: [Vec<Footprint>; 2],
        counts: [usize; 2],
    ) -> StaticSolution {
        centre_unloaded(&problem, &mut u);
        let (residual, reaction) = shaft_balance(&problem, &u);
        let forces = site_forces(&problem, &u);
        let strain = |side: Side| -> f64 {
            let field = elastic[side.index()].as_ref();
            let contacts: f64 = footprints[side.index()]
                .iter()
                .zip(field.iter().cycle())
                .enumerate()
                .map(|(ball, (foot, field))| {
                    let (motion, f) = (foot.weights.measure(field), forces[2 * ball + side.index()]);
                    motion[0] * f[0] + motion[1] * f[1]
                })
                .sum();
            let body = loads.rings[side.index()]
                .iter()
                .zip(field)
                .map(|(l, u)| dot(l, u))
                .sum::<f64>();
            0.5 * (contacts + body)
        };
        let hertz_energy = problem.sites.iter().map(|s| s.state(&u).force.energy).sum();
        let balls_work: f64 = loads
            .balls
            .iter()
            .flatten()
            .zip(u.balls.iter().flatten())
            .map(|(f, x)| f * x)
            .sum();
        StaticSolution {
            balls: ball_results(self.model, &problem, &u),
            shaft_residual: residual,
            shaft_reaction: reaction,
            strain_energy: strain(Side::Inner) + strain(Side::Outer),
            hertz_energy,
            load_work: balls_work + dot(&problem.shaft_load, &u.shaft),
            rounds: counts[0],
            newton_iterations: counts[1],
            warnings: footprint_warnings(&footprints, &forces),
            displacements: u,
            elastic,
            footprints,
        }
    }
}

impl StaticSolution {
    /// Semi-axes of the spread patches of one side, m, by ball; empty for a rigid ring or facets.
    pub fn patch_axes(&self, side: Side) -> Vec<[f64; 2]> {
        self.footprints[side.index()]
            .iter()
            .filter_map(|f| f.semi_axes)
            .collect()
    }
}

fn base_problem(model: &Model, loads: &Loads) -> Problem {
    let geometry = &model.geometry;
    let ball = geometry.ball_centre();
    let sites = (0..geometry.n_balls).flat_map(|i| {
        Side::BOTH.map(|side| {
            let centre = geometry.groove_centre(side);
            Site {
                ball: i,
                side,
                azimuth: geometry.azimuth(i),
                reach: [ball[0] - centre[0], ball[1] - centre[1]],
                touching: geometry.touching_distance(side),
                lever: geometry.centre_radius(side),
                law: ContactLaw {
                    stiffness: model.hertz[side.index()].stiffness,
                    patch_compliance: 0.0,
                },
            }
        })
    });
    Problem {
        sites: sites.collect(),
        rings: [None, None],
        shaft_free: model.shaft.map(|d| d == ShaftDof::Free),
        shaft_load: loads.shaft,
        ball_load: loads.balls.clone(),
        tilt_arm: geometry.centre_radius(Side::Inner),
    }
}

/// Starts groove motions at what was measured: the first guess of a ring that answers for the first time.
fn adopt_offsets(problem: &Problem, u: &mut Displacements) {
    for (groove, ring) in u.grooves.iter_mut().zip(&problem.rings) {
        if let Some(ring) = ring {
            for (g, c) in groove.iter_mut().flatten().zip(&ring.offset) {
                *g = *c;
            }
        }
    }
}

/// Force on the ring of every site [radial, axial], N.
fn site_forces(problem: &Problem, u: &Displacements) -> Vec<[f64; 2]> {
    let force = |site: &Site| {
        let state = site.state(u);
        state.normal.map(|n| state.force.force * n)
    };
    problem.sites.iter().map(force).collect()
}

/// Largest change over the largest force, and where.
fn largest_change(old: &[[f64; 2]], new: &[[f64; 2]]) -> (f64, usize) {
    let size = |f: &[f64; 2]| f[0].hypot(f[1]);
    let scale = new.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    old.iter()
        .zip(new)
        .enumerate()
        .fold((0.0, 0), |(largest, place), (i, (a, b))| {
            let change = (a[0] - b[0]).hypot(a[1] - b[1]) / scale;
            if change > largest {
                (change, i)
            } else {
                (largest, place)
            }
        })
}

fn check_patches(problem: &Problem, u: &Displacements) -> Result<(), DynamicsError> {
    for site in &problem.sites {
        let state = site.state(u);
        if state.force.beyond_limit {
            return Err(DynamicsError::PatchTooSmall {
                ball: site.ball,
                side: site.side.name(),
                force: state.force.force,
            });
        }
    }
    Ok(())
}

/// Sum of contact and applied loads on the shaft: on free dofs a residual, on the others minus the reaction.
fn shaft_balance(problem: &Problem, u: &Displacements) -> ([f64; 5], [f64; 5]) {
    let mut sum = problem.shaft_load;
    for site in problem.sites.iter().filter(|s| s.side == Side::Inner) {
        let state = site.state(u);
        for (total, row) in sum.iter_mut().zip(site.shaft_rows()) {
            *total += state.force.force * (row[0] * state.normal[0] + row[1] * state.normal[1]);
        }
    }
    let pick = |free: bool| {
        [0, 1, 2, 3, 4].map(|i| {
            if problem.shaft_free[i] == free {
                sum[i]
            } else {
                0.0
            }
        })
    };
    (pick(true), pick(false).map(|x| -x))
}

fn footprint_warnings(footprints: &[Vec<Footprint>; 2], forces: &[[f64; 2]]) -> Vec<String> {
    let mut warnings = Vec::new();
    for side in Side::BOTH {
        let loaded = |ball: usize| forces[2 * ball + side.index()] != [0.0; 2];
        let truncated: Vec<String> = footprints[side.index()]
            .iter()
            .enumerate()
            .filter(|(ball, f)| f.truncated && loaded(*ball))
            .map(|(ball, _)| ball.to_string())
            .collect();
        if !truncated.is_empty() {
            warnings.push(format!(
                "edge contact on the {} raceway, balls {}: the Hertz ellipse reaches beyond the groove; \
                 forces and pressures there are not valid",
                side.name(),
                truncated.join(", ")
            ));
        }
    }
    warnings
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
