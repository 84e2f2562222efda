//! What is kept of a shaft on bearings with elastic bodies, with the masses of what follows it.
//!
//! Masses of all parts are squares of motions over what is kept ([`crate::whirl_in_bodies`]).

use dense::linear_combinations;
use dynamics::condensation::Condensation;
use dynamics::stiffness::N_SHAFT;
use dynamics::whirl::{ShaftForms, ShaftRow, TurningShaft, WhirlMatrices};
use ring::rigid::RigidInertia;

use crate::whirl_bodies::{BodyOnShaft, N_MEAN, WhirlBody, WhirlSeat};
use crate::whirl_rows::{RowPlaces, WhirlBearing, WhirlShaft};

/// A row over all that is kept.
type KeptRow = Vec<f64>;

/// What is kept, with masses.
pub struct KeptRows<'p> {
    places: &'p RowPlaces,
    n: usize,
    stiffness: Vec<f64>,
    rates: Vec<f64>,
    /// Mass of balls.
    balls: Vec<f64>,
    forms: ShaftForms,
    speed: f64,
}

impl<'p> KeptRows<'p> {
    pub fn new(
        shaft: &WhirlShaft,
        places: &'p RowPlaces,
        [stiffness, rates]: [&[f64]; 2],
        condensation: &Condensation,
    ) -> KeptRows<'p> {
        let (n, n_shaft) = (places.n_kept, places.n_shaft);
        let none = || vec![0.0; n * n];
        let mut kept = KeptRows {
            places,
            n,
            stiffness: condensation.apply(stiffness),
            rates: condensation.apply(rates),
            balls: none(),
            forms: ShaftForms {
                mass: none(),
                axial: none(),
                radial: none(),
                across: none(),
                standing: none(),
            },
            speed: shaft.speed,
        };
        let own = &shaft.matrices.mass;
        for (row, own) in kept.forms.mass.chunks_exact_mut(n).zip(own.chunks_exact(n_shaft)) {
            row[..n_shaft].copy_from_slice(own);
        }
        let unit = |i: usize| unit_row(n, i);
        for node in (0..n_shaft).step_by(N_SHAFT) {
            let mass = |dof: usize| own[(n_shaft + 1) * (node + dof)];
            kept.add_round([unit(node), unit(node + 1)], (mass(0), 1.0));
            kept.add_round([unit(node + 3), unit(node + 4)], (mass(3), 1.0));
            add_square(n, mass(2), &[unit(node + 2)], &mut kept.forms.axial);
        }
        kept
    }

    /// A motion across z that goes round, with its mass and 1, or -1 where y is turned.
    fn add_round(&mut self, [x, y]: [KeptRow; 2], (mass, way): (f64, f64)) {
        let n = self.n;
        add_square(n, mass, &[x.clone(), y.clone()], &mut self.forms.radial);
        add_product(n, way * mass, (&y, &x), &mut self.forms.across);
        add_product(n, -way * mass, (&x, &y), &mut self.forms.across);
    }

    /// Adds the mass of the balls, and of a ring on the shaft itself.
    pub fn add_bearing(&mut self, b: usize, bearing: &WhirlBearing<'_>) {
        let first = self.places.balls[b];
        for i in first..first + 2 * bearing.model.geometry.n_balls {
            self.balls[(self.n + 1) * i] = bearing.model.ball_mass();
        }
        if let Some(inertia) = &bearing.ring {
            self.add_turning(inertia, self.place(bearing), bearing.way);
        }
    }

    /// Motion of the place of a bearing.
    fn place(&self, bearing: &WhirlBearing<'_>) -> [KeptRow; N_SHAFT] {
        bearing.motion.map(|own| {
            let mut row = vec![0.0; self.n];
            row[bearing.first..bearing.first + N_SHAFT].copy_from_slice(&own);
            row
        })
    }

    /// Adds a rigid ring that turns with the shaft, of such motions.
    fn add_turning(&mut self, inertia: &RigidInertia, motion: [KeptRow; N_SHAFT], way: f64) {
        let n = self.n;
        add_inertia(n, inertia, &motion, &mut self.forms.mass);
        let moment = way * self.speed * inertia.polar;
        add_product(n, moment, (&motion[3], &motion[4]), &mut self.rates);
        add_product(n, -moment, (&motion[4], &motion[3]), &mut self.rates);
        let [x, y, z, tilt_x, tilt_y] = motion;
        self.add_round([x, y], (inertia.mass, way));
        self.add_round([tilt_x, tilt_y], (inertia.transverse, way));
        add_square(n, inertia.mass, &[z], &mut self.forms.axial);
    }

    /// Adds the masses of a body and of the rings in it; `forces` are those on its functions by all that is kept.
    pub fn add_body(
        &mut self,
        body: &WhirlBody,
        (number, forces): (usize, &[f64]),
        bearings: &[WhirlBearing<'_>],
    ) {
        let (n, m, first) = (self.n, body.n_functions, self.places.oscillators[number]);
        let swinging: Vec<KeptRow> = (0..body.squares.len()).map(|k| unit_row(n, first + k)).collect();
        // The oscillators above by their forces.
        let weighted = linear_combinations(n, forces, m, &body.mass_above, m);
        let mut own = vec![0.0; n * n];
        for (p, w) in forces.chunks_exact(n).zip(weighted.chunks_exact(n)) {
            add_product(n, 1.0, (p, w), &mut own);
        }
        add_square(n, 1.0, &swinging, &mut own);
        if let Some(on_shaft) = &body.on_shaft {
            let bearing = &bearings[on_shaft.bearing];
            let rigid = of_motion(on_shaft, self.place(bearing));
            let left = kept_rows(n, on_shaft, first, forces);
            add_square(n, 1.0, &rigid, &mut own);
            for (rigid, left) in rigid.iter().zip(&left) {
                add_product(n, -1.0, (rigid, left), &mut own);
                add_product(n, -1.0, (left, rigid), &mut own);
            }
            self.add_momentum(on_shaft, &rigid, &left);
            self.add_on_shaft(on_shaft, [rigid, swinging].concat(), bearing.way * on_shaft.way);
        }
        let to = match body.on_shaft {
            Some(_) => &mut self.forms.mass,
            None => &mut self.forms.standing,
        };
        to.iter_mut().zip(own).for_each(|(sum, x)| *sum += x);
        // Motion of all functions.
        let mut seats = linear_combinations(n, forces, m, &body.flexibility_above, m);
        for (row, y) in body.rows.chunks_exact(m).enumerate() {
            y.iter()
                .enumerate()
                .for_each(|(f, y)| seats[n * f + first + row] += y);
        }
        for seat in &body.seats {
            let bearing = &bearings[seat.bearing];
            let [x, y, z, tilt_x, tilt_y, turn] = mean_motion(n, seat, &seats);
            let mut motion = [x, y, z, tilt_x, tilt_y];
            match body.on_shaft {
                Some(_) => {
                    // Beside the shaft, whose turning is given.
                    add_square(n, seat.inertia.polar, &[turn], &mut self.forms.mass);
                    for (row, with_shaft) in motion.iter_mut().zip(self.place(bearing)) {
                        row.iter_mut().zip(with_shaft).for_each(|(sum, x)| *sum += x);
                    }
                    self.add_turning(&seat.inertia, motion, bearing.way);
                }
                None => {
                    add_square(n, seat.inertia.polar, &[turn], &mut self.forms.standing);
                    add_inertia(n, &seat.inertia, &motion, &mut self.forms.standing);
                }
            }
        }
    }

    /// Adds what a body on the shaft does by turning, of its rigid oscillators and those that swing.
    fn add_on_shaft(&mut self, body: &BodyOnShaft, rows: Vec<KeptRow>, way: f64) {
        let (n, m) = (self.n, rows.len());
        for (i, x) in rows.iter().enumerate() {
            let mut turned = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
            let factors = [way * self.speed, 1.0, way];
            for (j, y) in rows.iter().enumerate() {
                let matrices = [&body.gyroscopic, &body.radial, &body.across];
                for ((sum, matrix), factor) in turned.iter_mut().zip(matrices).zip(factors) {
                    let entry = factor * matrix[m * i + j];
                    sum.iter_mut().zip(y).for_each(|(sum, y)| *sum += entry * y);
                }
            }
            let [gyroscopic, radial, across] = turned;
            add_product(n, 1.0, (x, &gyroscopic), &mut self.rates);
            add_product(n, 1.0, (x, &radial), &mut self.forms.radial);
            add_product(n, 1.0, (x, &across), &mut self.forms.across);
        }
    }

    /// Adds the motion of a body along z as a whole: only rigid oscillators have momentum.
    fn add_momentum(&mut self, body: &BodyOnShaft, rigid: &[KeptRow], left: &[KeptRow]) {
        let mut momentum = vec![0.0; self.n];
        for ((rigid, left), of_motion) in rigid.iter().zip(left).zip(&body.of_motion) {
            let pairs = momentum.iter_mut().zip(rigid.iter().zip(left));
            pairs.for_each(|(sum, (rigid, left))| *sum += of_motion[2] * (rigid - left));
        }
        add_square(self.n, 1.0 / body.mass, &[momentum], &mut self.forms.axial);
    }

    /// The equations of all that may move.
    pub fn equations(self, shaft: &WhirlShaft, held: &[usize]) -> TurningShaft {
        let beyond = self.places.n_shaft..self.n;
        let free: Vec<usize> = shaft.free.iter().copied().chain(beyond).collect();
        let rows: Vec<usize> = free.into_iter().filter(|row| !held.contains(row)).collect();
        let masses = self.balls.iter().zip(&self.forms.mass).zip(&self.forms.standing);
        let whole = WhirlMatrices {
            n: self.n,
            mass: masses.map(|((a, b), c)| a + b + c).collect(),
            rates: self.rates,
            stiffness: self.stiffness,
        };
        let row = |&i: &usize| ShaftRow {
            node: i / N_SHAFT,
            dof: i % N_SHAFT,
        };
        let of_shaft = shaft.free.iter().map(row).collect();
        let forms = self.forms.of_rows(self.n, &rows);
        TurningShaft::of_matrices(whole.of_rows(&rows), of_shaft, self.speed).with_forms(forms)
    }
}

/// Q^-1 q of a body on the shaft whose place moves so.
fn of_motion(body: &BodyOnShaft, place: [KeptRow; N_SHAFT]) -> Vec<KeptRow> {
    let rigid = |of_motion: &[f64; N_SHAFT]| {
        let mut sum = vec![0.0; place[0].len()];
        for (a, row) in of_motion.iter().zip(&place) {
            sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += a * x);
        }
        sum
    };
    body.of_motion.iter().map(rigid).collect()
}

/// A z of a body on the shaft, of which the first oscillator that swings has a row and those above follow forces.
fn kept_rows(n: usize, body: &BodyOnShaft, first: usize, forces: &[f64]) -> Vec<KeptRow> {
    let m = forces.len() / n;
    let mut rows = vec![vec![0.0; n]; N_SHAFT];
    for (row, above) in rows.iter_mut().zip(body.kept_above.chunks_exact(m)) {
        for (a, p) in above.iter().zip(forces.chunks_exact(n)) {
            row.iter_mut().zip(p).for_each(|(row, p)| *row += a * p);
        }
    }
    for (k, kept) in body.kept.iter().enumerate() {
        rows.iter_mut().zip(kept).for_each(|(row, a)| row[first + k] += a);
    }
    rows
}

/// Mean motion of the ring in a seat, of the motion of all functions of its body.
fn mean_motion(n: usize, seat: &WhirlSeat, functions: &[f64]) -> [KeptRow; N_MEAN] {
    let own = &functions[n * seat.functions.start..n * seat.functions.end];
    let width = seat.functions.len();
    std::array::from_fn(|k| {
        let mut sum = vec![0.0; n];
        for (a, row) in seat.mean[width * k..width * (k + 1)]
            .iter()
            .zip(own.chunks_exact(n))
        {
            sum.iter_mut().zip(row).for_each(|(sum, y)| *sum += a * y);
        }
        sum
    })
}

fn unit_row(n: usize, i: usize) -> KeptRow {
    let mut row = vec![0.0; n];
    row[i] = 1.0;
    row
}

/// Adds a factor times x y^T.
fn add_product(n: usize, factor: f64, (x, y): (&[f64], &[f64]), to: &mut [f64]) {
    for (row, x) in to.chunks_exact_mut(n).zip(x).filter(|(_, x)| **x != 0.0) {
        row.iter_mut().zip(y).for_each(|(sum, y)| *sum += factor * x * y);
    }
}

/// Adds a mass times the squares of motions.
fn add_square(n: usize, mass: f64, rows: &[KeptRow], to: &mut [f64]) {
    rows.iter().for_each(|row| add_product(n, mass, (row, row), to));
}

/// Adds a rigid inertia of such motions.
fn add_inertia(n: usize, inertia: &RigidInertia, motion: &[KeptRow; N_SHAFT], to: &mut [f64]) {
    for (j, moved) in motion.iter().enumerate() {
        let mut unit = [0.0; N_SHAFT];
        unit[j] = 1.0;
        for (row, entry) in motion.iter().zip(inertia.times(unit)) {
            add_product(n, entry, (row, moved), to);
        }
    }
}
