//! A figure with its name.

use figure::Figure;

/// A figure and the name of its files.
pub struct Named {
    /// Name without ending.
    pub name: String,
    /// The figure.
    pub figure: Figure,
}

impl Named {
    /// A figure with its name.
    pub fn new(name: impl Into<String>, figure: Figure) -> Named {
        Named {
            name: name.into(),
            figure,
        }
    }
}
