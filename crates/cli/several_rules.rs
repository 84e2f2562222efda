//! Rules of thumb for a list of bearings: what is said of one bearing, of each under the part of the loads that it
//! carries with rigid rings.

use assembly::{Assembly, AssemblyError, AssemblySolver};
use comm::print;
use dynamics::effects::rules::{PeakLoad, Remark};
use results::failure::Failure;
use scene::{Analysis, SeveralScene, assembly_with_rings};

use crate::rules;
use crate::several_instant::{load_at, poses, rolling_of_all};

/// What the rules of thumb say of the bearings of a list: a sentence each, once for all bearings that it is said of.
/// Effects are those of all bearings: one that is off is judged where it brings most, and one that is on is idle only
/// where it is in all. Nothing is said of loads where rigid rings have no equilibrium.
pub fn advice(scene: &SeveralScene, assembly: &Assembly) -> Result<Vec<String>, Failure> {
    let loads = loads_with_rigid_rings(scene).unwrap_or_default();
    let changes = scene.effects.are_scheduled();
    let mut said: Vec<Shared<'_>> = Vec::new();
    for (i, (bearing, mounted)) in scene.bearings.iter().zip(&assembly.bearings).enumerate() {
        let load = loads.get(i).copied().unwrap_or_default();
        for remark in rules::remarks_on_shaft(&bearing.scene, &mounted.model, load, changes)? {
            match said.iter_mut().find(|said| said.is_of(&remark)) {
                Some(said) => said.add(remark, &bearing.name),
                None => said.push(Shared::new(remark, &bearing.name)),
            }
        }
    }
    let n = scene.bearings.len();
    Ok(said.iter().filter_map(|said| said.sentence(n)).collect())
}

/// A remark, the bearings that it is made of in these words, and how many it is made of in any.
struct Shared<'a> {
    remark: Remark,
    names: Vec<&'a str>,
    n: usize,
}

impl<'a> Shared<'a> {
    fn new(remark: Remark, name: &'a str) -> Shared<'a> {
        Shared {
            remark,
            names: vec![name],
            n: 1,
        }
    }

    /// Whether another remark is the same, or judges the same.
    fn is_of(&self, remark: &Remark) -> bool {
        match (&self.remark.verdict, &remark.verdict) {
            (Some(own), Some(other)) => (&own.key, own.is_on) == (&other.key, other.is_on),
            _ => self.remark == *remark,
        }
    }

    /// Takes the same remark on another bearing: of verdicts the one of the larger ratio stays.
    fn add(&mut self, remark: Remark, name: &'a str) {
        self.n += 1;
        if remark.text == self.remark.text {
            self.names.push(name);
            return;
        }
        let ratio = |remark: &Remark| remark.verdict.as_ref().map_or(0.0, |v| v.ratio);
        if ratio(&remark) > ratio(&self.remark) {
            (self.remark, self.names) = (remark, vec![name]);
        }
    }

    /// The sentence, with the names of its bearings where it is not in these words of all `n`; None: it is not to be
    /// said, as what idles in some bearings serves others.
    fn sentence(&self, n: usize) -> Option<String> {
        let is_idle = self.remark.verdict.as_ref().is_some_and(|v| v.is_on);
        if is_idle && self.n < n {
            return None;
        }
        let text = &self.remark.text;
        Some(match self.names.len() == n {
            true => text.clone(),
            false => format!("bearing {}: {text}", quoted(&self.names)),
        })
    }
}

/// The same, said before a run begins.
pub fn say(scene: &SeveralScene, assembly: &Assembly) -> Result<Vec<String>, Failure> {
    let advice = advice(scene, assembly)?;
    for line in &advice {
        print::note(format_args!("advice: {line}"));
    }
    Ok(advice)
}

fn quoted(names: &[&str]) -> String {
    let each: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
    each.join(", ")
}

/// The largest loads of the shaft on every bearing whose rings are rigid, at the start and the end; None where there is
/// no equilibrium.
fn loads_with_rigid_rings(scene: &SeveralScene) -> Option<Vec<PeakLoad>> {
    let mut scene = scene.clone();
    // Friction of free balls changes no load by what counts here, and their equilibria take long.
    for bearing in &mut scene.bearings {
        bearing.scene.effects.traction = None;
    }
    let rings = scene.bearings.iter().map(|_| [None, None]).collect();
    let mut assembly = assembly_with_rings(&scene, rings).ok()?;
    let mut solver = AssemblySolver::new(&assembly).ok()?;
    let mut times = vec![0.0, end(&scene.analysis)];
    times.dedup();
    let mut loads = vec![PeakLoad::default(); assembly.bearings.len()];
    for time in times {
        let found = at(&scene, &mut assembly, &mut solver, time).ok()?;
        for (peak, load) in loads.iter_mut().zip(found) {
            peak.axial = peak.axial.max(load.axial);
            peak.radial = peak.radial.max(load.radial);
        }
    }
    Some(loads)
}

/// Loads of the shaft on the bearings at a time, s.
fn at(
    scene: &SeveralScene,
    assembly: &mut Assembly,
    solver: &mut AssemblySolver,
    time: f64,
) -> Result<Vec<PeakLoad>, AssemblyError> {
    load_at(scene, assembly, time)?;
    let poses = poses(&rolling_of_all(scene), assembly, time);
    let found = solver.solve_at(assembly, &poses, None)?;
    let load = |[x, y, z, ..]: [f64; 5]| PeakLoad {
        axial: z.abs(),
        radial: x.hypot(y),
        spring: 0.0,
    };
    Ok(found.bearings.iter().map(|b| load(b.shaft_reaction)).collect())
}

/// End of a course in time, s; 0 of an analysis at rest.
fn end(analysis: &Analysis) -> f64 {
    match analysis {
        Analysis::Dynamic(dynamic) => dynamic.n_steps as f64 * dynamic.step,
        Analysis::QuasiStatic(settings) => settings.n_steps as f64 * settings.step,
        _ => 0.0,
    }
}
