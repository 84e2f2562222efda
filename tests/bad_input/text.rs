//! The text of a small good mesh, and the changes that make it a bad one.

use crate::util::rings;

/// The text of the tiny inner ring, mm, as lines that tests change.
pub struct Text(pub Vec<String>);

impl Text {
    /// The text before anything is changed.
    pub fn good() -> Text {
        Text(rings::tiny_texts()[0].lines().map(str::to_string).collect())
    }

    /// Content of the file.
    pub fn bytes(&self) -> Vec<u8> {
        (self.0.join("\n") + "\n").into_bytes()
    }

    /// Index of the line `$<section>`.
    pub fn section(&self, name: &str) -> usize {
        self.0.iter().position(|l| *l == format!("${name}")).unwrap()
    }

    /// Number of nodes in the header.
    pub fn n_nodes(&self) -> usize {
        self.0[self.section("Nodes") + 1]
            .split(' ')
            .nth(1)
            .unwrap()
            .parse()
            .unwrap()
    }

    /// The line with the tag of node `k`, from 1.
    pub fn node_tag(&mut self, k: usize) -> &mut String {
        let line = self.section("Nodes") + 2 + k;
        &mut self.0[line]
    }

    /// The line with the coordinates of node `k`, from 1.
    pub fn node(&mut self, k: usize) -> &mut String {
        let line = self.section("Nodes") + 2 + self.n_nodes() + k;
        &mut self.0[line]
    }

    /// The line of volume element `k`, from 1: its tag and its nodes.
    pub fn element(&mut self, k: usize) -> &mut String {
        let line = self.section("Elements") + 2 + k;
        &mut self.0[line]
    }

    /// Appends a node and returns its tag.
    pub fn add_node(&mut self, coordinates: &str) -> usize {
        let (start, n) = (self.section("Nodes"), self.n_nodes());
        self.0[start + 1] = format!("1 {0} 1 {0}", n + 1);
        self.0[start + 2] = format!("3 1 0 {}", n + 1);
        self.0.insert(start + 3 + n, (n + 1).to_string());
        self.0.insert(start + 4 + 2 * n, coordinates.to_string());
        n + 1
    }

    /// Puts a facet of one surface in the place of one of the next surface.
    pub fn share_a_facet(&mut self) {
        let (mut line, mut firsts) = (self.section("Elements") + 2, Vec::new());
        while !self.0[line].starts_with('$') {
            let header: Vec<usize> = self.0[line]
                .split_whitespace()
                .map(|n| n.parse().unwrap())
                .collect();
            if header[0] == 2 {
                firsts.push(line + 1);
            }
            line += 1 + header[3];
        }
        let (_, nodes) = self.0[firsts[0]].split_once(' ').unwrap();
        let (tag, _) = self.0[firsts[1]].split_once(' ').unwrap();
        self.0[firsts[1]] = format!("{tag} {nodes}");
    }

    /// Gives all volume elements another type, with the first `n_nodes` of their nodes, repeated if there are more.
    pub fn retype(&mut self, gmsh_type: usize, n_nodes: usize) {
        let head = self.section("Elements") + 2;
        let count: usize = self.0[head].split(' ').nth(3).unwrap().parse().unwrap();
        self.0[head] = format!("3 1 {gmsh_type} {count}");
        for line in &mut self.0[head + 1..=head + count] {
            let words: Vec<String> = line.split_whitespace().map(str::to_string).collect();
            let nodes = words[1..]
                .iter()
                .cycle()
                .take(n_nodes)
                .cloned()
                .collect::<Vec<_>>();
            *line = format!("{} {}", words[0], nodes.join(" "));
        }
    }
}

/// The good text, changed.
pub fn changed(change: impl FnOnce(&mut Text)) -> Vec<u8> {
    let mut text = Text::good();
    change(&mut text);
    assert_ne!(text.bytes(), Text::good().bytes(), "nothing was changed");
    text.bytes()
}

/// The good text with all occurrences of `from` replaced.
pub fn replaced(from: &str, to: &str) -> Vec<u8> {
    changed(|text| text.0.iter_mut().for_each(|line| *line = line.replace(from, to)))
}
