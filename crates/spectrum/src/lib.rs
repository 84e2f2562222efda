//! `raceway spectrum`: amplitude spectrum, power density and envelope spectrum of a signal of a motion, with the lines
//! at which defects of the bearing show; over the frequency, or over the order where the speed changes.

pub mod fourier;
pub mod lines;
pub mod orders;
pub mod passages;
mod picture;
pub mod signal;
mod sound;
mod spall_length;

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, bail, ensure};
use checkpoint::{all_steps, read_any_step};
use clap::Args;
use comm::print;
use figure::Axis;
use results::failure::Failure;
use results::integrity::warn_of_doubts;
use results::whole::{make_folder, output_folder, require_own_picture, write, write_picture};
use scene::{Analysis, MeshFiles, Scene};

use fourier::LineSpectrum;
use lines::{Line, lines, smear, smear_of_orders};
use picture::{Abscissa, FREQUENCY, Titled, draw};
use signal::Signal;

pub use spall_length::{SpallLengthCommand, spall_length};

/// What the command line asks for.
#[derive(Debug, Args)]
#[command(name = "spectrum")]
pub struct SpectrumCommand {
    /// Folder of the results of a motion.
    pub dir: PathBuf,
    /// Column of probes.csv or shaft.csv, or a probe that has only one column.
    #[arg(long)]
    probe: String,
    /// Spectrum of the envelope of this band, Hz, such as 2000..8000.
    #[arg(long, value_name = "LOW..HIGH", conflicts_with = "density")]
    envelope: Option<Band>,
    /// Power spectral density instead of amplitudes.
    #[arg(long)]
    density: bool,
    /// Of a displacement: the spectrum of its acceleration, by second differences of its steps.
    #[arg(long)]
    acceleration: bool,
    /// Start of the time that counts, s.
    #[arg(long, default_value_t = f64::NEG_INFINITY)]
    from: f64,
    /// Its end, s.
    #[arg(long, default_value_t = f64::INFINITY)]
    to: f64,
    /// Over orders, multiples of the speed of this tachometer, [probes.tachometer.NAME] of the scene: for a speed that
    /// changes.
    #[arg(long, value_name = "NAME")]
    orders: Option<String>,
    /// Writes the signal besides, as signal_NAME.wav with a text that has its scale.
    #[arg(long)]
    wav: bool,
    /// Writes the signal besides, as signal_NAME.csv.
    #[arg(long)]
    csv: bool,
    /// Highest frequency of the figure, Hz, or order; default: the tenth multiple of the highest line.
    #[arg(long)]
    upto: Option<f64>,
    /// Folder of table, figure and signal; default: the folder of the results. Nothing in it is replaced.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Two frequencies, Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band([f64; 2]);

impl FromStr for Band {
    type Err = String;

    fn from_str(text: &str) -> Result<Band, String> {
        let expected = || {
            format!("expected two frequencies in Hz, the lower one first, such as 2000..8000, found {text:?}")
        };
        let (low, high) = text.split_once("..").ok_or_else(expected)?;
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| expected());
        let band = [number(low)?, number(high)?];
        let is_rising = band[0] >= 0.0 && band[0] < band[1] && band[1].is_finite();
        if is_rising {
            Ok(Band(band))
        } else {
            Err(expected())
        }
    }
}

/// Folder of the figures in that of the tables.
const FIGURES: &str = "figures";

/// Writes the table and the figure of a spectrum.
pub fn spectrum(request: &SpectrumCommand) -> Result<(), Failure> {
    let dir = &request.dir;
    require_folder(dir)?;
    plot::require_one_bearing(dir)?;
    let scene = scene_of(dir)?;
    require_motion(dir, &scene)?;
    let signal = request.signal()?;
    let mut marks = lines(dir, &scene, signal.span)?;
    let named = request.transform(&signal)?;
    let resolution = named.spectrum.resolution;
    let smeared = match request.orders {
        None => smear(&scene, signal.span, &marks, resolution),
        Some(_) => smear_of_orders(&scene, signal.span, resolution),
    };
    if let Some(text) = smeared {
        print::note(format_args!("warning: {text}"));
    }
    marks.iter_mut().for_each(|line| {
        line.frequency /= named.over.hertz;
        line.sidebands /= named.over.hertz;
    });
    warn_of_doubts(dir)?;
    let figure = draw(&named, &marks, request.upto)?.images()?;
    let names = request.file_names(&named, &signal);
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let out = output_folder(request.out.as_deref(), dir, &names)?;
    let table = out.join(format!("{}.csv", named.file));
    let picture = out.join(FIGURES).join(&named.file);
    require_own_picture(&picture)?;
    write_table(&table, &named)?;
    make_folder(&out.join(FIGURES))?;
    write_picture(&picture, &figure.svg, &figure.png)?;
    say(out, &named, &marks);
    if request.wav {
        let [sound, text] = sound::write_wav(out, &signal)?;
        print::line(format_args!(
            "{}, its scale in {}",
            sound.display(),
            text.display()
        ));
    }
    if request.csv {
        print::line(format_args!("{}", sound::write_csv(out, &signal)?.display()));
    }
    Ok(())
}

fn require_folder(dir: &Path) -> anyhow::Result<()> {
    ensure!(
        dir.is_dir(),
        "{} is no folder; expected the results of a motion",
        dir.display()
    );
    Ok(())
}

/// Fails for a run whose steps are no times.
fn require_motion(dir: &Path, scene: &Scene) -> anyhow::Result<()> {
    let table = match &scene.analysis {
        Analysis::Dynamic(_) | Analysis::QuasiStatic(_) => return Ok(()),
        // Steps of a sweep have the scene of their point.
        Analysis::Static | Analysis::Sweep(_) => "[static] or [sweep]",
        Analysis::Modes(_) => "[modes]",
    };
    bail!(
        "{} has the results of {table}, whose steps are no times; expected those of [dynamic] or [quasi_static]",
        dir.display()
    )
}

/// The scene of the run in `dir`.
pub fn scene_of(dir: &Path) -> Result<Scene, Failure> {
    let steps = all_steps(dir)?;
    let newest = steps.last().copied();
    let newest = newest.with_context(|| format!("{} has no step files", dir.display()))?;
    let text = read_any_step(dir, newest)?.scene;
    Ok(Scene::parse(
        &text,
        &dir.join("scene"),
        &[],
        MeshFiles::MayBeMissing,
    )?)
}

impl SpectrumCommand {
    /// The files that are written.
    fn file_names(&self, named: &Titled, signal: &Signal) -> Vec<String> {
        let file = &named.file;
        let mut names = vec![format!("{file}.csv")];
        names.extend(["svg", "png"].map(|ending| format!("{FIGURES}/{file}.{ending}")));
        if self.wav {
            names.extend(sound::wav_names(signal));
        }
        if self.csv {
            names.push(sound::csv_name(signal));
        }
        names
    }

    /// The signal that is asked for, within the span of time.
    fn signal(&self) -> anyhow::Result<Signal> {
        let span = [self.from, self.to];
        let signal = Signal::read(&self.dir, &self.probe, self.orders.as_deref(), span)?;
        if self.acceleration {
            return signal.acceleration();
        }
        Ok(signal)
    }

    fn transform(&self, signal: &Signal) -> anyhow::Result<Titled> {
        let Signal {
            name, ending, unit, ..
        } = signal;
        let what = name.replace('_', " ");
        let samples = self.samples(signal)?;
        let file = |more: &str| {
            let over = if self.orders.is_some() { "_orders" } else { "" };
            format!("spectrum_{name}{more}{over}")
        };
        let linear = |file: String, column: String, title: String, axis: Axis| Titled {
            spectrum: samples.limited(fourier::amplitudes(&samples.values, samples.rate)),
            file,
            column,
            title,
            axis,
            is_density: false,
            factor: unit.factor,
            over: samples.over,
        };
        if let Some(Band(band)) = self.envelope {
            return Ok(linear(
                file("_envelope"),
                format!("envelope_amplitude_{ending}"),
                format!("Envelope of {what} from {} Hz to {} Hz", band[0], band[1]),
                unit.axis("amplitude of the envelope"),
            ));
        }
        if self.density {
            let per = if self.orders.is_some() { "order" } else { "hz" };
            return Ok(Titled {
                spectrum: samples.limited(fourier::density(&samples.values, samples.rate)),
                file: file("_density"),
                column: format!("density_{ending}_squared_per_{per}"),
                title: format!("Power density of {what}"),
                axis: Axis::logarithmic("power density", density_unit(unit.sign, samples.over)),
                is_density: true,
                factor: unit.factor * unit.factor,
                over: samples.over,
            });
        }
        Ok(linear(
            file(""),
            format!("amplitude_{ending}"),
            format!("Amplitudes of {what}"),
            unit.axis("amplitude"),
        ))
    }

    /// What is transformed: the signal, or the envelope of its band; with a tachometer at equal angles.
    fn samples(&self, signal: &Signal) -> anyhow::Result<Samples> {
        let mut values = signal.values.clone();
        if let Some(Band(band)) = self.envelope {
            let highest = (0.5e3 * signal.rate).round() / 1e3;
            ensure!(
                band[1] <= highest,
                "--envelope goes up to {} Hz; the steps of the run show {highest} Hz at most",
                band[1]
            );
            values = fourier::envelope(&values, signal.rate, band);
        }
        let Some(angles) = &signal.angles else {
            return Ok(Samples {
                values,
                rate: signal.rate,
                highest: f64::INFINITY,
                over: FREQUENCY,
            });
        };
        let turned = orders::resample(&values, angles)?;
        let seconds = (values.len() - 1) as f64 / signal.rate;
        Ok(Samples {
            values: turned.values,
            rate: turned.rate,
            highest: turned.highest,
            over: Abscissa {
                column: "order",
                name: "order",
                unit: "1",
                hertz: turned.turns / seconds,
            },
        })
    }
}

/// Unit of a power density: an order has none, and a pure number only that of the abscissa.
fn density_unit(sign: &str, over: Abscissa) -> String {
    let square = if sign == "1" {
        sign.to_string()
    } else {
        format!("({sign})²")
    };
    match over.unit {
        "1" => square,
        unit => format!("{square}/{unit}"),
    }
}

/// Samples of equal steps of time or angle.
struct Samples {
    values: Vec<f64>,
    /// Samples a second, or a turn.
    rate: f64,
    /// Largest frequency or order that they show.
    highest: f64,
    over: Abscissa,
}

impl Samples {
    /// A spectrum without what lies above the largest frequency or order.
    fn limited(&self, mut spectrum: LineSpectrum) -> LineSpectrum {
        let last = (self.highest / spectrum.resolution).floor();
        if last < spectrum.values.len() as f64 {
            spectrum.values.truncate(last as usize + 1);
        }
        spectrum
    }
}

fn write_table(path: &Path, named: &Titled) -> anyhow::Result<()> {
    let head = format!("{},{}\n", named.over.column, named.column);
    let rows = named.spectrum.values.iter().enumerate();
    let row = |(k, value): (usize, &f64)| format!("{:?},{value:?}\n", k as f64 * named.spectrum.resolution);
    let content = head.clone() + &rows.map(row).collect::<String>();
    write(path, content.as_bytes(), |old| old.starts_with(head.as_bytes()))
}

/// What stands at the lines.
fn say(out: &Path, named: &Titled, marks: &[Line]) {
    // An order has no unit.
    let unit = if named.over.column == FREQUENCY.column {
        " Hz"
    } else {
        ""
    };
    print::line(format_args!(
        "{}.csv in {}, figure in {}; resolution {:.4}{unit}; {}:",
        named.file,
        out.display(),
        out.join(FIGURES).display(),
        named.spectrum.resolution,
        named.column
    ));
    let shown = (named.spectrum.resolution, named.spectrum.highest());
    for line in marks {
        let at = |name: &str, place: f64| {
            let [frequency, value] = named.spectrum.peak_near(place);
            let doubt = match line.is_resolved(place, marks, shown) {
                true => "",
                false => "; not resolved",
            };
            print::line(format_args!(
                "  {name:<6} {place:>10.3}{unit}: {value:.3e} at {frequency:.3}{unit}{doubt}"
            ));
        };
        at(line.name, line.frequency);
        for (sign, side) in [("side -", -line.sidebands), ("side +", line.sidebands)] {
            if line.sidebands > 0.0 && line.frequency + side > 0.0 {
                at(sign, line.frequency + side);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a density over orders would have a unit over 1.
    #[test]
    fn a_density_over_orders_has_the_square_of_a_unit() {
        let orders = Abscissa {
            unit: "1",
            ..FREQUENCY
        };
        assert_eq!(density_unit("µm", FREQUENCY), "(µm)²/Hz");
        assert_eq!(density_unit("µm", orders), "(µm)²");
        assert_eq!(density_unit("1", FREQUENCY), "1/Hz");
        assert_eq!(density_unit("1", orders), "1");
    }
}
