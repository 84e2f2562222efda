//! Natural modes of several bearings on one shaft, about the equilibrium of all of them.
//!
//! ```text
//! K_s q + sum  B_b^T f_b = omega^2 M_s q         the shaft, with the forces f_b of its bearings at their places B_b q
//! c_b^T y_b - B_b q      = 0                     an elastic inner ring of bearing b, whose seat moves with its place
//! ```
//!
//! Each bearing is what it is alone. The shaft has matrices M_s and K_s over its free dofs; a rigid shaft has no
//! stiffness. Contacts on a rigid inner ring take its place B_b q directly. Rings that are tied to one body vibrate
//! with it as one group. A body that carries several inner rings follows the shaft at its first seat.

use contact::Side;
use dense::Searched;
use ring::Partner;
use ring::sparse::SparseLoad;
use timer::{Laps, Stopwatch};

use super::columns::LengthGrowth;
use super::links::VibratingLinks;
use super::patches::links_with_patches;
use super::shape::{BearingDofs, FoundPair, Kinetic, Mode, Shape, is_larger};
use super::small::SmallDofs;
use super::system::VibratingSystem;
use super::{
    ModesSettings, add_bearing, block, check_supported, grouped, hold_loose_balls, search, shift, wanted,
    wave_rate,
};
use crate::error::DynamicsError;
use crate::model::Model;
use crate::solution::StaticSolution;
use crate::stiffness::released;

/// A shaft by its free dofs.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeShaft {
    /// Number of free dofs.
    pub n: usize,
    /// Mass matrix, kg and kg m^2, row-major `[n][n]`.
    pub mass: Vec<f64>,
    /// Stiffness, N/m and N m, row-major `[n][n]`.
    pub stiffness: Vec<f64>,
    /// Radius at which each dof counts as a displacement, m; 1 of displacements themselves. `[n]`.
    pub arms: Vec<f64>,
}

/// A bearing on a shaft.
pub struct BearingOnFreeShaft<'a> {
    /// The bearing.
    pub model: &'a Model,
    /// Where it stands.
    pub equilibrium: &'a StaticSolution,
    /// Motion x, y, z, tilt x, tilt y of its place, in its own frame, by free dofs of the shaft.
    pub place: [SparseLoad; 5],
}

/// A mode of several bearings on a shaft.
#[derive(Clone, Debug)]
pub struct ModeOfSeveral {
    /// All of it, with a shape of nothing: the shares of the kinetic energy are those of all inner rings, outer rings,
    /// balls, and of the shaft.
    pub whole: Mode,
    /// What each bearing has of it: its shares of the energy of all, and its shape, in its own frame.
    pub bearings: Vec<Mode>,
    /// Free dofs of the shaft, `[n]`, in the scale of the shapes.
    pub shaft: Vec<f64>,
}

/// Modes of several bearings, ascending.
#[derive(Clone, Debug)]
pub struct ModesOfSeveral {
    /// The modes; fewer than asked for when there are no more.
    pub modes: Vec<ModeOfSeveral>,
    /// Balls that touch neither raceway, of all bearings. They stand still in all modes.
    pub loose_balls: usize,
    /// Number of unknowns, without those of loose balls.
    pub n_unknowns: usize,
    /// Blocks of Lanczos; 0 by the dense method.
    pub steps: usize,
    /// Wall time, as of one bearing ([`super::ModeSet`]).
    pub laps: Laps,
}

/// Modes of bearings on a shaft about their equilibrium.
pub fn modes_of_several(
    bearings: &[BearingOnFreeShaft<'_>],
    shaft: &FreeShaft,
    settings: ModesSettings,
    progress: &mut dyn FnMut(Searched),
) -> Result<ModesOfSeveral, DynamicsError> {
    let clock = Stopwatch::start();
    for bearing in bearings {
        check_supported(bearing.model, bearing.equilibrium)?;
    }
    let models = || bearings.iter().map(|bearing| bearing.model);
    let shift = shift(settings, models().map(wave_rate).fold(f64::INFINITY, f64::min));
    let of_model = |model| wanted(model, (Partner::SHAFT, [0.0; 5]));
    let rings: Vec<_> = models().flat_map(of_model).collect();
    let (groups, places) = grouped(&rings, shift, settings.backend)?;
    let mut small = SmallDofs::default();
    let first = small.add_structure(shaft.n, &shaft.mass, &shaft.stiffness);
    let (mut all, mut links, mut joints) = (Vec::new(), Vec::new(), Vec::new());
    for (bearing, places) in bearings.iter().zip(places.chunks_exact(Side::BOTH.len())) {
        let (model, equilibrium) = (bearing.model, bearing.equilibrium);
        let rings = [places[0], places[1]];
        let place = || {
            let moved = |motion: &SparseLoad| motion.iter().map(|&(k, w)| (first + k, w)).collect();
            bearing.place.each_ref().map(moved)
        };
        let (dofs, carriers) = add_bearing(model, equilibrium, &mut small, rings, |_| place());
        let mut case = released(model, None, equilibrium)?;
        // Loads along the shaft do not turn with it.
        case.parts.shaft.tilted = None;
        links.extend(links_with_patches(&VibratingLinks {
            model,
            equilibrium,
            parts: &case.parts,
            rings: dofs.in_groups(&groups),
            first_ball: dofs.first_ball,
            carriers: &carriers,
        })?);
        if let Some((group, ring)) = dofs.in_groups(&groups)[0].filter(|(_, ring)| !ring.follows_body()) {
            joints.extend(dofs.shaft.iter().enumerate().filter_map(|(dof, motion)| {
                Some(LengthGrowth {
                    ring: Some((group, ring.partner_load(dof)?.clone())),
                    small: motion.iter().map(|&(k, w)| (k, -w)).collect(),
                })
            }));
        }
        all.push(dofs);
    }
    let loose_balls = hold_loose_balls(&mut small, &all, &links, shift);
    let n_balls = all.iter().map(|dofs| dofs.n_balls).sum();
    let system = VibratingSystem::new(groups, small, links, joints, shift)?;
    let found = search(&system, settings, block(n_balls), clock, progress)?;
    Ok(ModesOfSeveral {
        modes: found.made(|pair| ModeOfSeveral::new((&system, shaft), &all, pair)),
        loose_balls,
        n_unknowns: found.n_unknowns - 2 * loose_balls,
        steps: found.pairs.steps,
        laps: found.laps,
    })
}

impl ModeOfSeveral {
    /// Of an eigenvector; the shaft has the first of the small dofs.
    fn new(
        (system, shaft): (&VibratingSystem, &FreeShaft),
        bearings: &[BearingDofs],
        pair: FoundPair<'_>,
    ) -> ModeOfSeveral {
        let of_shaft = &system.small_part(pair.x)[..shaft.n];
        let mut shapes: Vec<Shape> = bearings
            .iter()
            .map(|dofs| Shape::new(system, dofs, pair.x))
            .collect();
        let mut largest = 0.0f64;
        let sizes = shapes
            .iter()
            .zip(bearings)
            .map(|(shape, dofs)| shape.largest(dofs.tilt_arm));
        for size in sizes.chain(of_shaft.iter().zip(&shaft.arms).map(|(q, arm)| q * arm)) {
            // Round-off does not choose between bearings that are alike.
            if is_larger(size, largest) {
                largest = size;
            }
        }
        shapes.iter_mut().for_each(|shape| shape.scale(1.0 / largest));
        let kinetic: Vec<Kinetic> = bearings.iter().map(|dofs| dofs.kinetic(system, pair.x)).collect();
        let entry = |i: usize| shaft.mass[i] * of_shaft[i / shaft.n] * of_shaft[i % shaft.n];
        let mut whole = Kinetic::default();
        whole.parts[3] = (0..shaft.n * shaft.n).map(entry).sum();
        for own in &kinetic {
            whole
                .parts
                .iter_mut()
                .zip(own.parts)
                .for_each(|(sum, x)| *sum += x);
            whole
                .bodies
                .iter_mut()
                .zip(own.bodies)
                .for_each(|(sum, x)| *sum += x);
        }
        let total: f64 = whole.parts.iter().sum();
        let of = |(kinetic, shape): (Kinetic, Shape)| Mode::of_parts(pair, kinetic, (total, largest), shape);
        ModeOfSeveral {
            whole: of((whole, Shape::default())),
            bearings: kinetic.into_iter().zip(shapes).map(of).collect(),
            shaft: of_shaft.iter().map(|q| q / largest).collect(),
        }
    }
}
