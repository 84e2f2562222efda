//! A body from another program: its stiffness and mass as Matrix Market, its nodes and the nodes of its seat as CSV.
//!
//! ```text
//! K.mtx       %%MatrixMarket matrix coordinate real symmetric|general; rows ux uy uz of each node of nodes.csv
//! nodes.csv   node,x,y,z     one line per node, in the order of the rows
//! seat.csv    node[,area]    nodes of the seat; without areas those of their Voronoi cells on the cylinder
//! M.mtx       the same of the mass, where the body moves
//! fixed.csv   node           nodes that are held; none if the matrix is held already
//! ```
//! Lengths are in one unit and forces per length in another, which the scene states; areas in the square of the
//! first. Lines that begin with # and a first line of names are skipped.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sprs::{CsMat, TriMat};

use crate::areas::cylinder_areas;
use crate::error::{AXES, SurroundingError};
use crate::seat::SeatCylinder;

/// Allowed difference of mirrored entries, over the geometric mean of their diagonal entries.
const SYMMETRY: f64 = 1e-8;

/// Largest entry over that geometric mean: 1 of a spring between two dofs, with the last digits of seven.
const PAIR: f64 = 1.0 + 1e-6;

/// Files of a body and their units.
#[derive(Clone, Debug, PartialEq)]
pub struct MatrixFiles {
    /// Stiffness.
    pub stiffness: PathBuf,
    /// Mass, of a body that moves, and its unit, kg.
    pub mass: Option<(PathBuf, f64)>,
    /// NumberedNodes.
    pub nodes: PathBuf,
    /// NumberedNodes of the seat.
    pub seat_nodes: PathBuf,
    /// NumberedNodes that are held.
    pub fixed_nodes: Option<PathBuf>,
    /// Unit of lengths, m.
    pub length_unit: f64,
    /// Unit of stiffness, N/m.
    pub stiffness_unit: f64,
}

/// A body as its matrices say.
#[derive(Clone, Debug)]
pub struct MatrixBody {
    /// Stiffness, N/m, symmetric, all entries.
    pub stiffness: CsMat<f64>,
    /// Mass, kg, all entries.
    pub mass: Option<CsMat<f64>>,
    /// NumberedNodes, m.
    pub places: Vec<[f64; 3]>,
    /// Their numbers.
    pub tags: Vec<u64>,
    /// Which are held.
    pub fixed: Vec<bool>,
    seat: Vec<(usize, Option<f64>)>,
}

impl MatrixBody {
    /// Reads and checks all files.
    pub fn read(files: &MatrixFiles) -> Result<MatrixBody, SurroundingError> {
        let (places, tags, number) = read_nodes(files)?;
        let find = |path: &Path, line: usize, value: f64| {
            let tag = node_number(path, line, value)?;
            number.get(&tag).copied().ok_or_else(|| {
                wrong(
                    path,
                    line,
                    format!(
                        "node {tag} is not in {}; expected one of its nodes",
                        files.nodes.display()
                    ),
                )
            })
        };
        let mut seat = Vec::new();
        for (line, row) in table(&files.seat_nodes, 1..=2, "node or node,area")? {
            let area = row.get(1).map(|a| a * files.length_unit * files.length_unit);
            seat.push((find(&files.seat_nodes, line, row[0])?, area));
        }
        seat.sort_unstable_by_key(|s| s.0);
        if let Some(pair) = seat.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let twice = format!("node {} stands here twice; expected each once", tags[pair[0].0]);
            return Err(wrong(&files.seat_nodes, 0, twice));
        }
        let mut fixed = vec![false; places.len()];
        if let Some(path) = &files.fixed_nodes {
            for (line, row) in table(path, 1..=1, "node")? {
                fixed[find(path, line, row[0])?] = true;
            }
        }
        let read =
            |(path, unit): (&PathBuf, f64), what| read_matrix((path, unit), what, (&files.nodes, &tags));
        Ok(MatrixBody {
            stiffness: read((&files.stiffness, files.stiffness_unit), "stiffness")?,
            mass: match &files.mass {
                Some((path, unit)) => Some(read((path, *unit), "mass")?),
                None => None,
            },
            places,
            tags,
            fixed,
            seat,
        })
    }

    /// Turns the body by 180 deg about x: places and the directions of all dofs.
    pub fn half_turn(&mut self) {
        self.places.iter_mut().for_each(|[_, y, z]| (*y, *z) = (-*y, -*z));
        // An entry of x with y or z changes its sign.
        let turned = |row: usize, column: usize| row.is_multiple_of(3) != column.is_multiple_of(3);
        for matrix in std::iter::once(&mut self.stiffness).chain(&mut self.mass) {
            for (row, mut vector) in matrix.outer_iterator_mut().enumerate() {
                let entries = vector.iter_mut().filter(|(column, _)| turned(row, *column));
                entries.for_each(|(_, value)| *value = -*value);
            }
        }
    }

    /// NumberedNodes of the seat with their areas, m^2, ascending.
    pub(crate) fn seat_areas(&self, name: &str) -> Result<Vec<(usize, f64)>, SurroundingError> {
        let what = format!("the seat of body \"{name}\"");
        let places: Vec<[f64; 3]> = self.seat.iter().map(|&(node, _)| self.places[node]).collect();
        let tags = self.seat.iter().map(|&(node, _)| self.tags[node]);
        let cylinder = SeatCylinder::of_nodes(&what, tags.zip(places.iter().copied()))?;
        let cells = cylinder_areas(&cylinder, &places);
        let of = |((node, area), cell): (&(usize, Option<f64>), f64)| (*node, area.unwrap_or(cell));
        Ok(self.seat.iter().zip(cells).map(of).collect())
    }

    /// Pairs of nodes with a common entry.
    pub(crate) fn neighbours(&self) -> Vec<usize> {
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for (row, vector) in self.stiffness.outer_iterator().enumerate() {
            let node = row / 3;
            let columns = vector.indices().iter().map(|column| column / 3);
            pairs.extend(columns.filter(|&other| other < node).map(|other| [other, node]));
        }
        pairs.sort_unstable();
        pairs.dedup();
        // A node without neighbours is an element of its own.
        pairs.extend((0..self.places.len()).map(|node| [node, node]));
        pairs.concat()
    }
}

fn wrong(path: &Path, line: usize, problem: String) -> SurroundingError {
    SurroundingError::File {
        path: path.to_path_buf(),
        line,
        problem,
    }
}

fn text_of(path: &Path) -> Result<String, SurroundingError> {
    std::fs::read_to_string(path).map_err(|source| SurroundingError::Unreadable {
        path: path.to_path_buf(),
        source,
    })
}

/// Rows of numbers and their lines.
fn table(
    path: &Path,
    columns: std::ops::RangeInclusive<usize>,
    expected: &str,
) -> Result<Vec<(usize, Vec<f64>)>, SurroundingError> {
    let text = text_of(path)?;
    let mut rows = Vec::new();
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let cells: Vec<&str> = content.split([',', ';', '\t']).map(str::trim).collect();
        let is_head = rows.is_empty() && cells[0].starts_with(|c: char| c.is_ascii_alphabetic());
        if is_head {
            continue;
        }
        let numbers: Option<Vec<f64>> = cells.iter().map(|cell| finite(cell)).collect();
        match numbers.filter(|numbers| columns.contains(&numbers.len())) {
            Some(numbers) => rows.push((line, numbers)),
            None => {
                return Err(wrong(
                    path,
                    line,
                    format!("{content:?} is no row of the table; expected {expected}"),
                ));
            }
        }
    }
    Ok(rows)
}

fn finite(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|x| x.is_finite())
}

fn node_number(path: &Path, line: usize, value: f64) -> Result<u64, SurroundingError> {
    if value >= 0.0 && value.fract() == 0.0 && value < 9e15 {
        return Ok(value as u64);
    }
    Err(wrong(
        path,
        line,
        format!("{value} is no number of a node; expected 0, 1, 2 ..."),
    ))
}

/// Places, m, and numbers of the nodes in their order, and the place in that order of each number.
type NumberedNodes = (Vec<[f64; 3]>, Vec<u64>, BTreeMap<u64, usize>);

/// Reads the nodes of a body; at least one.
fn read_nodes(files: &MatrixFiles) -> Result<NumberedNodes, SurroundingError> {
    let (mut places, mut tags, mut number) = (Vec::new(), Vec::new(), BTreeMap::new());
    for (line, row) in table(&files.nodes, 4..=4, "node,x,y,z")? {
        let tag = node_number(&files.nodes, line, row[0])?;
        if number.insert(tag, places.len()).is_some() {
            return Err(wrong(
                &files.nodes,
                line,
                format!("node {tag} stands here twice; expected each once"),
            ));
        }
        tags.push(tag);
        places.push([row[1], row[2], row[3]].map(|x| files.length_unit * x));
    }
    if places.is_empty() {
        return Err(wrong(
            &files.nodes,
            0,
            "no node; expected lines node,x,y,z".to_string(),
        ));
    }
    Ok((places, tags, number))
}

/// A matrix in SI units with both halves, of the nodes `tags` of the file `nodes`.
fn read_matrix(
    (path, unit): (&Path, f64),
    what: &'static str,
    (nodes, tags): (&Path, &[u64]),
) -> Result<CsMat<f64>, SurroundingError> {
    let text = text_of(path)?;
    let mut lines = (1..).zip(text.lines());
    let head = lines.next().map_or("", |(_, line)| line).to_ascii_lowercase();
    let is_symmetric = is_symmetric(path, &head)?;
    let mut rows = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('%'));
    let numbers = |line: &str| line.split_whitespace().map(finite).collect::<Option<Vec<f64>>>();
    let (line, size) = rows.next().unwrap_or((1, ""));
    let n = 3 * tags.len();
    let entries = n_entries((path, line), size, (nodes, tags))?;
    let mut triplets = TriMat::new((n, n));
    let mut count = 0.0;
    for (line, row) in rows {
        let inside = |x: f64| x >= 1.0 && x <= n as f64 && x.fract() == 0.0;
        match numbers(row).as_deref() {
            Some(&[i, j, value]) if inside(i) && inside(j) => {
                let (i, j, value) = (i as usize - 1, j as usize - 1, unit * value);
                triplets.add_triplet(i, j, value);
                if is_symmetric && i != j {
                    triplets.add_triplet(j, i, value);
                }
            }
            _ => {
                let problem =
                    format!("{row:?} is no entry; expected row, column from 1 to {n}, and a number");
                return Err(wrong(path, line, problem));
            }
        }
        count += 1.0;
    }
    if count != entries {
        return Err(wrong(
            path,
            0,
            format!("{count} entries; the sizes say {entries}, so the file is not whole"),
        ));
    }
    let matrix: CsMat<f64> = triplets.to_csr();
    require_sound((path, what), &matrix, tags)?;
    Ok(matrix)
}

/// Whether a Matrix Market file holds one half of its matrix, by its first line in lower case.
fn is_symmetric(path: &Path, head: &str) -> Result<bool, SurroundingError> {
    match head.split_whitespace().collect::<Vec<_>>().as_slice() {
        [
            "%%matrixmarket",
            "matrix",
            "coordinate",
            "real" | "integer",
            "symmetric",
        ] => Ok(true),
        [
            "%%matrixmarket",
            "matrix",
            "coordinate",
            "real" | "integer",
            "general",
        ] => Ok(false),
        _ => {
            let expected = "expected first \"%%MatrixMarket matrix coordinate real symmetric\", or general";
            Err(wrong(
                path,
                1,
                format!("no Matrix Market file of this kind; {expected}"),
            ))
        }
    }
}

/// Number of entries by the line of the sizes, which must be those of three dofs of every node.
fn n_entries(
    (path, line): (&Path, usize),
    size: &str,
    (nodes, tags): (&Path, &[u64]),
) -> Result<f64, SurroundingError> {
    let n = 3 * tags.len();
    let numbers = size.split_whitespace().map(finite).collect::<Option<Vec<f64>>>();
    match numbers.as_deref() {
        Some([r, c, entries]) if *r == n as f64 && *c == n as f64 => Ok(*entries),
        Some([r, c, _]) => {
            let problem = format!(
                "the matrix is {r} x {c}, but {} has {} nodes; expected {n} x {n}, rows ux uy uz of every node",
                nodes.display(),
                tags.len()
            );
            Err(wrong(path, line, problem))
        }
        _ => Err(wrong(
            path,
            line,
            "no sizes; expected rows, columns and entries".to_string(),
        )),
    }
}

/// Positive diagonal, symmetric, and no pair of dofs of negative energy.
fn require_sound(
    (path, what): (&Path, &str),
    matrix: &CsMat<f64>,
    tags: &[u64],
) -> Result<(), SurroundingError> {
    let place = |dof: usize| (tags[dof / 3], AXES[dof % 3]);
    let diagonal: Vec<f64> = (0..matrix.rows())
        .map(|i| matrix.get(i, i).copied().unwrap_or(0.0))
        .collect();
    if let Some(dof) = diagonal.iter().position(|d| *d <= 0.0) {
        let (node, axis) = place(dof);
        let problem = format!(
            "the {what} of node {node} in {axis} is {:e}; expected a positive number: take out nodes without \
             elements",
            diagonal[dof]
        );
        return Err(wrong(path, 0, problem));
    }
    for (i, row) in matrix.outer_iterator().enumerate() {
        for (j, &value) in row.iter() {
            let other = matrix.get(j, i).copied().unwrap_or(0.0);
            let most = (diagonal[i] * diagonal[j]).sqrt();
            if (value - other).abs() > SYMMETRY * most {
                return Err(SurroundingError::NotSymmetric {
                    path: path.to_path_buf(),
                    places: [place(i), place(j)],
                    value,
                    other,
                });
            }
            if i != j && value.abs() > PAIR * most {
                let [(node, axis), (other, along)] = [place(i), place(j)];
                let problem = format!(
                    "the {what} is not positive: node {node} {axis} with node {other} {along} has {value:e}, more than \
                     the root of the product of their own entries, {most:e}; so they could move with a negative \
                     energy: correct the entry, or export the matrix once more"
                );
                return Err(wrong(path, 0, problem));
            }
        }
    }
    Ok(())
}
