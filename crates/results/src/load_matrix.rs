//! Load matrix: what strain gauges read under a unit load of each ball, and ball loads from what they read.
//!
//! ```text
//! e = e_0 + M Q,   M[g][b] = strain of gauge g under 1 N of ball b on the ring, along its contact's normal
//! Q = (M^T M)^-1 M^T (e - e_0)
//! ```
//!
//! M is that of the ring's finite elements and of the patches and contact angles of one equilibrium; e_0 is what the
//! gauges read there besides, by fits, temperatures and loads on the ring. Under other loads contact angles and patches
//! differ, and M with them. The condition of M, the largest over the smallest singular value, says by how much errors
//! of the signals may grow.
//!
//! Cost: one solve of the ring per ball, n^3 for the inverse.

use std::path::Path;

use anyhow::{Context, anyhow, ensure};
use comm::print::counted;
use contact::Side;
use dense::DenseCholesky;
use dynamics::{Model, StaticSolution, StaticSolver};
use serde::{Deserialize, Serialize};

use crate::gauges::Gauges;
use crate::whole::write_new;

/// The matrix for the program.
pub const MATRIX_FILE: &str = "load_matrix.json";
/// The matrix for people.
pub const MATRIX_TABLE: &str = "load_matrix.csv";
/// Version of the keys.
const SCHEMA: u32 = 1;
/// Condition above which gauges do not tell balls apart: signals have some four digits.
const WORST_CONDITION: f64 = 1e4;
/// How near a ball must stand to a place of the matrix, rad: far below a patch, far above round-off.
const SAME_PLACE: f64 = 1e-6;

/// A load matrix, its gauges and the places of its balls.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
pub struct LoadMatrix {
    schema: u32,
    /// `inner` or `outer`.
    pub ring: String,
    /// Names of the gauges.
    pub gauges: Vec<String>,
    /// Azimuths of the balls in the frame of the ring, rad.
    pub ball_azimuths_rad: Vec<f64>,
    /// Contact angles of the balls, rad.
    pub contact_angles_rad: Vec<f64>,
    /// Strain without ball loads, `[n_gauges]`.
    pub offset: Vec<f64>,
    /// Strain per load, 1/N, `[n_gauges][n_balls]`.
    pub strain_per_n: Vec<Vec<f64>>,
    /// Largest over smallest singular value; absent where there are fewer gauges than balls.
    pub condition: Option<f64>,
}

impl LoadMatrix {
    /// The matrix at an equilibrium; `read` are the gauges' strains there, of all gauges of the scene.
    pub fn new(
        model: &Model,
        solver: &StaticSolver,
        solution: &StaticSolution,
        gauges: &Gauges,
        read: &[f64],
        side: Side,
    ) -> anyhow::Result<LoadMatrix> {
        let ring = solver.ring(side).expect("gauges are on flexible rings");
        let own: Vec<usize> = gauges.on(side).collect();
        let mut strain_per_n = vec![Vec::new(); own.len()];
        let mut offset: Vec<f64> = own.iter().map(|&g| read[g]).collect();
        let (mut azimuths, mut angles) = (Vec::new(), Vec::new());
        for (foot, ball) in solution.footprints(side).iter().zip(&solution.balls) {
            let contact = ball.contact(side);
            let (sin, cos) = contact.contact_angle_rad.sin_cos();
            let mut load = vec![0.0; ring.solver.n_dofs()];
            foot.weights
                .add_load([side.sign() * cos, side.sign() * sin], &mut load);
            let field = ring.solver.solve(load, 1);
            for (row, &g) in own.iter().enumerate() {
                let strain = gauges.strain(g, &field);
                offset[row] -= strain * contact.force_n;
                strain_per_n[row].push(strain);
            }
            azimuths.push(ball.azimuth_rad - solution.pose.frame_angle(side));
            angles.push(contact.contact_angle_rad);
        }
        ensure!(
            azimuths.len() == model.geometry.n_balls,
            "a load matrix needs contact by patches; the {} ring has none",
            side.name()
        );
        Ok(LoadMatrix {
            schema: SCHEMA,
            ring: side.name().to_string(),
            gauges: own.iter().map(|&g| gauges.name(g).to_string()).collect(),
            condition: condition(&strain_per_n)?,
            ball_azimuths_rad: azimuths,
            contact_angles_rad: angles,
            offset,
            strain_per_n,
        })
    }

    /// Writes both files into a folder; nothing is replaced.
    pub fn write(&self, dir: &Path) -> anyhow::Result<()> {
        let json = serde_json::to_string_pretty(self)? + "\n";
        write_new(&dir.join(MATRIX_FILE), |file| file.write_all(json.as_bytes()))?;
        let balls: String = (0..self.ball_azimuths_rad.len())
            .map(|b| format!(",ball_{b}_per_n"))
            .collect();
        let mut table = format!("gauge,offset{balls}\n");
        for ((name, offset), row) in self.gauges.iter().zip(&self.offset).zip(&self.strain_per_n) {
            let cells: String = row.iter().map(|x| format!(",{x:?}")).collect();
            table += &format!("{name},{offset:?}{cells}\n");
        }
        write_new(&dir.join(MATRIX_TABLE), |file| file.write_all(table.as_bytes()))
    }

    /// Reads a file that the program wrote.
    pub fn read(path: &Path) -> anyhow::Result<LoadMatrix> {
        let text =
            std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        let found: LoadMatrix = serde_json::from_str(&text).with_context(|| {
            format!(
                "{} is no load matrix; expected the {MATRIX_FILE} of raceway load-matrix",
                path.display()
            )
        })?;
        ensure!(
            found.schema == SCHEMA,
            "{} has schema {}; this program reads {SCHEMA}",
            path.display(),
            found.schema
        );
        let n_balls = found.ball_azimuths_rad.len();
        let is_whole = found.strain_per_n.len() == found.gauges.len()
            && found.offset.len() == found.gauges.len()
            && found.strain_per_n.iter().all(|row| row.len() == n_balls);
        ensure!(
            is_whole,
            "{} has rows of different lengths; write it again",
            path.display()
        );
        Ok(found)
    }

    /// The inverse; fails where the gauges do not tell the balls apart.
    pub fn inverse(&self) -> anyhow::Result<LoadInverse> {
        let (n, m) = (self.ball_azimuths_rad.len(), self.gauges.len());
        ensure!(
            m >= n,
            "{} on the {} ring {} not tell the loads of {n} balls apart; expected one gauge per ball at least",
            counted(m, "gauge"),
            self.ring,
            if m == 1 { "does" } else { "do" }
        );
        let condition = self.condition.unwrap_or(f64::INFINITY);
        ensure!(
            condition <= WORST_CONDITION,
            "the gauges on the {} ring do not tell the loads of the balls apart: the condition of their load matrix is \
             {condition:.1e}, expected {WORST_CONDITION:.0e} at most; put a gauge near each ball",
            self.ring
        );
        let factor = DenseCholesky::factor(n, &normal_matrix(&self.strain_per_n))?;
        Ok(LoadInverse {
            matrix: self.clone(),
            factor,
        })
    }

    /// By ball of the run the place of the matrix at which it stands; None where one stands at none.
    pub fn places(&self, azimuths: &[f64]) -> Option<Vec<usize>> {
        let near = |azimuth: &f64| {
            self.ball_azimuths_rad.iter().position(|place| {
                let off = azimuth - place;
                (off - std::f64::consts::TAU * (off / std::f64::consts::TAU).round()).abs() < SAME_PLACE
            })
        };
        let places: Vec<usize> = azimuths.iter().map(near).collect::<Option<_>>()?;
        (places.len() == self.ball_azimuths_rad.len()).then_some(places)
    }
}

/// A load matrix that is ready to give ball loads.
pub struct LoadInverse {
    matrix: LoadMatrix,
    factor: DenseCholesky,
}

impl LoadInverse {
    /// Loads at the places of the matrix, N, from the strains of its gauges.
    pub fn loads(&self, strains: &[f64]) -> Vec<f64> {
        let rows = &self.matrix.strain_per_n;
        let mut loads = vec![0.0; self.matrix.ball_azimuths_rad.len()];
        for ((row, strain), offset) in rows.iter().zip(strains).zip(&self.matrix.offset) {
            for (sum, m) in loads.iter_mut().zip(row) {
                *sum += m * (strain - offset);
            }
        }
        self.factor.solve(&mut loads, 1);
        loads
    }
}

/// M^T M, row-major.
fn normal_matrix(rows: &[Vec<f64>]) -> Vec<f64> {
    let n = rows.first().map_or(0, Vec::len);
    let mut product = vec![0.0; n * n];
    for row in rows {
        for i in 0..n {
            for j in 0..n {
                product[n * i + j] += row[i] * row[j];
            }
        }
    }
    product
}

fn condition(rows: &[Vec<f64>]) -> anyhow::Result<Option<f64>> {
    let n = rows.first().map_or(0, Vec::len);
    if rows.len() < n || n == 0 {
        return Ok(None);
    }
    let (values, _) = dense::symmetric_eigen(n, &normal_matrix(rows))
        .map_err(|error| anyhow!("cannot find the singular values of the load matrix: {error}"))?;
    let (low, high) = values
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(*v), h.max(*v)));
    // Squares of singular values are known to round-off of the largest one.
    Ok(Some((high / low.max(f64::EPSILON * high)).sqrt()))
}
