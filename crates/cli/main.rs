//! The program `raceway`: rolling bearings whose two rings are finite-element bodies.
//!
//! Exit codes: 0 finished, 2 wrong input, 3 no solution found, 75 stopped early with a step to resume
//! from.

mod bodies;
mod campbell;
mod campbell_files;
mod check;
mod cycles;
mod damping;
mod export;
mod help;
mod info;
mod init;
mod instants;
mod ledger_check;
mod linear_figures;
mod load_matrix;
mod mesh_command;
mod modes;
mod motion;
mod options;
mod pack;
mod periodic_gain;
mod points_ahead;
mod progress;
mod quasi_static;
mod rank_table;
mod remarks;
mod resume;
mod ring_sizes;
mod rules;
mod run;
mod several;
mod several_campbell;
mod several_check;
mod several_export;
mod several_files;
mod several_info;
mod several_instant;
mod several_ledger;
mod several_modes;
mod several_motion;
mod several_quasi_end;
mod several_quasi_state;
mod several_quasi_static;
mod several_read;
mod several_ready;
mod several_rest;
mod several_resume;
mod several_ripple;
mod several_rules;
mod several_state;
mod several_stiffness;
mod shared;
mod start;
mod stiffness;
mod stored;

use std::ffi::OsString;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use comm::print::Manner;
use comm::{Communicator, Environment, ProcessEnd, print};
use heat::HeatCommand;
use life::LifeCommand;
use plot::Plot;
use report::Report;
use results::failure::{Failure, agree, say_of_rank};
use results::memory::require_address_space;
use results::summary::peak_memory;
use results::{answer, log};
use spectrum::{SpallLengthCommand, SpectrumCommand};

use crate::campbell::CampbellCommand;
use crate::cycles::Cycles;
use crate::export::Export;
use crate::info::Inspection;
use crate::init::Init;
use crate::load_matrix::{BallLoadsCommand, LoadMatrixCommand};
use crate::mesh_command::MeshCommand;
use crate::options::{Limits, SweepPart, parse_part};
use crate::pack::Pack;
use crate::resume::ResumeRequest;
use crate::stiffness::StiffnessCommand;

/// Options of all commands stand behind those of a command in its help.
const LAST_OPTIONS: usize = 900;

/// Simulates angular contact ball bearings with fully flexible rings.
#[derive(Debug, Parser)]
#[command(
    name = "raceway",
    version,
    arg_required_else_help = true,
    disable_help_subcommand = true
)]
struct Arguments {
    /// Number of threads; default: RACEWAY_THREADS, or all cores. Results do not depend on it.
    #[arg(long, global = true, display_order = LAST_OPTIONS)]
    threads: Option<usize>,
    /// Answers with one line of JSON on standard output; all else that is said goes to standard error.
    #[arg(long, global = true, display_order = LAST_OPTIONS)]
    json: bool,
    /// Says nothing about how it goes but warnings and errors.
    #[arg(long, global = true, display_order = LAST_OPTIONS)]
    quiet: bool,
    /// Ends with the process of this number, which started this one.
    #[arg(long, global = true, hide = true)]
    parent: Option<i32>,
    #[command(subcommand)]
    command: Command,
}

#[global_allocator]
static ALLOCATOR: allocator::Ending = allocator::Ending;

/// Most threads that can be asked for: more than any machine has cores.
const MOST_THREADS: usize = 4096;
/// Environment variable with the number of threads.
const THREADS: &str = "RACEWAY_THREADS";

#[derive(Debug, Subcommand)]
enum Command {
    /// Writes a commented scene of a bearing to start from: a designation, or its main dimensions.
    Init(Init),
    /// Runs a scene and writes its results.
    Run {
        /// Scene file.
        scene: PathBuf,
        /// Changes a value of the scene: path=value, such as effects.axial_force.value="3 kN".
        #[arg(long = "set", value_name = "PATH=VALUE")]
        overrides: Vec<String>,
        /// Folder of the results; default: results/ and the scene's name.
        #[arg(long)]
        out: Option<PathBuf>,
        /// Solves only these points of a sweep, the first from its own start: a number, or first-last, such as 0-9.
        #[arg(long, value_name = "POINTS", value_parser = parse_part)]
        points: Option<SweepPart>,
        #[command(flatten)]
        limits: Limits,
    },
    /// Goes on with a run over time from its newest whole step, to the same bits as if it had not been interrupted.
    Resume(ResumeRequest),
    /// Says what a result folder, a step file or a mesh file holds.
    Info {
        /// Result folder, or a file in it.
        path: PathBuf,
        /// Reads and checks every byte of a folder's step files.
        #[arg(long)]
        verify: bool,
    },
    /// Puts finished steps into larger files, or takes them out again.
    Pack(Pack),
    /// Counts the stress cycles of probes: amplitude, mean and rain-flow.
    Cycles(Cycles),
    /// Writes steps in a form for other tools.
    Export(Export),
    /// Draws figures of a run from its tables and step files.
    Plot(Plot),
    /// Writes one HTML page of a run: scene, numbers, figures, energy, cost, warnings.
    Report(Report),
    /// Spectrum of a signal of a motion, with the lines of the bearing: amplitudes, power density or envelope.
    Spectrum(SpectrumCommand),
    /// How long a spall is, from the motion of the shaft as balls pass it.
    SpallLength(SpallLengthCommand),
    /// What the strain gauges of a scene read under a unit load of each ball.
    LoadMatrix(LoadMatrixCommand),
    /// Ball loads from what the strain gauges of a run have read, by a load matrix.
    BallLoads(BallLoadsCommand),
    /// Ratings of a bearing, and its life under the forces of a run or of a load spectrum.
    Life(LifeCommand),
    /// Steady temperatures from friction and given conductances, with what they do to clearance and forces.
    Heat(HeatCommand),
    /// Stiffness and damping of the shaft on its bearing, at the operating point or at every point of a sweep.
    Stiffness(StiffnessCommand),
    /// Modes of the shaft on its bearing over its speed, forward and backward, with damping: Campbell diagram.
    Campbell(CampbellCommand),
    /// Builds everything a run needs but solves nothing: effects, sizes, memory, output.
    Check {
        /// Scene file.
        scene: PathBuf,
        /// Changes a value of the scene.
        #[arg(long = "set", value_name = "PATH=VALUE")]
        overrides: Vec<String>,
    },
    /// Runs a grid of settings of a scene and tables errors and costs.
    Study(study::StudyRequest),
    /// Says which settings of a study reach an error at the lowest cost.
    Advise(study::Question),
    /// Turns every effect of a scene off or on and tables what that changes and costs.
    Prices(study::prices::PricesRequest),
    /// Becomes Gmsh, which then ends with the process that started this one.
    #[command(hide = true)]
    Gmsh {
        /// Arguments of Gmsh.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Says more of a command; `help scene` has every table and key of scenes, `help scene KEY` some of them.
    Help {
        /// A command, or scene and a table or key, such as bearing, shaft.z or contact_angle.
        topic: Vec<String>,
    },
    /// Prints completions of a shell: bash, zsh, fish, elvish or powershell.
    Completions {
        /// The shell; its manual says where completions are put.
        shell: clap_complete::Shell,
    },
    /// Prints the man page: raceway man > raceway.1. With --out writes it and those of all commands.
    Man {
        /// Folder of the pages raceway.1, raceway-run.1 and so on; it is made, pages in it are replaced.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Builds the ring meshes that a scene describes, or the periodic mesh of a ring that has a free one; needs Gmsh.
    Mesh(MeshCommand),
}

fn main() -> ExitCode {
    let matches = Arguments::command().get_matches();
    let name = matches.subcommand_name().unwrap_or_default().to_string();
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    if let Command::Gmsh { arguments: given } = &arguments.command {
        return become_gmsh(arguments.parent, given);
    }
    match &arguments.command {
        Command::Help { topic } => return help::help(topic, Arguments::command()),
        Command::Completions { shell } => return help::completions(*shell, Arguments::command()),
        Command::Man { out: None } => return help::man(Arguments::command()),
        Command::Man { out: Some(out) } => return help::pages(Arguments::command(), out),
        _ => {}
    }
    let is_answer_only = arguments.json;
    print::set_manner(Manner {
        is_answer_only,
        is_quiet: arguments.quiet,
    });
    let environment = match Environment::start() {
        Ok(environment) => environment,
        Err(error) => {
            let failure = Failure::from(error);
            print::note(format_args!("{}: {}", failure.kind(), failure.text()));
            return ExitCode::from(failure.number());
        }
    };
    if matches!(arguments.command, Command::Run { .. } | Command::Resume(_))
        && Communicator::world().is_root()
    {
        // A path need not be UTF-8.
        let arguments = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned());
        log::keep(&arguments.collect::<Vec<_>>());
    }
    let failure = execute(arguments).err();
    let end = environment.finish(failure.is_none());
    if is_answer_only {
        answer::say(&name, failure.as_ref());
    }
    let Some(failure) = failure.or_else(Failure::unwritten) else {
        log::end(None);
        return ExitCode::SUCCESS;
    };
    let comm = Communicator::world();
    if end == ProcessEnd::Alone {
        say_of_rank(&failure);
        environment.abort(failure.number());
    }
    match comm.has_failed_alone() && comm.is_root() {
        true => say_of_rank(&failure),
        false => print::note(format_args!("{}: {}", failure.kind(), failure.text())),
    }
    log::end(Some(&failure));
    ExitCode::from(failure.number())
}

/// Runs Gmsh in the place of this program; returns only if it cannot.
fn become_gmsh(parent: Option<i32>, arguments: &[OsString]) -> ExitCode {
    let failed = match parent.map_or(Ok(()), results::stop::end_with) {
        Ok(()) => anyhow::Error::from(std::process::Command::new("gmsh").args(arguments).exec()),
        Err(error) => error,
    };
    match failed.downcast_ref::<std::io::Error>().map(std::io::Error::kind) {
        Some(std::io::ErrorKind::NotFound) => ExitCode::from(mesh::NO_GMSH),
        _ => {
            print::from_any_rank(format_args!("{failed:#}"));
            ExitCode::FAILURE
        }
    }
}

/// Several ranks only do runs together.
fn require_one_task(command: &Command) -> Result<(), Failure> {
    let ranks = Communicator::world().size();
    let runs = matches!(command, Command::Run { .. } | Command::Resume(_));
    if ranks == 1 || runs {
        return Ok(());
    }
    Err(Failure::User(anyhow::anyhow!(
        "the launcher started {ranks} tasks, but only raceway run and raceway resume are shared by several; start one \
         task"
    )))
}

/// The number of threads that is asked for: by the command line, or else by the environment; none: all cores.
fn wanted_threads(given: Option<usize>) -> Result<Option<usize>, Failure> {
    let (name, threads) = match (given, std::env::var_os(THREADS)) {
        (Some(threads), _) => ("--threads", Ok(threads)),
        (None, Some(text)) => {
            let text = text.to_string_lossy().into_owned();
            (THREADS, text.trim().parse().map_err(|_| text))
        }
        (None, None) => return Ok(None),
    };
    let (shown, expected) = match threads {
        Ok(0) => ("0".to_string(), "at least 1".to_string()),
        Ok(threads) if threads > MOST_THREADS => (threads.to_string(), format!("at most {MOST_THREADS}")),
        Ok(threads) => return Ok(Some(threads)),
        Err(text) => (
            format!("{text:?}"),
            "a whole number of threads such as 4".to_string(),
        ),
    };
    Err(Failure::User(anyhow::anyhow!(
        "{name} is {shown}; expected {expected}"
    )))
}

/// Starts the threads that share the work; all cores have one unless a number is given.
fn start_threads(threads: Option<usize>) -> Result<(), Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0));
    agree(pool.build_global().map_err(|error| {
        let remedy = "use fewer with --threads, or allow more address space or processes (ulimit -v, -u)";
        Failure::User(anyhow::anyhow!(
            "the system gives too few threads ({error}); {remedy}"
        ))
    }))
}

/// Says what each of several ranks has needed.
fn say_memory_of_ranks() {
    let comm = Communicator::world();
    if comm.size() == 1 {
        return;
    }
    let peaks = comm.all_gather(vec![peak_memory() as f64], &vec![1; comm.size()]);
    let peaks: Vec<String> = peaks.iter().map(|bytes| format!("{:.0}", bytes / 1e6)).collect();
    print::line(format_args!("peak memory of the ranks: {} MB", peaks.join(", ")));
}

/// Makes the process ready for its command: ranks, memory, threads.
fn prepare(arguments: &Arguments) -> Result<(), Failure> {
    require_one_task(&arguments.command)?;
    require_address_space()?;
    arguments.parent.map_or(Ok(()), results::stop::end_with)?;
    let ranks = Communicator::world().size();
    if ranks == 1 {
        allocator::end_when_empty();
    }
    let shares = matches!(
        arguments.command,
        Command::Run { .. }
            | Command::Resume(_)
            | Command::Check { .. }
            | Command::Stiffness(_)
            | Command::LoadMatrix(_)
            | Command::Campbell(_)
    );
    let threads = wanted_threads(arguments.threads)?;
    if shares || threads.is_some() {
        start_threads(threads)?;
    }
    if ranks > 1 {
        let threads = rayon::current_num_threads();
        print::note(format_args!("{ranks} ranks, {threads} threads on rank 0"));
    }
    let is_drawn = matches!(arguments.command, Command::Plot(_));
    folder_of(&arguments.command).map_or(Ok(()), |dir| agree(info::require_run_folder(dir, is_drawn)))
}

/// What a file or folder holds; with `verify` its bytes are read too.
fn info_of(path: &Path, verify: bool) -> Result<(), Failure> {
    let depth = match verify {
        true => Inspection::Bytes,
        false => Inspection::Structure,
    };
    match path.is_dir() && !plot::bearings(path)?.is_empty() {
        true => several_info::info(path, depth),
        false => info::info(path, depth),
    }
}

/// The folder of a run that a command reads.
fn folder_of(command: &Command) -> Option<&Path> {
    match command {
        Command::Resume(request) => Some(&request.dir),
        Command::Pack(request) => Some(&request.dir),
        Command::Cycles(request) => Some(&request.dir),
        Command::Export(request) => Some(&request.dir),
        Command::Plot(request) => Some(&request.dir),
        Command::Report(request) => Some(&request.dir),
        Command::Spectrum(request) => Some(&request.dir),
        Command::SpallLength(request) => Some(&request.dir),
        Command::BallLoads(request) => Some(&request.dir),
        Command::Life(request) => request.dir.as_deref(),
        _ => None,
    }
}

fn execute(arguments: Arguments) -> Result<(), Failure> {
    results::stop::outlive_file_limit()?;
    prepare(&arguments)?;
    match arguments.command {
        Command::Run {
            scene,
            overrides,
            out,
            points,
            limits,
        } => {
            let dir = run::run(&scene, &overrides, out, &limits, points)?;
            say_memory_of_ranks();
            print::line(format_args!("results: {}", dir.display()));
            Ok(())
        }
        Command::Resume(request) => {
            match several_state::is_list(&request.dir)? {
                true => several_resume::resume_run(
                    &request.dir,
                    request.step,
                    request.changes(),
                    &request.limits,
                )?,
                false => resume::resume(&request)?,
            }
            say_memory_of_ranks();
            Ok(())
        }
        Command::Gmsh { .. } | Command::Help { .. } | Command::Completions { .. } | Command::Man { .. } => {
            unreachable!("they need no ranks and threads")
        }
        Command::Info { path, verify } => info_of(&path, verify),
        Command::Init(request) => init::init(&request),
        Command::Pack(request) => pack::pack(&request),
        Command::Cycles(request) => cycles::cycles(&request),
        Command::Export(request) => match request.is_of_list()? {
            true => several_export::export(&request),
            false => export::export(&request),
        },
        Command::Study(request) => study::study(&request),
        Command::Prices(request) => study::prices::prices(&request),
        Command::Advise(question) => study::advise(&question),
        Command::Plot(request) => plot::plot(&request),
        Command::Report(request) => report::report(&request),
        Command::Spectrum(request) => spectrum::spectrum(&request),
        Command::SpallLength(request) => spectrum::spall_length(&request),
        Command::LoadMatrix(command) => load_matrix::load_matrix(&command),
        Command::BallLoads(command) => load_matrix::ball_loads(&command),
        Command::Life(request) => life::life(&request),
        Command::Heat(request) => heat::heat(&request),
        Command::Stiffness(command) => stiffness::stiffness(&command),
        Command::Campbell(command) => campbell::campbell(&command),
        Command::Check { scene, overrides } => check::check(&scene, &overrides),
        Command::Mesh(command) => mesh_command::mesh(&command),
    }
}
