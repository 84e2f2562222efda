//! Which elements, nodes and rows belong to which sector, and the order of the interface.
//!
//! Every rank knows the nodes of all sectors, 4 bytes each, the owner of each row, 4 bytes, and the interface; rows
//! and elements of its own sectors only.

use std::ops::Range;
use std::sync::Arc;

use super::cut::sectors_of_elements;
use crate::error::SolverError;

/// Rows per node.
pub(super) const COMPONENTS: usize = 3;

/// One sector.
#[derive(Clone, Debug, PartialEq)]
pub struct Sector {
    /// Its elements, ascending; as nodes, their marks, rows and dofs only of sectors that this rank owns.
    pub elements: Vec<usize>,
    /// Nodes of its elements, ascending; a sector's own matrices number them 0.. in this order.
    pub nodes: Vec<usize>,
    /// Whether other sectors share the node, `[nodes.len()]`.
    pub(super) is_shared: Vec<bool>,
    /// Its rows: interior ones, ascending, then those of the boundary in the order of the interface.
    pub(super) rows: Vec<u32>,
    /// Dof of each of its rows among those of its nodes, 3 * node + component.
    pub(super) dofs: Vec<u32>,
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
    pub nodes: Arc<Vec<Vec<u32>>>,
}

/// A ring cut into sectors.
#[derive(Clone, Debug, PartialEq)]
pub struct SectorLayout {
    n: usize,
    /// Nodes of all sectors.
    nodes: Arc<Vec<Vec<u32>>>,
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
pub(super) enum RowPlace {
    /// Inside: in which sector, or at which place of the inner rows of all sectors, one after the other.
    Inside(usize),
    /// At a place of the interface.
    Shared(usize),
}

/// Number of sectors for a ring of `n_dofs` dofs: enough to keep a node's cores busy, few enough that the interface
/// stays a few per cent of the factor. It depends on nothing but the ring, because results depend on it in their last
/// bits.
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
            let mut nodes: Vec<u32> = own.iter().flat_map(nodes).map(|&node| small(node)).collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        Ok(SectorCut {
            nodes: Arc::new(own.iter().map(nodes).collect()),
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
        Ok(SectorLayout::of(cut, points.len(), free, 0..n_sectors))
    }

    /// Rows of a ring of `n_nodes` nodes that was cut; `free` are the dofs (3 * node + component) that have a row,
    /// ascending, `kept` the sectors whose rows are listed.
    ///
    /// # Panics
    /// When a node is in no sector.
    pub fn of(cut: SectorCut, n_nodes: usize, free: &[usize], kept: Range<usize>) -> SectorLayout {
        let n_sectors = cut.nodes.len();
        let mut row_of = vec![NONE; COMPONENTS * n_nodes];
        let rows = free.iter().enumerate();
        rows.for_each(|(row, &dof)| row_of[dof] = small(row));
        let touched = sectors_of_nodes(n_nodes, &cut.nodes);
        let rows = |&node: &u32| {
            let dofs = COMPONENTS * node as usize..COMPONENTS * (node as usize + 1);
            let rows = dofs.map(|dof| row_of[dof]).filter(|&row| row != NONE);
            rows.map(|row| row as usize).collect::<Vec<usize>>()
        };
        let mut interface: Vec<usize> = Vec::new();
        let mut sections = vec![0..0; n_sectors + 1];
        for (section, nodes) in interface_order(&touched, n_sectors) {
            let first = interface.len();
            interface.extend(nodes.iter().flat_map(rows));
            sections[section] = first..interface.len();
        }
        // Nodes of more than two sectors are in no cross-section.
        sections.pop();
        let mut owners: Vec<u32> = free.iter().map(|&dof| touched[dof / COMPONENTS][0]).collect();
        assert!(
            owners.iter().all(|&owner| owner != NONE),
            "every node has a sector"
        );
        let places = interface.iter().enumerate();
        places.for_each(|(place, &row)| owners[row] = small(n_sectors + place));
        let whole = Whole {
            n_sectors,
            row_of: &row_of,
            owners: &owners,
            touched: &touched,
        };
        let own = cut.elements.into_iter().zip(cut.nodes.iter()).enumerate();
        let sectors = own.map(|(s, (elements, nodes))| match kept.contains(&s) {
            true => Sector::new(elements, nodes, whole),
            false => Sector::elsewhere(nodes, whole),
        });
        SectorLayout {
            n: free.len(),
            sectors: sectors.collect(),
            nodes: cut.nodes,
            interface,
            sections,
            owners,
        }
    }

    /// Nodes of all sectors, ascending.
    pub fn nodes(&self) -> &[Vec<u32>] {
        &self.nodes
    }

    /// Goes through all rows, ascending, with their places in the interface or among the inner rows of all sectors,
    /// one after the other.
    pub(super) fn each_row(&self, mut put: impl FnMut(usize, RowPlace)) {
        let mut next: Vec<usize> = Vec::with_capacity(self.sectors.len());
        let mut first = 0;
        for sector in &self.sectors {
            next.push(first);
            first += sector.n_interior;
        }
        for row in 0..self.n {
            match self.place(row) {
                RowPlace::Inside(s) => {
                    put(row, RowPlace::Inside(next[s]));
                    next[s] += 1;
                }
                shared => put(row, shared),
            }
        }
    }

    /// Where a row is.
    pub(super) fn place(&self, row: usize) -> RowPlace {
        let (owner, n_sectors) = (self.owners[row] as usize, self.sectors.len());
        match owner.checked_sub(n_sectors) {
            Some(place) => RowPlace::Shared(place),
            None => RowPlace::Inside(owner),
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

/// What a sector is cut out of.
#[derive(Clone, Copy)]
struct Whole<'w> {
    n_sectors: usize,
    /// Row of each dof, or [`NONE`].
    row_of: &'w [u32],
    /// As in the layout.
    owners: &'w [u32],
    /// First and last sector of each node.
    touched: &'w [[u32; 2]],
}

impl Sector {
    fn new(elements: Vec<usize>, nodes: &[u32], whole: Whole<'_>) -> Sector {
        let (mut interior, mut shared) = (Vec::new(), Vec::new());
        for (local, &node) in nodes.iter().enumerate() {
            for c in 0..COMPONENTS {
                let row = whole.row_of[COMPONENTS * node as usize + c];
                if row == NONE {
                    continue;
                }
                let dof = small(COMPONENTS * local + c);
                match whole.place(row) {
                    None => interior.push((row, dof)),
                    Some(k) => shared.push((k, row, dof)),
                }
            }
        }
        shared.sort_unstable();
        let all = || interior.iter().copied().chain(shared.iter().map(|s| (s.1, s.2)));
        Sector {
            is_shared: nodes
                .iter()
                .map(|&node| whole.touched[node as usize][1] != NONE)
                .collect(),
            rows: all().map(|r| r.0).collect(),
            dofs: all().map(|r| r.1).collect(),
            n_interior: interior.len(),
            boundary: shared.iter().map(|s| s.0).collect(),
            elements,
            nodes: nodes.iter().map(|&node| node as usize).collect(),
        }
    }

    /// What is known of a sector that another rank owns.
    fn elsewhere(nodes: &[u32], whole: Whole<'_>) -> Sector {
        let dofs = nodes.iter().flat_map(|&node| {
            let first = COMPONENTS * node as usize;
            &whole.row_of[first..first + COMPONENTS]
        });
        let rows = dofs.filter(|&&row| row != NONE);
        let (mut n_interior, mut boundary) = (0, Vec::new());
        for &row in rows {
            match whole.place(row) {
                None => n_interior += 1,
                Some(k) => boundary.push(k),
            }
        }
        boundary.sort_unstable();
        Sector {
            is_shared: Vec::new(),
            rows: Vec::new(),
            dofs: Vec::new(),
            n_interior,
            boundary,
            elements: Vec::new(),
            nodes: Vec::new(),
        }
    }

    /// Dofs of its matrix that have rows, in their order.
    pub(super) fn kept_dofs(&self) -> Vec<usize> {
        self.dofs.iter().map(|&dof| dof as usize).collect()
    }

    /// Number of rows, boundary included.
    pub fn n_rows(&self) -> usize {
        self.n_interior + self.boundary.len()
    }

    /// Number among its own of a row inside it.
    pub(super) fn inside(&self, row: usize) -> usize {
        let found = self.rows[..self.n_interior].binary_search(&small(row));
        found.expect("the row is inside this sector")
    }

    /// Number of rows that no other sector shares.
    pub fn n_interior(&self) -> usize {
        self.n_interior
    }
}

impl Whole<'_> {
    /// Place of a row in the interface, if it is there.
    fn place(&self, row: u32) -> Option<usize> {
        (self.owners[row as usize] as usize).checked_sub(self.n_sectors)
    }
}

/// No sector, or no row.
const NONE: u32 = u32::MAX;
/// More than one sector besides the first.
const SEVERAL: u32 = u32::MAX - 1;

fn small(number: usize) -> u32 {
    let small = u32::try_from(number).ok();
    small
        .filter(|&n| n < SEVERAL)
        .expect("matrices of 2^32 rows fit into no memory")
}

/// First sector that touches each node, and the other one, [`NONE`] or [`SEVERAL`], from the nodes of each sector.
fn sectors_of_nodes(n_nodes: usize, nodes: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let mut of_node = vec![[NONE; 2]; n_nodes];
    for (s, nodes) in nodes.iter().enumerate() {
        for &node in nodes {
            let [first, other] = &mut of_node[node as usize];
            match (*first, *other) {
                (NONE, _) => *first = small(s),
                (_, NONE) => *other = small(s),
                _ => *other = SEVERAL,
            }
        }
    }
    of_node
}

/// Cross-sections and their nodes in the order of cyclic reduction; number n_sectors are the nodes of more than two
/// sectors.
fn interface_order(of_node: &[[u32; 2]], n_sectors: usize) -> Vec<(usize, Vec<u32>)> {
    // Cross-section s lies behind sector s.
    let mut sections = vec![Vec::new(); n_sectors + 1];
    for (node, &[a, b]) in of_node.iter().enumerate() {
        let section = match b {
            NONE => continue,
            b if b == a + 1 => a as usize,
            b if a == 0 && b as usize == n_sectors - 1 => b as usize,
            _ => n_sectors,
        };
        sections[section].push(small(node));
    }
    let mut order: Vec<usize> = reduction(n_sectors).concat();
    order.push(n_sectors);
    order
        .into_iter()
        .map(|s| (s, std::mem::take(&mut sections[s])))
        .collect()
}

/// Cyclic reduction of `n` things round a circle: every second one, then every second one of those that stay, until
/// one is left. Things of one level are not neighbours.
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
