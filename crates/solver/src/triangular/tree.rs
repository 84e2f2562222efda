//! The elimination tree of a factor's panels, cut into subtrees and the top above them.

use std::collections::BinaryHeap;
use std::ops::Range;

use crate::panels::Panels;

/// A subtree has at most one part in so many of the entries of L.
pub const MOST_SHARE: usize = 8;

/// No panel.
pub(super) const NONE: u32 = u32::MAX;

/// Some panels with places of their own: 0.. in the order of elimination, and behind them the boundary.
#[derive(Debug)]
pub(super) struct Piece {
    pub panels: Range<usize>,
    /// Places of its columns among all.
    pub places: Range<usize>,
    /// Places in the top of the rows above, ascending; none of the top itself.
    pub boundary: Vec<usize>,
}

/// The panels of a factor by subtrees, then the top.
#[derive(Debug)]
pub(super) struct Tree {
    /// Their places are those within their pieces.
    pub panels: Panels,
    pieces: Vec<Piece>,
    /// Panel of each place, `[n]`.
    pub panel_of: Vec<u32>,
    /// The panel above each within its piece, or [`NONE`].
    pub parents: Vec<u32>,
}

impl Tree {
    /// Cuts the tree of some panels with `n` places. Returns the new place of each place as well.
    pub fn new(panels: Panels, n: usize) -> (Tree, Vec<usize>) {
        let n_panels = panels.all().len();
        let mut panel_of = vec![NONE; n];
        for p in panels.all() {
            panel_of[panels.places(p)].fill(p as u32);
        }
        let above = |p: usize| panels.below(p).first().map(|&row| panel_of[row] as usize);
        let above: Vec<Option<usize>> = panels.all().map(above).collect();
        let (roots, top) = cut(&weights(&panels), &above);
        // Panels come before those above them, so a loop from the end meets those first.
        let mut piece_of = vec![top; n_panels];
        for (piece, &root) in roots.iter().enumerate() {
            piece_of[root] = piece;
        }
        for p in (0..n_panels).rev() {
            if let Some(above) = above[p].filter(|&above| piece_of[above] != top) {
                piece_of[p] = piece_of[above];
            }
        }
        let mut order: Vec<usize> = panels.all().collect();
        order.sort_by_key(|&p| piece_of[p]);
        let (pieces, new_places) = pieces(&panels, &order, &piece_of, &roots);
        let mut position = vec![0; n_panels];
        order.iter().enumerate().for_each(|(k, &p)| position[p] = k);
        let parents = order.iter().map(|&p| match above[p] {
            Some(above) if piece_of[above] == piece_of[p] => position[above] as u32,
            _ => NONE,
        });
        let parents = parents.collect();
        let panels = panels.rearranged(&order, |p, old| {
            let piece: &Piece = &pieces[piece_of[p]];
            let new = new_places[old];
            let top = pieces[pieces.len() - 1].places.start;
            match piece.places.contains(&new) {
                true => new - piece.places.start,
                false => {
                    let found = piece.boundary.binary_search(&(new - top));
                    piece.places.len() + found.expect("a subtree's root has the rows above of all its panels")
                }
            }
        });
        for (k, _) in order.iter().enumerate() {
            let piece = &pieces[piece_of[order[k]]];
            let places = panels.places(k);
            panel_of[piece.places.start + places.start..piece.places.start + places.end].fill(k as u32);
        }
        let tree = Tree {
            panels,
            pieces,
            panel_of,
            parents,
        };
        (tree, new_places)
    }

    /// The subtrees, and the top.
    pub fn split(&self) -> (&[Piece], &Piece) {
        let (top, subtrees) = self.pieces.split_last().expect("there is a top");
        (subtrees, top)
    }

    pub fn bytes(&self) -> usize {
        let boundary: usize = self.pieces.iter().map(|piece| piece.boundary.len()).sum();
        let lists =
            size_of::<u32>() * (self.panel_of.len() + self.parents.len()) + size_of::<usize>() * boundary;
        self.panels.bytes() + lists
    }
}

/// Entries of L in each panel.
fn weights(panels: &Panels) -> Vec<usize> {
    let entries = |p: usize| {
        let width = panels.places(p).len();
        width * (width + 1) / 2 + width * panels.below(p).len()
    };
    panels.all().map(entries).collect()
}

/// Roots of the subtrees, ascending, and their number.
fn cut(weights: &[usize], above: &[Option<usize>]) -> (Vec<usize>, usize) {
    let mut whole = weights.to_vec();
    let mut children = vec![Vec::new(); weights.len()];
    let mut heap = BinaryHeap::new();
    for (p, above) in above.iter().enumerate() {
        match *above {
            Some(above) => {
                whole[above] += whole[p];
                children[above].push(p);
            }
            None => heap.push((whole[p], p)),
        }
    }
    let most = weights.iter().sum::<usize>() / MOST_SHARE;
    while let Some(&(weight, p)) = heap.peek() {
        if weight <= most {
            break;
        }
        heap.pop();
        heap.extend(children[p].iter().map(|&child| (whole[child], child)));
    }
    let mut roots: Vec<usize> = heap.into_iter().map(|(_, p)| p).collect();
    roots.sort_unstable();
    let n = roots.len();
    (roots, n)
}

/// The pieces of panels in `order`, subtrees under their `roots` and the top, and the new place of each place.
fn pieces(panels: &Panels, order: &[usize], piece_of: &[usize], roots: &[usize]) -> (Vec<Piece>, Vec<usize>) {
    let n = order.iter().map(|&p| panels.places(p).len()).sum();
    let (mut new_places, mut n_placed) = (vec![0; n], 0);
    let (mut pieces, mut k) = (Vec::new(), 0);
    for piece in 0..=roots.len() {
        let (first, first_place) = (k, n_placed);
        while k < order.len() && piece_of[order[k]] == piece {
            for old in panels.places(order[k]) {
                new_places[old] = n_placed;
                n_placed += 1;
            }
            k += 1;
        }
        pieces.push(Piece {
            panels: first..k,
            places: first_place..n_placed,
            boundary: Vec::new(),
        });
    }
    let top = pieces[roots.len()].places.start;
    for (piece, &root) in pieces.iter_mut().zip(roots) {
        piece.boundary = panels
            .below(root)
            .iter()
            .map(|&old| new_places[old] - top)
            .collect();
    }
    (pieces, new_places)
}
