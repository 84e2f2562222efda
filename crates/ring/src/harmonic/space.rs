//! Where the vectors of a periodic ring live: its state, increments and loads are harmonics.
//!
//! The state of a periodic ring never leaves harmonic space while it moves: matrices act there harmonic by harmonic
//! ([`solver::cyclic::HarmonicOperator`]), and so does the inertia of a turning frame, which is local in cylindrical
//! components. Nodal fields are made when results ask for them. Scalar products of nodal vectors are those of
//! Parseval. The dofs of a shaft that carries the bore stay what they are, behind the harmonics. Of a ring that ranks
//! share, a vector has the harmonics of its rank alone, and all dofs of the shaft.

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

/// Harmonics of this rank and border of the coordinates `y`.
pub(super) fn to_harmonics(ring: &CyclicRing, y: &[f64]) -> Vec<f64> {
    let (free, border) = y.split_at(ring.n());
    let mut x = vec![0.0; ring.harmonic_len() + border.len()];
    let (harmonics, rows) = x.split_at_mut(ring.harmonic_len());
    ring.to_harmonic(free, harmonics);
    rows.copy_from_slice(border);
    x
}

/// Coordinates of the harmonics of this rank and the border `x`. Collective.
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

    /// Length of a vector of all ranks.
    pub(super) fn whole_len(&self) -> usize {
        self.ring.whole_len() + self.n_shaft
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

    /// Kinetic and strain energy, J: the bits that a step finds as it ends. Collective.
    pub(super) fn energies(&self, state: &RingState) -> [f64; 2] {
        let [w, v, _] = state.vectors().map(|x| self.parts(x));
        let twice = self.over_groups([], |group, [mv, kw], []| {
            self.products(group, [w.of(group), v.of(group)], [mv, kw])
        });
        let rows = self.defect.as_ref().map(|defect| defect.of_state(state));
        self.with_defect(state, twice.map(|twice| 0.5 * twice), rows.as_ref())
    }

    /// M v and K w of one group into `mv` and `kw`; twice the energies, that of K without the round-off of rigid
    /// motions.
    pub(super) fn products(&self, group: usize, [w, v]: [&[f64]; 2], [mv, kw]: [&mut [f64]; 2]) -> [f64; 2] {
        self.mass.group_product(group, v, mv);
        self.stiffness.group_product(group, w, kw);
        let strained = self.strained_part(group, w);
        let strain = self.part_dot(group, &strained, kw) + self.residual_energy(group, w);
        [self.part_dot(group, v, mv), strain]
    }

    /// The energies of a state with those of the defect, whose rows have the values `rows`. Collective.
    pub(super) fn with_defect(
        &self,
        state: &RingState,
        [kinetic, strain]: [f64; 2],
        rows: Option<&RowValues>,
    ) -> [f64; 2] {
        let (Some(defect), Some(rows)) = (&self.defect, rows) else {
            return [kinetic, strain];
        };
        let mut more = match self.ring.has_first_group() {
            true => self.defect_energies(defect, state.displacement(), rows),
            false => [0.0; 2],
        };
        self.ring.share_first(&mut more);
        [kinetic + more[0], strain + more[1]]
    }

    /// What a defect adds to kinetic and strain energy, J, of a state with the displacement `w`, on the rank of the
    /// first group.
    fn defect_energies(&self, defect: &SpaceDefect, w: &[f64], rows: &RowValues) -> [f64; 2] {
        let RowValues([on_rows, v, _]) = rows;
        let product = defect.product(Matrix::Stiffness, on_rows);
        let twice = self
            .rigid
            .twice_defect_energy(&self.ring, &self.low_of(w), [on_rows, &product]);
        [0.5 * defect.form(Matrix::Mass, v, v), 0.5 * twice]
    }

    /// The part of one group's displacement that is no rigid motion.
    fn strained_part<'w>(&self, group: usize, w: &'w [f64]) -> Cow<'w, [f64]> {
        if group > 0 || self.rigid.is_empty() {
            return Cow::Borrowed(w);
        }
        Cow::Owned(self.rigid.strained(&self.ring, w))
    }

    /// Twice the energy that is left out with the rigid motion of one group's displacement: that of the round-off of K.
    fn residual_energy(&self, group: usize, w: &[f64]) -> f64 {
        match group {
            0 => self.rigid.twice_residual_energy(&self.ring, w),
            _ => 0.0,
        }
    }

    /// The first group of a vector with the border, on the rank of that group.
    pub(super) fn low_of(&self, x: &[f64]) -> Vec<f64> {
        [&x[..self.ring.low_len()], &x[self.ring.harmonic_len()..]].concat()
    }

    /// a A b of a matrix A, 0 with one that the ring lacks. Collective.
    pub(super) fn form(&self, matrix: Matrix, a: &[f64], b: &[f64]) -> f64 {
        let operator = match matrix {
            Matrix::Mass => Some(&self.mass),
            Matrix::Stiffness => Some(&self.stiffness),
            Matrix::Stress => self.stress.as_ref(),
        };
        let Some(operator) = operator else { return 0.0 };
        let [by_groups, of_groups] = [a, b].map(|x| self.parts(x));
        let [regular] = self.over_groups([], |group, [product], []| {
            operator.group_product(group, of_groups.of(group), product);
            [self.part_dot(group, by_groups.of(group), product)]
        });
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
