//! A body from another program: its stiffness and mass as Matrix Market, its nodes and those of its seats as CSV.
//!
//! ```text
//! K.mtx       %%MatrixMarket matrix coordinate real symmetric|general; rows ux uy uz of each node of nodes.csv, and
//!             rx ry rz of nodes with six dofs
//! nodes.csv   node,x,y,z[,dofs]   one line per node, in the order of the rows; dofs 3 or 6, default 3
//! seat.csv    node[,area]    nodes of a seat; without areas those of their Voronoi cells on the cylinder
//! M.mtx       the same of the mass, where the body moves
//! fixed.csv   node           nodes that are held; none if the matrix is held already
//! ```
//! Lengths are in one unit and forces per length in another, which the scene states; areas in the square of the
//! first. Entries of a rotation with a displacement are in the unit of the matrix times that of lengths, those of two
//! rotations in the unit times its square. Lines that begin with # and a first line of names are skipped.
//!
//! Rows are kept in threes: a node with six dofs is two of them at one place, its displacement and its rotation.

use std::path::{Path, PathBuf};

use sprs::{CsMat, TriMat};

use crate::areas::cylinder_areas;
use crate::error::{SurroundingError, direction};
use crate::joint::{BodySeat, SeatJoint, joint, reference_joint, refuse_fixed};
use crate::nodes::{NumberedNodes, SeatNode, finite, table, text_of, wrong};
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
    /// Nodes.
    pub nodes: PathBuf,
    /// Where each seat is.
    pub seats: Vec<MatrixSeat>,
    /// Nodes that are held.
    pub fixed_nodes: Option<PathBuf>,
    /// Unit of lengths, m.
    pub length_unit: f64,
    /// Unit of stiffness, N/m.
    pub stiffness_unit: f64,
}

/// A seat among the nodes of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum MatrixSeat {
    /// File of the nodes of its cylinder.
    Nodes(PathBuf),
    /// Number of the node with six dofs with which it moves, such as the reference node of an RBE3.
    Reference(u64),
}

/// A body as its matrices say.
#[derive(Clone, Debug)]
pub struct MatrixBody {
    /// Stiffness, N/m, symmetric, all entries.
    pub stiffness: CsMat<f64>,
    /// Mass, kg, all entries.
    pub mass: Option<CsMat<f64>>,
    /// Place of each three of rows, m.
    pub places: Vec<[f64; 3]>,
    /// Numbers of their nodes.
    pub tags: Vec<u64>,
    /// Which are rotations, of nodes with six dofs.
    pub(crate) is_rotation: Vec<bool>,
    /// Which are held.
    pub fixed: Vec<bool>,
    seats: Vec<SeatPlace>,
}

/// Where a seat is.
#[derive(Clone, Debug)]
pub(crate) enum SeatPlace {
    /// Nodes, ascending, with areas, m^2, where their file has them.
    Surface(Vec<SeatNode>),
    /// The displacement of a node with six dofs; its rotation comes next.
    Reference(usize),
}

impl MatrixBody {
    /// Reads and checks all files.
    pub fn read(files: &MatrixFiles) -> Result<MatrixBody, SurroundingError> {
        let nodes = NumberedNodes::read(&files.nodes, files.length_unit)?;
        let seat = |seat: &MatrixSeat| match seat {
            MatrixSeat::Nodes(path) => nodes.seat(path, files.length_unit).map(SeatPlace::Surface),
            MatrixSeat::Reference(tag) => nodes.reference(*tag).map(SeatPlace::Reference),
        };
        let seats = files.seats.iter().map(seat).collect::<Result<_, _>>()?;
        let mut fixed = vec![false; nodes.places.len()];
        if let Some(path) = &files.fixed_nodes {
            for (line, row) in table(path, 1..=1, "node")? {
                let first = nodes.find(path, line, row[0])?;
                fixed[first] = true;
                if nodes.is_rotation.get(first + 1) == Some(&true) {
                    fixed[first + 1] = true;
                }
            }
        }
        let read = |of: (&PathBuf, f64), what| read_matrix((of.0, of.1), files.length_unit, what, &nodes);
        Ok(MatrixBody {
            stiffness: read((&files.stiffness, files.stiffness_unit), "stiffness")?,
            mass: match &files.mass {
                Some((path, unit)) => Some(read((path, *unit), "mass")?),
                None => None,
            },
            places: nodes.places,
            tags: nodes.tags,
            is_rotation: nodes.is_rotation,
            fixed,
            seats,
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

    /// Number of seats.
    pub fn n_seats(&self) -> usize {
        self.seats.len()
    }

    /// The functions of a seat on the body's side.
    pub(crate) fn joint(
        &self,
        name: &str,
        (number, seat): (usize, &BodySeat),
    ) -> Result<SeatJoint, SurroundingError> {
        let (what, fixed) = (seat.of_body(name), (&self.fixed[..], &self.tags[..]));
        match &self.seats[number] {
            SeatPlace::Surface(nodes) => {
                let areas = self.areas(&what, nodes)?;
                let made = joint(name, seat, &areas, &self.places, &self.tags)?;
                refuse_fixed(name, seat, &areas, fixed.0, fixed.1)?;
                Ok(made)
            }
            &SeatPlace::Reference(first) => {
                refuse_fixed(name, seat, &[(first, 0.0)], fixed.0, fixed.1)?;
                reference_joint(name, seat, self.places[first], [first, first + 1])
            }
        }
    }

    /// Nodes of a seat with their areas, m^2, ascending. `what` is for messages.
    fn areas(&self, what: &str, nodes: &[SeatNode]) -> Result<Vec<(usize, f64)>, SurroundingError> {
        let places: Vec<[f64; 3]> = nodes.iter().map(|&(node, _)| self.places[node]).collect();
        let tags = nodes.iter().map(|&(node, _)| self.tags[node]);
        let cylinder = SeatCylinder::of_nodes(what, tags.zip(places.iter().copied()))?;
        let cells = cylinder_areas(&cylinder, &places);
        let of = |(&(node, area), cell): (&SeatNode, f64)| (node, area.unwrap_or(cell));
        Ok(nodes.iter().zip(cells).map(of).collect())
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

/// A matrix in SI units with both halves.
fn read_matrix(
    (path, unit): (&Path, f64),
    length_unit: f64,
    what: &'static str,
    nodes: &NumberedNodes<'_>,
) -> Result<CsMat<f64>, SurroundingError> {
    let text = text_of(path)?;
    let mut lines = (1..).zip(text.lines());
    let head = lines.next().map_or("", |(_, line)| line).to_ascii_lowercase();
    let is_symmetric = is_symmetric(path, &head)?;
    let mut rows = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('%'));
    let numbers = |line: &str| line.split_whitespace().map(finite).collect::<Option<Vec<f64>>>();
    let (line, size) = rows.next().unwrap_or((1, ""));
    let n = 3 * nodes.tags.len();
    let entries = n_entries((path, line), size, nodes)?;
    // Displacements and rotations have other units.
    let unit_of = |row: usize| {
        if nodes.is_rotation[row / 3] {
            length_unit
        } else {
            1.0
        }
    };
    let mut triplets = TriMat::new((n, n));
    let mut count = 0.0;
    for (line, row) in rows {
        let inside = |x: f64| x >= 1.0 && x <= n as f64 && x.fract() == 0.0;
        match numbers(row).as_deref() {
            Some(&[i, j, value]) if inside(i) && inside(j) => {
                let (i, j) = (i as usize - 1, j as usize - 1);
                triplets.add_triplet(i, j, unit * unit_of(i) * unit_of(j) * value);
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
    let listed: CsMat<f64> = triplets.to_csr();
    let matrix = match is_symmetric {
        true => both_halves((path, what), &listed, nodes)?,
        false => listed,
    };
    require_sound((path, what), &matrix, nodes)?;
    Ok(matrix)
}

/// The whole of a matrix of which a file lists one half.
fn both_halves(
    (path, what): (&Path, &str),
    listed: &CsMat<f64>,
    nodes: &NumberedNodes<'_>,
) -> Result<CsMat<f64>, SurroundingError> {
    let mut whole = TriMat::new(listed.shape());
    for (&value, (i, j)) in listed.iter() {
        whole.add_triplet(i, j, value);
        if i == j {
            continue;
        }
        if listed.get(j, i).is_some() {
            let [(node, axis), (other, along)] =
                [i, j].map(|dof| (nodes.tags[dof / 3], direction(&nodes.is_rotation, dof)));
            let problem = format!(
                "the {what} of node {node} {axis} with node {other} {along} stands here in both halves, row {} column \
                 {} and the other way round; a file that its first line calls symmetric has one half: write general \
                 there, or take one half out",
                i + 1,
                j + 1
            );
            return Err(wrong(path, 0, problem));
        }
        whole.add_triplet(j, i, value);
    }
    Ok(whole.to_csr())
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

/// Number of entries by the line of the sizes, which must be those of all dofs of the nodes.
fn n_entries(
    (path, line): (&Path, usize),
    size: &str,
    nodes: &NumberedNodes<'_>,
) -> Result<f64, SurroundingError> {
    let n = 3 * nodes.tags.len();
    let numbers = size.split_whitespace().map(finite).collect::<Option<Vec<f64>>>();
    match numbers.as_deref() {
        Some([r, c, entries]) if *r == n as f64 && *c == n as f64 => Ok(*entries),
        Some([r, c, _]) => {
            let problem = format!(
                "the matrix is {r} x {c}, but {} has {} nodes; expected {n} x {n}, rows ux uy uz of every node{}",
                nodes.path.display(),
                nodes.first.len(),
                if nodes.is_rotation.contains(&true) {
                    ", and rx ry rz of those with 6 dofs"
                } else {
                    ""
                }
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
    nodes: &NumberedNodes<'_>,
) -> Result<(), SurroundingError> {
    let place = |dof: usize| (nodes.tags[dof / 3], direction(&nodes.is_rotation, dof));
    let diagonal: Vec<f64> = (0..matrix.rows())
        .map(|i| matrix.get(i, i).copied().unwrap_or(0.0))
        .collect();
    if let Some(dof) = diagonal.iter().position(|d| *d <= 0.0) {
        let (node, axis) = place(dof);
        let advice = match nodes.is_rotation[dof / 3] {
            true => {
                "condense the model with the inertia of what moves with the node, or give the node its own"
            }
            false => "take out nodes without elements",
        };
        let problem = format!(
            "the {what} of node {node} in {axis} is {:e}; expected a positive number: {advice}",
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
