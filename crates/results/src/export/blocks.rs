//! Parts of a result as grids of their own: one body of a bearing in the frame of the shaft, and the line of the shaft.

use assembly::Seating;
use checkpoint::{Grid, StepRecord};

use super::vtu::FieldArray;

/// VTK's types of a single point and of a line through several.
const VERTEX: u8 = 1;
const POLY_LINE: u8 = 4;
/// Value of the cell array `body` on the line of the shaft.
const SHAFT_ID: u8 = 5;

/// One body of a bearing, cut out of the grid of all its bodies.
pub struct BodyPart {
    /// Value of the cell array `body`.
    pub body: u8,
    /// It alone, in the frame of the bearing.
    grid: Grid,
    /// Its rows in the fields over points of the bearing, rising.
    points: Vec<usize>,
    /// Its rows in the fields over cells.
    cells: Vec<usize>,
}

/// The bodies of a bearing, in the order of their cells.
pub fn parts(grid: &Grid) -> Vec<BodyPart> {
    let mut bodies: Vec<u8> = Vec::new();
    for &body in &grid.body {
        if !bodies.contains(&body) {
            bodies.push(body);
        }
    }
    bodies.into_iter().map(|body| part(grid, body)).collect()
}

fn part(grid: &Grid, body: u8) -> BodyPart {
    let cells: Vec<usize> = (0..grid.types.len()).filter(|&i| grid.body[i] == body).collect();
    let mut numbers: Vec<Option<i64>> = vec![None; grid.points.len()];
    cells
        .iter()
        .flat_map(|&i| grid.cell(i))
        .for_each(|point| numbers[point] = Some(0));
    let points: Vec<usize> = (0..numbers.len()).filter(|&i| numbers[i].is_some()).collect();
    points
        .iter()
        .zip(0..)
        .for_each(|(&i, new)| numbers[i] = Some(new));
    let (mut connectivity, mut offsets) = (Vec::new(), vec![0]);
    for &i in &cells {
        connectivity.extend(grid.cell(i).filter_map(|point| numbers[point]));
        offsets.push(connectivity.len() as i64);
    }
    BodyPart {
        body,
        grid: Grid {
            points: points.iter().map(|&i| grid.points[i]).collect(),
            connectivity,
            offsets,
            types: cells.iter().map(|&i| grid.types[i]).collect(),
            body: vec![body; cells.len()],
            radius: cells.iter().map(|&i| grid.radius[i]).collect(),
        },
        points,
        cells,
    }
}

/// A grid with fields over points and cells: names, components, row-major values.
pub struct ShownGrid {
    /// The grid.
    pub grid: Grid,
    points: Vec<(&'static str, usize, Vec<f64>)>,
    cells: Vec<(&'static str, usize, Vec<f64>)>,
}

impl ShownGrid {
    /// The fields over points, and those over cells.
    pub fn fields(&self) -> [Vec<FieldArray<'_>>; 2] {
        [&self.points, &self.cells].map(|fields| {
            fields
                .iter()
                .map(|(name, n, values)| (*name, *n, &values[..]))
                .collect()
        })
    }
}

impl BodyPart {
    /// The body at a step, in the frame of the shaft on which its bearing sits.
    pub fn on_shaft(&self, record: &StepRecord, seating: &Seating) -> ShownGrid {
        let place = |own: &[f64; 3]| {
            let [x, y, z] = seating.orientation.turned_vector(*own);
            [x, y, z + seating.position]
        };
        let turned = |fields: Vec<FieldArray<'_>>, rows: &[usize]| {
            let field = |(name, n, values): FieldArray<'_>| (name, n, turned_rows(seating, n, values, rows));
            fields.into_iter().map(field).collect()
        };
        ShownGrid {
            grid: Grid {
                points: self.grid.points.iter().map(place).collect(),
                ..self.grid.clone()
            },
            points: turned(record.points.arrays(), &self.points),
            cells: turned(record.cells.arrays(), &self.cells),
        }
    }
}

/// Chosen rows of a field in the frame of the shaft: a vector of three components, tensors of six, else scalars.
fn turned_rows(seating: &Seating, n: usize, values: &[f64], rows: &[usize]) -> Vec<f64> {
    let orientation = seating.orientation;
    let mut chosen: Vec<f64> = rows
        .iter()
        .flat_map(|&i| &values[n * i..n * (i + 1)])
        .copied()
        .collect();
    match n {
        3 => {
            let vectors = chosen.as_chunks_mut::<3>().0;
            vectors
                .iter_mut()
                .for_each(|v| *v = orientation.turned_vector(*v));
        }
        n if n.is_multiple_of(6) => {
            let tensors = chosen.as_chunks_mut::<6>().0;
            tensors
                .iter_mut()
                .for_each(|s| *s = orientation.turned_tensor(*s));
        }
        _ => {}
    }
    chosen
}

/// The line of the shaft: positions, m, and x, y, z, m, tilt x, tilt y, rad, of its points. A point alone is a vertex.
pub fn shaft_line(line: &[(f64, [f64; 5])]) -> ShownGrid {
    let n = line.len();
    let each = |row: &dyn Fn(&[f64; 5]) -> [f64; 3]| line.iter().flat_map(|(_, q)| row(q)).collect();
    ShownGrid {
        grid: Grid {
            points: line.iter().map(|(z, _)| [0.0, 0.0, *z]).collect(),
            connectivity: (0..n as i64).collect(),
            offsets: vec![0, n as i64],
            types: vec![if n == 1 { VERTEX } else { POLY_LINE }],
            body: vec![SHAFT_ID],
            radius: vec![0.0],
        },
        points: vec![
            ("displacement", 3, each(&|q| [q[0], q[1], q[2]])),
            ("rotation", 3, each(&|q| [q[3], q[4], 0.0])),
        ],
        cells: Vec::new(),
    }
}
