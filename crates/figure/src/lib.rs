//! Figures of numbers: lines, points and surfaces over two axes with units, as SVG and as PNG with the same look.
//!
//! A figure is data ([`Figure`], [`Axis`], [`Series`], [`Surface`]); [`Figure::svg`] lays it out and draws it. Layout
//! keeps every text inside the picture and off every other: margins follow the widths of the labels, the legend
//! stands in rows above the axes, labels of points look for a free place. Text is measured with the font that is
//! built in (DejaVu Sans), and the PNG is that same SVG, rasterised with that font: a machine needs no fonts.
//! Colours are those of Okabe and Ito (*Color Universal Design*, 2008) and the map viridis, which readers with
//! colour-blindness can tell apart.

mod axis;
mod canvas;
mod chart;
mod clashes;
mod error;
mod figure;
mod labels;
mod layout;
mod legend;
mod marks;
mod page;
mod palette;
mod png;
mod point;
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
pub use figure::images::Images;
pub use figure::{Figure, SIZE};
pub use point::DataPoint;
pub use series::{Look, Series};
pub use surface::Surface;
pub use triangles::Triangle;
