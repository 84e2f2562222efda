"""Plots the stress at one node over time, from a result folder into a PNG and a CSV beside it.

    pvpython plot_probe.py RESULTS PICTURE.png --at X Y Z [options]

The node of a ring that is nearest to the point X Y Z, mm, of the mesh as it was read. On the inner ring it is a point
of the material and turns with it. The table has the columns step, time_s, the six components of the stress and von
Mises, Pa. Needs ParaView 5.11 or later; without a screen put `xvfb-run -a -s -noreset` in front.

  --body N          ring: 0 inner, 1 outer; default 1
  --size WxH        pixels; default 1400x800

The picture it makes: docs/images/7010c_1800rpm_probe.png (scenes/7010c_1800rpm_coarse.toml for 4.4 ms, `--at 37 0 0`: a ball pitch).

Exit codes: 0 done, 2 wrong arguments or files.
"""

import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from raceway_results import *

COMPONENTS = ["xx", "yy", "zz", "xy", "yz", "xz"]
# Red, green, blue of the components and of von Mises: Okabe and Ito's colours, told apart by all eyes.
LINES = [(0.90, 0.62, 0.0), (0.34, 0.71, 0.91), (0.0, 0.62, 0.45), (0.94, 0.89, 0.26), (0.0, 0.45, 0.70),
         (0.80, 0.47, 0.65), (0.0, 0.0, 0.0)]


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(prog="plot_probe.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("picture")
    parser.add_argument("--at", type=float, nargs=3, required=True)
    parser.add_argument("--body", type=int, default=OUTER)
    add_colour_options(parser)
    parser.set_defaults(size="1400x800")
    options = parser.parse_args(arguments)
    check_colour_options(parser, options)
    if not options.picture.endswith(".png"):
        parser.error("the picture is %s, expected a name ending in .png" % options.picture)
    return options


def nearest_node(data, body, at):
    """Number of the point of a ring nearest to `at`, m."""
    bodies = numpy.array(data.CellData["body"])
    cells = numpy.array(data.Cells)
    starts = numpy.array(data.CellLocations)
    nodes = {int(node) for cell in numpy.flatnonzero(bodies == body)
             for node in cells[starts[cell] + 1:starts[cell] + 1 + cells[starts[cell]]]}
    if not nodes or numpy.max(numpy.array(data.CellData["radius"])[bodies == body]) > 0:
        raise UserError("no ring has the body number %d" % body)
    nodes = numpy.array(sorted(nodes))
    distance = numpy.linalg.norm(numpy.array(data.Points)[nodes] - at, axis=1)
    return int(nodes[distance.argmin()]), float(distance.min())


def render(options):
    series, steps = find_steps(options.results, 0, sys.maxsize)
    reader = open_series(series, steps[0][1])
    data = dsa.WrapDataObject(servermanager.Fetch(reader))
    node, distance = nearest_node(data, options.body, 1e-3 * numpy.array(options.at))
    place = 1e3 * numpy.array(data.Points)[node]
    rows = []
    for number, time in steps:
        reader.UpdatePipeline(time)
        fields = dsa.WrapDataObject(servermanager.Fetch(reader)).PointData
        rows.append([number, time, *map(float, fields["stress"][node]), float(fields["von_mises"][node])])
    table = options.picture[:-len(".png")] + ".csv"
    head = ["step", "time_s"] + ["stress_%s_pa" % name for name in COMPONENTS] + ["von_mises_pa"]
    with open(table, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        writer.writerows([repr(value) for value in row] for row in rows)

    columns = Calculator(Input=CSVReader(FileName=[os.path.abspath(table)]), AttributeType="Row Data",
                         ResultArrayName="time (ms)", Function="1e3*time_s")
    shown = [name for name in head[2:]]
    for name in shown:
        columns = Calculator(Input=columns, AttributeType="Row Data", ResultArrayName=label(name),
                             Function="1e-6*%s" % name)
    view = CreateView("XYChartView", ViewSize=options.size)
    display = Show(columns, view)
    display.AttributeType, display.UseIndexForXAxis, display.XArrayName = "Row Data", 0, "time (ms)"
    display.SeriesVisibility = [label(name) for name in shown]
    thick = [entry for name in shown for entry in (label(name), "4" if name.startswith("von") else "2")]
    display.SeriesLineThickness = thick
    display.SeriesColor = [entry for name, line in zip(shown, LINES) for entry in (label(name), *map(str, line))]
    view.ChartTitle = "stress at node %d, (%.3f, %.3f, %.3f) mm" % (node, *place)
    view.LeftAxisTitle, view.BottomAxisTitle = "MPa", "time (ms)"
    SaveScreenshot(os.path.abspath(options.picture), view, ImageResolution=options.size)
    print("%s: node %d of body %d, %.4g mm from the point, %d steps, von Mises %.4g to %.4g MPa"
          % (options.picture, node, options.body, 1e3 * distance, len(rows), 1e-6 * min(row[-1] for row in rows),
             1e-6 * max(row[-1] for row in rows)))


def label(column):
    """Name in the legend."""
    return column[:-len("_pa")].replace("stress_", "").replace("_", " ")


main("plot_probe.py", parse_arguments(sys.argv[1:]), render)
