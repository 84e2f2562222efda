//! Films of the contacts, for `balls.csv`, `summary.json` and warnings.
//!
//! The surface of a ball rolls with the speed r omega_R, omega_R the ball's rotation about its own axis relative to the
//! cage: that of kinematic balls, at the free contact angle. With the slip ratio s that is 1 - s of the raceway's, and
//! the film takes the mean of both. Free balls roll as they turn and slip.
//! Thickness: [`contact::film`]. Films change no normal force, and no gap unless a scene gives `lubricant.lift_load`.

use contact::film::{Film, FilmContact, Lubricant};
use contact::{BySide, Side};
use dynamics::Model;
use dynamics::balls::BallResult;
use scene::{Roughness, Scene, mean_over_ball};
use serde::Serialize;

/// What films of a bearing take besides its state.
#[derive(Clone, Debug)]
pub struct FilmLaw {
    contacts: BySide<FilmContact>,
    lubricant: Lubricant,
    /// None: there is no lambda.
    roughness: Option<Roughness>,
    ball_radius: f64,
    /// Mean speed of both surfaces of kinematic balls over that of the ball's.
    means: BySide<f64>,
}

/// Thinnest film of one raceway.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FilmSummary {
    /// The ball that has it.
    ball: usize,
    central_m: f64,
    minimum_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    lambda: Option<f64>,
}

impl FilmLaw {
    /// That of a scene; None without `[lubricant]`.
    pub fn new(scene: &Scene, model: &Model) -> Option<FilmLaw> {
        let lubrication = scene.lubricant?;
        Some(FilmLaw {
            contacts: Side::BOTH.map(|side| model.film_contact(side)),
            lubricant: lubrication.lubricant,
            roughness: lubrication.roughness,
            ball_radius: 0.5 * model.geometry.ball_diameter,
            means: scene.effects.slip().map(mean_over_ball),
        })
    }

    /// Film of a contact of a ball that rotates at `spin` rad/s, or as a free one does; None where nothing rolls or
    /// presses.
    pub fn film(&self, side: Side, ball: &BallResult, spin: f64) -> Option<Film> {
        let speed = ball.rolling_speed(side, self.ball_radius);
        let contact = self.contacts[side.index()];
        contact.film(
            self.lubricant,
            speed.unwrap_or(self.ball_radius * spin * self.means[side.index()]),
            ball.contact(side).force_n,
        )
    }

    /// Lambda of a film; None without roughness.
    pub fn lambda(&self, side: Side, film: Film) -> Option<f64> {
        let roughness = self.roughness?;
        Some(film.ratio([roughness.raceways[side.index()], roughness.balls]))
    }

    /// Names of the columns of `balls.csv`.
    pub fn columns(&self) -> Vec<String> {
        let of_side = |side: Side| {
            let lambda = self.roughness.map(|_| "lambda");
            let names = ["film_central_m", "film_minimum_m"].into_iter().chain(lambda);
            names.map(move |name| format!("{}_{name}", side.name()))
        };
        Side::BOTH.into_iter().flat_map(of_side).collect()
    }

    /// Their values for a ball; 0 where there is no film.
    pub fn cells(&self, ball: &BallResult, spin: f64) -> Vec<f64> {
        let of_side = |side: Side| {
            let film = self.film(side, ball, spin);
            let thickness = film.map_or([0.0; 2], |film| [film.central, film.minimum]);
            let lambda = self
                .roughness
                .map(|_| film.and_then(|f| self.lambda(side, f)).unwrap_or(0.0));
            thickness.into_iter().chain(lambda)
        };
        Side::BOTH.into_iter().flat_map(of_side).collect()
    }

    /// The thinnest film of a raceway; None where there is none.
    pub fn thinnest(&self, side: Side, balls: &[BallResult], spin: f64) -> Option<FilmSummary> {
        let films = balls.iter().enumerate();
        let films = films.filter_map(|(i, ball)| Some((i, self.film(side, ball, spin)?)));
        let (ball, film) = films.min_by(|a, b| a.1.minimum.total_cmp(&b.1.minimum))?;
        Some(FilmSummary {
            ball,
            central_m: film.central,
            minimum_m: film.minimum,
            lambda: self.lambda(side, film),
        })
    }
}

impl FilmSummary {
    /// What a user should know of a film that does not part the surfaces.
    pub fn warning(&self, side: &str) -> Option<String> {
        let lambda = self.lambda.filter(|lambda| *lambda < 1.0)?;
        Some(format!(
            "the film of the {side} raceway is thinner than the surfaces are rough: lambda is {lambda:.2} at ball {}, \
             where it is {:.3} um thick; expected 1 or more, use thicker oil or smoother surfaces",
            self.ball,
            1e6 * self.central_m
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the film of a raceway that slips would take the slower surface alone, or change where nothing slips.
    #[test]
    fn the_surfaces_of_a_contact_that_slips_have_a_mean() {
        assert_eq!(mean_over_ball(0.0), 1.0);
        // The raceway moves at 1 past the contact, the ball at 0.6.
        assert!((0.6 * mean_over_ball(0.4) - 0.8).abs() < 1e-15);
    }

    /// Wrong: a film that does not part the surfaces would go unsaid.
    #[test]
    fn a_film_thinner_than_the_roughness_is_said() {
        let film = |lambda: f64| FilmSummary {
            ball: 3,
            central_m: 0.04e-6,
            minimum_m: 0.03e-6,
            lambda: Some(lambda),
        };
        let said = film(0.8).warning("inner").unwrap();
        let start =
            "the film of the inner raceway is thinner than the surfaces are rough: lambda is 0.80 at ball 3,";
        assert!(said.starts_with(start), "{said}");
        assert_eq!(film(1.0).warning("inner"), None);
    }
}
