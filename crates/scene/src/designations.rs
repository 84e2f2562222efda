//! What the designation of a bearing says: bore, outside diameter and width of ISO 15, dimension series 10, 02 and 03,
//! which catalogues print for the deep groove bearings 60, 62, 63 and the angular contact bearings 70, 72, 73; the
//! contact angle of a suffix; the clearance of deep groove bearings of ISO 5753-1.

use input::ten_digits;

/// Outside diameter and width, mm, for the bore codes 00 to 20.
type Sizes = [(f64, f64); 21];

/// Bores of the codes 00 to 20, mm.
#[rustfmt::skip]
const BORES: [f64; 21] = [
    10., 12., 15., 17., 20., 25., 30., 35., 40., 45., 50., 55., 60., 65., 70., 75., 80., 85., 90., 95., 100.,
];
/// Dimension series 10.
#[rustfmt::skip]
const SERIES_10: Sizes = [
    (26., 8.), (28., 8.), (32., 9.), (35., 10.), (42., 12.), (47., 12.), (55., 13.), (62., 14.), (68., 15.),
    (75., 16.), (80., 16.), (90., 18.), (95., 18.), (100., 18.), (110., 20.), (115., 20.), (125., 22.),
    (130., 22.), (140., 24.), (145., 24.), (150., 24.),
];
/// Dimension series 02.
#[rustfmt::skip]
const SERIES_02: Sizes = [
    (30., 9.), (32., 10.), (35., 11.), (40., 12.), (47., 14.), (52., 15.), (62., 16.), (72., 17.), (80., 18.),
    (85., 19.), (90., 20.), (100., 21.), (110., 22.), (120., 23.), (125., 24.), (130., 25.), (140., 26.),
    (150., 28.), (160., 30.), (170., 32.), (180., 34.),
];
/// Dimension series 03.
#[rustfmt::skip]
const SERIES_03: Sizes = [
    (35., 11.), (37., 12.), (42., 13.), (47., 14.), (52., 15.), (62., 17.), (72., 19.), (80., 21.), (90., 23.),
    (100., 25.), (110., 27.), (120., 29.), (130., 31.), (140., 33.), (150., 35.), (160., 37.), (170., 39.),
    (180., 41.), (190., 43.), (200., 45.), (215., 47.),
];
/// Radial clearance of group N, um, of deep groove bearings with bores up to the first number, mm: ISO 5753-1.
const CLEARANCES: [(f64, f64, f64); 9] = [
    (10., 2., 13.),
    (18., 3., 18.),
    (24., 5., 20.),
    (30., 5., 20.),
    (40., 6., 20.),
    (50., 6., 23.),
    (65., 8., 28.),
    (80., 10., 30.),
    (100., 12., 36.),
];
/// What a designation looks like, for messages.
pub const DESIGNATIONS: &str = "expected a series 60, 62, 63, 70, 72 or 73 with a bore code 00 to 20, such as 6206, \
                                7208 or 7010C, or the dimensions: --bore, --outside, --width and --contact-angle or \
                                --radial-clearance";

/// What a designation says.
pub struct Listed {
    /// Bore diameter, mm.
    pub bore: f64,
    /// Outside diameter, mm.
    pub outside: f64,
    /// Width, mm.
    pub width: f64,
    /// Contact angle; none of a deep groove bearing.
    pub degrees: Option<f64>,
    /// Where the contact angle is from.
    pub angle_note: &'static str,
}

/// Reads a designation, or says what was expected.
pub fn listed(designation: &str) -> Result<Listed, String> {
    let unknown = || format!("{designation:?} is no bearing that is known here; {DESIGNATIONS}");
    let text = designation.trim().to_uppercase();
    let (digits, suffix) = match text.find(|c: char| !c.is_ascii_digit()) {
        Some(end) => text.split_at(end),
        None => (text.as_str(), ""),
    };
    if digits.len() != 4 {
        return Err(unknown());
    }
    let (series, code) = digits.split_at(2);
    let sizes = match series {
        "60" | "70" => &SERIES_10,
        "62" | "72" => &SERIES_02,
        "63" | "73" => &SERIES_03,
        _ => return Err(unknown()),
    };
    let code: usize = code.parse().map_err(|_| unknown())?;
    let (outside, width) = *sizes.get(code).ok_or_else(unknown)?;
    let first = suffix
        .split(|c: char| !c.is_ascii_alphabetic())
        .next()
        .unwrap_or_default();
    let (degrees, angle_note) = match (series.starts_with('7'), first) {
        (false, _) => (None, ""),
        (true, "C") => (Some(15.0), "suffix C"),
        (true, "AC") => (Some(25.0), "suffix AC"),
        (true, "B") => (Some(40.0), "suffix B"),
        (true, _) => (Some(40.0), "usual without a suffix; C is 15, AC 25, B 40 deg"),
    };
    Ok(Listed {
        bore: BORES[code],
        outside,
        width,
        degrees,
        angle_note,
    })
}

/// Middle of group N, mm.
pub fn clearance_of(bore: f64) -> f64 {
    let row = CLEARANCES
        .iter()
        .find(|(most, ..)| bore <= *most)
        .unwrap_or(&CLEARANCES[8]);
    ten_digits(1e-3 * 0.5 * (row.1 + row.2))
}
