//! A quantity over triangles, linear in each: filled contours whose edges are exact.

/// Number of steps of the colours: few enough that their edges show as contour lines.
pub(crate) const LEVELS: usize = 20;

/// Level, from 0, of a value in the range.
pub(crate) fn level_of(value: f64, [low, high]: [f64; 2]) -> Option<usize> {
    let part = (value - low) / (high - low);
    part.is_finite()
        .then(|| ((part * LEVELS as f64) as usize).min(LEVELS - 1))
}

/// A triangle with values at its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners, in the units of the axes, `[3][2]`.
    pub corners: [[f64; 2]; 3],
    /// Values at the corners, in the unit of the colours.
    pub values: [f64; 3],
}

/// The parts of a triangle that have one colour each: level, and corners in order round the part.
pub(crate) fn bands(triangle: &Triangle, range: [f64; 2]) -> Vec<(usize, Vec<[f64; 2]>)> {
    let levels = triangle.values.map(|value| level_of(value, range));
    let [Some(a), Some(b), Some(c)] = levels else {
        return Vec::new();
    };
    let (first, last) = (a.min(b).min(c), a.max(b).max(c));
    let whole: Vec<[f64; 3]> = (0..3)
        .map(|i| [triangle.corners[i][0], triangle.corners[i][1], triangle.values[i]])
        .collect();
    let edge = |level: usize| range[0] + (range[1] - range[0]) * level as f64 / LEVELS as f64;
    let band = |level: usize| {
        // Values beyond the range have the colour of its end.
        let mut part = whole.clone();
        if level > first {
            part = beyond(&part, edge(level), 1.0);
        }
        if level < last {
            part = beyond(&part, edge(level + 1), -1.0);
        }
        (level, part.iter().map(|p| [p[0], p[1]]).collect::<Vec<_>>())
    };
    (first..=last)
        .map(band)
        .filter(|(_, part)| part.len() > 2)
        .collect()
}

/// The part of a polygon, corners `[x, y, value]`, whose values lie above a bound; below it for a sign of -1
/// (Sutherland and Hodgman 1974).
fn beyond(polygon: &[[f64; 3]], bound: f64, sign: f64) -> Vec<[f64; 3]> {
    let above = |p: &[f64; 3]| sign * (p[2] - bound);
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (from, to) = (above(p), above(q));
        if from >= 0.0 {
            part.push(*p);
        }
        if (from < 0.0) != (to < 0.0) {
            let t = from / (from - to);
            part.push(std::array::from_fn(|k| p[k] + t * (q[k] - p[k])));
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &[[f64; 2]]) -> f64 {
        let pairs = polygon.iter().zip(polygon.iter().cycle().skip(1));
        0.5 * pairs.map(|(p, q)| p[0] * q[1] - q[0] * p[1]).sum::<f64>()
    }

    /// Wrong: contours would lie elsewhere than where the linear field has their value, or leave gaps.
    #[test]
    fn bands_fill_a_triangle_and_end_where_the_field_has_their_value() {
        let triangle = Triangle {
            corners: [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            values: [0.0, 10.0, 0.0],
        };
        // The field is 10 x; of 20 levels from 0 to 20 ten are met, and level k covers x from k/10 to (k+1)/10.
        let parts = bands(&triangle, [0.0, 20.0]);
        let total: f64 = parts.iter().map(|(_, part)| area(part)).sum();
        assert!((total - 0.5).abs() < 1e-15, "{total}");
        for (level, part) in &parts {
            let ends = [*level as f64 / 10.0, (*level as f64 + 1.0) / 10.0];
            assert!(
                part.iter()
                    .all(|p| p[0] > ends[0] - 1e-12 && p[0] < ends[1] + 1e-12)
            );
            // A strip of a triangle: integral of 1 - x.
            let exact = 0.5 * ((1.0 - ends[0]).powi(2) - (1.0 - ends[1].min(1.0)).powi(2));
            assert!(
                (area(part) - exact).abs() < 1e-14,
                "{level}: {} {exact}",
                area(part)
            );
        }
        // Beyond the range and without a value.
        let high = Triangle {
            values: [30.0; 3],
            ..triangle
        };
        assert_eq!(bands(&high, [0.0, 20.0])[0].0, LEVELS - 1);
        let none = Triangle {
            values: [f64::NAN; 3],
            ..triangle
        };
        assert!(bands(&none, [0.0, 20.0]).is_empty());
    }
}
