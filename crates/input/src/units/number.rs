//! Decimal numbers kept as text, so that a power of ten can be applied without rounding.

/// A decimal number: sign and digits as typed, and a separate power of ten.
#[derive(Clone, Debug, PartialEq)]
pub struct Decimal<'a> {
    /// Sign, digits and point: `-1.5`.
    digits: &'a str,
    /// Power of ten, dimensionless.
    exponent: i64,
}

/// What is wrong with a number of which `rest` could not be read: a decimal comma, a fraction, spaces or signs between
/// thousands, a sign for inches.
pub fn way_of_writing(text: &str, rest: &str) -> Option<String> {
    let whole = &text[..text.len() - rest.len()];
    let digits = |rest: &str| rest.chars().take_while(char::is_ascii_digit).collect::<String>();
    if let Some(after) = rest.strip_prefix(',') {
        let fraction = digits(after);
        return (!fraction.is_empty()).then(|| format!("numbers have a decimal point, {whole}.{fraction}"));
    }
    if let Some(after) = rest.strip_prefix('/') {
        let parts = whole.parse::<f64>().ok().zip(digits(after).parse::<f64>().ok());
        return parts.map(|(a, b)| format!("a fraction is written as a decimal number, {}", a / b));
    }
    if rest.trim_start().starts_with(['"', '\u{201d}', '\u{2033}']) {
        return Some(format!("inches are written in letters, {whole} in"));
    }
    let after = rest.strip_prefix([' ', '\u{a0}', '\u{202f}', '\''])?;
    let thousands = digits(after);
    let ends = after[thousands.len()..]
        .chars()
        .next()
        .is_none_or(|c| !"/^0123456789".contains(c));
    (thousands.len() == 3 && ends).then(|| format!("digits stand together, {whole}{thousands}"))
}

impl<'a> Decimal<'a> {
    /// The number one.
    pub const ONE: Decimal<'static> = Decimal {
        digits: "1",
        exponent: 0,
    };

    /// Splits `-1.5e3 N` into the number and ` N`; `None` when the text does not begin with a number.
    ///
    /// An `e` counts as an exponent only when digits follow it.
    pub fn split(text: &'a str) -> Option<(Self, &'a str)> {
        let bytes = text.as_bytes();
        let digits_from = |start: usize| bytes[start..].iter().take_while(|b| b.is_ascii_digit()).count();
        let mut end = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
        let whole = digits_from(end);
        end += whole;
        let mut fraction = 0;
        if bytes.get(end) == Some(&b'.') {
            fraction = digits_from(end + 1);
            if whole + fraction > 0 {
                end += 1 + fraction;
            }
        }
        if whole + fraction == 0 {
            return None;
        }
        let digits = &text[..end];
        let mut exponent = 0;
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let start = end + 1;
            let sign = usize::from(matches!(bytes.get(start), Some(b'+' | b'-')));
            let n = digits_from(start + sign);
            if n > 0 {
                let after = start + sign + n;
                exponent = parse_exponent(&text[start..after]);
                end = after;
            }
        }
        Some((Decimal { digits, exponent }, &text[end..]))
    }

    /// The nearest double to this number times ten to the `power`, infinite when out of range.
    pub fn times_power_of_ten(&self, power: i64) -> f64 {
        let exponent = self.exponent.saturating_add(power);
        format!("{}e{exponent}", self.digits).parse().unwrap_or(f64::NAN)
    }
}

/// An exponent too long for an integer is beyond any double: saturate it.
fn parse_exponent(text: &str) -> i64 {
    let bound = if text.starts_with('-') {
        i64::MIN / 4
    } else {
        i64::MAX / 4
    };
    text.parse::<i64>()
        .map_or(bound, |e| e.clamp(i64::MIN / 4, i64::MAX / 4))
}

/// Whether the text is `nan` or `inf`, with a sign and a unit or not.
pub fn is_named_non_finite(text: &str) -> bool {
    let word = text
        .trim_start_matches(['+', '-'])
        .split_whitespace()
        .next()
        .unwrap_or("");
    ["nan", "inf", "infinity"]
        .iter()
        .any(|name| word.eq_ignore_ascii_case(name))
}
