//! The page of a run through the whole program.

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
    ] {
        assert!(page.contains(part), "{part}");
    }
    let title = summary(&dir, "motion")["title"].as_str().unwrap().to_string();
    assert!(page.contains(&format!("<h1>{title}</h1>")), "{title}");
    // 24 figures, each an SVG of its own.
    assert_eq!(page.matches("<svg ").count(), 24);
    for reference in ["src=", "href=", "url(", "@import", "<script"] {
        assert!(!page.contains(reference), "{reference}");
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

/// Wrong: a run that has not ended would get a page without its end.
#[test]
fn a_folder_without_a_summary_is_refused() {
    let dir = plotted();
    std::fs::remove_file(dir.path("sweep/summary.json")).unwrap();
    let outcome = dir.raceway(&["report", "sweep"]);
    assert_eq!(outcome.code, Some(2));
    let expected = "sweep has no summary.json; expected the results of a run that has ended";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
}
