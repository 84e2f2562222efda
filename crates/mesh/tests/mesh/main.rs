//! The crate as its users see it: files by gmsh, files of our own, revolved rings.

mod files;
mod nearly_periodic;
mod periodic;
mod revolution;
mod revolved;
mod rings;
mod written;

use std::path::PathBuf;

use mesh::{ElementKind, Mesh, RingSection, RingSide, Section, read_section, revolve};

/// A fixture by gmsh 4.8.4, see `data/README.md`.
fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data")
        .join(name)
}

/// A ring of the 7010C bearing with the mesh numbers of the fixtures.
fn ring(side: RingSide) -> RingSection {
    let is_outer = side == RingSide::Outer;
    RingSection {
        side,
        seat_diameter: if is_outer { 80e-3 } else { 50e-3 },
        raceway_diameter: if is_outer { 74.037e-3 } else { 56.01e-3 },
        groove_radius: if is_outer { 4.75e-3 } else { 4.65e-3 },
        shoulder_diameters: if is_outer { [68.6e-3; 2] } else { [60.4e-3; 2] },
        width: 16e-3,
        groove_offset: 0.0,
        groove_elements: 8,
        thickness_elements: 3,
        shoulder_elements: [2, 2],
        grading: 1.3,
    }
}

fn section(side: RingSide) -> Section {
    let name = if side == RingSide::Outer {
        "outer_section.msh"
    } else {
        "inner_section.msh"
    };
    read_section(data(name), 1e-3).unwrap()
}

fn revolved(side: RingSide, n_sectors: usize, kind: ElementKind) -> Mesh {
    let snap = ring(side).geometry().unwrap().snap();
    revolve(&section(side), n_sectors, kind, &[snap]).unwrap()
}

/// Volume of the polyhedral (hex8) or curved (hex20) mesh against the closed form.
fn relative_volume(mesh: &Mesh, side: RingSide) -> f64 {
    mesh::volume(mesh) / ring(side).volume().unwrap() - 1.0
}
