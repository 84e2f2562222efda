//! One instant of a run as every kind of result shows it.

use dynamics::StaticSolution;
use dynamics::balls::{BallResult, CageResult, Friction};
use dynamics::kinematics::Rolling;
use dynamics::motion::{Ledger, Motion, MotionState, StateShape};

/// Key numbers of one instant.
#[derive(Clone)]
pub struct Snapshot {
    /// All balls.
    pub balls: Vec<BallResult>,
    /// Speed of every ball's rotation about its own axis relative to the cage, rad/s; None where nothing turns.
    pub spin: Option<f64>,
    /// Shaft x, y, z, m, tilt x, tilt y, rad, in space.
    pub shaft: [f64; 5],
    /// Displacement of the outer ring's seat along z, m; None where it does not slide.
    pub seat: Option<f64>,
    /// Force and moment that hold prescribed dofs, N and N m; None where it is not known (motion).
    pub reaction: Option<[f64; 5]>,
    /// Friction of free balls; None where balls are not free.
    pub friction: Option<Friction>,
    /// A free cage; None where there is none.
    pub cage: Option<CageResult>,
    /// Energy terms, J, by name: the columns of `energy.csv`.
    pub energies: Vec<(&'static str, f64)>,
}

impl Snapshot {
    /// An equilibrium, of a bearing that rolls or stands. `total` is the potential energy that it minimises; `defect`
    /// is what is missing in the virtual work of all forces through the displacements, zero at equilibrium.
    pub fn of_equilibrium(solution: &StaticSolution, rolling: Option<&Rolling>) -> Snapshot {
        let total = solution.strain_energy + solution.hertz_energy + solution.load_potential;
        Snapshot {
            balls: solution.balls.clone(),
            // Free balls have each its own.
            spin: rolling
                .filter(|_| solution.friction.is_none())
                .map(|r| r.spin(solution.pose.now.time)),
            shaft: solution.displacements.shaft,
            seat: solution.parts.seat.as_ref().map(|_| solution.displacements.seat),
            reaction: Some(solution.shaft_reaction),
            friction: solution.friction,
            cage: None,
            energies: vec![
                ("strain", solution.strain_energy),
                ("hertz", solution.hertz_energy),
                ("load_potential", solution.load_potential),
                ("total", total),
                ("defect", solution.work_defect),
            ],
        }
    }

    /// An instant of a motion: energies now, works and losses since the start.
    pub fn of_motion(motion: &Motion<'_>, state: &MotionState) -> Snapshot {
        Snapshot {
            balls: motion.balls(state),
            spin: motion.spin(state),
            shaft: state.shaft,
            seat: state.seat.map(|seat| seat[0]),
            reaction: None,
            friction: motion.friction(state),
            cage: motion.cage(state),
            energies: ledger_terms(&state.ledger, &motion.shape()),
        }
    }
}

fn ledger_terms(ledger: &Ledger, shape: &StateShape) -> Vec<(&'static str, f64)> {
    let friction = ledger.friction.into_iter().flat_map(|friction| {
        [
            ("drive_work", friction.drive_work),
            ("friction_loss", friction.loss),
            ("friction_integrator_share", friction.integrator_share),
            ("drag_loss", friction.drag_loss),
        ]
    });
    let cage = ledger.cage.into_iter().flat_map(|cage| {
        [
            ("kinetic_cage", cage.kinetic),
            ("strain_cage", cage.strain),
            ("cage_drive_work", cage.drive_work),
            ("cage_impact_loss", cage.impact_loss),
            ("cage_friction_loss", cage.friction_loss),
            ("cage_integrator_share", cage.integrator_share),
            ("cage_drag_loss", cage.drag_loss),
        ]
    });
    let mut terms = vec![
        ("kinetic_inner", ledger.kinetic[0]),
        ("kinetic_outer", ledger.kinetic[1]),
        ("kinetic_balls", ledger.kinetic[2]),
        ("strain_inner", ledger.strain[0]),
        ("strain_outer", ledger.strain[1]),
        ("hertz", ledger.hertz),
        ("load_work", ledger.load_work),
        ("imposed_work", ledger.imposed_work),
        ("frame_work", ledger.frame_work),
        ("patch_work", ledger.patch_work),
        ("contact_loss", ledger.contact_loss),
        ("rayleigh_loss", ledger.rayleigh_loss),
        ("numerical_loss", ledger.numerical_loss),
    ];
    terms.extend(friction);
    terms.extend(cage);
    terms.extend([("total", ledger.total()), ("defect", ledger.defect())]);
    let asked = [
        (shape.has_profiles, "profile_work", ledger.profile_work),
        (
            shape.has_temperature_work,
            "temperature_work",
            ledger.temperature_work,
        ),
    ];
    for (_, name, value) in asked.into_iter().filter(|(is_asked, ..)| *is_asked) {
        let losses = terms.iter().position(|(name, _)| *name == "contact_loss");
        terms.insert(losses.unwrap_or(terms.len()), (name, value));
    }
    terms
}
