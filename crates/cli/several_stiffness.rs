//! `raceway stiffness` of a scene with a list of bearings: the matrix of each, and that of the shaft at a point.
//!
//! The point is where the first `[[shaft.load]]` acts, or else `shaft.load_point`. A list that runs in time is
//! linearised about the equilibrium of one instant, as one bearing is.

use std::path::Path;

use assembly::stiffness::LinearAssembly;
use assembly::{Assembly, AssemblyError, AssemblySolution, AssemblySolver, HousedTogether};
use comm::print;
use contact::Side;
use dynamics::Pose;
use results::failure::Failure;
use results::several_stiffness::{
    BearingStiffness, CouplingStiffness, SeveralStiffness, ShaftOperatingPoint, ShaftStiffnessAt,
};
use results::stiffness::{NOT_OVER_SPEED, OperatingPoint, StiffnessAt, StiffnessResults};
use results::survey::say_doubts;
use results::whole::{make_asked_folder, require_free};
use scene::{SeveralScene, assembly_with_rings, build_assembly};

use crate::campbell_files::cage_speeds;
use crate::damping::{damping_note, laws};
use crate::linear_figures::draw;
use crate::progress::Progress;
use crate::several::{at_point, column, points, rings, solving, stage_text, words_of};
use crate::several_instant::{load_at, poses, rolling_of_all};
use crate::several_read::all_doubts;
use crate::several_ripple::{Passing, RippleOfList};

/// Linearises at a time, s, with the ripple that is asked for, and writes.
pub fn stiffness(
    scene: &SeveralScene,
    (time, ripple): (f64, Option<usize>),
    out: &Path,
) -> Result<(), Failure> {
    let passing = Passing::new(scene, ripple)?;
    let bearings: Vec<String> = scene.bearings.iter().map(|b| b.name.clone()).collect();
    let names = SeveralStiffness::names(&bearings);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    require_free(out, &names)?;
    let results = linearise(scene, time, passing.as_ref())?;
    make_asked_folder(out)?;
    let mut names = results.write(out)?;
    results.print();
    names.extend(draw(out)?);
    if !results.suits_ross() {
        print::line(format_args!("no ross_NAME.csv: {NOT_OVER_SPEED}"));
    }
    print::line(format_args!("{} in {}", names.join(", "), out.display()));
    Ok(())
}

/// The results before anything is linearised.
fn empty(scene: &SeveralScene, warnings: Vec<String>) -> SeveralStiffness {
    let column = column(scene).map(str::to_string);
    let source = scene.path.display().to_string();
    let bearing = |bearing: &scene::BearingOnShaft| BearingStiffness {
        name: bearing.name.clone(),
        position: bearing.position,
        orientation: bearing.orientation.name(),
        results: StiffnessResults {
            source: source.clone(),
            column: column.clone(),
            points: Vec::new(),
            damping_note: String::new(),
            warnings: Vec::new(),
        },
    };
    let bearings = scene.bearings.iter().map(bearing).collect();
    let first_load = scene.shaft.loads.first().map(|load| load.position);
    SeveralStiffness {
        bearings,
        position: first_load.unwrap_or(scene.shaft.load_point),
        shaft: Vec::new(),
        couplings: Vec::new(),
        damping_note: String::new(),
        warnings,
        source,
        column,
    }
}

fn linearise(
    scene: &SeveralScene,
    time: f64,
    passing: Option<&Passing>,
) -> Result<SeveralStiffness, Failure> {
    let points = points(scene)?;
    let mut progress = Progress::new(points.len() as u64);
    progress.stage("reading meshes");
    let (mut assembly, _) = build_assembly(&points[0].1)?;
    let doubts = all_doubts(scene, &assembly);
    say_doubts(&doubts);
    progress.stage("factoring the stiffness of the rings");
    let mut solver = AssemblySolver::new(&assembly).map_err(solving)?;
    let mut results = empty(scene, doubts);
    let column = results.column.clone();
    let column = column.as_deref();
    let mut before = None;
    for (value, point) in &points {
        progress.stage(&stage_text(column, *value));
        let at = |failure: Failure| at_point(failure, column, *value);
        assembly = assembly_with_rings(point, rings(assembly))?;
        let at_point = AtPoint {
            value: *value,
            scene: point,
            time,
        };
        let (solution, poses) = at_point
            .solve(&mut assembly, &mut solver, before.as_ref())
            .map_err(solving)
            .map_err(at)?;
        let cages = cage_speeds(point, time);
        let damping = (laws(&point.effects), cages.as_slice());
        let linear = LinearAssembly::passing(&assembly, &solver, &solution, damping)
            .map_err(solving)
            .map_err(at)?;
        let of_shaft = at_point.of_shaft(&linear, (&assembly, &solution), results.position);
        results.shaft.push(of_shaft.map_err(solving).map_err(at)?);
        at_point.note_bearings(&linear, &solution, &mut results);
        note_couplings(&linear, &mut results);
        if let Some(passing) = passing {
            progress.stage("ball-pass ripple");
            let place = results.position;
            let found = passing.ripple(
                (&mut assembly, &mut solver),
                (&solution, &poses),
                (place, damping),
            );
            note_ripple(found.map_err(solving).map_err(at)?, &mut results);
        }
        results
            .warnings
            .extend(unloaded(&words_of(column, *value), &assembly, &solution));
        before = Some(solution);
        progress.advance();
    }
    progress.finish();
    results.warnings.extend(felt_through(&assembly));
    note_damping(scene, &assembly, &mut results);
    Ok(results)
}

/// A point of a list, at an instant.
struct AtPoint<'a> {
    /// The swept value.
    value: Option<f64>,
    /// Its load case.
    scene: &'a SeveralScene,
    /// Time, s.
    time: f64,
}

impl AtPoint<'_> {
    /// The equilibrium, and where the parts of every bearing stand in it.
    fn solve(
        &self,
        assembly: &mut Assembly,
        solver: &mut AssemblySolver,
        before: Option<&AssemblySolution>,
    ) -> Result<(AssemblySolution, Vec<Pose>), AssemblyError> {
        load_at(self.scene, assembly, self.time)?;
        let poses = poses(&rolling_of_all(self.scene), assembly, self.time);
        let start = before.map(AssemblySolution::as_start);
        let solution = solver.solve_at(assembly, &poses, start.as_ref())?;
        Ok((solution, poses))
    }

    /// The shaft at a position, m.
    fn of_shaft(
        &self,
        linear: &LinearAssembly,
        (assembly, solution): (&Assembly, &AssemblySolution),
        position: f64,
    ) -> Result<ShaftStiffnessAt, AssemblyError> {
        let speeds = self.scene.speed.clone().unwrap_or_default();
        let speeds = Side::BOTH.map(|side| speeds.of(side).at(self.time));
        let displacement = assembly
            .shaft
            .displacement_at(position, &solution.shaft.displacements);
        Ok(ShaftStiffnessAt {
            value: self.value,
            speed: speeds[0],
            preload: assembly.preload(solution),
            stiffness: linear.of_shaft(assembly, position)?,
            damping: linear.damping_of_shaft(assembly, position)?,
            displacement,
            operating_point: ShaftOperatingPoint {
                time_s: self.time,
                speed_rad_per_s: speeds,
                shaft_displacement: displacement,
            },
            ripple: None,
        })
    }

    /// Notes the matrix of each bearing.
    fn note_bearings(
        &self,
        linear: &LinearAssembly,
        solution: &AssemblySolution,
        results: &mut SeveralStiffness,
    ) {
        let speed = self.scene.speed.as_ref();
        let speed = speed.map_or(0.0, |speed| speed.inner.at(self.time));
        for (i, bearing) in results.bearings.iter_mut().enumerate() {
            let speeds = self.scene.bearings[i].scene.speed.clone().unwrap_or_default();
            let speeds = Side::BOTH.map(|side| speeds.of(side).at(self.time));
            bearing.results.points.push(StiffnessAt {
                value: self.value,
                speed,
                stiffness: linear.stiffness[i],
                damping: linear.damping[i],
                load_stiffness: Default::default(),
                operating_point: OperatingPoint::new(&solution.bearings[i], speeds),
                ripple: None,
            });
        }
    }
}

/// Notes the ripple of all matrices of the last point.
fn note_ripple(found: RippleOfList, results: &mut SeveralStiffness) {
    if let Some(shaft) = results.shaft.last_mut() {
        shaft.ripple = Some(found.shaft);
    }
    for (bearing, ripple) in results.bearings.iter_mut().zip(found.bearings) {
        if let Some(point) = bearing.results.points.last_mut() {
            point.ripple = Some(ripple);
        }
    }
    for (coupling, ripple) in results.couplings.iter_mut().zip(found.couplings) {
        coupling.ripple.push(ripple);
    }
}

/// Says what the damping of each bearing is, and that of the shaft.
fn note_damping(scene: &SeveralScene, assembly: &Assembly, results: &mut SeveralStiffness) {
    let laws = laws(&scene.effects);
    let models = assembly.bearings.iter().map(|bearing| &bearing.model);
    for (bearing, model) in results.bearings.iter_mut().zip(models.clone()) {
        bearing.results.damping_note = damping_note(laws, [model]);
    }
    results.damping_note = damping_note(laws, models);
}

/// Notes what bearings do to each other through bodies at a point.
fn note_couplings(linear: &LinearAssembly, results: &mut SeveralStiffness) {
    for (number, coupling) in linear.couplings.iter().enumerate() {
        if number == results.couplings.len() {
            let name = |bearing: usize| results.bearings[bearing].name.clone();
            results.couplings.push(CouplingStiffness {
                loaded: name(coupling.loaded),
                moved: name(coupling.moved),
                stiffness: Vec::new(),
                damping: Vec::new(),
                ripple: Vec::new(),
            });
        }
        results.couplings[number].stiffness.push(coupling.stiffness);
        results.couplings[number].damping.push(coupling.damping);
    }
}

/// Says which bearings feel each other through a body.
fn felt_through(assembly: &Assembly) -> Vec<String> {
    let bodies = assembly.housed_together().into_iter();
    let text = |housed: HousedTogether| {
        let body = housed.name;
        let names = housed
            .bearings
            .iter()
            .map(|&i| format!("{:?}", assembly.bearings[i].name));
        format!(
            "bearings {} feel each other through body {body:?}: the matrix of each holds while the shaft stays at the \
             others, what they do to each other is in the matrix of the shaft and in \"couplings\" of stiffness.json",
            names.collect::<Vec<_>>().join(", ")
        )
    };
    bodies.map(text).collect()
}

/// Says which bearings carry nothing.
fn unloaded(at: &str, assembly: &Assembly, solution: &AssemblySolution) -> Vec<String> {
    let pairs = assembly.bearings.iter().zip(&solution.bearings);
    let is_loose =
        |found: &dynamics::StaticSolution| found.balls.iter().all(|ball| ball.inner.force_n == 0.0);
    pairs
        .filter(|(_, found)| is_loose(found))
        .map(|(bearing, _)| {
            format!(
                "{at}bearing {:?} carries nothing: its stiffness is 0",
                bearing.name
            )
        })
        .collect()
}
