//! Texts: the built-in font, and how wide they are.

use std::sync::Once;

use plotters::style::{FontStyle, IntoFont, register_font};

/// The font as it is measured and rasterised.
pub const FONT: &str = "DejaVu Sans";
/// The fonts a viewer of the SVG may take: none of them is wider than the first.
pub const FONTS: &str = "DejaVu Sans, Verdana, sans-serif";

/// Height of a line of text over its size.
pub const LINE: f64 = 1.25;

/// The fonts behind a name, regular and bold.
pub fn font_files() -> [&'static [u8]; 2] {
    [dejavu::sans::regular(), dejavu::sans::bold()]
}

/// Makes the fonts known to the drawing library; only the first call does anything.
pub fn register() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let [regular, bold] = font_files();
        let known = register_font(FONT, FontStyle::Normal, regular).is_ok()
            && register_font(FONT, FontStyle::Bold, bold).is_ok();
        assert!(known, "the built-in font cannot be read");
    });
}

/// Weight of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// As in running text.
    Regular,
    /// As in titles.
    Bold,
}

impl Weight {
    /// The same for the drawing library.
    pub fn style(self) -> FontStyle {
        match self {
            Weight::Regular => FontStyle::Normal,
            Weight::Bold => FontStyle::Bold,
        }
    }
}

/// Width of a text of the given size, in the unit of the size.
pub fn width(text: &str, size: f64, weight: Weight) -> f64 {
    register();
    // The library returns whole units: measure large.
    let enlarged = 100.0;
    (FONT, enlarged, weight.style())
        .into_font()
        .box_size(text)
        .map_or(0.7 * text.chars().count() as f64 * size, |(w, _)| {
            f64::from(w) * size * PER_EM / enlarged
        })
}

/// The library scales a font so that ascent and descent together are its size; sizes here are ems.
const PER_EM: f64 = 1.165;

/// The text, cut with an ellipsis to fit the given width.
pub fn fit(text: &str, size: f64, weight: Weight, room: f64) -> String {
    if width(text, size, weight) <= room {
        return text.to_string();
    }
    let mut cut: Vec<char> = text.chars().collect();
    while !cut.is_empty() {
        cut.pop();
        let shorter = format!("{}…", cut.iter().collect::<String>().trim_end());
        if width(&shorter, size, weight) <= room {
            return shorter;
        }
    }
    String::new()
}
