//! A ring on its seat: pressure, and what the ring does, from interference and temperature.
//!
//! ```text
//! delta = I/2 + s e d/2      s = 1 for shafts, -1 for housings; e the strain of the partner less that of the ring
//! clamped       u = delta - c_p p,  p = k_r u + k_z e + q  ->  u = (delta - c_p (k_z e + q)) / (1 + c_p k_r)
//! mean motion   p = (delta - v) / (c + c_p),   rigid: the same with the tube from seat to groove bottom;  p >= 0
//! lets go       p(omega) = 0:   delta + s P omega^2 = (s G) omega^2
//! ```
//!
//! c_p is the give of the partner per pressure ([`super::tube`]); without a fit it is 0 and the partner keeps the round
//! form of a clamped seat at its own temperature. q and v are the pressure on a seat that is kept, and its motion where
//! it is free, of a ring whose temperature varies with the radius; a tube has none about its mean. P and G are the
//! growth of the partner's and the ring's seat per square of the speed; only the mean pressure moves the partner.

use std::f64::consts::TAU;
use std::sync::Arc;

use comm::Communicator;
use contact::{Meridian, Side};
use fem::Material;
use ring::{Hold, OwnStress, RadialProfile, RingModel, SeatAction, SeatField};

use super::conditions::{Conditions, Fit, SeatForm};
use super::tube::Tube;
use super::unmounted::Unmounted;
use crate::error::DynamicsError;

/// Places round the circumference at which the pressure of a seat is looked at.
const PLACES: usize = 720;
/// Nodes for each wave of a seat below which the wave of the groove is off by more than some per cent.
const NODES_PER_WAVE: f64 = 6.0;

/// What is known of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeatReport {
    /// Diametral interference at the bearing's temperatures, m; negative is clearance.
    pub interference: f64,
    /// Mean pressure, Pa.
    pub pressure: f64,
    /// Growth of the radius of the groove bottom, m.
    pub groove_growth: f64,
    /// Speed at which the ring lets go of its partner, rad/s; None: at no speed.
    pub loosening_speed: Option<f64>,
}

/// A ring on its seat, mounted.
#[derive(Clone)]
pub struct MountedSeat {
    /// Mean motion of the groove [radial, axial], m.
    pub groove: Meridian,
    /// Displacement of a flexible ring; None: none.
    pub field: Option<Arc<Vec<f64>>>,
    /// Its stress besides that of the displacement; None: none.
    pub own_stress: Option<Arc<OwnStress>>,
    /// What is known of its fit, if there is one.
    pub report: Option<SeatReport>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

/// A ring and its partner.
#[derive(Debug)]
pub struct RingSeat {
    side: Side,
    /// Diameter of bore or seat, m.
    diameter: f64,
    /// Largest speed of the ring, rad/s.
    speed: f64,
    /// Yield strength, Pa; None: not compared.
    yield_strength: Option<f64>,
    /// Tube from seat to groove bottom.
    tube: Tube,
    fit: Option<(Fit, Tube)>,
    answer: SeatAnswer,
    forms: Vec<FormField>,
    /// Forms for whose waves the seat has few nodes, as warnings.
    coarse: Vec<String>,
    /// What the ring does by its own strain about the mean; None: it has none.
    own: Option<Arc<SeatField>>,
}

/// What temperatures do to a seat.
#[derive(Clone, Copy, Debug, Default)]
pub struct SeatStrain {
    /// Strain of the partner less that of the ring.
    pub partner: f64,
    /// Share of the ring's own strain about its mean: 1 warm, 0 at the reference temperature.
    pub own: f64,
}

/// How a ring answers its partner.
#[derive(Debug)]
enum SeatAnswer {
    /// As a tube.
    Rigid,
    /// A clamped seat: moved into the ring, and stretched along the axis.
    Clamped([Arc<SeatField>; 2]),
    /// A seat in its mean motion, pressed; None without a fit.
    Pressed(Option<Arc<SeatField>>),
}

/// A form of the seat, and what 1 m of it does.
type FormField = (SeatForm, Arc<SeatField>);

/// Pressure of a seat, and the fields that it is made of.
struct Equilibrium {
    pressure: f64,
    parts: Vec<(Arc<SeatField>, f64)>,
}

impl RingSeat {
    /// The seat of a ring that strains by itself, if it does, by `own` about its mean; a flexible one finds its fields.
    pub fn new(
        bearing: &Unmounted,
        conditions: &Conditions,
        side: Side,
        own: Option<RadialProfile>,
    ) -> Result<RingSeat, DynamicsError> {
        let i = side.index();
        let forms: Vec<SeatForm> = conditions
            .seat_forms
            .iter()
            .copied()
            .filter(|f| f.side == side)
            .collect();
        let fit = conditions.fits[i];
        let coarse = match bearing.rings[i].as_deref() {
            Some(ring) => coarse_waves(side, ring, &forms)?,
            None => Vec::new(),
        };
        let is_clamped = |ring: &RingModel| ring.hold == Hold::Clamped;
        let (answer, forms) = match bearing.rings[i].as_deref() {
            Some(ring) if is_clamped(ring) => {
                let needs = fit.is_some() || conditions.temperatures.is_some() || !forms.is_empty();
                match needs {
                    true => clamped(bearing, side, ring, forms)?,
                    false => (SeatAnswer::Rigid, Vec::new()),
                }
            }
            _ if !forms.is_empty() => return Err(DynamicsError::SeatFormNotClamped { side: side.name() }),
            Some(ring) => {
                let fields = match fit {
                    Some(_) => fields(bearing, side, ring, &[SeatAction::Pressure])?,
                    None => Vec::new(),
                };
                (SeatAnswer::Pressed(fields.into_iter().next()), Vec::new())
            }
            None => (SeatAnswer::Rigid, Vec::new()),
        };
        let own = match (&own, bearing.rings[i].as_deref()) {
            (Some(strain), Some(ring)) => {
                let action = SeatAction::OwnStrain(strain.clone());
                fields(bearing, side, ring, &[action])?.into_iter().next()
            }
            _ => None,
        };
        Ok(RingSeat {
            side,
            diameter: bearing.seat_diameters[i],
            speed: bearing.speeds[i],
            yield_strength: bearing.yield_strength,
            own,
            tube: ring_tube(bearing, side),
            fit: fit.map(|fit| (fit, partner_tube(bearing, side, fit))),
            answer,
            forms,
            coarse,
        })
    }

    /// The seat mounted.
    pub fn mounted(&self, strain: SeatStrain) -> Result<MountedSeat, DynamicsError> {
        let mut mounted = self.equilibrium(strain)?;
        let groove = match &self.answer {
            SeatAnswer::Rigid => Meridian::new(mounted.pressure * self.tube.growth(), 0.0),
            _ => Meridian::from([0, 1].map(|c| {
                let parts = mounted.parts.iter();
                parts.map(|(field, size)| size * field.groove[c]).sum()
            })),
        };
        self.check_stress(mounted.pressure)?;
        self.check_waves(mounted.pressure)?;
        let waves = self
            .forms
            .iter()
            .map(|(form, field)| (field.clone(), form.amplitude));
        mounted.parts.extend(waves);
        let report = self.fit.as_ref().map(|_| SeatReport {
            interference: 2.0 * self.interference(strain),
            pressure: mounted.pressure,
            groove_growth: groove.radial,
            loosening_speed: self.loosening_speed(strain),
        });
        if let Some(report) = &report {
            self.check_speed(report)?;
        }
        Ok(MountedSeat {
            groove,
            field: sum(&mounted.parts),
            own_stress: self.own.as_ref().and_then(|own| own.own_stress.clone()),
            warnings: [self.coarse.clone(), self.warnings(mounted.pressure, strain)].concat(),
            report,
        })
    }

    /// Half of the interference of free bodies, m.
    fn interference(&self, strain: SeatStrain) -> f64 {
        let given = self.fit.as_ref().map_or(0.0, |(fit, _)| fit.interference);
        let free = 0.5 * (given - self.side.sign() * strain.partner * self.diameter);
        match &self.own {
            Some(own) => free - strain.own * own.into_ring,
            None => free,
        }
    }

    /// Pressure on a clamped seat that stays where it is, Pa.
    fn kept_pressure(&self, stretch: &SeatField, strain: SeatStrain) -> f64 {
        let along = stretch.pressure * strain.partner;
        match &self.own {
            Some(own) => along + strain.own * own.pressure,
            None => along,
        }
    }

    /// Give of the partner per pressure, m/Pa.
    fn give(&self) -> f64 {
        self.fit.as_ref().map_or(0.0, |(_, partner)| partner.give())
    }

    fn equilibrium(&self, strain: SeatStrain) -> Result<Equilibrium, DynamicsError> {
        let (delta, give) = (self.interference(strain), self.give());
        let own = self.own.iter().map(|own| (own.clone(), strain.own));
        let own = own.filter(|(_, size)| *size != 0.0);
        match &self.answer {
            SeatAnswer::Clamped([radial, stretch]) => {
                let kept = self.kept_pressure(stretch, strain);
                let moved = (delta - give * kept) / (1.0 + give * radial.pressure);
                let pressure = radial.pressure * moved + kept;
                if self.fit.is_some() && pressure <= 0.0 {
                    return Err(DynamicsError::LooseFit {
                        side: self.side.name(),
                        interference_um: 2e6 * delta,
                        missing_um: -2e6 * (delta + kept / radial.pressure),
                    });
                }
                let parts = [(radial, moved), (stretch, strain.partner)];
                let parts = parts.into_iter().filter(|(_, size)| *size != 0.0);
                let parts = parts.map(|(field, size)| (field.clone(), size));
                Ok(Equilibrium {
                    pressure,
                    parts: parts.chain(own).collect(),
                })
            }
            SeatAnswer::Rigid | SeatAnswer::Pressed(_) => {
                let field = match &self.answer {
                    SeatAnswer::Pressed(field) => field.as_ref(),
                    _ => None,
                };
                let give = give + field.map_or(self.tube.give(), |field| field.into_ring);
                let pressure = match self.fit {
                    Some(_) => (delta / give).max(0.0),
                    None => 0.0,
                };
                Ok(Equilibrium {
                    pressure,
                    parts: field
                        .map(|field| (field.clone(), pressure))
                        .into_iter()
                        .chain(own)
                        .collect(),
                })
            }
        }
    }

    /// Speed at which the mean pressure vanishes, rad/s.
    fn loosening_speed(&self, strain: SeatStrain) -> Option<f64> {
        let (_, partner) = self.fit.as_ref()?;
        // Growth into the ring.
        let sign = -self.side.sign();
        let partner_growth = sign * partner.spun();
        let delta = self.interference(strain);
        // What the pressure without speed would move the seat by, and the growth of the ring per square of the speed.
        let (delta, growth) = match &self.answer {
            SeatAnswer::Clamped([radial, stretch]) => (
                delta + self.kept_pressure(stretch, strain) / radial.pressure,
                radial.spin / radial.pressure,
            ),
            SeatAnswer::Pressed(Some(field)) => (delta, field.spin),
            SeatAnswer::Rigid | SeatAnswer::Pressed(None) => (delta, sign * self.tube.spun()),
        };
        let square = delta / (growth - partner_growth);
        (square > 0.0).then(|| square.sqrt())
    }

    /// Fails where the ring turns, which lets go at any speed.
    pub fn check_turning(&self, report: &SeatReport) -> Result<(), DynamicsError> {
        match self.speed > 0.0 {
            true => Err(self.lets_go(report, 0.0)),
            false => Ok(()),
        }
    }

    fn lets_go(&self, report: &SeatReport, limit: f64) -> DynamicsError {
        DynamicsError::FitLetsGo {
            side: self.side.name(),
            speed_rpm: self.speed * 60.0 / TAU,
            limit_rpm: limit * 60.0 / TAU,
            interference_um: 1e6 * report.interference,
        }
    }

    fn check_speed(&self, report: &SeatReport) -> Result<(), DynamicsError> {
        match report.loosening_speed {
            Some(limit) if self.speed >= limit && report.pressure > 0.0 => Err(self.lets_go(report, limit)),
            _ => Ok(()),
        }
    }

    /// Fails where the pressure of a fit makes the ring yield, as a tube.
    fn check_stress(&self, pressure: f64) -> Result<(), DynamicsError> {
        let (Some(_), Some(limit)) = (&self.fit, self.yield_strength) else {
            return Ok(());
        };
        let stress = pressure * self.tube.tresca();
        match stress > limit {
            true => Err(DynamicsError::FitYields {
                side: self.side.name(),
                pressure_mpa: 1e-6 * pressure,
                stress_mpa: 1e-6 * stress,
                limit_mpa: 1e-6 * limit,
            }),
            false => Ok(()),
        }
    }

    /// Fails where waves of the seat lift the ring off it.
    fn check_waves(&self, mean: f64) -> Result<(), DynamicsError> {
        if self.fit.is_none() || self.forms.is_empty() {
            return Ok(());
        }
        let pressure = |place: usize| {
            let azimuth = TAU * place as f64 / PLACES as f64;
            let waves = self.forms.iter().map(|(form, field)| {
                let phase = form.order as f64 * (azimuth - form.azimuth);
                form.amplitude * field.pressure * phase.cos()
            });
            mean + waves.sum::<f64>()
        };
        let lifted = (0..PLACES).filter(|&place| pressure(place) < 0.0).count();
        match lifted {
            0 => Ok(()),
            _ => Err(DynamicsError::SeatLifts {
                side: self.side.name(),
                percent: 100.0 * lifted as f64 / PLACES as f64,
            }),
        }
    }

    fn warnings(&self, pressure: f64, strain: SeatStrain) -> Vec<String> {
        let side = self.side.name();
        let clearance = -2e6 * self.interference(strain);
        if self.fit.is_some() && pressure == 0.0 && clearance >= 0.0 {
            // An interference of 0 leaves -0.
            let clearance = clearance.abs();
            return vec![format!(
                "the {side} ring has a clearance of {clearance:.2} um on its seat: nothing presses it there, and it is \
                 held as if it could not move in it"
            )];
        }
        if self.fit.is_none() && pressure < 0.0 {
            return vec![format!(
                "temperature pulls the clamped seat of the {side} ring with {:.1} MPa: a real one lets go unless its \
                 interference is larger; say how large it is by [effects.fit.{side}]",
                -1e-6 * pressure
            )];
        }
        Vec::new()
    }
}

/// Warnings of forms for whose waves the seat has few nodes. Fails where nodes take a wave for another one.
fn coarse_waves(side: Side, ring: &RingModel, forms: &[SeatForm]) -> Result<Vec<String>, DynamicsError> {
    let nodes = TAU / ring.held_spacing();
    // Of two nodes for each wave, a wave between them is zero at both.
    let most = (0.5 * nodes * (1.0 - 1e-6)).floor() as usize;
    let side = side.name();
    let mut warnings = Vec::new();
    for &SeatForm { order, .. } in forms {
        let per_wave = nodes / order as f64;
        if order > most {
            return Err(DynamicsError::SeatFormTooFine {
                side,
                order,
                per_wave,
                most,
            });
        }
        if per_wave < NODES_PER_WAVE * (1.0 - 1e-6) {
            warnings.push(format!(
                "[[effects.seat_form]] of order {order} has {per_wave:.1} nodes for each wave round the seat of the \
                 {side} ring: below {NODES_PER_WAVE:.0} the groove takes over too little of it, with 4 by a tenth less"
            ));
        }
    }
    Ok(warnings)
}

/// Fields of a clamped ring.
fn clamped(
    bearing: &Unmounted,
    side: Side,
    ring: &RingModel,
    forms: Vec<SeatForm>,
) -> Result<(SeatAnswer, Vec<FormField>), DynamicsError> {
    let mut actions = vec![SeatAction::Radial, SeatAction::Stretch];
    actions.extend(forms.iter().map(|form| SeatAction::Wave {
        order: form.order,
        high: form.azimuth,
    }));
    let mut fields = fields(bearing, side, ring, &actions)?;
    let waves = fields.split_off(2);
    let [radial, stretch] = [fields[0].clone(), fields[1].clone()];
    Ok((
        SeatAnswer::Clamped([radial, stretch]),
        forms.into_iter().zip(waves).collect(),
    ))
}

fn fields(
    bearing: &Unmounted,
    side: Side,
    ring: &RingModel,
    actions: &[SeatAction],
) -> Result<Vec<Arc<SeatField>>, DynamicsError> {
    if Communicator::world().size() > 1 {
        return Err(DynamicsError::MountedOnRanks { side: side.name() });
    }
    Ok(ring.seat_fields(bearing.settings(side), actions)?)
}

/// The ring as a tube from its seat to the bottom of its groove.
fn ring_tube(bearing: &Unmounted, side: Side) -> Tube {
    let [seat, other] = bearing.tube_radii(side);
    Tube {
        seat,
        other,
        material: bearing.ring_material,
    }
}

/// Shaft or housing.
fn partner_tube(bearing: &Unmounted, side: Side, fit: Fit) -> Tube {
    let steel = bearing.ring_material;
    Tube {
        seat: 0.5 * bearing.seat_diameters[side.index()],
        other: 0.5 * fit.partner_diameter,
        material: Material {
            young_modulus: fit.young_modulus.unwrap_or(steel.young_modulus),
            poisson_ratio: fit.poisson_ratio.unwrap_or(steel.poisson_ratio),
            density: fit.density.unwrap_or(steel.density),
        },
    }
}

/// Sum of fields; None of none.
fn sum(parts: &[(Arc<SeatField>, f64)]) -> Option<Arc<Vec<f64>>> {
    let n = parts.first()?.0.displacement.len();
    let mut sum = vec![0.0; n];
    for (field, size) in parts {
        let terms = sum.iter_mut().zip(field.displacement.iter());
        terms.for_each(|(sum, w)| *sum += size * w);
    }
    Some(Arc::new(sum))
}
