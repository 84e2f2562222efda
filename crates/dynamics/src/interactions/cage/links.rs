//! The links of a cage: a family of pockets, and one of the ends on the land.

use timer::SharedLaps;

use super::super::free_contact::jet::Jet;
use super::super::free_contact::{Carrier, N_LENGTHS, link_forces, unit};
use super::land::LandStep;
use super::pocket::PocketStep;
use super::{CageContact, CageForce};
use crate::system::{BodyId, Character, Interaction, Lengths, Link, LinkForces, LinkRows, LinkTerm};

/// A family of contacts of the cage.
#[derive(Clone, Debug, Default)]
pub struct CageLinks<C> {
    /// The contacts: pockets by ball, or both ends on the land.
    pub contacts: Vec<C>,
    links: Vec<Link>,
}

impl CageLinks<PocketStep> {
    /// Pockets of balls that are lumped bodies from `first_ball` on, in a cage that is the body `cage`.
    pub fn pockets(contacts: Vec<PocketStep>, first_ball: usize, cage: usize) -> CageLinks<PocketStep> {
        let link = |ball: usize| {
            let of_ball = (0..6).map(|c| unit(BodyId::Lumped(first_ball + ball), c, c));
            let of_cage = (0..6).map(|c| unit(BodyId::Lumped(cage), c, 6 + c));
            Link::linear(LinkRows::default(), of_ball.chain(of_cage).collect())
        };
        let links = (0..contacts.len()).map(link).collect();
        CageLinks { contacts, links }
    }
}

impl CageLinks<LandStep> {
    /// Ends of a cage, which is the body `cage`, on a land that `ring` carries.
    pub fn lands(contacts: Vec<LandStep>, cage: usize, ring: Carrier) -> CageLinks<LandStep> {
        let mut terms: Vec<LinkTerm> = (0..6).map(|c| unit(BodyId::Lumped(cage), c, c)).collect();
        if let Carrier::Lumped(body) = ring {
            terms.extend((0..5).map(|c| unit(BodyId::Lumped(body), c, 6 + c)));
        }
        let links = vec![Link::linear(LinkRows::default(), terms); contacts.len()];
        CageLinks { contacts, links }
    }
}

impl<C: CageContact> CageLinks<C> {
    /// Forces of all contacts at these lengths, and what resists the growth of the lengths of each.
    pub fn found(&self, lengths: Lengths) -> Vec<(CageForce, [Jet; N_LENGTHS])> {
        let of = |(i, contact): (usize, &C)| {
            let [_, end] = lengths.of(i);
            let mut resists = [Jet::default(); N_LENGTHS];
            (contact.evaluate(end, &mut resists), resists)
        };
        self.contacts.iter().enumerate().map(of).collect()
    }
}

impl<C: CageContact> Interaction for CageLinks<C> {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn n_rows(&self) -> usize {
        N_LENGTHS
    }

    fn character(&self) -> Character {
        Character::General
    }

    fn evaluate(&self, lengths: Lengths, costs: &SharedLaps) -> LinkForces {
        costs.time("cage", || {
            link_forces(self.found(lengths).into_iter().map(|(_, resists)| resists))
        })
    }

    fn round_off(&self, lengths: Lengths) -> f64 {
        let of = |(i, contact): (usize, &C)| {
            let [_, end] = lengths.of(i);
            let [f, g] = contact.evaluate(end, &mut [Jet::default(); N_LENGTHS]).normal;
            let (dt, size) = contact.sizes();
            contact
                .impact()
                .error_of(f.hypot(g), dt, 2.0 * f64::EPSILON * size)
        };
        self.contacts.iter().enumerate().map(of).sum()
    }
}
