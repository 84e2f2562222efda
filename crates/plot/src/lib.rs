//! `raceway plot`: figures of a finished run, from its tables and step files alone.
//!
//! Which figures there are follows from what the run computed: an equilibrium and a sweep are shown against the
//! azimuth of the balls and against the swept value, a motion against time and against the azimuth of one ball.
//! Fields of the raceways come from the step files.

mod balls;
mod cage;
mod campbell;
mod choice;
mod cut;
mod deformed;
mod energy;
mod groove;
mod modes;
mod named;
mod power;
mod probes;
mod profiles;
pub mod quantity;
mod raceways;
mod ring_outline;
mod run;
mod seat;
mod section;
mod several;
mod shades;
mod shaft;
mod shaft_modes;
mod stiffness;
mod stress_step;
mod surface;

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;
use comm::print;
use figure::Figure;
use results::answer;
use results::failure::{Failure, one_line};
use results::folder::say_later;
use results::integrity::warn_of_doubts;
use results::whole::{make_output_folder, require_own_picture, write_picture};

pub use choice::Choice;
pub use named::Named;
pub use quantity::AxisUnit;
pub use run::{Results, Steps, has_tables, swept_column};

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Plot {
    /// Folder of the results.
    pub dir: PathBuf,
    /// Folder of the figures; default: figures in the folder of the results. Figures in it are replaced.
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    choice: Choice,
}

/// The figures of a run, and why others could not be made: a sentence each.
pub struct Figures {
    /// Those that could be made.
    pub drawn: Vec<Named>,
    /// Those that could not.
    pub problems: Vec<String>,
}

/// Writes the figures of a run as SVG and PNG. A figure that cannot be made does not stop the others; the command then
/// ends with an error.
pub fn plot(request: &Plot) -> Result<(), Failure> {
    let (dir, choice) = (&request.dir, &request.choice);
    if choice.ball != 0 || choice.step.is_some() {
        require_one_bearing(dir).map_err(|error| {
            error.context("--ball and --step choose from the figures of one bearing".into())
        })?;
    }
    let mut figures = figures(dir, choice)?;
    warn_of_doubts(&request.dir)?;
    say_later(&request.dir);
    let out = request.out.clone().unwrap_or_else(|| request.dir.join("figures"));
    // All are drawn, and all places looked at, before the first is written.
    let mut images = Vec::new();
    for named in &figures.drawn {
        match named.figure.images() {
            Ok(drawn) => images.push((named.name.as_str(), out.join(&named.name), drawn)),
            Err(error) => figures.problems.push(format!("figure {}: {error}", named.name)),
        }
    }
    images
        .iter()
        .try_for_each(|(_, path, _)| require_own_picture(path))?;
    make_output_folder(request.out.as_deref(), &out)?;
    for (_, path, images) in &images {
        write_picture(path, &images.svg, &images.png)?;
    }
    let names: Vec<&str> = images.iter().map(|(name, ..)| *name).collect();
    answer::add("folder", &out);
    answer::add("figures", &names);
    print::line(format_args!(
        "{} as svg and png in {}: {}",
        print::counted(names.len(), "figure"),
        out.display(),
        names.join(", ")
    ));
    match figures.problems.as_slice() {
        [] => Ok(()),
        problems => Err(anyhow!("some figures could not be made: {}", problems.join("; ")).into()),
    }
}

/// Fails for the folder of several bearings: what is asked is of one.
pub fn require_one_bearing(dir: &Path) -> Result<(), Failure> {
    if !several::is_of_several(dir) {
        return Ok(());
    }
    let names = several::names(dir, usize::MAX)?;
    let first = names.first().map_or("", String::as_str);
    Err(Failure::User(anyhow!(
        "{} has the results of several bearings on one shaft; expected the folder of one of them, such as {}",
        dir.display(),
        dir.join(first).display()
    )))
}

/// Names of the bearings whose results are in `dir`, in their order on the shaft; none for a run of one bearing.
pub fn bearings(dir: &Path) -> anyhow::Result<Vec<String>> {
    match several::is_of_several(dir) {
        true => several::all_names(dir),
        false => Ok(Vec::new()),
    }
}

/// The figures of `raceway stiffness` and `raceway campbell` in `dir`.
pub fn linear_figures(dir: &Path) -> anyhow::Result<Vec<Named>> {
    let found = stiffness::figures(dir)?
        .into_iter()
        .chain(campbell::figures(dir)?);
    Ok(found.map(|(name, figure)| Named::new(name, figure)).collect())
}

/// Figures with their names.
fn with_names(found: anyhow::Result<Vec<(String, Figure)>>) -> anyhow::Result<Vec<Named>> {
    let with_name = |(name, figure)| Named::new(name, figure);
    Ok(found?.into_iter().map(with_name).collect())
}

/// The figures of the run in `dir`; at least one. Where none can be made, or what was chosen is not there, that is the
/// error.
pub fn figures(dir: &Path, choice: &Choice) -> Result<Figures, Failure> {
    if several::is_of_several(dir) {
        let mut drawn = with_names(several::figures(dir))?;
        drawn.extend(modes::figures(dir)?);
        drawn.extend(with_names(shaft_modes::figures(dir))?);
        drawn.extend(linear_figures(dir)?);
        let problems = Vec::new();
        return Ok(Figures { drawn, problems });
    }
    let results = Results::read(dir)?;
    stress_step::note_lacking(dir, choice.step)?;
    let groups = [
        ("balls", balls::figures(&results, choice)),
        ("shaft", shaft::figures(&results)),
        ("cage", cage::figures(&results)),
        ("power", with_names(power::figures(&results))),
        ("probes", probes::figures(&results)),
        ("profiles", profiles::figures(&results, choice)),
        ("energy", energy::figures(&results)),
        ("modes", modes::figures(dir)),
        ("stiffness", linear_figures(dir)),
        ("raceways", surface::figures(&results, choice)),
        ("grooves", with_names(groove::figures(&results, choice.step))),
        ("seat", with_names(seat::figures(dir))),
        ("sections", with_names(section::figures(&results, choice.step))),
        (
            "deformed rings",
            with_names(deformed::figures(&results, choice.step)),
        ),
    ];
    let is_chosen = choice.ball != 0 || choice.step.is_some();
    let (mut drawn, mut problems, mut first) = (Vec::new(), Vec::new(), None);
    for (group, made) in groups {
        match made {
            Ok(made) => drawn.extend(made),
            Err(error) if is_chosen => return Err(error.into()),
            Err(error) => {
                problems.push(format!("figures of {group}: {}", one_line(&error)));
                first.get_or_insert(error);
            }
        }
    }
    match (drawn.is_empty(), first) {
        (true, Some(error)) => Err(error.into()),
        (true, None) if dir.join("stiffness.json").exists() => Err(anyhow!(
            "{} has the stiffness at one point, of which there is no figure; expected that of a sweep, a ripple or a \
             time",
            dir.display()
        )
        .into()),
        (true, None) => Err(anyhow!(
            "{} has nothing to plot; expected the tables or step files of a run, such as balls.csv",
            dir.display()
        )
        .into()),
        _ => Ok(Figures { drawn, problems }),
    }
}
