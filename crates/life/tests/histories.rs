//! Lives of histories by counting passes, against the static formula and closed forms.

mod support;

use std::f64::consts::TAU;

use contact::Side;
use dynamics::kinematics::BothRings;
use life::damage::{History, bearing_life, even_life, ring_life};
use life::spacing::Spacing;

use support::assert_close;

/// Number of balls of all tests.
const BALLS: usize = 18;
/// Ratings of a ball on the raceways, N.
const RATINGS: BothRings = [4184.0, 5449.0];

/// A bearing whose cage makes the share `cage` of the turns of the inner ring against the outer one.
struct Rolling {
    cage: f64,
}

impl Rolling {
    /// The history of ring angles, rad, `[inner, outer]` at each row; `force` of azimuth and row.
    fn history(&self, angles: &[BothRings], force: impl Fn(f64, usize) -> f64) -> History {
        let mut history = History::default();
        for (row, &[inner, outer]) in angles.iter().enumerate() {
            let cage = self.cage * inner + (1.0 - self.cage) * outer;
            let azimuths: Vec<f64> = (0..BALLS)
                .map(|ball| cage + TAU * ball as f64 / BALLS as f64)
                .collect();
            let forces = azimuths.iter().map(|azimuth| [force(*azimuth, row); 2]);
            history.forces.push(forces.collect());
            history.azimuths.push(azimuths);
            history.ring_angles.push([inner, outer]);
        }
        history
    }

    /// Lives of the rings, million revolutions.
    fn lives(&self, history: &History) -> BothRings {
        self.damage(history).map(|damage| 1e-6 * ring_life(&damage))
    }

    fn damage(&self, history: &History) -> [Vec<f64>; 2] {
        let per_turn = [1.0 - self.cage, self.cage].map(|share| BALLS as f64 * share);
        Side::BOTH.map(|side| {
            let i = side.index();
            history.damage(side, RATINGS[i], per_turn[i]).unwrap()
        })
    }
}

/// Angles of rings that turn evenly by these turns, in `n` steps.
fn even_turns([inner, outer]: BothRings, n: usize) -> Vec<BothRings> {
    let at = |i: usize| i as f64 / n as f64 * TAU;
    (0..=n).map(|i| [inner * at(i), outer * at(i)]).collect()
}

/// Force of a ball whose place counts.
fn of_place(angle: f64) -> f64 {
    300.0 + 100.0 * angle.cos() + 30.0 * (2.0 * angle).sin()
}

/// Equivalent force of the positions: (mean Q^power)^(1/power).
fn mean(power: f64) -> f64 {
    let sum: f64 = (0..360)
        .map(|p| of_place((p as f64 + 0.5) / 360.0 * TAU).powf(power))
        .sum();
    (sum / 360.0).powf(1.0 / power)
}

/// gamma = 1/9: in a turn 10 balls pass a place of the inner ring, 8 one of the outer ring, and the pattern is back.
const NINTH: Rolling = Rolling { cage: 4.0 / 9.0 };
/// Rows of a turn that bring the balls to every position of both rings at a row: 0.1 and 0.125 degrees on the rings.
const ROWS: usize = 1600;

/// Wrong: a history of one revolution would not have the life of ISO 16281: a ring that turns the mean of Q^3, one that
/// stands that of Q^(10/3), whichever ring turns and in whichever direction.
#[test]
fn one_revolution_is_the_static_formula() {
    let [turning, standing] = [3.0, 10.0 / 3.0].map(mean);
    for (turns, equivalent) in [
        ([1.0, 0.0], [turning, standing]),
        ([-1.0, 0.0], [turning, standing]),
        ([0.0, 1.0], [standing, turning]),
    ] {
        let history = NINTH.history(&even_turns(turns, ROWS), |azimuth, _| of_place(azimuth));
        assert_close("turns", history.turns(), 1.0, 1e-12);
        let lives = NINTH.lives(&history);
        for i in 0..2 {
            let expected = (RATINGS[i] / equivalent[i]).powi(3);
            assert_close(&format!("{turns:?}, ring {i}"), lives[i], expected, 1e-12);
        }
        let of_both = equivalent
            .iter()
            .zip(RATINGS)
            .map(|(q, c)| (q / c).powf(10.0 / 3.0));
        let expected = of_both.sum::<f64>().powf(-0.9);
        assert_close(
            "both",
            1e-6 * bearing_life(lives.map(|l| 1e6 * l)),
            expected,
            1e-12,
        );
    }
}

/// Wrong: a load that turns with the inner ring would spread over it, and one that turns against it would not.
#[test]
fn a_load_that_turns_with_a_ring_stays_on_it() {
    let angles = even_turns([1.0, 0.0], ROWS);
    let history = NINTH.history(&angles, |azimuth, row| of_place(azimuth - angles[row][0]));
    let [inner, outer] = NINTH.lives(&history);
    assert_close("inner", inner, (RATINGS[0] / mean(10.0 / 3.0)).powi(3), 1e-12);
    assert_close("outer", outer, (RATINGS[1] / mean(3.0)).powi(3), 1e-12);
}

/// Wrong: the end of a history, or where the balls stand then, would change a life; also how fast time runs, and a
/// number of rows that has nothing to do with positions.
#[test]
fn equal_forces_live_alike_in_any_history() {
    let rolling = Rolling { cage: 0.43314 };
    let expected = RATINGS.map(|rating| (rating / 331.78).powi(3));
    let angles = [
        even_turns([1.0, 0.0], 667),
        even_turns([0.05, 0.0], 11),
        even_turns([-3.7, 1.9], 500),
        // A speed that changes, and a rest.
        (0..300)
            .map(|i| [1e-4 * f64::from(i.min(200)).powi(2), 0.0])
            .collect(),
    ];
    for angles in angles {
        let lives = rolling.lives(&rolling.history(&angles, |_, _| 331.78));
        for i in 0..2 {
            assert_close("life", lives[i], expected[i], 1e-12);
        }
    }
}

/// Wrong: two levels of load one after the other would not add their damage by their turns.
#[test]
fn two_levels_add_by_their_turns() {
    let n = 10_000;
    let angles = even_turns([10.0, 0.0], n);
    // The level changes within one of the rows.
    let history = NINTH.history(&angles, |_, row| if row <= 3 * n / 10 { 500.0 } else { 250.0 });
    let lives = NINTH.lives(&history);
    for i in 0..2 {
        let damage = |force: f64| (force / RATINGS[i]).powi(3);
        let expected = 1.0 / (0.3 * damage(500.0) + 0.7 * damage(250.0));
        assert_close("life", lives[i], expected, 2e-3);
    }
    let even = NINTH.damage(&history).map(|damage| 1e-6 * even_life(&damage));
    // The damage of each ring is even.
    let round_off = 1.0 - 1e-12;
    assert!(
        (0..2).all(|i| even[i] >= round_off * lives[i]),
        "{even:?} {lives:?}"
    );
}

/// Wrong: an oscillating bearing would live as one that turns. Each ball goes to and fro over its own arc; with the
/// share s of the raceway that the arcs cover, 1/L = q / s on them and L = s^(1/10) / q (weakest link of the covered
/// part).
#[test]
fn oscillation_lives_by_the_arcs_that_are_passed() {
    // The cage swings by 8 degrees on the outer ring, by 10 on the inner one: balls stand 20 degrees apart.
    let swing = 18.0_f64.to_radians();
    let angle = |i: i32| swing * f64::from(if i <= 400 { i } else { 800 - i }) / 400.0;
    let angles: Vec<BothRings> = (0..=800).map(|i| [angle(i), 0.0]).collect();
    let history = NINTH.history(&angles, |_, _| 331.78);
    assert_close("turns", history.turns(), 2.0 * 18.0 / 360.0, 1e-12);
    let lives = NINTH.lives(&history);
    for (i, share) in [(0, 10.0 / 20.0), (1, 8.0 / 20.0_f64)] {
        let expected = share.powf(0.1) * (RATINGS[i] / 331.78).powi(3);
        assert_close(&format!("ring {i}"), lives[i], expected, 1e-12);
    }
}

/// Wrong: a place that a short history has not passed would live for ever.
#[test]
fn positions_between_passed_ones_take_what_is_between() {
    // Half the way from ball to ball.
    let history = NINTH.history(&even_turns([0.025, 0.0], 50), |azimuth, _| of_place(azimuth));
    let [_, outer] = NINTH.damage(&history);
    for (p, damage) in outer.iter().enumerate() {
        let expected = (of_place((p as f64 + 0.5).to_radians()) / RATINGS[1]).powi(3);
        assert_close(&format!("position {p}"), *damage, expected, 0.05);
    }
}

/// A history of 40 turns of the inner ring whose rows lie so many ball pitches of the cage apart.
fn sparse(pitches: f64, force: impl Fn(f64, usize) -> f64) -> History {
    let step = pitches * TAU / BALLS as f64 / NINTH.cage;
    let n = (40.0 * TAU / step) as usize;
    let angles: Vec<BothRings> = (0..=n).map(|row| [step * row as f64, 0.0]).collect();
    NINTH.history(&angles, force)
}

/// Wrong: rows that lie pitches apart would cut the peaks of forces off, and lives come out up to twice as long. The
/// mean damage is that of the rows at any distance; on the ring that stands it spreads, up to an even one.
#[test]
fn rows_far_apart_keep_the_mean_damage() {
    // Loads on half of the round: most forces between rows would be too small.
    let force = |angle: f64| 1000.0 * angle.cos().max(0.0).powf(1.5);
    let mean = |power: f64| {
        let sum: f64 = (0..3600)
            .map(|p| force(f64::from(p) / 3600.0 * TAU).powf(power))
            .sum();
        (sum / 3600.0).powf(1.0 / power)
    };
    let [turning, standing] = [3.0, 10.0 / 3.0].map(mean);
    for (pitches, spread) in [
        (0.05, 1e-4),
        (0.53, 2e-3),
        (1.37, 0.02),
        (2.71, 0.05),
        (5.3, 0.09),
    ] {
        let [inner, outer] = NINTH.lives(&sparse(pitches, |azimuth, _| force(azimuth)));
        let expected = (RATINGS[0] / turning).powi(3);
        assert_close(&format!("inner, {pitches}"), inner, expected, 2e-3);
        let expected = (RATINGS[1] / standing).powi(3);
        assert_close(
            &format!("outer, {pitches}"),
            outer,
            (1.0 + 0.5 * spread) * expected,
            0.6 * spread,
        );
    }
}

/// Wrong: rows too far apart for the forces would stand without a word, or rows that do no harm would be blamed: those
/// under equal forces, and dense ones. The doubt of forces that come and go is 1/2 by its definition.
#[test]
fn the_doubt_is_that_of_forces_between_rows() {
    let of_half = |angle: f64, _: usize| 1000.0 * angle.cos().max(0.0).powf(1.5);
    let axial = Spacing::of(&sparse(5.3, |_, _| 400.0));
    assert!(axial.doubt == 0.0 && !axial.is_too_wide(), "{axial:?}");
    assert_close("pitches", axial.pitches, 5.3, 1e-9);
    let come_and_go = Spacing::of(&sparse(0.3, |_, row| if row % 2 == 0 { 400.0 } else { 0.0 }));
    assert_close("comes and goes", come_and_go.doubt, 0.5, 1e-12);
    let dense = Spacing::of(&sparse(0.25, of_half));
    assert!(!dense.is_too_wide() && dense.doubt < 3e-3, "{dense:?}");
    let twice = Spacing::of(&sparse(0.5, of_half));
    assert_close("square of the distance", twice.doubt / dense.doubt, 4.0, 0.03);
    let far = Spacing::of(&sparse(2.71, of_half));
    assert!(far.is_too_wide() && far.error() == "up to a third", "{far:?}");
    assert_close("needed", far.needed(), 0.25 / 2.71, 1e-9);
    // A turn of the cage from row to row: every ball keeps its force, though places differ.
    let whole = Spacing::of(&sparse(18.0, of_half));
    assert!(whole.is_too_wide(), "{whole:?}");
}

/// Wrong: what cannot be counted would give a number.
#[test]
fn what_cannot_be_counted_is_said() {
    let said = |angles: &[BothRings]| {
        let history = NINTH.history(angles, |_, _| 100.0);
        let error = history.damage(Side::BOTH[1], 1e3, 8.0).unwrap_err();
        error.to_string()
    };
    let text = said(&[[0.3, 0.3], [0.5, 0.5]]);
    assert!(
        text.starts_with("the rings do not turn against each other in this run"),
        "{text}"
    );
    let text = said(&[[0.0, 0.0], [1e-3, 0.0]]);
    assert!(
        text.starts_with("the balls pass no position of the outer raceway"),
        "{text}"
    );
    let text = said(&[[0.0, 0.0], [0.1, 0.0], [0.0, 0.0]]);
    assert!(
        text.starts_with("the balls swing by 2.546 deg on the outer raceway; expected at least 5.0 deg"),
        "{text}"
    );
}
