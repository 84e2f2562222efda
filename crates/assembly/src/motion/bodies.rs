//! Bodies that carry several bearings, over a part of a step.
//!
//! Every bearing moves the whole body, its own seat by the forces lam of its joint, and the oscillators besides by the
//! mean loads of the other bearings. A round hands these on. At given forces on the contacts, and a given motion of the
//! shaft, all joints together are a linear system: with A the compliance of a ring at its seat and D that of the body
//! between two seats, over the part,
//!
//! ```text
//! A_s lam_s + sum over seats D_st lam_t = gap_s
//! ```
//!
//! A bearing has solved its own row with the forces of the others that it was told. What these have changed since,
//! c_t, asks for a correction d of all:
//!
//! ```text
//! A_s d_s + sum over seats D_st d_t = -sum over others D_st c_t
//! ```
//!
//! So a round leaves only what the contacts answer to the corrections: over a step the inertia of rings holds most of
//! that back. Contacts feel the others through the seat alone, which they move by -D_st lam_t. So rounds of a body that
//! stands move seats, and when these rest the loads go on the oscillators. What the ledger of a bearing says of its
//! body includes what the others do to it, as imposed work.

use body::lane_dot;
use dense::DenseCholesky;
use dynamics::motion::held::{HeldPart, Holding};

use crate::error::AssemblyError;
use crate::housing::HousedTogether;
use crate::mixing::dot;

/// Change of the forces over their size at which they stay as they are. The ledger of each bearing closes with any
/// loads; what is left makes the copies of a body differ.
const LIMIT: f64 = 1e-10;
/// The same where rounds no longer contract.
const FLOOR: f64 = 1e-8;
/// A round that leaves more than this of the change before it no longer contracts.
const STALLED: f64 = 0.5;
/// Columns of a product that are added in one pass.
const COLUMNS: usize = 4;

/// The joints of a body with all rings that it carries, over parts of one size.
pub struct BodyJoints {
    /// Size of the parts, s.
    dt: f64,
    /// (A + D)^-1 times D between different seats, over the functions of all, column-major, then columns of zeros; of
    /// single precision: what it leaves of a change, the next round takes.
    answers: Vec<f32>,
    /// D_st, `[n_s][n_t]` flat, by the bearings s < t; it is D_ts transposed.
    softness: Vec<(usize, usize, Vec<f64>)>,
    /// Whether a shaft carries the body.
    on_shaft: bool,
}

/// Loads on the oscillators of shared bodies.
pub struct SharedLoads<'a> {
    bodies: Vec<SharedLoad<'a>>,
}

/// Loads on one body.
struct SharedLoad<'a> {
    housed: &'a HousedTogether,
    joints: BodyJoints,
    /// Forces of the joint of each seat that the others were told, N; empty before the first round.
    told: Vec<Vec<f64>>,
    /// Last change over the size.
    change: f64,
    /// Whether seats have moved by forces that are not yet on the oscillators.
    is_ahead: bool,
}

impl BodyJoints {
    /// Of a body over the parts that have begun.
    fn new(housed: &HousedTogether, parts: &[HeldPart<'_>]) -> Result<BodyJoints, AssemblyError> {
        let HousedTogether { side, bearings, .. } = housed;
        let (mut softness, mut own) = (Vec::new(), Vec::new());
        for &i in bearings {
            let factor = parts[i].factor(*side);
            let factor = factor.map_err(AssemblyError::of_bearing(&housed.name))?;
            let factor = factor.expect("a ring in a body is flexible");
            let bodies = bearings.iter().filter_map(|&t| parts[t].body(*side));
            let row = bodies.filter_map(|body| factor.body_compliance(&body.modes));
            softness.push(row.collect::<Vec<_>>());
            own.push(factor.seat_compliance().unwrap_or_default());
        }
        let sizes: Vec<usize> = own.iter().map(|a: &&[f64]| a.len().isqrt()).collect();
        let n: usize = sizes.iter().sum();
        // Both are symmetric, so rows are columns.
        let (mut joints, mut between) = (Vec::with_capacity(n * n), Vec::with_capacity(n * n));
        for (s, (row, a)) in softness.iter().zip(&own).enumerate() {
            for i in 0..sizes[s] {
                for (t, d) in row.iter().enumerate() {
                    let d = &d[sizes[t] * i..sizes[t] * (i + 1)];
                    if t == s {
                        let a = &a[sizes[s] * i..sizes[s] * (i + 1)];
                        joints.extend(d.iter().zip(a).map(|(d, a)| d + a));
                        between.extend(std::iter::repeat_n(0.0, sizes[s]));
                    } else {
                        joints.extend_from_slice(d);
                        between.extend_from_slice(d);
                    }
                }
            }
        }
        let joints = DenseCholesky::factor(n, &joints);
        let joints = joints.map_err(|source| AssemblyError::Matrix { source })?;
        joints.solve(&mut between, n);
        let mut answers: Vec<f32> = between.into_iter().map(|answer| answer as f32).collect();
        answers.resize(n * n.next_multiple_of(COLUMNS), 0.0);
        let rows = softness.into_iter().enumerate();
        let pairs = rows.flat_map(|(s, row)| {
            let pairs = row.into_iter().enumerate().skip(s + 1);
            pairs.map(move |(t, d)| (s, t, d))
        });
        Ok(BodyJoints {
            dt: parts[0].dt(),
            answers,
            softness: pairs.collect(),
            on_shaft: parts[bearings[0]]
                .body(*side)
                .is_some_and(|body| body.on_shaft().is_some()),
        })
    }

    /// What changes of the forces that others feel ask of all joints, N, over the functions of all seats.
    fn correction(&self, changes: &[f64]) -> Vec<f32> {
        let n = changes.len();
        let mut correction = vec![0.0; n];
        let columns = self.answers.chunks_exact((COLUMNS * n).max(1));
        for (columns, changes) in columns.zip(changes.chunks(COLUMNS)) {
            let by = |k: usize| changes.get(k).map_or(0.0, |change| *change as f32);
            let by = [by(0), by(1), by(2), by(3)];
            let column = |k: usize| &columns[n * k..n * (k + 1)];
            let [a, b, c, d] = [column(0), column(1), column(2), column(3)];
            for (i, lam) in correction.iter_mut().enumerate() {
                *lam -= (by[0] * a[i] + by[1] * b[i]) + (by[2] * c[i] + by[3] * d[i]);
            }
        }
        correction
    }

    /// Motion of each seat by the forces of the joints of the others, m.
    fn motions(&self, forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut motions: Vec<Vec<f64>> = forces.iter().map(|lam| vec![0.0; lam.len()]).collect();
        for (s, t, softness) in &self.softness {
            let (before, from) = motions.split_at_mut(*t);
            let (of_s, of_t) = (&mut before[*s], &mut from[0]);
            let rows = softness.chunks_exact(of_t.len().max(1)).zip(&forces[*s]);
            for ((row, force), y) in rows.zip(of_s) {
                *y -= lane_dot(row, &forces[*t]);
                of_t.iter_mut().zip(row).for_each(|(y, d)| *y -= force * d);
            }
        }
        motions
    }
}

impl<'a> SharedLoads<'a> {
    /// Loads of the bearings in each body, none yet; `kept` are joints of earlier parts.
    pub fn new(
        housed: &'a [HousedTogether],
        parts: &[HeldPart<'_>],
        kept: Vec<BodyJoints>,
    ) -> Result<SharedLoads<'a>, AssemblyError> {
        let mut kept = kept.into_iter();
        let body = |housed: &'a HousedTogether| {
            let joints = kept.next().filter(|joints| joints.dt == parts[0].dt());
            Ok(SharedLoad {
                housed,
                joints: joints.map_or_else(|| BodyJoints::new(housed, parts), Ok)?,
                told: Vec::new(),
                change: f64::INFINITY,
                is_ahead: false,
            })
        };
        let bodies = housed.iter().map(body).collect::<Result<_, AssemblyError>>()?;
        Ok(SharedLoads { bodies })
    }

    /// Hands on the loads that are expected before the first answers. A body on the shaft has none: what the shaft does
    /// to it is not known yet.
    pub fn expect(&mut self, parts: &mut [HeldPart<'_>]) {
        for body in &mut self.bodies {
            if !body.joints.on_shaft {
                body.exchange(parts);
                body.change = f64::INFINITY;
            }
        }
    }

    /// The joints, for the next part.
    pub fn into_joints(self) -> Vec<BodyJoints> {
        self.bodies.into_iter().map(|body| body.joints).collect()
    }

    /// Name of the body whose loads changed most in the last exchange, and their change over their size.
    pub fn worst(&self) -> Option<(&str, f64)> {
        let changes = self
            .bodies
            .iter()
            .map(|body| (&body.housed.name[..], body.change));
        changes.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Hands on the loads of the last answers; settled if no bearing is told anything new.
    pub fn exchange(&mut self, parts: &mut [HeldPart<'_>]) -> Holding {
        let mut holding = Holding::Settled;
        for body in &mut self.bodies {
            if body.exchange(parts) == Holding::Again {
                holding = Holding::Again;
            }
        }
        holding
    }
}

impl SharedLoad<'_> {
    fn exchange(&mut self, parts: &mut [HeldPart<'_>]) -> Holding {
        let HousedTogether { side, bearings, .. } = self.housed;
        let answers = bearings.iter().map(|&i| parts[i].forces_of_joint(*side));
        let mut found: Vec<Vec<f64>> = answers.map(Option::unwrap_or_default).collect();
        if self.told.is_empty() {
            self.told = found.iter().map(|lam| vec![0.0; lam.len()]).collect();
        }
        let pairs = found.iter().flatten().zip(self.told.iter().flatten());
        let changes: Vec<f64> = pairs.map(|(found, told)| found - told).collect();
        let size = found.iter().map(|lam| dot(lam, lam)).sum::<f64>().sqrt();
        let change = dot(&changes, &changes).sqrt() / size.max(f64::MIN_POSITIVE);
        let stalls = change > STALLED * self.change && change <= FLOOR;
        if change <= LIMIT || stalls {
            // What changes after this is new, such as turning frames: earlier rounds say nothing of it.
            self.change = f64::INFINITY;
            if std::mem::take(&mut self.is_ahead) {
                self.load(parts);
            }
            return Holding::Settled;
        }
        self.change = change;
        let corrections = self.joints.correction(&changes);
        let corrected = found.iter_mut().flatten().zip(corrections);
        corrected.for_each(|(lam, correction)| *lam += f64::from(correction));
        self.told = found;
        match self.joints.on_shaft {
            true => self.load(parts),
            false => self.move_seats(parts),
        }
        Holding::Again
    }

    /// Moves the seat of each bearing by what the joints of the others do to it.
    fn move_seats(&mut self, parts: &mut [HeldPart<'_>]) {
        let HousedTogether { side, bearings, .. } = self.housed;
        for (&i, motion) in bearings.iter().zip(self.joints.motions(&self.told)) {
            parts[i].move_seat(*side, &motion);
        }
        self.is_ahead = true;
    }

    /// Puts the loads of the joints of the others on the body of each bearing.
    fn load(&self, parts: &mut [HeldPart<'_>]) {
        let HousedTogether { side, bearings, .. } = self.housed;
        let pairs = bearings.iter().zip(&self.told);
        let loads: Vec<Vec<f64>> = pairs.map(|(&i, lam)| parts[i].load_on_body(*side, lam)).collect();
        for (number, &i) in bearings.iter().enumerate() {
            let of_others = |k: usize| -> f64 {
                let others = (0..bearings.len()).filter(|other| *other != number);
                others.map(|other| loads[other][k]).sum()
            };
            parts[i].load_body(*side, (0..loads[number].len()).map(of_others).collect());
        }
    }
}
