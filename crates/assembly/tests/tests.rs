//! Tests of assemblies, one file or folder per area, in one program, so that its libraries are linked once.

mod beam;
mod heavy;
mod housed;
mod lists;
mod modes;
mod motion;
mod near;
mod pair;
mod quasi_static;
#[path = "../../dynamics/tests/support/mod.rs"]
mod support;
