//! `[balls]` and `[effects.traction]`: what stands beside free balls, and laws of traction.

use super::*;

/// A motion with free balls; `traction` are the lines of its table, `rest` further tables.
pub fn free(traction: &str, rest: &str) -> String {
    let (head, tail) = DYNAMIC.split_once("[effects.axial_force]").unwrap();
    let (_, tail) = tail.split_once("[dynamic]").unwrap();
    let tables = format!("[balls]\nmotion = \"free\"\n[effects.traction]\n{traction}\n{rest}\n");
    let text = format!("{head}{tables}[dynamic]{tail}");
    let text = replace_line(
        &text,
        "integrator = \"chung_hulbert\"",
        "integrator = \"average_acceleration\"",
    );
    replace_line(&text, "rho = 0.8", "")
}

pub const COULOMB: &str = "law = \"coulomb\"\nfriction = 0.07";

/// Wrong: a scene that is right would be refused.
#[test]
fn free_balls_with_any_law_are_a_scene() {
    for law in [
        COULOMB,
        "law = \"coulomb\"\nfriction = 0.0\ncreep = 1e-3\npoints = [5, 31]",
        "law = \"curve\"\nat_rest = 0.0\nmost = 0.07\nslip_of_most = \"0.1 m/s\"\nat_large = 0.03",
        "law = \"curve\"\nslips = [\"0 m/s\", \"0.1 m/s\"]\ncoefficients = [0.0, 0.07]\ncreep = \"elastic\"",
    ] {
        let scene = parse(&free(law, ""), &[]).unwrap_or_else(|e| panic!("{law}: {e}"));
        assert_eq!(scene.balls, BallMotion::Free);
        assert_eq!(scene.contact.ball, BallElasticity::Sphere);
    }
    assert_eq!(parse(DYNAMIC, &[]).unwrap().balls, BallMotion::Kinematic);
}

/// Wrong: an effect that free balls make wrong would act twice, or a key that does nothing be taken.
#[test]
fn what_free_balls_replace_is_refused_with_the_reason() {
    for (rest, expected) in [
        (
            "[effects.ball_centrifugal]",
            "[effects.ball_centrifugal] stands beside balls.motion = \"free\", but the centrifugal force of a free \
             ball is its inertia, it would act twice; remove it",
        ),
        (
            "[effects.gyroscopic_moment]\ninner_share = 1.0\nouter_share = 1.0",
            "[effects.gyroscopic_moment] stands beside balls.motion = \"free\", but traction carries the gyroscopic \
             moment of a free ball, it would act twice; remove it",
        ),
        (
            "[effects.cage_slip]\ninner = 0.02\nouter = 0.0",
            "[effects.cage_slip] stands beside balls.motion = \"free\", but the slip of a free ball is a result, not \
             given; remove it",
        ),
    ] {
        let message = message_of(&free(COULOMB, rest), &[]);
        assert!(message.contains(expected), "{message}");
    }
    let temperature = "[effects.temperature]\ninner = \"60 degC\"\nouter = \"45 degC\"\nballs = \"65 degC\"";
    let message = message_of(&free(COULOMB, temperature), &[]);
    let expected = "[effects.temperature] stands beside balls.motion = \"free\", which is not computed; remove it, or \
                    use balls.motion = \"kinematic\"";
    assert!(message.contains(expected), "{message}");
    parse(&free(COULOMB, ""), &["contact.ball=\"sphere\""]).unwrap();
    let message = message_of(&free(COULOMB, ""), &["speed.ball_speeds=\"outer_control\""]);
    let expected = "speed.ball_speeds stands beside balls.motion = \"free\", but the speeds of free balls are results; \
                    remove it";
    assert!(message.contains(expected), "{message}");
}

/// Wrong: surfaces that are computed beside free balls would be refused, or those that are not be computed.
#[test]
fn free_balls_roll_on_real_surfaces() {
    let surfaces = "[[profiles.waviness]]\nring = \"inner\"\norder = 19\namplitude = \"0.5 um\"\n\n\
                    [[profiles.waviness]]\nball = 2\norder = 3\namplitude = \"0.5 um\"\n";
    let scene = parse(&free(COULOMB, surfaces), &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.balls, BallMotion::Free);
    assert!(!scene.profiles.raceways[0].is_empty() && scene.profiles.balls.contains_key(&2));
    let message = message_of(&free(COULOMB, surfaces), &["contact.ball=\"sphere\""]);
    let expected = "contact.ball is \"sphere\"; beside profiles both contacts of a ball are on their own, use \
                    \"half_space\"";
    assert!(message.contains(expected), "{message}");
    let message = message_of(&free(COULOMB, surfaces), &["speed.ball_speeds=\"outer_control\""]);
    let expected = "speed.ball_speeds stands beside balls.motion = \"free\", but the speeds of free balls are results; \
                    remove it";
    assert!(message.contains(expected), "{message}");
}

/// Wrong: balls would be free without what carries them, or traction do nothing.
#[test]
fn free_balls_and_traction_need_each_other() {
    let text = free(COULOMB, "");
    let alone = message_of(&text, &["balls.motion=\"kinematic\""]);
    let expected = "[effects.traction] needs free balls: balls whose motion is kinematic roll without friction; write \
                    [balls] with motion = \"free\", or remove it";
    assert!(alone.contains(expected), "{alone}");
    let drag = message_of(
        &free(
            COULOMB,
            "[effects.ball_drag]\ncoefficient = 0.5\ndensity = \"20 kg/m3\"",
        ),
        &["balls.motion=\"kinematic\""],
    );
    let expected = "[effects.ball_drag] needs free balls: nothing slows down balls whose motion is kinematic; write \
                    [balls] with motion = \"free\", or remove it";
    assert!(drag.contains(expected), "{drag}");
    let without = text.replace(&format!("[effects.traction]\n{COULOMB}"), "");
    let expected = "balls.motion is \"free\", but nothing carries the balls round; add [effects.traction] with law = \
                    \"coulomb\" and friction (0 is frictionless)";
    let message = message_of(&without, &[]);
    assert!(message.contains(expected), "{message}");
}

/// Wrong: an analysis or integrator that does not know free balls would compute something else.
#[test]
fn free_balls_are_refused_where_they_are_not_computed() {
    let at_rest = format!("{EXAMPLE}\n[balls]\nmotion = \"free\"\n[effects.traction]\n{COULOMB}\n");
    let message = message_of(&at_rest, &[]);
    let expected = "balls.motion is \"free\", but nothing turns: balls of an equilibrium roll; add [speed] with \
                    inner = \"1800 rpm\", or use motion = \"kinematic\"";
    assert!(message.contains(expected), "{message}");
    let turning = format!("{at_rest}[speed]\ninner = \"1800 rpm\"\n");
    let scene = parse(&turning, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.balls, BallMotion::Free);
    let caged = format!("{turning}[cage]\nmotion = \"free\"\n");
    let expected =
        "cage.motion is \"free\", which only motion in time computes; use [dynamic], or remove [cage]";
    assert!(message_of(&caged, &[]).contains(expected));
    let modes = format!(
        "{}[balls]\nmotion = \"free\"\n[effects.traction]\n{COULOMB}\n[modes]\nnumber = 3\n",
        without_table("[sweep]")
    );
    let expected =
        "balls.motion is \"free\", whose traction natural modes do not know; use motion = \"kinematic\"";
    assert!(message_of(&modes, &[]).contains(expected));
    let message = message_of(
        &free(COULOMB, ""),
        &["dynamic.integrator=\"chung_hulbert\"", "dynamic.rho=0.8"],
    );
    let expected = "balls.motion is \"free\", which needs the energy of the balls to be kept; use dynamic.integrator = \
                    \"average_acceleration\"";
    assert!(message.contains(expected), "{message}");
}

/// Wrong: a drag that drives balls on would be computed.
#[test]
fn drags_that_cannot_be_are_refused() {
    for (lines, expected) in [
        (
            "coefficient = -0.5\ndensity = \"20 kg/m3\"",
            "effects.ball_drag.coefficient is -0.5; expected 0 to 1000, a ball has 0.4 to 1",
        ),
        (
            "coefficient = 0.5\ndensity = \"-20 kg/m3\"",
            "effects.ball_drag.density is -20 kg/m3; a density cannot be negative",
        ),
    ] {
        let message = message_of(&free(COULOMB, &format!("[effects.ball_drag]\n{lines}")), &[]);
        assert!(message.contains(expected), "{message}");
    }
}

/// Wrong: a law that lacks a number, or has one too many or a wrong one, would be computed with another.
#[test]
fn laws_that_cannot_be_are_refused() {
    let curve = "law = \"curve\"\n";
    for (law, expected) in [
        (
            "law = \"coulomb\"".to_string(),
            "[effects.traction] needs friction, the coefficient of law = \"coulomb\"",
        ),
        (
            format!("{COULOMB}\nmost = 0.1"),
            "law = \"coulomb\", which takes friction alone; remove the keys of a curve",
        ),
        (
            "law = \"coulomb\"\nfriction = -0.1".to_string(),
            "effects.traction.friction is -0.1; expected a coefficient of friction from 0 to 2",
        ),
        (
            "law = \"coulomb\"\nfriction = 7.0".to_string(),
            "effects.traction.friction is 7; expected a coefficient of friction from 0 to 2",
        ),
        (
            "law = \"limiting_shear\"".to_string(),
            "[effects.traction] has law = \"limiting_shear\", which shears a film; add the table [lubricant]",
        ),
        (
            "law = \"limiting_shear\"".to_string(),
            "[effects.traction] has law = \"limiting_shear\" and needs eyring_stress, such as \"5 MPa\", and limit",
        ),
        (
            "law = \"limiting_shear\"\neyring_stress = \"0 MPa\"\nlimit = 0.08".to_string(),
            "effects.traction.eyring_stress is 0 MPa; the stress at which an oil begins to thin must be positive",
        ),
        (
            "law = \"limiting_shear\"\neyring_stress = \"5 MPa\"\nlimit = 0".to_string(),
            "effects.traction.limit is 0; expected above 0 to 1, the largest shear stress over the pressure: 0.05",
        ),
        (
            "law = \"limiting_shear\"\neyring_stress = \"5 MPa\"\nlimit = 0.08\nfriction = 0.07".to_string(),
            "[effects.traction] has law = \"limiting_shear\", whose coefficients follow from the film",
        ),
        (
            format!("{COULOMB}\nlimit = 0.08"),
            "eyring_stress and limit do nothing without law = \"limiting_shear\"",
        ),
        (
            format!("{curve}friction = 0.1\nslips = [\"0 m/s\", \"1 m/s\"]\ncoefficients = [0.0, 0.1]"),
            "effects.traction.friction does nothing with law = \"curve\"",
        ),
        (
            curve.to_string(),
            "needs either at_rest, most, slip_of_most and at_large, or slips and coefficients",
        ),
        (
            format!("{curve}most = 0.1"),
            "[effects.traction] needs all of at_rest, most, slip_of_most and at_large of its curve",
        ),
        (
            format!("{curve}at_rest = 0.1\nmost = 0.1\nslip_of_most = \"1 m/s\"\nat_large = 0.0"),
            "effects.traction.most is 0.1; it must be more than at_rest and at_large, it is the peak of the curve",
        ),
        (
            format!("{curve}at_rest = 0.0\nmost = 0.1\nslip_of_most = \"0 m/s\"\nat_large = 0.0"),
            "effects.traction.slip_of_most is 0 m/s; the slip of the largest coefficient must be positive",
        ),
        (
            format!("{curve}slips = [\"0 m/s\"]"),
            "[effects.traction] needs both slips and coefficients of its curve",
        ),
        (
            format!("{curve}slips = [\"0 m/s\"]\ncoefficients = [0.1, 0.2]"),
            "[effects.traction] has 1 slips and 2 coefficients; expected as many of both, at least two",
        ),
        (
            format!("{curve}slips = [\"1 m/s\", \"2 m/s\"]\ncoefficients = [0.1, 0.2]"),
            "effects.traction.slips[0] is 1 m/s; a curve begins without slip, at \"0 m/s\"",
        ),
        (
            format!("{curve}slips = [\"0 m/s\", \"0 m/s\"]\ncoefficients = [0.1, 0.2]"),
            "effects.traction.slips[1] is 0 m/s; slips must grow",
        ),
        (
            format!("{curve}slips = [\"0 m/s\", \"1 m/s\"]\ncoefficients = [0.1, 3.0]"),
            "effects.traction.coefficients[1] is 3; expected a coefficient of friction from 0 to 2",
        ),
        (
            format!("{COULOMB}\ncreep = 0.0"),
            "effects.traction.creep is 0; expected \"elastic\" or a slip ratio of 1e-9 to 1",
        ),
        (
            format!("{COULOMB}\npoints = [0, 15]"),
            "effects.traction.points[0] is 0; expected 1 to 63 places",
        ),
        (
            format!("{COULOMB}\npoints = [3, 64]"),
            "effects.traction.points[1] is 64; expected 1 to 63 places",
        ),
        (
            format!("{COULOMB}\ncreep = \"plastic\""),
            "\"elastic\" or a slip ratio such as 1e-3",
        ),
        (
            "law = \"stribeck\"".to_string(),
            "effects.traction.law is \"stribeck\"; valid values are \"coulomb\", \"curve\", \"limiting_shear\"",
        ),
        (
            format!("{COULOMB}\npoints = [3]"),
            "effects.traction.points: invalid length 1, expected two values in brackets, [a, b]",
        ),
        (
            format!("{COULOMB}\ncreep = -1e-3"),
            "effects.traction.creep is -0.001; expected \"elastic\" or a slip ratio of 1e-9 to 1",
        ),
        (
            "law = \"coulomb\"\nfriction = nan".to_string(),
            "effects.traction.friction is NaN; expected a coefficient of friction from 0 to 2",
        ),
        (
            "law = \"coulomb\"\nmu = 0.07".to_string(),
            "unknown key \"mu\" in [effects.traction]; valid keys are \"law\", \"friction\",",
        ),
        (
            "friction = 0.07".to_string(),
            "[effects.traction] has no key \"law\", which is required",
        ),
        (
            format!("{curve}at_rest = 0.0\nmost = 0.1\nslip_of_most = 0.1\nat_large = 0.0"),
            "effects.traction.slip_of_most: 0.1 is a number without a unit; expected a speed such as",
        ),
    ] {
        let message = message_of(&free(&law, ""), &[]);
        assert!(message.contains(expected), "{law}: {message}");
    }
    let message = message_of(
        &free(COULOMB, "").replace("motion = \"free\"", "motion = \"frei\""),
        &[],
    );
    assert!(message.contains("frei"), "{message}");
}
