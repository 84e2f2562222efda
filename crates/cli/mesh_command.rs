//! `raceway mesh`: the meshes that a scene describes, or the periodic mesh of a ring that has a free one.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use comm::print;
use input::{KINDS, LENGTH, Quantity, parse_unit};
use mesh::{ElementKind, OutlineCurve, OutlinePiece, Overwrite, RingSide, SectionFineness};
use results::answer;
use results::failure::Failure;
use scene::{BuildError, MadeLike, RevolveLike};

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct MeshCommand {
    /// Scene file; its [inner.section] and [outer.section] describe the meshes.
    #[arg(required_unless_present = "revolve_like", conflicts_with = "revolve_like")]
    scene: Option<PathBuf>,
    /// Changes a value of the scene.
    #[arg(long = "set", value_name = "PATH=VALUE", conflicts_with = "revolve_like")]
    overrides: Vec<String>,
    /// Replaces existing mesh files.
    #[arg(long)]
    force: bool,
    /// Finds the section of this mesh, whose shape is a body of revolution, and revolves it into equal sectors.
    #[arg(
        long,
        value_name = "RING.msh",
        requires = "sectors",
        help_heading = "Periodic mesh of a free one"
    )]
    revolve_like: Option<PathBuf>,
    /// Numbers of the new mesh.
    #[command(flatten)]
    like: Like,
}

/// What `--revolve-like` takes.
#[derive(Debug, Args)]
#[command(next_help_heading = "Periodic mesh of a free one")]
struct Like {
    /// Elements round the ring, a multiple of the number of balls.
    #[arg(long, requires = "revolve_like")]
    sectors: Option<usize>,
    /// Elements across the groove, an even number.
    #[arg(long, default_value_t = 12, requires = "revolve_like")]
    groove_elements: usize,
    /// Elements from raceway to bore or seat, at least.
    #[arg(long, default_value_t = 4, requires = "revolve_like")]
    thickness_elements: usize,
    /// Growth of the element size away from the raceway, 1 to 3.
    #[arg(long, default_value_t = 1.2, requires = "revolve_like")]
    grading: f64,
    /// Elements of the new mesh.
    #[arg(long, value_enum, default_value_t = RevolvedElement::Hex8, requires = "revolve_like")]
    element: RevolvedElement,
    /// Length unit of both meshes.
    #[arg(long, default_value = "mm", value_parser = unit, requires = "revolve_like")]
    mesh_unit: MeshUnit,
    /// How far nodes may be off the section, such as "1 um"; default: 1e-5 of the largest radius.
    #[arg(long, value_name = "LENGTH", value_parser = length, requires = "revolve_like")]
    tolerance: Option<Quantity<LENGTH>>,
    /// The new mesh; default: the name of the ring's mesh with _periodic.
    #[arg(long, value_name = "FILE.msh", requires = "revolve_like")]
    out: Option<PathBuf>,
}

/// Elements that can be revolved.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum RevolvedElement {
    /// Trilinear hexahedra.
    Hex8,
    /// Serendipity hexahedra.
    Hex20,
}

/// A length unit, m.
#[derive(Clone, Copy, Debug)]
struct MeshUnit(f64);

fn unit(text: &str) -> Result<MeshUnit, String> {
    let unit = parse_unit(text, &KINDS[LENGTH]);
    unit.map(MeshUnit).map_err(|error| error.to_string())
}

fn length(text: &str) -> Result<Quantity<LENGTH>, String> {
    let length: Quantity<LENGTH> = text
        .parse()
        .map_err(|error: input::UnitError| error.to_string())?;
    match length.si() > 0.0 {
        true => Ok(length),
        false => Err(format!(
            "{text:?} is no tolerance; expected a positive length such as \"1 um\""
        )),
    }
}

/// Builds meshes.
pub fn mesh(command: &MeshCommand) -> Result<(), Failure> {
    let overwrite = match command.force {
        true => Overwrite::Replace,
        false => Overwrite::Refuse,
    };
    let Some(ring) = &command.revolve_like else {
        let scene = command.scene.as_deref().unwrap_or(Path::new(""));
        return Ok(scene::build_meshes(
            scene,
            &command.overrides,
            overwrite,
            &results::stop::gmsh,
        )?);
    };
    let request = request(ring, &command.like, overwrite);
    match scene::revolve_like(&request, &results::stop::gmsh) {
        Ok(made) => {
            say(&request, &made);
            Ok(())
        }
        Err(BuildError::Exists { path }) => Err(Failure::User(anyhow::anyhow!(
            "{} exists already; give --force to replace it, or another --out",
            path.display()
        ))),
        Err(error) => Err(error.into()),
    }
}

fn request(ring: &Path, like: &Like, overwrite: Overwrite) -> RevolveLike {
    let stem = ring.file_stem().unwrap_or_default().to_string_lossy();
    let out = like.out.clone();
    RevolveLike {
        ring: ring.to_path_buf(),
        mesh_unit: like.mesh_unit.0,
        out: out.unwrap_or_else(|| ring.with_file_name(format!("{stem}_periodic.msh"))),
        tolerance: like.tolerance.as_ref().map(Quantity::si),
        fineness: SectionFineness {
            kind: match like.element {
                RevolvedElement::Hex8 => ElementKind::Hex8,
                RevolvedElement::Hex20 => ElementKind::Hex20,
            },
            sectors: like.sectors.expect("the command line has it"),
            groove_elements: like.groove_elements,
            thickness_elements: like.thickness_elements,
            grading: like.grading,
        },
        overwrite,
    }
}

/// Says what was found and made.
fn say(request: &RevolveLike, made: &MadeLike) {
    let (found, groove) = (&made.revolution, &made.groove);
    let mm = |x: f64| 1e3 * x;
    print::line(format_args!(
        "{}: a body of revolution, {} nodes of its surface are within {:.1e} mm of the section (tolerance {:.1e} mm)",
        request.ring.display(),
        found.n_nodes,
        mm(found.deviation),
        mm(made.tolerance)
    ));
    let (held, key) = match groove.side {
        RingSide::Inner => ("bore", "inner"),
        RingSide::Outer => ("outside", "outer"),
    };
    print::line(format_args!(
        "groove   radius {:.6} mm about r = {:.6} mm, z = {:.6} mm; bottom diameter {:.6} mm",
        mm(groove.arc.radius),
        mm(groove.arc.centre_r),
        mm(groove.arc.centre_z),
        mm(groove.raceway_diameter())
    ));
    print::line(format_args!(
        "ring     {key}, {held} diameter {:.6} mm, width {:.6} mm, groove from diameter {:.4} to {:.4} mm",
        mm(groove.held_diameter),
        mm(groove.faces[1] - groove.faces[0]),
        2.0 * mm(groove.ends[0][0]),
        2.0 * mm(groove.ends[1][0])
    ));
    made.outline.iter().for_each(say_piece);
    print::line(format_args!(
        "{}: {} {} elements, {} nodes, {} dofs, {} equal sectors",
        request.out.display(),
        made.mesh.n_elements(),
        made.mesh.kind.name(),
        made.mesh.n_nodes(),
        made.mesh.n_dofs(),
        request.fineness.sectors
    ));
    let relative = made.volume / found.mesh_volume - 1.0;
    print::line(format_args!(
        "volume   {:.4} mm3, {:.4} mm3 before ({:+.4} %), {:.4} mm3 of the section revolved; edges of the new section \
         are within {:.5} mm of it",
        1e9 * made.volume,
        1e9 * found.mesh_volume,
        100.0 * relative,
        1e9 * found.volume,
        mm(made.section_distance)
    ));
    print::line(format_args!("scene    {}", scene_lines(request, made, key)));
    answer::add("deviation_m", found.deviation);
    answer::add("groove_radius_m", groove.arc.radius);
    answer::add("groove_z_m", groove.arc.centre_z);
    answer::add("mesh", request.out.display().to_string());
    answer::add("nodes", made.mesh.n_nodes());
    answer::add("raceway_diameter_m", groove.raceway_diameter());
    answer::add("section_distance_m", made.section_distance);
    answer::add("volume_change", relative);
}

fn say_piece(piece: &OutlinePiece) {
    let shape = match piece.curve {
        OutlineCurve::Line => "line".to_string(),
        OutlineCurve::Arc { circle, sweep } => {
            format!(
                "arc of {:.4} mm, {:.2} deg",
                1e3 * circle.radius,
                sweep.abs().to_degrees()
            )
        }
    };
    let [[r0, z0], [r1, z1]] = [piece.start, piece.end].map(|p| p.map(|x| 1e3 * x));
    let groups = match piece.groups.is_empty() {
        true => "no group".to_string(),
        false => piece.groups.join(", "),
    };
    print::line(format_args!(
        "section  ({r0:.4}, {z0:.4}) to ({r1:.4}, {z1:.4}) mm: {shape}; {groups}"
    ));
}

/// What a scene says to use the new mesh.
fn scene_lines(request: &RevolveLike, made: &MadeLike, key: &str) -> String {
    let name = request.out.display().to_string();
    // In nanometres and back, so that zero has no sign.
    let groove_z = (made.groove.arc.centre_z * 1e12).round() / 1e9 + 0.0;
    match groove_z {
        0.0 => format!("{key}.mesh = {name:?}"),
        z => format!("{key}.mesh = {name:?}, {key}.groove_z = \"{z} mm\""),
    }
}
