//! Which elements, nodes and rows belong to which sector, and the order of the interface. Every rank knows all of it.

use std::ops::Range;

use super::cut::sectors_of_elements;
use crate::error::SolverError;

/// Rows per node.
pub(super) const COMPONENTS: usize = 3;

/// One sector.
#[derive(Clone, Debug, PartialEq)]
pub struct Sector {
    /// Its elements, ascending.
    pub elements: Vec<usize>,
    /// Nodes of its elements, ascending; a sector's own matrices number them 0.. in this order.
    pub nodes: Vec<usize>,
    /// Whether other sectors share the node, `[nodes.len()]`.
    pub(super) is_shared: Vec<bool>,
    /// Its rows: interior ones, ascending, then those of the boundary in the order of the interface.
    pub(super) rows: Vec<usize>,
    /// Dof of each of its rows among those of its nodes, 3 * node + component.
    pub(super) dofs: Vec<usize>,
    pub(super) n_interior: usize,
    /// Place in the interface of each row of the boundary, ascending.
    pub(super) boundary: Vec<usize>,
}

/// A ring cut into sectors.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorLayout {
    n: usize,
    sectors: Vec<Sector>,
    /// Rows of the interface in elimination order.
    interface: Vec<usize>,
    /// Places in the interface of each cross-section, `[n_sectors]`: that behind sector s is number s.
    pub(super) sections: Vec<Range<usize>>,
    /// Of each row, its sector, or n_sectors plus its place in the interface.
    owners: Vec<u32>,
}

/// Where a row is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Inside a sector.
    Inside(usize),
    /// At a place of the interface.
    Shared(usize),
}

/// Number of sectors for a ring of `n_dofs` dofs: enough to keep a node's cores busy, few enough that the interface stays
/// a few per cent of the factor. It depends on nothing but the ring, because results depend on it in their last bits.
pub fn default_sectors(n_dofs: usize) -> usize {
    match n_dofs {
        0..5_000 => 2,
        5_000..40_000 => 4,
        40_000..500_000 => 8,
        500_000..2_000_000 => 16,
        _ => 32,
    }
}

impl SectorLayout {
    /// Cuts a ring into `n_sectors`. Arguments as [`crate::angular_dissection`]; `free` are the dofs (3 * node +
    /// component) that have a row, ascending.
    pub fn new(
        points: &[[f64; 3]],
        elements: &[usize],
        nodes_per_element: usize,
        free: &[usize],
        n_sectors: usize,
    ) -> Result<SectorLayout, SolverError> {
        let n_elements = elements.len() / nodes_per_element;
        if n_sectors == 0 || n_sectors > n_elements {
            return Err(SolverError::BadSectors {
                n_sectors,
                n_elements,
            });
        }
        let of_element = sectors_of_elements(points, elements, nodes_per_element, n_sectors);
        let mut row_of = vec![usize::MAX; COMPONENTS * points.len()];
        free.iter().enumerate().for_each(|(row, &dof)| row_of[dof] = row);
        let of_node = sectors_of_nodes(points.len(), elements, nodes_per_element, &of_element);
        let rows = |node: &usize| {
            let dofs = COMPONENTS * node..COMPONENTS * (node + 1);
            let rows = dofs.map(|dof| row_of[dof]);
            rows.filter(|&row| row != usize::MAX).collect::<Vec<usize>>()
        };
        let mut interface: Vec<usize> = Vec::new();
        let mut sections = vec![0..0; n_sectors + 1];
        for (section, nodes) in interface_order(&of_node, n_sectors) {
            let first = interface.len();
            interface.extend(nodes.iter().flat_map(rows));
            sections[section] = first..interface.len();
        }
        // Nodes of more than two sectors are in no cross-section.
        sections.pop();
        let mut place = vec![usize::MAX; free.len()];
        interface.iter().enumerate().for_each(|(k, &row)| place[row] = k);
        let build = |s: usize| {
            let mine = (0..n_elements).filter(|&e| of_element[e] == s).collect();
            Sector::new(mine, elements, nodes_per_element, &row_of, &place, &of_node)
        };
        let sectors: Vec<Sector> = (0..n_sectors).map(build).collect();
        Ok(SectorLayout {
            owners: owners(free.len(), &sectors, &interface),
            n: free.len(),
            sectors,
            interface,
            sections,
        })
    }

    /// Where a row is.
    pub(super) fn place(&self, row: usize) -> Place {
        let (owner, n_sectors) = (self.owners[row] as usize, self.sectors.len());
        match owner.checked_sub(n_sectors) {
            Some(place) => Place::Shared(place),
            None => Place::Inside(owner),
        }
    }

    /// Number of rows.
    pub fn n(&self) -> usize {
        self.n
    }

    /// The sectors, round the ring.
    pub fn sectors(&self) -> &[Sector] {
        &self.sectors
    }

    /// Rows that sectors share, in elimination order.
    pub fn interface(&self) -> &[usize] {
        &self.interface
    }
}

impl Sector {
    fn new(
        elements: Vec<usize>,
        connectivity: &[usize],
        nodes_per_element: usize,
        row_of: &[usize],
        place: &[usize],
        of_node: &[Vec<usize>],
    ) -> Sector {
        let mut nodes: Vec<usize> = elements
            .iter()
            .flat_map(|&e| &connectivity[nodes_per_element * e..nodes_per_element * (e + 1)])
            .copied()
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        let (mut interior, mut shared) = (Vec::new(), Vec::new());
        for (local, &node) in nodes.iter().enumerate() {
            for c in 0..COMPONENTS {
                let row = row_of[COMPONENTS * node + c];
                let dof = COMPONENTS * local + c;
                if row == usize::MAX {
                    continue;
                }
                match place[row] {
                    usize::MAX => interior.push((row, dof)),
                    k => shared.push((k, row, dof)),
                }
            }
        }
        shared.sort_unstable();
        let all = || interior.iter().copied().chain(shared.iter().map(|s| (s.1, s.2)));
        Sector {
            is_shared: nodes.iter().map(|&node| of_node[node].len() > 1).collect(),
            rows: all().map(|r| r.0).collect(),
            dofs: all().map(|r| r.1).collect(),
            n_interior: interior.len(),
            boundary: shared.iter().map(|s| s.0).collect(),
            elements,
            nodes,
        }
    }

    /// Number of rows, boundary included.
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    /// Number among its own of a row inside it.
    pub(super) fn inside(&self, row: usize) -> usize {
        let found = self.rows[..self.n_interior].binary_search(&row);
        found.expect("the row is inside this sector")
    }

    /// Number of rows that no other sector shares.
    pub fn n_interior(&self) -> usize {
        self.n_interior
    }
}

/// Sectors that touch each node, ascending.
fn sectors_of_nodes(
    n_nodes: usize,
    elements: &[usize],
    nodes_per_element: usize,
    of_element: &[usize],
) -> Vec<Vec<usize>> {
    let mut of_node = vec![Vec::new(); n_nodes];
    for (nodes, &s) in elements.chunks_exact(nodes_per_element).zip(of_element) {
        for &node in nodes {
            let list: &mut Vec<usize> = &mut of_node[node];
            if let Err(at) = list.binary_search(&s) {
                list.insert(at, s);
            }
        }
    }
    of_node
}

/// Cross-sections and their nodes in the order of cyclic reduction; number n_sectors are the nodes of more than two sectors.
fn interface_order(of_node: &[Vec<usize>], n_sectors: usize) -> Vec<(usize, Vec<usize>)> {
    // Cross-section s lies behind sector s.
    let mut sections = vec![Vec::new(); n_sectors + 1];
    for (node, touched) in of_node.iter().enumerate() {
        match touched[..] {
            [a, b] if b == a + 1 => sections[a].push(node),
            [0, b] if b == n_sectors - 1 => sections[b].push(node),
            [_, _, ..] => sections[n_sectors].push(node),
            _ => {}
        }
    }
    let mut order: Vec<usize> = reduction(n_sectors).concat();
    order.push(n_sectors);
    order
        .into_iter()
        .map(|s| (s, std::mem::take(&mut sections[s])))
        .collect()
}

/// Cyclic reduction of `n` things round a circle: every second one, then every second one of those that stay, until one is
/// left. Things of one level are not neighbours.
pub(super) fn reduction(n: usize) -> Vec<Vec<usize>> {
    let mut levels = Vec::new();
    let mut stay: Vec<usize> = (0..n).collect();
    while stay.len() > 2 {
        levels.push(stay.iter().copied().skip(1).step_by(2).collect());
        stay = stay.into_iter().step_by(2).collect();
    }
    // Of two, each is both neighbours of the other.
    levels.extend(stay.into_iter().map(|last| vec![last]));
    levels
}

/// Of each row, its sector, or the number of sectors plus its place in the interface.
fn owners(n: usize, sectors: &[Sector], interface: &[usize]) -> Vec<u32> {
    let small = |owner: usize| u32::try_from(owner).expect("matrices of 2^32 rows fit into no memory");
    let mut owners = vec![0; n];
    for (s, sector) in sectors.iter().enumerate() {
        let inside = &sector.rows[..sector.n_interior];
        inside.iter().for_each(|&row| owners[row] = small(s));
    }
    for (place, &row) in interface.iter().enumerate() {
        owners[row] = small(sectors.len() + place);
    }
    owners
}
