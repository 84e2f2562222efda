//! The shaft as a linear structure: stiffness, mass, gyroscopic matrix, loads and where its dofs are held.
//!
//! A rigid shaft has five dofs: x, y, z of the axis point at position 0, and the rotation vector phi of its finite
//! rotation R, which has no component along z. A point of the axis at position s moves by
//!
//! ```text
//! x + s (R - 1) e_z,   R e_z = (phi_y sin(t)/t, -phi_x sin(t)/t, cos t),   t = |phi|
//! ```
//!
//! A beam has five dofs at every node, and is linear.

use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use dynamics::system::angle_functions;
use ring::rigid::RigidInertia;

use crate::beam::{BeamShaft, PointMass};
use crate::error::AssemblyError;

/// A place on the shaft: to first order its displacement is `motion` times the five dofs from `first` on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Position along the shaft, m.
    pub position: f64,
    /// First of five dofs.
    pub first: usize,
    /// Motion of the place for those dofs: of a straight shaft, unless it was asked for at a displacement.
    pub motion: ShaftMatrix,
    /// Distance from the origin of a rigid shaft that tilts by finite rotations, m; else 0.
    pub lever: f64,
}

impl Station {
    /// A place of a rigid shaft at a distance, m, from the point whose dofs are those of the shaft.
    pub fn on_rigid_shaft(position: f64) -> Station {
        Station {
            position,
            first: 0,
            motion: lever(position),
            lever: position,
        }
    }

    /// Displacement of a place that was asked for of a straight shaft.
    pub fn displacement(&self, q: &[f64]) -> [f64; N_SHAFT] {
        let mut place = self.moved(q);
        if self.lever == 0.0 {
            return place;
        }
        let [tilt_x, tilt_y] = [q[self.first + 3], q[self.first + 4]];
        let square = tilt_x * tilt_x + tilt_y * tilt_y;
        let [c, e] = angle_functions(square);
        // (R - 1) e_z less its first order.
        place[0] -= self.lever * square * e * tilt_y;
        place[1] += self.lever * square * e * tilt_x;
        place[2] -= self.lever * square * c;
        place
    }

    /// The same place with its motion about a displacement of the shaft.
    pub fn at(&self, q: &[f64]) -> Station {
        if self.lever == 0.0 {
            return *self;
        }
        let [tilt_x, tilt_y] = [q[self.first + 3], q[self.first + 4]];
        let square = tilt_x * tilt_x + tilt_y * tilt_y;
        let [c, e] = angle_functions(square);
        let s = 1.0 - square * e;
        let mut motion = identity();
        // d(sin(t)/t)/d phi = (e - c) phi.
        motion[0][3] = self.lever * (e - c) * tilt_x * tilt_y;
        motion[0][4] = self.lever * (s + (e - c) * tilt_y * tilt_y);
        motion[1][3] = -self.lever * (s + (e - c) * tilt_x * tilt_x);
        motion[1][4] = -self.lever * (e - c) * tilt_x * tilt_y;
        motion[2][3] = -self.lever * s * tilt_x;
        motion[2][4] = -self.lever * s * tilt_y;
        Station { motion, ..*self }
    }

    /// Motion of the place for one of the dofs, by [`motion`](Station::motion).
    pub fn moved(&self, by: &[f64]) -> [f64; N_SHAFT] {
        applied(&self.motion, &by[self.first..self.first + N_SHAFT])
    }

    /// Adds the share of the dofs in a load at the place.
    pub fn add_load(&self, load: [f64; N_SHAFT], to: &mut [f64]) {
        for (i, row) in self.motion.iter().enumerate() {
            for (sum, a) in to[self.first..].iter_mut().zip(row) {
                *sum += a * load[i];
            }
        }
    }

    /// Adds what a matrix over the motion of the place is over the dofs, to one of `n` rows.
    pub fn add_matrix(&self, matrix: &ShaftMatrix, n: usize, to: &mut [f64]) {
        let half = product(matrix, &self.motion);
        for i in 0..N_SHAFT {
            for j in 0..N_SHAFT {
                let entry: f64 = (0..N_SHAFT).map(|k| self.motion[k][i] * half[k][j]).sum();
                to[n * (self.first + i) + self.first + j] += entry;
            }
        }
    }
}

/// Product of a matrix and a vector.
pub fn applied(matrix: &ShaftMatrix, x: &[f64]) -> [f64; N_SHAFT] {
    matrix.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
}

/// Product of two matrices.
pub fn product(a: &ShaftMatrix, b: &ShaftMatrix) -> ShaftMatrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..N_SHAFT).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Motion of the point at distance `s` along z from the one whose dofs are given.
fn lever(s: f64) -> ShaftMatrix {
    let mut motion = identity();
    motion[0][4] = s;
    motion[1][3] = -s;
    motion
}

/// The matrix of no change.
pub fn identity() -> ShaftMatrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }))
}

/// A shaft without its bearings.
#[derive(Clone, Debug)]
pub struct ShaftBody {
    /// Positions of the nodes along the shaft, m; a rigid shaft has one, at 0.
    pub nodes: Vec<f64>,
    /// Displacement at which a dof is held, m or rad; None is free. `[5 n_nodes]`.
    pub held: Vec<Option<f64>>,
    /// Stiffness, row-major; all zero of a rigid shaft.
    pub stiffness: Vec<f64>,
    /// Mass, row-major.
    pub mass: Vec<f64>,
    /// Gyroscopic matrix of 1 rad/s, row-major.
    pub gyroscopic: Vec<f64>,
    is_beam: bool,
    /// Whether places have no levers: of a beam, and under a body that is linear.
    is_linear: bool,
}

impl ShaftBody {
    /// A rigid shaft with its inertia about position 0, whose dofs are held at given displacements.
    pub fn rigid(inertia: RigidInertia, held: [Option<f64>; N_SHAFT]) -> ShaftBody {
        let mut shaft = ShaftBody::empty(vec![0.0], false);
        shaft.held = held.to_vec();
        let station = shaft.station(0.0);
        shaft.add_inertia(&station, &inertia);
        shaft
    }

    /// A shaft of beam elements with nodes at the stations, m, among others.
    pub fn beam(beam: &BeamShaft, stations: &[f64]) -> Result<ShaftBody, AssemblyError> {
        let mut shaft = ShaftBody::empty(beam.nodes(stations)?, true);
        let n = shaft.n();
        for (k, element) in beam.elements(&shaft.nodes).into_iter().enumerate() {
            let add = |matrix: &mut Vec<f64>, own: [[f64; 10]; 10]| {
                for (i, row) in own.iter().enumerate() {
                    for (j, entry) in row.iter().enumerate() {
                        matrix[n * (N_SHAFT * k + i) + N_SHAFT * k + j] += entry;
                    }
                }
            };
            add(&mut shaft.stiffness, element.stiffness());
            add(&mut shaft.mass, element.mass());
            add(&mut shaft.gyroscopic, element.gyroscopic());
        }
        Ok(shaft)
    }

    fn empty(nodes: Vec<f64>, is_beam: bool) -> ShaftBody {
        let n = N_SHAFT * nodes.len();
        ShaftBody {
            nodes,
            held: vec![None; n],
            stiffness: vec![0.0; n * n],
            mass: vec![0.0; n * n],
            gyroscopic: vec![0.0; n * n],
            is_beam,
            is_linear: is_beam,
        }
    }

    /// Takes the tilts of a rigid shaft for small, as an elastic body does that it carries with several bearings.
    pub fn be_linear(&mut self) {
        self.is_linear = true;
    }

    /// Whether its places move by its dofs to first order alone.
    pub fn is_linear(&self) -> bool {
        self.is_linear
    }

    /// Number of dofs.
    pub fn n(&self) -> usize {
        self.held.len()
    }

    /// Whether it bends.
    pub fn is_beam(&self) -> bool {
        self.is_beam
    }

    /// The place at a position, m: any of a rigid shaft, the nearest node of a beam.
    pub fn station(&self, position: f64) -> Station {
        if !self.is_beam {
            return self.at_distance(position);
        }
        let distance = |k: &usize| (self.nodes[*k] - position).abs();
        let node = (0..self.nodes.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        Station {
            position,
            first: N_SHAFT * node.unwrap_or(0),
            motion: identity(),
            lever: 0.0,
        }
    }

    /// The place of a rigid shaft at a distance, m, from the point whose dofs are those of the shaft.
    pub fn at_distance(&self, distance: f64) -> Station {
        let station = Station::on_rigid_shaft(distance);
        match self.is_linear {
            true => Station {
                lever: 0.0,
                ..station
            },
            false => station,
        }
    }

    /// Adds a body that is fixed to the shaft at a station.
    pub fn add_inertia(&mut self, station: &Station, inertia: &RigidInertia) {
        let n = self.n();
        let mut mass = [[0.0; N_SHAFT]; N_SHAFT];
        for j in 0..N_SHAFT {
            let mut unit = [0.0; N_SHAFT];
            unit[j] = 1.0;
            let column = inertia.times(unit);
            (0..N_SHAFT).for_each(|i| mass[i][j] = column[i]);
        }
        station.add_matrix(&mass, n, &mut self.mass);
        let mut gyroscopic = [[0.0; N_SHAFT]; N_SHAFT];
        (gyroscopic[3][4], gyroscopic[4][3]) = (inertia.polar, -inertia.polar);
        station.add_matrix(&gyroscopic, n, &mut self.gyroscopic);
    }

    /// Adds a disc.
    pub fn add_mass(&mut self, mass: &PointMass) {
        let station = self.station(mass.position);
        let inertia = RigidInertia {
            mass: mass.mass,
            first_moment: 0.0,
            transverse: mass.transverse,
            polar: mass.polar,
        };
        self.add_inertia(&station, &inertia);
    }

    /// Load of a uniform acceleration, m/s^2, on all its mass: what does the same work. Masses whose centre is off
    /// their node are in the mass matrix with their first moments.
    pub fn weight(&self, acceleration: [f64; 3]) -> Vec<f64> {
        let n = self.n();
        let mut uniform = vec![0.0; n];
        for node in uniform.chunks_exact_mut(N_SHAFT) {
            node[..3].copy_from_slice(&acceleration);
        }
        times(n, &self.mass, &uniform)
    }

    /// Displacement at a position that may lie between nodes: linear between those of a beam.
    pub fn displacement_at(&self, position: f64, q: &[f64]) -> [f64; N_SHAFT] {
        match self.is_beam {
            true => self.moved_at(position, q),
            false => self.station(position).displacement(q),
        }
    }

    /// The same to first order about a straight shaft: for modes.
    pub fn moved_at(&self, position: f64, q: &[f64]) -> [f64; N_SHAFT] {
        if !self.is_beam {
            return self.station(position).moved(q);
        }
        let last = self.nodes.len() - 1;
        let after = self.nodes.partition_point(|z| *z < position).clamp(1, last);
        let [a, b] = [self.nodes[after - 1], self.nodes[after]];
        let share = ((position - a) / (b - a)).clamp(0.0, 1.0);
        std::array::from_fn(|i| (1.0 - share) * q[N_SHAFT * (after - 1) + i] + share * q[N_SHAFT * after + i])
    }
}

/// Product of a matrix of the shaft, of `n` columns and row-major, and a vector. A node sees its neighbours alone.
pub fn times(n: usize, matrix: &[f64], x: &[f64]) -> Vec<f64> {
    let row = |(i, row): (usize, &[f64])| {
        let first = (i - i % N_SHAFT).saturating_sub(N_SHAFT);
        let near = first..n.min(i - i % N_SHAFT + 2 * N_SHAFT);
        row[near.clone()].iter().zip(&x[near]).map(|(a, x)| a * x).sum()
    };
    matrix.chunks_exact(n).enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a place would be pushed another way than it moves: motions are the slopes of displacements, and places
    /// keep their distance from the origin.
    #[test]
    fn places_move_by_the_slopes_of_their_displacement() {
        let shaft = ShaftBody::rigid(RigidInertia::default(), [None; N_SHAFT]);
        let station = shaft.station(0.3);
        for q in [
            [0.0; 5],
            [1e-3, 2e-3, -1e-3, 0.02, -0.05],
            [0.0, 0.0, 0.0, 0.4, 0.6],
        ] {
            let motion = station.at(&q).motion;
            for k in 0..N_SHAFT {
                let (h, mut low, mut high) = (1e-5, q, q);
                (low[k], high[k]) = (low[k] - h, high[k] + h);
                let [low, high] = [low, high].map(|q| station.displacement(&q));
                for i in 0..N_SHAFT {
                    let slope = (high[i] - low[i]) / (2.0 * h);
                    assert!((slope - motion[i][k]).abs() < 1e-10, "{i} {k}");
                }
            }
            let moved = station.displacement(&q);
            let apart = [0, 1, 2].map(|i| moved[i] - q[i] + if i == 2 { 0.3 } else { 0.0 });
            let distance = apart.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((distance - 0.3).abs() < 1e-15, "{distance}");
        }
    }
}
