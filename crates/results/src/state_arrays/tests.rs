//! States as arrays and back.

use super::*;

const SHAPE: StateShape = StateShape {
    n_balls: 2,
    rings: [
        Some(RingShape {
            length: 3,
            kind: "coordinates",
            oscillators: 2,
        }),
        None,
    ],
    has_seat: true,
    has_free_balls: true,
    cage_ends: Some(2),
    has_profiles: true,
    has_orientations: true,
    has_temperature_work: true,
};

/// A state in which every number is another one, with a NaN and a negative zero.
fn state() -> MotionState {
    let mut next = 0.0;
    let mut number = || {
        next += 0.1;
        next
    };
    let mut pairs = |n: usize| {
        let vector = |_| Meridian::new(number(), number());
        (0..n).map(vector).collect::<Vec<_>>()
    };
    let (balls, ball_velocities, ball_accelerations) = (pairs(2), pairs(2), pairs(2));
    let (trend, forces) = (pairs(6), pairs(4));
    let place = |v: Meridian| PatchPlace {
        angle: v.radial,
        force: v.axial,
    };
    let places = [(); 3].map(|()| pairs(4).into_iter().map(place).collect());
    let mut list = |n: usize| (0..n).map(|_| number()).collect::<Vec<_>>();
    let body = BodyState([list(2), list(2), list(2)]);
    let ring = RingState::new(vec![f64::NAN, -0.0, 1e-300], list(3), list(3)).with_body(Some(body));
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
                .map(|_| ContactTraction::from_row([(); 12].map(|()| number())))
                .collect(),
            courses: (0..4)
                .map(|_| RingCourse::from_row([(); 6].map(|()| number())))
                .collect(),
            orientations: (0..2).map(|_| [(); 4].map(|()| number())).collect(),
            track: (0..4).map(|_| [(); 4].map(|()| number())).collect(),
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
    let mut without_moments = arrays.clone();
    let rows = without_moments.remove("free_ball_tractions").unwrap();
    without_moments.insert("free_ball_contacts".to_string(), rows);
    assert_eq!(
        refused(&without_moments, &SHAPE),
        "the tractions of the balls are stored without their moments: an earlier version of raceway wrote them; run \
         the scene anew"
    );
    let mut other = arrays.clone();
    other.insert("angles".to_string(), StateArray::Integer(vec![1]));
    assert_eq!(
        refused(&other, &SHAPE),
        "the state array angles holds integers, expected reals"
    );
}
