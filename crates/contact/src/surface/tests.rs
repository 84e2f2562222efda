//! Tests of surfaces and their envelopes.

use super::grid::envelope;
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
        ..Profiles::default()
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

/// The outer track of the 7010C.
fn outer() -> Track {
    Track::new(&BearingGeometry::reference_7010c(), Side::Outer)
}

fn dent() -> Dent {
    Dent {
        azimuth: 1.0,
        groove_angle: 0.3,
        diameter: 0.4e-3,
        depth: 10e-6,
        rim_height: 1e-6,
        rim_width: 0.1e-3,
    }
}

/// Wrong: a dent would have another shape than its formula: depth in the middle, the rim's height half-way across it,
/// nothing at its edges; and the volumes pi a^2 D/2 of the bowl and pi h b (a + b/2) of the rim, by a sum over a grid.
#[test]
fn a_dent_has_the_depth_and_the_volumes_of_its_formula() {
    let (track, dent) = (outer(), dent());
    let radius = track.radius(0.3);
    let at = |r: f64| dent.missing(track, 1.0 + r / radius, 0.3);
    let (a, b) = (0.5 * dent.diameter, dent.rim_width);
    for (r, expected) in [
        (0.0, 10e-6),
        (0.5 * a, 7.5e-6),
        (a, 0.0),
        (a + 0.5 * b, -1e-6),
        (a + b, 0.0),
    ] {
        assert!((at(r) - expected).abs() < 1e-15, "{r}: {} {expected}", at(r));
        assert!((at(-r) - expected).abs() < 1e-15);
        let across = dent.missing(track, 1.0, 0.3 + r / track.section_radius());
        assert!((across - expected).abs() < 1e-15, "{r}: {across} {expected}");
    }
    let cell = 1e-6;
    let n = (dent.reach() / cell) as isize + 2;
    let (mut bowl, mut rim) = (0.0, 0.0);
    for i in -n..=n {
        for k in -n..=n {
            let [x, y] = [i, k].map(|i| i as f64 * cell);
            let missing = dent.missing_at(x.hypot(y));
            bowl += missing.max(0.0) * cell * cell;
            rim -= missing.min(0.0) * cell * cell;
        }
    }
    let expected = [
        PI * a * a * dent.depth / 2.0,
        PI * dent.rim_height * b * (a + 0.5 * b),
    ];
    // The sum is off by the square of the cell over the radius at the kink.
    assert!((bowl / expected[0] - 1.0).abs() < 1e-4, "{bowl} {expected:?}");
    assert!((rim / expected[1] - 1.0).abs() < 1e-4, "{rim} {expected:?}");
}

/// Wrong: a dent would be lost between the corners and rows of the grid: the surface beside the points at which it is
/// computed, against the formula. The dent is so flat that the ball meets all of it, to the square of its slope. Chords
/// of a 24th of the radius leave 2 % of the depth at the kinks, a tenth of a percent in the bowl.
#[test]
fn the_grid_of_a_surface_shows_its_dents() {
    let geometry = BearingGeometry::reference_7010c();
    let hertz = crate::HertzContact::from_curvatures(14.0, 260.0, 113.7e9);
    let law = StripLaw::new(&hertz, geometry.groove_radius(Side::Outer));
    let flat = Dent {
        depth: 1e-10,
        rim_height: 1e-11,
        ..dent()
    };
    let profiles = Profiles {
        dents: vec![flat],
        ..Profiles::default()
    };
    let surface = StripSurface::new(law, (&geometry, Side::Outer), None, &profiles).unwrap();
    let radius = outer().radius(0.3);
    let mut worst = [0.0f64; 2];
    for i in -40..=40 {
        let x = 0.35e-3 * i as f64 / 40.3;
        let missing = surface.missing_at(1.0 + x / radius);
        for k in -40..=40 {
            let y = 0.35e-3 * k as f64 / 40.7;
            let angle = 0.3 + y / law.groove_radius;
            let next = surface.angles().partition_point(|a| *a <= angle);
            let [low, high] = [surface.angles()[next - 1], surface.angles()[next]];
            let found =
                missing[next - 1] + (missing[next] - missing[next - 1]) * (angle - low) / (high - low);
            let off = (found - flat.missing(outer(), 1.0 + x / radius, angle)).abs() / flat.depth;
            let is_bowl = x.hypot(y) < 0.9 * 0.5 * flat.diameter;
            worst[usize::from(is_bowl)] = worst[usize::from(is_bowl)].max(off);
        }
    }
    assert!(worst[0] < 0.02 && worst[1] < 1e-3, "{worst:?}");
    let far = surface.missing_at(1.1);
    assert!(far.iter().all(|w| *w == 0.0));
}

/// Wrong: a ball would fall through a dent, or not ride over its rim. In a bowl that is sharper than the ball it sinks
/// to k a^2/2 and no more; in a flat one to the depth, to the square of the grid. A rim holds it up, where its own
/// slope meets that of the rim: w is the least of -h sin^2(pi (r - a)/b) + k r^2/2. The rim's crest lifts it by h.
#[test]
fn a_ball_meets_the_envelope_of_a_dent() {
    let track = outer();
    let (angle, spacing) = (0.3, 1e-6);
    let curvature = track.curvature(angle);
    let met = |dent: Dent| {
        let n = 4001;
        let place = |i: usize| (i as f64 - 2000.0) * spacing / track.radius(angle);
        let heights: Vec<f64> = (0..n).map(|i| dent.missing(track, place(i), angle)).collect();
        envelope(&heights, spacing, curvature)
    };
    let at_zero = Dent {
        azimuth: 0.0,
        rim_height: 3e-6,
        ..dent()
    };
    let (a, b) = (0.5 * at_zero.diameter, at_zero.rim_width);
    let sharp = met(Dent {
        rim_height: 0.0,
        ..at_zero
    });
    let sag = 0.5 * curvature * a * a;
    assert!(at_zero.depth > sag);
    assert!((sharp[2000] / sag - 1.0).abs() < 1e-9, "{} {sag}", sharp[2000]);
    let flat = met(Dent {
        rim_height: 0.0,
        depth: 0.5 * sag,
        ..at_zero
    });
    assert!(
        (flat[2000] / (0.5 * sag) - 1.0).abs() < 1e-5,
        "{} {sag}",
        flat[2000]
    );
    let rim = met(at_zero);
    let held = |r: f64| -at_zero.rim_height * (PI * (r - a) / b).sin().powi(2) + 0.5 * curvature * r * r;
    let least = (0..10_000)
        .map(|i| held(a + b * f64::from(i) / 1e4))
        .fold(sag, f64::min);
    assert!((rim[2000] - least).abs() < 1e-3 * sag, "{} {least}", rim[2000]);
    assert!(rim[2000] < 0.9 * sag, "{} {sag}", rim[2000]);
    let crest = 2000 + ((a + 0.5 * b) / spacing).round() as usize;
    assert!((rim[crest] + at_zero.rim_height).abs() < 1e-12, "{}", rim[crest]);
}

/// Wrong: a contact in a dent would carry another load. In a dent wider than the ellipse and flatter than the ball
/// strips meet a groove of another curvature, 1/(2 R'') = 1/(2 R') - D/a^2, deeper by D: (4/3) c sqrt(2 R'')
/// (d - D)^1.5. Chords of the bowl leave a thousandth of D.
#[test]
fn a_contact_in_a_wide_dent_has_the_force_of_a_flatter_groove() {
    let geometry = BearingGeometry::reference_7010c();
    let hertz = crate::HertzContact::from_curvatures(14.0, 260.0, 113.7e9);
    let law = StripLaw::new(&hertz, geometry.groove_radius(Side::Outer));
    let wide = Dent {
        diameter: 4e-3,
        depth: 2e-6,
        rim_height: 0.0,
        rim_width: 0.0,
        ..dent()
    };
    let profiles = Profiles {
        dents: vec![wide],
        ..Profiles::default()
    };
    let surface = StripSurface::new(law, (&geometry, Side::Outer), None, &profiles).unwrap();
    let missing = surface.missing_at(wide.azimuth);
    let radius = 0.5 / (0.5 / law.parabola_radius - wide.depth / (0.5 * wide.diameter).powi(2));
    for d in [4e-6, 8e-6, 15e-6] {
        assert!((2.0 * radius * (d - wide.depth)).sqrt() < 0.5 * wide.diameter);
        let found = law.evaluate(surface.line(&missing), 0.0, d, wide.groove_angle);
        let expected = 4.0 / 3.0 * law.density * (2.0 * radius).sqrt() * (d - wide.depth).powf(1.5);
        let error = found.force / expected - 1.0;
        assert!(
            error.abs() < 1.5e-3 * wide.depth / (d - wide.depth),
            "{d}: {error}"
        );
        assert!(found.moment.abs() < 1e-6 * found.force * law.groove_radius);
    }
}

/// Wrong: a mark on a ball would come under a raceway at another time, or at another contact angle, than the ball turns
/// it there. The place of a dent in space, by Rodrigues' rotation about the axis of rolling, is on the normal of the
/// outer contact, or against that of the inner one, exactly where the surface has the whole depth.
#[test]
fn a_ball_turns_its_marks_under_both_raceways() {
    let geometry = BearingGeometry::reference_7010c();
    let equator = geometry.free_contact_angle();
    let (sin, cos) = equator.sin_cos();
    // In e_r, e_psi, e_z.
    let (axis, out) = ([sin, 0.0, -cos], [cos, 0.0, sin]);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    for (longitude, latitude) in [(0.0, 0.0), (0.7, 0.15), (4.0, -0.3)] {
        let depth = 1e-8;
        let dent = Dent {
            azimuth: longitude,
            groove_angle: latitude,
            diameter: 0.4e-3,
            depth,
            rim_height: 0.0,
            rim_width: 0.0,
        };
        let profiles = Profiles {
            dents: vec![dent],
            ..Profiles::default()
        };
        let (sin, cos) = f64::sin_cos(longitude);
        let turned = cross(axis, out);
        let (up, flat) = f64::sin_cos(latitude);
        let start = [0, 1, 2].map(|i| flat * (cos * out[i] + sin * turned[i]) - up * axis[i]);
        for side in Side::BOTH {
            let surface = BallSurface::new((&geometry, side), equator, &profiles).unwrap();
            let mut deepest = [0.0; 3];
            for i in 0..20_000 {
                let rolled = TAU * f64::from(i) / 20_000.0;
                let across = cross(axis, start);
                let along: f64 = (0..3).map(|k| axis[k] * start[k]).sum();
                let place = [0, 1, 2].map(|k| {
                    start[k] * rolled.cos()
                        + across[k] * rolled.sin()
                        + axis[k] * along * (1.0 - rolled.cos())
                });
                let towards = place.map(|x| side.sign() * x);
                if towards[1].abs() < 1e-3 && towards[0] > 0.0 {
                    let missing = surface.missing_at(rolled);
                    let line = surface.line(&missing);
                    let angle = towards[2].atan2(towards[0]);
                    let corner = line.angles.partition_point(|a| *a < angle - 1e-9);
                    if line.missing[corner] > deepest[0] {
                        deepest = [line.missing[corner], line.angles[corner] - angle, towards[1]];
                    }
                }
            }
            let [found, off, beside] = deepest;
            assert!(
                (found / depth - 1.0).abs() < 1e-2,
                "{side:?} {longitude}: {found}"
            );
            // Corners of the dent are 1.9e-3 rad apart.
            assert!(off.abs() < 2e-3 && beside.abs() < 1e-3, "{off} {beside}");
        }
    }
}

/// Wrong: a wave on a ball would be filtered as on a parallel far from the equator, where its slopes are steeper. At
/// the zero of the wave the raceway meets it too high by slope^2/(2 k_t), k_t = 1/r -+ cos(a)/rho.
#[test]
fn a_wave_of_a_ball_is_filtered_as_on_its_equator() {
    let geometry = BearingGeometry::reference_7010c();
    let (equator, radius) = (geometry.free_contact_angle(), 0.5 * geometry.ball_diameter);
    let (order, amplitude) = (12, 5e-7);
    let profiles = Profiles {
        waves: vec![Wave {
            order,
            amplitude,
            phase: 0.5 * std::f64::consts::PI,
        }],
        ..Profiles::default()
    };
    for side in Side::BOTH {
        let surface = BallSurface::new((&geometry, side), equator, &profiles).unwrap();
        let curvature = Track::on_ball(&geometry, side, equator).curvature(equator);
        let slope = order as f64 * amplitude / radius;
        let expected = -slope * slope / (2.0 * curvature);
        for off in [0.0, 0.02, -0.05] {
            let line = surface.missing_at(0.0);
            let angles = surface.line(&line).angles.to_vec();
            let i = angles.partition_point(|angle| *angle <= equator + off).max(1) - 1;
            let share = (equator + off - angles[i]) / (angles[i + 1] - angles[i]);
            let missing = line[i] + share * (line[i + 1] - line[i]);
            assert!(
                (missing / expected - 1.0).abs() < 0.05,
                "{side:?} {off}: {missing} {expected}"
            );
        }
    }
}

/// Wrong: a table of a ball would be read the wrong way round where the inner raceway meets it.
#[test]
fn a_table_of_a_ball_is_seen_by_both_raceways() {
    let geometry = BearingGeometry::reference_7010c();
    let profiles = Profiles {
        tables: vec![Heights {
            azimuths: vec![0.0, 2.0, 4.0],
            angles: vec![-0.2, 0.0, 0.3],
            heights: [-1e-9, 0.0, 2e-9].repeat(3),
        }],
        ..Profiles::default()
    };
    for side in Side::BOTH {
        let surface = BallSurface::new((&geometry, side), 0.25, &profiles).unwrap();
        let missing = surface.missing_at(1.234);
        for (angle, missing) in surface.line(&missing).angles.iter().zip(&missing) {
            let latitude = side.sign() * (angle - 0.25);
            let height = if latitude < 0.0 {
                5e-9 * latitude.max(-0.2)
            } else {
                latitude.min(0.3) / 0.3 * 2e-9
            };
            assert!(
                (missing + height).abs() < 1e-20,
                "{side:?} {angle}: {missing} {height}"
            );
        }
    }
}

/// Wrong: a ball that follows its path over a spall would change its normal velocity at mid-spall by anything else than
/// v k_t L: the slope of what it meets jumps from k_t L/2 to -k_t L/2. Slopes over 10 um beside the middle, which are
/// less by as much as the parabolas bend there; the 1 mm of the 7010C outside at 1800 rpm make 0.59 m/s.
#[test]
fn the_surface_kinks_at_mid_spall_by_the_curvature_times_the_length() {
    let geometry = BearingGeometry::reference_7010c();
    for (side, length) in [(Side::Outer, 1e-3), (Side::Outer, 0.5e-3), (Side::Inner, 1e-3)] {
        let (angle, azimuth) = (0.3415, 1.0);
        let track = Track::new(&geometry, side);
        let profiles = Profiles {
            spalls: vec![Spall {
                azimuth,
                groove_angle: angle,
                length,
                width: 4e-3,
                depth: 1e-3,
                edge: 0.0,
            }],
            ..Profiles::default()
        };
        let grid = profiles.grid(track, &(angle - 0.1..=angle + 0.1)).unwrap();
        // The corner nearest to the middle of the floor.
        let near = |a: &f64| (a - angle).abs();
        let corner = (0..grid.angles().len())
            .min_by(|a, b| near(&grid.angles()[*a]).total_cmp(&near(&grid.angles()[*b])))
            .unwrap();
        let own = grid.angles()[corner];
        let at = |place: f64| grid.missing_on(azimuth + place / track.radius(own), corner);
        let (near, step) = (10e-6, 10e-6);
        let slope = |sign: f64| sign * (at(sign * (near + step)) - at(sign * near)) / step;
        let jump = slope(-1.0) - slope(1.0);
        let k = track.curvature(own);
        let expected = k * (length - 2.0 * near - step);
        // The edges of the spall lie between points of the grid, 2.5 um apart.
        assert!(
            (jump / expected - 1.0).abs() < 1e-2,
            "{side:?}: {jump} {expected}"
        );
        if (side, length) == (Side::Outer, 1e-3) {
            // Two digits, and a corner beside the middle of the floor.
            assert!((3.034 * k * length - 0.59).abs() < 1e-2, "{}", 3.034 * k * length);
        }
    }
}
