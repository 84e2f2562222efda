//! What `raceway check` says of a ring.

use comm::print;
use contact::Side;
use dynamics::statics::settings;
use dynamics::{Model, MotionMemory, Numbers, Prepared, RingMemory, Substructures};
use results::failure::Failure;

use crate::rank_table::RingOnRanks;

/// Memory of one ring, what its motion holds when that is known, and on ranks when it is in sectors.
type RingForecast = (RingMemory, Option<MotionMemory>, Option<RingOnRanks>);

/// Forecasts of both rings, inner first.
#[derive(Default)]
pub struct RingForecasts {
    /// Memory at rest; None of a rigid ring.
    pub memory: [Option<RingMemory>; 2],
    /// In motion: Some(None) of a rigid ring, None when its steps are not forecast.
    pub motion: [Option<Option<MotionMemory>>; 2],
    /// On ranks, of a ring in sectors.
    pub on_ranks: [Option<RingOnRanks>; 2],
}

/// Prints both rings and returns the forecasts of their memory.
pub fn print_rings(model: &Model) -> Result<RingForecasts, Failure> {
    let mut rings = RingForecasts {
        motion: [Some(None), Some(None)],
        ..RingForecasts::default()
    };
    for side in Side::BOTH {
        if let Some((of_ring, of_motion, of_ranks)) = print_ring(model, side)? {
            rings.memory[side.index()] = Some(of_ring);
            rings.motion[side.index()] = of_motion.map(Some);
            rings.on_ranks[side.index()] = of_ranks;
        }
    }
    Ok(rings)
}

/// Prints one ring and returns the forecast of its memory; None for a rigid ring.
fn print_ring(model: &Model, side: Side) -> Result<Option<RingForecast>, Failure> {
    let stiffness = model.hertz[side.index()].stiffness / 10f64.powf(4.5);
    let Some(ring) = model.ring(side) else {
        print::line(format_args!(
            "{}    rigid, Hertz stiffness {stiffness:.4e} N/mm^1.5, no dofs",
            side.name()
        ));
        return Ok(None);
    };
    let mesh = &ring.mesh;
    let prepared = Prepared::new(ring, settings(model, side), Numbers::Pattern).map_err(Failure::solving)?;
    let prepared = prepared.stiffness;
    let memory = prepared.memory();
    print::line(format_args!(
        "{}    {} {}, {} nodes, {} dofs; Hertz stiffness {stiffness:.4e} N/mm^1.5; factor {:.1} MB, {:.2e} flops, \
         peak {:.1} MB",
        side.name(),
        mesh.n_elements(),
        mesh.kind.name(),
        mesh.n_nodes(),
        mesh.n_dofs(),
        prepared.factor_bytes() as f64 / 1e6,
        prepared.flops(),
        (memory.mesh + memory.making()) as f64 / 1e6
    ));
    print::line(format_args!(
        "         {}",
        match ring.periodicity() {
            Ok(periodicity) => format!(
                "rotationally periodic, {} equal sectors, to {:.1e} m; solver {}",
                periodicity.n_sectors(),
                periodicity.deviation(),
                prepared.note()
            ),
            Err(_) if prepared.solver_name() == "cyclic" =>
                format!("rotationally periodic up to a defect; solver {}", prepared.note()),
            Err(reason) => format!("not rotationally periodic: {reason}"),
        }
    ));
    if let Some(parts) = prepared.parts() {
        print_sectors(parts);
    }
    let on_ranks = prepared.parts().map(|parts| RingOnRanks::new(model, ring, parts));
    let motion = prepared.motion().map(|motion| match model.is_stiffened(side) {
        true => motion.stiffened(),
        false => motion,
    });
    Ok(Some((memory, motion, on_ranks)))
}

/// Prints the balance of the sectors.
fn print_sectors(parts: &Substructures) {
    print::line(format_args!("         {}", parts.note()));
    let costs = parts.symbolic().costs();
    let whole: f64 = costs.iter().map(|c| c.flops).sum();
    for (s, cost) in costs.iter().enumerate() {
        print::line(format_args!(
            "         sector {s}: {} elements, {} dofs, factor {:.1} MB, {:.1} % of the flops",
            cost.n_elements,
            cost.n_rows,
            cost.factor_bytes as f64 / 1e6,
            100.0 * cost.flops / whole
        ));
    }
}
