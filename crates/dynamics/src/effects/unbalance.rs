//! Unbalance of shaft and inner ring: a mass off the axis that turns with them.
//!
//! A mass m at the distance e from the axis, at the azimuth psi = angle + theta_i(t) in space, pulls on the shaft with
//!
//! ```text
//! F = -m d2/dt2 [ e (cos psi, sin psi) ] = m e ( Omega^2 e_r - A e_psi )
//! ```
//!
//! Omega the speed of the inner ring and A its acceleration. Off the plane of the inner groove centres it also tilts,
//! by position e_z x F; on the shaft of a list of bearings it pulls where it is. The mass itself is part of
//! `shaft.mass`; its motion with the shaft is the shaft's own inertia (e.g. Genta, Dynamics of Rotating Systems, 2005,
//! ch. 2: the Jeffcott rotor).
//!
//! The mean over a step of a motion is exact for any course of the speed: it is the change of m e d/dt (cos psi, sin
//! psi) over the step, so shaft and mass together keep their momentum to round-off. An equilibrium has the force of
//! its instant. A drive holds the speed, so the work of the force is its own.
//!
//! Rule of thumb: the force of a rotor of mass M balanced to G 2.5 (ISO 21940-11: e Omega = 2.5 mm/s, as for the
//! spindles of machine tools), M (e Omega) Omega, over the load; of an unbalance that is given, its own force m e
//! Omega^2.

use contact::Side;
use input::{ANGLE, LENGTH, MASS, Problems, Quantity};
use serde::Deserialize;

use super::loads::{Loads, Now};
use super::rules::{Case, PeakLoad, Remark, judge, share_of};
use super::table::{self, About, Context, Need, Setting, SpeedRole, Trial};
use crate::error::DynamicsError;
use crate::kinematics::Speed;
use crate::model::{Effect, Model};

const EXAMPLE: &str = r#"[effects.unbalance]             # needs [speed]
mass = "10 g"                   # a mass off the axis; it is part of shaft.mass
eccentricity = "5 mm"           # its distance from the axis: together 50 g mm
angle = "0 deg"                 # optional: its azimuth on the inner ring at t = 0, from +x towards +y; default 0
position = "0 mm"               # optional: where on the axis, from the plane of the inner groove centres, or along
                                # the shaft of a list of bearings; default 0
"#;

/// A heavier mass off the axis is a slip of the unit, kg.
const MAX_MASS: f64 = 1e3;
/// So is one that is farther from the axis, or from the bearing along it, m.
const MAX_LENGTH: f64 = 10.0;
/// Balance quality of spindles, e Omega, m/s.
const QUALITY: f64 = 2.5e-3;

/// The table of a scene.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, expecting = "the table [effects.unbalance]")]
pub struct UnbalanceTable {
    mass: Quantity<MASS>,
    eccentricity: Quantity<LENGTH>,
    angle: Option<Quantity<ANGLE>>,
    position: Option<Quantity<LENGTH>>,
}

impl UnbalanceTable {
    /// Where on the axis it is, m: from the plane of the inner groove centres, or along the shaft of several bearings.
    pub fn position(&self) -> f64 {
        self.position.as_ref().map_or(0.0, Quantity::si)
    }

    /// Mass times eccentricity, kg m.
    fn moment(&self) -> f64 {
        self.mass.si() * self.eccentricity.si()
    }
}

impl table::EffectTable for UnbalanceTable {
    fn about() -> About {
        About {
            name: "unbalance",
            example: EXAMPLE,
            speed: SpeedRole::Force,
            needs: &[Need::TurningInner],
            trial: Some(Trial {
                what: "10 g mm",
                keys: &[("mass", "10 g"), ("eccentricity", "1 mm")],
            }),
        }
    }

    fn advice(table: Option<&Self>, case: &Case<'_>) -> Vec<Remark> {
        let load = case.load.axial.max(case.load.radial);
        let speed = case.speed(Side::Inner);
        if !case.has_own_shaft || load == 0.0 || speed == 0.0 {
            return Vec::new();
        }
        let carried = case.model.carried_inertia().map_or(0.0, |body| body.mass);
        let rotor = case.model.shaft_mass + carried + case.inner_ring_mass();
        let (force, formula) = match table {
            Some(table) => (
                table.moment() * speed * speed,
                "the unbalance pulls with m e Omega^2 =",
            ),
            None => (
                rotor * QUALITY * speed,
                "shaft and inner ring balanced to G 2.5 pull with M (e Omega) Omega =",
            ),
        };
        let ratio = force / load;
        let estimate = format!("{formula} {force:.2} N, {}", share_of(ratio, "the load"));
        judge("unbalance", table.is_some(), ratio, &estimate)
    }

    fn check(&self, context: Context, problems: &mut Problems) {
        let mass = self.mass.si();
        problems.require(
            mass > 0.0 && mass <= MAX_MASS,
            "effects.unbalance.mass",
            &self.mass,
            "expected more than 0 and at most 1000 kg; without an unbalance leave the table out",
        );
        if let Some(all) = context.turning_mass.filter(|_| mass <= MAX_MASS) {
            problems.require(
                mass <= all,
                "effects.unbalance.mass",
                &self.mass,
                format!(
                    "expected at most {all} kg, all that turns: the mass off the axis is part of shaft.mass; \
                     check the unit of both"
                ),
            );
        }
        let eccentricity = self.eccentricity.si();
        problems.require(
            eccentricity > 0.0 && eccentricity <= MAX_LENGTH,
            "effects.unbalance.eccentricity",
            &self.eccentricity,
            "expected more than 0 and at most 10 m; the side of the axis is the key angle",
        );
        if let Some(position) = &self.position {
            problems.require(
                position.si().abs() <= MAX_LENGTH,
                "effects.unbalance.position",
                position,
                "expected at most 10 m from the plane of the inner groove centres, check its unit",
            );
        }
    }

    fn load(&self, setting: Setting<'_>) -> Result<Option<Box<dyn Effect>>, DynamicsError> {
        Ok(Some(Box::new(Unbalance {
            speed: setting.speeds.inner.clone(),
            moment: self.moment(),
            angle: self.angle.as_ref().map_or(0.0, Quantity::si),
            position: self.position(),
        })))
    }

    fn peak_load(&self, speed: f64) -> PeakLoad {
        PeakLoad {
            radial: self.moment() * speed * speed,
            ..PeakLoad::default()
        }
    }
}

/// A mass off the axis of shaft and inner ring.
pub struct Unbalance {
    /// Speed of the inner ring.
    pub speed: Speed,
    /// Mass times eccentricity, kg m.
    pub moment: f64,
    /// Azimuth on the inner ring at t = 0, rad.
    pub angle: f64,
    /// Axial distance from the plane of the inner groove centres, m.
    pub position: f64,
}

impl Unbalance {
    /// Force in space along x and y, N: the mean over an interval of `width` seconds about a time.
    fn force(&self, time: f64, width: f64) -> [f64; 2] {
        if width > 0.0 {
            let [start, end] = [-0.5, 0.5].map(|share| self.direction_rate(time + share * width));
            return [0, 1].map(|i| -self.moment * (end[i] - start[i]) / width);
        }
        let (sin, cos) = (self.angle + self.speed.angle(time)).sin_cos();
        let (speed, rate) = (self.speed.at(time), self.speed.rate(time));
        let [radial, tangential] = [speed * speed, -rate].map(|a| self.moment * a);
        [radial * cos - tangential * sin, radial * sin + tangential * cos]
    }

    /// Rate of the direction to the mass, d/dt (cos psi, sin psi), 1/s.
    fn direction_rate(&self, time: f64) -> [f64; 2] {
        let (sin, cos) = (self.angle + self.speed.angle(time)).sin_cos();
        let speed = self.speed.at(time);
        [-speed * sin, speed * cos]
    }
}

impl Effect for Unbalance {
    fn name(&self) -> &'static str {
        "unbalance"
    }

    fn add_loads(&self, _model: &Model, now: &Now, loads: &mut Loads) -> Result<(), DynamicsError> {
        let [x, y] = self.force(now.time, now.width);
        loads.add_shaft_force_at(self.position, [x, y, 0.0]);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOMENT: f64 = 5e-5;

    fn unbalance(speed: Speed) -> Unbalance {
        Unbalance {
            speed,
            moment: MOMENT,
            angle: 0.3,
            position: 0.0,
        }
    }

    /// Wrong: a slip of the unit, or a mass on the axis, would be computed.
    #[test]
    fn what_makes_no_sense_is_refused() {
        let context = Context {
            is_without_inertia: false,
            clock: input::Clock::Running,
            has_speed: [true, false],
            is_flexible: [false; 2],
            seat_diameters: [None; 2],
            has_expansion: [false; 2],
            has_lubricant: false,
            turning_mass: Some(2.0),
            parts_courses: None,
            has_ball_centrifugal: false,
        };
        let messages = |mass: &str, eccentricity: &str, position: &str| {
            let table = UnbalanceTable {
                mass: mass.parse().unwrap(),
                eccentricity: eccentricity.parse().unwrap(),
                angle: None,
                position: Some(position.parse().unwrap()),
            };
            let mut problems = Problems::default();
            table::EffectTable::check(&table, context, &mut problems);
            problems.into_texts()
        };
        assert!(messages("10 g", "5 mm", "-80 mm").is_empty());
        // All of a rotor may be off the axis, as that of Jeffcott.
        assert!(messages("2 kg", "1 um", "0 mm").is_empty());
        for (values, expected) in [
            (
                ["3 kg", "1 um", "0 mm"],
                "effects.unbalance.mass is 3 kg; expected at most 2 kg, all that turns: the mass off the axis is part \
                 of shaft.mass; check the unit of both",
            ),
            (
                ["0 g", "5 mm", "0 mm"],
                "effects.unbalance.mass is 0 g; expected more than 0 and at most 1000 kg; without an unbalance leave \
                 the table out",
            ),
            (
                ["10 g", "-5 mm", "0 mm"],
                "effects.unbalance.eccentricity is -5 mm; expected more than 0 and at most 10 m; the side of the axis \
                 is the key angle",
            ),
            (
                ["10 g", "5 mm", "11 m"],
                "effects.unbalance.position is 11 m; expected at most 10 m from the plane of the inner groove centres, \
                 check its unit",
            ),
        ] {
            let [mass, eccentricity, position] = values;
            assert_eq!(messages(mass, eccentricity, position), [expected]);
        }
    }

    fn close(found: [f64; 2], expected: [f64; 2], tolerance: f64) {
        let size = expected[0].hypot(expected[1]);
        let error = (found[0] - expected[0]).hypot(found[1] - expected[1]) / size;
        assert!(
            error < tolerance,
            "{found:?} instead of {expected:?}: {error:.1e}"
        );
    }

    /// Wrong: the size of the force, or it would not turn with the ring. A quarter of a turn later it points across.
    #[test]
    fn a_steady_force_of_m_e_omega_squared_turns_with_the_ring() {
        let of = unbalance(Speed::constant(200.0));
        let quarter = 0.25 * 2.0 * std::f64::consts::PI / 200.0;
        close(
            of.force(0.0, 0.0),
            [0.3f64.cos(), 0.3f64.sin()].map(|x| 2.0 * x),
            1e-15,
        );
        close(
            of.force(quarter, 0.0),
            [-0.3f64.sin(), 0.3f64.cos()].map(|x| 2.0 * x),
            1e-13,
        );
    }

    /// Wrong: the tangential force of a changing speed, or its sign: a mass that is sped up pulls back.
    #[test]
    fn a_changing_speed_pulls_back_along_the_path() {
        let of = unbalance(Speed::table(vec![0.0, 1.0], vec![0.0, 1e3]));
        // At t = 0 it does not turn yet: only -m e A e_psi is left.
        close(
            of.force(0.0, 0.0),
            [0.3f64.sin(), -0.3f64.cos()].map(|x| MOMENT * 1e3 * x),
            1e-15,
        );
    }

    /// Wrong: a motion would gain or lose momentum. Means over steps that pass the corners of the speed add up to the
    /// change of the mass's momentum, and short ones are the force of their instant.
    #[test]
    fn means_over_steps_add_up_to_the_change_of_momentum() {
        let of = unbalance(Speed::table(vec![0.2, 0.55], vec![10.0, 90.0]));
        let steps = (0..10).map(|i| of.force(0.05 + 0.1 * f64::from(i), 0.1));
        let sum = steps.fold([0.0; 2], |sum, f| [sum[0] + 0.1 * f[0], sum[1] + 0.1 * f[1]]);
        let (start, end) = (of.direction_rate(0.0), of.direction_rate(1.0));
        close(sum, [0, 1].map(|i| -MOMENT * (end[i] - start[i])), 1e-13);
        // The mean differs from the value in the middle by (Omega width)^2 / 24, and by round-off over (Omega width).
        close(of.force(0.4, 1e-5), of.force(0.4, 0.0), 1e-7);
    }
}
