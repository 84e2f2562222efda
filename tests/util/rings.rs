//! Ring meshes of the 7010C for the tests: a structured section, revolved.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use mesh::{ElementKind, Mesh, MshFormat, Overwrite, RingSection, RingSide, Section, revolve, write_msh};

/// How finely a ring is divided: sectors, elements across the groove, along each shoulder, through the thickness.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    pub sectors: usize,
    pub groove: usize,
    pub shoulder: usize,
    pub thickness: usize,
}

/// The mesh of the runs: five elements from ball to ball, 14 040 dofs per ring.
pub const COARSE: Level = Level {
    sectors: 90,
    groove: 8,
    shoulder: 2,
    thickness: 3,
};

/// The mesh of the inputs that are refused: as few nodes as make a ring, so that its text is easily changed.
pub const TINY: Level = Level {
    sectors: 18,
    groove: 4,
    shoulder: 1,
    thickness: 1,
};

/// The coarse meshes of both rings, inner first, as files in mm. Made once per test binary.
pub fn coarse_files() -> &'static [Vec<u8>; 2] {
    static FILES: OnceLock<[Vec<u8>; 2]> = OnceLock::new();
    FILES.get_or_init(|| both(|side| file(&ring(side, COARSE), 1e-3, MshFormat::Binary)))
}

/// The tiny meshes of both rings, inner first, as text in mm. Made once per test binary.
pub fn tiny_texts() -> &'static [String; 2] {
    static TEXTS: OnceLock<[String; 2]> = OnceLock::new();
    TEXTS.get_or_init(|| {
        both(|side| String::from_utf8(file(&ring(side, TINY), 1e-3, MshFormat::Ascii)).unwrap())
    })
}

fn both<T>(make: impl Fn(RingSide) -> T) -> [T; 2] {
    [make(RingSide::Inner), make(RingSide::Outer)]
}

/// The content of the mesh's file in units of `unit` metres.
pub fn file(mesh: &Mesh, unit: f64, format: MshFormat) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ring.msh");
    write_msh(&path, mesh, unit, format, Overwrite::Refuse).unwrap();
    std::fs::read(path).unwrap()
}

/// The measures of a ring of the 7010C: those of the tests' scene, and shoulders, which the scene leaves open.
fn measures(side: RingSide, level: Level) -> RingSection {
    let (seat_diameter, raceway_diameter, groove_radius, shoulder) = match side {
        RingSide::Inner => (50e-3, 56.01e-3, 4.65e-3, 60.4e-3),
        RingSide::Outer => (80e-3, 74.037e-3, 4.75e-3, 68.6e-3),
    };
    RingSection {
        side,
        seat_diameter,
        raceway_diameter,
        groove_radius,
        shoulder_diameters: [shoulder; 2],
        width: 16e-3,
        groove_offset: 0.0,
        groove_elements: level.groove,
        thickness_elements: level.thickness,
        shoulder_elements: [level.shoulder; 2],
        grading: 1.0,
    }
}

/// A ring of 8-node hexahedra, m.
pub fn ring(side: RingSide, level: Level) -> Mesh {
    let measures = measures(side, level);
    let snap = measures.geometry().unwrap().snap();
    let section = section(&measures, level);
    revolve(&section, level.sectors, ElementKind::Hex8, &[snap]).unwrap()
}

/// A grid of columns along z and rows from the raceway, where they are finer, to the seat.
fn section(measures: &RingSection, level: Level) -> Section {
    let columns = 2 * level.shoulder + level.groove;
    let rows = level.thickness;
    let mut points = Vec::new();
    for i in 0..=columns {
        let [race, back] = ends(measures, level, i);
        for j in 0..=rows {
            let s = (j as f64 / rows as f64).powf(1.4);
            points.push([
                race[0] + s * (back[0] - race[0]),
                race[1] + s * (back[1] - race[1]),
            ]);
        }
    }
    let node = |i: usize, j: usize| i * (rows + 1) + j;
    let mut quads = Vec::new();
    for i in 0..columns {
        quads.extend((0..rows).map(|j| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]));
    }
    let on_groove = level.shoulder..level.shoulder + level.groove;
    let groups = BTreeMap::from([
        (
            "raceway".to_string(),
            on_groove.map(|i| [node(i, 0), node(i + 1, 0)]).collect(),
        ),
        (
            measures.side.seat_group().to_string(),
            (0..columns).map(|i| [node(i, rows), node(i + 1, rows)]).collect(),
        ),
    ]);
    Section::new(points, quads, &groups).unwrap()
}

/// The first and the last point (r, z) of a column, on the raceway's side and on the seat, m.
fn ends(measures: &RingSection, level: Level, column: usize) -> [[f64; 2]; 2] {
    let g = measures.geometry().unwrap();
    let (shoulder, seat) = (0.5 * measures.shoulder_diameters[0], 0.5 * measures.seat_diameter);
    let columns = 2 * level.shoulder + level.groove;
    let along_shoulder = |k: usize| (g.face_z[1] - g.groove_z[1]) * k as f64 / level.shoulder as f64;
    if column < level.shoulder {
        let z = g.face_z[0] + along_shoulder(column);
        return [[shoulder, z], [seat, z]];
    }
    if columns - column < level.shoulder {
        let z = g.face_z[1] - along_shoulder(columns - column);
        return [[shoulder, z], [seat, z]];
    }
    let share = 2.0 * (column - level.shoulder) as f64 / level.groove as f64 - 1.0;
    let angle = share * g.groove_angles[1];
    let outwards = if measures.side == RingSide::Inner {
        -1.0
    } else {
        1.0
    };
    let race = [
        g.centre_radius + outwards * g.groove_radius * angle.cos(),
        g.groove_radius * angle.sin(),
    ];
    [race, [seat, share * g.groove_z[1]]]
}
