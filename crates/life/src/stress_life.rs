//! Life of a scene from the stress below its contacts, over that of the same bearing without fits, temperatures, seat
//! forms and speed.
//!
//! ```text
//! 1/L_s = n_s (2 pi R_s)^(1/e) d_s
//! d_s = mean of d over the balls (a ring that turns),   (mean of d^e)^(1/e) (a ring that stands)
//! ```
//!
//! d are the damages of passes ([`crate::risk`]), n_s the balls that pass a place per turn, R_s the radius of the
//! raceway. Both bearings have one material and one shape, so nothing but what was left out is in the ratio. Three
//! lives are compared: of the scene, of the reference, and both once more without stress of the rings, which is what
//! the loads alone do.

use std::f64::consts::TAU;
use std::path::Path;

use anyhow::anyhow;
use contact::{BySide, Side};
use dynamics::effects::SpeedRole;
use dynamics::{Model, StaticSolver};
use results::body_stress::{BodyUnderContact, under_contacts};
use results::failure::Failure;
use results::shown::Shown;
use scene::{Analysis, Scene, build_model, model_with_rings, rolling};
use serde::Serialize;

use crate::damage::{RingMotion, WEIBULL, bearing_life};
use crate::error::LifeError;
use crate::risk::damage_of_pass;
use crate::run::ring_motion;

/// Effects of mounting.
const MOUNTING: [&str; 3] = ["fit", "temperature", "seat_form"];

/// Life from stress as a ratio to that of the reference.
#[derive(Debug, Serialize)]
pub struct StressLife {
    /// What the reference is without.
    pub left_out: Vec<String>,
    /// Life over that of the reference.
    pub ratio: f64,
    /// The same if rings had no stress of their own: what the loads of the balls do.
    pub ratio_of_loads: f64,
    /// What the stress of the rings does: the first over the second.
    pub ratio_of_stress: f64,
    /// Inner raceway.
    pub inner: RacewayStressLife,
    /// Outer raceway.
    pub outer: RacewayStressLife,
    /// What a reader must know, a sentence each.
    pub notes: Vec<String>,
}

/// One raceway.
#[derive(Debug, Serialize)]
pub struct RacewayStressLife {
    /// Life over that of the reference.
    pub ratio: f64,
    /// Largest hoop stress of the ring as a body below a loaded contact, Pa.
    pub hoop_stress_pa: f64,
    /// The same of the reference, Pa.
    pub reference_hoop_stress_pa: f64,
}

/// Contacts of a bearing and the stress of its rings below them, inner first.
struct Stressed {
    contacts: BySide<Vec<BodyUnderContact>>,
    motion: BySide<RingMotion>,
    /// Balls that pass a place of each raceway per turn.
    passes: BySide<f64>,
    poisson_ratio: f64,
    /// Shear stress below which nothing happens, Pa.
    limit: f64,
}

/// Solves a scene and its reference.
pub fn from_stress(path: &Path, overrides: &[String]) -> Result<StressLife, Failure> {
    let scene = Scene::load(path, overrides)?;
    if !matches!(scene.analysis, Analysis::Static) {
        return Err(anyhow!(
            "{} is no single equilibrium; --stress takes a scene with [static], such as a point of its sweep by --set",
            path.display()
        )
        .into());
    }
    let (settings, left_out) = without(&scene);
    if settings.is_empty() {
        return Err(LifeError::NothingLeftOut.into());
    }
    let bare = [overrides, settings.as_slice()].concat();
    let reference = Scene::load(path, &bare)?;
    let (model, _) = build_model(&scene)?;
    let bare_model = model_with_rings(&reference, model.rings.clone())?;
    let mut notes: Vec<String> = model
        .mounting
        .report
        .iter()
        .flat_map(|report| report.warnings.clone())
        .collect();
    if !left_out.iter().any(|name| name == "speed") {
        notes.push(
            "nothing turns in this scene: the inner ring is taken to turn, the outer one to stand"
                .to_string(),
        );
    }
    let motion = ring_motion(&scene);
    let with = Stressed::new(&scene, &model, motion)?;
    let without = Stressed::new(&reference, &bare_model, motion)?;
    let found = compare(&with, &without, left_out, notes);
    match [found.ratio, found.ratio_of_loads]
        .iter()
        .all(|ratio| ratio.is_finite() && *ratio > 0.0)
    {
        true => Ok(found),
        false => Err(LifeError::BelowLimit {
            limit_mpa: 1e-6 * with.limit,
        }
        .into()),
    }
}

fn compare(with: &Stressed, without: &Stressed, left_out: Vec<String>, notes: Vec<String>) -> StressLife {
    let lives = |stressed: &Stressed, share: f64| Side::BOTH.map(|side| stressed.life(side, share));
    let (own, reference) = (lives(with, 1.0), lives(without, 1.0));
    let ratio = bearing_life(own) / bearing_life(reference);
    let ratio_of_loads = bearing_life(lives(with, 0.0)) / bearing_life(lives(without, 0.0));
    let [inner, outer] = Side::BOTH.map(|side| RacewayStressLife {
        ratio: own[side.index()] / reference[side.index()],
        hoop_stress_pa: with.hoop_stress(side),
        reference_hoop_stress_pa: without.hoop_stress(side),
    });
    StressLife {
        left_out,
        ratio,
        ratio_of_loads,
        ratio_of_stress: ratio / ratio_of_loads,
        inner,
        outer,
        notes,
    }
}

/// Settings that take fits, temperatures, seat forms and speed out of a scene, and their names.
fn without(scene: &Scene) -> (Vec<String>, Vec<String>) {
    let (mut settings, mut names) = (Vec::new(), Vec::new());
    for entry in scene
        .effects
        .list()
        .into_iter()
        .filter(|entry| entry.table().is_some())
    {
        let about = entry.about();
        if MOUNTING.contains(&about.name) || (about.speed != SpeedRole::None && scene.speed.is_some()) {
            settings.push(format!("effects.{}=none", about.name));
        }
        if MOUNTING.contains(&about.name) {
            names.push(about.name.to_string());
        }
    }
    if scene.speed.is_some() {
        settings.push("speed=none".to_string());
        if scene.lubricant.is_some() {
            settings.push("lubricant=none".to_string());
        }
        names.push("speed".to_string());
    }
    (settings, names)
}

impl Stressed {
    /// Finds the equilibrium of a scene.
    fn new(scene: &Scene, model: &Model, motion: [RingMotion; 2]) -> Result<Stressed, Failure> {
        let pose = rolling(scene).map_or_else(Default::default, |rolling| rolling.pose(0.0));
        let mut solver = StaticSolver::new(model).map_err(Failure::solving)?;
        let solution = solver.solve_at(model, &pose, None).map_err(Failure::solving)?;
        let shown = Shown::Equilibrium {
            model,
            placed: &model.geometry,
            solution: &solution,
        };
        let contacts = |side: Side| -> Result<_, Failure> {
            let found = under_contacts(&shown, side)?;
            let found = found.ok_or(LifeError::NoBody { side: side.name() })?;
            match found.iter().any(|contact| contact.patch.force > 0.0) {
                true => Ok(found),
                false => Err(LifeError::Unloaded.into()),
            }
        };
        let geometry = &model.geometry;
        let gamma = geometry.ball_diameter * geometry.free_contact_angle().cos() / geometry.pitch_diameter();
        let half = 0.5 * geometry.n_balls as f64;
        let [inner, outer] = Side::BOTH.map(contacts);
        Ok(Stressed {
            contacts: [inner?, outer?],
            motion,
            passes: [half * (1.0 + gamma), half * (1.0 - gamma)],
            poisson_ratio: scene.materials.rings.poisson_ratio,
            limit: scene.life.and_then(|life| life.shear_limit).unwrap_or(0.0),
        })
    }

    /// Life of a raceway, up to a factor of the material; `share`: of the stress of the ring as a body.
    fn life(&self, side: Side, share: f64) -> f64 {
        let i = side.index();
        let contacts = &self.contacts[i];
        let damage = |contact: &BodyUnderContact| {
            damage_of_pass(
                &contact.patch,
                contact.stress.map(|s| share * s),
                self.poisson_ratio,
                self.limit,
            )
        };
        let power = match self.motion[i] {
            RingMotion::Turns => 1.0,
            RingMotion::Stands => WEIBULL,
        };
        let sum: f64 = contacts.iter().map(|contact| damage(contact).powf(power)).sum();
        let mean = (sum / contacts.len() as f64).powf(1.0 / power);
        let radius = contacts.iter().map(|contact| contact.radius).sum::<f64>() / contacts.len() as f64;
        1.0 / (self.passes[i] * (TAU * radius).powf(1.0 / WEIBULL) * mean)
    }

    /// Largest hoop stress below a loaded contact, Pa.
    fn hoop_stress(&self, side: Side) -> f64 {
        let contacts = self.contacts[side.index()].iter();
        let loaded = contacts.filter(|contact| contact.patch.force > 0.0);
        loaded
            .map(|contact| contact.stress[1])
            .fold(f64::NEG_INFINITY, f64::max)
    }
}
