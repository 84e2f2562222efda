//! Integrators on a free elastic ring, against modal theory.

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::support::Case;
use crate::support::rings::{Level, ring};
use contact::Side;
use dynamics::effects::{Effect, Loads, Now};
use dynamics::kinematics::Speed;
use dynamics::modes::ring_modes;
use dynamics::motion::{Integrator, Motion, MotionSettings, MotionState, StepCache};
use dynamics::{
    ContactMode, DynamicsError, Hold, Mode, Model, ModesSettings, RingModel, RingSupport, ShaftDof,
};

const SMALL: Level = Level::hex8(54, 6, 1, 2);
/// Largest displacement, m: contacts are 40 um away.
const AMPLITUDE: f64 = 1e-6;
/// Periods of the mode in a run, and instants at which it is looked at.
const PERIODS: f64 = 1.2;
const SAMPLES: usize = 60;

/// A load on the nodes of the outer ring from t = 0 on, N, `[n_nodes][3]` flat.
struct NodalStep(Vec<f64>);

impl Effect for NodalStep {
    fn name(&self) -> &'static str {
        "nodal_step"
    }

    fn add_loads(&self, _: &Model, _: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        loads.add_ring_load(Side::Outer, self.0.clone(), [0.0; 5]);
        Ok(())
    }
}

/// A free outer ring round two balls that nothing touches, under a load on its nodes.
fn lonely(ring: &Arc<RingModel>, load: Vec<f64>) -> Model {
    let mut model = Case::axial(0.0).rigid();
    model.contact.mode = ContactMode::Patch;
    model.rings = [None, Some(ring.clone())];
    model.effects = vec![Box::new(NodalStep(load))];
    model.geometry.n_balls = 2;
    model.geometry.inner_raceway_diameter -= 0.3e-3;
    let back = model.geometry.ball_centre().axial - model.geometry.groove_centre(Side::Inner).axial;
    model.shaft = [0.0, 0.0, back, 0.0, 0.0].map(ShaftDof::Prescribed);
    model
}

/// Displacements of the ring's nodes at the end of each of `n` steps, from rest, m, `[n][n_nodes][3]`.
fn response(model: &Model, integrator: Integrator, dt: f64, n: usize) -> Vec<Vec<f64>> {
    let settings = MotionSettings {
        integrator,
        ..MotionSettings::conserving(dt, Speed::constant(0.0))
    };
    let motion = Motion::new(model, settings).unwrap();
    let ShaftDof::Prescribed(back) = model.shaft[2] else {
        unreachable!()
    };
    let mut state = motion.rest([0.0, 0.0, back, 0.0, 0.0], [0.0; 5]);
    state.balls = vec![[-50e-6, 0.0].into(); 2];
    state = motion.with_accelerations(state).unwrap();
    let mut cache = StepCache::default();
    let mut step = |state: &mut MotionState| {
        *state = motion.step(state, &mut cache).unwrap().0;
        assert!(state.forces.iter().all(|f| f.norm() == 0.0), "a contact closed");
        motion.ring_displacement(state, Side::Outer).unwrap().0
    };
    (0..n).map(|_| step(&mut state)).collect()
}

fn modes(ring: &RingModel, number: usize) -> Vec<Mode> {
    let settings = ModesSettings {
        number,
        shift: None,
        backend: dynamics::Backend::Auto,
    };
    let set = ring_modes(Side::Outer, ring, RingSupport::Free, settings, &mut |_| ()).unwrap();
    set.modes
}

fn shape(mode: &Mode) -> &[f64] {
    mode.shape.rings[1].as_ref().unwrap()
}

/// M phi.
fn inertia(ring: &RingModel, shape: &[f64]) -> Vec<f64> {
    let mass = fem::assemble_mass(&ring.mesh, &ring.material).unwrap();
    let rows = mass.outer_iterator();
    rows.map(|row| row.iter().map(|(j, m)| m * shape[j]).sum())
        .collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn largest(u: &[f64]) -> f64 {
    u.iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// A mode under a step load in its own shape, and what the ring makes of it.
struct OneMode {
    ring: Arc<RingModel>,
    shape: Vec<f64>,
    inertia: Vec<f64>,
    modal_mass: f64,
    /// Natural angular frequency, rad/s.
    omega: f64,
    model: Model,
}

impl OneMode {
    /// The first elastic mode of the free outer ring: an oval.
    fn new() -> OneMode {
        let ring = Arc::new(ring(Side::Outer, SMALL, Hold::Free));
        let found = modes(&ring, 10);
        let mode = found.iter().find(|m| !m.is_rigid).unwrap();
        let shape = shape(mode).to_vec();
        let omega = TAU * mode.frequency;
        let inertia = inertia(&ring, &shape);
        let scale = 0.5 * AMPLITUDE * omega * omega;
        let model = lonely(&ring, inertia.iter().map(|x| scale * x).collect());
        OneMode {
            modal_mass: dot(&shape, &inertia),
            ring,
            shape,
            inertia,
            omega,
            model,
        }
    }

    /// F/omega^2 (1 - cos omega t).
    fn exact(&self, t: f64) -> f64 {
        0.5 * AMPLITUDE * (1.0 - (self.omega * t).cos())
    }

    /// Largest error of the mode over its amplitude at `SAMPLES` times of 1.2 periods when each takes `parts` steps;
    /// error at the end; largest share of other shapes.
    fn error(&self, integrator: Integrator, parts: usize) -> [f64; 3] {
        let n = SAMPLES * parts;
        let dt = PERIODS * TAU / self.omega / n as f64;
        let path = response(&self.model, integrator, dt, n);
        let [mut worst, mut last, mut others] = [0.0f64; 3];
        for (i, u) in path.iter().enumerate().skip(parts - 1).step_by(parts) {
            let q = dot(&self.inertia, u) / self.modal_mass;
            let rest: Vec<f64> = u.iter().zip(&self.shape).map(|(u, p)| u - q * p).collect();
            last = (q - self.exact((i + 1) as f64 * dt)) / AMPLITUDE;
            worst = worst.max(last.abs());
            others = others.max(largest(&rest) / AMPLITUDE);
        }
        [worst, last, others]
    }
}

/// Wrong: a setting would not have its order on a ring, its mass would not be that of the modes, or a load in one
/// mode would move another. Average acceleration is late by omega t (omega dt)^2/12 (Hughes, The Finite Element
/// Method, 9.3).
#[test]
fn every_setting_has_its_order_on_an_elastic_ring() {
    let case = OneMode::new();
    println!(
        "{} nodes, mode at {:.1} Hz",
        case.ring.mesh.n_nodes(),
        case.omega / TAU
    );
    let settings = [
        ("average_acceleration", Integrator::average_acceleration(), 2.0),
        ("chung_hulbert 0.8", Integrator::chung_hulbert(0.8), 2.0),
        ("chung_hulbert 0", Integrator::chung_hulbert(0.0), 2.0),
        ("hht 0.1", Integrator::hht(0.1), 2.0),
        ("newmark 0.25 0.5", Integrator::newmark(0.25, 0.5), 2.0),
        ("newmark 0.3025 0.6", Integrator::newmark(0.3025, 0.6), 1.0),
    ];
    for (name, integrator, order) in settings {
        let [coarse, fine] = [2, 4].map(|parts| case.error(integrator, parts));
        let rate = (coarse[0] / fine[0]).log2();
        println!(
            "{name}: error {:.3e}, {:.3e}, order {rate:.3}, other shapes {:.1e}, {:.1e}",
            coarse[0], fine[0], coarse[2], fine[2]
        );
        assert!((rate - order).abs() < 0.1, "{name}: order {rate}, not {order}");
        // What Lanczos leaves in the shape, above the round-off of the steps.
        assert!(coarse[2].max(fine[2]) < 1e-10, "{name}: {coarse:?} {fine:?}");
        if integrator.is_conserving() {
            let (angle, n) = (PERIODS * TAU, 4.0 * SAMPLES as f64);
            let late = angle * (angle / n).powi(2) / 12.0;
            let expected = -0.5 * late * angle.sin();
            assert!((fine[1] / expected - 1.0).abs() < 0.01, "{} {expected}", fine[1]);
        }
    }
}

/// Displacement of a ring from rest under a step load at a time, s, as the sum of its elastic modes.
fn superposition(modes: &[Mode], load: &[f64], t: f64) -> Vec<f64> {
    let mut u = vec![0.0; load.len()];
    for mode in modes.iter().filter(|m| !m.is_rigid) {
        let omega = TAU * mode.frequency;
        let still = dot(shape(mode), load) / (mode.modal_mass * omega * omega);
        let q = still * (1.0 - (omega * t).cos());
        u.iter_mut().zip(shape(mode)).for_each(|(u, p)| *u += q * p);
    }
    u
}

/// Wrong: a load on the raceway would not reach the modes, or higher modes would not move as they do. A radial
/// traction cos 2 theta on the raceway from t = 0 on, over half a period of the oval mode, against the sum of the
/// first 200 modes, up to 198 kHz. Those at 49 and 55 kHz are worth 2e-3; the rest is that of the series and of the
/// steps.
#[test]
fn a_suddenly_squeezed_ring_moves_as_its_modes() {
    let ring = Arc::new(ring(Side::Outer, SMALL, Hold::Free));
    let load = fem::surface::traction_load(&ring.mesh, ring.mesh.group("raceway"), |x, _| {
        let (sin, cos) = x[1].atan2(x[0]).sin_cos();
        let pressure = 1e4 * (cos * cos - sin * sin);
        [pressure * cos, pressure * sin, 0.0]
    });
    let found = modes(&ring, 200);
    let oval = found.iter().find(|m| !m.is_rigid).unwrap();
    let n = 600;
    let dt = 0.5 / oval.frequency / n as f64;
    let path = response(
        &lonely(&ring, load.clone()),
        Integrator::average_acceleration(),
        dt,
        n,
    );
    let (mut worst, mut most) = (0.0f64, 0.0f64);
    for (i, u) in path.iter().enumerate().skip(19).step_by(20) {
        let expected = superposition(&found, &load, (i + 1) as f64 * dt);
        let difference: Vec<f64> = u.iter().zip(&expected).map(|(a, b)| a - b).collect();
        worst = worst.max(largest(&difference));
        most = most.max(largest(u));
    }
    println!(
        "modes to {:.0} kHz; up to {most:.3e} m, difference {:.2e}",
        1e-3 * found.last().unwrap().frequency,
        worst / most
    );
    assert!(worst < 5e-4 * most, "{}", worst / most);
}
