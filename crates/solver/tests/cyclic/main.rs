//! The cyclic solver against the sparse one on assembled rings: one file per subject.

#[path = "../common/mod.rs"]
mod common;
mod defect;
mod definite;
mod halves;
mod hold;
mod rings;
mod solve;
mod space;
mod stencil;
