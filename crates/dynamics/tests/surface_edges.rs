//! Contacts at the edges of grooves and over profiles: what is said of them, and that rest and motion agree.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::support::rings::Level;
use crate::support::{Case, equilibrium, relative};
use contact::surface::{Spall, Wave};
use contact::{Profiles, Side, StripLaw, StripSurface};
use dynamics::kinematics::Speed;
use dynamics::motion::{ContactLimit, Motion, MotionSettings, StepCache};
use dynamics::surfaces::EllipseKind;
use dynamics::{ContactMode, Hold, Model, StaticSolver};

fn with_outer_strips(mut model: Model, shoulders: Option<RangeInclusive<f64>>, profiles: &Profiles) -> Model {
    let law = StripLaw::new(&model.hertz[1], model.geometry.groove_radius(Side::Outer));
    let surface = StripSurface::new(law, (&model.geometry, Side::Outer), shoulders, profiles).unwrap();
    model.surfaces.strips[1] = Some(Arc::new(surface));
    model
}

/// The 7010C on rigid rings under thrust, whose outer shoulder stands so many half-widths from the middles of the
/// ellipses on a groove without it.
fn cut(half_widths: f64) -> Model {
    let case = Case::axial(2000.0);
    let before = equilibrium(&case.rigid()).balls[0].outer;
    let shoulder = before.contact_angle_rad + half_widths * before.semi_axes_m.groove / 4.75e-3;
    let mut model = with_outer_strips(case.rigid(), Some(-0.6..=shoulder), &Profiles::default());
    model.shaft_mass = 2.0;
    model
}

/// Wrong: a ball on rigid rings whose ellipse ends at a shoulder would not be named, or its stress be taken for
/// Hertz's; or every contact would be marked.
#[test]
fn balls_whose_ellipses_end_at_the_shoulder_of_a_rigid_ring_are_named() {
    let found = equilibrium(&cut(0.8));
    let balls: Vec<String> = (0..18).map(|ball| ball.to_string()).collect();
    let expected = format!(
        "edge contact on the outer raceway, balls {}: the ellipse ends at the shoulder; forces are those of what is \
         left of it, but the stress at the edge is higher than any pressure given here",
        balls.join(", ")
    );
    assert_eq!(found.warnings, [expected]);
    assert!(
        found
            .balls
            .iter()
            .all(|ball| ball.outer.ellipse == Some(EllipseKind::Edge))
    );
    assert!(found.balls.iter().all(|ball| ball.inner.ellipse.is_none()));
    let wide = with_outer_strips(
        Case::axial(2000.0).rigid(),
        Some(-0.6..=0.9),
        &Profiles::default(),
    );
    let found = equilibrium(&wide);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    assert!(
        found
            .balls
            .iter()
            .all(|ball| ball.outer.ellipse == Some(EllipseKind::Hertz))
    );
}

/// Wrong: on rigid rings a ball could run beyond its shoulder without a word, at rest or in motion.
#[test]
fn balls_beyond_the_shoulder_of_a_rigid_ring_are_refused() {
    let case = Case {
        radial: 1000.0,
        ..Case::axial(10_000.0)
    };
    // A shoulder of 27 deg, as the 7010C has with a diameter of 73 mm.
    let shoulder = 27f64.to_radians();
    let edged =
        |case: Case| with_outer_strips(case.rigid(), Some(-shoulder..=shoulder), &Profiles::default());
    let model = edged(case);
    let refused = StaticSolver::new(&model).unwrap().solve(&model, None);
    let text = refused.err().expect("balls at 40 deg leave it").to_string();
    let expected = "leaves the outer raceway: contact angle ";
    assert!(text.contains(expected), "{text}");
    assert!(
        text.contains(
            "between its shoulders the groove reaches from -27.00 to 27.00 deg; raise the shoulder or lower"
        ),
        "{text}"
    );
    // A motion from an equilibrium in the groove, whose load then drives the balls out of it.
    let start = equilibrium(&edged(Case::axial(1000.0)));
    let mut model = edged(Case::axial(20_000.0));
    model.shaft_mass = 2.0;
    let motion = Motion::new(&model, MotionSettings::conserving(5e-6, Speed::constant(0.0))).unwrap();
    let (mut state, mut cache) = (motion.start(&start), StepCache::default());
    let error = (0..400).find_map(|_| match motion.step(&state, &mut cache) {
        Ok((next, _)) => {
            state = next;
            None
        }
        Err(error) => Some(error.to_string()),
    });
    let text = error.expect("the balls leave the groove");
    assert!(text.contains(expected), "{text}");
}

/// Wrong: the force of an edge contact would be another one at rest than in motion: the force across the normal is part
/// of it. A motion that starts from the equilibrium stays there, to the 1e-8 at which Newton stops; 5 N at
/// least of 340 N act across.
#[test]
fn the_force_of_an_edge_contact_is_the_same_at_rest_and_in_motion() {
    let model = cut(0.6);
    let rest = equilibrium(&model);
    let motion = Motion::new(&model, MotionSettings::conserving(5e-6, Speed::constant(0.0))).unwrap();
    let mut cache = StepCache::default();
    let first = motion.start(&rest);
    let (state, _) = motion.step(&first, &mut cache).unwrap();
    let law = StripLaw::new(&model.hertz[1], model.geometry.groove_radius(Side::Outer));
    for (a, b) in rest.balls.iter().zip(motion.balls(&state)) {
        assert!(
            relative(a.outer.force_n, b.outer.force_n) < 1e-8,
            "{} {}",
            a.outer.force_n,
            b.outer.force_n
        );
        assert!(relative(a.inner.force_n, b.inner.force_n) < 1e-8);
        // Both contacts of a ball at rest carry the same.
        assert!(relative(a.inner.force_n, a.outer.force_n) < 1e-8);
        let a_half = (2.0 * law.parabola_radius * a.outer.approach_m).sqrt();
        let high = model.surfaces.edges(Side::Outer).unwrap().end();
        let tau = (high - a.outer.contact_angle_rad) * law.groove_radius / a_half;
        let normal = law.stiffness * a.outer.approach_m.powf(1.5) * (0.5 + 0.75 * tau - 0.25 * tau.powi(3));
        let across = (a.outer.force_n.powi(2) - normal * normal).sqrt();
        assert!(across > 5.0, "{} {normal}", a.outer.force_n);
        assert_eq!(b.outer.ellipse, Some(EllipseKind::Edge));
    }
    let beyond = motion.exceeded(&state);
    assert_eq!(beyond.len(), 18);
    assert!(
        beyond
            .iter()
            .all(|e| e.limit == ContactLimit::Edge && e.side == Side::Outer)
    );
}

/// Wrong: contacts over marks would pass for Hertz's, or those beside them, and those on long waves, for other ones.
/// One of 18 balls stands in a spall as long as two ellipses.
#[test]
fn contacts_over_marks_are_told_from_those_on_level_ground() {
    let case = Case::axial(2000.0);
    let smooth = equilibrium(&case.rigid());
    let outer = smooth.balls[0].outer;
    let spall = |width: f64, depth: f64| Profiles {
        spalls: vec![Spall {
            azimuth: case.rigid().geometry.azimuth(0),
            groove_angle: outer.contact_angle_rad,
            length: 0.5e-3,
            width,
            depth,
            edge: 0.05e-3,
        }],
        ..Profiles::default()
    };
    let wave = |order: usize| Profiles {
        waves: vec![Wave {
            order,
            amplitude: 1e-6,
            phase: 0.3,
        }],
        ..Profiles::default()
    };
    let marked = |profiles: Profiles| {
        let found = equilibrium(&with_outer_strips(case.rigid(), None, &profiles));
        let of_ball = |ball: usize| found.balls[ball].outer.ellipse.unwrap();
        (0..18)
            .filter(|ball| of_ball(*ball) == EllipseKind::Profile)
            .collect::<Vec<_>>()
    };
    assert_eq!(marked(spall(0.3e-3, 20e-6)), [0]);
    assert_eq!(marked(spall(4e-3, 3e-6)), [0]);
    assert!(marked(spall(4e-3, 1e-9)).is_empty());
    assert!(marked(wave(2)).is_empty());
    // 0.6 mm long, four to five half-widths.
    assert_eq!(marked(wave(390)).len(), 18);
    assert!(marked(Profiles::default()).is_empty());
}

/// Wrong: smooth strips on elastic rings would have another equilibrium than Hertz's law. Both settle to 1e-12 of their
/// forces, and agree to 1e-10.
#[test]
fn smooth_strips_on_elastic_rings_have_the_equilibrium_of_hertz() {
    let case = Case {
        radial: 800.0,
        ..Case::axial(2000.0)
    };
    let model = || {
        let mut model = case.flexible(ContactMode::Patch, Level::hex8(54, 6, 1, 2), Hold::MeanMotion);
        model.sphere = Default::default();
        model.tolerances.force = 1e-12;
        model
    };
    let (hertz, mut strips) = (model(), model());
    for side in Side::BOTH {
        let law = StripLaw::new(&strips.hertz[side.index()], strips.geometry.groove_radius(side));
        let smooth = StripSurface::new(law, (&strips.geometry, side), None, &Profiles::default());
        strips.surfaces.strips[side.index()] = Some(Arc::new(smooth.unwrap()));
    }
    let (a, b) = (equilibrium(&hertz), equilibrium(&strips));
    let largest = a.balls.iter().map(|ball| ball.inner.force_n).fold(0.0, f64::max);
    for (x, y) in a.balls.iter().zip(&b.balls) {
        for side in Side::BOTH {
            let off = x.contact(side).force_n - y.contact(side).force_n;
            assert!(off.abs() < 1e-10 * largest, "{off} of {largest}");
        }
    }
    let scale = a.displacements.shaft[2].abs();
    for (x, y) in a.displacements.shaft.iter().zip(&b.displacements.shaft) {
        assert!((x - y).abs() < 1e-10 * scale, "{x} {y}");
    }
}
