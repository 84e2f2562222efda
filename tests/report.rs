//! The page of a run through the whole program.

use checkpoint::FolderLock;

use crate::plot::plotted;
use crate::util::tables::summary;

/// Wrong: a reader of the page alone would miss something of the run, or need other files.
#[test]
fn the_page_of_a_run_stands_alone() {
    let dir = plotted();
    let outcome = dir.raceway(&["report", "motion"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let page = dir.text("motion/report.html");
    for part in [
        "Key numbers",
        "Figures",
        "Energy at the end",
        "Cost",
        "Scene",
        "Warnings",
        "[effects.axial_force]",
        "<h2>Bearing</h2>",
        "<tr><th>radial clearance</th><td>27.000 um</td></tr>",
        "<tr><th>free contact angle</th><td>14.928 deg</td></tr>",
        "<h2>Balls at the end</h2>",
        "<tr><th>17</th>",
        ", commit ",
        " UTC</td>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let summary = summary(&dir, "motion");
    let (elements, dofs) = (&summary["elements"]["inner"], &summary["dofs"]["inner"]);
    let meshes = format!("<tr><th>meshes</th><td>inner ring {elements} elements, {dofs} dofs, outer ring ");
    assert!(page.contains(&meshes), "{meshes}");
    let title = summary["title"].as_str().unwrap().to_string();
    assert!(page.contains(&format!("<h1>{title}</h1>")), "{title}");
    // 27 figures, each an SVG of its own.
    assert_eq!(page.matches("<svg ").count(), 27);
    for reference in ["src=", "href=", "url(", "@import", "fetch(", "import("] {
        assert!(!page.contains(reference), "{reference}");
    }
    // The script of the figures alone, which asks for nothing; every figure has what it reads: two axes with ticks.
    assert_eq!(page.matches("<script").count(), 1);
    for figure in page.split("<figure ").skip(1) {
        let figure = figure.split("</figure>").next().unwrap();
        assert!(figure.matches("dy=\"0.76em\"").count() >= 2, "{}", &figure[..60]);
        assert!(
            figure.matches("text-anchor=\"end\"").count() >= 2,
            "{}",
            &figure[..60]
        );
    }
    // Every element that is opened is closed, in the text that is no SVG.
    for element in [
        "table", "tr", "td", "th", "figure", "div", "ul", "li", "pre", "p", "h1", "h2", "svg",
    ] {
        let opened =
            page.matches(&format!("<{element}>")).count() + page.matches(&format!("<{element} ")).count();
        assert_eq!(
            opened,
            page.matches(&format!("</{element}>")).count(),
            "{element}"
        );
    }
}

/// Wrong: a run that has not ended would get a page without its end, or nobody would be told that it goes on.
#[test]
fn a_folder_without_a_summary_is_refused() {
    let dir = plotted();
    std::fs::remove_file(dir.path("sweep/summary.json")).unwrap();
    let outcome = dir.raceway(&["report", "sweep"]);
    assert_eq!(outcome.code, Some(2));
    let expected = "sweep has no summary.json; expected the results of a run that has ended; if it was killed, raceway \
                    resume sweep goes on with a run over time, and says of others what to do";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
    // Not of a folder without a step, and not while it runs.
    let lock = FolderLock::acquire(&dir.path("sweep")).unwrap();
    let outcome = dir.raceway(&["report", "sweep"]);
    assert!(
        outcome.stderr.contains("still writes to it"),
        "{}",
        outcome.stderr
    );
    assert!(!outcome.stderr.contains("resume"), "{}", outcome.stderr);
    drop(lock);
    std::fs::create_dir(dir.path("empty")).unwrap();
    let outcome = dir.raceway(&["report", "empty"]);
    assert!(
        outcome.stderr.ends_with("of a run that has ended\n"),
        "{}",
        outcome.stderr
    );
}

/// Wrong: what could not be drawn would take the page and all other figures with it, or be missing without a word.
#[test]
fn a_figure_that_cannot_be_made_does_not_stop_the_others() {
    let dir = plotted();
    std::fs::remove_file(dir.path("sweep/mesh.hdf")).unwrap();
    let _ = std::fs::remove_dir_all(dir.path("sweep/figures"));
    let outcome = dir.raceway(&["plot", "sweep"]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
    let expected = "error: some figures could not be made: figures of raceways: ";
    assert!(
        outcome.stderr.contains(expected) && outcome.stderr.contains("mesh.hdf"),
        "{}",
        outcome.stderr
    );
    assert!(dir.path("sweep/figures/ball_force.svg").is_file());
    assert!(!dir.path("sweep/figures/raceway_inner.svg").exists());
    let outcome = dir.raceway(&["report", "sweep"]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let page = dir.text("sweep/report.html");
    assert!(page.contains("<li>figures of raceways: ") && page.contains("aria-label=\"ball force\""));
}
