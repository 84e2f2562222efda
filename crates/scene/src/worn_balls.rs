//! Balls of a scene that are no spheres.

use std::collections::BTreeMap;
use std::sync::Arc;

use contact::surface::MOST_NUMBERS;
use contact::{BallSurface, BearingGeometry, Profiles, Side};
use dynamics::kinematics::BothRings;

use crate::error::BuildError;
use crate::tables::Scene;

/// Balls with profiles, by number, as inner and outer raceway meet them. They roll at the free contact angle, which
/// their speed follows ([`dynamics::kinematics`]).
pub fn worn_balls(
    scene: &Scene,
    geometry: &BearingGeometry,
    half_widths: BothRings,
) -> Result<BTreeMap<usize, [Arc<BallSurface>; 2]>, BuildError> {
    let equator = geometry.free_contact_angle();
    let worn = |(ball, profiles): (&usize, &Profiles)| {
        let [inner, outer] = Side::BOTH.map(|side| {
            let felt = profiles.felt_by(half_widths[side.index()], 0.5 * geometry.ball_diameter);
            let surface = BallSurface::new((geometry, side), equator, &felt);
            surface.map(Arc::new).ok_or_else(|| BuildError::Surface {
                path: scene.path.clone(),
                problem: too_fine(&format!("ball {ball}")),
            })
        });
        Ok((*ball, [inner?, outer?]))
    };
    scene.profiles.balls.iter().map(worn).collect()
}

/// What is said of profiles that need too many points.
pub fn too_fine(body: &str) -> String {
    format!(
        "the profiles of {body} need a grid of more than {} million points; use a longer spall, a longer edge, fewer \
         or larger dents or lower orders",
        MOST_NUMBERS / 1_000_000
    )
}
