//! `raceway check` of a scene with a list of bearings: sizes of each type, the shaft, and what is to be solved.

use assembly::Assembly;
use comm::print::{self, counted};
use dynamics::Model;
use dynamics::motion::check_supported;
use results::answer;
use results::failure::Failure;
use results::list_memory::{BearingMemory, forecast_list, forecast_modes_of_list};
use scene::{Analysis, BearingOnShaft, SeveralScene, ShaftKind, build_assembly, have_same_rings};

use crate::bodies::print_bodies;
use crate::ring_sizes::print_rings;
use crate::several_read::{all_doubts, surveys};
use crate::several_ready::forecast;
use crate::several_rules;
use crate::shared::print_effects;

/// Prints what a run would be.
pub fn check(scene: &SeveralScene) -> Result<(), Failure> {
    let (assembly, _) = build_assembly(scene)?;
    surveys(scene, &assembly)?;
    print::line(format_args!(
        "scene    {}",
        scene.title.as_deref().unwrap_or("(no title)")
    ));
    print_analysis(scene);
    print_effects(&scene.effects.names());
    let mut listed: Vec<BearingMemory<'_>> = Vec::new();
    for (i, bearing) in scene.bearings.iter().enumerate() {
        let model = &assembly.bearings[i].model;
        print_bearing(bearing, model);
        let like = (0..i).find(|&k| have_same_rings(&scene.bearings[k].scene, &bearing.scene));
        if let Some(k) = like {
            print::line(format_args!(
                "         its rings are those of {:?}, and are factored once",
                scene.bearings[k].name
            ));
            listed.push(BearingMemory {
                scene: &bearing.scene,
                model,
                ..listed[k]
            });
            continue;
        }
        if matches!(scene.analysis, Analysis::Dynamic(_)) {
            check_supported(model).map_err(Failure::solving)?;
        }
        let rings = print_rings(model)?;
        listed.push(BearingMemory {
            scene: &bearing.scene,
            model,
            rest: rings.memory,
            motion: rings.motion,
        });
    }
    let (start, steps) = forecast_list(&scene.analysis, &listed);
    let mut peak = steps.unwrap_or(0).max(start);
    if let Analysis::Modes(wanted) = &scene.analysis {
        peak = peak.max(forecast_modes_of_list(wanted, &listed));
    }
    print_bodies(assembly.bearings.iter().map(|bearing| &bearing.model));
    print_shaft(scene, &assembly.shaft);
    print::line(format_args!(
        "memory   peak about {:.0} MB with {} threads",
        peak as f64 / 1e6,
        rayon::current_num_threads()
    ));
    say_output(scene, &assembly);
    print_advice(scene, &assembly)?;
    answer::add("peak_memory_bytes", peak);
    answer::add("shaft_dofs", assembly.shaft.n());
    Ok(())
}

fn print_bearing(bearing: &BearingOnShaft, model: &Model) {
    let geometry = &model.geometry;
    print::line(format_args!(
        "bearing  {:?} of {} at {:.3} mm, {}: {} balls, clearance {:.4} mm, free contact angle {:.4} deg",
        bearing.name,
        bearing.type_file,
        1e3 * bearing.position,
        bearing.orientation.name(),
        geometry.n_balls,
        1e3 * geometry.clearance(),
        geometry.free_contact_angle().to_degrees()
    ));
}

/// Says how much a run would write.
fn say_output(scene: &SeveralScene, assembly: &Assembly) {
    let output = forecast(scene, assembly, 0);
    match &scene.analysis {
        Analysis::Sweep(sweep) => output.times(sweep.points.len() as u64).say(),
        _ => output.say(),
    }
}

fn print_advice(scene: &SeveralScene, assembly: &Assembly) -> Result<(), Failure> {
    let assumed = assumed(scene);
    for line in &assumed {
        print::line(format_args!("assumed  {line}"));
    }
    let advice = [
        all_doubts(scene, assembly),
        several_rules::advice(scene, assembly)?,
    ]
    .concat();
    for line in &advice {
        print::line(format_args!("advice   {line}"));
    }
    answer::add("advice", &advice);
    answer::add("assumed", &assumed);
    Ok(())
}

/// Numbers that names stand for, once each.
fn assumed(scene: &SeveralScene) -> Vec<String> {
    let of_bearings = scene.bearings.iter().flat_map(|bearing| &bearing.scene.assumed);
    once(of_bearings.chain(&scene.shaft.assumed).cloned())
}

fn once(lines: impl Iterator<Item = String>) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for line in lines {
        if !all.contains(&line) {
            all.push(line);
        }
    }
    all
}

fn print_analysis(scene: &SeveralScene) {
    match &scene.analysis {
        Analysis::Sweep(sweep) => print::line(format_args!(
            "analysis sweep of {} over {}",
            sweep.key,
            counted(sweep.points.len(), "value")
        )),
        Analysis::Dynamic(dynamic) => print::line(format_args!(
            "analysis dynamic: {} of {} s, a step file of each bearing every {}",
            counted(dynamic.n_steps, "step"),
            dynamic.step,
            counted(dynamic.output_every, "step")
        )),
        Analysis::QuasiStatic(settings) => print::line(format_args!(
            "analysis quasi-static: {} of {} s, a step file of each bearing every {}",
            counted(settings.n_steps, "step"),
            settings.step,
            counted(settings.output_every, "step")
        )),
        Analysis::Modes(wanted) => print::line(format_args!(
            "analysis modes, the {} lowest of all bearings with their shaft",
            wanted.number
        )),
        Analysis::Static => print::line(format_args!("analysis static")),
    }
}

fn print_shaft(scene: &SeveralScene, shaft: &assembly::ShaftBody) {
    let n_held = shaft.held.iter().filter(|held| held.is_some()).count();
    match &scene.shaft.kind {
        ShaftKind::Rigid(_) => print::line(format_args!(
            "shaft    rigid, {} free motions, {}",
            shaft.n() - n_held,
            along(scene)
        )),
        ShaftKind::Beam(beam) => {
            let [first, last] = beam.ends();
            let elements = beam.elements(&shaft.nodes);
            let mass: f64 = elements.iter().map(assembly::beam::BeamElement::mass_total).sum();
            print::line(format_args!(
                "shaft    beam from {:.3} to {:.3} mm, {} elements, {} dofs, {mass:.4} kg, {}",
                1e3 * first,
                1e3 * last,
                elements.len(),
                shaft.n(),
                along(scene)
            ));
        }
    }
}

/// What is on the shaft, in words.
fn along(scene: &SeveralScene) -> String {
    let [loads, discs] = [scene.shaft.loads.len(), scene.shaft.masses.len()];
    format!(
        "{} and {} along it",
        counted(loads, "load"),
        counted(discs, "disc")
    )
}
