//! Bodies and interactions of a bearing over an interval: the one list from which statics and motion make their system,
//! and of which modes take the contacts.
//!
//! Lumped bodies: the shaft, the balls, then the seat of the outer ring if it slides. Elastic ones: the flexible
//! rings, inner first. Of a ring that a static equilibrium sees, ports are the elastic motion relative to what
//! carries it; of one that moves in time, all motion, and its mount follows the shaft.

use contact::{Meridian, Side};
use ring::Partner;

use crate::bodies::{CageBody, FlatBody, FreeBall, Inertia, Name, TiltedLoads};
use crate::effects::Loads;
use crate::interactions::cage::land::LandStep;
use crate::interactions::cage::links::CageLinks;
use crate::interactions::cage::pocket::PocketStep;
use crate::interactions::free_contact::{Carrier, FreeContacts, GROOVE_LENGTH};
use crate::interactions::raceway_contact::{GrooveBodies, Means, RacewayContacts, Site, SiteState};
use crate::interactions::seat_spring::{Seat, SeatSpring};
use crate::model::Model;
use crate::system::{
    CarriedCircle, CircleLengths, ElasticPorts, Interaction, Interval, Lengths, Lumped, System,
};

/// Number of the shaft among the lumped bodies.
pub const SHAFT: usize = 0;
/// Number of the first ball.
pub const FIRST_BALL: usize = 1;
/// Number of the contacts among the interactions.
pub const CONTACTS: usize = 0;

/// Bodies and interactions of a bearing over an interval.
#[derive(Clone)]
pub struct BearingParts {
    /// The interval.
    pub interval: Interval,
    /// The shaft.
    pub shaft: FlatBody<5>,
    /// The balls.
    pub balls: Vec<FlatBody<2>>,
    /// Ports of the flexible rings, inner first.
    pub rings: [Option<ElasticPorts>; 2],
    /// Contacts of balls and rings.
    pub contacts: RacewayContacts,
    /// The seat of the outer ring and its spring, if it slides along the axis.
    pub seat: Option<SlidingSeat>,
    /// Free balls and their contacts, in the place of `balls` and of the links of `contacts`.
    pub free: Option<FreeParts>,
}

/// Free balls and their contacts.
#[derive(Clone)]
pub struct FreeParts {
    /// The balls.
    pub balls: Vec<FreeBall>,
    /// Their contacts.
    pub contacts: FreeContacts,
    /// The cage, if it is free.
    pub cage: Option<CageParts>,
}

/// A free cage and its contacts.
#[derive(Clone)]
pub struct CageParts {
    /// The cage.
    pub body: CageBody,
    /// Its pockets.
    pub pockets: CageLinks<PocketStep>,
    /// Its ends on the land that guides it.
    pub lands: CageLinks<LandStep>,
}

impl CageParts {
    /// Number of the cage among the lumped bodies.
    pub fn number(n_balls: usize, has_seat: bool) -> usize {
        FIRST_BALL + n_balls + usize::from(has_seat)
    }
}

/// The seat of the outer ring along the axis.
#[derive(Clone)]
pub struct SlidingSeat {
    /// The seat; only z is free.
    pub body: FlatBody<5>,
    /// What presses it.
    pub spring: SeatSpring,
}

/// A seat over an interval: what is known of it, and its inertia, start and load along z.
pub struct SeatStep {
    /// The seat.
    pub seat: Seat,
    /// Its motion along z.
    pub axial: Inertia,
    /// Weight of the start in the spring's force.
    pub weight: f64,
}

/// What a bearing's contacts are made of.
pub struct ContactList {
    /// The contacts.
    pub sites: Vec<Site>,
    /// Additional forces on the rings, by site; see [`RacewayContacts::dead`].
    pub dead: Vec<Meridian>,
    /// Means over a step; None: forces of an instant.
    pub means: Option<Means>,
}

impl BearingParts {
    /// A bearing of these bodies; connects the contacts.
    pub fn new(
        interval: Interval,
        shaft: FlatBody<5>,
        balls: Vec<FlatBody<2>>,
        rings: [Option<ElasticPorts>; 2],
        contacts: ContactList,
        seat: Option<SeatStep>,
    ) -> BearingParts {
        let ContactList { sites, dead, means } = contacts;
        let n_balls = sites.len() / 2;
        let mut parts = BearingParts {
            interval,
            shaft,
            rings,
            contacts: RacewayContacts::new(sites, dead, means),
            seat: seat.map(|step| SlidingSeat::new(step, FIRST_BALL + n_balls)),
            balls,
            free: None,
        };
        parts.connect(&[Vec::new(), Vec::new()]);
        parts
    }

    /// Puts free balls in the place of others; connects their contacts.
    pub fn with_free(mut self, free: Option<FreeParts>) -> BearingParts {
        let carriers = Side::BOTH.map(|side| match (self.elastic(side), self.carrier(side)) {
            (Some(ring), _) => Carrier::Elastic(ring),
            (None, Some(body)) => Carrier::Lumped(body),
            (None, None) => Carrier::AtRest,
        });
        // A rigid ring moves as what carries it, without a linear part.
        let is_linear = self.rings[0].is_some() && self.bends();
        let sites = &self.contacts.sites;
        let finite = |index: usize| {
            let site = sites
                .get(index)
                .filter(|site| is_linear && site.side.choose(true, false))?;
            Some(CarriedCircle {
                carrier: SHAFT,
                circle: site.circle(),
                lengths: CircleLengths::OfCircle(GROOVE_LENGTH),
            })
        };
        self.free = free;
        if let Some(free) = &mut self.free {
            free.contacts.connect(FIRST_BALL, carriers, finite);
        }
        self
    }

    /// Number of balls.
    pub fn n_balls(&self) -> usize {
        self.contacts.sites.len() / 2
    }

    /// Puts flexible rings in the place of those before. Grooves of a ring that is None here stay at `held`, m, by
    /// ball.
    pub fn set_rings(&mut self, rings: [Option<ElasticPorts>; 2], held: &[Vec<Meridian>; 2]) {
        self.rings = rings;
        self.connect(held);
    }

    /// Connects the contacts with what moves the grooves of the rings.
    fn connect(&mut self, held: &[Vec<Meridian>; 2]) {
        let grooves = Side::BOTH.map(|side| {
            let elastic = self.elastic(side);
            // The ports of a ring in motion have the motion of what carries it in them.
            let carries = elastic.is_none() || self.interval == Interval::Rest;
            GrooveBodies {
                carrier: self.carrier(side).filter(|_| carries),
                finite: (side == Side::Inner && self.bends()).then_some(SHAFT),
                held: match elastic {
                    Some(_) => Vec::new(),
                    None => held[side.index()].clone(),
                },
                elastic,
            }
        });
        self.contacts.connect(FIRST_BALL, &grooves);
    }

    /// Loads whose moments change with the tilt of the shaft, if it may tilt.
    pub fn tilted_loads(&self, loads: &Loads) -> Option<TiltedLoads> {
        TiltedLoads::new(&loads.shaft, loads.lever).filter(|_| self.moves(&[3, 4]))
    }

    /// Whether the shaft may make a motion in which links to its groove are not linear.
    fn bends(&self) -> bool {
        let is_projected = self.contacts.sites.first().is_some_and(|site| site.is_projected);
        self.moves(if is_projected {
            &[3, 4]
        } else {
            &CarriedCircle::COORDINATES
        })
    }

    /// Whether the shaft may move in one of these dofs.
    fn moves(&self, dofs: &[usize]) -> bool {
        dofs.iter().any(|&dof| self.shaft.imposed[dof] != Some(0.0))
    }

    /// Their system.
    pub fn system(&self) -> System<'_> {
        let mut lumped: Vec<&dyn Lumped> = vec![&self.shaft];
        lumped.extend(self.balls.iter().map(|ball| ball as &dyn Lumped));
        let free = self.free.iter().flat_map(|free| &free.balls);
        lumped.extend(free.map(|ball| ball as &dyn Lumped));
        lumped.extend(self.seat.iter().map(|seat| &seat.body as &dyn Lumped));
        lumped.extend(self.cage().map(|cage| &cage.body as &dyn Lumped));
        System::new(
            self.interval,
            lumped,
            self.rings.iter().flatten().collect(),
            self.interactions(),
        )
    }

    /// The interactions of its bodies.
    pub fn interactions(&self) -> Vec<&dyn Interaction> {
        let seat = self.seat.iter().map(|seat| &seat.spring as &dyn Interaction);
        let contacts: &dyn Interaction = match &self.free {
            Some(free) => &free.contacts,
            None => &self.contacts,
        };
        let cage = self.cage().into_iter();
        let cage = cage.flat_map(|cage| [&cage.pockets as &dyn Interaction, &cage.lands]);
        std::iter::once(contacts).chain(seat).chain(cage).collect()
    }

    /// The cage, if it is free.
    pub fn cage(&self) -> Option<&CageParts> {
        self.free.as_ref()?.cage.as_ref()
    }

    /// Number of the pockets among the interactions; the ends on the land follow.
    pub fn pockets(&self) -> usize {
        CONTACTS + 1 + usize::from(self.seat.is_some())
    }

    /// Number of the lumped body that carries a ring; None is at rest.
    pub fn carrier(&self, side: Side) -> Option<usize> {
        carrier(side, self.n_balls(), self.seat.is_some())
    }

    /// Number of a flexible ring among the elastic bodies.
    pub fn elastic(&self, side: Side) -> Option<usize> {
        let before = self.rings[..side.index()].iter().flatten().count();
        self.rings[side.index()].as_ref().map(|_| before)
    }

    /// l of every contact at start and end, `[2 n_sites]`.
    pub fn reaches(&self, x: &[f64]) -> [Vec<f64>; 2] {
        self.system().lengths_at(CONTACTS, x)
    }

    /// Contacts at the end.
    pub fn states(&self, x: &[f64]) -> Vec<SiteState> {
        self.contacts.states(&self.reaches(x)[1])
    }
}

impl SlidingSeat {
    fn new(SeatStep { seat, axial, weight }: SeatStep, body: usize) -> SlidingSeat {
        let mut dofs = [Inertia::default(); 5];
        dofs[2] = axial;
        let imposed = [Some(0.0), Some(0.0), None, Some(0.0), Some(0.0)];
        SlidingSeat {
            body: FlatBody::new(Name::Seat, dofs, imposed),
            spring: SeatSpring::new(seat, body, weight),
        }
    }
}

/// Lengths of the contacts as the contacts take them.
pub fn lengths([start, end]: &[Vec<f64>; 2]) -> Lengths<'_> {
    Lengths { start, end }
}

/// Number of the lumped body that carries a ring, among a shaft, so many balls and perhaps a sliding seat; None is at
/// rest.
pub(crate) fn carrier(side: Side, n_balls: usize, has_seat: bool) -> Option<usize> {
    match side {
        Side::Inner => Some(SHAFT),
        Side::Outer => has_seat.then_some(FIRST_BALL + n_balls),
    }
}

/// What holds a ring: the shaft the inner one, the housing the outer one, in which it may slide.
pub(crate) fn partner(model: &Model, side: Side) -> Partner {
    match side {
        Side::Inner => Partner::SHAFT,
        // A seat that slides is held in its other dofs by the bearing's own list.
        Side::Outer if model.seat().is_some() => Partner::SHAFT,
        Side::Outer => Partner::AT_REST,
    }
}
