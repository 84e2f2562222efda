//! Natural frequencies and shapes: of one ring alone, or of the loaded bearing about its static equilibrium.
//!
//! Small free vibration, K x = omega^2 M x, without damping and without rotation: no gyroscopic splitting of modes,
//! no cage. Contacts keep the tangent of their law, and their patches go along with them (`patches`). Unknowns of a
//! bearing: the nodes of its flexible rings, the shaft's free dofs, and two dofs per ball, radial and axial. K holds
//! the rings' stiffness and per contact, with l the vector from groove centre to ball centre,
//!
//! ```text
//! k n n^T + Q/|l| (1 - n n^T),    k = dQ/dg,  n = l/|l|
//! ```
//!
//! spread over the ring by the weights of its patch. The second term is the geometric stiffness of the contact force:
//! all that holds a ball across the contact normals. A contact without load has neither. A ball without load on both
//! raceways is coupled to nothing: its two motions at zero frequency are left out ([`ModeSet::loose_balls`]).
//! Levers are those of the deformed state, and the finite motion of the shaft adds the stiffness that its
//! curvature gives the contact forces ([`crate::system::Circle`]).
//!
//! - **Free** ring: six rigid motions at zero, then elastic modes, most of them double.
//! - **Held** ring: its bore or seat is clamped or held in its mean motion, as the scene has it, by a partner at rest,
//!   or it vibrates with the elastic body to which it is tied.
//! - **Bearing**: the outer ring is held by the housing, at rest or such a body; the inner ring by the shaft, whose
//!   free dofs move and carry its mass and moment of inertia, or by an elastic body that moves with the shaft. The
//!   rotation of the shaft about z is held. A rigid inner ring has the mass of the shaft and no other; dofs of the
//!   shaft without mass follow quasi-statically.
//! - **Several bearings** on one shaft ([`modes_of_several`]): rings that are tied to one body vibrate with it and with
//!   each other; the shaft has a mass and a stiffness matrix, and inner rings stay where it has them by constraints.
//!
//! Pairs come from block Lanczos about the negative shift lambda = -s ([`dense::eigen`]): K + s M is positive
//! definite even for a free ring, so the rings' own sparse Cholesky factors serve, and contacts and constraints are a
//! small dense system on top of them. Each ring is factored once, whatever the number of modes.

mod blocks;
mod columns;
mod links;
mod patches;
mod several;
mod shape;
mod small;
mod symmetric;
mod system;

use std::collections::BTreeSet;

use contact::Side;
use dense::{EigenProblem, LanczosSettings, Searched, lowest_pairs};
use ring::sparse::SparseLoad;
use ring::{Backend, Partner, RingModel, RingToVibrate, VibratingRings};
use timer::{Laps, Stopwatch};

use crate::bearing::SHAFT;
use crate::costs::{FACTOR, SEARCH};
use crate::error::DynamicsError;
use crate::model::{ContactMode, Model, ShaftDof};
use crate::solution::StaticSolution;
use columns::LinkTangent;
use links::{RingCarrier, VibratingLinks};
use patches::links_with_patches;
use shape::{BearingDofs, FoundPair, RingPlace};
use small::SmallDofs;
use system::VibratingSystem;

pub use several::{BearingOnFreeShaft, FreeShaft, ModeOfSeveral, ModesOfSeveral, modes_of_several};
pub use shape::{Mode, Shape};

/// omega^2 over the shift below which a mode is a rigid motion: far above round-off (1e-9 on 60 000 dofs), and a
/// thirty-thousandth of the first elastic frequency of a ring.
const RIGID: f64 = 1e-7;
/// Frequency of the shift over that of a wave along the radius, sqrt(E/rho)/R: near the first elastic modes of rings.
const SHIFT: f64 = 0.1;
/// Vectors per block of a ring: its modes are double, and two more speed up the search.
const RING_BLOCK: usize = 4;
/// Largest block of a bearing: clusters of modes are as wide as its number of balls.
const LARGEST_BLOCK: usize = 32;

/// What holds a ring that is looked at alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingSupport {
    /// Nothing.
    Free,
    /// Its bore or seat is held as in the bearing, by a partner at rest.
    AsHeld,
}

/// How many modes, and where the search is centred.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModesSettings {
    /// Number of modes, from the lowest, rigid motions included.
    pub number: usize,
    /// Frequency of the shift, Hz: s = (2 pi shift)^2. None: chosen from size and material.
    pub shift: Option<f64>,
    /// Linear solver of the rings.
    pub backend: Backend,
}

/// Modes of one body, ascending.
#[derive(Clone, Debug)]
pub struct ModeSet {
    /// The modes; fewer than asked for when the body has no more.
    pub modes: Vec<Mode>,
    /// Balls that touch neither raceway. They stand still in all modes.
    pub loose_balls: usize,
    /// Number of unknowns, without those of loose balls.
    pub n_unknowns: usize,
    /// Blocks of Lanczos; 0 by the dense method.
    pub steps: usize,
    /// Wall time of assembly and factorisation, [`FACTOR`], and of the search, [`SEARCH`].
    pub laps: Laps,
}

/// Modes of a ring alone.
pub fn ring_modes(
    side: Side,
    ring: &RingModel,
    support: RingSupport,
    settings: ModesSettings,
    progress: &mut dyn FnMut(Searched),
) -> Result<ModeSet, DynamicsError> {
    let clock = Stopwatch::start();
    let speed = (ring.material.young_modulus / ring.material.density).sqrt();
    let shift = shift(settings, speed / ring.groove.centre_radius);
    let partner = match support {
        RingSupport::Free => None,
        RingSupport::AsHeld => Some((Partner::AT_REST, [0.0; 5])),
    };
    let name = side.name();
    let body = VibratingRings::new(&[RingToVibrate { name, ring, partner }], shift, settings.backend)?;
    let system = VibratingSystem::new(vec![body], SmallDofs::default(), Vec::new(), Vec::new(), shift)?;
    let mut dofs = BearingDofs::default();
    dofs.rings[side.index()] = Some(RingPlace { group: 0, ring: 0 });
    search(&system, settings, RING_BLOCK, clock, progress)
        .map(|found| found.with(0, |pair| Mode::new(&system, &dofs, pair)))
}

/// Modes of the loaded bearing about an equilibrium of the model.
pub fn bearing_modes(
    model: &Model,
    equilibrium: &StaticSolution,
    settings: ModesSettings,
    progress: &mut dyn FnMut(Searched),
) -> Result<ModeSet, DynamicsError> {
    let clock = Stopwatch::start();
    check_supported(model, equilibrium)?;
    let shift = shift(settings, wave_rate(model));
    let free: Vec<usize> = (0..5).filter(|&i| model.shaft[i] == ShaftDof::Free).collect();
    let shaft = Partner {
        moves: model.shaft.map(|dof| dof == ShaftDof::Free),
    };
    let wanted = wanted(model, (shaft, model.shaft_masses()));
    let (groups, places) = grouped(&wanted, shift, settings.backend)?;
    let mut small = SmallDofs::default();
    let (dofs, carriers) = add_bearing(model, equilibrium, &mut small, [places[0], places[1]], |small| {
        let mut motion = [const { Vec::new() }; 5];
        for &dof in free.iter().filter(|_| places[0].is_none()) {
            motion[dof] = vec![(small.add(model.shaft_masses()[dof]), 1.0)];
        }
        motion
    });
    let link_tangents = links_with_patches(&VibratingLinks {
        model,
        equilibrium,
        parts: &equilibrium.parts,
        rings: dofs.in_groups(&groups),
        first_ball: dofs.first_ball,
        carriers: &carriers,
    })?;
    let loose = hold_loose_balls(&mut small, std::slice::from_ref(&dofs), &link_tangents, shift);
    let block = block(model.geometry.n_balls);
    let system = VibratingSystem::new(groups, small, link_tangents, Vec::new(), shift)?;
    search(&system, settings, block, clock, progress)
        .map(|found| found.with(loose, |pair| Mode::new(&system, &dofs, pair)))
}

/// Rate of the slowest wave over the size of a bearing, 1/s.
fn wave_rate(model: &Model) -> f64 {
    let steel = &model.ball_material;
    let speed = (steel.young_modulus / steel.density).sqrt();
    speed / model.geometry.centre_radius(Side::BOTH[0])
}

/// The elastic rings of a bearing with what holds them, inner first, whose shaft carries masses.
fn wanted(model: &Model, shaft: (Partner, [f64; 5])) -> [Option<RingToVibrate<'_>>; 2] {
    let housing = Partner {
        moves: [false, false, model.seat().is_some(), false, false],
    };
    let seat_mass = model.seat().map_or(0.0, |seat| seat.mass);
    let partners = [shaft, (housing, [0.0, 0.0, seat_mass, 0.0, 0.0])];
    Side::BOTH.map(|side| {
        Some(RingToVibrate {
            name: side.name(),
            ring: model.ring(side)?,
            partner: Some(partners[side.index()]),
        })
    })
}

/// Makes elastic rings ready, those that are tied to one body together, and says where each is.
fn grouped(
    wanted: &[Option<RingToVibrate<'_>>],
    shift: f64,
    backend: Backend,
) -> Result<(Vec<VibratingRings>, Vec<Option<RingPlace>>), DynamicsError> {
    let mut groups: Vec<Vec<RingToVibrate<'_>>> = Vec::new();
    let mut places = Vec::new();
    for wanted in wanted {
        places.push(wanted.map(|ring| {
            let known = groups.iter().position(|group| group[0].shares_body(&ring));
            let group = known.unwrap_or(groups.len());
            if known.is_none() {
                groups.push(Vec::new());
            }
            groups[group].push(ring);
            let ring = groups[group].len() - 1;
            RingPlace { group, ring }
        }));
    }
    Ok((VibratingRings::of_groups(&groups, shift, backend)?, places))
}

/// Adds the balls of a bearing to the small dofs, what carries its rigid rings and its seat. `shaft` adds the dofs of a
/// shaft, if there are any, and gives its motion by small dofs.
fn add_bearing(
    model: &Model,
    equilibrium: &StaticSolution,
    small: &mut SmallDofs,
    rings: [Option<RingPlace>; 2],
    shaft: impl FnOnce(&mut SmallDofs) -> [SparseLoad; 5],
) -> (BearingDofs, Vec<RingCarrier>) {
    let first_ball = small.n();
    for _ in 0..2 * model.geometry.n_balls {
        small.add(model.ball_mass());
    }
    let shaft = shaft(small);
    let mut carriers = Vec::new();
    for (coordinate, motion) in shaft.iter().enumerate() {
        if rings[0].is_none() && !motion.is_empty() {
            carriers.push(RingCarrier {
                body: SHAFT,
                coordinate,
                motion: motion.clone(),
            });
        }
    }
    let [_, outer] = Side::BOTH;
    let sliding = equilibrium.parts.carrier(outer).filter(|_| rings[1].is_none());
    let seat = sliding.map(|body| {
        let place = small.add(model.seat().map_or(0.0, |seat| seat.mass));
        carriers.push(RingCarrier {
            body,
            coordinate: 2,
            motion: vec![(place, 1.0)],
        });
        place
    });
    let dofs = BearingDofs {
        rings,
        first_ball,
        n_balls: model.geometry.n_balls,
        shaft,
        seat,
        tilt_arm: model.geometry.centre_radius(Side::BOTH[0]),
    };
    (dofs, carriers)
}

/// Makes balls of bearings stand on which no contact pushes, and says how many there are. They have neither stiffness
/// nor coupling, and would fill the lowest modes with nothing.
fn hold_loose_balls(
    small: &mut SmallDofs,
    bearings: &[BearingDofs],
    link_tangents: &[LinkTangent],
    shift: f64,
) -> usize {
    let is_stiff = |link: &&LinkTangent| link.tangent.iter().any(|entry| *entry != 0.0);
    let lengths = link_tangents
        .iter()
        .filter(is_stiff)
        .flat_map(|link| &link.lengths);
    let pushed: BTreeSet<usize> = lengths
        .flat_map(|length| length.small.iter().map(|(dof, _)| *dof))
        .collect();
    let firsts = bearings
        .iter()
        .flat_map(|dofs| (0..dofs.n_balls).map(|ball| dofs.first_ball + 2 * ball));
    let mut n = 0;
    for first in firsts {
        let own = [first, first + 1];
        if !own.iter().any(|dof| pushed.contains(dof)) {
            own.iter().for_each(|dof| small.hold(*dof, shift));
            n += 1;
        }
    }
    n
}

/// Vectors of a ring per ball on it: two directions of the contact, and two in which its patch changes.
pub const COLUMNS_PER_BALL: usize = 4;

/// Largest number of basis vectors that a search keeps, for forecasts of memory: ring alone, bearing.
pub fn basis_sizes(number: usize, n_balls: usize) -> [usize; 2] {
    [RING_BLOCK, block(n_balls)].map(|block| LanczosSettings::new(number, block).capacity())
}

/// Vectors per block of bearings with so many balls.
fn block(n_balls: usize) -> usize {
    n_balls.clamp(RING_BLOCK, LARGEST_BLOCK)
}

fn check_supported(model: &Model, equilibrium: &StaticSolution) -> Result<(), DynamicsError> {
    if model.contact.mode == ContactMode::Facet {
        let what = "contact.mode = \"facet\", whose forces have no energy; use \"patch\"";
        return Err(DynamicsError::NotInModes { what });
    }
    if equilibrium
        .parts
        .balls
        .iter()
        .any(|ball| ball.dofs[0].load_slope != 0.0)
    {
        let what = "the centrifugal force of balls: they belong to a bearing that does not turn";
        return Err(DynamicsError::NotInModes { what });
    }
    Ok(())
}

/// The shift s, 1/s^2.
fn shift(settings: ModesSettings, wave_rate: f64) -> f64 {
    match settings.shift {
        Some(frequency) => (std::f64::consts::TAU * frequency).powi(2),
        None => (SHIFT * wave_rate).powi(2),
    }
}

/// Eigenpairs of a system that were searched.
struct SearchedPairs {
    pairs: dense::Eigenpairs,
    n_unknowns: usize,
    shift: f64,
    laps: Laps,
}

impl SearchedPairs {
    /// What `make` makes of each of the pairs.
    fn made<T>(&self, make: impl Fn(FoundPair<'_>) -> T) -> Vec<T> {
        let vectors = self.pairs.vectors.chunks_exact(self.n_unknowns).enumerate();
        let pair = |(i, x)| {
            make(FoundPair {
                x,
                value: self.pairs.values[i],
                bound: self.pairs.bounds[i],
                residual: self.pairs.residuals[i],
                is_rigid: self.pairs.values[i] <= RIGID * self.shift,
            })
        };
        vectors.map(pair).collect()
    }

    fn with(self, loose_balls: usize, make: impl Fn(FoundPair<'_>) -> Mode) -> ModeSet {
        ModeSet {
            modes: self.made(make),
            loose_balls,
            n_unknowns: self.n_unknowns - 2 * loose_balls,
            steps: self.pairs.steps,
            laps: self.laps,
        }
    }
}

fn search(
    system: &VibratingSystem,
    settings: ModesSettings,
    block: usize,
    mut clock: Stopwatch,
    progress: &mut dyn FnMut(Searched),
) -> Result<SearchedPairs, DynamicsError> {
    let mut laps = Laps::default();
    laps.add(FACTOR, clock.lap());
    let lanczos = LanczosSettings::new(settings.number, block);
    let pairs = lowest_pairs(system, lanczos, progress).map_err(|source| DynamicsError::Modes { source })?;
    laps.add(SEARCH, clock.lap());
    Ok(SearchedPairs {
        pairs,
        n_unknowns: system.n(),
        shift: system.shift(),
        laps,
    })
}
