"""Draws a cut through the bearing at one azimuth with the von Mises stress, from a result folder into a PNG.

    pvpython render_section.py RESULTS PICTURE.png [options]

The half plane that ends at the axis is cut; the axis is horizontal, + to the right, the outer ring at the top. A ball
that the plane meets is drawn as its circle. Needs ParaView 5.11 or later; without a screen put
`xvfb-run -a -s -noreset` in front.

  --step N          committed step to show; default the last one
  --azimuth DEG     azimuth of the cut, from +x towards +y; default that of the most loaded ball
  --percentile P    colours end at this percentile of the values in the section, rounded up; default 100
  --max MPA         colours end at this value, MPa, instead
  --size WxH        pixels; default 1200x1000

The picture it makes: docs/images/7010c_1800rpm_section.png (step 30 of scenes/7010c_1800rpm.toml).

Exit codes: 0 done, 2 wrong arguments or files.
"""

import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from raceway_results import *


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="render_section.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("picture")
    parser.add_argument("--step", type=int)
    parser.add_argument("--azimuth", type=float)
    add_colour_options(parser)
    parser.set_defaults(percentile=100.0, size="1200x1000")
    options = parser.parse_args(arguments)
    check_colour_options(parser, options)
    if not options.picture.endswith(".png"):
        parser.error("the picture is %s, expected a name ending in .png" % options.picture)
    return options


def cut_at(source, time, outward, normal):
    """The section of `source` with the half plane through the axis."""
    half = Clip(Input=source, ClipType="Plane", Invert=0)
    half.ClipType.Origin, half.ClipType.Normal = [0.0, 0.0, 0.0], list(outward)
    plane = Slice(Input=half, SliceType="Plane")
    plane.SliceType.Origin, plane.SliceType.Normal = [0.0, 0.0, 0.0], list(normal)
    plane.UpdatePipeline(time)
    return plane


def circle(centre, radius, outward):
    """Points of a circle in the half plane."""
    turn = numpy.linspace(0.0, 2.0 * numpy.pi, 180, endpoint=False)
    return centre + radius * (numpy.outer(numpy.cos(turn), outward) + numpy.outer(numpy.sin(turn), [0.0, 0.0, 1.0]))


def render(options):
    series, number, time = find_step(options.results, options.step)
    scaled, solids = scaled_rings(open_series(series, time), time)
    _, centres, forces, radius = ball_points(scaled, time)
    loaded = centres[most_loaded(forces)]
    azimuth = numpy.arctan2(loaded[1], loaded[0]) if options.azimuth is None else numpy.radians(options.azimuth)
    outward = numpy.array([numpy.cos(azimuth), numpy.sin(azimuth), 0.0])
    # The viewer stands where this points to: then the axis points to the right when the radius points up.
    normal = numpy.array([-numpy.sin(azimuth), numpy.cos(azimuth), 0.0])
    section = cut_at(displaced(solids, time, 1.0), time, outward, normal)
    if section.GetDataInformation().GetNumberOfCells() == 0:
        raise UserError("the plane at %g deg cuts no ring of %s" % (numpy.degrees(azimuth), series))
    values = stress_values(section)
    top = top_of(options, values)
    view = new_view(options.size, time)
    view.OrientationAxesVisibility = 0
    show_rings(section, view, top)
    for centre in centres:
        off = abs(float(centre @ normal))
        if off < radius and centre @ outward > 0:
            met = circle(centre - (centre @ normal) * normal, numpy.sqrt(radius**2 - off**2), outward)
            show_lines(outlines([met]), view, INK)
    low, high = numpy.array(section.GetDataInformation().GetBounds()).reshape(3, 2).T
    points = numpy.concatenate([numpy.array(block) for block in [dsa.WrapDataObject(
        servermanager.Fetch(section)).Points]])
    heights = points @ outward
    middle = 0.5 * (heights.min() + heights.max()) * outward + [0.0, 0.0, 0.5 * (low[2] + high[2])]
    view.CameraFocalPoint, view.CameraPosition = list(middle), list(middle + 0.2 * normal)
    view.CameraViewUp, view.CameraParallelProjection = list(outward), 1
    view.CameraParallelScale = 0.62 * max(heights.max() - heights.min(), high[2] - low[2])
    GetActiveCamera().SetWindowCenter(0.08, 0.0)
    write_title(view, "von Mises stress at azimuth %.1f deg" % (numpy.degrees(azimuth) % 360.0), 24, "Upper Center")
    write_title(view, "%s; largest in the section %.4g MPa" % (instant(options.results, number, time), values.max()), 15,
                "Lower Center")
    SaveScreenshot(os.path.abspath(options.picture), view, ImageResolution=options.size)
    print("%s: %s, azimuth %.4g deg, colours 0 to %.4g MPa, largest %.4g MPa"
          % (options.picture, instant(options.results, number, time), numpy.degrees(azimuth) % 360.0, top, values.max()))


main("render_section.py", parse_arguments(sys.argv[1:]), render)
