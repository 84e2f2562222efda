//! A series of points and how it looks.

use crate::point::DataPoint;

/// How the points of a series are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Joined by a line.
    Line,
    /// A line with the area down to the series below: a part of a sum.
    Area,
    /// A mark at each point.
    Marks,
    /// A mark at each point, joined by a line.
    LineAndMarks,
    /// A large ring round each point: it marks points of other series.
    Rings,
    /// A dashed grey line: a value to compare with.
    Reference,
    /// A thin white line with a dark edge, for outlines on a surface.
    Outline,
    /// The same in dashes: of what is not as the others.
    BrokenOutline,
}

/// Points with a name. A point that is not finite, or not positive on a logarithmic axis, interrupts the line.
#[derive(Clone, Debug)]
pub struct Series {
    pub(crate) name: String,
    pub(crate) points: Vec<DataPoint>,
    pub(crate) look: Look,
    pub(crate) errors: Option<Vec<[f64; 2]>>,
    pub(crate) band: Option<Vec<[f64; 2]>>,
    pub(crate) shade: Option<f64>,
}

impl Series {
    /// A series.
    pub fn new(name: impl Into<String>, look: Look, points: Vec<DataPoint>) -> Series {
        Series {
            name: name.into(),
            points,
            look,
            errors: None,
            band: None,
            shade: None,
        }
    }

    /// A line.
    pub fn line(name: impl Into<String>, points: Vec<DataPoint>) -> Series {
        Series::new(name, Look::Line, points)
    }

    /// A line with marks.
    pub fn line_and_marks(name: impl Into<String>, points: Vec<DataPoint>) -> Series {
        Series::new(name, Look::LineAndMarks, points)
    }

    /// Parts of a sum over the same places, one above the other from zero: an area each, the first at the bottom.
    /// `parts` are names and values, `[n]` as `places`.
    pub fn stacked(places: &[f64], parts: &[(String, Vec<f64>)]) -> Vec<Series> {
        let mut below = vec![0.0; places.len()];
        let area = |(name, values): &(String, Vec<f64>)| {
            let above: Vec<f64> = below.iter().zip(values).map(|(low, value)| low + value).collect();
            let band = below
                .iter()
                .zip(&above)
                .map(|(low, high)| [*low, *high])
                .collect();
            let points = places
                .iter()
                .zip(&above)
                .map(|(x, y)| DataPoint::new(*x, *y))
                .collect();
            below = above;
            Series::new(name.clone(), Look::Area, points).band(band)
        };
        parts.iter().map(area).collect()
    }

    /// Marks.
    pub fn marks(name: impl Into<String>, points: Vec<DataPoint>) -> Series {
        Series::new(name, Look::Marks, points)
    }

    /// Rings round points, such as those of a Pareto front.
    pub fn rings(name: impl Into<String>, points: Vec<DataPoint>) -> Series {
        Series::new(name, Look::Rings, points)
    }

    /// A dashed grey line to compare with.
    pub fn reference(name: impl Into<String>, points: Vec<DataPoint>) -> Series {
        Series::new(name, Look::Reference, points)
    }

    /// Vertical error bars: lowest and highest value at each point.
    pub fn errors(mut self, errors: Vec<[f64; 2]>) -> Series {
        self.errors = Some(errors);
        self
    }

    /// A light band: lowest and highest value at each point.
    pub fn band(mut self, band: Vec<[f64; 2]>) -> Series {
        self.band = Some(band);
        self
    }

    /// The colour of curve `i` of a family of `n`, from the first to the last shade, instead of the next of the
    /// palette.
    pub fn shade(self, i: usize, n: usize) -> Series {
        self.shade_at(i as f64 / n.saturating_sub(1).max(1) as f64)
    }

    /// The colour at a part of the way from the first to the last shade, 0 to 1.
    pub fn shade_at(mut self, part: f64) -> Series {
        self.shade = Some(part);
        self
    }
}
