//! `raceway check`: builds everything a run needs except factors, and says what the run would be.

use std::path::Path;

use contact::Side;
use dynamics::{Model, RingMemory, forecast_peak, ring};

use crate::build::build_model;
use crate::failure::Failure;
use crate::modes;
use crate::print;
use crate::results::fields;
use crate::scene::{Analysis, Scene};

/// Bytes of one point in a step file: displacement f64, stress and von Mises f32, two force vectors f64.
const BYTES_PER_POINT: usize = 3 * 8 + 7 * 4 + 6 * 8;

/// Reads and checks the scene and its meshes and prints effects, sizes and forecasts.
pub fn check(path: &Path, overrides: &[String]) -> Result<(), Failure> {
    let scene = Scene::load(path, overrides)?;
    let model = build_model(&scene)?;
    print::line(format_args!(
        "scene    {}",
        scene.title.as_deref().unwrap_or("(no title)")
    ));
    let steps = match &scene.analysis {
        Analysis::Static => {
            print::line(format_args!("analysis static"));
            1
        }
        Analysis::Dynamic(dynamic) => {
            print::line(format_args!(
                "analysis dynamic, {} steps of {} s, fields every {} steps",
                dynamic.n_steps, dynamic.step, dynamic.output_every
            ));
            1 + dynamic.n_steps.div_ceil(dynamic.output_every) as usize
        }
        Analysis::Modes(wanted) => {
            let names: Vec<String> = wanted.bodies.iter().map(|b| modes::name(*b, wanted)).collect();
            print::line(format_args!(
                "analysis modes, the {} lowest of each: {}",
                wanted.number,
                names.join(", ")
            ));
            wanted.number * wanted.bodies.len()
        }
        Analysis::Sweep(sweep) => {
            print::line(format_args!(
                "analysis sweep of {} over {} values",
                sweep.key,
                sweep.points.len()
            ));
            sweep.points.len()
        }
    };
    let names: Vec<&str> = model.effects.iter().map(|e| e.name()).collect();
    print::line(format_args!(
        "effects  {}",
        if names.is_empty() {
            "none".to_string()
        } else {
            names.join(", ")
        }
    ));
    let geometry = &model.geometry;
    print::line(format_args!(
        "bearing  {} balls, clearance {:.4} mm, groove distance {:.4} mm, free contact angle {:.4} deg",
        geometry.n_balls,
        1e3 * geometry.clearance(),
        1e3 * geometry.groove_distance(),
        geometry.free_contact_angle().to_degrees()
    ));
    let mut memory = [None, None];
    for side in Side::BOTH {
        memory[side.index()] = print_ring(&model, side)?;
    }
    let n_threads = rayon::current_num_threads();
    print::line(format_args!(
        "memory   peak about {:.0} MB with {n_threads} threads{}",
        forecast_peak(memory, n_threads) as f64 / 1e6,
        match &scene.analysis {
            Analysis::Dynamic(_) =>
                " for the static start; the steps hold mass and stiffness too, and are not forecast"
                    .to_string(),
            Analysis::Modes(wanted) => format!(
                " for the static start; the search for modes holds mass, stiffness and {:.0} MB of vectors beside the \
                 factors",
                modes::basis_bytes(&model, wanted) as f64 / 1e6
            ),
            _ => String::new(),
        }
    ));
    let points: usize = fields::bodies(&model).iter().map(|b| b.points.len()).sum();
    let step_bytes = points * BYTES_PER_POINT + state_bytes(&scene, &model);
    print::line(format_args!(
        "output   about {:.2} MB per step, {:.2} MB in all",
        step_bytes as f64 / 1e6,
        (step_bytes * steps) as f64 / 1e6
    ));
    Ok(())
}

/// Prints one ring and returns the forecast of its memory; None for a rigid ring.
/// Bytes of the stored state of a moving bearing: displacement, velocity and acceleration of every ring dof.
fn state_bytes(scene: &Scene, model: &dynamics::Model) -> usize {
    match &scene.analysis {
        Analysis::Dynamic(_) => model
            .rings
            .iter()
            .flatten()
            .map(|ring| 3 * 8 * ring.mesh.n_dofs())
            .sum(),
        _ => 0,
    }
}

fn print_ring(model: &Model, side: Side) -> Result<Option<RingMemory>, Failure> {
    let stiffness = model.hertz[side.index()].stiffness / 10f64.powf(4.5);
    let Some(ring) = model.ring(side) else {
        print::line(format_args!(
            "{}    rigid, Hertz stiffness {stiffness:.4e} N/mm^1.5, no dofs",
            side.name()
        ));
        return Ok(None);
    };
    let mesh = &ring.mesh;
    let (memory, symbolic) = ring::forecast(side, ring, model.geometry.n_balls).map_err(Failure::solving)?;
    print::line(format_args!(
        "{}    {} {}, {} nodes, {} dofs; Hertz stiffness {stiffness:.4e} N/mm^1.5; factor {:.1} MB, {:.2e} flops, \
         peak {:.1} MB",
        side.name(),
        mesh.n_elements(),
        mesh.kind.name(),
        mesh.n_nodes(),
        mesh.n_dofs(),
        symbolic.factor_bytes() as f64 / 1e6,
        symbolic.flops(),
        (memory.mesh + memory.making()) as f64 / 1e6
    ));
    Ok(Some(memory))
}
