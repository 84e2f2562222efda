//! `raceway spall-length`: how long a spall is, from the motion of the shaft as balls pass it ([`crate::passages`]).

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};
use clap::Args;
use comm::print;
use contact::Side;
use contact::surface::sag;
use results::ball_turns::BallTurns;
use results::failure::Failure;
use results::integrity::warn_of_doubts;
use results::table::Table;
use results::whole::{output_folder, write};
use scene::{Scene, ShaftMotion, geometry};

use crate::passages::{BallAt, LEAST_QUIET, PassedBearing, ShaftRecord, SpallPassage, passages};
use crate::signal::equal_rate;
use crate::{require_folder, require_motion, scene_of};

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct SpallLengthCommand {
    /// Folder of the results of a motion.
    pub dir: PathBuf,
    /// The ring with the spall.
    #[arg(long, value_parser = ["inner", "outer"])]
    ring: String,
    /// Mass that moves with the shaft, kg; default: that of the scene, of an elastic inner ring that of a tube.
    #[arg(long, value_name = "KG")]
    mass: Option<f64>,
    /// Folder of spall_lengths.csv; default: the folder of the results. Nothing in it is replaced.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Table of the passages.
const TABLE: &str = "spall_lengths.csv";
/// Passages of one spall lie on the ring within this of each other, rad.
const SPREAD: f64 = 0.02;

/// Finds the passages, writes their table and says the length.
pub fn spall_length(command: &SpallLengthCommand) -> Result<(), Failure> {
    let dir = &command.dir;
    require_folder(dir)?;
    plot::require_one_bearing(dir)?;
    let scene = scene_of(dir)?;
    require_motion(dir, &scene)?;
    let side = Side::BOTH.into_iter().find(|side| side.name() == command.ring);
    let side = side.expect("the command line knows both names");
    let record = record(dir, &scene)?;
    let known = known(&scene, side, command.mass, &record)?;
    ensure_resolved(&record, &known)?;
    warn_of_doubts(dir)?;
    let found = passages(&record, &known);
    let head = "ball,entry_s,impact_s,azimuth_rad,length_m,flies\n";
    let row = |p: &SpallPassage| {
        let length = if p.length.is_nan() {
            String::new()
        } else {
            format!("{:?}", p.length)
        };
        let (entry, impact, azimuth, flies) = (p.entry, p.impact, p.azimuth, u8::from(p.flies));
        format!("{},{entry:?},{impact:?},{azimuth:?},{length},{flies}\n", p.ball)
    };
    let table = head.to_string() + &found.iter().map(row).collect::<String>();
    let out = output_folder(command.out.as_deref(), dir, &[TABLE])?;
    write(&out.join(TABLE), table.as_bytes(), |old| {
        old.starts_with(head.as_bytes())
    })?;
    found.iter().for_each(say_passage);
    say_all(&found, &record, &known);
    print::line(format_args!("{TABLE} in {}", out.display()));
    Ok(())
}

fn say_passage(passage: &SpallPassage) {
    let (entry, impact) = (1e3 * passage.entry, 1e3 * passage.impact);
    if passage.length.is_nan() {
        print::line(format_args!(
            "ball {:>3} loses its load at {entry:.4} ms and has some again at {impact:.4} ms, at {:.2} deg: it flies, \
             and the shaft does not tell how far",
            passage.ball,
            passage.azimuth.to_degrees()
        ));
        return;
    }
    print::line(format_args!(
        "ball {:>3} enters at {entry:.4} ms, meets the far edge at {impact:.4} ms, has left by {:.4} ms: {:.3} mm at \
         {:.2} deg{}",
        passage.ball,
        2.0 * impact - entry,
        1e3 * passage.length,
        passage.azimuth.to_degrees(),
        if passage.flies {
            "; it flies, and the spall is shorter"
        } else {
            ""
        }
    ));
}

/// The length that the passages agree on, or why there is none.
fn say_all(found: &[SpallPassage], record: &ShaftRecord, known: &PassedBearing) {
    let off = |a: &SpallPassage, b: &SpallPassage| ((a.azimuth - b.azimuth + PI).rem_euclid(TAU) - PI).abs();
    let together = |a: &SpallPassage| found.iter().filter(|b| off(a, b) < SPREAD).collect::<Vec<_>>();
    let groups = found.iter().map(together);
    let group = groups.fold(
        Vec::new(),
        |most, group| if group.len() > most.len() { group } else { most },
    );
    let told = group.iter().filter(|p| !p.flies);
    let mut lengths: Vec<f64> = told.clone().map(|p| p.length).collect();
    lengths.sort_by(f64::total_cmp);
    if found.is_empty() {
        print::line(format_args!(
            "no ball loses its load and meets an edge: no double impulse to tell a length from"
        ));
    } else if found.len() > 1 && 2 * group.len() <= found.len() {
        print::line(format_args!(
            "the passages lie at places of their own on the {} ring: no length of one spall; look at the other ring",
            known.side.name()
        ));
    } else if let Some(one) = told.min_by(|a, b| a.entry.total_cmp(&b.entry)) {
        let step = 1e3 * one.length / (one.impact - one.entry) * record.step;
        print::line(format_args!(
            "length {:.3} mm, median of {} passages of {}; a step is {step:.3} mm",
            500.0 * (lengths[lengths.len() / 2] + lengths[(lengths.len() - 1) / 2]),
            lengths.len(),
            found.len()
        ));
    } else {
        print::line(format_args!(
            "every ball flies over the spall: its length is not to be told"
        ));
    }
}

fn ensure_resolved(record: &ShaftRecord, known: &PassedBearing) -> anyhow::Result<()> {
    let quiet = record.samples(known, 1.0);
    ensure!(
        record.is_resolved(known),
        "the run has {quiet} steps from ball to ball; expected {} at least to tell entry and impact: a shorter \
         dynamic.step",
        40 * LEAST_QUIET
    );
    Ok(())
}

/// The motion of shaft and balls in `dir`.
fn record(dir: &Path, scene: &Scene) -> anyhow::Result<ShaftRecord> {
    let read = |name: &str| {
        Table::read(dir, name)?.with_context(|| {
            format!(
                "{} has no {name}; expected the results of a motion",
                dir.display()
            )
        })
    };
    let (shaft, balls) = (read("shaft.csv")?, read("balls.csv")?);
    let times = shaft.column("time_s")?;
    let motions = ["x_m", "y_m", "z_m", "tilt_x_rad", "tilt_y_rad"].map(|name| shaft.column(name));
    let motions = motions.into_iter().collect::<anyhow::Result<Vec<_>>>()?;
    let of_sides = |name: &str| -> anyhow::Result<[&[f64]; 2]> {
        let [inner, outer] = Side::BOTH.map(|side| balls.column(&format!("{}_{name}", side.name())));
        Ok([inner?, outer?])
    };
    let (forces, approaches) = (of_sides("force_n")?, of_sides("approach_m")?);
    let (angles, azimuths) = (of_sides("contact_angle_rad")?, balls.column("azimuth_rad")?);
    let turns = BallTurns::new(&balls, scene)?;
    let n = balls.n_rows() / times.len();
    ensure!(
        n > 0 && n * times.len() == balls.n_rows() && times.len() > 2,
        "{} has not the steps of shaft.csv; expected the results of a motion",
        dir.join("balls.csv").display()
    );
    let ball = |row: usize| BallAt {
        azimuth: azimuths[row],
        forces: forces.map(|column| column[row]),
        approaches: approaches.map(|column| column[row]),
        angles: angles.map(|column| column[row]),
    };
    let rows = (0..balls.n_rows()).map(ball).collect::<Vec<_>>();
    let mut steps: Vec<Vec<BallAt>> = rows.chunks(n).map(<[BallAt]>::to_vec).collect();
    for step in 1..steps.len() {
        for ball in 0..n {
            let turn = turns.between(n * (step - 1) + ball, n * step + ball);
            steps[step][ball].azimuth = steps[step - 1][ball].azimuth + turn;
        }
    }
    Ok(ShaftRecord {
        start: times[0],
        step: 1.0 / equal_rate(times)?,
        shaft: (0..times.len())
            .map(|row| [0, 1, 2, 3, 4].map(|k| motions[k][row]))
            .collect(),
        balls: steps,
    })
}

/// What is known of the bearing and its motion.
fn known(
    scene: &Scene,
    side: Side,
    mass: Option<f64>,
    record: &ShaftRecord,
) -> anyhow::Result<PassedBearing> {
    let geometry = geometry(scene);
    let bearing = &scene.bearing;
    let shaft = &scene.shaft;
    let own = match (&scene.inner.body, &scene.inner.inertia) {
        (Some(_), _) => {
            let radii = [bearing.inner_raceway_diameter, bearing.bore_diameter].map(|d| 0.5 * d);
            scene.materials.rings.density * PI * (radii[0].powi(2) - radii[1].powi(2)) * bearing.width
        }
        (None, Some(inertia)) => inertia.mass,
        (None, None) => 0.0,
    };
    let mass = mass.unwrap_or(shaft.mass + own);
    let is_free = [shaft.x, shaft.y, shaft.z].map(|motion| motion == ShaftMotion::Free);
    ensure!(
        is_free.contains(&true),
        "x, y and z of the shaft are held: nothing tells what a ball lacks; expected shaft.x = \"free\""
    );
    ensure!(
        mass > 0.0 && mass.is_finite(),
        "the shaft has no mass; expected shaft.mass in the scene, or --mass KG"
    );
    let [first, last] = [0, record.balls.len() - 1].map(|step| record.balls[step][0].azimuth);
    let duration = record.step * (record.balls.len() - 1) as f64;
    let (from, to) = (record.start, record.start + duration);
    let turned = scene.speed.as_ref().map_or(0.0, |speeds| {
        let speed = speeds.of(side);
        speed.angle(to) - speed.angle(from)
    });
    let (cage, ring) = ((last - first) / duration, turned / duration);
    ensure!(
        cage != ring,
        "balls do not roll over the {} ring: none passes a spall",
        side.name()
    );
    let diameter = bearing.ball_diameter;
    Ok(PassedBearing {
        side,
        mass,
        is_free,
        ball: (
            scene.materials.balls.density * PI / 6.0
                * (diameter.powi(3) - bearing.ball_inner_diameter.powi(3)),
            diameter,
            geometry.pitch_diameter(),
        ),
        sag: sag(&geometry, side, geometry.free_contact_angle(), 1.0),
        cage,
        ring,
    })
}
