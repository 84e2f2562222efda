//! Rings whose vectors are coordinates: one sparse factor, sectors cut by angle, or a periodic ring whose defect its
//! harmonics cannot hold.
//!
//! Contacts and partner act by a compliance and then by the increment that their forces make. One sparse factor takes
//! one solve for a step: its forward half before the contacts, its backward half after. Between them stand Z = L^-1 W
//! of the contacts, which touches few columns of the factor ([`solver::triangular`]). In sectors, which ranks share,
//! both come from *columns* X = S^-1 W, solved in one block with the predictor. Those of the mount are found once per
//! step size.

mod body;
pub(crate) mod columns;
pub(crate) mod sector;
mod sector_columns;
pub(crate) mod sparse;
mod step;
