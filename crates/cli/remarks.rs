//! What is said about a run before it begins and stands in its summary: slips of the scene, and what `raceway check`
//! advises.

use comm::print;
use dynamics::Model;
use results::failure::Failure;
use results::mounting;
use scene::Scene;

use crate::rules;

/// Remarks on a run.
pub struct Remarks {
    /// What is most likely a slip; it was said where the meshes were read.
    pub warnings: Vec<String>,
    /// What rules of thumb say about effects.
    pub advice: Vec<String>,
}

impl Remarks {
    /// Those on a scene and its model, of which `doubts` are known. Says the advice, and what the scene leaves open.
    pub fn on(scene: &Scene, model: &Model, doubts: Vec<String>) -> Result<Remarks, Failure> {
        for line in model.mounting.report.iter().flat_map(mounting::lines) {
            print::note(format_args!("{line}"));
        }
        for line in &scene.assumed {
            print::note(format_args!("assumed: {line}"));
        }
        let advice = rules::advice(scene, model)?;
        for line in &advice {
            print::note(format_args!("advice: {line}"));
        }
        Ok(Remarks {
            warnings: doubts,
            advice,
        })
    }

    /// The same and what was found at the start of the run.
    pub fn with(mut self, warnings: impl IntoIterator<Item = String>) -> Remarks {
        self.warnings.extend(warnings);
        self
    }
}
