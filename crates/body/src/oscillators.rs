//! A moving body as a list of oscillators ([`crate::vibration`]), and what its seats and its shaft see of them.

use std::ops::Range;
use std::sync::Arc;

use crate::carried::{N_SHAFT, ShaftPlace, combined, dot};
use crate::frame::FrameForms;
use crate::loads::ModalLoads;
use crate::rows::{add_rows, lane_dot};

/// A body as oscillators.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyModes {
    /// Squares of their angular frequencies, rad^2/s^2, ascending.
    pub squares: Vec<f64>,
    /// Motion of the seat functions, m per unit of an oscillator (m kg^1/2), `[n_oscillators][n_functions]` flat.
    pub seat: Vec<f64>,
    /// Oscillators in which the body stands under static forces, per N, `[n_oscillators][n_functions]` flat.
    pub of_forces: Vec<f64>,
    /// Frequency up to which modes with held seats are kept, Hz.
    pub below_hz: f64,
    /// How many these are.
    pub n_fixed: usize,
    /// Static forces on the seats, N per unit, `[n_oscillators][n_functions]` flat.
    pub(crate) forces: Vec<f64>,
    /// Shares of the modes with held seats, `[n_oscillators][n_fixed]` flat.
    pub(crate) shares: Vec<f64>,
    /// These modes on the free dofs, column-major.
    pub(crate) fixed: Vec<f64>,
    /// Of a body that a shaft carries.
    pub(crate) on_shaft: Option<ShaftShares>,
    /// Inertia of the turning frame of such a body.
    pub frame: Option<Box<FrameForms>>,
    /// Loads on all of the body, where a scene asks for any.
    pub(crate) loads: Option<Box<ModalLoads>>,
}

/// How oscillators move the shaft that carries their body, at the bearing of its first seat. The first [`N_SHAFT`] are
/// rigid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ShaftShares {
    /// Motion of the shaft per unit of an oscillator, m and rad.
    pub(crate) rows: Vec<[f64; N_SHAFT]>,
    /// Rigid oscillators of the body that moves with the shaft: by unit motions of it, `[rigid][motion]`.
    pub(crate) of_motion: [[f64; N_SHAFT]; N_SHAFT],
    /// Static forces on the functions of all seats that unit accelerations of the rigid oscillators ask for, N,
    /// `[rigid][n_functions]` flat.
    pub(crate) reactions: Vec<f64>,
}

/// The shaft at the bearing of a seat.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftAtSeat {
    /// 1, or -1 where the bearing stands turned by 180 deg about x in the frame of the body: the sign of its speed.
    pub way: f64,
    /// Motion of the shaft there per unit of an oscillator, m and rad.
    pub rows: Vec<[f64; N_SHAFT]>,
    /// Rigid oscillators of the body that moves with it: by unit motions there, `[rigid][motion]`.
    of_motion: [[f64; N_SHAFT]; N_SHAFT],
}

impl ShaftAtSeat {
    /// The shaft at a place on it.
    pub(crate) fn new(shares: &ShaftShares, place: &ShaftPlace) -> ShaftAtSeat {
        let unit = |k: usize| {
            let mut q = [0.0; N_SHAFT];
            q[k] = 1.0;
            place.here(q)
        };
        let of_motion = |row: &[f64; N_SHAFT]| [0, 1, 2, 3, 4].map(|k| dot(row, &unit(k)));
        ShaftAtSeat {
            way: if place.is_turned { -1.0 } else { 1.0 },
            rows: shares.rows.iter().map(|row| place.there(*row)).collect(),
            of_motion: shares.of_motion.each_ref().map(of_motion),
        }
    }

    /// Motion of the shaft under oscillators, m and rad.
    pub fn motion(&self, oscillators: &[f64]) -> [f64; N_SHAFT] {
        shaft_motion(&self.rows, oscillators)
    }

    /// Force and moment about the origin of the tilts there, N and N m, of loads on the rigid oscillators.
    pub fn resultant(&self, loads: &[f64]) -> [f64; N_SHAFT] {
        shaft_motion(&self.of_motion, loads)
    }

    /// Adds the oscillators of a motion or velocity with the shaft.
    pub fn add_motion(&self, q: [f64; N_SHAFT], oscillators: &mut [f64]) {
        for (x, row) in oscillators.iter_mut().zip(&self.of_motion) {
            *x += dot(row, &q);
        }
    }
}

/// Motion of the shaft under oscillators by its rows.
pub fn shaft_motion(rows: &[[f64; N_SHAFT]], oscillators: &[f64]) -> [f64; N_SHAFT] {
    let mut q = [0.0; N_SHAFT];
    for (row, x) in rows.iter().zip(oscillators) {
        (0..N_SHAFT).for_each(|k| q[k] += row[k] * x);
    }
    q
}

impl BodyModes {
    /// A rigid body: no oscillators.
    pub fn rigid() -> BodyModes {
        BodyModes {
            squares: Vec::new(),
            seat: Vec::new(),
            of_forces: Vec::new(),
            below_hz: f64::INFINITY,
            n_fixed: 0,
            forces: Vec::new(),
            shares: Vec::new(),
            fixed: Vec::new(),
            on_shaft: None,
            frame: None,
            loads: None,
        }
    }

    /// Number of oscillators.
    pub fn n(&self) -> usize {
        self.squares.len()
    }

    /// Motion of the shaft by an oscillator; none of a body that stands.
    pub(crate) fn shaft_row(&self, oscillator: usize) -> [f64; N_SHAFT] {
        self.on_shaft
            .as_ref()
            .map_or([0.0; N_SHAFT], |shares| shares.rows[oscillator])
    }

    /// Motion of the functions of all seats under oscillators, m.
    pub fn seat_motion(&self, oscillators: &[f64]) -> Vec<f64> {
        combined(&self.seat, oscillators)
    }

    /// Oscillators in which the body stands under forces on the functions of all seats, N.
    pub fn at_rest(&self, forces: &[f64]) -> Vec<f64> {
        let rows = self.of_forces.chunks_exact(forces.len().max(1));
        rows.map(|row| dot(row, forces)).collect()
    }

    /// Forces on the functions of all seats of a body on a shaft, N, by which its oscillators move so: `driven` are
    /// minus accelerations and damping of rigid ones, and of the others minus what they would stand for at rest.
    pub fn forces_on_shaft(&self, driven: &[f64]) -> Vec<f64> {
        let mut forces = combined(&self.forces, driven);
        if let Some(shares) = &self.on_shaft {
            let of_rigid = combined(&shares.reactions, &driven[..N_SHAFT]);
            forces.iter_mut().zip(of_rigid).for_each(|(f, r)| *f += r);
        }
        forces
    }

    /// Bytes of all.
    pub fn bytes(&self) -> usize {
        let lists = [
            &self.squares,
            &self.seat,
            &self.of_forces,
            &self.forces,
            &self.shares,
            &self.fixed,
        ];
        let frame = self.frame.as_ref().map_or(0, |frame| frame.bytes());
        let loads = self.loads.as_ref().map_or(0, |loads| loads.bytes());
        frame + loads + size_of::<f64>() * lists.iter().map(|list| list.len()).sum::<usize>()
    }
}

/// The oscillators of a body as one of its seats sees them.
#[derive(Clone, Debug, PartialEq)]
pub struct SeatModes {
    /// The body.
    pub of_body: Arc<BodyModes>,
    /// Numbers of the functions of the seat among those of all seats.
    pub own: Range<usize>,
    /// The shaft that carries the body; None of one that stands.
    pub on_shaft: Option<ShaftAtSeat>,
}

impl SeatModes {
    /// A rigid body: no oscillators.
    pub fn rigid() -> SeatModes {
        SeatModes {
            of_body: Arc::new(BodyModes::rigid()),
            own: 0..0,
            on_shaft: None,
        }
    }

    /// Number of oscillators.
    pub fn n(&self) -> usize {
        self.of_body.n()
    }

    /// Squares of their angular frequencies, rad^2/s^2.
    pub fn squares(&self) -> &[f64] {
        &self.of_body.squares
    }

    /// Motion of the functions of the seat, m per unit of each oscillator.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.n()).map(|i| self.row(i))
    }

    fn row(&self, i: usize) -> &[f64] {
        let seat = &self.of_body.seat;
        let width = seat.len() / self.n();
        &seat[width * i..][self.own.clone()]
    }

    /// Motion of the functions of the seat under oscillators, m; of a rigid body none.
    pub fn motion(&self, oscillators: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.own.len()];
        add_rows(&mut sum, |i| self.row(i), &oscillators[..self.n()]);
        sum
    }

    /// Forces on the oscillators of forces lam on the functions of the seat, N.
    pub fn loads(&self, lam: &[f64]) -> Vec<f64> {
        self.rows().map(|row| lane_dot(row, lam)).collect()
    }

    /// V diag(1/s) W^T of the functions of the seat and of those of another on the same body, W, for effective masses s
    /// of the oscillators, `[n_functions][n_others]` flat; empty for a rigid body.
    pub fn softness(&self, other: &SeatModes, effective: &[f64]) -> Vec<f64> {
        let [n, n_others] = [self, other].map(|seat| seat.own.len());
        let mut softness = vec![0.0; n * n_others];
        for ((row, s), by_other) in self.rows().zip(effective).zip(other.rows()) {
            for (to, v) in softness.chunks_exact_mut(n_others).zip(row) {
                let by = v / s;
                to.iter_mut().zip(by_other).for_each(|(d, w)| *d += by * w);
            }
        }
        softness
    }
}
