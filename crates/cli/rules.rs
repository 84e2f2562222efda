//! Rules of thumb for `raceway check`: which effects a scene leaves off although they matter, and which it pays for although
//! they do not.
//!
//! Every rule is a ratio of what an effect brings to what is there without it, from closed forms of rigid rings. An effect
//! that is off is pointed out from a ratio of 1 % on, one that is on below 0.1 %. Estimates are good to a factor of about
//! two: they say where to look, and `raceway prices` measures.
//!
//! ```text
//! load of a ball         Q = F_a / (Z sin a) + 4.37 F_r / (Z cos a)     Stribeck's number for ball bearings
//! ball_centrifugal       m r omega_c^2 / Q
//! gyroscopic_moment      2 M_g / (D_w Q),  M_g = J omega_b omega_c sin a: force across the contact normal
//! friction holds         M_g < 0.02 Q D_w: else balls turn about the tangent of their path
//! cage_slip              balls keep rolling while F_a > 10 Z F_c                Hirano
//! frame_rotation         u / d: growth of the turning inner ring over the Hertz approach d = (Q / K)^(2/3);
//!                        u = rho omega^2 r^3 / E of a free ring, rho omega^2 r t^2 / (2 E) of one of thickness t on a solid shaft
//! gravity                weight of shaft, inner ring and balls over the load
//! flexibility            u / d: hoop stretch of a ring that nothing holds, u = Z Q cos a r / (2 pi E A)
//! damping                an undamped motion rings on: its transients outlive any run
//! shaft.z                0 is the just-touching state; grooves opposite each other are at -A sin a, A their distance
//! ```
//!
//! a is the free contact angle, which is lower than the one under load: Q is rather too large, angles too small.
//! References: Harris, Rolling Bearing Analysis, 4th ed., chapters 5, 7 and 13; Hirano, ASLE Trans. 8 (1965) 425;
//! Timoshenko, Strength of Materials II (thin turning ring).

use contact::Side;
use dynamics::Model;
use dynamics::kinematics::Kinematics;
use scene::{Analysis, Motion, Scene, Support};

/// Ratio from which an effect that is off is pointed out.
const MATTERS: f64 = 1e-2;
/// Ratio below which an effect that is on is pointed out.
const NEGLIGIBLE: f64 = 1e-3;
/// Stribeck's number: the most loaded ball of a bearing under a radial load carries 4.37 F_r / Z (Harris, chapter 7).
const STRIBECK: f64 = 4.37;
/// Axial load per ball over its centrifugal force below which balls skid (Hirano).
const HIRANO: f64 = 10.0;
/// Friction coefficient that holds a ball against its gyroscopic moment, M_g < 0.02 Q D_w (Harris, chapter 5).
const HOLD: f64 = 0.02;
/// Acceleration of the earth, m/s2.
const GRAVITY: f64 = 9.81;

/// What a scene is judged by.
struct Case<'a> {
    scene: &'a Scene,
    model: &'a Model,
    /// Load of a ball, N; 0 when no load is given.
    ball_load: f64,
    /// Axial and radial load at their peaks, N.
    load: [f64; 2],
    /// Largest speed of the inner ring, rad/s.
    speed: f64,
    /// Hertz approach of inner and outer contact under the load of a ball, m.
    approach: f64,
    /// cos and sin of the free contact angle.
    angle: [f64; 2],
}

/// What the rules of thumb say about the effects of a scene: a sentence each, with estimate and formula.
pub fn advice(scene: &Scene, model: &Model) -> Vec<String> {
    // Modes and imposed displacements alone have no load to compare with.
    let case = Case::new(scene, model);
    let mut lines = Vec::new();
    if case.ball_load > 0.0 {
        centrifugal(&case, &mut lines);
        gyroscopic(&case, &mut lines);
        skidding(&case, &mut lines);
        frame(&case, &mut lines);
        gravity(&case, &mut lines);
        flexibility(&case, &mut lines);
    }
    damping(&case, &mut lines);
    zero_of_the_shaft(scene, model, &mut lines);
    lines
}

/// Displacements count from the just-touching state, which is not the middle of the axial play.
fn zero_of_the_shaft(scene: &Scene, model: &Model, lines: &mut Vec<String>) {
    let geometry = &model.geometry;
    let angle = geometry.free_contact_angle();
    let play = geometry.groove_distance() * angle.sin();
    if scene.shaft.z != Motion::Locked || play <= 0.0 {
        return;
    }
    lines.push(format!(
        "shaft.z is \"locked\" at 0, where all balls just touch at the free contact angle of {:.2} deg; with the grooves \
         opposite each other, as in a deep groove bearing without thrust, it is shaft.z = \"{:.3} um\"",
        angle.to_degrees(),
        -1e6 * play
    ));
}

impl Case<'_> {
    fn new<'a>(scene: &'a Scene, model: &'a Model) -> Case<'a> {
        let geometry = &model.geometry;
        let (sin, cos) = geometry.free_contact_angle().sin_cos();
        let axial = scene.effects.axial_force.as_ref();
        let radial = scene.effects.radial_force.as_ref();
        let load = [
            axial.map_or(0.0, |f| f.value.abs() * f.schedule.peak()),
            radial.map_or(0.0, |f| f.value.value.abs() * f.schedule.peak()),
        ];
        let z = geometry.n_balls as f64;
        let ball_load = load[0] / (z * sin.max(f64::MIN_POSITIVE)) + STRIBECK * load[1] / (z * cos);
        let speeds = scene.speed.iter().flat_map(|s| &s.values);
        let stiffness = |side: Side| model.hertz[side.index()].stiffness;
        let approach = |side| (ball_load / stiffness(side)).powf(2.0 / 3.0);
        Case {
            scene,
            model,
            ball_load,
            load,
            speed: speeds.fold(0.0, |m, w| w.abs().max(m)),
            approach: 0.5 * (approach(Side::Inner) + approach(Side::Outer)),
            angle: [cos, sin],
        }
    }

    fn kinematics(&self) -> Kinematics {
        let slip = self.scene.effects.cage_slip.unwrap_or([0.0; 2]);
        Kinematics::new(&self.model.geometry, slip)
    }

    /// Centrifugal force of a ball, N.
    fn centrifugal_force(&self) -> f64 {
        let cage = self.kinematics().cage * self.speed;
        self.model.ball_mass() * self.model.geometry.ball_centre()[0] * cage * cage
    }

    fn axial_per_ball(&self) -> f64 {
        self.load[0] / self.model.geometry.n_balls as f64
    }

    /// Radius of the bottom of the inner groove, m, and the thickness of the inner ring there.
    fn inner_ring(&self) -> [f64; 2] {
        let b = &self.scene.bearing;
        let radius = 0.5 * b.inner_raceway_diameter;
        [radius, radius - 0.5 * b.bore_diameter]
    }
}

/// Says that an effect is off and matters, or on and does not.
fn judge(lines: &mut Vec<String>, name: &str, is_on: bool, ratio: f64, estimate: &str) {
    if !is_on && ratio >= MATTERS {
        lines.push(format!("{name} is off, but {estimate}"));
    }
    if is_on && ratio < NEGLIGIBLE {
        lines.push(format!("{name} is on, but {estimate}: it could be left off"));
    }
}

fn centrifugal(case: &Case<'_>, lines: &mut Vec<String>) {
    let force = case.centrifugal_force();
    let ratio = force / case.ball_load;
    let estimate = format!(
        "the centrifugal force of a ball, m r omega_c^2 = {force:.3} N, is {} of its load of about {:.0} N",
        percent(ratio),
        case.ball_load
    );
    judge(
        lines,
        "[effects.ball_centrifugal]",
        case.scene.effects.ball_centrifugal,
        ratio,
        &estimate,
    );
}

fn gyroscopic(case: &Case<'_>, lines: &mut Vec<String>) {
    let geometry = &case.model.geometry;
    let diameter = geometry.ball_diameter;
    let turning = case.kinematics();
    let inertia = case.model.ball_mass() * diameter * diameter / 10.0;
    let moment = inertia * turning.ball * turning.cage * case.speed * case.speed * case.angle[1];
    let ratio = 2.0 * moment / (diameter * case.ball_load);
    let estimate = format!(
        "the gyroscopic moment of a ball, J omega_b omega_c sin a = {moment:.2e} N m, asks for 2 M_g / D_w = {} of its load \
         as friction",
        percent(ratio)
    );
    let is_on = case.scene.effects.gyroscopic_moment.is_some();
    judge(lines, "[effects.gyroscopic_moment]", is_on, ratio, &estimate);
    let hold = HOLD * case.ball_load * diameter;
    if moment > hold {
        lines.push(format!(
            "friction may not hold the balls: the gyroscopic moment {moment:.2e} N m is more than {HOLD} Q D_w = {hold:.2e} N m \
             (Harris), and balls that turn with it are not modelled"
        ));
    }
}

fn skidding(case: &Case<'_>, lines: &mut Vec<String>) {
    let (force, axial) = (case.centrifugal_force(), case.axial_per_ball());
    let is_rolling = axial > HIRANO * force;
    if case.speed > 0.0 && !is_rolling && case.scene.effects.cage_slip.is_none() {
        lines.push(format!(
            "[effects.cage_slip] is off, but balls may skid: F_a / (Z F_c) = {:.1}, and pure rolling needs more than \
             {HIRANO:.0} (Hirano)",
            axial / force
        ));
    }
}

fn frame(case: &Case<'_>, lines: &mut Vec<String>) {
    let Some(body) = &case.scene.inner.body else {
        return;
    };
    let steel = &case.scene.materials.rings;
    let [radius, thickness] = case.inner_ring();
    let square = steel.density * case.speed * case.speed * radius / steel.young_modulus;
    let (growth, formula) = match body.support {
        Support::Clamped => (0.5 * square * thickness * thickness, "rho omega^2 r t^2 / (2 E)"),
        Support::MeanMotion => (square * radius * radius, "rho omega^2 r^3 / E"),
    };
    let ratio = growth * case.angle[0] / case.approach;
    let estimate = format!(
        "the turning inner ring grows by {formula} = {:.4} um, {} of the Hertz approach of about {:.2} um",
        1e6 * growth,
        percent(ratio),
        1e6 * case.approach
    );
    judge(
        lines,
        "[effects.frame_rotation]",
        case.scene.effects.frame_rotation,
        ratio,
        &estimate,
    );
}

fn gravity(case: &Case<'_>, lines: &mut Vec<String>) {
    let b = &case.scene.bearing;
    let [radius, _] = case.inner_ring();
    let area = std::f64::consts::PI * (radius * radius - 0.25 * b.bore_diameter * b.bore_diameter);
    let ring = case.scene.materials.rings.density * area * b.width;
    let balls = case.model.geometry.n_balls as f64 * case.model.ball_mass();
    let mass = case.model.shaft_mass + ring + balls;
    let load = case.load[0].max(case.load[1]);
    let ratio = mass * GRAVITY / load;
    let estimate = format!(
        "shaft, inner ring and balls weigh about m g = {:.1} N, {} of the load",
        mass * GRAVITY,
        percent(ratio)
    );
    let is_on = case.scene.effects.gravity.is_some();
    judge(lines, "[effects.gravity]", is_on, ratio, &estimate);
}

fn flexibility(case: &Case<'_>, lines: &mut Vec<String>) {
    let b = &case.scene.bearing;
    let young = case.scene.materials.rings.young_modulus;
    let z = case.model.geometry.n_balls as f64;
    let rings = [
        (
            "inner",
            &case.scene.inner,
            0.5 * b.inner_raceway_diameter,
            0.5 * b.bore_diameter,
        ),
        (
            "outer",
            &case.scene.outer,
            0.5 * b.outer_raceway_diameter,
            0.5 * b.outside_diameter,
        ),
    ];
    for (name, ring, raceway, held) in rings {
        let area = (raceway - held).abs() * b.width;
        let mean = 0.5 * (raceway + held);
        let stretch = z * case.ball_load * case.angle[0] * mean / (2.0 * std::f64::consts::PI * young * area);
        let ratio = stretch / case.approach;
        if ring.body.is_none() && ratio >= MATTERS {
            lines.push(format!(
                "{name}.flexible is false, but a ring that nothing holds stretches by Z Q cos a r / (2 pi E A) = {:.2} um, {} \
                 of the Hertz approach; less on a solid shaft or in a solid housing",
                1e6 * stretch,
                percent(ratio)
            ));
        }
    }
}

fn damping(case: &Case<'_>, lines: &mut Vec<String>) {
    let effects = &case.scene.effects;
    let is_damped = effects.contact_damping.is_some() || effects.rayleigh_damping.is_some();
    if matches!(case.scene.analysis, Analysis::Dynamic(_)) && !is_damped && changes_in_time(case.scene) {
        lines.push(
            "[effects.contact_damping] and [effects.rayleigh_damping] are off, but loads or speed change in time: what they \
             set ringing never dies away"
                .to_string(),
        );
    }
}

/// Whether loads, imposed motions or the speed change in time.
fn changes_in_time(scene: &Scene) -> bool {
    let steady = input::Schedule::Constant;
    let e = &scene.effects;
    e.axial_force.as_ref().is_some_and(|f| f.schedule != steady)
        || e.radial_force.as_ref().is_some_and(|f| f.schedule != steady)
        || e.moment.as_ref().is_some_and(|f| f.schedule != steady)
        || scene.speed.as_ref().is_some_and(|s| s.values.len() > 1)
}

fn percent(ratio: f64) -> String {
    let p = 100.0 * ratio;
    if p >= 0.1 {
        format!("{p:.1} %")
    } else {
        format!("{p:.1e} %")
    }
}
