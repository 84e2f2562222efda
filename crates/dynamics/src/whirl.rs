//! Modes of a shaft that turns on its bearing: forward and backward, with damping.
//!
//! ```text
//! M x'' + (C + G) x' + K x = 0,      x: free dofs of the shaft, then [radial, axial] of each ball
//! ```
//!
//! K and C are those of the equilibrium at that speed ([`crate::stiffness`]), with what loads on the shaft add. M is
//! that of the shaft, its inertia about the axis point in the plane of the inner groove centres, of a flexible inner
//! ring as a rigid body, and of the balls. Of a spin W with the polar inertia I_p of all that turns,
//!
//! ```text
//! moment about x:  I t_x'' + I_p W t_y' ...          moment about y:  I t_y'' - I_p W t_x' ...
//! ```
//!
//! as in motion ([`crate::model::ShaftInertia`]; e.g. Genta, Dynamics of Rotating Systems, ch. 2).
//!
//! **Left out.** Rings yield without inertia of their own: a frequency f is off by the order of (f/f_r)^2 of the share
//! of the rings in the compliance, with f_r the first mode of a ring as it is held (`tests/whirl.rs` has numbers).
//! Balls stand at their azimuths while they vibrate, unless the linearisation has them going round
//! ([`Linearisation::going_round`]). With two balls or a radial load the matrices change as balls pass; this is one
//! place of them. The seat of the outer ring follows without mass.
//!
//! **Whirl.** With X and Y the amplitudes of a pair, (X + iY)/2 goes round from x to y, (X - iY)/2 the other way. The
//! kinetic energy of the first less that of the second, over their sum, is 1 of a circle along the spin, -1 of one
//! against it.

use contact::Side;
use dense::{ComplexNumber, ComplexPair, general_eigen};
use ring::rigid::RigidInertia;
use ring::{BodySettings, Frame, elastic_body};

use crate::bearing::partner;
use crate::bodies::AXES;
use crate::error::DynamicsError;
use crate::model::{Model, ShaftDof};
use crate::stiffness::{Linearisation, N_SHAFT};

/// Whirl below which a motion counts as in one plane: round-off of bearings that are alike in x and y is below 1e-9.
const PLANAR: f64 = 1e-6;
/// Share of the motion along z in the kinetic energy of the shaft above which a mode is axial.
const AXIAL: f64 = 0.5;

/// Share of the motion across z in the kinetic energy of the shaft up to which it is none.
const ACROSS: f64 = 1e-12;

/// |Im|/|lambda| up to which an eigenvalue counts as real.
///
/// Round-off splits m equal real eigenvalues that share one vector by eps^(1/m) |lambda|: 2e-8 of two, as at critical
/// damping, 1e-4 of four. Balls that creep back while they go round have multiples of the cage's speed for a frequency.
/// What swings less than this dies by e^(-20 pi) in one turn: nobody sees it swing.
const REAL: f64 = 0.1;

/// How the shaft goes round in a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whirl {
    /// Along its spin.
    Forward,
    /// Against it.
    Backward,
    /// In one plane, or without a spin.
    Planar,
    /// Along the axis.
    Axial,
}

impl Whirl {
    /// Its word in tables.
    pub fn name(self) -> &'static str {
        match self {
            Whirl::Forward => "forward",
            Whirl::Backward => "backward",
            Whirl::Planar => "planar",
            Whirl::Axial => "axial",
        }
    }
}

/// A mode at speed.
#[derive(Clone, Debug, PartialEq)]
pub struct WhirlMode {
    /// Frequency with which it swings, Hz; 0 if it does not.
    pub frequency: f64,
    /// Decay over the size of the eigenvalue: -Re/|lambda|; negative of a mode that grows.
    pub damping_ratio: f64,
    /// How the shaft goes round.
    pub whirl: Whirl,
    /// From -1, a circle against the spin, to 1, one along it.
    pub roundness: f64,
    /// Share of the shaft in the kinetic energy, with bodies and rings on it.
    pub shaft_share: f64,
    /// The same of what stands and yields, such as housings with their rings.
    pub standing_share: f64,
}

impl WhirlMode {
    /// Whether it swings by more than motions do that creep back, such as those of overdamped balls that go round.
    pub fn swings(&self) -> bool {
        // The damping ratio is the cosine of the angle whose sine is |Im|/|lambda|.
        self.frequency > 0.0 && 1.0 - self.damping_ratio.powi(2) > REAL * REAL
    }
}

/// Rigid inertia of the shaft of a bearing and of a rigid ring on it.
pub fn shaft_inertia(model: &Model) -> RigidInertia {
    RigidInertia {
        mass: model.shaft_mass,
        first_moment: 0.0,
        transverse: model.shaft_inertia.transverse,
        polar: model.shaft_inertia.polar,
    }
}

/// Rigid inertia of a flexible ring about its place; None of a rigid one.
pub fn ring_inertia(model: &Model, side: Side) -> Result<Option<RigidInertia>, DynamicsError> {
    let Some(ring) = model.ring(side) else {
        return Ok(None);
    };
    let settings = BodySettings {
        partner: partner(model, side),
        damping: [0.0; 2],
        backend: model.backend,
        frame: Frame::Still,
    };
    // Of a body in which it sits nothing is asked for.
    let own = match ring.tie {
        Some(_) => elastic_body(side.name(), &ring.untied(), settings)?,
        None => elastic_body(side.name(), ring, settings)?,
    };
    Ok(Some(own.rigid_inertia()))
}

/// Rigid inertia of all that turns with the shaft: of the shaft, a rigid ring on it, and a flexible inner ring.
pub fn turning_inertia(model: &Model) -> Result<RigidInertia, DynamicsError> {
    let mut sum = shaft_inertia(model);
    if let Some(ring) = ring_inertia(model, Side::Inner)? {
        sum = sum.with(ring);
        if let Some(carried) = model.carried_inertia() {
            sum = sum.with(carried);
        }
    }
    Ok(sum)
}

/// The equations of a shaft that turns with `speed`, rad/s.
pub struct TurningShaft {
    n: usize,
    mass: Vec<f64>,
    /// Damping and gyroscopic terms.
    rates: Vec<f64>,
    stiffness: Vec<f64>,
    /// The first rows: free dofs of the shaft.
    shaft: Vec<ShaftRow>,
    /// What moves with the shaft beyond its rows; None where its rows are all.
    forms: Option<ShaftForms>,
    speed: f64,
}

/// Forms over all rows of a shaft that is more than its own rows, row-major.
pub struct ShaftForms {
    /// Mass of all that moves with the shaft.
    pub mass: Vec<f64>,
    /// Mass of its motion along z as a whole.
    pub axial: Vec<f64>,
    /// Mass of its motion across z, and of tilts.
    pub radial: Vec<f64>,
    /// The same between a motion and another that is turned by 90 deg about z, from x to y.
    pub across: Vec<f64>,
    /// Mass of what stands and yields.
    pub standing: Vec<f64>,
}

impl ShaftForms {
    /// Those of the given rows of `n` alone.
    pub fn of_rows(&self, n: usize, rows: &[usize]) -> ShaftForms {
        ShaftForms {
            mass: of_rows(n, &self.mass, rows),
            axial: of_rows(n, &self.axial, rows),
            radial: of_rows(n, &self.radial, rows),
            across: of_rows(n, &self.across, rows),
            standing: of_rows(n, &self.standing, rows),
        }
    }
}

/// Rows and columns of a matrix of `n` rows.
fn of_rows(n: usize, matrix: &[f64], rows: &[usize]) -> Vec<f64> {
    let row = |i: &usize| rows.iter().map(|j| matrix[n * i + j]).collect::<Vec<_>>();
    rows.iter().flat_map(row).collect()
}

/// x^T A y.
fn form(matrix: &[f64], x: &[f64], y: &[f64]) -> f64 {
    let rows = matrix.chunks_exact(y.len().max(1)).zip(x);
    rows.map(|(row, x)| x * row.iter().zip(y).map(|(a, y)| a * y).sum::<f64>())
        .sum()
}

/// A row of the shaft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaftRow {
    /// Its place on the shaft; a rigid shaft has one.
    pub node: usize,
    /// Its dof there, of x, y, z, tilt x, tilt y.
    pub dof: usize,
}

/// Mass, damping with gyroscopic terms, and stiffness, row-major with `n` rows.
pub struct WhirlMatrices {
    /// Number of rows.
    pub n: usize,
    /// Mass.
    pub mass: Vec<f64>,
    /// Damping and gyroscopic terms.
    pub rates: Vec<f64>,
    /// Stiffness.
    pub stiffness: Vec<f64>,
}

impl WhirlMatrices {
    /// The matrices of the given rows alone; all others are held.
    pub fn of_rows(&self, rows: &[usize]) -> WhirlMatrices {
        let pick = |matrix: &[f64]| of_rows(self.n, matrix, rows);
        WhirlMatrices {
            n: rows.len(),
            mass: pick(&self.mass),
            rates: pick(&self.rates),
            stiffness: pick(&self.stiffness),
        }
    }
}

impl TurningShaft {
    /// Of a linearised bearing under what turns with the shaft. Fails where a free dof of the shaft has no inertia.
    pub fn new(
        model: &Model,
        bearing: &Linearisation,
        inertia: RigidInertia,
        speed: f64,
    ) -> Result<TurningShaft, DynamicsError> {
        let free: Vec<usize> = (0..N_SHAFT)
            .filter(|&dof| model.shaft[dof] == ShaftDof::Free)
            .collect();
        require_inertia(&free, inertia)?;
        let all = bearing.of_shaft_and_balls()?;
        let rows: Vec<usize> = free
            .iter()
            .copied()
            .chain((N_SHAFT..all.n).filter(|&i| all.is_held(i)))
            .collect();
        let mut stiffness = all.stiffness.clone();
        let (mut mass, mut rates) = (vec![0.0; all.n * all.n], vec![0.0; all.n * all.n]);
        if let Some(damping) = &all.damping {
            rates.copy_from_slice(damping);
        }
        for j in 0..N_SHAFT {
            let mut unit = [0.0; N_SHAFT];
            unit[j] = 1.0;
            let column = inertia.times(unit);
            for i in 0..N_SHAFT {
                stiffness[all.n * i + j] += bearing.load_stiffness[i][j];
                mass[all.n * i + j] = column[i];
            }
        }
        (N_SHAFT..all.n).for_each(|i| mass[(all.n + 1) * i] = model.ball_mass());
        rates[all.n * 3 + 4] += inertia.polar * speed;
        rates[all.n * 4 + 3] -= inertia.polar * speed;
        let whole = WhirlMatrices {
            n: all.n,
            mass,
            rates,
            stiffness,
        };
        let shaft = free.iter().map(|&dof| ShaftRow { node: 0, dof }).collect();
        Ok(TurningShaft::of_matrices(whole.of_rows(&rows), shaft, speed))
    }

    /// Of matrices whose first rows are those of a shaft that turns with `speed`, rad/s, which is in the matrices.
    pub fn of_matrices(matrices: WhirlMatrices, shaft: Vec<ShaftRow>, speed: f64) -> TurningShaft {
        TurningShaft {
            n: matrices.n,
            mass: matrices.mass,
            rates: matrices.rates,
            stiffness: matrices.stiffness,
            shaft,
            forms: None,
            speed,
        }
    }

    /// The same with what moves with the shaft beyond its rows.
    pub fn with_forms(self, forms: ShaftForms) -> TurningShaft {
        TurningShaft {
            forms: Some(forms),
            ..self
        }
    }

    /// A free dof of the shaft without mass.
    pub fn without_mass(&self) -> Option<ShaftRow> {
        let rows = self.shaft.iter().enumerate();
        let mut lacking = rows.filter(|(i, _)| self.mass[(self.n + 1) * i] <= 0.0);
        lacking.next().map(|(_, row)| *row)
    }

    /// The modes, from the lowest frequency. They are the pairs of the inverse of the equations of first order, in
    /// which the lowest modes are the largest and lose no digits beside those of the balls.
    pub fn modes(&self) -> Result<Vec<WhirlMode>, DynamicsError> {
        let n = self.n;
        let failed = |source| DynamicsError::Modes { source };
        let inverse = dense::DenseLu::factor(n, &self.stiffness)
            .map_err(failed)?
            .inverse();
        let product = |a: &[f64]| -> Vec<f64> {
            let entry = |k: usize| (0..n).map(|l| inverse[n * (k / n) + l] * a[n * l + k % n]).sum();
            (0..n * n).map(entry).collect()
        };
        let (mass, rates) = (product(&self.mass), product(&self.rates));
        // Lengths by the roots of the masses and times by the slowest motion, so that entries are of one size.
        let scale: Vec<f64> = (0..n).map(|i| self.mass[(n + 1) * i].sqrt()).collect();
        let largest = (0..n).map(|i| mass[(n + 1) * i].abs());
        let slowest = 1.0 / largest.fold(f64::MIN_POSITIVE, f64::max).sqrt();
        let mut matrix = vec![0.0; 4 * n * n];
        for i in 0..n {
            matrix[2 * n * (n + i) + i] = 1.0;
            for j in 0..n {
                let (ratio, row) = (scale[i] / scale[j], 2 * n * i);
                matrix[row + j] = -ratio * slowest * rates[n * i + j];
                matrix[row + n + j] = -ratio * slowest * slowest * mass[n * i + j];
            }
        }
        let pairs = general_eigen(2 * n, &matrix).map_err(failed)?;
        let mut modes: Vec<WhirlMode> = pairs
            .into_iter()
            .map(|pair| self.mode(&pair, slowest, &scale))
            .collect();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        Ok(modes)
    }

    /// The mode of a pair of the inverse, with 1/lambda of which the conjugate is taken: value and vector.
    fn mode(&self, pair: &ComplexPair, slowest: f64, scale: &[f64]) -> WhirlMode {
        let n = self.n;
        let place = |i: usize| [pair.vector[i][0] / scale[i], -pair.vector[i][1] / scale[i]];
        let x: Vec<ComplexNumber> = (0..n).map(place).collect();
        let energy = |rows: std::ops::Range<usize>| -> f64 {
            let of = |i: usize| -> f64 {
                (0..n)
                    .map(|j| self.mass[n * i + j] * (x[i][0] * x[j][0] + x[i][1] * x[j][1]))
                    .sum()
            };
            rows.map(of).sum()
        };
        let square = pair.value.iter().map(|part| part * part).sum::<f64>();
        let [re, im] = pair
            .value
            .map(|part| slowest * part / square.max(f64::MIN_POSITIVE));
        let parts = [0, 1].map(|part| x.iter().map(|x| x[part]).collect::<Vec<f64>>());
        let of = |matrix: &[f64]| parts.iter().map(|x| form(matrix, x, x)).sum::<f64>();
        let (of_shaft, axial, standing, roundness) = match &self.forms {
            Some(forms) => {
                let around = 2.0 * form(&forms.across, &parts[0], &parts[1]);
                let of_shaft = of(&forms.mass);
                let roundness = self.along(around, of(&forms.radial), of_shaft);
                (of_shaft, of(&forms.axial), of(&forms.standing), roundness)
            }
            None => {
                let axial = (0..self.shaft.len()).filter(|&i| self.shaft[i].dof == 2);
                let axial: f64 = axial.map(|i| energy(i..i + 1)).sum();
                let of_shaft = energy(0..self.shaft.len());
                (of_shaft, axial, 0.0, self.roundness(&x, of_shaft))
            }
        };
        let all = energy(0..n).max(f64::MIN_POSITIVE);
        WhirlMode {
            frequency: im / std::f64::consts::TAU,
            damping_ratio: 0.0 - re / re.hypot(im).max(f64::MIN_POSITIVE),
            whirl: match roundness {
                _ if axial > AXIAL * of_shaft => Whirl::Axial,
                r if r > PLANAR => Whirl::Forward,
                r if r < -PLANAR => Whirl::Backward,
                _ => Whirl::Planar,
            },
            roundness,
            shaft_share: of_shaft / all,
            standing_share: standing / all,
        }
    }

    /// The roundness by the rows of the shaft, which has this kinetic energy.
    fn roundness(&self, x: &[ComplexNumber], of_shaft: f64) -> f64 {
        let (mut along, mut against) = (0.0, 0.0);
        for [first, second] in [[0, 1], [3, 4]] {
            for (i, row) in self.shaft.iter().enumerate().filter(|(_, row)| row.dof == first) {
                let other = ShaftRow { dof: second, ..*row };
                let Some(k) = self.shaft.iter().position(|row| *row == other) else {
                    continue;
                };
                let mass = self.mass[(self.n + 1) * i];
                let ([a, b], [c, d]) = (x[i], x[k]);
                // |X + iY|^2 and |X - iY|^2.
                along += mass * ((a - d).powi(2) + (b + c).powi(2));
                against += mass * ((a + d).powi(2) + (b - c).powi(2));
            }
        }
        // Twice the energies.
        self.along(along - against, along + against, 2.0 * of_shaft)
    }

    /// Energy that goes round along the spin less that against it, from x to y, over their sum; 0 without a spin, and
    /// where what goes across is round-off of the whole.
    fn along(&self, difference: f64, sum: f64, whole: f64) -> f64 {
        if self.speed == 0.0 || sum <= ACROSS * whole {
            return 0.0;
        }
        self.speed.signum() * difference / sum
    }
}

fn require_inertia(free: &[usize], inertia: RigidInertia) -> Result<(), DynamicsError> {
    let lacking = free.iter().find(|&&dof| match dof {
        0..3 => inertia.mass <= 0.0,
        _ => inertia.transverse <= 0.0,
    });
    lacking.map_or(Ok(()), |&dof| {
        Err(DynamicsError::NoInertia {
            dof: AXES[dof],
            key: if dof < 3 {
                "shaft.mass"
            } else {
                "shaft.transverse_inertia"
            },
        })
    })
}
