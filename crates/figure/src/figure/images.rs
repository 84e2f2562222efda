//! A figure as SVG and as PNG.

use super::Figure;
use crate::error::FigureError;
use crate::{chart, png};

/// Image pixels per SVG pixel of the PNG files.
const PNG_SCALE: f32 = 1.5;

/// A figure as two files of the same look.
#[derive(Clone, Debug)]
pub struct Images {
    /// The SVG document.
    pub svg: String,
    /// The bytes of the PNG image.
    pub png: Vec<u8>,
}

impl Figure {
    /// The figure as an SVG document.
    pub fn svg(&self) -> Result<String, FigureError> {
        chart::draw(self)
    }

    /// The figure as a PNG image, `scale` image pixels per SVG pixel.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, FigureError> {
        png::rasterise(&self.svg()?, scale)
    }

    /// The figure as SVG and as PNG: the bytes of two files.
    pub fn images(&self) -> Result<Images, FigureError> {
        let svg = self.svg()?;
        let png = png::rasterise(&svg, PNG_SCALE)?;
        Ok(Images { svg, png })
    }
}
