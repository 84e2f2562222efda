//! Static equilibrium of bodies and contacts as they are: the minimum of the energy.
//!
//! The elastic energy of the rings is a positive quadratic form and that of the contacts convex. So the total energy is
//! convex, but for finite motions of the shaft, and its minimum is the equilibrium. Newton's steps are
//! capped: any start is safe. Cost: a dense factorisation of 2 n_balls (1 + rings) + 5 unknowns per iteration.

use contact::{BearingGeometry, Meridian, Side};
use timer::SharedLaps;

use crate::bearing::{BearingParts, SHAFT};
use crate::bodies::AXES;
use crate::condensation::Condensation;
use crate::displacements::Displacements;
use crate::error::DynamicsError;
use crate::model::MAX_TILT;
use crate::system::newton::{Policy, RoundOff, Shortening};
use crate::system::tangent::scale_tangent;

/// Largest residual over the force scale at which Newton may stop; it goes on to round-off while it improves.
const RESIDUAL_LIMIT: f64 = 1e-10;
/// Newton iterations before giving up. Preloaded bearings need 6 to 40. Loose ones need up to some hundred: a ball that
/// comes off leaves its last raceway by a factor 3 in approach per iteration, and every ball that is met on the way
/// takes its turn.
const MOST_ITERATIONS: usize = 2000;
/// Proximal stiffness over the contact stiffness scale.
const PROXIMAL: f64 = 1e-9;

/// Limits and scales of the search.
#[derive(Clone, Copy, Debug)]
pub struct SearchScales {
    /// Largest change of a displacement in one iteration, m.
    pub step: f64,
    /// Shaft displacement beyond which there is no equilibrium, m.
    pub range: f64,
    /// Stiffness of a typical contact, N/m.
    pub stiffness: f64,
    /// Length by which tilts are scaled, m.
    pub tilt_arm: f64,
}

impl SearchScales {
    /// Scales of a bearing with contact stiffness K (N/m^1.5): a contact pressed by a hundredth of the groove
    /// distance is typical, a quarter of it a long step.
    pub fn new(geometry: &BearingGeometry, hertz_stiffness: f64) -> SearchScales {
        let distance = geometry.groove_distance();
        SearchScales {
            step: 0.25 * distance,
            range: 0.5 * geometry.ball_diameter,
            stiffness: 1.5 * hertz_stiffness * (0.01 * distance).sqrt(),
            tilt_arm: geometry.centre_radius(Side::Inner),
        }
    }

    /// Length per unknown: tilts count by their arm.
    fn of_unknowns(&self, parts: &BearingParts) -> Vec<f64> {
        let mut scales: Vec<f64> = parts
            .shaft
            .free()
            .map(|dof| if dof < 3 { 1.0 } else { 1.0 / self.tilt_arm })
            .collect();
        scales.resize(parts.system().n(), 1.0);
        scales
    }
}

/// Displacements of the minimum, from any start, and the iterations it took.
pub fn minimise(
    parts: &BearingParts,
    start: &Displacements,
    scales: SearchScales,
) -> Result<(Displacements, usize), DynamicsError> {
    let system = parts.system();
    let lengths = scales.of_unknowns(parts);
    let policy = Policy {
        most_iterations: MOST_ITERATIONS,
        residual_limit: RESIDUAL_LIMIT,
        force_scale: largest_load(parts, scales),
        round_off: RoundOff::Links,
        ends_at_floor: false,
        keeps_factors: false,
        blocks: &[],
        scales: Some(&lengths),
        // A trace of the contacts' and more than what a growing ball load takes away.
        proximal: PROXIMAL * scales.stiffness + 2.0 * largest_slope(parts),
        longest_step: scales.step,
        search: Shortening::Energy,
        watch: &|x| {
            check_range(
                parts,
                system.coordinates(SHAFT, x),
                parts.seat_end(&system, x),
                scales,
            )
        },
        costs: &SharedLaps::default(),
    };
    let solved = system.solve(parts.unknowns(start), &policy)?;
    Ok((parts.displacements(&solved.unknowns, start), solved.iterations))
}

/// Force, N, that the round-off of positions makes in all contacts together: what a light load can be balanced to.
pub fn round_off(parts: &BearingParts, u: &Displacements) -> f64 {
    parts.system().round_off(&parts.unknowns(u))
}

/// Largest load on shaft and balls, N.
fn largest_load(parts: &BearingParts, scales: SearchScales) -> f64 {
    let shaft = parts.shaft.dofs.iter().enumerate();
    let shaft = shaft.map(|(dof, x)| if dof < 3 { x.load } else { x.load / scales.tilt_arm });
    let balls = parts.balls.iter().flat_map(|ball| ball.dofs.map(|dof| dof.load));
    shaft
        .chain(balls)
        .fold(f64::MIN_POSITIVE, |most, load| most.max(load.abs()))
}

/// What a user should know of a sliding seat where nothing holds the axis.
const SEAT_HINT: &str = "; the outer ring slides too: lock or prescribe shaft.z, or give \
                         effects.spring_preload.stiffness";

fn check_range(
    parts: &BearingParts,
    shaft: [f64; 5],
    seat: f64,
    scales: SearchScales,
) -> Result<(), DynamicsError> {
    if seat.abs() > scales.range {
        return Err(DynamicsError::NoEquilibrium {
            dof: "z of the outer ring's seat".to_string(),
            limit: format!("{:.3} mm", 1e3 * scales.range),
            hint: SEAT_HINT,
        });
    }
    for (i, q) in shaft.into_iter().enumerate() {
        let (limit, text) = match i {
            0..3 => (scales.range, format!("{:.3} mm", 1e3 * scales.range)),
            _ => (MAX_TILT, format!("{MAX_TILT} rad, where small rotations end")),
        };
        if q.abs() > limit {
            return Err(DynamicsError::NoEquilibrium {
                dof: format!("{} of the shaft", AXES[i]),
                limit: text,
                hint: hint(parts, i),
            });
        }
    }
    Ok(())
}

fn hint(parts: &BearingParts, dof: usize) -> &'static str {
    if parts.seat.is_some() && dof == 2 {
        SEAT_HINT
    } else {
        ""
    }
}

/// Fails when a free shaft dof has no stiffness at the solution `u`.
pub fn check_held(
    parts: &BearingParts,
    u: &Displacements,
    scales: SearchScales,
) -> Result<(), DynamicsError> {
    let free: Vec<usize> = parts.shaft.free().collect();
    let (system, x) = (parts.system(), parts.unknowns(u));
    let (n, m) = (system.n(), free.len());
    let at = system.evaluate(&x, &SharedLaps::default());
    let mut hessian = system.body_tangent(&x);
    system.add_link_tangents(&x, &at.links, &mut hessian);
    system.add_curvatures(&x, &at.links, &mut hessian);
    scale_tangent(n, &scales.of_unknowns(parts), &mut hessian);
    // The load that grows with the radial displacement of a ball must hold that alone, not what carries the rings.
    let balls = m..m + 2 * parts.balls.len();
    for i in m..n {
        let is_radial = balls.contains(&i) && (i - m).is_multiple_of(2);
        let of_load = if is_radial {
            2.0 * largest_slope(parts)
        } else {
            0.0
        };
        hessian[n * i + i] += PROXIMAL * scales.stiffness + of_load;
    }
    // Stiffness of the shaft on its balls and rings.
    let condensation = Condensation::new(n, m, &hessian);
    let condensation = condensation.map_err(|source| DynamicsError::ContactSystem { source })?;
    let mut stiffness = condensation.apply(&hessian);
    let scale = scales.stiffness;
    for i in 0..m {
        // A dof counts as unheld when its pivot, after elimination of those before it, vanishes.
        let pivot = stiffness[m * i + i];
        if pivot < 1e3 * PROXIMAL * scale {
            return Err(DynamicsError::Unheld {
                dof: AXES[free[i]],
                hint: hint(parts, free[i]),
                stiffness: (pivot / scale).max(0.0),
            });
        }
        for j in i + 1..m {
            let share = stiffness[m * j + i] / pivot;
            (i..m).for_each(|k| stiffness[m * j + k] -= share * stiffness[m * i + k]);
        }
    }
    Ok(())
}

fn largest_slope(parts: &BearingParts) -> f64 {
    let slopes = parts.balls.iter().map(|ball| ball.dofs[0].load_slope);
    slopes.fold(0.0, f64::max)
}

impl BearingParts {
    /// Load on a ball at its just-touching position and what its contacts add besides their normal forces, N.
    pub fn ball_load(&self, ball: usize) -> Meridian {
        let mut load = Meridian::from(self.balls[ball].dofs.map(|dof| dof.load));
        for (site, dead) in self.contacts.sites.iter().zip(&self.contacts.dead) {
            if site.ball == ball {
                load = load - *dead;
            }
        }
        load
    }

    /// Loads on the shaft with what the contacts of a ring that it carries add besides their normal forces, N and N m.
    pub fn shaft_load(&self) -> [f64; 5] {
        let mut sum = self.shaft.dofs.map(|dof| dof.load);
        let contacts = self.contacts.sites.iter().zip(&self.contacts.dead);
        for (site, dead) in contacts.filter(|(site, _)| site.side == Side::Inner) {
            for (load, row) in sum.iter_mut().zip(site.carrier_rows()) {
                *load += row.dot(*dead);
            }
        }
        sum
    }
}
