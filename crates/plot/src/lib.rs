//! `raceway plot`: figures of a finished run, from its tables and step files alone.
//!
//! Which figures there are follows from what the run computed: an equilibrium and a sweep are shown against the
//! azimuth of the balls and against the swept value, a motion against time and against the azimuth of one ball.
//! Fields of the raceways come from the step files.

mod balls;
mod campbell;
mod energy;
mod modes;
mod probes;
mod profiles;
pub mod quantity;
mod raceways;
mod run;
mod section;
mod shaft;
mod stiffness;
mod surface;

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;
use comm::print;
use figure::Figure;
use results::failure::Failure;
use results::folder::say_later;
use results::integrity::warn_of_doubts;
use results::whole::{make_output_folder, require_own_picture, write_picture};

pub use quantity::Unit;
pub use run::{Results, Steps};

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Plot {
    /// Folder of the results.
    dir: PathBuf,
    /// Folder of the figures; default: figures in the folder of the results. Figures in it are replaced.
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    choice: Choice,
}

/// What the figures show of a run.
#[derive(Clone, Debug, Default, Args)]
pub struct Choice {
    /// Ball whose way round is shown, from 0.
    #[arg(long, default_value_t = 0)]
    pub ball: usize,
    /// Step whose stress is shown; default: the last with stress.
    #[arg(long)]
    pub step: Option<u64>,
}

/// A figure and the name of its files.
pub struct Named {
    /// Name without ending.
    pub name: String,
    /// The figure.
    pub figure: Figure,
}

impl Named {
    /// A figure with its name.
    pub fn new(name: impl Into<String>, figure: Figure) -> Named {
        Named {
            name: name.into(),
            figure,
        }
    }
}

/// Writes the figures of a run as SVG and PNG.
pub fn plot(request: &Plot) -> Result<(), Failure> {
    let figures = figures(&request.dir, &request.choice)?;
    warn_of_doubts(&request.dir)?;
    say_later(&request.dir);
    let out = request.out.clone().unwrap_or_else(|| request.dir.join("figures"));
    // All are drawn, and all places looked at, before the first is written.
    let drawn = |named: &Named| Ok((out.join(&named.name), named.figure.images()?));
    let images = figures.iter().map(drawn).collect::<Result<Vec<_>, Failure>>()?;
    images
        .iter()
        .try_for_each(|(path, _)| require_own_picture(path))?;
    make_output_folder(request.out.as_deref(), &out)?;
    for (path, images) in &images {
        write_picture(path, &images.svg, &images.png)?;
    }
    let names: Vec<&str> = figures.iter().map(|named| named.name.as_str()).collect();
    print::line(format_args!(
        "{} figures as svg and png in {}: {}",
        figures.len(),
        out.display(),
        names.join(", ")
    ));
    Ok(())
}

/// The figures of `raceway stiffness` and `raceway campbell` in `dir`.
pub fn linear_figures(dir: &Path) -> anyhow::Result<Vec<Named>> {
    let found = stiffness::figures(dir)?
        .into_iter()
        .chain(campbell::figures(dir)?);
    Ok(found.map(|(name, figure)| Named::new(name, figure)).collect())
}

/// The figures of the run in `dir`; at least one.
pub fn figures(dir: &Path, choice: &Choice) -> Result<Vec<Named>, Failure> {
    let results = Results::read(dir)?;
    let mut figures = Vec::new();
    figures.extend(balls::figures(&results, choice)?);
    figures.extend(shaft::figures(&results)?);
    figures.extend(probes::figures(&results)?);
    figures.extend(profiles::figures(&results, choice)?);
    figures.extend(energy::figures(&results)?);
    figures.extend(modes::figures(dir)?);
    figures.extend(linear_figures(dir)?);
    figures.extend(surface::figures(&results, choice)?);
    figures.extend(section::figures(&results, choice)?);
    if figures.is_empty() {
        return Err(anyhow!(
            "{} has nothing to plot; expected the tables or step files of a run, such as balls.csv",
            dir.display()
        )
        .into());
    }
    Ok(figures)
}
