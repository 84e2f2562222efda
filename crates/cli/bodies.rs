//! What `raceway check` says of the bodies in which rings sit.

use std::sync::Arc;

use comm::print;
use contact::Side;
use dynamics::Model;
use scene::Scene;

/// Prints a line for each body of some bearings, once.
pub fn print_bodies<'m>(models: impl Iterator<Item = &'m Model>) {
    let mut told = Vec::new();
    for model in models {
        for side in Side::BOTH {
            let tie = model.tied(side).and_then(|ring| ring.tie.as_ref());
            let Some((tie, body)) = tie.and_then(|tie| Some((tie, tie.body.as_ref()?))) else {
                continue;
            };
            if told.iter().any(|other| Arc::ptr_eq(other, body)) {
                continue;
            }
            let modes = tie.modes.as_ref().map_or(String::new(), |modes| {
                let of_body = &modes.of_body;
                format!(
                    "; moves by {} modes below {} Hz with held seats",
                    of_body.n_fixed, of_body.below_hz
                )
            });
            let seats = match body.seats.len() {
                1 => "a seat".to_string(),
                n => format!("{n} seats"),
            };
            let like = body.apparent.map_or(String::new(), |like| {
                let mass = like.mass.map_or(String::new(), |[kg, _]| format!(", {kg:.3} kg"));
                format!(", as stiff as a solid of {:.3} GPa{mass}", 1e-9 * like.modulus)
            });
            print::line(format_args!(
                "body     {:?} round the {} ring: {} dofs, {} functions of {seats}, {:.1} MB{like}{modes}",
                body.name,
                side.name(),
                body.n_dofs,
                body.n_functions(),
                body.bytes as f64 / 1e6
            ));
            told.push(body.clone());
        }
    }
}

/// A seat follows each ball where it has orders up to the number of balls and a little more.
pub fn orders_of_seats(scene: &Scene, model: &Model) -> Vec<String> {
    let mut lines = Vec::new();
    for body in scene.bodies.iter().flatten() {
        let last = body.basis.order_and_degree(body.basis.n_functions() - 1);
        let (Some([harmonics, _]), balls) = (last, model.geometry.n_balls) else {
            continue;
        };
        if harmonics > balls {
            continue;
        }
        lines.push(format!(
            "body {:?}: its seat has {harmonics} orders for {balls} balls, so the ring gives way under each ball as if \
             nothing held it; ball forces hardly notice, displacements of the shaft come out about 1 % too large; \
             body.seat.harmonics = {} follows the balls",
            body.name,
            balls + 2
        ));
    }
    lines
}
