//! The state of a motion as named arrays, in both directions: what step files hold and what a run resumes from.
//!
//! One function, `exchange`, names every field of the state once; a `Port` carries the fields out or in. The
//! state is taken apart without `..`, so a field that is added to it does not compile until it has its line there.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{anyhow, ensure};
use checkpoint::StateArray;
use contact::Side;
use dynamics::motion::RingState;
use dynamics::motion::{
    CageLedger, CageState, ContactTraction, FreeState, FrictionLedger, Ledger, MotionState, RingShape,
    StateShape,
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
    port.rows("balls", balls, shape.n_balls)?;
    port.rows("ball_velocities", ball_velocities, shape.n_balls)?;
    port.rows("ball_accelerations", ball_accelerations, shape.n_balls)?;
    port.values("shaft", shaft)?;
    port.values("shaft_velocity", shaft_velocity)?;
    port.values("shaft_acceleration", shaft_acceleration)?;
    if shape.has_seat {
        port.values("seat", seat.get_or_insert_default())?;
    }
    port.rows("trend", trend, 3 * shape.n_balls)?;
    port.rows("forces", forces, n_sites)?;
    port.list("angles", angles, n_sites)?;
    port.list("approaches", approaches, n_sites)?;
    for (part, places) in places.iter_mut().enumerate() {
        port.rows(&format!("places_{part}"), places, n_sites)?;
    }
    if shape.has_free_balls {
        exchange_free(free.get_or_insert_default(), shape.n_balls, port)?;
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

fn exchange_free(free: &mut FreeState, n_balls: usize, port: &mut Port<'_>) -> anyhow::Result<()> {
    let FreeState {
        places,
        velocities,
        turnings,
        trends,
        contacts,
        cage: _,
    } = free;
    port.rows("free_balls", places, n_balls)?;
    port.rows("free_ball_velocities", velocities, n_balls)?;
    port.rows("free_ball_turnings", turnings, n_balls)?;
    port.rows("free_ball_trends", trends, n_balls)?;
    let mut rows: Vec<[f64; 7]> = contacts.iter().map(|contact| contact.to_row()).collect();
    port.rows("free_ball_contacts", &mut rows, 2 * n_balls)?;
    *contacts = rows.into_iter().map(ContactTraction::from_row).collect();
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
    let [mut w, mut v, mut a] = std::mem::take(ring).into_parts();
    for (name, vector) in [("w", &mut w), ("v", &mut v), ("a", &mut a)] {
        port.list(&format!("{side}_{name}{end}"), vector, shape.length)?;
    }
    *ring = RingState::new(w, v, a);
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
            "the state of the {side} ring is stored as {other}, expected {kind}: another version of raceway or another linear \
             solver wrote it, and the run would not go on to the same bits; run the scene anew"
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
mod tests {
    use super::*;

    const SHAPE: StateShape = StateShape {
        n_balls: 2,
        rings: [
            Some(RingShape {
                length: 3,
                kind: "coordinates",
            }),
            None,
        ],
        has_seat: true,
        has_free_balls: true,
        cage_ends: Some(2),
        has_profiles: true,
        has_temperature_work: true,
    };

    /// A state in which every number is another one, with a NaN and a negative zero.
    fn state() -> MotionState {
        let mut next = 0.0;
        let mut number = || {
            next += 0.1;
            next
        };
        let mut pairs = |n: usize| (0..n).map(|_| [number(), number()]).collect::<Vec<_>>();
        let (balls, ball_velocities, ball_accelerations) = (pairs(2), pairs(2), pairs(2));
        let (trend, forces, places) = (pairs(6), pairs(4), [(); 3].map(|()| pairs(4)));
        let mut list = |n: usize| (0..n).map(|_| number()).collect::<Vec<_>>();
        let ring = RingState::new(vec![f64::NAN, -0.0, 1e-300], list(3), list(3));
        MotionState {
            step: 7,
            rung: 3,
            rings: [Some(ring), None],
            balls,
            ball_velocities,
            ball_accelerations,
            trend,
            forces,
            places,
            angles: list(4),
            approaches: list(4),
            shaft: [0, 1, 2, 3, 4].map(|_| number()),
            shaft_velocity: [0, 1, 2, 3, 4].map(|_| number()),
            shaft_acceleration: [0, 1, 2, 3, 4].map(|_| number()),
            seat: Some([0, 1, 2].map(|_| number())),
            ledger: Ledger {
                kinetic: [0, 1, 2].map(|_| number()),
                strain: [0, 1].map(|_| number()),
                hertz: number(),
                load_work: number(),
                imposed_work: number(),
                frame_work: number(),
                patch_work: number(),
                profile_work: number(),
                temperature_work: number(),
                contact_loss: number(),
                rayleigh_loss: number(),
                numerical_loss: number(),
                initial: number(),
                largest: number(),
                friction: Some(FrictionLedger {
                    loss: number(),
                    integrator_share: number(),
                    drive_work: number(),
                    drag_loss: number(),
                }),
                cage: Some(CageLedger {
                    kinetic: number(),
                    strain: number(),
                    impact_loss: number(),
                    friction_loss: number(),
                    integrator_share: number(),
                    drag_loss: number(),
                    drive_work: number(),
                }),
            },
            free: Some(FreeState {
                places: (0..2).map(|_| [0, 1, 2].map(|_| number())).collect(),
                velocities: (0..2).map(|_| [0, 1, 2].map(|_| number())).collect(),
                turnings: (0..2).map(|_| [0, 1, 2].map(|_| number())).collect(),
                trends: (0..2).map(|_| [(); 6].map(|()| number())).collect(),
                contacts: (0..4)
                    .map(|_| ContactTraction::from_row([(); 7].map(|()| number())))
                    .collect(),
                cage: Some(CageState {
                    place: [(); 6].map(|()| number()),
                    rates: [(); 6].map(|()| number()),
                    met: (0..4).map(|_| number()).collect(),
                    pockets: (0..2).map(|_| [0, 1].map(|_| number())).collect(),
                    lands: (0..2).map(|_| [0, 1].map(|_| number())).collect(),
                    torques: [0, 1].map(|_| number()),
                }),
            }),
        }
    }

    /// Wrong: a resumed run would start from another state than the one that was saved.
    #[test]
    fn every_field_comes_back_bit_for_bit() {
        let state = state();
        let back = load(&store(&state, &SHAPE), &SHAPE).unwrap();
        // Debug prints the shortest text that is one f64 only, signs of zero and NaN included.
        assert_eq!(format!("{back:?}"), format!("{state:?}"));
        let bits = |s: &MotionState| {
            let ring = s.rings[0].as_ref().unwrap();
            let bits = ring.displacement().iter().map(|x| x.to_bits());
            bits.collect::<Vec<_>>()
        };
        assert_eq!(bits(&back), bits(&state));
    }

    /// Wrong: a file of another version or bearing would be taken for a state of this run.
    #[test]
    fn a_state_of_another_shape_is_refused_by_name() {
        let arrays = store(&state(), &SHAPE);
        let refused = |arrays: &Arrays, shape: &StateShape| load(arrays, shape).unwrap_err().to_string();
        let three = StateShape { n_balls: 3, ..SHAPE };
        assert_eq!(
            refused(&arrays, &three),
            "the state array balls has 4 values, expected 6"
        );
        let rigid = StateShape {
            rings: [None; 2],
            ..SHAPE
        };
        assert_eq!(
            refused(&arrays, &rigid),
            "the state array inner_a is not known to this version"
        );
        for name in arrays.keys() {
            let mut fewer = arrays.clone();
            fewer.remove(name);
            let text = refused(&fewer, &SHAPE);
            assert!(text.starts_with(&format!("the state array {name} is ")), "{text}");
        }
        let mut harmonics = SHAPE;
        harmonics.rings[0].as_mut().unwrap().kind = "harmonics";
        let text = refused(&arrays, &harmonics);
        assert!(
            text.starts_with("the state of the inner ring is stored as coordinates, expected harmonics: "),
            "{text}"
        );
        let mut earlier = arrays.clone();
        let w = earlier.remove("inner_w").unwrap();
        earlier.insert("inner_w_harmonics".to_string(), w);
        let text = refused(&earlier, &harmonics);
        assert!(
            text.contains("stored as harmonics in another order, expected harmonics"),
            "{text}"
        );
        let mut other = arrays.clone();
        other.insert("angles".to_string(), StateArray::Integer(vec![1]));
        assert_eq!(
            refused(&other, &SHAPE),
            "the state array angles holds integers, expected reals"
        );
    }
}
