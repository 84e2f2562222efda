//! Loads and displacements of all nodes of a few section nodes, such as those of the raceway, without a vector of the whole ring.
//!
//! Cost: three FFTs of length N per section node; memory `[n_section_nodes of the part][3][N]`.

use rayon::prelude::*;

use super::ring::CyclicRing;
use super::transform::{SectionPart, Spectrum, collect_group};

/// A field on the nodes of a part of the section, in cylindrical components.
pub struct PartField<'a> {
    ring: &'a CyclicRing,
    part: &'a SectionPart,
    /// `[places][3][n_sectors]`.
    components: Vec<f64>,
}

/// Harmonics of a field that is zero but on the nodes of a part of the section.
pub struct PartHarmonics<'a> {
    ring: &'a CyclicRing,
    part: &'a SectionPart,
    /// `[places][3][n_harmonics]`.
    spectra: Vec<Spectrum>,
}

impl CyclicRing {
    /// The field `harmonic`, `[harmonic_len()]`, at the nodes of `part`.
    ///
    /// # Panics
    /// When the length is another.
    pub fn field_at<'a>(&'a self, part: &'a SectionPart, harmonic: &[f64]) -> PartField<'a> {
        PartField {
            components: self.restore_places(&part.places, harmonic),
            ring: self,
            part,
        }
    }

    /// No loads on the nodes of `part`.
    pub fn no_loads<'a>(&'a self, part: &'a SectionPart) -> PartField<'a> {
        PartField {
            components: vec![0.0; 3 * self.n_sectors() * part.places.len()],
            ring: self,
            part,
        }
    }
}

impl<'a> PartField<'a> {
    /// Where a node's radial component is, and its direction (cos, sin); other components follow at a distance of N.
    fn site(&self, node: usize) -> (usize, [f64; 2]) {
        let shared = &self.ring.shared;
        let (site, width) = (shared.sites[node], self.ring.n_section_nodes());
        let place = self.part.places.binary_search(&(site % width));
        let place = place.unwrap_or_else(|_| panic!("node {node} is not of the part"));
        (
            3 * place * self.ring.n_sectors() + site / width,
            shared.directions[site],
        )
    }

    /// Value at one of the caller's rows (Cartesian).
    ///
    /// # Panics
    /// When its node is not of the part.
    pub fn value(&self, row: usize) -> f64 {
        let (first, [c, s]) = self.site(row / 3);
        let at = |component: usize| self.components[first + component * self.ring.n_sectors()];
        match row % 3 {
            0 => c * at(0) - s * at(1),
            1 => s * at(0) + c * at(1),
            _ => at(2),
        }
    }

    /// Adds `value` at one of the caller's rows (Cartesian).
    ///
    /// # Panics
    /// When its node is not of the part.
    pub fn add(&mut self, row: usize, value: f64) {
        let (first, [c, s]) = self.site(row / 3);
        let shares = match row % 3 {
            0 => [c, -s, 0.0],
            1 => [s, c, 0.0],
            _ => [0.0, 0.0, 1.0],
        };
        for (component, share) in shares.into_iter().enumerate() {
            self.components[first + component * self.ring.n_sectors()] += share * value;
        }
    }

    /// Writes the field's harmonics into `harmonic`, `[harmonic_len()]`; those of other nodes keep their values.
    ///
    /// # Panics
    /// When the length is another.
    pub fn write_harmonics(self, harmonic: &mut [f64]) {
        self.into_harmonics().write(harmonic);
    }

    /// The field's harmonics.
    pub fn into_harmonics(mut self) -> PartHarmonics<'a> {
        let (ring, places) = (self.ring, &self.part.places);
        let (n, n_harmonics) = (ring.n_sectors(), ring.shared.phases.n_harmonics());
        let mut spectra = vec![Spectrum::default(); 3 * places.len() * n_harmonics];
        self.components
            .par_chunks_mut((3 * n).max(1))
            .zip(spectra.par_chunks_mut(3 * n_harmonics))
            .zip(places)
            .for_each(|((lines, spectra), &place)| ring.line_spectra(place, lines, spectra));
        PartHarmonics {
            ring,
            part: self.part,
            spectra,
        }
    }
}

impl PartHarmonics<'_> {
    /// Writes them into `harmonic`, `[harmonic_len()]`; those of other nodes keep their values.
    ///
    /// # Panics
    /// When the length is another.
    pub fn write(&self, harmonic: &mut [f64]) {
        if !self.spectra.is_empty() {
            self.ring.collect(&self.part.places, &self.spectra, harmonic);
        }
    }

    /// Writes those of one group into its part of a vector, `[low_len()]`; those of other nodes keep their values.
    pub fn write_group(&self, group: usize, part: &mut [f64]) {
        let n_harmonics = self.ring.shared.phases.n_harmonics();
        collect_group(group, n_harmonics, (&self.part.places, &self.spectra), part);
    }
}
