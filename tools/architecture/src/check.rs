//! Rules that hold or not: dependencies and words.

use regex_lite::Regex;

use crate::place::Place;
use crate::rules::{Rules, WordRule};
use crate::source::Source;
use crate::workspace::{Crate, Workspace};

/// Dependencies that are not among those a crate may have. Crates without a rule are told too.
pub fn dependencies(workspace: &Workspace, rules: &Rules) -> Vec<Place> {
    let mut found = Vec::new();
    for krate in &workspace.crates {
        let Some(rule) = rules.of_crate(&krate.name) else {
            let text = format!("crate {} has no rule in rules.toml", krate.name);
            found.push(Place::of_file(&krate.manifest, text));
            continue;
        };
        for name in &krate.dependencies {
            let allowed = match (workspace.find(name), &rule.libraries) {
                (Some(_), _) => Some(&rule.uses),
                (None, libraries) => libraries.as_ref(),
            };
            if let Some(allowed) = allowed
                && !allowed.contains(name)
            {
                let text = format!("depends on {name}; allowed are {}", allowed.join(", "));
                found.push(Place::of_file(&krate.manifest, text));
            }
        }
    }
    found
}

/// Code that names what it may not.
pub fn words(workspace: &Workspace, rules: &Rules, proper: &[&Source]) -> anyhow::Result<Vec<Place>> {
    let mut found = Vec::new();
    for rule in &rules.words {
        let pattern = Regex::new(&rule.pattern)?;
        for krate in &workspace.crates {
            for source in sources_under(workspace, rule, krate, proper) {
                for (line, code) in source.code.iter().enumerate() {
                    if pattern.is_match(code) {
                        let text = format!("{}  <- {}", code.trim(), rule.rule);
                        found.push(Place::of_line(&source.path, line + 1, text));
                    }
                }
            }
        }
    }
    Ok(found)
}

/// Sources that a rule speaks of. `not` looks at a crate proper, `only` at benchmarks and examples too.
fn sources_under<'a>(
    workspace: &'a Workspace,
    rule: &WordRule,
    krate: &'a Crate,
    proper: &[&'a Source],
) -> Vec<&'a Source> {
    if rule.not.contains(&krate.name) {
        let inside = |source: &&&Source| source.path.starts_with(&krate.folder);
        return proper.iter().filter(inside).copied().collect();
    }
    let holds = rule.only.iter().any(|name| workspace.find(name).is_some());
    if holds && !rule.only.contains(&krate.name) {
        return workspace.sources_of(krate).collect();
    }
    Vec::new()
}
