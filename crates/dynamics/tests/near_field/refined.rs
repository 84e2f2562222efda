//! Stress below a ball on meshes of both kinds of hexahedra, each refined.

use std::f64::consts::PI;

use contact::{LoadedPatch, NearField, RingPoint, Side};
use fem::stress::von_mises;

use super::loaded::Ring;
use super::{ANGLE, NU};
use crate::support::rings::Level;

/// Depths below the middle of a contact, m.
const DEPTHS: [f64; 3] = [0.1e-3, 0.2e-3, 0.5e-3];
/// Of a ball of the 7010C under 2 kN of preload: a peak pressure of 1.5 GPa.
const PRELOAD: f64 = 332.5;
/// Element sizes and kinds of `raceway mesh`, each half of the one before.
const COARSE: [Level; 4] = [
    Level::hex8(90, 6, 2, 2),
    Level::hex8(180, 12, 3, 4),
    Level::hex20(90, 6, 2, 2),
    Level::hex20(180, 12, 3, 4),
];
const FINE: [Level; 2] = [Level::hex8(360, 24, 6, 8), Level::hex20(360, 24, 6, 8)];

/// Von Mises stress over the peak pressure at [`DEPTHS`], the ball `share` of a sector beyond a plane of nodes.
fn below(loaded: &Ring, sectors: usize, share: f64) -> [f64; 3] {
    let (ring, azimuth) = (loaded.ring(), share * 2.0 * PI / sectors as f64);
    let points = DEPTHS.map(|depth| RingPoint {
        azimuth,
        angle: ANGLE,
        depth,
    });
    let shape = loaded.patch(azimuth);
    let mut stress = loaded.stress(&loaded.displacements(&[shape]), &points);
    let contact = LoadedPatch {
        azimuth,
        force: loaded.force,
        angle: ANGLE,
        semi_axes: loaded.hertz_axes(),
        patch_angle: ANGLE,
        patch_axes: shape.semi_axes,
    };
    let positions = points.map(|p| p.position(&ring.groove));
    NearField::new(ring.groove, NU, 4.0, &positions).add(&[contact], &mut stress);
    [0, 1, 2].map(|i| von_mises(stress[i]) / loaded.peak_pressure())
}

/// Largest difference of these meshes at any depth, in peak pressures, of both rings under a force.
fn spread(levels: &[Level], force: f64) -> f64 {
    let mut largest = 0.0f64;
    for side in Side::BOTH {
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for &level in levels {
            let loaded = Ring::under(side, level, force);
            for share in [0.0, 0.5] {
                let found = below(&loaded, level.sectors, share);
                println!("{side:?} {level:?} {share}, {force} N: {found:.4?}");
                for (range, x) in range.iter_mut().zip(found) {
                    *range = [range[0].min(x), range[1].max(x)];
                }
            }
        }
        let gaps = range.map(|[low, high]| high - low);
        println!("{side:?}, {force} N: {gaps:.4?}");
        largest = gaps.into_iter().fold(largest, f64::max);
    }
    largest
}

/// Wrong: patches would shrink with the elements, whose errors then stay the same share of a stress that grows: meshes
/// of quadratic elements would be 0.02 peak pressures off. Four meshes, both rings, the ball on a node and in mid
/// element: within 0.01 of each other.
#[test]
fn meshes_of_both_kinds_of_elements_agree_below_a_ball() {
    let gap = spread(&COARSE, PRELOAD);
    assert!(gap < 0.01, "{gap}");
}

/// Wrong: the same of meshes with 360 sectors, where patches of elements alone were smallest.
#[test]
#[ignore = "rings of 1.4 million dofs: a minute; scripts/test-slow runs it"]
fn fine_meshes_agree_with_coarse_ones_below_a_ball() {
    let all: Vec<Level> = COARSE.into_iter().chain(FINE).collect();
    let gap = spread(&all, PRELOAD);
    assert!(gap < 0.01, "{gap}");
    println!(
        "at twice the peak pressure: {:.4}",
        spread(&COARSE, 8.0 * PRELOAD)
    );
}
