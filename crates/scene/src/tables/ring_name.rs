//! The rings by the names that tables and keys have for them.

use serde::Deserialize;

/// Which of the two rings.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RingName {
    /// The ring on the shaft.
    Inner,
    /// The ring in the housing.
    Outer,
}

impl RingName {
    /// The table of the scene.
    pub fn key(self) -> &'static str {
        match self {
            RingName::Inner => "inner",
            RingName::Outer => "outer",
        }
    }

    /// The surface that is held: the bore or the seat.
    pub fn held_surface(self) -> &'static str {
        match self {
            RingName::Inner => "bore",
            RingName::Outer => "seat",
        }
    }
}
