//! `--json`: the answer of a command to another program, one line of JSON on standard output when it has ended.
//!
//! Every answer has `command`, `status` (finished, stopped or failed), `exit_code`, `error` (null if there is none),
//! `warnings` and `output`, the lines that a person would see on standard output. Commands add keys of their own.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use comm::print;
use serde::Serialize;
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::summary::SUMMARY_FILE;

/// Key of the folder of a run.
const RESULTS: &str = "results";

/// What commands have added.
static ADDED: Mutex<Vec<(String, Value)>> = Mutex::new(Vec::new());

/// Adds a key to the answer; costs nothing where no answer is asked for.
pub fn add(key: &str, value: impl Serialize) {
    if !print::manner().is_answer_only {
        return;
    }
    let value = serde_json::to_value(value).unwrap_or(Value::Null);
    let mut added = ADDED.lock().unwrap_or_else(PoisonError::into_inner);
    added.retain(|(name, _)| name != key);
    added.push((key.to_string(), value));
}

/// Names the folder of a run; the answer has its summary too.
pub fn add_results(dir: &Path) {
    add(RESULTS, dir);
}

/// The summary of a run, also of one that failed after its first step.
fn summary(added: &[(String, Value)]) -> Option<Value> {
    let (_, dir) = added.iter().find(|(key, _)| key == RESULTS)?;
    let text = std::fs::read_to_string(Path::new(dir.as_str()?).join(SUMMARY_FILE)).ok()?;
    serde_json::from_str(&text).ok()
}

/// Says the answer of a command that has ended.
pub fn say(command: &str, failure: Option<&Failure>) {
    let (output, warnings) = print::so_far();
    let status = match failure {
        None => "finished",
        Some(Failure::Stopped(_)) => "stopped",
        Some(Failure::User(_) | Failure::Numerical(_)) => "failed",
    };
    let answer = json!({
        "command": command,
        "status": status,
        "exit_code": failure.map_or(0, Failure::number),
        "error": failure.map(Failure::text),
        "warnings": warnings,
        "output": output,
    });
    let Value::Object(mut answer) = answer else { return };
    let added = std::mem::take(&mut *ADDED.lock().unwrap_or_else(PoisonError::into_inner));
    let summary = summary(&added).map(|summary| ("summary".to_string(), summary));
    answer.extend(added.into_iter().chain(summary));
    print::answer(&Value::Object(answer).to_string());
}
