//! Stress of balls and raceways below their contacts, by Hertz: what `summary.json` says of it.
//!
//! It is proportional to the peak pressure, and depths to the ellipse, whose shape does not depend on the load: so
//! the ratios hold for all contacts of a side at every step, and the values are those of the most loaded contact of
//! the last one.

use contact::halfspace::{Extreme, subsurface};
use contact::{SemiAxes, Side};
use dynamics::Model;
use dynamics::balls::BallResult;
use scene::Materials;
use serde::Serialize;

/// The contacts of one side.
#[derive(Debug, Serialize)]
pub struct ContactSubsurface {
    /// The most loaded ball, from 0.
    most_loaded_ball: usize,
    /// Its peak pressure, Pa.
    peak_pressure_pa: f64,
    /// Semi-axes of its ellipse, m.
    semi_axes_m: SemiAxes,
    /// Below the surface of the ball.
    ball: BodySubsurface,
    /// Below the raceway.
    ring: BodySubsurface,
}

/// Largest stresses below one surface.
#[derive(Debug, Serialize)]
struct BodySubsurface {
    maximum_shear: Largest,
    von_mises: Largest,
    /// Amplitude of the orthogonal shear stress as the contact rolls by: half its range.
    orthogonal_shear: Largest,
}

/// A largest stress and where it is.
#[derive(Debug, Serialize)]
struct Largest {
    stress_pa: f64,
    depth_m: f64,
    over_peak_pressure: f64,
    depth_over_minor_semi_axis: f64,
}

/// The contacts of the inner and the outer side.
pub fn contacts(model: &Model, materials: &Materials, balls: &[BallResult]) -> [ContactSubsurface; 2] {
    Side::BOTH.map(|side| {
        let forces = balls.iter().map(|ball| ball.contact(side).force_n).enumerate();
        let (most_loaded_ball, _) =
            forces.fold((0, 0.0), |most, (i, f)| if f > most.1 { (i, f) } else { most });
        let contact = balls[most_loaded_ball].contact(side);
        // The shape of the ellipse does not depend on the force.
        let shape = model.hertz[side.index()].semi_axes(1.0);
        let body = |poisson_ratio: f64| {
            let found = subsurface(shape, poisson_ratio);
            let largest = |extreme: Extreme| Largest {
                stress_pa: extreme.over_peak_pressure * contact.peak_pressure_pa,
                depth_m: extreme.depth_over_minor_axis * contact.semi_axes_m.minor(),
                over_peak_pressure: extreme.over_peak_pressure,
                depth_over_minor_semi_axis: extreme.depth_over_minor_axis,
            };
            BodySubsurface {
                maximum_shear: largest(found.maximum_shear),
                von_mises: largest(found.von_mises),
                orthogonal_shear: largest(found.orthogonal_shear),
            }
        };
        ContactSubsurface {
            most_loaded_ball,
            peak_pressure_pa: contact.peak_pressure_pa,
            semi_axes_m: contact.semi_axes_m,
            ball: body(materials.balls.poisson_ratio),
            ring: body(materials.rings.poisson_ratio),
        }
    })
}
