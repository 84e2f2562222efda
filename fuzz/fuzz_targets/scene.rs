//! Any text as a scene, after a zero byte `--set` arguments, one a line: it is read or refused with a message.

#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use scene::{AnyScene, MeshFiles, SceneError};

/// In the folder of the scenes, so that lists find the bearings they name.
const PATH: &str = "scenes/any.toml";

fn parse(text: &str, overrides: &[String]) -> Result<AnyScene, SceneError> {
    AnyScene::parse(text, Path::new(PATH), overrides, MeshFiles::MayBeMissing)
}

/// What the checkpoints keep must be read again as the same scene.
fn is_read_again(scene: &AnyScene) -> bool {
    match scene {
        AnyScene::One(one) => match parse(&one.text, &[]) {
            Ok(AnyScene::One(again)) => again.effects == one.effects && again.analysis == one.analysis,
            _ => false,
        },
        AnyScene::Several(list) => match parse(&list.text, &list.type_overrides()) {
            Ok(AnyScene::Several(again)) => again.effects == list.effects && again.analysis == list.analysis,
            _ => false,
        },
    }
}

fuzz_target!(|data: &str| {
    let (text, overrides) = data.split_once('\0').unwrap_or((data, ""));
    let overrides: Vec<String> = overrides.lines().map(str::to_string).collect();
    match parse(text, &overrides) {
        Ok(scene) => assert!(is_read_again(&scene), "read again, it is another scene"),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
