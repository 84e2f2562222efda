//! Forecasts of the memory of a run, known before its first step, and what bounds it.

use std::fmt;
use std::path::Path;

use anyhow::anyhow;
use body::{BodyModes, SeatTie};
use comm::Communicator;
use contact::Side;
use dynamics::modes::{COLUMNS_PER_BALL, basis_sizes};
use dynamics::motion::Motion;
use dynamics::points::{most_ahead, points_per_start, threads_of_points};
use dynamics::statics::settings;
use dynamics::{
    Model, MotionMemory, Numbers, Prepared, RingMemory, RingModel, forecast_motion_peak, forecast_peak,
};
use rustix::process::{Resource, getrlimit};
use scene::{Analysis, Dynamic, ModeBody, Modes, Scene, StressOutput};

use crate::failure::Failure;
use crate::reduction_sizes::ReductionSizes;
use crate::seat::tied;

/// Steps between files up to which files wait for the disk.
const OFTEN: u64 = 10;
/// Steps that may wait, besides the one being made and the one being written.
pub(super) const QUEUE: usize = 1;

/// Functions of a seat as the mount of a moving ring: dofs and columns, bytes per function and node, measured.
const MOUNT_BYTES: usize = 40;

/// Memory of both rings at rest and in motion: of a rigid ring None and Some(None).
pub(crate) type RingsOfModel = ([Option<RingMemory>; 2], [Option<Option<MotionMemory>>; 2]);

/// Forecasts of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Forecasts {
    /// Statics of inner and outer ring; None is rigid, or was not solved.
    pub rings: [Option<RingMemory>; 2],
    /// Peak of the run, bytes; None where there is no forecast.
    pub peak: Option<usize>,
}

impl Forecasts {
    /// Of a run of a model at rest.
    pub fn at_rest(rings: [Option<RingMemory>; 2], (scene, model): (&Scene, &Model)) -> Forecasts {
        let peak = beside_rings(forecast_peak(rings, rings_at_once()), model);
        Forecasts {
            rings,
            peak: Some(peak + reduction_memory(scene, model)),
        }
    }

    /// Of a number of points of a model, of which several are solved at the same time.
    pub fn of_points(
        rings: [Option<RingMemory>; 2],
        (scene, model): (&Scene, &Model),
        n_points: u64,
    ) -> Forecasts {
        let peak = forecast_peak(rings, rings_at_once()) + points_bytes(rings, (scene, model), n_points);
        Forecasts {
            rings,
            peak: Some(beside_rings(peak, model) + reduction_memory(scene, model)),
        }
    }

    /// Of a motion that begins with `rings` at rest.
    pub fn of_motion(
        rings: [Option<RingMemory>; 2],
        motion: &Motion<'_>,
        (scene, dynamic): (&Scene, &Dynamic),
    ) -> Forecasts {
        let model = motion.model();
        let start = beside_rings(forecast_peak(rings, rings_at_once()), model);
        let steps = motion.memory_forecast(queued_steps(dynamic), rings_at_once());
        let with_all = |steps| beside_rings(steps, model) + reduction_memory(scene, model);
        Forecasts {
            rings,
            peak: steps.map(|steps| with_all(steps).max(start)),
        }
    }
}

/// What is held beside the rings when points are solved ahead of the one that is written, bytes: displacements of all
/// of them, load and displacements under way on every thread, and there, beyond two, the columns of a ring; and what is
/// written.
fn points_bytes(rings: [Option<RingMemory>; 2], (scene, model): (&Scene, &Model), n_points: u64) -> usize {
    bytes_of_points([(rings, model)].into_iter(), n_points) + written_bytes(scene, model, n_points)
}

/// What is held while a point is written and the next ones are solved, bytes per node of the rings, measured: fields on
/// their way to the disk, and stress that is made of them. A single point is written when the solver is done.
const WRITTEN_BYTES: usize = 100;
const STRESS_BYTES: usize = 200;

/// What points take that are written while others are solved, bytes.
pub(crate) fn written_bytes(scene: &Scene, model: &Model, n_points: u64) -> usize {
    let per_node = match (n_points, scene.output.stress) {
        (..=1, _) => 0,
        (_, StressOutput::None) => WRITTEN_BYTES,
        (_, StressOutput::Nodal | StressOutput::IntegrationPoints) => WRITTEN_BYTES + STRESS_BYTES,
    };
    let rings = model.rings.iter().flatten();
    per_node * rings.map(|ring| ring.mesh.n_nodes()).sum::<usize>()
}

/// What the points of the bearings of a list take that are solved ahead of the one that is written, bytes.
pub(crate) fn bytes_of_points<'m>(
    bearings: impl Iterator<Item = ([Option<RingMemory>; 2], &'m Model)> + Clone,
    n_points: u64,
) -> usize {
    let n_threads = threads_of_points();
    if n_threads == 1 || bearings.clone().any(|(_, model)| points_per_start(model) == 1) {
        return 0;
    }
    let after_first = usize::try_from(n_points.saturating_sub(1)).unwrap_or(usize::MAX);
    let (ahead, at_once) = (most_ahead(n_threads).min(after_first), n_threads.min(after_first));
    let flexible = bearings
        .clone()
        .flat_map(|(_, model)| model.rings.iter().flatten());
    let field: usize = flexible.map(|ring| size_of::<f64>() * ring.mesh.n_dofs()).sum();
    let columns = bearings
        .flat_map(|(rings, _)| rings.into_iter().flatten())
        .map(|ring| ring.columns.saturating_sub(ring.kept))
        .max();
    (ahead + 2 * at_once) * field + at_once.saturating_sub(2) * columns.unwrap_or(0)
}

/// The peak of rings with the surfaces of the model. Where these are made they are held three times, before the rings
/// are there. Good to a quarter: 353 MB measured for 290 at rest, 234 MB for 282 in motion.
fn with_surfaces(rings: usize, model: &Model) -> usize {
    let surfaces = model.surfaces.bytes();
    rings.max(2 * surfaces) + surfaces
}

/// Forecast of the largest resident memory until there is an equilibrium, and in the steps of a motion, bytes. Of each
/// ring `motion` has Some(None) when it is rigid and None when its steps are not forecast.
pub fn forecast(
    (scene, model): (&Scene, &Model),
    rings: [Option<RingMemory>; 2],
    motion: [Option<Option<MotionMemory>>; 2],
) -> (usize, Option<usize>) {
    let analysis = &scene.analysis;
    let steps = match (analysis, motion) {
        (Analysis::Dynamic(dynamic), [Some(inner), Some(outer)]) => {
            let queued = queued_steps(dynamic);
            let steps = forecast_motion_peak([inner, outer], queued, rings_at_once());
            Some(beside_rings(steps, model))
        }
        _ => None,
    };
    let points = match analysis {
        Analysis::Sweep(sweep) => sweep.points.len() as u64,
        Analysis::QuasiStatic(quasi) => 1 + quasi.n_steps,
        Analysis::Static | Analysis::Dynamic(_) | Analysis::Modes(_) => 1,
    };
    let rest = forecast_peak(rings, rings_at_once()) + points_bytes(rings, (scene, model), points);
    let rest = beside_rings(rest, model).max(match analysis {
        Analysis::Modes(wanted) => forecast_modes(wanted, (scene, model), rings),
        _ => 0,
    });
    let peaks = (rest, steps);
    with_reduction(peaks, analysis, reduction_memory(scene, model))
}

/// Forecast of the largest resident memory of the search for natural modes, bytes: factor, stiffness and mass of what
/// vibrates, the vectors of the search, its restart included, four blocks of a vector per ball for the contacts of a
/// bearing and their patches, and what is written. Measured: -6 to +5 %.
fn forecast_modes(wanted: &Modes, (scene, model): (&Scene, &Model), rings: [Option<RingMemory>; 2]) -> usize {
    let n_balls = model.geometry.n_balls;
    let [alone, bearing] = basis_sizes(wanted.number, n_balls);
    let of_rings = |sides: &[Side], n_vectors: usize| {
        let matrices = sides.iter().filter_map(|side| rings[side.index()]);
        let n_dofs = |side: &Side| model.ring(*side).map_or(0, |ring| ring.mesh.n_dofs());
        let vectors = size_of::<f64>() * n_vectors * sides.iter().map(n_dofs).sum::<usize>();
        vectors + matrices.map(searched_bytes).sum::<usize>()
    };
    let of_body = |body: &ModeBody| match body {
        ModeBody::Inner => of_rings(&Side::BOTH[..1], 2 * alone),
        ModeBody::Outer => of_rings(&Side::BOTH[1..], 2 * alone),
        ModeBody::Bearing => {
            of_rings(&Side::BOTH, 2 * bearing + COLUMNS_PER_BALL * n_balls) + tied_bytes(model)
        }
    };
    let meshes: usize = rings.iter().flatten().map(|ring| ring.mesh).sum();
    let search = wanted.bodies.iter().map(of_body).max().unwrap_or(0);
    let written = written_bytes(scene, model, wanted.number as u64);
    with_bodies(
        forecast_peak([None, None], 1) + meshes + search + written,
        [model],
    )
}

/// Factor, stiffness and mass of a ring in the search for modes, and what is written of it, bytes.
pub(crate) fn searched_bytes(ring: RingMemory) -> usize {
    ring.kept + ring.assembly + ring.results
}

/// Copies of a block of vectors that a ring in a body takes at a time, beside those of all rings, measured.
const TIED_BLOCKS: usize = 8;

/// What rings in bodies take in the search for modes on the way through the joint, bytes: blocks of vectors.
pub(crate) fn tied_bytes(model: &Model) -> usize {
    let rings = Side::BOTH.into_iter().filter_map(|side| tied(model, side));
    let n_dofs: usize = rings.map(|(ring, _)| ring.mesh.n_dofs()).sum();
    TIED_BLOCKS * model.geometry.n_balls * n_dofs * size_of::<f64>()
}

/// Peaks at rest and in the steps of a motion, with what `[output.reduction]` takes. A motion is reduced in its steps.
pub(crate) fn with_reduction(
    (rest, steps): (usize, Option<usize>),
    analysis: &Analysis,
    reduction: usize,
) -> (usize, Option<usize>) {
    match analysis {
        Analysis::Dynamic(_) => (rest, steps.map(|steps| steps + reduction)),
        _ => (rest + reduction, steps),
    }
}

/// What `[output.reduction]` of a scene takes while a run goes on, bytes: what is known, and for each step on its way
/// to the disk the numbers of the file and a state where there are some. Of a step that is made there are two states,
/// what was known and its arrays; with files that wait, one more waits with the caller. Measured: -7 to +11 %, on slow
/// disks too.
pub(crate) fn reduction_memory(scene: &Scene, model: &Model) -> usize {
    let Some(sizes) = ReductionSizes::new(scene, model) else {
        return 0;
    };
    let file = size_of::<f64>() * sizes.file_numbers();
    let under_way = match &scene.analysis {
        Analysis::Dynamic(dynamic) => {
            let queued = queued_steps(dynamic);
            (2 + 3 * queued) * sizes.state() + (1 + queued) * file
        }
        Analysis::QuasiStatic(_) => 2 * sizes.state() + file,
        Analysis::Static | Analysis::Sweep(_) | Analysis::Modes(_) => file,
    };
    sizes.known() + under_way
}

/// The peak of rings with what is there besides.
fn beside_rings(rings: usize, model: &Model) -> usize {
    with_bodies(with_surfaces(rings, model), [model])
}

/// The peak of the rest with the bodies of the rings of some bearings. They are made before it, one after the other.
pub(crate) fn with_bodies<'m>(rest: usize, models: impl IntoIterator<Item = &'m Model>) -> usize {
    let (mut kept, mut making, mut left) = (0, 0, 0);
    let models = models.into_iter();
    let ties = models.flat_map(|model| Side::BOTH.into_iter().filter_map(|side| tied(model, side)));
    for (ring, tie) in ties {
        kept += joint_bytes(ring, tie);
        // A body that carries several bearings is made once.
        let Some(body) = tie.body.as_ref().filter(|_| tie.seat == 0) else {
            continue;
        };
        let modes = tie.modes.as_ref().map(|modes| &*modes.of_body);
        kept += body.kept_bytes() + modes.map_or(0, BodyModes::bytes);
        let made = body.making_bytes(modes, rings_at_once());
        making = making.max(made.most());
        left += made.left;
    }
    kept + (rest + left).max(match making {
        0 => 0,
        making => making + forecast_peak([None, None], 1),
    })
}

/// The functions of a seat on the side of its ring, at rest and as the mount of a ring that moves, and the matrices of
/// the joint.
fn joint_bytes(ring: &RingModel, tie: &SeatTie) -> usize {
    let (nodes, n) = (
        ring.mesh.group_nodes(ring.held_group).len(),
        tie.space.basis.n_functions(),
    );
    let at_rest = n * nodes * size_of::<f64>() + body::joint_bytes(n);
    match tie.modes {
        Some(_) => at_rest + MOUNT_BYTES * n * nodes,
        None => at_rest,
    }
}

/// More memory than a ring takes for each of its nodes, bytes: five times that of a sparse factor of 17 k nodes.
pub(crate) const MOST_PER_NODE: u64 = 50_000;

/// Fails if a run of this model, of which nothing is factored yet, needs more memory than there is for it by its
/// forecast. That is made only where memory may be short: it costs the analysis of the matrices.
pub fn require_memory(scene: &Scene, model: &Model) -> Result<(), Failure> {
    let n_nodes: usize = model.rings.iter().flatten().map(|ring| ring.mesh.n_nodes()).sum();
    let short = bound().filter(|bound| bound.bytes < MOST_PER_NODE * n_nodes as u64);
    let Some(bound) = short.filter(|_| Communicator::world().size() == 1) else {
        return Ok(());
    };
    let (statics, motion) = rings_of(model)?;
    let (start, steps) = forecast((scene, model), statics, motion);
    require(steps.unwrap_or(0).max(start), bound)
}

/// Memory of the rings of a model at rest and in motion, of which nothing is factored yet.
pub(crate) fn rings_of(model: &Model) -> Result<RingsOfModel, Failure> {
    let (mut statics, mut motion) = ([None; 2], [Some(None); 2]);
    for side in Side::BOTH {
        let Some(ring) = model.ring(side) else { continue };
        let prepared = Prepared::new(ring, settings(model, side), Numbers::Pattern);
        let stiffness = prepared.map_err(Failure::solving)?.stiffness;
        statics[side.index()] = Some(stiffness.memory());
        motion[side.index()] = stiffness.motion().map(Some);
    }
    Ok((statics, motion))
}

/// Fails if a peak, bytes, is more than there may be.
pub(crate) fn require(peak: usize, bound: Bound) -> Result<(), Failure> {
    let peak = peak as u64;
    allocator::expect(peak);
    if peak <= bound.bytes {
        return Ok(());
    }
    Err(Failure::User(anyhow!(
        "the run needs about {} MB of memory with --threads {} by its forecast; expected at most {bound}; use a \
         coarser mesh, fewer --threads or more memory",
        peak / 1_000_000,
        rayon::current_num_threads()
    )))
}

/// What bounds the memory of this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bound {
    /// Memory, bytes.
    pub bytes: u64,
    /// What has so much.
    pub of: &'static str,
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} MB, {}", self.bytes / 1_000_000, self.of)
    }
}

/// The least of the limit of the address space, that of the control groups (version 2) and the machine's memory.
pub fn bound() -> Option<Bound> {
    let read = |path: &str| std::fs::read_to_string(path).unwrap_or_default();
    let groups = || of_groups(Path::new("/sys/fs/cgroup"), &read("/proc/self/cgroup"));
    let address_space = getrlimit(Resource::As).current;
    let machine = of_machine(&read("/proc/meminfo"));
    let bounds = [
        (address_space, "the limit of the address space (ulimit -v)"),
        (groups(), "the limit of the control group (container or job)"),
        (machine, "the memory of this machine"),
    ];
    let bounds = bounds.map(|(bytes, of)| bytes.map(|bytes| Bound { bytes, of }));
    bounds.into_iter().flatten().min_by_key(|bound| bound.bytes)
}

/// The least limit of a group, as `/proc/self/cgroup` names it, and of those above it.
fn of_groups(root: &Path, named: &str) -> Option<u64> {
    let path = named.lines().find_map(|line| line.strip_prefix("0::/"))?;
    let folder = root.join(path);
    let above = folder.ancestors().take_while(|folder| folder.starts_with(root));
    let limit = |folder: &Path| {
        let text = std::fs::read_to_string(folder.join("memory.max")).ok()?;
        text.trim().parse().ok()
    };
    above.filter_map(limit).min()
}

/// Memory and swap of the machine, as `/proc/meminfo` lists them in kB.
fn of_machine(listed: &str) -> Option<u64> {
    let kilobytes = |key: &str| {
        let value = listed.lines().find_map(|line| line.strip_prefix(key))?;
        value.split_whitespace().next()?.parse::<u64>().ok()
    };
    Some(1024 * (kilobytes("MemTotal:")? + kilobytes("SwapTotal:").unwrap_or(0)))
}

/// Steps of a motion that wait to be written at a time.
pub fn queued_steps(dynamic: &Dynamic) -> usize {
    if dynamic.output_every <= OFTEN { QUEUE } else { 0 }
}

/// Number of threads that make rings: ranks make one after the other.
pub(crate) fn rings_at_once() -> usize {
    match Communicator::world().size() {
        1 => rayon::current_num_threads(),
        _ => 1,
    }
}

/// Least address space, bytes: the libraries reserve some before the first ring is read, and end the program
/// where they get none.
const LEAST_ADDRESS_SPACE: u64 = 320_000_000;

/// Fails if the system gives this process too little address space for any work.
pub fn require_address_space() -> Result<(), Failure> {
    let limit = getrlimit(Resource::As).current;
    match limit.filter(|&limit| limit < LEAST_ADDRESS_SPACE) {
        None => Ok(()),
        Some(limit) => Err(Failure::User(anyhow!(
            "the address space of this process is limited to {} MB; expected at least {} MB and the memory that \
             raceway check forecasts, see ulimit -v",
            limit / 1_000_000,
            LEAST_ADDRESS_SPACE / 1_000_000
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a job whose group has less memory than the machine would be killed without a word.
    #[test]
    fn the_least_limit_of_the_groups_counts() {
        let root = tempfile::tempdir().unwrap();
        let job = root.path().join("job/step");
        std::fs::create_dir_all(&job).unwrap();
        std::fs::write(job.join("memory.max"), "max\n").unwrap();
        let limit = || of_groups(root.path(), "1:name=systemd:/other\n0::/job/step\n");
        assert_eq!(limit(), None);
        std::fs::write(root.path().join("job/memory.max"), "4096\n").unwrap();
        std::fs::write(root.path().join("memory.max"), "8192\n").unwrap();
        assert_eq!(limit(), Some(4096));
        assert_eq!(of_groups(root.path(), "4:memory:/job\n"), None);
        assert_eq!(
            of_machine("MemTotal: 3 kB\nMemFree: 1 kB\nSwapTotal: 2 kB\n"),
            Some(5120)
        );
        assert_eq!(of_machine(""), None);
    }
}
