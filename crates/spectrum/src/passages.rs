//! Balls that pass a spall, found in the motion of the shaft.
//!
//! What the shaft does is that of a ball that loses its load and gets it back, gone through the shaft on its other
//! balls and through the ball between its raceways. Both are taken out. With m the mass that the shaft moves, a its
//! acceleration, s_j its motion along the normal n_j of ball j, and of the bearing before the passage the forces Q, the
//! approaches d_i and d_o and k_j = 1.5/(d_i/Q_i + d_o/Q_o),
//!
//! ```text
//! (q - 1) Q_i n = m a + sum over the other balls of k_j n_j s_j      # what ball n lacks; q: share of Q_i it has
//! y             = d_i (1 - q^(2/3)) - s                              # spall outside: place of the ball, outwards
//! w             = y + d_o (1 - (Q_o'/Q_o)^(2/3)),                    Q_o' = Q_o - (1 - q) Q_i - m_b y''
//! m_b y''       = q Q_i - (1 + y/d_o)^1.5 Q_o + Q_o - Q_i            # spall inside
//! w             = d_i (1 - q^(2/3)) - y - s
//! ```
//!
//! w is how deep the ball stands in the spall. **Entry**: it sinks by the parabola k v^2 t^2/2, so that the root of w
//! grows with time; the line through it meets zero at the edge. **Impact**: the kink half-way is the deepest place.
//! (N. Sawalhi and R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846, have the double impulse.) A ball that
//! flies meets the far edge later, and where it is the shaft does not feel. **Ball**: that whose own forces fall most.
//!
//! Validity: rings whose own motion is small beside that of balls and shaft; a mass that moves along x, y or z; steps
//! that resolve the passage. Cost: a few hundred operations per step and ball.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use contact::{BySide, Side};

/// Time that counts as undisturbed before a passage, over that from ball to ball.
const QUIET: f64 = 1.0 / 40.0;
/// Time from the first sign of a passage by which one looks back for its entry.
const BACK: f64 = 1.0 / 70.0;
/// Time that a passage takes at most.
const LONGEST: f64 = 0.6;
/// Share of its load that a ball lacks at the first sign, and least load that counts over the largest.
const SIGN: f64 = 0.06;
const LEAST_LOAD: f64 = 0.1;
/// Depth of a spall, m.
const LEAST_DEPTH: f64 = 0.5e-6;
/// Depths, over the largest, between which the root is a line; that at which the ball is on its way out.
const ROOT_FROM: f64 = 0.1;
const ROOT_TO: f64 = 0.6;
const OUT: f64 = 0.8;
/// Share of its load below which a ball flies, within the error of it; also its least depth ([`DEEPER`]).
const FLIES: f64 = 0.05;
/// Share of its load that a ball has left at most by its own forces where the shaft says that it flies.
const LITTLE: f64 = 0.5;
/// Time over which the ball's acceleration is differenced, s: a tenth of the period between its raceways.
const BEND: f64 = 3e-6;
/// Depth of a passage over that to which a ball sinks in a spall of its length, at most; the inverse is the least of a
/// ball that stays loaded, [`FLIES`] that of one that flies.
const DEEPER: f64 = 2.0;
/// Time from the deepest place to the way out over that from entry to it, at most: on a floor it is long.
const KINK: f64 = 0.5;
/// Samples that count as undisturbed at least.
pub const LEAST_QUIET: usize = 8;

/// A ball of the bearing at a step, each contact inner first.
#[derive(Clone, Copy, Debug, Default)]
pub struct BallAt {
    /// Azimuth in space, rad, without jumps.
    pub azimuth: f64,
    /// Forces, N.
    pub forces: BySide<f64>,
    /// Approaches, m.
    pub approaches: BySide<f64>,
    /// Contact angles, rad.
    pub angles: BySide<f64>,
}

/// A motion with equal steps.
#[derive(Clone, Debug)]
pub struct ShaftRecord {
    /// Time of the first step, s.
    pub start: f64,
    /// Step size, s.
    pub step: f64,
    /// Motions of the shaft x, y, z, tilt x, tilt y, m and rad.
    pub shaft: Vec<[f64; 5]>,
    /// All balls at every step.
    pub balls: Vec<Vec<BallAt>>,
}

/// What is known of the bearing.
#[derive(Clone, Copy, Debug)]
pub struct PassedBearing {
    /// The ring that may have a spall.
    pub side: Side,
    /// Mass that moves with the shaft, kg.
    pub mass: f64,
    /// Whether it may move along x, y and z.
    pub is_free: [bool; 3],
    /// Mass of a ball, kg, its diameter and that of the pitch circle, m.
    pub ball: (f64, f64, f64),
    /// Depth to which a ball sinks in a spall over the square of its length, 1/m.
    pub sag: f64,
    /// Mean speed of the cage, rad/s.
    pub cage: f64,
    /// Mean speed of the ring, rad/s.
    pub ring: f64,
}

/// A ball that passed a spall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpallPassage {
    /// Its number.
    pub ball: usize,
    /// When it enters, s.
    pub entry: f64,
    /// When it meets the far edge, s; of a ball whose length is not told when it has some load again.
    pub impact: f64,
    /// Azimuth of the middle of the spall on its ring at the start of the run, rad.
    pub azimuth: f64,
    /// Length of the spall, m: pi f (D_m^2 - D^2 cos^2 a)/D_m times the time between, f the speed of the ring in the
    /// frame of the other. No number where the ball flies and the shaft does not tell the impact.
    pub length: f64,
    /// Whether the ball flew: the length is then too large.
    pub flies: bool,
}

/// The bearing just before a passage: normals of the inner contacts, from the ball, with their levers for x, y, z and
/// tilts, and stiffnesses, N/m.
struct Before<'r> {
    balls: &'r [BallAt],
    normals: Vec<[f64; 5]>,
    stiffness: Vec<f64>,
    /// Mean motion and mean acceleration of the shaft.
    shaft: [f64; 5],
    acceleration: [f64; 3],
}

/// All passages of a motion, in their order.
pub fn passages(record: &ShaftRecord, known: &PassedBearing) -> Vec<SpallPassage> {
    let (mut found, mut at) = (Vec::new(), 1 + record.samples(known, QUIET));
    while at + 2 < record.shaft.len() {
        let until = (at + record.samples(known, LONGEST)).min(record.shaft.len() - 2);
        let before = record.before(known, at);
        let first = record.pushes(known, &before, at);
        if !loads(before.balls)
            .zip(&first)
            .any(|(load, push)| *push > SIGN * load)
        {
            at += 1;
            continue;
        }
        let from = record.from(known, at);
        let ball = record.unloaded(from, at + record.samples(known, QUIET));
        let told = record.passage(known, ball, at, until);
        let passage = told.filter(|passage| record.is_seen(passage, from));
        match passage.or_else(|| record.flight(known, ball, at, until)) {
            Some(passage) => {
                at = at.max(record.step_of(passage.entry)) + record.samples(known, LONGEST);
                found.push(passage);
            }
            None => at += record.samples(known, QUIET),
        }
    }
    found
}

impl PassedBearing {
    /// Time from ball to ball, s.
    fn period(&self, n_balls: usize) -> f64 {
        TAU / (n_balls as f64 * (self.cage - self.ring).abs())
    }
}

/// Loads of the balls, N; infinite of those that have too little to lack any.
fn loads(balls: &[BallAt]) -> impl Iterator<Item = f64> {
    let most = balls.iter().map(|ball| ball.forces[0]).fold(0.0, f64::max);
    let loads = balls.iter().map(|ball| ball.forces[0]);
    loads.map(move |load| {
        if load > LEAST_LOAD * most {
            load
        } else {
            f64::INFINITY
        }
    })
}

impl ShaftRecord {
    /// Steps in this share of the time from ball to ball.
    pub fn samples(&self, known: &PassedBearing, share: f64) -> usize {
        (share * known.period(self.balls[0].len()) / self.step).round() as usize
    }

    /// Whether steps are short enough to tell what is undisturbed.
    pub fn is_resolved(&self, known: &PassedBearing) -> bool {
        self.samples(known, QUIET) >= LEAST_QUIET
    }

    /// Acceleration of the shaft, m/s^2.
    fn acceleration(&self, step: usize) -> [f64; 3] {
        let at = step.clamp(1, self.shaft.len() - 2);
        [0, 1, 2].map(|k| {
            let [a, b, c] = [at - 1, at, at + 1].map(|i| self.shaft[i][k]);
            (a - 2.0 * b + c) / (self.step * self.step)
        })
    }

    /// The bearing before the step `at`.
    fn before(&self, known: &PassedBearing, at: usize) -> Before<'_> {
        let steps = at.saturating_sub(self.samples(known, QUIET)).max(1)..at.max(2);
        let n = steps.len() as f64;
        let mean = |value: &dyn Fn(usize) -> f64| steps.clone().map(value).sum::<f64>() / n;
        let balls = &self.balls[at];
        let normal = |ball: &BallAt| {
            let ((sin, cos), (rise, out)) = (ball.azimuth.sin_cos(), ball.angles[0].sin_cos());
            let radius = 0.5 * known.ball.2;
            [
                -out * cos,
                -out * sin,
                -rise,
                -rise * radius * sin,
                rise * radius * cos,
            ]
        };
        let stiffness = |ball: &BallAt| {
            let give: f64 = [0, 1].map(|k| ball.approaches[k] / ball.forces[k]).iter().sum();
            if give.is_finite() && give > 0.0 {
                1.5 / give
            } else {
                0.0
            }
        };
        Before {
            balls,
            normals: balls.iter().map(normal).collect(),
            stiffness: balls.iter().map(stiffness).collect(),
            shaft: [0, 1, 2, 3, 4].map(|k| mean(&|step| self.shaft[step][k])),
            acceleration: [0, 1, 2].map(|k| mean(&|step| self.acceleration(step)[k])),
        }
    }

    /// Motion of the shaft along the normal of each ball since before, m.
    fn along(&self, before: &Before, step: usize) -> Vec<f64> {
        let along = |n: &[f64; 5]| {
            (0..5)
                .map(|k| n[k] * (self.shaft[step][k] - before.shaft[k]))
                .sum()
        };
        before.normals.iter().map(along).collect()
    }

    /// What each ball lacks of its force at a step if no other ball does, N, and were it to follow the shaft.
    fn pushes(&self, known: &PassedBearing, before: &Before, step: usize) -> Vec<f64> {
        let (now, along) = (self.acceleration(step), self.along(before, step));
        let mut sum = [0, 1, 2].map(|k| known.mass * (now[k] - before.acceleration[k]));
        for ((n, k_j), s) in before.normals.iter().zip(&before.stiffness).zip(&along) {
            (0..3).for_each(|k| sum[k] += k_j * s * n[k]);
        }
        // Locked directions take any force.
        let dot = |n: &[f64; 5], v: [f64; 3]| -> f64 {
            (0..3).filter(|k| known.is_free[*k]).map(|k| n[k] * v[k]).sum()
        };
        let push = |n: &[f64; 5]| -dot(n, sum) / dot(n, [n[0], n[1], n[2]]).max(f64::MIN_POSITIVE);
        before.normals.iter().map(push).collect()
    }

    /// The step before a first sign from which on a passage is looked at.
    fn from(&self, known: &PassedBearing, sign: usize) -> usize {
        sign.saturating_sub(self.samples(known, BACK)).max(1)
    }

    /// Share of its force at the step `from` that a ball has at another, of the contact with less.
    fn left(&self, ball: usize, from: usize, step: usize) -> f64 {
        let [before, now] = [from, step].map(|step| self.balls[step][ball].forces);
        (now[0] / before[0]).min(now[1] / before[1])
    }

    /// The ball whose own forces fall most between two steps, of those that have some to lose.
    fn unloaded(&self, from: usize, until: usize) -> usize {
        let least = |(ball, load): (usize, f64)| match load.is_finite() {
            true => self.least_left(ball, from, from..until),
            false => f64::INFINITY,
        };
        let lefts = loads(&self.balls[from]).enumerate().map(least);
        let ball = lefts.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        ball.map_or(0, |(ball, _)| ball)
    }

    /// Least share that a ball has left of its force at the step `from` in a range of steps.
    fn least_left(&self, ball: usize, from: usize, steps: Range<usize>) -> f64 {
        let steps = steps.start..steps.end.min(self.balls.len());
        steps
            .map(|step| self.left(ball, from, step))
            .fold(f64::INFINITY, f64::min)
    }

    /// Whether a ball's own forces are those of its passage: one that flies has little left, and is back at the impact.
    fn is_seen(&self, passage: &SpallPassage, from: usize) -> bool {
        let [entry, impact] = [passage.entry, passage.impact].map(|time| self.step_of(time));
        let end = (impact + (KINK * (impact - entry) as f64) as usize).min(self.balls.len() - 1);
        let is_back = (impact..=end).any(|step| self.left(passage.ball, from, step) > FLIES);
        is_back && (!passage.flies || self.least_left(passage.ball, from, entry..end) < LITTLE)
    }

    /// The flight of a ball soon after a first sign, by its own forces, where no passage is told; its length is no
    /// number. None where it keeps its load, or has not got it back at the end.
    fn flight(&self, known: &PassedBearing, ball: usize, sign: usize, until: usize) -> Option<SpallPassage> {
        let from = self.from(known, sign);
        let is_off = |step: &usize| self.left(ball, from, *step) < FLIES;
        let off = (sign..sign + self.samples(known, QUIET))
            .take_while(|step| *step < until)
            .find(is_off)?;
        let on = (off..until).find(|step| !is_off(step))?;
        let [entry, impact] = [off, on].map(|step| self.start + self.step * step as f64);
        let middle = 0.5 * (self.balls[off][ball].azimuth + self.balls[on][ball].azimuth);
        let turned = middle - known.ring * (0.5 * (entry + impact) - self.start);
        Some(SpallPassage {
            ball,
            entry,
            impact,
            azimuth: (turned + PI).rem_euclid(TAU) - PI,
            length: f64::NAN,
            flies: true,
        })
    }

    fn step_of(&self, time: f64) -> usize {
        ((time - self.start) / self.step).round() as usize
    }

    /// The passage of a ball with its first sign at a step; None where it is none, or goes on at the end.
    fn passage(&self, known: &PassedBearing, ball: usize, sign: usize, until: usize) -> Option<SpallPassage> {
        let from = self.from(known, sign);
        let before = self.before(known, from);
        let at = before.balls[ball];
        let force = at.forces[0];
        let along: Vec<f64> = (from..until)
            .map(|step| self.along(&before, step)[ball])
            .collect();
        let share = |(step, s): (usize, &f64)| {
            let lacks = self.pushes(known, &before, step)[ball] + before.stiffness[ball] * s;
            (1.0 - lacks / force).max(0.0)
        };
        let shares: Vec<f64> = (from..until).zip(&along).map(share).collect();
        let depths = match known.side.sign() > 0.0 {
            true => self.depths_outside(known, &at, &shares, &along),
            false => self.depths_inside(known, &at, &shares, &along),
        };
        let (deepest, out) = deepest(&depths)?;
        let shallower = |share: f64| {
            depths[..deepest]
                .iter()
                .rposition(|w| *w <= share * depths[deepest])
        };
        let root = shallower(ROOT_FROM)? + 1..shallower(ROOT_TO)? + 2;
        let dt = self.step;
        let start = self.start + dt * from as f64;
        let entry = start
            + dt * zero_of_line(
                root.clone()
                    .map(|step| (step as f64, depths[step].max(0.0).sqrt())),
            )?;
        let impact = start + dt * deepest as f64;
        let half = impact - entry;
        let (cage, ring) = (known.cage, known.ring);
        let (_, diameter, pitch) = known.ball;
        let cos = at.angles[known.side.index()].cos();
        // Of the contact along the raceway, with cage and ring as they turned.
        let speed = 0.5 * (pitch + known.side.sign() * diameter * cos) * (cage - ring).abs();
        // Half as long again: a path may be lost before the flight.
        let last = (deepest + (deepest - root.start) / 2).min(shares.len() - 1);
        let turned = at.azimuth + cage * (impact - start) - ring * (impact - self.start);
        let length = 2.0 * speed * half;
        let flies = shares[..=last].iter().any(|share| *share < FLIES);
        let depth = depths[deepest] / (known.sag * length * length);
        let least = if flies { FLIES } else { 1.0 / DEEPER };
        let is_kink = dt * ((out - deepest) as f64) < KINK * half;
        let is_spall = half > 0.0 && is_kink && (least..DEEPER).contains(&depth);
        is_spall.then_some(SpallPassage {
            ball,
            entry,
            impact,
            azimuth: (turned + PI).rem_euclid(TAU) - PI,
            length,
            flies,
        })
    }

    /// How deep a ball stands in a spall of the outer ring, m.
    fn depths_outside(&self, known: &PassedBearing, at: &BallAt, shares: &[f64], along: &[f64]) -> Vec<f64> {
        let ([d_i, d_o], [q_i, q_o], dt) = (at.approaches, at.forces, self.step);
        let place = |(share, s): (&f64, &f64)| d_i * (1.0 - share.powf(2.0 / 3.0)) - s;
        let places: Vec<f64> = shares.iter().zip(along).map(place).collect();
        let half = (BEND / dt).round().max(1.0) as usize;
        let depth = |j: usize| {
            if j < half {
                return places[j];
            }
            let bend = (places[j - half] - 2.0 * places[j] + places[j + half]) / (half as f64 * dt).powi(2);
            let outer = 1.0 - ((1.0 - shares[j]) * q_i + known.ball.0 * bend) / q_o;
            places[j] + d_o * (1.0 - outer.clamp(0.0, 1.0).powf(2.0 / 3.0))
        };
        (0..places.len().saturating_sub(half)).map(depth).collect()
    }

    /// The same of the inner ring.
    fn depths_inside(&self, known: &PassedBearing, at: &BallAt, shares: &[f64], along: &[f64]) -> Vec<f64> {
        let ([d_i, d_o], [q_i, q_o], dt) = (at.approaches, at.forces, self.step);
        let (mut place, mut speed) = (0.0, 0.0);
        let depth = |(share, s): (&f64, &f64)| {
            let depth = d_i * (1.0 - share.min(1.0).powf(2.0 / 3.0)) - place - s;
            let outer = q_o * (1.0 + place / d_o).max(0.0).powf(1.5);
            speed += dt * ((share - 1.0) * q_i - (outer - q_o)) / known.ball.0;
            place += dt * speed;
            depth
        };
        shares.iter().zip(along).map(depth).collect()
    }
}

/// The deepest place before the ball is on its way out, and that where it is; None: it does not go in, or not out
/// again.
fn deepest(depths: &[f64]) -> Option<(usize, usize)> {
    let mut deepest = 0;
    for (step, depth) in depths.iter().enumerate() {
        if *depth > depths[deepest] {
            deepest = step;
        } else if depths[deepest] > LEAST_DEPTH && *depth < OUT * depths[deepest] {
            return Some((deepest, step));
        }
    }
    None
}

/// Where the straight line through points meets zero; None of fewer than three.
fn zero_of_line(points: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let points: Vec<(f64, f64)> = points.collect();
    let n = points.len() as f64;
    let x = points.iter().map(|point| point.0).sum::<f64>() / n;
    let y = points.iter().map(|point| point.1).sum::<f64>() / n;
    let above: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let below: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
    (points.len() > 2 && above > 0.0).then(|| x - y * below / above)
}
