//! Systems that no bearing has yet: what the lists must be able to hold.

use super::newton::{Policy, RoundOff, Shortening};
use super::{
    BodyId, Character, ElasticPorts, Follow, Interaction, Interval, Lengths, Link, LinkForces, LinkRows,
    LinkTerm, Lumped, System,
};
use crate::error::DynamicsError;
use timer::SharedLaps;

/// A body with all coordinates free, held by springs to zero under a load.
struct Sprung {
    stiffness: f64,
    load: Vec<f64>,
    start: Vec<f64>,
}

impl Sprung {
    fn new(stiffness: f64, load: &[f64]) -> Sprung {
        Sprung {
            stiffness,
            load: load.to_vec(),
            start: vec![0.0; load.len()],
        }
    }
}

impl Lumped for Sprung {
    fn n_unknowns(&self) -> usize {
        self.load.len()
    }

    fn start(&self) -> &[f64] {
        &self.start
    }

    fn guess(&self, _interval: Interval) -> Vec<f64> {
        self.start.clone()
    }

    fn balance(&self, _interval: Interval, x: &[f64], residual: &mut [f64]) {
        for (r, (x, load)) in residual.iter_mut().zip(x.iter().zip(&self.load)) {
            *r = self.stiffness * x - load;
        }
    }

    fn tangent(&self, _interval: Interval) -> Vec<f64> {
        let n = self.load.len();
        (0..n * n)
            .map(|i| if i % (n + 1) == 0 { self.stiffness } else { 0.0 })
            .collect()
    }

    fn remedy(&self) -> &'static str {
        "hold it"
    }

    fn name(&self, unknown: usize) -> String {
        format!("sprung {unknown}")
    }
}

/// A point that an angle places on a circle: coordinates x and y, one unknown.
struct Pendulum {
    radius: f64,
    moment: f64,
    start: [f64; 2],
}

impl Lumped for Pendulum {
    fn n_coordinates(&self) -> usize {
        2
    }

    fn n_unknowns(&self) -> usize {
        1
    }

    fn start(&self) -> &[f64] {
        &self.start
    }

    fn place(&self, x: &[f64], end: &mut [f64]) {
        end.copy_from_slice(&[self.radius * x[0].cos(), self.radius * x[0].sin()]);
    }

    fn slopes(&self, x: &[f64]) -> Vec<(usize, usize, f64)> {
        vec![
            (0, 0, -self.radius * x[0].sin()),
            (1, 0, self.radius * x[0].cos()),
        ]
    }

    fn guess(&self, _interval: Interval) -> Vec<f64> {
        vec![0.0]
    }

    fn balance(&self, _interval: Interval, _x: &[f64], residual: &mut [f64]) {
        residual[0] = -self.moment;
    }

    fn tangent(&self, _interval: Interval) -> Vec<f64> {
        vec![0.0]
    }

    fn remedy(&self) -> &'static str {
        "hold it"
    }

    fn name(&self, _unknown: usize) -> String {
        "angle".to_string()
    }
}

/// Links with a matrix of their own, of any symmetry, about what they remember: F = A (l - memory).
struct Matrix {
    links: Vec<Link>,
    matrix: [[f64; 3]; 3],
    memory: Vec<[f64; 3]>,
}

impl Interaction for Matrix {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn n_rows(&self) -> usize {
        3
    }

    fn character(&self) -> Character {
        Character::General
    }

    fn evaluate(&self, lengths: Lengths, _costs: &SharedLaps) -> LinkForces {
        let mut found = LinkForces::default();
        for (link, memory) in self.memory.iter().enumerate() {
            let [_, end] = lengths.of::<3>(link);
            for row in self.matrix {
                let terms = (0..3).map(|j| row[j] * (end[j] - memory[j]));
                found.forces.push(terms.sum());
                found.tangents.extend(row);
            }
        }
        found
    }

    fn round_off(&self, _lengths: Lengths) -> f64 {
        0.0
    }
}

fn solve(system: &System) -> Result<Vec<f64>, DynamicsError> {
    let costs = SharedLaps::default();
    let policy = Policy {
        most_iterations: 100,
        residual_limit: 1e-10,
        force_scale: 1.0,
        round_off: RoundOff::Unknowns,
        ends_at_floor: false,
        keeps_factors: false,
        blocks: &[],
        scales: None,
        proximal: 0.0,
        longest_step: f64::INFINITY,
        search: Shortening::Residual(10),
        watch: &|_| Ok(()),
        costs: &costs,
    };
    Ok(system.solve(system.guess(), &policy)?.unknowns)
}

/// Largest out-of-balance force where the solution says that there is none.
fn defect(system: &System, x: &[f64]) -> f64 {
    let residual = system.evaluate(x, &SharedLaps::default()).residual;
    residual.iter().fold(0.0, |most, r| most.max(r.abs()))
}

fn three(body: BodyId, first: usize, sign: f64) -> [LinkTerm; 3] {
    let rows: [LinkRows; 3] = [0, 1, 2].map(|i| std::array::from_fn(|k| if k == i { sign } else { 0.0 }));
    [0, 1, 2].map(|i| LinkTerm {
        body,
        coordinate: first + i,
        rows: rows[i],
    })
}

const SKEW: [[f64; 3]; 3] = [[4.0, 1.0, 0.0], [-2.0, 5.0, 0.5], [0.0, -0.5, 3.0]];

/// Wrong: friction, whose tangent is not symmetric and which remembers slip, could not enter; a port of three
/// directions could not either. The solution is that of the linear system written by hand.
#[test]
fn a_family_with_memory_and_without_symmetry_meets_a_port_of_three_directions() {
    let ball = Sprung::new(2.0, &[1.0, -2.0, 0.5]);
    let ring = ElasticPorts {
        name: "inner",
        start: vec![0.0; 3],
        offset: vec![0.1, 0.0, -0.2],
        at_forces: vec![0.0, 0.3, 0.0],
        stiffness: vec![7.0, 1.0, 0.0, 1.0, 8.0, 2.0, 0.0, 2.0, 9.0],
        n_moving: 3,
        ..ElasticPorts::default()
    };
    let terms = [
        three(BodyId::Lumped(0), 0, 1.0),
        three(BodyId::Elastic(0), 0, -1.0),
    ]
    .concat();
    let links = Matrix {
        links: vec![Link::linear(LinkRows::default(), terms)],
        matrix: SKEW,
        memory: vec![[0.05, -0.1, 0.2]],
    };
    let system = System::new(Interval::Rest, vec![&ball], vec![&ring], vec![&links]);
    assert!(!system.has_energy(), "a skew tangent has no energy");
    let x = solve(&system).unwrap();
    // By hand: 2 x - f + A (x - g - m) = 0 and s + K (g - o) - A (x - g - m) = 0.
    let force = [0, 1, 2].map(|i| {
        (0..3)
            .map(|j| SKEW[i][j] * (x[j] - x[3 + j] - links.memory[0][j]))
            .sum::<f64>()
    });
    for i in 0..3 {
        assert!((2.0 * x[i] - ball.load[i] + force[i]).abs() < 1e-12);
        let elastic: f64 = (0..3)
            .map(|j| ring.stiffness[3 * i + j] * (x[3 + j] - ring.offset[j]))
            .sum();
        assert!((ring.at_forces[i] + elastic - force[i]).abs() < 1e-12);
    }
}

/// Wrong: a body with finite rotations could not enter without touching Newton. A point on a circle of radius r,
/// pulled to (0, -s) by a spring of stiffness k: the moment k r s cos(angle) balances the one applied.
#[test]
fn a_body_may_place_itself_by_an_angle() {
    let (radius, s) = (2.0, 3.0);
    let pendulum = Pendulum {
        radius,
        moment: 4.0 * radius * s * 0.3f64.cos(),
        start: [radius, 0.0],
    };
    let terms = [0, 1].map(|i| LinkTerm::new(BodyId::Lumped(0), i, [f64::from(i == 0), f64::from(i == 1)]));
    let spring = Matrix {
        links: vec![Link::linear(
            LinkTerm::new(BodyId::Lumped(0), 0, [0.0, s]).rows,
            terms.to_vec(),
        )],
        matrix: [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0; 3]],
        memory: vec![[0.0; 3]],
    };
    let system = System::new(Interval::Rest, vec![&pendulum], Vec::new(), vec![&spring]);
    let x = solve(&system).unwrap();
    assert!((x[0] + 0.3).abs() < 1e-9, "{x:?}");
}

/// Wrong: a seat of 225 functionals would enlarge Newton's system, or a second bearing's bodies not fit in the lists.
/// Ports that are held or follow a shaft have no unknowns, and what they ask for reaches the shaft.
#[test]
fn following_and_held_ports_have_no_unknowns() {
    let shafts = [
        Sprung::new(3.0, &[1.0, 0.0, 0.0, 0.0, 0.0]),
        Sprung::new(5.0, &[0.0, 2.0, 0.0, 0.0, 0.0]),
    ];
    let seat = |follow: Option<usize>, n_moving: usize, n: usize| ElasticPorts {
        name: "ring",
        start: vec![0.0; n],
        guess: Vec::new(),
        offset: vec![0.0; n],
        at_forces: Vec::new(),
        stiffness: (0..n * n)
            .map(|i| if i % (n + 1) == 0 { 2.0 } else { 0.0 })
            .collect(),
        n_moving,
        follow: follow.map(|body| Follow {
            body,
            frame: [0.7, 0.7],
        }),
    };
    let (wide, front, rear) = (seat(None, 2, 227), seat(Some(0), 2, 7), seat(Some(1), 2, 7));
    let system = System::new(
        Interval::Rest,
        shafts.iter().map(|shaft| shaft as &dyn Lumped).collect(),
        vec![&wide, &front, &rear],
        Vec::new(),
    );
    assert_eq!(
        system.n(),
        5 + 5 + 3 * 2,
        "225 held and 10 following ports have no unknowns"
    );
    let x = solve(&system).unwrap();
    // Each shaft carries its own spring and the seat that follows it, whatever the angle of the frame.
    assert!(
        (x[0] - 1.0 / 5.0).abs() < 1e-12 && (x[6] - 2.0 / 7.0).abs() < 1e-12,
        "{x:?}"
    );
    assert!(defect(&system, &x) < 1e-12);
}

/// Wrong: a tangent of the assembly would not be the derivative of its residual, and Newton would creep.
#[test]
fn the_tangent_is_the_derivative_of_the_residual() {
    let shaft = Sprung::new(3.0, &[1.0, 0.2, 0.0, 0.1, 0.0]);
    let mut ring = ElasticPorts {
        name: "inner",
        start: vec![0.0; 8],
        guess: Vec::new(),
        offset: vec![0.01; 8],
        at_forces: Vec::new(),
        stiffness: vec![0.0; 64],
        n_moving: 3,
        follow: Some(Follow {
            body: 0,
            frame: [0.4, 0.6],
        }),
    };
    for (i, k) in ring.stiffness.iter_mut().enumerate() {
        *k = if i % 9 == 0 {
            6.0
        } else {
            1.0 / (1.0 + (i / 8 + i % 8) as f64)
        };
    }
    let links = Matrix {
        links: vec![Link::linear(
            LinkRows::default(),
            [
                three(BodyId::Lumped(0), 2, 0.5),
                three(BodyId::Elastic(0), 0, -1.0),
            ]
            .concat(),
        )],
        matrix: SKEW,
        memory: vec![[0.0; 3]],
    };
    let system = System::new(Interval::Rest, vec![&shaft], vec![&ring], vec![&links]);
    let x: Vec<f64> = (0..system.n()).map(|i| 0.1 * i as f64).collect();
    let costs = SharedLaps::default();
    let at = system.evaluate(&x, &costs);
    let mut tangent = system.body_tangent(&x);
    system.add_link_tangents(&x, &at.links, &mut tangent);
    for j in 0..system.n() {
        let mut moved = x.clone();
        moved[j] += 1.0;
        let grown = system.evaluate(&moved, &costs).residual;
        for i in 0..system.n() {
            let exact = tangent[system.n() * i + j];
            // All is linear, so the difference over a step of one is the derivative.
            assert!((grown[i] - at.residual[i] - exact).abs() < 1e-11, "{i} {j}");
        }
    }
}
