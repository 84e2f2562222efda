//! Unilateral contact of a ball with both raceways of a bearing under thrust, pressure by pressure.
//!
//! A cell presses or is open, and its mean gap is that of the displaced bodies:
//! ```text
//! gap = mean of |x - c| - r  +  motion of the ring away  +  motion of the ball inwards  >= 0,   force >= 0
//! ```
//! with x on the raceway, moved by the shaft on the inner side, and c the centre of the ball. The forces of all cells
//! on the ball are in equilibrium in its meridian plane, and those on the inner ring carry the load. Newton's method,
//! with the cells that press found on the way (Hueber and Wohlmuth, Comput. Methods Appl. Mech. Eng. 194 (2005) 3147).

use std::ops::Range;

use contact::{BearingGeometry, Side};
use dense::DenseLu;

use super::half_sector::{Cell, Raceway};
use super::sphere::Sphere;

/// Rounds of the search: 10 to 12 are usual.
const MOST_ROUNDS: usize = 100;

/// Equilibrium under thrust.
#[derive(Debug)]
pub struct Found {
    /// Motion of the shaft along the axis, m.
    pub shaft: f64,
    /// Force of a ball on the outer ring, N, and its angle, rad.
    pub force: f64,
    pub angle: f64,
    /// Cells that press, inner first.
    pub pressing: [usize; 2],
}

/// Gap of a cell and how it grows with [radius of the ball, its place along the axis, motion of the shaft].
struct Gap {
    value: f64,
    slopes: [f64; 3],
}

fn gap(cell: &Cell, side: Side, offset: f64, place: [f64; 3], radius: f64) -> Gap {
    let shaft = if side == Side::Inner { place[2] } else { 0.0 };
    let mut gap = Gap {
        value: -radius,
        slopes: [0.0; 3],
    };
    for (x, share) in &cell.points {
        let arm = [x[0] - place[0], x[1], x[2] + offset + shaft - place[1]];
        let size = arm.iter().map(|c| c * c).sum::<f64>().sqrt();
        gap.value += share * size;
        gap.slopes[0] -= share * arm[0] / size;
        gap.slopes[1] -= share * arm[2] / size;
        if side == Side::Inner {
            gap.slopes[2] += share * arm[2] / size;
        }
    }
    gap
}

/// What all cells yield, m/N: both rings and the ball, `[n][n]` flat, inner cells first.
fn compliance(raceways: &[Raceway; 2], sphere: &Sphere, offsets: [f64; 2]) -> Vec<f64> {
    let sizes = [0, 1].map(|k| raceways[k].cells.len());
    let n = sizes[0] + sizes[1];
    let mut all = vec![0.0; n * n];
    let cells: Vec<(usize, &Cell)> = raceways
        .iter()
        .enumerate()
        .flat_map(|(k, raceway)| raceway.cells.iter().map(move |cell| (k, cell)))
        .collect();
    for (i, (side, at)) in cells.iter().enumerate() {
        for (j, (other, load)) in cells.iter().enumerate() {
            all[i * n + j] = if side == other {
                let first = if *side == 0 { 0 } else { sizes[0] };
                let ring = &raceways[*side];
                let own: f64 = load
                    .flat
                    .iter()
                    .map(|flat| sphere.between(&at.flat[0], flat))
                    .sum();
                own + ring.compliance[(i - first) * sizes[*side] + j - first]
            } else {
                let across = load.flat.iter().map(|flat| {
                    let arm = [0, 1, 2].map(|c| at.flat[0].centre[c] - flat.centre[c]);
                    let arm = [arm[0], arm[1], arm[2] + offsets[*side] - offsets[*other]];
                    let chord = arm.iter().map(|c| c * c).sum::<f64>().sqrt();
                    sphere.across(chord)
                });
                across.sum()
            };
        }
    }
    // The mean over the loaded cell and over the moved one are those of the same pairs of points.
    let turned = all.clone();
    (0..n * n).for_each(|k| all[k] = 0.5 * (turned[k] + turned[k % n * n + k / n]));
    all
}

/// Forces of the cells that press, N, and moves of ball and shaft, m, that close their gaps and carry half the load of
/// a ball, N.
fn forces_and_moves(yields: &[f64], gaps: &[Gap], presses: &[bool], half_load: f64) -> (Vec<f64>, [f64; 3]) {
    let n = gaps.len();
    let active: Vec<usize> = (0..n).filter(|&i| presses[i]).collect();
    let (m, size) = (active.len(), active.len() + 3);
    // In um and N.
    let (mut matrix, mut rhs) = (vec![0.0; size * size], vec![0.0; size]);
    for (row, &i) in active.iter().enumerate() {
        for (column, &j) in active.iter().enumerate() {
            matrix[row * size + column] = 1e6 * yields[i * n + j];
        }
        for k in 0..3 {
            matrix[row * size + m + k] = gaps[i].slopes[k];
            matrix[(m + k) * size + row] = gaps[i].slopes[k];
        }
        rhs[row] = -1e6 * gaps[i].value;
    }
    rhs[m + 2] = -half_load;
    DenseLu::factor(size, &matrix).unwrap().solve(&mut rhs, 1);
    let mut forces = vec![0.0; n];
    active.iter().zip(&rhs).for_each(|(&i, f)| forces[i] = *f);
    (forces, [0, 1, 2].map(|k| 1e-6 * rhs[m + k]))
}

/// Equilibrium under a thrust, N, from the elastic bodies alone.
pub fn solve(geometry: &BearingGeometry, raceways: &[Raceway; 2], sphere: &Sphere, thrust: f64) -> Found {
    let offsets = Side::BOTH.map(|side| geometry.groove_centre(side).axial);
    let n_inner = raceways[0].cells.len();
    let n = n_inner + raceways[1].cells.len();
    let yields = compliance(raceways, sphere, offsets);
    let half_load = 0.5 * thrust / geometry.n_balls as f64;
    let radius = 0.5 * geometry.ball_diameter;
    let [r, z] = geometry.ball_centre().to_array();
    let mut place = [r + 1e-6, z + 15e-6, 30e-6];
    let mut presses = vec![true; n];
    for _ in 0..MOST_ROUNDS {
        let gap_of = |i: usize| {
            let side = usize::from(i >= n_inner);
            let cell = &raceways[side].cells[i - side * n_inner];
            gap(cell, Side::BOTH[side], offsets[side], place, radius)
        };
        let gaps: Vec<Gap> = (0..n).map(gap_of).collect();
        let (forces, moves) = forces_and_moves(&yields, &gaps, &presses, half_load);
        let open = |i: usize| {
            let moved: f64 = (0..3).map(|k| gaps[i].slopes[k] * moves[k]).sum();
            let yielded: f64 = (0..n).map(|j| yields[i * n + j] * forces[j]).sum();
            gaps[i].value + moved + yielded
        };
        let pressing = |i: usize| {
            if presses[i] {
                forces[i] > 0.0
            } else {
                open(i) < 0.0
            }
        };
        let now: Vec<bool> = (0..n).map(pressing).collect();
        let far = moves.iter().fold(0.0f64, |far, x| far.max(x.abs()));
        (0..3).for_each(|k| place[k] += moves[k].clamp(-5e-6, 5e-6));
        if now == presses && far < 1e-13 {
            let on_outer = |k: usize| {
                (n_inner..n)
                    .map(|i| -2.0 * gaps[i].slopes[k] * forces[i])
                    .sum::<f64>()
            };
            let (across, along) = (on_outer(0), on_outer(1));
            let count = |range: Range<usize>| range.filter(|&i| presses[i]).count();
            return Found {
                shaft: place[2],
                force: across.hypot(along),
                angle: along.atan2(across),
                pressing: [0..n_inner, n_inner..n].map(count),
            };
        }
        presses = now;
    }
    panic!("cells of the contact do not settle");
}
