//! `raceway check`: builds everything a run needs except factors, and says what the run would be.

use std::f64::consts::PI;
use std::path::Path;

use comm::print::{self, counted};
use contact::BearingGeometry;
use dynamics::kinematics::Kinematics;
use dynamics::motion::check_supported;
use dynamics::{Model, MotionMemory, RingMemory};
use results::answer;
use results::disk::Forecast;
use results::failure::Failure;
use results::memory::{bound, forecast};
use results::probes::PlacedProbes;
use results::survey::Survey;
use scene::{Analysis, AnyScene, Scene, build_model, doubts};

use crate::bodies::print_bodies;
use crate::modes;
use crate::rank_table;
use crate::ring_sizes::print_rings;
use crate::rules;
use crate::several_check;
use crate::shared::print_effects;

/// Reads and checks the scene and its meshes and prints effects, sizes and forecasts.
pub fn check(path: &Path, overrides: &[String]) -> Result<(), Failure> {
    let scene = match AnyScene::load(path, overrides)? {
        AnyScene::One(scene) => *scene,
        AnyScene::Several(list) => return several_check::check(&list),
    };
    let (model, tags) = build_model(&scene)?;
    if matches!(scene.analysis, Analysis::Dynamic(_)) {
        check_supported(&model).map_err(Failure::solving)?;
    }
    let probes = PlacedProbes::new(&scene, &model, &tags)?;
    let region = Survey::of_part(&scene, &model)?.region;
    print::line(format_args!(
        "scene    {}",
        scene.title.as_deref().unwrap_or("(no title)")
    ));
    print_analysis(&scene);
    print_effects(&scene.effects.names());
    let geometry = &model.geometry;
    print::line(format_args!(
        "bearing  {} balls, clearance {:.4} mm, groove distance {:.4} mm, free contact angle {:.4} deg",
        geometry.n_balls,
        1e3 * geometry.clearance(),
        1e3 * geometry.groove_distance(),
        geometry.free_contact_angle().to_degrees()
    ));
    for line in model.mounting.report.iter().flat_map(results::mounting::lines) {
        print::line(format_args!("mounted  {line}"));
    }
    print_rolling(&scene, geometry);
    print_probes(&scene, probes.as_ref());
    if let Some([points, cells]) = region.map(|region| region.shares()) {
        let (points, cells) = (100.0 * points, 100.0 * cells);
        print::line(format_args!(
            "region   fields are kept at {points:.1} % of the points and {cells:.1} % of the cells"
        ));
    }
    let rings = print_rings(&model)?;
    print_bodies(std::iter::once(&model));
    print_memory(&scene, &model, rings.memory, rings.motion);
    rank_table::print(&rings.on_ranks, &scene.analysis);
    let forecast = Forecast::new(&scene, &model, 0);
    forecast.say();
    for line in &scene.assumed {
        print::line(format_args!("assumed  {line}"));
    }
    let advice = [doubts(&scene, &model), rules::advice(&scene, &model)?].concat();
    for line in &advice {
        print::line(format_args!("advice   {line}"));
    }
    answer::add("advice", &advice);
    answer::add("assumed", &scene.assumed);
    answer::add("clearance_m", geometry.clearance());
    answer::add("free_contact_angle_rad", geometry.free_contact_angle());
    Ok(())
}

fn print_analysis(scene: &Scene) {
    match &scene.analysis {
        Analysis::Static => print::line(format_args!("analysis static")),
        Analysis::QuasiStatic(quasi) => print::line(format_args!(
            "analysis quasi-static, {} of {} s, fields every {}",
            counted(quasi.n_steps, "step"),
            quasi.step,
            counted(quasi.output_every, "step")
        )),
        Analysis::Dynamic(dynamic) => print::line(format_args!(
            "analysis dynamic, {} of {} s, fields every {}",
            counted(dynamic.n_steps, "step"),
            dynamic.step,
            counted(dynamic.output_every, "step")
        )),
        Analysis::Modes(wanted) => {
            let names: Vec<String> = wanted.bodies.iter().map(|b| modes::name(*b, wanted)).collect();
            print::line(format_args!(
                "analysis modes, the {} lowest of each: {}",
                wanted.number,
                names.join(", ")
            ));
        }
        Analysis::Sweep(sweep) => print::line(format_args!(
            "analysis sweep of {} over {}",
            sweep.key,
            counted(sweep.points.len(), "value")
        )),
    }
}

/// Prints how cage and balls roll at the largest speed of the scene, and how often balls pass a point of each raceway
/// (Harris, 4th ed., chapter 8): n |omega_c - omega_o| / (2 pi) on the outer ring, n |omega_i - omega_c| / (2 pi) on
/// the inner one. A point of a ball meets each raceway once per turn about its own axis.
fn print_rolling(scene: &Scene, geometry: &BearingGeometry) {
    let Some(speeds) = &scene.speed else { return };
    let [inner, outer] = speeds.at_largest(|[inner, outer]| (inner - outer).abs());
    let turning = Kinematics::new(geometry, scene.effects.slip());
    let rpm = |speed: f64| speed * 30.0 / PI;
    let hertz = |speed: f64| speed.abs() / (2.0 * PI);
    let n = geometry.n_balls as f64;
    let outside = match outer {
        0.0 => String::new(),
        _ => format!(" and {:.2} rpm outside", rpm(outer)),
    };
    let cage = turning.of_cage([inner, outer]);
    print::line(format_args!(
        "rolling  at {:.2} rpm inside{outside}: cage {:.2} rpm, balls {:.2} rpm about their axes; passing balls {:.3} \
         per second inside, {:.3} per second outside",
        rpm(inner),
        rpm(cage),
        rpm(turning.ball * (inner - outer).abs()),
        n * hertz(inner - cage),
        n * hertz(cage - outer),
    ));
}

/// Prints the forecast of the peak. Of a motion `motion` has the sizes of each ring, Some(None) when it is rigid,
/// None when its steps are not forecast.
fn print_memory(
    scene: &Scene,
    model: &Model,
    memory: [Option<RingMemory>; 2],
    motion: [Option<Option<MotionMemory>>; 2],
) {
    let n_threads = rayon::current_num_threads();
    let (start, steps) = forecast((scene, model), memory, motion);
    let (peak, note) = match (&scene.analysis, steps) {
        (Analysis::Dynamic(_), Some(steps)) => {
            let note = format!(" ({:.0} MB for the static start)", start as f64 / 1e6);
            (steps.max(start), note)
        }
        (Analysis::Dynamic(_), _) => {
            let note = " for the static start; the steps hold mass and stiffness too, and are not forecast";
            (start, note.to_string())
        }
        _ => (start, String::new()),
    };
    answer::add("peak_memory_bytes", peak);
    print::line(format_args!(
        "memory   peak about {:.0} MB with {n_threads} threads{note}",
        peak as f64 / 1e6
    ));
    if let Some(bound) = bound().filter(|bound| bound.bytes < peak as u64) {
        print::line(format_args!(
            "         more than {bound}, so that a run would be refused here"
        ));
    }
}

/// Prints where the probes of a scene lie.
fn print_probes(scene: &Scene, probes: Option<&PlacedProbes>) {
    let Some(probes) = probes else { return };
    for p in probes.places() {
        print::line(format_args!(
            "probe    {}: node {} of the {} ring, azimuth {:.3} deg, r {:.4} mm, z {:.4} mm, {:.4} mm from its point",
            p.name,
            p.tag,
            p.ring,
            p.azimuth_rad.to_degrees(),
            1e3 * p.r_m,
            1e3 * p.z_m,
            1e3 * p.distance_m
        ));
    }
    for g in &scene.probes.gauges {
        print::line(format_args!(
            "probe    {}: strain gauge of {} mm x {} mm on the surface {:?} of the {} ring, azimuth {:.3} deg",
            g.name,
            1e3 * g.size[0],
            1e3 * g.size[1],
            g.surface,
            g.ring.key(),
            g.azimuth.to_degrees()
        ));
    }
    for c in &scene.probes.contacts {
        print::line(format_args!(
            "probe    {}: contact of ball {} with the {} ring",
            c.name,
            c.ball,
            c.ring.key()
        ));
    }
}
