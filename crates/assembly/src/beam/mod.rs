//! A shaft of Timoshenko beam elements: diameters along z, own mass, rotary inertia and gyroscopic moments.
//!
//! Each node has x, y, z and the tilts about x and y; torsion is left out. Sections lie end to end. There is a node at
//! every end of a section, bearing, load and mass, and between them so many that no element is longer than asked.
//!
//! At rest the elements are exact at their nodes: their shape functions solve the beam under end loads. In vibration
//! the error of a frequency falls with the fourth power of the length of the elements while shear is small. Shear is
//! constant in an element, which leaves a smaller error of second order.
//!
//! References: Przemieniecki, Theory of Matrix Structural Analysis (1968), ch. 5 and 11; Nelson, A finite rotating
//! shaft element using Timoshenko beam theory, J. Mech. Des. 102 (1980) 793; Cowper, J. Appl. Mech. 33 (1966) 335, eq.
//! 37 (shear coefficient of a hollow circle).

mod element;
mod section;

pub use element::{BeamElement, N_ELEMENT};
pub use section::BeamSection;

use fem::Material;

use crate::error::AssemblyError;

/// Gap or overlap of sections, and distance of stations, that is taken for round-off, over the length of the shaft.
const SAME_PLACE: f64 = 1e-9;

/// A mass on the shaft at one place, such as a disc.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointMass {
    /// Position along the shaft, m.
    pub position: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about x and y through its centre, kg m^2.
    pub transverse: f64,
    /// Moment of inertia about z, kg m^2.
    pub polar: f64,
}

/// Sections, material and fineness of a shaft.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamShaft {
    /// Sections from the lowest z to the highest, end to end.
    pub sections: Vec<BeamSection>,
    /// Steel of the shaft.
    pub material: Material,
    /// Longest element, m.
    pub longest_element: f64,
}

impl BeamShaft {
    /// Ends of the shaft, m.
    pub fn ends(&self) -> [f64; 2] {
        let first = self.sections.first().map_or(0.0, |s| s.from);
        let last = self.sections.last().map_or(0.0, |s| s.to);
        [first, last]
    }

    /// Checks that the sections make a shaft.
    pub fn check(&self) -> Result<(), AssemblyError> {
        let fail = |problem: String| Err(AssemblyError::ShaftBody { problem });
        let [first, last] = self.ends();
        let near = SAME_PLACE * (last - first).abs();
        if self.sections.is_empty() || self.longest_element.is_nan() || self.longest_element <= 0.0 {
            return fail(
                "the beam shaft has no sections or elements without length; expected one section at least"
                    .to_string(),
            );
        }
        for (number, section) in self.sections.iter().enumerate() {
            if !(section.to > section.from && section.outside > section.bore && section.bore >= 0.0) {
                return fail(format!(
                    "section {number} of the beam shaft is no hollow cylinder; expected from < to and 0 <= bore < \
                     outside"
                ));
            }
        }
        let pairs = self.sections.windows(2).enumerate();
        for (number, pair) in pairs {
            let gap = pair[1].from - pair[0].to;
            if gap.abs() > near {
                return fail(format!(
                    "sections {number} and {} of the beam shaft do not meet: {:.6} mm lie between them; expected ends \
                     that meet",
                    number + 1,
                    1e3 * gap
                ));
            }
        }
        Ok(())
    }

    /// Nodes along the shaft, m, in order: section ends, stations, and places between them.
    pub fn nodes(&self, stations: &[f64]) -> Result<Vec<f64>, AssemblyError> {
        self.check()?;
        let [first, last] = self.ends();
        let near = SAME_PLACE * (last - first);
        let mut fixed: Vec<f64> = self.sections.iter().map(|s| s.from).chain([last]).collect();
        for &station in stations {
            if station < first - near || station > last + near {
                return Err(AssemblyError::ShaftBody {
                    problem: format!(
                        "the position {:.6} mm is off the shaft; expected {:.6} to {:.6} mm, where its sections are",
                        1e3 * station,
                        1e3 * first,
                        1e3 * last
                    ),
                });
            }
            fixed.push(station.clamp(first, last));
        }
        fixed.sort_by(f64::total_cmp);
        fixed.dedup_by(|b, a| (*b - *a).abs() <= near);
        let mut nodes = vec![fixed[0]];
        for pair in fixed.windows(2) {
            let n = ((pair[1] - pair[0]) / self.longest_element * (1.0 - 1e-12))
                .ceil()
                .max(1.0) as usize;
            let step = (pair[1] - pair[0]) / n as f64;
            nodes.extend((1..n).map(|i| pair[0] + i as f64 * step));
            nodes.push(pair[1]);
        }
        Ok(nodes)
    }

    /// The elements between nodes.
    pub fn elements(&self, nodes: &[f64]) -> Vec<BeamElement> {
        let element = |pair: &[f64]| {
            let middle = 0.5 * (pair[0] + pair[1]);
            let section = self.sections.iter().find(|s| middle < s.to);
            let section = section.unwrap_or(&self.sections[self.sections.len() - 1]);
            BeamElement::new(section, &self.material, pair[1] - pair[0])
        };
        nodes.windows(2).map(element).collect()
    }
}
