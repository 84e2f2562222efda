//! Rings whose vectors are coordinates: one sparse factor, sectors cut by angle, or a periodic ring whose defect its
//! harmonics cannot hold.
//!
//! Contacts and partner act by a compliance and then by the increment that their forces make. Both come from
//! *columns* X = S^-1 W of the contacts, solved in one block with the predictor, which reads the factor once. The
//! columns of the mount are solved once per step size.

mod body;
pub(crate) mod columns;
pub(crate) mod sector;
mod sector_columns;
pub(crate) mod sparse;
mod step;
