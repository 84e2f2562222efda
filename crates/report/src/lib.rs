//! `raceway report`: one HTML page of a finished run that needs no other file: what was run, what came out, what it
//! cost and what a reader should know before believing it.

mod bearing;
mod html;
mod numbers;
mod page;
mod source;

use std::path::PathBuf;

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
    dir: PathBuf,
    /// File of the page; default: report.html in the folder of the results. It is replaced.
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    choice: Choice,
}

/// Writes the page of a run.
pub fn report(request: &Report) -> Result<(), Failure> {
    plot::require_one_bearing(&request.dir)?;
    let mut source = source::read(&request.dir)?;
    say_later(&request.dir);
    for doubt in &source.doubts {
        print::note(format_args!("warning: {doubt}"));
    }
    let mut figures = plot::figures(&request.dir, &request.choice)?;
    let numbers = numbers::numbers(&Results::read(&request.dir)?)?;
    let mut pictures = Vec::new();
    for named in &figures.drawn {
        match named.figure.svg() {
            Ok(svg) => pictures.push((named.name.clone(), svg)),
            Err(error) => figures.problems.push(format!("figure {}: {error}", named.name)),
        }
    }
    for problem in &figures.problems {
        print::note(format_args!("warning: {problem}"));
    }
    source.doubts.extend(figures.problems);
    let page = page::page(&source, &numbers, &pictures);
    let path = request
        .out
        .clone()
        .unwrap_or_else(|| request.dir.join("report.html"));
    whole::write(&path, page.as_bytes(), page::is_page)?;
    answer::add("page", &path);
    print::line(format_args!("report: {}", path.display()));
    Ok(())
}
