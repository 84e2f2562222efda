//! Hollow balls.

use super::*;
use crate::build::build_model;
use crate::error::BuildError;

const RIGID: [&str; 2] = ["inner.flexible=false", "outer.flexible=false"];

fn hollow(cavity: &str) -> String {
    EXAMPLE.replacen(
        "ball_diameter = \"9 mm\"",
        &format!("ball_diameter = \"9 mm\"\nball_inner_diameter = \"{cavity}\""),
        1,
    )
}

/// Wrong: a hollow ball with the mass, the inertia or the compliance of a solid one, or a scene without the key that is
/// another than it was. The moment of inertia is 2/5 m (R^5 - r^5)/(R^3 - r^3).
#[test]
fn hollow_balls_are_lighter_and_softer() {
    let model = |text: &str| build_model(&parse(text, &RIGID).unwrap()).unwrap().0;
    let (solid, found) = (model(EXAMPLE), model(&hollow("4 mm")));
    let volume = std::f64::consts::PI / 6.0 * (9e-3f64.powi(3) - 4e-3f64.powi(3));
    assert!((found.ball_mass() / (7800.0 * volume) - 1.0).abs() < 1e-14);
    let [outer, inner] = [4.5e-3f64, 2e-3];
    let radii = (outer.powi(5) - inner.powi(5)) / (outer.powi(3) - inner.powi(3));
    let inertia = found.ball_inertia();
    assert!((inertia.moment / (0.4 * found.ball_mass() * radii) - 1.0).abs() < 1e-14);
    assert!(found.sphere.own[0] < solid.sphere.own[0]);
    assert!(found.sphere.across.opposite() > solid.sphere.across.opposite());
    assert_eq!(found.hertz, solid.hertz);
    assert_eq!(solid.moment_factor(), 1.0);
    assert_eq!(
        solid.ball_inertia().moment,
        0.1 * solid.ball_mass() * 9e-3f64.powi(2)
    );
}

/// Wrong: a cavity that no ball has room for would be computed, or refused without saying what there is room for.
#[test]
fn cavities_that_are_too_large_are_refused() {
    for (cavity, expected) in [
        (
            "9 mm",
            "bearing.ball_inner_diameter is 9 mm; it must be less than bearing.ball_diameter, which is 9 mm",
        ),
        (
            "0 mm",
            "bearing.ball_inner_diameter is 0 mm; a diameter must be positive",
        ),
    ] {
        let message = parse(&hollow(cavity), &[]).err().unwrap().to_string();
        assert!(message.contains(expected), "{message}");
    }
    let scene = parse(&hollow("6 mm"), &RIGID).unwrap();
    let error = build_model(&scene).err().unwrap();
    assert!(matches!(error, BuildError::ThinWall { .. }));
    let message = error.to_string();
    for part in [
        "scene scenes/test.toml: bearing.ball_inner_diameter is 6.0000 mm, which leaves a wall of 1.500 mm; expected \
         at most 4.",
        ": the contacts are Hertz's where the wall is twice the larger semi-axis of their ellipse at 1.5 GPa",
    ] {
        assert!(message.contains(part), "{message}");
    }
}
