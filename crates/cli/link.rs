//! Build script: a program with HDF5 compiled in needs the C library alone, so the unwinder of libgcc is linked in too.
//!
//! Rust asks for the shared `libgcc_s`. A linker script of that name, found first, gives the archive `libgcc_eh` in its
//! place, which holds the same. It is linked at a fixed address, which makes it smaller.

use std::path::PathBuf;

fn main() {
    println!("cargo::rerun-if-changed=crates/cli/link.rs");
    if std::env::var_os("CARGO_FEATURE_STATIC_HDF5").is_none() {
        return;
    }
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR for build scripts"));
    let script = folder.join("libgcc_s.so");
    std::fs::write(&script, "GROUP ( -lgcc_eh -lgcc )\n")
        .unwrap_or_else(|error| panic!("cannot write {}: {error}", script.display()));
    println!("cargo::rustc-link-arg-bins=-L{}", folder.display());
    // At a fixed address half a megabyte of relocations is not needed.
    println!("cargo::rustc-link-arg-bins=-no-pie");
}
