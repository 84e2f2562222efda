//! Ball-pass ripple of a list of bearings: its matrices with the balls at places of their pitch while the rings stay.
//!
//! Bearings with as many balls on cages of one speed keep step: their balls go through the pitch together, one way
//! about the shaft. Bearings of other kinds pass at times of their own, so that in a motion any place of the ones meets
//! any place of the others. With k kinds and N places each there are N^k positions, and all are taken.

use std::f64::consts::TAU;

use anyhow::anyhow;
use assembly::stiffness::{LinearAssembly, PassedDamping};
use assembly::{Assembly, AssemblyError, AssemblySolution, AssemblySolver};
use dynamics::Pose;
use dynamics::kinematics::Kinematics;
use dynamics::stiffness::ShaftMatrix;
use results::failure::Failure;
use results::stiffness::{MOST_POSITIONS, Ripple, require_positions};
use scene::SeveralScene;

/// The balls of a list as they pass.
pub struct Passing {
    /// Places of a pitch.
    places: usize,
    /// Number of kinds that pass at times of their own.
    n_kinds: u32,
    bearings: Vec<PassingBearing>,
}

/// The balls of one bearing.
struct PassingBearing {
    kind: u32,
    /// Angle from a ball to the next in the bearing's frame, rad, along z of the shaft.
    pitch: f64,
}

/// Ripple of all matrices.
pub struct RippleOfList {
    /// Of the bearings, in the frame of the shaft.
    pub bearings: Vec<Ripple>,
    /// Of the shaft at the point.
    pub shaft: Ripple,
    /// Of what bearings do to each other through bodies.
    pub couplings: Vec<Ripple>,
}

impl Passing {
    /// Of a scene, if a ripple with so many places of a pitch is asked for.
    pub fn new(scene: &SeveralScene, ripple: Option<usize>) -> Result<Option<Passing>, Failure> {
        require_positions(ripple)?;
        let Some(places) = ripple else { return Ok(None) };
        let mut kinds: Vec<(f64, usize)> = Vec::new();
        let bearings = scene.bearings.iter().map(|bearing| {
            let geometry = scene::geometry(&bearing.scene);
            let kind = (
                Kinematics::new(&geometry, scene.effects.slip()).cage,
                geometry.n_balls,
            );
            let known = kinds.iter().position(|other| *other == kind);
            let number = known.unwrap_or(kinds.len());
            if known.is_none() {
                kinds.push(kind);
            }
            PassingBearing {
                kind: number as u32,
                pitch: bearing.orientation.turned_angle(TAU / geometry.n_balls as f64),
            }
        });
        let passing = Passing {
            places,
            bearings: bearings.collect(),
            n_kinds: kinds.len() as u32,
        };
        passing.require_few()?;
        Ok(Some(passing))
    }

    /// Number of positions of all balls; None: more than can be counted.
    fn positions(&self) -> Option<usize> {
        self.places.checked_pow(self.n_kinds)
    }

    fn require_few(&self) -> Result<(), Failure> {
        if self.positions().is_some_and(|all| all <= MOST_POSITIONS) {
            return Ok(());
        }
        let few = |n: &usize| {
            n.checked_pow(self.n_kinds)
                .is_some_and(|all| all <= MOST_POSITIONS)
        };
        let most = (1..=MOST_POSITIONS).take_while(few).last().unwrap_or(1);
        let (n, kinds) = (self.places, self.n_kinds);
        Err(Failure::User(anyhow!(match most {
            1 => format!(
                "--ripple is {n}, and bearings of {kinds} kinds pass their balls each at its own time: even 2 places \
                 of each pitch make more than {MOST_POSITIONS} positions; leave it out"
            ),
            _ => format!(
                "--ripple is {n}, and bearings of {kinds} kinds pass their balls each at its own time, which makes \
                 {n}^{kinds} positions; expected 2 to {most} places of each pitch, at most {MOST_POSITIONS} positions"
            ),
        })))
    }

    /// Where the parts stand at a position, from those of the first.
    fn poses(&self, first: &[Pose], position: usize) -> Vec<Pose> {
        let moved = |(bearing, first): (&PassingBearing, &Pose)| {
            let place = position / self.places.pow(bearing.kind) % self.places;
            let mut pose = *first;
            pose.now.cage_angle += bearing.pitch * place as f64 / self.places as f64;
            pose
        };
        self.bearings.iter().zip(first).map(moved).collect()
    }

    /// The ripple about an equilibrium with these poses, of the shaft at a place, m, with the damping of contacts that
    /// balls pass. The solver goes on as if nothing
    /// had been asked of it.
    pub fn ripple(
        &self,
        (assembly, solver): (&mut Assembly, &mut AssemblySolver),
        (solution, first): (&AssemblySolution, &[Pose]),
        (place, damping): (f64, PassedDamping<'_>),
    ) -> Result<RippleOfList, AssemblyError> {
        let (start, columns) = (solution.as_start(), solver.columns().to_vec());
        let mut bearings: Vec<Vec<ShaftMatrix>> = vec![Vec::new(); self.bearings.len()];
        let (mut shaft, mut couplings) = (Vec::new(), Vec::new());
        for position in 0..self.positions().unwrap_or(0) {
            let found = solver.solve_at(assembly, &self.poses(first, position), Some(&start))?;
            let linear = LinearAssembly::passing(assembly, solver, &found, damping)?;
            for (all, own) in bearings.iter_mut().zip(&linear.stiffness) {
                all.push(*own);
            }
            shaft.push(linear.of_shaft(assembly, place)?);
            couplings.resize_with(linear.couplings.len(), Vec::new);
            for (all, own) in couplings.iter_mut().zip(&linear.couplings) {
                all.push(own.stiffness);
            }
        }
        solver.restore_columns(columns);
        let of_all = |all: Vec<Vec<ShaftMatrix>>| all.iter().map(|one| Ripple::of(one)).collect();
        Ok(RippleOfList {
            bearings: of_all(bearings),
            shaft: Ripple::of(&shaft),
            couplings: of_all(couplings),
        })
    }
}
