//! `raceway spectrum`: amplitude spectrum, power density and envelope spectrum of a signal of a motion, with the lines
//! at which defects of the bearing show.

pub mod fourier;
pub mod lines;

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context, anyhow, ensure};
use checkpoint::{all_steps, read_any_step};
use clap::Args;
use comm::print;
use figure::{Axis, Figure, Series};
use plot::{Unit, quantity};
use results::failure::Failure;
use results::integrity::warn_of_doubts;
use results::table::Table;
use results::whole::{make_folder, require_own_picture, write, write_picture};
use scene::{MeshFiles, Scene};

use fourier::LineSpectrum;
use lines::{Line, lines};

/// What the command line asks for.
#[derive(Debug, Args)]
#[command(name = "spectrum")]
pub struct SpectrumCommand {
    /// Folder of the results of a motion.
    dir: PathBuf,
    /// Column of probes.csv or shaft.csv, or a probe that has only one column.
    #[arg(long)]
    probe: String,
    /// LineSpectrum of the envelope of this band, Hz, such as 2000..8000.
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
    /// Highest frequency of the figure, Hz; default: the tenth multiple of the highest line.
    #[arg(long)]
    upto: Option<f64>,
}

/// Two frequencies, Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band([f64; 2]);

impl FromStr for Band {
    type Err = String;

    fn from_str(text: &str) -> Result<Band, String> {
        let expected = || format!("expected two frequencies in Hz such as 2000..8000, found {text:?}");
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

/// Fewest samples of a spectrum.
const LEAST_SAMPLES: usize = 16;
/// Largest deviation of a step from the mean one.
const UNEQUAL: f64 = 1e-6;
/// Height from name to name of the lines in a figure, as a share of it.
const LABEL_STEP: f64 = 0.08;
/// Name of the first column of what is written.
const FREQUENCY: &str = "frequency_hz";

/// A signal of equal steps.
struct Signal {
    /// What it is, without its unit.
    name: String,
    /// Unit as it ends names of columns.
    ending: String,
    /// How it is shown.
    unit: Unit,
    values: Vec<f64>,
    /// Samples a second.
    rate: f64,
    /// First and last time, s.
    span: (f64, f64),
}

/// A spectrum and how it is called.
struct Titled {
    spectrum: LineSpectrum,
    /// Name of the files.
    file: String,
    /// Second column of the table.
    column: String,
    title: String,
    axis: Axis,
    is_density: bool,
    /// From SI to the unit of the axis.
    factor: f64,
}

/// Writes the table and the figure of a spectrum.
pub fn spectrum(request: &SpectrumCommand) -> Result<(), Failure> {
    let dir = &request.dir;
    require_folder(dir)?;
    let signal = request.signal()?;
    let marks = lines(dir, &scene_of(dir)?, signal.span)?;
    let named = request.transform(&signal)?;
    warn_of_doubts(dir)?;
    let figure = draw(&named, &marks, request.upto)?.images()?;
    let table = dir.join(format!("{}.csv", named.file));
    let picture = dir.join("figures").join(&named.file);
    require_own_picture(&picture)?;
    write_table(&table, &named)?;
    make_folder(&dir.join("figures"))?;
    write_picture(&picture, &figure.svg, &figure.png)?;
    say(dir, &named, &marks);
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

/// The scene of the run in `dir`.
fn scene_of(dir: &Path) -> Result<Scene, Failure> {
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
    /// The column that is asked for, within the span of time.
    fn signal(&self) -> anyhow::Result<Signal> {
        let (table, column) = self.column()?;
        let all = table.column("time_s")?;
        let rows: Vec<usize> = (0..table.n_rows())
            .filter(|&row| (self.from..=self.to).contains(&all[row]))
            .collect();
        ensure!(
            rows.len() >= LEAST_SAMPLES,
            "there are {} steps from {} s to {} s; expected {LEAST_SAMPLES} at least",
            rows.len(),
            self.from,
            self.to
        );
        let times: Vec<f64> = rows.iter().map(|&row| all[row]).collect();
        let rate = equal_rate(&times)?;
        let values = table.column(&column)?;
        let values: Vec<f64> = rows.iter().map(|&row| values[row]).collect();
        let (name, unit) = quantity::split(&column);
        let signal = Signal {
            name: name.to_string(),
            ending: column[name.len()..].trim_start_matches('_').to_string(),
            unit,
            values,
            rate,
            span: (times[0], times[times.len() - 1]),
        };
        if !self.acceleration {
            return Ok(signal);
        }
        ensure!(
            signal.ending == "m",
            "{column} is no displacement, in m; --acceleration needs one"
        );
        Ok(Signal {
            name: format!("{}_acceleration", signal.name),
            ending: "m_per_s2".to_string(),
            unit: quantity::split("a_m_per_s2").1,
            values: fourier::acceleration(&signal.values, rate),
            ..signal
        })
    }

    /// The table that has the column asked for, and its full name.
    fn column(&self) -> anyhow::Result<(Table, String)> {
        let mut known = Vec::new();
        for name in ["probes.csv", "shaft.csv"] {
            let Some(table) = Table::read(&self.dir, name)? else {
                continue;
            };
            let columns = table
                .names()
                .iter()
                .filter(|n| !["step", "time_s"].contains(&n.as_str()));
            let columns: Vec<String> = columns.cloned().collect();
            if columns.contains(&self.probe) {
                return Ok((table, self.probe.clone()));
            }
            let start = format!("{}_", self.probe);
            let of_probe: Vec<&String> = columns.iter().filter(|n| n.starts_with(&start)).collect();
            if let [column] = of_probe[..] {
                let column = column.clone();
                return Ok((table, column));
            }
            known.extend(if of_probe.is_empty() {
                columns
            } else {
                of_probe.into_iter().cloned().collect()
            });
        }
        Err(anyhow!(
            "{} has no signal {:?}; expected a column of probes.csv or shaft.csv: {}",
            self.dir.display(),
            self.probe,
            if known.is_empty() {
                "there is none".to_string()
            } else {
                known.join(", ")
            }
        ))
    }

    fn transform(&self, signal: &Signal) -> anyhow::Result<Titled> {
        let Signal {
            name, ending, unit, ..
        } = signal;
        let what = name.replace('_', " ");
        let linear = Titled {
            spectrum: fourier::amplitudes(&signal.values, signal.rate),
            file: format!("spectrum_{name}"),
            column: format!("amplitude_{ending}"),
            title: format!("Amplitudes of {what}"),
            axis: unit.axis("amplitude"),
            is_density: false,
            factor: unit.factor,
        };
        if let Some(Band(band)) = self.envelope {
            let highest = 0.5 * signal.rate;
            ensure!(
                band[1] <= highest,
                "--envelope goes up to {} Hz; the steps of the run show {highest:.1} Hz at most",
                band[1]
            );
            let envelope = fourier::envelope(&signal.values, signal.rate, band);
            return Ok(Titled {
                spectrum: fourier::amplitudes(&envelope, signal.rate),
                file: format!("spectrum_{name}_envelope"),
                column: format!("envelope_amplitude_{ending}"),
                title: format!("Envelope of {what} from {} Hz to {} Hz", band[0], band[1]),
                axis: unit.axis("amplitude of the envelope"),
                ..linear
            });
        }
        if self.density {
            return Ok(Titled {
                spectrum: fourier::density(&signal.values, signal.rate),
                file: format!("spectrum_{name}_density"),
                column: format!("density_{ending}_squared_per_hz"),
                title: format!("Power density of {what}"),
                axis: Axis::logarithmic("power density", format!("({})²/Hz", unit.sign)),
                is_density: true,
                factor: unit.factor * unit.factor,
            });
        }
        Ok(linear)
    }
}

/// Samples a second of instants that must be equally far apart.
fn equal_rate(times: &[f64]) -> anyhow::Result<f64> {
    let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    ensure!(step > 0.0, "the steps of the run have no time; expected a motion");
    let uneven = times
        .windows(2)
        .find(|t| (t[1] - t[0] - step).abs() > UNEQUAL * step);
    match uneven {
        Some(t) => Err(anyhow!(
            "the step from {} s to {} s is not like the others, {step:.6e} s; a spectrum needs equal steps",
            t[0],
            t[1]
        )),
        None => Ok(1.0 / step),
    }
}

fn draw(named: &Titled, marks: &[Line], upto: Option<f64>) -> anyhow::Result<Figure> {
    let LineSpectrum { resolution, values } = &named.spectrum;
    let highest = marks.iter().map(|line| line.frequency).fold(0.0, f64::max);
    let end = upto
        .unwrap_or(10.0 * highest)
        .min(*resolution * (values.len() - 1) as f64);
    ensure!(
        end > 2.0 * resolution,
        "the record is too short for a figure up to {end} Hz: its resolution is {resolution:.6} Hz"
    );
    // The mean is taken out: frequency 0 has nothing to show.
    let last = (end / resolution).floor() as usize;
    let points: Vec<[f64; 2]> = (1..=last)
        .map(|k| [k as f64 * resolution, named.factor * values[k]])
        .collect();
    let top = points.iter().map(|p| p[1]).fold(f64::MIN_POSITIVE, f64::max);
    let low = points
        .iter()
        .map(|p| p[1])
        .filter(|y| *y > 0.0)
        .fold(top, f64::min);
    let bottom = if named.is_density { low } else { 0.0 };
    let mut figure = Figure::new(
        &named.title,
        Axis::linear("frequency", "Hz").tight(),
        named.axis.clone(),
    )
    .note("Dashed: lines of the bearing and their multiples, from the simulated cage speed");
    for (place, line) in marks.iter().enumerate() {
        for k in 1..=line.harmonics {
            let x = k as f64 * line.frequency;
            if x > points[points.len() - 1][0] {
                break;
            }
            figure = figure.series(Series::reference("", vec![[x, bottom], [x, top]]));
        }
        // Names stand one below the other: lines may be close.
        let height = LABEL_STEP * (place as f64 + 0.5);
        let y = if named.is_density {
            top * (bottom / top).powf(height)
        } else {
            top * (1.0 - height)
        };
        if line.frequency <= points[points.len() - 1][0] {
            figure = figure.label([line.frequency, y], line.name);
        }
    }
    Ok(figure.series(Series::line("", points)))
}

fn write_table(path: &Path, named: &Titled) -> anyhow::Result<()> {
    let head = format!("{FREQUENCY},{}\n", named.column);
    let rows = named.spectrum.values.iter().enumerate();
    let row = |(k, value): (usize, &f64)| format!("{:?},{value:?}\n", k as f64 * named.spectrum.resolution);
    let content = head.clone() + &rows.map(row).collect::<String>();
    write(path, content.as_bytes(), |old| old.starts_with(head.as_bytes()))
}

/// What stands at the lines.
fn say(dir: &Path, named: &Titled, marks: &[Line]) {
    print::line(format_args!(
        "{}.csv in {}, figure in {}; resolution {:.4} Hz; {}:",
        named.file,
        dir.display(),
        dir.join("figures").display(),
        named.spectrum.resolution,
        named.column
    ));
    for line in marks {
        let [frequency, value] = named.spectrum.peak_near(line.frequency);
        print::line(format_args!(
            "  {:<6} {:>10.3} Hz: {value:.3e} at {frequency:.3} Hz",
            line.name, line.frequency
        ));
    }
}
