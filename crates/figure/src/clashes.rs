//! Checks a figure by its SVG: texts that overlap one another or leave the picture.

use resvg::usvg::{Group, Node, Rect, Tree};

use crate::{FigureError, png};

/// Slack for rounding to units of the drawing, parts of the width of the picture.
const SLACK: f32 = 1e-3;

/// Every pair of texts that share an area, and every text that is not wholly in the picture, in words. The boxes are
/// those of the glyphs of the built-in font.
pub fn clashes(svg: &str) -> Result<Vec<String>, FigureError> {
    let tree = png::parse(svg)?;
    let mut texts: Vec<(String, Rect)> = Vec::new();
    collect(tree.root(), &mut texts);
    let mut found = Vec::new();
    for (i, (text, place)) in texts.iter().enumerate() {
        if leaves(place, &tree) {
            found.push(format!("{text:?} leaves the picture"));
        }
        for (other, its_place) in &texts[i + 1..] {
            if place.intersect(its_place).is_some() {
                found.push(format!("{text:?} overlaps {other:?}"));
            }
        }
    }
    Ok(found)
}

fn leaves(place: &Rect, tree: &Tree) -> bool {
    let (size, slack) = (tree.size(), SLACK * tree.size().width());
    place.left() < -slack
        || place.top() < -slack
        || place.right() > size.width() + slack
        || place.bottom() > size.height() + slack
}

fn collect(group: &Group, texts: &mut Vec<(String, Rect)>) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect(group, texts),
            Node::Text(text) => {
                let words: String = text.chunks().iter().map(|chunk| chunk.text()).collect();
                texts.push((words.trim().to_string(), text.abs_bounding_box()));
            }
            _ => {}
        }
    }
}
