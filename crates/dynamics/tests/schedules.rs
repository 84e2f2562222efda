//! Loads and imposed displacements at a time: the same bearing as under their value at that time.

use dynamics::effects::{AxialForce, Effect, Gravity, Moment, Now, RadialForce};
use dynamics::{Model, Pose, ShaftDof, StaticSolution, StaticSolver};
use input::Schedule;

use crate::support::Case;

/// A bearing under all scheduled loads and a driven tilt; `at` makes the schedule of each from its number.
fn bearing(at: impl Fn(usize) -> Schedule) -> Model {
    let mut model = Case::axial(0.0).rigid();
    model.effects = vec![
        Box::new(AxialForce {
            value: 2000.0,
            schedule: at(0),
        }) as Box<dyn Effect>,
        Box::new(RadialForce {
            value: 500.0,
            direction: 0.7,
            schedule: at(1),
        }),
        Box::new(Moment {
            value: [2.0, -1.0],
            schedule: at(2),
        }),
        Box::new(Gravity::new([0.0, -9.81e3, 0.0], at(3), &[None, None]).unwrap()),
    ];
    model.shaft[3] = ShaftDof::Free;
    model.shaft[4] = ShaftDof::Prescribed(4e-4);
    model.shaft_schedules[4] = at(4);
    model
}

fn ramp(i: usize) -> Schedule {
    Schedule::Ramp {
        from: 0.5,
        to: 1.0 + 0.1 * i as f64,
        start: 1.0,
        duration: 2.0,
    }
}

fn solve(model: &Model, time: f64) -> StaticSolution {
    let now = Now {
        time,
        ..Now::default()
    };
    let pose = Pose {
        now,
        ring_angles: [0.0, 0.0],
        rolled: 0.0,
    };
    StaticSolver::new(model)
        .unwrap()
        .solve_at(model, &pose, None)
        .unwrap()
}

/// Wrong: a load, or an imposed displacement, would be taken at another time or with the factor of another. The same
/// bearing with each factor held at its value must give the same bits.
#[test]
fn statics_at_a_time_has_the_loads_of_that_time() {
    for time in [0.0, 1.5, 7.0] {
        let scheduled = solve(&bearing(ramp), time);
        let held = |i: usize| Schedule::Ramp {
            from: ramp(i).at(time),
            to: ramp(i).at(time),
            start: 0.0,
            duration: 1.0,
        };
        let constant = solve(&bearing(held), 0.0);
        assert_eq!(scheduled.displacements, constant.displacements, "{time} s");
        assert_eq!(scheduled.shaft_reaction, constant.shaft_reaction);
        assert_eq!(scheduled.displacements.shaft[4], 4e-4 * ramp(4).at(time));
    }
    let (early, late) = (solve(&bearing(ramp), 0.0), solve(&bearing(ramp), 7.0));
    assert!(late.balls[0].inner.force_n > 1.5 * early.balls[0].inner.force_n);
}

/// Wrong: the shaft would be driven to another place, at another rate, or where it should be free.
#[test]
fn prescribed_motions_follow_their_schedules() {
    let model = bearing(ramp);
    assert_eq!(
        (model.prescribed(3, 2.0), model.prescribed_rate(3, 2.0)),
        (None, None)
    );
    let (place, rate) = (
        model.prescribed(4, 2.0).unwrap(),
        model.prescribed_rate(4, 2.0).unwrap(),
    );
    // Halfway from 0.5 to 1.4, and 0.9 in 2 s.
    assert!((place - 4e-4 * 0.95).abs() < 1e-18 && (rate - 4e-4 * 0.45).abs() < 1e-18);
    assert_eq!(bearing(|_| Schedule::Constant).prescribed(4, 9.0), Some(4e-4));
}
