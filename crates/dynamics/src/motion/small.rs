//! The small nonlinear system of one step: free shaft dofs, balls, groove centres of flexible rings.
//!
//! Unknowns are the displacements at the end of the step. Residuals are forces: inertia and loads of balls and shaft
//! at the weighted time of the step, and for every flexible ring the forces C^-1 (g1 - predicted) it asks for, against those of
//! contacts and shaft. [`super::newton`] solves it.

use contact::Side;
use timer::SharedLaps;

use super::contacts::{ContactDamping, ContactScheme, MeanForce, mean_force, viscous};
use super::inertia::Inertia;
use super::shaft::ShaftStep;
use crate::problem::Site;
use ring::Integrator;

/// A flexible ring as contacts and partner see it over the step.
pub struct RingAnswer {
    /// Groove motions at the start, then the mount's, m and rad.
    pub start: Vec<f64>,
    /// At the end without forces.
    pub predicted: Vec<f64>,
    /// Inverse compliance, SI, row-major.
    pub stiffness: Vec<f64>,
}

/// The system of one step.
pub struct SmallSystem {
    /// Step size, s.
    pub dt: f64,
    /// Scheme of all bodies.
    pub integrator: Integrator,
    /// Contacts, ball 0 inner, ball 0 outer, ...
    pub sites: Vec<Site>,
    /// Balls [radial, axial].
    pub balls: Vec<[Inertia; 2]>,
    /// Shaft.
    pub shaft: ShaftStep,
    /// Flexible rings.
    pub rings: [Option<RingAnswer>; 2],
    /// Force scheme.
    pub scheme: ContactScheme,
    /// Contact damping.
    pub damping: Option<ContactDamping>,
    /// Additional forces on the rings at the contacts, [radial, axial], N, by site; none when empty.
    pub extra: Vec<[f64; 2]>,
}

impl SmallSystem {
    pub(super) fn n_shaft(&self) -> usize {
        self.shaft.free().len()
    }

    pub(super) fn n(&self) -> usize {
        self.n_shaft() + 2 * self.balls.len() * (1 + self.rings.iter().flatten().count())
    }

    /// Index of a ball's radial unknown.
    pub fn ball_index(&self, ball: usize) -> usize {
        self.n_shaft() + 2 * ball
    }

    /// Index of the first groove unknown of a ring.
    pub(super) fn ring_index(&self, side: Side) -> usize {
        let before = usize::from(side == Side::Outer && self.rings[0].is_some());
        self.n_shaft() + 2 * self.balls.len() * (1 + before)
    }

    /// Shaft displacement at the end of the step.
    pub fn shaft_end(&self, x: &[f64]) -> [f64; 5] {
        self.shaft.end(&x[..self.n_shaft()])
    }

    /// l at the start and at the end of the step.
    pub fn reach(&self, site: &Site, x: &[f64]) -> [[f64; 2]; 2] {
        let ball = self.ball_index(site.ball);
        let mut l = [site.reach, site.reach];
        for i in 0..2 {
            l[0][i] += self.balls[site.ball][i].start[0];
            l[1][i] += x[ball + i];
        }
        if let Some(ring) = &self.rings[site.side.index()] {
            let first = self.ring_index(site.side) + 2 * site.ball;
            for i in 0..2 {
                l[0][i] -= ring.start[2 * site.ball + i];
                l[1][i] -= x[first + i];
            }
        } else if site.side == Side::Inner {
            let (start, end, rows) = (self.shaft.start(), self.shaft_end(x), site.shaft_rows());
            for (dof, row) in rows.iter().enumerate() {
                for i in 0..2 {
                    l[0][i] -= row[i] * start[dof];
                    l[1][i] -= row[i] * end[dof];
                }
            }
        }
        l
    }

    /// Unknowns that move a site, and dl1 per unit of each.
    fn local(&self, site: &Site) -> Vec<(usize, [f64; 2])> {
        let ball = self.ball_index(site.ball);
        let mut list = vec![(ball, [1.0, 0.0]), (ball + 1, [0.0, 1.0])];
        if self.rings[site.side.index()].is_some() {
            let first = self.ring_index(site.side) + 2 * site.ball;
            list.extend([(first, [-1.0, 0.0]), (first + 1, [0.0, -1.0])]);
        } else if site.side == Side::Inner {
            let rows = site.shaft_rows();
            let free = self.shaft.free().into_iter().enumerate();
            list.extend(free.map(|(k, dof)| (k, rows[dof].map(|r| -r))));
        }
        list
    }

    /// Mean forces of all contacts; `costs` gets the time of the damping.
    pub(super) fn forces(&self, x: &[f64], costs: &SharedLaps) -> Vec<MeanForce> {
        let reaches: Vec<_> = self.sites.iter().map(|s| self.reach(s, x)).collect();
        let places = || self.sites.iter().zip(&reaches);
        let damping = self.damping.as_ref().map(|damping| {
            costs.time("contact_damping", || {
                let at = |(s, l): (&Site, &_)| viscous(damping, self.dt, s.touching, *l);
                places().map(at).collect::<Vec<_>>()
            })
        });
        let scheme = (self.scheme, self.integrator.alpha_f);
        let viscous = |index: usize| damping.as_ref().map(|terms| terms[index]);
        places()
            .enumerate()
            .map(|(index, (s, l))| mean_force(&s.law, s.touching, *l, scheme, viscous(index)))
            .collect()
    }

    /// g of a ring at the end of the step: its groove unknowns, then the mount, which follows its partner.
    fn ring_motion(&self, side: Side, ring: &RingAnswer, x: &[f64]) -> Vec<f64> {
        let first = self.ring_index(side);
        let mut g = x[first..first + 2 * self.balls.len()].to_vec();
        let n_mount = ring.start.len() - g.len();
        let partner = match side {
            Side::Inner => self.shaft.in_frame(self.shaft_end(x)),
            Side::Outer => [0.0; 5],
        };
        // A sixth functional is the rotation about z, which nothing turns in the ring's frame.
        g.extend(partner.iter().chain(&[0.0]).take(n_mount));
        g
    }

    /// Forces that a ring asks for at its functionals to move as `x` says.
    pub(super) fn ring_forces(&self, side: Side, ring: &RingAnswer, x: &[f64]) -> Vec<f64> {
        let motion = self.ring_motion(side, ring, x);
        let m = motion.len();
        let off: Vec<f64> = motion.iter().zip(&ring.predicted).map(|(g, p)| g - p).collect();
        let row = |i: usize| (0..m).map(|k| ring.stiffness[m * i + k] * off[k]).sum();
        (0..m).map(row).collect()
    }

    /// dg of the mount per unit of a free shaft dof.
    fn mount_slope(&self, dof: usize, n_mount: usize) -> Vec<f64> {
        let mut unit = [0.0; 5];
        unit[dof] = 1.0;
        let slope = self.shaft.in_frame(unit);
        slope.iter().chain(&[0.0]).take(n_mount).copied().collect()
    }

    /// Shaft dofs and balls, in the order of their unknowns.
    fn bodies(&self) -> impl Iterator<Item = &Inertia> {
        let shaft = self.shaft.free().into_iter().map(|dof| &self.shaft.bodies[dof]);
        shaft.chain(self.balls.iter().flatten())
    }

    /// Residual at `x` with the forces of the contacts there.
    pub(super) fn residual(&self, x: &[f64], forces: &[MeanForce]) -> Vec<f64> {
        let mut residual = vec![0.0; self.n()];
        for (i, body) in self.bodies().enumerate() {
            residual[i] = body.residual(self.integrator, x[i], self.dt)[0];
        }
        for side in Side::BOTH {
            if let Some(ring) = &self.rings[side.index()] {
                self.add_ring(side, ring, x, &mut residual);
            }
        }
        for (index, (site, force)) in self.sites.iter().zip(forces).enumerate() {
            let extra = self.extra.get(index).copied().unwrap_or_default();
            for (a, row) in self.local(site) {
                // An additional force on the ring acts on the ball with the opposite sign, as the contact's.
                residual[a] += row[0] * (force.force[0] + extra[0]) + row[1] * (force.force[1] + extra[1]);
            }
        }
        residual
    }

    /// What bodies and rings put into the Jacobian, row-major: the same for all unknowns.
    pub(super) fn linear_slope(&self) -> Vec<f64> {
        let n = self.n();
        let mut jacobian = vec![0.0; n * n];
        for (i, body) in self.bodies().enumerate() {
            jacobian[n * i + i] += body.residual(self.integrator, body.start[0], self.dt)[1];
        }
        for side in Side::BOTH {
            if let Some(ring) = &self.rings[side.index()] {
                self.add_ring_slope(side, ring, &mut jacobian);
            }
        }
        jacobian
    }

    /// Adds what the contacts put into it.
    pub(super) fn add_contact_slopes(&self, forces: &[MeanForce], jacobian: &mut [f64]) {
        let n = self.n();
        for (site, force) in self.sites.iter().zip(forces) {
            let (local, t) = (self.local(site), &force.tangent);
            for (a, row_a) in &local {
                for (b, row_b) in &local {
                    jacobian[n * a + b] += (0..2)
                        .map(|i| row_a[i] * (t[i][0] * row_b[0] + t[i][1] * row_b[1]))
                        .sum::<f64>();
                }
            }
        }
    }

    /// Forces a ring asks for: on its groove unknowns, and from the shaft.
    fn add_ring(&self, side: Side, ring: &RingAnswer, x: &[f64], residual: &mut [f64]) {
        let forces = self.ring_forces(side, ring, x);
        let (first, m) = (self.ring_index(side), 2 * self.balls.len());
        residual[first..first + m].copy_from_slice(&forces[..m]);
        if side == Side::Inner {
            let on_shaft = self.shaft.in_space(first_five(&forces[m..]));
            for (k, dof) in self.shaft.free().into_iter().enumerate() {
                residual[k] += on_shaft[dof];
            }
        }
    }

    fn add_ring_slope(&self, side: Side, ring: &RingAnswer, jacobian: &mut [f64]) {
        let (n, first, m) = (self.n(), self.ring_index(side), 2 * self.balls.len());
        let size = ring.start.len();
        let free = if side == Side::Inner {
            self.shaft.free()
        } else {
            Vec::new()
        };
        // Columns of all unknowns that move the ring: place in x, and dg.
        let slope_of = |k: usize| {
            let mut slope = vec![0.0; size];
            slope[k] = 1.0;
            slope
        };
        let mut columns: Vec<(usize, Vec<f64>)> = (0..m).map(|k| (first + k, slope_of(k))).collect();
        for (k, &dof) in free.iter().enumerate() {
            let mut slope = vec![0.0; m];
            slope.extend(self.mount_slope(dof, size - m));
            columns.push((k, slope));
        }
        for (column, slope) in columns {
            let moved: Vec<usize> = (0..size).filter(|&k| slope[k] != 0.0).collect();
            let row = |i: usize| -> f64 {
                moved
                    .iter()
                    .map(|&k| ring.stiffness[size * i + k] * slope[k])
                    .sum()
            };
            for i in 0..m {
                jacobian[n * (first + i) + column] += row(i);
            }
            if !free.is_empty() {
                let mount: Vec<f64> = (m..size).map(row).collect();
                let on_shaft = self.shaft.in_space(first_five(&mount));
                for (k, &dof) in free.iter().enumerate() {
                    jacobian[n * k + column] += on_shaft[dof];
                }
            }
        }
    }
}

/// The first five entries; zeros when there are fewer.
pub fn first_five(values: &[f64]) -> [f64; 5] {
    [0, 1, 2, 3, 4].map(|i| values.get(i).copied().unwrap_or(0.0))
}
