//! Where the vectors of a periodic ring live: its state, increments and loads are harmonics.
//!
//! The state of a periodic ring never leaves harmonic space while it moves: matrices act there harmonic by harmonic
//! ([`solver::cyclic::HarmonicOperator`]), and so does the inertia of a turning frame, which is local in cylindrical
//! components. Nodal fields are made when results ask for them. Scalar products of nodal vectors are those of
//! Parseval. The dofs of a shaft that carries the bore stay what they are, behind the harmonics.

use std::borrow::Cow;
use std::sync::OnceLock;

use solver::cyclic::{HarmonicOperator, NODE_LEN, turned};
use solver::{CyclicRing, SolverError};

use super::periodic::HeldSectors;
use super::rigid::RigidMotions;
use super::space_defect::SpaceDefect;
use crate::matrices::{Matrix, Nodes};
use crate::pool::VectorPool;
use crate::state::{RingState, RowValues};
use crate::step::FrameTurn;
use crate::vectors::dot;

/// Harmonic space and what acts in it.
pub(crate) struct HarmonicSpace {
    pub(super) ring: CyclicRing,
    /// Rows of the border: dofs of the shaft.
    pub(super) n_shaft: usize,
    /// M.
    pub(super) mass: HarmonicOperator,
    /// K.
    pub(super) stiffness: HarmonicOperator,
    /// K_1, where the stress of turning stiffens the ring.
    stress: Option<HarmonicOperator>,
    /// A defect, of whose regular ring the matrices are.
    pub(super) defect: Option<SpaceDefect>,
    /// What strains nothing.
    rigid: RigidMotions,
    /// Vectors of the space that are free.
    pub(super) pool: VectorPool,
    /// Made when a frame turns for the first time.
    frame: OnceLock<FrameLoads>,
}

/// Inertia of a turning frame beyond that of the free nodes' motion, as low vectors: M P and M J of fields, with P u
/// = (u_x, u_y, 0) and J u = (u_y, -u_x, 0).
pub(super) struct FrameLoads {
    /// Of the node positions.
    position: [Vec<f64>; 2],
    /// Of the motion of the held nodes with each dof of the shaft.
    shaft: Vec<[Vec<f64>; 2]>,
}

/// Harmonics and border of the coordinates `y`.
pub(super) fn to_harmonics(ring: &CyclicRing, y: &[f64]) -> Vec<f64> {
    let (free, border) = y.split_at(ring.n());
    let mut x = vec![0.0; ring.harmonic_len() + border.len()];
    let (harmonics, rows) = x.split_at_mut(ring.harmonic_len());
    ring.to_harmonic(free, harmonics);
    rows.copy_from_slice(border);
    x
}

/// Coordinates of the harmonics and border `x`.
pub(super) fn from_harmonics(ring: &CyclicRing, x: &[f64]) -> Vec<f64> {
    let (harmonics, border) = x.split_at(ring.harmonic_len());
    let mut y = vec![0.0; ring.n() + border.len()];
    let (free, rows) = y.split_at_mut(ring.n());
    ring.from_harmonic(harmonics, free);
    rows.copy_from_slice(border);
    y
}

impl HarmonicSpace {
    /// Harmonic space of the free nodes of a periodic ring. With a defect `nodes` are those of its regular ring.
    pub(super) fn new(
        held: &HeldSectors,
        nodes: Nodes<'_>,
        defect: Option<SpaceDefect>,
    ) -> Result<HarmonicSpace, SolverError> {
        let free = &held.sectors;
        let operator = |matrix, [border, corner]: [Vec<f64>; 2]| {
            HarmonicOperator::new(&free.ring, matrix, &border, &corner)
        };
        let n_shaft = nodes.coordinates.shaft().0.len();
        let stiffness = operator(&free.stiffness, nodes.border([0.0, 1.0]))?;
        let stress = free.stress.as_ref();
        let stress = stress.map(|stress| operator(stress, nodes.stress_border()));
        let of_rigid = defect.as_ref().map_or(&free.ring, SpaceDefect::regular);
        Ok(HarmonicSpace {
            rigid: RigidMotions::new(of_rigid, nodes, &stiffness, defect.as_ref()),
            pool: VectorPool::new(free.ring.harmonic_len() + n_shaft),
            n_shaft,
            mass: operator(&free.mass, nodes.border([1.0, 0.0]))?,
            stiffness,
            stress: stress.transpose()?,
            ring: match &held.seen {
                Some(seen) => free.ring.seen_at(seen),
                None => free.ring.clone(),
            },
            defect,
            frame: OnceLock::new(),
        })
    }

    /// Length of a vector.
    pub(super) fn len(&self) -> usize {
        self.ring.harmonic_len() + self.n_shaft
    }

    /// Length of one group's part of a vector, of the first with the rows of the border.
    pub(super) fn part_len(&self, group: usize) -> usize {
        self.ring.low_len() + if group == 0 { self.n_shaft } else { 0 }
    }

    /// One group's share of the scalar product of two vectors, of its parts of them.
    pub(super) fn part_dot(&self, group: usize, a: &[f64], b: &[f64]) -> f64 {
        let low = self.ring.low_len();
        self.ring.group_dot(group, &a[..low], &b[..low]) + dot(&a[low..], &b[low..])
    }

    /// Kinetic and strain energy, J.
    pub(super) fn energies(&self, state: &RingState) -> [f64; 2] {
        let [w, v, _] = state.vectors();
        let mut strained = w.to_vec();
        self.put_low(self.strained_part(0, &self.low_of(w)).as_ref(), &mut strained);
        let mut regular = [(&self.mass, v, v), (&self.stiffness, &strained, w)].map(|(operator, a, x)| {
            let (product, len) = (operator.product(x), self.ring.harmonic_len());
            let harmonics = self.ring.harmonic_dot(&a[..len], &product[..len]);
            0.5 * (harmonics + dot(&a[len..], &product[len..]))
        });
        regular[1] += 0.5 * self.residual_energy(0, &self.low_of(w));
        match &self.defect {
            None => regular,
            Some(defect) => {
                let more = self.defect_energies(defect, w, &defect.of_state(state));
                [regular[0] + more[0], regular[1] + more[1]]
            }
        }
    }

    /// What a defect adds to kinetic and strain energy, J, of a state with the displacement `w`.
    pub(super) fn defect_energies(&self, defect: &SpaceDefect, w: &[f64], rows: &RowValues) -> [f64; 2] {
        let RowValues([on_rows, v, _]) = rows;
        let product = defect.product(Matrix::Stiffness, on_rows);
        let twice = self
            .rigid
            .twice_defect_energy(&self.ring, &self.low_of(w), [on_rows, &product]);
        [0.5 * defect.form(Matrix::Mass, v, v), 0.5 * twice]
    }

    /// The part of one group's displacement that is no rigid motion.
    pub(super) fn strained_part<'w>(&self, group: usize, w: &'w [f64]) -> Cow<'w, [f64]> {
        if group > 0 || self.rigid.is_empty() {
            return Cow::Borrowed(w);
        }
        Cow::Owned(self.rigid.strained(&self.ring, w))
    }

    /// Twice the energy that is left out with the rigid motion of one group's displacement: that of the round-off of K.
    pub(super) fn residual_energy(&self, group: usize, w: &[f64]) -> f64 {
        match group {
            0 => self.rigid.twice_residual_energy(&self.ring, w),
            _ => 0.0,
        }
    }

    /// The first group of a vector with the border.
    fn low_of(&self, x: &[f64]) -> Vec<f64> {
        [&x[..self.ring.low_len()], &x[self.ring.harmonic_len()..]].concat()
    }

    /// Puts the first group with the border into a vector.
    fn put_low(&self, low: &[f64], x: &mut [f64]) {
        let (harmonics, border) = low.split_at(self.ring.low_len());
        x[..harmonics.len()].copy_from_slice(harmonics);
        x[self.ring.harmonic_len()..].copy_from_slice(border);
    }

    /// a A b of a matrix A, 0 with one that the ring lacks.
    pub(super) fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        let operator = match matrix {
            Matrix::Mass => Some(&self.mass),
            Matrix::Stiffness => Some(&self.stiffness),
            Matrix::Stress => self.stress.as_ref(),
        };
        let Some(operator) = operator else { return 0.0 };
        let (product, len) = (operator.product(b), self.ring.harmonic_len());
        let regular = self.ring.harmonic_dot(&a[..len], &product[..len]) + dot(&a[len..], &product[len..]);
        let of_defect = |defect: &SpaceDefect| {
            let [a, b] = [a, b].map(|x| defect.values(x));
            defect.form(matrix, &a, &b)
        };
        regular + self.defect.as_ref().map_or(0.0, of_defect)
    }

    /// What the inertia of a turning frame needs; made when first asked for.
    pub(super) fn frame(&self, nodes: Nodes<'_>) -> &FrameLoads {
        self.frame.get_or_init(|| self.frame_loads(nodes))
    }

    /// One group of the generalised load of the turning frame, see [`crate::body::frame_load`]. `motion` gives
    /// displacement and velocity of the numbers of the group from the first one on; `field` is overwritten.
    pub(super) fn frame_part(
        &self,
        (turn, known): (FrameTurn, &FrameLoads),
        group: usize,
        motion: impl Fn(usize, [&mut [f64]; 2]),
        field: &mut [f64],
        load: &mut [f64],
    ) {
        let (speed, acceleration, low) = (turn.speed, turn.acceleration, self.ring.low_len());
        let (harmonics, rows) = field.split_at_mut(low);
        for (node, field) in harmonics.as_chunks_mut().0.iter_mut().enumerate() {
            let [mut w, mut v] = [[0.0; NODE_LEN]; 2];
            motion(NODE_LEN * node, [&mut w, &mut v]);
            // J u = -e_z x u.
            let own = w.map(|w| speed * speed * w);
            let across = std::array::from_fn(|i| -acceleration * w[i] - 2.0 * speed * v[i]);
            *field = turned(&own, &across);
        }
        rows.fill(0.0);
        self.mass.group_product(group, field, load);
        if let Some(stress) = &self.stress {
            self.displacement_part(&motion, field);
            let mut held = vec![0.0; field.len()];
            stress.group_product(group, field, &mut held);
            let terms = load.iter_mut().zip(&held);
            terms.for_each(|(load, held)| *load -= speed * speed * held);
        }
        if group > 0 {
            return;
        }
        let mut add = |[own, turned]: [f64; 2], [p, j]: &[Vec<f64>; 2]| {
            let terms = load.iter_mut().zip(p.iter().zip(j));
            terms.for_each(|(load, (p, j))| *load += own * p + turned * j);
        };
        add([speed * speed, acceleration], &known.position);
        let [mut q, mut rate] = [(); 2].map(|()| vec![0.0; self.n_shaft]);
        motion(low, [&mut q, &mut rate]);
        for ((q, rate), of_shaft) in q.into_iter().zip(rate).zip(&known.shaft) {
            add(
                [speed * speed * q, acceleration * q + 2.0 * speed * rate],
                of_shaft,
            );
        }
    }

    /// Overwrites `field` with the displacement of one group, of the first with the rows of the border.
    fn displacement_part(&self, motion: &impl Fn(usize, [&mut [f64]; 2]), field: &mut [f64]) {
        let low = self.ring.low_len();
        let (harmonics, rows) = field.split_at_mut(low);
        for (node, field) in harmonics.as_chunks_mut().0.iter_mut().enumerate() {
            let [mut w, mut v] = [[0.0; NODE_LEN]; 2];
            motion(NODE_LEN * node, [&mut w, &mut v]);
            *field = w;
        }
        if !rows.is_empty() {
            let mut rates = vec![0.0; rows.len()];
            motion(low, [rows, &mut rates]);
        }
    }

    fn frame_loads(&self, nodes: Nodes<'_>) -> FrameLoads {
        let ring = self.defect.as_ref().map_or(&self.ring, SpaceDefect::regular);
        let low = |load: Vec<f64>| {
            let (free, shaft) = load.split_at(ring.n());
            ring.to_low(free, shaft)
        };
        FrameLoads {
            position: nodes.inertia_of_positions().map(low),
            shaft: (0..self.n_shaft)
                .map(|k| nodes.inertia_of_shaft(k).map(low))
                .collect(),
        }
    }
}
