//! An SVG document as an image, with the built-in font.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::{FigureError, text};

/// The document with its texts set in the built-in font.
pub fn parse(svg: &str) -> Result<Tree, FigureError> {
    let mut fonts = fontdb::Database::new();
    for file in text::font_files() {
        fonts.load_font_data(file.to_vec());
    }
    let options = Options {
        fontdb: Arc::new(fonts),
        font_family: text::FONT.into(),
        ..Options::default()
    };
    Tree::from_str(svg, &options).map_err(|error| failed(error.to_string()))
}

/// The image in PNG, `scale` image pixels per SVG pixel.
pub fn rasterise(svg: &str, scale: f32) -> Result<Vec<u8>, FigureError> {
    let tree = parse(svg)?;
    let size = tree
        .size()
        .to_int_size()
        .scale_by(scale)
        .ok_or_else(|| failed(format!("a scale of {scale} leaves no pixels")))?;
    let mut image = Pixmap::new(size.width(), size.height()).ok_or_else(|| {
        failed(format!(
            "{} x {} pixels are too many",
            size.width(),
            size.height()
        ))
    })?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut image.as_mut());
    image.encode_png().map_err(|error| failed(error.to_string()))
}

fn failed(reason: String) -> FigureError {
    FigureError::Raster { reason }
}
