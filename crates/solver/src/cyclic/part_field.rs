//! Loads and displacements of all nodes of a few section nodes, such as those of the raceway, without a vector of the
//! whole ring.
//!
//! Cost: three FFTs of length N per section node that is asked for or loaded; memory
//! `[n_section_nodes of the part][3][N]`.

use rayon::prelude::*;

use super::ring::CyclicRing;
use super::transform::{ELSEWHERE, SectionPart, Spectrum, collect_group};

/// A field on the nodes of a part of the section, in cylindrical components.
pub struct PartField<'a> {
    ring: &'a CyclicRing,
    part: &'a SectionPart,
    /// Of each place of the part its number in `components`, [`UNKNOWN`] where the field is not known.
    slots: Vec<usize>,
    /// `[slots][3][n_sectors]`.
    components: Vec<f64>,
}

/// Loads on the nodes of a part of the section, in cylindrical components.
pub struct PartLoads<'a> {
    ring: &'a CyclicRing,
    part: &'a SectionPart,
    /// `[places][3][n_sectors]`.
    components: Vec<f64>,
    /// Whether there are loads, by place.
    loaded: Vec<bool>,
    /// The node that was loaded last, and its site.
    last: Option<(usize, RadialSite)>,
}

/// Where a node's radial component is, and its direction (cos, sin); other components follow at a distance of N.
type RadialSite = (usize, [f64; 2]);

/// Slot of a place at which a field is not known.
const UNKNOWN: usize = usize::MAX;

/// Harmonics of a field that is zero but on the nodes of a part of the section.
pub struct PartHarmonics<'a> {
    ring: &'a CyclicRing,
    part: &'a SectionPart,
    /// `[places][3][n_harmonics]`.
    spectra: Vec<Spectrum>,
}

impl CyclicRing {
    /// The field `harmonic`, `[harmonic_len()]`, at the nodes of `part`. Collective.
    ///
    /// # Panics
    /// When the length is another.
    pub fn field_at<'a>(&'a self, part: &'a SectionPart, harmonic: &[f64]) -> PartField<'a> {
        let components = self.restore_places(&part.places, harmonic);
        PartField {
            ring: self,
            part,
            slots: (0..part.places.len()).collect(),
            components,
        }
    }

    /// The same at those section nodes of `part` alone to which the caller's nodes `nodes` belong.
    ///
    /// # Panics
    /// When the length is another, or a node is not of the part.
    pub fn field_at_nodes<'a>(
        &'a self,
        part: &'a SectionPart,
        nodes: impl IntoIterator<Item = usize>,
        harmonic: &[f64],
    ) -> PartField<'a> {
        let mut slots = vec![UNKNOWN; part.places.len()];
        let mut last = None;
        for node in nodes {
            // Rows of a node follow each other.
            if last != Some(node) {
                slots[part.number(self, node).0] = 0;
                last = Some(node);
            }
        }
        let known = slots.iter_mut().zip(&part.places).filter(|(s, _)| **s != UNKNOWN);
        let (slot, places): (Vec<_>, Vec<_>) = known.unzip();
        slot.into_iter().enumerate().for_each(|(i, slot)| *slot = i);
        PartField {
            components: self.restore_places(&places, harmonic),
            ring: self,
            part,
            slots,
        }
    }

    /// No loads on the nodes of `part`.
    pub fn no_loads<'a>(&'a self, part: &'a SectionPart) -> PartLoads<'a> {
        PartLoads {
            ring: self,
            part,
            components: vec![0.0; 3 * self.n_sectors() * part.places.len()],
            loaded: vec![false; part.places.len()],
            last: None,
        }
    }
}

impl SectionPart {
    /// Number among its places of that of a node, and the node's sector.
    fn number(&self, ring: &CyclicRing, node: usize) -> (usize, usize) {
        let (site, width) = (ring.shared.sites[node], ring.n_section_nodes());
        let number = self.numbers[site % width];
        assert_ne!(number, ELSEWHERE, "node {node} is not of the part");
        (number as usize, site / width)
    }
}

impl PartField<'_> {
    fn site(&self, node: usize) -> RadialSite {
        let (number, sector) = self.part.number(self.ring, node);
        let slot = self.slots[number];
        assert_ne!(slot, UNKNOWN, "the field is not known at node {node}");
        (
            3 * slot * self.ring.n_sectors() + sector,
            direction(self.ring, node),
        )
    }

    /// Value at one of the caller's nodes (Cartesian).
    ///
    /// # Panics
    /// When it is not of the part, or the field is not known there.
    pub fn vector(&self, node: usize) -> [f64; 3] {
        let (first, [c, s]) = self.site(node);
        let [r, t, z] = [0, 1, 2].map(|i| self.components[first + i * self.ring.n_sectors()]);
        [c * r - s * t, s * r + c * t, z]
    }

    /// Value at one of the caller's rows (Cartesian).
    ///
    /// # Panics
    /// When its node is not of the part, or the field is not known there.
    pub fn value(&self, row: usize) -> f64 {
        self.vector(row / 3)[row % 3]
    }

    /// Value of a functional on the caller's rows (Cartesian); fastest when the rows of a node follow each other.
    ///
    /// # Panics
    /// When a node is not of the part, or the field is not known there.
    pub fn measure(&self, functional: impl IntoIterator<Item = (usize, f64)>) -> f64 {
        let (mut sum, mut last) = (0.0, None);
        for (row, weight) in functional {
            let (node, component) = (row / 3, row % 3);
            let vector = match last {
                Some((known, vector)) if known == node => vector,
                _ => self.vector(node),
            };
            last = Some((node, vector));
            sum += weight * vector[component];
        }
        sum
    }
}

impl<'a> PartLoads<'a> {
    /// Adds `value` at one of the caller's rows (Cartesian).
    ///
    /// # Panics
    /// When its node is not of the part.
    pub fn add(&mut self, row: usize, value: f64) {
        let n = self.ring.n_sectors();
        let (first, [c, s]) = match self.last {
            Some((node, site)) if node == row / 3 => site,
            _ => {
                let (number, sector) = self.part.number(self.ring, row / 3);
                self.loaded[number] = true;
                (3 * number * n + sector, direction(self.ring, row / 3))
            }
        };
        self.last = Some((row / 3, (first, [c, s])));
        match row % 3 {
            0 => {
                self.components[first] += c * value;
                self.components[first + n] -= s * value;
            }
            1 => {
                self.components[first] += s * value;
                self.components[first + n] += c * value;
            }
            _ => self.components[first + 2 * n] += value,
        }
    }

    /// Writes their harmonics into `harmonic`, `[harmonic_len()]`; those of other nodes keep their values.
    ///
    /// # Panics
    /// When the length is another.
    pub fn write_harmonics(self, harmonic: &mut [f64]) {
        self.into_harmonics().write(harmonic);
    }

    /// Their harmonics; section nodes without loads are not transformed.
    pub fn into_harmonics(mut self) -> PartHarmonics<'a> {
        let (ring, places) = (self.ring, &self.part.places);
        let (n, n_harmonics) = (ring.n_sectors(), ring.shared.phases.n_harmonics());
        let mut spectra = vec![Spectrum::default(); 3 * places.len() * n_harmonics];
        self.components
            .par_chunks_mut((3 * n).max(1))
            .zip(spectra.par_chunks_mut(3 * n_harmonics))
            .zip(places)
            .zip(&self.loaded)
            .filter(|(_, loaded)| **loaded)
            .for_each(|(((lines, spectra), &place), _)| ring.line_spectra(place, lines, spectra));
        PartHarmonics {
            ring,
            part: self.part,
            spectra,
        }
    }
}

/// (cos, sin) of the azimuth of a node.
fn direction(ring: &CyclicRing, node: usize) -> [f64; 2] {
    ring.shared.directions[ring.shared.sites[node]]
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
