//! Patches that go along with their contacts as a bearing vibrates.
//!
//! On a flexible ring a contact acts on a patch with the weights W(s), where s are its contact angle alpha and the
//! force Q after which it has its size. Both follow the vectors l between the centres, which the patches measure:
//!
//! ```text
//! dl = a^T dy + B ds,       B = -d(W^T u)/ds,       ds = G dl,
//! df = D dl + F ds,         b_s = -(dW/ds) f        the load of a patch that moves under its force
//! ```
//!
//! with the tangent D of the contacts of a ball on patches that stay, the growth F of their forces with the patches at
//! the same l, and G from alpha(l) and Q(l, s). All are small matrices of one ball. With H = (1 - B G)^-1 they add
//! [a b] [D + F G; G] H a^T to the stiffness.
//!
//! That is not quite symmetric: a patch has no energy of its own. `symmetric` says what modes have in its place.
//!
//! Cost: two more columns for each contact.

use contact::{Meridian, Side};
use dense::{DenseError, DenseLu};

use super::columns::{LengthGrowth, LinkTangent};
use super::links::{VibratingLinks, link_tangents};
use crate::error::DynamicsError;
use crate::following::LENGTH_STEP;
use crate::interactions::raceway_contact::{N_ROWS, RacewayContacts, Site, SiteState, on_rings};
use crate::model::ContactMode;
use crate::patches_beside::{KINDS, PatchesBeside, StandingContacts};
use crate::raceway::Raceway;

/// Tangents of all interactions of the equilibrium and what they connect, on patches that go along.
pub fn links_with_patches(vibrating: &VibratingLinks<'_>) -> Result<Vec<LinkTangent>, DynamicsError> {
    let mut links = link_tangents(vibrating);
    let parts = vibrating.parts;
    if parts.free.is_some() || vibrating.rings.iter().all(Option::is_none) {
        return Ok(links);
    }
    let [_, reaches] = parts.reaches(&parts.unknowns(&vibrating.equilibrium.displacements));
    let patches = MovingPatches::new(vibrating, &parts.contacts.states(&reaches))?;
    for (ball, (lengths, link)) in reaches.chunks_exact(N_ROWS).zip(&mut links).enumerate() {
        patches.add(ball, lengths, link)?;
    }
    Ok(links)
}

/// The patches of the flexible rings of an equilibrium.
struct MovingPatches<'v> {
    vibrating: &'v VibratingLinks<'v>,
    rings: [Option<PatchesBeside>; 2],
    /// Force on the ring of every contact, N, with what loads it besides.
    forces: Vec<Meridian>,
    /// Step of a length, m.
    step: f64,
}

/// One number of a patch: on which ring, and in what it changes. Both count as forces, N: angles times the contact's.
struct Changing<'p> {
    side: Side,
    kind: usize,
    patches: &'p PatchesBeside,
    /// Newton per unit of the kind.
    unit: f64,
}

/// The contacts of a ball.
struct OfBall<'b> {
    sites: &'b [Site],
    /// l of the inner one, then of the outer one, m.
    lengths: [f64; N_ROWS],
    changing: &'b [Changing<'b>],
}

impl<'v> MovingPatches<'v> {
    /// Of a bearing whose contacts have patches.
    fn new(
        vibrating: &'v VibratingLinks<'v>,
        states: &[SiteState],
    ) -> Result<MovingPatches<'v>, DynamicsError> {
        let (model, parts) = (vibrating.model, vibrating.parts);
        let standing = StandingContacts {
            model,
            time: vibrating.equilibrium.pose.now.time,
            contacts: &parts.contacts,
            states,
        };
        let mut rings = [None, None];
        for side in Side::BOTH {
            if let Some(ring) = model.ring(side) {
                let raceway = Raceway::new(ring, ContactMode::Patch);
                rings[side.index()] = Some(PatchesBeside::new(&standing, side, &raceway)?);
            }
        }
        let mut forces = on_rings(states);
        let sums = forces.iter_mut().zip(&parts.contacts.dead);
        sums.for_each(|(sum, dead)| *sum = *sum + *dead);
        Ok(MovingPatches {
            vibrating,
            rings,
            forces,
            step: LENGTH_STEP * model.geometry.groove_distance(),
        })
    }

    /// Adds what they do to the link of a ball whose contacts have these lengths, m.
    fn add(&self, ball: usize, lengths: &[f64], link: &mut LinkTangent) -> Result<(), DynamicsError> {
        let changing = self.changing(ball);
        if changing.is_empty() {
            return Ok(());
        }
        let of_ball = OfBall {
            sites: &self.vibrating.parts.contacts.sites[2 * ball..][..2],
            lengths: std::array::from_fn(|i| lengths[i]),
            changing: &changing,
        };
        let motions: Vec<[f64; N_ROWS]> = changing
            .iter()
            .map(|changing| self.growth_of_lengths(ball, changing))
            .collect();
        let tangent = of_ball
            .tangent(&link.tangent, &motions, self.step)
            .map_err(|source| DynamicsError::ContactSystem { source })?;
        for changing in &changing {
            link.lengths.push(self.growth_of_load(ball, changing));
        }
        let n = link.lengths.len();
        let of_lengths = |i: usize, j: usize| if j < N_ROWS { tangent[N_ROWS * i + j] } else { 0.0 };
        link.tangent = (0..n * n).map(|e| of_lengths(e / n, e % n)).collect();
        Ok(())
    }

    fn changing(&self, ball: usize) -> Vec<Changing<'_>> {
        let rings = Side::BOTH.into_iter().zip(&self.rings);
        let loaded = rings.filter_map(|(side, ring)| Some((side, ring.as_ref()?)));
        let loaded = loaded.filter(|(_, patches)| patches.is_loaded(ball));
        let kinds = loaded.flat_map(|ring| KINDS.map(|kind| (ring, kind)));
        let changing = kinds.map(|((side, patches), kind)| Changing {
            side,
            kind,
            patches,
            unit: if kind == 0 { patches.size(ball) } else { 1.0 },
        });
        changing.collect()
    }

    /// Growth of l with a patch: of what it measures in the field of its ring, and of the fit that moves with the ring.
    fn growth_of_lengths(&self, ball: usize, changing: &Changing<'_>) -> [f64; N_ROWS] {
        let (side, kind) = (changing.side, changing.kind);
        let field = self.vibrating.equilibrium.elastic[side.index()].as_ref();
        let measured = field.map_or(Meridian::default(), |field| {
            changing.patches.growth_of_motion(kind, ball, field)
        });
        let [low, high] = changing.patches.sites(kind, ball).map(|site| site.reach);
        let reach = (high - low).map(|change| change / changing.patches.step(kind, ball));
        let mut growth = [0.0; N_ROWS];
        for (i, change) in (reach - measured).to_array().into_iter().enumerate() {
            growth[2 * side.index() + i] = change / changing.unit;
        }
        growth
    }

    /// What a patch that moves adds to the loads on its ring, as a length.
    fn growth_of_load(&self, ball: usize, changing: &Changing<'_>) -> LengthGrowth {
        let mut growth = LengthGrowth::default();
        let force = self.forces[2 * ball + changing.side.index()];
        if let Some((group, ring)) = self.vibrating.rings[changing.side.index()] {
            let loads = ring.contact_loads(&changing.patches.growth_of_load(ball, force));
            growth.add_ring(group, &loads[changing.kind], -1.0 / changing.unit);
        }
        growth
    }
}

impl OfBall<'_> {
    /// Growth of the forces on the rings, then of the numbers of the patches, with what moves the lengths besides
    /// patches: row-major, `[4 + numbers][4]`. `stays` is that of patches that stay, and `motions` the growth of the
    /// lengths with each number.
    fn tangent(&self, stays: &[f64], motions: &[[f64; N_ROWS]], step: f64) -> Result<Vec<f64>, DenseError> {
        let m = self.changing.len();
        let by_patch: Vec<(Vec<f64>, Vec<f64>)> = (0..m).map(|k| self.by_patch(k)).collect();
        let by_length: [Vec<f64>; N_ROWS] = std::array::from_fn(|i| self.by_length(i, step));
        // G = (1 - dQ/ds)^-1 ds/dl, column by column.
        let own = |i: usize, k: usize| if i == k { 1.0 } else { 0.0 };
        let kept: Vec<f64> = (0..m * m)
            .map(|e| own(e / m, e % m) - by_patch[e % m].1[e / m])
            .collect();
        let mut follow: Vec<f64> = by_length.concat();
        DenseLu::factor(m, &kept)?.solve(&mut follow, N_ROWS);
        // Rows of [D + F G; G].
        let row = |i: usize, c: usize| match i.checked_sub(N_ROWS) {
            Some(k) => follow[m * c + k],
            None => {
                let moved = (0..m).map(|k| by_patch[k].0[i] * follow[m * c + k]);
                stays[N_ROWS * i + c] + moved.sum::<f64>()
            }
        };
        // 1 - B G with the growth B of the lengths.
        let measured: Vec<f64> = (0..N_ROWS * N_ROWS)
            .map(|e| {
                let (i, c) = (e / N_ROWS, e % N_ROWS);
                own(i, c) - (0..m).map(|k| motions[k][i] * follow[m * c + k]).sum::<f64>()
            })
            .collect();
        let inverse = DenseLu::factor(N_ROWS, &measured)?.inverse();
        let entry = |e: usize| {
            let (i, c) = (e / N_ROWS, e % N_ROWS);
            (0..N_ROWS).map(|k| row(i, k) * inverse[N_ROWS * k + c]).sum()
        };
        Ok((0..(N_ROWS + m) * N_ROWS).map(entry).collect())
    }

    /// Growth of the forces on the rings, and of what the numbers of the patches follow, with a number of a patch at
    /// the same lengths.
    fn by_patch(&self, k: usize) -> (Vec<f64>, Vec<f64>) {
        let changing = &self.changing[k];
        let ball = self.sites[0].ball;
        let at = |place: usize| {
            let mut sites = self.sites.to_vec();
            sites[changing.side.index()] = changing.patches.sites(changing.kind, ball)[place].clone();
            let states = states(&sites, self.lengths);
            (forces(&states), self.followed(&states))
        };
        let (low, high) = (at(0), at(1));
        let step = changing.patches.step(changing.kind, ball) * changing.unit;
        (
            quotient((&low.0, &high.0), step),
            quotient((&low.1, &high.1), step),
        )
    }

    /// Growth of what the numbers of the patches follow with a length.
    fn by_length(&self, i: usize, step: f64) -> Vec<f64> {
        let at = |sign: f64| {
            let mut lengths = self.lengths;
            lengths[i] += sign * step;
            self.followed(&states(self.sites, lengths))
        };
        quotient((&at(-1.0), &at(1.0)), 2.0 * step)
    }

    /// Contact angles and forces of the patches, N.
    fn followed(&self, states: &[SiteState]) -> Vec<f64> {
        let of = |changing: &Changing<'_>| {
            let state = &states[changing.side.index()];
            match changing.kind {
                0 => state.angle * changing.unit,
                _ => state.force.force,
            }
        };
        self.changing.iter().map(of).collect()
    }
}

fn states(sites: &[Site], lengths: [f64; N_ROWS]) -> Vec<SiteState> {
    RacewayContacts::new(sites.to_vec(), Vec::new(), None).states(&lengths)
}

fn forces(states: &[SiteState]) -> Vec<f64> {
    on_rings(states)
        .iter()
        .flat_map(|force| force.to_array())
        .collect()
}

fn quotient((low, high): (&[f64], &[f64]), step: f64) -> Vec<f64> {
    low.iter()
        .zip(high)
        .map(|(low, high)| (high - low) / step)
        .collect()
}
