//! Where an axis has ticks, and what they say.

/// Largest number of labelled ticks on a linear axis; half as many are the aim.
const MOST_LINEAR: f64 = 9.0;
/// Largest number of labelled powers of ten on a logarithmic axis.
const MOST_DECADES: i32 = 9;
/// Below this many decades the axis also labels 2 and 5 between powers of ten.
const FEW_DECADES: f64 = 2.2;

/// Ticks of an axis. Places are in the coordinate of the axis: values, or their logarithms.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ticks {
    /// Place and text of the labelled ticks.
    pub labelled: Vec<(f64, String)>,
    /// Places of grid lines without label.
    pub minor: Vec<f64>,
}

/// Ticks at multiples of 1, 2 or 5 times a power of ten, in the range; or of `step`, where three of these are in it and
/// not too many.
pub fn linear(low: f64, high: f64, step: Option<f64>) -> Ticks {
    let step = step
        .filter(|step| (high - low) / step <= 4.0 * MOST_LINEAR)
        .filter(|step| (high / step + 1e-9).floor() > (low / step - 1e-9).ceil() + 1.0)
        .unwrap_or_else(|| round_step((high - low) / (0.6 * MOST_LINEAR)));
    let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
    let largest = low.abs().max(high.abs());
    let labelled = (0..=(last - first) as i64)
        .map(|i| (first + i as f64) * step)
        .map(|value| (value, label(value, step, largest)))
        .collect();
    Ticks {
        labelled,
        minor: Vec::new(),
    }
}

/// Ticks at powers of ten, with 2 and 5 between them if there are few, in the range of logarithms.
pub fn logarithmic(low: f64, high: f64) -> Ticks {
    let inside = |place: f64| place >= low - 1e-9 && place <= high + 1e-9;
    let decades = low.floor() as i32..=high.ceil() as i32;
    let stride = (((high - low) as i32 + 1) / MOST_DECADES + 1).max(1);
    let few = high - low < FEW_DECADES;
    let mut ticks = Ticks::default();
    for decade in decades {
        for factor in 1..10 {
            let place = f64::from(decade) + f64::from(factor).log10();
            let labels = match factor {
                1 => decade.rem_euclid(stride) == 0,
                2 | 5 => few,
                _ => few && high - low < 0.5,
            };
            match (inside(place), labels) {
                (true, true) => ticks.labelled.push((place, power_label(factor, decade, few))),
                (true, false) if stride == 1 => ticks.minor.push(place),
                _ => {}
            }
        }
    }
    if ticks.labelled.len() < 2 {
        return values_on_logarithmic(low, high);
    }
    ticks
}

/// A range too narrow for two round values: ticks as on a linear axis, at their logarithms.
fn values_on_logarithmic(low: f64, high: f64) -> Ticks {
    let linear = linear(10f64.powf(low), 10f64.powf(high), None);
    let labelled = linear.labelled.into_iter().filter(|(value, _)| *value > 0.0);
    Ticks {
        labelled: labelled.map(|(value, text)| (value.log10(), text)).collect(),
        minor: Vec::new(),
    }
}

/// The one of 1, 2, 5 times a power of ten whose ratio to `raw` is nearest to one.
fn round_step(raw: f64) -> f64 {
    let power = 10f64.powf(raw.log10().floor());
    let ratio = |factor: &f64| (factor * power / raw).ln().abs();
    let nearest = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .min_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    nearest.unwrap_or(10.0) * power
}

fn decimals_of(step: f64) -> usize {
    (0..12)
        .find(|&n| {
            let scaled = step * 10f64.powi(n);
            (scaled - scaled.round()).abs() < 1e-6 * scaled.max(1e-300) && scaled >= 0.999
        })
        .map_or(12, |n| n as usize)
}

/// A number of an axis: plain, or with a power of ten if it would be long; with as many digits as the step needs.
fn label(value: f64, step: f64, largest: f64) -> String {
    if value.abs() < 1e-6 * step {
        return "0".into();
    }
    let decimals = decimals_of(step);
    if decimals <= 5 && largest < 1e6 {
        return minus(format!("{value:.decimals$}"));
    }
    let digits = (value.abs() / step).log10().ceil().clamp(1.0, 12.0) as usize;
    let text = format!("{value:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = match mantissa.contains('.') {
        true => mantissa.trim_end_matches('0').trim_end_matches('.'),
        false => mantissa,
    };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    minus(format!("{mantissa}·10{}", superscript(exponent)))
}

/// 10^decade times 1, 2 or 5; plain if the axis has few decades and the number is short.
fn power_label(factor: i32, decade: i32, few: bool) -> String {
    if few && (-3..=4).contains(&decade) {
        let value = f64::from(factor) * 10f64.powi(decade);
        let decimals = (-decade).max(0) as usize;
        return format!("{value:.decimals$}");
    }
    match factor {
        1 => format!("10{}", superscript(decade)),
        _ => format!("{factor}·10{}", superscript(decade)),
    }
}

fn superscript(number: i32) -> String {
    let digit = |c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32('⁰' as u32 + (c as u32 - '0' as u32)).unwrap_or(c),
    };
    number.to_string().chars().map(digit).collect()
}

/// With the sign that is as wide as a plus.
fn minus(text: String) -> String {
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(ticks: &Ticks) -> Vec<&str> {
        ticks.labelled.iter().map(|(_, text)| text.as_str()).collect()
    }

    /// Wrong: axes would carry odd numbers, or numbers that do not tell their ticks apart.
    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(texts(&linear(0.0, 10.0, None)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(
            texts(&linear(-0.02, 0.02, None)),
            ["−0.02", "−0.01", "0", "0.01", "0.02"]
        );
        assert_eq!(
            texts(&linear(0.0, 360.0, Some(90.0))),
            ["0", "90", "180", "270", "360"]
        );
        // A step that leaves one tick alone is not taken.
        assert_eq!(
            texts(&linear(0.0, 20.0, Some(45.0))),
            ["0", "5", "10", "15", "20"]
        );
        assert_eq!(texts(&linear(40.0, 50.0, Some(45.0))).len(), 6);
        assert_eq!(
            texts(&linear(331.7, 331.9, None)),
            ["331.70", "331.75", "331.80", "331.85", "331.90"]
        );
        assert_eq!(
            texts(&linear(0.0, 4e-7, None)),
            ["0", "1·10⁻⁷", "2·10⁻⁷", "3·10⁻⁷", "4·10⁻⁷"]
        );
        let narrow = linear(1e-12, 1.000_000_1e-12, None);
        let mut different = texts(&narrow);
        different.dedup();
        assert_eq!(different.len(), narrow.labelled.len(), "{narrow:?}");
        assert_eq!(
            texts(&linear(0.0, 2e9, None)),
            ["0", "5·10⁸", "1·10⁹", "1.5·10⁹", "2·10⁹"]
        );
    }

    /// Wrong: a logarithmic axis would show too many numbers, or none.
    #[test]
    fn logarithmic_ticks_are_powers_of_ten() {
        assert_eq!(
            texts(&logarithmic(-3.0, 1.0)),
            ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]
        );
        assert_eq!(texts(&logarithmic(0.0, 1.31)), ["1", "2", "5", "10", "20"]);
        assert_eq!(texts(&logarithmic(-1.0, 0.0)), ["0.1", "0.2", "0.5", "1"]);
        let wide = logarithmic(-30.0, 2.0);
        assert!((4..=9).contains(&wide.labelled.len()), "{wide:?}");
        assert!(texts(&wide).contains(&"10⁻¹²"), "{wide:?}");
        for [low, high] in [[2.0_f64, 2.1], [3.0, 3.4], [9.3, 9.5]] {
            let n = logarithmic(low.log10(), high.log10()).labelled.len();
            assert!(n >= 2, "{low} to {high}: {n}");
        }
    }
}
