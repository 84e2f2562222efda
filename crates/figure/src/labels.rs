//! Places for the labels of points: near their point, inside the axes, on no mark, no line and no other label.

use crate::page::{Rect, TEXT};
use crate::text::{self, LINE, Weight};

/// Half the size of a mark with its surroundings.
const MARK: f64 = 7.0;
/// Distances from the point to try, in pixels.
const DISTANCES: [f64; 8] = [4.0, 12.0, 22.0, 36.0, 54.0, 76.0, 104.0, 140.0];
/// Directions to try.
const N_DIRECTIONS: usize = 16;

/// Distance from a point within which a line is its own, pixels.
const OWN: f64 = 0.5;

/// What labels must stay off.
pub struct Obstacles<'a> {
    /// Area they must stay in.
    pub inside: Rect,
    /// Points with a mark, pixels.
    pub marks: &'a [[f64; 2]],
    /// Lines, pixels.
    pub lines: &'a [[[f64; 2]; 2]],
}

/// A box for each label, in the order of the labels; none if there is a label without a place. Lines are crossed by the
/// way from a point to its label, and then by labels, only where nothing else is left.
pub fn place(labels: &[([f64; 2], &str)], obstacles: &Obstacles) -> Option<Vec<Rect>> {
    let marks: Vec<Rect> = obstacles.marks.iter().map(|&p| around(p, MARK)).collect();
    let mut placed: Vec<Rect> = Vec::new();
    for (point, text) in labels {
        let size = [text::width(text, TEXT, Weight::Regular) + 4.0, LINE * TEXT];
        let free = |place: &Rect| {
            obstacles.inside.holds(place)
                && !marks.iter().any(|mark| mark.overlaps(place))
                && !placed.iter().any(|other| other.overlaps(place))
        };
        let candidates: Vec<Rect> = candidates(*point, size).filter(|c| free(c)).collect();
        let is_clear = |place: &&Rect| !obstacles.lines.iter().any(|line| crosses(line, place));
        let is_reached = |place: &&Rect| {
            let way = [*point, place.nearest(*point)];
            !obstacles.lines.iter().any(|line| meets(line, way))
        };
        let mut clear = candidates.iter().filter(is_clear).peekable();
        let first = clear.peek().copied();
        placed.push(*clear.find(is_reached).or(first).or(candidates.first())?);
    }
    Some(placed)
}

/// Boxes of the given size round a point, nearest first.
fn candidates([x, y]: [f64; 2], [width, height]: [f64; 2]) -> impl Iterator<Item = Rect> {
    DISTANCES.into_iter().flat_map(move |distance| {
        (0..N_DIRECTIONS).map(move |i| {
            // The first direction is up and right.
            let angle = std::f64::consts::TAU * (i as f64 + 2.0) / N_DIRECTIONS as f64;
            let (cos, sin) = (angle.cos(), angle.sin());
            let middle_x = x + cos * (distance + MARK + 0.5 * width);
            let middle_y = y - sin * (distance + MARK + 0.5 * height);
            Rect {
                left: middle_x - 0.5 * width,
                right: middle_x + 0.5 * width,
                top: middle_y - 0.5 * height,
                bottom: middle_y + 0.5 * height,
            }
        })
    })
}

fn around([x, y]: [f64; 2], half: f64) -> Rect {
    Rect {
        left: x - half,
        right: x + half,
        top: y - half,
        bottom: y + half,
    }
}

/// Whether a line meets the way from a point, which may lie on the line.
fn meets([a, b]: &[[f64; 2]; 2], [from, to]: [[f64; 2]; 2]) -> bool {
    let less = |p: [f64; 2], q: [f64; 2]| [p[0] - q[0], p[1] - q[1]];
    let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
    let (way, line, gap) = (less(to, from), less(*b, *a), less(*a, from));
    let area = cross(way, line);
    if area == 0.0 {
        return false;
    }
    let (on_way, on_line) = (cross(gap, line) / area, cross(gap, way) / area);
    let off_point = on_way * way[0].hypot(way[1]) > OWN;
    off_point && on_way <= 1.0 && (0.0..=1.0).contains(&on_line)
}

/// Whether a line meets a box: the part of the line inside all four sides is not empty.
fn crosses([a, b]: &[[f64; 2]; 2], place: &Rect) -> bool {
    let mut part = [0.0_f64, 1.0_f64];
    let sides = [(0, place.left, place.right), (1, place.top, place.bottom)];
    for (component, low, high) in sides {
        let (from, way) = (a[component], b[component] - a[component]);
        if way.abs() < 1e-12 {
            if from < low || from > high {
                return false;
            }
            continue;
        }
        let (t0, t1) = ((low - from) / way, (high - from) / way);
        part = [part[0].max(t0.min(t1)), part[1].min(t0.max(t1))];
    }
    part[0] <= part[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wrong: the way to the name of a line would lead across the line beside it, as if it were the name of that one.
    #[test]
    fn the_way_to_a_label_crosses_no_other_line() {
        let inside = Rect {
            left: 0.0,
            right: 400.0,
            top: 0.0,
            bottom: 300.0,
        };
        let upright = |x: f64, top: f64| [[x, 300.0], [x, top]];
        let lines = [
            upright(191.0, 132.0),
            upright(200.0, 150.0),
            upright(231.0, 168.0),
        ];
        let ends = lines.map(|line| line[1]);
        let names = ["2 BSF", "BPFO", "BPFI"];
        let labels: Vec<([f64; 2], &str)> = ends.into_iter().zip(names).collect();
        let obstacles = Obstacles {
            inside,
            marks: &ends,
            lines: &lines,
        };
        let places = place(&labels, &obstacles).unwrap();
        for (i, (end, box_of_label)) in ends.iter().zip(&places).enumerate() {
            for (k, line) in lines.iter().enumerate() {
                let way = [*end, box_of_label.nearest(*end)];
                assert!(
                    !meets(line, way) && !crosses(line, box_of_label),
                    "{i} {k} {places:?}"
                );
            }
        }
        assert!(meets(&lines[0], [[200.0, 150.0], [180.0, 150.0]]));
        assert!(!meets(&lines[1], [[200.0, 150.0], [180.0, 140.0]]));
        assert!(!meets(&lines[0], [[200.0, 120.0], [180.0, 120.0]]));
    }
}
