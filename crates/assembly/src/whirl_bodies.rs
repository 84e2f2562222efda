//! Elastic bodies under the rings of bearings whose shaft turns: what vibrates of them, made ready once for all speeds.
//!
//! A body is its oscillators (`vibration` of crate `body`). Those up to the frequency of its modes swing; those above
//! follow the forces p on its seats, xi = y p/omega^2 with their motion y of the seats. So the seats move by
//!
//! ```text
//! y = S xi + F_h p,      F_h = F - sum y y^T/omega^2 of those that swing
//! ```
//!
//! Of a body on the shaft the oscillators are those of a body that flies freely, which the mass of a shaft at its held
//! faces would take many of. So they are combined to those of the body with a shaft that stands, z: with A z the rigid
//! oscillators by which free ones keep the shaft in place,
//!
//! ```text
//! (1 + A^T A) z omega^2 = K z,      M = (Q^-1 q)^2 - 2 (Q^-1 q) A z + z^2
//! ```
//!
//! A ring in a seat has the inertia of a rigid one that moves with the mean motion of the seat, in the sense of least
//! squares over its area, and turns about z as that does.

use std::ops::Range;
use std::sync::Arc;

use body::{BodyModes, SeatFunctions, SeatModes, SeatTie, ShaftAtSeat, Surrounding};
use contact::Side;
use dense::{DenseCholesky, inner_products, linear_combinations};
use dynamics::stiffness::N_SHAFT;
use dynamics::whirl::ring_inertia;
use dynamics::{DynamicsError, Model, RingError};
use ring::rigid::RigidInertia;

use crate::error::AssemblyError;
use crate::shaft::applied;

/// Frequency up to which oscillators swing where the scene names none, Hz: that of bodies in motion.
const MODES_BELOW: f64 = 20e3;

/// A body that vibrates.
pub struct WhirlBody {
    /// Its seats.
    pub seats: Vec<WhirlSeat>,
    /// Functions of all seats.
    pub n_functions: usize,
    /// Squares of the angular frequencies of the elastic oscillators that swing, 1/s^2.
    pub squares: Vec<f64>,
    /// S by oscillator, of a body on the shaft beside that, `[oscillator][n_functions]` flat.
    pub rows: Vec<f64>,
    /// F_h, m/N, `[n_functions][n_functions]` flat.
    pub flexibility_above: Vec<f64>,
    /// What bearings have of the flexibility of their own seats, less F_h.
    pub flexibility_beside: Vec<f64>,
    /// Mass of the oscillators above by forces, kg m^2/N^2.
    pub mass_above: Vec<f64>,
    /// The shaft that carries it; None of one that stands.
    pub on_shaft: Option<BodyOnShaft>,
}

/// How a body moves with its shaft, at the bearing of its first seat.
pub struct BodyOnShaft {
    /// Number of that bearing.
    pub bearing: usize,
    /// Speed of the body in its own frame over that of the shaft in the frame of that bearing: 1 or -1.
    pub way: f64,
    /// Q^-1, `[rigid][motion]`.
    pub of_motion: [[f64; N_SHAFT]; N_SHAFT],
    /// A of the oscillators that swing.
    pub kept: Vec<[f64; N_SHAFT]>,
    /// The same of forces on those above, `[rigid][n_functions]` flat.
    pub kept_above: Vec<f64>,
    /// Gyroscopic matrix of 1 rad/s of the rigid oscillators and those that swing, row-major.
    pub gyroscopic: Vec<f64>,
    /// Their masses across z.
    pub radial: Vec<f64>,
    /// The same between motions that are turned by 90 deg.
    pub across: Vec<f64>,
    /// Mass, kg.
    pub mass: f64,
}

/// A seat with its ring.
pub struct WhirlSeat {
    /// Number of the bearing.
    pub bearing: usize,
    /// The ring.
    pub side: Side,
    /// Its functions among those of the body.
    pub functions: Range<usize>,
    /// Inertia of the ring about the place of the bearing.
    pub inertia: RigidInertia,
    /// Mean motion x, y, z, tilt x, tilt y, turn about z of the ring by functions, `[6][functions]` flat.
    pub mean: Vec<f64>,
}

/// Motions of a ring in a seat.
pub const N_MEAN: usize = N_SHAFT + 1;

/// A joint of a ring with a body.
struct WhirlJoint<'m> {
    bearing: usize,
    name: &'m str,
    side: Side,
    model: &'m Model,
    tie: &'m Arc<SeatTie>,
    body: &'m Arc<Surrounding>,
}

/// The bodies with a mass under the rings of bearings, which have names for messages.
pub fn whirl_bodies(bearings: &[(&str, &Model)]) -> Result<Vec<WhirlBody>, AssemblyError> {
    let mut groups: Vec<Vec<WhirlJoint<'_>>> = Vec::new();
    for (bearing, &(name, model)) in bearings.iter().enumerate() {
        for side in Side::BOTH {
            let Some(tie) = model.tied(side).and_then(|ring| ring.tie.as_ref()) else {
                continue;
            };
            let Some(body) = tie.body.as_ref().filter(|body| body.has_mass()) else {
                continue;
            };
            let joint = WhirlJoint {
                bearing,
                name,
                side,
                model,
                tie,
                body,
            };
            match groups.iter_mut().find(|group| Arc::ptr_eq(group[0].body, body)) {
                Some(group) => group.push(joint),
                None => groups.push(vec![joint]),
            }
        }
    }
    groups.iter().map(|group| whirl_body(group)).collect()
}

fn whirl_body(joints: &[WhirlJoint<'_>]) -> Result<WhirlBody, AssemblyError> {
    let first = joints
        .iter()
        .min_by_key(|joint| joint.tie.seat)
        .expect("a body has a seat");
    let (body, fail) = (first.body, |source| first.fails(RingError::Body { source }));
    let modes = match &first.tie.modes {
        Some(modes) => modes.of_body.clone(),
        None => Arc::new(body.modes(MODES_BELOW).map_err(fail)?),
    };
    let n_rigid = if body.carried.is_some() { N_SHAFT } else { 0 };
    let most = (std::f64::consts::TAU * modes.below_hz).powi(2);
    let seats = joints
        .iter()
        .map(WhirlJoint::seat)
        .collect::<Result<Vec<_>, _>>()?;
    let n_functions = body.n_functions();
    let rows = seat_rows(joints, &modes, n_rigid);
    let held = match first.modes(&modes).on_shaft {
        Some(shaft) => Some(HeldOscillators::new(shaft, &modes.squares[n_rigid..])?),
        None => None,
    };
    let (squares, rows) = match &held {
        Some(held) => (held.squares.clone(), held.combined(&rows, n_functions)),
        None => (modes.squares.clone(), rows),
    };
    let n_swinging = squares.iter().take_while(|square| **square <= most).count();
    let (swinging, above) = rows.split_at(n_swinging * n_functions);
    let on_shaft = held.map(|held| held.on_shaft(first, &modes, above, n_swinging));
    let mut flexibility_above = body.flexibility.clone();
    add_products(
        swinging,
        &squares[..n_swinging],
        |square| -1.0 / square,
        &mut flexibility_above,
    );
    let mut mass_above = vec![0.0; n_functions * n_functions];
    add_products(
        above,
        &squares[n_swinging..],
        |square| square.powi(-2),
        &mut mass_above,
    );
    Ok(WhirlBody {
        on_shaft: on_shaft.transpose()?,
        squares: squares[..n_swinging].to_vec(),
        rows: swinging.to_vec(),
        n_functions,
        flexibility_beside: flexibility_beside(&seats, &body.flexibility, &flexibility_above),
        flexibility_above,
        seats,
        mass_above,
    })
}

/// What bearings have of the flexibility of their own seats, less that of the oscillators above.
fn flexibility_beside(seats: &[WhirlSeat], whole: &[f64], above: &[f64]) -> Vec<f64> {
    let n = whole.len().isqrt();
    let mut beside: Vec<f64> = above.iter().map(|f| -f).collect();
    for own in seats.iter().map(|seat| seat.functions.clone()) {
        for i in own.clone() {
            let row = n * i + own.start..n * i + own.end;
            let sums = beside[row.clone()].iter_mut();
            sums.zip(&whole[row]).for_each(|(sum, f)| *sum += f);
        }
    }
    beside
}

/// Adds the sum over oscillators of y y^T times a weight of their squares.
fn add_products(rows: &[f64], squares: &[f64], weight: impl Fn(f64) -> f64, to: &mut [f64]) {
    let m = to.len().isqrt();
    let weighted: Vec<f64> = rows
        .chunks_exact(m)
        .zip(squares)
        .flat_map(|(row, square)| {
            let weight = weight(*square);
            row.iter().map(move |y| weight * y)
        })
        .collect();
    // The rows of one by the columns of the other.
    let columns: Vec<f64> = (0..m)
        .flat_map(|i| weighted.iter().skip(i).step_by(m))
        .copied()
        .collect();
    let products = linear_combinations(m, rows, squares.len(), &columns, m);
    to.iter_mut().zip(products).for_each(|(sum, x)| *sum += x);
}

/// Motion of all functions under the elastic oscillators, of a body on the shaft beside that.
fn seat_rows(joints: &[WhirlJoint<'_>], modes: &Arc<BodyModes>, n_rigid: usize) -> Vec<f64> {
    let m = joints[0].body.n_functions();
    let mut rows = vec![0.0; m * (modes.n() - n_rigid)];
    for joint in joints {
        let seat = joint.modes(modes);
        let own = joint.tie.own();
        for (k, (row, to)) in seat
            .rows()
            .skip(n_rigid)
            .zip(rows.chunks_exact_mut(m))
            .enumerate()
        {
            to[own.clone()].copy_from_slice(row);
            let along = seat.on_shaft.as_ref().map(|shaft| shaft.rows[n_rigid + k]);
            if let Some(with_shaft) = along.and_then(|q| joint.tie.shaft_motion(q)) {
                let own = to[own.clone()].iter_mut();
                own.zip(with_shaft).for_each(|(y, r)| *y -= r);
            }
        }
    }
    rows
}

/// The elastic oscillators of a body on a shaft that stands, by those of the body that flies.
struct HeldOscillators {
    shaft: ShaftAtSeat,
    of_motion: [[f64; N_SHAFT]; N_SHAFT],
    /// Squares of their angular frequencies, ascending.
    squares: Vec<f64>,
    /// Their shares of the flying ones, `[held][flying]` flat.
    shares: Vec<f64>,
}

impl HeldOscillators {
    fn new(shaft: ShaftAtSeat, flying: &[f64]) -> Result<HeldOscillators, AssemblyError> {
        let mut of_motion = [[0.0; N_SHAFT]; N_SHAFT];
        for motion in 0..N_SHAFT {
            let (mut unit, mut rigid) = ([0.0; N_SHAFT], [0.0; N_SHAFT]);
            unit[motion] = 1.0;
            shaft.add_motion(unit, &mut rigid);
            (0..N_SHAFT).for_each(|r| of_motion[r][motion] = rigid[r]);
        }
        let n = flying.len();
        let kept: Vec<[f64; N_SHAFT]> = shaft.rows[N_SHAFT..]
            .iter()
            .map(|q| applied(&of_motion, q))
            .collect();
        // (1 + A^T A) in coordinates of unit stiffness: its eigenvalues are 1/omega^2.
        let roots: Vec<f64> = flying.iter().map(|square| square.sqrt()).collect();
        let entry = |k: usize| {
            let (i, j) = (k / n, k % n);
            let product: f64 = kept[i].iter().zip(&kept[j]).map(|(a, b)| a * b).sum();
            (product + if i == j { 1.0 } else { 0.0 }) / (roots[i] * roots[j])
        };
        let matrix: Vec<f64> = (0..n * n).map(entry).collect();
        let (values, vectors) =
            dense::symmetric_eigen(n, &matrix).map_err(|source| AssemblyError::Matrix { source })?;
        let columns = vectors.chunks_exact(n).zip(&values).rev();
        let share = |(vector, value): (&[f64], &f64)| -> Vec<f64> {
            let pairs = vector.iter().zip(&roots);
            pairs.map(|(y, root)| y / (root * value.sqrt())).collect()
        };
        Ok(HeldOscillators {
            shaft,
            of_motion,
            squares: values.iter().rev().map(|value| value.recip()).collect(),
            shares: columns.flat_map(share).collect(),
        })
    }

    /// Rows of `width` of the flying oscillators, of these.
    fn combined(&self, rows: &[f64], width: usize) -> Vec<f64> {
        let n = self.squares.len();
        linear_combinations(width, rows, n, &self.shares, n)
    }

    /// The body on its shaft, with the seat rows of the oscillators above.
    fn on_shaft(
        self,
        first: &WhirlJoint<'_>,
        modes: &BodyModes,
        above: &[f64],
        n_swinging: usize,
    ) -> Result<BodyOnShaft, AssemblyError> {
        let along = self.combined(self.shaft.rows[N_SHAFT..].as_flattened(), N_SHAFT);
        let kept: Vec<[f64; N_SHAFT]> = along
            .as_chunks::<N_SHAFT>()
            .0
            .iter()
            .map(|q| applied(&self.of_motion, q))
            .collect();
        let m = first.body.n_functions();
        let mut kept_above = vec![0.0; N_SHAFT * m];
        let highest = kept[n_swinging..].iter().zip(&self.squares[n_swinging..]);
        for ((kept, square), row) in highest.zip(above.chunks_exact(m)) {
            for (to, kept) in kept_above.chunks_exact_mut(m).zip(kept) {
                to.iter_mut()
                    .zip(row)
                    .for_each(|(sum, y)| *sum += kept * y / square);
            }
        }
        // All oscillators of the flying body by rigid ones and those that swing.
        let n = self.squares.len();
        let mut combinations = vec![0.0; (N_SHAFT + n_swinging) * (N_SHAFT + n)];
        for (i, row) in combinations.chunks_exact_mut(N_SHAFT + n).enumerate() {
            match i.checked_sub(N_SHAFT) {
                None => row[i] = 1.0,
                Some(i) => {
                    (0..N_SHAFT).for_each(|r| row[r] = -kept[i][r]);
                    row[N_SHAFT..].copy_from_slice(&self.shares[n * i..n * (i + 1)]);
                }
            }
        }
        let of = |matrix: &[f64]| in_terms(matrix, &combinations, N_SHAFT + n_swinging);
        let gyroscopic = first.body.gyroscopic(modes, N_SHAFT + n);
        let gyroscopic = gyroscopic.map_err(|source| first.fails(RingError::Body { source }))?;
        let [across, radial] = modes.frame.as_ref().map_or([const { Vec::new() }; 2], |frame| {
            frame.of_first(N_SHAFT + n).map(|matrix| of(&matrix))
        });
        Ok(BodyOnShaft {
            bearing: first.bearing,
            way: self.shaft.way,
            of_motion: self.of_motion,
            kept: kept[..n_swinging].to_vec(),
            kept_above,
            gyroscopic: of(&gyroscopic),
            radial,
            across,
            mass: first.tie.carried().map_or(0.0, |carried| carried.inertia.mass),
        })
    }
}

/// C A C^T of a matrix A and combinations C by `m` rows, all row-major.
fn in_terms(matrix: &[f64], combinations: &[f64], m: usize) -> Vec<f64> {
    let n = combinations.len() / m;
    // By columns: A C^T, then C A C^T.
    let moved = inner_products(n, matrix, n, combinations, m);
    let by_columns = inner_products(n, combinations, m, &moved, m);
    (0..m * m).map(|k| by_columns[m * (k % m) + k / m]).collect()
}

impl WhirlJoint<'_> {
    fn fails(&self, source: RingError) -> AssemblyError {
        AssemblyError::of_bearing(self.name)(DynamicsError::from(source))
    }

    /// The oscillators as its seat sees them.
    fn modes(&self, modes: &Arc<BodyModes>) -> SeatModes {
        let tie = SeatTie::clone(self.tie).in_motion(modes.clone());
        tie.modes.expect("a joint in motion has oscillators")
    }

    fn seat(&self) -> Result<WhirlSeat, AssemblyError> {
        let inertia = ring_inertia(self.model, self.side);
        let inertia = inertia.map_err(AssemblyError::of_bearing(self.name))?;
        Ok(WhirlSeat {
            bearing: self.bearing,
            side: self.side,
            functions: self.tie.own(),
            inertia: inertia.unwrap_or_default(),
            mean: self.mean_motion()?,
        })
    }

    /// Mean motion of the ring by functions of its seat.
    fn mean_motion(&self) -> Result<Vec<f64>, AssemblyError> {
        let ring = self.model.tied(self.side).expect("a joint has a ring");
        let functions = ring.seat_functions(self.side.name());
        let functions: SeatFunctions = functions
            .map_err(|source| self.fails(source))?
            .expect("a tied ring has functions");
        let (n, origin) = (functions.n(), ring.groove.centre_z);
        let rigid = |[x, y, z]: [f64; 3], motion: usize| {
            let z = z - origin;
            let of_motion = [
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [0.0, -z, y],
                [z, 0.0, -x],
                [-y, x, 0.0],
            ];
            of_motion[motion]
        };
        let measured = |motion: usize| {
            let field: Vec<f64> = ring.mesh.nodes.iter().flat_map(|x| rigid(*x, motion)).collect();
            functions.measure(&field)
        };
        let motions: Vec<Vec<f64>> = (0..N_MEAN).map(measured).collect();
        let weighted: Vec<Vec<f64>> = motions.iter().map(|b| functions.integrals(b)).collect();
        let product = |k: usize| -> f64 {
            let pairs = motions[k / N_MEAN].iter().zip(&weighted[k % N_MEAN]);
            pairs.map(|(a, b)| a * b).sum()
        };
        let squares: Vec<f64> = (0..N_MEAN * N_MEAN).map(product).collect();
        let factor = DenseCholesky::factor(N_MEAN, &squares);
        let factor = factor.map_err(|source| AssemblyError::Matrix { source })?;
        let mut mean = vec![0.0; N_MEAN * n];
        for function in 0..n {
            let mut own: Vec<f64> = weighted.iter().map(|row| row[function]).collect();
            factor.solve(&mut own, 1);
            (0..N_MEAN).for_each(|k| mean[n * k + function] = own[k]);
        }
        Ok(mean)
    }
}
