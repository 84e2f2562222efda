//! Modes of a shaft that turns on its bearings.
//!
//! ```text
//! M x'' + (C + W G) x' + K x = 0        x: free dofs of the shaft, then [radial, axial] of the balls of each bearing
//! ```
//!
//! As [`dynamics::whirl`] for one bearing: M has the shaft, the inner rings as rigid bodies at their places, and the
//! balls; G is the gyroscopic matrix of all that turns, W the speed. What that leaves out is left out here too. Bodies
//! that carry several bearings couple them by their stiffness at rest; one on the shaft turns as a rigid one.

use dynamics::bodies::AXES;
use dynamics::stiffness::N_SHAFT;
use dynamics::whirl::{ShaftRow, TurningShaft, WhirlMatrices, is_held, turning_inertia};

use crate::assembly::Assembly;
use crate::error::AssemblyError;
use crate::shaft::{ShaftBody, product};
use crate::stiffness::{InBodies, LinearAssembly};

/// The shaft with the inner rings that turn with it.
pub fn turning_shaft(assembly: &Assembly) -> Result<ShaftBody, AssemblyError> {
    let mut shaft = assembly.shaft.clone();
    for (bearing, mount) in assembly.bearings.iter().zip(assembly.mounts()) {
        let mut inertia =
            turning_inertia(&bearing.model).map_err(AssemblyError::of_bearing(&bearing.name))?;
        // Its centre lies along the bearing's own z.
        inertia.first_moment = bearing.place.orientation.turned_angle(inertia.first_moment);
        shaft.add_inertia(&mount.station, &inertia);
    }
    Ok(shaft)
}

/// The equations of linearised bearings and a shaft with all that turns ([`turning_shaft`]) at a speed, rad/s.
pub fn equations(
    assembly: &Assembly,
    shaft: &ShaftBody,
    linear: &LinearAssembly,
    speed: f64,
) -> Result<TurningShaft, AssemblyError> {
    let n_shaft = shaft.n();
    let balls = |b: usize| 2 * assembly.bearings[b].model.geometry.n_balls;
    let n = n_shaft + (0..assembly.bearings.len()).map(balls).sum::<usize>();
    let mut all = of_shaft(shaft, n, speed);
    let free: Vec<usize> = (0..n_shaft).filter(|&i| shaft.held[i].is_none()).collect();
    require_inertia(&all, &free)?;
    let mut rows = free.clone();
    let mut first = n_shaft;
    let mut places = Vec::new();
    let is_in_bodies = |b: usize| {
        linear
            .in_bodies
            .as_ref()
            .is_some_and(|all| all.starts[b] < all.starts[b + 1])
    };
    for (b, (bearing, mount)) in assembly.bearings.iter().zip(assembly.mounts()).enumerate() {
        let fail = AssemblyError::of_bearing(&bearing.name);
        let own = linear.bearings[b].of_shaft_and_balls().map_err(fail)?;
        let turn: [[f64; N_SHAFT]; N_SHAFT] = std::array::from_fn(|i| {
            let mut row = [0.0; N_SHAFT];
            row[i] = 1.0;
            bearing.place.orientation.turned(row)
        });
        let at = BearingRows {
            motion: product(&turn, &mount.station.motion),
            shaft: mount.station.first,
            balls: first,
        };
        if !is_in_bodies(b) {
            at.add(&at, (own.n, &own.stiffness), n, &mut all.stiffness);
        }
        if let Some(damping) = &own.damping {
            at.add(&at, (own.n, damping), n, &mut all.rates);
        }
        for i in 0..balls(b) {
            all.mass[(n + 1) * (first + i)] = bearing.model.ball_mass();
            if is_held(&own, N_SHAFT + i) {
                rows.push(first + i);
            }
        }
        first += balls(b);
        places.push(at);
    }
    if let Some(bodies) = &linear.in_bodies {
        add_bodies(bodies, &places, n, &mut all.stiffness);
    }
    let row = |&i: &usize| ShaftRow {
        node: i / N_SHAFT,
        dof: i % N_SHAFT,
    };
    let shaft_rows = free.iter().map(row).collect();
    Ok(TurningShaft::of_matrices(all.of_rows(&rows), shaft_rows, speed))
}

/// Matrices of the shaft at a speed, of `n` rows with room for what follows its dofs.
fn of_shaft(shaft: &ShaftBody, n: usize, speed: f64) -> WhirlMatrices {
    let spread = |matrix: &[f64], factor: f64| {
        let mut whole = vec![0.0; n * n];
        for (row, own) in whole.chunks_exact_mut(n).zip(matrix.chunks_exact(shaft.n())) {
            row.iter_mut().zip(own).for_each(|(sum, x)| *sum = factor * x);
        }
        whole
    };
    WhirlMatrices {
        n,
        mass: spread(&shaft.mass, 1.0),
        rates: spread(&shaft.gyroscopic, speed),
        stiffness: spread(&shaft.stiffness, 1.0),
    }
}

/// Adds the stiffness of bearings that share bodies to one of `n` rows.
fn add_bodies(bodies: &InBodies, places: &[BearingRows], n: usize, to: &mut [f64]) {
    let InBodies { starts, stiffness } = bodies;
    let n_coupled = starts[places.len()];
    for (loaded, at) in places.iter().enumerate() {
        for (moved, from) in places.iter().enumerate() {
            let columns = starts[moved]..starts[moved + 1];
            let rows = stiffness
                .chunks_exact(n_coupled)
                .take(starts[loaded + 1])
                .skip(starts[loaded]);
            let block: Vec<f64> = rows.flat_map(|row| &row[columns.clone()]).copied().collect();
            at.add(from, (columns.len(), &block), n, to);
        }
    }
}

/// Where the dofs of a bearing are among all rows: its axis point moves by `motion` times five dofs of the shaft.
struct BearingRows {
    motion: [[f64; N_SHAFT]; N_SHAFT],
    shaft: usize,
    balls: usize,
}

impl BearingRows {
    /// Adds a matrix of `m` columns, over the loads on this bearing's axis point and balls by motions of another's, to
    /// one of `n` rows.
    fn add(&self, moved: &BearingRows, (m, own): (usize, &[f64]), n: usize, to: &mut [f64]) {
        if m == 0 {
            return;
        }
        let columns: Vec<_> = (0..m).map(|j| moved.spread(j)).collect();
        for (i, row) in own.chunks_exact(m).enumerate() {
            for (row_of, a) in self.spread(i) {
                for (entry, columns) in row.iter().zip(&columns) {
                    for (column, b) in columns {
                        to[n * row_of + column] += a * entry * b;
                    }
                }
            }
        }
    }

    /// Of a row of the bearing: the rows among all, and their factors.
    fn spread(&self, i: usize) -> Vec<(usize, f64)> {
        match i {
            0..N_SHAFT => (0..N_SHAFT)
                .map(|k| (self.shaft + k, self.motion[i][k]))
                .collect(),
            _ => vec![(self.balls + i - N_SHAFT, 1.0)],
        }
    }
}

fn require_inertia(all: &WhirlMatrices, free: &[usize]) -> Result<(), AssemblyError> {
    let lacking = free.iter().find(|&&i| all.mass[(all.n + 1) * i] <= 0.0);
    lacking.map_or(Ok(()), |&i| {
        let dof = i % N_SHAFT;
        Err(AssemblyError::NoInertia {
            dof: AXES[dof],
            key: if dof < 3 {
                "shaft.mass"
            } else {
                "shaft.transverse_inertia"
            },
        })
    })
}
