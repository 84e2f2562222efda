//! Any text as a scene, after a zero byte `--set` arguments, one a line: it is read or refused with a message.

#![no_main]
#![allow(dead_code, unused_imports)]

#[path = "../../crates/scene/src/tables/mod.rs"]
mod tables;

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use tables::{MeshFiles, Scene};

fuzz_target!(|data: &str| {
    let (text, overrides) = data.split_once('\0').unwrap_or((data, ""));
    let overrides: Vec<String> = overrides.lines().map(str::to_string).collect();
    match Scene::parse(text, Path::new("scene.toml"), &overrides, MeshFiles::MayBeMissing) {
        Ok(scene) => {
            // What the checkpoints keep must be read again as the same scene.
            let again = Scene::parse(&scene.text, Path::new("scene.toml"), &[], MeshFiles::MayBeMissing);
            let again = again.expect("the text of a sound scene is a sound scene");
            let is_same = again.effects == scene.effects && again.analysis == scene.analysis;
            assert!(is_same, "read again, it is another scene");
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
