//! The beam shaft against closed forms: statics, natural frequencies, gyroscopic moments.

use assembly::ShaftLoads;
use assembly::newton::{Mount, Problem, Scales, settle};
use assembly::stiffness::LinearAssembly;
use assembly::support::LinearSupport;
use assembly::whirl::equations;
use assembly::{Assembly, BeamSection, BeamShaft, Orientation, PointMass, Seating, ShaftBody};
use dynamics::whirl::{Whirl, WhirlMode};
use fem::Material;

use crate::near::assert_near;

const LENGTH: f64 = 0.5;
const OUTSIDE: f64 = 0.06;
const BORE: f64 = 0.03;

fn steel(density: f64) -> Material {
    Material::new(207e9, 0.3, density).unwrap()
}

fn beam(sections: Vec<BeamSection>, density: f64, longest: f64) -> BeamShaft {
    BeamShaft {
        sections,
        material: steel(density),
        longest_element: longest,
    }
}

fn section(length: f64) -> BeamSection {
    BeamSection {
        from: 0.0,
        to: length,
        outside: OUTSIDE,
        bore: BORE,
    }
}

/// E I, k G A.
fn rigidities(section: &BeamSection) -> [f64; 2] {
    let material = steel(7800.0);
    let shear = section.shear_coefficient(0.3) * material.shear_modulus() * section.area();
    [material.young_modulus * section.second_moment(), shear]
}

/// Displacements of the nodes on linear supports at positions, under a load at a position.
fn deflection(
    beam: &BeamShaft,
    supports: &[(f64, LinearSupport)],
    (position, load): (f64, [f64; 5]),
) -> (ShaftBody, Vec<f64>) {
    let stations: Vec<f64> = supports.iter().map(|(z, _)| *z).chain([position]).collect();
    let shaft = ShaftBody::beam(beam, &stations).unwrap();
    let mut loads = ShaftLoads::none(&shaft);
    loads.add(&shaft.station(position), load);
    let mounts: Vec<Mount> = supports
        .iter()
        .map(|(z, _)| Mount {
            name: format!("support at {z}"),
            place: Seating {
                position: *z,
                orientation: Orientation::PlusZ,
                shift: 0.0,
            },
            station: shaft.station(*z),
        })
        .collect();
    let problem = Problem {
        shaft: &shaft,
        load: &loads,
        mounts: &mounts,
        scales: Scales {
            step: 1.0,
            stiffness: 1e3,
            tilt_arm: 0.05,
            tolerance: 1e-10,
        },
    };
    let mut holders: Vec<LinearSupport> = supports.iter().map(|(_, support)| *support).collect();
    let settled = settle(&problem, &mut holders, &vec![0.0; shaft.n()]).unwrap();
    (shaft, settled.displacements)
}

/// Wrong: bending or shear stiffness, or the signs of the slopes in one of the planes. Hinges of 1e14 N/m yield by
/// 5e-12 of a deflection of 1e-6 m.
#[test]
fn a_hinged_beam_bends_as_the_textbook_says_with_shear() {
    let [ei, kga] = rigidities(&section(LENGTH));
    let force = 1000.0;
    let shaft = beam(vec![section(LENGTH)], 7800.0, 0.07);
    let hinge = LinearSupport::hinge(1e14);
    for axis in [0, 1] {
        let mut load = [0.0; 5];
        load[axis] = force;
        let ends = [(0.0, hinge), (LENGTH, hinge)];
        let (shaft, q) = deflection(&shaft, &ends, (0.5 * LENGTH, load));
        let middle = shaft.station(0.5 * LENGTH).displacement(&q)[axis];
        let bending = force * LENGTH.powi(3) / (48.0 * ei);
        assert_near(middle, bending + force * LENGTH / (4.0 * kga), 1e-6);
        // The slope of x is tilt_y, of y minus tilt_x.
        let slope = force * LENGTH.powi(2) / (16.0 * ei);
        let (tilt, sign) = if axis == 0 { (4, 1.0) } else { (3, -1.0) };
        assert_near(sign * q[tilt], slope, 1e-6);
        assert_near(sign * q[q.len() - 5 + tilt], -slope, 1e-6);
    }
}

/// Wrong: the share of shear in a clamped beam, the bar along z, or the sum of elements.
#[test]
fn a_cantilever_bends_shears_and_stretches_as_in_closed_form() {
    let own = section(LENGTH);
    let [ei, kga] = rigidities(&own);
    let mut clamp = LinearSupport::hinge(1e14);
    (clamp.stiffness[3][3], clamp.stiffness[4][4]) = (1e14, 1e14);
    let (force, moment, pull) = (-700.0, 30.0, 5000.0);
    for longest in [1.0, 0.03] {
        let shaft = beam(vec![own], 7800.0, longest);
        let load = [force, 0.0, pull, 0.0, moment];
        let (_, q) = deflection(&shaft, &[(0.0, clamp)], (LENGTH, load));
        let tip = &q[q.len() - 5..];
        let l = LENGTH;
        let x = force * l.powi(3) / (3.0 * ei) + force * l / kga + moment * l * l / (2.0 * ei);
        assert_near(tip[0], x, 1e-6);
        assert_near(tip[4], force * l * l / (2.0 * ei) + moment * l / ei, 1e-6);
        assert_near(tip[2] - q[2], pull * l / (207e9 * own.area()), 1e-6);
    }
}

/// Wrong: the weight of a stepped shaft would not be that of its mass.
#[test]
fn the_weight_is_that_of_all_sections() {
    let second = BeamSection {
        from: LENGTH,
        to: 0.6,
        outside: 0.04,
        bore: 0.0,
    };
    let shaft = ShaftBody::beam(&beam(vec![section(LENGTH), second], 7800.0, 0.05), &[0.11]).unwrap();
    let weight = shaft.weight([0.0, -9.81, 0.0]);
    let total: f64 = weight.chunks_exact(5).map(|node| node[1]).sum();
    let mass = 7800.0 * (section(LENGTH).area() * LENGTH + second.area() * 0.1);
    assert_near(total, -9.81 * mass, 1e-12);
    // Moment about x at z = 0: what the weights at their places make, y down is a positive turn about x.
    let moment: f64 = weight
        .chunks_exact(5)
        .zip(&shaft.nodes)
        .map(|(w, z)| w[3] - z * w[1])
        .sum();
    let arm = 7800.0 * (section(LENGTH).area() * LENGTH * 0.25 + second.area() * 0.1 * 0.55);
    assert_near(moment, 9.81 * arm, 1e-12);
}

/// Modes without bearings at a speed, rad/s.
fn modes(shaft: ShaftBody, speed: f64) -> Vec<WhirlMode> {
    let load = ShaftLoads::none(&shaft);
    let turning = shaft.clone();
    let assembly = Assembly {
        bearings: Vec::new(),
        shaft,
        load,
    };
    let linear = LinearAssembly::default();
    equations(&assembly, &turning, &linear, speed)
        .unwrap()
        .modes()
        .unwrap()
}

/// Holds x and y at both ends, and z and one end.
fn hinged(mut shaft: ShaftBody) -> ShaftBody {
    let last = shaft.n() - 5;
    for dof in [0, 1, 2, last, last + 1] {
        shaft.held[dof] = Some(0.0);
    }
    shaft
}

/// Wrong: the consistent mass or rotary inertia. The modes of a hinged Timoshenko beam are sines, so their frequencies
/// solve a quadratic equation. Errors fall with the fourth power of the length of the elements while shear is small; it
/// is constant in an element, which leaves an error of second order, small too.
#[test]
fn frequencies_of_a_hinged_beam_converge_to_timoshenkos() {
    let exact = |own: &BeamSection, number: f64| -> f64 {
        let [ei, kga] = rigidities(own);
        let (rho_a, rho_i) = (7800.0 * own.area(), 7800.0 * own.second_moment());
        let k = number * std::f64::consts::PI / LENGTH;
        let (a, b) = (rho_i * rho_a / kga, rho_a + k * k * (rho_i + rho_a * ei / kga));
        let c = ei * k.powi(4);
        let square = 2.0 * c / (b + (b * b - 4.0 * a * c).sqrt());
        square.sqrt() / std::f64::consts::TAU
    };
    let error = |own: BeamSection, n: usize, number: usize| {
        let shaft = ShaftBody::beam(&beam(vec![own], 7800.0, LENGTH / n as f64), &[]).unwrap();
        let planar = |m: &WhirlMode| m.whirl == Whirl::Planar;
        let found: Vec<_> = modes(hinged(shaft), 0.0).into_iter().filter(planar).collect();
        // Each in two planes.
        found[2 * (number - 1)].frequency / exact(&own, number as f64) - 1.0
    };
    let slender = BeamSection {
        outside: 0.004,
        bore: 0.0,
        ..section(LENGTH)
    };
    for (own, expected, most) in [(slender, 4.0, 1e-4), (section(LENGTH), 2.0, 1e-3)] {
        for number in [1, 2] {
            let (coarse, fine) = (error(own, 4, number), error(own, 8, number));
            let order = (coarse / fine).log2();
            println!("mode {number}: errors {coarse:.2e}, {fine:.2e}, order {order:.2}");
            assert!(
                fine > 0.0 && fine < most * number.pow(4) as f64,
                "mode {number}: {fine:e}"
            );
            assert!(order > expected - 0.2, "mode {number}: order {order}");
        }
    }
}

/// Wrong: masses at the ends of a free beam. A slender one has the frequencies of Euler and Bernoulli, (4.730041 / L)^2
/// sqrt(E I / rho A), less a share of the square of its slenderness.
#[test]
fn a_free_slender_beam_swings_as_euler_and_bernoulli_have_it() {
    let own = BeamSection {
        outside: 0.004,
        bore: 0.0,
        ..section(LENGTH)
    };
    let ei = 207e9 * own.second_moment();
    let mut shaft = ShaftBody::beam(&beam(vec![own], 7800.0, LENGTH / 20.0), &[]).unwrap();
    // A trace of stiffness, so that rigid motions have one.
    let n = shaft.n();
    (0..n)
        .step_by(5)
        .for_each(|i| (0..3).for_each(|k| shaft.stiffness[(n + 1) * (i + k)] += 1e-4));
    let omega = (4.730041 / LENGTH).powi(2) * (ei / (7800.0 * own.area())).sqrt();
    let exact = omega / std::f64::consts::TAU;
    let found = modes(shaft, 0.0);
    let first = found.iter().find(|m| m.frequency > 0.5 * exact).unwrap();
    assert_near(first.frequency, exact, 5e-4);
}

/// Wrong: masses on the shaft, or that a disc in the middle, which does not tilt, would feel the speed. Jeffcott's
/// rotor: the critical speed is sqrt(k / m) with the stiffness of the hinged shaft.
#[test]
fn the_critical_speed_of_a_jeffcott_rotor_is_that_of_its_disc_on_its_shaft() {
    let own = section(LENGTH);
    let [ei, kga] = rigidities(&own);
    let mut shaft = hinged(ShaftBody::beam(&beam(vec![own], 1e-6, LENGTH / 4.0), &[]).unwrap());
    let (mass, disc) = (12.0, 0.5 * LENGTH);
    shaft.add_mass(&PointMass {
        position: disc,
        mass,
        transverse: 0.02,
        polar: 0.04,
    });
    let compliance = LENGTH.powi(3) / (48.0 * ei) + LENGTH / (4.0 * kga);
    let critical = (1.0 / (compliance * mass)).sqrt();
    let found = modes(shaft, critical);
    for whirl in [Whirl::Forward, Whirl::Backward] {
        let bending: Vec<_> = found.iter().filter(|m| m.whirl == whirl).collect();
        let near = bending
            .iter()
            .map(|m| (m.frequency * std::f64::consts::TAU / critical - 1.0).abs())
            .fold(f64::MAX, f64::min);
        assert!(near < 1e-6, "{whirl:?}: off by {near:e}");
    }
}

/// Wrong: sign or size of the gyroscopic moment of a disc on a beam. Frequencies of an overhung disc on a shaft without
/// mass are zeros of a polynomial of fourth degree; those along the spin are positive.
#[test]
fn an_overhung_disc_whirls_as_in_closed_form() {
    let own = section(LENGTH);
    let [ei, kga] = rigidities(&own);
    let (mass, transverse, polar) = (8.0, 0.05, 0.1);
    let speed = 900.0;
    let mut shaft = ShaftBody::beam(&beam(vec![own], 1e-7, LENGTH / 3.0), &[]).unwrap();
    (0..5).for_each(|dof| shaft.held[dof] = Some(0.0));
    shaft.add_mass(&PointMass {
        position: LENGTH,
        mass,
        transverse,
        polar,
    });
    let phi = 12.0 * ei / (kga * LENGTH * LENGTH);
    let k = ei / (LENGTH.powi(3) * (1.0 + phi));
    let (k11, k12, k22) = (12.0 * k, 6.0 * k * LENGTH, (4.0 + phi) * k * LENGTH * LENGTH);
    let determinant =
        |w: f64| (k11 - mass * w * w) * (k22 - transverse * w * w + polar * speed * w) / (k12 * k12) - 1.0;
    let found = modes(shaft, speed);
    let lowest: Vec<_> = found.iter().filter(|m| m.whirl != Whirl::Axial).take(4).collect();
    let along = lowest.iter().filter(|m| m.whirl == Whirl::Forward).count();
    assert_eq!((lowest.len(), along), (4, 2));
    for mode in lowest {
        let sign = if mode.whirl == Whirl::Forward { 1.0 } else { -1.0 };
        let w = sign * std::f64::consts::TAU * mode.frequency;
        // Newton's distance to the zero.
        let slope = (determinant(w * (1.0 + 1e-6)) - determinant(w * (1.0 - 1e-6))) / (2e-6 * w);
        let off = (determinant(w) / (slope * w)).abs();
        assert!(
            off < 1e-6,
            "{:?} at {} Hz is off by {off:e}",
            mode.whirl,
            mode.frequency
        );
    }
}

/// Wrong: sections that make no shaft would be solved.
#[test]
fn sections_that_do_not_meet_and_places_off_the_shaft_are_refused() {
    let gap = BeamSection {
        from: 0.51,
        to: 0.6,
        ..section(LENGTH)
    };
    let text = |beam: BeamShaft, stations: &[f64]| ShaftBody::beam(&beam, stations).unwrap_err().to_string();
    assert_eq!(
        text(beam(vec![section(LENGTH), gap], 7800.0, 0.1), &[]),
        "sections 0 and 1 of the beam shaft do not meet: 10.000000 mm lie between them; expected ends that meet"
    );
    assert_eq!(
        text(beam(vec![section(LENGTH)], 7800.0, 0.1), &[0.6]),
        "the position 600.000000 mm is off the shaft; expected 0.000000 to 500.000000 mm, where its sections are"
    );
    let solid = BeamSection {
        bore: OUTSIDE,
        ..section(LENGTH)
    };
    assert!(text(beam(vec![solid], 7800.0, 0.1), &[]).contains("0 <= bore < outside"));
}
