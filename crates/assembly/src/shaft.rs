//! The shaft as a linear structure: stiffness, mass, gyroscopic matrix, loads and where its dofs are held.
//!
//! A rigid shaft has five dofs: x, y, z and the tilts of the axis point at position 0. A point of the axis at position
//! s moves by the linear motion x + s tilt_y, y - s tilt_x. A beam has five dofs at every node.

use dynamics::stiffness::{N_SHAFT, ShaftMatrix};
use ring::rigid::RigidInertia;

use crate::beam::{BeamShaft, PointMass};
use crate::error::AssemblyError;

/// A place on the shaft: its displacement is `motion` times the five dofs from `first` on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Position along the shaft, m.
    pub position: f64,
    /// First of five dofs.
    pub first: usize,
    /// Motion of the place for those dofs.
    pub motion: ShaftMatrix,
}

impl Station {
    /// A place of a rigid shaft at a distance, m, from the point whose dofs are those of the shaft.
    pub fn on_rigid_shaft(position: f64) -> Station {
        Station {
            position,
            first: 0,
            motion: lever(position),
        }
    }

    /// Displacement of the place.
    pub fn displacement(&self, q: &[f64]) -> [f64; N_SHAFT] {
        applied(&self.motion, &q[self.first..self.first + N_SHAFT])
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
        }
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
            return Station::on_rigid_shaft(position);
        }
        let distance = |k: &usize| (self.nodes[*k] - position).abs();
        let node = (0..self.nodes.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        Station {
            position,
            first: N_SHAFT * node.unwrap_or(0),
            motion: identity(),
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

    /// Adds a load at a position, force x, y, z, N, and moment about x and y, N m.
    pub fn add_load(&self, position: f64, load: [f64; N_SHAFT], to: &mut [f64]) {
        self.station(position).add_load(load, to);
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
        if !self.is_beam {
            return self.station(position).displacement(q);
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
