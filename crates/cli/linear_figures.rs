//! Figures of `raceway stiffness` and `raceway campbell`.

use std::path::Path;

use results::failure::Failure;
use results::whole::write_picture;

/// Draws what tables in a folder hold, and returns the names of the SVG files.
pub fn draw(dir: &Path) -> Result<Vec<String>, Failure> {
    let mut names = Vec::new();
    for named in plot::linear_figures(dir)? {
        let images = named.figure.images()?;
        write_picture(&dir.join(&named.name), &images.svg, &images.png)?;
        names.push(format!("{}.svg", named.name));
    }
    Ok(names)
}
