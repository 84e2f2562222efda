//! The defect of a ring that is periodic but for some nodes and elements: what it adds to the matrices of the regular
//! ring.
//!
//! K = K_regular + the difference of the defect's elements, assembled twice: with their nodes where they are, and
//! where they would be in the regular ring, which has missing elements as well. The same for M. Products use the sum;
//! factors follow from those of the regular ring ([`solver::cyclic::CyclicDefect`]). Elements of nodes that are held
//! besides, or are free alone, belong to the defect too: their rows are gone from the true matrix, or new in it.
//! Cost: 16 n^2 bytes for n rows.

use mesh::{Mesh, NearlyPeriodic};
use sprs::CsMat;

use crate::coordinates::Coordinates;
use crate::error::RingError;
use crate::harmonic::defect_change::{Changes, DefectElements};
use crate::harmonic::regular::RegularRing;
use crate::model::RingModel;
use crate::sparse::{node_product, product};

/// Most rows of a defect, and most that it lacks: beyond, its dense system costs more than harmonics save.
const MOST_ROWS: usize = 1500;

/// A defect in nodal dofs.
pub struct RingDefect {
    /// Nodes of its elements in the regular ring, ascending: those of the true ring, then absent ones.
    nodes: Vec<usize>,
    /// How many of them the true ring has.
    n_present: usize,
    /// Its elements as they are, and as they would be.
    patches: [DefectElements; 2],
    /// Differences of M and K between nodes that are there.
    change: [CsMat<f64>; 2],
    note: String,
    bytes: usize,
}

/// A defect is solved as one if so many nodes are few, that it touches and that are gone; else the reason.
fn require_small(n_present: usize, n_gone: usize) -> Result<(), String> {
    for (n, what) in [(n_present, "touches"), (n_gone, "lacks")] {
        if 3 * n > MOST_ROWS {
            return Err(format!(
                "it is periodic up to a defect that {what} {} dofs, more than {MOST_ROWS}",
                3 * n
            ));
        }
    }
    Ok(())
}

impl RingDefect {
    /// The defect between a ring and its regular one; None when there is none. The inner error says why it cannot be
    /// solved as one.
    pub fn new(
        ring: &RingModel,
        nearly: &NearlyPeriodic,
        regular: &RegularRing,
        side: &'static str,
    ) -> Result<Result<Option<RingDefect>, String>, RingError> {
        let (mesh, n_nodes) = (&ring.mesh, ring.mesh.n_nodes());
        let missing = mesh.n_elements()..mesh.n_elements() + nearly.n_missing(mesh);
        let mut otherwise_held = [&regular.held_besides[..], &regular.loose].concat();
        otherwise_held.sort_unstable();
        let elements = [nearly.elements(mesh), elements_of(mesh, &otherwise_held)].concat();
        let mut present = elements.clone();
        present.sort_unstable();
        present.dedup();
        let all: Vec<usize> = present.iter().copied().chain(missing.clone()).collect();
        let mut nodes: Vec<usize> = all
            .iter()
            .flat_map(|&e| regular.mesh.element(e))
            .copied()
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        if nodes.is_empty() {
            return Ok(Ok(None));
        }
        let n_present = nodes.partition_point(|&node| node < n_nodes);
        let n_gone = nodes.len() - n_present + regular.held_besides.len();
        if let Err(reason) = require_small(n_present, n_gone) {
            return Ok(Err(reason));
        }
        // Absent nodes belong to no element of the true ring, so their places there mean nothing.
        let mut placed = regular.mesh.nodes.to_vec();
        placed[..n_nodes].copy_from_slice(&mesh.nodes);
        let patch = |positions: &[[f64; 3]], elements: &[usize]| {
            let whole = &regular.mesh;
            let mut part = whole.part(elements, &nodes);
            part.nodes = nodes.iter().map(|&node| positions[node]).collect();
            DefectElements::new(part, ring).map_err(|source| RingError::Fem { side, source })
        };
        let patches = [patch(&placed, &present)?, patch(&regular.mesh.nodes, &all)?];
        let rows: Vec<usize> = (0..n_present).collect();
        let dofs: Vec<usize> = (0..3 * n_present).collect();
        let [is, would_be] = &patches;
        let size = 3 * nodes.len();
        let bytes = 6 * size_of::<f64>() * size.pow(2);
        Ok(Ok(Some(RingDefect {
            change: [
                solver::restrict(&(&is.node_mass - &would_be.node_mass), &rows),
                solver::restrict(&(&is.stiffness - &would_be.stiffness), &dofs),
            ],
            note: note(mesh, nearly, regular, [3 * n_present, bytes]),
            patches,
            bytes,
            n_present,
            nodes,
        })))
    }

    /// Nodes of its elements that are there, ascending.
    pub fn nodes(&self) -> &[usize] {
        &self.nodes[..self.n_present]
    }

    /// Bytes of its dense matrices while the ring is factored.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// What and where it is, for a log.
    pub fn note(&self) -> &str {
        &self.note
    }

    /// Adds the defect's part of K x to the regular ring's, both nodal, `[n_dofs]`.
    pub fn add_stiffness_product(&self, x: &[f64], sum: &mut [f64]) {
        self.add(&product(&self.change[1], &self.values(x)), sum);
    }

    /// The same of M x.
    pub fn add_mass_product(&self, x: &[f64], sum: &mut [f64]) {
        self.add(&node_product(&self.change[0], &self.values(x)), sum);
    }

    /// The defect's part of x K x.
    pub fn stiffness_square(&self, x: &[f64]) -> f64 {
        let x = self.values(x);
        crate::vectors::dot(&x, &product(&self.change[1], &x))
    }

    /// The same of x M x.
    pub fn mass_square(&self, x: &[f64]) -> f64 {
        let x = self.values(x);
        crate::vectors::dot(&x, &node_product(&self.change[0], &x))
    }

    fn values(&self, x: &[f64]) -> Vec<f64> {
        let of_node = |&node: &usize| [x[3 * node], x[3 * node + 1], x[3 * node + 2]];
        self.nodes().iter().flat_map(of_node).collect()
    }

    fn add(&self, values: &[f64], sum: &mut [f64]) {
        for (&node, value) in self.nodes().iter().zip(values.chunks_exact(3)) {
            (0..3).for_each(|i| sum[3 * node + i] += value[i]);
        }
    }

    /// What it changes in the matrices of the coordinates of the true and of the regular ring.
    pub fn changes(&self, coordinates: &Coordinates, regular: &Coordinates) -> Changes {
        Changes::new(&self.nodes, &self.patches, coordinates, regular)
    }
}

/// Elements with one of the nodes `nodes` (ascending).
fn elements_of(mesh: &Mesh, nodes: &[usize]) -> Vec<usize> {
    let is_named = |node: &usize| nodes.binary_search(node).is_ok();
    let touches = |&e: &usize| mesh.element(e).iter().any(is_named);
    (0..mesh.n_elements()).filter(touches).collect()
}

/// What and where a defect is, how many rows it changes and how many bytes it takes.
fn note(mesh: &Mesh, nearly: &NearlyPeriodic, regular: &RegularRing, [rows, bytes]: [usize; 2]) -> String {
    let mut parts = Vec::new();
    if let Some(&(first, _)) = nearly.moved.first() {
        parts.push(format!(
            "{} nodes of {} elements in {} of them, the first node {first}, at most {:.1e} m from their places",
            nearly.moved.len(),
            nearly.elements(mesh).len(),
            nearly.n_sectors_moved(),
            nearly.largest_move
        ));
    }
    if let Some(first) = nearly.missing.iter().find(|&&node| node < mesh.n_nodes()) {
        parts.push(format!(
            "{} missing elements in {} of them, the first beside node {first}, with {} absent nodes",
            nearly.n_missing(mesh),
            nearly.n_sectors_missing(mesh),
            nearly.absent.len()
        ));
    }
    if let Some(first) = regular.held_besides.first() {
        parts.push(format!(
            "{} nodes that are held there alone, the first node {first}",
            regular.held_besides.len()
        ));
    }
    if let Some(first) = regular.loose.first() {
        parts.push(format!(
            "{} nodes that are free there alone, the first node {first}",
            regular.loose.len()
        ));
    }
    format!(
        "{} equal sectors but for {}; {rows} rows, {:.1} MB",
        nearly.periodicity.n_sectors(),
        parts.join(" and "),
        bytes as f64 / 1e6
    )
}
