"""Reading a result folder in ParaView, and the look that all pictures of this folder's scripts share.

Not a script. Import it only under pvpython of ParaView 5.11 or later. A script calls `main(name, parse, draw)`: exit
code 0 when the picture is made, 2 with one line on the error stream when arguments or files are wrong.
"""

import csv
import json
import math
import os
import sys

try:
    import numpy
    from paraview import servermanager
    from paraview.simple import *
    from vtkmodules.numpy_interface import dataset_adapter as dsa
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
except ImportError as error:
    sys.exit("%s: %s; run it with ParaView's pvpython" % (os.path.basename(sys.argv[0]), error))
paraview.simple._DisableFirstRenderCameraReset()

# Values of the cell array body, and how far beyond a cutting plane a ball still counts as on it, m.
INNER, OUTER = 0, 1
ON_PLANE = 1e-6
STRESS = "von Mises stress (MPa)"
BACKGROUND = [1.0, 1.0, 1.0]
INK = [0.1, 0.1, 0.1]
# Position and red, green, blue. Lightness falls steadily from light grey to dark red: unloaded steel stays light
# under any lighting, and the order of colours survives grey printing and colour blindness.
COLOURS = [
    (0.00, 0.84, 0.88, 0.93), (0.20, 0.99, 0.92, 0.60), (0.45, 0.99, 0.68, 0.28), (0.70, 0.90, 0.31, 0.15),
    (1.00, 0.45, 0.00, 0.15),
]



class UserError(Exception):
    """Something the caller can put right."""


def read_series(folder):
    """Absolute path of the series, and times of the committed steps by their number; their files are there."""
    series = os.path.abspath(os.path.join(folder, "run.hdf.series"))
    if not os.path.isfile(series):
        raise UserError("%s not found; expected the result folder of a run with at least one step" % series)
    with open(series) as file:
        entries = json.load(file)["files"]
    if not entries:
        raise UserError("%s lists no step; the run has not committed one yet" % series)
    for name in [entry["name"] for entry in entries] + ["mesh.hdf"]:
        if not os.path.isfile(os.path.join(os.path.dirname(series), name)):
            raise UserError("%s is missing beside %s" % (name, series))
    return series, {int(entry["name"][len("step_"):-len(".hdf")]): entry["time"] for entry in entries}


def find_step(folder, wanted):
    """Absolute path of the series, and number and time of the step to show; the last one when `wanted` is None."""
    series, steps = read_series(folder)
    number = max(steps) if wanted is None else wanted
    if number not in steps:
        raise UserError("step %d is not in %s; steps are %d to %d" % (number, series, min(steps), max(steps)))
    return series, number, steps[number]


def find_steps(folder, first, last):
    """Absolute path of the series, and number and time of the steps from `first` to `last`."""
    series, steps = read_series(folder)
    chosen = [(number, steps[number]) for number in sorted(steps) if first <= number <= last]
    if not chosen:
        raise UserError("no step from %d to %d is in %s; steps are %d to %d"
                        % (first, last, series, min(steps), max(steps)))
    return series, chosen


def instant(folder, number, time):
    """What a step shows, in words: modes have a frequency, points of a sweep their value; both have no time."""
    modes = os.path.join(folder, "modes.csv")
    if os.path.isfile(modes):
        with open(modes, newline="") as file:
            for row in csv.DictReader(file):
                if int(row["step"]) == number:
                    return "mode %s, %s, %.6g Hz" % (row["mode"], row["body"], float(row["frequency_hz"]))
    column, value = swept(folder, number)
    if column:
        return "point %d, %s = %s" % (number, column, value)
    return "step %d, t = %.6g s" % (number, time)


def swept(folder, number):
    """Column and text of the value of a point of a sweep; None twice for another run."""
    shaft = os.path.join(folder, "shaft.csv")
    if os.path.isfile(shaft):
        with open(shaft, newline="") as file:
            rows = csv.reader(file)
            column = next(rows, ["", "", ""])[2]
            value = next((row[2] for row in rows if row[0] == str(number)), None)
            # The path of a key of the scene has dots, other columns have none.
            if "." in column and value is not None:
                return column, value
    return None, None


def open_series(series, time):
    """The reader at the given time; fails when the arrays to draw are not there."""
    reader = OpenDataFile(series)
    if reader is None:
        raise UserError("this ParaView cannot open %s; expected version 5.11 or later" % series)
    reader.UpdatePipeline(time)
    for data, needed in [(reader.PointData, ["von_mises", "displacement"]), (reader.CellData, ["radius", "body"])]:
        missing = [name for name in needed if name not in data.keys()]
        if missing:
            raise UserError("%s has no array %s; its arrays are %s; pictures of stress need output.stress = \"nodal\""
                            % (series, missing[0], ", ".join(data.keys())))
    return reader


def select(source, time, array, lowest, highest):
    """Cells whose `array` lies between two values. The radius is 0 for solids, the ball's radius for balls.

    The two values must not both be 0: ParaView takes that for its default, which selects everything.
    """
    part = Threshold(Input=source, Scalars=["CELLS", array], LowerThreshold=lowest, UpperThreshold=highest)
    part.UpdatePipeline(time)
    return part


def displaced(source, time, factor):
    moved = WarpByVector(Input=source, Vectors=["POINTS", "displacement"], ScaleFactor=factor)
    moved.UpdatePipeline(time)
    return moved


def halved(source, time, normal):
    """The half on the side of `normal`. Balls, which are points, stay when they lie on the plane."""
    half = Clip(Input=source, ClipType="Plane", Invert=0)
    half.ClipType.Origin = [-ON_PLANE * component for component in normal]
    half.ClipType.Normal = normal
    half.UpdatePipeline(time)
    return half


def round_up(value):
    """The next of 1, 2, 2.5, 4, 5, 6, 8 times a power of ten: a colour bar with five equal parts of round numbers."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in [1, 2, 2.5, 4, 5, 6, 8, 10] if step * power >= value * (1 - 1e-12))


def stress_values(rings):
    """Nodal von Mises stress of the rings, MPa."""
    blocks = dsa.WrapDataObject(servermanager.Fetch(rings)).PointData[STRESS]
    values = numpy.concatenate([numpy.ravel(block) for block in getattr(blocks, "Arrays", [blocks])])
    if values.size == 0 or not numpy.isfinite(values).all():
        raise UserError("the von Mises stress of the rings has no values or values that are not finite")
    return values


def show_rings(rings, view, top):
    """Colours the rings from zero to `top`, MPa, with a colour bar."""
    display = Show(rings, view)
    display.Representation = "Surface"
    ColorBy(display, ("POINTS", STRESS))
    colours = GetColorTransferFunction(STRESS)
    colours.ColorSpace = "Lab"
    colours.RGBPoints = [number for at, *colour in COLOURS for number in (at * top, *colour)]
    # Mostly ambient light: a shaded colour would not be found on the colour bar.
    display.Ambient, display.Diffuse = 0.7, 0.35
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = STRESS, ""
    bar.TitleColor = bar.LabelColor = INK
    bar.TitleFontSize, bar.LabelFontSize = 18, 16
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%g", "%g"
    bar.UseCustomLabels, bar.CustomLabels = 1, [top * i / 5 for i in range(1, 5)]
    bar.WindowLocation = "Any Location"
    bar.Orientation, bar.Position, bar.ScalarBarLength = "Vertical", [0.9, 0.2], 0.6


def show_balls(balls, time, view, opacity=1.0):
    """A sphere of the array's radius at every vertex."""
    points = CellDatatoPointData(Input=balls)
    spheres = Glyph(Input=points, GlyphType="Sphere", GlyphMode="All Points")
    spheres.GlyphType.Radius = 1.0
    spheres.GlyphType.ThetaResolution = spheres.GlyphType.PhiResolution = 32
    spheres.OrientationArray = ["POINTS", "No orientation array"]
    spheres.ScaleArray, spheres.ScaleFactor = ["POINTS", "radius"], 1.0
    spheres.UpdatePipeline(time)
    display = Show(spheres, view)
    ColorBy(display, None)
    display.DiffuseColor, display.Opacity = [0.72, 0.73, 0.76], opacity
    display.Ambient, display.Diffuse, display.Specular = 0.3, 0.6, 0.4


def write_title(view, text, size, place):
    display = Show(Text(Text=text), view)
    display.WindowLocation = place
    display.FontSize, display.Color = size, INK


def contacts(folder, number):
    """Rows of balls.csv of one step: a dictionary of numbers per ball."""
    path = os.path.join(folder, "balls.csv")
    if not os.path.isfile(path):
        raise UserError("%s not found; expected the tables of a run" % path)
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if int(row["step"]) == number]
    if not rows:
        raise UserError("%s has no row of step %d" % (path, number))
    return [{name: float(value) for name, value in row.items()} for row in rows]


def ball_points(scaled, time):
    """Balls at their true place: centres, m, and forces on them from the inner and the outer ring, N, one row each."""
    balls = displaced(select(scaled, time, "radius", 1e-12, 1e12), time, 1.0)
    data = dsa.WrapDataObject(servermanager.Fetch(balls))
    radius = float(numpy.max(data.CellData["radius"]))
    points = numpy.array(data.Points)
    return balls, points, [numpy.array(data.PointData[name]) for name in ("force_inner", "force_outer")], radius


def most_loaded(forces):
    """Ball with the largest force on the outer ring."""
    return int(numpy.argmax(numpy.linalg.norm(forces[OUTER], axis=1)))


def outlines(ellipses):
    """Closed lines as a source."""
    points, lines = vtkPoints(), vtkCellArray()
    for outline in ellipses:
        first = points.GetNumberOfPoints()
        for point in outline:
            points.InsertNextPoint(*point)
        n = len(outline)
        lines.InsertNextCell(n + 1)
        for i in range(n + 1):
            lines.InsertCellPoint(first + i % n)
    data = vtkPolyData()
    data.SetPoints(points)
    data.SetLines(lines)
    source = TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def show_lines(lines, view, colour):
    display = Show(lines, view)
    display.LineWidth, display.AmbientColor, display.DiffuseColor = 2.0, colour, colour
    display.Ambient, display.Diffuse = 1.0, 0.0


def scaled_rings(reader, time):
    """The reader's data with von Mises stress in MPa, and its rings alone."""
    scaled = Calculator(Input=reader, AttributeType="Point Data", ResultArrayName=STRESS, Function="von_mises/1e6")
    return scaled, select(scaled, time, "radius", -1.0, 1e-12)


def new_view(size, time):
    view = CreateRenderView(ViewSize=size, Background=BACKGROUND)
    view.UseColorPaletteForBackground, view.OrientationAxesLabelColor, view.ViewTime = 0, INK, time
    return view


def top_of(options, values):
    """End of the colours, MPa: the one asked for, or a round number above a percentile of the values."""
    if options.max is not None:
        return options.max
    return round_up(float(numpy.percentile(values, options.percentile)) or float(values.max()) or 1.0)


def add_colour_options(parser):
    parser.add_argument("--percentile", type=float, default=99.0)
    parser.add_argument("--max", type=float)
    parser.add_argument("--size", default="1600x1000")


def check_colour_options(parser, options):
    try:
        options.size = [int(n) for n in options.size.split("x")]
        assert len(options.size) == 2 and min(options.size) > 0
    except (ValueError, AssertionError):
        parser.error("--size is %s, expected pixels as 1600x1000" % options.size)
    if not 0 < options.percentile <= 100:
        parser.error("--percentile is %g, expected more than 0 and at most 100" % options.percentile)
    if options.max is not None and not options.max > 0:
        parser.error("--max is %g MPa, expected a positive stress" % options.max)


def main(name, options, draw):
    """Draws and ends: with exit code 2 when files are wrong."""
    try:
        draw(options)
    except UserError as error:
        print("%s: %s" % (name, error), file=sys.stderr)
        # Close the readers before the HDF5 library is torn down, which would bury the message under its own.
        Disconnect()
        sys.exit(2)
