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

/// Where a ring is cut into sectors, before its rows are known.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorCut {
    /// Elements of each sector, ascending.
    pub elements: Vec<Vec<usize>>,
    /// Nodes of the elements of each sector, ascending.
    pub nodes: Vec<Vec<usize>>,
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

impl SectorCut {
    /// Cuts a ring into `n_sectors`. Arguments as [`crate::angular_dissection`].
    pub fn new(
        points: &[[f64; 3]],
        elements: &[usize],
        nodes_per_element: usize,
        n_sectors: usize,
    ) -> Result<SectorCut, SolverError> {
        let n_elements = elements.len() / nodes_per_element;
        if n_sectors == 0 || n_sectors > n_elements {
            return Err(SolverError::BadSectors {
                n_sectors,
                n_elements,
            });
        }
        let of_element = sectors_of_elements(points, elements, nodes_per_element, n_sectors);
        let mut own = vec![Vec::new(); n_sectors];
        of_element.iter().enumerate().for_each(|(e, &s)| own[s].push(e));
        let nodes = |own: &Vec<usize>| {
            let nodes = |&e: &usize| &elements[nodes_per_element * e..nodes_per_element * (e + 1)];
            let mut nodes: Vec<usize> = own.iter().flat_map(nodes).copied().collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        Ok(SectorCut {
            nodes: own.iter().map(nodes).collect(),
            elements: own,
        })
    }
}

impl SectorLayout {
    /// Cuts a ring into `n_sectors`: [`SectorCut::new`] and [`SectorLayout::of`].
    pub fn new(
        points: &[[f64; 3]],
        elements: &[usize],
        nodes_per_element: usize,
        free: &[usize],
        n_sectors: usize,
    ) -> Result<SectorLayout, SolverError> {
        let cut = SectorCut::new(points, elements, nodes_per_element, n_sectors)?;
        Ok(SectorLayout::of(cut, points.len(), free))
    }

    /// Rows of a ring of `n_nodes` nodes that was cut; `free` are the dofs (3 * node + component) that have a row, ascending.
    pub fn of(cut: SectorCut, n_nodes: usize, free: &[usize]) -> SectorLayout {
        let n_sectors = cut.nodes.len();
        let mut row_of = vec![usize::MAX; COMPONENTS * n_nodes];
        free.iter().enumerate().for_each(|(row, &dof)| row_of[dof] = row);
        let of_node = sectors_of_nodes(n_nodes, &cut.nodes);
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
        let own = cut.elements.into_iter().zip(cut.nodes);
        let sectors: Vec<Sector> = own
            .map(|(elements, nodes)| Sector::new(elements, nodes, &row_of, &place, &of_node))
            .collect();
        SectorLayout {
            owners: owners(free.len(), &sectors, &interface),
            n: free.len(),
            sectors,
            interface,
            sections,
        }
    }

    /// Lets go of what only the analysis of sectors needs, but for those in `kept`.
    pub fn forget_all_but(&mut self, kept: Range<usize>) {
        for (s, sector) in self.sectors.iter_mut().enumerate() {
            if !kept.contains(&s) {
                (sector.dofs, sector.is_shared) = (Vec::new(), Vec::new());
            }
        }
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
        nodes: Vec<usize>,
        row_of: &[usize],
        place: &[usize],
        of_node: &[Vec<usize>],
    ) -> Sector {
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

/// Sectors that touch each node, ascending, from the nodes of each sector.
fn sectors_of_nodes(n_nodes: usize, nodes: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut of_node = vec![Vec::new(); n_nodes];
    for (s, nodes) in nodes.iter().enumerate() {
        nodes.iter().for_each(|&node| of_node[node].push(s));
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
