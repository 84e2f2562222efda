//! Sentences of a page in Markdown.

/// Words of every sentence, without code, tables, headings and pictures.
pub fn lengths_of_sentences(text: &str) -> Vec<usize> {
    let sentences = paragraphs(text)
        .into_iter()
        .flat_map(|paragraph| sentences(&paragraph));
    sentences.filter(|n| *n > 0).collect()
}

/// Paragraphs and points of lists, each as one line.
fn paragraphs(text: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    let mut is_code = false;
    for line in text.lines() {
        let start = line.trim_start();
        if start.starts_with("```") {
            is_code = !is_code;
        }
        let ends = start.is_empty() || start.starts_with(['|', '#', '<', '`']) && is_mark(start);
        if is_code || ends || start.starts_with("![") {
            paragraphs.push(String::new());
            continue;
        }
        let point = start.trim_start_matches(|c: char| c.is_ascii_digit());
        let is_point = start.starts_with("- ") || point.starts_with(". ") && point.len() < start.len();
        if is_point {
            paragraphs.push(String::new());
        }
        let last = paragraphs.last_mut().expect("there is one from the start");
        *last += " ";
        *last += start.trim_start_matches("- ");
    }
    paragraphs
}

/// A table, a heading, HTML or a fence; a line may begin with code.
fn is_mark(start: &str) -> bool {
    !start.starts_with('`') || start.starts_with("```")
}

/// Number of words in each sentence of a paragraph. A sentence ends with a full stop before a capital or a mark.
fn sentences(paragraph: &str) -> Vec<usize> {
    let words: Vec<&str> = paragraph.split_whitespace().collect();
    let mut lengths = vec![0];
    for (i, word) in words.iter().enumerate() {
        *lengths.last_mut().expect("there is one from the start") += 1;
        let next = words.get(i + 1).and_then(|next| next.chars().next());
        let opens = next.is_some_and(|c| c.is_uppercase() || ['`', '*', '[', '('].contains(&c));
        let last = word.trim_end_matches([')', '*', '"']).chars().last();
        if opens && last.is_some_and(|c| ['.', '!', '?'].contains(&c)) {
            lengths.push(0);
        }
    }
    lengths
}

/// Wrong: the measure of sentences would not see one, or would see code and tables.
#[test]
fn sentences_are_counted() {
    let text = "# A heading of words\n\nOne two three. Four `five`.\n\n- six seven\n  eight.\n- nine\n\n| a | b |\n\n\
                ```\nraceway run x\n```\n\nTen (e.g. eleven) twelve: 0.5 mm. A B C!\n";
    assert_eq!(lengths_of_sentences(text), [3, 2, 3, 1, 6, 3]);
}
