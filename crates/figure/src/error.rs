//! Errors of the figure crate.

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// No finite point.
    #[error("the figure {title:?} has nothing to draw: none of its {n_points} points is finite{on_axes}")]
    Empty {
        /// Title of the figure.
        title: String,
        /// Number of points given.
        n_points: usize,
        /// What else the axes demand.
        on_axes: &'static str,
    },
    /// The area between the axes would vanish.
    #[error(
        "the figure {title:?} of {width} x {height} pixels has no room for its axes; expected a larger size or \
         shorter labels"
    )]
    NoRoom {
        /// Title of the figure.
        title: String,
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
    },
    /// Lengths of arrays disagree.
    #[error("the {what} of the figure has {found} values; expected {expected}")]
    Length {
        /// What has the wrong length.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// The drawing library refused.
    #[error("cannot draw the figure {title:?}: {reason}")]
    Draw {
        /// Title of the figure.
        title: String,
        /// What the library says.
        reason: String,
    },
    /// The SVG could not be made an image.
    #[error("cannot turn the figure into an image: {reason}")]
    Raster {
        /// What the library says.
        reason: String,
    },
}
