//! Between the caller's Cartesian vectors and harmonic space.
//!
//! With the cylindrical components u_{s,a} of node a of sector s, at o_a = 0 or 1/2 sectors beyond the sector's plane,
//!
//! ```text
//! w_{k,a} = D^H sum over s of u_{s,a} exp(-2 pi i k (s + o_a) / N),    D = diag(1, i, 1),    k = 0..=N/2
//! ```
//! The phase of each node's own azimuth and the factor i of the azimuthal component make the harmonics of a section
//! that is its own mirror image real. Cost: one real FFT of length N per dof of the section.

use std::sync::Arc;

use fft::ComplexToReal;
use fft::num_complex::Complex;
use rayon::prelude::*;

use super::phases::LANES;
use super::ring::{ABSENT, CyclicRing};
use super::shared::AtPlaces;
use crate::permutation::invert;

/// Section nodes transformed as one task.
const TASK: usize = 4;

/// Nodes turned back to Cartesian components as one task.
const NODAL_TASK: usize = 4096;

/// One coefficient of a real Fourier transform.
pub(super) type Spectrum = Complex<f64>;

/// Some nodes of a section with their images in all sectors, such as those of the raceway.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SectionPart {
    /// Places in elimination order, ascending.
    pub(super) places: Vec<usize>,
    /// Of each place of the section its number among these, [`ELSEWHERE`] of others.
    pub(super) numbers: Vec<u32>,
}

/// Number of a place that is not of the part.
pub(super) const ELSEWHERE: u32 = u32::MAX;

impl CyclicRing {
    /// Harmonics of the nodal vector `nodal` (Cartesian, `[n]`) into `harmonic`, `[harmonic_len()]`.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn to_harmonic(&self, nodal: &[f64], harmonic: &mut [f64]) {
        let all: Vec<usize> = (0..self.n_section_nodes()).collect();
        self.transform_places(&all, nodal, harmonic);
    }

    /// The same of a vector that is zero but at the nodes of `part`, which alone are read.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn to_harmonic_from(&self, part: &SectionPart, nodal: &[f64], harmonic: &mut [f64]) {
        harmonic.fill(0.0);
        self.transform_places(&part.places, nodal, harmonic);
    }

    /// Overwrites the harmonics of the nodes at `places`.
    fn transform_places(&self, places: &[usize], nodal: &[f64], harmonic: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        assert_eq!(harmonic.len(), self.harmonic_len(), "a vector in harmonic space");
        let n_harmonics = self.shared.phases.n_harmonics();
        let mut spectra = vec![Spectrum::default(); 3 * places.len() * n_harmonics];
        if spectra.is_empty() {
            return;
        }
        spectra
            .par_chunks_mut(3 * TASK * n_harmonics)
            .zip(places.par_chunks(TASK))
            .for_each(|(spectra, places)| self.transform_nodes(places, nodal, spectra));
        self.collect(places, &spectra, harmonic);
    }

    /// Overwrites the harmonics of the nodes at `places` with their spectra, `[places][3][n_harmonics]`.
    pub(super) fn collect(&self, places: &[usize], spectra: &[Spectrum], harmonic: &mut [f64]) {
        assert_eq!(harmonic.len(), self.harmonic_len(), "a vector in harmonic space");
        let (n_harmonics, first) = (self.shared.phases.n_harmonics(), self.own_groups().start);
        harmonic
            .par_chunks_mut(self.group_len())
            .enumerate()
            .for_each(|(i, lanes)| collect_group(first + i, n_harmonics, (places, spectra), lanes));
    }

    /// Nodal vector (Cartesian, `[n]`) of the harmonics `harmonic`, `[harmonic_len()]`. Collective.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn from_harmonic(&self, harmonic: &[f64], nodal: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        let all: Vec<usize> = (0..self.n_section_nodes()).collect();
        let components = self.restore_places(&all, harmonic);
        let (shared, n, width) = (&self.shared, self.n_sectors(), self.n_section_nodes());
        nodal
            .par_chunks_mut(3 * NODAL_TASK)
            .enumerate()
            .for_each(|(task, nodal)| {
                let sites = &shared.sites[NODAL_TASK * task..];
                for (u, &site) in nodal.chunks_exact_mut(3).zip(sites) {
                    if site == ABSENT {
                        u.fill(0.0);
                        continue;
                    }
                    let ([c, s], sector, place) = (shared.directions[site], site / width, site % width);
                    let [r, t, z] = [0, 1, 2].map(|i| components[(3 * place + i) * n + sector]);
                    u.copy_from_slice(&[c * r - s * t, s * r + c * t, z]);
                }
            });
    }

    /// The same for the nodes of `part` alone; other nodes keep their values. Collective.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn from_harmonic_at(&self, part: &SectionPart, harmonic: &[f64], nodal: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        let components = self.restore_places(&part.places, harmonic);
        let (shared, n, width) = (&self.shared, self.n_sectors(), self.n_section_nodes());
        for (lines, &place) in components.chunks_exact(3 * n).zip(&part.places) {
            for sector in 0..n {
                let site = sector * width + place;
                let ([c, s], node) = (shared.directions[site], shared.nodes[site]);
                if node == ABSENT {
                    continue;
                }
                let [r, t, z] = [0, 1, 2].map(|i| lines[i * n + sector]);
                nodal[3 * node..3 * node + 3].copy_from_slice(&[c * r - s * t, s * r + c * t, z]);
            }
        }
    }

    /// The section nodes to which the caller's nodes `nodes` belong, ascending.
    ///
    /// # Panics
    /// When a node does not exist.
    pub fn section_nodes(&self, nodes: impl IntoIterator<Item = usize>) -> Vec<usize> {
        let mut section: Vec<usize> = nodes.into_iter().map(self.section_node()).collect();
        section.sort_unstable();
        section.dedup();
        section
    }

    /// The caller's nodes that belong to the section nodes `section`, ascending.
    pub fn nodes_of(&self, section: &[usize]) -> Vec<usize> {
        let mut is_chosen = vec![false; self.n_section_nodes()];
        section.iter().for_each(|&node| is_chosen[node] = true);
        let section_node = self.section_node();
        let nodes = 0..self.shared.sites.len();
        nodes.filter(|&node| is_chosen[section_node(node)]).collect()
    }

    /// The section node to which each of the caller's nodes belongs.
    fn section_node(&self) -> impl Fn(usize) -> usize {
        let shared = &self.shared;
        let places = invert(&shared.place, shared.place.len()).expect("every section node has a place");
        move |node| places[shared.sites[node] % self.n_section_nodes()]
    }

    /// The section nodes to which the caller's nodes `nodes` belong, and the section nodes `section_nodes`.
    ///
    /// # Panics
    /// When a node does not exist.
    pub fn section_part(
        &self,
        section_nodes: &[usize],
        nodes: impl IntoIterator<Item = usize>,
    ) -> SectionPart {
        let shared = &self.shared;
        let of_nodes = nodes
            .into_iter()
            .map(|n| shared.sites[n] % self.n_section_nodes());
        let mut places: Vec<usize> = section_nodes
            .iter()
            .map(|&n| shared.place[n])
            .chain(of_nodes)
            .collect();
        places.sort_unstable();
        places.dedup();
        let mut numbers = vec![ELSEWHERE; self.n_section_nodes()];
        for (i, &place) in places.iter().enumerate() {
            numbers[place] = i as u32;
        }
        SectionPart { places, numbers }
    }

    /// Cylindrical components of the nodes at `places`, `[places][3][n_sectors]`. Collective.
    pub(super) fn restore_places(&self, places: &[usize], harmonic: &[f64]) -> Vec<f64> {
        let n = self.n_sectors();
        let mut components = vec![0.0; 3 * n * places.len()];
        let all = self.at_places(places, harmonic);
        components
            .par_chunks_mut((3 * TASK * n).max(1))
            .zip(places.par_chunks(TASK))
            .enumerate()
            .for_each(|(task, (components, places))| {
                self.restore_nodes((TASK * task, places), &all, components);
            });
        components
    }

    /// One group's part of the nodal scalar product of two vectors in harmonic space (Parseval), of its part of them,
    /// `[low_len()]` each.
    pub fn group_dot(&self, group: usize, a: &[f64], b: &[f64]) -> f64 {
        let n = self.n_sectors();
        let mut sums = [0.0; LANES];
        for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
            (0..LANES).for_each(|lane| sums[lane] += a[lane] * b[lane]);
        }
        let once = |k: usize| k == 0 || 2 * k == n;
        let weighted = sums.iter().enumerate().map(|(lane, sum)| {
            // Harmonics stand for their conjugates as well; unused lanes are zero.
            if once(group * LANES + lane) {
                *sum
            } else {
                2.0 * sum
            }
        });
        weighted.sum::<f64>() / n as f64
    }

    /// Spectra of the nodes at `places`, `[places][3][n_harmonics]`.
    fn transform_nodes(&self, places: &[usize], nodal: &[f64], spectra: &mut [Spectrum]) {
        let shared = &self.shared;
        let (n, width) = (self.n_sectors(), self.n_section_nodes());
        let n_harmonics = shared.phases.n_harmonics();
        let mut lines = vec![0.0; 3 * n];
        for (spectra, &place) in spectra.chunks_exact_mut(3 * n_harmonics).zip(places) {
            for sector in 0..n {
                let site = sector * width + place;
                let [c, s] = shared.directions[site];
                let [x, y, z] = self.at_site(nodal, site);
                lines[sector] = c * x + s * y;
                lines[n + sector] = c * y - s * x;
                lines[2 * n + sector] = z;
            }
            self.line_spectra(place, &mut lines, spectra);
        }
    }

    /// Spectra of one node's cylindrical components round the ring, `[3][n_sectors]`, which are overwritten.
    pub(super) fn line_spectra(&self, place: usize, lines: &mut [f64], spectra: &mut [Spectrum]) {
        let shared = &self.shared;
        let mut scratch = shared.forward.make_scratch_vec();
        for (component, (line, spectrum)) in lines
            .chunks_exact_mut(self.n_sectors())
            .zip(spectra.chunks_exact_mut(shared.phases.n_harmonics()))
            .enumerate()
        {
            shared
                .forward
                .process_with_scratch(line, spectrum, &mut scratch)
                .expect("the lengths are those of the plan");
            let turn = |(k, value): (usize, &mut Spectrum)| {
                let turned = self.shifted(*value, k, -shared.halves[place]);
                *value = if component == 1 {
                    Complex::new(turned.im, -turned.re)
                } else {
                    turned
                };
            };
            spectrum.iter_mut().enumerate().for_each(turn);
        }
    }

    /// The amplitude of harmonic k where the angle begins `halves` half sectors further on.
    fn shifted(&self, amplitude: Spectrum, k: usize, halves: i32) -> Spectrum {
        // Nodes in the plane of the sector need no turn.
        if halves == 0 {
            return amplitude;
        }
        let [cos, sin] = self.shared.phases.of(k, halves);
        amplitude * Complex::new(cos, sin)
    }

    /// Cylindrical components of the nodes at `places`, `[places][3][n_sectors]`, of which the first one is the `first`
    /// of those whose harmonics are known.
    fn restore_nodes(&self, (first, places): (usize, &[usize]), all: &AtPlaces<'_>, components: &mut [f64]) {
        let shared = &self.shared;
        let n = self.n_sectors();
        let mut spectrum = shared.inverse.make_input_vec();
        let mut scratch = shared.inverse.make_scratch_vec();
        for (i, line) in components.chunks_exact_mut(n).enumerate() {
            let (place, component) = (places[i / 3], i % 3);
            for (k, value) in spectrum.iter_mut().enumerate() {
                let w = all.harmonic(k, (first + i / 3, place), component);
                let w = if component == 1 {
                    Complex::new(-w.im, w.re)
                } else {
                    w
                };
                *value = self.shifted(w, k, shared.halves[place]) / n as f64;
            }
            restore_line(&shared.inverse, &mut spectrum, line, &mut scratch);
        }
    }
}

/// The values round the ring, `[n_sectors]`, of a spectrum, which is overwritten.
pub(super) fn restore_line(
    inverse: &Arc<dyn ComplexToReal<f64>>,
    spectrum: &mut [Spectrum],
    line: &mut [f64],
    scratch: &mut [Spectrum],
) {
    // The harmonics that are their own conjugates are real but for rounding.
    spectrum[0].im = 0.0;
    if line.len().is_multiple_of(2) {
        spectrum[line.len() / 2].im = 0.0;
    }
    inverse
        .process_with_scratch(spectrum, line, scratch)
        .expect("the lengths are those of the plan");
}

/// Writes the harmonics of the nodes at `places` into a group's part of a vector, `[n_section_nodes][3][2][LANES]`,
/// from their spectra.
pub(super) fn collect_group(
    group: usize,
    n_harmonics: usize,
    (places, spectra): (&[usize], &[Spectrum]),
    lanes: &mut [f64],
) {
    let first = group * LANES;
    let last = n_harmonics.min(first + LANES);
    for (spectra, &place) in spectra.chunks_exact(3 * n_harmonics).zip(places) {
        let node = &mut lanes[6 * LANES * place..][..6 * LANES];
        for (spectrum, parts) in spectra
            .chunks_exact(n_harmonics)
            .zip(node.chunks_exact_mut(2 * LANES))
        {
            parts.fill(0.0);
            for (lane, value) in spectrum[first..last].iter().enumerate() {
                parts[lane] = value.re;
                parts[LANES + lane] = value.im;
            }
        }
    }
}
