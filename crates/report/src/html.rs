//! Tables and numbers of a page.

use html_escape::encode_text;

/// What the cells of a row hold.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// Words.
    Text,
    /// Numbers, to the right.
    Numbers,
}

/// A row of a table.
pub fn row(name: &str, cells: &[String], kind: Cells) -> String {
    let class = if kind == Cells::Numbers {
        " class=\"number\""
    } else {
        ""
    };
    let cells: Vec<String> = cells
        .iter()
        .map(|c| format!("<td{class}>{}</td>", encode_text(c)))
        .collect();
    format!("<tr><th>{}</th>{}</tr>", encode_text(name), cells.concat())
}

/// A table with or without a head.
pub fn table(class: &str, head: Option<&[&str]>, rows: impl Iterator<Item = String>) -> String {
    let head = head.map_or(String::new(), |names| {
        let cells: Vec<String> = names.iter().map(|name| format!("<th>{name}</th>")).collect();
        format!("<tr>{}</tr>\n", cells.concat())
    });
    let rows: Vec<String> = rows.collect();
    format!("<table class=\"{class}\">\n{head}{}\n</table>", rows.join("\n"))
}

/// Five digits, plain where that is short.
pub fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e6).contains(&size) => {
            let decimals = (4 - size.log10().floor() as i32).clamp(0, 7) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.4e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: numbers would carry too few digits, or more than anyone reads.
    #[test]
    fn numbers_have_five_digits() {
        let pairs = [
            (331.783_2, "331.78"),
            (0.0, "0"),
            (-0.012_345_6, "-0.012346"),
            (1.23456e-9, "1.2346e-9"),
            (12345.6, "12346"),
        ];
        for (value, text) in pairs {
            assert_eq!(digits(value), text);
        }
    }
}
