//! Errors of the algorithms.

use contact::ContactError;
use dense::DenseError;
use ring::RingError;

/// Why a bearing could not be solved.
#[derive(Debug, thiserror::Error)]
pub enum DynamicsError {
    /// A ring could not be made or solved.
    #[error(transparent)]
    Ring(#[from] RingError),
    /// The small contact system is singular.
    #[error(
        "the contact system of balls and shaft has no solution: {source}; check the loads and the shaft's free \
         directions"
    )]
    ContactSystem {
        /// Cause.
        source: DenseError,
    },
    /// A contact is outside its theory.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The contact Newton stalled.
    #[error(
        "contact forces do not balance after {iterations} Newton iterations: largest residual {residual:.3e} N at \
         {place}, expected {limit:.3e} N; residual history {history:?}; try a smaller load step (a sweep) or check \
         the loads"
    )]
    NewtonStalled {
        /// Iterations done.
        iterations: usize,
        /// Largest residual, N.
        residual: f64,
        /// Dof of the largest residual.
        place: String,
        /// Accepted residual, N.
        limit: f64,
        /// Largest residual of the last iterations, N.
        history: Vec<f64>,
    },
    /// No equilibrium near the reference position.
    #[error(
        "no equilibrium: {dof} runs beyond {limit}; the loads push the inner ring off the balls or \
         a free direction is not held; lock it, add preload or reduce the load{hint}"
    )]
    NoEquilibrium {
        /// Dof and body.
        dof: String,
        /// What else a user should know.
        hint: &'static str,
        /// Limit with unit.
        limit: String,
    },
    /// A free shaft dof has no stiffness at the solution.
    #[error(
        "{dof} of the shaft is free but nothing resists it (stiffness {stiffness:.3e} of the largest): \
         lock it in [shaft] or load the bearing so that balls touch{hint}"
    )]
    Unheld {
        /// Shaft dof.
        dof: &'static str,
        /// What else a user should know.
        hint: &'static str,
        /// Stiffness over the largest.
        stiffness: f64,
    },
    /// A free shaft dof of a motion has neither inertia nor a contact that holds it.
    #[error(
        "{dof} is free, but it has no mass and no ball touches it, so nothing says where it goes: \
         {remedy}"
    )]
    Adrift {
        /// What it is.
        dof: String,
        /// What would hold it.
        remedy: &'static str,
    },
    /// A motion went where the equations do not hold.
    #[error(
        "{what} is at {value}, beyond {limit}: it has left the bearing, and what follows would mean nothing; hold it \
         by a load or in [shaft], or use contact = \"discrete_gradient\" and smaller steps if it should have stayed"
    )]
    LeftBearing {
        /// What moved.
        what: String,
        /// Where it is, with unit.
        value: String,
        /// Its limit, with unit.
        limit: String,
    },
    /// A free ball that finds no steady rolling in an equilibrium.
    #[error(
        "ball {ball} does not come to roll steadily: moments of {residual:.1e} of the load times the radius stay out \
         of balance; look at the friction and its curve, or compute a [dynamic] motion that does not begin in \
         equilibrium, [dynamic.start.given]"
    )]
    NoSteadyRolling {
        /// The ball.
        ball: usize,
        /// Largest moment out of balance over the largest force times the radius of the ball.
        residual: f64,
    },
    /// Two free balls run into each other.
    #[error(
        "balls {ball} and {other} run into each other: orbits that differ bring free balls together; {remedy}, or load \
         the bearing so that all balls roll alike"
    )]
    BallsTouch {
        /// A ball.
        ball: usize,
        /// The one after it.
        other: usize,
        /// What would keep them apart.
        remedy: &'static str,
    },
    /// A free cage that nothing holds.
    #[error(
        "the cage stands {:.3} mm off the axis, beyond {:.3} mm, a quarter of a ball diameter: pockets hold no cage \
         along their own axes, and balls that lag shift it; guide it by a land, cage.guidance = \"outer_land\" or \
         \"inner_land\"",
        1e3 * distance,
        1e3 * limit
    )]
    CageLost {
        /// Distance from the axis, m.
        distance: f64,
        /// Its limit, m.
        limit: f64,
    },
    /// Contacts of a ring share so few nodes that they are not independent.
    #[error(
        "the mesh of the {side} ring has too few nodes on its raceway to tell {n_balls} balls apart: the compliance \
         of its contacts is singular; use more elements round the ring or across the groove, or fewer balls"
    )]
    ContactsNotDistinct {
        /// `inner` or `outer`.
        side: &'static str,
        /// Number of balls.
        n_balls: usize,
    },
    /// Patches and forces do not settle.
    #[error(
        "contact places do not settle after {rounds} rounds: forces still change by {change:.3e} of the largest \
         (expected {limit:.1e}), most at ball {ball}, {side} raceway; history {history:?}"
    )]
    NotSettled {
        /// Rounds done.
        rounds: usize,
        /// Last relative change.
        change: f64,
        /// Accepted change.
        limit: f64,
        /// Ball with the largest change.
        ball: usize,
        /// Its side.
        side: &'static str,
        /// Relative changes of the last rounds.
        history: Vec<f64>,
    },
    /// The patch is smaller than the Hertz ellipse at this load.
    #[error(
        "ball {ball}, {side} raceway: at {force:.1} N the spread patch takes more compliance than Hertz's law has; \
         the force is too large or a stiffness given in [contact] too high for this mesh, or the groove too narrow; \
         check the loads, use a finer mesh or the exact stiffness"
    )]
    PatchTooSmall {
        /// Ball number, from 0.
        ball: usize,
        /// `inner` or `outer`.
        side: &'static str,
        /// Contact force, N.
        force: f64,
    },
    /// A ball reached no facet.
    #[error(
        "ball {ball} is near no facet of the {side} raceway: expected one within a ball radius; use more sectors, as \
         facets of few lie off the groove, or check the mesh's place"
    )]
    NoFacet {
        /// Ball number, from 0.
        ball: usize,
        /// `inner` or `outer`.
        side: &'static str,
    },
    /// The inertia of the turning frame does not settle within a step.
    #[error(
        "the inertia of the frame that turns at {speed:.1} rad/s does not settle in {rounds} rounds; use a smaller step"
    )]
    FrameNotSettled {
        /// Rounds done.
        rounds: usize,
        /// Speed, rad/s.
        speed: f64,
    },
    /// Patches find no place in a part of a step.
    #[error("the places of the contact patches do not settle in {rounds} rounds; use a smaller step")]
    PlacesNotSettled {
        /// Rounds done.
        rounds: usize,
    },
    /// The local error of a part of a step is too large.
    #[error(
        "the local error is {error:.2e} of the largest contact approach, expected {limit:.1e}; \
         allow smaller steps or a larger error"
    )]
    StepInaccurate {
        /// Error found.
        error: f64,
        /// Error accepted.
        limit: f64,
    },
    /// A step failed at its smallest size.
    #[error("the step of {dt:.3e} s ({halvings} times halved) from t = {time:.6e} s failed: {source}")]
    StepFailed {
        /// Its size, s.
        dt: f64,
        /// Halvings done.
        halvings: u32,
        /// Time at its start, s.
        time: f64,
        /// Cause.
        source: Box<DynamicsError>,
    },
    /// A choice that statics knows and motion does not.
    #[error("a moving bearing cannot have {what} in this version")]
    NotInMotion {
        /// The choice and its replacement.
        what: &'static str,
    },
    /// A choice that modes do not know.
    #[error("natural modes cannot have {what}")]
    NotInModes {
        /// The choice and its replacement.
        what: &'static str,
    },
    /// A choice that a stiffness does not know.
    #[error("a stiffness cannot be had with {what}")]
    NotInStiffness {
        /// The choice and its replacement.
        what: &'static str,
    },
    /// A free dof of the shaft that nothing gives inertia.
    #[error(
        "{dof} of the shaft is free and has no inertia, so it has no modes at speed; give {key}, or lock it in [shaft]"
    )]
    NoInertia {
        /// The dof.
        dof: &'static str,
        /// The key that gives it some.
        key: &'static str,
    },
    /// The search for modes failed.
    #[error("natural modes: {source}")]
    Modes {
        /// Cause.
        source: DenseError,
    },
    /// A clamped ring that its fit does not press on its partner.
    #[error(
        "the {side} ring has {}, but {side}.support = \"clamped\" keeps it on it; use \"mean_motion\", which lets a \
         loose ring keep its size, or at least {missing_um:.2} um more interference in [effects.fit.{side}]",
        looseness(*interference_um)
    )]
    LooseFit {
        /// `inner` or `outer`.
        side: &'static str,
        /// Diametral interference at the bearing's temperatures, um; negative is clearance.
        interference_um: f64,
        /// Interference that it lacks for any pressure, um.
        missing_um: f64,
    },
    /// A ring that speed lifts off its partner.
    #[error(
        "the {side} ring lets go of its partner at {limit_rpm:.0} rpm, with its {interference_um:.2} um of \
         interference, but [speed] reaches {speed_rpm:.0} rpm; a seat that lets go is not computed: lower the speed \
         or give [effects.fit.{side}] more interference"
    )]
    FitLetsGo {
        /// `inner` or `outer`.
        side: &'static str,
        /// Largest speed, rpm.
        speed_rpm: f64,
        /// Speed at which the pressure vanishes, rpm.
        limit_rpm: f64,
        /// Diametral interference, um.
        interference_um: f64,
    },
    /// A fit beyond yield.
    #[error(
        "the fit of the {side} ring presses with {pressure_mpa:.1} MPa, which stresses it by {stress_mpa:.0} MPa \
         (Tresca, as a tube to the groove bottom), beyond materials.rings.yield_strength of {limit_mpa:.0} MPa; \
         rings are elastic here: use less interference"
    )]
    FitYields {
        /// `inner` or `outer`.
        side: &'static str,
        /// Mean pressure, MPa.
        pressure_mpa: f64,
        /// Difference of the principal stresses, MPa.
        stress_mpa: f64,
        /// Yield strength, MPa.
        limit_mpa: f64,
    },
    /// A seat whose waves lift the ring off it.
    #[error(
        "the waves of [[effects.seat_form]] lift the {side} ring off {percent:.0} % of its seat; a seat that lets go \
         is not computed: use smaller amplitudes or more interference in [effects.fit.{side}]"
    )]
    SeatLifts {
        /// `inner` or `outer`.
        side: &'static str,
        /// Share of the circumference, per cent.
        percent: f64,
    },
    /// A wave of a seat that its nodes take for another one.
    #[error(
        "[[effects.seat_form]] of order {order} has {per_wave:.1} nodes for each wave round the seat of the {side} \
         ring, which take it for a wave of another order; expected more than 2, at most order {most}, or a mesh that \
         is finer there"
    )]
    SeatFormTooFine {
        /// `inner` or `outer`.
        side: &'static str,
        /// Waves round the circumference.
        order: usize,
        /// Nodes for each wave.
        per_wave: f64,
        /// Highest order that the nodes tell from others.
        most: usize,
    },
    /// A seat form on a ring that does not follow it.
    #[error(
        "[[effects.seat_form]] gives the {side} ring the form of its seat, which only a flexible ring with \
         {side}.support = \"clamped\" takes; give it a mesh and this support, or remove the form"
    )]
    SeatFormNotClamped {
        /// `inner` or `outer`.
        side: &'static str,
    },
    /// Fields of seats on several ranks.
    #[error(
        "fits, temperatures and seat forms of the flexible {side} ring need its whole mesh on one rank; start the \
         program without MPI"
    )]
    MountedOnRanks {
        /// `inner` or `outer`.
        side: &'static str,
    },
    /// A number became NaN or infinite.
    #[error("{what} is not finite; check the loads and material of the scene")]
    NotFinite {
        /// Quantity.
        what: &'static str,
    },
}

impl DynamicsError {
    /// Whether the cause is in what a user gave, not in its solution: something unheld, a choice that cannot be, a
    /// mesh with a hole.
    pub fn is_of_input(&self) -> bool {
        match self {
            DynamicsError::Ring(error) => error.is_of_input(),
            DynamicsError::Unheld { .. }
            | DynamicsError::NotInMotion { .. }
            | DynamicsError::NotInStiffness { .. }
            | DynamicsError::NoInertia { .. }
            | DynamicsError::LooseFit { .. }
            | DynamicsError::FitLetsGo { .. }
            | DynamicsError::FitYields { .. }
            | DynamicsError::SeatLifts { .. }
            | DynamicsError::SeatFormTooFine { .. }
            | DynamicsError::SeatFormNotClamped { .. }
            | DynamicsError::MountedOnRanks { .. }
            | DynamicsError::Contact(ContactError::Hole { .. }) => true,
            _ => false,
        }
    }

    /// Whether a smaller step in time may do what this one could not.
    pub fn may_pass_with_smaller_step(&self) -> bool {
        use DynamicsError::{
            ContactSystem, FrameNotSettled, NewtonStalled, NotFinite, PatchTooSmall, PlacesNotSettled,
            StepInaccurate,
        };
        matches!(
            self,
            NewtonStalled { .. }
                | ContactSystem { .. }
                | NotFinite { .. }
                | FrameNotSettled { .. }
                | PlacesNotSettled { .. }
                | PatchTooSmall { .. }
                | StepInaccurate { .. }
                | DynamicsError::Contact(ContactError::OffGroove { .. })
        )
    }
}

/// What a ring has that no pressure holds on its partner.
fn looseness(interference_um: f64) -> String {
    match interference_um < 0.0 {
        true => format!(
            "{:.2} um of clearance on its partner, warm as it is",
            -interference_um
        ),
        false => format!(
            "{interference_um:.2} um of interference with its partner, warm as it is, which a seat that cannot \
             contract along the axis takes up without pressure"
        ),
    }
}
