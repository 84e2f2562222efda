//! Strips against Hertz's law, closed forms and difference quotients.

use contact::hertz::Elastic;
use contact::strips::{StripForce, StripLaw, StripLine};
use contact::worn_line::WornLine;
use contact::{BearingGeometry, ContactLaw, HertzContact, Side};

fn outer_of_7010c() -> StripLaw {
    let geometry = BearingGeometry::reference_7010c();
    let steel = Elastic {
        young_modulus: 207e9,
        poisson_ratio: 0.3,
    };
    let hertz = HertzContact::new(&geometry, Side::Outer, steel, steel);
    StripLaw::new(&hertz, geometry.groove_radius(Side::Outer))
}

const SMOOTH: StripLine = StripLine {
    angles: &[-3.0, 3.0],
    missing: &[0.0, 0.0],
    worn: None,
};

/// Wrong: strips on a smooth groove would not be Hertz's law with what the patch takes out. To round-off.
#[test]
fn a_smooth_groove_is_exactly_hertz() {
    let law = outer_of_7010c();
    assert!(
        (law.parabola_radius / 59.61e-3 - 1.0).abs() < 1e-3,
        "{}",
        law.parabola_radius
    );
    assert!((law.density / 5.536e10 - 1.0).abs() < 1e-3, "{}", law.density);
    for compliance in [0.0, 2e-9] {
        let hertz = ContactLaw {
            stiffness: law.stiffness,
            patch_compliance: compliance,
            ball_compliance: 0.0,
        };
        for g in [1e-9, 1e-7, 3e-6, 1.2e-5, 4e-5] {
            for angle in [-0.2, 0.0, 0.35] {
                let (found, exact) = (law.evaluate(SMOOTH, compliance, g, angle), hertz.evaluate(g));
                let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
                assert!(!exact.beyond_limit && !found.beyond_limit);
                assert!(
                    close(found.force, exact.force),
                    "{g}: {} {}",
                    found.force,
                    exact.force
                );
                assert!(close(found.tangent[0][0], exact.tangent), "{g}");
                assert!(close(found.energy, exact.energy), "{g}");
                assert!(close(found.approach, exact.approach), "{g}");
                assert!(found.moment.abs() <= 1e-13 * exact.force * law.groove_radius);
            }
        }
    }
    assert_eq!(law.evaluate(SMOOTH, 0.0, -1e-6, 0.2).force, 0.0);
}

/// Wrong: where bodies touch on a bump alone, while the smooth groove would not, a contact that yields besides would
/// have no number for its approach. A bump that is level everywhere is a groove that is nearer: the same force at an
/// approach that is larger by its height, which Hertz's approach is measured without.
#[test]
fn a_contact_on_a_bump_has_an_approach_below_zero() {
    let law = outer_of_7010c();
    let height = 0.5e-6;
    let bump = StripLine {
        missing: &[-height, -height],
        ..SMOOTH
    };
    for compliance in [0.0, 7.5e-10] {
        for g in [-0.499e-6, -0.3e-6, -1e-7, 0.0, 1e-7] {
            let found = law.evaluate(bump, compliance, g, 0.2);
            let exact = law.evaluate(SMOOTH, compliance, g + height, 0.2);
            assert!(
                (found.force / exact.force - 1.0).abs() < 1e-9,
                "{g}: {} {}",
                found.force,
                exact.force
            );
            assert!(
                (found.approach + height - exact.approach).abs() < 1e-15,
                "{g}: {}",
                found.approach
            );
        }
        assert!(law.evaluate(bump, compliance, -0.6e-6, 0.2).approach.is_finite());
    }
}

/// Wrong: a truncated ellipse would keep another share of its force than 1/2 + 3/4 tau - tau^3/4.
#[test]
fn a_shoulder_takes_its_share_of_the_ellipse() {
    let law = outer_of_7010c();
    let d = 5e-6;
    let full = law.evaluate(SMOOTH, 0.0, d, 0.0).force;
    let half_width = law.half_width(full);
    for (tau, share) in [(0.5, 0.84375), (0.0, 0.5), (1.0, 1.0), (1.7, 1.0), (-0.4, 0.216)] {
        let line = StripLine {
            angles: &[-1.0, tau * half_width / law.groove_radius],
            missing: &[0.0, 0.0],
            worn: None,
        };
        let kept = law.evaluate(line, 0.0, d, 0.0).force / full;
        let formula = if tau < 1.0 {
            0.5 + 0.75 * tau - 0.25 * f64::powi(tau, 3)
        } else {
            1.0
        };
        assert!(
            (kept - formula).abs() < 1e-14 && (kept - share).abs() < 1e-12,
            "{tau}: {kept}"
        );
    }
}

/// Wrong: a spall over the middle half of the ellipse would leave another share than 0.3125 of the force.
#[test]
fn a_spall_takes_the_middle_of_the_ellipse() {
    let law = outer_of_7010c();
    let d = 5e-6;
    let full = law.evaluate(SMOOTH, 0.0, d, 0.1).force;
    let half = 0.5 * law.half_width(full) / law.groove_radius;
    let edge = 1e-12;
    let line = StripLine {
        angles: &[
            -1.0,
            0.1 - half - edge,
            0.1 - half,
            0.1 + half,
            0.1 + half + edge,
            1.0,
        ],
        missing: &[0.0, 0.0, 1e-4, 1e-4, 0.0, 0.0],
        worn: None,
    };
    let kept = law.evaluate(line, 0.0, d, 0.1).force / full;
    assert!((kept - 0.3125).abs() < 1e-9, "{kept}");
}

/// A groove with a shoulder, a slope, a dip and a bump within the ellipse.
const UNEVEN: StripLine = StripLine {
    angles: &[-0.5, 0.02, 0.05, 0.09, 0.13, 0.2],
    missing: &[0.0, 0.4e-6, 2.5e-6, 0.3e-6, -1.1e-6, 0.2e-6],
    worn: None,
};

/// A ball with a dip and a bump within the ellipse, at angles between those of the groove.
const WORN: WornLine = WornLine {
    radius: 4.5e-3,
    angles: &[0.01, 0.04, 0.07, 0.11, 0.15],
    missing: &[0.1e-6, 1.3e-6, -0.8e-6, 1.7e-6, -0.2e-6],
};

/// Wrong: forces, moments and tangents would not be derivatives of one energy, and motion would make some. Difference
/// quotients, with and without compliance, also beyond the limit of the patch; under a smooth and under a worn ball.
#[test]
fn forces_and_tangents_are_derivatives_of_the_energy() {
    let law = outer_of_7010c();
    let worn = StripLine {
        worn: Some(WORN),
        ..UNEVEN
    };
    for line in [UNEVEN, worn] {
        let mut beyond = 0;
        for compliance in [0.0, 8e-9] {
            for i in 0..60 {
                let (g, angle) = (-1e-6 + 1.2e-6 * i as f64, 0.02 + 0.0023 * i as f64);
                let at = |g: f64, angle: f64| law.evaluate(line, compliance, g, angle);
                let found = at(g, angle);
                beyond += usize::from(found.beyond_limit);
                check(&found, [at(g - 1e-11, angle), at(g + 1e-11, angle)], 2e-11, 0);
                check(&found, [at(g, angle - 1e-8), at(g, angle + 1e-8)], 2e-8, 1);
            }
        }
        assert!(beyond > 5, "the sweep must reach the limit, {beyond}");
    }
}

/// Wrong: what a ball lacks would be felt otherwise than what the groove lacks. At one contact angle the same heights
/// at the same places y across the track give the same force and energy; a ball that lacks the same all over is one
/// that stands farther away; a ball that lacks nothing is a sphere.
#[test]
fn a_worn_ball_on_a_groove_is_a_worn_groove_under_a_ball() {
    let law = outer_of_7010c();
    let (d, angle, radius) = (7e-6, 0.08, 4.5e-3);
    let force = |line: StripLine| law.evaluate(line, 2e-9, d, angle);
    let angles: Vec<f64> = WORN
        .angles
        .iter()
        .map(|a| angle + (a - angle) * radius / law.groove_radius)
        .collect();
    let groove = StripLine {
        angles: &[&[-3.0], &angles[..], &[3.0]].concat(),
        missing: &[&WORN.missing[..1], WORN.missing, &WORN.missing[4..]].concat(),
        worn: None,
    };
    let ball = StripLine {
        worn: Some(WORN),
        ..SMOOTH
    };
    let (a, b) = (force(groove), force(ball));
    assert!((a.force / b.force - 1.0).abs() < 1e-12, "{} {}", a.force, b.force);
    assert!((a.energy / b.energy - 1.0).abs() < 1e-12);
    // What moves with the contact angle is r/R_g of what it is on a groove.
    let share = a.moment / b.moment * radius / law.groove_radius;
    assert!((share - 1.0).abs() < 1e-9, "{} {}", a.moment, b.moment);
    let h = 1.3e-6;
    let [none, all] = [[0.0; 5], [h; 5]];
    let level = |missing| StripLine {
        worn: Some(WornLine { missing, ..WORN }),
        ..UNEVEN
    };
    let sphere = force(level(&none));
    assert!((sphere.force / force(UNEVEN).force - 1.0).abs() < 1e-14);
    let lower = force(level(&all));
    let smooth = law.evaluate(UNEVEN, 2e-9, d - h, angle);
    assert!((lower.force / smooth.force - 1.0).abs() < 1e-12);
    assert!((lower.moment / smooth.moment - 1.0).abs() < 1e-10);
}

fn check(found: &StripForce, [low, high]: [StripForce; 2], h: f64, k: usize) {
    let gradient = [found.force, found.moment];
    let scale = [found.force.abs() + 1e-2, found.force.abs() * 5e-3 + 1e-5];
    let slope = (high.energy - low.energy) / h;
    assert!(
        (slope - gradient[k]).abs() < 1e-4 * scale[k],
        "{k}: {slope} {gradient:?}"
    );
    if low.beyond_limit != high.beyond_limit {
        return;
    }
    for (i, change) in [high.force - low.force, high.moment - low.moment]
        .into_iter()
        .enumerate()
    {
        let (quotient, exact) = (change / h, found.tangent[i][k]);
        let size =
            (found.tangent[i][i] * found.tangent[k][k]).abs().sqrt() + 1e-2 * scale[i] / [1e-6, 1e-2][k];
        assert!(
            (quotient - exact).abs() < 2e-3 * size,
            "{i} {k}: {quotient} {exact} {size}"
        );
    }
}

/// Wrong: the approach would not meet d - c_s Q = g.
#[test]
fn what_the_patch_yields_is_taken_out() {
    let law = outer_of_7010c();
    for i in 1..100 {
        let g = 2e-7 * i as f64;
        let found = law.evaluate(UNEVEN, 2e-9, g, 0.08);
        if !found.beyond_limit {
            let residual = found.approach - 2e-9 * found.force - g;
            assert!(residual.abs() < 1e-15 * found.approach + 1e-21, "{g}: {residual}");
        }
    }
}
