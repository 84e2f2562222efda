//! The figure of a spectrum with the lines of the bearing and their names.

use anyhow::ensure;
use figure::{Axis, DataPoint, Figure, Series};

use crate::fourier::LineSpectrum;
use crate::lines::Line;

/// Height from name to name of the lines in a figure, as a share of that of the lines.
const LABEL_STEP: f64 = 0.08;

/// Height of the marks of sidebands, as a share of the figure.
const SIDEBAND_HEIGHT: f64 = 0.4;

/// A spectrum and how it is called.
pub struct Titled {
    pub spectrum: LineSpectrum,
    /// Name of the files.
    pub file: String,
    /// Second column of the table.
    pub column: String,
    pub title: String,
    pub axis: Axis,
    pub is_density: bool,
    /// From SI to the unit of the axis.
    pub factor: f64,
    pub over: Abscissa,
}

/// What a spectrum is over.
#[derive(Clone, Copy)]
pub struct Abscissa {
    /// First column of the table.
    pub column: &'static str,
    pub name: &'static str,
    pub unit: &'static str,
    /// Hz of one unit: 1, or the mean speed of the tachometer, turns a second.
    pub hertz: f64,
}

/// The frequency.
pub const FREQUENCY: Abscissa = Abscissa {
    column: "frequency_hz",
    name: "frequency",
    unit: "Hz",
    hertz: 1.0,
};

/// The figure up to a frequency or order; None: the tenth multiple of the highest line.
pub fn draw(named: &Titled, marks: &[Line], upto: Option<f64>) -> anyhow::Result<Figure> {
    let LineSpectrum { resolution, values } = &named.spectrum;
    let highest = marks.iter().map(|line| line.frequency).fold(0.0, f64::max);
    if let Some(upto) = upto {
        ensure!(upto > 0.0, "--upto is {upto}; expected more than 0");
    }
    let end = upto.unwrap_or(10.0 * highest).min(named.spectrum.highest());
    // An order has no unit.
    let unit = if named.over.unit == "1" { "" } else { " Hz" };
    ensure!(
        end > 2.0 * resolution,
        "the record is too short for a figure up to {end}{unit}: its resolution is {resolution:.6}{unit}"
    );
    // The mean is taken out: frequency 0 has nothing to show.
    let last = (end / resolution).floor() as usize;
    let points: Vec<DataPoint> = (1..=last)
        .map(|k| DataPoint::new(k as f64 * resolution, named.factor * values[k]))
        .collect();
    let top = points.iter().map(|p| p.y).fold(f64::MIN_POSITIVE, f64::max);
    let low = points
        .iter()
        .map(|p| p.y)
        .filter(|y| *y > 0.0)
        .fold(top, f64::min);
    let bottom = if named.is_density { low } else { 0.0 };
    let figure = Figure::new(
        &named.title,
        Axis::linear(named.over.name, named.over.unit).tight(),
        named.axis.clone(),
    )
    .note(
        "Dashed: lines of the bearing and their multiples, from the simulated cage speed; short: sidebands",
    );
    let last = points[points.len() - 1].x;
    let figure = with_lines(figure, marks, last, |share| match named.is_density {
        true => top * (bottom / top).powf(1.0 - share),
        false => top * share,
    });
    Ok(figure.series(Series::line("", points)))
}

/// Adds the lines up to the `last` frequency or order, with their names; `at_height` is a value of the axis by its
/// share of the height of the lines.
fn with_lines(mut figure: Figure, marks: &[Line], last: f64, at_height: impl Fn(f64) -> f64) -> Figure {
    let [bottom, top] = [0.0, 1.0].map(&at_height);
    let mut named: Vec<&Line> = marks.iter().filter(|line| line.frequency <= last).collect();
    named.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // Each line ends below its name, and the more to the left the higher: no name meets another line.
    let name_height = |rank: usize| at_height(1.0 + LABEL_STEP * (named.len() - rank) as f64);
    for line in marks {
        for (x, is_sideband) in line.family().into_iter().filter(|(x, _)| *x <= last) {
            let y = if is_sideband {
                at_height(SIDEBAND_HEIGHT)
            } else {
                top
            };
            let mark = [bottom, y].map(|y| DataPoint::new(x, y));
            figure = figure.series(Series::reference("", mark.to_vec()));
        }
    }
    for (rank, line) in named.iter().enumerate() {
        let ends = [top, name_height(rank)].map(|y| DataPoint::new(line.frequency, y));
        figure = figure
            .series(Series::reference("", ends.to_vec()))
            .label(ends[1], line.name);
    }
    figure
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: names of lines that are close would stand across other lines, or over each other.
    #[test]
    fn names_of_close_lines_stand_beside_their_own() {
        let line = |name, frequency| Line {
            name,
            frequency,
            harmonics: 3,
            sidebands: 0.3,
        };
        // A 7010C over its orders.
        let marks = [
            line("BPFO", 7.77),
            line("BPFI", 10.23),
            line("2 BSF", 7.1),
            line("cage", 0.43),
            line("shaft", 1.0),
        ];
        let values = (0..1000).map(|k| if k == 155 { 1.6e-6 } else { 1e-9 }).collect();
        let density = (true, Axis::logarithmic("power density", "m²"));
        for (is_density, axis) in [(false, Axis::linear("amplitude", "µm")), density] {
            let named = Titled {
                spectrum: LineSpectrum {
                    resolution: 0.05,
                    values: Vec::clone(&values),
                },
                file: String::new(),
                column: String::new(),
                title: "Amplitudes".to_string(),
                axis,
                is_density,
                factor: 1e6,
                over: FREQUENCY,
            };
            let svg = draw(&named, &marks, Some(50.0)).unwrap().images().unwrap().svg;
            assert_eq!(figure::clashes(&svg).unwrap(), Vec::<String>::new());
            let place = |name: &str| {
                let (before, _) = svg.split_once(&format!(">\n{name}\n</text>")).unwrap();
                let (_, own) = before.rsplit_once("<text ").unwrap();
                let number = |key: &str| {
                    let (_, rest) = own.split_once(&format!("{key}=\"")).unwrap();
                    rest.split_once('"').unwrap().0.parse::<f64>().unwrap()
                };
                [number("x"), number("y")]
            };
            let places = ["cage", "shaft", "2 BSF", "BPFO", "BPFI"].map(place);
            // From left to right, as the lines.
            assert!(places.windows(2).all(|two| two[0][0] < two[1][0]), "{places:?}");
        }
    }
}
