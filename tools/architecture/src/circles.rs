//! Circles of imports: sets of files each of which reaches all others (Tarjan's strongly connected components).

use crate::imports::Import;

/// The circles among `n` files, each sorted, the largest first.
pub fn circles(n: usize, imports: &[Import]) -> Vec<Vec<usize>> {
    let mut next = vec![Vec::new(); n];
    for import in imports {
        next[import.from].push(import.to);
    }
    let mut search = Search {
        next,
        order: vec![None; n],
        low: vec![0; n],
        stack: Vec::new(),
        waiting: vec![false; n],
        count: 0,
        found: Vec::new(),
    };
    for file in 0..n {
        if search.order[file].is_none() {
            search.visit(file);
        }
    }
    let mut found = search.found;
    found.sort_by_key(|circle| (usize::MAX - circle.len(), circle[0]));
    found
}

struct Search {
    next: Vec<Vec<usize>>,
    order: Vec<Option<usize>>,
    low: Vec<usize>,
    stack: Vec<usize>,
    waiting: Vec<bool>,
    count: usize,
    found: Vec<Vec<usize>>,
}

impl Search {
    fn visit(&mut self, file: usize) {
        let order = self.count;
        self.order[file] = Some(order);
        self.low[file] = order;
        self.count += 1;
        self.stack.push(file);
        self.waiting[file] = true;
        for to in self.next[file].clone() {
            match self.order[to] {
                None => {
                    self.visit(to);
                    self.low[file] = self.low[file].min(self.low[to]);
                }
                Some(order) if self.waiting[to] => self.low[file] = self.low[file].min(order),
                Some(_) => {}
            }
        }
        if self.low[file] == order {
            let start = self
                .stack
                .iter()
                .rposition(|&other| other == file)
                .expect("it was pushed above");
            let mut circle = self.stack.split_off(start);
            for &other in &circle {
                self.waiting[other] = false;
            }
            if circle.len() > 1 {
                circle.sort();
                self.found.push(circle);
            }
        }
    }
}
