//! The cyclic solver against the sparse one on assembled rings: one file per subject.

mod defect;
mod definite;
mod halves;
mod hold;
mod rings;
mod solve;
mod space;
mod stencil;
