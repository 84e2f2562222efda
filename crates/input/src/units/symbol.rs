//! The symbols of units and their prefixes, and what was probably meant by others.

use std::f64::consts::PI;

use super::unit::{Dimension, Unit};

/// A unit symbol: size = `factor` * 10^`power_of_ten` in SI.
struct Symbol {
    name: &'static str,
    factor: f64,
    power_of_ten: f64,
    dimension: Dimension,
    takes_prefix: bool,
}

const fn symbol(
    name: &'static str,
    factor: f64,
    power_of_ten: f64,
    dimension: Dimension,
    takes_prefix: bool,
) -> Symbol {
    Symbol {
        name,
        factor,
        power_of_ten,
        dimension,
        takes_prefix,
    }
}

/// Pound-force, N, exact: 0.45359237 kg under 9.80665 m/s2.
const LBF: f64 = 4.448_221_615_260_5;
/// Pound-force per square inch, Pa.
const PSI: f64 = LBF / (0.0254 * 0.0254);

/// All symbols. A whole symbol wins over a prefix and a symbol: `min` is a minute.
static SYMBOLS: [Symbol; 25] = [
    symbol("m", 1.0, 0.0, [0.0, 1.0, 0.0, 0.0], true),
    symbol("in", 0.0254, 0.0, [0.0, 1.0, 0.0, 0.0], false),
    symbol("ft", 0.3048, 0.0, [0.0, 1.0, 0.0, 0.0], false),
    symbol("g", 1.0, -3.0, [1.0, 0.0, 0.0, 0.0], true),
    symbol("t", 1.0, 3.0, [1.0, 0.0, 0.0, 0.0], false),
    symbol("lb", 0.45359237, 0.0, [1.0, 0.0, 0.0, 0.0], false),
    symbol("s", 1.0, 0.0, [0.0, 0.0, 1.0, 0.0], true),
    symbol("min", 60.0, 0.0, [0.0, 0.0, 1.0, 0.0], false),
    symbol("h", 3600.0, 0.0, [0.0, 0.0, 1.0, 0.0], false),
    symbol("rad", 1.0, 0.0, [0.0, 0.0, 0.0, 1.0], true),
    symbol("deg", PI / 180.0, 0.0, [0.0, 0.0, 0.0, 1.0], false),
    symbol("°", PI / 180.0, 0.0, [0.0, 0.0, 0.0, 1.0], false),
    symbol("rev", 2.0 * PI, 0.0, [0.0, 0.0, 0.0, 1.0], false),
    symbol("rpm", PI / 30.0, 0.0, [0.0, 0.0, -1.0, 1.0], false),
    symbol("Hz", 1.0, 0.0, [0.0, 0.0, -1.0, 0.0], true),
    symbol("N", 1.0, 0.0, [1.0, 1.0, -2.0, 0.0], true),
    symbol("kgf", 9.80665, 0.0, [1.0, 1.0, -2.0, 0.0], false),
    symbol("lbf", LBF, 0.0, [1.0, 1.0, -2.0, 0.0], false),
    symbol("Pa", 1.0, 0.0, [1.0, -1.0, -2.0, 0.0], true),
    symbol("psi", PSI, 0.0, [1.0, -1.0, -2.0, 0.0], false),
    symbol("ksi", PSI, 3.0, [1.0, -1.0, -2.0, 0.0], false),
    symbol("Msi", PSI, 6.0, [1.0, -1.0, -2.0, 0.0], false),
    symbol("bar", 1.0, 5.0, [1.0, -1.0, -2.0, 0.0], true),
    symbol("J", 1.0, 0.0, [1.0, 2.0, -2.0, 0.0], true),
    symbol("W", 1.0, 0.0, [1.0, 2.0, -3.0, 0.0], true),
];

/// Prefixes and their powers of ten; both code points of the micro sign.
const PREFIXES: [(&str, f64); 13] = [
    ("T", 12.0),
    ("G", 9.0),
    ("M", 6.0),
    ("k", 3.0),
    ("d", -1.0),
    ("c", -2.0),
    ("m", -3.0),
    ("u", -6.0),
    ("\u{b5}", -6.0),
    ("\u{3bc}", -6.0),
    ("n", -9.0),
    ("p", -12.0),
    ("f", -15.0),
];

/// The unit of a symbol, with a prefix or without.
pub fn find(name: &str) -> Option<Unit> {
    let unit = |s: &Symbol, prefix: f64| Unit {
        factor: s.factor,
        power_of_ten: s.power_of_ten + prefix,
        dimension: s.dimension,
    };
    if let Some(s) = SYMBOLS.iter().find(|s| s.name == name) {
        return Some(unit(s, 0.0));
    }
    PREFIXES.iter().find_map(|&(prefix, power)| {
        let rest = name.strip_prefix(prefix)?;
        SYMBOLS
            .iter()
            .find(|s| s.takes_prefix && s.name == rest)
            .map(|s| unit(s, power))
    })
}

/// Words for units, and units without a symbol here: what to write.
const WORDS: [(&str, &str); 19] = [
    ("degree", "deg"),
    ("degrees", "deg"),
    ("grad", "deg"),
    ("micron", "um"),
    ("microns", "um"),
    ("micrometer", "um"),
    ("millimeter", "mm"),
    ("millimetre", "mm"),
    ("inch", "in"),
    ("inches", "in"),
    ("newton", "N"),
    ("lbs", "lb"),
    ("sec", "s"),
    ("U", "rev"),
    ("r", "rev"),
    ("upm", "rpm"),
    ("RPM", "rpm"),
    ("cP", "mPa s"),
    ("cSt", "mm2/s"),
];

/// The unit that was probably meant: a word for it, two units run together (`Nm`), other capitals (`KN`), or one letter
/// off, of the dimension that is wanted if one is given.
pub fn suggest(name: &str, wanted: Option<Dimension>) -> Option<String> {
    if let Some((_, unit)) = WORDS.iter().find(|(word, _)| *word == name) {
        return Some(unit.to_string());
    }
    let split = name.char_indices().skip(1).map(|(i, _)| name.split_at(i));
    let together = split
        .filter(|(a, b)| find(a).is_some() && find(b).is_some())
        .last();
    if let Some((a, b)) = together.filter(|(a, _)| a.ends_with('N')) {
        return Some(format!("{a} {b}"));
    }
    let mut candidates = Vec::new();
    for s in &SYMBOLS {
        candidates.push(s.name.to_string());
        if s.takes_prefix {
            // Nobody means a megametre or a gigagram.
            let largest = if matches!(s.name, "m" | "g" | "s" | "rad") {
                3.0
            } else {
                12.0
            };
            let usual = PREFIXES.iter().filter(|(_, power)| *power <= largest);
            candidates.extend(usual.map(|(prefix, _)| format!("{prefix}{}", s.name)));
        }
    }
    let same_letters = candidates.iter().filter(|c| c.eq_ignore_ascii_case(name));
    let near = || {
        candidates
            .iter()
            .filter(|c| wanted.is_none_or(|wanted| find(c).is_some_and(|unit| unit.dimension == wanted)))
            .find(|c| c.len() > 2 && strsim::osa_distance(c, name) == 1)
    };
    same_letters
        .min_by_key(|c| strsim::osa_distance(c, name))
        .or_else(near)
        .cloned()
}
