//! What only whole meshes tell, found before ranks divide them, and the model that is left.
//!
//! Alone, this process reads both meshes and keeps them. Where ranks share rings in sectors, rank 0 alone reads and
//! checks them, finds the probes, writes the content of `mesh.hdf` to the disk and sends each rank its part; then it
//! lets go of the whole.

use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;
use checkpoint::MeshFile;
use comm::{Communicator, print};
use contact::Side;
use dynamics::{Model, RingModel, Sectors};
use scene::{Scene, build_model, difference, doubts, material, model_with_rings, ring_of};

use crate::about::identity;
use crate::failure::{Failure, agree};
use crate::fields;
use crate::memory::require_memory;
use crate::probes::PlacedProbes;
use crate::region::Region;

/// What only whole meshes tell of a run.
#[derive(Default)]
pub struct Survey {
    /// The probes of the scene, if it has some; where ranks share rings, on rank 0 only.
    pub probes: Option<PlacedProbes>,
    /// What is most likely a slip in the scene; where ranks share rings, on rank 0 only.
    pub doubts: Vec<String>,
    /// The region in which fields are kept, if the scene has one; where ranks share rings, on rank 0 only.
    pub region: Option<Region>,
    /// The content of `mesh.hdf` where the model will not have all of it, on rank 0.
    pub mesh: Option<MeshFile>,
}

impl Survey {
    /// That of a part of a run, whose meshes are whole: where its fields are kept.
    pub fn of_part(scene: &Scene, model: &Model) -> Result<Survey, Failure> {
        Ok(Survey {
            region: Region::new(scene, model)?,
            ..Survey::default()
        })
    }
}

/// The model of a scene (a point of `scene` when that is a sweep) with results in `dir`, and its survey, if a last
/// test of the whole passes. Collective.
pub fn build_surveyed(
    point: &Scene,
    scene: &Scene,
    dir: &Path,
    test: impl FnOnce(&Model) -> Result<(), Failure>,
) -> Result<(Model, Survey), Failure> {
    let comm = Communicator::world();
    require_same_scene(&scene.text)?;
    if comm.size() > 1 && point.solver.backend.divides_rings() {
        return build_shared(point, scene, dir, test);
    }
    let (mut model, survey) = whole(point, scene, test)?;
    if let Some(sectors) = model.backend.sectors() {
        for side in Side::BOTH {
            let divided = take(&mut model, side).map(|ring| ring.divide(side.name(), sectors));
            model.rings[side.index()] = divided.transpose().map_err(Failure::solving)?.map(Arc::new);
        }
    }
    Ok((model, survey))
}

/// The model of whole meshes and their survey.
fn whole(
    point: &Scene,
    scene: &Scene,
    test: impl FnOnce(&Model) -> Result<(), Failure>,
) -> Result<(Model, Survey), Failure> {
    let (model, tags) = build_model(point)?;
    let doubts = doubts(point, &model);
    say_doubts(&doubts);
    let probes = PlacedProbes::new(scene, &model, &tags)?;
    let region = Region::new(scene, &model)?;
    test(&model)?;
    require_memory(scene, &model)?;
    let survey = Survey {
        probes,
        doubts,
        region,
        mesh: None,
    };
    Ok((model, survey))
}

/// Says what is most likely a slip, before a run begins.
pub fn say_doubts(doubts: &[String]) {
    for doubt in doubts {
        print::note(format_args!("warning: {doubt}"));
    }
}

fn take(model: &mut Model, side: Side) -> Option<RingModel> {
    let ring = model.rings[side.index()].take()?;
    Some(Arc::into_inner(ring).expect("nobody else has a ring of a new model"))
}

/// The same where rank 0 reads for all.
fn build_shared(
    point: &Scene,
    scene: &Scene,
    dir: &Path,
    test: impl FnOnce(&Model) -> Result<(), Failure>,
) -> Result<(Model, Survey), Failure> {
    let comm = Communicator::world();
    let survey = || {
        let (model, survey) = whole(point, scene, test)?;
        let mesh = MeshFile::new(&fields::bodies(&model))?.of_run(identity(scene)?);
        let mesh = mesh.spooled(dir)?;
        let mesh = Some(mesh);
        Ok((model, Survey { mesh, ..survey }))
    };
    let read: Result<Option<(Model, Survey)>, Failure> = match comm.is_root() {
        true => survey().map(Some),
        false => Ok(None),
    };
    let (mut model, survey) = agree(read)?.unzip();
    let steel = material(&point.materials.rings)?;
    let sectors = Sectors {
        n_sectors: point.solver.sectors,
        comm,
    };
    let mut rings = [None, None];
    for (side, body) in Side::BOTH.into_iter().zip([&point.inner.body, &point.outer.body]) {
        if body.is_none() {
            continue;
        }
        let known = survey.as_ref().and_then(|survey: &Survey| survey.probes.as_ref());
        let more = known.map_or(Vec::new(), |probes| probes.nodes(side));
        let whole = model.as_mut().and_then(|model| take(model, side));
        let dealt = RingModel::deal(whole, side.name(), sectors, &more, |mesh| {
            ring_of(point, side, steel, mesh).expect("a ring with a mesh file is flexible")
        });
        rings[side.index()] = Some(Arc::new(dealt.map_err(Failure::solving)?));
    }
    let model = match model {
        Some(model) => Model { rings, ..model },
        None => model_with_rings(point, rings)?,
    };
    Ok((model, survey.unwrap_or_default()))
}

/// Fails unless all ranks have the scene of rank 0: all compute the same. Collective.
pub fn require_same_scene(text: &str) -> Result<(), Failure> {
    let comm = Communicator::world();
    let of_root = comm.from_root(text.as_bytes().to_vec());
    let compare = || {
        let differences = difference(&String::from_utf8_lossy(&of_root), text)?;
        match differences.first() {
            None => Ok(()),
            Some(first) => Err(Failure::User(anyhow!(
                "the scene of rank {} is not that of rank 0: {first}; all ranks must be started with one scene",
                comm.rank()
            ))),
        }
    };
    agree(compare())
}
