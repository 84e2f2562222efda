//! `[[profiles.table]]`: measured heights of a raceway or a ball; see [`super::profiles`].

use std::collections::BTreeMap;
use std::path::Path;

use contact::surface::Heights;
use serde::Deserialize;

use super::profile_place::WornBody;
use super::ring::MeshFiles;
use super::ring_name::RingName;

/// Largest height, m: more is no surface but another groove.
const MAX_TABLE_HEIGHT: f64 = 0.1e-3;

/// As typed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table [[profiles.table]]")]
pub(super) struct RawHeights {
    pub ring: Option<RingName>,
    pub ball: Option<i64>,
    file: String,
}

impl RawHeights {
    /// The heights of the file; None where it may be missing and is.
    pub(super) fn read(
        &self,
        body: WornBody,
        scene: &Path,
        files: MeshFiles,
    ) -> Result<Option<Heights>, String> {
        let path = scene.parent().unwrap_or(Path::new(".")).join(&self.file);
        if files == MeshFiles::MayBeMissing && !path.exists() {
            return Ok(None);
        }
        let text = std::fs::read_to_string(&path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        heights(&text, body)
            .map(Some)
            .map_err(|problem| format!("{}, {problem}", path.display()))
    }
}

/// A table of heights from its text: lines of two angles and a height that make a full grid.
fn heights(text: &str, body: WornBody) -> Result<Heights, String> {
    let [columns, article, along, across] = match body {
        WornBody::Ring(_) => [
            "azimuth_deg,groove_angle_deg,height_um",
            "an",
            "azimuth",
            "groove angle",
        ],
        WornBody::Ball(_) => [
            "longitude_deg,latitude_deg,height_um",
            "a",
            "longitude",
            "latitude",
        ],
    };
    let lines = text
        .lines()
        .zip(1..)
        .filter(|(line, _)| !line.trim().is_empty() && !line.starts_with('#'));
    let mut lines = lines.map(|(line, number)| (line.trim(), number));
    let head = lines
        .next()
        .map_or(String::new(), |(line, _)| line.replace(' ', ""));
    if head != columns {
        return Err(format!("line 1 is {head:?}; expected the columns {columns}"));
    }
    let mut rows: BTreeMap<u64, BTreeMap<u64, f64>> = BTreeMap::new();
    for (line, number) in lines {
        let [azimuth, angle, height] = point_of((line, number), [article, along, across])?;
        let row = rows.entry(ordered(azimuth)).or_default();
        if row.insert(ordered(angle), 1e-6 * height).is_some() {
            return Err(format!(
                "line {number} gives {line:?} again; expected each point once"
            ));
        }
    }
    let angles: Vec<u64> = rows
        .values()
        .next()
        .map(|row| row.keys().copied().collect())
        .unwrap_or_default();
    if angles.is_empty() {
        return Err(format!("there is no line below the columns {columns}"));
    }
    for (azimuth, row) in &rows {
        if !row.keys().eq(&angles) {
            return Err(format!(
                "the {along} {} deg has other {across}s than the first one; expected a full grid",
                value(*azimuth)
            ));
        }
    }
    Ok(Heights {
        azimuths: rows.keys().map(|azimuth| value(*azimuth).to_radians()).collect(),
        angles: angles.iter().map(|angle| value(*angle).to_radians()).collect(),
        heights: rows.values().flat_map(|row| row.values().copied()).collect(),
    })
}

/// The two angles, deg, and the height, um, of a numbered line, in the range of these words.
fn point_of((line, number): (&str, usize), [article, along, across]: [&str; 3]) -> Result<[f64; 3], String> {
    let cells: Vec<Option<f64>> = line.split(',').map(|cell| cell.trim().parse().ok()).collect();
    let [Some(azimuth), Some(angle), Some(height)] = cells[..] else {
        return Err(format!("line {number} is {line:?}; expected three numbers"));
    };
    let most = 1e6 * MAX_TABLE_HEIGHT;
    let is_sane = (0.0..360.0).contains(&azimuth) && angle.abs() < 90.0 && height.abs() <= most;
    if !is_sane {
        return Err(format!(
            "line {number} is {line:?}; expected {article} {along} from 0 to below 360 deg, a {across} between -90 \
             and 90 deg and a height of at most 100 um"
        ));
    }
    Ok([azimuth, angle, height])
}

/// A whole number in the order of the numbers.
fn ordered(x: f64) -> u64 {
    // Adding zero makes a negative zero positive.
    let bits = (x + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

fn value(ordered: u64) -> f64 {
    f64::from_bits(if ordered >> 63 == 1 {
        ordered & !(1 << 63)
    } else {
        !ordered
    })
}
