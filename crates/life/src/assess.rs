//! From loads and damage to the numbers of `life.json`.

use std::f64::consts::{PI, TAU};

use contact::{BearingGeometry, Side};
use dynamics::kinematics::BothRings;
use scene::{Life, LifeGrooves, Scene, geometry};
use serde::Serialize;

use crate::damage::{Damage, MILLION, bearing_life, even_life, ring_life};
use crate::equivalent::EquivalentLoads;
use crate::error::LifeError;
use crate::lubrication::{life_factor, reliability_factor, viscosity_ratio};
use crate::rating::{CatalogueBearing, REFERENCE_GROOVES, STATIC_PRESSURE};

/// Exponent of life over load of ball bearings (ISO 281).
const LIFE_EXPONENT: f64 = 3.0;
/// Contact angle that no clearance of a deep groove bearing makes, deg.
const LARGEST_OF_CLEARANCE: f64 = 20.0;

/// Rating of a catalogue over that of the dimensions beyond which it is a slip of the unit.
const PLAUSIBLE_RATING: std::ops::RangeInclusive<f64> = 0.2..=5.0;

/// What a scene says of its bearing's life.
#[derive(Clone, Debug, PartialEq)]
pub struct Rated {
    /// Dimensions of the ratings.
    pub bearing: CatalogueBearing,
    /// The table `[life]`, or its defaults.
    pub life: Life,
    /// Dynamic rating C_r, N.
    pub dynamic: f64,
    /// Static rating C_0r, N.
    pub at_rest: f64,
    /// Fatigue load limit C_u, N.
    pub fatigue_limit: f64,
    /// Ratings of a ball on the raceways, Q_ci and Q_ce, N.
    pub raceways: BothRings,
}

impl Rated {
    /// Ratings of the bearing of a scene, computed or of its catalogue.
    pub fn of_scene(scene: &Scene) -> Result<Rated, LifeError> {
        let life = scene.life.unwrap_or_default();
        let bearing = catalogue_bearing(&geometry(scene), &life)?;
        let dynamic = life.rating.unwrap_or_else(|| bearing.dynamic_rating());
        let at_rest = life.static_rating.unwrap_or_else(|| bearing.static_rating());
        Ok(Rated {
            bearing,
            life,
            dynamic,
            at_rest,
            fatigue_limit: life
                .fatigue_limit
                .unwrap_or_else(|| bearing.fatigue_limit(at_rest)),
            raceways: bearing.raceway_ratings(dynamic),
        })
    }

    /// Where the ratings come from, a sentence each.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let ratings = [
            ("rating", self.life.rating, self.bearing.dynamic_rating()),
            (
                "static_rating",
                self.life.static_rating,
                self.bearing.static_rating(),
            ),
        ];
        for (key, given, own) in ratings {
            let odd = given.filter(|given| !PLAUSIBLE_RATING.contains(&(given / own)));
            notes.extend(odd.map(|given| {
                format!("life.{key} is {given} N, and the dimensions give {own:.0} N: check its unit")
            }));
        }
        if self.life.contact_angle.is_none() {
            let angle = self.bearing.contact_angle.to_degrees();
            // Clearance alone makes no larger angle.
            let deep_groove = match angle < LARGEST_OF_CLEARANCE {
                true => "; catalogues rate a deep groove bearing at 0 deg, life.contact_angle",
                false => "",
            };
            notes.push(format!(
                "nominal contact angle {angle:.2} deg: the free contact angle{deep_groove}"
            ));
        }
        notes
    }
}

fn catalogue_bearing(geometry: &BearingGeometry, life: &Life) -> Result<CatalogueBearing, LifeError> {
    let angle = life
        .contact_angle
        .unwrap_or_else(|| geometry.free_contact_angle());
    if angle > PI / 4.0 * (1.0 + 1e-12) {
        return Err(LifeError::ThrustBearing {
            angle: angle.to_degrees(),
        });
    }
    Ok(CatalogueBearing {
        n_balls: geometry.n_balls,
        ball_diameter: geometry.ball_diameter,
        pitch_diameter: geometry.pitch_diameter(),
        contact_angle: angle,
        groove_radii: match life.grooves {
            LifeGrooves::Own => Side::BOTH.map(|side| geometry.groove_radius(side)),
            LifeGrooves::Reference => REFERENCE_GROOVES.map(|ratio| ratio * geometry.ball_diameter),
        },
    })
}

/// What a bearing went through, at one point or over a history.
#[derive(Clone, Debug)]
pub struct Exposure {
    /// The bearing.
    pub rated: Rated,
    /// P, the cubic mean over the turns of a history, and P_0, the largest of one.
    pub equivalent: EquivalentLoads,
    /// Largest pressure of a contact, Pa.
    pub peak_pressure: f64,
    /// Mean speed of the rings against each other, rad/s; None where it is not known.
    pub speed: Option<f64>,
    /// Damage of the raceways, inner first.
    pub damage: [Damage; 2],
    /// What a reader must know, a sentence each.
    pub notes: Vec<String>,
}

/// Ratings and life of ISO 281, without a run.
#[derive(Clone, Debug, Serialize)]
pub struct CatalogueLife {
    /// Nominal contact angle, rad.
    pub contact_angle_rad: f64,
    /// Pitch diameter D_pw, m.
    pub pitch_diameter_m: f64,
    /// Dynamic rating C_r, N.
    pub c_r_n: f64,
    /// Static rating C_0r, N.
    pub c_0r_n: f64,
    /// Fatigue load limit C_u, N.
    pub c_u_n: f64,
    /// Dynamic equivalent load P, N; None without load.
    pub p_n: Option<f64>,
    /// Static equivalent load P_0, N.
    pub p_0_n: Option<f64>,
    /// C_0r over P_0.
    pub static_safety: Option<f64>,
    /// Basic rating life, revolutions.
    pub l10_revolutions: Option<f64>,
    /// Basic rating life, h; None without speed.
    pub l10_hours: Option<f64>,
    /// Life with a_1 and the a_ISO of P, revolutions.
    pub l_nm_revolutions: Option<f64>,
    /// Reliability, per cent.
    pub reliability: f64,
    /// Its factor a_1.
    pub a_1: f64,
    /// Viscosity ratio, at most 4; None where it is not known.
    pub kappa: Option<f64>,
    /// Speed of the rings against each other, rad/s; None where it is not known.
    pub speed_rad_per_s: Option<f64>,
    /// Why numbers are missing, and what they rest on.
    pub notes: Vec<String>,
}

/// One raceway.
#[derive(Clone, Debug, Serialize)]
pub struct RacewayLife {
    /// Rating of a ball on this raceway, Q_ci or Q_ce, N.
    pub q_c_n: f64,
    /// Equivalent force of a ball, N.
    pub q_e_n: f64,
    /// Basic reference rating life of the ring, revolutions.
    pub l10r_revolutions: Option<f64>,
    /// The same if all positions shared the damage.
    pub even_revolutions: Option<f64>,
    /// Life by position; left out where there are many points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positions: Option<PositionLives>,
}

/// Life of the positions of a raceway.
#[derive(Clone, Debug, Serialize)]
pub struct PositionLives {
    /// Azimuth in the frame of the ring, rad.
    pub azimuth_rad: Vec<f64>,
    /// Life if all positions were as this one, revolutions; None without damage.
    pub l10r_revolutions: Vec<Option<f64>>,
}

/// Ratings and life of ISO 281, and life of ISO 16281 from the forces of the balls.
#[derive(Clone, Debug, Serialize)]
pub struct Assessment {
    /// ISO 281.
    #[serde(flatten)]
    pub catalogue: CatalogueLife,
    /// Rating of a ball on the inner raceway, N.
    pub q_ci_n: f64,
    /// Rating of a ball on the outer raceway, N.
    pub q_ce_n: f64,
    /// Groove radii of these shares: `own` or `reference`.
    pub grooves: &'static str,
    /// Dynamic equivalent reference load, N.
    pub p_ref_n: Option<f64>,
    /// Basic reference rating life, revolutions of one ring against the other.
    pub l10r_revolutions: Option<f64>,
    /// The same, h; None without speed.
    pub l10r_hours: Option<f64>,
    /// Factor a_ISO of the reference load; None where it is not known.
    pub a_iso: Option<f64>,
    /// Modified reference rating life a_1 a_ISO L_10r, revolutions.
    pub l_nmr_revolutions: Option<f64>,
    /// The same, h.
    pub l_nmr_hours: Option<f64>,
    /// Largest pressure of a contact, Pa.
    pub peak_pressure_pa: f64,
    /// 4200 MPa over the largest pressure.
    pub pressure_safety: Option<f64>,
    /// Inner raceway.
    pub inner: RacewayLife,
    /// Outer raceway.
    pub outer: RacewayLife,
}

/// Life of ISO 281 under equivalent loads, where they are known, at a speed of the rings against each other, rad/s.
pub fn catalogue_life(rated: &Rated, loads: Option<EquivalentLoads>, speed: Option<f64>) -> CatalogueLife {
    let loads = loads.filter(|loads| loads.dynamic > 0.0);
    let life = loads.map(|loads| MILLION * (rated.dynamic / loads.dynamic).powf(LIFE_EXPONENT));
    let speed = speed.or(rated.life.speed).map(f64::abs);
    let mut notes = rated.notes();
    let kappa = viscosity_ratio(rated.life.oil.as_ref(), speed, rated.bearing.pitch_diameter);
    let a_1 = reliability_factor(rated.life.reliability).unwrap_or(1.0);
    let a_iso = loads.map(|loads| modification(rated, &kappa, loads.dynamic));
    if let Some(Err(reason)) = &a_iso {
        notes.push(format!("no a_ISO: {reason}"));
    }
    let factor = a_iso.and_then(Result::ok);
    CatalogueLife {
        contact_angle_rad: rated.bearing.contact_angle,
        pitch_diameter_m: rated.bearing.pitch_diameter,
        c_r_n: rated.dynamic,
        c_0r_n: rated.at_rest,
        c_u_n: rated.fatigue_limit,
        p_n: loads.map(|loads| loads.dynamic),
        p_0_n: loads.map(|loads| loads.at_rest),
        static_safety: loads.map(|loads| rated.at_rest / loads.at_rest),
        l10_revolutions: life,
        l10_hours: life.and_then(|life| hours(life, speed)),
        l_nm_revolutions: life.zip(factor).map(|(life, factor)| a_1 * factor * life),
        reliability: rated.life.reliability,
        a_1,
        kappa: kappa.ok(),
        speed_rad_per_s: speed,
        notes,
    }
}

/// Life of ISO 16281 beside that of ISO 281.
pub fn assess(exposure: &Exposure) -> Assessment {
    let rated = &exposure.rated;
    let mut catalogue = catalogue_life(rated, Some(exposure.equivalent), exposure.speed);
    catalogue.notes.extend(exposure.notes.iter().cloned());
    let life = finite(life_of(&exposure.damage));
    let reference = life.map(|life| reference_load(rated, life));
    let kappa = catalogue.kappa.ok_or(String::new());
    let a_iso = reference.and_then(|load| modification(rated, &kappa, load).ok());
    let modified = life
        .zip(a_iso)
        .map(|(life, factor)| catalogue.a_1 * factor * life);
    let speed = catalogue.speed_rad_per_s;
    let [inner, outer] = Side::BOTH.map(|side| raceway(rated, side, &exposure.damage[side.index()]));
    Assessment {
        q_ci_n: inner.q_c_n,
        q_ce_n: outer.q_c_n,
        grooves: match rated.life.grooves {
            LifeGrooves::Own => "own",
            LifeGrooves::Reference => "reference",
        },
        p_ref_n: reference,
        l10r_revolutions: life,
        l10r_hours: life.and_then(|life| hours(life, speed)),
        a_iso,
        l_nmr_revolutions: modified,
        l_nmr_hours: modified.and_then(|life| hours(life, speed)),
        peak_pressure_pa: exposure.peak_pressure,
        pressure_safety: finite(STATIC_PRESSURE / exposure.peak_pressure),
        catalogue,
        inner,
        outer,
    }
}

impl Assessment {
    /// The same without the lives of single positions.
    pub fn without_positions(mut self) -> Assessment {
        self.inner.positions = None;
        self.outer.positions = None;
        self
    }
}

/// P_ref = C_r / L_10r^(1/3), N.
pub fn reference_load(rated: &Rated, life: f64) -> f64 {
    rated.dynamic / (life / MILLION).powf(1.0 / LIFE_EXPONENT)
}

fn raceway(rated: &Rated, side: Side, damage: &[f64]) -> RacewayLife {
    let rating = rated.raceways[side.index()];
    let life = ring_life(damage);
    let n = damage.len() as f64;
    RacewayLife {
        q_c_n: rating,
        q_e_n: rating * (life / MILLION).powf(-1.0 / LIFE_EXPONENT),
        l10r_revolutions: finite(life),
        even_revolutions: finite(even_life(damage)),
        positions: Some(PositionLives {
            azimuth_rad: (0..damage.len()).map(|p| (p as f64 + 0.5) * TAU / n).collect(),
            l10r_revolutions: damage.iter().map(|damage| finite(MILLION / damage)).collect(),
        }),
    }
}

/// Factor a_ISO of a load, N; says why there is none.
pub fn modification(rated: &Rated, kappa: &Result<f64, String>, load: f64) -> Result<f64, String> {
    let contamination = rated.life.contamination;
    let contamination = contamination.ok_or("no contamination factor: life.contamination".to_string());
    let (contamination, kappa) = match (contamination, kappa.clone()) {
        (Err(one), Err(other)) => return Err(format!("{one}; {other}")),
        (contamination, kappa) => (contamination?, kappa?),
    };
    life_factor(kappa, contamination * rated.fatigue_limit / load)
}

/// Hours of a number of revolutions at a speed, rad/s.
fn hours(revolutions: f64, speed: Option<f64>) -> Option<f64> {
    speed.and_then(|speed| finite(revolutions * TAU / speed / 3600.0))
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Damage of two raceways weighed and added: conditions of a spectrum.
pub fn add_damage(sum: &mut [Damage; 2], weight: f64, damage: &[Damage; 2]) {
    for (sum, damage) in sum.iter_mut().zip(damage) {
        for (sum, damage) in sum.iter_mut().zip(damage) {
            *sum += weight * damage;
        }
    }
}

/// Life of raceways with this damage, revolutions.
pub fn life_of(damage: &[Damage; 2]) -> f64 {
    let lives = Side::BOTH.map(|side| ring_life(&damage[side.index()]));
    bearing_life(lives)
}
