//! Energies of contacts at the ends of a step during which something moves under them.
//!
//! Over a step a contact keeps the surface and the mounting of its middle, so that its forces have a potential. Its
//! energies on the surfaces, or as it is mounted, at the ends are what the ledger counts the work of these by.

use contact::Meridian;

use super::raceway_contact::RacewayContacts;
use crate::system::Lengths;

impl RacewayContacts {
    /// Energies of the contacts at the start and at the end of a step, J, each on the surfaces of its own instant; None
    /// where no contact has strips.
    pub fn energies_on_surfaces(&self, lengths: Lengths) -> Option<[f64; 2]> {
        self.sites.iter().find(|site| site.strips.is_some())?;
        let is_smooth = self.sites.iter().any(|site| site.strips.is_none());
        let smooth = match is_smooth {
            true => [lengths.start, lengths.end].map(|l| self.states(l)),
            false => Default::default(),
        };
        let mut sum = [0.0; 2];
        for (index, site) in self.sites.iter().enumerate() {
            let energies = match site.strip_site() {
                Some(strips) => strips.energies_at_ends(lengths.of(index).map(Meridian::from)),
                None => [0, 1].map(|end: usize| smooth[end][index].force.energy),
            };
            (0..2).for_each(|end| sum[end] += energies[end]);
        }
        Some(sum)
    }

    /// Energies of the contacts at the start and at the end of a step, J, each as the bearing is mounted then; None
    /// where that does not change.
    pub fn energies_as_mounted(&self, lengths: Lengths) -> Option<[f64; 2]> {
        self.sites.iter().find(|site| site.ends.is_some())?;
        let energy = |end: usize, lengths: &[f64]| {
            let mut moved = self.clone();
            let mut lengths = lengths.to_vec();
            for (site, l) in moved.sites.iter_mut().zip(lengths.as_chunks_mut::<2>().0) {
                if let Some(ends) = &site.ends {
                    let mounted = ends[end];
                    *l = (Meridian::from(*l) + (mounted.reach - site.reach)).to_array();
                    site.touching = mounted.touching;
                }
            }
            moved
                .states(&lengths)
                .iter()
                .map(|state| state.force.energy)
                .sum()
        };
        Some([energy(0, lengths.start), energy(1, lengths.end)])
    }
}
