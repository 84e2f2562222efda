"""Draws balls rolling past one place of the outer ring, a PNG per step, from a result folder into a folder.

    pvpython render_passing.py RESULTS FRAMES [options]

Frames are FRAMES/frame_0000.png and so on, one per committed step, with the same colours and the same camera: it looks
from inside at the raceway of the outer ring. To see a ball pass, the steps must span a ball pitch: 1/Z of a turn of the
cage. Any tool makes a film of them, such as `ffmpeg -i FRAMES/frame_%04d.png film.mp4`. Needs ParaView 5.11 or later;
without a screen put `xvfb-run -a -s -noreset` in front.

  --steps A..B      committed steps to show, both ends included; default all
  --azimuth DEG     the place; default that of the most loaded ball in the middle of the steps
  --percentile P    colours end at this percentile of the values of that middle step, rounded up; default 99.8
  --max MPA         colours end at this value, MPa, instead
  --size WxH        pixels; default 1000x700

The picture it makes: docs/images/7010c_1800rpm_passing.png (a frame of scenes/7010c_1800rpm_coarse.toml).

Exit codes: 0 done, 2 wrong arguments or files.
"""

import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from raceway_results import *


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="render_passing.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("frames")
    parser.add_argument("--steps")
    parser.add_argument("--azimuth", type=float)
    add_colour_options(parser)
    parser.set_defaults(percentile=99.8, size="1000x700")
    options = parser.parse_args(arguments)
    check_colour_options(parser, options)
    try:
        first, last = (options.steps or "0..%d" % sys.maxsize).split("..")
        options.steps = int(first), int(last)
    except ValueError:
        parser.error("--steps is %s, expected both ends as in 20..40" % options.steps)
    return options


def render(options):
    series, steps = find_steps(options.results, *options.steps)
    middle = steps[len(steps) // 2][1]
    reader = open_series(series, middle)
    scaled, solids = scaled_rings(reader, middle)
    ring = displaced(select(solids, middle, "body", OUTER - 0.5, OUTER + 0.5), middle, 1.0)
    if ring.GetDataInformation().GetNumberOfCells() == 0:
        raise UserError("%s has no flexible outer ring to show" % series)
    balls, centres, forces, radius = ball_points(scaled, middle)
    loaded = centres[most_loaded(forces)]
    azimuth = numpy.arctan2(loaded[1], loaded[0]) if options.azimuth is None else numpy.radians(options.azimuth)
    outward = numpy.array([numpy.cos(azimuth), numpy.sin(azimuth), 0.0])
    half = halved(ring, middle, list(outward))
    top = top_of(options, stress_values(ring))
    reach = float(numpy.linalg.norm(loaded[:2]))

    view = new_view(options.size, middle)
    view.OrientationAxesVisibility = 0
    show_rings(half, view, top)
    # The contacts must be seen through the balls.
    show_balls(balls, middle, view, opacity=0.2)
    note = Text(Text="")
    display = Show(note, view)
    display.WindowLocation, display.FontSize, display.Color = "Lower Center", 15, INK
    write_title(view, "von Mises stress of the outer ring", 22, "Upper Center")
    focus = reach * outward
    view.CameraFocalPoint, view.CameraPosition = list(focus), list(-0.5 * reach * outward + [0.0, 0.0, -0.9 * reach])
    view.CameraViewUp, view.CameraViewAngle = [0.0, 0.0, 1.0], 40.0
    GetActiveCamera().SetWindowCenter(0.07, 0.0)
    os.makedirs(options.frames, exist_ok=True)
    for i, (number, time) in enumerate(steps):
        note.Text = instant(options.results, number, time)
        view.ViewTime = time
        Render(view)
        SaveScreenshot(os.path.join(os.path.abspath(options.frames), "frame_%04d.png" % i), view,
                       ImageResolution=options.size)
    print("%s: %d frames of steps %d to %d at azimuth %.4g deg, colours 0 to %.4g MPa"
          % (options.frames, len(steps), steps[0][0], steps[-1][0], numpy.degrees(azimuth) % 360.0, top))


main("render_passing.py", parse_arguments(sys.argv[1:]), render)
