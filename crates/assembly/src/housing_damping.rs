//! Damping of bearings in bodies that carry several, in slow motions.
//!
//! To the rows of each bearing ([`dynamics::moved_seat`]) come those of the motions d of its seats by the others. With
//! F' the part of the flexibility of a body between different seats, and -p the forces of a ring on its functions, d is
//! F' p. A body loses energy as the rings do, in proportion b to its stiffness, so that its flexibility at the slow
//! rate s is F' / (1 + s b), and to first order
//!
//! ```text
//! (1 + s b) d + F' (K_p + s C_p) (q, d) = 0
//! ```
//!
//! K_p and C_p are the rows of -p. All but the places of the bearings on the shaft is condensed out
//! ([`Condensation`]). Cost: dense factors of the rows of all bearings in bodies.

use dense::DenseError;
use dynamics::condensation::Condensation;
use dynamics::moved_seat::SeatMatrices;
use dynamics::stiffness::N_SHAFT;

use crate::housing::SharedBody;

/// Where the rows of the bearings are among all.
struct CoupledPlaces {
    /// First of the place on the shaft, by bearing.
    kept: Vec<usize>,
    /// First of the other rows of its own.
    own: Vec<usize>,
    /// First of the functions of its seats.
    functions: Vec<usize>,
    n_kept: usize,
    n: usize,
}

impl CoupledPlaces {
    fn new(bearings: &[Option<SeatMatrices>]) -> CoupledPlaces {
        let mut next = 0;
        let mut starts = |size: &dyn Fn(&SeatMatrices) -> usize| -> Vec<usize> {
            let start = |own: &Option<SeatMatrices>| {
                let first = next;
                next += own.as_ref().map_or(0, size);
                first
            };
            bearings.iter().map(start).collect()
        };
        let kept = starts(&|_| N_SHAFT);
        let own = starts(&|own| own.n_own - N_SHAFT);
        let functions = starts(&n_functions);
        CoupledPlaces {
            n_kept: own.first().copied().unwrap_or_default(),
            kept,
            own,
            functions,
            n: next,
        }
    }

    /// A row of a bearing among all.
    fn of(&self, bearing: usize, own: &SeatMatrices, row: usize) -> usize {
        match row {
            0..N_SHAFT => self.kept[bearing] + row,
            _ if row < own.n_own => self.own[bearing] + row - N_SHAFT,
            _ => self.functions[bearing] + row - own.n_own,
        }
    }
}

fn n_functions(own: &SeatMatrices) -> usize {
    own.functions.iter().flatten().map(|range| range.len()).sum()
}

/// Matrices to which rows are added, row-major of `n` columns.
struct CoupledMatrices {
    n: usize,
    stiffness: Vec<f64>,
    damping: Vec<f64>,
}

impl CoupledMatrices {
    /// Adds a row of a bearing, times a factor, to one of all.
    fn add(
        &mut self,
        (to, factor): (usize, f64),
        rows: &CoupledPlaces,
        (bearing, own): (usize, &SeatMatrices),
        row: usize,
    ) {
        let m = own.n_own + n_functions(own);
        let damping = own.damping.as_deref();
        for column in 0..m {
            let at = self.n * to + rows.of(bearing, own, column);
            self.stiffness[at] += factor * own.stiffness[m * row + column];
            self.damping[at] += factor * damping.map_or(0.0, |damping| damping[m * row + column]);
        }
    }
}

/// Damping over the places of all bearings in bodies, each in its own frame, row-major; None without any.
pub fn damping_in_bodies(
    bodies: &[SharedBody],
    bearings: &[Option<SeatMatrices>],
) -> Result<Option<Vec<f64>>, DenseError> {
    if bearings.iter().all(Option::is_none) {
        return Ok(None);
    }
    let rows = CoupledPlaces::new(bearings);
    let mut all = CoupledMatrices {
        n: rows.n,
        stiffness: vec![0.0; rows.n * rows.n],
        damping: vec![0.0; rows.n * rows.n],
    };
    for (b, own) in bearings.iter().enumerate() {
        let Some(own) = own else { continue };
        (0..own.n_own).for_each(|row| all.add((rows.of(b, own, row), 1.0), &rows, (b, own), row));
        for row in rows.functions[b]..rows.functions[b] + n_functions(own) {
            all.stiffness[(rows.n + 1) * row] = 1.0;
            all.damping[(rows.n + 1) * row] = own.ring_damping;
        }
    }
    for body in bodies {
        add_body(body, bearings, &rows, &mut all);
    }
    let condensation = Condensation::new(rows.n, rows.n_kept, &all.stiffness)?;
    Ok(Some(condensation.apply(&all.damping)))
}

/// Adds F' times the forces on a body to the rows of its functions.
fn add_body(
    body: &SharedBody,
    bearings: &[Option<SeatMatrices>],
    rows: &CoupledPlaces,
    all: &mut CoupledMatrices,
) {
    let functions = |b: usize| {
        let own = bearings[b].as_ref()?;
        Some((own, own.functions[body.side().index()].clone()?))
    };
    for (moved, moved_tie) in body.seats() {
        let Some((_, to)) = functions(moved) else { continue };
        for (loaded, loaded_tie) in body.seats().filter(|(loaded, _)| *loaded != moved) {
            let (Some((own, from)), Some(of_body)) = (functions(loaded), &moved_tie.body) else {
                continue;
            };
            let n = of_body.n_functions();
            for (k, f) in to.clone().zip(moved_tie.own()) {
                for (l, g) in from.clone().zip(loaded_tie.own()) {
                    let flexibility = of_body.flexibility[n * f + g];
                    let row = rows.functions[moved] + k;
                    all.add((row, flexibility), rows, (loaded, own), own.n_own + l);
                }
            }
        }
    }
}
