//! Between the caller's Cartesian vectors and harmonic space.
//!
//! With the cylindrical components u_{s,a} of node a of sector s, at o_a = 0 or 1/2 sectors beyond the sector's plane,
//!
//! ```text
//! w_{k,a} = D^H sum over s of u_{s,a} exp(-2 pi i k (s + o_a) / N),    D = diag(1, i, 1),    k = 0..=N/2
//! ```
//! The phase of each node's own azimuth and the factor i of the azimuthal component make the harmonics of a section that
//! is its own mirror image real. Cost: one real FFT of length N per dof of the section.

use std::sync::Arc;

use rayon::prelude::*;
use realfft::ComplexToReal;
use realfft::num_complex::Complex;

use super::phases::LANES;
use super::ring::CyclicRing;

/// Section nodes transformed as one task.
const TASK: usize = 4;

/// Nodes turned back to Cartesian components as one task.
const NODAL_TASK: usize = 4096;

/// One coefficient of a real Fourier transform.
pub(super) type Spectrum = Complex<f64>;

impl CyclicRing {
    /// Harmonics of the nodal vector `nodal` (Cartesian, `[n]`) into `harmonic`, `[harmonic_len()]`.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn to_harmonic(&self, nodal: &[f64], harmonic: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        assert_eq!(harmonic.len(), self.harmonic_len(), "a vector in harmonic space");
        let n_harmonics = self.shared.phases.n_harmonics();
        let mut spectra = vec![Spectrum::default(); 3 * self.n_section_nodes() * n_harmonics];
        if spectra.is_empty() {
            return;
        }
        spectra
            .par_chunks_mut(3 * TASK * n_harmonics)
            .enumerate()
            .for_each(|(task, spectra)| self.transform_nodes(TASK * task, nodal, spectra));
        harmonic
            .par_chunks_mut(self.group_len())
            .enumerate()
            .for_each(|(group, lanes)| collect_group(group, n_harmonics, &spectra, lanes));
    }

    /// Nodal vector (Cartesian, `[n]`) of the harmonics `harmonic`, `[harmonic_len()]`.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn from_harmonic(&self, harmonic: &[f64], nodal: &mut [f64]) {
        assert_eq!(nodal.len(), self.n(), "three components per node");
        assert_eq!(harmonic.len(), self.harmonic_len(), "a vector in harmonic space");
        let (n, width) = (self.n_sectors(), self.n_section_nodes());
        let mut components = vec![0.0; 3 * n * width];
        components
            .par_chunks_mut(3 * TASK * n)
            .enumerate()
            .for_each(|(task, components)| self.restore_nodes(TASK * task, harmonic, components));
        let shared = &self.shared;
        nodal
            .par_chunks_mut(3 * NODAL_TASK)
            .enumerate()
            .for_each(|(task, nodal)| {
                let sites = &shared.sites[NODAL_TASK * task..];
                for (u, &site) in nodal.chunks_exact_mut(3).zip(sites) {
                    let ([c, s], sector, place) = (shared.directions[site], site / width, site % width);
                    let [r, t, z] = [0, 1, 2].map(|i| components[(3 * place + i) * n + sector]);
                    u.copy_from_slice(&[c * r - s * t, s * r + c * t, z]);
                }
            });
    }

    /// The nodal scalar product of two vectors in harmonic space (Parseval), in a fixed order.
    ///
    /// # Panics
    /// When the lengths are others.
    pub fn harmonic_dot(&self, a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), self.harmonic_len(), "a vector in harmonic space");
        assert_eq!(b.len(), self.harmonic_len(), "a vector in harmonic space");
        let len = self.group_len().max(1);
        let groups = a.chunks_exact(len).zip(b.chunks_exact(len));
        groups
            .enumerate()
            .map(|(group, (a, b))| self.group_dot(group, a, b))
            .sum()
    }

    /// One group's part of the scalar product, of its part of two vectors.
    pub(super) fn group_dot(&self, group: usize, a: &[f64], b: &[f64]) -> f64 {
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

    /// Spectra of the nodes from place `first` on, `[nodes][3][n_harmonics]`.
    fn transform_nodes(&self, first: usize, nodal: &[f64], spectra: &mut [Spectrum]) {
        let shared = &self.shared;
        let (n, width) = (self.n_sectors(), self.n_section_nodes());
        let n_harmonics = shared.phases.n_harmonics();
        let mut lines = vec![0.0; 3 * n];
        let mut scratch = shared.forward.make_scratch_vec();
        for (i, spectra) in spectra.chunks_exact_mut(3 * n_harmonics).enumerate() {
            let place = first + i;
            for sector in 0..n {
                let site = sector * width + place;
                let node = shared.nodes[site];
                let [c, s] = shared.directions[site];
                let [x, y, z] = [0, 1, 2].map(|j| nodal[3 * node + j]);
                lines[sector] = c * x + s * y;
                lines[n + sector] = c * y - s * x;
                lines[2 * n + sector] = z;
            }
            for (component, (line, spectrum)) in lines
                .chunks_exact_mut(n)
                .zip(spectra.chunks_exact_mut(n_harmonics))
                .enumerate()
            {
                shared
                    .forward
                    .process_with_scratch(line, spectrum, &mut scratch)
                    .expect("the lengths are those of the plan");
                let turn = |(k, value): (usize, &mut Spectrum)| {
                    let [cos, sin] = shared.phases.of(k, -shared.halves[place]);
                    let turned = *value * Complex::new(cos, sin);
                    *value = if component == 1 {
                        Complex::new(turned.im, -turned.re)
                    } else {
                        turned
                    };
                };
                spectrum.iter_mut().enumerate().for_each(turn);
            }
        }
    }

    /// Cylindrical components of the nodes from place `first` on, `[nodes][3][n_sectors]`.
    fn restore_nodes(&self, first: usize, harmonic: &[f64], components: &mut [f64]) {
        let shared = &self.shared;
        let n = self.n_sectors();
        let mut spectrum = shared.inverse.make_input_vec();
        let mut scratch = shared.inverse.make_scratch_vec();
        for (i, line) in components.chunks_exact_mut(n).enumerate() {
            let (place, component) = (first + i / 3, i % 3);
            for (k, value) in spectrum.iter_mut().enumerate() {
                let start = (k / LANES) * self.group_len() + 2 * LANES * (3 * place + component) + k % LANES;
                let w = Complex::new(harmonic[start], harmonic[start + LANES]);
                let w = if component == 1 {
                    Complex::new(-w.im, w.re)
                } else {
                    w
                };
                let [cos, sin] = shared.phases.of(k, shared.halves[place]);
                *value = w * Complex::new(cos, sin) / n as f64;
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

/// A group's part of a harmonic vector, `[n_section_nodes][3][2][LANES]`, from the spectra of all dofs of the section.
fn collect_group(group: usize, n_harmonics: usize, spectra: &[Spectrum], lanes: &mut [f64]) {
    let first = group * LANES;
    let last = n_harmonics.min(first + LANES);
    for (spectrum, parts) in spectra
        .chunks_exact(n_harmonics)
        .zip(lanes.chunks_exact_mut(2 * LANES))
    {
        parts.fill(0.0);
        for (lane, value) in spectrum[first..last].iter().enumerate() {
            parts[lane] = value.re;
            parts[LANES + lane] = value.im;
        }
    }
}
