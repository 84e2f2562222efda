//! The small contact problem: balls, shaft and the elastic motion of the groove centres, as a convex energy.
//!
//! With l the vector from groove centre to ball centre, the geometric approach is g = |l| + D_w/2 - R. |l| is
//! convex in all displacements, the contact energy V(g) is convex and increasing, and the elastic energy of the rings
//! is a positive quadratic form; so the total energy is convex and its minimum is the equilibrium. For each
//! flexible ring the elastic motion u_c of its groove centres answers forces F by u_c = c + C (F - F0): c is the
//! motion measured in the full field under forces F0, so a slightly outdated C only slows convergence.
//!
//! Unknowns, in this order: free shaft dofs (tilts times `tilt_arm`, so that all are lengths), balls [radial,
//! axial], elastic motions of the inner and of the outer groove centres [radial, axial].

use std::sync::Arc;

use contact::law::ContactForce;
use contact::{ContactLaw, Side, Unevenness};

pub use crate::displacements::Displacements;
use crate::model::Model;

/// Unknowns of one contact: at most 5 shaft dofs, 2 of the ball, 2 of the groove centre.
const MAX_LOCAL: usize = 9;

/// One ball on one raceway.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// Ball number.
    pub ball: usize,
    /// Raceway.
    pub side: Side,
    /// Azimuth of the ball, rad.
    pub azimuth: f64,
    /// The same on the mesh of the ring, which may have turned, rad.
    pub ring_azimuth: f64,
    /// Groove centre to ball centre at zero displacement [radial, axial], m.
    pub reach: [f64; 2],
    /// |l| at which they touch, R - D_w/2, m.
    pub touching: f64,
    /// Radius of the groove centre from the axis: the shaft's lever, m.
    pub lever: f64,
    /// Force law.
    pub law: ContactLaw,
    /// How far the facets lie inside the torus; None on an exact torus.
    pub unevenness: Option<Arc<Unevenness>>,
}

/// Elastic answer of one ring: u_c = offset + C (F - force), over (ball, [radial, axial]).
#[derive(Clone, Debug)]
pub struct RingResponse {
    /// Motion measured under `force`, m, `[2 n_balls]`.
    pub offset: Vec<f64>,
    /// Forces of that measurement, normal and contact loads together, N, `[2 n_balls]`.
    pub force: Vec<f64>,
    /// C^-1, N/m, row-major `[2 n_balls][2 n_balls]`.
    pub stiffness: Vec<f64>,
}

/// The contact problem of one instant.
pub struct Problem {
    /// All contacts: ball 0 inner, ball 0 outer, ball 1 inner, ...
    pub sites: Vec<Site>,
    /// Elastic rings; None is rigid.
    pub rings: [Option<RingResponse>; 2],
    /// Which shaft dofs are unknown; the others keep their value.
    pub shaft_free: [bool; 5],
    /// Shaft loads, N and N m.
    pub shaft_load: [f64; 5],
    /// Ball loads [radial, axial], N.
    pub ball_load: Vec<[f64; 2]>,
    /// Dead load on the ring at each contact, N, by site, or empty; shaft and ball loads have theirs already.
    pub contact_load: Vec<[f64; 2]>,
    /// Growth of the radial load of each ball with its radial displacement, N/m.
    pub ball_slopes: Vec<f64>,
    /// Length by which tilts are scaled, m.
    pub tilt_arm: f64,
}

/// A contact at given displacements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiteState {
    /// Unit vector from groove centre to ball centre.
    pub normal: [f64; 2],
    /// |l|, m.
    pub length: f64,
    /// Change of the approach per unit of l besides |l|, from the facets.
    pub slope: [f64; 2],
    /// Force, tangent and energy.
    pub force: ContactForce,
}

impl Site {
    /// A ball at an azimuth on an exact, rigid groove that has not turned, with the model's Hertz stiffness.
    pub fn new(model: &Model, ball: usize, side: Side, azimuth: f64) -> Site {
        let geometry = &model.geometry;
        let (centre, ball_centre) = (geometry.groove_centre(side), geometry.ball_centre());
        Site {
            ball,
            side,
            azimuth,
            ring_azimuth: azimuth,
            reach: [ball_centre[0] - centre[0], ball_centre[1] - centre[1]],
            touching: geometry.touching_distance(side),
            lever: geometry.centre_radius(side),
            law: ContactLaw {
                stiffness: model.hertz[side.index()].stiffness,
                patch_compliance: 0.0,
            },
            unevenness: None,
        }
    }

    /// Motion [radial, axial] of the groove centre per unit of each shaft dof (tilts in rad).
    pub fn shaft_rows(&self) -> [[f64; 2]; 5] {
        let (sin, cos) = self.azimuth.sin_cos();
        [
            [cos, 0.0],
            [sin, 0.0],
            [0.0, 1.0],
            [0.0, self.lever * sin],
            [0.0, -self.lever * cos],
        ]
    }

    /// State at given displacements.
    pub fn state(&self, u: &Displacements) -> SiteState {
        let mut l = self.reach;
        for i in 0..2 {
            l[i] += u.balls[self.ball][i];
            if let Some(groove) = u.grooves[self.side.index()].get(self.ball) {
                l[i] -= groove[i];
            }
        }
        if self.side == Side::Inner {
            for (row, q) in self.shaft_rows().iter().zip(u.shaft) {
                l[0] -= row[0] * q;
                l[1] -= row[1] * q;
            }
        }
        let length = l[0].hypot(l[1]);
        let normal = if length > 0.0 {
            [l[0] / length, l[1] / length]
        } else {
            [self.side.sign(), 0.0]
        };
        let mut state = SiteState {
            normal,
            length,
            slope: [0.0; 2],
            force: ContactForce::default(),
        };
        let mut approach = length - self.touching;
        if let Some(unevenness) = &self.unevenness {
            let (offset, derivative) = unevenness.at(self.contact_angle(&state));
            approach += offset;
            // d angle / dl = (-n_axial, n_radial) / |l|.
            state.slope = [-derivative * normal[1] / length, derivative * normal[0] / length];
        }
        state.force = self.law.evaluate(approach);
        state
    }

    /// Work of the contact force through the whole displacement of ball against groove centre, J.
    pub fn work(&self, u: &Displacements) -> f64 {
        let state = self.state(u);
        let moved = [0, 1].map(|i| state.normal[i] * state.length - self.reach[i]);
        state.force.force * (state.normal[0] * moved[0] + state.normal[1] * moved[1])
    }

    /// Contact angle at a state, rad.
    pub fn contact_angle(&self, state: &SiteState) -> f64 {
        let sign = self.side.sign();
        (sign * state.normal[1]).atan2(sign * state.normal[0])
    }
}

impl Problem {
    /// Whether the forces have an energy: false on faceted raceways, whose normals are not those of their facets.
    pub fn is_conservative(&self) -> bool {
        self.sites.iter().all(|s| s.unevenness.is_none())
    }

    /// Number of unknowns.
    pub fn n(&self) -> usize {
        let free = self.shaft_free.iter().filter(|f| **f).count();
        let rings = self.rings.iter().flatten().count();
        free + 2 * self.ball_load.len() * (1 + rings)
    }

    /// Index of the first unknown of a ring's groove motions.
    fn ring_start(&self, side: Side) -> usize {
        let balls = 2 * self.ball_load.len();
        let before = usize::from(side == Side::Outer && self.rings[0].is_some());
        self.shaft_free.iter().filter(|f| **f).count() + balls * (1 + before)
    }

    /// Scale from unknown to shaft dof.
    fn shaft_scale(&self, dof: usize) -> f64 {
        if dof < 3 { 1.0 } else { 1.0 / self.tilt_arm }
    }

    /// Displacements moved by `step` times the direction `p` of unknowns.
    pub fn moved(&self, u: &Displacements, p: &[f64], step: f64) -> Displacements {
        let mut v = u.clone();
        let mut p = p.iter().map(|x| step * x);
        let mut next = || p.next().expect("the direction has one entry per unknown");
        for i in 0..5 {
            if self.shaft_free[i] {
                v.shaft[i] += next() * self.shaft_scale(i);
            }
        }
        v.balls.iter_mut().flatten().for_each(|x| *x += next());
        for (groove, ring) in v.grooves.iter_mut().zip(&self.rings) {
            if ring.is_some() {
                groove.iter_mut().flatten().for_each(|x| *x += next());
            }
        }
        v
    }

    /// Gradient of the energy: out-of-balance forces, N, `[n]`.
    pub fn gradient(&self, u: &Displacements) -> Vec<f64> {
        let mut gradient = self.linear_gradient(u);
        for site in &self.sites {
            let state = site.state(u);
            let (indices, rows, n) = self.local(site);
            for a in 0..n {
                let along = rows[a][0] * state.normal[0] + rows[a][1] * state.normal[1];
                gradient[indices[a]] += state.force.force * along;
            }
        }
        gradient
    }

    /// Hessian of the energy, N/m, row-major `[n][n]`.
    pub fn hessian(&self, u: &Displacements) -> Vec<f64> {
        let n = self.n();
        let mut hessian = vec![0.0; n * n];
        for side in Side::BOTH {
            if let Some(ring) = &self.rings[side.index()] {
                let (start, m) = (self.ring_start(side), ring.offset.len());
                for i in 0..m {
                    hessian[n * (start + i) + start..n * (start + i) + start + m]
                        .copy_from_slice(&ring.stiffness[m * i..m * (i + 1)]);
                }
            }
        }
        let first_ball = self.shaft_free.iter().filter(|f| **f).count();
        for ball in 0..self.ball_load.len() {
            let radial = first_ball + 2 * ball;
            hessian[n * radial + radial] -= self.ball_slopes[ball];
        }
        for site in &self.sites {
            let state = site.state(u);
            let (indices, rows, n_local) = self.local(site);
            let block = site_hessian(&state);
            for a in 0..n_local {
                let left = [0, 1].map(|j| rows[a][0] * block[0][j] + rows[a][1] * block[1][j]);
                for b in 0..n_local {
                    hessian[n * indices[a] + indices[b]] += left[0] * rows[b][0] + left[1] * rows[b][1];
                }
            }
        }
        hessian
    }

    /// Loads on the balls [radial, axial] at given displacements, N.
    pub fn ball_loads(&self, u: &Displacements) -> Vec<[f64; 2]> {
        let loads = self.ball_load.iter().zip(&self.ball_slopes).zip(&u.balls);
        loads.map(|((f, slope), x)| [f[0] + slope * x[0], f[1]]).collect()
    }

    /// Gradient of loads and ring elasticity.
    fn linear_gradient(&self, u: &Displacements) -> Vec<f64> {
        let mut gradient = Vec::with_capacity(self.n());
        for i in 0..5 {
            if self.shaft_free[i] {
                gradient.push(-self.shaft_load[i] * self.shaft_scale(i));
            }
        }
        gradient.extend(self.ball_loads(u).iter().flatten().map(|f| -f));
        for (side, groove) in Side::BOTH.into_iter().zip(&u.grooves) {
            if let Some(ring) = &self.rings[side.index()] {
                let load = |i: usize| {
                    self.contact_load
                        .get(i - i % 2 + side.index())
                        .map_or(0.0, |f| f[i % 2])
                };
                let change: Vec<f64> = groove
                    .iter()
                    .flatten()
                    .zip(&ring.offset)
                    .map(|(u, c)| u - c)
                    .collect();
                let m = change.len();
                gradient.extend(ring.force.iter().enumerate().map(|(i, f)| {
                    f - load(i)
                        + ring.stiffness[m * i..m * (i + 1)]
                            .iter()
                            .zip(&change)
                            .map(|(k, x)| k * x)
                            .sum::<f64>()
                }));
            }
        }
        gradient
    }

    /// Unknowns that move one contact, and dl per unit of each.
    fn local(&self, site: &Site) -> ([usize; MAX_LOCAL], [[f64; 2]; MAX_LOCAL], usize) {
        let (mut indices, mut rows, mut n) = ([0; MAX_LOCAL], [[0.0; 2]; MAX_LOCAL], 0);
        let mut push = |index, row| {
            indices[n] = index;
            rows[n] = row;
            n += 1;
        };
        let mut free = 0;
        let shaft_rows = site.shaft_rows();
        for i in 0..5 {
            if self.shaft_free[i] {
                if site.side == Side::Inner {
                    let scale = self.shaft_scale(i);
                    push(free, [-scale * shaft_rows[i][0], -scale * shaft_rows[i][1]]);
                }
                free += 1;
            }
        }
        push(free + 2 * site.ball, [1.0, 0.0]);
        push(free + 2 * site.ball + 1, [0.0, 1.0]);
        if self.rings[site.side.index()].is_some() {
            let start = self.ring_start(site.side) + 2 * site.ball;
            push(start, [-1.0, 0.0]);
            push(start + 1, [0.0, -1.0]);
        }
        (indices, rows, n)
    }

    /// Name of an unknown, for messages.
    pub fn name(&self, index: usize) -> String {
        let free: Vec<usize> = (0..5).filter(|&i| self.shaft_free[i]).collect();
        if index < free.len() {
            return format!("shaft {}", SHAFT_DOFS[free[index]]);
        }
        let rest = index - free.len();
        let balls = 2 * self.ball_load.len();
        let direction = if rest.is_multiple_of(2) { "radial" } else { "axial" };
        let ball = rest % balls / 2;
        if rest < balls {
            return format!("ball {ball}, {direction}");
        }
        let inner = rest < 2 * balls && self.rings[0].is_some();
        let side = if inner { Side::Inner } else { Side::Outer };
        format!(
            "groove centre of ball {ball} on the {} ring, {direction}",
            side.name()
        )
    }
}

/// Force on the ring of every site [radial, axial], N.
pub fn site_forces(problem: &Problem, u: &Displacements) -> Vec<[f64; 2]> {
    let force = |site: &Site| {
        let state = site.state(u);
        state.normal.map(|n| state.force.force * n)
    };
    problem.sites.iter().map(force).collect()
}

/// Names of the shaft dofs, as in the scene.
pub const SHAFT_DOFS: [&str; 5] = ["x", "y", "z", "tilt_x", "tilt_y"];

/// Derivative of Q n with respect to l: k n (n + slope)^T + Q/|l| (1 - n n^T); without slope the Hessian of V(|l|).
pub(crate) fn site_hessian(state: &SiteState) -> [[f64; 2]; 2] {
    let n = state.normal;
    let across = if state.length > 0.0 {
        state.force.force / state.length
    } else {
        0.0
    };
    let gap = [0, 1].map(|i| n[i] + state.slope[i]);
    [0, 1].map(|i| {
        [0, 1].map(|j| {
            let identity = if i == j { 1.0 } else { 0.0 };
            state.force.tangent * n[i] * gap[j] + across * (identity - n[i] * n[j])
        })
    })
}
