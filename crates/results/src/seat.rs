//! The seat of a ring in an elastic body: tractions as a table, and what the summary says of the joint.
//!
//! `seat_outer.csv` and `seat_inner.csv` have the last equilibrium of a run, or the end of a motion, on a grid of the
//! seat: azimuth from +x towards +y, z in the coordinates of the ring's mesh. Pressure is positive where the body
//! presses on the ring; shear is the traction on the ring in the direction of growing azimuth and z; motion is that of
//! the seat, which ring and body share, of a body on the shaft beside that of the shaft.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use body::{BesideRing, BodyLoad, SeatBasis, SeatFunctions, SeatTie, SeatTraction};
use comm::{Communicator, print};
use contact::Side;
use dynamics::frame::turn;
use dynamics::motion::{Motion, MotionState};
use dynamics::stiffness::N_SHAFT;
use dynamics::{Model, RingModel, StaticSolution};
use serde::Serialize;

use crate::failure::Failure;
use crate::whole;

/// Names of the tables, inner ring first.
pub const SEAT_TABLES: [&str; 2] = ["seat_inner.csv", "seat_outer.csv"];
/// Its columns.
const HEAD: &str =
    "azimuth_rad,z_m,pressure_pa,shear_tangential_pa,shear_axial_pa,radial_m,tangential_m,axial_m";
/// Points of the table round and across the seat.
const GRID: [usize; 2] = [144, 9];
/// Shares of the energy above which a warning asks for more functions.
const UNRESOLVED: f64 = 0.02;

/// The joint of a ring with its body at one equilibrium.
pub struct SeatState {
    side: Side,
    tie: Arc<SeatTie>,
    functions: SeatFunctions,
    /// What it carries.
    pub traction: SeatTraction,
    /// Forces on the other seats of the body, N, over the functions of all.
    others: Option<Arc<Vec<f64>>>,
    /// Load on all of the body.
    load: Option<BodyLoad>,
    /// Strain energy that the joint puts into the body, J: all of it where it is the only one.
    energy: f64,
}

/// What the summary says of a seat.
#[derive(Clone, Debug, Serialize)]
pub struct SeatSummary {
    body: String,
    harmonics: usize,
    across: usize,
    functions: usize,
    /// Share of the last two orders round the seat in the energy of the body; none of a seat that moves as a rigid one.
    energy_share_last_orders: Option<f64>,
    /// Share of the last degree across; none of a seat that moves as a rigid one.
    energy_share_last_degree: Option<f64>,
    /// Strain energy that this seat puts into the body, all of it where it is the only seat; part of that of the rings.
    body_energy_j: f64,
    /// Of a seat that moves as a rigid one nothing says how its forces spread.
    largest_pressure_pa: Option<f64>,
    smallest_pressure_pa: Option<f64>,
    body_dofs: usize,
    body_bytes: usize,
    /// Assembly, factor and all columns of the body.
    body_seconds: f64,
}

/// What the summary says of the seats of both rings, inner first.
pub type SeatSummaries = [Option<SeatSummary>; 2];

/// The ring of one side if it is tied to a body, and its joint.
pub fn tied(model: &Model, side: Side) -> Option<(&RingModel, &Arc<SeatTie>)> {
    let ring = model.tied(side)?;
    Some((ring, ring.tie.as_ref()?))
}

/// Where the seats of a bearing are written, and its name where there are several.
pub type SeatFolder<'p> = (&'p Path, Option<&'p str>);

/// Writes what the seats of rings in bodies carry, and sums it up; None where a ring is in none.
pub fn of_run(
    model: &Model,
    solution: &StaticSolution,
    to: SeatFolder<'_>,
) -> Result<SeatSummaries, Failure> {
    let [inner, outer] = Side::BOTH.map(|side| finished(SeatState::new(model, solution, side)?, to));
    Ok([inner?, outer?])
}

/// The same at the end of a motion.
pub fn of_motion(
    motion: &Motion<'_>,
    state: &MotionState,
    to: SeatFolder<'_>,
) -> Result<SeatSummaries, Failure> {
    let [inner, outer] = Side::BOTH.map(|side| finished(SeatState::in_motion(motion, state, side)?, to));
    Ok([inner?, outer?])
}

fn finished(state: Option<SeatState>, to: SeatFolder<'_>) -> Result<Option<SeatSummary>, Failure> {
    Ok(state.map(|state| state.finish(to)).transpose()?)
}

/// The ring on the shaft.
pub(crate) const ON_SHAFT: Side = Side::BOTH[0];

/// Mean motion of the inner ring's seat beside the rigid motion of the shaft whose body it sits on, at the axis point,
/// in the frame of the bearing, which stands in space, m and rad; None where the inner ring is on no such body. Seats
/// were resolved before.
pub fn beside_shaft_at_rest(model: &Model, solution: &StaticSolution) -> Option<[f64; N_SHAFT]> {
    let (ring, tie) = on_shaft(model)?;
    let functions = ring.seat_functions(ON_SHAFT.name()).ok().flatten()?;
    let field = solution.elastic[ON_SHAFT.index()].as_ref()?;
    let beside = at_axis_point(model, tie, &functions.measure(field));
    Some(turn(beside, solution.pose.frame_angle(ON_SHAFT)))
}

/// The same in a motion.
pub fn beside_shaft_in_motion(motion: &Motion<'_>, state: &MotionState) -> Option<[f64; N_SHAFT]> {
    let (_, tie) = on_shaft(motion.model())?;
    let moved = state.rings[ON_SHAFT.index()].as_ref()?.body()?;
    let seat = motion.tied(ON_SHAFT)?.seat_beside_shaft(moved)?;
    let beside = at_axis_point(motion.model(), tie, &seat);
    Some(turn(beside, motion.angle_of_frame(state, ON_SHAFT)))
}

/// The inner ring on the body of a shaft.
fn on_shaft(model: &Model) -> Option<(&RingModel, &Arc<SeatTie>)> {
    tied(model, ON_SHAFT).filter(|(_, tie)| tie.carried().is_some())
}

/// In the frame of the ring, which turns.
fn at_axis_point(model: &Model, tie: &SeatTie, motion: &[f64]) -> [f64; N_SHAFT] {
    let z = model.geometry.groove_centre(ON_SHAFT).axial;
    let [ux, uy, uz, rx, ry, _] = tie.space.mean_motion(motion, z);
    [ux, uy, uz, rx, ry]
}

/// A place of the table.
struct SeatPoint {
    azimuth: f64,
    z: f64,
    /// Traction on the ring, Pa: radial, tangential, axial.
    traction: [f64; 3],
    /// Motion, m.
    motion: [f64; 3],
}

impl SeatState {
    /// The joint of a ring at an equilibrium; None where it is in no body.
    pub fn new(model: &Model, solution: &StaticSolution, side: Side) -> Result<Option<SeatState>, Failure> {
        let Some((ring, tie)) = tied(model, side) else {
            return Ok(None);
        };
        let functions = ring.seat_functions(side.name()).map_err(Failure::solving)?;
        let (Some(functions), Some(field)) = (functions, &solution.elastic[side.index()]) else {
            return Ok(None);
        };
        let others = model.other_seats[side.index()].clone();
        let load = solution.body_load(model, side);
        let traction = tie.traction(&functions, field, model.acting(side, load));
        Ok(traction.map(|traction| SeatState {
            side,
            tie: tie.clone(),
            functions,
            others,
            load,
            energy: tie.energy(&traction, load),
            traction,
        }))
    }

    /// The joint of a ring in a motion; None where it is in no body.
    fn in_motion(motion: &Motion<'_>, state: &MotionState, side: Side) -> Result<Option<SeatState>, Failure> {
        let Some((ring, tie)) = tied(motion.model(), side) else {
            return Ok(None);
        };
        let functions = ring.seat_functions(side.name()).map_err(Failure::solving)?;
        let body = state.rings[side.index()].as_ref().and_then(|ring| ring.body());
        let (Some(functions), Some(body), Some(moved)) = (functions, motion.tied(side), body) else {
            return Ok(None);
        };
        let load = motion.body_load(state, side);
        let traction = body.traction(moved, load);
        let [_, strain] = body.energies(Some(moved));
        let energy = match (&traction, tie.has_others()) {
            (Some(traction), true) => tie.energy(traction, load),
            _ => strain,
        };
        Ok(traction.map(|traction| SeatState {
            side,
            tie: tie.clone(),
            functions,
            others: None,
            load,
            traction,
            energy,
        }))
    }

    /// Displacement of the body at rest, m, `[n_nodes][3]` flat, of one on the shaft beside that of the shaft.
    pub fn body_displacement(&self) -> Vec<f64> {
        let acting = BesideRing {
            others: self.others.as_ref().map(|others| others.as_slice()),
            load: self.load,
        };
        let found = self.tie.displacement(&self.traction, acting);
        found.expect("a joint that carries something has a body")
    }

    /// Writes the table, says how converged the joint is, and makes the entry of the summary. Rank 0 writes for all.
    pub fn finish(&self, (dir, bearing): SeatFolder<'_>) -> anyhow::Result<SeatSummary> {
        let points = self.points();
        if Communicator::world().is_root() && !points.is_empty() {
            let text = table(&points, self.side);
            let name = SEAT_TABLES[self.side.index()];
            whole::write(&dir.join(name), text.as_bytes(), |old| whole::holds(old, HEAD))?;
        }
        let summary = self.summary(&points);
        print::line(format_args!("{}", summary.line(self.side, bearing)));
        Ok(summary)
    }

    fn summary(&self, points: &[SeatPoint]) -> SeatSummary {
        let body = self
            .tie
            .body
            .as_ref()
            .expect("a joint that carries something has a body");
        let basis = self.tie.space.basis;
        let share = self.traction.convergence(basis);
        // Rigid motions are of the first order and degree.
        let [harmonics, across] = basis.largest().unwrap_or([1, 1]);
        let pressures = || points.iter().map(|p| p.pressure(self.side));
        SeatSummary {
            body: body.name.clone(),
            harmonics,
            across,
            functions: self.functions.n(),
            energy_share_last_orders: share.map(|share| share.last_orders),
            energy_share_last_degree: share.map(|share| share.last_degree),
            body_energy_j: self.energy,
            largest_pressure_pa: pressures().reduce(f64::max),
            smallest_pressure_pa: pressures().reduce(f64::min),
            body_dofs: body.n_dofs,
            body_bytes: body.bytes,
            body_seconds: body.seconds,
        }
    }

    /// The grid of the table; empty of a seat that moves as a rigid one.
    fn points(&self) -> Vec<SeatPoint> {
        let space = &self.tie.space;
        if space.basis == SeatBasis::Rigid {
            return Vec::new();
        }
        let traction = self.functions.traction(&self.traction.forces);
        let mut points = Vec::with_capacity(GRID[0] * GRID[1]);
        for i in 0..GRID[0] {
            let azimuth = TAU * i as f64 / GRID[0] as f64;
            for j in 0..GRID[1] {
                let across = 2.0 * j as f64 / (GRID[1] - 1) as f64 - 1.0;
                let phi = space.scalars(azimuth, across);
                let sum = |coefficients: &[f64], c: usize| {
                    let own = coefficients.iter().skip(c).step_by(3);
                    own.zip(&phi).map(|(a, b)| a * b).sum::<f64>()
                };
                points.push(SeatPoint {
                    azimuth,
                    z: space.middle + across * space.half_width,
                    traction: [0, 1, 2].map(|c| sum(&traction, c)),
                    motion: [0, 1, 2].map(|c| sum(&self.traction.motion, c)),
                });
            }
        }
        points
    }
}

impl SeatSummary {
    /// What the screen shows of the seat of a ring, of a list that of a bearing by its name.
    fn line(&self, side: Side, bearing: Option<&str>) -> String {
        let of = bearing.map_or(String::new(), |name| format!("bearing {name:?}: "));
        let shares = match (self.energy_share_last_orders, self.energy_share_last_degree) {
            (Some(orders), Some(degree)) => format!(
                "{} functions; the last two orders hold {orders:.2e} of its energy, the last degree across \
                 {degree:.2e}",
                self.functions
            ),
            _ => "it moves as a rigid one, with its reference node".to_string(),
        };
        format!(
            "{of}seat of the {} ring in body {:?}: {shares}",
            side.name(),
            self.body
        )
    }

    /// What a user should know.
    pub fn warning(&self) -> Option<String> {
        let (orders, degree) = (self.energy_share_last_orders?, self.energy_share_last_degree?);
        if orders.max(degree) < UNRESOLVED {
            return None;
        }
        let key = if orders > degree { "harmonics" } else { "across" };
        Some(format!(
            "the seat of body {:?} is not resolved: its last functions hold {:.1} % of its energy; raise {key} of \
             [[body.seat]]",
            self.body,
            100.0 * orders.max(degree)
        ))
    }
}

impl SeatPoint {
    /// Pressure of the body on the ring, Pa: from outside on an outer ring, from inside on an inner one.
    fn pressure(&self, side: Side) -> f64 {
        -side.sign() * self.traction[0]
    }
}

fn table(points: &[SeatPoint], side: Side) -> String {
    let mut text = format!("{HEAD}\n");
    for p in points {
        let [_, tangential, axial] = p.traction;
        let values = [
            p.azimuth,
            p.z,
            p.pressure(side),
            tangential,
            axial,
            p.motion[0],
            p.motion[1],
            p.motion[2],
        ];
        let cells: Vec<String> = values.iter().map(|v| format!("{v:e}")).collect();
        writeln!(text, "{}", cells.join(",")).expect("a string takes all text");
    }
    text
}
