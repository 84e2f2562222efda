//! Figures as they stand in a page.

use plot::Figures;

/// A name and an SVG document.
pub type Picture = (String, String);

/// The pictures of figures, and a sentence for each figure that could not be made.
pub fn drawn(figures: Figures) -> (Vec<Picture>, Vec<String>) {
    let mut problems = figures.problems;
    let mut pictures = Vec::new();
    for named in figures.drawn {
        match named.figure.svg() {
            Ok(svg) => pictures.push((named.name, svg)),
            Err(error) => problems.push(format!("figure {}: {error}", named.name)),
        }
    }
    (pictures, problems)
}
