//! Export of a signal: as CSV, and as WAV of 32-bit floats, with a text that says how to get its values back.
//!
//! ```text
//! value = offset + scale * sample,   offset the mean of the signal, scale its largest distance from it
//! ```
//!
//! Samples lie within -1 and 1, so that any player takes them; they are rounded to 6e-8 of the scale. A WAV file has a
//! whole number of samples a second; the text has the true one.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use anyhow::Context;
use hound::{SampleFormat, WavSpec, WavWriter};
use results::whole::{require_own, write};

use crate::signal::Signal;

/// How the text beside a WAV file begins.
const MARK: &str = "# A signal as raceway spectrum --wav wrote it: value = offset + scale * sample\n";

/// Names of the sound and of the text beside it.
pub fn wav_names(signal: &Signal) -> [String; 2] {
    let sound = format!("signal_{}.wav", signal.name);
    [sound.clone(), sound + ".toml"]
}

/// Name of the table of a signal.
pub fn csv_name(signal: &Signal) -> String {
    format!("signal_{}.csv", signal.name)
}

/// Writes `signal_NAME.wav` and `signal_NAME.wav.toml`; returns both paths.
pub fn write_wav(dir: &Path, signal: &Signal) -> anyhow::Result<[PathBuf; 2]> {
    let [sound, text] = wav_names(signal).map(|name| dir.join(name));
    require_own(&text, |old| old.starts_with(MARK.as_bytes()))?;
    // A WAV file has no place for a mark; it is known by the text beside it.
    require_own(&sound, |_| text.exists())?;
    let n = signal.values.len() as f64;
    let offset = signal.values.iter().sum::<f64>() / n;
    let scale = signal
        .values
        .iter()
        .fold(0.0f64, |s, x| s.max((x - offset).abs()));
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let rate = signal.rate.round();
    write(&sound, &wav(signal, offset, scale, rate)?, |_| true)?;
    let about = format!(
        "{MARK}column = \"{}\"\noffset = {offset:?}\nscale = {scale:?}\nsamples_per_second = {:?}\n\
         samples_per_second_of_the_wav = {rate:?}\nstart_s = {:?}\n",
        signal.column(),
        signal.rate,
        signal.start
    );
    write(&text, about.as_bytes(), |_| true)?;
    Ok([sound, text])
}

fn wav(signal: &Signal, offset: f64, scale: f64, rate: f64) -> anyhow::Result<Vec<u8>> {
    let spec = WavSpec {
        channels: 1,
        sample_rate: rate as u32,
        bits_per_sample: 32,
        sample_format: SampleFormat::Float,
    };
    let mut content = Cursor::new(Vec::new());
    let mut fill = || -> Result<(), hound::Error> {
        let mut writer = WavWriter::new(&mut content, spec)?;
        for x in &signal.values {
            writer.write_sample(((x - offset) / scale) as f32)?;
        }
        writer.finalize()
    };
    fill().with_context(|| format!("cannot make a WAV file of {}", signal.column()))?;
    Ok(content.into_inner())
}

/// Writes `signal_NAME.csv`, a line per sample; returns its path.
pub fn write_csv(dir: &Path, signal: &Signal) -> anyhow::Result<PathBuf> {
    let path = dir.join(csv_name(signal));
    let head = format!("time_s,{}\n", signal.column());
    let row = |(k, value): (usize, &f64)| format!("{:?},{value:?}\n", signal.start + k as f64 / signal.rate);
    let content = head.clone() + &signal.values.iter().enumerate().map(row).collect::<String>();
    write(&path, content.as_bytes(), |old| old.starts_with(head.as_bytes()))?;
    Ok(path)
}
