//! Why there is no life.

use thiserror::Error;

/// Failures of counting a life.
#[derive(Debug, Error)]
pub enum LifeError {
    /// Nothing rolls.
    #[error(
        "the rings do not turn against each other in this run, so no ball passes a raceway; expected a speed in \
         [speed], or the results of an equilibrium, whose life does not need one"
    )]
    NoTurning,
    /// The history is shorter than the way from one position to the next.
    #[error("the balls pass no position of the {side} raceway in this run; expected a longer history")]
    TooShort {
        /// Which raceway.
        side: &'static str,
    },
    /// Balls go to and fro over an arc that the positions do not resolve.
    #[error(
        "the balls swing by {swing:.3} deg on the {side} raceway; expected at least {least:.1} deg, below which \
         bearings fail by fretting and not by fatigue"
    )]
    SmallSwing {
        /// Which raceway.
        side: &'static str,
        /// Arc, deg.
        swing: f64,
        /// Least arc, deg.
        least: f64,
    },
    /// The nominal contact angle is one of a thrust bearing.
    #[error(
        "the contact angle is {angle:.1} deg; ISO 281 rates radial bearings of 0 to 45 deg, give life.contact_angle \
         if the nominal one is less"
    )]
    ThrustBearing {
        /// Nominal contact angle, deg.
        angle: f64,
    },
    /// The scene is its own reference.
    #[error(
        "the scene has no [effects.fit], [effects.temperature], [[effects.seat_form]] or [speed]; --stress compares \
         its life with that without them, expected one of them"
    )]
    NothingLeftOut,
    /// A ring without stress.
    #[error(
        "the {side} ring has no stress below its contacts: it is rigid, or contact.mode is \"facet\"; give it a mesh"
    )]
    NoBody {
        /// Which ring.
        side: &'static str,
    },
    /// No ball carries anything.
    #[error("no ball is loaded, so nothing wears the raceways out; expected a load or a preload")]
    Unloaded,
    /// Stress below the limit everywhere.
    #[error(
        "life.shear_limit of {limit_mpa:.0} MPa is above all stress below the contacts, so that nothing fails and \
         there is no ratio; expected less"
    )]
    BelowLimit {
        /// The limit, MPa.
        limit_mpa: f64,
    },
}
