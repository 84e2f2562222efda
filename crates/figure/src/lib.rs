//! Figures of numbers: lines, points and surfaces over two axes with units, as SVG and as PNG with the same look.
//!
//! A figure is data ([`Figure`], [`Axis`], [`Series`], [`Surface`]); [`Figure::svg`] lays it out and draws it. Layout
//! keeps every text inside the picture and off every other: margins follow the widths of the labels, the legend
//! stands in rows above the axes, labels of points look for a free place. Text is measured with the font that is
//! built in (DejaVu Sans), and the PNG is that same SVG, rasterised with that font: a machine needs no fonts.
//! Colours are those of Okabe and Ito (*Color Universal Design*, 2008) and the map viridis, which readers with
//! colour-blindness can tell apart.

mod axis;
mod chart;
mod clashes;
mod error;
mod labels;
mod layout;
mod legend;
mod marks;
mod palette;
mod png;
mod series;
mod surface;
mod text;
mod thin;
mod ticked;
mod ticks;
mod triangles;

pub use axis::{Axis, Scale};
pub use clashes::clashes;
pub use error::FigureError;
pub use series::{Look, Series};
pub use surface::Surface;
pub use triangles::Triangle;

/// Width and height of a figure in SVG pixels.
pub const SIZE: (u32, u32) = (720, 450);

/// A figure.
#[derive(Clone, Debug)]
pub struct Figure {
    pub(crate) title: String,
    pub(crate) note: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) series: Vec<Series>,
    pub(crate) surface: Option<Surface>,
    pub(crate) labels: Vec<Label>,
    pub(crate) size: (u32, u32),
    pub(crate) has_equal_scales: bool,
}

/// A figure as two files of the same look.
#[derive(Clone, Debug)]
pub struct Images {
    /// The SVG document.
    pub svg: String,
    /// The bytes of the PNG image.
    pub png: Vec<u8>,
}

/// A text at a point of the data.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub at: [f64; 2],
    pub text: String,
}

impl Figure {
    /// An empty figure over two axes.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Figure {
        Figure {
            title: title.into(),
            note: String::new(),
            x,
            y,
            series: Vec::new(),
            surface: None,
            labels: Vec::new(),
            size: SIZE,
            has_equal_scales: false,
        }
    }

    /// Writes a sentence below the title: what a reader must know of the numbers.
    pub fn note(mut self, text: impl Into<String>) -> Figure {
        self.note = text.into();
        self
    }

    /// Adds a series. Series of equal names share an entry of the legend; a series without a name has none.
    pub fn series(mut self, series: Series) -> Figure {
        self.series.push(series);
        self
    }

    /// Colours the area between the axes; series are drawn on top.
    pub fn surface(mut self, surface: Surface) -> Figure {
        self.surface = Some(surface);
        self
    }

    /// Writes a short text beside a point of the data, where there is room.
    pub fn label(mut self, at: [f64; 2], text: impl Into<String>) -> Figure {
        self.labels.push(Label {
            at,
            text: text.into(),
        });
        self
    }

    /// Width and height in SVG pixels; default: [`SIZE`].
    pub fn size(mut self, width: u32, height: u32) -> Figure {
        self.size = (width, height);
        self
    }

    /// A unit has the same length along both axes, which are linear.
    pub fn equal_scales(mut self) -> Figure {
        self.has_equal_scales = true;
        self
    }

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

/// Image pixels per SVG pixel of the PNG files.
const PNG_SCALE: f32 = 1.5;
