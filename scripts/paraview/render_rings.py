"""Renders the von Mises stress of the rings, with the balls as spheres, from a result folder into a PNG.

    pvpython render_rings.py RESULTS PICTURE.png [options]

RESULTS is a folder with run.hdf.series. Needs ParaView 5.11 or later. Without a screen put `xvfb-run -a -s -noreset`
in front (xvfb and xauth; without -noreset ParaView at times loses the screen), or use an off-screen build. Nothing is
kept between calls: the picture depends on the folder and the options only.

  --step N          committed step to show; default the last one
  --scale S         show the rings with displacements times S; default 1, their true place, to which the turning of
                    an inner ring in motion belongs; 0 is the mesh as it was read. Balls are always at their true place
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
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from raceway_results import *


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(
        prog="render_rings.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="pvpython render_rings.py RESULTS PICTURE.png [options]",
    )
    parser.add_argument("results", help=argparse.SUPPRESS)
    parser.add_argument("picture", help=argparse.SUPPRESS)
    parser.add_argument("--step", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--scale", type=float, default=1.0, help=argparse.SUPPRESS)
    parser.add_argument("--cut", choices=["none", "half", "raceways"], default="none", help=argparse.SUPPRESS)
    parser.add_argument("--body", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--balls", choices=["show", "hide"], default="show", help=argparse.SUPPRESS)
    parser.add_argument("--view", choices=["iso", "axial"], default="iso", help=argparse.SUPPRESS)
    parser.add_argument("--title", default="von Mises stress of the rings", help=argparse.SUPPRESS)
    parser.add_argument("--percentile", type=float, default=99.0, help=argparse.SUPPRESS)
    parser.add_argument("--max", type=float, help=argparse.SUPPRESS)
    parser.add_argument("--size", default="1600x1000", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    check_colour_options(parser, options)
    if not options.picture.endswith(".png"):
        parser.error("the picture is %s, expected a name ending in .png" % options.picture)
    return options


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
    scaled, solids = scaled_rings(reader, time)
    if options.body is not None:
        solids = select(solids, time, "body", options.body - 0.5, options.body + 0.5)
        if solids.GetDataInformation().GetNumberOfCells() == 0:
            raise UserError("no ring has the body number %d" % options.body)
    rings = displaced(solids, time, options.scale)
    values = stress_values(rings)
    top = top_of(options, values)
    balls = displaced(select(scaled, time, "radius", 1e-12, 1e12), time, 1.0)
    pieces, balls = cut_open(options.cut, rings, balls, time)

    view = new_view(options.size, time)
    for piece in pieces:
        show_rings(piece, view, top)
    if options.balls == "show" and balls.GetDataInformation().GetNumberOfPoints() > 0:
        show_balls(balls, time, view)
    deformed = "displacements x %g" % options.scale
    write_title(view, options.title, 26, "Upper Center")
    note = "%s, %s; largest nodal value %.4g MPa" % (instant(options.results, number, time), deformed, values.max())
    write_title(view, note, 15, "Lower Center")
    place_camera(view, options.view)
    SaveScreenshot(os.path.abspath(options.picture), view, ImageResolution=options.size)
    print("%s: %s, colours 0 to %.4g MPa, largest %.4g MPa"
          % (options.picture, instant(options.results, number, time), top, values.max()))


main("render_rings.py", parse_arguments(sys.argv[1:]), render)
