//! `raceway init`: a commented scene of a bearing to start from.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::print;
use input::{ANGLE, LENGTH, Quantity, shell_word};
use results::answer;
use results::failure::Failure;
use scene::{MeshFiles, Scene, StarterRequest, file_name, scene_text};

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct Init {
    /// Designation with its suffixes, such as 7208, 71914 ACD, 6203-2RS1/C3; series 60, 62, 63, 618, 619, 70, 72, 73,
    /// 718 and 719 with bores of 10 to 100 mm.
    designation: Vec<String>,
    /// Bore diameter, such as "40 mm".
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<LENGTH>)]
    bore: Option<Quantity<LENGTH>>,
    /// Outside diameter.
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<LENGTH>)]
    outside: Option<Quantity<LENGTH>>,
    /// Width.
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<LENGTH>)]
    width: Option<Quantity<LENGTH>>,
    /// Number of balls; an estimate otherwise.
    #[arg(long, value_parser = clap::value_parser!(u16).range(3..=1000))]
    balls: Option<u16>,
    /// Ball diameter; an estimate otherwise.
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<LENGTH>)]
    ball_diameter: Option<Quantity<LENGTH>>,
    /// Diameter of the circle of ball centres; an estimate otherwise.
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<LENGTH>)]
    pitch_diameter: Option<Quantity<LENGTH>>,
    /// Contact angle free of load, such as "40 deg".
    #[arg(long, alias = "angle", value_name = "ANGLE", value_parser = quantity::<ANGLE>)]
    #[arg(conflicts_with = "radial_clearance")]
    contact_angle: Option<Quantity<ANGLE>>,
    /// Radial clearance of a deep groove bearing, from one extreme to the other.
    #[arg(long, alias = "clearance", value_name = "LENGTH", value_parser = quantity::<LENGTH>)]
    #[arg(allow_hyphen_values = true)]
    radial_clearance: Option<Quantity<LENGTH>>,
    /// File to write; default: the designation with .toml. An existing file is never replaced.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// A quantity on the command line.
fn quantity<const KIND: usize>(text: &str) -> Result<Quantity<KIND>, String> {
    text.parse().map_err(|error: input::UnitError| error.to_string())
}

/// Writes the scene and says what comes next.
pub fn init(request: &Init) -> Result<(), Failure> {
    let wanted = StarterRequest {
        designation: (!request.designation.is_empty()).then(|| request.designation.join(" ")),
        bore: request.bore.clone(),
        outside: request.outside.clone(),
        width: request.width.clone(),
        balls: request.balls.map(usize::from),
        ball_diameter: request.ball_diameter.clone(),
        pitch_diameter: request.pitch_diameter.clone(),
        contact_angle: request.contact_angle.clone(),
        radial_clearance: request.radial_clearance.clone(),
    };
    let default = || PathBuf::from(format!("{}.toml", file_name(&wanted)));
    let path = request.out.clone().unwrap_or_else(default);
    let stem = path
        .file_stem()
        .map_or_else(|| file_name(&wanted), |stem| stem.to_string_lossy().into_owned());
    let text = scene_text(&wanted, &stem).map_err(|problem| Failure::User(anyhow!(problem)))?;
    // Given numbers may not fit together: that is said before a file is there.
    Scene::parse(&text, &path, &[], MeshFiles::MayBeMissing)?;
    write_new(&path, &text).map_err(Failure::User)?;
    print::line(format_args!("{} is written", path.display()));
    let n = text
        .lines()
        .filter(|line| !line.starts_with('#') && line.contains("ESTIMATE"))
        .count();
    answer::add("scene", &path);
    answer::add("estimates", n);
    if n > 0 {
        print::line(format_args!(
            "{n} of its numbers are estimates, marked ESTIMATE: replace them by those of a catalogue or a drawing"
        ));
    }
    print::line(format_args!(
        "next: raceway mesh {0}, which needs Gmsh; then raceway run {0}",
        shell_word(path.display())
    ));
    Ok(())
}

fn write_new(path: &Path, text: &str) -> anyhow::Result<()> {
    let file = std::fs::File::create_new(path);
    let mut file = match file {
        Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
            return Err(anyhow!(
                "{} exists already; give another file with --out",
                path.display()
            ));
        }
        other => other.with_context(|| format!("cannot write {}", path.display()))?,
    };
    file.write_all(text.as_bytes())
        .with_context(|| format!("cannot write {}", path.display()))
}
