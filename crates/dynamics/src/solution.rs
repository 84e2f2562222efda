//! A static equilibrium: displacements, forces, energies and the checks on them.

use body::BodyLoad;
use contact::{LoadedPatch, Meridian, Side};
use ring::vectors::dot;

use crate::balls::{BallResult, ContactResult, Friction};
use crate::bearing::{BearingParts, CONTACTS, SHAFT, SlidingSeat};
use crate::displacements::Displacements;
use crate::effects::Loads;
use crate::effects::steady_balls::SteadyBalls;
use crate::error::DynamicsError;
use crate::footprint::{Footprint, loaded, sizes};
use crate::interactions::carried_site::across_on_ball;
use crate::interactions::raceway_contact::{Site, SiteState, on_rings};
use crate::loading::LoadCase;
use crate::model::Model;
use crate::pose::Pose;
use crate::surfaces::{EllipseKind, Strips};
use crate::system::{FiniteMotion, Interval};
use crate::unloaded_balls::centre_unloaded;

/// Peak pressure that leaves a permanent indentation of 1e-4 of the ball diameter in bearing steel, Pa: ISO 76, for
/// ball bearings.
pub(crate) const STATIC_LIMIT: f64 = 4.2e9;
/// Friction coefficient of bearing steel above which a force across a contact cannot be carried: lubricated contacts
/// have 0.05 to 0.1, dry ones hardly more than 0.15 in rolling (Harris, 4th ed., chapter 14).
const MOST_FRICTION: f64 = 0.15;

/// A static equilibrium.
pub struct StaticSolution {
    /// Displacements of shaft, balls and groove centres.
    pub displacements: Displacements,
    /// Where the parts of the bearing stand.
    pub pose: Pose,
    /// Results of every ball.
    pub balls: Vec<BallResult>,
    /// How free balls roll; None where they are not free, or nothing drives them.
    pub steady: Option<SteadyBalls>,
    /// Friction of free balls; None where balls are not free.
    pub friction: Option<Friction>,
    /// Elastic nodal displacements of flexible rings relative to shaft or housing, in the frame of the ring's mesh,
    /// which may have turned, m, `[n_nodes][3]` flat.
    pub elastic: [Option<Vec<f64>>; 2],
    /// Out-of-balance force on the shaft, N and N m, about its origin; zero on prescribed dofs.
    pub shaft_residual: [f64; 5],
    /// Force and moment that hold the prescribed dofs, N and N m.
    pub shaft_reaction: [f64; 5],
    /// Strain energy of the rings, J.
    pub strain_energy: f64,
    /// Energy of the local contacts (2/5 K d_e^2.5 - c_s Q^2/2), J.
    pub hertz_energy: f64,
    /// Loads times displacements, J.
    pub load_work: f64,
    /// Potential of the loads, springs and balls' centrifugal forces among them, J.
    pub load_potential: f64,
    /// What is missing in the virtual work of all forces through the displacements, J: zero at equilibrium.
    pub work_defect: f64,
    /// Rounds of patch placement.
    pub rounds: usize,
    /// Newton iterations in all rounds.
    pub newton_iterations: usize,
    /// Warnings a user should read.
    pub warnings: Vec<String>,
    /// Bodies and contacts as they were solved.
    pub parts: BearingParts,
    footprints: [Vec<Footprint>; 2],
}

/// Rings of a solution: elastic fields and the places of the contacts on them, inner first.
pub struct RingFields {
    /// Elastic nodal displacements, m; None for a rigid ring.
    pub elastic: [Option<Vec<f64>>; 2],
    /// Contacts by ball; empty for a rigid ring.
    pub footprints: [Vec<Footprint>; 2],
}

impl StaticSolution {
    /// Evaluates everything at the equilibrium `u` of a load case, found in a number of rounds.
    pub fn new(
        case: LoadCase,
        mut u: Displacements,
        rings: RingFields,
        rounds: usize,
    ) -> Result<StaticSolution, DynamicsError> {
        let (model, parts) = (case.model, &case.parts);
        centre_unloaded(parts, &mut u);
        let states = parts.states_at(&u);
        let forces = on_rings(&states);
        let (residual, reaction) = shaft_balance(parts, &u, &forces);
        let finite = parts.system().finite_motions(CONTACTS, &parts.unknowns(&u));
        // Loads on the rings, through their elastic motion: on their bodies and, besides the normal forces, at
        // contacts.
        let ring_load_work = body_work(&case.loads, &rings)
            + ring_contact_work(&rings, &case.loads.contacts)
            + load_work_of_bodies(&case, &rings)?;
        let strain_energy = 0.5 * (ring_contact_work(&rings, &forces) + ring_load_work);
        let hertz_energy = states.iter().map(|state| state.force.energy).sum();
        let contact_work: f64 = parts.contacts.sites.iter().zip(&states).map(contact_work).sum();
        let (finite_work, finite_load) = finite_work(parts, &finite, &forces);
        let mut balls = ball_results(model, parts, &states, &u);
        let steady = case.steady(&u)?;
        let undriven = if steady.is_none() { case.undriven(&u) } else { None };
        let rolling = steady.as_ref().or(undriven.as_ref());
        if let Some(rolling) = rolling {
            for (i, ball) in balls.iter_mut().enumerate() {
                ball.free = Some(rolling.result(i, ball.azimuth_rad));
            }
        }
        let load_work = ball_work(parts, &u)
            + dot(&parts.shaft_load(), &u.shaft)
            + dot(&parts.shaft.loads_by_tilt(Interval::Rest, &u.shaft), &u.shaft)
            + ring_load_work
            + seat_work(parts, &u)
            + finite_load;
        Ok(StaticSolution {
            warnings: all_warnings(&case, &rings.footprints, &forces, &balls),
            balls,
            friction: rolling.map(SteadyBalls::friction),
            steady,
            work_defect: load_work + dot(&reaction, &u.shaft)
                - 2.0 * strain_energy
                - contact_work
                - finite_work,
            shaft_residual: residual,
            shaft_reaction: reaction,
            strain_energy,
            hertz_energy,
            load_work,
            load_potential: following_work(parts, &u) - load_work,
            rounds,
            newton_iterations: case.newton_iterations,
            displacements: u,
            pose: case.pose,
            parts: case.parts,
            elastic: rings.elastic,
            footprints: rings.footprints,
        })
    }

    /// Load on all of the body of a ring, in the frame of the ring; None where it takes none.
    pub fn body_load(&self, model: &Model, side: Side) -> Option<BodyLoad> {
        model.body_load(side, &self.pose.now, self.pose.frame_angle(side))
    }

    /// Places of the contacts on one side, by ball; empty for a rigid ring.
    pub fn footprints(&self, side: Side) -> &[Footprint] {
        &self.footprints[side.index()]
    }

    /// Contact forces on the ring of one side and the patches over which they are spread, by ball; empty for a rigid
    /// ring or facets.
    pub fn patches(&self, side: Side) -> Vec<LoadedPatch> {
        let patch = |(ball, foot): (usize, &Footprint)| {
            let contact = self.balls[ball].contact(side);
            let site = 2 * ball + side.index();
            let angle = contact.contact_angle_rad;
            Some(LoadedPatch {
                azimuth: self.parts.contacts.sites[site].ring_azimuth,
                force: contact.force_n,
                angle,
                semi_axes: contact.semi_axes_m,
                patch_angle: angle,
                patch_axes: foot.semi_axes?,
            })
        };
        let feet = self.footprints[side.index()].iter().enumerate();
        feet.filter_map(patch).collect()
    }
}

/// Work of the loads on the balls over their displacements, J.
fn ball_work(parts: &BearingParts, u: &Displacements) -> f64 {
    let slopes = parts.balls.iter().map(|ball| ball.dofs[0].load_slope);
    let loads = (0..parts.balls.len()).map(|ball| parts.ball_load(ball));
    let ball_work = loads.zip(slopes).zip(&u.balls);
    ball_work
        .map(|((f, slope), x)| Meridian::new(f.radial + slope * x.radial, f.axial).dot(*x))
        .sum()
}

/// What a reader of the equilibrium should know, of contacts, their friction and the effects.
fn all_warnings(
    case: &LoadCase,
    footprints: &[Vec<Footprint>; 2],
    forces: &[Meridian],
    balls: &[BallResult],
) -> Vec<String> {
    warnings(case.model, footprints, forces, balls)
        .into_iter()
        .chain(friction_warning(case.model, forces, &case.loads.contacts))
        .chain(
            case.model
                .effects
                .iter()
                .filter_map(|e| e.warning(case.model, &case.pose.now, balls)),
        )
        .collect()
}

/// What the virtual work of loads that follow a displacement, -k u, has more than their energy, J: half of it.
fn following_work(parts: &BearingParts, u: &Displacements) -> f64 {
    let balls = parts.balls.iter().zip(&u.balls);
    let balls: f64 = balls
        .map(|(ball, x)| ball.dofs[0].load_slope * x.radial * x.radial)
        .sum();
    let spring = parts
        .seat
        .as_ref()
        .map_or(0.0, |seat| seat.spring.force(u.seat) - seat.spring.force(0.0));
    let tilt = [u.shaft[3], u.shaft[4]];
    let tilted = parts.shaft.tilted.map_or(0.0, |loads| loads.virtual_excess(tilt));
    0.5 * (balls - spring * u.seat) + tilted
}

/// Load and spring of a seat that slides, and what contacts add besides their normal forces, through its
/// displacement, J.
fn seat_work(parts: &BearingParts, u: &Displacements) -> f64 {
    let contacts = parts.contacts.sites.iter().zip(&parts.contacts.dead);
    let dead: f64 = contacts
        .filter(|(site, _)| site.side == Side::Outer)
        .map(|(_, dead)| dead.axial)
        .sum();
    let of_seat = |seat: &SlidingSeat| (seat.body.dofs[2].load + dead - seat.spring.force(u.seat)) * u.seat;
    parts.seat.as_ref().map_or(0.0, of_seat)
}

/// Work of a contact force through the whole displacement of ball against groove centre, J.
fn contact_work((site, state): (&Site, &SiteState)) -> f64 {
    let (l, n) = (state.reach(), state.normal);
    let moved = l - site.reach;
    let across = state.lateral.map(|lateral| lateral.force(n, state.length));
    let across = across.unwrap_or_default();
    state.force.force * n.dot(moved) + across.radial * moved.radial + across.axial * moved.axial
}

/// Forces at the contacts, by site or none at all, times the elastic motion of the groove centres, J.
fn ring_contact_work(rings: &RingFields, forces: &[Meridian]) -> f64 {
    let mut work = 0.0;
    for side in Side::BOTH {
        if let Some(field) = &rings.elastic[side.index()] {
            for (ball, foot) in rings.footprints[side.index()].iter().enumerate() {
                if let Some(force) = forces.get(2 * ball + side.index()) {
                    work += Meridian::from(foot.weights.measure(field)).dot(*force);
                }
            }
        }
    }
    work
}

/// Body loads of the rings times their elastic displacements, J.
fn body_work(loads: &Loads, rings: &RingFields) -> f64 {
    let pairs = loads.rings.iter().zip(&rings.elastic);
    pairs
        .filter_map(|(load, field)| Some(dot(load.as_ref()?, field.as_ref()?)))
        .sum()
}

/// Loads on all of the bodies in which the rings sit times their displacements, J, as far as the rings' own seats have
/// a part in it ([`body::SeatTie::load_work`]).
fn load_work_of_bodies(case: &LoadCase, rings: &RingFields) -> Result<f64, DynamicsError> {
    let mut work = 0.0;
    for side in Side::BOTH {
        let (ring, load) = (case.model.ring(side), case.loads.bodies[side.index()]);
        let tied = ring.and_then(|ring| Some((ring, ring.tie.as_ref()?)));
        let (Some((ring, tie)), Some(field), true) = (tied, &rings.elastic[side.index()], load.is_some())
        else {
            continue;
        };
        if let Some(functions) = ring.seat_functions(side.name())? {
            let traction = tie.traction(&functions, field, case.model.acting(side, load));
            work += traction.map_or(0.0, |traction| tie.load_work(&traction, load));
        }
    }
    Ok(work)
}

/// What finite motions add to the virtual work through the displacements, J: of the normal forces, and of what contacts
/// add besides them, as a load.
fn finite_work(parts: &BearingParts, finite: &[Option<FiniteMotion>], forces: &[Meridian]) -> (f64, f64) {
    let (mut of_normal, mut of_dead) = (0.0, 0.0);
    let inner = forces.iter().step_by(2);
    for (ball, (finite, force)) in finite.iter().zip(inner).enumerate() {
        let Some(finite) = finite else { continue };
        let (lengths, rows) = (Meridian::from(finite.lengths()), finite.rows());
        let growth = [0, 1].map(|i| rows.iter().zip(finite.at).map(|(row, x)| row[i] * x).sum());
        let growth = Meridian::from(growth);
        of_normal += force.dot(growth - lengths);
        if let Some(dead) = parts.contacts.dead.get(2 * ball) {
            of_dead -= dead.dot(growth);
        }
    }
    (of_normal, of_dead)
}

/// Sum of contact and applied loads on the shaft under the normal forces on the rings: on free dofs a residual, on the
/// others minus the reaction.
fn shaft_balance(parts: &BearingParts, u: &Displacements, forces: &[Meridian]) -> ([f64; 5], [f64; 5]) {
    let mut all = forces.to_vec();
    let dead = parts.contacts.dead.iter();
    all.iter_mut()
        .zip(dead)
        .for_each(|(force, dead)| *force = *force + *dead);
    let taken = parts
        .system()
        .forces_on::<5>(SHAFT, CONTACTS, &parts.unknowns(u), &Meridian::flat(&all));
    let own = parts.shaft.forces(Interval::Rest, &u.shaft);
    let sum: [f64; 5] = std::array::from_fn(|i| -own[i] - taken[i]);
    let pick = |free: bool| {
        [0, 1, 2, 3, 4].map(|i| {
            if parts.shaft.imposed[i].is_none() == free {
                sum[i]
            } else {
                0.0
            }
        })
    };
    (pick(true), pick(false).map(|x| -x))
}

fn warnings(
    model: &Model,
    footprints: &[Vec<Footprint>; 2],
    forces: &[Meridian],
    balls: &[BallResult],
) -> Vec<String> {
    let mut warnings = edge_warnings(model, footprints, forces, balls);
    warnings.extend(model.shoulders.warning(&loaded(sizes(forces)), balls));
    let pressures = balls
        .iter()
        .flat_map(|b| [b.inner.peak_pressure_pa, b.outer.peak_pressure_pa]);
    let (place, highest) = pressures
        .enumerate()
        .fold((0, 0.0), |most, (i, p)| if p > most.1 { (i, p) } else { most });
    if highest > STATIC_LIMIT {
        warnings.push(format!(
            "the peak pressure at ball {}, {} raceway, is {:.2} GPa, above the static limit of bearing steel of {:.1} \
             GPa (ISO 76): there it yields, which this model does not know",
            place / 2,
            Side::BOTH[place % 2].name(),
            1e-9 * highest,
            1e-9 * STATIC_LIMIT
        ));
    }
    warnings
}

/// Warns of forces across contacts (the gyroscopic moment's) that friction cannot carry.
/// Free balls have no more than friction carries.
fn friction_warning(model: &Model, forces: &[Meridian], across: &[Meridian]) -> Option<String> {
    if model.traction().is_some() {
        return None;
    }
    let needed = forces.iter().zip(across).map(|(n, f)| f.norm() / n.norm());
    let (place, most) = needed
        .enumerate()
        .filter(|(_, needed)| !needed.is_nan())
        .fold((0, 0.0), |most, (i, c)| if c > most.1 { (i, c) } else { most });
    (most > MOST_FRICTION).then(|| {
        format!(
            "the gyroscopic moment of ball {} asks for a friction coefficient of {most:.2} on the {} raceway, more \
             than steel has ({MOST_FRICTION}): the ball would pivot there, which this model does not know; more \
             preload or the centrifugal force of the balls may be missing",
            place / 2,
            Side::BOTH[place % 2].name()
        )
    })
}

/// Warns of ellipses that reach beyond their groove: as strips tell, where there are edges, else as the mesh does.
fn edge_warnings(
    model: &Model,
    footprints: &[Vec<Footprint>; 2],
    forces: &[Meridian],
    balls: &[BallResult],
) -> Vec<String> {
    let (mut warnings, loaded) = (Vec::new(), loaded(sizes(forces)));
    for side in Side::BOTH {
        let is_beyond = |ball: &usize| match model.surfaces.edges(side) {
            Some(_) => balls[*ball].contact(side).ellipse == Some(EllipseKind::Edge),
            None => {
                let foot = footprints[side.index()].get(*ball);
                let contact = balls[*ball].contact(side);
                let reach = contact.semi_axes_m.groove / model.geometry.groove_radius(side);
                foot.is_some_and(|foot| foot.is_beyond(contact.contact_angle_rad))
                    || model.shoulders.is_beyond(side, contact.contact_angle_rad, reach)
            }
        };
        let truncated: Vec<String> = (0..balls.len())
            .filter(|ball| loaded[2 * ball + side.index()] && is_beyond(ball))
            .map(|ball| ball.to_string())
            .collect();
        if !truncated.is_empty() {
            warnings.push(format!(
                "edge contact on the {} raceway, balls {}: {}",
                side.name(),
                truncated.join(", "),
                model.surfaces.edge_meaning(side)
            ));
        }
    }
    warnings
}

/// Results of all balls at given displacements, where their contacts have these states.
fn ball_results(
    model: &Model,
    parts: &BearingParts,
    states: &[SiteState],
    u: &Displacements,
) -> Vec<BallResult> {
    let sites = &parts.contacts.sites;
    let contact = |i: usize| {
        let (site, state) = (&sites[i], &states[i]);
        let hertz = &model.hertz[site.side.index()];
        // As a motion has it: with the force of strips across the normal.
        let force = match state.lateral {
            Some(_) => state.on_ring().norm(),
            None => state.force.force,
        };
        let semi_axes = hertz.semi_axes(force);
        let of_strips = |strips: &Strips| strips.bearing(state.force.approach, state.angle, semi_axes);
        let bearing = site.strips.as_ref().map(of_strips);
        let peak = bearing.as_ref().map_or(1.0, |bearing| bearing.peak);
        ContactResult {
            force_n: force,
            contact_angle_rad: state.angle,
            approach_m: state.force.approach,
            semi_axes_m: semi_axes,
            peak_pressure_pa: peak * hertz.peak_pressure(force),
            ellipse: bearing.map(|bearing| bearing.kind),
        }
    };
    (0..model.geometry.n_balls)
        .map(|ball| BallResult {
            azimuth_rad: sites[2 * ball].azimuth.rem_euclid(2.0 * std::f64::consts::PI),
            inner: contact(2 * ball + Side::Inner.index()),
            outer: contact(2 * ball + Side::Outer.index()),
            displacement_m: u.balls[ball],
            across_n: across_on_ball(
                model,
                sites[2 * ball].azimuth,
                &u.shaft,
                states[2 * ball].on_ring(),
            ),
            free: None,
        })
        .collect()
}
