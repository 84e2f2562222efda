//! A figure as data: series, a surface and labels over two axes.

pub mod images;

use crate::axis::Axis;
use crate::point::DataPoint;
use crate::series::Series;
use crate::surface::Surface;

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

/// A text at a point of the data.
#[derive(Clone, Debug)]
pub(crate) struct Label {
    pub at: DataPoint,
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
    pub fn label(mut self, at: DataPoint, text: impl Into<String>) -> Figure {
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
}
