//! Draws a laid-out figure as SVG with the crate plotters.
//!
//! The drawing library places everything on whole units; a unit here is a tenth of an SVG pixel.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use crate::canvas::{Canvas, Drawn, UNITS, style, units, write};
use crate::labels::{Obstacles, place};
use crate::layout::{Layout, lay_out};
use crate::marks::{self, Pen};
use crate::page::{GAP, LINE_WIDTH, Rect, TEXT, TICK, TITLE};
use crate::surface::draw::draw_surface;
use crate::text::{self, FONT, FONTS, LINE, Weight};
use crate::ticked::Ticked;
use crate::{DataPoint, Figure, FigureError, Look};

/// How often a figure grows by a quarter when its labels find no place.
const GROWTHS: u32 = 6;

/// The figure as SVG. If the labels of points find no place, the picture grows until they do.
pub fn draw(figure: &Figure) -> Result<String, FigureError> {
    text::register();
    let mut figure = figure.clone();
    for _ in 0..GROWTHS {
        let layout = lay_out(&figure)?;
        if let Some(svg) = draw_once(&figure, &layout)? {
            return Ok(svg);
        }
        figure.size = (figure.size.0 * 5 / 4, figure.size.1 * 5 / 4);
    }
    Err(FigureError::NoRoom {
        title: figure.title,
        width: figure.size.0,
        height: figure.size.1,
    })
}

/// The figure as SVG; none if there is a label without a place.
fn draw_once(figure: &Figure, layout: &Layout) -> Result<Option<String>, FigureError> {
    let pen = Pen::new(figure, layout);
    let points: Vec<([f64; 2], &str)> = figure
        .labels
        .iter()
        .filter_map(|label| Some((pen.pixel(label.at)?, label.text.as_str())))
        .collect();
    let (mut marks, lines) = obstacles(figure, &pen);
    marks.extend(points.iter().map(|(at, _)| *at));
    let obstacles = Obstacles {
        inside: layout.plot,
        marks: &marks,
        lines: &lines,
    };
    let Some(places) = place(&points, &obstacles) else {
        return Ok(None);
    };
    let size = (figure.size.0 * UNITS as u32, figure.size.1 * UNITS as u32);
    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let drawn = draw_all(figure, layout, &pen, &canvas).and_then(|()| {
            for ((at, text), place) in points.iter().zip(&places) {
                let middle = [0.5 * (place.left + place.right), 0.5 * (place.top + place.bottom)];
                let near = place.nearest(*at);
                canvas.draw(&PathElement::new(
                    vec![units(*at), units(near)],
                    BLACK.mix(0.5).stroke_width(6),
                ))?;
                write(&canvas, text, middle, TEXT, Weight::Regular, HPos::Center)?;
            }
            canvas.present()
        });
        drawn.map_err(|error| FigureError::Draw {
            title: figure.title.clone(),
            reason: error.to_string(),
        })?;
    }
    Ok(Some(finish(&svg, figure, size)))
}

fn draw_all(figure: &Figure, layout: &Layout, pen: &Pen, canvas: &Canvas) -> Drawn {
    canvas.fill(&WHITE)?;
    draw_axes(figure, layout, canvas)?;
    if let (Some(surface), Some(bar)) = (&figure.surface, &layout.bar) {
        draw_surface(surface, bar, pen, canvas)?;
    }
    for index in 0..figure.series.len() {
        marks::draw_band(figure, index, pen, canvas)?;
    }
    for index in 0..figure.series.len() {
        marks::draw_series(figure, index, pen, canvas)?;
    }
    for entry in &layout.legend.entries {
        marks::draw_sample(figure, entry, canvas)?;
    }
    draw_names(figure, layout, canvas)
}

/// Axes, ticks, their labels and the grid, by plotters' own chart.
fn draw_axes(figure: &Figure, layout: &Layout, canvas: &Canvas) -> Drawn {
    let (plot, [width, height]) = (layout.plot, [f64::from(figure.size.0), f64::from(figure.size.1)]);
    let mut chart = ChartBuilder::on(canvas)
        .margin_top(length(plot.top))
        .margin_right(length(width - plot.right))
        .set_label_area_size(LabelAreaPosition::Left, length(plot.left))
        .set_label_area_size(LabelAreaPosition::Bottom, length(height - plot.bottom))
        .build_cartesian_2d(Ticked(layout.x.clone()), Ticked(layout.y.clone()))?;
    chart
        .configure_mesh()
        .bold_line_style(RGBColor(205, 205, 205).stroke_width(6))
        .light_line_style(RGBColor(232, 232, 232).stroke_width(5))
        .axis_style(BLACK.stroke_width(LINE_WIDTH))
        .set_all_tick_mark_size(length(0.5 * TICK))
        .label_style(style(TEXT, Weight::Regular))
        .draw()
}

/// Title, names of the axes and of the colour bar.
fn draw_names(figure: &Figure, layout: &Layout, canvas: &Canvas) -> Drawn {
    let (plot, [width, height]) = (layout.plot, [f64::from(figure.size.0), f64::from(figure.size.1)]);
    for (i, line) in layout.title.iter().enumerate() {
        let y = GAP + (i as f64 + 0.5) * LINE * TITLE;
        write(canvas, line, [0.5 * width, y], TITLE, Weight::Bold, HPos::Center)?;
    }
    let (note, first) = &layout.note;
    for (i, line) in note.iter().enumerate() {
        let y = first + i as f64 * LINE * TEXT;
        write(
            canvas,
            line,
            [0.5 * width, y],
            TEXT,
            Weight::Regular,
            HPos::Center,
        )?;
    }
    let x_name = text::fit(&figure.x.text(), TEXT, Weight::Regular, width - 2.0 * GAP);
    let overhang = 0.5 * text::width(&x_name, TEXT, Weight::Regular) + GAP;
    let middle = (0.5 * (plot.left + plot.right)).clamp(overhang, (width - overhang).max(overhang));
    let below = [middle, height - GAP - 0.5 * LINE * TEXT];
    write(canvas, &x_name, below, TEXT, Weight::Regular, HPos::Center)?;
    write_upward(canvas, &figure.y.text(), GAP + 0.5 * LINE * TEXT, figure, plot)?;
    if let (Some(surface), Some(_)) = (&figure.surface, &layout.bar) {
        let x = width - GAP - 0.5 * LINE * TEXT;
        write_upward(canvas, &surface.value.text(), x, figure, plot)?;
    }
    Ok(())
}

/// A text that reads upward, its middle line at x, centred on the axes as far as the picture allows.
fn write_upward(canvas: &Canvas, text: &str, x: f64, figure: &Figure, plot: Rect) -> Drawn {
    let height = f64::from(figure.size.1);
    let text = text::fit(text, TEXT, Weight::Regular, height - 2.0 * GAP);
    let overhang = 0.5 * text::width(&text, TEXT, Weight::Regular) + GAP;
    let y = (0.5 * (plot.top + plot.bottom)).clamp(overhang, (height - overhang).max(overhang));
    let style = style(TEXT, Weight::Regular)
        .transform(FontTransform::Rotate270)
        .pos(plotters::style::text_anchor::Pos::new(HPos::Center, VPos::Center));
    canvas.draw(&Text::new(text, units([x, y]), style))
}

/// Marks and lines that labels stay off, pixels.
fn obstacles(figure: &Figure, pen: &Pen) -> (Vec<[f64; 2]>, Vec<[[f64; 2]; 2]>) {
    if figure.labels.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let (mut all_marks, mut lines) = (Vec::new(), Vec::new());
    for series in &figure.series {
        let pixels: Vec<Option<[f64; 2]>> = series.points.iter().map(|&p| pen.pixel(p)).collect();
        if series.look != Look::Marks && series.look != Look::Rings {
            let pairs = pixels.windows(2).filter_map(|pair| Some([pair[0]?, pair[1]?]));
            lines.extend(pairs);
        }
        let errors = series.points.iter().zip(series.errors.iter().flatten());
        let ends = |(p, e): (&DataPoint, &[f64; 2])| e.map(|y| pen.pixel(DataPoint::new(p.x, y)));
        lines.extend(errors.map(ends).filter_map(|[low, high]| Some([low?, high?])));
        if matches!(series.look, Look::Marks | Look::LineAndMarks | Look::Rings) {
            all_marks.extend(pixels.iter().flatten());
        }
    }
    (all_marks, lines)
}

fn length(pixels: f64) -> i32 {
    (pixels * UNITS).round() as i32
}

/// Size in pixels, fonts that viewers have, and a name for those who cannot see the figure.
fn finish(svg: &str, figure: &Figure, size: (u32, u32)) -> String {
    let head = format!("width=\"{}\" height=\"{}\" viewBox", size.0, size.1);
    let with_size = format!(
        "width=\"{}\" height=\"{}\" role=\"img\" viewBox",
        figure.size.0, figure.size.1
    );
    let font = format!("font-family=\"{FONT}\"");
    svg.replacen(&head, &with_size, 1)
        .replace(&font, &format!("font-family=\"{FONTS}\""))
        .replace("opacity=\"1\" ", "")
}
