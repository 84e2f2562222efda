//! Long tables of a run: `balls.csv`, `shaft.csv`, `energy.csv`, `cage.csv`, `probes.csv`, `profiles.csv`. SI units in
//! the column names.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use checkpoint::{Companion, GrowingFile, Stamps};
use contact::Side;
use dynamics::balls::{BallResult, ContactResult};

use super::cut::TableCut;
use super::film::FilmLaw;
use super::free_columns::{
    FREE_BALL_COLUMNS, FRICTION_COLUMNS, POCKET_COLUMNS, TRACTION_COLUMNS, cage_cells, cage_columns,
    free_cells, friction_cells, pocket_cells,
};
use super::probes::ProfileRow;
use super::snapshot::Snapshot;

/// The tables of one run, open for appending.
pub struct Tables {
    balls: csv::Writer<GrowingFile>,
    shaft: csv::Writer<GrowingFile>,
    energy: csv::Writer<GrowingFile>,
    /// Only with a free cage.
    cage: Option<csv::Writer<GrowingFile>>,
    /// Only in a scene with probes.
    probes: Option<csv::Writer<GrowingFile>>,
    /// Only in a scene with profiles.
    profiles: Option<csv::Writer<GrowingFile>>,
    /// Whether balls have a spin.
    with_spin: bool,
    /// Films, of balls that turn and a lubricant.
    film: Option<FilmLaw>,
}

const BALLS: &str = "balls.csv";
const SHAFT: &str = "shaft.csv";
const ENERGY: &str = "energy.csv";
const CAGE: &str = "cage.csv";
const PROBES: &str = "probes.csv";
const PROFILES: &str = "profiles.csv";

const REACTION_COLUMNS: [&str; 5] = [
    "reaction_x_n",
    "reaction_y_n",
    "reaction_z_n",
    "reaction_tilt_x_n_m",
    "reaction_tilt_y_n_m",
];

const CONTACT_COLUMNS: [&str; 6] = [
    "force_n",
    "contact_angle_rad",
    "approach_m",
    "semi_axis_groove_m",
    "semi_axis_rolling_m",
    "peak_pressure_pa",
];

impl Tables {
    /// Creates the files with the header lines of a first snapshot; `swept` is the column of a swept value, `probes`
    /// are the columns of probes. Balls have a spin if the first snapshot has one.
    pub fn create(
        dir: &Path,
        swept: Option<&str>,
        first: &Snapshot,
        own: &OwnColumns,
    ) -> anyhow::Result<Tables> {
        let [balls, shaft, energy] = columns(swept, first, own);
        let make = |name: &str, columns: &Option<Vec<String>>| {
            let columns = columns.as_ref().map(|own| head(swept, own));
            columns.map(|columns| create(dir, name, &columns)).transpose()
        };
        Ok(Tables {
            balls: create(dir, BALLS, &balls)?,
            shaft: create(dir, SHAFT, &shaft)?,
            energy: create(dir, ENERGY, &energy)?,
            cage: make(CAGE, &cage_columns(first))?,
            probes: make(PROBES, &own.probes)?,
            profiles: make(PROFILES, &own.profiles)?,
            with_spin: first.spin.is_some(),
            film: own.film.clone(),
        })
    }

    /// Looks where the files of an earlier run are to be cut to go on after its step `last`, which tells of
    /// them by `stamps`.
    pub fn cuts(
        dir: &Path,
        first: &Snapshot,
        own: &OwnColumns,
        (last, stamps): (u64, Option<&Stamps>),
    ) -> anyhow::Result<Vec<TableCut>> {
        let [balls, shaft, energy] = columns(None, first, own);
        let find = |name: &str, columns: &[String]| {
            let header = columns.join(",");
            let Some(stamps) = stamps else {
                return TableCut::find(dir, name, &header, last);
            };
            let stamp = stamps.get(name).copied();
            let stamp =
                stamp.ok_or_else(|| anyhow!("step {last} does not tell of {name}, which this scene has"))?;
            TableCut::at_stamp(dir, name, &header, (last, stamp))
        };
        let mut cuts = vec![find(BALLS, &balls)?, find(SHAFT, &shaft)?, find(ENERGY, &energy)?];
        let cage = cage_columns(first);
        for (name, columns) in [(CAGE, &cage), (PROBES, &own.probes), (PROFILES, &own.profiles)] {
            if let Some(columns) = columns {
                cuts.push(find(name, &head(None, columns))?);
            }
        }
        Ok(cuts)
    }

    /// Opens the files of an earlier run at [`Tables::cuts`]. Rows after the cuts are moved into the folder that
    /// `aside` makes.
    pub fn resume(
        cuts: &[TableCut],
        first: &Snapshot,
        own: &OwnColumns,
        aside: &mut dyn FnMut() -> anyhow::Result<PathBuf>,
    ) -> anyhow::Result<Tables> {
        let mut open = |cut: &TableCut| Ok::<_, anyhow::Error>(csv::Writer::from_writer(cut.make(aside)?));
        let [balls, shaft, energy] = [open(&cuts[0])?, open(&cuts[1])?, open(&cuts[2])?];
        let mut rest = cuts[3..].iter();
        let mut next = |columns: &Option<Vec<String>>| {
            let cut = columns.as_ref().and_then(|_| rest.next());
            cut.map(&mut open).transpose()
        };
        Ok(Tables {
            balls,
            shaft,
            energy,
            cage: next(&cage_columns(first))?,
            probes: next(&own.probes)?,
            profiles: next(&own.profiles)?,
            with_spin: first.spin.is_some(),
            film: own.film.clone(),
        })
    }

    /// The files, for a thread that brings them to the disk.
    pub fn companions(&self) -> anyhow::Result<Vec<Companion>> {
        let companion = |(_, table): (&str, &csv::Writer<GrowingFile>)| {
            let (path, file) = (table.get_ref().path().to_path_buf(), table.get_ref().handle()?);
            Ok(Companion { path, file })
        };
        self.all().map(companion).collect()
    }

    /// Length and checksum of each table as written so far.
    pub fn stamps(&self) -> Stamps {
        let stamp =
            |(name, table): (&str, &csv::Writer<GrowingFile>)| (name.to_string(), table.get_ref().stamp());
        self.all().map(stamp).collect()
    }

    fn all(&self) -> impl Iterator<Item = (&'static str, &csv::Writer<GrowingFile>)> {
        [(BALLS, &self.balls), (SHAFT, &self.shaft), (ENERGY, &self.energy)]
            .into_iter()
            .chain(self.cage.as_ref().map(|table| (CAGE, table)))
            .chain(self.probes.as_ref().map(|table| (PROBES, table)))
            .chain(self.profiles.as_ref().map(|table| (PROFILES, table)))
    }

    /// Appends one step; `swept` is the swept value in SI.
    pub fn append(
        &mut self,
        step: u64,
        time: f64,
        swept: Option<f64>,
        snapshot: &Snapshot,
    ) -> anyhow::Result<()> {
        let head = place_of(step, time, swept);
        let row = |cells: Vec<String>| [head.clone(), cells].concat();
        let balls = snapshot.balls.iter().enumerate();
        let spin = snapshot.spin.filter(|_| self.with_spin);
        // Free balls have rotations of their own.
        let of_film = spin.unwrap_or_default();
        let rolling = |ball: &BallResult| -> Vec<String> {
            let film = self.film.iter().filter(|_| spin.is_some() || ball.free.is_some());
            let films = film.flat_map(|film| film.cells(ball, of_film));
            spin.into_iter().chain(films).map(number).collect()
        };
        let shaft = snapshot.shaft.iter().chain(snapshot.reaction.iter().flatten());
        let friction = snapshot.friction.iter().flat_map(friction_cells);
        let shaft = shaft.chain(&snapshot.seat).copied().chain(friction);
        let energies = snapshot.energies.iter();
        append(
            &mut self.balls,
            BALLS,
            balls.map(|(i, ball)| {
                let own = [
                    ball_cells(i, ball),
                    rolling(ball),
                    pocket_cells(i, snapshot).map(number).collect(),
                ];
                row([own.concat(), ellipse_cells(ball), across_cells(ball)].concat())
            }),
        )?;
        if let (Some(table), Some(cage)) = (&mut self.cage, &snapshot.cage) {
            append(table, CAGE, [row(cage_cells(cage).map(number).to_vec())])?;
        }
        append(&mut self.shaft, SHAFT, [row(shaft.map(number).collect())])?;
        append(
            &mut self.energy,
            ENERGY,
            [row(energies.map(|(_, x)| number(*x)).collect())],
        )
    }

    /// Appends one step to the table of the probes.
    pub fn append_probes(
        &mut self,
        step: u64,
        time: f64,
        swept: Option<f64>,
        values: &[f64],
    ) -> anyhow::Result<()> {
        let Some(table) = &mut self.probes else {
            return Ok(());
        };
        let cells = values.iter().map(|x| number(*x)).collect();
        append(table, PROBES, [[place_of(step, time, swept), cells].concat()])
    }

    /// Appends the profiles of one step.
    pub fn append_profiles(
        &mut self,
        step: u64,
        time: f64,
        swept: Option<f64>,
        rows: Vec<ProfileRow>,
    ) -> anyhow::Result<()> {
        let Some(table) = &mut self.profiles else {
            return Ok(());
        };
        let cells = |(name, point, values): ProfileRow| {
            let own = [name, point.to_string()]
                .into_iter()
                .chain(values.into_iter().map(number));
            place_of(step, time, swept).into_iter().chain(own).collect()
        };
        append(table, PROFILES, rows.into_iter().map(cells))
    }
}

/// Columns of the tables that only some scenes have, without step and time; None where there is no table.
#[derive(Debug, Default)]
pub struct OwnColumns {
    /// Of `probes.csv`.
    pub probes: Option<Vec<String>>,
    /// Of `profiles.csv`.
    pub profiles: Option<Vec<String>>,
    /// Films in `balls.csv`.
    pub film: Option<FilmLaw>,
}

/// Header line: step, time, a swept value, and the rest.
pub fn head(swept: Option<&str>, rest: &[String]) -> Vec<String> {
    let mut columns = vec!["step".to_string(), "time_s".to_string()];
    columns.extend(swept.map(str::to_string));
    columns.extend(rest.iter().cloned());
    columns
}

/// The first cells of a row.
pub fn place_of(step: u64, time: f64, swept: Option<f64>) -> Vec<String> {
    let mut cells = vec![step.to_string(), number(time)];
    cells.extend(swept.map(number));
    cells
}

/// Appends rows and hands them to the system: a killed run loses none of them.
pub fn append(
    table: &mut csv::Writer<GrowingFile>,
    name: &str,
    rows: impl IntoIterator<Item = Vec<String>>,
) -> anyhow::Result<()> {
    let write = || -> csv::Result<()> {
        for row in rows {
            table.write_record(row)?;
        }
        Ok(table.flush()?)
    };
    write().with_context(|| format!("cannot write {name} of the results"))
}

/// Cells of a ball in the columns [`ball_columns`].
pub fn ball_cells(index: usize, ball: &BallResult) -> Vec<String> {
    let mut cells = vec![index.to_string(), number(ball.azimuth_rad)];
    cells.extend([ball.inner.force_n, ball.outer.force_n].map(number));
    cells.extend([ball.inner.contact_angle_rad, ball.outer.contact_angle_rad].map(number));
    for contact in [&ball.inner, &ball.outer] {
        cells.extend(rest_of(contact).map(number));
    }
    cells.extend([ball.displacement_m.radial, ball.displacement_m.axial].map(number));
    if let Some(free) = &ball.free {
        cells.extend(free_cells(free).map(number));
    }
    cells
}

/// Cells of contacts whose raceways have strips: whether their ellipse is Hertz's.
fn ellipse_cells(ball: &BallResult) -> Vec<String> {
    let ellipses = Side::BOTH
        .into_iter()
        .filter_map(|side| ball.contact(side).ellipse);
    ellipses.map(|ellipse| ellipse.name().to_string()).collect()
}

/// Cells of balls that see the inner groove as a torus: the force across their planes.
fn across_cells(ball: &BallResult) -> Vec<String> {
    ball.across_n.into_iter().map(number).collect()
}

/// Columns of [`ellipse_cells`].
fn ellipse_columns(first: &Snapshot) -> Vec<String> {
    let has_strips = |side: &Side| {
        first
            .balls
            .iter()
            .any(|ball| ball.contact(*side).ellipse.is_some())
    };
    let sides = Side::BOTH.into_iter().filter(has_strips);
    sides.map(|side| format!("{}_ellipse", side.name())).collect()
}

fn rest_of(contact: &ContactResult) -> [f64; 4] {
    [
        contact.approach_m,
        contact.semi_axes_m.groove,
        contact.semi_axes_m.rolling,
        contact.peak_pressure_pa,
    ]
}

/// Shortest text that reads back as the same number.
pub fn number(x: f64) -> String {
    format!("{x:?}")
}

fn names(list: &[&str]) -> Vec<String> {
    list.iter().map(|s| s.to_string()).collect()
}

/// Columns that `balls.csv` always has.
pub fn ball_columns() -> Vec<String> {
    let mut balls = names(&[
        "ball",
        "azimuth_rad",
        "inner_force_n",
        "outer_force_n",
        "inner_contact_angle_rad",
        "outer_contact_angle_rad",
    ]);
    for side in ["inner", "outer"] {
        balls.extend(CONTACT_COLUMNS[2..].iter().map(|c| format!("{side}_{c}")));
    }
    balls.extend(names(&["displacement_radial_m", "displacement_axial_m"]));
    balls
}

/// Columns of the three tables.
fn columns(swept: Option<&str>, first: &Snapshot, own: &OwnColumns) -> [Vec<String>; 3] {
    let head = |rest: &[String]| head(swept, rest);
    let mut balls = ball_columns();
    if first.friction.is_some() {
        for side in ["inner", "outer"] {
            balls.extend(TRACTION_COLUMNS.iter().map(|c| format!("{side}_{c}")));
        }
        balls.extend(names(&FREE_BALL_COLUMNS));
    }
    if first.spin.is_some() {
        balls.push("spin_rad_per_s".to_string());
    }
    if first.spin.is_some() || first.friction.is_some() {
        balls.extend(own.film.iter().flat_map(FilmLaw::columns));
    }
    if first.cage.is_some() {
        balls.extend(names(&POCKET_COLUMNS));
    }
    balls.extend(ellipse_columns(first));
    let sees_torus = first.balls.iter().any(|ball| ball.across_n.is_some());
    balls.extend(sees_torus.then(|| "inner_across_n".to_string()));
    let mut shaft = names(&["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"]);
    if first.reaction.is_some() {
        shaft.extend(names(&REACTION_COLUMNS));
    }
    if first.seat.is_some() {
        shaft.push("outer_seat_z_m".to_string());
    }
    if first.friction.is_some() {
        shaft.extend(names(&FRICTION_COLUMNS));
    }
    let terms = first.energies.iter();
    let energy: Vec<String> = terms.map(|(term, _)| format!("{term}_j")).collect();
    [head(&balls), head(&shaft), head(&energy)]
}

/// A new table with its header line.
pub fn create(dir: &Path, name: &str, columns: &[String]) -> anyhow::Result<csv::Writer<GrowingFile>> {
    let mut writer = csv::Writer::from_writer(GrowingFile::create(&dir.join(name))?);
    append(&mut writer, name, [columns.to_vec()])?;
    Ok(writer)
}
