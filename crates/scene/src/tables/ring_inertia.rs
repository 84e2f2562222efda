//! `inner.inertia = "section"`: a rigid inner ring has the mass and the moments of inertia of its section.
//!
//! The section of `[inner.section]` revolved about the axis, of the density of `[materials.rings]`, in closed form
//! ([`mesh::VolumeMoments`]). They are added to those of the shaft, about the axis point in the plane of the groove
//! centres. There the centre of mass of a rigid shaft lies as well: that of a ring whose shoulders differ is beside it
//! by some s. What a motion then lacks is the moment m s x'' of a tilt and the force m s t'' of its rotation, which
//! change a squared frequency by about s^2/k^2, k the radius of gyration. Above [`MAX_SHARE`] it is refused.

use input::Problems;
use mesh::RingSection;
use serde::Deserialize;

/// Where the inertia of a rigid ring comes from.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum InertiaSource {
    /// From its section and density.
    Section,
}

/// Mass and moments of inertia of a rigid ring about the axis point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingInertia {
    /// Mass, kg.
    pub mass: f64,
    /// About x and y, kg m^2.
    pub transverse: f64,
    /// About z, kg m^2.
    pub polar: f64,
}

/// Square of the distance of the centre of mass over the radius of gyration, up to which it is taken as zero: half of
/// it is the share of a natural frequency.
const MAX_SHARE: f64 = 1e-3;

/// What is said of an outer ring that asks for it.
pub const OF_OUTER: &str = "outer.inertia is there, but the outer ring does not move with the shaft; remove it, or \
                            give the mass of a ring that slides in its seat as effects.spring_preload.mass";
/// What is said where no section is described.
pub const NO_SECTION: &str = "inner.inertia is \"section\", but there is no table [inner.section]; describe the \
                              section, or give shaft.mass, shaft.transverse_inertia and shaft.polar_inertia instead";

/// Inertia of a rigid inner ring of these measures and a density, kg/m^3.
pub fn of_section(
    section: &RingSection,
    density: f64,
    problems: &mut Problems,
    assumed: &mut Vec<String>,
) -> Option<RingInertia> {
    // Measures that make no ring are problems of the section or of the bearing.
    let moments = section.moments().ok()?;
    let inertia = RingInertia {
        mass: density * moments.volume,
        transverse: density * moments.transverse(),
        polar: density * moments.polar,
    };
    let centre = moments.axial / moments.volume;
    let share = centre * centre * inertia.mass / inertia.transverse;
    if share > MAX_SHARE {
        problems.add(format!(
            "inner.inertia is \"section\", but the centre of mass of that ring is {:.3} mm beside the plane of the \
             groove centres, where a rigid shaft has its own; expected at most {:.3} mm: set inner.flexible = true, or \
             give shaft.mass, shaft.transverse_inertia and shaft.polar_inertia instead",
            1e3 * centre,
            1e3 * (MAX_SHARE * inertia.transverse / inertia.mass).sqrt()
        ));
        return None;
    }
    assumed.push(format!(
        "the rigid inner ring has {:.4} kg, {:.4e} kg m2 across the axis and {:.4e} kg m2 about it, of its section; \
         the shaft's are added",
        inertia.mass, inertia.transverse, inertia.polar
    ));
    Some(inertia)
}
