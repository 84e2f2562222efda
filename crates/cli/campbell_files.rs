//! What `raceway campbell` of one bearing and of a list have in common: what they refuse, and what they write.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::anyhow;
use comm::print;
use contact::{BearingGeometry, Side};
use dynamics::balls::BallResult;
use dynamics::kinematics::{RingSpeeds, SlipRatios};
use dynamics::whirl::WhirlMode;
use dynamics::{Model, StaticSolution};
use results::campbell::{CAMPBELL_LINES, CAMPBELL_TABLE, ModesAtSpeed, print_campbell, write_campbell};
use results::failure::Failure;
use results::summary::print_warnings;
use results::whole::make_asked_folder;
use scene::{Analysis, Scene, SeveralScene, rolling};

use crate::linear_figures::draw;

/// Damping ratio below which a mode counts as one that grows.
///
/// Loads that follow the contact angles, such as the gyroscopic moment that friction carries, and moments about axes
/// that stay in space make the stiffness unsymmetric: of a pair without damping one whirl grows and the other decays,
/// by up to some 1e-4 (`docs/stiffness.md`). Real bearings damp by more: (0.25 to 2.5)e-5 s of their stiffness (Kramer,
/// Dynamics of Rotors and Foundations, 1993), so by 1e-3 or more from 130 Hz on.
pub const GROWS: f64 = -1e-3;

/// Force over the largest below which the stiffness of a ball is too far from those of the others to be taken as one
/// that changes smoothly round the bearing.
const HARDLY_LOADED: f64 = 0.01;

/// Share of shaft and bodies in the kinetic energy up to which a mode is one of balls alone, of which there are many.
const OF_BALLS: f64 = 0.02;

/// Keeps the lowest modes that swing and in which the shaft or a body takes part, and all before them that grow by
/// themselves.
pub fn keep_modes_of_shaft(modes: &mut Vec<WhirlMode>, number: usize) {
    let is_of_shaft = |mode: &WhirlMode| mode.shaft_share + mode.standing_share > OF_BALLS;
    modes.retain(|mode| mode.damping_ratio < GROWS || (mode.swings() && is_of_shaft(mode)));
    modes.truncate(number);
}

/// How fast the balls of a bearing go round with the cage at a time in s, rad/s; 0 without a speed.
pub fn cage_speed(scene: &Scene, time: f64) -> f64 {
    rolling(scene).map_or(0.0, |rolling| rolling.cage_speed(time))
}

/// The same of all bearings of a list, each in its own frame.
pub fn cage_speeds(scene: &SeveralScene, time: f64) -> Vec<f64> {
    let bearings = scene.bearings.iter();
    bearings.map(|bearing| cage_speed(&bearing.scene, time)).collect()
}

/// Refuses speeds of a shaft that turns backwards in a ring that turns: that is another machine than the one whose
/// shaft turns forwards.
pub fn require_forward(speed: Option<&RingSpeeds>, time: f64) -> Result<(), Failure> {
    let Some([inner, outer]) = speed.map(|speed| Side::BOTH.map(|side| speed.of(side).at(time))) else {
        return Ok(());
    };
    if inner >= 0.0 || outer == 0.0 {
        return Ok(());
    }
    let [inner, outer] = [inner, outer].map(|speed| speed * 30.0 / PI);
    Err(Failure::User(anyhow!(
        "speed.inner is {inner:.0} rpm and speed.outer {outer:.0} rpm, and the speeds of the shaft in modes are \
         positive; expected speed.inner above 0: give both speeds the other sign"
    )))
}

/// What a user should know of a mode that grows, by its number among those shown; `forces` are the ball forces of each
/// bearing, N.
pub fn growing(rpm: f64, modes: &[WhirlMode], forces: &[Vec<f64>]) -> Option<String> {
    let number = modes.iter().position(|mode| mode.damping_ratio < GROWS)?;
    let text = format!(
        "{rpm} rpm: mode {} grows by itself, with a damping ratio of {:.1e}",
        number + 1,
        modes[number].damping_ratio
    );
    let doubt = "balls go from full load to next to none, and modes, in which their stiffness changes smoothly round \
                 the bearing, tell that badly; a motion shows whether it does";
    let is_doubtful = forces.iter().any(|forces| {
        let most = forces.iter().copied().fold(0.0, f64::max);
        forces.iter().any(|force| *force < HARDLY_LOADED * most)
    });
    match is_doubtful {
        true => Some(format!("{text}; doubtful: {doubt}")),
        false => Some(text),
    }
}

/// The larger force of each ball of each bearing, N.
pub fn ball_forces<'s>(bearings: impl IntoIterator<Item = &'s StaticSolution>) -> Vec<Vec<f64>> {
    let larger = |ball: &BallResult| ball.inner.force_n.max(ball.outer.force_n);
    let of_balls = |bearing: &StaticSolution| bearing.balls.iter().map(larger).collect();
    bearings.into_iter().map(of_balls).collect()
}

/// What a user should know where a scene asks for the stiffness by the stress of turning rings.
pub fn without_stress<'m>(models: impl IntoIterator<Item = &'m Model>) -> Option<String> {
    let stiffens = |model: &Model| Side::BOTH.into_iter().any(|side| model.is_stiffened(side));
    let text = "modes over the speed are without effects.frame_rotation.stress_stiffening: their rings yield without \
                inertia of their own, which would take back most of what the stress of turning holds";
    models.into_iter().any(stiffens).then(|| text.to_string())
}

/// Modes of a beam or of elastic bodies that are shown where nobody says how many.
pub const MODES_OF_BEAM: usize = 10;

/// A diagram, and what a reader should know of it.
pub struct Diagram {
    /// Modes at all speeds.
    pub modes: Vec<ModesAtSpeed>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// A remark on the lines of cage and balls.
    pub note: Option<String>,
    /// What the damping ratios have in them.
    pub damping_note: String,
}

/// Refuses a sweep.
pub fn require_one_point(analysis: &Analysis, scene: &Path) -> Result<(), Failure> {
    let Analysis::Sweep(sweep) = analysis else {
        return Ok(());
    };
    Err(Failure::User(anyhow!(
        "{} has a [sweep] of {}; expected one operating point, so replace [sweep] by [static]",
        scene.display(),
        sweep.key
    )))
}

/// Refuses a diagram without any mode, before there are files of it.
fn require_modes(found: &[ModesAtSpeed]) -> Result<(), Failure> {
    if found.iter().any(|at| !at.modes.is_empty()) {
        return Ok(());
    }
    Err(Failure::User(anyhow!(
        "no mode of the shaft or of a body swings at any of the speeds: damping stops all of them, or nothing but \
         balls moves; give less damping, or free a dof in [shaft]"
    )))
}

/// Writes tables and figures into a folder, and prints the diagram; cage and balls are those of `geometry`.
pub fn write(
    diagram: &Diagram,
    out: &Path,
    geometry: &BearingGeometry,
    slip: SlipRatios,
) -> Result<(), Failure> {
    require_modes(&diagram.modes)?;
    make_asked_folder(out)?;
    write_campbell(out, &diagram.modes, geometry, slip)?;
    print_campbell(&diagram.modes);
    print::line(format_args!("damping: {}", diagram.damping_note));
    print_warnings(&diagram.warnings);
    if let Some(note) = &diagram.note {
        print::line(format_args!("{note}"));
    }
    let figures = draw(out)?;
    print::line(format_args!(
        "{CAMPBELL_TABLE}, {CAMPBELL_LINES}, {} in {}",
        figures.join(", "),
        out.display()
    ));
    Ok(())
}

#[cfg(test)]
mod tests {
    use dynamics::whirl::Whirl;

    use super::*;

    /// Wrong: what loads that follow contact angles leave would count as an instability, or one go unsaid.
    #[test]
    fn a_mode_that_grows_is_told_of_beyond_what_following_loads_leave() {
        let mode = |damping_ratio| WhirlMode {
            frequency: 300.0,
            damping_ratio,
            whirl: Whirl::Backward,
            roundness: -1.0,
            shaft_share: 1.0,
            standing_share: 0.0,
        };
        let [even, uneven] = [[100.0, 80.0], [100.0, 0.3]].map(Vec::from);
        assert_eq!(
            growing(
                8000.0,
                &[mode(-1.2e-4), mode(3e-4)],
                std::slice::from_ref(&uneven)
            ),
            None
        );
        let modes = [mode(1e-4), mode(-2e-3), mode(-3e-3)];
        let told = growing(8000.0, &modes, std::slice::from_ref(&even)).unwrap();
        assert_eq!(
            told,
            "8000 rpm: mode 2 grows by itself, with a damping ratio of -2.0e-3"
        );
        let doubted = growing(8000.0, &modes, &[even, uneven]).unwrap();
        assert!(
            doubted.starts_with(&format!(
                "{told}; doubtful: balls go from full load to next to none"
            )),
            "{doubted}"
        );
    }
}
