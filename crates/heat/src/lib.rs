//! `raceway heat`: steady temperatures of a bearing from its friction and given conductances, with what they do to its
//! clearance and forces.
//!
//! Each round solves the equilibrium of the scene at its temperatures ([`balance`]), takes the friction of it
//! ([`torque`], or a torque that the scene gives), and finds the temperatures that this makes ([`network`]). The rings
//! are factored once. Cost: an equilibrium per round, some five rounds, up to ten with thick oil.

pub mod balance;
pub mod network;
pub mod torque;

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::Args;
use comm::print;
use contact::Side;
use dynamics::mounting::Clearance;
use dynamics::{Model, StaticSolution, StaticSolver};
use results::failure::Failure;
use results::survey::say_doubts;
use results::whole;
use scene::{
    Analysis, BODIES, FrictionLaw, Heat, Scene, build_model, doubts, geometry, model_with_rings, rolling,
};
use serde::Serialize;

use balance::{Balance, BalanceEnd, NotSteady, settle};
use network::{Network, OfBodies};
use torque::{Torque, of_load, of_oil, viscosity_at};

/// Name of the file of a balance.
pub const HEAT_FILE: &str = "heat.json";
/// Version of its keys.
const SCHEMA: u32 = 1;
/// 0 degC, K.
const CELSIUS_ZERO: f64 = 273.15;

/// What the command line asks for.
#[derive(Debug, Args)]
pub struct HeatCommand {
    /// Scene at rest with a table [heat].
    scene: PathBuf,
    /// Changes a value of the scene: path=value, such as heat.torque="0.1 N m".
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Folder of heat.json; without it nothing is written.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// The bearing in a round.
#[derive(Clone, Debug, Serialize)]
struct BearingState {
    /// Friction torque, N m: the power over the speed of the rings against each other.
    torque_n_m: f64,
    /// Part of the oil, N m; only by Palmgren's formula.
    #[serde(skip_serializing_if = "Option::is_none")]
    oil_torque_n_m: Option<f64>,
    /// Sum of the balls' forces on the inner ring, N.
    ball_forces_n: f64,
    /// Largest of them, N.
    largest_force_n: f64,
    /// Radial clearance, m.
    radial_clearance_m: f64,
    /// Free contact angle, rad.
    free_contact_angle_rad: f64,
}

/// The file `heat.json`.
#[derive(Serialize)]
struct HeatFile<'a> {
    heat_schema: u32,
    source: String,
    /// `given`, `free_balls` or `palmgren`.
    friction: &'static str,
    speed_rad_per_s: f64,
    bodies: [&'static str; 5],
    /// Heat that the surroundings take at the last temperatures, W.
    given_off_w: f64,
    #[serde(flatten)]
    balance: &'a Balance<BearingState>,
}

/// Finds the balance of a scene, prints and writes it; a runaway ends with an error after that.
pub fn heat(command: &HeatCommand) -> Result<(), Failure> {
    let path = &command.scene;
    let scene = Scene::load(path, &command.overrides)?;
    let heat = check(&scene, path)?.clone();
    let speed = speed_of(&scene, &heat, path)?;
    if let Some(out) = &command.out {
        whole::require_own(&out.join(HEAT_FILE), is_own)?;
    }
    let (model, _) = build_model(&scene)?;
    say_doubts(&doubts(&scene, &model));
    let mut solver = StaticSolver::new(&model).map_err(Failure::solving)?;
    let mut bearing = WarmBearing {
        command,
        model,
        solver: &mut solver,
        before: None,
        heat: &heat,
        speed,
    };
    let network = Network {
        conductances: &heat.conductances,
        ambient: heat.ambient,
    };
    let balance = settle(&network, heat.limit, |temperatures| {
        bearing.round(temperatures).map_err(RoundFailure::Bearing)
    });
    let balance = balance.map_err(RoundFailure::into_failure)?;
    print_balance(&balance, &heat, speed);
    let file = HeatFile {
        heat_schema: SCHEMA,
        source: path.display().to_string(),
        friction: match heat.friction {
            FrictionLaw::Given(_) => "given",
            FrictionLaw::FreeBalls => "free_balls",
            FrictionLaw::Palmgren { .. } => "palmgren",
        },
        speed_rad_per_s: speed,
        bodies: BODIES,
        given_off_w: network.given_off(balance.temperatures_k),
        balance: &balance,
    };
    if let Some(out) = &command.out {
        write(out, &file)?;
    }
    match balance.end {
        BalanceEnd::Steady => Ok(()),
        BalanceEnd::Runaway => Err(Failure::Numerical(anyhow!(runaway(&balance, &heat)))),
    }
}

/// What a runaway is told by.
fn runaway(balance: &Balance<BearingState>, heat: &Heat) -> String {
    let warmest = (0..5).max_by(|a, b| balance.temperatures_k[*a].total_cmp(&balance.temperatures_k[*b]));
    let warmest = warmest.unwrap_or(0);
    let gain = balance.gain.filter(|gain| *gain > 0.0);
    let gain = gain.map_or(String::new(), |gain| {
        format!(", with {gain:.2} W more friction for each W more of heat")
    });
    format!(
        "thermal runaway: after {} rounds, with a body at heat.limit of {:.0} degC, friction makes more heat than \
         flows off: the {} would go on to {:.0} degC{gain}; more clearance, less preload, less friction or larger \
         conductances help",
        balance.rounds.len(),
        heat.limit - CELSIUS_ZERO,
        ["inner ring", "outer ring", "balls", "shaft", "housing"][warmest],
        balance.temperatures_k[warmest] - CELSIUS_ZERO,
    )
}

/// The table of a scene that is at rest.
fn check<'a>(scene: &'a Scene, path: &Path) -> Result<&'a Heat, Failure> {
    if !matches!(scene.analysis, Analysis::Static) {
        return Err(anyhow!(
            "{} is no single equilibrium; a heat balance takes a scene with [static]",
            path.display()
        )
        .into());
    }
    if scene.materials.rings.expansion.is_none() || scene.materials.balls.expansion.is_none() {
        return Err(anyhow!(
            "{}: a heat balance needs the thermal expansion of rings and balls; add materials.rings.expansion and \
             materials.balls.expansion, such as \"11.5e-6 /K\" of bearing steel",
            path.display()
        )
        .into());
    }
    if let Some(body) = scene.bodies.iter().flatten().next() {
        return Err(anyhow!(
            "{} has the body {:?}, whose temperatures raceway heat does not know; remove [[body]], with \"clamped\" or \
             \"mean_motion\" as the support of its ring",
            path.display(),
            body.name
        )
        .into());
    }
    if scene.effects.temperature.is_some() {
        return Err(anyhow!(
            "{} has [effects.temperature], which raceway heat finds; remove it, or --set effects.temperature=none; its \
             reference and the expansions of shaft and housing are keys of [heat] too",
            path.display()
        )
        .into());
    }
    let missing = || {
        anyhow!(
            "{} has no [heat]; expected friction and conductances",
            path.display()
        )
    };
    Ok(scene.heat.as_ref().ok_or_else(missing)?)
}

/// Speed of the rings against each other, rad/s.
fn speed_of(scene: &Scene, heat: &Heat, path: &Path) -> Result<f64, Failure> {
    let of_scene = scene.speed.as_ref().map(|speeds| speeds.relative(0.0).abs());
    let speed = heat.speed.or(of_scene).filter(|speed| *speed > 0.0);
    let still = || {
        anyhow!(
            "{}: the rings do not turn against each other, so nothing rolls; heat is that of rolling balls",
            path.display()
        )
    };
    Ok(speed.ok_or_else(still)?)
}

/// The bearing of a scene at temperatures that change from round to round.
struct WarmBearing<'a> {
    command: &'a HeatCommand,
    /// The bearing of the round before.
    model: Model,
    solver: &'a mut StaticSolver,
    before: Option<StaticSolution>,
    heat: &'a Heat,
    speed: f64,
}

/// Why a round failed.
enum RoundFailure {
    Bearing(Failure),
    NotSteady(NotSteady),
}

impl From<NotSteady> for RoundFailure {
    fn from(error: NotSteady) -> RoundFailure {
        RoundFailure::NotSteady(error)
    }
}

impl RoundFailure {
    fn into_failure(self) -> Failure {
        match self {
            RoundFailure::Bearing(failure) => failure,
            RoundFailure::NotSteady(error) => Failure::Numerical(error.into()),
        }
    }
}

impl WarmBearing<'_> {
    /// Friction power, W, of the equilibrium at temperatures, K.
    fn round(&mut self, temperatures: OfBodies) -> Result<(f64, BearingState), Failure> {
        let at = |failure: Failure| {
            let celsius = temperatures.map(|kelvin| format!("{:.1}", kelvin - CELSIUS_ZERO));
            failure.context(format!(
                "with {} at {} degC",
                BODIES.join(", "),
                celsius.join(", ")
            ))
        };
        let given = self.command.overrides.iter().cloned();
        let overrides: Vec<String> = given.chain(settings(self.heat, temperatures)).collect();
        let scene = Scene::load(&self.command.scene, &overrides)?;
        let rings = self.model.rings.clone();
        self.model = model_with_rings(&scene, rings).map_err(|error| at(error.into()))?;
        let pose = rolling(&scene).map_or_else(Default::default, |rolling| rolling.pose(0.0));
        let solved = self.solver.solve_at(&self.model, &pose, self.before.as_ref());
        let solution = solved.map_err(|error| at(Failure::solving(error)))?;
        let clearance = self
            .model
            .mounting
            .report
            .as_ref()
            .map(|report| report.clearances.operating);
        let (torque, state) = self.state(&scene, &solution, temperatures, clearance);
        self.before = Some(solution);
        Ok((torque * self.speed, state))
    }

    /// Torque, N m, and what is known of the bearing.
    fn state(
        &self,
        scene: &Scene,
        solution: &StaticSolution,
        temperatures: OfBodies,
        clearance: Option<Clearance>,
    ) -> (f64, BearingState) {
        let forces = solution.balls.iter().map(|ball| ball.inner.force_n);
        let (sum, largest) = forces.fold((0.0, 0.0), |(sum, most): (f64, f64), force| {
            (sum + force, most.max(force))
        });
        let bearing = geometry(scene);
        let torque = match &self.heat.friction {
            FrictionLaw::Given(torque) => Torque {
                of_oil: 0.0,
                of_load: *torque,
            },
            FrictionLaw::FreeBalls => Torque {
                of_oil: 0.0,
                of_load: drive_power(scene, solution) / self.speed,
            },
            FrictionLaw::Palmgren {
                oil_factor,
                load_factor,
                oil,
            } => {
                let viscosity = viscosity_at(oil, 0.5 * (temperatures[0] + temperatures[1]));
                Torque {
                    of_oil: of_oil(*oil_factor, viscosity, self.speed, bearing.pitch_diameter()),
                    of_load: of_load(*load_factor, sum, bearing.pitch_diameter()),
                }
            }
        };
        let is_formula = matches!(self.heat.friction, FrictionLaw::Palmgren { .. });
        let state = BearingState {
            torque_n_m: torque.total(),
            oil_torque_n_m: is_formula.then_some(torque.of_oil),
            ball_forces_n: sum,
            largest_force_n: largest,
            radial_clearance_m: clearance.map_or_else(|| bearing.clearance(), |clearance| clearance.radial),
            free_contact_angle_rad: clearance.map_or_else(
                || bearing.free_contact_angle(),
                |clearance| clearance.free_contact_angle,
            ),
        };
        (torque.total(), state)
    }
}

/// Settings of `[effects.temperature]` at temperatures, K.
fn settings(heat: &Heat, temperatures: OfBodies) -> Vec<String> {
    let kelvin = |key: &str, kelvin: f64| format!("effects.temperature.{key}=\"{kelvin:.9} K\"");
    let bodies = BODIES.iter().zip(temperatures);
    let bodies = bodies.map(|(body, temperature)| kelvin(body, temperature));
    let reference = heat.reference.map(|reference| kelvin("reference", reference));
    let partners = ["shaft", "housing"].iter().zip(heat.partner_expansion);
    let partners = partners.filter_map(|(body, expansion)| {
        Some(format!(
            "effects.temperature.{body}_expansion=\"{:?} /K\"",
            expansion?
        ))
    });
    bodies.chain(reference).chain(partners).collect()
}

/// Power that the rings put into free balls, W.
fn drive_power(scene: &Scene, solution: &StaticSolution) -> f64 {
    let (Some(balls), Some(speeds)) = (&solution.steady, &scene.speed) else {
        return 0.0;
    };
    balls
        .friction()
        .drive_power(Side::BOTH.map(|side| speeds.of(side).at(0.0)))
}

fn print_balance(balance: &Balance<BearingState>, heat: &Heat, speed: f64) {
    let friction = match heat.friction {
        FrictionLaw::Given(_) => "given",
        FrictionLaw::FreeBalls => "that of the free balls",
        FrictionLaw::Palmgren { .. } => "Palmgren's formula",
    };
    print::line(format_args!(
        "heat balance at {:.0} rpm, friction: {friction}; temperatures of {} in degC",
        speed * 30.0 / std::f64::consts::PI,
        BODIES.join(", ")
    ));
    print::line(format_args!(
        "  {:>5}  {:<38}{:>12}{:>11}{:>16}{:>16}",
        "round", "temperatures", "torque", "power", "clearance", "largest force"
    ));
    let celsius = |temperatures: &OfBodies| {
        let each = temperatures.map(|kelvin| format!("{:.1}", kelvin - CELSIUS_ZERO));
        each.join("  ")
    };
    for (number, round) in balance.rounds.iter().enumerate() {
        let state = &round.bearing;
        print::line(format_args!(
            "  {:>5}  {:<38}{:>8.4} N m{:>9.2} W{:>13.2} um{:>14.1} N",
            number + 1,
            celsius(&round.temperatures_k),
            state.torque_n_m,
            round.power_w,
            1e6 * state.radial_clearance_m,
            state.largest_force_n
        ));
    }
    let end = match balance.end {
        BalanceEnd::Steady => "steady",
        BalanceEnd::Runaway => "runaway",
    };
    print::line(format_args!("  {end}: {} degC", celsius(&balance.temperatures_k)));
}

fn is_own(old: &[u8]) -> bool {
    whole::holds(old, "\"heat_schema\"")
}

fn write(out: &Path, file: &HeatFile<'_>) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(file).context("cannot format heat.json")? + "\n";
    whole::make_asked_folder(out)?;
    let path = out.join(HEAT_FILE);
    whole::write(&path, text.as_bytes(), is_own)?;
    print::line(format_args!("heat: {}", path.display()));
    Ok(())
}
