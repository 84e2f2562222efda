//! What the designation of a bearing says: bore, outside diameter and width of ISO 15, dimension series 18, 19, 10, 02
//! and 03, which catalogues print for the deep groove bearings 618, 619, 60, 62, 63 and the angular contact bearings
//! 718, 719, 70, 72, 73; the contact angle of a suffix; the clearance of deep groove bearings of ISO 5753-1. Some
//! makers write 68, 69, 78 and 79 for the first two series.
//!
//! Makers write a suffix in many ways: `7010C`, `7010 CD/P4A`, `7010-C-T-P4S`; `6203-2RS1/C3`, `6203ZZC3`. Spaces,
//! dashes and strokes part its words. The first word of an angular contact bearing says its angle, C2 to C5 anywhere
//! the clearance of a deep groove bearing. HC before anything else in a word says that the balls are ceramic.

use input::ten_digits;

/// Outside diameter and width, mm, for the bore codes 00 to 20.
type Sizes = [(f64, f64); 21];

/// Bores of the codes 00 to 20, mm.
#[rustfmt::skip]
const BORES: [f64; 21] = [
    10., 12., 15., 17., 20., 25., 30., 35., 40., 45., 50., 55., 60., 65., 70., 75., 80., 85., 90., 95., 100.,
];
/// Dimension series 18.
#[rustfmt::skip]
const SERIES_18: Sizes = [
    (19., 5.), (21., 5.), (24., 5.), (26., 5.), (32., 7.), (37., 7.), (42., 7.), (47., 7.), (52., 7.), (58., 7.),
    (65., 7.), (72., 9.), (78., 10.), (85., 10.), (90., 10.), (95., 10.), (100., 10.), (110., 13.), (115., 13.),
    (120., 13.), (125., 13.),
];
/// Dimension series 19.
#[rustfmt::skip]
const SERIES_19: Sizes = [
    (22., 6.), (24., 6.), (28., 7.), (30., 7.), (37., 9.), (42., 9.), (47., 9.), (55., 10.), (62., 12.), (68., 12.),
    (72., 12.), (80., 13.), (85., 13.), (90., 13.), (100., 16.), (105., 16.), (110., 16.), (120., 18.), (125., 18.),
    (130., 18.), (140., 20.),
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
/// A range of radial clearance, um.
type Range = (f64, f64);
/// Groups of radial clearance of ISO 5753-1.
const GROUPS: [&str; 5] = ["C2", "N", "C3", "C4", "C5"];
/// Their ranges for deep groove bearings with bores up to the first number, mm: ISO 5753-1.
#[rustfmt::skip]
const CLEARANCES: [(f64, [Range; 5]); 9] = [
    (10., [(0., 7.), (2., 13.), (8., 23.), (14., 29.), (20., 37.)]),
    (18., [(0., 9.), (3., 18.), (11., 25.), (18., 33.), (25., 45.)]),
    (24., [(0., 10.), (5., 20.), (13., 28.), (20., 36.), (28., 48.)]),
    (30., [(1., 11.), (5., 20.), (13., 28.), (23., 41.), (30., 53.)]),
    (40., [(1., 11.), (6., 20.), (15., 33.), (28., 46.), (40., 64.)]),
    (50., [(1., 11.), (6., 23.), (18., 36.), (30., 51.), (45., 73.)]),
    (65., [(1., 15.), (8., 28.), (23., 43.), (38., 61.), (55., 90.)]),
    (80., [(1., 15.), (10., 30.), (25., 51.), (46., 71.), (65., 105.)]),
    (100., [(1., 18.), (12., 36.), (30., 58.), (53., 84.), (75., 120.)]),
];
/// What a designation looks like, for messages.
pub const DESIGNATIONS: &str = "expected a series 60, 62, 63, 618, 619, 70, 72, 73, 718 or 719 with a bore code 00 to \
                                20, such as 6206, 7208 or 71910C, or the dimensions: --bore, --outside, --width and \
                                --contact-angle or --radial-clearance";

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
    pub angle_note: String,
    /// Group of radial clearance, of a deep groove bearing.
    pub group: &'static str,
    /// Where the group is from.
    pub group_note: String,
    /// The word of the suffix that says that its balls are ceramic.
    pub hybrid: Option<String>,
}

/// Reads a designation, or says what was expected.
pub fn listed(designation: &str) -> Result<Listed, String> {
    let unknown = || format!("{designation:?} is no bearing that is known here; {DESIGNATIONS}");
    let text = designation.trim().to_uppercase();
    let (digits, suffix) = match text.find(|c: char| !c.is_ascii_digit()) {
        Some(end) => text.split_at(end),
        None => (text.as_str(), ""),
    };
    let (series, code) = digits
        .len()
        .checked_sub(2)
        .map_or((digits, ""), |end| digits.split_at(end));
    let sizes = match series {
        "618" | "68" | "718" | "78" => &SERIES_18,
        "619" | "69" | "719" | "79" => &SERIES_19,
        "60" | "70" => &SERIES_10,
        "62" | "72" => &SERIES_02,
        "63" | "73" => &SERIES_03,
        _ => return Err(unknown()),
    };
    let code: usize = code.parse().map_err(|_| unknown())?;
    let (outside, width) = *sizes.get(code).ok_or_else(unknown)?;
    let words: Vec<&str> = suffix
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    if let Some(other) = words.iter().find(|word| listed(word).is_ok()) {
        return Err(format!(
            "{designation:?} names two bearings, {digits} and {other}; expected one: make a scene of each"
        ));
    }
    let (group, group_note) = group_of(&words);
    let (degrees, angle_note) = match series.starts_with('7') {
        false => (None, String::new()),
        true => {
            let (degrees, note) = angle_of(words.first().copied());
            (Some(degrees), note)
        }
    };
    Ok(Listed {
        bore: BORES[code],
        outside,
        width,
        degrees,
        angle_note,
        group,
        group_note,
        // HC, alone or before a class of precision as in HCP4A.
        hybrid: words
            .iter()
            .find(|word| word.starts_with("HC"))
            .map(|word| word.to_string()),
    })
}

/// Contact angle of the first word of a suffix, degrees, and where it is from.
fn angle_of(word: Option<&str>) -> (f64, String) {
    const LETTERS: &str = "C is 15, AC 25, B 40 deg";
    let Some(word) = word else {
        return (40.0, format!("usual without a suffix; {LETTERS}"));
    };
    for (letters, degrees) in [("AC", 25.0), ("C", 15.0), ("B", 40.0)] {
        // C with a digit is a group of clearance or play.
        let is_angle = |after: &str| !after.starts_with(|c: char| c.is_ascii_digit());
        if word.strip_prefix(letters).is_some_and(is_angle) {
            return (degrees, format!("suffix {letters}"));
        }
    }
    (40.0, format!("ESTIMATE, suffix {word} is not known; {LETTERS}"))
}

/// The group of clearance among the words of a suffix, C3 alone or behind other letters as in ZZC3, and where it is
/// from.
fn group_of(words: &[&str]) -> (&'static str, String) {
    let says = |group: &str, word: &str| {
        let after = word.split_once(group).map(|(_, after)| after);
        after.is_some_and(|after| !after.starts_with(|c: char| c.is_ascii_digit()))
    };
    let of_words = |group: &&&str| words.iter().any(|word| **group != "N" && says(group, word));
    if let Some(group) = GROUPS.iter().find(of_words) {
        return (group, format!("the middle of group {group}, ISO 5753-1"));
    }
    // C1 and C9 look like a group; CM is that of makers for electric motors.
    let is_clearance = |word: &&&str| {
        let digit = |c: char| c.is_ascii_digit();
        **word == "CM" || word.split('C').skip(1).any(|after| after.starts_with(digit))
    };
    let note = match words.iter().find(is_clearance) {
        Some(word) => format!(
            "ESTIMATE, suffix {word} is no group of ISO 5753-1 that is known: C2, C3, C4, C5; that of N"
        ),
        None => "the middle of group N, ISO 5753-1".to_owned(),
    };
    ("N", note)
}

/// Material of the balls of a bearing, and a note on it.
pub fn material_of_balls(listed: Option<&Listed>) -> (&'static str, String) {
    match listed.and_then(|listed| listed.hybrid.as_ref()) {
        Some(word) => ("silicon nitride", format!("suffix {word}: a hybrid bearing")),
        None => ("bearing steel", "\"silicon nitride\" for a hybrid bearing".into()),
    }
}

/// Middle of a group of radial clearance, mm.
pub fn clearance_of(bore: f64, group: &str) -> f64 {
    let (_, ranges) = CLEARANCES
        .iter()
        .find(|(most, _)| bore <= *most)
        .unwrap_or(&CLEARANCES[8]);
    let (least, most) = GROUPS
        .iter()
        .zip(ranges)
        .find(|(name, _)| **name == group)
        .map_or(ranges[1], |(_, range)| *range);
    ten_digits(1e-3 * 0.5 * (least + most))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a designation as a catalogue prints it would silently give another contact angle.
    #[test]
    fn the_first_word_of_a_suffix_says_the_angle() {
        let cases = [
            ("7014 ACD", 25.0, "suffix AC"),
            ("7014 CD/HCP4A", 15.0, "suffix C"),
            ("7010-C-T-P4S", 15.0, "suffix C"),
            ("7306 BEP", 40.0, "suffix B"),
            (
                "7208 C3",
                40.0,
                "ESTIMATE, suffix C3 is not known; C is 15, AC 25, B 40 deg",
            ),
            ("7208", 40.0, "usual without a suffix; C is 15, AC 25, B 40 deg"),
            (
                "7208/P5",
                40.0,
                "ESTIMATE, suffix P5 is not known; C is 15, AC 25, B 40 deg",
            ),
            (
                "7208 A",
                40.0,
                "ESTIMATE, suffix A is not known; C is 15, AC 25, B 40 deg",
            ),
        ];
        for (designation, degrees, note) in cases {
            let found = listed(designation).unwrap();
            assert_eq!(
                (found.degrees, found.angle_note.as_str()),
                (Some(degrees), note),
                "{designation}"
            );
        }
    }

    /// Wrong: a hybrid bearing would have balls of steel, which are two and a half times as heavy, without a word.
    #[test]
    fn a_suffix_says_that_balls_are_ceramic() {
        for (designation, word) in [
            ("7014 CD/HCP4A", Some("HCP4A")),
            ("6206-2RS/HC5C3", Some("HC5C3")),
            ("7014 CD/P4A", None),
        ] {
            assert_eq!(
                listed(designation).unwrap().hybrid.as_deref(),
                word,
                "{designation}"
            );
        }
    }

    /// Wrong: a thin bearing would have the size of another. From catalogues of spindle and thin section bearings.
    #[test]
    fn thin_series_have_their_sizes() {
        let cases = [
            ("71900 CE/P4A", (10.0, 22.0, 6.0)),
            ("71910C", (50.0, 72.0, 12.0)),
            ("7914A5", (70.0, 100.0, 16.0)),
            ("71920 ACD", (100.0, 140.0, 20.0)),
            ("71816 C", (80.0, 100.0, 10.0)),
            ("61808", (40.0, 52.0, 7.0)),
            ("6907", (35.0, 55.0, 10.0)),
        ];
        for (designation, size) in cases {
            let found = listed(designation).unwrap();
            assert_eq!((found.bore, found.outside, found.width), size, "{designation}");
        }
        for wrong in ["1", "7", "719", "71921C", "72910", "719101"] {
            assert!(listed(wrong).is_err(), "{wrong}");
        }
    }

    /// Wrong: a bearing with more clearance would get that of group N. Middles by hand from ISO 5753-1.
    #[test]
    fn a_suffix_says_the_group_of_clearance() {
        let cases = [
            ("6203", 0.0105, "N"),
            ("6203/C3", 0.018, "C3"),
            ("6203-2RS1/C3", 0.018, "C3"),
            ("6308ZZC3", 0.024, "C3"),
            ("6310 C4", 0.0405, "C4"),
            ("6000-C2", 0.0035, "C2"),
            ("6220 M/C5", 0.0975, "C5"),
            ("6203-C-C3", 0.018, "C3"),
        ];
        for (designation, clearance, group) in cases {
            let found = listed(designation).unwrap();
            assert_eq!(
                (found.group, clearance_of(found.bore, found.group)),
                (group, clearance),
                "{designation}"
            );
            assert_eq!(
                found.group_note,
                format!("the middle of group {group}, ISO 5753-1")
            );
        }
    }

    /// Wrong: a clearance that nobody knows would pass for that of group N, the second of two bearings for a suffix.
    #[test]
    fn an_unknown_clearance_and_a_second_bearing_are_named() {
        for (designation, word) in [("6206/CM", "CM"), ("6010 C9", "C9"), ("6203-2RSC1", "2RSC1")] {
            assert_eq!(
                listed(designation).unwrap().group_note,
                format!(
                    "ESTIMATE, suffix {word} is no group of ISO 5753-1 that is known: C2, C3, C4, C5; that of N"
                )
            );
        }
        let text = listed("7208 6206").err().unwrap();
        assert_eq!(
            text,
            "\"7208 6206\" names two bearings, 7208 and 6206; expected one: make a scene of each"
        );
    }
}
