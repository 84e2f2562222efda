//! Why a text is no quantity.

use thiserror::Error;

/// Why a text is not the quantity that is needed. Every message starts with the text itself.
#[derive(Debug, Error, PartialEq)]
pub enum UnitError {
    /// There is a number but nothing after it.
    #[error("{text:?} has no unit; expected {expected}")]
    NoUnit {
        /// As typed.
        text: String,
        /// What would be right, with an example.
        expected: String,
    },
    /// The text does not begin with a decimal number.
    #[error("{text:?} does not begin with a number; expected {expected}")]
    NoNumber {
        /// As typed.
        text: String,
        /// What would be right, with an example.
        expected: String,
    },
    /// `nan`, `inf`, or a number beyond the range of a double in SI.
    #[error("{text:?} is not a finite number; expected {expected}")]
    NotFinite {
        /// As typed.
        text: String,
        /// What would be right, with an example.
        expected: String,
    },
    /// A symbol that is neither a unit nor a prefix and a unit.
    #[error("{text:?} has the unknown unit {symbol:?}{suggestion}; expected {expected}")]
    UnknownUnit {
        /// As typed.
        text: String,
        /// The symbol nobody knows.
        symbol: String,
        /// Empty, or ` (did you mean ...?)`.
        suggestion: String,
        /// What would be right, with an example.
        expected: String,
    },
    /// Number or unit expression are not well formed.
    #[error("{text:?} cannot be read: {reason}; expected {expected}")]
    Malformed {
        /// As typed.
        text: String,
        /// What is wrong with the expression.
        reason: String,
        /// What would be right, with an example.
        expected: String,
    },
    /// A well formed quantity of another kind.
    #[error("{text:?} is {found}; expected {expected}")]
    WrongDimension {
        /// As typed.
        text: String,
        /// The kind it is, or its base units.
        found: String,
        /// What would be right, with an example.
        expected: String,
    },
}
