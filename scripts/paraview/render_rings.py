"""Renders the von Mises stress of the rings, with the balls as spheres, from a result folder into a PNG.

    pvpython render_rings.py RESULTS PICTURE.png [options]

RESULTS is a folder with run.hdf.series. Needs ParaView 5.11 or later. Without a screen put `xvfb-run -a -s -noreset`
in front (xvfb and xauth; without -noreset ParaView at times loses the screen), or use an off-screen build. Nothing is
kept between calls: the picture depends on the folder and the options only.

  --step N          committed step to show; default the last one
  --scale S         show the rings deformed, displacements times S; default 0, undeformed. Balls are always shown
                    at their true place
  --cut CUT         none (default), half: remove the half y < 0, or raceways: keep y > 0 of the outer ring, x > 0 of
                    the inner ring and the balls between both, so that both raceways lie open
  --body N          only the ring whose cell array body is N, so that its raceway is seen; default all rings
  --balls hide      leave the balls out, to see the contacts behind them; default show
  --view V          iso (default) or axial, along the axis
  --title TEXT      headline; default "von Mises stress of the rings"
  --percentile P    colours end at this percentile of the nodal values of the rings, rounded up to a round number, so
                    that the small spots under the balls do not leave everything else in one colour; default 99
  --max MPA         colours end at this value, MPa, instead of a percentile: for pictures to be compared
  --size WxH        pixels; default 1600x1000

Exit codes: 0 done, 2 wrong arguments or files.
"""

import argparse
import json
import math
import os
import sys

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


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="render_rings.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="pvpython render_rings.py RESULTS PICTURE.png [options]",
    )
    parser.add_argument("results", help=argparse.SUPPRESS)
    parser.add_argument("picture", help=argparse.SUPPRESS)
    parser.add_argument("--step", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--scale", type=float, default=0.0, help=argparse.SUPPRESS)
    parser.add_argument("--cut", choices=["none", "half", "raceways"], default="none", help=argparse.SUPPRESS)
    parser.add_argument("--body", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--balls", choices=["show", "hide"], default="show", help=argparse.SUPPRESS)
    parser.add_argument("--view", choices=["iso", "axial"], default="iso", help=argparse.SUPPRESS)
    parser.add_argument("--title", default="von Mises stress of the rings", help=argparse.SUPPRESS)
    parser.add_argument("--percentile", type=float, default=99.0, help=argparse.SUPPRESS)
    parser.add_argument("--max", type=float, help=argparse.SUPPRESS)
    parser.add_argument("--size", default="1600x1000", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    try:
        options.size = [int(n) for n in options.size.split("x")]
        assert len(options.size) == 2 and min(options.size) > 0
    except (ValueError, AssertionError):
        parser.error("--size is %s, expected pixels as 1600x1000" % options.size)
    if not 0 < options.percentile <= 100:
        parser.error("--percentile is %g, expected more than 0 and at most 100" % options.percentile)
    if options.max is not None and not options.max > 0:
        parser.error("--max is %g MPa, expected a positive stress" % options.max)
    if not options.picture.endswith(".png"):
        parser.error("the picture is %s, expected a name ending in .png" % options.picture)
    return options


def find_step(folder, wanted):
    """Absolute path of the series, and number and time of the step to show."""
    series = os.path.abspath(os.path.join(folder, "run.hdf.series"))
    if not os.path.isfile(series):
        raise UserError("%s not found; expected the result folder of a run with at least one step" % series)
    with open(series) as file:
        entries = json.load(file)["files"]
    steps = {int(entry["name"][len("step_"):-len(".hdf")]): entry for entry in entries}
    if not steps:
        raise UserError("%s lists no step; the run has not committed one yet" % series)
    number = max(steps) if wanted is None else wanted
    if number not in steps:
        raise UserError("step %d is not in %s; steps are %d to %d" % (number, series, min(steps), max(steps)))
    for name in [entry["name"] for entry in entries] + ["mesh.hdf"]:
        if not os.path.isfile(os.path.join(os.path.dirname(series), name)):
            raise UserError("%s is missing beside %s" % (name, series))
    return series, number, steps[number]["time"]


def open_series(series, time):
    """The reader at the given time; fails when the arrays to draw are not there."""
    reader = OpenDataFile(series)
    if reader is None:
        raise UserError("this ParaView cannot open %s; expected version 5.11 or later" % series)
    reader.UpdatePipeline(time)
    for data, needed in [(reader.PointData, ["von_mises", "displacement"]), (reader.CellData, ["radius", "body"])]:
        missing = [name for name in needed if name not in data.keys()]
        if missing:
            raise UserError("%s has no array %s; its arrays are %s" % (series, missing[0], ", ".join(data.keys())))
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


def cut_open(cut, rings, balls, time):
    """Pieces of the rings, and the balls, that a cut leaves."""
    back, right = [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]
    if cut == "half":
        return [halved(rings, time, back)], halved(balls, time, back)
    if cut == "raceways":
        inner = select(rings, time, "body", INNER - 0.5, INNER + 0.5)
        outer = select(rings, time, "body", OUTER - 0.5, OUTER + 0.5)
        pieces = [halved(inner, time, right), halved(outer, time, back)]
        return pieces, halved(halved(balls, time, right), time, back)
    return [rings], balls


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


def show_balls(balls, time, view):
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
    display.DiffuseColor = [0.72, 0.73, 0.76]
    display.Ambient, display.Diffuse, display.Specular = 0.3, 0.6, 0.4


def write_title(view, text, size, place):
    display = Show(Text(Text=text), view)
    display.WindowLocation = place
    display.FontSize, display.Color = size, INK


def place_camera(view, kind):
    """The axis z points up to the viewer's right in `iso`; the half y < 0 is in front, so `--cut half` opens it."""
    view.CameraFocalPoint = [0.0, 0.0, 0.0]
    if kind == "axial":
        view.CameraPosition, view.CameraViewUp = [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]
    else:
        view.CameraPosition, view.CameraViewUp = [0.45, -1.0, 0.75], [0.0, 0.0, 1.0]
    ResetCamera(view)
    camera = GetActiveCamera()
    camera.Dolly(1.1 if kind == "axial" else 1.55)
    # The colour bar stands to the right.
    camera.SetWindowCenter(0.07, -0.02)


def render(options):
    series, number, time = find_step(options.results, options.step)
    reader = open_series(series, time)
    scaled = Calculator(Input=reader, AttributeType="Point Data", ResultArrayName=STRESS, Function="von_mises/1e6")
    solids = select(scaled, time, "radius", -1.0, 1e-12)
    if options.body is not None:
        solids = select(solids, time, "body", options.body - 0.5, options.body + 0.5)
        if solids.GetDataInformation().GetNumberOfCells() == 0:
            raise UserError("no ring has the body number %d" % options.body)
    rings = displaced(solids, time, options.scale)
    values = stress_values(rings)
    top = options.max if options.max is not None else round_up(
        float(numpy.percentile(values, options.percentile)) or float(values.max()) or 1.0)
    balls = displaced(select(scaled, time, "radius", 1e-12, 1e12), time, 1.0)
    pieces, balls = cut_open(options.cut, rings, balls, time)

    view = CreateRenderView(ViewSize=options.size, Background=BACKGROUND)
    view.UseColorPaletteForBackground, view.OrientationAxesLabelColor, view.ViewTime = 0, INK, time
    for piece in pieces:
        show_rings(piece, view, top)
    if options.balls == "show" and balls.GetDataInformation().GetNumberOfPoints() > 0:
        show_balls(balls, time, view)
    deformed = "undeformed" if options.scale == 0 else "displacements x %g" % options.scale
    write_title(view, options.title, 26, "Upper Center")
    note = "step %d, t = %.6g s, %s; largest nodal value %.4g MPa" % (number, time, deformed, values.max())
    write_title(view, note, 15, "Lower Center")
    place_camera(view, options.view)
    SaveScreenshot(os.path.abspath(options.picture), view, ImageResolution=options.size)
    print("%s: step %d, t = %.6g s, colours 0 to %.4g MPa, largest %.4g MPa"
          % (options.picture, number, time, top, values.max()))


OPTIONS = parse_arguments(sys.argv[1:])
try:
    import numpy
    from paraview import servermanager
    from paraview.simple import *
    from vtkmodules.numpy_interface import dataset_adapter as dsa
except ImportError as error:
    sys.exit("render_rings.py: %s; run it with ParaView's pvpython" % error)
paraview.simple._DisableFirstRenderCameraReset()
try:
    render(OPTIONS)
except UserError as error:
    print("render_rings.py: %s" % error, file=sys.stderr)
    # Close the readers before the HDF5 library is torn down, which would bury the message under its own.
    Disconnect()
    sys.exit(2)
