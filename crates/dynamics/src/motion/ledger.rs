//! The energy ledger: every joule in the model and every joule that came or went.
//!
//! total = kinetic + strain + Hertz energy. It may change only by work of loads (ball centrifugal force is one), of patches that move and change size with the contacts, and by dissipation. What is left is the defect: the error
//! of the scheme. A run whose defect exceeds its tolerance stops.

/// Energies and works, J, at the end of a step; works and losses are sums since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ledger {
    /// Kinetic energy of inner ring (with shaft), outer ring, balls.
    pub kinetic: [f64; 3],
    /// Strain energy of inner and outer ring.
    pub strain: [f64; 2],
    /// Energy of the local contacts.
    pub hertz: f64,
    /// Work of shaft and ball loads.
    pub load_work: f64,
    /// Work of moving and resized patches.
    pub patch_work: f64,
    /// Energy lost to contact damping.
    pub contact_loss: f64,
    /// Energy lost to Rayleigh damping.
    pub rayleigh_loss: f64,
    /// Total at the start.
    pub initial: f64,
    /// Largest energy or work so far: the scale of the defect.
    pub largest: f64,
}

impl Ledger {
    /// Energy in the model.
    pub fn total(&self) -> f64 {
        self.kinetic.iter().chain(&self.strain).sum::<f64>() + self.hertz
    }

    /// Energy that no work or loss explains.
    pub fn defect(&self) -> f64 {
        let work = self.load_work + self.patch_work;
        self.total() - self.initial - work + self.contact_loss + self.rayleigh_loss
    }

    /// Notes the present energies as a candidate for the scale.
    pub fn note_scale(&mut self) {
        let works = [
            self.load_work,
            self.patch_work,
            self.contact_loss,
            self.rayleigh_loss,
        ];
        let largest = works.iter().fold(self.total().abs(), |m, w| m.max(w.abs()));
        self.largest = self.largest.max(largest);
    }

    /// Defect over the largest energy: positive is a gain that nothing explains, negative a loss.
    pub fn relative_defect(&self) -> f64 {
        if self.largest > 0.0 {
            self.defect() / self.largest
        } else {
            0.0
        }
    }
}
