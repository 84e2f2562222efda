//! The page itself: every text of the run is escaped, nothing is loaded from elsewhere.

use html_escape::{encode_double_quoted_attribute, encode_text};
use results::whole;
use serde_json::Value;

use super::bearing;
use super::html::{Cells, digits, row, table};
use super::numbers::PageNumber;
use super::pictures::Picture;
use super::source::ReportedRun;

const STYLE: &str = include_str!("style.css");

/// Values under the pointer and zoom in the figures.
const SCRIPT: &str = include_str!("figures.js");

/// Key numbers below this are round-off in their units: um, mrad, deg, N, GPa.
const ROUND_OFF: f64 = 1e-9;

/// The HTML of a run of one bearing.
pub fn page(source: &ReportedRun, numbers: &[PageNumber], pictures: &[Picture]) -> String {
    let summary = &source.summary;
    let title = text(summary, "title");
    let parts = [
        format!("<h1>{}</h1>", encode_text(&title)),
        about(source),
        warnings(source),
        remarks("Advice", &list(summary, "advice")),
        remarks("Filled in where the scene is open", &list(summary, "assumed")),
        bearing::bearing(source.scene.as_deref()),
        modes(summary),
        key_numbers(numbers, summary),
        bearing::balls(summary),
        life(summary),
        figures(pictures),
        energy(summary),
        cost(summary, &source.files),
        scene(source.scene.as_deref()),
    ];
    document(&title, &parts)
}

/// A whole page that needs no other file.
pub fn document(title: &str, parts: &[String]) -> String {
    let title = encode_text(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n{}\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
        parts.join("\n")
    )
}

/// Whether a file is a page of this command.
pub fn is_page(content: &[u8]) -> bool {
    ["<h2>Warnings</h2>", "<h2>Key numbers</h2>"]
        .iter()
        .all(|head| whole::holds(content, head))
}

/// What was run, by which program, and how it ended.
fn about(source: &ReportedRun) -> String {
    let summary = &source.summary;
    let effects = list(summary, "effects").join(", ").replace('_', " ");
    let rows = [
        ("status", text(summary, "status")),
        ("scene file", text(summary, "scene")),
        ("analysis", text(summary, "analysis").replace('_', " ")),
        ("contact mode", text(summary, "contact_mode")),
        (
            "effects",
            if effects.is_empty() {
                "none".into()
            } else {
                effects
            },
        ),
        ("meshes", meshes(summary)),
        ("stress", bearing::stress(source.scene.as_deref())),
        ("program", program(summary, &source.commit)),
        ("ended", source.ended.clone()),
    ];
    let rows = rows.iter().filter(|(_, value)| !value.is_empty());
    let rows = rows.map(|(name, value)| row(name, std::slice::from_ref(value), Cells::Text));
    table("about", None, rows)
}

/// Elements and dofs of both rings.
pub fn meshes(summary: &Value) -> String {
    let dofs = summary
        .get("dofs")
        .and_then(Value::as_object)
        .into_iter()
        .flatten();
    let mesh = |(ring, dofs): (&String, &Value)| match summary["elements"][ring].as_u64() {
        Some(elements) if elements > 0 => format!("{ring} ring {elements} elements, {dofs} dofs"),
        _ => format!("{ring} ring {dofs} dofs"),
    };
    dofs.map(mesh).collect::<Vec<String>>().join(", ")
}

/// Name, version and commit of the program.
pub fn program(summary: &Value, commit: &str) -> String {
    let version = format!("raceway {}", text(summary, "version"));
    match commit {
        "" => version,
        commit => format!("{version}, commit {commit}"),
    }
}

/// A list under its heading; nothing where there is nothing to say.
pub fn remarks(heading: &str, lines: &[String]) -> String {
    let items: Vec<String> = lines
        .iter()
        .map(|line| format!("<li>{}</li>", encode_text(line)))
        .collect();
    match items.is_empty() {
        true => String::new(),
        false => format!(
            "<h2>{heading}</h2>\n<ul class=\"remarks\">\n{}\n</ul>",
            items.join("\n")
        ),
    }
}

pub fn warnings(source: &ReportedRun) -> String {
    let warnings = list(&source.summary, "warnings");
    let items: Vec<String> = source
        .doubts
        .iter()
        .chain(&warnings)
        .map(|w| format!("<li>{}</li>", encode_text(w)))
        .collect();
    match items.is_empty() {
        true => "<h2>Warnings</h2>\n<p>None.</p>".into(),
        false => format!(
            "<h2>Warnings</h2>\n<ul class=\"warnings\">\n{}\n</ul>",
            items.join("\n")
        ),
    }
}

/// Rows of the table of lives: name, keys from the summary, factor to the unit shown, and the unit.
const LIFE: [(&str, &str, f64, &str); 12] = [
    ("dynamic rating C_r", "/c_r_n", 1e-3, "kN"),
    ("static rating C_0r", "/c_0r_n", 1e-3, "kN"),
    ("equivalent load P, ISO 281", "/p_n", 1e-3, "kN"),
    (
        "life L_10, ISO 281",
        "/l10_revolutions",
        1e-6,
        "million revolutions",
    ),
    ("reference load P_ref, ISO 16281", "/p_ref_n", 1e-3, "kN"),
    (
        "life of the inner ring",
        "/inner/l10r_revolutions",
        1e-6,
        "million revolutions",
    ),
    (
        "life of the outer ring",
        "/outer/l10r_revolutions",
        1e-6,
        "million revolutions",
    ),
    (
        "life L_10r, ISO 16281",
        "/l10r_revolutions",
        1e-6,
        "million revolutions",
    ),
    ("life L_10r, ISO 16281", "/l10r_hours", 1.0, "h"),
    ("factor a_ISO", "/a_iso", 1.0, "1"),
    ("life L_nmr", "/l_nmr_revolutions", 1e-6, "million revolutions"),
    ("life L_nmr", "/l_nmr_hours", 1.0, "h"),
];

/// Ratings and life of the run, of a sweep those of its last point.
fn life(summary: &Value) -> String {
    let Some(life) = summary.get("life") else {
        return String::new();
    };
    let rows = LIFE.iter().filter_map(|(name, key, factor, unit)| {
        let value = life.pointer(key)?.as_f64()?;
        Some(row(
            name,
            &[digits(factor * value), unit.to_string()],
            Cells::Numbers,
        ))
    });
    let notes: Vec<String> = list(life, "notes")
        .iter()
        .map(|note| format!("<p>{}</p>", encode_text(note)))
        .collect();
    let head = ["quantity", "value", "unit"];
    let table = table("numbers", Some(&head), rows);
    format!("<h2>Life</h2>\n{table}\n{}", notes.join("\n"))
}

/// Natural frequencies of each body with the largest errors that they can have.
fn modes(summary: &Value) -> String {
    let Some(Value::Object(bodies)) = summary.get("modes") else {
        return String::new();
    };
    let numbers = |body: &Value, key: &str| -> Vec<f64> {
        let list = body.get(key).and_then(Value::as_array).into_iter().flatten();
        list.filter_map(Value::as_f64).collect()
    };
    let tables = bodies.iter().map(|(name, body)| {
        let (frequencies, bounds) = (numbers(body, "frequency_hz"), numbers(body, "bound_hz"));
        let rows = frequencies
            .iter()
            .zip(&bounds)
            .zip(1..)
            .map(|((frequency, bound), mode)| {
                row(
                    &mode.to_string(),
                    &[digits(*frequency), format!("{bound:.1e}")],
                    Cells::Numbers,
                )
            });
        let head = ["mode", "frequency, Hz", "largest error, Hz"];
        format!(
            "<h3>{}</h3>\n{}",
            encode_text(name),
            table("numbers", Some(&head), rows)
        )
    });
    let tables: Vec<String> = tables.collect();
    format!("<h2>Natural frequencies</h2>\n{}", tables.join("\n"))
}

pub fn key_numbers(numbers: &[PageNumber], summary: &Value) -> String {
    if numbers.is_empty() && summary.get("modes").is_some() {
        return "<h2>Key numbers</h2>\n<p>Those of the modes are above.</p>".into();
    }
    if numbers.is_empty() {
        return "<h2>Key numbers</h2>\n<p>The run has no tables of balls or shaft.</p>".into();
    }
    let rows = numbers.iter().map(|n| {
        let digits = |value: f64| digits(if value.abs() < ROUND_OFF { 0.0 } else { value });
        let rms = n.rms.map_or(String::new(), digits);
        let cells = [
            digits(n.smallest),
            digits(n.mean),
            digits(n.largest),
            rms,
            n.unit.to_string(),
        ];
        row(&n.name, &cells, Cells::Numbers)
    });
    let head = [
        "quantity",
        "smallest",
        "mean",
        "largest",
        "RMS about the mean",
        "unit",
    ];
    format!(
        "<h2>Key numbers</h2>\n<div class=\"wide\">{}</div>\n<p class=\"note\">Over all balls and all steps of the \
         tables; the root mean square is that over time, of single quantities of a motion. Peak pressures are \
         Hertz's.</p>",
        table("numbers", Some(&head), rows)
    )
}

pub fn figures(pictures: &[Picture]) -> String {
    let figure = |(name, svg): &Picture| {
        let name = name.replace('_', " ");
        format!(
            "<figure aria-label=\"{}\">\n{svg}</figure>",
            encode_double_quoted_attribute(&name)
        )
    };
    let figures: Vec<String> = pictures.iter().map(figure).collect();
    format!(
        "<h2>Figures</h2>\n<p class=\"note hint\">Point at a curve to read it. Drag over a part to enlarge it, along \
         one axis to enlarge that axis; a double click shows all again.</p>\n<div class=\"figures\">\n{}\n</div>",
        figures.join("\n")
    )
}

/// The energies of the end of the run.
pub fn energy(summary: &Value) -> String {
    let Some(Value::Object(terms)) = summary.get("energy_j") else {
        return String::new();
    };
    let rows = terms.iter().filter_map(|(name, value)| {
        let millijoule = digits(1e3 * value.as_f64()?);
        Some(row(&name.replace('_', " "), &[millijoule], Cells::Numbers))
    });
    format!(
        "<h2>Energy at the end</h2>\n{}",
        table("numbers", Some(&["term", "mJ"]), rows)
    )
}

/// Time by part, memory, files.
pub fn cost(summary: &Value, files: &[(String, u64)]) -> String {
    let mut parts = vec!["<h2>Cost</h2>".to_string()];
    if let Some(timing) = summary.get("timing_s").and_then(Value::as_object) {
        let total = timing.get("total").and_then(Value::as_f64).unwrap_or(0.0);
        let rows = timing.iter().filter_map(|(name, value)| {
            let seconds = value.as_f64()?;
            let share = if total > 0.0 { 100.0 * seconds / total } else { 0.0 };
            let cells = [format!("{seconds:.3}"), format!("{share:.1} %")];
            Some(row(&name.replace('_', " "), &cells, Cells::Numbers))
        });
        parts.push(table("numbers", Some(&["part", "s", "share"]), rows));
        parts.push(
            "<p class=\"note\">Parts that run at the same time may add up to more than the total.</p>".into(),
        );
    }
    if let Some(bytes) = summary.get("peak_memory_bytes").and_then(Value::as_f64) {
        parts.push(format!("<p>Peak memory: {}.</p>", megabytes(bytes)));
    }
    let rows = files
        .iter()
        .map(|(name, bytes)| row(name, &[megabytes(*bytes as f64)], Cells::Numbers));
    parts.push(table("numbers", Some(&["file", "size"]), rows));
    parts.join("\n")
}

pub fn scene(scene: Option<&str>) -> String {
    let pre = |text: &str| format!("<h2>Scene</h2>\n<pre class=\"scene\">{}</pre>", encode_text(text));
    scene.map_or(String::new(), pre)
}

/// A text of the summary; empty where it has none.
pub fn text(summary: &Value, key: &str) -> String {
    summary
        .get(key)
        .and_then(Value::as_str)
        .unwrap_or_default()
        .to_string()
}

pub fn list(summary: &Value, key: &str) -> Vec<String> {
    let items = summary.get(key).and_then(Value::as_array).into_iter().flatten();
    items
        .filter_map(|item| item.as_str().map(str::to_string))
        .collect()
}

fn megabytes(bytes: f64) -> String {
    match bytes {
        b if b >= 1e6 => format!("{:.1} MB", b / 1e6),
        b => format!("{:.1} kB", b / 1e3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the page of a search for modes would not tell a frequency.
    #[test]
    fn modes_have_a_table_for_each_body() {
        let summary = serde_json::json!({ "modes": {
            "bearing": { "frequency_hz": [1234.5678, 2000.0], "bound_hz": [1e-7, 2e-7] },
            "inner": { "frequency_hz": [4321.0], "bound_hz": [0.0] }
        } });
        let text = modes(&summary);
        for part in [
            "<h3>bearing</h3>",
            "<h3>inner</h3>",
            "1234.6",
            "2000.0",
            "2.0e-7",
            "4321.0",
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert_eq!(text.matches("<tr><th>2</th>").count(), 1, "{text}");
        assert_eq!(modes(&serde_json::json!({})), "");
    }

    /// Wrong: a title with signs of HTML would break the page.
    #[test]
    fn texts_are_escaped() {
        let summary = serde_json::json!({ "title": "a < b & <script>", "warnings": ["x > y"] });
        let source = ReportedRun {
            summary,
            doubts: vec![],
            scene: Some("# <pre>".into()),
            commit: "a<b".into(),
            ended: String::new(),
            files: vec![],
        };
        let page = page(&source, &[], &[]);
        assert!(
            page.contains("a &lt; b &amp; &lt;script&gt;") && page.matches("<script").count() == 1,
            "{page}"
        );
        assert!(
            page.contains("commit a&lt;b") && page.contains("x &gt; y") && page.contains("# &lt;pre&gt;"),
            "{page}"
        );
    }
}
