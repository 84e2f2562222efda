//! Natural frequencies and shapes: of one ring alone, or of the loaded bearing about its static equilibrium.
//!
//! Small free vibration, K x = omega^2 M x, without damping and without rotation: no gyroscopic splitting of modes,
//! no cage, the contacts stay where they are and keep the tangent of their law. Unknowns of a bearing: the nodes of
//! its flexible rings, the shaft's free dofs, and two dofs per ball, radial and axial. K holds the rings' stiffness
//! and per contact, with l the vector from groove centre to ball centre,
//!
//! ```text
//! k n n^T + Q/|l| (1 - n n^T),    k = dQ/dg,  n = l/|l|
//! ```
//!
//! spread over the ring by the weights of its patch. The second term is the geometric stiffness of the contact force:
//! all that holds a ball across the contact normals. A contact without load has none, so unloaded balls have modes at
//! zero. Levers are those of the deformed state, and the finite motion of the shaft adds the stiffness that its
//! curvature gives the contact forces ([`crate::system::Circle`]).
//!
//! - **Free** ring: six rigid motions at zero, then elastic modes, most of them double.
//! - **Held** ring: its bore or seat is clamped or held in its mean motion, as the scene has it, by a partner at rest,
//!   or it vibrates with the elastic body to which it is tied.
//! - **Bearing**: the outer ring is held by the housing, at rest or such a body; the inner ring by the shaft, whose
//!   free dofs move and carry its mass and moment of inertia. The rotation of the shaft about z is held. A rigid inner
//!   ring has the mass of the shaft and no other; dofs of the shaft without mass follow quasi-statically.
//!
//! Pairs come from block Lanczos about the negative shift lambda = -s ([`dense::eigen`]): K + s M is positive
//! definite even for a free ring, so the rings' own sparse Cholesky factors serve, and contacts and constraints are a
//! small dense system on top of them. Each ring is factored once, whatever the number of modes.

mod columns;
mod shape;
mod system;

use contact::Side;
use dense::{LanczosSettings, Searched, lowest_pairs};
use timer::{Laps, SharedLaps, Stopwatch};

use crate::bearing::{FIRST_BALL, SHAFT, lengths};
use crate::costs::{FACTOR, SEARCH};
use crate::error::DynamicsError;
use crate::model::{ContactMode, Model, ShaftDof};
use crate::solution::StaticSolution;
use crate::system::{Body, FiniteMotion, Link, LinkTerm, N_FINITE};
use columns::{LengthGrowth, LinkTangent};
use ring::{Backend, Partner, RingModel, VibratingRing};
use system::{BearingDofs, VibratingBearing};

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
    /// Number of unknowns.
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
    let body = VibratingRing::new(side.name(), ring, partner, shift, settings.backend)?;
    let mut rings = [None, None];
    rings[side.index()] = Some(body);
    let system = VibratingBearing::new(rings, Vec::new(), Vec::new(), shift)?;
    search(&system, settings, RING_BLOCK, clock, progress)
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
    let steel = &model.ball_material;
    let speed = (steel.young_modulus / steel.density).sqrt();
    let shift = shift(settings, speed / model.geometry.centre_radius(Side::Inner));
    let free: Vec<usize> = (0..5).filter(|&i| model.shaft[i] == ShaftDof::Free).collect();
    let shaft = Partner {
        moves: model.shaft.map(|dof| dof == ShaftDof::Free),
    };
    let housing = Partner {
        moves: [false, false, model.seat().is_some(), false, false],
    };
    let seat_mass = model.seat().map_or(0.0, |seat| seat.mass);
    let build = |side: Side| {
        let partner = match side {
            Side::Inner => (shaft, model.shaft_masses()),
            Side::Outer => (housing, [0.0, 0.0, seat_mass, 0.0, 0.0]),
        };
        let ring = model.ring(side);
        ring.map(|ring| VibratingRing::new(side.name(), ring, Some(partner), shift, settings.backend))
            .transpose()
    };
    let (inner, outer) = rayon::join(|| build(Side::Inner), || build(Side::Outer));
    let rings = [inner?, outer?];
    let mut small_mass = vec![model.ball_mass(); 2 * model.geometry.n_balls];
    let mut places = Vec::new();
    if rings[0].is_none() {
        for &dof in &free {
            places.push((SHAFT, dof, small_mass.len()));
            small_mass.push(model.shaft_masses()[dof]);
        }
    }
    let shaft = places.iter().map(|&(_, dof, place)| (dof, place)).collect();
    if let (None, Some(body)) = (&rings[1], equilibrium.parts.carrier(Side::Outer)) {
        places.push((body, 2, small_mass.len()));
        small_mass.push(seat_mass);
    }
    let seat = places.iter().find(|place| place.0 != SHAFT).map(|place| place.2);
    let link_tangents = link_tangents(equilibrium, &rings, &places);
    let block = model.geometry.n_balls.clamp(RING_BLOCK, LARGEST_BLOCK);
    let mut system = VibratingBearing::new(rings, small_mass, link_tangents, shift)?;
    system.set_bearing(BearingDofs {
        n_balls: model.geometry.n_balls,
        shaft,
        seat,
        tilt_arm: model.geometry.centre_radius(Side::Inner),
    });
    search(&system, settings, block, clock, progress)
}

/// Largest number of basis vectors that a search keeps, for forecasts of memory: ring alone, bearing.
pub fn basis_sizes(number: usize, n_balls: usize) -> [usize; 2] {
    [RING_BLOCK, n_balls.clamp(RING_BLOCK, LARGEST_BLOCK)]
        .map(|block| LanczosSettings::new(number, block).capacity())
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

/// Tangents of all interactions of the equilibrium and what they connect.
fn link_tangents(
    equilibrium: &StaticSolution,
    rings: &[Option<VibratingRing>; 2],
    places: &[(usize, usize, usize)],
) -> Vec<LinkTangent> {
    let parts = &equilibrium.parts;
    let x = parts.unknowns(&equilibrium.displacements);
    let system = parts.system();
    let vibrating = Vibrating {
        equilibrium,
        rings,
        places,
    };
    let mut link_tangents = Vec::new();
    for (number, family) in parts.interactions().into_iter().enumerate() {
        let found = system.lengths_at(number, &x);
        let at = family.evaluate(lengths(&found), &SharedLaps::default());
        let finite = system.finite_motions(number, &x);
        let n = family.n_rows();
        let tangents = at.tangents.chunks_exact(n * n);
        for ((link, tangent), finite) in family.links().iter().zip(tangents).zip(&finite) {
            link_tangents.push(LinkTangent {
                tangent: tangent.to_vec(),
                lengths: (0..n).map(|row| vibrating.growth(link, row, finite)).collect(),
            });
        }
        if system.has_curvature() {
            link_tangents.extend(vibrating.curvature(family.links(), &finite, &at.forces));
        }
    }
    link_tangents
}

/// What moves the coordinates of a bearing that vibrates.
struct Vibrating<'v> {
    equilibrium: &'v StaticSolution,
    rings: &'v [Option<VibratingRing>; 2],
    /// Body, its coordinate and its place among the small dofs, of what carries rigid rings.
    places: &'v [(usize, usize, usize)],
}

impl Vibrating<'_> {
    /// What moves one length of a link. What carries a ring has its dofs by body among the small ones, or in the motion
    /// of a flexible ring, which has that of its partner in it.
    fn growth(&self, link: &Link, row: usize, finite: &Option<FiniteMotion>) -> LengthGrowth {
        let is_elastic = |term: &LinkTerm| matches!(term.body, Body::Elastic(_));
        let is_ring = link.terms.iter().any(is_elastic);
        let mut growth = LengthGrowth::default();
        for term in link.terms.iter().filter(|term| term.rows[row] != 0.0) {
            let follows = is_ring && matches!(term.body, Body::Lumped(body) if self.carried(body).is_some());
            if !follows {
                self.add(&mut growth, (term.body, term.coordinate), term.rows[row]);
            }
        }
        if let (Some(carried), Some(finite)) = (link.finite, finite) {
            for (coordinate, row_of) in carried.coordinates().into_iter().zip(finite.rows()) {
                row_of
                    .get(row)
                    .into_iter()
                    .for_each(|value| self.add(&mut growth, coordinate, *value));
            }
        }
        growth
    }

    /// What finite motions and the loads that follow them add to the stiffness of the tilts under the forces of the
    /// links.
    fn curvature(
        &self,
        links: &[Link],
        finite: &[Option<FiniteMotion>],
        forces: &[f64],
    ) -> Option<LinkTangent> {
        let carrier = links.iter().find_map(|link| link.finite)?;
        let mut tangent = [[0.0; N_FINITE]; N_FINITE];
        let mut add = |sign: f64, values: [[f64; N_FINITE]; N_FINITE]| {
            let sums = tangent.as_flattened_mut().iter_mut();
            sums.zip(values.as_flattened())
                .for_each(|(sum, value)| *sum += sign * value);
        };
        let forces = forces.chunks_exact(forces.len() / links.len());
        for (finite, force) in finite.iter().zip(forces) {
            if let Some(finite) = finite {
                add(1.0, finite.circle.curvature(finite.at, [force[0], force[1]]));
            }
        }
        let [.., tilt_x, tilt_y] = self.equilibrium.displacements.shaft;
        if let Some(loads) = self.equilibrium.parts.shaft.tilted {
            add(-1.0, loads.slopes([tilt_x, tilt_y]));
        }
        let growth = |coordinate: (Body, usize)| {
            let mut growth = LengthGrowth::default();
            self.add(&mut growth, coordinate, 1.0);
            growth
        };
        Some(LinkTangent {
            tangent: tangent.as_flattened().to_vec(),
            lengths: carrier.coordinates().map(growth).to_vec(),
        })
    }

    /// Side of the ring that a lumped body carries.
    fn carried(&self, body: usize) -> Option<Side> {
        let carrier = |side: &Side| self.equilibrium.parts.carrier(*side) == Some(body);
        Side::BOTH.into_iter().find(carrier)
    }

    /// Adds `value` times the motion of a coordinate.
    fn add(&self, growth: &mut LengthGrowth, (body, coordinate): (Body, usize), value: f64) {
        match body {
            Body::Lumped(number) => {
                let Some(side) = self.carried(number) else {
                    let place = 2 * (number - FIRST_BALL) + coordinate;
                    return growth.small.push((place, value));
                };
                let mut places = self.places.iter();
                if let Some((_, _, place)) = places.find(|(of, dof, _)| (*of, *dof) == (number, coordinate)) {
                    growth.small.push((*place, value));
                }
                let ring = self.rings[side.index()].as_ref();
                if let Some(load) = ring.and_then(|ring| ring.partner_load(coordinate)) {
                    growth.add_ring(side.index(), load, value);
                }
            }
            Body::Elastic(number) => {
                let of = |side: &Side| self.equilibrium.parts.elastic(*side) == Some(number);
                let found = Side::BOTH.into_iter().find(of);
                let Some((side, ring)) = found.and_then(|s| Some((s, self.rings[s.index()].as_ref()?)))
                else {
                    return;
                };
                let foot = &self.equilibrium.footprints(side)[coordinate / 2];
                let weights = ring.held().coordinates.reduce_weights(&foot.weights);
                growth.add_ring(side.index(), &weights[coordinate % 2], value);
            }
        }
    }
}

fn search(
    system: &VibratingBearing,
    settings: ModesSettings,
    block: usize,
    mut clock: Stopwatch,
    progress: &mut dyn FnMut(Searched),
) -> Result<ModeSet, DynamicsError> {
    let mut laps = Laps::default();
    laps.add(FACTOR, clock.lap());
    let lanczos = LanczosSettings::new(settings.number, block);
    let pairs = lowest_pairs(system, lanczos, progress).map_err(|source| DynamicsError::Modes { source })?;
    let n = dense::EigenProblem::n(system);
    let modes = pairs.vectors.chunks_exact(n).enumerate().map(|(i, x)| {
        let [value, bound] = [pairs.values[i], pairs.bounds[i]];
        let is_rigid = value <= RIGID * dense::EigenProblem::shift(system);
        Mode::new(system, x, [value, bound], pairs.residuals[i], is_rigid)
    });
    let modes = modes.collect();
    laps.add(SEARCH, clock.lap());
    Ok(ModeSet {
        modes,
        n_unknowns: n,
        steps: pairs.steps,
        laps,
    })
}
