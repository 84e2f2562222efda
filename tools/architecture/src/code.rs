//! What of a text is code: no comments, no documentation, no tests.

use std::ops::Range;

use proc_macro2::{LineColumn, Span, TokenStream, TokenTree};
use syn::Attribute;

/// From the start to the end of any text.
pub fn whole_text() -> Range<LineColumn> {
    let start = LineColumn { line: 1, column: 0 };
    let end = LineColumn {
        line: usize::MAX,
        column: 0,
    };
    start..end
}

/// Keeps what tokens cover, and blanks the rest.
pub fn code_lines(text: &str, tests: &[Range<LineColumn>]) -> anyhow::Result<Vec<String>> {
    let lines: Vec<Vec<char>> = text.lines().map(|line| line.chars().collect()).collect();
    let mut code: Vec<Vec<char>> = lines.iter().map(|line| vec![' '; line.len()]).collect();
    let stream: TokenStream = text.parse().map_err(|error| anyhow::anyhow!("{error}"))?;
    keep(stream, tests, &lines, &mut code);
    Ok(code
        .into_iter()
        .map(|line| line.into_iter().collect::<String>().trim_end().to_owned())
        .collect())
}

fn keep(stream: TokenStream, tests: &[Range<LineColumn>], lines: &[Vec<char>], code: &mut [Vec<char>]) {
    for token in stream {
        let at = token.span().start();
        if tests.iter().any(|range| range.contains(&at)) {
            continue;
        }
        match token {
            TokenTree::Group(group) => {
                if is_comment(lines, group.span().start()) {
                    continue;
                }
                copy(group.span_open(), lines, code);
                keep(group.stream(), tests, lines, code);
                copy(group.span_close(), lines, code);
            }
            token => {
                if !is_comment(lines, at) {
                    copy(token.span(), lines, code);
                }
            }
        }
    }
}

/// Documentation becomes tokens whose place is the comment.
fn is_comment(lines: &[Vec<char>], at: LineColumn) -> bool {
    let line = &lines[at.line - 1][at.column..];
    line.first() == Some(&'/') && matches!(line.get(1), Some('/' | '*'))
}

fn copy(span: Span, lines: &[Vec<char>], code: &mut [Vec<char>]) {
    let (start, end) = (span.start(), span.end());
    for line in start.line..=end.line {
        let first = if line == start.line { start.column } else { 0 };
        let whole = lines[line - 1].len();
        let last = if line == end.line {
            end.column.min(whole)
        } else {
            whole
        };
        if first < last {
            code[line - 1][first..last].copy_from_slice(&lines[line - 1][first..last]);
        }
    }
}

/// Whether an attribute leaves an item to tests: `#[test]`, `#[cfg(test)]`, `#[cfg(all(test, ...))]`.
pub fn is_test(attribute: &Attribute) -> bool {
    if attribute.path().is_ident("test") {
        return true;
    }
    if !attribute.path().is_ident("cfg") {
        return false;
    }
    let condition = match &attribute.meta {
        syn::Meta::List(list) => list.tokens.to_string().replace(' ', ""),
        _ => return false,
    };
    condition == "test" || condition.starts_with("all(test,")
}
