//! `raceway report`: one HTML page of a finished run that needs no other file: what was run, what came out, what it
//! cost and what a reader should know before believing it. Several bearings on one shaft have one page, with a part for
//! each.

mod bearing;
mod html;
mod numbers;
mod page;
mod pictures;
mod several;
mod source;

use std::path::{Path, PathBuf};

use clap::Args;
use comm::print;
use plot::{Choice, Results};
use results::answer;
use results::failure::Failure;
use results::folder::say_later;
use results::whole;

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Report {
    /// Folder of the results.
    pub dir: PathBuf,
    /// File of the page; default: report.html in the folder of the results. It is replaced.
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    choice: Choice,
}

/// Writes the page of a run.
pub fn report(request: &Report) -> Result<(), Failure> {
    let names = plot::bearings(&request.dir)?;
    let (page, doubts) = match names.is_empty() {
        true => of_one(&request.dir, &request.choice)?,
        false => several::page(&request.dir, &names, &request.choice)?,
    };
    say_later(&request.dir);
    for doubt in &doubts {
        print::note(format_args!("warning: {doubt}"));
    }
    let path = request
        .out
        .clone()
        .unwrap_or_else(|| request.dir.join("report.html"));
    whole::write(&path, page.as_bytes(), page::is_page)?;
    answer::add("page", &path);
    print::line(format_args!("report: {}", path.display()));
    Ok(())
}

/// The page of a run of one bearing, and what was not as it should be.
fn of_one(dir: &Path, choice: &Choice) -> Result<(String, Vec<String>), Failure> {
    let mut source = source::read(dir)?;
    let (pictures, problems) = pictures::drawn(plot::figures(dir, choice)?);
    let numbers = numbers::numbers(&Results::read(dir)?)?;
    source.doubts.extend(problems);
    Ok((page::page(&source, &numbers, &pictures), source.doubts))
}
