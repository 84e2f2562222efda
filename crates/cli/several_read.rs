//! A list of bearings as it is read: its meshes, and what only they tell.

use assembly::Assembly;
use dynamics::Model;
use results::failure::Failure;
use results::list_memory::require_memory_of_list;
use results::survey::{Survey, say_doubts};
use scene::{Scene, SeveralScene, build_assembly, doubts};

use crate::remarks::Remarks;
use crate::several_rules;

/// A list that has been read.
pub struct ReadList {
    /// The bearings on their shaft.
    pub assembly: Assembly,
    /// What its summary says of the scene; it has been said.
    pub remarks: Remarks,
    /// Where the bearings keep fields.
    pub surveys: Vec<Survey>,
}

/// Reads the meshes of a list (a point of `scene` when that is a sweep) and finds what only they tell, if a last test
/// passes. Every rank reads them whole, and may fail alone.
pub fn read_list(
    point: &SeveralScene,
    scene: &SeveralScene,
    test: impl FnOnce(&Assembly) -> Result<(), Failure>,
) -> Result<ReadList, Failure> {
    let (assembly, _) = build_assembly(point)?;
    let warnings = all_doubts(scene, &assembly);
    say_doubts(&warnings);
    test(&assembly)?;
    let remarks = Remarks {
        warnings,
        advice: several_rules::say(scene, &assembly)?,
    };
    let surveys = surveys(scene, &assembly)?;
    Ok(ReadList {
        assembly,
        remarks,
        surveys,
    })
}

/// Fails where all bearings together need more memory than there is.
pub fn require_memory_of_all(scene: &SeveralScene, assembly: &Assembly) -> Result<(), Failure> {
    let bearings = scene.bearings.iter().zip(&assembly.bearings);
    let listed: Vec<(&Scene, &Model)> = bearings
        .map(|(bearing, mounted)| (&bearing.scene, &mounted.model))
        .collect();
    require_memory_of_list(&scene.analysis, &listed)
}

/// The regions in which the bearings keep fields, if the scene has one.
pub fn surveys(scene: &SeveralScene, assembly: &Assembly) -> Result<Vec<Survey>, Failure> {
    let bearings = scene.bearings.iter().zip(&assembly.bearings);
    let survey = |(bearing, mounted): (&scene::BearingOnShaft, &assembly::MountedBearing)| {
        let survey = Survey::of_part(&bearing.scene, &mounted.model);
        survey.map_err(|failure| failure.context(format!("bearing {:?}", bearing.name)))
    };
    bearings.map(survey).collect()
}

/// What is most likely a slip, once for each type.
pub fn all_doubts(scene: &SeveralScene, assembly: &Assembly) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for (bearing, mounted) in scene.bearings.iter().zip(&assembly.bearings) {
        let new = doubts(&bearing.scene, &mounted.model);
        all.extend(
            new.into_iter()
                .filter(|line| !all.contains(line))
                .collect::<Vec<_>>(),
        );
    }
    if scene.effects.temperature.is_some() {
        all.push(
            "effects.temperature acts in each bearing; the axial growth of shaft and housing between bearings is left \
             out: give it with pairing.offset"
                .to_string(),
        );
    }
    all
}
