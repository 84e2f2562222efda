//! Room that films take in the contacts of a bearing that turns steadily.

use contact::{BySide, Side};
use dynamics::Model;
use dynamics::kinematics::Rolling;

use crate::tables::Scene;

/// By how much the films of contacts with the load of the scene lift balls off the grooves, inner first, m; 0 without
/// that load. Their thickness falls with the load to the power 0.067 alone, so that all balls get the same. Balls roll
/// as the cage's kinematics say: `rolling`.
pub fn film_lift(scene: &Scene, model: &Model, rolling: Option<Rolling>) -> BySide<f64> {
    let asked = scene
        .lubricant
        .and_then(|oil| Some((oil.lubricant, oil.lift_load?)));
    let (Some((lubricant, load)), Some(rolling)) = (asked, rolling) else {
        return [0.0; 2];
    };
    let surface = 0.5 * model.geometry.ball_diameter * rolling.spin(0.0);
    let slip = scene.effects.slip();
    Side::BOTH.map(|side| {
        let speed = surface * mean_over_ball(slip[side.index()]);
        let film = model.film_contact(side).film(lubricant, speed, load);
        film.map_or(0.0, |film| film.central)
    })
}

/// Mean speed of both surfaces of a contact over that of the ball's, which lacks this share of the raceway's.
pub fn mean_over_ball(slip: f64) -> f64 {
    (1.0 - 0.5 * slip) / (1.0 - slip)
}
