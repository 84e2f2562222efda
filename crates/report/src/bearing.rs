//! What a page says of the bearing: its geometry from the scene, and a table of its balls.

use std::path::Path;

use scene::{MeshFiles, Scene, geometry};
use serde_json::Value;

use super::html::{Cells, digits, row, table};

/// More balls than this fill a page and tell no more.
const MOST_BALLS: usize = 60;

/// The scene of a step; none where it is not that of this version.
fn read(text: Option<&str>) -> Option<Scene> {
    Scene::parse(
        text?,
        Path::new("scene of the step"),
        &[],
        MeshFiles::MayBeMissing,
    )
    .ok()
}

/// Whether the stress of the run has that of the contacts in it; empty where it is not known.
pub fn stress(text: Option<&str>) -> String {
    match read(text).map(|scene| scene.stress.near_field_reach) {
        None => String::new(),
        Some(Some(_)) => "with near field: under the balls that of the Hertz ellipses".into(),
        Some(None) => {
            "without near field: that of forces spread over patches, far below the stress under a ball".into()
        }
    }
}

/// Main dimensions, clearance and free contact angle.
pub fn bearing(text: Option<&str>) -> String {
    let Some(scene) = read(text) else {
        return String::new();
    };
    let (b, g) = (&scene.bearing, geometry(&scene));
    let mm = |length: f64| format!("{} mm", digits(1e3 * length));
    let rows = [
        (
            "bore, outside diameter, width",
            [mm(b.bore_diameter), mm(b.outside_diameter), mm(b.width)].join(", "),
        ),
        ("balls", format!("{} of {}", b.balls, mm(b.ball_diameter))),
        ("pitch diameter", mm(g.pitch_diameter())),
        (
            "raceway diameters, inner and outer",
            [mm(b.inner_raceway_diameter), mm(b.outer_raceway_diameter)].join(", "),
        ),
        (
            "groove radii over ball diameter, inner and outer",
            [b.inner_groove_radius, b.outer_groove_radius]
                .map(|r| digits(r / b.ball_diameter))
                .join(", "),
        ),
        ("radial clearance", format!("{} um", digits(1e6 * g.clearance()))),
        (
            "free contact angle",
            format!("{} deg", digits(g.free_contact_angle().to_degrees())),
        ),
    ];
    let rows = rows
        .iter()
        .map(|(name, value)| row(name, std::slice::from_ref(value), Cells::Text));
    format!("<h2>Bearing</h2>\n{}", table("about", None, rows))
}

/// Forces, angles and pressures of every ball at the end of the run.
pub fn balls(summary: &Value) -> String {
    let balls = summary
        .get("balls")
        .and_then(Value::as_array)
        .map_or(&[][..], Vec::as_slice);
    if balls.is_empty() || balls.len() > MOST_BALLS {
        return String::new();
    }
    // A ball that touches nothing has no contact angle.
    let number = |ball: &Value, side: &str, key: &str, factor: f64, decimals: usize| {
        let is_loaded = ball.pointer(&format!("/{side}/force_n")).and_then(Value::as_f64) != Some(0.0);
        let value = ball.pointer(&format!("/{side}/{key}")).and_then(Value::as_f64);
        match value.filter(|_| is_loaded || key == "force_n") {
            Some(value) => rounded(factor * value, decimals),
            None => "-".to_string(),
        }
    };
    let degrees = 1f64.to_degrees();
    let quantities = [
        ("force_n", 1.0, 2),
        ("contact_angle_rad", degrees, 3),
        ("peak_pressure_pa", 1e-9, 3),
    ];
    let rows = balls.iter().zip(0..).map(|(ball, n)| {
        let azimuth = ball
            .get("azimuth_rad")
            .and_then(Value::as_f64)
            .unwrap_or(f64::NAN);
        let of_contacts = quantities.iter().flat_map(|&(key, factor, decimals)| {
            ["inner", "outer"].map(|side| number(ball, side, key, factor, decimals))
        });
        let cells: Vec<String> = std::iter::once(rounded(degrees * azimuth, 1))
            .chain(of_contacts)
            .collect();
        row(&n.to_string(), &cells, Cells::Numbers)
    });
    let head = [
        "ball",
        "azimuth, deg",
        "inner force, N",
        "outer force, N",
        "inner angle, deg",
        "outer angle, deg",
        "inner pressure, GPa",
        "outer pressure, GPa",
    ];
    let table = table("numbers", Some(&head), rows);
    format!("<h2>Balls at the end</h2>\n<div class=\"wide\">{table}</div>")
}

/// A number with so many decimals; round-off of zero has no sign.
pub fn rounded(value: f64, decimals: usize) -> String {
    let scale = 10f64.powi(decimals as i32);
    format!("{:.decimals$}", (value * scale).round() / scale + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a ball that touches nothing would have a contact angle of round-off, or a zero a sign.
    #[test]
    fn every_ball_has_a_row_and_unloaded_ones_no_angle() {
        let contact = |force: f64| {
            let (angle, pressure) = (-2.1e-7, 1.5e9);
            serde_json::json!({ "force_n": force, "contact_angle_rad": angle, "peak_pressure_pa": pressure })
        };
        let ball = |azimuth: f64, force: f64| {
            let (inner, outer) = (contact(force), contact(force));
            serde_json::json!({ "azimuth_rad": azimuth, "inner": inner, "outer": outer })
        };
        let text =
            balls(&serde_json::json!({ "balls": [ball(0.0, 1059.404), ball(std::f64::consts::PI, 0.0)] }));
        let row = |cells: [&str; 7]| {
            cells
                .map(|cell| format!("<td class=\"number\">{cell}</td>"))
                .concat()
        };
        let loaded = row(["0.0", "1059.40", "1059.40", "0.000", "0.000", "1.500", "1.500"]);
        let loose = row(["180.0", "0.00", "0.00", "-", "-", "-", "-"]);
        assert!(text.contains(&format!("<tr><th>0</th>{loaded}</tr>")), "{text}");
        assert!(text.contains(&format!("<tr><th>1</th>{loose}</tr>")), "{text}");
        assert_eq!(balls(&serde_json::json!({})), "");
    }
}
