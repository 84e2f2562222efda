//! What was probably meant by a slip: other keys, other tables, signs that TOML does not have.

use super::reference;

/// What catalogues and other programs call a key or a word.
const LETTERS: [(&str, &str); 28] = [
    ("import", "include"),
    ("includes", "include"),
    ("d", "bore_diameter"),
    ("D", "outside_diameter"),
    ("B", "width"),
    ("Z", "balls"),
    ("z", "balls"),
    ("n_balls", "balls"),
    ("Dw", "ball_diameter"),
    ("dm", "pitch_diameter"),
    ("alpha", "contact_angle"),
    ("clearance", "radial_clearance"),
    ("C", "rating"),
    ("C0", "static_rating"),
    ("E", "young_modulus"),
    ("nu", "poisson_ratio"),
    ("rho", "density"),
    ("magnitude", "value"),
    ("force", "value"),
    ("value", "inner"),
    ("fixed", "clamped"),
    ("flexible", "patch"),
    ("temperature", "viscosity"),
    ("breadth", "width"),
    ("radial_load", "radial_force"),
    ("axial_load", "axial_force"),
    ("thrust", "axial_force"),
    ("load", "value"),
];
/// Names shorter than this are parts of too many others.
const SHORTEST_PART: usize = 4;
/// More suggestions than this are none.
const MOST: usize = 3;

/// The one name that was meant by a slip of the keyboard.
pub fn near<'a>(name: &str, valid: &[&'a str]) -> Option<&'a str> {
    let distances = valid.iter().map(|v| (strsim::osa_distance(v, name), *v));
    let (distance, v) = distances.min_by_key(|(distance, _)| *distance)?;
    (distance <= 1 + name.chars().count() / 4).then_some(v)
}

/// Names that were meant: by a slip, by a letter of catalogues, or of which one is a part of the other.
pub fn meant<'a>(name: &str, valid: &[&'a str]) -> Vec<&'a str> {
    let mut keys = LETTERS
        .iter()
        .filter(|(letter, _)| *letter == name)
        .map(|(_, key)| key);
    if let Some(v) = keys.find_map(|key| valid.iter().find(|v| *v == key)) {
        return vec![v];
    }
    if let Some(v) = valid.iter().find(|v| v.eq_ignore_ascii_case(name)) {
        return vec![v];
    }
    if let Some(v) = near(name, valid) {
        return vec![v];
    }
    let shares = |v: &&&str| {
        let (short, long) = if v.len() < name.len() {
            (**v, name)
        } else {
            (name, **v)
        };
        short.len() >= SHORTEST_PART && long.contains(short)
    };
    let parts: Vec<&str> = valid.iter().filter(shares).copied().collect();
    if parts.len() > MOST { Vec::new() } else { parts }
}

/// Where a name belongs: `write [effects.gravity]`, `mesh belongs to [inner], [outer]`, or the top of the scene.
pub fn elsewhere(name: &str) -> Option<String> {
    let is_table = |table: &str| table.contains('.') && table.rsplit('.').next() == Some(name);
    if let Some(block) = reference::all().into_iter().find(|block| is_table(&block.table)) {
        return Some(format!("write [{}]", block.table));
    }
    let of_scene = |block: &reference::ReferenceTable| block.table.is_empty() && block.keys().contains(&name);
    if reference::all().iter().any(of_scene) {
        return Some(format!("{name} stands at the top, before the first table"));
    }
    let mut tables: Vec<String> = Vec::new();
    for block in reference::all() {
        let is_it = block.table == name || block.keys().contains(&name);
        let table = format!("[{}]", block.table);
        if is_it && !block.table.is_empty() && !tables.contains(&table) {
            tables.push(table);
        }
    }
    if tables == [format!("[{name}]")] {
        return Some(format!("[{name}] is a table of its own"));
    }
    if tables.is_empty() || tables.len() > MOST {
        return None;
    }
    Some(format!("{name} belongs to {}", tables.join(", ")))
}

/// The line, from 1, that a header or key on line `again` repeats.
pub fn first_of(text: &str, again: usize) -> Option<usize> {
    let lines: Vec<&str> = text.lines().collect();
    let name = |line: &str| match line.trim().starts_with('[') {
        true => line.split(']').next().unwrap_or_default().trim().to_string(),
        false => line.split('=').next().unwrap_or_default().trim().to_string(),
    };
    let wanted = name(lines.get(again.checked_sub(1)?)?);
    let before = &lines[..again - 1];
    before
        .iter()
        .rposition(|line| name(line) == wanted)
        .map(|line| line + 1)
}

/// What a line has that TOML has not.
pub fn of_syntax(line: &str) -> Option<String> {
    let code = line.split(" #").next().unwrap_or_default().trim();
    let (key, value) = code
        .split_once('=')
        .map_or((code, ""), |(key, value)| (key.trim(), value.trim()));
    if code.contains(['\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}']) {
        return Some("the quotes are those of a text program; write \"\"".into());
    }
    if code.starts_with("//") || code.starts_with(';') || code.starts_with("--") || code.contains(" //") {
        return Some("comments begin with #".into());
    }
    if !code.contains('=') && !code.starts_with('[') {
        let colon = code
            .split_once(':')
            .filter(|(key, value)| !key.contains(' ') && !value.is_empty());
        let bare = code.split_once(' ').map(|(key, value)| (key, value.trim()));
        let bare = bare.filter(|(_, value)| value.starts_with(|c: char| c == '"' || c.is_ascii_digit()));
        return match (colon, bare) {
            (Some((key, value)), _) => Some(format!("write {key} = {} instead of a colon", value.trim())),
            (None, Some((key, value))) => {
                Some(format!("a key and its value have = between: {key} = {value}"))
            }
            (None, None) => None,
        };
    }
    if key.contains(' ') && key.chars().all(|c| c.is_alphanumeric() || c == ' ') {
        return Some(format!("a key is one word: {}", key.replace(' ', "_")));
    }
    let comma = |text: &str| {
        let (whole, rest) = text.split_once(',')?;
        let fraction: String = rest.chars().take_while(char::is_ascii_digit).collect();
        let is_number =
            !whole.is_empty() && whole.bytes().all(|b| b.is_ascii_digit()) && !fraction.is_empty();
        is_number.then(|| format!("{whole}.{fraction}"))
    };
    if let Some(number) = comma(value) {
        return Some(format!("numbers have a decimal point: {number}"));
    }
    let first = value.chars().next()?;
    if first.is_ascii_digit() && value.contains(char::is_alphabetic) {
        return Some(format!("quantities stand in quotes: {key} = \"{value}\""));
    }
    if first.is_alphabetic() {
        let lower = value.to_lowercase();
        return Some(match lower.as_str() {
            "true" | "false" => format!("write {lower}"),
            "yes" | "on" => "write true".into(),
            "no" | "off" => "write false".into(),
            _ => format!("words stand in quotes: {key} = \"{value}\""),
        });
    }
    if value.ends_with([';', ',']) {
        return Some("a line ends without a sign".into());
    }
    if value.matches('"').count() == 1 {
        return Some("the quote at the end is missing".into());
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: a slip of TOML would be answered with the words of a grammar only.
    #[test]
    fn lines_that_are_no_toml_have_their_remedy() {
        let cases = [
            ("ball_diameter = 9,5 # mm", "numbers have a decimal point: 9.5"),
            ("width = 16 mm", "quantities stand in quotes: width = \"16 mm\""),
            ("x = free", "words stand in quotes: x = \"free\""),
            ("flexible = True", "write true"),
            ("flexible = no", "write false"),
            ("balls: 18", "write balls = 18 instead of a colon"),
            ("// a comment", "comments begin with #"),
            ("balls = 18 // a comment", "comments begin with #"),
            ("width = \"16 mm\";", "a line ends without a sign"),
            (
                "width = \u{201c}16 mm\u{201d}",
                "the quotes are those of a text program; write \"\"",
            ),
            ("width = \"16 mm", "the quote at the end is missing"),
        ];
        for (line, expected) in cases {
            assert_eq!(of_syntax(line).as_deref(), Some(expected), "{line}");
        }
        assert_eq!(of_syntax("balls ="), None);
        assert_eq!(of_syntax("[bearing"), None);
    }
}
