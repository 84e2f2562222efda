//! The state of a motion as named arrays, in both directions: what step files hold and what a run resumes from.
//!
//! One function, `exchange`, names every field of the state once; a `Port` carries the fields out or in. The
//! state is taken apart without `..`, so a field that is added to it does not compile until it has its line there.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{anyhow, ensure};
use checkpoint::StateArray;
use contact::{Meridian, Side};
use dynamics::motion::RingState;
use dynamics::motion::{
    BodyState, CageLedger, CageState, ContactTraction, FreeState, FrictionLedger, Ledger, MotionState,
    PatchPlace, RingCourse, RingShape, StateShape,
};

/// Arrays by name.
pub type Arrays = BTreeMap<String, StateArray>;

/// The arrays of a state of this shape.
pub fn store(state: &MotionState, shape: &StateShape) -> Arrays {
    let mut port = Port::Out(Arrays::new());
    // The copy is emptied into the arrays.
    exchange(&mut state.clone(), shape, &mut port).expect("storing checks nothing");
    match port {
        Port::Out(arrays) => arrays,
        Port::In { .. } => unreachable!("a port keeps its direction"),
    }
}

/// The state that was stored in `arrays`, bit for bit; fails when an array is missing, unknown or of another length.
pub fn load(arrays: &Arrays, shape: &StateShape) -> anyhow::Result<MotionState> {
    for (side, ring) in Side::BOTH.into_iter().zip(shape.rings) {
        require_kind(arrays, side.name(), ring)?;
    }
    ensure!(
        !arrays.contains_key(OLD_TRACTIONS),
        "the tractions of the balls are stored without their moments: an earlier version of raceway wrote them; run \
         the scene anew"
    );
    let mut state = MotionState::default();
    let mut port = Port::In {
        arrays,
        unread: arrays.keys().collect(),
    };
    exchange(&mut state, shape, &mut port)?;
    if let Port::In { unread, .. } = port
        && let Some(name) = unread.first()
    {
        return Err(anyhow!("the state array {name} is not known to this version"));
    }
    Ok(state)
}

/// Tractions of free balls as earlier versions stored them.
const OLD_TRACTIONS: &str = "free_ball_contacts";

/// Every field of the state by its name. A new field is one line here.
fn exchange(state: &mut MotionState, shape: &StateShape, port: &mut Port<'_>) -> anyhow::Result<()> {
    let MotionState {
        step,
        rung,
        rings,
        balls,
        ball_velocities,
        ball_accelerations,
        shaft,
        shaft_velocity,
        shaft_acceleration,
        seat,
        trend,
        forces,
        angles,
        approaches,
        places,
        free,
        ledger,
    } = state;
    let n_sites = 2 * shape.n_balls;
    port.counter("steps", step)?;
    port.counter("rung", rung)?;
    port.meridians("balls", balls, shape.n_balls)?;
    port.meridians("ball_velocities", ball_velocities, shape.n_balls)?;
    port.meridians("ball_accelerations", ball_accelerations, shape.n_balls)?;
    port.values("shaft", shaft)?;
    port.values("shaft_velocity", shaft_velocity)?;
    port.values("shaft_acceleration", shaft_acceleration)?;
    if shape.has_seat {
        port.values("seat", seat.get_or_insert_default())?;
    }
    port.meridians("trend", trend, 3 * shape.n_balls)?;
    port.meridians("forces", forces, n_sites)?;
    port.list("angles", angles, n_sites)?;
    port.list("approaches", approaches, n_sites)?;
    for (part, places) in places.iter_mut().enumerate() {
        let row = |place: &PatchPlace| [place.angle, place.force];
        let mut rows: Vec<_> = places.iter().map(row).collect();
        port.rows(&format!("places_{part}"), &mut rows, n_sites)?;
        let rows = rows.into_iter();
        *places = rows.map(|[angle, force]| PatchPlace { angle, force }).collect();
    }
    if shape.has_free_balls {
        exchange_free(free.get_or_insert_default(), shape, port)?;
        exchange_friction(ledger.friction.get_or_insert_default(), port)?;
        if let Some(ends) = shape.cage_ends {
            let cage = free.get_or_insert_default().cage.get_or_insert_default();
            exchange_cage(cage, (shape.n_balls, ends), port)?;
            exchange_cage_ledger(ledger.cage.get_or_insert_default(), port)?;
        }
    }
    exchange_ledger(ledger, shape, port)?;
    for (side, ring) in Side::BOTH.into_iter().zip(rings) {
        if let Some(shape) = shape.rings[side.index()] {
            exchange_ring(ring.get_or_insert_default(), side.name(), shape, port)?;
        }
    }
    Ok(())
}

fn exchange_free(free: &mut FreeState, shape: &StateShape, port: &mut Port<'_>) -> anyhow::Result<()> {
    let n_balls = shape.n_balls;
    let FreeState {
        places,
        velocities,
        turnings,
        trends,
        contacts,
        courses,
        track,
        orientations,
        cage: _,
    } = free;
    port.rows("free_balls", places, n_balls)?;
    port.rows("free_ball_velocities", velocities, n_balls)?;
    port.rows("free_ball_turnings", turnings, n_balls)?;
    port.rows("free_ball_trends", trends, n_balls)?;
    let mut rows: Vec<[f64; 12]> = contacts.iter().map(|contact| contact.to_row()).collect();
    port.rows("free_ball_tractions", &mut rows, 2 * n_balls)?;
    *contacts = rows.into_iter().map(ContactTraction::from_row).collect();
    let mut rows: Vec<[f64; 6]> = courses.iter().map(|course| course.to_row()).collect();
    port.rows("free_ball_courses", &mut rows, 2 * n_balls)?;
    *courses = rows.into_iter().map(RingCourse::from_row).collect();
    if shape.has_profiles {
        port.rows("free_ball_track", track, 2 * n_balls)?;
    }
    if shape.has_orientations {
        port.rows("free_ball_orientations", orientations, n_balls)?;
    }
    Ok(())
}

fn exchange_friction(friction: &mut FrictionLedger, port: &mut Port<'_>) -> anyhow::Result<()> {
    let FrictionLedger {
        loss,
        integrator_share,
        drive_work,
        drag_loss,
    } = friction;
    port.scalars("ledger_friction", [loss, integrator_share, drive_work, drag_loss])
}

/// `ends`: how many ends of the cage a land guides.
fn exchange_cage(
    cage: &mut CageState,
    (n_balls, ends): (usize, usize),
    port: &mut Port<'_>,
) -> anyhow::Result<()> {
    let CageState {
        place,
        rates,
        met,
        pockets,
        lands,
        torques,
    } = cage;
    port.values("cage", place)?;
    port.values("cage_rates", rates)?;
    port.list("cage_met", met, n_balls + ends)?;
    port.rows("cage_pockets", pockets, n_balls)?;
    port.rows("cage_lands", lands, ends)?;
    port.values("cage_torques", torques)
}

fn exchange_cage_ledger(cage: &mut CageLedger, port: &mut Port<'_>) -> anyhow::Result<()> {
    let CageLedger {
        kinetic,
        strain,
        impact_loss,
        friction_loss,
        integrator_share,
        drag_loss,
        drive_work,
    } = cage;
    port.scalars(
        "ledger_cage",
        [
            kinetic,
            strain,
            impact_loss,
            friction_loss,
            integrator_share,
            drag_loss,
            drive_work,
        ],
    )
}

/// Kinds of the vectors of a ring and how the names of their arrays end; the last one is of earlier versions.
const KINDS: [(&str, &str); 3] = [
    ("coordinates", ""),
    ("harmonics", "_harmonics_2"),
    ("harmonics in another order", "_harmonics"),
];

fn ending(kind: &str) -> &'static str {
    let known = KINDS.into_iter().find(|(name, _)| *name == kind);
    known.expect("vectors are of a known kind").1
}

fn exchange_ring(
    ring: &mut RingState,
    side: &str,
    shape: RingShape,
    port: &mut Port<'_>,
) -> anyhow::Result<()> {
    let end = ending(shape.kind);
    let mut body = ring.take_body();
    if shape.oscillators > 0 {
        let BodyState(of_body) = body.get_or_insert_default();
        for (name, list) in ["w", "v", "a"].into_iter().zip(of_body) {
            port.list(&format!("{side}_body_{name}"), list, shape.oscillators)?;
        }
    }
    let [mut w, mut v, mut a] = std::mem::take(ring).into_parts();
    for (name, vector) in [("w", &mut w), ("v", &mut v), ("a", &mut a)] {
        port.list(&format!("{side}_{name}{end}"), vector, shape.length)?;
    }
    *ring = RingState::new(w, v, a).with_body(body);
    Ok(())
}

/// Refuses the state of a ring that is stored in another form than the run computes with: it could go on, but not to
/// the same bits.
fn require_kind(arrays: &Arrays, side: &str, ring: Option<RingShape>) -> anyhow::Result<()> {
    let Some(RingShape { kind, .. }) = ring else {
        return Ok(());
    };
    let name = |kind: &str| format!("{side}_w{}", ending(kind));
    let mut others = KINDS.map(|(kind, _)| kind).into_iter();
    if !arrays.contains_key(&name(kind))
        && let Some(other) = others.find(|other| arrays.contains_key(&name(other)))
    {
        return Err(anyhow!(
            "the state of the {side} ring is stored as {other}, expected {kind}: another version of raceway or \
             another linear solver wrote it, and the run would not go on to the same bits; run the scene anew"
        ));
    }
    Ok(())
}

fn exchange_ledger(ledger: &mut Ledger, shape: &StateShape, port: &mut Port<'_>) -> anyhow::Result<()> {
    let Ledger {
        kinetic,
        strain,
        hertz,
        load_work,
        imposed_work,
        frame_work,
        patch_work,
        profile_work,
        temperature_work,
        contact_loss,
        rayleigh_loss,
        numerical_loss,
        initial,
        largest,
        friction: _,
        cage: _,
    } = ledger;
    port.values("ledger_kinetic", kinetic)?;
    port.values("ledger_strain", strain)?;
    port.scalars("ledger_works", [load_work, imposed_work, frame_work, patch_work])?;
    if shape.has_profiles {
        port.scalars("ledger_profiles", [profile_work])?;
    }
    if shape.has_temperature_work {
        port.scalars("ledger_temperatures", [temperature_work])?;
    }
    port.scalars("ledger_losses", [contact_loss, rayleigh_loss, numerical_loss])?;
    port.scalars("ledger_scale", [initial, largest, hertz])
}

/// Carries fields from a state into arrays or from arrays into a state.
enum Port<'a> {
    /// Arrays under way.
    Out(Arrays),
    /// Arrays as read, and the names nobody has asked for yet.
    In {
        arrays: &'a Arrays,
        unread: BTreeSet<&'a String>,
    },
}

impl Port<'_> {
    /// A list of `n` numbers.
    fn list(&mut self, name: &str, values: &mut Vec<f64>, n: usize) -> anyhow::Result<()> {
        match self {
            Port::Out(arrays) => {
                arrays.insert(name.to_string(), StateArray::Real(std::mem::take(values)));
            }
            Port::In { .. } => *values = self.read(name, n)?.to_vec(),
        }
        Ok(())
    }

    /// A list of `n` rows.
    fn rows<const N: usize>(&mut self, name: &str, rows: &mut Vec<[f64; N]>, n: usize) -> anyhow::Result<()> {
        let mut flat = rows.concat();
        self.list(name, &mut flat, N * n)?;
        *rows = flat.as_chunks::<N>().0.to_vec();
        Ok(())
    }

    /// A list of `n` vectors, as rows [radial, axial].
    fn meridians(&mut self, name: &str, vectors: &mut Vec<Meridian>, n: usize) -> anyhow::Result<()> {
        let mut flat = Meridian::flat(vectors);
        self.list(name, &mut flat, 2 * n)?;
        *vectors = Meridian::list(&flat);
        Ok(())
    }

    /// Numbers whose count is fixed.
    fn values(&mut self, name: &str, values: &mut [f64]) -> anyhow::Result<()> {
        let mut flat = values.to_vec();
        self.list(name, &mut flat, values.len())?;
        // Empty when it was carried out.
        values[..flat.len()].copy_from_slice(&flat);
        Ok(())
    }

    /// Single numbers in one array: a data set of its own costs more than its value.
    fn scalars<const N: usize>(&mut self, name: &str, values: [&mut f64; N]) -> anyhow::Result<()> {
        let mut flat = values.each_ref().map(|value| **value);
        self.values(name, &mut flat)?;
        values.into_iter().zip(flat).for_each(|(to, from)| *to = from);
        Ok(())
    }

    /// A count.
    fn counter(&mut self, name: &str, value: &mut u64) -> anyhow::Result<()> {
        match self {
            Port::Out(arrays) => {
                let stored = i64::try_from(*value).expect("nobody counts to 2^63");
                arrays.insert(name.to_string(), StateArray::Integer(vec![stored]));
            }
            Port::In { arrays, unread } => {
                unread.retain(|known| *known != name);
                *value = match arrays.get(name) {
                    Some(StateArray::Integer(stored)) if stored.len() == 1 => u64::try_from(stored[0])?,
                    other => {
                        return Err(anyhow!(
                            "the state array {name} is {other:?}, expected one integer"
                        ));
                    }
                };
            }
        }
        Ok(())
    }

    fn read(&mut self, name: &str, n: usize) -> anyhow::Result<&[f64]> {
        let Port::In { arrays, unread } = self else {
            unreachable!("only a port inwards reads")
        };
        unread.retain(|known| *known != name);
        match arrays.get(name) {
            Some(StateArray::Real(values)) => {
                ensure!(
                    values.len() == n,
                    "the state array {name} has {} values, expected {n}",
                    values.len()
                );
                Ok(values)
            }
            Some(StateArray::Integer(_)) => {
                Err(anyhow!("the state array {name} holds integers, expected reals"))
            }
            None => Err(anyhow!("the state array {name} is missing")),
        }
    }
}

#[cfg(test)]
mod tests;
