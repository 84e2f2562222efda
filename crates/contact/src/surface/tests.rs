//! Tests of surfaces and their envelopes.

use super::*;

/// Wrong: a ball would fall through a spall, or not sink at all. k_t L^2/8 in the middle of a deep spall with sharp
/// edges, the depth in a shallow one, and nothing beyond its ends.
#[test]
fn a_ball_sinks_by_its_sag() {
    let (spacing, curvature, length) = (1e-5, 195.0, 1e-3);
    let n = 2000;
    let spall = |depth: f64| -> Vec<f64> {
        let inside = |i: usize| ((i as f64 - 1000.0) * spacing).abs() < 0.5 * length;
        (0..n).map(|i| if inside(i) { depth } else { 0.0 }).collect()
    };
    let sag = curvature * length * length / 8.0;
    let deep = envelope(&spall(1e-3), spacing, curvature);
    assert!((deep[1000] / sag - 1.0).abs() < 1e-12, "{} {sag}", deep[1000]);
    let shallow = envelope(&spall(2e-6), spacing, curvature);
    assert!((shallow[1000] - 2e-6).abs() < 1e-18);
    assert_eq!([deep[949], deep[1051], shallow[0]], [0.0; 3]);
    // Rolling in over the edge is a parabola about it.
    let expected = 0.5 * curvature * (20.0 * spacing).powi(2);
    assert!((deep[970] / expected - 1.0).abs() < 1e-12);
}

/// Wrong: the envelope of smooth waves would lie off it. Exact for a parabola that is flatter than the ball:
/// min over t of A (s + t)^2/2 + k t^2/2 = A k/(A + k) s^2/2, to the square of the spacing.
#[test]
fn the_envelope_of_a_wave_is_exact() {
    let (n, k) = (4096, 195.0);
    let spacing = 0.23 / n as f64;
    let (order, amplitude) = (40.0, 2e-6);
    let wave: Vec<f64> = (0..n)
        .map(|i| -amplitude * (order * TAU * i as f64 / n as f64).cos())
        .collect();
    let found = envelope(&wave, spacing, k);
    // Newton for the touching point of the smooth wave.
    let number = order * TAU / 0.23;
    for (i, w) in found.iter().enumerate() {
        let s = i as f64 * spacing;
        let mut t = 0.0;
        for _ in 0..50 {
            let slope = amplitude * number * (number * (s + t)).sin() + k * t;
            t -= slope / (amplitude * number * number * (number * (s + t)).cos() + k);
        }
        let exact = -amplitude * (number * (s + t)).cos() + 0.5 * k * t * t;
        let chord = amplitude * (number * spacing).powi(2) / 8.0;
        assert!((w - exact).abs() <= chord, "{i}: {w} {exact}");
    }
}

/// Wrong: azimuths would not go round, or tables and spalls not add up.
#[test]
fn a_surface_goes_round_and_adds_its_profiles() {
    let geometry = BearingGeometry::reference_7010c();
    let law = StripLaw {
        stiffness: 1e10,
        density: 1e10,
        parabola_radius: 0.06,
        groove_radius: geometry.groove_radius(Side::Outer),
    };
    let profiles = Profiles {
        spalls: vec![Spall {
            azimuth: 0.0,
            groove_angle: 0.3,
            length: 4e-3,
            width: 2e-3,
            depth: 1e-6,
            edge: 0.1e-3,
        }],
        waves: vec![Wave {
            order: 2,
            amplitude: 3e-6,
            phase: 0.0,
        }],
        tables: vec![Heights {
            azimuths: vec![0.0, 0.5 * PI, PI, 1.5 * PI],
            angles: vec![0.0, 0.6],
            heights: vec![1e-6, 3e-6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        }],
    };
    let surface = StripSurface::new(law, (&geometry, Side::Outer), None, &profiles).unwrap();
    // A corner on the floor of the spall.
    let on_floor = |angle: &f64| (angle - 0.3).abs() * law.groove_radius < 0.85e-3;
    let place = surface.angles().iter().position(on_floor).unwrap();
    let inside = surface.angles()[place];
    let expected = 1e-6 - 3e-6 - (1e-6 + 2e-6 * inside / 0.6);
    let at = |azimuth: f64| surface.missing_at(azimuth)[place];
    assert!((at(0.0) - expected).abs() < 2e-9, "{} {expected}", at(0.0));
    for azimuth in [0.0, 0.01, 1.0, -0.02] {
        assert!((at(azimuth) - at(azimuth + TAU)).abs() < 1e-15);
    }
    let last = surface.missing_at(PI);
    assert!((last[0] + 3e-6).abs() < 1e-9, "{}", last[0]);
    assert!(surface.has_profile());
}

/// Wrong: a request for a grid that fits no memory would be tried.
#[test]
fn too_fine_a_surface_is_refused() {
    let geometry = BearingGeometry::reference_7010c();
    let hertz = crate::HertzContact::from_curvatures(14.0, 260.0, 113.7e9);
    let law = StripLaw::new(&hertz, geometry.groove_radius(Side::Outer));
    let profiles = Profiles {
        waves: vec![Wave {
            order: 1_000_000,
            amplitude: 1e-9,
            phase: 0.0,
        }],
        ..Profiles::default()
    };
    assert!(StripSurface::new(law, (&geometry, Side::Outer), None, &profiles).is_none());
}
