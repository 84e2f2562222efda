"""Draws the von Mises stress of both raceways with the contact ellipses of the balls, from a result folder into a PNG.

    pvpython render_contacts.py RESULTS PICTURE.png [options]

Above the inner ring seen from outside, below the far half of the outer ring seen from inside, both with the most
loaded ball in the middle. The ellipses are those of Hertz theory (semi-axes in balls.csv), drawn at the place where the
force of the ring on the ball passes; they are lifted a little so that the flat facets of a mesh do not hide them. Needs
ParaView 5.11 or later; without a screen put `xvfb-run -a -s -noreset` in front.

  --step N          committed step to show; default the last one
  --percentile P    colours end at this percentile of the nodal values of the rings, rounded up; default 99.5
  --max MPA         colours end at this value, MPa, instead
  --size WxH        pixels; default 1600x800

The picture it makes: docs/images/7010c_1800rpm_contacts.png (step 30 of scenes/7010c_1800rpm.toml).

Exit codes: 0 done, 2 wrong arguments or files.
"""

import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from raceway_results import *

POINTS_PER_ELLIPSE = 72
# Lift of the ellipses towards the ball, over its radius.
LIFT = 0.05


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="render_contacts.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("picture")
    parser.add_argument("--step", type=int)
    add_colour_options(parser)
    parser.set_defaults(percentile=99.5, size="1600x800")
    options = parser.parse_args(arguments)
    check_colour_options(parser, options)
    if not options.picture.endswith(".png"):
        parser.error("the picture is %s, expected a name ending in .png" % options.picture)
    return options


def ellipse(centre, force, radius, along_groove, along_rolling):
    """Points of one contact ellipse, laid on the ball."""
    normal = force / numpy.linalg.norm(force)
    azimuth = numpy.arctan2(centre[1], centre[0])
    rolling = numpy.array([-numpy.sin(azimuth), numpy.cos(azimuth), 0.0])
    groove = numpy.cross(normal, rolling)
    turn = numpy.linspace(0.0, 2.0 * numpy.pi, POINTS_PER_ELLIPSE, endpoint=False)
    arc = along_groove * numpy.cos(turn) / radius
    at = (1.0 - LIFT) * radius * (numpy.outer(numpy.sin(arc), groove) - numpy.outer(numpy.cos(arc), normal))
    return centre + at + along_rolling * numpy.outer(numpy.sin(turn), rolling)


def draw_ring(view, ring, lines, top):
    show_rings(ring, view, top)
    show_lines(lines, view, [0.05, 0.15, 0.75])


def look(view, position, focus, width):
    """Orthogonal view of `width` metres, with room for the colours to the right."""
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = list(position), list(focus), [0.0, 0.0, 1.0]
    view.CameraParallelProjection = 1
    view.CameraParallelScale = 0.5 * width * view.ViewSize[1] / view.ViewSize[0]
    SetActiveView(view)
    GetActiveCamera().SetWindowCenter(0.08, 0.0)


def render(options):
    series, number, time = find_step(options.results, options.step)
    scaled, solids = scaled_rings(open_series(series, time), time)
    rings = displaced(solids, time, 1.0)
    values = stress_values(rings)
    top = top_of(options, values)
    _, centres, forces, radius = ball_points(scaled, time)
    rows = contacts(options.results, number)
    loaded = most_loaded(forces)
    azimuth = numpy.arctan2(centres[loaded][1], centres[loaded][0])
    outward = numpy.array([numpy.cos(azimuth), numpy.sin(azimuth), 0.0])
    reach = float(numpy.linalg.norm(centres[loaded][:2]))

    layout = CreateLayout("contacts")
    views = []
    for side, name in enumerate(["inner", "outer"]):
        ring = select(rings, time, "body", side - 0.5, side + 0.5)
        if ring.GetDataInformation().GetNumberOfCells() == 0:
            raise UserError("%s has no flexible %s ring to show" % (series, name))
        view = new_view([options.size[0], options.size[1] // 2], time)
        view.OrientationAxesVisibility = 0
        outlined = [
            ellipse(centres[i], forces[side][i], radius, row["%s_semi_axis_groove_m" % name],
                    row["%s_semi_axis_rolling_m" % name])
            for i, row in enumerate(rows)
            if row["%s_force_n" % name] > 0 and (side == INNER or centres[i] @ outward > 0)
        ]
        if side == OUTER:
            ring = halved(ring, time, list(outward))
        draw_ring(view, ring, outlines(outlined), top)
        focus = reach * outward * (1 if side == OUTER else 0)
        look(view, focus + (0.3 if side == INNER else -0.3) * outward, focus, 2.9 * reach)
        write_title(view, "%s raceway" % name, 22, "Upper Center")
        views.append(view)
    write_title(views[0], instant(options.results, number, time), 15, "Lower Center")
    write_title(views[1], "most loaded: ball %d, %.4g N" % (loaded, rows[loaded]["outer_force_n"]), 15, "Lower Center")
    layout.SplitVertical(0, 0.5)
    layout.AssignView(1, views[0])
    layout.AssignView(2, views[1])
    layout.SetSize(*options.size)
    SaveScreenshot(os.path.abspath(options.picture), layout, ImageResolution=options.size)
    loads = sum(row["outer_force_n"] > 0 for row in rows)
    print("%s: %s, %d loaded balls, colours 0 to %.4g MPa, largest %.4g MPa"
          % (options.picture, instant(options.results, number, time), loads, top, values.max()))


main("render_contacts.py", parse_arguments(sys.argv[1:]), render)
