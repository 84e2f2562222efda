//! Finite motions of links in a system: their coordinates, slopes and curvature.

use super::super::finite::{CarriedCircle, FiniteCoordinates, FiniteMotion, FiniteRows};
use super::super::interaction::{Link, LinkForces, LinkRows};
use super::super::lumped::Interval;
use super::System;

impl System<'_> {
    /// Whether the motion of a link is finite.
    pub fn has_curvature(&self) -> bool {
        let mut links = self.interactions.iter().flat_map(|family| family.links());
        links.any(|link| link.finite.is_some())
    }

    /// Adds what the curvature of finite motions puts into it: the growth of the lengths' slopes times the forces. At
    /// rest it may make the tangent indefinite. Over a step slopes are means, so half of it.
    pub fn add_curvatures(&self, x: &[f64], links: &[LinkForces], tangent: &mut [f64]) {
        let (n, moves, end) = (self.n(), self.moves(x), self.end(x));
        let share = if self.interval == Interval::Rest { 1.0 } else { 0.5 };
        for (family, found) in self.interactions.iter().zip(links) {
            let forces = found.forces.chunks_exact(family.n_rows());
            for (link, force) in family.links().iter().zip(forces) {
                let Some(finite) = link.finite else { continue };
                let force = finite.of_link(force).map(|force| share * force);
                if force == [0.0; 2] {
                    continue;
                }
                let curvature = finite
                    .circle
                    .curvature(self.finite_coordinates(&finite, &end), force);
                let moving = finite
                    .coordinates()
                    .map(|(body, k)| moves.of(self.coordinate(body, k)));
                for (row, rows) in curvature.iter().zip(moving) {
                    for (value, columns) in row.iter().zip(moving) {
                        for (a, of_a) in rows {
                            let of_b = columns.iter();
                            of_b.for_each(|(b, of_b)| tangent[n * a + b] += of_a * value * of_b);
                        }
                    }
                }
            }
        }
    }

    /// Finite motions of a family's links, by link, with their coordinates for the unknowns `x`.
    pub fn finite_motions(&self, family: usize, x: &[f64]) -> Vec<Option<FiniteMotion>> {
        let end = self.end(x);
        let of = |link: &Link| {
            let finite = link.finite?;
            Some(FiniteMotion {
                circle: finite.circle,
                at: self.finite_coordinates(&finite, &end),
            })
        };
        self.interactions[family].links().iter().map(of).collect()
    }

    /// Unknowns that move the links of a family at `x`, by link, and the growth of its lengths with each.
    pub fn growths(&self, family: usize, x: &[f64]) -> Vec<Vec<(usize, LinkRows)>> {
        let (moves, end) = (self.moves(x), self.end(x));
        let of = |link: &Link| {
            let rows = |finite: CarriedCircle| finite.circle.rows(self.finite_coordinates(&finite, &end));
            let mut moved = Vec::new();
            self.moved_by(link, link.finite.map(|f| (f, rows(f))), &moves, &mut moved);
            moved
        };
        self.interactions[family].links().iter().map(of).collect()
    }

    /// Those of a finite motion.
    pub(super) fn finite_coordinates(
        &self,
        finite: &CarriedCircle,
        coordinates: &[f64],
    ) -> FiniteCoordinates {
        finite
            .coordinates()
            .map(|(body, k)| coordinates[self.coordinate(body, k)])
    }

    /// Slopes with which forces act: of the instant, or means over a step.
    pub(super) fn mean_rows(&self, finite: &CarriedCircle, end: &[f64]) -> FiniteRows {
        match self.interval {
            Interval::Rest => finite.circle.rows(self.finite_coordinates(finite, end)),
            Interval::Step(_) => finite.circle.mean_rows(
                self.finite_coordinates(finite, &self.start),
                self.finite_coordinates(finite, end),
            ),
        }
    }
}
