//! The assembly of a system: lengths, residual and tangent from its lists.

mod finite;

use std::ops::Range;

use timer::SharedLaps;

use super::elastic::{ElasticPorts, Follow};
use super::finite::{CarriedCircle, FiniteRows};
use super::interaction::{Character, Interaction, Lengths, Link, LinkForces, LinkRows};
use super::lumped::{BodyId, Interval, Lumped};
use super::moves::Moves;

/// Bodies and interactions over an interval.
pub struct System<'a> {
    interval: Interval,
    lumped: Vec<&'a dyn Lumped>,
    elastic: Vec<&'a ElasticPorts>,
    interactions: Vec<&'a dyn Interaction>,
    /// First unknown and first coordinate of every body, lumped ones first, and their numbers.
    first: Vec<[usize; 2]>,
    /// All coordinates at the start of the interval.
    start: Vec<f64>,
    /// Lengths of all links there, by family.
    starts: Vec<Vec<f64>>,
}

/// A system at given unknowns.
pub struct Evaluated {
    /// Forces of the links, by family.
    pub links: Vec<LinkForces>,
    /// Out-of-balance forces, N and N m, by unknown.
    pub residual: Vec<f64>,
}

impl<'a> System<'a> {
    /// The system of these bodies and interactions.
    pub fn new(
        interval: Interval,
        lumped: Vec<&'a dyn Lumped>,
        elastic: Vec<&'a ElasticPorts>,
        interactions: Vec<&'a dyn Interaction>,
    ) -> System<'a> {
        let sizes = lumped
            .iter()
            .map(|body| [body.n_unknowns(), body.n_coordinates()]);
        let sizes = sizes.chain(elastic.iter().map(|body| [body.n_moving; 2]));
        let mut first = vec![[0, 0]];
        for [unknowns, coordinates] in sizes {
            let [u, c] = first[first.len() - 1];
            first.push([u + unknowns, c + coordinates]);
        }
        let mut system = System {
            interval,
            lumped,
            elastic,
            interactions,
            first,
            start: Vec::new(),
            starts: Vec::new(),
        };
        system.start = system.at_start();
        let at_start = |family: usize| system.lengths(family, &system.start);
        system.starts = (0..system.interactions.len()).map(at_start).collect();
        system
    }

    /// The interval.
    pub fn interval(&self) -> Interval {
        self.interval
    }

    /// Number of unknowns.
    pub fn n(&self) -> usize {
        self.first[self.first.len() - 1][0]
    }

    /// Unknowns of a body.
    pub fn unknowns(&self, body: BodyId) -> Range<usize> {
        let i = self.number(body);
        self.first[i][0]..self.first[i + 1][0]
    }

    /// Whether all forces between the bodies have an energy.
    pub fn has_energy(&self) -> bool {
        let mut characters = self.interactions.iter().map(|family| family.character());
        self.interval == Interval::Rest && characters.all(|character| character == Character::Potential)
    }

    /// Unknowns when nothing accelerates: where Newton starts.
    pub fn guess(&self) -> Vec<f64> {
        let mut x: Vec<f64> = self
            .lumped
            .iter()
            .flat_map(|body| body.guess(self.interval))
            .collect();
        for body in &self.elastic {
            let is_known = !body.guess.is_empty();
            let guess = if is_known { &body.guess } else { &body.start };
            x.extend_from_slice(&guess[..body.n_moving]);
        }
        x
    }

    /// What an unknown is, for messages.
    pub fn name(&self, unknown: usize) -> String {
        for (i, body) in self.lumped.iter().enumerate() {
            if self.unknowns(BodyId::Lumped(i)).contains(&unknown) {
                return body.name(unknown - self.first[i][0]);
            }
        }
        let mut elastic = (0..self.elastic.len()).map(|i| (i, self.unknowns(BodyId::Elastic(i))));
        let found = elastic.find(|(_, unknowns)| unknowns.contains(&unknown));
        found.map_or_else(String::new, |(i, unknowns)| {
            format!("{}, port {}", self.elastic[i].name, unknown - unknowns.start)
        })
    }

    /// What gives an unknown of a lumped body a place that nothing resists, for messages.
    pub fn remedy(&self, unknown: usize) -> &'static str {
        let mut lumped = self.lumped.iter().enumerate();
        let owner = lumped.find(|(i, _)| self.unknowns(BodyId::Lumped(*i)).contains(&unknown));
        owner.map_or("check the compliance of the rings", |(_, body)| body.remedy())
    }

    /// Coordinates of a lumped body at the end for the unknowns `x`.
    pub fn coordinates<const N: usize>(&self, body: usize, x: &[f64]) -> [f64; N] {
        let mut end = [0.0; N];
        self.lumped[body].place(&x[self.unknowns(BodyId::Lumped(body))], &mut end);
        end
    }

    /// Motion at all ports of an elastic body for the unknowns `x`.
    pub fn ports(&self, body: usize, x: &[f64]) -> Vec<f64> {
        let ports = self.elastic[body];
        let mut g = x[self.unknowns(BodyId::Elastic(body))].to_vec();
        match &ports.follow {
            Some(follow) => {
                let q = self.coordinates(follow.body, x);
                g.extend(follow.ports(q, ports.n_following()));
            }
            None => g.resize(ports.offset.len(), 0.0),
        }
        g
    }

    /// Forces that an elastic body asks for at its ports for the unknowns `x`, N and N m.
    pub fn port_forces(&self, body: usize, x: &[f64]) -> Vec<f64> {
        self.elastic[body].forces(&self.ports(body, x))
    }

    /// Lengths of a family's links at the start of the interval, and at its end for the unknowns `x`.
    pub fn lengths_at(&self, family: usize, x: &[f64]) -> [Vec<f64>; 2] {
        [self.starts[family].clone(), self.lengths(family, &self.end(x))]
    }

    /// Forces of all links and the residual for the unknowns `x`.
    pub fn evaluate(&self, x: &[f64], costs: &SharedLaps) -> Evaluated {
        let end = self.end(x);
        let families = self.interactions.iter().zip(&self.starts).enumerate();
        let links = families
            .map(|(i, (family, start))| {
                let end = self.lengths(i, &end);
                family.evaluate(Lengths { start, end: &end }, costs)
            })
            .collect::<Vec<_>>();
        let moves = self.moves(x);
        let mut residual = vec![0.0; self.n()];
        for (i, body) in self.lumped.iter().enumerate() {
            let own = self.unknowns(BodyId::Lumped(i));
            body.balance(self.interval, &x[own.clone()], &mut residual[own]);
        }
        for i in 0..self.elastic.len() {
            self.add_ports(i, x, &moves, &mut residual);
        }
        let mut moved = Vec::new();
        for (family, found) in self.interactions.iter().zip(&links) {
            for (link, force) in family
                .links()
                .iter()
                .zip(found.forces.chunks_exact(family.n_rows()))
            {
                let finite = link.finite.map(|finite| (finite, self.mean_rows(&finite, &end)));
                self.moved_by(link, finite, &moves, &mut moved);
                for (a, row) in &moved {
                    residual[*a] += product(row, force);
                }
            }
        }
        Evaluated { links, residual }
    }

    /// Forces of a family's links on the coordinates of a lumped body, imposed ones among them, N and N m, when
    /// `forces` act on their lengths.
    pub fn forces_on<const N: usize>(
        &self,
        body: usize,
        family: usize,
        x: &[f64],
        forces: &[f64],
    ) -> [f64; N] {
        let (end, mut sum) = (self.end(x), [0.0; N]);
        let family = self.interactions[family];
        for (link, force) in family.links().iter().zip(forces.chunks_exact(family.n_rows())) {
            let own = link.terms.iter().filter(|term| term.body == BodyId::Lumped(body));
            own.for_each(|term| sum[term.coordinate] += product(&term.rows, force));
            let Some(finite) = link.finite else { continue };
            let rows = self.mean_rows(&finite, &end);
            for ((of, coordinate), row) in finite.coordinates().into_iter().zip(rows) {
                if of == BodyId::Lumped(body) {
                    sum[coordinate] += product(&finite.in_link(row), force);
                }
            }
        }
        sum
    }

    /// What bodies put into the tangent, row-major: the same for all unknowns.
    pub fn body_tangent(&self, x: &[f64]) -> Vec<f64> {
        let n = self.n();
        let mut tangent = vec![0.0; n * n];
        for (i, body) in self.lumped.iter().enumerate() {
            let own = self.unknowns(BodyId::Lumped(i));
            let block = body.tangent(self.interval);
            for (a, row) in own.clone().zip(block.chunks_exact(own.len().max(1))) {
                for (b, value) in own.clone().zip(row) {
                    tangent[n * a + b] += value;
                }
            }
        }
        let moves = self.moves(x);
        for i in 0..self.elastic.len() {
            self.add_port_tangent(i, &moves, &mut tangent);
        }
        tangent
    }

    /// Adds what the links put into it.
    pub fn add_link_tangents(&self, x: &[f64], links: &[LinkForces], tangent: &mut [f64]) {
        let (n, moves, end) = (self.n(), self.moves(x), self.end(x));
        let (mut moved, mut at_end) = (Vec::new(), Vec::new());
        let mut entries = [Entries::new(), Entries::new()];
        for (family, found) in self.interactions.iter().zip(links) {
            let m = family.n_rows();
            for (link, t) in family.links().iter().zip(found.tangents.chunks_exact(m * m)) {
                let finite = link.finite.map(|finite| (finite, self.mean_rows(&finite, &end)));
                self.moved_by(link, finite, &moves, &mut moved);
                let at = |finite: &CarriedCircle| finite.circle.rows(self.finite_coordinates(finite, &end));
                let finite = link.finite.map(|finite| (finite, at(&finite)));
                self.moved_by(link, finite, &moves, &mut at_end);
                if m > FEW_ROWS {
                    list_entries(&moved, m, &mut entries[0]);
                    list_entries(&at_end, m, &mut entries[1]);
                    add_sparse(t, m, &entries, (n, tangent));
                    continue;
                }
                for (a, row_a) in &moved {
                    for (b, row_b) in &at_end {
                        let terms = row_a.iter().zip(t.chunks_exact(m));
                        tangent[n * a + b] += terms.map(|(r, t)| r * product(t, row_b)).sum::<f64>();
                    }
                }
            }
        }
    }

    /// Force that the round-off of positions makes in all links together, N.
    pub fn round_off(&self, x: &[f64]) -> f64 {
        let end = self.end(x);
        let of = |(i, family): (usize, &&dyn Interaction)| {
            let (start, end) = (&self.starts[i], self.lengths(i, &end));
            family.round_off(Lengths { start, end: &end })
        };
        self.interactions.iter().enumerate().map(of).sum()
    }

    fn number(&self, body: BodyId) -> usize {
        match body {
            BodyId::Lumped(i) => i,
            BodyId::Elastic(i) => self.lumped.len() + i,
        }
    }

    /// All coordinates at the start.
    fn at_start(&self) -> Vec<f64> {
        let lumped = self.lumped.iter().flat_map(|body| body.start());
        let elastic = self.elastic.iter().flat_map(|body| &body.start[..body.n_moving]);
        lumped.chain(elastic).copied().collect()
    }

    /// All coordinates at the end.
    fn end(&self, x: &[f64]) -> Vec<f64> {
        let [_, first] = self.first[self.lumped.len()];
        let mut end = vec![0.0; first];
        for (i, body) in self.lumped.iter().enumerate() {
            let own = self.first[i][1]..self.first[i + 1][1];
            body.place(&x[self.unknowns(BodyId::Lumped(i))], &mut end[own]);
        }
        for i in 0..self.elastic.len() {
            end.extend_from_slice(&x[self.unknowns(BodyId::Elastic(i))]);
        }
        end
    }

    /// Lengths of a family's links at given coordinates.
    fn lengths(&self, family: usize, coordinates: &[f64]) -> Vec<f64> {
        let (links, n) = (
            self.interactions[family].links(),
            self.interactions[family].n_rows(),
        );
        let mut lengths = vec![0.0; n * links.len()];
        for (link, lengths) in links.iter().zip(lengths.chunks_exact_mut(n)) {
            lengths.copy_from_slice(&link.reach[..n]);
            for term in &link.terms {
                let q = coordinates[self.coordinate(term.body, term.coordinate)];
                for (l, row) in lengths.iter_mut().zip(term.rows) {
                    *l += row * q;
                }
            }
            if let Some(finite) = &link.finite {
                let at = self.finite_coordinates(finite, coordinates);
                let more = finite.in_link(finite.circle.lengths(at));
                lengths.iter_mut().zip(more).for_each(|(l, more)| *l += more);
            }
        }
        lengths
    }

    /// Place of a coordinate among all of them.
    fn coordinate(&self, body: BodyId, coordinate: usize) -> usize {
        self.first[self.number(body)][1] + coordinate
    }

    /// What moves the coordinates at `x`.
    fn moves(&self, x: &[f64]) -> Moves {
        let mut moves = Moves::default();
        for (i, body) in self.lumped.iter().enumerate() {
            let [unknown, coordinate] = self.first[i];
            moves.begin(coordinate);
            for (c, u, slope) in body.slopes(&x[self.unknowns(BodyId::Lumped(i))]) {
                moves.begin(coordinate + c);
                moves.list.push((unknown + u, slope));
            }
        }
        for (i, body) in self.elastic.iter().enumerate() {
            let [unknown, coordinate] = self.first[self.lumped.len() + i];
            for k in 0..body.n_moving {
                moves.begin(coordinate + k);
                moves.list.push((unknown + k, 1.0));
            }
        }
        moves.begin(self.first[self.first.len() - 1][1]);
        moves
    }

    /// Unknowns that move a link, and the growth of its lengths with each; of a finite motion with the rows given.
    fn moved_by(
        &self,
        link: &Link,
        finite: Option<(CarriedCircle, FiniteRows)>,
        moves: &Moves,
        moved: &mut Vec<(usize, LinkRows)>,
    ) {
        moved.clear();
        for term in &link.terms {
            let of = moves.of(self.coordinate(term.body, term.coordinate)).iter();
            moved.extend(of.map(|(unknown, slope)| (*unknown, term.rows.map(|r| r * slope))));
        }
        let Some((finite, rows)) = finite else { return };
        for ((body, k), row) in finite.coordinates().into_iter().zip(rows) {
            let row = finite.in_link(row);
            for (unknown, slope) in moves.of(self.coordinate(body, k)) {
                let sum = match moved.iter().position(|(of, _)| of == unknown) {
                    Some(place) => &mut moved[place].1,
                    None => {
                        moved.push((*unknown, LinkRows::default()));
                        &mut moved.last_mut().expect("just added").1
                    }
                };
                sum.iter_mut().zip(row).for_each(|(sum, row)| *sum += slope * row);
            }
        }
    }

    /// Forces that an elastic body asks for: at its moving ports, and from the body that others follow.
    fn add_ports(&self, i: usize, x: &[f64], moves: &Moves, residual: &mut [f64]) {
        let (body, own) = (self.elastic[i], self.unknowns(BodyId::Elastic(i)));
        let forces = self.port_forces(i, x);
        residual[own].copy_from_slice(&forces[..body.n_moving]);
        if let Some(follow) = &body.follow {
            let on_body = follow.in_space(&forces[body.n_moving..]);
            let first = self.first[follow.body][1];
            for (c, force) in on_body.iter().enumerate() {
                for (unknown, slope) in moves.of(first + c) {
                    residual[*unknown] += slope * force;
                }
            }
        }
    }

    fn add_port_tangent(&self, i: usize, moves: &Moves, tangent: &mut [f64]) {
        let (n, body, own) = (self.n(), self.elastic[i], self.unknowns(BodyId::Elastic(i)));
        let (size, m) = (body.offset.len(), body.n_moving);
        // Unknowns that move the ports, and by how much.
        let mut columns: Vec<(usize, Vec<f64>)> = Vec::new();
        for (k, unknown) in own.clone().enumerate() {
            let mut slope = vec![0.0; size];
            slope[k] = 1.0;
            columns.push((unknown, slope));
        }
        let of_followed = |follow: Follow| (follow, self.of_followed(&follow, moves));
        let followed = body.follow.map(of_followed);
        for (follow, unknowns) in followed.iter() {
            for (unknown, q) in unknowns {
                let mut slope = vec![0.0; m];
                slope.extend(follow.ports(*q, size - m));
                columns.push((*unknown, slope));
            }
        }
        for (column, slope) in columns {
            let moved: Vec<usize> = (0..size).filter(|&k| slope[k] != 0.0).collect();
            for (k, row) in own.clone().enumerate() {
                tangent[n * row + column] += body.force_slope(k, &moved, &slope);
            }
            if let Some((follow, unknowns)) = &followed {
                let grown: Vec<f64> = (m..size).map(|k| body.force_slope(k, &moved, &slope)).collect();
                let on_body = follow.in_space(&grown);
                for (row, q) in unknowns {
                    tangent[n * row + column] += q.iter().zip(on_body).map(|(q, f)| q * f).sum::<f64>();
                }
            }
        }
    }

    /// Unknowns of a followed body and the growth of its five coordinates with each.
    fn of_followed(&self, follow: &Follow, moves: &Moves) -> Vec<(usize, [f64; 5])> {
        let mut found: Vec<(usize, [f64; 5])> = self
            .unknowns(BodyId::Lumped(follow.body))
            .map(|unknown| (unknown, [0.0; 5]))
            .collect();
        let first = self.first[follow.body][1];
        for c in 0..5 {
            for (unknown, slope) in moves.of(first + c) {
                found[unknown - self.first[follow.body][0]].1[c] += slope;
            }
        }
        found
    }
}

/// Links with more lengths see most coordinates in one of them alone.
const FEW_ROWS: usize = 4;

/// Entries of rows that are mostly zero: unknown, length, growth.
type Entries = Vec<(usize, usize, f64)>;

fn list_entries(rows: &[(usize, LinkRows)], m: usize, entries: &mut Entries) {
    entries.clear();
    for (unknown, row) in rows {
        let some = row[..m].iter().enumerate().filter(|(_, r)| **r != 0.0);
        entries.extend(some.map(|(i, r)| (*unknown, i, *r)));
    }
}

/// Adds R_a^T T R_b of a link whose rows are mostly zero, for all pairs of unknowns.
fn add_sparse(t: &[f64], m: usize, [rows, columns]: &[Entries; 2], (n, tangent): (usize, &mut [f64])) {
    for (a, i, r) in rows {
        let (row, t) = (&mut tangent[n * a..n * (a + 1)], &t[m * i..m * (i + 1)]);
        for (b, j, s) in columns {
            row[*b] += r * t[*j] * s;
        }
    }
}

/// Scalar product that begins with its first term.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut terms = a.iter().zip(b).map(|(a, b)| a * b);
    let first = terms.next().unwrap_or(0.0);
    terms.fold(first, |sum, term| sum + term)
}
