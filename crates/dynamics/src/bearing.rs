//! Bodies and interactions of a bearing over an interval: the one list from which statics and motion make their system,
//! and of which modes take the contacts.
//!
//! Lumped bodies: the shaft, then the balls. Elastic ones: the flexible rings, inner first. Of a ring that a static
//! equilibrium sees, ports are the elastic motion relative to what carries it; of one that moves in time, all motion,
//! and its mount follows the shaft.

use contact::Side;
use ring::Partner;

use crate::bodies::FlatBody;
use crate::interactions::raceway_contact::{GrooveBodies, Means, RacewayContacts, Site, SiteState};
use crate::system::{ElasticPorts, Interaction, Interval, Lengths, Lumped, System};

/// Number of the shaft among the lumped bodies.
pub const SHAFT: usize = 0;
/// Number of the first ball.
pub const FIRST_BALL: usize = 1;
/// Number of the contacts among the interactions.
pub const CONTACTS: usize = 0;

/// Bodies and interactions of a bearing over an interval.
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
}

/// What a bearing's contacts are made of.
pub struct ContactList {
    /// The contacts.
    pub sites: Vec<Site>,
    /// Additional forces on the rings, by site; see [`RacewayContacts::dead`].
    pub dead: Vec<[f64; 2]>,
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
    ) -> BearingParts {
        let held = [Vec::new(), Vec::new()];
        let grooves = groove_bodies(interval, &rings, &held);
        let ContactList { sites, dead, means } = contacts;
        BearingParts {
            interval,
            shaft,
            balls,
            rings,
            contacts: RacewayContacts::new(sites, FIRST_BALL, &grooves, dead, means),
        }
    }

    /// Puts flexible rings in the place of those before. Grooves of a ring that is None here stay at `held`, m, by ball.
    pub fn set_rings(&mut self, rings: [Option<ElasticPorts>; 2], held: &[Vec<[f64; 2]>; 2]) {
        self.rings = rings;
        let grooves = groove_bodies(self.interval, &self.rings, held);
        self.contacts.connect(FIRST_BALL, &grooves);
    }

    /// Their system.
    pub fn system(&self) -> System<'_> {
        let mut lumped: Vec<&dyn Lumped> = vec![&self.shaft];
        lumped.extend(self.balls.iter().map(|ball| ball as &dyn Lumped));
        System::new(
            self.interval,
            lumped,
            self.rings.iter().flatten().collect(),
            self.interactions(),
        )
    }

    /// The interactions of its bodies.
    pub fn interactions(&self) -> Vec<&dyn Interaction> {
        vec![&self.contacts]
    }

    /// Number of a flexible ring among the elastic bodies.
    pub fn elastic(&self, side: Side) -> Option<usize> {
        elastic_number(side, &self.rings)
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

/// Lengths of the contacts as the contacts take them.
pub fn lengths([start, end]: &[Vec<f64>; 2]) -> Lengths<'_> {
    Lengths { start, end }
}

fn elastic_number(side: Side, rings: &[Option<ElasticPorts>; 2]) -> Option<usize> {
    let before = rings[..side.index()].iter().flatten().count();
    rings[side.index()].as_ref().map(|_| before)
}

/// What moves the grooves of the rings. The housing is at rest.
fn groove_bodies(
    interval: Interval,
    rings: &[Option<ElasticPorts>; 2],
    held: &[Vec<[f64; 2]>; 2],
) -> [GrooveBodies; 2] {
    Side::BOTH.map(|side| {
        let elastic = elastic_number(side, rings);
        let carries = elastic.is_none() || interval == Interval::Rest;
        let held = &held[side.index()];
        GrooveBodies {
            carrier: (side == Side::Inner && carries).then_some(SHAFT),
            held: if elastic.is_none() {
                held.clone()
            } else {
                Vec::new()
            },
            elastic,
        }
    })
}

/// What holds a ring.
pub(crate) fn partner(side: Side) -> Partner {
    match side {
        Side::Inner => Partner::SHAFT,
        Side::Outer => Partner::AT_REST,
    }
}
