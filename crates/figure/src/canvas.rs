//! The area a figure is drawn on, in units of the drawing, and texts on it.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::text::{FONT, Weight};

/// Units of the drawing per SVG pixel.
pub const UNITS: f64 = 10.0;

/// The area everything is drawn on.
pub type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Result of drawing.
pub type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A text, its middle line at y and its left end, middle or right end at x.
pub fn write(canvas: &Canvas, text: &str, at: [f64; 2], size: f64, weight: Weight, x_pos: HPos) -> Drawn {
    let style = style(size, weight).pos(Pos::new(x_pos, VPos::Center));
    canvas.draw(&Text::new(text.to_string(), units(at), style))
}

/// Style of a text; plotters writes a font size of its size over 1.24.
pub fn style(size: f64, weight: Weight) -> TextStyle<'static> {
    let font = FontDesc::new(FontFamily::Name(FONT), size * UNITS * 1.24, weight.style());
    TextStyle::from(font).color(&BLACK)
}

/// A place in units of the drawing.
pub fn units([x, y]: [f64; 2]) -> (i32, i32) {
    ((x * UNITS).round() as i32, (y * UNITS).round() as i32)
}
