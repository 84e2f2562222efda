//! Tables of the nodes of a body from another program, and the threes of rows that they have in its matrices.

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::SurroundingError;

/// A node of a seat and the area that its file gives it, m^2.
pub(crate) type SeatNode = (usize, Option<f64>);

pub(crate) fn wrong(path: &Path, line: usize, problem: String) -> SurroundingError {
    SurroundingError::File {
        path: path.to_path_buf(),
        line,
        problem,
    }
}

pub(crate) fn text_of(path: &Path) -> Result<String, SurroundingError> {
    std::fs::read_to_string(path).map_err(|source| SurroundingError::Unreadable {
        path: path.to_path_buf(),
        source,
    })
}

/// Rows of numbers and their lines.
pub(crate) fn table(
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

pub(crate) fn finite(text: &str) -> Option<f64> {
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

/// The nodes of a body in their order, with the threes of their rows.
pub(crate) struct NumberedNodes<'a> {
    pub path: &'a Path,
    /// Place of each three of rows, m.
    pub places: Vec<[f64; 3]>,
    /// Number of its node.
    pub tags: Vec<u64>,
    /// Which threes are rotations.
    pub is_rotation: Vec<bool>,
    /// The first three of each number.
    pub first: BTreeMap<u64, usize>,
}

impl NumberedNodes<'_> {
    /// Reads the nodes of a body; at least one.
    pub fn read(path: &Path, length_unit: f64) -> Result<NumberedNodes<'_>, SurroundingError> {
        let mut nodes = NumberedNodes {
            path,
            places: Vec::new(),
            tags: Vec::new(),
            is_rotation: Vec::new(),
            first: BTreeMap::new(),
        };
        for (line, row) in table(path, 4..=5, "node,x,y,z or node,x,y,z,dofs")? {
            let tag = node_number(path, line, row[0])?;
            if nodes.first.insert(tag, nodes.places.len()).is_some() {
                let twice = format!("node {tag} stands here twice; expected each once");
                return Err(wrong(path, line, twice));
            }
            let n_threes = match row.get(4) {
                None | Some(3.0) => 1,
                Some(6.0) => 2,
                Some(dofs) => {
                    let problem = format!(
                        "node {tag} has {dofs} dofs; expected 3, ux uy uz, or 6, with rx ry rz after them"
                    );
                    return Err(wrong(path, line, problem));
                }
            };
            for number in 0..n_threes {
                nodes.tags.push(tag);
                nodes.is_rotation.push(number == 1);
                nodes
                    .places
                    .push([row[1], row[2], row[3]].map(|x| length_unit * x));
            }
        }
        if nodes.places.is_empty() {
            return Err(wrong(path, 0, "no node; expected lines node,x,y,z".to_string()));
        }
        Ok(nodes)
    }

    /// The first three of rows of a node that a line of a file names.
    pub fn find(&self, path: &Path, line: usize, value: f64) -> Result<usize, SurroundingError> {
        let tag = node_number(path, line, value)?;
        let unknown = || {
            let known = self.path.display();
            let problem = format!("node {tag} is not in {known}; expected one of its nodes");
            wrong(path, line, problem)
        };
        self.first.get(&tag).copied().ok_or_else(unknown)
    }

    /// The nodes of a seat, ascending, each once.
    pub fn seat(&self, path: &Path, length_unit: f64) -> Result<Vec<SeatNode>, SurroundingError> {
        let mut seat = Vec::new();
        for (line, row) in table(path, 1..=2, "node or node,area")? {
            let area = row.get(1).map(|a| a * length_unit * length_unit);
            seat.push((self.find(path, line, row[0])?, area));
        }
        if seat.is_empty() {
            return Err(wrong(
                path,
                0,
                "no node; expected lines node or node,area".to_string(),
            ));
        }
        seat.sort_unstable_by_key(|s| s.0);
        if let Some(pair) = seat.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let twice = format!(
                "node {} stands here twice; expected each once",
                self.tags[pair[0].0]
            );
            return Err(wrong(path, 0, twice));
        }
        Ok(seat)
    }

    /// The node with six dofs with which a seat moves.
    pub fn reference(&self, tag: u64) -> Result<usize, SurroundingError> {
        let Some(&first) = self.first.get(&tag) else {
            let problem =
                format!("reference_node {tag} of a [[body.seat]] is not here; expected one of the nodes");
            return Err(wrong(self.path, 0, problem));
        };
        if self.is_rotation.get(first + 1) == Some(&true) {
            return Ok(first);
        }
        let problem = format!(
            "node {tag} is the reference_node of a [[body.seat]] and has 3 dofs, with which the ring could turn; \
             expected 6 in the fifth column, and rows rx ry rz of it in the matrices, or seat_nodes with nodes of the \
             whole cylinder"
        );
        Err(wrong(self.path, 0, problem))
    }
}
