//! Nothing in a figure overlaps or leaves the picture, measured on the SVG by another library.

use figure::{Axis, DataPoint, Figure, FigureError, Look, Series, Surface, clashes};

fn points<const N: usize>(list: [[f64; 2]; N]) -> Vec<DataPoint> {
    list.map(DataPoint::from).to_vec()
}

fn wave(n: usize, phase: f64) -> Vec<DataPoint> {
    let x = |i: usize| 360.0 * i as f64 / (n - 1) as f64;
    (0..n)
        .map(|i| DataPoint::new(x(i), 300.0 + 80.0 * (x(i).to_radians() + phase).cos()))
        .collect()
}

fn histories() -> Figure {
    let azimuth = Axis::linear("azimuth of the ball", "deg")
        .ticks_every(45.0)
        .tight();
    Figure::new(
        "Force of ball 1 over one revolution",
        azimuth,
        Axis::linear("contact force", "N"),
    )
    .series(Series::line("inner contact", wave(500, 0.0)))
    .series(Series::line("outer contact", wave(500, 0.3)))
    .series(Series::reference(
        "without radial force",
        points([[0.0, 331.8], [360.0, 331.8]]),
    ))
}

/// Errors against cost of two methods, Pareto front marked, labels at every point of the front.
fn work_precision() -> Figure {
    let points = |factor: f64| -> Vec<DataPoint> {
        (0..6)
            .map(|i| DataPoint::new(factor * 0.1 * 4f64.powi(i), 0.1 * 2.3f64.powi(-i)))
            .collect()
    };
    let errors = points(1.0).iter().map(|p| [0.8 * p.y, 1.3 * p.y]).collect();
    let figure = Figure::new(
        "Error of the ball force against cost",
        Axis::logarithmic("CPU time", "s"),
        Axis::logarithmic("error of the ball force", "1"),
    )
    .series(Series::line_and_marks("hex8 with incompatible modes", points(1.0)).errors(errors))
    .series(Series::line_and_marks("hex20", points(3.0)))
    .series(Series::rings("Pareto front", points(1.0)));
    let labels = points(1.0).into_iter().enumerate();
    labels.fold(figure, |figure, (i, at)| {
        figure.label(at, format!("{} sectors", 45 << i))
    })
}

fn map() -> Figure {
    let edges = |n: usize, length: f64| (0..=n).map(|i| length * i as f64 / n as f64).collect::<Vec<_>>();
    let value = |i: usize| 100.0 * ((i % 90) as f64 * 0.4).sin().powi(2) + (i / 90) as f64;
    let values = (0..90 * 12).map(value).collect();
    let surface = Surface::new(
        Axis::linear("von Mises stress", "MPa"),
        edges(90, 360.0),
        edges(12, 5.0),
        values,
    );
    let circle = (0..=40)
        .map(|i| 0.157 * f64::from(i))
        .map(|t| DataPoint::new(90.0 + 8.0 * t.cos(), 2.5 + t.sin()));
    Figure::new(
        "Stress of the outer raceway",
        Axis::linear("azimuth", "deg").tight(),
        Axis::linear("arc of the groove", "mm").tight(),
    )
    .surface(surface.expect("sizes agree"))
    .series(Series::new("contact ellipse", Look::Outline, circle.collect()))
}

/// Long names, large numbers, many series, tiny ranges.
fn awkward() -> Vec<Figure> {
    let long =
        "a very long name of a quantity that nobody would write on an axis but which a scene may ask for";
    let many = |n: usize| {
        let axes = (Axis::linear("time", "s"), Axis::linear("pressure", "Pa"));
        (0..n).fold(
            Figure::new(format!("{n} curves under {long}"), axes.0, axes.1),
            |f, i| {
                f.series(
                    Series::line(
                        format!("radial force {i} kN, {}", &long[..5 * i.min(15)]),
                        wave(50, 0.1 * i as f64),
                    )
                    .shade(i, n),
                )
            },
        )
    };
    let crowded = (0..30).fold(
        Figure::new("crowd", Axis::linear("x", "1"), Axis::linear("y", "1")).size(420, 300),
        |f, i| {
            let at = DataPoint::new(f64::from(i % 6), f64::from(i / 6));
            f.series(Series::marks("", vec![at]))
                .label(at, format!("point {i}"))
        },
    );
    let numbers = points([[0.0, 1e-12], [1e9, 1.0000001e-12]]);
    vec![
        many(14),
        Figure::new(long, Axis::linear(long, "m"), Axis::linear(long, "N"))
            .series(Series::marks(long, numbers)),
        Figure::new("one point", Axis::linear("x", "1"), Axis::logarithmic("y", "1"))
            .series(Series::marks("p", points([[0.0, 7.0]]))),
        Figure::new(
            "wide range",
            Axis::logarithmic("x", "s"),
            Axis::logarithmic("y", "1"),
        )
        .series(Series::line(
            "p",
            points([[1e-30, 1e-300], [1.0, 1e300], [2.0, 0.0], [f64::NAN, 1.0]]),
        )),
        Figure::new(
            "few decades",
            Axis::logarithmic("x", "s"),
            Axis::logarithmic("y", "1"),
        )
        .series(Series::line("p", points([[1.1, 0.31], [1.3, 0.39]]))),
        crowded,
    ]
}

/// Wrong: a reader could not read a label, because another lies on it or the picture ends.
#[test]
fn no_text_overlaps_another_or_leaves_the_picture() {
    let figures = [histories(), work_precision(), map(), parts()]
        .into_iter()
        .chain(awkward());
    for figure in figures {
        let svg = figure.svg().expect("the figure can be drawn");
        assert_eq!(
            clashes(&svg).expect("it is an SVG"),
            Vec::<String>::new(),
            "{}",
            &svg[..200]
        );
    }
}

/// Wrong: the check above would find nothing in any picture.
#[test]
fn a_clash_is_found() {
    let text = |x: i32, word: &str| {
        format!("<text x=\"{x}\" y=\"50\" font-size=\"13\" font-family=\"DejaVu Sans\">{word}</text>")
    };
    let svg = |parts: &[String]| {
        format!(
            "<svg width=\"200\" height=\"100\" viewBox=\"0 0 200 100\" xmlns=\"http://www.w3.org/2000/svg\">{}</svg>",
            parts.concat()
        )
    };
    assert!(
        clashes(&svg(&[text(10, "abc"), text(60, "def")]))
            .unwrap()
            .is_empty()
    );
    let overlapping = clashes(&svg(&[text(10, "abc"), text(20, "def")])).unwrap();
    assert!(
        overlapping[0].contains("\"abc\" overlaps \"def\""),
        "{overlapping:?}"
    );
    let outside = clashes(&svg(&[text(190, "abc")])).unwrap();
    assert!(outside[0].contains("leaves the picture"), "{outside:?}");
}

fn parts() -> Figure {
    let axes = (
        Axis::linear("time", "ms").tight(),
        Axis::linear("power", "W").including(0.0),
    );
    let places: Vec<f64> = (0..50).map(f64::from).collect();
    let part = |name: &str, size: f64| {
        (
            name.to_string(),
            places.iter().map(|x| size * (1.0 + (0.1 * x).sin())).collect(),
        )
    };
    let parts = [part("traction", 20.0), part("drag", 5.0), part("impacts", 0.0)];
    let figure = Figure::new("Power by source", axes.0, axes.1);
    Series::stacked(&places, &parts)
        .into_iter()
        .fold(figure, Figure::series)
}

/// Wrong: parts of a sum would not stand on each other, so that the uppermost line would not be the sum.
#[test]
fn parts_of_a_sum_stand_on_each_other() {
    let svg = parts().svg().unwrap();
    // Areas of 50 places: their upper edge forwards, the lower one back.
    let polygons = svg.split("<polygon").skip(1).map(|element| {
        let points = element
            .split_once("points=\"")
            .and_then(|(_, rest)| rest.split_once('"'))
            .unwrap()
            .0;
        let point = |pair: &str| {
            pair.split_once(',')
                .map(|(x, y)| [x, y].map(|v| v.parse::<i32>().unwrap()))
        };
        points
            .split_whitespace()
            .map(|pair| point(pair).unwrap())
            .collect::<Vec<_>>()
    });
    let areas: Vec<Vec<[i32; 2]>> = polygons.filter(|points| points.len() == 100).collect();
    assert_eq!(areas.len(), 3);
    for pair in areas.windows(2) {
        let upper: Vec<_> = pair[0][..50].to_vec();
        let lower: Vec<_> = pair[1][50..].iter().rev().copied().collect();
        assert_eq!(upper, lower);
    }
    // 20 to 5: heights over the axis, to the unit of the drawing.
    let floor = areas[0][99][1];
    let heights = [0, 1].map(|i| f64::from(floor - areas[i][10][1]));
    assert!(
        (heights[1] / heights[0] - 1.25).abs() < 2.0 / heights[0],
        "{heights:?}"
    );
}

/// Wrong: an axis would not say what it shows or in which unit.
#[test]
fn every_axis_has_its_unit() {
    let svg = map().svg().unwrap();
    for text in [
        "azimuth (deg)",
        "arc of the groove (mm)",
        "von Mises stress (MPa)",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(
        work_precision()
            .svg()
            .unwrap()
            .contains("error of the ball force (-)")
    );
}

/// Wrong: a machine without fonts would make images without text.
#[test]
fn an_image_has_text_without_system_fonts() {
    let axes = || (Axis::linear("x", "m"), Axis::linear("y", "m"));
    let image = |title: &str| {
        let (x, y) = axes();
        let figure = Figure::new(title, x, y).series(Series::line("", points([[0.0, 0.0], [1.0, 1.0]])));
        figure.png(1.0).unwrap()
    };
    assert!(image("Title of some length").len() > image(".").len() + 500);
}

/// Wrong: the same data would give other files.
#[test]
fn the_same_figure_has_the_same_bytes() {
    assert_eq!(work_precision().svg().unwrap(), work_precision().svg().unwrap());
    assert_eq!(histories().png(1.0).unwrap(), histories().png(1.0).unwrap());
}

/// Wrong: an empty figure would be a picture of nothing, or a crash.
#[test]
fn nothing_to_draw_is_an_error() {
    let figure = Figure::new("forces", Axis::linear("x", "m"), Axis::logarithmic("y", "N"))
        .series(Series::line("a", points([[0.0, -1.0], [1.0, f64::NAN]])));
    let error = figure.svg().unwrap_err().to_string();
    assert!(
        error.contains("\"forces\" has nothing to draw: none of its 2 points is finite and positive"),
        "{error}"
    );
    assert!(matches!(
        figure.size(50, 50).svg(),
        Err(FigureError::Empty { .. })
    ));
    let axes = (Axis::linear("x", "m"), Axis::linear("y", "m"));
    let small = Figure::new("small", axes.0, axes.1)
        .series(Series::line("a", points([[0.0, 1.0]])))
        .size(60, 60);
    assert!(
        small
            .svg()
            .unwrap_err()
            .to_string()
            .contains("no room for its axes")
    );
    let surface = Surface::new(
        Axis::linear("v", "m"),
        vec![0.0, 1.0],
        vec![0.0, 1.0],
        vec![1.0, 2.0],
    );
    assert!(
        surface
            .unwrap_err()
            .to_string()
            .contains("has 2 values; expected 1")
    );
}

/// Wrong: the files would not be there, or one of them would be of another kind.
#[test]
fn a_figure_is_written_as_svg_and_png() {
    let images = histories().images().unwrap();
    assert!(
        images.svg.starts_with("<svg width=\"720\" height=\"450\""),
        "{}",
        &images.svg[..80]
    );
    assert!(images.svg.len() < 40_000, "{}", images.svg.len());
    assert_eq!(&images.png[1..4], b"PNG");
}

/// Wrong: a sweep of many points would have no figure, because its legend leaves no room for the axes.
#[test]
fn a_figure_of_many_shaded_series_names_some_of_them() {
    let mut figure = Figure::new(
        "A sweep",
        Axis::linear("angle", "deg"),
        Axis::linear("force", "N"),
    );
    for i in 0..200 {
        let points = (0..10)
            .map(|j| DataPoint::new(f64::from(j), f64::from(i + j)))
            .collect();
        let name = format!("axial force {i}.125 kN");
        figure = figure.series(Series::line(name, points).shade(i as usize, 200));
    }
    let svg = figure.svg().unwrap();
    let named = |i: u32| svg.contains(&format!("axial force {i}.125 kN"));
    assert!(named(0) && named(199), "the ends have their names");
    let n = (0..200).filter(|&i| named(i)).count();
    assert!((5..50).contains(&n), "{n} names");
    assert_eq!(clashes(&svg).unwrap(), Vec::<String>::new());
}

/// Wrong: curves of a sweep of many points could not be told apart, or their names would take the room of the axes.
#[test]
fn many_shaded_series_have_a_colour_bar_in_the_colours_of_the_curves() {
    let force = Axis::linear("axial force", "kN").including(2.0).including(12.0);
    let mut figure = Figure::new(
        "A sweep",
        Axis::linear("angle", "deg"),
        Axis::linear("force", "N"),
    )
    .surface(Surface::bar_of_series(force));
    for i in 0..50 {
        let points = (0..10)
            .map(|j| DataPoint::new(f64::from(j), f64::from(i + j)))
            .collect();
        let part = f64::from(i) / 49.0;
        figure = figure.series(Series::line(format!("curve {i}"), points).shade_at(part));
    }
    let svg = figure.svg().unwrap();
    assert!(!svg.contains("curve "), "curves have no names");
    assert!(svg.contains("axial force (kN)"));
    for tick in ["2", "4", "6", "8", "10", "12"] {
        assert!(
            svg.lines().any(|line| line.trim() == tick),
            "{tick} is not beside the bar"
        );
    }
    // The ends of the bar have the colours of the first and of the last curve.
    let colours = |element: &str, key: &str| -> Vec<String> {
        let lines = svg.lines().filter(|line| line.starts_with(element));
        let values = lines.filter_map(|line| line.split_once(&format!("{key}=\"")).map(|(_, rest)| rest));
        values
            .filter_map(|rest| rest.split('"').next().map(str::to_string))
            .collect()
    };
    let (bar, curves) = (colours("<rect", "fill"), colours("<polyline", "stroke"));
    let first = bar
        .iter()
        .position(|colour| *colour == "#440154")
        .expect("the bar begins dark");
    assert!(
        curves.contains(&bar[first]) && curves.contains(&bar[first + 19]),
        "{bar:?} {curves:?}"
    );
    assert_eq!(clashes(&svg).unwrap(), Vec::<String>::new());
}

/// A surface of these values in a row, and the colours of its cells from left to right, then of the bar from below.
fn colours_of(values: &[f64]) -> (Vec<String>, String) {
    let edges = (0..=values.len()).map(|i| i as f64).collect();
    let value = Axis::linear("pressure", "MPa").including(0.0);
    let surface = Surface::new(value, edges, vec![0.0, 1.0], values.to_vec()).unwrap();
    let axes = [
        Axis::linear("azimuth", "deg").tight(),
        Axis::linear("z", "mm").tight(),
    ];
    let [x, y] = axes;
    let svg = Figure::new("Seat", x, y)
        .surface(surface.parted_at_zero())
        .svg()
        .unwrap();
    assert_eq!(clashes(&svg).unwrap(), Vec::<String>::new());
    let fills = svg.lines().filter(|line| line.starts_with("<rect"));
    let fills = fills.filter_map(|line| line.split("fill=\"").nth(1)?.split('"').next());
    (fills.map(str::to_string).collect(), svg.clone())
}

/// Wrong: pressure and pull would have colours that do not tell them apart, or not at the same size the same strength;
/// values of one sign would lose the map of all other figures.
#[test]
fn values_of_both_signs_part_at_zero() {
    let (both, svg) = colours_of(&[-3.0, -6.0, 3.0, 10.0]);
    let [blue, red] = [(33, 102, 172), (178, 24, 43)].map(|(r, g, b)| format!("#{r:02X}{g:02X}{b:02X}"));
    // The largest is red. Of the other sign nothing is as large, but the bar goes there.
    let has = |colours: &[String], colour: &str| colours.iter().filter(|c| *c == colour).count();
    assert_eq!([has(&both, &blue), has(&both, &red)], [1, 2], "{both:?}");
    for tick in ["−10", "0", "10"] {
        assert!(svg.lines().any(|line| line.trim() == tick), "{tick}");
    }
    let (mirrored, _) = colours_of(&[3.0, 6.0, -3.0, -10.0]);
    assert_eq!(
        [has(&mirrored, &blue), has(&mirrored, &red)],
        [2, 1],
        "{mirrored:?}"
    );
    // Round-off is no sign.
    for one in [[1.0, 6.0, 3.0, 10.0], [-1e-12, 6.0, 3.0, 10.0]] {
        let (one, svg) = colours_of(&one);
        assert!(has(&one, "#440154") > 0 && has(&one, &red) == 0, "{one:?}");
        assert!(!svg.lines().any(|line| line.trim() == "−10"));
    }
}

/// The figures of these tests as files, to look at: FIGURES=DIR.
#[test]
fn examples_can_be_looked_at() {
    let Some(dir) = std::env::var_os("FIGURES") else {
        return;
    };
    let figures = [histories(), work_precision(), map(), parts()]
        .into_iter()
        .chain(awkward());
    for (i, figure) in figures.enumerate() {
        let images = figure.images().unwrap();
        let path = std::path::Path::new(&dir).join(format!("example_{i}"));
        std::fs::write(path.with_extension("svg"), images.svg).unwrap();
        std::fs::write(path.with_extension("png"), images.png).unwrap();
    }
}
