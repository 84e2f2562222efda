//! Writes the results into `stability.md`, between its marks, and plots beside it. Cases that were not run keep their
//! lines.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use super::{Finished, Group, plot};

const BEGIN: &str = "<!-- results: written by scripts/hard-cases -->";
const END: &str = "<!-- end of results -->";
const HEAD: &str =
    "| case | why it is hard | settings | ledger defect | what held, what happened |\n|---|---|---|---|---|";

/// Writes tables into `folder/stability.md`, plots into `folder/images/stability/`.
pub fn write(folder: &Path, groups: &[Group], finished: &[Finished]) {
    let path = folder.join("stability.md");
    let page = std::fs::read_to_string(&path).unwrap();
    let (head, rest) = page
        .split_once(BEGIN)
        .expect("the page has the mark where results begin");
    let (before, tail) = rest
        .split_once(END)
        .expect("the page has the mark where results end");
    let images = folder.join("images/stability");
    std::fs::create_dir_all(&images).unwrap();
    let (mut lines, mut details) = earlier(before);
    for f in finished {
        lines.insert(f.case.name.to_string(), line(f));
        details.insert(f.case.name.to_string(), detail(f, &images));
    }
    let (mut text, mut n) = (String::new(), 0);
    for (i, group) in groups.iter().enumerate() {
        write!(text, "\n\n## {}. {}\n\n{HEAD}", i + 1, group.title).unwrap();
        let of = |all: &BTreeMap<String, String>| -> Vec<String> {
            group
                .cases
                .iter()
                .filter_map(|c| all.get(c.name).cloned())
                .collect()
        };
        let rows = of(&lines);
        n += rows.len();
        rows.iter().for_each(|l| write!(text, "\n{l}").unwrap());
        of(&details).iter().for_each(|d| text.push_str(d));
    }
    let total = format!("\n\n{n} cases.\n");
    std::fs::write(&path, format!("{head}{BEGIN}{text}{total}{END}{tail}")).unwrap();
}

/// Lines, and tables with plots, of the cases that stand on the page, by their names.
fn earlier(text: &str) -> (BTreeMap<String, String>, BTreeMap<String, String>) {
    let rows = text
        .lines()
        .filter(|l| l.starts_with("| ") && l.matches(" | ").count() >= 4);
    let name = |line: &str| line.split('|').nth(1).map(|n| n.trim().to_string());
    let lines = rows.filter_map(|l| Some((name(l)?, l.to_string()))).collect();
    let paragraphs: Vec<&str> = text.split("\n\n").collect();
    let mut details: BTreeMap<String, String> = BTreeMap::new();
    for (i, paragraph) in paragraphs.iter().enumerate() {
        let table = paragraph.strip_prefix("**").and_then(|p| p.split_once("**: "));
        let image = paragraph.strip_prefix("![").and_then(|p| p.split_once("]("));
        if let Some((name, _)) = table {
            let rows = paragraphs.get(i + 1).unwrap_or(&"");
            write!(
                details.entry(name.to_string()).or_default(),
                "\n\n{paragraph}\n\n{rows}"
            )
            .unwrap();
        } else if let Some((name, _)) = image {
            write!(details.entry(name.to_string()).or_default(), "\n\n{paragraph}").unwrap();
        }
    }
    (lines, details)
}

/// Tables and plot of a case.
fn detail(f: &Finished, images: &Path) -> String {
    let (name, mut text) = (f.case.name, String::new());
    for table in &f.record.tables {
        write!(text, "\n\n**{name}**: verdicts\n\n{table}").unwrap();
    }
    if let Some(plot) = &f.record.plot {
        plot::write(&images.join(format!("{name}.svg")), name, plot);
        write!(text, "\n\n![{name}](images/stability/{name}.svg)").unwrap();
    }
    text
}

fn line(f: &Finished) -> String {
    let defect = f.record.defect.map_or("-".to_string(), |d| format!("{d:.1e}"));
    let failures = f.record.failures();
    let mut found: Vec<String> = f.record.held();
    found.extend(f.record.happened.iter().cloned());
    let verdict = match failures.as_slice() {
        [] => String::new(),
        _ => format!("**does not hold: {}**; ", failures.join("; ")),
    };
    // A row is one line, whatever a failure says.
    let text = format!("{verdict}{}", found.join("; "));
    format!(
        "| {} | {} | {} | {defect} | {} |",
        f.case.name,
        f.case.why,
        f.case.settings,
        text.replace('|', "\\|").replace('\n', " ")
    )
}
